use super::super::step_with_power;
use super::*;
use crate::pmsm::{Input, Output, Power, State};
use proptest::prelude::*;
use servobench_base::{AlphaBeta, ElectricalAngle};

/// Saarakkala/Hinkkanen, 2.2 kW.
const MOTOR: Params =
    Params { electrical_ratio: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };

const HARMONICS: [FluxHarmonic; 2] = [
    FluxHarmonic { order: 6, d: 0.021, q: -0.033, phase: 0.4 },
    FluxHarmonic { order: 12, d: -0.006, q: 0.012, phase: -1.3 },
];
const FACTORS: [f64; 3] = [1.05, 0.93, 1.21];

fn varying<'a>(params: &'a Params, harmonics: &'a [FluxHarmonic], phases: &'a PhaseMatrix) -> Varying<'a> {
    Varying { params, harmonics, phases, series: 0.0 }
}

/// Current at the end, mean torque, copper loss and electrical power of a run at constant speed, from ticks of `end`/`n`.
fn run(motor: &Varying<'_>, omega_e: f64, end: f64, n: u32) -> [f64; 5] {
    let (h, mut x) = (end / f64::from(n), State { current: Dq { d: -1.3, q: 2.4 } });
    let mut means = [0.0; 3];
    for k in 0..n {
        let rotor = ElectricalAngle(0.7 + omega_e * h * f64::from(k)).rotation();
        let output = motor.step(&mut x, &Input { voltage: VOLTAGE, rotor, omega_e }, h);
        for (mean, one) in means.iter_mut().zip([output.torque, output.power.copper, output.power.electrical]) {
            *mean += one / f64::from(n);
        }
    }
    [x.current.d, x.current.q, means[0], means[1], means[2]]
}

const VOLTAGE: AlphaBeta = AlphaBeta { alpha: -60.0, beta: 41.0 };

/// Oracle: the flux linkages in the stator frame, with three phases one by one, by Runge and Kutta's method of order 4; the
/// torque is what the energy leaves: electrical less copper less stored, over the speed.
fn runge_kutta(
    p: &Params,
    harmonics: &[FluxHarmonic],
    factors: [f64; 3],
    omega_e: f64,
    end: f64,
    steps: u32,
) -> [f64; 5] {
    let magnets = |theta: f64| {
        let sum = |of: fn(&FluxHarmonic, f64) -> f64| -> f64 {
            harmonics.iter().map(|one| of(one, f64::from(one.order) * theta + one.phase)).sum()
        };
        let d = p.flux_linkage * (1.0 + sum(|one, x| one.d * x.cos()));
        Dq { d, q: p.flux_linkage * sum(|one, x| one.q * x.sin()) }
    };
    let current = |t: f64, flux: [f64; 2]| {
        let theta = 0.7 + omega_e * t;
        let own = magnets(theta);
        let linked = AlphaBeta { alpha: flux[0], beta: flux[1] }.to_dq(ElectricalAngle(theta).rotation());
        Dq { d: (linked.d - own.d) / p.inductance.d, q: (linked.q - own.q) / p.inductance.q }
    };
    let slope = |t: f64, y: [f64; 4]| {
        let i = current(t, [y[0], y[1]]).to_alpha_beta(ElectricalAngle(0.7 + omega_e * t).rotation());
        let half = 3.0_f64.sqrt() / 2.0 * i.beta;
        let phases = [i.alpha, -i.alpha / 2.0 + half, -i.alpha / 2.0 - half];
        let drops: [f64; 3] = core::array::from_fn(|k| p.resistance * factors[k] * phases[k]);
        let star = (drops[0] + drops[1] + drops[2]) / 3.0;
        let copper: f64 = drops.iter().zip(phases).map(|(u, i)| u * i).sum();
        [
            VOLTAGE.alpha - (drops[0] - star),
            VOLTAGE.beta - (drops[1] - drops[2]) / 3.0_f64.sqrt(),
            copper / end,
            1.5 * (VOLTAGE.alpha * i.alpha + VOLTAGE.beta * i.beta) / end,
        ]
    };
    let begin = Dq { d: -1.3, q: 2.4 };
    let own = magnets(0.7);
    let linked = Dq { d: p.inductance.d * begin.d + own.d, q: p.inductance.q * begin.q + own.q }
        .to_alpha_beta(ElectricalAngle(0.7).rotation());
    let mut y = [linked.alpha, linked.beta, 0.0, 0.0];
    let h = end / f64::from(steps);
    for k in 0..steps {
        let t = f64::from(k) * h;
        let ahead = |by: f64, k: [f64; 4]| core::array::from_fn(|n| y[n] + by * k[n]);
        let k1 = slope(t, y);
        let k2 = slope(t + h / 2.0, ahead(h / 2.0, k1));
        let k3 = slope(t + h / 2.0, ahead(h / 2.0, k2));
        let k4 = slope(t + h, ahead(h, k3));
        y = core::array::from_fn(|n| y[n] + h / 6.0 * (k1[n] + 2.0 * (k2[n] + k3[n]) + k4[n]));
    }
    let i = current(end, [y[0], y[1]]);
    let stored = (p.stored_energy(i) - p.stored_energy(begin)) / end;
    [i.d, i.q, (y[3] - y[2] - stored) * p.electrical_ratio / omega_e, y[2], y[3]]
}

