//! Parameters that have no effect where the others stand: the softness of a sharp blend, the size of patches where
//! there are none. The editor greys them.

use super::layers::Blend;
use super::param::{ParamPath, Segment};
use super::shapes::CellStyle;
use super::{
    Atmosphere, Biome, Biomes, Climate, Clouds, Detail, Form, Giant, GroundEdit, Layer, Planet, Population, Rings,
    Shape, Steep, Structure, TableRows, Tool, Water,
};

const ONE_COPY: &str = "There is one copy only";

/// Why a parameter has no effect: a sentence without a full stop. None: it has one.
type Idle = Option<&'static str>;

impl Planet {
    /// Why the parameter at `path` has no effect now, as a sentence without a full stop; None if it has one.
    pub fn idle(&self, path: &ParamPath) -> Option<&'static str> {
        use Segment::{Field, Index};
        match path.segments() {
            [Field("layers"), Index(index), rest @ ..] => {
                self.layers.get(*index).and_then(|layer| self.layer_idle(layer, rest))
            }
            [Field("edits"), Index(index), Field(name)] => {
                self.edits.get(*index).and_then(|edit| edit_idle(edit, name))
            }
            [Field("edits"), Index(index), Field("tool"), Field("random_turn_deg")] => {
                self.edits.get(*index).and_then(|edit| when(edit.copies <= 1, ONE_COPY))
            }
            [Field("life"), Index(index), Field(name)] => {
                self.life.get(*index).and_then(|population| self.population_idle(population, name))
            }
            [Field("climate"), Field(name)] => self.climate_idle(&self.climate, name),
            [Field("biomes"), Field("palette"), Index(index), Field(name)] => {
                self.biomes.palette.get(*index).and_then(|biome| biome_idle(biome, name))
            }
            [Field("biomes"), Field(name)] => biomes_idle(&self.biomes, name),
            [Field("structure"), rest @ ..] => {
                self.structure.as_ref().and_then(|structure| structure_idle(structure, rest))
            }
            [Field("water"), Field(name)] => self.water.as_ref().and_then(|water| water_idle(water, name)),
            [Field("atmosphere"), Field(name)] => self.atmosphere.as_ref().and_then(|air| air_idle(air, name)),
            [Field("clouds"), Field(name)] => self.clouds.as_ref().and_then(|clouds| clouds_idle(clouds, name)),
            [Field("giant"), Field(name)] => self.giant.as_ref().and_then(|giant| giant_idle(giant, name)),
            [Field("rings"), Field(name)] => self.rings.as_ref().and_then(|rings| rings_idle(rings, name)),
            _ => None,
        }
    }

    fn population_idle(&self, population: &Population, name: &str) -> Idle {
        match name {
            "clump_m" => when(population.clumping <= 0.0, "Nothing is drawn together into groups"),
            "color" | "leaf_color" if matches!(&population.form, Form::Mesh(form) if form.own_colors) => {
                Some("The objects have the colours of their file")
            }
            "leaf_color" if matches!(population.form, Form::Game(_)) => Some("What a game draws has one colour here"),
            "shore_m" if population.in_water => Some("The objects stand in water, too"),
            "shore_m" | "in_water" => when(self.water.is_none() && self.structure.is_none(), "There is no water"),
            _ => None,
        }
    }

    fn layer_idle(&self, layer: &Layer, rest: &[Segment]) -> Idle {
        let lies_over = self.structure.is_some() && !layer.under;
        match rest {
            [Segment::Field("softness_m")] => when(
                !matches!(layer.blend, Blend::SmoothMax | Blend::SmoothMin),
                "Only a smooth maximum or minimum rounds corners",
            ),
            [Segment::Field("amplitude_m")] => {
                when(layer.blend == Blend::Multiply, "Multiply scales the height by the noise and the offset alone")
            }
            [Segment::Field("folding")]
                if matches!(layer.shape, Shape::Craters(_) | Shape::Dunes(_) | Shape::HeightMap(_)) =>
            {
                Some("Craters, dunes and height maps are not folded")
            }
            [Segment::Field("under" | "folding")] | [Segment::Field("shape"), Segment::Field("follow_wind")] => {
                when(self.structure.is_none(), "The planet has no structure")
            }
            [Segment::Field("shape"), Segment::Field(name)] => shape_idle(&layer.shape, name, lies_over),
            _ => None,
        }
    }

    fn climate_idle(&self, climate: &Climate, name: &str) -> Idle {
        let solved = self.structure.as_ref().is_some_and(|structure| structure.weather_share >= 1.0);
        match name {
            "moisture" | "belts" | "sea_moisture" | "sea_reach_km" if solved => {
                Some("The structure's weather takes its place: Weather share is 1")
            }
            "sea_moisture" | "sea_reach_km" if self.water.is_none() => Some("The planet has no sea"),
            "sea_reach_km" => when(climate.sea_moisture == 0.0, "Coastal moisture is 0"),
            "wavelength_km" | "octaves" | "seed" => when(
                climate.temperature_variation_c == 0.0 && climate.moisture_variation == 0.0,
                "Both variations are 0",
            ),
            _ => None,
        }
    }
}

