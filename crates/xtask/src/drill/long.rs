//! `cargo xtask drill long`: long runs and their memory.
use super::built;
use super::measured::measured;
use crate::failure::Failure;
use crate::workspace::Workspace;
use std::fmt::Write as _;
use std::fs;
use std::time::Duration;

/// Wall-clock time after which a long run counts as hung.
const PATIENCE: Duration = Duration::from_mins(10);
/// Channels that are recorded.
const CHANNELS: [&str; 26] = [
    "setpoint.position",
    "setpoint.velocity",
    "setpoint.acceleration",
    "setpoint.jerk",
    "motor.position",
    "motor.velocity",
    "table.position",
    "table.velocity",
    "load.position",
    "load.velocity",
    "reference.position",
    "velocity.reference",
    "following_error.motor",
    "following_error.load",
    "effort.reference",
    "effort.motor",
    "current.d",
    "current.q",
    "current.q_reference",
    "voltage.d",
    "voltage.q",
    "voltage.magnitude",
    "power.electrical",
    "power.copper",
    "power.shaft",
    "saturation.voltage",
];

/// A run of the demo's axis at 16 kHz, back and forth.
struct Long {
    name: &'static str,
    /// Duration (s).
    duration: u32,
    /// Moves, each with a rest (s) behind it.
    moves: u32,
    rest: u32,
    /// Rate of recorded rows (Hz).
    rate: u32,
    /// Memory that it may take (MB).
    megabytes: f64,
}

const RUNS: [Long; 4] = [
    Long { name: "ten minutes of moves", duration: 600, moves: 300, rest: 1, rate: 16_000, megabytes: 300.0 },
    Long { name: "ten minutes, most at rest", duration: 600, moves: 2, rest: 1, rate: 16_000, megabytes: 300.0 },
    Long { name: "1e8 ticks, kept at 100 Hz", duration: 6_250, moves: 100, rest: 61, rate: 100, megabytes: 200.0 },
    Long { name: "1e8 ticks, kept at 1 kHz", duration: 6_250, moves: 100, rest: 61, rate: 1_000, megabytes: 200.0 },
];

impl Long {
    fn scenario(&self) -> String {
        let demo = include_str!("../../../../scenarios/demo/jerk.toml");
        let (axis, _) = demo.split_once("[[program]]").unwrap_or((demo, ""));
        let lines = axis.lines().map(|line| match line.split_once(" = ") {
            Some(("engine", _)) => "engine = [\"exact\"]".to_owned(),
            Some(("duration", _)) => format!("duration = \"{} s\"", self.duration),
            _ => line.to_owned(),
        });
        let mut text = lines.collect::<Vec<_>>().join("\n");
        for number in 0..self.moves {
            let to = if number % 2 == 0 { 250 } else { 0 };
            let steps = write!(text, "\n[[program]]\nmove_to = \"{to} mm\"\n[[program]]\nwait = \"{} s\"\n", self.rest);
            steps.unwrap_or_default();
        }
        text + &format!("[record]\nrate = \"{} Hz\"\nchannels = {CHANNELS:?}\n", self.rate)
    }
}

/// Runs the drill.
///
/// # Errors
/// [`Failure::Findings`] when a run does not end as expected, or exceeds its memory.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    built(workspace)?;
    let mut findings = Vec::new();
    println!("the demo's axis on exact with {} channels, metrics and recording\n", CHANNELS.len());
    println!("{:26} {:>12} {:>10} {:>10} {:>10}", "run", "values", "time", "memory", "at most");
    for long in RUNS {
        let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
        let path = room.path().join("long.toml");
        fs::write(&path, long.scenario()).map_err(Failure::file("write", &path))?;
        let mut command = workspace.servobench(["run", "long.toml", "--quiet"]);
        command.current_dir(room.path()).env("LD_LIBRARY_PATH", workspace.native_lib());
        let ended = measured(&mut command, PATIENCE)
            .map_err(|source| Failure::Start { program: workspace.binary().display().to_string(), source })?;
        let values = u64::from(long.duration) * u64::from(long.rate) * CHANNELS.len() as u64;
        let (name, seconds, megabytes) = (long.name, ended.seconds, ended.megabytes);
        println!("{name:26} {values:>12} {seconds:>8.1} s {megabytes:>7.0} MB {:>7.0} MB", long.megabytes);
        if ended.code != Some(0) {
            findings.push(format!("{name}: it ended with {:?}", ended.code));
        }
        if megabytes > long.megabytes {
            findings.push(format!("{name}: {megabytes:.0} MB, at most {:.0}", long.megabytes));
        }
    }
    if findings.is_empty() { Ok(()) } else { Err(Failure::Findings { findings }) }
}
