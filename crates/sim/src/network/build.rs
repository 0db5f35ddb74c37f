//! Construction of the network of a scenario.
use super::drive_profile::DriveProfile;
use super::plc::{self, Plc};
use super::program_cursor::ProgramCursor;
use super::reference::DelayedReference;
use super::requests::Requests;
use super::signals::Signals;
use super::tables::Tables;
use super::units::{Counted, DriveUnits, units};
use super::{MotionTask, Network, Stepped};
use crate::error::BuildError;
use crate::program::Program;
use servobench_base::{Countdown, Divider, ParamError, Setpoint};
use servobench_cia402::PowerState;
use servobench_cia402::interpolated::SubMode;
use servobench_cia402::objects::Dictionary;
use servobench_cia402::units::Object;
use servobench_drive::modes::interpolated::serial::Port;
use servobench_drive::{self as drive, Demand, EffortLimits, device, feedforward};
use servobench_fieldbus::bus;
use servobench_fieldbus::link::{self, Mailbox};
use servobench_fieldbus::task;
use servobench_fieldbus::trajectory::Timing;
use servobench_motion::Limits;
use servobench_motion::interpolate::Mode;
use servobench_scenario::{self as scenario, Actuator, Bus, Feedback, Scenario};
use servobench_trace::Recorder;

/// Most cycles that the drive bridges without a frame.
const BRIDGED: u32 = 2;
/// Factor by which an axis may exceed the velocity of all moves of the program.
const RESERVE: f64 = 2.0;

/// Factor on the jerk of the moves for leading differences to a prediction to zero.
const RECOVERY_JERK: f64 = 5.0;

/// Delays of a set-point (base ticks).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Delays {
    /// Delay in the link.
    pub(crate) link: u64,
    /// Delay from a cycle of the bus until its frame is at the drive.
    pub(crate) frame: u64,
    /// Delay in the drive, from the arrival of a frame until its target is reached.
    pub(crate) drive: u64,
}

impl Delays {
    pub(crate) const fn sum(self) -> u64 {
        self.link + self.frame + self.drive
    }
}

