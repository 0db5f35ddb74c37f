//! The closed loop at rest, for linearisation: built of linearised parts, perturbed one number at a time, advanced by the usual tick.
use crate::closed_loop::{ClosedLoop, Control, EncoderInput, Mounting, Shaft, Source, State};
use crate::disturbance::Disturbances;
use crate::error::BuildError;
use crate::external::External;
use crate::master_at_rest::{MasterAtRest, MasterOverBus};
use crate::program::Program;
use servobench_base::state::{Form, Part, Reader, Stateful as _, Writer, words};
use servobench_base::{AlphaBeta, Dq, ElectricalAngle, Setpoint};
use servobench_drive::{self as drive, Stage, measurement};
use servobench_linear::{Factors, LinearError, Running};
use servobench_plant::{
    CurrentSensor, Drive, Encoder, Engine as _, Exact, Mechanics, MechanicsSetup, Model, PowerStage, Switches,
};
use servobench_signals::Instant;
use servobench_stability as stability;
use servobench_trace::{About, Recorder};

/// Sensors wired to the drive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WiredSensors {
    /// The encoder of the motor.
    pub motor: Encoder,
    /// The encoder on the load, if it closes the position loop.
    pub load: Option<Encoder>,
    /// The current sensors, if they have errors.
    pub current: Option<CurrentSensor>,
}

/// The loop at rest.
pub struct AtRest {
    closed: ClosedLoop,
    /// Parameters of the drive with unchanged gains.
    params: drive::Params,
    /// State before the first tick, and the places of its numbers.
    fresh: Vec<u64>,
    form: Form,
    /// Voltage that holds the current at rest (V), and the electrical angle per motor coordinate.
    voltage: f64,
    current: f64,
    electrical_ratio: f64,
    has_begun: bool,
    external: External,
    now: Instant,
    recorder: Recorder,
}

/// Numbers that are not zero at rest.
const CURRENT: &str = "plant.power.0.0.state.current.d";
const INTEGRAL: &str = "controllers.drive.current.integral.d";
const VOLTAGES: [[&str; 2]; 2] = [
    ["controllers.drive.current.pending.alpha", "controllers.drive.current.pending.beta"],
    ["controllers.drive.held.current.voltage.alpha", "controllers.drive.held.current.voltage.beta"],
];
const POSITION: &str = "mechanics.position";

impl AtRest {
    /// The loop of `model` with these sensors.
    ///
    /// # Errors
    /// [`BuildError`] names the part that cannot be built.
    pub fn new(
        model: &stability::Loop,
        sensors: &WiredSensors,
        master: Option<&MasterOverBus>,
    ) -> Result<Self, BuildError> {
        let base_rate = model.drive.base_rate;
        let h = base_rate.period();
        let mut params = model.drive.linearised();
        if !sensors.motor.gives_velocity() {
            params.blocks.measurement.get_or_insert(measurement::Params::Difference);
        }
        // A misaligned commutation would turn the current at rest into torque.
        let turned = |encoder: Encoder| {
            let mut encoder = encoder.linearised();
            if let Some(errors) = encoder.errors.as_mut().filter(|_| model.d_current != 0.0) {
                errors.commutation = 0.0;
            }
            encoder
        };
        let motor_encoder = EncoderInput::new(turned(sensors.motor), 0, h)?;
        let load_encoder = sensors.load.map(|encoder| EncoderInput::new(turned(encoder), 1, h)).transpose()?;
        let mut sensor = sensors.current.map(|sensor| sensor.linearised());
        let (mut current, mut voltage, mut electrical_ratio) = (model.d_current, 0.0, 0.0);
        let power = match &model.source {
            stability::Source::Ideal { gain } => PowerStage::ideal(&servobench_plant::IdealSource {
                gain: *gain,
                output: servobench_plant::SourceOutput::Effort,
                limit: f64::INFINITY,
            }),
            stability::Source::Pmsm(motor) => {
                if let Some(sensor) = sensor.as_mut().filter(|_| current != 0.0) {
                    // Unequal sensors would turn the current at rest into torque.
                    let [a, b] = sensor.gain_error;
                    sensor.gain_error = [f64::midpoint(a, b); 2];
                    current /= 1.0 + sensor.gain_error[0];
                }
                (voltage, electrical_ratio) = (motor.resistance * current, motor.electrical_ratio);
                let mut stage = PowerStage::pmsm(*motor, f64::INFINITY, 0.0, h)?;
                stage.leave_power_out();
                match (sensor, &params.stage) {
                    (Some(sensor), Stage::Current { every, .. }) => stage.with_current_sensor(sensor, *every, h)?,
                    _ => stage,
                }
            }
        };
        let mechanics: Box<dyn Mechanics> = match &model.mechanics {
            stability::Mechanics::Bodies(chain) => {
                let model = Model::Chain(chain.linearised());
                Exact.build(&MechanicsSetup { model, drive: Drive::Effort, step: h, initial: Vec::new() })?
            }
            stability::Mechanics::Model { linear, .. } => linear.at_rest(),
        };
        let state = drive::State::new(&params, Setpoint::default())?;
        let control = Control { params: params.clone(), state, motor_encoder, load_encoder };
        let closed = ClosedLoop {
            base_rate,
            state: State {
                source: match master {
                    None => Source::Program(Box::new(Program::standing())),
                    Some(master) => Source::Master(Box::new(MasterAtRest::new(master, &params))),
                },
                begun: None,
                upcoming: None,
                control: Some(control),
                sensors: None,
                power,
                motor_before: 0.0,
                shaft: Shaft { effort: 0.0, position: 0.0 },
            },
            mechanics,
            prescribed: false,
            mounting: Mounting { transmission: model.mechanics.transmission(), direction: 1.0 },
            disturbances: Disturbances::new(&[], base_rate, 1)?,
            end_stops: None,
            switches: Switches::default(),
        };
        let mut at_rest = Self {
            closed,
            params,
            fresh: Vec::new(),
            form: Form::default(),
            voltage,
            current,
            electrical_ratio,
            has_begun: false,
            external: External { setpoint: Some(Setpoint::default()), ..External::default() },
            now: Instant::default(),
            recorder: Recorder::silent(About::default(), base_rate),
        };
        let (mut fresh, mut form) = (Vec::new(), Form::default());
        at_rest.write(&mut words(|word| fresh.push(word)))?;
        at_rest.write(&mut form)?;
        (at_rest.fresh, at_rest.form) = (fresh, form);
        Ok(at_rest)
    }

