//! Chosen velocities against a dense solution and against each other, at unequal times.
use crate::random::{Random, walk};
use servobench_motion::pvt::{Knot, Table, average, continuous, smooth};

/// The velocities that make acceleration continuous, by Gaussian elimination with pivoting of the full system in the
/// coefficients b of all segments: 4 unknowns a segment, in time from its start, with the conditions as the source
/// states them.
fn dense(knots: &[Knot], start: f64, end: f64) -> Vec<f64> {
    let segments = knots.len() - 1;
    let n = 4 * segments;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut add = |terms: &[(usize, f64)], right: f64| {
        let mut row = vec![0.0; n + 1];
        for (column, factor) in terms {
            row[*column] += factor;
        }
        row[n] = right;
        rows.push(row);
    };
    for i in 0..segments {
        let (h, b) = (knots[i + 1].t - knots[i].t, 4 * i);
        add(&[(b, 1.0)], knots[i].x);
        add(&[(b, 1.0), (b + 1, h), (b + 2, h * h), (b + 3, h * h * h)], knots[i + 1].x);
        let velocity = [(b + 1, 1.0), (b + 2, 2.0 * h), (b + 3, 3.0 * h * h)];
        if i + 1 < segments {
            add(&[&velocity[..], &[(b + 5, -1.0)]].concat(), 0.0);
            add(&[(b + 2, 2.0), (b + 3, 6.0 * h), (b + 6, -2.0)], 0.0);
        } else {
            add(&velocity, end);
        }
    }
    add(&[(1, 1.0)], start);
    for column in 0..n {
        let pivot = (column..n).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs())).unwrap();
        rows.swap(column, pivot);
        for i in column + 1..n {
            let factor = rows[i][column] / rows[column][column];
            let above = rows[column].clone();
            rows[i].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
        }
    }
    let mut b = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| rows[i][k] * b[k]).sum();
        b[i] = (rows[i][n] - known) / rows[i][i];
    }
    (0..segments).map(|i| b[4 * i + 1]).chain([end]).collect()
}

fn distance(knots: &[Knot], velocities: &[Knot]) -> f64 {
    knots.iter().zip(velocities).map(|(a, b)| (a.v.unwrap() - b.v.unwrap()).abs()).fold(0.0, f64::max)
}

#[test]
fn the_tridiagonal_solution_is_the_dense_one() {
    let mut random = Random::seeded(1);
    for count in [2, 3, 4, 5, 9, 17] {
        for _ in 0..20 {
            let mut knots = walk(&mut random, count);
            let (start, end) = (random.between(-9.0, 9.0), random.between(-9.0, 9.0));
            continuous(&mut knots, start, end, &mut vec![0.0; count]).unwrap();
            for (knot, v) in knots.iter().zip(dense(&knots, start, end)) {
                // Slopes reach 200/s; the dense system mixes h³ ≥ 1e-7 with 1 and loses as many digits.
                assert!((knot.v.unwrap() - v).abs() < 1e-8, "{} instead of {v}", knot.v.unwrap());
            }
        }
    }
}

#[test]
fn acceleration_is_continuous_to_rounding() {
    let mut random = Random::seeded(2);
    let mut knots = walk(&mut random, 1000);
    continuous(&mut knots, 0.5, -0.5, &mut [0.0; 1000]).unwrap();
    let table = Table::new(&knots).unwrap();
    for p in knots.windows(3) {
        let h = p[1].t - p[0].t;
        let before = table.piece(p[0].t).at(p[1].t);
        let after = table.at(p[1].t);
        // The terms of a: velocities over the shorter of both times; a few dozen roundings of them.
        let scale = p.iter().map(|knot| knot.v.unwrap().abs()).fold(200.0, f64::max) / h.min(p[2].t - p[1].t);
        assert!((before.a - after.a).abs() < 1e-13 * scale, "{} {} of {scale}", before.a, after.a);
        assert!((before.v - after.v).abs() < 1e-12 && (before.x - after.x).abs() < 1e-12);
    }
}

/// The bound derived in the docs of the module: each pass leaves half of the distance at most, a third at equal times.
#[test]
fn passes_converge_to_the_tridiagonal_solution() {
    let mut random = Random::seeded(3);
    for (equal, factor) in [(false, 1.0 / 2.0), (true, 1.0 / 3.0)] {
        for count in [3, 4, 5, 30, 300] {
            let mut knots = walk(&mut random, count);
            if equal {
                (0..).zip(&mut knots).for_each(|(k, knot)| knot.t = f64::from(k) / 64.0);
            }
            let mut solution = knots.clone();
            continuous(&mut solution, 1.0, -2.0, &mut vec![0.0; count]).unwrap();
            average(&mut knots, 1.0, -2.0).unwrap();
            let mut far = distance(&knots, &solution);
            for _ in 0..60 {
                smooth(&mut knots, 1).unwrap();
                let left = distance(&knots, &solution);
                // 1e-12 for velocities up to 200: rounding of both solutions.
                assert!(left <= factor * far + 1e-12, "{left} of {far}");
                far = left;
            }
            assert!(far < 1e-12, "{far} after 60 passes");
        }
    }
}

/// One pass over four points is exact (the derivation of F2), whatever the guess and however unequal the times.
#[test]
fn one_pass_solves_four_points() {
    let mut random = Random::seeded(4);
    for _ in 0..100 {
        let mut knots = walk(&mut random, 4);
        let mut solution = knots.clone();
        continuous(&mut solution, 3.0, 4.0, &mut [0.0; 4]).unwrap();
        for knot in &mut knots {
            knot.v = Some(1e3);
        }
        (knots[0].v, knots[3].v) = (Some(3.0), Some(4.0));
        smooth(&mut knots, 1).unwrap();
        assert!(distance(&knots, &solution) < 1e-11, "velocities up to 1000, a few roundings");
    }
}

#[test]
fn refusals_name_the_point() {
    let mut knots = [Knot::moving(0.0, 0.0, 0.0), Knot::new(1.0, 1.0), Knot::moving(2.0, 0.0, 0.0)];
    assert_eq!(
        smooth(&mut knots, 1).unwrap_err().to_string(),
        "point 1: `v` must be given, got NaN: choose a first velocity for each point, by the average rule if nothing \
         better is known"
    );
    assert_eq!(
        continuous(&mut knots, 0.0, 0.0, &mut [0.0; 2]).unwrap_err().to_string(),
        "`scratch` must hold a value for each of 3 points, got room for 2: pass a longer slice"
    );
    assert!(average(&mut knots, f64::NAN, 0.0).is_err());
    knots[2].t = 1.0;
    assert_eq!(
        average(&mut knots, 0.0, 0.0).unwrap_err().to_string(),
        "point 2: `t` must be at least 1e-30 s later than at the point before, got 1: sort the points by time and give each a \
         different time"
    );
}
