//! Construction of the loop from a scenario and an engine.

pub(crate) mod fmu;
mod objections;
pub(crate) mod plant;

use crate::axis::Axis;
use crate::closed_loop::{ClosedLoop, Control, EncoderInput, Mounting, Shaft, Source, State};
use crate::coupled::{self, ConnectionDelay, Coupled, FmuDoubt, FmuOpener, NoFmus};
use crate::disturbance::Disturbances;
use crate::error::{BuildError, check_length, check_ticks};
use crate::loose_sensors::LooseSensors;
use crate::machine::Machine;
use crate::network::Network;
use crate::program::Program;
use servobench_base::{Rate, Setpoint, Tick};
use servobench_drive::measurement;
use servobench_drive::unwrap::Unwrap;
use servobench_fieldbus::LinkFault;
use servobench_metrics::{JUDGED_BY, Occasion};
use servobench_plant::inverter::Modulation;
use servobench_plant::pmsm::Effects;
use servobench_plant::{Chain, Encoder, EncoderState, Engine, SourceOutput};
use servobench_scenario::{self as scenario, Actuator, AxisMechanics, Feedback, LoopSignal, Scenario};
use servobench_signals::{
    Amplifier, Equipment, Erring, InverterEffects, Motor, MotorEffects, NotRecorded, Rates, Selection, Signal, Unit,
};
use servobench_trace::{About, Event};

/// Time for which a run continues after its program, if the scenario sets no duration (s).
const TAIL: f64 = 0.5;
/// Largest size of a recording of every tick (GB), in memory or in files. It is the same on every machine, because the metrics
/// depend on it: a larger recording has `record.rate`.
pub const RECORDING_LIMIT: f64 = 4.0;

/// Length of a run of `scenario` with `program` planned (s).
#[must_use]
pub fn run_length(scenario: &Scenario, program: &Program) -> f64 {
    scenario.duration.unwrap_or(program.end() + TAIL)
}

/// A closed loop at tick 0, and what is recorded of it.
pub struct Bench {
    pub(crate) ticks: u64,
    pub(crate) closed_loop: Loop,
}

/// The axis, alone or with attached FMUs.
pub(crate) enum Loop {
    Alone(Box<Machine>),
    Coupled(Box<Coupled>),
}

impl Bench {
    /// Builds the loop of `scenario` on `engine`.
    ///
    /// # Errors
    /// [`BuildError`] names the part of the scenario that cannot be built.
    pub fn new(scenario: &Scenario, engine: &dyn Engine) -> Result<Self, BuildError> {
        Self::with_fmus(scenario, engine, &NoFmus)
    }

    /// Duration of a run of `scenario` that covers all of it (s): as long as the scenario sets, or half a second longer than its program,
    /// and in any case as long as the program, in whole base ticks.
    ///
    /// # Errors
    /// [`BuildError`] for a program that cannot be planned.
    pub fn length(scenario: &Scenario) -> Result<f64, BuildError> {
        let (base_rate, program) = (scenario.base_rate, Program::new(scenario)?);
        let ticks = base_rate.tick_at(run_length(scenario, &program));
        let end = base_rate.tick_at(program.end());
        let end = if base_rate.time(end) < program.end() { Tick(end.0 + 1) } else { end };
        Ok(base_rate.time(ticks.max(end)))
    }

    /// The lumped bodies of `scenario` as passed to engines; `None` if a user's file describes the mechanics.
    ///
    /// # Errors
    /// [`BuildError::Parameter`] names the parameter that is out of its bound.
    pub fn chain(scenario: &Scenario) -> Result<Option<Chain>, BuildError> {
        match &scenario.axis.mechanics {
            AxisMechanics::Bodies(chain) => plant::checked(chain).map(Some),
            AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => Ok(None),
        }
    }

    /// Delays of the connections between axis and FMUs; empty without FMUs.
    #[must_use]
    pub fn delays(&self) -> &[ConnectionDelay] {
        match &self.closed_loop {
            Loop::Alone(_) => &[],
            Loop::Coupled(coupled) => coupled.delays(),
        }
    }

