//! The PLC program: calls of function blocks (PLCopen Motion Control, part 1, version 2.0).
/// The PLC program. Its cycle is that of the motion task, [`Bus::motion_every`](super::Bus::motion_every).
#[derive(Debug, Clone, PartialEq)]
pub struct Plc {
    /// Whether absolute moves of an axis that was not homed are refused.
    pub homing_required: bool,
    /// What no command may exceed, of `[setpoint]`: |velocity|, |acceleration|, |jerk|, |snap|; infinite where there is none.
    pub limits: [f64; 4],
    /// The calls, at least one, in the order in which every cycle executes them.
    pub calls: Vec<Call>,
}

/// A call of a function block, with an instance of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// Name of the instance, unique.
    pub name: String,
    /// The block and its inputs.
    pub block: Block,
    /// When `Execute` or `Enable` becomes TRUE.
    pub start: Condition,
    /// When it becomes FALSE; `None`: `Execute` a cycle after the block has ended, `Enable` never.
    pub stop: Option<Condition>,
    /// How long `start` is waited for, from the beginning of the run (s); infinite where the end of the run is soon enough.
    pub timeout: f64,
    /// Whether the run may do without it.
    pub is_optional: bool,
    /// Inputs that change while `Execute` is TRUE, in the order of the file.
    pub updates: Vec<Update>,
}

/// New inputs of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct Update {
    /// When.
    pub when: Condition,
    /// The same block with all its inputs as they are from then on.
    pub block: Block,
}

/// When something happens: in the first cycle in which it holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// In the first cycle of the run; of an update: of the execution.
    AtOnce,
    /// At a time of the run (s).
    At(f64),
    /// So long after an output has become TRUE.
    After {
        /// Index of the call whose output it is.
        call: usize,
        /// Which output.
        output: Output,
        /// How long after (s).
        delay: f64,
    },
    /// The actual position passes this one upwards, or is above it already.
    Above(f64),
    /// The actual position passes this one downwards, or is below it already.
    Below(f64),
}

/// A function block with its inputs. Positions and velocities are in the axis coordinate, torques in the motor's.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// `MC_Power`.
    Power {
        /// Whether motion upwards is permitted.
        positive: bool,
        /// Whether motion downwards is permitted.
        negative: bool,
    },
    /// `MC_Home`: the drive's homing method.
    Home {
        /// Position of the reference from then on.
        position: f64,
        /// What becomes of the motion under way.
        buffer_mode: BufferMode,
    },
    /// `MC_Stop`.
    Stop(Braking),
    /// `MC_Halt`.
    Halt {
        /// How hard it brakes.
        braking: Braking,
        /// What becomes of the motion under way.
        buffer_mode: BufferMode,
    },
    /// `MC_Reset`.
    Reset,
    /// `MC_MoveAbsolute`.
    MoveAbsolute {
        /// Target.
        position: f64,
        /// Which way round a modulo axis.
        direction: Direction,
        /// Velocity and what leads to it.
        dynamics: Dynamics,
        /// How the motion begins.
        command: Command,
    },
    /// `MC_MoveRelative`: from the position at its start.
    MoveRelative {
        /// Distance.
        distance: f64,
        /// Velocity and what leads to it.
        dynamics: Dynamics,
        /// How the motion begins.
        command: Command,
    },
    /// `MC_MoveAdditive`: from the target of the move before.
    MoveAdditive {
        /// Distance.
        distance: f64,
        /// Velocity and what leads to it.
        dynamics: Dynamics,
        /// How the motion begins.
        command: Command,
    },
    /// `MC_MoveSuperimposed`: on top of the motion under way.
    MoveSuperimposed {
        /// Distance on top.
        distance: f64,
        /// What leads to it; its velocity is the largest difference of velocity.
        dynamics: Dynamics,
        /// Whether inputs count that change while `Execute` is TRUE.
        continuous_update: bool,
    },
    /// `MC_MoveVelocity`.
    MoveVelocity {
        /// Velocity; may be negative.
        velocity: f64,
        /// Its direction besides the sign of the velocity.
        direction: Direction,
        /// What leads to the velocity, whose magnitude is its velocity.
        dynamics: Dynamics,
        /// How the motion begins.
        command: Command,
    },
    /// `MC_MoveContinuousAbsolute`.
    MoveContinuousAbsolute {
        /// Target.
        position: f64,
        /// Velocity at the target, kept afterwards.
        end_velocity: f64,
        /// Which way round a modulo axis.
        direction: Direction,
        /// Velocity and what leads to it.
        dynamics: Dynamics,
        /// How the motion begins.
        command: Command,
    },
    /// `MC_PositionProfile`.
    PositionProfile {
        /// Positions.
        pairs: Vec<Pair>,
        /// What the inputs make of them.
        scales: Scales,
        /// Whether they count from where the profile begins.
        is_relative: bool,
        /// How the axis goes from one to the next.
        follow: ProfileFollow,
        /// Velocity at the last one.
        end_velocity: f64,
        /// What becomes of the motion under way.
        buffer_mode: BufferMode,
    },
    /// `MC_VelocityProfile`.
    VelocityProfile {
        /// Velocities.
        pairs: Vec<Pair>,
        /// What the inputs make of them.
        scales: Scales,
        /// What becomes of the motion under way.
        buffer_mode: BufferMode,
    },
    /// `MC_AccelerationProfile`.
    AccelerationProfile {
        /// Accelerations.
        pairs: Vec<Pair>,
        /// What the inputs make of them.
        scales: Scales,
        /// What becomes of the motion under way.
        buffer_mode: BufferMode,
    },
    /// `MC_SetPosition`.
    SetPosition {
        /// Position that the axis has from then on, or by which it is shifted.
        position: f64,
        /// Whether it is shifted.
        relative: bool,
    },
    /// `MC_SetOverride`.
    SetOverride {
        /// Factors of velocity, acceleration and jerk.
        factors: [f64; 3],
    },
    /// `MC_TorqueControl`.
    TorqueControl {
        /// Torque or force (motor coordinate).
        torque: f64,
        /// Largest change of it per second; infinite without one.
        torque_ramp: f64,
        /// Velocity (magnitude) beyond which the axis is stopped.
        velocity: f64,
        /// Its direction besides its sign.
        direction: Direction,
        /// How the motion begins.
        command: Command,
    },
    /// `MC_ReadStatus`.
    ReadStatus,
    /// `MC_ReadAxisError`.
    ReadAxisError,
    /// `MC_ReadActualPosition`.
    ReadActualPosition,
    /// `MC_ReadActualVelocity`.
    ReadActualVelocity,
    /// `MC_ReadActualTorque`.
    ReadActualTorque,
    /// The generator of fourth order as a block of its own.
    Profile4th {
        /// Target.
        position: f64,
        /// Limits of |velocity|, |acceleration|, |jerk|, |snap|.
        limits: [f64; 4],
        /// From the end of a profile until the block is ready for the next (s).
        settling_time: f64,
        /// Whether the motor is mounted the other way round.
        reversed: bool,
    },
}

