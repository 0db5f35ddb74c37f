//! The linear loop of users' own MJCF files, as each engine that reads them has it: against bodies, and against runs.
use servobench_base::Coordinate;
use servobench_plant::{Encoder, Engine, Exact, ModelKind};
use servobench_scenario::{Actuator, AxisMechanics, Drive, Feedback, Scenario};
use servobench_sim::{Analysis, Bench, External, NotAnalysed, analyse_stability, mechanics_at_rest};
use servobench_stability::{Depth, GainName, Report};
use servobench_tests::{engines, scenario_file};

/// How near to a boundary runs are looked at, as a share of the gain.
const BAR: f64 = 0.005;
/// Ticks of a window, of which the largest change of velocity is taken, and windows of a run.
const WINDOW: u32 = 1_600;
const WINDOWS: usize = 50;
/// Share of the largest change below which a push has faded to what rounding leaves.
const FADED: f64 = 1e-13;
/// Change of velocity within a tick from which on what is left out matters (m/s or rad/s).
const GROWN: f64 = 1.0;
/// Error of the engines' steps, as a share of a gain.
const OF_A_STEP: f64 = 2e-3;

/// A carriage with a load that sways on it, on a base that gives way.
const SOFT_BASE: &str = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body><joint type="slide" axis="1 0 0" stiffness="4e6" damping="900"/>
      <inertial pos="0 0 0" mass="50" diaginertia="1 1 1"/>
      <body><joint name="carriage" type="slide" axis="1 0 0" damping="10"/>
        <inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/>
        <body><joint name="load" type="slide" axis="1 0 0" stiffness="6e5" damping="500"/>
          <inertial pos="0 0 0" mass="10" diaginertia="1 1 1"/></body>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="force" joint="carriage"/></actuator></mujoco>"#;

/// An arm with a second one that hangs on it by a spring, both in gravity; `POSE` is where the arm points. It has dry friction, which the
/// linear loop leaves out.
const ARM: &str = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 -9.81" integrator="RK4"/>
  <worldbody>
    <body><joint name="carriage" type="hinge" axis="0 1 0" damping="0.5" frictionloss="FRICTION"/>
      <inertial pos="POSE" mass="5" diaginertia="0.1 0.2 0.1"/>
      <body pos="POSE"><joint name="load" type="hinge" axis="0 1 0" stiffness="4e3" damping="3"/>
        <inertial pos="POSE" mass="2" diaginertia="0.03 0.05 0.03"/></body>
    </body>
  </worldbody>
  <actuator><motor name="force" joint="carriage"/></actuator></mujoco>"#;

/// Those of the build that read MJCF.
fn mjcf_engines() -> impl Iterator<Item = &'static dyn Engine> {
    engines().into_iter().filter(|engine| engine.name().simulates(ModelKind::Mjcf))
}

fn drive(scenario: &mut Scenario) -> &mut Drive {
    match &mut scenario.actuator {
        Actuator::IdealSource { drive, source, .. } => {
            (source.limit, drive.params.velocity.max_effort) = (f64::INFINITY, f64::INFINITY);
            drive
        }
        other => panic!("{other:?}"),
    }
}

/// `own-mjcf.toml` without a program, with these gains: of the position loop (1/s), of the velocity loop, and its integral time (s).
fn axis(xml: Option<&str>, coordinate: Coordinate, gains: [f64; 3], on_load: bool) -> Scenario {
    let mut scenario = scenario_file("own-mjcf.toml");
    scenario.program.clear();
    scenario.duration = Some(10.0);
    if let (AxisMechanics::Mjcf(file), Some(xml)) = (&mut scenario.axis.mechanics, xml) {
        xml.clone_into(&mut file.xml);
    }
    (scenario.axis.motor_motion, scenario.axis.motion) = (coordinate, coordinate);
    let drive = drive(&mut scenario);
    let params = &mut drive.params;
    [params.position_gain, params.velocity.k_p, _] = gains;
    params.velocity.integral_time = Some(gains[2]);
    if on_load {
        drive.position_feedback = Feedback::Load(Encoder::default());
    }
    scenario
}

