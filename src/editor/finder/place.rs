//! A location as people write it: `12.5 N 45 W`, `12.5, -45`, `12°30'N 45°W`, with an altitude `@ 400 km`.

use crate::editor::widgets::number::{format_digits, length_text, read_number};
use crate::planet::param::Unit;
use std::fmt;

/// Lowest and highest altitude, metres.
const ALTITUDES_M: (f64, f64) = (1.0, 1e9);
const EXAMPLE: &str = "write 12.5 N 45 W or 12.5, -45";

/// A location to go to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Degrees north of the equator.
    pub lat_deg: f64,
    /// Degrees east of the prime meridian, above -180 to 180.
    pub lon_deg: f64,
    /// Height above the ground or the sea, whichever is higher; None keeps the height.
    pub altitude_m: Option<f64>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |f: &mut fmt::Formatter<'_>, deg: f64, letters: [char; 2]| {
            let letter = letters[usize::from(deg < 0.0)];
            write!(f, "{}°{letter}", format_digits((deg.abs() * 1e6).round() / 1e6, 9))
        };
        part(f, self.lat_deg, ['N', 'S'])?;
        f.write_str(" ")?;
        part(f, self.lon_deg, ['E', 'W'])?;
        self.altitude_m.map_or(Ok(()), |altitude_m| write!(f, " at {}", length_text(altitude_m)))
    }
}

/// A sign of a location.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sign {
    Number {
        value: f64,
        whole: bool,
    },
    /// ° ' or ".
    Mark(char),
    /// N, S, E or W.
    Letter(char),
    Comma,
}

/// Reads a location.
///
/// # Errors
/// What is wrong with the text, and what would be right.
pub fn read(text: &str) -> Result<Place, String> {
    let (location, altitude) = match text.split_once('@') {
        Some((location, altitude)) => (location, Some(altitude)),
        None => (text, None),
    };
    let signs = signs(location)?;
    if signs.is_empty() {
        return Err(format!("There is no location yet: {EXAMPLE}"));
    }
    let (first, second) = halves(&signs)?;
    let (first, second) = (angle(first)?, angle(second)?);
    let swapped = matches!(first.1, Some('E' | 'W')) || matches!(second.1, Some('N' | 'S'));
    let (lat, lon) = if swapped { (second, first) } else { (first, second) };
    if matches!(lat.1, Some('E' | 'W')) || matches!(lon.1, Some('N' | 'S')) {
        return Err("A location has one latitude, N or S, and one longitude, E or W".to_owned());
    }
    if lat.0.abs() > 90.0 {
        return Err(format!("The latitude {} is beyond a pole: use 0 to 90 N or S", lat.0.abs()));
    }
    if lon.0.abs() > 360.0 {
        return Err(format!("The longitude {} is more than a turn: use 0 to 180 E or W, or 0 to 360", lon.0.abs()));
    }
    let lon_deg = if lon.0 > 180.0 {
        lon.0 - 360.0
    } else if lon.0 <= -180.0 {
        lon.0 + 360.0
    } else {
        lon.0
    };
    let altitude_m = altitude.map(read_altitude).transpose()?;
    // Adding zero turns "-0" into "0".
    Ok(Place { lat_deg: lat.0 + 0.0, lon_deg: lon_deg + 0.0, altitude_m })
}

fn read_altitude(text: &str) -> Result<f64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("The altitude is missing after @: write @ 400 km".to_owned());
    }
    if text.parse::<f64>().is_ok() {
        return Err(format!("The altitude needs a unit: write @ {text} km or @ {text} m"));
    }
    let altitude_m = read_number(text, Unit::Metres, None).map_err(|why| format!("The altitude: {why}"))?;
    let (least, most) = ALTITUDES_M;
    if altitude_m < least {
        return Err(format!("The altitude {} is too low: use 1 m or more", length_text(altitude_m)));
    }
    if altitude_m > most {
        return Err(format!("The altitude {} is too high: use at most 1000000 km", length_text(altitude_m)));
    }
    Ok(altitude_m)
}

