//! The inputs of a call in the file, and their defaults from `[setpoint]`.
use crate::block::{Given, keys};
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::resolve::keys::LIMITS;
use crate::source::{At, Span};
use servobench_plcopen::{BlockName, Input, Value};

/// The inputs of a call, or those changed by an update.
#[derive(Clone)]
pub(super) struct Inputs<'a> {
    slots: Vec<&'a Slot<Given>>,
    /// Header of the call.
    pub(super) header: Span,
}

impl<'a> Inputs<'a> {
    pub(super) fn of_call(call: &'a file::Call) -> Self {
        Self { slots: Input::ALL.iter().map(|input| call.inputs.slot(*input)).collect(), header: call.span }
    }

    pub(super) fn of_update(call: &'a file::Call, update: &'a file::Update) -> Self {
        Self { slots: Input::ALL.iter().map(|input| update.inputs.slot(*input)).collect(), header: call.span }
    }

    /// These inputs, with those of `before` where absent.
    pub(super) fn or(&self, before: &Self) -> Self {
        let slots = self.slots.iter().zip(&before.slots).map(|(own, before)| either(own, before)).collect();
        Self { slots, header: self.header }
    }

    pub(super) fn slot(&self, input: Input) -> &'a Slot<Given> {
        self.slots[input as usize]
    }

    /// A quantity.
    pub(super) fn number(&self, input: Input) -> Slot<f64> {
        match self.slot(input) {
            Slot::Given(At { value: Value::Number(number), span }) => Slot::Given(At { value: *number, span: *span }),
            Slot::Wrong(span) => Slot::Wrong(*span),
            _ => Slot::Absent,
        }
    }

    /// Places of the given inputs.
    pub(super) fn spans(&self) -> impl Iterator<Item = (Input, Span)> {
        Input::ALL.iter().zip(&self.slots).filter_map(|(input, slot)| Some((*input, slot.span()?)))
    }

    /// Refuses inputs that the block does not have.
    pub(super) fn refuse_others(&self, block: BlockName, report: &mut Report) {
        let keys = keys(block);
        let has = match &*keys {
            [] => "it has none".to_owned(),
            inputs => format!("its inputs are {}", inputs.join(", ")),
        };
        for (input, span) in self.spans().filter(|(input, _)| block.input(*input).is_none()) {
            report.error(span, format!("{block} has no input `{}`", input.key()), &*has);
        }
    }
}

/// The limits of `[setpoint]` that its order uses.
pub(super) struct Defaults<'a>([&'a Slot<f64>; 4]);

impl<'a> Defaults<'a> {
    pub(super) fn of(setpoint: Option<&'a file::Setpoint>) -> Self {
        let Some(setpoint) = setpoint else { return Self([&Slot::Absent; 4]) };
        let order = setpoint.order.given().map_or(LIMITS.len(), |order| *order as usize);
        let limits = [&setpoint.velocity, &setpoint.acceleration, &setpoint.jerk, &setpoint.snap];
        Self(std::array::from_fn(|i| if i < order { limits[i] } else { &Slot::Absent }))
    }

    /// All limits; infinite where none is given.
    pub(super) fn limits(&self) -> Option<[f64; 4]> {
        let mut limits = [f64::INFINITY; 4];
        for (limit, slot) in limits.iter_mut().zip(self.0) {
            *limit = slot.optional().ok()?.copied().unwrap_or(f64::INFINITY);
        }
        Some(limits)
    }

    /// The limit for an input.
    pub(super) fn limit(&self, input: Input) -> &'a Slot<f64> {
        LIMITS.iter().position(|own| *own == input.key()).map_or(&Slot::Absent, |which| self.0[which])
    }
}

/// `own`, or `other` if absent.
fn either<'a, T>(own: &'a Slot<T>, other: &'a Slot<T>) -> &'a Slot<T> {
    if matches!(own, Slot::Absent) { other } else { own }
}
