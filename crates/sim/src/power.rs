//! Power stage: from the drive's command to the effort on the motor body.
use servobench_base::{AlphaBeta, Dq, ElectricalAngle, Rotation};
use servobench_drive::Command;
use servobench_plant::{BodyState, inverter, pmsm};

/// What stands between the drive and the mechanics.
#[derive(Debug, Clone)]
pub(crate) enum PowerStage {
    /// Inverter and synchronous motor.
    Pmsm {
        params: pmsm::Params,
        state: pmsm::State,
        /// DC-link voltage (V).
        u_dc: f64,
        /// Motor speed a tick ago (rad/s), to tell the mean over the coming tick.
        last_speed: f64,
        /// Rotor at this tick.
        rotor: Rotation,
    },
    /// Ideal source: effort = gain · output, |output| ≤ limit.
    Ideal { gain: f64, limit: f64 },
    /// Off, or a motor that follows its set-point: no effort.
    Off,
}

impl PowerStage {
    /// Stator current as the drive's sensors see it with the motor at `motor` (A, peak).
    pub(crate) fn measured_current(&mut self, motor: BodyState) -> AlphaBeta {
        match self {
            Self::Pmsm { params, state, rotor, .. } => {
                *rotor = ElectricalAngle::from_mechanical(motor.position, params.pole_pairs).rotation();
                state.current.to_alpha_beta(*rotor)
            }
            Self::Ideal { .. } | Self::Off => AlphaBeta::default(),
        }
    }

    /// Stator current in the rotor frame (A, peak).
    pub(crate) fn current(&self) -> Dq {
        match self {
            Self::Pmsm { state, .. } => state.current,
            Self::Ideal { .. } | Self::Off => Dq::default(),
        }
    }

    /// Output of an ideal source after its limit; 0 for others.
    pub(crate) fn output(&self, command: Command) -> f64 {
        match (self, command) {
            (Self::Ideal { limit, .. }, Command::Output(output)) => output.clamp(-limit, *limit),
            _ => 0.0,
        }
    }

    /// Goes from tick k to k+1 (`h` s) and returns the mean effort over it (N·m or N).
    pub(crate) fn advance(&mut self, command: Command, motor: BodyState, h: f64) -> f64 {
        let output = self.output(command);
        match (self, command) {
            (Self::Pmsm { params, state, u_dc, last_speed, rotor }, Command::Voltage(voltage)) => {
                // Straight on from the last two ticks: second order.
                let mean_speed = motor.velocity + (motor.velocity - *last_speed) / 2.0;
                *last_speed = motor.velocity;
                let input = pmsm::Input {
                    voltage: inverter::output(voltage, *u_dc),
                    rotor: *rotor,
                    omega_e: params.pole_pairs * mean_speed,
                };
                pmsm::step(params, state, input, h)
            }
            (Self::Ideal { gain, .. }, _) => *gain * output,
            _ => 0.0,
        }
    }
}
