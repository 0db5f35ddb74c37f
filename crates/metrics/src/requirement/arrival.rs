//! `arrives`: the last target of each sequence of moves is reached.
//!
//! Moves that follow each other without a pause are one sequence. When its last one ends at rest, the load (of a motor that
//! follows its set-point exactly: the motor) has to stand at its target: the mean over the last tenth of the time before the
//! next sequence, or the end of the run, is within the window. Ringing about the target is judged by limits.
use super::Rules;
use super::rules::Driven;
use crate::quantity::Quantity;
use crate::span::{Phase, phases};
use servobench_signals::{PerLimit, Signal};
use servobench_trace::{Ending, Recording};

/// The default window is the distance of the move by this.
const PART_OF_MOVE: f64 = 1e-3;
/// It is at least so many increments of the encoder.
const INCREMENTS: f64 = 10.0;
/// Differences of positions say nothing about so small a part of them; it is the window of a move over no distance.
const ROUNDING: f64 = 1e-12;
/// The mean is over the last one of so many parts of the time after the profile.
const REST: usize = 10;
/// A pause is longer than so many periods of the rows.
const PAUSE: f64 = 1.5;

/// Half width of the window in which a move over `distance` has arrived, unless the scenario says it: a thousandth of the
/// distance, and at least ten increments of the encoder that closes the position loop (all in the axis unit).
#[must_use]
pub fn arrival_window(distance: f64, increment: f64) -> f64 {
    (PART_OF_MOVE * distance.abs()).max(INCREMENTS * increment)
}

/// Why targets are not reached; `None` where no move ends at a target.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Option<Vec<String>> {
    let (channel, body) = match rules.driven {
        Driven::ByLoops => (Signal::LoadPosition, "load"),
        Driven::Exactly => (Signal::MotorPosition, "motor"),
        Driven::Not => return None,
    };
    let phases = phases(recording);
    let period = recording.rate.period();
    let ends_a_sequence = |k: usize| {
        let next = recording.moves.get(k + 1);
        next.is_none_or(|next| next.start > recording.moves[k].end + PAUSE * period)
    };
    let arriving =
        phases.iter().enumerate().filter(|(k, phase)| phase.made.ending == Ending::AtRest && ends_a_sequence(*k));
    let positions = recording.channel(channel);
    let mut asked = false;
    let mut reasons = Vec::new();
    for (_, phase) in arriving {
        asked = true;
        let reason = match positions {
            Some(positions) => miss(recording, positions, phase, rules, body),
            None => Some(format!("`{channel}` is not recorded: nobody can tell whether the {body} arrived")),
        };
        reasons.extend(reason);
    }
    asked.then_some(reasons)
}

/// How a target was missed.
fn miss(recording: &Recording, positions: &[f64], phase: &Phase<'_>, rules: &Rules<'_>, body: &str) -> Option<String> {
    let made = phase.made;
    let unit = recording.about.axis_unit.as_str();
    let quantity = |value: f64| Quantity::new(value, unit);
    let last = recording.time_of(recording.len().saturating_sub(1));
    if made.end > last + recording.rate.period() / 2.0 {
        let (end, last) = (Quantity::new(made.end, "s"), Quantity::new(last, "s"));
        return Some(format!("the run ends at {last}, before `{}` does at {end}", made.label));
    }
    // The move may end between the last two rows.
    let rows = if phase.after.is_empty() {
        phase.after.start.saturating_sub(1)..phase.after.start
    } else {
        phase.after.clone()
    };
    let count = rows.len().div_ceil(REST);
    let rest = positions.get(rows.end.saturating_sub(count)..rows.end).unwrap_or_default();
    if rest.is_empty() {
        return Some(format!("nothing was recorded after `{}`", made.label));
    }
    let error = rest.iter().map(|x| nearest(made.to - x, rules.modulo)).sum::<f64>() / rest.len() as f64;
    let distance = made.to - made.from;
    let rounding = ROUNDING * made.from.abs().max(made.to.abs());
    let window = rules.window.unwrap_or_else(|| arrival_window(distance, rules.increment).max(rounding));
    if error.abs() <= window {
        return None;
    }
    let side = if error * distance >= 0.0 { "short of" } else { "beyond" };
    let bound = bound_time(recording, made.start, recording.time_of(rows.end - 1));
    Some(format!(
        "the {body} ended {} {side} {} (window ±{}){bound}",
        quantity(error.abs()),
        quantity(made.to),
        quantity(window)
    ))
}

