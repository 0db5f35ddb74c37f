//! Positions at given times on a drive with velocity commands: `MC_PositionProfile` on the profile velocity mode.
//!
//! The drive takes a velocity V and an acceleration a = d > 0, changes linearly to V and stays there. Two methods to
//! meet the positions p_i at the times t_i (dT_i = t_i − t_(i−1)) with such [`Command`]s:
//!
//! # Option 1, [`Plateaus`]: hits every position
//!
//! In segment i the velocity is constant, V_i, except for the shares α·dT_i at its beginning and end, in which it changes
//! linearly to that of the neighbours; W_i is the velocity at the point itself, W_0 = V_s and W_N = V_e given.
//!
//! ```text
//! W_i = (dT_i·V_(i+1) + dT_(i+1)·V_i)/(dT_i + dT_(i+1))
//! 2(p_i − p_(i−1))/dT_i = α·W_(i−1) + (2 − 2α)·V_i + α·W_i                                  (area below the velocity)
//! ```
//!
//! With the first in the second this is a tridiagonal system in V_i, diagonally dominant for 0 < α ≤ 1/2. (In the
//! last row, as printed in the source, the plus between the terms of V_(N−1) and V_N is missing, and W_N = V_e replaces
//! V_(N+1).) Once W is known, the second row gives V_i back: the points alone, with W_i as their
//! velocity, are the profile.
//!
//! # Option 2, [`Spline`]: follows the cubic spline
//!
//! The [spline](crate::pvt::continuous) through the points with the end velocities V_s and V_e has continuous
//! acceleration. At the frequency ν = 1/h the command V = P'(t + h), a = |V − V_cur|/h is sent; a drive that obeys is
//! at V when the next one comes (V_cur = P'(t)), so that its velocity is the spline's at every command and
//! linear in between. Its position is the trapezoidal rule applied to P', and the error is known beforehand. With the
//! kernel of Peano,
//!
//! ```text
//! E(t_k + h) − E(t_k) = ∫₀ʰ s(h − s)/2·j(t_k + s) ds
//! ```
//!
//! and as j is constant in each segment, the sum over all intervals (Euler–Maclaurin) is, exactly and for any position
//! θ_i ∈ [0, 1) of the points between two commands, with the jerk jumping by Δj_i at the points passed,
//!
//! ```text
//! E(t_k) = h²/12·(a(t_k) − a(t_0)) + h³/6·Σ Δj_i·B3(θ_i),      B3(θ) = θ³ − 3/2·θ² + θ/2,    |B3| ≤ √3/36.
//! ```
//!
//! Between two commands the error changes monotonically from the one value to the other while the jerk keeps its sign,
//! and turns at most twice between two points where it does not: the overall largest error is found in one pass over
//! the points, for any number of commands.
//!
//! # On a bus
//!
//! Both send their commands at any time. A bus takes them at the instants of a [`Clock`], and waiting for the next one
//! would shift every position behind it: [`ClockedPlateaus`] and [`ClockedSpline`] are the same for a drive on a bus.
//!
//! Source: N. D. Baikov, A. N. Godunov, *An Approach to Implementing Functional Blocks of the PLCopen Specification*,
//! sections 4 and 5 (which requires an estimate of the error without giving a method).

mod clock;
mod clocked;
mod command;
mod plateaus;
mod rate;
mod share;
mod stepped;

pub use clock::Clock;
pub use clocked::{ClockedPlateaus, ClockedSpline, ClockedSteps};
pub use command::{Command, VelocityRamp};
pub use plateaus::{PlateauCommands, Plateaus};
pub use share::PlateauShare;
pub use stepped::{PointErrors, Spline, Stepped, SteppedCommands};
