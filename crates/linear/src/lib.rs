//! The linear loop by differences of the tick that runs.
//!
//! No equation is written a second time: a loop at rest is saved, one of its numbers is moved, it goes a tick, and what is different then,
//! by what was moved, is a column of the matrix of that tick.
//!
//! ```text
//! x(k+1) = A_i·x(k)         i the kind of the tick: which tasks have their turn
//! A_i·e_j = (tick_i(x₀ + δ·e_j) − tick_i(x₀))/δ
//! ```
//! **Exact.** A number that is zero at rest is moved by δ = 2⁻⁶⁰⁰: products of two deviations underflow to zero, so that what is left
//! is the derivative but for the rounding of the tick itself, and what does not act gives exactly zero. A number that is not zero at rest is
//! moved by as much as it is; what it acts on must be a straight line in it.
//!
//! **Positions.** The whole loop at rest at another place is at rest, too. This direction w, found by bringing it there, takes the
//! place of the first position: all others are told from it. A loop that no position closes then does not depend on it, exactly.
//!
//! **Gains.** Within a tick each gain acts once on the way of a signal, so that the matrix is affine in each: it is derived with
//! a gain as it is and without it, and anything between or beyond lies on a line ([`Factors`]).
//!
//! **States.** Only numbers that lie on a ring are states of the matrix: what nothing reads, and what only acts from outside, such as
//! a set-point, is in no loop.

mod derive;
mod error;
mod factors;
mod structure;

pub use derive::{Matrices, System, TickMatrix};
pub use error::LinearError;
pub use factors::Factors;
pub use structure::Pattern;

use servobench_base::state::{Reader, Writer};

/// Name that the numbers of the mechanics begin with.
pub const MECHANICS: &str = "mechanics.";
/// Name that the numbers of the controllers begin with; all others are of what they control.
pub const CONTROLLERS: &str = "controllers.";

/// A loop that runs.
pub trait Running {
    /// Writes its state, all of it within [`MECHANICS`], [`CONTROLLERS`] and other parts.
    ///
    /// # Errors
    /// [`LinearError`] where it cannot be saved.
    fn save(&mut self, to: &mut dyn Writer) -> Result<(), LinearError>;

    /// Takes a state that was saved.
    ///
    /// # Errors
    /// [`LinearError`] where it cannot be restored.
    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), LinearError>;

    /// Brings it to rest at `position`, before its first tick.
    ///
    /// # Errors
    /// [`LinearError`] where it cannot be brought there.
    fn place(&mut self, position: f64) -> Result<(), LinearError>;

    /// Goes a tick.
    ///
    /// # Errors
    /// [`LinearError`] where it cannot go on.
    fn tick(&mut self) -> Result<(), LinearError>;

    /// Has its gains by `factors` from now on.
    fn set(&mut self, factors: &Factors);
}
