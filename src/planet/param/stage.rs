//! The stages of a rebuild, and sets of them.

use std::fmt;

/// A stage of a rebuild. An edit makes some stages stale.
///
/// Tiles keep the results of the first four. The others fill small textures and uniforms, and rebuild no vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Noise values and gradients of one layer. Input: kind, seed, wavelength, octaves and so on.
    Field,
    /// Height: the combined layers. Input: amplitude, order, enabled, blend, masks.
    Height,
    /// Noise of temperature and moisture. Input: seed, region size, octaves.
    ClimateNoise,
    /// Temperature and moisture at sea level, and the finished vertices.
    Climate,
    /// Lists and meshes of what stands on the ground.
    Life,
    /// Textures of the biome table and the palette.
    Material,
    /// The cloud coverage map.
    CloudMap,
    /// LUT of the optical depth of the air.
    OpticalDepth,
    /// LUTs of light that the air scatters, and of the light of the sky.
    AirTables,
    /// Uniforms: water, star, rock, cloud drift, climate by height.
    Uniform,
    /// No stage: names and figures that are not drawn.
    Label,
}

impl Stage {
    /// All stages in the order in which they run.
    pub const ALL: [Stage; 11] = [
        Stage::Field,
        Stage::Height,
        Stage::ClimateNoise,
        Stage::Climate,
        Stage::Life,
        Stage::Material,
        Stage::CloudMap,
        Stage::OpticalDepth,
        Stage::AirTables,
        Stage::Uniform,
        Stage::Label,
    ];

    /// The stages that read the result of this stage.
    const fn consequences(self) -> Stages {
        match self {
            Stage::Field => Stages::of(&[Stage::Height, Stage::Climate]),
            Stage::Height | Stage::ClimateNoise => Stages::of(&[Stage::Climate]),
            // The shaders that fill these textures read the parameters from uniforms.
            Stage::OpticalDepth => Stages::of(&[Stage::AirTables, Stage::Uniform]),
            Stage::CloudMap | Stage::AirTables => Stages::of(&[Stage::Uniform]),
            Stage::Climate | Stage::Life | Stage::Material | Stage::Uniform | Stage::Label => Stages::NONE,
        }
    }
}

/// A set of stages.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Stages(u16);

impl Stages {
    /// The empty set.
    pub const NONE: Stages = Stages(0);

    /// The stages whose results are kept in tiles.
    pub const OF_TILES: Stages = Stages::of(&[Stage::Field, Stage::Height, Stage::ClimateNoise, Stage::Climate]);

    /// The set of the given stages.
    pub const fn of(stages: &[Stage]) -> Self {
        let (mut set, mut i) = (0, 0);
        while i < stages.len() {
            set |= 1 << stages[i] as u16;
            i += 1;
        }
        Self(set)
    }

    /// Whether the set contains a stage.
    pub const fn contains(self, stage: Stage) -> bool {
        self.0 & (1 << stage as u16) != 0
    }

    /// Whether the set is empty.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Union of two sets.
    pub const fn and(self, other: Stages) -> Self {
        Self(self.0 | other.0)
    }

    /// Intersection of two sets.
    pub const fn within(self, other: Stages) -> Self {
        Self(self.0 & other.0)
    }

    /// The stages that are not in the other set.
    pub const fn without(self, other: Stages) -> Self {
        Self(self.0 & !other.0)
    }

    /// The stages in the order in which they run.
    pub fn iter(self) -> impl Iterator<Item = Stage> {
        Stage::ALL.into_iter().filter(move |stage| self.contains(*stage))
    }

    /// The set, and every stage that reads the result of one of its stages.
    pub fn with_consequences(self) -> Self {
        self.iter().fold(self, |all, stage| all.and(stage.consequences()))
    }

    /// Whether any of the stages rebuilds tiles on the CPU.
    pub const fn touches_tiles(self) -> bool {
        !self.within(Self::OF_TILES).is_empty()
    }
}

impl FromIterator<Stage> for Stages {
    fn from_iter<I: IntoIterator<Item = Stage>>(stages: I) -> Self {
        stages.into_iter().fold(Stages::NONE, |all, stage| all.and(Stages::of(&[stage])))
    }
}

impl fmt::Debug for Stages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}
