//! Bodies, the drive's estimate of them, and the loops.
use super::*;

/// Oracle: by hand. r = 10 mm/2π; J = rotor + motor side + r²·table.
#[test]
fn a_rigid_body_is_reflected_through_the_screw() {
    let scenario = scenario(SCREW);
    let r = 0.01 / TAU;
    assert!(same(scenario.axis.transmission, r));
    assert_eq!((scenario.axis.motion, scenario.axis.motor_motion), (Coordinate::Linear, Coordinate::Rotary));
    let [motor, load] = bodies(&scenario) else { panic!("the table is merged") };
    assert_eq!((motor.name, load.name), ("motor", "load"));
    assert!(same(motor.inertia, 1.57e-4 + 1e-4 + r * r * 30.0));
    assert!(same(motor.friction.viscous, 1e-3 + r * r * 100.0));
    assert!(same(motor.friction.dry.coulomb, 0.05 + r * 20.0));
    assert!(same(motor.friction.dry.breakaway, 0.05 + r * 32.0));
    assert!(same(motor.friction.dry.stribeck_velocity, 0.002 / r));
    assert!(same(motor.bias, r * 9.81));
    assert_eq!((load.coordinate, motor.transmission.to_bits()), (Coordinate::Linear, r.to_bits()));
    let [link] = chain(&scenario).links() else { panic!("one link") };
    assert!(same(link.stiffness, 2e6) && same(link.damping, 50.0));
}

/// Oracle: by hand, in the axis coordinate: J/r², τ/r.
#[test]
fn the_estimate_is_the_plant_as_two_masses() {
    let scenario = scenario(SCREW);
    let (r, estimate) = (0.01 / TAU, &drive(&scenario).estimate);
    assert!(same(estimate.transmission, r));
    assert!(same(estimate.motor_inertia, (1.57e-4 + 1e-4) / (r * r) + 30.0));
    assert!(same(estimate.motor_viscous, 1e-3 / (r * r) + 100.0));
    assert!(same(estimate.coulomb, 0.05 / r + 20.0));
    assert!(same(estimate.bias, 9.81));
    assert!(same(estimate.load_inertia, 10.0) && same(estimate.stiffness, 2e6));
    assert!(estimate.load_viscous == 0.0);
    let (motor, dc_link, current) = motor(&scenario);
    assert!(same(current.motor.resistance, motor.resistance) && same(current.motor.flux_linkage, motor.flux_linkage));
    assert!(same(current.max_voltage, inverter::voltage_limit(dc_link)));
}

#[test]
fn three_bodies_are_split_at_the_softest_coupling() {
    let stiff_table = SCREW.replace("viscous = \"100", "stiffness = \"43 N/um\"\nviscous = \"100");
    let first = scenario(&stiff_table);
    assert_eq!(bodies(&first).len(), 3);
    let estimate = &drive(&first).estimate;
    assert!(same(estimate.load_inertia, 10.0) && same(estimate.stiffness, 2e6));
    let soft_table = SCREW.replace("viscous = \"100", "stiffness = \"1 N/um\"\nviscous = \"100");
    let second = scenario(&soft_table);
    let estimate = &drive(&second).estimate;
    assert!(same(estimate.load_inertia, 40.0) && same(estimate.stiffness, 1e6));
}

/// Oracle: the rules of `docs/scenario.md` by hand: J·ω at the motor, 4/ω, K_v = ω.
#[test]
fn gains_follow_from_bandwidths() {
    let scenario = scenario(SCREW);
    let r = 0.01 / TAU;
    let inertia = 1.57e-4 + 1e-4 + r * r * 40.0;
    let params = params(&scenario);
    let velocity = &params.velocity;
    assert!(same(velocity.k_p, inertia * TAU * 60.0), "{}", velocity.k_p);
    assert!(same(velocity.integral_time.unwrap(), 4.0 / (TAU * 60.0)));
    assert!(same(params.position_gain, TAU * 12.0));
    assert_eq!((params.velocity_rate().hertz(), params.position_rate().hertz()), (8_000, 4_000));
    let (motor, _, current) = motor(&scenario);
    let tuning = drive(&scenario).current_tuning;
    assert!(matches!(tuning, Some(Tuning::Bandwidth(alpha)) if same(alpha, TAU * 1200.0)), "{tuning:?}");
    assert!(same(current.gains.k_p.q, TAU * 1200.0 * motor.inductance.q));
    assert!(same(current.gains.k_i.q, TAU * 1200.0 * motor.resistance), "the integral time is L/R");
}

