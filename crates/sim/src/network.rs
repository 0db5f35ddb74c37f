//! A motion task, a fieldbus and the bus interface of a drive (CiA 402) in front of the loops.
//!
//! ```text
//! motion task → mailbox → link → frame → bus → drive → demand for the loops
//!      ↑                   ↑ ←── frame ←── bus ←── ┘
//!      └──── feedback ─────┘
//! ```
//!
//! At a base tick, in this order: in a cycle of the bus the answer of the drive's last step goes to the master, the motion task
//! turns, when it is due, and the link makes the next frame; then the drive steps, when its position loop turns, with the frame
//! that has arrived. Either way takes the delay of the bus.
mod build;
mod concerned;
mod drive_profile;
mod plc;
mod program_cursor;
mod reference;
mod requests;
mod signals;
mod tables;
mod targets;
mod units;

use crate::stepper::States;
use drive_profile::DriveProfile;
use plc::Plc;
use program_cursor::ProgramCursor;
use reference::DelayedReference;
use requests::Requests;
use servobench_base::{Countdown, Divider, Request, Setpoint, Stateful, Tick};
use servobench_cia402::{Commands, Mode, PowerState};
use servobench_drive::modes::interpolated::serial::Port;
use servobench_drive::supervision::Finding;
use servobench_drive::{Demand, EffortLimits, device, feedforward};
use servobench_fieldbus::bus::{self, BusFault};
use servobench_fieldbus::link::{self, Mailbox};
use servobench_fieldbus::task::{self, TaskFault};
use servobench_fieldbus::{AxisCommand, AxisFeedback, Interpolation, Task};
use servobench_motion::interpolate::Sample;
use servobench_plant::SwitchReading;
use servobench_signals::Instant;
use servobench_trace::Recorder;
use signals::Signals;

/// From the motion task to the bus interface of the drive.
#[derive(Debug, Stateful)]
pub(crate) struct Network {
    task: MotionTask,
    /// Model of the axis that the motion task feeds forward with.
    #[state(constant)]
    model: feedforward::Params,
    /// Axis coordinate per motor coordinate, as the master knows it.
    #[state(constant)]
    transmission: f64,
    mailbox: Mailbox,
    link: Stepped<link::Params, link::State>,
    drive: Stepped<device::Params, device::State>,
    /// The serial interface of the drive.
    serial: Port,
    bus: Stepped<bus::Params<'static>, bus::State>,
    #[state(constant)]
    faults: Vec<BusFault>,
    /// When the motion task runs.
    turns: Stepped<task::Params<'static>, task::State>,
    #[state(constant)]
    task_faults: Vec<TaskFault>,
    #[state(constant)]
    drive_every: Divider,
    drive_turn: Countdown,
    /// What has arrived at the drive since its last step.
    frame: Option<Commands>,
    demand: Demand,
    effort_limits: EffortLimits,
    reference: DelayedReference,
    requests: Requests,
    /// The set-point of the motion task's last cycle.
    asked: Setpoint,
    /// Why the motion task gave up.
    failure: Option<String>,
    bus_position: f64,
    /// −1 where the drive counts against the axis, otherwise 1.
    #[state(constant)]
    direction: f64,
    /// Length of an increment of the encoder that closes the position loop (its own coordinate).
    #[state(constant)]
    increment: f64,
    /// The same per axis coordinate, for the index pulse of the motor.
    #[state(constant)]
    index_increment: f64,
    /// Where the last index pulse was since the drive's last step.
    index: Option<i64>,
    #[state(constant)]
    tick: f64,
    signals: Signals,
}

/// Parameters, and the state that goes on by them.
#[derive(Debug, Stateful)]
struct Stepped<P, S> {
    #[state(constant)]
    params: P,
    state: S,
}

/// What commands the axis.
#[derive(Debug, Stateful)]
#[state(fixed)]
enum MotionTask {
    /// The moves of `[[program]]`.
    Moves(Box<ProgramCursor>),
    /// The same, left to the drive.
    DriveProfile(Box<DriveProfile>),
    /// The calls of `[[call]]`.
    Plc(Box<Plc>),
}

/// What the motion task is told at a tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prompt {
    /// The time (s).
    pub(crate) t: f64,
    /// The time of the program (s), which begins later where somebody else says when; `None` before that.
    pub(crate) program: Option<f64>,
    /// What the axis is to follow instead of the program.
    pub(crate) setpoint: Option<Setpoint>,
}

