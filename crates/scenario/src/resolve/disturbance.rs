//! `[[disturbance]]` and `[initial]`: external efforts and the initial state.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::File;
use crate::scenario::{Axis, AxisMechanics, Disturbance, DisturbedBody, Initial};
use servobench_base::{Coordinate, Rate};

/// Base rate and length of the run (s), if the file gives them.
pub(super) struct Timing {
    pub(super) base_rate: Option<Rate>,
    pub(super) duration: Option<f64>,
}

/// Bodies that follow the set-point exactly, regardless of disturbances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fixed {
    /// The motor.
    Motor,
    /// The only body, both motor and load.
    Everything,
}

impl Fixed {
    /// For an axis whose motion is prescribed.
    pub(super) fn of(axis: Option<&Axis>) -> Self {
        let has_one_body = axis.is_some_and(|axis| match &axis.mechanics {
            AxisMechanics::Bodies(chain) => chain.bodies().len() == 1,
            AxisMechanics::Mjcf(mjcf) => mjcf.motor_joint == mjcf.load_joint,
            AxisMechanics::InTheFmu => false,
        });
        if has_one_body { Self::Everything } else { Self::Motor }
    }
}

/// Advice about a load that cannot move separately.
const GIVE_STIFFNESS: &str = "give `stiffness` in `[axis.load]`, or a motor that is not prescribed";

pub(super) fn disturbances(
    file: &File,
    timing: &Timing,
    fixed: Option<Fixed>,
    report: &mut Report,
) -> Option<Vec<Disturbance>> {
    let Some(all) = file.disturbance.optional().ok()? else { return Some(Vec::new()) };
    let resolved: Vec<_> = all.0.iter().map(|one| disturbance(&one.value, timing, fixed, report)).collect();
    resolved.into_iter().collect()
}

fn disturbance(
    given: &file::Disturbance,
    timing: &Timing,
    fixed: Option<Fixed>,
    report: &mut Report,
) -> Option<Disturbance> {
    let on = given.on.at()?;
    let (motion, body) = match on.value {
        DisturbedBody::Motor => (report.motor?, "motor"),
        DisturbedBody::Load => (report.axis?, "load"),
    };
    match (fixed, on.value) {
        (Some(_), DisturbedBody::Motor) => {
            report.error(on.span, "the motor follows the set-point exactly and takes no disturbance", "");
        }
        (Some(Fixed::Everything), DisturbedBody::Load) => {
            let message = "the load is rigid with a motor that follows the set-point exactly and takes no disturbance";
            report.error(on.span, message, GIVE_STIFFNESS);
        }
        (Some(Fixed::Motor) | None, _) => {}
    }
    let (slot, other, right, wrong) = match motion {
        Coordinate::Linear => (&given.force, &given.torque, "force", "torque"),
        Coordinate::Rotary => (&given.torque, &given.force, "torque", "force"),
    };
    if let Some(span) = other.span() {
        let moves = if motion == Coordinate::Linear { "moves along a line" } else { "turns" };
        report.error(span, format!("the {body} {moves} and takes no `{wrong}`"), format!("give a `{right}`"));
        return None;
    }
    if matches!(slot, Slot::Absent) {
        report.missing("disturbance", right, given.span);
    }
    refuse_idle(given, timing, report);
    refuse_aliased(given, timing, report);
    Some(Disturbance {
        on: on.value,
        start: given.start.given().copied().unwrap_or(0.0),
        duration: given.duration.given().copied().unwrap_or(f64::INFINITY),
        effort: *slot.given()?,
        frequency: given.frequency.given().copied(),
    })
}

/// Refuses a disturbance that acts on no tick of the run.
fn refuse_idle(given: &file::Disturbance, timing: &Timing, report: &mut Report) {
    if let (Some(start), Some(duration)) = (given.start.at(), timing.duration)
        && start.value >= duration
    {
        report.error(start.span, format!("the run is over by then: it lasts {duration} s"), "");
        return;
    }
    let (Some(duration), Some(base_rate)) = (given.duration.at(), timing.base_rate) else { return };
    let start = given.start.given().copied().unwrap_or(0.0);
    if base_rate.tick_at(start) == base_rate.tick_at(start + duration.value) {
        let message = format!("no tick is between its start and its end: ticks are {} s apart", base_rate.period());
        report.error(duration.span, message, "");
    }
}

/// Refuses a sine that, sampled at the ticks, would appear as a slower one or as zero.
fn refuse_aliased(given: &file::Disturbance, timing: &Timing, report: &mut Report) {
    let (Some(frequency), Some(base_rate)) = (given.frequency.at(), timing.base_rate) else { return };
    let most = f64::from(base_rate.hertz()) / 2.0;
    if frequency.value >= most {
        let message =
            format!("a sine of {} Hz needs more than two ticks per period: less than {most} Hz", frequency.value);
        report.error(frequency.span, message, "lower it or raise `run.base_rate`");
    }
}

pub(super) fn initial(file: &File, fixed: Option<Fixed>, report: &mut Report) -> Initial {
    let Some(initial) = file.initial.given() else { return Initial::default() };
    for slot in [&initial.load_position, &initial.load_velocity] {
        if let (Some(Fixed::Everything), Some(span)) = (fixed, slot.span()) {
            let message = "the load is rigid with a motor that follows the set-point exactly, from zero";
            report.error(span, message, GIVE_STIFFNESS);
        }
    }
    let value = |slot: &Slot<f64>| slot.given().copied().unwrap_or_default();
    Initial { load_position: value(&initial.load_position), load_velocity: value(&initial.load_velocity) }
}
