//! The rows of one map of one picture, read from strips.

use super::format::Source;
use super::progress::Progress;
use super::strips::{Strips, floats};
use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek as _, SeekFrom};

/// Rows from the top.
pub(super) struct Rows<'a> {
    strips: &'a Strips,
    picture: usize,
    /// Index of the map among those of the strips.
    map: usize,
    row: u32,
    /// The strip of the row, and the row after its last.
    open: Option<(BufReader<File>, u32)>,
    bytes: Vec<u8>,
    progress: &'a Progress<'a>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(strips: &'a Strips, picture: usize, map: usize, progress: &'a Progress<'a>) -> Self {
        let row = strips.grid.width as usize * strips.maps[map].channels() * size_of::<f32>();
        Self { strips, picture, map, row: 0, open: None, bytes: vec![0; row], progress }
    }

    /// Opens the strip of the next row.
    fn open(&self) -> io::Result<(BufReader<File>, u32)> {
        let strip = self.strips.with_row(self.picture, self.row);
        let path = self.strips.path(strip.number);
        let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
        let mut file = File::open(&path).map_err(named)?;
        file.seek(SeekFrom::Start(self.strips.plane(&strip, self.map).start)).map_err(named)?;
        Ok((BufReader::with_capacity(1 << 16, file), strip.rows.end))
    }
}

impl Source for Rows<'_> {
    fn read(&mut self, rows: u32, values: &mut Vec<f32>) -> io::Result<()> {
        values.clear();
        for _ in 0..rows {
            let (mut file, end) = match self.open.take() {
                Some(open) => open,
                None => self.open()?,
            };
            file.read_exact(&mut self.bytes)?;
            values.extend(floats(&self.bytes));
            self.row += 1;
            if self.row < end {
                self.open = Some((file, end));
            } else if !self.progress.add(1) {
                return Err(io::Error::other("stopped"));
            }
        }
        Ok(())
    }
}
