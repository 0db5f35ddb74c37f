//! Whole runs against published numbers and closed forms.
use servobench_metrics::Name;
use servobench_plant::Exact;
use servobench_tests::{engines, measured, run, scenario, scenario_file, value};
use std::f64::consts::PI;

/// Oracle: e = v/kp + (Fv·v + Fc·sgn(v) + offset)/(gτ·kp·kv), with the published parameters of the EMPS axis
/// (Janot, Gautier, Brunot 2019): +0.80945 mm and −0.81407 mm at ±0.12468 m/s.
#[test]
fn emps_follows_at_its_published_error() {
    let emps = scenario_file("emps.toml");
    let recording = run(&emps, &Exact);
    let error = recording.channel("following_error.motor").unwrap();
    let v: f64 = 0.12468;
    for (made, sign) in recording.moves.iter().zip([1.0_f64, -1.0]) {
        let friction = 203.5034 * sign * v + 20.3935 * sign - 3.1648;
        let closed_form = sign * v / 160.18 + friction / (35.1507 * 160.18 * 243.45);
        let cruise = recording.index_at(made.cruise.0 + 0.9 * made.cruise.1);
        let found = error[cruise];
        assert!((found / closed_form - 1.0).abs() < 2e-3, "{sign}: {found} m against {closed_form} m");
        assert!((closed_form.abs() * 1e3 - if sign > 0.0 { 0.80945 } else { 0.81407 }).abs() < 5e-6);
    }
}

/// Oracle: ω = √(K·(1/J_M + 1/J_L)) free, √(K/J_L) with the motor held; K = 700 N·m/rad, J = 0.005 kg·m² each: 84.22 Hz
/// and 59.55 Hz.
#[test]
fn the_two_mass_drive_rings_at_its_two_frequencies_on_every_engine() {
    for (file, frequency) in [("two-mass-ring-down.toml", 84.22), ("two-mass-held.toml", 59.55)] {
        let two_mass = scenario_file(file);
        for engine in engines() {
            let metrics = measured(&two_mass, &run(&two_mass, engine));
            let found = value(&metrics, Name::ResidualVibrationFrequency);
            assert!((found / frequency - 1.0).abs() < 2e-3, "{file} on {}: {found} Hz", engine.name());
        }
    }
}

/// A load of 10 kg on an undamped spring behind a base that makes Lambrechts' 1 m move exactly.
fn behind_prescribed_base(order: u32, frequency: f64) -> String {
    let stiffness = 10.0 * (2.0 * PI * frequency).powi(2);
    format!(
        r#"
[run]
base_rate = "16 kHz"
duration = "2.6 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[axis.load]
mass = "10 kg"
stiffness = "{stiffness} N/m"
[motor]
kind = "prescribed"
[setpoint]
order = {order}
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
[[program]]
move_to = "1 m"
"#
    )
}

/// Oracle: a mode ω behind a base that follows the profile exactly rings with X·∏|sin(ωT_k/2)/(ωT_k/2)|, T_k the box
/// lengths: v/a-type times 1 s, 0.2 s, 0.1 s (and 0.05 s), since every bound is reached.
#[test]
fn residual_vibration_is_that_of_the_closed_form() {
    let mut large = 0;
    for (order, boxes) in [(3, &[1.0, 0.2, 0.1][..]), (4, &[1.0, 0.2, 0.1, 0.05])] {
        for frequency in [38.985, 3.3, 7.3, 12.7] {
            let asked = scenario(&behind_prescribed_base(order, frequency));
            let metrics = measured(&asked, &run(&asked, &Exact));
            let found = value(&metrics, Name::ResidualVibrationAmplitude);
            let sinc = |t: &f64| ((PI * frequency * t).sin() / (PI * frequency * t)).abs();
            let closed_form: f64 = boxes.iter().map(sinc).product();
            large += u32::from(closed_form > 10e-6);
            assert!(
                (found / closed_form - 1.0).abs() < 1e-2,
                "order {order}, {frequency} Hz: {found} m against {closed_form} m"
            );
        }
    }
    assert_eq!(large, 6, "three frequencies of each order leave more than 10 µm");
}

