//! Motion after a move as a sum of the free responses of a linear system.
//!
//! ```text
//! y(t) = c + Σ B·(1 − e^{−λt})/(λT) + Σ e^{−σt}·(a·cos √q·t + b·sin(√q·t)/√q)
//! ```
//! Real poles are written so that they stay well conditioned down to λ = 0, where they are a straight line. Pairs of
//! poles are written so that they pass without a seam from an oscillation (q = ω_d² > 0) through a double pole (q = 0)
//! to two tails (q < 0, where sine and cosine are hyperbolic): a fit that needs two tails does not end at the border.
use super::columns::Columns;
use super::series::Series;
use super::turns::{FRESH, by_addition};
use core::f64::consts::PI;

/// One component beside the constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Component {
    /// A real pole at −`rate`: an aperiodic tail.
    Tail {
        /// λ (1/s).
        rate: f64,
    },
    /// Two poles at −`decay` ± √(−`square`).
    Pair {
        /// σ (1/s).
        decay: f64,
        /// q (1/s²).
        square: f64,
    },
}

/// A pair of complex poles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Oscillation {
    /// σ = ζ·ω (1/s).
    pub(crate) decay: f64,
    /// ω_d = ω·√(1 − ζ²) (rad/s).
    pub(crate) damped: f64,
}

/// Fastest decay that differs from a jump, per step.
const FASTEST: f64 = 10.0;
/// Exponents over a whole series below which an exponential is a straight line with a curvature.
const STRAIGHT: f64 = 1e-6;
/// Growth of a tail over the series, as a power of e: tenfold at most. A tail that grows takes over from a drift.
const TAIL_GROWTH: f64 = 2.3;
/// The same for an oscillation.
const GROWTH: f64 = 20.0;
/// Largest frequency, in Nyquist frequencies.
const NYQUIST: f64 = 0.98;

impl Oscillation {
    /// Natural frequency ω/2π (Hz).
    pub(crate) fn frequency(self) -> f64 {
        libm::hypot(self.decay, self.damped) / (2.0 * PI)
    }

    /// Damping ratio ζ.
    pub(crate) fn damping(self) -> f64 {
        self.decay / libm::hypot(self.decay, self.damped)
    }
}

impl Component {
    /// The pair of poles of natural frequency `frequency` (Hz) and damping ratio `damping`.
    pub(crate) fn oscillating_at(frequency: f64, damping: f64) -> Self {
        let omega = 2.0 * PI * frequency;
        Self::Pair { decay: damping * omega, square: omega * omega * (1.0 - damping * damping) }
    }

    /// A pair of poles with the natural frequency `frequency` (Hz) and a small damping ratio: `ω_d = ω` is near enough to
    /// start from.
    pub(crate) fn oscillating(frequency: f64, damping: f64) -> Self {
        let omega = 2.0 * PI * frequency;
        Self::Pair { decay: damping * omega, square: omega * omega }
    }

    /// The oscillation of this component; `None` for tails.
    pub(crate) fn oscillation(self) -> Option<Oscillation> {
        match self {
            Self::Pair { decay, square } if square > 0.0 => Some(Oscillation { decay, damped: square.sqrt() }),
            _ => None,
        }
    }

    /// Number of linear coefficients; equal to the number of non-linear parameters.
    pub(crate) const fn width(self) -> usize {
        match self {
            Self::Tail { .. } => 1,
            Self::Pair { .. } => 2,
        }
    }

    /// Adds the columns of its coefficients.
    pub(crate) fn add_to(self, columns: &mut Columns, series: &Series) {
        match self {
            Self::Tail { rate } => add_tail(rate, columns, series),
            Self::Pair { decay, square } => {
                let (cosines, sines) = columns.add(2).split_at_mut(series.values.len());
                let at = |k| pair(decay, square, series.time(k));
                by_addition(at, pair(decay, square, series.step), square, cosines, sines);
            }
        }
    }

