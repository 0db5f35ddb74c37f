//! The plant as a linear one around a standstill: each part says what is linear in it.
//!
//! Every field is named here, so that a new one does not compile before somebody has said whether it stays.
use crate::pmsm::{self, Effects};
use crate::sensor::{CurrentSensor, Encoder, EncoderErrors};
use crate::{Body, Chain, Friction, IdealSource, inverter};

impl Friction {
    /// Its part that is proportional to the velocity.
    #[must_use]
    pub const fn linearised(&self) -> Self {
        let Self { viscous, dry: _ } = *self;
        Self { viscous, ..Self::NONE }
    }
}

impl Chain {
    /// The same bodies without dry friction and without constant efforts.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let mut chain = self.clone();
        for body in chain.bodies_mut() {
            let Body { name, coordinate, inertia, transmission, friction, bias: _ } = body.clone();
            *body = Body { name, coordinate, inertia, transmission, friction: friction.linearised(), bias: 0.0 };
        }
        chain
    }
}

impl IdealSource {
    /// Without a limit.
    #[must_use]
    pub const fn linearised(&self) -> Self {
        let Self { gain, output, limit: _ } = *self;
        Self { gain, output, limit: f64::INFINITY }
    }
}

impl Effects {
    /// The motor with the data `p` as the loop around a standstill has it: at the temperatures of the beginning. Cogging, harmonics,
    /// saturation, losses in the iron and unequal phases are left out.
    #[must_use]
    pub fn linearised(&self, p: &pmsm::Params) -> pmsm::Params {
        let Self { cogging: _, flux_harmonics: _, iron: _, phase_resistance: _, temperature, flux_map: _ } = self;
        temperature.map_or(*p, |temperature| temperature.motor(p, temperature.start))
    }
}

impl inverter::Params {
    /// The motor with the data `p` behind the devices that conduct: of the inverter their resistance alone is linear.
    #[must_use]
    pub fn linearised(&self, p: &pmsm::Params) -> pmsm::Params {
        let Self { modulation: _, carrier: _, dead_time: _, device_drop: _, on_resistance } = *self;
        pmsm::Params { resistance: p.resistance + on_resistance, ..*p }
    }
}

impl Encoder {
    /// As late as it is, and with the commutation that is off by as much; without increments, noise and errors that repeat. Where the
    /// one that it stands for gives positions alone, so must it be read.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self { increment: _, errors } = *self;
        Self { increment: None, errors: errors.as_ref().map(EncoderErrors::linearised) }
    }
}

impl EncoderErrors {
    fn linearised(&self) -> Self {
        let Self {
            signals: _,
            eccentricity: _,
            eccentricity_angle: _,
            zero: _,
            commutation,
            noise: _,
            seed: _,
            latency,
            range: _,
        } = *self;
        Self { commutation, latency, ..Self::default() }
    }
}

impl CurrentSensor {
    /// As late as it is, and with its gains; without offsets, noise, steps and range.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self { offset: _, gain_error, noise: _, seed: _, converter: _, delay, shift } = *self;
        Self { gain_error, delay, shift, ..Self::default() }
    }
}
