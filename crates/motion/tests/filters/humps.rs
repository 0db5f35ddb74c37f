//! MZV, and EI shapers of two and three humps, of damped modes: by the closed form of the residual, computed here.
use crate::random::Random;
use servobench_motion::PlanError;
use servobench_motion::shape::{Impulses, Vibration};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

fn mode(omega_n: f64, zeta: f64) -> Vibration {
    Vibration::new(omega_n, zeta).unwrap()
}

/// `e^(−ζω·t_n)·|Σ A_i·e^((ζω + jω_d)·t_i)|`.
fn residual(shaper: &Impulses, omega_n: f64, zeta: f64) -> f64 {
    let [re, im] = [f64::cos, f64::sin].map(|turn| {
        let part = |(time, amplitude): (f64, f64)| {
            let decay = (zeta * omega_n * (time - shaper.duration())).exp();
            amplitude * decay * turn(omega_n * (1.0 - zeta * zeta).sqrt() * time)
        };
        shaper.iter().map(|impulse| part((impulse.time, impulse.amplitude))).sum::<f64>()
    });
    re.hypot(im)
}

#[test]
fn modified_zero_vibration_is_the_printed_one_and_leaves_nothing() {
    let mut random = Random::seeded(21);
    for _ in 0..1000 {
        let (omega_n, zeta) = (random.between(1.0, 1000.0), random.between(0.0, 0.7));
        let shaper = Impulses::mzv(&mode(omega_n, zeta));
        let root = (1.0 - zeta * zeta).sqrt();
        let (k, period) = ((-0.75 * zeta * PI / root).exp(), 2.0 * PI / (omega_n * root));
        let amplitudes = [1.0 - FRAC_1_SQRT_2, (2_f64.sqrt() - 1.0) * k, (1.0 - FRAC_1_SQRT_2) * k * k];
        let sum: f64 = amplitudes.iter().sum();
        for ((amplitude, time), impulse) in amplitudes.iter().zip([0.0, 0.375, 0.75]).zip(shaper.iter()) {
            assert!((impulse.amplitude - amplitude / sum).abs() < 1e-15);
            assert!((impulse.time - time * period).abs() < 1e-15 * period);
        }
        // Damped too: K is the remaining vibration after 0.375 periods.
        assert!(residual(&shaper, omega_n, zeta) < 1e-15, "ω {omega_n}, ζ {zeta}");
        assert!(residual(&shaper, 1.01 * omega_n, zeta) > 1e-6, "the oracle can fail");
    }
}

/// The shaper with these humps, tolerable residual and damping ratio.
fn shaper(humps: usize, vibration: &Vibration, tolerable: f64) -> Result<Impulses, PlanError> {
    match humps {
        2 => Impulses::two_hump_ei(vibration, tolerable),
        _ => Impulses::three_hump_ei(vibration, tolerable),
    }
}

/// Largest damping ratio for which a shaper is guaranteed for a tolerable residual, by its documentation.
const PROMISED: [(usize, [(f64, f64); 4]); 2] =
    [(2, [(0.05, 0.5), (0.1, 0.3), (0.2, 0.1), (0.3, 0.05)]), (3, [(0.05, 0.3), (0.1, 0.2), (0.2, 0.05), (0.3, 0.02)])];

/// The least value of `of` within `low` and `high`, by golden section.
fn least(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.618_033_988_749_894_9;
    for _ in 0..90 {
        let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
        if of(left) < of(right) { high = right } else { low = left }
    }
    of(f64::midpoint(low, high))
}

/// Residuals at the zeros of the curve, and at the tops of its humps.
fn zeros_and_tops(left: impl Fn(f64) -> f64, tolerable: f64) -> (Vec<f64>, Vec<f64>) {
    let grid: Vec<f64> = (0..=4000).map(|k| 0.2 + 1.8 * f64::from(k) / 4000.0).collect();
    let curve: Vec<f64> = grid.iter().map(|w| left(*w)).collect();
    let (mut zeros, mut tops) = (Vec::new(), Vec::new());
    for k in 1..grid.len() - 1 {
        let (low, high) = (grid[k - 1], grid[k + 1]);
        if curve[k] < curve[k - 1] && curve[k] <= curve[k + 1] {
            zeros.push(least(low, high, &left));
        }
        if curve[k] > curve[k - 1] && curve[k] >= curve[k + 1] && curve[k] < 2.0 * tolerable {
            tops.push(-least(low, high, |w| -left(w)));
        }
    }
    (zeros, tops)
}

