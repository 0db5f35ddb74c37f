//! A scenario with every name resolved, every quantity in SI and every rule checked: what the closed loop is built from.
//!
//! A rotary motor's own coordinate is rad, a linear one's m. The axis coordinate is the load's: rad or m, as
//! [`Axis::motion`] says. "Effort" is a torque or a force, whichever fits the coordinate.
use servobench_base::Rate;
use std::path::PathBuf;

/// Longest run (s), 11.6 days. At the highest base rate its ticks are fewer than 2⁵³: the time of every tick is exact.
pub const LONGEST_RUN: f64 = 1e6;

/// One experiment: an axis, a program of moves, what to measure and the limits that make it pass or fail.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Name in tables and results; the file's stem unless given.
    pub name: String,
    /// What it shows, in a sentence.
    pub description: String,
    /// File it came from; `None` for text.
    pub path: Option<PathBuf>,
    /// Engines to run it on, at least one, in the order given.
    pub engines: Vec<EngineName>,
    /// Base rate: one tick of mechanics.
    pub base_rate: Rate,
    /// Length of the run (s); `None`: the program and half a second.
    pub duration: Option<f64>,
    /// The mechanics.
    pub axis: Axis,
    /// What moves it.
    pub motor: Motor,
    /// The firmware; ignored when the motor follows its prescribed motion.
    pub drive: Drive,
    /// Moves and pauses, one after the other, from time 0.
    pub program: Vec<Step>,
    /// External efforts.
    pub disturbances: Vec<Disturbance>,
    /// Deviation from rest at zero at time 0.
    pub initial: Initial,
    /// What to record.
    pub record: Record,
    /// What the measures need to know.
    pub measure: Measure,
    /// What makes it pass or fail, in the order of the file.
    pub limits: Vec<Limit>,
}

/// Bounds of one metric (SI).
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Name of the metric.
    pub metric: String,
    /// Smallest allowed value.
    pub min: Option<f64>,
    /// Largest allowed value.
    pub max: Option<f64>,
}

/// Engines a scenario can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EngineName {
    /// Exact zero-order hold of the linear chain.
    Exact,
    /// Rapier, in f64.
    Rapier,
    /// MuJoCo.
    Mujoco,
}

/// Whether a coordinate is a length or an angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// m, N, kg.
    Linear,
    /// rad, N·m, kg·m².
    Rotary,
}

/// The mechanics of the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Coordinate of the load.
    pub motion: Motion,
    /// Coordinate of the motor.
    pub motor_motion: Motion,
    /// Axis coordinate per motor coordinate: lead/2π (m/rad), 1/gear ratio, or 1.
    pub transmission: f64,
    /// The bodies.
    pub mechanics: AxisMechanics,
}

/// Where the bodies come from.
#[derive(Debug, Clone, PartialEq)]
pub enum AxisMechanics {
    /// Lumped bodies, the motor's first. Bodies that were coupled rigidly are merged already, the rotor's inertia is in.
    Bodies(Vec<Body>),
    /// A user's own MJCF file.
    Mjcf(Mjcf),
}

/// One lumped body; in the motor coordinate for the first, in the axis coordinate for the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// `motor`, `table` or `load`.
    pub name: &'static str,
    /// Mass (kg) or inertia (kg·m²).
    pub inertia: f64,
    /// Coupling to the body before it (axis coordinate); `None` for the first body only.
    pub coupling: Option<Coupling>,
    /// Viscous friction (N·s/m or N·m·s/rad).
    pub viscous: f64,
    /// Coulomb friction (N or N·m).
    pub coulomb: f64,
    /// Breakaway friction, at least `coulomb` (N or N·m).
    pub breakaway: f64,
    /// Stribeck velocity (m/s or rad/s); 0 for an immediate step.
    pub stribeck_velocity: f64,
    /// Constant resisting effort (N or N·m).
    pub bias: f64,
}

/// Spring and damper (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// N/m or N·m/rad.
    pub stiffness: f64,
    /// N·s/m or N·m·s/rad.
    pub damping: f64,
}

