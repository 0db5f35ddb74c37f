//! A motor whose iron saturates, by the Gauss method of two stages for the flux linkages, whose currents are corrected so that the field's
//! energy balances.
//!
//! ```text
//! dψ/dt = u(t) − e(θ) − R(θ)·i − ω·J·ψ        ψ = ψ(i) of the map        J·ψ = (−ψ_q, ψ_d)
//! ψ(I_j) = ψ_k + h·Σ a_jn·K_n                 K_j = u_j − e_j − R_j·Ĩ_j − ω·J·ψ(I_j)           j = 1, 2
//! ψ_{k+1} = ψ_k + h/2·(K_1 + K_2)             Ĩ_j = I_j + λ·K_j,  λ such that h/2·Σ Ĩ_j·K_j = W(ψ_{k+1}) − W(ψ_k)
//! ```
//! A Gauss method keeps the energy of constant inductances to the rounding. Where they change, its error is of the fifth power of h, which
//! λ removes: a discrete gradient (Gonzalez, *Journal of Nonlinear Science* 6, 1996) on top of a collocation, and also of fourth order
//! (Hairer, Lubich and Wanner, *Geometric Numerical Integration*, 2nd ed., ch. II.1 and V.5). Torque, losses and input all use Ĩ, so
//! that no power is lost in a tick however long it is. e is from the magnets' harmonics and from the effect of their temperature; the rest
//! of their flux linkage is in the map.
//!
//! A part of a tick is so short that the current decays by a quarter, that the rotor turns by a quarter radian, that a harmonic turns by
//! half a radian, and that the inductances change by [`LARGEST_CHANGE`] at most. Across a line of a table, where its inductances
//! jump, a part is of second order.
use super::flux_harmonics::{Flux, FluxHarmonic};
use super::flux_map::{CONVERGED, FluxMap, FluxPoint, Inductance, MOST_STEPS};
use super::gauss::{self, MOST_PARTS, STAGES, WEIGHTS, solved};
use super::phases::{Entries, PhaseMatrix};
use super::winding::{Span, Sums, Winding};
use super::{Params, moved};
use servobench_base::{Dq, Rotation};

/// Largest relative change of an inductance in a part of a tick.
const LARGEST_CHANGE: f64 = 0.25;
/// Maximum number of parts for that purpose.
const MOST_FOR_CHANGE: f64 = 64.0;
/// Relative change of a flux linkage, squared, below which it needs no correction: rounding is larger.
const NO_CHANGE: f64 = 1e-30;
/// Maximum steps towards λ: each leaves a hundredth of the error or less.
const MOST_CORRECTIONS: u32 = 8;

/// A motor that saturates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Saturated<'a> {
    /// Parameters with the resistance and flux linkage at this tick.
    pub(super) params: &'a Params,
    pub(super) map: &'a FluxMap,
    /// Flux linkage of the magnets in the map (V·s).
    pub(super) magnets: f64,
    pub(super) harmonics: &'a [FluxHarmonic],
    pub(super) phases: &'a PhaseMatrix,
    /// Resistance before each phase, outside the motor (Ω).
    pub(super) series: f64,
}

/// The equations at an instant.
struct Stage {
    u: Dq,
    /// Drop of the devices before it.
    drop: Dq,
    /// Flux of the magnets that is not in the map.
    flux: Flux,
    resistance: Entries,
    /// Resistance, including that in series.
    total: Entries,
    /// u − e.
    driving: Dq,
}

impl Winding for Saturated<'_> {
    fn advance<const POWER: bool>(&self, i: Dq, over: &Span, sums: &mut Sums) -> Dq {
        let mut parts = self.parts(i, over);
        loop {
            if let Some((after, more)) = self.in_parts(i, over, parts) {
                sums.add(&more);
                return after;
            }
            if f64::from(parts) >= MOST_PARTS {
                *sums = Sums::NAN;
                return Dq { d: f64::NAN, q: f64::NAN };
            }
            parts *= 4;
        }
    }

    fn electrical_ratio(&self) -> f64 {
        self.params.electrical_ratio
    }

    fn stored(&self, before: Dq, after: Dq) -> f64 {
        self.map.stored(before, after)
    }
}