/// Oracle: published with the system: 0.2419 µm jerk-limited, 0.0063 µm snap-limited at 38.985 Hz.
#[test]
fn lambrechts_published_residuals_are_met() {
    for (order, published, digits) in [(3, 0.2419e-6, 5e-11), (4, 0.0063e-6, 5e-11)] {
        let asked = scenario(&behind_prescribed_base(order, 6e4_f64.sqrt() / (2.0 * PI)));
        let metrics = measured(&asked, &run(&asked, &Exact));
        let found = value(&metrics, Name::ResidualVibrationAmplitude);
        assert!((found - published).abs() < digits + 1e-2 * published, "order {order}: {found}");
    }
}

/// The slide of `linear-stage-move.toml` as one body of 500 kg with an ideal encoder, moved without friction.
const LINEAR: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "500 kg"
[motor]
model = "siemens-1fn3900-4wb0"
[drive]
model = "servo-16khz"
dc_link = "600 V"
feedforward = { velocity = true, effort = "rigid" }
[setpoint]
order = 3
velocity = "90 m/min"
acceleration = "8 m/s2"
jerk = "300 m/s3"
[[program]]
move_to = "800 mm"
"#;

/// Oracles, from the catalogue values 8100 N at 49.4 A effective and 23 mm: F = 3/2·(π/τ_p)·ψ·i_q, which is 8100 N/(49.4·√2 A)
/// times i_q, F = m·a, and at constant velocity without current the voltage that balances the EMF, u_q = (π/τ_p)·v·ψ.
#[test]
fn a_linear_motor_has_the_force_and_the_voltage_of_its_catalogue() {
    let recording = run(&scenario(LINEAR), &Exact);
    let channel = |name: &str| recording.channel(name).unwrap();
    let per_ampere = 8100.0 / (49.4 * 2_f64.sqrt());
    let (force, current, velocity) = (channel("effort.motor"), channel("current.q"), channel("motor.velocity"));
    let current_d = channel("current.d");
    assert!(force.iter().fold(0.0, |most: f64, force| most.max(*force)) > 3.9e3, "it takes 500 kg · 8 m/s²");
    for k in 0..recording.len() - 1 {
        // The force over a tick is that of the mean current, with a force constant that is written in 9 digits, and it is what
        // accelerates the slide, all but the rounding of a difference of velocities up to 1.5 m/s over 1/16 ms. That mean is
        // the midpoint but for h²/12 of the current's second derivative: R/L of its slope (h·R/L = 0.8 Ω·62.5 µs/7.5 mH), and
        // the turn ω·h of the frame of what goes with the other axis.
        let (lag, turn) = (0.8 * 62.5e-6 / 7.5e-3, PI / 0.023 * velocity[k].abs() / 16_000.0);
        let slopes = lag * (current[k + 1] - current[k]).abs() + turn * (current_d[k + 1] - current_d[k]).abs();
        let curvature = 1.2 * (slopes + turn * turn * current[k].abs()) / 12.0;
        let by_current = per_ampere * f64::midpoint(current[k], current[k + 1]);
        let by_mass = 500.0 * (velocity[k + 1] - velocity[k]) * 16_000.0;
        let within = 1e-8 * 4e3 + per_ampere * curvature;
        assert!((force[k] - by_current).abs() < within, "{k}: {} N for {by_current} N ± {within} N", force[k]);
        assert!((force[k] - by_mass).abs() < 1e-6, "{k}: {} N for {by_mass} N", force[k]);
    }
    let (at, length) = recording.moves[0].cruise;
    let cruise = recording.index_at(at + 0.9 * length);
    let [u_q, u_d] = ["voltage.q", "voltage.d"].map(|name| channel(name)[cruise]);
    let emf = 1.5 * per_ampere / 1.5;
    // What is left of the settling is below 0.1 %.
    assert!((u_q / emf - 1.0).abs() < 1e-3 && u_d.abs() < 1e-3 * emf, "{u_q} V and {u_d} V against {emf} V");
}

