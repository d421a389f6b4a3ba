//! Numbers as text: short, with an optional unit.

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

/// Reads a number with an optional unit, and converts it to `unit`: `"1.5 km"` is 1500 for metres.
///
/// # Errors
/// Why the text is no such number.
pub fn read_number(typed: &str, unit: Unit) -> Result<f64, String> {
    let typed = typed.trim();
    let text: String = typed.chars().filter(|c| !c.is_whitespace()).map(|c| if c == '−' { '-' } else { c }).collect();
    if text.is_empty() {
        return Err("nothing was typed".to_owned());
    }
    // The longest prefix that is a number: "1e3m" is 1000 m.
    let (number, rest) = text
        .char_indices()
        .map(|(i, c)| i + c.len_utf8())
        .rev()
        .find_map(|end| Some((text[..end].parse::<f64>().ok()?, &text[end..])))
        .ok_or_else(|| format!("{typed:?} is not a number"))?;
    let factor = match (unit, rest) {
        (_, "") => 1.0,
        (_, rest) if rest == unit.symbol() => 1.0,
        (Unit::Metres, "km") => 1000.0,
        (Unit::Metres, "cm") => 0.01,
        (Unit::Metres, "mm") | (Unit::Kilometres, "m") => 0.001,
        (Unit::Millimetres, "m") => 1000.0,
        (Unit::Millimetres, "cm") => 10.0,
        (Unit::Degrees, "deg") | (Unit::Celsius, "C" | "°") => 1.0,
        (Unit::MetresPerSecond, "km/h") => 1.0 / 3.6,
        (Unit::KilometresPerHour, "m/s") => 3.6,
        (Unit::PerKilometre, "1/m") => 1000.0,
        (Unit::PerMetre, "1/km") => 0.001,
        (Unit::None, _) => return Err(format!("{typed:?} has a unit, but this is a plain number")),
        _ => return Err(format!("{typed:?} is not in {}", unit.symbol())),
    };
    let value = number * factor;
    if value.is_finite() { Ok(value) } else { Err(format!("{typed:?} is not a finite number")) }
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
        assert_eq!(read_number("1.5 km", Unit::Metres), Ok(1500.0));
        assert_eq!(read_number("1e3m", Unit::Metres), Ok(1000.0));
        assert_eq!(read_number("500 m", Unit::Kilometres), Ok(0.5));
        assert_eq!(read_number("−12 °C", Unit::Celsius), Ok(-12.0));
        assert_eq!(read_number("3", Unit::None), Ok(3.0));
        for bad in ["", "km", "3 parsecs", "NaN", "inf"] {
            assert!(read_number(bad, Unit::Kilometres).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn lengths_are_readable() {
        assert_eq!(length_text(0.04), "0.0 m");
        assert_eq!(length_text(-0.04), "0.0 m");
        assert_eq!(length_text(8848.2), "8848 m");
        assert_eq!(length_text(12_742_000.0), "12742 km");
    }
}
