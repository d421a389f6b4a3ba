//! Presets of version 2: every kind of layer, heights not yet to the millimetre. Frozen: never edit it.
//!
//! Every type here is the file's own. A field that a type of today gains later needs a value under `adding` here: the
//! value that means what a preset of version 2 meant.

use super::frozen::{Migrate, frozen, frozen_choice, frozen_kinds};
use super::v3;
use crate::planet::{self, GroundEdits, Precision, Version};

frozen! {
    /// The whole file. Its heights keep the arithmetic that they were made with.
    "Planet" File => v3::File {
        version: Version = Version(2),
        name: String = "Unnamed".to_owned(),
        seed: u32 = 1,
        radius_km: f64 = 6371.0,
        height_curve: Vec<[f64; 2]> = Vec::new(),
        star: Star = Star::default(),
        layers: Vec<Layer> = Vec::new(),
        climate: Climate = Climate::default(),
        biomes: Biomes = Biomes::default(),
        water: Option<Water> = None,
        atmosphere: Option<Atmosphere> = None,
        clouds: Option<Clouds> = None,
        editor: Option<EditorNotes> = None,
    } adding {
        ground_version: None, edits: GroundEdits::default(), life: Vec::new(),
        precision: Precision::Classic, structure: None, settlements: 0.0, giant: None, rings: None
    }
}

frozen! {
    "Star" Star => planet::Star {
        latitude_deg: f64 = 12.0,
        longitude_deg: f64 = 0.0,
        day_hours: f64 = 24.0,
        tilt_deg: f64 = 23.4,
        color: [f64; 3] = [1.0, 0.97, 0.93],
        brightness: f64 = 1.0,
        radius_deg: f64 = 0.268,
    }
}

frozen! {
    "Climate" Climate => planet::Climate {
        equator_c: f64 = 28.0,
        pole_c: f64 = -28.0,
        lapse_c_per_km: f64 = 6.5,
        temperature_variation_c: f64 = 5.0,
        moisture: f64 = 0.5,
        moisture_variation: f64 = 0.6,
        belts: f64 = 0.3,
        drying_per_km: f64 = 0.06,
        sea_moisture: f64 = 0.0,
        sea_reach_km: f64 = 1500.0,
        wettest_mm: f64 = 3000.0,
        wavelength_km: f64 = 3000.0,
        octaves: u32 = 6,
        seed: u32 = 7,
    }
}

frozen! {
    "Biomes" Biomes => planet::Biomes {
        rows: TableRows = TableRows::Temperature,
        coldest_c: f64 = -30.0,
        hottest_c: f64 = 30.0,
        lowest_m: f64 = 0.0,
        highest_m: f64 = 6000.0,
        blend: TableBlend = TableBlend::Linear,
        border_jitter: f64 = 1.0,
        cliff_start_deg: f64 = 28.0,
        cliff_full_deg: f64 = 42.0,
        cliff_color: [f64; 3] = [0.16, 0.14, 0.12],
        cliff_detail: Detail = Detail::None,
        cliff_detail_m: f64 = 6.0,
        beach_m: f64 = 0.0,
        beach_key: char = 'a',
        beach_steepest_deg: f64 = 15.0,
        snow: bool = false,
        snow_key: char = 'a',
        snow_below_c: f64 = -6.0,
        snow_range_c: f64 = 4.0,
        snow_steepest_deg: f64 = 40.0,
        palette: Vec<Biome> = vec![Biome::default()],
        table: Vec<String> = vec!["a".repeat(16); 12],
    }
}

frozen_choice! { TableRows => planet::TableRows { Temperature, Elevation } }

frozen_choice! { TableBlend => planet::TableBlend { Linear, Crisp } }

frozen! {
    "Biome" Biome => planet::Biome {
        key: char = 'a',
        name: String = "Ground".to_owned(),
        color: [f64; 3] = [0.2, 0.18, 0.15],
        variation: f64 = 0.25,
        patches: f64 = 0.0,
        patch_color: [f64; 3] = [0.25, 0.22, 0.15],
        patch_m: f64 = 100.0,
        roughness: f64 = 0.9,
        specular: f64 = 0.2,
        detail: Detail = Detail::None,
        detail_m: f64 = 2.0,
        detail_strength: f64 = 1.0,
        steep: Steep = Steep::Rock,
        steep_key: char = 'a',
        steep_from_deg: f64 = 25.0,
        steep_to_deg: f64 = 35.0,
        relief_m: f64 = 0.0,
        relief_size_m: f64 = 50.0,
        glow: f64 = 0.0,
        glow_color: [f64; 3] = [1.0, 0.25, 0.03],
        flow_m_s: f64 = 0.0,
    }
    adding { patch_detail: planet::Detail::None, textures: Default::default() }
}

frozen_choice! { Detail => planet::Detail { None, Grass, Litter, Sand, Gravel, Rock, Snow, Ice, Mud, Lava } }

