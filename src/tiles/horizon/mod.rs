//! Horizon angles from the heights of a surface's tiles, coarse to fine. No noise is evaluated.
//!
//! A node marches over its own mesh only where that has the right resolution: over ground nearer than [`FAR`] vertex
//! spacings, and on to twice that for its children. The horizon of farther ground comes from its parent, which has it
//! from its own mesh and from its parent. Each distance is thus seen at the level whose vertex spacing is 1/16 to 1/32
//! of it. The parent's result is corrected for the height of the child's vertices, weighted by nearness.
//!
//! - `pyramid`: heights at every level; `patch`: heights around one node; `march`: the march over a patch
mod march;
mod patch;
mod pyramid;

use super::{Leaf, Surface};
use crate::lod::cull::lowest_radius_m;
use crate::lod::horizon::{AZIMUTHS, COARSE_SIDE, HORIZON_IMAGES, HorizonTile};
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES};
use crate::lod::{Culling, View};
use crate::sphere::NodeId;
use half::f16;
use half::slice::HalfFloatSliceExt;
use march::{Along, Metric, PerVertex, Step, march};
use patch::Patch;
use pyramid::{Pyramid, mixed};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Distance in vertex spacings beyond which children use the result of their parents (half of it in the parent's
/// spacings).
const FAR: usize = 16;
/// First steps of the march in vertex spacings, and their weights: a mesh cannot tell what is so near from the local
/// slope, which shading knows better.
const FIRST: [(f32, f32); 4] = [(1.0, 0.25), (1.5, 0.5), (2.0, 0.75), (2.5, 1.0)];
/// Share of a face's width by which its coordinates are valid beyond its edge; farther ground is ignored.
const REACH: f32 = 1.0 / 8.0;
/// Tangent of an empty horizon: straight down.
const NOTHING: f32 = -1e4;

/// Statistics of computing horizon tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct HorizonWork {
    /// Tiles made.
    pub tiles: usize,
    /// Seconds it took, over all rounds.
    pub secs: f64,
}

/// Computes the horizon tiles that a view shows of a surface, coarse before fine and near before far.
pub(super) struct HorizonFinder {
    pyramid: Pyramid,
    /// Nodes whose horizon tiles are missing, level by level; the next level last.
    wanted: Vec<NodeId>,
    found: HashMap<NodeId, Arc<HorizonTile>>,
    radius_m: f64,
}

/// A horizon tile to compute: node, key, parent.
type Missing = (NodeId, u64, Option<Arc<HorizonTile>>);

impl HorizonFinder {
    /// Starts with the tiles of a surface.
    pub(super) fn new(surface: &Surface, view: &View) -> Self {
        let mut wanted = wanted_nodes(surface, view);
        wanted.reverse();
        let radius_m = surface.terrain.planet().radius_m();
        Self { pyramid: Pyramid::new(surface), wanted, found: HashMap::new(), radius_m }
    }

    /// Continues while `keep_going` says yes. Once `wanted`, asked far more often, says no, the finder is of no more
    /// use. `known` returns earlier horizon tiles; each new one is passed to `keep`. Leaves whose own tile is missing
    /// keep that of an earlier revision, or get that of a coarser node. Returns whether all tiles are there.
    pub(super) fn find(
        &mut self,
        surface: &mut Surface,
        known: &dyn Fn(NodeId) -> Option<Arc<HorizonTile>>,
        keep: &dyn Fn(&Arc<HorizonTile>),
        keep_going: &dyn Fn() -> bool,
        wanted: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        if self.wanted.is_empty() {
            return true;
        }
        profiling::scope!("horizons");
        let begun = Instant::now();
        let side = rayon::current_num_threads().max(1);
        while !self.wanted.is_empty() && keep_going() {
            let missing = self.next_missing(side, known);
            let make = |(id, key, parent): &Missing| {
                make_horizon(&self.pyramid, *id, *key, parent.as_deref(), self.radius_m, wanted).map(Arc::new)
            };
            let made: Vec<Arc<HorizonTile>> = missing.par_iter().filter_map(make).collect();
            made.iter().for_each(keep);
            surface.stats.horizons.tiles += made.len();
            self.found.extend(made.into_iter().map(|tile| (tile.id, tile)));
        }
        let done = self.wanted.is_empty();
        for leaf in &mut surface.leaves {
            attach(leaf, &self.found, done);
        }
        surface.stats.horizons.secs += begun.elapsed().as_secs_f64();
        done
    }

