//! Implicit tiling (3D Tiles 1.1, OGC 22-025r4, chapter 9): each face of the cube sphere is a quadtree whose tiles are
//! not listed. A subtree file says which of them are there, and the box and the error of each.
//!
//! A reader that knows no more of a tile than its place divides the box of the face evenly. Squares of a sphere do not
//! lie in such boxes: the files give every tile its own, with the semantics TILE_BOUNDING_BOX and TILE_GEOMETRIC_ERROR,
//! which come before what is derived. Only the root of a subtree is without one until its file is there; hence a face
//! is one subtree.

use crate::sphere::{Face, NodeId};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Finest level: a file has a bit for each tile that could be there.
pub(super) const MAX_LEVEL: u8 = 10;
/// Length of the head of a file, and what its parts are padded to, in bytes.
const HEAD: usize = 24;
const ALIGNMENT: usize = 8;

/// What a viewer must know of a tile before it loads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outline {
    /// A box around it and all that it is divided into, in the planet frame, metres: the centre, and half of each side
    /// as a vector.
    pub(super) bounds: [f64; 12],
    /// Its geometric error, metres.
    pub(super) error_m: f64,
}

/// The tiles of a face.
#[derive(Default)]
pub(super) struct Subtree {
    /// By their place in the order of the file.
    tiles: BTreeMap<usize, Outline>,
    /// Levels with tiles.
    levels: u8,
}

impl Subtree {
    /// Adds a tile.
    pub(super) fn add(&mut self, node: NodeId, outline: Outline) {
        self.tiles.insert(index(node), outline);
        self.levels = self.levels.max(node.level + 1);
    }

    /// The tile of a face in the tileset: the root of the quadtree.
    pub(super) fn root(&self, face: Face) -> Value {
        let root = self.tiles.get(&0);
        json!({
            "boundingVolume": { "box": root.map_or([0.0; 12], |outline| outline.bounds) },
            "geometricError": root.map_or(0.0, |outline| outline.error_m),
            "refine": "REPLACE",
            "content": { "uri": format!("{{level}}/{}_{{x}}_{{y}}.glb", face.name()) },
            "implicitTiling": {
                "subdivisionScheme": "QUADTREE",
                "availableLevels": self.levels,
                "subtreeLevels": self.levels,
                "subtrees": { "uri": format!("subtrees/{}_{{level}}_{{x}}_{{y}}.subtree", face.name()) },
            },
        })
    }

    /// The file.
    pub(super) fn encode(&self) -> Vec<u8> {
        let mut binary = Vec::new();
        let mut views = Vec::new();
        let mut view = |bytes: &[u8]| {
            views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() }));
            binary.extend_from_slice(bytes);
            pad(&mut binary, 0);
            views.len() - 1
        };
        let places = first(self.levels);
        let available = if self.tiles.len() == places {
            json!({ "constant": 1 })
        } else {
            json!({ "bitstream": view(&bits(self.tiles.keys().copied(), places)), "availableCount": self.tiles.len() })
        };
        let numbers = |values: &mut dyn Iterator<Item = f64>| values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>();
        let bounds = view(&numbers(&mut self.tiles.values().flat_map(|outline| outline.bounds)));
        let errors = view(&numbers(&mut self.tiles.values().map(|outline| outline.error_m)));
        let mut json = json!({
            "buffers": [{ "byteLength": binary.len() }],
            "bufferViews": views,
            "propertyTables": [{
                "class": "tile",
                "count": self.tiles.len(),
                "properties": { "bounds": { "values": bounds }, "error_m": { "values": errors } },
            }],
            "tileAvailability": available,
            "contentAvailability": [available],
            "childSubtreeAvailability": { "constant": 0 },
            "tileMetadata": 0,
        })
        .to_string()
        .into_bytes();
        pad(&mut json, b' ');
        let mut file = Vec::with_capacity(HEAD + json.len() + binary.len());
        file.extend_from_slice(b"subt");
        file.extend_from_slice(&1_u32.to_le_bytes());
        for part in [&json, &binary] {
            file.extend_from_slice(&(part.len() as u64).to_le_bytes());
        }
        file.append(&mut json);
        file.append(&mut binary);
        file
    }
}

/// Where the file of a face is, in the folder of the tileset.
pub(super) fn uri(face: Face) -> String {
    format!("subtrees/{}_0_0_0.subtree", face.name())
}

/// What the numbers of the files mean.
pub(super) fn schema() -> Value {
    json!({
        "id": "tiles",
        "classes": {
            "tile": {
                "properties": {
                    "bounds": {
                        "type": "SCALAR",
                        "componentType": "FLOAT64",
                        "array": true,
                        "count": 12,
                        "required": true,
                        "semantic": "TILE_BOUNDING_BOX",
                    },
                    "error_m": {
                        "type": "SCALAR",
                        "componentType": "FLOAT64",
                        "required": true,
                        "semantic": "TILE_GEOMETRIC_ERROR",
                    },
                },
            },
        },
    })
}

/// The place of a tile: level by level from the coarsest, each along the Z-order curve (Morton 1966).
fn index(node: NodeId) -> usize {
    first(node.level) + (spread(node.x) | spread(node.y) << 1)
}

/// Tiles of all levels before one: the first place of that level.
fn first(level: u8) -> usize {
    ((1 << (2 * u32::from(level))) - 1) / 3
}

/// The bits of a number with a gap after each.
fn spread(number: u32) -> usize {
    (0..u32::from(MAX_LEVEL)).map(|bit| ((number >> bit & 1) as usize) << (2 * bit)).sum()
}

