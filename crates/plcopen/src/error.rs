//! Errors of blocks and of the axis.
//!
//! The standard leaves the numbers of ErrorID to the supplier. Here the thousands are the class: 1 an input, 2 the state of the axis, 3 the
//! plan of a move, 4 the axis itself.
use crate::blocks::BlockName;
use crate::parameter::AxisParameter;
use crate::state::AxisState;
use servobench_base::Stateful;
use servobench_config::Choice as _;
use servobench_fieldbus::Fault;
use servobench_motion::PlanError;
use thiserror::Error;

/// The output ErrorID.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
#[repr(u16)]
pub enum ErrorId {
    /// No error.
    #[default]
    None = 0,
    /// An input is not a number, or has the wrong sign or range.
    Input = 0x1001,
    /// An input is above a limit of the axis.
    AboveLimit = 0x1002,
    /// A superimposed motion and the one below are together above a limit of the axis.
    SumAboveLimit = 0x1003,
    /// The input Direction does not fit the block.
    Direction = 0x1004,
    /// The input BufferMode does not fit the block, or the command before it.
    BufferMode = 0x1005,
    /// The parameter of the axis is read-only.
    ReadOnly = 0x1006,
    /// The target is beyond a software limit.
    SoftwareLimit = 0x1007,
    /// The state of the axis does not allow the block.
    State = 0x2001,
    /// The axis has no reference.
    NotHomed = 0x2002,
    /// The axis holds no more buffered commands.
    BufferFull = 0x2003,
    /// MC_Power does not permit motion in this direction.
    NotPermitted = 0x2004,
    /// The motion is over and cannot be changed.
    Ended = 0x2005,
    /// The move cannot be planned.
    Plan = 0x3001,
    /// The drive or its link reports a fault.
    DriveFault = 0x4001,
    /// The power failed.
    PowerLost = 0x4002,
    /// The reference was not found.
    HomingFailed = 0x4003,
    /// The axis moved in a direction that MC_Power no longer permits.
    PermissionLost = 0x4004,
    /// The axis ran faster than MC_TorqueControl allows.
    Overspeed = 0x4005,
    /// A profile gave no set-point, or one beyond the limits of the axis.
    Profile = 0x4006,
    /// A move that had been accepted could not be planned when its turn came.
    PlanLost = 0x4007,
    /// The axis was about to pass a software limit.
    SoftwareLimitPassed = 0x4008,
    /// The following error was too large.
    PositionLag = 0x4009,
    /// MC_StepBlock met nothing within its limits.
    NoObstacle = 0x400A,
}

impl ErrorId {
    /// Every error.
    pub const ALL: [Self; 23] = [
        Self::Input,
        Self::AboveLimit,
        Self::SumAboveLimit,
        Self::Direction,
        Self::BufferMode,
        Self::ReadOnly,
        Self::SoftwareLimit,
        Self::State,
        Self::NotHomed,
        Self::BufferFull,
        Self::NotPermitted,
        Self::Ended,
        Self::Plan,
        Self::DriveFault,
        Self::PowerLost,
        Self::HomingFailed,
        Self::PermissionLost,
        Self::Overspeed,
        Self::Profile,
        Self::PlanLost,
        Self::SoftwareLimitPassed,
        Self::PositionLag,
        Self::NoObstacle,
    ];

    /// Number on the output.
    #[must_use]
    pub const fn number(self) -> u16 {
        self as u16
    }

    /// Meaning, in words.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::None => "no error",
            Self::Input => "an input is not a number, or has the wrong sign or range",
            Self::AboveLimit => "an input is above a limit of the axis",
            Self::SumAboveLimit => "a superimposed motion and the one below are together above a limit of the axis",
            Self::Direction => "the input Direction does not fit the block",
            Self::BufferMode => "the input BufferMode does not fit the block, or the command before it",
            Self::ReadOnly => "the parameter of the axis is read-only",
            Self::SoftwareLimit => "the target is beyond a software limit of the axis",
            Self::State => "the state of the axis does not allow the block",
            Self::NotHomed => "an absolute position is commanded to an axis that is not homed",
            Self::BufferFull => "the axis holds no more buffered commands",
            Self::NotPermitted => "MC_Power does not permit motion in this direction",
            Self::Ended => "the motion is over and cannot be changed any more",
            Self::Plan => "the move cannot be planned",
            Self::DriveFault => "the drive or its link reports a fault",
            Self::PowerLost => "the power failed, or never came back",
            Self::HomingFailed => "the drive did not find its reference",
            Self::PermissionLost => "MC_Power withdrew the permission for the direction of the running motion",
            Self::Overspeed => "the axis ran faster than the input Velocity of MC_TorqueControl",
            Self::Profile => "a profile gave no set-point in a cycle, or one beyond the limits of the axis",
            Self::PlanLost => "a waiting move that had been accepted could not be planned when it became active",
            Self::SoftwareLimitPassed => "the axis was about to pass a software limit",
            Self::PositionLag => "the following error was larger than MaxPositionLag",
            Self::NoObstacle => "MC_StepBlock met no obstacle within TimeLimit and DistanceLimit",
        }
    }
}

