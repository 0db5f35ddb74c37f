//! Cost of a tick of the whole closed loop on every engine, and of the bare engine step, in one run.
//!
//! `cargo xtask bench [--json]`. The loop: 16 kHz current control of a synchronous motor, two bodies, 20 recorded
//! channels. The bare step goes through the same motion of the same model: the engine's own library and nothing of ours.
//! On `exact` the axis also moves by function blocks of a PLC over a fieldbus; what that costs more is the price of blocks,
//! bus and the drive's state machine with its modes.
//!
//! Short rounds of all candidates alternate, so that a busy machine slows all of them; the least of each counts.
use servobench_plant::{BodyState, Engine, EngineName, Exact, Input, Mechanics, MechanicsError, MechanicsSetup};
use servobench_scenario::Scenario;
use servobench_sim::Bench;
use servobench_tests::scenario;
use std::sync::{Arc, Mutex};
use std::time::Instant;

const ROUNDS: usize = 300;
const BASE_RATE: f64 = 16_000.0;
const CHANNELS: usize = 20;

/// A quarter of a second in the middle of which the axis cruises.
const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
duration = "0.25 s"
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
acceleration = "1500 rad/s2"
jerk = "6e4 rad/s3"
snap = "6e6 rad/s4"
"#;

/// The axis is fed its set-points directly.
const DIRECT: &str = r#"
[[program]]
move_to = "15 rad"
"#;

/// The same move by function blocks, executed every 4 ms, over a bus with a frame every millisecond.
const ON_A_BUS: &str = r#"
[bus]
cycle = "1 ms"
motion_cycle = "4 ms"
units = { drive = 1048576, axis = "1 rev" }
[plc]
homing_required = false
[[call]]
block = "MC_Power"
name = "power"
[[call]]
block = "MC_MoveAbsolute"
name = "move"
start = "power.Status"
position = "15 rad"
"#;

/// Names of the candidates: one driven over a bus, one that records every channel.
const BY_BLOCKS: &str = "by blocks";
const ALL_CHANNELS: &str = "all channels";

/// What is measured: one round of it returns nanoseconds per tick.
struct Candidate {
    name: String,
    round: Box<dyn FnMut() -> f64>,
    best: f64,
}

/// One engine in the report (ns per tick).
struct Line {
    engine: EngineName,
    tick: f64,
    /// The bare step, of engines that have one.
    bare: Option<f64>,
    /// The loop on `exact` with the bare step after each tick, of no effect: what no coupling could be cheaper than.
    in_turn: Option<f64>,
}

/// What is added to a tick on `exact` (ns).
struct Adds {
    /// By blocks, drive and bus.
    blocks: f64,
    /// By all channels in place of twenty, the powers of the motor among them.
    channels: f64,
}

fn main() {
    let json = std::env::args().any(|argument| argument == "--json");
    let mut candidates = candidates();
    for _ in 0..ROUNDS {
        for candidate in &mut candidates {
            candidate.best = candidate.best.min((candidate.round)());
        }
    }
    let of = |wanted: String| candidates.iter().find(|candidate| candidate.name == wanted).map(|found| found.best);
    let lines: Vec<Line> = servobench_tests::engines()
        .into_iter()
        .map(Engine::name)
        .filter_map(|engine| {
            let tick = of(engine.to_string())?;
            Some(Line { engine, tick, bare: of(format!("bare {engine}")), in_turn: of(format!("{engine} in turn")) })
        })
        .collect();
    let added = |by: &str| of(by.to_owned()).map_or(f64::NAN, |tick| tick - exact_tick(&lines));
    let adds = Adds { blocks: added(BY_BLOCKS), channels: added(ALL_CHANNELS) };
    if json { print_json(&lines, &adds) } else { print_table(&lines, &adds) }
}

fn exact_tick(lines: &[Line]) -> f64 {
    lines.iter().find(|line| line.engine == Exact.name()).map_or(f64::NAN, |line| line.tick)
}

