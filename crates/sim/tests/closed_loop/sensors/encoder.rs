//! What errors of the encoder do to an axis.
use super::axis::{RATE, TORQUE_CONSTANT, harmonic, turning, turning_with, whole_turns};
use crate::rig::{run, values};
use servobench_trace::Recording;
use std::f64::consts::TAU;

/// What the encoder reads too much, row by row (rad).
fn error(recording: &Recording) -> Vec<f64> {
    let [read, position] = ["measured.motor.position", "motor.position"].map(|name| values(recording, name));
    read.iter().zip(position).map(|(read, position)| read - position).collect()
}

/// Loops that are too slow to follow what repeats with the turn.
const SLOW: [&str; 2] = ["2 Hz", "0.3 Hz"];

/// Error of the reading at so many periods per turn (rad).
fn error_at(encoder: &str, rpm: f64, per_turn: f64) -> f64 {
    let recording = run(&turning_with(rpm, 14.0, encoder, "{}", SLOW));
    harmonic(&recording, whole_turns(&recording, 6.0, 10.0), &error(&recording), per_turn)
}

/// Oracle: P/(4π)·a twice per period, P/(2π)·o once, P/(4π)·ε twice (Heydemann 1981), P = 2π/64. The next order is of the size
/// of the error: 1 % of it.
#[test]
fn errors_of_the_signals_repeat_with_their_period() {
    let period = TAU / 64.0;
    for (error, times, expected) in [
        ("amplitude_error = 0.01", 2.0, period / (2.0 * TAU) * 0.01),
        ("offset_sine = 0.01", 1.0, period / TAU * 0.01),
        ("offset_cosine = -0.008", 1.0, period / TAU * 0.008),
        ("phase_error = \"0.5 deg\"", 2.0, period / (2.0 * TAU) * 0.5_f64.to_radians()),
    ] {
        let found = error_at(&format!("{{ lines_per_rev = 64, {error} }}"), 61.0, 64.0 * times);
        assert!((found / expected - 1.0).abs() < 0.012, "{error}: {found} {expected}");
    }
}

/// Oracle: e/r once per turn.
#[test]
fn an_eccentric_disc_errs_once_per_turn() {
    let found = error_at("{ eccentricity = \"13 um\", disc_radius = \"22 mm\" }", 300.0, 1.0);
    assert!((found / (13e-6 / 22e-3) - 1.0).abs() < 0.001, "{found}");
}

/// Oracle: a position loop that is fast against the turn holds what is read, so that the axis errs by e/r the other way.
#[test]
fn an_axis_follows_its_encoder_where_the_loop_is_fast() {
    let text =
        turning_with(7.0, 3.0, "{ eccentricity = \"13 um\", disc_radius = \"22 mm\" }", "{}", ["40 Hz", "15 Hz"]);
    let recording = run(&text);
    let [following, position] = ["following_error.motor", "motor.position"].map(|name| values(&recording, name));
    assert!(position.len() == following.len());
    let found = harmonic(&recording, whole_turns(&recording, 0.9, 1.9), following, 1.0);
    // 0.117 Hz against 15 Hz, with a velocity that is fed forward.
    assert!((found / (13e-6 / 22e-3) - 1.0).abs() < 0.01, "{found}");
}

