//! Numbers of a buffer, as an accessor lays them out. Nothing that the file says of lengths and offsets is believed.

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};

/// Elements of an accessor as numbers of 32 bits, `N` for each: those that it lacks are `rest`. Normalised integers
/// become shares.
pub(super) fn floats<const N: usize>(
    accessor: &Accessor<'_>,
    buffers: &[Vec<u8>],
    most: usize,
    rest: f32,
) -> Result<Vec<[f32; N]>, String> {
    let (kind, norm) = (accessor.data_type(), accessor.normalized());
    let read = |bytes: &[u8]| {
        let share = |value: f32, most: f32| if norm { (value / most).max(-1.0) } else { value };
        match (kind, bytes) {
            (DataType::I8, &[a]) => share(f32::from(a as i8), 127.0),
            (DataType::U8, &[a]) => share(f32::from(a), 255.0),
            (DataType::I16, &[a, b]) => share(f32::from(i16::from_le_bytes([a, b])), 32_767.0),
            (DataType::U16, &[a, b]) => share(f32::from(u16::from_le_bytes([a, b])), 65_535.0),
            (DataType::U32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as f32,
            (DataType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            _ => f32::NAN,
        }
    };
    let width = kind.size();
    let elements = elements(accessor, buffers, most)?;
    let of = |element: &[u8]| {
        let mut out = [rest; N];
        out.iter_mut().zip(element.chunks_exact(width)).for_each(|(out, bytes)| *out = read(bytes));
        out
    };
    Ok(elements.into_iter().map(of).collect())
}

/// Elements of an accessor as indices.
pub(super) fn indices(accessor: &Accessor<'_>, buffers: &[Vec<u8>], most: usize) -> Result<Vec<u32>, String> {
    let read = |bytes: &[u8]| match *bytes {
        [a] => Ok(u32::from(a)),
        [a, b] => Ok(u32::from(u16::from_le_bytes([a, b]))),
        [a, b, c, d] => Ok(u32::from_le_bytes([a, b, c, d])),
        _ => Err("has indices that are no whole numbers; export it anew".to_owned()),
    };
    if !matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32)
        || accessor.dimensions() != Dimensions::Scalar
    {
        return read(&[]).map(|_| Vec::new());
    }
    elements(accessor, buffers, most)?.into_iter().map(read).collect()
}

/// The bytes of each element.
fn elements<'a>(accessor: &Accessor<'_>, buffers: &'a [Vec<u8>], most: usize) -> Result<Vec<&'a [u8]>, String> {
    if accessor.sparse().is_some() {
        return Err("has sparse accessors, which are not read; export it without".to_owned());
    }
    let count = accessor.count();
    if count > most {
        return Err(format!("has {count} numbers in one accessor; use a mesh of at most {} triangles", most / 3));
    }
    let broken = || format!("is broken: accessor {} lies outside its buffer; export it anew", accessor.index());
    let view = accessor.view().ok_or_else(broken)?;
    let whole = buffers.get(view.buffer().index()).ok_or_else(broken)?;
    let end = view.offset().checked_add(view.length()).ok_or_else(broken)?;
    let bytes = whole.get(view.offset()..end).and_then(|bytes| bytes.get(accessor.offset()..)).ok_or_else(broken)?;
    let size = accessor.size();
    let stride = view.stride().unwrap_or(size).max(1);
    let element = |i: usize| {
        let start = i.checked_mul(stride)?;
        bytes.get(start..start.checked_add(size)?)
    };
    (0..count).map(|i| element(i).ok_or_else(broken)).collect()
}