    /// Doubts about the FMUs beside the axis.
    #[must_use]
    pub fn fmu_doubts(&self) -> &[FmuDoubt] {
        match &self.closed_loop {
            Loop::Alone(_) => &[],
            Loop::Coupled(coupled) => coupled.doubts(),
        }
    }

    /// Builds the loop of `scenario` on `engine`, with `fmu_opener` to open its FMUs.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_fmus(scenario: &Scenario, engine: &dyn Engine, fmu_opener: &dyn FmuOpener) -> Result<Self, BuildError> {
        let base_rate = scenario.base_rate;
        let program = Program::new(scenario)?;
        let duration = run_length(scenario, &program);
        let bus = scenario.bus.as_ref();
        check_expectations(scenario)?;
        check_length(None, duration)?;
        let ticks = base_rate.tick_at(duration).0 + 1;
        check_ticks(ticks, base_rate)?;
        let disturbances = Disturbances::new(&scenario.disturbances, base_rate, ticks)?;

        let (mechanics, bodies) = plant::mechanics(scenario, engine)?;
        let direction = scenario.direction();
        let motor = mechanics.bodies()[0];
        let motor_before = direction * motor.position;
        let mut power = plant::power_stage(&scenario.actuator, direction * motor.velocity, base_rate.period())?;
        let is_replaced = coupled::replaces_the_drive(scenario);
        let mut control = match &scenario.actuator {
            Actuator::Prescribed | Actuator::Off(_) => None,
            _ if is_replaced => None,
            Actuator::Pmsm { encoder, drive, .. } | Actuator::IdealSource { encoder, drive, .. } => {
                Some(Control::new(drive, *encoder, base_rate.period())?)
            }
        };

        let sensors = if is_replaced { loose_sensors(scenario)? } else { None };
        let equipment = equipment(scenario, bodies.len() == 3);
        let rates = writer_rates(scenario);
        let all = Selection::all(&equipment, &rates);
        let wanted = recorded(&all, &scenario.record.channels)?;
        let selection = measured(&all, &scenario.record.channels)?;
        if scenario.fmus.is_empty() && !selection.signals().iter().any(|signal| is_power(*signal)) {
            power.leave_power_out();
        }
        let (rate, record_every) = recorded_rate(scenario, selection.signals().len(), ticks, duration)?;
        let rows = ticks.div_ceil(u64::from(record_every));
        let about = About {
            scenario: scenario.name.clone(),
            engine: engine.name().to_string(),
            axis_unit: equipment.axis.unit().into(),
            bodies,
            overrides: scenario.overrides.iter().map(ToString::to_string).collect(),
        };
        let rows = usize::try_from(rows).unwrap_or(usize::MAX);
        let mut recorder = selection.recorder(about, rate, rows);
        if record_every > 1 {
            recorder.note_event(thinned_event(rate, duration));
        }
        let source = match (bus, &mut control) {
            (None, _) => {
                for made in program.moves() {
                    recorder.note_move(made);
                }
                Source::Program(Box::new(program))
            }
            (Some(_), None) => return Err(BuildError::NoDriveOnTheBus),
            (Some(bus), Some(control)) => {
                let (network, delays) = Network::new(scenario, bus, program, &control.params, &mut recorder)?;
                // A bias on the axis acts in the opposite direction on a motor mounted in reverse.
                control.params.feedforward.bias *= direction;
                Source::Network(Box::new(network), delays.sum() as f64 * base_rate.period())
            }
        };
        let closed_loop = ClosedLoop {
            base_rate,
            state: State {
                source,
                begun: None,
                upcoming: None,
                control,
                sensors,
                power,
                motor_before,
                shaft: Shaft { effort: 0.0, position: motor.position },
            },
            mechanics,
            prescribed: matches!(scenario.actuator, Actuator::Prescribed),
            mounting: Mounting { transmission: scenario.axis.transmission, direction },
            disturbances,
            end_stops: plant::end_stops(scenario)?,
            switches: plant::switches(scenario)?,
        };
        let machine = Machine::new(Axis::new(closed_loop, wanted, recorder, record_every), base_rate);
        let closed_loop = if scenario.fmus.is_empty() {
            Loop::Alone(Box::new(machine))
        } else {
            Loop::Coupled(Box::new(Coupled::new(scenario, machine, ticks, (&equipment, &rates), fmu_opener)?))
        };
        Ok(Self { ticks, closed_loop })
    }
}

