//! What each effect of real hardware costs per tick of the whole closed loop, and how many seconds of it are simulated in one.
//!
//! `cargo xtask bench [--json]`. The axis of `scenarios/feed-axis-move.toml` for a second at 16 kHz on `exact`, one recorded channel, one
//! core. Rounds of all rows alternate, so that a busy machine slows all of them; the least of each counts. Ratios are to the ideal axis.
use servobench_plant::Exact;
use servobench_scenario::{Document, Override, Scenario};
use servobench_sim::Bench;
use std::time::Instant;

const ROUNDS: usize = 15;
const AXIS: &str = include_str!("../scenarios/feed-axis-move.toml");

/// A row: its name, and the keys that switch its effect on.
type Row = (&'static str, &'static [&'static str]);

const COGGING: &str = "motor.cogging=[{ per_rev = 36, amplitude = \"25 mNm\" }]";
const IRON: &str = "motor.iron_loss={ speed = \"3000 rpm\", hysteresis = \"6 W\", eddy = \"10 W\" }";
const HARMONICS: &str = "motor.flux_harmonic=[{ order = 6, d = 0.01, q = -0.02 }]";
const PHASES: &str = "motor.phase_resistance=[1, 1, 1.1]";
const THERMAL: &str = "motor.thermal={ ambient = \"30 degC\", to_housing = \"0.6 K/W\", to_ambient = \"1.1 K/W\", winding_capacity = \"60 J/K\", housing_capacity = \"900 J/K\" }";
const SATURATION: &str = "motor.saturation={ current = \"18.8 Apk\", share = 0.891 }";
const DEAD_TIME: &str = "drive.inverter.dead_time=2 us";
const CARRIER: &str = "drive.inverter.carrier=16 kHz";
const DROPS: [&str; 2] = ["drive.inverter.device_drop=1 V", "drive.inverter.on_resistance=30 mOhm"];
const SWITCHING: &str = "drive.inverter.modulation=switching";
const LINK: &str = "drive.link={ capacitance = \"470 uF\", source_resistance = \"0.5 Ohm\", mains_frequency = \"50 Hz\", brake = { resistance = \"47 Ohm\", on = \"390 V\", off = \"375 V\" } }";
const CURRENT_ERRORS: [&str; 6] = [
    "drive.current.sensor.offset_a=0.05 A",
    "drive.current.sensor.gain_error_b=0.01",
    "drive.current.sensor.bits=14",
    "drive.current.sensor.range=40 A",
    "drive.current.sensor.delay=1",
    "drive.current.sensor.shift=5 us",
];
const CURRENT_NOISE: &str = "drive.current.sensor.noise=20 mA";
const SIGNALS: [&str; 4] = [
    "motor.encoder.lines_per_rev=2048",
    "motor.encoder.amplitude_error=0.01",
    "motor.encoder.offset_sine=0.004",
    "motor.encoder.phase_error=0.3 deg",
];
const DISC: [&str; 2] = ["motor.encoder.eccentricity=10 um", "motor.encoder.disc_radius=20 mm"];
const ENCODER_NOISE: &str = "motor.encoder.noise=0.0001 deg";
const LATENCY: &str = "motor.encoder.latency=40 us";
const ZERO: [&str; 3] =
    ["motor.encoder.turn_bits=12", "motor.encoder.commutation_offset=2 deg", "motor.encoder.zero_offset=0.001 deg"];
const LOAD: [&str; 6] = [
    "drive.position_feedback=load",
    "drive.load_encoder.signal_period=20 um",
    "drive.load_encoder.step=1 nm",
    "drive.load_encoder.offset_sine=0.01",
    "drive.load_encoder.noise=5 nm",
    "drive.load_encoder.latency=40 us",
];

const ROWS: &[Row] = &[
    ("motor: cogging", &[COGGING]),
    ("motor: iron loss", &[IRON]),
    ("motor: flux harmonics", &[HARMONICS]),
    ("motor: unequal phases", &[PHASES]),
    ("motor: thermal model", &[THERMAL]),
    ("motor: saturation", &[SATURATION]),
    ("motor: all of these", &[COGGING, IRON, HARMONICS, PHASES, THERMAL, SATURATION]),
    ("inverter: dead time", &[CARRIER, DEAD_TIME]),
    ("inverter: devices", &DROPS),
    ("inverter: DC link", &[LINK]),
    ("inverter: switching", &[CARRIER, SWITCHING]),
    ("inverter: all of these, averaged", &[CARRIER, DEAD_TIME, DROPS[0], DROPS[1], LINK]),
    ("inverter: all of these", &[CARRIER, SWITCHING, DEAD_TIME, DROPS[0], DROPS[1], LINK]),
    ("current sensors: errors", &CURRENT_ERRORS),
    ("current sensors: noise", &[CURRENT_NOISE]),
    ("encoder: signals", &SIGNALS),
    ("encoder: eccentricity", &DISC),
    ("encoder: noise", &[ENCODER_NOISE]),
    ("encoder: latency", &[LATENCY]),
    ("encoder: zero, turns, commutation", &ZERO),
    ("encoder: a scale on the load", &LOAD),
    (
        "firmware: two filters of the torque",
        &[
            "drive.filter=[{ kind = \"notch\", frequency = \"300 Hz\" }, { kind = \"low-pass\", order = 2, frequency = \"900 Hz\" }]",
        ],
    ),
    ("firmware: velocity by M/T", &["drive.velocity.measurement=mt"]),
    (
        "firmware: velocity by an observer",
        &["drive.velocity.measurement=observer", "drive.velocity.observer.bandwidth=200 Hz"],
    ),
    ("firmware: MTPA, field weakening", &["drive.current.strategy=mtpa", "drive.current.field_weakening=true"]),
];

/// Rows that have everything of some.
fn sums() -> Vec<(&'static str, Vec<&'static str>)> {
    let sensors: Vec<&str> =
        [&CURRENT_ERRORS[..], &[CURRENT_NOISE], &SIGNALS, &DISC, &[ENCODER_NOISE, LATENCY], &ZERO, &LOAD].concat();
    let motor = [COGGING, IRON, HARMONICS, PHASES, THERMAL, SATURATION];
    let inverter = [CARRIER, SWITCHING, DEAD_TIME, DROPS[0], DROPS[1], LINK];
    let everything = [&sensors[..], &motor, &inverter].concat();
    vec![("all sensor effects", sensors), ("everything", everything)]
}

fn scenario(keys: &[&str]) -> Scenario {
    let (axis, _) = AXIS.split_once("[limits]").unwrap_or_else(|| panic!("the axis has limits"));
    let keys: Vec<Override> =
        keys.iter().map(|key| key.parse().unwrap_or_else(|error| panic!("{key}: {error}"))).collect();
    let loaded = Document::parse("axis.toml", axis, None, None)
        .and_then(|document| document.scenario(&keys))
        .unwrap_or_else(|error| panic!("{error}"));
    let mut scenario = loaded.scenario;
    scenario.duration = Some(1.0);
    scenario.record.channels = vec!["load.position".parse().unwrap_or_else(|error| panic!("{error}"))];
    scenario
}

/// Seconds of a run, and its ticks.
fn run(scenario: &Scenario) -> (f64, usize) {
    let bench = Bench::new(scenario, &Exact).unwrap_or_else(|error| panic!("{error}"));
    let start = Instant::now();
    let outcome = bench.run(&mut |_| {});
    let time = start.elapsed().as_secs_f64();
    assert_eq!(outcome.failure, None);
    (time, 16_000)
}

fn main() {
    let json = std::env::args().any(|argument| argument == "--json");
    let mut rows: Vec<(&str, Vec<&str>)> = vec![("ideal", vec![])];
    rows.extend(ROWS.iter().map(|(name, keys)| (*name, keys.to_vec())));
    rows.extend(sums());
    let scenarios: Vec<Scenario> = rows.iter().map(|(_, keys)| scenario(keys)).collect();
    let mut least = vec![f64::INFINITY; rows.len()];
    for _ in 0..ROUNDS {
        for (scenario, least) in scenarios.iter().zip(&mut least) {
            let (time, ticks) = run(scenario);
            *least = least.min(time / ticks as f64);
        }
    }
    let ideal = least[0];
    if json {
        let rows: Vec<String> = rows
            .iter()
            .zip(&least)
            .map(|((name, _), tick)| format!("{{\"effect\":\"{name}\",\"ns\":{:.1}}}", tick * 1e9))
            .collect();
        println!("{{\"hardware\":[{}]}}", rows.join(","));
        return;
    }
    println!("a tick of the feed axis at 16 kHz on exact, one core");
    println!("{:36}{:>8}{:>12}{:>8}{:>12}", "effect", "ns", "ns more", "ratio", "x real time");
    for ((name, _), tick) in rows.iter().zip(&least) {
        let (ns, more, ratio) = (tick * 1e9, (tick - ideal) * 1e9, tick / ideal);
        println!("{name:36}{ns:>8.0}{more:>12.0}{ratio:>8.2}{:>12.0}", 1.0 / (tick * 16e3));
    }
}
