//! Option 2 of the position profile: the error of an ideal drive that obeys the commands is as announced.
use crate::drive::follow;
use crate::random::{Random, walk};
use servobench_motion::PlanError;
use servobench_motion::position_profile::{Spline, Stepped};
use servobench_motion::pvt::Knot;

fn solve(knots: &mut [Knot], start: f64, end: f64) -> Spline<'_> {
    let mut scratch = vec![0.0; knots.len()];
    Spline::solve(knots, start, end, &mut scratch).unwrap()
}

/// The error of the drive at each of `times`.
fn errors(way: Stepped<'_>, spline: Spline<'_>, times: &[f64]) -> Vec<f64> {
    let table = spline.table();
    let first = table.knots()[0];
    let drive = follow(way.commands(), (first.t, first.x, first.v.unwrap()), times.iter().copied());
    drive.into_iter().zip(times).map(|((x, _), t)| x - table.at(*t).x).collect()
}

/// The system of the source in the coefficients C, as printed, solved by general elimination; then
/// B_i = ΔA/dT − dT/3·(C_(i+1) + 2·C_i), which is the velocity of point i.
fn velocities_of_the_source(knots: &[Knot], start: f64, end: f64) -> Vec<f64> {
    let n = knots.len();
    let h: Vec<f64> = knots.windows(2).map(|p| p[1].t - p[0].t).collect();
    let slope: Vec<f64> = knots.windows(2).map(|p| (p[1].x - p[0].x) / (p[1].t - p[0].t)).collect();
    let mut m = vec![vec![0.0; n + 1]; n];
    (m[0][0], m[0][1], m[0][n]) = (2.0 / 3.0 * h[0], h[0] / 3.0, slope[0] - start);
    for i in 0..n - 2 {
        let (left, right) = (h[i], h[i + 1]);
        (m[i + 1][i], m[i + 1][i + 1], m[i + 1][i + 2]) = (left / 3.0, 2.0 / 3.0 * (left + right), right / 3.0);
        m[i + 1][n] = slope[i + 1] - slope[i];
    }
    (m[n - 1][n - 2], m[n - 1][n - 1], m[n - 1][n]) = (h[n - 2] / 3.0, 2.0 / 3.0 * h[n - 2], -(slope[n - 2] - end));
    for column in 0..n {
        for i in (0..n).filter(|i| *i != column) {
            let factor = m[i][column] / m[column][column];
            let above = m[column].clone();
            m[i].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
        }
    }
    let c: Vec<f64> = (0..n).map(|i| m[i][n] / m[i][i]).collect();
    (0..n - 1).map(|i| slope[i] - h[i] / 3.0 * (c[i + 1] + 2.0 * c[i])).chain([end]).collect()
}

#[test]
fn the_spline_is_that_of_the_source() {
    let mut random = Random::seeded(10);
    for count in [2, 3, 4, 12, 60] {
        let mut knots = walk(&mut random, count);
        let expected = velocities_of_the_source(&knots, 1.5, -2.5);
        for (knot, v) in solve(&mut knots, 1.5, -2.5).table().knots().iter().zip(expected) {
            // Slopes up to 200/s, conditioning of a diagonally dominant system: some dozen roundings.
            assert!((knot.v.unwrap() - v).abs() < 1e-11, "{:?} instead of {v}", knot.v);
        }
    }
}

/// Times that are whole numbers of commands: E(t_i) = h²/12·(a(t_i) − a(t_0)), announced without any margin.
#[test]
fn points_on_commands_err_by_the_change_of_acceleration() {
    let mut knots = [(0.0, 0.0), (0.25, 1.0), (0.375, 0.5), (0.75, 2.0), (1.0, 0.0)].map(|(t, x)| Knot::new(t, x));
    let spline = solve(&mut knots, 0.5, -0.5);
    let way = spline.stepped(64.0).unwrap();
    assert_eq!((way.count(), way.commands().count(), way.point_errors().len()), (64, 64, 5));
    let a = |t| spline.table().at(t).a;
    // The acceleration at the end, from inside.
    let a_end = spline.table().piece(0.8).at(1.0).a;
    let expected = [0.0, a(0.25) - a(0.0), a(0.375) - a(0.0), a(0.75) - a(0.0), a_end - a(0.0)];
    for (error, difference) in way.point_errors().zip(expected) {
        assert!((error - difference / 64.0_f64.powi(2) / 12.0).abs() < 1e-14, "{error}: a few roundings of x ≤ 2");
    }
    let largest = expected.into_iter().map(f64::abs).fold(0.0, f64::max) / 64.0_f64.powi(2) / 12.0;
    assert!((way.largest_error() - largest).abs() < 1e-14);
}