impl Control {
    /// The drive at rest at zero, with the encoder `motor_encoder` on the motor.
    fn new(drive: &scenario::Drive, motor_encoder: Encoder, h: f64) -> Result<Self, BuildError> {
        let params = drive.params.clone();
        let state = servobench_drive::State::new(&params, Setpoint::default())?;
        let load_encoder = match drive.position_feedback {
            Feedback::Motor => None,
            Feedback::Load(encoder) => Some(EncoderInput::new(encoder, 1, h)?),
        };
        let mut motor_encoder = EncoderInput::new(motor_encoder, 0, h)?;
        if matches!(params.blocks.measurement, Some(measurement::Params::Mt(_))) {
            motor_encoder.encoder = motor_encoder.encoder.with_timed_edges(0, h);
        }
        Ok(Self { params, state, motor_encoder, load_encoder })
    }
}

impl EncoderInput {
    /// Encoder number `number` of the axis, in ticks of `h` (s).
    pub(crate) fn new(encoder: Encoder, number: u32, h: f64) -> Result<Self, BuildError> {
        let range = encoder.errors.and_then(|errors| errors.range);
        Ok(Self { encoder: EncoderState::new(encoder, number, h)?, unwrap: range.map(Unwrap::new) })
    }
}

/// Checks that the link can have the faults that are expected of it.
fn check_expectations(scenario: &Scenario) -> Result<(), BuildError> {
    let available = || LinkFault::ALL.map(LinkFault::name);
    for (index, expected) in scenario.requirements.expected.iter().enumerate() {
        let Occasion::Fault { fault, who } = &expected.on else { continue };
        if who == "link" && !available().iter().any(|name| name.eq_ignore_ascii_case(fault)) {
            return Err(BuildError::NoSuchFault { index, fault: fault.clone(), available: available().to_vec() });
        }
    }
    Ok(())
}

/// The `wanted` signals among `all` signals of the axis; all when the list is empty.
fn recorded(all: &Selection, wanted: &[Signal]) -> Result<Selection, BuildError> {
    let available = || all.signals().to_vec();
    all.of(wanted).map_err(|NotRecorded { signal }| BuildError::UnknownChannel { signal, available: available() })
}

/// The recorded signals with those by which the run is judged; with a current also its ripple, which is measured with it.
fn measured(all: &Selection, wanted: &[Signal]) -> Result<Selection, BuildError> {
    let is_current = |signal: &Signal| matches!(signal, Signal::CurrentD | Signal::CurrentQ);
    let ripple = [Signal::CurrentPeak, Signal::CurrentRms].into_iter().filter(|_| wanted.iter().any(is_current));
    let besides = JUDGED_BY.into_iter().filter(|_| !wanted.is_empty()).chain(ripple);
    let besides = besides.filter(|signal| all.has(*signal));
    recorded(all, &wanted.iter().copied().chain(besides).collect::<Vec<_>>())
}

/// True for a signal that needs the motor's powers, which include the mean square of the current.
fn is_power(signal: Signal) -> bool {
    signal.unit() == Unit::Watt || signal == Signal::CurrentRms
}

/// Largest number of channels of the axis of `scenario`: with a body between motor and load, which its engine may find.
#[must_use]
pub fn most_channels(scenario: &Scenario) -> usize {
    let equipment = equipment(scenario, true);
    Signal::ALL.iter().filter(|signal| signal.presence().holds(&equipment)).count()
}

