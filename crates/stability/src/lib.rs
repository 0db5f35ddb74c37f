//! The sampled linear loop of a servo axis: its poles, the loop that is unstable, and the gains at the boundary.
//!
//! [`Loop`] describes the axis and its drive. [`analyse`] takes the matrices of its ticks from the running loop
//! ([`servobench_linear`]), which include all rates, delays, filters and the current loop in both axes. The product over the
//! common period of all loops is formed once; its eigenvalues are the poles.
//!
//! ```text
//! x(t+1) = C_t·P·x(t)                P the mechanics, C_t the loops that are due at tick t, and the power stage
//! M = (C_0·P)·(C_{N−1}·P)⋯(C_1·P)    the loop is unstable: |λ(M)| > 1
//! ```
//! [`analyse_schedule`] repeats the analysis with the gains of a gain schedule.
//!
//! Friction, saturation and quantisation are not in it: [`LEFT_OUT`].
//! Source: Bittanti & Colaneri, *Periodic Systems*, 2009, ch. 3 (monodromy matrix of a multirate loop).

mod analyse;
mod boundary;
mod eigen;
mod equations;
mod error;
mod model;
mod ordering;
mod period;
mod pole;
mod qr;
mod report;
mod schedule;

pub use analyse::{Depth, analyse, analyse_master};
pub use error::StabilityError;
pub use model::{LEFT_OUT, Loop, Mechanics, PositionFeedback, Source, VelocitySignal};
pub use pole::Pole;
pub use report::{Boundaries, Boundary, GainName, Instability, LoopName, LoopReport, Report, Slowest, Warning};
pub use schedule::analyse_schedule;
