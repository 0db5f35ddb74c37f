//! A motor at constant speed on a voltage that is constant in the stator frame, over any time: the segment between two edges.
//!
//! ```text
//! w = (i_d, i_q, u_d, u_q, 1)        dw/dt = A·w, with A as in [`maps`](super::maps)        w(t + δ) = Σ (δA)ⁿ/n!·w(t)
//! ```
//! The series is cut where the remainder is below the rounding. The means of i, i_d² + i_q² and ψ·i_q + (L_d − L_q)·i_d·i_q are
//! taken by Gauss and Legendre's rule with four points, exact up to the seventh power of δ: of a product, which changes by 2c, it leaves
//! out (2c)⁸·(4!)⁴/(9·(8!)³) < 2e-15 with c = [`LARGEST_PART`] of change in a part. A longer time is cut into equal parts. The mean of i
//! is taken in the stator frame, so that the power of any voltage that is held there follows from it.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::Params;
use super::winding::{Span, Sums, Winding, stored};
use core::array::from_fn;
use servobench_base::Dq;

/// Largest relative change in a part.
const LARGEST_PART: f64 = 0.1;
/// Change up to which [`FEW`] terms are enough: 0.03⁸/8! < 2e-17. [`ALL`] are for a part: 0.1¹²/12! < 1e-20.
const SMALL_PART: f64 = 0.03;
const FEW: usize = 7;
const ALL: usize = 11;

/// Maximum number of parts.
const MOST_PARTS: f64 = 1e6;

/// Points of the rule from 0 to 1, and their weights (Abramowitz & Stegun, *Handbook of Mathematical Functions*, table 25.4).
const POINTS: [f64; 4] =
    [0.069_431_844_202_973_71, 0.330_009_478_207_571_87, 0.669_990_521_792_428_13, 0.930_568_155_797_026_29];
const WEIGHTS: [f64; 4] =
    [0.173_927_422_568_726_93, 0.326_072_577_431_273_07, 0.326_072_577_431_273_07, 0.173_927_422_568_726_93];

/// The motor's equations, per second, including the resistance in series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Equations {
    electrical_ratio: f64,
    /// R/L.
    decay: Dq,
    /// 1/L.
    per_volt: Dq,
    /// L_q/L_d, and L_d/L_q.
    cross: Dq,
    /// ψ/L_q.
    emf: f64,
    /// ψ, and L_d − L_q.
    torque: [f64; 2],
    inductance: Dq,
    /// R of the motor itself.
    resistance: f64,
    /// Fastest relative change at rest, and by the turn.
    fastest: [f64; 2],
}

impl Equations {
    /// Equations of `motor`, with `series` (Ω) before each phase.
    pub(crate) fn new(motor: &Params, series: f64) -> Self {
        let (l, r) = (motor.inductance, motor.resistance + series);
        let cross = Dq { d: l.q / l.d, q: l.d / l.q };
        Self {
            electrical_ratio: motor.electrical_ratio,
            decay: Dq { d: r / l.d, q: r / l.q },
            per_volt: Dq { d: 1.0 / l.d, q: 1.0 / l.q },
            cross,
            emf: motor.flux_linkage / l.q,
            torque: [motor.flux_linkage, l.d - l.q],
            inductance: l,
            resistance: motor.resistance,
            fastest: [r / l.d.min(l.q), cross.d.max(cross.q)],
        }
    }

    /// Advances over `time` with `u` and `other` in the frame of the rotor at the beginning; only `u` acts on the current.
    #[inline(always)]
    fn over<const POWER: bool>(&self, i: Dq, [u, other]: [Dq; 2], omega: f64, time: f64, sums: &mut Sums) -> Dq {
        let change = time * (self.fastest[0] + omega.abs() * self.fastest[1]);
        if change <= SMALL_PART {
            return self.part::<FEW, POWER>(i, [u, other], omega, time, sums);
        }
        if change <= LARGEST_PART {
            return self.part::<ALL, POWER>(i, [u, other], omega, time, sums);
        }
        self.parts::<POWER>(i, [u, other], omega, time, sums)
    }

