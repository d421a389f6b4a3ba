//! Parsers of sizes, angles and locations on the command line. Each error says what would be right.

use crate::giant::DEEPEST_M;
use crate::planet::printable::number_text;
use crate::render::Post;
use std::fmt::Display;
use std::str::FromStr;

/// Largest side of a picture, in pixels.
const MAX_SIDE: u32 = 32_768;
/// Most pixels of a picture: they take 12 bytes each.
const MAX_PIXELS: u64 = 1 << 28;

/// Most parts of a bake.
const MOST_SHARDS: u32 = 65_536;

/// A finite number from `min` to `max`.
fn number(text: &str, min: f64, max: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= min && value <= max => Ok(value),
        Ok(value) => Err(format!("{} is out of range; use {min} to {max}", number_text(value))),
        Err(_) => Err(format!("this is not a number; use {min} to {max}")),
    }
}

/// A whole number from `min` to `max`.
pub(super) fn whole<T: FromStr + PartialOrd + Display + Copy>(text: &str, min: T, max: T) -> Result<T, String> {
    match (text.parse::<T>(), text.parse::<f64>()) {
        (Ok(value), _) if value >= min && value <= max => Ok(value),
        (_, Ok(number)) if number == number.trunc() => {
            Err(format!("{} is out of range; use {min} to {max}", number_text(number)))
        }
        _ => Err(format!("this is not a whole number; use {min} to {max}")),
    }
}

pub(super) fn latitude(text: &str) -> Result<f64, String> {
    number(text, -90.0, 90.0)
}

pub(super) fn longitude(text: &str) -> Result<f64, String> {
    number(text, -360.0, 360.0)
}

pub(super) fn heading(text: &str) -> Result<f64, String> {
    number(text, -360.0, 360.0)
}

pub(super) fn pitch(text: &str) -> Result<f64, String> {
    number(text, -90.0, 90.0)
}

pub(super) fn field_of_view(text: &str) -> Result<f64, String> {
    number(text, 1.0, 150.0)
}

/// Altitude in metres above the ground or the sea; negative: depth under the sea, or below a giant's cloud tops.
pub(super) fn altitude(text: &str) -> Result<f64, String> {
    match number(text, -DEEPEST_M, 1e12) {
        Ok(altitude_m) if altitude_m.abs() < 0.1 => {
            let altitude_m = number_text(altitude_m);
            Err(format!("{altitude_m} is on the surface; use 0.1 or more, or -0.1 or less for a depth under the sea"))
        }
        other => other,
    }
}

/// Height in metres above the reference sphere.
pub(super) fn height(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e12)
}

pub(super) fn zenith(text: &str) -> Result<f64, String> {
    number(text, 0.0, 180.0)
}

/// Focal length in mm in front of a sensor 24 mm high.
pub(super) fn focal_length(text: &str) -> Result<f64, String> {
    number(text, 4.0, 1300.0)
}

/// A height over the reference sphere, above or below it.
pub(super) fn level(text: &str) -> Result<f64, String> {
    number(text, -1e8, 1e8)
}

/// A length that may be 0.
pub(super) fn depth(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e12)
}

/// A factor on lengths.
pub(super) fn scale(text: &str) -> Result<f64, String> {
    number(text, 1e-9, 1e9)
}

/// A length in metres that is not 0.
pub(super) fn length(text: &str) -> Result<f64, String> {
    number(text, 1e-4, 1e12)
}

pub(super) fn samples(text: &str) -> Result<u32, String> {
    let wrong = || "use 1 to 16, the samples along each side of a pixel".to_owned();
    text.parse().ok().filter(|samples| (1..=16).contains(samples)).ok_or_else(wrong)
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    number(text, -1e9, 1e9)
}

/// The time for building the ground of a picture.
pub(super) fn ground_seconds(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e6)
}

/// The memory for the ground of a picture.
pub(super) fn ground_mib(text: &str) -> Result<u32, String> {
    let wrong = || "use 16 to 65536, in MiB".to_owned();
    text.parse().ok().filter(|mib| (16..=65_536).contains(mib)).ok_or_else(wrong)
}

/// The length of a trial of a system.
pub(super) fn years(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e6)
}

/// The length of a film.
pub(super) fn length_secs(text: &str) -> Result<f64, String> {
    number(text, 0.0, 3600.0)
}

pub(super) fn exposure(text: &str) -> Result<f64, String> {
    number(text, -20.0, 20.0)
}

