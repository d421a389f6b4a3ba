//! When a still picture is drawn again to make it finer: once the user has not touched anything for a moment, so that
//! the window answers at once. Each picture adds a sample to all pixels ([`crate::render::Reuse::Still`]).

use std::time::Duration;

/// Refinement of the picture on screen.
pub struct Refinement {
    /// Time without input before the first sample, and pictures that are drawn of a still scene.
    pause_secs: f64,
    most: u32,
    drawn: u32,
    touched_at_secs: f64,
}

impl Refinement {
    /// `is_software`: whether the adapter is a processor, which takes a large part of a second for each picture.
    pub fn new(is_software: bool) -> Self {
        let (pause_secs, most) = if is_software { (0.5, 16) } else { (0.1, 32) };
        Self { pause_secs, most, drawn: 0, touched_at_secs: 0.0 }
    }

    /// Notes input at a time.
    pub fn touched(&mut self, now_secs: f64) {
        self.touched_at_secs = now_secs;
    }

    /// Notes a picture: a further sample of the one before, or another.
    pub fn drew(&mut self, sample: bool) {
        self.drawn = if sample { self.drawn + 1 } else { 0 };
    }

    /// Samples that are drawn, and samples of a finished picture.
    pub fn progress(&self) -> (u32, u32) {
        (self.drawn, self.most)
    }

    /// Time until the next sample is due; none once the picture is finished.
    pub fn due_after(&self, now_secs: f64) -> Option<Duration> {
        let wait_secs = (self.touched_at_secs + self.pause_secs - now_secs).max(0.0);
        (self.drawn < self.most).then(|| Duration::from_secs_f64(wait_secs))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_wait_for_a_pause_and_come_to_an_end() {
        let mut refinement = Refinement::new(true);
        refinement.touched(10.0);
        assert_eq!(refinement.due_after(10.2), Some(Duration::from_secs_f64(10.5 - 10.2)));
        for drawn in 0..16 {
            assert_eq!((refinement.progress(), refinement.due_after(11.0)), ((drawn, 16), Some(Duration::ZERO)));
            refinement.drew(true);
        }
        assert_eq!(refinement.due_after(11.0), None);
        refinement.drew(false);
        assert_eq!(refinement.due_after(11.0), Some(Duration::ZERO));
    }
}
