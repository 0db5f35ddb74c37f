//! From a scenario and an engine to everything that the loop needs.
use crate::channels::{Amplifier, Equipment, Selection, WriterRates};
use crate::error::BuildError;
use crate::limits::LimitWatch;
use crate::power::PowerStage;
use crate::program::Program;
use servobench_base::{Dq, Rate, Rotation, Setpoint};
use servobench_drive::{self as drive, Firmware, current, feedforward, velocity};
use servobench_plant::{self as plant, BodyState, Chain, Encoder, Engine, Mechanics, MechanicsSetup, inverter, pmsm};
use servobench_scenario::{self as scenario, Scenario};
use servobench_trace::{About, Recorder};

/// How long a run goes on after its program, when the scenario does not say (s).
const TAIL: f64 = 0.5;
/// Memory granted to one recording (GB).
const RECORDING_LIMIT: f64 = 4.0;

/// A closed loop at tick 0.
pub struct Bench {
    pub(crate) base_rate: Rate,
    pub(crate) ticks: u64,
    pub(crate) program: Program,
    pub(crate) firmware: Option<Firmware>,
    pub(crate) power: PowerStage,
    pub(crate) mechanics: Box<dyn Mechanics>,
    /// Whether the motor follows the set-point exactly.
    pub(crate) prescribed: bool,
    /// Axis coordinate per motor coordinate.
    pub(crate) transmission: f64,
    pub(crate) motor_encoder: Encoder,
    pub(crate) load_encoder: Option<Encoder>,
    pub(crate) disturbances: Vec<scenario::Disturbance>,
    pub(crate) selection: Selection,
    pub(crate) recorder: Recorder,
    /// Base ticks from row to row, and to the next one.
    pub(crate) record_every: u32,
    pub(crate) ticks_to_row: u32,
    pub(crate) watch: LimitWatch,
}

impl Bench {
    /// Builds the loop of `scenario` on `engine`.
    ///
    /// # Errors
    /// [`BuildError`] says which part of the scenario cannot be built.
    pub fn new(scenario: &Scenario, engine: &dyn Engine) -> Result<Self, BuildError> {
        let base_rate = scenario.base_rate;
        let program = Program::plan(&scenario.program)?;
        let duration = scenario.duration.unwrap_or(program.end() + TAIL);
        let ticks = base_rate.tick_at(duration).0 + 1;

        let (mechanics, bodies) = mechanics(scenario, engine)?;
        let (power, motor_encoder) = power_stage(scenario)?;
        let firmware = match scenario.motor {
            scenario::Motor::Prescribed => None,
            _ if !scenario.drive.enabled => None,
            _ => Some(Firmware::new(firmware(scenario)?, Setpoint::default())?),
        };
        let load_encoder = scenario.drive.load_encoder.map(encoder).transpose()?;
        if scenario.drive.position_feedback == scenario::Feedback::Load && load_encoder.is_none() {
            return Err(BuildError::Contradiction(
                "`drive.position_feedback` is \"load\" but there is no `[drive.load_encoder]`",
            ));
        }

        let rotary = |motion| motion == scenario::Motion::Rotary;
        let equipment = Equipment {
            axis_unit: if rotary(scenario.axis.motion) { "rad" } else { "m" },
            effort_unit: if rotary(scenario.axis.motor_motion) { "N m" } else { "N" },
            table: bodies.len() == 3,
            amplifier: match power {
                PowerStage::Pmsm { .. } => Some(Amplifier::Current),
                PowerStage::Ideal { .. } => Some(Amplifier::Ideal),
                PowerStage::Off => None,
            },
        };
        let rates = WriterRates {
            base: base_rate,
            position: scenario.drive.position.rate,
            velocity: scenario.drive.velocity.rate,
            current: scenario.drive.current.as_ref().map_or(base_rate, |current| current.rate),
        };
        let selection = Selection::new(&scenario.record.channels, &equipment, &rates)?;
        let record_every = base_rate.divider(scenario.record.rate)?.ticks();
        let rows = ticks.div_ceil(u64::from(record_every));
        check_memory(selection.specs.len(), rows, scenario.record.rate, duration)?;
        let about = About {
            scenario: scenario.name.clone(),
            engine: engine.name().into(),
            axis_unit: equipment.axis_unit.into(),
            bodies,
        };
        let rows = usize::try_from(rows).unwrap_or(usize::MAX);
        let mut recorder = Recorder::new(about, scenario.record.rate, selection.specs.clone(), rows);
        for made in program.moves(equipment.axis_unit) {
            recorder.note_move(made);
        }
        Ok(Self {
            base_rate,
            ticks,
            program,
            firmware,
            power,
            mechanics,
            prescribed: matches!(scenario.motor, scenario::Motor::Prescribed),
            transmission: scenario.axis.transmission,
            motor_encoder,
            load_encoder,
            disturbances: scenario.disturbances.clone(),
            selection,
            recorder,
            record_every,
            ticks_to_row: 0,
            watch: LimitWatch::default(),
        })
    }
}

