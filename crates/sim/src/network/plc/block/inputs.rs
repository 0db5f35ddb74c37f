//! The inputs of the blocks, from how a scenario says them; `None` for those of another block.
mod table;

pub(super) use table::{Positions, Rates};

use servobench_motion::Limits;
use servobench_plcopen as plcopen;
use servobench_plcopen::generator::Mounting;
use servobench_scenario as scenario;
use servobench_scenario::Block as Said;

pub(super) fn power(said: &Said) -> Option<plcopen::PowerInputs> {
    let Said::Power { positive: enable_positive, negative: enable_negative } = *said else { return None };
    Some(plcopen::PowerInputs { enable: false, enable_positive, enable_negative })
}

pub(super) fn reading(said: &Said) -> Option<plcopen::ReadInputs> {
    let is_reading = matches!(
        said,
        Said::ReadStatus
            | Said::ReadAxisError
            | Said::ReadActualPosition
            | Said::ReadActualVelocity
            | Said::ReadActualTorque
    );
    is_reading.then_some(plcopen::ReadInputs { enable: false })
}

pub(super) fn reset(said: &Said) -> Option<plcopen::ResetInputs> {
    matches!(said, Said::Reset).then_some(plcopen::ResetInputs { execute: false })
}

pub(super) fn home(said: &Said) -> Option<plcopen::HomeInputs> {
    let Said::Home { position, buffer_mode: mode } = said else { return None };
    Some(plcopen::HomeInputs { execute: false, position: *position, buffer_mode: buffer_mode(*mode) })
}

pub(super) fn stop(said: &Said) -> Option<plcopen::StopInputs> {
    let Said::Stop(scenario::Braking { deceleration, jerk, snap }) = said else { return None };
    Some(plcopen::StopInputs { execute: false, deceleration: *deceleration, jerk: finite(*jerk), snap: finite(*snap) })
}

pub(super) fn halt(said: &Said) -> Option<plcopen::HaltInputs> {
    let Said::Halt { braking: scenario::Braking { deceleration, jerk, snap }, buffer_mode: mode } = said else {
        return None;
    };
    Some(plcopen::HaltInputs {
        execute: false,
        deceleration: *deceleration,
        jerk: finite(*jerk),
        snap: finite(*snap),
        buffer_mode: buffer_mode(*mode),
    })
}

pub(super) fn move_absolute(said: &Said) -> Option<plcopen::MoveAbsoluteInputs> {
    let Said::MoveAbsolute { position, direction: way, dynamics, command } = said else { return None };
    Some(plcopen::MoveAbsoluteInputs {
        execute: false,
        continuous_update: command.continuous_update,
        position: *position,
        velocity: dynamics.velocity,
        acceleration: dynamics.acceleration,
        deceleration: dynamics.deceleration,
        jerk: finite(dynamics.jerk),
        snap: finite(dynamics.snap),
        direction: direction(*way),
        buffer_mode: buffer_mode(command.buffer_mode),
    })
}

pub(super) fn move_relative(said: &Said) -> Option<plcopen::MoveRelativeInputs> {
    let Said::MoveRelative { distance, dynamics, command } = said else { return None };
    Some(plcopen::MoveRelativeInputs {
        execute: false,
        continuous_update: command.continuous_update,
        distance: *distance,
        velocity: dynamics.velocity,
        acceleration: dynamics.acceleration,
        deceleration: dynamics.deceleration,
        jerk: finite(dynamics.jerk),
        snap: finite(dynamics.snap),
        buffer_mode: buffer_mode(command.buffer_mode),
    })
}

pub(super) fn move_additive(said: &Said) -> Option<plcopen::MoveAdditiveInputs> {
    let Said::MoveAdditive { distance, dynamics, command } = said else { return None };
    Some(plcopen::MoveAdditiveInputs {
        execute: false,
        continuous_update: command.continuous_update,
        distance: *distance,
        velocity: dynamics.velocity,
        acceleration: dynamics.acceleration,
        deceleration: dynamics.deceleration,
        jerk: finite(dynamics.jerk),
        snap: finite(dynamics.snap),
        buffer_mode: buffer_mode(command.buffer_mode),
    })
}

