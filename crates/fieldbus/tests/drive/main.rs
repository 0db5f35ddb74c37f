//! The link over a bus with the drive that it controls.
mod rig;

use rig::{BUS, DELAY, MOTION, RATE, Rig};
use servobench_base::{Setpoint, Tick};
use servobench_cia402::PowerState;
use servobench_drive::modes::homing::Method;
use servobench_fieldbus::bus::{BusFault, BusFaultKind};
use servobench_fieldbus::{AxisCommand, Fault, Homing, Interpolation, LinkFault, Power, Task};
use servobench_motion::interpolate::Sample;
use servobench_motion::{Limits, Order, Profile};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
/// Start of the move (base ticks).
const START: u64 = 10 * MOTION;

/// Acceleration that targets in whole counts add to the drive's cubic (m/s²): a step of a count within a cycle of the bus
/// and back, 6·count/T².
const ROUNDING: f64 = 6.0 * 1e-6 / (1e-3 * 1e-3);

/// The motion at `tick`: at rest, a move of a metre, at rest again.
fn motion(tick: u64) -> Setpoint {
    let profile = Profile::plan(Order::Fourth, 1.0, &LIMITS).unwrap();
    profile.at((tick as f64 - START as f64) / f64::from(RATE))
}

fn follow(setpoint: Setpoint) -> AxisCommand {
    let Setpoint { x, v, a, .. } = setpoint;
    AxisCommand::of(Task::Follow(Sample { x, v, a, torque: 0.0 }))
}

fn moving(tick: u64) -> AxisCommand {
    follow(motion(tick))
}

fn resting(x: f64) -> impl Fn(u64) -> AxisCommand {
    move |_| follow(Setpoint::at_rest(x))
}

#[test]
fn the_axis_is_where_the_samples_were_a_constant_time_ago() {
    let mut rig = Rig::new();
    // The delay of the link, of the bus, and the cycle over which the drive reaches a target; the axis is read one step of the
    // drive after its demand.
    let delay = rig.params.delay() + BUS * u64::from(DELAY) + BUS;
    rig.run(START, moving);
    assert_eq!((rig.feedback().power, rig.feedback().fault), (Power::On, None));
    for _ in 0..150 * MOTION / BUS {
        rig.run(BUS, moving);
        let error = rig.axis.x - motion((rig.tick).saturating_sub(delay)).x;
        // A count of rounding; the quintic of the link and the cubic of the drive are off by less.
        assert!(error.abs() < 1.1e-6, "tick {}: {error}", rig.tick);
    }
    assert!((rig.feedback().position - 1.0).abs() < 1e-12);
    assert!(rig.peaks[1] < LIMITS.acceleration + ROUNDING, "{:?}", rig.peaks);
}

#[test]
fn homing_and_a_move_from_there() {
    let mut rig = Rig::new();
    rig.run(START, resting(0.0));
    let home = |_| AxisCommand::of(Task::Home { position: 0.25 });
    rig.run(5 * MOTION, home);
    assert_eq!((rig.feedback().homing, rig.feedback().fault), (Homing::Attained, None));
    assert!((rig.feedback().position - 0.25).abs() < 1e-12);
    rig.run(10 * MOTION, resting(0.25));
    assert!(rig.axis.x.abs() < 1e-12, "{}", rig.axis.x);
    let from = rig.tick;
    rig.run(150 * MOTION, |tick| {
        let setpoint = motion(tick - from + START);
        follow(Setpoint { x: 0.25 + setpoint.x, ..setpoint })
    });
    assert!((rig.axis.x - 1.0).abs() < 1e-9, "{}", rig.axis.x);
}

/// A drive that has found its reference counts from another zero. If homing is cancelled about that time, nothing jumps by the distance
/// between the two zeros.
#[test]
fn a_homing_that_is_taken_back_as_it_ends_moves_nothing() {
    let places = (0..900_u32).map(|place| 1e-3 + 37e-6 * f64::from(place));
    let found = places.clone().filter(|switch| {
        let mut rig = Rig::new();
        rig.drive_params.homing.method = Method::from_number(24).unwrap();
        rig.run(START, resting(0.0));
        let taken_back = rig.tick + 45 * MOTION;
        while rig.tick < taken_back + 12 * MOTION {
            rig.measured.home = rig.axis.x >= *switch;
            let heard = rig.feedback().demanded();
            let home = AxisCommand::of(Task::Home { position: 0.7374 });
            rig.run(1, |tick| if tick < taken_back { home } else { resting(heard)(tick) });
        }
        assert_eq!((rig.feedback().fault, rig.feedback().homing), (None, Homing::Idle));
        assert!(rig.peaks[0] < 0.051, "switch at {switch} m: {:?}", rig.peaks);
        rig.feedback().position > 0.5
    });
    assert!((40..860).contains(&found.count()));
}

