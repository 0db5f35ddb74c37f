use super::super::tests::runs::{Equations, Run, assert_second_order_under_acceleration, assert_solved_exactly};
use super::super::{FluxMap, Saturation};
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

/// Harmonics alone, phases alone, both: the errors of currents, torque, copper and electrical power fall by 16 when the tick is
/// halved.
#[test]
fn a_tick_is_of_fourth_order_at_constant_speed() {
    // Constant inductances are a curve that is straight.
    let straight = Saturation { current: 20.0, share: 1.0, residual: 0.1 };
    let map = FluxMap::curve(&straight, MOTOR.flux_linkage, MOTOR.inductance).unwrap();
    // Both in one part of a tick: 12·431·9e-3/128 = 0.36 rad.
    let (voltage, begin) = (AlphaBeta { alpha: -60.0, beta: 41.0 }, Dq { d: -1.3, q: 2.4 });
    let of = Run { voltage, begin, omega: 431.0, end: 9e-3 };
    let cases: [(&[FluxHarmonic], [f64; 3]); 3] = [(&HARMONICS, [1.0; 3]), (&[], FACTORS), (&HARMONICS, FACTORS)];
    for (harmonics, factors) in cases {
        let equations = Equations { params: &MOTOR, map: &map, magnets: MOTOR.flux_linkage, harmonics, factors };
        let phases = PhaseMatrix::of(factors);
        equations.assert_fourth_order(&varying(&MOTOR, harmonics, &phases), &of, 1e-7, 3.8);
    }
}

/// Oracle: the motor without harmonics, which is solved exactly. The error of a part of a tick is in the module's text.
#[test]
fn without_harmonics_it_is_the_motor_that_is_solved_exactly() {
    let round =
        Params { electrical_ratio: 4.0, resistance: 0.36, inductance: Dq { d: 2e-4, q: 2e-4 }, flux_linkage: 6.395e-3 };
    let stiff = Params { inductance: Dq { d: 1e-6, q: 2e-6 }, ..MOTOR };
    for (p, h) in [(MOTOR, 1.0 / 16e3), (round, 1.0 / 8e3), (stiff, 20e-6)] {
        for turn in [0.0, 0.02, -0.14, 0.4, 6.1, -9.0] {
            assert_solved_exactly(&varying(&p, &[], &PhaseMatrix::EQUAL), &p, h, turn);
        }
    }
}

proptest! {
    /// Oracle: the first law, for any inequality, speed and length of the tick.
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

#[test]
fn a_tick_in_which_the_speed_changes_is_of_second_order() {
    let phases = PhaseMatrix::of(FACTORS);
    assert_second_order_under_acceleration(&varying(&MOTOR, &HARMONICS, &phases));
}

/// Zero inputs leave a motor at rest at exact zeros; a not-a-number speed gives none.
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
