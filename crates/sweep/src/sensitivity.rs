//! Effect of each key on a metric.
//!
//! ```text
//! share of a key = Var(E(y | key)) / Var(y)                                                               (1)
//! between = Σ n_b (ȳ_b − ȳ)²,   within = Σ (y − ȳ_b)²   over bins b of equal count                        (2)
//! share ≈ (between − (K − 1)·within/(n − K)) / (between + within)                                         (3)
//! ```
//! (1) is the first-order index of I. Sobol', *Sensitivity estimates for nonlinear mathematical models*, Mathematical Modelling and
//! Computational Experiment 1 (1993), which is the correlation ratio of K. Pearson. (2) estimates it from any draws: A.
//! Saltelli et al., *Global Sensitivity Analysis: The Primer*, 2008, section 1.2. The means of K bins scatter even for a key without
//! effect, by the amount that (3) subtracts: T. Kelley, *An unbiased correlation ratio measure*, PNAS 21 (1935). A change of the mean
//! within a bin is lost, 1/K² of the share for a uniform slope.
use crate::axis::Value;
use crate::draws::Draws;
use crate::sweep::Arrangement;
use crate::table::{Column, Table};
use std::collections::BTreeSet;

/// Draws at an end of a key: their smallest number, and the divisor of all draws: a tenth.
const FEWEST: usize = 5;
const PART: usize = 10;
/// Largest number of least-squares iterations, and the change, in standard deviations, at which they stop.
const MOST_TURNS: usize = 200;
const NO_MORE: f64 = 1e-12;
/// Number of draws below which bins are not meaningful.
const FEWEST_DRAWS: usize = 12;

/// Effect of each key on a metric.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The keys, with the largest share first.
    pub keys: Vec<Influence>,
    /// The share of the variance that no single key explains, 0 to 1: interactions of keys, and chance.
    pub rest: f64,
    /// The standard deviation to be explained, in the unit of the metric (SI).
    pub deviation: f64,
}

/// Effect of a key on a metric.
#[derive(Debug, Clone, PartialEq)]
pub struct Influence {
    /// The key; for parallel axes all of them: `a, b`; for several engines `engine`.
    pub key: String,
    /// Share of the variance that it explains by itself (3), 0 to 1.
    pub share: f64,
    /// Standard deviation of the share about 0 if the key had no effect; 0 for an axis, since all its values were run.
    pub chance: f64,
    /// The metric at low values of the key. For names: at the smallest metric.
    pub low: End,
    /// The metric at high values of the key. For names: at the largest metric.
    pub high: End,
    /// Standard error of the difference between both ends, in the unit of the metric (SI); 0 for an axis.
    pub error: f64,
}

/// An end of a key.
#[derive(Debug, Clone, PartialEq)]
pub struct End {
    /// Value of the key; for a drawn key the mean of the draws at this end, a tenth of all.
    pub at: Value,
    /// Mean of the metric at this end (SI).
    pub mean: f64,
}

impl Influence {
    /// Metric at the high end minus that at the low end (SI).
    #[must_use]
    pub fn difference(&self) -> f64 {
        self.high.mean - self.low.mean
    }
}

impl Sensitivity {
    /// Effects of the drawn keys on `column`: shares of its scatter within a group, about the group's mean, averaged over the groups. A key
    /// that lengthens the time with one value of an axis and shortens it with another thus has its share, while the difference of its ends,
    /// also an average, may be small. `None` without draws, or if no group scatters and was measured in 12 draws or more.
    #[must_use]
    pub fn of_draws(table: &Table<'_>, column: &Column) -> Option<Self> {
        let draws = table.sweep.draws()?;
        let groups: Vec<Group<'_>> =
            (0..table.groups()).filter_map(|group| Group::of(table.values(column, group))).collect();
        let (squares, count) = groups.iter().fold((0.0, 0.0), |sum, one| (sum.0 + one.squares, sum.1 + one.count));
        if !(squares > 0.0 && squares.is_finite()) {
            return None;
        }
        let keys: Vec<Influence> = (0..draws.keys().len()).map(|key| influence(&groups, draws, key, squares)).collect();
        let explained: f64 = keys.iter().map(|key| key.share).sum();
        Some(Self::sorted(keys, 1.0 - explained, squares / count))
    }