/// Any times and any rate, from one command for the whole move to hundreds for a segment: the error of the drive at the
/// points is as computed, and nowhere more than announced.
#[test]
fn the_drive_errs_as_announced() {
    let mut random = Random::seeded(11);
    let mut tightest = f64::INFINITY;
    for k in 0..400 {
        let mut knots = walk(&mut random, 2 + k % 30);
        let spline = solve(&mut knots, random.between(-5.0, 5.0), random.between(-5.0, 5.0));
        let rate = 10.0_f64.powf(random.between(-0.5, 3.5));
        let way = spline.stepped(rate).unwrap();
        let table = spline.table();
        let points: Vec<f64> = table.knots().iter().map(|knot| knot.t).collect();
        let speed = way.commands().map(|command| command.velocity.abs()).fold(5.0, f64::max);
        // The drive adds up a distance of speed·duration; its ramps end a rounding of t early or late. The computed error
        // adds up jumps of jerk times h³, more than the error itself if h is longer than the segments.
        let jerk = points.iter().map(|t| table.at(*t).j.abs()).fold(0.0, f64::max);
        let rounding = 1e-13 * (1.0 + speed * table.duration()) * (1.0 + way.count() as f64 / 100.0)
            + 1e-15 * points.len() as f64 * jerk / rate.powi(3);
        for (announced, actual) in way.point_errors().zip(errors(way, spline, &points)) {
            assert!((announced - actual).abs() < rounding, "at {rate}/s: {announced} announced, {actual}");
        }
        let fine: Vec<f64> = (0..=5000).map(|k| points[0] + table.duration() * f64::from(k) / 5000.0).collect();
        let largest =
            errors(way, spline, &fine).into_iter().chain(way.point_errors()).map(f64::abs).fold(0.0, f64::max);
        assert!(largest <= way.largest_error() + rounding, "at {rate}/s: {largest} of {}", way.largest_error());
        if table.duration() * rate < 1e3 {
            tightest = tightest.min(largest / way.largest_error());
        }
    }
    // The announced error is reached: five instants and more per command, of an error that is stationary at its
    // largest.
    assert!(tightest > 0.95, "{tightest}");
}

/// Ten times 0.1 s added up are 0.9999999999999999 s, three times 0.1 s a rounding more than 0.3 s: no command is
/// sent for that.
#[test]
fn rounding_of_times_is_no_interval() {
    for (segments, count) in [(3, 300), (10, 1000)] {
        let mut t = 0.0;
        let mut knots = vec![Knot::new(0.0, 0.0)];
        for x in 0..segments {
            t += 0.1;
            knots.push(Knot::new(t, f64::from(x % 3)));
        }
        let spline = solve(&mut knots, 0.0, 0.0);
        assert_eq!(spline.stepped(1000.0).unwrap().count(), count);
        let shorter = spline.stepped(1000.5).unwrap();
        let last = shorter.commands().last().unwrap();
        assert!((shorter.count(), t - last.t < 0.6e-3) == (count + 1, true), "{last:?}");
    }
}

/// With a constant jerk (two points), E = j·h³/12 per command: the rate follows by hand.
#[test]
fn the_lowest_rate_by_hand() {
    // x = t³ from 0 to 1 in 1 s: j = 6, E = h²/12·6 = h²/2 at whole rates; 5e-5 needs 100/s exactly.
    let mut knots = [Knot::new(0.0, 0.0), Knot::new(1.0, 1.0)];
    let spline = solve(&mut knots, 0.0, 3.0);
    assert_eq!(spline.lowest_rate(5.0000001e-5), Ok(100));
    assert_eq!(spline.lowest_rate(4.9999999e-5), Ok(101));
    assert_eq!(spline.lowest_rate(0.6), Ok(1));
}

#[test]
fn the_lowest_rate_is_enough_and_one_less_is_not() {
    let mut random = Random::seeded(12);
    for k in 0..60 {
        let mut knots = walk(&mut random, 2 + k);
        let spline = solve(&mut knots, 0.0, 0.0);
        let allowed = 10.0_f64.powf(random.between(-8.0, -1.0));
        let rate = spline.lowest_rate(allowed).unwrap();
        assert!(spline.stepped(f64::from(rate)).unwrap().largest_error() <= allowed);
        if rate > 1 {
            assert!(spline.stepped(f64::from(rate - 1)).unwrap().largest_error() > allowed);
        }
    }
}

/// Halving the interval quarters the error: the trapezoidal rule is of order 2.
#[test]
fn the_error_is_of_order_two() {
    let mut knots = walk(&mut Random::seeded(13), 10);
    let spline = solve(&mut knots, 0.0, 0.0);
    let error = |rate| spline.stepped(rate).unwrap().largest_error();
    let order = (error(1000.0) / error(2000.0)).log2();
    assert!((order - 2.0).abs() < 0.02, "observed order {order}");
}

#[test]
fn refusals() {
    let mut knots = walk(&mut Random::seeded(14), 5);
    let spline = solve(&mut knots, 0.0, 0.0);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e31] {
        assert!(spline.stepped(rate).is_err());
    }
    let too_often = spline.stepped(1e15).unwrap_err();
    assert!(
        matches!(too_often, PlanError::OutOfRange { name: "rate", highest, .. } if (1e11..1e13).contains(&highest))
    );
    assert!(too_often.to_string().ends_with("send fewer commands, or let the table begin at time 0"));
    assert!(spline.lowest_rate(0.0).is_err());
    let refusal = spline.lowest_rate(1e-29).unwrap_err().to_string();
    assert!(
        refusal.starts_with("`allowed` must be between ") && refusal.ends_with("give the move more time"),
        "{refusal}"
    );
}
