//! The closed loop tick by tick, for an external simulation, which provides the influences on the axis and may restore earlier states.
use crate::bench::{Bench, Loop};
use crate::closed_loop::Source;
use crate::external::External;
use crate::machine::Machine;
use crate::run::{Failure, Outcome};
use servobench_base::state::{Reader, Writer};
use servobench_base::{Rate, Setpoint, Tick};
use servobench_cia402::PowerState;
use servobench_fieldbus::Fault;
use servobench_plant::{BodyState, MechanicsError};
use servobench_plcopen::AxisState;
use servobench_signals::{Selection, Signal};
use servobench_trace::ChannelSpec;

/// States of axis, link and drive; `None` for missing parts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct States {
    /// Power state of the drive on a fieldbus.
    pub drive: Option<PowerState>,
    /// Fault of the drive (603Fh), 0 for none.
    pub drive_fault: u16,
    /// Fault of the link.
    pub link_fault: Option<Fault>,
    /// State of the axis that function blocks command.
    pub axis: Option<AxisState>,
}

/// A closed loop that advances one tick per call.
pub struct Stepper {
    machine: Machine,
    selection: Selection,
    /// Ticks of a whole run of the scenario.
    ticks: u64,
}

impl Bench {
    /// The loop without the FMUs beside it, to be stepped from outside. Its channels are those that the scenario records.
    #[must_use]
    pub fn into_stepper(self) -> Stepper {
        let Stepper { machine, selection, ticks } = self.into_recording_stepper();
        let rate = machine.base_rate();
        Stepper { machine: Machine::new(machine.axis.unrecorded(), rate), selection, ticks }
    }

    /// The same, recording every tick: [`Stepper::finish`] gives the recording.
    #[must_use]
    pub fn into_recording_stepper(self) -> Stepper {
        let machine = match self.closed_loop {
            Loop::Alone(machine) => *machine,
            Loop::Coupled(coupled) => coupled.alone(),
        };
        let selection = machine.axis.wanted.clone();
        Stepper { machine, selection, ticks: self.ticks }
    }
}

impl Stepper {
    /// Ticks per second.
    #[must_use]
    pub const fn base_rate(&self) -> Rate {
        self.machine.base_rate()
    }

    /// The current tick, which is the next to run.
    #[must_use]
    pub const fn tick(&self) -> Tick {
        self.machine.next()
    }

    /// True while ticks of a whole run of the scenario are left; the last one is [`finish`](Self::finish).
    #[must_use]
    pub const fn is_under_way(&self) -> bool {
        self.machine.next().0 + 1 < self.ticks
    }

    /// Ends the run at the present tick: its recording, up to `failure` if there was one.
    #[must_use]
    pub fn finish(mut self, failure: Option<Failure>) -> Outcome {
        if failure.is_none() {
            self.machine.observe();
        }
        self.machine.finish(failure)
    }

    /// What [`values`](Self::values) are.
    #[must_use]
    pub fn channels(&self) -> &[ChannelSpec] {
        self.selection.specs()
    }

    /// Signals of [`values`](Self::values).
    #[must_use]
    pub fn signals(&self) -> &[Signal] {
        self.selection.signals()
    }

    /// Values for a recording: positions and velocities of the bodies at the current tick, everything else of the previous
    /// tick, whose efforts have moved the bodies there. Before the first tick that is zero.
    pub fn values(&mut self) -> &[f64] {
        self.selection.values(&self.machine.axis.now)
    }

    /// The motor in its own coordinate at the current tick, in which its encoder and its effort are given.
    #[must_use]
    pub fn shaft(&self) -> BodyState {
        self.machine.axis.closed_loop.mechanics.bodies()[0]
    }

    /// The set-point of the previous tick.
    #[must_use]
    pub const fn setpoint(&self) -> Setpoint {
        self.machine.axis.now.setpoint
    }

    /// The states after the previous tick.
    #[must_use]
    pub fn states(&self) -> States {
        match &self.machine.axis.closed_loop.state.source {
            Source::Program(_) | Source::Master(_) => States::default(),
            Source::Network(network, _) => network.states(),
        }
    }

    /// Runs one tick, exactly as [`Bench::run`] does.
    ///
    /// # Errors
    /// [`Failure`]; the loop must not be stepped again, but may be restored.
    pub fn step(&mut self, external: &External) -> Result<(), Failure> {
        self.machine.axis.external = *external;
        self.machine.tick()?;
        self.machine.axis.sample();
        Ok(())
    }

    /// Writes the state of the loop at the current tick.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot save its state.
    pub fn save(&mut self, to: &mut dyn Writer) -> Result<(), MechanicsError> {
        to.word(self.tick().0);
        self.machine.axis.save(to)
    }

    /// Restores the state that [`save`](Self::save) wrote for a stepper of the same scenario.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot restore it, or the numbers are not a state of this loop. Then it must not be stepped, but
    /// another state may be restored.
    pub fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), MechanicsError> {
        let tick = Tick(from.word()?);
        self.machine.axis.restore(from)?;
        self.machine.go_back(tick);
        Ok(())
    }
}
