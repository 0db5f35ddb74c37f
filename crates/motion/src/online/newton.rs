//! The root of an increasing function whose slope is known.
use core::cell::Cell;

/// Maximum number of steps: bisection alone takes 60 to the rounding of the bounds.
const MOST: usize = 100;

/// The last step of Newton's method, as a part of the time: the one after it would be its square.
const LAST: f64 = 1e-12;

/// Largest remainder before that step, relative to the largest value: it is more where the slope has no bounds.
const SMALL: f64 = 1e-11;

/// The last root, at which the search for the next one begins, for a function that has changed little.
#[derive(Debug)]
pub(crate) struct Near(Cell<f64>);

impl Near {
    pub(crate) const fn to(time: f64) -> Self {
        Self(Cell::new(time))
    }

    /// Without any root yet.
    pub(crate) const fn nothing() -> Self {
        Self::to(f64::NAN)
    }
}

/// Interval of a root.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bracket {
    /// Time at which the function is below zero, by `missing`.
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) missing: f64,
}

impl Bracket {
    /// Root of `f`, which increases and returns its value and its slope; `None` when it stays below zero.
    ///
    /// Newton's method as long as its steps stay in the bracket and halve, bisection elsewhere. It begins at the last root, or,
    /// if that is outside the bracket, as if `f` grew with the power of the time of which `inverse` is the root.
    pub(crate) fn root(&self, near: &Near, inverse: impl Fn(f64) -> f64, f: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
        let Self { mut low, mut high, missing } = *self;
        let (mut time, mut is_reached) = (near.0.get(), false);
        if !(time > low && time < high) {
            let beyond = f(high).0;
            if beyond < 0.0 {
                return None;
            }
            (time, is_reached) = (low + (high - low) * inverse(missing / (missing + beyond)), true);
        }
        let (mut before, mut largest) = (high - low, missing);
        for _ in 0..MOST {
            let (value, slope) = f(time);
            if value >= 0.0 {
                (high, is_reached) = (time, true);
            } else if time < high {
                low = time;
            } else {
                return None;
            }
            largest = largest.max(value.abs());
            let step = value / slope;
            let next = time - step;
            let rounding;
            (time, before, rounding) = if next >= low && next <= high && 2.0 * step.abs() <= before {
                (next, step.abs(), if value.abs() <= SMALL * largest { LAST } else { f64::EPSILON })
            } else if is_reached {
                (0.5 * (low + high), 0.5 * (high - low), f64::EPSILON)
            } else {
                (high, high - low, 0.0)
            };
            if before <= rounding * time {
                break;
            }
        }
        near.0.set(time);
        Some(time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function with its slope, its root, and the number of its evaluations.
    type Case = (fn(f64) -> (f64, f64), f64, u32);

    const CASES: [Case; 4] = [
        (|x| (x * x * x - 2.0, 3.0 * x * x), 1.259_921_049_894_873_2, 8),
        // A power is met at once, with one step that confirms it.
        (|x| (x * x * x - 1e-12, 3.0 * x * x), 1e-4, 3),
        (|x| if x < 0.7 { (x - 0.7, 1.0) } else { (1e3 * (x - 0.7), 1e3) }, 0.7, 8),
        (|x| (libm::sqrt(x) - 1e-3, 0.5 / libm::sqrt(x)), 1e-6, 30),
    ];

    #[test]
    fn roots_are_found_in_few_steps_and_fewer_near_the_last() {
        for (f, root, most) in CASES {
            let count = Cell::new(0);
            let counted = |x| {
                count.set(count.get() + 1);
                f(x)
            };
            let (near, bracket) = (Near::nothing(), Bracket { low: 0.0, high: 3.0, missing: -f(0.0).0 });
            let found = bracket.root(&near, libm::cbrt, counted).unwrap();
            assert!((found / root - 1.0).abs() < 1e-14, "{found} {root}");
            assert!(count.get() <= most, "{root}: {}", count.get());
            let first = count.replace(0);
            assert!((bracket.root(&near, libm::cbrt, counted).unwrap() / root - 1.0).abs() < 1e-14, "{root}");
            assert!(count.get() < first, "{root}: {} {first}", count.get());
        }
    }

    #[test]
    fn without_a_slope_it_is_bisection() {
        let bracket = Bracket { low: 0.0, high: 3.0, missing: 0.1 };
        let found = bracket.root(&Near::nothing(), libm::cbrt, |x| (x - 0.1, 0.0)).unwrap();
        assert!((found / 0.1 - 1.0).abs() < 1e-14, "{found}");
    }

    #[test]
    fn a_function_that_stays_below_has_none() {
        let bracket = Bracket { low: 0.0, high: 1.0, missing: 2.0 };
        for near in [Near::nothing(), Near::to(0.5)] {
            assert_eq!(bracket.root(&near, libm::cbrt, |x| (x - 2.0, 1.0)), None);
        }
    }
}