pub(super) fn move_superimposed(said: &Said) -> Option<plcopen::MoveSuperimposedInputs> {
    let Said::MoveSuperimposed { distance, dynamics, continuous_update } = said else { return None };
    Some(plcopen::MoveSuperimposedInputs {
        execute: false,
        continuous_update: *continuous_update,
        distance: *distance,
        velocity_diff: dynamics.velocity,
        acceleration: dynamics.acceleration,
        deceleration: dynamics.deceleration,
        jerk: finite(dynamics.jerk),
        snap: finite(dynamics.snap),
    })
}

pub(super) fn move_velocity(said: &Said) -> Option<plcopen::MoveVelocityInputs> {
    let Said::MoveVelocity { velocity, direction: way, dynamics, command } = said else { return None };
    Some(plcopen::MoveVelocityInputs {
        execute: false,
        continuous_update: command.continuous_update,
        velocity: *velocity,
        acceleration: dynamics.acceleration,
        deceleration: dynamics.deceleration,
        jerk: finite(dynamics.jerk),
        snap: finite(dynamics.snap),
        direction: direction(*way),
        buffer_mode: buffer_mode(command.buffer_mode),
    })
}

pub(super) fn move_continuous_absolute(said: &Said) -> Option<plcopen::MoveContinuousAbsoluteInputs> {
    let Said::MoveContinuousAbsolute { position, end_velocity, direction: way, dynamics, command } = said else {
        return None;
    };
    Some(plcopen::MoveContinuousAbsoluteInputs {
        execute: false,
        continuous_update: command.continuous_update,
        position: *position,
        end_velocity: *end_velocity,
        velocity: dynamics.velocity,
        acceleration: dynamics.acceleration,
        deceleration: dynamics.deceleration,
        jerk: finite(dynamics.jerk),
        snap: finite(dynamics.snap),
        direction: direction(*way),
        buffer_mode: buffer_mode(command.buffer_mode),
    })
}

pub(super) fn set_position(said: &Said) -> Option<plcopen::SetPositionInputs> {
    let Said::SetPosition { position, relative } = said else { return None };
    Some(plcopen::SetPositionInputs { execute: false, position: *position, relative: *relative })
}

pub(super) fn set_override(said: &Said) -> Option<plcopen::SetOverrideInputs> {
    let Said::SetOverride { factors: [vel_factor, acc_factor, jerk_factor] } = said else { return None };
    Some(plcopen::SetOverrideInputs {
        enable: false,
        vel_factor: *vel_factor,
        acc_factor: *acc_factor,
        jerk_factor: *jerk_factor,
    })
}

pub(super) fn torque_control(said: &Said) -> Option<plcopen::TorqueControlInputs> {
    let Said::TorqueControl { torque, torque_ramp, velocity, direction: way, command } = said else { return None };
    Some(plcopen::TorqueControlInputs {
        execute: false,
        continuous_update: command.continuous_update,
        torque: *torque,
        torque_ramp: *torque_ramp,
        velocity: *velocity,
        direction: direction(*way),
        buffer_mode: buffer_mode(command.buffer_mode),
    })
}

pub(super) fn profile_4th(said: &Said) -> Option<plcopen::Profile4thInputs> {
    let Said::Profile4th { position, limits: [velocity, acceleration, jerk, snap], settling_time, reversed } = *said
    else {
        return None;
    };
    Some(plcopen::Profile4thInputs {
        enable: false,
        position,
        limits: Limits { velocity, acceleration, jerk, snap },
        settling_time,
        mounting: if reversed { Mounting::Opposite } else { Mounting::Same },
    })
}

/// An input that is left to the axis where it is infinite.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

const fn buffer_mode(mode: scenario::BufferMode) -> plcopen::BufferMode {
    match mode {
        scenario::BufferMode::Aborting => plcopen::BufferMode::Aborting,
        scenario::BufferMode::Buffered => plcopen::BufferMode::Buffered,
        scenario::BufferMode::BlendingLow => plcopen::BufferMode::BlendingLow,
        scenario::BufferMode::BlendingPrevious => plcopen::BufferMode::BlendingPrevious,
        scenario::BufferMode::BlendingNext => plcopen::BufferMode::BlendingNext,
        scenario::BufferMode::BlendingHigh => plcopen::BufferMode::BlendingHigh,
    }
}

const fn direction(direction: scenario::Direction) -> plcopen::Direction {
    match direction {
        scenario::Direction::Positive => plcopen::Direction::Positive,
        scenario::Direction::Negative => plcopen::Direction::Negative,
        scenario::Direction::Shortest => plcopen::Direction::Shortest,
        scenario::Direction::Current => plcopen::Direction::Current,
    }
}