    #[cold]
    fn parts<const POWER: bool>(&self, i: Dq, [u, other]: [Dq; 2], omega: f64, time: f64, sums: &mut Sums) -> Dq {
        let change = time * (self.fastest[0] + omega.abs() * self.fastest[1]);
        let parts = (change / LARGEST_PART).ceil();
        // A motor that turns ten thousand times between two edges has diverged: it gets not-a-number results.
        if !(0.0..=MOST_PARTS).contains(&parts) {
            *sums = Sums::NAN;
            return Dq { d: f64::NAN, q: f64::NAN };
        }
        let (step, mut i) = (time / parts, i);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number up to MOST_PARTS")]
        for k in 0..parts as u32 {
            let (sin, cos) = libm::sincos(omega * step * f64::from(k));
            let turned = |u: Dq| Dq { d: cos * u.d + sin * u.q, q: cos * u.q - sin * u.d };
            i = self.part::<ALL, POWER>(i, [turned(u), turned(other)], omega, step, sums);
        }
        i
    }

    #[inline(always)]
    fn part<const TERMS: usize, const POWER: bool>(
        &self,
        i: Dq,
        [u, other]: [Dq; 2],
        omega: f64,
        time: f64,
        sums: &mut Sums,
    ) -> Dq {
        let x = omega * time;
        let decay = [-time * self.decay.d, -time * self.decay.q];
        let cross = [x * self.cross.d, -x * self.cross.q];
        let per_volt = [time * self.per_volt.d, time * self.per_volt.q];
        let emf = -x * self.emf;

        // The n-th terms of the series, and their sums at the end and at the points.
        let (mut d, mut q, mut v) = (i.d, i.q, u);
        let (mut end, mut at) = (i, [[i.d; 4], [i.q; 4]]);
        let mut power = POINTS;
        let mut constant = emf;
        for per in &INVERSE[..TERMS] {
            let next_d = per * (decay[0] * d + cross[0] * q + per_volt[0] * v.d);
            let next_q = per * (decay[1] * q + cross[1] * d + per_volt[1] * v.q + constant);
            constant = 0.0;
            v = Dq { d: per * x * v.q, q: -per * x * v.d };
            (d, q) = (next_d, next_q);
            end = Dq { d: end.d + d, q: end.q + q };
            at = [from_fn(|k| at[0][k] + d * power[k]), from_fn(|k| at[1][k] + q * power[k])];
            power = from_fn(|k| power[k] * POINTS[k]);
        }

        let [at_d, at_q] = at;
        let mean = |of: [f64; 4]| (WEIGHTS[0] * of[0] + WEIGHTS[1] * of[1]) + (WEIGHTS[2] * of[2] + WEIGHTS[3] * of[3]);
        let [psi, saliency] = self.torque;
        sums.torque += time * mean(from_fn(|k| (psi + saliency * at_d[k]) * at_q[k]));
        if !POWER {
            return end;
        }
        // Sine and cosine of the turn at the points: x¹¹/11! and x¹⁰/10! are below 3e-17.
        let z: [f64; 4] = from_fn(|k| (x * POINTS[k]) * (x * POINTS[k]));
        let cos: [f64; 4] = from_fn(|k| 1.0 - z[k] * (0.5 - z[k] * (C4 - z[k] * (C6 - z[k] * C8))));
        let sin: [f64; 4] = from_fn(|k| x * POINTS[k] * (1.0 - z[k] * (C3 - z[k] * (C5 - z[k] * (C7 - z[k] * C9)))));
        let held_d = mean(from_fn(|k| cos[k] * at_d[k] - sin[k] * at_q[k]));
        let held_q = mean(from_fn(|k| sin[k] * at_d[k] + cos[k] * at_q[k]));
        let square = time * mean(from_fn(|k| at_d[k] * at_d[k] + at_q[k] * at_q[k]));
        sums.square += square;
        sums.copper += self.resistance * square;
        sums.work += time * (u.d * held_d + u.q * held_q);
        sums.other += time * (other.d * held_d + other.q * held_q);
        end
    }
}

impl Winding for Equations {
    #[inline(always)]
    fn advance<const POWER: bool>(&self, i: Dq, over: &Span, sums: &mut Sums) -> Dq {
        let Span { voltage, drop, rotor, omega, time } = *over;
        let drop = if POWER { drop.to_dq(rotor) } else { Dq::default() };
        self.over::<POWER>(i, [voltage.to_dq(rotor), drop], omega, time, sums)
    }

