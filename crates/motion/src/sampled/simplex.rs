//! The largest value of a linear function between bounds that lie symmetrically about zero.
//!
//! ```text
//! maximise c·x   with  |x_j| ≤ d_j  and  |a_r·x| ≤ b_r          (b_r = 0 is an equation)
//! ```
//!
//! Zero keeps all bounds, so that the primal simplex method starts there and needs no first phase; each a_r·x is a variable
//! too, basic at first. A variable outside the basis rests at a bound, or still at zero. The tableau is dense: the programs
//! here have some forty rows and columns. The caller checks the answer, on both sides
//! ([`reach`](super::reach)): a rounding in here can cost an optimum, never a limit.
use std::vec::Vec;

/// A program with no rows yet.
#[derive(Debug, Clone)]
pub(super) struct Program {
    objective: Vec<f64>,
    /// d_j.
    column_bounds: Vec<f64>,
    /// a_r, one after the other.
    rows: Vec<f64>,
    /// b_r.
    row_bounds: Vec<f64>,
}

/// The `x` of the largest value, and the `duals` that prove it.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    pub(super) x: Vec<f64>,
    /// λ_r, the growth of the value with the bound of row r: c·x ≤ Σ_j d_j·|c_j − Σ_r λ_r·a_rj| + Σ_r b_r·|λ_r| for
    /// every x that keeps the bounds, for any λ; with this one it is an equation at the largest.
    pub(super) duals: Vec<f64>,
}

/// Share of the largest entry below which an entry is rounding.
const ROUNDING: f64 = 1e-11;

/// Smallest divisor.
const PIVOT: f64 = 1e-9;

/// Steps after which the tableau is recomputed.
const RENEWAL: usize = 60;

/// Steps without a gain after which the first column that gains is taken instead of the steepest (Bland 1977).
const PATIENCE: usize = 20;

impl Program {
    /// Largest value of Σ `objective`_j·x_j with |x_j| ≤ `column_bounds`_j.
    pub(super) const fn new(objective: Vec<f64>, column_bounds: Vec<f64>) -> Self {
        Self { objective, column_bounds, rows: Vec::new(), row_bounds: Vec::new() }
    }

    /// Adds |`row`·x| ≤ `bound`.
    pub(super) fn bound(&mut self, row: impl IntoIterator<Item = f64>, bound: f64) {
        self.rows.extend(row);
        self.row_bounds.push(bound);
        debug_assert_eq!(self.rows.len(), self.row_bounds.len() * self.objective.len(), "one entry for each column");
    }

    /// Solves it; `None` when the method does not terminate.
    pub(super) fn solve(&self) -> Option<Solution> {
        let mut tableau = Tableau::of(self);
        tableau.enter_equations();
        let most = 50 * (self.objective.len() + self.row_bounds.len() + 1);
        let mut since = 0;
        for _ in 0..most {
            let improved = tableau.improve();
            since += usize::from(improved);
            if !improved && since == 0 {
                return Some(tableau.solution(self));
            }
            if !improved || since > RENEWAL {
                tableau = tableau.renewed(self);
                since = 0;
            }
        }
        None
    }
}

/// The basic variables and the objective as linear functions of the others. Variable j < columns is x_j, the others are
/// a_r·x; all are scaled so that no entry of a column or row exceeds one.
struct Tableau {
    columns: usize,
    /// Row r: the coefficients of basic variable r.
    entries: Vec<f64>,
    objective: Vec<f64>,
    /// Variable of each row and of each column.
    basic: Vec<usize>,
    others: Vec<usize>,
    /// Bounds by variable.
    bounds: Vec<f64>,
    values: Vec<f64>,
    scales: Vec<f64>,
    /// The unit of the objective.
    unit: f64,
    /// Steps in a row that gained nothing.
    idle: usize,
}

/// The largest magnitude, or one if all are zero.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0, |most: f64, value| most.max(value.abs()));
    if largest > 0.0 { largest } else { 1.0 }
}

