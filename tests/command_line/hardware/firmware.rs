//! The blocks of the firmware that answer real hardware: each scenario passes as it is, and fails without its block or with another
//! value.

/// `scenarios/hardware/NAME.toml` passes, and fails with each of these keys.
fn passes_but_not_with(name: &str, others: &[&str]) {
    let others: Vec<&[&str]> = others.iter().map(std::slice::from_ref).collect();
    super::passes_but_not_with(name, &others);
}

#[test]
fn a_notch_takes_the_resonance_out_of_the_loop() {
    passes_but_not_with("notch-filter", &["drive.filter=[]", "drive.filter[0].frequency='1280 Hz'"]);
}

/// Half of the voltage is as little as none.
#[test]
fn field_weakening_takes_the_motor_beyond_its_back_emf() {
    let others = ["drive.current.field_weakening=false", "drive.current.field_weakening_share=0.475"];
    passes_but_not_with("field-weakening", &others);
}

#[test]
fn maximum_torque_per_ampere_saves_copper_loss() {
    passes_but_not_with("mtpa", &["drive.current.strategy=d-reference"]);
}

#[test]
fn i2t_keeps_to_the_continuous_current() {
    let others = ["drive.i2t={}", "drive.i2t.motor.continuous_current='6.4 Arms'", "drive.i2t.motor.peak_time='0.8 s'"];
    passes_but_not_with("i2t", &others);
}

#[test]
fn a_weight_on_the_reference_takes_the_peak_torque() {
    passes_but_not_with(
        "reference-weight",
        &["drive.velocity.reference_weight=1", "drive.velocity.reference_weight=0"],
    );
}

/// Where the load is never reached, or derates, the fault that the scenario expects does not come.
#[test]
fn i2t_is_told_as_a_fault() {
    let others = ["drive.i2t={}", "drive.i2t.motor.reaction=derate", "drive.i2t.motor.continuous_current='6.4 Arms'"];
    passes_but_not_with("i2t-fault", &others);
}

/// Differences kick at low speed; with a slower or a faster timer the noise at speed is another.
#[test]
fn the_m_t_method_takes_the_noise_of_low_speeds() {
    let others =
        ["drive.velocity.measurement=difference", "drive.velocity.timer='2 us'", "drive.velocity.timer='0.5 us'"];
    passes_but_not_with("velocity-mt", &others);
}

#[test]
fn an_observer_takes_the_noise_of_an_encoder() {
    let bandwidth = |hertz| format!("drive.velocity.observer.bandwidth='{hertz} Hz'");
    let others = ["drive.velocity.measurement=difference", &bandwidth(400), &bandwidth(100)];
    passes_but_not_with("velocity-observer", &others);
}

#[test]
fn an_observer_takes_off_a_load() {
    let share = |share| format!("drive.velocity.observer.disturbance_compensation={share}");
    passes_but_not_with("disturbance-compensation", &[&share(0), &share(1), "drive.velocity.measurement=difference"]);
}

/// A thousand seconds are as little as no integral.
#[test]
fn an_integral_in_the_position_loop_holds_a_weight() {
    let time = |time| format!("drive.position.integral_time='{time}'");
    passes_but_not_with("position-integral", &[&time("1000 s"), &time("25 ms"), &time("100 ms")]);
}

#[test]
fn a_derivative_in_the_position_loop_damps_it() {
    let time = |time| format!("drive.position.derivative_time='{time}'");
    passes_but_not_with("position-derivative", &[&time("1 us"), &time("1 ms"), &time("4 ms")]);
}

#[test]
fn a_measured_acceleration_is_an_inertia() {
    let time = |time| format!("drive.velocity.derivative_time='{time}'");
    passes_but_not_with("acceleration-feedback", &[&time("1 us"), &time("1.3265 ms"), &time("5.306 ms")]);
}

#[test]
fn what_a_dead_time_takes_is_given_back() {
    let time = |time| format!("drive.current.dead_time_compensation.dead_time='{time}'");
    passes_but_not_with("dead-time-compensation", &[&time("1 ns"), &time("4 us")]);
}

/// Each harmonic counts by its order, amplitude and phase, which motor and drive mean alike.
#[test]
fn what_a_motor_cogs_is_taken_off() {
    let others = [
        "drive.cogging=[]",
        "drive.cogging[0].amplitude='50 mNm'",
        "drive.cogging[1].amplitude='10 mNm'",
        "drive.cogging[1].phase='-40 deg'",
        "drive.cogging[0].order=35",
    ];
    passes_but_not_with("cogging-compensation", &others);
}

#[test]
fn a_speed_limit_below_the_set_point_holds_the_motor_back() {
    let speed = |rpm| format!("drive.velocity.max_speed='{rpm} rpm'");
    passes_but_not_with("max-speed", &[&speed(1080), &speed(500)]);
}

#[test]
fn less_gain_at_speed_is_less_noise() {
    let factor = |factor: f64| format!("drive.gain_schedule.velocity={factor}");
    passes_but_not_with("gain-schedule", &[&factor(1.0), &factor(0.25)]);
}
