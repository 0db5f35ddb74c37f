//! Tests of the firmware.
use super::*;
use crate::blocks::{derivative, filter, position};
use crate::params::tests::{emps, every, synchronous};
use crate::velocity::Cut;

const REST: Demand = Demand::position(Setpoint::at_rest(0.0));

fn at_rest(p: &Params) -> State {
    State::new(p, Setpoint::default()).unwrap()
}

/// Oracle: the published control law, u = kv·(kp·e − v) in volts, held between its 1 kHz cycles.
#[test]
fn a_p_p_cascade_is_the_published_control_law() {
    let (p, mut x) = (emps(), at_rest(&emps()));
    let at = |x: f64| Sensors { motor_position: x, motor_velocity: Some(0.02), ..Sensors::default() };
    let setpoint = Setpoint { x: 8e-4, v: 0.1, ..Setpoint::default() };
    let law = |x: f64| 243.45 * (160.18 * (8e-4 - x) - 0.02);
    for k in 0..32 {
        let position = |k: i32| 5e-4 + 1e-6 * f64::from(k);
        let PowerCommand::Output(u) =
            step(&p, &mut x, &Demand::position(setpoint), EffortLimits::NONE, &at(position(k)))
        else {
            panic!("an ideal amplifier")
        };
        assert!((u - law(position(k / 16 * 16))).abs() < 1e-11, "tick {k}: {u}");
    }
}

#[test]
fn velocity_from_an_encoder_without_one_is_a_difference() {
    let (p, mut x) = (emps(), at_rest(&emps()));
    let mut last = 0.0;
    for k in 0..=32 {
        let position = 0.02 * f64::from(k) / 16_000.0;
        let sensors = Sensors { motor_position: position, ..Sensors::default() };
        if let PowerCommand::Output(u) = step(&p, &mut x, &REST, EffortLimits::NONE, &sensors) {
            last = u;
        }
    }
    assert!((last - 243.45 * (160.18 * -0.02 * 32.0 / 16_000.0 - 0.02)).abs() < 1e-9, "{last}");
}

#[test]
fn references_go_on_between_two_turns_of_the_position_loop() {
    let (p, mut x) = (emps(), at_rest(&emps()));
    for k in 0..40 {
        let setpoint = Setpoint { x: 0.1 * f64::from(k) / 16_000.0, v: 0.1, ..Setpoint::default() };
        step(&p, &mut x, &Demand::position(setpoint), EffortLimits::NONE, &Sensors::default());
        assert!((x.references(&p).0.x - setpoint.x).abs() < 1e-18, "tick {k}");
    }
}

/// Oracle: the set-point itself, under a position loop of 1 kHz and a velocity loop of 8 kHz: the velocity at constant jerk is a parabola.
/// Its age is that of the measurement: half a period of the velocity loop for a difference, plus the time of the filter. Without
/// interpolation it is the staircase of the position loop.
#[test]
fn the_velocity_that_is_fed_forward_goes_on_between_cycles_of_the_position_loop() {
    let start = Setpoint { x: 0.0, v: 0.1, a: 3.0, j: -400.0, s: 0.0 };
    let share = 0.75;
    for (interpolate, motor_velocity, filter) in
        [(true, None, 0.0), (true, Some(0.0), 0.0), (true, Some(0.0), 2e-4), (true, None, 3e-4), (false, None, 3e-4)]
    {
        let feedforward = crate::feedforward::Params { velocity: share, interpolate, ..emps().feedforward };
        let velocity_every = every(8_000);
        let p = Params { position_gain: 0.0, velocity_every, velocity_filter_time: filter, feedforward, ..emps() };
        let velocity = velocity::Params { max_effort: f64::INFINITY, ..p.velocity };
        let p = Params { velocity, ..p };
        let age = if interpolate { filter + if motor_velocity.is_none() { 1.0 / 16_000.0 } else { 0.0 } } else { 0.0 };
        let mut x = at_rest(&p);
        for k in 0..64_u32 {
            let setpoint = |k: u32| start.after(f64::from(k) / 16_000.0);
            step(
                &p,
                &mut x,
                &Demand::position(setpoint(k)),
                EffortLimits::NONE,
                &Sensors { motor_velocity, ..Sensors::default() },
            );
            let cycle = if interpolate { k / 2 * 2 } else { k / 16 * 16 };
            let at = |age: f64| share * start.after(f64::from(cycle) / 16_000.0 - age).v;
            let held = x.held();
            let followed = (held.effort.effort - held.feedforward) / p.velocity.k_p * p.transmission;
            // The effort is some thousand times as large.
            assert!((followed - at(age)).abs() < 1e-12, "{interpolate} tick {k}: {held:?}");
            let expected = at(0.0);
            assert!((x.held().velocity_reference - expected).abs() < 1e-15, "{interpolate} tick {k}: {:?}", x.held());
        }
    }
}

