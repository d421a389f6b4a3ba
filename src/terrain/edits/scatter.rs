//! Copies of stamps that are scattered over a painted mask: their places follow its strokes.

use super::World;
use super::compiled::CompiledEdit;
use super::index::Index;
use super::mask::{EditMask, Strokes};
use super::paint::Paint;
use super::roster::{Changes, Roster};
use std::sync::Arc;

/// Finds anew the places of the copies of edits that are new, or whose mask changed, and adds those that have other
/// places to the changes. `masks`: the index of mask strokes after the changes.
pub(super) fn refresh(roster: &mut Roster, changes: &mut Changes, masks: &Index, world: World) {
    let scattered = roster.scattered();
    if scattered.is_empty() {
        return;
    }
    let new = changes.added.iter().filter_map(|slot| roster.edit(*slot));
    let changed: Vec<Paint> =
        new.chain(changes.removed.iter().map(|(_, edit)| edit)).filter_map(|edit| edit.paint().copied()).collect();
    for (slot, shared) in scattered {
        let (Some(old), Some(name)) = (roster.edit(slot).cloned(), shared.edit.limiting_mask()) else { continue };
        let mask = EditMask::new(name, &shared.edit);
        let is_new = changes.added.contains(&slot);
        let is_stroke = |paint: &Paint| matches!(paint, Paint::Mask { mask: of, .. } if *of == mask.id);
        if !is_new && !changed.iter().any(is_stroke) {
            continue;
        }
        let shares = Strokes { index: masks, roster };
        let scatter = |dirs: &[glam::DVec3]| shares.shares(mask, dirs);
        let edit = CompiledEdit::new(&shared.edit, world.radius_m, world.sea_m, Some(&scatter));
        if !is_new {
            let places = |edit: &CompiledEdit| edit.pieces.iter().map(|piece| piece.hash).collect::<Vec<u128>>();
            if places(&edit) == places(&old) {
                continue;
            }
            changes.removed.push((slot, old));
            changes.added.push(slot);
        }
        roster.replace(slot, Arc::new(edit));
    }
    changes.added.sort_unstable_by_key(|slot| roster.rank_of(*slot));
}