/// `error`, on a modulo axis the shorter way round.
fn nearest(error: f64, modulo: Option<f64>) -> f64 {
    modulo.map_or(error, |modulo| error - modulo * (error / modulo).round())
}

/// Which limit of the drive bound for the longest time from `start` to `end` (s), as the end of a sentence.
fn bound_time(recording: &Recording, start: f64, end: f64) -> String {
    let PerLimit { voltage, current, effort } = PerLimit::NAMES;
    let limits = [effort, current, voltage];
    let bound = limits.map(|limit| {
        let binding =
            recording.events.iter().filter(|event| event.limit.as_ref().is_some_and(|bound| bound.name == limit));
        let time: f64 = binding.map(|event| (event.end.min(end) - event.start.max(start)).max(0.0)).sum();
        (limit, time)
    });
    let longest = bound.into_iter().reduce(|one, two| if two.1 > one.1 { two } else { one });
    match longest {
        Some((limit, time)) if time > 0.0 => format!("; {limit} bound for {}", Quantity::new(time, "s")),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::synthetic::{Build, planned};
    use servobench_trace::{Event, Move};

    /// One move from 0 to 0.2 m in 0.5 s, of 1 s recorded at 1 kHz; the load is at `load(t)`.
    fn one_move(load: impl Fn(f64) -> f64) -> Recording {
        Build::new(1000, 1001)
            .channel(Signal::LoadPosition, "m", load)
            .channel(Signal::MotorPosition, "m", |_| 0.2)
            .moves([planned(0.0, 0.5, 0.0, 0.2).made()])
            .finish()
    }

    #[test]
    fn a_load_that_stops_short_says_by_how_much_and_what_held_it() {
        let mut recording = one_move(|_| 0.15);
        for (start, end) in [(0.1, 0.3), (0.9, 5.0)] {
            recording.events.push(Event::bound(start, end, "velocity loop", "effort limit", false));
        }
        let rules = rules();
        let broken = broken(&recording, &rules).unwrap();
        assert_eq!(broken, ["the load ended 50.0 mm short of 200 mm (window ±200 µm); effort limit bound for 300 ms"]);
    }

    /// From 0.2 m to 0.2 m: a thousandth of nothing would be no window.
    #[test]
    fn a_move_over_no_distance_arrives_but_for_rounding() {
        for (off, arrives) in [(0.0, true), (1e-15, true), (1e-12, false)] {
            let mut recording = one_move(|_| 0.2 + off);
            recording.moves = vec![planned(0.0, 0.0, 0.2, 0.2).made()];
            let found = broken(&recording, &rules()).unwrap();
            assert_eq!(found.is_empty(), arrives, "{off}: {found:?}");
        }
    }

    /// The window is met inclusively, and a rounding beyond it is a miss.
    #[test]
    fn the_window_is_inclusive() {
        let window = Some(5e-6);
        for (beyond, arrives) in [(0.0, true), (4.9e-6, true), (-4.9e-6, true), (5.1e-6, false), (-5.1e-6, false)] {
            let recording = one_move(|t| if t < 0.9 { 0.0 } else { 0.2 + beyond });
            let found = broken(&recording, &Rules { window, ..rules() }).unwrap();
            assert_eq!(found.is_empty(), arrives, "{beyond}: {found:?}");
        }
        let recording = one_move(|_| 0.3);
        let found = broken(&recording, &Rules { window, ..rules() }).unwrap();
        assert_eq!(found, ["the load ended 100 mm beyond 200 mm (window ±5.00 µm)"]);
        let nan = one_move(|_| f64::NAN);
        assert_eq!(broken(&nan, &rules()).unwrap().len(), 1, "what is no number has not arrived");
    }

    /// Without a window it is a thousandth of the distance, or ten increments of the encoder if that is more.
    #[test]
    fn the_default_window_follows_from_move_and_encoder() {
        for (beyond, increment, arrives) in
            [(1.9e-4, 0.0, true), (2.1e-4, 0.0, false), (2.1e-4, 3e-5, true), (3.1e-4, 3e-5, false)]
        {
            let recording = one_move(|_| 0.2 + beyond);
            let found = broken(&recording, &Rules { increment, ..rules() }).unwrap();
            assert_eq!(found.is_empty(), arrives, "{beyond} {increment}: {found:?}");
        }
    }

    #[test]
    fn a_ringing_load_has_arrived_where_its_mean_has() {
        // Forty periods in the last tenth.
        let recording = one_move(|t| 0.2 + 1e-3 * (2.0 * core::f64::consts::PI * 400.0 * t).sin());
        assert_eq!(broken(&recording, &rules()).unwrap(), [""; 0]);
    }

    #[test]
    fn a_run_that_ends_before_its_move_does_not_arrive() {
        let recording = Build::new(1000, 401)
            .channel(Signal::LoadPosition, "m", |_| 0.2)
            .moves([planned(0.0, 0.5, 0.0, 0.2).made()])
            .finish();
        let found = broken(&recording, &rules()).unwrap();
        assert_eq!(found, ["the run ends at 400 ms, before `move to 0.2 m` does at 500 ms"]);
        // Its end may lie on the last row.
        let recording = Build::new(1000, 501)
            .channel(Signal::LoadPosition, "m", |_| 0.2)
            .moves([planned(0.0, 0.5, 0.0, 0.2).made()])
            .finish();
        assert_eq!(broken(&recording, &rules()).unwrap(), [""; 0]);
    }

    /// Of moves in a sequence only the last one counts; of those that are aborted or pass their target none does.
    #[test]
    fn what_is_not_to_come_to_rest_is_not_asked() {
        let recording = |ending, gap: f64| {
            let first = Move { ending, ..planned(0.0, 0.3, 0.0, 0.9).made() };
            Build::new(1000, 1001)
                .channel(Signal::LoadPosition, "m", |_| 0.2)
                .moves([first, planned(0.3 + gap, 0.6, 0.9, 0.2).made()])
                .finish()
        };
        for (ending, gap, misses) in
            [(Ending::AtRest, 0.0, 0), (Ending::AtRest, 0.1, 1), (Ending::Aborted, 0.0, 0), (Ending::InMotion, 0.1, 0)]
        {
            let found = broken(&recording(ending, gap), &rules()).unwrap();
            assert_eq!(found.len(), misses, "{ending:?}, {gap}: {found:?}");
        }
        let mut endless = recording(Ending::AtRest, 0.0);
        endless.moves.iter_mut().for_each(|made| made.ending = Ending::InMotion);
        assert_eq!(broken(&endless, &rules()), None);
        assert_eq!(broken(&recording(Ending::AtRest, 0.1), &Rules { driven: Driven::Not, ..rules() }), None);
    }

    #[test]
    fn a_prescribed_motor_is_judged_on_its_own_side() {
        let recording = one_move(|_| 0.1);
        assert_eq!(broken(&recording, &Rules { driven: Driven::Exactly, ..rules() }).unwrap(), [""; 0]);
    }

    #[test]
    fn a_modulo_axis_may_stand_a_turn_away() {
        let recording = one_move(|_| 0.2 + 3.0 * 0.7);
        assert_eq!(broken(&recording, &Rules { modulo: Some(0.7), ..rules() }).unwrap(), [""; 0]);
        assert_eq!(broken(&recording, &Rules { modulo: Some(0.69), ..rules() }).unwrap().len(), 1);
    }

    #[test]
    fn what_is_not_recorded_does_not_pass() {
        let recording = Build::new(1000, 1001)
            .channel(Signal::MotorPosition, "m", |_| 0.2)
            .moves([planned(0.0, 0.5, 0.0, 0.2).made()]);
        assert_eq!(broken(&recording.finish(), &rules()).unwrap().len(), 1);
    }
}
