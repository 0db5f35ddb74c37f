//! Set-points of a table: the polynomial of each segment, the order of reading, a million points.
use crate::random::{Random, walk};
use servobench_base::Setpoint;
use servobench_motion::pvt::{Knot, Table, average, continuous, smooth};

/// Position and velocity by the Hermite basis (Farin, *Curves and Surfaces for CAGD*, 7.5), a form without b0 … b3.
fn hermite(p: &[Knot], t: f64) -> (f64, f64) {
    let h = p[1].t - p[0].t;
    let u = (t - p[0].t) / h;
    let (v0, v1) = (p[0].v.unwrap(), p[1].v.unwrap());
    let x = p[0].x * (1.0 - u).powi(2) * (1.0 + 2.0 * u)
        + p[1].x * u * u * (3.0 - 2.0 * u)
        + h * u * (1.0 - u) * (v0 * (1.0 - u) - v1 * u);
    let v = (p[1].x - p[0].x) / h * 6.0 * u * (1.0 - u) + v0 * (1.0 - u) * (1.0 - 3.0 * u) + v1 * u * (3.0 * u - 2.0);
    (x, v)
}

#[test]
fn cubic_segments_are_hermite_polynomials_and_meet_the_points() {
    let mut random = Random::seeded(5);
    let mut knots = walk(&mut random, 200);
    for knot in &mut knots {
        knot.v = Some(random.between(-20.0, 20.0));
    }
    let table = Table::new(&knots).unwrap();
    for p in knots.windows(2) {
        assert_eq!((table.at(p[0].t).x, table.at(p[0].t).v), (p[0].x, p[0].v.unwrap()));
        for k in 0..=10 {
            let t = p[0].t + (p[1].t - p[0].t) * (f64::from(k) / 10.0);
            let (s, (x, v)) = (table.piece(p[0].t).at(t), hermite(p, t));
            // Positions up to 20, velocities up to 200 that cancel: a few dozen roundings.
            assert!((s.x - x).abs() < 1e-13 && (s.v - v).abs() < 1e-11, "at {t}: {s:?} {x} {v}");
        }
    }
    let last = knots[199];
    assert_eq!(table.at(last.t), Setpoint { x: last.x, v: last.v.unwrap(), ..Setpoint::default() });
}

/// Velocity, acceleration and jerk are the derivatives of position: central differences are exact for a parabola, and
/// leave j·d²/6 of a cubic.
#[test]
fn derivatives_belong_together() {
    let mut random = Random::seeded(6);
    let mut knots = walk(&mut random, 20);
    continuous(&mut knots, 0.0, 0.0, &mut [0.0; 20]).unwrap();
    let table = Table::new(&knots).unwrap();
    let d = 1e-4;
    for p in knots.windows(2) {
        let t = f64::midpoint(p[0].t, p[1].t);
        let (before, s, after) = (table.at(t - d), table.at(t), table.at(t + d));
        let slope = |left: f64, right: f64| (right - left) / (2.0 * d);
        assert!((slope(before.x, after.x) - s.v - s.j * d * d / 6.0).abs() < 1e-10 * (1.0 + s.v.abs()));
        assert!((slope(before.v, after.v) - s.a).abs() < 1e-8 * (1.0 + s.a.abs()));
        assert!((slope(before.a, after.a) - s.j).abs() < 1e-6 * (1.0 + s.j.abs()));
    }
}

/// PT, and PT between PVT: the slope of the points, and a cubic segment that continues with it.
#[test]
fn linear_segments() {
    let knots = [
        Knot::moving(0.0, 1.0, 9.0),
        Knot::new(2.0, 5.0),
        Knot::new(3.0, 3.0),
        Knot::moving(4.0, 4.0, 1.0),
        Knot::new(5.0, 6.0),
    ];
    let table = Table::new(&knots).unwrap();
    let linear = |x, v| Setpoint { x, v, ..Setpoint::default() };
    assert_eq!([table.at(0.0), table.at(0.5), table.at(1.5)], [linear(1.0, 2.0), linear(2.0, 2.0), linear(4.0, 2.0)]);
    assert_eq!([table.at(2.0), table.at(2.5), table.at(4.5)], [linear(5.0, -2.0), linear(4.0, -2.0), linear(5.0, 2.0)]);
    // From (3, −2) to (4, 1) in 1 s: b2 = 3 + 4 − 1 = 6, b3 = −1 − 2 = −3.
    assert_eq!(table.at(3.0), Setpoint { x: 3.0, v: -2.0, a: 12.0, j: -18.0, s: 0.0 });
    assert_eq!([table.at(5.0), table.at(f64::INFINITY)], [linear(6.0, 0.0); 2]);
    assert_eq!([table.at(-1.0), table.at(f64::NEG_INFINITY), table.at(f64::NAN)], [linear(1.0, 2.0); 3]);
    let from_rest = [Knot::new(0.0, 1.0), Knot::moving(1.0, 2.0, 0.0)];
    assert_eq!(Table::new(&from_rest).unwrap().at(0.0), Setpoint { x: 1.0, v: 0.0, a: 6.0, j: -12.0, s: 0.0 });
}

#[test]
fn a_cursor_reads_the_same_in_any_order() {
    let mut random = Random::seeded(7);
    let mut knots = walk(&mut random, 300);
    average(&mut knots, 0.0, 1.0).unwrap();
    (3..300).step_by(7).for_each(|i| knots[i].v = None);
    let table = Table::new(&knots).unwrap();
    let mut cursor = table.cursor();
    let mut t = knots[0].t - 1.0;
    while t < knots[299].t + 1.0 {
        assert_eq!(cursor.at(t), table.at(t));
        t += random.between(-0.02, 0.1);
    }
    for k in 0..1000 {
        let t = match random.unit() {
            u if u < 0.1 => f64::NAN,
            u if u < 0.3 => knots[k * 7 % 300].t,
            _ => random.between(-2.0, knots[299].t + 1.0),
        };
        assert_eq!(cursor.at(t), table.at(t));
    }
    assert_eq!(table.samples(0.01).next(), Some(table.at(knots[0].t)));
    assert_eq!(table.samples(f64::NAN).count(), 1);
}

/// A million points on a sine, 1 ms apart, all rules, and two million samples. At equal times and away from the ends
/// the velocities of a cubic spline are right to order 4, so that it errs as a Hermite polynomial does:
/// h⁴/384·max|x⁗|.
#[test]
fn a_million_points() {
    const N: usize = 1_000_000;
    let omega = 20.0;
    let mut knots: Vec<Knot> = (0..N).map(|k| k as f64 / 1e3).map(|t| Knot::new(t, (omega * t).sin())).collect();
    let end = omega * (omega * knots[N - 1].t).cos();
    average(&mut knots, omega, end).unwrap();
    smooth(&mut knots, 2).unwrap();
    continuous(&mut knots, omega, end, &mut vec![0.0; N]).unwrap();
    let table = Table::new(&knots).unwrap();
    let (mut count, mut largest) = (0_u32, 0.0_f64);
    for s in table.samples(5e-4) {
        let t = f64::from(count) * 5e-4;
        largest = largest.max((s.x - (omega * t).sin()).abs());
        count += 1;
    }
    assert_eq!(count, 1_999_999);
    // (1e-3·20)⁴/384 = 4.1667e-10; the sines are rounded at arguments of 20000, by up to 4e-12.
    assert!((largest - 4.1667e-10).abs() < 4e-12, "{largest}");
}
