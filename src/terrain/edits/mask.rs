//! Masks that are painted by hand: strokes lead from 0 towards 1, or back. They limit layers and other edits.

use super::compiled::CompiledEdit;
use super::index::{Hash, Index};
use super::near::{Hit, Near, Touch};
use super::paint::Paint;
use super::roster::Roster;
use super::{Edits, Subject};
use crate::planet::{GroundEdit, Key};
use crate::terrain::landform::MAX_BANDS;
use glam::DVec3;
use std::cell::RefCell;

/// A painted mask, by a hash of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MaskId(pub(super) Key);

impl MaskId {
    pub(crate) fn of(name: &str) -> Self {
        Self(Key::of(name))
    }
}

impl Edits {
    /// Whether paint of masks may be within a chord of a direction.
    pub(crate) fn may_mask(&self, disc: (DVec3, f64)) -> bool {
        let touches = |number: &u32| self.roster.piece(*number).is_some_and(|piece| piece.touches(disc.0, disc.1));
        let mut may = false;
        self.index(Subject::Masks).each_leaf(Some(disc), &mut |pieces| may = may || pieces.iter().any(touches));
        may
    }

    /// Calls `each` with the number of each point that is near strokes, the paint of a mask there from 0 to 1, and one
    /// gradient by the direction for each of the spacings.
    pub(crate) fn masked(
        &self,
        mask: MaskId,
        dirs: &[DVec3],
        spacings_rad: &[f64],
        each: impl FnMut(usize, f64, &[DVec3]),
    ) {
        Strokes { index: self.index(Subject::Masks), roster: &self.roster }.masked(mask, dirs, spacings_rad, each);
    }

    /// What the mask of an edit leaves of it at points.
    pub(super) fn shares(
        &self,
        edit: &CompiledEdit,
        dirs: impl Iterator<Item = DVec3>,
        spacings_rad: &[f64],
    ) -> Shares {
        let Some(mask) = edit.mask else { return Shares::default() };
        let (dirs, bands) = (dirs.collect::<Vec<DVec3>>(), spacings_rad.len().min(MAX_BANDS));
        let mut values = vec![mask.share(0.0); dirs.len()];
        let mut gradients = vec![DVec3::ZERO; dirs.len() * bands];
        self.masked(mask.id, &dirs, spacings_rad, |i, value, by_dir| {
            values[i] = mask.share(value);
            for (own, by_dir) in gradients[i * bands..][..bands].iter_mut().zip(by_dir) {
                *own = if mask.is_outside { -*by_dir } else { *by_dir };
            }
        });
        Shares { values, gradients, bands }
    }
}

/// The painted mask that limits an edit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EditMask {
    pub(super) id: MaskId,
    is_outside: bool,
}

impl EditMask {
    pub(super) fn new(name: &str, edit: &GroundEdit) -> Self {
        Self { id: MaskId::of(name), is_outside: edit.outside_mask }
    }

    pub(super) fn hash(&self, hash: &mut Hash) {
        self.id.0.words().into_iter().for_each(|word| hash.add(word));
        hash.add(u64::from(self.is_outside));
    }

    /// What it leaves of the edit where it is painted so far.
    fn share(&self, paint: f64) -> f64 {
        if self.is_outside { 1.0 - paint } else { paint }
    }
}

/// What a mask leaves of an edit at some points.
#[derive(Debug, Default)]
pub(super) struct Shares {
    /// None: everything.
    values: Vec<f64>,
    gradients: Vec<DVec3>,
    bands: usize,
}

impl Shares {
    /// The share at a point, from 0 to 1.
    #[inline]
    pub(super) fn of(&self, point: usize) -> f64 {
        self.values.get(point).copied().unwrap_or(1.0)
    }

    /// Its gradients by the direction, one for each spacing; none if it is 1 everywhere.
    #[inline]
    pub(super) fn gradients(&self, point: usize) -> &[DVec3] {
        self.gradients.get(point * self.bands..(point + 1) * self.bands).unwrap_or_default()
    }
}

/// The share of a mask at directions.
pub(super) type ShareAt<'a> = &'a dyn Fn(&[DVec3]) -> Vec<f64>;

/// The strokes of the mask tool.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strokes<'a> {
    pub(super) index: &'a Index,
    pub(super) roster: &'a Roster,
}

impl Strokes<'_> {
    /// The share of a mask at directions.
    pub(super) fn shares(&self, mask: EditMask, dirs: &[DVec3]) -> Vec<f64> {
        let mut shares = vec![mask.share(0.0); dirs.len()];
        self.masked(mask.id, dirs, &[], |i, value, _| shares[i] = mask.share(value));
        shares
    }

    /// See [`Edits::masked`].
    fn masked(&self, mask: MaskId, dirs: &[DVec3], spacings_rad: &[f64], mut each: impl FnMut(usize, f64, &[DVec3])) {
        if self.index.is_empty() || dirs.is_empty() {
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
        near.each_touch(self.index, self.roster, dirs, paints, |Touch { edit, hits, .. }| {
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
