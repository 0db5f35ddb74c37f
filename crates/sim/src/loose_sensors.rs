//! The sensors of an axis whose drive is replaced by an FMU, which reads them.
use crate::closed_loop::{EncoderInput, Mounting};
use servobench_base::Stateful;
use servobench_plant::{BodyState, PowerStage};
use servobench_signals::Instant;

/// Encoders and current sensors that no firmware reads.
#[derive(Stateful)]
pub(crate) struct LooseSensors {
    pub(crate) motor_encoder: EncoderInput,
    #[state(fixed)]
    pub(crate) load_encoder: Option<EncoderInput>,
    /// True if the currents are measured: with voltage control of a synchronous motor.
    #[state(constant)]
    pub(crate) has_current: bool,
    /// True if the next tick has been read already.
    is_read: bool,
}

impl LooseSensors {
    pub(crate) const fn new(
        motor_encoder: EncoderInput,
        load_encoder: Option<EncoderInput>,
        has_current: bool,
    ) -> Self {
        Self { motor_encoder, load_encoder, has_current, is_read: false }
    }

    /// Reads the next tick, if that has not been done, and writes the readings to `now`. `motor` (its own coordinate) and `load` are
    /// as mounted.
    pub(crate) fn look_ahead(
        &mut self,
        [motor, load]: [BodyState; 2],
        Mounting { transmission, direction }: Mounting,
        power: &mut PowerStage,
        now: &mut Instant,
    ) {
        if std::mem::replace(&mut self.is_read, true) {
            return;
        }
        now.measured_position[0] = direction * transmission * self.motor_encoder.read(motor).position;
        if let Some(encoder) = &mut self.load_encoder {
            now.measured_position[1] = direction * encoder.read(load).position;
        }
        if self.has_current {
            let current = power.measured_current(motor);
            now.measured_current = current.to_dq(power.rotation().rotation());
        }
    }

    /// Reads the sensors at the tick itself, after which the next one follows.
    pub(crate) fn read(
        &mut self,
        bodies: [BodyState; 2],
        mounting: Mounting,
        power: &mut PowerStage,
        now: &mut Instant,
    ) {
        self.look_ahead(bodies, mounting, power, now);
        self.is_read = false;
    }
}
