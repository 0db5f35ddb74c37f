//! What a scenario can ask to record is what the loop records.
use servobench_plant::Exact;
use servobench_scenario::{CHANNELS, Disturbance, DisturbedBody, Motion, Scenario};
use servobench_sim::selected;
use servobench_tests::{run, scenario_file};
use std::collections::{BTreeMap, BTreeSet};

/// The first ticks of axes that have everything between them: a synchronous motor with a table before the load, an
/// ideal source, a load that is pushed, a fieldbus; and something that pushes the motor.
fn axes() -> [Scenario; 4] {
    ["demo/snap.toml", "lambrechts-snap.toml", "feed-axis-load-step.toml", "plc/bus-jitter.toml"].map(|file| {
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

/// Names of the channels that are kept of a run of `scenario`, in their order.
fn recorded(scenario: &Scenario) -> Vec<String> {
    selected(run(scenario, &Exact), &scenario.record.channels)
        .channels
        .into_iter()
        .map(|channel| channel.spec.name)
        .collect()
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

/// Unit of each channel as the reference of scenario files gives it.
fn documented() -> BTreeMap<String, String> {
    let reference = include_str!("../docs/scenario.md");
    let (_, table) = reference.split_once("### Channels\n").unwrap();
    let rows = table.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` | "));
    let unit = |rest: &str| rest.split(" | ").next().unwrap().to_owned();
    rows.map(|(name, rest)| (name.to_owned(), unit(rest))).collect()
}

#[test]
fn the_reference_gives_the_units_that_are_recorded() {
    let documented = documented();
    assert!(documented.keys().eq(CHANNELS.iter().copied().collect::<BTreeSet<_>>()), "{documented:?}");
    for scenario in axes() {
        let effort = |motion| if motion == Motion::Linear { "N" } else { "N m" };
        let axis = if scenario.axis.motion == Motion::Linear { "m" } else { "rad" };
        let (motor, load) = (effort(scenario.axis.motor_motion), effort(scenario.axis.motion));
        for channel in run(&scenario, &Exact).channels {
            let spec = channel.spec;
            let expected = match documented[&spec.name].as_str() {
                // None of the sources here has a gain, which would make it volts.
                "E" | "V or E" => motor.to_owned(),
                "F" => load.to_owned(),
                "1" => String::new(),
                other => other.replace('U', axis),
            };
            assert_eq!(spec.unit, expected, "{}", spec.name);
        }
    }
}
