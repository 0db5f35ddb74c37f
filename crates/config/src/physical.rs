//! What parameters measure: the dimensions that each accepts, and how messages call them.
use crate::dimension::Dimension;
use servobench_base::Coordinate;

/// A physical quantity as parameters accept it.
#[derive(Debug, PartialEq)]
pub struct Physical {
    /// With its article: "a stiffness".
    pub name: &'static str,
    /// Unit that a proposal uses.
    pub unit: &'static str,
    /// Accepted dimensions, and what one SI unit of each is in the unit that the parameter means.
    pub accepts: &'static [(Dimension, f64)],
}

/// What a parameter measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// One thing, whatever the axis.
    Plain(&'static Physical),
    /// In the axis coordinate: linear or rotary as the axis is.
    Axis(&'static Counterparts),
    /// In the motor coordinate: linear or rotary as the motor is.
    Motor(&'static Counterparts),
}

/// A pair of corresponding quantities: force and torque, mass and inertia.
#[derive(Debug, PartialEq)]
pub struct Counterparts {
    /// Along a line.
    pub linear: Physical,
    /// Around a shaft.
    pub rotary: Physical,
}

impl Kind {
    /// What the parameter measures on this axis; both when that is not known.
    pub fn candidates(
        self,
        axis: Option<Coordinate>,
        motor: Option<Coordinate>,
    ) -> impl Iterator<Item = &'static Physical> {
        let (pair, coordinate) = match self {
            Self::Plain(physical) => return [Some(physical), None].into_iter().flatten(),
            Self::Axis(pair) => (pair, axis),
            Self::Motor(pair) => (pair, motor),
        };
        let [linear, rotary] = [Some(&pair.linear), Some(&pair.rotary)];
        match coordinate {
            Some(Coordinate::Linear) => [linear, None],
            Some(Coordinate::Rotary) => [rotary, None],
            None => [linear, rotary],
        }
        .into_iter()
        .flatten()
    }
}
