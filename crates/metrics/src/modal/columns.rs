//! Columns of equal length, and sums of their products.
//!
//! A sum of products is a chain of dependent additions; a processor adds up several columns in the time of one. So operations of
//! one column with many others are made with four of them at a time: the same operations in the same order for each.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]

use servobench_base::wide_registers;
use std::slice::ChunksExact;

/// Columns that are processed side by side.
const TOGETHER: usize = 4;

/// Columns of equal length, contiguous in memory.
#[derive(Debug, Clone)]
pub(crate) struct Columns {
    rows: usize,
    values: Vec<f64>,
}

impl Columns {
    /// Empty, for columns of `rows` values (at least one), with room for `count`.
    pub(crate) fn new(rows: usize, count: usize) -> Self {
        assert!(rows > 0, "a column has a value");
        Self { rows, values: Vec::with_capacity(rows * count) }
    }

    pub(crate) const fn count(&self) -> usize {
        self.values.len() / self.rows
    }

    /// Adds `count` columns of zeros, and returns them to be filled in.
    pub(crate) fn add(&mut self, count: usize) -> &mut [f64] {
        let here = self.values.len();
        self.values.resize(here + count * self.rows, 0.0);
        &mut self.values[here..]
    }

    /// Adds a column.
    pub(crate) fn push(&mut self, values: impl Iterator<Item = f64>) {
        self.values.extend(values);
        assert!(self.values.len().is_multiple_of(self.rows), "a column has {} values", self.rows);
    }

    pub(crate) fn column(&self, index: usize) -> &[f64] {
        &self.values[index * self.rows..][..self.rows]
    }

    /// The first `count` columns, contiguous.
    pub(crate) fn first(&self, count: usize) -> &[f64] {
        &self.values[..count * self.rows]
    }

    pub(crate) fn iter(&self) -> ChunksExact<'_, f64> {
        self.values.chunks_exact(self.rows)
    }

    /// The columns before `index`, and those from there on.
    pub(crate) fn split_at_mut(&mut self, index: usize) -> (&mut [f64], &mut [f64]) {
        self.values.split_at_mut(index * self.rows)
    }

    /// Removes the last column and returns it.
    pub(crate) fn pop(&mut self) -> Vec<f64> {
        self.values.split_off(self.values.len() - self.rows)
    }

    /// All columns, contiguous.
    pub(crate) fn all_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }
}

