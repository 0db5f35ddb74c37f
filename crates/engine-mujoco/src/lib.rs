//! `MuJoCo` behind servobench's [`Mechanics`] trait: chains of bodies by generated MJCF, and a user's own MJCF files.
//!
//! | what | how | order in the tick length |
//! |---|---|---|
//! | chain moved by efforts | RK4, efforts held over the tick | fourth |
//! | chain behind a prescribed base | the base is the frame of reference (`base.rs`) | fourth without damping, else second |
//! | dry friction | see [`servobench_plant::GroundFriction`]; stuck bodies keep their position bit for bit | second between the stops, first at each stop |
//! | a user's MJCF | the integrator of the file | as `MuJoCo` documents it |
//!
//! RK4 damps a mode of ω by ζ = (ω·h)⁵/144: below 1e-4 up to ω·h = 0.43, which is 1.1 kHz at 16 kHz. A chain for which it
//! would diverge, undamped from ω·h = 2.83 on, is refused (`stability.rs`).
//!
//! The library of `MuJoCo` is loaded at first use (`library.rs`): a program with this engine starts without it.
//!
//! A fatal error of `MuJoCo` **ends the process with exit code 1** after a line on standard error. A caller that must survive
//! that runs the engine in a separate process.

mod base;
mod chain;
mod library;
mod messages;
mod mjcf;
mod simulation;
mod stability;

use servobench_plant::{Engine, EngineName, Mechanics, MechanicsError, MechanicsSetup, Model};

const NAME: EngineName = EngineName::Mujoco;

/// The engine `mujoco`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Mujoco;

impl Engine for Mujoco {
    fn name(&self) -> EngineName {
        NAME
    }

    fn missing(&self) -> Option<String> {
        library::missing()
    }

    #[expect(clippy::match_wildcard_for_single_variants, reason = "all kinds that it does not list are refused alike")]
    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        setup.check()?;
        match &setup.model {
            Model::Chain(chain) => Ok(Box::new(chain::MujocoChain::new(chain.clone(), setup)?)),
            Model::Mjcf(model) => Ok(Box::new(mjcf::MujocoMjcf::new(model, setup)?)),
            other => Err(MechanicsError::not_simulated(NAME, other)),
        }
    }
}
