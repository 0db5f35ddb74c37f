//! Thinning that keeps every extreme.
use crate::recording::Recording;

/// Indices that remain when `values` are thinned to a minimum/maximum envelope of `buckets` buckets, ascending.
///
/// The values are cut into `buckets` runs whose lengths differ by one at most. Of each run the first smallest and the
/// first largest value stay, at their own indices, and so do the very first and the very last value. Nothing is
/// averaged or moved: the global extremes and, within one run, the instants of all extremes survive. Values are left
/// as they are when that would not be fewer, `2·buckets + 2`. A NaN is neither small nor large and does not stay.
#[must_use]
pub fn envelope(values: &[f64], buckets: usize) -> Vec<usize> {
    let len = values.len();
    if len <= buckets.saturating_mul(2).saturating_add(2) {
        return (0..len).collect();
    }
    let mut kept = Vec::with_capacity(2 * buckets + 2);
    let mut keep = |index: usize| {
        if kept.last().is_none_or(|last| *last < index) {
            kept.push(index);
        }
    };
    keep(0);
    for bucket in 0..buckets {
        let (start, end) = (edge(bucket, buckets, len), edge(bucket + 1, buckets, len));
        if let Some((low, high)) = extremes(&values[start..end]) {
            keep(start + low.min(high));
            keep(start + low.max(high));
        }
    }
    keep(len - 1);
    kept
}

/// First index of run `bucket` when `len` values are cut into `buckets` runs; in 128 bits, as the product may overflow.
fn edge(bucket: usize, buckets: usize, len: usize) -> usize {
    usize::try_from(bucket as u128 * len as u128 / buckets as u128).unwrap_or(len)
}

/// Indices of the first smallest and the first largest value; `None` when all are NaN.
fn extremes(run: &[f64]) -> Option<(usize, usize)> {
    let first = run.iter().position(|value| !value.is_nan())?;
    let (mut low, mut high) = (first, first);
    for (index, value) in run.iter().enumerate().skip(first + 1) {
        if *value < run[low] {
            low = index;
        }
        if *value > run[high] {
            high = index;
        }
    }
    Some((low, high))
}

impl Recording {
    /// The channel `name` as (time in s, value), thinned by [`envelope`] to `buckets` buckets; `None` without the channel.
    #[must_use]
    pub fn envelope(&self, name: &str, buckets: usize) -> Option<Vec<(f64, f64)>> {
        let values = self.channel(name)?;
        Some(envelope(values, buckets).into_iter().map(|index| (self.time_of(index), values[index])).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_spike_of_one_sample_survives_at_its_own_instant() {
        let mut values: Vec<f64> = (0..10_000).map(|k| (f64::from(k) * 1e-3).sin()).collect();
        values[7_777] = 5.0;
        values[7_778] = -5.0;
        let kept = envelope(&values, 100);
        assert!(kept.contains(&7_777) && kept.contains(&7_778));
        assert!(kept.len() <= 202);
    }

    #[test]
    fn few_values_and_no_buckets() {
        assert_eq!(envelope(&[3.0, 1.0, 2.0], 1), [0, 1, 2]);
        assert_eq!(envelope(&[3.0, 1.0, 2.0], 0), [0, 2]);
        assert!(envelope(&[], 10).is_empty());
        assert_eq!(envelope(&[f64::NAN; 9], 2), [0, 8]);
    }

    proptest! {
        /// Oracle: the smallest and largest value of any stretch of whole runs, found by plain search.
        #[test]
        fn extremes_ends_and_order_survive(values in prop::collection::vec(-1e3..1e3_f64, 1..400), buckets in 0..40_usize) {
            let kept = envelope(&values, buckets);
            prop_assert!(kept.windows(2).all(|pair| pair[0] < pair[1]), "ascending, none twice: {kept:?}");
            prop_assert!(kept.len() <= (2 * buckets + 2).min(values.len()));
            prop_assert_eq!((kept.first(), kept.last()), (Some(&0), Some(&(values.len() - 1))));
            for bucket in 0..buckets {
                let run = bucket * values.len() / buckets..(bucket + 1) * values.len() / buckets;
                for extreme in [f64::min, f64::max] {
                    let all = values[run.clone()].iter().copied().reduce(extreme);
                    let left = kept.iter().filter(|k| run.contains(k)).map(|k| values[*k]).reduce(extreme);
                    prop_assert_eq!(all, left);
                }
            }
        }
    }
}
