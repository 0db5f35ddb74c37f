//! Currents for an effort: maximum torque per ampere, and field weakening at the voltage limit.
//!
//! ```text
//! τ = K·(ψ + (L_d − L_q)·i_d)·i_q       K = 1.5·p
//! u_d = R·i_d − ω·L_q·i_q               u_q = R·i_q + ω·(L_d·i_d + ψ)
//! |i| ≤ I_max                           |u| ≤ U
//! ```
//! **Maximum torque per ampere.** Least |i| for τ where w³·(w − ψ) = (L_d − L_q)²·(τ/K)², w = ψ + (L_d − L_q)·i_d: the left side is convex
//! beyond its root, so that Newton's method descends to it. At I_max i_d = ψ/(4(L_q − L_d)) − √(ψ²/(16(L_q − L_d)²) + I_max²/2), written
//! without the difference that becomes 0/0 for L_d = L_q. Without magnets (ψ = 0) both currents have equal magnitude, i_d with the sign of
//! L_d − L_q, and none flows without torque.
//!
//! **Field weakening.** At i_d the largest |i_q| is that of the circle or, by a quadratic, of the voltage ellipse, resistance included.
//! Both sets are convex, so the effort over i_d has one maximum. It is the end of maximum torque per ampere, the corner of circle and
//! ellipse, or, where ψ/L_d < I_max at high speed, the point of maximum torque per voltage. That is below the i_d preferred by the
//! strategy, except where this alone exceeds ψ/L_d: with little or no magnets the field is weakened by a smaller |i_d|. A smaller effort is
//! applied at the preferred i_d, or at the nearest one towards the maximum at which the voltage suffices. The voltage must also suffice for
//! i_q = 0, so that the current of a released effort can decay.
//!
//! **Voltage feedback.** Errors of the estimates show in the voltage that the current loop computes: U falls by dU/dt = α·(σ·U_max − |u|),
//! to half of σ·U_max at most, and never rises above σ·U_max. σ is the share of the voltage that is used.
//! Source: Morimoto, Takeda, Hirasa, Taniguchi, *IEEE Trans. Ind. Appl.* 26(5), 1990 (the regions); Kim, Sul, *IEEE Trans. Ind. Appl.*
//! 33(1), 1997 (feedback of the voltage).
use super::{MotorEstimate, Params as Loop};
use crate::EffortLimits;
use servobench_base::{Dq, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{BANDWIDTH, RATIO};
use servobench_config::{Bound, Measure, ParameterError, not_negative};

servobench_config::parameters! {
    /// A parameter of field weakening.
    pub enum Parameter {
        /// Share of the largest voltage that field weakening uses
        SHARE "share of the voltage for field weakening" = Measure { kind: Plain(&RATIO), bound: Bound::Within(0.1, 1.0), example: "0.95" };
        /// Rate α at which the voltage that the current loop computes corrects field weakening
        FEEDBACK "voltage feedback of field weakening" = not_negative(Plain(&BANDWIDTH), "20 Hz");
    }
}

servobench_config::choices! {
    /// Choice of the d-axis current for an effort.
    pub enum Strategy default DReference {
        /// a constant one, `d_reference`
        DReference = "d-reference",
        /// maximum torque per ampere: the d-axis current that needs the least current
        Mtpa = "mtpa",
    }
}

/// Field weakening; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weakening {
    /// Share σ of the largest voltage in use.
    pub share: f64,
    /// Rate α of the voltage feedback (rad/s); 0 for none.
    pub feedback: f64,
}

/// Choice of the currents for an effort; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Params {
    /// Choice of the d-axis current.
    pub strategy: Strategy,
    /// Field weakening, if any.
    pub weakening: Option<Weakening>,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Correction of the voltage by the feedback (V), not above 0.
    pub correction: f64,
}

/// Largest effort in a direction, and its d-axis current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Effort (N·m or N), a magnitude.
    pub effort: f64,
    /// d-axis current (A).
    pub d: f64,
}

/// Capability of motor and inverter at the present speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// In positive direction.
    pub forward: Peak,
    /// In negative direction.
    pub backward: Peak,
    /// Voltage limit (V).
    voltage: f64,
    /// Electrical speed (rad/s).
    omega_e: f64,
}

/// Iterations of Newton's method: it squares its error, and begins within a factor of 2.
const NEWTON: usize = 8;
/// Halvings: the width is 2·I_max·2⁻³⁶.
const HALVINGS: usize = 36;
/// Steps of the golden section: the remaining interval is 0.618⁴⁰ = 4e-9 of 2·I_max.
const SECTIONS: usize = 40;
/// Golden section, (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

