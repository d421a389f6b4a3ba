//! Locations of values in a RON text: a scanner of brackets, literals and comments, without types.
//!
//! serde forgets positions once a value is read, and ranges are checked only when the whole planet is there. This
//! scanner walks the text again and reports the path (`layers[2].shape.octaves`) and offset of each value. It is a loop
//! with its own stack, so deep nesting cannot overflow the thread's stack. It never fails: of a broken text it reports
//! the part before the break.

use super::printable::printable;
use std::collections::HashMap;

/// One step of a path in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step<'a> {
    /// A field of a struct.
    Field(&'a str),
    /// An element of a list or tuple.
    Index(usize),
}

/// The place of a value, as byte offsets into the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// Offset of the field's name; of the value if it has no name.
    pub(crate) key: usize,
    /// Offset of the value.
    pub(crate) value: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Token<'a> {
    Open(char),
    Close,
    Comma,
    Colon,
    Ident(&'a str),
    Literal,
}

/// Splits a text into tokens; comments and white space are left out.
struct Tokens<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Tokens<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn skip_while(&mut self, keep: impl Fn(char) -> bool) {
        let rest = self.rest();
        self.at += rest.find(|c| !keep(c)).unwrap_or(rest.len());
    }

    /// Moves behind the next `end`, or to the end of the text.
    fn skip_past(&mut self, end: &str) {
        let rest = self.rest();
        self.at += rest.find(end).map_or(rest.len(), |i| i + end.len());
    }

    fn skip_space_and_comments(&mut self) {
        loop {
            self.skip_while(|c| c.is_whitespace() || matches!(c, '\u{200e}' | '\u{200f}'));
            let rest = self.rest();
            if rest.starts_with("//") {
                self.skip_while(|c| c != '\n');
            } else if rest.starts_with("/*") {
                self.skip_block_comment();
            } else if rest.starts_with("#!") {
                self.skip_past("]");
            } else {
                return;
            }
        }
    }

    fn skip_block_comment(&mut self) {
        self.at += 2;
        let mut depth = 1;
        while depth > 0 {
            self.skip_while(|c| !matches!(c, '/' | '*'));
            let rest = self.rest();
            if rest.is_empty() {
                return;
            } else if rest.starts_with("/*") {
                (self.at, depth) = (self.at + 2, depth + 1);
            } else if rest.starts_with("*/") {
                (self.at, depth) = (self.at + 2, depth - 1);
            } else {
                self.at += 1;
            }
        }
    }

    fn skip_string(&mut self) {
        self.at += 1;
        loop {
            self.skip_while(|c| !matches!(c, '"' | '\\'));
            match self.rest().chars().next() {
                Some('\\') => {
                    self.at += 1;
                    self.at += self.rest().chars().next().map_or(0, char::len_utf8);
                }
                Some(_) => {
                    self.at += 1;
                    return;
                }
                None => return,
            }
        }
    }

    /// `r"…"`, `r#"…"#`, …; `hashes` is the text between the `r` and the quote.
    fn skip_raw_string(&mut self, prefix: usize, hashes: usize) {
        self.at += prefix + hashes + 1;
        self.skip_past(&format!("\"{}", "#".repeat(hashes)));
    }

    fn skip_char(&mut self) {
        self.at += 1;
        let first = self.rest().chars().next();
        self.at += first.map_or(0, char::len_utf8);
        if first == Some('\\') {
            self.at += self.rest().chars().next().map_or(0, char::len_utf8);
            self.skip_while(|c| c.is_ascii_hexdigit() || matches!(c, '{' | '}'));
        }
        if self.rest().starts_with('\'') {
            self.at += 1;
        }
    }

    /// The next token and its offset.
    fn next(&mut self) -> Option<(usize, Token<'a>)> {
        self.skip_space_and_comments();
        let start = self.at;
        let rest = self.rest();
        let first = rest.chars().next()?;
        let token = match first {
            '(' | '[' | '{' => {
                self.at += 1;
                Token::Open(first)
            }
            ')' | ']' | '}' => {
                self.at += 1;
                Token::Close
            }
            ',' => {
                self.at += 1;
                Token::Comma
            }
            ':' => {
                self.at += 1;
                Token::Colon
            }
            '"' => {
                self.skip_string();
                Token::Literal
            }
            '\'' => {
                self.skip_char();
                Token::Literal
            }
            _ if first == '_' || first.is_alphabetic() => self.word(rest),
            _ => {
                self.at += first.len_utf8();
                self.skip_while(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '+' | '-'));
                Token::Literal
            }
        };
        Some((start, token))
    }

    /// An identifier, a raw identifier, or a string with a prefix.
    fn word(&mut self, rest: &'a str) -> Token<'a> {
        for prefix in ["r", "br", "b"] {
            let Some(after) = rest.strip_prefix(prefix) else { continue };
            let hashes = after.len() - after.trim_start_matches('#').len();
            match after[hashes..].chars().next() {
                Some('"') if prefix == "b" && hashes == 0 => {
                    self.at += 1;
                    self.skip_string();
                    return Token::Literal;
                }
                Some('"') if prefix != "b" => {
                    self.skip_raw_string(prefix.len(), hashes);
                    return Token::Literal;
                }
                Some('\'') if prefix == "b" && hashes == 0 => {
                    self.at += 1;
                    self.skip_char();
                    return Token::Literal;
                }
                _ => {}
            }
        }
        if rest.starts_with("r#") {
            self.at += 2;
        }
        let start = self.at;
        self.skip_while(|c| c == '_' || c.is_alphanumeric());
        Token::Ident(&self.text[start..self.at])
    }
}

