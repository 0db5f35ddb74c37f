//! `servobench-view`, the program beside: found, of this version, started before anything runs, and what it fails at.
use crate::{SLIDE, code, folder, json, said, script};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A copy of `servobench` without anything beside it, in a folder where it finds its libraries; it goes away with the folder.
struct Alone(tempfile::TempDir);

impl Alone {
    fn new() -> Self {
        let program = Path::new(env!("CARGO_BIN_EXE_servobench"));
        let folder = tempfile::tempdir_in(program.parent().unwrap()).unwrap();
        let copy = folder.path().join("servobench");
        fs::hard_link(program, &copy).or_else(|_| fs::copy(program, &copy).map(drop)).unwrap();
        Self(folder)
    }

    /// Puts this script there as `servobench-view`.
    fn beside(&self, text: &str) {
        script(&self.0.path().join("servobench-view"), text);
    }

    /// Runs it in `work`, with the shell's own programs on the search path.
    fn run(&self, work: &Path, arguments: &[&str]) -> Output {
        let mut command = Command::new(self.0.path().join("servobench"));
        command.args(arguments).current_dir(work).env("PATH", "/usr/bin:/bin").output().unwrap()
    }
}

/// Answers `--version` as the program of this build does.
fn of_this_version(otherwise: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("[ \"$1\" = --version ] && exec echo servobench-view {version}\n{otherwise}\n")
}

#[test]
fn without_it_a_suite_ends_before_it_runs_and_a_comparison_goes_on() {
    let work = folder(&[("slide.toml", SLIDE), ("slower.toml", &SLIDE.replace("5 m/s2", "2 m/s2"))]);
    let alone = Alone::new();
    let sweep = "scenario = \"slide.toml\"\n[[vary]]\nkey = \"setpoint.jerk\"\nvalues = [\"100 m/s3\", \"200 m/s3\"]\n";
    fs::write(work.path().join("a.sweep.toml"), sweep).unwrap();
    let how = "`cargo build --release -p servobench-view` builds it";
    for arguments in [&["run", "slide.toml", "--rrd"][..], &["sweep", "a.sweep.toml", "--keep", "all", "--rrd"]] {
        let output = alone.run(work.path(), arguments);
        assert_eq!(code(&output), 3, "{}", said(&output));
        assert!(said(&output).contains("is neither beside this program nor on the PATH"), "{}", said(&output));
        assert!(said(&output).contains(how), "{}", said(&output));
        assert!(!work.path().join("servobench-out").exists(), "nothing was begun: {arguments:?}");
    }

    let output = alone.run(work.path(), &["compare", "slide.toml", "slower.toml", "--out", "compared"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let (table, warnings) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(warnings.contains("no recording for the viewer") && warnings.contains(how), "{warnings}");
    assert!(table.contains("slower") && !table.contains("look at it"), "{table}");
    let left: Vec<_> =
        fs::read_dir(work.path().join("compared")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["comparison.json"]);
    let results = json(&fs::read(work.path().join("compared/comparison.json")).unwrap());
    for run in results["scenarios"].as_array().unwrap() {
        assert_eq!((&run["recording"], &run["files"]), (&serde_json::Value::Null, &serde_json::json!([])));
    }

    // A Parquet file has to be drawn first; what is drawn already does not.
    let output = alone.run(work.path(), &["run", "slide.toml"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let output = alone.run(work.path(), &["view", "servobench-out"]);
    assert!(code(&output) == 3 && said(&output).contains(how), "{}", said(&output));
}

#[test]
fn one_of_another_version_is_refused_with_both_versions() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let alone = Alone::new();
    alone.beside("echo servobench-view 0.0.1");
    let output = alone.run(work.path(), &["run", "slide.toml", "--rrd"]);
    let own = format!("is servobench-view 0.0.1, and this program needs servobench-view {}", env!("CARGO_PKG_VERSION"));
    assert!(code(&output) == 3 && said(&output).contains(&own), "{}", said(&output));
    assert!(!work.path().join("servobench-out").exists());
}

/// It gets the recording by its name and all else on standard input; what it writes is the file.
#[test]
fn it_gets_recordings_and_a_request_and_writes_to_the_file() {
    let work = folder(&[("slide.toml", &format!("{SLIDE}\n[limits]\nmove_time = \"1 ms\"\n"))]);
    let alone = Alone::new();
    alone.beside(&of_this_version("shift; echo \"$@\"; exec cat -"));
    let output = alone.run(work.path(), &["run", "slide.toml", "--rrd"]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    let drawn = fs::read_to_string(work.path().join("servobench-out/slide.exact.rrd")).unwrap();
    let (recordings, request) = drawn.split_once('\n').unwrap();
    assert_eq!(recordings, "servobench-out/slide.exact.parquet");
    let request = json(request.as_bytes());
    assert_eq!((&request["format"], &request["labels"]), (&"servobench-view/1".into(), &serde_json::json!([])));
    let options = &request["options"];
    assert_eq!((&options["verdicts"][0]["outcome"], &options["window"]), (&"failed".into(), &1e-5.into()), "{options}");
    assert!(options["verdicts"][0]["reasons"][0].as_str().unwrap().starts_with("move_time"), "{options}");
    assert_eq!(options["allowed"], serde_json::json!([["move_time", 1e-3]]));
}

/// A recording that is not drawn costs the run its verdict, and leaves no half of a file.
#[test]
fn what_it_fails_at_is_an_error_of_the_run() {
    let work = folder(&[("slide.toml", SLIDE), ("slower.toml", &SLIDE.replace("5 m/s2", "2 m/s2"))]);
    let alone = Alone::new();
    alone.beside(&of_this_version("echo half of a file; echo no room >&2; exit 9"));
    let output = alone.run(work.path(), &["run", "slide.toml", "--rrd"]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let words = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("exit code 9; its last words: no room"), "{words}");
    let mut left: Vec<_> =
        fs::read_dir(work.path().join("servobench-out")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    assert!(left.iter().all(|name| !name.to_string_lossy().contains("rrd")), "{left:?}");
    let output = alone.run(work.path(), &["compare", "slide.toml", "slower.toml", "--out", "compared"]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    assert_eq!(fs::read_dir(work.path().join("compared")).unwrap().count(), 0, "neither recording nor half a file");
    // A recording that cannot be read is invalid input.
    fs::write(work.path().join("no.parquet"), "no recording").unwrap();
    alone.beside(&of_this_version("echo 'servobench-view: `no.parquet` is not a Parquet file' >&2; exit 2"));
    let output = alone.run(work.path(), &["view", "no.parquet"]);
    assert!(
        code(&output) == 2 && said(&output).starts_with("servobench: `no.parquet` is not a Parquet file"),
        "{}",
        said(&output)
    );
}
