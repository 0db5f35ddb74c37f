//! What dead time and devices take from the voltage, averaged over the carrier.
//!
//! ```text
//! ū_x = ū_x,ideal − E·sgn(i_x) − r·i_x        E = t_d·f_carrier·U_dc + U_T        x = a, b, c
//! ```
//! A leg whose devices are both off is at the rail that its diodes lead the current to: with i_x > 0, out of the leg, the lower one. That
//! takes t_d of the upper rail once in a period; with i_x < 0 it adds as much. Transistor and diode have the same threshold U_T and the
//! same resistance r. With one leg against two, the space vector of the error is 4/3·E long and turns in steps of 60°; its fundamental is
//! 4/π·E. Source: Holmes & Lipo, *Pulse Width Modulation for Power Converters* (the pulse that is lost); Jeong & Park, *IEEE
//! Transactions on Industrial Electronics* 38(2), 1991 (the mean over a period).
//!
//! # A current near zero
//!
//! A current that the error would reverse is held at zero (zero-current clamping): with both devices off and no current, the diodes block,
//! and the leg goes where the motor takes it. So E·sgn(0) is whatever holds the current, up to E. Over a tick with the currents p_x at
//! its end, had there been no E, that is
//!
//! ```text
//! E·sgn(i_x) = L/h·clamp(p_x + μ, ±h·E/L)        μ = clamp(median(p)/2, ±h·E/3L)
//! ```
//! This is the currents' step against three dry frictions, solved exactly: it minimises Σ (i_x − p_x)²·L/2h + E·|i_x| over currents
//! that sum up to zero, whose multiplier, the star point, is μ. A motor on less than 4/3·E along a phase takes no current at all.
//!
//! E is held over a tick: where a current passes zero it is off by at most h·E/L, of first order in the tick; everywhere else the
//! error is exact. r·i_x is that of the middle of the tick, of second order. L is the smaller inductance, so that a salient motor is
//! held from both sides, and not thrown from one to the other.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::legs::{Legs, product, vector};
use super::params::Params;
use servobench_base::AlphaBeta;

/// What an averaged inverter takes of each leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Averaged {
    /// Dead time in periods of the carrier.
    dead: f64,
    /// Threshold of a device (V).
    drop: f64,
    /// Resistance of a device (Ω).
    resistance: f64,
}

/// What is taken over a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Taken {
    /// By dead time and threshold, and of that the threshold's share.
    error: Legs,
    share: f64,
    /// By the resistance.
    ohmic: Legs,
}

impl Averaged {
    pub(crate) fn new(p: &Params) -> Self {
        Self { dead: p.dead_time * p.carrier, drop: p.device_drop, resistance: p.on_resistance }
    }

    /// What it takes of the legs of a link of `u_dc` (V) over a tick that begins with the currents `before` and would end with
    /// `free`, where a volt changes a current by `gain` (A).
    #[inline(always)]
    pub(crate) fn taken(&self, before: Legs, free: Legs, u_dc: f64, gain: f64) -> Taken {
        let drop = self.drop + self.dead * u_dc;
        let ohmic: Legs = core::array::from_fn(|x| self.resistance * 0.5 * (before[x] + free[x]));
        let free: Legs = core::array::from_fn(|x| free[x] - gain * ohmic[x]);
        let most = gain * drop;
        // They sum up to zero.
        let median = -(free[0].max(free[1]).max(free[2]) + free[0].min(free[1]).min(free[2]));
        let star = (0.5 * median).clamp(-most / 3.0, most / 3.0);
        let error = free.map(|p| (p + star).clamp(-most, most) / gain);
        let share = if drop > 0.0 { self.drop / drop } else { 0.0 };
        Taken { error, share, ohmic }
    }
}

impl Taken {
    /// What the voltage is less.
    #[inline(always)]
    pub(crate) fn voltage(&self) -> AlphaBeta {
        vector(core::array::from_fn(|x| self.error[x] + self.ohmic[x]))
    }

    /// Power that the devices turn into heat, with the mean currents `mean` (W). What dead time takes goes back into the link.
    #[inline(always)]
    pub(crate) fn loss(&self, mean: Legs) -> f64 {
        self.share * product(self.error, mean) + product(self.ohmic, mean)
    }
}

#[cfg(test)]
mod tests {
    use super::super::legs::legs;
    use super::*;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    /// 2.3 µs of 62.5 µs on 320 V: 11.776 V of each leg.
    const DEAD: Averaged = Averaged { dead: 2.3e-6 * 16e3, drop: 0.0, resistance: 0.0 };
    const E: f64 = 2.3e-6 * 16e3 * 320.0;

