use super::*;
use crate::world::grid::{node, refined};
use crate::world::noise::fbm;
use std::collections::BTreeMap;

/// A continent, or a few: height before rise, and rise.
struct Island {
    side: usize,
    initial_m: Vec<f64>,
    uplift_m: Vec<f64>,
    even: Vec<f64>,
    params: Params,
    courses: Vec<DrawnCourse>,
}

impl Island {
    /// A round continent with rough heights.
    fn new(side: usize) -> Self {
        let cells = Cells::of(side);
        let middle = DVec3::new(0.5, 0.6, 0.62).normalize();
        let inside = |d: &DVec3| 0.75 - d.distance(middle) + 0.12 * fbm(*d, 3.0, 4, 0.55, 5);
        let initial_m = cells.dirs.iter().map(|d| (1500.0 * inside(d)).clamp(-4000.0, 60.0)).collect();
        let rise = |d: &DVec3| 3000.0 * (0.4 + 0.6 * fbm(*d, 4.0, 3, 0.5, 6)).clamp(0.15, 1.0);
        let uplift_m = cells.dirs.iter().map(|d| if inside(d) > 0.0 { rise(d) } else { 0.0 }).collect();
        let params = Params { age_myr: 40.0, rock_variation: 0.0, deposition: 0.0, ..Params::default() };
        Self { side, initial_m, uplift_m, even: vec![0.0; cells.dirs.len()], params, courses: Vec::new() }
    }

    fn finer(&self) -> Self {
        let cells = Cells::of(self.side);
        let double = |values: &[f64]| refined(&cells, values);
        let (initial_m, uplift_m, even) = (double(&self.initial_m), double(&self.uplift_m), double(&self.even));
        Self {
            side: 2 * self.side,
            initial_m,
            uplift_m,
            even,
            params: self.params.clone(),
            courses: self.courses.clone(),
        }
    }

    fn solved(&self, coarser: Option<&Drainage>) -> Drainage {
        self.solved_with(&vec![400.0; self.even.len()], &vec![-500.0; self.even.len()], coarser, &|| true).unwrap()
    }

    fn solved_with(
        &self,
        runoff_mm: &[f64],
        dryness_mm: &[f64],
        coarser: Option<&Drainage>,
        keep_going: &KeepGoing<'_>,
    ) -> Option<Drainage> {
        let inputs = Inputs {
            params: &self.params,
            seed: 3,
            side: self.side,
            radius_km: 6371.0,
            sea_level_m: Some(0.0),
            initial_m: &self.initial_m,
            uplift_m: &self.uplift_m,
            softness: &self.even,
            courses: &self.courses,
            runoff_mm,
            dryness_mm,
        };
        Drainage::solve(&inputs, coarser, keep_going)
    }
}

/// The end of the way down from a cell.
fn end(found: &Drainage, mut cell: usize) -> usize {
    for _ in 0..found.receiver.len() {
        let to = found.receiver[cell] as usize;
        if to == cell {
            return cell;
        }
        cell = to;
    }
    panic!("the way down from {cell} is a ring");
}

/// Least-squares slope of y by x.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let (xy, xx) =
        points.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - mx) * (p.1 - my), xx + (p.0 - mx) * (p.0 - mx)));
    xy / xx
}

#[test]
fn all_water_reaches_the_sea_or_a_closed_basin_and_no_ground_rises_along_it() {
    let mut island = Island::new(48);
    island.params = Params::default();
    let found = island.solved(None);
    assert!(found.order.len() > 500);
    for &cell in &found.order {
        let (cell, last) = (cell as usize, end(&found, cell as usize));
        assert!(found.is_sea[last] || found.sinks.contains(&(last as u32)), "{cell} ends on land");
        let to = found.receiver[cell] as usize;
        assert!(found.bed_m[cell] >= found.bed_m[to], "{cell}: {} {}", found.bed_m[cell], found.bed_m[to]);
        if found.lake[cell] == 0 && found.lake[to] == 0 && !found.is_sea[to] {
            assert!(found.height_m[cell] >= found.height_m[to]);
        }
    }
}

