//! Inputs that are almost right: real files, cut into words and joined wrongly.
//!
//! Random bytes never get past the outermost parser. A real file with a few changed words does, and its mistakes are found, or missed,
//! deep inside.
use bolero::Driver;
use bolero::generator::ValueGenerator;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::ops::Bound::{Excluded, Included};
use std::ops::Range;

/// Generator of changed files of bytes.
#[derive(Debug, Clone)]
pub struct Splice {
    /// The words of each file.
    files: Vec<Vec<Vec<u8>>>,
    /// Words to insert.
    dictionary: Vec<Vec<u8>>,
    /// All words of files and dictionary, each once, by kind.
    kinds: [Vec<Vec<u8>>; 3],
}

/// Generator of changed texts; see [`Splice::text`].
#[derive(Debug, Clone)]
pub struct SplicedText(Splice);

type Words<'a> = Vec<Cow<'a, [u8]>>;

/// Greatest number of words of an input, so that doubling cannot fill the memory.
const MOST_WORDS: usize = 1 << 14;

impl Splice {
    /// Splices files of bytes, each byte a word.
    ///
    /// # Panics
    /// If there is no file or no word to insert.
    #[must_use]
    pub fn bytes(files: &[&[u8]], dictionary: &[&[u8]]) -> Self {
        assert!(!files.is_empty() && !dictionary.is_empty(), "there is nothing to splice");
        let bytes = |file: &&[u8]| file.iter().map(|byte| vec![*byte]).collect();
        Self::new(files.iter().map(bytes).collect(), dictionary.iter().map(|word| word.to_vec()).collect())
    }

    /// Splices texts: a word is a number, a name, or any other character.
    ///
    /// # Panics
    /// If there is no file or no word to insert.
    #[must_use]
    pub fn text(files: &[&str], dictionary: &[&str]) -> SplicedText {
        assert!(!files.is_empty() && !dictionary.is_empty(), "there is nothing to splice");
        let words = |file: &&str| words(file).into_iter().map(|word| word.as_bytes().to_vec()).collect();
        let dictionary = dictionary.iter().map(|word| word.as_bytes().to_vec()).collect();
        SplicedText(Self::new(files.iter().map(words).collect(), dictionary))
    }

    fn new(files: Vec<Vec<Vec<u8>>>, dictionary: Vec<Vec<u8>>) -> Self {
        let all: BTreeSet<_> = files.iter().flatten().chain(&dictionary).collect();
        let mut kinds = [const { vec![] }; 3];
        for word in all {
            kinds[kind(word)].push(word.clone());
        }
        Self { files, dictionary, kinds }
    }
}

/// 0 for a number, 1 for a name, 2 for anything else.
fn kind(word: &[u8]) -> usize {
    match word {
        [b'0'..=b'9', ..] | [b'-' | b'+' | b'.', b'0'..=b'9', ..] => 0,
        [b'a'..=b'z' | b'A'..=b'Z', ..] => 1,
        _ => 2,
    }
}

/// Words of a text: numbers and names whole, anything else by the character.
fn words(text: &str) -> Vec<&str> {
    let in_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '-' | '+');
    let mut words = vec![];
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = if in_word(first) { rest.find(|c| !in_word(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        let (word, after) = rest.split_at(end);
        words.push(word);
        rest = after;
    }
    words
}

impl ValueGenerator for Splice {
    type Output = Vec<u8>;

    fn generate<D: Driver>(&self, driver: &mut D) -> Option<Vec<u8>> {
        let mut words: Words =
            self.files[below(driver, self.files.len())?].iter().map(|w| Cow::Borrowed(&w[..])).collect();
        for _ in 0..below(driver, 9)? {
            self.change(&mut words, driver)?;
            words.truncate(MOST_WORDS);
        }
        Some(words.concat())
    }
}

impl ValueGenerator for SplicedText {
    type Output = String;

    fn generate<D: Driver>(&self, driver: &mut D) -> Option<String> {
        self.0.generate(driver).map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
    }
}

impl Splice {
    /// Makes one change.
    fn change<'a, D: Driver>(&'a self, words: &mut Words<'a>, driver: &mut D) -> Option<()> {
        let at = range(words, driver)?;
        match below(driver, 17)? {
            0 => drop(words.drain(at)),
            1 => words.truncate(at.start),
            2 => {
                let moved: Words = words.drain(at).collect();
                let to = below(driver, words.len() + 1)?;
                words.splice(to..to, moved);
            }
            3 => {
                let copy = words[at].to_vec();
                let to = below(driver, words.len() + 1)?;
                words.splice(to..to, copy);
            }
            4 => {
                let times = 2 << below(driver, 7)?;
                let copies: Words = words[at.clone()].iter().cycle().take(times * at.len()).cloned().collect();
                words.splice(at, copies);
            }
            5 => {
                let other = &self.files[below(driver, self.files.len())?];
                let from = range(other, driver)?;
                words.splice(at, other[from].iter().map(|w| Cow::Borrowed(&w[..])));
            }
            6 => {
                let Some(word) = words.get_mut(at.start).filter(|word| !word.is_empty()) else { return Some(()) };
                let byte = below(driver, word.len())?;
                word.to_mut()[byte] = driver.produce()?;
            }
            // The smallest changes get furthest, so they are the most frequent.
            7..=10 => {
                let Some(word) = words.get_mut(at.start) else { return Some(()) };
                *word = self.another(kind(word), driver)?;
            }
            11..=14 => {
                let number = words.iter_mut().skip(at.start).find(|word| kind(word) == 0);
                if let Some(number) = number {
                    *number = self.another(0, driver)?;
                }
            }
            _ => {
                let word = &self.dictionary[below(driver, self.dictionary.len())?];
                let at = if driver.produce()? { at.start..at.start } else { at };
                words.splice(at, [Cow::Borrowed(&word[..])]);
            }
        }
        Some(())
    }

    /// Another word of a kind: one of the known words, or a number of any magnitude.
    fn another<'a, D: Driver>(&'a self, kind: usize, driver: &mut D) -> Option<Cow<'a, [u8]>> {
        let ours = &self.kinds[kind];
        if ours.is_empty() || kind == 0 && driver.produce()? {
            let (digit, exponent) = (below(driver, 10)?, driver.gen_i32(Included(&-340), Included(&340))?);
            return Some(Cow::Owned(format!("{digit}e{exponent}").into_bytes()));
        }
        Some(Cow::Borrowed(&ours[below(driver, ours.len())?]))
    }
}

