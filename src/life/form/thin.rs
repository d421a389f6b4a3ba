//! Coarser levels of any mesh. Loose leaves and blades thin out and grow by as much (stochastic simplification, Cook et
//! al. 2007); solid parts are joined in cells (vertex clustering, Rossignac and Borrel 1993).

use super::artist::Fine;
use super::build::{Detail, Mesh, Vertex};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Most triangles of a connected part that counts as a leaf or blade.
const LOOSE: usize = 16;
/// Least share of the triangles of a level for solid parts, if there are any, and for loose ones.
const SHARES: [f32; 2] = [0.3, 0.4];
/// Triangles that a loose part keeps in a coarser level.
const KEPT: usize = 2;
/// Triangles for each solid part, at least: the smallest parts are left out where there are fewer.
const ROD: usize = 12;
/// Greatest factor on the width of loose parts.
const GROWN: f32 = 8.0;

/// Mesh of a level, and how it becomes fuller and flatter.
pub(super) struct Thinned {
    fine: Fine,
    /// Middle of the loose part of each corner; none of solid ones.
    middles: Vec<Option<Vec3>>,
    /// Mean thickness of solid parts.
    thickness: f32,
}

impl Thinned {
    /// Mesh with the fullness and flatness that the levels need to match.
    pub(super) fn mesh(&self, detail: &Detail) -> Mesh {
        let is_same = detail.fill == 1.0 && detail.flat == 1.0;
        let has_loose = self.middles.iter().any(Option::is_some);
        let moved = |(v, middle): (&Vertex, &Option<Vec3>)| {
            let position = match middle {
                _ if is_same => v.position,
                Some(middle) => *middle + detail.flatten((v.position - *middle) * detail.swell()),
                None => {
                    // To the sides alone: the height stays.
                    let out = Vec3::new(v.normal.x, v.normal.y, 0.0);
                    let wide = v.position + out * ((detail.swell() - 1.0) * self.thickness);
                    if has_loose { wide } else { detail.flatten(wide) }
                }
            };
            Vertex { position, ..*v }
        };
        let vertices = self.fine.vertices.iter().zip(&self.middles).map(moved).collect();
        let triangles = self.fine.triangles.iter().map(|triangle| triangle.map(|at| at as u16)).collect();
        Mesh { vertices, triangles }
    }
}

/// Mesh with at most `most` triangles.
pub(super) fn thinned(fine: &Fine, most: usize) -> Thinned {
    let parts = connected(fine);
    let (loose, solid): (Vec<Vec<usize>>, Vec<Vec<usize>>) = parts.into_iter().partition(|part| part.len() <= LOOSE);
    let of_solid: usize = solid.iter().map(Vec::len).sum();
    let of_loose: usize = loose.iter().map(Vec::len).sum();
    let mut out = Thinned { fine: Fine::default(), middles: Vec::new(), thickness: 0.0 };
    let is_all = fine.triangles.len() <= most;
    let wanted = most as f32 * of_solid as f32 / fine.triangles.len().max(1) as f32;
    let for_solid = match (solid.is_empty(), loose.is_empty()) {
        (true, _) => 0,
        (_, true) => most,
        _ => wanted.clamp(SHARES[0] * most as f32, (1.0 - SHARES[1]) * most as f32) as usize,
    };
    if is_all {
        solid.iter().for_each(|part| out.copy(fine, part, None));
    } else {
        out.cluster(fine, &largest(fine, solid, for_solid / ROD), for_solid);
    }
    // Joined parts may be thicker than they were.
    out.thickness = thickness(&out.fine);
    // What solid parts have not needed is there for loose ones.
    let left = most - out.fine.triangles.len().min(most);
    if is_all || of_loose <= left {
        loose.iter().for_each(|part| out.copy(fine, part, Some((middle(fine, part), 1.0))));
    } else {
        out.thin(fine, loose, left);
    }
    out
}

impl Thinned {
    /// Adds triangles as they are, or larger about a middle.
    fn copy(&mut self, fine: &Fine, triangles: &[usize], loose: Option<(Vec3, f32)>) {
        let mut places = HashMap::new();
        for &at in triangles {
            let triangle = fine.triangles[at].map(|corner| {
                *places.entry(corner).or_insert_with(|| {
                    let mut v = fine.vertices[corner as usize];
                    if let Some((middle, scale)) = loose.filter(|(_, scale)| *scale != 1.0) {
                        v.position = middle + (v.position - middle) * scale;
                    }
                    self.fine.vertices.push(v);
                    self.middles.push(loose.map(|(middle, _)| middle));
                    self.fine.vertices.len() as u32 - 1
                })
            });
            self.fine.triangles.push(triangle);
        }
    }

