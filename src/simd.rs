//! The instruction sets that the evaluator's loops are compiled for, and the choice between them at run time.
//!
//! The same Rust source is compiled once for each set and vectorised by the compiler. Results are bit-identical; only
//! the speed differs.

use std::sync::OnceLock;

/// An instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Simd {
    /// The target's minimum: SSE2 on x86-64, NEON on aarch64.
    Baseline,
    Sse41,
    Avx2,
    Avx512,
}

impl Simd {
    /// The best set of this machine.
    pub fn detect() -> Simd {
        static BEST: OnceLock<Simd> = OnceLock::new();
        *BEST.get_or_init(|| Self::available().last().copied().unwrap_or(Simd::Baseline))
    }

    /// All sets of this machine, slowest first.
    pub fn available() -> Vec<Simd> {
        #[cfg_attr(not(target_arch = "x86_64"), allow(unused_mut))]
        let mut sets = vec![Simd::Baseline];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("sse4.1") {
                sets.push(Simd::Sse41);
            }
            if is_x86_feature_detected!("avx2") {
                sets.push(Simd::Avx2);
            }
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512vl")
            {
                sets.push(Simd::Avx512);
            }
        }
        sets
    }

    /// Short name, as in `tellus bench`.
    pub fn name(self) -> &'static str {
        match self {
            Simd::Baseline => "baseline",
            Simd::Sse41 => "sse4.1",
            Simd::Avx2 => "avx2",
            Simd::Avx512 => "avx512",
        }
    }
}

/// Compiles `$body`, an `#[inline(always)]` function, once for each instruction set. The function written, `$name`,
/// takes the set to use as its first argument; it may have one type parameter, which it hands to the body. Sets that
/// this machine lacks fall back to the baseline, so the call is always sound.
macro_rules! for_each_simd {
    ($(#[$meta:meta])* $vis:vis fn $name:ident<$param:ident: $bound:ident>($($arg:ident: $type:ty),* $(,)?) = $body:ident) => {
        for_each_simd!(@ [$(#[$meta])* $vis] $name [<$param: $bound>] [::<$param>] ($($arg: $type),*) [$body::<$param>]);
    };
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),* $(,)?) = $body:expr) => {
        for_each_simd!(@ [$(#[$meta])* $vis] $name [] [] ($($arg: $type),*) [$body]);
    };
    (@ [$($head:tt)*] $name:ident [$($generics:tt)*] [$($turbofish:tt)*] ($($arg:ident: $type:ty),*) [$($body:tt)*]) => {
        #[allow(clippy::too_many_arguments)]
        $($head)* fn $name $($generics)* (simd: $crate::simd::Simd, $($arg: $type),*) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "sse4.1")]
                fn sse41 $($generics)* ($($arg: $type),*) { $($body)*($($arg),*) }
                #[target_feature(enable = "avx2")]
                fn avx2 $($generics)* ($($arg: $type),*) { $($body)*($($arg),*) }
                #[target_feature(enable = "avx512f,avx512dq,avx512bw,avx512vl")]
                fn avx512 $($generics)* ($($arg: $type),*) { $($body)*($($arg),*) }
                use $crate::simd::Simd;
                if simd > Simd::Baseline && simd <= Simd::detect() {
                    // SAFETY: `simd` is at most the set that was detected on this machine, and each set
                    // includes the ones before.
                    unsafe {
                        match simd {
                            Simd::Sse41 => return sse41 $($turbofish)* ($($arg),*),
                            Simd::Avx2 => return avx2 $($turbofish)* ($($arg),*),
                            Simd::Avx512 => return avx512 $($turbofish)* ($($arg),*),
                            Simd::Baseline => {}
                        }
                    }
                }
            }
            let _ = simd;
            $($body)*($($arg),*);
        }
    };
}
pub(crate) use for_each_simd;