#[test]
fn a_limit_switch_stops_the_axis_and_lets_it_out_again() {
    let mut rig = Rig::new();
    rig.run(START + 40 * MOTION, moving);
    rig.measured.positive_limit = true;
    // The drive brakes from 1 m/s with 1 m/s² (6084h).
    rig.run(60 * MOTION, moving);
    assert_eq!(rig.feedback().fault, Some(Fault::Link(LinkFault::PositiveLimit)));
    let x = rig.axis.x;
    rig.run(10 * MOTION, moving);
    assert_eq!((rig.axis.x, rig.drive.power()), (x, PowerState::OperationEnabled));
    rig.peaks = [0.0; 2];
    let reset = |tick| AxisCommand { reset: true, ..resting(x)(tick) };
    rig.run(3 * MOTION, reset);
    rig.run(10 * MOTION, resting(x));
    assert_eq!(rig.feedback().fault, None);
    let from = rig.tick;
    rig.run(150 * MOTION, |tick| {
        let setpoint = motion(tick - from + START);
        follow(Setpoint { x: x - setpoint.x, v: -setpoint.v, a: -setpoint.a, ..setpoint })
    });
    assert_eq!(rig.feedback().fault, None);
    assert!((rig.axis.x - (x - 1.0)).abs() < 2e-6, "{}", rig.axis.x);
    assert!(rig.peaks[1] < LIMITS.acceleration + ROUNDING, "{:?}", rig.peaks);
}

#[test]
fn faults_of_the_drive_are_reset_and_the_axis_goes_on_without_a_jump() {
    let mut rig = Rig::new();
    rig.run(START + 40 * MOTION, moving);
    rig.fault = Some(0x4310);
    rig.run(20 * MOTION, moving);
    assert_eq!(rig.feedback().fault, Some(Fault::Drive(0x4310)));
    assert_eq!(rig.drive.power(), PowerState::Fault);
    rig.fault = None;
    rig.peaks = [0.0; 2];
    // The motion task did not wait: the difference is removed during its motion.
    rig.run(MOTION, |tick| AxisCommand { reset: true, ..moving(tick) });
    rig.run(300 * MOTION, moving);
    assert_eq!((rig.feedback().fault, rig.feedback().power), (None, Power::On));
    assert!((rig.axis.x - 1.0).abs() < 1e-9, "{}", rig.axis.x);
    rig.assert_recovered();
}

#[test]
fn a_stopped_motion_task_stops_the_axis_within_its_limits() {
    let mut rig = Rig::new();
    let stopped = (START + 40 * MOTION) / BUS;
    rig.faults = vec![BusFault { kind: BusFaultKind::MasterStopped, cycles: stopped..stopped + 2_000 }];
    rig.run(START + 100 * MOTION, moving);
    assert_eq!(rig.feedback().interpolation, Interpolation::Underflow);
    assert_eq!((rig.axis.v, rig.feedback().fault), (0.0, None));
    rig.run(300 * MOTION, moving);
    assert_eq!(rig.feedback().interpolation, Interpolation::Run1);
    assert!((rig.axis.x - 1.0).abs() < 1e-9, "{}", rig.axis.x);
    rig.assert_recovered();
}

#[test]
fn the_set_point_within_a_bus_cycle_is_where_the_drive_will_be() {
    let mut rig = Rig::new();
    rig.run(START + 40 * MOTION, moving);
    let ahead = BUS * u64::from(DELAY) + BUS;
    let expected: Vec<_> = (0..BUS).map(|tick| rig.link.setpoint(&rig.params, Tick(rig.tick - BUS + tick)).x).collect();
    rig.run(ahead - BUS, moving);
    for expected in expected.iter().step_by(4) {
        assert!((rig.axis.x - expected).abs() < 1e-6, "{} for {expected}", rig.axis.x);
        rig.run(4, moving);
    }
}

impl Rig {
    /// Checks the peaks: motion and recovery, both at their limits at worst; a predicted sample is off by j·(2T)³/6, and the return
    /// to the right one has 10/√3 of that over T² (quintic from rest to rest).
    fn assert_recovered(&self) {
        let recovery = self.params.settings().recovery;
        let t = MOTION as f64 / f64::from(RATE);
        let predicted = 10.0 / 3.0_f64.sqrt() * LIMITS.jerk * 8.0 * t / 6.0;
        let [velocity, acceleration] = self.peaks;
        assert!(velocity < LIMITS.velocity + recovery.velocity + 1e-3, "{velocity}: a count per cycle is 1 mm/s");
        assert!(acceleration < LIMITS.acceleration + recovery.acceleration + predicted + ROUNDING, "{acceleration}");
    }
}

/// Friction and lag keep the axis away from the demand at which the drive ends homing. Oracle: the master counts from that demand,
/// and neither the demand nor the axis moves by more than the half count of rounding when csp takes over.
#[test]
fn homing_hands_over_what_the_drive_follows() {
    for behind in [-36.4e-6, 41.3e-6, 0.0, 2.49e-3] {
        let mut rig = Rig::new();
        rig.run(START, resting(0.0));
        rig.behind = behind;
        let home = |_| AxisCommand::of(Task::Home { position: -0.125 });
        rig.run(5 * MOTION + 7, home);
        let feedback = rig.feedback();
        assert_eq!((feedback.homing, feedback.fault), (Homing::Attained, None));
        // With homing method 35 the reference is the present position.
        assert!((feedback.position + 0.125).abs() < 1e-12, "{feedback:?}");
        assert!((feedback.following_error - behind).abs() <= 0.51e-6, "{feedback:?}");
        let (at, setpoint) = (rig.axis.x, feedback.demanded());
        rig.peaks = [0.0; 2];
        rig.run(10 * MOTION, resting(setpoint));
        assert!((rig.axis.x - at).abs() <= 0.51e-6, "{behind}: {} {at}", rig.axis.x);
        assert!(rig.peaks[0] <= 0.51e-6 * 1.6 / 1e-3, "{behind}: {:?}", rig.peaks);
    }
}
