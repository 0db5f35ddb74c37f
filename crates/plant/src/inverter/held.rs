//! Currents that dead time and thresholds hold, brake or let through over some time.
//!
//! ```text
//! i = i_free − M·e      e = 2/3·Σ E_x·c_x      E_x = E·sgn(i_x), for i_x = 0 whatever holds it, |E_x| ≤ E      i_x = c_x·i
//! ```
//! i is the current at the end of that time, M its change per held voltage, c_x the axis of the phase x. These are three dry
//! frictions on a body of two coordinates. M grows with e (it is positive definite, but not symmetric if the rotor turns), so that
//! there is one solution: all three flow (six patterns of signs), one is held and the others flow (six edges between two of them), or all
//! are held. Trying finds it. Source: Facchinei and Pang, *Finite-Dimensional Variational Inequalities*, ch. 2.
use super::legs::{Legs, legs, vector};
use servobench_base::AlphaBeta;

/// Change of the current (A) by a voltage (V): rows and columns α, β.
pub(super) type Response = [[f64; 2]; 2];

/// Ratio of the response across to that along below which the current has a single line: a phase is lost.
const ONE_LINE: f64 = 1e-9;

/// M·e.
pub(super) fn changed(m: &Response, e: AlphaBeta) -> AlphaBeta {
    AlphaBeta { alpha: m[0][0] * e.alpha + m[0][1] * e.beta, beta: m[1][0] * e.alpha + m[1][1] * e.beta }
}

/// The best of the solutions that were tried, and its error (A).
struct Best {
    error: AlphaBeta,
    off: f64,
}

impl Best {
    fn take(&mut self, error: AlphaBeta, off: f64) {
        if off < self.off {
            *self = Self { error, off };
        }
    }
}

/// The voltage e (V) that legs with an error of `most` (V) take if their currents would be `free` (A) without it.
pub(super) fn error(free: AlphaBeta, m: &Response, most: f64) -> AlphaBeta {
    let gain = m[0][0] + m[1][1];
    let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    if determinant <= ONE_LINE * gain * gain {
        return along_a_line(free, m, most);
    }
    let mut best = Best { error: AlphaBeta::default(), off: f64::INFINITY };
    for first in 0..3 {
        let [second, third] = [(first + 1) % 3, (first + 2) % 3];
        for sign in [1.0, -1.0] {
            // One leg against two.
            let mut signs = [-sign; 3];
            signs[first] = sign;
            let error = vector(signs.map(|sign| sign * most));
            let i = flowing(free, m, error);
            best.take(error, signs.iter().zip(i).fold(0.0, |off: f64, (sign, i)| off.max(-sign * i)));
            // The first one is held, the others flow.
            let mut own = [0.0; 3];
            own[second] = sign * most;
            own[third] = -sign * most;
            let i = flowing(free, m, vector(own));
            let mut unit = [0.0; 3];
            unit[first] = 1.0;
            let per_volt = changed(m, vector(unit));
            own[first] = i[first] / legs(per_volt)[first];
            let error = vector(own);
            let i = flowing(free, m, error);
            let beyond = gain * (own[first].abs() - most);
            best.take(error, beyond.max(-sign * i[second]).max(sign * i[third]).max(0.0));
        }
    }
    let per = 1.0 / determinant;
    let all = AlphaBeta {
        alpha: per * (m[1][1] * free.alpha - m[0][1] * free.beta),
        beta: per * (m[0][0] * free.beta - m[1][0] * free.alpha),
    };
    let [a, b, c] = legs(all);
    let half_width = 0.5 * (a.max(b).max(c) - a.min(b).min(c));
    best.take(all, (gain * (half_width - most)).max(0.0));
    best.error
}

/// Currents of the legs with that error.
fn flowing(free: AlphaBeta, m: &Response, error: AlphaBeta) -> Legs {
    let by = changed(m, error);
    legs(AlphaBeta { alpha: free.alpha - by.alpha, beta: free.beta - by.beta })
}

