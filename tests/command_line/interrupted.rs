//! Suites that are ended before their time: what stays, and how they go on.
use super::{SLIDE, code, command, folder, json, said, servobench};
use serde_json::Value;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// Three scenarios, the second of which takes long enough to be met under way, and the results of the suite when nothing ends it.
struct Suite {
    work: TempDir,
    whole: Vec<u8>,
}

impl Suite {
    fn new() -> Self {
        let kept = "[record]\nchannels = [\"load.position\"]\nrate = \"100 Hz\"\n[measure]";
        let long = SLIDE.replace("0.4 s", "2000 s").replace("[measure]", kept);
        let work = folder(&[("a.toml", SLIDE), ("b.toml", &long), ("c.toml", SLIDE), ("wrong.toml", "[run]\n")]);
        let suite = Self { work, whole: Vec::new() };
        let output = suite.command("whole").output().unwrap();
        assert_eq!(code(&output), 2, "{}", said(&output));
        let whole = fs::read(suite.out("whole").join("results.json")).unwrap();
        assert_eq!(json(&whole)["status"], "complete");
        assert!(!suite.out("whole").join("results.journal").exists());
        Self { whole, ..suite }
    }

    fn out(&self, name: &str) -> PathBuf {
        self.work.path().join(name)
    }

    fn command(&self, out: &str) -> Command {
        let files = ["a.toml", "b.toml", "c.toml", "wrong.toml"].map(|name| self.work.path().join(name));
        let mut command = command(&["run", "--jobs", "1", "--quiet"]);
        command.args(files).arg("--out").arg(self.out(out)).arg("--junit").arg(self.out(out).with_extension("xml"));
        command
    }

    /// The suite when its first run has ended and the second is under way.
    fn under_way(&self, out: &str) -> Child {
        let mut child = self.command(out).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let journal = self.out(out).join("results.journal");
        // The journal's own record, the invalid file, the first run.
        wait_until(|| fs::read_to_string(&journal).is_ok_and(|text| text.lines().count() >= 3));
        // Until the second one begins nothing computes.
        let before = processor_time(&child);
        wait_until(|| processor_time(&child) >= before + 2 || child.try_wait().unwrap().is_some());
        child
    }

