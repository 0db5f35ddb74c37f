//! `[plc]` and `[[call]]`: the PLC program, with its requirements on the rest of the file.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::File;
use crate::resolve::condition::{self, Instance};
use crate::resolve::inputs::{Defaults, Inputs};
use crate::resolve::keys::{Keys, Reported};
use crate::resolve::{block, refuse};
use crate::scenario::Plc;
use crate::source::{At, Sources, Span};
use servobench_plcopen::program::{Call, Condition, Update};
use servobench_plcopen::{BlockName, BufferMode, Input, Trigger, Value};

/// Values from the rest of the file that calls depend on.
pub(super) struct Known<'a> {
    /// Length of the run (s), if the file gives it.
    pub(super) duration: Option<f64>,
    /// Period of a modulo axis; absent for an axis with ends.
    pub(super) modulo: &'a Slot<f64>,
    /// True if the drive is in the mode profile velocity.
    pub(super) is_told_velocities: bool,
    pub(super) sources: &'a Sources,
}

/// The PLC program, if there is one.
#[expect(clippy::option_option, reason = "a wrong program is not the same as none")]
pub(super) fn resolve(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Option<Plc>> {
    let calls = match &file.call {
        Slot::Wrong(_) => return None,
        Slot::Given(calls) if !calls.value.0.is_empty() => &calls.value.0,
        Slot::Given(_) | Slot::Absent => {
            let (plc, modulo) = (file.plc.span(), file.axis.given().and_then(|axis| axis.modulo.span()));
            let keys = [("plc", plc), ("modulo", modulo)];
            refuse(&keys, "is for function blocks", "give a `[[call]]`, or leave it out", report);
            return Some(None);
        }
    };
    check_surroundings(file, calls, report);
    let instances = instances(calls, report);
    let (homing_required, ramp_start) = match file.plc.optional().ok()? {
        Some(plc) => {
            if !known.is_told_velocities {
                let help = "elsewhere the drive receives positions";
                refuse(&[("ramp_start", plc.ramp_start.span())], "is for the mode \"pv\"", help, report);
            }
            (plc.homing_required.optional().ok()?.copied(), plc.ramp_start.optional().ok()?.copied())
        }
        None => (None, None),
    };
    let homing_required = homing_required.unwrap_or(true);
    let velocity_ramps = known.is_told_velocities.then(|| ramp_start.unwrap_or_default());
    warn_of_refusals(calls, homing_required, report);
    let mut said = Reported::default();
    let defaults = Defaults::of(file.setpoint.given());
    let Known { modulo, is_told_velocities, sources, .. } = *known;
    let reading = block::Context { defaults: &defaults, modulo, is_told_velocities, sources };
    let conditions = condition::Context { instances: &instances, duration: known.duration };
    let resolved: Vec<_> = calls
        .iter()
        .zip(&instances)
        .map(|(call, instance)| self::call(&call.value, &instance.name, &reading, &conditions, &mut said, report))
        .collect();
    let starts: Vec<Option<Condition>> = resolved.iter().map(|(start, _)| *start).collect();
    condition::refuse_circles(&starts, &instances, report);
    let calls = resolved.into_iter().map(|(_, call)| call).collect::<Option<Vec<_>>>();
    Some(Some(Plc { homing_required, velocity_ramps, limits: defaults.limits()?, calls: calls? }))
}

/// Refuses tables that exclude calls, and reports missing ones that calls need.
fn check_surroundings(file: &File, calls: &[At<file::Call>], report: &mut Report) {
    let Some(first) = calls.first().map(|call| call.value.span) else { return };
    if file.program.given().is_some_and(|program| !program.0.is_empty()) {
        let help = "write the moves as calls, or leave the calls out";
        report.error(first, "`[[program]]` and `[[call]]` exclude each other", help);
    }
    if matches!(file.bus, Slot::Absent) {
        report.missing_with_help("", "bus", first, "function blocks command a drive on a fieldbus: give its `cycle`");
    }
    if let Some(run) = file.run.given()
        && matches!(run.duration, Slot::Absent)
    {
        let help = "the duration of calls is not known beforehand";
        report.missing_with_help("run", "duration", run.span, help);
    }
    if let Some(setpoint) = file.setpoint.given() {
        let of_blocks = |key: &str| matches!(key, "order" | "velocity" | "acceleration" | "jerk" | "snap");
        let unused: Vec<_> = Keys::of_setpoint(setpoint).named().filter(|(key, _)| !of_blocks(key)).collect();
        refuse(&unused, "is not used by function blocks", "they plan from any state of motion", report);
    }
}

/// The calls with their names.
fn instances(calls: &[At<file::Call>], report: &mut Report) -> Vec<Instance> {
    let mut instances: Vec<Instance> = Vec::new();
    for call in calls {
        let call = &call.value;
        let block = call.block.given().copied();
        let name = match (call.name.at(), block) {
            (Some(name), _) => {
                check_name(name, report);
                name.value.clone()
            }
            (None, Some(block)) => {
                let before = instances.iter().filter(|instance| instance.block == Some(block)).count();
                format!("{block}_{before}")
            }
            (None, None) => String::new(),
        };
        let is_taken = instances.iter().any(|other| !name.is_empty() && other.name.eq_ignore_ascii_case(&name));
        if is_taken {
            let span = call.name.span().unwrap_or(call.span);
            report.error(span, format!("there is a call `{name}` already"), "each needs a different `name`");
        }
        instances.push(Instance { name, block, span: call.span, start: call.start.span() });
    }
    instances
}

/// Checks that the name of an instance is an identifier (IEC 61131-3).
fn check_name(name: &At<String>, report: &mut Report) {
    let mut letters = name.value.chars();
    let begins = letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_');
    if !begins || !letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
        let message = format!("\"{}\" is not the name of an instance", name.value);
        report.error(name.span, message, "write letters, digits and `_`, a letter first");
    }
}