fn edit_idle(edit: &GroundEdit, name: &str) -> Idle {
    match name {
        "limit" | "blend" | "above_m" | "below_m" | "softness" if matches!(edit.tool, Tool::River(_)) => {
            Some("The course of a river has no limits")
        }
        "softness" | "raggedness" if matches!(edit.tool, Tool::Object(_)) => Some("Objects have no edge that fades"),
        "radius_km" if matches!(edit.tool, Tool::Object(_)) => Some("Objects have a size instead"),
        "mask" => when(!edit.tool.reads_mask(), "Rivers and masks are not limited by masks"),
        "outside_mask" => when(edit.limiting_mask().is_none(), "The edit has no mask"),
        "copies" | "spread_km" | "smallest" if !edit.tool.is_stamp() => Some("Only stamps have copies"),
        "spread_km" | "smallest" => when(edit.copies <= 1, ONE_COPY),
        _ => None,
    }
}

fn when(idle: bool, why: &'static str) -> Idle {
    idle.then_some(why)
}

fn shape_idle(shape: &Shape, name: &str, lies_over: bool) -> Idle {
    const ONE_OCTAVE: &str = "There is one octave only";
    match (shape, name) {
        (Shape::Craters(it), "gain") => when(it.octaves == 1, "There is one size only"),
        (Shape::Craters(it), "fresh") => when(it.age == 0.0, "No crater is eroded: Erosion is 0"),
        (Shape::Terraces(it), "wavelength_km" | "octaves") => when(it.waviness == 0.0, "Waviness is 0"),
        (Shape::Warped(it), "warp_wavelength_km" | "warp_octaves") => when(it.warp_km == 0.0, "Warp is 0"),
        (Shape::Dunes(it), "wind_deg") => when(it.follow_wind && lies_over, "The dunes follow the planet's wind"),
        (Shape::Dunes(it), "gain" | "lacunarity") => when(it.octaves == 1, "There is one size only"),
        (Shape::Canyons(it), "gain" | "lacunarity") => when(it.octaves == 1, "There is one size only"),
        (Shape::Cells(it), "width") => when(it.style == CellStyle::Bumps, "Bumps have no borders"),
        (Shape::Cells(it), "gain" | "lacunarity") => when(it.octaves == 1, ONE_OCTAVE),
        (Shape::HeightMap(it), "layout" | "low" | "high") => when(it.file.path().is_empty(), "There is no picture yet"),
        (Shape::Fbm(it), "gain" | "lacunarity") => when(it.octaves == 1, ONE_OCTAVE),
        (Shape::Ridged(it), "gain" | "lacunarity" | "feedback") => when(it.octaves == 1, ONE_OCTAVE),
        (Shape::Billow(it), "gain" | "lacunarity") => when(it.octaves == 1, ONE_OCTAVE),
        (Shape::Damped(it), "gain" | "lacunarity") => when(it.octaves == 1, ONE_OCTAVE),
        _ => None,
    }
}