/// Dynamics required of an axis: the largest values of all its moves.
#[derive(Debug, Clone, Copy)]
struct Dynamics {
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl Network {
    /// Builds the network of `scenario` in front of `loops`. Returns it with the delays from the motion task to the loops.
    ///
    /// # Errors
    /// [`BuildError`] names the part of the scenario that cannot be built.
    pub(crate) fn new(
        scenario: &Scenario,
        bus: &Bus,
        program: Program,
        loops: &drive::Params,
        recorder: &mut Recorder,
    ) -> Result<(Self, Delays), BuildError> {
        let base_rate = scenario.base_rate;
        let tick = base_rate.period();
        let bus_every = divider("bus.cycle", bus.cycle)?;
        let motion_cycle = divider("bus.motion_cycle", bus.cycle.saturating_mul(bus.motion_every))?;
        let drive_every = loops.position_every;
        if !bus_every.is_multiple_of(drive_every) {
            let bound = "a whole number of periods of the position loop";
            let value = f64::from(bus.cycle) * tick;
            return Err(BuildError::Key(ParamError { name: "bus.cycle", value, bound }));
        }
        let dynamics = scenario.plc.as_ref().map_or_else(|| dynamics(&program), dynamics_of_calls);

        let rated_effort = rated_effort(scenario);
        let counted = counted(scenario, loops)?;
        // The drive has its own direction; the master knows about the reversal.
        let of_drive = scenario::DriveUnits { axis: bus.units.axis.abs(), ..bus.units };
        let units = units(&counted, scenario.axis.motion, of_drive, rated_effort)?;
        let device = device_params(bus, loops, units.conversions, bus.cycle / drive_every.ticks(), &dynamics);
        let device = device::Params { counter: bus.counter, ..device };
        let (device, rated_effort) = with_objects(&device, bus, &units, rated_effort)?;
        let increment = units.increment;
        let drive = Stepped { state: device::State::new(&device)?, params: device };

        let model = master_model(bus, loops, scenario);
        let settings = link::Settings {
            base_rate,
            bus_cycle: bus_every,
            motion_cycle,
            interpolation: bus.interpolation,
            margin: bus.margin,
            run_ahead: bus.run_ahead,
            control: control(bus, &dynamics),
            sequencing: bus.sequencing,
            drive_timeout: base_rate.tick_at(bus.drive_timeout).0,
            round_trip: 2 * bus.delay + 1,
            // The master gets the values of the drive's last step.
            answer_age: drive_every.ticks(),
            reverse_switches: bus.reverse_switches,
            units: link::Units {
                drive_units: bus.units.drive.into(),
                axis_units: bus.units.axis,
                velocity_factor: 1.0,
                rated_effort,
                counter: bus.counter,
            },
            velocity_from_differences: bus.velocity_from_differences,
            recovery: recovery(bus, &dynamics),
            velocity_limit: RESERVE * dynamics.velocity,
        };
        let link = link::Params::new(settings)?;
        let delays = delays(scenario, bus, &link, &device, (motion_cycle, drive_every));
        let period = f64::from(motion_cycle.ticks()) * tick;
        let delay = delays.sum() as f64 * tick + wait(bus.mode, loops, drive_every);
        let task = match &scenario.plc {
            Some(plc) => MotionTask::Plc(Box::new(Plc::new(plc, &scenario.axis, period, recorder)?)),
            None if !bus.mode.is_cyclic() => {
                let moves = ProgramCursor::new(program, period);
                let timing =
                    Timing { task: period, bus: f64::from(bus.cycle) * tick, frame: delays.frame as f64 * tick };
                MotionTask::DriveProfile(Box::new(DriveProfile::new(moves, bus, &device, timing)?))
            }
            None => MotionTask::Moves(Box::new(ProgramCursor::new(program, period))),
        };
        let reference = match &task {
            MotionTask::Moves(moves) => DelayedReference::of_program(period, delay, moves.program()),
            MotionTask::DriveProfile(_) | MotionTask::Plc(_) => DelayedReference::new(period, delay),
        };
        let requests = requests(&task, period, delay);
        let network = Self {
            task,
            model,
            transmission: loops.transmission,
            mailbox: Mailbox::default(),
            link: Stepped { params: link, state: link::State::default() },
            drive,
            serial: Port::default(),
            bus: Stepped { params: bus::Params::new(bus_every, bus.delay, &[])?, state: bus::State::default() },
            faults: bus.faults.clone(),
            turns: Stepped { params: task::Params::new(motion_cycle, &[]), state: task::State::default() },
            task_faults: bus.task_faults.clone(),
            drive_every,
            drive_turn: Countdown::default(),
            frame: None,
            demand: Demand::Off,
            effort_limits: EffortLimits::NONE,
            reference,
            requests,
            asked: Setpoint::default(),
            failure: None,
            bus_position: 0.0,
            direction: bus.units.direction(),
            increment,
            index_increment: index_increment(&counted, increment, loops),
            index: None,
            tick,
            signals: Signals::new(bus.mode == scenario::BusMode::InterpolatedPosition, recorder),
        };
        Ok((network, delays))
    }
}

/// Requests of `task`, which has cycles of `period` (s), and whose set-points are followed `delay` (s) later.
fn requests(task: &MotionTask, period: f64, delay: f64) -> Requests {
    match task {
        MotionTask::Moves(moves) => Requests::of_program(moves.program(), period, delay),
        MotionTask::DriveProfile(profile) => {
            let program = profile.moves().program();
            match profile.targets() {
                Some(targets) => Requests::of_targets(targets.clone(), period, delay),
                None if profile.lags().is_empty() => Requests::of_program(program, period, delay),
                None => Requests::of_tables(Tables::of(program, profile.lags()), period, delay),
            }
        }
        MotionTask::Plc(_) => Requests::of_cycles(period, delay),
    }
}

/// Delays of a set-point from a motion task with `motion_cycle` to a drive that steps every `drive_every` ticks.
fn delays(
    scenario: &Scenario,
    bus: &Bus,
    link: &link::Params,
    device: &device::Params,
    (motion_cycle, drive_every): (Divider, Divider),
) -> Delays {
    let steps = match device.interpolation {
        Mode::CubicBSpline => 2,
        _ => 1,
    };
    let in_drive = u64::from(device.cycle.shift * drive_every.ticks()) + steps * u64::from(bus.cycle);
    let (link, drive) = match (bus.mode.is_cyclic(), &scenario.plc) {
        (true, _) => (link.delay(), in_drive),
        // A velocity from function blocks reaches the drive one of their cycles later.
        (false, Some(_)) => (motion_cycle.ticks().into(), 0),
        (false, None) => (0, 0),
    };
    Delays { link, frame: u64::from(bus.delay) * u64::from(bus.cycle), drive }
}

/// Delay of a set-point of `mode` for the feedforward (s): in the drive's position loop, which a velocity bypasses.
fn wait(mode: scenario::BusMode, loops: &drive::Params, drive_every: Divider) -> f64 {
    match mode {
        scenario::BusMode::CyclicPosition => loops.reference_delay.length(loops.period(drive_every)),
        _ => 0.0,
    }
}

fn divider(key: &'static str, ticks: u32) -> Result<Divider, BuildError> {
    Divider::new(ticks).ok_or(BuildError::Key(ParamError {
        name: key,
        value: f64::from(ticks),
        bound: "a base tick at least",
    }))
}

/// Largest values of all moves, with a default jerk if no move has one: the acceleration within 10 ms.
fn dynamics(program: &Program) -> Dynamics {
    let most = |k: usize, otherwise: f64| {
        let peaks = program.moves().map(|made| made.peaks[k]).filter(|peak| peak.is_finite() && *peak > 0.0);
        let most = peaks.fold(0.0, f64::max);
        if most > 0.0 { most } else { otherwise }
    };
    let velocity = most(0, 1.0);
    let acceleration = most(1, 10.0 * velocity);
    Dynamics { velocity, acceleration, jerk: most(2, 100.0 * acceleration) }
}

/// Largest values of all calls.
fn dynamics_of_calls(calls: &scenario::Plc) -> Dynamics {
    let Limits { velocity, acceleration, jerk, .. } = plc::limits(calls);
    Dynamics { velocity, acceleration, jerk: if jerk.is_finite() { jerk } else { 100.0 * acceleration } }
}

/// Effort that 1000 in 6071h stands for: the largest effort of the drive, or one unit if it has no limit.
fn rated_effort(scenario: &Scenario) -> f64 {
    scenario.actuator.rated_effort().unwrap_or(1.0)
}

fn counted(scenario: &Scenario, loops: &drive::Params) -> Result<Counted, BuildError> {
    let feedback = scenario.actuator.drive().map_or(Feedback::Motor, |drive| drive.position_feedback);
    Ok(match (feedback, &scenario.actuator) {
        (Feedback::Load(encoder), _) => {
            Counted { motion: scenario.axis.motion, increment: encoder.increment, transmission: 1.0 }
        }
        (Feedback::Motor, Actuator::Pmsm { encoder, .. } | Actuator::IdealSource { encoder, .. }) => Counted {
            motion: scenario.axis.motor_motion,
            increment: encoder.increment,
            transmission: loops.transmission,
        },
        (Feedback::Motor, Actuator::Prescribed | Actuator::Off(_)) => {
            return Err(BuildError::NoDriveOnTheBus);
        }
    })
}

/// Length of an increment of the position loop's encoder in the motor's coordinate.
fn index_increment(counted: &Counted, increment: f64, loops: &drive::Params) -> f64 {
    increment * counted.transmission / loops.transmission
}

fn device_params(
    bus: &Bus,
    loops: &drive::Params,
    units: device::Units,
    steps: u32,
    dynamics: &Dynamics,
) -> device::Params {
    device::Params {
        period: loops.period(loops.position_every),
        cycle: device::CycleParams { steps, shift: 0, bridged: BRIDGED },
        interpolation: bus.drive_interpolation,
        units,
        reverse_switches: bus.reverse_switches,
        profile: device::Profile {
            velocity: dynamics.velocity,
            acceleration: dynamics.acceleration,
            deceleration: dynamics.acceleration,
            quick_stop_deceleration: RESERVE * dynamics.acceleration,
            ..device::Params::default().profile
        },
        // Points with separate times and velocities.
        sub_mode: SubMode::Cubic,
        ..device::Params::default()
    }
}

/// The settings after the master has written to the objects of the drive, and the rated effort after that.
fn with_objects(
    settings: &device::Params,
    bus: &Bus,
    units: &DriveUnits,
    rated_effort: f64,
) -> Result<(device::Params, f64), BuildError> {
    if bus.objects.is_empty() {
        return Ok((*settings, rated_effort));
    }
    let mut objects = Dictionary::new();
    let factors = &units.factors;
    for (index, values) in [
        (0x608F, factors.position_encoder_resolution),
        (0x6091, factors.gear_ratio),
        (0x6092, factors.feed_constant),
        (0x6096, factors.velocity_factor),
    ] {
        for (subindex, value) in (1..).zip(values) {
            objects.preset(Object { index, subindex }, value.into())?;
        }
    }
    settings.store_in(&mut objects)?;
    for write in &bus.objects {
        objects
            .write_number(write.object, write.value, PowerState::SwitchOnDisabled)
            .map_err(|error| BuildError::Object { key: write.key.clone(), error: Box::new(error) })?;
    }
    let written = settings.with_objects_on_axis(&objects, units.unit)?;
    if let Some(range) = written.rotary.range {
        let bound = "the whole range: the link counts through the end of its counter";
        let name = "drive.objects.607Bh.2";
        return Err(BuildError::Key(ParamError { name, value: range.max().into(), bound }));
    }
    // The number of steps between two frames depends on the bus.
    let settings = device::Params { cycle: settings.cycle, ..written };
    Ok((settings, settings.units.rated_effort()))
}

/// Model of the axis in the motion task: the estimate of the drive, for the model behind the torque offset.
fn master_model(bus: &Bus, loops: &drive::Params, scenario: &Scenario) -> feedforward::Params {
    let model = scenario.actuator.drive().map(|drive| drive.estimate.model(bus.effort_offset));
    feedforward::Params { model: model.unwrap_or(feedforward::Model::Off), ..loops.feedforward }
}

/// Limits for leading differences to the set-points to zero.
fn recovery(bus: &Bus, dynamics: &Dynamics) -> Limits {
    // A prediction is corrected in every cycle of the task, which would never finish with the jerk of the moves alone.
    let jerk = if bus.run_ahead > 0 { RECOVERY_JERK * dynamics.jerk } else { dynamics.jerk };
    Limits { velocity: dynamics.velocity, acceleration: dynamics.acceleration, jerk, snap: f64::INFINITY }
}

fn control(bus: &Bus, dynamics: &Dynamics) -> link::Control {
    let torque_offset = bus.effort_offset != drive::EffortFeedforward::Off;
    match bus.position_loop {
        Some(gains) => link::Control::Velocity {
            gains,
            feedforward: f64::from(u8::from(bus.velocity_offset)),
            limit: RESERVE * dynamics.velocity,
            torque_offset,
        },
        None => link::Control::Position { velocity_offset: bus.velocity_offset, torque_offset },
    }
}
