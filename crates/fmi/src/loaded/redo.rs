//! Discarded steps are undone and repeated in parts.
//!
//! An FMU that discards a step has not computed it to its end. The standard allows only a return to a saved state then (FMI 2.0.5,
//! §4.2.2; FMI 3.0.2, §4.2, state *Step Discarded*). Saving costs as much as some steps, so it is done once in many steps, and the calls
//! since then are repeated after going back. If an FMU cannot go back, the step continues from the time that the FMU reports; without a
//! report the step fails.
use super::instance::{Attempt, Instance, Slot};
use crate::slave::{SlaveError, StepEnd};

/// Greatest number of parts of a step, by ten halvings.
const MOST_PARTS: u32 = 1 << 10;
/// Calls after which the state is saved again.
const MOST_CALLS: usize = 64;

/// Calls and states to repeat discarded steps in parts.
pub(super) struct Redo {
    /// True if the FMU can go back and take steps of another length.
    is_able: bool,
    /// Slot of the state that `calls` have followed.
    kept: Option<Slot>,
    calls: Vec<Call>,
    /// Inputs of all calls, the same number for each.
    past: Vec<[f64; 3]>,
    /// Inputs and outputs of a call.
    inputs: Vec<[f64; 3]>,
    values: Vec<f64>,
    outputs: Vec<f64>,
}

/// A call that has changed the instance.
#[derive(Debug, Clone, Copy)]
enum Call {
    /// A step from `time` by `length` (s).
    Step { time: f64, length: f64 },
    /// A reading with inputs.
    Read,
}

impl Redo {
    /// For an instance with the given numbers of inputs and outputs.
    pub(super) fn new(instance: &dyn Instance, inputs: usize, outputs: usize) -> Self {
        let can = instance.capabilities();
        let is_able = can.saves_state && can.variable_step;
        Self {
            is_able,
            kept: None,
            calls: Vec::with_capacity(MOST_CALLS),
            past: Vec::with_capacity(MOST_CALLS * inputs),
            inputs: vec![[0.0; 3]; inputs],
            values: vec![0.0; inputs],
            outputs: vec![0.0; outputs],
        }
    }

    /// Notes that the present state is saved.
    pub(super) fn is_kept(&mut self, slot: Slot) {
        self.kept = Some(slot);
        self.calls.clear();
        self.past.clear();
    }

    /// Notes that the instance is read with inputs.
    pub(super) fn reads(&mut self, inputs: &[f64]) {
        if self.calls.len() < MOST_CALLS {
            self.calls.push(Call::Read);
            self.past.extend(inputs.iter().map(|value| [*value, 0.0, 0.0]));
        } else {
            self.kept = None;
        }
    }

    /// Goes from `time` to `time + length` (s).
    pub(super) fn step(
        &mut self,
        instance: &mut dyn Instance,
        time: f64,
        length: f64,
        inputs: &[[f64; 3]],
    ) -> Result<StepEnd, SlaveError> {
        if self.is_able {
            return self.step_in_parts(instance, time, length, inputs);
        }
        match instance.attempt(time, length, inputs)? {
            Attempt::Came(progress) => Ok(progress),
            Attempt::Discarded { within: Some(reached), .. } => Ok(StepEnd::Until(reached)),
            Attempt::Discarded { call, within: None } => {
                Err(SlaveError::Discarded { call: call.into(), time, shortest: None })
            }
        }
    }

    /// The same, with a discarded step halved, and so on.
    fn step_in_parts(
        &mut self,
        instance: &mut dyn Instance,
        time: f64,
        length: f64,
        inputs: &[[f64; 3]],
    ) -> Result<StepEnd, SlaveError> {
        // Both in parts of the step.
        let (mut done, mut next) = (0, MOST_PARTS);
        while done < MOST_PARTS {
            let since = length * f64::from(done) / f64::from(MOST_PARTS);
            let (from, part) = (time + since, length * f64::from(next) / f64::from(MOST_PARTS));
            self.inputs.iter_mut().zip(inputs).for_each(|(later, input)| *later = after(*input, since));
            match self.step_or_back(instance, from, part)? {
                Attempt::Came(StepEnd::Done) => {
                    done += next;
                    // The other half of the halved part.
                    next = 1 << done.trailing_zeros();
                }
                Attempt::Came(early) => return Ok(early),
                Attempt::Discarded { within: Some(reached), .. } if next > 1 => {
                    match self.step_or_back(instance, from, reached - from)? {
                        Attempt::Came(StepEnd::Done) => return Ok(StepEnd::Until(reached)),
                        Attempt::Came(early) => return Ok(early),
                        // Its report was wrong.
                        Attempt::Discarded { .. } => next /= 2,
                    }
                }
                Attempt::Discarded { .. } if next > 1 => next /= 2,
                Attempt::Discarded { call, .. } => {
                    return Err(SlaveError::Discarded { call: call.into(), time: from, shortest: Some(part) });
                }
            }
        }
        Ok(StepEnd::Done)
    }

    /// Tries a step with the present inputs; goes back if it is discarded.
    fn step_or_back(&mut self, instance: &mut dyn Instance, time: f64, length: f64) -> Result<Attempt, SlaveError> {
        if self.kept.is_none() || self.calls.len() == MOST_CALLS {
            self.keep(instance)?;
        }
        let attempt = instance.attempt(time, length, &self.inputs)?;
        if matches!(attempt, Attempt::Discarded { .. }) {
            self.go_back(instance)?;
        } else {
            self.calls.push(Call::Step { time, length });
            self.past.extend_from_slice(&self.inputs);
        }
        Ok(attempt)
    }

    fn keep(&mut self, instance: &mut dyn Instance) -> Result<(), SlaveError> {
        instance.save(Slot::Step)?;
        self.is_kept(Slot::Step);
        Ok(())
    }

    /// Restores the saved state and repeats the calls since then.
    fn go_back(&mut self, instance: &mut dyn Instance) -> Result<(), SlaveError> {
        let Some(slot) = self.kept else { return Ok(()) };
        instance.restore(slot)?;
        if self.calls.is_empty() {
            return Ok(());
        }
        let count = self.inputs.len();
        for (at, call) in self.calls.iter().enumerate() {
            let inputs = &self.past[at * count..][..count];
            match *call {
                Call::Step { time, length } => {
                    if let Attempt::Discarded { call, .. } = instance.attempt(time, length, inputs)? {
                        return Err(SlaveError::Discarded { call: call.into(), time, shortest: None });
                    }
                }
                Call::Read => {
                    self.values.iter_mut().zip(inputs).for_each(|(value, input)| *value = input[0]);
                    instance.read(Some(&self.values), &mut self.outputs)?;
                }
            }
        }
        // The next part may be discarded too.
        self.keep(instance)
    }
}

/// An input with its derivatives `since` (s) later.
fn after([value, first, second]: [f64; 3], since: f64) -> [f64; 3] {
    [value + since * (first + since * second / 2.0), first + since * second, second]
}
