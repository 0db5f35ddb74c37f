//! Tables sent as velocity commands.
use crate::{is_finite, refused, tables};
use servobench_fuzz::{Number, ValueGenerator, check, fuzz};
use servobench_motion::position_profile::{Command, Plateaus, Spline};
use servobench_motion::pvt::Knot;

fn is_usable(command: Command) -> bool {
    let Command { t, velocity, acceleration } = command;
    t.is_finite() && velocity.is_finite() && acceleration.is_finite() && acceleration >= 0.0
}

fn requests() -> impl ValueGenerator<Output = (Vec<Knot>, [f64; 3], [f64; 2])> {
    (tables::knots(), [Number::any(); 3], [Number::magnitude(); 2])
}

#[test]
fn plateaus() {
    fuzz(check!(), 20_000, requests(), |(knots, [start, end, t], [share, _])| {
        let mut scratch = vec![0.0; knots.len()];
        for alpha in [*share, share / 2e3, 0.5, 1e-30] {
            let mut knots = knots.clone();
            let points = knots.len();
            match Plateaus::solve(&mut knots, *start, *end, alpha, &mut scratch) {
                Ok(way) => {
                    assert!(way.commands().all(is_usable), "{:?} of {way:?}", way.commands().collect::<Vec<_>>());
                    let mut cursor = way.cursor();
                    for t in tables::times(way.knots(), *t) {
                        assert!(is_finite(way.at(t)), "at {t:e}: {:?} of {way:?}", way.at(t));
                        assert_eq!(cursor.at(t), way.at(t), "at {t:e} of {way:?}");
                    }
                }
                Err(error) => refused(error, points),
            }
        }
    });
}

#[test]
fn stepped_splines() {
    fuzz(check!(), 10_000, requests(), |(knots, [start, end, _], [rate, allowed])| {
        let (mut knots, points) = (knots.clone(), knots.len());
        let mut scratch = vec![0.0; points];
        let spline = match Spline::solve(&mut knots, *start, *end, &mut scratch) {
            Ok(spline) => spline,
            Err(error) => return refused(error, points),
        };
        for rate in [*rate, 1e3, 3.0 / spline.table().duration()] {
            match spline.stepped(rate) {
                Ok(way) => {
                    assert!(way.commands().take(100).all(is_usable), "{way:?}");
                    assert!(way.point_errors().all(f64::is_finite), "{way:?}");
                    let largest = way.largest_error();
                    assert!(largest.is_finite() && largest >= 0.0, "{largest} of {way:?}");
                }
                Err(error) => refused(error, points),
            }
        }
        match spline.lowest_rate(*allowed) {
            Ok(rate) => assert!(rate >= 1),
            Err(error) => refused(error, points),
        }
    });
}
