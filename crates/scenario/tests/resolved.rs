//! What a scenario becomes: derived gains, merged bodies, overridden models.
use servobench_base::{Coordinate, Dq, Setpoint};
use servobench_drive::current::{self, Gains, Tuning};
use servobench_drive::{Params, Stage, feedforward};
use servobench_metrics::{Limit, Name};
use servobench_motion::interpolate::Mode;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target};
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};
use servobench_motion::shape::Shaper;
use servobench_motion::{Limits, Order};
use servobench_planner::{
    Averages, CommandRate, Filter, Follow, Generator, Grid, Method, PointToPoint, Positioning, Replanning, Rockwell,
    Shaping, TableMove, Velocities,
};
use servobench_plant::{Body, Chain, Encoder, EngineName, IdealSource, SourceOutput, inverter, pmsm};
use servobench_scenario::*;
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn scenario(text: &str) -> Scenario {
    parse("test.toml", text, None).unwrap_or_else(|e| panic!("{e}")).scenario
}

fn chain(scenario: &Scenario) -> &Chain {
    match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => chain,
        AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => panic!("bodies"),
    }
}

fn bodies(scenario: &Scenario) -> &[Body] {
    chain(scenario).bodies()
}

/// The synchronous motor, its DC link and its current loop.
fn motor(scenario: &Scenario) -> (&pmsm::Params, f64, &current::Params) {
    match &scenario.actuator {
        Actuator::Pmsm { motor, dc_link, drive, .. } => (motor, *dc_link, drive.params.current_loop().unwrap().0),
        other => panic!("a synchronous motor, not {other:?}"),
    }
}

/// The ideal source and its gain as the drive knows it.
fn source(scenario: &Scenario) -> (&IdealSource, f64) {
    match &scenario.actuator {
        Actuator::IdealSource { source, drive, .. } => match drive.params.stage {
            Stage::Direct { gain } => (source, gain),
            Stage::Current { .. } => panic!("a current loop"),
        },
        other => panic!("an ideal source, not {other:?}"),
    }
}

/// The samples of a move from rest to rest.
fn grid(step: &MoveStep) -> Grid {
    match step.request.generator {
        Generator::PointToPoint(PointToPoint { grid: Some(grid), .. }) => grid,
        _ => panic!("{step:?}"),
    }
}

fn drive(scenario: &Scenario) -> &Drive {
    scenario.actuator.drive().unwrap()
}

fn params(scenario: &Scenario) -> &Params {
    &drive(scenario).params
}

/// Equal but for a few roundings.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * a.abs().max(b.abs())
}

const SCREW: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
lead = "10 mm"
[axis.motor_side]
inertia = "1e-4 kg m2"
viscous = "1e-3 Nm s/rad"
coulomb = "0.05 Nm"
[axis.table]
mass = "30 kg"
viscous = "100 N s/m"
coulomb = "20 N"
static = "32 N"
stribeck_velocity = "2 mm/s"
bias = "9.81 N"
[axis.load]
mass = "10 kg"
stiffness = "2 N/um"
damping = "50 N s/m"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
load_encoder = { step = "0.1 um" }
position_feedback = "load"
"#;

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

/// A wrong belief of the inertia reaches the gain: the firmware knows its estimate only.
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

/// Oracle: by hand. A drive that believes in half the lead sees twice the revolutions per millimetre; the inertia at the
/// shaft of the motor is what it is.
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

/// Oracle: by hand. Gains in volts are volts whatever the drive believes a volt to be; the limit of the output becomes one
/// of the effort that it believes in.
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
    let Actuator::Pmsm { encoder: Encoder { increment: Some(increment) }, .. } = scenario.actuator else {
        panic!("an encoder with increments")
    };
    assert!(same(increment, TAU / 1_048_576.0));
    let Feedback::Load(encoder) = drive(&scenario).position_feedback else { panic!("the load's") };
    assert!(same(encoder.increment.unwrap(), 1e-7));
    assert!(same(dc_link, 560.0));
}

const LINEAR: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "100 kg"
[motor]
kind = "pmsm"
pole_pitch = "24 mm"
resistance = "2 Ohm"
inductance = "20 mH"
force_constant = "80 N/Arms"
mass = "5 kg"
max_current = "10 Arms"
[drive]
model = "servo-16khz"
"#;

fn pmsm_of(text: &str) -> pmsm::Params {
    *motor(&scenario(text)).0
}

