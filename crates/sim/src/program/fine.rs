//! Interpolation between a slow task that commands and a drive with a set-point at every tick.
use servobench_base::{ParamError, Rate, Setpoint, Stateful, Tick};
use servobench_motion::interpolate::{Interpolator, Sample};
use servobench_scenario::Interpolation;

/// The commands of a slow task, interpolated. Before the first command the axis rested at its start.
#[derive(Debug, Clone, Stateful)]
pub(super) struct Fine {
    interpolator: Interpolator,
    /// Ticks from one command to the next.
    #[state(constant)]
    every: u64,
    /// Ticks since the last command.
    passed: u64,
}

impl Fine {
    pub(super) fn new(interpolation: &Interpolation, base_rate: Rate) -> Result<Self, ParamError> {
        let Tick(every) = base_rate.tick_at(interpolation.period);
        let refused =
            ParamError { name: "setpoint.interpolation.period", value: interpolation.period, bound: "a tick at least" };
        if every == 0 {
            return Err(refused);
        }
        let interpolator = Interpolator::new(interpolation.mode, interpolation.period).map_err(|_| refused)?;
        Ok(Self { interpolator, every, passed: 0 })
    }

    /// Delay of the drive behind the command (s).
    pub(super) fn delay(&self) -> f64 {
        self.interpolator.mode().delay_samples() as f64 * self.interpolator.period()
    }

    /// The set-point of the next tick; `command` gives the current command of the slow task.
    #[inline]
    pub(super) fn next(&mut self, command: impl FnOnce() -> Setpoint) -> Setpoint {
        if self.passed == 0 {
            self.take(command());
        }
        let fraction = self.passed as f64 / self.every as f64;
        self.passed = if self.passed + 1 < self.every { self.passed + 1 } else { 0 };
        // A plan has no invalid numbers, and the window is full from the first command on.
        self.interpolator.at(fraction).map(|command| command.setpoint).unwrap_or_default()
    }

    fn take(&mut self, Setpoint { x, v, a, .. }: Setpoint) {
        let sample = Sample { x, v, a, torque: 0.0 };
        let rest = Sample { x, ..Sample::default() };
        while self.interpolator.received() + 1 < self.interpolator.mode().points() as u64 {
            self.push(rest);
        }
        self.push(sample);
    }

    fn push(&mut self, sample: Sample) {
        let taken = self.interpolator.push(sample);
        debug_assert!(taken.is_ok(), "{taken:?}");
    }
}
