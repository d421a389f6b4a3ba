//! Random numbers and smooth noise from an integer hash: the same on every machine.

use glam::Vec3;

/// Hash of one number (the output function of PCG-RXS-M-XS, O'Neill 2014).
pub(super) fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Stream of random numbers.
#[derive(Clone, Debug)]
pub(super) struct Random(u32);

impl Random {
    /// Stream number `stream` of a seed.
    pub(super) fn new(seed: u32, stream: u32) -> Self {
        Self(hash(seed ^ hash(stream.wrapping_add(0x9e37_79b9))))
    }

    /// Next whole number.
    pub(super) fn whole(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        hash(self.0)
    }

    /// Next number in 0 .. 1.
    pub(super) fn unit(&mut self) -> f32 {
        (self.whole() >> 8) as f32 / 16_777_216.0
    }

    /// Next number in -1 .. 1.
    pub(super) fn signed(&mut self) -> f32 {
        self.unit() * 2.0 - 1.0
    }

    /// Next number between two bounds.
    pub(super) fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Next point in the unit ball, by rejection.
    pub(super) fn ball(&mut self) -> Vec3 {
        for _ in 0..16 {
            let p = Vec3::new(self.signed(), self.signed(), self.signed());
            if p.length_squared() <= 1.0 {
                return p;
            }
        }
        Vec3::ZERO
    }

    /// Next unit vector.
    pub(super) fn direction(&mut self) -> Vec3 {
        self.ball().normalize_or(Vec3::Z)
    }
}

/// Value of a lattice point in -1 .. 1.
fn lattice(x: i32, y: i32, z: i32, seed: u32) -> f32 {
    let h = hash(x as u32 ^ hash(y as u32 ^ hash(z as u32 ^ seed)));
    (h >> 8) as f32 / 8_388_608.0 - 1.0
}

/// Smooth value noise in -1 .. 1 with a wavelength of about 2.
pub(super) fn noise(p: Vec3, seed: u32) -> f32 {
    let base = p.floor();
    let f = p - base;
    let s = f * f * (Vec3::splat(3.0) - 2.0 * f);
    let (x, y, z) = (base.x as i32, base.y as i32, base.z as i32);
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let row = |dy: i32, dz: i32| mix(lattice(x, y + dy, z + dz, seed), lattice(x + 1, y + dy, z + dz, seed), s.x);
    mix(mix(row(0, 0), row(1, 0), s.y), mix(row(0, 1), row(1, 1), s.y), s.z)
}