/// Warns of calls that will be refused at execution: not an error, since that may be the purpose of the scenario.
fn warn_of_refusals(calls: &[At<file::Call>], homing_required: bool, report: &mut Report) {
    let has = |block| calls.iter().any(|call| call.value.block.given() == Some(&block));
    if calls.iter().any(|call| call.value.block.given().is_none()) {
        return;
    }
    if let (false, Some(first)) = (has(BlockName::Power), calls.first()) {
        let help = "call \"MC_Power\", and let the others wait for its `Status`";
        report.warning(first.value.span, "nothing powers the axis", help);
    }
    let is_blended = |call: &&At<file::Call>| {
        let modes = [BufferMode::Aborting, BufferMode::Buffered];
        let mode = call.value.inputs.slot(Input::BufferMode).given();
        call.value.block.given().is_some_and(|block| block.homes())
            && matches!(mode, Some(Value::BufferMode(mode)) if !modes.contains(mode))
    };
    for home in calls.iter().filter(is_blended) {
        let help = "write \"buffered\", or leave it out";
        let span = home.value.inputs.slot(Input::BufferMode).span().unwrap_or(home.value.span);
        report.warning(span, "homing begins at Standstill and blends with nothing: the block will refuse it", help);
    }
    let is_absolute = |call: &&At<file::Call>| {
        let block = call.value.block.given();
        matches!(block, Some(BlockName::MoveAbsolute | BlockName::MoveContinuousAbsolute))
    };
    let is_homed = calls.iter().any(|call| call.value.block.given().is_some_and(|block| block.homes()));
    if let (true, false, Some(absolute)) = (homing_required, is_homed, calls.iter().find(is_absolute)) {
        let help = "call \"MC_Home\" before, or write `homing_required = false` in `[plc]`";
        report.warning(absolute.value.span, "the axis is never homed: this move will be refused", help);
    }
}

