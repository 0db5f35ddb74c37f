//! Linear mechanics around rest, from differences of the steps of any engine that saves its state.
//!
//! ```text
//! y(k+1) = A·y(k) + B·u(k)         y: deviations of the saved numbers, u: deviation of the motor's effort
//! A·e_j = (4·D(δ/2) − D(δ))/3      D(δ) = (F(z + δ·e_j) − F(z − δ·e_j))/(2·δ), F a step of the engine
//! ```
//! **Rest.** Newton's method solves F(z, u) = z at the motor's position: u is the effort that holds the axis, for example against gravity.
//!
//! **Rigid motion.** Where the axis can rest at any position, (A − 1)·w = 0. All other numbers are then relative to the motor's position
//! times w, so that nothing depends on that position, exactly.
//!
//! The difference between D(δ/2) and D(δ) measures the nonlinearity. Entries below it are set to zero.
use crate::mechanics::{Actuation, BodyState, Input, Mechanics, MechanicsError};
use nalgebra::{Complex, DMatrix, DVector};
use serde::{Deserialize, Serialize};
use servobench_base::state::{Damaged, Form, Part, Reader, Stateful, Writer, words};
use std::f64::consts::TAU;
use thiserror::Error;

/// δ (m, rad or per second). Relative to a lever of 10 cm its fourth power is 1e-12, as is the rounding of 1 m relative to δ.
const SIZE: f64 = 1.0 / 8192.0;
/// Relative rounding error of a step.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;
/// Largest residual of a solved equation, relative to its terms.
const LEFT: f64 = 1e-6;
/// Largest change within a tick at rest, relative to a number or to δ.
const AT_REST: f64 = 1e-9;
/// Largest relative nonlinearity.
const SMOOTH: f64 = 1e-4;
/// Singular values below this share of the largest one count as zero.
const SINGULAR: f64 = 1e-11;
/// Largest number of saved numbers: 48 joints take two seconds.
const MOST: usize = 256;
/// Iterations of Newton's method: each doubles the number of digits.
const NEWTON: u32 = 8;
/// Frequency at which all bodies move as one (Hz).
const SLOW: f64 = 0.1;

/// Linear mechanics around rest, as plain numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LinearMechanics {
    /// Rows of A and, at the end of each, B; the first number is the position of the motor.
    step: Vec<Vec<f64>>,
    /// Rows of the positions and velocities of the bodies.
    bodies: Vec<Vec<f64>>,
    /// Number that is the velocity of the motor.
    velocity: usize,
    inertia: f64,
    is_free: bool,
    bend: f64,
}

/// Linear mechanics in a loop.
struct Running {
    of: LinearMechanics,
    /// The numbers and, at the end, the effort.
    state: Vec<f64>,
    next: Vec<f64>,
    bodies: Vec<BodyState>,
}

/// Why mechanics have no linear model.
#[derive(Debug, Error)]
pub enum NotLinear {
    /// The engine fails, or cannot save a state.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// Its state is too large for an analysis within a few seconds.
    #[error("its state has {0} numbers, more than {MOST}: remove joints that the axis does not move")]
    TooLarge(usize),
    /// No effort of the motor holds it at rest.
    #[error("no effort of the motor holds the axis at rest where the scenario begins")]
    NotAtRest,
    /// Its response is not proportional to small deviations.
    #[error(
        "around rest it is not linear: half the deviation changes the response by a share of {0:.1e}, more than {SMOOTH:.0e}"
    )]
    NotSmooth(f64),
}

/// Derivatives by every number and the effort, and the differences between the two step sizes.
struct Differences {
    columns: DMatrix<f64>,
    errors: DMatrix<f64>,
}

/// An engine whose state is set number by number.
struct Moved<'a> {
    mechanics: &'a mut dyn Mechanics,
    words: Vec<u64>,
    /// Indices of the words that are varied.
    places: Vec<usize>,
}

