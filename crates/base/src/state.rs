//! States as numbers: everything that a part of the loop carries from tick to tick, saved, restored and named.
//!
//! A state is declared once. `#[derive(Stateful)]` saves every field of it, so that a new field cannot be forgotten, and a field that is
//! not to be saved says why:
//!
//! | mark | of a field |
//! |---|---|
//! | `#[state(constant)]` | a parameter: equal in all states of a run |
//! | `#[state(derived)]` | computed from the rest of the state; saved, but moving it alone means nothing |
//! | `#[state(recomputed)]` | not saved: computed from the rest after it was restored, or in each tick before it is read |
//! | `#[state(fixed)]` | an option or a list with parameters in it, whose form they decide |
//!
//! A type without parameters in it is a [`Value`], which an option or a list can make anew. A type that has fields with parameters in them, and
//! an enum with parameters in it, is itself marked `#[state(fixed)]`.
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
//! Restoring is in place: parameters, tables and plans stay where they are.
#[cfg(feature = "std")]
mod form;
#[cfg(feature = "std")]
mod texts;
mod values;

#[cfg(feature = "std")]
pub use form::{Form, Number};
pub use servobench_state_derive::Stateful;
use thiserror::Error;

/// All that a part of the loop carries from tick to tick.
pub trait Stateful {
    /// Writes every number of it, in an order that its parameters decide.
    fn save(&self, to: &mut dyn Writer);

    /// Takes the numbers that [`save`](Self::save) of a state with the same parameters has written.
    ///
    /// # Errors
    /// [`Damaged`]; then a part of the state may be restored, and it must not be used but to restore another.
    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged>;
}

/// A state without parameters: its numbers are all of it.
pub trait Value: Stateful + Sized {
    /// The state that [`save`](Stateful::save) has written.
    ///
    /// # Errors
    /// [`Damaged`].
    fn restored(from: &mut Reader<'_>) -> Result<Self, Damaged>;
}

/// Implements [`Stateful`] and [`Value`] of a type by another value: what it is saved as, and what makes it of that, or nothing.
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

/// An option or a list whose form the parameters decide.
pub trait FixedForm {
    /// See [`Stateful::save`].
    fn save_fixed(&self, to: &mut dyn Writer);

    /// See [`Stateful::restore`].
    ///
    /// # Errors
    /// [`Damaged`], also where the form is another.
    fn restore_fixed(&mut self, from: &mut Reader<'_>) -> Result<(), Damaged>;
}

/// A name that numbers of a state belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Name of the field.
    pub name: &'static str,
    /// True where it is computed from the rest.
    pub is_derived: bool,
}

impl Part {
    /// A field.
    #[must_use]
    pub const fn field(name: &'static str) -> Self {
        Self { name, is_derived: false }
    }

    /// A field that is computed from the rest.
    #[must_use]
    pub const fn derived(name: &'static str) -> Self {
        Self { name, is_derived: true }
    }
}

/// Receives the numbers of a state.
pub trait Writer {
    /// A number that varies continuously.
    fn number(&mut self, value: f64);

    /// A count, a choice or a flag.
    fn word(&mut self, value: u64);

    /// Numbers up to [`leave`](Self::leave) belong to this part.
    fn enter(&mut self, part: Part);

    /// The part ends.
    fn leave(&mut self);
}

/// A writer that gives each number to `take` as a word, numbers by their bits.
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

/// The words of a saved state, one after the other.
#[derive(Debug, Clone)]
pub struct Reader<'a> {
    words: &'a [u64],
    is_moved: bool,
}

impl<'a> Reader<'a> {
    /// From the first of `words` on.
    #[must_use]
    pub const fn new(words: &'a [u64]) -> Self {
        Self { words, is_moved: false }
    }

    /// From the first of `words` on, in which numbers were changed after they had been saved.
    #[must_use]
    pub const fn moved(words: &'a [u64]) -> Self {
        Self { words, is_moved: true }
    }

    /// True where numbers were changed: a state that would not do it in its next step computes again what it derives from them.
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

    /// A number of things each of which has at least one word.
    ///
    /// # Errors
    /// [`Damaged`] where there are fewer words than that.
    pub fn length(&mut self) -> Result<usize, Damaged> {
        let length = self.word()?;
        usize::try_from(length).ok().filter(|length| *length <= self.words.len()).ok_or(Damaged)
    }

    /// The end.
    ///
    /// # Errors
    /// [`Damaged`] where there are further words.
    pub const fn end(&self) -> Result<(), Damaged> {
        if self.words.is_empty() { Ok(()) } else { Err(Damaged) }
    }
}

/// Restores `state` from all of `words`.
///
/// # Errors
/// [`Damaged`] where they are not of a state with the same parameters; then `state` must not be used but to restore another.
pub fn restore(state: &mut (impl Stateful + ?Sized), words: &[u64]) -> Result<(), Damaged> {
    let mut from = Reader::new(words);
    state.restore(&mut from)?;
    from.end()
}

/// Numbers are not a saved state of what they are to restore.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("not a state of this loop: it was saved with other parameters, or it is damaged")]
pub struct Damaged;

#[cfg(test)]
mod tests;