/// Equipment of the axis of `scenario`, which determines its channels; `table` is a body between motor and load.
fn equipment(scenario: &Scenario, table: bool) -> Equipment {
    let effort_unit = scenario.axis.motor_motion.effort_unit();
    let is_replaced = coupled::replaces_the_drive(scenario);
    let of = |effects: &Effects| MotorEffects { iron_loss: effects.iron.is_some(), thermal_model: effects.warms_up() };
    let effects = match &scenario.actuator {
        Actuator::Pmsm { effects, .. } => of(effects),
        Actuator::Off(Some(idle)) => of(&idle.effects),
        Actuator::Prescribed | Actuator::Off(None) | Actuator::IdealSource { .. } => MotorEffects::default(),
    };
    let is_idle = matches!(scenario.actuator, Actuator::Off(Some(_)));
    let amplifier = match &scenario.actuator {
        Actuator::Prescribed | Actuator::Off(_) => None,
        Actuator::Pmsm { .. } => Some(Amplifier::Current),
        Actuator::IdealSource { source, .. } => Some(Amplifier::Ideal {
            output_unit: match source.output {
                SourceOutput::Voltage => "V",
                SourceOutput::Effort => effort_unit,
            },
        }),
    };
    Equipment {
        name: scenario.axis.name,
        axis: scenario.axis.motion,
        motor_coordinate: scenario.axis.motor_motion,
        disturbed: [scenario::DisturbedBody::Motor, scenario::DisturbedBody::Load]
            .map(|body| is_disturbed(scenario, body)),
        table,
        end_stops: scenario.axis.end_stops.is_some(),
        inverter: match &scenario.actuator {
            Actuator::Pmsm { inverter, link, .. } => InverterEffects {
                losses: inverter.is_some(),
                switching: inverter.is_some_and(|inverter| inverter.modulation == Modulation::Switching),
                link: link.is_some(),
            },
            _ => InverterEffects::default(),
        },
        bus: scenario.bus.is_some(),
        effects,
        erring: if is_replaced { erring_alone(scenario) } else { erring(&scenario.actuator) },
        amplifier: if is_replaced { None } else { amplifier },
        motor: match amplifier {
            _ if gives(scenario, LoopSignal::Effort) => Motor::Effort,
            _ if gives(scenario, LoopSignal::VoltageQ) => Motor::Currents,
            Some(Amplifier::Current) => Motor::Currents,
            Some(Amplifier::Ideal { .. }) => Motor::Effort,
            None if is_idle => Motor::Effort,
            None => Motor::Motion,
        },
    }
}

/// Sensors of the drive that have errors.
fn erring(actuator: &Actuator) -> Erring {
    let Some(drive) = actuator.drive() else { return Erring::default() };
    let motor = actuator.encoder().and_then(|encoder| encoder.errors);
    Erring {
        encoders: [
            motor.is_some(),
            matches!(drive.position_feedback, Feedback::Load(encoder) if encoder.errors.is_some()),
        ],
        // Sensors at the legs measure another current than the motor's if its wires are swapped.
        current: matches!(actuator, Actuator::Pmsm { wiring, .. }
            if drive.current_sensor.is_some() || motor.is_some() || wiring.swapped.is_some()),
        velocity: drive.params.blocks.measurement.is_some(),
    }
}

/// Sensors that are not ideal, where no firmware reads them.
fn erring_alone(scenario: &Scenario) -> Erring {
    let is_ideal = |encoder: Encoder| encoder == Encoder::default();
    let Some(drive) = scenario.actuator.drive() else { return Erring::default() };
    Erring {
        encoders: [
            scenario.actuator.encoder().is_some_and(|encoder| !is_ideal(encoder)),
            matches!(drive.position_feedback, Feedback::Load(encoder) if !is_ideal(encoder)),
        ],
        current: drive.current_sensor.is_some() && gives(scenario, LoopSignal::VoltageQ),
        velocity: false,
    }
}

/// The sensors of an axis without firmware; `None` if they are ideal.
fn loose_sensors(scenario: &Scenario) -> Result<Option<LooseSensors>, BuildError> {
    let erring = erring_alone(scenario);
    if erring == Erring::default() {
        return Ok(None);
    }
    let h = scenario.base_rate.period();
    let load = scenario.actuator.drive().and_then(|drive| match drive.position_feedback {
        Feedback::Load(encoder) => Some(encoder),
        Feedback::Motor => None,
    });
    let motor = EncoderInput::new(scenario.actuator.encoder().unwrap_or_default(), 0, h)?;
    let load = load.map(|encoder| EncoderInput::new(encoder, 1, h)).transpose()?;
    Ok(Some(LooseSensors::new(motor, load, erring.current)))
}

