use super::*;

const TICK: f64 = 1.0 / 16e3;
const P: PositionGains = PositionGains::proportional(60.0);

/// Largest stable gain (1/s) of a loop over cycles of `cycle` (s), with a position that is `delay` (s) old.
fn ultimate_gain(cycle: f64, delay: f64) -> f64 {
    2.0 / cycle * libm::tan(core::f64::consts::FRAC_PI_4 * cycle / delay)
}

/// Oracle: a cubic, which is its own interpolation.
#[test]
fn the_set_point_of_any_tick_that_is_kept_is_found() {
    let motion = |tick: u64| Setpoint { x: 3.0, v: 0.5, a: -4.0, j: 30.0, s: 0.0 }.after(tick as f64 * TICK);
    let mut position_loop = PositionLoop::OPEN;
    for cycle in 0..100 {
        position_loop.put_out(16 * cycle, &motion(16 * cycle));
        let oldest = 16 * cycle.saturating_sub(LONGEST);
        for tick in oldest..=16 * cycle {
            position_loop.receive(&P, 1.0, tick, 0, TICK);
            let error = position_loop.error() - (motion(tick).x - 1.0);
            assert!(error.abs() < 4e-15, "a few roundings at 3 m: {error} at {tick} of {cycle}");
        }
    }
}

#[test]
fn before_the_first_set_point_the_axis_is_on_the_line_to_it() {
    let mut position_loop = PositionLoop::OPEN;
    position_loop.receive(&P, 0.3, 40, 0, TICK);
    assert_eq!(position_loop.error().to_bits(), 0.0_f64.to_bits(), "nothing is followed");
    position_loop.put_out(100, &Setpoint { v: 0.1, ..Setpoint::at_rest(0.5) });
    position_loop.receive(&P, 0.25, 40, 0, TICK);
    // 60 ticks before, at 0.1 m/s.
    assert!((position_loop.error() - (0.25 - 0.1 * 60.0 * TICK)).abs() < 1e-15, "{}", position_loop.error());
    position_loop.receive(&P, 0.25, 100, 0, TICK);
    assert_eq!(position_loop.error().to_bits(), 0.25_f64.to_bits());
    position_loop.open();
    position_loop.receive(&P, 0.3, 200, 0, TICK);
    assert_eq!(position_loop.error().to_bits(), 0.0_f64.to_bits());
}

/// Largest stable gain (1/s) of the loop with integral time and derivative, with a position that is `r` cycles of `cycle` (s) old: at the
/// frequency where the response without the gain has the phase −π.
fn ultimate_gain_with(cycle: f64, r: usize, integral_time: Option<f64>, derivative: Option<Derivative>) -> f64 {
    // Complex numbers as pairs.
    let times = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
    let over = |n: (f64, f64), (c, d): (f64, f64)| {
        let (re, im) = times(n, (c, -d));
        (re / (c * c + d * d), im / (c * c + d * d))
    };
    let response = |angle: f64| {
        let z = (angle.cos(), angle.sin());
        let less = (z.0 - 1.0, z.1);
        let mut c = (1.0, 0.0);
        if let Some(time) = integral_time {
            let i = over((cycle / time, 0.0), less);
            c = (c.0 + i.0, c.1 + i.1);
        }
        if let Some(Derivative { time, filter }) = derivative {
            let d =
                over((time * less.0, time * less.1), (cycle * z.0 + filter * less.0, cycle * z.1 + filter * less.1));
            c = (c.0 + d.0, c.1 + d.1);
        }
        let plant = over((cycle / 2.0 * (z.0 + 1.0), cycle / 2.0 * z.1), less);
        let late = (r as f64 * angle).sin_cos();
        times(times(c, plant), (late.1, -late.0))
    };
    // The first angle at which the response crosses the negative real axis upwards.
    let (mut low, step) = (1e-6, 1e-5);
    let mut before = response(low);
    loop {
        let next = response(low + step);
        if before.1 < 0.0 && next.1 >= 0.0 && next.0 < 0.0 {
            return 1.0 / next.0.hypot(next.1);
        }
        (low, before) = (low + step, next);
        assert!(low < core::f64::consts::PI, "it never crosses");
    }
}

