//! The function blocks, and the lists of their inputs, outputs and names: each property of a block is defined once, in its module or
//! here.
//!
//! # Execute
//!
//! A rising edge of Execute takes the inputs over and starts the command; later changes have no effect, unless ContinuousUpdate was
//! TRUE at the edge: then each change acts on the active command (PLCopen part 1, section 2.4.1).
//!
//! - Busy, Done, CommandAborted and Error exclude each other; Active goes with Busy while the command has the axis.
//! - Done, CommandAborted and Error stay until Execute is FALSE. When it was FALSE before they came, they last one cycle.
//! - A falling edge does not end the command. A new rising edge starts a new one, and the old one is no longer reported. If the new one
//!   is refused, Error is TRUE for that, and the old one continues unreported: errors of blocks do not stop the axis.
//! - InVelocity, InEndVelocity and InTorque go with Busy and Active, while the set-point is the commanded value: if ContinuousUpdate
//!   changes that value, they are FALSE from the same call on until it is reached.
//!
//! # Enable
//!
//! The outputs of a block with Enable follow it from cycle to cycle; Valid or Error shows if they are meaningful. Busy is TRUE as long
//! as Enable is: an error is over as soon as its cause is, without a new edge (section 2.2.3).
//!
//! # Another block
//!
//! A block is a module here that implements [`FunctionBlock`], and a line in the list below. Its inputs name, by [`BlockInput`]s,
//! inputs of the list and their defaults; its outputs name outputs of the list. Programs call it, scenario files have its keys,
//! recordings its outputs, and the references in `docs/` list it from there on
//! (`SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-plcopen -p servobench-scenario` writes them). A block that commands the axis
//! also needs its place in the state diagram, `ARROWS`.
mod axis_move;
mod digital;
mod digital_cam_switch;
mod execution;
mod finish_homing;
mod halt_superimposed;
mod home;
mod motion;
mod move_absolute;
mod move_additive;
mod move_continuous_absolute;
mod move_continuous_relative;
mod move_relative;
mod move_superimposed;
mod move_velocity;
mod outputs;
mod parameters;
mod position_profile;
mod power;
mod profile;
mod profile_4th;
mod read;
mod read_axis_info;
mod read_motion_state;
mod reset;
mod set_override;
mod set_position;
mod step_block;
mod stop;
mod time_profile;
mod torque_control;
mod touch_probe;

use crate::interface::{BlockInput, BlockInputs, InputType, OutputType, Trigger, names};
use crate::list::{list_blocks, list_inputs, list_outputs};
use crate::parameter::{AxisBoolParameter, AxisParameter};
use core::fmt;
use servobench_config::Kind::{Axis, Motor, Plain};
use servobench_config::quantities::{ACCELERATION, EFFORT, EFFORT_RATE, JERK, POSITION, RATIO, SNAP, TIME, VELOCITY};
use servobench_config::{Choice as _, any, not_negative, positive};
use servobench_fieldbus::ProbeTrigger;
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::ShapeKind;