/// A course across a continent, from one coast to another place.
fn course(from: DVec3, to: DVec3, spring_m3_s: f64, cut: f64) -> DrawnCourse {
    let points = (0..=4).map(|k| from.lerp(to, f64::from(k) * 0.25).normalize()).collect();
    DrawnCourse { points, wander_rad: 0.0, seed: 1, spring_m3_s, cut }
}

#[test]
fn a_drawn_river_follows_its_line_to_the_sea_and_gathers_water_along_it() {
    let middle = DVec3::new(0.5, 0.6, 0.62).normalize();
    let (east, north) = crate::sphere::geo::east_north(middle);
    let mut island = Island::new(48);
    let bare = island.solved(None);
    // From beyond the middle, over its watershed, far out into the sea.
    let [spring, sea] = [-0.2, 1.2].map(|along| (middle + (east * 0.8 + north * 0.6) * along).normalize());
    island.courses = vec![course(spring, sea, 0.0, 0.9)];
    for side in [48, 96] {
        let found = match side {
            48 => island.solved(None),
            _ => island.finer().solved(Some(&island.solved(None))),
        };
        let mut cell = crate::world::grid::cell_at(side, spring);
        assert!(!found.is_sea[cell]);
        let (mut length, mut before) = (0, 0);
        while !found.is_sea[cell] {
            let dir = Cells::of(side).dirs[cell];
            let aside = dir.dot(spring.cross(sea).normalize()).abs();
            assert!(aside < 1.5 / side as f64 * 2.0, "{aside} from the line, cell {length}");
            assert!(found.discharge[cell] > before, "no water flows in");
            (before, length) = (found.discharge[cell], length + 1);
            assert!(found.receiver[cell] as usize != cell, "it ends on land after {length} cells");
            cell = found.receiver[cell] as usize;
        }
        assert!(length > side / 4, "{length} cells");
        assert!(found.order.iter().all(|cell| found.is_sea[end(&found, *cell as usize)]
            || found.sinks.contains(&(end(&found, *cell as usize) as u32))));
    }
    // Without the line its water went elsewhere.
    let mut cell = crate::world::grid::cell_at(48, spring);
    let mut aside = 0.0_f64;
    while !bare.is_sea[cell] && bare.receiver[cell] as usize != cell {
        aside = aside.max(Cells::of(48).dirs[cell].dot(spring.cross(sea).normalize()).abs());
        cell = bare.receiver[cell] as usize;
    }
    assert!(aside > 3.0 / 48.0 * 2.0, "{aside}");
}

#[test]
fn a_spring_adds_its_water_and_a_cut_lowers_the_bed() {
    let middle = DVec3::new(0.5, 0.6, 0.62).normalize();
    let (east, _) = crate::sphere::geo::east_north(middle);
    let sea = (middle + east * 1.2).normalize();
    let solved = |spring_m3_s: f64, cut: f64| {
        let mut island = Island::new(48);
        island.courses = vec![course(middle, sea, spring_m3_s, cut)];
        let found = island.solved(None);
        let cell = crate::world::grid::cell_at(48, middle);
        (found.discharge_m3_s[cell], found.bed_m[cell])
    };
    let [(dry, high_m), (wet, _), (_, low_m)] = [solved(0.0, 0.0), solved(5000.0, 0.0), solved(0.0, 1.0)];
    // A greater river cuts deeper, and gathers a little more.
    assert!((5000.0..6000.0).contains(&(wet - dry)), "{dry} {wet}");
    assert!(low_m < 0.5 * high_m, "{low_m} {high_m}");
}

