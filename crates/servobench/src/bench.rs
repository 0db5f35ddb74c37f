//! The closed loop step by step.
use crate::error::Error;
use crate::run::{Judging, Run, early_end};
use crate::scenario::Scenario;
use servobench_base::Setpoint;
use servobench_plant::{BodyState, Engine};
use servobench_signals::Signal;
use servobench_sim::{self as sim, External, Failure, Stepper};

/// A scenario tick by tick, with efforts, a set-point or a controller from outside.
///
/// Between two ticks it shows the axis at the present instant; a tick holds its inputs and moves the axis to the next instant.
pub struct Bench {
    scenario: servobench_scenario::Scenario,
    stepper: Stepper,
    failure: Option<Failure>,
    is_controlled_from_outside: bool,
}

impl Bench {
    /// The loop of `scenario` at time 0, on its first engine.
    ///
    /// # Errors
    /// [`Error::Build`], [`Error::EngineMissing`].
    pub fn new(scenario: &Scenario) -> Result<Self, Error> {
        Self::on(scenario, scenario.engine()?)
    }

    /// The same on an engine supplied by the caller.
    ///
    /// # Errors
    /// [`Error::Build`].
    pub fn on(scenario: &Scenario, engine: &dyn Engine) -> Result<Self, Error> {
        let resolved = scenario.resolved().clone();
        let stepper = sim::Bench::new(&resolved, engine)?.into_recording_stepper();
        Ok(Self { scenario: resolved, stepper, failure: None, is_controlled_from_outside: false })
    }

    /// True until the run has the length that its scenario gives it.
    #[must_use]
    pub const fn is_under_way(&self) -> bool {
        self.failure.is_none() && self.stepper.is_under_way()
    }

    /// One tick, through which `external` is held.
    ///
    /// # Errors
    /// [`Error::Failed`] where the simulation cannot continue; [`finish`](Self::finish) returns the run up to there.
    pub fn step(&mut self, external: &External) -> Result<(), Error> {
        self.is_controlled_from_outside |= external.controller.is_some();
        self.stepper.step(external).map_err(|failure| {
            self.failure = Some(failure.clone());
            failure.into()
        })
    }

    /// The present time (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.stepper.base_rate().time(self.stepper.tick())
    }

    /// Length of a tick (s).
    #[must_use]
    pub fn period(&self) -> f64 {
        self.stepper.base_rate().period()
    }

    /// Position and velocity of the motor at the present instant, in its own coordinate (rad, rad/s, or m, m/s).
    #[must_use]
    pub fn motor(&self) -> BodyState {
        self.stepper.shaft()
    }

    /// The set-point of the tick before, in the coordinate of the axis.
    #[must_use]
    pub const fn setpoint(&self) -> Setpoint {
        self.stepper.setpoint()
    }

    /// The value of a signal (SI): positions and velocities of the bodies at the present instant, everything else of the tick before, zero
    /// before the first. `None` of a signal that the scenario does not record.
    #[must_use]
    pub fn value(&mut self, signal: Signal) -> Option<f64> {
        let index = self.stepper.signals().iter().position(|one| *one == signal)?;
        self.stepper.values().get(index).copied()
    }

    /// Ends the run at the present instant, measures and judges it.
    ///
    /// # Errors
    /// [`Error::Failed`] of a failure that leaves nothing to judge, [`Error::NotKept`].
    pub fn finish(self) -> Result<Run, Error> {
        let outcome = self.stepper.finish(self.failure);
        let ended = outcome.failure.map(early_end).transpose()?;
        let judging =
            Judging { ended, is_controlled_from_outside: self.is_controlled_from_outside, ..Judging::default() };
        Run::judged(&self.scenario, outcome.recording, judging).map_err(Error::NotKept)
    }
}