impl Params {
    /// True if the d-axis current is constant.
    #[must_use]
    pub const fn is_plain(&self) -> bool {
        matches!(self, Self { strategy: Strategy::DReference, weakening: None })
    }

    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self, max_current: f64) -> Result<(), ParameterError> {
        if let Some(Weakening { share, feedback }) = self.weakening {
            Parameter::SHARE.check(share)?;
            Parameter::FEEDBACK.check(feedback)?;
        }
        if self.is_plain() || max_current.is_finite() {
            return Ok(());
        }
        let bound = "finite, as maximum torque per ampere and field weakening need it";
        Err(ParameterError { name: super::Parameter::MAX_CURRENT, value: max_current, bound })
    }
}

impl Strategy {
    /// True if `motor` has torque with the d-axis currents of this strategy: a constant `d_reference` (A, peak), or any.
    #[must_use]
    pub fn has_torque(self, motor: &MotorEstimate, d_reference: f64) -> bool {
        match self {
            Self::DReference => motor.effort_constant(d_reference) > 0.0,
            Self::Mtpa => motor.flux_linkage > 0.0 || motor.saliency() != 0.0,
        }
    }
}

impl MotorEstimate {
    /// L_d − L_q (H).
    #[must_use]
    pub fn saliency(&self) -> f64 {
        self.inductance.d - self.inductance.q
    }

    /// d-axis current of maximum torque per ampere for a current of this `length` (A).
    #[must_use]
    pub fn mtpa_at_current(&self, length: f64) -> f64 {
        let (psi, saliency) = (self.flux_linkage, self.saliency());
        2.0 * saliency * length * length / (psi + libm::sqrt(psi * psi + 8.0 * saliency * saliency * length * length))
    }

    /// d-axis current with which `effort` takes the least current (A).
    #[must_use]
    pub fn mtpa(&self, effort: f64) -> f64 {
        let (psi, saliency) = (self.flux_linkage, self.saliency());
        let wanted = effort / (1.5 * self.electrical_ratio);
        let right = saliency * saliency * wanted * wanted;
        let mut w = psi + libm::sqrt(libm::sqrt(right));
        // Without magnets and torque, or with a torque whose square underflows to zero.
        if w == 0.0 {
            return 0.0;
        }
        for _ in 0..NEWTON {
            w -= (w * w * w * (w - psi) - right) / (w * w * (4.0 * w - 3.0 * psi));
        }
        saliency * wanted * wanted / (w * w * w)
    }

    /// Steady voltage at `current` and the electrical speed `omega_e` (V).
    #[must_use]
    pub fn steady_voltage(&self, Dq { d, q }: Dq, omega_e: f64) -> Dq {
        Dq {
            d: self.resistance * d - omega_e * self.inductance.q * q,
            q: self.resistance * q + omega_e * (self.inductance.d * d + self.flux_linkage),
        }
    }
}

/// Current and voltage limit at a speed, in the direction in which i_q has the sign `sign`.
struct Bounds<'a> {
    p: &'a Loop,
    voltage: f64,
    omega_e: f64,
    sign: f64,
}

impl Bounds<'_> {
    /// Largest |i_q| at the d-axis current `d`; below 0 if the voltage does not suffice for i_q = 0.
    fn q_current(&self, d: f64) -> f64 {
        let motor = &self.p.motor;
        let (r, omega, l) = (motor.resistance, self.omega_e, motor.inductance);
        let circle = super::q_current(self.p.max_current, d);
        let flux = l.d * d + motor.flux_linkage;
        let excess = r * r * d * d + omega * omega * flux * flux - self.voltage * self.voltage;
        let square = r * r + omega * omega * l.q * l.q;
        if excess > 0.0 {
            return -excess / square;
        }
        let half = self.sign * r * omega * (motor.saliency() * d + motor.flux_linkage);
        // For a positive `half` the difference would cancel: computed by the product of the roots instead.
        let root = libm::sqrt(half * half - square * excess);
        let ellipse = if half > 0.0 { -excess / (half + root) } else { (root - half) / square };
        circle.min(ellipse)
    }

    /// Largest effort at `d`; below 0, in other units, if there is none.
    fn effort(&self, d: f64) -> f64 {
        let q = self.q_current(d);
        if q > 0.0 { self.p.motor.effort_constant(d) * q } else { q }
    }

    /// Largest d-axis current of the search for the largest effort, under a strategy that prefers `most`.
    fn highest(&self, most: f64) -> f64 {
        let motor = &self.p.motor;
        if motor.saliency() < 0.0 && motor.flux_linkage < -motor.inductance.d * most { 0.0 } else { most }
    }

    /// Largest effort under a strategy that prefers the d-axis current `most` for it.
    fn peak(&self, most: f64) -> Peak {
        let motor = &self.p.motor;
        let ceiling =
            Peak { effort: motor.effort_constant(most) * super::q_current(self.p.max_current, most), d: most };
        if self.effort(most) >= ceiling.effort {
            return ceiling;
        }
        // Range in which the voltage suffices for i_q = 0.
        let (r, omega, l) = (motor.resistance, self.omega_e, motor.inductance.d);
        let (square, psi) = (r * r + omega * omega * l * l, motor.flux_linkage);
        let middle = -omega * omega * l * psi / square;
        let inside = self.voltage * self.voltage * square - omega * omega * psi * psi * r * r;
        let half = libm::sqrt(inside.max(0.0)) / square;
        let (mut low, mut high) = ((middle - half).max(-self.p.max_current), (middle + half).min(self.highest(most)));
        if motor.saliency() > 0.0 {
            // Below, i_q makes an effort against its sign.
            low = low.max(-psi / motor.saliency());
        }
        if inside < 0.0 || low > high {
            return Peak { effort: 0.0, d: middle.clamp(-self.p.max_current, most) };
        }
        let within = |share: f64, low: f64, high: f64| low + share * (high - low);
        let (mut left, mut right) = (within(1.0 - GOLDEN, low, high), within(GOLDEN, low, high));
        let (mut at_left, mut at_right) = (self.effort(left), self.effort(right));
        for _ in 0..SECTIONS {
            if at_left < at_right {
                (low, left, at_left) = (left, right, at_right);
                right = within(GOLDEN, low, high);
                at_right = self.effort(right);
            } else {
                (high, right, at_right) = (right, left, at_left);
                left = within(1.0 - GOLDEN, low, high);
                at_left = self.effort(left);
            }
        }
        let d = f64::midpoint(low, high);
        Peak { effort: self.effort(d).clamp(0.0, ceiling.effort), d }
    }
}

