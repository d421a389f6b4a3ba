//! The tools of ground edits and their parameters. Formulas are in `terrain::edits::tool`, one file each: `t` is the
//! distance from the line or the middle in radii, `w` falls from 1 to 0 over the softness.

use crate::planet::biome::UNSET_KEY;
use crate::planet::kinds::kinds;
use crate::planet::masks::FIRST_PAINTED;
use crate::planet::param::{Domain, Stage, Unit, choice, count, linear, log, params};
use crate::planet::picture::PictureFile;

kinds! {
    /// What an edit does to the ground.
    pub enum Tool: "tool", "Tool", Stage::Height;
    /// Raises the ground, or lowers it.
    Raise(Raise) = "Raise or lower",
    /// Brings the ground to one height.
    Flatten(Flatten) = "Flatten",
    /// Adds hills and hollows.
    Roughen(Roughen) = "Roughen",
    /// Cuts level steps.
    Terrace(Terrace) = "Terrace",
    /// A bowl with a rim and ejecta around it; with a wide floor, an impact basin.
    Crater(Crater) = "Crater",
    /// A cone or a shield with a caldera.
    Volcano(Volcano) = "Volcano",
    /// A table mountain with cliffs over talus.
    Mesa(Mesa) = "Mesa",
    /// Land that rises out of the sea.
    Island(Island) = "Island",
    /// The ground of a height picture: a mountain, a city, a logo.
    Picture(PictureStamp) = "Picture",
    /// A crest along a line.
    Ridge(Ridge) = "Ridge",
    /// A valley with steep walls along a line.
    Canyon(Canyon) = "Canyon",
    /// A bed along a line, at the heights of its points.
    Road(Road) = "Road",
    /// Smooths away what is finer than a part of the brush.
    Smooth(Smooth) = "Smooth",
    /// Carves gullies down the slopes, as running water does.
    Hydraulic(Hydraulic) = "Hydraulic erosion",
    /// Crumbles what stands out, and fills hollows with it, as frost does.
    Thermal(Thermal) = "Thermal erosion",
    /// A rampart or dam with a level top along a line.
    Wall(Wall) = "Wall",
    /// A step in the ground along a line: the left side rises, the right side sinks.
    Fault(Fault) = "Fault",
    /// A coast along a line: land on the left side, sea on the right.
    Coast(Coast) = "Coast",
    /// Paints how wet the climate is.
    Moisture(MoisturePaint) = "Moisture",
    /// Paints how warm the climate is.
    Temperature(TemperaturePaint) = "Temperature",
    /// Paints a biome: the climate that it has in the biome table.
    Biome(BiomePaint) = "Biome",
    /// Paints where clouds gather and where the sky clears. Clouds drift through the painted places.
    Clouds(CloudPaint) = "Clouds",
    /// Paints a mask: layers and edits that name it act where it is painted.
    Mask(MaskPaint) = "Mask",
    /// Paints how far rock rises while the rivers of the structure carve it: a range with valleys, or land out of the
    /// sea.
    Uplift(UpliftPaint) = "Uplift",
    /// Paints how hard the rock is that the rivers of the structure carve: hard rock stands high and steep.
    Rock(RockPaint) = "Rock hardness",
    /// Paints rain of the structure's weather: rivers grow, lakes fill, biomes follow.
    Rain(RainPaint) = "Rain",
    /// The course of a river of the structure, from its spring to its mouth: it carves its valley along the line.
    River(RiverCourse) = "River",
    /// Paints what stands on the ground: clears it, or plants it. Nothing stands in water that may not.
    Life(LifePaint) = "Life",
    /// An object of a population at each point: a tree, a stone. It stands wherever it is put.
    Object(PlacedObject) = "Object",
}

impl Tool {
    /// Whether the tool acts around each of its points alone, and not along the line through them.
    pub fn is_stamp(&self) -> bool {
        matches!(self, Tool::Crater(_) | Tool::Volcano(_) | Tool::Mesa(_) | Tool::Island(_) | Tool::Picture(_))
            || matches!(self, Tool::Object(_))
    }

