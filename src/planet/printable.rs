//! Text of strangers, as it may be shown: names of files and tokens of presets can hold commands for a terminal, and
//! marks that turn the direction of the text around them.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Whether a character commands a terminal. Ends of lines and tabs do no harm.
fn commands(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
}

/// Whether a character turns the direction of the text behind it (Unicode's bidirectional controls).
fn turns(c: char) -> bool {
    matches!(c, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A number in few digits, however great or small it is: `1e300` has 301.
pub(crate) fn number_text(number: f64) -> String {
    let is_plain = number == 0.0 || (1e-6..1e15).contains(&number.abs());
    if is_plain { number.to_string() } else { format!("{number:e}") }
}

/// A text with escapes in the place of such characters. Those of turning ones are JSON's, which the same text may be.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(|c| commands(c) || turns(c)) {
        return text.into();
    }
    let mut printable = String::with_capacity(text.len());
    for c in text.chars() {
        if commands(c) {
            printable.extend(c.escape_default());
        } else if turns(c) {
            // A string takes all that is written.
            let _ = write!(printable, "\\u{:04x}", u32::from(c));
        } else {
            printable.push(c);
        }
    }
    printable.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, -5.0, 1e9, 0.001, 1e300, -1.5e-300, 5e-324, f64::NAN, f64::NEG_INFINITY].map(number_text);
        assert_eq!(texts, ["0", "-5", "1000000000", "0.001", "1e300", "-1.5e-300", "5e-324", "NaN", "-inf"]);
    }

    #[test]
    fn what_commands_or_turns_is_escaped_and_nothing_else() {
        assert_eq!(printable("é: ‘a’\n\tb"), "é: ‘a’\n\tb");
        assert_eq!(printable("\u{1b}[31m\u{7}"), "\\u{1b}[31m\\u{7}");
        assert_eq!(printable("{\"a\": \"\u{202e}x\u{2069}\"}"), "{\"a\": \"\\u202ex\\u2069\"}");
    }
}
