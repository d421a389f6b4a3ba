//! Memory and work limits of the pictures, texture sets and meshes of one planet, so that no preset exhausts either,
//! whatever its files say.
//!
//! - One picture has at most [`MAX_PIXELS`].
//! - All pictures of a planet keep at most [`MAX_BYTES`] of pixels: two bytes for a pixel of a PNG, four for one of an
//!   OpenEXR, and for a texture set those of its layer. Coarser levels add a third. Reading a picture and making its
//!   levels takes about as much again for a moment: no planet's pictures ever take more than 1.5 GiB.
//! - The files of a planet hold at most [`MAX_WORK_BYTES`] of unpacked numbers in all channels, used or not: this
//!   bounds the time.
//! - All meshes of a planet have at most [`MAX_MESH_TRIANGLES`].
//!
//! Sizes come from the files' headers and are taken from the budget before anything is decoded. Equal pictures and
//! meshes count once, however many layers and populations use them.

use super::pixels::Picture;

/// Most pixels of one picture: 16384 x 8192.
pub const MAX_PIXELS: u64 = 1 << 27;
/// Most bytes of pixels that all pictures of a planet may keep.
pub const MAX_BYTES: u64 = 512 << 20;
/// Most bytes that the files of all pictures of a planet may hold, unpacked.
pub const MAX_WORK_BYTES: u64 = 4 << 30;

/// Most triangles of all meshes of a planet.
pub const MAX_MESH_TRIANGLES: usize = 1_000_000;

/// The budget that is left for further pictures and meshes of one planet.
#[derive(Clone, Debug)]
pub struct Budget {
    bytes: u64,
    work_bytes: u64,
    triangles: usize,
    /// Hashes of the pictures and meshes that have been counted.
    counted: Vec<u64>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { bytes: MAX_BYTES, work_bytes: MAX_WORK_BYTES, triangles: MAX_MESH_TRIANGLES, counted: Vec::new() }
    }
}

impl Budget {
    /// Counts a loaded picture; an error if there is no room for it.
    pub(in crate::planet) fn keep(&mut self, picture: &Picture) -> Result<(), String> {
        self.keep_layer(picture.hash, picture.bytes)
    }

    /// Counts loaded pixels, such as those of a texture set; an error if there is no room for them.
    pub(in crate::planet) fn keep_layer(&mut self, hash: u64, bytes: u64) -> Result<(), String> {
        if !self.counted.contains(&hash) {
            self.take(bytes, 0)?;
            self.counted.push(hash);
        }
        Ok(())
    }

    /// Counts a loaded mesh; an error if there is no room for it.
    pub(in crate::planet) fn keep_mesh(&mut self, hash: u64, triangles: usize) -> Result<(), String> {
        if !self.counted.contains(&hash) {
            let left = self.triangles;
            self.triangles = left.checked_sub(triangles).ok_or_else(|| {
                format!(
                    "has {triangles} triangles, and {left} of {MAX_MESH_TRIANGLES} are left for it beside the planet's \
                     other meshes; use smaller meshes, or one file in several populations"
                )
            })?;
            self.counted.push(hash);
        }
        Ok(())
    }

    /// Takes room for a picture before it is decoded: the bytes of its pixels, and the unpacked bytes of its file.
    pub(in crate::planet) fn take(&mut self, bytes: u64, work_bytes: u64) -> Result<(), String> {
        if bytes > self.bytes {
            return Err(format!(
                "takes {} of memory, and {} of {} are left for it beside the planet's other pictures; use smaller \
                 pictures, or one file in several layers",
                mebibytes(bytes),
                mebibytes(self.bytes),
                mebibytes(MAX_BYTES)
            ));
        }
        if work_bytes > self.work_bytes {
            return Err(format!(
                "holds {} of numbers in all its channels, and {} of {} are left for it beside the planet's other \
                 pictures; use smaller pictures, or save them with fewer channels",
                mebibytes(work_bytes),
                mebibytes(self.work_bytes),
                mebibytes(MAX_WORK_BYTES)
            ));
        }
        self.bytes -= bytes;
        self.work_bytes -= work_bytes;
        Ok(())
    }

    /// Gives back the pixel bytes that [`Self::take`] took: the picture could not be read, or is loaded already.
    pub(super) fn give_back(&mut self, bytes: u64) {
        self.bytes = (self.bytes + bytes).min(MAX_BYTES);
    }
}

fn mebibytes(bytes: u64) -> String {
    format!("{} MiB", bytes.div_ceil(1 << 20))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_meshes_count_once() {
        let mut budget = Budget::default();
        assert_eq!((budget.keep_mesh(7, 600_000), budget.keep_mesh(7, 600_000)), (Ok(()), Ok(())));
        let error = budget.keep_mesh(8, 500_000).unwrap_err();
        assert!(error.starts_with("has 500000 triangles, and 400000 of 1000000 are left"), "{error}");
        assert_eq!(budget.keep_mesh(9, 400_000), Ok(()));
    }

    #[test]
    fn what_is_taken_is_missing_and_comes_back() {
        let mut budget = Budget::default();
        assert_eq!(budget.take(MAX_BYTES, MAX_WORK_BYTES / 2), Ok(()));
        assert!(budget.take(1, 0).unwrap_err().starts_with("takes 1 MiB of memory, and 0 MiB of 512 MiB are left"));
        budget.give_back(MAX_BYTES);
        // Work that was done is done, whatever came of it.
        let error = budget.take(1, MAX_WORK_BYTES).unwrap_err();
        assert!(
            error.starts_with("holds 4096 MiB of numbers in all its channels, and 2048 MiB of 4096 MiB"),
            "{error}"
        );
        assert_eq!(budget.take(MAX_BYTES, MAX_WORK_BYTES / 2), Ok(()));
    }
}