/// What a cycle of the motion task is to do.
#[derive(Debug, Clone, Copy)]
enum Now {
    /// The program, at its time (s).
    Program(f64),
    /// Somebody else's set-point.
    Follow(Setpoint),
}

/// What a cycle of the motion task gives.
#[derive(Debug, Clone)]
struct Step {
    command: AxisCommand,
    /// What the axis is to follow; `None` where the drive finds its own way, or none.
    setpoint: Option<Setpoint>,
    /// What function blocks want; a program of moves is known beforehand.
    request: Request,
}

impl MotionTask {
    /// The time of a program of moves in its last cycle (s); `None` before the axis is powered, and of function blocks.
    fn time(&self) -> Option<f64> {
        match self {
            Self::Moves(moves) => moves.time(),
            Self::DriveProfile(profile) => profile.moves().time(),
            Self::Plc(_) => None,
        }
    }

    fn cycle(
        &mut self,
        now: Now,
        feedback: &AxisFeedback,
        origin: f64,
        recorder: &mut Recorder,
        sample: impl Fn(Setpoint) -> Sample,
    ) -> Result<Step, String> {
        let t = match now {
            Now::Program(t) => t,
            Now::Follow(setpoint) => {
                let command = AxisCommand::of(Task::Follow(sample(setpoint)));
                return Ok(Step { command, setpoint: Some(setpoint), request: Request::Follow(setpoint) });
            }
        };
        match self {
            Self::Moves(moves) => {
                let now = moves.cycle(feedback).unwrap_or(0.0);
                let setpoint = moves.at(now);
                let command = AxisCommand::of(Task::Follow(sample(setpoint)));
                Ok(Step { command, setpoint: Some(setpoint), request: Request::Nothing })
            }
            Self::DriveProfile(way) => Ok(way.cycle(feedback)),
            Self::Plc(plc) => plc.cycle(t, feedback, origin, recorder, sample),
        }
    }
}

/// What the drive's sensors say at one of its steps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measurement {
    /// Reading of the encoder that closes the position loop (its own coordinate).
    pub(crate) position: f64,
    /// Velocity as the velocity loop sees it (axis coordinate).
    pub(crate) velocity: f64,
    /// Effort that the loops ask for (motor coordinate).
    pub(crate) effort: f64,
    /// Whether a limit cut it.
    pub(crate) effort_is_cut: bool,
    /// Reference less position, as the position loop saw them (axis coordinate).
    pub(crate) following_error: f64,
    /// Whether an I²t load is reached that is a fault.
    pub(crate) is_overloaded: bool,
    /// Whether the encoders of motor and load say that they have failed.
    pub(crate) encoder_errors: [bool; 2],
    /// Finding of the supervision of motor and power stage.
    pub(crate) finding: Option<Finding>,
    /// The switches.
    pub(crate) switches: SwitchReading,
}

impl Network {
    /// Goes through base tick `k` and returns what the loops are to do, and with how much effort at most. `pulse` is where an index pulse came in
    /// this tick; the drive looks at its sensors when it steps.
    pub(crate) fn step(
        &mut self,
        k: u64,
        prompt: &Prompt,
        pulse: Option<f64>,
        measure: impl FnOnce() -> Measurement,
        recorder: &mut Recorder,
    ) -> (&Demand, EffortLimits) {
        if let Some(pulse) = pulse {
            self.index = Some(counts(pulse / self.index_increment));
        }
        let Stepped { params, state } = &mut self.bus;
        if let Some(cycle) = bus::step(&params.with_faults(&self.faults), state, Tick(k)) {
            self.step_bus(&cycle, prompt, recorder);
        }
        if self.drive_turn.is_due(self.drive_every) {
            self.step_drive(prompt.t, &measure(), recorder);
        }
        (&self.demand, self.effort_limits)
    }

    fn step_drive(&mut self, t: f64, measurement: &Measurement, recorder: &mut Recorder) {
        let Stepped { params, state } = &mut self.drive;
        let frame = self.frame.take();
        let measured = device::Measured {
            increments: counts(measurement.position / self.increment),
            velocity: measurement.velocity,
            effort: measurement.effort,
            following_error: measurement.following_error,
            effort_is_cut: measurement.effort_is_cut,
            negative_limit: measurement.switches.negative,
            positive_limit: measurement.switches.positive,
            home: measurement.switches.home,
            index: self.index.take(),
            is_overloaded: measurement.is_overloaded,
            motor_encoder_error: measurement.encoder_errors[0],
            load_encoder_error: measurement.encoder_errors[1],
            finding: measurement.finding,
        };
        let inputs = device::Inputs { frame: frame.as_ref(), measured, fault: None, main_voltage: true };
        let device::Outputs { demand, effort_limits, .. } = device::step(params, state, &inputs);
        (self.demand, self.effort_limits) = (demand, effort_limits);
        self.signals.of_drive(t, state, recorder);
    }

