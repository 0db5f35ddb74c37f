//! Reading a quantity of a certain dimension, and what to say when it has another.
use crate::physical::{Physical, describe};
use crate::quantity::{self, QuantityError};

/// Why a text is not the quantity that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ReadError {
    /// It is no quantity at all.
    NoQuantity(QuantityError),
    /// It is a bare number.
    NoUnit,
    /// It has another dimension.
    OtherDimension {
        /// What it is, with its article.
        is: String,
        /// What to do when only a little is missing; otherwise empty.
        help: &'static str,
    },
}

/// Reads `text` as one of `candidates`: which one, and the value in the unit that it means.
///
/// # Errors
/// [`ReadError`] says what it is instead.
pub(crate) fn read(text: &str, candidates: &[&Physical]) -> Result<(usize, f64), ReadError> {
    let read = quantity::parse(text).map_err(ReadError::NoQuantity)?;
    for (which, physical) in candidates.iter().enumerate() {
        if let Some((_, factor)) = physical.accepts.iter().find(|(accepted, _)| *accepted == read.dimension) {
            return Ok((which, read.value * factor));
        }
    }
    if !read.has_unit {
        return Err(ReadError::NoUnit);
    }
    let bare = read.dimension.without_amplitude();
    let lacks_amplitude = candidates
        .iter()
        .flat_map(|physical| physical.accepts)
        .any(|(accepted, _)| accepted.without_amplitude() == bare);
    let help = if lacks_amplitude {
        "say whether the amplitude or the effective value is meant: `Apk` or `Arms`, `Vpk` or `Vrms`"
    } else {
        ""
    };
    Err(ReadError::OtherDimension { is: describe(read.dimension), help })
}

/// `write "250 mm" or "250 deg"`
pub(crate) fn proposals(number: &str, candidates: &[&Physical]) -> String {
    let is_finite = number.parse::<f64>().is_ok_and(f64::is_finite);
    let number = if is_finite { number.trim_start_matches('+') } else { "1" };
    let mut all: Vec<String> = Vec::new();
    for physical in candidates {
        let proposal = format!("\"{number} {}\"", physical.unit);
        if !all.contains(&proposal) {
            all.push(proposal);
        }
    }
    format!("write {}", all.join(" or "))
}

/// "a length or an angle"
pub(crate) fn names(candidates: &[&Physical]) -> String {
    let names: Vec<&str> = candidates.iter().map(|physical| physical.name).collect();
    names.join(" or ")
}
