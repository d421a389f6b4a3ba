//! The noise that raises and lowers the steps of terraces: plain octaves. The steps depend on the ground below and
//! are cut where layers are joined (`height::steps`).

use super::fbm::Fbm;
use super::varying::Around;
use super::{Arithmetic, Chunk, Evaluate, Scratch};
use crate::planet;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Terraces {
    waves: Fbm,
}

impl Terraces {
    pub(super) fn new(params: &planet::Terraces, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        Self { waves: Fbm::plain(seed, radius_km / params.wavelength_km, params.octaves, arithmetic) }
    }
}

impl Evaluate for Terraces {
    fn octave_count(&self) -> usize {
        self.waves.octave_count()
    }

    fn bounds(&self) -> (f64, f64) {
        self.waves.bounds()
    }

    fn bounds_around(&self, around: Around) -> (f64, f64) {
        self.waves.bounds_around(around)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        self.waves.add_to(chunk, scratch);
    }
}
