//! The canvas that patterns are drawn on: texels by a function, or strokes that cover one another by height.

use super::noise::{SIDE, Texel, hash};

/// One texel of a pattern.
#[derive(Clone, Copy, Default)]
pub(super) struct Spot {
    /// Height as a share of the pattern's side length.
    pub(super) height: f32,
    /// Factor on the albedo of the biome.
    pub(super) tint: [f32; 3],
    /// Added to the biome's roughness.
    pub(super) roughness: f32,
    /// Share of the biome's glow.
    pub(super) glow: f32,
}

/// A pattern by a function of the texel.
pub(super) fn each(spot: impl Fn(Texel) -> Spot) -> Vec<Spot> {
    (0..SIDE * SIDE).map(|i| spot(Texel::new(i))).collect()
}

/// The same factor on all channels.
pub(super) fn grey(light: f32) -> [f32; 3] {
    [light; 3]
}

/// A colour times a brightness.
pub(super) fn tinted(color: [f32; 3], light: f32) -> [f32; 3] {
    color.map(|c| c * light)
}

/// A colour between two.
pub(super) fn between(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share)
}

/// Height of a dome whose rim is at 0 and whose middle is at 1.
pub(super) fn dome(inside: f32) -> f32 {
    (inside * (2.0 - inside)).sqrt()
}

/// Heights of a canvas before strokes are drawn on it.
pub(super) struct Heights(Vec<f32>);

impl Heights {
    pub(super) fn of(canvas: &[Spot]) -> Self {
        Self(canvas.iter().map(|spot| spot.height).collect())
    }

    /// Height at a point of the unit square.
    pub(super) fn at(&self, point: [f32; 2]) -> f32 {
        let [x, y] = point.map(|w| (w * SIDE as f32) as usize % SIDE);
        self.0[y * SIDE + x]
    }
}

/// Noise of the texel alone, -1..1.
pub(super) fn grain(texel: Texel, seed: u32) -> f32 {
    2.0 * hash([(texel.index % SIDE) as u32, (texel.index / SIDE) as u32], seed)[0] - 1.0
}

/// Six random numbers of a stroke, 0..1.
pub(super) fn dice(number: u32, seed: u32) -> [f32; 6] {
    let ([a, b, c], [d, e, f]) = (hash([number, 1], seed), hash([number, 2], seed));
    [a, b, c, d, e, f]
}

/// Place of a stroke: its middle and its half sides are shares of the pattern's side length.
pub(super) struct Stroke {
    pub(super) middle: [f32; 2],
    pub(super) turn_rad: f32,
    pub(super) half_length: f32,
    pub(super) half_width: f32,
}

impl Stroke {
    /// Draws the stroke, wrapping at the borders. `spot` gets the position along and across the stroke, -1..1 within
    /// it. Its texel replaces the pattern's where it is higher.
    pub(super) fn draw(&self, canvas: &mut [Spot], spot: impl Fn(f32, f32) -> Option<Spot>) {
        let (side, [x0, y0]) = (SIDE as i32, self.middle.map(|w| w * SIDE as f32));
        let (sin, cos) = self.turn_rad.sin_cos();
        // Strokes are at least as wide as a texel, so that thin ones do not break into dots.
        let (length, width) = (self.half_length * SIDE as f32, (self.half_width * SIDE as f32).max(0.5));
        let reach = |along: f32, across: f32| (length * along.abs()).hypot(width * across.abs()) + 1.0;
        let (reach_x, reach_y) = (reach(cos, sin), reach(sin, cos));
        let range = |c: f32, reach: f32| (c - reach).floor() as i32..=(c + reach).ceil() as i32;
        for y in range(y0, reach_y) {
            for x in range(x0, reach_x) {
                let (dx, dy) = (x as f32 + 0.5 - x0, y as f32 + 0.5 - y0);
                let (along, across) = ((dx * cos + dy * sin) / length, (dy * cos - dx * sin) / width);
                if along.abs() >= 1.0 {
                    continue;
                }
                if let Some(new) = spot(along, across) {
                    let old = &mut canvas[(y.rem_euclid(side) * side + x.rem_euclid(side)) as usize];
                    if new.height > old.height {
                        *old = new;
                    }
                }
            }
        }
    }
}
