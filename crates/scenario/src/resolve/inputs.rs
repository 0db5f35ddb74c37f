//! The inputs of a call as a file writes them, and what `[setpoint]` says where a block has such an input.
use crate::block::BlockName;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::resolve::keys::LIMITS;
use crate::scenario::Direction;
use crate::source::Span;

/// The inputs that are quantities and may change while a block is executed.
const QUANTITIES: [&str; 14] = [
    "position",
    "distance",
    "velocity",
    "end_velocity",
    "velocity_difference",
    "acceleration",
    "deceleration",
    "jerk",
    "snap",
    "torque",
    "torque_ramp",
    "velocity_factor",
    "acceleration_factor",
    "jerk_factor",
];

/// The inputs of a call, or those that an update changes.
#[derive(Clone)]
pub(super) struct Inputs<'a> {
    quantities: [&'a Slot<f64>; QUANTITIES.len()],
    pub(super) direction: &'a Slot<Direction>,
    /// `enable_positive` and `enable_negative`.
    pub(super) permissions: [&'a Slot<bool>; 2],
    /// The call, for the inputs that no update has.
    pub(super) call: &'a file::Call,
    is_update: bool,
}

/// The inputs of a table that has them all.
macro_rules! inputs_of {
    ($table:expr, $call:expr, $is_update:expr) => {
        Inputs {
            quantities: [
                &$table.position,
                &$table.distance,
                &$table.velocity,
                &$table.end_velocity,
                &$table.velocity_difference,
                &$table.acceleration,
                &$table.deceleration,
                &$table.jerk,
                &$table.snap,
                &$table.torque,
                &$table.torque_ramp,
                &$table.velocity_factor,
                &$table.acceleration_factor,
                &$table.jerk_factor,
            ],
            direction: &$table.direction,
            permissions: [&$table.enable_positive, &$table.enable_negative],
            call: $call,
            is_update: $is_update,
        }
    };
}

impl<'a> Inputs<'a> {
    pub(super) const fn of_call(call: &'a file::Call) -> Self {
        inputs_of!(call, call, false)
    }

    pub(super) const fn of_update(call: &'a file::Call, update: &'a file::Update) -> Self {
        inputs_of!(update, call, true)
    }

    /// These, and where one is absent that of `before`.
    pub(super) fn or(&self, before: &Self) -> Self {
        let quantities = std::array::from_fn(|i| either(self.quantities[i], before.quantities[i]));
        let permissions = std::array::from_fn(|i| either(self.permissions[i], before.permissions[i]));
        let direction = either(self.direction, before.direction);
        Self { quantities, direction, permissions, call: self.call, is_update: true }
    }

    /// A quantity by its name.
    pub(super) fn quantity(&self, name: &str) -> &'a Slot<f64> {
        let found = QUANTITIES.iter().position(|own| *own == name);
        found.map_or(&Slot::Absent, |which| self.quantities[which])
    }

    /// Their names, and where they are.
    pub(super) fn named(&self) -> impl Iterator<Item = (&'static str, Option<Span>)> {
        let quantities = QUANTITIES.into_iter().zip(self.quantities).map(|(name, slot)| (name, slot.span()));
        let call = self.call;
        let fixed = [
            ("buffer_mode", call.buffer_mode.span()),
            ("continuous_update", call.continuous_update.span()),
            ("relative", call.relative.span()),
            ("settling_time", call.settling_time.span()),
            ("reversed", call.reversed.span()),
            ("table", call.table.span()),
            ("time_scale", call.time_scale.span()),
            ("value_scale", call.value_scale.span()),
            ("position_offset", call.position_offset.span()),
            ("velocity_offset", call.velocity_offset.span()),
            ("acceleration_offset", call.acceleration_offset.span()),
        ];
        let fixed = fixed.into_iter().filter(|_| !self.is_update);
        let [positive, negative] = self.permissions.map(Slot::span);
        let changeable =
            [("direction", self.direction.span()), ("enable_positive", positive), ("enable_negative", negative)];
        quantities.chain(changeable).chain(fixed)
    }

    /// Objects to inputs that the block does not have.
    pub(super) fn refuse_others(&self, block: BlockName, report: &mut Report) {
        let interface = block.interface();
        let has = match interface.inputs {
            [] => "it has none".to_owned(),
            inputs => format!("its inputs are {}", inputs.join(", ")),
        };
        for (name, span) in self.named() {
            if let Some(span) = span.filter(|_| !interface.inputs.contains(&name)) {
                report.error(span, format!("{} has no input `{name}`", interface.name), &*has);
            }
        }
    }
}

/// The limits of `[setpoint]`, as far as its order uses them.
pub(super) struct Defaults<'a>([&'a Slot<f64>; 4]);

impl<'a> Defaults<'a> {
    pub(super) fn of(setpoint: Option<&'a file::Setpoint>) -> Self {
        let Some(setpoint) = setpoint else { return Self([&Slot::Absent; 4]) };
        let order = setpoint.order.given().map_or(LIMITS.len(), |order| *order as usize);
        let limits = [&setpoint.velocity, &setpoint.acceleration, &setpoint.jerk, &setpoint.snap];
        Self(std::array::from_fn(|i| if i < order { limits[i] } else { &Slot::Absent }))
    }

    /// All of them; infinite where there is none.
    pub(super) fn limits(&self) -> Option<[f64; 4]> {
        let mut limits = [f64::INFINITY; 4];
        for (limit, slot) in limits.iter_mut().zip(self.0) {
            *limit = slot.optional().ok()?.copied().unwrap_or(f64::INFINITY);
        }
        Some(limits)
    }

    /// A limit by its name.
    pub(super) fn limit(&self, name: &str) -> &'a Slot<f64> {
        LIMITS.iter().position(|own| *own == name).map_or(&Slot::Absent, |which| self.0[which])
    }
}

/// The own value before the other.
pub(super) fn either<'a, T>(own: &'a Slot<T>, other: &'a Slot<T>) -> &'a Slot<T> {
    if matches!(own, Slot::Absent) { other } else { own }
}