/// A wrong estimate of the inertia reaches the gain: the firmware knows only its estimate.
#[test]
fn an_estimate_overrides_single_values() {
    let right = scenario(SCREW);
    let wrong = scenario(&format!("{SCREW}[drive.estimate]\nload_inertia = \"20 kg\"\nmotor.resistance = \"2 Ohm\"\n"));
    let r = 0.01 / TAU;
    // The difference of two nearly equal gains loses a digit or two.
    let difference = params(&wrong).velocity.k_p - params(&right).velocity.k_p;
    assert!((difference / (r * r * 10.0 * TAU * 60.0) - 1.0).abs() < 1e-12, "{difference}");
    assert!(same(drive(&wrong).estimate.motor_inertia, drive(&right).estimate.motor_inertia));
    let (plant, _, current) = motor(&wrong);
    assert!(same(current.motor.resistance, 2.0) && same(plant.resistance, 1.615), "the motor itself is what it is");
    assert!(same(current.motor.flux_linkage, plant.flux_linkage));
}

/// Oracle: by hand. A drive that assumes half the lead sees twice the revolutions per millimetre; the inertia at the shaft of the
/// motor does not change.
#[test]
fn what_the_drive_believes_does_not_change_the_plant() {
    let text = format!("{SCREW}[drive.estimate]\nlead = \"5 mm\"\ngear_ratio = 3\ndc_link = \"600 V\"\n");
    let wrong = scenario(&text);
    assert!(same(wrong.axis.transmission, 0.01 / TAU));
    let (estimate, r) = (&drive(&wrong).estimate, 0.005 / TAU / 3.0);
    assert!(same(estimate.transmission, r));
    let shaft = 1.57e-4 + 1e-4 + (0.01 / TAU) * (0.01 / TAU) * 30.0;
    assert!(same(estimate.motor_inertia * r * r, shaft), "{estimate:?}");
    assert!(same(params(&wrong).velocity.k_p, (shaft + r * r * 10.0) * TAU * 60.0));
    let (_, dc_link, current) = motor(&wrong);
    assert!(same(dc_link, 560.0) && same(current.max_voltage, inverter::voltage_limit(600.0)));
}

/// Oracle: by hand. Gains in volts do not depend on the drive's estimate of a volt; the limit of the output becomes a limit of the
/// estimated effort.
#[test]
fn an_ideal_source_has_a_gain_that_the_drive_believes() {
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/emps.toml")).unwrap();
    let wrong = scenario(&format!("{text}[drive.estimate]\ngain = \"20 N/V\"\n"));
    let (source, estimated_gain) = source(&wrong);
    assert!(same(source.gain, 35.1507) && same(estimated_gain, 20.0));
    assert!(same(params(&wrong).velocity.k_p, 20.0 * 243.45) && same(params(&wrong).velocity.max_effort, 200.0));
}

#[test]
fn gains_of_the_current_loop_are_those_of_the_file() {
    let with = |current: &str| scenario(&SCREW.replace("load_encoder = {", &format!("{current}\nload_encoder = {{")));
    let given = with("current.gain_d = \"12 V/A\"\ncurrent.gain_q = \"15 V/A\"");
    let (motor_of_file, _, current) = motor(&given);
    assert_eq!(drive(&given).current_tuning, Some(Tuning::Gains(Dq { d: 12.0, q: 15.0 })));
    let l_over_r = motor_of_file.inductance.q / motor_of_file.resistance;
    assert!(same(current.gains.k_p.d, 12.0) && same(current.gains.k_p.q / current.gains.k_i.q, l_over_r));
    let given = with("current.integral_time_d = \"2 ms\"\ncurrent.integral_time_q = \"4 ms\"");
    let (.., current) = motor(&given);
    let Gains { k_p, k_i } = current.gains;
    assert!(same(k_p.d / k_i.d, 0.002) && same(k_p.q / k_i.q, 0.004));
    let tuning = drive(&given).current_tuning;
    assert!(matches!(tuning, Some(Tuning::Bandwidth(_))), "the bandwidth of the model stays");
}

#[test]
fn limits_of_the_motor_and_its_encoder() {
    let scenario = scenario(SCREW);
    let (motor, dc_link, current) = motor(&scenario);
    assert!(same(current.max_current, 13.3 * 2_f64.sqrt()), "effective becomes peak");
    assert!(
        params(&scenario).velocity.max_effort.is_infinite(),
        "the current is the only limit unless another is given"
    );
    assert!(same(scenario.actuator.max_effort(), motor.effort_constant(0.0) * current.max_current));
    let Actuator::Pmsm { encoder: Encoder { increment: Some(increment), .. }, .. } = scenario.actuator else {
        panic!("an encoder with increments")
    };
    assert!(same(increment, TAU / 1_048_576.0));
    let Feedback::Load(encoder) = drive(&scenario).position_feedback else { panic!("the load's") };
    assert!(same(encoder.increment.unwrap(), 1e-7));
    assert!(same(dc_link, 560.0));
}