    fn write(&mut self, to: &mut dyn Writer) -> Result<(), servobench_plant::MechanicsError> {
        let State { source, begun: _, upcoming: _, control, sensors: _, power, motor_before: _, shaft } =
            &self.closed.state;
        to.enter(Part::field("mechanics"));
        self.closed.mechanics.save(to)?;
        to.leave();
        if let Some(Control { params: _, state, motor_encoder, load_encoder }) = control {
            part(to, "controllers", |to| {
                part(to, "drive", |to| state.save(to));
                part(to, "effort", |to| shaft.effort.save(to));
                if let Source::Master(master) = source {
                    part(to, "master", |to| master.save(to));
                }
            });
            for EncoderInput { encoder, unwrap: _ } in
                [Some(motor_encoder), load_encoder.as_ref()].into_iter().flatten()
            {
                part(to, "encoder", |to| encoder.save(to));
            }
        }
        part(to, "plant", |to| part(to, "power", |to| power.save(to)));
        Ok(())
    }

    fn read(&mut self, from: &mut Reader<'_>) -> Result<(), LinearError> {
        let State { source, control, power, shaft, .. } = &mut self.closed.state;
        self.closed.mechanics.restore(from).map_err(|error| LinearError::Stopped(error.to_string()))?;
        if let Some(Control { params: _, state, motor_encoder, load_encoder }) = control {
            state.restore(from)?;
            shaft.effort.restore(from)?;
            if let Source::Master(master) = source {
                master.restore(from)?;
            }
            for input in [Some(motor_encoder), load_encoder.as_mut()].into_iter().flatten() {
                input.encoder.restore(from)?;
            }
        }
        power.restore(from)?;
        Ok(())
    }
}

fn part(to: &mut dyn Writer, name: &'static str, save: impl FnOnce(&mut dyn Writer)) {
    to.enter(Part::field(name));
    save(to);
    to.leave();
}

impl Running for AtRest {
    fn save(&mut self, to: &mut dyn Writer) -> Result<(), LinearError> {
        self.write(to).map_err(|error| LinearError::Stopped(error.to_string()))
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), LinearError> {
        self.has_begun = true;
        self.read(from)
    }

    fn place(&mut self, position: f64) -> Result<(), LinearError> {
        let mut saved = self.fresh.clone();
        let mut put = |name: &str, value: f64| {
            let word = self.form.word(name).ok_or_else(|| LinearError::NoSuchNumber(name.to_owned()))?;
            saved[word] = value.to_bits();
            Ok::<_, LinearError>(())
        };
        put(POSITION, position)?;
        if self.current != 0.0 {
            let rotor = ElectricalAngle::from_mechanical(position, self.electrical_ratio).rotation();
            let AlphaBeta { alpha, beta } = Dq { d: self.voltage, q: 0.0 }.to_alpha_beta(rotor);
            put(CURRENT, self.current)?;
            put(INTEGRAL, self.voltage)?;
            for [along, across] in VOLTAGES {
                put(along, alpha)?;
                put(across, beta)?;
            }
        }
        let mut from = Reader::moved(&saved);
        self.read(&mut from)?;
        from.end()?;
        self.has_begun = false;
        Ok(())
    }

    /// Advances the mechanics with the effort of the previous tick, then everything else, up to the effort.
    fn tick(&mut self) -> Result<(), LinearError> {
        if self.has_begun {
            self.now.effort = self.closed.mounting.direction * self.closed.state.shaft.effort;
            let integrated = self.closed.integrate(&self.external, &self.now);
            integrated.map_err(|reason| LinearError::Stopped(reason.to_string()))?;
        }
        self.has_begun = true;
        self.closed.tick(0, &self.external, &mut self.recorder, &mut self.now);
        Ok(())
    }

    fn set(&mut self, factors: &Factors) {
        let Some(control) = &mut self.closed.state.control else { return };
        let mut params = self.params.clone();
        params.position_gain *= factors.position;
        params.velocity.k_p *= factors.velocity;
        if let Some(measurement::Params::Observer(observer)) = &mut params.blocks.measurement {
            observer.compensation *= factors.compensation;
        }
        if let Stage::Current { params, .. } = &mut params.stage {
            for gain in [&mut params.gains.k_p, &mut params.gains.k_i] {
                *gain = Dq { d: gain.d * factors.current.d, q: gain.q * factors.current.q };
            }
        }
        control.params = params;
        if let Source::Master(master) = &mut self.closed.state.source {
            master.set(factors.position);
        }
    }
}
