//! Quantities of parameters: the dimensions that each accepts, and their names in messages.
use crate::dimension::Dimension;
use servobench_base::Coordinate;

/// A physical quantity that parameters accept.
#[derive(Debug, PartialEq)]
pub struct Physical {
    /// Name with its article: "a stiffness".
    pub name: &'static str,
    /// Unit used in proposals.
    pub unit: &'static str,
    /// Accepted dimensions, each with the value of its SI unit in the unit of the parameter.
    pub accepts: &'static [(Dimension, f64)],
}

/// Quantity of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// The same quantity for every axis.
    Plain(&'static Physical),
    /// In the axis coordinate: linear or rotary like the axis.
    Axis(&'static Counterparts),
    /// In the motor coordinate: linear or rotary like the motor.
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
    /// The quantity of the parameter on this axis; both if the coordinate is unknown.
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
