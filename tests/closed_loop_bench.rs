//! Cost of a tick of the whole closed loop on every engine, and of the bare engine step, in one run.
//!
//! `cargo xtask bench [--json]`. The loop: 16 kHz current control of a synchronous motor, two bodies, 20 recorded
//! channels. Rounds of all candidates alternate, so that a busy machine slows all of them; the least of each counts.
use servobench_plant::{Engine, Exact};
use servobench_scenario::Scenario;
use servobench_sim::Bench;
use servobench_tests::scenario;
use std::time::Instant;

/// Simulated time of one round (s), and rounds.
const SECONDS: u32 = 1;
const ROUNDS: usize = 40;
const BASE_RATE: f64 = 16_000.0;
const CHANNELS: usize = 20;

const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "two-mass"
[motor]
model = "saarakkala-2.2kw"
[drive]
dc_link = "540 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "8 kHz"
bandwidth = "50 Hz"
[drive.position]
rate = "4 kHz"
gain = "60 1/s"
[drive.feedforward]
velocity = true
effort = "two-mass"
[setpoint]
order = 4
velocity = "100 rad/s"
acceleration = "500 rad/s2"
jerk = "2e4 rad/s3"
snap = "1e6 rad/s4"
[[program]]
move_to = "60 rad"
"#;

/// What is measured: a name, and one round of it that returns nanoseconds per tick.
type Candidate = (String, Box<dyn FnMut() -> f64>);

fn main() {
    let json = std::env::args().any(|argument| argument == "--json");
    let mut candidates = candidates();
    let mut best = vec![f64::INFINITY; candidates.len()];
    for _ in 0..ROUNDS {
        for ((_, round), best) in candidates.iter_mut().zip(&mut best) {
            *best = best.min(round());
        }
    }
    let named: Vec<(&str, f64)> = candidates.iter().map(|(name, _)| name.as_str()).zip(best).collect();
    report(&named, json);
}

fn report(best: &[(&str, f64)], json: bool) {
    let of = |wanted: &str| best.iter().find(|(name, _)| *name == wanted).map(|(_, ns)| *ns);
    let exact = of("exact").unwrap_or(f64::NAN);
    let mut lines = Vec::new();
    for engine in servobench_tests::engines() {
        let (name, bare) = (engine.name(), of(&format!("bare {}", engine.name())));
        let Some(tick) = of(name) else { continue };
        let real_time = 1e9 / BASE_RATE / tick;
        let above = bare.map(|bare| tick - bare - exact);
        lines.push((name, tick, real_time, bare, above));
    }
    if json {
        let engines: Vec<String> = lines
            .iter()
            .map(|(name, tick, real_time, bare, above)| {
                let number = |value: &Option<f64>| value.map_or("null".to_owned(), |value| format!("{value:.1}"));
                let (bare, above) = (number(bare), number(above));
                format!(
                    "{{\"engine\":\"{name}\",\"ns_per_tick\":{tick:.1},\"times_real_time\":{real_time:.1},\
                     \"bare_step_ns\":{bare},\"above_bare_and_exact_ns\":{above}}}"
                )
            })
            .collect();
        println!("{{\"base_rate_hz\":{BASE_RATE},\"channels\":{CHANNELS},\"engines\":[{}]}}", engines.join(","));
        return;
    }
    println!("{:8} {:>9} {:>12} {:>10} {:>22}", "engine", "ns/tick", "× real time", "bare step", "above bare + exact");
    for (name, tick, real_time, bare, above) in lines {
        let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.0} ns"));
        println!("{name:8} {tick:>9.0} {real_time:>12.0} {:>10} {:>22}", number(bare), number(above));
    }
}

fn candidates() -> Vec<Candidate> {
    let axis = with_twenty_channels(scenario(AXIS));
    let mut all: Vec<Candidate> = Vec::new();
    for engine in servobench_tests::engines() {
        let axis = axis.clone();
        all.push((engine.name().to_owned(), Box::new(move || loop_round(&axis, engine))));
    }
    all.push(("bare rapier".into(), bare_rapier()));
    #[cfg(feature = "mujoco")]
    all.push(("bare mujoco".into(), bare_mujoco()));
    all
}

