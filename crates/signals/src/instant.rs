//! The state of a run at one tick.
use servobench_base::{Dq, Request, RequestKind, Setpoint, Stateful};
use servobench_plant::BodyState;
use servobench_plant::inverter::{LinkPower, Ripple};
use servobench_plant::pmsm::{Power, Temperatures};

/// All values at tick k, before the integration to k+1. In the axis coordinate unless noted.
#[derive(Debug, Clone, Copy, Default, Stateful)]
pub struct Instant {
    /// Request of the task to the load, if it is for a position or a velocity.
    pub request: Setpoint,
    /// Requested effort of the motor.
    pub requested_effort: f64,
    /// Kind of the request.
    pub request_kind: RequestKind,
    /// Set-point of the motion task, before the bus.
    pub task: Setpoint,
    /// Actual position read by the master.
    pub bus_position: f64,
    /// Output of the master, in units of the axis.
    pub put_out: Setpoint,
    /// The effort beside it (motor coordinate).
    pub put_out_effort: f64,
    /// The set-point.
    pub setpoint: Setpoint,
    /// The motor.
    pub motor: BodyState,
    /// The body between motor and load.
    pub table: BodyState,
    /// The load.
    pub load: BodyState,
    /// Position that the load is to follow.
    pub reference: f64,
    /// Position that the motor is to follow.
    pub motor_reference: f64,
    /// Reference less position, of motor and load.
    pub following_error: [f64; 2],
    /// Velocity command.
    pub velocity_reference: f64,
    /// Effort requested by the velocity loop (motor coordinate).
    pub effort_reference: f64,
    /// Effort of the motor (motor coordinate).
    pub effort: f64,
    /// Currents of the motor.
    pub current: Dq,
    /// Length of their vector over the tick that ends here, with a switching inverter.
    pub ripple: Ripple,
    /// Requested q-axis current.
    pub current_reference: f64,
    /// Voltage computed by the current loop at this tick.
    pub voltage_reference: Dq,
    /// Voltage of the inverter over the coming tick.
    pub voltage: Dq,
    /// Mean powers over the tick that ends here.
    pub power: Power,
    /// Temperatures of the motor; zero without warming.
    pub temperatures: Temperatures,
    /// Mean loss of the inverter over the tick that ends here.
    pub inverter_loss: f64,
    /// Voltage of the DC link at this tick.
    pub dc_link: f64,
    /// Mean power from the mains into the link, and into its brake resistor, over the tick that ends here.
    pub link_power: LinkPower,
    /// Mean power on the shaft over the tick that ends here.
    pub shaft_power: f64,
    /// Output of an ideal source.
    pub output: f64,
    /// External effort on the motor over the coming tick (motor coordinate).
    pub motor_disturbance: f64,
    /// External effort on the load over the coming tick.
    pub load_disturbance: f64,
    /// Effort of the end stops on the load over the coming tick.
    pub end_stop: f64,
    /// Positions measured by the encoders of motor and load.
    pub measured_position: [f64; 2],
    /// Velocity of the motor at the last cycle of the velocity loop, if a separate method of the drive measures it.
    pub measured_velocity: f64,
    /// Currents of the motor, measured at the last cycle of the current loop.
    pub measured_current: Dq,
    /// Alarms of the hardware at this tick.
    pub alarms: Alarms,
    /// Limits that bind at this tick.
    pub binds: PerLimit<bool>,
    /// Share of the ticks since the last row in which each of them bound.
    pub saturation: PerLimit<f64>,
}

impl Instant {
    /// Takes the request of the task. Without a requested position, the position is that of the load.
    #[inline]
    pub fn ask(&mut self, request: Request) {
        let here = self.load.position;
        self.request_kind = request.kind();
        (self.request, self.requested_effort) = match request {
            Request::Nothing | Request::Stand => (Setpoint::at_rest(here), 0.0),
            Request::Rest(x) => (Setpoint::at_rest(x), 0.0),
            Request::Follow(setpoint) => (setpoint, 0.0),
            Request::Velocity(v) => (Setpoint { v, ..Setpoint::at_rest(here) }, 0.0),
            Request::Effort(effort) => (Setpoint::at_rest(here), effort),
        };
    }
}

/// Alarms of the hardware.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Stateful)]
pub struct Alarms {
    /// The DC link has less than half of its voltage.
    pub collapsed_link: bool,
    /// The encoder of the motor has found that its signals cannot be trusted.
    pub motor_encoder: bool,
    /// The encoder of the load has found the same.
    pub load_encoder: bool,
}

/// A value for each monitored limit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Stateful)]
pub struct PerLimit<T> {
    /// Voltage limit, which the current loop keeps or the inverter enforces.
    pub voltage: T,
    /// Current limit, which cuts the request of the velocity loop.
    pub current: T,
    /// Effort limit of the velocity loop.
    pub effort: T,
    /// Speed limit of the drive, which cuts the request of the position loop, or of the master; no channel shows its share.
    pub speed: T,
    /// Velocity limit of the master; no channel shows its share.
    pub master: T,
}

impl PerLimit<&'static str> {
    /// Name of each limit in recordings and reports.
    pub const NAMES: Self = Self {
        voltage: "voltage limit",
        current: "current limit",
        effort: "effort limit",
        speed: "speed limit",
        master: "velocity limit of the master",
    };
}
