//! Nodes around the eye whose objects a view needs: cells of populations, and groups of cells where few objects stand
//! for all.

use super::grid::angle;
use super::placement::Placement;
use super::thinning::Thinning;
use crate::lod::View;
use crate::planet::Key;
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use glam::DVec3;

/// Share of the height above the ground that counts for the reach: hills may rise towards the eye.
const HEIGHT_COUNTS: f64 = 0.8;

/// Share of its distance at which a node counts for the objects that it holds: the eye moves on before the next list.
const NEARER: f64 = 0.8;
/// Share of the objects from which on groups of cells hold what is left.
const GROUPED: f64 = 1.0 / 16.0;
/// Least share of the objects that a list of low ranks holds.
const LEAST_STEP: f64 = 1.0 / 1024.0;

/// A cell that a view needs.
pub(super) struct Needed<'a> {
    pub(super) placement: &'a Placement,
    /// A cell, or a group of them.
    pub(super) id: NodeId,
    /// Rank below which its objects are needed.
    pub(super) limit: f64,
    pub(super) rules: Key,
    pub(super) ground: Key,
    away_m: f64,
}

impl Needed<'_> {
    pub(super) fn soil_node(&self) -> Option<NodeId> {
        self.placement.soil_node(self.id)
    }

    /// Nodes whose objects are those of this one: its group, or its cells.
    pub(super) fn standing_in(&self) -> impl Iterator<Item = NodeId> {
        let (cells, groups) = (self.placement.grid.level, self.placement.group_level());
        let group = (self.id.level == cells && groups < cells).then(|| {
            let up = cells - groups;
            NodeId { level: groups, x: self.id.x >> up, y: self.id.y >> up, ..self.id }
        });
        let own = (self.id.level < cells).then(|| self.id.descendants(cells));
        group.into_iter().chain(own.into_iter().flatten())
    }
}

/// Cells around the eye that a view needs, nearest first: those behind it, too, for shadows, and because it may turn
/// before the next surface is there.
///
/// `placements`, `thinnings`: all that are on, and how each thins out.
pub(super) fn needed<'a>(
    terrain: &Terrain,
    view: &View,
    (placements, thinnings): (&'a [Placement], &[Thinning]),
) -> Vec<Needed<'a>> {
    let planet = terrain.planet();
    let (eye, planet_m) = (view.camera.position_planet_m, planet.radius_m());
    let farthest_m = thinnings.iter().map(|thinning| thinning.reach_m).fold(0.0, f64::max);
    // From orbit the ground below is not even asked for.
    if eye.length() - planet_m - terrain.height_bounds_m().1 > farthest_m / HEIGHT_COUNTS {
        return Vec::new();
    }
    let dir = eye.normalize_or(DVec3::Z);
    let ground_m = planet_m + terrain.height_m(dir).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let below_m = HEIGHT_COUNTS * (eye.length() - ground_m).max(0.0);
    if below_m > farthest_m {
        return Vec::new();
    }
    // What decides about the ground, the climate and the biomes of a place.
    let site = Key::of(&(&planet.biomes, &planet.climate, planet.sea_level_m(), planet.radius_km, planet.seed));
    // Few nodes are touched by edits.
    let keys = terrain.tile_keys();
    let untouched = Key::of(&(keys, None::<Key>));
    let mut needed = Vec::new();
    for (placement, thinning) in placements.iter().zip(thinnings) {
        // From above, less of the ground is in reach.
        let flat_m = (thinning.reach_m.powi(2) - below_m.powi(2)).max(0.0).sqrt();
        if flat_m <= 0.0 {
            continue;
        }
        let rules = Key::of(&(site, placement.population().placed()));
        let mut need = |id: NodeId, limit: f64| {
            let own = (terrain.with_edits_near(keys, id), placement.edits_key(terrain, id));
            let ground = if own == (keys, None) { untouched } else { Key::of(&own) };
            let away_m = angle(id.direction(0.5, 0.5), dir) * planet_m;
            needed.push(Needed { placement, id, limit, rules, ground, away_m });
        };
        let thins = thinning.full_m.is_finite();
        let limit = |id: NodeId| {
            if !thins {
                return 1.0;
            }
            let middle = id.direction(0.5, 0.5);
            let half_m = 1.1 * angle(middle, id.direction(0.0, 0.0)) * planet_m;
            let nearest_m = (angle(middle, dir) * planet_m - half_m).max(0.0).hypot(below_m);
            step(thinning.limit(NEARER * nearest_m))
        };
        let cells = placement.grid.level;
        let groups = if thins { placement.group_level() } else { cells };
        for node in placement.grid.nodes_within(groups, dir, flat_m) {
            let least = limit(node);
            if groups == cells || least <= GROUPED {
                need(node, least);
            } else {
                node.descendants(cells).for_each(|cell| need(cell, limit(cell)));
            }
        }
    }
    needed.sort_by(|a, b| {
        a.away_m.total_cmp(&b.away_m).then(a.id.cmp(&b.id)).then(a.placement.index.cmp(&b.placement.index))
    });
    needed
}

/// The least half of a half, and so on, that is not below a share: lists change seldom while the eye moves.
fn step(share: f64) -> f64 {
    let mut step = 1.0;
    while 0.5 * step >= share && step > LEAST_STEP {
        step *= 0.5;
    }
    step
}
