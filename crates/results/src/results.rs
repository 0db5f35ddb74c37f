//! `results.json`: results of runs, for programs. The schema is in `docs/results.schema.json`.
use crate::digest::Digest;
use crate::error::ResultsError;
use crate::run::RunResult;
use crate::written::digest_of;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use servobench_base::AxisName;
use servobench_files::with_short_quotes;
use std::io::{self, BufReader};
use std::path::Path;

/// Name of the schema, before its version.
const SCHEMA: &str = "servobench-results/";
/// Version of the schema.
const VERSION: u32 = 3;

/// The results of several runs. `R` is the container of finished runs, `U` the type of unfinished ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound(deserialize = "R: Deserialize<'de>, U: Deserialize<'de>"))]
pub struct Results<R = Vec<RunResult>, U = Unfinished> {
    /// Name and version of the schema.
    pub schema: String,
    /// Program and version that wrote them.
    pub generator: String,
    /// Completeness of the suite.
    #[serde(default)]
    pub status: Status,
    /// Digest of the requested runs, in their order: equal suites of one program have equal digests, and equal
    /// results.
    #[serde(default)]
    pub suite: Digest,
    /// The finished runs, in the order of the request.
    pub scenarios: R,
    /// The unfinished runs, in that order; left out if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unfinished: Vec<U>,
}

/// Completeness of a suite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// All requested runs are among the results.
    #[default]
    Complete,
    /// The suite is running, or was interrupted.
    Incomplete,
}

/// A requested run without a result.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Unfinished {
    /// Name of the scenario.
    pub name: String,
    /// File of the scenario as given, `-` for standard input; `null` for an embedded one.
    pub file: Option<String>,
    /// Engine.
    pub engine: String,
    /// Name of the axis; left out where it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<AxisName>,
}

/// Outcome of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// All limits are kept, all requirements met, all expected faults have occurred.
    Passed,
    /// All requirements are met, and there was no limit to keep.
    Unjudged,
    /// A limit is missed, a requirement broken, or an expected fault did not occur.
    Failed,
    /// The scenario cannot be read, or cannot be built.
    #[serde(alias = "input")]
    Invalid,
    /// The run could not be completed.
    #[default]
    Error,
}

impl Outcome {
    /// True if the run was completed, and nothing in it failed.
    #[must_use]
    pub const fn is_good(self) -> bool {
        matches!(self, Self::Passed | Self::Unjudged)
    }

    /// The word for the outcome, used everywhere.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Unjudged => "unjudged (no limits)",
            Self::Failed => "failed",
            Self::Invalid => "invalid",
            Self::Error => "error",
        }
    }

    /// True if the run was completed, so that its metrics are valid.
    #[must_use]
    pub const fn is_whole(self) -> bool {
        !matches!(self, Self::Invalid | Self::Error)
    }
}

/// Largest file of results (bytes): 100 000 runs with one move take 1.5 GB.
const MOST_BYTES: u64 = 1 << 32;
/// A file of more bytes is parsed for validity before it is read.
const LARGE: u64 = 16 << 20;

/// Reads the text of a file of results.
///
/// # Errors
/// Errors of the operating system; the file is not regular, or larger than any results.
pub fn read_results(path: &Path) -> io::Result<String> {
    let file = servobench_files::open(path, MOST_BYTES)?;
    if file.metadata()?.len() > LARGE {
        // A file that is not JSON is not loaded into memory to find that out.
        let refused = |error: serde_json::Error| {
            let why = with_short_quotes(&error.to_string());
            io::Error::new(io::ErrorKind::InvalidData, format!("it is no JSON: {why}"))
        };
        serde_json::from_reader::<_, IgnoredAny>(BufReader::new(file)).map_err(refused)?;
    }
    servobench_files::read_text(path, MOST_BYTES)
}

impl<R, U> Results<R, U> {
    /// The results of a suite, some runs of which may not have ended.
    #[must_use]
    pub fn of_suite(suite: Digest, scenarios: R, unfinished: Vec<U>) -> Self {
        let generator = concat!("servobench ", env!("CARGO_PKG_VERSION")).to_owned();
        let status = if unfinished.is_empty() { Status::Complete } else { Status::Incomplete };
        Self { schema: format!("{SCHEMA}{VERSION}"), generator, status, suite, scenarios, unfinished }
    }
}

