//! JUnit XML for continuous integration.
use crate::error::ReportError;
use crate::failures::{lifted, missed_limits, other_failures};
use crate::metric_table::metric_table;
use crate::said::last_words;
use crate::style::Style;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use servobench_results::{Outcome, Results, RunResult, Unfinished, printable, printable_lines};
use std::time::Duration;

/// One test case for each scenario and engine, with the `times` (wall clock) that the runs took: results hold none; without
/// any the times are left out.
///
/// A run that did not end is an error, so that a suite that was ended before its time is never taken for one that passed.
/// What failed is a failure: its message says which limit is missed by how much or which requirement is broken, its text
/// says all of that with file and line, and the case has the attributes `file` and `line` of the first limit. What is invalid
/// or could not be carried out is an error. The verdict is a property; metrics, lifted requirements and warnings are the
/// case's output, what FMUs said at last its error output.
///
/// # Errors
/// [`ReportError::Junit`].
pub fn junit(results: &Results, times: &[Duration]) -> Result<String, ReportError> {
    let mut suite = TestSuite::new("servobench");
    let cases = results.scenarios.iter().enumerate().map(|(k, run)| case(run, times.get(k).copied()));
    suite.add_test_cases(cases);
    suite.add_test_cases(results.unfinished.iter().map(unfinished));
    let mut report = Report::new("servobench");
    if !times.is_empty() {
        let sum = times.iter().sum();
        suite.set_time(sum);
        report.set_time(sum);
    }
    report.add_test_suite(suite);
    Ok(printable_lines(&report.to_string()?))
}

fn case(run: &RunResult, time: Option<Duration>) -> TestCase {
    let engine = if run.engine.is_empty() { String::new() } else { format!(" [{}]", run.engine) };
    // The same scenario under other numbers is another case.
    let overrides = run.overrides.join(", ");
    let with = if overrides.is_empty() { String::new() } else { format!(" with {}", printable(&overrides)) };
    let mut case = TestCase::new(format!("{}{engine}{with}", printable(&run.name).trim()), status(run));
    case.set_classname(class_name(run.file.as_deref()));
    case.add_property(("verdict", run.verdict.word()));
    if let Some(time) = time {
        case.set_time(time);
    }
    if let Some(file) = &run.file {
        case.extra.insert("file".into(), printable(file).into());
        let line = missed_limits(run).iter().find_map(|limit| limit.line);
        if let Some(line) = line {
            case.extra.insert("line".into(), line.to_string().into());
        }
    }
    let out = output(run);
    if !out.is_empty() {
        case.set_system_out(out);
    }
    let said = last_words(run, Style::default().width);
    if !said.is_empty() {
        case.set_system_err(said.join("\n"));
    }
    case
}

/// The file of a scenario.
fn class_name(file: Option<&str>) -> String {
    file.map_or_else(|| "servobench".to_owned(), printable)
}

/// A run that has no result.
fn unfinished(run: &Unfinished) -> TestCase {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    status.set_type("unfinished").set_message("the suite was ended before this run");
    let mut case = TestCase::new(format!("{} [{}]", printable(&run.name).trim(), run.engine), status);
    case.set_classname(class_name(run.file.as_deref()));
    case
}

/// What is lifted, what warns, and every metric.
fn output(run: &RunResult) -> String {
    let mut lines = lifted(run);
    lines.extend(run.warnings.iter().map(|warning| format!("warning: {warning}")));
    if run.verdict.is_whole() && !run.metrics.is_empty() {
        lines.push(metric_table(run, Style::default()));
    }
    lines.join("\n")
}

fn status(run: &RunResult) -> TestCaseStatus {
    let kind = match run.verdict {
        Outcome::Passed | Outcome::Unjudged => return TestCaseStatus::success(),
        Outcome::Failed => NonSuccessKind::Failure,
        Outcome::Invalid | Outcome::Error => NonSuccessKind::Error,
    };
    let (what, told) = if run.verdict == Outcome::Failed { failures(run) } else { (run.verdict.word(), vec![]) };
    let told = if told.is_empty() { run.reasons.clone() } else { told };
    let more = told.len().saturating_sub(1);
    let more = if more > 0 { format!(" (and {more} more)") } else { String::new() };
    let message = format!("{}{more}", told.first().map_or("", String::as_str));
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(what).set_message(message).set_description(told.join("\n"));
    status
}

