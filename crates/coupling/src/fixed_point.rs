//! A loop whose signals must agree: start and result of its evaluations.
//!
//! The blocks of a loop are evaluated one after the other. Only the signals that an earlier block (or the block
//! itself) takes from a later one are unknown; all others follow from these during an evaluation.
use crate::Block;
use crate::acceleration::Accelerator;
use crate::network::Wiring;
use crate::settings::Iteration;
use crate::signals::Signals;

/// Relative error of an evaluation in single precision: eight of its roundings.
const SINGLE: f64 = 1.0 / (1_u32 << 20) as f64;

/// A loop of blocks.
pub(crate) struct FixedPoint {
    /// The blocks in the order of their evaluation.
    pub(crate) blocks: Vec<usize>,
    /// Its blocks or outputs, for messages.
    pub(crate) cycle: String,
    pub(crate) iteration: Iteration,
    unknowns: Vec<Unknown>,
    /// Unknowns that change only at events: they are taken as they come, and agree when they are equal.
    discrete: Vec<Unknown>,
    accelerator: Accelerator,
    x: Vec<f64>,
    r: Vec<f64>,
    weights: Vec<f64>,
    /// Values of the discrete unknowns at the start of the evaluation.
    before: Vec<f64>,
    /// Fraction of the greatest value of a signal, where the loop agreed, that counts as rounding; 0 for double precision.
    rounding: f64,
    greatest: Vec<f64>,
    /// Start of the last evaluation; true if the discrete unknowns agreed in it.
    from: Vec<f64>,
    discrete_agree: bool,
}

#[derive(Clone, Copy)]
struct Unknown {
    block: usize,
    output: usize,
}

/// Change of an output that should have stayed the same.
pub(crate) struct Disagreement {
    pub(crate) output: usize,
    pub(crate) change: f64,
    pub(crate) allowed: f64,
}

impl FixedPoint {
    /// A loop of `blocks`, some of `all`, with the outputs `unknowns` to be solved for.
    pub(crate) fn new<B: Block>(
        wiring: &Wiring,
        (all, blocks): (&[B], Vec<usize>),
        unknowns: &[usize],
        iteration: Iteration,
        cycle: String,
    ) -> Self {
        let unknowns = unknowns.iter().map(|output| Unknown { block: wiring.block_of(*output), output: *output });
        let (discrete, unknowns): (Vec<_>, Vec<_>) = unknowns.partition(|unknown| wiring.discrete[unknown.output]);
        let zeros = vec![0.0; unknowns.len()];
        let is_single = blocks.iter().any(|block| all[*block].is_single_precision());
        Self {
            rounding: if is_single { SINGLE } else { 0.0 },
            greatest: zeros.clone(),
            from: zeros.clone(),
            discrete_agree: true,
            blocks,
            cycle,
            iteration,
            accelerator: Accelerator::new(iteration.acceleration, unknowns.len()),
            unknowns,
            before: vec![0.0; discrete.len()],
            discrete,
            x: zeros.clone(),
            r: zeros.clone(),
            weights: zeros,
        }
    }

    /// Starts the search for another fixed point.
    pub(crate) fn begin(&mut self) {
        self.accelerator.begin();
    }

    /// Notes the start of the next evaluation.
    pub(crate) fn note(&mut self, signals: &Signals) {
        for (x, unknown) in self.x.iter_mut().zip(&self.unknowns) {
            *x = signals.newest(unknown.output);
        }
        for (before, unknown) in self.before.iter_mut().zip(&self.discrete) {
            *before = signals.newest(unknown.output);
        }
    }

    /// The largest deviation of the result of the evaluation from its start, relative to the tolerance; `None` if it agrees.
    pub(crate) fn disagreement(&mut self, signals: &Signals) -> Option<Disagreement> {
        let changed = |(unknown, before): (&Unknown, &f64)| {
            let change = signals.newest(unknown.output) - before;
            (change != 0.0).then_some(Disagreement { output: unknown.output, change, allowed: 0.0 })
        };
        let mut worst = self.discrete.iter().zip(&self.before).find_map(changed);
        self.discrete_agree = worst.is_none();
        let mut most = 1.0;
        for (signal, unknown) in self.unknowns.iter().enumerate() {
            let magnitude = self.x[signal].abs().max(signals.magnitude(unknown.block, unknown.output));
            let allowed = self.iteration.absolute
                + (self.iteration.relative * magnitude).max(self.rounding * magnitude.max(self.greatest[signal]));
            let change = signals.newest(unknown.output) - self.x[signal];
            self.r[signal] = change;
            self.weights[signal] = 1.0 / allowed;
            if change.abs() > most * allowed {
                most = change.abs() / allowed;
                worst = Some(Disagreement { output: unknown.output, change, allowed });
            }
        }
        if worst.is_none() {
            self.note_greatest();
        }
        worst
    }

    fn note_greatest(&mut self) {
        for (greatest, x) in self.greatest.iter_mut().zip(&self.x) {
            *greatest = greatest.max(x.abs());
        }
    }

    /// Sets the signals to the start of the next evaluation. True if that equals the start of the last one, to the rounding of
    /// single precision: signals that a loop amplifies never agree better.
    pub(crate) fn correct(&mut self, signals: &mut Signals) -> bool {
        self.from.copy_from_slice(&self.x);
        self.accelerator.advance(&mut self.x, &self.r, &self.weights);
        for (x, unknown) in self.x.iter().zip(&self.unknowns) {
            signals.replace(unknown.output, *x);
        }
        let stays =
            |((x, from), greatest): ((&f64, &f64), &f64)| (x - from).abs() <= self.rounding * x.abs().max(*greatest);
        let agrees =
            self.rounding > 0.0 && self.discrete_agree && self.x.iter().zip(&self.from).zip(&self.greatest).all(stays);
        if agrees {
            self.note_greatest();
        }
        agrees
    }
}
