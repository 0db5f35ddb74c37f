//! Parameters that are physical quantities, declared by the crates that own them.
use crate::bound::{Bound, Measure};
use crate::physical::Kind;
use core::fmt;
use servobench_base::{ParamError, finite, non_negative, positive};

/// A parameter that is a physical quantity: name, meaning and requirements. Errors name a parameter by this.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Its name in words, unique among the parameters of its crate.
    pub name: &'static str,
    /// Its meaning: a clause that begins a sentence, to which a file's reference adds its default.
    pub meaning: &'static str,
    /// Its quantity, bound and an example.
    pub measure: Measure,
}

/// A parameter that is out of its bound.
pub type ParameterError = ParamError<&'static Parameter>;

impl Parameter {
    /// Returns `value` (SI) if it is within the bound.
    ///
    /// # Errors
    /// [`ParameterError`] otherwise, also for a value that is not finite.
    pub const fn check(&'static self, value: f64) -> Result<f64, ParameterError> {
        self.measure.bound.check(self, value)
    }

    /// Like [`check`](Self::check), with an error that contains only the name of the parameter.
    ///
    /// # Errors
    /// [`ParamError`] otherwise, also for a value that is not finite.
    pub const fn check_in_words(&self, value: f64) -> Result<f64, ParamError> {
        self.measure.bound.check(self.name, value)
    }

    /// The same parameter in the coordinate of the motor, with a separate example.
    #[must_use]
    pub const fn of_motor(&self, example: &'static str) -> Self {
        let kind = match self.measure.kind {
            Kind::Axis(counterparts) => Kind::Motor(counterparts),
            kind => kind,
        };
        Self { measure: Measure { kind, example, ..self.measure }, ..*self }
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl Bound {
    /// Returns `value` (SI) of the parameter `name` if it is within the bound.
    ///
    /// # Errors
    /// [`ParamError`] otherwise, also for a value that is not finite.
    pub const fn check<N: Copy>(self, name: N, value: f64) -> Result<f64, ParamError<N>> {
        match self {
            Self::Positive => positive(name, value),
            Self::NotNegative => non_negative(name, value),
            Self::Any => finite(name, value),
            Self::Within(low, high) => {
                if low <= value && value <= high {
                    Ok(value)
                } else {
                    Err(ParamError { name, value, bound: "within its range" })
                }
            }
        }
    }
}

/// Declares parameters, each a `&'static` [`Parameter`], beside the settings they describe; the doc comment of one is its meaning,
/// without a full stop.
///
/// ```
/// use servobench_config::{Kind::Plain, positive, quantities::RESISTANCE};
/// servobench_config::parameters! {
///     /// A parameter of the motor.
///     pub enum Parameter {
///         /// Stator resistance
///         RESISTANCE "resistance" = positive(Plain(&RESISTANCE), "0.36 Ohm");
///     }
/// }
/// assert_eq!(Parameter::RESISTANCE.meaning, "Stator resistance");
/// assert_eq!(Parameter::RESISTANCE.check(0.36), Ok(0.36));
/// let message = Parameter::RESISTANCE.check(-1.0).unwrap_err().to_string();
/// assert_eq!(message, "`resistance` must be finite and positive, got -1");
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[doc = $doc:literal])+
        $visibility:vis enum $type:ident {
            $( $(#[doc = $meaning:literal])+ $parameter:ident $name:literal = $measure:expr; )+
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy)]
        $visibility enum $type {}

        impl $type {
            $(
                $(#[doc = $meaning])+
                pub const $parameter: &'static $crate::Parameter = &$crate::Parameter {
                    name: $name,
                    meaning: concat!($($meaning),+).trim_ascii(),
                    measure: $measure,
                };
            )+

            /// Every parameter.
            pub const ALL: &'static [&'static $crate::Parameter] = &[$(Self::$parameter),+];
        }
    };
}
