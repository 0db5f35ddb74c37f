//! Output that nobody reads, or that cannot be written.
use crate::{code, command, said};
use std::fs::File;
use std::process::Stdio;

/// CI pipes into `grep -q` and `head`: the verdict keeps its code when nobody reads, on whichever stream.
#[test]
fn a_reader_that_goes_away_leaves_the_verdict_its_code() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().to_str().unwrap();
    for (arguments, expected) in [
        (&["run", "tests/scenarios/must-fail.toml", "--out", out][..], 4),
        (&["run", "scenarios/lambrechts-snap.toml", "--engine", "exact", "--out", out], 0),
        (&["check", "no-such-file.toml"], 2),
        (&["schema"], 0),
    ] {
        let mut child = command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(expected), "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
const PLAN: [&str; 9] =
    ["plan", "--order", "2", "--distance", "1 m", "--velocity", "1 m/s", "--acceleration", "1 m/s2"];

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_ends_with_3() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().to_str().unwrap();
    for arguments in [
        &["run", "scenarios/lambrechts-snap.toml", "--engine", "exact", "--out", out][..],
        &["schema"],
        &["check", "scenarios/lambrechts-snap.toml"],
        &PLAN,
    ] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output =
            command(arguments).stdout(full).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap();
        assert_eq!(code(&output), 3, "{}", said(&output));
        assert!(said(&output).contains("cannot write to standard output"), "{}", said(&output));
    }
}

/// The command that looks at a result is that which the shell finds: the name alone where that is enough.
#[cfg(unix)]
#[test]
fn advice_names_the_program_as_short_as_a_shell_finds_it() {
    let work = crate::folder(&[("slide.toml", crate::SLIDE), ("other.toml", &crate::SLIDE.replace("80 Hz", "50 Hz"))]);
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_servobench"));
    let (out, folder) = (work.path().join("out"), program.parent().unwrap());
    let (one, two) = (work.path().join("slide.toml"), work.path().join("other.toml"));
    for arguments in
        [&["run", one.to_str().unwrap(), "--rrd"][..], &["compare", one.to_str().unwrap(), two.to_str().unwrap()]]
    {
        for (path, expected) in
            [(folder, ": servobench view "), (work.path(), &*format!(": {} view ", program.display()))]
        {
            let arguments = [arguments, &["--out", out.to_str().unwrap()]].concat();
            let output = command(&arguments).env("PATH", crate::search_path([path.to_owned()])).output().unwrap();
            assert!(said(&output).contains(expected), "{expected}: {}", said(&output));
        }
    }
}
