//! Moves executed sample by sample.
//!
//! A sampled move is a list of [`Run`]s: a highest derivative and for how many samples it is sent. Two ways to make
//! set-points of it are in use. With Ts = 1 and the snap s_k of sample k, order 4:
//!
//! ```text
//! forward-Euler cascade, [`Cascade`]           x += v;  v += a;  a += j;  j += s_k      all from the values before
//! exact hold, [`Profile::at`](crate::Profile)  x += v + a/2 + j/6 + s_k/24;  v += a + j/2 + s_k/6;  …
//! ```
//!
//! What a unit of snap at sample i has made of the position at sample N is `C(m, 3)` with `m = N − 1 − i` in the first, and
//! `((m + 1)⁴ − m⁴)/24` in the second: polynomials in i with the same cube, −i³/6. Where velocity, acceleration and jerk
//! are zero again, Σ s_i, Σ i·s_i and Σ i²·s_i are zero, so that **both are at rest on the same position at sample N**.
//! On the way they differ: at order n the cascade stands still for its first n − 1 samples and lags by
//! (n − 1)/2 samples, x_k ≈ x(t_k − (n − 1)/2·Ts), exactly so where the velocity is constant.
mod cascade;

pub use cascade::{Along, Cascade};

/// Samples in a row in which the highest derivative is the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Acceleration, jerk or snap by order (SI), with the sign of the direction.
    pub value: f64,
    /// Number of samples.
    pub count: u64,
}
