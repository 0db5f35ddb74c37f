//! Motion after a move as a sum of what a linear system at rest input can do.
//!
//! ```text
//! y(t) = c + Σ B·(1 − e^{−λt})/(λT) + Σ e^{−σt}·(a·cos ω_d·t + b·sin ω_d·t)
//! ```
//! Real poles are written so that they stay well conditioned down to λ = 0, where they are a straight line.
use super::series::Series;
use core::f64::consts::PI;

/// One component beside the constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Component {
    /// A real pole at −`rate` (1/s): an aperiodic tail.
    Tail {
        /// λ (1/s).
        rate: f64,
    },
    /// A pair of complex poles at −`decay` ± i·`frequency`.
    Oscillation {
        /// σ = ζ·ω (1/s).
        decay: f64,
        /// ω_d, damped (rad/s).
        frequency: f64,
    },
}

/// Steps of the recurrences between two fresh evaluations of the transcendental functions; each step rounds once.
const FRESH: usize = 64;

impl Component {
    /// Number of linear coefficients; equal to the number of non-linear parameters.
    pub(crate) const fn width(self) -> usize {
        match self {
            Self::Tail { .. } => 1,
            Self::Oscillation { .. } => 2,
        }
    }

    /// Appends the columns that the coefficients multiply.
    pub(crate) fn columns(self, series: &Series, columns: &mut Vec<Vec<f64>>) {
        let count = series.values.len();
        match self {
            Self::Tail { rate } => {
                let length = series.length();
                columns.push((0..count).map(|k| tail(rate, series.time(k), length)).collect());
            }
            Self::Oscillation { decay, frequency } => {
                let (mut cosines, mut sines) = (Vec::with_capacity(count), Vec::with_capacity(count));
                let turn = point(decay, frequency, series.step);
                let mut z = (1.0, 0.0);
                for k in 0..count {
                    z = if k % FRESH == 0 { point(decay, frequency, series.time(k)) } else { product(z, turn) };
                    cosines.push(z.0);
                    sines.push(z.1);
                }
                columns.extend([cosines, sines]);
            }
        }
    }

    /// Appends the derivatives of this component, with these `columns` and `coefficients`, by its non-linear
    /// parameters.
    pub(crate) fn derivatives(
        self,
        series: &Series,
        columns: &[Vec<f64>],
        coefficients: &[f64],
        derivatives: &mut Vec<Vec<f64>>,
    ) {
        let times = (0..series.values.len()).map(|k| series.time(k));
        match self {
            Self::Tail { rate } => {
                let (b, length) = (coefficients[0], series.length());
                derivatives.push(times.map(|t| b * tail_by_rate(rate, t, length)).collect());
            }
            Self::Oscillation { .. } => {
                let (a, b) = (coefficients[0], coefficients[1]);
                let rows = || times.clone().zip(&columns[0]).zip(&columns[1]);
                derivatives.push(rows().map(|((t, cos), sin)| -t * (a * cos + b * sin)).collect());
                derivatives.push(rows().map(|((t, cos), sin)| t * (b * cos - a * sin)).collect());
            }
        }
    }

    /// The component with its parameters moved by `step`, as far as a series of this kind can show them.
    pub(crate) fn moved(self, step: &[f64], series: &Series) -> Self {
        let (length, interval) = (series.length(), series.step);
        match self {
            // A tail that grows takes over from a drift; tenfold at most.
            Self::Tail { rate } => Self::Tail { rate: (rate + step[0]).clamp(-2.3 / length, 10.0 / interval) },
            Self::Oscillation { decay, frequency } => Self::Oscillation {
                decay: (decay + step[0]).clamp(-20.0 / length, 10.0 / interval),
                frequency: (frequency + step[1]).clamp(1.0 / length, 0.98 * PI / interval),
            },
        }
    }
}

