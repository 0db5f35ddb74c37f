//! `servobench run`: verdicts, results, recordings.
use crate::{SLIDE, code, command, folder, json, repository, said, servobench};
use std::fs;
#[cfg(unix)]
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
    let weak =
        SLIDE.replace("[drive.velocity]", "[drive]\nmax_force = \"95 N\"\n[drive.velocity]").replace("0.4 s", "1 s");
    let work = folder(&[("weak.toml", &weak)]);
    let (file, out) = (work.path().join("weak.toml"), work.path().join("out"));
    let output = servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let said = said(&output);
    assert!(said.contains("no limits  weak") && said.contains("1 run: 1 unjudged (no limits)"), "{said}");
    // 20 kg at 5 m/s² need 100 N.
    assert!(said.contains(" limit bound ") && !said.contains("passed"), "{said}");
}

/// Names are stable, and a run removes exactly what the list of the one before names.
#[test]
fn a_run_removes_what_the_run_before_left_and_nothing_else() {
    let work = folder(&[("slide.toml", SLIDE), ("other.toml", SLIDE)]);
    let out = work.path().join("out");
    let run = |file: &str| {
        let output =
            servobench(&["run", work.path().join(file).to_str().unwrap(), "--out", out.to_str().unwrap(), "--rrd"]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        said(&output)
    };
    let files = || {
        let names = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    };
    assert!(!run("slide.toml").contains("removed"));
    for name in ["mine.parquet", "notes.txt"] {
        fs::write(out.join(name), "mine").unwrap();
    }
    let again = run("slide.toml");
    assert!(again.contains(", with a recording that they do not name; removed 2 files of the run before\n"), "{again}");
    assert_eq!(files(), ["mine.parquet", "notes.txt", "results.json", "slide.exact.parquet", "slide.exact.rrd"]);
    let other = run("other.toml");
    assert_eq!(files(), ["mine.parquet", "notes.txt", "other.exact.parquet", "other.exact.rrd", "results.json"]);
    assert!(other.contains(&format!("{} view ", env!("CARGO_BIN_EXE_servobench"))), "to be pasted: {other}");
    let results = json(&fs::read(out.join("results.json")).unwrap());
    assert_eq!(results["scenarios"][0]["files"], serde_json::json!(["other.exact.parquet", "other.exact.rrd"]));
}

/// A list may come from anywhere: what is not beside it is not removed. One of a later version is refused by its name.
#[test]
fn a_list_of_others_removes_nothing() {
    let work = folder(&[("slide.toml", SLIDE), ("victim.parquet", "mine")]);
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let run = || {
        let output = servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        said(&output)
    };
    run();
    let list = out.join("results.json");
    let text = fs::read_to_string(&list).unwrap();
    let victim = work.path().join("victim.parquet");
    assert!(text.contains("\"slide.exact.parquet\"\n"));
    for path in ["../victim.parquet".to_owned(), victim.display().to_string()] {
        fs::write(&list, text.replace("\"slide.exact.parquet\"\n", &format!("{path:?}\n"))).unwrap();
        run();
        assert!(victim.is_file(), "{path}");
    }
    // What cannot be read as results is somebody else's.
    let of_others =
        ["{}".to_owned(), "mine\n".to_owned(), text.replace("servobench-results/3", "servobench-results/4")];
    for (text, why) in of_others.iter().zip(["missing field", "expected value", "`servobench-results/4`, newer"]) {
        fs::write(&list, text).unwrap();
        let output = servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        let said = said(&output);
        assert_eq!(code(&output), 2, "{said}");
        assert!(said.contains("--out") && said.contains(why) && said.contains("would be lost"), "{said}");
        assert_eq!(&fs::read_to_string(&list).unwrap(), text);
    }
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
    // Whole, in lines of their own.
    for expected in ["a/slide\n", "b/slide\n"] {
        assert!(said(&output).contains(expected), "{}", said(&output));
    }
}

/// One bad file does not stop the others, and is in every report.
#[test]
fn a_file_that_is_invalid_ends_with_2_and_the_others_run() {
    let work = folder(&[("bad.toml", &SLIDE.replace("\"20 kg\"", "20")), ("good.toml", SLIDE)]);
    let (out, junit) = (work.path().join("out"), work.path().join("new").join("folder").join("junit.xml"));
    let arguments = ["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = servobench(&[&arguments[..], &["--junit", junit.to_str().unwrap()]].concat());
    assert_eq!(code(&output), 2, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let verdicts: Vec<_> = results["scenarios"].as_array().unwrap().iter().map(|run| &run["verdict"]).collect();
    assert_eq!(verdicts, ["invalid", "unjudged"], "{results}");
    assert!(results["scenarios"][0]["reasons"][0].as_str().unwrap().contains("bad.toml:8:8: "), "{results}");
    assert!(out.join("good.exact.parquet").is_file());
    let report = fs::read_to_string(&junit).unwrap();
    assert!(report.contains("errors=\"1\"") && report.contains("type=\"invalid\""), "{report}");
    // The count is the last but one line, and what is invalid stands directly above it.
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.contains("INVALID    bad") && table.contains("2 runs: 1 unjudged (no limits), 1 invalid"), "{table}");
    assert!(table.find("no limits  good").unwrap() < table.find("INVALID").unwrap(), "{table}");
}

#[test]
fn where_every_file_is_invalid_nothing_is_touched() {
    let work = folder(&[("bad.toml", &SLIDE.replace("\"20 kg\"", "20"))]);
    let (out, junit) = (work.path().join("out"), work.path().join("junit.xml"));
    let arguments = ["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = servobench(&[&arguments[..], &["--junit", junit.to_str().unwrap()]].concat());
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(!out.exists() && junit.is_file());
    for wrong in
        [&["run", "no-such-file.toml"][..], &["run", "--no-such-flag"], &["fly"], &[], &["compare", "one.toml"]]
    {
        assert_eq!(code(&servobench(wrong)), 2, "{wrong:?}");
    }
}

#[test]
fn what_is_no_toml_is_one_mistake_and_of_many_twenty_are_shown() {
    let many = (0..300).map(|k| format!("key{k} = {k}\n")).collect::<Vec<_>>().concat();
    let json = format!("{{\n{}}}\n", "  \"key\": 1,\n".repeat(10_000));
    let work = folder(&[("results.json", &json), ("many.toml", &many)]);
    let said_of = |name: &str| {
        let output = servobench(&["run", work.path().join(name).to_str().unwrap()]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        said(&output)
    };
    let said = said_of("results.json");
    assert!(said.contains("results.json: 1 mistake\n") && said.contains("it looks like JSON"), "{said}");
    let said = said_of("many.toml");
    assert!(said.contains("many.toml: 303 mistakes\n") && said.contains("and 283 more in "), "{said}");
    assert_eq!(said.matches("unknown key").count(), 20 - 3, "{said}");
}

#[test]
fn a_report_that_cannot_be_written_does_not_swallow_the_table() {
    let work = folder(&[("slide.toml", SLIDE), ("taken", "a file where a folder should be")]);
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let junit = work.path().join("taken").join("junit.xml");
    let arguments = ["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = servobench(&[&arguments[..], &["--junit", junit.to_str().unwrap()]].concat());
    assert_eq!(code(&output), 3, "{}", said(&output));
    assert!(said(&output).contains("1 run: 1 unjudged") && said(&output).contains("cannot make the folder"));
    assert!(out.join("results.json").is_file());
}

#[test]
fn a_missed_limit_is_in_junit_with_its_line_and_the_time_that_the_run_took() {
    let work = folder(&[("slide.toml", &format!("{SLIDE}\n[limits]\nmove_time = \"1 ms\"\n"))]);
    let (file, out, junit) = (work.path().join("slide.toml"), work.path().join("out"), work.path().join("junit.xml"));
    let (path, report) = (file.to_str().unwrap(), junit.to_str().unwrap());
    let output = servobench(&["run", path, "--out", out.to_str().unwrap(), "--junit", report, "--quiet"]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    let text = fs::read_to_string(&junit).unwrap();
    let line = fs::read_to_string(&file).unwrap().lines().position(|line| line.starts_with("move_time")).unwrap() + 1;
    assert!(text.contains(&format!("file=\"{path}\" line=\"{line}\"")), "{text}");
    assert!(text.contains(&format!("limit 1.00 ms, 230 times as much ({path}:{line})")), "{text}");
    assert!(!text.contains("time=\"0.000\""), "{text}");
    // One line for what did not pass, and the count.
    let lines: Vec<_> = said(&output).lines().map(str::to_owned).collect();
    assert_eq!(lines, ["FAILED   slide on exact: move_time 227 ms, limit 1.00 ms", "1 run: 1 failed; 1 with warnings"]);
    let results = json(&fs::read(out.join("results.json")).unwrap());
    assert_eq!(results["scenarios"][0]["metrics"]["move_time"]["line"], line);
    assert_eq!(results["scenarios"][0]["parameters"]["drive.velocity.bandwidth"], "80 Hz");
}

/// A name is no option and no command, wherever it goes.
#[test]
fn a_name_may_be_anything() {
    let name = "name = \"-fast\\n::error::all is fine\\u001b[2J\"";
    let work = folder(&[("slide.toml", &format!("{name}\n{SLIDE}"))]);
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let output = servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let said = said(&output);
    assert!(!said.contains('\u{1b}') && said.lines().all(|line| !line.trim_start().starts_with("::")), "{said}");
    assert!(out.join("-fast---error--all-is-fine--2J.exact.parquet").is_file());
}

#[test]
fn a_run_that_diverges_has_failed_and_costs_nobody_else() {
    // Two loops of 4 kHz with a bandwidth far beyond their rate: the axis leaves the finite numbers.
    let wild = SLIDE.replace("\"80 Hz\"", "\"2 MHz\"").replace("0.4 s", "20 s");
    let work = folder(&[("slide.toml", SLIDE), ("wild.toml", &wild)]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    assert_eq!(results["scenarios"][0]["verdict"], "unjudged");
    assert_eq!(results["scenarios"][1]["verdict"], "failed");
    let reasons: Vec<_> =
        results["scenarios"][1]["reasons"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
    for begins in ["stable: the loop is unstable: ", "bounded: the run diverged at "] {
        assert!(reasons.iter().any(|reason| reason.starts_with(begins)), "{reasons:?}");
    }
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
    assert_eq!(code(&output), 4, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let reasons = results["scenarios"][0]["reasons"].as_array().unwrap().iter().map(|one| one.as_str().unwrap());
    let reason = reasons.into_iter().find(|reason| reason.starts_with("bounded: the run diverged at ")).unwrap();
    assert!(!reason.contains("jerk") && !reason.contains("servobench") && reason.lines().count() == 1, "{reason}");
    assert_eq!(said(&output).matches("is not used by a move of order 2").count(), 1, "{}", said(&output));
}

/// Without a file the demo runs, says so, and leaves other results alone.
#[test]
fn the_bare_demo_runs_on_the_embedded_engines() {
    let work = tempfile::tempdir().unwrap();
    let others = work.path().join("servobench-out");
    fs::create_dir(&others).unwrap();
    fs::write(others.join("results.json"), "mine").unwrap();
    let output = command(&["run", "--jobs", "2"]).current_dir(work.path()).output().unwrap();
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).contains("no file is named: running the demo that is built in (jerk."), "{}", said(&output));
    assert_eq!(fs::read_to_string(others.join("results.json")).unwrap(), "mine");
    let results = json(&fs::read(others.join("demo").join("results.json")).unwrap());
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

/// A run that passed, one without limits, one that failed.
#[test]
fn keep_says_which_recordings_stay() {
    let limit = |most: &str| format!("{SLIDE}[limits]\nfollowing_error_peak_load = \"{most}\"\n");
    let files = [("passed.toml", limit("1 m")), ("failed.toml", limit("1 nm")), ("unjudged.toml", SLIDE.to_owned())];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let work = folder(&files);
    let out = work.path().join("out");
    let run = |more: &[&str]| {
        let arguments = ["run", work.path().to_str().unwrap(), "--out", out.to_str().unwrap()];
        let output = servobench(&[&arguments[..], more].concat());
        let results = json(&fs::read(out.join("results.json")).unwrap());
        let mut left: Vec<_> =
            fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        left.retain(|name| name != "results.json");
        left.sort();
        let mut named: Vec<String> = Vec::new();
        for run in results["scenarios"].as_array().unwrap() {
            let files: Vec<_> =
                run["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap().to_owned()).collect();
            assert_eq!(run["recording"].as_str(), files.first().map(String::as_str));
            named.extend(files);
        }
        named.sort();
        assert_eq!(named, left, "results.json names what is there");
        (code(&output), said(&output), left)
    };
    let (code_of_all, said, all) = run(&[]);
    assert_eq!(all, ["failed.exact.parquet", "passed.exact.parquet", "unjudged.exact.parquet"]);
    assert!(code_of_all == 4 && said.contains("\nresults and recordings: "), "{said}");
    let (code, said, left) = run(&["--keep", "failed", "--rrd"]);
    assert_eq!((code, left), (4, vec!["failed.exact.parquet".to_owned(), "failed.exact.rrd".to_owned()]));
    assert!(
        said.contains("\nresults and 1 recording: ") && said.contains("; removed 3 files of the run before"),
        "{said}"
    );
    let (code, said, left) = run(&["--keep", "none"]);
    assert_eq!((code, left.len()), (4, 0));
    assert!(said.contains("\nresults, no recordings: ") && !said.contains("look at them"), "{said}");
    let view = servobench(&["view", out.to_str().unwrap()]);
    assert!(crate::code(&view) == 2 && crate::said(&view).contains("`--keep all`"), "{}", crate::said(&view));
    let both = servobench(&["run", work.path().to_str().unwrap(), "--keep", "none", "--rrd"]);
    assert!(crate::code(&both) == 2 && crate::said(&both).contains("leave one of them out"), "{}", crate::said(&both));
}
