use super::*;
use crate::planet::{PlateByHand, PlateKind};
use crate::sphere::geo::east_north;
use crate::sphere::spread;
use crate::world::grid::areas_sr;

fn solved(seed: u32, side: usize) -> Plates {
    Plates::solve(&Params::default(), seed, side, &|| true).unwrap()
}

/// The share of the globe where the surface, after rock has risen, lies above the sea.
fn land_share(plates: &Plates) -> f64 {
    let areas = areas_sr(plates.rock.side);
    let land = (0..areas.len()).filter(|&cell| plates.rock.base_m[cell] + plates.rock.uplift_m[cell] > 0.0);
    land.map(|cell| areas[cell]).sum::<f64>() / areas.iter().sum::<f64>()
}

#[test]
fn the_default_has_about_as_much_land_as_the_earth_and_two_levels() {
    let mut mean = 0.0;
    for seed in 1..=4 {
        let plates = solved(seed, 32);
        let share = land_share(&plates);
        assert!((0.18..0.45).contains(&share), "seed {seed}: {share}");
        mean += share / 4.0;
        // Heights are frequent on land near zero and on ocean floors, and rare between.
        let between = |low: f64, high: f64| {
            let count =
                plates.rock.base_m.iter().zip(&plates.rock.uplift_m).filter(|(b, u)| (low..high).contains(&(*b + *u)));
            count.count() as f64 / plates.rock.base_m.len() as f64 / (high - low)
        };
        let (floor, slope, land) = (between(-5500.0, -3500.0), between(-2500.0, -1000.0), between(-200.0, 900.0));
        assert!(floor > 1.8 * slope && land > 1.8 * slope, "seed {seed}: {floor} {slope} {land}");
    }
    assert!((0.24..0.38).contains(&mean), "{mean}");
}

#[test]
fn the_layout_does_not_depend_on_the_grid() {
    let layout = Layout::new(&Params::default(), 3);
    let coarse = solved(3, 16);
    let fine = solved(3, 48);
    assert_eq!(coarse.layout, layout);
    assert_eq!(fine.layout, layout);
    for (cell, dir) in Cells::of(16).dirs.iter().enumerate() {
        assert_eq!(layout.crusts(&Params::default(), &[*dir])[0].base_m.to_bits(), coarse.rock.base_m[cell].to_bits());
    }
}

#[test]
fn a_finer_crust_keeps_the_heights_and_makes_coasts_longer() {
    let plates = solved(5, 48);
    let (coarse, fine) = (&plates.rock, plates.rock.finer(&plates.layout));
    let surface_m = |rock: &Rock| -> Vec<f64> { rock.base_m.iter().zip(&rock.uplift_m).map(|(b, u)| b + u).collect() };
    let [coarse_m, fine_m] = [coarse, &fine].map(surface_m);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    assert_eq!((fine.side, fine_m.len()), (96, 4 * coarse_m.len()));
    assert!((mean(&fine_m) - mean(&coarse_m)).abs() < 60.0, "{} {}", mean(&fine_m), mean(&coarse_m));
    // A smooth coast crosses twice as many cells on a grid of twice the side; a ragged one more.
    let coast = |side: usize, heights_m: &[f64]| {
        let cells = Cells::of(side);
        let on_coast = |cell: &usize| {
            heights_m[*cell] > 0.0 && cells.around(*cell).iter().any(|&other| heights_m[other as usize] <= 0.0)
        };
        (0..heights_m.len()).filter(on_coast).count() as f64
    };
    let ratio = coast(96, &fine_m) / coast(48, &coarse_m);
    assert!(ratio > 2.1, "{ratio}");
}

#[test]
fn ocean_floors_sink_with_the_square_root_of_their_age() {
    let params = Params::default();
    let depth = |myr: f64| floor_depth(&params, myr) - params.ridge_m;
    assert!((depth(40.0) / depth(10.0) - 2.0).abs() < 1e-9);
    assert_eq!(floor_depth(&params, 150.0), params.ocean_m);
}

