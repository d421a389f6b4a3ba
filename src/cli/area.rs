//! Arguments that bakes share: a region, and how much of a structure is in it.

use super::{args, tell};
use crate::bake::{Detail, Region};
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// A region, or none.
#[derive(clap::Args)]
pub(super) struct RegionArgs {
    #[arg(
        long,
        help = "Latitude of the centre of a region in degrees, north positive [default: the whole globe]",
        value_name = "DEG",
        value_parser = args::latitude,
        requires_all = ["lon", "km"]
    )]
    lat: Option<f64>,
    #[arg(
        long,
        help = "Longitude of the centre of a region in degrees, east positive",
        value_name = "DEG",
        value_parser = args::longitude,
        requires_all = ["lat", "km"]
    )]
    lon: Option<f64>,
    /// Length of a side of a region
    #[arg(long, value_name = "KILOMETRES", value_parser = args::region, requires_all = ["lat", "lon"])]
    km: Option<f64>,
}

impl RegionArgs {
    pub(super) fn region(&self) -> Option<Region> {
        Some(Region { lat_deg: self.lat?, lon_deg: self.lon?, side_km: self.km? })
    }
}

/// How much of a structure is baked.
#[derive(clap::Args)]
pub(super) struct DetailArgs {
    /// all: what `tellus sample` answers. pixel: without valleys and rivers of a structure that are too narrow for the
    /// pixels or vertices, as the planet is drawn from afar; a globe takes seconds instead of hours
    #[arg(
        long,
        value_name = "DETAIL",
        default_value = "all",
        value_parser = detail()
    )]
    pub(super) detail: Detail,
}

/// Parser of the names of [`Detail`].
pub(super) fn detail() -> impl TypedValueParser<Value = Detail> {
    PossibleValuesParser::new(Detail::ALL.map(Detail::name)).try_map(|name| Detail::named(&name).ok_or(name))
}

/// Tells that a bake takes long, and what would be faster.
pub(super) fn tell_slow() {
    tell("note: every river nearby is made, milliseconds for each point; --detail pixel leaves out the narrow ones");
}
