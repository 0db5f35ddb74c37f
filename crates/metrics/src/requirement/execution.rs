//! `executed`: every call of a function block is executed, reaches its purpose, and ends without an error.
use super::phases::RequestPhase;
use super::rules::{Driven, EarlyEnd};
use super::task::Task;
use super::{Expectation, Occasion};
use crate::quantity::Quantity;
use servobench_base::RequestKind;
use servobench_trace::{Call, CallFate, Ending, Move};

/// The state of the drive in which its loops follow, as named in recordings.
const OPERATION_ENABLED: &str = "Operation enabled";

/// Time without a request after which a task is silent (s).
const SILENT: f64 = 0.02;

/// Reasons why the program is not executed; `None` where there is nothing to execute.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    let Task { recording, rules, .. } = task;
    let gave_up = match &rules.ended {
        Some(EarlyEnd::GaveUp(reason)) => Some(reason.clone()),
        Some(EarlyEnd::Diverged { .. }) | None => None,
    };
    let unpowered = unpowered(task);
    let silent = silent(task);
    if recording.calls.is_empty() && gave_up.is_none() && unpowered.is_empty() && silent.is_none() {
        return None;
    }
    let wrong = recording.calls.iter().filter_map(|call| wrong(call, rules.expected));
    Some(gave_up.into_iter().chain(wrong).chain(unpowered).chain(silent).collect())
}

/// Motions without power: of a drive that is off, and those ended by a loss of power that no expected fault explains.
fn unpowered(task: &Task<'_>) -> Vec<String> {
    let moves =
        |phase: &&RequestPhase| matches!(phase.kind, RequestKind::Follow | RequestKind::Velocity | RequestKind::Effort);
    if task.rules.driven == Driven::Not {
        let first = task.phases.iter().find(moves);
        return first
            .map(|phase| format!("a motion is requested at {}, and the drive is off", task.time(phase.rows.start)))
            .into_iter()
            .collect();
    }
    let followed = task.phases.windows(2).filter(|pair| moves(&&pair[0]) && pair[1].kind == RequestKind::Nothing);
    followed
        .filter(|pair| !task.is_excused(&pair[0].rows) && loses_power(task, &pair[1]))
        .map(|pair| {
            let row = pair[1].rows.start;
            format!("the power is lost at {} in a motion{}", task.time(row), task.within(row))
        })
        .collect()
}

/// A task that falls silent before it is done, while the drive would follow, unless the load makes the moves that were planned meanwhile.
fn silent(task: &Task<'_>) -> Option<String> {
    let is_told = task.recording.signal("drive", "state").is_some();
    let mut pairs = task.phases.windows(2).filter(|pair| {
        let rows = &pair[1].rows;
        let is_silence =
            pair[1].kind == RequestKind::Nothing && rows.len() as f64 * task.recording.rate.period() >= SILENT;
        is_told && is_silence && !task.is_excused(&pair[0].rows) && !loses_power(task, &pair[1])
    });
    let pair = pairs.find(|pair| !is_done(task, &pair[0], &pair[1]))?;
    let [from, to] = [pair[1].rows.start, pair[1].rows.end - 1].map(|row| task.time(row));
    Some(format!("the task requests nothing from {from} to {to}, and the planned motion is not executed"))
}

/// True if nothing remained planned when the task fell `silent`, or the load does it nevertheless.
fn is_done(task: &Task<'_>, before: &RequestPhase, silent: &RequestPhase) -> bool {
    let Some(rows) = &task.rows else { return false };
    let end = silent.rows.end - 1;
    let is_last = silent.rows.end == task.recording.len();
    if before.kind == RequestKind::Velocity {
        let wanted = rows.request_velocity[before.rows.end - 1];
        let middle = usize::midpoint(silent.rows.start, end);
        let off = (rows.load_velocity(middle, end) - wanted).abs();
        return !is_last || off <= task.rules.tolerances.velocity * wanted.abs();
    }
    let (begun, over) = (task.recording.time_of(silent.rows.start), task.recording.time_of(silent.rows.end));
    let is_planned = |made: &&Move| made.end > begun;
    let mut planned = task.recording.moves.iter().filter(is_planned).peekable();
    if planned.peek().is_none() {
        return !is_last || matches!(before.kind, RequestKind::Rest | RequestKind::Stand);
    }
    // At the target of each before the next one begins, if that is in the silence.
    while let Some(made) = planned.next() {
        let next = planned.peek().map_or(f64::INFINITY, |next| next.start);
        if next > over && !is_last {
            return true;
        }
        let way = (made.to - made.from).abs();
        let window = task.window(way).min(task.rules.tolerances.arrives * way).max(task.rules.resolution());
        let last = task.recording.index_at(next.min(over)).saturating_sub(1).min(end);
        if made.ending != Ending::AtRest || (rows.load[last] - made.to).abs() > window {
            return false;
        }
    }
    true
}

