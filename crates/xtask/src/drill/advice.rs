//! `cargo xtask drill advise`: an advice against a grid of set-points, each of which is run, and against new machines.
use super::built;
use crate::failure::Failure;
use crate::workspace::Workspace;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Tolerances of the machines.
const BOX: [(&str, &str, [&str; 2]); 2] =
    [("axis.load.frequency", "Hz", ["15.75", "19.25"]), ("axis.load.damping_ratio", "", ["0.002", "0.008"])];
/// Largest ratio of a grid set-point's time to the advised one that counts as better.
const BETTER: f64 = 0.995;
/// Number of new draws.
const FRESH: u32 = 1_000;

/// Runs the drill: 20 480 set-points of third and fourth order, or `SERVOBENCH_SWEEP` times fewer levels of each limit.
///
/// # Errors
/// [`Failure::Findings`] when the grid holds a better set-point, or new draws do not keep the promise.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    built(workspace)?;
    let room = tempfile::tempdir().map_err(Failure::file("make a folder in", std::env::temp_dir()))?;
    let scenario = workspace.root.join("scenarios/flexible-axis.toml");
    let out = room.path().join("advice.json");
    let within = BOX.map(|(key, unit, [low, high])| format!("{key}={low} {unit}..{high} {unit}"));
    let scenario_text = scenario.display().to_string();
    let out_text = out.display().to_string();
    let mut arguments = vec!["advise", &scenario_text, "--order", "3,4", "--shaper", "none", "-o", &out_text];
    arguments.extend(within.iter().flat_map(|one| ["--within", one]));
    servobench(workspace, &arguments, room.path())?;
    let advice = json(&out)?;
    let number = |key: &str| advice[key].as_f64().unwrap_or(f64::NAN);
    let (time, share) = (number("time"), advice["verified"]["share_at_least"].as_f64().unwrap_or(f64::NAN));
    println!("\nadvice: {:.1} ms, at least {:.1} % of the machines\n", 1e3 * time, 100.0 * share);
    let mut findings = Vec::new();

    // A better set-point must also succeed on the machine that limits the advice most.
    let worst = &advice["usage"].as_array().and_then(|all| {
        all.iter().max_by(|one, other| {
            let used = |one: &Value| one["used"].as_f64().unwrap_or(0.0);
            used(one).total_cmp(&used(other))
        })
    });
    let killer = worst.map(|worst| worst["machine"].clone()).unwrap_or_default();
    let level = |top: f64, ratio: f64, count: i32| (0..count).map(move |k| top * ratio.powi(-k)).collect::<Vec<f64>>();
    // Every n-th level of each.
    let every = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|every| every.parse::<i32>().ok()).unwrap_or(1).max(1);
    let count = |of: i32| (of / every).max(1);
    let axes = [
        ("velocity", "m/s", level(0.5, 1.05, count(4))),
        ("acceleration", "m/s2", level(4.0, 1.06, count(8))),
        ("jerk", "m/s3", level(400.0, 1.16, count(20))),
        ("snap", "m/s4", level(4e5, 1.35, count(32))),
    ];
    let vary = axes.iter().map(|(key, unit, values)| {
        let values: Vec<String> = values.iter().map(|value| format!("\"{value} {unit}\"")).collect();
        format!("[[vary]]\nkey = \"setpoint.{key}\"\nvalues = [{}]\n", values.join(", "))
    });
    let head = "metrics = [\"move_and_settling_time\"]\n";
    let grid = format!("scenario = \"flexible-axis.toml\"\n{head}{}", vary.collect::<String>());
    let set = killer.as_object().into_iter().flatten().map(|(key, value)| {
        let unit = BOX.iter().find(|(own, ..)| own == key).map_or("", |(_, unit, _)| unit);
        format!("{key}={value} {unit}")
    });
    let mode = killer["axis.load.frequency"].as_f64().map(|frequency| format!("measure.mode={frequency} Hz"));
    let set: Vec<String> = set.chain(mode).collect();
    let survivors = survivors(workspace, room.path(), &scenario, &grid, &set, BETTER * time)?;
    println!(
        "{} set-points of the grid are faster than {:.1} ms on that machine alone",
        survivors.len(),
        1e3 * BETTER * time
    );
    if !survivors.is_empty() {
        let column = |k: usize, unit: &str| {
            survivors.iter().map(|row| format!("\"{} {unit}\"", row[k])).collect::<Vec<_>>().join(", ")
        };
        let mut zip = format!("scenario = \"flexible-axis.toml\"\narrangement = \"zip\"\n{head}");
        for (k, (key, unit, _)) in axes.iter().enumerate() {
            zip.extend(["[[vary]]\nkey = \"setpoint.", key, "\"\nvalues = [", &column(k, unit), "]\n"]);
        }
        let mut left: Vec<bool> = vec![true; survivors.len()];
        for frequency in 0..=28 {
            for damping in BOX[1].2 {
                let low: f64 = BOX[0].2[0].parse().unwrap_or(0.0);
                let frequency = format!("{}", low + 0.125 * f64::from(frequency));
                let set = [
                    format!("axis.load.frequency={frequency} Hz"),
                    format!("axis.load.damping_ratio={damping}"),
                    format!("measure.mode={frequency} Hz"),
                ];
                let good = good(workspace, room.path(), &scenario, &zip, &set)?;
                left.iter_mut().zip(good).for_each(|(left, good)| *left &= good.is_some_and(|t| t < BETTER * time));
            }
        }
        let better = left.iter().filter(|left| **left).count();
        println!("{better} of them keep all limits on all machines of the box");
        for (row, _) in survivors.iter().zip(&left).filter(|(_, left)| **left) {
            let limits = axes.iter().zip(row).map(|((key, unit, _), value)| format!("{key} {value} {unit}"));
            println!("  {}", limits.collect::<Vec<_>>().join(", "));
        }
        if better > 0 {
            findings.push(format!("{better} set-points of the grid are better by more than 0.5 %"));
        }
    }

    let drawn = BOX.map(|(key, unit, [low, high])| {
        let also = if key.ends_with("frequency") { "also = \"measure.mode\"\n" } else { "" };
        format!("[[vary]]\nkey = \"{key}\"\n{also}uniform = {{ from = \"{low} {unit}\", to = \"{high} {unit}\" }}\n")
    });
    let fresh = format!(
        "scenario = \"flexible-axis.toml\"\n{head}{}[draws]\ncount = {FRESH}\nseed = 20261126\nmethod = \"random\"\n",
        drawn.concat()
    );
    let settings = advice["settings"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let settings: Vec<String> = settings.map(str::to_owned).collect();
    let kept = good(workspace, room.path(), &scenario, &fresh, &settings)?.iter().flatten().count();
    println!("{kept} of {FRESH} fresh draws keep all limits; {:.1} % were promised", 100.0 * share);
    if (kept as f64) < share * f64::from(FRESH) {
        findings.push(format!("{kept} of {FRESH} fresh draws keep all limits, {:.2} % were promised", 100.0 * share));
    }
    if findings.is_empty() { Ok(()) } else { Err(Failure::Findings { findings }) }
}

