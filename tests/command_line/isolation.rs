//! Scenarios and models that crash, hang or take all there is, and processes that are killed or stopped: each costs its run only, and
//! nothing of it stays.
use super::{SLIDE, code, command, folder, json, repository, said, servobench};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A scenario of `tests/hostile`.
fn hostile(name: &str) -> String {
    repository().join("tests/hostile").join(name).to_str().unwrap().to_owned()
}

/// Processes that `of` has started, and that these have started, which have not ended: their ids and command lines.
fn descendants(of: u32) -> Vec<(u32, String)> {
    let ids = fs::read_dir("/proc").unwrap().filter_map(|entry| entry.unwrap().file_name().to_str()?.parse().ok());
    let all: Vec<(u32, u32)> = ids.filter_map(|id: u32| Some((id, parent(id)?))).collect();
    let (mut found, mut next) = (Vec::new(), vec![of]);
    while let Some(parent) = next.pop() {
        let children = all.iter().filter(|(_, of)| *of == parent).map(|(id, _)| *id);
        next.extend(children.clone());
        found.extend(children);
    }
    let line = |id: &u32| fs::read_to_string(format!("/proc/{id}/cmdline")).unwrap_or_default().replace('\0', " ");
    found.iter().map(|id| (*id, line(id))).collect()
}

/// Whoever started the process; `None` for one that has ended.
fn parent(id: u32) -> Option<u32> {
    let stat = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    let mut words = stat.rsplit_once(") ")?.1.split(' ');
    let state = words.next()?;
    words.next()?.parse().ok().filter(|_| !matches!(state, "Z" | "X"))
}

/// Waits for something that comes sooner or later.
fn wait_until(mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < Duration::from_mins(1), "it does not come");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn send(signal: &str, process: u32) {
    assert!(Command::new("kill").args(["-s", signal, &process.to_string()]).status().unwrap().success());
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = entries.collect();
    names.sort();
    names
}

/// The worker of a suite that is under way: it has started nothing, its keeper has started it.
fn worker_of(suite: &Child) -> u32 {
    let mut found = None;
    wait_until(|| {
        let all = descendants(suite.id());
        found = all.iter().map(|(id, _)| *id).find(|id| parent(*id).is_some_and(|keeper| keeper != suite.id()));
        found.is_some()
    });
    found.unwrap()
}

/// How long the process has run, in ticks of the system's clock (a hundredth of a second): proc(5), fields 14 and 15 of `stat`.
#[cfg(feature = "mujoco")]
fn time_of(process: u32) -> u64 {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let behind_the_name = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    behind_the_name.skip(11).take(2).filter_map(|ticks| ticks.parse::<u64>().ok()).sum()
}