fn analysed(scenario: &Scenario, engine: &dyn Engine) -> Analysis {
    let model = mechanics_at_rest(scenario, engine);
    analyse_stability(scenario, Depth::Boundaries, None, model.as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

fn report(scenario: &Scenario, engine: &dyn Engine) -> Report {
    match analysed(scenario, engine) {
        Analysis::Done { report, .. } => *report,
        Analysis::NotPossible(why) => panic!("{}: {why}", engine.name()),
    }
}

fn boundaries(report: &Report) -> Vec<(GainName, f64)> {
    let of = |found: &servobench_stability::LoopReport| {
        let at = found.boundaries?;
        Some([at.below, at.above].into_iter().flatten().map(|at| (found.gain_name, at.factor)).collect::<Vec<_>>())
    };
    report.loops.iter().filter_map(of).flatten().collect()
}

/// Growth of a push from window to window over the last half of a run; ±∞ where it fades to nothing or grows for good.
fn growth(scenario: &Scenario, engine: &dyn Engine) -> f64 {
    let bench = Bench::new(scenario, engine).unwrap_or_else(|error| panic!("{error}"));
    let mut stepper = bench.into_stepper();
    let velocity = stepper.channels().iter().position(|spec| spec.name == "motor.velocity").unwrap();
    let (mut last, mut windows) = (0.0, Vec::new());
    for window in 0..WINDOWS {
        let mut most = 0.0_f64;
        for tick in 0..WINDOW {
            let motor_effort = if window == 0 && tick == 0 { 1e-4 } else { 0.0 };
            if stepper.step(&External { motor_effort, ..External::default() }).is_err() {
                return f64::INFINITY;
            }
            let now = stepper.values()[velocity];
            most = most.max((now - last).abs());
            last = now;
        }
        windows.push(most);
        if most > GROWN {
            return f64::INFINITY;
        }
    }
    let nothing = FADED * windows.iter().copied().fold(0.0, f64::max);
    if windows[WINDOWS / 2..].iter().any(|most| *most < nothing) {
        return f64::NEG_INFINITY;
    }
    let half: Vec<f64> = windows[WINDOWS / 2..].iter().map(|most| most.ln()).collect();
    let middle = (half.len() - 1) as f64 / 2.0;
    let (mut above, mut below) = (0.0, 0.0);
    for (index, logarithm) in half.iter().enumerate() {
        above += (index as f64 - middle) * logarithm;
        below += (index as f64 - middle).powi(2);
    }
    above / below
}

fn scaled(scenario: &Scenario, name: GainName, factor: f64) -> Scenario {
    let mut scaled = scenario.clone();
    let params = &mut drive(&mut scaled).params;
    match name {
        GainName::Position => params.position_gain *= factor,
        _ => params.velocity.k_p *= factor,
    }
    scaled
}

/// Oracle: runs with a gain 0.5 % to both sides of each boundary, over which a push fades or grows; engines that integrate otherwise agree
/// to the error of their steps.
#[test]
fn boundaries_of_mjcf_files_are_where_runs_change_from_decay_to_growth() {
    use Coordinate::{Linear, Rotary};
    let arm = |pose: &str| ARM.replace("POSE", pose).replace("FRICTION", "0");
    let (up, ahead) = (arm("0 0 0.3"), arm("0.3 0 0"));
    for (number, (what, xml, coordinate, gains, on_load)) in [
        ("load that sways", None, Linear, [25.0, 2.8e3, 0.05], false),
        ("load that sways, its encoder", None, Linear, [25.0, 2.8e3, 0.05], true),
        ("soft base", Some(SOFT_BASE), Linear, [40.0, 4e3, 0.1], true),
        ("arm ahead", Some(&*ahead), Rotary, [20.0, 60.0, 0.1], false),
        ("arm up", Some(&*up), Rotary, [1.1, 30.0, 1e9], false),
    ]
    .into_iter()
    .enumerate()
    {
        let scenario = axis(xml, coordinate, gains, on_load);
        let found: Vec<_> = mjcf_engines().map(|engine| (engine, boundaries(&report(&scenario, engine)))).collect();
        for (engine, all) in &found {
            println!("{what} on {}: {all:?}", engine.name());
            assert!(all.len() >= 2 && all.len() == found[0].1.len(), "{what}");
            for ((name, one), (_, other)) in all.iter().zip(&found[0].1) {
                assert!((one / other - 1.0).abs() < OF_A_STEP, "{what}: {name:?} {one} {other}");
            }
        }
        let (engine, all) = &found[number % found.len()];
        for (name, factor) in all {
            let of = |by: f64| growth(&scaled(&scenario, *name, factor * by), *engine);
            let (below, above) = (of(1.0 / (1.0 + BAR)), of(1.0 + BAR));
            println!("    {name:?} {factor:.5}: {below:.4} {above:.4}");
            let (inside, outside) = if *factor > 1.0 { (below, above) } else { (above, below) };
            assert!(inside < 0.0 && outside > 0.0, "{what}: {name:?}");
        }
    }
}

/// Oracle: the same bodies in a row, whose matrices are exact.
#[test]
fn an_mjcf_file_of_bodies_in_a_row_has_the_boundaries_of_these() {
    let file = axis(None, Coordinate::Linear, [25.0, 2.8e3, 0.05], true);
    let mut bodies = file.clone();
    bodies.axis.mechanics = scenario_file("lambrechts-snap.toml").axis.mechanics;
    let expected = boundaries(&report(&bodies, &Exact));
    for engine in mjcf_engines() {
        for ((name, one), (_, other)) in boundaries(&report(&file, engine)).iter().zip(&expected) {
            println!("{} {name:?}: {:.1e}", engine.name(), one / other - 1.0);
            assert!((one / other - 1.0).abs() < OF_A_STEP);
        }
    }
}

#[test]
fn dry_friction_is_left_out_and_what_has_no_rest_is_named() {
    let with = |xml: String| axis(Some(&xml), Coordinate::Rotary, [1.1, 30.0, 1e9], false);
    let arm = |friction: &str| with(ARM.replace("POSE", "0 0 0.3").replace("FRICTION", friction));
    let falls = with(ARM.replace("POSE", "0.3 0 0").replace("FRICTION", "0").replace("stiffness=\"4e3\"", ""));
    for engine in mjcf_engines() {
        assert_eq!(boundaries(&report(&arm("5"), engine)), boundaries(&report(&arm("0"), engine)), "{}", engine.name());
        match analysed(&falls, engine) {
            Analysis::NotPossible(NotAnalysed::Mjcf(why)) => {
                assert_eq!(why, "no effort of the motor holds the axis at rest where the scenario begins");
            }
            other => panic!("{other:?}"),
        }
    }
}
