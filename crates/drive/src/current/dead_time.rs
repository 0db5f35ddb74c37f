//! Compensation of the inverter's dead time: adds the lost voltage of each leg to its reference.
//!
//! ```text
//! Δu_x = ΔU·sat(i_x/i_0)      ΔU = t_d·f·U_dc      x = a, b, c
//! ```
//! While both switches of a leg are open, the diode that carries the current sets its voltage: the mean of the leg over a carrier period is
//! off by t_d·f·U_dc against the current. The sign is that of the reference, which has no ripple, at the rotor angle of application; below
//! i_0 the leg's capacitance makes the loss linear, and so does the compensation. The common part of the three legs does not reach the
//! motor.
//! Source: Jeong, Park, *IEEE Trans. Industrial Electronics* 38(2), 1991; Holmes & Lipo, *Pulse Width Modulation for Power Converters*,
//! §2.5 (dead time).
use servobench_base::AlphaBeta;
use servobench_config::Kind::Plain;
use servobench_config::quantities::{CURRENT, FREQUENCY, TIME};
use servobench_config::{ParameterError, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the dead-time compensation.
    pub enum Parameter {
        /// Dead time of a leg as the drive knows it
        DEAD_TIME "dead time that is compensated" = not_negative(Plain(&TIME), "2 us");
        /// Frequency of the carrier as the drive knows it
        FREQUENCY "carrier frequency that is compensated for" = positive(Plain(&FREQUENCY), "8 kHz");
        /// Phase current below which the compensation is proportional to the current
        LINEAR_ZONE "linear zone of the compensation of dead time" = not_negative(Plain(&CURRENT), "0.1 Apk");
    }
}

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Dead time t_d (s).
    pub dead_time: f64,
    /// Carrier frequency f (Hz).
    pub frequency: f64,
    /// Linear zone i_0 (A, peak); 0 for a step.
    pub linear_zone: f64,
    /// Assumed voltage U_dc of the DC link (V).
    pub dc_link: f64,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        Parameter::DEAD_TIME.check(self.dead_time)?;
        Parameter::FREQUENCY.check(self.frequency)?;
        Parameter::LINEAR_ZONE.check(self.linear_zone)?;
        super::Parameter::DC_LINK.check(self.dc_link).map(|_| ())
    }

    /// Mean voltage loss of a leg (V): t_d·f·U_dc.
    #[must_use]
    pub fn loss(&self) -> f64 {
        self.dead_time * self.frequency * self.dc_link
    }

    /// Compensating voltage while `current` (A) flows (V).
    #[inline]
    #[must_use]
    pub fn voltage(&self, current: AlphaBeta) -> AlphaBeta {
        let (half, root) = (current.alpha / 2.0, libm::sqrt(0.75) * current.beta);
        let [a, b, c] = [current.alpha, root - half, -root - half].map(|i| self.of_leg(i));
        AlphaBeta { alpha: (2.0 * a - b - c) / 3.0, beta: (b - c) / libm::sqrt(3.0) }
    }

    fn of_leg(&self, i: f64) -> f64 {
        if i.abs() < self.linear_zone {
            self.loss() * i / self.linear_zone
        } else if i == 0.0 {
            0.0
        } else {
            self.loss().copysign(i)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{PI, TAU};

    const P: Params = Params { dead_time: 2.3e-6, frequency: 8e3, linear_zone: 0.0, dc_link: 537.0 };

    /// n-th harmonic of the α and the β voltage under a rotating current of `amplitude`: real parts of cos and of sin.
    fn harmonic(p: &Params, amplitude: f64, n: f64) -> (f64, f64) {
        // Not a multiple of six, so that no sample is on a step.
        const SAMPLES: u32 = 100_003;
        let mut sum = (0.0, 0.0);
        for k in 0..SAMPLES {
            let angle = TAU * f64::from(k) / f64::from(SAMPLES);
            let u = p.voltage(AlphaBeta { alpha: amplitude * angle.cos(), beta: amplitude * angle.sin() });
            sum = (sum.0 + u.alpha * (n * angle).cos(), sum.1 + u.beta * (n * angle).sin());
        }
        (2.0 * sum.0 / f64::from(SAMPLES), 2.0 * sum.1 / f64::from(SAMPLES))
    }

    /// Oracle: Fourier series of a square wave: 4/(πn)·ΔU, alternating; in the motor without the multiples of three. The β voltage of the
    /// harmonics 6m − 1 rotates backwards.
    #[test]
    fn a_turning_current_meets_the_harmonics_of_a_square_wave() {
        let loss = 2.3e-6 * 8e3 * 537.0;
        for (n, alpha, beta) in [(1.0, 1.0, 1.0), (3.0, 0.0, 0.0), (5.0, 1.0, -1.0), (7.0, -1.0, -1.0), (9.0, 0.0, 0.0)]
        {
            let (a, b) = harmonic(&P, 4.3, n);
            let size = 4.0 / (PI * n) * loss;
            // A step is between two samples: 1e-5 of a turn.
            assert!((a - alpha * size).abs() < 1e-4 * loss && (b - beta * size).abs() < 1e-4 * loss, "{n}: {a} {b}");
        }
    }

    /// Oracle: the describing function of a saturation: (2/π)·(asin(r) + r·√(1 − r²))·ΔU/i_0 per ampere, r = i_0/i.
    #[test]
    fn near_zero_it_is_a_line() {
        let p = Params { linear_zone: 0.7, ..P };
        for amplitude in [0.4, 0.9, 3.1] {
            let r = (0.7_f64 / amplitude).min(1.0);
            let exact = 2.0 / PI * (r.asin() + r * (1.0 - r * r).sqrt()) * p.loss() / 0.7 * amplitude;
            let (found, _) = harmonic(&p, amplitude, 1.0);
            assert!((found / exact - 1.0).abs() < 1e-5, "{amplitude}: {found} {exact}");
        }
    }

    /// Oracle: by hand: a current out of a alone, half of it returning through b and c each.
    #[test]
    fn a_phase_gets_four_thirds() {
        let u = P.voltage(AlphaBeta { alpha: 1.7, beta: 0.0 });
        assert!((u.alpha - 4.0 / 3.0 * P.loss()).abs() < 1e-12 && u.beta.abs() < 1e-12, "{u:?}");
        assert_eq!(P.voltage(AlphaBeta::default()), AlphaBeta::default());
    }

    #[test]
    fn errors_name_the_parameter() {
        assert_eq!(P.check(), Ok(()));
        let said = Params { dead_time: -1e-6, ..P }.check().unwrap_err().to_string();
        assert!(said.starts_with("`dead time that is compensated` must be"), "{said}");
    }
}
