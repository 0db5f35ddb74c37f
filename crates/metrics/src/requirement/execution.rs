//! `executed`: every call of a function block is executed, comes to what it is for, and ends without an error.
use super::rules::EarlyEnd;
use super::{Expectation, Occasion, Rules};
use crate::quantity::Quantity;
use servobench_trace::{Call, CallFate, Recording};

/// Why calls are not as they should be; `None` where there are none.
pub(super) fn broken(recording: &Recording, rules: &Rules<'_>) -> Option<Vec<String>> {
    let gave_up = match &rules.ended {
        Some(EarlyEnd::GaveUp(reason)) => Some(reason.clone()),
        Some(EarlyEnd::Diverged { .. }) | None => None,
    };
    if recording.calls.is_empty() && gave_up.is_none() {
        return None;
    }
    let wrong = recording.calls.iter().filter(|call| !call.is_optional).filter_map(|call| wrong(call, rules.expected));
    Some(gave_up.into_iter().chain(wrong).collect())
}

fn wrong(call: &Call, expected: &[Expectation]) -> Option<String> {
    let Call { name, block, .. } = call;
    match &call.fate {
        CallFate::Executed => None,
        CallFate::NeverExecuted(why) => Some(why.clone()),
        CallFate::Unfinished(why) => Some(format!("`{name}` ({block}) did not come to its end: {why}")),
        CallFate::Failed { .. } if expected.iter().any(|expectation| fits(expectation, call).is_some()) => None,
        CallFate::Failed { time, id, message } => {
            Some(format!("`{name}` ended in Error {id:04X}h at {}: {message}", Quantity::new(*time, "s")))
        }
    }
}

/// When the error came that `expectation` expects of `call` (s).
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
    use crate::synthetic::Build;

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
            broken(&recording, &rules()).unwrap(),
            [
                "`call_1` was not executed: `home.Done` did not become TRUE",
                "`call_2` ended in Error 2002h at 250 ms: the axis has no reference",
                "`call_3` (MC_MoveAbsolute) did not come to its end: its `Done` did not become TRUE",
            ]
        );
    }

    #[test]
    fn optional_calls_may_fail_and_expected_errors_may_come() {
        let optional = recording(&[(true, failed()), (true, CallFate::NeverExecuted(String::new()))]);
        assert_eq!(broken(&optional, &rules()).unwrap(), [""; 0]);
        for (who, fault, from, to, is_expected) in [
            ("call_0", "2002h", 0.0, f64::INFINITY, true),
            ("call_0", "2002h", 0.25, 0.25, true),
            ("call_0", "2002h", 0.26, 1.0, false),
            ("call_0", "2002h", 0.0, 0.24, false),
            ("call_0", "2001h", 0.0, f64::INFINITY, false),
            ("call_1", "2002h", 0.0, f64::INFINITY, false),
        ] {
            let expected = [expecting(who, fault, from, to)];
            let found = broken(&recording(&[(false, failed())]), &Rules { expected: &expected, ..rules() }).unwrap();
            assert_eq!(found.is_empty(), is_expected, "{expected:?}: {found:?}");
        }
    }

    #[test]
    fn a_program_without_calls_has_nothing_to_execute_unless_it_gave_up() {
        assert_eq!(broken(&recording(&[]), &rules()), None);
        let ended = Some(EarlyEnd::GaveUp("`jog` was not executed within 2 s".into()));
        let found = broken(&recording(&[]), &Rules { ended, ..rules() }).unwrap();
        assert_eq!(found, ["`jog` was not executed within 2 s"]);
    }
}