#[test]
fn a_drawn_river_may_end_inland_or_join_another() {
    let middle = DVec3::new(0.5, 0.6, 0.62).normalize();
    let (east, north) = crate::sphere::geo::east_north(middle);
    let at = |x: f64, y: f64| (middle + east * x + north * y).normalize();
    let mut island = Island::new(48);
    island.courses = vec![
        course(at(-0.1, 0.0), at(1.2, 0.0), 100.0, 0.5),
        course(at(0.1, 0.3), at(0.1, -0.2), 3000.0, 0.5),
        course(at(-0.2, -0.3), at(-0.35, -0.25), 2000.0, 0.5),
    ];
    let found = island.solved(None);
    island.courses.truncate(1);
    let alone = island.solved(None);
    let more = |x: f64, y: f64| {
        let cell = crate::world::grid::cell_at(48, at(x, y));
        found.discharge_m3_s[cell] - alone.discharge_m3_s[cell]
    };
    assert!(more(0.2, 0.0) >= 2999.0, "the second joins the first: {}", more(0.2, 0.0));
    assert!(more(-0.35, -0.25) >= 1999.0, "the third has its water at its end: {}", more(-0.35, -0.25));
    assert!(found.order.iter().all(|cell| {
        let last = end(&found, *cell as usize);
        found.is_sea[last] || found.sinks.contains(&(last as u32))
    }));
}

#[test]
fn no_two_ways_cross() {
    let bare = Island::new(48);
    let (middle, sea) = (DVec3::new(0.5, 0.6, 0.62).normalize(), DVec3::new(0.9, -0.3, 0.4).normalize());
    let drawn = Island { courses: vec![course(middle, sea, 100.0, 0.5)], ..Island::new(48) };
    no_ways_cross(&bare.solved(None));
    no_ways_cross(&drawn.solved(None));
}

fn no_ways_cross(found: &Drainage) {
    let cells = Cells::of(48);
    let place = |cell: u32| node(found.side, cell as usize, found.seed);
    let mut crossings = 0;
    for &cell in &found.order {
        let (a, b) = (place(cell), place(found.receiver[cell as usize]));
        for near in cells.around(cell as usize) {
            let to = found.receiver[near as usize];
            if found.is_sea[near as usize] || [to, near].contains(&found.receiver[cell as usize]) || to == cell {
                continue;
            }
            let (c, d) = (place(near), place(to));
            let side = |p: DVec3, q: DVec3, r: DVec3| p.cross(q).dot(r);
            let apart = side(a, b, c) * side(a, b, d) > 0.0 || side(c, d, a) * side(c, d, b) > 0.0;
            crossings += usize::from(!apart);
        }
    }
    assert_eq!(crossings, 0);
}

#[test]
fn beds_are_concave_as_stream_power_has_it() {
    let mut island = Island::new(64);
    island.uplift_m.iter_mut().for_each(|m| *m = if *m > 0.0 { 800.0 } else { 0.0 });
    let found = island.solved(None);
    let mut points = Vec::new();
    for &cell in &found.order {
        let (cell, to) = (cell as usize, found.receiver[cell as usize] as usize);
        let step = place_rad(&found, cell, to);
        let drop = found.bed_m[cell] - found.bed_m[to];
        if drop > 0.1 && found.lake[cell] == 0 && !found.is_sea[to] {
            points.push((libm::log(found.discharge[cell] as f64), libm::log(drop / step)));
        }
    }
    let concavity = -slope(&points);
    assert!((0.4..=0.52).contains(&concavity), "{concavity}");
}

fn place_rad(found: &Drainage, a: usize, b: usize) -> f64 {
    node(found.side, a, found.seed).distance(node(found.side, b, found.seed))
}

