//! Motion tasks, buses and drives at random, and orderly ones over a bad bus.
use crate::rig::{BUS, MOTION, RATE, Rig, follow, sample, settings};
use servobench_base::{Setpoint, Tick};
use servobench_fieldbus::bus::{self, BusFault, BusFaultKind};
use servobench_fieldbus::link::{self, Control, Input, PositionGains, Sequencing, Settings};
use servobench_fieldbus::{AxisCommand, Interpolation, Task};
use servobench_motion::interpolate::{Mode, Sample};
use servobench_motion::{Limits, Order, Profile};
use servobench_testkit::Random;

/// Size of a sweep: `SERVOBENCH_SWEEP`, or `usual`.
fn sweep_size(usual: u64) -> u64 {
    std::env::var("SERVOBENCH_SWEEP").map_or(usual, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}

/// Commands and settings of a random program.
trait Mad {
    /// A number of either sign, over `decades` below and above one.
    fn magnitude(&mut self, decades: f64) -> f64;

    /// A number, mostly a sensible one.
    fn value(&mut self) -> f64;

    fn task(&mut self) -> Task;

    fn settings(&mut self) -> Settings;
}

impl Mad for Random {
    fn magnitude(&mut self, decades: f64) -> f64 {
        let sign = if self.once_in(2) { 1.0 } else { -1.0 };
        sign * 10.0_f64.powf(decades * (2.0 * self.unit() - 1.0))
    }

    fn value(&mut self) -> f64 {
        match self.below(40) {
            0 => f64::NAN,
            1 => f64::NEG_INFINITY,
            2 => self.magnitude(300.0),
            3..8 => self.magnitude(6.0),
            _ => self.magnitude(1.0),
        }
    }

    fn task(&mut self) -> Task {
        match self.below(60) {
            0..3 => Task::Effort(self.value()),
            3 => Task::Home { position: self.value() },
            _ => Task::Follow(Sample { x: self.value(), v: self.value(), a: self.value(), torque: self.value() }),
        }
    }

    fn settings(&mut self) -> Settings {
        let mode = Mode::ALL[usize::try_from(self.below(7)).unwrap()];
        let position = Control::Position { velocity_offset: self.once_in(2), torque_offset: self.once_in(2) };
        let velocity = Control::Velocity {
            gains: PositionGains::proportional(20.0),
            feedforward: 1.0,
            limit: 3.0,
            torque_offset: self.once_in(2),
        };
        Settings {
            interpolation: mode,
            margin: u32::try_from(self.below(2 * MOTION + 1)).unwrap(),
            control: if self.once_in(3) { velocity } else { position },
            sequencing: if self.once_in(3) { Sequencing::Simplified } else { Sequencing::Strict },
            reverse_switches: self.once_in(2),
            velocity_from_differences: self.once_in(2),
            recovery: Limits {
                velocity: self.magnitude(1.0).abs(),
                acceleration: 10.0 * self.magnitude(1.0).abs(),
                jerk: 1e3 * self.magnitude(1.0).abs(),
                snap: 0.0,
            },
            velocity_limit: 100.0 * self.magnitude(1.0).abs(),
            ..settings()
        }
    }
}

/// Position from which on samples are refused: 2⁵³ counts (m).
const FURTHEST: f64 = 9.1e9;
/// Bus cycles of one life.
const LIFE: u64 = 2_000;

#[test]
fn no_command_makes_the_output_jump_or_end_in_no_number() {
    let mut random = Random::seeded(1);
    let mut seen = [0_u64; Interpolation::ALL.len()];
    for life in 0..sweep_size(200) {
        let settings = random.settings();
        let mut rig = Rig::new(settings);
        let mut due = 0;
        let (mut last, mut at, mut furthest) = (rig.setpoint_now(), 0, 0.0_f64);
        // One kind of task for a while, so that it has an effect.
        let patience = 1 + random.below(30);
        for cycle in 0..LIFE {
            if rig.tick >= due {
                due = rig.tick + BUS * random.below(2 * MOTION / BUS);
                let power = !random.once_in(40);
                let task = random.task();
                let sane = follow(Sample { x: random.magnitude(1.0), ..Sample::default() }).task;
                let task = if random.once_in(patience) { task } else { sane };
                let stamp = if random.once_in(5) { random.below(2 * rig.tick + 1) } else { rig.tick / MOTION * MOTION };
                if let Task::Follow(Sample { x, .. }) = task
                    && x.abs() < FURTHEST
                {
                    furthest = x.abs().max(furthest);
                }
                for _ in 0..=u8::from(random.once_in(30)) {
                    rig.write(stamp, AxisCommand { power, reset: random.once_in(2), ..AxisCommand::of(task) });
                }
            }
            if random.once_in(100) {
                rig.mailbox.begin();
            }
            rig.drive.fault = random.once_in(300);
            rig.external_fault = random.once_in(300);
            rig.drive.actuals.digital_inputs = if random.once_in(50) { 7 } else { 0 };
            if random.once_in(30) {
                rig.answer = None;
            }
            rig.tick += if random.once_in(50) { random.below(4 * MOTION) } else { random.below(BUS / 2) };

            let (before, mode, now) = (rig.state.interpolation(), rig.commands.mode, rig.tick);
            rig.cycle();
            let output = rig.state.setpoint(&rig.params, Tick(now));
            let after = rig.state.interpolation();
            seen[usize::try_from(after.number() + 4).unwrap()] += 1;
            let Setpoint { x, v, a, j, s } = output;
            assert!([x, v, a, j, s].iter().all(|value| value.is_finite()), "life {life}, cycle {cycle}: {output:?}");
            let feedback = rig.feedback();
            assert!(feedback.position.is_finite() && feedback.velocity.is_finite() && feedback.effort.is_finite());
            let follows = mode == rig.commands.mode && matches!(mode, 8 | 9);
            if follows && before != Interpolation::Off && after != Interpolation::Off {
                // The output is the reading plus a difference: it rounds as the farthest sample does, and as the farthest
                // swing of a polynomial with twice the velocity limit at its ends.
                let swing = 2.0 * settings.velocity_limit * MOTION as f64 / RATE;
                let bound = settings.velocity_limit * (now - at) as f64 / RATE + 1e-15 * (furthest + swing);
                assert!((x - last).abs() <= bound, "life {life}, cycle {cycle}: {last} to {x}, {bound} allowed");
            }
            (last, at) = (x, now);
        }
    }
    // Otherwise the test would not cover the states that matter.
    assert!(seen.iter().all(|times| *times > 10), "{seen:?}");
}

impl Rig {
    fn setpoint_now(&self) -> f64 {
        self.state.setpoint(&self.params, Tick(self.tick)).x
    }
}

/// A move over a bus with random faults.
struct Run {
    rig: Rig,
    faults: Vec<BusFault>,
}

impl Run {
    fn new(random: &mut Random) -> Self {
        let delay = u32::try_from(random.below(3)).unwrap();
        let margin = u32::try_from(random.below(64)).unwrap();
        let params = Settings { margin, round_trip: 2 * delay + 1, ..settings() };
        let mut faults: Vec<_> = (0..random.below(8))
            .map(|_| {
                let by = u32::try_from(random.below(2 * BUS)).unwrap();
                let kind = match random.below(5) {
                    0 => BusFaultKind::Lost,
                    1 => BusFaultKind::Late { by },
                    2 => BusFaultKind::MasterStopped,
                    3 => BusFaultKind::DriveSilent,
                    _ => BusFaultKind::Jitter { by, seed: by },
                };
                let from = 300 + random.below(1_500);
                // Shorter than the drive time-out of 100 cycles, all of them together.
                BusFault { kind, cycles: from..from + random.below(12) }
            })
            .collect();
        // The master stops for longer.
        let from = 300 + random.below(1_500);
        faults.push(BusFault { kind: BusFaultKind::MasterStopped, cycles: from..from + random.below(400) });
        Self { rig: Rig::new(params), faults }
    }
}

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

#[test]
fn over_a_bad_bus_the_output_stays_within_what_the_axis_can_do_and_arrives() {
    let mut random = Random::seeded(2);
    let profile = Profile::plan(Order::Fourth, 1.0, &LIMITS).unwrap();
    let mut troubles = 0;
    for run in 0..sweep_size(200) {
        let Run { mut rig, faults } = Run::new(&mut random);
        let wire = bus::Params::new(settings().bus_cycle, (rig.params.settings().round_trip - 1) / 2, &faults).unwrap();
        let mut state = bus::State::default();
        let (mut x, mut v) = ([0.0; 2], 0.0_f64);
        let mut acceleration = 0.0_f64;
        let mut actuals = rig.drive.actuals;
        for tick in 0..4_000 * BUS {
            let Some(cycle) = bus::step(&wire, &mut state, Tick(tick)) else { continue };
            let due = cycle.due.0;
            if due.is_multiple_of(MOTION) && !cycle.master_stopped {
                let motion = profile.at((due as f64 - 250.0 * BUS as f64) / RATE);
                rig.write(due, follow(sample(motion)));
            }
            let heard = state.to_master(&wire, &cycle, actuals);
            let input = Input { tick: cycle.due, mailbox: &rig.mailbox, actuals: heard, external_fault: false };
            let commands = link::step(&rig.params, &mut rig.state, input);
            if let Some(commands) = state.to_drive(&wire, &cycle, commands) {
                rig.commands = commands;
            }
            actuals = rig.drive.step(&rig.commands);
            let now = rig.state.setpoint(&rig.params, cycle.due).x;
            let h = BUS as f64 / RATE;
            v = v.max(((now - x[0]) / h).abs());
            acceleration = acceleration.max(((now - 2.0 * x[0] + x[1]) / (h * h)).abs());
            x = [now, x[0]];
            troubles += u64::from(!matches!(rig.state.interpolation(), Interpolation::Run1 | Interpolation::Off));
        }
        assert_eq!(rig.state.fault(), None, "run {run}: {faults:?}");
        // As for single faults (troubles.rs), but corrections and recoveries may overlap: twice.
        let t = MOTION as f64 / RATE;
        let e = LIMITS.jerk * (2.0 * t).powi(3) / 6.0;
        let bound =
            LIMITS.acceleration + 2.0 * (10.0 * e / 3.0_f64.sqrt() / (t * t) + settings().recovery.acceleration);
        assert!(acceleration < bound, "run {run}: {acceleration} m/s² of {bound}: {faults:?}");
        assert!(v <= settings().velocity_limit, "run {run}: {v} m/s");
        assert_eq!(rig.drive.counts, 1_000_000, "run {run}: {faults:?}");
    }
    assert!(troubles > 1_000, "{troubles}");
}
