//! What a view keeps of its frames for the next one ([`Reuse`]): the clouds of each body, which are carried over while
//! the camera moves (`cloud_gather.wgsl`), and the mean of a still picture (`still.wgsl`).

use super::gpu;
use super::scene::Reuse;
use super::shared::{Body, Frame};
use super::targets::{Owned, Target, Targets};
use crate::lod::Quality;
use glam::{DVec2, DVec3, Mat4, UVec2};
use std::f64::consts::TAU;

/// Place of the marched pixel in a block of 4 by 4 and of 2 by 2 pixels, frame by frame: neighbours in time are far
/// apart (Bayer, An optimum method for two-level rendition, 1973).
const PLACES_OF_4: [[u32; 2]; 16] = [
    [0, 0],
    [2, 2],
    [2, 0],
    [0, 2],
    [1, 1],
    [3, 3],
    [3, 1],
    [1, 3],
    [1, 0],
    [3, 2],
    [3, 0],
    [1, 2],
    [0, 1],
    [2, 3],
    [2, 1],
    [0, 3],
];
const PLACES_OF_2: [[u32; 2]; 4] = [[0, 0], [1, 1], [1, 0], [0, 1]];

/// How far a view has come.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Progress {
    /// Frames that kept something.
    frames: u32,
    /// Number of the frame among those of a still picture, from 1; 0 for other frames.
    pub(crate) still: u32,
}

impl Progress {
    /// Begins a frame.
    pub(crate) fn begin(&mut self, reuse: Reuse) {
        self.frames = if reuse == Reuse::None { 0 } else { self.frames.wrapping_add(1) };
        self.still = if reuse == Reuse::Still { self.still + 1 } else { 0 };
    }

    /// Offset of the picture in pixels, right and down, each from -0.5 to 0.5: 0 for all but still pictures. Any number
    /// of frames covers the pixel evenly (Roberts, The unreasonable effectiveness of quasirandom sequences, 2018).
    pub(crate) fn jitter_px(self) -> DVec2 {
        const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3);
        let moved = STEP * f64::from(self.still.saturating_sub(1)) + 0.5;
        moved - moved.floor() - 0.5
    }

    /// Sets the uniforms of a frame. `still_scale`: pixels developed for each pixel drawn.
    pub(crate) fn write(self, out: &mut Frame, still_scale: f32) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        out.still_number = self.still;
        out.still_scale = if self.still > 0 { still_scale } else { 1.0 };
        // Together, the frames resolve the pixels that are developed.
        if self.still > 1 {
            out.pixel_rad /= still_scale;
        }
        out.still_jitter_px = self.jitter_px().as_vec2();
        out.noise_shift = (f64::from(self.frames.saturating_sub(1)) * GOLDEN).fract() as f32;
    }
}

/// The clouds of a body in one frame.
struct CloudPicture {
    light: wgpu::TextureView,
    distance: wgpu::TextureView,
}

impl CloudPicture {
    fn new(device: &wgpu::Device, size_px: [u32; 2]) -> Self {
        let make = |target: Target| {
            gpu::target(device, &format!("{target:?}"), size_px, target.format().unwrap_or(super::RADIANCE_FORMAT))
        };
        Self { light: make(Target::CloudLight), distance: make(Target::CloudDistance) }
    }
}

/// The camera of a frame, in the frame of the body.
#[derive(Clone, Copy)]
struct Eye {
    position_m: DVec3,
    clip_from_rel_m: Mat4,
    /// Angle about the pole by which the wind has carried the clouds.
    drift_rad: f64,
}

/// The clouds of a body in a view: those of this frame and of the one before.
pub(crate) struct CloudHistory {
    size_px: [u32; 2],
    pictures: [CloudPicture; 2],
    /// One pixel of each block; made when it is first needed.
    marched: Option<(u32, CloudPicture)>,
    /// Index of this frame's picture.
    newest: usize,
    /// The camera of the newest picture.
    eye: Eye,
    /// Whether this frame carries clouds over.
    carries: bool,
    quality: Quality,
}

/// What the clouds of a frame are drawn for.
pub(crate) struct CloudFrame {
    pub(crate) reuse: Reuse,
    /// Number of the frame among those that kept something.
    pub(crate) progress: Progress,
    /// Size of the targets.
    pub(crate) size_px: [u32; 2],
    pub(crate) quality: Quality,
    /// The eye in the body's frame.
    pub(crate) eye_m: DVec3,
    /// Angle about the pole by which the wind has carried the clouds.
    pub(crate) drift_rad: f64,
}

impl CloudHistory {
    /// Memory of the pictures.
    pub(crate) fn resident_bytes(&self) -> u64 {
        let pictures = self.pictures.iter().chain(self.marched.as_ref().map(|(_, picture)| picture));
        pictures.map(|picture| gpu::view_bytes([&picture.light, &picture.distance])).sum()
    }

