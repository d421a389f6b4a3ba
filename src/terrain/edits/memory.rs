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
    /// The ground under all edits.
    ground: Key,
    /// Heights of the nodes of smooth ground.
    pub(super) heights: Lattices<f64>,
    /// Waves of gullies.
    pub(super) cells: Lattices<Cell>,
}

impl Memory {
    /// The memory of a terrain whose ground under all edits has this key: that of an earlier terrain over the same
    /// ground. It forgets the lattices that are not among `used`; the earlier terrain finds them out again where it
    /// still asks.
    pub(super) fn after(before: &Arc<Self>, ground: Key, used: &HashSet<LatticeKey>) -> Arc<Self> {
        if before.ground != ground {
            return Arc::new(Self { ground, ..Self::default() });
        }
        before.heights.retain(used);
        before.cells.retain(used);
        before.clone()
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
