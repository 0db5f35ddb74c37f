//! csv: the master closes the position loop over a bus that delays its frames by some cycles.
//!
//! The axis is ideal; the bounds are those of the derivation in `link/position_loop.rs`.
use crate::rig::{BUS, Drive, MOTION, RATE, follow, sample, settings};
use servobench_base::{Setpoint, Tick};
use servobench_cia402::{Actuals, Commands};
use servobench_fieldbus::link::{self, Control, Input, Mailbox, Params, PositionGains, Settings, State, Units};
use servobench_motion::{Limits, Order, Profile};
use std::collections::VecDeque;

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
const WAY: f64 = 1.9;
const START: u64 = 10 * MOTION;
/// 3 s later, when the move of 2.25 s is over.
const END: u64 = START + 48_000;
/// Base ticks per step of the drive, which measures at its steps.
const STEP: u64 = 4;
/// Position gain (1/s).
const GAIN: f64 = 60.0;
/// A unit of position on the bus (m); one of velocity is as much per second.
const UNIT: f64 = 1e-9;

/// Course of the axis from one velocity to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Between {
    /// In a line.
    Line,
    /// In steps of that line, each held for a step of the drive: it lags by half of it.
    Held,
}

struct Loop {
    params: Params,
    state: State,
    mailbox: Mailbox,
    drive: Drive,
    between: Between,
    to_drive: VecDeque<Option<Commands>>,
    to_master: VecDeque<Option<Actuals>>,
    commands: Commands,
    /// The ends of the line that the drive is on, and its steps on it.
    velocities: [f64; 2],
    steps: u64,
    answer: Actuals,
    x: f64,
    tick: u64,
    /// Output of each cycle.
    put_out: Vec<Setpoint>,
    /// Cycles whose answers are lost.
    lost: std::ops::Range<u64>,
}

impl Loop {
    fn new(delay: u32, gain: f64, feedforward: f64, between: Between) -> Self {
        let settings = Settings {
            control: Control::Velocity {
                gains: PositionGains::proportional(gain),
                feedforward,
                limit: 2.0,
                torque_offset: false,
            },
            round_trip: 2 * delay + 1,
            answer_age: u32::try_from(STEP).unwrap(),
            units: Units { drive_units: 1.0 / UNIT, velocity_factor: 1.0, ..settings().units },
            velocity_limit: 2.0,
            ..settings()
        };
        // The command sent `delay` cycles before arrives.
        let empty = delay as usize;
        Self {
            params: Params::new(settings).unwrap(),
            state: State::default(),
            mailbox: Mailbox::default(),
            drive: Drive::new(settings.units.counter),
            between,
            to_drive: vec![None; empty].into(),
            to_master: vec![None; empty].into(),
            commands: Commands::default(),
            velocities: [0.0; 2],
            steps: 0,
            answer: Actuals::default(),
            x: 0.0,
            tick: 0,
            put_out: Vec::new(),
            lost: 0..0,
        }
    }

    /// A cycle of the bus.
    fn cycle(&mut self, motion: impl Fn(u64) -> Setpoint) {
        if self.tick.is_multiple_of(MOTION) {
            self.mailbox.write(Tick(self.tick), follow(sample(motion(self.tick))));
        }
        let is_lost = self.lost.contains(&(self.tick / BUS));
        self.to_master.push_back((!is_lost).then_some(self.answer));
        let actuals = self.to_master.pop_front().flatten();
        let input = Input { tick: Tick(self.tick), mailbox: &self.mailbox, actuals, external_fault: false };
        let commands = link::step(&self.params, &mut self.state, input);
        self.put_out.push(self.state.setpoint(&self.params, Tick(self.tick)));
        self.to_drive.push_back(Some(commands));
        if let Some(arrived) = self.to_drive.pop_front().flatten() {
            self.commands = arrived;
            self.velocities = [self.velocities[1], f64::from(arrived.target_velocity) * UNIT];
            self.steps = 0;
        }
        for _ in 0..BUS / STEP {
            self.step();
        }
        self.tick += BUS;
    }

    /// Runs a step of the drive: it measures, then the axis moves.
    fn step(&mut self) {
        let position = counts(self.x);
        self.answer = Actuals { position, position_demand: position, ..self.drive.step(&self.commands) };
        let [from, to] = self.velocities;
        let at = |steps: u64| from + (to - from) * steps as f64 * STEP as f64 / BUS as f64;
        let v = match self.between {
            Between::Line => f64::midpoint(at(self.steps), at(self.steps + 1)),
            Between::Held => at(self.steps),
        };
        self.steps += 1;
        self.x += v * STEP as f64 / RATE;
    }

    /// Distance of the axis from the set-point that is due now, `delay` cycles of the bus after its output.
    fn error(&self, delay: u32) -> f64 {
        // A set-point is reached at the end of the cycle that begins when it arrives.
        let due = self.put_out.len().saturating_sub(1 + delay as usize);
        self.put_out[due].x - self.x
    }
}

/// The nearest count; two metres are within the 32 bits of the counter.
#[expect(clippy::cast_possible_truncation, reason = "a whole number within the counter")]
fn counts(x: f64) -> i32 {
    (x / UNIT).round() as i32
}

