//! Option 1 of the position profile: an ideal drive that obeys the commands hits every position.
use crate::drive::follow;
use crate::random::{Random, walk};
use servobench_motion::position_profile::Plateaus;
use servobench_motion::pvt::Knot;

/// Three points by hand: dT = 1 and 1, α = 1/4, p = 0, 1, 1, V_s = V_e = 0. W_1 = (V_1 + V_2)/2 and
/// 2 = 3/2·V_1 + W_1/4, 0 = 3/2·V_2 + W_1/4 give V_1 − V_2 = 4/3 and V_1 + V_2 = 8/7, so V_1 = 26/21, V_2 = −2/21.
#[test]
fn two_segments_by_hand() {
    let mut knots = [Knot::new(0.0, 0.0), Knot::new(1.0, 1.0), Knot::new(2.0, 1.0)];
    let way = Plateaus::solve(&mut knots, 0.0, 0.0, 0.25, &mut [0.0; 3]).unwrap();
    let near = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-15, "{value} instead of {expected}");
    near(way.plateau(0).unwrap(), 26.0 / 21.0);
    near(way.plateau(1).unwrap(), -2.0 / 21.0);
    near(way.knots()[1].v.unwrap(), 4.0 / 7.0);
    let commands: Vec<_> = way.commands().collect();
    assert_eq!(way.commands().len(), 3);
    for (command, (t, v, a)) in
        commands.iter().zip([(0.0, 26.0 / 21.0, 104.0 / 21.0), (0.75, -2.0 / 21.0, 8.0 / 3.0), (1.75, 0.0, 8.0 / 21.0)])
    {
        near(command.t, t);
        near(command.velocity, v);
        assert!((command.acceleration - a).abs() < 4e-15, "{} instead of {a}", command.acceleration);
    }
}

fn cases() -> impl Iterator<Item = (Vec<Knot>, f64, f64, f64)> {
    let mut random = Random::seeded(8);
    (0..300).map(move |k| {
        let knots = walk(&mut random, 2 + k % 40);
        let alpha = if k % 10 == 0 { 0.5 } else { random.between(0.01, 0.5) };
        (knots, random.between(-5.0, 5.0), random.between(-5.0, 5.0), alpha)
    })
}

/// 1e-12 of the distance travelled: the drive adds up its path over all segments.
#[test]
fn the_drive_hits_every_position() {
    for (mut knots, start, end, alpha) in cases() {
        let count = knots.len();
        let way = Plateaus::solve(&mut knots, start, end, alpha, &mut vec![0.0; count]).unwrap();
        let first = way.knots()[0];
        let times = way.knots().iter().map(|knot| knot.t);
        let travelled = way.knots().windows(2).map(|p| (p[1].x - p[0].x).abs()).sum::<f64>().max(1.0);
        for (knot, (x, v)) in way.knots().iter().zip(follow(way.commands(), (first.t, first.x, start), times)) {
            assert!((x - knot.x).abs() <= 1e-12 * travelled, "{x} instead of {}", knot.x);
            // Ramps begin and end at rounded times: a few roundings of t ≤ 10 s under up to 1e5/s².
            assert!((v - knot.v.unwrap()).abs() <= 1e-9, "{v} instead of {:?}", knot.v);
        }
        assert_eq!((way.knots()[0].v, way.knots()[count - 1].v), (Some(start), Some(end)));
    }
}

/// The set-points are the path of the drive, and at the points of the table they are its positions bit for bit.
#[test]
fn set_points_are_what_the_drive_does() {
    for (mut knots, start, end, alpha) in cases() {
        let count = knots.len();
        let way = Plateaus::solve(&mut knots, start, end, alpha, &mut vec![0.0; count]).unwrap();
        let (first, last) = (way.knots()[0], way.knots()[count - 1]);
        let times: Vec<f64> = (0..=997).map(|k| first.t + (last.t - first.t) * f64::from(k) / 997.0).collect();
        let mut cursor = way.cursor();
        for (t, (x, v)) in times.iter().zip(follow(way.commands(), (first.t, first.x, start), times.iter().copied())) {
            let s = way.at(*t);
            assert!((s.x - x).abs() < 1e-12 * count as f64 && (s.v - v).abs() < 1e-9, "at {t}: {s:?}, drive {x} {v}");
            assert_eq!(cursor.at(*t), s);
        }
        for knot in way.knots() {
            assert_eq!(way.at(knot.t).x.to_bits(), knot.x.to_bits());
        }
    }
}

/// Velocity is constant from α·dT to (1 − α)·dT of every segment, as the source requires.
#[test]
fn plateaus_are_where_they_belong() {
    let mut knots = walk(&mut Random::seeded(9), 12);
    let way = Plateaus::solve(&mut knots, 0.0, 0.0, 0.2, &mut [0.0; 12]).unwrap();
    for (i, p) in way.knots().windows(2).enumerate() {
        let h = p[1].t - p[0].t;
        for u in [0.2001, 0.5, 0.7999] {
            let s = way.at(p[0].t + u * h);
            assert_eq!((s.v, s.a), (way.plateau(i).unwrap(), 0.0));
        }
        assert!(way.at(p[0].t + 0.19 * h).a != 0.0 && way.at(p[0].t + 0.81 * h).a != 0.0);
    }
    assert_eq!(way.plateau(11), None);
}

#[test]
fn refusals() {
    let mut knots = [Knot::new(0.0, 0.0), Knot::new(1.0, 1.0)];
    for alpha in [0.0, -0.1, 0.51, f64::NAN] {
        assert!(Plateaus::solve(&mut knots, 0.0, 0.0, alpha, &mut [0.0; 2]).is_err());
    }
    let refusal =
        |knots: &mut [Knot], end: f64| Plateaus::solve(knots, 0.0, end, 0.3, &mut [0.0; 2]).unwrap_err().to_string();
    assert_eq!(
        refusal(&mut knots[..1], 0.0),
        "a table needs at least 2 points, got 1: add the point where the move ends"
    );
    assert_eq!(refusal(&mut [], 0.0), "a table needs at least 2 points, got 0: add the point where the move ends");
    assert_eq!(
        refusal(&mut knots, f64::NAN),
        "point 1: `v` must be a number within ±1e30, got NaN: correct it or its unit"
    );
}
