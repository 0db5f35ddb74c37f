//! When a run has done its program: from t = 0 to the last target that is reached for good.
use super::{Compared, Value};
use servobench_metrics::Name;
use servobench_results::RunResult;

/// Name of the metric in results.
const PROGRAM_TIME: &str = "program_time";
/// Words of [`servobench_metrics::Absence::NotSettled`] in results.
const NOT_SETTLED: &str = "has not settled";

/// When the last target of `run` is reached for good (s); infinite where a load does not settle although a window asks for it. Results of
/// before the metric have the ends of their moves and the settling times. `None` where nothing moves from rest to rest.
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

/// True of a run that moves, has a window, and does not settle.
fn is_unsettled(run: &RunResult) -> bool {
    let is_missing = run.metric(Name::SettlingTime).is_none() && run.metric(Name::MoveTime).is_some();
    let why = run.absent.get(Name::SettlingTime.as_str());
    is_missing && why.is_some_and(|why| why.contains(NOT_SETTLED))
}

impl<'a> Compared<'a> {
    /// When its last target is reached for good.
    pub(super) fn arrival(&self) -> Option<Value<'a>> {
        of(self.result).map(|time| (time, "s"))
    }

    /// True of a program that begins with a move and ends with it.
    pub(super) fn is_one_move(&self) -> bool {
        match self.result.moves.as_slice() {
            [] => true,
            [one] => one.start <= 0.0,
            _ => false,
        }
    }
}
