//! What the drive believes of its plant may be wrong: its own limits hold all the same, and the plant is what it is.
use servobench_metrics::Name;
use servobench_plant::Exact;
use servobench_scenario::Scenario;
use servobench_tests::{measured, run, scenario, value};

/// The 2.2 kW motor with 10 g m² on its shaft, a gear of 10 behind it, and `more` in the file.
fn rotary(more: &str) -> Scenario {
    scenario(&format!(
        r#"
[run]
base_rate = "16 kHz"
duration = "0.6 s"
[axis]
motion = "rotary"
gear_ratio = 10
[axis.load]
inertia = "0.5 kg m2"
[motor]
model = "saarakkala-2.2kw"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "8 kHz"
bandwidth = "25 Hz"
[drive.position]
rate = "4 kHz"
bandwidth = "6 Hz"
{more}
"#
    ))
}

/// Largest magnitude of `channel`.
fn peak(recording: &servobench_trace::Recording, channel: &str) -> f64 {
    recording.channel(channel).unwrap().iter().fold(0.0, |peak, value| value.abs().max(peak))
}

/// Oracle: 6.45 Arms are 9.12 A of amplitude, whatever torque the drive believes that they give. A drive that takes the
/// magnets for a fifth of what they are asks for five times the current it needs.
#[test]
fn the_current_limit_holds_with_a_wrong_flux_linkage() {
    let limit = 6.45 * 2_f64.sqrt();
    let step = rotary(
        "[drive]\ndc_link = \"540 V\"\nestimate.motor.flux_linkage = \"0.1 V s\"\n[setpoint]\norder = 2\n\
         velocity = \"10 rad/s\"\nacceleration = \"1000 rad/s2\"\n[[program]]\nmove_to = \"2 rad\"\n",
    );
    let recording = run(&step, &Exact);
    let reference = peak(&recording, "current.q_reference");
    assert!(reference <= limit && reference > limit * (1.0 - 1e-12), "{reference} A");
    // A loop of 1 kHz with a tick and a half of delay at 16 kHz overshoots a step by a few per cent.
    assert!(peak(&recording, "current.q") < 1.1 * limit, "{} A", peak(&recording, "current.q"));
    let binds = |message: &str| recording.events.iter().filter(|event| event.message == message).count();
    assert!(binds("current limit binds") > 0 && binds("effort limit binds") == 0, "{:?}", recording.events);
    let metrics = measured(&step, &recording);
    assert!(value(&metrics, Name::CurrentSaturationTime) > 0.0);
    assert!(value(&metrics, Name::EffortSaturationTime).abs() < 1e-15);
}

/// Oracle: with the current at its limit the axis accelerates by 1.5·p·ψ·i over the inertia at the shaft, 2237 rad/s² for
/// the motor. The effort limit, when it is the smaller one, says so itself.
#[test]
fn the_limit_that_binds_is_the_one_that_is_named() {
    let program = "[setpoint]\norder = 2\nvelocity = \"40 rad/s\"\nacceleration = \"1e4 rad/s2\"\n[[program]]\n\
                   move_to = \"20 rad\"\n";
    for (drive, torque, name, other) in [
        ("", 1.5 * 3.0 * 0.545 * 6.45 * 2_f64.sqrt(), Name::CurrentSaturationTime, Name::EffortSaturationTime),
        ("max_torque = \"15 Nm\"\n", 15.0, Name::EffortSaturationTime, Name::CurrentSaturationTime),
    ] {
        let step = rotary(&format!("[drive]\ndc_link = \"540 V\"\n{drive}{program}"));
        let recording = run(&step, &Exact);
        let velocity = recording.channel("motor.velocity").unwrap();
        let [early, late] = [0.01, 0.03].map(|t| velocity[recording.index_at(t)]);
        // On the axis, behind the gear: τ/10 over the 0.01 kg m² that the motor feels.
        let expected = torque / 0.01 / 10.0;
        assert!(((late - early) / 0.02 / expected - 1.0).abs() < 1e-3, "{} rad/s²", (late - early) / 0.02);
        let metrics = measured(&step, &recording);
        assert!(value(&metrics, name) > 0.02 && value(&metrics, other).abs() < 1e-15, "{name}");
    }
}

