//! What the firmware of a scenario knows: gains, limits, rates and estimates.
use crate::error::BuildError;
use servobench_base::{Dq, Rate};
use servobench_drive::{self as drive, current, feedforward, velocity};
use servobench_plant::inverter;
use servobench_scenario::{self as scenario, Scenario};

/// Parameters of the firmware.
pub(super) fn params(scenario: &Scenario) -> Result<drive::Params, BuildError> {
    let (drive, estimate) = (&scenario.drive, &scenario.drive.estimate);
    let base_rate = scenario.base_rate;
    let stage = match (&scenario.motor, &estimate.motor, &drive.current) {
        (scenario::Motor::IdealSource(source), ..) => drive::Stage::Direct { gain: source.gain },
        (_, Some(motor), Some(current)) => current_stage(base_rate, drive.dc_link, motor, current)?,
        _ => {
            return Err(BuildError::Contradiction("a synchronous motor needs a `[drive.current]`"));
        }
    };
    let model = match drive.feedforward.effort {
        scenario::EffortFeedforward::Off => feedforward::Model::Off,
        scenario::EffortFeedforward::Rigid => feedforward::Model::Rigid {
            inertia: estimate.motor_inertia + estimate.load_inertia,
            viscous: estimate.motor_viscous + estimate.load_viscous,
        },
        scenario::EffortFeedforward::TwoMass => feedforward::Model::TwoMass {
            motor_inertia: estimate.motor_inertia,
            load_inertia: estimate.load_inertia,
            stiffness: estimate.stiffness,
            motor_viscous: estimate.motor_viscous,
            load_viscous: estimate.load_viscous,
        },
    };
    let friction = |value: f64| if drive.feedforward.friction { value } else { 0.0 };
    let mut params = drive::Params {
        base_rate,
        transmission: scenario.axis.transmission,
        position_gain: drive.position.gain,
        feedback: match drive.position_feedback {
            scenario::Feedback::Motor => drive::Feedback::Motor,
            scenario::Feedback::Load => drive::Feedback::Load,
        },
        position_every: base_rate.divider(drive.position.rate)?,
        velocity: velocity::Params {
            k_p: drive.velocity.gain,
            integral_time: drive.velocity.integral_time,
            max_effort: drive.max_effort,
        },
        velocity_every: base_rate.divider(drive.velocity.rate)?,
        velocity_filter_time: drive.velocity.filter_time,
        feedforward: feedforward::Params {
            velocity: drive.feedforward.velocity,
            model,
            coulomb: friction(estimate.coulomb),
            bias: friction(estimate.bias),
        },
        reference_delay: 0.0,
        stage,
    };
    // Without effort feedforward there is nothing to wait for.
    let path = if model == feedforward::Model::Off { 0.0 } else { params.effort_path_delay() };
    params.reference_delay = drive.feedforward.delay.unwrap_or(path);
    Ok(params)
}

fn current_stage(
    base_rate: Rate,
    dc_link: f64,
    motor: &scenario::Pmsm,
    current: &scenario::CurrentLoop,
) -> Result<drive::Stage, BuildError> {
    let estimate = current::MotorEstimate {
        pole_pairs: motor.electrical_ratio,
        resistance: motor.resistance,
        inductance: Dq { d: motor.inductance_d, q: motor.inductance_q },
        flux_linkage: motor.flux_linkage,
    };
    let max_voltage = inverter::voltage_limit(dc_link);
    let mut params = current::Params::from_bandwidth(estimate, current.bandwidth, max_voltage)?;
    if let Some((d, q)) = current.gain {
        params.k_p = Dq { d, q };
    }
    if let Some((d, q)) = current.integral_time {
        params.k_i = Dq { d: params.k_p.d / d, q: params.k_p.q / q };
    }
    Ok(drive::Stage::Current { params, every: base_rate.divider(current.rate)? })
}
