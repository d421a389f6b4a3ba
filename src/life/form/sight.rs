//! Sight of a mesh from the side and from above: how much it covers and its mean look, for levels of detail that match
//! and for the canopy.

use super::build::Mesh;
use super::math::{TURN, around};
use glam::{Vec2, Vec3};

/// Means of what is seen from a side.
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
    /// Means of summed pixels, of which `square` cover a square of the height.
    fn of(sums: Vec3, square: f32) -> Self {
        let pixels = sums.x.max(1.0);
        Self { cover: sums.x / square, part: sums.y / pixels, light: sums.z / pixels }
    }

    /// Mean look of two sights, with the cover of the first.
    fn with(&self, other: &Sight) -> Self {
        Self { part: 0.5 * (self.part + other.part), light: 0.5 * (self.light + other.light), ..*self }
    }

    /// Change of a mesh seen so, to the colours and light of another sight.
    fn adapt(&self, target: &Sight, mesh: &mut Mesh) {
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

/// What is seen from the side and from above.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sights {
    /// Mean over four sides.
    pub side: Sight,
    /// From above.
    pub top: Sight,
}

impl Sights {
    /// Change of a mesh seen so, to the colours and light of other sights: both sides count the same.
    pub(super) fn adapt(&self, target: &Sights, mesh: &mut Mesh) {
        self.side.with(&self.top).adapt(&target.side.with(&target.top), mesh);
    }
}

/// Picture with depth.
struct Picture {
    width: usize,
    rows: usize,
    pixels: Vec<(f32, f32, f32)>,
}

impl Picture {
    fn new(width: usize, rows: usize) -> Self {
        Self { width, rows, pixels: vec![(f32::MAX, 0.0, 0.0); width * rows] }
    }

    /// Drawing of a mesh. `place`: position in the picture (x, y in pixels, depth in z).
    fn draw_mesh(&mut self, mesh: &Mesh, place: impl Fn(Vec3) -> Vec3) {
        for t in &mesh.triangles {
            let v = t.map(|i| &mesh.vertices[i as usize]);
            self.draw(v.map(|v| place(v.position)), v.map(|v| Vec2::new(v.part, v.light)));
        }
    }

    /// Sums over the covered pixels: their number, part and light.
    fn sums(&self) -> Vec3 {
        let covered = self.pixels.iter().filter(|p| p.0 < f32::MAX);
        covered.fold(Vec3::ZERO, |sum, &(_, part, light)| sum + Vec3::new(1.0, part, light))
    }

    /// Drawing of one triangle: places (x, y in pixels, depth in z) with part and light.
    fn draw(&mut self, p: [Vec3; 3], look: [Vec2; 3]) {
        each_pixel(p, [self.width, self.rows], |at, depth, w| {
            if depth < self.pixels[at].0 {
                let seen = look[0] * w[0] + look[1] * w[1] + look[2] * w[2];
                self.pixels[at] = (depth, seen.x, seen.y);
            }
        });
    }
}

/// Pixels of a picture that a triangle covers: their index, depth, and weights of the corners. `p`: x, y in pixels,
/// depth in z.
pub(super) fn each_pixel(p: [Vec3; 3], [width, rows]: [usize; 2], mut found: impl FnMut(usize, f32, [f32; 3])) {
    // Pixels whose centres lie within the bounds; most leaves are smaller than a pixel.
    let (low, high) = (p[0].min(p[1]).min(p[2]) + 0.5, p[0].max(p[1]).max(p[2]) - 0.5);
    if high.x < 0.0 || high.y < 0.0 {
        return;
    }
    let (x0, x1) = (low.x as usize, (high.x as usize).min(width - 1));
    let (y0, y1) = (low.y as usize, (high.y as usize).min(rows - 1));
    let flat = p.map(Vec3::truncate);
    let area = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]);
    if x1 < x0 || y1 < y0 || area.abs() < 1e-6 {
        return;
    }
    let side = |i: usize, j: usize| (flat[i], (flat[j] - flat[i]) * area.signum());
    let sides = [side(1, 2), side(2, 0), side(0, 1)];
    for y in y0..=y1 {
        for x in x0..=x1 {
            let q = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let w = sides.map(|(from, way)| way.perp_dot(q - from));
            if w.iter().all(|&w| w >= 0.0) {
                let w = w.map(|w| w / area.abs());
                found(y * width + x, w[0] * p[0].z + w[1] * p[1].z + w[2] * p[2].z, w);
            }
        }
    }
}

/// Sights of a mesh, from four sides and from above.
pub(super) fn look(mesh: &Mesh) -> Sights {
    Sights { side: look_from(mesh, 4, 40), top: look_down(mesh, 48) }
}

/// Sight of a mesh from a number of sides over half a turn, with a number of rows over its height.
pub(super) fn look_from(mesh: &Mesh, sides: usize, rows: usize) -> Sight {
    let reach = reach(mesh);
    // The pixels are as wide as it takes for every form to be as many wide.
    let width = rows * 5 / 4;
    let scale = Vec2::new(width as f32 / (2.0 * reach), rows as f32);
    let mut sums = Vec3::ZERO;
    for side in 0..sides {
        let right = around(TURN * (side as f32 + 0.35) / (2.0 * sides as f32));
        let away = Vec3::new(-right.y, right.x, 0.0);
        // Each side is seen in rows of other heights: many leaves are thinner than a row.
        let shift = (side as f32 + 0.5) / sides as f32 - 0.5;
        let mut picture = Picture::new(width, rows);
        picture.draw_mesh(mesh, |p| Vec3::new((p.dot(right) + reach) * scale.x, p.z * scale.y + shift, p.dot(away)));
        sums += picture.sums();
    }
    Sight::of(sums, sides as f32 * scale.x * scale.y)
}

/// Sight of a mesh from above, with a number of rows over its width.
pub(super) fn look_down(mesh: &Mesh, rows: usize) -> Sight {
    let reach = reach(mesh);
    let scale = rows as f32 / (2.0 * reach);
    let mut picture = Picture::new(rows, rows);
    picture.draw_mesh(mesh, |p| Vec3::new((p.x + reach) * scale, (p.y + reach) * scale, -p.z));
    Sight::of(picture.sums(), scale * scale)
}

/// Greatest distance of a mesh from its axis, at least a tenth of its height.
fn reach(mesh: &Mesh) -> f32 {
    mesh.vertices.iter().fold(0.02_f32, |r, v| r.max(v.position.truncate().length()))
}