/// Largest errors of the loop, run by its own code with an ideal axis, from a tenth to a half and in the second half of the run.
fn errors(r: usize, gains: PositionGains) -> [f64; 2] {
    let law = Law { gains, feedforward: 1.0, limit: f64::INFINITY };
    let mut position_loop = PositionLoop::OPEN;
    let (mut x, mut velocities, mut positions) = (1e-6, [0.0; 2], [1e-6; 40]);
    let (cycles, mut largest) = (40_000_u64, [0.0_f64; 2]);
    for cycle in 0..cycles {
        let now = 16 * cycle;
        position_loop.put_out(now, &Setpoint::default());
        position_loop.receive(&gains, positions[r - 1], now, now, TICK);
        let (v, _) = position_loop.velocity(&law, 0.0, 1e-3);
        velocities = [velocities[1], v];
        x += 1e-3 / 2.0 * (velocities[0] + velocities[1]);
        positions.rotate_right(1);
        positions[0] = x;
        let half = usize::from(cycle >= cycles / 2);
        if cycle >= cycles / 10 {
            largest[half] = largest[half].max(x.abs());
        }
        if x.abs() > 1e3 {
            largest[1] = f64::INFINITY;
            break;
        }
    }
    largest
}

/// Oracles: the frequency response, whose phase is −π at the boundary, against the loop itself, which grows above and fades below; the
/// closed form for the integral against both.
#[test]
fn integral_and_derivative_move_the_boundary_to_where_the_frequency_response_says() {
    let cycle = 1e-3;
    for r in [1_usize, 3, 7] {
        let delay = r as f64 * cycle;
        for (integral_time, derivative) in [
            (None, None),
            (Some(20.0 * delay), None),
            (Some(4.0 * delay), None),
            (None, Some(Derivative { time: 0.3 * delay, filter: 0.1 * delay })),
            (Some(10.0 * delay), Some(Derivative { time: 0.3 * delay, filter: 0.1 * delay })),
            (Some(10.0 * delay), Some(Derivative { time: 0.2 * delay, filter: 0.0 })),
        ] {
            let ultimate = ultimate_gain_with(cycle, r, integral_time, derivative);
            let proportional = ultimate_gain(cycle, delay);
            println!("r {r}, T_i {integral_time:?}, {derivative:?}: {ultimate:.2} of {proportional:.2} 1/s");
            match (integral_time, derivative) {
                (None, None) => assert!((ultimate / proportional - 1.0).abs() < 1e-4, "{ultimate}"),
                (Some(time), None) => {
                    let c = cycle / (2.0 * time);
                    // tan(r·θ) − tan(θ/2)·(1 − c)/c changes its sign below π/(2r).
                    let f = |angle: f64| {
                        (r as f64 * angle).sin() * c - (r as f64 * angle).cos() * (angle / 2.0).tan() * (1.0 - c)
                    };
                    let (mut low, mut high) = (1e-9, core::f64::consts::FRAC_PI_2 / r as f64);
                    for _ in 0..200 {
                        let middle = f64::midpoint(low, high);
                        if f(middle) < 0.0 { low = middle } else { high = middle }
                    }
                    let t = (low / 2.0).tan();
                    let closed = 2.0 * t / (cycle * (1.0 - c).hypot(c / t));
                    assert!((ultimate / closed - 1.0).abs() < 1e-4, "{ultimate} {closed}");
                }
                _ => {}
            }
            for (share, grows) in [(0.97, false), (1.03, true)] {
                let largest = errors(r, PositionGains { gain: share * ultimate, integral_time, derivative });
                assert_eq!(largest[1] > largest[0], grows, "r {r}, {share} of {ultimate}: {largest:?}");
            }
        }
    }
}

/// Oracle: x″ + K·x′ + K/T_i·x = 0 without delay: the error of an axis that misses every velocity by d, from rest at t = 0, is
/// d·(exp(−p·t) − exp(−q·t))/(q − p), p and q its roots. It goes to zero; without the integral it stays at d/K.
#[test]
fn the_integral_takes_out_a_velocity_that_the_axis_misses() {
    let (gain, time, missed, cycle) = (20.0, 1.0, 0.05, 1e-4);
    for integral_time in [None, Some(time)] {
        let gains = PositionGains { gain, integral_time, derivative: None };
        let law = Law { gains, feedforward: 1.0, limit: 1.0 };
        let (mut position_loop, mut x) = (PositionLoop::OPEN, 0.0);
        let root = (gain * gain / 4.0 - gain / time).sqrt();
        let (p, q) = (gain / 2.0 - root, gain / 2.0 + root);
        for k in 0..100_000_u64 {
            let t = k as f64 * cycle;
            position_loop.put_out(2 * k, &Setpoint::default());
            position_loop.receive(&gains, x, 2 * k, 2 * k, cycle / 2.0);
            let error = position_loop.error();
            let expected = match integral_time {
                Some(_) => missed * ((-p * t).exp() - (-q * t).exp()) / (q - p),
                None => missed / gain * (1.0 - (-gain * t).exp()),
            };
            // Euler with steps of a 500th of 1/K: within that share of the peak.
            assert!((error - expected).abs() < missed / gain * 2.0 * gain * cycle, "{t}: {error} for {expected}");
            let (v, _) = position_loop.velocity(&law, 0.0, cycle);
            x += cycle * (v - missed);
        }
        let left = position_loop.error();
        match integral_time {
            Some(_) => assert!(left.abs() < 1e-6, "{left}"),
            None => assert!((left - missed / gain).abs() < 1e-12, "{left}"),
        }
    }
}

