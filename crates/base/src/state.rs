//! States as numbers: all values that a part of the loop carries from tick to tick, saved, restored and named.
//!
//! A state is declared once. `#[derive(Stateful)]` saves every field, so that a new field cannot be forgotten; any other treatment of a
//! field is marked:
//!
//! | mark | field |
//! |---|---|
//! | `#[state(constant)]` | a parameter: equal in all states of a run |
//! | `#[state(derived)]` | computed from the rest of the state; saved, but changing it alone has no meaning |
//! | `#[state(recomputed)]` | not saved: computed from the rest after a restore, or in each tick before it is read |
//! | `#[state(fixed)]` | an option or a list that contains parameters, which determine its form |
//!
//! A type without parameters is a [`Value`], which an option or a list can create anew. A type whose fields contain parameters, or an
//! enum that contains parameters, is itself marked `#[state(fixed)]`.
//!
//! ```
//! use servobench_base::state::{Stateful, restore, words};
//!
//! #[derive(Clone, Debug, PartialEq, Stateful)]
//! struct Integrator {
//!     #[state(constant)]
//!     gain: f64,
//!     integral: f64,
//!     is_held: bool,
//! }
//!
//! let integrator = Integrator { gain: 2.0, integral: 0.5, is_held: false };
//! let mut saved = Vec::new();
//! integrator.save(&mut words(|word| saved.push(word)));
//! let mut other = Integrator { gain: 2.0, integral: 0.0, is_held: true };
//! restore(&mut other, &saved).unwrap();
//! assert_eq!(other, integrator);
//! ```
//!
//! Restoring is in place: parameters, tables and plans are not moved.
#[cfg(feature = "std")]
mod form;
#[cfg(feature = "std")]
mod texts;
mod values;

#[cfg(feature = "std")]
pub use form::{Form, Number};
pub use servobench_state_derive::Stateful;
use thiserror::Error;

/// All values that a part of the loop carries from tick to tick.
pub trait Stateful {
    /// Writes all numbers, in an order that depends only on the parameters.
    fn save(&self, to: &mut dyn Writer);

    /// Reads the numbers written by [`save`](Self::save) of a state with the same parameters.
    ///
    /// # Errors
    /// [`Damaged`]; the state may then be partly restored, and must not be used except to restore another.
    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged>;
}

/// A state without parameters: its numbers define it completely.
pub trait Value: Stateful + Sized {
    /// The state written by [`save`](Stateful::save).
    ///
    /// # Errors
    /// [`Damaged`].
    fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged>;
}

/// Implements [`Stateful`] and [`Value`] for a type by conversion to and from another value; the conversion back may fail.
///
/// ```
/// #[derive(Debug, PartialEq)]
/// struct Even(u32);
///
/// servobench_base::saved_as!(Even: u32, |even: &Even| even.0 / 2, |half: u32| half.checked_mul(2).map(Self));
/// ```
#[macro_export]
macro_rules! saved_as {
    ($type:ty: $value:ty, $save:expr, $make:expr) => {
        impl $crate::state::Stateful for $type {
            fn save(&self, to: &mut dyn $crate::state::Writer) {
                let value: $value = ($save)(self);
                $crate::state::Stateful::save(&value, to);
            }

            fn restore(&mut self, from: &mut $crate::state::Reader<'_>) -> Result<(), $crate::state::Damaged> {
                *self = $crate::state::Value::restored(from)?;
                Ok(())
            }
        }

        impl $crate::state::Value for $type {
            fn restored(from: &mut $crate::state::Reader<'_>) -> Result<Self, $crate::state::Damaged> {
                let value: $value = $crate::state::Value::restored(from)?;
                ($make)(value).ok_or($crate::state::Damaged)
            }
        }
    };
}

/// An option or a list whose form depends on the parameters.
pub trait FixedForm {
    /// See [`Stateful::save`].
    fn save_fixed(&self, to: &mut dyn Writer);