/// A pair of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Time since the pair before, or since the start (s): above zero, but for the first pair zero or more.
    pub delta_time: f64,
    /// Position, velocity or acceleration at its end.
    pub value: f64,
}

/// What the inputs of a profile make of its pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Factor of the times.
    pub time: f64,
    /// Factor of the values.
    pub value: f64,
    /// What is added to the values after that.
    pub offset: f64,
}

/// How the axis goes from position to position of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProfileFollow {
    /// Along the cubic spline.
    Spline,
    /// By plateaus of velocity; the share of a segment at either end in which velocity changes.
    Plateaus(f64),
}

/// Velocity and what leads to it (magnitudes).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dynamics {
    /// Largest velocity; of a superimposed move the largest difference.
    pub velocity: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest deceleration.
    pub deceleration: f64,
    /// Largest jerk; infinite without a limit.
    pub jerk: f64,
    /// Largest snap; infinite without a limit.
    pub snap: f64,
}

/// How hard an axis brakes (magnitudes).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Braking {
    /// Largest deceleration.
    pub deceleration: f64,
    /// Largest jerk; infinite without a limit.
    pub jerk: f64,
    /// Largest snap; infinite without a limit.
    pub snap: f64,
}

/// How the motion of a block begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Command {
    /// What becomes of the motion under way.
    pub buffer_mode: BufferMode,
    /// Whether inputs count that change while `Execute` is TRUE.
    pub continuous_update: bool,
}

/// What becomes of the motion under way when a block is executed (`BufferMode`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BufferMode {
    /// It is broken off.
    #[default]
    Aborting,
    /// It ends first.
    Buffered,
    /// Its target is passed at the lower of both velocities.
    BlendingLow,
    /// Its target is passed at its own velocity.
    BlendingPrevious,
    /// Its target is passed at the velocity of the next.
    BlendingNext,
    /// Its target is passed at the higher of both velocities.
    BlendingHigh,
}

/// Which way an axis goes (`Direction`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Direction {
    /// Upwards.
    Positive,
    /// Downwards.
    Negative,
    /// The shorter of both.
    #[default]
    Shortest,
    /// As it goes already.
    Current,
}

/// An output that is TRUE or FALSE.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Output {
    /// The command has ended as commanded.
    Done,
    /// The block is not finished.
    Busy,
    /// The block controls the axis.
    Active,
    /// Another command has taken over.
    CommandAborted,
    /// Something is wrong.
    Error,
    /// The power is on.
    Status,
    /// The other outputs are valid.
    Valid,
    /// The commanded velocity is reached.
    InVelocity,
    /// The target is passed at its velocity.
    InEndVelocity,
    /// The commanded torque is reached.
    InTorque,
    /// The profile is over.
    ProfileCompleted,
    /// The override holds.
    Enabled,
    /// The generator takes a new command.
    Ready,
    /// The axis is in the state Disabled.
    Disabled,
    /// The axis is in the state Standstill.
    Standstill,
    /// The axis is in the state Homing.
    Homing,
    /// The axis is in the state Discrete Motion.
    DiscreteMotion,
    /// The axis is in the state Continuous Motion.
    ContinuousMotion,
    /// The axis is in the state Stopping.
    Stopping,
    /// The axis is in the state `ErrorStop`.
    ErrorStop,
}