    /// Effects on `column` of axes and engines with more than one value: shares of the variance of the group means. If all groups were
    /// measured, the shares and the rest add up to 1. `None` without such an axis or if the column is constant.
    #[must_use]
    pub fn of_axes(table: &Table<'_>, column: &Column) -> Option<Self> {
        let groups: Vec<(usize, f64)> =
            (0..table.groups()).filter_map(|group| Some((group, mean(table.values(column, group))?))).collect();
        let n = groups.len() as f64;
        let average = groups.iter().map(|(_, mean)| mean / n).sum::<f64>();
        let variance = groups.iter().map(|(_, mean)| square(mean - average) / n).sum::<f64>();
        if !is_scattered(variance, average) {
            return None;
        }
        let factors = factors(table);
        let (effects, rest) = effects(&groups, &factors, average, variance);
        let each = factors.iter().zip(&effects);
        let keys: Vec<Influence> =
            each.filter_map(|(factor, effects)| factor.influence(&groups, effects, average, variance)).collect();
        (!keys.is_empty()).then(|| Self::sorted(keys, rest / variance, variance))
    }

    fn sorted(mut keys: Vec<Influence>, rest: f64, variance: f64) -> Self {
        keys.sort_by(|one, other| other.share.total_cmp(&one.share));
        Self { keys, rest: rest.clamp(0.0, 1.0), deviation: variance.sqrt() }
    }
}

const fn square(x: f64) -> f64 {
    x * x
}

/// True if a variance about this `mean` exceeds the rounding error, and is finite.
fn is_scattered(variance: f64, mean: f64) -> bool {
    variance > square(8.0 * f64::EPSILON * mean) && variance.is_finite()
}

/// The mean of the measured values of `values`.
fn mean(values: &[f64]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values.iter().filter(|value| value.is_finite()) {
        sum += value;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}

/// The draws of a group in which a metric was measured.
struct Group<'c> {
    values: &'c [f64],
    count: f64,
    /// Sum of the squares about the mean.
    squares: f64,
}

impl<'c> Group<'c> {
    /// A group that scatters, with enough draws for bins.
    fn of(values: &'c [f64]) -> Option<Self> {
        let mean = mean(values)?;
        let measured = || values.iter().filter(|value| value.is_finite());
        let squares: f64 = measured().map(|value| square(value - mean)).sum();
        let count = measured().count();
        let tells = count >= FEWEST_DRAWS && is_scattered(squares / count as f64, mean);
        tells.then_some(Self { values, count: count as f64, squares })
    }
}