/// At rest, a move, at rest again.
fn motion(tick: u64) -> Setpoint {
    Profile::plan(Order::Fourth, WAY, &LIMITS).unwrap().at((tick as f64 - START as f64) / RATE)
}

/// The largest error of all, and that at constant velocity, 0.4 s = 24/K after the acceleration has ended.
fn errors(delay: u32, feedforward: f64, between: Between) -> [f64; 2] {
    let mut axis = Loop::new(delay, GAIN, feedforward, between);
    let (mut largest, mut cruising, mut cruises) = (0.0_f64, 0.0_f64, 0);
    while axis.tick < END {
        axis.cycle(motion);
        let error = axis.error(delay).abs();
        assert_eq!(axis.state.fault(), None);
        largest = largest.max(error);
        cruises = if motion(axis.tick).v > LIMITS.velocity - 1e-9 { cruises + BUS } else { 0 };
        if cruises as f64 > 0.4 * RATE {
            cruising = cruising.max(error);
        }
    }
    assert!(cruising > 0.0, "cruised");
    assert!((axis.x - WAY).abs() < 0.51 * UNIT, "{}", axis.x);
    [largest, cruising]
}

/// Largest jerk of the output (m/s³): quintics between samples have more than the motion.
fn jerk() -> f64 {
    let mut axis = Loop::new(0, GAIN, 1.0, Between::Line);
    let mut largest = 0.0_f64;
    while axis.tick < END {
        axis.cycle(motion);
        largest = largest.max(axis.put_out.last().unwrap().j.abs());
    }
    largest
}

#[test]
fn the_error_is_that_of_the_derivation_whatever_the_delay_of_the_bus() {
    let cycle = BUS as f64 / RATE;
    for delay in [0, 1, 2] {
        assert!(GAIN * f64::from(2 * delay + 2) * cycle < 1.0_f64.exp().recip(), "does not swing");
        // Half a count of the received position, half a unit of velocity.
        let units = 0.5 * UNIT + 0.5 * UNIT / GAIN + 1e-14;
        let line = jerk() * cycle * cycle / 12.0 / GAIN;
        for (between, lag) in [(Between::Line, 0.0), (Between::Held, STEP as f64 / RATE / 2.0)] {
            let [largest, cruising] = errors(delay, 1.0, between);
            let bound = LIMITS.acceleration * lag / GAIN + line + units;
            println!("{delay} {between:?}: {largest:.3e} of {bound:.3e} m, {cruising:.3e} m at constant velocity");
            assert!(cruising <= units, "{cruising:e} of {units:e}");
            assert!(largest <= bound, "{largest:e} of {bound:e}");
            // The acceleration holds for 0.1 s, six times 1/K.
            assert!(between == Between::Line || largest > 0.95 * bound, "{largest:e} of {bound:e}");
        }
    }
}

#[test]
fn without_feedforward_the_axis_lags_by_velocity_over_gain_and_no_more() {
    for (delay, feedforward) in [(0, 0.0), (1, 0.0), (2, 0.0), (1, 0.75)] {
        let [_, cruising] = errors(delay, feedforward, Between::Line);
        let lag = (1.0 - feedforward) * LIMITS.velocity / GAIN;
        assert!((cruising - lag).abs() < 0.51 * UNIT, "{cruising:e} for {lag:e}");
    }
}

/// Oracle: none was lost. At constant velocity the last difference is the next one, too.
#[test]
fn answers_that_are_lost_at_constant_velocity_change_nothing() {
    let mut axis = Loop::new(1, GAIN, 1.0, Between::Line);
    // A second into the move.
    let middle = START + 16_000;
    axis.lost = middle / BUS..middle / BUS + 20;
    while axis.tick < middle + 40 * BUS {
        axis.cycle(motion);
        if axis.tick > middle {
            assert!(axis.error(1).abs() < 0.51 * UNIT, "{:e}", axis.error(1));
        }
    }
}

/// Oracle: an axis that is pushed off by a millimetre comes back below the ultimate gain and swings away above it.
#[test]
fn the_gain_margin_is_where_the_loop_begins_to_swing() {
    for delay in [0, 1, 3, 15] {
        let cycle = BUS as f64 / RATE;
        let dead_time = (f64::from(2 * delay + 1) * BUS as f64 + STEP as f64) / RATE;
        // The drive takes a cycle to get there.
        let ultimate_gain = 2.0 / cycle * (core::f64::consts::FRAC_PI_4 * cycle / dead_time.max(cycle)).tan();
        let margin = ultimate_gain / GAIN;
        // At an age of a quarter of a cycle the formula is 2.8 % too high for a round trip of one cycle.
        for (share, comes_back) in [(0.96, true), (1.04, false)] {
            let mut axis = Loop::new(delay, share * margin * GAIN, 1.0, Between::Line);
            let rest = |_| Setpoint::default();
            while axis.tick < START {
                axis.cycle(rest);
            }
            axis.x += 1e-3;
            let mut last = 0.0_f64;
            for cycle in 0..4_000 {
                axis.cycle(rest);
                assert_eq!(axis.state.fault(), None);
                last = if cycle < 3_800 { 0.0 } else { last.max(axis.x.abs()) };
            }
            assert_eq!(last < 1e-3, comes_back, "delay {delay}, {share} of {margin}: {last}");
        }
    }
}
