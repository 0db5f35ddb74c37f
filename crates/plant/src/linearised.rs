//! The plant as a linear one around a standstill: each part says what is linear in it, sensors and inverter beside their parameters.
//!
//! Every field is named here, so that a new one does not compile before somebody has said whether it stays.
use crate::pmsm::{self, Effects};
use crate::{Body, Chain, Friction, IdealSource};

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
