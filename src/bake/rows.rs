//! The rows of one map of one picture, read from strips.

use super::format::Source;
use super::progress::Progress;
use super::strips::{Strips, floats};
use std::io;

/// Rows from the top.
pub(super) struct Rows<'a> {
    strips: &'a Strips,
    picture: usize,
    /// Index of the map among those of the strips.
    map: usize,
    row: u32,
    /// The values of the strip of the row, and the row after its last.
    open: Option<(Vec<u8>, u32)>,
    /// Bytes of a row.
    length: usize,
    progress: &'a Progress<'a>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(strips: &'a Strips, picture: usize, map: usize, progress: &'a Progress<'a>) -> Self {
        let length = strips.grid.width as usize * strips.maps[map].channels() * size_of::<f32>();
        Self { strips, picture, map, row: 0, open: None, length, progress }
    }

    /// Reads the strip of the next row, which begins with it.
    fn open(&self) -> io::Result<(Vec<u8>, u32)> {
        let strip = self.strips.with_row(self.picture, self.row);
        let named = |error: io::Error| {
            io::Error::new(error.kind(), format!("{}: {error}", self.strips.path(strip.number).display()))
        };
        Ok((self.strips.read(&strip, self.map).map_err(named)?, strip.rows.end))
    }
}

impl Source for Rows<'_> {
    fn read(&mut self, rows: u32, values: &mut Vec<f32>) -> io::Result<()> {
        values.clear();
        for _ in 0..rows {
            let (bytes, end) = match self.open.take() {
                Some(open) => open,
                None => self.open()?,
            };
            let start = bytes.len().saturating_sub((end - self.row) as usize * self.length);
            values.extend(floats(&bytes[start..][..self.length]));
            self.row += 1;
            if self.row < end {
                self.open = Some((bytes, end));
            } else if !self.progress.add(1) {
                return Err(io::Error::other("stopped"));
            }
        }
        Ok(())
    }
}
