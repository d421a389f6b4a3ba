//! A biome, one kind of ground: colours, gloss, close-up pattern, steep ground, biome relief and glow.

use super::Biomes;
use super::param::{Choice, Domain, Stage, Unit, choice, linear, log, params};
use super::textures::TextureSetFile;

/// Period of a pattern in metres. It must stay below the length at which shaders wrap positions (`WRAP_M` in
/// `render/biome_table.rs`).
pub(super) const DETAIL_SIZE: Domain = log(0.2, 200.0);

/// The key that a rule holds until a biome is chosen for it. If the palette has no such key, the rule must be off.
pub const UNSET_KEY: char = 'a';

choice! {
    /// Close-up pattern of the ground.
    pub enum Detail {
        /// One even surface.
        None = "None",
        /// Blades in tufts.
        Grass = "Grass",
        /// Bunches of dry grass on bare earth.
        Steppe = "Steppe",
        /// Cushions of moss.
        Moss = "Moss",
        /// Fallen leaves and twigs, as under trees.
        Litter = "Litter",
        /// Fallen needles, twigs, cones and moss, as under conifers.
        Needles = "Needles",
        /// Crumbs and clods of earth.
        Soil = "Soil",
        /// Sand in ripples of the wind.
        Sand = "Sand",
        /// Smooth sand with shells and pebbles.
        Beach = "Beach sand",
        /// Pebbles of all sizes between finer grains.
        Gravel = "Gravel",
        /// Round stones, as in the bed of a river.
        Cobbles = "Cobbles",
        /// Broken stones with flat faces.
        Scree = "Scree",
        /// Volcanic ash with stones that fell into it.
        Ash = "Ash",
        /// Powder with small craters and crumbs, as on a world without air.
        Regolith = "Regolith",
        /// Fractured slabs with layers and lichen.
        Rock = "Rock",
        /// Crystals of several colours in rounded sheets.
        Granite = "Granite",
        /// Tops of dark columns with bubbles.
        Basalt = "Basalt",
        /// Thin layers that lie across one another.
        Sandstone = "Sandstone",
        /// A dark crust in plates with glowing cracks.
        Lava = "Lava",
        /// Cold lava in folded lobes.
        RopeLava = "Rope lava",
        /// Cold lava in rubble full of holes.
        Clinker = "Clinker",
        /// Plates of dried mud with damp cracks.
        Mud = "Mud",
        /// Wet clay with puddles and runnels.
        WetMud = "Wet mud",
        /// Polygons of salt between ridges.
        Salt = "Salt",
        /// Powder snow with soft drifts.
        Snow = "Snow",
        /// Plates of hard snow, with powder between.
        Crust = "Wind crust",
        /// Ridges that the wind has carved into snow.
        Sastrugi = "Sastrugi",
        /// Old snow that the sun has melted into cups.
        Firn = "Firn",
        /// Clear and cloudy patches with cracks.
        Ice = "Ice",
        /// Clear blue ice with white cracks, bubbles and melted holes.
        BlueIce = "Blue ice",
    }
}

choice! {
    /// What a biome becomes on steep ground.
    pub enum Steep {
        /// The bare rock that all biomes share, between the slopes that all biomes share.
        Rock = "Rock",
        /// Another biome of the palette, between slopes of its own.
        Biome = "Another biome",
        /// The biome stays on every slope.
        Stays = "Stays",
    }
}

