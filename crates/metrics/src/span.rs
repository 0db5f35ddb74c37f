//! Rows of a recording that a metric covers.
use crate::absence::Absence;
use crate::extremes::most_of;
use servobench_base::Tick;
use servobench_signals::Signal;
use servobench_trace::{Move, Recording};
use std::cell::OnceCell;
use std::ops::{Deref, Range};

/// A move and its rows.
#[derive(Debug, Clone)]
pub(crate) struct Phase<'a> {
    /// The move.
    pub(crate) made: &'a Move,
    /// Rows from the start of the profile to just before its end.
    pub(crate) profile: Range<usize>,
    /// Rows from the end of the profile to just before the next move, or to the end of the recording.
    pub(crate) after: Range<usize>,
    /// Its rows until another motion is requested that is not a move: a velocity, a stop, a search for a switch.
    pub(crate) rest: Range<usize>,
}

impl Phase<'_> {
    /// All rows of the move: profile and the time after it.
    pub(crate) fn rows(&self) -> Range<usize> {
        self.profile.start..self.after.end
    }

    /// Rows of the profile and of the rest after it.
    pub(crate) fn until_rest_ends(&self) -> Range<usize> {
        self.profile.start..self.rest.end
    }
}

/// The part of `after` without a requested motion, once the request has come to rest.
fn rest_of(recording: &Recording, after: &Range<usize>) -> Range<usize> {
    let requested = recording.channel(Signal::RequestVelocity).and_then(|values| values.get(after.clone()));
    let Some(requested) = requested else { return after.clone() };
    // The path of a set-point may end some rows after its profile.
    let moves = |velocity: &f64| *velocity != 0.0;
    let Some(rests) = requested.iter().position(|velocity| !moves(velocity)) else { return after.clone() };
    let moves_again = requested[rests..].iter().position(moves).map(|row| after.start + rests + row);
    after.start..moves_again.unwrap_or(after.end)
}

/// The moves of a recording with their rows.
pub(crate) fn phases(recording: &Recording) -> Vec<Phase<'_>> {
    let moves = recording.moves.iter().enumerate();
    moves
        .map(|(k, made)| {
            let next = recording.moves.get(k + 1);
            let start = recording.index_at(made.start);
            let end = recording.index_at(made.end).max(start);
            let stop = next.map_or(recording.len(), |next| recording.index_at(next.start)).max(end);
            let after = end..stop;
            let rest = rest_of(recording, &after);
            Phase { made, profile: start..end, after, rest }
        })
        .collect()
}

/// A recording whose channels are each searched once for values that are not finite: a program may have as many moves as rows.
#[derive(Debug)]
pub(crate) struct Checked<'a> {
    recording: &'a Recording,
    /// First row of each channel that is not finite, once known.
    gaps: Vec<OnceCell<Option<usize>>>,
}

impl<'a> Checked<'a> {
    pub(crate) fn of(recording: &'a Recording) -> Self {
        Self { recording, gaps: vec![OnceCell::new(); recording.channels.len()] }
    }
}

impl Deref for Checked<'_> {
    type Target = Recording;

    fn deref(&self) -> &Recording {
        self.recording
    }
}

/// Values of a channel, searched only once.
///
/// # Errors
/// [`Absence::NoChannel`], [`Absence::NotFinite`].
pub(crate) fn channel<'a>(checked: &'a Checked<'_>, signal: Signal) -> Result<&'a [f64], Absence> {
    #[cfg(test)]
    assert!(crate::MEASURED_FROM.contains(&signal), "`{signal}` is missing in `MEASURED_FROM`");
    let recording = checked.recording;
    let named = recording.channels.iter().zip(&checked.gaps).find(|(channel, _)| channel.spec.name == signal.name());
    let (channel, gap) = named.ok_or(Absence::NoChannel { channel: signal })?;
    recording.release();
    let values = &*channel.values;
    match *gap.get_or_init(|| first_gap(values)) {
        None => Ok(values),
        Some(row) => Err(Absence::NotFinite { channel: signal, time: recording.rate.time(Tick(row as u64)) }),
    }
}

/// The first row that is not finite. Most often there is none, which is checked for many values at once.
fn first_gap(values: &[f64]) -> Option<usize> {
    const MANY: usize = 64;
    let has_gap = |values: &[f64]| values.iter().fold(false, |has_gap, value| has_gap | !value.is_finite());
    let from = values.chunks(MANY).position(has_gap)? * MANY;
    values[from..].iter().position(|value| !value.is_finite()).map(|at| from + at)
}

/// Unit of a channel; empty when the recording lacks it.
pub(crate) fn unit(recording: &Recording, signal: Signal) -> &str {
    recording.find(signal).map_or("", |channel| channel.spec.unit.as_str())
}

/// Largest magnitude of `values`.
///
/// # Errors
/// [`Absence::NothingRecorded`] when there are none.
pub(crate) fn largest_magnitude(values: &[f64], part: &'static str) -> Result<f64, Absence> {
    if values.is_empty() { Err(Absence::NothingRecorded { part }) } else { Ok(most_of([values], |[x]| x.abs())) }
}

/// Largest of `values`.
///
/// # Errors
/// [`Absence::NothingRecorded`] when there are none.
pub(crate) fn largest(values: impl Iterator<Item = f64>, part: &'static str) -> Result<f64, Absence> {
    values.reduce(f64::max).ok_or(Absence::NothingRecorded { part })
}

/// Square root of the mean of `squares`.
///
/// # Errors
/// [`Absence::NothingRecorded`] when there are none.
pub(crate) fn root_mean(squares: impl Iterator<Item = f64>, part: &'static str) -> Result<f64, Absence> {
    let (sum, count) = squares.fold((0.0, 0_u64), |(sum, count), square| (sum + square, count + 1));
    if count == 0 { Err(Absence::NothingRecorded { part }) } else { Ok((sum / count as f64).sqrt()) }
}

#[cfg(test)]
mod tests {
    use super::first_gap;

    #[test]
    fn the_first_value_that_is_not_finite_is_found_wherever_it_is() {
        for length in [0, 1, 63, 64, 65, 200] {
            let values = vec![1.0; length];
            assert_eq!(first_gap(&values), None);
            for at in 0..length {
                for gap in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut values = values.clone();
                    values[at] = gap;
                    values[length - 1] = f64::NAN;
                    assert_eq!(first_gap(&values), Some(at));
                }
            }
        }
    }
}
