//! Pseudo-random numbers, the same on every machine, rounded so that they read well in a file.

use crate::planet::param::{Domain, Param, Value};

/// Most that a variation moves the logarithm of a number whose slider is logarithmic: by a factor of 4.5.
const MOST_LOG: f64 = 1.5;

/// Rounds to three significant digits, to keep files readable.
pub(crate) fn three_digits(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let scale = libm::pow(10.0, 2.0 - libm::floor(libm::log10(value.abs())));
    (value * scale).round() / scale
}

/// Mixing step of SplitMix64 (Steele, Lea, Flood, Fast splittable pseudorandom number generators, 2014): a hash of
/// 64 bits.
pub(crate) fn mix_bits(bits: u64) -> u64 {
    let z = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// What SplitMix64 adds to its state from number to number: the golden ratio.
pub(crate) const GOLDEN_BITS: u64 = 0x9e37_79b9_7f4a_7c15;

/// SplitMix64.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN_BITS);
        mix_bits(self.0)
    }

    /// From 0 to below 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Rounded: tenths of small numbers, hundredths of smaller ones.
    pub(crate) fn rounded(&mut self, low: f64, high: f64) -> f64 {
        let step = if high - low > 5.0 { 1.0 } else { 100.0 };
        ((self.between(low, high) * step).round() / step).clamp(low, high)
    }

    pub(crate) fn rounded_log(&mut self, low: f64, high: f64) -> f64 {
        three_digits(libm::exp(self.between(libm::log(low), libm::log(high)))).clamp(low, high)
    }

    pub(crate) fn color(&mut self, low: [f64; 3], high: [f64; 3]) -> [f64; 3] {
        let mut color = low;
        for (component, high) in color.iter_mut().zip(high) {
            *component = three_digits(self.between(*component, high)).clamp(*component, high);
        }
        color
    }

    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    pub(crate) fn seed(&mut self) -> u32 {
        // Four digits suffice, and can be read out.
        (self.next() % 10_000) as u32
    }

    pub(crate) fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[(self.next() % from.len() as u64) as usize]
    }

    pub(crate) fn name(&mut self) -> String {
        const STARTS: &[&str] =
            &["Ar", "Bel", "Cal", "Dor", "El", "Fen", "Ish", "Kor", "Mir", "Nov", "Or", "Tal", "Ver"];
        const MIDDLES: &[&str] = &["a", "e", "i", "o", "u", "ae", "ia", "and", "ess", "ili", "or"];
        const ENDS: &[&str] = &["dia", "ra", "th", "lon", "mir", "nis", "ria", "s", "ta", "vos", "x"];
        [STARTS, MIDDLES, ENDS].map(|part| *self.pick(part)).concat()
    }

    /// A value moved by up to `strength` of its own size; `None` if it cannot move. Zero is a choice, not a size, and
    /// stays.
    pub(crate) fn moved(&mut self, param: &Param, value: &Value, strength: f64) -> Option<Value> {
        if strength == 0.0 {
            return None;
        }
        let by = self.between(-strength, strength);
        match (value, param.domain) {
            (Value::Number(v), Domain::Number { min, max, logarithmic: false }) => {
                Some(Value::Number(three_digits(v * (1.0 + by)).clamp(min, max)))
            }
            // Equal steps are equal ratios.
            (Value::Number(v), Domain::Number { min, max, logarithmic: true }) => {
                Some(Value::Number(three_digits(v * libm::exp(by * MOST_LOG)).clamp(min, max)))
            }
            (Value::Count(v), Domain::Count { min, max }) => {
                let moved = (f64::from(*v) * (1.0 + by)).round();
                Some(Value::Count((moved as u32).clamp(min, max)))
            }
            (Value::Count(_), Domain::Seed) => {
                let seed = self.seed();
                self.chance(strength * strength).then_some(Value::Count(seed))
            }
            (Value::Triple(v), Domain::Color | Domain::Triple { .. }) => {
                let max = if let Domain::Triple { max } = param.domain { max } else { 1.0 };
                // By ratio: coefficients differ by powers of ten, and grey stays nearly grey.
                let moved = v.map(|c| three_digits(c * (1.0 + self.between(-strength, strength))).clamp(0.0, max));
                Some(Value::Triple(moved))
            }
            _ => None,
        }
    }
}
