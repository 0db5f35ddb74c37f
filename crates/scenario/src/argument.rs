//! Quantities on a command line: read and checked as in a scenario file.
use crate::quantity;
use crate::reading::{self, ReadError, names, proposals};
use servobench_base::Coordinate;
use servobench_config::quantities::{ACCELERATION, FREQUENCY, JERK, POSITION, RATIO, SNAP, TIME, VELOCITY};
use servobench_config::{Counterparts, Physical};
use servobench_fmu_file::SiUnit;
use servobench_metrics::Name;
use thiserror::Error;

/// A derivative of position with respect to time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// Position or distance.
    Position,
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
    /// Jerk.
    Jerk,
    /// Snap.
    Snap,
}

/// A quantity of another kind than the argument needs.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{text}`: {message}")]
pub struct ArgumentError {
    /// The text as given.
    pub text: String,
    /// The mistake with its correction.
    pub message: String,
}

/// Reads a position or one of its derivatives (SI), on an axis that is linear or rotary, or either when `motion` is `None`; returns
/// the value and its coordinate.
///
/// # Errors
/// [`ArgumentError`] for a text that is not a quantity, has no unit or another dimension.
pub fn axis_quantity(
    derivative: Derivative,
    motion: Option<Coordinate>,
    text: &str,
) -> Result<(f64, Coordinate), ArgumentError> {
    let Counterparts { linear, rotary } = match derivative {
        Derivative::Position => &POSITION,
        Derivative::Velocity => &VELOCITY,
        Derivative::Acceleration => &ACCELERATION,
        Derivative::Jerk => &JERK,
        Derivative::Snap => &SNAP,
    };
    match motion {
        Some(Coordinate::Linear) => Ok((read(&[linear], text)?.0, Coordinate::Linear)),
        Some(Coordinate::Rotary) => Ok((read(&[rotary], text)?.0, Coordinate::Rotary)),
        None => {
            let (value, which) = read(&[linear, rotary], text)?;
            Ok((value, if which == 0 { Coordinate::Linear } else { Coordinate::Rotary }))
        }
    }
}

/// Reads a number with any unit: its value in SI, and the exponents of kilogram, metre, second and ampere; `None` for any other text.
pub(crate) fn any_quantity(text: &str) -> Option<(f64, [i32; 4])> {
    let quantity = quantity::parse(text).ok().filter(|quantity| quantity.has_unit)?;
    Some((quantity.value, quantity.dimension.mechanical()))
}

/// The SI unit of this name; `None` if it is not a unit.
#[must_use]
pub fn si_unit(name: &str) -> Option<SiUnit> {
    let (_, exponents) = any_quantity(&format!("1 {name}"))?;
    Some(SiUnit { name: name.to_owned(), exponents })
}

/// Reads a time (s).
///
/// # Errors
/// As [`axis_quantity`].
pub fn time(text: &str) -> Result<f64, ArgumentError> {
    Ok(read(&[&TIME], text)?.0)
}

/// Reads a frequency (Hz).
///
/// # Errors
/// As [`axis_quantity`].
pub fn frequency(text: &str) -> Result<f64, ArgumentError> {
    Ok(read(&[&FREQUENCY], text)?.0)
}

/// Reads a value of a metric (SI) in the same way as a limit of it; `axis` and `motor` are the coordinates of load and motor.
///
/// # Errors
/// As [`axis_quantity`].
pub fn metric_value(metric: Name, axis: Coordinate, motor: Coordinate, text: &str) -> Result<f64, ArgumentError> {
    let candidates: Vec<&Physical> = metric.largest().kind.candidates(Some(axis), Some(motor)).collect();
    Ok(read(&candidates, text)?.0)
}

/// Reads a pure number: `0.02`, `2 %`.
///
/// # Errors
/// As [`axis_quantity`].
pub fn ratio(text: &str) -> Result<f64, ArgumentError> {
    Ok(read(&[&RATIO], text)?.0)
}

