//! A character that walks on the ground of a patch: it steps over what is low, is stopped by what is steep, slides down
//! slopes that are too steep to stand on, falls, and comes to rest.
//!
//! While it stands it is moved as characters usually are: up by the height of a step, along, and down again. In the air
//! and on steep ground it is a body under gravity, with the friction that holds it just to the limit of the slope, so
//! that the limit is one of sliding too and nobody trembles there.

use super::GroundPatch;
use crate::planet::Planet;
use crate::terrain::contact::{Capsule, Contact, Sweep};
use glam::DVec3;

/// Longest time of a step: the rest is dropped.
const MOST_SECS: f64 = 0.25;
/// Most things in one step along which a walker slides on.
const MOST_SLIDES: usize = 4;
/// Most places around at which a free one is looked for.
const MOST_PLACES: usize = 64;
/// Shares of the skin between which the gap of one who stands may be.
const RESTING: [f64; 2] = [0.25, 2.0];
/// Share of a step that is lifted beside a wall that leans over.
const LEAST_LIFT: f64 = 0.25;
/// What has a normal with less than this share upwards is a wall.
const STEEP: f64 = 0.3;
/// What falls by less than this share of a step under gravity is held.
const HELD: f64 = 1e-3;
/// The same between two sides.
const WEDGED: f64 = 0.05;
/// The Earth's, m/s² and metres.
const EARTH: [f64; 2] = [9.81, 6_371_000.0];

/// The body of a walker: an upright capsule, and what it can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkerBody {
    /// Radius of the capsule.
    pub radius_m: f64,
    /// Height of the capsule from foot to head, at least twice the radius.
    pub height_m: f64,
    /// Highest step, up or down, that is taken without a jump or a fall.
    pub step_m: f64,
    /// Steepest ground that can be walked on and stood on.
    pub slope_limit_rad: f64,
    /// Width of the gap between the body and the ground.
    pub skin_m: f64,
    /// Acceleration towards the centre of the planet.
    pub gravity_m_s2: f64,
}

/// A character on the ground of a patch, in the planet frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walker {
    /// Its body. It may change between steps.
    pub body: WalkerBody,
    feet_planet_m: DVec3,
    velocity_m_s: DVec3,
    /// Normal of the ground that holds it.
    support: Option<DVec3>,
}

impl Default for WalkerBody {
    /// A person on the Earth.
    fn default() -> Self {
        Self { radius_m: 0.35, height_m: 1.8, step_m: 0.35, slope_limit_rad: 0.8, skin_m: 0.01, gravity_m_s2: EARTH[0] }
    }
}

impl WalkerBody {
    /// Step to the place of a number on a spiral of the golden angle, with two places on the area of the body.
    fn place_around(&self, up: DVec3, number: usize) -> DVec3 {
        let (number, (east, north)) = (number as f64 + 1.0, up.any_orthonormal_pair());
        let (sin, cos) = libm::sincos(2.399_963 * number);
        (east * cos + north * sin) * (0.7 * self.radius_m * number.sqrt())
    }

    /// A person on a planet: with the gravity that its radius gives it if it is as dense as the Earth.
    pub fn on(planet: &Planet) -> Self {
        Self { gravity_m_s2: EARTH[0] * planet.radius_m() / EARTH[1], ..Self::default() }
    }

    /// The capsule of a body whose feet are at a position.
    pub fn capsule_at(&self, feet_planet_m: DVec3) -> Capsule {
        let feet_m = feet_planet_m;
        let up = feet_m.normalize_or(DVec3::Z);
        let top_m = (self.height_m - self.radius_m).max(self.radius_m);
        Capsule { ends_planet_m: [feet_m + up * self.radius_m, feet_m + up * top_m], radius_m: self.radius_m }
    }

    /// Whether ground with a normal can be stood on.
    fn holds_on(&self, normal: DVec3, up: DVec3) -> bool {
        normal.dot(up) >= libm::cos(self.slope_limit_rad)
    }
}