    /// What is left is run, and then everything is as if nothing had ended the suite.
    fn goes_on(&self, out: &str) {
        let report = self.out(out).with_extension("xml");
        let (folder, junit) = (self.out(out), report.to_str().unwrap());
        let output = servobench(&["run", "--quiet", "--resume", folder.to_str().unwrap(), "--junit", junit]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        let results = fs::read(self.out(out).join("results.json")).unwrap();
        assert!(results == self.whole, "{}", String::from_utf8_lossy(&results));
        assert_eq!(names(&self.out(out)), names(&self.out("whole")));
        for name in names(&self.out("whole")) {
            assert!(fs::read(self.out(out).join(&name)).unwrap() == fs::read(self.out("whole").join(&name)).unwrap());
        }
        let report = fs::read_to_string(self.out(out).with_extension("xml")).unwrap();
        assert!(report.contains("tests=\"4\"") && !report.contains("unfinished"), "{report}");
    }

    fn results(&self, out: &str) -> Value {
        json(&fs::read(self.out(out).join("results.json")).unwrap())
    }
}

/// Waits for something that comes sooner or later.
fn wait_until(mut is_so: impl FnMut() -> bool) {
    while !is_so() {
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Time that a process has computed (clock ticks): proc_pid_stat(5), `utime`, the twelfth after the name in brackets.
fn processor_time(child: &Child) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
    let (_, after_the_name) = status.rsplit_once(')').unwrap();
    after_the_name.split_whitespace().nth(11).unwrap().parse().unwrap()
}

fn send(signal: &str, child: &Child) {
    assert!(Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap().success());
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = entries.collect();
    names.sort();
    names
}

fn unfinished(results: &Value) -> Vec<&str> {
    results["unfinished"].as_array().unwrap().iter().map(|run| run["name"].as_str().unwrap()).collect()
}

#[test]
fn interrupted_once_a_suite_ends_what_is_under_way_and_writes_its_results() {
    let suite = Suite::new();
    let mut child = suite.under_way("once");
    send("INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let results = suite.results("once");
    assert_eq!((results["status"].as_str(), unfinished(&results)), (Some("incomplete"), vec!["c"]));
    assert_eq!(results["scenarios"].as_array().unwrap().len(), 3);
    let report = fs::read_to_string(suite.out("once.xml")).unwrap();
    assert!(report.contains("errors=\"2\"") && report.contains("the suite was ended before this run"), "{report}");
    let left = ["a.exact.parquet", "b.exact.parquet", "results.journal", "results.json"];
    assert_eq!(names(&suite.out("once")), left);
    suite.goes_on("once");
}

#[test]
fn interrupted_twice_or_terminated_it_ends_now_and_nothing_that_has_ended_is_lost() {
    let suite = Suite::new();
    let endings: [(&str, &[&str], i32); 2] = [("twice", &["INT", "INT"], 2), ("term", &["TERM"], 15)];
    for (out, signals, number) in endings {
        let mut child = suite.under_way(out);
        for (k, signal) in signals.iter().enumerate() {
            if k > 0 {
                // Two of one kind that wait at once are one (signal(7)).
                std::thread::sleep(Duration::from_millis(50));
            }
            send(signal, &child);
        }
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(number), "{status}");
        let results = suite.results(out);
        assert_eq!((results["status"].as_str(), unfinished(&results)), (Some("incomplete"), vec!["b", "c"]));
        let report = fs::read_to_string(suite.out(out).with_extension("xml")).unwrap();
        assert!(report.contains("errors=\"3\""), "{report}");
        assert_eq!(names(&suite.out(out)), ["a.exact.parquet", "results.journal", "results.json"]);
        suite.goes_on(out);
    }
}

#[test]
fn a_killed_suite_loses_nothing_that_has_ended() {
    let suite = Suite::new();
    let mut child = suite.under_way("killed");
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(9));
    let results = suite.results("killed");
    assert_eq!((results["status"].as_str(), unfinished(&results)), (Some("incomplete"), vec!["a", "b", "c", "wrong"]));
    // A recording that was written before its run was noted is none.
    fs::write(suite.out("killed").join("c.exact.parquet"), "half").unwrap();
    suite.goes_on("killed");
}

/// However often it is ended, and wherever it then is.
#[test]
fn a_suite_that_is_resumed_can_be_killed_again() {
    let suite = Suite::new();
    let mut child = suite.under_way("often");
    child.kill().unwrap();
    child.wait().unwrap();
    let journal = suite.out("often").join("results.journal");
    for _ in 0..2 {
        let before = fs::read(&journal).unwrap().len();
        let resumed = command(&["run", "--quiet", "--resume", suite.out("often").to_str().unwrap()])
            .stdout(Stdio::null())
            .spawn();
        let mut resumed = resumed.unwrap();
        resumed.kill().unwrap();
        resumed.wait().unwrap();
        assert!(fs::read(&journal).unwrap().len() >= before);
    }
    suite.goes_on("often");
}

/// A recording that is damaged, or not there, is not of a run that has ended.
#[test]
fn what_is_damaged_is_run_again() {
    let suite = Suite::new();
    let mut child = suite.under_way("damaged");
    child.kill().unwrap();
    child.wait().unwrap();
    let recording = suite.out("damaged").join("a.exact.parquet");
    let mut bytes = fs::read(&recording).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&recording, bytes).unwrap();
    suite.goes_on("damaged");
}