/// The value, and the index of its kind in `candidates`.
fn read(candidates: &[&Physical], text: &str) -> Result<(f64, usize), ArgumentError> {
    let wrong = |message: String| ArgumentError { text: text.to_owned(), message };
    reading::read(text, candidates).map(|(which, value)| (value, which)).map_err(|error| match error {
        ReadError::NoQuantity(error) => wrong(format!("{}{}", error.message, after(&error.help))),
        ReadError::NoUnit => {
            wrong(format!("{} needs its unit; {}", names(candidates), proposals(text.trim(), candidates)))
        }
        ReadError::OtherDimension { is, help } => {
            wrong(format!("{} is needed, this is {is}{}", names(candidates), after(help)))
        }
    })
}

/// Help as the end of a message.
fn after(help: &str) -> String {
    if help.is_empty() { String::new() } else { format!("; {help}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_quantity_says_whether_the_axis_is_linear_or_rotary() {
        assert_eq!(axis_quantity(Derivative::Position, None, "250 mm"), Ok((0.25, Coordinate::Linear)));
        let (angle, motion) = axis_quantity(Derivative::Position, None, "180 deg").unwrap();
        assert!((angle - std::f64::consts::PI).abs() < 1e-15 && motion == Coordinate::Rotary);
        assert_eq!(time("1 ms"), Ok(1e-3));
        assert_eq!((frequency("8 kHz"), ratio("2 %"), ratio("0.02")), (Ok(8000.0), Ok(0.02), Ok(0.02)));
    }

    #[test]
    fn a_value_of_a_metric_has_the_unit_that_a_limit_of_it_has() {
        use Coordinate::{Linear, Rotary};
        let value = |metric, text| metric_value(metric, Linear, Rotary, text).map_err(|error| error.message);
        assert_eq!(value(Name::ResidualVibrationAmplitude, "20 um"), Ok(20e-6));
        assert_eq!(value(Name::TorquePeak, "5Nm"), Ok(5.0));
        // An effective value: 4 Arms are 4√2 Apk.
        let current = value(Name::CurrentRms, "4 Arms").unwrap();
        assert!((current - 4.0).abs() < 1e-12, "{current}");
        assert!(value(Name::TorquePeak, "5 N").unwrap_err().contains("a torque is needed, this is a force"));
        assert!(value(Name::ResidualVibrationAmplitude, "20").unwrap_err().contains("a length needs its unit"));
        assert!(value(Name::CurrentRms, "4 A").is_err());
    }

    /// Oracle: the definitions of the units.
    #[test]
    fn units_of_signals_are_known() {
        for (name, exponents) in [
            ("m", [0, 1, 0, 0]),
            ("rad", [0; 4]),
            ("m/s", [0, 1, -1, 0]),
            ("rad/s²", [0, 0, -2, 0]),
            ("m/s⁴", [0, 1, -4, 0]),
            ("N", [1, 1, -2, 0]),
            ("N m", [1, 2, -2, 0]),
            ("A", [0, 0, 0, 1]),
            ("V", [1, 2, -3, -1]),
            ("s", [0, 0, 1, 0]),
        ] {
            assert_eq!(si_unit(name).map(|unit| unit.exponents), Some(exponents), "{name}");
        }
        assert_eq!(si_unit(""), None);
    }

    #[test]
    fn what_is_wrong_is_said_with_the_way_out() {
        let said = |text| axis_quantity(Derivative::Velocity, Some(Coordinate::Linear), text).unwrap_err().to_string();
        assert_eq!(said("1"), "`1`: a velocity needs its unit; write \"1 m/s\"");
        assert_eq!(said("1 m"), "`1 m`: a velocity is needed, this is a length (mm)");
        assert_eq!(said("3000 rpm"), "`3000 rpm`: a velocity is needed, this is an angular velocity (rpm)");
        assert!(said("1 m/sek").contains("unknown unit `sek`"), "{}", said("1 m/sek"));
    }
}
