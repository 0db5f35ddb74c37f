//! `[[bus.fault]]`: faults, in cycles of the bus or of the motion task.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::FaultName;
use crate::resolve::bus::Known;
use crate::resolve::{Alternative, one_of, whole};
use servobench_fieldbus::bus::{BusFault, BusFaultKind, BusFaultName};
use servobench_fieldbus::task::{TaskFault, TaskFaultKind, TaskFaultName};
use std::ops::Range;

/// Default seed of the random numbers.
const SEED: u32 = 1;

/// A fault of the bus or of the motion task.
enum Fault {
    Bus(BusFault),
    Task(TaskFault),
}

/// The faults of a bus and of the motion task; `cycles` are the base ticks per bus cycle and the bus cycles per cycle of the
/// motion task.
pub(super) fn faults(
    given: &file::Bus,
    cycles: Option<(u32, u32)>,
    known: &Known<'_>,
    report: &mut Report,
) -> Option<(Vec<BusFault>, Vec<TaskFault>)> {
    let mut faults = (Vec::new(), Vec::new());
    let Some(all) = given.fault.optional().ok()? else { return Some(faults) };
    let resolved: Vec<_> = all.0.iter().map(|one| fault(&one.value, cycles, known, report)).collect();
    for fault in resolved {
        match fault? {
            Fault::Bus(fault) => faults.0.push(fault),
            Fault::Task(fault) => faults.1.push(fault),
        }
    }
    Some(faults)
}

fn fault(given: &file::BusFault, cycles: Option<(u32, u32)>, known: &Known<'_>, report: &mut Report) -> Option<Fault> {
    let task_cycle = cycles.map(|(cycle, every)| cycle.saturating_mul(every));
    let parameters = parameters(given, task_cycle, known, report);
    let name = *given.kind.given()?;
    let cycle = match name {
        FaultName::Bus(_) => cycles.map(|(cycle, _)| cycle),
        FaultName::Task(_) => task_cycle,
    };
    let cycles = concerned(given, cycle, known, report);
    let ((by, seed), cycles) = (parameters?, cycles?);
    Some(match name {
        FaultName::Bus(name) => {
            let kind = match name {
                BusFaultName::Lost => BusFaultKind::Lost,
                BusFaultName::Late => BusFaultKind::Late { by },
                BusFaultName::Jitter => BusFaultKind::Jitter { by, seed },
                BusFaultName::MasterStopped => BusFaultKind::MasterStopped,
                BusFaultName::DriveSilent => BusFaultKind::DriveSilent,
                BusFaultName::ExternalFault => BusFaultKind::ExternalFault,
            };
            Fault::Bus(BusFault { kind, cycles })
        }
        FaultName::Task(name) => {
            let kind = match name {
                TaskFaultName::Late => TaskFaultKind::Late { by },
                TaskFaultName::Jitter => TaskFaultKind::Jitter { by, seed },
                TaskFaultName::Lost => TaskFaultKind::Lost,
                TaskFaultName::Torn => TaskFaultKind::Torn,
                TaskFaultName::Fast => TaskFaultKind::Fast { by },
            };
            Fault::Task(TaskFault { kind, cycles })
        }
    })
}

/// Time of the fault (base ticks), 0 if it has none, and its seed.
fn parameters(
    given: &file::BusFault,
    task_cycle: Option<u32>,
    known: &Known<'_>,
    report: &mut Report,
) -> Option<(u32, u32)> {
    let name = *given.kind.given()?;
    let is_random = matches!(name, FaultName::Bus(BusFaultName::Jitter) | FaultName::Task(TaskFaultName::Jitter));
    let is_late = matches!(name, FaultName::Bus(BusFaultName::Late) | FaultName::Task(TaskFaultName::Late));
    let is_fast = name == FaultName::Task(TaskFaultName::Fast);
    let needs_time = is_random || is_late || is_fast;
    if let (false, Some(span)) = (needs_time, given.by.span()) {
        report.error(span, "`by` is for the kinds \"late\", \"jitter\" and \"fast\"", "");
    }
    if let (false, Some(span)) = (is_random, given.seed.span()) {
        report.error(span, "`seed` is for \"jitter\"", "");
    }
    let by = match &given.by {
        _ if !needs_time => Some(0),
        Slot::Absent => {
            let why = if is_fast { "the time by which a cycle is too short" } else { "the delay" };
            report.missing_with_help("bus.fault", "by", given.span, why);
            None
        }
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole::ticks("by", *at, known.base_rate, report).filter(|by| {
            let leaves_nothing = is_fast && task_cycle.is_some_and(|cycle| *by >= cycle);
            if leaves_nothing {
                report.error(at.span, "nothing is left of the cycle of the motion task", "make it shorter");
            }
            !leaves_nothing
        }),
    };
    let seed = given.seed.optional().ok().map(|seed| seed.copied().unwrap_or(SEED));
    // A wrong seed is an error only for a random fault.
    Some((by?, if is_random { seed? } else { SEED }))
}

/// The cycles affected, each of `cycle` base ticks.
fn concerned(given: &file::BusFault, cycle: Option<u32>, known: &Known<'_>, report: &mut Report) -> Option<Range<u64>> {
    let start = given.start.optional().ok()?.copied().unwrap_or(0.0);
    if let (Some(at), Some(duration)) = (given.start.at(), known.duration)
        && at.value >= duration
    {
        report.error(at.span, format!("the run is over by then: it lasts {duration} s"), "");
    }
    let length = one_of(&[("cycles", given.cycles.span()), ("duration", given.duration.span())], report);
    let per_second = f64::from(known.base_rate?.hertz()) / f64::from(cycle?);
    let first = first_from(start * per_second);
    let end = match length {
        Alternative::Use(0) => first.saturating_add(u64::from(*given.cycles.given()?)),
        Alternative::Use(_) => {
            let duration = given.duration.at()?;
            let end = first_from((start + duration.value) * per_second);
            if end == first {
                let message =
                    format!("no cycle begins between its start and its end, they are {} s apart", 1.0 / per_second);
                report.error(duration.span, message, "");
                return None;
            }
            end
        }
        Alternative::Contradiction => return None,
        Alternative::None => {
            let is_once = matches!(
                given.kind.given()?,
                FaultName::Bus(BusFaultName::Lost | BusFaultName::Late)
                    | FaultName::Task(TaskFaultName::Late | TaskFaultName::Lost | TaskFaultName::Torn)
            );
            if is_once { first.saturating_add(1) } else { u64::MAX }
        }
    };
    Some(first..end)
}

/// The first whole number that is not below `cycles`, apart from rounding.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative; what is too large saturates"
)]
fn first_from(cycles: f64) -> u64 {
    (cycles - 1e-9 * cycles.max(1.0)).ceil() as u64
}