    fn step_bus(&mut self, cycle: &bus::Cycle, prompt: &Prompt, recorder: &mut Recorder) {
        let origin = self.origin();
        let Stepped { params, state } = &mut self.link;
        let Stepped { params: wire, state: frames } = &mut self.bus;
        let actuals = frames.to_master(wire, cycle, self.drive.state.actuals(&self.drive.params));
        let mut torn = None;
        while let Some(turn) =
            task::step(&self.turns.params.with_faults(&self.task_faults), &mut self.turns.state, cycle.due)
        {
            let now = match (prompt.setpoint, prompt.program) {
                _ if cycle.master_stopped => continue,
                (Some(setpoint), _) => Now::Follow(setpoint),
                (None, Some(t)) => Now::Program(t),
                (None, None) => continue,
            };
            let step = self.task.cycle(now, &state.feedback(params), origin, recorder, |setpoint| {
                let motor = self.model.motor_reference(setpoint);
                let torque = self.transmission * self.model.effort(setpoint);
                Sample { x: motor.position, v: motor.velocity, a: setpoint.a, torque }
            });
            if let MotionTask::DriveProfile(way) = &mut self.task
                && let Some(message) = way.message()
                && let Err(error) = self.serial.receive(self.drive.state.trajectory_buffer(), &message)
            {
                self.failure = Some(format!("the serial interface of the drive: {error}"));
            }
            match step {
                Ok(Step { command, setpoint, request }) => {
                    let t = turn.due.0 as f64 * self.tick;
                    self.requests.push(t, request);
                    if let Some(passed) = self.task.time() {
                        self.reference.begin(t - passed);
                        self.requests.goes_on(t, passed);
                    }
                    match setpoint {
                        Some(setpoint) => self.reference.push(t, setpoint),
                        None => self.reference.restart(),
                    }
                    self.asked = setpoint.unwrap_or(Setpoint::at_rest(state.feedback(params).demanded()));
                    torn = turn.is_torn.then_some((turn.due, command));
                    if turn.is_torn {
                        self.mailbox.begin();
                    } else if !turn.is_lost {
                        self.mailbox.write(turn.due, command);
                    }
                }
                Err(reason) => self.failure = Some(reason),
            }
        }
        let input =
            link::Input { tick: cycle.due, mailbox: &self.mailbox, actuals, external_fault: cycle.external_fault };
        let commands = link::step(params, state, input);
        if let Some((due, command)) = torn {
            self.mailbox.finish(due, command);
        }
        if state.fault().is_some() {
            // What the motion task asks for meanwhile is not followed.
            self.reference.restart();
        }
        self.bus_position = state.feedback(params).position;
        if let Some(arrived) = frames.to_drive(wire, cycle, commands) {
            self.frame = Some(arrived);
        }
        self.signals.of_link(prompt.t, state, recorder);
    }

    /// The set-point that the loops follow, so long after the drive's last step, with the motor at `position`.
    fn setpoint(&self, position: f64) -> Setpoint {
        let since = f64::from(self.drive_turn.since(self.drive_every)) * self.tick;
        match self.demand {
            Demand::Position { setpoint, .. } => self.along(setpoint.after(since)),
            Demand::Velocity { setpoint, .. } => {
                self.along(Setpoint { x: self.direction * position, v: setpoint.v + since * setpoint.a, ..setpoint })
            }
            Demand::Off | Demand::Effort(_) => Setpoint::at_rest(position),
        }
    }

    /// A set-point of the drive along the axis.
    fn along(&self, Setpoint { x, v, a, j, s }: Setpoint) -> Setpoint {
        let d = self.direction;
        Setpoint { x: d * x, v: d * v, a: d * a, j: d * j, s: d * s }
    }

