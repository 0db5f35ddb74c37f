//! Every ready scenario without its program, its loads and its bus: an axis that nobody moves is finite and at rest.
use servobench_metrics::Name;
use servobench_plant::Exact;
use servobench_scenario::{Initial, Scenario, load};
use servobench_sim::Bench;
use servobench_tests::{engines, faults, measured, ready_scenarios, run, scenario, value};

/// How far the load goes in the last second: encoders have noise, and loops without an integrator of the position creep (m or rad).
const AT_REST: f64 = 2e-3;

/// The hardware of `scenario` for ten seconds, with nothing to do.
fn idle(mut scenario: Scenario) -> Scenario {
    scenario.program.clear();
    scenario.disturbances.clear();
    scenario.requirements.expected.clear();
    scenario.record.channels.clear();
    (scenario.plc, scenario.bus, scenario.interpolation) = (None, None, None);
    scenario.initial = Initial::default();
    scenario.duration = Some(10.0);
    scenario
}

/// What is wrong with it, if anything.
fn fault(scenario: &Scenario) -> Option<String> {
    let all = engines();
    let engine = all.iter().find(|engine| scenario.engines.contains(&engine.name()))?;
    // One that cannot stand without its bus, its program or its FMU.
    let bench = Bench::new(scenario, *engine).ok()?;
    let outcome = bench.run(&mut |_| {});
    if let Some(failure) = &outcome.failure {
        return Some(format!("{failure:?}"));
    }
    let recording = &outcome.recording;
    for channel in &recording.channels {
        if let Some(at) = channel.values.iter().position(|value| !value.is_finite()) {
            return Some(format!("{} is not finite in row {at}", channel.spec.name));
        }
    }
    let position = recording.channel("load.position")?;
    let last = &position[recording.index_at(9.0)..];
    let (low, high) = last.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
    (high - low > AT_REST).then(|| format!("the load goes by {} in the last second", high - low))
}

#[test]
fn every_ready_scenario_that_nothing_moves_is_at_rest() {
    let mut hardware: Vec<Scenario> = Vec::new();
    for path in ready_scenarios() {
        let Ok(loaded) = load(&path) else { continue };
        let scenario = idle(loaded.scenario);
        let is_known = |one: &Scenario| {
            one.axis == scenario.axis && one.actuator == scenario.actuator && one.base_rate == scenario.base_rate
        };
        if scenario.fmus.is_empty() && !hardware.iter().any(is_known) {
            hardware.push(scenario);
        }
    }
    assert!(hardware.len() > 40, "{} ready scenarios", hardware.len());
    let wrong = faults(&hardware, |one| fault(one).map(|fault| format!("{}: {fault}", one.name)));
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A small motor on an averaged inverter, told by its own tick that is 8 times as short: the error of the dead time was that of a pure
/// inductance, which made the copper loss 3.4 times as large; that of the resistance of the devices acted on the current without it, which
/// made their loss twice as large.
#[test]
fn small_motors_have_the_losses_of_a_short_tick() {
    let axis = "[axis]\nmotion = \"rotary\"\nmotor_side = { inertia = \"3e-5 kg m2\", viscous = \"1e-4 Nm s/rad\" }\n";
    let drive = "dc_link = \"48 V\"\ncurrent = { rate = \"16 kHz\", bandwidth = \"400 Hz\" }\n\
        velocity = { rate = \"8 kHz\", bandwidth = \"40 Hz\" }\nposition = { rate = \"4 kHz\", bandwidth = \"8 Hz\" }\n\
        feedforward = { velocity = true }\n";
    let rest = "[setpoint]\norder = 3\nvelocity = \"60 rpm\"\nacceleration = \"50 rad/s2\"\njerk = \"5e3 rad/s3\"\n\
        [[program]]\nmove_to = \"180 deg\"\n[[program]]\nmove_to = \"0 deg\"\n";
    let small = "[motor]\nmodel = \"teknic-m2310p\"\n";
    let slotless = "[motor]\nkind = \"pmsm\"\npole_pairs = 1\nresistance = \"1 Ohm\"\ninductance = \"20 uH\"\n\
        flux_linkage = \"0.02 V s\"\ninertia = \"1e-6 kg m2\"\nmax_current = \"10 Apk\"\n";
    for (motor, inverter, expected) in [
        (small, "carrier = \"16 kHz\", dead_time = \"2 us\"", Some(6.45e-3)),
        (small, "device_drop = \"0.7 V\", on_resistance = \"0.1 Ohm\"", None),
        (slotless, "on_resistance = \"1 Ohm\"", None),
        (
            slotless,
            "carrier = \"16 kHz\", dead_time = \"1 us\", device_drop = \"0.5 V\", on_resistance = \"1 Ohm\"",
            None,
        ),
    ] {
        let [coarse, fine] = ["16 kHz", "128 kHz"].map(|rate| {
            let text = format!(
                "[run]\nbase_rate = \"{rate}\"\n{axis}{motor}[drive]\ninverter = {{ {inverter} }}\n{drive}{rest}"
            );
            let scenario = scenario(&text);
            let metrics = measured(&scenario, &run(&scenario, &Exact));
            [Name::CopperLoss, Name::InverterLoss, Name::VelocityErrorPeak].map(|name| value(&metrics, name))
        });
        println!("{inverter}: {coarse:?} {fine:?}");
        for at in 0..3 {
            assert!((coarse[at] - fine[at]).abs() <= 0.01 * fine[at].abs(), "{inverter}, {at}: {coarse:?} {fine:?}");
        }
        if let Some(expected) = expected {
            assert!((coarse[0] / expected - 1.0).abs() < 0.01, "{coarse:?}");
        }
    }
}

/// A motor whose teeth or iron act swings into a tooth, or is braked, with its power off for good.
#[test]
fn a_motor_that_is_off_has_its_teeth() {
    let text = |cogging: &str| {
        format!(
            "[run]\nbase_rate = \"16 kHz\"\nduration = \"1 s\"\n[axis]\nmotion = \"rotary\"\n\
             motor_side = {{ inertia = \"3 kg cm2\", viscous = \"0.01 Nm s/rad\" }}\n\
             [motor]\nmodel = \"wittenstein-premo-1f\"\n{cogging}[drive]\nenabled = false\nmodel = \"servo-16khz\"\n\
             dc_link = \"320 V\"\n[setpoint]\norder = 3\nvelocity = \"60 rpm\"\nacceleration = \"100 rad/s2\"\n\
             jerk = \"1e4 rad/s3\"\n[[program]]\nwait = \"1 s\"\n"
        )
    };
    let end = |text: &str| {
        let recording = run(&scenario(text), &Exact);
        let position = recording.channel("load.position").unwrap();
        position[position.len() - 1]
    };
    assert!(end(&text("")).abs() < 1e-15);
    // Oracle: F·sin(36·x + φ) is at rest where the angle is half a turn.
    let found = end(&text("cogging = [{ per_rev = 36, amplitude = \"0.2 Nm\", phase = \"60 deg\" }]\n"));
    let expected = 120.0_f64.to_radians() / 36.0;
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
}