/// True where the drive leaves Operation enabled in `phase`; a task that only falls silent leaves it there.
fn loses_power(task: &Task<'_>, phase: &RequestPhase) -> bool {
    let Some(state) = task.recording.signal("drive", "state") else { return true };
    let [start, end] = [phase.rows.start, phase.rows.end].map(|row| task.recording.time_of(row));
    let is_enabled = |value: &str| value == OPERATION_ENABLED;
    let mut changes = state.changes.iter().filter(|(time, _)| start < *time && *time < end);
    !state.at(start).is_some_and(is_enabled) || changes.any(|(_, value)| !is_enabled(value))
}

fn wrong(call: &Call, expected: &[Expectation]) -> Option<String> {
    let Call { name, block, .. } = call;
    match &call.fate {
        CallFate::Executed => None,
        CallFate::NeverExecuted(_) | CallFate::Unfinished(_) if call.is_optional => None,
        CallFate::NeverExecuted(why) => Some(why.clone()),
        CallFate::Unfinished(why) => Some(format!("`{name}` ({block}) did not finish: {why}")),
        CallFate::Failed { .. } if expected.iter().any(|expectation| fits(expectation, call).is_some()) => None,
        CallFate::Failed { time, id, message } => {
            Some(format!("`{name}` ended in Error {id:04X}h at {}: {message}", Quantity::new(*time, "s")))
        }
    }
}

