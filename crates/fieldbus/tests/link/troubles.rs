//! Each fault shows as its state, and the output stays within its bounds.
use crate::rig::{BUS, MOTION, RATE, Rig, follow, sample, settings};
use servobench_base::{Rate, Setpoint, Tick};
use servobench_fieldbus::Interpolation::{self, Busy, Overflow, Run1, Run2, Run3, Slow, Underflow, Wait};
use servobench_fieldbus::link::Settings;
use servobench_motion::interpolate::{Interval, Mode, Sample};
use servobench_motion::{Limits, Order, Profile};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
/// Cycles of the motion task before the move.
const BEFORE: u64 = 12;
/// A cycle in the middle of the acceleration.
const MIDDLE: u64 = BEFORE + 9;

/// The motion at `tick`: at rest, a move of a metre, at rest again.
fn motion(tick: u64) -> Setpoint {
    let profile = Profile::plan(Order::Fourth, 1.0, &LIMITS).unwrap();
    profile.at((tick as f64 - (BEFORE * MOTION) as f64) / RATE)
}

/// A rig whose output is watched.
struct Watched {
    rig: Rig,
    /// Set-points of the last two cycles.
    last: [Setpoint; 2],
    states: Vec<Interpolation>,
    /// Largest acceleration between three cycles.
    acceleration: f64,
    /// Largest difference of accelerations between two cycles, by their time.
    jerk: f64,
    velocity: f64,
}

impl Watched {
    fn new(settings: Settings) -> Self {
        let last = [Setpoint::default(); 2];
        Self { rig: Rig::new(settings), last, states: Vec::new(), acceleration: 0.0, jerk: 0.0, velocity: 0.0 }
    }

    fn cycle(&mut self) -> Interpolation {
        self.rig.cycle();
        let (now, [before, first]) = (self.rig.setpoint(), self.last);
        let h = BUS as f64 / RATE;
        self.velocity = self.velocity.max(((now.x - before.x) / h).abs());
        self.acceleration = self.acceleration.max(((now.x - 2.0 * before.x + first.x) / (h * h)).abs());
        self.jerk = self.jerk.max(((now.a - before.a) / h).abs());
        self.last = [now, before];
        let state = self.rig.state.interpolation();
        if self.states.last() != Some(&state) {
            self.states.push(state);
        }
        state
    }

    /// Runs up to tick `end`; `written` returns the tick of the motion whose sample is written at a tick, if any.
    fn run(&mut self, end: u64, written: impl Fn(u64) -> Option<u64>) {
        while self.rig.tick < end {
            if let Some(due) = written(self.rig.tick) {
                self.rig.write(due, follow(sample(motion(due))));
            }
            self.cycle();
        }
    }

    fn run_in_time(&mut self, end: u64) {
        self.run(end, in_time);
    }

    /// Checks that the acceleration is at most that of the motion, of a wrong prediction by e, below, and of the recovery.
    ///
    /// A sample predicted two steps ahead is off by e = j·(2T)³/6; the polynomial that returns to the right one has at most
    /// 10·e/√3/T² more acceleration (quintic from rest to rest).
    fn assert_bounded(&self) {
        let t = MOTION as f64 / RATE;
        let e = LIMITS.jerk * (2.0 * t).powi(3) / 6.0;
        let recovery = settings().recovery;
        let bound = LIMITS.acceleration + 10.0 * e / 3.0_f64.sqrt() / (t * t) + recovery.acceleration;
        assert!(self.acceleration < bound, "{} m/s² of {bound}", self.acceleration);
        // Both may be at their limits at once; a difference of positions of a metre rounds to 1e-13 m/s.
        assert!(self.velocity < LIMITS.velocity + recovery.velocity + 1e-12, "{}", self.velocity);
        assert!(self.rig.state.fault().is_none() && !self.rig.state.is_limited());
    }

    /// Checks that differences exceed the derivatives of the motion by no more than the error of the quintic at a snap that switches
    /// within its interval: 2·snap·T²/8 at most, the remainder of a line through two points.
    fn assert_undisturbed(&self) {
        let t = MOTION as f64 / RATE;
        assert!(self.acceleration < LIMITS.acceleration + LIMITS.snap * t * t / 4.0, "{}", self.acceleration);
    }

    /// Checks that the trouble has no lasting effect.
    fn assert_arrived(&self) {
        assert_eq!(self.states.last(), Some(&Run1));
        assert!((self.last[0].x - 1.0).abs() < 1e-12, "{}", self.last[0].x);
        assert_eq!(self.rig.drive.counts, 1_000_000);
    }
}

