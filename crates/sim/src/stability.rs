//! The linear loop of a scenario, for the analysis of its stability.
use crate::bench::plant;
use crate::coupled;
use crate::error::BuildError;
use crate::linear::{AtRest, WiredSensors};
use crate::master_at_rest::MasterOverBus;
use crate::same_loop;
use crate::speeds::Speeds;
use servobench_base::Divider;
use servobench_drive::Stage;
use servobench_drive::current::operating_point::Strategy;
use servobench_metrics::Quantity;
use servobench_plant::{Encoder, Engine, LinearMechanics};
use servobench_scenario::{Actuator, AxisMechanics, Bus, BusMode, Drive, Feedback, Scenario};
use servobench_stability::{
    self as stability, Depth, Instability, Loop, Mechanics, PositionFeedback, Report, Slowest, Source, VelocitySignal,
};
use std::fmt::{self, Display, Formatter};

/// Result of the analysis of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub enum Analysis {
    /// The poles of the loop.
    Done {
        /// Report on the poles.
        report: Box<Report>,
        /// The position loop that the master closes over the bus.
        master: Option<MasterLoop>,
        /// Parts of the scenario that are not included.
        without: Vec<NotAnalysed>,
    },
    /// A linear loop is not possible, for this reason.
    NotPossible(NotAnalysed),
}

/// The position loop that the master closes over the bus (csv).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MasterLoop {
    /// Its gain (1/s).
    pub gain: f64,
    /// The largest gain with which it is stable (1/s); `None` if it is stable and only the verdict was requested, or the loops below it
    /// are unstable.
    pub largest: Option<f64>,
    /// The poles that decay last; `None` if the loops below it are unstable.
    pub slowest: Option<Slowest>,
}

impl MasterLoop {
    /// True if the gain exceeds the largest one.
    #[must_use]
    pub fn is_unstable(&self) -> bool {
        self.largest.is_some_and(|largest| self.gain > largest)
    }
}

/// The reason why it is unstable, in words.
impl Display for MasterLoop {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let gain = Quantity::new(self.gain, "1/s");
        write!(
            f,
            "the loop is unstable: position loop of the master, gain {gain}: with the round trip of the bus and the velocity loop of the drive "
        )?;
        match self.largest.filter(|largest| *largest > 0.0) {
            Some(largest) => {
                let (factor, largest) = (Quantity::new(largest / self.gain, ""), Quantity::new(largest, "1/s"));
                write!(f, "it is stable to {largest} ({factor} ×)")
            }
            None => f.write_str("no gain makes it stable"),
        }
    }
}

/// Linear model of an MJCF file around rest, or the reason why there is none.
pub type MechanicsAtRest = Result<LinearMechanics, String>;

/// Linear model of the MJCF file of `scenario` around rest at its initial position, by `engine`; `None` without a file.
#[must_use]
pub fn mechanics_at_rest(scenario: &Scenario, engine: &dyn Engine) -> Option<MechanicsAtRest> {
    let mut still = scenario.clone();
    let AxisMechanics::Mjcf(file) = &mut still.axis.mechanics else { return None };
    file.is_smooth = true;
    still.initial.load_velocity = 0.0;
    let built = plant::mechanics(&still, engine).map_err(|error| error.to_string());
    let h = scenario.base_rate.period();
    Some(built.and_then(|(mut mechanics, _)| {
        LinearMechanics::around_rest(mechanics.as_mut(), h).map_err(|error| error.to_string())
    }))
}

/// Parts that are not analysed, with the reason.
#[derive(Debug, Clone, PartialEq)]
pub enum NotAnalysed {
    /// The motor is not commanded by a loop.
    NoDrive,
    /// The drive is an FMU, or an FMU provides the output of the drive.
    ForeignDrive,
    /// The mechanics are only an FMU.
    FmuMechanics,
    /// The mechanics are an MJCF file without a linear model around rest, for this reason.
    Mjcf(String),
    /// FMUs beside the axis act on it: the axis without them is analysed.
    Fmus,
    /// The commutation is misaligned while a current flows at standstill: the loop with an aligned commutation is analysed.
    Commutation,
    /// The commutation is misaligned, and without magnets the current that it turns makes all of the torque.
    CommutationWithoutMagnets,
    /// Function blocks make the program: only a run shows if it stays at the speed at which the gain schedule is unstable.
    GainSchedule(Box<Instability>),
    /// The motor is connected wrongly: the loop with a correct cable is analysed.
    Wiring,
    /// The poles could not be computed.
    Failed(stability::StabilityError),
}

