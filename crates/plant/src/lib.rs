//! Physics of a servo axis: motor, inverter, sensors, friction, mechanics. Knows nothing of controllers.
//!
//! Each block is `Params` (constant in a run), `State` (all that a snapshot must hold), an input and a step.
//! Mechanics is a trait, because it has several engines; the engine `exact` lives here, the others in crates of
//! their own.

mod chain;
mod friction;
mod mechanics;
mod mjcf;

pub use chain::{Body, Chain, Coordinate, Link};
pub use friction::{Contact, DryFriction, Grip};
pub use mechanics::{
    Actuation, BodyState, Drive, Engine, Input, Mechanics, MechanicsError, MechanicsSetup,
    MjcfModel, Model,
};
pub use mjcf::chain_to_mjcf;
