//! The linear loop by differences of the running tick.
//!
//! No equation is written a second time: a loop at rest is saved, one of its numbers is moved, it runs a tick, and the resulting
//! differences, divided by the move, are a column of the matrix of that tick.
//!
//! ```text
//! x(k+1) = A_i·x(k)         i the kind of the tick: the tasks that are due
//! A_i·e_j = (tick_i(x₀ + δ·e_j) − tick_i(x₀))/δ
//! ```
//! **Exact.** A number that is zero at rest is moved by δ = 2⁻⁶⁰⁰: products of two deviations underflow to zero, so that the result
//! is the derivative except for the rounding of the tick itself, and numbers that do not act give exactly zero. A number that is not
//! zero at rest is moved by its own magnitude; everything that it acts on must be linear in it.
//!
//! **Positions.** The whole loop at rest at another place is at rest, too. This direction w, found by bringing it there, replaces
//! the first position: all others are measured from it. A loop that no position closes then does not depend on it, exactly.
//!
//! **Gains.** Within a tick each gain acts once on the path of a signal, so that the matrix is affine in each: it is derived with
//! the unchanged gain and without it, and anything between or beyond lies on a line ([`Factors`]).
//!
//! **States.** Only numbers on a ring are states of the matrix: numbers that nothing reads, and numbers that only act from outside, such as
//! a set-point, are in no loop.

mod derive;
mod error;
mod factors;
mod structure;

pub use derive::{Matrices, System, TickMatrix};
pub use error::LinearError;
pub use factors::Factors;
pub use structure::Pattern;

use servobench_base::state::{Reader, Writer};

/// Prefix of the names of the numbers of the mechanics.
pub const MECHANICS: &str = "mechanics.";
/// Prefix of the names of the numbers of the controllers; all others belong to the controlled system.
pub const CONTROLLERS: &str = "controllers.";

/// A running loop.
pub trait Running {
    /// Writes its state, all of it within [`MECHANICS`], [`CONTROLLERS`] and other parts.
    ///
    /// # Errors
    /// [`LinearError`] if it cannot be saved.
    fn save(&mut self, to: &mut dyn Writer) -> Result<(), LinearError>;

    /// Restores a saved state.
    ///
    /// # Errors
    /// [`LinearError`] if it cannot be restored.
    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), LinearError>;

    /// Brings it to rest at `position`, before its first tick.
    ///
    /// # Errors
    /// [`LinearError`] if it cannot be brought there.
    fn place(&mut self, position: f64) -> Result<(), LinearError>;

    /// Runs one tick.
    ///
    /// # Errors
    /// [`LinearError`] if it cannot continue.
    fn tick(&mut self) -> Result<(), LinearError>;

    /// Sets its gains, scaled by `factors`.
    fn set(&mut self, factors: &Factors);
}