/// Oracle: by hand. F = 3/2·(π/τ_p)·ψ·i with i an amplitude, and the power balance F·v = 3/2·e·i: at 1 m/s the EMF of a
/// phase has the amplitude e = (π/τ_p)·ψ·1 m/s, √3 times that between two lines.
#[test]
fn a_linear_motor_by_any_of_its_constants() {
    let motor = pmsm_of(LINEAR);
    let per_amplitude = 80.0 / 2_f64.sqrt();
    assert!(same(motor.electrical_ratio, PI / 0.024));
    assert!(
        same(1.5 * PI / 0.024 * motor.flux_linkage, per_amplitude) && same(motor.effort_constant(0.0), per_amplitude)
    );
    let scenario = scenario(LINEAR);
    assert_eq!(scenario.axis.motor_motion, Coordinate::Linear);
    assert!(same(scenario.axis.transmission, 1.0) && same(bodies(&scenario)[0].inertia, 105.0), "forcer and slide");
    assert!(same(scenario.actuator.max_effort(), 800.0), "80 N/Arms times 10 Arms");
    let emf = 3_f64.sqrt() * per_amplitude / 1.5;
    let by_emf = pmsm_of(&LINEAR.replace("force_constant = \"80 N/Arms\"", &format!("back_emf = \"{emf} Vpk s/m\"")));
    assert!(same(by_emf.flux_linkage, motor.flux_linkage), "{} {}", by_emf.flux_linkage, motor.flux_linkage);
}

/// A linear motor is a motor with one pole pair on a screw with a lead of two pole pitches.
#[test]
fn a_linear_motor_is_a_rotary_one_unrolled() {
    let unrolled = LINEAR
        .replace("motion = \"linear\"", "motion = \"linear\"\nlead = \"48 mm\"")
        .replace("pole_pitch = \"24 mm\"", "pole_pairs = 1")
        .replace("force_constant = \"80 N/Arms\"", &format!("flux_linkage = \"{} V s\"", pmsm_of(LINEAR).flux_linkage))
        .replace("[axis.motor_side]\nmass = \"100 kg\"", "[axis.table]\nmass = \"105 kg\"")
        .replace("mass = \"5 kg\"\n", "");
    let (linear, rotary) = (scenario(LINEAR), scenario(&unrolled));
    let r = rotary.axis.transmission;
    assert!(same(linear.actuator.max_effort(), rotary.actuator.max_effort() / r), "the same force at the slide");
    let [linear_gain, rotary_gain] = [&linear, &rotary].map(|scenario| params(scenario).velocity.k_p);
    assert!(same(linear_gain, rotary_gain / (r * r)), "the same gain at the slide");
    assert!(
        same(pmsm_of(LINEAR).electrical_ratio, pmsm_of(&unrolled).electrical_ratio / r),
        "the same frequency at one speed"
    );
}

/// Oracle: the published law, u = k_v·(k_p·e − v) volts and 35.1507 newtons per volt.
#[test]
fn the_emps_controller_in_newtons() {
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/emps.toml")).unwrap();
    let scenario = scenario(&text);
    let params = params(&scenario);
    assert!(same(params.velocity.k_p, 35.1507 * 243.45) && same(params.position_gain, 160.18));
    assert_eq!(params.velocity.integral_time, None);
    assert!(same(params.velocity.max_effort, 351.507));
    assert!(params.feedforward.velocity == 0.0 && params.feedforward.model == feedforward::Model::Off);
    let (source, estimated_gain) = source(&scenario);
    assert!(same(source.gain, 35.1507) && same(source.limit, 10.0) && same(estimated_gain, 35.1507));
    assert_eq!(source.output, SourceOutput::Voltage);
    let [body] = bodies(&scenario) else { panic!("one body") };
    assert!(same(body.inertia, 95.1089) && same(body.friction.viscous, 203.5034) && same(body.bias, -3.1648));
    assert!(
        same(body.friction.dry.coulomb, 20.3935) && same(body.friction.dry.breakaway, body.friction.dry.coulomb),
        "no static friction: as Coulomb"
    );
    assert_eq!(scenario.engines, [EngineName::Exact, EngineName::Rapier, EngineName::Mujoco]);
}

