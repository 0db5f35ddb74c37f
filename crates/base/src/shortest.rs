//! Numbers as texts that parse to the same number.
use core::fmt;

/// A number as the shortest text that parses to it exactly, with an exponent where it would be long: `0.30000000000000004`, `5e20`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shortest(pub f64);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(number) = *self;
        let is_plain = number == 0.0 || (1e-5..1e16).contains(&number.abs());
        if is_plain { write!(f, "{number}") } else { write!(f, "{number:e}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString as _;

    #[test]
    fn it_reads_back_and_is_short() {
        for (number, text) in [
            (0.0, "0"),
            (50.0, "50"),
            (0.1 + 0.2, "0.30000000000000004"),
            (1e-9, "1e-9"),
            (-2e300, "-2e300"),
            (1e15, "1000000000000000"),
        ] {
            assert_eq!(Shortest(number).to_string(), text);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), number.to_bits());
        }
    }
}
