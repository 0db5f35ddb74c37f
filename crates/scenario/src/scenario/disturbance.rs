//! External efforts, and the initial state of the axis.

/// An external effort.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbance {
    /// Body on which it acts.
    pub on: DisturbedBody,
    /// First instant (s).
    pub start: f64,
    /// Duration (s); infinite: to the end.
    pub duration: f64,
    /// Amplitude (N or N·m, in the body's coordinate).
    pub effort: f64,
    /// Frequency of a sine (Hz); `None` for a step.
    pub frequency: Option<f64>,
}

servobench_config::choices! {
    /// Body that a disturbance acts on, in the coordinate of that body.
    pub enum DisturbedBody {
        /// the motor side
        Motor = "motor",
        /// the last body
        Load = "load",
    }
}

/// Initial deviation of the load from rest at zero (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Initial {
    /// Load position (m or rad).
    pub load_position: f64,
    /// Load velocity (m/s or rad/s).
    pub load_velocity: f64,
}