#[test]
fn a_suite_whose_scenarios_have_changed_does_not_go_on() {
    let suite = Suite::new();
    let mut child = suite.under_way("changed");
    child.kill().unwrap();
    child.wait().unwrap();
    let before = fs::read(suite.out("changed").join("results.journal")).unwrap();
    fs::write(suite.work.path().join("c.toml"), SLIDE.replace("80 Hz", "81 Hz")).unwrap();
    let output = servobench(&["run", "--resume", suite.out("changed").to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("are not those it was begun with"), "{}", said(&output));
    assert!(said(&output).contains("a scenario that has no result yet"), "{}", said(&output));
    assert!(fs::read(suite.out("changed").join("results.journal")).unwrap() == before);
}

/// A scenario is read again when its turn comes: what it is then must be what the suite was begun with.
#[test]
fn a_scenario_that_changes_while_the_suite_runs_is_no_run_of_it() {
    let suite = Suite::new();
    let file = suite.work.path().join("c.toml");
    for (out, changed) in [("changed", Some(SLIDE.replace("20 kg", "21 kg"))), ("gone", None)] {
        let mut child = suite.under_way(out);
        match changed {
            Some(text) => fs::write(&file, text).unwrap(),
            None => fs::remove_file(&file).unwrap(),
        }
        assert_eq!(exit_of(&mut child), Some(2));
        fs::write(&file, SLIDE).unwrap();
        let run = &suite.results(out)["scenarios"][2];
        assert_eq!((run["name"].as_str(), run["verdict"].as_str()), (Some("c"), Some("error")));
        let reason = run["reasons"][0].as_str().unwrap();
        assert!(reason.contains("has changed since the suite began"), "{reason}");
        suite.goes_on(out);
    }
}

#[test]
fn a_complete_suite_is_reported_again() {
    let suite = Suite::new();
    let before = names(&suite.out("whole"));
    let output = servobench(&["run", "--resume", suite.out("whole").to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("4 runs: 3 unjudged (no limits), 1 invalid"), "{}", said(&output));
    assert_eq!(names(&suite.out("whole")), before);
    let output = servobench(&["run", "--resume", suite.work.path().to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("there is no suite in"), "{}", said(&output));
}

/// Whatever differs from what the report is of, it is not shown as today's, and what differs is named.
#[test]
fn a_complete_suite_is_not_reported_again_once_something_has_changed() {
    let limited = format!("{SLIDE}[limits]\nfollowing_error_peak_load = \"1 m\"\n");
    let work = folder(&[("a.toml", &limited), ("b.toml", &limited)]);
    let out = work.path().join("out");
    let files = ["a.toml", "b.toml"].map(|name| work.path().join(name));
    let mut suite = command(&["run", "--quiet"]);
    assert_eq!(code(&suite.args(&files).arg("--out").arg(&out).output().unwrap()), 0);
    let resumed = || servobench(&["run", "--resume", out.to_str().unwrap()]);
    let output = resumed();
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(
        said(&output).contains("nothing is left to run") && said(&output).contains("2 passed"),
        "{}",
        said(&output)
    );

    let (results, recording) = (out.join("results.json"), out.join("a.exact.parquet"));
    let is_refused = |changed: &Path, text: Option<Vec<u8>>, words: &str| {
        let before = fs::read(changed).unwrap();
        match text {
            Some(text) => fs::write(changed, text).unwrap(),
            None => fs::remove_file(changed).unwrap(),
        }
        let output = resumed();
        assert_eq!(code(&output), 2, "{}", said(&output));
        let told = said(&output);
        assert!(told.contains("its report is not one of today") && told.contains(words), "{told}");
        assert!(!told.contains("passed"), "{told}");
        assert!(told.lines().count() <= 3, "only what differs: {told}");
        fs::write(changed, before).unwrap();
    };
    // A run of it would fail.
    let strict = limited.replace("1 m\"\n", "1 nm\"\n");
    is_refused(&files[1], Some(strict.into_bytes()), "`b.toml` has changed");
    is_refused(&files[1], None, "cannot be used now");
    let edited = fs::read_to_string(&results).unwrap().replacen("\"passed\"", "\"unjudged\"", 1);
    is_refused(&results, Some(edited.into_bytes()), "`results.json`: the results are not those that were written");
    is_refused(&recording, None, "`a.exact.parquet` is gone");
    let other = fs::read(out.join("b.exact.parquet")).unwrap();
    is_refused(&recording, Some(other), "`a.exact.parquet` is not the recording that was measured");
    assert_eq!(code(&resumed()), 0);
}

/// A journal that somebody sent: no option of it writes, nothing outside of what the command line of now allows is read.
#[test]
fn a_journal_neither_writes_nor_reads_elsewhere() {
    let suite = Suite::new();
    let mut child = suite.under_way("sent");
    child.kill().unwrap();
    child.wait().unwrap();
    let journal = suite.out("sent").join("results.journal");
    let written = fs::read_to_string(&journal).unwrap();
    let resumed =
        |more: &[&str]| servobench(&[&["run", "--resume", suite.out("sent").to_str().unwrap()], more].concat());
    // The suite was begun with `--junit`, which would write over a file of whoever resumes it.
    let victim = suite.out("sent.xml");
    fs::write(&victim, "mine").unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    fs::write(elsewhere.path().join("secret.toml"), "password = 1\n").unwrap();
    let hostile = |from: &str, to: &str| {
        let (first, rest) = written.split_once('\n').unwrap();
        let json = first[17..].replace(from, to);
        assert_ne!(json, first[17..], "{from}");
        fs::write(&journal, format!("{:016x} {json}\n{rest}", twox_hash::XxHash64::oneshot(0, json.as_bytes())))
            .unwrap();
    };
    let secret = elsewhere.path().join("secret.toml");
    let a = suite.work.path().join("a.toml");
    for (from, to) in [
        (a.to_str().unwrap(), secret.to_str().unwrap()),
        (
            a.to_str().unwrap(),
            &format!("{}/../{}", suite.work.path().display(), secret.strip_prefix("/tmp").unwrap_or(&secret).display()),
        ),
    ] {
        hostile(from, to);
        let output = resumed(&[]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        assert!(
            said(&output).contains("which is outside of") && !said(&output).contains("password"),
            "{}",
            said(&output)
        );
    }
    // A link is what it leads to.
    std::os::unix::fs::symlink(&secret, suite.work.path().join("link.toml")).unwrap();
    hostile("a.toml", "link.toml");
    assert!(said(&resumed(&[])).contains("which is outside of"));
    hostile("\"stems\":[\"a.exact\"", "\"stems\":[\"../../x\"");
    assert!(said(&resumed(&[])).contains("which no run leaves beside it"));
    fs::write(&journal, &written).unwrap();
    let output = resumed(&["--root", elsewhere.path().to_str().unwrap()]);
    assert!(code(&output) == 2 && said(&output).contains("which is outside of"), "{}", said(&output));
    let output = resumed(&[]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("4 runs: 3 unjudged"), "{}", said(&output));
    assert_eq!(fs::read(victim).unwrap(), b"mine");
}

/// Recordings that something removes or changes while the suite runs are found at its end.
#[test]
fn recordings_that_change_while_the_suite_runs_take_the_verdict_away() {
    let suite = Suite::new();
    for (out, text) in [("gone", None), ("edited", Some("PAR1"))] {
        let mut child = suite.under_way(out);
        let recording = suite.out(out).join("a.exact.parquet");
        match text {
            None => fs::remove_file(&recording).unwrap(),
            Some(text) => fs::write(&recording, text).unwrap(),
        }
        assert_eq!(exit_of(&mut child), Some(2));
        let run = &suite.results(out)["scenarios"][0];
        assert_eq!((run["name"].as_str(), run["verdict"].as_str()), (Some("a"), Some("error")));
        let reason = run["reasons"][0].as_str().unwrap();
        assert!(reason.contains("changed while the suite ran: `a.exact.parquet`"), "{reason}");
        assert!(!recording.exists(), "nothing names it any more");
        suite.goes_on(out);
    }
}

/// What came in on standard input is not there again.
#[test]
fn a_scenario_from_standard_input_goes_on_too() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("out");
    let kept = "[record]\nchannels = [\"load.position\"]\nrate = \"100 Hz\"\n[measure]";
    let long = SLIDE.replace("0.4 s", "2000 s").replace("[measure]", kept);
    let mut child = command(&["run", "--quiet", "-", "--out", out.to_str().unwrap()])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), long.as_bytes()).unwrap();
    wait_until(|| out.join("results.json").exists());
    child.kill().unwrap();
    child.wait().unwrap();
    let output = servobench(&["run", "--resume", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert_eq!(names(&out), ["results.json", "stdin.exact.parquet"]);
}

/// The second of two suites says why it does not write into the folder of the first, and touches nothing there.
#[test]
fn two_suites_do_not_write_into_one_folder() {
    let suite = Suite::new();
    let mut child = suite.under_way("shared");
    let before = fs::read(suite.out("shared").join("results.json")).unwrap();
    let file = suite.work.path().join("a.toml");
    let second = |command: &str| {
        let (file, out) = (file.to_str().unwrap(), suite.out("shared"));
        let files: &[&str] = if command == "run" { &[file] } else { &[file, file] };
        servobench(&[&[command], files, &["--out", out.to_str().unwrap()]].concat())
    };
    for command in ["run", "compare"] {
        let output = second(command);
        assert_eq!(code(&output), 3, "{}", said(&output));
        assert!(said(&output).contains("another servobench writes into"), "{}", said(&output));
    }
    assert!(fs::read(suite.out("shared").join("results.json")).unwrap() == before);
    assert!(suite.out("shared").join("a.exact.parquet").is_file());
    assert_eq!(exit_of(&mut child), Some(2));
    assert!(fs::read(suite.out("shared").join("results.json")).unwrap() == suite.whole);
}

fn exit_of(child: &mut Child) -> Option<i32> {
    let status: ExitStatus = child.wait().unwrap();
    status.code()
}

/// A bound on the size of files stands for a disk that is full: what cannot be written is said, and what was is valid.
#[test]
fn a_disk_that_is_full_takes_no_verdict_for_good() {
    let work = folder(&[("a.toml", SLIDE), ("b.toml", SLIDE)]);
    let out = work.path().join("out");
    let program = env!("CARGO_BIN_EXE_servobench");
    // In blocks of 512 or 1024 bytes, which differs from shell to shell: neither holds the recordings, both hold the results.
    let line = format!("ulimit -f 40; exec {program} run {0} --out {0}/out", work.path().display());
    let output = Command::new("sh").args(["-c", &line]).output().unwrap();
    assert_eq!(code(&output), 3, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    assert_eq!(results["status"], "complete");
    for run in results["scenarios"].as_array().unwrap() {
        assert_eq!((run["verdict"].as_str(), run["recording"].as_str()), (Some("error"), None), "{run}");
    }
    assert_eq!(names(&out), ["results.journal", "results.json"]);
    // With room on the disk they are carried out.
    let output = servobench(&["run", "--resume", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).contains("0 of 2 runs had ended; running the others"), "{}", said(&output));
    assert_eq!(names(&out), ["a.exact.parquet", "b.exact.parquet", "results.json"]);
}
