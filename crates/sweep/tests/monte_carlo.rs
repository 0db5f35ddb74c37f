//! A linear case with a known distribution: mean, deviation, quantiles and their intervals, from the draws of a sweep.
use servobench_sweep::{Arrangement, Axis, Distribution, Drawn, Draws, Method, Proportion, Sample, Sweep, Value};

const COUNT: u32 = 10_000;

/// The varied keys: a normal mass, a uniform stiffness, and an axis that shifts everything.
fn sweep(seed: u64, method: Method) -> Sweep {
    let of = |key: &str, distribution| Drawn { key: key.into(), unit: String::new(), distribution };
    let keys = vec![
        of("mass", Distribution::Normal { mean: 5.0, sigma: 0.2 }),
        of("stiffness", Distribution::Uniform { low: -1.0, high: 1.0 }),
    ];
    let axis = Axis { key: "offset".into(), values: [10.0, 20.0].map(|x| Value::Number(x, String::new())).to_vec() };
    Sweep::new(vec![axis], Arrangement::Grid, Some(Draws::new(COUNT, seed, method, keys).unwrap())).unwrap()
}

/// offset + 3·mass + 2·stiffness, for the draws of combination `combination`.
fn values(sweep: &Sweep, combination: usize) -> Sample {
    let points = combination * COUNT as usize..(combination + 1) * COUNT as usize;
    let number = |index: usize| -> [f64; 3] {
        let point = sweep.point(index);
        [0, 1, 2].map(|key: usize| point[key].value.number().unwrap())
    };
    Sample::of(points.map(number).map(|[offset, mass, stiffness]| offset + 3.0 * mass + 2.0 * stiffness)).unwrap()
}

/// The distribution of 3·mass + 2·stiffness about 15: a normal number with σ = 0.6 and one between −2 and 2.
///
/// ```text
/// P(y < x) = ∫ Φ((x − u)/σ) du / 4 over u from −2 to 2 = σ (G((x + 2)/σ) − G((x − 2)/σ)) / 4,   G(z) = z Φ(z) + φ(z)
/// ```
fn below(x: f64) -> f64 {
    let sigma = 0.6;
    let integral = |z: f64| z * below_normal(z) + (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
    sigma * (integral((x + 2.0) / sigma) - integral((x - 2.0) / sigma)) / 4.0
}

fn below_normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

fn density(x: f64) -> f64 {
    (below_normal((x + 2.0) / 0.6) - below_normal((x - 2.0) / 0.6)) / 4.0
}

/// Inverse of `below`.
fn quantile(share: f64) -> f64 {
    let (mut low, mut high) = (-10.0, 10.0);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        if below(middle) < share { low = middle } else { high = middle }
    }
    low
}

const SHARES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];

/// Acceptance: mean and quantiles within three standard errors, σ/√n for the mean and √(p(1 − p)/n)/density for a quantile. With a
/// Latin hypercube they are smaller.
#[test]
fn mean_and_quantiles_are_those_of_the_distribution() {
    // Variance of the normal part, and (4)²/12 of the uniform one.
    let (n, deviation) = (f64::from(COUNT), (0.36 + 16.0 / 12.0_f64).sqrt());
    for method in [Method::Random, Method::LatinHypercube] {
        let sweep = sweep(1, method);
        for (combination, middle) in [(0, 25.0), (1, 35.0)] {
            let found = values(&sweep, combination);
            assert_eq!(found.count(), COUNT as usize);
            let error = deviation / n.sqrt();
            assert!((found.mean() - middle).abs() < 3.0 * error, "{method:?}: {} ± {error}", found.mean());
            // The error of a deviation is below σ/√(2n), since the uniform part has shorter tails than a normal one.
            assert!(
                (found.deviation() - deviation).abs() < 3.0 * error / 2_f64.sqrt(),
                "{method:?}: {}",
                found.deviation()
            );
            assert!((found.standard_error() / error - 1.0).abs() < 0.03);
            for share in SHARES {
                let expected = quantile(share);
                let error = (share * (1.0 - share) / n).sqrt() / density(expected);
                let quantile = found.quantile(share) - middle;
                assert!(
                    (quantile - expected).abs() < 3.0 * error,
                    "{method:?} {share}: {quantile} ± {error}, not {expected}"
                );
            }
        }
    }
}

/// Coverage of the true quantile by an interval, and of the true share by a bound, in 400 repetitions: at least as promised, minus three
/// standard errors of that count, √(0.95·0.05/400) = 1.1 %. Not always either: too wide an interval is of no use.
#[test]
fn intervals_have_the_truth_as_often_as_they_say() {
    const REPETITIONS: u64 = 400;
    let limit = quantile(0.9);
    let (mut inside, mut kept) = ([0_u32; SHARES.len()], 0_u32);
    for seed in 0..REPETITIONS {
        let found = values(&sweep(seed, Method::Random), 0);
        for (count, share) in inside.iter_mut().zip(SHARES) {
            let [Some(low), Some(high)] = found.interval(share, 0.95) else { panic!("{share}") };
            *count += u32::from((low..=high).contains(&(25.0 + quantile(share))));
        }
        let good = found.sorted().partition_point(|x| *x < 25.0 + limit) as u64;
        kept += u32::from(Proportion::new(good, u64::from(COUNT) - good).at_least(0.95) <= 0.9);
    }
    for (count, what) in inside.iter().zip(SHARES.map(|share| share.to_string())).chain([(&kept, "share".into())]) {
        let rate = f64::from(*count) / REPETITIONS as f64;
        assert!(rate > 0.95 - 0.033 && rate < 0.95 + 0.033, "{what}: {rate}");
    }
}
