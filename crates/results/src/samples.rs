//! Results for the tests: Lambrechts' move under two limits, a run that missed limits, one that broke off.
use crate::digest::Digest;
use crate::entry::{ExpectedResult, MetricResult};
use crate::results::{Outcome, Results};
use crate::run::RunResult;
use indexmap::IndexMap;
use servobench_base::Severity;
use servobench_files::{FileRole, MadeOf};
use servobench_metrics::{Name, RequirementResult, Standing};
use servobench_trace::{Ending, Event, LogEntry, Move};

/// A metric without a limit.
fn free(name: Name, value: f64, unit: &str) -> (String, MetricResult) {
    let metric =
        MetricResult { value: Some(value), unit: unit.into(), limit: None, limit_min: None, pass: None, line: None };
    (name.to_string(), metric)
}

/// A metric with an upper limit.
fn limited(name: Name, value: Option<f64>, unit: &str, limit: f64) -> (String, MetricResult) {
    let pass = Some(value.is_some_and(|value| value <= limit));
    (name.to_string(), MetricResult { value, unit: unit.into(), limit: Some(limit), limit_min: None, pass, line: None })
}

/// A passed run with these metrics.
#[must_use]
pub fn run(name: &str, engine: &str, metrics: impl IntoIterator<Item = (String, MetricResult)>) -> RunResult {
    RunResult {
        name: name.into(),
        file: Some(format!("scenarios/{name}.toml")),
        engine: engine.into(),
        axis: None,
        inputs: Digest::of(name.as_bytes()),
        made_of: vec![MadeOf::of_bytes(format!("{name}.toml"), FileRole::Scenario, name.as_bytes())],
        verdict: Outcome::Unjudged,
        duration: 2.0,
        reasons: vec![],
        requirements: requirements([("arrives", Standing::Met, vec![])]),
        expected: vec![],
        optional_calls: vec![],
        warnings: vec![],
        check_warnings: Some(vec![]),
        parameters: [("drive.velocity.bandwidth".to_owned(), "30 Hz".to_owned())].into_iter().collect(),
        overrides: vec![],
        metrics: metrics.into_iter().collect(),
        absent: [("current_peak".to_owned(), "`current.d` is not recorded; only a PMSM has a current".to_owned())]
            .into_iter()
            .collect(),
        moves: vec![],
        events: vec![],
        log: vec![],
        recording: Some(format!("{name}.{engine}.parquet")),
        recording_seal: Some("ef46db3751d8e999".into()),
        files: vec![format!("{name}.{engine}.parquet")],
    }
}

/// Requirements with their standings and reasons.
#[must_use]
pub fn requirements<const N: usize>(all: [(&str, Standing, Vec<String>); N]) -> IndexMap<String, RequirementResult> {
    let all = all.into_iter();
    all.map(|(name, standing, reasons)| (name.to_owned(), RequirementResult { standing, reasons })).collect()
}

/// A run with these numbers: move, settling (s), error, peak-to-peak (m), frequency (Hz), damping, force (N).
#[must_use]
pub fn of_numbers(name: &str, numbers: [f64; 8]) -> RunResult {
    let [time, settling, error, vibration, frequency, damping, peak, rms] = numbers;
    run(
        name,
        "exact",
        [
            free(Name::MoveTime, time, "s"),
            free(Name::SettlingTime, settling, "s"),
            free(Name::MoveAndSettlingTime, time + settling, "s"),
            free(Name::FollowingErrorPeakLoad, error, "m"),
            free(Name::ResidualVibrationPp, vibration, "m"),
            free(Name::ResidualVibrationAmplitude, vibration / 2.0, "m"),
            free(Name::ResidualVibrationFrequency, frequency, "Hz"),
            free(Name::ResidualVibrationDamping, damping, ""),
            free(Name::TorquePeak, peak, "N"),
            free(Name::TorqueRms, rms, "N"),
        ],
    )
}

/// Lambrechts' set-point: 1 m at 1 m/s, 5 m/s², 50 m/s³, and at order 4 1000 m/s⁴, all of which it reaches.
#[must_use]
pub fn lambrechts_move(order: usize) -> Move {
    let limits = [1.0, 5.0, 50.0, 1000.0];
    let mut made = Move {
        label: format!("move from 0 m to 1 m, order {order}"),
        start: 0.0,
        end: if order == 3 { 1.3 } else { 1.35 },
        from: 0.0,
        to: 1.0,
        peaks: limits,
        limits: limits.map(Some),
        cruise: (0.35, 0.65),
        ending: Ending::AtRest,
    };
    made.peaks[order..].fill(f64::INFINITY);
    made.limits[order..].fill(None);
    made
}

/// The jerk-limited move.
#[must_use]
pub fn jerk() -> RunResult {
    of_numbers("lambrechts-jerk", [1.3, 0.004, 3.1e-6, 3.4e-6, 38.985, 0.0021, 170.0, 61.2])
}

