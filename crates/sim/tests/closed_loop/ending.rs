//! How a run ends: by its length, or by a failure of the engine.
use crate::rig;
use servobench_plant::{BodyState, Engine, EngineName, Exact, Input, Mechanics, MechanicsError, MechanicsSetup};
use servobench_scenario::{LONGEST_RUN, Scenario};
use servobench_sim::{Bench, BuildError};

/// A mass of 20 kg that 1 N is to bring to a metre from here at once: the effort limit binds from the first ticks on.
fn weak() -> Scenario {
    let text = r#"
[run]
base_rate = "16 kHz"
duration = "0.05 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
limit = "1 N"
[drive.velocity]
rate = "16 kHz"
gain = "1000 N s/m"
[drive.position]
rate = "16 kHz"
gain = "60 1/s"
[setpoint]
order = 2
velocity = "1 m/s"
acceleration = "100 m/s2"
[[program]]
move_to = "1 m"
"#;
    rig::scenario(text)
}

/// `exact` until a tick at which it fails.
struct FailsAt(u64);

struct Failing {
    exact: Box<dyn Mechanics>,
    ticks_left: u64,
}

impl Engine for FailsAt {
    fn name(&self) -> EngineName {
        EngineName::Exact
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        Ok(Box::new(Failing { exact: Exact.build(setup)?, ticks_left: self.0 }))
    }
}

impl Mechanics for Failing {
    fn bodies(&self) -> &[BodyState] {
        self.exact.bodies()
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let Some(left) = self.ticks_left.checked_sub(1) else {
            return Err(MechanicsError::Native { engine: EngineName::Exact, message: "as asked".into() });
        };
        self.ticks_left = left;
        self.exact.advance(input)
    }
}

#[test]
fn what_still_binds_at_a_failure_ends_there() {
    for (engine, last_tick) in [(&FailsAt(24) as &dyn Engine, 24.0), (&Exact, 800.0)] {
        let outcome = Bench::new(&weak(), engine).unwrap().run(&mut |_| {});
        let recording = outcome.recording;
        let last = last_tick / 16e3;
        assert_eq!(outcome.failure.map(|failure| failure.time), (last_tick < 800.0).then_some(last));
        assert_eq!(recording.time_of(recording.len() - 1).to_bits(), f64::to_bits(last));
        let [event] = recording.events.as_slice() else { panic!("one event: {:?}", recording.events) };
        assert!(event.start < 0.001, "{event:?}");
        assert_eq!(event.end.to_bits(), f64::to_bits(last), "{event:?}");
    }
}

/// Beyond 2⁶⁴ ticks the counter would start again from zero: no tick, nothing measured, and passed.
#[test]
fn a_run_that_never_ends_is_refused() {
    for duration in [1.001 * LONGEST_RUN, 1e16, 1e300, f64::INFINITY, f64::NAN] {
        let mut scenario = weak();
        scenario.duration = Some(duration);
        let refusal = Bench::new(&scenario, &Exact).err();
        assert!(matches!(&refusal, Some(BuildError::TooLong { step: None, .. })), "{refusal:?}");
    }
}

/// 1e10 ticks at 16 kHz are a week.
#[test]
fn a_run_of_too_many_ticks_is_refused() {
    let mut scenario = weak();
    for (duration, is_refused) in [(624_999.0, false), (625_001.0, true)] {
        scenario.duration = Some(duration);
        let refusal = Bench::new(&scenario, &Exact).err();
        assert_eq!(matches!(refusal, Some(BuildError::TooManyTicks { .. })), is_refused, "{refusal:?}");
    }
}

#[test]
fn a_recording_that_does_not_fit_is_refused() {
    let mut scenario = weak();
    scenario.duration = Some(0.5 * LONGEST_RUN);
    let refusal = Bench::new(&scenario, &Exact).err();
    assert!(matches!(refusal, Some(BuildError::RecordingTooLarge { .. })), "{refusal:?}");
}

#[test]
fn a_disturbance_after_the_end_is_refused() {
    use servobench_scenario::{Disturbance, DisturbedBody};
    let mut scenario = weak();
    let (on, effort, frequency) = (DisturbedBody::Load, 1.0, None);
    scenario.disturbances.push(Disturbance { on, start: 0.06, duration: f64::INFINITY, effort, frequency });
    let refusal = Bench::new(&scenario, &Exact).err();
    assert!(matches!(refusal, Some(BuildError::IdleDisturbance { index: 0, .. })), "{refusal:?}");
}
