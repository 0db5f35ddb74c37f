//! Linearisation of the plant around a standstill: each part gives its linear part, sensors and inverter beside their parameters.
//!
//! Every field is named here, so that a new one does not compile until its treatment is decided.
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
    /// The source without its limit.
    #[must_use]
    pub const fn linearised(&self) -> Self {
        let Self { gain, output, limit: _ } = *self;
        Self { gain, output, limit: f64::INFINITY }
    }
}

impl Effects {
    /// The motor with the data `p` in the loop around a standstill: at the initial temperatures. Cogging, harmonics,
    /// saturation, losses in the iron and unequal phases are left out.
    #[must_use]
    pub fn linearised(&self, p: &pmsm::Params) -> pmsm::Params {
        let Self { cogging: _, flux_harmonics: _, iron: _, phase_resistance: _, temperature, flux_map: _ } = self;
        temperature.map_or(*p, |temperature| temperature.motor(p, temperature.start))
    }
}
