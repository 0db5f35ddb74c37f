//! Masters that send random frames.
use crate::axis::Axis;
use servobench_base::Setpoint;
use servobench_cia402::interpolated::{Point, SegmentCommand, SubMode};
use servobench_cia402::{Command, Commands, Controlword, Mode, PowerState};
use servobench_drive::device::{Limits, Params, Window};
use servobench_drive::modes::homing::Method;
use servobench_drive::modes::profile::Ramp;
use servobench_drive::{Demand, EffortLimits};
use servobench_motion::interpolate;
use servobench_testkit::Random;

const VELOCITY: f64 = 0.5;
const ACCELERATION: f64 = 3.0;
const QUICK_STOP: f64 = 10.0;

fn params(random: &mut Random) -> Params {
    let limits = Limits {
        velocity: VELOCITY,
        profile_velocity: VELOCITY,
        acceleration: ACCELERATION,
        deceleration: ACCELERATION,
        effort: EffortLimits { forward: 2.0, backward: 1.0 },
        position: random.next().is_multiple_of(2).then_some([-0.2, 0.3]),
    };
    let mut params = Params { limits, ..Params::default() };
    params.profile.quick_stop_deceleration = QUICK_STOP;
    if random.next().is_multiple_of(2) {
        params.profile.ramp = Ramp::JerkLimited(100.0);
    }
    params.profile.end_velocity = [0.0, 0.05][usize::from(random.next().is_multiple_of(3))];
    params.profile.effort_slope = 100.0;
    params.interpolation = [interpolate::Mode::Linear, interpolate::Mode::Cubic, interpolate::Mode::CubicBSpline]
        [(random.next() % 3) as usize];
    params.sub_mode = SubMode::Cubic;
    params.homing.method = Method::all().nth((random.next() % 32) as usize).unwrap_or(params.homing.method);
    params.following_error = Window { width: 0.05, time: 1e-3 };
    params
}

/// Commands in a sensible order now and then, and any bits in between.
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "any bits will do")]
fn scramble(random: &mut Random, frame: &mut Commands) {
    match random.next() % 8 {
        0 => frame.controlword = Controlword::from_bits(random.next() as u16),
        1 => frame.controlword = Controlword::of(Command::ALL[(random.next() % 7) as usize]),
        2 => frame.controlword = Controlword::from_bits(frame.controlword.bits() ^ (1 << (random.next() % 16))),
        _ => {
            let next = Command::ALL[[0, 1, 5, 5][(random.next() % 4) as usize]];
            let specific = (random.next() as u16) & 0x0270;
            frame.controlword = Controlword::from_bits(Controlword::of(next).bits() | specific);
        }
    }
    if random.next().is_multiple_of(16) {
        frame.mode = Mode::ALL[(random.next() % 8) as usize].code();
    }
    if random.next().is_multiple_of(64) {
        frame.mode = random.next() as i8;
    }
    let range = 1_i64 << (random.next() % 34);
    let mut any = || (random.next() as i64 % range.max(1)) as i32;
    frame.target_position = any();
    frame.target_velocity = any();
    (frame.position_offset, frame.velocity_offset) = (any(), any());
    (frame.target_torque, frame.torque_offset) = (any() as i16, any() as i16);
    frame.profile_velocity = any().unsigned_abs();
    (frame.profile_acceleration, frame.profile_deceleration) = (any().unsigned_abs(), any().unsigned_abs());
    frame.home_offset = any() % 1000;
}

/// A point in sequence, of 127 µm in 10 ms at most, or an order to the buffer.
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "any bits will do")]
fn segment(random: &mut Random, status: u32) -> Option<[u8; 8]> {
    let any = random.next() as u8;
    let command = match random.next() % 64 {
        0 => SegmentCommand::Clear,
        1 => SegmentCommand::Remove(any % 4),
        2 => SegmentCommand::ResetSegment,
        3..8 => SegmentCommand::ClearErrors(any),
        _ => {
            let point = Point { position: (any as i8).into(), is_relative: true, velocity: Some(0), time: 10_000 };
            SegmentCommand::Point { counter: (status & 7) as u8, point }
        }
    };
    command.encode()
}