/// Obstacles of a walker: what it stands on and what stops it.
///
/// [`GroundPatch`] is the ground alone, `life::Surroundings` the ground with trunks and stones.
pub trait Walkable {
    /// The ground on which they stand.
    fn ground(&mut self) -> &mut GroundPatch;

    /// As [`GroundPatch::contact`], with the nearest of all obstacles.
    fn contact(&mut self, capsule: &Capsule, within_m: f64) -> Option<Contact>;

    /// The way out of what stands on the ground, for a capsule that is put into it; zero for one that is free.
    fn way_aside(&mut self, _capsule: &Capsule, _skin_m: f64) -> DVec3 {
        DVec3::ZERO
    }

    /// As [`GroundPatch::sweep`], until the first of all obstacles.
    fn sweep(&mut self, capsule: &Capsule, motion_planet_m: DVec3, skin_m: f64) -> Option<Sweep>;
}

impl Walkable for GroundPatch {
    fn ground(&mut self) -> &mut GroundPatch {
        self
    }

    fn contact(&mut self, capsule: &Capsule, within_m: f64) -> Option<Contact> {
        GroundPatch::contact(self, capsule, within_m)
    }

    fn sweep(&mut self, capsule: &Capsule, motion_planet_m: DVec3, skin_m: f64) -> Option<Sweep> {
        GroundPatch::sweep(self, capsule, motion_planet_m, skin_m)
    }
}

/// Where a walker would come to stand.
struct Landing {
    feet_m: DVec3,
    contact: Contact,
}

impl Walker {
    /// A walker whose feet are at a position. It falls if that is above the ground.
    pub fn new(body: WalkerBody, feet_planet_m: DVec3) -> Self {
        Self { body, feet_planet_m, velocity_m_s: DVec3::ZERO, support: None }
    }

    /// A walker on the ground in a direction.
    pub fn on_ground(body: WalkerBody, patch: &mut impl Walkable, dir_planet: DVec3) -> Self {
        let mut up = crate::terrain::points::unit(dir_planet);
        // Beside a slope the body touches before the feet do: it comes down from where it is free.
        let high_m = body.radius_m + body.step_m + body.skin_m;
        let over = |patch: &mut GroundPatch, up: DVec3| {
            up * (patch.terrain().planet().radius_m() + patch.height_m(up) + high_m)
        };
        let first_m = over(patch.ground(), up);
        let mut walker = Self::new(body, first_m);
        let mut slid = None;
        for number in 0..=MOST_SLIDES + MOST_PLACES {
            let aside_m = patch.way_aside(&body.capsule_at(walker.feet_planet_m), body.skin_m);
            if aside_m == DVec3::ZERO {
                break;
            }
            // Between objects that push it to and fro it looks around, farther and farther; without a free place it
            // stays where it was pushed to.
            let place_m = match number.checked_sub(MOST_SLIDES) {
                None => walker.feet_planet_m + aside_m,
                Some(MOST_PLACES) => slid.unwrap_or(first_m),
                Some(number) => {
                    slid.get_or_insert(walker.feet_planet_m);
                    first_m + body.place_around(first_m.normalize_or(up), number)
                }
            };
            up = place_m.normalize_or(up);
            walker.feet_planet_m = over(patch.ground(), up);
        }
        for _ in 0..MOST_SLIDES {
            let from_m = walker.feet_planet_m;
            match patch.sweep(&body.capsule_at(from_m), up * -2.0 * high_m, body.skin_m) {
                // In a crevice: higher up it is free.
                Some(sweep) if sweep.share == 0.0 => walker.feet_planet_m = from_m + up * 4.0 * high_m,
                Some(sweep) => {
                    let feet_m = from_m - up * (2.0 * high_m * sweep.share);
                    walker.stand(feet_m, sweep.contact.normal_planet);
                    break;
                }
                None => break,
            }
        }
        walker
    }

    /// The lowest point of the body, a skin's width over level ground.
    pub fn feet_planet_m(&self) -> DVec3 {
        self.feet_planet_m
    }

    /// How fast it moves.
    pub fn velocity_planet_m_s(&self) -> DVec3 {
        self.velocity_m_s
    }

