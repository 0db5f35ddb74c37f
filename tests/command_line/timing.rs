//! `servobench timing`, and the diagrams that `servobench run` leaves.
use crate::{SLIDE, code, folder, on_a_bus, said, servobench};
use servobench_trace::{Recording, Signal};
use std::fs;
use std::path::{Path, PathBuf};

/// The recording of a run over a fieldbus, in a folder that goes away.
fn recorded() -> (tempfile::TempDir, PathBuf) {
    let work = folder(&[("slide.toml", &on_a_bus(""))]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().join("slide.toml").to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    (work, out.join("slide.exact.parquet"))
}

/// What `timing` of the recording prints with these arguments.
fn drawn(recording: &Path, more: &[&str]) -> String {
    let output = servobench(&[&["timing", recording.to_str().unwrap()], more].concat());
    assert_eq!(code(&output), 0, "{}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_run_with_signals_leaves_its_diagram() {
    let (_work, recording) = recorded();
    let left = fs::read_to_string(recording.with_extension("timing.svg")).unwrap();
    assert!(left.starts_with("<svg"), "{left}");
    assert!(left.contains("Operation enabled"), "the state of the drive:\n{left}");
    assert_eq!(left, drawn(&recording, &[]), "the same of the recording");
}

#[test]
fn a_run_without_signals_leaves_none() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let out = work.path().join("out");
    let output = servobench(&["run", work.path().join("slide.toml").to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let mut names: Vec<_> = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["results.json", "slide.exact.parquet"]);
    assert!(drawn(&out.join("slide.exact.parquet"), &[]).contains("velocity"), "its curves can be drawn");
}

#[test]
fn arguments_choose_what_is_drawn() {
    let (work, path) = recorded();
    let mut recording = Recording::read_parquet(&path).unwrap();
    let signal = |source: &str, name: &str, changes: &[(f64, &str)]| Signal {
        source: source.into(),
        name: name.into(),
        changes: changes.iter().map(|(time, value)| (*time, (*value).to_owned())).collect(),
    };
    recording.signals = vec![
        signal("First", "Execute", &[(0.0, "FALSE"), (0.1, "TRUE")]),
        signal("Second", "Execute", &[(0.0, "FALSE"), (0.3, "TRUE")]),
        signal("Second", "Error", &[(0.0, "FALSE")]),
    ];
    let path = work.path().join("two.parquet");
    recording.write_parquet(&path).unwrap();
    let has = |more: &[&str]| ["First", "Second", ">Error<"].map(|word| drawn(&path, more).contains(word));
    assert_eq!(has(&["--idle"]), [true, true, true]);
    assert_eq!(has(&["--source", "Second", "--idle"]), [false, true, true]);
    // What is left out as idle is named in a note.
    assert_eq!(has(&["--source", "Second"]), [false, true, false]);
    assert_eq!(has(&["--source", "First", "--source", "Second", "--idle"]), [true, true, true]);
    // The second starts after that stretch.
    let is_left_out = |more: &[&str]| drawn(&path, more).contains("nothing happens: Second.Execute");
    assert_eq!([is_left_out(&["--from", "50 ms", "--to", "200 ms"]), is_left_out(&[])], [true, false]);
    assert!(drawn(&path, &["--width", "1200"]).contains("width=\"1200\""));

    let svg = work.path().join("part.svg");
    assert_eq!(drawn(&path, &["--from", "0.2 s", "-o", svg.to_str().unwrap()]), "");
    assert_eq!(fs::read_to_string(svg).unwrap(), drawn(&path, &["--from", "0.2 s"]));
}

#[test]
fn what_cannot_be_drawn_is_told_with_file_value_and_way_out() {
    let (work, recording) = recorded();
    let recording = recording.to_str().unwrap();
    let rrd = work.path().join("other.rrd");
    fs::write(&rrd, "no recording").unwrap();
    for (arguments, expected) in [
        (
            &[recording, "--width", "100"][..],
            "slide.exact.parquet`: --width: a drawing of 100 pixels; it is from 480 to 4000",
        ),
        (
            &[recording, "--source", "frist"],
            "slide.exact.parquet`: --source: no signals of `frist` are recorded; there are",
        ),
        (
            &[recording, "--from", "9 s"],
            "slide.exact.parquet`: --from, --to: nothing is recorded from 9.0 s to 0.4 s: choose",
        ),
        (&[recording, "--to", "0.2"], "a time needs its unit"),
        (&["no-such.parquet"], "cannot read `no-such.parquet`"),
        (&[rrd.to_str().unwrap()], "other.rrd` is not a Parquet file"),
    ] {
        let output = servobench(&[&["timing"], arguments].concat());
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(said(&output).contains(expected), "{expected} in:\n{}", said(&output));
        assert!(output.stdout.is_empty());
    }
    let nowhere = work.path().join("no/folder/part.svg");
    let output = servobench(&["timing", recording, "-o", nowhere.to_str().unwrap()]);
    assert_eq!(code(&output), 3);
    assert!(said(&output).contains("cannot write") && said(&output).contains("part.svg"), "{}", said(&output));
}

/// Nothing is lost: a recording is not drawn over itself, a scenario not by its own data sheet.
#[test]
fn what_is_read_is_not_written_over() {
    let (work, recording) = recorded();
    let before = fs::read(&recording).unwrap();
    let output = servobench(&["timing", recording.to_str().unwrap(), "-o", recording.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("name another file"), "{}", said(&output));
    assert_eq!(fs::read(&recording).unwrap(), before);

    let scenario = work.path().join("slide.toml");
    let before = fs::read(&scenario).unwrap();
    let output = servobench(&["objects", scenario.to_str().unwrap(), "-o", scenario.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert_eq!(fs::read(&scenario).unwrap(), before);
}
