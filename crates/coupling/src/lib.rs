//! A co-simulation master: blocks that are stepped separately and exchange signals at fixed times.
//!
//! [`Master::new`] couples the [`Block`]s of a [`Network`]; each [`Master::advance`] performs one communication step H:
//!
//! ```text
//! step       each block that is due goes from t to t + n·H, with inputs that are polynomials over the step
//! exchange   outputs at t + H are read; those that follow inputs without a step are read after these, algebraic loops are solved
//! judge      a number that is not finite, or a coupling that grows by itself, ends the run
//! ```
//!
//! # Orders of accuracy
//!
//! An input is the polynomial of order k through the last k + 1 values of its signal, extrapolated beyond the newest of them. For a
//! signal that is k + 1 times differentiable its error within the step is `u^(k+1)·H^(k+1)·σ(σ+1)…(σ+k)/(k+1)!`, O(H^(k+1)). A block's
//! state integrates it once, O(H^(k+2)) in a step; T/H steps add up to
//!
//! | method | global error | why |
//! |---|---|---|
//! | [`Method::Jacobi`] | O(H^(k+1)) | all inputs extrapolated |
//! | [`Method::GaussSeidel`] | O(H^(k+1)) | inputs from later blocks extrapolated; those from earlier ones have a smaller constant |
//! | [`Method::Iterated`] | O(H^(max(k,1)+1)) | all inputs interpolated, with the end of the step among their points |
//!
//! provided that the coupled simulation is zero-stable. It is when no outputs follow each other in a cycle without a step, or when such
//! cycles are solved at the exchange, as done here (Kübler & Schiehlen, Math. Comput. Model. Dyn. Syst. 6 (2000) 93; Arnold & Günther, BIT
//! 41 (2001) 1; orders as in Busch, *Zur effizienten Kopplung von Simulationsprogrammen*, Kassel 2012, ch. 4; survey: Gomes, Thule, Broman,
//! Larsen & Vangheluwe, ACM Comput. Surv. 51 (2018) 49).
//!
//! The order is lowered by:
//!
//! - **The start, and each event.** With only one known value the order is 0, with two it is 1. One step of order 0 leaves O(H²) in the
//!   state for good: explicit methods of order 2 promise O(H³) only where signals begin with slope 0 (from rest), O(H²) else. The
//!   iterated method begins with a straight line, O(H³), and loses nothing.
//! - **Blocks that take no derivatives** hold the mean of the polynomial, which is exact in the integral over the step and off by O(H²)
//!   within it: at most order 2.
//!
//! `docs/coupling.md` has the measured orders, and recommends methods.
//!
//! # Time
//!
//! Exchanges are whole base ticks; seconds appear only in [`Block::step`], which gets the same length each time, bit for bit. A block
//! with a step of n·H takes it at the beginning, and its end is known to faster blocks at once, except with [`Method::Jacobi`], where it
//! counts when it is reached. [`Master::delays`] lists the effect on each connection.

mod acceleration;
mod block;
mod cycles;
mod delay;
mod error;
mod estimate;
mod fixed_point;
mod master;
mod network;
mod polynomial;
mod rise;
mod schedule;
mod settings;
mod settle;
mod signals;
mod stepping;
mod watch;

pub use block::{Block, Input};
pub use delay::Delay;
pub use error::CouplingError;
pub use estimate::EstimatedError;
pub use master::{Advance, Master};
pub use network::{Connection, InputPort, Member, Network, NetworkError, Port};
pub use polynomial::{Order, later, mean, value};
pub use servobench_base::StepEnd;
pub use settings::{Acceleration, Iteration, Method, MethodKind, Settings};
