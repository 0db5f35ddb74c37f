//! `cargo xtask drill many`: suites of more and more runs that are next to nothing by themselves, so that what is seen is what a run
//! costs beside its simulation.
use super::built;
use super::measured::{Measured, measured};
use crate::failure::Failure;
use crate::workspace::Workspace;
use std::fs;

/// Runs of the suites, unless `SERVOBENCH_SWEEP` says how many the largest has.
const RUNS: [u64; 4] = [1, 300, 2_000, 20_000];
/// Suites on an engine in a worker process have no more runs than that.
const MOST_IN_WORKERS: u64 = 2_000;
/// What a run may add to the memory of a suite (bytes): its names and digests, but not its result.
const MOST_BYTES: f64 = 1_500.0;

/// Ten ticks of a slide that nobody moves.
fn scenario(engine: &str) -> String {
    format!(
        "engine = [\"{engine}\"]\n[run]\nbase_rate = \"1 kHz\"\nduration = \"0.01 s\"\n[axis]\nmotion = \"linear\"\n\
         motor_side = {{ mass = \"20 kg\" }}\n[motor]\nkind = \"prescribed\"\n"
    )
}

/// Runs the drill.
///
/// # Errors
/// [`Failure::Findings`] when a suite does not end as it should, or its memory grows with its results.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let has_mujoco = built(workspace)?;
    let largest = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|size| size.parse().ok());
    let sizes = RUNS.into_iter().filter(|runs| largest.is_none_or(|largest| *runs < largest)).chain(largest);
    let mut findings = Vec::new();
    println!("time of processors; `beside` is without the program's start, for each run\n");
    println!("{:7} {:>8} {:>10} {:>12} {:>8} {:>10}", "engine", "runs", "time", "beside", "memory", "a run");
    for (engine, most) in [("exact", u64::MAX), ("mujoco", MOST_IN_WORKERS)] {
        if engine == "mujoco" && !has_mujoco {
            continue;
        }
        let mut first = None;
        for runs in sizes.clone().filter(|runs| *runs <= most) {
            let ended = suite(workspace, engine, runs)?;
            let Measured { code, seconds, megabytes } = ended;
            let start = *first.get_or_insert(ended);
            let more = (runs - 1).max(1) as f64;
            let each = (seconds - start.seconds) / more * 1e3;
            let grown = (megabytes - start.megabytes) * f64::from(1 << 20) / more;
            println!("{engine:7} {runs:>8} {seconds:>8.3} s {each:>9.3} ms {megabytes:>5.1} MB {grown:>8.0} B");
            if code != Some(0) {
                findings.push(format!("{runs} runs on {engine} ended with {code:?}"));
            }
            // Of a few runs the rest of the program is the larger part.
            if runs >= 20_000 && grown > MOST_BYTES {
                findings.push(format!(
                    "{runs} runs on {engine}: each adds {grown:.0} B to memory, at most {MOST_BYTES} are its names"
                ));
            }
        }
    }
    if findings.is_empty() { Ok(()) } else { Err(Failure::Findings { findings }) }
}

/// Runs a suite of as many scenarios.
fn suite(workspace: &Workspace, engine: &str, runs: u64) -> Result<Measured, Failure> {
    let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
    let folder = room.path().join("scenarios");
    fs::create_dir(&folder).map_err(Failure::file("make", &folder))?;
    let text = scenario(engine);
    for number in 0..runs {
        let path = folder.join(format!("{number}.toml"));
        fs::write(&path, &text).map_err(Failure::file("write", &path))?;
    }
    let mut command = workspace.servobench(["run", "scenarios", "--quiet", "--keep", "none", "--jobs", "1"]);
    command.current_dir(room.path()).env("LD_LIBRARY_PATH", workspace.native_lib());
    let ended = measured(&mut command);
    ended.map_err(|source| Failure::Start { program: workspace.binary().display().to_string(), source })
}
