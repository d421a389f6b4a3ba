//! GeoJSON (RFC 7946): features, and lines that cross the antimeridian, which are split there (section 3.1.9).

use crate::sphere::LatLon;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::fmt::Display;
use std::io::{self, Write};

/// The endings of its files' names.
pub(super) const ENDINGS: &[&str] = &["geojson", "json"];

/// A point of a line.
pub(super) trait Place: Copy {
    fn place(&self) -> LatLon;
    /// The point at `share` of the way to another, at a place.
    fn towards(&self, other: &Self, share: f64, place: LatLon) -> Self;
}

impl Place for LatLon {
    fn place(&self) -> LatLon {
        *self
    }

    fn towards(&self, _: &Self, _: f64, place: LatLon) -> Self {
        place
    }
}

/// The text of a collection, one feature a line.
pub(super) fn collection(features: impl Iterator<Item = Value>) -> Result<String, String> {
    let mut bytes = Vec::new();
    write_collection(&mut bytes, features).map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// Writes a collection, one feature a line.
pub(super) fn write_collection(out: &mut impl Write, features: impl Iterator<Item = impl Display>) -> io::Result<()> {
    out.write_all(b"{\"type\":\"FeatureCollection\",\"features\":[")?;
    for (k, feature) in features.enumerate() {
        let comma = if k == 0 { "" } else { "," };
        write!(out, "{comma}\n{feature}")?;
    }
    out.write_all(b"\n]}\n")
}

pub(super) fn feature(geometry: &Value, properties: &Value) -> Value {
    json!({ "type": "Feature", "geometry": geometry, "properties": properties })
}

/// The geometry of a line in parts; null if it is shorter than digits tell.
pub(super) fn line<P: Place>(parts: &[Vec<P>]) -> Value {
    if parts.is_empty() {
        return Value::Null;
    }
    let kind = if parts.len() == 1 { "LineString" } else { "MultiLineString" };
    json!({ "type": kind, "coordinates": shaped(parts, |point| json!(lon_lat_deg(point.place()))) })
}

/// A value for each point: an array, or one for each part if there are several.
pub(super) fn shaped<P>(parts: &[Vec<P>], value: impl Fn(&P) -> Value) -> Value {
    let mut arrays: Vec<Value> = parts.iter().map(|part| part.iter().map(&value).collect()).collect();
    if arrays.len() == 1 { arrays.swap_remove(0) } else { Value::Array(arrays) }
}

/// Longitude and latitude in degrees: the order of GeoJSON. Six digits are a tenth of a metre on the Earth.
pub(super) fn lon_lat_deg(place: LatLon) -> [f64; 2] {
    let (lat, lon) = place.to_degrees();
    [rounded(lon, 1e6), rounded(lat, 1e6)]
}

pub(super) fn rounded(value: f64, per_unit: f64) -> f64 {
    (value * per_unit).round() / per_unit
}

/// Cuts a line where it crosses the antimeridian. Both parts end there. Points that are written as the one before are
/// left out, and so is a part of which one point is left: a line that only touches the antimeridian has none beyond it.
pub(super) fn parts<P: Place>(points: &[P]) -> Vec<Vec<P>> {
    let mut parts: Vec<Vec<P>> = vec![Vec::new()];
    let mut last: Option<P> = None;
    let add = |parts: &mut Vec<Vec<P>>, point: P| {
        let Some(part) = parts.last_mut() else { return };
        if part.last().is_none_or(|before| lon_lat_deg(before.place()) != lon_lat_deg(point.place())) {
            part.push(point);
        }
    };
    for &point in points {
        if let Some(before) = last.filter(|before| (point.place().lon_rad - before.place().lon_rad).abs() > PI) {
            let [end, start] = crossing(&before, &point);
            add(&mut parts, end);
            parts.push(vec![start]);
        }
        add(&mut parts, point);
        last = Some(point);
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// The point between two others that lies on the antimeridian, as each of them would write it.
fn crossing<P: Place>(a: &P, b: &P) -> [P; 2] {
    let (from, to) = (a.place().direction(), b.place().direction());
    let share = if from.y == to.y { 0.5 } else { (from.y / (from.y - to.y)).clamp(0.0, 1.0) };
    let lat_rad = LatLon::from_direction(from.lerp(to, share)).lat_rad;
    [a, b].map(|near| a.towards(b, share, LatLon { lat_rad, lon_rad: PI.copysign(near.place().lon_rad) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(places: &[(f64, f64)]) -> Vec<Vec<[f64; 2]>> {
        let line: Vec<LatLon> = places.iter().map(|&(lat, lon)| LatLon::from_degrees(lat, lon)).collect();
        parts(&line).into_iter().map(|part| part.into_iter().map(lon_lat_deg).collect()).collect()
    }

    #[test]
    fn parts_have_a_length_and_no_point_twice() {
        // On the antimeridian itself, under both of its names, and next to it.
        for middle in [180.0, -180.0, 179.999_999_9, -179.999_999_9] {
            for end in [179.0, -179.0] {
                let parts = shown(&[(1.0, 179.0), (2.0, middle), (2.0, middle), (3.0, end)]);
                assert!(!parts.is_empty(), "{middle} {end}");
                for part in &parts {
                    assert!(
                        part.len() > 1 && part.windows(2).all(|pair| pair[0] != pair[1]),
                        "{middle} {end}: {parts:?}"
                    );
                    assert!(part.windows(2).all(|pair| (pair[0][0] - pair[1][0]).abs() < 180.0), "{parts:?}");
                }
                assert_eq!(
                    [parts[0][0], parts[parts.len() - 1][parts[parts.len() - 1].len() - 1]],
                    [[179.0, 1.0], [end, 3.0]]
                );
            }
        }
        assert_eq!(shown(&[(1.0, 5.0), (1.0, 5.000_000_01)]), Vec::<Vec<[f64; 2]>>::new());
        assert_eq!(line::<LatLon>(&[]), Value::Null);
    }
}