/// Effect of key `key` of `draws` on `groups`; `total` is the sum of their squares about their means.
fn influence(groups: &[Group<'_>], draws: &Draws, key: usize, total: f64) -> Influence {
    let mut order: Vec<(f64, usize)> = (0..draws.count()).map(|draw| draws.value(key, draw)).zip(0..).collect();
    order.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
    let drawn = &draws.keys()[key];
    let n = groups.len() as f64;
    let (mut share, mut chance, mut error) = (0.0, 0.0, 0.0);
    let mut ends = [(0.0, 0.0); 2];
    for group in groups {
        let value = |(at, draw): &(f64, usize)| Some((*at, *group.values.get(*draw)?));
        let pairs: Vec<(f64, f64)> = order.iter().filter_map(value).filter(|pair| pair.1.is_finite()).collect();
        let ratio = Ratio::of(&pairs);
        share += ratio.share * group.squares / total;
        // The groups have the same draws: a chance effect in one of them may be in all.
        chance += ratio.chance * group.squares / total;
        let size = (pairs.len() / PART).max(FEWEST);
        let [low, high] = [&pairs[..size], &pairs[pairs.len() - size..]].map(end_of);
        for (sum, end) in ends.iter_mut().zip([&low, &high]) {
            *sum = (sum.0 + end.at / n, sum.1 + end.mean / n);
        }
        error += (low.variance + high.variance).sqrt() / n;
    }
    let [low, high] = ends.map(|(at, mean)| End { at: Value::Number(at, drawn.unit.clone()), mean });
    Influence { key: drawn.key.clone(), share: share.clamp(0.0, 1.0), chance, low, high, error }
}

/// Means of the key and of the metric in some draws, and the variance of the metric's mean.
struct Means {
    at: f64,
    mean: f64,
    variance: f64,
}

fn end_of(pairs: &[(f64, f64)]) -> Means {
    let n = pairs.len() as f64;
    let (at, mean) = pairs.iter().fold((0.0, 0.0), |(at, mean), pair| (at + pair.0 / n, mean + pair.1 / n));
    let squares: f64 = pairs.iter().map(|pair| square(pair.1 - mean)).sum();
    Means { at, mean, variance: squares / (n - 1.0) / n }
}

/// The correlation ratio (3) of values ordered by the key.
struct Ratio {
    share: f64,
    chance: f64,
}

impl Ratio {
    /// For pairs in the order of their first numbers; as many bins as draws per bin.
    fn of(pairs: &[(f64, f64)]) -> Self {
        let count = pairs.len();
        let bins = count.isqrt();
        let n = count as f64;
        let average = pairs.iter().map(|pair| pair.1 / n).sum::<f64>();
        let (mut between, mut within, mut fourth) = (0.0, 0.0, 0.0);
        for bin in 0..bins {
            let pairs = &pairs[bin * count / bins..(bin + 1) * count / bins];
            let size = pairs.len() as f64;
            let mean = pairs.iter().map(|pair| pair.1 / size).sum::<f64>();
            between += size * square(mean - average);
            let squares = pairs.iter().map(|pair| square(pair.1 - mean)).sum::<f64>();
            within += squares;
            // The fourth power of the scatter within the bin, unbiased for normal numbers.
            fourth += square(squares) / ((size - 1.0) * (size + 1.0));
        }
        let (k, total) = (bins as f64, between + within);
        let share = (between - (k - 1.0) * within / (n - k)) / total;
        // For numbers with the same mean in each bin but different scatter σ_b, `between` has the variance 2 Σ σ_b⁴.
        let chance = (2.0 * fourth * (1.0 - 1.0 / k) * (n - 1.0) / (n - k)).sqrt() / total;
        Self { share, chance }
    }
}

/// An axis, parallel axes, or the engines.
struct Factor {
    key: String,
    /// Its values, and the index of the value of each group.
    values: Vec<Value>,
    of_group: Vec<usize>,
}

fn factors(table: &Table<'_>) -> Vec<Factor> {
    let groups = table.groups();
    let places: Vec<Vec<usize>> =
        (0..table.sweep.combinations()).map(|combination| table.sweep.places(combination)).collect();
    let axes = table.sweep.axes();
    let of_axis = |axis: usize| {
        let of_group = (0..groups).map(|group| places[table.combination(group)][axis]).collect();
        Factor { key: axes[axis].key.clone(), values: axes[axis].values.clone(), of_group }
    };
    let mut factors: Vec<Factor> = match table.sweep.arrangement() {
        // Parallel axes cannot be told apart: they count as one, with the values of the first.
        Arrangement::Zip if axes.len() > 1 => {
            let all: Vec<&str> = axes.iter().map(|axis| axis.key.as_str()).collect();
            vec![Factor { key: all.join(", "), ..of_axis(0) }]
        }
        Arrangement::Zip | Arrangement::Grid => (0..axes.len()).map(of_axis).collect(),
    };
    factors.push(Factor {
        key: "engine".to_owned(),
        values: table.engines.iter().map(|name| Value::Text(name.clone())).collect(),
        of_group: (0..groups).map(|group| group / table.sweep.combinations()).collect(),
    });
    factors.retain(|factor| factor.values.len() > 1);
    factors
}

impl Factor {
    /// Its effect, from the additions of its values to the `average`; `None` if it was measured at a single value.
    fn influence(&self, groups: &[(usize, f64)], effects: &[f64], average: f64, variance: f64) -> Option<Influence> {
        let squares: f64 = groups.iter().map(|(group, _)| square(effects[self.of_group[*group]])).sum();
        let measured: BTreeSet<usize> = groups.iter().map(|(group, _)| self.of_group[*group]).collect();
        let is_of_numbers = self.values.iter().all(|value| value.number().is_some());
        // Numbers in their own order, names by the metric.
        let order = |value: &usize| match self.values[*value].number() {
            Some(number) if is_of_numbers => number,
            _ => effects[*value],
        };
        let low = measured.iter().min_by(|one, other| order(one).total_cmp(&order(other)))?;
        let high = measured.iter().max_by(|one, other| order(one).total_cmp(&order(other)))?;
        let end = |value: usize| End { at: self.values[value].clone(), mean: average + effects[value] };
        (measured.len() > 1).then(|| Influence {
            key: self.key.clone(),
            share: (squares / groups.len() as f64 / variance).clamp(0.0, 1.0),
            chance: 0.0,
            low: end(*low),
            high: end(*high),
            error: 0.0,
        })
    }
}

/// Additions of each value of the `factors` to the mean of all `groups`, and the mean square of the remainder. If each group was
/// measured, an addition is the mean of the groups with that value minus the mean of all; if some are missing, the other factors are not
/// balanced over its values, and their additions are subtracted first: iterated least squares (*backfitting*, L. Breiman & J. Friedman,
/// Journal of the American Statistical Association 80, 1985).
fn effects(groups: &[(usize, f64)], factors: &[Factor], average: f64, variance: f64) -> (Vec<Vec<f64>>, f64) {
    let mut effects: Vec<Vec<f64>> = factors.iter().map(|factor| vec![0.0; factor.values.len()]).collect();
    let mut rest: Vec<f64> = groups.iter().map(|(_, mean)| mean - average).collect();
    for _ in 0..MOST_TURNS {
        let mut largest = 0.0_f64;
        for (factor, effects) in factors.iter().zip(&mut effects) {
            let mut sums = vec![(0.0, 0.0); factor.values.len()];
            for ((group, _), rest) in groups.iter().zip(&rest) {
                let sum = &mut sums[factor.of_group[*group]];
                *sum = (sum.0 + rest, sum.1 + 1.0);
            }
            let more: Vec<f64> = sums.iter().map(|(sum, count)| if *count > 0.0 { sum / count } else { 0.0 }).collect();
            for ((group, _), rest) in groups.iter().zip(&mut rest) {
                *rest -= more[factor.of_group[*group]];
            }
            for (effect, more) in effects.iter_mut().zip(&more) {
                *effect += more;
                largest = largest.max(more.abs());
            }
        }
        if largest <= NO_MORE * variance.sqrt() {
            break;
        }
    }
    (effects, rest.iter().map(|rest| square(*rest)).sum::<f64>() / groups.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random;

    /// The corrected ratio of noise is 0 on average and scatters as predicted: over 400 seeds, within three standard errors of a mean,
    /// 1/√400, and of a standard deviation, 1/√800. The uncorrected mean would be (K − 1)/(n − 1), four times the scatter.
    #[test]
    fn noise_has_no_share() {
        for count in [50_u32, 1000] {
            let ratios: Vec<Ratio> = (0..400)
                .map(|seed| {
                    let number = |k: u32| random::between(random::number(random::stream(seed, 7), k.into()));
                    Ratio::of(&(0..count).map(|k| (f64::from(k), number(k))).collect::<Vec<_>>())
                })
                .collect();
            let n = ratios.len() as f64;
            let chance = ratios.iter().map(|ratio| ratio.chance / n).sum::<f64>();
            let mean = ratios.iter().map(|ratio| ratio.share / n).sum::<f64>();
            let deviation = (ratios.iter().map(|ratio| square(ratio.share - mean) / n).sum::<f64>()).sqrt();
            assert!(mean.abs() < 3.0 * chance / 20.0, "{count}: {mean} ± {chance}");
            assert!((deviation / chance - 1.0).abs() < 3.0 / 800_f64.sqrt(), "{count}: {deviation}, not {chance}");
        }
    }
}
