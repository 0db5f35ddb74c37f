//! Runs side by side: a table, and what it says in words.
//!
//! Differences within one per cent are none. A ratio of vibrations never stands alone: what it costs in time and torque
//! follows, and at which frequency and damping it holds.
mod relation;
mod table;
mod words;

use crate::results::{Outcome, RunResult};
use crate::text::wrapped;

/// A run under the name that it has in the comparison.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// `jerk`, `snap`.
    pub label: &'a str,
    /// Its results.
    pub result: &'a RunResult,
}

/// Two or more runs of the same axis.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    runs: Vec<Compared<'a>>,
}

/// Value (SI) and unit.
type Value<'a> = (f64, &'a str);

impl<'a> Comparison<'a> {
    /// Compares `runs`; the first is the one that the others are held against.
    #[must_use]
    pub const fn new(runs: Vec<Compared<'a>>) -> Self {
        Self { runs }
    }

    /// Which run missed which of its own limits, in lines that fit `width`; empty when all kept them.
    #[must_use]
    pub fn missed(&self, width: usize) -> String {
        let failed = self.runs.iter().filter(|run| run.result.verdict == Outcome::Failed);
        let lines = failed.flat_map(|run| {
            let reasons = run.result.reasons.iter();
            reasons.flat_map(|reason| wrapped(&format!("{} missed a limit: {reason}", run.label), width))
        });
        lines.map(|line| line + "\n").collect()
    }
}

/// What an effort in `unit` is called.
fn force_or_torque(unit: &str) -> &'static str {
    if unit == "N" { "force" } else { "torque" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{jerk, missed};

    #[test]
    fn missed_limits_are_said_of_the_run_that_missed_them() {
        let (jerk, slow) = (jerk(), missed());
        let runs = vec![Compared { label: "jerk", result: &jerk }, Compared { label: "slow", result: &slow }];
        insta::assert_snapshot!(Comparison::new(runs).missed(76), @r#"
        slow missed a limit: settling_time 35.2 ms, limit 20.0 ms
        slow missed a limit: residual_vibration_pp 8.30 µm, limit 2.00 µm
        slow missed a limit: current_peak could not be measured: the recording has
        no channel `current.d`
        "#);
        let kept = vec![Compared { label: "jerk", result: &jerk }; 2];
        assert_eq!(Comparison::new(kept).missed(76), "");
    }
}