/// Oracle: by hand. On the motor the loop compares r·(motor position) with the motor's reference, on the load the load's own position with
/// the load's reference.
#[test]
fn the_encoder_that_closes_the_loop_is_the_one_that_is_compared() {
    let p = Params { transmission: 0.5, ..emps() };
    let setpoint = Setpoint::at_rest(3e-3);
    for (feedback, error) in [(Feedback::Motor, 3e-3 - 0.5 * 2e-3), (Feedback::Load(2.5e-3), 3e-3 - 2.5e-3)] {
        let mut x = at_rest(&p);
        step(
            &p,
            &mut x,
            &Demand::position(setpoint),
            EffortLimits::NONE,
            &Sensors { motor_position: 2e-3, feedback, ..Sensors::default() },
        );
        assert!((x.held().velocity_reference - 160.18 * error).abs() < 1e-15, "{feedback:?}: {:?}", x.held());
    }
}

/// Oracle: by hand: 9 A, and 1.5·p·ψ·9 A of the motor as estimated by the firmware.
#[test]
fn a_demand_beyond_the_current_limit_is_cut_and_said() {
    let p = synchronous();
    let held_at = |velocity: f64| {
        let mut x = at_rest(&p);
        let sensors = Sensors { motor_velocity: Some(velocity), ..Sensors::default() };
        step(&p, &mut x, &REST, EffortLimits::NONE, &sensors);
        *x.held()
    };
    for sign in [1.0, -1.0] {
        let held = held_at(-100.0 * sign);
        assert!((held.current_reference - 9.0 * sign).abs() < 1e-14, "{held:?}");
        assert!(held.current_reference.abs() <= 9.0, "not by one rounding more");
        assert!((held.effort.effort - sign * 1.5 * 3.0 * 0.545 * 9.0).abs() < 1e-14, "{held:?}");
        assert_eq!(held.effort.cut, Some(Cut::Available));
    }
    assert_eq!(held_at(-1.0).effort, velocity::Output { effort: 3.0, cut: None });
}

/// Oracle: by hand. Without a position loop the velocity demand passes to the velocity loop unchanged; an effort bypasses both, within the
/// limit; without power there is no output. The reference is the position of the axis.
#[test]
fn a_demand_closes_the_loops_that_it_names() {
    let p = Params { transmission: 0.5, ..emps() };
    let sensors = Sensors { motor_position: 2e-3, motor_velocity: Some(0.02), ..Sensors::default() };
    let answer = |demand: Demand| {
        let mut x = at_rest(&p);
        let command = step(&p, &mut x, &demand, EffortLimits::NONE, &sensors);
        assert!((x.references(&p).0.x - 1e-3).abs() < 1e-18, "{demand:?}: {:?}", x.held);
        (command, x.held.velocity_reference, x.held.effort)
    };
    let velocity = Demand::Velocity { setpoint: Setpoint { v: 0.03, ..Setpoint::default() }, effort_offset: 7.0 };
    let (_, reference, effort) = answer(velocity);
    assert!((reference - 0.03).abs() < 1e-18);
    assert!((effort.effort - (35.1507 * 243.45 * (0.03 / 0.5 - 0.02) + 7.0)).abs() < 1e-10, "{effort:?}");
    assert_eq!(answer(Demand::Effort(-12.0)).2, velocity::Output { effort: -12.0, cut: None });
    assert_eq!(answer(Demand::Effort(1e3)).2, velocity::Output { effort: 351.507, cut: Some(Cut::Effort) });
    assert_eq!(answer(Demand::Off).0, PowerCommand::Off);
}

