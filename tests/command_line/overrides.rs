//! `--set`: keys of a scenario with another value than its file gives them.
use crate::{SLIDE, code, folder, json, on_a_bus, said, servobench};
use servobench_trace::Recording;
use std::fs;

/// Runs `slide.toml`, in a folder of its own, with these arguments; what it said, and `results.json` if it is there.
fn run(text: &str, more: &[&str]) -> (i32, String, serde_json::Value, tempfile::TempDir) {
    let work = folder(&[("slide.toml", text)]);
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let arguments = ["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = servobench(&[&arguments[..], more].concat());
    let results = fs::read(out.join("results.json")).map_or(serde_json::Value::Null, |text| json(&text));
    (code(&output), said(&output), results, work)
}

/// Everything that a run leaves says what was overridden, on an engine in a process of its own too; without overrides nothing
/// is other than it was.
#[test]
fn a_run_with_overrides_does_not_look_like_the_scenario_itself() {
    let with = ["--set", "program[0].move_to=40 mm", "--set", "setpoint.jerk='300 m/s3'"];
    let mut engines = vec!["exact"];
    if cfg!(feature = "mujoco") {
        engines.push("mujoco");
    }
    for engine in engines {
        let junit = tempfile::NamedTempFile::new().unwrap();
        let junit = junit.path();
        let more = [&with[..], &["--engine", engine, "--junit", junit.to_str().unwrap()]].concat();
        let (code, said, results, work) = run(SLIDE, &more);
        assert_eq!(code, 0, "{said}");
        assert!(said.contains("\noverrides: program[0].move_to=40 mm, setpoint.jerk='300 m/s3'\n"), "{said}");
        let run = &results["scenarios"][0];
        let given = ["program[0].move_to=40 mm", "setpoint.jerk='300 m/s3'"];
        assert_eq!(run["overrides"], serde_json::json!(given));
        let parameters = ["setpoint.jerk", "program.0.move_to"].map(|key| run["parameters"][key].as_str().unwrap());
        assert_eq!(parameters, ["300 m/s3", "40 mm"]);
        let recording = work.path().join("out").join(run["recording"].as_str().unwrap());
        let recording = Recording::read_parquet(recording).unwrap();
        assert_eq!(recording.about.overrides, given);
        let junit = fs::read_to_string(junit).unwrap();
        assert!(junit.contains(&format!("slide [{engine}] with program[0].move_to=40 mm")), "{junit}");
    }
    let (_, said, results, _work) = run(SLIDE, &[]);
    assert!(!said.contains("overrides") && results["scenarios"][0].get("overrides").is_none(), "{said}");
}

#[test]
fn a_mistake_in_an_override_is_shown_on_the_command_line() {
    let (code, said, _, _work) =
        run(SLIDE, &["--set", "setpoint.jrek=1 m/s3", "--set", "drive.velocity.bandwidth=80 m"]);
    assert_eq!(code, 2, "{said}");
    insta::assert_snapshot!(said.lines().skip(1).collect::<Vec<_>>().join("\n"));
}

/// What the parser of the command line finds wrong is told together with its other mistakes.
#[test]
fn what_is_no_override_is_a_mistake_of_the_command_line() {
    let output = servobench(&["run", "--set", "jerk", "--jobs", "0"]);
    assert_eq!(code(&output), 2);
    let said = said(&output);
    for expected in ["invalid value '0' for '--jobs <N>'", "'--set <KEY=VALUE>': missing `=`"] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
}

#[test]
fn every_command_that_reads_a_scenario_takes_overrides() {
    let work = folder(&[("slide.toml", SLIDE), ("bus.toml", &on_a_bus("\"6065h\" = 10000"))]);
    let at = |name: &str| work.path().join(name).to_str().unwrap().to_owned();
    let (slide, bus, out, fmu) = (at("slide.toml"), at("bus.toml"), at("out"), at("slide.fmu"));
    let long = "setpoint.velocity=10 mm/s";
    let checked = servobench(&["check", &slide, "--set", long]);
    // 50 mm at 10 mm/s, beside a fraction of a second for speeding up and braking.
    assert!(said(&checked).contains("1 move, 5.0"), "{}", said(&checked));
    let objects = servobench(&["objects", &bus, "--set", "drive.objects.'6065h'=4711", "--format", "json"]);
    assert!(said(&objects).contains("4711"), "{}", said(&objects));
    let both = servobench(&["compare", &slide, &bus, "--set", "measure.window=20 um", "--out", &out]);
    assert!(said(&both).contains("\noverrides of all runs: measure.window=20 um\n"), "{}", said(&both));
    let comparison = json(&fs::read(at("out/comparison.json")).unwrap());
    assert_eq!(comparison["scenarios"][1]["overrides"], serde_json::json!(["measure.window=20 um"]));
    let export = servobench(&["fmu", "export", &slide, "--set", long, "--output", &fmu]);
    if code(&export) == 0 {
        assert!(said(&export).contains("of slide with setpoint.velocity=10 mm/s"), "{}", said(&export));
        let info = servobench(&["fmu", "info", &fmu]);
        assert!(said(&info).contains("setpoint.velocity=10 mm/s"), "{}", said(&info));
    } else {
        // The library of exported FMUs is built by itself.
        assert!(said(&export).contains("servobench-fmu"), "{}", said(&export));
    }
}

/// One file that has no such element does not keep the other from being run.
#[test]
fn overrides_are_of_each_scenario() {
    let two = format!("{SLIDE}[[program]]\nwait = \"10 ms\"\n");
    let work = folder(&[("one.toml", SLIDE), ("two.toml", &two.replace("[measure]\nwindow = \"10 um\"\n", ""))]);
    let out = work.path().join("out");
    let arguments =
        ["run", work.path().to_str().unwrap(), "--set", "program[1].wait=20 ms", "--out", out.to_str().unwrap()];
    let output = servobench(&arguments);
    assert_eq!(code(&output), 2, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let verdicts: Vec<_> = (0..2).map(|k| results["scenarios"][k]["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts, ["invalid", "unjudged"]);
    assert_eq!(results["scenarios"][0]["overrides"], results["scenarios"][1]["overrides"]);
}
