//! Operations of the master on blocks: step, read, repeat.
use crate::error::CouplingError;
use crate::fixed_point::{Disagreement, FixedPoint};
use crate::master::{Advance, Master};
use crate::polynomial::{later, value};
use crate::{Block, StepEnd};

/// Fraction of a step that is left out at its end: the rounding of a time in seconds.
const ROUNDING: f64 = 1e-9;
/// Most parts of a step; a block that needs more makes no progress.
const MOST_PARTS: u32 = 1000;

impl<B: Block> Master<B> {
    /// Steps a block, again after each early return.
    pub(crate) fn step(&mut self, block: usize) -> Result<Option<Advance>, CouplingError<B::Error>> {
        let shape = &self.wiring.shapes[block];
        let (now, until) = (self.clock.now, self.clock.now + u64::from(shape.every));
        let inputs = &mut self.inputs[..shape.inputs];
        for (input, wire) in inputs.iter_mut().zip(&self.wiring.wires[shape.first_input..]) {
            *input = self.signals.input(wire, now);
        }
        // The length is computed from ticks and thus the same in each step, unlike a difference of times.
        let whole = self.clock.time(u64::from(shape.every));
        for (number, input) in (shape.first_input..).zip(inputs.iter()) {
            self.estimates.note_end(number, value(input, whole));
        }
        let (start, end) = (self.clock.time(now), self.clock.time(until));
        let (mut time, mut length, mut parts) = (start, whole, 0);
        loop {
            let step = self.blocks[block].step(time, length, inputs);
            let at = match step.map_err(|source| failed(&self.wiring, block, time, source))? {
                StepEnd::Done => break,
                StepEnd::Terminated(time) => return Ok(Some(Advance::Terminated { block, time })),
                StepEnd::Until(at) => at,
            };
            parts += 1;
            if !(at >= time && at <= end + ROUNDING * whole) || parts > MOST_PARTS {
                let block = self.wiring.block_name(block);
                return Err(CouplingError::Astray { block, from: start, to: end, at, parts });
            }
            length = end - at;
            if length <= ROUNDING * whole {
                break;
            }
            for input in inputs.iter_mut() {
                *input = later(input, at - time);
            }
            time = at;
        }
        self.reached[block] = until;
        self.fresh[block] = false;
        self.is_interrupted[block] = parts > 0;
        Ok(None)
    }

    /// Reads a block and stores its outputs at the time for which room has been made.
    pub(crate) fn read(&mut self, block: usize, inputs: Option<usize>) -> Result<(), CouplingError<B::Error>> {
        let shape = &self.wiring.shapes[block];
        let outputs = &mut self.outputs[..shape.outputs];
        let at = self.reached[block];
        let present = inputs.map(|inputs| &self.present[..inputs]);
        self.blocks[block]
            .read(present, outputs)
            .map_err(|source| failed(&self.wiring, block, self.clock.time(at), source))?;
        self.fresh[block] = true;
        self.signals.set(block, outputs).map_err(|output| {
            let value = outputs[output - shape.first_output];
            CouplingError::NotFinite {
                output: self.wiring.output_name(output),
                value,
                time: self.clock.time(at),
                step: at,
            }
        })
    }

    /// Reads a block with its inputs at the exchange `now`.
    pub(crate) fn follow(&mut self, block: usize, now: u64) -> Result<(), CouplingError<B::Error>> {
        self.signals.open(block, now);
        let inputs = self.present_inputs(block, now);
        self.read(block, Some(inputs))
    }

    /// Ends the initialisation of a block with its inputs at the start.
    pub(crate) fn begin(&mut self, block: usize) -> Result<(), CouplingError<B::Error>> {
        let inputs = self.present_inputs(block, 0);
        let started = self.blocks[block].start(&self.present[..inputs]);
        started.map_err(|source| self.failed(block, 0, source))
    }

    /// Stores the inputs of a block at the exchange `now`; returns their number.
    fn present_inputs(&mut self, block: usize, now: u64) -> usize {
        let shape = &self.wiring.shapes[block];
        for (value, wire) in self.present.iter_mut().zip(&self.wiring.wires[shape.first_input..][..shape.inputs]) {
            *value = self.signals.input(wire, now)[0];
        }
        shape.inputs
    }

