//! Tests of the observer.
use super::*;
use servobench_testkit::Random;

const J: f64 = 2.3e-3;

/// A motor of inertia `J`, advanced by cycles: exact under a constant effort.
#[derive(Clone, Copy, Default)]
struct Motor {
    position: f64,
    velocity: f64,
}

impl Motor {
    fn advance(&mut self, effort: f64, h: f64) -> f64 {
        let travelled = h * (self.velocity + h / 2.0 * effort / J);
        self.position += travelled;
        self.velocity += h * effort / J;
        travelled
    }
}

fn observer(omega: f64, h: f64, inertia: f64) -> Params {
    Params::new(omega, h, inertia, 0.0).unwrap()
}

/// Oracle: the error of the velocity has the poles z, z, z: its samples satisfy e(k+3) − 3z·e(k+2) + 3z²·e(k+1) − z³·e(k) = 0 under
/// any effort, from any initial error.
#[test]
fn all_poles_of_the_error_are_at_the_bandwidth() {
    for (omega, h) in [(613.0, 125e-6), (97.3, 1e-3), (4_100.0, 71.3e-6)] {
        let (p, z) = (observer(omega, h, J), (-omega * h).exp());
        let mut motor = Motor { position: 0.0, velocity: 7.1 };
        let mut x = State { behind: 1.3e-3, velocity: 2.2, disturbance: -0.03 };
        let mut errors = Vec::new();
        for k in 0..200 {
            let effort = 0.4 * (0.37 * f64::from(k)).sin();
            let travelled = motor.advance(effort, h);
            errors.push(motor.velocity - step(&p, &mut x, travelled, effort));
        }
        for e in errors.windows(4) {
            let left = e[3] - 3.0 * z * e[2] + 3.0 * z * z * e[1] - z.powi(3) * e[0];
            // Velocities of some 7 rad/s, a few roundings of travels over h.
            assert!(left.abs() < 1e-13, "{omega}: {left}");
        }
        // The remaining initial error is z^200 times the square of 200.
        let left = 200.0_f64.powi(2) * z.powi(200) * 5.0;
        assert!(errors[199].abs() <= left + 1e-12, "{omega}: {} {left}", errors[199]);
    }
}

/// Oracle: ω = ω_0 + a·t: no lag at constant acceleration and a constant load, which is observed as well.
#[test]
fn a_ramp_is_followed_without_lag_and_a_load_is_found() {
    let h = 125e-6;
    let p = observer(700.0, h, J);
    let (mut motor, mut x) = (Motor::default(), State::default());
    let load = -0.37;
    for k in 0..2_000 {
        let effort = 0.9;
        let travelled = motor.advance(effort + load, h);
        let velocity = step(&p, &mut x, travelled, effort);
        if k > 600 {
            assert!((velocity - motor.velocity).abs() < 1e-10, "{k}: {velocity}");
            assert!((x.disturbance - load).abs() < 1e-9, "{k}: {x:?}");
        }
    }
}

/// Oracle: by hand. With an effort that grows by Δτ per cycle, D grows by ΔD = (Ĵ/J − 1)·Δτ, and in the steady state r = ΔD/l_3 and
/// ω − ω̂ = (l_1 − T·l_2/2)·r/T; for small ω_o·T the result is 3·Ḋ/(Ĵ·ω_o²).
#[test]
fn a_wrong_inertia_costs_an_error_at_constant_jerk() {
    let h = 125e-6;
    for (share, omega) in [(0.7, 311.0), (1.43, 311.0), (2.0, 1_207.0)] {
        let (p, growth) = (observer(omega, h, share * J), 1.7e-4);
        let (mut motor, mut x, mut last) = (Motor::default(), State::default(), 0.0);
        for k in 0..3_000 {
            let effort = growth * f64::from(k);
            let travelled = motor.advance(effort, h);
            last = motor.velocity - step(&p, &mut x, travelled, effort);
        }
        let rise = (share - 1.0) * growth;
        let [l_1, l_2, l_3] = p.gains;
        let exact = (l_1 - h * l_2 / 2.0) * rise / l_3 / h;
        assert!((last / exact - 1.0).abs() < 1e-6, "{share}: {last} {exact}");
        let continuous = 3.0 * rise / h / (share * J * omega * omega);
        assert!((exact / continuous - 1.0).abs() < omega * h, "{share}: {exact} {continuous}");
    }
}

/// Oracle: white noise σ of the position appears in ω̂ with (1 − z)³·(13 + 50z + 49z²)/(2·(1 + z)⁵)·σ²/T², and in a difference with
/// 2·σ²/T²: both as the sum of squares of the response to one wrong reading, and by random noise.
#[test]
fn noise_of_the_position_is_reduced_as_the_closed_form_says() {
    let variance = |z: f64| (1.0 - z).powi(3) * (13.0 + 50.0 * z + 49.0 * z * z) / (2.0 * (1.0 + z).powi(5));
    for (omega, h) in [(613.0, 125e-6), (2_011.0, 125e-6), (97.3, 1.13e-3)] {
        let (p, z) = (observer(omega, h, J), (-omega * h).exp());
        let mut x = State::default();
        let mut squares = 0.0;
        for k in 0..20_000 {
            // A single reading that is 1 too large is a travel of 1 and then of −1.
            let travelled = [1.0, -1.0].get(k).copied().unwrap_or(0.0);
            squares += step(&p, &mut x, travelled, 0.0).powi(2);
        }
        let exact = variance(z) / (h * h);
        assert!((squares / exact - 1.0).abs() < 1e-9, "{omega}: {squares} {exact}");

        let (mut x, mut random, mut last, mut sum, mut of_differences) =
            (State::default(), Random::seeded(7), 0.0, 0.0, 0.0);
        let many = 400_000;
        for _ in 0..many {
            // Uniform noise: the variance is 1/12.
            let noise = random.unit() - 0.5;
            let velocity = step(&p, &mut x, noise - last, 0.0);
            of_differences += ((noise - last) / h).powi(2) / f64::from(many);
            sum += velocity * velocity / f64::from(many);
            last = noise;
        }
        let reduction = sum / of_differences;
        // One in some 1/(ω·h) cycles is independent: 3 % in the slowest case is four standard deviations.
        assert!((reduction / (variance(z) / 2.0) - 1.0).abs() < 0.03, "{omega}: {reduction}");
    }
}

/// Errors name the parameter out of its bound.
#[test]
fn errors_name_the_parameter() {
    let said = |omega, inertia, compensation| Params::new(omega, 1e-3, inertia, compensation).unwrap_err().to_string();
    assert_eq!(said(0.0, J, 0.0), "`bandwidth of the observer` must be finite and positive, got 0");
    assert!(said(300.0, 0.0, 0.0).contains("whose inertia is known"));
    assert!(said(300.0, J, 1.2).starts_with("`compensation of the disturbance` must be"));
}
