//! Rapier behind servobench's [`Mechanics`] trait: chains of lumped bodies, and a subset of users' MJCF files. 64-bit
//! floats, `enhanced-determinism`, one substep to a tick.
//!
//! | what | how | order in the tick length h |
//! |---|---|---|
//! | chain moved by efforts | a sliding body for each lump (`lumps.rs`); half kick – drift – half kick, the drift Rapier's | second, damped or not |
//! | chain behind a prescribed base | the links see the base at both ends of the tick | second |
//! | dry friction of a chain | see [`servobench_plant::GroundFriction`]; stuck bodies keep their position bit for bit | second between the stops, first at each stop |
//! | a user's MJCF | a multibody of joints (`linkage.rs`), efforts as in a chain | second; Coriolis forces of hinges on hinges first |
//!
//! A mode of ω oscillates too fast by the factor 1 + (ω·h)²/24 (84 Hz at 16 kHz: 5e-5; 1 kHz: 6e-3) and keeps its amplitude:
//! numerical damping is below 1e-7 of critical over ten seconds. A chain with a mode of ω·h ≥ 2 is refused.
//!
//! Chains are built from [`Chain`] and not from its MJCF text, because mjcf-rs skips the spring and the damper of a
//! tendon. A test compares both paths.
//!
//! Joints of MJCF files are those of a multibody, in reduced coordinates. Rapier's impulse joints were measured too: with
//! one of them a pendulum opens by 17 nm at its pivot and loses 0.2 % of its amplitude in ten seconds at 16 kHz; in a
//! multibody it does not open and loses 1e-8.
//!
//! A tick makes no allocations of its own; Rapier 0.36.1 allocates once in each step, and several times with a multibody.
//! Chains give the same bits on every machine of the same target; MJCF files with hinges do so with the same C library,
//! whose sine Rapier uses for them.
//!
//! # The subset of MJCF
//!
//! Everything else is refused by name, all of it at once.
//!
//! | element | supported |
//! |---|---|
//! | `<body>` | nested (100 elements deep), with one joint or rigid; `pos` and any of the rotations |
//! | `<joint>` | `hinge`, `slide`: `pos`, `axis`, `damping`, `stiffness`, `springref`, `frictionloss`, `armature` |
//! | `<inertial>` | `mass`, `diaginertia`, `fullinertia`, a frame |
//! | `<geom>` | mass by `mass` or `density`, of `sphere`, `capsule`, `ellipsoid`, `cylinder`, `box`; no contacts: a file in which geoms could touch is refused |
//! | `<tendon><fixed>` | spring and damper between joints: `stiffness`, `damping`, `springlength` |
//! | `<actuator><motor>` | on the motor joint; the drive's effort is that on the joint, so `gear` cancels out |
//! | `<default>` | classes of `joint`, `geom`, `motor` |
//! | `<compiler>`, `<option>` | `angle`, `eulerseq`, `inertiafromgeom`; `gravity`, contacts off; the tick is the base rate's |
//! | `<contact><exclude>` | |
//!
//! Materials, lights, cameras, sites, sensors and the like are ignored: they move nothing.

mod chain;
mod half_kick;
mod linkage;
mod lumps;
mod mjcf;
mod scene;

use chain::LumpChain;
use linkage::{Linkage, LinkageError};
use mjcf::{Mechanism, MjcfRefusal};
use servobench_plant::{Chain, Drive, Engine, EngineName, Mechanics, MechanicsError, MechanicsSetup, MjcfModel, Model};

const NAME: EngineName = EngineName::Rapier;

/// The engine `rapier`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rapier;

impl Engine for Rapier {
    fn name(&self) -> EngineName {
        NAME
    }

    #[expect(clippy::match_wildcard_for_single_variants, reason = "all kinds that it does not list are refused alike")]
    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        setup.check()?;
        match &setup.model {
            Model::Chain(chain) => Ok(match chain.bodies().len() {
                1 => Box::new(LumpChain::<1>::new(chain, setup)?),
                2 => Box::new(LumpChain::<2>::new(chain, setup)?),
                3 => Box::new(LumpChain::<3>::new(chain, setup)?),
                _ => Box::new(LumpChain::<{ Chain::MAX_BODIES }>::new(chain, setup)?),
            }),
            Model::Mjcf(model) => build_mjcf(model, setup),
            other => Err(MechanicsError::not_simulated(NAME, other)),
        }
    }
}

fn build_mjcf(file: &MjcfModel, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
    if setup.drive == Drive::Prescribed {
        return Err(MechanicsError::Unsupported {
            engine: NAME,
            what: "a prescribed motion of an MJCF model".into(),
            help: "drive it by efforts, or describe the axis by its bodies".into(),
        });
    }
    let refused = |refusals: Vec<MjcfRefusal>| {
        if let [MjcfRefusal::Unreadable { message }] = &refusals[..] {
            return MechanicsError::Model { engine: NAME, message: format!("{}: {message}", file.path.display()) };
        }
        MechanicsError::Refused {
            engine: NAME,
            path: file.path.clone(),
            refusals: refusals.iter().map(Into::into).collect(),
            help: "change the file, choose the engine `mujoco`, or describe the axis by its bodies",
        }
    };
    let mut mechanism = Mechanism::read(&file.xml).map_err(refused)?;
    if file.is_smooth {
        mechanism.links.iter_mut().filter_map(|link| link.joint.as_mut()).for_each(|joint| joint.friction = 0.0);
    }
    let axis = mechanism.axis(file).map_err(|mut refusals| {
        refusals.extend(linkage::check(&mechanism).err().unwrap_or_default());
        refused(refusals)
    })?;
    match Linkage::new(&mechanism, axis, setup) {
        Ok(linkage) => Ok(Box::new(linkage)),
        Err(LinkageError::Refused(refusals)) => Err(refused(refusals)),
        Err(LinkageError::Engine(error)) => Err(error),
    }
}
