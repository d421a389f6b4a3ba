//! What to do when the graphics device fails: tell of errors; after a loss, keep the work and begin anew.

use crate::editor::state::State;

/// Tells of errors of the device, and restarts the editor if the device is lost: no picture can be drawn any more.
pub fn poll(state: &mut State) {
    if let Some(error) = state.device.take_error() {
        // The rest of wgpu's message tells of its own calls.
        let first = error.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or("unknown").to_owned();
        state.report(
            "The graphics device reports an error",
            vec![
                first,
                "The picture may be wrong. Save your work; a lower quality or a smaller window takes less of the device."
                    .to_owned(),
            ],
        );
    }
    if let Some(reason) = state.device.take_lost() {
        let unsaved = state.document.to_recover().is_some() || state.system_is_dirty();
        let is_kept =
            state.recovery.as_mut().is_some_and(|recovery| recovery.leave(&state.document, state.system.as_ref()));
        if unsaved && !is_kept {
            log::error!("the unsaved work could not be kept");
        }
        let failed = match &mut state.restart {
            Some(restart) => restart().err(),
            None => Some("restart the editor".to_owned()),
        };
        if let Some(failed) = failed {
            // The window may not be able to show it any more.
            log::error!("the graphics device was lost: {failed}");
            state.report("The graphics device was lost", vec![reason, failed]);
        }
    }
}
