//! Loops whose poles are known in closed form.
use crate::axes::{MOTOR, TAU, Tuning, body, chain, ideal, report, running, sensors, servo};
use servobench_drive::current;
use servobench_drive::{self as drive, derivative, filter, measurement, position, schedule, velocity};
use servobench_sim::AtRest;
use servobench_stability::{
    Depth, GainName, Loop, LoopName, LoopReport, PositionFeedback, VelocitySignal, analyse as analyse_running,
    analyse_schedule,
};

/// Boundaries are bisected to 1e-6 of the gain.
const BISECTED: f64 = 2e-6;

fn above(model: &Loop, name: LoopName) -> f64 {
    let report = report(model);
    let found = report.loops.iter().find(|found| found.name == name).unwrap();
    found.boundaries.unwrap().above.unwrap().gain
}

/// Oracle: v(k+1) = (1 − K·h/m)·v(k), so that K = 2m/h is the boundary; the pole at −1 is at half the loop's rate.
#[test]
fn a_p_velocity_loop_on_one_mass() {
    for (base, every, mass) in [(12_000, 1, 7.3), (20_000, 5, 0.31)] {
        let boundary = 2.0 * mass * f64::from(base) / f64::from(every);
        let model = ideal(base, every, 0.6 * boundary, chain(vec![body(mass, 0.0)], &[]));
        assert!((above(&model, LoopName::Velocity) / boundary - 1.0).abs() < BISECTED, "{base} Hz / {every}");

        let model = ideal(base, every, 1.1 * boundary, chain(vec![body(mass, 0.0)], &[]));
        let report = report(&model);
        let found = report.instability.unwrap();
        assert_eq!((found.name, found.gain_name), (LoopName::Velocity, GainName::Velocity));
        assert!((found.pole.magnitude - 1.2).abs() < 1e-12, "|1 − 2.2|: {found:?}");
        let rate = f64::from(base) / f64::from(every);
        assert!((found.pole.frequency / (rate / 2.0) - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.pole.growth / (1.2_f64.ln() * rate) - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.boundaries.below.unwrap().factor * 1.1 - 1.0).abs() < BISECTED, "{found:?}");
        assert_eq!(found.boundaries.above, None);
    }
}

/// Oracle: the same mass under differences of positions: m·v' = m·v − K·h·(v + v_before)/2: z² + (a/2 − 1)·z + a/2 with
/// a = K·h/m; the circle is left at a = 2, at z² = −1: a quarter of the rate.
#[test]
fn differences_of_positions_cost_half_a_period() {
    let (mass, h) = (2.6, 4.0 / 12e3);
    let model = Loop {
        velocity_signal: VelocitySignal::Differences,
        ..ideal(12_000, 4, 1.3 * mass / h, chain(vec![body(mass, 0.0)], &[]))
    };
    let boundary = above(&model, LoopName::Velocity);
    assert!((boundary / (2.0 * mass / h) - 1.0).abs() < BISECTED, "{boundary}");
    let mut fast = model.clone();
    fast.drive.velocity.k_p = 1.0001 * 2.0 * mass / h;
    let pole = report(&fast).instability.unwrap().pole;
    assert!((pole.frequency / 750.0 - 1.0).abs() < 1e-3, "{pole:?}");
}

/// Oracle: the same m cycles late: (z − 1)·z^(m+1) + a/2·(z + 1), on the circle at a = 2·tan(π/(4·(m + 1))), whatever part of the m
/// cycles are ticks of the base rate; a share of a tick more is between two of them.
#[test]
fn a_late_encoder_is_a_dead_time() {
    let mass = 2.6;
    let found = |every: u32, latency: f64| {
        let h = f64::from(every) / 12e3;
        let velocity_signal = VelocitySignal::Differences;
        let model = ideal(12_000, every, 0.02 * mass / h, chain(vec![body(mass, 0.0)], &[]));
        let model = Loop { velocity_signal, ..model };
        let late = AtRest::new(&model, &sensors(&model, latency * h), None).unwrap();
        let report = analyse_running(&model, Box::new(late), Depth::Boundaries).unwrap();
        report.loops[0].boundaries.unwrap().above.unwrap().gain * h / mass
    };
    for every in [1, 4] {
        for cycles in [0_u32, 1, 2, 7, 29] {
            let a = found(every, f64::from(cycles));
            let expected = 2.0 * (TAU / 8.0 / f64::from(cycles + 1)).tan();
            assert!((a / expected - 1.0).abs() < BISECTED, "{every} {cycles}: {a} {expected}");
        }
        let between = [2.0, 2.2, 2.5, 2.99, 3.0].map(|latency| found(every, latency));
        assert!(between.windows(2).all(|pair| pair[1] < pair[0]), "{every}: {between:?}");
    }
}

