//! The closed loop tick by tick, for somebody else's simulation: what acts on the axis comes from outside, and it can go back.
use crate::bench::{Axis, Bench};
use crate::closed_loop::{ClosedLoop, Source};
use crate::recorded::Recorded;
use crate::run::{Failure, Reason};
use servobench_base::{Dq, Rate, Setpoint, Tick};
use servobench_cia402::PowerState;
use servobench_fieldbus::Fault;
use servobench_plant::BodyState;
use servobench_plcopen::AxisState;
use servobench_signals::PerLimit;
use servobench_signals::{Instant, Selection, Signal};
use servobench_trace::{ChannelSpec, Recorder};

/// What comes from outside, held over a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct External {
    /// Whether the program of the scenario may run: it begins with the first tick at which it may, and runs once.
    pub start: bool,
    /// What the axis is to follow instead of the program (axis coordinate). Over a fieldbus it is what the motion task sends.
    pub setpoint: Option<Setpoint>,
    /// Effort on the motor body (its own coordinate, N·m or N), beside the disturbances of the scenario.
    pub motor_effort: f64,
    /// Effort on the load (axis coordinate, N or N·m), beside the disturbances of the scenario.
    pub load_effort: f64,
    /// Where motor (its own coordinate) and load (axis coordinate) are measured to be; the loop's own mechanics do not move then.
    pub measured: Option<[BodyState; 2]>,
    /// What stands for the drive, or for drive and motor.
    pub controller: Option<Controller>,
}

/// What somebody else's controller gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Controller {
    /// Effort of the motor (its own coordinate, N·m or N), instead of drive and motor.
    Effort(f64),
    /// Stator voltage in the rotor's frame at the tick (V, peak), instead of the drive.
    Voltage(Dq),
}

impl Default for External {
    /// A run of the scenario as it is.
    fn default() -> Self {
        Self { start: true, setpoint: None, motor_effort: 0.0, load_effort: 0.0, measured: None, controller: None }
    }
}

/// States of axis, link and drive; `None` where there is none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct States {
    /// Power state of the drive on a fieldbus.
    pub drive: Option<PowerState>,
    /// Its fault (603Fh), 0 for none.
    pub drive_fault: u16,
    /// Fault of the link.
    pub link_fault: Option<Fault>,
    /// State of the axis that function blocks command.
    pub axis: Option<AxisState>,
}

/// Which limits cut what the loops ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Binding {
    /// The DC-link voltage.
    pub voltage: bool,
    /// The current that the drive allows.
    pub current: bool,
    /// The effort that the drive allows.
    pub effort: bool,
}

/// A closed loop that goes a tick when it is told to.
pub struct Stepper {
    closed_loop: ClosedLoop,
    /// The tick that comes next.
    tick: u64,
    /// The bodies at that tick, and what the loops said at the one before.
    now: Instant,
    selection: Selection,
    recorder: Recorder,
}

/// A closed loop at a tick, to go back to.
pub struct Snapshot {
    closed_loop: ClosedLoop,
    tick: u64,
    now: Instant,
}

impl Bench {
    /// The loop without the FMUs beside it, to be stepped from outside. Its channels are those that the scenario records.
    #[must_use]
    pub fn into_stepper(self) -> Stepper {
        let Recorded { closed_loop, wanted: selection, recorder, .. } = match self.axis {
            Axis::Alone(recorded) => *recorded,
            Axis::Coupled(coupled) => coupled.alone(),
        };
        let recorder = Recorder::silent(recorder.about().clone(), closed_loop.base_rate);
        let mut now = Instant::default();
        closed_loop.sample(&External::default(), &mut now);
        Stepper { closed_loop, tick: 0, now, selection, recorder }
    }
}

impl Stepper {
    /// Ticks per second.
    #[must_use]
    pub const fn base_rate(&self) -> Rate {
        self.closed_loop.base_rate
    }

    /// The present tick: the one that comes next.
    #[must_use]
    pub const fn tick(&self) -> Tick {
        Tick(self.tick)
    }

    /// What [`values`](Self::values) are.
    #[must_use]
    pub fn channels(&self) -> &[ChannelSpec] {
        self.selection.specs()
    }

    /// The signals that they are.
    #[must_use]
    pub fn signals(&self) -> &[Signal] {
        self.selection.signals()
    }

    /// What a recording would say: positions and velocities of the bodies at the present tick, everything else of the tick
    /// before, whose efforts have brought the bodies there. Before the first tick that is zero.
    pub fn values(&mut self) -> &[f64] {
        self.selection.values(&self.now)
    }

    /// The motor in its own coordinate at the present tick, as its encoder and its effort have it.
    #[must_use]
    pub fn shaft(&self) -> BodyState {
        self.closed_loop.mechanics.bodies()[0]
    }

    /// The set-point of the tick before.
    #[must_use]
    pub const fn setpoint(&self) -> Setpoint {
        self.now.setpoint
    }

    /// The states that the tick before has left.
    #[must_use]
    pub fn states(&self) -> States {
        match &self.closed_loop.state.source {
            Source::Program(_) => States::default(),
            Source::Network(network, _) => network.states(),
        }
    }

    /// Which limits bound at the tick before.
    #[must_use]
    pub const fn binding(&self) -> Binding {
        let binds = self.now.binds;
        Binding { voltage: binds.voltage, current: binds.current, effort: binds.effort }
    }

    /// One tick, exactly as [`Bench::run`] takes it.
    ///
    /// # Errors
    /// [`Failure`]; the loop must not be stepped again, but may go back.
    pub fn step(&mut self, external: &External) -> Result<(), Failure> {
        let now = &mut self.now;
        self.closed_loop.tick(self.tick, external, &mut self.recorder, now);
        let time = self.closed_loop.base_rate.time(Tick(self.tick));
        let done = if external.measured.is_some() { self.closed_loop.check() } else { self.closed_loop.integrate(now) };
        done.map_err(|reason: Reason| Failure { time, reason })?;
        self.closed_loop.sample(external, now);
        let share = |binds: bool| f64::from(u8::from(binds));
        let PerLimit { voltage, current, effort } = now.binds;
        now.saturation = PerLimit { voltage: share(voltage), current: share(current), effort: share(effort) };
        self.tick += 1;
        Ok(())
    }

    /// Where the loop is now; `None` where the engine cannot copy its mechanics.
    #[must_use]
    pub fn snapshot(&self) -> Option<Snapshot> {
        Some(Snapshot { closed_loop: self.closed_loop.copy()?, tick: self.tick, now: self.now })
    }

    /// Goes back to `snapshot`, which may be of another stepper of the same scenario.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        if let Some(closed_loop) = snapshot.closed_loop.copy() {
            (self.closed_loop, self.tick, self.now) = (closed_loop, snapshot.tick, snapshot.now);
        }
    }
}
