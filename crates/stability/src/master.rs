//! The position loop that a master closes over a bus, against the largest gain with which it is stable.
//!
//! ```text
//! L(jω) = K·C(z)·T/2·(z + 1)/(z − 1)·e^{−jωD}·H(jω),  z = e^{jωT}      K_u = 1/|L/K| where L is on the negative real axis
//! C(z) = 1 + T/T_i/(z − 1) + T_d·(z − 1)/(T·z + T_f·(z − 1))
//! H = A·k_p·(b + 1/(s·T_i,v))/(J·s) / (1 + A·F·k_p·(1 + 1/(s·T_i,v))/(J·s)),  A = e^{−sT_v/2}/(1 + s/α),  F = e^{−sT_v/2}/(1 + s·T_f,v)
//! ```
//! T is the cycle of the bus, D the round trip with the age of the answer, H the velocity loop of the drive on an axis without springs,
//! as it follows a velocity. With H = 1 and C = 1 it is K_u·T = 2·tan(π·T/(4·D)). Springs, and filters of the drive but that of its
//! velocity, are not in it.
//! Source: docs/fieldbus.md, "The position loop in the master"; Åström & Murray, *Feedback Systems*, 2nd ed., §10.2 (Nyquist).
use crate::model::{Loop, Source, VelocitySignal};
use nalgebra::Complex;
use servobench_drive::Stage;
use std::f64::consts::PI;

/// Frequencies at which the loop is looked at, from [`LOWEST`] of the highest on.
const FREQUENCIES: u32 = 4_000;
/// The lowest frequency, as a share of half the rate of the bus.
const LOWEST: f64 = 1e-5;
/// Bisections of the interval in which the loop comes to the negative real axis: to 1e-12 of it.
const BISECTIONS: u32 = 40;

/// The position loop that a master closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Master {
    /// Gain K (1/s).
    pub gain: f64,
    /// Integral time T_i (s); `None` without an integral.
    pub integral_time: Option<f64>,
    /// Derivative time T_d and time constant T_f of the filter before it (s); `None` without a derivative.
    pub derivative: Option<(f64, f64)>,
    /// Cycle T of the bus (s).
    pub cycle: f64,
    /// Round trip D with the age of the answer (s).
    pub round_trip: f64,
}

impl Master {
    /// The largest stable gain K_u (1/s) above a velocity loop as `model` has it; 0 where no gain is stable.
    #[must_use]
    pub fn largest_gain(&self, model: &Loop) -> f64 {
        let inertia = model.inertia() / model.effort_ratio();
        self.largest_gain_over(|s| velocity_loop(model, inertia, s))
    }

    /// The same above a velocity loop with the frequency response `follows`.
    fn largest_gain_over(&self, follows: impl Fn(Complex<f64>) -> Complex<f64>) -> f64 {
        let highest = PI / self.cycle;
        let at = |omega: f64| self.loop_per_gain(omega) * follows(Complex::new(0.0, omega));
        let frequency = |i: u32| highest * LOWEST.powf(1.0 - f64::from(i) / f64::from(FREQUENCIES));
        let mut below = (frequency(0), at(frequency(0)));
        // What begins above the negative real axis is unstable with the smallest gain.
        if below.1.im > 0.0 {
            return 0.0;
        }
        let mut largest = f64::INFINITY;
        for i in 1..=FREQUENCIES {
            let above = (frequency(i), at(frequency(i)));
            if below.1.re < 0.0 && above.1.re < 0.0 && (below.1.im > 0.0) != (above.1.im > 0.0) {
                largest = largest.min(1.0 / crossing(&at, below, above).norm());
            }
            below = above;
        }
        // At half the rate of the bus it is real.
        if below.1.re < 0.0 { largest.min(1.0 / below.1.norm()) } else { largest }
    }

    /// L/K without the velocity loop.
    fn loop_per_gain(&self, omega: f64) -> Complex<f64> {
        let (t, one) = (self.cycle, Complex::new(1.0, 0.0));
        let z = Complex::from_polar(1.0, omega * t);
        let mut controller = one;
        if let Some(integral_time) = self.integral_time {
            controller += Complex::new(t / integral_time, 0.0) / (z - one);
        }
        if let Some((time, filter)) = self.derivative {
            controller += (z - one) * time / (z * t + (z - one) * filter);
        }
        controller * (z + one) / (z - one) * (t / 2.0) * Complex::from_polar(1.0, -omega * self.round_trip)
    }
}

