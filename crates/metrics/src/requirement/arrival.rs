//! `arrives`: the load rests at each target.
//!
//! In each rest that is long enough for the loop to come to rest, and in that in which the run ends, the mean of the load is at the
//! target, over whole cycles where it swings ([`Task`](super::task::Task)). Ringing about the target is judged by limits and by
//! `rings`.
use super::home_place;
use super::rules::Driven;
use super::task::{Piece, ROUNDING, Task};
use crate::quantity::Quantity;
use servobench_trace::{Ending, Recording};

/// The default window is the distance of the move by this.
const PART_OF_WAY: f64 = 1e-3;
/// Least default window, in increments of the encoder or units of the bus.
pub(super) const RESOLUTIONS: f64 = 10.0;
/// Least remaining window in the same resolutions, where the window is larger than the tolerance.
const LEAST_RESOLUTIONS: f64 = 2.0;
/// Largest share of the distance by which deflection, or too little time for the loop, explains an error.
const OF_WAY: f64 = 0.1;

/// Default half width of the window in which a load has arrived after a move over `distance`: a thousandth of the
/// distance, and at least ten times the `resolution`: an increment of the encoder that closes the position loop, or a unit of the bus
/// (all in the axis unit).
#[must_use]
pub fn arrival_window(distance: f64, resolution: f64) -> f64 {
    (PART_OF_WAY * distance.abs()).max(RESOLUTIONS * resolution)
}

/// Reasons why targets are not reached; `None` without a target.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    if task.rules.driven == Driven::Not {
        return None;
    }
    let unfinished: Vec<String> = unfinished(task.recording).into_iter().chain(home_place::misplaced(task)).collect();
    let mut rests = task.pieces.iter().filter(|(piece, _)| matches!(piece, Piece::Rest { .. })).peekable();
    if rests.peek().is_none() && unfinished.is_empty() && task.rules.home_at.is_none() {
        return None;
    }
    Some(
        unfinished
            .into_iter()
            .chain(rests.filter_map(|(piece, rest)| {
                let Piece::Rest { way, is_short } = *piece else { return None };
                if task.is_excused(&rest.rows) {
                    return None;
                }
                let last = rest.rows.end - 1;
                let target = task.rows.as_ref()?.request[last];
                let deflection = &task.rules.deflection;
                let gives_way = deflection.droop(task.disturbance)
                    + deflection.elastic
                    + deflection.elastic_per_effort * task.on_load;
                let of_loop = rest.response_off.abs();
                let of_loop = if is_short { of_loop.min(OF_WAY * way) } else { of_loop };
                let least = (LEAST_RESOLUTIONS * task.rules.resolution()).max(ROUNDING * target.abs());
                let bound = task.window(way).min(task.rules.tolerances.arrives * way).max(least)
                    + of_loop
                    + gives_way.min(OF_WAY * way);
                let off = rest.load_off;
                (off.is_nan() || off.abs() > bound).then(|| {
                    let row = rest.rows.start;
                    format!(
                        "the load rests {} from {} at {}{} (window ±{}){}",
                        task.length(off.abs()),
                        task.length(target),
                        task.time(last),
                        task.within(row),
                        task.length(bound),
                        task.bound_by(&(task.begun(row)..rest.rows.end))
                    )
                })
            }))
            .collect(),
    )
}