/// Oracle: v(k+1) = (1 − K·f(ω)·h/m)·v(k): speeds from f(ω) = 2·m/(K·h) on are unstable, by a pole at half the rate.
#[test]
fn a_gain_schedule_is_unstable_from_a_speed_on() {
    let (mass, h, first) = (7.3, 1.0 / 12e3, 0.4);
    let schedule = schedule::Params { from: 2.0, to: 12.0, position: 1.0, velocity: 11.0 };
    let rest = ideal(12_000, 1, first * mass / h, chain(vec![body(mass, 0.0)], &[]));
    let blocks = drive::Blocks { schedule: Some(schedule), ..drive::Blocks::default() };
    let model = Loop { drive: drive::Params { blocks, ..rest.drive }, ..rest };
    assert!(report(&model).is_stable(), "at standstill");
    // 1 + s·10 = 2/0.4 at s = 0.4.
    let boundary = 2.0 + 0.4 * 10.0;
    let stays = |time: f64| {
        analyse_schedule(&model, running(&model), |range| {
            assert!((range.start / boundary - 1.0).abs() < 0.05 && range.end.is_infinite(), "{range:?}");
            time
        })
        .unwrap()
    };
    // Two ticks are a period of the pole.
    assert_eq!(stays(1.9 * h), None);
    let found = stays(2.1 * h).unwrap();
    assert_eq!((found.name, found.speed), (LoopName::Velocity, Some((12.0, "m/s"))));
    assert!((found.gain / (11.0 * first * mass / h) - 1.0).abs() < 1e-12, "{found:?}");
    assert!((found.pole.magnitude - (1.0_f64 - 4.4).abs()).abs() < 1e-12, "{found:?}");
    assert!((found.boundaries.below.unwrap().factor * 4.4 / 2.0 - 1.0).abs() < BISECTED, "{found:?}");
    let said = found.to_string();
    assert!(
        said.starts_with("the loop is unstable at 12 m/s of the motor (gain schedule): velocity loop, gain "),
        "{said}"
    );
}

/// Oracle: a double integrator under position and velocity, sampled (Åström & Wittenmark, *Computer-Controlled Systems*,
/// 3rd ed., example 3.2): x' = x + h·v + h²/2m·u, v' = v + h/m·u, u = −K·(K_v·x + v). With a = K·h/m and b = K_v·h:
/// z² + (a + a·b/2 − 2)·z + 1 − a + a·b/2, by Jury stable for 0 < b < 2 and a < 2.
#[test]
fn a_double_integrator_under_position_and_velocity() {
    let (mass, h) = (4.1, 1.0 / 12e3);
    let cascade = |a: f64, b: f64| {
        let rest = ideal(12_000, 1, a * mass / h, chain(vec![body(mass, 0.0)], &[]));
        Loop { closes_position: true, drive: drive::Params { position_gain: b / h, ..rest.drive }, ..rest }
    };
    let stable = report(&cascade(0.7, 0.4));
    assert!(stable.is_stable());
    // z² − 1.16·z + 0.44: a pair of |λ|² = 0.44 and cos φ = 0.58/|λ|.
    let pair = stable.slowest.oscillating.unwrap();
    let (magnitude, angle) = (0.44_f64.sqrt(), (0.58 / 0.44_f64.sqrt()).acos());
    assert_eq!(stable.slowest.real, None);
    assert!((pair.growth * h / magnitude.ln() - 1.0).abs() < 1e-9, "{pair:?}");
    assert!((pair.frequency * TAU * h / angle - 1.0).abs() < 1e-9, "{pair:?}");
    let boundary =
        |name| stable.loops.iter().find(|found| found.name == name).unwrap().boundaries.unwrap().above.unwrap();
    assert!((boundary(LoopName::Velocity).factor * 0.7 / 2.0 - 1.0).abs() < BISECTED, "a = 2");
    assert!((boundary(LoopName::Position).factor * 0.4 / 2.0 - 1.0).abs() < BISECTED, "b = 2");
    let position = report(&cascade(0.7, 2.2)).instability.unwrap();
    assert_eq!(position.name, LoopName::Position);
    assert!((position.boundaries.below.unwrap().factor * 2.2 / 2.0 - 1.0).abs() < BISECTED, "{position:?}");
    assert_eq!(report(&cascade(2.3, 0.4)).instability.unwrap().name, LoopName::Velocity);

    // The poles that fade last: a pair, or two real ones.
    let pair = stable.slowest.oscillating.unwrap();
    assert_eq!(stable.slowest.real, None);
    let (half, square) = (1.0 - 0.7_f64.midpoint(0.14), 1.0 - 0.7 + 0.14_f64);
    assert!((pair.growth / (square.ln() / 2.0 / h) - 1.0).abs() < 1e-9, "{pair:?}");
    assert!((pair.frequency / ((half / square.sqrt()).acos() / TAU / h) - 1.0).abs() < 1e-9, "{pair:?}");
    let slow = report(&cascade(0.7, 0.05));
    assert_eq!(slow.slowest.oscillating, None);
    let (half, square) = (1.0 - 0.7_f64.midpoint(0.0175), 1.0 - 0.7 + 0.0175_f64);
    let slowest = half + (half * half - square).sqrt();
    assert!((slow.slowest.real.unwrap().growth / (slowest.ln() / h) - 1.0).abs() < 1e-9, "{slow:?}");
}

