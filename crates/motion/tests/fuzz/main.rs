//! For any request: a trajectory or a refusal in words, never a panic, never a not-a-number set-point, and the end
//! exactly as guaranteed.

mod interpolation;
mod position_profiles;
mod profiles;
mod rockwell;
mod shapers;
#[cfg(feature = "std")]
mod shortest;
mod tables;
mod transitions;

use servobench_base::Setpoint;
use servobench_motion::{Order, PlanError};

const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

fn is_finite(s: Setpoint) -> bool {
    [s.x, s.v, s.a, s.j, s.s].iter().all(|value| value.is_finite())
}

/// A refusal has a message, and its point exists.
fn refused(error: PlanError, points: usize) {
    if let PlanError::Point { point, .. } = error {
        assert!(point < points, "{error} of {points} points");
    }
    assert!(error.to_string().len() > 20, "{error}");
}
