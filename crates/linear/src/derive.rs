//! Matrices of the kinds of ticks of a running loop.
use crate::{CONTROLLERS, Factors, LinearError, MECHANICS, Pattern, Running};
use nalgebra::DMatrix;
use servobench_base::state::{Form, Number, Part, Reader, Writer, words};
use std::collections::HashMap;

/// Exponent of two of the deviation of a number that is zero at rest: its square underflows, and the deviation scaled by 1e6 or
/// its inverse does not.
const SMALL: i32 = -600;
/// Relative remainder of terms of a sum that cancel: roundings of some ten numbers.
const MEETS: f64 = 4096.0 * f64::EPSILON;
/// Most places tried.
const PLACES: u32 = 64;
/// Largest relative change of a number at rest in a tick: roundings of a sum of some ten numbers.
const REST: f64 = 64.0 * f64::EPSILON;

/// The loop at rest before and after a tick of a kind.
struct Kind {
    words: Vec<u64>,
    before: Vec<f64>,
    after: Vec<f64>,
}

/// Matrix of a tick.
#[derive(Debug, Clone, PartialEq)]
pub struct TickMatrix {
    /// A.
    pub matrix: DMatrix<f64>,
    /// Magnitudes of the sums that the entries are, to which their roundings are proportional; `None` if equal to the entries.
    pub magnitude: Option<DMatrix<f64>>,
}

/// A tick with inputs and outputs: x(k+1) = A·x(k) + B·u(k), y(k+1) = C·x(k) + D·u(k).
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// A.
    pub a: DMatrix<f64>,
    /// B.
    pub b: DMatrix<f64>,
    /// C.
    pub c: DMatrix<f64>,
    /// D.
    pub d: DMatrix<f64>,
}

/// A running loop, with the matrices of its ticks derived so far.
pub struct Matrices<'a> {
    running: Box<dyn Running + 'a>,
    numbers: Vec<Number>,
    kinds: Vec<Kind>,
    /// Difference of every number between rest at another place and rest here; the same per position there; and the number from which
    /// positions are measured.
    elsewhere: Vec<f64>,
    place: Vec<f64>,
    origin: Option<usize>,
    /// True if controllers hold a value that is not zero at rest.
    is_operated: bool,
    /// Indices of the numbers that are states.
    states: Vec<usize>,
    /// Derived matrices, by their kind and the bits of their factors.
    known: HashMap<(usize, u8), DMatrix<f64>>,
    scratch: (Vec<u64>, Vec<f64>),
}

/// Deviation of a number that is zero at rest.
fn small() -> f64 {
    f64::from(SMALL).exp2()
}

fn values(running: &mut dyn Running) -> Result<Vec<f64>, LinearError> {
    let mut values = Vec::new();
    running.save(&mut Values(&mut values))?;
    Ok(values)
}

impl<'a> Matrices<'a> {
    /// The matrices of `running`, whose first tick is number 0; the tick of kind i is number `ticks[i]`, each larger than 0.
    ///
    /// # Errors
    /// [`LinearError`] if it does not run, or does not stay at rest.
    pub fn new(mut running: Box<dyn Running + 'a>, ticks: &[u32]) -> Result<Self, LinearError> {
        let last = ticks.iter().copied().max().unwrap_or(0);
        running.set(&Factors { position: 0.0, ..Factors::ONE });
        running.place(0.0)?;
        running.tick()?;
        let mut form = Form::default();
        running.save(&mut form)?;
        let numbers = form.numbers;
        let elsewhere = elsewhere(running.as_mut(), &numbers, last)?;
        running.set(&Factors::ONE);
        running.place(0.0)?;
        running.tick()?;
        let mut kinds: Vec<Option<Kind>> = ticks.iter().map(|_| None).collect();
        for number in 1..=last {
            let mut saved = Vec::new();
            running.save(&mut words(|word| saved.push(word)))?;
            let before = values(running.as_mut())?;
            running.tick()?;
            for (kind, _) in kinds.iter_mut().zip(ticks).filter(|(_, tick)| **tick == number) {
                *kind = Some(Kind { words: saved.clone(), before: before.clone(), after: values(running.as_mut())? });
            }
        }
        let kinds: Vec<Kind> = kinds.into_iter().flatten().collect();
        let is_position = |number: &Number| number.name.starts_with(MECHANICS) && !number.is_derived;
        let origin = numbers.iter().zip(&elsewhere).position(|(number, there)| is_position(number) && *there != 0.0);
        let position = origin.map_or(1.0, |origin| elsewhere[origin]);
        let place = elsewhere.iter().map(|there| there / position).collect();
        let is_held = |(number, value): (&Number, &f64)| number.name.starts_with(CONTROLLERS) && *value != 0.0;
        let is_operated = kinds.first().is_some_and(|kind| numbers.iter().zip(&kind.before).any(is_held));
        let (states, known, scratch) = (Vec::new(), HashMap::new(), (Vec::new(), Vec::new()));
        let mut matrices =
            Self { running, numbers, kinds, elsewhere, place, origin, is_operated, states, known, scratch };
        matrices.find_states()?;
        Ok(matrices)
    }

