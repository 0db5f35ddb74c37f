//! Torque that errors of the current sensors make.
use super::axis::{POLE_PAIRS, RATE, TORQUE_CONSTANT, harmonic, torque_error, turning, turning_with, whole_turns};
use crate::rig::{run, values};
/// Of 5 Hz electrical, at which the current loop of 700 Hz leaves (5/700)² of what it is to follow.
const SLOW: f64 = 75.0;

/// Torque ripple of the motor at f_e and at twice that (N·m), with a velocity loop that is too slow to answer it.
fn ripple(sensor: &str) -> [f64; 2] {
    let recording = run(&turning_with(SLOW, 6.0, "{}", sensor, ["2 Hz", "0.3 Hz"]));
    let (rows, error) = (whole_turns(&recording, 2.0, 4.0), torque_error(&recording));
    [1.0, 2.0].map(|order| harmonic(&recording, rows.clone(), &error, order * POLE_PAIRS))
}

/// Oracle: K_t·(2/√3)·√(a² + a·b + b²) at f_e (Chung and Sul 1998); an offset makes nothing at 2·f_e. To 1 %: the current loop
/// follows to 0.01 %, the speed of the fit varies by less than the rest.
#[test]
fn an_offset_makes_torque_at_the_electrical_frequency() {
    for (a, b) in [(0.13, 0.0), (0.0, -0.07), (0.11, 0.046), (0.09, -0.09_f64)] {
        let [first, second] = ripple(&format!("{{ offset_a = \"{a} A\", offset_b = \"{b} A\" }}"));
        let expected = TORQUE_CONSTANT * 2.0 / 3.0_f64.sqrt() * (a * a + a * b + b * b).sqrt();
        assert!((first / expected - 1.0).abs() < 0.01, "{a} {b}: {first} {expected}");
        assert!(second < 0.01 * expected, "{a} {b}: {second}");
    }
}

/// Oracle: K_t·I·|g_a − g_b|/√3 at 2·f_e with 1/(1 + g) − 1 for g; equal errors make none.
#[test]
fn a_gain_error_makes_torque_at_twice_the_electrical_frequency() {
    let current = 1.9 / TORQUE_CONSTANT;
    for (a, b) in [(0.04, 0.0), (0.0, -0.023), (0.031, -0.017), (0.02, 0.05_f64)] {
        let [first, second] = ripple(&format!("{{ gain_error_a = {a}, gain_error_b = {b} }}"));
        let true_of = |g: f64| 1.0 / (1.0 + g) - 1.0;
        // The mean of what the sensors read too much makes the velocity loop ask for more: of the current that flows.
        let asked = current / (1.0 + f64::midpoint(true_of(a), true_of(b)));
        let expected = TORQUE_CONSTANT * asked * (true_of(a) - true_of(b)).abs() / 3.0_f64.sqrt();
        assert!((second / expected - 1.0).abs() < 0.01, "{a} {b}: {second} {expected}");
        // The mean still drifts by the slow loops: its share at f_e.
        assert!(first < 0.02 * expected, "{a} {b}: {first}");
    }
    let [first, second] = ripple("{ gain_error_a = 0.03, gain_error_b = 0.03 }");
    assert!(first < 1e-4 && second < 1e-4, "{first} {second}");
}

/// Oracle: what is measured stands at (0, i_q) and is ω_e·τ behind: the current that flows has i_d = −i_q·sin, i_q = i_q·cos of
/// that angle, whatever the loop.
#[test]
fn a_late_sample_turns_the_current_by_the_angle_that_has_passed() {
    for (sensor, age) in [
        ("{ delay = 1 }", 1.0),
        ("{ delay = 2 }", 2.0),
        ("{ shift = \"21 us\" }", 21e-6 * RATE),
        ("{ delay = 1, shift = \"50 us\" }", 1.0 + 50e-6 * RATE),
    ] {
        let recording = run(&turning(1_100.0, 40.0, "{}", sensor));
        let rows = whole_turns(&recording, 18.0, 24.0);
        let mean = |name: &str| values(&recording, name)[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let angle = mean("motor.velocity") * POLE_PAIRS * age / RATE;
        let [d, q] = ["current.d", "current.q"].map(mean);
        let [measured_d, measured_q] = ["measured.current.d", "measured.current.q"].map(mean);
        assert!((-d).atan2(q) / angle > 0.99 && (-d).atan2(q) / angle < 1.01, "{sensor}: {d} {q} against {angle}");
        assert!(
            (q.hypot(d) / measured_q - 1.0).abs() < 1e-3 && measured_d.abs() < 1e-3 * q,
            "{measured_d} {measured_q}"
        );
    }
}

/// Oracle: variance of what is measured about what flows, σ² of each phase: 4σ²/3 of the vector, (1 + (1 + 4)/3)/2·σ² per axis of
/// the rotor. The mean of n squares is known to √(2/n); the loop's own answer is a tick later.
#[test]
fn noise_is_measured_and_not_what_flows() {
    let recording = run(&turning(SLOW, 6.0, "{}", "{ noise = \"50 mA\", seed = 4 }"));
    let rows = whole_turns(&recording, 2.0, 4.0);
    let [d, q, measured_d, measured_q] =
        ["current.d", "current.q", "measured.current.d", "measured.current.q"].map(|name| values(&recording, name));
    let sum: f64 = rows.clone().map(|k| (measured_d[k] - d[k]).powi(2) + (measured_q[k] - q[k]).powi(2)).sum();
    let variance = sum / rows.len() as f64;
    // α has σ², β (σ² + 4σ²)/3.
    let expected = 0.05_f64.powi(2) * (1.0 + 5.0 / 3.0);
    let bound = 5.0 * (2.0 / rows.len() as f64).sqrt();
    assert!((variance / expected - 1.0).abs() < bound, "{variance} {expected} ± {bound}");
}

/// The old bits: without errors, with an empty table, and with a seed alone.
#[test]
fn sensors_without_errors_leave_every_bit() {
    let text = |sensor: &str| turning(SLOW, 1.0, "{}", sensor);
    let with = text("{}");
    let without = with.replace(", sensor = {}", "");
    assert_ne!(with, without);
    let [with, without, seeded] = [with, without, text("{ seed = 3, offset_a = \"0 A\" }")].map(|text| run(&text));
    for name in ["motor.position", "effort.motor", "current.d", "voltage.q"] {
        let bits = |recording| values(recording, name).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(bits(&with) == bits(&without) && bits(&seeded) == bits(&without), "{name}");
    }
    assert!(with.channel("measured.current.d").is_none());
}

/// A range below the current that is needed: what flows is more than what is measured.
#[test]
fn a_converter_out_of_its_range_hides_current() {
    let recording = run(&turning(SLOW, 3.0, "{}", "{ bits = 12, range = \"3 A\" }"));
    let largest = |name: &str| values(&recording, name).iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!(largest("current.q") > 1.5 * 3.0, "{}", largest("current.q"));
    // The third phase is not measured: a and b at the same end of the range make twice as much.
    assert!(largest("measured.current.q") < largest("current.q").min(2.0 * 3.0 + 1e-12));
}