/// Oracle: the same motor rolled up, one pole pair on a screw that advances by two pole pitches per revolution and weighs
/// nothing. Only rounding may tell them apart: 1e-16 m of position, differenced over 125 µs, times the velocity gain of
/// 188 kN·s/m over 116 N/A is 1.3 nA, again and again.
#[test]
fn a_linear_motor_moves_like_the_rotary_one_that_it_unrolls() {
    let flux_linkage = 8100.0 / (49.4 * 2_f64.sqrt()) / (1.5 * PI / 0.023);
    let rolled_up = LINEAR.replace("[axis.motor_side]", "lead = \"46 mm\"\n[axis.table]").replace(
        "model = \"siemens-1fn3900-4wb0\"",
        &format!(
            "kind = \"pmsm\"\npole_pairs = 1\nresistance = \"0.8 Ohm\"\ninductance = \"7.5 mH\"\n\
             flux_linkage = \"{flux_linkage} V s\"\nmax_current = \"49.4 Arms\""
        ),
    );
    let [linear, rotary] = [LINEAR, &rolled_up].map(|text| run(&scenario(text), &Exact));
    for (name, tolerance) in [("load.position", 1e-9), ("current.q", 1e-6), ("voltage.q", 1e-4)] {
        let pairs = linear.channel(name).unwrap().iter().zip(rotary.channel(name).unwrap());
        let difference = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(difference < tolerance, "{name}: {difference}");
    }
}

/// The table of the feed axis sticks, creeps one way by half a micrometre as the integrator unwinds, and sticks again: but
/// for the picometres by which its coupling gives back, way and displacement are the same, so nothing oscillates.
#[test]
fn a_table_that_creeps_has_no_mode() {
    let axis = scenario_file("feed-axis-move.toml");
    let recording = run(&axis, &Exact);
    let after = &recording.channel("load.position").unwrap()[recording.index_at(recording.moves[0].end)..];
    let way: f64 = after.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let displacement = (after[after.len() - 1] - after[0]).abs();
    assert!(displacement > 0.1e-6 && way < 1.001 * displacement, "{way} m for {displacement} m");
    let metrics = measured(&axis, &recording);
    assert_eq!(metrics.run.value(Name::ResidualVibrationAmplitude), Some(0.0));
    let frequency = Name::ResidualVibrationFrequency;
    assert!(metrics.run.absence(frequency).is_some(), "{:?}", metrics.run.value(frequency));
}

/// Oracle: e^(−2·ζ·acos(ζ)/√(1 − ζ²)) of the velocity, from m·δ̈ + d·δ̇ + k·δ = 0 until the stop would pull. The tick in which the
/// load comes, and that in which it leaves, are partly in the stop: of 35 ticks in all.
#[test]
fn a_load_leaves_a_damped_stop_as_the_closed_form_says_on_every_engine() {
    let slide = scenario_file("end-stop.toml");
    let ratio = 2190.9 / (2.0 * (1e7_f64 * 12.0).sqrt());
    let expected = (-2.0 * ratio * ratio.acos() / (1.0 - ratio * ratio).sqrt()).exp();
    for engine in engines() {
        let recording = run(&slide, engine);
        let velocity = recording.channel("load.velocity").unwrap();
        let (before, after) = (velocity[0], velocity[velocity.len() - 1]);
        println!("{}: {} of {expected}", engine.name(), -after / before);
        assert!((-after / before / expected - 1.0).abs() < 2e-3, "{}: {after} m/s", engine.name());
        let pushes = recording.channel("effort.end_stop").unwrap();
        assert!(pushes.iter().all(|push| *push <= 0.0) && pushes.iter().any(|push| *push < -1e3));
    }
}
