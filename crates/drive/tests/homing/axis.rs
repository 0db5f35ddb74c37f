//! An ideal axis: it moves as the last set-point demands. The drive sees only its switches and index pulses.
use servobench_base::Setpoint;
use servobench_cia402::{Command, ControlBit, Controlword};
use servobench_drive::Demand;
use servobench_drive::modes::homing::{Output, Params, State, step};
use servobench_drive::modes::{Actual, Moment, Targets};
use std::ops::RangeInclusive;

pub(crate) const PERIOD: f64 = 1.0 / 2000.0;
/// Increment of the encoder of a lagging axis: at the speed for zero, one every other period.
pub(crate) const INCREMENT: f64 = 10e-6;
/// Positions of the limit switches.
pub(crate) const ENDS: (f64, f64) = (-1.0, 1.0);

/// Switches and index pulses of the axis.
#[derive(Debug, Clone)]
pub(crate) struct Machine {
    /// Range in which the home switch is on.
    pub(crate) home: RangeInclusive<f64>,
    /// Positions of index pulses, in ascending order.
    pub(crate) pulses: Vec<f64>,
}

impl Machine {
    /// Pulses 0.1 apart, none near the edges of a home switch that is on over `home`.
    pub(crate) fn with_home(home: RangeInclusive<f64>) -> Self {
        Self { home, pulses: (-12..12).map(|k| f64::from(k) * 0.1 + 0.037).collect() }
    }

    pub(crate) fn pulse_left_of(&self, x: f64) -> f64 {
        *self.pulses.iter().rfind(|pulse| **pulse < x).unwrap()
    }

    pub(crate) fn pulse_right_of(&self, x: f64) -> f64 {
        *self.pulses.iter().find(|pulse| **pulse > x).unwrap()
    }

    /// Negative limit, positive limit and home switch at `x`.
    pub(crate) fn switches(&self, x: f64) -> [bool; 3] {
        [x <= ENDS.0, x >= ENDS.1, self.home.contains(&x)]
    }
}

/// The axis under the drive.
pub(crate) struct Axis<'a> {
    /// Time constant with which the axis follows the set-point (s).
    pub(crate) lag: f64,
    /// Position of the axis, if it lags.
    behind: f64,
    machine: &'a Machine,
    /// The last set-point, in the machine's coordinate.
    pub(crate) demanded: Setpoint,
    /// Offset of the drive's coordinate from the machine's.
    pub(crate) shift: f64,
    last: f64,
    pub(crate) params: Params,
    pub(crate) state: State,
}

/// Record of a step, in the machine's coordinate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// State of the axis at the step.
    pub(crate) at: Setpoint,
    /// The set-point of the axis.
    pub(crate) demanded: Setpoint,
    pub(crate) output: Output,
}

pub(crate) fn idle() -> Controlword {
    Controlword::of(Command::EnableOperation)
}

pub(crate) fn start() -> Controlword {
    idle().with(ControlBit::ModeSpecific4, true)
}

impl<'a> Axis<'a> {
    pub(crate) fn new(machine: &'a Machine, params: Params, at: f64) -> Self {
        let demanded = Setpoint::at_rest(at);
        let moment = Moment { targets: targets(idle()), actual: Actual::default(), demanded, period: PERIOD };
        Self { lag: 0.0, behind: at, machine, demanded, shift: 0.0, last: at, params, state: State::begin(&moment) }
    }

    /// Starts the mode anew with `controlword`.
    pub(crate) fn take_over(&mut self, controlword: Controlword) {
        let (demanded, actual) = (self.demanded, Actual::default());
        self.state = State::begin(&Moment { targets: targets(controlword), actual, demanded, period: PERIOD });
    }

    pub(crate) fn step(&mut self, controlword: Controlword) -> Seen {
        let asked = self.demanded.after(PERIOD);
        let at = self.place(asked);
        // The switches do not depend on increments.
        let truly = if self.lag == 0.0 { at.x } else { self.behind };
        let [negative_limit, positive_limit, home] = self.machine.switches(truly);
        let crossed =
            |pulse: &&f64| (self.last < **pulse && **pulse <= at.x) || (at.x <= **pulse && **pulse < self.last);
        let actual = Actual {
            position: at.x + self.shift,
            velocity: at.v,
            effort: 0.0,
            negative_limit,
            positive_limit,
            home,
            index: self.machine.pulses.iter().find(crossed).map(|pulse| pulse + self.shift),
        };
        self.last = at.x;
        let demanded = Setpoint { x: self.demanded.x + self.shift, ..self.demanded }.after(PERIOD);
        let moment = Moment { targets: targets(controlword), actual, demanded, period: PERIOD };
        let output = step(&self.params, &mut self.state, &moment);
        let Demand::Position { setpoint, .. } = output.answer.demand else { panic!("{:?}", output.answer.demand) };
        self.demanded = Setpoint { x: setpoint.x - self.shift, ..setpoint };
        self.shift += output.shift.unwrap_or(0.0);
        Seen { at, demanded: self.demanded, output }
    }
}

impl Axis<'_> {
    /// State of the axis for a set-point: the set-point itself, or a lagging position, with the velocity measured by the increments of an
    /// encoder.
    fn place(&mut self, asked: Setpoint) -> Setpoint {
        if self.lag == 0.0 {
            return asked;
        }
        let increment = |x: f64| (x / INCREMENT).round() * INCREMENT;
        let before = increment(self.behind);
        self.behind += (asked.x - self.behind) * PERIOD / self.lag;
        let x = increment(self.behind);
        Setpoint { x, v: (x - before) / PERIOD, ..Setpoint::default() }
    }
}

fn targets(controlword: Controlword) -> Targets {
    Targets { controlword, ..Targets::default() }
}
