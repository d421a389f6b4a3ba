//! `tellus rivers`: the rivers, lakes and basins of a planet as GeoJSON (RFC 7946).
//!
//! Rivers are LineStrings from source to mouth; one that crosses the antimeridian is a MultiLineString. The arrays of
//! numbers in the properties have the shape of the coordinates. Lakes are MultiPoints, basins are Points at their
//! mouths.

use super::geojson::{self, Place, feature, lon_lat_deg, parts, rounded, shaped};
use super::{Failure, args, load_as_source, maps, outputs};
use crate::planet::Planet;
use crate::planet::file::write_atomically;
use crate::sphere::LatLon;
use crate::terrain::{Basin, Course, CoursePoint, Lake, Mouth};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Least discharge unless it is given, in m³/s, on a planet of the radius of the Earth.
const DEFAULT_M3_S: f64 = 100.0;
const EARTH_KM: f64 = 6371.0;

/// Write rivers, lakes and basins as GeoJSON
#[derive(clap::Args)]
pub(super) struct Args {
    /// The preset; it must have a structure
    #[arg(value_name = "FILE.ron")]
    file: PathBuf,
    /// The file to write: LineStrings from source to mouth with height_m (of the bed), width_m and discharge_m3_s at
    /// each point, MultiPoints of lakes, Points at the mouths of basins
    #[arg(short, long, value_name = "OUT.geojson")]
    output: PathBuf,
    /// Least discharge of a river or basin in cubic metres a second, at its mouth; each river begins where it carries
    /// so much [default: 100 on a planet of the Earth's size, on others by their area]
    #[arg(long, value_name = "M3S", value_parser = args::discharge)]
    min_discharge: Option<f64>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    outputs::check_ending(&args.output, geojson::ENDINGS)?;
    let (planet, sources) = load_as_source(&args.file)?;
    outputs::check_files(&sources, &[&args.output])?;
    if planet.structure.is_none() {
        return Err(format!("{}: {} has no structure, so it has no rivers", args.file.display(), planet.name).into());
    }
    let least_m3_s = args.min_discharge.unwrap_or_else(|| default_m3_s(&planet));
    let terrain = maps::terrain(planet)?;
    let rivers = terrain.rivers(least_m3_s);
    let courses = rivers.courses.iter().map(course);
    let features = courses.chain(rivers.lakes.iter().map(lake)).chain(rivers.basins.iter().map(basin));
    let text = geojson::collection(features)?;
    write_atomically(&args.output, text.as_bytes()).map_err(|error| format!("{}: {error}", args.output.display()))?;
    Ok(())
}

fn default_m3_s(planet: &Planet) -> f64 {
    let size = planet.radius_km / EARTH_KM;
    DEFAULT_M3_S * size * size
}

impl Place for CoursePoint {
    fn place(&self) -> LatLon {
        self.place
    }

    fn towards(&self, other: &Self, share: f64, place: LatLon) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * share;
        Self {
            place,
            height_m: between(self.height_m, other.height_m),
            width_m: between(self.width_m, other.width_m),
            discharge_m3_s: between(self.discharge_m3_s, other.discharge_m3_s),
        }
    }
}

fn course(course: &Course) -> Value {
    let parts = parts(&course.points);
    let number = |value: fn(&CoursePoint) -> f64| shaped(&parts, |point| json!(rounded(value(point), 1e3)));
    let (into, into_id) = match course.mouth {
        Mouth::Sea => ("sea", Value::Null),
        Mouth::Lake(id) => ("lake", json!(id)),
        Mouth::River(id) => ("river", json!(id)),
        Mouth::Ground => ("ground", Value::Null),
    };
    let properties = json!({
        "kind": "river",
        "id": course.id,
        "length_km": rounded(course.length_km, 1e3),
        "mouth_discharge_m3_s": course.points.last().map(|point| rounded(point.discharge_m3_s, 1e3)),
        "into": into,
        "into_id": into_id,
        "height_m": number(|point| point.height_m),
        "width_m": number(|point| point.width_m),
        "discharge_m3_s": number(|point| point.discharge_m3_s),
    });
    feature(&geojson::line(&parts), &properties)
}

fn lake(lake: &Lake) -> Value {
    let coordinates: Vec<[f64; 2]> = lake.cells.iter().map(|&cell| lon_lat_deg(cell)).collect();
    let properties = json!({
        "kind": "lake",
        "id": lake.id,
        "level_m": rounded(lake.level_m, 1e3),
        "area_km2": rounded(lake.area_km2, 1e3),
        "endorheic": lake.is_endorheic(),
        "outlet": lake.outlet.map(lon_lat_deg),
    });
    feature(&json!({ "type": "MultiPoint", "coordinates": coordinates }), &properties)
}

fn basin(basin: &Basin) -> Value {
    let properties = json!({
        "kind": "basin",
        "id": basin.id,
        "area_km2": rounded(basin.area_km2, 1e3),
        "discharge_m3_s": rounded(basin.discharge_m3_s, 1e3),
        "endorheic": basin.is_endorheic,
    });
    feature(&json!({ "type": "Point", "coordinates": lon_lat_deg(basin.mouth) }), &properties)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(places: &[(f64, f64)]) -> Vec<CoursePoint> {
        let point = |(k, &(lat, lon)): (usize, &(f64, f64))| CoursePoint {
            place: LatLon::from_degrees(lat, lon),
            height_m: 100.0 - k as f64,
            width_m: 10.0,
            discharge_m3_s: k as f64,
        };
        places.iter().enumerate().map(point).collect()
    }

    #[test]
    fn lines_are_split_at_the_antimeridian() {
        assert_eq!(parts(&line(&[(1.0, 5.0), (2.0, -5.0)])).len(), 1);
        let parts = parts(&line(&[(10.0, 178.0), (10.0, 179.0), (10.0, -179.0), (10.0, 179.5)]));
        let shown: Vec<Vec<[f64; 2]>> =
            parts.iter().map(|part| part.iter().map(|point| lon_lat_deg(point.place)).collect()).collect();
        assert_eq!(shown.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3, 2]);
        assert_eq!([shown[0][2][0], shown[1][0][0]], [180.0, -180.0]);
        assert_eq!([shown[1][2][0], shown[2][0][0]], [-180.0, 180.0]);
        assert!(shown[0][2][1] == shown[1][0][1] && (shown[0][2][1] - 10.0).abs() < 0.01, "{shown:?}");
        assert!((parts[1][0].height_m - 98.5).abs() < 0.01 && parts[0][2] != parts[1][0]);
        let found = course(&Course { id: 7, points: parts.concat(), mouth: Mouth::Sea, length_km: 1.0 });
        assert_eq!(found["geometry"]["type"], "MultiLineString");
        assert_eq!(found["properties"]["height_m"].as_array().map(Vec::len), Some(3));
    }
}