    /// Adds an even choice of loose parts, as much larger as others are left out.
    fn thin(&mut self, fine: &Fine, loose: Vec<Vec<usize>>, most: usize) {
        let whole: f32 = loose.iter().flatten().map(|&at| area(fine, at)).sum();
        let mut parts: Vec<(u64, Vec<usize>)> = loose
            .into_iter()
            .map(|mut part| {
                let order = along_curve(middle(fine, &part));
                part.sort_by(|a, b| area(fine, *b).total_cmp(&area(fine, *a)));
                part.truncate(KEPT);
                (order, part)
            })
            .collect();
        parts.sort_by_key(|(order, _)| *order);
        let all: usize = parts.iter().map(|(_, part)| part.len()).sum();
        // Steps of equal length along a curve through space.
        let (mut passed, mut used, mut kept) = (0, 0, Vec::new());
        for (_, part) in parts {
            passed += part.len();
            if used + part.len() <= most * passed / all.max(1) {
                used += part.len();
                kept.push(part);
            }
        }
        let left: f32 = kept.iter().flatten().map(|&at| area(fine, at)).sum();
        let scale = (whole / left.max(f32::MIN_POSITIVE)).sqrt().clamp(1.0, GROWN);
        kept.iter().for_each(|part| self.copy(fine, part, Some((middle(fine, part), scale))));
    }

    /// Adds solid triangles, joined in cells that are as large as the number of triangles asks for.
    fn cluster(&mut self, fine: &Fine, triangles: &[usize], most: usize) {
        if triangles.is_empty() {
            return;
        }
        if triangles.len() <= most {
            return self.copy(fine, triangles, None);
        }
        // Few cells cannot tell sides apart.
        let best = finest(fine, triangles, most, true);
        let best = if 2 * best.triangles.len() < most {
            let plain = finest(fine, triangles, most, false);
            if plain.triangles.len() > best.triangles.len() { plain } else { best }
        } else {
            best
        };
        let first = self.fine.vertices.len() as u32;
        self.middles.extend(best.vertices.iter().map(|_| None));
        self.fine.vertices.extend(best.vertices);
        self.fine.triangles.extend(best.triangles.iter().map(|triangle| triangle.map(|at| first + at)));
    }
}

/// Triangles of the largest parts, `most` of them and at least one.
fn largest(fine: &Fine, parts: Vec<Vec<usize>>, most: usize) -> Vec<usize> {
    let whole = |part: &Vec<usize>| part.iter().map(|&at| area(fine, at)).sum::<f32>();
    let mut parts: Vec<(f32, Vec<usize>)> = parts.into_iter().map(|part| (whole(&part), part)).collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    parts.truncate(most.max(1));
    parts.into_iter().flat_map(|(_, part)| part).collect()
}

/// Triangles in the smallest cells that leave at most `most` of them.
fn finest(fine: &Fine, triangles: &[usize], most: usize, are_apart: bool) -> Fine {
    let (mut small, mut large) = (1e-3_f32, 4.0_f32);
    let mut best = Fine::default();
    for _ in 0..14 {
        let side = (small * large).sqrt();
        let joined = joined(fine, triangles, side, are_apart);
        if joined.triangles.len() > most {
            small = side;
            continue;
        }
        large = side;
        if joined.triangles.len() >= best.triangles.len() {
            best = joined;
        }
    }
    best
}