pub(super) fn white(text: &str) -> Result<f64, String> {
    let (least, most) = Post::WHITE_K.into_inner();
    number(text, least, most)
}

pub(super) fn share(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1.0)
}

/// Discharge in cubic metres a second.
pub(super) fn discharge(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e12)
}

/// Length of a side of a region in kilometres.
pub(super) fn region(text: &str) -> Result<f64, String> {
    number(text, 1e-6, 1e6)
}

/// `MIN,MAX` in metres.
pub(super) fn heights(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "these are not two heights; write MIN,MAX in metres, such as -11000,9000".to_owned();
    let (min, max) = text.split_once(',').ok_or_else(wrong)?;
    let height = |text: &str| number(text.trim(), -1e6, 1e6);
    let [min, max] = [height(min)?, height(max)?];
    if min < max { Ok([min, max]) } else { Err(wrong()) }
}

/// `I/N`: part I of N, from 1.
pub(super) fn shard(text: &str) -> Result<(u32, u32), String> {
    let wrong = || format!("this is no shard; write I/N with I from 1 to N and N at most {MOST_SHARDS}, such as 2/8");
    let (number, count) = text.split_once('/').ok_or_else(wrong)?;
    let [number, count] = [number, count].map(|text| text.parse().ok());
    let (number, count) = number.zip(count).ok_or_else(wrong)?;
    if (1..=MOST_SHARDS).contains(&count) && (1..=count).contains(&number) { Ok((number, count)) } else { Err(wrong()) }
}

/// `LAT,LON` in degrees.
pub(super) fn location(text: &str) -> Result<(f64, f64), String> {
    let (lat, lon) = text.split_once(',').ok_or("this is not a location; write LAT,LON such as 20,-45")?;
    let lat = latitude(lat.trim()).map_err(|e| format!("latitude: {e}"))?;
    let lon = longitude(lon.trim()).map_err(|e| format!("longitude: {e}"))?;
    Ok((lat, lon))
}

/// `WIDTHxHEIGHT` in pixels.
pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("this is not a size; write WIDTHxHEIGHT, each 1 to {MAX_SIDE}, such as 1280x720");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side)).ok_or_else(wrong);
    let [width, height] = [side(width)?, side(height)?];
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "{width}x{height} are too many pixels; use at most {MAX_PIXELS} in all, such as 16384x16384"
        ));
    }
    Ok([width, height])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_or_refused_with_what_would_be_right() {
        assert_eq!(size("1x32768"), Ok([1, 32_768]));
        assert!(size("32768x32768").unwrap_err().contains("16384x16384"));
        assert!(samples("17").is_err() && samples("4") == Ok(4));
        for wrong in ["", "x", "0x5", "5", "32769x1", "-1x5", "1x2x3", "1.5x2", "99999999999x1"] {
            assert!(size(wrong).unwrap_err().contains("1280x720"), "{wrong}");
        }
        assert_eq!(location("-10, 30.5"), Ok((-10.0, 30.5)));
        assert_eq!(location("91,0"), Err("latitude: 91 is out of range; use -90 to 90".to_owned()));
        assert!(location("10").unwrap_err().contains("LAT,LON"));
        assert_eq!(latitude("1e300"), Err("1e300 is out of range; use -90 to 90".to_owned()));
        assert_eq!(whole("7", 1_u32, 9), Ok(7));
        for wrong in ["-7", "0", "10", "1e300", "99999999999999999999"] {
            assert!(whole(wrong, 1_u8, 9).unwrap_err().contains("is out of range; use 1 to 9"), "{wrong}");
        }
        for wrong in ["", "x", "1.5", "NaN"] {
            assert_eq!(whole(wrong, 1_u32, 9), Err("this is not a whole number; use 1 to 9".to_owned()), "{wrong}");
        }
        assert_eq!(latitude("NaN"), Err("NaN is out of range; use -90 to 90".to_owned()));
        assert_eq!(altitude("-20"), Ok(-20.0));
        assert_eq!((shard("2/8"), heights("-5, 7.5")), (Ok((2, 8)), Ok([-5.0, 7.5])));
        for wrong in ["0/3", "4/3", "1", "1/0", "-1/3", "1/2/3", "1/99999999"] {
            assert!(shard(wrong).unwrap_err().contains("2/8"), "{wrong}");
        }
        assert!(heights("7,7").is_err() && heights("7").is_err() && heights("low,7").is_err());
        assert!(latitude("north").is_err() && altitude("0").is_err() && altitude("inf").is_err());
    }
}