pub use axis_move::{AxisMove, AxisMoveInputs, AxisMoveOutputs, MoveType};
pub use digital::{
    ReadDigitalInput, ReadDigitalInputInputs, ReadDigitalOutput, ReadDigitalOutputInputs, WriteDigitalOutput,
    WriteDigitalOutputInputs,
};
pub use digital_cam_switch::{
    CamDirection, CamEnd, CamState, CamSwitch, DigitalCamSwitch, DigitalCamSwitchInputs, DigitalCamSwitchOutputs,
    TrackOptions, ValueSource,
};
pub use execution::Report;
pub use finish_homing::{FinishHoming, FinishHomingInputs};
pub use halt_superimposed::{HaltSuperimposed, HaltSuperimposedInputs};
pub use home::{Home, HomeAbsolute, HomeAbsoluteInputs, HomeDirect, HomeDirectInputs, HomeInputs};
pub use motion::{MotionBlock, MotionInputs};
pub use move_absolute::{MoveAbsolute, MoveAbsoluteInputs};
pub use move_additive::{MoveAdditive, MoveAdditiveInputs};
pub use move_continuous_absolute::{
    MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveContinuousAbsoluteOutputs,
};
pub use move_continuous_relative::{MoveContinuousRelative, MoveContinuousRelativeInputs};
pub use move_relative::{MoveRelative, MoveRelativeInputs};
pub use move_superimposed::{MoveSuperimposed, MoveSuperimposedInputs, MoveSuperimposedOutputs};
pub use move_velocity::{MoveVelocity, MoveVelocityInputs, MoveVelocityOutputs};
pub use outputs::{DoneOutputs, FunctionBlock, MotionOutputs, Outputs};
pub use parameters::{
    ReadBoolOutputs, ReadBoolParameter, ReadBoolParameterInputs, ReadParameter, ReadParameterInputs,
    ReadParameterOutputs, WriteBoolParameter, WriteBoolParameterInputs, WriteParameter, WriteParameterInputs,
};
pub use position_profile::{Follow, PositionProfile, PositionProfileInputs, TimePosition};
pub use power::{Power, PowerInputs, PowerOutputs};
pub use profile::{Memory, Pair};
pub use profile_4th::{Profile4th, Profile4thInputs, Profile4thOutputs};
pub use read::{
    ReadActualPosition, ReadActualTorque, ReadActualVelocity, ReadAxisError, ReadAxisErrorOutputs, ReadInputs,
    ReadStatus, ReadStatusOutputs, ReadValueOutputs, ReadsValue,
};
pub use read_axis_info::{ReadAxisInfo, ReadAxisInfoOutputs};
pub use read_motion_state::{ReadMotionState, ReadMotionStateOutputs};
pub use reset::{Reset, ResetInputs};
pub use set_override::{SetOverride, SetOverrideInputs, SetOverrideOutputs};
pub use set_position::{SetPosition, SetPositionInputs};
pub use step_block::{StepBlock, StepBlockInputs};
pub use stop::{Halt, HaltInputs, Stop, StopInputs, StopOutputs};
pub use time_profile::{
    AccelerationProfile, AccelerationProfileInputs, ProfileOutputs, VelocityProfile, VelocityProfileInputs,
};
pub use torque_control::{TorqueControl, TorqueControlInputs, TorqueControlOutputs};
pub use touch_probe::{AbortTrigger, AbortTriggerInputs, TouchProbe, TouchProbeInputs, TouchProbeOutputs};

