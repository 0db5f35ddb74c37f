//! Physics of a servo axis: motor, inverter, sensors, friction, mechanics. Independent of controllers.
//!
//! Each block has `Params` (constant in a run), `State` (kept from tick to tick), an input and a step.
//! Mechanics is a trait, because it has several engines; the engine [`Exact`] is in this crate, the others in separate
//! crates.

mod chain;
mod end_stops;
mod engine;
mod exact;
mod fmu;
mod friction;
mod ground_friction;
mod identity;
mod integration;
pub mod inverter;
mod linear_mechanics;
mod linearised;
mod load_coordinate;
mod mechanics;
mod mjcf;
mod mjcf_axis;
mod modes;
pub mod pmsm;
mod power_stage;
mod refusal;
mod sensor;
mod source;
mod switches;
mod wiring;

pub use chain::{Body, Chain, ChainParameter, Link};
pub use end_stops::{EndStopError, EndStopParameter, EndStops};
pub use engine::{Capabilities, Engine, EngineName};
pub use exact::Exact;
pub use fmu::{FmuBody, FmuModel};
pub use friction::{DryFriction, Friction, FrictionParameter};
pub use ground_friction::{Grips, GroundFriction};
pub use identity::Identity;
pub use integration::{Distortion, Integrator};
pub use linear_mechanics::{LinearMechanics, NotLinear};
pub use load_coordinate::{LoadCoordinate, PosedJoint};
pub use mechanics::{
    Actuation, BodyState, Drive, Input, JointLimit, LogMessage, Mechanics, MechanicsError, MechanicsSetup, MjcfModel,
    Model, ModelKind, check_states,
};
pub use mjcf::chain_to_mjcf;
pub use mjcf_axis::MjcfAxis;
pub use modes::Mode;
pub use power_stage::PowerStage;
pub use refusal::{Refusal, RefusedAt};
pub use sensor::{
    Converter, CurrentSensor, CurrentSensorParameter, Edge, Encoder, EncoderErrors, EncoderParameter, EncoderState,
    Reading, Signals, Track,
};
pub use source::{IdealSource, SourceOutput};
pub use switches::{SwitchPoint, SwitchReading, Switches};
pub use wiring::{Phase, Swap, Wiring, WiringParameter};