/// An open bracket.
struct Frame {
    /// `Some(…)` and `Fbm(…)`: an unnamed content is the value itself and adds no step to the path.
    transparent: bool,
    index: usize,
    /// Whether the current element has added a step to the path.
    stepped: bool,
    /// Whether its value has begun.
    begun: bool,
    /// Offset of its name.
    key: Option<usize>,
}

impl Frame {
    fn new(transparent: bool) -> Self {
        Self { transparent, index: 0, stepped: false, begun: false, key: None }
    }
}

/// Calls `visit` with the path and place of each value, in the order of the text, until it returns `false`.
pub(crate) fn walk<'a>(text: &'a str, mut visit: impl FnMut(&[Step<'a>], Place) -> bool) {
    let mut tokens = Tokens { text, at: 0 };
    let mut path: Vec<Step<'a>> = Vec::new();
    let mut frames: Vec<Frame> = Vec::new();
    let mut top = Frame::new(true);
    while let Some((start, token)) = tokens.next() {
        match token {
            Token::Comma | Token::Close => {
                if std::mem::take(&mut top.stepped) {
                    path.pop();
                }
                (top.begun, top.key, top.index) = (false, None, top.index + 1);
                if token == Token::Close {
                    match frames.pop() {
                        Some(outer) => top = outer,
                        None => return,
                    }
                }
                continue;
            }
            Token::Colon => continue,
            _ => {}
        }
        // Looks one token ahead: `name:` is a field, `Name(` a variant or a struct.
        let mut opens = matches!(token, Token::Open(_));
        let mut names = false;
        if let Token::Ident(name) = token {
            let before = tokens.at;
            match tokens.next() {
                Some((_, Token::Colon)) if !top.begun => {
                    if !std::mem::replace(&mut top.stepped, true) {
                        path.push(Step::Field(name));
                    }
                    top.key = Some(start);
                    continue;
                }
                Some((_, Token::Open('('))) => (opens, names) = (true, true),
                _ => tokens.at = before,
            }
        }
        if !top.begun {
            top.begun = true;
            if !top.stepped && !top.transparent {
                path.push(Step::Index(top.index));
                top.stepped = true;
            }
            if !visit(&path, Place { key: top.key.unwrap_or(start), value: start }) {
                return;
            }
        }
        if opens {
            frames.push(std::mem::replace(&mut top, Frame::new(names)));
        }
    }
}

/// The steps of a path as it is written in messages.
pub(crate) fn steps(path: &str) -> Vec<Step<'_>> {
    path.split(['.', '['])
        .filter(|part| !part.is_empty())
        .map(|part| match part.strip_suffix(']').and_then(|digits| digits.parse().ok()) {
            Some(index) => Step::Index(index),
            None => Step::Field(part),
        })
        .collect()
}

/// A path as it is written in messages; the opposite of [`steps`].
pub(crate) fn path_text(steps: &[Step<'_>]) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            Step::Index(index) => text.push_str(&format!("[{index}]")),
            Step::Field(name) if text.is_empty() => text.push_str(name),
            Step::Field(name) => {
                text.push('.');
                text.push_str(name);
            }
        }
    }
    text
}

/// The place of the value at a path; an empty path is the planet itself.
pub(crate) fn find(text: &str, path: &str) -> Option<Place> {
    let wanted = steps(path);
    let mut found = None;
    walk(text, |path, place| {
        if path == wanted.as_slice() {
            found = Some(place);
        }
        found.is_none()
    });
    found
}

