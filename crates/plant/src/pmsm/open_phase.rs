//! A winding with a lost phase: the other two are in series, and have a single current.
//!
//! ```text
//! i = s·n      n = [cos γ, sin γ] in the rotor frame, γ = θ_n − θ      θ_n: at right angles to the axis of the lost phase, in the stator
//! u_n = R_n·s + d(ℓ·s)/dt + ω·nᵀ·e      ℓ = nᵀ·L·n = L_d·cos²γ + L_q·sin²γ      R_n = nᵀ·R·n
//! T = 3/2·p·(nᵀ·e·s + (L_d − L_q)·sin γ·cos γ·s²)                              e = [ψ_d′ − ψ_q, ψ_q′ + ψ_d]
//! ```
//! These are the equations of the motor along n; across it, the voltage at the open terminal keeps the current of that phase at
//! zero, and does no work. With w = √ℓ·s the energy of the field is ¾·w²,
//!
//! ```text
//! dw/dt = (u_n − ω·nᵀ·e)/√ℓ − (R_n + ℓ′/2)/ℓ·w        ℓ′ = dℓ/dt = 2·ω·(L_d − L_q)·sin γ·cos γ
//! ```
//! solved by the Gauss method of two stages, which keeps quadratic invariants: the energies close to the rounding, as in `varying`, with
//! parts of the same length. Source: Krause, *Analysis of Electric Machinery*, 3rd ed., ch. 4; Hairer, Lubich and Wanner, *Geometric
//! Numerical Integration*, 2nd ed., ch. IV.2.
use super::Params;
use super::effects::RealMotor;
use super::flux_harmonics::{Flux, FluxHarmonic};
use super::gauss::{self, OFF_THE_MIDDLE, STAGES};
use super::phases::{Entries, PhaseMatrix};
use super::winding::{Span, Sums, Winding, stored};
use servobench_base::{AlphaBeta, Dq, Rotation};

/// A winding whose current flows along a fixed line in the stator.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OpenPhase<'a> {
    params: &'a Params,
    harmonics: &'a [FluxHarmonic],
    phases: PhaseMatrix,
    /// Resistance before each phase, outside the motor (Ω).
    series: f64,
    /// n in the stator frame.
    line: AlphaBeta,
}

/// The equation at a stage.
struct Stage {
    /// Along the line: voltage, drop of the devices before it (V), voltage per speed (V·s), resistance of the motor (Ω), inductance (H).
    voltage: f64,
    drop: f64,
    per_speed: f64,
    resistance: f64,
    inductance: f64,
    /// (L_d − L_q)·sin γ·cos γ.
    reluctance: f64,
}

impl Winding for OpenPhase<'_> {
    fn advance<const POWER: bool>(&self, i: Dq, over: &Span, sums: &mut Sums) -> Dq {
        let Span { rotor, omega, time, .. } = *over;
        let (n, l) = self.along(rotor);
        let parts = self.parts(omega * time, time);
        let part = time / f64::from(parts);
        let first = libm::sqrt(l) * (n.d * i.d + n.q * i.q);
        let last =
            (0..parts).fold(first, |w, k| self.part(w, over, rotor.ahead(omega * part * f64::from(k)), part, sums));
        let (n, l) = self.along(rotor.ahead(omega * time));
        let s = last / libm::sqrt(l);
        Dq { d: s * n.d, q: s * n.q }
    }

    fn electrical_ratio(&self) -> f64 {
        self.params.electrical_ratio
    }

    fn stored(&self, before: Dq, after: Dq) -> f64 {
        stored(self.params.inductance, before, after)
    }
}

impl<'a> OpenPhase<'a> {
    /// The winding of the motor that is `params` at this tick, with the effects of `real`, behind `series` (Ω), its current along `line`.
    pub(crate) fn new(params: &'a Params, real: Option<&'a RealMotor>, series: f64, line: AlphaBeta) -> Self {
        let (harmonics, phases) = real.map_or((&[][..], PhaseMatrix::EQUAL), RealMotor::harmonics_and_phases);
        Self { params, harmonics, phases, series, line }
    }

    /// n in the frame of a rotor at `rotor`, and the inductance along it.
    fn along(&self, rotor: Rotation) -> (Dq, f64) {
        let (n, l) = (self.line.to_dq(rotor), self.params.inductance);
        (n, l.d * n.d * n.d + l.q * n.q * n.q)
    }

    fn parts(&self, turn: f64, h: f64) -> u32 {
        let Params { resistance, inductance, .. } = self.params;
        let decay = h * (resistance * self.phases.largest() + self.series) / inductance.d.min(inductance.q);
        gauss::parts(decay, turn, self.harmonics, 0.0)
    }

    fn stage(&self, over: &Span, rotor: Rotation) -> Stage {
        let ((n, inductance), l) = (self.along(rotor), self.params.inductance);
        let flux = Flux::at(self.params.flux_linkage, self.harmonics, rotor);
        let Entries { dd, dq, qq } = self.phases.at(rotor);
        let along = |of: AlphaBeta| self.line.alpha * of.alpha + self.line.beta * of.beta;
        Stage {
            voltage: along(over.voltage),
            drop: along(over.drop),
            per_speed: n.d * (flux.slope_d - flux.q) + n.q * (flux.slope_q + flux.d),
            resistance: self.params.resistance * (dd * n.d * n.d + 2.0 * dq * n.d * n.q + qq * n.q * n.q),
            inductance,
            reluctance: (l.d - l.q) * n.d * n.q,
        }
    }

    fn part(&self, w: f64, over: &Span, rotor: Rotation, h: f64, sums: &mut Sums) -> f64 {
        let omega = over.omega;
        let stages = STAGES.map(|at| self.stage(over, rotor.ahead(omega * h * at)));
        // dw/dt = b − a·w.
        let [a, b] = [
            stages.each_ref().map(|one| (one.resistance + self.series + omega * one.reluctance) / one.inductance),
            stages.each_ref().map(|one| (one.voltage - omega * one.per_speed) / libm::sqrt(one.inductance)),
        ];
        let (own, less, more) = (0.25 * h, (0.25 - OFF_THE_MIDDLE) * h, (0.25 + OFF_THE_MIDDLE) * h);
        let known = [w + own * b[0] + less * b[1], w + more * b[0] + own * b[1]];
        let [[m00, m01], [m10, m11]] = [[1.0 + own * a[0], less * a[1]], [more * a[0], 1.0 + own * a[1]]];
        let determinant = m00 * m11 - m01 * m10;
        let at_stages =
            [(known[0] * m11 - known[1] * m01) / determinant, (known[1] * m00 - known[0] * m10) / determinant];
        let mut change = 0.0;
        for (k, stage) in stages.iter().enumerate() {
            change += h / 2.0 * (b[k] - a[k] * at_stages[k]);
            let s = at_stages[k] / libm::sqrt(stage.inductance);
            sums.torque += h / 2.0 * (stage.per_speed * s + stage.reluctance * s * s);
            sums.copper += h / 2.0 * stage.resistance * s * s;
            sums.square += h / 2.0 * s * s;
            sums.work += h / 2.0 * stage.voltage * s;
            sums.other += h / 2.0 * stage.drop * s;
        }
        w + change
    }
}

#[cfg(test)]
mod tests;
