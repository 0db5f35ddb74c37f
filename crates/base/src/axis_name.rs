//! Names of axes.
use core::fmt;
use core::str::FromStr;
use thiserror::Error;

/// Name of an axis: 1 to 32 letters, digits, `_` and `-` of ASCII.
///
/// The signals of an axis with a name have two names: `load.position` within the axis, and `x.load.position` among those of all axes. A name
/// of an axis has no dot, so that the part before the first dot is the axis, [`strip`](Self::strip).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AxisName {
    /// The name, zeros behind it.
    bytes: [u8; Self::LONGEST],
}

/// A text that cannot name an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum AxisNameError {
    /// It has no characters.
    #[error("the name of an axis must not be empty")]
    Empty,
    /// It has too many characters.
    #[error("the name of an axis has at most {} characters, got {characters}", AxisName::LONGEST)]
    TooLong {
        /// How many it has.
        characters: usize,
    },
    /// It has another character than letters, digits, `_` and `-`.
    #[error("the name of an axis consists of letters from a to z, digits, `_` and `-`, got {character:?}")]
    Character {
        /// The first such character.
        character: char,
    },
}

impl AxisName {
    /// Characters of the longest name.
    pub const LONGEST: usize = 32;

    /// The name as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        let length = self.bytes.iter().position(|byte| *byte == 0).unwrap_or(Self::LONGEST);
        core::str::from_utf8(&self.bytes[..length]).unwrap_or_default()
    }

    /// `name` within this axis: `load.position` of `x.load.position` where the axis is `x`; `None` where `name` does not begin with this axis.
    #[must_use]
    pub fn strip<'a>(&self, name: &'a str) -> Option<&'a str> {
        name.strip_prefix(self.as_str())?.strip_prefix('.')
    }
}

impl FromStr for AxisName {
    type Err = AxisNameError;

    fn from_str(text: &str) -> Result<Self, AxisNameError> {
        if text.is_empty() {
            return Err(AxisNameError::Empty);
        }
        let is_right = |character: &char| character.is_ascii_alphanumeric() || matches!(character, '_' | '-');
        if let Some(character) = text.chars().find(|character| !is_right(character)) {
            return Err(AxisNameError::Character { character });
        }
        let mut bytes = [0; Self::LONGEST];
        let place = bytes.get_mut(..text.len()).ok_or(AxisNameError::TooLong { characters: text.len() })?;
        place.copy_from_slice(text.as_bytes());
        Ok(Self { bytes })
    }
}

impl fmt::Display for AxisName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl fmt::Debug for AxisName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.as_str(), f)
    }
}

#[cfg(feature = "serde")]
mod in_files {
    use super::AxisName;
    use serde::de::{Deserializer, Error, Visitor};
    use serde::{Deserialize, Serialize, Serializer};

    impl Serialize for AxisName {
        fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
            to.serialize_str(self.as_str())
        }
    }

    /// Refuses what is not a name.
    impl<'de> Deserialize<'de> for AxisName {
        fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
            struct Name;

            impl Visitor<'_> for Name {
                type Value = AxisName;

                fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                    f.write_str("the name of an axis")
                }

                fn visit_str<E: Error>(self, text: &str) -> Result<AxisName, E> {
                    text.parse().map_err(E::custom)
                }
            }

            from.deserialize_str(Name)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn hostile_names_are_refused() {
        let refused = |text: &str| text.parse::<AxisName>().unwrap_err();
        assert_eq!(refused(""), AxisNameError::Empty);
        for (text, character) in [
            ("x.y", '.'),
            ("\"x\"", '"'),
            ("x'", '\''),
            ("x y", ' '),
            ("x\0", '\0'),
            ("x\u{1b}[2J", '\u{1b}'),
            ("x\n", '\n'),
            ("../x", '.'),
            ("x/y", '/'),
            ("ä", 'ä'),
            ("\u{202e}x", '\u{202e}'),
            ("ｘ", 'ｘ'),
        ] {
            assert_eq!(refused(text), AxisNameError::Character { character }, "{text:?}");
        }
        assert_eq!(refused(&"x".repeat(33)), AxisNameError::TooLong { characters: 33 });
        let message = refused(&"x".repeat(10_000)).to_string();
        assert_eq!(message, "the name of an axis has at most 32 characters, got 10000");
        let message = refused(&"\u{1b}".repeat(10_000)).to_string();
        assert_eq!(
            message, "the name of an axis consists of letters from a to z, digits, `_` and `-`, got '\\u{1b}'",
            "the message is short and shows no escape sequence"
        );
    }

    #[test]
    fn a_name_is_the_part_before_the_first_dot() {
        let x: AxisName = "x".parse().unwrap();
        assert_eq!(x.strip("x.load.position"), Some("load.position"));
        for other in ["load.position", "x2.load.position", "xload.position", "x", ""] {
            assert_eq!(x.strip(other), None, "{other}");
        }
    }

    proptest! {
        #[test]
        fn names_are_kept_as_they_are(text in "[A-Za-z0-9_-]{1,32}") {
            let name: AxisName = text.parse().unwrap();
            prop_assert_eq!(name.as_str(), text.as_str());
            prop_assert_eq!(name.to_string(), text.clone());
            let below = format!("{text}.a.b");
            prop_assert_eq!(name.strip(&below), Some("a.b"));
        }

        #[test]
        fn any_text_is_a_name_or_refused(text in any::<String>()) {
            if let Ok(name) = text.parse::<AxisName>() {
                prop_assert_eq!(name.as_str(), text.as_str());
                let is_right = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                prop_assert!((1..=32).contains(&text.len()) && text.chars().all(is_right));
            }
        }
    }
}
