//! What a master writes to the drive.
use crate::{refused, tables};
use servobench_fuzz::{Number, ValueGenerator, check, fuzz, produce};
use servobench_motion::pvt::{Knot, Point, Record, to_knots, to_points};

/// Words and the values behind them; half of the words without reserved bits, so that many are points.
fn streams() -> impl ValueGenerator<Output = Vec<(u16, Vec<i32>)>> {
    let values = produce::<Vec<i32>>().with().len(0..4_usize);
    let word = (produce::<u16>(), produce::<bool>(), values)
        .map_gen(|(word, plain, values)| (if plain { word & 0x10FF } else { word }, values));
    produce::<Vec<(u16, Vec<i32>)>>().with().len(0..12_usize).values(word)
}

#[test]
fn records() {
    let requests = (streams(), produce::<bool>(), produce::<i32>(), Number::magnitude());
    fuzz(check!(), 20_000, requests, |(stream, ends, origin, unit)| {
        let mut points = Vec::new();
        for (i, (word, values)) in stream.iter().enumerate() {
            match Record::decode(i, *word, values) {
                Ok(record) => {
                    let words = record.encode();
                    assert_eq!((words.word(), words.values()), (*word, &values[..]), "{record:?}");
                    if let Record::Point(point) = record {
                        points.push(point);
                    }
                }
                Err(error) => refused(error, stream.len()),
            }
        }
        if let Some(last) = points.last_mut().filter(|_| *ends) {
            last.time_ms = 0;
        }
        let mut knots = vec![Knot::default(); points.len()];
        let knots = match to_knots(&points, *origin, *unit, &mut knots) {
            Ok(knots) => knots,
            Err(error) => return refused(error, points.len()),
        };
        tables::holds(knots, *unit);
        if knots.iter().any(|knot| knot.x.abs() > 1e30 || knot.v.is_some_and(|v| v.abs() > 1e30)) {
            return;
        }
        let mut back = vec![Point::default(); points.len()];
        // The way back is exact: absolute, and rounded to the count that it came from.
        let back = to_points(knots, *unit, &mut back).unwrap_or_else(|error| panic!("{error} of {points:?}"));
        let mut position = *origin;
        for (point, back) in points.iter().zip(back) {
            position = if point.relative { position + point.position } else { point.position };
            assert_eq!(*back, Point { position, relative: false, ..*point });
        }
    });
}

#[test]
fn points_of_tables() {
    fuzz(check!(), 20_000, (tables::knots(), Number::magnitude()), |(knots, unit)| {
        let mut points = vec![Point::default(); knots.len()];
        match to_points(knots, *unit, &mut points) {
            Ok(points) => {
                let mut back = vec![Knot::default(); points.len()];
                let back = to_knots(points, 0, *unit, &mut back).unwrap_or_else(|error| panic!("{error} of {knots:?}"));
                for (one, other) in knots.iter().zip(back) {
                    // Half a count, and the rounding of the quotient.
                    let most = 0.5 * unit + 1e-12 * one.x.abs();
                    assert!((one.x - other.x).abs() <= most, "{one:?} {other:?}");
                }
            }
            Err(error) => refused(error, knots.len()),
        }
    });
}
