//! Blocks of the firmware that answer real hardware, in the closed loop.
use crate::rig::{run, values};

/// The 2.2 kW interior permanent-magnet motor under these keys of the current loop, with a constant load (N·m).
fn text(current: &str, max_current: f64, load: f64, program: &str, more: &str) -> String {
    format!(
        r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
[motor]
kind = "pmsm"
pole_pairs = 3
resistance = "3.6 Ohm"
inductance_d = "36 mH"
inductance_q = "51 mH"
flux_linkage = "0.545 V s"
inertia = "0.005 kg m2"
max_current = "{max_current} Apk"
[drive]
dc_link = "540 V"
current = {{ rate = "16 kHz", bandwidth = "600 Hz", {current} }}
velocity = {{ rate = "8 kHz", bandwidth = "30 Hz" }}
position = {{ rate = "4 kHz", gain = "0.01 1/s" }}
feedforward = {{ velocity = true }}
{more}
[setpoint]
order = 2
acceleration = "3000 rad/s2"
{program}
[[disturbance]]
on = "load"
torque = "{load} Nm"
[requirements]
arrives = false
"#
    )
}

/// Mean over the last tenth.
fn end(all: &[f64]) -> f64 {
    let last = &all[all.len() * 9 / 10..];
    last.iter().sum::<f64>() / last.len() as f64
}

const P: f64 = 3.0;
const R: f64 = 3.6;
const L_D: f64 = 36e-3;
const L_Q: f64 = 51e-3;
const PSI: f64 = 0.545;

fn torque(d: f64, q: f64) -> f64 {
    1.5 * P * (PSI + (L_D - L_Q) * d) * q
}

/// Largest motoring torque at the electrical speed ω within |i| ≤ `most` and |u| ≤ `voltage`, resistance included: all currents
/// in polar coordinates, the radius by bisection, since a larger current in a direction is the larger torque there.
fn best(omega: f64, most: f64, voltage: f64) -> f64 {
    let is_within = |length: f64, angle: f64| {
        let (d, q) = (-length * angle.cos(), length * angle.sin());
        (R * d - omega * L_Q * q).hypot(R * q + omega * (L_D * d + PSI)) <= voltage
    };
    let at = |angle: f64| {
        // From the outside in: the first length at which the voltage suffices.
        let length = (0..=1_500).rev().map(|k| most * f64::from(k) / 1_500.0).find(|length| is_within(*length, angle));
        length.map_or(0.0, |length| torque(-length * angle.cos(), length * angle.sin()))
    };
    (0..=1_500).map(|k| at(std::f64::consts::FRAC_PI_2 * f64::from(k) / 1_500.0)).fold(0.0, f64::max)
}

/// Oracle: the speed at which circle and voltage ellipse leave the load's torque, resistance included. Asked for more, the axis comes
/// to that speed within 0.5 %: with less current than ψ/L_d at the corner of both, with more at the most torque per voltage.
#[test]
fn the_axis_reaches_the_speed_of_the_voltage_ellipse() {
    for (share, max_current, load) in [(0.95, 9.12, 9.7), (1.0, 9.12, 14.3), (0.9, 19.7, 11.3)] {
        let voltage = share * 540.0 / 3.0_f64.sqrt();
        let (mut low, mut high) = (100.0, 3_000.0);
        for _ in 0..16 {
            let middle = f64::midpoint(low, high);
            *(if best(middle, max_current, voltage) > load { &mut low } else { &mut high }) = middle;
        }
        let current = format!("strategy = \"mtpa\", field_weakening = true, field_weakening_share = {share}");
        let program = "velocity = \"8000 rpm\"\n[[program]]\nreach_velocity = \"8000 rpm\"\nhold = \"2.5 s\"\n[[program]]\nreach_velocity = \"0 rpm\"";
        let text = text(&current, max_current, -load, program, "")
            .replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"2.5 s\"");
        let recording = run(&text);
        let speed = 3.0 * end(values(&recording, "motor.velocity"));
        let i = ["current.d", "current.q"].map(|name| end(values(&recording, name)));
        println!(
            "share {share}: {:.3} rad/s, closed form {low:.3}, {:+.3} %, i = {i:?}",
            speed,
            100.0 * (speed / low - 1.0)
        );
        assert!((speed / low - 1.0).abs() < 5e-3, "{share}: {speed} {low} {i:?}");
        assert!(low > 1.05 * voltage / PSI, "beyond what the back-EMF alone allows");
    }
}

