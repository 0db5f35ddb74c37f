//! A tick of the closed loop on the engine `exact` allocates nothing, with and without a fieldbus.
use servobench_plant::Exact;
use servobench_scenario::Scenario;
use servobench_sim::Bench;
use servobench_testkit::CountingAllocator;
use std::path::Path;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// The scenario `file` with the last `calls` of its blocks left out.
fn scenario_without(calls: usize, file: &str) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(file);
    let mut scenario = servobench_scenario::load(&path).unwrap().scenario;
    if let Some(plc) = &mut scenario.plc {
        plc.calls.truncate(plc.calls.len() - calls);
    }
    scenario
}

/// Allocations and rows of a run of `scenario` that lasts `duration` (s), once it is built. A change of a signal has words of its own:
/// one allocation, which is left out.
fn allocations(scenario: &Scenario, duration: f64) -> (u64, usize) {
    let bench = Bench::new(&Scenario { duration: Some(duration), ..scenario.clone() }, &Exact).unwrap();
    let before = CountingAllocator::count();
    let outcome = bench.run(&mut |_| {});
    let count = CountingAllocator::count() - before;
    assert!(outcome.failure.is_none() && outcome.recording.events.is_empty(), "an event has words of its own");
    let changes: usize = outcome.recording.signals.iter().map(|signal| signal.changes.len()).sum();
    (count - changes as u64, outcome.recording.len())
}

/// Oracle: a run of 1.2 s allocates as often as one of 0.3 s. A synchronous motor whose table sticks and slips, an ideal
/// source behind two bodies, a prescribed motion, and motors with effects.
#[test]
fn ticks_allocate_nothing() {
    for file in [
        "feed-axis-stick-slip.toml",
        "lambrechts-snap.toml",
        "vibration-snap.toml",
        "hardware/cogging.toml",
        "hardware/flux-harmonics.toml",
        "hardware/saturation-table.toml",
        "hardware/warming-up.toml",
    ] {
        let scenario = scenario_without(0, file);
        let ((short, few), (long, many)) = (allocations(&scenario, 0.3), allocations(&scenario, 1.2));
        assert!(few > 4_000 && many > 3 * few, "{file}: {few} and {many} rows");
        assert_eq!(short, long, "{file}: {} rows more", many - few);
    }
}

/// The same on a bus, within the first move of a program of function blocks: no signal changes there.
#[test]
fn ticks_on_a_bus_allocate_nothing() {
    let scenario = scenario_without(1, "plc/figure-3a.toml");
    let ((short, few), (long, many)) = (allocations(&scenario, 0.2), allocations(&scenario, 0.5));
    assert!(few > 3_000 && many > 2 * few, "{few} and {many} rows");
    assert_eq!(short, long, "{} rows more", many - few);
}
