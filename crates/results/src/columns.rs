//! Measurements of a suite, a column for each metric.
use crate::journal::JournalError;
use crate::results::Outcome;
use crate::runs::Runs;
use servobench_metrics::Name;

/// Outcomes and metrics of the runs of a suite, by their places in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// Outcome of each run; `None`: it has not ended.
    pub outcomes: Vec<Option<Outcome>>,
    /// True for runs that did not meet a requirement, broken or lifted.
    pub broken: Vec<bool>,
    /// All metrics that were measured in any run, in the order of tables.
    pub metrics: Vec<MetricColumn>,
}

/// A metric of all runs.
#[derive(Debug, Clone, PartialEq)]
pub struct MetricColumn {
    /// The metric.
    pub metric: Name,
    /// Unit of the values.
    pub unit: String,
    /// Values (SI); NaN where it was not measured.
    pub values: Vec<f64>,
}

impl Columns {
    /// Columns of `runs`, of which there are `count` when all have ended.
    ///
    /// # Errors
    /// [`JournalError`] if a result cannot be read.
    pub fn of(runs: &dyn Runs, count: usize) -> Result<Self, JournalError> {
        let mut columns = Self { outcomes: vec![None; count], broken: vec![false; count], metrics: Vec::new() };
        for head in runs.heads().filter(|head| head.index < count) {
            let run = runs.result(head.index)?;
            columns.outcomes[head.index] = Some(run.verdict);
            columns.broken[head.index] = run.not_met().next().is_some();
            for (name, metric) in &run.metrics {
                let (Some(value), Ok(name)) = (metric.value, name.parse()) else { continue };
                columns.of_metric(name, &metric.unit).values[head.index] = value;
            }
        }
        columns.metrics.sort_by_key(|column| column.metric);
        Ok(columns)
    }

    fn of_metric(&mut self, metric: Name, unit: &str) -> &mut MetricColumn {
        let place = self.metrics.iter().position(|column| column.metric == metric).unwrap_or_else(|| {
            let values = vec![f64::NAN; self.outcomes.len()];
            self.metrics.push(MetricColumn { metric, unit: unit.to_owned(), values });
            self.metrics.len() - 1
        });
        &mut self.metrics[place]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Results, samples};

    #[test]
    fn each_metric_has_a_column_with_a_value_where_it_was_measured() {
        let (jerk, broken, snap) = (samples::jerk(), samples::broken(), samples::snap());
        let time = |run: &crate::RunResult| run.metric(Name::MoveTime).unwrap().0;
        let expected = [time(&jerk), time(&snap)];
        let results = Results::new(vec![jerk, broken, snap]);
        let columns = Columns::of(&results, 4).unwrap();
        assert_eq!(columns.broken, [false; 4]);
        assert_eq!(columns.outcomes[1..], [Some(Outcome::Error), Some(results.scenarios[2].verdict), None]);
        let found = &columns.metrics[0];
        assert_eq!((found.metric, found.unit.as_str()), (Name::MoveTime, "s"));
        assert_eq!([found.values[0], found.values[2]].map(f64::to_bits), expected.map(f64::to_bits));
        assert!(found.values[1].is_nan() && found.values[3].is_nan());
        assert!(columns.metrics.is_sorted_by_key(|column| column.metric));
    }
}