    /// See [`Stateful::restore`].
    ///
    /// # Errors
    /// [`Damaged`], also if the form differs.
    fn restore_fixed(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged>;
}

/// A name for a group of numbers of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Name of the field.
    pub name: &'static str,
    /// True if it is computed from the rest.
    pub is_derived: bool,
}

impl Part {
    /// A field.
    #[must_use]
    pub const fn field(name: &'static str) -> Self {
        Self { name, is_derived: false }
    }

    /// A field computed from the rest.
    #[must_use]
    pub const fn derived(name: &'static str) -> Self {
        Self { name, is_derived: true }
    }
}

/// Receives the numbers of a state.
pub trait Writer {
    /// Writes a number that varies continuously.
    fn number(&mut self, value: f64);

    /// Writes a count, a choice or a flag.
    fn word(&mut self, value: u64);

    /// Begins a part: the numbers up to [`leave`](Self::leave) belong to it.
    fn enter(&mut self, part: Part);

    /// Ends the part.
    fn leave(&mut self);
}

/// A writer that passes each number to `take` as a word, floating-point numbers by their bits.
pub const fn words<F: FnMut(u64)>(take: F) -> Words<F> {
    Words(take)
}

/// See [`words`].
#[derive(Debug, Clone, Copy)]
pub struct Words<F>(F);

impl<F: FnMut(u64)> Writer for Words<F> {
    fn number(&mut self, value: f64) {
        (self.0)(value.to_bits());
    }

    fn word(&mut self, value: u64) {
        (self.0)(value);
    }

    fn enter(&mut self, _: Part) {}

    fn leave(&mut self) {}
}

/// The words of a saved state, in sequence.
#[derive(Debug, Clone)]
pub struct Reader<'a> {
    words: &'a [u64],
    is_moved: bool,
}

impl<'a> Reader<'a> {
    /// Reads `words` from the first on.
    #[must_use]
    pub const fn new(words: &'a [u64]) -> Self {
        Self { words, is_moved: false }
    }

    /// Reads `words` from the first on, some of which were changed after saving.
    #[must_use]
    pub const fn moved(words: &'a [u64]) -> Self {
        Self { words, is_moved: true }
    }

    /// True if numbers were changed: a state then recomputes derived values that its next step would not recompute.
    #[must_use]
    pub const fn is_moved(&self) -> bool {
        self.is_moved
    }

    /// The next word.
    ///
    /// # Errors
    /// [`Damaged`] at the end.
    pub fn word(&mut self) -> Result<u64, Damaged> {
        let (first, rest) = self.words.split_first().ok_or(Damaged)?;
        self.words = rest;
        Ok(*first)
    }

    /// The next number.
    ///
    /// # Errors
    /// [`Damaged`] at the end.
    pub fn number(&mut self) -> Result<f64, Damaged> {
        self.word().map(f64::from_bits)
    }

    /// The length of a list whose items have at least one word each.
    ///
    /// # Errors
    /// [`Damaged`] if fewer words are left.
    pub fn length(&mut self) -> Result<usize, Damaged> {
        let length = self.word()?;
        usize::try_from(length).ok().filter(|length| *length <= self.words.len()).ok_or(Damaged)
    }

    /// Checks that no words are left.
    ///
    /// # Errors
    /// [`Damaged`] if there are further words.
    pub const fn end(&self) -> Result<(), Damaged> {
        if self.words.is_empty() { Ok(()) } else { Err(Damaged) }
    }
}

/// Restores `state` from all of `words`.
///
/// # Errors
/// [`Damaged`] if they are not of a state with the same parameters; `state` must then not be used except to restore another.
pub fn restore(state: &mut (impl Stateful + ?Sized), words: &[u64]) -> Result<(), Damaged> {
    let mut from = Reader::new(words);
    state.restore(&mut from)?;
    from.end()
}

/// The words are not a saved state of the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("not a state of this loop: it was saved with other parameters, or it is damaged")]
pub struct Damaged;

#[cfg(test)]
mod tests;
