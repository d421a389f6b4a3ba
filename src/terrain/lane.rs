//! Chunks of points: fixed arrays with one number for each point, which the compiler vectorises.

/// Points worked on at a time: few enough for all arrays to stay in the first-level cache.
pub(crate) const CHUNK: usize = 256;

/// One number for each point of a chunk.
pub(crate) type Lane<T> = [T; CHUNK];

/// Coordinates of a chunk of points, each axis in its own slice of at most [`CHUNK`] numbers.
pub(crate) type Points3<'a> = [&'a [f64]; 3];