    /// Whether it stands, rather than falls or slides.
    pub fn is_standing(&self) -> bool {
        self.support.is_some()
    }

    /// Jumps, if it stands: `speed_m_s` upwards.
    pub fn jump(&mut self, speed_m_s: f64) {
        if self.support.take().is_some() && speed_m_s.is_finite() {
            self.velocity_m_s += self.up() * speed_m_s;
        }
    }

    /// Advances by a time, at most a quarter of a second. One who stands walks with the part of `wish_m_s` that is
    /// level, slower uphill and downhill by the way that the slope adds; one who falls or slides cannot. What is not
    /// finite counts as no wish, or no time.
    pub fn step(&mut self, patch: &mut impl Walkable, wish_m_s: DVec3, duration_secs: f64) {
        let secs = if duration_secs.is_finite() { duration_secs.clamp(0.0, MOST_SECS) } else { 0.0 };
        if secs == 0.0 {
            return;
        }
        let up = self.up();
        let wish_m_s = if wish_m_s.is_finite() { wish_m_s - up * wish_m_s.dot(up) } else { DVec3::ZERO };
        match self.support {
            Some(_) if wish_m_s == DVec3::ZERO => self.rest(patch),
            Some(normal) => {
                // One who leans on a wall is on level ground.
                let slope = normal.dot(up);
                self.walk(patch, wish_m_s * if slope < STEEP { 1.0 } else { slope }, secs, normal);
            }
            None => self.fall(patch, secs),
        }
    }

    fn up(&self) -> DVec3 {
        self.feet_planet_m.normalize_or(DVec3::Z)
    }

    fn stand(&mut self, feet_m: DVec3, normal: DVec3) {
        (self.feet_planet_m, self.support) = (feet_m, Some(normal));
    }

    /// Stays where it is, to the bit, as long as the ground does.
    fn rest(&mut self, patch: &mut impl Walkable) {
        self.velocity_m_s = DVec3::ZERO;
        let skin_m = self.body.skin_m.max(super::TOUCH_M);
        let [least_m, most_m] = RESTING.map(|share| share * skin_m);
        match patch.contact(&self.body.capsule_at(self.feet_planet_m), most_m) {
            None => self.support = None,
            Some(contact) if contact.gap_m < least_m => {
                let (up, normal) = (self.up(), contact.normal_planet);
                // Beside a wall it goes away from it; else it would climb it.
                let way = if normal.dot(up) < STEEP { normal } else { up };
                self.feet_planet_m += way * (skin_m - contact.gap_m);
            }
            Some(_) => {}
        }
    }

    /// One step of one who stands.
    fn walk(&mut self, patch: &mut impl Walkable, pace_m_s: DVec3, secs: f64, support: DVec3) {
        let (from_m, up, body) = (self.feet_planet_m, self.up(), self.body);
        let wished_m = pace_m_s * secs;
        let (feet_m, contact) = match self.landing(patch, wished_m) {
            Some(Ok(Landing { feet_m, contact })) => (feet_m, contact),
            Some(Err(in_air_m)) => {
                // Over an edge: it keeps its speed.
                (self.feet_planet_m, self.velocity_m_s, self.support) = (in_air_m, pace_m_s, None);
                return;
            }
            None => return self.rest(patch),
        };
        let (feet_m, normal) = self.beside(patch, &Landing { feet_m, contact }, wished_m);
        let to_m = if body.holds_on(normal, up) || self.leads_on(patch, wished_m) {
            self.stand(feet_m, normal);
            feet_m
        } else {
            let downhill = (normal - up * normal.dot(up)).normalize_or_zero();
            let against_m = wished_m.dot(downhill);
            if against_m > 0.0 {
                self.support = None;
                feet_m
            } else {
                self.along(patch, wished_m - downhill * against_m, support)
            }
        };
        self.feet_planet_m = to_m;
        self.velocity_m_s = (to_m - from_m) / secs;
    }