/// Oracle: a velocity loop with a filter of time constant T on a mass: z² + (a·f + f − 2)·z + 1 − f with f = h/(h + T),
/// a = K·h/m, the filter's output being that of the newest sample: −1 is reached at a·f = 4 − 2f.
#[test]
fn a_filter_moves_the_boundary() {
    let (mass, h, filter) = (4.1, 2.0 / 20e3, 0.7e-4);
    let f = h / (h + filter);
    let rest = ideal(20_000, 2, mass / h, chain(vec![body(mass, 0.0)], &[]));
    let model = Loop { drive: drive::Params { velocity_filter_time: filter, ..rest.drive }, ..rest };
    let boundary = above(&model, LoopName::Velocity);
    assert!((boundary * h / mass / ((4.0 - 2.0 * f) / f) - 1.0).abs() < BISECTED, "{boundary}");
}

/// Oracle: a velocity loop on a mass, a = K·h/m, behind a low-pass of second order, b_0·(z + 1)²/(z² + a_1·z + a_2) with
/// t = tan(πfh): (z − 1)(z² + a_1·z + a_2) + a·b_0·(z + 1)², by Jury stable for a < 4·(1 − a_2)/(3 − a_1 − a_2) = 4ζt/(1 + 2ζt).
#[test]
fn a_filter_of_the_torque_moves_the_boundary() {
    let (mass, h) = (4.1, 2.0 / 20e3);
    for (frequency, damping) in [(713.0, 0.61), (97.3, 0.23), (2311.0, 1.4)] {
        let t = (std::f64::consts::PI * frequency * h).tan();
        let exact = 4.0 * damping * t / (1.0 + 2.0 * damping * t);
        let rest = ideal(20_000, 2, 0.6 * exact * mass / h, chain(vec![body(mass, 0.0)], &[]));
        let filter = filter::Filter::SecondOrder { frequency, damping };
        let filters = filter::Params::new(&[filter], rest.drive.velocity_rate()).unwrap();
        let blocks = drive::Blocks { filters, ..drive::Blocks::default() };
        let model = Loop { drive: drive::Params { blocks, ..rest.drive }, ..rest };
        let boundary = above(&model, LoopName::Velocity) * h / mass;
        assert!((boundary / exact - 1.0).abs() < BISECTED, "{frequency} Hz: {boundary} {exact}");
    }
}

