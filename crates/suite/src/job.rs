//! One scenario on one engine.
use servobench_scenario::{EngineName, Scenario, Step};
use std::collections::HashMap;

/// One scenario on one engine.
#[derive(Debug, Clone)]
pub struct Job {
    /// Name of the run, unique among its siblings and fit for a file: `feed-axis-move.exact`.
    pub id: String,
    /// The scenario.
    pub scenario: Scenario,
    /// Text of its file: what a worker process is given.
    pub text: String,
    /// The engine.
    pub engine: EngineName,
    /// Durations that the moves are slowed to (s), one for each move; empty: as the scenario says. A worker process is
    /// told them beside the text.
    pub durations: Vec<f64>,
}

impl Job {
    /// Slows the moves to `durations` (s), one for each move.
    pub fn slow_to(&mut self, durations: Vec<f64>) {
        slow_to(&mut self.scenario, &durations);
        self.durations = durations;
    }
}

/// Slows the moves of `scenario` to `durations` (s); a duration of zero leaves its move alone.
pub(crate) fn slow_to(scenario: &mut Scenario, durations: &[f64]) {
    let moves = scenario.program.iter_mut().filter_map(|step| match step {
        Step::Move(step) => Some(step),
        Step::Wait(_) => None,
    });
    for (step, duration) in moves.zip(durations) {
        if *duration > 0.0 {
            step.duration = Some(*duration);
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
    let mut taken: HashMap<String, u32> = HashMap::new();
    let mut jobs = Vec::new();
    for Source { scenario, text } in sources {
        let wanted = if engines.is_empty() { scenario.engines.clone() } else { engines.to_vec() };
        for engine in wanted {
            let id = format!("{}.{}", file_name(&scenario.name), engine.as_str());
            let count = taken.entry(id.clone()).or_default();
            *count += 1;
            let id = if *count == 1 { id } else { format!("{id}.{count}") };
            jobs.push(Job { id, scenario: scenario.clone(), text: text.clone(), engine, durations: Vec::new() });
        }
    }
    jobs
}

/// `name` with everything but letters, digits, `-`, `_` and `.` made a `-`.
fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect()
}
