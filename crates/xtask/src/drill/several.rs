//! `cargo xtask drill several`: comparisons and sweeps of real runs, one of which is dead, unstable or over its limit; and one machine with
//! two seeds.
//!
//! The axis and the spoiled run are drawn from a seed. The bad run is known from the way it was spoiled; conclusions are read from the
//! printed text.
use super::built;
use crate::failure::Failure;
use crate::workspace::Workspace;
use servobench_testkit::Random;
use std::fs;
use std::path::Path;

/// Number of cases; `SERVOBENCH_SWEEP` overrides it.
const CASES: u64 = 60;

/// A bad conclusion of one case, if there is one.
type Finding = Option<String>;

/// Way in which a run is spoiled: the word for it, and the key with the value that does so.
type Spoiled = (&'static str, String);

/// Runs the drill.
///
/// # Errors
/// [`Failure::Findings`] names the seed of every case in which a bad run wins, lies on a front or is not named, or in which one of two
/// seeds wins.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    built(workspace)?;
    let cases = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|count| count.parse().ok()).unwrap_or(CASES);
    let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
    let (mut findings, mut counts) = (Vec::new(), [0_u32; 3]);
    for seed in 0..cases {
        let random = &mut Random::seeded(seed);
        let kind = usize::from(seed % 5 > 1) + usize::from(seed % 5 == 4);
        counts[kind] += 1;
        let found = match kind {
            0 => comparison(workspace, room.path(), random)?,
            1 => sweep(workspace, room.path(), random)?,
            _ => seeds(workspace, room.path(), random)?,
        };
        findings.extend(found.map(|found| format!("seed {seed}: {found}")));
    }
    let [comparisons, sweeps, seeds] = counts;
    println!(
        "{comparisons} comparisons, {sweeps} sweeps, {seeds} machines with two seeds: {} findings",
        findings.len()
    );
    if findings.is_empty() { Ok(()) } else { Err(Failure::Findings { findings }) }
}

/// A healthy axis: a slide with friction and an encoder, whose move ends well before its run.
fn axis(random: &mut Random, noise: f64) -> String {
    let mass = random.between(5.0, 40.0);
    let (friction, distance) = (random.between(5.0, 40.0), random.between(20.0, 120.0));
    let (velocity, position) = (random.between(40.0, 90.0), random.between(20.0, 50.0));
    let noise = if noise > 0.0 { format!(", noise = \"{noise} um\"") } else { String::new() };
    format!(
        "engine = [\"exact\"]\n[run]\nbase_rate = \"8 kHz\"\nduration = \"1.2 s\"\n[axis]\nmotion = \"linear\"\n\
         motor_side = {{ mass = \"{mass:.2} kg\", coulomb = \"{friction:.1} N\", viscous = \"20 N s/m\" }}\n[motor]\n\
         kind = \"ideal-source\"\nlimit = \"4 kN\"\nencoder = {{ step = \"0.1 um\"{noise} }}\n[drive]\n\
         velocity = {{ rate = \"8 kHz\", bandwidth = \"{velocity:.0} Hz\" }}\nposition = {{ rate = \"4 kHz\", gain = \"{position:.0} 1/s\" }}\n\
         [setpoint]\norder = 3\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\njerk = \"200 m/s3\"\n[[program]]\n\
         move_to = \"{distance:.1} mm\"\n[measure]\nwindow = \"20 um\"\n[limits]\nmove_time = \"0.9 s\"\n"
    )
}

/// A key whose value makes a run bad.
fn spoiled(random: &mut Random) -> Spoiled {
    match random.below(4) {
        0 => ("dead", format!("motor.limit={:.2} N", random.between(0.1, 3.0))),
        1 => ("out of its loop", format!("drive.position.gain={:.5} 1/s", random.between(1e-4, 1e-2))),
        2 => ("unstable", format!("drive.velocity.bandwidth={:.0} Hz", random.between(6e3, 3e4))),
        _ => ("over its limit", format!("setpoint.velocity={:.4} m/s", random.between(0.005, 0.015))),
    }
}

