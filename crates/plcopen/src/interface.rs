//! Interface of blocks by name: inputs, their defaults, and outputs.
use crate::blocks::{CamSwitch, Follow, Input, MoveType, Pair, TrackOptions, ValueSource};
use crate::command::{BufferMode, Direction};
use crate::parameter::{AxisBoolParameter, AxisParameter};
use servobench_config::{Bound, Choice, Measure};
use servobench_fieldbus::ProbeTrigger;
use servobench_motion::rockwell::ShapeKind;

/// Input that starts and ends a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Trigger {
    /// The rising edge of Execute.
    Execute,
    /// Enable, as long as it is TRUE.
    Enable,
}

impl Trigger {
    /// Name in the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Execute => "Execute",
            Self::Enable => "Enable",
        }
    }
}

/// Type of an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InputType {
    /// A number.
    Quantity(Measure),
    /// A whole number, from the first to the second one.
    Whole(u32, u32),
    /// TRUE or FALSE.
    Flag,
    /// Direction of the axis.
    Direction,
    /// Relation to the active motion.
    BufferMode,
    /// The rows of a profile.
    Table,
    /// The switches of MC_DigitalCamSwitch.
    Switches,
    /// The options of tracks of MC_DigitalCamSwitch.
    Tracks,
    /// One of these alternatives: their names and meanings.
    Choice(&'static [(&'static str, &'static str)]),
    /// A value of the parameter given by [`Input::Parameter`].
    ParameterValue,
}

/// An input of a certain block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockInput {
    /// Input.
    pub input: Input,
    /// Default.
    pub absent: Absent,
    /// Bound of this block, in addition to that of the input.
    pub bound: Bound,
}

/// Default of an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Absent {
    /// None: the input must be given. The reason, beyond the fact that the block needs it.
    Refused(Option<&'static str>),
    /// This number.
    Number(f64),
    /// TRUE or FALSE.
    Flag(bool),
    /// This direction.
    Direction(Direction),
    /// The active motion is aborted.
    Aborting,
    /// None: the input is optional.
    Nothing,
    /// Value of another input.
    As(Input),
    /// The limit of the axis for this input; the axis must have one.
    Limit(Input),
    /// The limit of the axis, if it has one.
    LimitIfAny(Input),
}

impl BlockInput {
    const fn new(input: Input, absent: Absent) -> Self {
        Self { input, absent, bound: Bound::Any }
    }

    /// The same input, which must be above zero for this block.
    pub(crate) const fn positive(self) -> Self {
        Self { bound: Bound::Positive, ..self }
    }
}

/// An input that must be given.
pub(crate) const fn required(input: Input) -> BlockInput {
    BlockInput::new(input, Absent::Refused(None))
}

/// An input that must be given, for this reason.
pub(crate) const fn required_for(input: Input, why: &'static str) -> BlockInput {
    BlockInput::new(input, Absent::Refused(Some(why)))
}

/// A number with a default.
pub(crate) const fn or(input: Input, number: f64) -> BlockInput {
    BlockInput::new(input, Absent::Number(number))
}

/// A flag with a default.
pub(crate) const fn flag(input: Input, otherwise: bool) -> BlockInput {
    BlockInput::new(input, Absent::Flag(otherwise))
}

/// A direction with a default.
pub(crate) const fn direction(otherwise: Direction) -> BlockInput {
    BlockInput::new(Input::Direction, Absent::Direction(otherwise))
}

/// BufferMode.
pub(crate) const fn buffer_mode() -> BlockInput {
    BlockInput::new(Input::BufferMode, Absent::Aborting)
}

/// A limit of this block; by default that of the axis.
pub(crate) const fn limit(input: Input) -> BlockInput {
    BlockInput::new(input, Absent::Limit(input))
}

/// A limit of this block or of the axis, if either has one.
pub(crate) const fn limit_if_any(input: Input) -> BlockInput {
    BlockInput::new(input, Absent::LimitIfAny(input))
}

/// An optional input; a choice defaults to its first alternative.
pub(crate) const fn optional(input: Input) -> BlockInput {
    BlockInput::new(input, Absent::Nothing)
}

/// An input whose default is the value of `other`.
pub(crate) const fn like(input: Input, other: Input) -> BlockInput {
    BlockInput::new(input, Absent::As(other))
}

/// Deceleration of a block that only brakes; by default the limit of the acceleration.
pub(crate) const fn braking() -> BlockInput {
    BlockInput::new(Input::Deceleration, Absent::Limit(Input::Acceleration))
}

/// A value of an input; tables are kept as `T`, which implements [`Tables`] where blocks read them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<T> {
    /// A number (SI).
    Number(f64),
    /// TRUE or FALSE.
    Flag(bool),
    /// Direction of the axis.
    Direction(Direction),
    /// Relation to the active motion.
    BufferMode(BufferMode),
    /// The rows of a profile, switches, or options of tracks.
    Table(T),
    /// The name of an alternative.
    Choice(&'static str),
}

