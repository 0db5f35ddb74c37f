//! `cargo xtask drill inputs`: mutated files of every kind that the program reads, through the program itself.
//!
//! For any content of a file, the program ends with one of its own exit codes, and rejects within 1 s of processor time and 200 MB of
//! memory. Wall-clock time means nothing on a shared machine.
use super::built;
use super::measured::{Measured, PATIENCE, measured};
use super::mutants::{Digest, Mutator};
use crate::failure::Failure;
use crate::workspace::{Workspace, run as run_command};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

/// Files of each kind; `SERVOBENCH_SWEEP` overrides it.
const FILES: u64 = 40;
/// Limits of a rejection: processor time (s), memory (MB).
const MOST_SECONDS: f64 = 1.0;
const MOST_MEGABYTES: f64 = 200.0;
/// Exit codes of the program: passed, invalid input, error, failed.
const CODES: [i32; 4] = [0, 2, 3, 4];
/// Exit codes of a rejected file.
const REJECTED: [i32; 2] = [2, 3];

/// One kind of file, and the command that reads it.
struct Kind {
    name: &'static str,
    mutator: Mutator,
    /// Path of the file in the folder of the kind.
    file: &'static str,
    /// Folder whose content is removed before each command.
    cleared: Option<&'static str>,
    command: Vec<String>,
    folder: PathBuf,
}

/// Results for all files of a kind.
#[derive(Default)]
struct Outcome {
    codes: BTreeMap<String, u64>,
    /// Largest value for a rejected file.
    seconds: f64,
    megabytes: f64,
    offenders: Vec<String>,
}

/// Runs the drill.
///
/// # Errors
/// [`Failure::Findings`] with each file that the program mishandled; they are kept.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let files = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|size| size.parse().ok()).unwrap_or(FILES);
    built(workspace)?;
    let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
    let room_path = room.path().canonicalize().map_err(Failure::file("find", room.path()))?;
    let kinds = kinds(workspace, &room_path)?;
    let kept = workspace.target.join("drill").join("inputs");
    let outcomes: Vec<Result<Outcome, Failure>> = thread::scope(|scope| {
        let threads: Vec<_> =
            kinds.iter().map(|kind| scope.spawn(|| held_against(kind, files, workspace, &kept))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap_or_else(|_| Ok(Outcome::default()))).collect()
    });
    let mut offenders = Vec::new();
    println!("{:14} {:>8}  {:24} {:>9} {:>9}", "kind", "files", "exit codes", "most s", "most MB");
    for (kind, outcome) in kinds.iter().zip(outcomes) {
        let Outcome { codes, seconds, megabytes, offenders: own } = outcome?;
        let codes: Vec<_> = codes.iter().map(|(code, count)| format!("{code}: {count}")).collect();
        println!("{:14} {files:>8}  {:24} {seconds:>9.3} {megabytes:>9.1}", kind.name, codes.join(", "));
        offenders.extend(own);
    }
    if offenders.is_empty() { Ok(()) } else { Err(Failure::Findings { findings: offenders }) }
}

/// Gives every file of a kind to the program. Mishandled ones are kept in a folder.
fn held_against(kind: &Kind, files: u64, workspace: &Workspace, kept: &Path) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    for number in 0..files {
        let bytes = kind.mutator.file(number)?;
        if let Some(folder) = kind.cleared {
            let folder = kind.folder.join(folder);
            fs::remove_dir_all(&folder).or_else(|_| fs::create_dir_all(&folder)).ok();
            fs::create_dir_all(&folder).map_err(Failure::file("make", &folder))?;
        }
        let path = kind.folder.join(kind.file);
        fs::write(&path, &bytes).map_err(Failure::file("write", &path))?;
        let mut command = workspace.servobench(&kind.command);
        command.current_dir(&kind.folder).env("LD_LIBRARY_PATH", workspace.native_lib());
        let program = workspace.binary();
        let ended = measured(&mut command, PATIENCE)
            .map_err(|source| Failure::Start { program: program.display().to_string(), source })?;
        let code = ended.code.map_or_else(|| "signal".to_owned(), |code| code.to_string());
        *outcome.codes.entry(code).or_default() += 1;
        if ended.code.is_some_and(|code| REJECTED.contains(&code)) {
            outcome.seconds = outcome.seconds.max(ended.seconds);
            outcome.megabytes = outcome.megabytes.max(ended.megabytes);
        }
        if let Some(why) = offence(ended) {
            let folder = kept.join(kind.name);
            let copy = folder.join(format!("{number}-{}", path.file_name().unwrap_or_default().to_string_lossy()));
            fs::create_dir_all(&folder).map_err(Failure::file("make", &folder))?;
            fs::write(&copy, &bytes).map_err(Failure::file("write", &copy))?;
            outcome.offenders.push(format!("{}: {why}", copy.display()));
        }
    }
    Ok(outcome)
}

