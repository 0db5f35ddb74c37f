//! Shares of functions with known shares.
use servobench_sweep::{
    Arrangement, Axis, Column, Distribution, Drawn, Draws, Method, Outcome, Sample, Sensitivity, Sweep, Table, Value,
};
use std::f64::consts::PI;

/// The table of `function` of the settings of each point, in the order of the keys; values that are not numbers count as 0.
fn with_table(sweep: &Sweep, engines: &[&str], function: impl Fn(usize, &[f64]) -> f64, look: impl FnOnce(&Table<'_>)) {
    let engines: Vec<String> = engines.iter().map(|name| (*name).to_owned()).collect();
    let row = |row: usize| {
        let point = sweep.point(row % sweep.points());
        let numbers: Vec<f64> = point.iter().map(|setting| setting.value.number().unwrap_or(0.0)).collect();
        function(row / sweep.points(), &numbers)
    };
    let rows = engines.len().max(1) * sweep.points();
    let column = Column { name: "settling_time".into(), unit: "s".into(), values: (0..rows).map(row).collect() };
    look(&Table { sweep, engines: &engines, columns: vec![column], outcomes: vec![Outcome::Good; rows] });
}

fn drawn(count: u32, seed: u64, method: Method, distribution: Distribution, keys: &[&str]) -> Draws {
    let keys = keys.iter().map(|key| Drawn { key: (*key).into(), unit: "kg".into(), distribution }).collect();
    Draws::new(count, seed, method, keys).unwrap()
}

fn axis(key: &str, values: &[f64]) -> Axis {
    Axis { key: key.into(), values: values.iter().map(|value| Value::Number(*value, String::new())).collect() }
}

fn of_draws(sweep: &Sweep, function: impl Fn(&[f64]) -> f64) -> Sensitivity {
    let mut found = None;
    with_table(sweep, &[], |_, x| function(x), |table| found = Sensitivity::of_draws(table, &table.columns[0]));
    found.unwrap()
}

fn share(of: &Sensitivity, key: &str) -> f64 {
    of.keys.iter().find(|one| one.key == key).unwrap().share
}

const NORMAL: Distribution = Distribution::Normal { mean: 0.0, sigma: 1.0 };

/// Published: T. Ishigami & T. Homma, *An importance quantification technique in uncertainty analysis for computer models*, 1990; the
/// indices for a = 7 and b = 0.1 in Saltelli et al. 2008: 0.3139, 0.4424, 0. The tolerance is three standard errors of the mean of 40
/// seeds, measured by their scatter, plus the change of the mean within a bin: (width of a bin)²/12 times the mean squared slope over the
/// variance, which is 13.845.
#[test]
fn the_function_of_ishigami_has_its_published_shares() {
    const COUNT: u32 = 4096;
    let uniform = Distribution::Uniform { low: -PI, high: PI };
    let ishigami = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
    let width: f64 = 2.0 * PI / 64.0;
    let within = |squared_slope: f64| width * width / 12.0 * squared_slope / 13.845;
    for method in [Method::Random, Method::LatinHypercube] {
        let found: Vec<Sensitivity> = (0..40)
            .map(|seed| {
                let draws = drawn(COUNT, seed, method, uniform, &["x1", "x2", "x3"]);
                of_draws(&Sweep::new(vec![], Arrangement::Grid, Some(draws)).unwrap(), ishigami)
            })
            .collect();
        let slope = (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2) / 2.0;
        for (key, published, within) in [("x1", 0.3139, within(slope)), ("x2", 0.4424, within(24.5))] {
            let sample = Sample::of(found.iter().map(|one| share(one, key))).unwrap();
            // Plus half a unit of the last published digit.
            let tolerance = 3.0 * sample.standard_error() + within + 0.5e-4;
            assert!((sample.mean() - published).abs() < tolerance, "{method:?} {key}: {} ± {tolerance}", sample.mean());
            assert!(tolerance < 0.01, "{method:?} {key}: the standard error tells nothing: {tolerance}");
        }
        // A share of 0 appears by chance: the largest of 40 half-normal numbers exceeds four standard deviations only once in 400 times.
        for one in &found {
            let key = one.keys.iter().find(|key| key.key == "x3").unwrap();
            assert!(key.share < 4.0 * key.chance && key.chance < 0.004, "{method:?}: {key:?}");
            assert_eq!(one.keys[0].key, "x2");
            assert!((one.rest - 0.2437).abs() < 0.06, "{method:?}: {}", one.rest);
        }
    }
}

/// Share of the variance of a normal number in the means of `bins` equally likely parts: a part from z to w has the mean
/// K (φ(z) − φ(w)).
fn of_bins(bins: u32) -> f64 {
    let k = f64::from(bins);
    let density = |place: u32| match place {
        0 => 0.0,
        _ if place == bins => 0.0,
        _ => (-0.5 * NORMAL.quantile(f64::from(place) / k).powi(2)).exp() / (2.0 * PI).sqrt(),
    };
    (0..bins).map(|bin| (k * (density(bin) - density(bin + 1))).powi(2) / k).sum()
}

/// For 3 a + 2 b + c with normal numbers the shares are 9, 4 and 1 of 14; the highest tenth of a normal number has the mean
/// φ(1.2816)/0.1 = 1.7550. Tolerances: three standard errors, measured over 40 seeds; for the ends those reported.
#[test]
fn a_linear_function_has_the_squares_of_its_slopes() {
    for (method, count) in [(Method::Random, 1024), (Method::LatinHypercube, 1024), (Method::LatinHypercube, 100)] {
        let found: Vec<Sensitivity> = (0..40)
            .map(|seed| {
                let draws = drawn(count, seed, method, NORMAL, &["a", "b", "c"]);
                let sweep = Sweep::new(vec![], Arrangement::Grid, Some(draws)).unwrap();
                of_draws(&sweep, |x| 3.0 * x[0] + 2.0 * x[1] + x[2])
            })
            .collect();
        for (key, slope) in [("a", 3.0), ("b", 2.0), ("c", 1.0)] {
            let expected = slope * slope / 14.0 * of_bins(count.isqrt());
            let sample = Sample::of(found.iter().map(|one| share(one, key))).unwrap();
            let (mean, error) = (sample.mean(), sample.standard_error());
            // Clamping raises the small share of a few draws, by the part below 0 of a normal number with its scatter.
            let clamped = if count == 100 && key == "c" { 0.4 * sample.deviation() } else { 0.0 };
            // The ends' parts of the variance are those of the sample, with an error of 1/n.
            let tolerance = 3.0 * error + clamped + 2.0 / f64::from(count);
            assert!((mean - expected).abs() < tolerance, "{method:?} {count} {key}: {mean} ± {error}, not {expected}");
            let of_key = |one: &Sensitivity| one.keys.iter().find(|other| other.key == key).unwrap().clone();
            let tenth = if count == 1024 { 1.7550 } else { 1.7400 };
            let ends = found.iter().map(of_key);
            let beyond =
                ends.filter(|end| (end.difference() - 2.0 * tenth * slope).abs() > 3.0 * end.error + 0.03 * slope);
            // One in 370 for normal numbers; ten draws are closer to Student's distribution.
            assert!(beyond.count() <= 3, "{method:?} {count} {key}");
        }
    }
}

/// The low and the high end are identified by the value of the key.
#[test]
fn ends_are_said_in_the_unit_of_the_key() {
    let draws = drawn(1000, 1, Method::LatinHypercube, Distribution::Uniform { low: 4.0, high: 6.0 }, &["mass"]);
    let found = of_draws(&Sweep::new(vec![], Arrangement::Grid, Some(draws)).unwrap(), |x| 10.0 * x[0]);
    let key = &found.keys[0];
    // A tenth of 4 to 6 kg at either end: 4.1 and 5.9 kg on average, to a thousandth of the range.
    for (end, at) in [(&key.low, 4.1), (&key.high, 5.9)] {
        assert!((end.at.number().unwrap() - at).abs() < 2e-3 && end.at.unit() == "kg", "{end:?}");
        assert!((end.mean - 10.0 * at).abs() < 2e-2, "{end:?}");
    }
    assert!(key.share > 0.998 && found.rest < 0.002, "{found:?}");
    assert!((found.deviation - 10.0 * 2.0 / 12_f64.sqrt()).abs() < 0.01, "{found:?}");
}

/// Effects of axes are removed from the scatter, and a key keeps its share even if another value of an axis inverts its effect.
#[test]
fn axes_and_draws_are_apart() {
    let draws = || Some(drawn(1024, 1, Method::LatinHypercube, NORMAL, &["a", "b"]));
    let sweep = Sweep::new(vec![axis("k", &[-1.0, 1.0])], Arrangement::Grid, draws()).unwrap();
    let found = of_draws(&sweep, |x| 1000.0 * x[0] + x[1] + x[2]);
    let alone = of_draws(&Sweep::new(vec![], Arrangement::Grid, draws()).unwrap(), |x| x[0] + x[1]);
    // The same draws in each combination: the same shares, up to the digits lost with an offset of 1000.
    for key in ["a", "b"] {
        assert!((share(&found, key) - share(&alone, key)).abs() < 1e-9 && share(&found, key) > 0.4, "{found:?}");
    }
    let together = of_draws(&sweep, |x| x[0] * x[1] + 0.5 * x[2]);
    // In either group variance 1 from a and 0.25 from b; bins of normal numbers lose a hundredth.
    assert!((share(&together, "b") - 0.2).abs() < 0.03 && (share(&together, "a") - 0.8).abs() < 0.03, "{together:?}");
    let of_a = together.keys.iter().find(|key| key.key == "a").unwrap();
    assert!(of_a.difference().abs() < 2.0 * of_a.error, "up and down: {together:?}");
    assert!(together.rest < 0.03, "{together:?}");
    // The joint effect of two keys belongs to neither.
    let product = of_draws(&sweep, |x| x[1] * x[2]);
    assert!(product.rest > 0.9 && product.keys.iter().all(|key| key.share < 5.0 * key.chance), "{product:?}");
    with_table(
        &sweep,
        &[],
        |_, x| 1000.0 * x[0] + x[1],
        |table| {
            let found = Sensitivity::of_axes(table, &table.columns[0]).unwrap();
            assert_eq!((found.keys.len(), found.keys[0].key.as_str()), (1, "k"));
            assert!((found.keys[0].share - 1.0).abs() < 1e-12 && (found.keys[0].difference() - 2000.0).abs() < 1e-9);
        },
    );
}

/// By hand: the values of a grid are complete, so that the shares are those of sums. i² for 0, 1, 2 has the variance 26/9, 3 j for 0
/// and 1 has 9/4; an engine that adds 1 has 1/4.
#[test]
fn shares_of_axes_are_those_by_hand() {
    let sweep = Sweep::new(vec![axis("i", &[2.0, 0.0, 1.0]), axis("j", &[0.0, 1.0])], Arrangement::Grid, None).unwrap();
    let engines = ["exact", "mujoco"];
    with_table(
        &sweep,
        &engines,
        |engine, x| x[0] * x[0] - 3.0 * x[1] + engine as f64,
        |table| {
            let found = Sensitivity::of_axes(table, &table.columns[0]).unwrap();
            let total = 26.0 / 9.0 + 9.0 / 4.0 + 1.0 / 4.0;
            for (key, variance, difference) in [("i", 26.0 / 9.0, 4.0), ("j", 2.25, -3.0), ("engine", 0.25, 1.0)] {
                let one = found.keys.iter().find(|one| one.key == key).unwrap();
                assert!((one.share - variance / total).abs() < 1e-12, "{one:?}");
                assert!(
                    (one.difference() - difference).abs() < 1e-12 && one.error == 0.0 && one.chance == 0.0,
                    "{one:?}"
                );
            }
            assert!(found.rest < 1e-12);
            // Ends are ordered by the number, not by the order of the runs.
            assert_eq!(found.keys[0].low.at, Value::Number(0.0, String::new()));
        },
    );
    with_table(
        &sweep,
        &[],
        |_, x| (x[0] - 1.0) * (x[1] - 0.5),
        |table| {
            let found = Sensitivity::of_axes(table, &table.columns[0]).unwrap();
            assert!(found.rest > 1.0 - 1e-12, "what keys do together only is no key's: {found:?}");
        },
    );
    with_table(&sweep, &[], |_, _| 7.0, |table| assert!(Sensitivity::of_axes(table, &table.columns[0]).is_none()));
}

/// High values of both axes are not measured together, which must not favour either of them. Oracle: the function.
#[test]
fn combinations_that_are_missing_do_not_confound_the_axes() {
    let axes = vec![axis("i", &[0.0, 1.0, 2.0, 3.0]), axis("j", &[0.0, 1.0, 2.0])];
    let sweep = Sweep::new(axes, Arrangement::Grid, None).unwrap();
    let sum = |x: &[f64]| if x[0] > 1.5 && x[1] > 0.5 { f64::NAN } else { 100.0 * x[0] + x[1] };
    with_table(
        &sweep,
        &[],
        |_, x| sum(x),
        |table| {
            let found = Sensitivity::of_axes(table, &table.columns[0]).unwrap();
            let difference = |key: &str| found.keys.iter().find(|one| one.key == key).unwrap().difference();
            // Iterations end at 1e-12 of the deviation, which is 100, and each leaves a part of the remainder.
            assert!((difference("i") - 300.0).abs() < 1e-8 && (difference("j") - 2.0).abs() < 1e-8, "{found:?}");
            assert!(found.rest < 1e-12 && found.keys[0].key == "i" && found.keys[1].share < 1e-3, "{found:?}");
        },
    );
}

#[test]
fn keys_that_go_side_by_side_are_one_and_names_have_ends_too() {
    let names =
        Axis { key: "shaper".into(), values: ["zv", "none", "zvd"].map(|name| Value::Text(name.into())).to_vec() };
    let sweep = Sweep::new(vec![names, axis("j", &[5.0, 9.0, 1.0])], Arrangement::Zip, None).unwrap();
    with_table(
        &sweep,
        &["exact"],
        |_, x| x[1],
        |table| {
            let found = Sensitivity::of_axes(table, &table.columns[0]).unwrap();
            assert_eq!((found.keys.len(), found.keys[0].key.as_str()), (1, "shaper, j"));
            let key = &found.keys[0];
            assert_eq!((key.low.at.written(), key.high.at.written()), ("zvd".into(), "none".into()));
            assert!((key.share - 1.0).abs() < 1e-12 && found.rest < 1e-12);
        },
    );
}

/// An unmeasured metric has no effect, and nothing else is shifted.
#[test]
fn what_was_not_measured_is_left_out() {
    let draws = drawn(2000, 1, Method::Random, NORMAL, &["a", "b"]);
    let sweep = Sweep::new(vec![axis("k", &[0.0, 1.0])], Arrangement::Grid, Some(draws)).unwrap();
    let holes = |x: &[f64]| if x[0] > 0.5 && x[2] > 0.0 { f64::NAN } else { x[0] + 2.0 * x[1] + x[2] };
    let found = of_draws(&sweep, holes);
    assert!((share(&found, "a") - 0.8).abs() < 0.05, "{found:?}");
    let of_few = |count, function: fn(&[f64]) -> f64| {
        let draws = drawn(count, 1, Method::Random, NORMAL, &["a"]);
        let sweep = Sweep::new(vec![], Arrangement::Grid, Some(draws)).unwrap();
        let mut found = None;
        with_table(
            &sweep,
            &[],
            |_, x| function(x),
            |table| found = Some(Sensitivity::of_draws(table, &table.columns[0])),
        );
        found.unwrap()
    };
    assert!(of_few(11, |x| x[0]).is_none() && of_few(12, |x| x[0]).is_some());
    assert!(of_few(50, |_| 1.0).is_none() && of_few(50, |_| f64::NAN).is_none());
    assert!(of_few(50, |x| x[0] * 1e300).is_none(), "beyond all numbers when squared");
}