/// Harmonics alone, phases alone, both: the errors of currents, torque, copper and electrical power fall by 16 when the tick is
/// halved.
#[test]
fn a_tick_is_of_fourth_order_at_constant_speed() {
    let (omega_e, end) = (431.0, 9e-3);
    let cases: [(&[FluxHarmonic], [f64; 3]); 3] = [(&HARMONICS, [1.0; 3]), (&[], FACTORS), (&HARMONICS, FACTORS)];
    for (harmonics, factors) in cases {
        let oracle = runge_kutta(&MOTOR, harmonics, factors, omega_e, end, 40_000);
        let phases = PhaseMatrix::of(factors);
        let motor = varying(&MOTOR, harmonics, &phases);
        // Both in one part of a tick: 12·431·9e-3/128 = 0.36 rad.
        let [coarse, fine] = [128, 256].map(|n| run(&motor, omega_e, end, n));
        for (at, name) in ["i_d", "i_q", "torque", "copper", "electrical"].into_iter().enumerate() {
            let [coarse, fine] = [coarse, fine].map(|found| (found[at] - oracle[at]).abs());
            let order = (coarse / fine).log2();
            assert!(fine < 1e-7 * oracle[at].abs().max(1.0), "{name}: off by {fine}");
            // Near 4; a value whose error happens to change its sign may fall faster.
            assert!(order > 3.8, "{name}: observed order {order}, {coarse} {fine}");
        }
    }
}

