//! What a scenario can ask to record is what the loop records.
use servobench_plant::Exact;
use servobench_scenario::{CHANNELS, Scenario};
use servobench_tests::{run, scenario_file};
use std::collections::BTreeSet;

/// The first ticks of axes that have everything between them: a synchronous motor with a table before the load, and an
/// ideal source.
fn axes() -> [Scenario; 2] {
    ["demo/snap.toml", "lambrechts-snap.toml"].map(|file| {
        let mut scenario = scenario_file(file);
        scenario.duration = Some(1e-3);
        scenario.record.channels.clear();
        scenario
    })
}

/// Names of the channels that a run of `scenario` records, in their order.
fn recorded(scenario: &Scenario) -> Vec<String> {
    run(scenario, &Exact).channels.into_iter().map(|channel| channel.spec.name).collect()
}

#[test]
fn the_loop_records_every_channel_that_a_scenario_can_name_and_no_other() {
    let mut all = BTreeSet::new();
    for scenario in axes() {
        let names = recorded(&scenario);
        let in_order: Vec<_> = CHANNELS.iter().filter(|name| names.iter().any(|own| own == *name)).collect();
        assert!(names.iter().eq(in_order), "{}: {names:?} in the order of {CHANNELS:?}", scenario.name);
        all.extend(names);
    }
    let known: BTreeSet<_> = CHANNELS.iter().map(|name| (*name).to_owned()).collect();
    assert_eq!(all, known);
}

#[test]
fn each_channel_can_be_recorded_alone() {
    for mut scenario in axes() {
        for name in recorded(&scenario) {
            scenario.record.channels = vec![name.clone()];
            assert_eq!(recorded(&scenario), [name]);
            scenario.record.channels.clear();
        }
    }
}
