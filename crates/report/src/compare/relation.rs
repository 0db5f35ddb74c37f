//! One size relative to another.
use servobench_metrics::Quantity;
use std::fmt;

/// Relative differences below this count as none.
pub(super) const SAME: f64 = 0.01;

/// Size of the change from `one` to `two`, in per cent of `one`.
pub(super) fn percent(one: f64, two: f64) -> Quantity<'static> {
    Quantity::new(100.0 * ((two - one) / one).abs(), "")
}

/// A size relative to a reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Relation {
    /// Within 1 %.
    Same,
    /// Smaller: reference over size.
    Less(f64),
    /// Larger: size over reference.
    More(f64),
    /// Different, but by chance as far as can be shown: the runs have random numbers.
    Chance,
}

impl Relation {
    /// Relation of `size` to `reference`, by magnitude.
    pub(super) fn of(reference: f64, size: f64) -> Self {
        let (reference, size) = (reference.abs(), size.abs());
        // Never reached is as late as never reached, and later than all else.
        if size.is_infinite() && reference.is_infinite() {
            return Self::Same;
        }
        if reference.is_finite() && size.is_finite() && (size - reference).abs() <= SAME * reference.max(size) {
            Self::Same
        } else if size < reference {
            Self::Less(reference / size)
        } else {
            Self::More(size / reference)
        }
    }

    pub(super) const fn is_more(self) -> bool {
        matches!(self, Self::More(_))
    }

    /// True if neither is known to be larger.
    pub(super) const fn is_equal(self) -> bool {
        matches!(self, Self::Same | Self::Chance)
    }
}

impl fmt::Display for Relation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |ratio: f64| Quantity::new(ratio, "");
        match *self {
            Self::Same => f.write_str("same"),
            Self::Chance => f.write_str("within noise"),
            Self::Less(ratio) if !ratio.is_finite() => f.write_str("none left"),
            Self::More(ratio) if !ratio.is_finite() => f.write_str("none before"),
            Self::Less(ratio) if ratio < 2.0 => write!(f, "{:.2} % less", number(100.0 * (1.0 - 1.0 / ratio))),
            Self::More(ratio) if ratio < 2.0 => write!(f, "{:.2} % more", number(100.0 * (ratio - 1.0))),
            Self::Less(ratio) => write!(f, "{:.2} × less", number(ratio)),
            Self::More(ratio) => write!(f, "{:.2} × as much", number(ratio)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relations_read_well() {
        for (one, two, text) in [
            (3.4, 0.21, "16 × less"),
            (0.21, 3.4, "16 × as much"),
            (1.0, 0.77, "23 % less"),
            (1.0, 1.23, "23 % more"),
            (1.0, 1.009, "same"),
            (-1.0, 0.5, "2.0 × less"),
            (1.0, 0.0, "none left"),
            (0.0, 1.0, "none before"),
            (0.0, 0.0, "same"),
            (f64::INFINITY, f64::INFINITY, "same"),
            (f64::INFINITY, 1.0, "none left"),
            (1.0, f64::INFINITY, "none before"),
        ] {
            assert_eq!(Relation::of(one, two).to_string(), text, "{one} {two}");
        }
    }
}
