//! `servobench sweep`: a scenario over many values of its keys.
use crate::{SLIDE, code, command, folder, json, repository, said, servobench};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The slide with a limit that the heavier ones miss, over masses and a text.
const SWEEP: &str = r#"
scenario = "slide.toml"
description = "slides of several masses"
metrics = ["following_error_peak_load", "torque_peak"]
[[vary]]
key = "setpoint.order"
values = [2, 3]
[[vary]]
key = "setpoint.acceleration"
values = ["7.3 m/s2", "9.1 m/s2", "11.7 m/s2"]
"#;

fn files() -> tempfile::TempDir {
    folder(&[("slide.toml", SLIDE), ("a.sweep.toml", SWEEP)])
}

fn sweep(work: &Path, more: &[&str]) -> std::process::Output {
    let (file, out) = (work.join("a.sweep.toml"), work.join("out"));
    servobench(&[&["sweep", file.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat())
}

/// A row of a table: heading and cell of each column.
pub(crate) type Row = Vec<(String, String)>;

/// Rows of a CSV without quotes, by heading.
pub(crate) fn rows(path: &Path) -> Vec<Row> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let heading = lines.next().unwrap();
    lines.map(|cells| heading.iter().cloned().zip(cells).collect()).collect()
}

pub(crate) fn cell<'a>(row: &'a [(String, String)], heading: &str) -> &'a str {
    &row.iter().find(|(name, _)| name == heading).unwrap_or_else(|| panic!("{heading} in {row:?}")).1
}

