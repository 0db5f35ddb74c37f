//! Drive units at the bus interface: factor group, polarity, counters that wrap.
use crate::axis::{Axis, setpoint};
use servobench_cia402::Mode;
use servobench_cia402::counter::Counter;
use servobench_cia402::units::{AxisUnit, FactorGroup, POLARITY_POSITION, POLARITY_TORQUE, POLARITY_VELOCITY, Ratio};
use servobench_drive::Demand;
use servobench_drive::device::{Params, Units};

fn micrometre() -> AxisUnit {
    AxisUnit::Metre(Ratio::new(1, 1_000_000).unwrap())
}

/// 1000 increments per revolution of a screw of 10 mm: 10 µm per increment, velocities in mm/min.
fn screw(polarity: u8) -> Params {
    let factors = FactorGroup {
        position_encoder_resolution: [1000, 1],
        feed_constant: [10_000, 1],
        velocity_factor: [60, 1000],
        polarity,
        ..FactorGroup::default()
    };
    Params { units: Units::new(&factors, micrometre(), 2.0).unwrap(), ..Params::default() }
}

/// Oracle: by hand.
#[test]
fn targets_and_measurements_go_through_the_factor_group() {
    let mut axis = Axis::enabled(&screw(0), Mode::CyclicSynchronousPosition);
    (axis.frame.target_position, axis.frame.velocity_offset) = (2_000, 6_000);
    axis.frame.torque_offset = 250;
    axis.cycle();
    axis.cycle();
    let Demand::Position { setpoint, velocity_offset, effort_offset } = axis.last else { panic!("{:?}", axis.last) };
    assert!((setpoint.x - 2e-3).abs() < 1e-15 && (velocity_offset - 0.1).abs() < 1e-15, "{:?}", axis.last);
    assert!((effort_offset - 0.5).abs() < 1e-15, "{:?}", axis.last);
    axis.measured.following_error = 55e-6;
    (axis.velocity, axis.measured.effort) = (0.2, -1.0);
    axis.step(false);
    let actuals = axis.actuals();
    assert_eq!((actuals.position, actuals.velocity, actuals.torque), (2_000, 12_000, -500));
    assert_eq!(actuals.following_error, 55);
}

/// The master sees the axis reversed, the loops see the encoder.
#[test]
fn polarity_turns_set_points_and_measurements_round() {
    for (polarity, position, velocity) in [
        (POLARITY_POSITION, -1.0, 1.0),
        (POLARITY_VELOCITY, 1.0, -1.0),
        (POLARITY_POSITION | POLARITY_VELOCITY, -1.0, -1.0),
    ] {
        let mut axis = Axis::enabled(&screw(polarity), Mode::CyclicSynchronousPosition);
        axis.frame.target_position = 500;
        axis.cycle();
        axis.step(true);
        assert!((setpoint(&axis.last).x - position * 5e-4).abs() < 1e-15, "{polarity:#x}: {:?}", axis.last);
        assert_eq!(axis.actuals().position, 500);
        let mut axis = Axis::enabled(&screw(polarity), Mode::CyclicSynchronousVelocity);
        axis.frame.target_velocity = 3_000;
        axis.cycle();
        axis.step(true);
        assert!((setpoint(&axis.last).v - velocity * 0.05).abs() < 1e-15, "{polarity:#x}: {:?}", axis.last);
        assert_eq!(axis.actuals().velocity, 3_000);
    }
}

/// Bit 5 alone reverses the torques that the master sends and reads.
#[test]
fn torque_has_a_polarity_of_its_own() {
    for (polarity, sign) in [(0, 1), (POLARITY_POSITION | POLARITY_VELOCITY, 1), (POLARITY_TORQUE, -1), (0xE0, -1)] {
        let mut axis = Axis::enabled(&screw(polarity), Mode::CyclicSynchronousTorque);
        (axis.frame.target_torque, axis.frame.torque_offset) = (200, 50);
        axis.cycle();
        axis.measured.effort = 1.0;
        axis.step(true);
        // 250 ‰ of 2 N, and 1 N of these.
        assert_eq!(axis.last, Demand::Effort(f64::from(sign) * 0.5), "{polarity:#x}");
        assert_eq!(axis.actuals().torque, sign * 500, "{polarity:#x}");
    }
}

