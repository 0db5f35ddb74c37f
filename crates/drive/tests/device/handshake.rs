//! Profile position: bits 4, 5, 6 and 9 of the controlword against bits 10 and 12 of the statusword, frame by frame as in the
//! timing diagrams of the profile (IEC 61800-7-201, profile position mode, set-point handshake).
use crate::axis::Axis;
use servobench_cia402::{ControlBit, Mode, StatusBit};
use servobench_drive::device::{Params, Window};

/// One frame per step, so that bits are seen at every step; no waiting time in the window.
fn axis() -> Axis {
    let mut params = Params { position: Window { width: 2e-6, time: 0.0 }, ..Params::default() };
    params.cycle.steps = 1;
    let mut axis = Axis::enabled(&params, Mode::ProfilePosition);
    axis.frame.profile_velocity = 100_000;
    (axis.frame.profile_acceleration, axis.frame.profile_deceleration) = (1_000_000, 1_000_000);
    axis
}

impl Axis {
    fn steps(&mut self, count: u32) {
        for _ in 0..count {
            self.step(true);
        }
    }

    fn micrometres(&self) -> f64 {
        self.position * 1e6
    }
}

#[test]
fn a_single_set_point_is_acknowledged_until_bit_4_falls_and_reached_at_the_end() {
    let mut axis = axis();
    assert!(axis.has(StatusBit::TargetReached) && !axis.has(StatusBit::ModeSpecific12));
    axis.frame.target_position = 10_000;
    axis.step(true);
    assert!(!axis.has(StatusBit::ModeSpecific12), "a target without the edge of bit 4 is none");
    axis.set(ControlBit::ModeSpecific4, true);
    axis.step(true);
    assert!(axis.has(StatusBit::ModeSpecific12) && !axis.has(StatusBit::TargetReached), "taken at the edge");
    // While bit 4 stays, neither bit 12 falls nor is another target taken.
    axis.frame.target_position = 99_000;
    for _ in 0..5 {
        axis.step(true);
        assert!(axis.has(StatusBit::ModeSpecific12));
    }
    axis.set(ControlBit::ModeSpecific4, false);
    axis.step(true);
    assert!(!axis.has(StatusBit::ModeSpecific12), "free for the next one");
    // 0.1 m/s by 1 m/s²: 10 mm are two ramps of 5 mm, 0.2 s.
    let steps = axis.settle() + 7;
    assert!((799..=801).contains(&steps), "{steps}");
    assert!((axis.micrometres() - 10_000.0).abs() < 1e-9, "{}", axis.micrometres());
}

#[test]
fn one_set_point_waits_and_the_next_edge_is_lost() {
    let mut axis = axis();
    assert!(axis.give(10_000));
    assert!(axis.give(20_000), "the buffer was free");
    axis.set(ControlBit::ModeSpecific4, false);
    axis.step(true);
    assert!(axis.has(StatusBit::ModeSpecific12), "the buffer is full: bit 12 stays");
    assert!(!axis.give(-5_000));
    axis.set(ControlBit::ModeSpecific4, false);
    // Bit 10 does not come in between, bit 12 falls when the second one is under way.
    let mut freed_at = None;
    for k in 0.. {
        axis.step(true);
        if freed_at.is_none() && !axis.has(StatusBit::ModeSpecific12) {
            freed_at = Some((k, axis.micrometres()));
        }
        if axis.has(StatusBit::TargetReached) {
            break;
        }
    }
    let (_, freed) = freed_at.unwrap();
    assert!((freed - 10_000.0).abs() < 1.0, "the first one is finished with a stop: {freed}");
    assert!((axis.micrometres() - 20_000.0).abs() < 1e-9);
}

#[test]
fn a_change_set_immediately_replaces_what_is_under_way_and_what_waits() {
    let mut axis = axis();
    assert!(axis.give(100_000) && axis.give(200_000));
    axis.steps(400);
    let here = axis.micrometres();
    axis.set(ControlBit::ModeSpecific5, true);
    axis.give(20_000);
    axis.set(ControlBit::ModeSpecific4, false);
    axis.step(true);
    assert!(!axis.has(StatusBit::ModeSpecific12), "nothing waits any more");
    axis.settle();
    assert!(here < 20_000.0 && (axis.micrometres() - 20_000.0).abs() < 1e-9, "{here}");
}

