//! Rotary axes: positions within a range (607Bh), and the directions to a target (60F2h).
use crate::axis::{Axis, setpoint};
use servobench_cia402::counter::Counter;
use servobench_cia402::modulo::{PositionRange, RotaryAxisOption};
use servobench_cia402::units::{AxisUnit, FactorGroup, Ratio};
use servobench_cia402::{ControlBit, Mode};
use servobench_drive::device::{Params, Rotary, Units, Window};
use std::f64::consts::TAU;

/// Units in a turn: thousandths of a degree; 20 increments each.
const TURN: i32 = 360_000;

fn params(min: i32, direction: RotaryAxisOption, polarity: u8) -> Params {
    let factors = FactorGroup {
        position_encoder_resolution: [7_200_000, 1],
        feed_constant: [TURN.cast_unsigned(), 1],
        polarity,
        ..FactorGroup::default()
    };
    let unit = AxisUnit::Revolution(Ratio::new(1, TURN.into()).unwrap());
    let mut params = Params {
        units: Units::new(&factors, unit, 1.0).unwrap(),
        rotary: Rotary { range: Some(PositionRange::new(min, min + TURN - 1).unwrap()), direction },
        position: Window { width: 1e-6, time: 0.0 },
        ..Params::default()
    };
    params.cycle.steps = 1;
    params
}

impl Axis {
    /// Angle turned in the direction of the encoder (thousandths of a degree).
    fn turned(&self) -> f64 {
        self.position / TAU * f64::from(TURN)
    }
}

fn positioning(params: &Params, from: f64) -> Axis {
    let mut axis = Axis::new(params);
    axis.position = from / f64::from(TURN) * TAU;
    axis.enable(Mode::ProfilePosition);
    axis.frame.profile_velocity = 3_600_000;
    (axis.frame.profile_acceleration, axis.frame.profile_deceleration) = (u32::MAX, u32::MAX);
    axis
}

/// Distances by hand, in degrees: from, to, and the distance linearly, in negative and positive direction, and the shortest one.
const WAYS: [(i32, i32, [i32; 4]); 8] = [
    (350, 10, [-340, -340, 20, 20]),
    (10, 350, [340, -20, 340, -20]),
    (0, 90, [90, -270, 90, 90]),
    (90, 0, [-90, -90, 270, -90]),
    (0, 180, [180, -180, 180, 180]),
    (180, 0, [-180, -180, 180, 180]),
    (100, 100, [0, 0, 0, 0]),
    // Beyond the range: two turns and 10° away on a linear axis, at 10° otherwise.
    (0, 730, [730, -350, 10, 10]),
];

#[test]
fn a_target_is_reached_on_the_way_of_the_option_code() {
    use RotaryAxisOption::{Linear, Negative, Positive, Shortest};
    for (from, to, ways) in WAYS {
        for (option, way) in [Linear, Negative, Positive, Shortest].into_iter().zip(ways) {
            for (polarity, sign) in [(0, 1), (0xE0, -1)] {
                // Three turns on: the axis counts them, the bus does not show them.
                let start = sign * (3 * TURN + 1000 * from);
                let mut axis = positioning(&params(0, option, polarity), start.into());
                assert_eq!(axis.actuals().position, 1000 * from);
                assert!(axis.give(1000 * to));
                axis.settle();
                let what = format!("{from} to {to}, {option:?}, {polarity:#x}");
                let expected = f64::from(start + sign * 1000 * way);
                // Doubles at a few turns resolve 1e-10 of a unit.
                assert!((axis.turned() - expected).abs() < 1e-6, "{what}: {} {expected}", axis.turned());
                assert_eq!(axis.actuals().position, 1000 * to % TURN, "{what}");
            }
        }
    }
}

