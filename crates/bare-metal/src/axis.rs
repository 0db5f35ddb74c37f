//! A move with a new target while it runs.
use core::panic::PanicInfo;
use servobench_motion::online::{Effort, Target, Transition};
use servobench_motion::{Limits, Order, PlanError, Profile};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

/// The position (m) `t` seconds after the start of a move to `first` (m) whose target was changed to `then` (m) after `sent` seconds; NaN
/// when that cannot be planned.
#[expect(unsafe_code, reason = "the name is for a caller in C, and no other symbol of the program has it")]
#[unsafe(no_mangle)]
extern "C" fn servobench_axis_position(first: f64, then: f64, sent: f64, t: f64) -> f64 {
    position(first, then, sent, t).unwrap_or(f64::NAN)
}

fn position(first: f64, then: f64, sent: f64, t: f64) -> Result<f64, PlanError> {
    let begun = Profile::plan_optimal(Order::Fourth, first, &LIMITS)?;
    if t < sent {
        return Ok(begun.at(t).x);
    }
    let target = Target::Position { x: then, v: 0.0 };
    let sent_on = Transition::plan(Order::Fourth, &begun.at(sent), &target, &LIMITS.into(), Effort::Fast)?;
    Ok(sent_on.at(t - sent).x)
}

#[panic_handler]
fn stop(_: &PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