/// Rows of a profile, kept as `P`, and their interpretation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table<P> {
    /// The rows.
    pub pairs: P,
    /// True if positions count from the beginning of the profile.
    pub is_relative: bool,
    /// Interpolation between the positions.
    pub follow: Follow,
}

/// Storage for the table of an input.
pub trait Tables {
    /// The rows of a profile.
    fn profile(&self) -> Option<Table<&[Pair]>> {
        None
    }

    /// The switches of MC_DigitalCamSwitch.
    fn switches(&self) -> &[CamSwitch] {
        &[]
    }

    /// The options of tracks of MC_DigitalCamSwitch.
    fn tracks(&self) -> &[TrackOptions] {
        &[]
    }
}

/// Stores profiles only.
impl<P: AsRef<[Pair]>> Tables for Table<P> {
    fn profile(&self) -> Option<Table<&[Pair]>> {
        Some(Table { pairs: self.pairs.as_ref(), is_relative: self.is_relative, follow: self.follow })
    }
}

/// Values of inputs by name; missing ones take the default of the block.
#[derive(Debug, Clone, PartialEq)]
pub struct Values<T>([Option<Value<T>>; Input::ALL.len()]);

impl<T> Default for Values<T> {
    fn default() -> Self {
        Self([const { None }; Input::ALL.len()])
    }
}

impl<T> Values<T> {
    /// Gives `input` a value.
    pub fn set(&mut self, input: Input, value: Value<T>) {
        self.0[input as usize] = Some(value);
    }

    /// Value of `input`, if it has one.
    #[must_use]
    pub const fn get(&self, input: Input) -> Option<&Value<T>> {
        self.0[input as usize].as_ref()
    }

    /// Number of `input`, if it has one.
    #[must_use]
    pub fn number(&self, input: Input) -> Option<f64> {
        if let Some(Value::Number(number)) = self.get(input) { Some(*number) } else { None }
    }

    /// Table of `input`, if it has one.
    #[must_use]
    pub fn table(&self, input: Input) -> Option<&T> {
        if let Some(Value::Table(table)) = self.get(input) { Some(table) } else { None }
    }
}

/// The inputs of a block.
pub trait BlockInputs<'i>: Sized {
    /// Input that starts and ends the block.
    const TRIGGER: Trigger;
    /// Other inputs, in the order of the list.
    const INPUTS: &'static [BlockInput];
    /// True if the inputs apply as they are in every cycle, rather than as they were at the start.
    const ARE_FOLLOWED: bool = matches!(Self::TRIGGER, Trigger::Enable) && !Self::INPUTS.is_empty();

    /// Inputs from `values`, with Execute or Enable as `trigger`. A missing required number is NaN, which blocks refuse.
    fn read<T: Tables>(values: &'i Values<T>, trigger: bool) -> Self;
}

/// A type that an input can have.
pub(crate) trait FromValues: Sized {
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self;
}

impl FromValues for f64 {
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
        values.number(own.input).unwrap_or_else(|| match own.absent {
            Absent::Number(number) => number,
            Absent::As(other) => values.number(other).unwrap_or(Self::NAN),
            _ => Self::NAN,
        })
    }
}

/// A whole number: a bit, or a mask of bits.
impl FromValues for u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and within its range")]
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
        let otherwise = if let Absent::Number(number) = own.absent { number } else { 0.0 };
        values.number(own.input).unwrap_or(otherwise) as Self
    }
}

/// A number that may be left to the axis.
impl FromValues for Option<f64> {
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
        values.number(own.input)
    }
}

impl FromValues for bool {
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
        match (values.get(own.input), own.absent) {
            (Some(Value::Flag(flag)), _) => *flag,
            (_, absent) => absent == Absent::Flag(true),
        }
    }
}

impl FromValues for Direction {
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
        match (values.get(own.input), own.absent) {
            (Some(Value::Direction(direction)), _) => *direction,
            (_, Absent::Direction(direction)) => direction,
            _ => Self::default(),
        }
    }
}

impl FromValues for BufferMode {
    fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
        if let Some(Value::BufferMode(mode)) = values.get(own.input) { *mode } else { Self::default() }
    }
}

/// Names and meanings of the `N` alternatives of `T`.
pub(crate) const fn names<T: Choice, const N: usize>() -> [(&'static str, &'static str); N] {
    let mut names = [("", ""); N];
    let mut at = 0;
    while at < N {
        let (name, _, meaning) = T::ALL[at];
        names[at] = (name, meaning);
        at += 1;
    }
    names
}

/// Implements reading by name for types of alternatives; the default is the first one.
macro_rules! read_by_name {
    ($($type:ty),+) => { $(
        impl FromValues for $type {
            fn read<T>(values: &Values<T>, own: &BlockInput) -> Self {
                let given = if let Some(Value::Choice(name)) = values.get(own.input) { Self::from_name(name) } else { None };
                given.unwrap_or(Self::ALL[0].1)
            }
        }
    )+ };
}

