//! Forms of plants and stones: meshes made from a few parameters and a seed.
//!
//! - `build`, `math`, `random`: meshes, arithmetic and random numbers, the same on every machine
//! - `tube`, `leaf`, `sphere`, `grow`, `clump`: parts that several kinds share
//! - `sight`, `steer`: what is seen from the side and from above, and the search for levels of detail that match
//! - `cover`: how much a form covers, and its light, for what is seen of many from afar
//! - `tree`, `crown`, `foliage`, `conifer`, `palm`, `tuft`, `cushion`, `cactus`, `mushroom`: kinds of plant
//! - `wood`: fallen wood; `stone`, `crystal`: kinds of rock; `bulbs`, `fans`, `tendrils`: kinds of strange life
//! - `artist`: meshes of files; `shade`: their light, `thin`: their levels of detail; `stand_in`: what is drawn of an
//!   object that a game draws

mod artist;
#[cfg(test)]
mod artist_tests;
mod build;
mod bulbs;
mod cactus;
mod clump;
mod conifer;
pub(crate) mod cover;
mod crown;
mod crystal;
mod cushion;
mod fans;
mod foliage;
mod grow;
mod leaf;
mod math;
mod mushroom;
mod palm;
mod random;
mod shade;
mod sight;
mod sphere;
mod stand_in;
mod steer;
mod stone;
mod tendrils;
#[cfg(test)]
mod tests;
mod thin;
mod tree;
mod tube;
mod tuft;
mod wood;

use crate::planet::Form;
use build::Detail;
pub use build::{Mesh, Vertex};
pub(crate) use cover::{Cover, level_light};

/// Number of levels of detail: 0 is the nearest.
pub const LEVELS: usize = 4;

impl Form {
    /// Builder of this form's meshes; what all levels share is made only once.
    fn builder(&self, seed: u32) -> Box<dyn Fn(&Detail) -> Mesh + '_> {
        match self {
            Form::Tree(form) => {
                let plan = tree::plan(form, seed);
                Box::new(move |detail| tree::build(&plan, detail))
            }
            Form::Fans(form) => {
                let plan = fans::plan(form, seed);
                Box::new(move |detail| fans::build(&plan, detail))
            }
            Form::Conifer(form) => Box::new(|detail| conifer::build(form, detail)),
            Form::Palm(form) => Box::new(|detail| palm::build(form, detail)),
            Form::Tuft(form) => Box::new(|detail| tuft::build(form, detail)),
            Form::Cushion(form) => Box::new(|detail| cushion::build(form, detail)),
            Form::Cactus(form) => Box::new(|detail| cactus::build(form, detail)),
            Form::Mushroom(form) => Box::new(|detail| mushroom::build(form, detail)),
            Form::Wood(form) => Box::new(|detail| wood::build(form, detail)),
            Form::Stone(form) => Box::new(|detail| stone::build(form, detail)),
            Form::Crystal(form) => Box::new(|detail| crystal::build(form, detail)),
            Form::Bulbs(form) => Box::new(|detail| bulbs::build(form, detail)),
            Form::Tendrils(form) => Box::new(|detail| tendrils::build(form, detail)),
            Form::Mesh(form) => match artist::plan(form, seed) {
                Some(plan) => Box::new(move |detail| artist::build(&plan, detail)),
                None => Box::new(|detail| stand_in::build(stand_in::WIDTH, detail)),
            },
            Form::Game(form) => Box::new(|detail| stand_in::build(form.width as f32, detail)),
        }
    }
}

/// Builder of a form's meshes.
type Builder<'a> = dyn Fn(&Detail) -> Mesh + 'a;

/// Mesh of a form at one level of detail; `seed` already mixes the variant.
pub fn mesh(form: &Form, seed: u32, level: usize) -> Mesh {
    let build = form.builder(seed);
    let near = build(&Detail { level: 0, seed, fill: 1.0, flat: 1.0 }).fit();
    if level == 0 { near } else { matched(&*build, seed, level.min(LEVELS - 1), &sight::look(&near)) }
}

/// The nearest and the farthest mesh of a form.
pub(super) fn extremes(form: &Form, seed: u32) -> [Mesh; 2] {
    let build = form.builder(seed);
    let near = build(&Detail { level: 0, seed, fill: 1.0, flat: 1.0 }).fit();
    let far = matched(&*build, seed, LEVELS - 1, &sight::look(&near));
    [near, far]
}

/// Meshes of a form at all levels of detail: faster than one by one.
pub fn meshes(form: &Form, seed: u32) -> [Mesh; LEVELS] {
    let build = form.builder(seed);
    let near = build(&Detail { level: 0, seed, fill: 1.0, flat: 1.0 }).fit();
    let sight = sight::look(&near);
    let far = |level| matched(&*build, seed, level, &sight);
    let (a, b, c) = (far(1), far(2), far(3));
    [near, a, b, c]
}

/// Mesh of a coarser level that covers as much as the near one, from the side and from above, with the same mean
/// colours and light of both views together.
fn matched(build: &Builder, seed: u32, level: usize, near: &sight::Sights) -> Mesh {
    let mut search = steer::Search::new();
    let mut best: Option<(f32, Mesh, sight::Sights)> = None;
    for _ in 0..6 {
        let [fill, flat] = search.knobs();
        let mesh = build(&Detail { level, seed, fill, flat }).fit();
        let seen = sight::look(&mesh);
        let off = |near: f32, seen: f32| (near / seen.max(1e-3) - 1.0).abs();
        let [side, top] = [off(near.side.cover, seen.side.cover), off(near.top.cover, seen.top.cover)];
        let miss = side + 0.5 * top;
        if best.as_ref().is_none_or(|(least, _, _)| miss < *least) {
            best = Some((miss, mesh, seen));
        }
        if (side < 0.02 && top < 0.03) || !search.step(near, &seen) {
            break;
        }
    }
    let (_, mut mesh, seen) = best.unwrap_or_default();
    seen.adapt(near, &mut mesh);
    mesh
}

/// Share of the box around a mesh that it covers, below which bodies pass between its parts.
const OPEN: f32 = 0.3;

/// Whether bodies pass between the parts of a mesh: it has leaves, or covers little of what is around it.
pub(crate) fn is_open(mesh: &Mesh) -> bool {
    let has_leaves = mesh.vertices.iter().any(|vertex| vertex.part > 0.5);
    let reach = mesh.vertices.iter().fold(0.02_f32, |reach, v| reach.max(v.position.truncate().length()));
    has_leaves || sight::look_from(mesh, 4, 40).cover < OPEN * 2.0 * reach
}