fn start(arguments: &[&str], out: &Path) -> Child {
    let mut suite = command(arguments);
    suite.arg("--out").arg(out).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn a_model_that_is_nested_without_end_is_refused() {
    let work = folder(&[]);
    for arguments in [vec!["check"], vec!["run", "--out", work.path().to_str().unwrap()]] {
        let output = command(&arguments).arg(hostile("nested.toml")).output().unwrap();
        assert_eq!(code(&output), 2, "{}", said(&output));
        let words = said(&output).split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert!(words.contains("the depth of elements in each other is more than 1000"), "{words}");
    }
}

#[test]
fn a_recording_that_does_not_fit_is_refused_before_it_begins() {
    let work = folder(&[]);
    let (file, out) = (hostile("bigmem.toml"), work.path().join("out"));
    let output = servobench(&["run", &file, "--memory-limit", "50 MB", "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 3, "{}", said(&output));
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let reason = results["scenarios"][0]["reasons"][0].as_str().unwrap();
    assert!(reason.contains("and the limit is 50 MB") && reason.contains("`record.channels`"), "{reason}");
}

/// Ten days of an axis: named as slow, then ended with what it has. The file's own limit holds as that of the command line does.
#[test]
fn a_run_that_takes_too_long_is_named_and_then_ended() {
    let endless = SLIDE.replace("0.4 s", "1e6 s").replace("[measure]", "[record]\nrate = \"1 Hz\"\n[measure]");
    let own = endless.replacen("[axis]", "time_limit = \"1 s\"\n[axis]", 1);
    let work = folder(&[("endless.toml", &endless), ("own.toml", &own)]);
    for (name, limit) in [("endless", vec!["--time-limit", "1 s"]), ("own", vec![])] {
        let (file, out) = (work.path().join(format!("{name}.toml")), work.path().join(name));
        let arguments = [&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()], &limit[..]].concat();
        let output = servobench(&arguments);
        assert_eq!(code(&output), 3, "{}", said(&output));
        assert!(said(&output).contains(&format!("slow: {name}.exact: ")), "{}", said(&output));
        let results = json(&fs::read(out.join("results.json")).unwrap());
        let reason = results["scenarios"][0]["reasons"][0].as_str().unwrap();
        assert!(
            reason.starts_with("its limit of time, 1 s, was reached at ") && reason.contains("of 1000000.000 s"),
            "{reason}"
        );
    }
}

/// A model that MuJoCo does not come back from, in a suite that is killed.
#[cfg(feature = "mujoco")]
#[test]
fn nothing_is_left_of_a_suite_that_is_killed() {
    let work = folder(&[]);
    let out = work.path().join("out");
    for signal in ["KILL", "TERM"] {
        let mut suite = start(&["run", "--quiet", &hostile("looping.toml")], &out);
        worker_of(&suite);
        let family = descendants(suite.id());
        send(signal, suite.id());
        suite.wait().unwrap();
        wait_until(|| family.iter().all(|(id, _)| parent(*id).is_none()));
        let left = names(&out);
        assert!(left.iter().all(|name| name == "results.json" || name == "results.journal"), "{signal}: {left:?}");
    }
}

/// The second run of the suite passes, whatever ends the worker of the first one from outside.
#[cfg(feature = "mujoco")]
#[test]
fn a_worker_that_is_killed_costs_its_run_only() {
    let work = folder(&[("z.toml", SLIDE)]);
    for (signal, says) in [("SEGV", "signal 11 (SIGSEGV"), ("KILL", "signal 9 (SIGKILL"), ("ABRT", "signal 6 (SIGABRT")]
    {
        let (file, out) = (work.path().join("z.toml"), work.path().join(signal));
        let arguments = ["run", &hostile("looping.toml"), file.to_str().unwrap(), "--engine", "mujoco", "--jobs", "1"];
        let suite = start(&arguments, &out);
        let worker = worker_of(&suite);
        // At its start the runtime takes a SIGSEGV for one of its own, which would come again.
        wait_until(|| time_of(worker) >= 10);
        send(signal, worker);
        let output = suite.wait_with_output().unwrap();
        assert_eq!(code(&output), 3, "{}", said(&output));
        let results = json(&fs::read(out.join("results.json")).unwrap());
        let [looping, slide] = &results["scenarios"].as_array().unwrap()[..] else { panic!("{results}") };
        let reason = looping["reasons"][0].as_str().unwrap();
        assert!(reason.contains(says) && slide["verdict"] == "unjudged", "{reason} {slide}");
    }
}

/// The time in which the suite itself is stopped is not silence of its worker.
#[cfg(feature = "mujoco")]
#[test]
fn a_suite_that_is_stopped_goes_on() {
    let long = SLIDE.replace("0.4 s", "500 s").replace("[measure]", "[record]\nrate = \"10 Hz\"\n[measure]");
    let work = folder(&[("long.toml", &long)]);
    let file = work.path().join("long.toml");
    let arguments = ["run", file.to_str().unwrap(), "--engine", "mujoco", "--worker-timeout", "2 s"];
    let suite = start(&arguments, &work.path().join("out"));
    worker_of(&suite);
    send("STOP", suite.id());
    std::thread::sleep(Duration::from_secs(4));
    send("CONT", suite.id());
    let output = suite.wait_with_output().unwrap();
    assert_eq!(code(&output), 0, "{}", said(&output));
}

/// Suites in PID namespaces of their own, with one folder: their workers had one name, and so did their recordings.
#[cfg(feature = "mujoco")]
#[test]
fn two_suites_with_one_folder_do_not_swap_recordings() {
    let isolated = |arguments: &[&str]| {
        let mut command = Command::new("unshare");
        command.args(["--pid", "--fork", "--mount-proc"]).args(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).current_dir(repository());
        command
    };
    if !isolated(&["true"]).status().is_ok_and(|status| status.success()) {
        eprintln!(
            "skipped: two_suites_with_one_folder_do_not_swap_recordings needs PID namespaces, which are not allowed here"
        );
        return;
    }
    let program = env!("CARGO_BIN_EXE_servobench");
    let own = ["A", "B"].map(|name| {
        let work = folder(&[]);
        code(&servobench(&[
            "run",
            "--quiet",
            &hostile(&format!("pidns/{name}")),
            "--out",
            work.path().to_str().unwrap(),
        ]))
    });
    assert_eq!(own, [0, 4]);
    for pair in 0..5 {
        let work = folder(&[]);
        let out: PathBuf = work.path().join("out");
        let suites = ["A", "B"].map(|name| {
            let file = hostile(&format!("pidns/{name}"));
            isolated(&[program, "run", "--quiet", &file, "--out", out.to_str().unwrap()]).spawn().unwrap()
        });
        let outputs = suites.map(|suite| suite.wait_with_output().unwrap());
        for (output, own) in outputs.iter().zip(own) {
            // The folder may be the other's.
            let is_locked = code(output) == 3 && said(output).contains("another servobench writes into");
            assert!(is_locked || code(output) == own, "pair {pair}: {}", said(output));
        }
        assert!(outputs.iter().any(|output| code(output) != 3));
    }
}

/// The worker was told the name by an option; names and paths that look like one are none.
#[test]
fn a_name_that_begins_with_a_hyphen_is_a_name() {
    let work = folder(&[]);
    let engines: &[&str] = if cfg!(feature = "mujoco") { &["exact", "rapier", "mujoco"] } else { &["exact", "rapier"] };
    for engine in engines {
        let out = work.path().join(engine);
        let arguments = ["run", &hostile("dash.toml"), "--engine", engine, "--out", out.to_str().unwrap()];
        let output = servobench(&arguments);
        assert_eq!(code(&output), 0, "{engine}: {}", said(&output));
        assert_eq!(names(&out), [format!("-fast.{engine}.parquet"), "results.json".to_owned()]);
    }
}
