//! One scenario on one engine.
use servobench::run::limits_of_moves;
use servobench_metrics::Name;
use servobench_plant::{EngineName, ModelKind};
use servobench_scenario::{AxisMechanics, Scenario, Step};
use servobench_sim::Program;
use std::collections::{HashMap, HashSet};

/// One scenario on one engine.
#[derive(Debug, Clone)]
pub struct Job {
    /// Name of the run, unique among its siblings and fit for a file: `feed-axis-move.exact`.
    pub id: String,
    /// The scenario.
    pub scenario: Scenario,
    /// Text of its file, which a worker process receives.
    pub text: String,
    /// The engine.
    pub engine: EngineName,
    /// Its name beside other runs; `None`: that of its scenario.
    label: Option<String>,
    /// Durations from [`Job::slow_to`]. A worker process receives them beside the text.
    durations: Vec<f64>,
    /// True if the recording is needed, and not only its metrics.
    keeps_recording: bool,
    /// Metrics that are needed; `None`: all.
    wanted: Option<Vec<Name>>,
}

impl Job {
    /// The scenario of `source` on `engine`, called `id`.
    #[must_use]
    pub fn new(id: String, source: Source, engine: EngineName) -> Self {
        let Source { scenario, text } = source;
        Self { id, scenario, text, engine, label: None, durations: Vec::new(), keeps_recording: true, wanted: None }
    }

    /// The same job for another scenario, called `id`; it is not slowed yet.
    pub(crate) fn of_source(&self, source: Source, id: String) -> Self {
        let Source { scenario, text } = source;
        Self { id, scenario, text, durations: Vec::new(), ..self.clone() }
    }

    /// Sets its name in messages to `label`: variants of one scenario share a name.
    pub fn call(&mut self, label: String) {
        self.label = Some(label);
    }

    /// Its name in messages.
    #[must_use]
    pub fn label(&self) -> &str {
        self.label.as_deref().unwrap_or(&self.scenario.name)
    }

    /// Slows the moves to `durations` (s), one for each move.
    pub fn slow_to(&mut self, durations: Vec<f64>) {
        slow_to(&mut self.scenario, &durations);
        self.durations = durations;
    }

    /// Leaves the recording out: unless the scenario names channels, it then has only the signals that metrics are computed from. Metrics
    /// and verdict are the same.
    pub const fn leave_recording_out(&mut self) {
        self.keeps_recording = false;
    }

    /// Restricts measurement to these metrics, and those that the scenario limits.
    pub fn measure_only(&mut self, metrics: &[Name]) {
        self.wanted = Some(metrics.to_vec());
    }

    /// Metrics that are needed or limited; `None`: all.
    pub(crate) fn metrics(&self) -> Option<HashSet<Name>> {
        let limits = limits_of_moves(&self.scenario).flatten().chain(&self.scenario.limits);
        Some(self.wanted.as_ref()?.iter().copied().chain(limits.map(|limit| limit.metric)).collect())
    }

    /// True if all signals are recorded that the scenario requests.
    pub(crate) fn records_all(&self) -> bool {
        self.keeps_recording || !self.scenario.record.channels.is_empty()
    }

    /// Durations that the moves are slowed to (s), one for each move; empty: those of the scenario.
    pub(crate) fn durations(&self) -> &[f64] {
        &self.durations
    }

    /// True if it runs in a worker process: its engine can end the process that it runs in.
    pub(crate) fn runs_in_worker(&self) -> bool {
        let kind = match self.scenario.axis.mechanics {
            _ if self.engine.simulates(ModelKind::Fmu) => ModelKind::Fmu,
            AxisMechanics::Bodies(_) => ModelKind::Chain,
            AxisMechanics::Mjcf(_) => ModelKind::Mjcf,
            AxisMechanics::InTheFmu => ModelKind::Fmu,
        };
        self.engine.runs_in_worker(kind)
    }
}

/// Slows the moves of `scenario` to `durations` (s); a duration of zero leaves its move unchanged. The time after the program keeps its
/// length: a run of given length becomes longer by as much, and the start of a residual vibration measured after the program moves by as
/// much.
pub(crate) fn slow_to(scenario: &mut Scenario, durations: &[f64]) {
    let end = |scenario: &Scenario| Program::new(scenario).ok().map(|program| program.end());
    let has_times = scenario.duration.is_some() || scenario.measure.from.is_some();
    let before = if has_times { end(scenario) } else { None };
    slow_moves(scenario, durations);
    let Some((before, after)) = before.and_then(|before| Some((before, end(scenario)?))) else { return };
    let later = (after - before).max(0.0);
    if let Some(duration) = scenario.duration.as_mut().filter(|duration| **duration >= before) {
        *duration += later;
    }
    if let Some(from) = scenario.measure.from.as_mut().filter(|from| **from >= before) {
        *from += later;
    }
}

fn slow_moves(scenario: &mut Scenario, durations: &[f64]) {
    let moves = scenario.program.iter_mut().filter_map(|step| match step {
        Step::Move(step) => Some(step),
        Step::Wait(_) => None,
    });
    for (step, duration) in moves.zip(durations) {
        if *duration > 0.0 {
            step.request.duration = Some(*duration);
        }
    }
}

/// A scenario and the text it came from.
#[derive(Debug, Clone)]
pub struct Source {
    /// The scenario.
    pub scenario: Scenario,
    /// Text of its file.
    pub text: String,
}