#[test]
fn networks_branch_as_natural_ones_do() {
    let found = Island::new(96).solved(None);
    // Strahler's orders of channels, and the longest way above each cell. A channel begins where a few cells meet: each
    // cell alone would count as a source, whatever the land.
    let count = found.receiver.len();
    let cell_units = 400.0 * 1e-3 * 4.0 * std::f64::consts::PI / count as f64 / DISCHARGE_UNIT;
    let is_channel = |cell: usize| found.discharge[cell] as f64 > 3.5 * cell_units;
    let (mut order, mut twins, mut length) = (vec![1_u32; count], vec![0_u32; count], vec![0.0_f64; count]);
    let mut streams: BTreeMap<u32, u32> = BTreeMap::new();
    for &cell in found.order.iter().rev() {
        let (cell, to) = (cell as usize, found.receiver[cell as usize] as usize);
        if twins[cell] >= 2 {
            order[cell] += 1;
        }
        if to == cell {
            continue;
        }
        length[to] = length[to].max(length[cell] + place_rad(&found, cell, to));
        if !is_channel(cell) {
            continue;
        }
        match order[to].cmp(&order[cell]) {
            std::cmp::Ordering::Less => (order[to], twins[to]) = (order[cell], 1),
            std::cmp::Ordering::Equal => twins[to] += 1,
            std::cmp::Ordering::Greater => {}
        }
    }
    for &cell in &found.order {
        let (cell, to) = (cell as usize, found.receiver[cell as usize] as usize);
        if is_channel(cell) && (found.is_sea[to] || order[to] != order[cell]) {
            *streams.entry(order[cell]).or_default() += 1;
        }
    }
    let number = |order: u32| f64::from(streams.get(&order).copied().unwrap_or(0));
    for (low, high) in [(1, 2), (2, 3)] {
        let ratio = number(low) / number(high);
        assert!((2.8..=5.2).contains(&ratio), "orders {low} and {high}: {ratio} of {streams:?}");
    }
    // Hack's law: the length of a river by its area.
    let points: Vec<(f64, f64)> = found
        .order
        .iter()
        .map(|&cell| cell as usize)
        .filter(|&cell| found.discharge[cell] as f64 > 12.0 * cell_units)
        .map(|cell| (libm::log(found.discharge[cell] as f64), libm::log(length[cell])))
        .collect();
    let exponent = slope(&points);
    assert!((0.48..=0.64).contains(&exponent), "{exponent}");
}

#[test]
fn a_finer_grid_keeps_the_great_rivers() {
    let island = Island::new(32);
    let coarse = island.solved(None);
    let fine = island.finer().solved(Some(&coarse));
    let least = coarse.discharge.iter().max().unwrap() / 12;
    let (mut near, mut all) = (0, 0);
    for &cell in coarse.order.iter().filter(|&&cell| coarse.discharge[cell as usize] > least) {
        let dir = node(32, cell as usize, coarse.seed);
        all += 1;
        let is_near = |&cell: &u32| {
            fine.discharge[cell as usize] > least / 2 && node(64, cell as usize, fine.seed).distance(dir) < 2.0 / 32.0
        };
        near += usize::from(fine.order.iter().any(is_near));
    }
    assert!(all > 20 && near * 10 >= all * 9, "{near} of {all}");
}

#[test]
fn older_rivers_have_worn_more_and_young_ones_leave_the_plateau() {
    let mean = |age_myr: f64| {
        let mut island = Island::new(32);
        island.params.age_myr = age_myr;
        let found = island.solved(None);
        found.order.iter().map(|&cell| f64::from(found.height_m[cell as usize])).sum::<f64>() / found.order.len() as f64
    };
    let (young, middle, old) = (mean(0.5), mean(10.0), mean(100.0));
    assert!(young > 1.3 * middle && middle > 2.0 * old, "{young} {middle} {old}");
}

/// A continent with a deep basin in its middle.
fn basin() -> Island {
    let mut island = Island::new(48);
    let middle = DVec3::new(0.5, 0.6, 0.62).normalize();
    for (cell, dir) in Cells::of(48).dirs.iter().enumerate() {
        let away = dir.distance(middle);
        if away < 0.3 {
            island.uplift_m[cell] = 300.0;
            island.initial_m[cell] = 20.0;
        } else if island.uplift_m[cell] > 0.0 {
            island.uplift_m[cell] = island.uplift_m[cell].max(2200.0);
        }
    }
    island.params.age_myr = 3.0;
    island
}