frozen_choice! { Steep => planet::Steep { Rock, Biome, Stays } }

frozen! {
    "Water" Water => planet::Water {
        level_m: f64 = 0.0,
        absorption_per_m: [f64; 3] = [0.34, 0.0325, 0.00635],
        color: [f64; 3] = [0.004, 0.028, 0.052],
        wind_m_s: f64 = 7.0,
        freezing_c: f64 = -12.0,
        ice_color: [f64; 3] = [0.72, 0.78, 0.84],
    } adding { fetch_km: 1000.0, swell_m: 0.5, floe_m: 3000.0, glow: 0.0, glow_color: [1.0, 0.25, 0.03] }
}

frozen! {
    "Atmosphere" Atmosphere => planet::Atmosphere {
        height_km: f64 = 100.0,
        rayleigh_per_km: [f64; 3] = [0.005802, 0.013558, 0.0331],
        rayleigh_scale_km: f64 = 8.0,
        mie_scattering_per_km: [f64; 3] = [0.003996, 0.003996, 0.003996],
        mie_absorption_per_km: [f64; 3] = [0.000444, 0.000444, 0.000444],
        mie_scale_km: f64 = 1.2,
        mie_anisotropy: f64 = 0.8,
        absorber_per_km: [f64; 3] = [0.00065, 0.001881, 0.000085],
        absorber_height_km: f64 = 25.0,
        absorber_width_km: f64 = 15.0,
        ground_albedo: [f64; 3] = [0.3, 0.3, 0.3],
    } adding { aurora: 0.0, aurora_lat_deg: 67.0 }
}

frozen! {
    "Clouds" Clouds => planet::Clouds {
        coverage: f64 = 0.5,
        scale_km: f64 = 2500.0,
        curl: f64 = 0.6,
        seed: u32 = 3,
        altitude_km: f64 = 3.0,
        thickness_km: f64 = 2.0,
        density: f64 = 12.0,
        puff_km: f64 = 6.0,
        color: [f64; 3] = [0.98, 0.98, 0.98],
        wind_km_h: f64 = 60.0,
    } adding {
        storms: 0.0,
        cyclones: 24,
        layering: 0.0,
        towers: 0.0,
        rain: 0.0,
        middle: 0.0,
        middle_gap_km: 1.0,
        middle_thickness_km: 0.6,
        middle_density: 4.0,
        middle_puff_km: 1.5,
        veil: 0.0,
        veil_gap_km: 3.0,
        veil_density: 0.6,
        fog: 0.0,
        fog_altitude_km: 0.0,
        fog_thickness_km: 0.3,
        fog_density: 6.0,
    }
}

frozen! {
    "EditorNotes" EditorNotes => planet::EditorNotes {
        bookmarks: Vec<Bookmark> = Vec::new(),
    } adding { locks: Vec::new() }
}

frozen! {
    "Bookmark" Bookmark => planet::Bookmark {
        name: String = "View".to_owned(),
        latitude_deg: f64 = 0.0,
        longitude_deg: f64 = 0.0,
        altitude_m: f64 = 1000.0,
        heading_deg: f64 = 0.0,
        pitch_deg: f64 = 0.0,
        roll_deg: f64 = 0.0,
    }
}

frozen! {
    "Layer" Layer => planet::Layer {
        name: String = "Layer".to_owned(),
        enabled: bool = true,
        seed: u32 = 1,
        shape: Shape = Shape::Fbm(Fbm::default()),
        amplitude_m: f64 = 1000.0,
        bias: f64 = 0.0,
        curve: Vec<[f64; 2]> = Vec::new(),
        blend: Blend = Blend::Add,
        softness_m: f64 = 100.0,
        masks: Vec<Mask> = Vec::new(),
    }
    adding { under: false, folding: 0.0 }
}

frozen_choice! { Blend => planet::Blend { Add, Subtract, Multiply, Max, Min, Replace, SmoothMax, SmoothMin } }

frozen_kinds! {
    Mask => planet::Mask { Layer(LayerMask), Height(HeightMask), Slope(SlopeMask), Latitude(LatitudeMask) }
}

frozen! {
    "LayerMask" LayerMask => planet::LayerMask {
        layer: String = String::new(),
        from: f64 = -0.1,
        to: f64 = 0.1,
        invert: bool = false,
    }
}

frozen! {
    "HeightMask" HeightMask => planet::HeightMask {
        from_m: f64 = 0.0,
        to_m: f64 = 500.0,
        invert: bool = false,
    }
}

frozen! {
    "SlopeMask" SlopeMask => planet::SlopeMask {
        from_deg: f64 = 15.0,
        to_deg: f64 = 30.0,
        over_m: f64 = 500.0,
        invert: bool = false,
    }
}

frozen! {
    "LatitudeMask" LatitudeMask => planet::LatitudeMask {
        from_deg: f64 = 50.0,
        to_deg: f64 = 60.0,
        both: bool = true,
        invert: bool = false,
    }
}