/// Description of a forbidden behaviour of the program, if any.
fn offence(ended: Measured) -> Option<String> {
    let Measured { code, seconds, megabytes } = ended;
    let Some(code) = code else { return Some("ended by a signal".into()) };
    if !CODES.contains(&code) {
        return Some(format!("exit code {code}"));
    }
    let is_too_much = seconds > MOST_SECONDS || megabytes > MOST_MEGABYTES;
    (REJECTED.contains(&code) && is_too_much).then(|| format!("rejected after {seconds:.2} s with {megabytes:.0} MB"))
}

/// A run of a few ticks that follows a table, with two channels.
const TINY: &str = r#"
engine = ["exact"]
[run]
base_rate = "1 kHz"
duration = "0.05 s"
[axis]
motion = "linear"
motor_side = { mass = "20 kg" }
[motor]
kind = "prescribed"
[[program]]
table = { file = "table.csv" }
[record]
channels = ["load.position", "motor.velocity"]
[limits]
move_time = "1 s"
"#;
const TABLE: &str = "time [ms],position [mm],velocity [mm/s]\n0,0,0\n10,0.1,20\n20,0.4,30\n30,0.5,0\n";
/// A motor by its model, and a body in an MJCF file.
const WITH_MODEL: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
lead = "10 mm"
motor_side = { inertia = "1e-3 kg m2" }
[motor]
model = "own"
[drive]
model = "servo-16khz"
dc_link = "320 V"
[setpoint]
order = 2
velocity = "0.1 m/s"
acceleration = "1 m/s2"
[[program]]
move_to = "10 mm"
"#;

/// The folder `folder`, with these files.
fn folder_of(folder: &Path, files: &[(&str, &str)]) -> Result<PathBuf, Failure> {
    for (file, text) in files {
        let path = folder.join(file);
        let own = path.parent().unwrap_or(folder);
        fs::create_dir_all(own).map_err(Failure::file("make", own))?;
        fs::write(&path, text).map_err(Failure::file("write", &path))?;
    }
    fs::create_dir_all(folder).map_err(Failure::file("make", folder))?;
    Ok(folder.to_owned())
}

