//! Arithmetic in number fields: `3600*2`, `1/3`, `(6371+400)/2`, `3 km + 200 m`, `sqrt(2)`, and changes of the number
//! that is there: `*1.5`, `+=10%`.

/// What a text may refer to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Context<'a> {
    /// Units with the factors that turn them into that of the field; longer ones come before their own beginnings.
    pub units: &'a [(&'a str, f64)],
    /// The number that is there.
    pub now: Option<f64>,
}

/// The value of a text of numbers, `+ - * / ^`, parentheses, `sqrt`, `abs` and `pi`. A number with a unit counts in the
/// unit of the field, as numbers without one do that are added to it.
///
/// # Errors
/// What is wrong with the text.
pub fn evaluate(text: &str, context: Context<'_>) -> Result<f64, String> {
    let text = text.trim();
    if let Some(now) = context.now
        && let Some((sign, rest)) = change_of(text)
    {
        let share = rest.trim().strip_suffix('%');
        let by = read(share.unwrap_or(rest), context)?;
        let by = if share.is_some() { by / 100.0 } else { by };
        return Ok(match sign {
            '+' if share.is_some() => now + now * by,
            '-' if share.is_some() => now - now * by,
            '+' => now + by,
            '-' => now - by,
            '*' => now * by,
            _ => now / by,
        });
    }
    read(text, context)
}

/// The sign and the operand of a text that changes the number that is there: `*2`, `+=5`. `-5` is a number.
fn change_of(text: &str) -> Option<(char, &str)> {
    let (first, rest) = text.split_at_checked(text.chars().next()?.len_utf8())?;
    let sign = match first.chars().next()? {
        '*' | '×' => '*',
        '/' | '÷' => '/',
        sign @ ('+' | '-') if rest.starts_with('=') => sign,
        _ => return None,
    };
    Some((sign, rest.strip_prefix('=').unwrap_or(rest)))
}

fn read(text: &str, context: Context<'_>) -> Result<f64, String> {
    let mut reader = Reader { text: text.chars().collect(), at: 0, depth: 0, context };
    let quantity = reader.sum()?;
    match reader.peek() {
        None if !matches!(quantity.power, 0 | 1) => Err("units are multiplied or divided".to_owned()),
        None => Ok(quantity.value),
        Some(')') => Err("there is a ) without a (".to_owned()),
        Some(_) => Err(format!("{:?} is not a number", reader.rest())),
    }
}

/// Most parentheses and signs inside each other.
const MOST_DEPTH: usize = 32;

/// A number, in the unit of the field to some power.
#[derive(Clone, Copy, Debug)]
struct Quantity {
    value: f64,
    power: i32,
}

impl Quantity {
    fn plain(value: f64) -> Self {
        Self { value, power: 0 }
    }
}

struct Reader<'a> {
    text: Vec<char>,
    at: usize,
    depth: usize,
    context: Context<'a>,
}