/// A refused call, or a failed command.
#[derive(Debug, Clone, Copy, PartialEq, Error, Stateful)]
pub enum BlockError {
    /// An input is not a number, or has the wrong sign or range.
    #[error("{block}: `{input}` must be {bound}, got {value}: correct the input")]
    Input {
        /// The block.
        block: BlockName,
        /// Input in the spelling of the standard.
        input: &'static str,
        /// Rejected value (SI).
        value: f64,
        /// Bound of the value, in words.
        bound: &'static str,
    },
    /// An input is above a limit of the axis.
    #[error(
        "{block}: `{input}` must be at most {limit}, the limit of the axis, got {value}: lower it or raise the limit"
    )]
    AboveLimit {
        /// The block.
        block: BlockName,
        /// Input in the spelling of the standard.
        input: &'static str,
        /// Rejected value (SI).
        value: f64,
        /// Limit of the axis (SI).
        limit: f64,
    },
    /// A superimposed motion and the one below are together above a limit of the axis.
    #[error(
        "{block}: `{input}` and that of the other motion must together be at most {limit}, the limit of the axis, got \
         {value}: lower one of them"
    )]
    SumAboveLimit {
        /// The block.
        block: BlockName,
        /// Input in the spelling of the standard.
        input: &'static str,
        /// Rejected sum (SI).
        value: f64,
        /// Limit of the axis (SI).
        limit: f64,
    },
    /// The input Direction does not fit the block.
    #[error("{block}: `Direction` must be {bound}, got {value}: correct the input")]
    Direction {
        /// The block.
        block: BlockName,
        /// Rejected direction, in the spelling of the standard.
        value: &'static str,
        /// Permitted directions, in words.
        bound: &'static str,
    },
    /// The input BufferMode does not fit the block, or the command before it.
    #[error("{block}: `BufferMode` must be {bound}, got {value}: correct the input")]
    BufferMode {
        /// The block.
        block: BlockName,
        /// Rejected mode, in the spelling of the standard.
        value: &'static str,
        /// Permitted modes, in words.
        bound: &'static str,
    },
    /// The parameter of the axis is read-only.
    #[error("{block}: `ParameterNumber` \"{}\" is read-only: write one that is not", parameter.name())]
    ReadOnly {
        /// The block.
        block: BlockName,
        /// The parameter.
        parameter: AxisParameter,
    },
    /// The target is beyond a software limit.
    #[error(
        "{block}: leads to {value}, beyond the software limit {limit} of the axis: correct the target or write the \
         parameter SWLimitPos or SWLimitNeg"
    )]
    SoftwareLimit {
        /// The block.
        block: BlockName,
        /// Target position (SI).
        value: f64,
        /// The limit (SI).
        limit: f64,
    },
    /// The state of the axis does not allow the block.
    #[error("{block}: the state of the axis, {state}, does not allow it: {}", state.help())]
    State {
        /// The block.
        block: BlockName,
        /// State of the axis.
        state: AxisState,
    },
    /// The axis has no reference.
    #[error("{block}: `Position` {value} has no meaning on an axis without a reference: execute MC_Home first")]
    NotHomed {
        /// The block.
        block: BlockName,
        /// Rejected position (SI).
        value: f64,
    },
    /// The axis holds no more buffered commands.
    #[error("{block}: `BufferMode`: {held} commands wait, as many as the axis holds: wait for the Done of one")]
    BufferFull {
        /// The block.
        block: BlockName,
        /// Number of waiting commands.
        held: usize,
    },
    /// MC_Power does not permit motion in this direction.
    #[error("{block}: leads in a direction that MC_Power does not permit: set `{input}` of MC_Power")]
    NotPermitted {
        /// The block.
        block: BlockName,
        /// Input of MC_Power.
        input: &'static str,
    },
    /// The motion is over and cannot be changed.
    #[error("{block}: `ContinuousUpdate`: the motion is over: start it again with a rising edge of `Execute`")]
    Ended {
        /// The block.
        block: BlockName,
    },
    /// The move cannot be planned.
    #[error("{block}: {error}")]
    Plan {
        /// The block.
        block: BlockName,
        /// Cause.
        error: PlanError,
    },
    /// The axis stopped with an error.
    #[error("{block}: {error}")]
    Axis {
        /// The block.
        block: BlockName,
        /// Cause.
        error: AxisError,
    },
}

