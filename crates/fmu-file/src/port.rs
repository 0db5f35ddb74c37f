//! Numbers that are exchanged.

/// A number that is exchanged with an FMU, in SI units. The FMU has it in the unit of its model description; what has none there
/// counts in SI units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiPort {
    /// Name of the variable, or `name[2]`, `name[2,1]` of an element of an array, counted from 1.
    pub variable: String,
    /// What the number is on our side; `None` if it may be anything.
    pub unit: Option<SiUnit>,
}

/// An SI unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiUnit {
    /// As people write it.
    pub name: String,
    /// Exponents of kilogram, metre, second and ampere. The radian, which some count and some do not, is one.
    pub exponents: [i32; 4],
}