list_inputs! {
    Position "position" changes InputType::Quantity(any(Axis(&POSITION), "250 mm")),
        "Target position" + ", for MC_Home, MC_HomeDirect, MC_StepBlock and MC_SetPosition the new position of the axis";
    Distance "distance" changes InputType::Quantity(any(Axis(&POSITION), "-250 mm")), "Distance";
    Velocity "velocity" changes InputType::Quantity(any(Axis(&VELOCITY), "30 m/min")),
        "Velocity; for MC_MoveVelocity it may be negative";
    EndVelocity "end_velocity" changes InputType::Quantity(any(Axis(&VELOCITY), "5 m/min")),
        "Velocity at the target, kept afterwards" + "; for MC_PositionProfile at its last position (default 0)";
    VelocityDifference "velocity_difference" changes InputType::Quantity(positive(Axis(&VELOCITY), "5 m/min")),
        "Largest velocity on top of the motion under way";
    Acceleration "acceleration" changes InputType::Quantity(positive(Axis(&ACCELERATION), "5 m/s2")), "Largest acceleration";
    Deceleration "deceleration" changes InputType::Quantity(positive(Axis(&ACCELERATION), "8 m/s2")),
        "Largest deceleration" + " (default `acceleration`)";
    Jerk "jerk" changes InputType::Quantity(positive(Axis(&JERK), "50 m/s3")), "Largest jerk";
    Snap "snap" changes InputType::Quantity(positive(Axis(&SNAP), "1000 m/s4")),
        "Largest snap" + ", an input beside those of the standard";
    Direction "direction" changes InputType::Direction,
        "Direction of the axis" + " (default \"shortest\" for a move to a position on a modulo axis, otherwise \"positive\", \
         where a negative velocity or torque reverses it)";
    BufferMode "buffer_mode" stays InputType::BufferMode,
        "Treatment of the active motion" + " (default \"aborting\")";
    ContinuousUpdate "continuous_update" stays InputType::Flag,
        "Applies `updates` while `Execute` is TRUE" + " (default false)";
    Torque "torque" changes InputType::Quantity(any(Motor(&EFFORT), "2 Nm")), "Torque, for a linear motor the force";
    TorqueRamp "torque_ramp" changes InputType::Quantity(positive(Motor(&EFFORT_RATE), "10 Nm/s")),
        "Largest change of the torque" + " (default unlimited)";
    TorqueLimit "torque_limit" stays InputType::Quantity(positive(Motor(&EFFORT), "1 Nm")),
        "Largest torque of MC_StepBlock (6072h), at which an obstacle counts as found";
    TorqueTolerance "torque_tolerance" stays InputType::Quantity(positive(Motor(&EFFORT), "0.05 Nm")),
        "Amount by which the torque may be below that at an obstacle" + " (default 5 % of it)";
    DetectionVelocityLimit "detection_velocity_limit" stays InputType::Quantity(positive(Axis(&VELOCITY), "1 mm/s")),
        "Velocity below which an obstacle holds the axis";
    DetectionVelocityTime "detection_velocity_time" stays InputType::Quantity(not_negative(Plain(&TIME), "50 ms")),
        "Time for which the axis must be that slow";
    TimeLimit "time_limit" stays InputType::Quantity(positive(Plain(&TIME), "20 s")),
        "Longest time of MC_StepBlock" + " (default unlimited)";
    DistanceLimit "distance_limit" stays InputType::Quantity(positive(Axis(&POSITION), "600 mm")),
        "Longest distance of MC_StepBlock" + " (default unlimited)";
    VelocityFactor "velocity_factor" changes InputType::Quantity(not_negative(Plain(&RATIO), "50 %")),
        "Factor of all velocities" + " (default 1)";
    AccelerationFactor "acceleration_factor" changes InputType::Quantity(positive(Plain(&RATIO), "50 %")),
        "Factor of all accelerations and decelerations" + " (default 1)";
    JerkFactor "jerk_factor" changes InputType::Quantity(positive(Plain(&RATIO), "50 %")),
        "Factor of all jerks" + " (default 1)";
    Relative "relative" stays InputType::Flag,
        "MC_SetPosition shifts the position by the given one" + " (default false)";
    SettlingTime "settling_time" stays InputType::Quantity(positive(Plain(&TIME), "50 ms")),
        "Time from the end of a profile until the generator is ready for the next";
    Reversed "reversed" stays InputType::Flag,
        "Motor mounted the other way round" + " (default false)";
    EnablePositive "enable_positive" changes InputType::Flag,
        "MC_Power permits motion upwards" + " (default true)";
    EnableNegative "enable_negative" changes InputType::Flag,
        "MC_Power permits motion downwards" + " (default true)";
    Table "table" stays InputType::Table,
        "Table of a profile, whose times count from its start; a first row at 0 gives the position of the axis then. The file of \
         MC_PositionProfile has the columns `time` and `position`, that of MC_VelocityProfile `velocity`, that of \
         MC_AccelerationProfile `acceleration`. Positions are followed along the cubic spline, or by `follow = \"plateaus\"`";
    TimeScale "time_scale" stays InputType::Quantity(positive(Plain(&RATIO), "2")),
        "Factor of the times of a table" + " (default 1)";
    ValueScale "value_scale" stays InputType::Quantity(any(Plain(&RATIO), "-0.5")),
        "Factor of the values of a table, not 0" + " (default 1)";
    PositionOffset "position_offset" stays InputType::Quantity(any(Axis(&POSITION), "10 mm")),
        "Offset then added to the positions of a table" + " (default 0)";
    VelocityOffset "velocity_offset" stays InputType::Quantity(any(Axis(&VELOCITY), "1 m/min")),
        "Offset then added to the velocities of a table" + " (default 0)";
    AccelerationOffset "acceleration_offset" stays InputType::Quantity(any(Axis(&ACCELERATION), "1 m/s2")),
        "Offset then added to the accelerations of a table" + " (default 0)";
    Parameter "parameter" stays InputType::Choice(&const { names::<AxisParameter, { AxisParameter::ALL.len() }>() }),
        "Parameter of the axis that is a number";
    BoolParameter "bool_parameter" stays InputType::Choice(&const { names::<AxisBoolParameter, { AxisBoolParameter::ALL.len() }>() }),
        "Parameter of the axis that is TRUE or FALSE";
    Value "value" stays InputType::ParameterValue, "Value written to `parameter`";
    BoolValue "bool_value" stays InputType::Flag, "Value written to `bool_parameter` or to the digital output";
    InputNumber "input_number" stays InputType::Whole(0, 31),
        "Bit of the digital inputs of the drive (60FDh)" + ": 0 negative and 1 positive limit switch, 2 home switch";
    OutputNumber "output_number" stays InputType::Whole(0, 31), "Bit of the digital outputs of the drive (60FEh)";
    Switches "switches" stays InputType::Switches, "Switches of MC_DigitalCamSwitch, each with a track and its positions";
    TrackOptions "track_options" stays InputType::Tracks,
        "Compensations and hysteresis of tracks of MC_DigitalCamSwitch" + " (default none)";
    EnableMask "enable_mask" changes InputType::Whole(0, u32::MAX),
        "Tracks of MC_DigitalCamSwitch that are enabled, track k by bit k" + " (default all)";
    ValueSource "value_source" stays InputType::Choice(&const { names::<ValueSource, { ValueSource::ALL.len() }>() }),
        "Source of the position and velocity that switch the outputs" + " (default \"set-point\")";
    TriggerInput "trigger_input" stays InputType::Choice(&const { names::<ProbeTrigger, { ProbeTrigger::ALL.len() }>() }),
        "Trigger on which the drive records the position of the axis";
    FirstPosition "first_position" stays InputType::Quantity(any(Axis(&POSITION), "90 mm")),
        "Beginning of the window in which a trigger counts" + " (default everywhere)";
    LastPosition "last_position" stays InputType::Quantity(any(Axis(&POSITION), "110 mm")),
        "End of the window in which a trigger counts" + " (default everywhere)";
    MoveType "move_type" stays InputType::Choice(&const { names::<MoveType, { MoveType::ALL.len() }>() }),
        "Meaning of `position` of MAM, a target or a distance" + " (default \"absolute\")";
    Shape "shape" stays InputType::Choice(&const { names::<ShapeKind, { ShapeKind::ALL.len() }>() }),
        "Shape of the velocity of MAM" + " (default \"trapezoid\")";
    JerkOfTime "jerk_of_time" stays InputType::Quantity(positive(Plain(&RATIO), "25 %")),
        "Jerk as the part of the ramp in which the acceleration changes" + " (default 100 % for an S-curve, if no jerk is given)";
    JerkOfMaximum "jerk_of_maximum" stays InputType::Quantity(positive(Plain(&RATIO), "60 %")),
        "Jerk as a share of that of the axis";
    JerkTime "jerk_time" stays InputType::Quantity(positive(Plain(&TIME), "2 ms")),
        "Jerk as the time in which the acceleration rises, and falls";
    DecelerationJerk "deceleration_jerk" stays InputType::Quantity(positive(Axis(&JERK), "80 m/s3")),
        "Jerk of the deceleration" + " (default that of the acceleration)";
    DecelerationJerkOfTime "deceleration_jerk_of_time" stays InputType::Quantity(positive(Plain(&RATIO), "50 %")),
        "Jerk of the deceleration as the part of its ramp in which it changes";
    DecelerationJerkOfMaximum "deceleration_jerk_of_maximum" stays InputType::Quantity(positive(Plain(&RATIO), "60 %")),
        "Jerk of the deceleration as a share of that of the axis";
    DecelerationJerkTime "deceleration_jerk_time" stays InputType::Quantity(positive(Plain(&TIME), "2 ms")),
        "Jerk of the deceleration as the time in which it rises, and falls";
    Order "order" stays InputType::Whole(2, 4),
        "Derivative of the position that Profile4th switches: 2 the acceleration, 3 the jerk, 4 the snap" + " (default 4)";
}