/// Oracle: a drive that was never off. The former states of the loops are gone, and so is the old reference.
#[test]
fn a_drive_that_was_off_begins_anew() {
    let p = synchronous();
    let demand = Demand::position(Setpoint::at_rest(1e-3));
    let sensors = |position| Sensors { motor_position: position, motor_velocity: Some(0.0), ..Sensors::default() };
    let (mut x, mut fresh) = (at_rest(&p), at_rest(&p));
    for (demand, position) in [(&demand, 0.0), (&Demand::Off, 9e-4)] {
        for _ in 0..40 {
            step(&p, &mut x, demand, EffortLimits::NONE, &sensors(position));
        }
    }
    assert_eq!((x.velocity, x.held.effort), (velocity::State::default(), velocity::Output::default()));
    step(&p, &mut x, &demand, EffortLimits::NONE, &sensors(9e-4));
    step(&p, &mut fresh, &demand, EffortLimits::NONE, &sensors(9e-4));
    assert_eq!(x.held.effort, fresh.held.effort);
}

/// Oracle: by hand: a sine of effort through a notch, as the filter alone gives it, then the limit, in a mode without velocity loop.
#[test]
fn an_effort_goes_through_the_filters_before_its_limit() {
    let rate = servobench_base::Rate::new(1_000).unwrap();
    let notch = filter::Filter::Notch { frequency: 43.0, zero_damping: 0.02, pole_damping: 0.9 };
    let filters = filter::Params::new(&[notch], rate).unwrap();
    let p = Params { blocks: crate::Blocks { filters, ..crate::Blocks::default() }, ..emps() };
    let (mut x, mut alone) = (at_rest(&p), filter::State::default());
    for k in 0..200_u32 {
        let effort = 400.0 * (0.27 * f64::from(k)).sin();
        for _ in 0..16 {
            step(&p, &mut x, &Demand::Effort(effort), EffortLimits::NONE, &Sensors::default());
        }
        let exact = filter::step(&filters, &mut alone, effort).clamp(-351.507, 351.507);
        assert!((x.held.effort.effort - exact).abs() < 1e-12, "{k}: {} {exact}", x.held.effort.effort);
    }
}

/// Oracle: by hand. Above ω_2 both gains have their factors, and the velocity reference ends at the largest speed.
#[test]
fn gains_and_speed_limit_are_those_of_the_speed() {
    let schedule = Some(crate::schedule::Params { from: 0.01, to: 0.05, position: 0.3, velocity: 0.6 });
    let blocks = crate::Blocks { schedule, max_speed: 0.031, ..crate::Blocks::default() };
    let p = Params { blocks, transmission: 0.5, ..emps() };
    for (velocity, factors) in [(0.005, (1.0, 1.0)), (0.02, (0.825, 0.9)), (-0.2, (0.3, 0.6))] {
        let mut x = at_rest(&p);
        let sensors = Sensors { motor_velocity: Some(velocity), ..Sensors::default() };
        // The first cycle measures the velocity, which the position loop uses in the second.
        for _ in 0..17 {
            let demand = Demand::position(Setpoint::at_rest(2e-5));
            step(&p, &mut x, &demand, EffortLimits::NONE, &sensors);
        }
        let reference = factors.0 * 160.18 * 2e-5;
        let effort = factors.1 * 35.1507 * 243.45 * (reference / 0.5 - velocity);
        assert!((x.held.velocity_reference - reference).abs() < 1e-15, "{velocity}: {:?}", x.held);
        assert!((x.held.effort.effort - effort.clamp(-351.507, 351.507)).abs() < 1e-9, "{velocity}: {:?}", x.held);
    }
    let mut x = at_rest(&p);
    step(&p, &mut x, &Demand::position(Setpoint::at_rest(-1.0)), EffortLimits::NONE, &Sensors::default());
    assert!((x.held.velocity_reference + 0.5 * 0.031).abs() < 1e-15, "{:?}", x.held);
}

