//! All that is known at one tick.
use servobench_base::{Dq, Request, RequestKind, Setpoint, Stateful};
use servobench_plant::BodyState;
use servobench_plant::inverter::{LinkPower, Ripple};
use servobench_plant::pmsm::{Power, Temperatures};

/// All that is known at tick k, before the integration to k+1. In the axis coordinate unless said otherwise.
#[derive(Debug, Clone, Copy, Default, Stateful)]
pub struct Instant {
    /// Request of the task to the load, where it is for a position or a velocity.
    pub request: Setpoint,
    /// The effort that it wants of the motor.
    pub requested_effort: f64,
    /// Which of them it wants.
    pub request_kind: RequestKind,
    /// Set-point of the motion task, before it goes over the bus.
    pub task: Setpoint,
    /// Actual position as the master reads it.
    pub bus_position: f64,
    /// What the master puts out, in units of the axis.
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
    /// What the load is to follow.
    pub reference: f64,
    /// What the motor is to follow.
    pub motor_reference: f64,
    /// Reference less position, of motor and load.
    pub following_error: [f64; 2],
    /// Velocity command.
    pub velocity_reference: f64,
    /// What the velocity loop asks for (motor coordinate).
    pub effort_reference: f64,
    /// What the motor gives (motor coordinate).
    pub effort: f64,
    /// Currents of the motor.
    pub current: Dq,
    /// Length of their vector over the tick that ends here, where the inverter switches.
    pub ripple: Ripple,
    /// q-axis current that is asked for.
    pub current_reference: f64,
    /// What the current loop computes at this tick.
    pub voltage_reference: Dq,
    /// What the inverter gives over the coming tick.
    pub voltage: Dq,
    /// Mean powers over the tick that ends here.
    pub power: Power,
    /// Temperatures of the motor; zero where nothing warms up.
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
    /// What the encoders of motor and load say.
    pub measured_position: [f64; 2],
    /// Velocity of the motor as the velocity loop saw it at its last cycle, where a method of the drive measures it.
    pub measured_velocity: f64,
    /// Currents of the motor as the current loop measured them at its last cycle.
    pub measured_current: Dq,
    /// What hardware says of itself at this tick.
    pub alarms: Alarms,
    /// Which limits bind at this tick.
    pub binds: PerLimit<bool>,
    /// In which share of the ticks since the last row they did.
    pub saturation: PerLimit<f64>,
}

impl Instant {
    /// Takes the request of the task. Where it wants no position, that is where the load is.
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

/// What hardware says of itself.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Stateful)]
pub struct Alarms {
    /// The DC link has less than half of its voltage.
    pub collapsed_link: bool,
    /// The encoder of the motor has found that its signals cannot be trusted.
    pub motor_encoder: bool,
    /// That of the load has.
    pub load_encoder: bool,
}

/// Something for each limit that is watched.
#[derive(Debug, Clone, Copy, Default, PartialEq, Stateful)]
pub struct PerLimit<T> {
    /// Voltage limit, which the current loop keeps to or the inverter enforces.
    pub voltage: T,
    /// Current limit, which cuts what the velocity loop asks for.
    pub current: T,
    /// Effort limit of the velocity loop.
    pub effort: T,
    /// Speed limit of the drive, which cuts what the position loop, or the master, asks for; no channel shows its share.
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
