//! Small pictures, drawn on another thread with the viewport's pipelines.

use crate::film::Thumbnail;
use crate::render::{Renderer, srgb_from_linear};
use eframe::egui::{Color32, ColorImage};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// A picture of the newest batch: its number there, and the picture or what went wrong.
pub type Drawn = (usize, Result<ColorImage, String>);

/// A thread that draws batches of thumbnails. A new batch ends the one before.
pub struct Thumbnails {
    jobs: Sender<(u64, usize, Thumbnail)>,
    drawn: Receiver<(u64, Drawn)>,
    batch: Arc<AtomicU64>,
}

impl Thumbnails {
    /// Draws with `renderer`. `wake` is called when a picture is there.
    pub fn start(mut renderer: Renderer, wake: impl Fn() + Send + 'static) -> Self {
        let (jobs, wanted) = channel::<(u64, usize, Thumbnail)>();
        let (done, drawn) = channel();
        let batch = Arc::new(AtomicU64::new(0));
        let newest = Arc::clone(&batch);
        std::thread::spawn(move || {
            for (of, number, thumbnail) in wanted {
                if of != newest.load(Ordering::Relaxed) {
                    continue;
                }
                let side = thumbnail.side_px as usize;
                let picture = thumbnail.draw(&mut renderer).map(|pixels| image(&pixels, side));
                // The receiver is gone if the editor has closed.
                if done.send((of, (number, picture))).is_err() {
                    return;
                }
                wake();
            }
        });
        Self { jobs, drawn, batch }
    }

    /// Begins a batch.
    pub fn draw(&self, thumbnails: impl IntoIterator<Item = Thumbnail>) {
        let of = self.batch.fetch_add(1, Ordering::Relaxed) + 1;
        for (number, thumbnail) in thumbnails.into_iter().enumerate() {
            // The thread ends only with the receiver of its answers, which lives as long as this.
            let _ = self.jobs.send((of, number, thumbnail));
        }
    }

    /// The next picture of the newest batch.
    pub fn poll(&self) -> Option<Drawn> {
        let newest = self.batch.load(Ordering::Relaxed);
        self.drawn.try_iter().find(|(of, _)| *of == newest).map(|(_, drawn)| drawn)
    }
}

impl Drop for Thumbnails {
    fn drop(&mut self) {
        // What waits is not drawn any more.
        self.batch.fetch_add(1, Ordering::Relaxed);
    }
}

fn image(pixels: &[[f32; 3]], side: usize) -> ColorImage {
    let byte = |value: f32| (srgb_from_linear(f64::from(value)) * 255.0).round() as u8;
    let pixels = pixels.iter().map(|pixel| {
        let [r, g, b] = pixel.map(byte);
        Color32::from_rgb(r, g, b)
    });
    ColorImage::new([side, side], pixels.collect())
}