/// Oracle: the closed form of I²t with 8.1 A, under a limit of 9 A; then the continuous current of the drive's model.
#[test]
fn a_thermal_load_ends_the_peak_current() {
    use crate::overload::{Params as Load, Reaction};
    let load = Load { continuous_current: 5.3, time_constant: 0.21, reaction: Reaction::Derate };
    for (reaction, currents) in [(Reaction::Derate, [9.0, 5.3]), (Reaction::Fault, [9.0, 9.0])] {
        let blocks = crate::Blocks { motor_load: Some(Load { reaction, ..load }), ..crate::Blocks::default() };
        let p = Params { blocks, ..synchronous() };
        let mut x = at_rest(&p);
        let measured = servobench_base::AlphaBeta { alpha: 0.0, beta: 8.1 };
        let sensors = Sensors { motor_velocity: Some(-100.0), current: measured, ..Sensors::default() };
        let time = load.time(8.1);
        let mut reached = None;
        for k in 0..16_000_u32 {
            step(&p, &mut x, &REST, EffortLimits::NONE, &sensors);
            let is_over = x.loads()[0] >= 1.0;
            let current = currents[usize::from(is_over)];
            assert!((x.held.current_reference - current).abs() < 1e-12, "{k}: {:?}", x.held);
            assert_eq!(x.is_overloaded(&p), is_over && reaction == Reaction::Fault);
            if is_over && reached.is_none() {
                reached = Some(f64::from(k) / 16e3);
            }
        }
        // Within a cycle of the velocity loop, which uses the last measured current of the current loop.
        assert!((reached.unwrap() - time).abs() < 2.0 / 8e3, "{reached:?} {time}");
    }
}

/// Oracle: the drive's own envelope. Where the speed reduces the effort below the current limit, the velocity loop uses that bound: its
/// integrator rests there.
#[test]
fn the_velocity_loop_knows_what_the_speed_leaves() {
    use crate::current::operating_point::{Params as Operation, Strategy, Weakening};
    let Stage::Current { params, every } = synchronous().stage else { panic!() };
    let weakening = Some(Weakening { share: 0.95, feedback: 0.0 });
    let params = current::Params { operation: Operation { strategy: Strategy::Mtpa, weakening }, ..params };
    let p = Params { stage: Stage::Current { params, every }, ..synchronous() };
    for velocity in [300.0, -300.0] {
        let mut x = at_rest(&p);
        let sensors = Sensors { motor_velocity: Some(velocity), ..Sensors::default() };
        let demand =
            Demand::Velocity { setpoint: Setpoint { v: 2.0 * velocity, ..Setpoint::default() }, effort_offset: 0.0 };
        for _ in 0..16_000 {
            step(&p, &mut x, &demand, EffortLimits::NONE, &sensors);
        }
        let envelope = Envelope::new(&params, &operating_point::State::default(), 3.0 * velocity);
        let EffortLimits { forward, backward } = envelope.limits();
        let left = if velocity > 0.0 { forward } else { -backward };
        assert!(left.abs() < 0.8 * p.max_effort(), "{left}");
        assert_eq!(x.held.effort, velocity::Output { effort: left, cut: Some(Cut::Available) });
        assert!((x.velocity.integral - left).abs() < 1e-9, "{:?}", x.velocity);
        assert_eq!(x.held.references, envelope.currents(&params, left));
    }
}