type Point = (f64, Complex<f64>);

/// Where `at` comes to the real axis between two points on both sides of it.
fn crossing(at: &impl Fn(f64) -> Complex<f64>, mut below: Point, mut above: Point) -> Complex<f64> {
    for _ in 0..BISECTIONS {
        let middle = f64::midpoint(below.0, above.0);
        let point = (middle, at(middle));
        *(if (point.1.im > 0.0) == (below.1.im > 0.0) { &mut below } else { &mut above }) = point;
    }
    above.1
}

/// Velocity per velocity reference at s, of an axis of `inertia` per effort ratio.
fn velocity_loop(model: &Loop, inertia: f64, s: Complex<f64>) -> Complex<f64> {
    let (p, one) = (&model.drive, Complex::new(1.0, 0.0));
    let hold = (-s * (p.period(p.velocity_every) / 2.0)).exp();
    let actuator = match (&p.stage, &model.source) {
        (Stage::Current { params, .. }, Source::Pmsm(motor)) => {
            one / (one + s * (motor.inductance.q / params.gains.k_p.q))
        }
        _ => one,
    };
    let differences = match model.velocity_signal {
        VelocitySignal::Encoder => one,
        VelocitySignal::Differences => hold,
    };
    let filter = differences / (one + s * p.velocity_filter_time);
    let integral = p.velocity.integral_time.map_or(Complex::default(), |time| one / (s * time));
    let forward = hold * actuator * p.velocity.k_p / (s * inertia);
    forward * (integral + p.blocks.reference_weight) / (one + forward * filter * (integral + one))
}

#[cfg(test)]
mod tests {
    use super::*;

    const T: f64 = 1e-3;

    fn master(round_trip: f64) -> Master {
        Master { gain: 1.0, integral_time: None, derivative: None, cycle: T, round_trip }
    }

    /// Without a velocity loop.
    fn at_once(_: Complex<f64>) -> Complex<f64> {
        Complex::new(1.0, 0.0)
    }

    /// Oracle: the table of docs/fieldbus.md.
    #[test]
    fn an_axis_that_is_there_at_once_has_the_gain_of_the_table() {
        for (cycles, expected) in [(1.0, 2.0), (2.0, 0.83), (3.0, 0.54), (5.0, 0.32), (7.0, 0.23)] {
            let found = master(cycles * T).largest_gain_over(at_once) * T;
            assert!((found - expected).abs() < 0.005, "{cycles}: {found}");
            assert!((found - 2.0 * (PI / (4.0 * cycles)).tan()).abs() < 1e-6, "{cycles}: {found}");
        }
    }

    /// Oracle: the table of integral times of docs/fieldbus.md, K·D = θ·sin θ with tan θ = θ·T_i/D, for cycles much shorter than D.
    #[test]
    fn an_integral_costs_gain_as_the_table_has_it() {
        let delay = 400.0 * T;
        for (ratio, expected) in [(0.9, 0.0), (2.0, 1.07), (4.0, 1.37), (10.0, 1.50), (20.0, 1.54)] {
            let integral = Master { integral_time: Some(ratio * delay), ..master(delay) };
            let found = integral.largest_gain_over(at_once) * delay;
            assert!((found - expected).abs() < 0.006, "{ratio}: {found}");
        }
        let derivative = Master { derivative: Some((0.2 * delay, 0.02 * delay)), ..master(delay) };
        let found = derivative.largest_gain_over(at_once) * delay;
        assert!((found - 1.78).abs() < 0.01, "docs/fieldbus.md: {found}");
    }

    /// Oracle: by hand. A lag τ and a dead time D = τ: ω·τ + atan(ω·τ) = π/2 at ω·τ = 0.86033, K·τ = ω·τ·√(1 + (ω·τ)²) = 1.1349.
    #[test]
    fn a_lag_of_the_velocity_loop_costs_gain() {
        let delay = 300.0 * T;
        let found = master(delay).largest_gain_over(|s| Complex::new(1.0, 0.0) / (s * delay + 1.0)) * delay;
        assert!((found - 1.1349).abs() < 1e-3, "{found}");
    }
}