    /// Names of the states.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.states.iter().map(|&number| self.numbers[number].name.as_str())
    }

    /// Number of states.
    #[must_use]
    pub const fn size(&self) -> usize {
        self.states.len()
    }

    /// Finds the states: numbers on a ring that are reached, directly or not, from numbers outside of the controllers.
    fn find_states(&mut self) -> Result<(), LinearError> {
        let count = self.numbers.len();
        let is_start = |number: &Number| !number.name.starts_with(CONTROLLERS) && !number.is_derived;
        let mut reached: Vec<usize> = (0..count).filter(|&number| is_start(&self.numbers[number])).collect();
        let mut is_reached: Vec<bool> = (0..count).map(|number| is_start(&self.numbers[number])).collect();
        let mut columns: Vec<Vec<Vec<f64>>> = self.kinds.iter().map(|_| Vec::new()).collect();
        let mut next = 0;
        while next < reached.len() {
            let number = reached[next];
            next += 1;
            for (kind, columns) in columns.iter_mut().enumerate() {
                let column = self.column(kind, number)?;
                for (row, _) in column.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                    if !is_reached[row] && !self.numbers[row].is_derived {
                        is_reached[row] = true;
                        reached.push(row);
                    }
                }
                columns.push(column);
            }
        }
        let acts = |j: usize, i: usize| columns.iter().any(|columns| columns[j][reached[i]] != 0.0);
        let components = Pattern::with_rows(reached.len(), acts).components();
        let mut states: Vec<usize> = components.into_iter().filter(|one| one.len() > 1).flatten().collect();
        states.sort_by_key(|&index| reached[index]);
        for (kind, columns) in columns.iter().enumerate() {
            let of = |i: usize, j: usize| columns[states[j]][reached[states[i]]];
            let matrix = DMatrix::from_fn(states.len(), states.len(), of);
            self.known.insert((kind, Factors::ONE.bits()), matrix);
        }
        self.states = states.into_iter().map(|index| reached[index]).collect();
        let moves = |kind: &Kind, state: usize| {
            let (before, after) = (kind.before[state], kind.after[state]);
            (after - before).abs() > REST * before.abs()
        };
        match self.states.iter().find(|&&state| self.kinds.iter().any(|kind| moves(kind, state))) {
            Some(&state) => Err(LinearError::NotAtRest(self.numbers[state].name.clone())),
            None => Ok(()),
        }
    }

    /// Differences of all numbers after a tick of a kind, per difference of `number` before it.
    fn column(&mut self, kind: usize, number: usize) -> Result<Vec<f64>, LinearError> {
        let mut column = self.moved(kind, number)?;
        if self.origin == Some(number) && self.is_operated {
            // Terms of the place that are rotated with it cancel except for roundings: the remainder of their sum is zero.
            let mut sums = vec![0.0; column.len()];
            let shares = self.place.clone();
            for (other, share) in shares.iter().enumerate().filter(|(other, share)| *other != number && **share != 0.0)
            {
                for (sum, entry) in sums.iter_mut().zip(self.moved(kind, other)?) {
                    *sum += (share * entry).abs();
                }
            }
            for (row, (entry, sum)) in column.iter_mut().zip(sums).enumerate() {
                if row != number && entry.abs() <= MEETS * sum {
                    *entry = 0.0;
                }
            }
        }
        Ok(column)
    }

    fn moved(&mut self, kind: usize, number: usize) -> Result<Vec<f64>, LinearError> {
        let Self { running, numbers, kinds, elsewhere, place, origin, scratch: (moved, after), .. } = self;
        let of = &kinds[kind];
        moved.clone_from(&of.words);
        let mut put = |number: usize, value: f64| moved[numbers[number].word] = value.to_bits();
        let at_rest = of.before[number];
        let mut size = if at_rest == 0.0 { small() } else { at_rest.abs().log2().ceil().exp2() };
        if *origin == Some(number) {
            size = elsewhere[number];
            for (other, there) in elsewhere.iter().enumerate().filter(|(_, there)| **there != 0.0) {
                put(other, of.before[other] + there);
            }
        } else {
            let moved_to = at_rest + size;
            size = moved_to - at_rest;
            put(number, moved_to);
        }
        let mut from = Reader::moved(moved);
        running.restore(&mut from)?;
        from.end()?;
        running.tick()?;
        after.clear();
        running.save(&mut Values(after))?;
        let mut column: Vec<f64> =
            after.iter().zip(&of.after).map(|(other, at_rest)| by(*other, *at_rest, size)).collect();
        // All places are measured from the origin.
        if let Some(travel) = origin.map(|origin| column[origin]).filter(|travel| *travel != 0.0) {
            for (other, (entry, share)) in column.iter_mut().zip(place.iter()).enumerate() {
                if *share != 0.0 && *origin != Some(other) {
                    *entry -= share * travel;
                }
            }
        }
        Ok(column)
    }

    /// The matrix of a tick of this kind with these gains.
    ///
    /// # Errors
    /// [`LinearError`] if it does not run.
    pub fn matrix(&mut self, kind: usize, factors: &Factors) -> Result<TickMatrix, LinearError> {
        let corners = factors.corners();
        for (corner, _) in &corners {
            self.derive(kind, corner)?;
        }
        let of = |corner: &Factors| &self.known[&(kind, corner.bits())];
        if let [(corner, _)] = &corners[..] {
            return Ok(TickMatrix { matrix: of(corner).clone(), magnitude: None });
        }
        let size = self.states.len();
        let mut sum = TickMatrix { matrix: DMatrix::zeros(size, size), magnitude: Some(DMatrix::zeros(size, size)) };
        let first = of(&corners[0].0);
        for (corner, share) in &corners {
            let matrix = of(corner);
            // Entries on which no gain acts stay unchanged, to the bit.
            sum.matrix.zip_zip_apply(matrix, first, |entry, corner, first| *entry += share * (corner - first));
            if let Some(magnitude) = &mut sum.magnitude {
                magnitude.zip_zip_apply(matrix, first, |entry, corner, first| {
                    let differ = corner.to_bits() != first.to_bits();
                    *entry += if differ { share.abs() * (corner.abs() + first.abs()) } else { 0.0 };
                });
            }
        }
        sum.matrix += first;
        if let Some(magnitude) = &mut sum.magnitude {
            magnitude.zip_apply(first, |entry, first| *entry += first.abs());
        }
        Ok(sum)
    }

    /// A tick of this kind with unchanged gains, from states and `inputs` to states and `outputs`: numbers by their names, the first
    /// of several with one name. A number that a tick sets before it reads it is not an input.
    ///
    /// # Errors
    /// [`LinearError`] if it does not run, or has no such number.
    pub fn system(&mut self, kind: usize, inputs: &[&str], outputs: &[&str]) -> Result<System, LinearError> {
        let index = |name: &&str| {
            let found = self.numbers.iter().position(|number| number.name == **name);
            found.ok_or_else(|| LinearError::NoSuchNumber((*name).to_owned()))
        };
        let with = |names: &[&str]| names.iter().map(index).collect::<Result<Vec<_>, _>>();
        let (inputs, outputs) = (with(inputs)?, with(outputs)?);
        let states = self.states.clone();
        self.at_rest(kind, &Factors::ONE)?;
        let mut block = |rows: &[usize], columns: &[usize]| self.block(kind, rows, columns);
        let (a, b) = (block(&states, &states)?, block(&states, &inputs)?);
        Ok(System { a, b, c: block(&outputs, &states)?, d: block(&outputs, &inputs)? })
    }

    fn derive(&mut self, kind: usize, corner: &Factors) -> Result<(), LinearError> {
        let key = (kind, corner.bits());
        if !self.known.contains_key(&key) {
            self.at_rest(kind, corner)?;
            let states = self.states.clone();
            let matrix = self.block(kind, &states, &states)?;
            self.known.insert(key, matrix);
        }
        Ok(())
    }

    /// Sets these gains, with which the loop at rest may differ by roundings.
    fn at_rest(&mut self, kind: usize, factors: &Factors) -> Result<(), LinearError> {
        self.running.set(factors);
        let of = &mut self.kinds[kind];
        self.running.restore(&mut Reader::new(&of.words))?;
        self.running.tick()?;
        of.after = values(self.running.as_mut())?;
        Ok(())
    }

    /// Differences of the numbers `rows` after a tick, per difference of the numbers `columns` before it.
    fn block(&mut self, kind: usize, rows: &[usize], columns: &[usize]) -> Result<DMatrix<f64>, LinearError> {
        let mut block = DMatrix::zeros(rows.len(), columns.len());
        for (index, &number) in columns.iter().enumerate() {
            let column = self.column(kind, number)?;
            for (entry, &row) in block.column_mut(index).iter_mut().zip(rows) {
                *entry = column[row];
            }
        }
        Ok(block)
    }
}