fn in_time(tick: u64) -> Option<u64> {
    tick.is_multiple_of(MOTION).then_some(tick)
}

const END: u64 = 200 * MOTION;

#[test]
fn nothing_wrong_is_run_1_from_the_second_sample_on() {
    let mut axis = Watched::new(settings());
    axis.run_in_time(END);
    axis.assert_bounded();
    axis.assert_arrived();
    assert_eq!(axis.states, [Interpolation::Off, Wait, Run1]);
    axis.assert_undisturbed();
}

#[test]
fn a_late_sample_is_predicted_for_as_long_as_it_is_late() {
    for (late, seen) in
        [(BUS, &[Run2, Run1][..]), (MOTION - BUS, &[Run2, Run1]), (MOTION + BUS, &[Run2, Run3, Run2, Run1])]
    {
        let mut axis = Watched::new(settings());
        let late_one = MIDDLE * MOTION;
        // The next cycle waits for it.
        axis.run(END, |tick| match tick {
            tick if tick == late_one + late => Some(late_one),
            tick if tick == late_one => None,
            tick if late > MOTION && tick == late_one + MOTION => None,
            tick if late > MOTION && tick == late_one + MOTION + 2 * BUS => Some(late_one + MOTION),
            tick => in_time(tick),
        });
        axis.assert_bounded();
        axis.assert_arrived();
        assert_eq!(axis.states[2..], [&[Run1], seen].concat(), "late by {late}");
    }
}

#[test]
fn the_margin_is_no_lateness() {
    let mut axis = Watched::new(Settings { margin: 64, ..settings() });
    axis.run(END, |tick| {
        // Up to the margin late, differently each time.
        let (due, late) = (tick / MOTION * MOTION, tick / MOTION % 5 * BUS);
        (tick == due + late).then_some(due)
    });
    axis.assert_bounded();
    axis.assert_arrived();
    assert_eq!(axis.states, [Interpolation::Off, Wait, Run1]);
    axis.assert_undisturbed();
}

#[test]
fn without_samples_the_axis_is_brought_to_rest_and_starts_again_by_itself() {
    let mut axis = Watched::new(settings());
    axis.run_in_time(MIDDLE * MOTION);
    let mut changes = Vec::new();
    for _ in 0..100 * MOTION / BUS {
        let before = axis.states.len();
        axis.cycle();
        if axis.states.len() > before {
            changes.push((axis.rig.tick - BUS, axis.rig.state.interpolation()));
        }
    }
    // The last sample was that of MIDDLE − 1, whose interval ended at MIDDLE.
    let at = |cycle| (MIDDLE + cycle) * MOTION;
    assert_eq!(changes, [(at(0), Run2), (at(1), Run3), (at(2), Underflow)]);
    let rest = axis.last[0];
    assert_eq!((rest.v, rest.a), (0.0, 0.0));
    assert!(rest.x > 0.0 && rest.x < 1.0, "{}", rest.x);
    axis.assert_bounded();

    // The motion task has gone on meanwhile.
    let now = axis.rig.tick;
    axis.run_in_time(now + 100 * MOTION);
    axis.assert_bounded();
    axis.assert_arrived();
    assert_eq!(axis.states[axis.states.len() - 2..], [Underflow, Run1]);
}

/// Cycle of a motion task whose samples are to be 320 ticks apart.
const FAST: u64 = MOTION - 3 * BUS;

#[test]
fn a_stop_and_a_new_start_while_the_motion_goes_on_are_smooth() {
    let mut axis = Watched::new(settings());
    let gap = MIDDLE * MOTION..(MIDDLE + 6) * MOTION;
    axis.run(END, |tick| in_time(tick).filter(|tick| !gap.contains(tick)));
    axis.assert_bounded();
    axis.assert_arrived();
    assert_eq!(axis.states[2..], [Run1, Run2, Run3, Underflow, Run1]);
    // Motion and recovery; the quintic of a snap that switches has up to snap·T/2 more.
    let bound = LIMITS.jerk + settings().recovery.jerk + LIMITS.snap * MOTION as f64 / RATE / 2.0;
    assert!(axis.jerk < bound, "{} m/s³ of {bound}", axis.jerk);
}

