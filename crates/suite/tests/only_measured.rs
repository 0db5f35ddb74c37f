//! A run whose recording is not needed records fewer signals; measurements and verdict are the same.
use servobench::{Engines, Run};
use servobench_metrics::Name;
use servobench_plant::{EngineName, Exact};
use servobench_scenario::load;
use servobench_suite::{Source, Workers, execute, jobs};
use std::path::{Path, PathBuf};

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

fn scenarios() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders =
        ["scenarios", "scenarios/demo", "scenarios/setpoints", "scenarios/plc", "tests/scenarios/requirements"];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let mut files: Vec<_> = files.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|kind| kind == "toml"));
    files.sort();
    files
}

#[test]
fn metrics_and_verdict_do_not_depend_on_what_is_recorded_beside_them() {
    let (mut compared, mut fewer) = (0, 0);
    for path in scenarios() {
        // Those with FMUs or an MJCF file need what others build.
        let Ok(loaded) = load(&path) else { continue };
        let text = std::fs::read_to_string(&path).unwrap();
        let source = Source { scenario: loaded.scenario, text };
        let mut job = jobs(vec![source], &[EngineName::Exact]).remove(0);
        let run = |job: &_| execute(job, &ENGINES, &Workers::none(), &mut |_| {});
        let Ok(Run { recording, metrics, verdict }) = run(&job) else { continue };
        job.leave_recording_out();
        let only = run(&job).unwrap_or_else(|broken| panic!("{}: {}", path.display(), broken.error));
        assert_eq!((&only.metrics, &only.verdict), (&metrics, &verdict), "{}", path.display());
        // Some of the metrics, and those that the scenario limits, are what they are among all.
        job.measure_only(&[Name::SettlingTime, Name::TorqueRms]);
        let few = run(&job).unwrap_or_else(|broken| panic!("{}: {}", path.display(), broken.error));
        assert_eq!(few.verdict, only.verdict, "{}", path.display());
        for (name, metric) in few.metrics.run.iter() {
            let is_asked = [Name::SettlingTime, Name::TorqueRms].contains(&name);
            let in_moves = few.metrics.moves.iter().filter_map(|made| made.metrics.get(name));
            let is_limited = in_moves.chain([metric]).any(|metric| metric.limit.is_some());
            assert!(is_asked || is_limited, "{}: {name}", path.display());
            assert_eq!(only.metrics.get(name), Some(metric), "{}: {name}", path.display());
        }
        assert_eq!(few.metrics.get(Name::TorqueRms), only.metrics.get(Name::TorqueRms), "{}", path.display());
        compared += 1;
        fewer += usize::from(only.recording.channels.len() < recording.channels.len());
    }
    assert!(compared > 20 && fewer > 15, "{compared} runs, {fewer} of them with fewer signals");
}