/// With any input, an axis is driven only while its drive function is enabled, by finite numbers, within the limits of its mode.
#[test]
fn no_frame_drives_a_disabled_axis_or_any_axis_beyond_its_limits() {
    let sweep: u32 = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|value| value.parse().ok()).unwrap_or(100_000);
    let mut random = Random::seeded(402);
    let (mut enabled, mut reached) = (0, [0_u32; 11]);
    let mut axis = Axis::new(&params(&mut random));
    for k in 0..10 * sweep {
        if k % 20_000 == 0 {
            axis = Axis::new(&params(&mut random));
        }
        let with_frame = k % 4 == 0 && !random.next().is_multiple_of(50);
        if with_frame && random.next().is_multiple_of(10) {
            scramble(&mut random, &mut axis.frame);
        }
        let is_sent = with_frame && random.next().is_multiple_of(8);
        axis.frame.trajectory_point = is_sent.then(|| segment(&mut random, axis.actuals().buffer_status)).flatten();
        if random.unit() < 0.002 {
            axis.measured.positive_limit = random.next().is_multiple_of(5);
            axis.measured.negative_limit = random.next().is_multiple_of(5);
            axis.measured.home = random.next().is_multiple_of(2);
            axis.measured.index =
                random.next().is_multiple_of(2).then_some(axis.params.units.increments(axis.position));
            axis.fault = random.next().is_multiple_of(10).then_some(0x2310);
            axis.main_voltage = !random.next().is_multiple_of(20);
        }
        let (before, mode_before) = (axis.last, axis.state.mode());
        let outputs = axis.step(with_frame);
        let is_enabled = axis.state.power().is_drive_function_enabled();
        let what = || format!("step {k}: {:?} {:?} {before:?} {outputs:?}", axis.state.power(), axis.state.mode());
        assert!(is_enabled && axis.main_voltage || outputs.demand == Demand::Off, "{}", what());
        enabled += u32::from(axis.state.power() == PowerState::OperationEnabled);
        #[expect(clippy::cast_sign_loss, reason = "codes of modes are positive")]
        let code = axis.actuals().mode as usize;
        if let (Some(v), Some(v_before)) = (velocity(&outputs.demand), velocity(&before))
            && axis.state.mode() == mode_before
            && [1, 3, 6].contains(&code)
        {
            let most = QUICK_STOP * axis.params.period * (1.0 + 1e-9);
            assert!((v - v_before).abs() <= most, "{}", what());
        }
        reached[code] += u32::from(outputs.demand != Demand::Off);
        match outputs.demand {
            Demand::Off => axis.velocity = 0.0,
            Demand::Effort(effort) => {
                assert!((-1.0..=2.0).contains(&effort), "{}", what());
                axis.velocity = 0.1 * effort;
            }
            Demand::Velocity { setpoint, effort_offset } => {
                assert!(is_within(&setpoint, code) && (-1.0..=2.0).contains(&effort_offset), "{}", what());
            }
            Demand::Position { setpoint, velocity_offset, effort_offset } => {
                assert!(is_within(&setpoint, code), "{}", what());
                assert!(velocity_offset.abs() <= VELOCITY && (-1.0..=2.0).contains(&effort_offset), "{}", what());
            }
        }
    }
    println!("enabled {enabled} of {}, by mode {reached:?}", 10 * sweep);
    assert!(
        enabled > sweep && [1, 3, 4, 6, 7, 8, 9, 10].into_iter().all(|code| reached[code] > sweep / 20),
        "{reached:?}"
    );
}

/// The velocity that a demand follows.
fn velocity(demand: &Demand) -> Option<f64> {
    match demand {
        Demand::Position { setpoint, .. } | Demand::Velocity { setpoint, .. } => Some(setpoint.v),
        Demand::Effort(_) | Demand::Off => None,
    }
}

/// Velocity within the limit, and the acceleration of the modes that have one.
fn is_within(setpoint: &Setpoint, code: usize) -> bool {
    let Setpoint { x, v, a, j, s } = *setpoint;
    let is_cyclic = code >= 8;
    [x, v, a, j, s].into_iter().all(f64::is_finite)
        && v.abs() <= VELOCITY * (1.0 + 1e-9)
        && (is_cyclic || a.abs() <= QUICK_STOP * (1.0 + 1e-9))
}