impl Saturated<'_> {
    fn parts(&self, i: Dq, over: &Span) -> u32 {
        let Span { omega, time, .. } = *over;
        let here = self.map.at(i);
        let inductance = here.inductance;
        let resistance = self.params.resistance * self.phases.largest() + self.series;
        let decay = time * resistance / inductance.smallest();
        let stage = self.stage(over, over.rotor);
        let K { d, q } = stage.slope(omega, i, &here);
        let change = inductance.solved(Dq { d: time * d, q: time * q });
        let there = self.map.at(moved(i, change)).inductance;
        let of_saturation = (inductance.difference(&there) / LARGEST_CHANGE).min(MOST_FOR_CHANGE);
        gauss::parts(decay, omega * time, self.harmonics, of_saturation)
    }

    /// The current at the end; `None` when a part is too long for Newton's method.
    fn in_parts(&self, i: Dq, over: &Span, parts: u32) -> Option<(Dq, Sums)> {
        let (mut i, mut sums) = (i, Sums::default());
        let part = over.time / f64::from(parts);
        for k in 0..parts {
            i = self.part(i, over, over.rotor.ahead(over.omega * part * f64::from(k)), part, &mut sums)?;
        }
        Some((i, sums))
    }

    fn stage(&self, over: &Span, rotor: Rotation) -> Stage {
        let Params { resistance, flux_linkage, .. } = *self.params;
        let mut flux = Flux::at(flux_linkage, self.harmonics, rotor);
        flux.d -= self.magnets;
        let parts = self.phases.at(rotor);
        let resistance = Entries { dd: resistance * parts.dd, dq: resistance * parts.dq, qq: resistance * parts.qq };
        let total = Entries { dd: resistance.dd + self.series, qq: resistance.qq + self.series, ..resistance };
        let u = over.voltage.to_dq(rotor);
        let driving =
            Dq { d: u.d - over.omega * (flux.slope_d - flux.q), q: u.q - over.omega * (flux.slope_q + flux.d) };
        Stage { u, drop: over.drop.to_dq(rotor), flux, resistance, total, driving }
    }

    fn part(&self, i: Dq, over: &Span, rotor: Rotation, h: f64, sums: &mut Sums) -> Option<Dq> {
        let stages = STAGES.map(|at| self.stage(over, rotor.ahead(over.omega * h * at)));
        let before = self.map.at(i).flux;
        let changes = self.changes(i, before, &stages, over.omega, h)?;
        let points = changes.map(|change| self.map.at(moved(i, change)));
        // K_j without the correction.
        let free: [K; 2] = core::array::from_fn(|j| stages[j].slope(over.omega, moved(i, changes[j]), &points[j]));

        let no_change = NO_CHANGE * self.map.square(before);
        let (mut lambda, mut corrections) = (0.0, 0);
        let mut near =
            Dq { d: i.d + SQRT_3 * (changes[1].d - changes[0].d), q: i.q + SQRT_3 * (changes[1].q - changes[0].q) };
        let (after, slopes) = loop {
            let slopes: [K; 2] = core::array::from_fn(|j| stages[j].corrected(free[j], lambda));
            let [half_d, half_q] = [h / 2.0 * (slopes[0].d + slopes[1].d), h / 2.0 * (slopes[0].q + slopes[1].q)];
            let after = self.map.current(Dq { d: before.d + half_d, q: before.q + half_q }, near)?;
            near = after;
            let square = h / 2.0 * (slopes[0].square() + slopes[1].square());
            if h * square <= no_change || corrections == MOST_CORRECTIONS {
                break (after, slopes);
            }
            let (mut work, mut size, mut per) = (0.0, 0.0, 0.0);
            let end = Dq { d: after.d - i.d, q: after.q - i.q };
            for ((stage, slope), change) in stages.iter().zip(&slopes).zip(&changes) {
                let (along_d, along_q) = (change.d + lambda * slope.d, change.q + lambda * slope.q);
                work += h / 2.0 * (along_d * slope.d + along_q * slope.q);
                size += h / 2.0
                    * ((along_d.abs() + i.d.abs()) * slope.d.abs() + (along_q.abs() + i.q.abs()) * slope.q.abs());
                // R·K, by which K falls with λ.
                let Dq { d, q } = stage.total.times(Dq { d: slope.d, q: slope.q });
                per += h / 2.0 * ((end.d - change.d) * d + (end.q - change.q) * q);
            }
            let defect = self.map.beyond(i, after) - work;
            if defect.abs() <= f64::EPSILON * size {
                break (after, slopes);
            }
            lambda += defect / (square + per);
            corrections += 1;
        };
        for (n, stage) in stages.iter().enumerate() {
            let by = Dq { d: changes[n].d + lambda * slopes[n].d, q: changes[n].q + lambda * slopes[n].q };
            stage.account(moved(i, by), &points[n], h / 2.0, sums);
        }
        Some(after)
    }

    /// I_j − i: Newton's method for all four.
    fn changes(&self, i: Dq, before: Dq, stages: &[Stage; 2], omega: f64, h: f64) -> Option<[Dq; 2]> {
        let mut changes = [Dq::default(); 2];
        let driven = stages.iter().fold(0.0, |most: f64, one| most.max(one.driving.d.abs()).max(one.driving.q.abs()));
        let rounding = self.map.rounding(moved(before, Dq { d: h * driven, q: 0.0 }));
        for _ in 0..MOST_STEPS {
            let points = changes.map(|change| self.map.at(moved(i, change)));
            let mut system = [[0.0; 5]; 4];
            for n in 0..2 {
                let (point, stage) = (&points[n], &stages[n]);
                let Inductance { dd, dq, qq } = point.inductance;
                let K { d, q } = stage.slope(omega, moved(i, changes[n]), point);
                let total = stage.total;
                // −dK/dI.
                let falls =
                    [[total.dd - omega * dq, total.dq - omega * qq], [total.dq + omega * dd, total.qq + omega * dq]];
                for (j, weights) in WEIGHTS.iter().enumerate() {
                    for (axis, slope) in [d, q].into_iter().enumerate() {
                        let row = &mut system[2 * j + axis];
                        row[2 * n] = h * weights[n] * falls[axis][0];
                        row[2 * n + 1] = h * weights[n] * falls[axis][1];
                        row[4] += h * weights[n] * slope;
                    }
                }
                system[2 * n][2 * n] += dd;
                system[2 * n][2 * n + 1] += dq;
                system[2 * n + 1][2 * n] += dq;
                system[2 * n + 1][2 * n + 1] += qq;
                system[2 * n][4] -= point.flux.d - before.d;
                system[2 * n + 1][4] -= point.flux.q - before.q;
            }
            let missing = system.iter().fold(0.0, |most: f64, row| most.max(row[4].abs()));
            let [d1, q1, d2, q2] = solved(system);
            changes = [moved(changes[0], Dq { d: d1, q: q1 }), moved(changes[1], Dq { d: d2, q: q2 })];
            let step = d1.abs().max(q1.abs()).max(d2.abs()).max(q2.abs());
            let size =
                changes.iter().fold(i.d.abs().max(i.q.abs()), |most, one| most.max(one.d.abs()).max(one.q.abs()));
            if step <= CONVERGED * size || missing <= rounding {
                return Some(changes);
            }
        }
        None
    }
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// dψ/dt.
#[derive(Debug, Clone, Copy, PartialEq)]
struct K {
    d: f64,
    q: f64,
}