impl Display for NotAnalysed {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Self::NoDrive => f.write_str("this motor has no drive, so that no loop is closed"),
            Self::ForeignDrive => f.write_str("an FMU stands for the drive, and its equations are not known here"),
            Self::FmuMechanics => f.write_str(
                "the mechanics is an FMU, whose equations are not known here: describe the axis by its bodies, too",
            ),
            Self::Mjcf(why) => write!(f, "the MJCF file has no linear model: {why}"),
            Self::Fmus => f.write_str("the FMUs beside the axis are not analysed; the axis without them is"),
            Self::Commutation => f.write_str(
                "a commutation that is off turns the current that the d axis has at standstill, which is not analysed; the loop with a \
                 commutation that is right is",
            ),
            Self::CommutationWithoutMagnets => f.write_str(
                "a commutation that is off turns the current that gives a motor without magnets its torque, which is not analysed",
            ),
            Self::GainSchedule(instability) => {
                write!(f, "whether function blocks stay at this speed only a run tells: {instability}")
            }
            Self::Wiring => f.write_str(
                "swapped wires and a lost phase of the motor are not analysed; the loop with a cable that is right is",
            ),
            Self::Failed(error) => error.fmt(f),
        }
    }
}

/// Analyses the sampled linear loop of `scenario`: at standstill and, with a gain schedule, at each speed at which `speeds` stay for
/// longer than a period of its pole. Without `speeds` that time is unknown. `model` is the result of [`mechanics_at_rest`] for an MJCF
/// file.
///
/// # Errors
/// [`BuildError`] names the part of the scenario that cannot be built.
pub fn analyse_stability(
    scenario: &Scenario,
    depth: Depth,
    speeds: Option<&Speeds>,
    model: Option<&MechanicsAtRest>,
) -> Result<Analysis, BuildError> {
    let (model, sensors, mut without) = match linear_loop(scenario, model)? {
        Ok(found) => found,
        Err(why) => return Ok(Analysis::NotPossible(why)),
    };
    let failed = |error| Ok(Analysis::NotPossible(NotAnalysed::Failed(error)));
    let running = || AtRest::new(&model, &sensors, None).map(Box::new);
    let mut report = match same_loop::report(&model, &sensors, depth)? {
        Ok(report) => Box::new(report),
        Err(error) => return failed(error),
    };
    if report.is_stable() {
        let stays = |range| speeds.map_or(f64::INFINITY, |speeds| speeds.longest_within(&range));
        match stability::analyse_schedule(&model, running()?, stays) {
            Ok(found) if speeds.is_some() => report.instability = found,
            Ok(found) => without.extend(found.map(|found| NotAnalysed::GainSchedule(Box::new(found)))),
            Err(error) => return failed(error),
        }
    }
    let Some(master) = scenario.bus.as_ref().and_then(over_bus) else {
        return Ok(Analysis::Done { report, master: None, without });
    };
    let mut closed = MasterLoop { gain: master.gains.gain, largest: None, slowest: None };
    if report.is_stable() {
        let model = Loop { master_cycle: Some(master.cycle), ..model };
        let running = Box::new(AtRest::new(&model, &sensors, Some(&master))?);
        match stability::analyse_master(&model, running, depth) {
            Ok((slowest, margin)) => {
                (closed.slowest, closed.largest) = (Some(slowest), margin.map(|factor| factor * closed.gain));
            }
            Err(error) => return failed(error),
        }
    }
    Ok(Analysis::Done { report, master: Some(closed), without })
}

/// The position loop that the master closes over `bus`, if it does.
fn over_bus(bus: &Bus) -> Option<MasterOverBus> {
    let gains = bus.position_loop.filter(|gains| gains.gain > 0.0)?;
    Some(MasterOverBus { gains, cycle: Divider::new(bus.cycle)?, delay: bus.delay as usize })
}

type Found = Result<(Loop, WiredSensors, Vec<NotAnalysed>), NotAnalysed>;

