//! What edits read besides the ground under a point.
//!
//! Some read the ground around a point, as the edits before them left it. What they need is found before the points
//! are changed, in two passes over those edits. The first goes back from the last: it lists the nodes that each edit
//! must know, which are those around the points and around the nodes of later edits. The second goes forward: it
//! evaluates the heights of those nodes, each from the last edit before that knows it. So edits that lie over one
//! another by the hundred cost what each does to its nodes.

use super::compiled::CompiledEdit;
use super::gullies::{Carved, Cell, Gullies, Waves};
use super::memory::{Known, Memory, Node, Nodes};
use super::near::{Near, Touch};
use super::outline::{Noise, Sampled};
use super::smooth::Lattice;
use super::stamp::{Stamp, Stamped};
use super::{Edits, Span};
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};

/// Quantity that a tool reads.
#[derive(Clone, Debug)]
pub(super) enum Reads {
    Nothing,
    /// Value of the nearest arc of a line with two sides.
    Sides,
    /// Heights of the near parts of the line, averaged.
    Heights,
    /// Noise of rough ground.
    Noise(Noise),
    /// Value of a picture over its level; None while it is not loaded.
    Picture(Option<Stamp>),
    /// Ground around the point.
    Around(Reader),
}

/// Quantity at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample<'a> {
    pub(super) value: f64,
    pub(super) slope: Slope<'a>,
}

/// Gradient of a quantity by the direction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Slope<'a> {
    None,
    /// Gradient along a line; it shows where the edit does.
    Line(DVec3),
    /// Gradient of ground that has far larger features than the edit.
    Ground(DVec3),
    Noise(Sampled),
    Picture(Stamped<'a>),
    Gullies(Carved),
}

impl Slope<'_> {
    /// The part of the gradient that points so far apart can show. Lines have none here.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        match self {
            Slope::None | Slope::Line(_) => DVec3::ZERO,
            Slope::Ground(gradient) => *gradient,
            Slope::Noise(noise) => noise.gradient(spacing_rad),
            Slope::Picture(stamped) => stamped.gradient(spacing_rad),
            Slope::Gullies(carved) => carved.gradient(spacing_rad),
        }
    }
}

/// Reader of the ground around a point.
#[derive(Clone, Debug)]
pub(super) enum Reader {
    /// Ground without fine detail.
    Smooth(Lattice),
    /// Gullies down the slopes of that ground.
    Gullies(Gullies),
}

/// Nodes that an edit must know.
#[derive(Debug, Default)]
struct Wish {
    heights: Nodes,
    /// Cells of gullies, for each octave.
    cells: Vec<Nodes>,
}

/// Ground around some points, for an edit.
#[derive(Debug, Default)]
pub(super) struct Surroundings {
    heights: Known<f64>,
    /// Waves of gullies, for each octave.
    cells: Vec<Known<Cell>>,
}

/// Ground around some points, for all edits that read it, by their slots.
#[derive(Debug, Default)]
pub(crate) struct Surrounded(HashMap<u32, Surroundings>);

/// Work of the second pass for an edit.
struct Plan<'a> {
    slot: u32,
    edit: &'a CompiledEdit,
    reader: &'a Reader,
    heights: Known<f64>,
    /// Nodes without heights, by the slot of the edit from which they are evaluated; None: from the layers on.
    missing: BTreeMap<Option<u32>, Vec<Node>>,
    waves: Option<Waves>,
}

impl Reader {
    /// The lattice at whose nodes it reads heights.
    pub(super) fn lattice(&self) -> &Lattice {
        match self {
            Reader::Smooth(lattice) => lattice,
            Reader::Gullies(gullies) => gullies.lattice(),
        }
    }

    /// Angle within which the ground decides about a point.
    pub(super) fn reach_rad(&self) -> f64 {
        match self {
            Reader::Smooth(lattice) => lattice.reach_rad(),
            Reader::Gullies(gullies) => gullies.reach_rad(),
        }
    }

    fn ask(&self, dir: DVec3, wish: &mut Wish) {
        match self {
            Reader::Smooth(lattice) => lattice.ask(dir, &mut wish.heights),
            Reader::Gullies(gullies) => gullies.ask(dir, &mut wish.cells),
        }
    }

    /// The quantity at one of the points that were asked for.
    pub(super) fn at(&self, dir: DVec3, around: &Surroundings) -> Sample<'static> {
        match self {
            Reader::Smooth(lattice) => {
                let (value, gradient) = lattice.at(dir, &around.heights);
                Sample { value, slope: Slope::Ground(gradient) }
            }
            Reader::Gullies(gullies) => {
                let carved = gullies.at(dir, &around.cells);
                Sample { value: carved.height_m, slope: Slope::Gullies(carved) }
            }
        }
    }
}

