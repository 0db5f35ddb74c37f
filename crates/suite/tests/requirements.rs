//! Scenarios whose runs break a requirement, or come close to one, break those in their first line and no others.
use servobench::Engines;
use servobench_metrics::{Expectation, Incident, Occasion, Standing};
use servobench_plant::{EngineName, Exact};
use servobench_scenario::{Scenario, load};
use servobench_suite::{Source, Workers, execute, jobs};
use std::path::{Path, PathBuf};

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenarios/requirements")
}

/// The requirements that the run breaks, and why.
fn broken(path: &Path) -> (Vec<&'static str>, Vec<String>) {
    broken_of(path, &[])
}

/// The same of a run that keeps only `channels`, or all where there are none.
fn broken_of(path: &Path, channels: &[&str]) -> (Vec<&'static str>, Vec<String>) {
    let mut loaded = load(path).unwrap_or_else(|error| panic!("{error}"));
    if !channels.is_empty() {
        loaded.scenario.record.channels = channels.iter().map(|name| name.parse().unwrap()).collect();
    }
    let text = std::fs::read_to_string(path).unwrap();
    let source = Source { scenario: loaded.scenario, text };
    let job = jobs(vec![source], &[EngineName::Exact]).remove(0);
    let run =
        execute(&job, &ENGINES, &Workers::none(), &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error));
    let names = run
        .verdict
        .requirements
        .iter()
        .filter(|(_, result)| result.standing == Standing::Broken)
        .map(|(name, _)| name.as_str());
    (names.collect(), run.verdict.reasons().collect())
}

/// Reasons for which the run of `path` fails when `change` has changed its scenario.
fn reasons_of(path: &Path, change: impl FnOnce(&mut Scenario)) -> Vec<String> {
    let mut loaded = load(path).unwrap_or_else(|error| panic!("{error}"));
    change(&mut loaded.scenario);
    let source = Source { scenario: loaded.scenario, text: std::fs::read_to_string(path).unwrap() };
    let job = jobs(vec![source], &[EngineName::Exact]).remove(0);
    let run =
        execute(&job, &ENGINES, &Workers::none(), &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error));
    run.verdict.reasons().collect()
}

fn expecting(incident: Incident, from: f64, to: f64) -> Expectation {
    Expectation { on: Occasion::Event(incident), from, to }
}

/// The crash comes at 0.35 s: an expectation of another time excuses nothing, and does not come.
#[test]
fn an_expected_event_has_its_time() {
    let path = folder().join("end-stop-crash.toml");
    let reasons = |from, to| {
        reasons_of(&path, |scenario| scenario.requirements.expected = vec![expecting(Incident::EndStop, from, to)])
    };
    assert_eq!(reasons(0.3, 0.4), [""; 0]);
    let [harm, missing] = &reasons(1.0, 2.0)[..] else { panic!() };
    assert!(harm.starts_with("no_harm: the load meets the positive end stop at 78"), "{harm}");
    assert_eq!(missing, "expected, but did not occur: the event `end_stop` from 1 s to 2 s");
}

/// In both files the contact is intended, or without power: they stay green without expectations and with them. Pressed at a stop in
/// another state the axis comes to harm.
#[test]
fn a_contact_in_homing_or_without_power_is_none_that_harms() {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    for (name, from, to) in [("end-stop.toml", 0.1, 0.4), ("plc/home-on-block.toml", 0.5, 3.0)] {
        let path = scenarios.join(name);
        assert_eq!(reasons_of(&path, |_| {}), [""; 0], "{name}");
        let expected = vec![expecting(Incident::EndStop, from, to)];
        assert_eq!(reasons_of(&path, |scenario| scenario.requirements.expected = expected), [""; 0], "{name}");
    }
}

/// A limit of the drive and a fault of the file are events that can be expected, and harm nothing.
#[test]
fn what_harms_nothing_can_be_expected_too() {
    let plc = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc");
    for (name, incident) in [("limit-switch.toml", Incident::InternalLimit), ("bus-jitter.toml", Incident::BusFault)] {
        let whole = |incident| vec![expecting(incident, 0.0, f64::INFINITY)];
        let path = plc.join(name);
        let reasons = |incident| reasons_of(&path, |scenario| scenario.requirements.expected.extend(whole(incident)));
        assert_eq!(reasons(incident), [""; 0], "{name}");
        assert_eq!(
            reasons(Incident::BufferOverflow),
            ["expected, but did not occur: the event `buffer_overflow`"],
            "{name}"
        );
    }
}

/// Scenarios with FMUs need files made by commands; they run as a suite of the program.
#[test]
fn every_shipped_scenario_meets_its_requirements() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let folders = ["", "demo", "plc", "setpoints", "hardware", "hardware/faults"].map(|folder| repository.join(folder));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|kind| kind == "toml")).collect();
    files.sort();
    assert!(files.len() >= 30, "{files:?}");
    let mut wrong = Vec::new();
    // A user's own MJCF file is not for `exact`.
    for path in files.iter().filter(|path| !path.ends_with("own-mjcf.toml")) {
        let (_, reasons) = broken(path);
        if !reasons.is_empty() {
            wrong.push(format!("{}:\n  {}", path.display(), reasons.join("\n  ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn each_run_breaks_what_its_first_line_says() {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 17, "{files:?}");
    let mut wrong = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        let said = text.lines().next().unwrap().strip_prefix("# breaks: ").unwrap_or_else(|| panic!("{path:?}"));
        // Where a loop swings between its limits, where it ends is a matter of roundings.
        let (perhaps, said): (Vec<&str>, Vec<&str>) = said.split(' ').partition(|word| word.ends_with('?'));
        let mut said: Vec<&str> = said.into_iter().filter(|word| *word != "nothing").collect();
        said.sort_unstable();
        let (mut names, reasons) = broken(&path);
        names.retain(|name| !perhaps.iter().any(|perhaps| perhaps.trim_end_matches('?') == *name));
        names.sort_unstable();
        println!("{}: {names:?}\n  {}", path.file_stem().unwrap().display(), reasons.join("\n  "));
        if names != said {
            wrong.push(format!("{}: says {said:?}, breaks {names:?}: {reasons:?}", path.display()));
        }
        // Limits are of what is kept; requirements are not.
        let (mut of_little, _) = broken_of(&path, &["load.velocity"]);
        of_little.retain(|name| !perhaps.iter().any(|perhaps| perhaps.trim_end_matches('?') == *name));
        of_little.sort_unstable();
        if of_little != names {
            wrong.push(format!("{}: with one channel kept it breaks {of_little:?}, not {names:?}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A pause shifts the next move on the grid of ticks by a rounding error; that move does not count as aborted.
#[test]
fn a_pause_before_a_move_does_not_let_it_off() {
    let text = std::fs::read_to_string(folder().join("torque-too-small.toml")).unwrap();
    let work = tempfile::tempdir().unwrap();
    let models = folder().join("../models");
    for pause in ["0.05 s", "0.1 s", "0.35 s", "0.37 s", "1/3 s"].map(|pause| pause.replace("1/3 s", "0.3333333 s")) {
        let step = format!("[[program]]\nwait = \"{pause}\"\n[[program]]\n");
        let path = work.path().join("paused.toml");
        std::fs::write(&path, text.replace("[[program]]\n", &step)).unwrap();
        let link = work.path().join("models");
        if !link.exists() {
            copy(&models, &link);
        }
        assert_eq!(broken(&path).0, ["follows", "arrives"], "{pause}");
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}
