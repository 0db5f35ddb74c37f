//! Response of a flexible load to the motor, row by row.
//!
//! ```text
//! y = Σ w·z        z″ + d·z′ + ω²·(z − x − τ·x′) = 0        x the motor's position, Σ w = 1
//! ```
//! Each mode is discretised exactly for an input that is constant over a row, its mean, so that no frequency makes it unstable.
//! Source: Åström & Wittenmark, *Computer-Controlled Systems*, 3rd ed., §2.3.

use servobench_base::HeldMode;

/// A [`HeldMode`] discretised, with its state.
#[derive(Debug, Clone, Copy)]
struct Swinging {
    mode: HeldMode,
    /// Transition of the distance from the input and of the velocity.
    transition: [[f64; 2]; 2],
    position: f64,
    velocity: f64,
}

impl Swinging {
    fn new(mode: HeldMode, h: f64) -> Self {
        let sigma = mode.decay / 2.0;
        let squared = mode.omega.powi(2) - sigma.powi(2);
        let damped = squared.abs().sqrt();
        let (fades, x) = ((-sigma * h).exp(), damped * h);
        let (c, s) = if squared > 0.0 {
            (fades * x.cos(), fades * x.sin() / damped)
        } else if x == 0.0 {
            (fades, fades * h)
        } else {
            // e^(−σh)·cosh and ·sinh, which alone would overflow.
            let (slow, fast) = (((damped - sigma) * h).exp() / 2.0, ((-damped - sigma) * h).exp() / 2.0);
            (slow + fast, (slow - fast) / damped)
        };
        let transition = [[c + sigma * s, s], [-mode.omega.powi(2) * s, c - sigma * s]];
        Self { mode, transition, position: 0.0, velocity: 0.0 }
    }

    fn step(&mut self, mean: f64, velocity: f64) {
        let input = mean + self.mode.lead * velocity;
        let [[a, b], [c, d]] = self.transition;
        let (off, before) = (self.position - input, self.velocity);
        self.position = input + a * off + b * before;
        self.velocity = c * off + d * before;
    }
}

/// A load on its springs; without modes, its position is that of the motor.
#[derive(Debug, Clone)]
pub(super) struct FlexibleLoad {
    modes: Vec<Swinging>,
    h: f64,
    /// Last position of the motor.
    motor: f64,
}

impl FlexibleLoad {
    /// At rest at zero; a row lasts `h` (s).
    pub(super) fn new(modes: &[HeldMode], h: f64) -> Self {
        Self { modes: modes.iter().map(|mode| Swinging::new(*mode, h)).collect(), h, motor: 0.0 }
    }

    /// Position of the load.
    pub(super) fn position(&self) -> f64 {
        if self.modes.is_empty() {
            return self.motor;
        }
        self.modes.iter().map(|mode| mode.mode.weight * mode.position).sum()
    }

    /// Puts motor and load at `position` with `velocity`.
    pub(super) fn put(&mut self, position: f64, velocity: f64) {
        self.motor = position;
        for mode in &mut self.modes {
            (mode.position, mode.velocity) = (position, velocity);
        }
    }

    /// To the next row, in which the motor is at `motor`.
    pub(super) fn step(&mut self, motor: f64) {
        let (mean, velocity) = (f64::midpoint(self.motor, motor), (motor - self.motor) / self.h);
        for mode in &mut self.modes {
            mode.step(mean, velocity);
        }
        self.motor = motor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(omega: f64, zeta: f64) -> FlexibleLoad {
        FlexibleLoad::new(&[HeldMode { weight: 1.0, omega, decay: 2.0 * zeta * omega, lead: 0.0 }], 1e-3)
    }

    /// Oracle: the step response of an undamped load, 1 − cos(ω·t), of one at its limit, 1 − (1 + ω·t)·e^(−ω·t), and of one far
    /// beyond it, 1 − e^(−ω·t/(2ζ)).
    #[test]
    fn a_step_is_followed_as_the_damping_says() {
        let (omega, t) = (60.0, 0.02);
        let x = omega * t;
        for (zeta, exact) in
            [(0.0, 1.0 - f64::cos(x)), (1.0, 1.0 - (1.0 + x) * f64::exp(-x)), (2e3, 1.0 - f64::exp(-x / 4e3))]
        {
            let mut load = one(omega, zeta);
            load.motor = 1.0;
            (0..20).for_each(|_| load.step(1.0));
            assert!((load.position() - exact).abs() < 1e-6, "{zeta}: {} {exact}", load.position());
        }
    }

    /// Oracle: behind a ramp a load lags by (2ζ/ω − τ)·v, and beside a sine of 10 rad/s it swings by 1/(1 − (10/60)²).
    #[test]
    fn a_motion_is_followed_as_an_oscillator_does() {
        let mut load = FlexibleLoad::new(&[HeldMode { weight: 1.0, omega: 60.0, decay: 48.0, lead: 4e-3 }], 1e-3);
        (1..=2_000).for_each(|k| load.step(0.3e-3 * f64::from(k)));
        let lag = 0.6 - load.position();
        assert!((lag - 0.3 * (48.0 / 3600.0 - 4e-3)).abs() < 1e-9, "{lag}");
        let mut load = one(60.0, 0.0);
        let gain = 1.0 / (1.0 - 1.0 / 36.0);
        load.put(0.0, 10.0 * gain);
        let worst = (1..=2_000).map(|k| {
            let (before, now) = (f64::from(k - 1) * 1e-2, f64::from(k) * 1e-2);
            load.motor = before.sin();
            load.step(now.sin());
            (load.position() - gain * now.sin()).abs()
        });
        assert!(worst.fold(0.0, f64::max) < 1e-4);
    }

    #[test]
    fn no_frequency_makes_it_unstable_and_without_modes_it_is_rigid() {
        for (omega, zeta) in [(1e7, 0.0), (1e7, 1e3), (1e-3, 1e6)] {
            let mut load = one(omega, zeta);
            (0..1_000).for_each(|_| load.step(1.0));
            assert!(load.position().abs() <= 2.1, "{omega} {zeta}: {}", load.position());
        }
        let mut rigid = FlexibleLoad::new(&[], 1e-3);
        rigid.step(0.7);
        assert!((rigid.position() - 0.7).abs() < 1e-15);
    }
}