frozen_kinds! {
    Shape => planet::Shape {
        Fbm(Fbm),
        Ridged(Ridged),
        Craters(Craters),
        Terraces(Terraces),
        Billow(Billow),
        Damped(Damped),
        Warped(Warped),
        Continents(Continents),
        Dunes(Dunes),
        Gullies(Gullies),
        Canyons(Canyons),
        Cells(Cells),
        HeightMap(HeightMap),
    }
}

frozen! {
    "Fbm" Fbm => planet::Fbm {
        wavelength_km: f64 = 2000.0,
        octaves: u32 = 12,
        gain: f64 = 0.5,
        lacunarity: f64 = 2.0,
    }
}

frozen! {
    "Ridged" Ridged => planet::Ridged {
        wavelength_km: f64 = 800.0,
        octaves: u32 = 12,
        gain: f64 = 0.5,
        lacunarity: f64 = 2.0,
        feedback: f64 = 2.0,
    }
}

frozen! {
    "Craters" Craters => planet::Craters {
        diameter_km: f64 = 200.0,
        octaves: u32 = 7,
        gain: f64 = 0.55,
        lacunarity: f64 = 2.0,
        density: f64 = 0.7,
        power: f64 = 2.4,
        rim: f64 = 0.28,
        ejecta: f64 = 1.6,
        floor: f64 = 0.45,
        peak: f64 = 0.3,
        age: f64 = 0.7,
        fresh: f64 = 0.1,
    }
}

frozen! {
    "Terraces" Terraces => planet::Terraces {
        sharpness: f64 = 0.8,
        waviness: f64 = 0.5,
        wavelength_km: f64 = 30.0,
        octaves: u32 = 4,
    }
}

frozen! {
    "Billow" Billow => planet::Billow {
        wavelength_km: f64 = 100.0,
        octaves: u32 = 8,
        gain: f64 = 0.4,
        lacunarity: f64 = 2.0,
    }
}

frozen! {
    "Damped" Damped => planet::Damped {
        wavelength_km: f64 = 400.0,
        octaves: u32 = 12,
        gain: f64 = 0.5,
        lacunarity: f64 = 2.0,
        damping: f64 = 0.12,
    }
}

frozen! {
    "Warped" Warped => planet::Warped {
        wavelength_km: f64 = 1000.0,
        octaves: u32 = 12,
        gain: f64 = 0.5,
        lacunarity: f64 = 2.0,
        warp_km: f64 = 300.0,
        warp_wavelength_km: f64 = 1000.0,
        warp_octaves: u32 = 3,
    }
}

frozen! {
    "Continents" Continents => planet::Continents {
        wavelength_km: f64 = 5500.0,
        octaves: u32 = 14,
        gain: f64 = 0.56,
        lacunarity: f64 = 2.0,
        warp: f64 = 0.3,
        land: f64 = 0.32,
        shelf: f64 = 0.2,
    }
}

frozen! {
    "Dunes" Dunes => planet::Dunes {
        wavelength_km: f64 = 1.5,
        octaves: u32 = 2,
        gain: f64 = 0.2,
        lacunarity: f64 = 4.0,
        wind_deg: f64 = 90.0,
        asymmetry: f64 = 0.8,
        waviness: f64 = 0.5,
    }
    adding { follow_wind: false }
}

frozen! {
    "Gullies" Gullies => planet::Gullies {
        wavelength_km: f64 = 60.0,
        octaves: u32 = 2,
        gain: f64 = 0.5,
        lacunarity: f64 = 2.0,
        gully_km: f64 = 8.0,
        gully_octaves: u32 = 5,
        depth: f64 = 1.0,
    }
}

frozen! {
    "Canyons" Canyons => planet::Canyons {
        wavelength_km: f64 = 200.0,
        octaves: u32 = 3,
        gain: f64 = 0.6,
        lacunarity: f64 = 2.0,
        width_km: f64 = 8.0,
        steepness: f64 = 0.35,
        meander: f64 = 0.5,
    }
}

frozen! {
    "Cells" Cells => planet::Cells {
        cell_km: f64 = 800.0,
        style: CellStyle = CellStyle::Plates,
        width: f64 = 0.2,
        jitter: f64 = 1.0,
        octaves: u32 = 1,
        gain: f64 = 0.5,
        lacunarity: f64 = 2.0,
    }
}

frozen! {
    "HeightMap" HeightMap => planet::HeightMap {
        file: String = String::new(),
        layout: PictureLayout = PictureLayout::Equirectangular,
        low: f64 = 0.0,
        high: f64 = 1.0,
    }
}

frozen_choice! { CellStyle => planet::CellStyle { Plates, Cracks, Bumps } }

frozen_choice! { PictureLayout => planet::PictureLayout { Equirectangular, CubeCross, CubeStrip } }
