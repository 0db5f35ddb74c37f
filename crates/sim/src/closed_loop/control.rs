//! The firmware with the sensors wired to it.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::network::Measurement;
use servobench_base::{PowerCommand, Stateful};
use servobench_drive::measurement::Edge;
use servobench_drive::unwrap::Unwrap;
use servobench_drive::velocity::Cut;
use servobench_drive::{self as drive, Demand, EffortLimits, Feedback, Sensors};
use servobench_plant::{self as plant, BodyState, EncoderState, PowerStage, Reading, SwitchReading};
use servobench_signals::{Instant, PerLimit};

/// The firmware and the sensors wired to it.
#[derive(Stateful)]
pub(crate) struct Control {
    #[state(constant)]
    pub(crate) params: drive::Params,
    pub(crate) state: drive::State,
    pub(crate) motor_encoder: EncoderInput,
    /// The encoder on the load, if it closes the position loop.
    #[state(fixed)]
    pub(crate) load_encoder: Option<EncoderInput>,
}

/// An encoder, with the drive's unwrapping of its limited range.
#[derive(Stateful)]
pub(crate) struct EncoderInput {
    pub(crate) encoder: EncoderState,
    #[state(fixed)]
    pub(crate) unwrap: Option<Unwrap>,
}

impl EncoderInput {
    #[inline(always)]
    pub(crate) fn read(&mut self, body: BodyState) -> Reading {
        let reading = self.encoder.read(body);
        match &mut self.unwrap {
            None => reading,
            Some(unwrap) => Reading { position: unwrap.position(reading.position), ..reading },
        }
    }
}

/// Mounting of the motor.
#[derive(Clone, Copy)]
pub(crate) struct Mounting {
    /// Axis coordinate per motor coordinate.
    pub(crate) transmission: f64,
    /// −1 for a motor mounted in reverse: the coordinates of motor, encoders and drive are then opposite to those of the
    /// mechanics; otherwise 1.
    pub(crate) direction: f64,
}

impl Mounting {
    /// A body of the mechanics in the coordinate of a motor or encoder mounted on it.
    #[inline(always)]
    pub(crate) fn seen(self, BodyState { position, velocity }: BodyState) -> BodyState {
        BodyState { position: self.direction * position, velocity: self.direction * velocity }
    }
}

impl Control {
    /// Reads the sensors on `motor` and `load`, as they are mounted. Writes alarms, and positions that differ from those of the bodies,
    /// to `now`.
    #[inline(always)]
    pub(super) fn measure(
        &mut self,
        [motor, load]: [BodyState; 2],
        Mounting { transmission, direction }: Mounting,
        power: &mut PowerStage,
        now: &mut Instant,
    ) -> Sensors {
        let reading = self.motor_encoder.read(motor);
        now.alarms.motor_encoder = reading.error;
        if self.motor_encoder.encoder.errs() {
            now.measured_position[0] = direction * transmission * reading.position;
        }
        Sensors {
            motor_position: reading.position,
            rotor_position: reading.to_rotor.map(|further| reading.position + further),
            motor_velocity: reading.velocity,
            motor_edge: reading.edge.map(|plant::Edge { age, offset }| Edge { age, offset }),
            feedback: match &mut self.load_encoder {
                None => Feedback::Motor,
                Some(input) => {
                    let Reading { position, error, .. } = input.read(load);
                    now.alarms.load_encoder = error;
                    if input.encoder.errs() {
                        now.measured_position[1] = direction * position;
                    }
                    Feedback::Load(position)
                }
            },
            current: power.measured_current(motor),
            dc_link: now.dc_link,
            winding: now.temperatures.winding,
            known_rotation: power.rotation(),
        }
    }

    /// A tick of the firmware.
    #[inline(always)]
    pub(super) fn step(&mut self, demand: &Demand, limits: EffortLimits, sensors: &Sensors) -> PowerCommand {
        drive::step(&self.params, &mut self.state, demand, limits, sensors)
    }

    /// Position that closes the position loop (axis coordinate).
    pub(super) fn closing_position(&self, sensors: &Sensors) -> f64 {
        match sensors.feedback {
            Feedback::Motor => self.params.transmission * sensors.motor_position,
            Feedback::Load(position) => position,
        }
    }

    /// Measurement for the bus interface of the drive.
    pub(super) fn measurement(&self, sensors: &Sensors, now: &Instant, switches: SwitchReading) -> Measurement {
        let Self { params, state, .. } = self;
        Measurement {
            position: sensors.closing_position(),
            velocity: state.velocity(params),
            effort: state.held().effort.effort,
            effort_is_cut: state.held().effort.cut.is_some(),
            following_error: state.following_error(params, sensors),
            is_overloaded: state.is_overloaded(params),
            encoder_errors: [now.alarms.motor_encoder, now.alarms.load_encoder],
            finding: state.finding(),
            switches,
        }
    }

    /// Writes references, currents and active limits of the loops to `now`, in the `direction` of the axis. `cuts_velocity`: true if the
    /// drive cuts it, true if the master does.
    #[inline(always)]
    pub(super) fn show(&self, direction: f64, cuts_velocity: [bool; 2], now: &mut Instant) {
        let Self { params, state, .. } = self;
        let held = state.held();
        now.velocity_reference = direction * held.velocity_reference;
        now.effort_reference = held.effort.effort;
        now.current_reference = held.current_reference;
        now.voltage_reference = held.current.computed;
        now.measured_current = held.current.current;
        if params.blocks.measurement.is_some() {
            now.measured_velocity = direction * state.velocity(params);
        }
        now.binds = PerLimit {
            voltage: held.current.saturated,
            current: held.effort.cut == Some(Cut::Available),
            effort: held.effort.cut == Some(Cut::Effort),
            speed: held.speed_is_cut | cuts_velocity[0],
            master: cuts_velocity[1],
        };
    }
}