impl Moved<'_> {
    /// Numbers at the present tick.
    fn numbers(&mut self) -> Result<Vec<f64>, MechanicsError> {
        let mut saved = Vec::with_capacity(self.words.len());
        self.mechanics.save(&mut words(|word| saved.push(word)))?;
        Ok(self.places.iter().map(|&place| f64::from_bits(saved[place])).collect())
    }

    fn put(&mut self, numbers: &[f64]) -> Result<(), MechanicsError> {
        for (place, number) in self.places.iter().zip(numbers) {
            self.words[*place] = number.to_bits();
        }
        self.mechanics.restore(&mut Reader::moved(&self.words))
    }

    /// Numbers one tick after `from`, whose last entry is the effort.
    fn step(&mut self, from: &[f64]) -> Result<Vec<f64>, MechanicsError> {
        self.put(from)?;
        self.mechanics.advance(&only(from[self.places.len()]))?;
        self.numbers()
    }

    /// Positions and velocities of the bodies.
    fn bodies(&mut self, at: &[f64]) -> Result<Vec<f64>, MechanicsError> {
        self.put(at)?;
        Ok(self.mechanics.bodies().iter().flat_map(|body| [body.position, body.velocity]).collect())
    }
}

impl Differences {
    fn of(at: &[f64], mut of: impl FnMut(&[f64]) -> Result<Vec<f64>, MechanicsError>) -> Result<Self, MechanicsError> {
        let here = of(at)?;
        let mut columns = DMatrix::zeros(here.len(), at.len());
        let mut errors = columns.clone();
        let mut moved = at.to_vec();
        for j in 0..at.len() {
            let mut by = |size: f64| {
                moved[j] = at[j] + size;
                let (up, above) = (moved[j], of(&moved)?);
                moved[j] = at[j] - size;
                let (down, below) = (moved[j], of(&moved)?);
                moved[j] = at[j];
                let slope = |(above, below): (&f64, &f64)| (above - below) / (up - down);
                Ok::<_, MechanicsError>(above.iter().zip(&below).map(slope).collect::<Vec<_>>())
            };
            let (whole, half) = (by(SIZE)?, by(SIZE / 2.0)?);
            for (i, (whole, half)) in whole.iter().zip(&half).enumerate() {
                let (found, error) = ((4.0 * half - whole) / 3.0, (half - whole).abs());
                let rounding = ROUNDINGS * here[i].abs() / SIZE;
                columns[(i, j)] = if found.abs() > 4.0 * error + rounding { found } else { 0.0 };
                errors[(i, j)] = error;
            }
        }
        Ok(Self { columns, errors })
    }

    /// Relative nonlinearity: the largest difference between the two step sizes, relative to the largest entry of its row. NaN if any is.
    fn bend(&self) -> f64 {
        let rows = self.columns.row_iter().zip(self.errors.row_iter());
        let shares = rows.flat_map(|(row, errors)| {
            let largest = row.amax();
            errors.iter().map(|error| if largest > 0.0 { error / largest } else { error * 0.0 }).collect::<Vec<_>>()
        });
        shares.fold(0.0, |most, share| if share > most || share.is_nan() { share } else { most })
    }

    /// Swaps numbers 0 and `other`.
    fn swap(&mut self, other: usize) {
        for matrix in [&mut self.columns, &mut self.errors] {
            matrix.swap_rows(0, other);
            matrix.swap_columns(0, other);
        }
    }

    /// Makes all numbers but the first relative to it: `others` is the rigid motion per motion of the first.
    fn tell_from_the_motor(&mut self, others: &DVector<f64>) {
        for (i, share) in (1..).zip(others.iter()).filter(|(_, share)| share.abs() >= LEFT) {
            for j in 1..self.columns.ncols() {
                let (own, of_motor) = (self.columns[(i, j)], share * self.columns[(0, j)]);
                let error = self.errors[(i, j)] + (share * self.errors[(0, j)]).abs();
                let told = own - of_motor;
                let is_left = told.abs() > 4.0 * error + ROUNDINGS * (own.abs() + of_motor.abs());
                self.columns[(i, j)] = if is_left { told } else { 0.0 };
            }
        }
        self.columns.column_mut(0).fill(0.0);
        self.columns[(0, 0)] = 1.0;
    }
}

/// The shortest x that minimises |M·x − b|.
fn shortest(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    // Columns scaled to unit length, since their units differ.
    let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    let inverse = |length: &f64| if *length > 0.0 { 1.0 / length } else { 0.0 };
    let scales = DVector::from_iterator(lengths.len(), lengths.iter().map(inverse));
    let found = (matrix * DMatrix::from_diagonal(&scales)).svd(true, true);
    Some(found.solve(right, SINGULAR * found.singular_values.amax()).ok()?.component_mul(&scales))
}