fn check_memory(channels: usize, rows: u64, rate: Rate, duration: f64) -> Result<(), BuildError> {
    let gigabytes = channels as f64 * rows as f64 * 8e-9;
    if gigabytes <= RECORDING_LIMIT {
        return Ok(());
    }
    Err(BuildError::TooLong { channels, rate: rate.hertz(), duration, gigabytes, limit: RECORDING_LIMIT })
}

/// The mechanics at tick 0 and the names of its bodies.
fn mechanics(scenario: &Scenario, engine: &dyn Engine) -> Result<(Box<dyn Mechanics>, Vec<String>), BuildError> {
    let drive = match scenario.motor {
        scenario::Motor::Prescribed => plant::Drive::Prescribed,
        _ => plant::Drive::Effort,
    };
    let (model, names) = match &scenario.axis.mechanics {
        scenario::AxisMechanics::Bodies(bodies) => {
            let names: Vec<String> = bodies.iter().map(|body| body.name.to_owned()).collect();
            (plant::Model::Chain(chain(&scenario.axis, bodies)?), names)
        }
        scenario::AxisMechanics::Mjcf(mjcf) => {
            let model = plant::MjcfModel {
                xml: mjcf.xml.clone(),
                path: mjcf.path.clone(),
                motor_joint: mjcf.motor_joint.clone(),
                load_joint: mjcf.load_joint.clone(),
                actuator: mjcf.actuator.clone(),
            };
            let names = if model.motor_joint == model.load_joint { &["motor"][..] } else { &["motor", "load"] };
            (plant::Model::Mjcf(model), names.iter().map(|name| (*name).to_owned()).collect())
        }
    };
    let mut initial = vec![BodyState::default(); names.len()];
    if let Some(load) = initial.last_mut() {
        *load = BodyState { position: scenario.initial.load_position, velocity: scenario.initial.load_velocity };
    }
    if let [motor] = initial.as_mut_slice() {
        motor.position /= scenario.axis.transmission;
        motor.velocity /= scenario.axis.transmission;
    }
    let setup = MechanicsSetup { model, drive, step: scenario.base_rate.period(), initial };
    Ok((engine.build(&setup)?, names))
}

fn chain(axis: &scenario::Axis, bodies: &[scenario::Body]) -> Result<Chain, BuildError> {
    let coordinate = |motion| match motion {
        scenario::Motion::Linear => plant::Coordinate::Linear,
        scenario::Motion::Rotary => plant::Coordinate::Rotary,
    };
    let links = bodies
        .iter()
        .filter_map(|body| body.coupling)
        .map(|coupling| plant::Link { stiffness: coupling.stiffness, damping: coupling.damping })
        .collect();
    let bodies = bodies
        .iter()
        .enumerate()
        .map(|(i, body)| plant::Body {
            name: body.name,
            coordinate: coordinate(if i == 0 { axis.motor_motion } else { axis.motion }),
            inertia: body.inertia,
            transmission: if i == 0 { axis.transmission } else { 1.0 },
            viscous: body.viscous,
            dry: plant::DryFriction {
                coulomb: body.coulomb,
                breakaway: body.breakaway,
                stribeck_velocity: body.stribeck_velocity,
            },
            bias: body.bias,
        })
        .collect();
    Ok(Chain::new(bodies, links)?)
}

fn encoder(encoder: scenario::Encoder) -> Result<Encoder, BuildError> {
    let encoder = Encoder { increment: encoder.resolution };
    encoder.check()?;
    Ok(encoder)
}

