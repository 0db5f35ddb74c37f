//! Input shaping and moving averages of set-points, which keep a move from exciting a vibration of the axis.
//!
//! A mode of natural frequency ω and damping ratio ζ rings after an impulse. Split into impulses `A_i` at `t_i` (ΣA = 1),
//! the vibration after the last one, relative to that of one impulse at t = 0 at its own instant, is
//!
//! ```text
//! V(ω, ζ) = e^(−ζω·t_n)·|Σ A_i·e^((ζω + jω_d)·t_i)|      ω_d = ω·√(1 − ζ²)        (Singer & Seering 1990, eq. 2)
//!
//! with K = e^(−ζπ/√(1−ζ²)), at the times 0, T, 2T, 3T, T = π/ω_d, half a period of the damped vibration:
//!   ZV    (1, K)/(1 + K)                    V = 0                        adds T
//!   MZV   (1, √2·L, L²)/(1 + √2·L + L²)     V = 0                        adds 1.5T, L = K^0.75, at 0, 0.75T, 1.5T
//!   ZVD   (1, 2K, K²)/(1 + K)²              V = dV/dω = 0                adds 2T
//!   ZVDD  (1, 3K, 3K², K³)/(1 + K)³         V = dV/dω = d²V/dω² = 0      adds 3T
//!   EI    (1 + v, 2 − 2v, 1 + v)/4 (ζ = 0)  V = v, zero on both sides    adds 2T
//!   EI with n humps: V = v at their tops, n + 1 zeros around them        adds (n + 1)·T (ζ = 0), n = 2, 3
//! ```
//!
//! Remaining share of an undamped mode whose frequency is 10 % lower or higher, and width of the band around the frequency
//! in which it is at most 5 %; the EI shapers have v = 5 %:
//!
//! | | ZV | MZV | ZVD | ZVDD | EI | 2-hump EI | 3-hump EI |
//! |---|---|---|---|---|---|---|---|
//! | 10 % lower, higher | 15.6 % | 10.8, 8.5 % | 2.4 % | 0.4 % | 2.4 % | 3.9 % | 3.0 % |
//! | band | 6.4 % | 10.4 % | 28.7 % | 48.0 % | 39.9 % | 72.5 % | 96.4 % |
//!
//! Sources: ZV, ZVD, ZVDD: Singer & Seering, *Preshaping Command Inputs to Reduce System Vibration*, J. Dynamic Systems,
//! Measurement and Control 112 (1990). EI (extra-insensitive): Singhose, Seering & Singer, *Residual Vibration Reduction
//! Using Vector Diagrams to Generate Shaped Inputs*, J. Mechanical Design 116 (1994); with two and three humps: Singhose,
//! Porter, Tuttle & Singer, *Vibration Reduction Using Multi-Hump Input Shapers*, same journal as the first, 119 (1997); for
//! ζ > 0 the equations are solved here instead of using the curve fits of that. MZV: `shaper_defs.py` of Klipper.
//! Moving averages: Biagiotti & Melchiorri, *FIR Filters for Online Trajectory Planning with Time- and Frequency-Domain
//! Specifications*, Control Engineering Practice 20 (2012).
//!
//! | | on a set-point as a function of time | on a stream of set-points |
//! |---|---|---|
//! | impulses | [`Impulses::shape`], exact | [`ShapingFilter`], times on the grid of samples |
//! | averages | [`MovingAverages`], exact, for integrable set-points | [`MovingAverage`], one after the other |
//!
//! Both come to rest at exactly the target: values are summed as differences from one of them.
//!
//! ```
//! use servobench_motion::shape::{Impulses, Vibration};
//! use servobench_motion::{Limits, Order, Profile};
//! let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
//! let plan = Profile::plan(Order::Third, 0.3, &limits)?;
//! let shaper = Impulses::zvd(&Vibration::new(62.8, 0.02)?);
//! let end = plan.duration() + shaper.duration();
//! assert_eq!(shaper.shape(end, |t| plan.at(t)).x, 0.3);
//! assert!((end - plan.duration() - 0.1).abs() < 1e-3);
//! # Ok::<(), servobench_motion::PlanError>(())
//! ```

mod averages;
mod difference;
mod extra_insensitive;
mod filter;
mod humps;
mod impulses;
mod mean;
mod newton;
mod shaper;
mod vibration;

pub use averages::MovingAverages;
pub use filter::ShapingFilter;
pub use impulses::{Impulse, Impulses};
pub use mean::MovingAverage;
pub use shaper::{Shaper, ShaperKind};
pub use vibration::Vibration;
