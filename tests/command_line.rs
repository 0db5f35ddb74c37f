//! The program as its users see it: output, files, exit codes. It belongs to the crate `cli`, whose binary it runs.
use serde_json::Value;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, SystemTime};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `servobench`, to be run in the repository's root.
fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_servobench"));
    command.args(arguments).current_dir(repository());
    command
}

/// Runs `servobench` in the repository's root.
fn servobench(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn json(text: &[u8]) -> Value {
    serde_json::from_slice(text).unwrap()
}

/// A folder that goes away, with scenario files in it.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// A rigid axis that is held by nothing: with a negative damping it would diverge, with a plain one it moves.
const SLIDE: &str = r#"
[run]
base_rate = "4 kHz"
duration = "0.4 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "4 kHz"
bandwidth = "80 Hz"
kind = "p"
[drive.position]
rate = "4 kHz"
gain = "60 1/s"
[drive.feedforward]
velocity = true
effort = "rigid"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "5 m/s2"
jerk = "200 m/s3"
[[program]]
move_to = "50 mm"
[measure]
window = "10 um"
"#;

#[test]
fn a_run_that_keeps_its_limits_ends_with_0_and_writes_results_and_recording() {
    let work = folder(&[("slide.toml", &format!("{SLIDE}\n[limits]\nfollowing_error_peak_load = \"1 mm\"\n"))]);
    let out = work.path().join("out");
    let (file, junit) = (work.path().join("slide.toml"), work.path().join("junit.xml"));
    let output = servobench(&[
        "run",
        file.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--rrd",
        "--junit",
        junit.to_str().unwrap(),
    ]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let scenario = &results["scenarios"][0];
    assert_eq!((&scenario["name"], &scenario["engine"]), (&"slide".into(), &"exact".into()));
    assert_eq!((&scenario["verdict"], &scenario["duration"]), (&"passed".into(), &0.4.into()), "{scenario}");
    let metric = &scenario["metrics"]["following_error_peak_load"];
    assert_eq!((&metric["unit"], &metric["pass"]), (&"m".into(), &true.into()), "{metric}");
    assert!(metric["value"].as_f64().unwrap() < 1e-3);
    for file in ["slide.exact.parquet", "slide.exact.rrd"] {
        assert!(out.join(file).metadata().unwrap().len() > 1000, "{file}");
    }
    assert!(fs::read_to_string(junit).unwrap().contains("slide"));
}

#[test]
fn a_missed_limit_ends_with_4_and_is_named() {
    let work = tempfile::tempdir().unwrap();
    let output = servobench(&["run", "tests/scenarios/must-fail.toml", "--out", work.path().to_str().unwrap()]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    assert!(said(&output).contains("following_error_cruise_load"), "{}", said(&output));
}

/// CI pipes into `grep -q` and `head`: the verdict keeps its code when nobody reads, on whichever stream.
#[test]
fn a_reader_that_goes_away_leaves_the_verdict_its_code() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().to_str().unwrap();
    for (arguments, expected) in [
        (&["run", "tests/scenarios/must-fail.toml", "--out", out][..], 4),
        (&["run", "scenarios/lambrechts-snap.toml", "--out", out], 0),
        (&["check", "no-such-file.toml"], 2),
        (&["schema"], 0),
    ] {
        let mut child = command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(expected), "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_ends_with_3() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().to_str().unwrap();
    for arguments in [&["run", "scenarios/lambrechts-snap.toml", "--out", out][..], &["schema"]] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output =
            command(arguments).stdout(full).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap();
        assert_eq!(code(&output), 3, "{}", said(&output));
        assert!(said(&output).contains("cannot write to standard output"), "{}", said(&output));
    }
}

#[test]
fn wrong_input_ends_with_2_before_anything_runs() {
    let work = folder(&[("good.toml", SLIDE), ("bad.toml", &SLIDE.replace("\"20 kg\"", "20"))]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(!out.exists(), "nothing is written when the input is wrong");
    for wrong in
        [&["run", "no-such-file.toml"][..], &["run", "--no-such-flag"], &["fly"], &[], &["compare", "one.toml"]]
    {
        assert_eq!(code(&servobench(wrong)), 2, "{wrong:?}");
    }
}

#[test]
fn every_mistake_of_a_file_is_reported_in_one_go() {
    let text = SLIDE
        .replace("\"20 kg\"", "20")
        .replace("velocity = \"0.5 m/s\"", "velocity = \"0.5 m\"")
        .replace("jerk =", "jerq =")
        .replace("rate = \"4 kHz\"\ngain", "rate = \"3 kHz\"\ngain");
    let work = folder(&[("bad.toml", &text)]);
    let output = servobench(&["check", work.path().join("bad.toml").to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    let said = said(&output);
    for expected in ["\"20 kg\"", "velocity", "jerk", "3000 Hz"] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 80), "80 columns:\n{said}");
}

#[test]
fn a_run_that_cannot_be_carried_out_ends_with_3_and_costs_nobody_else() {
    // Two loops of 4 kHz with a bandwidth far beyond their rate: the axis leaves the finite numbers.
    let wild = SLIDE.replace("\"80 Hz\"", "\"2 MHz\"").replace("0.4 s", "20 s");
    let work = folder(&[("slide.toml", SLIDE), ("wild.toml", &wild)]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    assert_eq!(results["scenarios"][0]["verdict"], "passed");
    assert_eq!(results["scenarios"][1]["verdict"], "error");
    assert!(results["scenarios"][1]["reasons"][0].as_str().unwrap().contains("diverged"), "{results}");
}

#[cfg(not(feature = "mujoco"))]
#[test]
fn an_engine_that_the_build_lacks_is_named_with_feature_and_command() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let file = work.path().join("slide.toml");
    let out = work.path().join("out");
    let output = servobench(&["run", file.to_str().unwrap(), "--engine", "mujoco", "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 3);
    assert!(said(&output).contains("--features mujoco"), "{}", said(&output));
}

#[test]
fn results_are_the_same_bytes_whatever_the_number_of_workers() {
    let work = tempfile::tempdir().unwrap();
    let results = ["1", "3"].map(|jobs| {
        let out = work.path().join(jobs);
        let output = servobench(&[
            "run",
            "scenarios/demo",
            "scenarios/emps.toml",
            "--engine",
            "exact",
            "--engine",
            "rapier",
            "--jobs",
            jobs,
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let mut files: Vec<_> = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.into_iter().map(|file| (file.file_name().unwrap().to_owned(), fs::read(&file).unwrap())).collect()
    });
    let [one, three]: [Vec<_>; 2] = results;
    assert_eq!(one.len(), 1 + 3 * 2, "results.json and a recording for each run");
    assert!(one == three, "some file differs");
}

/// Bar: Lambrechts' limits, order 3: 1.30 s; order 4: 1.35 s, t_d = t_j = t_a = 0.05 s, t_v = 0.65 s; at 1 ms the same.
#[test]
fn plan_reproduces_the_published_profile() {
    let limits = "--distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4 --json";
    for sampled in ["", "--sample-time 1ms"] {
        for (order, duration) in [(3, 1.3), (4, 1.35)] {
            let line = format!("plan --order {order} {limits} {sampled}");
            let output = servobench(&line.split_whitespace().collect::<Vec<_>>());
            assert_eq!(code(&output), 0, "{}", said(&output));
            let plan = json(&output.stdout);
            let near = |name: &str, expected: f64| {
                let found = plan[name].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-12, "{line}: {name} = {found}");
            };
            near("duration_s", duration);
            if order == 4 {
                for name in ["t_d", "t_j", "t_a"] {
                    near(name, 0.05);
                }
                near("t_v", 0.65);
                near("snap_effective", 1000.0);
            }
            let lengths = plan["segments"].as_array().unwrap().iter().map(|one| one["length_s"].as_f64().unwrap());
            assert!((lengths.sum::<f64>() - duration).abs() < 1e-12);
        }
    }
}

#[test]
fn plan_writes_tables_and_drawings_and_refuses_what_is_missing() {
    let work = tempfile::tempdir().unwrap();
    let (csv, svg) = (work.path().join("plan.csv"), work.path().join("plan.svg"));
    let arguments = ["plan", "--order", "2", "--distance", "-90 deg", "--velocity", "60 rpm", "--acceleration"];
    let mut drawn = arguments.to_vec();
    drawn.extend(["50 rad/s2", "--csv", csv.to_str().unwrap(), "--svg", svg.to_str().unwrap()]);
    let output = servobench(&drawn);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).lines().all(|line| line.chars().count() <= 80));
    let table = fs::read_to_string(csv).unwrap();
    let last: Vec<f64> = table.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!((last[1] + std::f64::consts::FRAC_PI_2).abs() < 1e-15, "{last:?}");
    assert!(fs::read_to_string(svg).unwrap().starts_with("<svg"));
    let output =
        servobench(&["plan", "--order", "3", "--distance", "1", "--velocity", "1 m/s", "--acceleration", "1 m/s2"]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("\"1 mm\" or \"1 deg\""), "{}", said(&output));
}

/// A sample time that is too short by some powers of ten costs a sentence, not the machine's memory.
#[test]
fn plan_refuses_a_table_of_absurd_length_and_draws_it_all_the_same() {
    let work = tempfile::tempdir().unwrap();
    let (csv, svg) = (work.path().join("plan.csv"), work.path().join("plan.svg"));
    let arguments = "plan --order 4 --distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4 \
                     --sample-time 1ns";
    let plan = |more: &[&str]| servobench(&[&arguments.split_whitespace().collect::<Vec<_>>()[..], more].concat());
    let output = plan(&["--csv", csv.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("--csv would write a table of 1350000001 rows"), "{}", said(&output));
    assert_eq!(fs::read_dir(work.path()).unwrap().count(), 0);
    assert_eq!(code(&plan(&["--svg", svg.to_str().unwrap()])), 0);
    assert!(svg.metadata().unwrap().len() < 100_000);
}

#[test]
fn compare_says_in_words_which_wins_and_writes_one_recording() {
    let work = tempfile::tempdir().unwrap();
    for equal in ["limits", "duration"] {
        let out = work.path().join(equal);
        let output = servobench(&[
            "compare",
            "scenarios/lambrechts-jerk.toml",
            "scenarios/lambrechts-snap.toml",
            "--equal",
            equal,
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        assert!(said(&output).contains("residual vibration"), "{}", said(&output));
        let recordings = fs::read_dir(&out)
            .unwrap()
            .filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|extension| extension == "rrd"));
        assert_eq!(recordings.count(), 1);
    }
}

/// Two drives with other gains are no two set-points.
#[test]
fn compare_refuses_scenarios_that_differ_in_more_than_the_set_point() {
    let work = folder(&[("one.toml", SLIDE), ("two.toml", &SLIDE.replace("60 1/s", "30 1/s"))]);
    let (one, two, out) = (work.path().join("one.toml"), work.path().join("two.toml"), work.path().join("out"));
    let output = servobench(&["compare", one.to_str().unwrap(), two.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("`one` and `two` differ in `drive.position`"), "{}", said(&output));
    assert!(!out.exists());
}

#[test]
fn a_limit_that_is_missed_in_a_comparison_ends_with_4_and_is_named() {
    let fast = format!("{SLIDE}\n[limits]\nmove_time = \"1 ms\"\n");
    let work = folder(&[("one.toml", &fast), ("two.toml", &SLIDE.replace("5 m/s2", "2 m/s2"))]);
    let (one, two, out) = (work.path().join("one.toml"), work.path().join("two.toml"), work.path().join("out"));
    let output = servobench(&["compare", one.to_str().unwrap(), two.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    assert!(said(&output).contains("one missed a limit: move_time"), "{}", said(&output));
    let results = json(&fs::read(out.join("comparison.json")).unwrap());
    let runs = results["scenarios"].as_array().unwrap();
    assert_eq!((&runs[0]["verdict"], &runs[1]["verdict"]), (&"failed".into(), &"passed".into()));
    assert!(runs.iter().all(|run| run["recording"] == "one-against-two.rrd"), "{results}");
    assert!(out.join("one-against-two.rrd").is_file());
}

/// What `view` hands to a viewer that writes its arguments down.
#[cfg(unix)]
fn viewed(folder: &Path) -> (Output, Vec<String>) {
    let viewer = repository().join("tests/viewer");
    let list = folder.join("viewed.txt");
    let output =
        command(&["view", folder.to_str().unwrap()]).env("PATH", viewer).env("VIEWED", &list).output().unwrap();
    let names = fs::read_to_string(list).unwrap_or_default();
    (output, names.lines().map(|path| Path::new(path).file_name().unwrap().to_str().unwrap().to_owned()).collect())
}

#[cfg(unix)]
#[test]
fn view_opens_what_the_last_results_name_and_nothing_older() {
    let work = folder(&[("slide.toml", SLIDE), ("slower.toml", &SLIDE.replace("5 m/s2", "2 m/s2"))]);
    let (one, two, out) = (work.path().join("slide.toml"), work.path().join("slower.toml"), work.path().join("out"));
    let (one, two) = (one.to_str().unwrap(), two.to_str().unwrap());
    let run = |arguments: &[&str]| {
        let output = servobench(&[arguments, &["--out", out.to_str().unwrap()]].concat());
        assert_eq!(code(&output), 0, "{}", said(&output));
    };
    let (output, _) = viewed(work.path());
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("no `results.json`"), "{}", said(&output));

    // Left by an earlier run of something else.
    fs::create_dir(&out).unwrap();
    fs::write(out.join("old.exact.rrd"), "old").unwrap();
    run(&["run", one, "--rrd"]);
    let rrd = out.join("slide.exact.rrd");
    let with_limits = fs::read(&rrd).unwrap();
    assert_eq!(viewed(&out).1, ["slide.exact.rrd"]);
    assert!(fs::read(&rrd).unwrap() == with_limits, "the one that `run` made is kept");

    // The Parquet file of a later run is newer than the `.rrd` of the first.
    run(&["run", one]);
    let long_ago = SystemTime::now() - Duration::from_hours(1);
    File::options().write(true).open(&rrd).unwrap().set_modified(long_ago).unwrap();
    assert_eq!(viewed(&out).1, ["slide.exact.rrd"]);
    assert!(rrd.metadata().unwrap().modified().unwrap() > long_ago + Duration::from_mins(1), "made anew");

    // What came last is shown: the comparison, in which all runs lie in one recording.
    File::options().write(true).open(out.join("results.json")).unwrap().set_modified(long_ago).unwrap();
    run(&["compare", one, two]);
    assert_eq!(viewed(&out).1, ["slide-against-slower.rrd"]);
}

/// The reason of a run in a worker process is not what the process wrote on its standard error.
#[cfg(feature = "mujoco")]
#[test]
fn a_reason_does_not_depend_on_where_the_run_happened() {
    let wild = SLIDE.replace("\"80 Hz\"", "\"2 MHz\"").replace("0.4 s", "20 s").replace("order = 3", "order = 2");
    let work = folder(&[("wild.toml", &wild)]);
    let (file, out) = (work.path().join("wild.toml"), work.path().join("out"));
    let output = servobench(&["run", file.to_str().unwrap(), "--engine", "mujoco", "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let reason = results["scenarios"][0]["reasons"][0].as_str().unwrap();
    assert!(reason.starts_with("at ") && reason.contains("engine `mujoco` diverged"), "{reason}");
    assert!(!reason.contains("jerk") && !reason.contains("servobench") && reason.lines().count() == 1, "{reason}");
    assert_eq!(said(&output).matches("is not used by a move of order 2").count(), 1, "{}", said(&output));
}

#[test]
fn the_schema_is_the_one_in_the_repository() {
    let output = servobench(&["schema"]);
    let kept = fs::read(repository().join("docs/scenario.schema.json")).unwrap();
    assert_eq!(json(&output.stdout), json(&kept), "run `servobench schema > docs/scenario.schema.json`");
}

#[test]
fn the_bare_demo_runs_on_the_embedded_engines() {
    let work = tempfile::tempdir().unwrap();
    let output = servobench(&["run", "--out", work.path().to_str().unwrap(), "--jobs", "2"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let results = json(&fs::read(work.path().join("results.json")).unwrap());
    let engines: Vec<_> = results["scenarios"].as_array().unwrap().iter().map(|one| one["engine"].clone()).collect();
    for engine in ["exact", "rapier"] {
        assert_eq!(engines.iter().filter(|name| *name == engine).count(), 2, "{engines:?}");
    }
}

#[test]
fn the_scenario_in_the_readme_passes() {
    let readme = fs::read_to_string(repository().join("README.md")).unwrap();
    let (_, rest) = readme.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let lines = text.lines().filter(|line| !line.is_empty()).count();
    assert!(lines <= 20, "the README promises a short scenario: {lines} lines");
    let room = folder(&[("readme.toml", text)]);
    let output =
        servobench(&["run", room.path().join("readme.toml").to_str().unwrap(), "--out", room.path().to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
}
