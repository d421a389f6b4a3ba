//! Sight of a mesh from the side: how much it covers and its mean look, for levels of detail that match.

use super::build::Mesh;
use super::math::{TURN, around};
use glam::{Vec2, Vec3};

/// Means of what is seen from the side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sight {
    /// Covered area, in squares of the height.
    pub cover: f32,
    /// Mean mix of colours.
    pub part: f32,
    /// Mean share of the sky.
    pub light: f32,
}

impl Sight {
    /// Change of a mesh seen so, to the colours and light of another sight.
    pub(super) fn adapt(&self, target: &Sight, mesh: &mut Mesh) {
        let up = target.part > self.part;
        let less = (target.part / self.part.max(1e-3)).clamp(0.0, 1.0);
        let more = ((1.0 - target.part) / (1.0 - self.part).max(1e-3)).clamp(0.0, 1.0);
        let glow = (target.light / self.light.max(1e-3)).clamp(0.4, 2.5);
        for v in &mut mesh.vertices {
            v.part = if up { 1.0 - (1.0 - v.part) * more } else { v.part * less };
            v.light = (v.light * glow).clamp(0.0, 1.0);
        }
    }
}

/// Picture with depth.
struct Picture {
    width: usize,
    rows: usize,
    pixels: Vec<(f32, f32, f32)>,
}

impl Picture {
    /// Drawing of one triangle: places (x, y in pixels, depth in z) with part and light.
    fn draw(&mut self, p: [Vec3; 3], look: [Vec2; 3]) {
        let area = (p[1] - p[0]).truncate().perp_dot((p[2] - p[0]).truncate());
        if area.abs() < 1e-6 {
            return;
        }
        let low = p[0].min(p[1]).min(p[2]).max(Vec3::ZERO);
        let high = p[0].max(p[1]).max(p[2]);
        let (x1, y1) = (high.x.max(0.0) as usize, high.y.max(0.0) as usize);
        for y in low.y as usize..=y1.min(self.rows - 1) {
            for x in low.x as usize..=x1.min(self.width - 1) {
                let q = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let weight =
                    |i: usize, j: usize| (p[j].truncate() - p[i].truncate()).perp_dot(q - p[i].truncate()) / area;
                let w = [weight(1, 2), weight(2, 0), weight(0, 1)];
                if w.iter().any(|&w| w < 0.0) {
                    continue;
                }
                let depth = w[0] * p[0].z + w[1] * p[1].z + w[2] * p[2].z;
                let pixel = &mut self.pixels[y * self.width + x];
                if depth < pixel.0 {
                    let seen = look[0] * w[0] + look[1] * w[1] + look[2] * w[2];
                    *pixel = (depth, seen.x, seen.y);
                }
            }
        }
    }
}

/// Sight of a mesh, as the mean over four sides.
pub(super) fn look(mesh: &Mesh) -> Sight {
    look_from(mesh, 4, 40)
}

/// Sight of a mesh from a number of sides over half a turn, with a number of rows over its height.
pub(super) fn look_from(mesh: &Mesh, sides: usize, rows: usize) -> Sight {
    let reach = mesh.vertices.iter().fold(0.1_f32, |r, v| r.max(v.position.truncate().length()));
    // A wide form is seen in the same number of pixels as a narrow one.
    let scale = (rows as f32).min(2.25 * rows as f32 / reach);
    let width = ((reach * 2.0 * scale) as usize + 1).min(5 * rows);
    let mut sum = Sight::default();
    let mut count = 0.0_f32;
    for side in 0..sides {
        let right = around(TURN * (side as f32 + 0.35) / (2.0 * sides as f32));
        let away = Vec3::new(-right.y, right.x, 0.0);
        let mut picture = Picture { width, rows, pixels: vec![(f32::MAX, 0.0, 0.0); width * rows] };
        let place = |p: Vec3| Vec3::new((p.dot(right) + reach) * scale, p.z * scale, p.dot(away));
        for t in &mesh.triangles {
            let v = t.map(|i| &mesh.vertices[i as usize]);
            picture.draw(v.map(|v| place(v.position)), v.map(|v| Vec2::new(v.part, v.light)));
        }
        for &(_, part, light) in picture.pixels.iter().filter(|p| p.0 < f32::MAX) {
            count += 1.0;
            sum.part += part;
            sum.light += light;
        }
    }
    let pixels = count.max(1.0);
    Sight { cover: count / (sides as f32 * scale * scale), part: sum.part / pixels, light: sum.light / pixels }
}
