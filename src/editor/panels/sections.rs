//! The sections of the panels: which parameters stand together, in the order of an artist's work. Parameters in no
//! section come first, in the order of the file.

use crate::planet::param::{ParamPath, Segment};

/// Parameters under a heading that folds.
pub struct Section {
    /// The heading.
    pub title: &'static str,
    /// Whether it is unfolded at first.
    pub open: bool,
    /// Names of the fields, in the order shown.
    pub fields: &'static [&'static str],
}

const fn open(title: &'static str, fields: &'static [&'static str]) -> Section {
    Section { title, open: true, fields }
}

const fn folded(title: &'static str, fields: &'static [&'static str]) -> Section {
    Section { title, open: false, fields }
}

const PLANET: &[Section] = &[folded("Heights", &["height_curve", "precision"])];

const LAYER: &[Section] = &[
    open("Landform", &["shape"]),
    open("Height", &["amplitude_m", "bias", "blend", "softness_m", "curve"]),
    folded("Structure", &["under", "folding"]),
];

const EDIT: &[Section] = &[
    open("Tool", &["tool"]),
    open("Extent", &["radius_km", "softness", "raggedness", "seed"]),
    folded("Acts on", &["limit", "above_m", "below_m", "mask", "outside_mask"]),
    folded("Symmetry", &["turns", "mirrored"]),
    folded("Copies", &["copies", "spread_km", "smallest"]),
];

const STAR: &[Section] = &[
    open("Light", &["color", "brightness", "radius_deg"]),
    open("Place and day", &["latitude_deg", "longitude_deg", "day_hours", "tilt_deg"]),
];

const CLIMATE: &[Section] = &[
    open("Temperature", &["equator_c", "pole_c", "lapse_c_per_km", "temperature_variation_c"]),
    open(
        "Moisture",
        &["moisture", "moisture_variation", "belts", "drying_per_km", "sea_moisture", "sea_reach_km", "wettest_mm"],
    ),
    open("Regions", &["wavelength_km", "octaves", "seed"]),
];

const BIOMES: &[Section] = &[
    open("Axes", &["rows", "coldest_c", "hottest_c", "lowest_m", "highest_m"]),
    open("Borders", &["blend", "border_jitter"]),
    folded("Steep rock", &["cliff_start_deg", "cliff_full_deg", "cliff_color", "cliff_detail", "cliff_detail_m"]),
    folded("Beaches", &["beach_m", "beach_key", "beach_steepest_deg"]),
    folded("Snow", &["snow", "snow_key", "snow_below_c", "snow_range_c", "snow_steepest_deg"]),
];

const BIOME: &[Section] = &[
    open("Colour", &["variation", "patches", "patch_color", "patch_m"]),
    open("Surface", &["roughness", "specular", "detail", "patch_detail", "textures", "detail_m", "detail_strength"]),
    folded("Steep ground", &["steep", "steep_key", "steep_from_deg", "steep_to_deg"]),
    folded("Relief", &["relief_m", "relief_size_m"]),
    folded("Glow and flow", &["glow", "glow_color", "flow_m_s"]),
];

const POPULATION: &[Section] = &[
    open("Form", &["form"]),
    open("Size and colour", &["height_m", "height_spread", "color", "leaf_color", "color_spread", "litter"]),
    open("Place", &["biomes", "slope_from_deg", "slope_to_deg", "shore_m", "in_water"]),
    folded("Water, ridges and hollows", &["bank_from_m", "bank_to_m", "curvature_from", "curvature_to"]),
    folded(
        "Climate and height",
        &["temperature_from_c", "temperature_to_c", "moisture_from", "moisture_to", "height_from_m", "height_to_m"],
    ),
    folded("Groups", &["clumping", "clump_m", "seed"]),
    folded("Stance", &["upright", "lean_deg", "sunk", "sway", "solid"]),
];

const PLATES: &[Section] = &[
    open("Layout", &["seed", "count", "size_variation", "raggedness", "drift_mm_yr"]),
    open("Land", &["continents", "fragments", "mountains_m", "belt_km", "plateau_km", "old_belts_m", "inland_m"]),
    folded("Ocean floor", &["ocean_m", "ridge_m", "trench_m", "shelf_km", "arcs_m"]),
    folded("Rifts and hot spots", &["rifts_m", "hot_spots", "hot_spots_m"]),
];

const WATER: &[Section] = &[
    open("Colour", &["color", "absorption_per_m"]),
    open("Waves", &["wind_m_s", "fetch_km", "swell_m"]),
    open("Ice", &["freezing_c", "ice_color", "floe_m"]),
    folded("Glow", &["glow", "glow_color"]),
];

const ATMOSPHERE: &[Section] = &[
    open("Molecules", &["rayleigh_per_km", "rayleigh_scale_km"]),
    open("Haze", &["mie_scattering_per_km", "mie_absorption_per_km", "mie_scale_km", "mie_anisotropy"]),
    folded("Absorbing layer", &["absorber_per_km", "absorber_height_km", "absorber_width_km"]),
    folded("Light from the ground", &["ground_albedo"]),
    open("Aurora", &["aurora", "aurora_lat_deg"]),
];

const CLOUDS: &[Section] = &[
    open(
        "Low clouds",
        &["coverage", "layering", "towers", "rain", "altitude_km", "thickness_km", "density", "puff_km"],
    ),
    open("Weather", &["scale_km", "curl", "storms", "cyclones", "wind_km_h", "seed", "color"]),
    open("Middle clouds", &["middle", "middle_gap_km", "middle_thickness_km", "middle_density", "middle_puff_km"]),
    open("Veil", &["veil", "veil_gap_km", "veil_density"]),
    open("Fog", &["fog", "fog_altitude_km", "fog_thickness_km", "fog_density"]),
];

const GIANT: &[Section] = &[
    open("Bands", &["bands", "variation", "contrast", "seed"]),
    open("Colours", &["zone_color", "belt_color", "accent_color", "pole_color"]),
    open("Flow", &["jet_m_s", "turbulence", "eddy_radii", "filaments"]),
    open("Storms", &["storms", "spot_radii", "spot_lat_deg", "spot_color"]),
];

const RINGS: &[Section] = &[
    open("Extent", &["inner_radii", "width_radii"]),
    open("Density", &["optical_depth", "profile", "ringlets", "ringlet_share", "gaps", "seed"]),
    open("Light", &["dust", "inner_color", "outer_color"]),
];

const MEMBER: &[Section] =
    &[open("Orbit", &["orbit"]), open("Start", &["start"]), folded("Rotation", &["spin"]), open("Light", &["light"])];

/// The sections of the part at `path`; none for a part whose parameters are few.
pub fn sections_of(path: &ParamPath) -> &'static [Section] {
    use Segment::{Field, Index};
    match path.segments() {
        [] => PLANET,
        [Field("layers"), Index(_)] => LAYER,
        [Field("edits"), Index(_)] | [Field("brush")] => EDIT,
        [Field("life"), Index(_)] => POPULATION,
        [Field("star")] => STAR,
        [Field("climate")] => CLIMATE,
        [Field("biomes")] => BIOMES,
        [Field("biomes"), Field("palette"), Index(_)] => BIOME,
        [Field("structure"), Field("plates")] => PLATES,
        [Field("water")] => WATER,
        [Field("atmosphere")] => ATMOSPHERE,
        [Field("clouds")] => CLOUDS,
        [Field("giant")] => GIANT,
        [Field("rings")] => RINGS,
        [Field("bodies"), Index(_)] => MEMBER,
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{
        Atmosphere, Biome, Biomes, Climate, Clouds, Giant, Layer, Planet, Plates, Population, Rings, Star, Water,
    };

    #[test]
    fn every_field_of_a_section_exists_and_stands_in_one_section() {
        let names = |params: &[crate::planet::param::Param]| params.iter().map(|param| param.name).collect::<Vec<_>>();
        let parts = [
            (PLANET, names(Planet::PARAMS)),
            (LAYER, [names(Layer::PARAMS), vec!["shape"]].concat()),
            (POPULATION, [names(Population::PARAMS), vec!["form"]].concat()),
            (STAR, names(Star::PARAMS)),
            (CLIMATE, names(Climate::PARAMS)),
            (BIOMES, names(Biomes::PARAMS)),
            (BIOME, names(Biome::PARAMS)),
            (PLATES, names(Plates::PARAMS)),
            (WATER, names(Water::PARAMS)),
            (ATMOSPHERE, names(Atmosphere::PARAMS)),
            (CLOUDS, names(Clouds::PARAMS)),
            (GIANT, names(Giant::PARAMS)),
            (RINGS, names(Rings::PARAMS)),
        ];
        for (sections, names) in parts {
            let fields: Vec<_> = sections.iter().flat_map(|section| section.fields).collect();
            for (index, field) in fields.iter().enumerate() {
                assert!(names.contains(field), "{field}");
                assert!(!fields[..index].contains(field), "{field} is in two sections");
            }
        }
    }
}