params! {
    /// One kind of ground.
    pub struct Biome {
        /// The letter of this biome in the table; unique in the palette.
        key: char = 'a', "Key", Unit::None, Domain::Letter, Stage::Material;
        /// Name of the biome.
        name: String = "Ground".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 48 }, Stage::Label;
        /// Colour of the ground (albedo, linear sRGB).
        color: [f64; 3] = [0.2, 0.18, 0.15], "Colour", Unit::None, Domain::Color, Stage::Material;
        /// Strength of the macro variation: 0 is one even colour.
        variation: f64 = 0.25, "Colour variation", Unit::None, linear(0.0, 1.0), Stage::Material;
        /// Share of the ground that has the second colour.
        patches: f64 = 0.0, "Patches", Unit::None, linear(0.0, 1.0), Stage::Material;
        /// Colour of the patches.
        patch_color: [f64; 3] = [0.25, 0.22, 0.15], "Patch colour", Unit::None, Domain::Color, Stage::Material;
        /// Size of the patches.
        patch_m: f64 = 100.0, "Patch size", Unit::Metres, log(1.0, 100_000.0), Stage::Material;
        /// Roughness of the surface: 0 is a mirror, 1 is chalk.
        roughness: f64 = 0.9, "Roughness", Unit::None, linear(0.0, 1.0), Stage::Material;
        /// Strength of the specular reflection: 0 is none, 0.25 is water, 0.5 is most minerals.
        specular: f64 = 0.2, "Specular", Unit::None, linear(0.0, 1.0), Stage::Material;
        /// Close-up pattern.
        detail: Detail = Detail::None, "Detail", Unit::None, Domain::Choice, Stage::Material;
        /// Close-up pattern of the patches. With None they have that of the biome.
        patch_detail: Detail = Detail::None, "Patch detail", Unit::None, Domain::Choice, Stage::Material;
        /// Colour picture of a texture set, which is shown in place of the close-up pattern. Pictures of normals,
        /// roughness, height and occlusion are found beside it by their names.
        #[serde(skip_serializing_if = "TextureSetFile::is_none")]
        textures: TextureSetFile = TextureSetFile::default(), "Textures", Unit::None,
            Domain::File { max_chars: 256 }, Stage::Material;
        /// Period of the pattern.
        detail_m: f64 = 2.0, "Detail size", Unit::Metres, DETAIL_SIZE, Stage::Material;
        /// Strength of the pattern: 0 is an even surface.
        detail_strength: f64 = 1.0, "Detail strength", Unit::None, linear(0.0, 2.0), Stage::Material;
        /// What the biome becomes on steep ground.
        steep: Steep = Steep::Rock, "On steep ground", Unit::None, Domain::Choice, Stage::Material;
        /// Key of the biome that replaces it on steep ground, if that is another biome.
        steep_key: char = UNSET_KEY, "Replaced by", Unit::None, Domain::BiomeKey, Stage::Material;
        /// Slope at which the other biome begins to replace it.
        steep_from_deg: f64 = 25.0, "Steep from", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Slope from which there is only the other biome.
        steep_to_deg: f64 = 35.0, "Steep to", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Biome relief: height of the hummocks and hollows that the biome adds to the ground. It fades towards
        /// neighbours as the table blends.
        relief_m: f64 = 0.0, "Relief", Unit::Metres, log(0.0, 1000.0), Stage::Height;
        /// Wavelength of the biome relief.
        relief_size_m: f64 = 50.0, "Relief size", Unit::Metres, log(1.0, 100_000.0), Stage::Field | Stage::Height;
        /// Radiance of the glowing parts: 1 is as bright as white ground under a star of brightness 1.
        glow: f64 = 0.0, "Glow", Unit::None, log(0.0, 100.0), Stage::Material;
        /// Colour of the glow.
        glow_color: [f64; 3] = [1.0, 0.25, 0.03], "Glow colour", Unit::None, Domain::Color, Stage::Material;
        /// Speed at which the pattern flows downhill, as lava does. The ground itself does not move.
        flow_m_s: f64 = 0.0, "Flow", Unit::MetresPerSecond, log(0.0, 10.0), Stage::Material;
    }
}

impl Detail {
    /// Name of the pattern as presets have it.
    pub fn name(self) -> &'static str {
        self.names()[self.index()]
    }
}

impl Biome {
    /// Close-up pattern of the patches: their own, or that of the biome.
    pub fn detail_of_patches(&self) -> Detail {
        if self.patch_detail == Detail::None { self.detail } else { self.patch_detail }
    }

    /// Whether the biome adds biome relief.
    pub fn has_relief(&self) -> bool {
        self.relief_m > 0.0
    }
}

/// The rule by which a biome is replaced on steep ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteepRule {
    /// Index into the palette; None is the bare rock that all biomes share.
    pub into: Option<usize>,
    /// Slope at which the replacement begins.
    pub from_deg: f64,
    /// Slope from which the replacement is complete.
    pub to_deg: f64,
}

impl Biomes {
    /// Index of a key in the palette.
    pub fn index_of(&self, key: char) -> Option<usize> {
        self.palette.iter().position(|biome| biome.key == key)
    }

