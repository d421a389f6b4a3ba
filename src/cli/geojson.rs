//! GeoJSON (RFC 7946): features, and lines that cross the antimeridian, which are split there (section 3.1.9).

use crate::sphere::LatLon;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::fmt::Write as _;

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
    let mut text = "{\"type\":\"FeatureCollection\",\"features\":[".to_owned();
    for (k, feature) in features.enumerate() {
        let comma = if k == 0 { "" } else { "," };
        write!(text, "{comma}\n{feature}").map_err(|error| error.to_string())?;
    }
    text.push_str("\n]}\n");
    Ok(text)
}

pub(super) fn feature(geometry: &Value, properties: &Value) -> Value {
    json!({ "type": "Feature", "geometry": geometry, "properties": properties })
}

/// The geometry of a line in parts.
pub(super) fn line<P: Place>(parts: &[Vec<P>]) -> Value {
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

/// Cuts a line where it crosses the antimeridian. Both parts end there.
pub(super) fn parts<P: Place>(points: &[P]) -> Vec<Vec<P>> {
    let mut parts = vec![Vec::new()];
    let mut last: Option<P> = None;
    for &point in points {
        if let Some(before) = last.filter(|before| (point.place().lon_rad - before.place().lon_rad).abs() > PI) {
            let [end, start] = crossing(&before, &point);
            parts.last_mut().into_iter().for_each(|part| part.push(end));
            parts.push(vec![start]);
        }
        parts.last_mut().into_iter().for_each(|part| part.push(point));
        last = Some(point);
    }
    parts
}

/// The point between two others that lies on the antimeridian, as each of them would write it.
fn crossing<P: Place>(a: &P, b: &P) -> [P; 2] {
    let (from, to) = (a.place().direction(), b.place().direction());
    let share = if from.y == to.y { 0.5 } else { (from.y / (from.y - to.y)).clamp(0.0, 1.0) };
    let lat_rad = LatLon::from_direction(from.lerp(to, share)).lat_rad;
    [a, b].map(|near| a.towards(b, share, LatLon { lat_rad, lon_rad: PI.copysign(near.place().lon_rad) }))
}
