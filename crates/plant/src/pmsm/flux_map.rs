//! Flux linkage of currents and magnets in iron that saturates: the gradient of one co-energy, so that no closed cycle makes energy.
//!
//! ```text
//! ψ_d = ∂W'/∂i_d      ψ_q = ∂W'/∂i_q      L_dd = ∂²W'/∂i_d²      L_dq = ∂²W'/∂i_d∂i_q = L_qd      L_qq = ∂²W'/∂i_q²
//! T = 3/2·p·(ψ_d·i_q − ψ_q·i_d)           field: 3/2·W, W = ψ_d·i_d + ψ_q·i_q − W'
//! ```
//! W' is either [interpolated](table) in a table of flux linkages, or a [curve](curve) from one figure of a data sheet. It is convex
//! in both: the currents follow from the flux linkages. Co-energy: Krause, *Analysis of Electric Machinery*, 3rd ed., ch. 1.
//!
//! The magnets are included: ψ_d without current is their flux linkage at the reference temperature. Its change at another
//! temperature, and their harmonics, are added to it, independently of the currents.
mod build;
mod curve;
mod table;

pub use build::{FluxData, FluxMapError, FluxPart};
use curve::Curve;
pub use curve::{Saturation, SaturationParameter};
use servobench_base::{Dq, ParamError};
use std::sync::Arc;
use table::FluxTable;

/// Flux linkage as a function of the currents.
#[derive(Debug, Clone, PartialEq)]
pub struct FluxMap {
    form: Form,
    /// A computed flux linkage has the rounding of this scale, however small it is (V·s).
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
    /// The map of a table.
    ///
    /// # Errors
    /// [`FluxMapError`] gives the mistake in the table, its place, and the remedy.
    pub fn table(data: &FluxData) -> Result<Self, FluxMapError> {
        let scale = data.psi_d.iter().chain(&data.psi_q).fold(0.0, |most: f64, psi| most.max(psi.abs()));
        build::table(data).map(|table| Self { form: Form::Table(Arc::new(table)), scale })
    }

    /// The map of a motor whose data sheet gives `flux_linkage` (V·s) and `inductance` (H) without current.
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

    /// W(ψ₁) − W(ψ₀) − i₀·(ψ₁ − ψ₀) from the current `before` to `after`: the field energy beyond first order, to its own digits.
    pub(super) fn beyond(&self, before: Dq, after: Dq) -> f64 {
        match &self.form {
            Form::Table(table) => table.beyond(before, after),
            Form::Curve(curve) => curve.beyond(before, after),
        }
    }

    /// Increase of the field energy from the current `before` to `after` (J).
    #[must_use]
    pub fn stored(&self, before: Dq, after: Dq) -> f64 {
        let ends = [before, after].map(|i| self.flux(i));
        let first = before.d * (ends[1].d - ends[0].d) + before.q * (ends[1].q - ends[0].q);
        1.5 * (first + self.beyond(before, after))
    }

    /// The current near `near` for the flux linkage `flux`, by Newton's method; `None` if it does not converge.
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

    /// The square of `flux`, at least that of the scale of its rounding (V²·s²).
    pub(super) fn square(&self, flux: Dq) -> f64 {
        (flux.d * flux.d + flux.q * flux.q).max(self.scale * self.scale)
    }

    /// Largest difference of two flux linkages near `flux` that are equal but for rounding (V·s).
    pub(super) fn rounding(&self, flux: Dq) -> f64 {
        ROUNDINGS * f64::EPSILON * self.scale.max(flux.d.abs()).max(flux.q.abs())
    }
}

/// Step of Newton's method, relative to the current, below which it is the last one.
pub(super) const CONVERGED: f64 = 1e-8;
/// Roundings of the flux linkage within which a step is the last one, too: near zero, where the magnets are all of the flux linkage,
/// no step is small relative to the current. A polynomial of the third power has about as many.
const ROUNDINGS: f64 = 8.0;
/// Maximum number of steps; more mean that it does not converge.
pub(super) const MOST_STEPS: u32 = 25;

impl Inductance {
    /// Change of the current for that of the flux linkage.
    pub(super) fn solved(&self, flux: Dq) -> Dq {
        let Self { dd, dq, qq } = *self;
        let per = 1.0 / (dd * qq - dq * dq);
        Dq { d: per * (qq * flux.d - dq * flux.q), q: per * (dd * flux.q - dq * flux.d) }
    }

    /// Smallest inductance in any direction.
    pub(super) fn smallest(&self) -> f64 {
        let half = (self.dd - self.qq) / 2.0;
        f64::midpoint(self.dd, self.qq) - libm::sqrt(half * half + self.dq * self.dq)
    }

    /// Largest relative difference from `other`.
    pub(super) fn difference(&self, other: &Self) -> f64 {
        let dd = (other.dd - self.dd).abs() / self.dd.min(other.dd);
        let qq = (other.qq - self.qq).abs() / self.qq.min(other.qq);
        let dq = (other.dq - self.dq).abs() / libm::sqrt(self.dd.min(other.dd) * self.qq.min(other.qq));
        dd.max(qq).max(dq)
    }
}

#[cfg(test)]
pub(super) mod tests;
