//! How the velocity is measured, in the closed loop: noise through it in closed form, methods against each other.
use crate::rig::{run, values};
use servobench_trace::Recording;
use std::f64::consts::{PI, TAU};

/// Base ticks, and cycles of both loops, per second.
const RATE: f64 = 8e3;
const INERTIA: f64 = 0.01;
/// Bandwidth of a fast velocity loop (rad/s), and gain of the position loop (1/s).
const OMEGA: f64 = TAU * 35.0;
const POSITION_GAIN: f64 = 70.0;
const HELD: &str = "gain = \"70 1/s\"";

/// Keys of these loops.
const FAST: &str = "bandwidth = \"35 Hz\"";

/// An inertia on an ideal source, at a constant velocity (rad/s) for `hold` (s), against a load (N·m); keys of encoder, velocity and
/// position loop besides.
fn held(encoder: &str, velocity: &str, position: &str, speed: f64, hold: f64, load: f64) -> Recording {
    run(&format!(
        r#"
run.base_rate = "8 kHz"
axis = {{ motion = "rotary", motor_side = {{ inertia = "{INERTIA} kg m2" }} }}
[motor]
kind = "ideal-source"
encoder = {{ {encoder} }}
[drive]
velocity = {{ rate = "8 kHz", {velocity} }}
position = {{ rate = "8 kHz", {position} }}
feedforward = {{ velocity = true }}
[setpoint]
order = 2
velocity = "100 rad/s"
acceleration = "200 rad/s2"
[[program]]
reach_velocity = "{speed} rad/s"
hold = "{hold} s"
[[program]]
reach_velocity = "0 rad/s"
[[disturbance]]
on = "load"
torque = "{load} Nm"
[requirements]
arrives = false
"#
    ))
}

/// Rows of the hold, in which nothing is left of the run-up.
fn steady(hold: f64) -> std::ops::Range<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few seconds")]
    let row = |time: f64| (time * RATE) as usize;
    row(1.2)..row(hold)
}

fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
}

type Complex = (f64, f64);

