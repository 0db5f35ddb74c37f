//! The most effort that a motor gives at a speed: its torque–speed envelope.
//!
//! ```text
//! largest T(i)      |i| ≤ I (circle)      |u(i, ω)| ≤ U (ellipse, resistance included)      steady state
//! ```
//! For a given i_d, i_q is bounded by circle and ellipse. Both sets are convex, so their upper bound h(i_d) is concave; the effort there
//! is h times ψ + (L_d − L_q)·i_d, a product of concave positive functions, which has one maximum: golden sections find it for every
//! resistance, and whether the motor's ellipse shrinks to a point inside the circle (ψ/L_d < I) or outside.
//! Source of circle and ellipse: Morimoto, Takeda, Hirasa and Taniguchi, *IEEE Transactions on Industry Applications* 26(5), 1990.
use super::Params;
use servobench_base::Dq;

/// Bounds of current and voltage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Largest current (A, peak); may be infinite if the voltage bounds it.
    pub current: f64,
    /// Largest phase voltage (V, peak).
    pub voltage: f64,
}

/// The point of most effort at a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MostEffort {
    /// Current there (A, peak).
    pub current: Dq,
    /// Effort there (N·m or N).
    pub effort: f64,
}

/// An interval of numbers.
#[derive(Debug, Clone, Copy)]
struct Interval {
    from: f64,
    to: f64,
}

/// Golden sections: the rest of an interval is below the rounding of its ends.
const SECTIONS: u32 = 90;

impl Params {
    /// The most effort in the direction of growing positions, at the electrical speed `omega_e` (rad/s), which is negative if the
    /// motor brakes; `None` if it cannot turn that fast without an effort against it.
    #[must_use]
    pub fn most_effort(&self, bounds: Bounds, omega_e: f64) -> Option<MostEffort> {
        let range = self.range_of_d(bounds, omega_e)?;
        // Positive if some i_q is permitted that may be positive.
        let room = |d: f64| self.range_of_q(bounds, omega_e, d).map_or(f64::NEG_INFINITY, |q| q.to.min(q.to - q.from));
        let inside = top(range, room);
        if room(inside).is_nan() || room(inside) < 0.0 {
            return None;
        }
        let edge = |mut out: f64| {
            let mut within = inside;
            for _ in 0..SECTIONS {
                let middle = f64::midpoint(within, out);
                *(if room(middle) >= 0.0 { &mut within } else { &mut out }) = middle;
            }
            within
        };
        let at = |d: f64| Dq { d, q: self.range_of_q(bounds, omega_e, d).map_or(0.0, |q| q.to) };
        let d = top(Interval { from: edge(range.from), to: edge(range.to) }, |d| self.torque(at(d)));
        // The largest torque may be at an end, from which golden sections keep away by a rounding.
        let current = [d, edge(range.from), edge(range.to)]
            .map(at)
            .into_iter()
            .max_by(|one, other| self.torque(*one).total_cmp(&self.torque(*other)))?;
        Some(MostEffort { current, effort: self.torque(current) })
    }

    /// Largest speed at which the motor gives at least `effort`, up to `most` (electrical, rad/s).
    #[must_use]
    pub fn fastest_with(&self, bounds: Bounds, effort: f64, most: f64) -> f64 {
        let gives = |omega_e: f64| self.most_effort(bounds, omega_e).is_some_and(|found| found.effort >= effort);
        if gives(most) {
            return most;
        }
        let (mut slow, mut fast) = (0.0, most);
        for _ in 0..SECTIONS {
            let middle = f64::midpoint(slow, fast);
            *(if gives(middle) { &mut slow } else { &mut fast }) = middle;
        }
        slow
    }

    /// Currents in d for which the bounds permit some in q, and for which an effort has the sign of i_q.
    fn range_of_d(&self, Bounds { current, voltage }: Bounds, omega_e: f64) -> Option<Interval> {
        let Self { resistance: r, inductance: Dq { d: l_d, q: l_q }, flux_linkage: psi, .. } = *self;
        let (x_d, x_q, emf) = (omega_e * l_d, omega_e * l_q, omega_e * psi);
        // u = Z·i + (0, emf); the extremes of i_d on |u| = U are those of its ellipse: i_d = (R·u_d + X_q·(u_q − emf))/det.
        let det = r * r + x_d * x_q;
        let (centre, half) = (-x_q * emf / det, voltage * r.hypot(x_q) / det);
        let mut range = Interval { from: (centre - half).max(-current), to: (centre + half).min(current) };
        let saliency = l_d - l_q;
        if saliency < 0.0 {
            range.to = range.to.min(psi / -saliency);
        } else if saliency > 0.0 {
            range.from = range.from.max(-psi / saliency);
        }
        (range.from <= range.to).then_some(range)
    }

