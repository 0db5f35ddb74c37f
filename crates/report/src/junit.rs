//! JUnit XML for continuous integration.
use crate::error::ReportError;
use crate::failures::{lifted, missed_limits, other_failures};
use crate::metric_table::metric_table;
use crate::said::last_words;
use crate::style::Style;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use servobench_results::{Outcome, RunResult, Runs, Unfinished, printable, printable_lines};
use servobench_trace::of_axis;
use std::iter::once;
use std::time::Duration;

/// One test case for each scenario and engine, with the wall-clock time of the run where it is known. The parts add up to
/// one text.
///
/// A run that did not end is an error, so that an interrupted suite is never taken for one that passed.
/// A run without limits is skipped: its results were not judged. A run that failed is a failure: its message names each missed limit with
/// its excess, or the broken requirement; its text lists all of that with file and line, and the case has the attributes `file` and `line`
/// of the first limit. A run that is invalid or could not be executed is an error. The verdict is a property; metrics, lifted requirements
/// and warnings are the case's output, the last log lines of FMUs its error output.
///
/// # Errors
/// [`ReportError::Junit`]; [`ReportError::Run`] in place of a run that cannot be read.
pub fn junit(runs: &dyn Runs) -> impl Iterator<Item = Result<String, ReportError>> {
    let unfinished = runs.unfinished().count();
    let mut suite = TestSuite::new(NAME);
    let count = |kind| runs.heads().filter(|head| kind_of(head.verdict) == Some(kind)).count();
    suite.tests = runs.heads().count() + unfinished;
    suite.skipped = runs.count_of(Outcome::Unjudged);
    suite.failures = count(NonSuccessKind::Failure);
    suite.errors = count(NonSuccessKind::Error) + unfinished;
    if runs.heads().any(|head| head.took.is_some()) {
        suite.set_time(runs.heads().filter_map(|head| head.took).sum());
    }
    let (start, end) = match written(suite, TestCase::new(NAME, TestCaseStatus::success())) {
        Ok(Written { start, end, .. }) => (Ok(start), Ok(end)),
        Err(error) => (Err(error), Ok(String::new())),
    };
    let text = |case| Ok(written(TestSuite::new(NAME), case)?.case);
    let cases = runs.heads().map(move |head| text(case(&*runs.result(head.index)?, head.took)));
    let unfinished = runs.unfinished().map(move |run| text(unfinished_case(run)));
    let parts = once(start).chain(cases).chain(unfinished).chain(once(end));
    parts.map(|part| part.map(|text| printable_lines(&text)))
}

const NAME: &str = "servobench";

/// A report with one case, in parts.
struct Written {
    /// Text before the case.
    start: String,
    case: String,
    /// Text after the case.
    end: String,
}

/// A report with the numbers of `suite` and `case` in it. The library writes whole reports only, and one of many runs is larger than
/// memory: so each case is written in a separate report, and the surrounding text once.
fn written(mut suite: TestSuite, case: TestCase) -> Result<Written, ReportError> {
    let mut report = Report::new(NAME);
    report.time = suite.time;
    suite.test_cases.push(case);
    report.add_test_suite(suite);
    let text = report.to_string()?;
    // Only our own names and numbers precede the case, and only closing tags follow it.
    let start = text.find(CASE).unwrap_or_default();
    let end = text.rfind(END).unwrap_or(text.len());
    Ok(Written { start: text[..start].to_owned(), case: text[start..end].to_owned(), end: text[end..].to_owned() })
}

/// Markup that begins a case, and markup that ends a suite.
const CASE: &str = "        <testcase ";
const END: &str = "    </testsuite>";

