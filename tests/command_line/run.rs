//! `servobench run`: verdicts, results, recordings.
use crate::{SLIDE, code, folder, json, repository, said, servobench};
use std::fs;

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

/// The number behind each word: a single run shows all its metrics, several do when asked to.
#[test]
fn a_single_run_shows_all_its_metrics_with_limit_and_share() {
    let work = folder(&[("slide.toml", &format!("{SLIDE}\n[limits]\nmove_time = \"1 s\"\n"))]);
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let run = |more: &[&str]| {
        let arguments = ["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let output = servobench(&[&arguments[..], more].concat());
        assert_eq!(code(&output), 0, "{}", said(&output));
        assert!(said(&output).lines().all(|line| line.chars().count() <= 80), "{}", said(&output));
        String::from_utf8(output.stdout).unwrap()
    };
    let (one, both) = (run(&[]), ["--engine", "exact", "--engine", "rapier"]);
    let row = one.lines().find(|line| line.starts_with("move_time")).unwrap_or_else(|| panic!("{one}"));
    // 0.227 s of 1 s.
    assert_eq!(row.split_whitespace().collect::<Vec<_>>(), ["move_time", "227", "ms", "1.00", "s", "23", "%"]);
    assert_eq!(run(&both).matches("torque_rms").count(), 0);
    assert_eq!(run(&[&both[..], &["--verbose"]].concat()).matches("torque_rms").count(), 2);
}

/// Without limits nothing was judged, and a drive at its limit is no quiet pass.
#[test]
fn what_was_not_judged_did_not_pass_and_a_limit_that_bound_is_said() {
    let weak = SLIDE.replace("[drive.velocity]", "[drive]\nmax_force = \"60 N\"\n[drive.velocity]");
    let work = folder(&[("weak.toml", &weak)]);
    let (file, out) = (work.path().join("weak.toml"), work.path().join("out"));
    let output = servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let said = said(&output);
    assert!(said.contains("no limits  weak") && said.contains("1 run: 1 without limits"), "{said}");
    // 20 kg at 5 m/s² need 100 N.
    assert!(said.contains(" limit bound ") && !said.contains("passed"), "{said}");
}

#[test]
fn recordings_of_earlier_runs_are_announced() {
    let work = folder(&[("slide.toml", SLIDE), ("other.toml", SLIDE)]);
    let out = work.path().join("out");
    let run = |file: &str| {
        let output =
            servobench(&["run", work.path().join(file).to_str().unwrap(), "--out", out.to_str().unwrap(), "--rrd"]);
        said(&output)
    };
    assert!(!run("slide.toml").contains("earlier"));
    assert!(!run("slide.toml").contains("earlier"), "the same again");
    let said = run("other.toml");
    assert!(said.contains(", with a recording of an earlier run\n"), "{said}");
    assert!(said.contains(&format!("{} view ", env!("CARGO_BIN_EXE_servobench"))), "to be pasted: {said}");
}

#[test]
fn two_files_of_one_name_are_told_apart() {
    let work = tempfile::tempdir().unwrap();
    for side in ["a", "b"] {
        fs::create_dir(work.path().join(side)).unwrap();
        fs::write(work.path().join(side).join("slide.toml"), SLIDE).unwrap();
    }
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    for expected in ["a/slide  exact", "b/slide  exact"] {
        assert!(said(&output).contains(expected), "{}", said(&output));
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
fn a_run_that_cannot_be_carried_out_ends_with_3_and_costs_nobody_else() {
    // Two loops of 4 kHz with a bandwidth far beyond their rate: the axis leaves the finite numbers.
    let wild = SLIDE.replace("\"80 Hz\"", "\"2 MHz\"").replace("0.4 s", "20 s");
    let work = folder(&[("slide.toml", SLIDE), ("wild.toml", &wild)]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    assert_eq!(results["scenarios"][0]["verdict"], "unjudged");
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