impl Results {
    /// The results of these runs, all of which have ended.
    #[must_use]
    pub fn new(scenarios: Vec<RunResult>) -> Self {
        Self::of_suite(Digest::default(), scenarios, Vec::new())
    }

    /// The results as JSON, numbers in the shortest form that reads back to the same bits, with their digest at the end.
    ///
    /// # Errors
    /// [`ResultsError::Json`].
    pub fn to_json(&self) -> Result<String, ResultsError> {
        #[derive(Serialize)]
        struct Sealed<'a> {
            #[serde(flatten)]
            results: &'a Results,
            digest: Digest,
        }
        Ok(serde_json::to_string_pretty(&Sealed { results: self, digest: digest_of(self)? })? + "\n")
    }

    /// Reads JSON from [`Results::to_json`]; refuses it if it has been edited since.
    ///
    /// # Errors
    /// As [`Results::from_json`]; [`ResultsError::Unsealed`], [`ResultsError::Edited`].
    pub fn from_sealed_json(text: &str) -> Result<Self, ResultsError> {
        #[derive(Deserialize)]
        struct Seal {
            digest: Option<Digest>,
        }
        let results = Self::from_json(text)?;
        match serde_json::from_str::<Seal>(text)?.digest {
            None => Err(ResultsError::Unsealed),
            Some(digest) if digest == digest_of(&results)? => Ok(results),
            Some(_) => Err(ResultsError::Edited),
        }
    }

    /// Reads JSON from [`Results::to_json`], and results of older versions: version 2 has no inputs of the
    /// runs, version 1 also lacks requirements, parameters, and all files but the recording.
    ///
    /// # Errors
    /// [`ResultsError::Json`], [`ResultsError::Newer`], [`ResultsError::Schema`].
    pub fn from_json(text: &str) -> Result<Self, ResultsError> {
        let version = serde_json::from_str::<Head>(text)?.version()?;
        let mut results: Self = serde_json::from_str(text)?;
        results.schema = format!("{SCHEMA}{VERSION}");
        if version == 1 {
            for run in &mut results.scenarios {
                run.files = run.recording.iter().cloned().collect();
            }
        }
        Ok(results)
    }
}

/// Head of a file of results.
#[derive(Deserialize)]
struct Head {
    schema: String,
    status: Option<Status>,
}

impl Head {
    /// Version of the schema, if this build reads it.
    fn version(self) -> Result<u32, ResultsError> {
        let Self { schema, status } = self;
        match schema.strip_prefix(SCHEMA).and_then(|version| version.parse().ok()) {
            // A file without a status is not complete.
            Some(VERSION) if status.is_none() => Err(ResultsError::Json(serde::de::Error::missing_field("status"))),
            Some(version @ 1..=VERSION) => Ok(version),
            Some(version) if version > VERSION => Err(ResultsError::Newer { found: schema, known: VERSION }),
            _ => Err(ResultsError::Schema { found: schema }),
        }
    }
}

