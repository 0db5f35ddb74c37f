//! The touch probe of an axis: request and answer.
use servobench_base::Stateful;
use servobench_cia402::touch_probe::{Edge, Function};

servobench_config::choices! {
    /// Trigger at which the drive latches the position of the axis.
    #[derive(Stateful)]
    pub enum ProbeTrigger {
        /// the home switch is met
        HomeSwitchMet = "home-switch-met",
        /// the home switch is left
        HomeSwitchLeft = "home-switch-left",
        /// the index pulse of the encoder
        IndexPulse = "index-pulse",
    }
}

impl ProbeTrigger {
    /// Edge at which the trigger latches.
    pub(crate) const fn edge(self) -> Edge {
        match self {
            Self::HomeSwitchMet | Self::IndexPulse => Edge::Positive,
            Self::HomeSwitchLeft => Edge::Negative,
        }
    }

    /// Command to the drive (60B8h).
    pub(crate) const fn function(self) -> u16 {
        Function::first(self.edge(), matches!(self, Self::IndexPulse)).0
    }
}

/// A request for the position of the axis at a trigger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub struct TouchProbe {
    /// Number, from 1: another number is another request.
    pub number: u32,
    /// Trigger at which the drive latches the position.
    pub trigger: ProbeTrigger,
}

/// The answer to a request for the position at a trigger.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct ProbeFeedback {
    /// Number of the request.
    pub number: u32,
    /// Latched position; `None` before the trigger has come.
    pub position: Option<f64>,
}
