//! The factor group: conversion between increments of the encoder and units of the axis.
//!
//! IEC 61800-7-201 (CiA 402-2), with each object a fraction of its sub-indices 01h and 02h:
//!
//! ```text
//! position = increments·feed constant (6092h)/(position encoder resolution (608Fh)·gear ratio (6091h))
//! velocity = increments per second·feed constant/(position encoder resolution·gear ratio)·velocity factor (6096h)
//! ```
//!
//! and both with the sign of the polarity (607Eh). Set-points are converted inversely. The product is one reduced fraction of integers,
//! [`Ratio`], so a conversion is exact up to the one rounding to a whole number of counts. That rounding is to the nearest, a half upwards:
//! a position that is shifted by a whole number of units is rounded as before, on both sides of zero.
//!
//! A converted position is always less than one count off. Increments of a position that are converted one after the other accumulate their
//! roundings.
//!
//! ```
//! use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio};
//! // 2^20 increments per motor revolution, a gear of 7:2 and a screw of 5 mm, in micrometres.
//! let factors = FactorGroup {
//!     position_encoder_resolution: [1 << 20, 1],
//!     gear_ratio: [7, 2],
//!     feed_constant: [5000, 1],
//!     ..FactorGroup::default()
//! };
//! let scaling = factors.scaling(AxisUnit::Metre(Ratio::new(1, 1_000_000)?))?;
//! assert_eq!(scaling.increments(10_000)?, 7 << 20);
//! assert_eq!(scaling.metres_or_radians(7 << 20)?, 0.01);
//! # Ok::<(), servobench_cia402::units::UnitError>(())
//! ```

mod divisor;
mod error;
mod factor_group;
mod ratio;
mod scaling;

pub use error::{Object, UnitError};
pub use factor_group::{AxisUnit, FactorGroup, POLARITY_BITS, POLARITY_POSITION, POLARITY_TORQUE, POLARITY_VELOCITY};
pub use ratio::Ratio;
pub use scaling::Scaling;
