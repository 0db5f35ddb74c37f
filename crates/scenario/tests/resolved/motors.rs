//! Motors, and models in place of one.
use super::*;

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

/// Oracle: 12 kHz ticks are 1/12000 s apart, whatever decimal fraction is typed; 16 000 samples of the typed time would be 6e-7
/// samples short, and set-points would switch a tick late.
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