/// The place of every value by path, down to the depth of any preset.
pub(crate) fn all(text: &str) -> HashMap<String, Place> {
    const DEEPEST: usize = 8;
    let mut places = HashMap::new();
    walk(text, |path, place| {
        if path.len() <= DEEPEST {
            places.entry(path_text(path)).or_insert(place);
        }
        true
    });
    places
}

/// Line and column (both from 1, the column in characters) of a byte offset.
pub(crate) fn line_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    (before.bytes().filter(|&byte| byte == b'\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// The byte offset of a line and column.
pub(crate) fn offset(text: &str, line: usize, column: usize) -> usize {
    let line_start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(line_start..).unwrap_or_default();
    line_start + rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(i, _)| i)
}

/// The text of the token at an offset, shortened, for messages. What commands a terminal or turns the direction of text
/// is escaped.
pub(crate) fn excerpt(text: &str, offset: usize) -> String {
    const MOST_CHARS: usize = 40;
    let mut tokens = Tokens { text, at: offset };
    if tokens.next().is_none() {
        return "the end of the text".to_owned();
    }
    let token = text.get(offset..tokens.at).unwrap_or_default();
    let line = token.lines().next().unwrap_or_default();
    let shown: String = line.chars().take(MOST_CHARS).collect();
    let is_whole = line.len() == token.len() && line.chars().count() <= MOST_CHARS;
    format!("`{}{}`", printable(&shown).replace('\t', "\\t"), if is_whole { "" } else { "…" })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r##"#![enable(implicit_some)] // a ( comment
Planet( /* nested /* ( */ [ */
    version: 1, name: "a \" ( b", raw: r#"x " ) y"#, r#type: 'c', quote: '\'', paren: '(', code: '\u{28}',
    layers: [
        (name: "é", shape: Fbm(octaves: 3, gain: 0.5), masks: []),
        (shape: Ridged(octaves: 4)), // )
        Layer(masks: [(from: 1, to: 2,), (from: 3)],),
    ],
    color: (0.1, 0.2, 0.3), flag: true, none: None,
    water: Some((level_m: 7)), air: Some(height_km: 8), bytes: b"(", last: -1.5e3,
)"##;

    fn value_at(path: &str) -> Option<&'static str> {
        find(TEXT, path).map(|place| &TEXT[place.value..])
    }

    #[test]
    fn every_kind_of_value_is_found() {
        let cases = [
            ("", "Planet("),
            ("version", "1,"),
            ("name", "\"a"),
            ("raw", "r#"),
            ("type", "'c'"),
            ("quote", "'\\''"),
            ("paren", "'('"),
            ("code", "'\\u"),
            ("layers", "["),
            ("layers[0].name", "\"é\""),
            ("layers[0].shape", "Fbm("),
            ("layers[0].shape.octaves", "3"),
            ("layers[0].shape.gain", "0.5"),
            ("layers[0].masks", "[]"),
            ("layers[1].shape.octaves", "4"),
            ("layers[2]", "Layer("),
            ("layers[2].masks[0].to", "2"),
            ("layers[2].masks[1].from", "3"),
            ("color", "(0.1"),
            ("color[2]", "0.3"),
            ("flag", "true"),
            ("none", "None"),
            ("water.level_m", "7"),
            ("air.height_km", "8"),
            ("bytes", "b\""),
            ("last", "-1.5e3"),
        ];
        for (path, start) in cases {
            assert!(value_at(path).is_some_and(|v| v.starts_with(start)), "{path}: {:?}", value_at(path));
        }
        assert_eq!(value_at("layers[3]"), None);
        assert_eq!(value_at("nothing"), None);
    }

    #[test]
    fn columns_count_characters() {
        let place = find(TEXT, "layers[0].shape").unwrap();
        assert_eq!(line_column(TEXT, place.key), (5, 21));
        assert_eq!(offset(TEXT, 5, 21), place.key);
    }

    #[test]
    fn depth_costs_no_stack() {
        let deep = "(a:[".repeat(200_000);
        let mut most = 0;
        walk(&deep, |path, _| {
            most = most.max(path.len());
            true
        });
        assert_eq!(most, 399_999);
    }

    #[test]
    fn excerpts_are_short() {
        assert_eq!(excerpt("a: \"x y\"", 3), "`\"x y\"`");
        assert_eq!(excerpt("a:", 2), "the end of the text");
        assert_eq!(excerpt(&"x".repeat(100), 0).chars().count(), 43);
    }
}