/// Splits a text into signs.
fn signs(text: &str) -> Result<Vec<Sign>, String> {
    let mut signs = Vec::new();
    let text: Vec<char> = text.to_uppercase().replace("''", "\"").chars().collect();
    let mut at = 0;
    while let Some(&c) = text.get(at) {
        let run = |fits: fn(&char) -> bool| text[at..].iter().take_while(|c| fits(c)).collect::<String>();
        let mut length = 1;
        match c {
            c if c.is_whitespace() => {}
            ',' | ';' => signs.push(Sign::Comma),
            '°' | 'º' | '˚' => signs.push(Sign::Mark('°')),
            '\'' | '′' | '’' => signs.push(Sign::Mark('\'')),
            '"' | '″' | '”' => signs.push(Sign::Mark('"')),
            c if c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | '−') => {
                let number = run(|c| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | '−'));
                length = number.chars().count();
                let plain = number.replace('−', "-");
                let value = plain.parse().map_err(|_| format!("\"{number}\" is not a number: {EXAMPLE}"))?;
                // "-0°30'" keeps its sign.
                signs.push(Sign::Number { value, whole: !plain.contains('.') });
            }
            c if c.is_alphabetic() => {
                let word = run(|c| c.is_alphabetic());
                length = word.chars().count();
                signs.push(match word.as_str() {
                    "N" | "NORTH" => Sign::Letter('N'),
                    "S" | "SOUTH" => Sign::Letter('S'),
                    "E" | "EAST" => Sign::Letter('E'),
                    "W" | "WEST" => Sign::Letter('W'),
                    "DEG" | "D" => Sign::Mark('°'),
                    "MIN" => Sign::Mark('\''),
                    "SEC" => Sign::Mark('"'),
                    _ => return Err(format!("\"{}\" is no direction: use N, S, E or W", word.to_lowercase())),
                });
            }
            other => return Err(format!("\"{other}\" has no place in a location: {EXAMPLE}")),
        }
        at += length;
    }
    Ok(signs)
}

/// The signs of the two angles.
fn halves(signs: &[Sign]) -> Result<(&[Sign], &[Sign]), String> {
    let places = |is: fn(&Sign) -> bool| signs.iter().enumerate().filter(move |(_, sign)| is(sign)).map(|(i, _)| i);
    let commas: Vec<usize> = places(|sign| *sign == Sign::Comma).collect();
    let letters: Vec<usize> = places(|sign| matches!(sign, Sign::Letter(_))).collect();
    let degrees: Vec<usize> = places(|sign| *sign == Sign::Mark('°')).collect();
    let numbers: Vec<usize> = places(|sign| matches!(sign, Sign::Number { .. })).collect();
    let parts = |split: usize| (&signs[..split], &signs[split..]);
    match (commas.as_slice(), letters.as_slice()) {
        ([comma], _) => Ok((&signs[..*comma], &signs[comma + 1..])),
        ([_, ..], _) => Err(format!("One comma separates latitude and longitude: {EXAMPLE}")),
        // "N 12 W 45" or "12 N 45 W".
        ([], [0, second]) => Ok(parts(*second)),
        ([], [first, _]) => Ok(parts(first + 1)),
        ([], _) => match (degrees.as_slice(), numbers.as_slice()) {
            ([_, second], _) => Ok(parts(second - 1)),
            (_, [_, second]) => Ok(parts(*second)),
            (_, [_]) => Err("The longitude is missing: a location is a latitude and a longitude".to_owned()),
            _ => Err(format!("It is not clear where the longitude begins: {EXAMPLE}")),
        },
    }
}

/// Whether a letter comes before the numbers.
fn leads(signs: &[Sign]) -> bool {
    matches!(signs.first(), Some(Sign::Letter(_)))
}

