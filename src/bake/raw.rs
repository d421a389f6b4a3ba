//! Maps as whole numbers of 16 bits without a header, little-endian: what the landscapes of Unreal and Unity import.

use super::format::{Shape, Source};
use std::io::{self, BufWriter, Write};

/// Writes a picture.
pub(super) fn write(out: impl Write, shape: &Shape, rows: &mut dyn Source) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    let mut values = Vec::new();
    for _ in 0..shape.height {
        rows.read(1, &mut values)?;
        values.iter().try_for_each(|&value| out.write_all(&shape.steps.number(value).to_le_bytes()))?;
    }
    out.flush()
}