    /// Whether the tool reads the ground around a point, as earlier edits left it.
    pub fn reads_ground(&self) -> bool {
        matches!(self, Tool::Smooth(_) | Tool::Hydraulic(_) | Tool::Thermal(_))
    }

    /// Whether the tool acts along a line that is drawn point by point.
    pub fn is_line(&self) -> bool {
        matches!(
            self,
            Tool::Ridge(_)
                | Tool::Canyon(_)
                | Tool::Road(_)
                | Tool::Wall(_)
                | Tool::Fault(_)
                | Tool::Coast(_)
                | Tool::River(_)
        )
    }

    /// Whether the tool leaves the ground under it as it is: it paints the climate, the clouds, a mask of
    /// layers, what stands on the ground or the structure.
    pub fn is_paint(&self) -> bool {
        matches!(self, Tool::Moisture(_) | Tool::Temperature(_) | Tool::Biome(_) | Tool::Clouds(_))
            || matches!(self, Tool::Mask(_) | Tool::Life(_) | Tool::Object(_))
            || self.is_structural()
    }

    /// Whether a painted mask limits edits with the tool.
    pub fn reads_mask(&self) -> bool {
        !matches!(self, Tool::Mask(_) | Tool::River(_))
    }

    /// Whether the tool changes what the structure is solved from: its rivers answer. Without a structure it does
    /// nothing.
    pub fn is_structural(&self) -> bool {
        matches!(self, Tool::Uplift(_) | Tool::Rock(_) | Tool::Rain(_) | Tool::River(_))
    }
}

params! {
    /// `h + amount_m * w`
    pub struct Raise {
        /// Height by which the ground is raised; negative lowers it.
        amount_m: f64 = 500.0, "Amount", Unit::Metres, linear(-20_000.0, 20_000.0), Stage::Height;
    }
}

