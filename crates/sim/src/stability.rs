//! The linear loop of a scenario, for the analysis of its stability.
use crate::bench::plant;
use crate::coupled;
use crate::error::BuildError;
use servobench_base::Dq;
use servobench_plant::Encoder;
use servobench_scenario::{Actuator, AxisMechanics, BusMode, Feedback, LoopSignal, Scenario};
use servobench_stability::{
    self as stability, Depth, Loop, OperatingPoint, PositionFeedback, Report, Source, VelocitySignal,
};
use std::fmt::{self, Display, Formatter};

/// What the analysis of a scenario came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Analysis {
    /// The poles of the loop.
    Done {
        /// What they say.
        report: Box<Report>,
        /// A loop of the scenario that is not in it.
        without: Option<NotAnalysed>,
    },
    /// There is no linear loop that is known here, and why.
    NotPossible(NotAnalysed),
}

/// What is not analysed, and why.
#[derive(Debug, Clone, PartialEq)]
pub enum NotAnalysed {
    /// Nothing commands the motor by a loop.
    NoDrive,
    /// The drive is an FMU, or an FMU gives what the drive would.
    ForeignDrive,
    /// The mechanics is an MJCF file or an FMU alone.
    ForeignMechanics(&'static str),
    /// The master closes the position loop over the bus: what is analysed is the drive.
    MastersPositionLoop,
    /// FMUs beside the axis act on it: what is analysed is the axis without them.
    Fmus,
    /// Sensors are late, or the commutation is off: what is analysed is the loop with sensors that are not.
    LateSensors,
    /// The motor is connected wrongly: what is analysed is the loop with a cable that is right.
    Wiring,
    /// The poles could not be computed.
    Failed(stability::StabilityError),
}

impl Display for NotAnalysed {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::NoDrive => f.write_str("this motor has no drive, so that no loop is closed"),
            Self::ForeignDrive => f.write_str("an FMU stands for the drive, and its equations are not known here"),
            Self::ForeignMechanics(what) => {
                write!(
                    f,
                    "the mechanics is {what}, whose equations are not known here: describe the axis by its bodies"
                )
            }
            Self::MastersPositionLoop => f.write_str(
                "the position loop of the master, closed over the bus (csv), is not analysed; the drive's loops are",
            ),
            Self::Fmus => f.write_str("the FMUs beside the axis are not analysed; the axis without them is"),
            Self::LateSensors => f.write_str(
                "delays of the sensors and an error of the commutation are not analysed; the loop without them is",
            ),
            Self::Wiring => f.write_str(
                "swapped wires and a lost phase of the motor are not analysed; the loop with a cable that is right is",
            ),
            Self::Failed(error) => error.fmt(f),
        }
    }
}

/// Analyses the sampled linear loop of `scenario` at standstill.
///
/// # Errors
/// [`BuildError`] says which part of the scenario cannot be built.
pub fn analyse_stability(scenario: &Scenario, depth: Depth) -> Result<Analysis, BuildError> {
    let (model, without) = match linear_loop(scenario)? {
        Ok(found) => found,
        Err(why) => return Ok(Analysis::NotPossible(why)),
    };
    Ok(match stability::analyse(&model, depth) {
        Ok(report) => Analysis::Done { report: Box::new(report), without },
        Err(error) => Analysis::NotPossible(NotAnalysed::Failed(error)),
    })
}

type Found = Result<(Loop, Option<NotAnalysed>), NotAnalysed>;

/// The linear loop of `scenario`, and which of its loops is not in it; or why there is none.
fn linear_loop(scenario: &Scenario) -> Result<Found, BuildError> {
    if coupled::replaces_the_drive(scenario) {
        return Ok(Err(NotAnalysed::ForeignDrive));
    }
    let chain = match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => chain,
        AxisMechanics::Mjcf(_) => return Ok(Err(NotAnalysed::ForeignMechanics("an MJCF file"))),
        AxisMechanics::InTheFmu => return Ok(Err(NotAnalysed::ForeignMechanics("an FMU"))),
    };
    let (drive, source, encoder) = match &scenario.actuator {
        Actuator::Prescribed | Actuator::Off => return Ok(Err(NotAnalysed::NoDrive)),
        Actuator::Pmsm { motor, encoder, drive, .. } => (drive, Source::Pmsm(*motor), encoder),
        Actuator::IdealSource { source, encoder, drive } => (drive, Source::Ideal { gain: source.gain }, encoder),
    };
    let bus = scenario.bus.as_ref();
    let closes_position = bus.is_none_or(|bus| !matches!(bus.mode, BusMode::CyclicVelocity | BusMode::ProfileVelocity));
    let model = Loop {
        drive: drive.params.clone(),
        closes_position,
        velocity_signal: velocity_signal(*encoder),
        position_feedback: match drive.position_feedback {
            Feedback::Motor => PositionFeedback::Motor,
            Feedback::Load(_) => PositionFeedback::Load,
        },
        current_tuning: drive.current_tuning,
        source,
        mechanics: plant::checked(chain)?,
        point: drive.params.current_loop().map_or_else(OperatingPoint::default, |(current, _)| OperatingPoint {
            current: Dq { d: current.d_reference, q: 0.0 },
        }),
    };
    let without = if bus.is_some_and(|bus| bus.mode == BusMode::CyclicVelocity) {
        Some(NotAnalysed::MastersPositionLoop)
    } else {
        scenario.fmus.iter().flat_map(|fmu| &fmu.outputs).any(|(_, signal)| acts(*signal)).then_some(NotAnalysed::Fmus)
    };
    let without = without.or_else(|| sensors_are_late(&scenario.actuator).then_some(NotAnalysed::LateSensors));
    let is_wrong = matches!(&scenario.actuator, Actuator::Pmsm { wiring, .. } if !wiring.is_right());
    let without = without.or(is_wrong.then_some(NotAnalysed::Wiring));
    Ok(Ok((model, without)))
}

fn velocity_signal(encoder: Encoder) -> VelocitySignal {
    if encoder.gives_velocity() { VelocitySignal::Encoder } else { VelocitySignal::Differences }
}

/// Whether what a sensor says is late, or commutation is off, which the linear loop does not know.
fn sensors_are_late(actuator: &Actuator) -> bool {
    let Some(drive) = actuator.drive() else { return false };
    let late =
        |encoder: Encoder| encoder.errors.is_some_and(|errors| errors.latency > 0.0 || errors.commutation != 0.0);
    actuator.encoder().is_some_and(late)
        || matches!(drive.position_feedback, Feedback::Load(encoder) if late(encoder))
        || drive.current_sensor.is_some_and(|sensor| sensor.delay > 0 || sensor.shift > 0.0)
}

/// Whether what an FMU gives acts on the axis.
const fn acts(signal: LoopSignal) -> bool {
    matches!(signal, LoopSignal::MotorEffort | LoopSignal::LoadEffort)
}
