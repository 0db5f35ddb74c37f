//! Types with a few named values.
use servobench_base::Coordinate;

/// A type with a few named values: an enumeration of alternatives among which users choose by name.
pub trait Choice: Copy + 'static {
    /// Every value: name, value, meaning.
    const ALL: &'static [(&'static str, Self, &'static str)];

    /// The value with this name.
    #[must_use]
    fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, ..)| *known == name).map(|(_, value, _)| *value)
    }

    /// Its name.
    #[must_use]
    fn name(self) -> &'static str
    where
        Self: PartialEq,
    {
        Self::ALL.iter().find(|(_, value, _)| *value == self).map_or("", |(name, ..)| name)
    }
}

impl Choice for Coordinate {
    const ALL: &'static [(&'static str, Self, &'static str)] = &[
        ("linear", Self::Linear, "the load moves along a line: m, N, kg"),
        ("rotary", Self::Rotary, "the load turns: rad, N·m, kg·m²"),
    ];
}

/// Declares an enumeration whose values users choose by name; the doc comment of a value is its meaning. A default is optional:
/// `enum Kind default Pi`.
///
/// ```
/// servobench_config::choices! {
///     /// Kind of a velocity loop.
///     pub enum Kind {
///         /// proportional
///         P = "p",
///         /// proportional and integral
///         Pi = "pi",
///     }
/// }
/// use servobench_config::Choice as _;
/// assert_eq!(Kind::from_name("pi"), Some(Kind::Pi));
/// assert_eq!(Kind::P.name(), "p");
/// assert_eq!(Kind::ALL[1].2, "proportional and integral");
/// ```
///
/// Alternatives may have parameters; the names then belong to a second type, the `kind` of the first:
///
/// ```
/// servobench_config::choices! {
///     /// Method of finding velocities.
///     pub enum Velocities named VelocitiesKind {
///         /// the mean of the neighbours
///         Average = "average",
///         /// the same, smoothed
///         Smooth {
///             /// Number of passes.
///             passes: u32,
///         } = "smooth",
///     }
/// }
/// use servobench_config::Choice as _;
/// assert_eq!(VelocitiesKind::from_name("smooth"), Some(VelocitiesKind::Smooth));
/// assert_eq!(Velocities::Smooth { passes: 3 }.kind().name(), "smooth");
/// ```
#[macro_export]
macro_rules! choices {
    (
        $(#[doc = $doc:literal])+
        $(#[derive($($derived:ident),+)])?
        $visibility:vis enum $type:ident $(default $default:ident)? {
            $( $(#[doc = $meaning:literal])+ $variant:ident = $name:literal, )+
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash $($(, $derived)+)?)]
        $visibility enum $type {
            $( $(#[doc = $meaning])+ $variant, )+
        }

        $(
            impl Default for $type {
                fn default() -> Self {
                    Self::$default
                }
            }
        )?

        impl $crate::Choice for $type {
            const ALL: &'static [(&'static str, Self, &'static str)] =
                &[$( ($name, Self::$variant, concat!($($meaning),+).trim_ascii()), )+];
        }
    };
    (
        $(#[doc = $doc:literal])+
        $(#[derive($($derived:ident),+)])?
        $visibility:vis enum $type:ident named $kind:ident $(default $default:ident)? {
            $(
                $(#[doc = $meaning:literal])+
                $variant:ident $({ $( $(#[doc = $field_doc:literal])+ $field:ident: $field_type:ty, )+ })? = $name:literal,
            )+
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq $($(, $derived)+)?)]
        $visibility enum $type {
            $(
                $(#[doc = $meaning])+
                $variant $({ $( $(#[doc = $field_doc])+ $field: $field_type, )+ })?,
            )+
        }

        impl $type {
            /// The alternative without its parameters.
            #[must_use]
            $visibility const fn kind(&self) -> $kind {
                match self {
                    $( Self::$variant { .. } => $kind::$variant, )+
                }
            }
        }

        $crate::choices! {
            $(#[doc = $doc])+
            ///
            /// The alternatives without their parameters.
            $(#[derive($($derived),+)])?
            $visibility enum $kind $(default $default)? {
                $( $(#[doc = $meaning])+ $variant = $name, )+
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    choices! {
        /// An example.
        enum Example default Second {
            /// the first of them,
            /// in two lines
            First = "first",
            /// the second
            Second = "second",
        }
    }

    choices! {
        /// An example with parameters.
        enum WithParameters named Kind default None {
            /// no parameter
            None = "none",
            /// two of them
            Two {
                /// One.
                one: f64,
                /// The other.
                other: u32,
            } = "two",
        }
    }

    #[test]
    fn alternatives_with_parameters_are_chosen_by_their_kind() {
        let both = [WithParameters::None, WithParameters::Two { one: 0.5, other: 3 }];
        assert_eq!(both.map(|one| one.kind().name()), ["none", "two"]);
        assert_eq!((Kind::default(), Kind::from_name("two")), (Kind::None, Some(Kind::Two)));
        assert_eq!(Kind::ALL[1].2, "two of them");
        assert!(matches!(both[1], WithParameters::Two { one: 0.5, other: 3 }));
    }

    #[test]
    fn values_have_names_and_meanings() {
        assert_eq!(Example::First.name(), "first");
        assert_eq!(Example::from_name("second"), Some(Example::default()));
        assert_eq!(Example::from_name("third"), None);
        assert_eq!(Example::ALL[0].2, "the first of them, in two lines");
    }
}
