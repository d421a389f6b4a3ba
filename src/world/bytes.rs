//! Numbers as bytes, little-endian: the content of maps on disk.

/// Writes numbers one after another.
#[derive(Default)]
pub(crate) struct Writer(pub(super) Vec<u8>);

impl Writer {
    pub(crate) fn u32(&mut self, value: u32) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    /// Values without their count.
    pub(crate) fn bytes(&mut self, values: impl IntoIterator<Item = u8>) {
        self.0.extend(values);
    }

    /// As [`Writer::bytes`].
    pub(crate) fn f32s(&mut self, values: impl IntoIterator<Item = f32>) {
        values.into_iter().for_each(|value| self.0.extend_from_slice(&value.to_le_bytes()));
    }

    /// As [`Writer::bytes`].
    pub(crate) fn f64s(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.0.extend_from_slice(&value.to_le_bytes()));
    }
}

/// Reads them back. None where bytes are missing, or a number is not finite: a file may be damaged.
pub(crate) struct Reader<'a>(pub(super) &'a [u8]);

impl<'a> Reader<'a> {
    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }

    pub(crate) fn f32s(&mut self, count: usize) -> Option<Vec<f32>> {
        let (numbers, _) = self.bytes(count.checked_mul(4)?)?.as_chunks();
        let values: Vec<f32> = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        values.iter().all(|value| value.is_finite()).then_some(values)
    }

    pub(crate) fn f64s(&mut self, count: usize) -> Option<Vec<f64>> {
        let (numbers, _) = self.bytes(count.checked_mul(8)?)?.as_chunks();
        let values: Vec<f64> = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
        values.iter().all(|value| value.is_finite()).then_some(values)
    }

    /// Whether everything was read.
    pub(crate) fn is_at_end(&self) -> bool {
        self.0.is_empty()
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.bytes(N)?.try_into().ok()
    }
}
