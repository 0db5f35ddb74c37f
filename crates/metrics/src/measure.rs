//! Metrics of a recording.
use crate::metric::{MetricSet, Metrics, MoveMetrics};
use crate::name::Name;
use crate::span::{Checked, Phase, phases};
use crate::vibration::{Residual, Search};
use crate::{basis, compliance, coupling, effort, incident, rounding, settling, tracking};
use servobench_base::Rate;
use servobench_signals::Signal;
use servobench_trace::{Ending, Recording};

/// Share of the settling window below which a vibration does not matter.
const PART_OF_WINDOW: f64 = 1e-3;
/// Increments of an encoder below which a motion may be caused by its resolution.
const INCREMENTS: f64 = 4.0;

/// Data that a measurement needs besides the recording.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Question {
    /// Settling window, ± around the target (axis unit). Without it, there is no settling time.
    pub window: Option<f64>,
    /// Correct position of the zero of the task after homing, in the coordinate of the engine (axis unit).
    pub home_at: Option<f64>,
    /// Start of the measurement of residual vibration (s). Without it, the end of the last profile.
    pub from: Option<f64>,
    /// Natural frequency of the requested mode (Hz). Without it, the mode with the most energy is reported.
    pub mode: Option<f64>,
    /// Frequency of the lowest mode of the model (Hz); `None` where it is rigid or not known.
    pub lowest_mode: Option<f64>,
    /// One increment of the encoder that closes the position loop (axis unit); 0 for an ideal one.
    pub increment: f64,
    /// Rate of the ticks of the run; rows at a lower one are thinned. `None` where every tick has a row.
    pub base_rate: Option<Rate>,
}

impl Question {
    /// Vibration below this is of no interest (axis unit): a thousandth of the window, and four increments.
    pub(crate) fn least(&self) -> f64 {
        (PART_OF_WINDOW * self.window.unwrap_or_default()).max(INCREMENTS * self.increment)
    }
}

/// Signals from which metrics and requirements are computed: a recording of these gives the same results as one of every signal.
pub const MEASURED_FROM: [Signal; 33] = [
    Signal::RequestPosition,
    Signal::RequestVelocity,
    Signal::RequestEffort,
    Signal::SetpointPosition,
    Signal::SetpointAcceleration,
    Signal::MotorPosition,
    Signal::MotorVelocity,
    Signal::LoadPosition,
    Signal::BusPosition,
    Signal::VelocityReference,
    Signal::FollowingErrorMotor,
    Signal::FollowingErrorLoad,
    Signal::EffortReference,
    Signal::EffortMotor,
    Signal::CurrentD,
    Signal::CurrentQ,
    Signal::CurrentPeak,
    Signal::CurrentRms,
    Signal::VoltageD,
    Signal::VoltageQ,
    Signal::PowerElectrical,
    Signal::PowerCopper,
    Signal::PowerShaft,
    Signal::SaturationVoltage,
    Signal::SaturationCurrent,
    Signal::SaturationEffort,
    Signal::DisturbanceMotor,
    Signal::DisturbanceLoad,
    Signal::EffortEndStop,
    Signal::TemperatureWinding,
    Signal::PowerInverter,
    Signal::VoltageDcLink,
    Signal::PowerBrake,
];

/// Metrics that need the dominant mode of a residual vibration, whose fit takes longer than all others.
const OF_A_MODE: [Name; 5] = [
    Name::ResidualVibrationAmplitude,
    Name::ResidualVibrationFrequency,
    Name::ResidualVibrationDamping,
    Name::ResidualVibrationShare,
    Name::SteadyStateError,
];

/// Measures everything that the recording allows; all else is absent with the reason.
/// The definitions are in `docs/metrics.md`.
#[must_use]
pub fn measure(recording: &Recording, question: &Question) -> Metrics {
    measured(recording, question, Search::of(question.mode))
}

/// Measures only the metrics that are `wanted`: others are neither present nor absent, and a mode that only they need is not
/// fitted.
#[must_use]
pub fn measure_only(recording: &Recording, question: &Question, wanted: &dyn Fn(Name) -> bool) -> Metrics {
    let needs_a_mode = OF_A_MODE.into_iter().any(wanted);
    let search = if needs_a_mode { Search::of(question.mode) } else { Search::Nowhere };
    let mut metrics = measured(recording, question, search);
    for set in metrics.moves.iter_mut().map(|made| &mut made.metrics).chain([&mut metrics.run]) {
        set.retain(wanted);
    }
    metrics
}

fn measured(recording: &Recording, question: &Question, search: Search) -> Metrics {
    let phases = phases(recording);
    let checked = Checked::of(recording);
    let mut run = MetricSet::default();
    let mut moves = Vec::with_capacity(phases.len());
    // The stretch that begins at `from`, and every rest after it.
    let from = question.from.map(|from| Residual::from_time(&checked, from, question, search));
    let mut residuals: Vec<_> = from.into_iter().collect();
    let begins = question.from.unwrap_or(f64::NEG_INFINITY);
    for (k, phase) in phases.iter().enumerate() {
        let residual = Residual::after(&checked, phase, question, search);
        let made = phase.made;
        let metrics = move_metrics(&checked, phase, question, &residual);
        moves.push(MoveMetrics { label: made.label.clone(), start: made.start, end: made.end, metrics });
        // A move that another takes over, or that ends in motion, leaves no rest; the last one is measured as it is.
        if made.start > begins && (made.ending == Ending::AtRest || k + 1 == phases.len()) {
            residuals.push(residual);
        }
    }
    let all = 0..recording.len();
    settling::note_worst(&mut run, &checked, &moves);
    settling::note_program(&mut run, &phases, &moves);
    tracking::note(&mut run, &checked, all.clone(), &phases);
    Residual::largest(residuals).note(&mut run, &checked);
    compliance::note(&mut run, &phases);
    effort::note(&mut run, &checked, &all);
    incident::note(&mut run, &checked);
    coupling::note(&mut run, recording);
    let mut metrics = Metrics { run, moves };
    rounding::clear(&mut metrics, recording);
    basis::withhold(&mut metrics, recording, question);
    metrics
}

/// One move: its profile and the time until the next. Torque, current and voltage are those of the profile.
fn move_metrics(recording: &Checked<'_>, phase: &Phase<'_>, question: &Question, residual: &Residual) -> MetricSet {
    let mut metrics = MetricSet::default();
    let this = std::slice::from_ref(phase);
    settling::note(&mut metrics, recording, phase, question, residual.mode());
    tracking::note(&mut metrics, recording, phase.rows(), this);
    residual.note(&mut metrics, recording);
    compliance::note(&mut metrics, this);
    effort::note(&mut metrics, recording, &phase.profile);
    metrics
}
