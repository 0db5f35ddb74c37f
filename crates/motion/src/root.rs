//! The root of an increasing function between two bounds.

/// Maximum number of evaluations: bisection between any two bounds that are not farther apart than 1e30 times the root takes 150.
const MOST: usize = 200;

/// Root of `f`, which increases, between `low` and `high`; the nearer bound if `f` has one sign there.
///
/// Chandrupatla's method (Advances in Engineering Software 28, 1997): inverse quadratic interpolation if it is safe by the last
/// three points, bisection otherwise. It ends when the interval is within rounding.
pub(crate) fn increasing(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (f_low, f_high) = (f(low), f(high));
    increasing_from((low, f_low), (high, f_high), f)
}

/// The same with known values of `f` at both bounds.
#[inline]
pub(crate) fn increasing_from(low: (f64, f64), high: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    if low.1 >= 0.0 {
        low.0
    } else if high.1 <= 0.0 {
        high.0
    } else {
        between(low, high, f)
    }
}

/// The same between two points with known values of `f` below and above zero.
pub(crate) fn between(low: (f64, f64), high: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    // `a` is the newest point, `b` the other end of the bracket, `c` the point before `a` on its side.
    let ((mut b, mut f_b), (mut a, mut f_a)) = (low, high);
    if f_a <= 0.0 {
        return a;
    }
    // Value below which `f` is rounding, at the size of its terms.
    let negligible = f64::EPSILON * f_b.abs().min(f_a.abs());
    let mut part = 0.5;
    for _ in 0..MOST {
        let m = a + part * (b - a);
        let f_m = f(m);
        let (c, f_c);
        if (f_m > 0.0) == (f_a > 0.0) {
            (c, f_c) = (a, f_a);
        } else {
            (c, f_c) = (b, f_b);
            (b, f_b) = (a, f_a);
        }
        (a, f_a) = (m, f_m);
        let best = if f_a.abs() < f_b.abs() { a } else { b };
        // Size of a rounding step, as a share of the bracket.
        let rounding = 2.0 * f64::EPSILON * best.abs() / (b - a).abs();
        if rounding > 0.5 || f_a.abs() <= negligible {
            return best;
        }
        let (xi, phi) = ((a - b) / (c - b), (f_a - f_b) / (f_c - f_b));
        part = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
        } else {
            0.5
        };
        part = part.max(rounding).min(1.0 - rounding);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::Cell;

    #[test]
    fn roots_of_steep_and_flat_functions_are_found_in_few_evaluations() {
        for (f, root) in [
            ((|x| x * x * x - 2.0) as fn(f64) -> f64, libm::cbrt(2.0)),
            (|x| x * x * x * x - 1e-12, 1e-3),
            (|x| libm::sqrt(x) - 1e-3, 1e-6),
            (|x| if x < 0.7 { 1e-3 * (x - 0.7) } else { 1e3 * (x - 0.7) }, 0.7),
            (|x| 1e9 * (x - 0.1), 0.1),
        ] {
            let count = Cell::new(0);
            let found = increasing(0.0, 3.0, |x| {
                count.set(count.get() + 1);
                f(x)
            });
            assert!((found / root - 1.0).abs() < 1e-14, "{found} {root}");
            assert!(count.get() <= 60, "{root}: {}", count.get());
        }
    }

    #[test]
    fn without_a_change_of_sign_it_is_the_nearer_bound() {
        assert_eq!(increasing(1.0, 2.0, |x| x).to_bits(), 1.0_f64.to_bits());
        assert_eq!(increasing(1.0, 2.0, |x| x - 9.0).to_bits(), 2.0_f64.to_bits());
    }
}