/// An angle in degrees, with its letter.
fn angle(signs: &[Sign]) -> Result<(f64, Option<char>), String> {
    let mut letter = None;
    let mut parts: Vec<(f64, bool, Option<char>)> = Vec::new();
    for sign in signs {
        match sign {
            Sign::Letter(found) if letter.is_some() => return Err(format!("There is one letter too many: {found}")),
            Sign::Letter(found) => letter = Some(*found),
            // "N 5" and "5 N" are angles, "5 N 45" is not.
            Sign::Number { .. } if letter.is_some() && !parts.is_empty() && !leads(signs) => {
                return Err(format!("There is a number too many: {EXAMPLE}, with a point for decimals"));
            }
            Sign::Number { value, whole } => parts.push((*value, *whole, None)),
            Sign::Mark(mark) => match parts.last_mut() {
                Some((.., unset @ None)) => *unset = Some(*mark),
                _ => return Err(format!("{mark} belongs behind a number: {EXAMPLE}")),
            },
            Sign::Comma => {}
        }
    }
    let Some((first, ..)) = parts.first().copied() else { return Err(format!("A number is missing: {EXAMPLE}")) };
    let negative = first.is_sign_negative();
    if negative && letter.is_some() {
        return Err("Use a minus sign or a letter, not both".to_owned());
    }
    if parts.len() > 3 {
        return Err("An angle has degrees, minutes and seconds at most".to_owned());
    }
    let mut deg = 0.0;
    for (i, ((value, whole, mark), (name, unit))) in
        parts.iter().zip([('°', 1.0), ('\'', 60.0), ('"', 3600.0)]).enumerate()
    {
        if mark.is_some_and(|mark| mark != name) {
            return Err("Degrees come first, then minutes ', then seconds \"".to_owned());
        }
        if i > 0 && !(0.0..60.0).contains(value) {
            let name = if i == 1 { "Minutes" } else { "Seconds" };
            return Err(format!("{name} are 0 to 59, not {value}"));
        }
        if !whole && i + 1 < parts.len() {
            return Err(format!("{value} has a fraction: only the last number of an angle may"));
        }
        deg += value.abs() / unit;
    }
    let negative = negative || matches!(letter, Some('S' | 'W'));
    Ok((if negative { -deg } else { deg }, letter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(text: &str) -> (f64, f64, Option<f64>) {
        let place = read(text).unwrap_or_else(|why| panic!("{text}: {why}"));
        (place.lat_deg, place.lon_deg, place.altitude_m)
    }

    #[test]
    fn locations_are_read_as_people_write_them() {
        for text in [
            "12.5 N 45 W",
            "12.5, -45",
            "12.5 -45",
            "12°30'N 45°W",
            "12° 30' N, 45° 0' 0\" W",
            "12 30 N 45 0 W",
            "N 12.5 W 45",
            "45 W 12.5 N",
            "12.5°n45°w",
            "12.5; 315",
            "12°30′00″ −45°",
            "12.500° N 45.000° W",
            "+12.5 north 45 west",
        ] {
            assert_eq!(at(text), (12.5, -45.0, None), "{text}");
        }
        assert_eq!(at("-0°30', 0"), (-0.5, 0.0, None));
        assert_eq!(at("90 S 180 W").1, 180.0, "one way to write that meridian");
    }

    #[test]
    fn an_altitude_follows_the_location() {
        assert_eq!(at("12.5 N 45 W @ 400 km").2, Some(400_000.0));
        assert_eq!(at("1,2@2m").2, Some(2.0));
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, why) in [
            ("", "There is no location yet"),
            ("12.5", "The longitude is missing"),
            ("12.5 N", "The longitude is missing"),
            ("95 N 0 E", "The latitude 95 is beyond a pole"),
            ("0, 400", "The longitude 400 is more than a turn"),
            ("5 N 6 N", "one latitude"),
            ("-5 N 6 E", "a minus sign or a letter, not both"),
            ("5 X 6 E", "\"x\" is no direction"),
            ("1 2 3 4", "not clear where the longitude begins"),
            ("1, 2, 3", "One comma"),
            ("12,5 N 45", "a point for decimals"),
            ("12,5 N 45 W", "a point for decimals"),
            ("12°75' 3°", "Minutes are 0 to 59, not 75"),
            ("12.5°30' 3°", "only the last number"),
            ("1.2.3, 4", "\"1.2.3\" is not a number"),
            ("1, 2 @", "The altitude is missing"),
            ("1, 2 @ 400", "needs a unit"),
            ("1, 2 @ 4 parsecs", "is not in m"),
            ("1, 2 @ 0 km", "too low"),
            ("1, 2 @ 1e12 km", "too high"),
            ("1 & 2", "\"&\" has no place"),
            (",", "A number is missing"),
        ] {
            let said = read(text).expect_err(text);
            assert!(said.contains(why), "{text}: {said}");
        }
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_back(lat in -90_000_000_i32..=90_000_000, lon in -179_999_999_i32..=180_000_000) {
            let place = Place { lat_deg: f64::from(lat) / 1e6, lon_deg: f64::from(lon) / 1e6, altitude_m: None };
            let back = read(&place.to_string()).unwrap();
            prop_assert!((back.lat_deg - place.lat_deg).abs() < 1e-6, "{place}");
            prop_assert!((back.lon_deg - place.lon_deg).abs() < 1e-6, "{place}");
        }

        #[test]
        fn no_text_is_too_odd(text in "[0-9NSEWnm°'\"., @+-]{0,14}|.{0,20}") {
            if let Ok(place) = read(&text) {
                prop_assert!(place.lat_deg.abs() <= 90.0 && place.lon_deg > -180.0 && place.lon_deg <= 180.0);
            }
        }
    }
}
