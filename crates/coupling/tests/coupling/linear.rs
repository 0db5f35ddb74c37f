//! Linear blocks that are stepped exactly, and what they are together.
//!
//! ẋ = A·x + B·u, y = C·x + D·u. With u a parabola over the step, [x, u, u', u''] is one linear system, whose matrix exponential is a
//! Taylor series after halving the step until its norm is below 1/2 (20 terms: 0.5²⁰/20! < 1e-24).
use servobench_coupling::{Block, Connection, Input, InputPort, Member, Port, StepEnd, later, mean};
use std::convert::Infallible;
use std::num::NonZeroU32;

/// A square matrix by rows.
#[derive(Debug, Clone)]
pub(crate) struct Matrix {
    pub(crate) size: usize,
    pub(crate) rows: Vec<f64>,
}

impl Matrix {
    pub(crate) fn zeros(size: usize) -> Self {
        Self { size, rows: vec![0.0; size * size] }
    }

    pub(crate) fn at(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.rows[row * self.size + column]
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.size);
        for row in 0..self.size {
            for column in 0..self.size {
                *product.at(row, column) =
                    (0..self.size).map(|k| self.rows[row * self.size + k] * other.rows[k * self.size + column]).sum();
            }
        }
        product
    }

    pub(crate) fn apply(&self, x: &[f64], result: &mut [f64]) {
        for (row, y) in self.rows.chunks(self.size).zip(result) {
            *y = row.iter().zip(x).map(|(a, x)| a * x).sum();
        }
    }

    /// exp(self·t)
    pub(crate) fn exponential(&self, t: f64) -> Self {
        let norm = self.rows.chunks(self.size).map(|row| row.iter().map(|a| a.abs()).sum::<f64>()).fold(0.0, f64::max);
        let (mut halvings, mut scale) = (0, t);
        while norm * scale > 0.5 {
            (halvings, scale) = (halvings + 1, scale / 2.0);
        }
        let mut sum = Self::zeros(self.size);
        (0..self.size).for_each(|i| *sum.at(i, i) = 1.0);
        let mut term = sum.clone();
        for k in 1..=20 {
            term = term.times(self);
            term.rows.iter_mut().for_each(|a| *a *= scale / f64::from(k));
            sum.rows.iter_mut().zip(&term.rows).for_each(|(s, t)| *s += t);
        }
        for _ in 0..halvings {
            sum = sum.times(&sum);
        }
        sum
    }
}

/// Matrices of a block, each by its rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Model {
    pub(crate) a: Vec<Vec<f64>>,
    pub(crate) b: Vec<Vec<f64>>,
    pub(crate) c: Vec<Vec<f64>>,
    pub(crate) d: Vec<Vec<f64>>,
}

/// A block of the test.
#[derive(Debug, Clone)]
pub(crate) struct Linear {
    pub(crate) model: Model,
    pub(crate) x: Vec<f64>,
    /// Inputs at the end of the last step, as the block knows them.
    u: Vec<f64>,
    saved: Option<(Vec<f64>, Vec<f64>)>,
    /// How often it came back early, in steps that were repeated, too; evaluations of this step, and the most of any.
    pub(crate) events: u32,
    evaluations: u32,
    pub(crate) most_evaluations: u32,
    /// The transition over a step, for its length.
    transition: (f64, Matrix),
    /// Takes no derivatives: holds the mean.
    pub(crate) holds_mean: bool,
    pub(crate) can_save: bool,
    /// Comes back early at this time (s).
    pub(crate) event: Option<f64>,
    scratch: [Vec<f64>; 2],
}

impl Linear {
    pub(crate) fn new(model: Model, x: &[f64]) -> Self {
        let (n, m) = (x.len(), model.d.first().map_or(0, Vec::len));
        let size = n + 3 * m;
        let scratch = [vec![0.0; size], vec![0.0; size]];
        let transition = (0.0, Matrix::zeros(size));
        let (x, u) = (x.to_vec(), vec![0.0; m]);
        Self {
            model,
            x,
            u,
            saved: None,
            events: 0,
            evaluations: 0,
            most_evaluations: 0,
            transition,
            holds_mean: false,
            can_save: true,
            event: None,
            scratch,
        }
    }

    fn prepare(&mut self, length: f64) {
        if self.transition.0.to_bits() == length.to_bits() {
            return;
        }
        let (n, m) = (self.x.len(), self.u.len());
        let mut whole = Matrix::zeros(n + 3 * m);
        for row in 0..n {
            (0..n).for_each(|k| *whole.at(row, k) = self.model.a[row][k]);
            (0..m).for_each(|k| *whole.at(row, n + k) = self.model.b[row][k]);
        }
        (0..2 * m).for_each(|k| *whole.at(n + k, n + m + k) = 1.0);
        self.transition = (length, whole.exponential(length));
    }

    fn go(&mut self, length: f64, inputs: &[Input]) {
        self.prepare(length);
        let (n, m) = (self.x.len(), self.u.len());
        let [from, to] = &mut self.scratch;
        from[..n].copy_from_slice(&self.x);
        for (k, input) in inputs.iter().enumerate() {
            let input = if self.holds_mean { [mean(input, length), 0.0, 0.0] } else { *input };
            (from[n + k], from[n + m + k], from[n + 2 * m + k]) = (input[0], input[1], input[2]);
            self.u[k] = later(&input, length)[0];
        }
        self.transition.1.apply(from, to);
        self.x.copy_from_slice(&to[..n]);
    }
}

impl Block for Linear {
    type Error = Infallible;

    fn saves_state(&self) -> bool {
        self.can_save
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.model.d[output][input] != 0.0
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, Infallible> {
        if let Some(event) = self.event.filter(|event| *event > time && *event < time + length) {
            self.go(event - time, inputs);
            self.events += 1;
            return Ok(StepEnd::Until(event));
        }
        self.go(length, inputs);
        self.evaluations += 1;
        self.most_evaluations = self.most_evaluations.max(self.evaluations);
        Ok(StepEnd::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), Infallible> {
        let u = inputs.unwrap_or(&self.u);
        for ((y, c), d) in outputs.iter_mut().zip(&self.model.c).zip(&self.model.d) {
            *y = c.iter().zip(&self.x).map(|(c, x)| c * x).sum::<f64>()
                + d.iter().zip(u).map(|(d, u)| d * u).sum::<f64>();
        }
        Ok(())
    }

    fn save(&mut self) -> Result<(), Infallible> {
        let (x, u) = self.saved.get_or_insert_with(|| (self.x.clone(), self.u.clone()));
        x.copy_from_slice(&self.x);
        u.copy_from_slice(&self.u);
        self.evaluations = 0;
        Ok(())
    }

    fn restore(&mut self) -> Result<(), Infallible> {
        let (x, u) = self.saved.as_ref().unwrap();
        self.x.copy_from_slice(x);
        self.u.copy_from_slice(u);
        Ok(())
    }
}

/// A member with ports named `u0…` and `y0…`.
pub(crate) fn member<B: Block>(name: &str, block: B, inputs: usize, outputs: usize) -> Member<B> {
    Member {
        name: name.into(),
        inputs: (0..inputs).map(|i| InputPort { name: format!("u{i}"), held: 0.0 }).collect(),
        outputs: (0..outputs).map(|i| format!("y{i}")).collect(),
        every: NonZeroU32::MIN,
        block,
    }
}

/// A connection as it is.
pub(crate) fn connect(from: (usize, usize), to: (usize, usize)) -> Connection {
    let port = |(block, port)| Port { block, port };
    Connection { from: port(from), to: port(to), gain: 1.0, offset: 0.0, is_discrete: false }
}
