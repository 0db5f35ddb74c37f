//! Settings that the drive refuses.
use servobench_drive::device::{Params, State, Window};
use servobench_drive::modes::profile::Ramp;
use servobench_motion::interpolate;

/// Error message of the default settings after `spoil` has changed them.
fn refusal(spoil: impl Fn(&mut Params)) -> String {
    let mut params = Params::default();
    spoil(&mut params);
    State::new(&params).unwrap_err().to_string()
}

#[test]
fn a_refusal_names_the_object_the_value_and_what_it_must_be() {
    let refused = refusal(|p| p.profile.quick_stop_deceleration = 0.0);
    assert_eq!(refused, "`quick_stop_deceleration` must be finite and positive, got 0");
    let refused = refusal(|p| p.limits.position = Some([0.2, 0.1]));
    assert_eq!(refused, "`software_position_limit.max` must be above the lowest one, got 0.1");
    let refused = refusal(|p| p.interpolation = interpolate::Mode::Quintic);
    assert_eq!(refused, "`interpolation` must be 1 (linear), 2 (cubic) or 4 (cubic B-spline), got 3");
}

#[test]
fn every_setting_is_checked() {
    type Spoil = fn(&mut Params);
    let spoils: [(&str, Spoil); 19] = [
        ("period", |p| p.period = 0.0),
        ("interpolation_time_period", |p| p.cycle.steps = 0),
        ("max_motor_speed", |p| p.limits.velocity = 0.0),
        ("max_profile_velocity", |p| p.limits.profile_velocity = -1.0),
        ("max_acceleration", |p| p.limits.acceleration = f64::NAN),
        ("max_deceleration", |p| p.limits.deceleration = 0.0),
        ("positive_torque_limit", |p| p.limits.effort.forward = 0.0),
        ("negative_torque_limit", |p| p.limits.effort.backward = f64::NAN),
        ("software_position_limit.max", |p| p.limits.position = Some([f64::NAN, 1.0])),
        ("profile_velocity", |p| p.profile.velocity = f64::INFINITY),
        ("profile_acceleration", |p| p.profile.acceleration = 0.0),
        ("profile_deceleration", |p| p.profile.deceleration = f64::NAN),
        ("end_velocity", |p| p.profile.end_velocity = -0.1),
        ("torque_slope", |p| p.profile.effort_slope = 0.0),
        ("profile_jerk", |p| p.profile.ramp = Ramp::JerkLimited(0.0)),
        ("following_error_time_out", |p| p.following_error.time = -1.0),
        ("position_window", |p| p.position = Window { width: f64::NAN, time: 0.0 }),
        ("velocity_window_time", |p| p.velocity.time = f64::INFINITY),
        ("velocity_threshold", |p| p.standstill.width = -1.0),
    ];
    for (name, spoil) in spoils {
        let refused = refusal(spoil);
        assert!(refused.starts_with(&format!("`{name}` must be ")), "{refused}");
    }
    assert!(State::new(&Params::default()).is_ok());
}