/// Oracle: the torque per ampere in closed form: i_d = ψ/(4(L_q − L_d)) − √(ψ²/(16(L_q − L_d)²) + i²/2) at the current that flows, which
/// makes the load's torque.
#[test]
fn a_constant_load_is_held_by_the_least_current() {
    let program = "velocity = \"60 rpm\"\n[[program]]\nmove_by = \"0.4 rev\"";
    let text = text("strategy = \"mtpa\"", 14.0, -23.7, program, "");
    let recording = run(&text.replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"1.5 s\""));
    let [d, q] = ["current.d", "current.q"].map(|name| end(values(&recording, name)));
    let (a, square) = (L_Q - L_D, d * d + q * q);
    let exact = PSI / (4.0 * a) - (PSI * PSI / (16.0 * a * a) + square / 2.0).sqrt();
    println!("i = ({d:.6}, {q:.6}) A, closed form {exact:.6} A, {:.6} Nm", torque(d, q));
    // The axis still settles by its slow position loop: 0.01 1/s.
    assert!((d / exact - 1.0).abs() < 1e-4 && (torque(d, q) / 23.7 - 1.0).abs() < 1e-4, "{d} {q} {exact}");
}

/// The 6.7 kW reluctance motor in place of the one with magnets, `d` and `q` (mH) being its inductances.
fn without_magnets(text: &str, d: f64, q: f64) -> String {
    let of = |d: &str, q: &str, psi: &str| {
        format!("inductance_d = \"{d} mH\"\ninductance_q = \"{q} mH\"\nflux_linkage = \"{psi} V s\"")
    };
    text.replace(&of("36", "51", "0.545"), &of(&d.to_string(), &q.to_string(), "0"))
        .replace("pole_pairs = 3\nresistance = \"3.6 Ohm\"", "pole_pairs = 2\nresistance = \"0.54 Ohm\"")
}

/// Oracle: τ = 1.5·p·(L_d − L_q)·i_d·i_q takes least current at 45°, i_d with the sign of L_d − L_q, i_q with that of τ.
#[test]
fn a_motor_without_magnets_holds_a_load_by_its_saliency() {
    for (l_d, l_q) in [(41.5, 6.2), (6.2, 41.5)] {
        for (load, way) in [(-17.3, 0.4), (17.3, 0.4), (-17.3, -0.4), (17.3, -0.4)] {
            let program = format!("velocity = \"60 rpm\"\n[[program]]\nmove_by = \"{way} rev\"");
            let text = without_magnets(&text("strategy = \"mtpa\"", 31.0, load, &program, ""), l_d, l_q);
            let text = text.replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"1.5 s\"");
            let recording = run(&text.replace("gain = \"0.01 1/s\"", "bandwidth = \"3 Hz\""));
            let [d, q, turned] = ["current.d", "current.q", "load.position"].map(|name| end(values(&recording, name)));
            let expected = (17.3 / (1.5 * 2.0 * (l_d - l_q).abs() * 1e-3)).sqrt();
            println!("{l_d} {l_q} mH, {load} Nm: i = ({d:.6}, {q:.6}) A, closed form {expected:.6} A");
            assert!((d / (expected * (l_d - l_q).signum()) - 1.0).abs() < 1e-4, "{d} {expected}");
            assert!((q / (expected * -load.signum()) - 1.0).abs() < 1e-4, "{q} {expected}");
            assert!((turned / (way * std::f64::consts::TAU) - 1.0).abs() < 1e-3, "{turned}");
        }
    }
}