/// What kind of failure it is, and every part of it in words, limits with their place in the file.
fn failures(run: &RunResult) -> (&'static str, Vec<String>) {
    let missed = missed_limits(run);
    let others = other_failures(run);
    let kind = match (missed.is_empty(), run.requirements.iter().any(|(_, one)| !one.reasons.is_empty())) {
        (false, _) => "limit missed",
        (true, true) => "requirement broken",
        (true, false) => "expected fault missing",
    };
    let placed = missed.iter().map(|limit| {
        let place = run.file.as_ref().zip(limit.line).map(|(file, line)| format!(" ({file}:{line})"));
        limit.sentence() + &place.unwrap_or_default()
    });
    (kind, placed.chain(others).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::samples;

    fn read(times: &[Duration]) -> Report {
        Report::deserialize_from_str(&junit(&samples::results(), times).unwrap()).unwrap()
    }

    /// Kind, type, message and text of a case that did not succeed.
    fn told(case: &TestCase) -> (NonSuccessKind, &str, &str, &str) {
        let TestCaseStatus::NonSuccess { kind, ty, message, description, .. } = &case.status else {
            panic!("{case:?}")
        };
        let [ty, message, description] =
            [ty, message, description].map(|of| of.as_ref().map_or("", quick_junit::XmlString::as_str));
        (*kind, ty, message, description)
    }

    #[test]
    fn reads_back_with_failures_and_errors_told_apart() {
        let report = read(&[]);
        assert_eq!((report.tests, report.failures, report.errors), (7, 2, 2));
        let cases = &report.test_suites[0].test_cases;
        assert_eq!(cases[0].name.as_str(), "lambrechts-jerk [exact]");
        let classname = cases[0].classname.as_ref().map(quick_junit::XmlString::as_str);
        assert_eq!(classname, Some("scenarios/lambrechts-jerk.toml"));
        assert!(matches!(cases[0].status, TestCaseStatus::Success { .. }));
        assert_eq!(cases[0].properties[0].value.as_str(), "unjudged (no limits)");
        let (kind, _, message, description) = told(&cases[4]);
        assert_eq!(kind, NonSuccessKind::Error);
        let whole =
            "the mechanics diverged at 0.123 s: the position of `load` is not finite; take a smaller step than 1.00 ms";
        assert_eq!((message, description), (whole, whole), "a message of two parts is one line");
        let said = cases[4].system_err.as_ref().unwrap().as_str();
        assert!(said.ends_with("  0.1230 s  error: the pressure in `tank.p` is negative"), "{said}");
    }

    #[test]
    fn a_missed_limit_is_told_with_its_size_its_file_and_its_line() {
        let report = read(&[]);
        let case = &report.test_suites[0].test_cases[1];
        let (kind, ty, message, description) = told(case);
        let file = "scenarios/feed-axis-reversal-at-low-speed-with-stick-slip.toml";
        assert_eq!((kind, ty), (NonSuccessKind::Failure, "limit missed"));
        assert_eq!(message, format!("settling_time 35.2 ms, limit 20.0 ms, 76 % over ({file}:31) (and 2 more)"));
        assert_eq!(description.lines().nth(1), Some("residual_vibration_pp 8.30 µm, limit 2.00 µm, 4.2 times as much"));
        assert_eq!(case.extra["file"].as_str(), file);
        assert_eq!(case.extra["line"].as_str(), "31");
    }

    #[test]
    fn a_broken_requirement_is_a_failure_and_what_is_lifted_is_said() {
        let report = read(&[]);
        let cases = &report.test_suites[0].test_cases;
        let (kind, ty, message, _) = told(&cases[6]);
        assert_eq!((kind, ty), (NonSuccessKind::Failure, "requirement broken"));
        assert!(message.starts_with("arrives: the load ended 200 mm short of 200 mm"), "{message}");
        let out = cases[2].system_out.as_ref().unwrap().as_str();
        assert!(out.starts_with("lifted: bounded\n"), "{out}");
    }

    #[test]
    fn a_run_that_did_not_end_is_an_error() {
        let mut results = samples::results();
        results.unfinished =
            vec![Unfinished { name: "last".into(), file: Some("last.toml".into()), engine: "mujoco".into() }];
        let report = Report::deserialize_from_str(&junit(&results, &[]).unwrap()).unwrap();
        assert_eq!((report.tests, report.errors), (8, 3));
        let (kind, ty, message, _) = told(&report.test_suites[0].test_cases[7]);
        assert_eq!((kind, ty, message), (NonSuccessKind::Error, "unfinished", "the suite was ended before this run"));
    }

    #[test]
    fn times_are_those_of_the_clock() {
        let report = read(&[1500, 250, 0, 0, 0, 0, 4].map(Duration::from_millis));
        let cases = &report.test_suites[0].test_cases;
        assert_eq!(cases[1].time, Some(Duration::from_millis(250)));
        assert_eq!(report.time, Some(Duration::from_millis(1754)));
        assert_eq!(read(&[]).test_suites[0].test_cases[1].time, None);
    }

    #[test]
    fn two_reports_are_the_same_bytes() {
        let times = [Duration::from_millis(3); 7];
        assert_eq!(junit(&samples::results(), &times).unwrap(), junit(&samples::results(), &times).unwrap());
    }
}
