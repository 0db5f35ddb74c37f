//! A long move, streamed by a master with irregular cycles.
use crate::axis::{Axis, COUNT, PERIOD, assert_near, cubic, idle, linear, run, whole};
use servobench_cia402::interpolated::{BufferError, Point, SegmentCommand, SubMode};
use servobench_motion::pvt::{Knot, Table};
use servobench_testkit::Random;

const POINTS: usize = 10_000;

/// The points in SI, as in a table: relative to the position at the start of the move, at absolute times.
fn knots(points: &[Point], origin: i32) -> Vec<Knot> {
    let (mut position, mut time) = (origin, 0_u32);
    let knot = |point: &Point| {
        position = if point.is_relative { position + point.position } else { point.position };
        let t = f64::from(time / 1000) / 1e3;
        time += point.time;
        Knot { t, x: f64::from(position) * COUNT, v: point.velocity.map(|v| f64::from(v) * 0.1 * COUNT) }
    };
    points.iter().map(knot).collect()
}

/// Points on a sum of sines, 5 to 20 ms apart, from rest to rest. Every position and velocity fits into 24 bits.
fn move_along_sines(random: &mut Random) -> Vec<Point> {
    let along = |t: f64| {
        let rise = (t / 5.0).min(1.0);
        let waves = [(0.9e6, 0.31), (0.4e6, 0.73), (0.1e6, 1.9)];
        let x: f64 = waves.iter().map(|(a, w)| a * (1.0 - (w * t).cos())).sum();
        let v: f64 = waves.iter().map(|(a, w)| a * w * (w * t).sin()).sum();
        (rise * x, rise * v)
    };
    let mut t = 0.0;
    let mut points: Vec<Point> = (0..POINTS)
        .map(|_| {
            let (x, v) = along(t);
            let ms = 5 + u32::try_from(random.next() % 16).unwrap();
            t += f64::from(ms) / 1e3;
            cubic(whole(x), whole(v / 0.1), ms)
        })
        .collect();
    points[0].velocity = Some(0);
    let last = points.len() - 1;
    (points[last].velocity, points[last].time) = (Some(0), 0);
    points
}

/// A master that wakes every 20 ms, up to 100 ms late, and sends no more points than the buffer has room for.
struct Master<'a> {
    points: &'a [Point],
    sent: usize,
    wakes: f64,
    random: Random,
}

impl Master<'_> {
    fn send(&mut self, axis: &mut Axis, t: f64) {
        if t < self.wakes {
            return;
        }
        self.wakes += 0.02 + 0.1 * self.random.unit();
        // The master knows the buffer by 2012h only: free places, and the number of the next segment.
        let free = usize::try_from(axis.buffer.status() >> 16 & 0xFF).unwrap();
        for point in self.points.iter().skip(self.sent).take(free) {
            let counter = axis.buffer.status().to_le_bytes()[0] & 7;
            let bytes = SegmentCommand::Point { counter, point: *point }.encode().unwrap();
            axis.buffer.apply(SegmentCommand::decode(bytes).unwrap()).unwrap();
            self.sent += 1;
        }
    }
}

#[test]
fn a_master_that_comes_late_keeps_ten_thousand_points_flowing() {
    let mut random = Random::seeded(4);
    let points = move_along_sines(&mut random);
    let knots = knots(&points, 0);
    let table = Table::new(&knots).unwrap();
    let mut cursor = table.cursor();

    let mut axis = Axis::at(0, SubMode::Cubic);
    let mut master = Master { points: &points, sent: 0, wakes: 0.0, random };
    master.send(&mut axis, 0.0);
    axis.step(idle());
    let (mut fewest, mut furthest) = (usize::MAX, [0.0_f64; 2]);
    let mut k = 0_u32;
    loop {
        let t = f64::from(k) * PERIOD;
        master.send(&mut axis, t);
        let setpoint = axis.step(run());
        if !axis.answer.bit_12 {
            break;
        }
        let expected = cursor.at(t);
        // Positions of metres, summed from pieces: some roundings of 2e-16 each, and those of the time in a segment, of a
        // microsecond's 1e-12 at a metre per second.
        assert_near(setpoint.x, expected.x, 1e-12);
        assert_near(setpoint.v, expected.v, 1e-11);
        furthest = [furthest[0].max((setpoint.x - expected.x).abs()), furthest[1].max((setpoint.v - expected.v).abs())];
        if master.sent < POINTS {
            fewest = fewest.min(32 - axis.buffer.free());
        }
        k += 1;
    }
    assert_near(f64::from(k) * PERIOD, table.duration(), PERIOD);
    assert_eq!((master.sent, axis.errors()), (POINTS, 0));
    assert!(!axis.buffer.has(BufferError::Underflow) && axis.answer.target_reached);
    assert_near(axis.last.x, f64::from(points[POINTS - 1].position) * COUNT, 0.0);
    println!("at least {fewest} points waited; positions to {:e} m, velocities to {:e} m/s", furthest[0], furthest[1]);
    assert!(fewest < 25, "the master is late enough to matter: {fewest}");
}

#[test]
fn linear_points_and_cubic_ones_mix_as_in_a_table() {
    // No segment leads to the first point: a cubic begins with its velocity.
    for (first, second) in
        [(None, None), (Some(1_000_000), None), (Some(1_000_000), Some(-400_000)), (None, Some(-400_000))]
    {
        follows_the_table(first, second);
    }
}

fn follows_the_table(first: Option<i32>, second: Option<i32>) {
    let either = |point: Point, velocity: Option<i32>| Point { velocity, ..point };
    let relative = |point: Point| Point { is_relative: true, ..point };
    let points = [
        either(linear(1000, 10), first),
        either(linear(3000, 20), second),
        relative(cubic(-500, -300_000, 7)),
        cubic(9000, 200_000, 30),
        relative(linear(-2000, 10)),
        cubic(7000, 0, 0),
    ];
    let knots = knots(&points, 1000);
    let table = Table::new(&knots).unwrap();
    let mut axis = Axis::at(1000, SubMode::Cubic);
    axis.add(&points);
    for k in 0..308 {
        let setpoint = axis.step(run());
        assert!(axis.answer.bit_12, "{k}");
        // Not at a point itself: there it is a matter of rounding to which segment the instant belongs.
        if k % 4 != 0 {
            let expected = table.at(f64::from(k) * PERIOD);
            // The time in a segment is summed here and subtracted there: 1e-17 s at 1 m/s, and a few roundings of 1e-18 m.
            assert_near(setpoint.x, expected.x, 1e-16);
            assert_near(setpoint.v, expected.v, 1e-13);
            assert_near(setpoint.a, expected.a, 1e-10);
        }
    }
    axis.step(run());
    assert_eq!((axis.last.x, axis.last.v, axis.answer.bit_12), (7000.0 * COUNT, 0.0, false));
}