impl Reader<'_> {
    /// The next character that is not blank.
    fn peek(&mut self) -> Option<char> {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn rest(&self) -> String {
        self.text[self.at..].iter().filter(|c| !c.is_whitespace()).collect()
    }

    /// Takes the next character if it is one of these.
    fn take(&mut self, any: &[char]) -> Option<char> {
        let next = self.peek().filter(|c| any.contains(c))?;
        self.at += 1;
        Some(next)
    }

    /// Takes a word.
    fn take_word(&mut self, word: &str) -> bool {
        self.peek();
        let length = word.chars().count();
        let is_there = self.text[self.at..].iter().take(length).copied().eq(word.chars());
        // `mix` is no `mi`.
        let goes_on = word.ends_with(char::is_alphabetic)
            && self.text.get(self.at + length).is_some_and(|next| next.is_alphabetic());
        if is_there && !goes_on {
            self.at += length;
        }
        is_there && !goes_on
    }

    fn sum(&mut self) -> Result<Quantity, String> {
        let mut sum = self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            let other = self.product()?;
            let value = if sign == '+' { sum.value + other.value } else { sum.value - other.value };
            sum = Quantity { value, power: sum.power.max(other.power) };
        }
        Ok(sum)
    }

    fn product(&mut self) -> Result<Quantity, String> {
        let mut product = self.signed()?;
        while let Some(sign) = self.take(&['*', '/', '×', '÷']) {
            let other = self.signed()?;
            product = match sign {
                '*' | '×' => Quantity { value: product.value * other.value, power: product.power + other.power },
                _ => Quantity { value: product.value / other.value, power: product.power - other.power },
            };
        }
        Ok(product)
    }

    fn signed(&mut self) -> Result<Quantity, String> {
        self.depth += 1;
        if self.depth > MOST_DEPTH {
            return Err("there are too many parentheses".to_owned());
        }
        let quantity = match self.take(&['+', '-']) {
            Some('-') => self.signed().map(|quantity| Quantity { value: -quantity.value, ..quantity }),
            Some(_) => self.signed(),
            None => self.power(),
        };
        self.depth -= 1;
        quantity
    }

    fn power(&mut self) -> Result<Quantity, String> {
        let base = self.number()?;
        match self.take(&['^']) {
            Some(_) => Ok(Quantity { value: libm::pow(base.value, self.signed()?.value), ..base }),
            None => Ok(base),
        }
    }

    /// A number, a function or a sum in parentheses, with its unit.
    fn number(&mut self) -> Result<Quantity, String> {
        let bare = self.bare()?;
        for (unit, factor) in self.context.units {
            if !unit.is_empty() && self.take_word(unit) {
                return Ok(Quantity { value: bare.value * factor, power: bare.power + 1 });
            }
        }
        Ok(bare)
    }

    fn bare(&mut self) -> Result<Quantity, String> {
        if self.take(&['(']).is_some() {
            return self.inner();
        }
        let Some(first) = self.peek() else {
            let before = self.text.iter().rev().find(|c| !c.is_whitespace());
            return Err(
                before.map_or("nothing was typed".to_owned(), |sign| format!("a number is missing after {sign}"))
            );
        };
        if self.take_word("pi") || self.take_word("π") {
            return Ok(Quantity::plain(std::f64::consts::PI));
        }
        for (name, function) in [("sqrt", libm::sqrt as fn(f64) -> f64), ("abs", libm::fabs)] {
            if self.take_word(name) {
                let Some(_) = self.take(&['(']) else { return Err(format!("a ( is missing after {name}")) };
                let inner = self.inner()?;
                return Ok(Quantity { value: function(inner.value), ..inner });
            }
        }
        // The longest text that is a number: "1e3" has an exponent, "1e" has not.
        let rest = &self.text[self.at..];
        let length = rest.iter().take_while(|c| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-')).count();
        let number = |length: &usize| rest[..*length].iter().collect::<String>().parse::<f64>().ok();
        let found = (1..=length).rev().find_map(|length| Some((length, number(&length)?)));
        match found.filter(|_| first.is_ascii_digit() || first == '.') {
            Some((length, value)) => {
                self.at += length;
                Ok(Quantity::plain(value))
            }
            None => Err(format!("{:?} is not a number", self.rest())),
        }
    }

    /// What stands in parentheses.
    fn inner(&mut self) -> Result<Quantity, String> {
        let value = self.sum()?;
        match self.take(&[')']) {
            Some(_) => Ok(value),
            None => Err("a ) is missing".to_owned()),
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
            ("1/4 + sqrt(0.25)", 0.75),
            ("abs(-3)*2", 6.0),
            ("2*pi", std::f64::consts::TAU),
        ] {
            assert_eq!(evaluate(text, Context::default()), Ok(value), "{text}");
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
            ("sqrt 4", "a ( is missing after sqrt"),
            ("", "nothing was typed"),
            (&"(".repeat(99), "there are too many parentheses"),
        ] {
            assert_eq!(evaluate(text, Context::default()), Err(why.to_owned()), "{text}");
        }
    }

    #[test]
    fn units_and_changes_of_the_number_that_is_there() {
        let units = [("km", 1000.0), ("mi", 1609.344), ("m", 1.0), ("ft", 0.3048)];
        let context = Context { units: &units, now: Some(400.0) };
        for (text, value) in [
            ("3 km + 200 m", 3200.0),
            ("2*2100 km + 300mi", 4_200_000.0 + 482_803.2),
            ("1 km + 200", 1200.0),
            ("(1 + 2) km / 2", 1500.0),
            ("6 km / 2 m", 3000.0),
            ("10ft", 3.048),
            ("*1.5", 600.0),
            ("/ 4", 100.0),
            ("+=10%", 440.0),
            ("-=25 %", 300.0),
            ("*=50%", 200.0),
            ("+= 1 km", 1400.0),
            ("-5", -5.0),
            ("+5", 5.0),
        ] {
            let found = evaluate(text, context);
            assert!(found.as_ref().is_ok_and(|found| (found - value).abs() < 1e-9 * value.abs()), "{text}: {found:?}");
        }
        for (text, why) in [
            ("3 km * 2 km", "units are multiplied or divided"),
            ("3 parsecs", "\"parsecs\" is not a number"),
            ("3 kmx", "\"kmx\" is not a number"),
            ("*", "nothing was typed"),
        ] {
            assert_eq!(evaluate(text, context), Err(why.to_owned()), "{text}");
        }
        assert!(evaluate("*2", Context::default()).is_err(), "there is no number");
    }

    proptest! {
        #[test]
        fn no_text_is_too_odd(text in "[0-9.eE+*/^()=%kmsqrtpi -]{0,40}") {
            let _ = evaluate(&text, Context::default());
        }

        #[test]
        fn a_number_is_its_own_value(value in -1e12..1e12_f64) {
            prop_assert_eq!(evaluate(&value.to_string(), Context::default()), Ok(value));
            prop_assert_eq!(evaluate(&format!("{value:e}"), Context::default()), Ok(value));
        }
    }
}