/// True if an FMU provides `signal`.
fn gives(scenario: &Scenario, signal: LoopSignal) -> bool {
    scenario.fmus.iter().flat_map(|fmu| &fmu.outputs).any(|(_, given)| *given == signal)
}

/// True if the scenario or an FMU disturbs the body.
fn is_disturbed(scenario: &Scenario, body: scenario::DisturbedBody) -> bool {
    let by_fmus = match body {
        scenario::DisturbedBody::Motor => LoopSignal::MotorEffort,
        scenario::DisturbedBody::Load => LoopSignal::LoadEffort,
    };
    scenario.disturbances.iter().any(|disturbance| disturbance.on == body)
        || scenario.fmus.iter().flat_map(|fmu| &fmu.outputs).any(|(_, signal)| *signal == by_fmus)
}

/// Rates at which each writer updates its channels.
fn writer_rates(scenario: &Scenario) -> Rates {
    let base_rate = scenario.base_rate;
    let drive = scenario.actuator.drive().map(|drive| &drive.params);
    let every = |ticks: u32| Rate::new(base_rate.hertz() / ticks.max(1)).unwrap_or(base_rate);
    let bus = scenario.bus.as_ref();
    Rates {
        base: base_rate,
        task: bus.map_or(base_rate, |bus| every(bus.cycle.saturating_mul(bus.motion_every))),
        bus: bus.map_or(base_rate, |bus| every(bus.cycle)),
        position: drive.map_or(base_rate, servobench_drive::Params::position_rate),
        velocity: drive.map_or(base_rate, servobench_drive::Params::velocity_rate),
        current: drive.and_then(servobench_drive::Params::current_loop).map_or(base_rate, |(_, rate)| rate),
    }
}

/// Rate of the rows, and base ticks per row: every tick, so that the metrics do not depend on
/// `record.rate`; at `record.rate` where that would be too large.
///
/// # Errors
/// [`BuildError::RecordingTooLarge`] if that is too large as well.
fn recorded_rate(scenario: &Scenario, channels: usize, ticks: u64, duration: f64) -> Result<(Rate, u32), BuildError> {
    let (base_rate, rate) = (scenario.base_rate, scenario.record.rate);
    let gigabytes = |every: u32| channels as f64 * ticks.div_ceil(u64::from(every)) as f64 * 8e-9;
    if gigabytes(1) <= RECORDING_LIMIT {
        return Ok((base_rate, 1));
    }
    let every = base_rate.divider(rate)?.ticks();
    let gigabytes = gigabytes(every);
    if gigabytes <= RECORDING_LIMIT {
        return Ok((rate, every));
    }
    Err(BuildError::RecordingTooLarge { channels, rate: rate.hertz(), duration, gigabytes, limit: RECORDING_LIMIT })
}

fn thinned_event(rate: Rate, duration: f64) -> Event {
    let message = format!(
        "every tick would take more than {RECORDING_LIMIT} GB: measured at {} Hz, and what is faster than half of that is \
         folded; name fewer `record.channels` to measure at every tick",
        rate.hertz()
    );
    Event::new(0.0, duration, "recorder", message)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 40 channels of 16 kHz fill 4 GB in 781 s; 1 kHz lasts sixteen times as long.
    #[test]
    fn every_tick_is_kept_as_long_as_it_fits() {
        let text = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\n[motor]\nkind = \"prescribed\"\n\
                    [record]\nrate = \"1 kHz\"\n";
        let scenario = scenario::parse("test", text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        let rate_of = |seconds: u32| recorded_rate(&scenario, 40, 16_000 * u64::from(seconds), f64::from(seconds));
        assert_eq!(rate_of(780).map(|(rate, every)| (rate.hertz(), every)), Ok((16_000, 1)));
        assert_eq!(rate_of(790).map(|(rate, every)| (rate.hertz(), every)), Ok((1_000, 16)));
        assert!(matches!(rate_of(13_000), Err(BuildError::RecordingTooLarge { rate: 1_000, .. })));
    }
}