/// Names of all files left by the runs whose results are in the file at `path`. The rest is not kept in memory.
///
/// # Errors
/// As [`Results::from_json`]; [`ResultsError::Read`].
pub fn files_of_results(path: &Path) -> Result<Vec<String>, ResultsError> {
    #[derive(Deserialize)]
    struct Left {
        recording: Option<String>,
        /// Missing in version 1.
        files: Option<Vec<String>>,
    }
    #[derive(Deserialize)]
    struct All {
        schema: String,
        status: Option<Status>,
        scenarios: Vec<Left>,
    }
    let file = servobench_files::open(path, MOST_BYTES).map_err(ResultsError::Read)?;
    let All { schema, status, scenarios } = serde_json::from_reader(BufReader::new(file))?;
    Head { schema, status }.version()?;
    let files = scenarios
        .into_iter()
        .flat_map(|Left { recording, files }| files.unwrap_or_else(|| recording.into_iter().collect()));
    Ok(files.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{LimitPlace, RunIdentity};
    use crate::samples;
    use serde_json::{Value, json};
    use servobench_base::{Rate, Severity};
    use servobench_metrics::{
        Expectation, Expected, Limit, Name, Occasion, Question, Requirement, RequirementResult, Standing, measure,
    };
    use servobench_trace::{About, Channel, ChannelSpec, Ending, Event, LogEntry, Move, Recording};

    /// A mistake, and the function that makes it.
    type Spoiled = (&'static str, fn(&mut Value));

    fn validator() -> jsonschema::Validator {
        let schema = serde_json::from_str(include_str!("../../../docs/results.schema.json")).unwrap();
        jsonschema::validator_for(&schema).unwrap()
    }

    #[test]
    fn axes_have_names() {
        let mut results = samples::results();
        results.scenarios[0].axis = Some("x".parse().unwrap());
        let json = results.to_json().unwrap();
        assert!(validator().is_valid(&serde_json::from_str(&json).unwrap()));
        assert_eq!(Results::from_json(&json).unwrap().scenarios[0].axis, results.scenarios[0].axis);
        for name in ["", "a.b", "a\u{1b}[2J", &"a".repeat(33)] {
            let name = serde_json::to_string(name).unwrap();
            let json = json.replace("\"axis\": \"x\"", &format!("\"axis\": {name}"));
            assert!(!validator().is_valid(&serde_json::from_str(&json).unwrap()), "{name}");
            let refused = Results::from_json(&json).unwrap_err().to_string();
            assert!(refused.contains("the name of an axis ") && !refused.contains('\u{1b}'), "{refused}");
        }
    }

    fn value(results: &Results) -> Value {
        serde_json::from_str(&results.to_json().unwrap()).unwrap()
    }

    /// A recording of one move with a ramp as following error.
    fn recording() -> Recording {
        let rate = Rate::new(1000).unwrap();
        let spec = ChannelSpec {
            axis: None,
            name: "following_error.load".into(),
            unit: "m".into(),
            writer: "test".into(),
            rate,
        };
        Recording {
            about: About {
                scenario: "ramp".into(),
                engine: "exact".into(),
                axis_unit: "m".into(),
                bodies: vec!["load".into()],
                overrides: vec![],
            },
            rate,
            channels: vec![Channel { spec, values: (0..=1000).map(|k| f64::from(k) * 0.1e-6).collect() }],
            moves: vec![Move {
                label: "move to 1 m".into(),
                start: 0.0,
                end: 0.5,
                from: 0.0,
                to: 1.0,
                peaks: [2.0, 8.0, f64::INFINITY, f64::INFINITY],
                limits: [Some(2.5), Some(8.0), None, None],
                cruise: (0.2, 0.0),
                ending: Ending::AtRest,
            }],
            events: vec![Event::new(0.1, 0.1, "test", "an event")],
            signals: vec![],
            calls: vec![],
            limit_reversals: vec![],
            log: vec![LogEntry {
                source: "FMU load".into(),
                severity: Severity::Warning,
                start: 0.1,
                end: 0.1,
                times: 1,
                text: "stiff".into(),
            }],
            coupling: None,
        }
    }

    /// A run judged by two limits of which one cannot be measured.
    fn judged() -> RunResult {
        let recording = recording();
        let mut metrics = measure(&recording, &Question::default());
        let limits = [Limit::at_most(Name::FollowingErrorPeakLoad, 0.1e-3), Limit::at_most(Name::SettlingTime, 0.1)];
        let verdict = metrics.judge(&limits);
        let place = |metric: &str, line| LimitPlace { in_move: None, metric: metric.into(), line };
        let limits = vec![
            place("following_error_peak_load", 31),
            place("settling_time", 32),
            place("setpoint_velocity_ratio", 33),
        ];
        let run = RunIdentity { name: "ramp".into(), engine: "exact".into(), limits, ..RunIdentity::default() };
        RunResult::judged(run, &recording, &metrics, &verdict)
    }

    #[test]
    fn results_are_as_the_schema_says() {
        let mut results = samples::results();
        results.scenarios.push(judged());
        let errors: Vec<_> = validator().iter_errors(&value(&results)).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{errors:#?}");
    }

    #[test]
    fn the_schema_refuses_what_is_wrong() {
        let right = value(&samples::results());
        let wrong: [Spoiled; 9] = [
            ("another version", |v| v["schema"] = json!("servobench-results/2")),
            ("no verdict", |v| drop(v["scenarios"][0].as_object_mut().unwrap().remove("verdict"))),
            ("a verdict of its own", |v| v["scenarios"][0]["verdict"] = json!("maybe")),
            ("passed with a reason", |v| v["scenarios"][0]["reasons"] = json!(["why"])),
            ("failed without a reason", |v| v["scenarios"][1]["reasons"] = json!([])),
            ("a metric without unit", |v| {
                drop(v["scenarios"][0]["metrics"]["move_time"].as_object_mut().unwrap().remove("unit"));
            }),
            ("a standing of its own", |v| {
                v["scenarios"][1]["requirements"] = json!({ "stable": { "standing": "maybe", "reasons": [] } });
            }),
            ("a broken requirement without a reason", |v| {
                v["scenarios"][1]["requirements"] = json!({ "stable": { "standing": "broken", "reasons": [] } });
            }),
            ("a field nobody knows", |v| v["scenarios"][0]["host"] = json!("here")),
        ];
        for (what, spoil) in wrong {
            let mut value = right.clone();
            spoil(&mut value);
            assert!(!validator().is_valid(&value), "{what}");
        }
        assert!(validator().is_valid(&right));
    }

    #[test]
    fn a_judged_run_holds_every_limit() {
        let run = judged();
        assert_eq!(run.verdict, Outcome::Failed);
        // Instants 0 to 1000 at 1 kHz.
        assert_eq!(run.duration.to_bits(), 1.0_f64.to_bits());
        let peak = run.metrics.get("following_error_peak_load").unwrap();
        assert_eq!((peak.limit, peak.pass), (Some(0.1e-3), Some(true)));
        let settling = run.metrics.get("settling_time").unwrap();
        assert_eq!((settling.value, settling.limit, settling.pass), (None, Some(0.1), Some(false)));
        let why = "settling_time could not be measured: `load.position` is not recorded";
        assert_eq!(run.reasons, [why]);
        assert_eq!(run.moves[0].metrics.get("setpoint_velocity_ratio").unwrap().value, Some(0.8));
        assert_eq!((run.events.len(), run.log.len()), (1, 1));
    }

    #[test]
    fn json_reads_back_to_the_same_bits_and_keeps_the_order() {
        let results = Results::new(vec![judged(), samples::snap()]);
        let text = results.to_json().unwrap();
        let back = Results::from_json(&text).unwrap();
        assert_eq!(back, results);
        assert_eq!(back.to_json().unwrap(), text);
        let names: Vec<_> = back.scenarios[1].metrics.iter().map(|(name, _)| name.to_owned()).collect();
        let order: Vec<_> = results.scenarios[1].metrics.iter().map(|(name, _)| name.to_owned()).collect();
        assert_eq!(names, order);
    }

    /// Verdicts of a run with these standings, and with or without limits.
    fn verdict_of(
        (standing, reasons): (Standing, Vec<String>),
        limits: &[Limit],
        expected: Vec<Expected>,
    ) -> RunResult {
        let recording = recording();
        let mut metrics = measure(&recording, &Question::default());
        let mut verdict = metrics.judge(limits);
        let arrives = RequirementResult { standing, reasons };
        let executed = RequirementResult { standing: Standing::NotAsked, reasons: vec![] };
        verdict.requirements = vec![(Requirement::Arrives, arrives), (Requirement::Executed, executed)];
        verdict.expected = expected;
        verdict.warnings = vec!["`jog` was refused".into()];
        RunResult::judged(RunIdentity::default(), &recording, &metrics, &verdict)
    }

    #[test]
    fn a_broken_requirement_fails_without_any_limit() {
        let why = "the load ended 200 mm short of 200 mm".to_owned();
        let broken = verdict_of((Standing::Broken, vec![why.clone()]), &[], vec![]);
        assert_eq!((broken.verdict, broken.reasons.as_slice()), (Outcome::Failed, &[format!("arrives: {why}")][..]));
        let lifted = verdict_of((Standing::Lifted, vec![why]), &[], vec![]);
        assert_eq!((lifted.verdict, lifted.reasons.len()), (Outcome::Unjudged, 0));
        let limit = [Limit::at_most(Name::FollowingErrorPeakLoad, 1.0)];
        assert_eq!(verdict_of((Standing::Met, vec![]), &limit, vec![]).verdict, Outcome::Passed);
        let json = value(&Results::new(vec![broken, lifted]));
        assert_eq!(json["scenarios"][0]["requirements"]["arrives"]["standing"], "broken");
        assert_eq!(json["scenarios"][0]["requirements"]["executed"]["standing"], "not_asked");
        assert_eq!(json["scenarios"][1]["requirements"]["arrives"]["standing"], "lifted");
        assert_eq!(json["scenarios"][1]["warnings"], json!(["`jog` was refused"]));
    }

    #[test]
    fn an_expected_fault_judges_a_run() {
        let expectation = Expectation {
            on: Occasion::Fault { fault: "8611h".into(), who: "drive".into() },
            from: 0.5,
            to: f64::INFINITY,
        };
        let of =
            |met| verdict_of((Standing::Met, vec![]), &[], vec![Expected { expectation: expectation.clone(), met }]);
        let (missing, came) = (of(None), of(Some(0.75)));
        assert_eq!((missing.verdict, came.verdict), (Outcome::Failed, Outcome::Passed));
        assert_eq!(missing.reasons, ["expected, but did not occur: 8611h of `drive` from 0.5 s on"]);
        assert_eq!(missing.expected[0].words(), "8611h of `drive` from 0.5 s on");
        let json = value(&Results::new(vec![came]));
        let expected = json!({ "fault": "8611h", "who": "drive", "from": 0.5, "to": null, "met_at": 0.75 });
        assert_eq!(json["scenarios"][0]["expected"], json!([expected]));
    }

    #[test]
    fn limits_know_their_line() {
        let run = judged();
        let line = |name: &str| run.metrics.get(name).unwrap().line;
        assert_eq!((line("following_error_peak_load"), line("settling_time")), (Some(31), Some(32)));
        assert_eq!(line("setpoint_velocity_ratio"), None, "it has no limit");
    }

    /// Fields that version 1 lacks are empty, and its word for invalid input is understood.
    #[test]
    fn the_version_before_is_read() {
        let mut old = value(&samples::results());
        old["schema"] = json!("servobench-results/1");
        for run in old["scenarios"].as_array_mut().unwrap() {
            let run = run.as_object_mut().unwrap();
            for key in ["requirements", "expected", "warnings", "parameters", "files"] {
                run.remove(key);
            }
            if run["verdict"] == "invalid" {
                run.insert("verdict".into(), json!("input"));
            }
        }
        let read = Results::from_json(&old.to_string()).unwrap();
        assert_eq!(read.scenarios[0].files, ["lambrechts-jerk.exact.parquet"]);
        assert_eq!((&read as &dyn crate::runs::Runs).count_of(Outcome::Invalid), 1);
        assert_eq!(read.schema, "servobench-results/3");
    }

    #[test]
    fn another_schema_is_refused_by_name() {
        let refusal = |schema: &str| {
            let text = samples::results().to_json().unwrap().replace("servobench-results/3", schema);
            Results::from_json(&text).unwrap_err().to_string()
        };
        assert_eq!(
            refusal("servobench-results/4"),
            "the results have schema `servobench-results/4`, newer than this build, which reads versions 1 to 3; use the \
             servobench that wrote them, or run the scenarios again"
        );
        for other in ["servobench-results/0", "servobench-results/x", "sarif"] {
            assert_eq!(refusal(other), format!("the file has schema `{other}`, which is none of servobench's results"));
        }
        assert!(matches!(Results::from_json("{}"), Err(ResultsError::Json(_))));
    }
}
