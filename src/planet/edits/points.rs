//! The points of a ground edit. A file writes each as `(latitude, longitude)` in degrees; with a height in metres as a
//! third number where the tool reads one; with a width and a strength as fourth and fifth where the line tapers.

use crate::planet::param::{Form, Look, ParamPath, Params, PartType, Visit};
use crate::sphere::LatLon;
use glam::DVec3;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A point of an edit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EditPoint {
    /// Degrees north of the equator.
    pub latitude_deg: f64,
    /// Degrees east of the prime meridian.
    pub longitude_deg: f64,
    /// Height of the ground that a road is to have here; 0 for other tools.
    pub height_m: f64,
    /// Radius of the edit here, as a share of its radius.
    pub width: f64,
    /// Share of its effect that the edit has here.
    pub strength: f64,
}

impl Default for EditPoint {
    fn default() -> Self {
        Self { latitude_deg: 0.0, longitude_deg: 0.0, height_m: 0.0, width: 1.0, strength: 1.0 }
    }
}

impl EditPoint {
    /// The point under a direction. Places are rounded to 1e-7 degrees, which is a centimetre on the Earth, so that
    /// they are short in files.
    pub fn under(dir_planet: DVec3) -> Self {
        let tidy = |degrees: f64| (degrees * 1e7).round() / 1e7;
        let (latitude_deg, longitude_deg) = LatLon::from_direction(dir_planet).to_degrees();
        Self { latitude_deg: tidy(latitude_deg), longitude_deg: tidy(longitude_deg), ..Self::default() }
    }

    /// The direction of the point.
    pub fn direction(&self) -> DVec3 {
        LatLon::from_degrees(self.latitude_deg, self.longitude_deg).direction()
    }
}

impl Serialize for EditPoint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = [self.latitude_deg, self.longitude_deg, self.height_m, self.width, self.strength];
        let usual = [f64::NAN, f64::NAN, 0.0, 1.0, 1.0];
        // What is as usual is left out from the end on.
        let count = 1 + (0..numbers.len()).rev().find(|i| numbers[*i] != usual[*i]).unwrap_or(0);
        let mut tuple = serializer.serialize_tuple(count)?;
        numbers.iter().take(count).try_for_each(|number| tuple.serialize_element(number))?;
        tuple.end()
    }
}

impl<'de> Deserialize<'de> for EditPoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;
        impl<'de> Visitor<'de> for Numbers {
            type Value = EditPoint;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a point: (latitude, longitude), perhaps with height, width and strength behind them")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<EditPoint, A::Error> {
                let lacking = |count| A::Error::invalid_length(count, &self);
                let latitude_deg = seq.next_element()?.ok_or_else(|| lacking(0))?;
                let longitude_deg = seq.next_element()?.ok_or_else(|| lacking(1))?;
                let height_m = seq.next_element()?.unwrap_or(0.0);
                let width = seq.next_element()?.unwrap_or(1.0);
                let strength = seq.next_element()?.unwrap_or(1.0);
                Ok(EditPoint { latitude_deg, longitude_deg, height_m, width, strength })
            }
        }
        deserializer.deserialize_tuple(5, Numbers)
    }
}

/// The points of an edit, in order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct EditPoints(pub Vec<EditPoint>);

impl FromIterator<EditPoint> for EditPoints {
    fn from_iter<T: IntoIterator<Item = EditPoint>>(points: T) -> Self {
        Self(points.into_iter().collect())
    }
}

/// The points are one value without a slider: they are set on the planet, `validate` checks them.
impl Params for EditPoints {
    fn each_param(&mut self, _path: &mut ParamPath, _visit: &mut Visit<'_>) {}
    fn each_value(&self, _path: &mut ParamPath, _look: &mut Look<'_>) {}
}

impl PartType for EditPoints {
    const FORM: Form = Form::List;

    fn every_kind() -> Vec<Self> {
        vec![Self(vec![EditPoint { latitude_deg: 10.0, longitude_deg: 20.0, ..EditPoint::default() }])]
    }
}
