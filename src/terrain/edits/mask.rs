//! Masks of layers that are painted by hand: strokes lead from 0 towards 1, or back.

use super::Edits;
use super::compiled::CompiledEdit;
use super::near::{Hit, Near, Touch};
use super::paint::Paint;
use crate::planet::Key;
use crate::sphere::NodeId;
use crate::terrain::landform::MAX_BANDS;
use glam::DVec3;
use std::cell::RefCell;

/// A painted mask, by a hash of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MaskId(Key);

impl MaskId {
    pub(crate) fn of(name: &str) -> Self {
        Self(Key::of(name))
    }

    /// The two halves of the hash.
    pub(super) fn words(self) -> [u64; 2] {
        [(self.0.bits() >> 64) as u64, self.0.bits() as u64]
    }
}

impl Edits {
    /// The key of all paint of masks. None if there is none.
    pub(crate) fn mask_key(&self) -> Option<Key> {
        (!self.masks.is_empty()).then(|| self.masks.key_of_all())
    }

    /// The key of the paint of masks that touches a node and the ground close around it. None if none does.
    pub(crate) fn mask_key_near(&self, id: NodeId) -> Option<Key> {
        self.masks.key_near(id, &self.roster)
    }

    /// Whether paint of masks may be within a chord of a direction.
    pub(crate) fn may_mask(&self, disc: (DVec3, f64)) -> bool {
        let touches = |number: &u32| self.roster.piece(*number).is_some_and(|piece| piece.touches(disc.0, disc.1));
        let mut may = false;
        self.masks.each_leaf(Some(disc), &mut |pieces| may = may || pieces.iter().any(touches));
        may
    }

    /// Calls `each` with the number of each point that is near strokes, the paint of a mask there from 0 to 1, and one
    /// gradient by the direction for each of the spacings.
    pub(crate) fn masked(
        &self,
        mask: MaskId,
        dirs: &[DVec3],
        spacings_rad: &[f64],
        mut each: impl FnMut(usize, f64, &[DVec3]),
    ) {
        if self.masks.is_empty() {
            return;
        }
        thread_local! {
            static NEAR: RefCell<Near> = RefCell::default();
        }
        let bands = spacings_rad.len().min(MAX_BANDS);
        // Of each point; nothing yet where no stroke is.
        let (mut values, mut gradients) = (Vec::new(), Vec::new());
        let mut near = NEAR.take();
        let paints =
            |_: u32, edit: &CompiledEdit| matches!(edit.paint(), Some(Paint::Mask { mask: of, .. }) if *of == mask);
        near.each_touch(&self.masks, &self.roster, dirs, paints, |Touch { edit, hits, .. }| {
            let Some(Paint::Mask { amount, .. }) = edit.paint().copied() else { return };
            values.resize(dirs.len(), None);
            gradients.resize(dirs.len() * bands, DVec3::ZERO);
            for Hit { point: i, nearest } in hits {
                let value = values[*i].get_or_insert(0.0);
                let Some(weight) = edit.weighted(dirs[*i], nearest) else { continue };
                let (strength, share) = (amount.abs(), amount.abs() * weight.change_m);
                let left = if amount > 0.0 { 1.0 - *value } else { -*value };
                for (gradient, &spacing_rad) in gradients[*i * bands..][..bands].iter_mut().zip(spacings_rad) {
                    *gradient = *gradient * (1.0 - share) + weight.gradient(spacing_rad) * (strength * left);
                }
                *value = (*value + left * share).clamp(0.0, 1.0);
            }
        });
        for (i, value) in values.iter().enumerate() {
            if let Some(value) = value {
                each(i, *value, &gradients[i * bands..][..bands]);
            }
        }
        NEAR.set(near);
    }
}
