//! The binomial distribution, to full precision for any number of trials.
//!
//! ```text
//! P(B ≥ k) = I_p(k, n − k + 1)        P(B ≤ k) = I_q(n − k, k + 1)        q = 1 − p
//! I_x(a, b) = P(B = a of a + b − 1) · a (1 − x) / (β₁ + α₂/(β₂ + α₃/(β₃ + …)))
//! ```
//! Sources: NIST Digital Library of Mathematical Functions, 8.17.5; A. DiDonato & A. Morris, *Algorithm 708: significant digit computation of
//! the incomplete beta function ratios*, ACM Transactions on Mathematical Software 18 (1992), `BFRAC` (continued fraction); C. Loader,
//! *Fast and accurate computation of binomial probabilities*, 2000 (the factor before it: differences of logarithms of factorials would
//! lose as many digits as these have, eight for ten million trials). For p near an end, the count is compared with its
//! expectation on the side of the small numbers.
use core::f64::consts::PI;

/// Largest number of terms of the continued fraction; n trials need about √n.
const MOST_TERMS: u32 = 1_000_000;

/// The probability of `hits` or more of `trials`, each a hit with probability `p`.
pub(crate) fn at_least(hits: u64, trials: u64, p: f64) -> f64 {
    match hits {
        0 => 1.0,
        _ if hits > trials || p <= 0.0 => 0.0,
        _ if p >= 1.0 => 1.0,
        _ if is_above(hits, trials, p) => upper_tail(hits, trials, p),
        _ => 1.0 - lower_tail(hits - 1, trials, p),
    }
}

/// The probability of `hits` or fewer of `trials`, each a hit with probability `p`.
pub(crate) fn at_most(hits: u64, trials: u64, p: f64) -> f64 {
    if hits >= trials || p <= 0.0 {
        return 1.0;
    }
    match hits + 1 {
        _ if p >= 1.0 => 0.0,
        above if is_above(above, trials, p) => 1.0 - upper_tail(above, trials, p),
        _ => lower_tail(hits, trials, p),
    }
}

/// True if `hits` exceeds the expected number: the continued fraction converges fast beyond it.
fn is_above(hits: u64, trials: u64, p: f64) -> bool {
    p * (trials as f64 + 3.0) < hits as f64 + 1.0
}

/// Probability of `hits` or more, above the expected number.
fn upper_tail(hits: u64, trials: u64, p: f64) -> f64 {
    let (k, n) = (hits as f64, trials as f64);
    if hits == trials {
        return libm::exp(n * libm::log(p));
    }
    let fraction = continued_fraction(k, n - k + 1.0, p, excess(k, n + 1.0, p));
    density(hits, trials, p) * k * (1.0 - p) * fraction
}

/// Probability of `hits` or fewer, below the expected number.
fn lower_tail(hits: u64, trials: u64, p: f64) -> f64 {
    let (k, n) = (hits as f64, trials as f64);
    if hits == 0 {
        return libm::exp(n * libm::log1p(-p));
    }
    let fraction = continued_fraction(n - k, k + 1.0, 1.0 - p, -excess(k + 1.0, n + 1.0, p));
    density(hits, trials, p) * (n - k) * p * fraction
}

/// `k` − `n`·p, without differences of nearly equal large numbers.
fn excess(k: f64, n: f64, p: f64) -> f64 {
    if p <= 0.5 { k - n * p } else { n * (1.0 - p) - (n - k) }
}

/// The probability of exactly `hits` of `trials`, neither none nor all, 0 < p < 1.
fn density(hits: u64, trials: u64, p: f64) -> f64 {
    let (k, n) = (hits as f64, trials as f64);
    let (rest, off) = (n - k, excess(k, n, p));
    let exponent = of_stirling(n)
        - of_stirling(k)
        - of_stirling(rest)
        - deviance(k, n * p, off)
        - deviance(rest, n * (1.0 - p), -off);
    (n / (2.0 * PI * k * rest)).sqrt() * libm::exp(exponent)
}

/// Error of Stirling's formula: ln n! − ln(√(2πn) (n/e)ⁿ). From 16 on the fifth term of the series is below 1e-16.
fn of_stirling(n: f64) -> f64 {
    if n < 16.0 {
        return libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - 0.5 * libm::log(2.0 * PI);
    }
    let square = n * n;
    (1.0 / 12.0 - (1.0 / 360.0 - (1.0 / 1260.0 - (1.0 / 1680.0 - 1.0 / 1188.0 / square) / square) / square) / square)
        / n
}