/// The snap-limited move.
#[must_use]
pub fn snap() -> RunResult {
    of_numbers("lambrechts-snap", [1.35, 0.0, 0.73e-6, 0.21e-6, 38.985, 0.0021, 169.0, 60.0])
}

/// A run that missed three limits, one of which could not be measured.
#[must_use]
pub fn missed() -> RunResult {
    let mut run = run(
        "feed-axis-reversal-at-low-speed-with-stick-slip",
        "mujoco",
        [
            free(Name::MoveTime, 0.5, "s"),
            limited(Name::SettlingTime, Some(0.0352), "s", 0.02),
            limited(Name::FollowingErrorPeakLoad, Some(45.1e-6), "m", 50e-6),
            limited(Name::ResidualVibrationPp, Some(8.3e-6), "m", 2e-6),
            limited(Name::CurrentPeak, None, "", 10.0),
        ],
    );
    run.verdict = Outcome::Failed;
    if let Some(settling) = run.metrics.get_mut("settling_time") {
        settling.line = Some(31);
    }
    run.reasons = vec![
        "settling_time 35.2 ms, limit 20.0 ms".into(),
        "residual_vibration_pp 8.30 µm, limit 2.00 µm".into(),
        "current_peak could not be measured: `current.d` is not recorded; only a PMSM has a current".into(),
    ];
    run.events = vec![Event::bound(0.1, 0.2, "velocity loop", "effort limit", false)];
    run
}

/// A run that keeps its limit, with a drive at its limit for half a second.
#[must_use]
pub fn kept() -> RunResult {
    let mut run = run("kept", "exact", [limited(Name::MoveTime, Some(1.0), "s", 2.0)]);
    run.verdict = Outcome::Passed;
    run.requirements = requirements([
        ("arrives", Standing::Met, vec![]),
        ("executed", Standing::NotAsked, vec![]),
        ("bounded", Standing::Lifted, vec![]),
    ]);
    run.events = vec![Event::bound(0.1, 0.6, "current loop", "voltage limit", false)];
    run.log = vec![LogEntry {
        source: "FMU load".into(),
        severity: Severity::Warning,
        start: 0.2,
        end: 0.2,
        times: 1,
        text: "the valve is closed against a pressure of more than 2 bar".into(),
    }];
    run
}

/// A run that keeps its limit, breaks two requirements, and lacks an expected fault.
#[must_use]
pub fn short() -> RunResult {
    let mut run = run("pick", "exact", [limited(Name::MoveTime, Some(0.65), "s", 2.0)]);
    run.verdict = Outcome::Failed;
    let short = "the load ended 200 mm short of 200 mm (window ±5 µm); effort limit bound for 1.99 s";
    let jog = "`jog` was never executed: `home.Done` did not come";
    run.requirements = requirements([
        ("arrives", Standing::Broken, vec![short.into()]),
        ("executed", Standing::Broken, vec![jog.into()]),
        ("stable", Standing::Lifted, vec!["the velocity loop has a pole outside the unit circle".into()]),
    ]);
    run.expected = vec![ExpectedResult {
        fault: Some("8611h".into()),
        who: Some("drive".into()),
        event: None,
        from: 0.5,
        to: None,
        met_at: None,
    }];
    run.reasons = vec![
        format!("arrives: {short}"),
        format!("executed: {jog}"),
        "expected, but did not occur: 8611h of `drive` from 0.5 s on".into(),
    ];
    run.warnings = vec!["two frames were lost".into()];
    run.events =
        vec![Event::bound(0.01, 2.0, "velocity loop", "effort limit", false), Event::new(2.0, 2.0, "PLC", jog)];
    run
}

/// A scenario that cannot be built.
#[must_use]
pub fn wrong() -> RunResult {
    let mut run = broken();
    run.verdict = Outcome::Invalid;
    run.log.clear();
    run.requirements = IndexMap::new();
    run.reasons = vec!["`axis.mjcf.file`: there is no `arm.xml`".into()];
    run
}

/// A run that broke off.
#[must_use]
pub fn broken() -> RunResult {
    let mut run = run("two-mass", "rapier", []);
    run.verdict = Outcome::Error;
    run.reasons = vec![
        "the mechanics diverged at 0.123 s: the position of `load` is not finite; take a smaller step than 1.00 ms"
            .into(),
    ];
    run.absent = [].into_iter().collect();
    let said = |severity: Severity, time: f64, times: u64, text: &str| LogEntry {
        source: "FMU load".into(),
        severity,
        start: 0.001,
        end: time,
        times,
        text: text.into(),
    };
    run.log = vec![
        said(Severity::Info, 0.001, 1, "solver: Gear, order 5"),
        said(
            Severity::Warning,
            0.122,
            121,
            "Newton's method did not converge within 10 iterations; a smaller step is taken",
        ),
        said(Severity::Error, 0.123, 1, "the pressure in `tank.p` is negative"),
    ];
    run
}

/// All sample results.
#[must_use]
pub fn results() -> Results {
    Results::new(vec![jerk(), missed(), kept(), snap(), broken(), wrong(), short()])
}