/// Difference of every number between a place at which the bodies stay to the bit and the place 0; if a position is multiplied from tick
/// to tick, not all places are suitable. Numbers that keep changing there, such as an integral, do not belong to the place.
fn elsewhere(running: &mut dyn Running, numbers: &[Number], last: u32) -> Result<Vec<f64>, LinearError> {
    let mut at = |position: f64| {
        running.place(position)?;
        // The period is over when everything held by a task has its value at rest.
        (0..=last).try_for_each(|_| running.tick())?;
        let first = values(running)?;
        (0..last).try_for_each(|_| running.tick())?;
        Ok::<_, LinearError>((first, values(running)?))
    };
    let (here, _) = at(0.0)?;
    let mut found = vec![0.0; numbers.len()];
    for place in 0..PLACES {
        let (there, later) = at(small() * (1.0 + f64::from(place) / f64::from(PLACES)))?;
        let all = || there.iter().zip(&later);
        found = all()
            .zip(&here)
            .map(
                |((there, later), here)| {
                    if (there - later).abs() <= REST * there.abs() { by(*there, *here, 1.0) } else { 0.0 }
                },
            )
            .collect();
        if all()
            .zip(numbers)
            .all(|((there, later), number)| is_same(*there, *later) || !number.name.starts_with(MECHANICS))
        {
            break;
        }
    }
    Ok(found)
}

const fn is_same(one: f64, other: f64) -> bool {
    one.to_bits() == other.to_bits()
}

/// The difference of two numbers, by `size`; zero for equal numbers, even if they are not finite.
fn by(other: f64, at_rest: f64, size: f64) -> f64 {
    if is_same(other, at_rest) { 0.0 } else { (other - at_rest) / size }
}

/// Writer of the numbers alone.
struct Values<'a>(&'a mut Vec<f64>);

impl Writer for Values<'_> {
    fn number(&mut self, value: f64) {
        self.0.push(value);
    }

    fn word(&mut self, _: u64) {}

    fn enter(&mut self, _: Part) {}

    fn leave(&mut self) {}
}

#[cfg(test)]
mod tests;