/// Set-points of `grid` that are good and faster than `most` (s) with these settings.
fn survivors(
    workspace: &Workspace,
    room: &Path,
    scenario: &Path,
    grid: &str,
    set: &[String],
    most: f64,
) -> Result<Vec<[String; 4]>, Failure> {
    let rows = rows(workspace, room, scenario, grid, set)?;
    println!("{} set-points of the grid were run", rows.len());
    let fast = rows.into_iter().filter(|row| row.verdict == "passed" && row.time.is_some_and(|time| time < most));
    Ok(fast.map(|row| row.point).collect())
}

/// The time of each row that is good (s).
fn good(
    workspace: &Workspace,
    room: &Path,
    scenario: &Path,
    sweep: &str,
    set: &[String],
) -> Result<Vec<Option<f64>>, Failure> {
    let rows = rows(workspace, room, scenario, sweep, set)?.into_iter();
    Ok(rows.map(|row| row.time.filter(|_| row.verdict == "passed")).collect())
}

struct Row {
    point: [String; 4],
    verdict: String,
    time: Option<f64>,
}

/// The rows of a sweep.
fn rows(workspace: &Workspace, room: &Path, scenario: &Path, sweep: &str, set: &[String]) -> Result<Vec<Row>, Failure> {
    let (file, own, out) = (room.join("drill.sweep.toml"), room.join("flexible-axis.toml"), room.join("out"));
    fs::write(&file, sweep).map_err(Failure::file("write", &file))?;
    fs::copy(scenario, &own).map_err(Failure::file("copy", &own))?;
    let mut arguments = vec!["sweep", "drill.sweep.toml", "--quiet", "--out", "out"];
    arguments.extend(set.iter().flat_map(|one| ["--set", one]));
    servobench(workspace, &arguments, room)?;
    let table = out.join("sweep.csv");
    let text = fs::read_to_string(&table).map_err(Failure::file("read", &table))?;
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let heading = lines.next().unwrap_or_default();
    let place = |name: &str| heading.iter().position(|one| one.starts_with(name));
    let (verdict, time) = (place("verdict"), place("move_and_settling_time"));
    let keys = ["velocity", "acceleration", "jerk", "snap"].map(|key| place(&format!("setpoint.{key}")));
    let cell = |line: &[&str], place: Option<usize>| place.and_then(|k| line.get(k)).map_or("", |cell| cell).to_owned();
    let row = |line: Vec<&str>| Row {
        point: keys.map(|key| cell(&line, key)),
        verdict: cell(&line, verdict),
        time: cell(&line, time).parse().ok(),
    };
    Ok(lines.map(row).collect())
}

/// Runs the program; failed runs are not a failure of the drill.
fn servobench(workspace: &Workspace, arguments: &[&str], folder: &Path) -> Result<(), Failure> {
    let mut command = workspace.servobench(arguments.iter().copied());
    command.current_dir(folder).env("LD_LIBRARY_PATH", workspace.native_lib());
    let ended = command.status();
    let ended = ended.map_err(|source| Failure::Start { program: workspace.binary().display().to_string(), source })?;
    match ended.code() {
        Some(0 | 4) => Ok(()),
        code => Err(Failure::Findings {
            findings: vec![format!("`servobench {}` ended with {code:?}", arguments.join(" "))],
        }),
    }
}

fn json(path: &Path) -> Result<Value, Failure> {
    let text = fs::read_to_string(path).map_err(Failure::file("read", path))?;
    serde_json::from_str(&text).map_err(|error| Failure::File {
        what: "read",
        path: path.to_owned(),
        source: error.into(),
    })
}