/// The same if M·x = b within the error of the differences.
fn solved(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let x = shortest(matrix, right)?;
    let (left, parts) = (matrix * &x - right, matrix.abs() * x.abs() + right.abs());
    let rounding = ROUNDINGS * parts.amax();
    left.iter().zip(parts.iter()).all(|(left, parts)| left.abs() <= LEFT * parts + rounding).then_some(x)
}

impl LinearMechanics {
    /// Linear model of `mechanics`, driven by efforts in ticks of `h` (s), around rest at the motor's present position.
    ///
    /// # Errors
    /// [`NotLinear`].
    pub fn around_rest(mechanics: &mut dyn Mechanics, h: f64) -> Result<Self, NotLinear> {
        // The first tick of an engine may differ from all others.
        mechanics.advance(&only(0.0))?;
        let (mut form, mut saved) = (Form::default(), Vec::new());
        mechanics.save(&mut form)?;
        mechanics.save(&mut words(|word| saved.push(word)))?;
        let places = form.numbers.iter().filter(|number| !number.is_derived).map(|number| number.word).collect();
        let mut moved = Moved { mechanics, words: saved, places };
        let mut at = moved.numbers()?;
        let size = at.len();
        if size > MOST {
            return Err(NotLinear::TooLarge(size));
        }
        let motor = largest(&Differences::of(&at, |at| moved.bodies(at))?.columns, 0, 0);
        at.push(0.0);
        let mut step = rest(&mut moved, &mut at, motor)?;
        let bend = step.bend();
        if bend > SMOOTH || bend.is_nan() {
            return Err(NotLinear::NotSmooth(bend));
        }
        // The motor's position comes first.
        let mut bodies = Differences::of(&at[..size], |at| moved.bodies(at))?;
        step.swap(motor);
        bodies.columns.swap_columns(0, motor);
        let still = still(&step);
        let elsewhere = solved(&still.columns(1, size - 1).into_owned(), &-still.column(0));
        if let Some(others) = &elsewhere {
            step.tell_from_the_motor(others);
            let at_the_motor = bodies.columns.column(0) + bodies.columns.columns(1, size - 1) * others;
            bodies.columns.set_column(0, &at_the_motor.map(|share| if share.abs() < LEFT { 0.0 } else { share }));
        }
        let still = self::still(&step);
        let (effort, velocities) = (step.columns.column(size).into_owned(), bodies.columns.row(1).transpose());
        let mut glides = DVector::zeros(size);
        glides[0] = h;
        let rows = |matrix: &DMatrix<f64>| matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        Ok(Self {
            step: rows(&step.columns),
            bodies: rows(&bodies.columns),
            velocity: largest(&bodies.columns, 1, 1),
            inertia: inertia(&still, &effort, &velocities, h, elsewhere.is_some()),
            is_free: elsewhere.is_some() && solved(&still, &glides).is_some(),
            bend,
        })
    }

    /// At rest.
    #[must_use]
    pub fn at_rest(&self) -> Box<dyn Mechanics> {
        let (size, bodies) = (self.step.len(), vec![BodyState::default(); self.bodies.len() / 2]);
        Box::new(Running { of: self.clone(), state: vec![0.0; size + 1], next: vec![0.0; size + 1], bodies })
    }

    /// Inertia of everything that moves with the motor (motor coordinate); without a rigid motion the inertia of an immediate response.
    #[must_use]
    pub const fn inertia(&self) -> f64 {
        self.inertia
    }

    /// True without viscous friction: a constant velocity persists.
    #[must_use]
    pub const fn is_free(&self) -> bool {
        self.is_free
    }

    /// Relative error of the entries: the square of the relative nonlinearity, which is the next order in δ².
    #[must_use]
    pub const fn uncertainty(&self) -> f64 {
        self.bend * self.bend
    }
}

