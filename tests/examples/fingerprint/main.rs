//! Whether two builds compute the same numbers, bit for bit:
//!
//! ```sh
//! cargo run --release -p servobench-tests --example fingerprint -- PROGRAM OUT SCENARIOS...
//! ```
//!
//! runs every scenario under SCENARIOS (files or folders) with PROGRAM, a `servobench` of any build, on the scenario's own engines
//! and on every other one that takes it; plans every line of `plans.txt`; exports some axes as FMUs and steps them. In the folder
//! OUT it writes one file for each kind of result, to be compared with `diff -r`:
//!
//! | file | content |
//! |---|---|
//! | `recordings.txt` | a hash of each channel, signal, move, event, call and line of the log of each recording |
//! | `results.txt` | verdict, requirements, metrics and limits of each run, as `results.json` has them, without its digests |
//! | `said.txt` | what `check` and `run` say of each scenario |
//! | `plans.txt` | what `plan --json` says |
//! | `fmus.txt` | hashes of the files in exported FMUs, the libraries apart, and of what the FMUs put out |
mod fmus;
mod hash;
mod recordings;
mod runs;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, thread};

/// Runs at a time.
const WORKERS: usize = 2;

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let [program, out, scenarios @ ..] = arguments.as_slice() else {
        eprintln!("usage: fingerprint PROGRAM OUT SCENARIOS...");
        return ExitCode::from(2);
    };
    let version = call(program, Path::new("."), &["--version"]);
    assert!(version.status.success(), "{} does not run: {}", program.display(), said(&version));
    fs::create_dir_all(out).unwrap();
    let files: Vec<PathBuf> = scenarios.iter().flat_map(|one| scenario_files(one)).collect();
    let all = in_parallel(&files, |file| runs::of(program, file));
    let write = |name: &str, text: String| fs::write(out.join(name), text).unwrap();
    write("recordings.txt", all.iter().map(|one| one.recordings.as_str()).collect());
    write("results.txt", all.iter().map(|one| one.results.as_str()).collect());
    write("said.txt", all.iter().map(|one| one.said.as_str()).collect());
    write("plans.txt", in_parallel(&plan_lines(), |line| plan(program, line)).concat());
    write("fmus.txt", in_parallel(&fmus::exports(), |export| export.fingerprint(program)).concat());
    println!("{} scenarios: {}", files.len(), out.display());
    ExitCode::SUCCESS
}

/// The scenario files at or below `path`, in order.
fn scenario_files(path: &Path) -> Vec<PathBuf> {
    if path.is_file() {
        return vec![path.to_owned()];
    }
    let mut entries: Vec<PathBuf> = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    let is_wanted = |path: &PathBuf| {
        if path.is_dir() {
            !path.ends_with("models")
        } else {
            path.extension().is_some_and(|end| end == "toml") && !path.to_string_lossy().ends_with(".sweep.toml")
        }
    };
    entries.iter().filter(|path| is_wanted(path)).flat_map(|path| scenario_files(path)).collect()
}

/// `work` of each of `items`, in their order.
fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let mut done: Vec<(usize, R)> = thread::scope(|scope| {
        let worker = || {
            let mut done = Vec::new();
            while let Some((index, item)) =
                Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|i| Some((i, items.get(i)?)))
            {
                done.push((index, work(item)));
            }
            done
        };
        let workers: Vec<_> = (0..WORKERS).map(|_| scope.spawn(worker)).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Runs `program` with `arguments` in `folder`.
fn call(program: &Path, folder: &Path, arguments: &[&str]) -> Output {
    let program = program.canonicalize().unwrap();
    Command::new(program).args(arguments).current_dir(folder).env("COLUMNS", "80").output().unwrap()
}

/// Exit code, standard output and standard error.
fn said(output: &Output) -> String {
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    format!("{}\n{out}{err}", output.status)
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn plan_lines() -> Vec<&'static str> {
    include_str!("plans.txt").lines().filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
}

fn plan(program: &Path, line: &str) -> String {
    let arguments: Vec<&str> = ["plan"].into_iter().chain(line.split_whitespace()).chain(["--json"]).collect();
    // Names are as they were when profiles were options: fingerprints of older builds have them.
    let option = if line.starts_with("--") { "" } else { "--profile " };
    format!("== {option}{line}\n{}\n", said(&call(program, &repository(), &arguments)))
}