/// Oracle: a PI loop on a mass, a = K·h/m, the integrator by forward Euler: (z − 1)² + a·(z − 1) + a·h/T: −1 is reached at
/// a = 4/(2 − h/T), +1 turned at a·(1 − h/T) = 0.
#[test]
fn an_integrator_moves_the_boundary() {
    let (mass, h, integral_time) = (4.1, 1.0 / 20e3, 1.5e-4);
    let rest = ideal(20_000, 1, mass / h, chain(vec![body(mass, 0.0)], &[]));
    let velocity = velocity::Params { integral_time: Some(integral_time), ..rest.drive.velocity };
    let model = Loop { drive: drive::Params { velocity, ..rest.drive }, ..rest };
    let boundary = above(&model, LoopName::Velocity) * h / mass;
    assert!((boundary / (4.0 / (2.0 - h / integral_time)) - 1.0).abs() < BISECTED, "{boundary}");
}

/// Oracle: with the zero on the pole an axis of the current loop is, but for h·R/L, z² − z + α·h: |λ|² = α·h = 1, at ±60°,
/// a sixth of the rate. The d axis has the same gain times d/q of what the drive believes.
#[test]
fn the_current_loop_alone_is_stable_up_to_alpha_h_of_one() {
    let tuning = Tuning { current: 2_000.0, velocity: 0.0, integral_time: 0.05, filter_time: 0.0, position: 0.0 };
    let mut model = servo(tuning, chain(vec![body(1e3, 0.0)], &[]));
    // h·R/2L = 1.4 % of the gain is what forward Euler and the hold differ by.
    let boundary = above(&model, LoopName::Current);
    assert!((boundary * TAU / 16e3 - 1.0).abs() < 0.02, "{boundary} Hz");

    let drive::Stage::Current { params, .. } = &mut model.drive.stage else { panic!("a current loop") };
    params.gains.k_p.d *= 1.1 * boundary / 2_000.0;
    params.gains.k_i.d *= 1.1 * boundary / 2_000.0;
    model.current_tuning = Some(current::Tuning::Gains(servobench_base::Dq::default()));
    let found = report(&model).instability.unwrap();
    assert_eq!((found.name, found.gain_name), (LoopName::Current, GainName::CurrentD));
    assert!((found.boundaries.below.unwrap().factor * 1.1 - 1.0).abs() < BISECTED, "{found:?}");
    assert!((found.pole.frequency / (16e3 / 6.0) - 1.0).abs() < 0.05, "{found:?}");
}

/// Oracle: two masses and a spring in closed form. A velocity loop of little gain moves the poles by −K/2m of the motor's
/// share, to first order; the mode at 2.65 kHz is above half of the loop's rate.
#[test]
fn a_mode_above_half_the_loops_rate_keeps_its_frequency() {
    let stiffness = (TAU * 2_650.0_f64).powi(2) / 2.0;
    let model = |base: u32, every, gain| {
        ideal(base, every, gain, chain(vec![body(1.0, 0.0), body(1.0, 0.0)], &[(stiffness, 0.0)]))
    };
    for (base, every) in [(16_000, 4), (12_000, 3), (16_000, 16), (20_000, 4)] {
        for gain in [1.0, 1e-3] {
            let report = report(&model(base, every, gain));
            let found = match report.instability {
                Some(found) => found.pole,
                None => report.loops[0].least_damped.unwrap(),
            };
            assert!((found.frequency / 2_650.0 - 1.0).abs() < 1e-3, "{base}/{every}, {gain}: {found:?}");
            assert!(found.growth.abs() < 0.51 * gain, "{found:?}");
        }
    }
}

/// Oracle: mirror images: a motor behind a gear of 1:5 is one with 25 times less of gain and inertia.
#[test]
fn a_gear_scales_gain_and_inertia() {
    let h = 1.0 / 12e3;
    for (feedback, position_gain) in [(PositionFeedback::Motor, 400.0), (PositionFeedback::Load, 1.0)] {
        let straight = ideal(12_000, 1, 0.9 / h, chain(vec![body(1.0, 0.3), body(2.0, 0.1)], &[(1e5, 3.0)]));
        let straight = Loop {
            closes_position: true,
            position_feedback: feedback,
            drive: drive::Params { position_gain, ..straight.drive },
            ..straight
        };
        let mut geared = straight.clone();
        let mut motor = body(1.0 / 25.0, 0.3 / 25.0);
        motor.transmission = 0.2;
        geared.mechanics = chain(vec![motor, body(2.0, 0.1)], &[(1e5, 3.0)]).into();
        geared.drive.transmission = 0.2;
        geared.drive.velocity.k_p /= 25.0;
        let (straight, geared) = (report(&straight), report(&geared));
        for (one, other) in straight.loops.iter().zip(&geared.loops) {
            let factor = |found: &LoopReport| found.boundaries.unwrap().above.unwrap().factor;
            let (one, other) = (factor(one), factor(other));
            assert!((one / other - 1.0).abs() < BISECTED, "{feedback:?}: {one} {other}");
        }
    }
}