    /// Takes up to a number of unknown nodes of one level, and all known ones on the way.
    fn next_missing(&mut self, most: usize, known: &dyn Fn(NodeId) -> Option<Arc<HorizonTile>>) -> Vec<Missing> {
        let mut missing: Vec<Missing> = Vec::new();
        while let Some(&id) = self.wanted.last() {
            if missing.len() == most || missing.first().is_some_and(|(first, ..)| first.level != id.level) {
                break;
            }
            self.wanted.pop();
            let parent = id.parent().and_then(|parent| self.found.get(&parent));
            let Some(ground) = self.pyramid.get(id).filter(|_| parent.is_some() || id.level == 0) else { continue };
            let from_parent = parent.map_or(self.radius_m.to_bits(), |parent| parent.key);
            let key = mixed(from_parent, self.pyramid.hash_around(id));
            match known(id).filter(|tile| tile.key == key && (tile.far.is_some() || !ground.split)) {
                Some(tile) => drop(self.found.insert(id, tile)),
                None => missing.push((id, key, parent.cloned())),
            }
        }
        missing
    }
}

/// The visible leaves and all their ancestors, level by level; nearest to the eye first.
fn wanted_nodes(surface: &Surface, view: &View) -> Vec<NodeId> {
    let culling = Culling::new(view, lowest_radius_m(&surface.terrain));
    let eye = view.camera.position_planet_m;
    let mut nearest_m: HashMap<NodeId, f64> = HashMap::new();
    for leaf in surface.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)) {
        let away_m = leaf.tile.center_planet_m.distance(eye) - leaf.tile.bounding_radius_m;
        for id in std::iter::successors(Some(leaf.tile.id), |id| id.parent()) {
            let nearest = nearest_m.entry(id).or_insert(f64::MAX);
            *nearest = nearest.min(away_m);
        }
    }
    let mut sorted: Vec<(NodeId, f64)> = nearest_m.into_iter().collect();
    sorted.sort_by(|a, b| a.0.level.cmp(&b.0.level).then(a.1.total_cmp(&b.1)).then(a.0.cmp(&b.0)));
    sorted.into_iter().map(|(id, _)| id).collect()
}

/// Sets the horizon tile of a leaf. Until its own is computed, that of an earlier revision is better than a coarser
/// one.
fn attach(leaf: &mut Leaf, found: &HashMap<NodeId, Arc<HorizonTile>>, complete: bool) {
    let id = leaf.tile.id;
    let best = std::iter::successors(Some(id), |id| id.parent()).find_map(|id| found.get(&id));
    let has_own = leaf.horizon.as_ref().is_some_and(|tile| tile.id == id);
    if let Some(best) = best.filter(|best| best.id == id || complete || !has_own) {
        leaf.horizon = Some(best.clone());
    }
}