/// A third of a turn a thousand times: 333 turns and a third, on the unit.
#[test]
fn many_turns_in_one_direction_do_not_drift() {
    let mut axis = positioning(&params(-180_000, RotaryAxisOption::Positive, 0), 0.0);
    for n in 1..=1000 {
        let target = [0, 120_000, -120_000][n % 3];
        assert!(axis.give(target));
        axis.settle();
        assert_eq!(axis.actuals().position, target, "{n}");
    }
    assert!((axis.turned() - 120_000_000.0).abs() < 1e-6, "{}", axis.turned());
}

/// 10° is commanded on the way to 350°, while the axis is still before 10°: it lies 20° beyond 350° for a set-point that waits, and just
/// ahead for one that takes effect at once.
#[test]
fn a_set_point_that_waits_counts_from_the_one_before_it() {
    for (at_once, expected) in [(false, 370_000.0), (true, 10_000.0)] {
        let mut axis = positioning(&params(0, RotaryAxisOption::Positive, 0), 5_000.0);
        assert!(axis.give(350_000));
        assert!(axis.turned() < 8_000.0, "{}", axis.turned());
        axis.set(ControlBit::ModeSpecific5, at_once);
        assert!(axis.give(10_000));
        axis.settle();
        assert!((axis.turned() - expected).abs() < 1e-6, "{at_once}: {}", axis.turned());
    }
}

#[test]
fn a_relative_set_point_may_be_longer_than_a_turn() {
    let mut axis = positioning(&params(0, RotaryAxisOption::Shortest, 0), 0.0);
    axis.set(ControlBit::ModeSpecific6, true);
    assert!(axis.give(-800_000));
    axis.settle();
    assert!((axis.turned() + 800_000.0).abs() < 1e-6, "{}", axis.turned());
    assert_eq!(axis.actuals().position, 280_000);
}

/// The shortest way without a range: through the end of the counter, of 16 bits here and 32 there.
#[test]
fn without_a_range_the_counter_is_the_turn() {
    for bits in [16, 32] {
        let range = 1_i64 << bits;
        let counter = Counter::signed(bits).unwrap();
        let rotary = Rotary { range: None, direction: RotaryAxisOption::Shortest };
        let mut axis = Axis::new(&Params { counter, rotary, ..Params::default() });
        axis.position = (range / 2 - 100) as f64 * 1e-6;
        axis.enable(Mode::ProfilePosition);
        let shown = axis.actuals().position;
        assert_eq!(i64::from(shown), range / 2 - 100);
        assert!(axis.give(-shown));
        axis.settle();
        // Doubles at 2 km resolve 5e-13 m.
        assert!((axis.position - (range / 2 + 100) as f64 * 1e-6).abs() < 1e-11, "{bits}: {}", axis.position);
    }
}

/// Ten turns in csp, 7° a cycle, by targets within the range; readings are in the range. Oracle: counted.
#[test]
fn cyclic_targets_go_on_at_the_other_end_of_the_range() {
    for step in [7_000, -7_000] {
        let mut axis = Axis::enabled(&params(0, RotaryAxisOption::Linear, 0), Mode::CyclicSynchronousPosition);
        let mut target = 0_i32;
        for n in 1..=515 {
            target += step;
            axis.frame.target_position = target.rem_euclid(TURN);
            let v = setpoint(&axis.step(true).demand).v;
            // 7 units/ms in steps of 250 µs.
            let expected = f64::from(step) / f64::from(TURN) * TAU / 250e-6;
            assert!((v - expected).abs() < 1e-9 * expected.abs(), "cycle {n}: {v} {expected}");
            assert!((0..TURN).contains(&axis.actuals().position));
        }
        axis.step(true);
        assert_eq!(axis.actuals().position, target.rem_euclid(TURN));
        assert!((axis.turned() - f64::from(target)).abs() < 1e-5, "{}", axis.turned());
    }
}

#[test]
fn a_range_that_the_counter_does_not_show_is_refused() {
    let counter = Counter::signed(16).unwrap();
    let refused = Params { counter, ..params(0, RotaryAxisOption::Linear, 0) }.check().unwrap_err();
    assert_eq!(
        refused.to_string(),
        "`position_range_limit` must be within what the counter of the bus shows, got 359999"
    );
}