    fn of(i: AlphaBeta, gain: f64) -> Taken {
        DEAD.taken(legs(i), legs(i), 320.0, gain)
    }

    fn at(angle: f64) -> AlphaBeta {
        AlphaBeta { alpha: 5.0 * angle.cos(), beta: 5.0 * angle.sin() }
    }

    /// Oracle: the published forms −t_d·f·U·sgn(i) of a leg, 4/3 of it as a vector, 4/π of it as the fundamental of a phase. The current
    /// is beyond twenty times what a tick changes.
    #[test]
    fn leg_vector_and_fundamental_are_the_published_ones() {
        let gain = 0.25 / E;
        let (steps, mut in_phase, mut in_quadrature) = (7_000, 0.0, 0.0);
        for k in 0..steps {
            let angle = 2.0 * PI * (f64::from(k) + 0.37) / f64::from(steps);
            let (i, taken) = (legs(at(angle)), of(at(angle), gain));
            for (i, error) in i.into_iter().zip(taken.error).filter(|(i, _)| i.abs() > 0.25) {
                assert!((error - E.copysign(i)).abs() < 1e-12 * E, "{angle} {i}: {taken:?}");
            }
            let vector = taken.voltage();
            let length = vector.alpha.hypot(vector.beta);
            if i.iter().all(|i| i.abs() > 0.25) {
                assert!((length / (4.0 / 3.0 * E) - 1.0).abs() < 1e-12, "{angle}: {length}");
            }
            in_phase += vector.alpha * angle.cos() * 2.0 / f64::from(steps);
            in_quadrature += vector.alpha * angle.sin() * 2.0 / f64::from(steps);
        }
        // Clamping rounds the corners, by (h·E/L)/(5 A)/6 of a step's width; 1 % is what is asked for.
        assert!((in_phase / (4.0 / PI * E) - 1.0).abs() < 2e-3, "{in_phase}");
        assert!(in_quadrature.abs() < 1e-3 * E, "{in_quadrature}");
    }

    /// Oracle: the balance of voltages. Along a phase, one leg stands against two in parallel.
    #[test]
    fn below_four_thirds_of_the_error_there_is_no_current() {
        let gain = 62.5e-6 / 3.485e-3;
        for direction in [1.0, -1.0] {
            for (share, flows) in [(0.2, 0.0), (0.99, 0.0), (1.01, 0.01), (1.5, 0.5)] {
                let free = gain * share * 4.0 / 3.0 * E * direction;
                let taken = DEAD.taken([0.0; 3], legs(AlphaBeta { alpha: free, beta: 0.0 }), 320.0, gain);
                let current = free - gain * taken.voltage().alpha;
                let expected = gain * flows * 4.0 / 3.0 * E * direction;
                assert!((current - expected).abs() < 1e-14, "{share}: {current} {expected}");
            }
        }
    }

    proptest! {
        /// Oracle: what makes a step against friction the right one (Karush, Kuhn and Tucker): each error within ±E, at its end where
        /// the current flows, against it; and no current is reversed.
        #[test]
        fn each_leg_is_held_or_braked(alpha in -2.0..2.0_f64, beta in -2.0..2.0_f64, gain in 0.001..0.3_f64) {
            let free = AlphaBeta { alpha, beta };
            let taken = of(free, gain);
            let end: Legs = {
                let u = taken.voltage();
                legs(AlphaBeta { alpha: alpha - gain * u.alpha, beta: beta - gain * u.beta })
            };
            for x in 0..3 {
                // Some roundings of numbers up to gain·E, divided by the gain.
                prop_assert!(taken.error[x].abs() <= E * (1.0 + 1e-12));
                if end[x].abs() > 1e-12 {
                    prop_assert!((taken.error[x] - E.copysign(end[x])).abs() < 1e-9, "{end:?} {taken:?}");
                }
            }
        }
    }

    /// Oracle: U_T·Σ|i_x| + r·Σ i_x², and nothing by dead time.
    #[test]
    fn devices_turn_threshold_and_resistance_into_heat() {
        let real = Averaged { drop: 0.9, resistance: 0.05, ..DEAD };
        let i = legs(at(0.4));
        let taken = real.taken(i, i, 320.0, 1e-3);
        let expected: f64 = i.iter().map(|i| 0.9 * i.abs() + 0.05 * i * i).sum();
        assert!((taken.loss(i) / expected - 1.0).abs() < 1e-12, "{} {expected}", taken.loss(i));
        assert!(of(at(0.4), 1e-3).loss(i).abs() < 1e-15);
    }
}