const fn only(effort: f64) -> Input {
    Input { actuation: Actuation::Effort(effort), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

/// Column of the largest entry of a row, from column `first` on.
fn largest(matrix: &DMatrix<f64>, row: usize, first: usize) -> usize {
    let magnitude = |column: usize| matrix[(row, column)].abs();
    (first..matrix.ncols()).max_by(|a, b| magnitude(*a).total_cmp(&magnitude(*b))).unwrap_or(first)
}

/// A − 1.
fn still(step: &Differences) -> DMatrix<f64> {
    let size = step.columns.nrows();
    step.columns.columns(0, size) - DMatrix::identity(size, size)
}

/// Brings `at`, numbers and effort, to rest at the position of the motor (number `motor`); returns the derivatives there.
fn rest(moved: &mut Moved<'_>, at: &mut [f64], motor: usize) -> Result<Differences, NotLinear> {
    let size = at.len() - 1;
    for number in 0..NEWTON {
        // Without an equilibrium the iteration can leave the range of the engine.
        let failed = |error| if number == 0 { NotLinear::Mechanics(error) } else { NotLinear::NotAtRest };
        let after = moved.step(at).map_err(failed)?;
        let found = Differences::of(at, |at| moved.step(at)).map_err(failed)?;
        let change = DVector::from_iterator(size, at.iter().zip(&after).map(|(before, after)| before - after));
        let is_at_rest = |(change, number): (&f64, &f64)| change.abs() <= AT_REST * (number.abs() + SIZE);
        if change.iter().zip(at.iter()).all(is_at_rest) {
            return Ok(found);
        }
        let mut with_effort = found.columns;
        (0..size).for_each(|i| with_effort[(i, i)] -= 1.0);
        with_effort.column_mut(motor).fill(0.0);
        let way = shortest(&with_effort, &change).ok_or(NotLinear::NotAtRest)?;
        at.iter_mut().zip(way.iter()).for_each(|(number, way)| *number += way);
    }
    Err(NotLinear::NotAtRest)
}

/// Inertia J (N·s²/m or N·m·s²/rad) from the frequency response G of the velocity at a low frequency: 1/G = d + i·ω·J.
fn inertia(still: &DMatrix<f64>, effort: &DVector<f64>, velocities: &DVector<f64>, h: f64, is_loose: bool) -> f64 {
    // Nothing depends on the position.
    let (first, size) = (usize::from(is_loose), effort.len() - usize::from(is_loose));
    let complex = |part: DVector<f64>| part.rows(first, size).map(|entry| Complex::new(entry, 0.0));
    let turn = Complex::from_polar(1.0, TAU * SLOW * h) - 1.0;
    let matrix = DMatrix::from_diagonal_element(size, size, turn)
        - still.view((first, first), (size, size)).map(|entry| Complex::new(entry, 0.0));
    let answer = matrix.lu().solve(&complex(effort.clone()));
    let slow = answer.map(|answer| complex(velocities.clone()).dot(&answer).inv().im / (TAU * SLOW));
    slow.filter(|_| is_loose).unwrap_or_else(|| h / velocities.dot(effort))
}

impl Running {
    fn publish(&mut self) {
        let of = |row: &Vec<f64>| row.iter().zip(&self.state).map(|(share, number)| share * number).sum();
        for (body, rows) in self.bodies.iter_mut().zip(self.of.bodies.chunks(2)) {
            *body = BodyState { position: of(&rows[0]), velocity: of(&rows[1]) };
        }
    }
}

impl Mechanics for Running {
    fn bodies(&self) -> &[BodyState] {
        &self.bodies
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        let Self { of, state, next, .. } = self;
        if let (Actuation::Effort(effort), Some(last)) = (input.actuation, state.last_mut()) {
            *last = effort;
        }
        for (next, row) in next.iter_mut().zip(&of.step) {
            *next = row.iter().zip(&*state).map(|(share, number)| share * number).sum();
        }
        std::mem::swap(state, next);
        self.publish();
        Ok(())
    }

    fn state(&mut self) -> Option<&mut dyn Stateful> {
        Some(self)
    }

    fn restored(&mut self) -> Result<(), MechanicsError> {
        self.publish();
        Ok(())
    }
}

impl Stateful for Running {
    fn save(&self, to: &mut dyn Writer) {
        for (index, number) in self.state[..self.of.step.len()].iter().enumerate() {
            let name = match index {
                0 => "position",
                index if index == self.of.velocity => "velocity",
                _ => "other",
            };
            to.enter(Part::field(name));
            to.number(*number);
            to.leave();
        }
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged> {
        self.state[..self.of.step.len()].iter_mut().try_for_each(|number| number.restore(from))
    }
}
