//! The touch probe of an axis: what is asked for, and what is answered.
use servobench_base::Stateful;
use servobench_cia402::touch_probe::{Edge, Function};

servobench_config::choices! {
    /// What has the drive latch the position of the axis.
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
    /// The edge at which it latches.
    pub(crate) const fn edge(self) -> Edge {
        match self {
            Self::HomeSwitchMet | Self::IndexPulse => Edge::Positive,
            Self::HomeSwitchLeft => Edge::Negative,
        }
    }

    /// What the drive is told (60B8h).
    pub(crate) const fn function(self) -> u16 {
        Function::first(self.edge(), matches!(self, Self::IndexPulse)).0
    }
}

/// A question for the position of the axis at a trigger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub struct TouchProbe {
    /// Its number, from 1: another one is another question.
    pub number: u32,
    /// What has the drive latch the position.
    pub trigger: ProbeTrigger,
}

/// The answer to a question for the position at a trigger.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct ProbeFeedback {
    /// Number of the question.
    pub number: u32,
    /// Where the axis was; `None` before the trigger has come.
    pub position: Option<f64>,
}
