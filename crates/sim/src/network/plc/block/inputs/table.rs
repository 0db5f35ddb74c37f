//! The inputs of the blocks that follow a table, which a call keeps and lends to its block.
use super::buffer_mode;
use servobench_plcopen as plcopen;
use servobench_plcopen::Pair;
use servobench_scenario as scenario;
use servobench_scenario::Block as Said;

/// A table of positions.
#[derive(Clone)]
pub(in super::super) struct Positions {
    pairs: Vec<Pair>,
    scales: scenario::Scales,
    is_absolute: bool,
    follow: plcopen::Follow,
    end_velocity: f64,
    buffer_mode: plcopen::BufferMode,
}

impl Positions {
    pub(in super::super) fn of(said: &Said) -> Option<Self> {
        let Said::PositionProfile { pairs: said, scales, is_relative, follow, end_velocity, buffer_mode: mode } = said
        else {
            return None;
        };
        let follow = match *follow {
            scenario::ProfileFollow::Spline => plcopen::Follow::Spline,
            scenario::ProfileFollow::Plateaus(share) => plcopen::Follow::Plateaus(share),
        };
        let (is_absolute, end_velocity, buffer_mode) = (!is_relative, *end_velocity, buffer_mode(*mode));
        Some(Self { pairs: pairs(said), scales: *scales, is_absolute, follow, end_velocity, buffer_mode })
    }

    pub(in super::super) fn inputs(&self) -> plcopen::PositionProfileInputs<'_> {
        let Self { ref pairs, scales, is_absolute, follow, end_velocity, buffer_mode } = *self;
        plcopen::PositionProfileInputs {
            time_scale: scales.time,
            position_scale: scales.value,
            offset: scales.offset,
            time_position: plcopen::TimePosition { pairs, is_absolute },
            follow,
            end_velocity,
            buffer_mode,
            ..plcopen::PositionProfileInputs::along(pairs)
        }
    }
}

/// A table of velocities or accelerations.
#[derive(Clone)]
pub(in super::super) struct Rates {
    pairs: Vec<Pair>,
    scales: scenario::Scales,
    buffer_mode: plcopen::BufferMode,
}

impl Rates {
    pub(in super::super) fn of_velocities(said: &Said) -> Option<Self> {
        let Said::VelocityProfile { pairs: said, scales, buffer_mode: mode } = said else { return None };
        Some(Self { pairs: pairs(said), scales: *scales, buffer_mode: buffer_mode(*mode) })
    }

    pub(in super::super) fn of_accelerations(said: &Said) -> Option<Self> {
        let Said::AccelerationProfile { pairs: said, scales, buffer_mode: mode } = said else { return None };
        Some(Self { pairs: pairs(said), scales: *scales, buffer_mode: buffer_mode(*mode) })
    }

    pub(in super::super) fn velocities(&self) -> plcopen::VelocityProfileInputs<'_> {
        let Self { ref pairs, scales, buffer_mode } = *self;
        plcopen::VelocityProfileInputs {
            time_scale: scales.time,
            velocity_scale: scales.value,
            offset: scales.offset,
            buffer_mode,
            ..plcopen::VelocityProfileInputs::along(pairs)
        }
    }

    pub(in super::super) fn accelerations(&self) -> plcopen::AccelerationProfileInputs<'_> {
        let Self { ref pairs, scales, buffer_mode } = *self;
        plcopen::AccelerationProfileInputs {
            time_scale: scales.time,
            acceleration_scale: scales.value,
            offset: scales.offset,
            buffer_mode,
            ..plcopen::AccelerationProfileInputs::along(pairs)
        }
    }
}

fn pairs(said: &[scenario::Pair]) -> Vec<Pair> {
    said.iter().map(|&scenario::Pair { delta_time, value }| Pair { delta_time, value }).collect()
}
