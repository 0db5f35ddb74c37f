//! Set-point generators.
//!
//! - [`Profile`]: rest-to-rest moves of order 2 (trapezoid), 3 (jerk-limited) and 4 (snap-limited), below.
//! - [`online`]: transitions of order 2, 3 and 4 from any state, planned while the axis moves.
//! - [`sampled`]: moves sample by sample.
//! - [`rockwell`]: the two profiles of Rockwell's axis move.
//! - [`pvt`]: tables of positions, velocities and times; [`position_profile`]: the same sent as velocity commands.
//! - [`interpolate`]: between a slow task that commands and a fast one that drives.
//! - [`shape`]: input shapers and moving averages that suppress a vibration in any of these.
//!
//! # Rest to rest
//!
//! ```
//! use servobench_motion::{Limits, Order, Profile};
//! let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
//! let plan = Profile::plan_sampled(Order::Fourth, 1.0, &limits, 1e-3)?;
//! assert_eq!(plan.samples().map(|samples| samples.total()), Some(1350));
//! assert_eq!(plan.at(plan.duration()).x, 1.0);
//! # Ok::<(), servobench_motion::PlanError>(())
//! ```
//!
//! # A profile is a step through moving averages
//!
//! A moving average of length T, without its factor 1/T, outputs the integral of its input over the last T seconds, `(1 − e^(−sT))/s`.
//! A step of height `d` through averages of lengths `T1 … Tn` becomes the move (n = 4 below):
//!
//! ```text
//! x(s) = d/s·∏ (1 − e^(−s·T_k))/s,    final value, lim s·x(s):  |x| = d·T1·T2·T3·T4    after T = T1 + T2 + T3 + T4.
//!
//! Derivative n − m is the output of average m, cancelled by a factor (1 − e^(−s·T_k)) for every average behind it. The output of
//! average m rises to d·T1⋯Tm within T1 + … + Tm; a next average at least that long cancels nothing before. Therefore
//!   j_peak = d·T1      a_peak = d·T1·T2      v_peak = d·T1·T2·T3      if  T1 ≤ T2,  T1+T2 ≤ T3,  T1+T2+T3 ≤ T4.
//!
//! Derivative n, m = 0, multiplied out: pulses ±d of length T1, one for each subset S of {T2 … Tn}, starting at ΣS with
//! the sign (−1)^|S|. The same conditions keep them apart; between them lie dwells of three lengths:
//!   t_d = T1    t_j = T2 − T1    t_a = T3 − T2 − T1    t_v = T4 − T3 − T2 − T1         T = 8t_d + 4t_j + 2t_a + t_v.
//!
//! In samples, n_k = T_k/Ts, the forward-Euler cascade has the same product:  x = d·Ts⁴·n1·n2·n3·n4.
//! ```
//!
//! # The planner in one equation
//!
//! Average after average is made as short as the limits allow while those behind it follow as short as their order
//! permits, each the sum of its predecessors. With `P` the peak reached by the averages before average k and `c` their sum, a
//! quantity with the bound `B` (the distance, v, a, …) at the output of the i-th average behind average k peaks at
//!
//! ```text
//! P·2^(i(i−1)/2)·T·(c + T)^i          hence T(c + T)^i = q = B/(P·2^(i(i−1)/2))       for the length T = T_k
//! ```
//!
//! Continuous: T is the smallest root over the bounds, at least c. Sampled: T is the smallest whole number of samples that
//! reaches B, found by stepping an integer (a floating `ceil` of the root gives a sample too many whenever an exact
//! whole number is missed by one rounding), and `d` is lowered so that B is met exactly before the next bound is
//! checked. That is the sequential rounding of Pietrusewicz, Waszczuk & Kubicki, *`MC_MoveAbsolute()` 4th Order
//! Real-Time Trajectory Generation Function Algorithm and Implementation*, Applied Sciences 9 (2019), after
//! Lambrechts, Boerlage & Steinbuch (2005). The one equation stands for these of the paper:
//!
//! | average | B = distance | B = v | B = a | B = j |
//! |---|---|---|---|---|
//! | T1 = t_d | (4)–(6), i = 3 | (9)–(11), i = 2 | (14)–(16), i = 1 | (19)–(21), i = 0 |
//! | T2 | (23)–(25), i = 2 | (28)–(30), i = 1 | (33)–(35), i = 0 | |
//! | T3 | (37)–(40), i = 1 | (43)–(45), i = 0 | | |
//! | T4 | (47)–(49), i = 0 | | | |
//!
//! and the subset sum above for (50)–(54) and (63). Several are misprinted there; `tests/plans/paper.rs` has them
//! in corrected form, as a second planner for comparison with this one. The sign of the move is applied once,
//! through `d`. Orders 2 and 3 are the same with two and three averages. Order 3 is time-optimal; order 4 is not quite,
//! since this shape brings the jerk to zero at peak velocity (up to 6.94 % of the time when there is no cruise).
//!
//! # Executing a plan
//!
//! [`Profile::at`] evaluates the exact polynomial, the *exact hold* of the highest derivative. A sampled move may also be sent
//! through the *forward-Euler cascade* (72)–(75), [`sampled::Cascade`]. Both are at rest at the target at sample N; the
//! cascade stands still for its first three samples at order 4 and lags by 1.5·Ts·v during motion. A move that keeps its limits
//! at every sample of the cascade keeps them at every time of the exact hold ([`sampled`]).
//!
//! | planner | samples |
//! |---|---|
//! | [`Profile::plan_sampled`] | those of the paper's sequential rounding |
//! | [`Profile::plan_fewest`] | the fewest with moving averages; brute force finds none below |
//! | `sampled::Shortest` (feature `std`) | the fewest of any move, with a proof up to 300 samples |
#![cfg_attr(not(test), no_std)]
#[cfg(all(feature = "std", not(test)))]
extern crate std;

mod boxes;
mod course;
mod error;
pub mod interpolate;
mod limits;
pub mod online;
mod optimal;
mod piece;
pub mod position_profile;
mod profile;
pub mod pvt;
mod request;
pub mod rockwell;
mod root;
pub mod sampled;
mod segment;
pub mod shape;
mod stretch;
mod trajectory;

pub use course::Course;
pub use error::PlanError;
pub use limits::{LimitParameter, Limits, Order};
pub use piece::Piece;
pub use profile::{Peaks, Profile, Samples, Times};
pub use segment::{Segment, Segments};
pub use trajectory::Trajectory;
