//! Images of edits by symmetry, and lines that taper.

use crate::sculpt::{at, beside, edit, planet, terrain};
use crate::stamp::HILLS;
use glam::DVec3;
use std::sync::Arc;
use tellus::planet::Planet;
use tellus::planet::edits::{
    Crater, EditPoint, Flatten, GroundEdit, Hydraulic, MAX_ALL_POINTS, MAX_EDITS, PictureStamp, Raise, Tool,
};
use tellus::planet::file::MAX_FILE_BYTES;
use tellus::terrain::Terrain;

/// Without noise, an image has the ground of its edit, at a place that is turned and mirrored as it is.
#[test]
fn images_of_an_edit_are_turned_around_the_axis_and_mirrored_at_the_equator() {
    let turned = |dir: DVec3, degrees: f64, mirrored: bool| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let z = if mirrored { -dir.z } else { dir.z };
        DVec3::new(dir.x * cos - dir.y * sin, dir.x * sin + dir.y * cos, z)
    };
    let mut sides = 0;
    for tool in Tool::all() {
        if tool.is_paint() || matches!(tool, Tool::Roughen(_)) {
            continue;
        }
        let mut points = vec![at(24.0, 10.0)];
        if !tool.is_stamp() {
            points.extend([at(30.0, 14.0), at(31.0, 22.0), at(27.0, 26.0), at(24.0, 27.0), at(22.0, 31.0)]);
        }
        let tool = match tool {
            Tool::Picture(stamp) => {
                Tool::Picture(PictureStamp { file: HILLS.to_owned().into(), turn_deg: 25.0, ..stamp })
            }
            Tool::Flatten(flatten) => Tool::Flatten(Flatten { height_m: 300.0, ..flatten }),
            tool => tool,
        };
        if matches!(tool, Tool::Road(_)) {
            points.iter_mut().for_each(|point| point.height_m = 250.0);
        }
        let copies = if tool.is_stamp() { 3 } else { 1 };
        let plain = GroundEdit { raggedness: 0.0, copies, spread_km: 50.0, smallest: 0.7, ..edit(tool, 40.0, &points) };
        let alone = terrain(&planet(0.0, vec![plain.clone()]));
        let images = terrain(&planet(0.0, vec![GroundEdit { turns: 3, mirrored: true, ..plain.clone() }]));
        let mut changed = 0;
        for (point, away_km) in points.iter().flat_map(|point| (0..9).map(move |k| (point, 3.0 + 5.0 * f64::from(k)))) {
            for heading_deg in [0.0, 70.0, 160.0, 250.0, 300.0] {
                let dir = beside(point, heading_deg, away_km);
                let wanted_m = alone.height_m(dir);
                changed += u32::from(wanted_m != 0.0);
                assert_eq!(images.height_m(dir).to_bits(), wanted_m.to_bits(), "{plain:?}");
                for (degrees, mirrored) in [(120.0, false), (240.0, false), (0.0, true), (120.0, true), (240.0, true)] {
                    let found_m = images.height_m(turned(dir, degrees, mirrored));
                    // Of two arcs that are as near, rounding may choose either; lines with sides tell them apart.
                    assert!((found_m - wanted_m).abs() < 5e-3, "{plain:?} {degrees} {mirrored}: {found_m} {wanted_m}");
                }
            }
        }
        // Ground that edits read is level here.
        assert!(changed > 0 || plain.tool.reads_ground() || matches!(plain.tool, Tool::Terrace(_)), "{plain:?}");
        sides += u32::from(matches!(plain.tool, Tool::Fault(_) | Tool::Coast(_)));
    }
    assert_eq!(sides, 2);

    let too_many = GroundEdit { turns: 12, mirrored: true, ..edit(Tool::default(), 10.0, &[at(1.0, 2.0); 50]) };
    let why = Terrain::try_new(Arc::new(planet(0.0, vec![too_many]))).unwrap_err().to_string();
    assert!(why.contains("24 images of 50 points") && why.contains("at most 41"), "{why}");
}

#[test]
fn a_line_tapers_in_width_and_in_strength_and_files_keep_both() {
    let (from, mut to) = (at(0.0, 0.0), at(0.0, 8.0));
    (to.width, to.strength) = (0.5, 0.5);
    let raise = edit(Tool::Raise(Raise { amount_m: 700.0 }), 40.0, &[from, to]);
    let planet = planet(0.0, vec![GroundEdit { softness: 0.8, ..raise }]);
    let terrain = terrain(&planet);
    // The distance in widths of the place, the share of the weight there.
    for (lon_deg, width) in [(0.0, 1.0), (4.0, 0.75), (8.0, 0.5)] {
        for (share, weight) in [(0.0, 1.0), (0.2, 1.0), (0.6, 0.5), (1.0, 0.0)] {
            let found_m = terrain.height_m(beside(&at(0.0, lon_deg), 0.0, 40.0 * width * share));
            let wanted_m = 700.0 * width * weight;
            // The share of the length is that of the chord.
            assert!((found_m - wanted_m).abs() < 0.2, "{lon_deg} {share}: {found_m} {wanted_m}");
        }
    }
    let text = planet.to_text();
    assert!(text.contains("(0, 0), (0, 8, 0, 0.5, 0.5)") || text.contains("(0.0, 8.0, 0.0, 0.5, 0.5)"), "{text}");
    assert!(Planet::from_text("p.ron", &text).unwrap().edits == planet.edits);
    for (points, told) in [
        ("(1, 2, 0, 9)", "the width 9 is out of range; use 0.02 to 4"),
        ("(1, 2, 0, 1, 1.5)", "the strength 1.5 is out of range; use 0 to 1"),
    ] {
        let wrong = text.replace("(0, 8, 0, 0.5, 0.5)", points).replace("(0.0, 8.0, 0.0, 0.5, 0.5)", points);
        let why = Planet::from_text("p.ron", &wrong).unwrap_err().to_string();
        assert!(why.contains(told), "{why}");
    }
}

/// What may be saved can be opened again.
#[test]
fn the_file_of_all_edits_that_a_planet_may_have_is_not_too_long() {
    let point = EditPoint {
        latitude_deg: -12.345_678_9,
        longitude_deg: -123.456_789_1,
        height_m: 0.0,
        width: 0.415,
        strength: 0.415,
    };
    let long = |points: usize| GroundEdit {
        name: "A name as long as names of edits may be, or near".to_owned(),
        points: vec![point; points].into_iter().collect(),
        raggedness: 0.123_456_789,
        ..GroundEdit::of(Tool::Hydraulic(Hydraulic::default()))
    };
    let count = MAX_ALL_POINTS / MAX_EDITS;
    let mut planet = planet(0.0, vec![long(count); MAX_EDITS]);
    assert!(tellus::planet::validate::problems(&planet).is_empty());
    let length = planet.to_text().len() as u64;
    assert!(length < MAX_FILE_BYTES && length > MAX_FILE_BYTES / 3, "{length}");
    planet.edits.get_mut(0).unwrap().points.0.push(point);
    let (path, why) = tellus::planet::validate::problems(&planet).remove(0);
    assert!(path.to_string() == "edits" && why.contains("500001 points of all edits are too many"), "{why}");
    // Few points of many copies.
    let crater = GroundEdit { copies: 1000, ..edit(Tool::Crater(Crater::default()), 10.0, &[at(1.0, 2.0); 4]) };
    let why = Terrain::try_new(Arc::new(crate::sculpt::planet(0.0, vec![crater; 251]))).unwrap_err().to_string();
    assert!(why.contains("1004000 points of all edits with copies and images are too many"), "{why}");
}
