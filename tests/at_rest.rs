//! Every ready scenario without its program, its loads and its bus: an axis that nobody moves is finite and at rest.
use servobench_metrics::Name;
use servobench_plant::Exact;
use servobench_scenario::{Initial, Scenario, load};
use servobench_sim::Bench;
use servobench_testkit::Random;
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

/// Motors from 16 Ω and 50 µH to 0.02 Ω and 5 mH in their closed loop, with dead time, threshold and resistance of the devices, at speeds at
/// which currents stick at zero for long and at others: losses and velocity error are those of a tick a quarter as long within 1 %; the
/// most is 0.5 %, of 1 Ω and 20 µH.
#[test]
fn five_motors_in_their_loop_have_the_losses_of_a_short_tick() {
    let motors = [
        ("16 Ohm", ["50 uH"; 2], "4 mV s", "2 Apk", ("1e-5 kg m2", "1e-5 Nm s/rad"), 48, ("2 us", "0.7 V", "1 Ohm")),
        ("1 Ohm", ["20 uH"; 2], "20 mV s", "10 Apk", ("3e-5 kg m2", "1e-4 Nm s/rad"), 48, ("1 us", "0.5 V", "1 Ohm")),
        (
            "0.36 Ohm",
            ["0.2 mH"; 2],
            "6.2 mV s",
            "7 Apk",
            ("3e-5 kg m2", "1e-4 Nm s/rad"),
            48,
            ("2 us", "0 V", "30 mOhm"),
        ),
        (
            "1.615 Ohm",
            ["2.9 mH", "4.4 mH"],
            "60.6 mV s",
            "18 Apk",
            ("3e-4 kg m2", "1e-3 Nm s/rad"),
            320,
            ("2.3 us", "0.9 V", "60 mOhm"),
        ),
        (
            "0.02 Ohm",
            ["5 mH"; 2],
            "0.5 V s",
            "90 Apk",
            ("0.2 kg m2", "0.05 Nm s/rad"),
            560,
            ("2 us", "1.2 V", "4 mOhm"),
        ),
    ];
    for (resistance, [l_d, l_q], psi, most, (inertia, viscous), link, (dead_time, drop, on)) in motors {
        for (speed, acceleration, way) in [(60, 50, 90), (900, 400, 540)] {
            let [coarse, fine] = [16, 64].map(|rate| {
                let scenario = scenario(&format!(
                    "[run]\nbase_rate = \"{rate} kHz\"\n[axis]\nmotion = \"rotary\"\n\
                     motor_side = {{ inertia = \"{inertia}\", viscous = \"{viscous}\" }}\n\
                     [motor]\nkind = \"pmsm\"\npole_pairs = 4\nresistance = \"{resistance}\"\ninductance_d = \"{l_d}\"\n\
                     inductance_q = \"{l_q}\"\nflux_linkage = \"{psi}\"\nmax_current = \"{most}\"\n\
                     [drive]\ndc_link = \"{link} V\"\ninverter = {{ carrier = \"16 kHz\", dead_time = \"{dead_time}\", \
                     device_drop = \"{drop}\", on_resistance = \"{on}\" }}\n\
                     current = {{ rate = \"16 kHz\", bandwidth = \"400 Hz\" }}\n\
                     velocity = {{ rate = \"8 kHz\", bandwidth = \"40 Hz\" }}\n\
                     position = {{ rate = \"4 kHz\", bandwidth = \"8 Hz\" }}\nfeedforward = {{ velocity = true }}\n\
                     [setpoint]\norder = 3\nvelocity = \"{speed} rpm\"\nacceleration = \"{acceleration} rad/s2\"\n\
                     jerk = \"{acceleration}e2 rad/s3\"\n[[program]]\nmove_to = \"{way} deg\"\n"
                ));
                let metrics = measured(&scenario, &run(&scenario, &Exact));
                [Name::CopperLoss, Name::InverterLoss, Name::VelocityErrorPeak].map(|name| value(&metrics, name))
            });
            println!("{resistance}, {l_d}, {speed} rpm: {coarse:?} {fine:?}");
            for at in 0..3 {
                assert!((coarse[at] / fine[at] - 1.0).abs() < 0.01, "{resistance} {speed} {at}: {coarse:?} {fine:?}");
            }
        }
    }
}