    #[inline(always)]
    fn electrical_ratio(&self) -> f64 {
        self.electrical_ratio
    }

    #[inline(always)]
    fn stored(&self, before: Dq, after: Dq) -> f64 {
        stored(self.inductance, before, after)
    }
}

/// 1/n, from 1 on.
const INVERSE: [f64; ALL] = [
    1.0,
    1.0 / 2.0,
    1.0 / 3.0,
    1.0 / 4.0,
    1.0 / 5.0,
    1.0 / 6.0,
    1.0 / 7.0,
    1.0 / 8.0,
    1.0 / 9.0,
    1.0 / 10.0,
    1.0 / 11.0,
];
const C3: f64 = 1.0 / 6.0;
const C4: f64 = 1.0 / 24.0;
const C5: f64 = 1.0 / 120.0;
const C6: f64 = 1.0 / 720.0;
const C7: f64 = 1.0 / 5040.0;
const C8: f64 = 1.0 / 40320.0;
const C9: f64 = 1.0 / 362_880.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pmsm::{Input, State, step_with_power};
    use proptest::prelude::*;
    use servobench_base::{AlphaBeta, Rotation};

    const MOTOR: Params =
        Params { electrical_ratio: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };

    proptest! {
        /// Oracle: the motor's own exact tick, by doubling of its maps, for short and long times, either way round, fast and slow.
        #[test]
        fn a_segment_is_a_tick_of_the_motor(
            id in -5.0..5.0_f64, iq in -5.0..5.0_f64, alpha in -300.0..300.0_f64, beta in -300.0..300.0_f64,
            omega in -2000.0..2000.0_f64, logarithm in -7.0..-2.5_f64,
        ) {
            let (time, rotor) = (10_f64.powf(logarithm), Rotation { sin: 0.6, cos: 0.8 });
            let voltage = AlphaBeta { alpha, beta };
            let mut expected = State { current: Dq { d: id, q: iq } };
            let input = Input { voltage, rotor, omega_e: omega };
            let output = step_with_power(&MOTOR, &mut expected, input, time);
            let (equations, mut sums) = (Equations::new(&MOTOR, 0.0), Sums::default());
            let drop = AlphaBeta { alpha: alpha * 0.5, beta: beta * 0.5 };
            let over = Span { voltage, drop, rotor, omega, time };
            let end = equations.advance::<true>(Dq { d: id, q: iq }, &over, &mut sums);
            // A few dozen roundings of currents that change by up to 300 V·time/L; long times are cut into parts of a tenth.
            let scale = 5.0 + 500.0 * time / 36e-3 + omega.abs() * time * 16.0;
            prop_assert!((end.d - expected.current.d).abs() < 1e-14 * scale, "{end:?} {expected:?}");
            prop_assert!((end.q - expected.current.q).abs() < 1e-14 * scale, "{end:?} {expected:?}");
            let mut alone = Sums::default();
            let same = equations.advance::<false>(Dq { d: id, q: iq }, &over, &mut alone);
            prop_assert_eq!((same, alone), (end, Sums { torque: sums.torque, ..Sums::default() }));
            let factor = 1.5 * MOTOR.electrical_ratio / time;
            prop_assert!((factor * sums.torque - output.torque).abs() < 1e-13 * scale * scale);
            prop_assert!((1.5 * sums.copper / time - output.power.copper).abs() < 1e-13 * 6.0 * scale * scale);
            prop_assert!((1.5 * sums.work / time - output.power.electrical).abs() < 1e-13 * 1000.0 * scale);
            let stored = equations.stored(Dq { d: id, q: iq }, end) / time;
            prop_assert!((stored - output.power.stored).abs() < 1e-13 * scale * scale / time);
            prop_assert!((sums.other - 0.5 * sums.work).abs() < 1e-14 * 500.0 * scale * time);
        }
    }

    #[test]
    fn what_is_in_series_adds_to_the_resistance() {
        let more = Params { resistance: 3.85, ..MOTOR };
        assert_eq!(
            Equations::new(&MOTOR, 0.25),
            Equations { resistance: MOTOR.resistance, ..Equations::new(&more, 0.0) }
        );
    }
}