/// Oracle: U/√3 of the measured link, in each cycle; without the block that of the estimate.
#[test]
fn the_voltage_limit_may_be_that_of_the_measured_link() {
    for (measures_dc_link, dc_link, limit) in
        [(true, 137.0, 137.0 / 3.0_f64.sqrt()), (true, 0.0, 0.0), (false, 137.0, 300.0)]
    {
        let p = Params { blocks: crate::Blocks { measures_dc_link, ..crate::Blocks::default() }, ..synchronous() };
        let mut x = at_rest(&p);
        let sensors = Sensors { motor_velocity: Some(-100.0), dc_link, ..Sensors::default() };
        for k in 0..400 {
            step(&p, &mut x, &REST, EffortLimits::NONE, &sensors);
            assert!(x.held.current.computed.magnitude() <= limit * (1.0 + 1e-12), "{k}: {:?}", x.held.current);
        }
        assert!((x.held.current.computed.magnitude() - limit).abs() < 1e-9, "{limit}: {:?}", x.held.current);
        assert!(x.held.current.saturated);
    }
}

/// A finding stays until the power goes off, and does not affect the loops.
#[test]
fn a_finding_is_told_until_the_power_goes_off() {
    use crate::supervision::{Finding, Params as Supervision, Stall};
    let stall = Some(Stall { speed: 0.1, time: 17e-3 });
    let supervision = Some(Supervision { undervoltage: Some(200.0), stall, ..Supervision::default() });
    let blocks = crate::Blocks { supervision, ..crate::Blocks::default() };
    let (watched, plain) = (Params { blocks, ..synchronous() }, synchronous());
    let (mut x, mut y) = (at_rest(&watched), at_rest(&plain));
    let demand = Demand::position(Setpoint::at_rest(1e3));
    for k in 0..16_000_u32 {
        // The axis stands although the full effort is demanded; the link sags for a moment in between.
        let dc_link = if k == 12_000 { 150.0 } else { 540.0 };
        let sensors = Sensors { motor_velocity: Some(0.0), dc_link, ..Sensors::default() };
        let commands = [
            step(&watched, &mut x, &demand, EffortLimits::NONE, &sensors),
            step(&plain, &mut y, &demand, EffortLimits::NONE, &sensors),
        ];
        assert!(commands[0] == commands[1] && x.held == y.held, "{k}");
        // 136 cycles of the velocity loop, the first of which has not seen a cut yet: the one at tick 2·136.
        assert_eq!(x.finding(), (k >= 272).then_some(Finding::Stall), "{k}: what was found first");
    }
    for _ in 0..8 {
        step(&watched, &mut x, &Demand::Off, EffortLimits::NONE, &Sensors::default());
    }
    assert_eq!(x.finding(), None, "and without power nothing is looked for");
}

/// Oracle: by hand. A selected difference method ignores the encoder's velocity; an observer has its own state, driven by the effort of the
/// previous cycle.
#[test]
fn the_velocity_is_measured_by_the_method_that_is_chosen() {
    use crate::measurement::{Params as Method, observer};
    let h = 1e-3;
    let observer = observer::Params::new(900.0, h, 130.0, 0.0).unwrap();
    for measurement in [None, Some(Method::Difference), Some(Method::Observer(observer))] {
        let p = Params { blocks: crate::Blocks { measurement, ..crate::Blocks::default() }, ..emps() };
        let (mut x, mut alone, mut last, mut effort) = (at_rest(&p), observer::State::default(), None, 0.0);
        for k in 0..50_u32 {
            let position = 1e-5 * (0.3 * f64::from(k)).sin();
            let sensors = Sensors { motor_position: position, motor_velocity: Some(0.7), ..Sensors::default() };
            step(&p, &mut x, &REST, EffortLimits::NONE, &sensors);
            let travelled = position - last.replace(position).unwrap_or(position);
            let exact = match measurement {
                None => 0.7,
                Some(Method::Difference) => travelled / h,
                _ => observer::step(&observer, &mut alone, travelled, effort),
            };
            assert!((x.velocity(&p) - exact).abs() < 1e-15, "{k}: {} {exact}", x.velocity(&p));
            effort = x.held.effort.effort;
            for _ in 1..16 {
                step(&p, &mut x, &REST, EffortLimits::NONE, &sensors);
            }
        }
    }
}

