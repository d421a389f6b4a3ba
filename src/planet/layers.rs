//! The terrain layers of a preset. `terrain` evaluates them.

use super::masks::Mask;
use super::param::{Curve, Domain, ParamPath, Segment, Stage, Unit, choice, linear, log, params};
use super::shapes::Shape;

/// Domain of a curve over noise.
const NOISE_CURVE: Domain = Domain::Curve { most: 4.0, least_step: 0.01 };

params! {
    /// One layer of terrain. Its noise `v`, reshaped by `curve`, is about -1 to 1. Its output is
    /// `y = (v + bias) * amplitude_m`. `blend` combines the output with the height of the earlier layers, scaled by the
    /// masks.
    pub struct Layer {
        /// Name of the layer. Masks refer to it by this name, so it must be unique.
        name: String = "Layer".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 48 }, Stage::Label;
        /// Whether the layer changes the height. A layer that is off can still serve as a mask.
        enabled: bool = true, "Enabled", Unit::None, Domain::Flag, Stage::Height;
        /// Seed of the layer's noise. Another seed is another landscape of the same kind.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field;
        /// Height for a noise value of 1.
        amplitude_m: f64 = 1000.0, "Amplitude", Unit::Metres, log(0.0, 100_000.0), Stage::Height;
        /// Added to the noise before the amplitude: positive raises the whole layer, negative lowers it.
        bias: f64 = 0.0, "Offset", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// How the layer is combined with the height of the earlier layers.
        blend: Blend = Blend::Add, "Blend mode", Unit::None, Domain::Choice, Stage::Height;
        /// Height difference below which SmoothMax and SmoothMin round the corner.
        softness_m: f64 = 100.0, "Softness", Unit::Metres, log(0.0, 100_000.0), Stage::Height;
        /// Reshapes the noise before bias and amplitude: points (noise, new value). An empty curve changes nothing.
        /// Beyond its ends the curve is a straight line.
        curve: Curve = Curve::new(), "Curve", Unit::None, NOISE_CURVE, Stage::Height;
        /// Whether the layer lies under the structure of the planet, which rivers carve. Without a structure it has no
        /// effect.
        under: bool = false, "Below the structure", Unit::None, Domain::Flag, Stage::Field;
        /// How strongly belts of folded rock steer the layer: across a belt its features become narrower, about by this
        /// factor and one, so that ridges run along the folds. Craters, dunes and pictures are not steered. Without a
        /// structure it has no effect.
        folding: f64 = 0.0, "Folding", Unit::None, linear(0.0, 4.0), Stage::Field;
    } with {
        /// Landform: the kind of terrain and its parameters.
        shape: Shape = Shape::default();
        /// Where the layer acts. Several masks multiply.
        masks: Vec<Mask> = Vec::new();
    }
}

choice! {
    /// How a layer's output `y` is combined with the height `h` of the earlier layers.
    pub enum Blend {
        /// `h + y`
        Add = "Add",
        /// `h - y`
        Subtract = "Subtract",
        /// `h * (v + bias)`: the layer scales the height; its amplitude has no effect.
        Multiply = "Multiply",
        /// The greater of `h` and `y`.
        Max = "Maximum",
        /// The lesser of `h` and `y`.
        Min = "Minimum",
        /// `y` alone.
        Replace = "Replace",
        /// The greater of `h` and `y`, with the corner rounded by `softness_m`.
        SmoothMax = "Smooth maximum",
        /// The lesser of `h` and `y`, with the corner rounded by `softness_m`.
        SmoothMin = "Smooth minimum",
    }
}

/// The path of a layer.
pub fn layer_path(index: usize) -> ParamPath {
    ParamPath::from(vec![Segment::Field("layers"), Segment::Index(index)])
}
