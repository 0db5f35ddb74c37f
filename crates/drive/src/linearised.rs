//! The firmware as a linear loop around a standstill: each block says what is linear in it.
//!
//! Every field is named here, so that a new one does not compile before somebody has said whether it stays ([`Params::linearised`]).
use crate::current::operating_point;
use crate::{Blocks, Params, Stage, current, feedforward, measurement, velocity};

impl Params {
    /// The same firmware without what is not linear: limits are infinite, what differs from one direction to the other and what depends on
    /// the speed or the position is off. Gains are those of a standstill; those at a speed of the gain schedule are so many times as large
    /// ([`schedule::Params::factors`](crate::schedule::Params::factors)).
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self {
            base_rate,
            transmission,
            position_gain,
            position_every,
            velocity: velocity::Params { k_p, integral_time, max_effort: _ },
            velocity_every,
            velocity_filter_time,
            feedforward,
            blocks,
            reference_delay,
            stage,
        } = self;
        Self {
            base_rate: *base_rate,
            transmission: *transmission,
            position_gain: *position_gain,
            position_every: *position_every,
            velocity: velocity::Params { k_p: *k_p, integral_time: *integral_time, max_effort: f64::INFINITY },
            velocity_every: *velocity_every,
            velocity_filter_time: *velocity_filter_time,
            feedforward: feedforward.linearised(),
            blocks: blocks.linearised(),
            reference_delay: *reference_delay,
            stage: match stage {
                Stage::Current { params, every } => Stage::Current { params: params.linearised(), every: *every },
                Stage::Direct { gain } => Stage::Direct { gain: *gain },
            },
        }
    }
}

impl Blocks {
    /// The blocks that are linear in what they see. The M/T method gives differences of positions, as finely as one likes.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self {
            filters,
            cogging: _,
            motor_load: _,
            drive_load: _,
            schedule: _,
            max_speed: _,
            reference_weight,
            supervision: _,
            measures_dc_link: _,
            measurement,
            acceleration,
            position,
        } = self;
        Self {
            filters: *filters,
            reference_weight: *reference_weight,
            measurement: measurement.map(|method| match method {
                measurement::Params::Difference | measurement::Params::Mt(_) => measurement::Params::Difference,
                measurement::Params::Observer(observer) => measurement::Params::Observer(observer),
            }),
            acceleration: *acceleration,
            position: *position,
            cogging: None,
            motor_load: None,
            drive_load: None,
            schedule: None,
            max_speed: f64::INFINITY,
            supervision: None,
            measures_dc_link: false,
        }
    }
}

impl feedforward::Params {
    /// Without what differs from one direction to the other, and without a constant.
    #[must_use]
    pub const fn linearised(&self) -> Self {
        let Self { velocity, interpolate, model, coulomb: _, bias: _ } = *self;
        Self { velocity, interpolate, model, coulomb: 0.0, bias: 0.0 }
    }
}

impl current::Params {
    /// Without limits and dead time, and with the d-axis current of a standstill: maximum torque per ampere has no slope there, and the
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
