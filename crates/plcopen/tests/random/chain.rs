//! The axis behind a link, a bus and a drive (CiA 402), which lags, faults, loses power and frames.
//!
//! A position that takes over from an effort, or from an interrupted ramp to power off, is not checked for a while: the set-point begins
//! at the position that the master has read, and jumps by the distance covered since.
use super::chance::Chance;
use super::{CYCLE_TIME, Follower, LIMITS};
use servobench_base::{Rate, Setpoint, Tick};
use servobench_cia402::Commands;
use servobench_cia402::counter::Counter;
use servobench_drive::Demand;
use servobench_drive::device::{self, CycleParams, Inputs, Measured};
use servobench_fieldbus::bus;
use servobench_fieldbus::link::{self, Control, Input, Mailbox, Sequencing, Settings, Units};
use servobench_fieldbus::{AxisCommand, AxisFeedback, Power};
use servobench_motion::Limits;
use servobench_motion::interpolate::Mode;

/// Base ticks per second, per cycle of the motion task and of the bus, and per step of the drive.
const RATE: u32 = 16_000;
const MOTION: u64 = 32;
const BUS: u32 = 16;
const DRIVE: u64 = 4;
const PERIOD: f64 = DRIVE as f64 / RATE as f64;
/// Delay of a frame (cycles of the bus).
const DELAY: u32 = 1;
/// Time constant with which the axis follows the demand (s).
const LAG: f64 = 7e-3;
/// One count per cycle of the bus, and as much again for the cubic between rounded targets (m/s).
const ROUNDING: f64 = 2.0 * 1e-6 * RATE as f64 / BUS as f64;
/// Time after a takeover in which the demand may jump (steps of the drive).
const TAKES_OVER: u32 = 80;
/// Highest velocity that the link commands, and therefore that the drive demands.
const FASTEST: f64 = 1.1 * LIMITS.velocity;

/// Link, bus, drive and axis.
pub(crate) struct Chain {
    settings: link::Params,
    link: link::State,
    mailbox: Mailbox,
    wire: bus::State,
    drive_params: device::Params,
    drive: device::State,
    frame: Option<Commands>,
    axis: Setpoint,
    /// The last position demand.
    demand: Option<f64>,
    /// Steps until the demand is checked again.
    taking_over: u32,
    fault: Option<u16>,
    tick: u64,
}

impl Default for Chain {
    fn default() -> Self {
        let rate = Rate::new(RATE).unwrap();
        let cycle = CycleParams { steps: BUS / 4, shift: 0, bridged: 3 };
        let drive_params = device::Params { cycle, interpolation: Mode::Cubic, ..device::Params::default() };
        Self {
            settings: link::Params::new(Settings {
                base_rate: rate,
                bus_cycle: rate.divider(Rate::new(RATE / BUS).unwrap()).unwrap(),
                motion_cycle: rate.divider(Rate::new(500).unwrap()).unwrap(),
                interpolation: Mode::Quintic,
                margin: 0,
                run_ahead: 0,
                control: Control::Position { velocity_offset: true, torque_offset: true },
                sequencing: Sequencing::Strict,
                drive_timeout: 8_000,
                round_trip: 2 * DELAY + 1,
                answer_age: 0,
                reverse_switches: false,
                units: Units {
                    drive_units: 1e6,
                    axis_units: 1.0,
                    velocity_factor: 1.0,
                    rated_effort: 1.0,
                    counter: Counter::signed(32).unwrap(),
                },
                velocity_from_differences: false,
                recovery: Limits { velocity: 0.5, acceleration: 5.0, jerk: 200.0, snap: 0.0 },
                velocity_limit: FASTEST,
            })
            .unwrap(),
            link: link::State::default(),
            mailbox: Mailbox::default(),
            wire: bus::State::default(),
            drive_params,
            drive: device::State::new(&drive_params).unwrap(),
            frame: None,
            axis: Setpoint::default(),
            demand: None,
            taking_over: 0,
            fault: None,
            tick: 0,
        }
    }
}

impl Follower for Chain {
    fn feedback(&self) -> AxisFeedback {
        self.link.feedback(&self.settings)
    }

    fn follow(&mut self, command: &AxisCommand, chance: &mut Chance, place: &str) {
        assert!((CYCLE_TIME * f64::from(RATE) - MOTION as f64).abs() < 1e-9);
        self.fault = match self.fault {
            None => chance.once_in(3000).then_some(0x2310),
            Some(code) => (!chance.once_in(50)).then_some(code),
        };
        let main_voltage = !chance.once_in(3000);
        for _ in 0..MOTION {
            self.turn_bus(*command, chance);
            if self.tick.is_multiple_of(DRIVE) {
                self.turn_drive(main_voltage, place);
            }
            self.tick += 1;
        }
    }
}

impl Chain {
    fn turn_bus(&mut self, command: AxisCommand, chance: &mut Chance) {
        let wire = bus::Params::new(self.settings.settings().bus_cycle, DELAY, &[]).unwrap();
        let Some(cycle) = bus::step(&wire, &mut self.wire, Tick(self.tick)) else { return };
        let actuals = self.wire.to_master(&wire, &cycle, self.drive.actuals(&self.drive_params));
        if cycle.due.0.is_multiple_of(MOTION) {
            self.mailbox.write(cycle.due, command);
        }
        let input = Input { tick: cycle.due, mailbox: &self.mailbox, actuals, external_fault: cycle.external_fault };
        let commands = link::step(&self.settings, &mut self.link, input);
        let arrived = self.wire.to_drive(&wire, &cycle, commands);
        self.frame = arrived.filter(|_| !chance.once_in(2000));
    }

    fn turn_drive(&mut self, main_voltage: bool, place: &str) {
        let measured = Measured {
            increments: self.drive_params.units.increments(self.axis.x),
            velocity: self.axis.v,
            ..Measured::default()
        };
        let frame = self.frame.take();
        let inputs = Inputs { frame: frame.as_ref(), measured, fault: self.fault, main_voltage };
        let demand = device::step(&self.drive_params, &mut self.drive, &inputs).demand;
        let last = self.demand.take();
        let before = self.axis;
        self.axis.x += match demand {
            Demand::Position { setpoint, .. } => {
                assert!(setpoint.x.is_finite() && setpoint.v.is_finite(), "{place}: {setpoint:?}");
                let is_on = self.feedback().power == Power::On;
                self.taking_over = if is_on { self.taking_over.saturating_sub(1) } else { TAKES_OVER };
                if let Some(last) = last.filter(|_| self.taking_over == 0) {
                    let mean = (setpoint.x - last).abs() / PERIOD;
                    assert!(mean <= FASTEST + ROUNDING, "{place}: {mean} m/s from {last} to {setpoint:?}");
                }
                self.demand = Some(setpoint.x);
                (setpoint.x - before.x) * PERIOD / LAG + setpoint.v * PERIOD
            }
            Demand::Velocity { setpoint, .. } => setpoint.v * PERIOD,
            Demand::Effort(effort) => {
                self.taking_over = TAKES_OVER;
                (before.v + 0.001 * effort).clamp(-1.2, 1.2) * PERIOD
            }
            // Friction brakes an undriven axis.
            Demand::Off => 0.99 * before.v * PERIOD,
        };
        self.axis.v = (self.axis.x - before.x) / PERIOD;
    }
}
