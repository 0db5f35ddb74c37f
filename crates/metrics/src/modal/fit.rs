//! Separable least squares: for given poles the amplitudes follow from a linear problem; the poles are improved by
//! Levenberg–Marquardt on what the linear problem leaves.
//!
//! Source: Golub & Pereyra, *Separable nonlinear least squares*, Inverse Problems 19, 2003, with the Jacobian of Kaufman.
use super::least_squares::{Orthonormal, dot, solve_definite};
use super::model::Component;
use super::series::Series;

const MAX_STEPS: usize = 60;
const FIRST_DAMPING: f64 = 1e-3;
const MAX_DAMPING: f64 = 1e8;
/// Predicted change of the fitted curve, relative, below which the poles stand still (squared).
const STILL: f64 = 1e-28;

/// A constant and components fitted to a series.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// The components beside the constant.
    pub(crate) components: Vec<Component>,
    /// Coefficient of the constant, then those of the components in order.
    pub(crate) coefficients: Vec<f64>,
    /// Sum of squares of what is left.
    pub(crate) energy: f64,
    /// What is left.
    pub(crate) residual: Vec<f64>,
    columns: Vec<Vec<f64>>,
    basis: Orthonormal,
}

impl Fit {
    /// The best amplitudes of `components`; `None` when the series cannot tell them apart.
    pub(crate) fn linear(series: &Series, components: Vec<Component>) -> Option<Self> {
        let mut columns = vec![vec![1.0; series.values.len()]];
        for component in &components {
            component.columns(series, &mut columns);
        }
        let basis = Orthonormal::of(&columns)?;
        let mut residual = series.values.clone();
        let along = basis.remove_from(&mut residual);
        let coefficients = basis.back_substitute(along);
        let energy = dot(&residual, &residual);
        let finite = energy.is_finite() && coefficients.iter().all(|c| c.is_finite());
        finite.then_some(Self { components, coefficients, energy, residual, columns, basis })
    }

    /// The components with their coefficients.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (Component, &[f64])> {
        let mut next = 1;
        self.components.iter().map(move |component| {
            let first = next;
            next += component.width();
            (*component, &self.coefficients[first..next])
        })
    }

    /// Sum of the fitted components that `which` picks.
    pub(crate) fn sum_of(&self, which: impl Fn(Component) -> bool) -> Vec<f64> {
        let mut sum = vec![0.0; self.residual.len()];
        let mut next = 1;
        for component in &self.components {
            let these = next..next + component.width();
            next = these.end;
            if which(*component) {
                for k in these {
                    sum.iter_mut().zip(&self.columns[k]).for_each(|(y, x)| *y += self.coefficients[k] * x);
                }
            }
        }
        sum
    }

    /// The same with the poles where the energy is least.
    pub(crate) fn refined(mut self, series: &Series) -> Self {
        let scale = dot(&series.values, &series.values);
        let mut damping = FIRST_DAMPING;
        for _ in 0..MAX_STEPS {
            let derivatives = self.derivatives(series);
            let curvature: Vec<Vec<f64>> =
                derivatives.iter().map(|one| derivatives.iter().map(|two| dot(one, two)).collect()).collect();
            let slope: Vec<f64> = derivatives.iter().map(|column| dot(column, &self.residual)).collect();
            let Some(better) = self.improved(series, &curvature, &slope, &mut damping, scale) else {
                return self;
            };
            self = better;
        }
        self
    }

    /// Derivatives of the fitted curve by the poles, without what the amplitudes can make good.
    fn derivatives(&self, series: &Series) -> Vec<Vec<f64>> {
        let mut derivatives = Vec::new();
        let mut next = 1;
        for component in &self.components {
            let these = next..next + component.width();
            next = these.end;
            let (columns, coefficients) = (&self.columns[these.clone()], &self.coefficients[these]);
            component.derivatives(series, columns, coefficients, &mut derivatives);
        }
        for column in &mut derivatives {
            self.basis.remove_from(column);
        }
        derivatives
    }

    /// One accepted step; `None` when none is left that makes a difference.
    fn improved(
        &self,
        series: &Series,
        curvature: &[Vec<f64>],
        slope: &[f64],
        damping: &mut f64,
        scale: f64,
    ) -> Option<Self> {
        while *damping < MAX_DAMPING {
            let mut damped = curvature.to_vec();
            for (k, row) in damped.iter_mut().enumerate() {
                row[k] += *damping * row[k];
            }
            let step = solve_definite(damped, slope.to_vec())?;
            let change: f64 = curvature.iter().zip(&step).map(|(row, s)| s * dot(row, &step)).sum();
            if change <= STILL * scale {
                return None;
            }
            let trial = Self::linear(series, self.moved(&step, series));
            if let Some(trial) = trial.filter(|trial| trial.energy < self.energy) {
                *damping *= 0.1;
                return Some(trial);
            }
            *damping *= 10.0;
        }
        None
    }

    fn moved(&self, step: &[f64], series: &Series) -> Vec<Component> {
        let mut next = 0;
        self.components
            .iter()
            .map(|component| {
                let first = next;
                next += component.width();
                component.moved(&step[first..next], series)
            })
            .collect()
    }
}
