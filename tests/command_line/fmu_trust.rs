//! Whose code runs when: an FMU whose library leaves a trace as soon as it is loaded.
use crate::fmu_standard::{self, DESCRIPTION, fmu, mischief};
use crate::{SLIDE, code, command, said};
use std::fs::{self, File};
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// It is loaded, and that is all: a function of the standard is not in it.
const SOURCE: &str = r#"
#include <stdio.h>
#include <stdlib.h>
__attribute__((constructor)) static void loaded(void) {
    const char *name = getenv("TRACE");
    FILE *file = name ? fopen(name, "a") : NULL;
    if (file) fputs("loaded\n", file), fclose(file);
}
"#;

/// A folder with `strict.fmu`, whose library leaves the trace, and scenarios with it beside the axis and as its mechanics, with and
/// without isolation.
fn work() -> TempDir {
    let work = tempfile::tempdir().unwrap();
    let (source, library) = (work.path().join("trace.c"), work.path().join("trace.so"));
    fs::write(&source, SOURCE).unwrap();
    let compiled = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(&source).status();
    assert!(compiled.unwrap().success(), "the C compiler that the workspace is built with anyway");
    let mut zip = ZipWriter::new(File::create(work.path().join("strict.fmu")).unwrap());
    let library = fs::read(library).unwrap();
    for (name, content) in [("modelDescription.xml", DESCRIPTION.as_bytes()), ("binaries/linux64/strict.so", &library)]
    {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    for (name, isolation) in [("isolated", ""), ("free", "isolation = \"none\"\n")] {
        let beside = fmu("strict", &format!("outputs = {{ x = \"disturbance.load\" }}\n{isolation}"));
        let write = |name: &str, text: String| fs::write(work.path().join(format!("{name}.toml")), text).unwrap();
        write(&format!("beside-{name}"), format!("{SLIDE}{beside}"));
        let engines =
            if cfg!(feature = "mujoco") { "engine = [\"mujoco\", \"rapier\"]" } else { "engine = [\"rapier\"]" };
        write(&format!("engines-{name}"), format!("{engines}\n{SLIDE}{beside}"));
        let mechanics = format!(
            "engine = \"fmu\"\n{SLIDE}[axis.fmu]\nfile = \"strict.fmu\"\n{isolation}inputs = {{ u = \"effort.motor\" }}\n\
             outputs = {{ clock = \"shaft.position\" }}\n"
        );
        write(&format!("mechanics-{name}"), mechanics);
    }
    work
}

/// What came of `arguments` in `folder`, and whether the library was loaded.
fn traced(folder: &Path, arguments: &[&str]) -> (Output, bool) {
    let trace = folder.join("trace");
    fs::remove_file(&trace).ok();
    let output = command(arguments).current_dir(folder).env("TRACE", &trace).output().unwrap();
    (output, trace.is_file())
}

/// What is said, without the lines that it is broken into.
fn in_one_line(output: &Output) -> String {
    said(output).split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

const ISOLATED: [&str; 3] = ["beside-isolated.toml", "engines-isolated.toml", "mechanics-isolated.toml"];
const FREE: [&str; 3] = ["beside-free.toml", "engines-free.toml", "mechanics-free.toml"];

#[test]
fn a_check_reads_descriptions_only() {
    let work = work();
    for scenario in ISOLATED {
        let (output, was_loaded) = traced(work.path(), &["check", scenario]);
        assert!(code(&output) == 0 && !was_loaded, "{scenario}: {}", said(&output));
        assert!(!said(&output).contains("--allow-unisolated-fmus"), "{scenario}: {}", said(&output));
        let (output, was_loaded) = traced(work.path(), &["check", scenario, "--load-fmus"]);
        assert!(code(&output) == 2 && was_loaded, "{scenario}: {}", said(&output));
    }
    for scenario in FREE {
        // It runs nothing, and says what a run will need.
        for more in [&[][..], &["--allow-unisolated-fmus"]] {
            let (output, was_loaded) = traced(work.path(), &[&["check", scenario], more].concat());
            assert!(code(&output) == 0 && !was_loaded, "{scenario}: {}", said(&output));
            let words = in_one_line(&output);
            assert!(words.contains("a run will need `--allow-unisolated-fmus`"), "{scenario}: {words}");
        }
        let (output, was_loaded) = traced(work.path(), &["check", scenario, "--load-fmus"]);
        assert!(code(&output) == 2 && !was_loaded, "{scenario}: {}", said(&output));
        let allowed = ["check", scenario, "--load-fmus", "--allow-unisolated-fmus"];
        let (output, was_loaded) = traced(work.path(), &allowed);
        assert!(code(&output) == 2 && was_loaded, "{scenario}: {}", said(&output));
    }
    // What a description cannot be used for is found without its code.
    let wrong = format!("{SLIDE}{}", fmu("strict", "outputs = { nothing = \"disturbance.load\" }"));
    fs::write(work.path().join("wrong.toml"), wrong).unwrap();
    let (output, was_loaded) = traced(work.path(), &["check", "wrong.toml"]);
    assert!(code(&output) == 2 && !was_loaded && said(&output).contains("`nothing`"), "{}", said(&output));
}

#[test]
fn no_other_command_runs_what_it_only_looks_at() {
    let work = work();
    let (output, was_loaded) = traced(work.path(), &["fmu", "info", "strict.fmu"]);
    assert!(code(&output) == 0 && !was_loaded, "{}", said(&output));
    for scenario in ISOLATED.into_iter().chain(FREE) {
        let (output, was_loaded) = traced(work.path(), &["fmu", "export", scenario, "-o", "x.fmu"]);
        assert!(!was_loaded, "{scenario}: {}", said(&output));
        let (output, was_loaded) = traced(work.path(), &["objects", scenario]);
        assert!(!was_loaded, "{scenario}: {}", said(&output));
    }
}

/// That an FMU runs where nothing contains it is for the command line to say: not for the scenario, nor for `--set`.
#[test]
fn no_scenario_lets_an_fmu_run_without_isolation() {
    let work = work();
    let unset = ["--set", "fmu.0.isolation=none"];
    for (scenario, more) in FREE.into_iter().map(|free| (free, &[][..])).chain([("beside-isolated.toml", &unset[..])]) {
        let compared = ["compare", scenario, scenario];
        for command in [&["run", scenario, "--out", "out"][..], &compared] {
            let (output, was_loaded) = traced(work.path(), &[command, more].concat());
            assert!(code(&output) == 2 && !was_loaded, "{command:?}: {}", said(&output));
            let words = in_one_line(&output);
            let place = if more.is_empty() { "isolation = \"none\"" } else { "fmu.0.isolation=none" };
            for says in [place, "a run needs `--allow-unisolated-fmus`", "leave `isolation` out"] {
                assert!(words.contains(says), "{command:?}: {says}: {}", said(&output));
            }
            let (output, was_loaded) = traced(work.path(), &[command, more, &["--allow-unisolated-fmus"]].concat());
            // There is no function of the standard in it.
            assert!(code(&output) == 2 && was_loaded, "{command:?}: {}", said(&output));
        }
    }
    for scenario in ISOLATED {
        let (output, was_loaded) = traced(work.path(), &["run", scenario]);
        assert!(code(&output) == 2 && was_loaded, "{scenario}: {}", said(&output));
    }
}

/// The journal of a suite is a file as any other: it may come from anywhere.
#[test]
fn a_suite_that_goes_on_is_trusted_again() {
    let work = fmu_standard::work(&[("hangs", mischief("m", "hang", "step", "isolation = \"none\""))]);
    let run = |more: &[&str]| {
        let mut command = command(more);
        command.current_dir(work.path());
        command
    };
    let mut child = run(&["run", "hangs.toml", "--out", "out", "--allow-unisolated-fmus"]).spawn().unwrap();
    let journal = work.path().join("out/results.journal");
    let late = Instant::now() + Duration::from_mins(1);
    // Its first record says what was allowed; a kill may come while it is being written.
    while !std::fs::read_to_string(&journal).is_ok_and(|text| text.contains('\n')) {
        assert!(Instant::now() < late, "there is no journal");
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let output = run(&["run", "--resume", "out"]).output().unwrap();
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("begun with `--allow-unisolated-fmus`; give it again"), "{}", said(&output));
}
