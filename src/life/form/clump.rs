//! Clumps: rough solids around many points, for crowns that are seen from far away.

use super::build::{Detail, Look, Mesh};
use super::math::{mix, smooth, turn};
use super::random::Random;
use super::sphere;
use glam::Vec3;

/// Value of which a share of the list is lower.
fn percentile(mut values: Vec<f32>, share: f32) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    let index = (values.len() as f32 * share) as usize;
    values.get(index.min(values.len().saturating_sub(1))).copied()
}

/// Mean of points and their spread along the axes.
fn spread(points: &[Vec3]) -> (Vec3, Vec3) {
    let count = points.len().max(1) as f32;
    let middle = points.iter().sum::<Vec3>() / count;
    let square: Vec3 = points.iter().map(|&p| (p - middle) * (p - middle)).sum::<Vec3>() / count;
    (middle, Vec3::new(square.x.sqrt(), square.y.sqrt(), square.z.sqrt()).max(Vec3::splat(0.005)))
}

/// Drawing of a blob of 20 triangles around points; `core` is a factor on its size.
pub(super) fn draw(mesh: &mut Mesh, points: &[Vec3], core: f32, detail: &Detail) {
    let mut random = Random::new(detail.seed, 900);
    let swell = core * detail.swell();
    let (middle, wide) = spread(points);
    let inner: Vec<Vec3> = points.iter().map(|&p| (p - middle) / wide).collect();
    let usual = percentile(inner.iter().map(|q| q.length()).collect(), 0.7).unwrap_or(1.0);
    let (low, high) = points.iter().fold((f32::MAX, f32::MIN), |(a, b), p| (a.min(p.z), b.max(p.z)));
    let spin = random.range(0.0, 7.0);
    let ball = sphere::sphere(1);
    let base = mesh.vertices.len().min(65_000) as u16;
    for corner in &ball.corners {
        let way = turn(*corner, Vec3::Z, spin);
        let facing = |q: &&Vec3| q.dot(way) > 0.78 * q.length();
        let reach = percentile(inner.iter().filter(facing).map(|q| q.length()).collect(), 0.85).unwrap_or(usual);
        // Poles keep their height; the corners around them make the outline uneven.
        let ragged = if corner.z.abs() > 0.9 { 1.0 } else { random.range(0.84, 1.2) };
        let lift = if corner.z.abs() > 0.9 { 0.0 } else { random.signed() * 0.16 };
        let at = middle + (way + Vec3::Z * lift) * wide * (reach * ragged * swell * 1.12);
        let height = smooth(low, high, at.z);
        let light = mix(0.3, 1.0, height * 0.55 + 0.25 + 0.2 * way.z);
        let look = Look { part: 1.0, light, sway: 0.25 + 0.5 * at.z.clamp(0.0, 1.0) };
        mesh.vertex(at, way + Vec3::Z * 0.3, look);
    }
    // The top stays.
    let top = mesh.vertices[base as usize].position;
    detail.flatten_part(mesh, base as usize, top);
    mesh.triangles.extend(ball.triangles.iter().map(|t| t.map(|i| base + i)));
}

/// Order of points in which each next one lies farthest from all before it; only the first `count` are ordered.
pub(super) fn even_order(points: &[Vec3], count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let mut away = vec![f32::MAX; points.len()];
    for k in 0..count.min(points.len()) {
        let distance = |&j: &usize| away[order[j]];
        let next = (k..order.len()).max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(k);
        order.swap(k, next);
        let chosen = points[order[k]];
        away.iter_mut().zip(points).for_each(|(d, p)| *d = d.min(p.distance_squared(chosen)));
    }
    order
}