    /// Prepares the history of a frame with clouds, and sets the uniforms of the body. Gives whether clouds are carried
    /// over.
    pub(crate) fn prepare(history: &mut Option<Self>, device: &wgpu::Device, of: &CloudFrame, out: &mut Body) -> bool {
        (out.march_block, out.march_place) = (1, UVec2::ZERO);
        if of.reuse == Reuse::None {
            *history = None;
            return false;
        }
        let eye = Eye { position_m: of.eye_m, clip_from_rel_m: out.clip_from_rel_m, drift_rad: of.drift_rad };
        let kept = history.take().filter(|kept| kept.size_px == of.size_px && kept.quality == of.quality);
        let Some(mut kept) = kept else {
            *history = Some(Self {
                size_px: of.size_px,
                pictures: [(); 2].map(|()| CloudPicture::new(device, of.size_px)),
                marched: None,
                newest: 0,
                eye,
                carries: false,
                quality: of.quality,
            });
            return false;
        };
        kept.newest = 1 - kept.newest;
        kept.carries = of.reuse == Reuse::Moving;
        if kept.carries {
            let (block, place) = match of.quality {
                Quality::Low => (2, PLACES_OF_2[of.progress.frames as usize % 4]),
                Quality::Medium | Quality::High => (4, PLACES_OF_4[of.progress.frames as usize % 16]),
            };
            if kept.marched.as_ref().is_none_or(|(side, _)| *side != block) {
                let size_px = of.size_px.map(|side| side.div_ceil(block));
                kept.marched = Some((block, CloudPicture::new(device, size_px)));
            }
            (out.march_block, out.march_place) = (block, UVec2::from_array(place));
            out.before_clip_from_rel_m = kept.eye.clip_from_rel_m;
            out.eye_before_rel_m = (kept.eye.position_m - of.eye_m).as_vec3();
            let turn_rad = of.drift_rad - kept.eye.drift_rad;
            out.cloud_turn_rad = (turn_rad - TAU * (turn_rad / TAU).round()) as f32;
        }
        kept.eye = eye;
        let carries = kept.carries;
        *history = Some(kept);
        carries
    }

    /// The texture of a target of the clouds. `marching`: for the march itself, which may draw a part of the pixels.
    pub(crate) fn texture(&self, target: Target, marching: bool) -> Option<&wgpu::TextureView> {
        let newest = &self.pictures[self.newest];
        let before = &self.pictures[1 - self.newest];
        let marched = self.marched.as_ref().map(|(_, picture)| picture);
        let newest = if marching && self.carries { marched? } else { newest };
        match target {
            Target::CloudLight => Some(&newest.light),
            Target::CloudDistance => Some(&newest.distance),
            Target::MarchedLight => marched.map(|marched| &marched.light),
            Target::MarchedDistance => marched.map(|marched| &marched.distance),
            Target::LightBefore => Some(&before.light),
            Target::DistanceBefore => Some(&before.distance),
            _ => None,
        }
    }

    /// The part of its targets that the march draws.
    pub(crate) fn marched_px(&self, viewport_px: [u32; 4]) -> [u32; 4] {
        match &self.marched {
            Some((block, _)) if self.carries => {
                [0, 0, viewport_px[2].div_ceil(*block), viewport_px[3].div_ceil(*block)]
            }
            _ => viewport_px,
        }
    }
}

/// The mean of the frames of a still scene, and its targets of the post-process.
pub(crate) struct Still {
    pub(crate) targets: Targets,
    /// Index of the newest mean.
    newest: usize,
}

impl Still {
    /// An empty mean for pictures of a size.
    pub(crate) fn new(device: &wgpu::Device, size_px: [u32; 2]) -> Self {
        let mut targets = Targets::new(size_px);
        let developed = [Target::Toned, Target::Smoothed].map(Owned::Target);
        let means = [0, 1].into_iter().flat_map(|number| [Owned::Mean(number), Owned::MeanStars(number)]);
        developed.into_iter().chain(means).for_each(|owned| targets.make(device, owned));
        Self { targets, newest: 0 }
    }

    /// Begins a frame.
    pub(crate) fn advance(&mut self) {
        self.newest = 1 - self.newest;
    }

    /// The texture of a target: of the mean, and of the post-process that follows.
    pub(crate) fn texture(&self, target: Target) -> Option<&wgpu::TextureView> {
        let (now, before) = (self.newest, 1 - self.newest);
        self.targets.get(match target {
            Target::MeanLight => Owned::Mean(now),
            Target::MeanStars => Owned::MeanStars(now),
            Target::MeanLightBefore => Owned::Mean(before),
            Target::MeanStarsBefore => Owned::MeanStars(before),
            other => Owned::Target(other),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_of_a_block_is_marched_in_turn() {
        let all = |places: &[[u32; 2]], side: u32| {
            let mut sorted: Vec<u32> = places.iter().map(|[x, y]| y * side + x).collect();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..side * side).collect::<Vec<_>>());
        };
        all(&PLACES_OF_4, 4);
        all(&PLACES_OF_2, 2);
    }

    #[test]
    fn frames_of_a_still_picture_cover_the_pixel() {
        let mut progress = Progress::default();
        let mut quarters = [0; 4];
        for number in 1..=16 {
            progress.begin(Reuse::Still);
            let at = progress.jitter_px();
            assert!(at.abs().max_element() <= 0.5);
            assert!(number > 1 || at == DVec2::ZERO, "the first frame is where the picture was");
            quarters[usize::from(at.x >= 0.0) + 2 * usize::from(at.y >= 0.0)] += 1;
        }
        assert!(quarters.iter().all(|count| (3..=5).contains(count)), "{quarters:?}");
        progress.begin(Reuse::Moving);
        assert_eq!((progress.still, progress.jitter_px()), (0, DVec2::ZERO));
    }
}
