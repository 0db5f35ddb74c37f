//! A longer run is never greener: an oscillation or growth in a run is in every longer one, and so is its verdict.
//!
//! The sweep is small in ordinary runs: `SERVOBENCH_SWEEP=500 cargo test --release -p servobench-suite --test longer` runs five hundred
//! scenarios, and prints how many were red.
use servobench::Engines;
use servobench_metrics::{Requirement, Standing};
use servobench_plant::{EngineName, Exact};
use servobench_suite::{Source, Workers, execute, jobs};
use servobench_testkit::Random;

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };
/// The last is forty times as long as the first.
const LENGTHS: usize = 10;

/// An axis whose loop is unstable, or cycles, with how long its program takes and ten periods of the swing are (s).
struct Unstable {
    text: String,
    program: f64,
    ten_periods: f64,
}

/// A position loop in the master above its bound, between limits of force, of its velocity or of the speed of the drive.
fn master(random: &mut Random) -> Unstable {
    let delay = random.index(3);
    // A frame there and one back, and the drive's cycle, 1 ms each; as much again for each cycle of delay either way.
    let age = 3e-3 + 2e-3 * delay as f64;
    let gain = random.logarithmic(1.1, 3.0) * core::f64::consts::FRAC_PI_2 / age;
    let mass = random.logarithmic(2.0, 50.0);
    let force = mass * random.logarithmic(20.0, 2e4);
    let bandwidth = random.logarithmic(60.0, 500.0);
    let max_speed = if random.once_in(3) { "max_speed = \"0.7 m/s\"" } else { "" };
    let text = format!(
        r#"
[axis]
motion = "linear"
motor_side = {{ mass = "{mass} kg" }}
[motor]
kind = "ideal-source"
limit = "{force} N"
encoder = {{ step = "0.05 um" }}
[drive.velocity]
rate = "8 kHz"
bandwidth = "{bandwidth} Hz"
{max_speed}
[drive.position]
rate = "8 kHz"
bandwidth = "8 Hz"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "4 m/s2"
jerk = "100 m/s3"
[bus]
cycle = "1 ms"
delay = {delay}
mode = "csv"
position_gain = "{gain} 1/s"
units = {{ drive = 1, axis = "0.1 um" }}
[[program]]
move_to = "{} mm"
"#,
        random.between(20.0, 200.0)
    );
    Unstable { text, program: 1.0, ten_periods: 40.0 * age }
}

/// A velocity loop that is too fast for its rate, on an axis that stands.
fn velocity_loop(random: &mut Random) -> Unstable {
    let rate = random.one_of(&[1000.0, 2000.0, 4000.0]);
    let gain = random.logarithmic(1.02, 4.0);
    // A difference of positions is half a period old, and a velocity held for one is: beyond 2·rate/3 it swings at half the rate.
    let bandwidth = gain * rate / core::f64::consts::TAU * 4.0 / 3.0;
    let text = format!(
        r#"
[axis]
motion = "linear"
motor_side = {{ mass = "10 kg" }}
load = {{ mass = "{} kg", frequency = "{} Hz", damping_ratio = 0.02 }}
[motor]
kind = "ideal-source"
limit = "{} N"
[drive.velocity]
kind = "p"
rate = "{rate} Hz"
bandwidth = "{bandwidth} Hz"
[drive.position]
rate = "{rate} Hz"
gain = "5 1/s"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "4 m/s2"
jerk = "100 m/s3"
[[program]]
move_to = "5 mm"
"#,
        random.logarithmic(0.5, 20.0),
        random.logarithmic(10.0, 200.0),
        random.decades(2.0, 8.0)
    );
    Unstable { text, program: 0.2, ten_periods: 20.0 / rate }
}

/// A position loop that is faster than the velocity loop below it.
fn position_loop(random: &mut Random) -> Unstable {
    let bandwidth = random.logarithmic(5.0, 40.0);
    let gain = random.logarithmic(1.1, 4.0) * core::f64::consts::TAU * bandwidth;
    let text = format!(
        r#"
[axis]
motion = "linear"
motor_side = {{ mass = "10 kg" }}
[motor]
kind = "ideal-source"
limit = "{} N"
encoder = {{ step = "{} um" }}
[drive.velocity]
rate = "8 kHz"
bandwidth = "{bandwidth} Hz"
integral_time = "{} s"
[drive.position]
rate = "4 kHz"
gain = "{gain} 1/s"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "4 m/s2"
jerk = "100 m/s3"
[[program]]
wait = "0.1 s"
[[program]]
move_to = "20 mm"
"#,
        random.decades(2.0, 6.0),
        random.decades(-2.0, 1.0),
        0.5 / (core::f64::consts::TAU * bandwidth)
    );
    Unstable { text, program: 0.4, ten_periods: 10.0 / bandwidth }
}

/// True where the run of `text` for `duration` (s) is red by swings or growth; a linear loop that is known to be unstable does not count.
fn swings(text: &str, duration: f64) -> bool {
    let text = format!("[run]\nbase_rate = \"8 kHz\"\nduration = \"{duration} s\"\n{text}");
    let loaded =
        servobench_scenario::parse("longer.toml", &text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let job = jobs(vec![Source { scenario: loaded.scenario, text }], &[EngineName::Exact]).remove(0);
    let run =
        execute(&job, &ENGINES, &Workers::none(), &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error));
    let of = |name: Requirement| {
        run.verdict.requirements.iter().filter(move |(of, result)| *of == name && result.standing == Standing::Broken)
    };
    let has_diverged = of(Requirement::Bounded).count() > 0;
    let reasons = of(Requirement::Stable).flat_map(|(_, result)| &result.reasons);
    has_diverged || reasons.filter(|reason| !reason.starts_with("the loop is unstable")).count() > 0
}

#[test]
fn after_the_first_red_every_longer_run_is_red() {
    let count: u64 = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|count| count.parse().ok()).unwrap_or(9);
    let (mut red, mut at_once, mut wrong) = (0, 0, Vec::new());
    for seed in 0..count {
        let mut random = Random::seeded(seed);
        let kinds = [master, velocity_loop, position_loop];
        let Unstable { text, program, ten_periods } = kinds[usize::try_from(seed % 3).unwrap()](&mut random);
        let lengths = (0..LENGTHS).map(|k| program + ten_periods * 1.5_f64.powi(i32::try_from(k).unwrap()));
        let found: Vec<bool> = lengths.map(|length| swings(&text, length)).collect();
        red += usize::from(found.contains(&true));
        at_once += usize::from(found[0]);
        if !found.is_sorted() {
            wrong.push(format!("seed {seed}: {found:?}"));
        }
    }
    println!("{count} scenarios at {LENGTHS} lengths: {red} red, {at_once} of them at the first");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(10 * red >= 8 * usize::try_from(count).unwrap(), "{red} of {count} are red");
}