/// Oracle: 12 kHz ticks are 1/12000 s apart, whatever decimal fraction is typed for it; 16 000 samples of the typed time
/// would be 6e-7 samples short, and set-points would switch a tick late.
#[test]
fn a_sample_time_is_whole_ticks_to_the_bit() {
    for (typed, ticks) in
        [("83.33333333 us", 1.0), ("0.0833333333333 ms", 1.0), ("249.9999999 us", 3.0), ("1 ms", 12.0)]
    {
        let text = format!(
            "[run]\nbase_rate = \"12 kHz\"\n[axis]\nmotion = \"linear\"\n[motor]\nkind = \"prescribed\"\n\
             [setpoint]\norder = 2\nvelocity = \"1 m/s\"\nacceleration = \"1 m/s2\"\nsample_time = \"{typed}\"\n\
             [[program]]\nmove_to = \"1 m\"\n"
        );
        let scenario = scenario(&text);
        let [Step::Move(step)] = scenario.program.as_slice() else { panic!("{:?}", scenario.program) };
        let time = grid(step).sample_time;
        assert_eq!(time.to_bits(), f64::to_bits(ticks / 12e3), "{typed}: {time} s");
    }
}

#[test]
fn what_the_scenario_says_displaces_what_the_model_says() {
    let own = SCREW
        .replace("encoder = { counts", "torque_constant = \"0.5 Nm/Apk\"\nmax_current = \"5 Apk\"\nencoder = { counts")
        .replace("load_encoder", "velocity.gain = \"0.2 Nm s/rad\"\nload_encoder");
    let scenario = scenario(&own);
    let (motor, _, current) = motor(&scenario);
    assert!(same(motor.flux_linkage, 0.5 / 6.0), "instead of the model's back-EMF");
    assert!(same(current.max_current, 5.0) && same(motor.resistance, 1.615));
    assert!(same(params(&scenario).velocity.k_p, 0.2), "instead of the model's bandwidth");
    assert_eq!(params(&scenario).velocity_rate().hertz(), 8_000, "the rest of the sub-table stays");
}

#[test]
fn models_beside_the_scenario_come_before_embedded_ones() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("a/b");
    std::fs::create_dir_all(&deep).unwrap();
    std::fs::create_dir_all(folder.path().join("models/drives")).unwrap();
    let mine =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/drives/servo-16khz.toml"))
            .unwrap()
            .replace("560 V", "48 V");
    std::fs::write(folder.path().join("models/drives/servo-16khz.toml"), mine).unwrap();
    let loaded = parse("test.toml", SCREW, Some(&deep)).unwrap();
    assert!(same(motor(&loaded.scenario).1, 48.0));
    let names: Vec<_> = loaded.sources.ids().map(|id| loaded.sources.name(id).to_owned()).collect();
    assert_eq!(names.len(), 3, "the scenario, the motor, the drive: {names:?}");
    assert_eq!(names[1], "<embedded>/models/motors/wittenstein-premo-1f.toml");
}

#[test]
fn moves_take_what_they_do_not_say_from_the_set_point() {
    let text = format!(
        "{SCREW}{}",
        r#"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
sample_time = "1 ms"
[[program]]
move_to = "250 mm"
[[program]]
wait = "0.2 s"
[[program]]
move_by = "-50 mm"
order = 3
velocity = "100 mm/s"
duration = "2 s"
"#
    );
    // The third step leaves `snap` unused, which is worth a warning.
    let loaded = parse("test.toml", &text, None).unwrap();
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    let [Step::Move(first), Step::Wait(pause), Step::Move(second)] = loaded.scenario.program.as_slice() else {
        panic!()
    };
    for (step, distance, positioning, order, duration, limits) in [
        (first, 0.25, Positioning::Absolute, 4, None, [0.5, 5.0, 50.0, 1000.0]),
        (second, -0.05, Positioning::Relative, 3, Some(2.0), [0.1, 5.0, 50.0, f64::INFINITY]),
    ] {
        let generator = &step.request.generator;
        assert_eq!((generator.distance(), step.positioning), (Some(distance), positioning));
        assert_eq!((generator.order(), step.request.duration), (order, duration));
        assert_eq!(generator.limits().map(f64::to_bits), limits.map(f64::to_bits));
    }
    assert_eq!(grid(first), Grid::new(0.001));
    assert!(same(*pause, 0.2));
}

