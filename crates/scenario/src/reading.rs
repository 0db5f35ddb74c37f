//! Reading a quantity of a certain dimension, and the advice when its dimension is another.
use crate::quantity::{self, QuantityError, Scale};
use servobench_config::Dimension;
use servobench_config::Physical;
use servobench_config::quantities::NAMED;

/// Reason why a text is not the wanted quantity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ReadError {
    /// Not a quantity.
    NoQuantity(QuantityError),
    /// A bare number.
    NoUnit,
    /// A quantity of another dimension.
    OtherDimension {
        /// Description of the quantity, with its article.
        is: String,
        /// Advice when only a little is missing; otherwise empty.
        help: &'static str,
    },
}

/// Reads `text` as one of `candidates`: the index of the candidate, and the value in the candidate's unit.
///
/// # Errors
/// [`ReadError`] with a description of the text.
pub(crate) fn read(text: &str, candidates: &[&Physical]) -> Result<(usize, f64), ReadError> {
    let read = quantity::parse(text).map_err(|error| {
        let help = if error.is_shapeless { proposals("1", candidates) } else { error.help };
        ReadError::NoQuantity(QuantityError { help, ..error })
    })?;
    for (which, physical) in candidates.iter().enumerate() {
        if let Some((_, factor)) = physical.accepts.iter().find(|(accepted, _)| *accepted == read.dimension) {
            return Ok((which, read.value * factor));
        }
    }
    if !read.has_unit {
        return Err(ReadError::NoUnit);
    }
    let (is, help) = other(read.dimension, candidates);
    Err(ReadError::OtherDimension { is, help })
}

/// `number` in `unit` as one of `candidates`, with the result of [`read`]; `None` where it is not one of them.
pub(crate) fn amount(number: f64, unit: &str, candidates: &[&Physical]) -> Option<(usize, f64)> {
    let scale = Scale::read(unit).ok()?;
    let value = scale.of_number(number)?;
    let meant = |physical: &&Physical| Some(physical.accepts.iter().find(|(own, _)| *own == scale.dimension())?.1);
    candidates.iter().enumerate().find_map(|(which, physical)| Some((which, value * meant(physical)?)))
}

/// Description of a quantity of dimension `is`, which is not in `wanted`, and advice where engineers commonly mean one of `wanted` by it.
fn other(is: Dimension, wanted: &[&Physical]) -> (String, &'static str) {
    let accepted = || wanted.iter().flat_map(|physical| physical.accepts).map(|(dimension, _)| *dimension);
    let accepts = |dimension: Dimension| accepted().any(|own| own == dimension);
    let per_second = Dimension::ONE.times(Dimension::SECOND, -1);
    let angle_per_second = Dimension::RADIAN.times(Dimension::SECOND, -1);
    if accepted().any(|own| own.without_amplitude() == is.without_amplitude()) {
        return if is == is.without_amplitude() {
            ("neither an amplitude nor an RMS value".to_owned(), "write `Arms` or `Apk`, `Vrms` or `Vpk`")
        } else {
            ("an amplitude or an RMS value".to_owned(), "plain `A` or `V` is needed here")
        };
    }
    let help = if is == Dimension::KILOGRAM && accepts(Dimension::METRE.times(Dimension::SECOND, -2)) {
        "`g` is the gram; gravity is 9.80665 m/s2"
    } else if is == per_second && accepts(Dimension::HERTZ) && accepts(angle_per_second) {
        "write `rad/s` for the corner of a loop; its frequency in `Hz` is that over 2π"
    } else if (is == per_second || is == Dimension::HERTZ) && accepts(angle_per_second) {
        "an angle has a unit: write `rpm` for revolutions per minute, `rev/s` or `rad/s`"
    } else {
        ""
    };
    (describe(is), help)
}

/// `write "250 mm" or "250 deg"`
pub(crate) fn proposals(number: &str, candidates: &[&Physical]) -> String {
    let is_finite = number.parse::<f64>().is_ok_and(f64::is_finite);
    let number = if is_finite { number.trim_start_matches('+') } else { "1" };
    let mut all: Vec<String> = Vec::new();
    for physical in candidates {
        let proposal =
            if physical.unit.is_empty() { number.to_owned() } else { format!("\"{number} {}\"", physical.unit) };
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

/// Description of a quantity of dimension `dimension`: "a force (kg·m/s²)".
pub(crate) fn describe(dimension: Dimension) -> String {
    if dimension == Dimension::ONE {
        return "a pure number".to_owned();
    }
    // The first dimension in each list is the canonical one.
    let named = NAMED.iter().find(|physical| physical.accepts.first().is_some_and(|(own, _)| *own == dimension));
    match named {
        Some(physical) if physical.name.contains('(') => physical.name.to_owned(),
        Some(physical) => format!("{} ({})", physical.name, physical.unit),
        None if dimension == Dimension::AMPERE => "a current (A)".to_owned(),
        None => format!("in {dimension}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_config::quantities::*;

    #[test]
    fn the_unit_of_every_proposal_is_accepted_as_it_is() {
        let plain = [&RATIO, &BANDWIDTH, &LEAD, &VOLTAGE_AMPLITUDE, &CURRENT_RMS, &CURRENT_GAIN];
        let pairs = [&INERTIAL, &EFFORT, &STIFFNESS, &VISCOUS, &VOLT_GAIN, &SOURCE_GAIN];
        let pairs = pairs.iter().flat_map(|pair| [&pair.linear, &pair.rotary]);
        for physical in plain.into_iter().chain(pairs).chain(NAMED) {
            let read = quantity::parse(&format!("1 {}", physical.unit)).unwrap();
            assert!(physical.accepts.iter().any(|(own, _)| *own == read.dimension), "{physical:?}");
        }
    }

    #[test]
    fn dimensions_have_names() {
        assert_eq!(describe(Dimension::NEWTON), "a force (N)");
        assert_eq!(describe(Dimension::METRE), "a length (mm)");
        assert_eq!(describe(Dimension::AMPERE), "a current (A)");
        assert_eq!(describe(Dimension::KILOGRAM.times(Dimension::AMPERE, 3)), "in kg·A³");
        assert_eq!(describe(Dimension::ONE), "a pure number");
    }
}