#[test]
fn a_rotary_axis_is_in_radians() {
    // 3600 increments and 360 000 units (thousandths of a degree) per revolution.
    let factors =
        FactorGroup { position_encoder_resolution: [3600, 1], feed_constant: [360_000, 1], ..FactorGroup::default() };
    let unit = AxisUnit::Revolution(Ratio::new(1, 360_000).unwrap());
    let params = Params { units: Units::new(&factors, unit, 1.0).unwrap(), ..Params::default() };
    let mut axis = Axis::enabled(&params, Mode::CyclicSynchronousPosition);
    axis.frame.target_position = 90_000;
    axis.cycle();
    axis.step(true);
    assert!((setpoint(&axis.last).x - core::f64::consts::FRAC_PI_2).abs() < 1e-15, "{:?}", axis.last);
}

/// Ten times through the 32-bit counter: targets wrap as the counter does, the axis never jumps and ends where it should.
#[test]
fn cyclic_targets_run_through_the_end_of_the_counter() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    // 1 km a millisecond: 10·2³² µm are 42 950 km.
    let step = 1_000_000_000_i64;
    let mut target = 0_i64;
    for n in 1..=43 {
        target += step;
        #[expect(clippy::cast_possible_truncation, reason = "the counter of the bus wraps")]
        let shown = target as i32;
        axis.frame.target_position = shown;
        for outputs in axis.cycle() {
            let v = setpoint(&outputs.demand).v;
            assert!((v - 1e6).abs() < 1e-6, "cycle {n}: {v}");
        }
    }
    axis.cycle();
    // Doubles at 43 000 km resolve 7e-9 m.
    assert!((axis.position - target as f64 * 1e-6).abs() < 1e-6, "{}", axis.position);
    assert_eq!(axis.actuals().position, axis.frame.target_position);
}

/// Counters of every width, and without a sign: oracle is the motion, cycle by cycle.
#[test]
fn cyclic_targets_run_through_the_end_of_narrow_counters() {
    for (bits, signed) in [(16, true), (16, false), (8, true), (31, false), (32, false)] {
        let counter = if signed { Counter::signed(bits) } else { Counter::unsigned(bits) }.unwrap();
        let mut axis = Axis::enabled(&Params { counter, ..Params::default() }, Mode::CyclicSynchronousPosition);
        // A third of the range in a cycle, forwards and back: ten turns each.
        let step = i64::try_from(counter.range() / 3).unwrap();
        let mut target = 0_i64;
        for n in 0..60 {
            target += if n < 30 { step } else { -step };
            #[expect(clippy::cast_possible_truncation, reason = "32 bits of an object")]
            let shown = counter.wrap(target.into()) as i32;
            axis.frame.target_position = shown;
            axis.cycle();
        }
        axis.cycle();
        assert!((axis.position - target as f64 * 1e-6).abs() < 1e-6, "{bits} {signed}: {}", axis.position);
        assert_eq!(axis.actuals().position, axis.frame.target_position, "{bits} {signed}");
    }
}

/// Counters whose readings take two words. Those of 64 bits end with the drive's own integers.
#[test]
fn cyclic_targets_run_through_the_end_of_wide_counters() {
    for (bits, signed, cycles) in [(33, true, 30), (40, false, 30), (48, true, 30), (64, true, 1), (64, false, 1)] {
        let counter = if signed { Counter::signed(bits) } else { Counter::unsigned(bits) }.unwrap();
        let mut axis = Axis::enabled(&Params { counter, ..Params::default() }, Mode::CyclicSynchronousPosition);
        let step = counter.range() / 3;
        let mut target = 0_i128;
        for n in 0..4 * cycles {
            // Forwards, back through zero and as far to the other side, and forwards again.
            target += if (cycles..3 * cycles).contains(&n) { -step } else { step };
            [axis.frame.target_position, axis.frame.target_position_high] = counter.words(target);
            axis.cycle();
            axis.cycle();
            let what = format!("{bits} bits, signed {signed}, cycle {n}");
            let expected = target as f64 * 1e-6;
            assert!((axis.position - expected).abs() <= 1e-6 + 4.0 * f64::EPSILON * expected.abs(), "{what}");
            let actuals = axis.actuals();
            let shown = counter.reading_of([actuals.position, actuals.position_high]);
            // Beyond 2⁵³ increments the simulated encoder itself is a number of 64 bits.
            let rounding = target.abs() / (1 << 50) + 1;
            assert!((shown - counter.wrap(target)).abs() <= rounding, "{what}: {shown}");
        }
    }
    // A rotary axis has its range in objects of 32 bits.
    let rotary = servobench_drive::device::Rotary {
        direction: servobench_cia402::modulo::RotaryAxisOption::Shortest,
        ..servobench_drive::device::Rotary::default()
    };
    let params = Params { counter: Counter::signed(33).unwrap(), rotary, ..Params::default() };
    assert_eq!(params.check().map_err(|error| error.name), Err("counter"));
}
