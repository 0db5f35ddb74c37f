//! Linear and rotary coordinates.

/// Kind of a coordinate, a length or an angle, which also determines the unit of an effort.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Coordinate {
    /// m, N, kg.
    Linear,
    /// rad, N·m, kg·m².
    Rotary,
}

impl Coordinate {
    /// Symbol of its unit.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Linear => "m",
            Self::Rotary => "rad",
        }
    }

    /// Symbol of the unit of an effort along it: a force or a torque.
    #[must_use]
    pub const fn effort_unit(self) -> &'static str {
        match self {
            Self::Linear => "N",
            Self::Rotary => "N m",
        }
    }
}
