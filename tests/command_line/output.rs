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
