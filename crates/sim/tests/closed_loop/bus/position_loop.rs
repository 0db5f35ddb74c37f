//! Integral and derivative of the master's position loop, on an axis.
use crate::rig::{MOVE, SCREW, last, run, values};
use servobench_trace::Recording;

const BUS: &str = "[bus]\ncycle = \"1 ms\"\nmode = \"csv\"\nposition_gain = \"60 1/s\"\n";

fn with(more: &str, program: &str) -> Recording {
    run(&format!("{SCREW}{BUS}{more}{program}"))
}

/// 1 m at 0.5 m/s: 1.9 s of constant velocity.
const LONG: &str = "[[program]]\nmove_to = \"1 m\"\n";

fn error_at(recording: &Recording, t: f64) -> f64 {
    values(recording, "following_error.load")[recording.index_at(t)]
}

/// Oracle: without feedforward a proportional loop is v/K behind for as long as it moves; with an integral the error goes with the slow
/// root of s² + K·s + K/T_i.
#[test]
fn the_lag_of_a_constant_velocity_goes_to_zero() {
    let bare = with("", LONG);
    assert!((error_at(&bare, 1.5) - 0.5 / 60.0).abs() < 20e-6, "{}", error_at(&bare, 1.5));
    let integral = with("position_integral_time = \"0.1 s\"\n", LONG);
    let (early, late) = (error_at(&integral, 0.9), error_at(&integral, 1.1));
    let slow = 30.0 - (900.0_f64 - 600.0).sqrt();
    println!("{early:.3e} m, {late:.3e} m 0.2 s later, root {slow} 1/s");
    assert!(late.abs() < early.abs() * (-slow * 0.2).exp() * 1.5 + 3e-6, "{early} {late}");
    assert!(error_at(&integral, 1.9).abs() < 5e-6, "{}", error_at(&integral, 1.9));
}

/// Oracle: friction and inertia do not move the end of the axis, an integral may: it comes to rest on the target.
#[test]
fn it_ends_on_the_target_with_every_part() {
    for more in [
        "position_integral_time = \"80 ms\"\n",
        "position_derivative_time = \"0.6 ms\"\n",
        "velocity_offset = true\nposition_integral_time = \"80 ms\"\nposition_derivative_time = \"0.6 ms\"\nposition_derivative_filter = \"0.3 ms\"\n",
    ] {
        let program = format!("{MOVE}[[program]]\nwait = \"1 s\"\n");
        let recording = with(more, &program);
        let end = last(&recording, "load.position");
        assert!((end - 0.25).abs() < 5e-6, "{more}: {end}");
    }
}