/// The start condition, and the call.
fn call(
    given: &file::Call,
    name: &str,
    reading: &block::Context<'_>,
    conditions: &condition::Context<'_>,
    said: &mut Reported,
    report: &mut Report,
) -> (Option<Condition>, Option<Call>) {
    let start = match &given.start {
        Slot::Absent => Some(Condition::AtOnce),
        Slot::Wrong(_) => None,
        Slot::Given(at) => condition::resolve(at, conditions, report),
    };
    let stop = match &given.stop {
        Slot::Absent => Some(None),
        Slot::Wrong(_) => None,
        Slot::Given(at) => condition::resolve(at, conditions, report).map(Some),
    };
    if let (Some(Condition::At(on)), Some(Some(Condition::At(off))), Some(span)) = (start, stop, given.stop.span())
        && off <= on
    {
        report.error(span, format!("it stops at {off} s and starts at {on} s: it is never TRUE"), "");
    }
    let timeout = timeout(given, start, conditions.duration, report);
    let block = given.block.given().copied();
    let inputs = Inputs::of_call(given);
    if let Some(block) = block {
        inputs.refuse_others(block, report);
    }
    let resolved = block.and_then(|block| reading.inputs(block, &inputs, said, report));
    let updates = block.and_then(|block| updates(given, block, &inputs, reading, conditions, said, report));
    let call = || {
        let (start, stop, timeout) = (start?, stop?, timeout?);
        let is_optional = given.optional.optional().ok()?.copied().unwrap_or(false);
        let (name, block, inputs, updates) = (name.to_owned(), block?, resolved?, updates?);
        Some(Call { name, block, inputs, start, stop, timeout, is_optional, updates })
    };
    (start, call())
}

/// Time limit of the wait for `start` (s).
fn timeout(given: &file::Call, start: Option<Condition>, duration: Option<f64>, report: &mut Report) -> Option<f64> {
    let at = match &given.timeout {
        Slot::Absent => return Some(f64::INFINITY),
        Slot::Wrong(_) => return None,
        Slot::Given(at) => at,
    };
    if let Some(Condition::AtOnce | Condition::At(_)) = start {
        report.error(at.span, "`timeout` is for a `start` that may not come", "leave it out");
    } else if let Some(duration) = duration.filter(|duration| at.value >= *duration) {
        report.error(at.span, format!("the run is over by then: it lasts {duration} s"), "");
    }
    Some(at.value)
}

fn updates(
    given: &file::Call,
    block: BlockName,
    inputs: &Inputs<'_>,
    reading: &block::Context<'_>,
    conditions: &condition::Context<'_>,
    said: &mut Reported,
    report: &mut Report,
) -> Option<Vec<Update>> {
    let Some(all) = given.updates.optional().ok()? else { return Some(Vec::new()) };
    if let Some(span) = given.updates.span() {
        refuse_updates(given, block, span, report);
    }
    let mut before = inputs.clone();
    let mut updates = Vec::new();
    for update in &all.0 {
        let update = &update.value;
        let changes = Inputs::of_update(given, update);
        changes.refuse_others(block, report);
        if changes.spans().next().is_none() {
            report.error(update.span, "this update changes nothing", "");
        }
        before = changes.or(&before);
        let resolved = reading.inputs(block, &before, said, report);
        let when = update.when.at().and_then(|when| condition::resolve(when, conditions, report));
        updates.push(when.zip(resolved).map(|(when, inputs)| Update { when, inputs }));
    }
    updates.into_iter().collect()
}

/// Refuses updates of latched inputs: those are taken at the rising edge of `Execute` unless `ContinuousUpdate` is TRUE (section 2.4 of the
/// standard).
fn refuse_updates(given: &file::Call, block: BlockName, span: Span, report: &mut Report) {
    if block.follows_inputs() {
        return;
    }
    let mut help = "";
    if block.trigger() == Trigger::Execute && block.input(Input::ContinuousUpdate).is_some() {
        match given.inputs.slot(Input::ContinuousUpdate) {
            Slot::Given(At { value: Value::Flag(true), .. }) | Slot::Wrong(_) => return,
            _ => help = "write `continuous_update = true`",
        }
    }
    report.error(span, format!("{block} keeps the inputs that it was started with"), help);
}
