//! Masks: where a layer acts.
//!
//! Every mask rises smoothly from 0 (off) at `from` to 1 (on) at `to`; either may be the greater one. `invert` swaps
//! off and on. Several masks of a layer multiply.

use super::kinds::kinds;
use super::param::{Domain, Stage, Unit, linear, log, params};
use super::{Planet, Tool};
use std::collections::BTreeSet;

/// Name of the first mask that is painted.
pub(crate) const FIRST_PAINTED: &str = "Mask";

kinds! {
    /// The quantity that decides where the layer acts.
    pub enum Mask: "mask", "Kind", Stage::Field | Stage::Height;
    /// The noise of another layer.
    Layer(LayerMask) = "Another layer",
    /// The height of the earlier layers.
    Height(HeightMask) = "Height",
    /// The slope of the earlier layers.
    Slope(SlopeMask) = "Slope",
    /// The distance from the equator.
    Latitude(LatitudeMask) = "Latitude",
    /// Strokes of the mask tool.
    Painted(PaintedMask) = "Painted by hand",
}

params! {
    /// Limits a layer to a range of another layer's noise, before curve, bias and amplitude.
    pub struct LayerMask {
        /// Name of the layer whose noise is read.
        layer: String = String::new(), "Layer", Unit::None, Domain::Text { max_chars: 48 }, Stage::Height;
        /// Noise value at which the layer is fully off.
        from: f64 = -0.1, "Off at", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// Noise value at which the layer is fully on.
        to: f64 = 0.1, "On at", Unit::None, linear(-2.0, 2.0), Stage::Height;
        /// Swaps on and off.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

params! {
    /// Limits a layer to a range of the height of the earlier layers.
    pub struct HeightMask {
        /// Height at which the layer is fully off.
        from_m: f64 = 0.0, "Off at", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Height;
        /// Height at which the layer is fully on.
        to_m: f64 = 500.0, "On at", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Height;
        /// Swaps on and off.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

params! {
    /// Limits a layer to a range of the slope of the earlier layers.
    pub struct SlopeMask {
        /// Slope at which the layer is fully off.
        from_deg: f64 = 15.0, "Off at", Unit::Degrees, linear(0.0, 90.0), Stage::Height;
        /// Slope at which the layer is fully on.
        to_deg: f64 = 30.0, "On at", Unit::Degrees, linear(0.0, 90.0), Stage::Height;
        /// Distance over which the slope is measured; finer terrain does not count. All masks of a planet together may
        /// use only a few different distances.
        over_m: f64 = 500.0, "Measured over", Unit::Metres, log(1.0, 1_000_000.0), Stage::Field | Stage::Height;
        /// Swaps on and off.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

params! {
    /// Limits a layer to a range of latitude: near the poles, near the equator, in one hemisphere.
    pub struct LatitudeMask {
        /// Latitude at which the layer is fully off; north is positive.
        from_deg: f64 = 50.0, "Off at", Unit::Degrees, linear(-90.0, 90.0), Stage::Height;
        /// Latitude at which the layer is fully on.
        to_deg: f64 = 60.0, "On at", Unit::Degrees, linear(-90.0, 90.0), Stage::Height;
        /// Ignores the sign of the latitude, so that both hemispheres are alike.
        both: bool = true, "Both hemispheres", Unit::None, Domain::Flag, Stage::Height;
        /// Swaps on and off.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

params! {
    /// Limits a layer to where strokes of the mask tool painted a mask of this name.
    pub struct PaintedMask {
        /// Name of the mask. Layers that name the same mask share it.
        mask: String = FIRST_PAINTED.to_owned(), "Painted mask", Unit::None, Domain::MaskName { max_chars: 48 },
            Stage::Field | Stage::Height;
        /// Paint, from 0 to 1, at which the layer is fully off.
        from_share: f64 = 0.0, "Off at", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// Paint at which the layer is fully on.
        to_share: f64 = 1.0, "On at", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// Swaps on and off.
        invert: bool = false, "Invert", Unit::None, Domain::Flag, Stage::Height;
    }
}

impl Planet {
    /// The names of painted masks that layers and edits have, in alphabetical order.
    pub fn painted_masks(&self) -> BTreeSet<&str> {
        let of_layers = self.layers.iter().flat_map(|layer| &layer.masks).filter_map(|mask| match mask {
            Mask::Painted(mask) => Some(&*mask.mask),
            _ => None,
        });
        let of_edits = self.edits.iter().filter_map(|edit| match &edit.tool {
            Tool::Mask(paint) => Some(&*paint.mask),
            _ => edit.limiting_mask(),
        });
        of_layers.chain(of_edits).filter(|name| !name.is_empty()).collect()
    }
}

impl Mask {
    /// Name and value of the two ends of the range.
    pub fn ends(&self) -> [(&'static str, f64); 2] {
        match self {
            Mask::Layer(mask) => [("from", mask.from), ("to", mask.to)],
            Mask::Height(mask) => [("from_m", mask.from_m), ("to_m", mask.to_m)],
            Mask::Slope(mask) => [("from_deg", mask.from_deg), ("to_deg", mask.to_deg)],
            Mask::Latitude(mask) => [("from_deg", mask.from_deg), ("to_deg", mask.to_deg)],
            Mask::Painted(mask) => [("from_share", mask.from_share), ("to_share", mask.to_share)],
        }
    }

    /// The layer that the mask reads, if it reads one.
    pub fn layer(&self) -> Option<&str> {
        match self {
            Mask::Layer(mask) => Some(&mask.layer),
            _ => None,
        }
    }

    /// Makes a mask that reads a layer read another one.
    pub fn set_layer(&mut self, name: &str) {
        if let Mask::Layer(mask) = self {
            name.clone_into(&mut mask.layer);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::param::Choice;

    /// The kinds keep what they have in common; the ends of a range of noise are not those of a share of paint.
    #[test]
    fn a_mask_that_becomes_a_painted_one_is_on_where_it_is_painted_in_full() {
        let mut mask = Mask::default();
        assert!(matches!(mask, Mask::Layer(_)));
        mask.set_index(Mask::Painted(PaintedMask::default()).index());
        assert_eq!(mask, Mask::Painted(PaintedMask::default()));
    }
}