/// Oracle: the motor without harmonics, which is solved exactly. What a part of a tick leaves out is said in the module's text.
#[test]
fn without_harmonics_it_is_the_motor_that_is_solved_exactly() {
    let round =
        Params { electrical_ratio: 4.0, resistance: 0.36, inductance: Dq { d: 2e-4, q: 2e-4 }, flux_linkage: 6.395e-3 };
    let stiff = Params { inductance: Dq { d: 1e-6, q: 2e-6 }, ..MOTOR };
    for (p, h) in [(MOTOR, 1.0 / 16e3), (round, 1.0 / 8e3), (stiff, 20e-6)] {
        for turn in [0.0, 0.02, -0.14, 0.4, 6.1, -9.0] {
            let rotor = ElectricalAngle(0.7).rotation();
            let omega_e = turn / h;
            let voltage = Dq { d: -7.0, q: 11.0 + omega_e * p.flux_linkage }.to_alpha_beta(rotor);
            let input = Input { voltage, rotor, omega_e };
            let (mut x, mut y) = (State { current: Dq { d: -1.3, q: 2.4 } }, State { current: Dq { d: -1.3, q: 2.4 } });
            let ours = varying(&p, &[], &PhaseMatrix::EQUAL).step(&mut x, &input, h);
            let exact = step_with_power(&p, &mut y, input, h);
            let through = 1.0 / (p.resistance + p.inductance.d / h);
            let scale = 3.0 + (20.0 + (omega_e * p.flux_linkage).abs()) * through;
            let off = (x.current.d - y.current.d).abs().max((x.current.q - y.current.q).abs());
            // (1/4)⁴/720 of a transient for each part of the tick, of which there are 24 at most that it lives through.
            assert!(off < 2e-5 * scale, "{p:?} {turn}: off by {off} of {scale}");
            let most = 1.5 * p.electrical_ratio * (p.flux_linkage + (p.inductance.q - p.inductance.d) * scale) * scale;
            // A product of two currents that each change by a quarter in a part.
            assert!((ours.torque - exact.torque).abs() < 2e-5 * most, "{turn}: {} {}", ours.torque, exact.torque);
        }
    }
}

proptest! {
    /// Oracle: the first law, whatever is unequal, however fast, however long the tick.
    #[test]
    fn no_power_is_lost(
        resistance in 1e-3..50.0_f64,
        (d, q) in (5e-5..5e-2_f64, 0.3..3.0_f64),
        (flux_linkage, share) in (1e-3..1.0_f64, -0.2..0.2_f64),
        order in 1..48_u32,
        turn in -2.5..2.5_f64,
        (i_d, i_q, u_d, u_q) in (-20.0..20.0_f64, -20.0..20.0_f64, -50.0..50.0_f64, -50.0..50.0_f64),
        factors in [0.5..2.0_f64, 0.5..2.0_f64, 0.5..2.0_f64],
    ) {
        let h = 1.0 / 12_000.0;
        let p = Params { electrical_ratio: 5.0, resistance, inductance: Dq { d, q: d * q }, flux_linkage };
        let harmonics = [FluxHarmonic { order, d: share, q: 0.3 - share, phase: share * 9.0 }];
        let rotor = ElectricalAngle(-1.1).rotation();
        let voltage = Dq { d: u_d, q: u_q + turn / h * flux_linkage }.to_alpha_beta(rotor);
        let (mut x, input) = (State { current: Dq { d: i_d, q: i_q } }, Input { voltage, rotor, omega_e: turn / h });
        let phases = PhaseMatrix::of(factors);
        let Power { electrical, copper, stored, air_gap, .. } = varying(&p, &harmonics, &phases).step(&mut x, &input, h).power;
        let largest = [electrical, copper, stored, air_gap].into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        prop_assert!((electrical - copper - stored - air_gap).abs() < 1e-12 * largest,
            "{electrical} {copper} {stored} {air_gap}");
        prop_assert!(copper >= 0.0);
    }
}

