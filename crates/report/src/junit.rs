//! JUnit XML for continuous integration.
use crate::error::ReportError;
use crate::metric_table::metric_table;
use crate::results::{Outcome, Results, RunResult};
use crate::said::last_words;
use crate::style::Style;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

/// One test case for each scenario and engine. A missed limit is a failure, a run that could not be carried out is an
/// error; the metrics are the case's output, what FMUs said at last is its error output. Times of test cases are wall-clock times by custom, and results hold
/// none: they are left out.
///
/// # Errors
/// [`ReportError::Junit`].
pub fn junit(results: &Results) -> Result<String, ReportError> {
    let mut suite = TestSuite::new("servobench");
    suite.add_test_cases(results.scenarios.iter().map(case));
    let mut report = Report::new("servobench");
    report.add_test_suite(suite);
    Ok(report.to_string()?)
}

fn case(run: &RunResult) -> TestCase {
    let mut case = TestCase::new(format!("{} [{}]", run.name, run.engine), status(run));
    case.set_classname(run.file.as_deref().unwrap_or("servobench"));
    if run.verdict.is_whole() && !run.metrics.is_empty() {
        case.set_system_out(metric_table(run, Style::default()));
    }
    let said = last_words(run, Style::default().width);
    if !said.is_empty() {
        case.set_system_err(said.join("\n"));
    }
    case
}

fn status(run: &RunResult) -> TestCaseStatus {
    let (kind, what) = match run.verdict {
        Outcome::Passed | Outcome::Unjudged => return TestCaseStatus::success(),
        Outcome::Failed => (NonSuccessKind::Failure, "limit missed"),
        Outcome::Input => (NonSuccessKind::Error, "wrong input"),
        Outcome::Error => (NonSuccessKind::Error, "run not carried out"),
    };
    let of_moves = run.moves.iter().flat_map(|made| made.metrics.iter());
    let missed = run.metrics.iter().chain(of_moves).filter(|(_, metric)| metric.pass == Some(false)).count();
    let message = match (run.verdict, missed) {
        (Outcome::Failed, 1) => "1 limit missed".to_owned(),
        (Outcome::Failed, count) => format!("{count} limits missed"),
        _ => run.reasons.join("\n"),
    };
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(what).set_message(message).set_description(run.reasons.join("\n"));
    status
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn reads_back_with_failures_and_errors_told_apart() {
        let xml = junit(&samples::results()).unwrap();
        let report = Report::deserialize_from_str(&xml).unwrap();
        assert_eq!((report.tests, report.failures, report.errors), (6, 1, 2));
        let cases = &report.test_suites[0].test_cases;
        let names: Vec<_> = cases.iter().map(|case| case.name.as_str()).collect();
        assert_eq!(names[0], "lambrechts-jerk [exact]");
        assert_eq!(
            cases[0].classname.as_ref().map(quick_junit::XmlString::as_str),
            Some("scenarios/lambrechts-jerk.toml")
        );
        assert!(matches!(cases[0].status, TestCaseStatus::Success { .. }));
        let TestCaseStatus::NonSuccess { kind, message, description, .. } = &cases[1].status else { panic!("missed") };
        assert_eq!(*kind, NonSuccessKind::Failure);
        assert_eq!(message.as_ref().unwrap().as_str(), "3 limits missed");
        let lines: Vec<_> = description.as_ref().unwrap().as_str().lines().collect();
        assert_eq!(lines[1], "residual_vibration_pp 8.30 µm, limit 2.00 µm");
        let TestCaseStatus::NonSuccess { kind, message, description, .. } = &cases[4].status else { panic!("broken") };
        assert_eq!(*kind, NonSuccessKind::Error);
        let whole =
            "the mechanics diverged at 0.123 s: the position of `load` is not finite; take a smaller step than 1.00 ms";
        assert_eq!(message.as_ref().unwrap().as_str(), whole);
        assert_eq!(description.as_ref().unwrap().as_str(), whole, "a message of two parts is one line");
        let said = cases[4].system_err.as_ref().unwrap().as_str();
        assert!(said.ends_with("  0.1230 s  error: the pressure in `tank.p` is negative"), "{said}");
    }

    #[test]
    fn two_reports_are_the_same_bytes() {
        assert_eq!(junit(&samples::results()).unwrap(), junit(&samples::results()).unwrap());
    }
}
