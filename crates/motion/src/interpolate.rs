//! Interpolation between a slow commanding task and a fast drive task: set-points at any fraction of a slow period.
//!
//! The slow task gives position, velocity, acceleration and torque once every T; the fast one reads in between. With
//! the samples `0` and `1` at the ends of the interval, `−2 … 3` around it, D = x1 − x0, and u the elapsed fraction of T:
//!
//! ```text
//! linear    x = x0 + D·u
//! cubic     x = x0 + V0·u + (3D − 2V0 − V1)·u² + (V0 + V1 − 2D)·u³                                           V = v·T
//! quintic   x = x0 + V0·u + A0/2·u² + (10D − 6V0 − 4V1 − (3A0 − A1)/2)·u³                                    A = a·T²
//!             + (−15D + 8V0 + 7V1 + (3A0 − 2A1)/2)·u⁴ + (6D − 3(V0 + V1) − (A0 − A1)/2)·u⁵
//! B-spline  x = Σ x_i·B(u − i),   B the uniform B-spline of degree 3 or 5, the samples as its control points
//! torque    τ0 + (τ1 − τ0)·u, in every mode
//! ```
//!
//! Sources: the modes are those of the block `RM_AxisSpline` of REXYGEN (REX Controls, function block reference);
//! Hermite polynomials and uniform B-splines: de Boor, *A Practical Guide to Splines*, 1978, ch. IV and X;
//! Biagiotti & Melchiorri, *Trajectory Planning for Automatic Machines and Robots*, 2008, ch. 2 and 8.
//!
//! # Properties of the modes
//!
//! | mode | meets the samples | continuous | exact for degree | delay | v and a are |
//! |---|---|---|---|---|---|
//! | linear | x | x | 1 | T | the derivatives of x |
//! | cubic | x, v | x, v | 3 | T | the derivatives of x |
//! | quintic | x, v, a | x, v, a | 5 | T | the derivatives of x |
//! | cubic B-spline | none | x, v, a | 1 | 2T | the derivatives of x |
//! | quintic B-spline | none | x, v, a, j, s | 1 | 3T | the derivatives of x |
//! | all linear | x, v, a | x, v, a | 1 in each of x, v, a | T | interpolated by themselves |
//! | all cubic | x, v, a | x, v, a and dx/dt | 3 in each of x, v | T | v: cubic by v and a; a = dv/dt |
//!
//! A polynomial mode follows any given velocity and acceleration, and swings where they do not match the
//! positions. A B-spline cannot swing, but rounds corners: for a parabola it has the right velocity and
//! acceleration, and a position error of `a·T²·(n + 1)/24`, n the degree (the variance of B is (n + 1)/12).
//!
//! # Delay
//!
//! An interval can be read only when all its samples are there. Pushed at k·T, sample k opens the interval that ends
//! [`Mode::delay_samples`] − 1 samples before it: the value read at t is the set-point of t − delay·T. The source's
//! prediction by one or two steps, its states and its buffer belong around this: [`Interval`] is one interval as a value,
//! so a buffer may hold several; [`Interpolator`] holds the newest one.
//!
//! ```
//! use servobench_motion::interpolate::{Interpolator, Mode, Sample};
//! let mut axis = Interpolator::new(Mode::Cubic, 4e-3)?;
//! axis.push(Sample { x: 0.0, v: 1.0, a: 0.0, torque: 0.0 })?;
//! axis.push(Sample { x: 4e-3, v: 1.0, a: 0.0, torque: 2.0 })?;
//! let command = axis.at(0.25)?;
//! assert!((command.setpoint.x - 1e-3).abs() < 1e-15);
//! assert_eq!(command.torque, 0.5);
//! # Ok::<(), servobench_motion::PlanError>(())
//! ```

mod interval;
mod polynomial;
mod stream;

pub use interval::{Command, Interval, Sample};
pub use stream::Interpolator;

use servobench_config::Choice;

servobench_config::choices! {
    /// Interpolation between two slow samples; the table in the [module documentation](self) compares them.
    pub enum Mode {
        /// position linear, velocity its slope; one period late
        Linear = "linear",
        /// by positions and velocities; one period late
        Cubic = "cubic",
        /// by positions, velocities and accelerations; one period late
        Quintic = "quintic",
        /// positions as control points, not passed through; two periods late
        CubicBSpline = "cubic-b-spline",
        /// positions as control points, not passed through; three periods late
        QuinticBSpline = "quintic-b-spline",
        /// position, velocity, acceleration each linear; one period late
        AllLinear = "all-linear",
        /// position and velocity each cubic; one period late
        AllCubic = "all-cubic",
    }
}

impl Mode {
    /// All modes, in the order of their numbers, from 1, in the source's parameter `InterpolationMode`.
    pub const ALL: [Self; 7] = {
        let mut all = [Self::Linear; 7];
        let mut i = 0;
        while i < all.len() {
            all[i] = <Self as Choice>::ALL[i].1;
            i += 1;
        }
        all
    };

    /// Number of samples that one interval needs, half of them on each side: 2, 4 or 6.
    #[must_use]
    pub const fn points(self) -> usize {
        match self {
            Self::CubicBSpline => 4,
            Self::QuinticBSpline => 6,
            Self::Linear | Self::Cubic | Self::Quintic | Self::AllLinear | Self::AllCubic => 2,
        }
    }

    /// Delay of the output in slow periods when an interval is read as soon as possible: half of
    /// [`points`](Self::points).
    #[must_use]
    pub const fn delay_samples(self) -> usize {
        self.points() / 2
    }
}