/// Time of the error that `expectation` expects of `call` (s).
pub(super) fn fits(expectation: &Expectation, call: &Call) -> Option<f64> {
    let CallFate::Failed { time, id, .. } = call.fate else { return None };
    let Occasion::Fault { fault, who } = &expectation.on else { return None };
    let is_it = *who == call.name && Expectation::code_of(fault) == Some(id);
    (is_it && expectation.is_open_at(time)).then_some(time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::{expecting, rules};
    use crate::requirement::{Expected, Rules};
    use crate::synthetic::{Build, planned};
    use servobench_signals::Signal;
    use servobench_trace::Recording;

    fn found(recording: &Recording, rules: &Rules<'_>, expected: &[Expected]) -> Option<Vec<String>> {
        broken(&Task::of(recording, rules, expected))
    }

    /// A task that falls silent at `from` in a motion to 0.1 m that takes until 0.9 s; the load is at `load(t)`.
    fn silent(from: f64, state: &str, load: fn(f64) -> f64) -> Recording {
        Build::new(1000, 2001)
            .channel(Signal::RequestPosition, "m", |t| 0.125 * (t - 0.1))
            .channel(Signal::RequestVelocity, "m/s", |_| 0.125)
            .channel(Signal::LoadPosition, "m", load)
            .requests(&[(0.0, "stand"), (0.1, "follow"), (from, "nothing")])
            .signal("drive", "state", &[(0.0, "Switched on"), (0.05, "Operation enabled"), (from, state)])
            .moves([planned(0.1, 0.9, 0.0, 0.1).made()])
            .finish()
    }

    /// A drive that is not enabled does not follow, a fault that is expected ends the task, and what comes to its target does it.
    #[test]
    fn a_task_that_falls_silent_is_not_executed() {
        let halfway = |_: f64| 0.05;
        let enabled = silent(0.5, "Operation enabled", halfway);
        assert_eq!(
            found(&enabled, &rules(), &[]).unwrap(),
            ["the task requests nothing from 500 ms to 2.00 s, and the planned motion is not executed"]
        );
        let came = Expected { expectation: expecting("drive", "8611h", 0.0, 1.0), met: Some(0.5) };
        assert_eq!(found(&enabled, &rules(), &[came]), None);
        assert_eq!(found(&silent(1.99, "Operation enabled", halfway), &rules(), &[]), None, "too short to be seen");
        assert_eq!(
            found(&silent(0.5, "Operation enabled", |t| (0.125 * (t - 0.1)).clamp(0.0, 0.1)), &rules(), &[]),
            None
        );
        let done = Recording { moves: Vec::new(), ..enabled };
        assert_eq!(found(&done, &rules(), &[]).unwrap().len(), 1, "nobody knows where it was to go");
    }

    fn recording(fates: &[(bool, CallFate)]) -> Recording {
        let mut recording = Build::new(1000, 11).finish();
        recording.calls = fates
            .iter()
            .enumerate()
            .map(|(k, (is_optional, fate))| Call {
                name: format!("call_{k}"),
                block: "MC_MoveAbsolute".into(),
                is_optional: *is_optional,
                fate: fate.clone(),
            })
            .collect();
        recording
    }

    fn failed() -> CallFate {
        CallFate::Failed { time: 0.25, id: 0x2002, message: "the axis has no reference".into() }
    }

    #[test]
    fn each_call_that_did_not_end_well_is_named() {
        let never = CallFate::NeverExecuted("`call_1` was not executed: `home.Done` did not become TRUE".into());
        let recording = recording(&[
            (false, CallFate::Executed),
            (false, never),
            (false, failed()),
            (false, CallFate::Unfinished("its `Done` did not become TRUE".into())),
        ]);
        assert_eq!(
            found(&recording, &rules(), &[]).unwrap(),
            [
                "`call_1` was not executed: `home.Done` did not become TRUE",
                "`call_2` ended in Error 2002h at 250 ms: the axis has no reference",
                "`call_3` (MC_MoveAbsolute) did not finish: its `Done` did not become TRUE",
            ]
        );
    }

    #[test]
    fn optional_calls_need_not_start_and_expected_errors_may_come() {
        let optional = recording(&[
            (true, CallFate::NeverExecuted(String::new())),
            (true, CallFate::Unfinished(String::new())),
            (true, failed()),
        ]);
        assert_eq!(
            found(&optional, &rules(), &[]).unwrap(),
            ["`call_2` ended in Error 2002h at 250 ms: the axis has no reference"],
            "what was started is not refused without a word"
        );
        for (who, fault, from, to, is_expected) in [
            ("call_0", "2002h", 0.0, f64::INFINITY, true),
            ("call_0", "2002h", 0.25, 0.25, true),
            ("call_0", "2002h", 0.26, 1.0, false),
            ("call_0", "2002h", 0.0, 0.24, false),
            ("call_0", "2001h", 0.0, f64::INFINITY, false),
            ("call_1", "2002h", 0.0, f64::INFINITY, false),
        ] {
            let expected = [expecting(who, fault, from, to)];
            let rules = Rules { expected: &expected, ..rules() };
            let found = found(&recording(&[(false, failed())]), &rules, &[]).unwrap();
            assert_eq!(found.is_empty(), is_expected, "{expected:?}: {found:?}");
        }
    }

    #[test]
    fn a_program_without_calls_has_nothing_to_execute_unless_it_gave_up() {
        assert_eq!(found(&recording(&[]), &rules(), &[]), None);
        let ended = Some(EarlyEnd::GaveUp("`jog` was not executed within 2 s".into()));
        let found = found(&recording(&[]), &Rules { ended, ..rules() }, &[]).unwrap();
        assert_eq!(found, ["`jog` was not executed within 2 s"]);
    }

    #[test]
    fn a_motion_without_power_is_not_executed() {
        let moving =
            |changes: &[(f64, &str)]| Build::new(1000, 1001).channel("time", "s", |t| t).requests(changes).finish();
        let off = Rules { driven: Driven::Not, ..rules() };
        let program = moving(&[(0.0, "stand"), (0.1, "follow"), (0.4, "rest")]);
        assert_eq!(found(&program, &off, &[]).unwrap(), ["a motion is requested at 100 ms, and the drive is off"]);
        assert_eq!(found(&moving(&[(0.0, "stand")]), &off, &[]), None);
        assert_eq!(found(&program, &rules(), &[]), None);
        for (ends, is_found) in [("nothing", true), ("stand", false), ("rest", false)] {
            let lost = moving(&[(0.0, "stand"), (0.1, "velocity"), (0.3, ends)]);
            let words = found(&lost, &rules(), &[]);
            let all: &[&str] = if is_found { &["the power is lost at 300 ms in a motion"] } else { &[] };
            assert_eq!(words.unwrap_or_default(), all);
            let came = |at| [Expected { expectation: expecting("drive", "3220h", 0.0, 1.0), met: Some(at) }];
            assert_eq!(found(&lost, &rules(), &came(0.3)), None);
            assert_eq!(found(&lost, &rules(), &came(0.5)).is_some(), is_found);
        }
    }
}
