//! Settings that are refused.
use crate::rig::{BUS, MOTION, settings};
use servobench_fieldbus::link::{Control, Params, PositionGains, Settings, Units};
use servobench_motion::Limits;

fn message(settings: Settings) -> String {
    Params::new(settings).unwrap_err().to_string()
}

#[test]
fn every_refusal_names_field_value_bound_and_way_out() {
    let s = settings();
    assert_eq!(
        message(Settings { margin: 641, ..s }),
        "`margin` must be at most 640 ticks, two cycles of the motion task, got 641: let the samples come earlier, or the \
         cycle be longer"
    );
    assert_eq!(
        message(Settings { round_trip: 100, ..s }),
        "`drive_timeout` must be longer than the round trip of 1600 ticks, got 1600 ticks"
    );
    assert_eq!(
        message(Settings { velocity_limit: 3e3, ..s }),
        "`velocity_limit` is 3e9 in the drive's velocity unit, at most 2147483647 fits 32 bits: choose a coarser unit"
    );
    assert_eq!(
        message(Settings { units: Units { axis_units: 0.0, ..s.units }, ..s }),
        "`units.axis_units` must be finite and not zero, got 0"
    );
    let recovery = Limits { jerk: 0.0, ..s.recovery };
    assert_eq!(message(Settings { recovery, ..s }), "`jerk` must be finite and positive, got 0");
    let control = Control::Velocity {
        gains: PositionGains::proportional(1.0),
        feedforward: f64::NAN,
        limit: 1.0,
        torque_offset: false,
    };
    assert_eq!(message(Settings { control, ..s }), "`control.feedforward` must be finite, got NaN");
    let control = Control::Velocity {
        gains: PositionGains::proportional(1.0),
        feedforward: 1.0,
        limit: 1.0,
        torque_offset: false,
    };
    assert_eq!(
        message(Settings { control, round_trip: 31, answer_age: 33, ..s }),
        "`round_trip` and `answer_age` must be at most 528 ticks together, got 529: take a longer cycle"
    );
    assert!(Params::new(Settings { control, round_trip: 31, answer_age: 32, ..s }).is_ok());
    // Two cycles of 1 ms and half a one.
    let integral = |time| {
        let gains = PositionGains { integral_time: Some(time), ..PositionGains::proportional(1.0) };
        Settings { control: Control::Velocity { gains, feedforward: 1.0, limit: 1.0, torque_offset: false }, ..s }
    };
    assert_eq!(
        message(integral(0.0025)),
        "the integral time of the master's position loop must be longer than 0.0025 s, the age of the position and half a cycle, got \
         0.0025 s: with a shorter one the loop is unstable at every gain"
    );
    assert!(Params::new(integral(0.0026)).is_ok());
    assert_eq!(message(integral(f64::NAN)), "`control.gains.integral_time` must be finite and positive, got NaN");
}

#[test]
fn the_delay_is_that_of_the_interpolation_and_the_margin() {
    use servobench_motion::interpolate::Mode;
    for (interpolation, cycles) in [(Mode::Linear, 1), (Mode::CubicBSpline, 2), (Mode::QuinticBSpline, 3)] {
        let params =
            Params::new(Settings { interpolation, margin: 2 * u32::try_from(BUS).unwrap(), ..settings() }).unwrap();
        assert_eq!(params.delay(), cycles * MOTION + 2 * BUS);
    }
}