/// Triangles with one corner for each cell. `are_apart`: corners on other sides of a thin part stay apart, so that it
/// keeps a width.
fn joined(fine: &Fine, triangles: &[usize], side: f32, are_apart: bool) -> Fine {
    let key = |v: &Vertex| {
        let cell = (v.position / side).floor();
        let sides = (are_apart && v.normal.x > 0.0, are_apart && v.normal.y > 0.0, v.part > 0.5);
        (cell.x as i32, cell.y as i32, cell.z as i32, sides)
    };
    let mut cells = BTreeMap::new();
    let mut members: BTreeSet<u32> = BTreeSet::new();
    triangles.iter().for_each(|&at| members.extend(fine.triangles[at]));
    let mut sums: Vec<(Vertex, f32)> = Vec::new();
    let mut places = HashMap::new();
    for at in members {
        let v = &fine.vertices[at as usize];
        let place = *cells.entry(key(v)).or_insert_with(|| {
            let none =
                Vertex { position: Vec3::ZERO, normal: Vec3::ZERO, tint: Vec3::ZERO, part: 0.0, light: 0.0, sway: 0.0 };
            sums.push((none, 0.0));
            sums.len() as u32 - 1
        });
        places.insert(at, place);
        let (sum, count) = &mut sums[place as usize];
        sum.position += v.position;
        sum.normal += v.normal;
        sum.tint += v.tint;
        sum.part += v.part;
        sum.light += v.light;
        sum.sway += v.sway;
        *count += 1.0;
    }
    let mean = |(sum, count): &(Vertex, f32)| Vertex {
        position: sum.position / *count,
        normal: sum.normal.normalize_or(Vec3::Z),
        tint: sum.tint / *count,
        part: sum.part / *count,
        light: sum.light / *count,
        sway: sum.sway / *count,
    };
    let mut out = Fine { vertices: sums.iter().map(mean).collect(), triangles: Vec::new() };
    let mut known = BTreeSet::new();
    for &at in triangles {
        let [a, b, c] = fine.triangles[at].map(|corner| places[&corner]);
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        if a != b && b != c && c != a && known.insert(sorted) {
            out.triangles.push([a, b, c]);
        }
    }
    out
}

/// Triangles of each connected part: those with corners at one place.
fn connected(fine: &Fine) -> Vec<Vec<usize>> {
    let mut at_place: HashMap<[u32; 3], usize> = HashMap::new();
    // A forest over corners, each of which leads to another of its part.
    let mut leads: Vec<usize> = (0..fine.vertices.len()).collect();
    fn root(leads: &mut [usize], mut at: usize) -> usize {
        while leads[at] != at {
            leads[at] = leads[leads[at]];
            at = leads[at];
        }
        at
    }
    for (at, v) in fine.vertices.iter().enumerate() {
        let place = v.position.to_array().map(|part| (part + 0.0).to_bits());
        let first = *at_place.entry(place).or_insert(at);
        let (a, b) = (root(&mut leads, first), root(&mut leads, at));
        leads[b] = a;
    }
    for triangle in &fine.triangles {
        let [a, b, c] = triangle.map(|at| at as usize);
        for other in [b, c] {
            let (a, b) = (root(&mut leads, a), root(&mut leads, other));
            leads[b] = a;
        }
    }
    let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, triangle) in fine.triangles.iter().enumerate() {
        parts.entry(root(&mut leads, triangle[0] as usize)).or_default().push(number);
    }
    parts.into_values().collect()
}

fn corners(fine: &Fine, triangle: usize) -> [Vec3; 3] {
    fine.triangles[triangle].map(|at| fine.vertices[at as usize].position)
}

fn area(fine: &Fine, triangle: usize) -> f32 {
    let [a, b, c] = corners(fine, triangle);
    0.5 * (b - a).cross(c - a).length()
}

/// Mean place of the corners of triangles.
fn middle(fine: &Fine, triangles: &[usize]) -> Vec3 {
    let sum: Vec3 = triangles.iter().flat_map(|&at| corners(fine, at)).sum();
    sum / (3 * triangles.len().max(1)) as f32
}

/// Mean half width of closed parts: of a rod its radius.
fn thickness(fine: &Fine) -> f32 {
    let (mut volume, mut whole) = (0.0, 0.0);
    for at in 0..fine.triangles.len() {
        let [a, b, c] = corners(fine, at);
        volume += a.dot(b.cross(c)) / 6.0;
        whole += area(fine, at);
    }
    (2.0 * volume.abs() / f32::max(whole, 1e-6)).clamp(0.004, 0.3)
}

/// Number of a place along a curve through space whose neighbours are near one another (Morton 1966).
fn along_curve(at: Vec3) -> u64 {
    let spread = |part: f32| {
        let step = ((part.clamp(-4.0, 4.0) + 4.0) * 128.0) as u64;
        (0..10).fold(0, |sum, bit| sum | ((step >> bit & 1) << (3 * bit)))
    };
    spread(at.x) | spread(at.y) << 1 | spread(at.z) << 2
}