fn kinds(workspace: &Workspace, room: &Path) -> Result<Vec<Kind>, Failure> {
    let text = |path: &Path| {
        let path = workspace.root.join(path);
        fs::read_to_string(&path).map_err(Failure::file("read", &path))
    };
    let texts = |paths: &[&str], ending: &str| -> Result<Vec<String>, Failure> {
        let tracked = workspace.tracked(paths)?;
        tracked.iter().filter(|path| path.extension().is_some_and(|own| own == ending)).map(|path| text(path)).collect()
    };
    let folder = |name: &str, files: &[(&str, &str)]| folder_of(&room.join(name), files);
    let tiny = [("tiny.toml", TINY), ("table.csv", TABLE)];
    let seeds = Seeds::made(workspace, &folder("seeds", &tiny)?)?;
    let mjcf = text(Path::new("scenarios/own-mjcf.toml"))?.replace("../models/axes/swaying-load.xml", "own.xml");
    let kind = |name, mutator, file, cleared, command: &[&str], folder| Kind {
        name,
        mutator,
        file,
        cleared,
        command: command.iter().map(|word| (*word).to_owned()).collect(),
        folder,
    };
    let scenarios: Vec<String> = texts(&["scenarios"], "toml")?;
    let models: Vec<String> = texts(&["models/motors"], "toml")?;
    let tables: Vec<String> = texts(&["scenarios"], "csv")?;
    let mechanics: Vec<String> = texts(&["models/axes"], "xml")?;
    let descriptions: Vec<String> = texts(&["crates/fmi/tests/description"], "xml")?;
    let none = Digest::None;
    Ok(vec![
        kind(
            "scenario",
            Mutator::of_texts(&scenarios, none),
            "a.toml",
            None,
            &["check", "a.toml"],
            folder("scenario", &[("points.csv", TABLE), ("velocities.csv", TABLE)])?,
        ),
        kind(
            "model",
            Mutator::of_texts(&models, none),
            "models/motors/own.toml",
            None,
            &["check", "a.toml"],
            folder("model", &[("a.toml", WITH_MODEL), ("models/motors/own.toml", "")])?,
        ),
        kind(
            "mjcf",
            Mutator::of_texts(&mechanics, none),
            "own.xml",
            None,
            &["check", "a.toml"],
            folder("mjcf", &[("a.toml", &mjcf)])?,
        ),
        kind(
            "table",
            Mutator::of_texts(&tables, none),
            "table.csv",
            None,
            &["check", "tiny.toml"],
            folder("table", &tiny)?,
        ),
        kind(
            "recording",
            Mutator::of_bytes(&[seeds.recording], Digest::Seal),
            "a.parquet",
            None,
            &["timing", "a.parquet"],
            folder("recording", &[])?,
        ),
        kind(
            "results",
            Mutator::of_texts(&[seeds.results], none),
            "out/results.json",
            Some("out"),
            &["run", "--resume", "out", "-q"],
            folder("results", &tiny)?,
        ),
        kind(
            "journal",
            Mutator::of_texts(
                &[seeds.journal.replace(&seeds.folder, &room.join("journal").display().to_string())],
                Digest::Lines,
            ),
            "out/results.journal",
            Some("out"),
            &["run", "--resume", "out", "-q"],
            folder("journal", &tiny)?,
        ),
        kind(
            "fmu",
            Mutator::of_descriptions(&descriptions)?,
            "a.fmu",
            None,
            &["fmu", "info", "a.fmu"],
            folder("fmu", &[])?,
        ),
    ])
}

/// Files that the program has written.
struct Seeds {
    recording: Vec<u8>,
    results: String,
    journal: String,
    /// Folder of the run.
    folder: String,
}

impl Seeds {
    /// Runs the program in `folder`.
    fn made(workspace: &Workspace, folder: &Path) -> Result<Self, Failure> {
        let arguments = ["run", "tiny.toml", "--out", "out"];
        run_command(workspace.servobench(arguments).arg("-q").current_dir(folder), 0)?;
        let read = |name: &str| {
            let path = folder.join("out").join(name);
            fs::read(&path).map_err(Failure::file("read", path))
        };
        let results = String::from_utf8_lossy(&read("results.json")?).into_owned();
        let values: Value = serde_json::from_str(&results)
            .map_err(|error| Failure::Output { command: "servobench run".into(), why: error.to_string() })?;
        let suite = json!({ "suite": { "version": 1, "suite": values["suite"], "command": arguments, "folder": folder, "stems": ["tiny.exact"] } });
        let finished = json!({ "finished": { "index": 0, "seconds": 0.1, "result": values["scenarios"][0] } });
        // Zeros in place of digests: every second file gets matching ones.
        let journal = format!("{:016x} {suite}\n{:016x} {finished}\n", 0, 0);
        let folder = folder.display().to_string();
        Ok(Self { recording: read("tiny.exact.parquet")?, results, journal, folder })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_program_must_not_do_is_found() {
        let of = |code, seconds, megabytes| offence(Measured { code, seconds, megabytes });
        assert_eq!(of(Some(2), 0.5, 100.0), None);
        assert_eq!(of(Some(0), 5.0, 900.0), None, "what is taken is no rejection");
        assert_eq!(of(None, 0.0, 1.0).unwrap(), "ended by a signal");
        assert_eq!(of(Some(101), 0.0, 1.0).unwrap(), "exit code 101");
        assert!(of(Some(2), 1.5, 1.0).unwrap().contains("1.50 s"));
        assert!(of(Some(3), 0.1, 300.0).unwrap().contains("300 MB"));
    }
}
