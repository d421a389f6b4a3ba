//! Small pictures, drawn on another thread with the viewport's pipelines, and kept in files between runs.

use crate::film::Thumbnail;
use crate::planet::file::write_atomically;
use crate::planet::open::read_whole;
use crate::planet::{Key, Planet, VERSION};
use crate::render::{Renderer, srgb_from_linear};
use eframe::egui::{Color32, ColorImage};
use image::ImageEncoder as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Most pictures that are kept between runs.
const MOST_KEPT: usize = 400;
/// Longest file of a kept picture.
const MOST_BYTES: u64 = 1 << 24;

/// A picture of the newest batch: its number there, and the picture or what went wrong.
pub type Drawn = (usize, Result<ColorImage, String>);

/// A thread that draws batches of thumbnails. A new batch ends the one before.
pub struct Thumbnails {
    jobs: Sender<(u64, usize, Thumbnail)>,
    drawn: Receiver<(u64, Drawn)>,
    batch: Arc<AtomicU64>,
}

impl Thumbnails {
    /// Draws with `renderer`. `kept`: the folder where pictures are kept; None: nowhere. `wake` is called when a
    /// picture is there.
    pub fn start(mut renderer: Renderer, kept: Option<PathBuf>, wake: impl Fn() + Send + 'static) -> Self {
        let (jobs, wanted) = channel::<(u64, usize, Thumbnail)>();
        let (done, drawn) = channel();
        let batch = Arc::new(AtomicU64::new(0));
        let newest = Arc::clone(&batch);
        std::thread::spawn(move || {
            let kept = kept.map(KeptPictures::open);
            for (of, number, thumbnail) in wanted {
                if of != newest.load(Ordering::Relaxed) {
                    continue;
                }
                let thumbnail = with_pictures(thumbnail);
                let side = thumbnail.side_px as usize;
                let file = kept.as_ref().map(|kept| kept.file(&thumbnail));
                let picture = match file.as_deref().and_then(read) {
                    Some(picture) => Ok(picture),
                    None => {
                        let drawn = thumbnail.draw(&mut renderer).map(|pixels| image(&pixels, side));
                        if let (Some(file), Ok(picture)) = (&file, &drawn) {
                            write(file, picture);
                        }
                        drawn
                    }
                };
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

/// Reads height maps and meshes that are not loaded. A layer whose picture cannot be read is flat.
fn with_pictures(thumbnail: Thumbnail) -> Thumbnail {
    if thumbnail.planet.missing_files().is_empty() {
        return thumbnail;
    }
    let mut planet = Planet::clone(&thumbnail.planet);
    planet.load_pictures();
    Thumbnail { planet: Arc::new(planet), ..thumbnail }
}

/// The folder of pictures that are kept between runs: each named by all that it shows.
struct KeptPictures {
    folder: PathBuf,
}

impl KeptPictures {
    /// Opens the folder. The oldest pictures go when there are too many.
    fn open(folder: PathBuf) -> Self {
        let files = fs::read_dir(&folder).into_iter().flatten().filter_map(|entry| {
            let entry = entry.ok()?;
            let metadata = entry
                .metadata()
                .ok()
                .filter(|data| data.is_file() && is_own_name(&entry.file_name().to_string_lossy()));
            Some((metadata?.modified().ok()?, entry.path()))
        });
        let mut files: Vec<_> = files.collect();
        files.sort();
        let surplus = files.len().saturating_sub(MOST_KEPT);
        for (_, path) in &files[..surplus] {
            // Somebody else may have removed it already.
            let _ = fs::remove_file(path);
        }
        Self { folder }
    }

    fn file(&self, thumbnail: &Thumbnail) -> PathBuf {
        let seen = (thumbnail.place, thumbnail.time_secs.to_bits(), thumbnail.side_px);
        let key = Key::of(&(env!("CARGO_PKG_VERSION"), VERSION, Key::of_planet(&thumbnail.planet), seen));
        self.folder.join(format!("{:032x}.png", key.bits()))
    }
}

/// Whether a name is one that [`KeptPictures::file`] gives: what others have put into the folder stays.
fn is_own_name(name: &str) -> bool {
    let key = name.strip_suffix(".png").unwrap_or_default();
    key.len() == 32 && key.bytes().all(|digit| digit.is_ascii_hexdigit())
}

fn read(file: &Path) -> Option<ColorImage> {
    let picture = image::load_from_memory(&read_whole(file, MOST_BYTES).ok()?).ok()?.into_rgb8();
    let size = [picture.width() as usize, picture.height() as usize];
    Some(ColorImage::from_rgb(size, &picture))
}

/// A picture that cannot be kept is drawn again in the next run.
fn write(file: &Path, picture: &ColorImage) {
    let rgb: Vec<u8> = picture.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
    let [width, height] = picture.size.map(|side| side as u32);
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    if encoder.write_image(&rgb, width, height, image::ExtendedColorType::Rgb8).is_ok()
        && let Some(folder) = file.parent()
        && fs::create_dir_all(folder).is_ok()
        && let Err(error) = write_atomically(file, &bytes)
    {
        log::debug!("{}: the picture is not kept: {error}", file.display());
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
