//! The mode over ideal loops, with a master that writes to the buffer between two steps.
use servobench_base::Setpoint;
use servobench_cia402::interpolated::{Point, SubMode, TimePeriod};
use servobench_cia402::{Command, ControlBit, Controlword};
use servobench_drive::Demand;
use servobench_drive::modes::interpolated::{Buffer, Params, State, step};
use servobench_drive::modes::{Actual, Answer, Moment, Steepness, Targets};

pub(crate) const PERIOD: f64 = 250e-6;
/// A count is a micrometre.
pub(crate) const COUNT: f64 = 1e-6;
pub(crate) const STOP: Steepness = Steepness { acceleration: 10.0, jerk: Some(1000.0) };

pub(crate) fn params(sub_mode: SubMode) -> Params {
    Params { sub_mode, period: TimePeriod::new(10, -3).unwrap(), count: COUNT, stop: STOP, velocity: f64::INFINITY }
}

pub(crate) struct Axis {
    pub(crate) params: Params,
    pub(crate) state: State,
    pub(crate) buffer: Buffer,
    /// The last set-point.
    pub(crate) last: Setpoint,
    pub(crate) answer: Answer,
}

impl Axis {
    pub(crate) fn at(counts: i32, sub_mode: SubMode) -> Self {
        let last = Setpoint::at_rest(f64::from(counts) * COUNT);
        let buffer = Buffer::default();
        let state = State::begin(&moment(idle(), last));
        let answer = Answer { demand: Demand::position(last), target_reached: true, bit_12: false, bit_13: false };
        Self { params: params(sub_mode), state, buffer, last, answer }
    }

    /// Starts the mode anew with `word`.
    pub(crate) fn take_over(&mut self, word: Controlword) {
        self.state = State::begin(&moment(word, self.last));
    }

    pub(crate) fn step(&mut self, word: Controlword) -> Setpoint {
        let moment = moment(word, self.last.after(PERIOD));
        self.answer = step(&self.params, &mut self.state, &mut self.buffer, &moment);
        let Demand::Position { setpoint, velocity_offset, effort_offset } = self.answer.demand else {
            panic!("{:?}", self.answer)
        };
        assert_eq!((velocity_offset, effort_offset, self.answer.bit_13), (0.0, 0.0, false));
        assert_eq!(self.answer.bit_12, self.state.is_following());
        self.last = setpoint;
        setpoint
    }

    pub(crate) fn add(&mut self, points: &[Point]) {
        for point in points {
            self.buffer.add(*point).unwrap();
        }
    }

    /// Steps until the axis rests, the first one with the move still active; returns every set-point.
    pub(crate) fn until_rest(&mut self, word: Controlword) -> Vec<Setpoint> {
        let mut setpoints = vec![];
        for _ in 0..1_000_000 {
            setpoints.push(self.step(word));
            if self.answer.target_reached {
                return setpoints;
            }
        }
        panic!("{:?} does not come to rest", self.last);
    }

    /// 2012h: sequence error, overflow, underflow.
    pub(crate) fn errors(&self) -> u32 {
        self.buffer.status() >> 24 & 7
    }
}

fn moment(controlword: Controlword, demanded: Setpoint) -> Moment {
    let targets = Targets { controlword, ..Targets::default() };
    let actual = Actual { position: demanded.x, velocity: demanded.v, ..Actual::default() };
    Moment { targets, actual, demanded, period: PERIOD }
}

pub(crate) fn idle() -> Controlword {
    Controlword::of(Command::EnableOperation)
}

pub(crate) fn run() -> Controlword {
    idle().with(ControlBit::ModeSpecific4, true)
}

/// A point with a velocity; the time in milliseconds.
pub(crate) fn cubic(position: i32, velocity: i32, ms: u32) -> Point {
    Point { position, is_relative: false, velocity: Some(velocity), time: 1000 * ms }
}

/// A point without one.
pub(crate) fn linear(position: i32, ms: u32) -> Point {
    Point { position, is_relative: false, velocity: None, time: 1000 * ms }
}

pub(crate) fn assert_near(one: f64, other: f64, tolerance: f64) {
    assert!((one - other).abs() <= tolerance, "{one} is not {other}, to {tolerance}");
}

/// The nearest whole number.
#[expect(clippy::cast_possible_truncation, reason = "saturates, and none of the tests goes there")]
pub(crate) fn whole(value: f64) -> i32 {
    value.round() as i32
}
