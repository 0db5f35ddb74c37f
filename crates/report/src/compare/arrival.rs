//! Program time of a run: from t = 0 to the instant at which the last target is reached for good.
use super::{Compared, Value};
use servobench_metrics::Name;
use servobench_results::RunResult;

/// Name of the metric in results.
const PROGRAM_TIME: &str = "program_time";
/// Words of [`servobench_metrics::Absence::NotSettled`] in results.
const NOT_SETTLED: &str = "has not settled";

/// Time at which `run` reaches its last target for good (s); infinite if a load does not settle although a window requires it. Results
/// older than the metric have the ends of their moves and the settling times. `None` if nothing moves from rest to rest.
pub(super) fn of(run: &RunResult) -> Option<f64> {
    let never = is_unsettled(run).then_some(f64::INFINITY);
    if let Some(time) = run.metrics.get(PROGRAM_TIME).and_then(|metric| metric.value) {
        return Some(time);
    }
    let settling = Name::SettlingTime.as_str();
    let ends = run
        .moves
        .iter()
        .map(|made| made.end + made.metrics.get(settling).and_then(|metric| metric.value).unwrap_or_default());
    let time = |name: Name| run.metric(name).map(|(value, _)| value);
    let last = ends.reduce(f64::max).or_else(|| time(Name::MoveAndSettlingTime)).or_else(|| time(Name::MoveTime));
    last.map(|last| never.unwrap_or(last))
}

/// True for a run that moves, has a window, and does not settle.
fn is_unsettled(run: &RunResult) -> bool {
    let is_missing = run.metric(Name::SettlingTime).is_none() && run.metric(Name::MoveTime).is_some();
    let why = run.absent.get(Name::SettlingTime.as_str());
    is_missing && why.is_some_and(|why| why.contains(NOT_SETTLED))
}

impl<'a> Compared<'a> {
    /// Time at which the run reaches its last target for good.
    pub(super) fn arrival(&self) -> Option<Value<'a>> {
        of(self.result).map(|time| (time, "s"))
    }

    /// True for a program of at most one move that starts at t = 0.
    pub(super) fn is_one_move(&self) -> bool {
        match self.result.moves.as_slice() {
            [] => true,
            [one] => one.start <= 0.0,
            _ => false,
        }
    }
}
