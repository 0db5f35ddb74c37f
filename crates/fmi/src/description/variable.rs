//! Variables.
use super::clock::Ticks;

servobench_config::choices! {
    /// Who gives a variable its value.
    pub enum Causality {
        /// the importer, before initialisation; a dimension of arrays (FMI 3.0)
        StructuralParameter = "structuralParameter",
        /// the importer, before or during initialisation
        Parameter = "parameter",
        /// the FMU, from parameters
        CalculatedParameter = "calculatedParameter",
        /// the importer, at every communication point
        Input = "input",
        /// the FMU; others may use it
        Output = "output",
        /// the FMU; for looking at only
        Local = "local",
        /// the independent variable, time
        Independent = "independent",
    }
}

servobench_config::choices! {
    /// When a variable changes.
    pub enum Variability {
        /// never
        Constant = "constant",
        /// not after initialisation
        Fixed = "fixed",
        /// when a tunable parameter does
        Tunable = "tunable",
        /// at events
        Discrete = "discrete",
        /// at any time
        Continuous = "continuous",
    }
}

servobench_config::choices! {
    /// How a variable is initialised.
    pub enum Initial {
        /// with its start value
        Exact = "exact",
        /// by an iteration that begins with its start value
        Approx = "approx",
        /// from other variables
        Calculated = "calculated",
    }
}

servobench_config::choices! {
    /// Type of a variable. `Real` of FMI 2.0 is `Float64`, its `Integer` is `Int32`.
    #[derive(PartialOrd, Ord)]
    pub enum DataType {
        /// single precision
        Float32 = "Float32",
        /// double precision
        Float64 = "Float64",
        /// signed, 8 bits
        Int8 = "Int8",
        /// unsigned, 8 bits
        UInt8 = "UInt8",
        /// signed, 16 bits
        Int16 = "Int16",
        /// unsigned, 16 bits
        UInt16 = "UInt16",
        /// signed, 32 bits
        Int32 = "Int32",
        /// unsigned, 32 bits
        UInt32 = "UInt32",
        /// signed, 64 bits
        Int64 = "Int64",
        /// unsigned, 64 bits
        UInt64 = "UInt64",
        /// TRUE or FALSE
        Boolean = "Boolean",
        /// text
        String = "String",
        /// bytes
        Binary = "Binary",
        /// an item of an enumeration: signed, 64 bits in FMI 3.0, 32 in FMI 2.0
        Enumeration = "Enumeration",
        /// A clock: no value, it ticks
        Clock = "Clock",
    }
}

impl DataType {
    /// True if it is a floating-point number.
    #[must_use]
    pub fn is_float(self) -> bool {
        matches!(self, Self::Float32 | Self::Float64)
    }

    /// Least and greatest value of an integer type.
    #[must_use]
    pub fn integers(self) -> Option<(i128, i128)> {
        Some(match self {
            Self::Int8 => (i8::MIN.into(), i8::MAX.into()),
            Self::UInt8 => (0, u8::MAX.into()),
            Self::Int16 => (i16::MIN.into(), i16::MAX.into()),
            Self::UInt16 => (0, u16::MAX.into()),
            Self::Int32 => (i32::MIN.into(), i32::MAX.into()),
            Self::UInt32 => (0, u32::MAX.into()),
            Self::Int64 | Self::Enumeration => (i64::MIN.into(), i64::MAX.into()),
            Self::UInt64 => (0, u64::MAX.into()),
            _ => return None,
        })
    }
}

/// Values of a scalar or, in row-major order, of an array.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Floating-point numbers.
    Float(Vec<f64>),
    /// Integers or items of an enumeration.
    Integer(Vec<i128>),
    /// TRUE or FALSE.
    Boolean(Vec<bool>),
    /// Texts.
    String(Vec<String>),
    /// Byte strings.
    Binary(Vec<Vec<u8>>),
}

impl Values {
    /// Number of values.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Float(all) => all.len(),
            Self::Integer(all) => all.len(),
            Self::Boolean(all) => all.len(),
            Self::String(all) => all.len(),
            Self::Binary(all) => all.len(),
        }
    }

    /// True if it holds none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// An extent of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Fixed number of elements.
    Fixed(u64),
    /// Value of a structural parameter, given by its position in [`crate::ModelDescription::variables`].
    Structural(usize),
}

/// Another name of a variable (FMI 3.0).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Alias {
    /// The name.
    pub name: String,
    /// Its purpose.
    pub description: String,
    /// Unit for display; empty if as the variable.
    pub display_unit: String,
}

/// A variable of an FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// Key of the variable in the functions of the standard. In FMI 2.0 several variables of a type may share one.
    pub value_reference: u32,
    /// Its meaning.
    pub description: String,
    /// Source of its value.
    pub causality: Causality,
    /// Times at which it changes.
    pub variability: Variability,
    /// Kind of initialisation; none for the independent variable.
    pub initial: Option<Initial>,
    /// Its type.
    pub data_type: DataType,
    /// Name of its declared type; empty without one.
    pub declared_type: String,
    /// Its enumeration, by the position in [`crate::ModelDescription::enumerations`].
    pub enumeration: Option<usize>,
    /// Extents; none for a scalar.
    pub dimensions: Vec<Dimension>,
    /// Start value: one for each element, or one for all.
    pub start: Option<Values>,
    /// Least value, in the variable's unit. 64-bit integers are rounded.
    pub min: Option<f64>,
    /// Greatest value.
    pub max: Option<f64>,
    /// Ordinary magnitude.
    pub nominal: Option<f64>,
    /// Physical quantity as the FMU names it; empty without one.
    pub quantity: String,
    /// Its unit, by the position in [`crate::ModelDescription::units`].
    pub unit: Option<usize>,
    /// Unit for display, one of those of its unit; empty without one.
    pub display_unit: String,
    /// True if it is a difference, to which the offset of its unit does not apply.
    pub is_relative: bool,
    /// Variable of which it is the time derivative, by position.
    pub derivative_of: Option<usize>,
    /// Timing of its ticks, if it is a clock (FMI 3.0).
    pub ticks: Option<Ticks>,
    /// Value references of the clocks it ticks with (FMI 3.0).
    pub clocks: Vec<u32>,
    /// Other names (FMI 3.0).
    pub aliases: Vec<Alias>,
}