/// Oracle: the blocks by themselves: K_v·(e + I + D) is the velocity reference, and the derivative of the velocity is subtracted. Without
/// power their states are cleared.
#[test]
fn integral_and_derivative_are_parts_of_their_loops() {
    let derivative = derivative::Params { time: 3e-3, filter_time: 0.7e-3 };
    let shaping = position::Params { integral_time: Some(40e-3), derivative: Some(derivative) };
    let blocks = crate::Blocks { position: Some(shaping), acceleration: Some(derivative), ..crate::Blocks::default() };
    let (with, without) = (Params { blocks, ..emps() }, emps());
    let (mut x, mut of_position, mut of_velocity) =
        (at_rest(&with), position::State::default(), derivative::State::default());
    for k in 0..60_u32 {
        let (position, velocity) = (3e-6 * (0.2 * f64::from(k)).cos(), 1e-5 * (0.31 * f64::from(k)).sin());
        let sensors = Sensors { motor_position: position, motor_velocity: Some(velocity), ..Sensors::default() };
        for _ in 0..16 {
            step(&with, &mut x, &REST, EffortLimits::NONE, &sensors);
        }
        let asked = 160.18 * position::step(&shaping, &mut of_position, -position, 0.0, 1e-3);
        let less = derivative::step(&derivative, &mut of_velocity, velocity, 1e-3);
        let effort = without.velocity.k_p * (asked - velocity - less);
        assert!((x.held.velocity_reference - asked).abs() < 1e-15, "{k}");
        assert!((x.held.effort.effort - effort).abs() < 1e-12 * without.velocity.k_p, "{k}");
    }
    step(&with, &mut x, &Demand::Off, EffortLimits::NONE, &Sensors::default());
    for _ in 0..16 {
        step(&with, &mut x, &REST, EffortLimits::NONE, &Sensors::default());
    }
    assert_eq!((x.blocks.position.integral.to_bits(), x.blocks.acceleration.rate.to_bits()), (0, 0), "{x:?}");
}

/// Oracle: by hand. At the speed limit and at the effort limit the integral does not grow in the direction of the limit.
#[test]
fn the_integral_of_the_position_waits_at_limits() {
    let shaping = Some(position::Params { integral_time: Some(40e-3), derivative: None });
    for (max_speed, far) in [(0.01, 1e-3), (f64::INFINITY, 0.9)] {
        let blocks = crate::Blocks { position: shaping, max_speed, ..crate::Blocks::default() };
        let p = Params { blocks, ..emps() };
        for sign in [1.0, -1.0] {
            let mut x = at_rest(&p);
            let demand = Demand::position(Setpoint::at_rest(sign * far));
            for _ in 0..16 {
                step(&p, &mut x, &demand, EffortLimits::NONE, &Sensors::default());
            }
            let first = x.blocks.position.integral;
            assert!((first - sign * far * 1e-3 / 40e-3).abs() < 1e-15, "the limit is met in the first cycle: {first}");
            for _ in 0..1600 {
                step(&p, &mut x, &demand, EffortLimits::NONE, &Sensors::default());
            }
            assert_eq!(x.blocks.position.integral.to_bits(), first.to_bits());
            assert_eq!(x.held.speed_is_cut, max_speed.is_finite(), "between two cycles of the position loop too");
            let beyond = Sensors { motor_position: sign * 1.001 * far, ..Sensors::default() };
            for _ in 0..1600 {
                step(&p, &mut x, &demand, EffortLimits::NONE, &beyond);
            }
            assert!(sign * x.blocks.position.integral < sign * first, "against it it does");
        }
    }
}
