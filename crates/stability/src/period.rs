//! The common period of all loops: the matrices of its ticks, their product, and the propagation of vectors through it.
//!
//! The product begins after the tick at which all loops are due: there every signal of a
//! controller is fresh, so that a loop appears in it as a ring through a controller's state (`structure`).
use crate::equations::{Equations, Order};
use crate::error::StabilityError;
use nalgebra::{Complex, DMatrix, DVector};
use servobench_linear::{Pattern, TickMatrix};
use std::rc::Rc;

/// Largest entry of a product whose columns can still be squared and summed.
pub(crate) const LARGEST: f64 = 1e150;

pub(crate) type ComplexVector = DVector<Complex<f64>>;

/// The ticks of a common period.
pub(crate) struct Period {
    /// The matrix of a tick of each level.
    kinds: Vec<TickMatrix>,
    /// Index into `kinds` of each tick of the period; the tick at which all loops are due is the last.
    ticks: Vec<usize>,
    /// The product of all tick matrices.
    pub(crate) monodromy: DMatrix<f64>,
    /// States of each loop.
    pub(crate) loops: Rc<Vec<Vec<usize>>>,
    /// Length of a tick (s).
    pub(crate) h: f64,
}

/// `matrix` to the power of `exponent`; `None` for the exponent 0.
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

/// The product over a period, of values given for each kind of tick.
fn product<T: Clone>(of: impl Fn(usize) -> T, order: &Order, after: impl Fn(&T, &T) -> T + Copy) -> T {
    let Order { every, ends } = order;
    // Over a cycle, by the kind of its last tick: as many cycles of the task below, all but the last of which end with a tick of that task.
    let mut below: Vec<T> = (1..every.len()).map(|kind| of(kind - 1)).collect();
    let mut ends: Vec<T> = ends.iter().map(|&kind| of(kind)).collect();
    for level in 1..every.len() {
        if let Some(before) = power(&below[level - 1], every[level] / every[level - 1] - 1, after) {
            for last in below[level..].iter_mut().chain(&mut ends) {
                *last = after(last, &before);
            }
        }
    }
    let all = ends.into_iter().reduce(|before, last| after(&last, &before));
    all.unwrap_or_else(|| of(0))
}

impl Period {
    /// The period of the loops that `equations` close.
    ///
    /// # Errors
    /// [`StabilityError`] if the loop does not run, [`StabilityError::Overflow`] if the product overflows.
    pub(crate) fn new(equations: &mut Equations) -> Result<Self, StabilityError> {
        let order = equations.order();
        let used = order.ends.iter().max().map_or(0, |last| last + 1);
        let kinds: Vec<TickMatrix> = (0..used).map(|kind| equations.matrix(kind)).collect::<Result<_, _>>()?;
        let ticks = order.ticks();
        let monodromy = product(|kind| kinds[kind].matrix.clone(), &order, |last, first| last * first);
        // NaN is caught, too.
        if !monodromy.iter().all(|entry| entry.abs() < LARGEST) {
            return Err(StabilityError::Overflow { ticks: ticks.len() });
        }
        let loops = equations.known_loops().unwrap_or_else(|| {
            let pattern = |kind: usize| Pattern::of(&kinds[kind].matrix);
            Rc::new(product(pattern, &order, Pattern::after).loops(&equations.controllers()))
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
        self.ticks.iter().map(|&kind| &self.kinds[kind].matrix)
    }

    /// Magnitudes of the terms whose sums are the entries of these matrices.
    pub(crate) fn magnitudes(&self) -> impl Iterator<Item = &DMatrix<f64>> {
        let of = |&kind: &usize| {
            let tick = &self.kinds[kind];
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

    /// The row vector `row` (here as a column) before each tick and after the last: `y_j = A_jᵀ·y_{j+1}`.
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
