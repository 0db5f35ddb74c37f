//! The function blocks that a call can name, and the keys of their inputs, from the list in `servobench_plcopen`.
use crate::diagnostic::Report;
use crate::field::{Field, Slot, key, written};
use crate::file::{CamSwitch, TableOfPoints, TrackOptions};
use crate::list::Many;
use crate::simple::{Name, OneOf};
use crate::source::At;
use crate::table::{GroupKey, OpenTable};
use crate::tree::Node;
use serde_json::{Value as Json, json};
use servobench_config::quantities::VELOCITY;
use servobench_config::{Choice as _, Kind::Axis, Measure, positive};
use servobench_files::suggestion;
use servobench_plcopen::program::Rows;
use servobench_plcopen::{AxisParameter, BlockName, BufferMode, Direction, Input, InputType, Output, Value};

impl Field for BlockName {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let Some(text) = node.value.as_text() else {
            let message = format!("`{}` must be the name of a function block, got {}", key(path), written(node));
            report.error(node.span, message, "write \"MC_MoveAbsolute\"");
            return None;
        };
        let found = Self::from_name(text);
        if found.is_none() {
            let names = Self::ALL.iter().map(|block| block.name());
            report.error(node.span, format!("unknown function block \"{text}\""), suggestion(text, names));
        }
        found
    }

    fn schema((): &()) -> Json {
        let each = Self::ALL.iter().map(|block| {
            let outputs: Vec<_> = conditions(*block).map(Output::name).collect();
            json!({
                "const": block.name(),
                "description": block.meaning(),
                "x-trigger": block.trigger().name(),
                "x-inputs": keys(*block),
                "x-outputs": outputs,
            })
        });
        json!({ "oneOf": each.collect::<Vec<_>>() })
    }
}

/// Keys of the inputs of `block`.
pub(crate) fn keys(block: BlockName) -> Vec<&'static str> {
    block.inputs().iter().map(|own| own.input.key()).collect()
}

/// The outputs of `block` that conditions can name.
pub(crate) fn conditions(block: BlockName) -> impl Iterator<Item = Output> {
    block.outputs().iter().copied().filter(|output| output.is_condition())
}

/// Moment at which inputs are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moment {
    /// Before the block is executed: all inputs.
    Start,
    /// During execution: the inputs that may change.
    Later,
}

impl Moment {
    fn inputs(self) -> impl Iterator<Item = Input> {
        Input::ALL.iter().copied().filter(move |input| self == Self::Start || input.may_change())
    }
}

/// An input as written in a file.
pub(crate) type Given = Value<GivenRows>;

/// The table of an input as written in a file.
pub(crate) type GivenRows = Rows<Box<At<TableOfPoints>>, Vec<At<CamSwitch>>, Vec<At<TrackOptions>>>;

/// Inputs of all blocks, indexed by `Input`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BlockInputs(Vec<Slot<Given>>);

impl BlockInputs {
    pub(crate) fn keys(moment: Moment) -> impl Iterator<Item = &'static str> {
        moment.inputs().map(Input::key)
    }

    pub(crate) fn read(open: &mut OpenTable<'_>, moment: Moment) -> Self {
        let mut slots = vec![Slot::Absent; Input::ALL.len()];
        for input in moment.inputs() {
            let key = input.key();
            slots[input as usize] = match input.value_type() {
                InputType::Quantity(measure) => open.field(key, &measure).map(|at| Value::Number(at.value)),
                InputType::Flag => open.field(key, &()).map(|at| Value::Flag(at.value)),
                InputType::Direction => open.field(key, &OneOf).map(|at| Value::Direction(at.value)),
                InputType::BufferMode => open.field(key, &OneOf).map(|at| Value::BufferMode(at.value)),
                InputType::Table => open.field(key, &()).map(|at| Value::Table(Rows::Profile(Box::new(at)))),
                InputType::Switches => {
                    open.field(key, &()).map(|at: At<Many<_>>| Value::Table(Rows::Switches(at.value.0)))
                }
                InputType::Tracks => open.field(key, &()).map(|at: At<Many<_>>| Value::Table(Rows::Tracks(at.value.0))),
                InputType::Whole(lowest, highest) => {
                    open.field(key, &(lowest..=highest)).map(|at: At<u32>| Value::Number(at.value.into()))
                }
                InputType::Choice(names) => open.field(key, &names).map(|at: At<Name>| Value::Choice(at.value.0)),
                InputType::ParameterValue => {
                    let measure = parameter_value(&slots[Input::Parameter as usize]);
                    open.field(key, &measure).map(|at| Value::Number(at.value))
                }
            };
        }
        Self(slots)
    }

    pub(crate) fn schemas(moment: Moment) -> Vec<GroupKey<1>> {
        let of = |input: Input| {
            let meaning = match moment {
                Moment::Start => input.meaning_with_default(),
                Moment::Later => input.meaning(),
            };
            let schema = match input.value_type() {
                InputType::Quantity(measure) => f64::schema(&measure),
                InputType::Flag => bool::schema(&()),
                InputType::Direction => Direction::schema(&OneOf),
                InputType::BufferMode => BufferMode::schema(&OneOf),
                InputType::Table => TableOfPoints::schema(&()),
                InputType::Switches => Many::<CamSwitch>::schema(&()),
                InputType::Tracks => Many::<TrackOptions>::schema(&()),
                InputType::Whole(lowest, highest) => u32::schema(&(lowest..=highest)),
                InputType::Choice(names) => Name::schema(&names),
                InputType::ParameterValue => f64::schema(&parameter_value(&Slot::Absent)),
            };
            (input.key(), ("", [meaning]), schema)
        };
        moment.inputs().map(of).collect()
    }

    pub(crate) fn slot(&self, input: Input) -> &Slot<Given> {
        &self.0[input as usize]
    }
}

/// Measure of the value written to the parameter in `slot`: a velocity, as most are, if the parameter is missing or cannot be written.
fn parameter_value(slot: &Slot<Given>) -> Measure {
    let measure = match slot.given() {
        Some(Value::Choice(name)) => AxisParameter::from_name(name).and_then(AxisParameter::written_as),
        _ => None,
    };
    measure.unwrap_or(positive(Axis(&VELOCITY), "0.5 m/s"))
}

impl<T> Slot<T> {
    fn map<U>(self, of: impl FnOnce(At<T>) -> U) -> Slot<U> {
        match self {
            Self::Absent => Slot::Absent,
            Self::Wrong(span) => Slot::Wrong(span),
            Self::Given(at) => Slot::Given(At { span: at.span, value: of(at) }),
        }
    }
}