/// A random axis on a motor that saturates, in SI units and in proportion: its link gives three times the back-EMF, its resistance takes up
/// to a fifth of that and its current up to the flux of its magnets; salient or not, on an inverter with these keys.
fn saturating(random: &mut Random, inverter: &str) -> String {
    let (link, most) = (random.one_of(&[48.0, 320.0, 560.0]), random.logarithmic(0.5, 50.0));
    let (pairs, speed) = (1 + random.below(6), random.between(30.0, 300.0));
    let psi = link / 3.0_f64.sqrt() / 3.0 / (pairs as f64 * speed);
    let resistance = link * random.logarithmic(0.003, 0.06) / most;
    let l_d = psi / most * random.logarithmic(0.05, 1.0);
    let l_q = l_d * random.one_of(&[1.0, 1.4, 2.5]);
    let torque = 1.5 * pairs as f64 * psi * most;
    let acceleration = speed / random.between(0.03, 0.1);
    let inertia = random.between(0.05, 0.4) * torque / acceleration;
    let saturation = psi / l_d * random.between(0.4, 2.0);
    let [share, residual, viscous] =
        [random.between(0.8, 0.99), random.between(0.02, 0.3), random.between(0.0, 0.1) * torque / speed];
    let strategy = random.one_of(&["d-reference", "mtpa"]);
    let way = if random.below(2) == 0 { -1.0 } else { 1.0 } * 0.2 * speed;
    format!(
        "[run]\nbase_rate = \"16 kHz\"\nduration = \"0.7 s\"\n[axis]\nmotion = \"rotary\"\n\
         motor_side = {{ inertia = \"{inertia} kg m2\", viscous = \"{viscous} Nm s/rad\" }}\n\
         [motor]\nkind = \"pmsm\"\npole_pairs = {pairs}\nresistance = \"{resistance} Ohm\"\ninductance_d = \"{l_d} H\"\n\
         inductance_q = \"{l_q} H\"\nflux_linkage = \"{psi} V s\"\nmax_current = \"{most} Apk\"\n\
         saturation = {{ current = \"{saturation} Apk\", share = {share}, residual = {residual} }}\n\
         [drive]\ndc_link = \"{link} V\"\ninverter = {{ {inverter} }}\n\
         current = {{ rate = \"16 kHz\", bandwidth = \"400 Hz\", strategy = \"{strategy}\" }}\n\
         velocity = {{ rate = \"8 kHz\", bandwidth = \"40 Hz\" }}\nposition = {{ rate = \"4 kHz\", bandwidth = \"8 Hz\" }}\n\
         feedforward = {{ velocity = true, effort = \"rigid\" }}\n\
         [setpoint]\norder = 3\nvelocity = \"{speed} rad/s\"\nacceleration = \"{acceleration} rad/s2\"\n\
         jerk = \"{} rad/s3\"\n[[program]]\nmove_by = \"{way} rad\"\n",
        300.0 * acceleration
    )
}

/// Newton's method of a motor that saturates ended at a part of the current, which a motor without load comes below: NaN some time after
/// the move, or in the first tick. With dead time an axis without friction hunts for ever, which finer ticks and a bridge that switches do
/// as well: there it is finite.
#[test]
fn random_axes_that_saturate_come_to_rest_without_load() {
    let inverters = [
        ("on_resistance = \"1 mOhm\"", true),
        ("", true),
        ("modulation = \"switching\", carrier = \"16 kHz\"", true),
        ("carrier = \"16 kHz\", dead_time = \"1 us\", device_drop = \"0.4 V\"", false),
    ];
    let (mut random, mut made, mut refused) = (Random::seeded(39), 0, 0);
    while made < 200 {
        // A bridge that switches takes ten times as long.
        let (inverter, rests) = if made % 20 == 0 { inverters[2] } else { inverters[random.one_of(&[0, 1, 3])] };
        let text = saturating(&mut random, inverter);
        // A share of the torque that no curve of these magnets and inductances has.
        let Ok(loaded) = servobench_scenario::parse("saturating", &text, None) else {
            refused += 1;
            continue;
        };
        made += 1;
        let recording = run(&loaded.scenario, &Exact);
        for channel in &recording.channels {
            let finite = channel.values.iter().all(|value| value.is_finite());
            assert!(finite, "{made}: {} is not finite\n{text}", channel.spec.name);
        }
        let velocity = recording.channel("motor.velocity").unwrap();
        let largest = |all: &[f64]| all.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let [fastest, at_rest] = [largest(velocity), largest(&velocity[recording.index_at(0.6)..])];
        assert!(!rests || at_rest < 1e-4 * fastest, "{made}: {at_rest} of {fastest} rad/s\n{text}");
    }
    assert!(refused < 200, "{refused} of {} axes were refused", made + refused);
    println!("{refused} more were refused");
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
