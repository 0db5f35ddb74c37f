//! Values and times of the exchanges with an FMU.
use super::*;
use servobench_plant::{BodyState, EngineName, MechanicsError};
use std::sync::{Arc, Mutex};

/// A torque that excites the mode, and a force on the table.
fn efforts(tick: u32) -> (f64, f64) {
    let t = f64::from(tick) * TICK;
    (2.0 * (700.0 * t).sin() + 0.5, 100.0 * (90.0 * t).cos())
}

/// To the bit: the FMU's inputs and outputs are passed on.
#[test]
fn with_an_exchange_in_every_tick_it_is_what_the_fmu_is() {
    let mut fmu = mechanics(ExactFmu::new(TICK), &model(1), &IN_SI);
    let mut here = exact(TICK);
    for tick in 0..1000 {
        assert_eq!(fmu.bodies(), here.bodies(), "tick {tick}");
        let (torque, force) = efforts(tick);
        let all = Input { motor_disturbance: 0.25, ..input(torque, force) };
        fmu.advance(&all).unwrap();
        here.advance(&all).unwrap();
    }
    assert!(here.bodies()[1].position.abs() > 1e-4, "it moves");
}

/// Oracle: a built-in engine stepped n ticks at once, with the mean of the efforts; bit for bit at the exchanges, except for the rounding
/// of the mean, which a relative 1e-12 covers over 100 steps.
#[test]
fn between_exchanges_the_fmu_gets_the_mean_of_the_efforts() {
    const N: u32 = 4;
    let step = f64::from(N) * TICK;
    let mut fmu = mechanics(ExactFmu::new(step), &model(N), &IN_SI);
    let mut here = exact(step);
    for exchange in 0..100 {
        for (body, at) in fmu.bodies().iter().zip(here.bodies()) {
            assert!(
                (body.position - at.position).abs() <= 1e-12 * at.position.abs().max(1e-3),
                "{exchange}: {body:?} {at:?}"
            );
            assert!(
                (body.velocity - at.velocity).abs() <= 1e-12 * at.velocity.abs().max(1.0),
                "{exchange}: {body:?} {at:?}"
            );
        }
        let (mut torque, mut force) = (0.0, 0.0);
        for tick in N * exchange..N * (exchange + 1) {
            let now = efforts(tick);
            (torque, force) = (torque + now.0 / f64::from(N), force + now.1 / f64::from(N));
            fmu.advance(&input(now.0, now.1)).unwrap();
        }
        here.advance(&input(torque, force)).unwrap();
    }
}

/// Greatest error of the table's position between exchanges, while it swings freely after 10 ms of torque.
fn worst(ticks: u32) -> f64 {
    let mut fmu = mechanics(ExactFmu::new(f64::from(ticks) * TICK), &model(ticks), &IN_SI);
    let mut here = exact(TICK);
    let mut worst = 0.0_f64;
    for tick in 0..800 {
        let torque = if tick < 80 { 2.0 } else { 0.0 };
        fmu.advance(&input(torque, 0.0)).unwrap();
        here.advance(&input(torque, 0.0)).unwrap();
        // Any exact engine agrees at the exchanges: the difference is that of the extrapolation.
        if tick > 160 {
            worst = worst.max((fmu.bodies()[1].position - here.bodies()[1].position).abs());
        }
    }
    worst
}

/// Oracle: the engine with a step of a tick. The order of the extrapolation is tested with its code; this tests its time and period: half
/// the step divides the error by 4. The mode has ω·H = 0.05 and 0.1, and its next order a tenth of that: 20 % each way.
#[test]
fn bodies_go_on_between_exchanges() {
    // The last tick before an exchange is 7/8 and 3/4 of a step after the previous one.
    let (coarse, fine) = (worst(8), worst(4));
    let observed = (coarse / fine * (0.75 / 0.875_f64).powi(2)).log2();
    assert!((observed - 2.0).abs() < 0.3, "{coarse} {fine} {observed}");
}

/// A slave at rest that gives scripted answers and records its steps.
struct Scripted {
    answer: fn(f64, f64) -> Result<StepEnd, SlaveError>,
    position: f64,
    /// Time, length and effort of each step.
    steps: Arc<Mutex<Vec<(f64, f64, f64)>>>,
}

impl Scripted {
    fn new(answer: fn(f64, f64) -> Result<StepEnd, SlaveError>) -> Self {
        Self { answer, position: 0.5, steps: Arc::default() }
    }
}

impl Slave for Scripted {
    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.steps.lock().unwrap().push((time, length, inputs[0][0]));
        (self.answer)(time, length)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        outputs[0] = self.position;
        Ok(())
    }
}

fn single_body(ticks: u32) -> FmuModel {
    let motor = FmuBody { position: port("angle", RADIAN), velocity: None };
    FmuModel { motor, load: None, load_disturbance: None, ..model(ticks) }
}

/// The result of a tick with this answer.
fn tick(answer: fn(f64, f64) -> Result<StepEnd, SlaveError>) -> Result<(), MechanicsError> {
    mechanics(Scripted::new(answer), &single_body(1), &IN_SI).advance(&input(1.0, 0.0))
}