impl Envelope {
    /// Envelope at the electrical speed `omega_e` (rad/s), with the correction by the voltage feedback.
    #[must_use]
    pub fn new(p: &Loop, x: &State, omega_e: f64) -> Self {
        let voltage = match p.operation.weakening {
            Some(Weakening { share, .. }) => share * p.max_voltage + x.correction,
            None => f64::INFINITY,
        };
        let most = match p.operation.strategy {
            Strategy::DReference => p.d_reference,
            Strategy::Mtpa => p.motor.mtpa_at_current(p.max_current),
        };
        let peak = |sign: f64| {
            if voltage.is_finite() {
                return Bounds { p, voltage, omega_e, sign }.peak(most);
            }
            Peak { effort: p.motor.effort_constant(most) * super::q_current(p.max_current, most), d: most }
        };
        Self { forward: peak(1.0), backward: peak(-1.0), voltage, omega_e }
    }

    /// Largest efforts.
    #[must_use]
    pub const fn limits(&self) -> EffortLimits {
        EffortLimits { forward: self.forward.effort, backward: self.backward.effort }
    }

    /// Currents of `effort`, which is cut to the envelope.
    #[must_use]
    pub fn currents(&self, p: &Loop, effort: f64) -> Dq {
        let (sign, peak) = if effort < 0.0 { (-1.0, self.backward) } else { (1.0, self.forward) };
        let wanted = (sign * effort).min(peak.effort);
        let mut d = match p.operation.strategy {
            Strategy::DReference => p.d_reference,
            Strategy::Mtpa => p.motor.mtpa(wanted),
        };
        if self.voltage.is_finite() {
            let bounds = Bounds { p, voltage: self.voltage, omega_e: self.omega_e, sign };
            // The demand exceeds the envelope only by the rounding of the search.
            let suffices = |d: f64| bounds.effort(d) >= wanted * (1.0 - 1e-9);
            if !suffices(d) {
                let (mut enough, mut too_little) = (peak.d, d);
                for _ in 0..HALVINGS {
                    let middle = f64::midpoint(enough, too_little);
                    *(if suffices(middle) { &mut enough } else { &mut too_little }) = middle;
                }
                d = enough;
            }
        }
        let most = super::q_current(p.max_current, d);
        let per_ampere = p.motor.effort_constant(d);
        // A motor without magnets and current would lead to a division by zero.
        Dq { d, q: if per_ampere > 0.0 { sign * (wanted / per_ampere).min(most) } else { 0.0 } }
    }
}

/// Advances `x` by `h` (s) with the voltage that the current loop computed (V).
pub fn step(p: &Loop, x: &mut State, computed: Dq, h: f64) {
    let Some(Weakening { share, feedback }) = p.operation.weakening else { return };
    if feedback == 0.0 || p.max_voltage.is_infinite() {
        return;
    }
    let most = share * p.max_voltage;
    let left = most - computed.magnitude();
    // An explicit step of more than 1 would overshoot.
    x.correction = (x.correction + (h * feedback).min(1.0) * left).clamp(-most / 2.0, 0.0);
}

#[cfg(test)]
mod tests;
