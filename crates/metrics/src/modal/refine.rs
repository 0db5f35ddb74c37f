//! The poles that fit best: Levenberg–Marquardt on the residual of the best amplitudes (separable least squares).
//!
//! Source: Golub & Pereyra, *Separable nonlinear least squares*, Inverse Problems 19, 2003, with the Jacobian of Kaufman;
//! damping after Nielsen, *Damping parameter in Marquardt's method*, IMM-REP-1999-05.
use super::columns::{Columns, dot, dots};
use super::fit::Fit;
use super::least_squares::solve_definite;
use super::model::Component;
use super::series::Series;

/// Energy of rounding, relative to that of the series.
const ROUNDING: f64 = 1e-28;

/// Damping of a step, relative to the curvature.
struct Damping {
    mu: f64,
    /// Next increase of `mu`.
    increase: f64,
}

impl Damping {
    const START: Self = Self { mu: 1e-3, increase: 2.0 };

    /// After a step that took `share` of the predicted reduction: less damping the better the prediction was. More where
    /// much less was taken, or steps would go back and forth across a valley.
    fn accept(&mut self, share: f64) {
        let off = 2.0 * share - 1.0;
        *self = Self { mu: self.mu * (1.0 - off * off * off).clamp(0.1, 2.0), increase: 2.0 };
    }

    /// After a step that led uphill.
    fn reject(&mut self) {
        self.mu *= self.increase;
        self.increase *= 2.0;
    }
}

impl Fit {
    /// Moves the poles to where the energy is least, while steps promise to take the share `worth` of it and more than `least`,
    /// and there are `fits` left to try them.
    pub(crate) fn refined(mut self, series: &Series, worth: f64, least: f64, fits: &mut usize) -> Self {
        let least = least.max(ROUNDING * dot(&series.values, &series.values));
        let mut damping = Damping::START;
        while *fits > 0 {
            match self.improved(series, &mut damping, least.max(worth * self.energy), fits) {
                Some(better) => self = better,
                None => break,
            }
        }
        self
    }

    /// After one step downhill; `None` when none promises to take more than `least` of the energy, or no fit is left to try one.
    fn improved(&self, series: &Series, damping: &mut Damping, least: f64, fits: &mut usize) -> Option<Self> {
        let derivatives = self.derivatives(series);
        let count = derivatives.count();
        let curvature: Vec<Vec<f64>> = (0..count)
            .map(|k| {
                let mut row = vec![0.0; k + 1];
                dots(derivatives.column(k), derivatives.first(k + 1), &mut row);
                row
            })
            .collect();
        let mut slope = vec![0.0; count];
        dots(&self.residual, derivatives.first(count), &mut slope);
        loop {
            let mut damped = curvature.clone();
            damped.iter_mut().enumerate().for_each(|(k, row)| row[k] *= 1.0 + damping.mu);
            let step = solve_definite(damped, slope.clone())?;
            let held_back = |k: usize| damping.mu * curvature[k][k] * step[k];
            let promised: f64 = (0..step.len()).map(|k| step[k] * (slope[k] + held_back(k))).sum();
            if promised <= least {
                return None;
            }
            *fits = fits.checked_sub(1)?;
            match Self::of(self.moved(&step, series), series) {
                Some(better) if better.energy < self.energy => {
                    damping.accept((self.energy - better.energy) / promised);
                    return Some(better);
                }
                _ => damping.reject(),
            }
        }
    }

    /// Derivatives of the fitted curve with respect to the poles, without the part that the amplitudes can compensate.
    fn derivatives(&self, series: &Series) -> Columns {
        let mut derivatives = Columns::new(series.values.len(), self.coefficients.len());
        for (component, places) in self.terms() {
            component.add_derivatives_to(
                &mut derivatives,
                series,
                &self.columns,
                places.start,
                &self.coefficients[places],
            );
        }
        self.basis.remove_once(&mut derivatives);
        derivatives
    }

    fn moved(&self, step: &[f64], series: &Series) -> Vec<Component> {
        // The constant has a coefficient but no pole.
        self.terms()
            .map(|(component, places)| component.moved(&step[places.start - 1..places.end - 1], series))
            .collect()
    }
}
