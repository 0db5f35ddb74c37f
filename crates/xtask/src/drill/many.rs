//! `cargo xtask drill many`: suites of more and more tiny runs, which show the cost of a run beside its simulation.
use super::built;
use super::measured::{Measured, PATIENCE, measured};
use crate::failure::Failure;
use crate::workspace::Workspace;
use std::fs;

/// Runs of the suites; `SERVOBENCH_SWEEP` sets the number of the largest.
const RUNS: [u64; 3] = [300, 2_000, 20_000];
/// Most runs of a suite on an engine in a worker process.
const MOST_IN_WORKERS: u64 = 2_000;
/// Most memory that a run may add to a suite (bytes): its names and digests, but not its result.
const MOST_BYTES: f64 = 1_500.0;

/// Ten ticks of a slide at rest.
fn scenario(engine: &str) -> String {
    format!(
        "engine = [\"{engine}\"]\n[run]\nbase_rate = \"1 kHz\"\nduration = \"0.01 s\"\n[axis]\nmotion = \"linear\"\n\
         motor_side = {{ mass = \"20 kg\" }}\n[motor]\nkind = \"prescribed\"\n"
    )
}

/// The axis of the demo on one engine for [`LENGTH`].
fn demo() -> String {
    let text = include_str!("../../../../scenarios/demo/jerk.toml");
    let lines = text.lines().map(|line| match line.split_once(" = ") {
        Some(("engine", _)) => "engine = [\"exact\"]".to_owned(),
        Some(("duration", _)) => format!("duration = \"{LENGTH} s\""),
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Runs of the demo's axis, and the duration of each (s).
const DEMOS: u64 = 200;
const LENGTH: f64 = 1.5;
/// Number of such suites; the fastest counts.
const ROUNDS: usize = 5;

/// Runs the drill.
///
/// # Errors
/// [`Failure::Findings`] when a suite does not end as expected, or its memory grows with its results.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let has_mujoco = built(workspace)?;
    let largest = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|size| size.parse().ok());
    let sizes = RUNS.into_iter().filter(|runs| largest.is_none_or(|largest| *runs < largest)).chain(largest);
    let mut findings = Vec::new();
    println!(
        "time is that of processors; what a run adds is told without the first one, in which the program starts\n"
    );
    println!(
        "{:7} {:>8} {:>10} {:>10} {:>13} {:>12}",
        "engine", "runs", "time", "memory", "time a run", "memory a run"
    );
    for (engine, most) in [("exact", u64::MAX), ("mujoco", MOST_IN_WORKERS)] {
        if engine == "mujoco" && !has_mujoco {
            continue;
        }
        let text = scenario(engine);
        let start = suite(workspace, (&text, 1), "none", &mut findings)?;
        println!("{engine:7} {:>8} {:>8.3} s {:>7.1} MB", 1, start.seconds, start.megabytes);
        for runs in sizes.clone().filter(|runs| (2..=most).contains(runs)) {
            let Measured { seconds, megabytes, .. } = suite(workspace, (&text, runs), "none", &mut findings)?;
            let more = (runs - 1) as f64;
            let each = (seconds - start.seconds) / more * 1e3;
            let grown = (megabytes - start.megabytes) * f64::from(1 << 20) / more;
            println!("{engine:7} {runs:>8} {seconds:>8.3} s {megabytes:>7.1} MB {each:>10.3} ms {grown:>10.0} B");
            // With few runs the memory of the rest of the program dominates.
            if runs >= 20_000 && grown > MOST_BYTES {
                findings.push(format!(
                    "{runs} runs on {engine}: each adds {grown:.0} B to memory, at most {MOST_BYTES} are its names"
                ));
            }
        }
    }
    println!(
        "\n{DEMOS} runs of {LENGTH} s of the demo's axis on exact, in simulated seconds per second of one processor:"
    );
    for (keep, what) in [("all", "with recordings"), ("none", "without")] {
        // Other load on the machine only adds to the time.
        let mut least = f64::INFINITY;
        for _ in 0..ROUNDS {
            least = least.min(suite(workspace, (&demo(), DEMOS), keep, &mut findings)?.seconds);
        }
        println!("{what:16} {:>4.0}", DEMOS as f64 * LENGTH / least);
    }
    if findings.is_empty() { Ok(()) } else { Err(Failure::Findings { findings }) }
}

/// Runs a suite of `runs` scenarios with this text; one that does not end well is a finding.
fn suite(
    workspace: &Workspace,
    (text, runs): (&str, u64),
    keep: &str,
    findings: &mut Vec<String>,
) -> Result<Measured, Failure> {
    let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
    let folder = room.path().join("scenarios");
    fs::create_dir(&folder).map_err(Failure::file("make", &folder))?;
    for number in 0..runs {
        let path = folder.join(format!("{number}.toml"));
        fs::write(&path, text).map_err(Failure::file("write", &path))?;
    }
    let mut command = workspace.servobench(["run", "scenarios", "--quiet", "--jobs", "1", "--keep", keep]);
    command.current_dir(room.path()).env("LD_LIBRARY_PATH", workspace.native_lib());
    let ended = measured(&mut command, PATIENCE);
    let ended = ended.map_err(|source| Failure::Start { program: workspace.binary().display().to_string(), source })?;
    if ended.code != Some(0) {
        findings.push(format!("a suite of {runs} runs ended with {:?}", ended.code));
    }
    Ok(ended)
}
