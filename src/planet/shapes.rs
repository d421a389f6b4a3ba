//! The landforms, the kinds of terrain layer, and the parameters of each. `terrain/landform` evaluates them, in files
//! of the same names.
//!
//! A new landform needs its parameters and a line in the list here, and a file in `terrain/landform`. Panels, file
//! format and messages follow.

use super::kinds::kinds;
use super::param::{Domain, Stage, Unit, choice, count, linear, log, params};
use super::picture::{PictureFile, PictureLayout};

/// Writes the enum from the list of landforms. Each name is also the name of a struct of parameters.
macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $kind:ident = $label:literal, )+) => {
        kinds! {
            /// The landform of the layer.
            pub enum Shape: "shape", "Kind", Stage::Field;
            $( $(#[doc = $doc])+ $kind($kind) = $label, )+
        }
    };
}

shapes! {
    /// Rolling ground: octaves of gradient noise summed.
    Fbm = "Fractal noise",
    /// Mountain chains: octaves of noise folded into crests.
    Ridged = "Ridges",
    /// Impact craters of many sizes.
    Craters = "Craters",
    /// Steps cut into the ground of the earlier layers.
    Terraces = "Terraces",
    /// Rounded hills between creased valleys: octaves of folded noise.
    Billow = "Billow",
    /// Smooth valleys and rough peaks: octaves that are weaker where the ground is steep.
    Damped = "Slope-damped noise",
    /// Swirling, folded ground: octaves summed at points displaced by other noise.
    Warped = "Warped noise",
    /// Continents and oceans with shelves, slopes and abyssal plains: the base of most planets.
    Continents = "Continents",
    /// Dunes: crests across the wind, gentle on the windward side and steep on the lee.
    Dunes = "Dunes",
    /// Eroded mountains: gullies and ridges that run down the slope and branch.
    Gullies = "Gullies",
    /// Meandering valleys with flat floors, walls and tributaries.
    Canyons = "Canyons",
    /// Cells around scattered centres: plates, cracks or domes.
    Cells = "Cells",
    /// Heights from a picture.
    HeightMap = "Height map",
}

/// Writes the parameters of a landform that sums octaves of lacunarity 2: those before the octaves, the three of the
/// octaves with these defaults, and the rest.
macro_rules! octaves {
    (
        $(#[doc = $doc:literal])+
        pub struct $name:ident: $octaves:literal octaves, gain $gain:literal { $($before:tt)* } then { $($rest:tt)* }
    ) => {
        params! {
            $(#[doc = $doc])+
            pub struct $name {
                $($before)*
                /// Number of octaves; each further one halves the smallest feature (at lacunarity 2).
                octaves: u32 = $octaves, "Octaves", Unit::None, count(1, 24), Stage::Field;
                /// Amplitude of each octave relative to the previous one: higher is rougher.
                gain: f64 = $gain, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
                /// Frequency of each octave relative to the previous one.
                lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
                $($rest)*
            }
        }
    };
}

impl Shape {
    /// The amplitude of a new layer, which suits the default size of the landform.
    pub fn usual_amplitude_m(&self) -> f64 {
        match self {
            Shape::Continents(_) | Shape::HeightMap(_) => 5000.0,
            Shape::Craters(_) => 4000.0,
            Shape::Gullies(_) | Shape::Canyons(_) => 2000.0,
            Shape::Billow(_) | Shape::Terraces(_) => 300.0,
            Shape::Dunes(_) => 50.0,
            Shape::Fbm(_) | Shape::Ridged(_) | Shape::Damped(_) | Shape::Warped(_) | Shape::Cells(_) => 1000.0,
        }
    }
}

octaves! {
    /// Fractal Brownian motion: octaves of gradient noise, each finer and weaker than the previous one, summed and
    /// divided by the sum of their amplitudes.
    pub struct Fbm: 12 octaves, gain 0.5 {
        /// Wavelength of the coarsest octave.
        wavelength_km: f64 = 2000.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
    } then {}
}

octaves! {
    /// Ridged multifractal (Musgrave): noise folded at zero into crests. Each octave is scaled by the previous one, so
    /// that valleys stay smooth and crests grow sharp. From about -1 (valley) to 1 (crest).
    pub struct Ridged: 12 octaves, gain 0.5 {
        /// Distance between neighbouring ranges of the coarsest octave.
        wavelength_km: f64 = 800.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
    } then {
        /// How much a crest of one octave amplifies the next: 0 is rough everywhere, 2 keeps valleys smooth.
        feedback: f64 = 2.0, "Feedback", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Impact craters: bowls with a raised rim, from -1 (floor) to about 0.3 (rim); each octave is a smaller size.
    pub struct Craters {
        /// Diameter of the widest craters.
        diameter_km: f64 = 200.0, "Diameter", Unit::Kilometres, log(0.001, 50_000.0), Stage::Field;
        /// Number of sizes; each further one halves the smallest crater (at lacunarity 2).
        octaves: u32 = 7, "Octaves", Unit::None, count(1, 20), Stage::Field;
        /// Depth of each size relative to the previous one.
        gain: f64 = 0.55, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Frequency of each size relative to the previous one.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Share of the ground covered by craters of each size; with a power of counts, by those of the widest size.
        density: f64 = 0.7, "Density", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Exponent of the cumulative count of craters by diameter, about 2.4 on moons; counts stop where the ground is
        /// full. At 0 every size covers an equal share.
        power: f64 = 2.4, "Size distribution", Unit::None, linear(0.0, 4.0), Stage::Field;
        /// Height of the rim relative to the depth of the bowl.
        rim: f64 = 0.28, "Rim height", Unit::None, linear(0.0, 0.6), Stage::Field;
        /// Reach of the ejecta in crater radii.
        ejecta: f64 = 1.6, "Ejecta reach", Unit::None, linear(1.1, 1.6), Stage::Field;
        /// Share of the radius that is flat floor in the widest craters; small craters are bowls.
        floor: f64 = 0.45, "Flat floor", Unit::None, linear(0.0, 0.8), Stage::Field;
        /// Height of the central peak of the widest craters relative to their depth.
        peak: f64 = 0.3, "Central peak", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Erosion of the oldest craters, which are shallow and rimless at 1. Each crater has its own age up to this.
        age: f64 = 0.7, "Erosion", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Share of craters that are fresh, whatever the age of the others.
        fresh: f64 = 0.1, "Fresh craters", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// Terraces: cuts the height of the earlier layers into flat treads with steep risers, one step for each
    /// `amplitude_m`. The layer's value is the difference from that height to its step, -0.5 to 0.5, so the blend
    /// should be Add. Masks that refer to the layer read the noise of its waviness.
    pub struct Terraces {
        /// Flatness of the treads and steepness of the risers: 0 changes nothing, 1 makes stairs.
        sharpness: f64 = 0.8, "Sharpness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// How far noise raises and lowers the steps, as a share of a step's height.
        waviness: f64 = 0.5, "Waviness", Unit::None, linear(0.0, 4.0), Stage::Height;
        /// Wavelength of the coarsest octave of that noise.
        wavelength_km: f64 = 30.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of octaves of that noise; each further one halves the smallest feature.
        octaves: u32 = 4, "Octaves", Unit::None, count(1, 24), Stage::Field;
    }
}

octaves! {
    /// Billow noise: each octave is folded at zero like `Ridged`, but upside down, so that hills are round and the
    /// valleys between them are creases. From -1 (valleys) to 1 (tops).
    pub struct Billow: 8 octaves, gain 0.4 {
        /// Distance between neighbouring hills of the coarsest octave.
        wavelength_km: f64 = 100.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
    } then {}
}

octaves! {
    /// Slope-damped fractal noise (Quilez): an octave is weaker where the previous octaves are steep, which leaves
    /// wide, smooth valleys below rough peaks. About -1 to 1; damping lowers the mean.
    pub struct Damped: 12 octaves, gain 0.5 {
        /// Wavelength of the coarsest octave.
        wavelength_km: f64 = 400.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
    } then {
        /// Strength of the damping by slope: 0 is plain fractal noise.
        damping: f64 = 0.12, "Damping", Unit::None, log(0.0, 4.0), Stage::Field;
    }
}

octaves! {
    /// Fractal noise at points that another fractal noise displaces into swirls and folds. About -1 to 1.
    pub struct Warped: 12 octaves, gain 0.5 {
        /// Wavelength of the coarsest octave.
        wavelength_km: f64 = 1000.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
    } then {
        /// How far points are displaced.
        warp_km: f64 = 300.0, "Warp", Unit::Kilometres, log(0.0, 100_000.0), Stage::Field;
        /// Distance over which the displacement changes.
        warp_wavelength_km: f64 = 1000.0, "Warp wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of octaves of the displacement: 1 bends the terrain, more curl and fray it.
        warp_octaves: u32 = 3, "Warp octaves", Unit::None, count(1, 8), Stage::Field;
    }
}

params! {
    /// Continents and oceans: warped fractal noise, mapped through a profile whose shares of the surface are like the
    /// Earth's. -1 is the abyssal plain, 0 the coast, 1 the highest interior. A continental slope leads up to the
    /// shelf, a coastal plain to the interior.
    pub struct Continents {
        /// Size of the continents.
        wavelength_km: f64 = 5500.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of octaves; each further one halves the smallest feature (at lacunarity 2).
        octaves: u32 = 14, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Amplitude of each octave relative to the previous one: higher frays the coasts and scatters islands.
        gain: f64 = 0.56, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Frequency of each octave relative to the previous one.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Displacement of the coasts relative to the wavelength: 0 makes blobs, more makes peninsulas, gulfs and
        /// straits.
        warp: f64 = 0.3, "Warp", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Share of the surface that lies above 0.
        land: f64 = 0.32, "Land", Unit::None, linear(0.02, 0.98), Stage::Field;
        /// Share of the sea floor that is shallow shelf.
        shelf: f64 = 0.2, "Shelf", Unit::None, linear(0.01, 0.6), Stage::Field;
    }
}

params! {
    /// Dunes: crests across the wind that fork and end, from -1 (trough) to 1 (crest).
    pub struct Dunes {
        /// Distance from crest to crest of the largest dunes.
        wavelength_km: f64 = 1.5, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of sizes of dunes; smaller ones lie on larger ones.
        octaves: u32 = 2, "Octaves", Unit::None, count(1, 8), Stage::Field;
        /// Height of each size relative to the previous one.
        gain: f64 = 0.2, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Frequency of each size relative to the previous one.
        lacunarity: f64 = 4.0, "Lacunarity", Unit::None, linear(1.5, 10.0), Stage::Field;
        /// Heading towards which the wind blows: 0 is north, 90 east.
        wind_deg: f64 = 90.0, "Wind", Unit::Degrees, linear(-180.0, 360.0), Stage::Field;
        /// Whether the dunes follow the wind of the planet's weather instead of that heading. It takes a structure, and
        /// a layer that lies over it.
        follow_wind: bool = false, "Follow the wind", Unit::None, Domain::Flag, Stage::Field;
        /// Steepness of the lee relative to the windward side: 0 is equal, 1 is a sharp crest with a steep lee.
        asymmetry: f64 = 0.8, "Asymmetry", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How far the crests bend.
        waviness: f64 = 0.5, "Waviness", Unit::None, linear(0.0, 2.0), Stage::Field;
    }
}

params! {
    /// Mountains carved by running water: a smooth base, and gullies that run down its slopes and branch.
    pub struct Gullies {
        /// Wavelength of the base that is carved.
        wavelength_km: f64 = 60.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of octaves of the base. Octaves much coarser than the gullies direct them; finer ones roughen the
        /// ground.
        octaves: u32 = 2, "Octaves", Unit::None, count(1, 16), Stage::Field;
        /// Amplitude of each octave of base and gullies relative to the previous one.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Frequency of each octave of base and gullies relative to the previous one.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Distance between neighbouring gullies of the coarsest octave.
        gully_km: f64 = 8.0, "Gully spacing", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of octaves of gullies; each branches off the previous one.
        gully_octaves: u32 = 5, "Gully octaves", Unit::None, count(1, 16), Stage::Field;
        /// Depth of the gullies relative to their width: at 1 they are about as steep as the base.
        depth: f64 = 1.0, "Depth", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Valleys along the zero lines of warped noise: 0 outside the valleys, -1 on the floor of the largest.
    pub struct Canyons {
        /// Distance between the largest valleys.
        wavelength_km: f64 = 200.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Number of sizes of valleys: 1 is only the largest, each further one adds tributaries.
        octaves: u32 = 3, "Octaves", Unit::None, count(1, 12), Stage::Field;
        /// Depth of tributaries relative to the valleys that they join.
        gain: f64 = 0.6, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// How many times smaller tributaries are, in width and distance, than the valleys that they join.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Width of the largest valleys from rim to rim.
        width_km: f64 = 8.0, "Width", Unit::Kilometres, log(0.001, 10_000.0), Stage::Field;
        /// Share of the width that is flat floor: 0 is a V-shaped valley, near 1 a trench between cliffs.
        steepness: f64 = 0.35, "Floor share", Unit::None, linear(0.0, 0.95), Stage::Field;
        /// Strength of the meanders: 0 is nearly straight.
        meander: f64 = 0.5, "Meander", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// Cells: each point belongs to the nearest of many scattered centres.
    pub struct Cells {
        /// Distance between neighbouring centres of the coarsest octave, on average.
        cell_km: f64 = 800.0, "Cell size", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// Plates, cracks or domes.
        style: CellStyle = CellStyle::Plates, "Style", Unit::None, Domain::Choice, Stage::Field;
        /// Width of the slopes between plates, or of the cracks, in cells. Bumps ignore it.
        width: f64 = 0.2, "Border width", Unit::None, log(0.005, 1.0), Stage::Field;
        /// Irregularity of the cells: at 0 the centres are a regular grid.
        jitter: f64 = 1.0, "Jitter", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Number of octaves, each of smaller cells.
        octaves: u32 = 1, "Octaves", Unit::None, count(1, 12), Stage::Field;
        /// Amplitude of each octave relative to the previous one: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Frequency of each octave relative to the previous one.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

choice! {
    /// The form of the cells.
    pub enum CellStyle {
        /// Each cell is a plain at a random level, -1 to 1; slopes connect them.
        Plates = "Plates",
        /// The borders are cracks, from 0 (ground) down to -1.
        Cracks = "Cracks",
        /// Each cell is a dome, from 1 (top) down to about 0 at the border.
        Bumps = "Bumps",
    }
}

params! {
    /// A height map: a grey picture of the whole planet, smoothed by about one pixel. Without a picture it is 0
    /// everywhere.
    pub struct HeightMap {
        /// The picture: PNG (8 or 16 bits; black is 0, white is 1) or OpenEXR (channel Y, or else L, R or the first;
        /// unscaled), of at most 16384 x 8192 pixels. The path is relative to the preset's folder, or absolute.
        file: PictureFile = PictureFile::default(), "File", Unit::None, Domain::File { max_chars: 256 }, Stage::Field;
        /// How the picture covers the planet. Equirectangular: twice as wide as high, north up, longitude 0 in the
        /// middle. CubeCross: 4 x 3 squares; -Y, +X, +Y, -X in the middle row, +Z above and -Z below +X. CubeStrip: the
        /// six squares in one row or column, in the order +X, -X, +Y, -Y, +Z, -Z. +X is at longitude 0, +Y at 90°
        /// east, +Z at the north pole. Each face is a flat 90° view from outside.
        layout: PictureLayout = PictureLayout::Equirectangular, "Layout", Unit::None, Domain::Choice, Stage::Field;
        /// Value of the layer where the picture is black (0).
        low: f64 = 0.0, "Black", Unit::None, linear(-1.0, 1.0), Stage::Field;
        /// Value of the layer where the picture is white (1).
        high: f64 = 1.0, "White", Unit::None, linear(-1.0, 1.0), Stage::Field;
    }
}
