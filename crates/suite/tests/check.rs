//! Objections of an engine, and the key or line that is to blame.
use servobench::Engines;
use servobench::check::Objection;
use servobench_plant::{
    Engine, EngineName, Exact, Mechanics, MechanicsError, MechanicsSetup, MjcfModel, Refusal, RefusedAt,
};
use servobench_scenario::{Actuator, AxisMechanics, Scenario};
use servobench_suite::{Job, RunError, Source, Workers, check, jobs};

const TEXT: &str = r#"
engine = "exact"
[run]
base_rate = "1 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "1 kHz"
bandwidth = "20 Hz"
[drive.position]
rate = "1 kHz"
gain = "20 1/s"
[setpoint]
order = 2
velocity = "1 m/s"
acceleration = "1 m/s2"
[[program]]
wait = "0.1 s"
[[program]]
move_to = "10 mm"
duration = "1 ms"
"#;

/// Refuses every file in three places, or panics.
struct Refuses {
    panics: bool,
}

impl Engine for Refuses {
    fn name(&self) -> EngineName {
        EngineName::Exact
    }

    fn build(&self, _: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        assert!(!self.panics, "cannot bear it");
        let refusal = |place, message: &str| Refusal { place, message: message.into() };
        let refusals = vec![
            refusal(RefusedAt::Line(3), "no mesh"),
            refusal(RefusedAt::Name("elbow".into()), "no elbow"),
            refusal(RefusedAt::Name("tendon's".into()), "no such joint"),
            refusal(RefusedAt::File, "no mass"),
        ];
        Err(MechanicsError::Refused { engine: EngineName::Exact, path: "arm.xml".into(), refusals, help: "change it" })
    }
}

const REFUSING: Engines = Engines { installed: &[&Refuses { panics: false }], ..Engines::NONE };
const PANICKING: Engines = Engines { installed: &[&Refuses { panics: true }], ..Engines::NONE };

/// With an MJCF file whose load joint is `elbow`.
fn job() -> Job {
    let mut scenario =
        servobench_scenario::parse("test", TEXT, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    scenario.axis.mechanics = AxisMechanics::Mjcf(MjcfModel {
        xml: "<mujoco/>".into(),
        path: "arm.xml".into(),
        motor_joint: "shoulder".into(),
        load_joint: "elbow".into(),
        actuator: "servo".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    });
    jobs(vec![Source { scenario, text: TEXT.into() }], &[]).remove(0)
}

#[test]
fn each_objection_has_its_place() {
    let found = check(&job(), &REFUSING, &Workers::none()).unwrap();
    let places: Vec<(&str, Option<u32>)> = found.iter().map(|one| (one.key.as_str(), one.line)).collect();
    let file = "axis.mjcf.file";
    assert_eq!(
        places,
        [("program.1", None), (file, Some(3)), ("axis.mjcf.load_joint", None), (file, None), (file, None)],
        "{found:?}"
    );
    let refused = |line, message: &str| Objection {
        key: file.into(),
        line,
        message: format!("engine `exact`: {message}"),
        help: "change it".into(),
    };
    assert_eq!((&found[1], &found[4]), (&refused(Some(3), "no mesh"), &refused(None, "no mass")));
}

/// Values that no file can have, since its keys have bounds.
#[test]
fn parameters_of_drive_and_switches_are_shown_at_their_keys() {
    const EXACT: Engines = Engines { installed: &[&Exact], ..Engines::NONE };
    type Spoil = fn(&mut Scenario);
    fn drive(scenario: &mut Scenario) -> &mut servobench_drive::Params {
        let Actuator::IdealSource { drive, .. } = &mut scenario.actuator else { panic!("an ideal source") };
        &mut drive.params
    }
    let text = TEXT.replace("duration = \"1 ms\"", "");
    let cases: [(&str, &str, Spoil); 5] = [
        ("drive.velocity.gain", "`gain of the velocity loop` must be", |it| drive(it).velocity.k_p = f64::NAN),
        ("drive.position.gain", "got -1", |it| drive(it).position_gain = -1.0),
        ("drive.estimate.coulomb", "got inf", |it| drive(it).feedforward.coulomb = f64::INFINITY),
        ("axis", "`transmission` must be", |it| drive(it).transmission = 0.0),
        ("axis.switches.negative", "must be finite", |it| it.axis.switches.negative = Some(f64::NEG_INFINITY)),
    ];
    for (key, words, spoil) in cases {
        let mut scenario = servobench_scenario::parse("test", &text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        spoil(&mut scenario);
        let job = jobs(vec![Source { scenario, text: text.clone() }], &[]).remove(0);
        let found = check(&job, &EXACT, &Workers::none()).unwrap();
        assert!(found.iter().any(|one| one.key == key && one.message.contains(words)), "{key}: {found:?}");
    }
}

#[test]
fn who_cannot_be_asked_is_no_objection() {
    let missing = check(&job(), &Engines::NONE, &Workers::none());
    assert!(matches!(missing, Err(RunError::Loop(servobench::Error::EngineMissing(_)))), "{missing:?}");
    let panicked = check(&job(), &PANICKING, &Workers::none());
    assert!(matches!(panicked, Err(RunError::Loop(servobench::Error::Panicked(_)))), "{panicked:?}");
}
