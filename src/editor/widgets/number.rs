//! Numbers as text: short, with an optional unit.

use super::arithmetic::{Context, evaluate};
use crate::planet::param::Unit;

/// A number with about five significant digits and no trailing zeros.
pub fn format_number(value: f64) -> String {
    format_digits(value, 5)
}

/// A number with about this many significant digits and no trailing zeros.
pub fn format_digits(value: f64, digits: i32) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".to_owned();
    }
    let digits_before_point = magnitude.log10().floor() as i32 + 1;
    let decimals = (digits - digits_before_point).clamp(0, 9) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text.is_empty() || text == "-0" || text == "0" { format!("{value:e}") } else { text.to_owned() }
}

/// Reads a number or a calculation with optional units, and converts it to `unit`: `"1.5 km"` is 1500 for metres. `now`
/// is the number that is there, for texts that change it: `"*1.5"`.
///
/// # Errors
/// Why the text is no such number.
pub fn read_number(typed: &str, unit: Unit, now: Option<f64>) -> Result<f64, String> {
    let typed = typed.trim();
    let text = typed.replace('−', "-");
    if text.is_empty() {
        return Err("nothing was typed".to_owned());
    }
    let units = units_read(unit);
    let finite = |value: f64| match value.is_finite() {
        true => Ok(value),
        false => Err(format!("{typed:?} is not a finite number")),
    };
    // A unit at the end of a calculation without others belongs to all of it: `100/3 km`.
    for (symbol, factor) in units.iter().filter(|(symbol, _)| !symbol.is_empty()) {
        let Some(number) = text.strip_suffix(symbol).filter(|number| !number.trim().is_empty()) else { continue };
        if let Ok(value) = evaluate(number, Context::default()) {
            return finite(value * factor);
        }
    }
    let why = match evaluate(&text, Context { units: &units, now }) {
        Ok(value) => return finite(value),
        Err(why) => why,
    };
    let calculates = text.trim_start_matches(['-', '+']).contains(['+', '*', '/', '(', ')', '^', '×', '÷', '=']);
    let has_number = text.trim_start_matches(['-', '+', '.', '(']).starts_with(|c: char| c.is_ascii_digit());
    Err(match unit {
        _ if calculates => format!("{typed:?}: {why}"),
        _ if !has_number => format!("{typed:?} is not a number"),
        Unit::None => format!("{typed:?} has a unit, but this is a plain number"),
        _ => format!("{typed:?} is not in {}", unit.symbol()),
    })
}

/// The units that a number may have, with their factors; longer ones come before their own beginnings and ends.
fn units_read(unit: Unit) -> Vec<(&'static str, f64)> {
    let others: &[(&str, f64)] = match unit {
        Unit::Metres => &[("km", 1000.0), ("cm", 0.01), ("mm", 0.001), ("mi", 1609.344), ("ft", 0.3048)],
        Unit::Kilometres => &[("km", 1.0), ("mi", 1.609_344), ("ft", 0.000_304_8), ("m", 0.001)],
        Unit::Millimetres => &[("mm", 1.0), ("cm", 10.0), ("ft", 304.8), ("m", 1000.0)],
        Unit::Degrees => &[("deg", 1.0), ("rad", 180.0 / std::f64::consts::PI)],
        Unit::Celsius => &[("°C", 1.0), ("°", 1.0), ("C", 1.0)],
        Unit::MetresPerSecond => &[("km/h", 1.0 / 3.6), ("mph", 0.447_04), ("kn", 1.852 / 3.6)],
        Unit::KilometresPerHour => &[("m/s", 3.6), ("mph", 1.609_344), ("kn", 1.852)],
        Unit::PerKilometre => &[("1/m", 1000.0)],
        Unit::PerMetre => &[("1/km", 0.001)],
        _ => &[],
    };
    others.iter().copied().chain([(unit.symbol(), 1.0), ("", 1.0)]).collect()
}