    /// Where one who stands comes to who cannot go uphill.
    fn along(&mut self, patch: &mut impl Walkable, wished_m: DVec3, support: DVec3) -> DVec3 {
        let (from_m, up, body) = (self.feet_planet_m, self.up(), self.body);
        let Some(Ok(landing)) = self.landing(patch, wished_m) else { return from_m };
        let (feet_m, normal) = self.beside(patch, &landing, wished_m);
        if body.holds_on(normal, up) || self.leads_on(patch, wished_m) {
            self.stand(feet_m, normal);
            return feet_m;
        }
        // One who is wedged between steep sides gets out along them, if that is not steep, and slides if not held.
        let rise_m = (feet_m - from_m).dot(up);
        if !body.holds_on(support, up) && rise_m <= libm::tan(body.slope_limit_rad) * wished_m.length() {
            self.support = None;
            return feet_m;
        }
        from_m
    }

    /// Where one who would come down on a steep side stands beside it: the feet, and the normal of what holds them. One
    /// who climbs the edge of a kerb stays there.
    fn beside(&self, patch: &mut impl Walkable, landing: &Landing, wished_m: DVec3) -> (DVec3, DVec3) {
        let (body, up, normal) = (self.body, self.up(), landing.contact.normal_planet);
        let on_side = (landing.feet_m, normal);
        if body.holds_on(normal, up) {
            return on_side;
        }
        let down_m = up * (-2.0 * body.step_m);
        let (feet_m, Some(ground)) = self.slide(patch, landing.feet_m, down_m) else { return on_side };
        if !body.holds_on(ground.normal_planet, up) {
            return on_side;
        }
        let edge_m = (landing.contact.point_planet_m - feet_m).dot(up);
        let ahead_m = wished_m.normalize_or_zero() * (body.radius_m + wished_m.length());
        match self.landing(patch, ahead_m) {
            Some(Ok(ahead)) if self.climbs(&ahead, feet_m, ahead_m, edge_m) => on_side,
            _ => (feet_m, ground.normal_planet),
        }
    }

    /// Whether one gets as far as it should, onto an edge or nearly, and is held there.
    fn climbs(&self, ahead: &Landing, from_m: DVec3, wished_m: DVec3, edge_m: f64) -> bool {
        let (gone_m, is_held) = (ahead.feet_m - from_m, self.body.holds_on(ahead.contact.normal_planet, self.up()));
        is_held && gone_m.dot(wished_m) > 0.9 * wished_m.length_squared() && gone_m.dot(self.up()) > 0.5 * edge_m
    }

    /// Goes up or down, and along steep sides on the way: where that ends, and what else stops it.
    fn slide(&self, patch: &mut impl Walkable, from_m: DVec3, motion_m: DVec3) -> (DVec3, Option<Contact>) {
        let (body, up) = (self.body, self.up());
        let (mut feet_m, mut left_m) = (from_m, motion_m);
        for _ in 0..MOST_SLIDES {
            let Some(hit) = patch.sweep(&body.capsule_at(feet_m), left_m, body.skin_m) else {
                return (feet_m + left_m, None);
            };
            feet_m += left_m * hit.share;
            let normal = hit.contact.normal_planet;
            if body.holds_on(normal * normal.dot(up).signum(), up) {
                return (feet_m, Some(hit.contact));
            }
            left_m *= 1.0 - hit.share;
            left_m -= normal * left_m.dot(normal).min(0.0);
        }
        (feet_m, None)
    }

    /// Whether the way leads onto ground that can be stood on, no higher or lower than a step: over the edge of a kerb.
    fn leads_on(&self, patch: &mut impl Walkable, wished_m: DVec3) -> bool {
        let ahead_m = wished_m.normalize_or_zero() * (self.body.radius_m + wished_m.length());
        match self.landing(patch, ahead_m) {
            Some(Ok(landing)) => self.body.holds_on(landing.contact.normal_planet, self.up()),
            _ => false,
        }
    }