#[test]
fn a_dry_basin_keeps_its_water_and_a_wet_one_overflows() {
    let island = basin();
    let count = island.even.len();
    let dry = island.solved_with(&vec![60.0; count], &vec![1500.0; count], None, &|| true).unwrap();
    assert!(!dry.sinks.is_empty());
    let closed: Vec<&Lake> = dry.lakes.iter().filter(|lake| lake.outlet.is_none()).collect();
    assert!(!closed.is_empty() && closed.iter().all(|lake| lake.area_sr < 0.2), "{closed:?}");
    let wet = island.solved_with(&vec![900.0; count], &vec![-300.0; count], None, &|| true).unwrap();
    assert!(wet.sinks.is_empty());
    let open: Vec<&Lake> = wet.lakes.iter().filter(|lake| lake.outlet.is_some()).collect();
    assert!(open.iter().any(|lake| lake.area_sr > 0.02), "{open:?}");
    for (cell, &number) in wet.lake.iter().enumerate().filter(|(_, number)| **number != 0) {
        assert!(f64::from(wet.height_m[cell]) < wet.lakes[number as usize - 1].level_m);
    }
}

/// Without a rim the water of a lake would stand as a wall beside lower ground.
#[test]
fn lakes_have_rims() {
    let rough = |side: usize| {
        let mut island = Island::new(side);
        island.params = Params { lakes: 1.5, age_myr: 4.0, ..island.params };
        for (uplift_m, dir) in island.uplift_m.iter_mut().zip(&Cells::of(side).dirs) {
            *uplift_m *= (0.7 + 0.9 * fbm(*dir, 9.0, 4, 0.6, 8)).clamp(0.0, 1.0);
        }
        island
    };
    for island in [basin(), rough(32), rough(64)] {
        for (runoff_mm, dryness_mm) in [(60.0, 1500.0), (900.0, -300.0)] {
            let count = island.even.len();
            let found = island.solved_with(&vec![runoff_mm; count], &vec![dryness_mm; count], None, &|| true).unwrap();
            let cells = Cells::of(island.side);
            let (mut shores, mut walls) = (0, 0);
            for (cell, &number) in found.lake.iter().enumerate().filter(|(_, number)| **number != 0) {
                let level_m = found.lakes[number as usize - 1].level_m;
                for other in cells.around(cell).into_iter().map(|other| other as usize) {
                    shores += usize::from(found.lake[other] != number);
                    walls += usize::from(found.lake[other] != number && found.bed_m[other] < level_m - 10.0);
                }
            }
            assert!(shores > 20 && walls == 0, "{} {runoff_mm}: {walls} of {shores}", island.side);
        }
    }
}

#[test]
fn equal_bits_on_any_number_of_threads_and_an_end_when_told() {
    let island = Island::new(32);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| island.solved(None))
    };
    let (one, three) = (on(1), on(3));
    assert!(one.bed_m.iter().zip(&three.bed_m).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!((one.receiver, one.discharge, one.lake), (three.receiver, three.discharge, three.lake));
    let even = vec![300.0; island.even.len()];
    assert!(island.solved_with(&even, &even, None, &|| false).is_none());
}

#[test]
fn a_planet_without_a_sea_has_rivers_that_run_dry_in_its_plains() {
    let island = Island::new(24);
    let even = vec![300.0; island.even.len()];
    let inputs = Inputs {
        params: &island.params,
        seed: 3,
        side: 24,
        radius_km: 40.0,
        sea_level_m: None,
        initial_m: &island.initial_m,
        uplift_m: &island.uplift_m,
        softness: &island.even,
        courses: &[],
        runoff_mm: &even,
        dryness_mm: &even,
    };
    let found = Drainage::solve(&inputs, None, &|| true).unwrap();
    let plains = found.is_sea.iter().filter(|sea| **sea).count() as f64 / found.is_sea.len() as f64;
    assert!((0.05..0.2).contains(&plains), "{plains}");
    assert!(found.height_m.iter().all(|m| m.is_finite()));
}