    /// Adds the derivatives of this component, whose columns begin at `first` among `columns` and have these `coefficients`, with respect
    /// to its non-linear parameters.
    pub(crate) fn add_derivatives_to(
        self,
        derivatives: &mut Columns,
        series: &Series,
        columns: &Columns,
        first: usize,
        coefficients: &[f64],
    ) {
        let times = (0..series.values.len()).map(|k| series.time(k));
        match self {
            Self::Tail { rate } => {
                let (b, length) = (coefficients[0], series.length());
                let rows = times.zip(columns.column(first));
                derivatives.push(rows.map(|(t, y)| b * tail_by_rate(rate, t, length, *y)));
            }
            Self::Pair { decay, square } => {
                let (a, b) = (coefficients[0], coefficients[1]);
                let rows =
                    times.zip(columns.column(first)).zip(columns.column(first + 1)).map(|((t, c), s)| (t, *c, *s));
                derivatives.push(rows.clone().map(|(t, c, s)| -t * (a * c + b * s)));
                derivatives.push(rows.map(|(t, c, s)| b * sine_by_square(decay, square, t, c, s) - 0.5 * a * t * s));
            }
        }
    }

    /// The component with its parameters moved by `step`, as far as a series of this kind can show them.
    pub(crate) fn moved(self, step: &[f64], series: &Series) -> Self {
        let (slowest, fastest) = (-TAIL_GROWTH / series.length(), FASTEST / series.step);
        match self {
            Self::Tail { rate } => Self::Tail { rate: (rate + step[0]).clamp(slowest, fastest) },
            Self::Pair { decay, square } => {
                let decay = (decay + step[0]).clamp(-GROWTH / series.length(), fastest);
                // Two tails keep to the bounds of one.
                let apart = (decay - slowest).min(fastest - decay).max(0.0);
                let highest = NYQUIST * PI / series.step;
                Self::Pair { decay, square: (square + step[1]).clamp(-apart * apart, highest * highest) }
            }
        }
    }
}

/// `(1 − e^{−λt})/(λT)`.
pub(crate) fn tail(rate: f64, t: f64, length: f64) -> f64 {
    let u = rate * t;
    t / length * if u.abs() < 1e-8 { 1.0 - u / 2.0 } else { -libm::expm1(-u) / u }
}

/// Adds the column of the [`tail`] of `rate`: `e^{−λt} − 1` by the addition theorem `E(s + t) = E(s)·E(t) + E(s) + E(t)`, which keeps
/// its digits where it is small, with fresh values in between.
fn add_tail(rate: f64, columns: &mut Columns, series: &Series) {
    let length = series.length();
    let count = series.values.len();
    if (rate * series.time(count)).abs() < STRAIGHT {
        columns.push((0..count).map(|k| tail(rate, series.time(k), length)));
        return;
    }
    let (step, scale) = (libm::expm1(-rate * series.step), -1.0 / (rate * length));
    for (group, rows) in columns.add(1).chunks_mut(FRESH).enumerate() {
        let mut here = libm::expm1(-rate * series.time(group * FRESH));
        for row in rows {
            *row = here * scale;
            here += step * (1.0 + here);
        }
    }
}

/// Derivative of [`tail`], here `y`, by λ: `t²/T·(e^{−u}·(1 + u) − 1)/u²`, u = λt.
fn tail_by_rate(rate: f64, t: f64, length: f64, y: f64) -> f64 {
    let u = rate * t;
    let g = if u.abs() < 1e-3 {
        // Truncated after the cube, whose coefficient is 1/30.
        -0.5 + u * (1.0 / 3.0 - u / 8.0)
    } else {
        let decayed = 1.0 - rate * length * y;
        (decayed * (1.0 + u) - 1.0) / (u * u)
    };
    t * t / length * g
}

/// `e^{−σt}·cos √q·t` and `e^{−σt}·sin(√q·t)/√q`.
fn pair(decay: f64, square: f64, t: f64) -> (f64, f64) {
    let root = square.abs().sqrt();
    if square > 0.0 {
        let (sin, cos) = libm::sincos(root * t);
        let envelope = libm::exp(-decay * t);
        (envelope * cos, envelope * sin / root)
    } else if square < 0.0 {
        // cosh and sinh without the difference of two exponentials, which would cancel.
        let slow = libm::exp((root - decay) * t);
        let apart = libm::expm1(-2.0 * root * t);
        (slow * (1.0 + 0.5 * apart), -slow * apart / (2.0 * root))
    } else {
        let envelope = libm::exp(-decay * t);
        (envelope, envelope * t)
    }
}