/// x ln(x/m) + m − x, where `off` is x − m. For x near m the terms cancel, and a series in off/(x + m) replaces them.
fn deviance(x: f64, m: f64, off: f64) -> f64 {
    if off.abs() >= 0.1 * (x + m) {
        return x * libm::log(x / m) - off;
    }
    let v = off / (x + m);
    let (mut sum, mut power) = (off * v, 2.0 * x * v);
    for j in 1..1000 {
        power *= v * v;
        let next = sum + power / (2.0 * f64::from(j) + 1.0);
        if next.to_bits() == sum.to_bits() {
            break;
        }
        sum = next;
    }
    sum
}

/// 1/(β₁ + α₂/(β₂ + …)) by the method of Lentz as modified by Thompson and Barnett, where `lambda` is a − (a + b) x; for λ > −1 or so.
fn continued_fraction(a: f64, b: f64, x: f64, lambda: f64) -> f64 {
    let not_zero = |value: f64| if value.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { value };
    let mut fraction = not_zero(a * (lambda + 1.0) / (a + 1.0));
    let (mut c, mut d) = (fraction, 0.0);
    for term in 1..MOST_TERMS {
        let m = f64::from(term);
        let odd = a + 2.0 * m - 1.0;
        let alpha = (a + m - 1.0) / odd * ((a + b + m - 1.0) / odd) * m * (b - m) * x * x;
        let beta = m + m * (b - m) * x / odd + (a + m) * (lambda + 1.0 + m * (2.0 - x)) / (odd + 2.0);
        d = 1.0 / not_zero(beta + alpha * d);
        c = not_zero(beta + alpha / c);
        let change = c * d;
        fraction *= change;
        if (change - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    1.0 / fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the sum itself, by recurrence of its terms. A sum of n rounded terms has an error of some n·ε.
    #[test]
    fn tails_are_the_sums_that_they_stand_for() {
        for (trials, p) in [(1_u64, 0.3), (10, 0.5), (59, 0.95), (200, 0.01), (1000, 0.37), (1000, 0.999)] {
            let n = trials as f64;
            let mut terms = vec![libm::exp(n * libm::log1p(-p))];
            for k in 1..=trials {
                let last = terms[terms.len() - 1];
                terms.push(last * (n - k as f64 + 1.0) / k as f64 * p / (1.0 - p));
            }
            // (1 − p)ⁿ of 0.001¹⁰⁰⁰ underflows: such a row is summed from the other end.
            if terms[0] == 0.0 {
                terms = vec![libm::exp(n * libm::log(p))];
                for k in (0..trials).rev() {
                    let last = terms[terms.len() - 1];
                    terms.push(last * (k as f64 + 1.0) / (n - k as f64) * (1.0 - p) / p);
                }
                terms.reverse();
            }
            for hits in 0..=trials {
                let place = usize::try_from(hits).unwrap();
                let (below, above): (f64, f64) = (terms[..=place].iter().sum(), terms[place..].iter().sum());
                for (found, sum) in [(at_most(hits, trials, p), below), (at_least(hits, trials, p), above)] {
                    let tolerance = 4.0 * (n + 10.0) * f64::EPSILON * sum + f64::MIN_POSITIVE;
                    assert!((found - sum).abs() <= tolerance, "{hits} of {trials} at {p}: {found}, not {sum}");
                }
            }
        }
    }

    /// Oracle: mpmath 1.4 with 60 digits, `betainc(k, n - k + 1, 0, p, regularized=True)`. The rounding of p changes a tail by at most n
    /// times as much: the tolerance is that of √n roundings, as the terms of the exponent are of the order of the distance from the mean in
    /// standard deviations squared.
    #[test]
    fn ten_million_trials_lose_no_digits() {
        for (hits, trials, p, expected) in [
            (5_001_000_u64, 10_000_000_u64, 0.5, 0.26364792810332189887),
            (3_u64, 10_000_000_u64, 1e-07, 0.080301387874407315344),
            (9_999_990_u64, 10_000_000_u64, 0.999998, 0.010811660666763871219),
            (1_005_000_u64, 10_000_000_u64, 0.1, 6.9645373541649162672e-8),
            (600_u64, 1_000_u64, 0.5, 1.3642320780330092128e-10),
            (70_u64, 1_000_000_u64, 5e-05, 0.0043336929289427416446),
        ] {
            let found = at_least(hits, trials, p);
            let tolerance = 4.0 * (trials as f64).sqrt() * f64::EPSILON;
            assert!((found / expected - 1.0).abs() < tolerance, "{hits} of {trials} at {p}: {found}, not {expected}");
        }
    }

    #[test]
    fn the_ends_are_certain() {
        for p in [0.0, 0.3, 1.0] {
            assert_eq!((at_least(0, 5, p), at_most(5, 5, p), at_least(6, 5, p)), (1.0, 1.0, 0.0));
        }
        assert_eq!(
            (at_least(1, 5, 0.0), at_least(5, 5, 1.0), at_most(4, 5, 1.0), at_most(0, 5, 0.0)),
            (0.0, 1.0, 0.0, 1.0)
        );
    }
}
