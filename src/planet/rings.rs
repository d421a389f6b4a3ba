//! Rings of a planet: dust and ice in the plane of its equator.

use super::param::{Curve, Domain, Stage, Unit, count, linear, log, params};
use super::starting::Starting;

/// Domain of the profile: the way from the inner to the outer edge, and a factor on the optical depth.
const PROFILE: Domain = Domain::Curve { most: 4.0, least_step: 0.001 };

params! {
    /// Rings in the plane of the equator.
    pub struct Rings {
        /// Radius of the inner edge, in radii of the planet.
        inner_radii: f64 = 1.25, "Inner edge", Unit::None, log(1.02, 20.0), Stage::Uniform;
        /// Width from the inner to the outer edge, in radii of the planet.
        width_radii: f64 = 1.05, "Width", Unit::None, log(0.01, 20.0), Stage::Uniform;
        /// Optical depth across the rings where they are as dense as the profile's 1: 0.1 is a veil, 2 hides what is
        /// behind.
        optical_depth: f64 = 1.1, "Optical depth", Unit::None, log(0.0, 10.0), Stage::Uniform;
        /// Density from the inner edge (0) to the outer edge (1). An empty profile has three rings with a division.
        profile: Curve = Curve::new(), "Profile", Unit::None, PROFILE, Stage::Uniform;
        /// How much the density varies from ringlet to ringlet.
        ringlets: f64 = 0.55, "Ringlets", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Width of the widest ringlets as a share of the width of the rings.
        ringlet_share: f64 = 0.12, "Ringlet width", Unit::None, log(0.005, 1.0), Stage::Uniform;
        /// Gaps that small moons keep clear.
        gaps: u32 = 4, "Gaps", Unit::None, count(0, 16), Stage::Uniform;
        /// Share of fine dust: it glows when the star is behind it, large pieces when the star is in front.
        dust: f64 = 0.08, "Dust", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Thickness of the rings, which shows from near. Saturn's are about 10 m thick.
        thickness_m: f64 = 50.0, "Thickness", Unit::Metres, log(1.0, 10_000.0), Stage::Uniform;
        /// Size of the largest pieces, which show from near. The number of pieces falls with the cube of their size.
        largest_m: f64 = 8.0, "Largest pieces", Unit::Metres, log(0.1, 200.0), Stage::Uniform;
        /// Colour of the inner edge (linear sRGB): the share of the light that the pieces scatter.
        inner_color: [f64; 3] = [0.42, 0.36, 0.29], "Inner colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Colour of the outer edge.
        outer_color: [f64; 3] = [0.78, 0.70, 0.58], "Outer colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Seed of ringlets, gaps and pieces.
        seed: u32 = 0, "Seed", Unit::None, Domain::Seed, Stage::Uniform;
    }
}

/// Rings to start from.
pub const STARTING_RINGS: &[Starting<Rings>] = &[
    Starting::new("Broad and bright", "Ice: three rings with a division, as Saturn's", Rings::default),
    Starting::new("Thin and dark", "A few narrow rings of coal-black pieces, as Uranus'", narrow),
    Starting::new("Dust", "A wide veil that glows against the star, as Jupiter's", dusty),
    Starting::new("Rubble", "A young ring of broken rock, red and dense", rubble),
];

fn narrow() -> Rings {
    Rings {
        inner_radii: 1.64,
        width_radii: 0.38,
        optical_depth: 1.2,
        profile: vec![
            [0.0, 0.0],
            [0.01, 0.4],
            [0.02, 0.0],
            [0.19, 0.0],
            [0.2, 0.5],
            [0.21, 0.0],
            [0.43, 0.0],
            [0.44, 0.7],
            [0.45, 0.0],
            [0.95, 0.0],
            [0.96, 1.4],
            [1.0, 1.0],
        ],
        ringlets: 0.3,
        gaps: 0,
        dust: 0.15,
        inner_color: [0.06, 0.06, 0.06],
        outer_color: [0.08, 0.08, 0.075],
        ..Rings::default()
    }
}

fn dusty() -> Rings {
    Rings {
        inner_radii: 1.3,
        width_radii: 1.6,
        optical_depth: 0.03,
        profile: vec![[0.0, 0.05], [0.25, 0.3], [0.3, 1.0], [0.36, 0.35], [1.0, 0.0]],
        ringlets: 0.1,
        gaps: 0,
        dust: 0.9,
        thickness_m: 3000.0,
        largest_m: 1.0,
        inner_color: [0.5, 0.42, 0.34],
        outer_color: [0.55, 0.46, 0.4],
        ..Rings::default()
    }
}

fn rubble() -> Rings {
    Rings {
        inner_radii: 1.5,
        width_radii: 0.6,
        optical_depth: 2.0,
        profile: vec![[0.0, 0.0], [0.1, 1.0], [0.8, 1.0], [1.0, 0.0]],
        ringlets: 0.8,
        ringlet_share: 0.06,
        gaps: 1,
        dust: 0.3,
        thickness_m: 120.0,
        largest_m: 25.0,
        inner_color: [0.34, 0.22, 0.15],
        outer_color: [0.42, 0.3, 0.21],
        ..Rings::default()
    }
}