/// Oracle: by hand, from the file to the firmware.
#[test]
fn blocks_of_the_firmware_are_those_of_the_file() {
    use servobench_drive::current::operating_point::{Strategy, Weakening};
    use servobench_drive::{Blocks, filter, overload, schedule};
    assert_eq!(params(&scenario(SCREW)).blocks, Blocks::default(), "none of them unless it is asked for");
    assert!(motor(&scenario(SCREW)).2.operation.is_plain() && motor(&scenario(SCREW)).2.dead_time.is_none());
    let given = "[drive.velocity]\nmax_speed = \"3000 rpm\"\nreference_weight = 0.7\n\
        [[drive.filter]]\nkind = \"low-pass\"\nfrequency = \"700 Hz\"\n\
        [[drive.filter]]\nkind = \"bi-quad\"\nzero_frequency = \"400 Hz\"\npole_frequency = \"500 Hz\"\nzero_damping = 0.1\n\
        [[drive.cogging]]\norder = 12\namplitude = \"0.02 Nm\"\nphase = \"30 deg\"\n\
        [drive.gain_schedule]\nfrom = \"1 rad/s\"\nto = \"2 rad/s\"\nvelocity = 0.5\n\
        [drive.current]\nstrategy = \"mtpa\"\nfield_weakening = true\n\
        dead_time_compensation = { dead_time = \"2 us\", frequency = \"8 kHz\" }\n\
        [drive.i2t]\nmotor = { continuous_current = \"5 Apk\", time_constant = \"3 s\" }\n\
        drive = { continuous_current = \"5 Arms\", peak_time = \"2 s\" }\n";
    let scenario = scenario(&format!("{SCREW}\n{given}"));
    let (params, (_, dc_link, current)) = (params(&scenario), motor(&scenario));
    let Blocks {
        filters,
        cogging,
        motor_load,
        drive_load,
        schedule,
        max_speed,
        reference_weight,
        measurement,
        acceleration,
        position,
        supervision,
        measures_dc_link,
        ..
    } = &params.blocks;
    let (zero_frequency, zero_damping, pole_frequency, pole_damping) = (400.0, 0.1, 500.0, 0.7);
    let exact = [
        filter::Filter::LowPass { frequency: 700.0 },
        filter::Filter::BiQuad { zero_frequency, zero_damping, pole_frequency, pole_damping },
    ];
    assert_eq!(*filters, filter::Params::new(&exact, params.velocity_rate()).unwrap());
    assert!(same(*max_speed, 3000.0 * TAU / 60.0) && same(*reference_weight, 0.7));
    assert_eq!((*measurement, *acceleration, *position), (None, None, None));
    assert_eq!((*supervision, *measures_dc_link), (None, false));
    assert_eq!(*schedule, Some(schedule::Params { from: 1.0, to: 2.0, position: 1.0, velocity: 0.5 }));
    let cogging = cogging.unwrap();
    assert!(same(cogging.effort(0.3, 0.0), -0.02 * (12.0_f64 * 0.3 + TAU / 12.0).sin()));
    let lag = (params.period(params.velocity_every) - 1.0 / 16e3) / 2.0;
    assert!(same(cogging.lead(), lag + current.motor.inductance.q / current.gains.k_p.q), "{}", cogging.lead());
    let derate = overload::Reaction::Derate;
    let load = overload::Params { continuous_current: 5.0, time_constant: 3.0, reaction: derate };
    assert_eq!(*motor_load, Some(load));
    assert!(same(drive_load.unwrap().time(13.3 * 2_f64.sqrt()), 2.0));
    assert_eq!(current.operation.strategy, Strategy::Mtpa);
    assert_eq!(current.operation.weakening, Some(Weakening { share: 0.95, feedback: 0.0 }));
    assert!(same(current.dead_time.unwrap().loss(), 2e-6 * 8e3 * dc_link));
}