#[test]
fn bandwidths_are_by_what_the_axis_has() {
    let tuning = Tuning { current: 800.0, velocity: 0.5, integral_time: 0.05, filter_time: 0.0, position: 200.0 };
    let mut model = servo(tuning, chain(vec![body(1e-3, 0.0), body(3e-3, 0.0)], &[(1e4, 0.1)]));
    let drive::Stage::Current { params, .. } = &mut model.drive.stage else { panic!("a current loop") };
    params.motor.flux_linkage = MOTOR.flux_linkage / 2.0;
    let report = report(&model);
    let found: Vec<f64> = report.loops.iter().map(|found| found.bandwidth.unwrap()).collect();
    // The drive believes in half the torque per ampere and asks for twice the current.
    for (found, expected) in found.iter().zip([800.0, 2.0 * 0.5 / 4e-3 / TAU, 200.0 / TAU]) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }
    assert_eq!(report.warnings, []);
}

/// By Routh in s = (z − 1)/(z + 1): whether w³ + A·w² + B·w + C, w = z − 1, has all roots within the unit circle.
fn is_within(a: f64, b: f64, c: f64) -> bool {
    let [s3, s2, s1, s0] = [8.0 - 4.0 * a + 2.0 * b - c, 4.0 * a - 4.0 * b + 3.0 * c, 2.0 * b - 3.0 * c, c];
    [s3, s2, s1, s0].iter().all(|coefficient| *coefficient > 0.0) && s2 * s1 > s3 * s0
}

/// Factor from 1 to `end` at which `holds` changes, by bisection.
fn change(end: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut same, mut other) = (1.0, end);
    assert!(holds(same) && !holds(other));
    for _ in 0..60 {
        let middle = f64::midpoint(same, other);
        *(if holds(middle) { &mut same } else { &mut other }) = middle;
    }
    same
}

/// A double integrator under position and velocity, a = K·h/m and b = K_v·h, with these parts of the position loop.
fn held(a: f64, b: f64, parts: impl Fn(f64) -> position::Params) -> Loop {
    let (mass, h) = (4.1, 1.0 / 12e3);
    let rest = ideal(12_000, 1, a * mass / h, chain(vec![body(mass, 0.0)], &[]));
    let blocks = drive::Blocks { position: Some(parts(h)), ..drive::Blocks::default() };
    Loop { closes_position: true, drive: drive::Params { position_gain: b / h, blocks, ..rest.drive }, ..rest }
}

/// Oracle: with c = h/T_i the loop is w³ + (a + a·b/2)·w² + (a·b + a·b·c/2)·w + a·b·c, stable from
/// a = 8c/((4 − 2b + b·c)·(2 − 2c) + 4c) to 2.
#[test]
fn an_integral_of_the_position_needs_velocity_gain() {
    for (a, b, c) in [(0.7, 0.4, 0.05), (0.31, 0.13, 0.021)] {
        let of = |h| position::Params { integral_time: Some(h / c), derivative: None };
        let report = report(&held(a, b, of));
        let boundaries =
            report.loops.iter().find(|found| found.name == LoopName::Velocity).unwrap().boundaries.unwrap();
        let least = 8.0 * c / ((4.0 - 2.0 * b + b * c) * (2.0 - 2.0 * c) + 4.0 * c);
        assert!((boundaries.below.unwrap().factor * a / least - 1.0).abs() < BISECTED, "{boundaries:?} {least}");
        assert!((boundaries.above.unwrap().factor * a / 2.0 - 1.0).abs() < BISECTED, "{boundaries:?}");
        let position = report.loops.iter().find(|found| found.name == LoopName::Position).unwrap().boundaries.unwrap();
        let by_routh = change(50.0, |f| is_within(a + a * f * b / 2.0, a * f * b * (1.0 + c / 2.0), a * f * b * c));
        assert!((position.above.unwrap().factor / by_routh - 1.0).abs() < BISECTED, "{position:?} {by_routh}");
    }
}