/// Random damping ratios and residuals, and the corners of the guaranteed range.
#[test]
fn damped_humps_are_as_high_as_tolerable_and_zero_in_between() {
    let mut random = Random::seeded(22);
    for (humps, promised) in PROMISED {
        for (most_damping, most_tolerable) in promised {
            let corners = [(0.0, 0.001), (0.0, most_tolerable), (most_damping, 0.001), (most_damping, most_tolerable)];
            let within = (0..20).map(|_| (random.between(0.0, most_damping), random.between(0.001, most_tolerable)));
            for (zeta, tolerable) in corners.into_iter().chain(within) {
                let context = format!("{humps} humps, ζ {zeta}, V {tolerable}");
                let shaper = shaper(humps, &mode(1.0, zeta), tolerable).expect(&context);
                let left = |w| residual(&shaper, w, zeta);
                // The mode is at the middle zero, or at the top of the middle hump.
                let at_mode = if humps == 2 { 0.0 } else { tolerable };
                assert!((left(1.0) - at_mode).abs() < 1e-12, "{context}: {:e}", left(1.0));
                let (zeros, tops) = zeros_and_tops(left, tolerable);
                let (zeros, tops) = (&zeros[..=humps.min(zeros.len() - 1)], &tops[..humps.min(tops.len())]);
                assert_eq!((zeros.len(), tops.len()), (humps + 1, humps), "{context}");
                // |V| has a corner at its zero, so the section ends within some ulp of it.
                assert!(zeros.iter().all(|zero| *zero < 1e-12), "{context}: {zeros:?}");
                // Newton leaves 1e-13 of its equations: all humps are as high as requested.
                assert!(tops.iter().all(|top| (top - tolerable).abs() < 1e-12), "{context}: {tops:?}");
                let sum: f64 = shaper.iter().map(|i| i.amplitude).sum();
                assert!((sum - 1.0).abs() < 1e-15 && shaper.iter().all(|i| i.amplitude > 0.0), "{context}");
                assert!(shaper.iter().is_sorted_by(|one, next| one.time < next.time), "{context}");
            }
        }
    }
}

/// The frequency only scales the times.
#[test]
fn humps_are_found_for_any_frequency_where_promised() {
    for (humps, promised) in PROMISED {
        for (most_damping, most_tolerable) in promised {
            for (z, v) in (0..=20).flat_map(|z| (0..=12).map(move |v| (f64::from(z) / 20.0, f64::from(v) / 12.0))) {
                let (zeta, tolerable) = (z * most_damping, 0.001 + v * (most_tolerable - 0.001));
                let of_one = shaper(humps, &mode(1.0, zeta), tolerable).unwrap();
                let of_many = shaper(humps, &mode(250.0, zeta), tolerable).unwrap();
                for (one, other) in of_one.iter().zip(of_many.iter()) {
                    assert!((one.time - 250.0 * other.time).abs() < 1e-14);
                    assert_eq!(one.amplitude.to_bits(), other.amplitude.to_bits());
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let message = |e: PlanError| e.to_string();
    assert_eq!(
        message(Impulses::two_hump_ei(&mode(10.0, 0.0), 0.6).unwrap_err()),
        "`tolerable` must be between 0.001 and 0.5 (below it, take a ZVD shaper), got 0.6"
    );
    assert_eq!(
        message(Impulses::three_hump_ei(&mode(10.0, 0.3), 0.05).unwrap_err()),
        "no extra-insensitive shaper found for `damping_ratio` = 0.3 and `tolerable` = 0.05: lower either, or take a ZVD shaper"
    );
}
