//! A motor whose equations change with the angle of the rotor, by the Gauss method of two stages.
//!
//! ```text
//! L·di/dt = u(t) − e(θ) − A(θ)·i           A = [ R_dd           R_dq − ω·L_q ]      θ = θ_k + ω·t
//!                                              [ R_dq + ω·L_d   R_qq         ]
//! I_j = i_k + h·Σ a_jn·K_n      K_j = L⁻¹·(u_j − e_j − A_j·I_j)      j = 1, 2 at t = (1/2 ∓ √3/6)·h
//! i_{k+1} = i_k + h/2·(K_1 + K_2)         mean of a power over the tick = (P_1 + P_2)/2
//! ```
//! Of fourth order at constant speed and stable for every tick. Gauss methods keep quadratic invariants: the change of ¾·iᵀ·L·i is h times
//! the mean of the powers of the stages to the rounding, so that no power is lost in a tick however long it is. If the speed changes
//! in a tick, its mean is used: second order, as for the motor without harmonics. Source: Hairer, Lubich and Wanner, *Geometric
//! Numerical Integration*, 2nd ed., ch. II.1 and IV.2.
//!
//! The time is divided so that a harmonic turns by at most half a radian and the current decays by at most a quarter in a part: the
//! error of a part is below (1/2)⁵/4320 of a harmonic and (1/4)⁵/720 of a transient.
use super::Params;
use super::flux_harmonics::{Flux, FluxHarmonic};
use super::gauss::{self, STAGES, WEIGHTS, solved};
use super::phases::{Entries, PhaseMatrix};
use super::winding::{Span, Sums, Winding, stored};
use servobench_base::{Dq, Rotation};

/// A motor whose equations change with the angle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Varying<'a> {
    /// Parameters with the resistance and flux linkage at this tick.
    pub(super) params: &'a Params,
    pub(super) harmonics: &'a [FluxHarmonic],
    pub(super) phases: &'a PhaseMatrix,
    /// Resistance before each phase, outside the motor (Ω).
    pub(super) series: f64,
}

/// The equations at a stage.
struct Stage {
    u: Dq,
    /// Drop of the devices before it.
    drop: Dq,
    flux: Flux,
    resistance: Entries,
    /// u − e.
    driving: Dq,
    /// A.
    slope: [[f64; 2]; 2],
}

impl Winding for Varying<'_> {
    fn advance<const POWER: bool>(&self, i: Dq, over: &Span, sums: &mut Sums) -> Dq {
        let Span { rotor, omega, time, .. } = *over;
        let parts = self.parts(omega * time, time);
        let part = time / f64::from(parts);
        (0..parts).fold(i, |i, k| self.part(i, over, rotor.ahead(omega * part * f64::from(k)), part, sums))
    }

    fn electrical_ratio(&self) -> f64 {
        self.params.electrical_ratio
    }

    fn stored(&self, before: Dq, after: Dq) -> f64 {
        stored(self.params.inductance, before, after)
    }
}

impl Varying<'_> {
    fn parts(&self, turn: f64, h: f64) -> u32 {
        let Params { resistance, inductance, .. } = self.params;
        let decay = h * (resistance * self.phases.largest() + self.series) / inductance.d.min(inductance.q);
        gauss::parts(decay, turn, self.harmonics, 0.0)
    }

    fn stage(&self, over: &Span, rotor: Rotation) -> Stage {
        let Params { resistance, inductance, flux_linkage, .. } = self.params;
        let omega = over.omega;
        let flux = Flux::at(*flux_linkage, self.harmonics, rotor);
        let parts = self.phases.at(rotor);
        let resistance = Entries { dd: resistance * parts.dd, dq: resistance * parts.dq, qq: resistance * parts.qq };
        let voltage = over.voltage.to_dq(rotor);
        let driving =
            Dq { d: voltage.d - omega * (flux.slope_d - flux.q), q: voltage.q - omega * (flux.slope_q + flux.d) };
        let slope = [
            [resistance.dd + self.series, resistance.dq - omega * inductance.q],
            [resistance.dq + omega * inductance.d, resistance.qq + self.series],
        ];
        Stage { u: voltage, drop: over.drop.to_dq(rotor), flux, resistance, driving, slope }
    }

    fn part(&self, i: Dq, over: &Span, rotor: Rotation, h: f64, sums: &mut Sums) -> Dq {
        let l = self.params.inductance;
        let stages = STAGES.map(|at| self.stage(over, rotor.ahead(over.omega * h * at)));
        // L·I_j + h·Σ a_jn·A_n·I_n = L·i + h·Σ a_jn·(u_n − e_n), unknowns (I_1d, I_1q, I_2d, I_2q).
        let mut system = [[0.0; 5]; 4];
        for (j, weights) in WEIGHTS.iter().enumerate() {
            for (axis, (inductance, current)) in [(l.d, i.d), (l.q, i.q)].into_iter().enumerate() {
                let row = &mut system[2 * j + axis];
                row[4] = inductance * current;
                row[2 * j + axis] = inductance;
                for (n, (stage, weight)) in stages.iter().zip(weights).enumerate() {
                    row[2 * n] += h * weight * stage.slope[axis][0];
                    row[2 * n + 1] += h * weight * stage.slope[axis][1];
                    row[4] += h * weight * [stage.driving.d, stage.driving.q][axis];
                }
            }
        }
        let [d1, q1, d2, q2] = solved(system);
        let mut change = Dq::default();
        for (stage, i) in stages.iter().zip([Dq { d: d1, q: q1 }, Dq { d: d2, q: q2 }]) {
            let [[dd, dq], [qd, qq]] = stage.slope;
            change.d += h / 2.0 * (stage.driving.d - dd * i.d - dq * i.q) / l.d;
            change.q += h / 2.0 * (stage.driving.q - qd * i.d - qq * i.q) / l.q;
            let Entries { dd, dq, qq } = stage.resistance;
            let flux = &stage.flux;
            sums.torque +=
                h / 2.0 * ((flux.d + flux.slope_q) * i.q + (flux.slope_d - flux.q) * i.d + (l.d - l.q) * i.d * i.q);
            sums.copper += h / 2.0 * (dd * i.d * i.d + 2.0 * dq * i.d * i.q + qq * i.q * i.q);
            sums.square += h / 2.0 * (i.d * i.d + i.q * i.q);
            sums.work += h / 2.0 * (stage.u.d * i.d + stage.u.q * i.q);
            sums.other += h / 2.0 * (stage.drop.d * i.d + stage.drop.q * i.q);
        }
        Dq { d: i.d + change.d, q: i.q + change.q }
    }
}

#[cfg(test)]
mod tests;