/// Derivative by q of the `s` of the [`pair`] (`c`, `s`) at `t`: `(t·c − s)/2q`.
fn sine_by_square(decay: f64, square: f64, t: f64, c: f64, s: f64) -> f64 {
    let u = square * t * t;
    if u.abs() < 1e-2 {
        // Truncated after the square; the next coefficient is 1/90720.
        t * t * t * libm::exp(-decay * t) * (-1.0 / 6.0 + u * (1.0 / 60.0 - u / 1680.0))
    } else {
        (t * c - s) / (2.0 * square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Case = (Component, Vec<f64>, Box<dyn Fn(f64) -> f64>);

    fn series() -> Series {
        Series::thinned(&[0.0; 300], 0.2e-3, 1e-3, 1, 300)
    }

    fn value(component: Component, coefficients: &[f64], k: usize) -> f64 {
        columns_of(component).iter().zip(coefficients).map(|(column, c)| column[k] * c).sum()
    }

    fn columns_of(component: Component) -> Columns {
        let mut columns = Columns::new(series().values.len(), 2);
        component.add_to(&mut columns, &series());
        columns
    }

    /// Columns match the formula, and derivatives match central differences: an error of the
    /// order of step², and rounding over step. Both sides of q = 0, and close to it.
    #[test]
    fn columns_and_derivatives() {
        let series = series();
        let (a, b) = (0.7, -40.0);
        let tail = |rate: f64| move |t: f64| 1.3 * (1.0 - (-rate * t).exp()) / (rate * 0.299);
        let oscillation = move |decay: f64, q: f64| {
            move |t: f64| (-decay * t).exp() * (a * (q.sqrt() * t).cos() + b * (q.sqrt() * t).sin() / q.sqrt())
        };
        let tails = move |decay: f64, q: f64| {
            let r = (-q).sqrt();
            move |t: f64| (-decay * t).exp() * (a * (r * t).cosh() + b * (r * t).sinh() / r)
        };
        let cases: [Case; 7] = [
            (Component::Tail { rate: 12.0 }, vec![1.3], Box::new(tail(12.0))),
            (Component::Tail { rate: 1e-4 }, vec![1.3], Box::new(tail(1e-4))),
            (Component::Pair { decay: 3.0, square: 4e4 }, vec![a, b], Box::new(oscillation(3.0, 4e4))),
            (Component::Pair { decay: 3.0, square: 1e-2 }, vec![a, b], Box::new(oscillation(3.0, 1e-2))),
            (
                Component::Pair { decay: 3.0, square: 0.0 },
                vec![a, b],
                Box::new(move |t| (-3.0 * t).exp() * (a + b * t)),
            ),
            (Component::Pair { decay: 3.0, square: -1e-2 }, vec![a, b], Box::new(tails(3.0, -1e-2))),
            (Component::Pair { decay: 30.0, square: -400.0 }, vec![a, b], Box::new(tails(30.0, -400.0))),
        ];
        for (component, coefficients, exact) in cases {
            let mut derivatives = Columns::new(series.values.len(), 2);
            component.add_derivatives_to(&mut derivatives, &series, &columns_of(component), 0, &coefficients);
            for k in [0, 63, 64, 65, 299] {
                let exact = exact(series.time(k));
                assert!((value(component, &coefficients, k) - exact).abs() < 1e-11, "{component:?} {k}");
                for (p, derivative) in derivatives.iter().enumerate() {
                    let step = |sign: f64| {
                        let mut step = vec![0.0; component.width()];
                        step[p] = sign * 1e-3;
                        value(component.moved(&step, &series), &coefficients, k)
                    };
                    let difference = (step(1.0) - step(-1.0)) / 2e-3;
                    assert!((derivative[k] - difference).abs() < 1e-7, "{component:?} {p} {k}");
                }
            }
        }
    }

    #[test]
    fn poles_stay_where_the_series_can_show_them() {
        let mode = Component::oscillating(100.0 / PI, 0.0);
        let moved = |step: [f64; 2]| mode.moved(&step, &series());
        assert_eq!(moved([5.0, 0.0]), Component::Pair { decay: 5.0, square: 4e4 });
        // 1 kHz: below the Nyquist frequency; 0.299 s: growing by e²⁰ at most, where no tail may be.
        let Component::Pair { square, .. } = moved([0.0, 1e8]) else { panic!("still a pair") };
        assert!((square.sqrt() / (980.0 * PI) - 1.0).abs() < 1e-12);
        let Component::Pair { decay, square } = moved([-1e4, -1e8]) else { panic!("still a pair") };
        assert!((decay * 0.299 + 20.0).abs() < 1e-12 && square.abs() < 1e-12);
        // Two tails: the slow one grows tenfold at most.
        let Component::Pair { decay, square } = moved([50.0, -1e8]) else { panic!("still a pair") };
        assert!(((decay - (-square).sqrt()) * 0.299 + 2.3).abs() < 1e-9);
    }
}
