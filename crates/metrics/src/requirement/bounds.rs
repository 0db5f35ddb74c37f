//! `bounded`: positions stay finite, and within a multiple of the range of the program.
use super::Rules;
use super::rules::{Driven, EarlyEnd};
use crate::extremes::range_of;
use crate::quantity::Quantity;
use servobench_signals::Signal;
use servobench_trace::Recording;

/// Largest excursion of an axis from the range of the program, in multiples of that range.
const TIMES_THE_RANGE: f64 = 10.0;

/// Reasons why the axis is out of bounds.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Vec<String> {
    if let Some(EarlyEnd::Diverged { time, reason }) = &rules.ended {
        return vec![format!("the run diverged at {}: {reason}", Quantity::new(*time, "s"))];
    }
    let unit = recording.about.axis_unit.as_str();
    let range = range(recording, rules);
    let outside = [Signal::MotorPosition, Signal::LoadPosition].into_iter().find_map(|channel| {
        let positions = recording.channel(channel)?;
        let is_outside = |x: f64| !x.is_finite() || range.is_some_and(|range| range.is_left_by(x));
        let row = positions.iter().position(|x| is_outside(*x))?;
        let (x, time) = (Quantity::new(positions[row], unit), Quantity::new(recording.time_of(row), "s"));
        let body = channel.name().trim_end_matches(".position");
        Some(match range {
            Some(range) if positions[row].is_finite() => format!(
                "the {body} is at {x} at {time}: more than {TIMES_THE_RANGE} times the range of the program, {}, outside of it",
                Quantity::new(range.high - range.low, unit)
            ),
            _ => format!("the position of the {body} is not finite at {time}"),
        })
    });
    outside.into_iter().collect()
}

/// Range of the positions of the program.
#[derive(Debug, Clone, Copy)]
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    fn is_left_by(self, x: f64) -> bool {
        let beyond = TIMES_THE_RANGE * (self.high - self.low);
        x < self.low - beyond || x > self.high + beyond
    }
}

/// From the lowest to the highest set-point, including the starting position of the axis; `None` where nothing is to move, and where
/// nothing moves it.
fn range(recording: &Recording, rules: &Rules<'_>) -> Option<Range> {
    if rules.driven == Driven::Not {
        return None;
    }
    let start = [Signal::LoadPosition, Signal::MotorPosition]
        .into_iter()
        .filter_map(|name| recording.channel(name)?.first().copied());
    let all = range_of(recording.channel(Signal::SetpointPosition)?);
    let (low, high) = start.fold(all, |(low, high), x| (low.min(x), high.max(x)));
    let moves = recording.moves.iter().any(|made| made.peaks[0] > 0.0);
    (moves && high > low).then_some(Range { low, high })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::{Build, planned};

    /// A move over 0.2 m, of which the load is at `load(t)`.
    fn recording(load: impl Fn(f64) -> f64) -> Recording {
        Build::new(1000, 1001)
            .channel(Signal::SetpointPosition, "m", |t| 0.2 * t.min(0.5) / 0.5)
            .channel(Signal::LoadPosition, "m", load)
            .moves([planned(0.0, 0.5, 0.0, 0.2).made()])
            .finish()
    }

    #[test]
    fn ten_times_the_range_beyond_either_end_is_too_far() {
        for (x, is_kept) in [(2.19, true), (2.21, false), (-1.99, true), (-2.01, false)] {
            let found = broken(&recording(|t| if t > 0.75 { x } else { 0.0 }), &rules());
            assert_eq!(found.is_empty(), is_kept, "{x}: {found:?}");
        }
        let found = broken(&recording(|t| if t >= 0.75 { 2.7 } else { 0.0 }), &rules());
        assert_eq!(
            found,
            ["the load is at 2.70 m at 750 ms: more than 10 times the range of the program, 200 mm, outside of it"]
        );
    }

    #[test]
    fn what_is_not_finite_is_not_bounded_whatever_the_program() {
        let spoiled = |t: f64| if t > 0.5 { f64::NAN } else { 0.0 };
        assert_eq!(broken(&recording(spoiled), &rules()), ["the position of the load is not finite at 501 ms"]);
        let free = Rules { driven: Driven::Not, ..rules() };
        assert_eq!(broken(&recording(spoiled), &free).len(), 1);
        assert_eq!(broken(&recording(|t| 1e9 * t), &free), [""; 0], "nothing holds it");
    }

    #[test]
    fn a_run_that_diverged_says_when() {
        let ended = Some(EarlyEnd::Diverged { time: 0.031, reason: "a position or velocity is not finite".into() });
        let found = broken(&recording(|_| 0.0), &Rules { ended, ..rules() });
        assert_eq!(found, ["the run diverged at 31.0 ms: a position or velocity is not finite"]);
    }
}
