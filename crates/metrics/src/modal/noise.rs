//! Noise in a record: changes from value to value that belong to no motion.
use super::columns::dot;

/// Number of standard deviations within which everything is taken for noise.
pub(crate) const DEVIATIONS: f64 = 5.0;
/// Coefficients of the fourth difference. It removes a line, a parabola and a cubic altogether, and of an oscillation with sixteen
/// values to a period it leaves 2 %.
const FOURTH: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
/// Standard deviation of the fourth difference of white noise of 1: the root of the sum of squares of these, 70.
const GAIN: f64 = 8.366_600_265_340_756;
/// Standard deviation of a normal distribution over the median of its magnitude.
const OF_MEDIAN: f64 = 1.482_602_218_505_602;
/// Maximum number of differences that are used: their median scatters by 2 %.
const LOOKED_AT: usize = 2048;
/// Lags at which differences of white noise are uncorrelated, and those of an oscillation fully correlated at one or another.
const APART: std::ops::Range<usize> = FOURTH.len()..17;
/// Correlation that may occur by chance: it scatters by 5 % over [`LOOKED_AT`] differences.
const IN_COMMON: f64 = 0.3;

/// Standard deviation of the white noise in `values`: by the median of fourth differences, which a few jumps do not move. A motion has
/// hundreds of values to a period at every tick, so that nothing of it remains; where it has few, the remainder is not noise, and the
/// result is 0.
pub(crate) fn deviation(values: &[f64]) -> f64 {
    let differences: Vec<f64> = values.windows(FOURTH.len()).take(LOOKED_AT).map(fourth_difference).collect();
    if differences.len() < 2 * APART.end || !is_white(&differences) {
        return 0.0;
    }
    let mut sizes: Vec<f64> = differences.iter().map(|x| x.abs()).collect();
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    OF_MEDIAN * *median / GAIN
}

fn is_white(differences: &[f64]) -> bool {
    let all = dot(differences, differences);
    APART.into_iter().all(|apart| {
        let (one, two) = (&differences[apart..], &differences[..differences.len() - apart]);
        dot(one, two).abs() <= IN_COMMON * all
    })
}

fn fourth_difference(values: &[f64]) -> f64 {
    values.iter().zip(FOURTH).map(|(y, c)| c * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use servobench_testkit::Random;

    /// White noise of 1, to the scatter of the median; beside a jump, and a wave of 200 values to a period and ten times that size.
    #[test]
    fn noise_is_told_from_what_moves() {
        let mut random = Random::seeded(5);
        let noise: Vec<f64> = (0..8000).map(|_| (0..12).map(|_| random.unit()).sum::<f64>() - 6.0).collect();
        let wave = |k: usize| 10.0 * (2.0 * PI * k as f64 / 200.0).sin();
        let jump = |k: usize| if k > 2000 { 1e2 } else { 0.0 };
        let moved: Vec<f64> = noise.iter().enumerate().map(|(k, y)| y + wave(k) + jump(k)).collect();
        for values in [noise, moved] {
            let found = deviation(&values);
            assert!((found - 1.0).abs() < 0.1, "{found}");
        }
        // Fast waves are not noise: 2.2 to 20 values to a period.
        for values in [2.2, 3.0, 4.0, 6.5, 20.0] {
            let wave: Vec<f64> = (0..3000).map(|k| (2.0 * PI * f64::from(k) / values).sin()).collect();
            assert!(deviation(&wave).abs() < 1e-300, "{values}");
        }
        assert!(deviation(&[0.0; 3]).abs() < 1e-300);
    }
}