impl BlockError {
    /// The output ErrorID.
    #[must_use]
    pub const fn id(&self) -> ErrorId {
        match self {
            Self::Input { .. } => ErrorId::Input,
            Self::AboveLimit { .. } => ErrorId::AboveLimit,
            Self::SumAboveLimit { .. } => ErrorId::SumAboveLimit,
            Self::Direction { .. } => ErrorId::Direction,
            Self::BufferMode { .. } => ErrorId::BufferMode,
            Self::ReadOnly { .. } => ErrorId::ReadOnly,
            Self::SoftwareLimit { .. } => ErrorId::SoftwareLimit,
            Self::State { .. } => ErrorId::State,
            Self::NotHomed { .. } => ErrorId::NotHomed,
            Self::BufferFull { .. } => ErrorId::BufferFull,
            Self::NotPermitted { .. } => ErrorId::NotPermitted,
            Self::Ended { .. } => ErrorId::Ended,
            Self::Plan { .. } => ErrorId::Plan,
            Self::Axis { error, .. } => error.id(),
        }
    }
}

/// An error of the axis, which leads to ErrorStop.
#[derive(Debug, Clone, Copy, PartialEq, Error, Stateful)]
pub enum AxisError {
    /// The drive or its link reports a fault.
    #[error("{fault}: remove its cause and call MC_Reset")]
    DriveFault {
        /// Fault reported.
        fault: Fault,
    },
    /// The power failed.
    #[error("the power of the axis failed in {state}: see why the drive left it, and call MC_Reset")]
    PowerLost {
        /// State of the axis at that time.
        state: AxisState,
    },
    /// The reference was not found.
    #[error("the drive did not find its reference: check its switches, and call MC_Reset")]
    HomingFailed,
    /// The axis moved in a direction that is no longer permitted.
    #[error("the axis moves at {velocity} while `{input}` of MC_Power is FALSE: stop it before")]
    PermissionLost {
        /// Commanded velocity (SI).
        velocity: f64,
        /// Input of MC_Power.
        input: &'static str,
    },
    /// The axis ran faster than MC_TorqueControl allows.
    #[error(
        "MC_TorqueControl: the axis runs at {velocity}, `Velocity` allows {limit}: lower `Torque` or raise `Velocity`"
    )]
    Overspeed {
        /// Actual velocity (SI).
        velocity: f64,
        /// Largest magnitude (SI).
        limit: f64,
    },
    /// A profile gave a set-point beyond the limits of the axis.
    #[error("{block}: its {quantity} {value} is beyond {limit}, the limit of the axis: change the profile")]
    Profile {
        /// The block.
        block: BlockName,
        /// Velocity, acceleration or jerk.
        quantity: &'static str,
        /// Value (SI).
        value: f64,
        /// Limit of the axis (SI).
        limit: f64,
    },
    /// A block that leads the axis was not called.
    #[error("{block}: gave no set-point in this cycle: call it in every cycle")]
    NotLed {
        /// The block.
        block: BlockName,
    },
    /// A move that had been accepted could not be planned when its turn came.
    #[error("{error}")]
    PlanLost {
        /// Cause.
        error: PlanError,
    },
    /// The axis was about to pass a software limit.
    #[error("the axis was about to pass its software limit {limit}: end the motion before")]
    SoftwareLimit {
        /// The limit (SI).
        limit: f64,
    },
    /// The following error was too large.
    #[error(
        "the following error {lag} is larger than MaxPositionLag, {limit}: see what holds the axis, or raise the parameter"
    )]
    PositionLag {
        /// Following error (SI).
        lag: f64,
        /// Largest magnitude (SI).
        limit: f64,
    },
    /// A search met no obstacle within its limits.
    #[error(
        "MC_StepBlock: no obstacle within `{input}`, {limit}: see that there is one and that the axis reaches `TorqueLimit` at it, \
         or raise `{input}`"
    )]
    NoObstacle {
        /// Input whose limit was exceeded.
        input: &'static str,
        /// Value of the input (SI).
        limit: f64,
    },
}

impl AxisError {
    /// The output AxisErrorID.
    #[must_use]
    pub const fn id(&self) -> ErrorId {
        match self {
            Self::DriveFault { .. } => ErrorId::DriveFault,
            Self::PowerLost { .. } => ErrorId::PowerLost,
            Self::HomingFailed => ErrorId::HomingFailed,
            Self::PermissionLost { .. } => ErrorId::PermissionLost,
            Self::Overspeed { .. } => ErrorId::Overspeed,
            Self::Profile { .. } | Self::NotLed { .. } => ErrorId::Profile,
            Self::PlanLost { .. } => ErrorId::PlanLost,
            Self::SoftwareLimit { .. } => ErrorId::SoftwareLimitPassed,
            Self::PositionLag { .. } => ErrorId::PositionLag,
            Self::NoObstacle { .. } => ErrorId::NoObstacle,
        }
    }
}
