//! Meshes of forms and the steps that build them.

use glam::Vec3;

/// Depth below the ground that a form may reach, as a share of its height.
pub(super) const SUNK: f32 = 0.15;

/// Corner of a form's triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Place; z is up, the ground is at 0 and the top at 1.
    pub position: Vec3,
    /// Unit vector that lighting takes as the surface's direction.
    pub normal: Vec3,
    /// Mix of the colours: 0 = first (wood, stone, stalk), 1 = second (leaves, cap, tips).
    pub part: f32,
    /// Share of the sky that it sees, 0 .. 1.
    pub light: f32,
    /// Share of the wind's push that it follows: 0 at the base, 1 where it moves most.
    pub sway: f32,
    /// Factor on the mix of the colours, linear sRGB: 1 but in meshes of files, which have colours of their own.
    pub tint: Vec3,
}

/// Triangles of a form, with the front counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners.
    pub vertices: Vec<Vertex>,
    /// Triples of corners.
    pub triangles: Vec<[u16; 3]>,
}

/// Look of a vertex besides its place and normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Mix of the colours.
    pub part: f32,
    /// Share of the sky.
    pub light: f32,
    /// Share of the wind.
    pub sway: f32,
}

/// Request for a mesh: how fine, from which seed, how full and how flat.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detail {
    /// Level of detail: 0 = near.
    pub level: usize,
    /// Seed of all random numbers.
    pub seed: u32,
    /// Factor on the area of leaves (or the width of solid parts) that makes levels cover the same.
    pub fill: f32,
    /// Factor on the width of parts whose height is divided by it: more cover from above and no less from the side.
    pub flat: f32,
}

impl Detail {
    /// Entry of a table with one value for each level.
    pub(super) fn pick<T: Copy>(&self, table: [T; super::LEVELS]) -> T {
        table[self.level.min(super::LEVELS - 1)]
    }

    /// Factor on lengths that changes areas by `fill`.
    pub(super) fn swell(&self) -> f32 {
        self.fill.sqrt()
    }

    /// Vector within a part, wider and lower by `flat`.
    pub(super) fn flatten(&self, v: Vec3) -> Vec3 {
        v * Vec3::new(self.flat, self.flat, 1.0 / self.flat)
    }

    /// Flattening of the part that the corners from `start` on make; the pivot stays.
    pub(super) fn flatten_part(&self, mesh: &mut Mesh, start: usize, pivot: Vec3) {
        // Rounding must not move a part that keeps its shape.
        let part = if self.flat == 1.0 { &mut [] } else { &mut mesh.vertices[start..] };
        for v in part {
            v.position = pivot + self.flatten(v.position - pivot);
        }
    }
}

impl Mesh {
    /// Addition of a corner; gives its index.
    pub(super) fn vertex(&mut self, position: Vec3, normal: Vec3, look: Look) -> u16 {
        let index = self.vertices.len().min(65_535) as u16;
        let Look { part, light, sway } = look;
        let unit = |x: f32| x.clamp(0.0, 1.0);
        let normal = normal.normalize_or(Vec3::Z);
        let (part, light, sway) = (unit(part), unit(light), unit(sway));
        self.vertices.push(Vertex { position, normal, part, light, sway, tint: Vec3::ONE });
        index
    }

    /// Addition of a triangle.
    pub(super) fn triangle(&mut self, a: u16, b: u16, c: u16) {
        self.triangles.push([a, b, c]);
    }

    /// Highest z.
    pub(super) fn top(&self) -> f32 {
        self.vertices.iter().fold(f32::MIN, |top, v| top.max(v.position.z))
    }

    /// Scale to a height of exactly 1, with nothing deeper than `SUNK`.
    pub(super) fn fit(mut self) -> Self {
        let top = self.top();
        let scale = if top > 1e-6 { 1.0 / top } else { 1.0 };
        for v in &mut self.vertices {
            v.position *= scale;
            v.position.z = v.position.z.clamp(-SUNK, 1.0);
        }
        self
    }

    /// Normals from the faces around each place; edges sharper than the angle whose cosine is `crease` stay sharp.
    pub(super) fn crease(&self, crease: f32) -> Self {
        let face = |t: &[u16; 3]| {
            let [a, b, c] = t.map(|i| self.vertices[i as usize].position);
            (b - a).cross(c - a)
        };
        let faces: Vec<Vec3> = self.triangles.iter().map(face).collect();
        let mut touching = vec![Vec::new(); self.vertices.len()];
        for (i, t) in self.triangles.iter().enumerate() {
            t.iter().for_each(|&v| touching[v as usize].push(i));
        }
        let mut out = Mesh::default();
        for (i, t) in self.triangles.iter().enumerate() {
            let own = faces[i].normalize_or(Vec3::Z);
            let corner = t.map(|v| {
                let near = touching[v as usize].iter().map(|&f| faces[f]);
                let sum: Vec3 = near.filter(|f| f.normalize_or(Vec3::Z).dot(own) >= crease).sum();
                let v = self.vertices[v as usize];
                out.vertex(v.position, sum.normalize_or(own), Look { part: v.part, light: v.light, sway: v.sway })
            });
            out.triangles.push(corner);
        }
        out
    }
}