fn print_json(lines: &[Line], Adds { blocks, channels }: &Adds) {
    let number = |value: Option<f64>| value.map_or("null".to_owned(), |value| format!("{value:.1}"));
    let exact = exact_tick(lines);
    let engines: Vec<String> = lines
        .iter()
        .map(|line| {
            format!(
                "{{\"engine\":\"{}\",\"ns_per_tick\":{:.1},\"times_real_time\":{:.1},\"bare_step_ns\":{},\
                 \"above_bare_and_exact_ns\":{},\"above_bare_and_exact_in_turn_ns\":{}}}",
                line.engine,
                line.tick,
                1e9 / BASE_RATE / line.tick,
                number(line.bare),
                number(line.bare.map(|bare| line.tick - bare - exact)),
                number(line.in_turn.map(|in_turn| line.tick - in_turn)),
            )
        })
        .collect();
    println!(
        "{{\"base_rate_hz\":{BASE_RATE},\"channels\":{CHANNELS},\"blocks_drive_and_bus_add_ns\":{blocks:.1},\"all_channels_add_ns\":{channels:.1},\
         \"engines\":[{}]}}",
        engines.join(",")
    );
}

fn print_table(lines: &[Line], Adds { blocks, channels }: &Adds) {
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.0} ns"));
    let exact = exact_tick(lines);
    println!("{:8} {:>9} {:>12} {:>10} {:>19} {:>9}", "", "", "", "", "above bare + exact", "");
    println!(
        "{:8} {:>9} {:>12} {:>10} {:>9} {:>9}",
        "engine", "ns/tick", "× real time", "bare step", "apart", "in turn"
    );
    for line in lines {
        println!(
            "{:8} {:>9.0} {:>12.0} {:>10} {:>9} {:>9}",
            line.engine,
            line.tick,
            1e9 / BASE_RATE / line.tick,
            number(line.bare),
            number(line.bare.map(|bare| line.tick - bare - exact)),
            number(line.in_turn.map(|in_turn| line.tick - in_turn)),
        );
    }
    println!("apart: both measured alone, each with the caches to itself; in turn: one after the other at every tick");
    println!(
        "blocks, drive and bus add {blocks:.0} ns per tick: MC_Power and MC_MoveAbsolute every 4 ms, a frame every 1 ms"
    );
    println!("all channels in place of {CHANNELS}, the powers of the motor among them, add {channels:.0} ns per tick");
}

fn candidates() -> Vec<Candidate> {
    let direct = scenario(&[AXIS, DIRECT].concat());
    let motion = Arc::new(Motion::of(&direct));
    let recording_all = direct.clone();
    let axis = with_twenty_channels(direct);
    let mut on_a_bus = scenario(&[AXIS, ON_A_BUS].concat());
    on_a_bus.record.channels.clone_from(&axis.record.channels);
    assert_moves(&on_a_bus);
    let mut all = vec![
        candidate(BY_BLOCKS.into(), move || loop_round(&on_a_bus, &Exact)),
        candidate(ALL_CHANNELS.into(), move || loop_round(&recording_all, &Exact)),
    ];
    for engine in servobench_tests::engines() {
        let looped = axis.clone();
        all.push(candidate(engine.name().to_string(), move || loop_round(&looped, engine)));
        let Some(bare) = bare_step(engine.name()) else { continue };
        let alone = Arc::clone(&motion);
        all.push(candidate(format!("bare {}", engine.name()), move || bare_round(&alone, bare)));
        let (looped, in_turn) = (axis.clone(), InTurn { bare, motion: Arc::clone(&motion) });
        all.push(candidate(format!("{} in turn", engine.name()), move || loop_round(&looped, &in_turn)));
    }
    all
}

/// Blocks that move nothing would cost less.
fn assert_moves(axis: &Scenario) {
    let recording = servobench_tests::run(axis, &Exact);
    let position = recording.channel("load.position").and_then(|values| values.last().copied());
    assert!(position.is_some_and(|position| position > 5.0), "the axis ends at {position:?} rad");
}

fn candidate(name: String, round: impl FnMut() -> f64 + 'static) -> Candidate {
    Candidate { name, round: Box::new(round), best: f64::INFINITY }
}

