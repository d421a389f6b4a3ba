//! Where a layer acts: the kinds of mask and the parameters of each.
//!
//! Every mask goes smoothly from off (0) at `from` to on (1) at `to`, whichever of the two is greater, and `invert`
//! swaps off and on. Several masks of a layer multiply.

use super::kinds::kinds;
use super::param::{Domain, Stage, Unit, linear, log, params};

kinds! {
    /// What decides where the layer acts.
    pub enum Mask: "mask", "Kind", Stage::Field | Stage::Height;
    /// The noise of another layer.
    Layer(LayerMask),
    /// The height made by the layers before.
    Height(HeightMask),
    /// The slope made by the layers before.
    Slope(SlopeMask),
    /// The distance from the equator.
    Latitude(LatitudeMask),
}

params! {
    /// Lets a layer act where another layer's noise is in a range: the noise as it is before curve, bias and amplitude.
    pub struct LayerMask {
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

params! {
    /// Lets a layer act where the height made by the layers before it is in a range.
    pub struct HeightMask {
        /// Height at which the layer is fully off.
        from_m: f64 = 0.0, "From", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Height;
        /// Height at which the layer is fully on; between the two it fades smoothly.
        to_m: f64 = 500.0, "To", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Height;
        /// Off where it would be on, and the reverse.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

params! {
    /// Lets a layer act where the ground made by the layers before it is flat or steep enough.
    pub struct SlopeMask {
        /// Slope at which the layer is fully off.
        from_deg: f64 = 15.0, "From", Unit::Degrees, linear(0.0, 90.0), Stage::Height;
        /// Slope at which the layer is fully on; between the two it fades smoothly.
        to_deg: f64 = 30.0, "To", Unit::Degrees, linear(0.0, 90.0), Stage::Height;
        /// Distance over which the slope is measured: relief much finer than this does not count. A planet
        /// may use few different ones.
        over_m: f64 = 500.0, "Over", Unit::Metres, log(1.0, 1_000_000.0), Stage::Field | Stage::Height;
        /// Off where it would be on, and the reverse.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

params! {
    /// Lets a layer act between two latitudes: near the poles, near the equator, in one hemisphere.
    pub struct LatitudeMask {
        /// Latitude at which the layer is fully off; north is positive.
        from_deg: f64 = 50.0, "From", Unit::Degrees, linear(-90.0, 90.0), Stage::Height;
        /// Latitude at which the layer is fully on; between the two it fades smoothly.
        to_deg: f64 = 60.0, "To", Unit::Degrees, linear(-90.0, 90.0), Stage::Height;
        /// Whether the south is the mirror image of the north: latitudes then count without their sign.
        both: bool = true, "Both hemispheres", Unit::None, Domain::Flag, Stage::Height;
        /// Off where it would be on, and the reverse.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

impl Mask {
    /// Name and value of the two parameters at which it is fully off and fully on.
    pub fn ends(&self) -> [(&'static str, f64); 2] {
        match self {
            Mask::Layer(mask) => [("from", mask.from), ("to", mask.to)],
            Mask::Height(mask) => [("from_m", mask.from_m), ("to_m", mask.to_m)],
            Mask::Slope(mask) => [("from_deg", mask.from_deg), ("to_deg", mask.to_deg)],
            Mask::Latitude(mask) => [("from_deg", mask.from_deg), ("to_deg", mask.to_deg)],
        }
    }

    /// The layer it looks at, if it looks at one.
    pub fn layer(&self) -> Option<&str> {
        match self {
            Mask::Layer(mask) => Some(&mask.layer),
            _ => None,
        }
    }

    /// Lets it look at another layer, if it looks at one.
    pub fn set_layer(&mut self, name: &str) {
        if let Mask::Layer(mask) = self {
            name.clone_into(&mut mask.layer);
        }
    }
}