/// A word, some words in a row, or whole lines.
fn range<D: Driver>(words: &[impl AsRef<[u8]>], driver: &mut D) -> Option<Range<usize>> {
    let start = below(driver, words.len() + 1)?;
    let ends_line = |word: &&[u8]| *word == b"\n";
    let mut lines = words[start..].iter().map(AsRef::as_ref);
    let len = match below(driver, 4)? {
        0 | 1 => 1,
        2 => 1 + below(driver, 40)?,
        _ => lines.position(|word| ends_line(&word)).map_or(1, |at| at + 1),
    };
    Some(start..words.len().min(start + len))
}

/// A number below `bound`, which is not zero.
pub(crate) fn below<D: Driver>(driver: &mut D, bound: usize) -> Option<usize> {
    driver.gen_usize(Included(&0), Excluded(&bound))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::Seeded;
    use bolero::TestTarget;
    use std::sync::Mutex;

    #[test]
    fn a_text_is_its_words() {
        let text = "gain = \"1.5e-3 µm/s2\"\n[a.b]";
        let expected = ["gain", " ", "=", " ", "\"", "1.5e-3", " ", "µm", "/", "s2", "\"", "\n", "[", "a.b", "]"];
        assert_eq!(words(text), expected);
        assert_eq!(words(text).concat(), text);
    }

    /// Result of each kind of change on three words, among the inputs of one sweep.
    #[test]
    fn every_kind_of_change_happens() {
        let seen = Mutex::new(BTreeSet::new());
        let texts = Splice::text(&["a b\nc", "z", "7 9"], &["0"]);
        TestTarget::new(Seeded { inputs: 50_000 }).with_generator(texts).for_each(|text: &String| {
            seen.lock().unwrap().insert(text.clone());
        });
        let seen = seen.into_inner().unwrap();
        for (change, text) in [
            ("none", "a b\nc"),
            ("a word cut", " b\nc"),
            ("a line cut", "c"),
            ("the end cut", "a b"),
            ("a word moved", "a \ncb"),
            ("a word copied", "a bb\nc"),
            ("a line doubled", "a b\na b\nc"),
            ("a word repeated", "a bbbbbbbb\nc"),
            ("a word of another file", "a z\nc"),
            ("a byte changed", "a b\n\u{fffd}"),
            ("a word put in", "a 0b\nc"),
            ("a name for a name", "a c\nc"),
            ("a number for a number", "0 9"),
            ("a word replaced", "a 0\nc"),
        ] {
            assert!(seen.contains(text), "{change}: {text:?}");
        }
        let is_tiny = |text: &String| {
            text.split_once("e-3").is_some_and(|(digit, rest)| digit.len() == 1 && rest.ends_with(" 9"))
        };
        assert!(seen.iter().any(is_tiny), "a number of any magnitude");
    }

    #[test]
    fn no_input_fills_the_memory() {
        let long = "a ".repeat(MOST_WORDS / 2);
        let longest = 1 + MOST_WORDS * "four".len();
        let texts = Splice::text(&[&long], &["four"]);
        let property = move |text: &String| assert!(text.len() <= longest);
        TestTarget::new(Seeded { inputs: 200 }).with_generator(texts).for_each(property);
    }
}
