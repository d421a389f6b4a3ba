//! How well a typed word fits a text. The letters of the word must be in the text in their order. After a letter the
//! word goes on with the next one, later in the same word of the text, or at the begin of a later word: "rp" finds
//! "Random planet", and "frq" finds "Frequency", but letters strewn over a line find nothing.

/// Points of a letter at the begin of the text, at the begin of a word, and behind the letter before.
const FIRST: i32 = 4;
const BEGIN: i32 = 8;
const NEXT: i32 = 6;
/// Points that a gap costs: a word with two gaps is worth less than one in a description.
const GAP: i32 = 8;
/// So many letters that were not typed cost a point.
const SPARE: usize = 6;

/// A text prepared for the search.
#[derive(Clone, Debug)]
pub struct Text {
    letters: Vec<char>,
    /// Whether a word begins with the letter.
    begins: Vec<bool>,
}

/// How well a word fits: more points are better.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fit {
    /// Points.
    pub points: i32,
    /// Indices of the letters of the text that were typed.
    pub letters: Vec<usize>,
}

/// A letter in lower case; one stays one, so that indices stay the same.
pub fn folded(letter: char) -> char {
    letter.to_lowercase().next().unwrap_or(letter)
}

impl Text {
    /// Prepares a text.
    pub fn new(text: &str) -> Self {
        let letters: Vec<char> = text.chars().map(folded).collect();
        let begins =
            (0..letters.len()).map(|i| letters[i].is_alphanumeric() && (i == 0 || !letters[i - 1].is_alphanumeric()));
        Self { begins: begins.collect(), letters }
    }

    /// How well a word in lower case fits; None if it does not.
    pub fn fit(&self, word: &[char]) -> Option<Fit> {
        let (count, length) = (self.letters.len(), word.len());
        if length == 0 || !is_within(word, &self.letters) {
            return None;
        }
        // best[i][at]: most points of the word from letter i on if that letter is at `at`, and the place of the next.
        let mut best: Vec<Vec<Option<(i32, usize)>>> = vec![vec![None; count]; length];
        for i in (0..length).rev() {
            for at in (i..count).filter(|at| self.letters[*at] == word[i]) {
                let here = 1 + if self.begins[at] { BEGIN } else { 0 } + if at == 0 { FIRST } else { 0 };
                best[i][at] = if i + 1 == length { Some((here, at)) } else { self.onward(&best[i + 1], at, here) };
            }
        }
        let (points, first) =
            (0..count).filter_map(|at| Some((best[0][at]?.0, at))).max_by_key(|(points, at)| (*points, count - at))?;
        let mut letters = vec![first];
        for row in &best[..length - 1] {
            let at = *letters.last()?;
            letters.push(row[at]?.1);
        }
        Some(Fit { points: points - ((count - length) / SPARE) as i32, letters })
    }

    /// Most points of a letter at `at`, which has the points `here`, with the rest of the word behind it.
    fn onward(&self, rest: &[Option<(i32, usize)>], at: usize, here: i32) -> Option<(i32, usize)> {
        let mut same_word = true;
        let mut best = None;
        for (next, after) in rest.iter().enumerate().skip(at + 1) {
            same_word &= self.letters[next].is_alphanumeric();
            let step = if next == at + 1 { NEXT } else { -GAP };
            let reached = next == at + 1 || same_word || self.begins[next];
            if let (true, Some((points, _))) = (reached, after)
                && best.is_none_or(|(most, _)| here + step + points > most)
            {
                best = Some((here + step + points, next));
            }
        }
        best
    }
}

/// Whether the letters of the word are in the text in their order, anywhere.
fn is_within(word: &[char], text: &[char]) -> bool {
    let mut text = text.iter();
    word.iter().all(|letter| text.any(|other| other == letter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fit(word: &str, text: &str) -> Option<Fit> {
        Text::new(text).fit(&word.chars().map(folded).collect::<Vec<_>>())
    }

    fn points(word: &str, text: &str) -> i32 {
        fit(word, text).map_or(i32::MIN, |fit| fit.points)
    }

    #[test]
    fn letters_are_found_in_their_order() {
        assert_eq!(fit("amp", "Amplitude").unwrap().letters, [0, 1, 2]);
        assert_eq!(fit("rp", "Random planet").unwrap().letters, [0, 7]);
        assert_eq!(fit("frq", "Frequency").unwrap().letters, [0, 1, 3]);
        assert_eq!(fit("LEVEL", "Sea level").unwrap().letters, [4, 5, 6, 7, 8]);
        assert_eq!(fit("pma", "Amplitude"), None);
        assert_eq!(fit("", "Amplitude"), None);
        assert_eq!(fit("amplitudes", "Amplitude"), None);
    }

    #[test]
    fn letters_strewn_over_a_line_are_no_fit() {
        assert_eq!(fit("sun", "Reset view of the main light"), None);
        assert_eq!(fit("undo", "Under the second moon"), None, "o is amid another word");
    }

    #[test]
    fn better_fits_have_more_points() {
        assert!(points("scale", "Scale") > points("scale", "Mie scale"));
        assert!(points("scale", "Mie scale") > points("scale", "Upscaled"));
        assert!(points("sl", "Sea level") > points("sl", "Absolute"));
        assert!(points("wind", "Wind") > points("wind", "Windows of the wind"));
        // The run of letters is taken, not the first letters that would do.
        assert_eq!(fit("level", "Lower levels").unwrap().letters, [6, 7, 8, 9, 10]);
    }

    proptest! {
        /// The letters that were typed are in the text where the fit says, in ascending order.
        #[test]
        fn a_fit_points_at_the_letters(word in "[a-c ]{1,5}", text in "[a-cA-C ]{0,12}") {
            let word: Vec<char> = word.chars().collect();
            let prepared = Text::new(&text);
            let text: Vec<char> = text.chars().map(folded).collect();
            match prepared.fit(&word) {
                Some(fit) => {
                    prop_assert!(fit.letters.windows(2).all(|pair| pair[0] < pair[1]));
                    let found: Vec<char> = fit.letters.iter().map(|at| text[*at]).collect();
                    prop_assert_eq!(found, word);
                }
                // What stands in the text letter for letter is always found.
                None => prop_assert!(!text.windows(word.len()).any(|part| part == word)),
            }
        }
    }
}