/// Computes the horizon tile of a node from the ground around it and from its parent; None if one of them is unknown,
/// or once `wanted` says no.
fn make_horizon(
    pyramid: &Pyramid,
    id: NodeId,
    key: u64,
    parent: Option<&HorizonTile>,
    radius_m: f64,
    wanted: &dyn Fn() -> bool,
) -> Option<HorizonTile> {
    profiling::scope!("horizon");
    static NEXT_SERIAL: AtomicU64 = AtomicU64::new(1);
    let reach = (REACH * TILE_QUADS as f32 * f64::from(1_u32 << id.level) as f32) as usize;
    let patch = Patch::new(pyramid, id, reach)?;
    let metric = Metric::new(id, radius_m);
    let [near_steps, far_steps] = steps(reach);
    let split = pyramid.get(id)?.split;
    let inherited = parent.and_then(|parent| Inherited::new(parent, pyramid, id));

    let mut own = vec![f16::ZERO; HORIZON_IMAGES * TILE_VERTICES];
    let mut far = split.then(|| Vec::with_capacity(AZIMUTHS * TILE_VERTICES));
    let (mut open, mut open_plane) = (vec![0.0_f32; TILE_VERTICES], vec![0.0_f32; TILE_VERTICES]);
    let slopes = Slopes::new(&patch);
    let mut sines = vec![0.0; TILE_VERTICES];
    for azimuth in 0..AZIMUTHS {
        if !wanted() {
            return None;
        }
        let dir = direction(azimuth);
        let along = metric.along(dir);
        let (mut tangents, mut nearness) = match &inherited {
            Some(inherited) => inherited.look(azimuth, &along),
            None => (vec![NOTHING; TILE_VERTICES], vec![0.0; TILE_VERTICES]),
        };
        march(&patch, dir, &along, &far_steps, &mut tangents, &mut nearness);
        if let Some(far) = &mut far {
            far.extend(tangents.iter().zip(&nearness).map(|(t, n)| [f16::from_f32(*t), f16::from_f32(*n)]));
        }
        march(&patch, dir, &along, &near_steps, &mut tangents, &mut nearness);
        slopes.add_openness(dir, &along, &mut open_plane);
        for i in 0..TILE_VERTICES {
            let tangent = tangents[i];
            let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
            sines[i] = tangent * cosine;
            open[i] += if tangent > 0.0 { cosine * cosine } else { 1.0 };
        }
        own[azimuth * TILE_VERTICES..][..TILE_VERTICES].convert_from_f32_slice(&sines);
    }
    let share: PerVertex = open.iter().zip(&open_plane).map(|(open, plane)| (open / plane).min(1.0)).collect();
    own[AZIMUTHS * TILE_VERTICES..].convert_from_f32_slice(&share);
    let coarse = match parent {
        Some(parent) => quarter(&parent.own, id.quarter()),
        None => own.chunks(TILE_VERTICES).flat_map(every_second).collect(),
    };
    Some(HorizonTile { id, serial: NEXT_SERIAL.fetch_add(1, Ordering::Relaxed), own, coarse, key, far })
}

/// Unit vector of an azimuth in the coordinates of the face.
fn direction(azimuth: usize) -> [f32; 2] {
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * azimuth as f64 / AZIMUTHS as f64);
    [cos as f32, sin as f32]
}

/// The steps of a march up to a distance in vertex spacings: near steps, and those that children need.
fn steps(reach: usize) -> [Vec<Step>; 2] {
    let plain = |spacings: usize| Step { spacings: spacings as f32, weight: 1.0 };
    let first = FIRST.map(|(spacings, weight)| Step { spacings, weight });
    let within = |step: &Step| step.spacings <= reach as f32;
    let near = first.into_iter().chain((3..FAR).map(plain)).filter(within).collect();
    [near, (FAR..2 * FAR).map(plain).filter(within).collect()]
}

/// Slopes of the ground at the vertices, in metres for each step of the grid.
struct Slopes([PerVertex; 2]);

impl Slopes {
    fn new(patch: &Patch) -> Self {
        let at = |i: usize, dx: i64, dy: i64| {
            let m = patch.margin as i64;
            let (x, y) = ((i % TILE_SIDE) as i64 + m + dx, (i / TILE_SIDE) as i64 + m + dy);
            patch.height_m[(y * patch.side as i64 + x) as usize]
        };
        let slope = |dx: i64, dy: i64| (0..TILE_VERTICES).map(|i| 0.5 * (at(i, dx, dy) - at(i, -dx, -dy))).collect();
        Self([slope(1, 0), slope(0, 1)])
    }

