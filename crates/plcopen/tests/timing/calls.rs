//! What many tests call, and what they look at.
use crate::bench::{Bench, LIMITS};
use servobench_plcopen::{MoveAbsoluteInputs, MoveVelocityInputs};

pub(crate) fn to(position: f64) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs { execute: true, position, ..MoveAbsoluteInputs::within(&LIMITS) }
}

pub(crate) fn running(velocity: f64) -> MoveVelocityInputs {
    MoveVelocityInputs { execute: true, velocity, ..MoveVelocityInputs::within(&LIMITS) }
}

/// The axis is commanded to be at `x`, bit for bit.
pub(crate) fn at(bench: &Bench, x: f64) {
    assert_eq!(bench.axis.commanded().x.to_bits(), x.to_bits(), "{} {x}", bench.axis.commanded().x);
}
