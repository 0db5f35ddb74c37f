//! Intervals of constant value of a signal, and their visible parts.
use super::window::{Window, is_time};
use crate::drawing::Axis;
use servobench_trace::Signal;

/// Narrower intervals are not visible on their own (pixels).
const NARROW: f64 = 0.5;

/// An interval of one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch<'a> {
    /// Start within the window (s).
    pub(super) from: f64,
    /// End within the window (s).
    pub(super) to: f64,
    pub(super) value: &'a str,
    /// True if the signal visibly changes at its start.
    pub(super) is_change: bool,
}

impl Stretch<'_> {
    /// Its value, if it is a number.
    pub(super) fn number(&self) -> Option<f64> {
        self.value.parse().ok().filter(|number: &f64| number.is_finite())
    }
}

/// The intervals of `signal` in `window`, in order of time.
pub(super) fn stretches<'a>(signal: &'a Signal, window: Window) -> Vec<Stretch<'a>> {
    let changes: Vec<(f64, &'a str)> =
        signal.changes.iter().filter(|(time, _)| is_time(*time)).map(|(time, value)| (*time, value.as_str())).collect();
    let ends = changes.iter().skip(1).map(|(time, _)| *time).chain([f64::INFINITY]);
    let mut stretches: Vec<Stretch<'a>> = Vec::new();
    let mut done = window.from;
    for (&(since, value), until) in changes.iter().zip(ends) {
        if since > window.to || until <= window.from {
            continue;
        }
        // No earlier than the one before: time is monotonic.
        let (from, to) = (since.max(done), until.clamp(since.max(done), window.to.max(done)));
        stretches.push(Stretch { from, to, value, is_change: since >= window.from });
        done = to;
    }
    stretches
}

/// Visible intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Seen<'a> {
    /// One, from pixel to pixel.
    One { from: f64, to: f64, value: &'a str },
    /// `count` intervals, each too narrow to be seen, together from pixel to pixel; with the last value.
    Many { from: f64, to: f64, count: usize, value: &'a str },
}

/// Visible parts of `stretches`: at most two for each half pixel.
pub(super) fn seen<'a>(stretches: &[Stretch<'a>], time: &Axis) -> Vec<Seen<'a>> {
    let mut seen = Vec::new();
    let is_narrow = |stretch: &Stretch<'_>| time.at(stretch.to) - time.at(stretch.from) < NARROW;
    for run in stretches.chunk_by(|one, next| is_narrow(one) && is_narrow(next)) {
        match run {
            [first, .., last] if run.len() > 2 => {
                let (from, to) = (time.at(first.from), time.at(last.to));
                seen.push(Seen::Many { from, to, count: run.len(), value: last.value });
            }
            few => seen.extend(few.iter().map(|Stretch { from, to, value, .. }| Seen::One {
                from: time.at(*from),
                to: time.at(*to),
                value,
            })),
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIME: Axis = Axis { low: 0.0, high: 1.0, from: 100.0, to: 200.0 };

    fn signal(changes: &[(f64, &str)]) -> Signal {
        let changes = changes.iter().map(|(time, value)| (*time, (*value).to_owned())).collect();
        Signal { source: "axis".into(), name: "state".into(), changes }
    }

    #[test]
    fn values_hold_until_the_next_change_within_the_window() {
        let signal = signal(&[(0.0, "a"), (0.1, "b"), (0.5, "c"), (2.0, "d")]);
        let shown = stretches(&signal, Window { from: 0.2, to: 1.0 });
        let expected = [
            Stretch { from: 0.2, to: 0.5, value: "b", is_change: false },
            Stretch { from: 0.5, to: 1.0, value: "c", is_change: true },
        ];
        assert_eq!(shown, expected);
    }

    /// A pulse of one cycle is visible; a thousand of them are one block.
    #[test]
    fn one_pulse_is_drawn_and_a_thousand_are_a_block() {
        let pulse = signal(&[(0.0, "FALSE"), (0.5, "TRUE"), (0.501, "FALSE")]);
        let window = Window { from: 0.0, to: 1.0 };
        assert_eq!(seen(&stretches(&pulse, window), &TIME).len(), 3);
        let changes: Vec<(f64, &str)> = ["FALSE", "TRUE"]
            .into_iter()
            .cycle()
            .take(1000)
            .zip(0..)
            .map(|(value, k)| (f64::from(k) * 1e-3, value))
            .collect();
        let train = signal(&changes);
        let seen = seen(&stretches(&train, window), &TIME);
        assert!(matches!(seen[..], [Seen::Many { count: 1000, value: "TRUE", .. }]), "{seen:?}");
    }

    #[test]
    fn time_does_not_go_back() {
        let wrong = signal(&[(0.5, "a"), (0.2, "b"), (f64::NAN, "c"), (0.7, "d"), (f64::INFINITY, "e")]);
        let shown = stretches(&wrong, Window { from: 0.0, to: 1.0 });
        assert!(shown.windows(2).all(|pair| pair[0].to <= pair[1].from), "{shown:?}");
        assert!(shown.iter().all(|one| one.from <= one.to && one.to <= 1.0), "{shown:?}");
    }
}