/// A user's own MJCF file and the parts of it that are the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Mjcf {
    /// Text of the file.
    pub xml: String,
    /// The file.
    pub path: PathBuf,
    /// Motor joint.
    pub motor_joint: String,
    /// Load joint.
    pub load_joint: String,
    /// Actuator.
    pub actuator: String,
}

/// What moves the axis.
#[derive(Debug, Clone, PartialEq)]
pub enum Motor {
    /// A permanent-magnet synchronous motor on an averaged inverter.
    Pmsm(Pmsm),
    /// An ideal source: effort = gain × output, output saturating.
    IdealSource(IdealSource),
    /// The motor side follows the set-point exactly.
    Prescribed,
}

/// PMSM in dq, amplitude-invariant, phase-to-neutral.
#[derive(Debug, Clone, PartialEq)]
pub struct Pmsm {
    /// Pole pairs.
    pub pole_pairs: u32,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// d-axis inductance (H).
    pub inductance_d: f64,
    /// q-axis inductance (H).
    pub inductance_q: f64,
    /// Flux linkage of the magnets, peak (V·s).
    pub flux_linkage: f64,
    /// Largest current, peak (A).
    pub max_current: f64,
    /// Encoder on the motor.
    pub encoder: Encoder,
}

/// Ideal effort source.
#[derive(Debug, Clone, PartialEq)]
pub struct IdealSource {
    /// Effort per unit of output (N/V or N·m/V; 1 when the output is the effort itself).
    pub gain: f64,
    /// Largest |output| (V, N or N·m).
    pub limit: f64,
    /// Encoder on the motor.
    pub encoder: Encoder,
}

/// Position encoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encoder {
    /// Smallest step (motor coordinate for the motor's, axis coordinate for the load's); `None` for an ideal encoder.
    pub resolution: Option<f64>,
}

/// The drive's firmware.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Whether the power stage is on. Off: no current, no force, and the axis is free.
    pub enabled: bool,
    /// DC-link voltage (V); infinite without a limit.
    pub dc_link: f64,
    /// Largest effort it asks for (motor coordinate); infinite without a limit.
    pub max_effort: f64,
    /// Current loop; `None` for an ideal source.
    pub current: Option<CurrentLoop>,
    /// Velocity loop.
    pub velocity: VelocityLoop,
    /// Position loop.
    pub position: PositionLoop,
    /// Feedforward.
    pub feedforward: Feedforward,
    /// What the firmware believes of the axis.
    pub estimate: Estimate,
    /// Encoder on the load, when the axis has one.
    pub load_encoder: Option<Encoder>,
    /// Which encoder closes the position loop.
    pub position_feedback: Feedback,
}

/// Encoder that closes a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feedback {
    /// Motor encoder.
    Motor,
    /// Load encoder.
    Load,
}

/// Current loop in dq.
#[derive(Debug, Clone, PartialEq)]
pub struct CurrentLoop {
    /// Task rate.
    pub rate: Rate,
    /// Closed-loop bandwidth (rad/s); gains are derived from it and the estimated motor.
    pub bandwidth: f64,
    /// Proportional gains (V/A) d and q, when given instead of derived.
    pub gain: Option<(f64, f64)>,
    /// Integral times (s) d and q, when given.
    pub integral_time: Option<(f64, f64)>,
}

/// Velocity loop.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityLoop {
    /// Task rate.
    pub rate: Rate,
    /// Proportional gain in effort per velocity of the motor coordinate (N·s/m or N·m·s/rad).
    pub gain: f64,
    /// Integral time (s); `None` for a P controller.
    pub integral_time: Option<f64>,
    /// Time constant of the low-pass on the measured velocity (s); 0 for none.
    pub filter_time: f64,
}

/// Position loop.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionLoop {
    /// Task rate.
    pub rate: Rate,
    /// Proportional gain, `K_v` (1/s).
    pub gain: f64,
}