#[test]
fn a_constant_velocity_is_predicted_exactly_in_every_mode() {
    for interpolation in Mode::ALL {
        let mut rig = Rig::new(Settings { interpolation, ..settings() });
        let delay = rig.params.delay();
        let at = |tick: u64| Setpoint { v: 0.5, ..Setpoint::at_rest(0.5 * tick as f64 / RATE) };
        let mut predicted = 0;
        while rig.tick < 200 * MOTION {
            // From some time on every third sample is half a cycle late.
            let (cycle, tick) = (rig.tick / MOTION, rig.tick);
            let late = if cycle > 150 && cycle % 3 == 0 { MOTION / 2 } else { 0 };
            if tick == cycle * MOTION + late {
                rig.write(cycle * MOTION, follow(sample(at(cycle * MOTION))));
            }
            rig.cycle();
            predicted += u32::from(rig.state.interpolation() == Run2);
            if cycle > 140 {
                let (x, expected) = (rig.setpoint().x, at(tick - delay).x);
                assert!((x - expected).abs() < 1e-12, "{interpolation:?}: {x} for {expected}");
            }
        }
        assert!(predicted > 100, "{predicted}");
    }
}

#[test]
fn a_link_that_starts_late_is_not_slow() {
    let mut axis = Watched::new(settings());
    for cycle in 0..10 {
        axis.rig.write(cycle * MOTION, follow(sample(motion(0))));
    }
    axis.rig.tick = 9 * MOTION;
    axis.run_in_time(END);
    assert!(!axis.states.contains(&Slow), "{:?}", axis.states);
    axis.assert_arrived();
}

#[test]
fn a_motion_task_that_is_too_fast_overflows_the_buffer() {
    let mut axis = Watched::new(settings());
    axis.run(END, |tick| tick.is_multiple_of(FAST).then_some(tick / FAST * MOTION));
    axis.assert_arrived();
    let overflows = axis.states.iter().filter(|state| **state == Overflow).count();
    // A sample too many every 320/(320 − 272) samples; it takes AHEAD = 4 and one more to be thrown away.
    let samples = usize::try_from(END / FAST).unwrap();
    assert!((samples / 60..=samples / 20).contains(&overflows), "{overflows} of {samples}: {:?}", axis.states);
    assert!(axis.states.iter().all(|state| !matches!(state, Underflow | Slow | Busy)));
    // The motion runs 320/272 as fast as it was planned.
    let pace = MOTION as f64 / FAST as f64;
    assert!(axis.velocity < pace * LIMITS.velocity + settings().recovery.velocity);
    assert!(axis.rig.state.fault().is_none() && !axis.rig.state.is_limited());
}

#[test]
fn after_an_overflow_the_delay_is_the_nominal_one() {
    let mut rig = Rig::new(Settings { margin: 64, ..settings() });
    let at = |tick: u64| follow(sample(Setpoint { v: 0.5, ..Setpoint::at_rest(0.5 * tick as f64 / RATE) }));
    while rig.state.interpolation() != Overflow {
        if rig.tick.is_multiple_of(FAST) {
            rig.write(rig.tick, at(rig.tick));
        }
        rig.cycle();
    }
    // In time from that sample on.
    let first = rig.tick - BUS;
    for _ in 0..200 * MOTION / BUS {
        if (rig.tick - first).is_multiple_of(MOTION) {
            rig.write(rig.tick, at(rig.tick));
        }
        rig.cycle();
    }
    let expected = 0.5 * (rig.tick - BUS - rig.params.delay()) as f64 / RATE;
    assert!((rig.setpoint().x - expected).abs() < 1e-12, "{} for {expected}", rig.setpoint().x);
}

/// Oracle: the interval from the sample that came to the parabola's next point.
#[test]
fn what_is_predicted_behind_a_late_sample_is_predicted_from_it() {
    // A recovery that is over within a few cycles of the bus.
    let recovery = Limits { velocity: 10.0, acceleration: 1e5, jerk: 1e9, snap: 0.0 };
    let mut rig = Rig::new(Settings { recovery, velocity_limit: 100.0, ..settings() });
    let late = MIDDLE - 4;
    // The jerk is at its highest there. Sample `late` comes when the interval behind it is read.
    while rig.tick < (late + 2) * MOTION {
        let cycle = rig.tick / MOTION;
        if rig.tick.is_multiple_of(MOTION) && cycle < late {
            rig.write(rig.tick, follow(sample(motion(rig.tick))));
        } else if rig.tick == (late + 1) * MOTION + BUS {
            rig.write(late * MOTION, follow(sample(motion(late * MOTION))));
        }
        rig.cycle();
    }
    assert_eq!(rig.state.interpolation(), Run2);
    let t = MOTION as f64 / RATE;
    let came = sample(motion(late * MOTION));
    let next = Sample { x: came.x + t * (came.v + t / 2.0 * came.a), v: came.v + t * came.a, ..came };
    let expected = Interval::new(Mode::Quintic, t, &[came, next]).unwrap().at((MOTION - BUS) as f64 / MOTION as f64);
    let expected = expected.unwrap().setpoint.x;
    assert!((rig.setpoint().x - expected).abs() < 1e-12, "{} for {expected}", rig.setpoint().x);
}

