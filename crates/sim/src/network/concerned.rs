//! Frames and cycles of the motion task that are hit by the faults of a scenario, as events.
use core::ops::Range;
use servobench_config::Choice as _;
use servobench_fieldbus::bus::{self, BusFault};
use servobench_fieldbus::task::{self, TaskFault};
use servobench_metrics::Incident;
use servobench_trace::{Event, Recorder};

/// Records each fault of the bus and of the motion task that hit some of the cycles run, in ticks of `tick` (s).
pub(super) fn note(
    (bus, frames, bus_faults): (&bus::Params<'_>, &bus::State, &[BusFault]),
    (task, cycles, task_faults): (&task::Params<'_>, &task::State, &[TaskFault]),
    tick: f64,
    recorder: &mut Recorder,
) {
    let of_bus = bus_faults.iter().map(|fault| (fault.kind.kind().name(), &fault.cycles));
    let of_bus = of_bus.filter_map(|fault| event(fault, frames.cycles(), bus.cycle() as f64 * tick, ["bus", "frames"]));
    let of_task = task_faults.iter().map(|fault| (fault.kind.kind().name(), &fault.cycles));
    let period = task.cycle() as f64 * tick;
    let of_task = of_task.filter_map(|fault| event(fault, cycles.cycles(), period, ["motion task", "cycles"]));
    of_bus.chain(of_task).for_each(|event| recorder.note_event(event));
}

/// The event of fault `kind` for those of its cycles that were among the first `came`, one every `period` (s).
fn event((kind, cycles): (&str, &Range<u64>), came: u64, period: f64, [source, things]: [&str; 2]) -> Option<Event> {
    let (first, end) = (cycles.start, cycles.end.min(came));
    let count = end.checked_sub(first).filter(|count| *count > 0)?;
    let things = if count == 1 { things.trim_end_matches('s') } else { things };
    let message = format!("\"{kind}\" concerns {count} {things}, from number {first} on");
    let mut event = Event::new(first as f64 * period, (end - 1) as f64 * period, source, message)
        .incident(Incident::BusFault.name());
    if let Some(mark) = &mut event.incident {
        mark.count = Some(count);
    }
    Some(event)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_that_never_came_are_not_concerned() {
        let of = |cycles: Range<u64>| {
            let event = event(("lost", &cycles), 100, 1e-3, ["bus", "frames"])?;
            Some((event.start, event.end, event.incident?.count?))
        };
        assert_eq!(of(10..13), Some((0.01, 0.012, 3)));
        assert_eq!(of(90..u64::MAX), Some((0.09, 0.099, 10)));
        assert_eq!(of(100..101), None);
        assert_eq!(of(200..u64::MAX), None);
    }
}