    /// Where load and motor are to be: where the motion task wanted them, as much later as the way to the loops takes; what
    /// the drive itself wants where it finds its own way; `None` where nothing is to be followed.
    fn reference(&mut self, t: f64) -> Option<(Setpoint, feedforward::MotorReference)> {
        let reference = self.reference.at(t);
        let drive = &self.drive.state;
        let follows = matches!(
            drive.mode(),
            Some(Mode::CyclicSynchronousPosition | Mode::CyclicSynchronousVelocity | Mode::ProfileVelocity)
        );
        match (&self.demand, reference) {
            (Demand::Position { .. } | Demand::Velocity { .. }, Some(reference)) if follows => {
                let reference = Setpoint { x: reference.x + self.origin(), ..reference };
                Some((reference, self.model.motor_reference(reference)))
            }
            (Demand::Position { .. }, _) => {
                let reference = self.setpoint(0.0);
                Some((reference, feedforward::MotorReference { position: reference.x, velocity: reference.v }))
            }
            _ => None,
        }
    }

    /// The request of the motion task that is due at the loops at `t` (s), which does not go back: nothing while the drive does not
    /// follow, or the link brings the axis to rest or waits for samples.
    pub(crate) fn request(&mut self, t: f64) -> Request {
        let request = self.requests.at(t);
        let (drive, link) = (&self.drive.state, &self.link.state);
        let follows = drive.power() == PowerState::OperationEnabled
            && link.fault().is_none()
            && !matches!(link.interpolation(), Interpolation::Wait | Interpolation::Underflow);
        let origin = self.origin();
        match request {
            _ if !follows => Request::Nothing,
            Request::Rest(x) => Request::Rest(x + origin),
            Request::Follow(setpoint) => Request::Follow(Setpoint { x: setpoint.x + origin, ..setpoint }),
            Request::Nothing | Request::Stand | Request::Velocity(_) | Request::Effort(_) => request,
        }
    }

    /// Where the axis has its zero once it is homed, in the coordinate of the machine.
    fn origin(&self) -> f64 {
        let Stepped { params, state } = &self.drive;
        self.direction * params.units.metres_or_radians(state.origin())
    }

    /// The states of link, drive and axis.
    pub(crate) fn states(&self) -> States {
        let (drive, link) = (&self.drive.state, &self.link.state);
        States {
            drive: Some(drive.power()),
            drive_fault: drive.fault().map_or(0, device::Fault::code),
            link_fault: link.fault(),
            axis: match &self.task {
                MotionTask::Plc(plc) => Some(plc.state()),
                MotionTask::Moves(_) | MotionTask::DriveProfile(_) => None,
            },
        }
    }

    /// True where the drive cuts the velocity that it is sent, and the master what it sends.
    pub(crate) const fn cuts_velocity(&self) -> [bool; 2] {
        [self.drive.state.cuts_velocity(), self.link.state.is_limited()]
    }

    /// Why the motion task gave up, once.
    pub(crate) const fn failure(&mut self) -> Option<String> {
        self.failure.take()
    }

    /// Brings to `now`, which is at `t` (s): set-point and references, what goes over the bus, and the actual position as the master
    /// reads it.
    pub(crate) fn show(&mut self, t: f64, now: &mut Instant) {
        let Stepped { params, state } = &self.link;
        let put_out = state.output(params);
        now.setpoint = self.setpoint(now.motor.position);
        (now.task, now.bus_position) = (self.asked, self.bus_position);
        (now.put_out, now.put_out_effort) = (put_out.setpoint, put_out.torque);
        (now.reference, now.motor_reference) = match self.reference(t) {
            Some((reference, motor)) => (reference.x, motor.position),
            None => (now.load.position, now.motor.position),
        };
    }

    /// Notes what is known at the end only.
    pub(crate) fn finish(&mut self, t: f64, delay: f64, recorder: &mut Recorder) {
        let of_bus = (&self.bus.params, &self.bus.state, &self.faults[..]);
        concerned::note(of_bus, (&self.turns.params, &self.turns.state, &self.task_faults), self.tick, recorder);
        match &mut self.task {
            MotionTask::Moves(moves) => moves.moves(delay).for_each(|made| recorder.note_move(made)),
            MotionTask::DriveProfile(way) => way.note(delay, recorder),
            MotionTask::Plc(plc) => plc.finish(t, delay, recorder),
        }
    }
}

/// The nearest whole number of increments.
#[expect(clippy::cast_possible_truncation, reason = "saturates, far beyond any axis")]
fn counts(increments: f64) -> i64 {
    libm::round(increments) as i64
}