/// Oracle: the motor goes where the drive wants it, r̂·θ = x; the axis goes to r·θ.
#[test]
fn a_wrong_gear_ratio_moves_the_axis_too_far() {
    let moved = rotary(
        "[drive]\ndc_link = \"540 V\"\nestimate.gear_ratio = 11\n[setpoint]\norder = 3\nvelocity = \"2 rad/s\"\n\
         acceleration = \"40 rad/s2\"\njerk = \"2000 rad/s3\"\n[[program]]\nmove_to = \"0.1 rad\"\n",
    );
    let recording = run(&moved, &Exact);
    let last = *recording.channel("load.position").unwrap().last().unwrap();
    // 6 Hz of position bandwidth: what is left after half a second is below e^(−18).
    assert!((last / 0.11 - 1.0).abs() < 1e-6, "{last}");
}

/// Oracle: as for the axis itself, e = v/kp + F/(kp·kv): a drive that thinks its amplifier twice as strong gives half the
/// force for its gain in newtons.
#[test]
fn a_wrong_source_gain_changes_the_loop_gain() {
    let v: f64 = 0.12468;
    let emps = |estimate: &str| {
        scenario(&format!(
            r#"
[run]
base_rate = "16 kHz"
[axis]
model = "emps"
[motor]
model = "emps"
[drive]
model = "emps"
velocity.gain = "8557.4 N s/m"
{estimate}
[setpoint]
order = 3
velocity = "0.12468 m/s"
acceleration = "1 m/s2"
jerk = "20 m/s3"
[[program]]
move_to = "200 mm"
"#
        ))
    };
    for (estimate, gain) in [("", 35.1507), ("estimate.gain = \"70.3014 N/V\"", 70.3014)] {
        let recording = run(&emps(estimate), &Exact);
        let friction = 203.5034 * v + 20.3935 - 3.1648;
        let closed_form = v / 160.18 + friction / (160.18 * 8557.4 * 35.1507 / gain);
        let made = &recording.moves[0];
        let found = recording.channel("following_error.motor").unwrap()
            [recording.index_at(made.cruise.0 + 0.9 * made.cruise.1)];
        assert!((found / closed_form - 1.0).abs() < 2e-3, "{gain}: {found} m against {closed_form} m");
    }
}

/// Oracle: u ≤ U_dc/√3 of whichever DC link is the lower one, the drive's or the inverter's own. What the inverter cuts on
/// its own is known, too.
#[test]
fn the_lower_dc_link_limits_the_voltage_and_it_is_said() {
    let program = "[setpoint]\norder = 3\nvelocity = \"6 rad/s\"\nacceleration = \"100 rad/s2\"\njerk = \"5000 rad/s3\"\n\
                   [[program]]\nmove_to = \"1 rad\"\n";
    for (real, believed) in [(100, 100), (100, 540), (540, 100), (540, 540)] {
        let drive = format!("[drive]\ndc_link = \"{real} V\"\nestimate.dc_link = \"{believed} V\"\n");
        let moved = rotary(&format!("{drive}{program}"));
        let recording = run(&moved, &Exact);
        let asked = peak(&recording, "voltage.magnitude");
        assert!(asked <= f64::from(believed) / 3_f64.sqrt() * (1.0 + 1e-12), "{real} V, {believed} V: {asked} V");
        let cut = value(&measured(&moved, &recording), Name::VoltageSaturationTime);
        let said = recording.events.iter().any(|event| event.message == "voltage limit binds");
        // 60 rad/s of the motor need 98 V; 100 V of DC link give 58 V.
        assert_eq!((cut > 0.0, said), (real.min(believed) < 540, real.min(believed) < 540), "{real} V, {believed} V");
    }
}