/// A motor without magnets, unloaded, comes to rest without a current, and stays there; with a constant d-axis current it keeps that.
#[test]
fn a_motor_without_magnets_comes_to_rest() {
    let program = "velocity = \"600 rpm\"\n[[program]]\nmove_by = \"3 rev\"\n[[program]]\nmove_by = \"-3 rev\"";
    for (l_d, l_q, strategy, held) in [
        (41.5, 6.2, "strategy = \"mtpa\"", 0.0),
        (6.2, 41.5, "strategy = \"mtpa\", field_weakening = true", 0.0),
        (41.5, 6.2, "d_reference = \"8 Apk\"", 8.0),
        (6.2, 41.5, "d_reference = \"-8 Apk\"", -8.0),
    ] {
        let text = without_magnets(&text(strategy, 31.0, 0.0, program, ""), l_d, l_q);
        let text = text.replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"10 s\"");
        let recording = run(&text.replace("gain = \"0.01 1/s\"", "bandwidth = \"3 Hz\""));
        let last = |name: &str| *values(&recording, name).last().unwrap();
        println!("{strategy}: {} rad/s, {} A, {} A", last("motor.velocity"), last("current.d"), last("current.q"));
        assert!(last("motor.velocity").abs() < 1e-9, "{strategy}: {}", last("motor.velocity"));
        assert!((last("current.d") - held).abs() < 1e-3 && last("current.q").abs() < 1e-3, "{strategy}");
        let moved = values(&recording, "load.position").iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!((moved / (6.0 * std::f64::consts::PI) - 1.0).abs() < 0.01, "{moved}");
    }
}

/// Oracle: t = −τ·ln(1 − I_n²/I²) at the current limit I, from when it flows; then I_n flows.
#[test]
fn a_peak_current_ends_when_the_thermal_load_is_reached() {
    let more =
        "max_torque = \"20 Nm\"\ni2t = { drive = { continuous_current = \"5.1 Apk\", time_constant = \"0.83 s\" } }";
    let program = "velocity = \"8000 rpm\"\n[[program]]\nreach_velocity = \"8000 rpm\"\nhold = \"1 s\"\n[[program]]\nreach_velocity = \"0 rpm\"";
    let heavy = "inertia = \"1 kg m2\"\nmax_current";
    let text = text("", 9.12, 0.0, program, more)
        .replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"0.9 s\"");
    let recording = run(&text.replace("inertia = \"0.005 kg m2\"\nmax_current", heavy));
    let (reference, flowing) = (values(&recording, "current.q_reference"), values(&recording, "current.q"));
    let peak = 20.0 / (1.5 * P * PSI);
    let begins = flowing.iter().position(|i| *i > 0.5 * peak).unwrap() as f64 / 16e3;
    let ends = reference.iter().rposition(|i| (i - peak).abs() < 1e-9).unwrap() as f64 / 16e3;
    let exact = -0.83 * (1.0 - (5.1_f64 / peak).powi(2)).ln();
    println!("the peak current flows for {:.5} s, closed form {exact:.5} s", ends - begins);
    // The current comes within some periods of its loop, 0.3 ms, and its first percents count less.
    assert!((ends - begins - exact).abs() < 2e-3, "{begins} {ends} {exact}");
    assert!((end(flowing) - 5.1).abs() < 1e-6, "{}", end(flowing));
}

/// Oracle: the share of the voltage itself. A drive that believes the flux linkage to be 8 % too small asks for more voltage than its
/// share in steady motion; with the feedback the mean of what it asks for is its share.
#[test]
fn the_feedback_finds_the_voltage_that_the_estimates_miss() {
    let program = "velocity = \"2600 rpm\"\n[[program]]\nreach_velocity = \"2600 rpm\"\nhold = \"1.5 s\"\n[[program]]\nreach_velocity = \"0 rpm\"";
    let wrong = "estimate = { motor = { flux_linkage = \"0.5014 V s\" } }";
    let share = 0.92 * 540.0 / 3.0_f64.sqrt();
    let [without, with] = ["", ", field_weakening_feedback = \"3 Hz\""].map(|feedback| {
        let current = format!("strategy = \"mtpa\", field_weakening = true, field_weakening_share = 0.92{feedback}");
        let text = text(&current, 9.12, -3.0, program, wrong);
        let text = text.replace("base_rate = \"16 kHz\"", "base_rate = \"16 kHz\"\nduration = \"1.4 s\"");
        let recording = run(&text);
        let [d, q] = ["voltage.d_reference", "voltage.q_reference"].map(|name| end(values(&recording, name)));
        d.hypot(q) / share
    });
    println!("|u| of its share: {without:.4} without feedback, {with:.4} with");
    // Its time constant is 53 ms, and the run settles for twenty of them.
    assert!(without > 1.02 && (with - 1.0).abs() < 2e-3, "{without} {with}");
}