fn times((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}

fn over(a: Complex, (c, d): Complex) -> Complex {
    let square = c * c + d * d;
    times(a, (c / square, -d / square))
}

/// |N|² at the angle θ per cycle: from an error of the reading to the torque that is asked for, N = C/(1 + C·G) with
/// C = k_p·(K_v + (1 − z⁻¹)/T)·(1 + (T/T_i)·z⁻¹/(1 − z⁻¹)) and G = T²/(2J)·(z + 1)/(z − 1)², the inertia under a torque that is held.
fn noise_gain(theta: f64, omega: f64) -> f64 {
    let (t, k_p, t_i) = (1.0 / RATE, INERTIA * omega, 4.0 / omega);
    let z = (theta.cos(), theta.sin());
    let back = (theta.cos(), -theta.sin());
    let difference = (1.0 - back.0, -back.1);
    let outer = (POSITION_GAIN + difference.0 / t, difference.1 / t);
    let integral = over((t / t_i * back.0, t / t_i * back.1), difference);
    let (re, im) = times(outer, (1.0 + integral.0, integral.1));
    let c = (k_p * re, k_p * im);
    let less = (z.0 - 1.0, z.1);
    let g = over((t * t / (2.0 * INERTIA) * (z.0 + 1.0), t * t / (2.0 * INERTIA) * z.1), times(less, less));
    let loop_gain = times(c, g);
    let (re, im) = over(c, (1.0 + loop_gain.0, loop_gain.1));
    re * re + im * im
}

/// Oracle: at f increments per cycle the error of the reading is a sawtooth of position, q/(π·m)·sin(2π·m·f·k) for all m: the variance of
/// the torque is the sum of q²/(2π²·m²)·|N(2π·m·f)|². To 1 %: an increment passes
/// earlier or later as the axis answers to those before, by a share of some ω·T, which is no part of a linear loop.
#[test]
fn increments_go_through_the_closed_loop_as_the_closed_form_says() {
    let counts = 5003.0;
    let step = TAU / counts;
    for per_cycle in [0.618_034, 1.324_718, 2.071_1] {
        let speed = per_cycle * step * RATE;
        let recording = held(&format!("counts_per_rev = {counts}"), "bandwidth = \"10 Hz\"", HELD, speed, 6.0, 0.0);
        let found = variance(&values(&recording, "effort.reference")[steady(6.0)]);
        let lines = (1..20_000).map(f64::from);
        let exact: f64 = lines
            .map(|m| {
                step * step / (2.0 * PI * PI * m * m) * noise_gain((TAU * m * per_cycle).rem_euclid(TAU), TAU * 10.0)
            })
            .sum();
        println!("{per_cycle} increments per cycle: {found:.4e} {exact:.4e} ({:+.3} %)", 100.0 * (found / exact - 1.0));
        assert!((found / exact - 1.0).abs() < 0.01, "{per_cycle}: {found} {exact}");
    }
}

/// Oracle: white noise σ that dithers increments q is white noise of σ² + q²/12 (Widrow), and through the loop that times the mean of |N|².
/// To 1 %: of 2e5 cycles it is known to 0.3 %.
#[test]
fn noise_goes_through_the_closed_loop_as_the_closed_form_says() {
    let (counts, hold) = (5003.0, 26.0);
    let step = TAU / counts;
    let noise = 0.7 * step;
    let encoder = format!("counts_per_rev = {counts}, noise = \"{noise} rad\", seed = 11");
    let recording = held(&encoder, FAST, HELD, 3.719, hold, 0.0);
    let found = variance(&values(&recording, "effort.reference")[steady(hold)]);
    let points = 200_000;
    let mean = (0..points).map(|i| noise_gain(TAU * (f64::from(i) + 0.5) / f64::from(points), OMEGA)).sum::<f64>();
    let exact = (noise * noise + step * step / 12.0) * mean / f64::from(points);
    println!("noise and increments: {found:.4e} {exact:.4e} ({:+.3} %)", 100.0 * (found / exact - 1.0));
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

/// Largest error of the measured velocity, relative.
fn worst(recording: &Recording, hold: f64) -> f64 {
    let [measured, velocity] = ["measured.motor.velocity", "motor.velocity"].map(|name| values(recording, name));
    steady(hold).map(|k| (measured[k] / velocity[k] - 1.0).abs()).fold(0.0, f64::max)
}

/// Oracle: |Δω|/ω ≤ τ/(t_m − τ) for M/T, and of a difference the fraction of an increment over a cycle. The loop is slow: the axis
/// moves by less than a tenth of the error.
#[test]
fn the_m_t_method_resolves_what_differences_cannot() {
    let counts = 5003.0;
    let step = TAU / counts;
    for (per_cycle, turn_bits) in [(0.618_034, ""), (3.324_718, ""), (7.071_1, ", turn_bits = 1")] {
        let speed = per_cycle * step * RATE;
        let encoder = format!("counts_per_rev = {counts}{turn_bits}");
        let [mt, difference] = ["mt", "difference"].map(|method| {
            let velocity = format!("bandwidth = \"2 Hz\", measurement = \"{method}\"");
            worst(&held(&encoder, &velocity, "gain = \"4 1/s\"", speed, 3.0, 0.0), 3.0)
        });
        let timer = 100e-9;
        let measured = if per_cycle < 1.0 { 1.0 } else { f64::floor(per_cycle) } / per_cycle / RATE;
        let bound = timer / (measured - timer);
        println!("{per_cycle}: M/T {mt:.2e} (bound {bound:.2e}), difference {difference:.2e}");
        assert!(mt < 1.1 * bound, "{per_cycle}: {mt} {bound}");
        let fraction = per_cycle.fract();
        let of_difference = fraction.max(1.0 - fraction) / per_cycle;
        assert!((difference / of_difference - 1.0).abs() < 0.1, "{per_cycle}: {difference} {of_difference}");
    }
}

/// Oracle: the variance of the observer's velocity for white noise of the position, with a loop that is too slow to answer.
#[test]
fn an_observer_reduces_the_noise_of_the_velocity_as_the_closed_form_says() {
    let (noise, hold) = (2e-5, 26.0);
    let encoder = format!("noise = \"{noise} rad\", seed = 3");
    for (hertz, tolerance) in [(400.0, 0.02), (133.0, 0.03)] {
        let velocity =
            format!("bandwidth = \"2 Hz\", measurement = \"observer\", observer = {{ bandwidth = \"{hertz} Hz\" }}");
        let recording = held(&encoder, &velocity, "gain = \"4 1/s\"", 3.719, hold, 0.0);
        let z = (-TAU * hertz / RATE).exp();
        let exact = (1.0 - z).powi(3) * (13.0 + 50.0 * z + 49.0 * z * z) / (2.0 * (1.0 + z).powi(5));
        let exact = exact * (noise * RATE).powi(2);
        let [measured, velocity] = ["measured.motor.velocity", "motor.velocity"].map(|name| values(&recording, name));
        let error: Vec<f64> = steady(hold).map(|k| measured[k] - velocity[k]).collect();
        let found = variance(&error);
        println!("observer of {hertz} Hz: {found:.4e} {exact:.4e} ({:+.2} %)", 100.0 * (found / exact - 1.0));
        assert!((found / exact - 1.0).abs() < tolerance, "{hertz}: {found} {exact}");
    }
}

/// Oracle: by hand, of a P velocity loop under a constant load τ: the position stays behind by τ/(k_p·K_v), by the share of it that the
/// observed disturbance leaves, and with an integral in the position loop not at all.
#[test]
fn a_constant_load_is_met_by_the_observer_or_by_the_integral() {
    let load = 0.83;
    let observer = |share: f64| {
        format!(
            "measurement = \"observer\", observer = {{ bandwidth = \"150 Hz\", disturbance_compensation = {share} }}"
        )
    };
    for (measurement, position, left) in [
        (String::new(), "", 1.0),
        (observer(0.0), "", 1.0),
        (observer(0.37), "", 0.63),
        (observer(1.0), "", 0.0),
        (String::new(), ", integral_time = \"60 ms\"", 0.0),
        (observer(0.37), ", integral_time = \"60 ms\", derivative_time = \"4 ms\"", 0.0),
    ] {
        let velocity = format!("{FAST}, kind = \"p\", {measurement}");
        let recording = held("", velocity.trim_end_matches(", "), &format!("{HELD}{position}"), 1.3, 3.0, -load);
        let rows = steady(3.0);
        let count = rows.len() as f64;
        let error = values(&recording, "following_error.motor")[rows].iter().sum::<f64>() / count;
        let exact = load / (INERTIA * OMEGA * POSITION_GAIN);
        assert!((error / exact - left).abs() < 1e-6, "{velocity} {position}: {} {left}", error / exact);
    }
}

/// What is the same anyway leaves every bit: differences of an encoder that gives no velocity.
#[test]
fn differences_by_choice_are_those_without_it() {
    let velocity = |more: &str| format!("{FAST}{more}");
    let [without, with] = ["", ", measurement = \"difference\""]
        .map(|more| held("counts_per_rev = 5003", &velocity(more), HELD, 3.719, 1.0, 0.2));
    for name in ["motor.position", "effort.reference", "velocity.reference"] {
        let bits = |recording| values(recording, name).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(bits(&without) == bits(&with), "{name}");
    }
    assert!(without.channel("measured.motor.velocity").is_none(), "no channel without the key");
}
