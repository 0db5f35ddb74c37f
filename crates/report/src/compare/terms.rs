//! Criteria for a difference between two runs: more than matters, more than can be seen, and more than chance.
//!
//! ```text
//! equal    |a − b| ≤ max(1 % of the larger; 1 % of the smallest limit; for lengths 1 % of the window or one increment)
//! chance   |ā − b̄| ≤ 3·√(s_a² + s_b²)   of at least five seeds each, mean ā and standard deviation s_a
//! ```
//! √(s_a² + s_b²) is the standard deviation of the difference of two single runs. That of means of five is √5 times smaller: between two
//! sets of seeds of one machine, chance makes a difference where Student's t with 8 degrees of freedom exceeds 6.7, once in 6 000 times.
use super::relation::{Relation, SAME};
use super::{Compared, Comparison, Noise, Value};
use servobench_metrics::Name;
use servobench_results::RunResult;

/// Seeds below which a spread is not known well enough.
pub(super) const SEEDS: usize = 5;
/// Standard deviations of a difference within which it is chance.
const BY_CHANCE: f64 = 3.0;

impl Compared<'_> {
    /// True if the run has random numbers and too few seeds to know their effect.
    pub(super) fn has_unknown_noise(&self) -> bool {
        matches!(self.noise, Noise::Seeds(others) if others.len() + 1 < SEEDS)
    }

    /// Mean and standard deviation of a metric over the seeds; `None` without random numbers, with too few seeds, or where a seed
    /// lacks the metric.
    fn spread(&self, of: impl Fn(&RunResult) -> Option<f64>) -> Option<(f64, f64)> {
        let values = self.seeds().map(of).collect::<Option<Vec<f64>>>()?;
        let n = values.len() as f64;
        if values.len() < SEEDS {
            return None;
        }
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        Some((mean, (squares / (n - 1.0)).sqrt()))
    }
}

impl<'a> Comparison<'a> {
    /// Relation of a metric of `this` to that of `other`; `None` where one lacks it.
    pub(super) fn relation(&self, name: Name, this: &Compared<'a>, other: &Compared<'a>) -> Option<Relation> {
        let both = [this.metric(name)?, other.metric(name)?];
        let limits = self.runs.iter().filter_map(|run| run.result.metrics.get(name.as_str())?.limit);
        let limit = limits.fold(f64::INFINITY, f64::min);
        let of = |run: &RunResult| run.metric(name).map(|(value, _)| value.abs());
        Some(self.stands(both, if limit.is_finite() { limit } else { 0.0 }, [this, other], of))
    }

    /// Relation of the program times of `this` and `other`. A run that never reaches its target is later than all others.
    pub(super) fn arrival(&self, this: &Compared<'a>, other: &Compared<'a>) -> Option<Relation> {
        let both = [this.arrival()?, other.arrival()?];
        Some(self.stands(both, 0.0, [this, other], super::arrival::of))
    }

    fn stands(
        &self,
        [this, other]: [Value<'_>; 2],
        limit: f64,
        runs: [&Compared<'a>; 2],
        of: impl Fn(&RunResult) -> Option<f64>,
    ) -> Relation {
        let plain = Relation::of(other.0, this.0);
        let is_length = matches!(this.1, "m" | "rad");
        let known = (SAME * limit).max(if is_length { self.length } else { 0.0 });
        if plain == Relation::Same || (this.0.abs() - other.0.abs()).abs() <= known {
            return Relation::Same;
        }
        if runs.iter().all(|run| matches!(run.noise, Noise::None)) {
            return plain;
        }
        // A run without random numbers is the same with every seed.
        let spread = |run: &Compared<'a>, own: f64| match run.noise {
            Noise::None => Some((own.abs(), 0.0)),
            Noise::Seeds(_) => run.spread(&of),
        };
        match (spread(runs[0], this.0), spread(runs[1], other.0)) {
            (Some((one, s)), Some((two, t))) if (one - two).abs() > BY_CHANCE * s.hypot(t) => plain,
            _ => Relation::Chance,
        }
    }
}
