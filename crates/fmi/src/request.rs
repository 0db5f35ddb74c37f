//! A request for an FMU by a simulation, and the numbers that the FMU declares.
use crate::description::{DataType, Exponents};
use servobench_fmu_file::{FmuFile, SiPort};

/// Request for an FMU, initialised and wired, with its numbers in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuRequest<'a> {
    /// The FMU.
    pub file: &'a FmuFile,
    /// Name of the instance; `None` for that of the model.
    pub name: Option<&'a str>,
    /// Exchanged inputs.
    pub inputs: Vec<SiPort>,
    /// Exchanged outputs.
    pub outputs: Vec<SiPort>,
    /// Length of its steps (s).
    pub step: f64,
    /// End of its last step (s), if known: at the end of the run or after it, since steps are whole.
    pub end: Option<f64>,
    /// True if it waits in its initialisation for its inputs ([`Slave::start`](crate::Slave::start)).
    pub waits: bool,
}

/// A number exchanged with an FMU, as its model description declares it.
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
    /// Its dimension.
    pub exponents: Exponents,
}

impl DeclaredUnit {
    /// True if both measure the same. The radian is ignored, since some tools count it and some do not.
    #[must_use]
    pub fn measures_the_same_as(&self, other: &Self) -> bool {
        let without_radian = |exponents| Exponents { rad: 0, ..exponents };
        without_radian(self.exponents) == without_radian(other.exponents)
    }
}