/// Oracle: by hand, from the file to plant and firmware.
#[test]
fn faults_and_their_supervision_are_those_of_the_file() {
    use servobench_drive::supervision::{Commutation, Params, Phases, Stall};
    use servobench_plant::{Phase, Swap, Wiring};
    let given = "[motor.connection]\nswapped = \"ca\"\nopen = \"b\"\nopen_at = \"0.3 s\"\n\
        [drive.current]\nmeasured_dc_link = true\n[bus]\ncycle = \"1 ms\"\n\
        [drive.supervision]\nundervoltage = \"201 V\"\novervoltage = \"402 V\"\noverspeed = \"3000 rpm\"\n\
        commutation = { speed = \"300 rpm\", current = \"4 Arms\" }\nstall = { speed = \"30 rpm\", time = \"0.2 s\" }\n\
        phase_loss = { current = \"1.5 Apk\", time = \"7 ms\" }\novercurrent = \"21 Arms\"\nwinding_temperature = \"131 degC\"\n\
        [motor.thermal]\nambient = \"25 degC\"\nto_housing = \"1 K/W\"\nto_ambient = \"1 K/W\"\nwinding_capacity = \"100 J/K\"\n\
        housing_capacity = \"1000 J/K\"\n";
    let scenario = scenario(&format!("{SCREW}\n{given}"));
    let Actuator::Pmsm { wiring, .. } = &scenario.actuator else { panic!("a motor") };
    assert_eq!(*wiring, Wiring { swapped: Some(Swap::Ca), open: Some((Phase::B, 0.3)) });
    let blocks = &params(&scenario).blocks;
    let rpm = TAU / 60.0;
    let expected = Params {
        undervoltage: Some(201.0),
        overvoltage: Some(402.0),
        overspeed: Some(3000.0 * rpm),
        overcurrent: Some(21.0 * 2_f64.sqrt()),
        winding_temperature: Some(131.0),
        commutation: Some(Commutation { speed: 300.0 * rpm, current: 4.0 * 2_f64.sqrt() }),
        stall: Some(Stall { speed: 30.0 * rpm, time: 0.2 }),
        phases: Some(Phases { current: 1.5, time: 7e-3 }),
    };
    let found = blocks.supervision.unwrap();
    assert!(blocks.measures_dc_link);
    let numbers = |p: &Params| {
        let (commutation, stall, phases) = (p.commutation.unwrap(), p.stall.unwrap(), p.phases.unwrap());
        let [low, high, speed] = [p.undervoltage, p.overvoltage, p.overspeed].map(Option::unwrap);
        let [most, warm] = [p.overcurrent, p.winding_temperature].map(Option::unwrap);
        [
            low,
            high,
            speed,
            most,
            warm,
            commutation.speed,
            commutation.current,
            stall.speed,
            stall.time,
            phases.current,
            phases.time,
        ]
    };
    for (found, expected) in numbers(&found).into_iter().zip(numbers(&expected)) {
        assert!(same(found, expected), "{found} {expected}");
    }
}

/// Oracle: by hand, from the file to the firmware.
#[test]
fn how_the_velocity_is_measured_is_as_the_file_says() {
    use servobench_drive::measurement::{Params as Method, mt, observer};
    use servobench_drive::{derivative, position};
    let with = |keys: &str| params(&scenario(&format!("{SCREW}\n{keys}"))).clone();
    let found = with("[drive.velocity]\nmeasurement = \"difference\"\n");
    assert_eq!(found.blocks.measurement, Some(Method::Difference));
    let found = with("[drive.velocity]\nmeasurement = \"mt\"\n");
    let Some(Method::Mt(mt::Params { timer, step })) = found.blocks.measurement else { panic!("{found:?}") };
    assert!(same(timer, 100e-9) && same(step, TAU / 1_048_576.0));
    let found = with(
        "[drive.velocity]\nmeasurement = \"observer\"\nobserver = { bandwidth = \"200 Hz\", disturbance_compensation = 0.3 }\n",
    );
    let Some(Method::Observer(observer)) = found.blocks.measurement else { panic!("{found:?}") };
    let inertia = observer.inertia;
    let exact = observer::Params::new(200.0 * TAU, found.period(found.velocity_every), inertia, 0.3).unwrap();
    assert_eq!(observer, exact);
    // The velocity loop's gain is the same inertia times its bandwidth.
    assert!((found.velocity.k_p / inertia / TAU - 60.0).abs() < 1e-9, "{found:?}");
    let found = with(
        "[drive.velocity]\nderivative_time = \"0.4 ms\"\n\
        [drive.position]\nintegral_time = \"70 ms\"\nderivative_time = \"3 ms\"\nderivative_filter_time = \"1 ms\"\n",
    );
    let acceleration = found.blocks.acceleration.unwrap();
    assert!(same(acceleration.time, 0.4e-3) && same(acceleration.filter_time, 0.04e-3));
    let position::Params { integral_time, derivative } = found.blocks.position.unwrap();
    assert!(same(integral_time.unwrap(), 70e-3));
    assert_eq!(derivative, Some(derivative::Params { time: 3e-3, filter_time: 1e-3 }));
}
