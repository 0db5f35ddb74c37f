//! The motion task: the ticks of its cycles, and the fate of their commands.
use core::ops::Range;
use servobench_base::{Divider, Rate, Tick};
use servobench_fieldbus::task::{self, Params, State, TaskFault, TaskFaultKind};

fn cycle() -> Divider {
    let base = Rate::new(16_000).unwrap();
    base.divider(Rate::new(250).unwrap()).unwrap()
}

fn fault(kind: TaskFaultKind, cycles: Range<u64>) -> TaskFault {
    TaskFault { kind, cycles }
}

/// The cycles of `ticks` ticks, with the tick at which each ran.
fn ran(faults: &[TaskFault], ticks: u64) -> Vec<(u64, task::Cycle)> {
    let (params, mut state) = (Params::new(cycle(), faults), State::default());
    let mut ran = Vec::new();
    for tick in 0..ticks {
        while let Some(cycle) = task::step(&params, &mut state, Tick(tick)) {
            ran.push((tick, cycle));
        }
    }
    ran
}

fn times(faults: &[TaskFault], ticks: u64) -> Vec<(u64, u64)> {
    ran(faults, ticks).into_iter().map(|(tick, cycle)| (tick, cycle.due.0)).collect()
}

#[test]
fn cycles_run_when_they_are_due() {
    for (number, (tick, cycle)) in ran(&[], 640).iter().enumerate() {
        assert_eq!((*tick, cycle.number, cycle.due.0), (64 * number as u64, number as u64, *tick));
        assert!(!cycle.is_lost && !cycle.is_torn);
    }
    assert_eq!(ran(&[], 640).len(), 10);
}

#[test]
fn a_late_cycle_is_late_alone_and_a_very_late_one_is_followed_by_a_burst() {
    let late = |by, cycles| times(&[fault(TaskFaultKind::Late { by }, cycles)], 300);
    assert_eq!(late(20, 1..2), [(0, 0), (84, 64), (128, 128), (192, 192), (256, 256)]);
    assert_eq!(late(150, 1..2), [(0, 0), (214, 64), (214, 128), (214, 192), (256, 256)]);
    assert_eq!(late(3, 0..1)[0], (3, 0));
    // A cycle with two such faults is late by both.
    let both = [fault(TaskFaultKind::Late { by: 20 }, 1..3), fault(TaskFaultKind::Late { by: 7 }, 1..2)];
    assert_eq!(times(&both, 160), [(0, 0), (91, 64), (148, 128)]);
}

#[test]
fn jitter_stays_within_its_bound_and_is_the_same_every_time() {
    let jitter = |seed| times(&[fault(TaskFaultKind::Jitter { by: 30, seed }, 0..u64::MAX)], 64_000);
    let late: Vec<_> = jitter(1).iter().map(|(tick, due)| tick - due).collect();
    assert!(late.iter().all(|late| *late <= 30), "{late:?}");
    // Of a thousand, each of 31 values comes at least once: (30/31)^1000 is 6e-15.
    assert!((0..=30).all(|value| late.contains(&value)), "{late:?}");
    assert_eq!(jitter(1), jitter(1));
    assert_ne!(jitter(1), jitter(2));
}

#[test]
fn a_fast_clock_gains_for_good() {
    let short = |by, cycles| times(&[fault(TaskFaultKind::Fast { by }, cycles)], 200);
    assert_eq!(short(16, 1..3), [(0, 0), (64, 64), (112, 112), (160, 160)]);
    // At least a tick is left.
    assert_eq!(short(64, 0..2), [(0, 0), (1, 1), (2, 2), (66, 66), (130, 130), (194, 194)]);
}

#[test]
fn lost_and_torn_commands_are_those_that_were_named() {
    let faults = [fault(TaskFaultKind::Lost, 2..4), fault(TaskFaultKind::Torn, 3..5)];
    let seen: Vec<_> = ran(&faults, 384).into_iter().map(|(_, cycle)| (cycle.is_lost, cycle.is_torn)).collect();
    assert_eq!(seen, [(false, false), (false, false), (true, false), (true, true), (false, true), (false, false)]);
}
