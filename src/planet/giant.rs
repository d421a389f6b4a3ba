//! Gas giants: planets without a ground, whose clouds are drawn in bands by jets.

use super::Planet;
use super::param::{Domain, ParamPath, Stage, Unit, count, linear, log, params};
use super::starting::Starting;

params! {
    /// The clouds of a gas giant, in place of a ground.
    pub struct Giant {
        /// Bands from pole to pole.
        bands: u32 = 16, "Bands", Unit::None, count(2, 48), Stage::Uniform;
        /// How much the widths and colours of the bands vary.
        variation: f64 = 0.6, "Variation", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// How much belts differ from zones.
        contrast: f64 = 0.9, "Contrast", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Colour of the zones, the bright bands (linear sRGB).
        zone_color: [f64; 3] = [0.76, 0.62, 0.43], "Zones", Unit::None, Domain::Color, Stage::Uniform;
        /// Colour of the belts, the dark bands.
        belt_color: [f64; 3] = [0.33, 0.155, 0.07], "Belts", Unit::None, Domain::Color, Stage::Uniform;
        /// Colour that some bands tend to.
        accent_color: [f64; 3] = [0.55, 0.37, 0.24], "Accent", Unit::None, Domain::Color, Stage::Uniform;
        /// Colour of the poles.
        pole_color: [f64; 3] = [0.26, 0.25, 0.25], "Poles", Unit::None, Domain::Color, Stage::Uniform;
        /// Speed of the jet on the equator; the others alternate and are slower.
        jet_m_s: f64 = 130.0, "Jets", Unit::MetresPerSecond, linear(0.0, 800.0), Stage::Uniform;
        /// How far eddies fold the bands.
        turbulence: f64 = 1.0, "Turbulence", Unit::None, linear(0.0, 3.0), Stage::Uniform;
        /// Size of the eddies, in radii of the planet.
        eddy_radii: f64 = 0.09, "Eddy size", Unit::None, log(0.01, 1.0), Stage::Uniform;
        /// Contrast of filaments along the jets.
        filaments: f64 = 0.5, "Filaments", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Oval storms.
        storms: u32 = 5, "Storms", Unit::None, count(0, 7), Stage::Uniform;
        /// Half width of the great spot in radii of the planet; 0: none.
        spot_radii: f64 = 0.2, "Great spot", Unit::None, linear(0.0, 0.5), Stage::Uniform;
        /// Latitude of the great spot.
        spot_lat_deg: f64 = -22.0, "Latitude of the spot", Unit::Degrees, linear(-70.0, 70.0), Stage::Uniform;
        /// Colour of the great spot.
        spot_color: [f64; 3] = [0.52, 0.18, 0.07], "Colour of the spot", Unit::None, Domain::Color, Stage::Uniform;
        /// Seed of bands, eddies and storms.
        seed: u32 = 0, "Seed", Unit::None, Domain::Seed, Stage::Uniform;
    }
}

impl Planet {
    /// Parts of the planet that a giant does not have, because it has no ground; none unless the planet is a giant.
    pub(super) fn giant_problems(&self) -> impl Iterator<Item = (ParamPath, String)> {
        let grounds = [
            ("layers", !self.layers.is_empty()),
            ("edits", !self.edits.is_empty()),
            ("life", !self.life.is_empty()),
            ("structure", self.structure.is_some()),
            ("water", self.water.is_some()),
        ];
        let is_giant = self.giant.is_some();
        grounds.into_iter().filter(move |(_, has)| is_giant && *has).map(|(part, _)| {
            let message = format!("a gas giant has no ground; remove `{part}`, or `giant`");
            (ParamPath::default().join(part), message)
        })
    }
}

impl Planet {
    /// Whether the planet has a ground.
    ///
    /// # Errors
    /// A gas giant has none.
    pub fn check_ground(&self) -> Result<(), String> {
        match self.giant {
            Some(_) => Err(format!("{} is a gas giant: it has no ground", self.name)),
            None => Ok(()),
        }
    }
}

/// Giants to start from.
pub const STARTING_GIANTS: &[Starting<Giant>] = &[
    Starting::new("Banded", "Cream and rust, with a great spot, as Jupiter", Giant::default),
    Starting::new("Calm gold", "Broad pale bands under haze, as Saturn", gold),
    Starting::new("Ice giant", "Blue, almost without bands, as Neptune", ice),
    Starting::new("Hot", "Dark and violent, close to its star", hot),
];

fn gold() -> Giant {
    Giant {
        bands: 20,
        variation: 0.45,
        contrast: 0.45,
        zone_color: [0.74, 0.58, 0.34],
        belt_color: [0.44, 0.29, 0.14],
        accent_color: [0.62, 0.48, 0.30],
        pole_color: [0.36, 0.37, 0.33],
        jet_m_s: 400.0,
        turbulence: 0.35,
        eddy_radii: 0.06,
        filaments: 0.3,
        storms: 2,
        spot_radii: 0.0,
        ..Giant::default()
    }
}

fn ice() -> Giant {
    Giant {
        bands: 9,
        variation: 0.8,
        contrast: 0.4,
        zone_color: [0.20, 0.42, 0.68],
        belt_color: [0.09, 0.22, 0.52],
        accent_color: [0.30, 0.52, 0.72],
        pole_color: [0.16, 0.32, 0.55],
        jet_m_s: 350.0,
        turbulence: 0.5,
        eddy_radii: 0.12,
        filaments: 0.35,
        storms: 3,
        spot_radii: 0.13,
        spot_lat_deg: -19.0,
        spot_color: [0.04, 0.10, 0.30],
        ..Giant::default()
    }
}

fn hot() -> Giant {
    Giant {
        bands: 7,
        variation: 0.7,
        contrast: 0.9,
        zone_color: [0.30, 0.12, 0.09],
        belt_color: [0.06, 0.03, 0.05],
        accent_color: [0.42, 0.20, 0.08],
        pole_color: [0.05, 0.04, 0.07],
        jet_m_s: 800.0,
        turbulence: 2.2,
        eddy_radii: 0.16,
        filaments: 0.8,
        storms: 7,
        spot_radii: 0.0,
        ..Giant::default()
    }
}
