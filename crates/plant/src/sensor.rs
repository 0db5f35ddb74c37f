//! Sensors, which err as real ones do: each error is switched on by itself, and a sensor without errors costs nothing.
mod current;
mod edge;
mod encoder;
mod latency;
mod noise;
mod signals;
mod turn;

pub(crate) use current::State as CurrentSensorState;
pub use current::{Converter, CurrentSensor, CurrentSensorParameter};
pub use edge::Edge;
pub use encoder::{Encoder, EncoderErrors, EncoderParameter, EncoderState, Reading};
pub use signals::{Signals, Track};
