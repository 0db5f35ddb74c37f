//! Flux linkage of currents and magnets in iron that saturates: the gradient of one co-energy, so that no closed cycle makes energy.
//!
//! ```text
//! ψ_d = ∂W'/∂i_d      ψ_q = ∂W'/∂i_q      L_dd = ∂²W'/∂i_d²      L_dq = ∂²W'/∂i_d∂i_q = L_qd      L_qq = ∂²W'/∂i_q²
//! T = 3/2·p·(ψ_d·i_q − ψ_q·i_d)           field: 3/2·W, W = ψ_d·i_d + ψ_q·i_q − W'
//! ```
//! W' is either [interpolated](table) in a table of flux linkages, or a [curve](curve) that one figure of a data sheet gives. It is convex
//! in both: the currents follow from the flux linkages. Co-energy: Krause, *Analysis of Electric Machinery*, 3rd ed., ch. 1.
//!
//! The magnets are in it: ψ_d without current is their flux linkage at the reference temperature. What they have more or less at
//! another temperature, and their harmonics, add on to it, whatever the currents are.
mod build;
mod curve;
mod table;

pub use build::{FluxData, FluxMapError, FluxPart};
use curve::Curve;
pub use curve::{Saturation, SaturationParameter};
use servobench_base::{Dq, ParamError};
use std::sync::Arc;
use table::FluxTable;

/// Flux linkage by the currents.
#[derive(Debug, Clone, PartialEq)]
pub struct FluxMap {
    form: Form,
    /// A computed flux linkage has the rounding of this one, however small it is itself (V·s).
    scale: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Form {
    Table(Arc<FluxTable>),
    Curve(Curve),
}

/// Incremental inductances (H).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Inductance {
    pub(super) dd: f64,
    pub(super) dq: f64,
    pub(super) qq: f64,
}

/// A map at some currents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FluxPoint {
    pub(super) flux: Dq,
    pub(super) inductance: Inductance,
}

impl FluxMap {
    /// That of a table.
    ///
    /// # Errors
    /// [`FluxMapError`] says what is wrong with the table and where, and the way out.
    pub fn table(data: &FluxData) -> Result<Self, FluxMapError> {
        let scale = data.psi_d.iter().chain(&data.psi_q).fold(0.0, |most: f64, psi| most.max(psi.abs()));
        build::table(data).map(|table| Self { form: Form::Table(Arc::new(table)), scale })
    }

    /// That of a motor whose data sheet gives `flux_linkage` (V·s) and `inductance` (H) without current.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub fn curve(saturation: &Saturation, flux_linkage: f64, inductance: Dq) -> Result<Self, ParamError> {
        Curve::new(saturation, flux_linkage, inductance)
            .map(|curve| Self { form: Form::Curve(curve), scale: flux_linkage })
    }

    /// Flux linkage at the current `i` (V·s).
    #[must_use]
    pub fn flux(&self, i: Dq) -> Dq {
        self.at(i).flux
    }

    pub(super) fn at(&self, i: Dq) -> FluxPoint {
        match &self.form {
            Form::Table(table) => table.at(i),
            Form::Curve(curve) => curve.at(i),
        }
    }

    /// W(ψ₁) − W(ψ₀) − i₀·(ψ₁ − ψ₀) from the current `before` to `after`: what the field takes beyond first order, with its own digits.
    pub(super) fn beyond(&self, before: Dq, after: Dq) -> f64 {
        match &self.form {
            Form::Table(table) => table.beyond(before, after),
            Form::Curve(curve) => curve.beyond(before, after),
        }
    }

    /// Energy that the field has more with the current `after` than with `before` (J).
    #[must_use]
    pub fn stored(&self, before: Dq, after: Dq) -> f64 {
        let ends = [before, after].map(|i| self.flux(i));
        let first = before.d * (ends[1].d - ends[0].d) + before.q * (ends[1].q - ends[0].q);
        1.5 * (first + self.beyond(before, after))
    }

    /// The current from `near`, where the flux linkage is `flux`: Newton's method; `None` when it does not come to its end.
    pub(super) fn current(&self, flux: Dq, near: Dq) -> Option<Dq> {
        let mut i = near;
        for _ in 0..MOST_STEPS {
            let FluxPoint { flux: here, inductance } = self.at(i);
            let missing = Dq { d: flux.d - here.d, q: flux.q - here.q };
            let step = inductance.solved(missing);
            i = Dq { d: i.d + step.d, q: i.q + step.q };
            // Quadratic convergence: the next step would be below the rounding.
            if step.d.abs().max(step.q.abs()) <= CONVERGED * i.d.abs().max(i.q.abs())
                || missing.d.abs().max(missing.q.abs()) <= self.rounding(flux)
            {
                return Some(i);
            }
        }
        None
    }

    /// The square of `flux`, or of what its rounding is of (V²·s²).
    pub(super) fn square(&self, flux: Dq) -> f64 {
        (flux.d * flux.d + flux.q * flux.q).max(self.scale * self.scale)
    }

    /// Two flux linkages near `flux` that are apart by no more than this are the same one (V·s).
    pub(super) fn rounding(&self, flux: Dq) -> f64 {
        ROUNDINGS * f64::EPSILON * self.scale.max(flux.d.abs()).max(flux.q.abs())
    }
}

/// A step of Newton's method that is so small relative to the current is the last one.
pub(super) const CONVERGED: f64 = 1e-8;
/// So is one from flux linkages that are right but for so many roundings: near zero, where the magnets are all of the flux linkage, no step
/// is small relative to the current. A polynomial of the third power has about as many.
const ROUNDINGS: f64 = 8.0;
/// As many steps are taken; more mean that it does not converge.
pub(super) const MOST_STEPS: u32 = 25;

impl Inductance {
    /// The change of the current with that of the flux linkage.
    pub(super) fn solved(&self, flux: Dq) -> Dq {
        let Self { dd, dq, qq } = *self;
        let per = 1.0 / (dd * qq - dq * dq);
        Dq { d: per * (qq * flux.d - dq * flux.q), q: per * (dd * flux.q - dq * flux.d) }
    }

    /// The smallest that a direction has.
    pub(super) fn smallest(&self) -> f64 {
        let half = (self.dd - self.qq) / 2.0;
        f64::midpoint(self.dd, self.qq) - libm::sqrt(half * half + self.dq * self.dq)
    }

    /// By how much of itself it is another one at `other`, at most.
    pub(super) fn difference(&self, other: &Self) -> f64 {
        let dd = (other.dd - self.dd).abs() / self.dd.min(other.dd);
        let qq = (other.qq - self.qq).abs() / self.qq.min(other.qq);
        let dq = (other.dq - self.dq).abs() / libm::sqrt(self.dd.min(other.dd) * self.qq.min(other.qq));
        dd.max(qq).max(dq)
    }
}

#[cfg(test)]
pub(super) mod tests;
