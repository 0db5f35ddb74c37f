//! Calls and checks that many tests share.
use crate::bench::{Bench, LIMITS};
use servobench_plcopen::{MoveAbsoluteInputs, MoveVelocityInputs};

pub(crate) fn to(position: f64) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs { execute: true, position, ..MoveAbsoluteInputs::within(&LIMITS) }
}

pub(crate) fn running(velocity: f64) -> MoveVelocityInputs {
    MoveVelocityInputs { execute: true, velocity, ..MoveVelocityInputs::within(&LIMITS) }
}

/// Checks that the axis is commanded to `x`, bit for bit.
pub(crate) fn at(bench: &Bench, x: f64) {
    assert_eq!(bench.axis.commanded().x.to_bits(), x.to_bits(), "{} {x}", bench.axis.commanded().x);
}
