//! Moves executed sample by sample.
//!
//! A sampled move is a list of [`Run`]s: a highest derivative and the number of samples for which it is sent. Two methods to make
//! set-points of it are in use. With Ts = 1 and the snap s_k of sample k, order 4:
//!
//! ```text
//! forward-Euler cascade, [`Cascade`]           x += v;  v += a;  a += j;  j += s_k      all from the values before
//! exact hold, [`Profile::at`](crate::Profile)  x += v + a/2 + j/6 + s_k/24;  v += a + j/2 + s_k/6;  …
//! ```
//!
//! # The values of the cascade are the control points of the exact hold
//!
//! In each sample the exact hold is a polynomial, joined to the next as smoothly as the order allows: a spline. Its
//! coefficients in terms of B-splines are the values of the cascade, from the highest derivative down,
//!
//! ```text
//! j(t) = Σ_k j_k·B_1(t − k)     a(t) = Σ_k a_k·B_2(t − k)     v(t) = Σ_k v_k·B_3(t − k)     x(t) = Σ_k x_k·B_4(t − k)
//! ```
//!
//! B_1 is the hat between −1 and 1, B_m(t) the mean of B_(m−1) from t to t + 1: the derivative of one sum has the differences
//! of neighbours as coefficients, which the cascade adds up. B_m is nowhere negative, its shifts sum to one, and its
//! middle is at −(m − 1)/2. Hence:
//!
//! - **A move within its limits at every sample of the cascade is within them at every time of the exact hold**: a weighted
//!   mean of values is not larger than the largest. The reverse does not hold: a move planned for the exact hold alone may
//!   be shorter.
//! - At order n the cascade lags by (n − 1)/2 samples, x_k ≈ x(t_k − (n − 1)/2·Ts), exactly so where the velocity is constant,
//!   and stands still for its first n − 1 samples.
//! - Where velocity, acceleration and jerk are zero again, all x_k are the same: **both are at rest on the same position at
//!   sample N**.
//!
//! # How many samples
//!
//! Three planners, each with more freedom than the one before. Saving of samples compared with the first, on average and at
//! most, in 1299 random requests of order 4 up to 300 samples (the test `forward_euler_keeps_every_limit_at_every_sample_and_lands`
//! prints it; `SERVOBENCH_SWEEP=400000`):
//!
//! | | shape of the move | shorter by |
//! |---|---|---|
//! | [`Profile::plan_sampled`](crate::Profile::plan_sampled) | moving averages, rounded one after the other as published | – |
//! | [`Profile::plan_fewest`](crate::Profile::plan_fewest) | moving averages | 1.00, at most 7 |
//! | `Shortest` (feature `std`) | any | 3.15, at most 28 |
//!
//! Of all 4000 requests, of orders 2 to 4, 3991 are proven to have no shorter move of any shape. A long move is seldom proven, and
//! is within five samples of the continuous optimum.
mod cascade;
use servobench_base::Stateful;
#[cfg(feature = "std")]
mod half;
#[cfg(feature = "std")]
mod proof;
#[cfg(feature = "std")]
mod reach;
#[cfg(feature = "std")]
mod shortest;
#[cfg(feature = "std")]
mod simplex;
#[cfg(feature = "std")]
mod symmetric;

pub use cascade::{Along, Cascade};
#[cfg(feature = "std")]
pub use shortest::Shortest;

servobench_config::choices! {
    /// Set-points from samples of the highest derivative. Those of the [`Cascade`] lag in motion by half a sample for each derivative
    /// but one.
    pub enum Execution default ExactHold {
        /// the exact polynomial, the highest derivative held: N samples, no lag
        ExactHold = "hold",
        /// the forward-Euler cascade, each sample held until the next: at rest at the same sample, and 1.5 samples late in motion at
        /// order 4
        ForwardEuler = "euler",
    }
}

/// Consecutive samples with the same highest derivative.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Run {
    /// Acceleration, jerk or snap by order (SI), with the sign of the direction.
    pub value: f64,
    /// Number of samples.
    pub count: u64,
}