    /// Announces the outputs of a block before the exchange; those that follow inputs are read with the inputs at the end of its step.
    pub(crate) fn announce(&mut self, block: usize, follows: bool) -> Result<(), CouplingError<B::Error>> {
        let shape = &self.wiring.shapes[block];
        let (inputs, until) = (shape.inputs, self.reached[block]);
        if follows {
            for (value, wire) in self.present.iter_mut().zip(&self.wiring.wires[shape.first_input..][..inputs]) {
                *value = self.signals.at_end(wire, self.clock.now, until);
            }
        }
        self.signals.open(block, until);
        self.read(block, follows.then_some(inputs))
    }

    /// Steps the blocks of a loop repeatedly until the values exchanged at the end of the step agree.
    pub(crate) fn repeat(&mut self, fixed_point: &mut FixedPoint) -> Result<Option<Advance>, CouplingError<B::Error>> {
        let now = self.clock.now;
        if self.reached[fixed_point.blocks[0]] > now {
            return Ok(None);
        }
        for block in &fixed_point.blocks {
            self.blocks[*block].save().map_err(|source| self.failed(*block, now, source))?;
            self.signals.open(*block, now + u64::from(self.wiring.shapes[*block].every));
        }
        fixed_point.begin();
        for evaluation in 1..=fixed_point.iteration.most {
            fixed_point.note(&self.signals);
            for block in &fixed_point.blocks {
                if evaluation > 1 {
                    self.blocks[*block].restore().map_err(|source| self.failed(*block, now, source))?;
                }
                if let Some(ended) = self.step(*block)? {
                    return Ok(Some(ended));
                }
                self.announce(*block, self.follows(*block))
                    .map_err(|e| diverged(e, fixed_point, evaluation, &self.clock))?;
            }
            let Some(disagreement) = fixed_point.disagreement(&self.signals) else {
                return Ok(None);
            };
            if evaluation == fixed_point.iteration.most {
                return Err(self.not_converged(fixed_point, &disagreement, now + 1));
            }
            if fixed_point.correct(&mut self.signals) {
                return Ok(None);
            }
        }
        Ok(None)
    }

    /// Solves outputs that follow each other at the exchange `now`.
    pub(crate) fn solve(&mut self, fixed_point: &mut FixedPoint, now: u64) -> Result<(), CouplingError<B::Error>> {
        if fixed_point.blocks.iter().all(|block| self.reached[*block] != now) {
            return Ok(());
        }
        for block in &fixed_point.blocks {
            if self.reached[*block] == now {
                self.signals.open(*block, now);
            }
        }
        fixed_point.begin();
        for evaluation in 1..=fixed_point.iteration.most {
            fixed_point.note(&self.signals);
            for block in &fixed_point.blocks {
                if self.reached[*block] == now {
                    self.follow(*block, now).map_err(|e| diverged(e, fixed_point, evaluation, &self.clock))?;
                }
            }
            let Some(disagreement) = fixed_point.disagreement(&self.signals) else { break };
            if evaluation == fixed_point.iteration.most {
                return Err(self.not_converged(fixed_point, &disagreement, now));
            }
            if fixed_point.correct(&mut self.signals) {
                break;
            }
        }
        Ok(())
    }

    fn failed(&self, block: usize, step: u64, source: B::Error) -> CouplingError<B::Error> {
        failed(&self.wiring, block, self.clock.time(step), source)
    }

    fn not_converged(&self, of: &FixedPoint, found: &Disagreement, step: u64) -> CouplingError<B::Error> {
        CouplingError::NotConverged {
            cycle: of.cycle.clone(),
            output: self.wiring.output_name(found.output),
            change: found.change,
            allowed: found.allowed,
            iterations: of.iteration.most,
            step,
            time: self.clock.time(step),
            length: self.clock.time(1),
        }
    }
}

fn failed<E>(wiring: &crate::network::Wiring, block: usize, time: f64, source: E) -> CouplingError<E> {
    CouplingError::Block { block: wiring.block_name(block), time, source }
}

/// A number that overflows after the first evaluation is due to the iteration.
fn diverged<E>(
    error: CouplingError<E>,
    of: &FixedPoint,
    evaluation: u32,
    clock: &crate::master::Clock,
) -> CouplingError<E> {
    match error {
        CouplingError::NotFinite { output, value, time, step } if evaluation > 1 => CouplingError::NotConverged {
            cycle: of.cycle.clone(),
            output,
            change: value,
            allowed: of.iteration.absolute,
            iterations: evaluation,
            step,
            time,
            length: clock.time(1),
        },
        other => other,
    }
}