impl Tableau {
    fn of(program: &Program) -> Self {
        let (columns, rows) = (program.objective.len(), program.row_bounds.len());
        let mut entries = program.rows.clone();
        let mut scales = program.column_bounds.clone();
        for (at, entry) in entries.iter_mut().enumerate() {
            *entry *= program.column_bounds[at % columns];
        }
        for row in entries.chunks_exact_mut(columns) {
            let scale = largest(row.iter().copied());
            for entry in row.iter_mut() {
                *entry /= scale;
            }
            scales.push(scale);
        }
        let mut objective: Vec<f64> =
            program.objective.iter().zip(&program.column_bounds).map(|(c, d)| c * d).collect();
        let unit = largest(objective.iter().copied());
        for c in &mut objective {
            *c /= unit;
        }
        let bounds =
            (0..columns).map(|_| 1.0).chain(program.row_bounds.iter().zip(&scales[columns..]).map(|(b, s)| b / s));
        Self {
            columns,
            entries,
            objective,
            basic: (columns..columns + rows).collect(),
            others: (0..columns).collect(),
            bounds: bounds.collect(),
            values: [0.0].repeat(columns + rows),
            scales,
            unit,
            idle: 0,
        }
    }

    fn row(&self, r: usize) -> &[f64] {
        &self.entries[r * self.columns..(r + 1) * self.columns]
    }

    /// Equations leave the basis first and for good: their variable has nowhere to go.
    fn enter_equations(&mut self) {
        for r in 0..self.basic.len() {
            if self.bounds[self.basic[r]] == 0.0 {
                let steepest = (0..self.columns)
                    .filter(|j| self.bounds[self.others[*j]] > 0.0)
                    .max_by(|j, k| self.row(r)[*j].abs().total_cmp(&self.row(r)[*k].abs()));
                if let Some(j) = steepest.filter(|j| self.row(r)[*j].abs() > ROUNDING) {
                    self.exchange(r, j);
                }
            }
        }
    }

    /// One step uphill; false without one.
    fn improve(&mut self) -> bool {
        let gain = |j: usize| {
            let (slope, variable) = (self.objective[j], self.others[j]);
            let (value, bound) = (self.values[variable], self.bounds[variable]);
            let open = bound > 0.0 && if slope > 0.0 { value < bound } else { value > -bound };
            if open && slope.abs() > ROUNDING { slope.abs() } else { 0.0 }
        };
        let candidate = if self.idle > PATIENCE {
            (0..self.columns).filter(|j| gain(*j) > 0.0).min_by_key(|j| self.others[*j])
        } else {
            (0..self.columns).max_by(|j, k| gain(*j).total_cmp(&gain(*k))).filter(|j| gain(*j) > 0.0)
        };
        let Some(j) = candidate else { return false };
        let direction = if self.objective[j] > 0.0 { 1.0 } else { -1.0 };
        let entering = self.others[j];
        // To its own bound, or to that of a basic variable; of those that are reached together, except for rounding
        // (Harris 1973), the one with the largest entry.
        let own = self.bounds[entering] - direction * self.values[entering];
        let (mut together, mut leaving, mut step) = (own, None, own);
        for r in 0..self.basic.len() {
            let entry = self.row(r)[j];
            if entry.abs() > PIVOT {
                together = together
                    .min((self.room(r, entry * direction) + ROUNDING * self.bounds[self.basic[r]]) / entry.abs());
            }
        }
        let mut largest = 0.0;
        for r in 0..self.basic.len() {
            let entry = self.row(r)[j];
            if entry.abs() > PIVOT.max(largest) {
                let room = self.room(r, entry * direction) / entry.abs();
                if room <= together && room < own {
                    (largest, leaving, step) = (entry.abs(), Some(r), room);
                }
            }
        }
        self.idle = if step > ROUNDING { 0 } else { self.idle + 1 };
        self.values[entering] += direction * step;
        for r in 0..self.basic.len() {
            let change = self.row(r)[j] * direction * step;
            self.values[self.basic[r]] += change;
        }
        if let Some(r) = leaving {
            // Exactly at its bound, whatever the rounding of the steps.
            let variable = self.basic[r];
            self.values[variable] = self.bounds[variable].copysign(self.row(r)[j] * direction);
            self.exchange(r, j);
        } else {
            self.values[entering] = direction * self.bounds[entering];
        }
        true
    }

    /// Range of basic variable `r` in a direction.
    fn room(&self, r: usize, direction: f64) -> f64 {
        let variable = self.basic[r];
        (self.bounds[variable] - self.values[variable].copysign(self.values[variable] * direction)).max(0.0)
    }