/// Jobs for every scenario on every engine that it names, or on `engines` when that is not empty.
#[must_use]
pub fn jobs(sources: Vec<Source>, engines: &[EngineName]) -> Vec<Job> {
    let mut ids = JobIds::default();
    let mut jobs = Vec::new();
    for source in sources {
        let wanted = if engines.is_empty() { source.scenario.engines.clone() } else { engines.to_vec() };
        for engine in wanted {
            jobs.push(Job::new(ids.next(&source.scenario.name, engine), source.clone(), engine));
        }
    }
    jobs
}

/// Issues unique names of runs for [`Job::id`].
#[derive(Debug, Default)]
pub struct JobIds {
    taken: HashMap<String, u32>,
}

impl JobIds {
    /// The name of the next run of this scenario on this engine.
    pub fn next(&mut self, scenario: &str, engine: EngineName) -> String {
        let id = format!("{}.{engine}", file_name(scenario));
        let count = self.taken.entry(id.clone()).or_default();
        *count += 1;
        if *count == 1 { id } else { format!("{id}.{count}") }
    }
}

/// Largest length of a file name made from a scenario (B). File systems allow 255; engine, number and kind follow it, and while the file is
/// written the id of the process.
const LONGEST: usize = 150;

/// `name` as one part of a path, whatever it is: everything but letters, digits, `-`, `_` and `.` becomes a `-`. The result is not empty,
/// not hidden (`.x`), not a parent (`..`), and not too long for a file. Different names may become equal: callers that need unique ones
/// number them.
#[must_use]
pub fn file_name(name: &str) -> String {
    // Invisible characters of the category of letters: fillers of Hangul.
    let is_seen = |c: char| !matches!(c, '\u{115f}' | '\u{1160}' | '\u{3164}' | '\u{ffa0}');
    let is_kept = |c: char| c.is_alphanumeric() && is_seen(c) || "-_.".contains(c);
    let mut safe: String = name.chars().map(|c| if is_kept(c) { c } else { '-' }).collect();
    if safe.is_empty() || safe.starts_with('.') {
        safe.replace_range(..safe.len().min(1), "_");
    }
    safe.truncate(safe.floor_char_boundary(LONGEST));
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(text: &str) -> Job {
        let scenario = servobench_scenario::parse("test", text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        jobs(vec![Source { scenario, text: text.to_owned() }], &[]).remove(0)
    }

    const TEXT: &str = r#"
        engine = ["exact"]
        [run]
        base_rate = "1 kHz"
        duration = "2 s"
        [axis]
        motion = "linear"
        [axis.motor_side]
        mass = "20 kg"
        [motor]
        kind = "prescribed"
        [record]
        channels = ["load.position", "motor.position"]
    "#;

    /// A run of 3 s whose move takes 1 s has 2 s after it, slowed or not.
    #[test]
    fn what_follows_the_program_stays_as_long_as_it_was() {
        let text = TEXT.replace("duration = \"2 s\"", "duration = \"3 s\"").replace(
            "[record]",
            "[setpoint]\norder = 2\nvelocity = \"1 m/s\"\nacceleration = \"4 m/s2\"\n[[program]]\nmove_to = \"0.75 m\"\n[measure]\nfrom = \"1.5 s\"\n[record]",
        );
        let mut job = job(&text);
        job.slow_to(vec![1.25]);
        let Scenario { duration, measure, .. } = &job.scenario;
        let (duration, from) = (duration.unwrap(), measure.from.unwrap());
        assert!((duration - 3.25).abs() < 1e-12 && (from - 1.75).abs() < 1e-12, "{duration} {from}");
    }

    #[test]
    fn names_are_unique_and_fit_for_files() {
        let scenario = Scenario { name: "a/b c".into(), ..job(TEXT).scenario };
        let source = Source { scenario, text: String::new() };
        let jobs = jobs(vec![source.clone(), source], &[EngineName::Exact, EngineName::Rapier]);
        let ids: Vec<_> = jobs.iter().map(|job| job.id.as_str()).collect();
        assert_eq!(ids, ["a-b-c.exact", "a-b-c.rapier", "a-b-c.exact.2", "a-b-c.rapier.2"]);
    }

    /// Names that become equal stay two files, for every cause.
    #[test]
    fn names_that_become_equal_are_numbered() {
        let long = "µ".repeat(4000);
        let names = ["a/b", "a b", "a\nb", &long, &(long.clone() + "x"), "", "-"].map(str::to_owned);
        let scenario = job(TEXT).scenario;
        let source = |name| Source { scenario: Scenario { name, ..scenario.clone() }, text: String::new() };
        let jobs = jobs(names.map(source).to_vec(), &[EngineName::Exact]);
        let mut ids: Vec<_> = jobs.iter().map(|job| job.id.as_str()).collect();
        assert_eq!(ids[..3], ["a-b.exact", "a-b.exact.2", "a-b.exact.3"]);
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), 7);
    }

    #[test]
    fn a_name_of_a_file_is_one_part_of_a_path() {
        for (name, safe) in [
            ("feed-axis_2.µ", "feed-axis_2.µ"),
            ("../../outside/x", "_.-..-outside-x"),
            ("..", "_."),
            (".", "_"),
            ("", "_"),
            ("/etc/passwd", "-etc-passwd"),
            ("-rf", "-rf"),
            ("a\\b\0c\u{202e}d\u{3164}", "a-b-c-d-"),
            ("\u{1b}]0;x\u{7}", "--0-x-"),
        ] {
            assert_eq!(file_name(name), safe);
        }
        let long = file_name(&"µ€".repeat(1000));
        assert!((LONGEST - 2..=LONGEST).contains(&long.len()), "{}", long.len());
    }
}
