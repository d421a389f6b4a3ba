//! Crowns of trees: outlines filled with lobes of foliage, and the points in them where leaves grow.

use super::math::{GOLDEN, TURN, around, cos, exp, mix, pow, sin, smooth};
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

/// Rounded mass of foliage: an upright ellipsoid.
#[derive(Clone, Copy, Debug)]
struct Lobe {
    /// Centre.
    centre: Vec3,
    /// Radii along the axes.
    reach: Vec3,
}

impl Lobe {
    /// Place as seen from the centre, in radii: shorter than 1 inside.
    fn inner(&self, at: Vec3) -> Vec3 {
        (at - self.centre) / self.reach
    }

    /// Length of a ray within the lobe, in radii: 2 through the centre.
    fn chord(&self, from: Vec3, way: Vec3) -> f32 {
        let (o, d) = (self.inner(from), way / self.reach);
        let length = d.length();
        let middle = -o.dot(d) / length;
        let half = 1.0 - (o.length_squared() - middle * middle);
        if half <= 0.0 {
            return 0.0;
        }
        let half = half.sqrt();
        (middle + half).max(0.0) - (middle - half).max(0.0)
    }
}

/// Directions from which the sky shines, with the share of each.
fn rays() -> [(Vec3, f32); 9] {
    let mut rays = [(Vec3::Z, 0.2); 9];
    for i in 0..4 {
        let angle = TURN * (i as f32 + 0.3) / 4.0;
        rays[1 + i] = (around(angle) * cos(0.85) + Vec3::Z * sin(0.85), 0.135);
        rays[5 + i] = (around(angle + 0.8) * cos(0.2) + Vec3::Z * sin(0.2), 0.065);
    }
    rays
}

/// Crown filled with lobes.
#[derive(Clone, Debug)]
pub(super) struct Canopy {
    /// Outline.
    pub outline: Outline,
    /// Lobes of foliage.
    lobes: Vec<Lobe>,
    /// Share of light that a radius of leaves takes away, as an exponent.
    dense: f32,
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

    /// Whether it is the crown of a shrub, which begins at the ground.
    pub(super) fn low(&self) -> bool {
        self.shape == Crown::Round && self.foot < 0.08
    }

