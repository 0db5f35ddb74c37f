//! Shortest basis of vibration, settling and rest: two periods of the slowest mode, and enough rows.
use crate::absence::Absence;
use crate::measure::Question;
use crate::metric::{MetricSet, Metrics};
use crate::name::Name;
use servobench_base::Rate;
use servobench_trace::Recording;
use std::ops::Range;

/// Periods of the slowest mode: a single one cannot be distinguished from a drift.
const PERIODS: f64 = 2.0;
/// Shortest basis (s): about as long as the motion of a rigid axis after its profile takes to show.
const SHORTEST: f64 = 20e-3;
/// Fewest rows.
const ROWS: u32 = 20;

impl Question {
    /// Shortest recorded time after a profile (s), with rows at `rate`, for a metric of vibration, of settling or of rest: two
    /// periods of `mode`, or else of the lowest mode of the model, 20 ms, and 20 rows.
    #[must_use]
    pub fn basis(&self, rate: Rate) -> f64 {
        self.seen().max(f64::from(ROWS) * rate.period())
    }

    /// The same, whatever the rows.
    fn seen(&self) -> f64 {
        self.mode.or(self.lowest_mode).map_or(0.0, |mode| PERIODS / mode).max(SHORTEST)
    }

    /// Lowest rate (Hz) at which rows are measured in place of every tick: 20 of them in the shortest basis.
    #[must_use]
    pub fn coarsest_rate(&self) -> f64 {
        f64::from(ROWS) / self.seen()
    }
}

/// Checks that `rows` of `recording` are a basis.
///
/// # Errors
/// [`Absence::NothingRecorded`] without a row, [`Absence::RestTooShort`].
pub(crate) fn of(recording: &Recording, rows: &Range<usize>, question: &Question) -> Result<(), Absence> {
    let (period, needed) = (recording.rate.period(), question.basis(recording.rate));
    if rows.is_empty() {
        return Err(Absence::NothingRecorded { part: "between the profile and the next move" });
    }
    // A profile and the next move may both begin between two rows.
    if (rows.len() + 1) as f64 * period >= needed && rows.len() >= ROWS as usize {
        Ok(())
    } else {
        Err(Absence::RestTooShort { rest: rows.len() as f64 * period, needed })
    }
}

/// Withholds metrics of rows that stand for many ticks each and are too far apart.
pub(crate) fn withhold(metrics: &mut Metrics, recording: &Recording, question: &Question) {
    let (rate, needed) = (recording.rate.hertz(), question.coarsest_rate());
    let is_thinned = question.base_rate.is_some_and(|base| base.hertz() > rate);
    if is_thinned && f64::from(rate) < needed {
        let moves = metrics.moves.iter_mut().map(|made| &mut made.metrics);
        for set in moves.chain([&mut metrics.run]) {
            withhold_in(set, &Absence::TooFewRows { rate: f64::from(rate), needed });
        }
    }
}

fn withhold_in(set: &mut MetricSet, why: &Absence) {
    for name in Name::ALL.iter().filter(|name| name.is_of_rows()) {
        if set.get(*name).is_some() {
            set.withhold(*name, why.clone());
        }
    }
}
