//! What the firmware of a scenario knows: gains, limits, rates and estimates. Nothing here sees the plant.
use crate::error::BuildError;
use servobench_base::{Dq, Rate};
use servobench_drive::{self as drive, current, delay, feedforward, velocity};
use servobench_scenario as scenario;

/// Parameters of the firmware that is set as `drive` says, hears its set-points over `bus` and commands `stage`.
pub(crate) fn params(
    base_rate: Rate,
    drive: &scenario::Drive,
    bus: Option<&scenario::Bus>,
    stage: drive::Stage,
) -> Result<drive::Params, BuildError> {
    let estimate = &drive.estimate;
    let model = model(estimate, drive.feedforward.effort);
    let friction = |value: f64| if drive.feedforward.friction { value } else { 0.0 };
    let mut params = drive::Params {
        base_rate,
        transmission: estimate.transmission,
        position_gain: drive.position.gain,
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
            interpolate: drive.feedforward.interpolate,
            model,
            coulomb: friction(estimate.coulomb),
            bias: friction(estimate.bias),
        },
        reference_delay: delay::Params::default(),
        stage,
    };
    // Without effort feedforward, the drive's own or the master's, there is nothing to wait for.
    let sent = bus.is_some_and(|bus| bus.effort_offset != scenario::EffortFeedforward::Off);
    let path = if model == feedforward::Model::Off && !sent { 0.0 } else { params.effort_path_delay() };
    let delay = drive.feedforward.delay.unwrap_or(path);
    params.reference_delay = delay::Params::new(delay, params.period(params.position_every))?;
    Ok(params)
}

/// The model of an axis of which `estimate` is known.
pub(crate) fn model(estimate: &scenario::Estimate, effort: scenario::EffortFeedforward) -> feedforward::Model {
    match effort {
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
    }
}

/// The current loop of a synchronous motor.
pub(crate) fn current_stage(base_rate: Rate, current: &scenario::CurrentLoop) -> Result<drive::Stage, BuildError> {
    let scenario::MotorEstimate { electrical_ratio, resistance, inductance_d, inductance_q, flux_linkage } =
        current.motor;
    let motor = current::MotorEstimate {
        electrical_ratio,
        resistance,
        inductance: Dq { d: inductance_d, q: inductance_q },
        flux_linkage,
    };
    let derived = match current.gain {
        scenario::CurrentGain::Bandwidth(alpha) => current::Gains::from_bandwidth(&motor, alpha),
        scenario::CurrentGain::PerAxis { d, q } => current::Gains::cancelling(&motor, Dq { d, q }),
    };
    let gains = match current.integral_time {
        Some((d, q)) => current::Gains::with_integral_times(derived.k_p, Dq { d, q }),
        None => derived,
    };
    let max_voltage = current::voltage_limit(current.dc_link);
    let scenario::CurrentLoop { d_reference, max_current, .. } = *current;
    let params = current::Params { motor, gains, d_reference, max_current, max_voltage };
    Ok(drive::Stage::Current { params, every: base_rate.divider(current.rate)? })
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenario::Actuator;

    /// The integral gains of the current loop of a drive with `current` in its file, on a motor that it believes to have
    /// 4 Ω, 20 mH and 50 mH.
    fn integral_gains(current: &str) -> Dq {
        let text = format!(
            r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
[motor]
model = "saarakkala-2.2kw"
[drive]
model = "servo-16khz"
current = {{ {current} }}
estimate.motor = {{ resistance = "4 Ohm", inductance_d = "20 mH", inductance_q = "50 mH" }}
"#
        );
        let parsed = scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
        let Actuator::Pmsm { current, .. } = parsed.actuator else { panic!("a synchronous motor") };
        let drive::Stage::Current { params, .. } = current_stage(parsed.base_rate, &current).unwrap() else {
            panic!("a current loop")
        };
        params.gains.k_i
    }

    /// Oracle: by hand. k_i = k_p/T_i per axis: α·R with k_p = α·L, k_p·R/L with gains that are given, or as given.
    #[test]
    fn the_integral_gain_follows_from_the_estimate_on_each_axis() {
        for (current, d, q) in [
            ("bandwidth = \"1000 rad/s\"", 4000.0, 4000.0),
            ("gain_d = \"10 V/A\", gain_q = \"10 V/A\"", 2000.0, 800.0),
            (
                "gain_d = \"10 V/A\", gain_q = \"10 V/A\", integral_time_d = \"10 ms\", integral_time_q = \"20 ms\"",
                1000.0,
                500.0,
            ),
        ] {
            let found = integral_gains(current);
            assert!((found.d / d - 1.0).abs() < 1e-14 && (found.q / q - 1.0).abs() < 1e-14, "{current}: {found:?}");
        }
    }
}