    /// The rule for steep ground of a biome; None if it stays on every slope.
    pub fn steep_rule(&self, biome: &Biome) -> Option<SteepRule> {
        // Never a step: it would show as a line where the slope passes the limit.
        let rule = |into, from_deg: f64, to_deg: f64| SteepRule { into, from_deg, to_deg: to_deg.max(from_deg + 0.5) };
        match biome.steep {
            Steep::Rock => Some(rule(None, self.cliff_start_deg, self.cliff_full_deg)),
            Steep::Biome => {
                self.index_of(biome.steep_key).map(|index| rule(Some(index), biome.steep_from_deg, biome.steep_to_deg))
            }
            Steep::Stays => None,
        }
    }

    /// Replaces a key in the table and in all rules.
    pub fn replace_key(&mut self, old: char, new: char) {
        self.table.replace_key(old, new);
        let steep = self.palette.iter_mut().map(|biome| &mut biome.steep_key);
        for key in steep.chain([&mut self.beach_key, &mut self.snow_key]) {
            if *key == old {
                *key = new;
            }
        }
    }
}

impl Biomes {
    /// Resets the key of each rule that is off and names no biome. Older presets could hold such keys.
    pub(crate) fn forget_idle_keys(&mut self) {
        let keys: Vec<char> = self.palette.iter().map(|biome| biome.key).collect();
        let forget = |key: &mut char, is_on: bool| {
            if !is_on && !keys.contains(key) {
                *key = UNSET_KEY;
            }
        };
        forget(&mut self.beach_key, self.beach_m > 0.0);
        forget(&mut self.snow_key, self.snow);
        for biome in &mut self.palette {
            forget(&mut biome.steep_key, biome.steep == Steep::Biome);
        }
    }

    /// Gives a biome of the palette to each rule that names none: the brightest to snow, the first to all others.
    /// `idle` includes rules that are off.
    pub fn name_missing(&mut self, idle: bool) {
        let light = |biome: &Biome| biome.color.iter().sum::<f64>();
        let brightest = self.palette.iter().max_by(|a, b| light(a).total_cmp(&light(b)));
        let (Some(first), Some(brightest)) = (self.palette.first(), brightest) else { return };
        let (first, brightest) = (first.key, brightest.key);
        let keys: Vec<char> = self.palette.iter().map(|biome| biome.key).collect();
        let name = |key: &mut char, is_on: bool, with: char| {
            if (is_on || idle) && !keys.contains(key) {
                *key = with;
            }
        };
        name(&mut self.beach_key, self.beach_m > 0.0, first);
        name(&mut self.snow_key, self.snow, brightest);
        for biome in &mut self.palette {
            name(&mut biome.steep_key, biome.steep == Steep::Biome, first);
        }
    }
}

/// The biome relief of each cell of a biome table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Reliefs {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Height and wavelength in metres, row by row; height 0 is none, whatever the wavelength.
    pub(crate) cells: Vec<(f64, f64)>,
}

impl Reliefs {
    /// The wavelengths for which noise is needed.
    pub(crate) fn sizes_m(&self) -> impl Iterator<Item = f64> {
        self.cells.iter().filter(|(height_m, _)| *height_m > 0.0).map(|(_, size_m)| *size_m)
    }
}

impl Biomes {
    /// The biome relief of each cell of the table; None if no biome in it has one.
    pub(crate) fn reliefs(&self) -> Option<Reliefs> {
        if !self.palette.iter().any(Biome::has_relief) {
            return None;
        }
        let (columns, rows) = (self.table.columns(), self.table.rows().len());
        let of = |biome: &Biome| if biome.has_relief() { (biome.relief_m, biome.relief_size_m) } else { (0.0, 1.0) };
        let by_key: std::collections::BTreeMap<char, (f64, f64)> =
            self.palette.iter().rev().map(|biome| (biome.key, of(biome))).collect();
        let rows_of_cells = self.table.rows().iter().map(|row| {
            let cells = row.chars().map(|key| by_key.get(&key).copied().unwrap_or((0.0, 1.0)));
            cells.chain(std::iter::repeat((0.0, 1.0))).take(columns)
        });
        let reliefs = Reliefs { columns, rows, cells: rows_of_cells.flatten().collect() };
        let any = reliefs.sizes_m().next().is_some();
        any.then_some(reliefs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_without_a_pattern_have_that_of_the_biome() {
        let biome = Biome { detail: Detail::Sand, ..Biome::default() };
        assert_eq!(biome.detail_of_patches(), Detail::Sand);
        assert_eq!(Biome { patch_detail: Detail::Salt, ..biome }.detail_of_patches(), Detail::Salt);
        assert_eq!(Detail::RopeLava.name(), "RopeLava");
    }
}