read_by_name! { AxisParameter, AxisBoolParameter, ProbeTrigger, MoveType, ShapeKind, ValueSource }

/// Types of outputs.
pub(crate) trait Recorded {
    /// Value as recorded; TRUE is 1.
    fn recorded(self) -> f64;
}

impl Recorded for bool {
    fn recorded(self) -> f64 {
        f64::from(u8::from(self))
    }
}

impl Recorded for crate::ErrorId {
    fn recorded(self) -> f64 {
        f64::from(self.number())
    }
}

impl Recorded for u16 {
    fn recorded(self) -> f64 {
        f64::from(self)
    }
}

impl Recorded for f64 {
    fn recorded(self) -> f64 {
        self
    }
}

/// Type of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum OutputType {
    /// TRUE or FALSE.
    Flag,
    /// Always FALSE: the condition does not occur here.
    Never,
    /// A number.
    Number,
}

/// Declares the inputs of a block: the struct, the defaults, and reading by name.
macro_rules! inputs {
    ($(#[$meta:meta])* pub struct $name:ident on $trigger:ident {}) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, servobench_base::Stateful)]
        pub struct $name {
            #[doc = $crate::interface::inputs!(@doc $trigger)]
            pub $trigger: bool,
        }

        impl $crate::interface::BlockInputs<'_> for $name {
            const TRIGGER: $crate::Trigger = $crate::interface::inputs!(@trigger $trigger);
            const INPUTS: &'static [$crate::BlockInput] = &[];

            fn read<T: $crate::Tables>(_: &$crate::Values<T>, $trigger: bool) -> Self {
                Self { $trigger }
            }
        }
    };
    (
        $(#[$meta:meta])*
        pub struct $name:ident on $trigger:ident {
            $( $(#[$field_meta:meta])* $field:ident: $type:ty = $spec:expr, )+
        }
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, servobench_base::Stateful)]
        pub struct $name {
            #[doc = $crate::interface::inputs!(@doc $trigger)]
            pub $trigger: bool,
            $( $(#[$field_meta])* pub $field: $type, )+
        }

        impl $crate::interface::BlockInputs<'_> for $name {
            const TRIGGER: $crate::Trigger = $crate::interface::inputs!(@trigger $trigger);
            const INPUTS: &'static [$crate::BlockInput] = &[$($spec,)+];

            fn read<T: $crate::Tables>(values: &$crate::Values<T>, trigger: bool) -> Self {
                Self {
                    $trigger: trigger,
                    $( $field: $crate::interface::FromValues::read(values, const { &$spec }), )+
                }
            }
        }
    };
    (@doc execute) => { "Execute." };
    (@doc enable) => { "Enable." };
    (@trigger execute) => { $crate::Trigger::Execute };
    (@trigger enable) => { $crate::Trigger::Enable };
}

/// Declares the outputs of a block: the struct, and the output of each field.
macro_rules! outputs {
    (
        $(#[$meta:meta])*
        pub struct $name:ident {
            $( $(#[$field_meta:meta])* $field:ident: $type:ty = $output:ident, )+
        }
    ) => {
        $(#[$meta])*
        pub struct $name {
            $( $(#[$field_meta])* pub $field: $type, )+
        }

        impl $crate::Outputs for $name {
            const LIST: &'static [$crate::Output] = &[$($crate::Output::$output),+];

            fn each(&self, mut record: impl FnMut(f64)) {
                $( record($crate::interface::Recorded::recorded(self.$field)); )+
            }
        }
    };
}

/// Declares the outputs of a block that gives a motion command: the one that reports success, with the report that sets it, and those
/// common to all of them.
macro_rules! command_outputs {
    ($(#[$meta:meta])* pub struct $name:ident; $(#[$aim_meta:meta])* $aim:ident = $output:ident by $report:ident) => {
        $crate::interface::outputs! {
            $(#[$meta])*
            #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
            pub struct $name {
                $(#[$aim_meta])*
                $aim: bool = $output,
                /// Busy: the block is neither done nor aborted.
                busy: bool = Busy,
                /// Active: the block has the axis.
                active: bool = Active,
                /// CommandAborted: another command took the axis.
                command_aborted: bool = CommandAborted,
                /// Error.
                error: bool = Error,
                /// ErrorID.
                error_id: $crate::ErrorId = ErrorId,
            }
        }

        impl From<$crate::Report> for $name {
            fn from(report: $crate::Report) -> Self {
                Self {
                    $aim: report == $crate::Report::$report,
                    busy: report.is_busy(),
                    active: report.is_active(),
                    command_aborted: report == $crate::Report::Aborted,
                    error: report.error_id() != $crate::ErrorId::None,
                    error_id: report.error_id(),
                }
            }
        }
    };
}

pub(crate) use {command_outputs, inputs, outputs};