    /// Currents in q that the bounds permit beside `d`.
    fn range_of_q(&self, Bounds { current, voltage }: Bounds, omega_e: f64, d: f64) -> Option<Interval> {
        let Self { resistance: r, inductance: Dq { d: l_d, q: l_q }, flux_linkage: psi, .. } = *self;
        // |u|² = a·i_q² + 2·b·i_q + c + U²
        let (x_q, flux) = (omega_e * l_q, omega_e * (l_d * d + psi));
        let (a, b) = (r * r + x_q * x_q, r * (flux - x_q * d));
        let root = (voltage * voltage * a - (r * r * d + x_q * flux).powi(2)).max(-f64::MIN_POSITIVE).sqrt();
        if root.is_nan() {
            return None;
        }
        let circle = if current.is_finite() { ((current - d) * (current + d)).max(0.0).sqrt() } else { f64::INFINITY };
        Some(Interval { from: ((-b - root) / a).max(-circle), to: ((root - b) / a).min(circle) })
    }
}

/// Position in `range` of the single maximum of `value`.
fn top(Interval { mut from, mut to }: Interval, value: impl Fn(f64) -> f64) -> f64 {
    let golden = (5_f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (to - golden * (to - from), from + golden * (to - from));
    let (mut at_low, mut at_high) = (value(low), value(high));
    for _ in 0..SECTIONS {
        if at_low < at_high {
            (from, low, at_low) = (low, high, at_high);
            high = from + golden * (to - from);
            at_high = value(high);
        } else {
            (to, high, at_high) = (high, low, at_low);
            low = to - golden * (to - from);
            at_low = value(low);
        }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Saarakkala/Hinkkanen, 2.2 kW, on 540 V with 1.5 times its rated current.
    const SALIENT: Params =
        Params { electrical_ratio: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };
    const BOUNDS: Bounds = Bounds { current: 9.12, voltage: 311.769_145 };

    fn most(p: &Params, bounds: Bounds, omega_e: f64) -> MostEffort {
        p.most_effort(bounds, omega_e).unwrap()
    }

    /// Oracle: at low speed the circle alone bounds, and dT/dγ = 0 on it: i_d = (ψ − √(ψ² + 8·ΔL²·I²))/(4·ΔL), ΔL = L_q − L_d.
    #[test]
    fn at_low_speed_it_is_the_maximum_torque_per_ampere() {
        let (saliency, psi) = (15e-3_f64, 0.545_f64);
        for current in [2.3, 9.12, 31.7] {
            let expected = (psi - (psi * psi + 8.0 * (saliency * current).powi(2)).sqrt()) / (4.0 * saliency);
            let found = most(&SALIENT, Bounds { current, ..BOUNDS }, 7.0).current;
            // A maximum is flat: its position is found to the root of the rounding.
            assert!((found.d - expected).abs() < 1e-6 * current, "{current} A: {found:?} {expected}");
            assert!((found.d.hypot(found.q) - current).abs() < 1e-12 * current);
        }
    }

    /// Oracle: without resistance and saliency circle and ellipse are two circles; they meet at
    /// i_d = ((U/ω)² − ψ² − (L·I)²)/(2·ψ·L), from the corner U/ω = √(ψ² + (L·I)²) on.
    #[test]
    fn without_resistance_the_weakened_field_has_a_closed_form() {
        let round = Params { resistance: 1e-9, inductance: Dq { d: 0.04, q: 0.04 }, ..SALIENT };
        let (psi, flux_of_current) = (0.545, 0.04 * 9.12);
        let corner = BOUNDS.voltage / f64::hypot(psi, flux_of_current);
        for part in [0.3, 0.97, 1.0, 1.2, 1.9] {
            let omega_e = part * corner;
            let d = ((BOUNDS.voltage / omega_e).powi(2) - psi * psi - flux_of_current * flux_of_current)
                / (2.0 * psi * 0.04);
            let expected = 1.5 * 3.0 * psi * (9.12_f64.powi(2) - d.min(0.0).powi(2)).sqrt();
            let found = most(&round, BOUNDS, omega_e).effort;
            // The resistance that is left changes a part of 1e-9·I/U.
            assert!((found / expected - 1.0).abs() < 1e-9, "{part}: {found} {expected}");
        }
        // ψ/L = 13.6 A > I: it ends where the flux of the whole current in −d leaves U/ω.
        let last = BOUNDS.voltage / (psi - flux_of_current);
        assert!(
            round.most_effort(BOUNDS, 0.9999 * last).is_some() && round.most_effort(BOUNDS, 1.0001 * last).is_none()
        );
        let fastest = round.fastest_with(BOUNDS, 0.0, 1e4);
        assert!((fastest / last - 1.0).abs() < 1e-7, "{fastest} {last}");
    }

    /// Oracle: ψ/L < I, no resistance: at any speed the most effort is at i_d = −ψ/L, with all of the voltage for i_q = U/(ω·L).
    #[test]
    fn a_motor_whose_current_can_take_all_flux_has_no_last_speed() {
        let weak = Params { resistance: 1e-9, inductance: Dq { d: 0.08, q: 0.08 }, ..SALIENT };
        for omega_e in [3_000.0, 30_000.0] {
            let found = most(&weak, BOUNDS, omega_e);
            let expected = 1.5 * 3.0 * 0.545 * BOUNDS.voltage / (omega_e * 0.08);
            assert!((found.effort / expected - 1.0).abs() < 1e-8, "{omega_e}: {found:?}");
            assert!((found.current.d + 0.545 / 0.08).abs() < 1e-5, "{found:?}");
        }
    }

    /// Oracle: all currents of a fine grid, with resistance and saliency, motoring and braking.
    #[test]
    fn no_current_of_a_grid_gives_more() {
        for omega_e in [-900.0, -411.0, -3.0, 0.0, 250.0, 423.0, 611.0, 930.0] {
            let found = most(&SALIENT, BOUNDS, omega_e);
            let voltage = SALIENT.steady_voltage(found.current, omega_e);
            assert!(voltage.d.hypot(voltage.q) <= BOUNDS.voltage * (1.0 + 1e-9), "{omega_e}: {voltage:?}");
            assert!(found.current.d.hypot(found.current.q) <= BOUNDS.current * (1.0 + 1e-12));
            let mut best = 0.0_f64;
            for n in 0..=600 {
                for m in 0..=600 {
                    let current = Dq { d: 9.12 * (f64::from(n) / 300.0 - 1.0), q: 9.12 * f64::from(m) / 600.0 };
                    let u = SALIENT.steady_voltage(current, omega_e);
                    if current.d.hypot(current.q) <= 9.12 && u.d.hypot(u.q) <= BOUNDS.voltage {
                        best = best.max(SALIENT.torque(current));
                    }
                }
            }
            // A step of the grid is 0.3 % of the current.
            assert!(best <= found.effort * (1.0 + 1e-12) && best > 0.99 * found.effort, "{omega_e}: {best} {found:?}");
        }
    }

    /// Oracle: without magnets and resistance, half of (L_d − L_q)·I² at low speed and half of (L_d − L_q)·(U/ω)²/(L_d·L_q) at high speed,
    /// whichever inductance is the larger one; and no last speed.
    #[test]
    fn a_motor_without_magnets_has_torque_by_its_saliency() {
        for inductance in [Dq { d: 41.5e-3, q: 6.2e-3 }, Dq { d: 6.2e-3, q: 41.5e-3 }] {
            let p = Params { electrical_ratio: 2.0, resistance: 1e-9, inductance, flux_linkage: 0.0 };
            assert_eq!(p.check(), Ok(()));
            let bounds = Bounds { current: 31.0, ..BOUNDS };
            let factor = 1.5 * 2.0 * (inductance.d - inductance.q).abs() / 2.0;
            for omega_e in [5.0, -5.0, 9_000.0] {
                let flux = bounds.voltage / omega_e;
                let expected = factor * (31.0_f64.powi(2)).min(flux * flux / (inductance.d * inductance.q));
                let found = most(&p, bounds, omega_e);
                assert!((found.effort / expected - 1.0).abs() < 1e-6, "{omega_e}: {found:?} {expected}");
            }
        }
        let alike = Params { inductance: Dq { d: 6e-3, q: 6e-3 }, flux_linkage: 0.0, ..SALIENT };
        let refusal = alike.check().unwrap_err().to_string();
        assert_eq!(refusal, "`flux linkage` must be positive where both inductances are equal, got 0");
    }

    #[test]
    fn beyond_its_last_speed_there_is_nothing() {
        assert_eq!(SALIENT.most_effort(BOUNDS, 1e5), None);
        let no_current = Bounds { current: 0.0, ..BOUNDS };
        assert!(most(&SALIENT, no_current, 100.0).effort.abs() < 1e-300);
        assert!(most(&SALIENT, Bounds { current: f64::INFINITY, ..BOUNDS }, 100.0).effort > 100.0);
    }
}
