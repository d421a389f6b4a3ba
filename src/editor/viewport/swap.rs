//! The surface on screen, and the next one, which replaces it once all of its tiles are on the GPU.
//!
//! An upload that has begun is finished even if newer surfaces are complete: otherwise a slider that is held could put
//! off every swap.

use crate::tiles::Surface;
use std::sync::Arc;

/// Most bytes of tiles that one frame uploads: a few milliseconds on a software adapter.
pub const UPLOAD_BUDGET_BYTES: u64 = 6 << 20;

/// The two surfaces.
#[derive(Default)]
pub struct Swap {
    shown: Option<Arc<Surface>>,
    incoming: Option<Arc<Surface>>,
}

impl Swap {
    /// Shows a surface whose tiles are on the GPU already, or none.
    pub fn of(shown: Option<Arc<Surface>>) -> Self {
        Self { shown, incoming: None }
    }

    /// The surface on screen.
    pub fn shown(&self) -> Option<&Arc<Surface>> {
        self.shown.as_ref()
    }

    /// Uploads one frame's share. `upload` uploads some tiles of a surface and gives whether all are uploaded.
    pub fn advance(&mut self, newest: Option<Arc<Surface>>, upload: impl FnOnce(&Surface) -> bool) {
        let is_shown = |surface: &Arc<Surface>| self.shown.as_ref().is_some_and(|shown| Arc::ptr_eq(shown, surface));
        if self.incoming.is_none() {
            self.incoming = newest.filter(|surface| !is_shown(surface));
        }
        if self.incoming.as_ref().is_some_and(|surface| upload(surface)) {
            self.shown = self.incoming.take();
        }
    }

    /// Whether an upload is under way.
    pub fn is_uploading(&self) -> bool {
        self.incoming.is_some()
    }

    /// Whether another surface is to be shown: being uploaded, or built already.
    pub fn is_under_way(&self, newest: Option<&Arc<Surface>>) -> bool {
        let is_shown = |surface| self.shown.as_ref().is_some_and(|shown| Arc::ptr_eq(shown, surface));
        self.incoming.is_some() || newest.is_some_and(|surface| !is_shown(surface))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Quality, opening};
    use crate::planet::Planet;
    use crate::tiles::build_now;

    #[test]
    fn what_is_being_uploaded_is_shown_before_anything_newer() {
        let planet = Arc::new(Planet::default());
        let view = opening::opening_view(&planet, [64, 64], Quality::Low);
        let [first, second, third] = [(); 3].map(|()| Arc::new(build_now(&planet, &view).unwrap()));
        let mut swap = Swap::default();
        let mut step = |newest: &Arc<Surface>, done| {
            swap.advance(Some(newest.clone()), |_| done);
            swap.shown().cloned()
        };
        let is =
            |shown: Option<Arc<Surface>>, expected: &Arc<Surface>| shown.is_some_and(|s| Arc::ptr_eq(&s, expected));
        assert!(step(&first, false).is_none());
        assert!(is(step(&first, true), &first));
        assert!(is(step(&second, false), &first));
        assert!(is(step(&third, false), &first));
        assert!(is(step(&third, true), &second), "begun is brought to its end");
        assert!(is(step(&third, true), &third));
    }
}
