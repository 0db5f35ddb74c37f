//! `[setpoint]` and `[[program]]` to steps.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::File;
use crate::resolve::{Way, has_window, limits, one_way};
use crate::scenario::{LONGEST_RUN, MoveStep, Step, Target};
use crate::source::{At, Span};
use servobench_base::Rate;
use std::collections::BTreeSet;

/// Keys of the limits, velocity first.
const LIMITS: [&str; 4] = ["velocity", "acceleration", "jerk", "snap"];

/// What a move says of itself, or `[setpoint]` for all.
struct Profile<'a> {
    order: &'a Slot<u32>,
    limits: [&'a Slot<f64>; 4],
    sample_time: &'a Slot<f64>,
    duration: &'a Slot<f64>,
}

/// What the steps need to know of the rest of the file.
struct Known {
    base_rate: Option<Rate>,
    /// Whether there is a settling window.
    has_window: bool,
}

/// What has been said of `[setpoint]` already: once is enough for all moves.
#[derive(Default)]
struct Said {
    missing: Vec<&'static str>,
    places: BTreeSet<Span>,
}

pub(super) fn steps(file: &File, base_rate: Option<Rate>, report: &mut Report) -> Option<Vec<Step>> {
    let Some(program) = file.program.optional().ok()? else { return Some(Vec::new()) };
    refuse_endless(&program.0, report);
    let mut said = Said::default();
    let known = Known { base_rate, has_window: has_window(file) };
    let steps: Vec<_> = program
        .0
        .iter()
        .map(|step| self::step(&step.value, file.setpoint.given(), &known, &mut said, report))
        .collect();
    steps.into_iter().collect()
}

/// Objects to the step whose pauses and given durations lead beyond the longest run. How long the other moves last is
/// known when they are planned.
fn refuse_endless(program: &[At<file::ProgramStep>], report: &mut Report) {
    let mut end = 0.0;
    for step in program {
        let Some(length) = step.value.wait.at().or(step.value.duration.at()) else { continue };
        end += length.value;
        if end > LONGEST_RUN {
            let message = format!("the program would last {end} s at least, a run lasts {LONGEST_RUN} s at most");
            report.error(length.span, message, "");
            return;
        }
    }
}

fn step(
    step: &file::ProgramStep,
    defaults: Option<&file::Setpoint>,
    known: &Known,
    said: &mut Said,
    report: &mut Report,
) -> Option<Step> {
    let own = Profile {
        order: &step.order,
        limits: [&step.velocity, &step.acceleration, &step.jerk, &step.snap],
        sample_time: &step.sample_time,
        duration: &step.duration,
    };
    let defaults = defaults.map(|all| Profile {
        order: &all.order,
        limits: [&all.velocity, &all.acceleration, &all.jerk, &all.snap],
        sample_time: &all.sample_time,
        duration: &Slot::Absent,
    });
    let ways = [("move_to", step.move_to.span()), ("move_by", step.move_by.span()), ("wait", step.wait.span())];
    let there: Vec<_> = ways.iter().filter(|(_, span)| span.is_some()).collect();
    if let [(first, _), (second, Some(span)), ..] = there.as_slice() {
        report.error(*span, format!("`{first}` and `{second}` in one step"), "write two steps");
        return None;
    }
    let target = match one_way(&ways, report) {
        Way::Use(0) => step.move_to.given().copied().map(Target::Absolute),
        Way::Use(1) => step.move_by.given().copied().map(Target::Relative),
        Way::Use(_) => {
            no_profile(&own, step.limits.span(), report);
            return step.wait.given().copied().map(Step::Wait);
        }
        Way::Contradiction => return None,
        Way::None => {
            report.lacking("program", step.span, "this step does nothing", "give `move_to`, `move_by` or `wait`");
            return None;
        }
    };
    let profile = profile(&own, defaults.as_ref(), step.span, known.base_rate, said, report);
    let metric_limits =
        step.limits.optional().ok().map(|own| own.map_or_else(Vec::new, |own| limits(own, known.has_window, report)));
    let (order, limits, sample_time) = profile?;
    let duration = own.duration.optional().ok()?.copied();
    Some(Step::Move(MoveStep { target: target?, order, limits, sample_time, duration, metric_limits: metric_limits? }))
}

