//! The state of an instance as bytes: its size and the time to write it do not depend on the length of the run.
//!
//! ```text
//! token of the FMU | count of all words | phase, start, stop | count, values | with a loop: its state | checksum
//! ```
//! Words of eight bytes, little endian; `stop` is NaN without one. The checksum is xxHash64 of the bytes before it.
use crate::error::Refusal;
use crate::instance::{Experiment, Phase, State};
use crate::machine::Model;
use servobench_base::state::Reader;
use std::cmp::Ordering;
use twox_hash::XxHash64;

const PHASES: [Phase; 5] = [Phase::Instantiated, Phase::Initialization, Phase::Step, Phase::Terminated, Phase::Failed];

/// Words of a token.
const TOKEN: usize = 5;

/// The bytes of `state`, of the FMU with this token.
pub(crate) fn write(state: &State, token: &str) -> Vec<u8> {
    let State { phase, experiment, values, machine } = state;
    let place = PHASES.iter().position(|one| one == phase).map_or(u64::MAX, |place| place as u64);
    let numbers = [experiment.start, experiment.stop.unwrap_or(f64::NAN)];
    let head = [place].into_iter().chain(numbers.map(f64::to_bits));
    let values = [values.len() as u64].into_iter().chain(values.iter().map(|value| value.to_bits()));
    let run = [u64::from(machine.is_some())].into_iter().chain(machine.iter().flatten().copied());
    let body: Vec<u64> = head.chain(values).chain(run).collect();
    let count = TOKEN + 1 + body.len() + 1;
    let all = token_words(token).into_iter().chain([count as u64]).chain(body);
    let mut bytes: Vec<u8> = all.flat_map(u64::to_le_bytes).collect();
    bytes.extend(XxHash64::oneshot(0, &bytes).to_le_bytes());
    bytes
}

/// The state in `bytes`, of `model` with this token.
///
/// # Errors
/// [`Refusal::State`] for bytes that are damaged, or not a state of this FMU.
pub(crate) fn read(bytes: &[u8], model: &Model, token: &str) -> Result<State, Refusal> {
    let wrong = |why| Refusal::State { why };
    let too_early = |_| wrong("they end too early");
    let (whole, rest) = bytes.as_chunks();
    let words: Vec<u64> = whole.iter().map(|word| u64::from_le_bytes(*word)).collect();
    let mut from = Reader::new(&words);
    for expected in token_words(token) {
        if from.word().map_err(too_early)? != expected {
            return Err(wrong("they are of another FMU, or of another version of it"));
        }
    }
    match from.word().map_err(too_early)?.cmp(&(words.len() as u64)) {
        Ordering::Greater => return Err(wrong("they end too early")),
        Ordering::Equal if rest.is_empty() => {}
        Ordering::Less | Ordering::Equal => return Err(wrong("they go on after its end")),
    }
    let checked = &bytes[..bytes.len() - 8];
    if words.last() != Some(&XxHash64::oneshot(0, checked)) {
        return Err(wrong("they are damaged: their checksum is another"));
    }
    let mut word = || from.word().map_err(too_early);
    let phase = usize::try_from(word()?).ok().and_then(|place| PHASES.get(place).copied());
    let phase = phase.ok_or(wrong("the phase is unknown"))?;
    let (start, stop) = (f64::from_bits(word()?), f64::from_bits(word()?));
    let experiment = Experiment { start, stop: (!stop.is_nan()).then_some(stop) };
    let mut values = model.start();
    if word()? != values.len() as u64 {
        return Err(wrong("the number of values is another"));
    }
    for value in &mut values {
        *value = f64::from_bits(word()?);
    }
    let has_machine = word()? != 0;
    let read = TOKEN + 1 + 3 + 1 + values.len() + 1;
    let rest = words.get(read..words.len() - 1).ok_or(wrong("they end too early"))?;
    let machine = has_machine.then(|| rest.to_vec());
    Ok(State { phase, experiment, values, machine })
}

/// The token as words, padded with zeros.
fn token_words(token: &str) -> [u64; TOKEN] {
    let mut bytes = [0; 8 * TOKEN];
    bytes.iter_mut().zip(token.bytes()).for_each(|(to, from)| *to = from);
    let mut words = [0; TOKEN];
    for (word, eight) in words.iter_mut().zip(bytes.chunks(8)) {
        *word = eight.try_into().map_or(0, u64::from_le_bytes);
    }
    words
}