#[test]
fn belts_lie_along_boundaries_and_folds_are_tangents() {
    let plates = solved(2, 48);
    let dirs = &Cells::of(48).dirs;
    let mut high = 0;
    for (cell, dir) in dirs.iter().enumerate() {
        let (fold, folded) = plates.folds[cell];
        assert!(fold.dot(*dir).abs() < 1e-9 && (fold.length() - 1.0).abs() < 1e-9 && (0.0..=1.0).contains(&folded));
        high += usize::from(plates.rock.uplift_m[cell] > 3000.0);
    }
    let share = high as f64 / dirs.len() as f64;
    assert!((0.002..0.12).contains(&share), "{share}");
}

#[test]
fn equal_bits_on_any_number_of_threads_and_an_end_when_told() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solved(5, 16))
    };
    let (one, three) = (on(1), on(3));
    assert!(one.rock.base_m.iter().zip(&three.rock.base_m).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(one.plate, three.plate);
    assert!(Plates::solve(&Params::default(), 1, 16, &|| false).is_none());
}

#[test]
fn extreme_parameters_give_finite_heights() {
    for (count, continents) in [(2, 0.0), (60, 1.0), (7, 0.5)] {
        let params = Params { count, continents, size_variation: 1.0, raggedness: 2.0, ..Params::default() };
        let plates = Plates::solve(&params, 9, 12, &|| true).unwrap();
        assert!(plates.rock.base_m.iter().chain(&plates.rock.uplift_m).all(|m| m.is_finite() && m.abs() < 60_000.0));
    }
}

/// The entry that leaves the plate of most land as it is, and that plate.
fn entry_of_land(layout: &Layout) -> PlateByHand {
    let land = |plate: &usize| spread(2000).filter(|dir| layout.plate_under(*dir) == *plate).count();
    let continental = (0..layout.plates.len()).filter(|&plate| layout.plates[plate].is_continental);
    layout.entry(continental.max_by_key(land).unwrap()).unwrap()
}

fn with(entry: &PlateByHand) -> (Params, Layout) {
    let params = Params { by_hand: vec![entry.clone()], ..Params::default() };
    let layout = Layout::new(&params, 3);
    (params, layout)
}

fn heights_m(layout: &Layout, params: &Params, dirs: &[DVec3]) -> Vec<f64> {
    layout.crusts(params, dirs).iter().map(|crust| crust.base_m + crust.uplift_m).collect()
}

#[test]
fn an_entry_as_it_was_laid_out_changes_next_to_nothing_and_one_of_no_plate_nothing() {
    let (params, layout) = (Params::default(), Layout::new(&Params::default(), 3));
    let dirs: Vec<DVec3> = spread(4000).collect();
    let before = heights_m(&layout, &params, &dirs);
    let (edited, same) = with(&entry_of_land(&layout));
    let after = heights_m(&same, &edited, &dirs);
    let far = before.iter().zip(&after).filter(|(a, b)| (*a - *b).abs() > 60.0).count();
    assert!(far < dirs.len() / 50, "{far}");
    let (_, none) = with(&PlateByHand { plate: 59, kind: PlateKind::Oceanic, ..PlateByHand::default() });
    assert_eq!(none, layout);
}

