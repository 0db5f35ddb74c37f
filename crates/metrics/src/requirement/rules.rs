//! Data for judging requirements besides the recording.
use super::deflection::Deflection;
use super::servo::Servo;
use super::{Expectation, Requirement};
use servobench_base::HeldMode;
use servobench_signals::Signal;

/// Data that the judgement of requirements needs besides the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules<'a> {
    /// Requirements that the scenario lifts.
    pub lifted: &'a [Requirement],
    /// Faults and incidents that belong to the run.
    pub expected: &'a [Expectation],
    /// Half width of the window around a target in which the axis has arrived (axis unit); `None`: that of
    /// [`arrival_window`](super::arrival_window).
    pub window: Option<f64>,
    /// Correct position of the zero of the task after homing, in the coordinate of the engine (axis unit); `None`: not given.
    pub home_at: Option<f64>,
    /// One increment of the encoder that closes the position loop or, if that is wider, the error of its signals within a period (axis
    /// unit); 0 for an ideal one.
    pub increment: f64,
    /// Noise of its readings (axis unit, effective).
    pub noise: f64,
    /// The same of the encoder at the motor, which closes the velocity loop; both may be the same encoder.
    pub motor: Readings,
    /// Efforts that the scenario orders, which explain swings of the axis.
    pub disturbances: Vec<Disturbance>,
    /// Channels in which an FMU excites the axis, each with the factor that converts it to an effort of the motor.
    pub excited: Vec<(Signal, f64)>,
    /// Axis coordinate per motor coordinate.
    pub transmission: f64,
    /// One unit of the positions on the bus (axis unit); 0 without a bus.
    pub bus_unit: f64,
    /// The linear rigid loop, if it is known.
    pub servo: Option<Servo>,
    /// The modes in which the load follows the motor; empty for a rigid axis, or if the mechanics are not known.
    pub held_modes: Vec<HeldMode>,
    /// Displacement of the axis by efforts.
    pub deflection: Deflection,
    /// Largest deviations of the axis from the request.
    pub tolerances: Tolerances,
    /// Means by which the axis moves.
    pub driven: Driven,
    /// Result of the analysis of the linear loop.
    pub linear_loop: LinearLoop,
    /// Poles of the linear loop, as far as it was analysed.
    pub poles: Option<Poles>,
    /// Part of the loops that this analysis lacks, with the reason: there the run alone is judged.
    pub not_analysed: Option<String>,
    /// Reason why the run ended early, if it did.
    pub ended: Option<EarlyEnd>,
    /// Highest permissible temperature of the winding (°C); `None` if it does not warm up.
    pub winding_limit: Option<f64>,
}

/// Resolution and noise of an encoder's positions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Readings {
    /// One increment, or the error of its signals within a period if that is wider (axis unit); 0 for an ideal one.
    pub increment: f64,
    /// Noise (axis unit, effective).
    pub noise: f64,
}

/// Largest deviations of the axis from the request, as shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Distance of the load from the response, as a share of the distance that the response covers.
    pub follows: f64,
    /// Largest window around a target, as a share of the distance to it.
    pub arrives: f64,
    /// Error of a held velocity, as a share of that velocity.
    pub velocity: f64,
    /// Error of an effort, as a share of that effort.
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
    /// Start (s).
    pub start: f64,
    /// End (s); infinite: the end of the run.
    pub end: f64,
    /// Its amplitude as an effort of the motor (N·m or N, motor coordinate).
    pub effort: f64,
    /// Frequency of a sine that begins at zero (Hz); `None` for a constant one.
    pub frequency: Option<f64>,
}

/// Means by which an axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// A drive with closed loops.
    ByLoops,
    /// The motor follows the set-point exactly: there is no loop, and arrival is judged at the motor.
    Exactly,
    /// Nothing: the drive is off.
    Not,
}

/// Result of the analysis of the linear loop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LinearLoop {
    /// No pole outside the unit circle.
    Stable,
    /// A pole is outside, described in words.
    Unstable(String),
    /// The loop could not be analysed, or there is none.
    NotAnalysed,
}

/// The poles of a linear loop that fade last.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Poles {
    /// The slowest pair that oscillates, with a damping ratio below 1/√2.
    pub oscillating: Option<Oscillation>,
    /// Decay of the slowest pole that does not oscillate (1/s).
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

/// Reason why a run ended early.
#[derive(Debug, Clone, PartialEq)]
pub enum EarlyEnd {
    /// A state left the finite numbers.
    Diverged {
        /// Time (s).
        time: f64,
        /// Reason in the engine's words.
        reason: String,
    },
    /// The program gave up, for this reason.
    GaveUp(String),
}

/// An encoder sees a swing larger than this number of its increments,
const INCREMENTS: f64 = 4.0;
/// and than this multiple of the noise of its readings.
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

    /// Largest swing of the motor that an encoder does not distinguish from rest (axis unit).
    pub(super) const fn unseen(&self) -> f64 {
        let increment = self.increment.max(self.motor.increment);
        (INCREMENTS * increment).max(NOISE * self.noise.max(self.motor.noise))
    }

    pub(crate) const fn has_diverged(&self) -> bool {
        matches!(self.ended, Some(EarlyEnd::Diverged { .. }))
    }
}