/// Sum of products, always in the same order: eight interleaved sums, so that a processor can work on them side by side.
pub(crate) fn dot(one: &[f64], two: &[f64]) -> f64 {
    wide_registers!(dot_in_any(one, two), dot_in_wide_registers, one, two)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn dot_in_wide_registers(one: &[f64], two: &[f64]) -> f64 {
    dot_in_any(one, two)
}

#[inline(always)]
fn dot_in_any(one: &[f64], two: &[f64]) -> f64 {
    dots_of([two], one)[0]
}

/// The [`dot`] of `one` with each of `others`, contiguous columns, as many as there are `sums`.
pub(crate) fn dots(one: &[f64], others: &[f64], sums: &mut [f64]) {
    wide_registers!(dots_in_any(one, others, sums), dots_in_wide_registers, one, others, sums);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn dots_in_wide_registers(one: &[f64], others: &[f64], sums: &mut [f64]) {
    dots_in_any(one, others, sums);
}

#[inline(always)]
fn dots_in_any(one: &[f64], others: &[f64], sums: &mut [f64]) {
    let (groups, rest) = sums.as_chunks_mut::<TOGETHER>();
    let (in_groups, in_rest) = others.split_at(groups.len() * TOGETHER * one.len());
    for (sums, others) in groups.iter_mut().zip(in_groups.chunks_exact(TOGETHER * one.len())) {
        *sums = dots_of(columns_of(others, one.len()), one);
    }
    for (sum, other) in rest.iter_mut().zip(in_rest.chunks_exact(one.len())) {
        *sum = dot_in_any(one, other);
    }
}

/// Subtracts from each of `vectors`, contiguous columns, its projection on the unit vector `unit`, and writes the lengths of the
/// projections to `along`.
pub(crate) fn remove_from_each(unit: &[f64], vectors: &mut [f64], along: &mut [f64]) {
    wide_registers!(
        remove_from_each_in_any(unit, vectors, along),
        remove_from_each_in_wide_registers,
        unit,
        vectors,
        along
    );
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn remove_from_each_in_wide_registers(unit: &[f64], vectors: &mut [f64], along: &mut [f64]) {
    remove_from_each_in_any(unit, vectors, along);
}

#[inline(always)]
fn remove_from_each_in_any(unit: &[f64], vectors: &mut [f64], along: &mut [f64]) {
    dots_in_any(unit, vectors, along);
    for (vector, along) in vectors.chunks_exact_mut(unit.len()).zip(along) {
        vector.iter_mut().zip(unit).for_each(|(x, q)| *x -= *along * q);
    }
}

/// The first `N` of `columns` of `rows` values.
#[inline(always)]
fn columns_of<const N: usize>(columns: &[f64], rows: usize) -> [&[f64]; N] {
    std::array::from_fn(|n| &columns[n * rows..][..rows])
}

#[inline(always)]
fn dots_of<const N: usize>(columns: [&[f64]; N], with: &[f64]) -> [f64; N] {
    let (values, rest) = with.as_chunks::<8>();
    let chunks = columns.map(|column| &column.as_chunks::<8>().0[..values.len()]);
    let mut sums = [[0.0; 8]; N];
    for (k, values) in values.iter().enumerate() {
        for (sums, chunks) in sums.iter_mut().zip(&chunks) {
            for (sum, (a, b)) in sums.iter_mut().zip(values.iter().zip(&chunks[k])) {
                *sum += a * b;
            }
        }
    }
    std::array::from_fn(|n| {
        let beyond: f64 = rest.iter().zip(&columns[n][with.len() - rest.len()..]).map(|(a, b)| a * b).sum();
        sums[n].iter().sum::<f64>() + beyond
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Processors with and without wide registers give the same bits, and so do one column and many.
    #[test]
    fn both_kinds_of_processors_give_the_same_bits() {
        let mut random = servobench_testkit::Random::seeded(19);
        for rows in (1..70).chain([1000, 1001, 1007]) {
            for count in 0..10 {
                let unit: Vec<f64> = (0..rows).map(|_| random.signed()).collect();
                let vectors: Vec<f64> = (0..rows * count).map(|_| 1e3 * random.signed()).collect();
                let (mut here, mut in_any, mut single) = (vectors.clone(), vectors.clone(), vectors.clone());
                let mut along = [vec![0.0; count], vec![0.0; count], vec![0.0; count]];
                remove_from_each(&unit, &mut here, &mut along[0]);
                remove_from_each_in_any(&unit, &mut in_any, &mut along[1]);
                for (vector, along) in single.chunks_exact_mut(rows).zip(&mut along[2]) {
                    *along = dot(&unit, vector);
                    remove_from_each(&unit, vector, &mut [0.0]);
                }
                let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!((bits(&here), bits(&along[0])), (bits(&in_any), bits(&along[1])), "{rows} rows, {count}");
                assert_eq!((bits(&here), bits(&along[0])), (bits(&single), bits(&along[2])), "{rows} rows, {count}");
            }
        }
    }

    /// Whole numbers, so that the sum is exact: 0·1 + 1·2 + … + 20·21 = 20·21·22/3, and 1 + 2 + … + 21 less.
    #[test]
    fn a_sum_of_products_leaves_nothing_out() {
        let one: Vec<f64> = (0..21).map(f64::from).collect();
        let mut others = Columns::new(21, 5);
        for first in 1..6 {
            others.push((first..first + 21).map(f64::from));
        }
        let mut sums = [0.0; 5];
        dots(&one, others.all_mut(), &mut sums);
        for (k, sum) in sums.iter().enumerate() {
            assert!((sum - 3080.0 - 210.0 * k as f64).abs() < 1e-12, "{k}: {sum}");
        }
        assert!((dot(&one, others.column(0)) - 3080.0).abs() < 1e-12);
        assert_eq!((others.count(), others.iter().len()), (5, 5));
    }
}