params! {
    /// `h + (height_m - h) * strength * w`
    pub struct Flatten {
        /// Height to which the ground is brought, above the reference sphere.
        height_m: f64 = 0.0, "Height", Unit::Metres, linear(-20_000.0, 20_000.0), Stage::Height;
        /// Share of the way to that height.
        strength: f64 = 1.0, "Strength", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// `h + amplitude_m * noise * w`
    pub struct Roughen {
        /// Height of the hills.
        amplitude_m: f64 = 200.0, "Amplitude", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
        /// Size of the largest hills.
        wavelength_km: f64 = 10.0, "Wavelength", Unit::Kilometres, log(0.001, 1000.0), Stage::Height;
    }
}

params! {
    /// `h + (steps(h) - h) * strength * w`
    pub struct Terrace {
        /// Height of a step.
        step_m: f64 = 200.0, "Step", Unit::Metres, log(0.1, 5000.0), Stage::Height;
        /// How steep the risers are: 0 is a gentle wave, 1 a cliff.
        sharpness: f64 = 0.7, "Sharpness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// Share of the way to the steps.
        strength: f64 = 1.0, "Strength", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// In the middle `h - depth_m + peak_m`, at the rim `h + rim_m`; ejecta end two radii out.
    pub struct Crater {
        /// Depth of the floor below the ground around it.
        depth_m: f64 = 1500.0, "Depth", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
        /// Height of the rim.
        rim_m: f64 = 400.0, "Rim", Unit::Metres, log(0.0, 10_000.0), Stage::Height;
        /// Share of the radius that is level floor: small craters are bowls, basins have wide floors.
        floor: f64 = 0.3, "Floor", Unit::None, linear(0.0, 0.9), Stage::Height;
        /// Height of the peak in the middle above the floor.
        peak_m: f64 = 0.0, "Central peak", Unit::Metres, log(0.0, 10_000.0), Stage::Height;
    }
}

params! {
    /// With `f` the profile of the cone, in the middle `h + height_m * f(caldera) - caldera_m`.
    pub struct Volcano {
        /// Height of the cone without its caldera.
        height_m: f64 = 3000.0, "Height", Unit::Metres, log(0.0, 30_000.0), Stage::Height;
        /// Shape of the flanks: 0 is a shield, 1 a cone that steepens to the top.
        steepness: f64 = 0.7, "Steepness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// Radius of the caldera as a share of the radius.
        caldera: f64 = 0.12, "Caldera", Unit::None, linear(0.0, 0.6), Stage::Height;
        /// Depth of the caldera below its edge.
        caldera_m: f64 = 400.0, "Caldera depth", Unit::Metres, log(0.0, 10_000.0), Stage::Height;
    }
}

params! {
    /// `h + height_m` on the top; cliffs and talus over the softness.
    pub struct Mesa {
        /// Height of the top above the ground below it.
        height_m: f64 = 600.0, "Height", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
        /// Share of the height that is talus below the cliffs.
        talus: f64 = 0.4, "Talus", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// In the middle the height above the sea, or the ground as it was where that is higher.
    pub struct Island {
        /// Height of the middle above the sea.
        height_m: f64 = 800.0, "Height", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
        /// Depth of its foot below the sea.
        foot_m: f64 = 800.0, "Foot", Unit::Metres, log(1.0, 10_000.0), Stage::Height;
    }
}

params! {
    /// `h + height_m * (value - level) * w`: the longer side of the picture is the diameter, its corners are cut off.
    pub struct PictureStamp {
        /// The picture, of any shape: PNG (8 or 16 bits; black is 0, white is 1) or OpenEXR (channel Y, or else L, R or
        /// the first; unscaled). It is smoothed by about one pixel. The path is relative to the preset's folder, or
        /// absolute.
        file: PictureFile = PictureFile::default(), "File", Unit::None, Domain::File { max_chars: 256 }, Stage::Height;
        /// Height of white above black; negative turns mountains into basins.
        height_m: f64 = 1500.0, "Height", Unit::Metres, linear(-20_000.0, 20_000.0), Stage::Height;
        /// Value of the picture that leaves the ground as it is: 0 for black, 1 for white.
        level: f64 = 0.0, "Level", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// Clockwise turn of the top of the picture from north.
        turn_deg: f64 = 0.0, "Turn", Unit::Degrees, linear(-180.0, 180.0), Stage::Height;
        /// Copies are turned at random, by up to this angle either way.
        random_turn_deg: f64 = 180.0, "Random turn", Unit::Degrees, linear(0.0, 180.0), Stage::Height;
    }
}

params! {
    /// `h + height_m` on the crest.
    pub struct Ridge {
        /// Height of the crest.
        height_m: f64 = 1500.0, "Height", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
    }
}

params! {
    /// `h - depth_m` on the floor.
    pub struct Canyon {
        /// Depth of the floor.
        depth_m: f64 = 1200.0, "Depth", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
        /// Share of the radius that is level floor.
        floor: f64 = 0.2, "Floor", Unit::None, linear(0.0, 0.9), Stage::Height;
    }
}

params! {
    /// `h + (height along the line - h) * strength * w`; heights of near parts of the line are averaged.
    pub struct Road {
        /// Share of the way to the heights of the line.
        strength: f64 = 1.0, "Strength", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// `h + (smooth ground - h) * strength * w`
    pub struct Smooth {
        /// Size of what is smoothed away, as a share of the radius: ground finer than that becomes even.
        size: f64 = 0.5, "Size", Unit::None, log(0.05, 1.0), Stage::Height;
        /// Share of the way to smooth ground.
        strength: f64 = 1.0, "Strength", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// `h + gullies * w`: crests keep their height. Gullies run down the slopes of the ground around, are as deep as it
    /// is steep, and end where it is level.
    pub struct Hydraulic {
        /// Distance between the largest gullies, as a share of the radius.
        spacing: f64 = 0.15, "Spacing", Unit::None, log(0.02, 0.5), Stage::Height;
        /// Depth of gullies: at 1 the flanks of the largest are as steep as the ground.
        depth: f64 = 1.5, "Depth", Unit::None, linear(0.0, 4.0), Stage::Height;
        /// Number of sizes of gullies: each further one branches off those of twice its size.
        octaves: u32 = 4, "Octaves", Unit::None, count(1, 6), Stage::Height;
        /// Slope from which gullies become no deeper.
        steepest_deg: f64 = 25.0, "Steepest", Unit::Degrees, linear(1.0, 60.0), Stage::Height;
    }
}

params! {
    /// `h + (s + m * tanh((h - s) / m) - h) * strength * w`: what stands out of smooth ground `s`, or lies below it, by
    /// more than `m` crumbles; `m` is half the size by the tangent of the talus slope.
    pub struct Thermal {
        /// Size of the largest forms that crumble, as a share of the radius.
        size: f64 = 0.25, "Size", Unit::None, log(0.05, 1.0), Stage::Height;
        /// Slope of the talus: gentler ground stays.
        talus_deg: f64 = 15.0, "Talus slope", Unit::Degrees, log(0.2, 60.0), Stage::Height;
        /// Share of the way to crumbled ground.
        strength: f64 = 1.0, "Strength", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// `h + height_m` on the top.
    pub struct Wall {
        /// Height of the top above the ground below it.
        height_m: f64 = 100.0, "Height", Unit::Metres, log(0.0, 20_000.0), Stage::Height;
        /// Share of the radius that is level top.
        top: f64 = 0.5, "Top", Unit::None, linear(0.0, 0.95), Stage::Height;
    }
}

params! {
    /// `h + throw_m * slip * (step - drop) * (1 - t)^2`; the slip is 1 in the middle of the line and 0 at its ends.
    pub struct Fault {
        /// Height of the step in the middle of the line; negative lets the right side rise.
        throw_m: f64 = 800.0, "Throw", Unit::Metres, linear(-20_000.0, 20_000.0), Stage::Height;
        /// Width of the step as a share of the radius.
        scarp: f64 = 0.1, "Scarp", Unit::None, log(0.01, 1.0), Stage::Height;
        /// Share of the throw by which the right side sinks.
        drop: f64 = 0.3, "Drop", Unit::None, linear(0.0, 1.0), Stage::Height;
    }
}

params! {
    /// `h + (shore - h) * w`: the shore is at the sea level on the line, `land_m` above it one radius to the left,
    /// `depth_m` below it one radius to the right. It fades towards the ends of a line that is not closed.
    pub struct Coast {
        /// Height of the land above the sea.
        land_m: f64 = 80.0, "Land", Unit::Metres, log(0.0, 10_000.0), Stage::Height;
        /// Depth of the sea floor.
        depth_m: f64 = 120.0, "Depth", Unit::Metres, log(0.0, 10_000.0), Stage::Height;
        /// Whether land and sea change sides.
        flip: bool = false, "Other side", Unit::None, Domain::Flag, Stage::Height;
    }
}

choice! {
    /// What paint does to the climate.
    pub enum PaintMode {
        /// Adds to what the climate says.
        Shift = "Shift",
        /// Puts a value in its place.
        Set = "Set",
    }
}

params! {
    /// Shift: `m + moisture * w`; set: `m + (moisture - m) * w`, at the surface.
    pub struct MoisturePaint {
        /// Whether it adds to the moisture or sets it.
        mode: PaintMode = PaintMode::Shift, "Mode", Unit::None, Domain::Choice, Stage::Climate;
        /// Moisture that is added or set; the biome table has 0 (dry) to 1 (wet).
        moisture: f64 = 0.3, "Moisture", Unit::None, linear(-1.0, 1.0), Stage::Climate;
    }
}

params! {
    /// Shift: `T + temperature_c * w`; set: `T + (temperature_c - T) * w`, at the surface.
    pub struct TemperaturePaint {
        /// Whether it adds to the temperature or sets it.
        mode: PaintMode = PaintMode::Shift, "Mode", Unit::None, Domain::Choice, Stage::Climate;
        /// Temperature that is added or set.
        temperature_c: f64 = 8.0, "Temperature", Unit::Celsius, linear(-100.0, 100.0), Stage::Climate;
    }
}

params! {
    /// Sets moisture and temperature to those of the biome, by `strength * w`.
    pub struct BiomePaint {
        /// The biome.
        biome: char = UNSET_KEY, "Biome", Unit::None, Domain::BiomeKey, Stage::Climate;
        /// Share of the way to its climate.
        strength: f64 = 1.0, "Strength", Unit::None, linear(0.0, 1.0), Stage::Climate;
    }
}

params! {
    /// `log-odds of the cover + 10 * amount * w`, for each layer of clouds that the planet has
    pub struct CloudPaint {
        /// How much cloudier it becomes: 1 is overcast, -1 is clear sky.
        amount: f64 = 0.25, "Amount", Unit::None, linear(-1.0, 1.0), Stage::CloudMap;
    }
}

params! {
    /// `v + (1 - v) * amount * w`; a negative amount erases: `v + v * amount * w`
    pub struct MaskPaint {
        /// Name of the mask. Layers and edits refer to it by this name.
        mask: String = FIRST_PAINTED.to_owned(), "Painted mask", Unit::None, Domain::MaskName { max_chars: 48 },
            Stage::Height;
        /// Share of the way to full paint; negative erases.
        amount: f64 = 1.0, "Amount", Unit::None, linear(-1.0, 1.0), Stage::Height;
    }
}

params! {
    /// `uplift + uplift_m * w`, from which rivers carve; below 0 the ground sinks before they do.
    pub struct UpliftPaint {
        /// Height by which rock rises while rivers carve it; negative lets it sink.
        uplift_m: f64 = 2500.0, "Uplift", Unit::Metres, linear(-10_000.0, 20_000.0), Stage::Field;
    }
}

params! {
    /// `log of the erodibility - hardness * w`
    pub struct RockPaint {
        /// How much harder the rock becomes: 1 is carved 2.7 times as slowly, -1 as fast.
        hardness: f64 = 1.5, "Hardness", Unit::None, linear(-3.0, 3.0), Stage::Field;
    }
}

params! {
    /// `rain + rain_mm * w`, and at least 0
    pub struct RainPaint {
        /// Rain and snow that are added in a year; negative takes some away.
        rain_mm: f64 = 800.0, "Rain", Unit::MillimetresPerYear, linear(-6000.0, 6000.0), Stage::Field;
    }
}

params! {
    /// Water follows the line from its first point to its last, as far as that leads down. Where a line ends inland,
    /// the water finds the rest of its way.
    pub struct RiverCourse {
        /// Water of the spring at the first point, besides what flows in along the way.
        spring_m3_s: f64 = 200.0, "Spring", Unit::CubicMetresPerSecond, log(0.0, 500_000.0), Stage::Field;
        /// How far the river has cut down: 0 is as its water has, 1 is as gently as rivers run.
        cut: f64 = 0.9, "Cut", Unit::None, linear(0.0, 1.0), Stage::Field;
    }
}

params! {
    /// `share + (density - share) * w`, where `share` is the share of its greatest density that a population has
    pub struct LifePaint {
        /// Name of the population; empty for all of them.
        population: String = String::new(), "Population", Unit::None,
            Domain::PopulationName { max_chars: 48, none: "All populations" }, Stage::Life;
        /// Share of its greatest density that the population gets: 0 clears, 1 plants it as dense as where everything
        /// suits it.
        density: f64 = 1.0, "Density", Unit::None, linear(0.0, 1.0), Stage::Life;
    }
}

params! {
    /// An object at each point, on the ground there; widths of points and sizes of copies are factors on its height.
    pub struct PlacedObject {
        /// Name of its population; empty for the first one.
        population: String = String::new(), "Population", Unit::None,
            Domain::PopulationName { max_chars: 48, none: "The first" }, Stage::Life;
        /// Height as a factor on the mean height of its population.
        size: f64 = 1.0, "Size", Unit::None, log(0.1, 4.0), Stage::Life;
        /// Clockwise turn, seen from above.
        turn_deg: f64 = 0.0, "Turn", Unit::Degrees, linear(-180.0, 180.0), Stage::Life;
        /// Copies are turned at random, by up to this angle either way.
        random_turn_deg: f64 = 180.0, "Random turn", Unit::Degrees, linear(0.0, 180.0), Stage::Life;
    }
}