list_outputs! {
    Done "Done" Flag "the command has ended as commanded";
    Busy "Busy" Flag "the block is not finished";
    Active "Active" Flag "the block controls the axis";
    CommandAborted "CommandAborted" Flag "another command has taken over";
    Error "Error" Flag "the block has an error";
    ErrorId "ErrorID" Number "the code of the error";
    Status "Status" Flag "the power is on";
    Valid "Valid" Flag "the other outputs are valid";
    InVelocity "InVelocity" Flag "the commanded velocity is reached";
    InEndVelocity "InEndVelocity" Flag "the target is passed at its velocity";
    InTorque "InTorque" Flag "the commanded torque is reached";
    ProfileCompleted "ProfileCompleted" Flag "the profile is over";
    CoveredDistance "CoveredDistance" Number "distance covered by the superimposed motion";
    Enabled "Enabled" Flag "the override is active";
    Ready "Ready" Flag "the generator takes a new command";
    ErrorStop "ErrorStop" Flag "the axis is in the state ErrorStop";
    Disabled "Disabled" Flag "the axis is in the state Disabled";
    Stopping "Stopping" Flag "the axis is in the state Stopping";
    Homing "Homing" Flag "the axis is in the state Homing";
    Standstill "Standstill" Flag "the axis is in the state Standstill";
    DiscreteMotion "DiscreteMotion" Flag "the axis is in the state Discrete Motion";
    ContinuousMotion "ContinuousMotion" Flag "the axis is in the state Continuous Motion";
    SynchronizedMotion "SynchronizedMotion" Never "the axis follows another one";
    AxisErrorId "AxisErrorID" Number "the error of the axis";
    DriveCode "DriveCode" Number "the code of the drive";
    Position "Position" Number "the actual position";
    Velocity "Velocity" Number "the actual velocity";
    Torque "Torque" Number "the actual effort";
    ConstantVelocity "ConstantVelocity" Flag "the velocity is constant";
    Accelerating "Accelerating" Flag "the speed rises";
    Decelerating "Decelerating" Flag "the speed falls";
    DirectionPositive "DirectionPositive" Flag "the position increases";
    DirectionNegative "DirectionNegative" Flag "the position decreases";
    HomeAbsSwitch "HomeAbsSwitch" Flag "the home switch is met";
    LimitSwitchPos "LimitSwitchPos" Flag "the switch of the positive end is met";
    LimitSwitchNeg "LimitSwitchNeg" Flag "the switch of the negative end is met";
    Simulation "Simulation" Never "the axis has no drive";
    CommunicationReady "CommunicationReady" Flag "the drive answers";
    ReadyForPowerOn "ReadyForPowerOn" Flag "neither drive nor link has a fault";
    PowerOn "PowerOn" Flag "the motor is powered";
    IsHomed "IsHomed" Flag "the position counts from the reference";
    AxisWarning "AxisWarning" Flag "the drive warns";
    Value "Value" Number "the value of the parameter";
    BoolValue "Value" Flag "the value of the parameter, input or output";
    InOperation "InOperation" Flag "the tracks that are enabled are switched";
    RecordedPosition "RecordedPosition" Number "position of the axis at the trigger";
    Acceleration "Acceleration" Number "the acceleration of the set-point";
    Added "pref_add" Number "position added by the move";
    Jerk "Jerk" Number "the jerk of the set-point";
    Snap "dJerk" Number "the snap of the set-point";
    MoveEnabled "EN" Flag "the block is executed";
    MoveBegun "DN" Flag "the move has begun";
    MoveFailed "ER" Flag "the block has an error";
    InProcess "IP" Flag "the move is in progress";
    MoveActive "AC" Flag "the move controls the axis";
    ProcessComplete "PC" Flag "the axis is at its target";
}