fn biomes_idle(biomes: &Biomes, name: &str) -> Idle {
    match name {
        "coldest_c" | "hottest_c" => when(biomes.rows == TableRows::Elevation, "Rows are elevations"),
        "lowest_m" | "highest_m" => when(biomes.rows == TableRows::Temperature, "Rows are temperatures"),
        "beach_key" | "beach_steepest_deg" => when(biomes.beach_m == 0.0, "There are no beaches: Beach height is 0"),
        "snow_key" | "snow_below_c" | "snow_range_c" | "snow_steepest_deg" => when(!biomes.snow, "Snow cover is off"),
        "cliff_detail_m" if biomes.cliff_detail == Detail::None => Some("Rock has no detail"),
        "cliff_start_deg" | "cliff_full_deg" | "cliff_color" | "cliff_detail" | "cliff_detail_m" => {
            when(biomes.palette.iter().all(|biome| biome.steep != Steep::Rock), "No biome becomes rock on steep ground")
        }
        _ => None,
    }
}

fn biome_idle(biome: &Biome, name: &str) -> Idle {
    match name {
        "patch_color" | "patch_m" | "patch_detail" => when(biome.patches == 0.0, "Patches is 0"),
        "detail_m" | "detail_strength" => {
            let has_patches = biome.patches > 0.0 && biome.patch_detail != Detail::None;
            let has_own = biome.detail != Detail::None || !biome.textures.is_none();
            when(!has_own && !has_patches, "The biome has no detail")
        }
        "steep_key" | "steep_from_deg" | "steep_to_deg" => {
            when(biome.steep != Steep::Biome, "No other biome replaces it on steep ground")
        }
        "relief_size_m" => when(biome.relief_m == 0.0, "Relief is 0"),
        "glow_color" => when(biome.glow == 0.0, "Glow is 0"),
        _ => None,
    }
}

fn structure_idle(structure: &Structure, rest: &[Segment]) -> Idle {
    match rest {
        [Segment::Field("plates"), Segment::Field("hot_spots_m")] => {
            when(structure.plates.hot_spots == 0, "There are no hot spots")
        }
        _ => None,
    }
}

fn water_idle(water: &Water, name: &str) -> Idle {
    match name {
        "glow_color" => when(water.glow == 0.0, "Glow is 0"),
        _ => None,
    }
}

fn air_idle(air: &Atmosphere, name: &str) -> Idle {
    let none = |coefficients: [f64; 3]| coefficients == [0.0; 3];
    match name {
        "rayleigh_scale_km" => when(none(air.rayleigh_per_km), "Rayleigh scattering is 0"),
        "mie_anisotropy" => when(none(air.mie_scattering_per_km), "Mie scattering is 0"),
        "mie_scale_km" => when(
            none(air.mie_scattering_per_km) && none(air.mie_absorption_per_km),
            "Mie scattering and absorption are 0",
        ),
        "absorber_height_km" | "absorber_width_km" => when(none(air.absorber_per_km), "Absorption is 0"),
        "aurora_lat_deg" => when(air.aurora == 0.0, "Aurora is 0"),
        _ => None,
    }
}

fn giant_idle(giant: &Giant, name: &str) -> Idle {
    match name {
        "spot_lat_deg" | "spot_color" => when(giant.spot_radii == 0.0, "Great spot is 0"),
        "eddy_radii" => when(giant.turbulence == 0.0 && giant.filaments == 0.0, "Turbulence and Filaments are 0"),
        _ => None,
    }
}

fn rings_idle(rings: &Rings, name: &str) -> Idle {
    match name {
        "ringlet_share" => when(rings.ringlets == 0.0, "Ringlets is 0"),
        "thickness_m" | "largest_m" => when(rings.dust == 1.0, "Dust is 1"),
        _ => None,
    }
}

fn clouds_idle(clouds: &Clouds, name: &str) -> Idle {
    match name {
        "density" | "puff_km" | "layering" | "towers" | "rain" => when(clouds.coverage == 0.0, "Low cover is 0"),
        "cyclones" => when(clouds.storms == 0.0, "Cyclone strength is 0"),
        "storms" => when(clouds.cyclones == 0, "There are no cyclones"),
        "middle_gap_km" | "middle_thickness_km" | "middle_density" | "middle_puff_km" => {
            when(clouds.middle == 0.0, "Middle cover is 0")
        }
        "veil_gap_km" | "veil_density" => when(clouds.veil == 0.0, "Veil cover is 0"),
        "fog_altitude_km" | "fog_thickness_km" | "fog_density" => when(clouds.fog == 0.0, "Fog cover is 0"),
        _ => None,
    }
}
