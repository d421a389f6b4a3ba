//! Crowns of trees: outlines filled with lobes of foliage, and the points in them where leaves grow.

use super::math::{GOLDEN, around, mix, pow, sin, smooth};
use super::random::Random;
use crate::planet::life::{Crown, Tree};
use glam::Vec3;

/// Place of a cluster of leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Centre of the cluster.
    pub at: Vec3,
    /// Normal for lighting: away from the lobe and the crown.
    pub normal: Vec3,
    /// Share of the sky that it sees.
    pub light: f32,
    /// Share of hanging: 1 for a strand that hangs down.
    pub hang: f32,
}

/// Size and shape of a crown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    /// Shape.
    pub shape: Crown,
    /// Height of the foot.
    pub foot: f32,
    /// Height from foot to top.
    pub height: f32,
    /// Largest radius.
    pub radius: f32,
    /// Raggedness, 0 .. 1.
    pub irregular: f32,
}

impl Outline {
    /// Outline of a tree's crown.
    pub(super) fn new(form: &Tree) -> Self {
        let trunk = form.trunk as f32;
        let radius = form.crown_width as f32 * 0.5;
        // A parasol is flat, and hanging twigs reach below the foot of their dome.
        let height = match form.crown {
            Crown::Umbrella => ((1.0 - trunk) * 0.55).min(0.16 + 0.2 * radius),
            _ => 1.0 - trunk,
        };
        Self { shape: form.crown, foot: 1.0 - height, height, radius, irregular: form.irregular as f32 }
    }

    /// Radius at a share of the height, as a share of the largest.
    fn profile(&self, h: f32) -> f32 {
        let dome = |h: f32| (1.0 - (2.0 * h - 1.0) * (2.0 * h - 1.0)).max(0.0).sqrt();
        match self.shape {
            Crown::Round => dome(pow(h, 0.85)),
            Crown::Cone => pow(1.0 - h, 0.85) * smooth(-0.12, 0.12, h),
            Crown::Column => pow(sin(std::f32::consts::PI * pow(h, 0.75)), 0.6),
            Crown::Umbrella => pow(1.0 - h, 0.45) * smooth(-0.4, 0.35, h),
            Crown::Weeping => dome(0.3 + 0.7 * h) * smooth(-0.35, 0.3, h),
        }
    }

    /// Size that the lengths of branches follow.
    pub(super) fn size(&self) -> f32 {
        libm::cbrtf(self.radius * self.radius * self.height)
    }

    /// Centre of the crown.
    fn centre(&self) -> Vec3 {
        Vec3::Z * (self.foot + self.height * if self.shape == Crown::Umbrella { 0.1 } else { 0.45 })
    }

    /// Lobes of foliage: centres and radii (horizontal, vertical).
    fn lobes(&self, random: &mut Random) -> Vec<(Vec3, f32, f32)> {
        let wild = self.irregular;
        let slender = (self.height / (2.0 * self.radius)).clamp(0.3, 6.0);
        let count = (mix(14.0, 11.0, wild) * pow(slender, 0.7)).clamp(9.0, 30.0) as usize;
        let thick = match self.shape {
            Crown::Umbrella => self.radius * 0.85,
            _ => self.radius.min(self.height * 0.5),
        };
        let spin = random.range(0.0, 7.0);
        (0..count)
            .map(|i| {
                let h = (i as f32 + 0.5 + random.signed() * 0.35) / count as f32;
                let size = thick * mix(0.44, 0.36, wild) * (1.0 + random.signed() * 0.4 * wild);
                let vertical = match self.shape {
                    Crown::Umbrella => (size * 0.5).min(self.height * 0.36),
                    _ => size * mix(0.85, 0.6, wild),
                };
                let room = (self.radius * self.profile(h) - size * 0.9).max(0.0);
                let out = room * (1.0 - 0.45 * wild * random.unit());
                // Every third lobe of a wide crown fills its inside.
                let out = if i % 4 == 3 { out * random.range(0.2, 0.7) } else { out };
                let angle = spin + i as f32 * GOLDEN + random.signed() * 0.5 * wild;
                let z = self.foot + mix(vertical * 0.8, self.height - vertical, h);
                (around(angle) * out + Vec3::Z * z, size.min(self.radius * self.profile(h) + thick * 0.12), vertical)
            })
            .collect()
    }

    /// Share of the sky at a place with a normal: less inside the crown and below.
    fn sky(&self, at: Vec3, normal: Vec3, lobe: f32) -> f32 {
        let from = (at - self.centre()) / Vec3::new(self.radius, self.radius, self.height * 0.55);
        let depth = from.length().min(1.0);
        let open = 0.1 + 0.5 * depth * depth + 0.45 * lobe * lobe;
        (open * (0.66 + 0.36 * normal.z)).max(0.06)
    }

    /// Points where leaves grow, in random order.
    pub(super) fn spots(&self, most: usize, random: &mut Random) -> Vec<Spot> {
        let lobes = self.lobes(random);
        let volume: f32 = lobes.iter().map(|l| pow(l.1, 2.2)).sum();
        let mut spots = Vec::new();
        for &(centre, wide, high) in &lobes {
            let count = (most as f32 * pow(wide, 2.2) / volume.max(1e-9)) as usize;
            for _ in 0..count.max(4) {
                let ball = random.ball();
                // Leaves gather in the outer shell and on the upper side.
                let ball = ball.normalize_or(Vec3::Z) * pow(ball.length(), 0.6);
                let ball = if ball.z < -0.35 { ball * Vec3::new(1.0, 1.0, -0.6) } else { ball };
                let at = centre + ball * Vec3::new(wide, wide, high);
                spots.push(self.spot(at, ball, 0.0));
                if self.shape == Crown::Weeping && random.unit() < 0.3 {
                    self.strand(at, ball, random, &mut spots);
                }
            }
        }
        for i in (1..spots.len()).rev() {
            spots.swap(i, random.whole() as usize % (i + 1));
        }
        spots
    }

    /// Spot at a place inside a lobe.
    fn spot(&self, at: Vec3, ball: Vec3, hang: f32) -> Spot {
        let away = (at - self.centre()) / Vec3::new(self.radius, self.radius, self.height * 0.6);
        let normal = (ball * 0.75 + away * 0.65 + Vec3::Z * 0.3).normalize_or(Vec3::Z);
        Spot { at, normal, light: self.sky(at, normal, ball.length()), hang }
    }

    /// Hanging twig below a place.
    fn strand(&self, at: Vec3, ball: Vec3, random: &mut Random, spots: &mut Vec<Spot>) {
        let lowest = (self.foot * 0.45).max(0.05);
        let length = ((at.z - lowest) * random.range(0.3, 0.85)).min(self.height * 0.5);
        let drift = around(random.range(0.0, 7.0)) * 0.03;
        let count = (length / (0.06 * self.height)).clamp(0.0, 6.0) as usize;
        for i in 1..=count {
            let share = i as f32 / count as f32;
            let mut spot = self.spot(at + drift * share - Vec3::Z * (length * share), ball * (1.0 - 0.5 * share), 1.0);
            spot.light = mix(spot.light, 0.75, 0.3);
            spots.push(spot);
        }
    }
}