/// Memory of a table: growable in a program.
#[cfg(feature = "program")]
type Rows<T> = alloc::vec::Vec<T>;
#[cfg(not(feature = "program"))]
type Rows<T> = [T; 0];

list_blocks! {
    Power: Power, "MC_Power", "powers the axis as long as it is enabled";
    Home: Home, "MC_Home" command, "homes by the method of the drive (6098h)";
    HomeDirect: HomeDirect, "MC_HomeDirect" command, "gives the axis its reference where it stands";
    HomeAbsolute: HomeAbsolute, "MC_HomeAbsolute" command, "takes the reference of an absolute encoder";
    StepBlock: StepBlock, "MC_StepBlock" command, "runs against an obstacle with limited torque and takes it as the reference";
    FinishHoming: FinishHoming, "MC_FinishHoming" command, "ends steps of homing, by a distance away from the reference";
    Stop: Stop, "MC_Stop" command, "brakes to rest and lets no other motion begin while `Execute` is TRUE";
    Halt: Halt, "MC_Halt" command, "brakes to rest; another motion may take over";
    Reset: Reset, "MC_Reset", "leaves ErrorStop";
    MoveAbsolute: MoveAbsolute, "MC_MoveAbsolute" command, "moves to a position";
    MoveRelative: MoveRelative, "MC_MoveRelative" command, "moves by a distance from where it begins";
    MoveAdditive: MoveAdditive, "MC_MoveAdditive" command, "moves by a distance from the target of the move before";
    MoveSuperimposed: MoveSuperimposed, "MC_MoveSuperimposed" command,
        "moves by a distance on top of the motion under way";
    HaltSuperimposed: HaltSuperimposed, "MC_HaltSuperimposed",
        "brakes the motion on top, and leaves the one below alone";
    MoveVelocity: MoveVelocity, "MC_MoveVelocity" command, "changes to a velocity and keeps it";
    MoveContinuousAbsolute: MoveContinuousAbsolute, "MC_MoveContinuousAbsolute" command,
        "passes a position at a velocity and keeps that";
    MoveContinuousRelative: MoveContinuousRelative, "MC_MoveContinuousRelative" command,
        "moves by a distance, passes its end at a velocity and keeps that";
    PositionProfile: PositionProfile<Rows<Knot>, Rows<f64>>, "MC_PositionProfile" command,
        "moves through a table of positions";
    VelocityProfile: VelocityProfile<Rows<Pair>>, "MC_VelocityProfile" command, "moves by a table of velocities";
    AccelerationProfile: AccelerationProfile<Rows<Pair>>, "MC_AccelerationProfile" command,
        "moves by a table of accelerations";
    SetPosition: SetPosition, "MC_SetPosition", "gives the axis a position without moving it";
    SetOverride: SetOverride, "MC_SetOverride",
        "scales velocities, accelerations and jerks as long as it is enabled";
    TorqueControl: TorqueControl, "MC_TorqueControl" command, "changes to a torque or force and keeps it";
    ReadStatus: ReadStatus, "MC_ReadStatus", "reads the state of the axis";
    ReadMotionState: ReadMotionState, "MC_ReadMotionState", "reads whether the axis accelerates or decelerates, and its direction";
    ReadAxisInfo: ReadAxisInfo, "MC_ReadAxisInfo", "reads switches, power, reference and warnings of the axis";
    ReadDigitalInput: ReadDigitalInput, "MC_ReadDigitalInput", "reads a digital input of the drive";
    ReadDigitalOutput: ReadDigitalOutput, "MC_ReadDigitalOutput", "reads a digital output of the drive";
    WriteDigitalOutput: WriteDigitalOutput, "MC_WriteDigitalOutput", "sets a digital output of the drive";
    DigitalCamSwitch: DigitalCamSwitch<Rows<CamState>>, "MC_DigitalCamSwitch",
        "switches digital outputs of the drive by the position of the axis";
    TouchProbe: TouchProbe, "MC_TouchProbe", "records the position of the axis at a trigger";
    AbortTrigger: AbortTrigger, "MC_AbortTrigger", "stops waiting for the trigger";
    ReadParameter: ReadParameter, "MC_ReadParameter", "reads a parameter of the axis that is a number";
    ReadBoolParameter: ReadBoolParameter, "MC_ReadBoolParameter", "reads a parameter of the axis that is TRUE or FALSE";
    WriteParameter: WriteParameter, "MC_WriteParameter", "sets a parameter of the axis that is a number";
    WriteBoolParameter: WriteBoolParameter, "MC_WriteBoolParameter", "sets a parameter of the axis that is TRUE or FALSE";
    ReadAxisError: ReadAxisError, "MC_ReadAxisError", "reads the error of the axis";
    ReadActualPosition: ReadActualPosition, "MC_ReadActualPosition", "reads the actual position";
    ReadActualVelocity: ReadActualVelocity, "MC_ReadActualVelocity", "reads the actual velocity";
    ReadActualTorque: ReadActualTorque, "MC_ReadActualTorque", "reads the actual torque or force";
    AxisMove: AxisMove, "MAM" command, "Rockwell's axis move: from rest to rest by a trapezoid or an S-curve";
    Profile4th: Profile4th, "Profile4th" command, "the generator of fourth order as a block: moves to a position";
}

impl BlockName {
    /// The block of this name in the standard.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|block| block.name() == name)
    }

    /// The block's own version of an input; `None` if it has no such input.
    #[must_use]
    pub fn input(self, input: Input) -> Option<&'static BlockInput> {
        self.inputs().iter().find(|own| own.input == input)
    }
}

impl fmt::Display for BlockName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Output {
    /// True if a program can wait for the output: TRUE or FALSE, and not always the same.
    #[must_use]
    pub const fn is_condition(self) -> bool {
        matches!(self.value_type(), OutputType::Flag)
    }
}
