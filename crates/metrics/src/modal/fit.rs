//! The amplitudes that fit best, for given poles.
use super::columns::{Columns, dot};
use super::least_squares::{Orthonormal, Solution};
use super::model::Component;
use super::series::Series;
use crate::extremes::most_of;
use std::ops::Range;

/// A constant and components fitted to a series.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// The components beside the constant.
    pub(crate) components: Vec<Component>,
    /// Sum of squares of the residual.
    pub(crate) energy: f64,
    /// Difference between the series and the fit.
    pub(crate) residual: Vec<f64>,
    /// Coefficient of the constant, then those of the components in order.
    pub(super) coefficients: Vec<f64>,
    /// Columns that the coefficients multiply.
    pub(super) columns: Columns,
    pub(super) basis: Orthonormal,
}

impl Fit {
    /// The best amplitudes of `components`; `None` when the series cannot tell them apart.
    pub(crate) fn of(components: Vec<Component>, series: &Series) -> Option<Self> {
        let width: usize = components.iter().map(|component| component.width()).sum();
        let mut columns = Columns::new(series.values.len(), 1 + width);
        columns.push(series.values.iter().map(|_| 1.0));
        for component in &components {
            component.add_to(&mut columns, series);
        }
        let Solution { basis, coefficients, residual } = Solution::of(&columns, &series.values)?;
        let energy = dot(&residual, &residual);
        let finite = energy.is_finite() && coefficients.iter().all(|c| c.is_finite());
        finite.then_some(Self { components, energy, residual, coefficients, columns, basis })
    }

    /// The constant beside the components.
    pub(crate) fn constant(&self) -> f64 {
        self.coefficients[0]
    }

    /// Largest magnitude of the residual.
    pub(crate) fn peak(&self) -> f64 {
        most_of([&self.residual], |[y]| y.abs())
    }

    /// The one of `candidates` that removes most of the residual, and by how much (sum of squares).
    pub(crate) fn best_of(&self, candidates: &Candidates) -> Option<(Component, f64)> {
        let Candidates { components, columns } = candidates;
        let gains = self.basis.gains(columns.clone(), components.first()?.width(), &self.residual);
        let gains = components.iter().zip(gains).filter_map(|(one, gain)| Some((*one, gain?)));
        gains.reduce(|one, two| if two.1 > one.1 { two } else { one })
    }

    /// The fit with one more component.
    pub(crate) fn with(&self, component: Component, series: &Series) -> Option<Self> {
        Self::of([self.components.as_slice(), &[component]].concat(), series)
    }

    /// The fit with the one of `candidates` that removes most of the residual.
    pub(crate) fn with_best_of(&self, candidates: &Candidates, series: &Series) -> Option<Self> {
        let (best, _) = self.best_of(candidates)?;
        self.with(best, series)
    }

    /// The components with the ranges of their coefficients.
    pub(super) fn terms(&self) -> impl Iterator<Item = (Component, Range<usize>)> {
        self.components.iter().scan(1, |next, component| {
            let first = *next;
            *next += component.width();
            Some((*component, first..*next))
        })
    }

    /// The components with their coefficients.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (Component, &[f64])> {
        self.terms().map(|(component, places)| (component, &self.coefficients[places]))
    }

    /// Sum of the fitted components selected by `which`.
    pub(crate) fn sum_of(&self, which: impl Fn(Component) -> bool) -> Vec<f64> {
        let mut sum = vec![0.0; self.residual.len()];
        for place in self.terms().filter(|(component, _)| which(*component)).flat_map(|(_, places)| places) {
            let coefficient = self.coefficients[place];
            sum.iter_mut().zip(self.columns.column(place)).for_each(|(y, x)| *y += coefficient * x);
        }
        sum
    }
}

/// Components that a fit may be extended by, all of the same kind, with their columns.
#[derive(Debug)]
pub(crate) struct Candidates {
    components: Vec<Component>,
    columns: Columns,
}

impl Candidates {
    pub(crate) fn of(components: Vec<Component>, series: &Series) -> Self {
        let width: usize = components.iter().map(|component| component.width()).sum();
        let mut columns = Columns::new(series.values.len(), width);
        for component in &components {
            component.add_to(&mut columns, series);
        }
        Self { components, columns }
    }
}
