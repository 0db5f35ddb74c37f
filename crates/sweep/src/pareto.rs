//! Pareto fronts of two criteria.

/// Indices of the `points` that no other one dominates, ascending by the first number. The smaller of two numbers is better; a point
/// dominates another if it is not worse in either and better in one. All of several equal points are included; points with NaN
/// never are.
#[must_use]
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|place| !(points[*place].0.is_nan() || points[*place].1.is_nan())).collect();
    // Zeros of either sign are equal: 0 is added.
    let key = |place: &usize| (points[*place].0 + 0.0, points[*place].1 + 0.0);
    order.sort_unstable_by(|one, other| {
        let ((x, y), (u, v)) = (key(one), key(other));
        x.total_cmp(&u).then(y.total_cmp(&v)).then(one.cmp(other))
    });
    let mut last: Option<(f64, f64)> = None;
    order.retain(|place| {
        let here = key(place);
        let is_better = last.is_none_or(|best| here.1 < best.1 || here == best);
        if is_better {
            last = Some(here);
        }
        is_better
    });
    order
}

/// The indices of [`front`] without those that a remaining point beats when nearby values count as `equal`: no larger in either number,
/// and smaller in one. This thins out a dense front but keeps ends that are far apart.
#[must_use]
pub fn front_apart(points: &[(f64, f64)], equal: &[impl Fn(f64, f64) -> bool; 2]) -> Vec<usize> {
    let is_smaller = |one: f64, other: f64, k: usize| one < other && !equal[k](one, other);
    let beats = |one: &usize, other: &usize| {
        let ((x, y), (u, v)) = (points[*one], points[*other]);
        let is_larger = is_smaller(u, x, 0) || is_smaller(v, y, 1);
        !is_larger && (is_smaller(x, u, 0) || is_smaller(y, v, 1))
    };
    // From the second number upwards: a point as fast and calmer comes first, a point as calm and faster replaces others.
    let mut kept: Vec<usize> = Vec::new();
    for one in front(points).into_iter().rev() {
        if !kept.iter().any(|other| beats(other, &one)) {
            kept.retain(|other| !beats(&one, other));
            kept.push(one);
        }
    }
    kept.reverse();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn neither_ties_nor_what_is_no_number_confuse_it() {
        let nan = f64::NAN;
        let points = [(2.0, 1.0), (1.0, 2.0), (1.0, 2.0), (1.0, 3.0), (2.0, 1.5), (nan, 0.0), (0.0, nan), (3.0, 1.0)];
        assert_eq!(front(&points), [1, 2, 0]);
        assert_eq!(front(&[(0.0, -0.0), (-0.0, 0.0), (0.0, 1.0)]), [0, 1]);
        assert_eq!(front(&[(1.0, f64::INFINITY), (f64::NEG_INFINITY, f64::INFINITY)]), [1]);
        assert!(front(&[]).is_empty() && front(&[(nan, nan)]).is_empty());
    }

    #[test]
    fn what_is_nearly_equal_is_not_a_choice() {
        let near = |one: f64, other: f64| (one - other).abs() <= 0.01 * one.abs().min(other.abs());
        // The second is as fast as the first and calmer; the third is slower and as calm.
        let points = [(1.0, 5.0), (1.005, 1.0), (1.5, 0.995), (2.0, 0.5), (f64::INFINITY, 0.1)];
        assert_eq!(front(&points), [0, 1, 2, 3, 4]);
        assert_eq!(front_apart(&points, &[near, near]), [1, 3, 4]);
        assert_eq!(front_apart(&[(1.0, 1.0), (1.0, 1.0)], &[near, near]), [0, 1], "none beats its equal");
        assert!(front_apart(&[], &[near, near]).is_empty());
        // In a dense front each is as fast as the next, which is calmer: it is thinned out, but not emptied from one end to the other.
        let dense: Vec<(f64, f64)> = (0..500).map(|k| 1.0 + 0.002 * f64::from(k)).map(|x| (x, 1.0 / (x * x))).collect();
        let apart = front_apart(&dense, &[near, near]);
        let steps: Vec<f64> = apart.windows(2).map(|pair| dense[pair[1]].0 / dense[pair[0]].0).collect();
        assert!(apart.len() < 400 && steps.iter().all(|step| *step < 1.02), "{steps:?}");
        assert!(apart[0] < 10 && apart.last() == Some(&499), "{apart:?}");
    }

    /// Numbers, many of them equal.
    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            8 => (0..6_i32).prop_map(f64::from),
            4 => -1e300..1e300_f64,
            1 => Just(f64::NAN),
            1 => Just(-0.0),
            1 => Just(f64::INFINITY),
        ]
    }

    proptest! {
        /// Oracle: the definition, each point against all others.
        #[test]
        fn it_is_what_each_against_each_leaves(points in prop::collection::vec((number(), number()), 0..40)) {
            let dominates = |(x, y): (f64, f64), (u, v): (f64, f64)| x <= u && y <= v && (x < u || y < v);
            let is_number = |place: &usize| !points[*place].0.is_nan() && !points[*place].1.is_nan();
            let expected: Vec<usize> = (0..points.len())
                .filter(is_number)
                .filter(|place| !points.iter().any(|other| dominates(*other, points[*place])))
                .collect();
            let mut found = front(&points);
            prop_assert!(found.windows(2).all(|pair| points[pair[0]].0 <= points[pair[1]].0));
            found.sort_unstable();
            prop_assert_eq!(found, expected);
        }
    }
}