/// Oracle: the linear loop released at the limit with an empty integral. Overshoot from ε₀ = limit/K without delay, by the same closed
/// form; an integral that had wound up for a second would overshoot many times as much.
#[test]
fn at_the_velocity_limit_the_integral_stands() {
    let (gain, time, limit, cycle) = (20.0, 0.5, 0.2, 1e-4);
    let gains = PositionGains { gain, integral_time: Some(time), derivative: None };
    let law = Law { gains, feedforward: 1.0, limit };
    let (mut position_loop, mut x) = (PositionLoop::OPEN, 0.0);
    let (mut overshoot, mut cut) = (0.0_f64, 0.0);
    for k in 0..50_000_u64 {
        position_loop.put_out(2 * k, &Setpoint::at_rest(0.2));
        position_loop.receive(&gains, x, 2 * k, 2 * k, cycle / 2.0);
        let (v, is_cut) = position_loop.velocity(&law, 0.0, cycle);
        assert!(v.abs() <= limit);
        if is_cut {
            assert_eq!(position_loop.integral, Some(0.0), "in cycle {k}");
            cut += cycle;
        }
        x += cycle * v;
        overshoot = overshoot.max(x - 0.2);
    }
    // 0.2 m less the last limit/K at 0.2 m/s.
    assert!((cut - (1.0 - 1.0 / gain)).abs() < 2.0 * cycle, "{cut} s");
    let (start, root) = (limit / gain, (gain * gain / 4.0 - gain / time).sqrt());
    let (p, q) = (gain / 2.0 - root, gain / 2.0 + root);
    // ε(0) = ε₀, ε′(0) = −K·ε₀: ε = ε₀·((q − K)·exp(−p·t) − (p − K)·exp(−q·t))/(q − p), K = p + q.
    let error = |t: f64| start * (q * (-q * t).exp() - p * (-p * t).exp()) / (q - p);
    let expected = (0..50_000).map(|k| -error(f64::from(k) * 1e-4)).fold(0.0, f64::max);
    println!("overshoot {overshoot:.3e} m, {expected:.3e} m");
    assert!((overshoot / expected - 1.0).abs() < 0.02, "{overshoot} {expected}");
}

/// Oracle: the filtered difference of a ramp, T_d times its slope with the lag of the filter; also after lost frames.
#[test]
fn the_derivative_is_that_of_the_filtered_error() {
    let derivative = Derivative { time: 5e-3, filter: 2e-3 };
    let gains = PositionGains { derivative: Some(derivative), ..P };
    let mut position_loop = PositionLoop::OPEN;
    let mut received = 0;
    for cycle in 0..200_u64 {
        let now = 16 * cycle;
        position_loop.put_out(now, &Setpoint::default());
        // Every third frame is lost.
        if cycle % 3 != 1 {
            let t = now as f64 * TICK;
            position_loop.receive(&gains, -0.3 * t, now, now, TICK);
            received += 1;
        }
    }
    // Fifty time constants later the initial transient has decayed.
    assert!((position_loop.derivative - 0.3 * 5e-3).abs() < 1e-12, "{} after {received}", position_loop.derivative);
    let law = Law { gains, feedforward: 0.0, limit: 10.0 };
    let (v, _) = position_loop.velocity(&law, 0.0, 1e-3);
    assert!((v - 60.0 * (position_loop.error() + 0.3 * 5e-3)).abs() < 1e-12, "{v}");
}

/// Oracle: the recursion of the characteristic equation grows above the gain and fades below it.
#[test]
fn the_ultimate_gain_is_where_the_recursion_neither_grows_nor_fades() {
    for r in [1_usize, 2, 3, 7, 31] {
        let gain = ultimate_gain(1e-3, r as f64 * 1e-3);
        for (share, grows) in [(0.97, false), (1.03, true)] {
            let mut x = [1.0; 40];
            let mut largest = [0.0_f64; 2];
            for step in 0..40_000 {
                let next = x[0] - share * gain * 1e-3 / 2.0 * (x[r - 1] + x[r]);
                x.rotate_right(1);
                x[0] = next;
                let half = usize::from(step >= 400);
                if !(400..39_600).contains(&step) {
                    largest[half] = largest[half].max(next.abs());
                }
                if next.abs() > 1e6 {
                    largest[1] = next.abs();
                    break;
                }
            }
            assert_eq!(largest[1] > largest[0], grows, "r {r}, {share} of {gain}: {largest:?}");
        }
    }
}
