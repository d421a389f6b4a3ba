//! Arithmetic in number fields: `3600*2`, `1/3`, `(6371+400)/2`.

/// The value of a text of numbers, `+ - * / ^` and parentheses.
///
/// # Errors
/// What is wrong with the text.
pub fn evaluate(text: &str) -> Result<f64, String> {
    let mut reader = Reader { text: text.chars().filter(|c| !c.is_whitespace()).collect(), at: 0, depth: 0 };
    let value = reader.sum()?;
    match reader.peek() {
        None => Ok(value),
        Some(')') => Err("there is a ) without a (".to_owned()),
        Some(_) => Err(format!("{:?} is not a number", reader.rest())),
    }
}

/// Most parentheses and signs inside each other.
const MOST_DEPTH: usize = 32;

struct Reader {
    text: Vec<char>,
    at: usize,
    depth: usize,
}

impl Reader {
    fn peek(&self) -> Option<char> {
        self.text.get(self.at).copied()
    }

    fn rest(&self) -> String {
        self.text[self.at..].iter().collect()
    }

    /// Takes the next character if it is one of these.
    fn take(&mut self, any: &[char]) -> Option<char> {
        let next = self.peek().filter(|c| any.contains(c))?;
        self.at += 1;
        Some(next)
    }

    fn sum(&mut self) -> Result<f64, String> {
        let mut value = self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            let other = self.product()?;
            value = if sign == '+' { value + other } else { value - other };
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<f64, String> {
        let mut value = self.signed()?;
        while let Some(sign) = self.take(&['*', '/', '×', '÷']) {
            let other = self.signed()?;
            value = if matches!(sign, '*' | '×') { value * other } else { value / other };
        }
        Ok(value)
    }

    fn signed(&mut self) -> Result<f64, String> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return Err("there are too many parentheses".to_owned());
        }
        let value = match self.take(&['+', '-']) {
            Some('-') => self.signed().map(|value| -value),
            Some(_) => self.signed(),
            None => self.power(),
        };
        self.depth -= 1;
        value
    }

    fn power(&mut self) -> Result<f64, String> {
        let base = self.number()?;
        match self.take(&['^']) {
            Some(_) => Ok(libm::pow(base, self.signed()?)),
            None => Ok(base),
        }
    }

    fn number(&mut self) -> Result<f64, String> {
        if self.take(&['(']).is_some() {
            let value = self.sum()?;
            return match self.take(&[')']) {
                Some(_) => Ok(value),
                None => Err("a ) is missing".to_owned()),
            };
        }
        let Some(first) = self.peek() else {
            let before = self.at.checked_sub(1).and_then(|at| self.text.get(at));
            return Err(
                before.map_or("nothing was typed".to_owned(), |sign| format!("a number is missing after {sign}"))
            );
        };
        // The longest text that is a number: "1e3" has an exponent, "1e" has not.
        let rest = &self.text[self.at..];
        let length = rest.iter().take_while(|c| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-')).count();
        let number = |length: &usize| rest[..*length].iter().collect::<String>().parse::<f64>().ok();
        let found = (1..=length).rev().find_map(|length| Some((length, number(&length)?)));
        match found.filter(|_| first.is_ascii_digit() || first == '.') {
            Some((length, value)) => {
                self.at += length;
                Ok(value)
            }
            None => Err(format!("{:?} is not a number", self.rest())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn arithmetic_follows_the_usual_order() {
        for (text, value) in [
            ("3600*2", 7200.0),
            ("1/4", 0.25),
            ("1 + 2 * 3", 7.0),
            ("(1+2)*3", 9.0),
            ("2^3^2", 512.0),
            ("-2^2", -4.0),
            ("2*-3", -6.0),
            ("1e3-1e-3", 999.999),
            ("10-4-3", 3.0),
            (".5×4÷2", 1.0),
        ] {
            assert_eq!(evaluate(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, why) in [
            ("3600*", "a number is missing after *"),
            ("(1+2", "a ) is missing"),
            ("1+2)", "there is a ) without a ("),
            ("2*x", "\"x\" is not a number"),
            ("2x", "\"x\" is not a number"),
            ("", "nothing was typed"),
            (&"(".repeat(99), "there are too many parentheses"),
        ] {
            assert_eq!(evaluate(text), Err(why.to_owned()), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_is_too_odd(text in "[0-9.eE+*/^() -]{0,40}") {
            let _ = evaluate(&text);
        }

        #[test]
        fn a_number_is_its_own_value(value in -1e12..1e12_f64) {
            prop_assert_eq!(evaluate(&value.to_string()), Ok(value));
            prop_assert_eq!(evaluate(&format!("{value:e}")), Ok(value));
        }
    }
}
