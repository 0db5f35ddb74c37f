//! What a judgement needs to know besides the recording.
use super::deflection::Deflection;
use super::servo::Servo;
use super::{Expectation, Requirement};
use servobench_base::HeldMode;
use servobench_signals::Signal;

/// What a judgement of requirements needs to know besides the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules<'a> {
    /// Requirements that the scenario lifts.
    pub lifted: &'a [Requirement],
    /// Faults and incidents that belong to the run.
    pub expected: &'a [Expectation],
    /// Half width of the window around a target in which the axis has arrived (axis unit); `None`: as
    /// [`arrival_window`](super::arrival_window) says.
    pub window: Option<f64>,
    /// Where homing has to put the zero of the task, as the engine has it (axis unit); `None`: nobody says.
    pub home_at: Option<f64>,
    /// One increment of the encoder that closes the position loop or, if that is wider, the error of its signals within a period (axis
    /// unit); 0 for an ideal one.
    pub increment: f64,
    /// Noise of its readings (axis unit, effective).
    pub noise: f64,
    /// The same of the encoder at the motor, which closes the velocity loop; it may be the same one.
    pub motor: Readings,
    /// Efforts that the scenario orders, which explain that the axis swings.
    pub disturbances: Vec<Disturbance>,
    /// Channels in which an FMU excites the axis, each with the factor that makes it an effort of the motor.
    pub excited: Vec<(Signal, f64)>,
    /// Axis coordinate per motor coordinate.
    pub transmission: f64,
    /// One unit of the positions on the bus (axis unit); 0 without a bus.
    pub bus_unit: f64,
    /// The linear rigid loop, where there is one that is known.
    pub servo: Option<Servo>,
    /// The modes in which the load follows the motor; none of a rigid axis, or one whose mechanics are not known.
    pub held_modes: Vec<HeldMode>,
    /// By how much efforts displace the axis.
    pub deflection: Deflection,
    /// How far off what is requested the axis may be.
    pub tolerances: Tolerances,
    /// What moves the axis.
    pub driven: Driven,
    /// What the analysis of the linear loop found.
    pub linear_loop: LinearLoop,
    /// Poles of the linear loop, as far as it was analysed.
    pub poles: Option<Poles>,
    /// What of the loops is not in that, and why: there the run alone is judged.
    pub not_analysed: Option<String>,
    /// Why the run ended before its end, if it did.
    pub ended: Option<EarlyEnd>,
    /// Highest temperature that the winding bears (°C); `None` where it does not warm up.
    pub winding_limit: Option<f64>,
}

/// Resolution and noise of an encoder's positions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Readings {
    /// One increment, or the error of its signals within a period if that is wider (axis unit); 0 of an ideal one.
    pub increment: f64,
    /// Noise (axis unit, effective).
    pub noise: f64,
}

/// How far off what is requested the axis may be, as shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Of the way of the response: how far from it the load may be.
    pub follows: f64,
    /// Of the way to a target: the largest window around it.
    pub arrives: f64,
    /// Of a velocity that is held.
    pub velocity: f64,
    /// Of an effort.
    pub effort: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self { follows: 0.03, arrives: 0.05, velocity: 0.03, effort: 0.04 }
    }
}

/// An effort that the scenario orders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
    /// From when on it acts (s).
    pub start: f64,
    /// Until when (s); infinite: to the end of the run.
    pub end: f64,
    /// Its amplitude as an effort of the motor (N·m or N, motor coordinate).
    pub effort: f64,
    /// Of a sine that begins at zero (Hz); `None` for a constant one.
    pub frequency: Option<f64>,
}

/// What moves the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// A drive with closed loops.
    ByLoops,
    /// The motor follows the set-point exactly: there is no loop, and it is the motor that arrives.
    Exactly,
    /// Nothing: the drive is off.
    Not,
}

/// What the analysis of the linear loop found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LinearLoop {
    /// No pole outside the unit circle.
    Stable,
    /// There is one: which, in words.
    Unstable(String),
    /// It could not be analysed, or there is no loop.
    NotAnalysed,
}

/// The poles of a linear loop that fade last.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Poles {
    /// Of those that oscillate, with a damping ratio below 1/√2.
    pub oscillating: Option<Oscillation>,
    /// Decay of the slowest one that does not oscillate (1/s).
    pub slowest_real: Option<f64>,
}

/// A pair of poles that oscillates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillation {
    /// Frequency (Hz).
    pub frequency: f64,
    /// Decay of its amplitude (1/s); negative where it grows.
    pub decay: f64,
}

/// Why a run ended before its end.
#[derive(Debug, Clone, PartialEq)]
pub enum EarlyEnd {
    /// A state left the finite numbers: when (s), and what the engine says.
    Diverged {
        /// When (s).
        time: f64,
        /// In the engine's words.
        reason: String,
    },
    /// The program gave up: why.
    GaveUp(String),
}

/// The encoder sees a swing that is larger than so many of its increments,
const INCREMENTS: f64 = 4.0;
/// and than so many times the noise of its readings.
const NOISE: f64 = 5.0;

impl Rules<'_> {
    /// The oscillation that fades last.
    pub(super) fn oscillation(&self) -> Option<Oscillation> {
        self.poles.and_then(|poles| poles.oscillating)
    }

    /// The coarser of the increment of the encoder and the unit of the bus (axis unit).
    pub(super) const fn resolution(&self) -> f64 {
        self.increment.max(self.bus_unit)
    }

    /// The largest swing of the motor that an encoder does not tell from none (axis unit).
    pub(super) const fn unseen(&self) -> f64 {
        let increment = self.increment.max(self.motor.increment);
        (INCREMENTS * increment).max(NOISE * self.noise.max(self.motor.noise))
    }

    pub(crate) const fn has_diverged(&self) -> bool {
        matches!(self.ended, Some(EarlyEnd::Diverged { .. }))
    }
}
