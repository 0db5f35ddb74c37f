//! Loops to analyse.
use servobench_base::Coordinate;
use servobench_base::{Divider, Dq, Rate};
use servobench_drive::{self as drive, current, feedforward, velocity};
use servobench_plant::{Body, Chain, Encoder, EncoderErrors, Friction, Link, pmsm};
use servobench_sim::{AtRest, WiredSensors};
use servobench_stability::{
    Depth, Loop, PositionFeedback, Report, Source, StabilityError, VelocitySignal, analyse as analyse_running,
};

pub(crate) const TAU: f64 = std::f64::consts::TAU;

pub(crate) fn ticks(ticks: u32) -> Divider {
    Divider::new(ticks).unwrap()
}

pub(crate) fn body(inertia: f64, viscous: f64) -> Body {
    let (coordinate, friction) = (Coordinate::Linear, Friction { viscous, ..Friction::NONE });
    Body { name: "body", coordinate, inertia, transmission: 1.0, friction, bias: 0.0 }
}

/// Bodies in a row with links of these stiffnesses and dampings.
pub(crate) fn chain(bodies: Vec<Body>, links: &[(f64, f64)]) -> Chain {
    Chain::new(bodies, links.iter().map(|&(stiffness, damping)| Link { stiffness, damping }).collect()).unwrap()
}

/// An ideal source under a P velocity loop that turns every `every` ticks of `base` Hz; no position loop.
pub(crate) fn ideal(base: u32, every: u32, k_p: f64, mechanics: Chain) -> Loop {
    Loop {
        drive: drive::Params {
            base_rate: Rate::new(base).unwrap(),
            transmission: 1.0,
            position_gain: 0.0,
            position_every: ticks(every),
            velocity: velocity::Params { k_p, integral_time: None, max_effort: f64::INFINITY },
            velocity_every: ticks(every),
            velocity_filter_time: 0.0,
            feedforward: feedforward::Params {
                velocity: 0.0,
                interpolate: true,
                model: feedforward::Model::Off,
                coulomb: 0.0,
                bias: 0.0,
            },
            blocks: drive::Blocks::default(),
            reference_delay: drive::delay::Params::default(),
            stage: drive::Stage::Direct { gain: 1.0 },
        },
        closes_position: false,
        master_cycle: None,
        velocity_signal: VelocitySignal::Encoder,
        position_feedback: PositionFeedback::Motor,
        current_tuning: None,
        source: Source::Ideal { gain: 1.0 },
        mechanics: mechanics.into(),
        d_current: 0.0,
    }
}

/// What an axis with a synchronous motor is set to.
#[derive(Clone, Copy)]
pub(crate) struct Tuning {
    /// Hz.
    pub(crate) current: f64,
    /// N·m·s/rad.
    pub(crate) velocity: f64,
    /// s
    pub(crate) integral_time: f64,
    /// s
    pub(crate) filter_time: f64,
    /// 1/s
    pub(crate) position: f64,
}

pub(crate) const MOTOR: pmsm::Params = pmsm::Params {
    electrical_ratio: 4.0,
    resistance: 1.615,
    inductance: Dq { d: 3.485e-3, q: 3.485e-3 },
    flux_linkage: 60.6e-3,
};

/// A synchronous motor at 16/8/4 kHz.
pub(crate) fn servo(tuning: Tuning, mechanics: Chain) -> Loop {
    let motor = current::MotorEstimate {
        electrical_ratio: MOTOR.electrical_ratio,
        resistance: MOTOR.resistance,
        inductance: MOTOR.inductance,
        flux_linkage: MOTOR.flux_linkage,
    };
    let gains = current::Gains::from_bandwidth(&motor, TAU * tuning.current);
    let (max_current, max_voltage) = (f64::INFINITY, f64::INFINITY);
    let operation = current::operating_point::Params::default();
    let params =
        current::Params { motor, gains, d_reference: 0.0, max_current, max_voltage, operation, dead_time: None };
    let rest = ideal(16_000, 2, tuning.velocity, mechanics);
    Loop {
        drive: drive::Params {
            position_gain: tuning.position,
            position_every: ticks(4),
            velocity: velocity::Params { integral_time: Some(tuning.integral_time), ..rest.drive.velocity },
            velocity_filter_time: tuning.filter_time,
            stage: drive::Stage::Current { params, every: ticks(1) },
            ..rest.drive
        },
        closes_position: true,
        source: Source::Pmsm(MOTOR),
        ..rest
    }
}

/// Sensors as `model` has them, whose encoder on the motor is as late as this (s).
pub(crate) fn sensors(model: &Loop, latency: f64) -> WiredSensors {
    let errors = EncoderErrors { latency, ..EncoderErrors::default() };
    let increment = (model.velocity_signal == VelocitySignal::Differences).then_some(1e-9);
    let motor = Encoder { increment, errors: (latency > 0.0).then_some(errors) };
    let load = (model.position_feedback == PositionFeedback::Load).then(Encoder::default);
    WiredSensors { motor, load, current: None }
}

/// The loop that `model` describes, as it runs.
pub(crate) fn running(model: &Loop) -> Box<AtRest> {
    Box::new(AtRest::new(model, &sensors(model, 0.0), None).unwrap_or_else(|error| panic!("{error}")))
}

/// # Errors
/// As of [`analyse_running`].
pub(crate) fn analyse(model: &Loop, depth: Depth) -> Result<Report, StabilityError> {
    analyse_running(model, running(model), depth)
}

pub(crate) fn report(model: &Loop) -> Report {
    analyse(model, Depth::Boundaries).unwrap_or_else(|error| panic!("{error}"))
}