/// Oracle: after 0.1 s the axis is at 5 mm with 0.1 m/s; it stops within 5 mm, at 10 mm, and goes back to 2 mm.
#[test]
fn a_target_behind_is_reached_by_braking_and_going_back() {
    let mut axis = axis();
    axis.set(ControlBit::ModeSpecific5, true);
    assert!(axis.give(100_000));
    axis.steps(399);
    axis.give(2_000);
    let mut furthest = 0.0_f64;
    while !axis.has(StatusBit::TargetReached) {
        axis.step(true);
        furthest = furthest.max(axis.micrometres());
    }
    // A step more at 0.1 m/s are 25 µm.
    assert!((furthest - 10_025.0).abs() < 1.0, "{furthest}");
    assert!((axis.micrometres() - 2_000.0).abs() < 1e-9);
}

#[test]
fn relative_set_points_count_from_the_target_before() {
    let mut axis = axis();
    axis.set(ControlBit::ModeSpecific6, true);
    assert!(axis.give(3_000) && axis.give(-1_000));
    axis.set(ControlBit::ModeSpecific4, false);
    axis.settle();
    assert!((axis.micrometres() - 2_000.0).abs() < 1e-9);
    // At once: relative to the target under way, not to the present position.
    axis.set(ControlBit::ModeSpecific5, true);
    axis.give(5_000);
    axis.steps(100);
    axis.give(5_000);
    axis.settle();
    assert!((axis.micrometres() - 12_000.0).abs() < 1e-9);
}

/// Oracle: the axis passes the set-point at its profile velocity, 0.1 m/s, and keeps it towards the next one until it
/// brakes for that, 5 mm before.
#[test]
fn a_change_on_set_point_passes_the_first_one_at_its_velocity() {
    let mut axis = axis();
    assert!(axis.give(20_000));
    axis.set(ControlBit::ModeSpecific9, true);
    axis.frame.profile_velocity = 50_000;
    assert!(axis.give(40_000));
    axis.set(ControlBit::ModeSpecific4, false);
    let mut at_first = None;
    while !axis.has(StatusBit::TargetReached) {
        axis.step(true);
        if at_first.is_none() && axis.micrometres() >= 20_000.0 {
            at_first = Some(axis.velocity);
        }
        if axis.micrometres() > 24_000.0 {
            // 0.1 m/s to 0.05 m/s by 1 m/s²: 3.75 mm.
            assert!(axis.velocity <= 0.05 + 1e-9, "{}", axis.velocity);
        }
    }
    assert!((at_first.unwrap() - 0.1).abs() < 3e-4, "{at_first:?}");
    assert!((axis.micrometres() - 40_000.0).abs() < 1e-9);
}

#[test]
fn after_a_halt_the_move_goes_on_and_bit_10_tells_that_the_axis_stands() {
    let mut axis = axis();
    assert!(axis.give(30_000));
    axis.steps(600);
    axis.set(ControlBit::Halt, true);
    axis.step(true);
    assert!(!axis.has(StatusBit::TargetReached));
    let steps = axis.settle();
    // 0.1 m/s by 1 m/s² down to the 1 mm/s that count as standstill, and 10 ms of that, at 4 kHz.
    assert!((434..=438).contains(&steps), "{steps}");
    let held = axis.micrometres();
    axis.steps(100);
    assert!((axis.micrometres() - held).abs() < 1e-12 && held < 29_000.0, "{held}");
    axis.set(ControlBit::Halt, false);
    axis.step(true);
    assert!(!axis.has(StatusBit::TargetReached));
    axis.settle();
    assert!((axis.micrometres() - 30_000.0).abs() < 1e-9);
}

#[test]
fn the_target_is_reached_when_the_axis_has_been_within_the_window_for_its_time() {
    let mut params = Params { position: Window { width: 2e-6, time: 0.02 }, ..Params::default() };
    params.cycle.steps = 1;
    let mut axis = Axis::enabled(&params, Mode::ProfilePosition);
    axis.frame.profile_velocity = 100_000;
    assert!(axis.give(10_000));
    // 0.2 s of motion at 1 m/s², 20 ms in the window: 880 steps of 0.25 ms.
    let steps = axis.settle();
    assert!((878..=881).contains(&steps), "{steps}");
}
