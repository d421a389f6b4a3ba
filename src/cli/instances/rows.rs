//! Objects as rows: a table, and points.

use super::kind_and_scale;
use crate::cli::geojson::{rounded, write_collection};
use crate::life::Instance;
use crate::planet::Planet;
use crate::sphere::LatLon;
use serde_json::json;
use std::io::{self, BufWriter, Write};

/// Writes a table of comma-separated values.
pub(super) fn write_table(out: &mut impl Write, planet: &Planet, instances: &[Instance]) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let columns =
        ["id", "kind", "latitude_deg", "longitude_deg", "height_m", "turn_deg", "scale", "qx", "qy", "qz", "qw"];
    table.write_record(columns)?;
    for instance in instances {
        let (lat_deg, lon_deg) = LatLon::from_direction(instance.dir_planet).to_degrees();
        let (kind, scale) = kind_and_scale(planet, instance);
        let [qx, qy, qz, qw] = instance.local_from_form().to_array().map(|part| format!("{part:.6}"));
        table.write_record([
            instance.id.to_string().as_str(),
            kind,
            &format!("{lat_deg:.9}"),
            &format!("{lon_deg:.9}"),
            &format!("{:.3}", instance.base_m),
            &format!("{:.2}", instance.turn_rad.to_degrees()),
            &format!("{scale:.4}"),
            &qx,
            &qy,
            &qz,
            &qw,
        ])?;
    }
    table.flush()
}

/// Writes points as GeoJSON.
pub(super) fn write_points(out: &mut impl Write, planet: &Planet, instances: &[Instance]) -> io::Result<()> {
    // Names in quotes. Numbers are written without a `Value` in between, which takes three times as long.
    let kinds: Vec<String> = planet.life.iter().map(|population| json!(population.name).to_string()).collect();
    let features = instances.iter().map(|instance| {
        let (lat_deg, lon_deg) = LatLon::from_direction(instance.dir_planet).to_degrees();
        let [lat_deg, lon_deg] = [lat_deg, lon_deg].map(|angle_deg| rounded(angle_deg, 1e9));
        let (_, scale) = kind_and_scale(planet, instance);
        let [height_m, turn_deg, scale] =
            [(instance.base_m, 1e3), (instance.turn_rad.to_degrees(), 1e2), (scale, 1e4)]
                .map(|(value, per_unit)| rounded(value, per_unit));
        let [qx, qy, qz, qw] = instance.local_from_form().to_array().map(|part| rounded(part, 1e6));
        let (kind, id) = (&kinds[usize::from(instance.population)], instance.id);
        // A number of JSON does not hold all bits of an id.
        format!(
            "{{\"type\":\"Feature\",\"geometry\":{{\"type\":\"Point\",\"coordinates\":[{lon_deg},{lat_deg},{height_m}]}},\
            \"properties\":{{\"id\":\"{id}\",\"kind\":{kind},\"turn_deg\":{turn_deg},\"scale\":{scale},\
            \"qx\":{qx},\"qy\":{qy},\"qz\":{qz},\"qw\":{qw}}}}}"
        )
    });
    let mut out = BufWriter::new(out);
    write_collection(&mut out, features)?;
    out.flush()
}
