//! The examples that the source prints, in counts and counts per second.
use servobench_motion::pvt::{Knot, Table, average, continuous, s_curve, s_curve_segment_time, smooth};

const T: f64 = 0.01;

/// Positions 10 ms apart.
fn table_of<const N: usize>(positions: [f64; N]) -> [Knot; N] {
    let mut k = 0;
    positions.map(|x| {
        k += 1;
        Knot::new(f64::from(k - 1) / 100.0, x)
    })
}

fn velocities(knots: &[Knot]) -> Vec<f64> {
    knots.iter().map(|knot| knot.v.unwrap()).collect()
}

/// Relative to `scale`: a dozen roundings of numbers up to `scale`.
fn assert_near(value: f64, expected: f64, scale: f64) {
    assert!((value - expected).abs() <= 1e-14 * scale, "{value} instead of {expected}");
}

/// "The velocity passed with the second point is (15000 − 0)/0.020 or 750000."
#[test]
fn the_average_rule_on_four_points() {
    let mut knots = table_of([0.0, 5e3, 15e3, 20e3]);
    average(&mut knots, 0.0, 0.0).unwrap();
    for (v, expected) in velocities(&knots).into_iter().zip([0.0, 75e4, 75e4, 0.0]) {
        assert_near(v, expected, 75e4);
    }
}

/// Zero velocities: a(t) = 6·ΔP/T²·(1 − 2t/T) in each segment, so that it jumps from −6·5000/T² to +6·10000/T².
#[test]
fn four_points_with_zero_velocities_jump_in_acceleration() {
    let mut knots = table_of([0.0, 5e3, 15e3, 20e3]);
    for knot in &mut knots {
        knot.v = Some(0.0);
    }
    let table = Table::new(&knots).unwrap();
    let full = 6.0 * 1e4 / (T * T);
    assert_near(table.at(T.next_down()).a, -0.5 * full, 1e2 * full);
    assert_near(table.at(T).a, full, full);
    assert_near(table.at(1.5 * T).v, 1.5 * 1e4 / T, 1e7);
    assert_near(table.at(2.0 * T).a, 0.5 * full, full);
}

/// F2 by hand: V1 = (12·15000/T − 3·15000/T)/15 = 900000 = V2; a(T) = (4·9000 − 6·5000)/T² = 6·10⁷ from either side.
#[test]
fn four_points_with_continuous_acceleration() {
    let mut knots = table_of([0.0, 5e3, 15e3, 20e3]);
    continuous(&mut knots, 0.0, 0.0, &mut [0.0; 4]).unwrap();
    for (v, expected) in velocities(&knots).into_iter().zip([0.0, 9e5, 9e5, 0.0]) {
        assert_near(v, expected, 9e5);
    }
    let table = Table::new(&knots).unwrap();
    for (t, a) in [(0.0, 12e7), (T.next_down(), 6e7), (T, 6e7), (2.0 * T, -6e7), ((3.0 * T).next_down(), -12e7)] {
        // One rounding of t moves a by j·2e-18 s; the terms of a are ten times as large as a.
        assert_near(table.at(t).a, a, 1e10);
    }
    let exact = velocities(&knots);
    average(&mut knots, 0.0, 0.0).unwrap();
    smooth(&mut knots, 1).unwrap();
    for (v, expected) in velocities(&knots).into_iter().zip(exact) {
        assert_near(v, expected, 9e5);
    }
}

const TEN: [f64; 10] = [0.0, 100.0, 150.0, 200.0, 300.0, 240.0, 0.0, -100.0, -50.0, 40.0];

#[test]
fn the_first_guess_at_ten_positions() {
    let mut knots = table_of(TEN);
    average(&mut knots, 0.0, 0.0).unwrap();
    let printed = [0.0, 7500.0, 5000.0, 7500.0, 2000.0, -15000.0, -17000.0, -2500.0, 7000.0, 0.0];
    for (v, expected) in velocities(&knots).into_iter().zip(printed) {
        assert_near(v, expected, 2e4);
    }
}

/// Largest jump of acceleration at an inner point, by the formulas of the source, b2 and b3 as printed.
fn largest_jump(knots: &[Knot]) -> f64 {
    let end = |p: &[Knot]| {
        let (p0, p1, v0, v1) = (p[0].x, p[1].x, p[0].v.unwrap(), p[1].v.unwrap());
        let b2 = 3.0 * (p1 - p0) / (T * T) - (2.0 * v0 + v1) / T;
        let b3 = (v1 + v0) / (T * T) + 2.0 * (p0 - p1) / (T * T * T);
        (2.0 * b2, 2.0 * b2 + 6.0 * b3 * T)
    };
    knots.windows(3).map(|p| (end(&p[..2]).1 - end(&p[1..]).0).abs()).fold(0.0, f64::max)
}

/// "Much smaller" after one pass, "no obvious discontinuities" after two: equal times leave a third at most per pass.
#[test]
fn passes_over_ten_positions_remove_the_jumps_of_acceleration() {
    let mut knots = table_of(TEN);
    average(&mut knots, 0.0, 0.0).unwrap();
    let mut jumps = vec![largest_jump(&knots)];
    for _ in 0..4 {
        smooth(&mut knots, 1).unwrap();
        jumps.push(largest_jump(&knots));
    }
    assert!(jumps[0] > 1e6 && jumps.windows(2).all(|pair| pair[1] < pair[0] / 3.0), "{jumps:?}");
    let mut twice = table_of(TEN);
    average(&mut twice, 0.0, 0.0).unwrap();
    smooth(&mut twice, 4).unwrap();
    assert_eq!(twice, knots, "four passes in one call are four calls");
}

/// From 0 to 1000 counts in four segments of 100 ms: J = D/(2T³) = 500000. Oracle: the jerk integrated by hand,
/// pos = J·T³·[0, 1/6, 1, 11/6, 2] and vel = J·T²·[0, 1/2, 1, 1/2, 0].
#[test]
fn the_s_curve_from_0_to_1000() {
    let (jerk, t) = (5e5, 0.1);
    let knots = s_curve(0.0, 1000.0, t).unwrap();
    for (knot, x) in knots.iter().zip([0.0, 1.0 / 6.0, 1.0, 11.0 / 6.0, 2.0]) {
        assert_near(knot.x, jerk * 1e-3 * x, 1e3);
    }
    assert_eq!(velocities(&knots), [0.0, 2500.0, 5000.0, 2500.0, 0.0]);
    let table = Table::new(&knots).unwrap();
    for (i, sign) in [1.0, -1.0, -1.0, 1.0].into_iter().enumerate() {
        let s = table.at((i as f64 + 0.5) * t);
        // The jerk is a difference of velocities over T²: 1e-13 relative.
        assert_near(s.j, sign * jerk, 10.0 * jerk);
        assert_near(s.a, [0.5, 0.5, -0.5, -0.5][i] * jerk * t, 10.0 * jerk * t);
    }
    assert_near(s_curve_segment_time(-1000.0, jerk).unwrap(), t, 1.0);
    assert_eq!(s_curve(7.0, -1000.0, t).unwrap()[4], Knot::moving(0.4, -993.0, -0.0));
}