    /// Adds the share of the sky that a plane of these slopes leaves open in a direction.
    fn add_openness(&self, dir: [f32; 2], along: &Along, open: &mut [f32]) {
        let [s, t] = &self.0;
        for i in 0..TILE_VERTICES {
            let rise = ((s[i] * dir[0] + t[i] * dir[1]) * along.per_m[i]).max(0.0);
            open[i] += 1.0 / (1.0 + rise * rise);
        }
    }
}

/// The far horizon of a parent at the vertices of a child.
struct Inherited<'a> {
    far: &'a [[f16; 2]],
    quarter: (usize, usize),
    /// Height of the parent's mesh above the vertices of the child.
    above_m: PerVertex,
}

impl<'a> Inherited<'a> {
    fn new(parent: &'a HorizonTile, pyramid: &Pyramid, id: NodeId) -> Option<Self> {
        let (own, coarse) = (pyramid.get(id)?, pyramid.get(parent.id)?);
        let mut above_m = doubled(&coarse.height_m, id.quarter());
        above_m.iter_mut().zip(&own.height_m).for_each(|(above, own)| *above -= own);
        Some(Self { far: parent.far.as_deref()?, quarter: id.quarter(), above_m })
    }

    /// Tangents and nearness in one azimuth.
    fn look(&self, azimuth: usize, along: &Along) -> (PerVertex, PerVertex) {
        let image = &self.far[azimuth * TILE_VERTICES..][..TILE_VERTICES];
        let [tangents, nearness] = [0, 1].map(|k| image.iter().map(|far| far[k].to_f32()).collect::<PerVertex>());
        let mut tangents = doubled(&tangents, self.quarter);
        // In spacings of the child, which are half as long, everything is half as near.
        let nearness: PerVertex = doubled(&nearness, self.quarter).into_iter().map(|near| 0.5 * near).collect();
        for i in 0..TILE_VERTICES {
            tangents[i] += self.above_m[i] * nearness[i] * along.per_m[i];
        }
        (tangents, nearness)
    }
}

/// One quarter of a node's values; each new vertex between gets the mean of its neighbours.
fn doubled(values: &[f32], (right, upper): (usize, usize)) -> PerVertex {
    let half = TILE_QUADS / 2;
    let at = |x: usize, y: usize| values[(y + upper * half) * TILE_SIDE + x + right * half];
    let mut all = vec![0.0; TILE_VERTICES];
    for y in 0..TILE_SIDE {
        let (y0, y1) = (y / 2, y.div_ceil(2));
        for x in 0..TILE_SIDE {
            let (x0, x1) = (x / 2, x.div_ceil(2));
            all[y * TILE_SIDE + x] = 0.25 * ((at(x0, y0) + at(x1, y0)) + (at(x0, y1) + at(x1, y1)));
        }
    }
    all
}

/// One quarter of each image of a parent.
fn quarter(images: &[f16], (right, upper): (usize, usize)) -> Vec<f16> {
    let half = TILE_QUADS / 2;
    let rows = |image: &'_ [f16]| -> Vec<f16> {
        (0..COARSE_SIDE)
            .flat_map(|y| image[(y + upper * half) * TILE_SIDE + right * half..][..COARSE_SIDE].to_vec())
            .collect()
    };
    images.chunks(TILE_VERTICES).flat_map(rows).collect()
}

fn every_second(image: &[f16]) -> Vec<f16> {
    let at = |i: usize| image[2 * (i / COARSE_SIDE) * TILE_SIDE + 2 * (i % COARSE_SIDE)];
    (0..COARSE_SIDE * COARSE_SIDE).map(at).collect()
}

#[cfg(test)]
mod tests;
