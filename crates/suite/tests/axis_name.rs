//! A name of the axis changes names and nothing else: every bit of the recording, every metric and the verdict are those of the axis without.
use servobench::{Engines, Run};
use servobench_plant::{EngineName, Exact};
use servobench_scenario::{Document, Scenario};
use servobench_suite::{Source, Workers, execute, jobs};
use servobench_trace::{Channel, ChannelSpec, Recording};
use std::path::{Path, PathBuf};

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

fn scenarios() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["scenarios/demo", "scenarios/plc"];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let mut files: Vec<_> = files.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|kind| kind == "toml"));
    files.sort();
    files
}

fn run(scenario: Scenario) -> Option<Run> {
    let job = jobs(vec![Source { scenario, text: String::new() }], &[EngineName::Exact]).remove(0);
    execute(&job, &ENGINES, &Workers::none(), &mut |_| {}).ok()
}

/// Names and bits of the values, without the axis.
fn channels(recording: &Recording) -> Vec<(&str, Vec<u64>)> {
    let bits = |channel: &Channel| channel.values.iter().map(|value| value.to_bits()).collect();
    recording.channels.iter().map(|channel| (channel.spec.name.as_str(), bits(channel))).collect()
}

#[test]
fn a_name_changes_names_only() {
    let mut compared = 0;
    for path in scenarios() {
        // Those with FMUs or an MJCF file need what others build.
        let Ok(document) = Document::open(&path, None) else { continue };
        let Ok(plain) = document.scenario(&[]) else { continue };
        let named = document.scenario(&["axis.name=\"x-1\"".parse().unwrap()]);
        let mut named = named.unwrap_or_else(|error| panic!("{}: {error}", path.display())).scenario;
        assert_eq!(named.axis.name.unwrap().as_str(), "x-1");
        named.overrides.clear();
        let (Some(mut plain), Some(mut named)) = (run(plain.scenario), run(named)) else { continue };
        let path = path.display();
        assert_eq!(channels(&named.recording), channels(&plain.recording), "{path}");
        assert!(named.recording.channels.iter().all(|one| one.spec.full_name() == format!("x-1.{}", one.spec.name)));
        for (own, other) in named.recording.channels.drain(..).zip(plain.recording.channels.drain(..)) {
            assert_eq!(ChannelSpec { axis: None, ..own.spec }, other.spec, "{path}");
        }
        // Moves, events, signals, calls and log as texts, in which one NaN equals another.
        assert_eq!(format!("{:?}", named.recording), format!("{:?}", plain.recording), "{path}");
        assert_eq!((named.metrics, named.verdict), (plain.metrics, plain.verdict), "{path}");
        compared += 1;
    }
    assert!(compared > 5, "{compared} runs");
}
