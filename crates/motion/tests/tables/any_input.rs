//! Any bit pattern as input: a move or a refusal with the number of a point that exists, never a panic, never a
//! set-point that is no number.
use proptest::prelude::*;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::position_profile::{Command, Plateaus, Spline};
use servobench_motion::pvt::{Knot, Point, Record, Table, average, continuous, s_curve, smooth, to_knots, to_points};

fn any_number() -> impl Strategy<Value = f64> {
    const SPECIAL: [f64; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        f64::MAX,
        f64::MIN_POSITIVE,
        1e-30,
        1e30,
        -1e30,
    ];
    prop_oneof![
        1 => any::<u64>().prop_map(f64::from_bits),
        4 => (-30.0..30.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent)),
        4 => (-30.0..30.0_f64).prop_map(|exponent| -(10.0_f64.powf(exponent))),
        8 => -1e3..1e3_f64,
        1 => (0..SPECIAL.len()).prop_map(|i| SPECIAL[i]),
    ]
}

/// Tables of which a good part is valid: times mostly add up.
fn any_knots() -> impl Strategy<Value = Vec<Knot>> {
    let knot = (any_number(), any_number(), proptest::option::of(any_number()), 0..40);
    (proptest::collection::vec(knot, 0..9), any::<bool>()).prop_map(|(knots, tame)| {
        let mut t = 0.0;
        let knots = knots.into_iter().map(|(dt, x, v, odd)| {
            t = if odd == 0 { dt } else { t + dt.abs() };
            let small = |value: f64| if tame && value.abs() > 1e30 { 1.0 } else { value };
            Knot { t, x: small(x), v: v.map(small) }
        });
        knots.collect()
    })
}

fn numbers(s: Setpoint) -> bool {
    [s.x, s.v, s.a, s.j, s.s].iter().all(|value| value.is_finite())
}

fn refused(error: PlanError, points: usize) -> Result<(), TestCaseError> {
    if let PlanError::Point { point, .. } = error {
        prop_assert!(point < points, "{error} of {points} points");
    }
    prop_assert!(error.to_string().len() > 20);
    Ok(())
}

fn times(knots: &[Knot], t: f64) -> Vec<f64> {
    let edges = knots.iter().flat_map(|knot| [knot.t, knot.t.next_down(), knot.t.next_up()]);
    let middles = knots.windows(2).map(|p| f64::midpoint(p[0].t, p[1].t));
    edges.chain(middles).chain([t, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]).collect()
}

fn check_table(knots: &[Knot], t: f64) -> Result<(), TestCaseError> {
    match Table::new(knots) {
        Ok(table) => {
            for t in times(knots, t) {
                prop_assert!(numbers(table.at(t)), "at {t:e}: {:?} of {knots:?}", table.at(t));
                prop_assert_eq!(table.cursor().at(t), table.at(t));
            }
            prop_assert!(table.samples(t.abs()).take(100).all(numbers));
            Ok(())
        }
        Err(e) => refused(e, knots.len()),
    }
}

fn command(command: Command) -> bool {
    command.t.is_finite()
        && command.velocity.is_finite()
        && command.acceleration.is_finite()
        && command.acceleration >= 0.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]
    #[test]
    fn tables_and_velocities(knots in any_knots(), start in any_number(), end in any_number(), t in any_number()) {
        check_table(&knots, t)?;
        let mut scratch = vec![0.0; knots.len()];
        for rule in 0..3 {
            let mut knots = knots.clone();
            let chosen = match rule {
                0 => average(&mut knots, start, end),
                1 => average(&mut knots, start, end).and_then(|()| smooth(&mut knots, 3)),
                _ => continuous(&mut knots, start, end, &mut scratch),
            };
            match chosen {
                Ok(()) => {
                    prop_assert!(knots.iter().all(|knot| knot.v.is_some_and(f64::is_finite)), "{:?}", knots);
                    check_table(&knots, t)?;
                }
                Err(e) => refused(e, knots.len())?,
            }
        }
    }

    #[test]
    fn position_profiles(
        knots in any_knots(),
        start in any_number(),
        end in any_number(),
        share in any_number(),
        t in any_number(),
        rate in any_number(),
    ) {
        let mut scratch = vec![0.0; knots.len()];
        for alpha in [share, share.abs() / 2e3, 0.5, 1e-30] {
            let mut knots = knots.clone();
            let points = knots.len();
            match Plateaus::solve(&mut knots, start, end, alpha, &mut scratch) {
                Ok(way) => {
                    prop_assert!(way.commands().all(command), "{:?} of {:?}", way.commands().collect::<Vec<_>>(), way);
                    for t in times(way.knots(), t) {
                        prop_assert!(numbers(way.at(t)), "at {t:e}: {:?} of {:?}", way.at(t), way);
                        prop_assert_eq!(way.cursor().at(t), way.at(t));
                    }
                }
                Err(e) => refused(e, points)?,
            }
        }
        let (mut knots, points) = (knots, scratch.len());
        match Spline::solve(&mut knots, start, end, &mut scratch) {
            Ok(spline) => {
                for rate in [rate.abs(), 1e3, 3.0 / spline.table().duration()] {
                    match spline.stepped(rate) {
                        Ok(way) => {
                            prop_assert!(way.commands().take(100).all(command));
                            prop_assert!(way.point_errors().all(f64::is_finite), "{:?}", way);
                            prop_assert!(way.largest_error().is_finite() && way.largest_error() >= 0.0);
                        }
                        Err(e) => refused(e, points)?,
                    }
                }
                match spline.lowest_rate(share.abs()) {
                    Ok(rate) => prop_assert!(rate >= 1),
                    Err(e) => refused(e, points)?,
                }
            }
            Err(e) => refused(e, points)?,
        }
    }

    #[test]
    fn words_and_points(
        stream in proptest::collection::vec((any::<u16>(), proptest::collection::vec(any::<i32>(), 0..4)), 0..12),
        origin in any::<i32>(),
        unit in any_number(),
    ) {
        let mut points = Vec::new();
        for (i, (word, values)) in stream.iter().enumerate() {
            // Half of the words without reserved bits, so that many are points.
            match Record::decode(i, if i % 2 == 0 { word & 0x10FF } else { *word }, values) {
                Ok(Record::Point(point)) => points.push(point),
                Ok(record) => prop_assert_eq!(record.encode().values().len(), 0),
                Err(e) => refused(e, stream.len())?,
            }
        }
        if let Some(last) = points.last_mut() {
            last.time_ms = 0;
        }
        let mut knots = vec![Knot::default(); points.len()];
        match to_knots(&points, origin, unit, &mut knots) {
            Ok(knots) => {
                let mut back = vec![Point::default(); points.len()];
                match to_points(knots, unit, &mut back) {
                    // The way back is exact: absolute, and rounded to the count that it came from.
                    Ok(back) => {
                        let kept = |(a, b): (&Point, &Point)| (a.velocity, a.time_ms) == (b.velocity, b.time_ms);
                        prop_assert!(back.iter().zip(&points).all(kept));
                    }
                    Err(e) => refused(e, points.len())?,
                }
                check_table(knots, unit)?;
            }
            Err(e) => refused(e, points.len())?,
        }
    }

    #[test]
    fn s_curves(start in any_number(), distance in any_number(), time in any_number(), t in any_number()) {
        match s_curve(start, distance, time) {
            Ok(knots) => check_table(&knots, t)?,
            Err(e) => refused(e, 5)?,
        }
    }
}
