//! The graphics device of the window: errors that nobody caught, and its loss.

use eframe::egui;
use std::sync::{Arc, Mutex, PoisonError};

/// What went wrong with a device since it was asked last. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct DeviceWatch(Arc<Mutex<Troubles>>);

#[derive(Debug, Default)]
struct Troubles {
    /// The first error, until it is taken.
    error: Option<String>,
    /// Whether an error has been taken: the same one may come in every frame.
    told: bool,
    lost: Option<String>,
}

impl DeviceWatch {
    /// Watches a device from now on. wgpu's own answer to an error is a panic.
    pub fn new(device: &wgpu::Device, ctx: &egui::Context) -> Self {
        let watch = Self::default();
        let (noted, waker) = (watch.clone(), ctx.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            log::error!("{error}");
            noted.note_error(match error {
                wgpu::Error::OutOfMemory { .. } => "its memory is full".to_owned(),
                error => error.to_string(),
            });
            waker.request_repaint();
        }));
        let (noted, waker) = (watch.clone(), ctx.clone());
        device.set_device_lost_callback(move |reason, message| {
            log::error!("the graphics device was lost ({reason:?}): {message}");
            // Whoever destroys a device knows it; dropping the last handle does.
            if reason != wgpu::DeviceLostReason::Destroyed {
                noted.note_lost(message);
                waker.request_repaint();
            }
        });
        watch
    }

    /// Notes an error.
    pub fn note_error(&self, message: String) {
        let mut troubles = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !troubles.told {
            troubles.error.get_or_insert(message);
        }
    }

    /// Notes that the device is lost.
    pub fn note_lost(&self, message: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).lost.get_or_insert(message);
    }

    /// The first error, once.
    pub fn take_error(&self) -> Option<String> {
        let mut troubles = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let error = troubles.error.take();
        troubles.told |= error.is_some();
        error
    }

    /// Why the device was lost, once.
    pub fn take_lost(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).lost.take()
    }
}