/// Feedforward.
#[derive(Debug, Clone, PartialEq)]
pub struct Feedforward {
    /// Share of the reference velocity that is fed forward, 0 to 1.
    pub velocity: f64,
    /// Model behind the effort feedforward.
    pub effort: EffortFeedforward,
    /// Whether estimated Coulomb friction and bias are fed forward too.
    pub friction: bool,
    /// How long the reference waits for the feedforward path (s); `None`: as long as the effort path takes.
    pub delay: Option<f64>,
}

/// Model behind the effort feedforward.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EffortFeedforward {
    /// None.
    Off,
    /// One rigid body: inertia and viscous friction.
    Rigid,
    /// Two bodies and a spring: velocity, acceleration, jerk and snap; the set-point is the load's.
    TwoMass,
}

/// What the firmware believes, all in the axis coordinate unless said otherwise. The tool fills it from the plant;
/// a scenario overrides single values to express mismatch.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Mass or inertia on the motor's side of the spring (two-mass), rotor included.
    pub motor_inertia: f64,
    /// Mass or inertia beyond the spring; 0 for a rigid axis.
    pub load_inertia: f64,
    /// Spring stiffness (N/m or N·m/rad); infinite for a rigid axis.
    pub stiffness: f64,
    /// Viscous friction on the motor's side.
    pub motor_viscous: f64,
    /// Viscous friction on the load.
    pub load_viscous: f64,
    /// Coulomb friction, all bodies.
    pub coulomb: f64,
    /// Constant resisting effort, all bodies.
    pub bias: f64,
    /// Motor as the firmware knows it; `None` for an ideal source.
    pub motor: Option<Pmsm>,
}

/// A step of the program.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A rest-to-rest move.
    Move(MoveStep),
    /// A pause (s).
    Wait(f64),
}

/// A rest-to-rest move.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveStep {
    /// Target: absolute, or relative to the last target (axis coordinate).
    pub target: Target,
    /// Order of the profile: 2, 3 or 4.
    pub order: u8,
    /// Limits of |velocity|, |acceleration|, |jerk|, |snap|; infinite where the order has none.
    pub limits: [f64; 4],
    /// Sampled plan with this sample time (s); `None` for the continuous one.
    pub sample_time: Option<f64>,
    /// Slowed to last this long (s), every derivative in proportion; `None`: as fast as the limits allow.
    pub duration: Option<f64>,
}

/// Where a move goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To a position.
    Absolute(f64),
    /// By a distance.
    Relative(f64),
}

/// An external effort.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbance {
    /// Body it acts on.
    pub on: DisturbedBody,
    /// First instant (s).
    pub start: f64,
    /// How long (s); infinite: to the end.
    pub duration: f64,
    /// Amplitude (N or N·m, in the body's coordinate).
    pub effort: f64,
    /// Frequency of a sine (Hz); `None` for a step.
    pub frequency: Option<f64>,
}

/// Body a disturbance acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DisturbedBody {
    /// The motor (motor coordinate).
    Motor,
    /// The load (axis coordinate).
    Load,
}

/// Initial deviation of the load from rest at zero (axis coordinate).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Initial {
    /// Load position (m or rad).
    pub load_position: f64,
    /// Load velocity (m/s or rad/s).
    pub load_velocity: f64,
}

/// What to record.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Rate of the recording; divides the base rate.
    pub rate: Rate,
    /// Channels to keep; empty for all.
    pub channels: Vec<String>,
}

/// What the measures need to know.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measure {
    /// Settling window, ± (axis coordinate); without it there is no settling time.
    pub window: Option<f64>,
    /// From when on residual vibration is measured when there is no move (s).
    pub from: Option<f64>,
    /// Where to look for the residual mode (Hz); without it, everywhere.
    pub mode: Option<f64>,
}

impl EngineName {
    /// Every engine, in the order in which tables list them.
    pub const ALL: [Self; 3] = [Self::Exact, Self::Rapier, Self::Mujoco];

    /// The name as scenario files write it.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Rapier => "rapier",
            Self::Mujoco => "mujoco",
        }
    }
}
