//! The common period of all loops: the matrices of its ticks, their product, and vectors on their way through it.
//!
//! The product is taken around once from the tick at which all loops turn, after they have: there every signal of a
//! controller is fresh, so that a loop is in it as a ring through a controller's state (`structure`).
use crate::equations::{Due, Equations};
use crate::error::StabilityError;
use nalgebra::{Complex, DMatrix, DVector};
use servobench_linear::{Pattern, TickMatrix};
use std::rc::Rc;

/// Largest entry of a product whose columns can still be squared and summed.
pub(crate) const LARGEST: f64 = 1e150;

pub(crate) type ComplexVector = DVector<Complex<f64>>;

/// The ticks of a common period.
pub(crate) struct Period {
    /// What is due, and the matrix of such a tick: `C·P`.
    kinds: Vec<(Due, TickMatrix)>,
    /// Index into `kinds` of each tick of the period, the one at which all loops turn last.
    ticks: Vec<usize>,
    /// The product of all.
    pub(crate) monodromy: DMatrix<f64>,
    /// States of each loop.
    pub(crate) loops: Rc<Vec<Vec<usize>>>,
    /// Length of a tick (s).
    pub(crate) h: f64,
}

/// `matrix` to the power of `exponent`; `None` for 1.
fn power<T: Clone>(matrix: &T, mut exponent: u32, after: impl Fn(&T, &T) -> T) -> Option<T> {
    let (mut power, mut square) = (None, matrix.clone());
    while exponent > 0 {
        if exponent & 1 == 1 {
            power = Some(power.map_or_else(|| square.clone(), |power| after(&square, &power)));
        }
        exponent >>= 1;
        if exponent > 0 {
            square = after(&square, &square);
        }
    }
    power
}

/// The product over a period of what is there for each kind of tick: each loop's period is a whole number of the periods of the loop
/// below it.
fn product<T: Clone>(
    of: impl Fn(Due) -> T,
    all: Due,
    [current, velocity, position]: [u32; 3],
    after: impl Fn(&T, &T) -> T + Copy,
) -> T {
    let behind = |last: T, before: Option<T>| before.map_or_else(|| last.clone(), |before| after(&last, &before));
    let idle = Due { position: false, velocity: false, current: false };
    let idle = if current > 1 { power(&of(idle), current - 1, after) } else { None };
    let current_period = |due: Due| behind(of(due), idle.clone());
    let velocity_period = |due: Due| {
        let inner = Due { position: false, velocity: false, current: true };
        let count = velocity / current - 1;
        behind(current_period(due), if count > 0 { power(&current_period(inner), count, after) } else { None })
    };
    let (inner, count) = (Due { position: false, ..all }, position / velocity - 1);
    behind(velocity_period(all), if count > 0 { power(&velocity_period(inner), count, after) } else { None })
}

impl Period {
    /// Of the loops that `equations` close.
    ///
    /// # Errors
    /// [`StabilityError`] when the loop does not run, [`StabilityError::Overflow`] when the product is beyond what can be computed with.
    pub(crate) fn new(equations: &mut Equations) -> Result<Self, StabilityError> {
        let (drive, current, closed) = (&equations.model().drive, equations.current_every(), equations.closed());
        // A loop that is open does not lengthen the period: what is below it repeats faster.
        let velocity = drive.velocity_every.ticks();
        let velocity = if closed.shaft { velocity } else { current };
        let position = if closed.position { drive.position_every.ticks() } else { velocity };

        let all = Due { position: closed.position, velocity: closed.shaft, current: true };
        let mut kinds: Vec<(Due, TickMatrix)> = Vec::new();
        let mut ticks = Vec::new();
        for k in 1..=position {
            let due = Due {
                position: all.position && k == position,
                velocity: all.velocity && k.is_multiple_of(velocity),
                current: k.is_multiple_of(current),
            };
            let index = kinds.iter().position(|(kind, _)| *kind == due);
            ticks.push(index.unwrap_or(kinds.len()));
            if index.is_none() {
                kinds.push((due, equations.matrix(due)?));
            }
        }
        let of = |due: Due| kinds.iter().find(|(kind, _)| *kind == due).map(|(_, tick)| &tick.matrix);
        let missing = || DMatrix::identity(equations.states(), equations.states());
        let rates = [current, velocity, position];
        let monodromy = product(|due| of(due).cloned().unwrap_or_else(missing), all, rates, |last, first| last * first);
        // NaN, too.
        if !monodromy.iter().all(|entry| entry.abs() < LARGEST) {
            return Err(StabilityError::Overflow { ticks: position });
        }
        let loops = equations.known_loops().unwrap_or_else(|| {
            let pattern = |due| of(due).map_or_else(|| Pattern::identity(equations.states()), Pattern::of);
            Rc::new(product(pattern, all, rates, Pattern::after).loops(&equations.controllers()))
        });
        equations.keep_loops(&loops);
        Ok(Self { kinds, ticks, monodromy, loops, h: equations.h() })
    }

    /// Length (s).
    pub(crate) fn seconds(&self) -> f64 {
        self.ticks.len() as f64 * self.h
    }

    /// Matrices of the ticks in order.
    pub(crate) fn matrices(&self) -> impl DoubleEndedIterator<Item = &DMatrix<f64>> {
        self.ticks.iter().map(|&kind| &self.kinds[kind].1.matrix)
    }

    /// What the entries of these matrices are sums of.
    pub(crate) fn magnitudes(&self) -> impl Iterator<Item = &DMatrix<f64>> {
        let of = |&kind: &usize| {
            let tick = &self.kinds[kind].1;
            tick.magnitude.as_ref().unwrap_or(&tick.matrix)
        };
        self.ticks.iter().map(of)
    }

    /// A state before the period and after each of its ticks.
    pub(crate) fn forward(&self, state: ComplexVector) -> Vec<ComplexVector> {
        let mut states = vec![state];
        for matrix in self.matrices() {
            let next = times(matrix, &states[states.len() - 1]);
            states.push(next);
        }
        states
    }

    /// What a row vector (here as a column) is before each tick and after the last: `y_j = A_jᵀ·y_{j+1}`.
    pub(crate) fn backward(&self, row: ComplexVector) -> Vec<ComplexVector> {
        let mut rows = vec![row];
        for matrix in self.matrices().rev() {
            let before = times(&matrix.transpose(), &rows[rows.len() - 1]);
            rows.push(before);
        }
        rows.reverse();
        rows
    }
}

fn times(matrix: &DMatrix<f64>, vector: &ComplexVector) -> ComplexVector {
    let mut product = ComplexVector::zeros(matrix.nrows());
    for (column, factor) in matrix.column_iter().zip(vector.iter()) {
        for (sum, entry) in product.iter_mut().zip(column.iter()) {
            *sum += factor * *entry;
        }
    }
    product
}