/// A move whose end the run does not reach.
fn unfinished(recording: &Recording) -> Option<String> {
    let last = recording.time_of(recording.len().saturating_sub(1));
    let mut to_targets = recording.moves.iter().filter(|made| made.ending == Ending::AtRest);
    let cut = to_targets.find(|made| made.end > last + recording.rate.period() / 2.0)?;
    let (end, last) = (Quantity::new(cut.end, "s"), Quantity::new(last, "s"));
    Some(format!("the run ends at {last}, before `{}` does at {end}", cut.label))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::requirement::{Deflection, Rules};
    use crate::synthetic::{Build, planned};
    use core::f64::consts::TAU;
    use servobench_signals::Signal;
    use servobench_trace::Event;

    /// A move from 0 to 0.2 m in 0.5 s, then a rest to 1 s, at 1 kHz; the load is at `load(t)`.
    fn one_move(load: impl Fn(f64) -> f64) -> Recording {
        let x = |t: f64| 0.2 * t.min(0.5) / 0.5;
        Build::new(1000, 1001)
            .channel(Signal::RequestPosition, "m", x)
            .channel(Signal::RequestVelocity, "m/s", |t| if t < 0.5 { 0.4 } else { 0.0 })
            .channel(Signal::LoadPosition, "m", load)
            .requests(&[(0.0, "follow"), (0.5, "rest")])
            .moves([planned(0.0, 0.5, 0.0, 0.2).made()])
            .finish()
    }

    fn found(recording: &Recording, rules: &Rules<'_>) -> Vec<String> {
        broken(&Task::of(recording, rules, &[])).unwrap_or_default()
    }

    #[test]
    fn a_load_that_rests_elsewhere_says_where_and_what_held_it() {
        let mut recording = one_move(|_| 0.15);
        recording.events.push(Event::bound(0.95, 5.0, "velocity loop", "effort limit", false));
        assert_eq!(
            found(&recording, &rules()),
            [
                "the load rests 50.0 mm from 200 mm at 1.00 s in `move to 0.2 m` (window ±200 µm); effort limit bound for 51.0 ms"
            ]
        );
        assert_eq!(found(&one_move(|_| f64::NAN), &rules()).len(), 1, "what is not a number has not arrived");
    }

    /// The scenario's window, at most 5 % of the distance, or a thousandth of it and ten increments or units of the bus.
    #[test]
    fn the_window_is_that_of_the_scenario_but_never_the_way() {
        for (window, increment, bus_unit, bound) in [
            (None, 0.0, 0.0, 2e-4),
            (None, 3e-5, 0.0, 3e-4),
            (None, 0.0, 4e-5, 4e-4),
            (Some(5e-6), 1e-9, 0.0, 5e-6),
            (Some(0.2), 0.0, 0.0, 0.01),
            (Some(0.2), 6e-3, 0.0, 12e-3),
        ] {
            for side in [1.0, -1.0] {
                let rules = Rules { window, increment, bus_unit, ..rules() };
                let found = |part: f64| found(&one_move(|_| 0.2 + side * part * bound), &rules);
                assert_eq!(found(0.99), [""; 0], "{window:?} {increment} {bus_unit}");
                assert_eq!(found(1.01).len(), 1, "{window:?} {increment} {bus_unit}");
            }
        }
    }

    #[test]
    fn deflection_explains_a_tenth_of_the_way() {
        let deflection = Deflection { elastic: 1e-3, ..Deflection::default() };
        let rules = Rules { deflection, ..rules() };
        assert_eq!(found(&one_move(|_| 0.1989), &rules), [""; 0]);
        assert_eq!(found(&one_move(|_| 0.1987), &rules).len(), 1);
        let soft = Rules { deflection: Deflection { elastic: 1.0, ..deflection }, ..rules };
        assert_eq!(found(&one_move(|_| 0.181), &soft), [""; 0]);
        assert_eq!(found(&one_move(|_| 0.179), &soft).len(), 1);
    }

    /// 7 Hz end in the middle of a cycle, and decay by 3 1/s: their last tenth is far off the target, their cycles are not.
    #[test]
    fn a_ringing_load_has_arrived_where_its_cycles_have() {
        let ringing = |off: f64| {
            one_move(move |t| {
                0.2 + off + if t < 0.5 { 0.0 } else { 0.02 * (TAU * 7.0 * t).sin() * (-3.0 * (t - 0.5)).exp() }
            })
        };
        let rules = Rules { window: Some(1e-3), ..rules() };
        assert_eq!(found(&ringing(0.0), &rules), [""; 0]);
        assert_eq!(found(&ringing(3e-3), &rules).len(), 1);
    }

    /// A slow swing that is over in the last quarter of the rest, and one whose mean is at the target while it grows out of all bounds.
    #[test]
    fn the_last_cycles_say_where_a_load_rests() {
        let off = |x: fn(f64) -> f64| one_move(move |t| 0.2 + if t < 0.5 { 0.0 } else { x(t - 0.5) });
        let over = off(|t| 0.02 * (1.0 + (TAU * 10.0 * t).cos()) * (1.0 - t / 0.35).max(0.0).powi(3));
        assert_eq!(found(&over, &rules()), [""; 0]);
        let rules = Rules { window: Some(5e-3), ..rules() };
        let grows = off(|t| 1e-5 * (TAU * 10.0 * t).sin() * (20.0 * t).exp());
        assert_eq!(found(&grows, &rules).len(), 1);
        assert_eq!(found(&off(|t| 0.02 * (TAU * 10.0 * t).sin()), &rules), [""; 0], "it swings about the target");
    }

    /// Frames are lost in a move, and the task has come to its target when they arrive again: shortly before the end, or long.
    #[test]
    fn a_rest_behind_a_silence_is_judged_at_the_end() {
        for (heard, place, is_found) in [(0.99, 0.15, true), (0.99, 0.2, false), (0.7, 0.15, true), (0.7, 0.2, false)] {
            let mut recording = one_move(move |t| if t < 0.3 { 0.4 * t } else { place });
            recording.signals[0].changes =
                vec![(0.0, "follow".into()), (0.3, "nothing".into()), (heard, "rest".into())];
            assert_eq!(found(&recording, &rules()).len(), usize::from(is_found), "{heard} {place}");
        }
    }

    #[test]
    fn a_rest_in_the_middle_is_judged_as_the_last_one_is() {
        let stop = |pause: f64| {
            let x =
                move |t: f64| if t < 0.5 + pause { 0.4 * t.min(0.5) } else { (0.2 - 0.4 * (t - 0.5 - pause)).max(0.0) };
            let recording = Build::new(1000, 3001)
                .channel(Signal::RequestPosition, "m", x)
                .channel(Signal::RequestVelocity, "m/s", |_| 0.0)
                .channel(Signal::LoadPosition, "m", move |t| x(t).min(0.19))
                .requests(&[(0.0, "follow"), (0.5, "rest"), (0.5 + pause, "follow"), (1.0 + pause, "rest")])
                .finish();
            found(&recording, &rules()).len()
        };
        assert_eq!(stop(0.1), 1);
        assert_eq!(stop(0.01), 0, "too short for any loop: `follows` judges it");
    }

    #[test]
    fn a_run_that_ends_before_its_move_does_not_arrive() {
        for (rows, is_kept) in [(401, false), (501, true)] {
            let mut recording = Build::new(1000, rows)
                .channel(Signal::RequestPosition, "m", |t| 0.4 * t)
                .channel(Signal::RequestVelocity, "m/s", |_| 0.4)
                .channel(Signal::LoadPosition, "m", |t| 0.4 * t)
                .requests(&[(0.0, "follow"), (0.5, "rest")])
                .finish();
            recording.moves = vec![planned(0.0, 0.5, 0.0, 0.2).made()];
            let all: &[&str] =
                if is_kept { &[] } else { &["the run ends at 400 ms, before `move to 0.2 m` does at 500 ms"] };
            assert_eq!(found(&recording, &rules()), all);
        }
    }

    #[test]
    fn without_a_target_nothing_is_asked() {
        let asked = |recording: &Recording, driven| {
            let rules = Rules { driven, ..rules() };
            broken(&Task::of(recording, &rules, &[])).is_some()
        };
        assert!(!asked(&one_move(|_| 0.0), Driven::Not));
        assert!(asked(&one_move(|_| 0.0), Driven::Exactly), "the load of a prescribed motor arrives too");
        let mut standing = one_move(|_| 0.0);
        (standing.signals, standing.moves) = (Vec::new(), Vec::new());
        assert!(!asked(&standing, Driven::ByLoops));
    }
}