#[test]
fn times_are_counted_not_summed() {
    let toy = Scripted::new(|_, _| Ok(StepEnd::Done));
    let steps = Arc::clone(&toy.steps);
    let mut fmu = mechanics(toy, &single_body(3), &IN_SI);
    (0..3_000).for_each(|_| fmu.advance(&input(1.0, 0.0)).unwrap());
    let steps = steps.lock().unwrap();
    // 2997 ticks of 1/8000 s: one rounding, that of the quotient.
    assert_eq!((steps.len(), steps[999]), (1000, (2997.0 / 8_000.0, 3.0 / 8_000.0, 1.0)));
}

/// Oracle: the virtual work of a force F on the load is F·dx = F·i·dφ.
#[test]
fn disturbances_of_a_single_body_act_with_the_effort() {
    let all = Input { motor_disturbance: 0.5, ..input(2.0, 100.0) };
    let toy = Scripted::new(|_, _| Ok(StepEnd::Done));
    let steps = Arc::clone(&toy.steps);
    mechanics(toy, &single_body(1), &IN_SI).advance(&all).unwrap();
    assert_eq!(*steps.lock().unwrap(), [(0.0, TICK, 2.0 + 0.5 + 100.0 * 5e-3)]);
}

#[test]
fn a_load_of_its_own_needs_an_input_for_its_disturbance() {
    let model = FmuModel { load_disturbance: None, ..model(1) };
    let mut fmu = mechanics(ExactFmu::new(TICK), &model, &IN_SI);
    fmu.advance(&input(1.0, 0.0)).unwrap();
    let error = fmu.advance(&input(1.0, 3.0)).unwrap_err();
    assert!(error.to_string().contains("name that input with `load_disturbance`"), "{error}");
}

#[test]
fn a_step_that_ends_early_goes_on_to_its_end() {
    let early = |time: f64, length: f64| {
        if length > 0.9 * TICK { Ok(StepEnd::Until(time + 0.25 * length)) } else { Ok(StepEnd::Done) }
    };
    assert_eq!(tick(early), Ok(()));
}

#[test]
fn what_goes_wrong_in_a_step_ends_the_run_with_the_reason() {
    let says = |answer: fn(f64, f64) -> Result<StepEnd, SlaveError>| tick(answer).unwrap_err();
    for (error, words) in [
        (says(|time, _| Ok(StepEnd::Until(time))), "came back from a step from 0 s at 0 s"),
        (says(|time, length| Ok(StepEnd::Until(time + 1e-6 * length))), "came back early 10000 times"),
        (says(|_, _| Ok(StepEnd::Terminated(0.0))), "wants the simulation to end at 0 s"),
        (
            says(|time, _| Err(SlaveError::Crashed { call: "".into(), time, how: "signal 11".into() })),
            "ended at 0 s: signal 11",
        ),
        (
            says(|time, _| Err(SlaveError::Discarded { call: "fmi2DoStep".into(), time, shortest: None })),
            "discarded fmi2DoStep at 0 s",
        ),
    ] {
        assert!(matches!(error, MechanicsError::Native { engine: EngineName::Fmu, .. }), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    }
    let error = says(|time, _| Err(SlaveError::NotFinite { variable: "x".into(), value: f64::NAN, time }));
    assert!(matches!(error, MechanicsError::Native { .. }), "{error}");
}

#[test]
fn a_position_that_is_not_finite_is_not_passed_on() {
    let toy = Scripted { position: f64::INFINITY, ..Scripted::new(|_, _| Ok(StepEnd::Done)) };
    let built = FmuMechanics::new(Box::new(toy), &single_body(1), TICK);
    let error = built.err().unwrap();
    assert_eq!(error.to_string(), "engine `fmu` failed: the FMU's output `angle` is inf");
}

#[test]
fn a_position_that_no_machine_has_is_divergence() {
    let toy = Scripted { position: -2e10, ..Scripted::new(|_, _| Ok(StepEnd::Done)) };
    let error = mechanics(toy, &single_body(1), &IN_SI).advance(&input(1.0, 0.0)).unwrap_err();
    let said = "engine `fmu` diverged: a position or velocity has grown to 2.0e10 m or rad, or per second";
    assert_eq!(error.to_string(), said);
}

#[test]
fn a_prescribed_motion_is_refused() {
    let actuation = Actuation::Motion(servobench_base::Setpoint::default());
    let all = Input { actuation, motor_disturbance: 0.0, load_disturbance: 0.0 };
    let result = mechanics(ExactFmu::new(TICK), &model(1), &IN_SI).advance(&all);
    assert!(matches!(result, Err(MechanicsError::Unsupported { engine: EngineName::Fmu, .. })));
}

/// A slave that moves with 3 rad/s.
struct Ramp(f64);

impl Slave for Ramp {
    fn step(&mut self, time: f64, length: f64, _: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.0 = 3.0 * (time + length);
        Ok(StepEnd::Done)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        outputs[0] = self.0;
        Ok(())
    }
}

/// Oracle: the velocity derived from the positions. Tolerance: a rounding each of product, sum, difference and quotient.
#[test]
fn without_a_velocity_it_is_that_of_the_positions() {
    let mut fmu = mechanics(Ramp(0.0), &single_body(1), &IN_SI);
    assert_eq!(fmu.bodies(), [BodyState::default()]);
    for _ in 0..10 {
        fmu.advance(&input(0.0, 0.0)).unwrap();
        assert!((fmu.bodies()[0].velocity - 3.0).abs() < 1e-11, "{:?}", fmu.bodies());
    }
}