/// Oracle: currents of a round motor at constant speed on phases that differ, as phasors of positive and negative sequence. With
/// i = P·e^{jωt} + N·e^{−jωt} and R·i = R·(m·i + ρ·i*), ρ = δ + jε:
///
/// ```text
/// (R·m + jωL)·P + R·ρ·N* = U − jωψ          (R·m + jωL)·N* + R·ρ*·P = 0
/// ```
#[test]
fn unequal_phases_make_the_negative_sequence_of_the_phasors() {
    let p = Params { inductance: Dq { d: 21e-3, q: 21e-3 }, ..MOTOR };
    let (omega, u) = (233.0, Dq { d: -6.0, q: 147.0 });
    let phases = PhaseMatrix::of(FACTORS);
    // A voltage that turns with the rotor, at ticks of 0.002 rad: held over each its length is off by 2e-7.
    let h = 0.002 / omega;
    let mut x = State::default();
    // 0.15 s.
    let steps = 17_475;
    for k in 0..steps {
        let theta = ElectricalAngle(omega * h * f64::from(k));
        let voltage = u.to_alpha_beta(theta.ahead(omega * h / 2.0).rotation());
        varying(&p, &[], &phases).step(&mut x, &Input { voltage, rotor: theta.rotation(), omega_e: omega }, h);
    }
    let (r, mean) = (p.resistance, FACTORS.iter().sum::<f64>() / 3.0);
    let rho = [(2.0 * FACTORS[0] - FACTORS[1] - FACTORS[2]) / 6.0, (FACTORS[2] - FACTORS[1]) / 12.0_f64.sqrt()];
    let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let over = |a: [f64; 2], b: [f64; 2]| times(a, [b[0], -b[1]]).map(|part| part / (b[0] * b[0] + b[1] * b[1]));
    let z = [r * mean, omega * p.inductance.d];
    // N* = −R·ρ*·P/Z, so P = V/(Z − R²·|ρ|²/Z).
    let back = over([r * r * (rho[0] * rho[0] + rho[1] * rho[1]), 0.0], z);
    let positive = over([u.d, u.q - omega * p.flux_linkage], [z[0] - back[0], z[1] - back[1]]);
    let negative_conjugate = over(times([-r * rho[0], r * rho[1]], positive), z);
    // In the rotor frame: P + N·e^{−2jθ}.
    let theta = omega * h * f64::from(steps);
    let turned = times([negative_conjugate[0], -negative_conjugate[1]], [(2.0 * theta).cos(), -(2.0 * theta).sin()]);
    let expected = [positive[0] + turned[0], positive[1] + turned[1]];
    let size = positive[0].hypot(positive[1]);
    let off = (x.current.d - expected[0]).hypot(x.current.q - expected[1]);
    // 25 time constants: e⁻²⁵ of the transient; the length of the voltage, 1.7e-7 of 147 V through 6 Ω, of 4 A: 1e-6.
    assert!(off < 5e-6 * size, "{:?} {expected:?}", x.current);
    assert!(negative_conjugate[0].hypot(negative_conjugate[1]) > 0.02 * size, "there is something to test");
}

/// Under constant acceleration, with the mean speed of each tick, against a finer tick: second order, as without harmonics.
#[test]
fn a_tick_in_which_the_speed_changes_is_of_second_order() {
    let (omega, acceleration) = (300.0, 4e5);
    let end = |n: u32| {
        let (h, mut x) = (2e-3 / f64::from(n), State::default());
        for k in 0..n {
            let t = f64::from(k) * h;
            let rotor = ElectricalAngle(omega * t + acceleration * t * t / 2.0).rotation();
            let input = Input { voltage: VOLTAGE, rotor, omega_e: omega + acceleration * (t + h / 2.0) };
            varying(&MOTOR, &HARMONICS, &PhaseMatrix::of(FACTORS)).step(&mut x, &input, h);
        }
        x.current.q
    };
    let exact = end(4096);
    let order = ((end(32) - exact) / (end(64) - exact)).log2();
    assert!((order - 2.0).abs() < 0.15, "observed order {order}");
}

/// Nothing on a motor at rest is exact zeros; a speed that is no number gives none.
#[test]
fn nothing_in_is_nothing_out() {
    let phases = PhaseMatrix::of(FACTORS);
    let motor = varying(&MOTOR, &HARMONICS, &phases);
    let rest = Input { voltage: AlphaBeta::default(), rotor: Rotation::default(), omega_e: 0.0 };
    let mut x = State::default();
    assert_eq!((motor.step(&mut x, &rest, 1e-4), x), (Output::default(), State::default()));
    for omega_e in [f64::NAN, f64::INFINITY] {
        let mut x = State::default();
        let output = motor.step(&mut x, &Input { omega_e, ..rest }, 1e-4);
        assert!(output.torque.is_nan() && x.current.d.is_nan(), "{omega_e}");
    }
}
