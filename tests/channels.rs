//! The signals that axes have.
use servobench_plant::Exact;
use servobench_scenario::{Disturbance, DisturbedBody, Scenario};
use servobench_signals::Signal;
use servobench_sim::selected;
use servobench_tests::{run, scenario_file};
use std::collections::BTreeSet;

/// The first ticks of axes that have everything between them: a synchronous motor with a table before the load, an
/// ideal source, a load that is pushed, one with end stops, a fieldbus, motors and sensors that are not ideal; and something that pushes
/// the motor.
const AXES: [&str; 14] = [
    "demo/snap.toml",
    "lambrechts-snap.toml",
    "feed-axis-load-step.toml",
    "end-stop.toml",
    "plc/bus-jitter.toml",
    "hardware/iron-loss.toml",
    "hardware/warming-up.toml",
    "hardware/current-offset.toml",
    "hardware/sincos-amplitude.toml",
    "hardware/scale-offset.toml",
    "hardware/dead-time.toml",
    "hardware/switching.toml",
    "hardware/brake-resistor.toml",
    "hardware/velocity-mt.toml",
];

fn axes() -> [Scenario; AXES.len()] {
    AXES.map(|file| {
        let mut scenario = scenario_file(file);
        scenario.duration = Some(1e-3);
        scenario.record.channels.clear();
        if let Some(step) = scenario.disturbances.pop() {
            let on = |on| Disturbance { on, start: 0.0, ..step.clone() };
            scenario.disturbances = vec![on(DisturbedBody::Motor), on(DisturbedBody::Load)];
        }
        scenario
    })
}

/// The signals that are kept of a run of `scenario`, in their order.
fn recorded(scenario: &Scenario) -> Vec<Signal> {
    selected(run(scenario, &Exact), &scenario.record.channels)
        .channels
        .into_iter()
        .map(|channel| channel.spec.name.parse().unwrap())
        .collect()
}

#[test]
fn every_signal_is_recorded_of_some_axis_in_the_order_of_the_list() {
    let mut all = BTreeSet::new();
    for scenario in axes() {
        let signals = recorded(&scenario);
        assert!(signals.is_sorted(), "{}: {signals:?}", scenario.name);
        all.extend(signals);
    }
    assert!(all.iter().eq(Signal::ALL), "{all:?}");
}

#[test]
fn each_signal_can_be_recorded_alone() {
    for mut scenario in axes() {
        for signal in recorded(&scenario) {
            scenario.record.channels = vec![signal];
            assert_eq!(recorded(&scenario), [signal]);
            scenario.record.channels.clear();
        }
    }
}

/// Oracle: the scenario file, a step of 300 N from 0.2 s to 0.7 s.
#[test]
fn a_disturbance_is_recorded_in_the_rows_in_which_it_acts() {
    let mut scenario = scenario_file("feed-axis-load-step.toml");
    scenario.duration = Some(0.8);
    let recording = run(&scenario, &Exact);
    let force = recording.channel("disturbance.load").unwrap();
    let acts = recording.index_at(0.2)..recording.index_at(0.7);
    let expected = |row: usize| if acts.contains(&row) { 300.0_f64 } else { 0.0 };
    assert!((0..recording.len()).all(|row| (force[row] - expected(row)).abs() < f64::MIN_POSITIVE));
    assert!(recording.channel("disturbance.motor").is_none(), "nothing pushes the motor");
}
