//! `[[bus.fault]]`: what goes wrong, in cycles of the bus or of the motion task.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::FaultName;
use crate::resolve::bus::Known;
use crate::resolve::{Way, one_way, whole};
use crate::scenario::{BusFault, BusFaultKind};
use std::ops::Range;

/// Seed of the random numbers, unless given.
const SEED: u32 = 1;

/// The faults on a bus of `cycles`: base ticks in one of them, and how many there are in one of the motion task's.
pub(super) fn faults(
    given: &file::Bus,
    cycles: Option<(u32, u32)>,
    known: &Known<'_>,
    report: &mut Report,
) -> Option<Vec<BusFault>> {
    let Some(all) = given.fault.optional().ok()? else { return Some(Vec::new()) };
    let resolved: Vec<_> = all.0.iter().map(|one| fault(&one.value, cycles, known, report)).collect();
    resolved.into_iter().collect()
}

fn fault(
    given: &file::BusFault,
    cycles: Option<(u32, u32)>,
    known: &Known<'_>,
    report: &mut Report,
) -> Option<BusFault> {
    let task_cycle = cycles.map(|(cycle, every)| cycle.saturating_mul(every));
    let kind = kind(given, task_cycle, known, report);
    let is_of_task = given.kind.given()?.is_of_task();
    let cycle = if is_of_task { task_cycle } else { cycles.map(|(cycle, _)| cycle) };
    let cycles = concerned(given, cycle, known, report);
    Some(BusFault { kind: kind?, cycles: cycles? })
}

fn kind(
    given: &file::BusFault,
    task_cycle: Option<u32>,
    known: &Known<'_>,
    report: &mut Report,
) -> Option<BusFaultKind> {
    let name = given.kind.at()?;
    let is_random = matches!(name.value, FaultName::Jitter | FaultName::TaskJitter);
    let is_fast = name.value == FaultName::TaskFast;
    let needs_time = is_random || is_fast || matches!(name.value, FaultName::Late | FaultName::TaskLate);
    if let (false, Some(span)) = (needs_time, given.by.span()) {
        report.error(span, "`by` is for what is \"late\", has \"jitter\" or is \"fast\"", "");
    }
    if let (false, Some(span)) = (is_random, given.seed.span()) {
        report.error(span, "`seed` is for \"jitter\"", "");
    }
    let by = match &given.by {
        _ if !needs_time => Some(0),
        Slot::Absent => {
            report.missing_with_help(
                "bus.fault",
                "by",
                given.span,
                if is_fast { "how much too short a cycle is" } else { "how late it is" },
            );
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
    Some(match name.value {
        FaultName::Lost => BusFaultKind::Lost,
        FaultName::Late => BusFaultKind::Late { by: by? },
        FaultName::Jitter => BusFaultKind::Jitter { by: by?, seed: seed? },
        FaultName::MasterStopped => BusFaultKind::MasterStopped,
        FaultName::DriveSilent => BusFaultKind::DriveSilent,
        FaultName::ExternalFault => BusFaultKind::ExternalFault,
        FaultName::TaskLate => BusFaultKind::TaskLate { by: by? },
        FaultName::TaskJitter => BusFaultKind::TaskJitter { by: by?, seed: seed? },
        FaultName::TaskLost => BusFaultKind::TaskLost,
        FaultName::TaskTorn => BusFaultKind::TaskTorn,
        FaultName::TaskFast => BusFaultKind::TaskFast { by: by? },
    })
}

/// The cycles that it concerns, each of `cycle` base ticks.
fn concerned(given: &file::BusFault, cycle: Option<u32>, known: &Known<'_>, report: &mut Report) -> Option<Range<u64>> {
    let start = given.start.optional().ok()?.copied().unwrap_or(0.0);
    if let (Some(at), Some(duration)) = (given.start.at(), known.duration)
        && at.value >= duration
    {
        report.error(at.span, format!("the run is over by then: it lasts {duration} s"), "");
    }
    let length = one_way(&[("cycles", given.cycles.span()), ("duration", given.duration.span())], report);
    let per_second = f64::from(known.base_rate?.hertz()) / f64::from(cycle?);
    let first = first_from(start * per_second);
    let end = match length {
        Way::Use(0) => first.saturating_add(u64::from(*given.cycles.given()?)),
        Way::Use(_) => {
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
        Way::Contradiction => return None,
        Way::None => match given.kind.given()? {
            FaultName::Lost | FaultName::Late | FaultName::TaskLate | FaultName::TaskLost | FaultName::TaskTorn => {
                first.saturating_add(1)
            }
            FaultName::Jitter
            | FaultName::MasterStopped
            | FaultName::DriveSilent
            | FaultName::ExternalFault
            | FaultName::TaskJitter
            | FaultName::TaskFast => u64::MAX,
        },
    };
    Some(first..end)
}

/// The first whole number that is not below `cycles`, but for rounding.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "not negative; what is too large saturates"
)]
fn first_from(cycles: f64) -> u64 {
    (cycles - 1e-9 * cycles.max(1.0)).ceil() as u64
}