/// The unit as a suffix of a number.
pub fn suffix(unit: Unit) -> String {
    match unit.symbol() {
        "" => String::new(),
        "°" => "°".to_owned(),
        symbol => format!(" {symbol}"),
    }
}

/// A length for reading: millimetres to thousands of kilometres.
pub fn length_text(metres: f64) -> String {
    if metres.abs() >= 10_000.0 {
        format!("{} km", round_to(metres / 1000.0, if metres.abs() < 100_000.0 { 1 } else { 0 }))
    } else {
        format!("{} m", round_to(metres, if metres.abs() < 10.0 { 1 } else { 0 }))
    }
}

/// The longest of 1, 2, 5, 10, ... that is not above `most_m`.
pub fn round_length_m(most_m: f64) -> f64 {
    let ten = 10_f64.powf(most_m.max(1e-3).log10().floor());
    [5.0, 2.0].into_iter().map(|step| step * ten).find(|length_m| *length_m <= most_m).unwrap_or(ten)
}

fn round_to(value: f64, decimals: usize) -> String {
    // Adding zero turns "-0" into "0".
    let scale = 10f64.powi(decimals as i32);
    format!("{:.decimals$}", (value * scale).round() / scale + 0.0)
}

/// Megabytes of 2^20 bytes.
pub fn megabytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in
            [(0.0, "0"), (1.0, "1"), (0.005802, "0.005802"), (6371.0, "6371"), (100000.0, "100000"), (-12.5, "-12.5")]
        {
            assert_eq!(format_number(value), text);
        }
        assert_eq!(format_number(1.0 / 3.0), "0.33333");
        assert_eq!(format_number(1e-12), "1e-12");
    }

    #[test]
    fn units_are_understood() {
        assert_eq!(read_number("1.5 km", Unit::Metres, None), Ok(1500.0));
        assert_eq!(read_number("1e3m", Unit::Metres, None), Ok(1000.0));
        assert_eq!(read_number("500 m", Unit::Kilometres, None), Ok(0.5));
        assert_eq!(read_number("−12 °C", Unit::Celsius, None), Ok(-12.0));
        assert_eq!(read_number("3", Unit::None, None), Ok(3.0));
        assert_eq!(read_number("0.5 1/km", Unit::PerKilometre, None), Ok(0.5));
        assert_eq!(read_number("36 km/h", Unit::MetresPerSecond, None), Ok(10.0));
        assert_eq!(read_number("(1+2)*2 km", Unit::Metres, None), Ok(6000.0));
        assert_eq!(read_number("1/4", Unit::None, None), Ok(0.25));
        assert_eq!(read_number("3 km + 200 m", Unit::Metres, None), Ok(3200.0));
        assert_eq!(read_number("*2", Unit::Metres, Some(150.0)), Ok(300.0));
        assert_eq!(read_number("100/4 km", Unit::Metres, None), Ok(25_000.0));
        assert_eq!(read_number("3600*", Unit::None, None), Err("\"3600*\": a number is missing after *".to_owned()));
        assert_eq!(read_number("1/0", Unit::None, None), Err("\"1/0\" is not a finite number".to_owned()));
        for bad in ["", "km", "3 parsecs", "NaN", "inf"] {
            assert!(read_number(bad, Unit::Kilometres, None).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn lengths_are_readable() {
        assert_eq!(length_text(0.04), "0.0 m");
        assert_eq!(length_text(-0.04), "0.0 m");
        assert_eq!(length_text(8848.2), "8848 m");
        assert_eq!(length_text(12_742_000.0), "12742 km");
    }

    #[test]
    fn a_scale_has_a_round_length() {
        for (most, round) in [(130.0, 100.0), (250.0, 200.0), (999.0, 500.0), (1.0, 1.0), (0.7, 0.5)] {
            assert!((round_length_m(most) - round).abs() < 1e-9, "{most}");
        }
    }
}
