//! Numbers exchanged with an FMU.

/// A number exchanged with an FMU, in SI units. The FMU has it in the unit of its model description, or in SI units if that gives none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiPort {
    /// Name of the variable, or `name[2]`, `name[2,1]` of an element of an array, counted from 1.
    pub variable: String,
    /// Its unit in the scenario; `None` if any is accepted.
    pub unit: Option<SiUnit>,
}

/// An SI unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiUnit {
    /// Its usual notation.
    pub name: String,
    /// Exponents of kilogram, metre, second and ampere. The radian, which some count and some do not, counts as one.
    pub exponents: [i32; 4],
}
