//! The firmware as a linear loop around standstill: the linear part of each block.
//!
//! Every field is listed here, so that a new one does not compile without a decision on its linear part ([`Params::linearised`]).
use crate::current::operating_point;
use crate::{Params, Stage, current, feedforward, velocity};

impl Params {
    /// Same firmware without its nonlinear parts: limits are infinite, and everything that depends on direction, speed or position is off.
    /// Gains are those at standstill; the gain schedule multiplies them at speed
    /// ([`schedule::Params::factors`](crate::schedule::Params::factors)).
    #[must_use]
    pub fn linearised(&self) -> Self {
        let velocity::Params { k_p, integral_time, max_effort: _ } = self.velocity;
        Self {
            base_rate: self.base_rate,
            transmission: self.transmission,
            position_gain: self.position_gain,
            position_every: self.position_every,
            velocity: velocity::Params { k_p, integral_time, max_effort: f64::INFINITY },
            velocity_every: self.velocity_every,
            velocity_filter_time: self.velocity_filter_time,
            feedforward: self.feedforward.linearised(),
            blocks: self.blocks.linearised(),
            reference_delay: self.reference_delay,
            stage: match &self.stage {
                Stage::Current { params, every } => Stage::Current { params: params.linearised(), every: *every },
                Stage::Direct { gain } => Stage::Direct { gain: *gain },
            },
        }
    }
}

impl feedforward::Params {
    /// Without direction-dependent and constant efforts.
    #[must_use]
    pub const fn linearised(&self) -> Self {
        let Self { velocity, interpolate, model, coulomb: _, bias: _ } = *self;
        Self { velocity, interpolate, model, coulomb: 0.0, bias: 0.0 }
    }
}

impl current::Params {
    /// Without limits and dead time, and with the d-axis current at standstill: maximum torque per ampere has no slope there, and the
    /// voltage suffices.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self { motor, gains, d_reference, max_current: _, max_voltage: _, operation: _, dead_time: _ } = *self;
        Self {
            motor,
            gains,
            d_reference,
            max_current: f64::INFINITY,
            max_voltage: f64::INFINITY,
            operation: operating_point::Params::default(),
            dead_time: None,
        }
    }
}
