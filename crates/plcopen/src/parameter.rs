//! Parameters of an axis that blocks read and write: the list of PLCopen part 1, version 2.0 (section 3.20, table of parameters).
//!
//! The axis has one limit for acceleration and deceleration: both parameters of a pair show it, and that of the acceleration sets it.
use servobench_base::Stateful;
use servobench_config::quantities::{ACCELERATION, JERK, POSITION, VELOCITY};
use servobench_config::{Kind::Axis, Measure, any, positive};

servobench_config::choices! {
    /// A numeric parameter of the axis.
    #[derive(Stateful)]
    pub enum AxisParameter {
        /// CommandedPosition (1), read-only
        CommandedPosition = "commanded-position",
        /// SWLimitPos (2): positive software limit
        PositiveLimit = "sw-limit-pos",
        /// SWLimitNeg (3): negative software limit
        NegativeLimit = "sw-limit-neg",
        /// MaxPositionLag (7): largest following error
        MaxLag = "max-position-lag",
        /// MaxVelocitySystem (8), read-only
        MaxVelocitySystem = "max-velocity-system",
        /// MaxVelocityAppl (9): limit of the velocity, at most that of the system
        MaxVelocity = "max-velocity-appl",
        /// ActualVelocity (10), read-only
        ActualVelocity = "actual-velocity",
        /// CommandedVelocity (11), read-only
        CommandedVelocity = "commanded-velocity",
        /// MaxAccelerationSystem (12), read-only
        MaxAccelerationSystem = "max-acceleration-system",
        /// MaxAccelerationAppl (13): limit of acceleration and deceleration, at most that of the system
        MaxAcceleration = "max-acceleration-appl",
        /// MaxDecelerationSystem (14), read-only
        MaxDecelerationSystem = "max-deceleration-system",
        /// MaxDecelerationAppl (15), read-only: that of the acceleration
        MaxDeceleration = "max-deceleration-appl",
        /// MaxJerkSystem (16), read-only
        MaxJerkSystem = "max-jerk-system",
        /// MaxJerkAppl (17): limit of the jerk, at most that of the system
        MaxJerk = "max-jerk-appl",
    }
}

servobench_config::choices! {
    /// A BOOL parameter of the axis.
    #[derive(Stateful)]
    pub enum AxisBoolParameter {
        /// EnableLimitPos (4): TRUE if the positive software limit is active
        EnablePositiveLimit = "enable-limit-pos",
        /// EnableLimitNeg (5): TRUE if the negative software limit is active
        EnableNegativeLimit = "enable-limit-neg",
        /// EnablePosLagMonitoring (6): TRUE if the following error is monitored
        EnableLagMonitoring = "enable-pos-lag-monitoring",
    }
}

impl AxisParameter {
    /// Quantity and bound of a value that is written; `None` if the parameter is read-only.
    #[must_use]
    pub const fn written_as(self) -> Option<Measure> {
        match self {
            Self::PositiveLimit | Self::NegativeLimit => Some(any(Axis(&POSITION), "400 mm")),
            Self::MaxLag => Some(positive(Axis(&POSITION), "2 mm")),
            Self::MaxVelocity => Some(positive(Axis(&VELOCITY), "0.5 m/s")),
            Self::MaxAcceleration => Some(positive(Axis(&ACCELERATION), "2 m/s2")),
            Self::MaxJerk => Some(positive(Axis(&JERK), "50 m/s3")),
            Self::CommandedPosition
            | Self::MaxVelocitySystem
            | Self::ActualVelocity
            | Self::CommandedVelocity
            | Self::MaxAccelerationSystem
            | Self::MaxDecelerationSystem
            | Self::MaxDeceleration
            | Self::MaxJerkSystem => None,
        }
    }
}