/// Objects to keys of a move in a pause.
fn no_profile(own: &Profile<'_>, metric_limits: Option<Span>, report: &mut Report) {
    let limits = LIMITS.into_iter().zip(own.limits).map(|(key, slot)| (key, slot.span()));
    let others = [
        ("order", own.order.span()),
        ("sample_time", own.sample_time.span()),
        ("duration", own.duration.span()),
        ("limits", metric_limits),
    ];
    for (key, span) in limits.chain(others) {
        if let Some(span) = span {
            report.error(span, format!("a pause has no `{key}`"), "");
        }
    }
}

fn profile(
    own: &Profile<'_>,
    defaults: Option<&Profile<'_>>,
    header: Span,
    base_rate: Option<Rate>,
    said: &mut Said,
    report: &mut Report,
) -> Option<(u8, [f64; 4], Option<f64>)> {
    let order = either(own.order, defaults.map(|all| all.order));
    let slots: [&Slot<f64>; 4] = std::array::from_fn(|i| either(own.limits[i], defaults.map(|all| all.limits[i])));
    let Some(order_value) = order.given().and_then(|order| u8::try_from(*order).ok()) else {
        if matches!(order, Slot::Absent) {
            said.missing("order", header, "2, 3 or 4", report);
        }
        // Whatever the order is, it limits these.
        for (key, slot) in LIMITS.into_iter().zip(slots).take(2) {
            if matches!(slot, Slot::Absent) {
                said.missing(key, header, "every move needs it", report);
            }
        }
        return None;
    };
    let mut limits = [f64::INFINITY; 4];
    let mut is_complete = true;
    for (i, slot) in slots.into_iter().enumerate() {
        let is_limited = i < usize::from(order_value);
        match slot {
            Slot::Given(at) if is_limited => limits[i] = at.value,
            Slot::Given(At { span, .. }) => {
                let message = format!("`{}` is not used by a move of order {order_value}", LIMITS[i]);
                said.once(*span, |report| report.warning(*span, message, ""), report);
            }
            Slot::Absent if is_limited => {
                said.missing(LIMITS[i], header, &format!("a move of order {order_value} needs it"), report);
                is_complete = false;
            }
            Slot::Wrong(_) => is_complete = false,
            Slot::Absent => {}
        }
    }
    let sample_time = match either(own.sample_time, defaults.map(|all| all.sample_time)) {
        Slot::Absent => Some(None),
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole_ticks(*at, base_rate, said, report).map(Some),
    };
    let sample_time = sample_time?;
    is_complete.then_some((order_value, limits, sample_time))
}

/// The move's own value before that of `[setpoint]`.
fn either<'a, T>(own: &'a Slot<T>, default: Option<&'a Slot<T>>) -> &'a Slot<T> {
    match (own, default) {
        (Slot::Absent, Some(default)) => default,
        _ => own,
    }
}

/// A sample time that must be a whole number of base ticks.
fn whole_ticks(time: At<f64>, base_rate: Option<Rate>, said: &mut Said, report: &mut Report) -> Option<f64> {
    let hertz = f64::from(base_rate?.hertz());
    let ticks = time.value * hertz;
    if ticks.round() >= 1.0 && (ticks - ticks.round()).abs() <= 1e-9 * ticks {
        // Not as typed: what 83.33333333 us lacks of a tick at 12 kHz would add up over the samples of a move.
        return Some(ticks.round() / hertz);
    }
    let in_microseconds = |ticks: f64| ticks * base_rate.map_or(0.0, Rate::period) * 1e6;
    let near = format!("{} us", in_microseconds(ticks.round().max(1.0)));
    let message = format!("`sample_time` is {ticks:.4} base ticks, not a whole number");
    said.once(time.span, |report| report.error(time.span, message, format!("{near} fits")), report);
    None
}

impl Said {
    fn missing(&mut self, key: &'static str, header: Span, why: &str, report: &mut Report) {
        if !self.missing.contains(&key) {
            self.missing.push(key);
            report.missing_with_help("setpoint", key, header, why);
        }
    }

    fn once(&mut self, place: Span, say: impl FnOnce(&mut Report), report: &mut Report) {
        if self.places.insert(place) {
            say(report);
        }
    }
}
