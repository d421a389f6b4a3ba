//! The number types that formulas are generic over: `f32` for speed, `f64` where the rounding of f32 would show.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The numbers that formulas are made of.
pub(crate) trait Scalar:
    Copy
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The least normal number above zero.
    const LEAST: Self;
    /// The greatest finite number.
    const MOST: Self;
    /// The nearest to a constant.
    fn of(v: f64) -> Self;
    /// A parameter, which is an f32 in every formula.
    fn from_f32(v: f32) -> Self;
    fn from_i32(v: i32) -> Self;
    fn abs(self) -> Self;
    fn max(self, low: Self) -> Self;
    fn min(self, high: Self) -> Self;
    fn clamp(self, low: Self, high: Self) -> Self;
    fn sqrt(self) -> Self;
    /// The nearest whole number, for numbers below 2^22.
    fn whole(self) -> Self;
}

macro_rules! scalar {
    ($number:ty, $rounder:expr) => {
        impl Scalar for $number {
            const LEAST: Self = <$number>::MIN_POSITIVE;
            const MOST: Self = <$number>::MAX;
            #[inline(always)]
            fn of(v: f64) -> Self {
                v as $number
            }
            #[inline(always)]
            fn from_f32(v: f32) -> Self {
                v.into()
            }
            #[inline(always)]
            fn from_i32(v: i32) -> Self {
                v as $number
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn max(self, low: Self) -> Self {
                self.max(low)
            }
            #[inline(always)]
            fn min(self, high: Self) -> Self {
                self.min(high)
            }
            #[inline(always)]
            fn clamp(self, low: Self, high: Self) -> Self {
                self.clamp(low, high)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn whole(self) -> Self {
                // Adding and subtracting it leaves no room for the fraction.
                (self + $rounder) - $rounder
            }
        }
    };
}
scalar!(f32, 12_582_912.0);
scalar!(f64, 6_755_399_441_055_744.0);