#[test]
fn a_plate_that_is_dragged_takes_its_continents_along_and_leaves_others_where_they_are() {
    let (params, layout) = (Params::default(), Layout::new(&Params::default(), 3));
    let entry = entry_of_land(&layout);
    let id = entry.plate as usize;
    let center = layout.plates[id].center;
    let (east, north) = east_north(center);
    let from = (center + east * 0.2).normalize();
    let to = (center + east * 0.35 + north * 0.3).normalize();
    // In two steps, the second from where the first ended: as a pointer drags it.
    let half = from.lerp(to, 0.5).normalize();
    let first = layout.dragged(&entry, from, half).unwrap();
    let (_, halfway) = with(&first);
    let moved = halfway.dragged(&first, half, to).unwrap();
    let (edited, after) = with(&moved);
    // As laid out the plate is at home.
    let carry = |dir: DVec3| after.moved_dir(id, dir);
    assert!(carry(from).distance(to) < 3e-4, "{} {}", carry(from), to);
    // Well inside the plate, before and after.
    let inside = |layout: &Layout, dir: DVec3| {
        let (east, north) = east_north(dir);
        [east, -east, north, -north].iter().all(|way| layout.plate_under((dir + *way * 0.2).normalize()) == id)
    };
    let (mut there, mut same) = (0, 0);
    for dir in spread(6000).filter(|dir| inside(&layout, *dir) && inside(&after, carry(*dir))) {
        let land = heights_m(&layout, &params, &[dir])[0] > 0.0;
        there += 1;
        same += usize::from(land == (heights_m(&after, &edited, &[carry(dir)])[0] > 0.0));
    }
    assert!(there > 100 && same * 100 > there * 88, "{same} of {there}");
    // Far away only the age of ocean floors changes.
    let far: Vec<DVec3> = spread(6000).filter(|dir| dir.dot(center) < -0.9 && dir.dot(to) < -0.9).collect();
    let land = |layout, params| -> Vec<bool> {
        heights_m(layout, params, &far).iter().map(|height_m| *height_m > 0.0).collect()
    };
    let (before, after) = (land(&layout, &params), land(&after, &edited));
    let differ = before.iter().zip(&after).filter(|(before, after)| before != after).count();
    assert!(far.len() > 100 && differ * 50 < far.len(), "{differ} of {}", far.len());
}

#[test]
fn a_plate_becomes_an_ocean_or_a_continent_and_moves_as_it_is_told() {
    let layout = Layout::new(&Params::default(), 3);
    let entry = entry_of_land(&layout);
    let land = |layout: &Layout, params: &Params, plate: u32| {
        let dirs: Vec<DVec3> = spread(4000).filter(|dir| layout.plate_under(*dir) == plate as usize).collect();
        let heights_m = heights_m(layout, params, &dirs);
        heights_m.iter().filter(|height_m| **height_m > 0.0).count() as f64 / heights_m.len() as f64
    };
    let (params, drowned) = with(&PlateByHand { kind: PlateKind::Oceanic, ..entry.clone() });
    assert!(land(&layout, &Params::default(), entry.plate) > 0.25 && land(&drowned, &params, entry.plate) < 0.1);
    let bare = (0..layout.plates.len()).filter(|&plate| !layout.plates[plate].is_continental);
    let size = |plate: &usize| spread(2000).filter(|dir| layout.plate_under(*dir) == *plate).count();
    let bare = layout.entry(bare.max_by_key(size).unwrap()).unwrap();
    let (params, risen) = with(&PlateByHand { kind: PlateKind::Continental, ..bare.clone() });
    let (before, after) = (land(&layout, &Params::default(), bare.plate), land(&risen, &params, bare.plate));
    assert!(after > before + 0.15, "{before} {after}");
    // To the east at 80 mm a year, which is what an entry says again.
    let (_, east) = with(&PlateByHand { heading_deg: 90.0, drift_mm_yr: 80.0, ..entry.clone() });
    let plate = &east.plates[entry.plate as usize];
    let motion = plate.pole.cross(plate.center) * EARTH_KM;
    let (to_east, to_north) = east_north(plate.center);
    assert!((motion.dot(to_east) - 80.0).abs() < 1e-9 && motion.dot(to_north).abs() < 1e-9);
    assert_eq!(east.entry(entry.plate as usize), Some(entry.clone()), "as it was laid out");
    let (_, grown) = with(&PlateByHand { growth: 0.6, ..entry.clone() });
    let size = |layout: &Layout| spread(4000).filter(|dir| layout.plate_under(*dir) == entry.plate as usize).count();
    assert!(size(&grown) as f64 > 1.15 * size(&layout) as f64);
}
