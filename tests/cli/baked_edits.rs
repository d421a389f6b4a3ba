//! Ground edits baked into a height picture, through the library.

use std::path::Path;
use std::sync::Arc;
use tellus::bake::{BakeError, EditBake};
use tellus::planet::edits::{
    Crater, EditPoint, EditPoints, Flatten, GroundEdit, MaskPaint, MoisturePaint, Raise, Ridge, Tool, Volcano,
};
use tellus::planet::{Fbm, Layer, Planet, Shape, Water};
use tellus::sphere::{LatLon, geo};
use tellus::terrain::Terrain;

fn edit(name: &str, tool: Tool, radius_km: f64, points: &[(f64, f64)]) -> GroundEdit {
    let point = |(lat_deg, lon_deg): &(f64, f64)| EditPoint {
        latitude_deg: *lat_deg,
        longitude_deg: *lon_deg,
        ..EditPoint::default()
    };
    let points = EditPoints(points.iter().map(point).collect());
    GroundEdit { name: name.to_owned(), radius_km, points, ..GroundEdit::of(tool) }
}

/// A planet with biome relief and edits, some of which are baked: those whose names begin with `b`.
fn planet() -> Arc<Planet> {
    let layer = Layer {
        amplitude_m: 900.0,
        shape: Shape::Fbm(Fbm { wavelength_km: 300.0, octaves: 10, ..Fbm::default() }),
        ..Layer::default()
    };
    let mut planet = Planet {
        radius_km: 1000.0,
        layers: vec![layer],
        water: Some(Water { level_m: -50.0, ..Water::default() }),
        edits: [
            edit("b raise", Tool::Raise(Raise { amount_m: 700.0 }), 30.0, &[(20.0, 30.0), (21.0, 32.0), (20.0, 34.0)]),
            edit("stays", Tool::Flatten(Flatten { height_m: 200.0, strength: 0.5 }), 40.0, &[(20.5, 31.0)]),
            edit("b flat", Tool::Flatten(Flatten { height_m: 400.0, ..Flatten::default() }), 25.0, &[(22.0, 31.0)]),
            edit("paint", Tool::Moisture(MoisturePaint::default()), 40.0, &[(20.5, 31.0)]),
            edit("b ridge", Tool::Ridge(Ridge { height_m: 500.0 }), 20.0, &[(18.5, 30.0), (19.5, 33.0)]),
            edit("after", Tool::Flatten(Flatten { height_m: 0.0, ..Flatten::default() }), 15.0, &[(20.0, 32.0)]),
            edit("far", Tool::Raise(Raise::default()), 30.0, &[(-50.0, 100.0)]),
        ]
        .into_iter()
        .collect(),
        ..Planet::default()
    };
    planet.biomes.palette.iter_mut().for_each(|biome| biome.relief_m = 5.0);
    Arc::new(planet)
}

fn named(planet: &Planet, wanted: impl Fn(&str) -> bool) -> Vec<usize> {
    planet.edits.iter().enumerate().filter(|(_, edit)| wanted(&edit.name)).map(|(index, _)| index).collect()
}

#[test]
fn a_picture_of_edits_makes_the_ground_that_they_made() {
    let planet = planet();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hills.exr");
    let bake = EditBake::new(&planet, named(&planet, |name| name.starts_with('b') || name == "paint")).unwrap();
    assert_eq!(bake.count(), 3);
    let baked = bake.run(None, &|_| true).unwrap().unwrap();
    baked.write(&file).unwrap();
    let mut stamped = baked.replace(&planet, Path::new("hills.exr"));
    stamped.set_folder(folder.path());
    assert!(stamped.load_pictures().is_empty());
    let names: Vec<&str> = stamped.edits.iter().map(|edit| edit.name.as_str()).collect();
    assert_eq!(names, ["stays", "paint", "Baked: 3 edits", "after", "far"]);
    assert_eq!(names[baked.index()], "Baked: 3 edits");
    // The preset with its picture, as it is saved and opened again.
    assert_eq!(Planet::from_text("hills.ron", &stamped.to_text()).unwrap().edits.len(), 5);

    let [before, after] = [&planet, &Arc::new(stamped)].map(|planet| Terrain::try_new(planet.clone()).unwrap());
    let bare = Terrain::try_new(Arc::new(Planet { edits: Default::default(), ..Planet::clone(&planet) })).unwrap();
    let middle = LatLon::from_degrees(20.3, 31.8).direction();
    let (mut greatest_m, mut changed, mut same) = (0.0_f64, 0, 0);
    for dir in geo::spread(800_000).filter(|dir| dir.angle_between(middle) < 0.2) {
        let [was_m, is_m, bare_m] = [&before, &after, &bare].map(|terrain| terrain.height_m(dir));
        greatest_m = greatest_m.max((was_m - is_m).abs());
        changed += u32::from((was_m - bare_m).abs() > 100.0);
        same += u32::from(was_m == is_m);
    }
    // The edits stand some 700 m over hills; a pixel has 0.8 km, and the ridge a crease.
    assert!(changed > 200 && same > 200, "{changed} {same}");
    assert!(greatest_m < 12.0, "{greatest_m}");
    let far = LatLon::from_degrees(-50.0, 100.0).direction();
    assert_eq!(before.height_m(far).to_bits(), after.height_m(far).to_bits());

    let told = bake.compare(&baked, &file, None, &|_| true).unwrap().unwrap();
    assert!(told.rms_m > 0.0 && told.rms_m < 1.0 && told.greatest_m >= told.rms_m, "{told:?}");
    assert!(told.greatest_m < 12.0 && told.greatest_m > 0.1 * greatest_m, "{told:?} {greatest_m}");
}