/// The linear loop of `scenario` and the parts left out of it, or the reason why there is none.
fn linear_loop(scenario: &Scenario, model: Option<&MechanicsAtRest>) -> Result<Found, BuildError> {
    if coupled::replaces_the_drive(scenario) {
        return Ok(Err(NotAnalysed::ForeignDrive));
    }
    let mechanics = match (&scenario.axis.mechanics, model) {
        (AxisMechanics::Bodies(chain), _) => Mechanics::Bodies(plant::checked(chain)?),
        (AxisMechanics::Mjcf(_), Some(Ok(linear))) => Mechanics::Model {
            coordinate: scenario.axis.motor_motion,
            transmission: scenario.axis.transmission,
            linear: linear.clone(),
        },
        (AxisMechanics::Mjcf(_), Some(Err(why))) => return Ok(Err(NotAnalysed::Mjcf(why.clone()))),
        (AxisMechanics::Mjcf(_), None) => return Ok(Err(NotAnalysed::Mjcf("no engine was asked for one".to_owned()))),
        (AxisMechanics::InTheFmu, _) => return Ok(Err(NotAnalysed::FmuMechanics)),
    };
    let (drive, source, encoder) = match &scenario.actuator {
        Actuator::Prescribed | Actuator::Off(_) => return Ok(Err(NotAnalysed::NoDrive)),
        Actuator::Pmsm { motor, effects, inverter, encoder, drive, .. } => {
            let motor = effects.linearised(motor);
            let motor = inverter.as_ref().map_or(motor, |inverter| inverter.linearised(&motor));
            (drive, Source::Pmsm(motor), encoder)
        }
        Actuator::IdealSource { source, encoder, drive } => (drive, Source::Ideal { gain: source.gain }, encoder),
    };
    let wired = WiredSensors {
        motor: *encoder,
        load: match drive.position_feedback {
            Feedback::Motor => None,
            Feedback::Load(encoder) => Some(encoder),
        },
        current: drive.current_sensor,
    };
    let bus = scenario.bus.as_ref();
    let closes_position = bus.is_none_or(|bus| !matches!(bus.mode, BusMode::CyclicVelocity | BusMode::ProfileVelocity));
    let (params, d_current) = operated(drive, &source);
    let model = Loop {
        drive: params,
        closes_position,
        master_cycle: None,
        velocity_signal: velocity_signal(*encoder),
        position_feedback: match drive.position_feedback {
            Feedback::Motor => PositionFeedback::Motor,
            Feedback::Load(_) => PositionFeedback::Load,
        },
        current_tuning: drive.current_tuning,
        source,
        mechanics,
        d_current,
    };
    let commutation = encoder.errors.map_or(0.0, |errors| errors.commutation);
    if matches!(&model.source, Source::Pmsm(motor) if motor.flux_linkage == 0.0) && commutation != 0.0 {
        return Ok(Err(NotAnalysed::CommutationWithoutMagnets));
    }
    let acts = scenario.fmus.iter().any(|fmu| fmu.efforts().next().is_some());
    let turns = model.d_current != 0.0 && commutation != 0.0;
    let is_wrong = matches!(&scenario.actuator, Actuator::Pmsm { wiring, .. } if !wiring.is_right());
    let left_out = [(acts, NotAnalysed::Fmus), (turns, NotAnalysed::Commutation), (is_wrong, NotAnalysed::Wiring)];
    let without = left_out.into_iter().filter_map(|(is_left_out, what)| is_left_out.then_some(what)).collect();
    Ok(Ok((model, wired, without)))
}

/// The drive linearised without effort, at its d-axis current there. If motor or estimate has no magnets,
/// maximum torque per ampere has no slope there; around any effort the loop is that at the d-axis current of that effort, since both
/// axes of the current loop respond alike, and the current of the largest effort is used.
fn operated(drive: &Drive, source: &Source) -> (servobench_drive::Params, f64) {
    let mut params = drive.params.clone();
    let Stage::Current { params: current, .. } = &mut params.stage else { return (params, 0.0) };
    let has_no_magnets =
        matches!(source, Source::Pmsm(motor) if motor.flux_linkage == 0.0) || current.motor.flux_linkage == 0.0;
    if current.operation.strategy == Strategy::Mtpa && has_no_magnets {
        current.d_reference = current.motor.mtpa_at_current(current.max_current);
    }
    let d_current = current.d_reference;
    (params, d_current)
}

fn velocity_signal(encoder: Encoder) -> VelocitySignal {
    if encoder.gives_velocity() { VelocitySignal::Encoder } else { VelocitySignal::Differences }
}
