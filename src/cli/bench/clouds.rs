//! The cost of clouds: the maps of a frame, and queries.

use super::{median, repeat};
use crate::clouds::CloudField;
use crate::planet::Planet;
use crate::render::cloud_keyframe;
use crate::sphere::spread;
use crate::terrain::Terrain;
use serde_json::{Value, json};
use std::hint::black_box;
use std::sync::Arc;

/// Directions of queries.
const QUERIES: usize = 500;

/// `field_ms`: an edit of scale, curl, storms or seed, without its maps. `keyframe_ms`: one cube map of ranks, on all
/// cores. `draft_ms`: the same while a slider is dragged. `cover_us`: one query.
pub(super) fn measure(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = Terrain::try_new(planet.clone()).map_err(|error| error.to_string())?;
    let field = CloudField::new(&terrain);
    let field_ms = median(&repeat(|| drop(black_box(CloudField::new(&terrain)))));
    let mut number = 0;
    let mut keyframe_ms = |is_draft: bool| {
        median(&repeat(|| {
            number += 1;
            cloud_keyframe(&field, number, is_draft);
        }))
    };
    let (keyframe_ms, draft_ms) = (keyframe_ms(false), keyframe_ms(true));
    let covers = || {
        for dir in spread(QUERIES) {
            black_box(field.cover(dir, 1000.0));
        }
    };
    let cover_us = median(&repeat(covers)).map(|ms| ms * 1000.0 / QUERIES as f64);
    Ok(json!({ "field_ms": field_ms, "keyframe_ms": keyframe_ms, "draft_ms": draft_ms, "cover_us": cover_us }))
}