#[test]
fn what_cannot_be_baked_says_why() {
    let planet = planet();
    let why = |wanted: fn(&str) -> bool| match EditBake::new(&planet, named(&planet, wanted)) {
        Err(BakeError::Asked(why)) => why,
        other => panic!("{other:?}"),
    };
    assert!(why(|name| name == "paint").contains("changes the ground"));
    assert!(why(|_| true).contains("km apart"), "{}", why(|_| true));
    let mut level = Planet::clone(&planet);
    level.edits = [edit("b", Tool::Raise(Raise { amount_m: 0.0 }), 30.0, &[(0.0, 0.0)])].into_iter().collect();
    let told = EditBake::new(&Arc::new(level), [0]).unwrap().run(None, &|_| true);
    assert!(told.is_err_and(|error| error.to_string().contains("change no height")));
    // Crater rims reach beyond the radius.
    let mut crater = Planet::clone(&planet);
    crater.edits = [edit("b", Tool::Crater(Crater::default()), 30.0, &[(0.0, 0.0)])].into_iter().collect();
    let bake = EditBake::new(&Arc::new(crater), [0, 0, 7]).unwrap();
    assert_eq!(bake.count(), 1);
    assert!(bake.pixel_m() * f64::from(bake.side_px()) > 120_000.0, "{}", bake.pixel_m());
    assert!(bake.run(None, &|_| false).unwrap().is_none());
}

#[test]
fn copies_that_a_mask_scatters_are_baked_where_they_lie() {
    let volcano = Volcano { height_m: 800.0, steepness: 0.0, caldera: 0.0, caldera_m: 0.0 };
    let scattered = GroundEdit {
        copies: 30,
        spread_km: 200.0,
        smallest: 0.8,
        mask: "Field".to_owned(),
        ..edit("cones", Tool::Volcano(volcano), 25.0, &[(20.0, 30.0)])
    };
    let stroke = edit("field", Tool::Mask(MaskPaint { mask: "Field".to_owned(), amount: 1.0 }), 90.0, &[(21.0, 33.0)]);
    for outside_mask in [false, true] {
        let edits = [GroundEdit { outside_mask, ..scattered.clone() }, stroke.clone()];
        let planet = Arc::new(Planet { edits: edits.into_iter().collect(), ..Planet::clone(&planet()) });
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("cones.exr");
        let bake = EditBake::new(&planet, [0]).unwrap();
        let baked = bake.run(None, &|_| true).unwrap().unwrap();
        baked.write(&file).unwrap();
        let mut stamped = baked.replace(&planet, &file);
        assert!(stamped.load_pictures().is_empty());
        let bare = Planet { edits: Default::default(), ..Planet::clone(&planet) };
        let [bare, before, after] =
            [Arc::new(bare), planet.clone(), Arc::new(stamped)].map(|planet| Terrain::try_new(planet).unwrap());
        let middle = LatLon::from_degrees(20.0, 30.0).direction();
        let (mut raised, mut lost) = (0, 0);
        for dir in geo::spread(200_000).filter(|dir| dir.angle_between(middle) < 0.25) {
            let [bare_m, was_m, is_m] = [&bare, &before, &after].map(|terrain| terrain.height_m(dir));
            raised += u32::from(was_m - bare_m > 200.0);
            lost += u32::from((was_m - is_m).abs() > 60.0);
        }
        assert!(raised > 100 && lost == 0, "{raised} {lost}");
    }
}