    /// The tableau of the same basis, recomputed from the program, without the rounding of the steps that led to it.
    fn renewed(&self, program: &Program) -> Self {
        let mut fresh = Self::of(program);
        let mut waiting: Vec<usize> = (0..self.columns).filter(|x| self.basic.contains(x)).collect();
        while !waiting.is_empty() {
            let free = (0..fresh.basic.len())
                .filter(|r| fresh.basic[*r] >= self.columns && self.others.contains(&fresh.basic[*r]));
            let pairs = free.flat_map(|r| waiting.iter().map(move |x| (r, *x)));
            let size = |(r, x): &(usize, usize)| fresh.row(*r)[*x].abs();
            let Some((r, x)) = pairs.max_by(|one, two| size(one).total_cmp(&size(two))) else { break };
            fresh.exchange(r, x);
            waiting.retain(|other| *other != x);
        }
        fresh.idle = self.idle;
        for variable in &self.others {
            fresh.values[*variable] = self.values[*variable];
        }
        for r in 0..fresh.basic.len() {
            let value = fresh.row(r).iter().zip(&fresh.others).map(|(entry, other)| entry * fresh.values[*other]).sum();
            fresh.values[fresh.basic[r]] = value;
        }
        fresh
    }

    /// Basic variable `r` and the other variable `j` change places.
    fn exchange(&mut self, r: usize, j: usize) {
        let n = self.columns;
        let pivot = 1.0 / self.entries[r * n + j];
        for entry in &mut self.entries[r * n..(r + 1) * n] {
            *entry *= -pivot;
        }
        self.entries[r * n + j] = pivot;
        let solved: Vec<f64> = self.row(r).to_vec();
        let substitute = |row: &mut [f64]| {
            let factor = core::mem::take(&mut row[j]);
            if factor != 0.0 {
                for (entry, solved) in row.iter_mut().zip(&solved) {
                    *entry += factor * solved;
                }
            }
        };
        for (i, row) in self.entries.chunks_exact_mut(n).enumerate() {
            if i != r {
                substitute(row);
            }
        }
        substitute(&mut self.objective);
        core::mem::swap(&mut self.basic[r], &mut self.others[j]);
    }

    fn solution(&self, program: &Program) -> Solution {
        let x = (0..self.columns).map(|j| self.values[j] * program.column_bounds[j]).collect();
        let mut duals = [0.0].repeat(self.basic.len());
        for (slope, variable) in self.objective.iter().zip(&self.others) {
            if let Some(r) = variable.checked_sub(self.columns) {
                duals[r] = slope * self.unit / self.scales[*variable];
            }
        }
        Solution { x, duals }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Oracle: duality. The solution keeps all bounds, and reaches the bound that its dual variables prove.
        #[test]
        fn the_duals_prove_the_largest_value(
            objective in prop::collection::vec(-1.0..1.0_f64, 1..9),
            rows in prop::collection::vec((prop::collection::vec(-1.0..1.0_f64, 9), 0..4_u8, 0.01..1.0_f64), 0..12),
        ) {
            let columns = objective.len();
            let bounds: Vec<f64> = (0..columns).map(|j| 1.0 + j as f64).collect();
            let mut program = Program::new(objective.clone(), bounds.clone());
            // One in four is an equation.
            let rows: Vec<(Vec<f64>, f64)> = rows.into_iter().map(|(row, kind, bound)| (row, if kind == 0 { 0.0 } else { bound })).collect();
            for (row, bound) in &rows {
                program.bound(row[..columns].iter().copied(), *bound);
            }
            let Solution { x, duals } = program.solve().unwrap();
            let dot = |row: &[f64]| row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>();
            for (x, bound) in x.iter().zip(&bounds) {
                prop_assert!(x.abs() <= bound * (1.0 + 1e-9));
            }
            let mut at_most = 0.0;
            for ((row, bound), dual) in rows.iter().zip(&duals) {
                // A few dozen steps, each of which divides by an entry; random rows are rarely near dependence.
                prop_assert!(dot(row).abs() <= bound + 1e-7, "{} {bound}", dot(row));
                at_most += bound * dual.abs();
            }
            for j in 0..columns {
                let cost: f64 = rows.iter().zip(&duals).map(|((row, _), dual)| row[j] * dual).sum();
                at_most += bounds[j] * (objective[j] - cost).abs();
            }
            let value = dot(&objective);
            prop_assert!((at_most - value).abs() <= 1e-6 * (1.0 + value.abs()), "{at_most} {value}");
        }
    }
}