/// Oracle: the reading is v·τ behind, and the axis as much ahead of its reference.
#[test]
fn an_old_reading_lets_the_axis_run_ahead() {
    for latency in [30e-6, 3.3 / RATE, 5.0 / RATE] {
        let encoder = format!("{{ latency = \"{latency} s\" }}");
        let recording = run(&turning(300.0, 20.0, &encoder, "{}"));
        let rows = whole_turns(&recording, 12.0, 16.0);
        let error = error(&recording);
        let mean = |values: &[f64]| values[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let velocity = mean(values(&recording, "motor.velocity"));
        assert!((mean(&error) / (-velocity * latency) - 1.0).abs() < 1e-3, "{latency}");
        let ahead = -mean(values(&recording, "following_error.motor"));
        // The difference of two positions is half a cycle old, which the drive knows; the feedback of that is left.
        let without = {
            let recording = run(&turning(300.0, 20.0, "{ step = \"1e-9 deg\" }", "{}"));
            -mean(values(&recording, "following_error.motor"))
        };
        assert!(((ahead - without) / (velocity * latency) - 1.0).abs() < 0.01, "{latency}: {ahead} {without}");
    }
}

/// Oracle: what the commutation is off by, Park's transformation is off by: i_d = −i_q·sin of the angle, and the torque per ampere that
/// is asked for falls with its cosine.
#[test]
fn a_commutation_that_is_off_costs_torque() {
    for degrees in [11.0, -23.0_f64] {
        let recording = run(&turning(300.0, 20.0, &format!("{{ commutation_offset = \"{degrees} deg\" }}"), "{}"));
        let rows = whole_turns(&recording, 12.0, 16.0);
        let mean = |name: &str| values(&recording, name)[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let [d, q, measured_q] = ["current.d", "current.q", "measured.current.q"].map(mean);
        let angle = degrees.to_radians();
        assert!(((-d).atan2(q) / angle - 1.0).abs() < 1e-3, "{d} {q}");
        assert!((q / (measured_q * angle.cos()) - 1.0).abs() < 1e-3);
        // The load is the same: the q current that makes it, too.
        assert!((TORQUE_CONSTANT * q / 1.9 - 1.0).abs() < 1e-3, "{q}");
    }
}

/// Oracle: with n + f increments per cycle of the velocity loop the difference is wrong by a variance of q²·f·(1 − f)/T²; times k_p² it
/// is in the torque that is asked for. To 1 %: the loop is slow and the axis heavy, so that it does not answer.
#[test]
fn increments_make_noise_in_the_velocity_and_in_the_torque() {
    let counts = 20_011.0;
    for rpm in [37.3, 61.7] {
        let encoder = format!("{{ counts_per_rev = {counts} }}");
        let recording = run(&turning_with(rpm, 14.0, &encoder, "{}", ["0.5 Hz", "0.05 Hz"]));
        let rows = whole_turns(&recording, 9.0, 12.0);
        let (position, asked) = (values(&recording, "motor.position"), values(&recording, "effort.reference"));
        let cycle = 2.0 / RATE;
        // Two ticks a cycle: the increments that are passed in each.
        let increment = TAU / counts;
        let passed = |k: usize| (position[k] - position[k - 2]) / increment;
        let first = rows.start.next_multiple_of(2);
        let cycles: Vec<usize> = (first..rows.end).step_by(2).collect();
        // Half the moving mean below is left out at either end.
        let inner = 800..cycles.len() - 800;
        let of_counts = inner.clone().map(|i| passed(cycles[i]).fract() * (1.0 - passed(cycles[i]).fract()));
        let variance_of_counts = of_counts.sum::<f64>() / inner.len() as f64;
        // k_p = J·ω.
        let gain = 0.0043 * TAU * 0.5;
        let expected = (gain * increment / cycle).powi(2) * variance_of_counts;
        // What is asked for, less its slow course: a moving mean of 0.2 s.
        let slow = |i: usize| {
            let near = &cycles[i.saturating_sub(800)..(i + 801).min(cycles.len())];
            near.iter().map(|k| asked[*k]).sum::<f64>() / near.len() as f64
        };
        let found = inner.clone().map(|i| (asked[cycles[i]] - slow(i)).powi(2)).sum::<f64>() / inner.len() as f64;
        assert!((found / expected - 1.0).abs() < 0.01, "{rpm}: {found} {expected}");
    }
}

/// An absolute encoder of four turns: the drive counts on, and the axis does not notice.
#[test]
fn an_absolute_encoder_is_counted_on() {
    let [free, wrapped] = ["{ counts_per_rev = 8192 }", "{ counts_per_rev = 8192, turn_bits = 2 }"]
        .map(|encoder| run(&turning(300.0, 20.0, encoder, "{}")));
    let [free_position, wrapped_position] = [&free, &wrapped].map(|recording| values(recording, "motor.position"));
    assert!(free_position.last().is_some_and(|last| (last / TAU - 20.0).abs() < 0.01));
    for (free, wrapped) in free_position.iter().zip(wrapped_position) {
        // One increment where a rounding decides.
        assert!((free - wrapped).abs() < TAU / 8192.0, "{free} {wrapped}");
    }
    assert!(error(&wrapped).iter().all(|error| error.abs() < TAU / 8192.0));
}

/// A zero that is off moves the axis, and leaves its commutation.
#[test]
fn a_zero_that_is_off_moves_the_axis_only() {
    let recording = run(&turning(300.0, 10.0, "{ zero_offset = \"1.3 deg\" }", "{}"));
    let last = |name: &str| *values(&recording, name).last().unwrap();
    assert!((last("following_error.motor") - 1.3_f64.to_radians()).abs() < 1e-4, "{}", last("following_error.motor"));
    assert!(last("current.d").abs() < 1e-6);
}

#[test]
fn encoders_without_errors_leave_every_bit() {
    for (plain, with) in [
        ("{}", "{ lines_per_rev = 512, amplitude_error = 0, noise = \"0 deg\", seed = 7, latency = \"0 s\" }"),
        ("{ step = \"0.01 deg\" }", "{ step = \"0.01 deg\", zero_offset = \"0 deg\", eccentricity_angle = \"3 deg\" }"),
    ] {
        let [plain, with] = [plain, with].map(|encoder| run(&turning(300.0, 4.0, encoder, "{}")));
        for name in ["motor.position", "effort.motor", "current.d", "voltage.q"] {
            let bits = |recording| values(recording, name).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert!(bits(&plain) == bits(&with), "{name}");
        }
    }
}
