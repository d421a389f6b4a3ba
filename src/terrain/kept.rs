//! The fields that a tile keeps: those of the present planet, and some of earlier planets, so that an undo evaluates
//! no noise.

use super::field::Field;
use super::height::CompiledLayer;
use super::landform::Landform;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Most fields of earlier planets, besides one for each layer: a new seed or radius replaces the fields of all layers
/// at once.
const MOST_PAST: usize = 8;
/// Age at which a field of an earlier planet is worth half as much.
const HALF_WORTH: Duration = Duration::from_secs(60);

#[derive(Clone, Debug)]
struct Kept {
    landform: Arc<Landform>,
    field: Arc<Field>,
    /// Since when a layer of the present planet uses it.
    since: Option<Instant>,
    /// How long layers of earlier planets used it, and until when.
    shown: Duration,
    until: Instant,
}

impl Kept {
    /// How likely it is to be wanted again. An undo brings back a state that stood for long, rarely one that a slider
    /// passed in a moment or that was left long ago.
    fn worth(&self, now: Instant) -> f64 {
        let age = now.duration_since(self.until);
        self.shown.as_secs_f64() / (HALF_WORTH + age).as_secs_f64()
    }
}

/// Equal landforms have equal fields, so a field is found by its landform and the spacings of its gradients, wherever
/// the layer stands in the list.
#[derive(Clone, Debug, Default)]
pub(crate) struct KeptFields(Vec<Kept>);

impl KeptFields {
    /// The field of a landform with gradients for these spacings.
    pub(crate) fn find(&self, landform: &Landform, spacings_rad: &[f64]) -> Option<Arc<Field>> {
        let fits = |kept: &&Kept| *kept.landform == *landform && kept.field.has(spacings_rad);
        self.0.iter().find(fits).map(|kept| kept.field.clone())
    }

    /// Makes these layers the present planet, with the fields that are known. Fields of other layers become the past,
    /// of which the worthiest are kept.
    pub(crate) fn adopt(&mut self, layers: &[CompiledLayer], fields: &[Option<Arc<Field>>], now: Instant) {
        for (layer, field) in layers.iter().zip(fields) {
            if let Some(field) = field
                && !self.0.iter().any(|kept| Arc::ptr_eq(&kept.field, field))
            {
                let (landform, field) = (layer.landform.clone(), field.clone());
                self.0.push(Kept { landform, field, since: None, shown: Duration::ZERO, until: now });
            }
        }
        for kept in &mut self.0 {
            if fields.iter().flatten().any(|field| Arc::ptr_eq(&kept.field, field)) {
                kept.since.get_or_insert(now);
            } else if let Some(since) = kept.since.take() {
                kept.shown += now.duration_since(since);
                kept.until = now;
            }
        }
        // The present first, then the past in order of worth.
        self.0.sort_by(|a, b| b.since.cmp(&a.since).then(b.worth(now).total_cmp(&a.worth(now))));
        let present = self.0.iter().filter(|kept| kept.since.is_some()).count();
        self.0.truncate(present + layers.len() + MOST_PAST);
    }

    /// Worth and bytes of each field of the past.
    pub(crate) fn past(&self, now: Instant) -> impl Iterator<Item = (f64, usize)> {
        self.0.iter().filter(|kept| kept.since.is_none()).map(move |kept| (kept.worth(now), kept.field.bytes()))
    }

    /// Forgets fields of the past below this worth.
    pub(crate) fn forget_below(&mut self, worth: f64, now: Instant) {
        self.0.retain(|kept| kept.since.is_some() || kept.worth(now) >= worth);
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        self.0.iter().map(|kept| kept.field.bytes()).sum()
    }
}