/// Solution for two legs in series: s = s_free − g·e along n, held below 2/3·E·Σ|n_x|.
fn along_a_line(free: AlphaBeta, m: &Response, most: f64) -> AlphaBeta {
    let gain = m[0][0] + m[1][1];
    let column = if m[0][0] > m[1][1] { [m[0][0], m[1][0]] } else { [m[0][1], m[1][1]] };
    let length = libm::hypot(column[0], column[1]);
    if length == 0.0 || length.is_nan() {
        return AlphaBeta::default();
    }
    let n = AlphaBeta { alpha: column[0] / length, beta: column[1] / length };
    let bound = most * legs(n).iter().map(|leg| leg.abs()).sum::<f64>() * 2.0 / 3.0;
    let along = ((n.alpha * free.alpha + n.beta * free.beta) / gain).min(bound).max(-bound);
    AlphaBeta { alpha: along * n.alpha, beta: along * n.beta }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const E: f64 = 11.776;

    /// Oracle: the balance of voltages. Along a phase, one leg stands against two in parallel.
    #[test]
    fn below_four_thirds_of_the_error_there_is_no_current() {
        let gain = 62.5e-6 / 3.485e-3;
        let m = [[gain, 0.0], [0.0, gain]];
        for direction in [1.0, -1.0] {
            for (share, flows) in [(0.2, 0.0), (0.99, 0.0), (1.01, 0.01), (1.5, 0.5)] {
                let free = AlphaBeta { alpha: gain * share * 4.0 / 3.0 * E * direction, beta: 0.0 };
                let current = flowing(free, &m, error(free, &m, E))[0];
                let expected = gain * flows * 4.0 / 3.0 * E * direction;
                assert!((current - expected).abs() < 1e-14, "{share}: {current} {expected}");
            }
        }
    }

    /// Oracle: two legs in series take 2·E/√3 of the voltage between their phases.
    #[test]
    fn two_legs_in_series_hold_together() {
        let (g, n) = (0.02, AlphaBeta { alpha: 0.0, beta: 1.0 });
        let m = [[0.0, 0.0], [0.0, g]];
        for (volts, left) in [(1.0, 0.0), (-13.5, 0.0), (20.0, 20.0 - 2.0 / 3.0_f64.sqrt() * E)] {
            let free = AlphaBeta { alpha: 0.0, beta: g * volts };
            let found = error(free, &m, E);
            assert!((g * volts - g * found.beta - g * left).abs() < 1e-13 && found.alpha.abs() < 1e-13 * n.beta);
        }
        assert_eq!(error(AlphaBeta::default(), &[[0.0; 2]; 2], E), AlphaBeta::default());
    }

    proptest! {
        /// Oracle: the conditions of a correct step against friction (Karush, Kuhn and Tucker): each error within ±E, at its end where
        /// the current flows, against it; and no current is reversed. For salient motors that turn, whose response is not symmetric.
        #[test]
        fn each_leg_is_held_or_braked(
            alpha in -2.0..2.0_f64, beta in -2.0..2.0_f64, gain in 0.001..0.3_f64,
            (saliency, angle, turn) in (0.05..1.0_f64, -3.2..3.2_f64, -1.4..1.4_f64),
        ) {
            let free = AlphaBeta { alpha, beta };
            let (sin, cos) = angle.sin_cos();
            let [aa, ab, bb] = [cos * cos + saliency * sin * sin, (1.0 - saliency) * sin * cos, sin * sin + saliency * cos * cos];
            // As far as the turn leaves it positive definite.
            let skew = turn.sin() * saliency;
            let m = [[gain * aa, gain * (ab - skew)], [gain * (ab + skew), gain * bb]];
            let found = error(free, &m, E);
            let i = flowing(free, &m, found);
            let of_legs = legs(found);
            // The star point is free: legs may have a common component.
            let (low, high) = of_legs.iter().fold((f64::MAX, f64::MIN), |(low, high), leg| (low.min(*leg), high.max(*leg)));
            prop_assert!(high - low <= 2.0 * E * (1.0 + 1e-12));
            for x in 0..3 {
                for y in 0..3 {
                    // From where current flows out to where it flows in.
                    if i[x] > 1e-12 && i[y] < -1e-12 {
                        prop_assert!((of_legs[x] - of_legs[y] - 2.0 * E).abs() < 1e-9, "{i:?} {of_legs:?}");
                    }
                }
            }
        }
    }
}