/// `(1 − e^{−λt})/(λT)`.
pub(crate) fn tail(rate: f64, t: f64, length: f64) -> f64 {
    let u = rate * t;
    t / length * if u.abs() < 1e-8 { 1.0 - u / 2.0 } else { -libm::expm1(-u) / u }
}

/// Derivative of [`tail`] by λ: `t²/T·(e^{−u}·(1 + u) − 1)/u²`, u = λt.
fn tail_by_rate(rate: f64, t: f64, length: f64) -> f64 {
    let u = rate * t;
    let g = if u.abs() < 1e-3 {
        // Truncated after the cube, whose coefficient is 1/30.
        -0.5 + u * (1.0 / 3.0 - u / 8.0)
    } else {
        (libm::exp(-u) * (1.0 + u) - 1.0) / (u * u)
    };
    t * t / length * g
}

/// `e^{(−σ + iω)t}`.
fn point(decay: f64, frequency: f64, t: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(frequency * t);
    let envelope = libm::exp(-decay * t);
    (envelope * cos, envelope * sin)
}

fn product((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    (a * c - b * d, a * d + b * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series() -> Series {
        Series::thinned(&[0.0; 300], 0.2e-3, 1e-3, 1, 300)
    }

    fn value(component: Component, coefficients: &[f64], k: usize) -> f64 {
        let mut columns = Vec::new();
        component.columns(&series(), &mut columns);
        columns.iter().zip(coefficients).map(|(column, c)| column[k] * c).sum()
    }

    /// Columns are what the formula says; derivatives are what central differences say (error of the order of step²).
    #[test]
    fn columns_and_derivatives() {
        let series = series();
        for (component, coefficients) in [
            (Component::Oscillation { decay: 3.0, frequency: 200.0 }, vec![0.7, -0.4]),
            (Component::Tail { rate: 12.0 }, vec![1.3]),
            (Component::Tail { rate: 1e-4 }, vec![1.3]),
        ] {
            let (mut columns, mut derivatives) = (Vec::new(), Vec::new());
            component.columns(&series, &mut columns);
            component.derivatives(&series, &columns, &coefficients, &mut derivatives);
            for k in [0, 63, 64, 65, 299] {
                let t = series.time(k);
                let exact = match component {
                    Component::Oscillation { decay, frequency } => {
                        (-decay * t).exp() * (0.7 * (frequency * t).cos() - 0.4 * (frequency * t).sin())
                    }
                    Component::Tail { rate } => 1.3 * (1.0 - (-rate * t).exp()) / (rate * 0.299),
                };
                assert!((value(component, &coefficients, k) - exact).abs() < 1e-11, "{component:?} {k}");
                for (p, derivative) in derivatives.iter().enumerate() {
                    let step = |sign: f64| {
                        let mut step = vec![0.0; component.width()];
                        step[p] = sign * 1e-3;
                        value(component.moved(&step, &series), &coefficients, k)
                    };
                    let difference = (step(1.0) - step(-1.0)) / 2e-3;
                    assert!((derivative[k] - difference).abs() < 1e-8, "{component:?} {p} {k}");
                }
            }
        }
    }

    #[test]
    fn poles_stay_where_the_series_can_show_them() {
        let mode = Component::Oscillation { decay: 0.0, frequency: 200.0 };
        let moved = |step: [f64; 2]| mode.moved(&step, &series());
        assert_eq!(moved([5.0, 5.0]), Component::Oscillation { decay: 5.0, frequency: 205.0 });
        // 1 kHz: below the Nyquist frequency; 0.299 s: at least a radian, growing by e²⁰ at most.
        assert_eq!(moved([0.0, 1e4]), Component::Oscillation { decay: 0.0, frequency: 980.0 * PI });
        let Component::Oscillation { decay, frequency } = moved([-1e4, -1e4]) else { panic!("still a mode") };
        assert!((frequency * 0.299 - 1.0).abs() < 1e-12 && (decay * 0.299 + 20.0).abs() < 1e-12);
    }
}
