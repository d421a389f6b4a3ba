//! What edits that read the ground have found out about it, node by node of a lattice. Terrains with the same ground
//! under all edits share one memory: a stroke more leaves what those before it know.

use super::gullies::Cell;
use crate::planet::Key;
use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Parts of a memory, each with a lock of its own.
const PARTS: usize = 16;

/// A node: its coordinates in a lattice.
pub(super) type Node = [i64; 3];
/// Nodes.
pub(super) type Nodes = HashSet<Node, BuildHasherDefault<Mixer>>;
/// What is known of nodes.
pub(super) type Known<V> = HashMap<Node, V, BuildHasherDefault<Mixer>>;

/// Tells a lattice and the ground that it lies in: a hash of the edits before it that are near, and of what reads them.
pub(super) type LatticeKey = u128;

/// The memory of all edits that read the ground, as far as they were asked.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// Heights of the nodes of smooth ground.
    pub(super) heights: Lattices<f64>,
    /// Waves of gullies.
    pub(super) cells: Lattices<Cell>,
}

impl Memory {
    /// The memory of the terrains whose ground under all edits has this key. It forgets the lattices that are not among
    /// `used`; terrains of earlier revisions find them out again where they still ask.
    pub(super) fn of(ground: Key, used: &HashSet<LatticeKey>) -> Arc<Self> {
        static LAST: Mutex<Option<(Key, Arc<Memory>)>> = Mutex::new(None);
        let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
        let memory = match &*last {
            Some((key, memory)) if *key == ground => memory.clone(),
            _ => Arc::default(),
        };
        memory.heights.retain(used);
        memory.cells.retain(used);
        *last = Some((ground, memory.clone()));
        memory
    }
}

/// Lattices by their keys.
#[derive(Debug)]
pub(super) struct Lattices<V> {
    parts: [Mutex<HashMap<LatticeKey, Known<V>>>; PARTS],
}

impl<V> Default for Lattices<V> {
    fn default() -> Self {
        Self { parts: Default::default() }
    }
}

impl<V: Copy> Lattices<V> {
    fn part(&self, lattice: LatticeKey) -> MutexGuard<'_, HashMap<LatticeKey, Known<V>>> {
        self.parts[(lattice % PARTS as u128) as usize].lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn retain(&self, used: &HashSet<LatticeKey>) {
        for part in &self.parts {
            part.lock().unwrap_or_else(PoisonError::into_inner).retain(|lattice, _| used.contains(lattice));
        }
    }

    /// What is known of nodes of a lattice, and the nodes of which nothing is known.
    pub(super) fn recall(&self, lattice: LatticeKey, nodes: impl IntoIterator<Item = Node>) -> (Known<V>, Vec<Node>) {
        let part = self.part(lattice);
        let nodes = nodes.into_iter();
        let Some(of_lattice) = part.get(&lattice) else { return (Known::default(), nodes.collect()) };
        let (mut known, mut missing) = (Known::default(), Vec::new());
        for node in nodes {
            if let Some(value) = of_lattice.get(&node) {
                known.insert(node, *value);
            } else {
                missing.push(node);
            }
        }
        (known, missing)
    }

    /// Remembers nodes.
    pub(super) fn keep(&self, lattice: LatticeKey, new: &[(Node, V)]) {
        let mut part = self.part(lattice);
        part.entry(lattice).or_default().extend(new.iter().copied());
    }
}

/// A quick hash of nodes.
#[derive(Debug, Default)]
pub(super) struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u64(&mut self, word: u64) {
        let mixed = (self.0 ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.0 = mixed ^ (mixed >> 29);
    }

    fn write_i64(&mut self, word: i64) {
        self.write_u64(word as u64);
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }
}
