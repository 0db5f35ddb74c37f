//! Where the time of a whole run goes: reading the scenario, building the loop, the ticks, their recording, metrics and verdict, the
//! recording on disk; and how many short runs there are per second.
//!
//! `cargo xtask bench [--json]`. The run: the axis of the demo for 1.5 s at 16 kHz, on one core. Rounds of all engines alternate; the
//! median of each part counts.
use servobench::Engines;
use servobench_metrics::{Name, measure};
use servobench_plant::{Engine, EngineName, Exact};
use servobench_scenario::{Scenario, parse};
use servobench_sim::Bench;
use servobench_suite::{Job, Source, Workers, execute, jobs};
use servobench_trace::Recording;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

const ROUNDS: usize = 21;
const DEMO: &str = include_str!("../scenarios/demo/jerk.toml");
const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

/// Metrics that need no mode.
const FEW: [Name; 2] = [Name::SettlingTime, Name::FollowingErrorPeakLoad];

/// What a run consists of, in its order.
const PARTS: [&str; 6] = ["read", "build", "ticks", "record", "measure", "write"];
/// The part that a run without a recording leaves out.
const WRITE: usize = 5;

/// The demo, as long as it is measured here.
fn demo() -> String {
    let text = DEMO.replace("duration = \"4 s\"", "duration = \"1.5 s\"");
    let (axis, _) = text.split_once("[limits]").unwrap_or_else(|| panic!("the demo has limits"));
    axis.to_owned()
}

/// A move of some 0.27 s, and rest.
fn short() -> String {
    let text = demo().replace("duration = \"1.5 s\"", "duration = \"0.5 s\"");
    text.replace("move_to = \"250 mm\"", "move_to = \"30 mm\"")
}

fn job_of(text: &str) -> Job {
    let scenario = scenario_of(text);
    jobs(vec![Source { scenario, text: text.to_owned() }], &[EngineName::Exact]).remove(0)
}

fn scenario_of(text: &str) -> Scenario {
    parse("demo.toml", text, None).unwrap_or_else(|error| panic!("{error}")).scenario
}

fn timed<T>(what: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let done = what();
    (done, start.elapsed().as_secs_f64())
}

fn ticks_of(scenario: &Scenario, engine: &dyn Engine) -> (f64, f64, Recording) {
    let (bench, build) = timed(|| Bench::new(scenario, engine).unwrap_or_else(|error| panic!("{error}")));
    let (outcome, run) = timed(|| bench.run(&mut |_| {}));
    assert_eq!(outcome.failure, None);
    (build, run, outcome.recording)
}

/// Seconds of each part of one run.
fn parts(text: &str, engine: &dyn Engine, folder: &Path) -> [f64; PARTS.len()] {
    let (scenario, read) = timed(|| scenario_of(text));
    let (build, recorded, recording) = ticks_of(&scenario, engine);
    let mut bare = scenario.clone();
    bare.record.channels = vec!["load.position".parse().unwrap_or_else(|error| panic!("{error}"))];
    // Some signals are recorded for the requirements in any case.
    let (_, ticks, _) = ticks_of(&bare, engine);
    let (metrics, measured) = timed(|| measure(&recording, &scenario.measure));
    black_box(metrics);
    // As a suite does it: a file that is there already would first have to reach the disk.
    let path = folder.join("run.parquet");
    let (written, write) = timed(|| recording.write_parquet(&path));
    written.unwrap_or_else(|error| panic!("{error}"));
    std::fs::remove_file(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    [read, build, ticks, (recorded - ticks).max(0.0), measured, write]
}

/// Seconds of a whole run without a recording, as a suite makes it.
fn whole(job: &Job) -> f64 {
    let (run, time) = timed(|| execute(job, &ENGINES, &Workers::none(), &mut |_| {}));
    black_box(run.unwrap_or_else(|broken| panic!("{}", broken.error)));
    time
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let json = std::env::args().any(|argument| argument == "--json");
    let folder = std::env::temp_dir().join(format!("servobench-run-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let (text, engines) = (demo(), servobench_tests::engines());
    let mut short = job_of(&short());
    short.leave_recording_out();
    let mut few = short.clone();
    few.measure_only(&FEW);
    let mut rounds: Vec<Vec<[f64; PARTS.len()]>> = vec![Vec::new(); engines.len()];
    let (mut shorts, mut with_few) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        for (engine, rounds) in engines.iter().zip(&mut rounds) {
            rounds.push(parts(&text, *engine, &folder));
        }
        for _ in 0..10 {
            shorts.push(whole(&short));
            with_few.push(whole(&few));
        }
    }
    std::fs::remove_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let medians: Vec<[f64; PARTS.len()]> = rounds
        .iter()
        .map(|rounds| std::array::from_fn(|part| median(rounds.iter().map(|round| round[part]).collect())))
        .collect();
    let length = scenario_of(&text).duration.map_or(f64::NAN, |length| length);
    let per_second = [shorts, with_few].map(|times| 1.0 / median(times));
    if json {
        print_json(&engines, &medians, length, per_second);
    } else {
        print_table(&engines, &medians, length, per_second);
    }
}

fn print_table(engines: &[&dyn Engine], medians: &[[f64; PARTS.len()]], length: f64, per_second: [f64; 2]) {
    println!("a run of {length} s on one core (ms), and simulated seconds per second with and without its recording");
    let titles = PARTS.map(|part| format!("{part:>8}")).concat();
    println!("{:8}{titles}{:>9}{:>9}", "engine", "with", "without");
    for (engine, parts) in engines.iter().zip(medians) {
        let columns = parts.map(|part| format!("{:>8.2}", part * 1e3)).concat();
        let all: f64 = parts.iter().sum();
        let (with, without) = (length / all, length / (all - parts[WRITE]));
        println!("{:8}{columns}{with:>9.0}{without:>9.0}", engine.name().to_string());
    }
    let [all, few] = per_second;
    println!("runs of 0.5 s with a move on exact, without a recording, per second of one core:");
    println!("{all:.0} with all metrics, {few:.0} with {} and {} only", FEW[0], FEW[1]);
}

fn print_json(engines: &[&dyn Engine], medians: &[[f64; PARTS.len()]], length: f64, [all, few]: [f64; 2]) {
    let engines: Vec<String> = engines
        .iter()
        .zip(medians)
        .map(|(engine, parts)| {
            let parts: Vec<String> =
                PARTS.iter().zip(parts).map(|(part, time)| format!("\"{part}_ms\":{:.3}", time * 1e3)).collect();
            format!("{{\"engine\":\"{}\",{}}}", engine.name(), parts.join(","))
        })
        .collect();
    let shorts = format!("\"short_runs_per_second\":{all:.0},\"with_few_metrics\":{few:.0}");
    println!("{{\"run_s\":{length},{shorts},\"parts\":[{}]}}", engines.join(","));
}
