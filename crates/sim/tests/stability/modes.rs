//! The modes that a run shows: how fast each of them grows or fades, whatever is beside it.
//!
//! Sampled every S, a multiple of its common period, a linear loop leaves sums of powers. Stacked over D samples they are a matrix
//! whose columns go on by the same multipliers λ:
//!
//! ```text
//! y_k = Σ_i c_i·λ_i^k        H = [y_k; y_{k+1}; …; y_{k+D−1}]_k = U·Σ·Vᵀ
//! A = pinv(first D−1 blocks of U_r)·(last D−1 blocks of U_r)        λ = eigenvalues of A
//! ```
//! r is the number of singular values above rounding. A spectrum needs a time of 1/Δf to tell two modes apart and hides a small one
//! behind the skirt of a large one; this needs neither, as long as nothing but rounding is beside the sum. Where the whole fades or
//! grows by much within the samples, it is flattened first by a factor from sample to sample, which is a factor of every λ.
//! Source: Roy & Kailath, *ESPRIT*, IEEE Trans. ASSP 37 (1989); Tu et al., *On Dynamic Mode Decomposition*, J. Comput. Dyn. 1 (2014).
use nalgebra::{Complex, DMatrix};

/// Samples that are stacked: more unknowns than any of these loops has states.
const DEPTH: usize = 16;
/// Of the largest singular value; rounding is three orders of magnitude below.
const RANK: f64 = 1e-10;
/// Of the largest amplitude: what is smaller than this says nothing.
const SHARE: f64 = 1e-7;

/// A mode.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mode {
    /// ln|λ|: its growth from sample to sample.
    pub(crate) growth: f64,
    /// Its largest amplitude within the samples, as a share of that of the largest mode.
    pub(crate) share: f64,
}

/// The fastest-growing mode of `samples`, each a row of channels; `None` where there are too few, or no linear loop is in them.
pub(crate) fn largest(samples: &[Vec<f64>]) -> Option<Mode> {
    modes(samples)?.into_iter().filter(|mode| mode.share > SHARE).max_by(|one, two| one.growth.total_cmp(&two.growth))
}

fn modes(samples: &[Vec<f64>]) -> Option<Vec<Mode>> {
    let count = samples.len();
    let channels = samples.first()?.len();
    if count < 4 * DEPTH {
        return None;
    }
    let (values, flattened) = flat(samples)?;
    let columns = count - DEPTH + 1;
    let stacked = DMatrix::from_fn(DEPTH * channels, columns, |i, k| values[(k + i / channels, i % channels)]);
    let svd = stacked.try_svd(true, false, f64::EPSILON, 10_000)?;
    let largest = svd.singular_values.max();
    let rank = svd.singular_values.iter().filter(|value| **value > RANK * largest).count();
    let blocks = (DEPTH - 1) * channels;
    let directions = svd.u?;
    let (before, after) = (directions.view((0, 0), (blocks, rank)), directions.view((channels, 0), (blocks, rank)));
    let step = before.into_owned().try_svd(true, true, f64::EPSILON, 10_000)?.solve(&after, 1e-14).ok()?;
    let multipliers = step.complex_eigenvalues();
    // Which share each has: by least squares.
    let powers = DMatrix::from_fn(count, rank, |k, i| multipliers[i].powf(k as f64));
    let values = values.map(|value| Complex::new(value, 0.0));
    let amplitudes = powers.try_svd(true, true, f64::EPSILON, 10_000)?.solve(&values, 1e-14).ok()?;
    let size = |i: usize| {
        let at_first = amplitudes.row(i).norm();
        at_first.max(at_first * multipliers[i].norm().powf(count as f64 - 1.0))
    };
    let most = (0..rank).map(size).fold(0.0, f64::max);
    let mode = |i: usize| Mode { growth: multipliers[i].norm().ln() - flattened, share: size(i) / most };
    Some((0..rank).map(mode).collect())
}

/// The samples as rows, each channel of the size 1 and the whole as large at the end as at the beginning; and what has been added to
/// the growth from sample to sample.
fn flat(samples: &[Vec<f64>]) -> Option<(DMatrix<f64>, f64)> {
    let (count, channels) = (samples.len(), samples[0].len());
    let part = count / 8;
    let size = |of: &[Vec<f64>], i: usize| of.iter().map(|row| row[i].abs()).fold(0.0, f64::max);
    let ratio = |i: usize| (size(&samples[..part], i) / size(&samples[count - part..], i)).ln();
    let ratios: Vec<f64> = (0..channels).map(ratio).filter(|ratio| ratio.is_finite()).collect();
    let added = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64 / (count - part) as f64;
    let mut values = DMatrix::from_fn(count, channels, |k, i| samples[k][i] * (added * k as f64).exp());
    for mut column in values.column_iter_mut() {
        let largest = column.amax();
        if largest > 0.0 {
            column /= largest;
        }
    }
    values.iter().all(|value| value.is_finite()).then_some((values, added))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Samples every 4 ms of modes as (amplitude, growth (1/s), frequency (Hz)), in three channels.
    fn samples(of: &[(f64, f64, f64)]) -> Vec<Vec<f64>> {
        let at = |k: usize, channel: usize| {
            let t = 4e-3 * k as f64;
            let one = |(i, (amplitude, growth, frequency)): (usize, &(f64, f64, f64))| {
                let phase = 0.7 * i as f64 + 1.1 * channel as f64;
                amplitude * (1.0 + 0.3 * channel as f64) * (growth * t).exp() * (TAU * frequency * t + phase).cos()
            };
            of.iter().enumerate().map(one).sum()
        };
        (0..400).map(|k| (0..3).map(|channel| at(k, channel)).collect()).collect()
    }

    /// A slow growth behind a large mode, two modes that a spectrum of 1.6 s does not tell apart, a fast decay of everything.
    #[test]
    fn the_largest_growth_is_found_behind_what_is_larger() {
        for (of, expected) in [
            (vec![(1.0, -0.002, 1211.3), (1e-5, 0.016, 3.1)], 0.016),
            (vec![(1.0, -0.3, 40.0), (1.0, 0.02, 40.05)], 0.02),
            (vec![(1.0, -30.0, 17.0), (0.1, -22.0, 31.0), (1e-3, -60.0, 55.0)], -22.0),
            (vec![(1.0, -0.01, 5.0), (0.5, -0.5, 0.0)], -0.01),
        ] {
            let found = largest(&samples(&of)).unwrap().growth / 4e-3;
            assert!((found - expected).abs() < 1e-3 * expected.abs(), "{of:?}: {found}");
        }
    }

    /// What is below the share says nothing, whichever way it goes.
    #[test]
    fn a_mode_below_the_share_is_none() {
        let found = largest(&samples(&[(1.0, -0.02, 50.0), (1e-12, 1.0, 9.0)])).unwrap().growth / 4e-3;
        assert!((found + 0.02).abs() < 1e-4, "{found}");
    }
}
