//! Parameters that are physical quantities, as the crate that owns them declares them.
use crate::bound::{Bound, Measure};
use crate::physical::Kind;
use servobench_base::{ParamError, finite, non_negative, positive};

/// What a parameter means and what it must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Description {
    /// What it means: a clause that begins a sentence, to which a file's reference adds its default.
    pub meaning: &'static str,
    /// What it measures, its bound and an example.
    pub measure: Measure,
}

impl Description {
    /// The same of the motor, in its own coordinate, with an example of its own.
    #[must_use]
    pub const fn of_motor(self, example: &'static str) -> Self {
        let kind = match self.measure.kind {
            Kind::Axis(counterparts) => Kind::Motor(counterparts),
            kind => kind,
        };
        Self { measure: Measure { kind, example, ..self.measure }, ..self }
    }
}

impl Bound {
    /// `value` (SI) of the parameter `name`, when it is within the bound.
    ///
    /// # Errors
    /// [`ParamError`] otherwise, also for what is not finite.
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

/// Declares the parameters of a crate, by which its errors name them; the doc comment of one is its meaning, without a full stop.
///
/// ```
/// use servobench_config::{Kind::Plain, positive, quantities::RESISTANCE};
/// servobench_config::parameters! {
///     /// A parameter of the motor.
///     pub enum Parameter {
///         /// Stator resistance
///         Resistance "resistance" = positive(Plain(&RESISTANCE), "0.36 Ohm");
///     }
/// }
/// assert_eq!(Parameter::Resistance.description().meaning, "Stator resistance");
/// assert_eq!(Parameter::Resistance.check(0.36), Ok(0.36));
/// let message = Parameter::Resistance.check(-1.0).unwrap_err().to_string();
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
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        $visibility enum $type {
            $( $(#[doc = $meaning])+ $parameter, )+
        }

        impl $type {
            /// Every parameter.
            pub const ALL: &'static [Self] = &[$(Self::$parameter),+];

            /// Its name in words.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $( Self::$parameter => $name, )+
                }
            }

            /// What it means and what it must be.
            #[must_use]
            pub const fn description(self) -> $crate::Description {
                match self {
                    $( Self::$parameter => $crate::Description {
                        meaning: concat!($($meaning),+).trim_ascii(),
                        measure: $measure,
                    }, )+
                }
            }

            /// `value` (SI), when it is within the bound of this parameter.
            ///
            /// # Errors
            #[doc = concat!("An error that names the ", stringify!($type), ", the value and the bound.")]
            pub const fn check(self, value: f64) -> Result<f64, $crate::ParamError<Self>> {
                self.description().measure.bound.check(self, value)
            }

            /// The same with an error that has the parameter's name in words.
            ///
            /// # Errors
            /// An error that names the parameter, the value and the bound.
            pub const fn check_in_words(self, value: f64) -> Result<f64, $crate::ParamError> {
                self.description().measure.bound.check(self.name(), value)
            }
        }

        impl core::fmt::Display for $type {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}