impl Surroundings {
    fn height_m(&self, node: &Node) -> f64 {
        self.heights.get(node).copied().unwrap_or(0.0)
    }
}

impl Surrounded {
    /// The surroundings for the edit in a slot. None if no point is within its reach.
    pub(super) fn of(&self, slot: u32) -> Option<&Surroundings> {
        self.0.get(&slot)
    }
}

/// Heights of the ground at directions after a span of edits. They begin with heights that are known, or else with
/// those of the layers. Edits of the span find what they read.
type Evaluate<'a> = dyn FnMut(&[DVec3], Option<&[f64]>, Span, &Surrounded) -> Vec<f64> + 'a;

impl Edits {
    /// Reads the ground around points for all edits that need it.
    pub(crate) fn surroundings(
        &self,
        dirs: &[DVec3],
        near: &mut Near,
        memory: &Memory,
        evaluate: &mut Evaluate<'_>,
    ) -> Surrounded {
        let mut surrounded = Surrounded::default();
        if self.reading.is_empty() {
            return surrounded;
        }
        // By the order in which edits act.
        let mut wishes = BTreeMap::new();
        self.ask(dirs, Span::default(), near, &mut wishes);
        let mut plans = Vec::new();
        while let Some((_, (slot, wish))) = wishes.pop_last() {
            let Some(plan) = self.plan(slot, wish, memory) else { continue };
            for (source, nodes) in &plan.missing {
                if let Some(source) = *source {
                    let (_, wish) =
                        wishes.entry(self.roster.rank_of(source)).or_insert_with(|| (source, Wish::default()));
                    wish.heights.extend(nodes);
                }
                let span = Span { from: *source, before: Some(slot) };
                self.ask(&plan.dirs(nodes), span, near, &mut wishes);
            }
            plans.push(plan);
        }
        for mut plan in plans.into_iter().rev() {
            let key = plan.edit.lattice_key();
            for (source, nodes) in std::mem::take(&mut plan.missing) {
                let begun_m =
                    |source: &Surroundings| nodes.iter().map(|node| source.height_m(node)).collect::<Vec<f64>>();
                let begun_m = source.and_then(|source| surrounded.of(source)).map(begun_m);
                let span = Span { from: source, before: Some(plan.slot) };
                let heights_m = evaluate(&plan.dirs(&nodes), begun_m.as_deref(), span, &surrounded);
                let new: Vec<(Node, f64)> = nodes.into_iter().zip(heights_m).collect();
                memory.heights.keep(key, &new);
                plan.heights.extend(new);
            }
            let cells = match (plan.reader, plan.waves) {
                (Reader::Gullies(gullies), Some(waves)) => gullies.finish(key, waves, &plan.heights, memory),
                _ => Vec::new(),
            };
            surrounded.0.insert(plan.slot, Surroundings { heights: plan.heights, cells });
        }
        surrounded
    }

    /// Adds what the edits of a span need at directions to the wishes, which are by rank, with the slots.
    fn ask(&self, dirs: &[DVec3], span: Span, near: &mut Near, wishes: &mut BTreeMap<u32, (u32, Wish)>) {
        let ranks = self.ranks(span);
        let acts = |slot: u32, _: &CompiledEdit| ranks.contains(&self.roster.rank_of(slot));
        near.each_touch(&self.reading, &self.roster, dirs, acts, |Touch { slot, edit, hits, .. }| {
            let Some(reader) = edit.reader() else { return };
            let (_, wish) = wishes.entry(self.roster.rank_of(slot)).or_insert_with(|| (slot, Wish::default()));
            hits.iter().for_each(|hit| reader.ask(dirs[hit.point], wish));
        });
    }

    /// What is known of the nodes that an edit needs, and where the heights of the others begin.
    fn plan(&self, slot: u32, mut wish: Wish, memory: &Memory) -> Option<Plan<'_>> {
        let edit = self.roster.edit(slot)?;
        let reader = edit.reader()?;
        let key = edit.lattice_key();
        let waves = match reader {
            Reader::Smooth(_) => None,
            Reader::Gullies(gullies) => Some(gullies.recall(key, wish.cells, &mut wish.heights, memory)),
        };
        let (heights, lacking) = memory.heights.recall(key, wish.heights);
        let mut missing: BTreeMap<Option<u32>, Vec<Node>> = BTreeMap::new();
        for node in lacking {
            let dir = reader.lattice().dir(node);
            let knows = |slot: &u32| self.roster.edit(*slot).is_some_and(|edit| edit.surrounds(dir));
            missing.entry(edit.context.sources.iter().copied().find(knows)).or_default().push(node);
        }
        Some(Plan { slot, edit, reader, heights, missing, waves })
    }
}

impl Plan<'_> {
    fn dirs(&self, nodes: &[Node]) -> Vec<DVec3> {
        nodes.iter().map(|node| self.reader.lattice().dir(*node)).collect()
    }
}
