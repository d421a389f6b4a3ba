//! The terrain layers of a preset: what stands in the ordered list, not how it is evaluated (see `terrain`).

use super::masks::Mask;
use super::param::{Curve, Domain, ParamPath, Segment, Stage, Unit, choice, linear, log, params};
use super::shapes::Shape;

/// Reach of a curve over noise, and how close its points may stand.
const NOISE_CURVE: Domain = Domain::Curve { most: 4.0, least_step: 0.01 };

params! {
    /// One layer of terrain. Its noise `v`, reshaped by `curve`, is about -1 to 1; its output is
    /// `y = (v + bias) * amplitude_m`, which `blend` joins to the height made by the layers above it in the list, as
    /// far as the masks let it.
    pub struct Layer {
        /// What the layer is called; masks refer to it by this name, so it must be unique.
        name: String = "Layer".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 48 }, Stage::Label;
        /// Whether the layer takes part. A layer that is off can still serve as a mask.
        enabled: bool = true, "Enabled", Unit::None, Domain::Flag, Stage::Height;
        /// Start of this layer's pseudo-random sequence; another number is another landscape of the same kind.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field;
        /// Height of a full swing of the noise.
        amplitude_m: f64 = 1000.0, "Amplitude", Unit::Metres, log(0.0, 100_000.0), Stage::Height;
        /// Added to the noise before the amplitude: positive raises the whole layer, negative sinks it.
        bias: f64 = 0.0, "Bias", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// How the layer joins the height below it.
        blend: Blend = Blend::Add, "Blend", Unit::None, Domain::Choice, Stage::Height;
        /// How far apart in height SmoothMax and SmoothMin begin to round the corner between the two grounds.
        softness_m: f64 = 100.0, "Softness", Unit::Metres, log(0.0, 100_000.0), Stage::Height;
        /// Reshapes the noise: points (noise, what it becomes), before bias and amplitude. Empty leaves it as it is;
        /// beyond its ends the curve goes on straight.
        curve: Curve = Curve::new(), "Curve", Unit::None, NOISE_CURVE, Stage::Height;
    } with {
        /// The kind of terrain and its parameters.
        shape: Shape = Shape::default();
        /// Where the layer acts; several masks multiply.
        masks: Vec<Mask> = Vec::new();
    }
}

choice! {
    /// How a layer's output `y` joins the height `h` of the layers before it.
    pub enum Blend {
        /// `h + y`
        Add = "Add",
        /// `h - y`
        Subtract = "Subtract",
        /// `h * (v + bias)`: the layer scales what is there; its amplitude plays no part.
        Multiply = "Multiply",
        /// The greater of `h` and `y`.
        Max = "Max",
        /// The lesser of `h` and `y`.
        Min = "Min",
        /// `y` alone.
        Replace = "Replace",
        /// The greater of `h` and `y`, the corner between them rounded by `softness_m`.
        SmoothMax = "SmoothMax",
        /// The lesser of `h` and `y`, the corner between them rounded by `softness_m`.
        SmoothMin = "SmoothMin",
    }
}

/// Gives each list element its place in a path, for panels that work on one element at a time.
pub fn layer_path(index: usize) -> ParamPath {
    ParamPath::from(vec![Segment::Field("layers"), Segment::Index(index)])
}
