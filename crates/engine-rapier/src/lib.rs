//! Rapier behind servobench's [`Mechanics`] trait.

mod chain;
mod half_kick;
mod lumps;
mod scene;

use chain::LumpChain;
use servobench_plant::{Chain, Engine, Mechanics, MechanicsError, MechanicsSetup, Model};

const NAME: &str = "rapier";

/// The engine `rapier`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rapier;

impl Engine for Rapier {
    fn name(&self) -> &'static str {
        NAME
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        servobench_base::positive("step", setup.step)?;
        for state in &setup.initial {
            servobench_base::finite("initial position", state.position)?;
            servobench_base::finite("initial velocity", state.velocity)?;
        }
        match &setup.model {
            Model::Chain(chain) => Ok(match chain.bodies().len() {
                1 => Box::new(LumpChain::<1>::new(chain, setup)?),
                2 => Box::new(LumpChain::<2>::new(chain, setup)?),
                3 => Box::new(LumpChain::<3>::new(chain, setup)?),
                _ => Box::new(LumpChain::<{ Chain::MAX_BODIES }>::new(chain, setup)?),
            }),
            Model::Mjcf(model) => Err(MechanicsError::Unsupported {
                engine: NAME,
                what: format!("MJCF files ({})", model.path.display()),
                way_out: "choose the engine `mujoco`, or describe the axis by its bodies".into(),
            }),
        }
    }
}

/// The actuation is not the one that the mechanics were built for.
fn wrong_actuation() -> MechanicsError {
    MechanicsError::Unsupported {
        engine: NAME,
        what: "an actuation other than the one it was built for".into(),
        way_out: "use efforts with `Drive::Effort` and motions with `Drive::Prescribed`".into(),
    }
}