impl K {
    fn square(&self) -> f64 {
        self.d * self.d + self.q * self.q
    }
}

impl Stage {
    fn slope(&self, omega: f64, i: Dq, at: &FluxPoint) -> K {
        let drop = self.total.times(i);
        K { d: self.driving.d - drop.d + omega * at.flux.q, q: self.driving.q - drop.q - omega * at.flux.d }
    }

    /// K with the current that λ corrects: (1 + λ·R)·K is K without.
    fn corrected(&self, K { d, q }: K, lambda: f64) -> K {
        let Entries { dd, dq, qq } = self.total;
        let (dd, dq, qq) = (1.0 + lambda * dd, lambda * dq, 1.0 + lambda * qq);
        let per = 1.0 / (dd * qq - dq * dq);
        K { d: per * (qq * d - dq * q), q: per * (dd * q - dq * d) }
    }

    fn account(&self, i: Dq, at: &FluxPoint, time: f64, sums: &mut Sums) {
        let (flux, of_magnets) = (&at.flux, &self.flux);
        let Entries { dd, dq, qq } = self.resistance;
        sums.torque += time
            * ((flux.d + of_magnets.d + of_magnets.slope_q) * i.q - (flux.q + of_magnets.q - of_magnets.slope_d) * i.d);
        sums.copper += time * (dd * i.d * i.d + 2.0 * dq * i.d * i.q + qq * i.q * i.q);
        sums.square += time * (i.d * i.d + i.q * i.q);
        sums.work += time * (self.u.d * i.d + self.u.q * i.q);
        sums.other += time * (self.drop.d * i.d + self.drop.q * i.q);
    }
}

#[cfg(test)]
mod tests;
