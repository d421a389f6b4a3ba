//! The kinds of terrain layer and the parameters of each. How a kind is evaluated stands in the file of the same
//! name in `terrain/landform`.
//!
//! A new kind: its parameters here, one line in the list of kinds, one file in `terrain/landform`. The list of names,
//! the panels, the file and the messages follow from these.

use super::kinds::kinds;
use super::param::{Domain, Stage, Unit, choice, count, linear, log, params};
use super::picture::{PictureFile, PictureLayout};

/// Writes the enum from the list of kinds, each of which is also the name of its parameters.
macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $kind:ident, )+) => {
        kinds! {
            /// The kind of terrain that this layer is made of.
            pub enum Shape: "shape", "Kind", Stage::Field;
            $( $(#[doc = $doc])+ $kind($kind), )+
        }
    };
}

shapes! {
    /// Rolling ground: octaves of gradient noise summed.
    Fbm,
    /// Mountain chains: octaves of noise folded into crests.
    Ridged,
    /// Impact craters of many sizes.
    Craters,
    /// Steps cut into the ground that the layers before have made.
    Terraces,
    /// Rounded hills between creased valleys: octaves of folded noise.
    Billow,
    /// Smooth valleys and rough peaks: octaves that count less where the ground is steep already.
    Damped,
    /// Swirling, folded ground: octaves summed at points displaced by other noise.
    Warped,
    /// Continents and oceans with shelves, slopes and abyssal plains: the base of most planets.
    Continents,
    /// Dunes: crests across the wind, gentle before it and steep behind.
    Dunes,
    /// Eroded mountains: gullies and ridges that run down the slope and branch.
    Gullies,
    /// Meandering valleys with flat floors, walls and tributaries.
    Canyons,
    /// Cells around scattered centres: plates, cracks or domes.
    Cells,
    /// Heights from a picture.
    HeightMap,
}

impl Shape {
    /// An amplitude that suits the kind at its default size: what a new layer begins with.
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

params! {
    /// Fractal Brownian motion: octaves of gradient noise, each finer and weaker than the one before, summed and
    /// divided by the sum of their strengths.
    pub struct Fbm {
        /// Distance from crest to crest of the coarsest octave.
        wavelength_km: f64 = 2000.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

params! {
    /// Ridged multifractal (Musgrave): noise folded at zero into crests; each octave is strong where the one before
    /// was, so that valleys stay smooth and crests grow sharp. Shifted to about -1 (valley) to 1 (crest).
    pub struct Ridged {
        /// Distance between neighbouring ranges of the coarsest octave.
        wavelength_km: f64 = 800.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// How much a crest of one octave strengthens the next: 0 is rough everywhere, 2 keeps valleys smooth.
        feedback: f64 = 2.0, "Feedback", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Impact craters: bowls with a raised rim, from -1 (floor) to about 0.3 (rim); each octave is a smaller size.
    pub struct Craters {
        /// Diameter of the widest craters.
        diameter_km: f64 = 200.0, "Diameter", Unit::Kilometres, log(0.001, 50_000.0), Stage::Field;
        /// How many sizes there are; each one more halves the smallest crater (at lacunarity 2).
        octaves: u32 = 7, "Octaves", Unit::None, count(1, 20), Stage::Field;
        /// Depth of each size against the one before.
        gain: f64 = 0.55, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Smallness of each size against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Share of the ground that has been hit, for each size; with a power of counts, by the widest.
        density: f64 = 0.7, "Density", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How much more numerous craters are the smaller they are: the power of their cumulative count, about 2.4 on
        /// moons, until the ground is full of them. At 0 the sizes are mixed evenly.
        power: f64 = 2.4, "Power of counts", Unit::None, linear(0.0, 4.0), Stage::Field;
        /// Height of the rim against the depth of the bowl.
        rim: f64 = 0.28, "Rim", Unit::None, linear(0.0, 0.6), Stage::Field;
        /// How far the ejecta reach, in radii of the crater.
        ejecta: f64 = 1.6, "Ejecta", Unit::None, linear(1.1, 1.6), Stage::Field;
        /// How much of the radius of the widest craters is flat floor; small craters are bowls.
        floor: f64 = 0.45, "Flat floor", Unit::None, linear(0.0, 0.8), Stage::Field;
        /// Height of the peak in the middle of the widest craters against their depth.
        peak: f64 = 0.3, "Central peak", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How worn the oldest craters are: shallow, without a rim. Each crater has its own age up to this.
        age: f64 = 0.7, "Age", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Share of craters that are fresh whatever the age of the rest.
        fresh: f64 = 0.1, "Fresh", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// Terraces: the height made by the layers before is cut into flat treads with steep risers between them, one step
    /// for each `amplitude_m`. The layer's noise is the way from that height to its step, -0.5 to 0.5, so that it
    /// belongs with the blend Add. Masks on it look at the noise of its waviness.
    pub struct Terraces {
        /// How flat the treads are and how steep the risers: 0 leaves the ground as it is, 1 makes stairs.
        sharpness: f64 = 0.8, "Sharpness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// How far noise raises and lowers the steps, as a share of a step.
        waviness: f64 = 0.5, "Waviness", Unit::None, linear(0.0, 4.0), Stage::Height;
        /// Distance from crest to crest of that noise's coarsest octave.
        wavelength_km: f64 = 30.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves that noise has; each one more halves the smallest feature.
        octaves: u32 = 4, "Octaves", Unit::None, count(1, 24), Stage::Field;
    }
}

params! {
    /// Billow noise: each octave folded at zero, the other way round than `Ridged`, so that hills are round and the
    /// valleys between them creases. From -1 (valleys) to 1 (tops).
    pub struct Billow {
        /// Distance between neighbouring hills of the coarsest octave.
        wavelength_km: f64 = 100.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 8, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.4, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

params! {
    /// Slope-damped fractal noise (Quilez): an octave counts less where those before it have made the ground
    /// steep, as if rain had worn the slopes down into wide, smooth valleys below rough peaks. About -1 to 1;
    /// damping lowers the mean.
    pub struct Damped {
        /// Distance from crest to crest of the coarsest octave.
        wavelength_km: f64 = 400.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// How strongly slope smooths: 0 is plain fractal noise.
        damping: f64 = 0.12, "Damping", Unit::None, log(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Fractal noise at points displaced by another fractal noise, which draws its features out into swirls
    /// and folds. About -1 to 1.
    pub struct Warped {
        /// Distance from crest to crest of the coarsest octave.
        wavelength_km: f64 = 1000.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 12, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// How far points are displaced.
        warp_km: f64 = 300.0, "Warp", Unit::Kilometres, log(0.0, 100_000.0), Stage::Field;
        /// Distance over which the displacement changes.
        warp_wavelength_km: f64 = 1000.0, "Warp wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves the displacement has: 1 bends, more curl and fray.
        warp_octaves: u32 = 3, "Warp octaves", Unit::None, count(1, 8), Stage::Field;
    }
}

params! {
    /// Continents and oceans: warped fractal noise, put through a profile with shares of the surface as on the
    /// Earth. -1 is the abyssal plain, 0 the coast; a continental slope leads up to the shelf, a coastal plain
    /// to the interior, up to 1.
    pub struct Continents {
        /// Size of the continents.
        wavelength_km: f64 = 5500.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves are summed; each one more halves the smallest feature (at lacunarity 2).
        octaves: u32 = 14, "Octaves", Unit::None, count(1, 24), Stage::Field;
        /// Strength of each octave against the one before: higher frays the coasts and scatters islands.
        gain: f64 = 0.56, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Displacement of the coasts against the wavelength: 0 is blobs, more draws out peninsulas, gulfs and straits.
        warp: f64 = 0.3, "Warp", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Share of the surface that lies above 0.
        land: f64 = 0.32, "Land", Unit::None, linear(0.02, 0.98), Stage::Field;
        /// Share of the sea floor that is shallow shelf.
        shelf: f64 = 0.2, "Shelf", Unit::None, linear(0.01, 0.6), Stage::Field;
    }
}

params! {
    /// Dunes: crests that stand across the wind, fork and end as real ones do, from -1 (trough) to 1 (crest).
    pub struct Dunes {
        /// Distance from crest to crest of the largest dunes.
        wavelength_km: f64 = 1.5, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many sizes of dunes ride on one another.
        octaves: u32 = 2, "Octaves", Unit::None, count(1, 8), Stage::Field;
        /// Height of each size against the one before.
        gain: f64 = 0.2, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Smallness of each size against the one before.
        lacunarity: f64 = 4.0, "Lacunarity", Unit::None, linear(1.5, 10.0), Stage::Field;
        /// Heading towards which the wind blows: 0 is north, 90 east.
        wind_deg: f64 = 90.0, "Wind", Unit::Degrees, linear(-180.0, 360.0), Stage::Field;
        /// How much steeper the lee is than the side before the wind: 0 is as steep, 1 breaks off at a sharp crest.
        asymmetry: f64 = 0.8, "Asymmetry", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How far the crests bend to and fro.
        waviness: f64 = 0.5, "Waviness", Unit::None, linear(0.0, 2.0), Stage::Field;
    }
}

params! {
    /// Mountains as running water carves them: smooth relief, and gullies that run down its slopes and branch.
    pub struct Gullies {
        /// Distance from crest to crest of the relief that is carved.
        wavelength_km: f64 = 60.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves the relief has. Those much coarser than the gullies lead them; finer
        /// ones roughen the ground.
        octaves: u32 = 2, "Octaves", Unit::None, count(1, 16), Stage::Field;
        /// Strength of each octave, of the relief as of the gullies, against the one before.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave, of the relief as of the gullies, against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Distance between neighbouring gullies of the coarsest kind.
        gully_km: f64 = 8.0, "Gullies", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many octaves of gullies branch off one another.
        gully_octaves: u32 = 5, "Gully octaves", Unit::None, count(1, 16), Stage::Field;
        /// How deep the gullies are against their width: 1 is about as steep as the relief.
        depth: f64 = 1.0, "Depth", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}

params! {
    /// Valleys along the zero lines of warped noise: 0 outside them, -1 on the floor of the largest.
    pub struct Canyons {
        /// Distance between the largest valleys.
        wavelength_km: f64 = 200.0, "Wavelength", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// How many sizes of valley there are: 1 is the largest alone, each one more adds tributaries.
        octaves: u32 = 3, "Octaves", Unit::None, count(1, 12), Stage::Field;
        /// Depth of tributaries against the valleys that they lead to.
        gain: f64 = 0.6, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Smallness of tributaries, in width and distance, against the valleys that they lead to.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
        /// Width of the largest valleys from rim to rim.
        width_km: f64 = 8.0, "Width", Unit::Kilometres, log(0.001, 10_000.0), Stage::Field;
        /// Share of the width that is flat floor: 0 is a valley like a V, near 1 a trench between cliffs.
        steepness: f64 = 0.35, "Steepness", Unit::None, linear(0.0, 0.95), Stage::Field;
        /// How far the valleys wind: 0 is nearly straight.
        meander: f64 = 0.5, "Meander", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// Cells: each point of the ground belongs to the nearest of many scattered centres.
    pub struct Cells {
        /// Distance between neighbouring centres of the coarsest octave, on average.
        cell_km: f64 = 800.0, "Cell size", Unit::Kilometres, log(0.001, 100_000.0), Stage::Field;
        /// What is made of the cells.
        style: CellStyle = CellStyle::Plates, "Style", Unit::None, Domain::Choice, Stage::Field;
        /// Width of the slopes between plates, or of the cracks, in cells. Domes have none.
        width: f64 = 0.2, "Border width", Unit::None, log(0.005, 1.0), Stage::Field;
        /// How irregular the cells are: at 0 the centres stand in rows.
        jitter: f64 = 1.0, "Jitter", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How many octaves are summed, each of smaller cells.
        octaves: u32 = 1, "Octaves", Unit::None, count(1, 12), Stage::Field;
        /// Strength of each octave against the one before: higher is rougher.
        gain: f64 = 0.5, "Gain", Unit::None, linear(0.05, 0.95), Stage::Field;
        /// Fineness of each octave against the one before.
        lacunarity: f64 = 2.0, "Lacunarity", Unit::None, linear(1.5, 4.0), Stage::Field;
    }
}

choice! {
    /// What is made of cells.
    pub enum CellStyle {
        /// Each cell is a plain at a random level, -1 to 1, and slopes join them.
        Plates = "Plates",
        /// The borders are cracks, from 0 (the ground) down to -1.
        Cracks = "Cracks",
        /// Each cell is a dome, from 1 (its top) down to about 0 where it meets the next.
        Bumps = "Bumps",
    }
}

params! {
    /// A height map: a grey picture of the whole planet, smoothed by about one of its pixels. Without a picture it is 0
    /// everywhere.
    pub struct HeightMap {
        /// The picture: PNG (8 or 16 bits; black is 0, white is 1) or OpenEXR (channel Y, or else L, R or the first;
        /// numbers as they are), of at most 16384 x 8192 pixels. The path counts from the preset's folder.
        file: PictureFile = PictureFile::default(), "File", Unit::None, Domain::File { max_chars: 256 }, Stage::Field;
        /// How the picture covers the planet. Equirectangular: twice as wide as high, north up, longitude 0 in the
        /// middle. CubeCross: 4 x 3 squares; -Y, +X, +Y, -X in the middle row, +Z above and -Z below +X. CubeStrip: the
        /// same squares in one row or column, in the order +X, -X, +Y, -Y, +Z, -Z. +X is at longitude 0, +Y at 90°
        /// east, +Z at the north pole; faces are seen from outside, as flat 90° pictures.
        layout: PictureLayout = PictureLayout::Equirectangular, "Layout", Unit::None, Domain::Choice, Stage::Field;
        /// What black (0) means, as a value of this layer.
        low: f64 = 0.0, "Black", Unit::None, linear(-1.0, 1.0), Stage::Field;
        /// What white (1) means, as a value of this layer.
        high: f64 = 1.0, "White", Unit::None, linear(-1.0, 1.0), Stage::Field;
    }
}