/// Keeps the first twenty channels of those that the axis has.
fn with_twenty_channels(mut axis: Scenario) -> Scenario {
    let recording = servobench_tests::run(&axis, &Exact);
    let names = recording.channels.iter().map(|channel| channel.spec.name.parse().unwrap());
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

fn bare_round(motion: &Arc<Motion>, bare: Bare) -> f64 {
    let mut step = bare(motion);
    let ticks = motion.efforts.len();
    let start = Instant::now();
    for k in 0..ticks {
        step(k);
    }
    start.elapsed().as_secs_f64() * 1e9 / ticks as f64
}

/// The motion of the loop, for the bare steps to go through.
struct Motion {
    setup: MechanicsSetup,
    /// Effort on the motor at each tick (N·m).
    efforts: Vec<f64>,
    /// Mean accelerations of motor and load over each tick (rad/s²).
    accelerations: Vec<[f64; 2]>,
}

impl Motion {
    fn of(axis: &Scenario) -> Self {
        let recording = servobench_tests::run(axis, &Exact);
        let values = |name: &str| recording.channel(name).unwrap_or_else(|| panic!("no channel {name}"));
        let (motor, load) = (values("motor.velocity"), values("load.velocity"));
        let mean = |v: &[f64], k: usize| v.get(k + 1).map_or(0.0, |next| (next - v[k]) * BASE_RATE);
        let accelerations = (0..motor.len()).map(|k| [mean(motor, k), mean(load, k)]).collect();
        Self { setup: setup_of(axis), efforts: values("effort.motor").to_vec(), accelerations }
    }
}

/// What the loop asks an engine to build.
fn setup_of(axis: &Scenario) -> MechanicsSetup {
    struct Listener(Mutex<Option<MechanicsSetup>>);
    impl Engine for Listener {
        fn name(&self) -> EngineName {
            Exact.name()
        }
        fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
            self.0.lock().unwrap_or_else(|error| panic!("{error}")).replace(setup.clone());
            Exact.build(setup)
        }
    }
    let listener = Listener(Mutex::new(None));
    drop(Bench::new(axis, &listener));
    let heard = listener.0.into_inner().unwrap_or_else(|error| panic!("{error}"));
    heard.unwrap_or_else(|| panic!("the loop built no mechanics"))
}

/// `exact`, and a bare step of another engine after each tick.
struct InTurn {
    bare: Bare,
    motion: Arc<Motion>,
}

struct InTurnMechanics {
    exact: Box<dyn Mechanics>,
    step: Step,
    k: usize,
}

impl Engine for InTurn {
    fn name(&self) -> EngineName {
        Exact.name()
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        Ok(Box::new(InTurnMechanics { exact: Exact.build(setup)?, step: (self.bare)(&self.motion), k: 0 }))
    }
}

impl Mechanics for InTurnMechanics {
    fn bodies(&self) -> &[BodyState] {
        self.exact.bodies()
    }

    fn advance(&mut self, input: &Input) -> Result<(), MechanicsError> {
        (self.step)(self.k);
        self.k += 1;
        self.exact.advance(input)
    }
}

/// Tick k of a bare engine.
type Step = Box<dyn FnMut(usize) + Send>;
/// Builds a bare engine at tick 0.
type Bare = fn(&Arc<Motion>) -> Step;

fn bare_step(engine: EngineName) -> Option<Bare> {
    match engine {
        EngineName::Rapier => Some(bare_rapier),
        #[cfg(feature = "mujoco")]
        EngineName::Mujoco => Some(bare_mujoco),
        _ => None,
    }
}

/// Two bodies in a scene like that of the engine.
fn bare_rapier(motion: &Arc<Motion>) -> Step {
    use rapier3d_f64::prelude::{LockedAxes, MassProperties, PhysicsWorld, RigidBodyBuilder, Vector};
    let mut scene = PhysicsWorld::new();
    let parameters = &mut scene.integration_parameters;
    parameters.dt = motion.setup.step;
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
    let motion = Arc::clone(motion);
    Box::new(move |k| {
        let [motor, load] = motion.accelerations[k];
        scene.gravity = Vector::new(motor, load, 0.0);
        scene.step();
    })
}

/// The generated model of the same axis.
#[cfg(feature = "mujoco")]
fn bare_mujoco(motion: &Arc<Motion>) -> Step {
    use mujoco_rs::prelude::{MjData, MjModel, MjtDisableBit};
    let servobench_plant::Model::Chain(chain) = &motion.setup.model else { panic!("the axis is no chain") };
    let xml = servobench_plant::chain_to_mjcf(chain, motion.setup.drive, motion.setup.step);
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
    let mut data = MjData::new(Arc::new(model));
    let motion = Arc::clone(motion);
    Box::new(move |k| {
        data.qfrc_applied_mut()[0] = motion.efforts[k];
        data.step();
    })
}
