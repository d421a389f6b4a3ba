//! What a tile of a tileset tells of itself, in its file: a bake that goes on needs it of tiles that are there.

use super::patch::Patch;
use crate::planet::open::open_file;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::io::Read as _;
use std::path::Path;

/// Longest description of a tile: that of one has a few thousand bytes.
const MOST_JSON_BYTES: u64 = 1 << 20;

/// What a tile tells of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Measures {
    /// Extremes of its vertices over the reference sphere, lakes and seas included.
    pub(super) lowest_m: f64,
    pub(super) highest_m: f64,
    /// Greatest distance of a vertex from the mesh of every second one.
    pub(super) coarser_m: f64,
}

impl Measures {
    pub(super) fn of(patch: &Patch, radius_m: f64) -> Self {
        let mut measures = Self { lowest_m: f64::INFINITY, highest_m: f64::NEG_INFINITY, coarser_m: 0.0 };
        for (i, vertex) in patch.vertices.iter().enumerate() {
            let height_m = vertex.position_m.distance(patch.center_m) - radius_m;
            measures.lowest_m = measures.lowest_m.min(height_m);
            measures.highest_m = measures.highest_m.max(height_m);
            let (row, column) = (i / patch.side, i % patch.side);
            // The diagonal of a cell runs from its lower left to its upper right corner.
            let (before, after) = match (row % 2, column % 2) {
                (0, 0) => continue,
                (0, _) => ((row, column - 1), (row, column + 1)),
                (_, 0) => ((row - 1, column), (row + 1, column)),
                _ => ((row + 1, column - 1), (row - 1, column + 1)),
            };
            let at = |(row, column): (usize, usize)| patch.at(row, column).position_m;
            let away_m = vertex.position_m.distance(0.5 * (at(before) + at(after)));
            measures.coarser_m = measures.coarser_m.max(away_m);
        }
        measures
    }

    /// The measures in a file; None if it is no tile.
    pub(super) fn read(path: &Path) -> Option<Self> {
        let mut file = open_file(path).ok()?;
        let mut head = [0; 20];
        file.read_exact(&mut head).ok()?;
        let length = head.starts_with(b"glTF").then(|| u32::from_le_bytes([head[12], head[13], head[14], head[15]]))?;
        let mut json = Vec::new();
        file.take(u64::from(length).min(MOST_JSON_BYTES)).read_to_end(&mut json).ok()?;
        let document: Value = serde_json::from_slice(&json).ok()?;
        serde_json::from_value(document.get("nodes")?.get(0)?.get("extras")?.get("measures")?.clone()).ok()
    }
}
