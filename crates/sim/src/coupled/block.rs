//! Axis and FMUs as blocks of a coupling.
use crate::recorded::{Recorded, Saved};
use crate::run::Failure;
use crate::stepper::{Controller, External};
use servobench_base::{Dq, Setpoint, Tick};
use servobench_coupling::{Block, Input, Step, later, mean, value};
use servobench_fmi::{Progress, Slave, SlaveError};
use servobench_plant::MechanicsError;
use servobench_scenario::LoopSignal;
use servobench_signals::{Instant, Selection};

/// What the axis gives before channels of the recording.
pub(super) const OWN: [&str; 3] = ["time", "shaft.position", "shaft.velocity"];

/// Part of a step that is a rounding of its times.
const ROUNDING: f64 = 1e-9;

/// One of those that are coupled.
pub(super) enum Part {
    Axis(Box<Axis>),
    Fmu(AttachedFmu),
}

/// An FMU beside the axis.
pub(super) struct AttachedFmu {
    pub(super) slave: Box<dyn Slave>,
    /// When the run ends (s): an FMU that wants to end then, or after it, keeps nobody from anything.
    pub(super) end: f64,
}

/// Why a part could not go on.
#[derive(Debug, thiserror::Error)]
pub(super) enum PartError {
    #[error(transparent)]
    Axis(Failure),
    #[error(transparent)]
    Fmu(SlaveError),
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
}

/// The axis as a block.
pub(super) struct Axis {
    pub(super) recorded: Recorded,
    /// Ticks of the run: the last one is recorded at the end.
    ticks: u64,
    takes: Vec<LoopSignal>,
    /// What others are given behind [`OWN`].
    gives: Selection,
    now: Instant,
    external: External,
    saved: Option<(Saved, Instant, External)>,
}

impl Axis {
    pub(super) fn new(recorded: Recorded, ticks: u64, takes: Vec<LoopSignal>, gives: Selection) -> Self {
        let mut now = Instant::default();
        recorded.closed_loop.sample(&External::default(), &mut now);
        Self { recorded, ticks, takes, gives, now, external: External::default(), saved: None }
    }

    /// What acts over a tick that begins `since` a step's start (s).
    fn external(&self, inputs: &[Input], since: f64, tick: f64) -> External {
        let mut external = External::default();
        let mut setpoint = None;
        let mut voltage = None;
        for (signal, input) in self.takes.iter().zip(inputs) {
            let (now, held) = (value(input, since), mean(&later(input, since), tick));
            match signal {
                LoopSignal::MotorEffort => external.motor_effort = held,
                LoopSignal::LoadEffort => external.load_effort = held,
                LoopSignal::SetpointPosition => setpoint.get_or_insert_with(Setpoint::default).x = now,
                LoopSignal::SetpointVelocity => setpoint.get_or_insert_with(Setpoint::default).v = now,
                LoopSignal::SetpointAcceleration => setpoint.get_or_insert_with(Setpoint::default).a = now,
                LoopSignal::Effort => external.controller = Some(Controller::Effort(held)),
                LoopSignal::VoltageD => voltage.get_or_insert_with(Dq::default).d = now,
                LoopSignal::VoltageQ => voltage.get_or_insert_with(Dq::default).q = now,
            }
        }
        external.setpoint = setpoint;
        external.controller = external.controller.or(voltage.map(Controller::Voltage));
        external
    }

    /// The bodies and the set-point of the tick that comes.
    fn look(&mut self) {
        self.recorded.closed_loop.sample(&External::default(), &mut self.now);
        if let Some(setpoint) = self.recorded.closed_loop.look_ahead(self.recorded.tick) {
            self.now.setpoint = setpoint;
        }
    }

    /// The loop with its last tick recorded.
    pub(super) fn recorded_to_the_end(self, is_complete: bool) -> Recorded {
        let Self { mut recorded, external, mut now, .. } = self;
        if is_complete {
            recorded.observe(&external, &mut now);
        }
        recorded
    }
}

impl Block for Part {
    type Error = PartError;

    fn saves_state(&self) -> bool {
        match self {
            Self::Axis(axis) => axis.recorded.closed_loop.mechanics.marks(),
            Self::Fmu(fmu) => fmu.slave.capabilities().saves_state,
        }
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.feeds_through(output, input),
        }
    }

    fn is_discrete(&self, output: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.is_discrete(output),
        }
    }

    fn has_initial_equations(&self) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.is_initialising(),
        }
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.follows_at_start(output, input),
        }
    }

    fn start(&mut self, inputs: &[f64]) -> Result<(), PartError> {
        match self {
            Self::Axis(_) => Ok(()),
            Self::Fmu(fmu) => fmu.slave.start(Some(inputs)).map_err(PartError::Fmu),
        }
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<Step, PartError> {
        let axis = match self {
            Self::Axis(axis) => axis,
            Self::Fmu(AttachedFmu { slave, end }) => {
                return Ok(match slave.step(time, length, inputs).map_err(PartError::Fmu)? {
                    Progress::Done => Step::Done,
                    Progress::Terminated(time) if time >= *end - ROUNDING * length => Step::Done,
                    Progress::Until(time) => Step::Until(time),
                    Progress::Terminated(time) => Step::Terminated(time),
                });
            }
        };
        let rate = axis.recorded.closed_loop.base_rate;
        for tick in 0..rate.tick_at(length).0 {
            if axis.recorded.tick + 1 == axis.ticks {
                break;
            }
            axis.external = axis.external(inputs, rate.time(Tick(tick)), rate.period());
            axis.recorded.observe(&axis.external, &mut axis.now);
            axis.recorded.go_on(&axis.now).map_err(PartError::Axis)?;
        }
        axis.look();
        Ok(Step::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                axis.look();
                let (own, channels) = outputs.split_at_mut(OWN.len());
                let shaft = axis.recorded.closed_loop.mechanics.bodies()[0];
                own.copy_from_slice(&[axis.recorded.time(), shaft.position, shaft.velocity]);
                if !channels.is_empty() {
                    channels.copy_from_slice(axis.gives.values(&axis.now));
                }
                Ok(())
            }
            Self::Fmu(fmu) => fmu.slave.read(inputs, outputs).map_err(PartError::Fmu),
        }
    }

    fn save(&mut self) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                let saved = axis.recorded.save()?;
                axis.saved = Some((saved, axis.now, axis.external));
                Ok(())
            }
            Self::Fmu(fmu) => fmu.slave.save().map_err(PartError::Fmu),
        }
    }

    fn restore(&mut self) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                let Some((saved, now, external)) = &axis.saved else {
                    return Err(MechanicsError::NoWayBack.into());
                };
                axis.recorded.restore(saved)?;
                (axis.now, axis.external) = (*now, *external);
                Ok(())
            }
            Self::Fmu(fmu) => fmu.slave.restore().map_err(PartError::Fmu),
        }
    }
}