/// The power stage and the encoder on the motor.
fn power_stage(scenario: &Scenario) -> Result<(PowerStage, Encoder), BuildError> {
    let on = scenario.drive.enabled;
    match &scenario.motor {
        scenario::Motor::Prescribed => Ok((PowerStage::Off, Encoder::default())),
        scenario::Motor::IdealSource(source) => {
            let encoder = encoder(source.encoder)?;
            let stage = PowerStage::Ideal { gain: source.gain, limit: source.limit };
            Ok((if on { stage } else { PowerStage::Off }, encoder))
        }
        scenario::Motor::Pmsm(motor) => {
            let params = pmsm::Params {
                pole_pairs: f64::from(motor.pole_pairs),
                resistance: motor.resistance,
                inductance: Dq { d: motor.inductance_d, q: motor.inductance_q },
                flux_linkage: motor.flux_linkage,
            };
            params.check()?;
            let encoder = encoder(motor.encoder)?;
            let (state, u_dc) = (pmsm::State::default(), scenario.drive.dc_link);
            let stage = PowerStage::Pmsm { params, state, u_dc, last_speed: 0.0, rotor: Rotation::default() };
            Ok((if on { stage } else { PowerStage::Off }, encoder))
        }
    }
}

/// What the firmware knows.
fn firmware(scenario: &Scenario) -> Result<drive::Params, BuildError> {
    let (drive, estimate) = (&scenario.drive, &scenario.drive.estimate);
    let base_rate = scenario.base_rate;
    let stage = match (&scenario.motor, &estimate.motor, &drive.current) {
        (scenario::Motor::IdealSource(source), ..) => drive::Stage::Direct { gain: source.gain },
        (_, Some(motor), Some(current)) => current_stage(base_rate, drive.dc_link, motor, current)?,
        _ => {
            return Err(BuildError::Contradiction("a synchronous motor needs a `[drive.current]`"));
        }
    };
    let model = match drive.feedforward.effort {
        scenario::EffortFeedforward::Off => feedforward::Model::Off,
        scenario::EffortFeedforward::Rigid => feedforward::Model::Rigid {
            inertia: estimate.motor_inertia + estimate.load_inertia,
            viscous: estimate.motor_viscous + estimate.load_viscous,
        },
        scenario::EffortFeedforward::TwoMass => feedforward::Model::TwoMass {
            motor_inertia: estimate.motor_inertia,
            load_inertia: estimate.load_inertia,
            stiffness: estimate.stiffness,
            motor_viscous: estimate.motor_viscous,
            load_viscous: estimate.load_viscous,
        },
    };
    let friction = |value: f64| if drive.feedforward.friction { value } else { 0.0 };
    let mut params = drive::Params {
        base_rate,
        transmission: scenario.axis.transmission,
        position_gain: drive.position.gain,
        feedback: match drive.position_feedback {
            scenario::Feedback::Motor => drive::Feedback::Motor,
            scenario::Feedback::Load => drive::Feedback::Load,
        },
        position_every: base_rate.divider(drive.position.rate)?,
        velocity: velocity::Params {
            k_p: drive.velocity.gain,
            integral_time: drive.velocity.integral_time,
            max_effort: drive.max_effort,
        },
        velocity_every: base_rate.divider(drive.velocity.rate)?,
        velocity_filter_time: drive.velocity.filter_time,
        feedforward: feedforward::Params {
            velocity: drive.feedforward.velocity,
            model,
            coulomb: friction(estimate.coulomb),
            bias: friction(estimate.bias),
        },
        reference_delay: 0.0,
        stage,
    };
    // Without effort feedforward there is nothing to wait for.
    let path = if model == feedforward::Model::Off { 0.0 } else { params.effort_path_delay() };
    params.reference_delay = drive.feedforward.delay.unwrap_or(path);
    Ok(params)
}

fn current_stage(
    base_rate: Rate,
    dc_link: f64,
    motor: &scenario::Pmsm,
    current: &scenario::CurrentLoop,
) -> Result<drive::Stage, BuildError> {
    let estimate = current::MotorEstimate {
        pole_pairs: f64::from(motor.pole_pairs),
        resistance: motor.resistance,
        inductance: Dq { d: motor.inductance_d, q: motor.inductance_q },
        flux_linkage: motor.flux_linkage,
    };
    let max_voltage = inverter::voltage_limit(dc_link);
    let mut params = current::Params::from_bandwidth(estimate, current.bandwidth, max_voltage)?;
    if let Some((d, q)) = current.gain {
        params.k_p = Dq { d, q };
    }
    if let Some((d, q)) = current.integral_time {
        params.k_i = Dq { d: params.k_p.d / d, q: params.k_p.q / q };
    }
    Ok(drive::Stage::Current { params, every: base_rate.divider(current.rate)? })
}