    /// Radius at a share of the height, as a share of the largest.
    fn profile(&self, h: f32) -> f32 {
        let dome = |h: f32| (1.0 - (2.0 * h - 1.0) * (2.0 * h - 1.0)).max(0.0).sqrt();
        match self.shape {
            // A shrub is wide down to the ground.
            Crown::Round if self.low() => dome(pow(mix(0.25, 1.0, h), 0.9)),
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

    /// Lobes of foliage; `share` is a factor on their number.
    fn lobes(&self, share: f32, random: &mut Random) -> Vec<Lobe> {
        let wild = self.irregular;
        let slender = (self.height / (2.0 * self.radius)).clamp(0.3, 6.0);
        let count = ((mix(22.0, 19.0, wild) * pow(slender, 0.5)).clamp(15.0, 34.0) * share) as usize;
        let low = self.low();
        let count = if low { count + 6 } else { count };
        let thick = match self.shape {
            Crown::Umbrella => self.radius * 0.85,
            Crown::Column => self.radius * 1.4,
            _ => self.radius.min(self.height * 0.5),
        };
        let spin = random.range(0.0, 7.0);
        (0..count)
            .map(|i| {
                let h = (i as f32 + 0.5 + random.signed() * 0.35) / count as f32;
                let size = thick * mix(0.42, 0.36, wild) * (1.0 + random.signed() * (0.15 + 0.35 * wild));
                let vertical = match self.shape {
                    Crown::Umbrella => (size * 0.5).min(self.height * 0.36),
                    _ if low => size * 0.9,
                    _ => size * mix(0.95, 0.72, wild),
                };
                let room = (self.radius * self.profile(h) - size * 0.85).max(0.0);
                let out = room * (1.0 - 0.45 * wild * random.unit());
                // Every third lobe of a wide crown fills its inside.
                let out = if i % 4 == 3 { out * random.range(0.2, 0.7) } else { out };
                let angle = spin + i as f32 * GOLDEN + random.signed() * 0.5 * wild;
                let z = self.foot + mix(vertical * if low { 0.55 } else { 0.8 }, self.height - vertical, h);
                let wide = size.min(self.radius * self.profile(h) + thick * 0.12);
                Lobe { centre: around(angle) * out + Vec3::Z * z, reach: Vec3::new(wide, wide, vertical) }
            })
            .collect()
    }
}

impl Canopy {
    /// Crown of a tree.
    pub(super) fn new(form: &Tree, random: &mut Random) -> Self {
        let outline = Outline::new(form);
        // A dead tree shows fewer branches.
        let lobes = outline.lobes(if form.leaves < 0.02 { 0.5 } else { 1.0 }, random);
        Self { outline, lobes, dense: 1.05 * form.leaves as f32 }
    }

    /// Share of the sky that is seen from a place with a normal: less inside the crown and below.
    fn open(&self, at: Vec3, normal: Vec3) -> f32 {
        let seen: f32 = rays()
            .iter()
            .map(|&(way, share)| {
                let deep: f32 = self.lobes.iter().map(|l| l.chord(at, way)).sum();
                share * exp(-self.dense * deep)
            })
            .sum();
        ((0.25 + 0.82 * pow(seen, 0.7)) * (0.82 + 0.22 * normal.z)).clamp(0.04, 1.0)
    }

    /// Whether a place lies deep inside a lobe other than its own.
    fn buried(&self, at: Vec3, own: usize, depth: f32) -> bool {
        let inside = |l: &Lobe| l.inner(at).length_squared() < depth * depth;
        self.lobes.iter().enumerate().any(|(i, l)| i != own && inside(l))
    }

    /// Points where leaves grow, in random order.
    pub(super) fn spots(&self, most: usize, random: &mut Random) -> Vec<Spot> {
        let volume: f32 = self.lobes.iter().map(|l| pow(l.reach.x, 2.2)).sum();
        let mut spots = Vec::new();
        for (own, lobe) in self.lobes.iter().enumerate() {
            let count = (most as f32 * pow(lobe.reach.x, 2.2) / volume.max(1e-9)) as usize;
            for _ in 0..count.max(4) {
                // Leaves gather in the outer shell and on the upper side, where no other lobe is.
                let mut ball = Vec3::Z;
                for _ in 0..4 {
                    ball = random.direction() * mix(0.8, 1.02, pow(random.unit(), 0.7));
                    ball.z = if ball.z < -0.45 { ball.z * -0.7 } else { ball.z };
                    if !self.buried(lobe.centre + ball * lobe.reach, own, 0.8) {
                        break;
                    }
                }
                let at = lobe.centre + ball * lobe.reach;
                spots.push(self.spot(at, ball, 0.0));
                if self.outline.shape == Crown::Weeping && random.unit() < 0.3 {
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
        let normal = self.normal(at, ball);
        Spot { at, normal, light: self.open(at, normal), hang }
    }

    /// Normal for lighting: away from the lobe and the crown.
    fn normal(&self, at: Vec3, ball: Vec3) -> Vec3 {
        let Outline { radius, height, .. } = self.outline;
        let away = (at - self.outline.centre()) / Vec3::new(radius, radius, height * 0.6);
        (ball * 0.85 + away * 0.5 + Vec3::Z * 0.2).normalize_or(Vec3::Z)
    }

    /// Hanging twig below a place.
    fn strand(&self, at: Vec3, ball: Vec3, random: &mut Random, spots: &mut Vec<Spot>) {
        let Outline { foot, height, .. } = self.outline;
        let lowest = (foot * 0.45).max(0.05);
        let length = ((at.z - lowest) * random.range(0.3, 0.85)).min(height * 0.5);
        let drift = around(random.range(0.0, 7.0)) * 0.03;
        let count = (length / (0.06 * height)).clamp(0.0, 6.0) as usize;
        for i in 1..=count {
            let share = i as f32 / count as f32;
            let mut spot = self.spot(at + drift * share - Vec3::Z * (length * share), ball * (1.0 - 0.5 * share), 1.0);
            spot.light = mix(spot.light, 0.75, 0.3);
            spots.push(spot);
        }
    }
}
