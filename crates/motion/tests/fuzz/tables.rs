//! Tables of positions, velocities and times.
use crate::{is_finite, refused};
use servobench_fuzz::{Number, ValueGenerator, check, fuzz, produce};
use servobench_motion::pvt::{Knot, Table, average, continuous, s_curve, s_curve_segment_time, smooth};

/// Tables of which a good part is valid: times mostly add up.
pub(crate) fn knots() -> impl ValueGenerator<Output = Vec<Knot>> {
    let point = (Number::magnitude(), Number::any(), Number::any(), 0..64_u8);
    produce::<Vec<(f64, f64, f64, u8)>>().with().len(0..9_usize).values(point).map_gen(|points| {
        let mut t = 0.0;
        let knot = |(dt, x, v, kind): (f64, f64, f64, u8)| {
            t = if kind == 63 { dt } else { t + dt };
            Knot { t, x, v: (kind % 4 != 0).then_some(v) }
        };
        points.into_iter().map(knot).collect()
    })
}

/// Times at, beside and between the points, and others.
pub(crate) fn times(knots: &[Knot], t: f64) -> Vec<f64> {
    let edges = knots.iter().flat_map(|knot| [knot.t, knot.t.next_down(), knot.t.next_up()]);
    let middles = knots.windows(2).map(|pair| f64::midpoint(pair[0].t, pair[1].t));
    edges.chain(middles).chain([t, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]).collect()
}

/// A table of these points is refused, or meets them.
pub(crate) fn holds(knots: &[Knot], t: f64) {
    let table = match Table::new(knots) {
        Ok(table) => table,
        Err(error) => return refused(error, knots.len()),
    };
    let mut cursor = table.cursor();
    for t in times(knots, t) {
        assert!(is_finite(table.at(t)), "at {t:e}: {:?} of {knots:?}", table.at(t));
        assert_eq!(cursor.at(t), table.at(t), "at {t:e} of {knots:?}");
    }
    for knot in knots {
        assert_eq!((table.at(knot.t).x + 0.0).to_bits(), (knot.x + 0.0).to_bits(), "{knot:?} of {knots:?}");
    }
    assert!(table.samples(t.abs()).take(100).all(is_finite), "{knots:?}");
}

#[test]
fn points_and_velocities() {
    let requests = (knots(), [Number::any(); 3], 0..5_usize);
    fuzz(check!(), 20_000, requests, |(knots, [start, end, t], passes)| {
        holds(knots, *t);
        let mut scratch = vec![0.0; knots.len()];
        for rule in 0..3 {
            let mut knots = knots.clone();
            let chosen = match rule {
                0 => average(&mut knots, *start, *end),
                1 => average(&mut knots, *start, *end).and_then(|()| smooth(&mut knots, *passes)),
                _ => continuous(&mut knots, *start, *end, &mut scratch),
            };
            match chosen {
                Ok(()) => {
                    assert!(knots.iter().all(|knot| knot.v.is_some_and(f64::is_finite)), "{knots:?}");
                    holds(&knots, *t);
                }
                Err(error) => refused(error, knots.len()),
            }
        }
    });
}

#[test]
fn s_curves() {
    fuzz(check!(), 20_000, [Number::any(); 5], |[start, distance, time, jerk, t]| {
        match s_curve(*start, *distance, *time) {
            Ok(knots) => holds(&knots, *t),
            Err(error) => refused(error, 5),
        }
        match s_curve_segment_time(*distance, *jerk) {
            Ok(time) => assert!(time > 0.0 && time.is_finite(), "{time:e}"),
            Err(error) => refused(error, 0),
        }
    });
}
