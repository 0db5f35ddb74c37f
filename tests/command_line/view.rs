//! `servobench view`, with a viewer that writes down what it is told to open.
use crate::{SLIDE, code, command, folder, repository, said, search_path, servobench};
use std::fs::{self, File};
use std::path::Path;
use std::process::Output;
use std::time::{Duration, SystemTime};

/// What `view` hands to a viewer that writes its arguments down.
fn viewed(folder: &Path) -> (Output, Vec<String>) {
    let viewer = repository().join("tests/viewer");
    let list = folder.join("viewed.txt");
    let mut view = command(&["view", folder.to_str().unwrap()]);
    let output = view.env("PATH", search_path([viewer])).env("VIEWED", &list).output().unwrap();
    let names = fs::read_to_string(list).unwrap_or_default();
    (output, names.lines().map(|path| Path::new(path).file_name().unwrap().to_str().unwrap().to_owned()).collect())
}

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

    // The `.rrd` of the first run is gone with it; one is made of the recording, and again when that is newer.
    run(&["run", one]);
    assert!(!rrd.exists());
    assert_eq!(viewed(&out).1, ["slide.exact.rrd"]);
    let long_ago = SystemTime::now() - Duration::from_hours(1);
    File::options().write(true).open(&rrd).unwrap().set_modified(long_ago).unwrap();
    assert_eq!(viewed(&out).1, ["slide.exact.rrd"]);
    assert!(rrd.metadata().unwrap().modified().unwrap() > long_ago + Duration::from_mins(1), "made anew");

    // What came last is shown: the comparison, in which all runs lie in one recording.
    File::options().write(true).open(out.join("results.json")).unwrap().set_modified(long_ago).unwrap();
    run(&["compare", one, two]);
    assert_eq!(viewed(&out).1, ["slide-against-slower.rrd"]);
}