fn case(run: &RunResult, time: Option<Duration>) -> TestCase {
    let engine = if run.engine.is_empty() { String::new() } else { format!(" [{}]", run.engine) };
    // The same scenario with other numbers is another case.
    let overrides = run.overrides.join(", ");
    let with = if overrides.is_empty() { String::new() } else { format!(" with {}", printable(&overrides)) };
    let mut case =
        TestCase::new(format!("{}{}{engine}{with}", printable(&run.name).trim(), of_axis(run.axis)), status(run));
    case.set_classname(class_name(run.file.as_deref()));
    case.add_property(("verdict", run.verdict.word()));
    let lifted = lifted(run);
    if !lifted.is_empty() {
        case.add_property(("lifted", printable(&lifted.join("; ").replace("lifted: ", "")).as_str()));
    }
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

/// Class name of a case: the file of the scenario.
fn class_name(file: Option<&str>) -> String {
    file.map_or_else(|| "servobench".to_owned(), printable)
}

/// The case of a run without a result.
fn unfinished_case(run: &Unfinished) -> TestCase {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    status.set_type("unfinished").set_message("the suite was ended before this run");
    let mut case =
        TestCase::new(format!("{}{} [{}]", printable(&run.name).trim(), of_axis(run.axis), run.engine), status);
    case.set_classname(class_name(run.file.as_deref()));
    case
}

/// Lifted requirements, warnings and all metrics.
fn output(run: &RunResult) -> String {
    let mut lines = lifted(run);
    lines.extend(run.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(run.check_warnings.iter().flatten().map(|warning| format!("warning of check: {warning}")));
    if run.verdict.is_whole() && !run.metrics.is_empty() {
        lines.push(metric_table(run, Style::default()));
    }
    lines.join("\n")
}

/// JUnit kind of an outcome; `None` for a success.
const fn kind_of(outcome: Outcome) -> Option<NonSuccessKind> {
    match outcome {
        Outcome::Passed | Outcome::Unjudged => None,
        Outcome::Failed => Some(NonSuccessKind::Failure),
        Outcome::Invalid | Outcome::Error => Some(NonSuccessKind::Error),
    }
}

fn status(run: &RunResult) -> TestCaseStatus {
    if run.verdict == Outcome::Unjudged {
        let mut status = TestCaseStatus::skipped();
        status
            .set_type("unjudged")
            .set_message("no limits: give the scenario `[limits]`, or deny such runs with `--deny unjudged`");
        return status;
    }
    let Some(kind) = kind_of(run.verdict) else { return TestCaseStatus::success() };
    let (what, told) = if run.verdict == Outcome::Failed { failures(run) } else { (run.verdict.word(), vec![]) };
    let told = if told.is_empty() { run.reasons.clone() } else { told };
    let more = told.len().saturating_sub(1);
    let more = if more > 0 { format!(" (and {more} more)") } else { String::new() };
    let message = format!("{}{more}", told.first().map_or("", String::as_str));
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(what).set_message(message).set_description(told.join("\n"));
    status
}

/// Kind of failure, and all its parts in words, limits with their place in the file.
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
    use servobench_results::{Finished, Kept, Results, samples};

    fn text_of(runs: &dyn Runs) -> String {
        junit(runs).collect::<Result<_, _>>().unwrap()
    }

    fn read(runs: &dyn Runs) -> Report {
        Report::deserialize_from_str(&text_of(runs)).unwrap()
    }

    /// These runs, with their durations (ms).
    fn timed(results: Results, times: [u32; 7]) -> Kept {
        let unfinished =
            |run: &RunResult| Unfinished { name: run.name.clone(), file: None, engine: run.engine.clone(), axis: None };
        let mut kept = Kept::new(None, results.scenarios.iter().map(unfinished).collect::<Vec<_>>());
        for ((index, result), time) in results.scenarios.into_iter().enumerate().zip(times) {
            kept.note(Finished { index, seconds: f64::from(time) * 1e-3, result }).unwrap();
        }
        kept
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
        let report = read(&samples::results());
        assert_eq!((report.tests, report.failures, report.errors), (7, 2, 2));
        let cases = &report.test_suites[0].test_cases;
        assert_eq!(cases[0].name.as_str(), "lambrechts-jerk [exact]");
        let classname = cases[0].classname.as_ref().map(quick_junit::XmlString::as_str);
        assert_eq!(classname, Some("scenarios/lambrechts-jerk.toml"));
        assert_eq!((report.skipped, report.test_suites[0].skipped), (2, 2));
        let TestCaseStatus::Skipped { ty, message, .. } = &cases[0].status else { panic!("{:?}", cases[0]) };
        let [ty, message] = [ty, message].map(|of| of.as_ref().map_or("", quick_junit::XmlString::as_str));
        assert!(ty == "unjudged" && message.starts_with("no limits: "), "{message}");
        assert!(matches!(cases[2].status, TestCaseStatus::Success { .. }));
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
    fn a_case_has_the_name_of_its_axis() {
        let mut results = samples::results();
        results.scenarios[0].axis = Some("x".parse().unwrap());
        let last = Unfinished { name: "last".into(), file: None, engine: "mujoco".into(), axis: "y".parse().ok() };
        results.unfinished = vec![last];
        let report = read(&results);
        let cases = &report.test_suites[0].test_cases;
        assert_eq!(cases[0].name.as_str(), "lambrechts-jerk (axis x) [exact]");
        assert_eq!(cases[7].name.as_str(), "last (axis y) [mujoco]");
    }

    #[test]
    fn a_missed_limit_is_told_with_its_size_its_file_and_its_line() {
        let report = read(&samples::results());
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
        let report = read(&samples::results());
        let cases = &report.test_suites[0].test_cases;
        let (kind, ty, message, _) = told(&cases[6]);
        assert_eq!((kind, ty), (NonSuccessKind::Failure, "requirement broken"));
        assert!(message.starts_with("arrives: the load ended 200 mm short of 200 mm"), "{message}");
        let out = cases[2].system_out.as_ref().unwrap().as_str();
        assert!(out.starts_with("lifted: bounded\n"), "{out}");
        let lifted = &cases[2].properties[1];
        assert_eq!((lifted.name.as_str(), lifted.value.as_str()), ("lifted", "bounded"));
    }

    #[test]
    fn a_run_that_did_not_end_is_an_error() {
        let mut results = samples::results();
        results.unfinished = vec![Unfinished {
            name: "last".into(),
            file: Some("last.toml".into()),
            engine: "mujoco".into(),
            axis: None,
        }];
        let report = read(&results);
        assert_eq!((report.tests, report.errors), (8, 3));
        let (kind, ty, message, _) = told(&report.test_suites[0].test_cases[7]);
        assert_eq!((kind, ty, message), (NonSuccessKind::Error, "unfinished", "the suite was ended before this run"));
    }

    #[test]
    fn times_are_those_of_the_clock() {
        let report = read(&timed(samples::results(), [1500, 250, 0, 0, 0, 0, 4]));
        let cases = &report.test_suites[0].test_cases;
        assert_eq!(cases[1].time, Some(Duration::from_millis(250)));
        assert_eq!(report.time, Some(Duration::from_millis(1754)));
        assert_eq!(read(&samples::results()).test_suites[0].test_cases[1].time, None);
    }

    /// The parts put together equal the text that the library writes in one piece.
    #[test]
    fn the_parts_are_one_report() {
        let mut results = samples::results();
        results.unfinished =
            vec![Unfinished { name: "\u{1b}[<x>".into(), file: None, engine: "mujoco".into(), axis: None }; 2];
        results.scenarios[0].name = "    </testsuite>\n        <testcase name=\"\">".into();
        results.scenarios[1].reasons.push("    </testsuite>\n        <testcase ".into());
        let mut suite = TestSuite::new(NAME);
        suite.add_test_cases(results.scenarios.iter().map(|run| case(run, None)));
        suite.add_test_cases(results.unfinished.iter().map(unfinished_case));
        let mut report = Report::new(NAME);
        report.add_test_suite(suite);
        assert_eq!(text_of(&results), printable_lines(&report.to_string().unwrap()));
    }

    #[test]
    fn two_reports_are_the_same_bytes() {
        assert_eq!(text_of(&timed(samples::results(), [3; 7])), text_of(&timed(samples::results(), [3; 7])));
    }
}
