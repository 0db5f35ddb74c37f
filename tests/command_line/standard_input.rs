//! `-`: a scenario from standard input, an output to standard output.
use crate::{SLIDE, code, command, folder, json, on_a_bus, repository, said, servobench};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Output, Stdio};

/// `servobench` in `folder`, with `text` on standard input.
fn fed(arguments: &[&str], text: &[u8], folder: &Path) -> Output {
    let mut child = command(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // One that refuses its arguments reads nothing.
    child.stdin.take().unwrap().write_all(text).ok();
    child.wait_with_output().unwrap()
}

/// Oracle: the same text from a file, on engines in this process and in one of their own.
#[test]
fn a_scenario_from_standard_input_runs_as_from_a_file() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let mut engines = vec!["--engine", "exact"];
    if cfg!(feature = "mujoco") {
        engines.extend(["--engine", "mujoco"]);
    }
    let run = |scenario, out| {
        let output = fed(&[&["run", scenario, "--out", out][..], &engines].concat(), SLIDE.as_bytes(), work.path());
        assert_eq!(code(&output), 0, "{}", said(&output));
        json(&fs::read(work.path().join(out).join("results.json")).unwrap())
    };
    let (mut from_stdin, mut from_file) = (run("-", "a"), run("slide.toml", "b"));
    assert_eq!(
        (&from_stdin["scenarios"][0]["name"], &from_stdin["scenarios"][0]["file"]),
        (&"stdin".into(), &"-".into())
    );
    assert_eq!(from_stdin["scenarios"][0]["recording"], "stdin.exact.parquet");
    for results in [&mut from_stdin, &mut from_file] {
        // The name is part of what a run is made of, of its recording, and of the digest of all.
        for key in ["suite", "digest"] {
            results.as_object_mut().unwrap().remove(key);
        }
        for run in results["scenarios"].as_array_mut().unwrap() {
            for key in ["name", "file", "inputs", "made_of", "recording", "recording_seal", "files"] {
                run.as_object_mut().unwrap().remove(key);
            }
        }
    }
    assert_eq!(from_stdin, from_file);
}

/// A table, a model and an MJCF file are where the current folder has them.
#[test]
fn what_it_names_is_looked_for_from_the_current_folder() {
    let model = fs::read_to_string(repository().join("models/motors/emps.toml")).unwrap();
    let work = folder(&[]);
    fs::create_dir_all(work.path().join("models/motors")).unwrap();
    fs::write(work.path().join("models/motors/own.toml"), model).unwrap();
    let text = SLIDE.replace("kind = \"ideal-source\"", "model = \"own\"");
    let output = fed(&["check", "-"], text.as_bytes(), work.path());
    assert_eq!(code(&output), 0, "{}", said(&output));
    let elsewhere = fed(&["check", "-"], text.as_bytes(), &repository());
    assert!(code(&elsewhere) == 2 && said(&elsewhere).contains("unknown model `own`"), "{}", said(&elsewhere));
}

#[test]
fn mistakes_are_told_as_those_of_stdin() {
    let work = folder(&[]);
    let wrong = SLIDE.replace("jerk =", "jerq =");
    for command in ["run", "check"] {
        let output = fed(&[command, "-"], wrong.as_bytes(), work.path());
        assert_eq!(code(&output), 2);
        let said = said(&output);
        assert!(said.contains("stdin: 2 mistakes") && said.contains("[stdin:25:1]"), "{said}");
    }
    let output = fed(&["run", "-"], b"\xff\xfe", work.path());
    assert!(code(&output) == 2 && said(&output).contains("cannot read `stdin`: "), "{}", said(&output));
    let output = fed(&["run", "-"], b"", work.path());
    assert!(code(&output) == 2 && said(&output).contains("missing table `[run]`"), "{}", said(&output));
    let twice = fed(&["compare", "-", "-"], SLIDE.as_bytes(), work.path());
    assert!(code(&twice) == 2 && said(&twice).contains("`-` is there twice"), "{}", said(&twice));
}

#[test]
fn every_command_that_reads_a_scenario_takes_standard_input() {
    let work = folder(&[("other.toml", &SLIDE.replace("80 Hz", "50 Hz"))]);
    let compared = fed(&["compare", "other.toml", "-"], SLIDE.as_bytes(), work.path());
    assert!(said(&compared).contains("other and stdin on exact"), "{}", said(&compared));
    let bus = on_a_bus("\"6065h\" = 4711");
    let objects = fed(&["objects", "-", "--output", "-", "--format", "json"], bus.as_bytes(), work.path());
    assert!(json(&objects.stdout).to_string().contains("4711"), "{}", said(&objects));
    let without = fed(&["objects", "-"], SLIDE.as_bytes(), work.path());
    assert!(said(&without).contains("`stdin` has no `[bus]`"), "{}", said(&without));
}

#[test]
fn a_dash_is_standard_output_for_output_alone() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let file = work.path().join("slide.toml");
    for arguments in [
        &["run", file.to_str().unwrap(), "--junit", "-"][..],
        &["run", file.to_str().unwrap(), "--out", "-"],
        &["plan", "--order", "2", "--distance", "1 m", "--velocity", "1 m/s", "--acceleration", "1 m/s2", "--svg", "-"],
    ] {
        let output = servobench(arguments);
        assert_eq!(code(&output), 2, "{}", said(&output));
        assert!(said(&output).contains("standard output (-) is for --output alone"), "{}", said(&output));
    }
    let output = servobench(&["objects", "--format", "eds", "--output", "-"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("FileName=drive.eds"), "{}", said(&output));
}

/// A terminal is told what is waited for; `script` gives one to the program.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_is_told_what_is_expected() {
    let program = env!("CARGO_BIN_EXE_servobench");
    let call = format!("{program} check -");
    let mut script = std::process::Command::new("script");
    let started = script.args(["-qec", &call, "/dev/null"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    // Not every machine has it.
    let Ok(mut child) = started else { return };
    child.stdin.take().unwrap().write_all(b"\x04").ok();
    let output = child.wait_with_output().unwrap();
    assert!(said(&output).contains("reading a scenario (TOML) from standard input"), "{}", said(&output));
}