/// A bit for each of `count` places, from the lowest of each byte.
fn bits(set: impl Iterator<Item = usize>, count: usize) -> Vec<u8> {
    let mut bytes = vec![0; count.div_ceil(8)];
    for place in set {
        bytes[place / 8] |= 1 << (place % 8);
    }
    bytes
}

fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), with);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn node(level: u8, x: u32, y: u32) -> NodeId {
        NodeId { level, face: Face::NegY, x, y }
    }

    /// A level, a column and a row that it has.
    fn nodes() -> impl Strategy<Value = NodeId> {
        (0..=MAX_LEVEL).prop_flat_map(|level| {
            let side = 1_u32 << level;
            (0..side, 0..side).prop_map(move |(x, y)| node(level, x, y))
        })
    }

    #[test]
    fn places_follow_the_curve_level_by_level() {
        // As the figures of the standard number them: x first.
        assert_eq!(index(node(0, 0, 0)), 0);
        assert_eq!([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| index(node(1, x, y))), [1, 2, 3, 4]);
        assert_eq!([(0, 0), (2, 0), (0, 2), (3, 3)].map(|(x, y)| index(node(2, x, y))), [5, 9, 13, 20]);
        let mut places: Vec<_> = (0..4)
            .flat_map(|level| (0..1 << level).flat_map(move |y| (0..1 << level).map(move |x| index(node(level, x, y)))))
            .collect();
        places.sort_unstable();
        assert!(places.into_iter().eq(0..85));
    }

    proptest! {
        #[test]
        fn the_children_of_a_tile_lie_side_by_side(node in nodes()) {
            prop_assume!(node.level < MAX_LEVEL);
            let offset = index(node) - first(node.level);
            let children = node.children().map(|child| index(child) - first(child.level));
            prop_assert_eq!(children, [0, 1, 2, 3].map(|child| 4 * offset + child));
        }

        #[test]
        fn bits_are_those_of_the_places(set in prop::collection::btree_set(0_usize..341, 0..341)) {
            let bytes = bits(set.iter().copied(), 341);
            prop_assert_eq!(bytes.len(), 43);
            for place in 0..344 {
                prop_assert_eq!(bytes[place / 8] >> (place % 8) & 1 == 1, set.contains(&place));
            }
        }
    }

    /// The parts of a file: its JSON, and its views.
    fn read(file: &[u8]) -> (Value, Vec<Vec<u8>>) {
        let length = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
        assert_eq!((&file[..4], &file[4..8]), (&b"subt"[..], &[1, 0, 0, 0][..]));
        let (json, binary) = (length(8), length(16));
        assert_eq!((json % 8, binary % 8, HEAD + json + binary), (0, 0, file.len()));
        let parsed: Value = serde_json::from_slice(&file[HEAD..HEAD + json]).unwrap();
        assert_eq!(parsed["buffers"][0]["byteLength"], binary);
        let views = parsed["bufferViews"].as_array().unwrap().iter().map(|view| {
            let [start, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
            assert!(start % 8 == 0 && start + length <= binary);
            file[HEAD + json + start..][..length].to_vec()
        });
        let views = views.collect();
        (parsed, views)
    }

    fn outline(number: f64) -> Outline {
        Outline { bounds: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11].map(|i| number + f64::from(i)), error_m: -number }
    }

    #[test]
    fn a_file_has_the_outlines_of_the_tiles_that_are_there_in_their_order() {
        let mut subtree = Subtree::default();
        // Not in the order of the file; a quarter is divided.
        let root = node(0, 0, 0);
        let tiles = [node(1, 1, 0).children(), root.children()].concat();
        for (i, tile) in tiles.iter().chain([&root]).enumerate() {
            subtree.add(*tile, outline(100.0 * i as f64));
        }
        let (json, views) = read(&subtree.encode());
        let available = &json["tileAvailability"];
        assert_eq!(available["availableCount"], 9);
        assert_eq!(&json["contentAvailability"][0], available);
        assert_eq!(json["childSubtreeAvailability"]["constant"], 0);
        // Tiles 0 to 4, and 9 to 12 of 21.
        assert_eq!(views[available["bitstream"].as_u64().unwrap() as usize], [0b0001_1111, 0b0001_1110, 0]);
        let table = &json["propertyTables"][json["tileMetadata"].as_u64().unwrap() as usize];
        assert_eq!((&table["count"], &table["class"]), (&9.into(), &"tile".into()));
        let numbers = |name: &str| -> Vec<f64> {
            let view = &views[table["properties"][name]["values"].as_u64().unwrap() as usize];
            view.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()
        };
        let order = [8, 4, 5, 6, 7, 0, 1, 2, 3].map(|i| outline(100.0 * f64::from(i)));
        assert_eq!(numbers("error_m"), order.map(|outline| outline.error_m));
        assert_eq!(numbers("bounds"), order.map(|outline| outline.bounds).concat());
        let tile = subtree.root(Face::NegY);
        assert_eq!((&tile["geometricError"], &tile["implicitTiling"]["subtreeLevels"]), (&(-800.0).into(), &3.into()));
        assert_eq!(tile["content"]["uri"], "{level}/neg_y_{x}_{y}.glb");
    }

    #[test]
    fn a_quadtree_without_gaps_needs_no_bits() {
        let mut subtree = Subtree::default();
        let root = node(0, 0, 0);
        root.children().iter().chain([&root]).for_each(|tile| subtree.add(*tile, outline(1.0)));
        let (json, views) = read(&subtree.encode());
        assert_eq!((&json["tileAvailability"]["constant"], views.len()), (&1.into(), 2));
        assert_eq!(views[0].len() + views[1].len(), 5 * 13 * 8);
    }
}