/// Oracle: with d = T_d/h and no filter the loop is w³ + (1 + a + a·b·(1 + d)/2)·w² + (a + a·b/2 + a·b·(1 + d))·w + a·b.
#[test]
fn a_derivative_of_the_position_moves_the_boundary() {
    for (a, b, d) in [(0.7, 0.4, 1.3), (0.31, 0.13, 4.7)] {
        let of = |h| position::Params {
            integral_time: None,
            derivative: Some(derivative::Params { time: d * h, filter_time: 0.0 }),
        };
        let report = report(&held(a, b, of));
        let found = report.loops.iter().find(|found| found.name == LoopName::Position).unwrap().boundaries.unwrap();
        let by_routh = change(200.0, |f| {
            let ab = a * b * f;
            is_within(1.0 + a + ab * (1.0 + d) / 2.0, a + ab / 2.0 + ab * (1.0 + d), ab)
        });
        assert!((found.above.unwrap().factor / by_routh - 1.0).abs() < BISECTED, "{found:?} {by_routh}");
    }
}

/// Oracle: with d = T_d/h and no filter (w + a)·(1 + w) + a·d·w: −1 is reached at a = 2/(1 + 2d); with the filter, f = h/(T_f + h) in
/// its place, (w + a)·(w + f) + a·d·f·w: at a·(2 − f + 2·d·f) = 2·(2 − f).
#[test]
fn a_measured_acceleration_moves_the_boundary() {
    let (mass, h) = (4.1, 1.0 / 20e3);
    for (d, filter) in [(0.7, 0.0), (2.9, 0.0), (1.7, 1.31)] {
        let f = 1.0 / (1.0 + filter);
        let exact = 2.0 * (2.0 - f) / (2.0 - f + 2.0 * d * f);
        let rest = ideal(20_000, 1, 0.6 * exact * mass / h, chain(vec![body(mass, 0.0)], &[]));
        let acceleration = Some(derivative::Params { time: d * h, filter_time: filter * h });
        let blocks = drive::Blocks { acceleration, ..drive::Blocks::default() };
        let model = Loop { drive: drive::Params { blocks, ..rest.drive }, ..rest };
        let boundary = above(&model, LoopName::Velocity) * h / mass;
        assert!((boundary / exact - 1.0).abs() < BISECTED, "{d} {filter}: {boundary} {exact}");
    }
}

/// Oracle: separation. With the right inertia the error of the observer knows nothing of the control: the loop has the poles of an exact
/// velocity, 1 − a, and those of the observer, with and without compensation of the disturbance. With a wrong inertia it has not.
#[test]
fn an_observer_with_the_right_inertia_leaves_the_boundary() {
    let (mass, h) = (4.1, 2.0 / 20e3);
    for (share, compensation, is_moved) in [(1.0, 0.0, false), (1.0, 0.83, false), (1.9, 0.0, true), (0.6, 0.83, true)]
    {
        let rest = ideal(20_000, 2, 0.6 * mass / h, chain(vec![body(mass, 0.0)], &[]));
        let observer = measurement::observer::Params::new(911.0, h, share * mass, compensation).unwrap();
        let measurement = Some(measurement::Params::Observer(observer));
        let blocks = drive::Blocks { measurement, ..drive::Blocks::default() };
        let model = Loop {
            velocity_signal: VelocitySignal::Differences,
            drive: drive::Params { blocks, ..rest.drive },
            ..rest
        };
        let report = report(&model);
        assert!(report.is_stable());
        let boundary = report.loops[0].boundaries.unwrap().above.unwrap().gain * h / mass;
        assert_eq!((boundary / 2.0 - 1.0).abs() > BISECTED, is_moved, "{share} {compensation}: {boundary}");
        if !is_moved {
            // The slowest pole is that of the observer, three of them at once: as exact as the cube root of a rounding.
            let pole = report.largest.unwrap();
            assert!((pole.growth / -911.0 - 1.0).abs() < 1e-3, "{pole:?}");
        }
    }
}