/// Every way of moving, and what the steps take from `[setpoint]`.
#[test]
fn moves_of_every_family() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("points.csv"),
        "time [ms],position [mm],velocity [mm/s]\n0,0,\n10,5,500\n20,15,\n",
    )
    .unwrap();
    let text = format!(
        "{SCREW}{}",
        r#"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
method = "optimal"
negative_velocity = "20 m/min"
shaper = { kind = "ei", frequency = "17.5 Hz", damping = 0.02 }
averages = ["10 ms", "5 ms"]
interpolation = { mode = "quintic-b-spline", period = "4 ms" }
[[program]]
move_to = "250 mm"
[[program]]
move_to = "50 mm"
aborts_after = "0.1 s"
end_velocity = "-5 m/min"
shaper = { kind = "none" }
averages = []
[[program]]
reach_velocity = "6 m/min"
online = "refined"
hold = "0.2 s"
order = 3
shaper = { kind = "none" }
averages = []
[[program]]
move_to = "0 mm"
shaper = { kind = "none" }
averages = []
[[program]]
table = { file = "points.csv", relative = true, velocities = "smooth", passes = 5 }
[[program]]
table = { file = "points.csv", relative = true, follow = "steps", command_rate = "200 Hz" }
shaper = { kind = "none" }
averages = []
[[program]]
move_by = "10 mm"
rockwell = { shape = "s-curve", deceleration = "8 m/s2", jerk_of_time = "25 %", deceleration_jerk_of_maximum = 0.5, maximum_jerk = "400 m/s3" }
"#
    );
    let scenario = parse("test.toml", &text, Some(folder.path())).unwrap_or_else(|e| panic!("{e}")).scenario;
    let period = 4e-3;
    assert_eq!(scenario.interpolation, Some(Interpolation { mode: Mode::QuinticBSpline, period }));
    let moves = scenario.program.iter().filter_map(|step| match step {
        Step::Move(step) => Some(step),
        Step::Wait(_) => None,
    });
    let moves: Vec<_> = moves.collect();
    let [rest, passing, turning, home, through, steps, rockwell] = moves.as_slice() else { panic!("{moves:?}") };

    let generator = |step: &MoveStep| step.request.generator.clone();
    let (order, limits) = (Order::Fourth, Limits { velocity: 0.5, acceleration: 5.0, jerk: 50.0, snap: 1000.0 });
    let method = Method::Optimal;
    let expected = PointToPoint { distance: 0.25, order, limits, method, grid: None };
    assert_eq!(generator(rest), Generator::PointToPoint(expected));
    let shaper = Shaping { shaper: Shaper::Ei { tolerable: 0.05 }, frequency: 17.5, damping: 0.02 };
    let averages = Averages { lengths: vec![0.01, 0.005], sample_time: scenario.base_rate.period() };
    assert_eq!(rest.request.filter, Filter { shaper: Some(shaper), averages: Some(averages) });
    assert_eq!((rest.aborts_after, passing.aborts_after), (None, Some(0.1)));
    assert_eq!(passing.request.filter, Filter::NONE);
    let online = |target, order, effort| {
        let snap = if order == Order::Fourth { limits.snap } else { f64::INFINITY };
        let velocity = Sides { above: limits.velocity, below: 20.0 / 60.0 };
        let limits = DirectionalLimits { velocity, snap, ..limits.into() };
        Generator::Replanning(Replanning { from: Setpoint::default(), target, order, limits, effort })
    };
    let to = |x, v| online(Target::Position { x, v }, Order::Fourth, Effort::Fast);
    assert_eq!(generator(passing), to(0.05, -5.0 / 60.0));
    assert_eq!(generator(turning), online(Target::Velocity(0.1), Order::Third, Effort::Refined));
    assert_eq!((passing.hold, turning.hold), (0.0, 0.2));
    assert!([passing, turning].iter().all(|step| step.request.generator.ends_in_motion()));
    // Nothing of its own says so: the move before ends in motion.
    assert_eq!(generator(home), to(0.0, 0.0));

    let knots = vec![Knot::new(0.0, 0.0), Knot::moving(0.01, 0.005, 0.5), Knot::new(0.02, 0.015)];
    let table = |velocities, follow| Generator::Table(TableMove { knots: knots.clone(), velocities, follow });
    assert_eq!(generator(through), table(Velocities::Smooth { passes: 5 }, Follow::Segments));
    assert_eq!(generator(steps), table(Velocities::Given, Follow::Steps { rate: CommandRate::Given(200.0) }));
    assert_eq!([through, steps].map(|step| step.request.generator.order()), [3, 2]);
    let shape = Shape::SCurve { acceleration: Jerk::PercentOfTime(25.0), deceleration: Jerk::PercentOfMaximum(50.0) };
    let operands = Move { distance: 0.01, speed: 0.5, acceleration: 5.0, deceleration: 8.0, shape };
    let maximum = MaximumJerk { acceleration: 400.0, deceleration: 400.0 };
    assert_eq!(generator(rockwell), Generator::Rockwell(Rockwell { operands, maximum }));
    let positioning = moves.iter().map(|step| step.positioning == Positioning::Absolute);
    assert!(positioning.eq([true, true, false, true, false, false, false]));
}

