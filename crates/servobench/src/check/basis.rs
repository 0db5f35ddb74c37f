//! Limits on metrics for which a run is too short, or its rows too far apart.
use super::Objection;
use crate::question::question;
use crate::size::is_thinned;
use servobench_metrics::{Limit, Quantity, Question, Scope};
use servobench_scenario::{Scenario, Step};
use servobench_sim::{Program, run_length};
use servobench_trace::Move;

/// Milliseconds that are rounding.
const ROUNDING: f64 = 1e-6;

/// Limits of `scenario` that no run of it can keep, because their metrics cannot be measured.
pub(super) fn objections(scenario: &Scenario) -> Vec<Objection> {
    let Ok(planned) = Program::new(scenario) else { return Vec::new() };
    let question = question(scenario);
    let mut found = too_few_rows(scenario, &question);
    let moves: Vec<Move> = planned.moves().collect();
    let run = Planned { scenario, question, length: run_length(scenario, &planned), moves };
    found.extend(scenario.limits.iter().filter_map(|limit| run.too_short(limit)));
    let steps = scenario.program.iter().enumerate().filter_map(|(index, step)| match step {
        Step::Move(step) => Some((index, &step.metric_limits)),
        Step::Wait(_) => None,
    });
    for ((index, limits), made) in steps.zip(0..run.moves.len()) {
        found.extend(limits.iter().filter_map(|limit| run.too_short_after(made, index, limit)));
    }
    found
}

/// A planned run.
struct Planned<'a> {
    scenario: &'a Scenario,
    question: Question,
    /// Length (s).
    length: f64,
    moves: Vec<Move>,
}

impl Planned<'_> {
    /// Objection where the last rest, or the one that `measure.from` begins, is too short for `limit`.
    fn too_short(&self, limit: &Limit) -> Option<Objection> {
        let name = limit.metric;
        let from = self.question.from.filter(|_| name.scope() == Scope::AfterMove);
        let begins = from.or(self.moves.last().map(|made| made.end))?;
        let next = self.moves.iter().map(|made| made.start).find(|start| *start > begins);
        let key = format!("limits.{name}");
        let needed = self.lacking(limit, next.unwrap_or(self.length) - begins)?;
        let help = match next {
            Some(_) => format!("give a `wait` of {} there, or a later `measure.from`", seconds(needed)),
            None => format!("give `run.duration` at least {}", seconds(begins + needed)),
        };
        Some(self.objection(key, limit, next.unwrap_or(self.length) - begins, help))
    }

    /// Objection where the rest after move number `made`, step `index` of the program, is too short for its `limit`.
    fn too_short_after(&self, made: usize, index: usize, limit: &Limit) -> Option<Objection> {
        let (end, next) = (self.moves[made].end, self.moves.get(made + 1).map(|next| next.start));
        let rest = next.unwrap_or(self.length) - end;
        let needed = self.lacking(limit, rest)?;
        let help = match next {
            Some(_) => format!("give a `wait` of at least {} after it", seconds(needed)),
            None => format!("give `run.duration` at least {}", seconds(end + needed)),
        };
        Some(self.objection(format!("program.{index}.limits.{}", limit.metric), limit, rest, help))
    }

    /// Duration of rest that `limit` needs (s); `None` where `rest` (s) is long enough.
    fn lacking(&self, limit: &Limit, rest: f64) -> Option<f64> {
        let rate = self.scenario.base_rate;
        let needed = self.question.basis(rate);
        // An instant more or less is one of rounding.
        (limit.metric.needs_basis() && rest + rate.period() < needed).then_some(needed)
    }

    fn objection(&self, key: String, limit: &Limit, rest: f64, help: String) -> Objection {
        let needed = self.question.basis(self.scenario.base_rate);
        let why = match self.question.mode.or(self.question.lowest_mode) {
            Some(mode) if 2.0 / mode >= needed => format!("two periods of {}", Quantity::new(mode, "Hz")),
            _ => "20 ms and 20 rows at least".to_owned(),
        };
        let rest = if rest > 0.0 { format!("{} are", seconds(rest)) } else { "nothing is".to_owned() };
        let message =
            format!("`{}` is measured over {}, {why}, of which {rest} in the run", limit.metric, seconds(needed));
        Objection { key, line: None, message, help }
    }
}

/// Limits on metrics whose rows are too far apart.
fn too_few_rows(scenario: &Scenario, question: &Question) -> Vec<Objection> {
    let (rate, needed) = (scenario.record.rate.hertz(), question.coarsest_rate());
    if !is_thinned(scenario) || f64::from(rate) >= needed {
        return Vec::new();
    }
    let limits = scenario.limits.iter().filter(|limit| limit.metric.is_of_rows());
    let object = |limit: &Limit| Objection {
        key: format!("limits.{}", limit.metric),
        line: None,
        message: format!(
            "`{}` would be measured from rows at {}, because every tick takes too much memory: {} are needed",
            limit.metric,
            Quantity::new(f64::from(rate), "Hz"),
            Quantity::new(needed, "Hz")
        ),
        help: "shorten the run, raise `record.rate`, or name fewer `record.channels`".to_owned(),
    };
    limits.map(object).collect()
}

/// A time that is enough, to whole milliseconds.
fn seconds(time: f64) -> String {
    format!("{} s", (time * 1e3 - ROUNDING).ceil() / 1e3)
}
