//! Moves through a table of points: position, velocity and time (PVT), or position and time (PT).
//!
//! ```
//! use servobench_motion::pvt::{Knot, Table, average};
//! let mut knots = [(0.0, 0.0), (0.01, 5.0), (0.02, 15.0), (0.03, 20.0)].map(|(t, x)| Knot::new(t, x));
//! average(&mut knots, 0.0, 0.0)?;
//! let table = Table::new(&knots)?;
//! assert_eq!(table.at(0.01).v, 750.0);
//! # Ok::<(), servobench_motion::PlanError>(())
//! ```
//!
//! # One segment
//!
//! ```text
//! from (P0, V0) to (PT, VT) in the time T,  p(t) = b0 + b1·t + b2·t² + b3·t³:
//!   b0 = P0     b1 = V0     b2 = 3(PT − P0)/T² − (2V0 + VT)/T     b3 = (V0 + VT)/T² − 2(PT − P0)/T³
//!   a(t) = 2·b2 + 6·b3·t     j = 6·b3
//! ```
//!
//! A point without a velocity is approached linearly, b1 = (PT − P0)/T and b2 = b3 = 0. Position and velocity are
//! continuous in a cubic table; velocity jumps at the points of a linear one, where the acceleration would be
//! infinite and is given as that of the segment that begins. A cubic segment behind a linear one begins with the
//! velocity of the linear one; one that begins the table without a velocity begins at rest.
//!
//! # Velocities between given positions
//!
//! With the segments h0, h1 before and behind a point, their mean velocities s0, s1 and λ = h1/(h0 + h1),
//! μ = h0/(h0 + h1) = 1 − λ, the acceleration is continuous at the point if
//!
//! ```text
//! λ·V0 + 2·V1 + μ·V2 = r1 = 3(λ·s0 + μ·s1)
//! ```
//!
//! - [`average`]: V1 = (P2 − P0)/(h0 + h1), which ignores that.
//! - [`smooth`]: passes from the first point to the last, in place, each point from its neighbours. This row and the
//!   next one solved for V1 are the formula F2 of the source, generalised to unequal times, and this row alone, for
//!   the last point, its F1:
//!
//!   ```text
//!   F2:  V1 = (2·r1 − 2·λ1·V0 − μ1·r2 + μ1·μ2·V3)/(4 − μ1·λ2)          F1:  V1 = (r1 − λ1·V0 − μ1·V2)/2
//!   ```
//!
//!   A pass leaves at most (2λ1 + μ1·μ2)/(4 − μ1·λ2) ≤ 1/2 of the largest distance to the solution of all rows, 1/3
//!   if all times are equal: the passes are iterations that solve the system, and the source shows two of
//!   them.
//! - [`continuous`]: that solution, a tridiagonal system solved in one forward and one backward sweep.
//!
//! Source: Copley Controls, *PVT Trajectory Calculations*, rev. 00 (2020), sections "Cubic Polynomial Interpolation",
//! "Calculating velocity for continuous accelerations" and "Using PVT points to generate S-curve moves".

mod cursor;
mod knot;
mod s_curve;
mod table;
mod velocities;

pub use cursor::{Cursor, Knotted};
pub use knot::Knot;
pub(crate) use knot::{checked, scratch_for};
pub use s_curve::{s_curve, s_curve_segment_time};
pub use table::Table;
pub(crate) use velocities::set_ends;
pub use velocities::{average, continuous, smooth};