/// Keeps the first twenty channels of those that the axis has.
fn with_twenty_channels(mut axis: Scenario) -> Scenario {
    axis.duration = Some(f64::from(SECONDS));
    let recording = servobench_tests::run(&axis, &Exact);
    let names = recording.channels.iter().map(|channel| channel.spec.name.clone());
    axis.record.channels = names.take(CHANNELS).collect();
    assert_eq!(axis.record.channels.len(), CHANNELS, "the axis has too few channels");
    axis
}

fn loop_round(axis: &Scenario, engine: &dyn Engine) -> f64 {
    let bench = Bench::new(axis, engine).unwrap_or_else(|error| panic!("{error}"));
    let start = Instant::now();
    let outcome = bench.run(&mut |_| {});
    let elapsed = start.elapsed();
    assert_eq!(outcome.failure, None);
    elapsed.as_secs_f64() * 1e9 / outcome.recording.len() as f64
}

/// A round of bare steps (ns each).
fn round_of(mut step: impl FnMut() + 'static) -> Box<dyn FnMut() -> f64> {
    let steps = SECONDS * 16_000;
    Box::new(move || {
        let start = Instant::now();
        for _ in 0..steps {
            step();
        }
        start.elapsed().as_secs_f64() * 1e9 / f64::from(steps)
    })
}

/// Two bodies in a scene like that of the engine, and nothing of ours.
fn bare_rapier() -> Box<dyn FnMut() -> f64> {
    use rapier3d_f64::prelude::{LockedAxes, MassProperties, PhysicsWorld, RigidBodyBuilder, Vector};
    let mut scene = PhysicsWorld::new();
    let parameters = &mut scene.integration_parameters;
    parameters.dt = 1.0 / BASE_RATE;
    parameters.num_solver_iterations = 1;
    parameters.num_internal_stabilization_iterations = 0;
    parameters.max_ccd_substeps = 0;
    parameters.warmstart_coefficient = 0.0;
    for i in 0..2 {
        let free = LockedAxes::from_bits_truncate(1 << i);
        let mass = MassProperties::new(Vector::ZERO, 1.0, Vector::splat(1.0));
        let body = RigidBodyBuilder::dynamic().locked_axes(LockedAxes::all() ^ free).additional_mass_properties(mass);
        scene.bodies.insert(body.can_sleep(false));
    }
    let mut k = 0_u32;
    round_of(move || {
        k = k.wrapping_add(1);
        scene.gravity = Vector::splat(f64::from(k % 7) - 3.0);
        scene.step();
    })
}

/// The generated model of the same axis, stepped by `mj_step` alone.
#[cfg(feature = "mujoco")]
fn bare_mujoco() -> Box<dyn FnMut() -> f64> {
    use mujoco_rs::prelude::{MjData, MjModel, MjtDisableBit};
    use servobench_plant::{Drive, chain_to_mjcf};
    let xml = chain_to_mjcf(&two_mass(), Drive::Effort, 1.0 / BASE_RATE);
    let mut model = MjModel::from_xml_string(&xml).unwrap_or_else(|error| panic!("{error}"));
    for unused in [
        MjtDisableBit::mjDSBL_CONSTRAINT,
        MjtDisableBit::mjDSBL_CONTACT,
        MjtDisableBit::mjDSBL_GRAVITY,
        MjtDisableBit::mjDSBL_ACTUATION,
        MjtDisableBit::mjDSBL_SENSOR,
    ] {
        model.opt_mut().disableflags |= unused as i32;
    }
    let mut data = MjData::new(std::sync::Arc::new(model));
    data.qfrc_applied_mut()[0] = 1e-3;
    round_of(move || data.step())
}

#[cfg(feature = "mujoco")]
fn two_mass() -> servobench_plant::Chain {
    use servobench_plant::{Body, Chain, Coordinate, DryFriction, Link};
    let body = |name| Body {
        name,
        coordinate: Coordinate::Rotary,
        inertia: 5e-3,
        transmission: 1.0,
        viscous: 0.0,
        dry: DryFriction::NONE,
        bias: 0.0,
    };
    Chain::new(vec![body("motor"), body("load")], vec![Link { stiffness: 700.0, damping: 0.01 }])
        .unwrap_or_else(|error| panic!("{error}"))
}
