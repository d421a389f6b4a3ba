//! The terrain layers of a preset: what stands in the ordered list, not how it is evaluated (see `terrain`).

use super::param::{Domain, ParamPath, Segment, Stage, Unit, choice, linear, log, params};
use super::shapes::Shape;

params! {
    /// One layer of terrain. Its noise `v` is about -1 to 1; its output is `y = (v + bias) * amplitude_m`, which `blend`
    /// joins to the height made by the layers above it in the list, as far as the masks let it.
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
    } with {
        /// The kind of noise and its parameters.
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
    }
}

params! {
    /// Lets a layer act only where another layer's noise is in a range.
    pub struct Mask {
        /// Name of the layer whose noise decides.
        layer: String = String::new(), "Layer", Unit::None, Domain::Text { max_chars: 48 }, Stage::Height;
        /// Noise value at which the layer is fully off.
        from: f64 = -0.1, "From", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// Noise value at which the layer is fully on; between the two it fades smoothly.
        to: f64 = 0.1, "To", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// Off where it would be on, and the reverse.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

/// Gives each list element its place in a path, for panels that work on one element at a time.
pub fn layer_path(index: usize) -> ParamPath {
    ParamPath::from(vec![Segment::Field("layers"), Segment::Index(index)])
}
