//! An FMU as a simulation wants it, and the numbers that it declares.
use crate::description::{DataType, Exponents};
use servobench_fmu_file::{FmuFile, SiPort};

/// An FMU as a simulation wants it: initialised and wired, its numbers in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuRequest<'a> {
    /// The FMU.
    pub file: &'a FmuFile,
    /// Name of the instance; `None`: that of the model.
    pub name: Option<&'a str>,
    /// Inputs that are exchanged.
    pub inputs: Vec<SiPort>,
    /// Outputs that are exchanged.
    pub outputs: Vec<SiPort>,
    /// How long its steps are (s).
    pub step: f64,
    /// When its last step ends (s), if that is known: at the end of the run or after it, since steps are whole.
    pub end: Option<f64>,
    /// Whether it waits in its initialisation for its inputs ([`Slave::start`](crate::Slave::start)).
    pub waits: bool,
}

/// A number that an FMU exchanges, as its model description declares it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeclaredNumber {
    /// Its type.
    pub data_type: DataType,
    /// Its unit, if it has one.
    pub unit: Option<DeclaredUnit>,
}

/// A unit of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeclaredUnit {
    /// Its name in the description.
    pub name: String,
    /// What it is made of.
    pub exponents: Exponents,
}

impl DeclaredUnit {
    /// True where both measure the same. The radian, which some count and some do not, is one.
    #[must_use]
    pub fn measures_the_same_as(&self, other: &Self) -> bool {
        let without_radian = |exponents| Exponents { rad: 0, ..exponents };
        without_radian(self.exponents) == without_radian(other.exponents)
    }
}