/// Every row is what `run` gives with the keys of the row, to the bit.
#[test]
fn a_row_is_what_a_run_of_its_keys_gives() {
    let work = files();
    let output = sweep(work.path(), &["--engine", "exact", "--engine", "rapier"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).lines().all(|line| line.chars().count() <= 80), "{}", said(&output));
    let all = rows(&work.path().join("out/sweep.csv"));
    assert_eq!(all.len(), 12);
    let results = json(&fs::read(work.path().join("out/results.json")).unwrap());
    for (row, result) in all.iter().zip(results["scenarios"].as_array().unwrap()) {
        let overrides = [
            format!("setpoint.order={}", cell(row, "setpoint.order")),
            format!("setpoint.acceleration={} m/s2", cell(row, "setpoint.acceleration [m/s2]")),
        ];
        assert_eq!(result["overrides"], Value::from(overrides.to_vec()));
        let (scenario, out) = (work.path().join("slide.toml"), work.path().join("one"));
        let run = servobench(&[
            "run",
            scenario.to_str().unwrap(),
            "--engine",
            cell(row, "engine"),
            "--set",
            &overrides[0],
            "--set",
            &overrides[1],
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(code(&run), 0, "{}", said(&run));
        let one = json(&fs::read(out.join("results.json")).unwrap());
        let one = &one["scenarios"][0];
        assert_eq!(one["inputs"], result["inputs"]);
        for (name, unit) in [("following_error_peak_load", "m"), ("torque_peak", "N")] {
            let own: f64 = cell(row, &format!("{name} [{unit}]")).parse().unwrap();
            assert_eq!(own.to_bits(), one["metrics"][name]["value"].as_f64().unwrap().to_bits(), "{row:?}");
            assert_eq!(one["metrics"][name], result["metrics"][name]);
        }
    }
}

#[test]
fn a_sweep_fails_with_its_runs() {
    let limited = format!("{SLIDE}\n[limits]\ntorque_peak = \"190 N\"\n");
    let work = folder(&[("slide.toml", &limited), ("a.sweep.toml", SWEEP)]);
    let output = sweep(work.path(), &[]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    let verdicts: Vec<_> =
        rows(&work.path().join("out/sweep.csv")).iter().map(|row| cell(row, "verdict").to_owned()).collect();
    assert!(verdicts.contains(&"passed".to_owned()) && verdicts.contains(&"failed".to_owned()), "{verdicts:?}");
}

/// What a sweep that was interrupted has left is gone on with, and comes to the same files.
#[cfg(unix)]
#[test]
fn a_sweep_is_resumed() {
    let draws = "[[vary]]\nkey = \"axis.motor_side.mass\"\nnormal = { mean = \"20 kg\", tolerance = \"5 %\" }\n[draws]\ncount = 300\n";
    let work = folder(&[("slide.toml", SLIDE), ("a.sweep.toml", &format!("{SWEEP}{draws}"))]);
    let out = work.path().join("out");
    assert_eq!(code(&sweep(work.path(), &["--quiet"])), 0);
    let files = ["sweep.csv", "sweep.parquet", "results.json"];
    let whole = files.map(|file| fs::read(out.join(file)).unwrap());
    let (file, out) = (work.path().join("a.sweep.toml"), work.path().join("out"));
    let mut child = command(&["sweep", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--quiet"])
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let journal = out.join("results.journal");
    let lines = || fs::read_to_string(&journal).map_or(0, |text| text.lines().count());
    while lines() < 20 && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    child.kill().ok();
    child.wait().unwrap();
    if journal.exists() {
        assert!(!out.join("sweep.csv").exists(), "an old table beside a new sweep");
        let run = servobench(&["run", "--resume", out.to_str().unwrap()]);
        assert_eq!(code(&run), 2, "{}", said(&run));
        assert!(said(&run).contains("servobench sweep --resume"), "{}", said(&run));
        let resumed = servobench(&["sweep", "--resume", out.to_str().unwrap()]);
        assert_eq!(code(&resumed), 0, "{}", said(&resumed));
    }
    for (file, whole) in files.iter().zip(whole) {
        assert!(fs::read(out.join(file)).unwrap() == whole, "{file}");
    }
}

#[test]
fn what_is_wrong_with_a_sweep_is_said_before_it_runs() {
    let refusal = |sweep: &str| {
        let work = folder(&[("slide.toml", SLIDE), ("a.sweep.toml", sweep)]);
        let output = self::sweep(work.path(), &[]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        assert!(!work.path().join("out").exists());
        said(&output)
    };
    let unknown = refusal(&SWEEP.replace("setpoint.acceleration", "setpoint.accelerate"));
    assert!(unknown.contains("accelerate") && unknown.contains("not even the first"), "{unknown}");
    let missing = refusal(&SWEEP.replace("slide.toml", "nowhere.toml"));
    assert!(missing.contains("nowhere.toml"), "{missing}");
    let outside = refusal(&SWEEP.replace("slide.toml", "/etc/passwd"));
    assert!(outside.contains("/etc/passwd") && outside.contains("--root"), "{outside}");
    let twice = refusal(&SWEEP.replace("setpoint.acceleration", "setpoint.order"));
    assert!(twice.contains("`setpoint.order` varies twice"), "{twice}");
}

/// One value that the scenario does not take costs its rows, which say why.
#[test]
fn an_invalid_value_costs_its_rows() {
    let work = folder(&[("slide.toml", SLIDE), ("a.sweep.toml", &SWEEP.replace("9.1 m/s2", "-9.1 m/s2"))]);
    let output = sweep(work.path(), &[]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("2 of the 6 points that were tried are invalid"), "{}", said(&output));
    let all = rows(&work.path().join("out/sweep.csv"));
    let invalid: Vec<_> = all.iter().filter(|row| cell(row, "verdict") == "invalid").collect();
    assert_eq!(invalid.len(), 2);
    assert!(invalid.iter().all(|row| cell(row, "setpoint.acceleration [m/s2]") == "-9.1"));
    assert!(invalid.iter().all(|row| cell(row, "torque_peak [N]").is_empty()));
    let results = json(&fs::read(work.path().join("out/results.json")).unwrap());
    assert!(results["scenarios"][1]["reasons"][0].as_str().unwrap().contains("-9.1 m/s2"), "{results}");
}

#[test]
fn a_key_may_follow_another_one() {
    let limits = "scenario = \"slide.toml\"\n[[vary]]\nkey = \"limits.following_error_peak_load\"\n\
                  also = \"limits.following_error_peak_motor\"\nvalues = [\"1 nm\", \"30 nm\"]\n";
    let work = folder(&[("slide.toml", SLIDE), ("a.sweep.toml", limits)]);
    assert_eq!(code(&sweep(work.path(), &[])), 4);
    let results = json(&fs::read(work.path().join("out/results.json")).unwrap());
    let of = |index: usize, what: &str| results["scenarios"][index][what].clone();
    let both = ["limits.following_error_peak_load=30 nm", "limits.following_error_peak_motor=30 nm"];
    assert_eq!(of(1, "overrides"), Value::from(both.to_vec()));
    assert_eq!((of(0, "verdict"), of(1, "verdict")), ("failed".into(), "passed".into()));
    assert_eq!(of(0, "reasons").as_array().unwrap().len(), 2);
}

#[test]
fn recordings_stay_when_asked_for_and_go_with_their_sweep() {
    let work = files();
    let output = sweep(work.path(), &["--keep", "all"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    for number in 1..=6 {
        assert!(work.path().join(format!("out/slide-{number}.exact.parquet")).is_file(), "{number}");
    }
    // A suite that comes after it leaves nothing of it.
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    assert_eq!(code(&servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()])), 0);
    let mut left: Vec<_> = fs::read_dir(&out).unwrap().map(|one| one.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["results.json", "slide.exact.parquet"]);
}

/// A table by somebody else is neither written over nor removed by what comes after it.
#[test]
fn a_table_of_the_user_stays() {
    let work = files();
    let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let run = || servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&run()), 0);
    let own = out.join("sweep.csv");
    fs::write(&own, "my,own,table\n").unwrap();
    let output = sweep(work.path(), &[]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("is no table of a sweep"), "{}", said(&output));
    assert_eq!(code(&run()), 0);
    assert_eq!(fs::read_to_string(own).unwrap(), "my,own,table\n");
}

/// The sweep of the README, and its picture: `SERVOBENCH_WRITE_DOCS=1` writes it anew.
#[test]
fn the_picture_of_the_readme_is_that_of_its_sweep() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().to_str().unwrap();
    let output = servobench(&["sweep", "scenarios/sweeps/jerk-or-snap.sweep.toml", "--out", out]);
    // Most combinations miss a limit on some machine: that is what it shows.
    assert_eq!(code(&output), 4, "{}", said(&output));
    assert!(said(&output).lines().all(|line| line.chars().count() <= 80), "{}", said(&output));
    let shown = String::from_utf8(output.stdout).unwrap();
    let front: Vec<&str> = shown.lines().skip_while(|line| !line.starts_with("No other combination")).collect();
    assert!(front.iter().take(4).any(|line| line.contains("jerk 50 m/s3, snap 1000 m/s4")), "{shown}");
    for (drawn, kept) in [("sweep.svg", "jerk-or-snap.svg"), ("sweep-front.svg", "jerk-or-snap-front.svg")] {
        let (drawn, kept) = (fs::read(work.path().join(drawn)).unwrap(), repository().join("docs/images").join(kept));
        if std::env::var_os("SERVOBENCH_WRITE_DOCS").is_some() {
            fs::write(&kept, &drawn).unwrap();
        }
        assert!(fs::read(&kept).unwrap() == drawn, "{}: run this test with SERVOBENCH_WRITE_DOCS=1", kept.display());
    }
}
