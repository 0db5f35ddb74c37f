//! A state of an instance as bytes: parameters, inputs and what the inputs were since tick 0. What it means is simulated again,
//! which by determinism gives the same state bit for bit.
//!
//! ```text
//! token of the FMU | phase, start, stop | values | with a run: tick, count of changes, changes (tick, input, value)
//! ```
//! Little endian; `stop` is NaN without one.
use crate::error::Refusal;
use crate::history::{Change, History};
use crate::instance::{Experiment, Phase, SavedRun, State};
use crate::interface::INPUTS;
use crate::machine::{Machine, Model};

const PHASES: [Phase; 5] = [Phase::Instantiated, Phase::Initialization, Phase::Step, Phase::Terminated, Phase::Failed];

/// The bytes of `state`, of the FMU with this token.
pub(crate) fn write(state: &State, token: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut word = |word: u64| bytes.extend_from_slice(&word.to_le_bytes());
    for word8 in token_words(token) {
        word(word8);
    }
    word(PHASES.iter().position(|phase| *phase == state.phase).map_or(u64::MAX, |at| at as u64));
    word(state.experiment.start.to_bits());
    word(state.experiment.stop.unwrap_or(f64::NAN).to_bits());
    word(state.values.len() as u64);
    state.values.iter().for_each(|value| word(value.to_bits()));
    word(u64::from(state.run.is_some()));
    if let Some(run) = &state.run {
        let changes = run.past.changes();
        word(run.tick);
        word(changes.len() as u64);
        for Change { tick, input, value } in changes {
            word(tick);
            word(input.into());
            word(value.to_bits());
        }
    }
    bytes
}

/// The state that `bytes` are, of `model` with this token; simulates up to it.
///
/// # Errors
/// [`Refusal::State`] for bytes that are none; what the loop says when it cannot be simulated again.
pub(crate) fn read(bytes: &[u8], model: &Model, token: &str) -> Result<State, Refusal> {
    let wrong = |why| Refusal::State { why };
    let mut words = bytes.chunks(8).map(|word| word.try_into().map(u64::from_le_bytes));
    let mut word = || match words.next() {
        Some(Ok(word)) => Ok(word),
        _ => Err(wrong("they end too early")),
    };
    for expected in token_words(token) {
        if word()? != expected {
            return Err(wrong("they are of another FMU, or of another version of it"));
        }
    }
    let phase =
        usize::try_from(word()?).ok().and_then(|at| PHASES.get(at).copied()).ok_or(wrong("the phase is unknown"))?;
    let (start, stop) = (f64::from_bits(word()?), f64::from_bits(word()?));
    let experiment = Experiment { start, stop: (!stop.is_nan()).then_some(stop) };
    let mut values = model.start();
    if word()? != values.len() as u64 {
        return Err(wrong("the number of values is another"));
    }
    for value in &mut values {
        *value = f64::from_bits(word()?);
    }
    let run = match word()? {
        0 => None,
        1 => {
            let (tick, count) = (word()?, word()?);
            let mut changes = Vec::new();
            for _ in 0..count {
                let (tick, input, value) = (word()?, word()?, f64::from_bits(word()?));
                let input = u8::try_from(input).ok().filter(|input| usize::from(*input) < INPUTS);
                let input = input.ok_or(wrong("there is no such input"))?;
                changes.push(Change { tick, input, value });
            }
            Some(simulate(model, &values, tick, &changes)?)
        }
        _ => return Err(wrong("it has neither a run nor none")),
    };
    if word().is_ok() {
        return Err(wrong("they go on after its end"));
    }
    Ok(State { phase, experiment, values, run })
}

/// The run with these inputs up to `end`.
fn simulate(model: &Model, values: &[f64], end: u64, changes: &[Change]) -> Result<SavedRun, Refusal> {
    let mut machine = Machine::new(model, values)?;
    let (mut history, mut inputs) = (History::default(), [0.0; INPUTS]);
    let mut changes = changes.iter().peekable();
    for tick in 0..end {
        while let Some(change) = changes.next_if(|change| change.tick <= tick) {
            inputs[usize::from(change.input)] = change.value;
        }
        history.note(tick, &inputs);
        machine.step(&inputs)?;
    }
    let failed = || Refusal::Failed("the loop cannot be copied".into());
    Ok(SavedRun { machine: machine.save().ok_or_else(failed)?, tick: end, past: history.past() })
}

/// The token as five words, zeros behind it.
fn token_words(token: &str) -> [u64; 5] {
    let mut bytes = [0; 40];
    bytes.iter_mut().zip(token.bytes()).for_each(|(to, from)| *to = from);
    let mut words = [0; 5];
    for (word, eight) in words.iter_mut().zip(bytes.chunks(8)) {
        *word = eight.try_into().map_or(0, u64::from_le_bytes);
    }
    words
}
