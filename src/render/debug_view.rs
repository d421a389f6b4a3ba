//! Debug views: what a picture shows of the ground in the place of the planet in its light.

use crate::world::MapView;

/// Picture that is drawn of the surface: shaded, or one of its fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DebugView {
    /// The planet.
    #[default]
    Shaded,
    /// Height, from the lowest to the highest of the surface.
    Height,
    /// The normal in the planet frame as a colour.
    Normal,
    /// Angle against the horizontal, 0 to 60°.
    Slope,
    /// The biome's colour by itself.
    Biome,
    /// Temperature, -40 to 40 °C.
    Temperature,
    /// Moisture, dry to wet.
    Moisture,
    /// The tile's level in the quadtree.
    Lod,
    /// Lines where tiles meet.
    TileBorders,
    /// The edges of the triangles.
    Wireframe,
    /// Vertex spacing in pixels of the picture, as the level of detail sees it: blue 1, green 4, yellow 16, red 64.
    Error,
    /// White where there is ground, black elsewhere.
    Coverage,
    /// The ground's albedo with its patterns, without light.
    Albedo,
    /// The plates of a structure, with darts along their motion.
    Plates,
    /// The rain of a structure, with darts along the wind.
    Rain,
    /// The basins, rivers and lakes of a structure.
    Rivers,
    /// How many objects of a population stand there, from none to the most of it: [`Scene::population`].
    ///
    /// [`Scene::population`]: super::Scene::population
    Density,
}

impl DebugView {
    /// All of them.
    pub const ALL: [DebugView; 17] = [
        DebugView::Shaded,
        DebugView::Height,
        DebugView::Normal,
        DebugView::Slope,
        DebugView::Biome,
        DebugView::Temperature,
        DebugView::Moisture,
        DebugView::Lod,
        DebugView::TileBorders,
        DebugView::Wireframe,
        DebugView::Error,
        DebugView::Coverage,
        DebugView::Albedo,
        DebugView::Plates,
        DebugView::Rain,
        DebugView::Rivers,
        DebugView::Density,
    ];

    /// The map of the structure that it shows, if it shows one.
    pub(crate) fn map(self) -> Option<MapView> {
        match self {
            DebugView::Plates => Some(MapView::Plates),
            DebugView::Rain => Some(MapView::Rain),
            DebugView::Rivers => Some(MapView::Rivers),
            _ => None,
        }
    }

    /// Whether it shows a map of the structure: of a planet without one it is an even grey.
    pub fn needs_structure(self) -> bool {
        self.map().is_some()
    }

    /// The name that the editor shows.
    pub fn label(self) -> &'static str {
        match self {
            DebugView::Shaded => "Shaded",
            DebugView::Height => "Height",
            DebugView::Normal => "Normal",
            DebugView::Slope => "Slope",
            DebugView::Biome => "Biome",
            DebugView::Temperature => "Temperature",
            DebugView::Moisture => "Moisture",
            DebugView::Lod => "Level",
            DebugView::TileBorders => "Tile borders",
            DebugView::Error => "Error",
            DebugView::Wireframe => "Wireframe",
            DebugView::Coverage => "Coverage",
            DebugView::Albedo => "Albedo",
            DebugView::Plates => "Plates",
            DebugView::Rain => "Rain",
            DebugView::Rivers => "Rivers",
            DebugView::Density => "Density",
        }
    }
}