#[test]
fn a_sample_that_is_being_written_is_not_read() {
    let mut axis = Watched::new(settings());
    let due = MIDDLE * MOTION;
    axis.run_in_time(due);
    axis.rig.mailbox.begin();
    assert_eq!(axis.cycle(), Busy);
    axis.rig.mailbox.finish(Tick(due), follow(sample(motion(due))));
    assert_eq!(axis.cycle(), Run1);
    axis.run_in_time(END);
    axis.assert_bounded();
    axis.assert_arrived();
    assert_eq!(axis.states[2..], [Run1, Busy, Run1]);
}

#[test]
fn a_writer_that_never_ends_stops_the_axis() {
    let mut axis = Watched::new(settings());
    axis.run_in_time(MIDDLE * MOTION);
    axis.rig.mailbox.begin();
    for _ in 0..100 * MOTION / BUS {
        assert_eq!(axis.cycle(), Busy);
    }
    assert_eq!((axis.last[0].v, axis.last[0].a), (0.0, 0.0));
    axis.assert_bounded();
}

#[test]
fn a_sample_that_was_overwritten_is_slow() {
    let mut axis = Watched::new(settings());
    let due = MIDDLE * MOTION;
    axis.run_in_time(due);
    // Two at once: the first is lost.
    for due in [due - MOTION / 2, due] {
        axis.rig.write(due, follow(sample(motion(due))));
    }
    assert_eq!(axis.cycle(), Slow);
    axis.run_in_time(END);
    axis.assert_bounded();
    axis.assert_arrived();
}

#[test]
fn an_underflow_after_a_sample_that_was_overwritten_is_one() {
    let mut axis = Watched::new(settings());
    let due = MIDDLE * MOTION;
    axis.run_in_time(due);
    for due in [due - MOTION / 2, due] {
        axis.rig.write(due, follow(sample(motion(due))));
    }
    axis.run(due + 10 * MOTION, |_| None);
    assert_eq!(axis.states[2..], [Run1, Slow, Underflow]);
    axis.assert_bounded();
}

#[test]
fn a_link_that_is_slower_than_the_motion_task_says_so() {
    let hz = |hz| Rate::new(hz).unwrap();
    let base = hz(16_000);
    // Bus 20 ms, motion task 10 ms.
    let bus_cycle = base.divider(hz(50)).unwrap();
    let motion_cycle = base.divider(hz(100)).unwrap();
    let settings = Settings { bus_cycle, motion_cycle, drive_timeout: 3_200, ..settings() };
    let mut rig = Rig::new(settings);
    let mut seen = Vec::new();
    for _ in 0..200 {
        for due in [rig.tick.saturating_sub(160), rig.tick] {
            rig.write(due, follow(sample(motion(due))));
        }
        rig.cycle();
        rig.tick += 320 - BUS;
        seen.push(rig.state.interpolation());
    }
    assert!(seen[20..].iter().all(|state| *state == Slow), "{seen:?}");
    assert_eq!(rig.drive.counts, 1_000_000, "it still arrives");
}

#[test]
fn a_cycle_that_the_motion_task_leaves_out_does_not_change_the_delay() {
    let mut axis = Watched::new(settings());
    axis.run(END / 5, |tick| in_time(tick).filter(|tick| *tick != MIDDLE * MOTION));
    axis.assert_bounded();
    // Compared with an axis to which nothing happened, a second later and still moving.
    let mut other = Watched::new(settings());
    other.run_in_time(END / 5);
    let (x, expected) = (axis.last[0].x, other.last[0].x);
    assert!((x - expected).abs() < 1e-12 && expected < 0.999, "{x} for {expected}");
    assert_eq!(axis.states[2..], [Run1, Run2, Run1]);
}

#[test]
fn a_link_that_stood_still_goes_on_from_where_the_drive_was_left() {
    let mut axis = Watched::new(settings());
    axis.run_in_time(MIDDLE * MOTION);
    let left = axis.last[0].x;
    axis.rig.tick += 2 * MOTION + BUS;
    axis.last = [Setpoint::at_rest(left); 2];
    axis.run_in_time(END);
    axis.assert_bounded();
    axis.assert_arrived();
}
