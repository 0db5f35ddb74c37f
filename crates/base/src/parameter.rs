//! Checks of parameters where they enter; the error names the field, the value and the bound.
use servobench_base::Stateful;
use thiserror::Error;

/// A parameter outside its bound.
#[derive(Debug, Clone, Copy, PartialEq, Error, Stateful)]
#[error("`{name}` must be {bound}, got {value}")]
pub struct ParamError<N = &'static str> {
    /// The parameter: a name, or the identifier of its owner.
    pub name: N,
    /// Rejected value (SI).
    pub value: f64,
    /// The bound in words: "finite and positive".
    pub bound: &'static str,
}

/// Returns `value` if it is finite and above zero.
///
/// # Errors
/// [`ParamError`] otherwise.
pub const fn positive<N: Copy>(name: N, value: f64) -> Result<f64, ParamError<N>> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(ParamError { name, value, bound: "finite and positive" })
    }
}

/// Returns `value` if it is finite and not below zero.
///
/// # Errors
/// [`ParamError`] otherwise.
pub const fn non_negative<N: Copy>(name: N, value: f64) -> Result<f64, ParamError<N>> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(ParamError { name, value, bound: "finite and not negative" })
    }
}

/// Returns `value` if it is finite.
///
/// # Errors
/// [`ParamError`] otherwise.
pub const fn finite<N: Copy>(name: N, value: f64) -> Result<f64, ParamError<N>> {
    if value.is_finite() { Ok(value) } else { Err(ParamError { name, value, bound: "finite" }) }
}

/// Returns `value` if it is above zero; infinity stands for no limit.
///
/// # Errors
/// [`ParamError`] otherwise.
pub const fn limit<N: Copy>(name: N, value: f64) -> Result<f64, ParamError<N>> {
    if value > 0.0 { Ok(value) } else { Err(ParamError { name, value, bound: "positive" }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_names_field_value_and_bound() {
        let e = positive("mass", -1.0).unwrap_err();
        assert_eq!(e.to_string(), "`mass` must be finite and positive, got -1");
        assert_eq!(non_negative("viscous", f64::NAN).unwrap_err().bound, "finite and not negative");
        assert!(finite("bias", f64::INFINITY).is_err());
        assert_eq!(non_negative("viscous", 0.0), Ok(0.0));
        assert_eq!(limit("max_effort", f64::INFINITY), Ok(f64::INFINITY));
        assert!(limit("max_effort", 0.0).is_err() && limit("max_effort", f64::NAN).is_err());
    }
}
