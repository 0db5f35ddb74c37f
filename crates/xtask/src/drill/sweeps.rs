//! `cargo xtask drill sweep`: rate of runs of 0.5 s in a sweep (1/s), and memory as their number grows.
use super::built;
use super::measured::{PATIENCE, measured};
use crate::failure::Failure;
use crate::workspace::Workspace;
use std::fs;
use std::time::Instant;

/// Runs of the sweeps; `SERVOBENCH_SWEEP` sets the number of the largest.
const RUNS: [u64; 2] = [1_000, 20_000];
/// Number of equal sweeps; the fastest counts.
const ROUNDS: usize = 3;
/// Memory that the largest sweep may take beyond the smallest (bytes for each run): its verdict, its place and its metrics.
const MOST_BYTES: f64 = 400.0;

/// The axis of the demo for half a second: a move of some 0.27 s, and rest.
fn scenario() -> String {
    let text = include_str!("../../../../scenarios/demo/jerk.toml");
    let (text, _) = text.split_once("[limits]").unwrap_or((text, ""));
    let lines = text.lines().map(|line| match line.split_once(" = ") {
        Some(("engine", _)) => "engine = [\"exact\"]".to_owned(),
        Some(("duration", _)) => "duration = \"0.5 s\"".to_owned(),
        Some(("move_to", _)) => "move_to = \"30 mm\"".to_owned(),
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn sweep(runs: u64) -> String {
    format!(
        "scenario = \"short.toml\"\nmetrics = [\"settling_time\", \"following_error_peak_load\"]\n[[vary]]\nkey = \"axis.load.mass\"\n\
         normal = {{ mean = \"12 kg\", tolerance = \"5 %\" }}\n[[vary]]\nkey = \"setpoint.jerk\"\n\
         uniform = {{ from = \"40 m/s3\", to = \"60 m/s3\" }}\n[draws]\ncount = {runs}\n"
    )
}

/// Runs the drill.
///
/// # Errors
/// [`Failure::Findings`] when a sweep does not end as expected, or its memory grows with its results.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    built(workspace)?;
    let largest = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|size| size.parse().ok());
    let sizes = RUNS.into_iter().filter(|runs| largest.is_none_or(|largest| *runs < largest)).chain(largest);
    let (mut findings, mut first) = (Vec::new(), None);
    println!("sweeps of runs of 0.5 s with two metrics, one at a time for each core\n");
    println!("{:>8} {:>10} {:>12} {:>10} {:>14}", "runs", "time", "runs/s", "memory", "memory a run");
    for runs in sizes {
        let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
        for (name, text) in [("short.toml", scenario()), ("short.sweep.toml", sweep(runs))] {
            let path = room.path().join(name);
            fs::write(&path, text).map_err(Failure::file("write", &path))?;
        }
        let (mut least, mut megabytes) = (f64::INFINITY, 0.0_f64);
        for _ in 0..if runs > 10_000 { 1 } else { ROUNDS } {
            let mut command = workspace.servobench(["sweep", "short.sweep.toml", "--quiet"]);
            command.current_dir(room.path()).env("LD_LIBRARY_PATH", workspace.native_lib());
            let start = Instant::now();
            let ended = measured(&mut command, 60 * PATIENCE);
            let ended =
                ended.map_err(|source| Failure::Start { program: workspace.binary().display().to_string(), source })?;
            least = least.min(start.elapsed().as_secs_f64());
            megabytes = megabytes.max(ended.megabytes);
            // Some draws miss the settling window at the end: those have failed.
            if !matches!(ended.code, Some(0 | 4)) {
                findings.push(format!("a sweep of {runs} runs ended with {:?}", ended.code));
            }
        }
        let (before, start) = *first.get_or_insert((runs, megabytes));
        let grown = (megabytes - start) * f64::from(1 << 20) / (runs - before).max(1) as f64;
        println!("{runs:>8} {least:>8.2} s {:>12.0} {megabytes:>7.1} MB {grown:>12.0} B", runs as f64 / least);
        if runs >= 20_000 && grown > MOST_BYTES {
            findings
                .push(format!("{runs} runs: each adds {grown:.0} B to memory, at most {MOST_BYTES} are its numbers"));
        }
    }
    if findings.is_empty() { Ok(()) } else { Err(Failure::Findings { findings }) }
}