    /// Up by a step, along, and down by two: where that ends, or the position in the air of one who went over an edge.
    /// None if there is no way.
    fn landing(&self, patch: &mut impl Walkable, wished_m: DVec3) -> Option<Result<Landing, DVec3>> {
        let (body, up) = (self.body, self.up());
        let lift = patch.sweep(&body.capsule_at(self.feet_planet_m), up * body.step_m, body.skin_m);
        let mut lifted_m = body.step_m * lift.map_or(1.0, |lift| lift.share);
        let (mut feet_m, mut left_m) = (self.feet_planet_m + up * lifted_m, wished_m);
        // A wall that leans over it lets it lift its feet a little, away from the wall.
        let lacking_m = LEAST_LIFT * body.step_m - lifted_m;
        if lacking_m > 0.0 {
            (feet_m, _) = self.slide(patch, feet_m, up * lacking_m);
            lifted_m = (feet_m - self.feet_planet_m).dot(up).max(0.0);
        }
        let mut sweep = |feet_m: DVec3, motion_m: DVec3| patch.sweep(&body.capsule_at(feet_m), motion_m, body.skin_m);
        for _ in 0..MOST_SLIDES {
            let Some(hit) = sweep(feet_m, left_m) else {
                feet_m += left_m;
                break;
            };
            feet_m += left_m * hit.share;
            let wall = hit.contact.normal_planet;
            let wall = (wall - up * wall.dot(up)).normalize_or_zero();
            left_m *= 1.0 - hit.share;
            left_m -= wall * left_m.dot(wall).min(0.0);
        }
        let fall_m = lifted_m + body.step_m;
        match sweep(feet_m, up * -fall_m) {
            Some(hit) if hit.contact.gap_m < 0.0 => None,
            Some(hit) => Some(Ok(Landing { feet_m: feet_m - up * (fall_m * hit.share), contact: hit.contact })),
            None => Some(Err(feet_m - up * lifted_m)),
        }
    }

    /// One step of one who falls or slides.
    fn fall(&mut self, patch: &mut impl Walkable, secs: f64) {
        let (from_m, up, body) = (self.feet_planet_m, self.up(), self.body);
        let friction = libm::tan(body.slope_limit_rad);
        let fallen_m_s = body.gravity_m_s2 * secs;
        self.velocity_m_s -= up * fallen_m_s;
        let mut left_secs = secs;
        let (mut sides, mut met) = ([DVec3::ZERO; MOST_SLIDES], 0);
        while met < MOST_SLIDES {
            let motion_m = self.velocity_m_s * left_secs;
            let Some(hit) = patch.sweep(&body.capsule_at(self.feet_planet_m), motion_m, body.skin_m) else {
                self.feet_planet_m += motion_m;
                break;
            };
            let normal = hit.contact.normal_planet;
            self.feet_planet_m += motion_m * hit.share;
            if hit.contact.gap_m < 0.0 {
                self.feet_planet_m += normal * (body.skin_m - hit.contact.gap_m);
            }
            left_secs *= 1.0 - hit.share;
            if body.holds_on(normal, up) {
                self.velocity_m_s = DVec3::ZERO;
                self.stand(self.feet_planet_m, normal);
                return;
            }
            // The side takes the speed towards it, and friction a part of the rest.
            let into_m_s = -self.velocity_m_s.dot(normal).min(0.0);
            self.velocity_m_s += normal * into_m_s;
            if let Some(other) = sides[..met].iter().find(|other| self.velocity_m_s.dot(**other) < 0.0) {
                let edge = other.cross(normal).normalize_or_zero();
                self.velocity_m_s = edge * self.velocity_m_s.dot(edge);
            }
            let speed_m_s = self.velocity_m_s.length();
            let slower = 1.0 - friction * into_m_s / speed_m_s.max(f64::MIN_POSITIVE);
            self.velocity_m_s *= slower.max(0.0);
            sides[met] = normal;
            met += 1;
        }
        // Between two sides it comes to rest a little early: each pushes it towards the other.
        let held = if met > 1 { WEDGED } else { HELD };
        let is_held = (from_m - self.feet_planet_m).dot(up) < held * fallen_m_s * secs;
        if let Some(normal) = sides[..met].last().filter(|_| is_held && self.velocity_m_s.length() < held * fallen_m_s)
        {
            self.velocity_m_s = DVec3::ZERO;
            self.stand(self.feet_planet_m, *normal);
        }
    }
}