/// Healthy variants around a spoiled one.
fn comparison(workspace: &Workspace, room: &Path, random: &mut Random) -> Result<Finding, Failure> {
    let others = 1 + random.below(4);
    let place = random.below(others + 1);
    let (how, key) = spoiled(random);
    let variants: Vec<String> = (0..=others)
        .map(|k| {
            let jerk = random.between(50.0, 900.0);
            if k == place { format!("bad: {key}") } else { format!("good{k}: setpoint.jerk={jerk:.0} m/s3") }
        })
        .collect();
    let mut arguments = vec!["compare", "axis.toml", "--out", "out"];
    arguments.extend(variants.iter().flat_map(|one| ["--variant", one]));
    let text = axis(random, 0.0);
    let printed = printed(workspace, room, &[("axis.toml", &text)], &arguments)?;
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    let conclusion = words.split(" look at it").next().unwrap_or_default().rsplit(". ").next().unwrap_or_default();
    let is_praised = words.contains("bad wins") || (conclusion.contains("choice") && conclusion.contains("bad"));
    let is_named = printed.lines().any(|line| line.starts_with("bad is out: "));
    Ok((is_praised || !is_named).then(|| format!("{how} ({key}) wins or is not named:\n{printed}")))
}

/// A grid of a spoiled key and of a jerk.
fn sweep(workspace: &Workspace, room: &Path, random: &mut Random) -> Result<Finding, Failure> {
    let (mut how, mut key) = spoiled(random);
    while key.starts_with("motor.") {
        // A sweep does not choose a motor.
        (how, key) = spoiled(random);
    }
    let (key, value) = key.split_once('=').unwrap_or((&key, ""));
    let good = match key {
        "drive.position.gain" => "30 1/s",
        "drive.velocity.bandwidth" => "60 Hz",
        _ => "0.4 m/s",
    };
    let jerks = [random.between(50.0, 200.0), random.between(300.0, 900.0)].map(|jerk| format!("\"{jerk:.0} m/s3\""));
    let sweep = format!(
        "scenario = \"axis.toml\"\n[[vary]]\nkey = \"{key}\"\nvalues = [\"{value}\", \"{good}\"]\n[[vary]]\nkey = \"setpoint.jerk\"\n\
         values = [{}]\n",
        jerks.join(", ")
    );
    let text = axis(random, 0.0);
    let files = [("axis.toml", text.as_str()), ("axis.sweep.toml", sweep.as_str())];
    let printed = printed(workspace, room, &files, &["sweep", "axis.sweep.toml", "--out", "out"])?;
    let (table, front) = printed.split_once("o other combination").unwrap_or((&printed, ""));
    let short = key.rsplit('.').next().unwrap_or_default();
    let shown = |line: &str| line.contains(&format!("{short} {value}"));
    let is_on_front = front.is_empty() || front.lines().any(shown);
    let failed = table.matches("FAILED").count();
    Ok((is_on_front || failed < 2).then(|| format!("{how} ({key}={value}), {failed} failed:\n{printed}")))
}

/// One machine with noise, twice, with different seeds.
fn seeds(workspace: &Workspace, room: &Path, random: &mut Random) -> Result<Finding, Failure> {
    let noise = random.between(0.02, 2.0);
    let text = axis(random, noise);
    let count = ["1", "5"][usize::from(random.below(2) == 1)];
    let other = format!("b: motor.encoder.seed={}", 10 + random.below(1_000_000));
    let arguments = ["compare", "axis.toml", "--out", "out", "--seeds", count, "--variant", "a: ", "--variant", &other];
    let printed = printed(workspace, room, &[("axis.toml", &text)], &arguments)?;
    let has_winner = printed.contains(" wins: ") && !printed.contains(" is out: ");
    Ok(has_winner.then(|| format!("a seed wins over the other ({count} seeds):\n{printed}")))
}

/// Output of the program with these files in its folder.
fn printed(workspace: &Workspace, room: &Path, files: &[(&str, &str)], arguments: &[&str]) -> Result<String, Failure> {
    for (name, text) in files {
        let path = room.join(name);
        fs::write(&path, text).map_err(Failure::file("write", &path))?;
    }
    let mut command = workspace.servobench(arguments);
    command.current_dir(room).env("LD_LIBRARY_PATH", workspace.native_lib());
    let ended = command.output();
    let ended = ended.map_err(|source| Failure::Start { program: workspace.binary().display().to_string(), source })?;
    match ended.status.code() {
        Some(0 | 4) => Ok(String::from_utf8_lossy(&ended.stdout).into_owned()),
        code => Err(Failure::Findings {
            findings: vec![format!(
                "`servobench {}` ended with {code:?}: {}",
                arguments.join(" "),
                String::from_utf8_lossy(&ended.stderr)
            )],
        }),
    }
}
