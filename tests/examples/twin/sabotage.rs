//! Mechanics with something wrong that no scenario can say.
use serde::Deserialize;
use servobench_plant::{
    Actuation, BodyState, Engine, EngineName, Input, JointLimit, LogMessage, Mechanics, MechanicsError, MechanicsSetup,
    MjcfModel, Model,
};
use servobench_scenario::AxisMechanics;
use std::collections::VecDeque;

/// What is wrong with a machine, from a time `at` (s) on.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Sabotage {
    /// The motor gives `factor` of the effort that the drive believes in.
    Effort { at: f64, factor: f64 },
    /// It gives `most` at most (motor coordinate).
    EffortLimit { at: f64, most: f64 },
    /// Motor and load stand, whatever acts on them.
    Stuck { at: f64 },
    /// The encoder of the motor stays where it is.
    EncoderFrozen { at: f64 },
    /// It counts `factor` for one, from where it is.
    EncoderScaled { at: f64, factor: f64 },
    /// It tells where the motor was `by` seconds ago.
    EncoderLate { at: f64, by: f64 },
}

/// What an encoder makes of the position of the motor.
#[derive(Clone, Copy)]
enum Error {
    /// So much of its way.
    Scale(f64),
    /// That of so long ago (s).
    Delay(f64),
}

/// An engine whose mechanics are sabotaged.
pub(crate) struct SabotagedEngine {
    pub(crate) inner: &'static dyn Engine,
    pub(crate) sabotage: Vec<Sabotage>,
    /// The mechanics from the time `at` (s) on, beginning where the others are then.
    pub(crate) then: Option<AxisMechanics>,
    pub(crate) at: f64,
    /// Axis coordinate per motor coordinate.
    pub(crate) transmission: f64,
}

impl Engine for SabotagedEngine {
    fn name(&self) -> EngineName {
        self.inner.name()
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        let inner = self.inner.build(setup)?;
        if self.sabotage.is_empty() && self.then.is_none() {
            return Ok(inner);
        }
        let model = match (&self.then, &setup.model) {
            (Some(AxisMechanics::Bodies(chain)), _) => Some(Model::Chain(chain.clone())),
            (Some(AxisMechanics::Mjcf(file)), Model::Mjcf(before)) => {
                Some(Model::Mjcf(MjcfModel { axis: before.axis, ..file.clone() }))
            }
            _ => None,
        };
        let then = model.map(|model| MechanicsSetup { model, ..setup.clone() });
        let mut sabotaged = Sabotaged {
            engine: self.inner,
            seen: Vec::new(),
            frozen_at: None,
            past: VecDeque::new(),
            tick: 0,
            step: setup.step,
            sabotage: self.sabotage.clone(),
            then,
            at: self.at,
            transmission: self.transmission,
            inner,
        };
        sabotaged.see();
        Ok(Box::new(sabotaged))
    }
}

struct Sabotaged {
    engine: &'static dyn Engine,
    inner: Box<dyn Mechanics>,
    sabotage: Vec<Sabotage>,
    then: Option<MechanicsSetup>,
    at: f64,
    transmission: f64,
    /// The bodies as encoders have them: the motor first, the load last.
    seen: Vec<BodyState>,
    /// Where the motor was when its encoder began to err.
    frozen_at: Option<f64>,
    /// The motor of the last ticks, as long ago as its encoder is late.
    past: VecDeque<BodyState>,
    tick: u64,
    step: f64,
}

impl Sabotaged {
    fn time(&self) -> f64 {
        self.tick as f64 * self.step
    }

    fn is_stuck(&self) -> bool {
        let now = self.time();
        self.sabotage.iter().any(|one| matches!(one, Sabotage::Stuck { at } if now >= *at))
    }

    /// Looks at the bodies. The encoder of a motor that is the load at once errs alone.
    fn see(&mut self) {
        let now = self.time();
        self.seen.clear();
        self.seen.extend_from_slice(self.inner.bodies());
        if self.is_stuck() {
            for body in &mut self.seen {
                body.velocity = 0.0;
            }
        }
        let true_motor = self.seen[0];
        let is_alone = self.seen.len() == 1;
        for one in &self.sabotage {
            let (at, error) = match *one {
                Sabotage::EncoderFrozen { at } => (at, Error::Scale(0.0)),
                Sabotage::EncoderScaled { at, factor } => (at, Error::Scale(factor)),
                Sabotage::EncoderLate { at, by } => (at, Error::Delay(by)),
                _ => continue,
            };
            if is_alone && self.seen.len() == 1 {
                let r = self.transmission;
                self.seen.push(BodyState { position: r * true_motor.position, velocity: r * true_motor.velocity });
            }
            if let Error::Delay(by) = error {
                self.past.push_back(true_motor);
                while self.past.len() as f64 > 1.0 + by / self.step {
                    self.past.pop_front();
                }
            }
            if now >= at {
                self.seen[0] = match error {
                    Error::Delay(_) => self.past[0],
                    Error::Scale(factor) => {
                        let origin = *self.frozen_at.get_or_insert(true_motor.position);
                        let position = origin + factor * (true_motor.position - origin);
                        BodyState { position, velocity: factor * true_motor.velocity }
                    }
                };
            }
        }
    }
}

impl Mechanics for Sabotaged {
    fn bodies(&self) -> &[BodyState] {
        &self.seen
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let now = self.time();
        if now >= self.at
            && let Some(setup) = self.then.take()
        {
            let initial = self.inner.bodies().to_vec();
            self.inner = self.engine.build(&MechanicsSetup { initial, ..setup })?;
        }
        let mut input = *input;
        if let Actuation::Effort(effort) = &mut input.actuation {
            for one in &self.sabotage {
                match *one {
                    Sabotage::Effort { at, factor } if now >= at => *effort *= factor,
                    Sabotage::EffortLimit { at, most } if now >= at => *effort = effort.clamp(-most, most),
                    _ => (),
                }
            }
        }
        if !self.is_stuck() {
            self.inner.advance(&input)?;
        }
        self.tick += 1;
        self.see();
        Ok(())
    }

    fn end(&mut self) {
        self.inner.end();
    }

    fn take_log(&mut self) -> Vec<LogMessage> {
        self.inner.take_log()
    }

    fn joint_limits(&self) -> &[JointLimit] {
        self.inner.joint_limits()
    }
}