#[test]
fn limits_keep_their_order_and_their_meaning() {
    let text = format!(
        "{SCREW}{}",
        r#"
[limits]
torque_peak = "5 Nm"
current_peak = "10 Arms"
current_rms = "10 Arms"
following_error_cruise_load = { min = "0.4 mm", max = "0.5 mm" }
residual_vibration_damping = "5 %"
setpoint_jerk_ratio = 1
"#
    );
    let limit = |metric: &str, min, max| Limit { metric: metric.parse().unwrap(), min, max: Some(max) };
    let limits = scenario(&text).limits;
    assert!(same(limits[2].max.unwrap(), 10.0), "an effective value is judged as one");
    assert!(same(limits[1].max.unwrap(), 10.0 * 2_f64.sqrt()), "a peak as one");
    assert_eq!(limits[0], limit("torque_peak", None, 5.0));
    assert_eq!(
        limits[3..],
        [
            limit("following_error_cruise_load", Some(4e-4), 5e-4),
            limit("residual_vibration_damping", None, 0.05),
            limit("setpoint_jerk_ratio", None, 1.0),
        ]
    );
}

const RING_DOWN: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "two-mass"
gear_ratio = 5
[motor]
model = "saarakkala-2.2kw"
[drive]
enabled = false
[initial]
load_position = "90 deg"
load_velocity = "60 rpm"
"#;

#[test]
fn a_drive_that_is_off_needs_no_loops() {
    let scenario = scenario(RING_DOWN);
    assert_eq!(scenario.actuator, Actuator::Off);
    assert!(same(scenario.initial.load_position, PI / 2.0) && same(scenario.initial.load_velocity, TAU));
    assert!(same(scenario.axis.transmission, 0.2));
    assert_eq!((scenario.duration, scenario.record.rate.hertz(), scenario.name.as_str()), (None, 16_000, "test"));
}

#[test]
fn a_prescribed_motor_needs_neither_drive_nor_inertia() {
    let scenario = scenario(
        "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\n[axis.load]\nmass = \"10 kg\"\nstiffness = \"6e5 N/m\"\n\
         [motor]\nkind = \"prescribed\"\n",
    );
    assert_eq!((scenario.actuator, scenario.axis.motor_motion), (Actuator::Prescribed, Coordinate::Linear));
}

#[test]
fn a_users_own_mjcf_is_read_beside_the_file_that_names_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/own-mjcf.toml");
    let scenario = servobench_scenario::load(&path).unwrap().scenario;
    let AxisMechanics::Mjcf(mjcf) = &scenario.axis.mechanics else { panic!("MJCF") };
    assert!(
        mjcf.xml.contains("<mujoco model=\"swaying load\">") && mjcf.path.ends_with("models/axes/swaying-load.xml")
    );
    assert_eq!(
        (mjcf.motor_joint.as_str(), mjcf.load_joint.as_str(), mjcf.actuator.as_str()),
        ("carriage", "load", "force")
    );
    assert!(same(params(&scenario).velocity.k_p, 30.0 * TAU * 15.0), "from the estimate");
}

#[test]
fn a_move_has_limits_of_its_own_and_a_pause_has_none() {
    let file = |step: &str, limit: &str| {
        let setpoint = "[setpoint]\norder = 2\nvelocity = \"1 m/s\"\nacceleration = \"1 m/s2\"\n";
        format!("{SCREW}{setpoint}[[program]]\n{step}\n[program.limits]\n{limit}\n")
    };
    let band = "following_error_cruise_load = { min = \"0.8 mm\", max = \"0.9 mm\" }";
    let Some(Step::Move(MoveStep { metric_limits, .. })) = scenario(&file("move_to = \"1 m\"", band)).program.pop()
    else {
        panic!("a move")
    };
    let metric = Name::FollowingErrorCruiseLoad;
    assert_eq!(metric_limits, [Limit { metric, min: Some(0.8e-3), max: Some(0.9e-3) }]);
    for (step, limit, refusal) in [
        ("wait = \"1 s\"", band, "a pause has no `limits`"),
        ("move_to = \"1 m\"", "settling_time = \"1 s\"", "`settling_time` needs a settling window"),
        ("move_to = \"1 m\"", "following_error_cruise_load = { min = \"-1 mm\" }", "`min` must be zero or more"),
    ] {
        let found = servobench_scenario::parse("test", &file(step, limit), None).unwrap_err().to_string();
        assert!(found.contains(refusal), "{found}");
    }
}
