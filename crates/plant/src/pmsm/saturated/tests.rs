use super::super::flux_map::tests::published;
use super::super::tests::runs::{Equations, NAMES, Run, assert_second_order_under_acceleration, assert_solved_exactly};
use super::super::{Power, Saturation};
use super::*;
use crate::pmsm::{Input, State};
use proptest::prelude::*;
use servobench_base::{AlphaBeta, ElectricalAngle};

/// The motor of [`published`], with the inductances by which its example controls it.
const RELUCTANCE: Params =
    Params { electrical_ratio: 2.0, resistance: 0.63, inductance: Dq { d: 18e-3, q: 110e-3 }, flux_linkage: 0.477 };
const SERVO: Params = Params {
    electrical_ratio: 4.0,
    resistance: 1.615,
    inductance: Dq { d: 3.485e-3, q: 4.1e-3 },
    flux_linkage: 0.0606,
};
const HARMONICS: [FluxHarmonic; 1] = [FluxHarmonic { order: 6, d: 0.021, q: -0.033, phase: 0.4 }];
const FACTORS: [f64; 3] = [1.05, 0.93, 1.21];
const EQUAL: PhaseMatrix = PhaseMatrix::EQUAL;

fn curve(p: &Params, current: f64, share: f64) -> FluxMap {
    FluxMap::curve(&Saturation { current, share, residual: 0.1 }, p.flux_linkage, p.inductance).unwrap()
}

fn plain<'a>(params: &'a Params, map: &'a FluxMap) -> Saturated<'a> {
    Saturated { params, map, magnets: params.flux_linkage, harmonics: &[], phases: &EQUAL, series: 0.0 }
}

/// A curve, alone and with harmonics and unequal phases and warm magnets: the errors fall by 16 when the tick is halved.
#[test]
fn a_tick_is_of_fourth_order_at_constant_speed() {
    let map = curve(&SERVO, 20.0, 0.7);
    let of =
        Run { voltage: AlphaBeta { alpha: -60.0, beta: 41.0 }, begin: Dq { d: -3.0, q: 9.0 }, omega: 431.0, end: 4e-3 };
    let phases = PhaseMatrix::of(FACTORS);
    let warm = Params { flux_linkage: 0.93 * SERVO.flux_linkage, ..SERVO };
    let all =
        Saturated { params: &warm, map: &map, magnets: 0.0606, harmonics: &HARMONICS, phases: &phases, series: 0.0 };
    let equations = |params| Equations { params, map: &map, magnets: 0.0606, harmonics: &[], factors: [1.0; 3] };
    equations(&SERVO).assert_fourth_order(&plain(&SERVO, &map), &of, 1e-6, 3.7);
    let real = Equations { harmonics: &HARMONICS, factors: FACTORS, ..equations(&warm) };
    real.assert_fourth_order(&all, &of, 1e-6, 3.7);
}

/// The published motor by its table, across whose lines the inductances jump: of second order at least, and with small errors.
#[test]
fn a_table_is_followed_over_its_lines() {
    let map = published(14, 12);
    let of = Run {
        voltage: AlphaBeta { alpha: -110.0, beta: 71.0 },
        begin: Dq { d: -3.0, q: 5.0 },
        omega: 220.0,
        end: 4e-3,
    };
    let motor = plain(&RELUCTANCE, &map);
    let magnets = RELUCTANCE.flux_linkage;
    let equations = Equations { params: &RELUCTANCE, map: &map, magnets, harmonics: &[], factors: [1.0; 3] };
    let oracle = equations.solve(&of, 80_000);
    // 4, 8 and 16 kHz.
    let errors = [16, 32, 64].map(|n| {
        let found = of.in_ticks(&motor, n);
        let off: [f64; 5] = core::array::from_fn(|at| (found[at] - oracle[at]).abs());
        off
    });
    println!("{oracle:?}\n{errors:?}");
    for (at, name) in NAMES.into_iter().enumerate() {
        // Relative to 20 A, and to the 20 N·m that two of them make with 0.9 V·s.
        assert!(
            errors[2][at] < 1e-6 * oracle[at].abs().max(20.0),
            "{name}: off by {} of {}",
            errors[2][at],
            oracle[at]
        );
        assert!(errors[2][at] < errors[0][at] / 4.0, "{name}: {errors:?}");
    }
}

/// Oracle: the motor that is solved exactly, at constant inductances, by a curve and by a table.
#[test]
fn without_saturation_it_is_the_motor_that_is_solved_exactly() {
    let linear = |p: &Params| {
        let (l, psi) = (p.inductance, p.flux_linkage);
        let flux = |i: Dq| Dq { d: psi + l.d * i.d, q: l.q * i.q };
        let data = super::super::flux_map::tests::sampled(vec![-30.0, 0.0, 10.0], vec![0.0, 9.0, 20.0], flux);
        FluxMap::table(&data).unwrap()
    };
    let stiff = Params { inductance: Dq { d: 1e-6, q: 2e-6 }, ..SERVO };
    for (p, h) in [(SERVO, 1.0 / 16e3), (RELUCTANCE, 1.0 / 8e3), (stiff, 20e-6)] {
        for (map, turn) in
            [(curve(&p, 20.0, 1.0), 0.02), (linear(&p), -0.14), (linear(&p), 0.4), (linear(&p), 6.1), (linear(&p), 0.0)]
        {
            assert_solved_exactly(&plain(&p, &map), &p, h, turn);
        }
    }
}

/// Oracle: the same in hundredths of a tick. The error of one tick of 16 kHz, relative to the larger of the current and the rated one, in
/// currents up to twice the rated ones and with all the voltage of links of 540 and 320 V: 7e-8 RMS, 6e-7 at most. The bounds are twice
/// that; an engineer sees 1e-5.
#[test]
fn what_a_tick_leaves_out_is_below_what_an_engineer_sees() {
    let h = 1.0 / 16e3;
    let (table, curve) = (published(14, 12), curve(&SERVO, 20.0, 0.7));
    for (p, map, rated, most) in [(RELUCTANCE, &table, 12.4, 311.0), (SERVO, &curve, 10.0, 184.0)] {
        let (motor, mut worst, mut sum) = (plain(&p, map), 0.0_f64, 0.0);
        for n in 0..400 {
            let at = |step: f64| 2.0 * (f64::from(n) * step).fract() - 1.0;
            let begin = Dq { d: -rated + 0.9 * rated * at(0.618), q: 1.7 * rated * at(0.7549) };
            let omega = 900.0 * at(0.3819);
            let (sin, cos) = (3.2 * at(0.5698)).sin_cos();
            let voltage = AlphaBeta { alpha: most * cos, beta: most * sin };
            let rotor = ElectricalAngle(0.7).rotation();
            let over = Span { voltage, drop: AlphaBeta::default(), rotor, omega, time: h };
            let found = motor.advance::<true>(begin, &over, &mut Sums::default());
            let fine = (0..100).fold(begin, |i, k| {
                let over = Span { rotor: rotor.ahead(omega * h * f64::from(k) / 100.0), time: h / 100.0, ..over };
                motor.advance::<true>(i, &over, &mut Sums::default())
            });
            let error = (found.d - fine.d).hypot(found.q - fine.q) / fine.magnitude().max(rated);
            worst = worst.max(error);
            sum += error * error;
        }
        let mean = (sum / 400.0_f64).sqrt();
        println!("of a tick: {mean:e} RMS, {worst:e} at most");
        assert!(worst < 1e-6 && mean < 2e-7, "{mean} {worst}");
    }
}

proptest! {
    /// Oracle: the first law, for any saturation, speed and duration; in series, too, where the series resistance takes its
    /// part.
    #[test]
    fn no_power_is_lost(
        resistance in 0.05..20.0_f64,
        (share, residual) in (0.45..1.0_f64, 0.05..0.5_f64),
        (order, harmonic) in (1..24_u32, -0.2..0.2_f64),
        turn in -2.5..2.5_f64,
        (i_d, i_q, u_d, u_q) in (-30.0..30.0_f64, -30.0..30.0_f64, -300.0..300.0_f64, -300.0..300.0_f64),
        factors in [0.5..2.0_f64, 0.5..2.0_f64, 0.5..2.0_f64],
        (warm, series) in (0.7..1.2_f64, 0.0..3.0_f64),
        is_a_table in any::<bool>(),
        logarithm in -7.0..-3.5_f64,
    ) {
        static MAP: std::sync::OnceLock<FluxMap> = std::sync::OnceLock::new();
        let h = 10.0_f64.powf(logarithm);
        let cold = if is_a_table { RELUCTANCE } else { SERVO };
        let p = Params { resistance, flux_linkage: warm * cold.flux_linkage, ..cold };
        let saturation = Saturation { current: 20.0, share, residual };
        let curve = FluxMap::curve(&saturation, cold.flux_linkage, cold.inductance);
        prop_assume!(curve.is_ok());
        let curve = curve.unwrap();
        let map = if is_a_table { MAP.get_or_init(|| published(9, 7)) } else { &curve };
        let harmonics = [FluxHarmonic { order, d: harmonic, q: 0.3 - harmonic, phase: harmonic * 9.0 }];
        let phases = PhaseMatrix::of(factors);
        let motor = Saturated { params: &p, map, magnets: cold.flux_linkage, harmonics: &harmonics, phases: &phases, series };
        let rotor = ElectricalAngle(-1.1).rotation();
        let omega = turn / h.max(1e-4);
        let voltage = Dq { d: u_d, q: u_q + omega * p.flux_linkage }.to_alpha_beta(rotor);
        let (before, mut sums) = (Dq { d: i_d, q: i_q }, Sums::default());
        let over = Span { voltage, drop: AlphaBeta::default(), rotor, omega, time: h };
        let after = motor.advance::<true>(before, &over, &mut sums);
        let Power { electrical, copper, stored, air_gap, .. } =
            sums.output(motor.stored(before, after), p.electrical_ratio, omega, h).power;
        let in_series = 1.5 * series * sums.square / h;
        let terms = [electrical, copper, in_series, stored, air_gap];
        let largest = terms.into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        // The stored energy is the difference of two currents, which have a rounding each.
        let rounding = 4e-16 * 1.5 * map.flux(before).magnitude().max(map.flux(after).magnitude())
            * before.magnitude().max(after.magnitude()) / h;
        prop_assert!((electrical - copper - in_series - stored - air_gap).abs() < 1e-12 * largest + rounding,
            "{terms:?}, {} of {largest}, {rounding}", electrical - copper - in_series - stored - air_gap);
        prop_assert!(copper >= 0.0);
    }
}

/// Oracle: a motor whose own resistance is the sum.
#[test]
fn what_is_in_series_adds_to_the_resistance() {
    let map = curve(&SERVO, 20.0, 0.7);
    let more = Params { resistance: SERVO.resistance + 0.25, ..SERVO };
    let over = Span {
        voltage: AlphaBeta { alpha: 31.0, beta: -12.0 },
        drop: AlphaBeta::default(),
        rotor: ElectricalAngle(0.7).rotation(),
        omega: 310.0,
        time: 41e-6,
    };
    let i = Dq { d: -3.0, q: 8.0 };
    let (mut first, mut second) = (Sums::default(), Sums::default());
    let after = Saturated { series: 0.25, ..plain(&SERVO, &map) }.advance::<true>(i, &over, &mut first);
    let expected = plain(&more, &map).advance::<true>(i, &over, &mut second);
    assert!((after.d - expected.d).abs() + (after.q - expected.q).abs() < 1e-14 * 20.0);
    assert!((first.copper / second.copper - 1.615 / 1.865).abs() < 1e-12);
}

#[test]
fn a_tick_in_which_the_speed_changes_is_of_second_order() {
    assert_second_order_under_acceleration(&plain(&SERVO, &curve(&SERVO, 20.0, 0.7)));
}

/// Zero time changes nothing; zero inputs leave a motor at rest at zero; a not-a-number speed, voltage or current gives none and
/// terminates.
#[test]
fn nothing_in_is_nothing_out() {
    let map = published(9, 7);
    let motor = plain(&RELUCTANCE, &map);
    let rest = Span {
        voltage: AlphaBeta::default(),
        drop: AlphaBeta::default(),
        rotor: Rotation::default(),
        omega: 0.0,
        time: 1e-4,
    };
    let mut sums = Sums::default();
    let after = motor.advance::<true>(Dq::default(), &rest, &mut sums);
    // The table is straight to the rounding only.
    assert!(after.magnitude() < 1e-15 && sums.work == 0.0, "{after:?} {sums:?}");
    let i = Dq { d: -2.0, q: 3.0 };
    let mut sums = Sums::default();
    let none = Span { time: 0.0, omega: 300.0, voltage: AlphaBeta { alpha: 100.0, beta: 3.0 }, ..rest };
    assert_eq!((motor.advance::<true>(i, &none, &mut sums), sums), (i, Sums::default()));
    for over in [
        Span { omega: f64::NAN, ..rest },
        Span { omega: f64::INFINITY, ..rest },
        Span { voltage: AlphaBeta { alpha: f64::NAN, beta: 0.0 }, ..rest },
        Span { voltage: AlphaBeta { alpha: f64::INFINITY, beta: 0.0 }, ..rest },
    ] {
        let mut sums = Sums::default();
        let after = motor.advance::<true>(i, &over, &mut sums);
        assert!(after.d.is_nan() && sums.torque.is_nan(), "{over:?}: {after:?} {sums:?}");
    }
    let after = motor.advance::<true>(Dq { d: f64::NAN, q: 0.0 }, &rest, &mut Sums::default());
    assert!(after.d.is_nan());
    // An extremely large voltage still gives finite numbers.
    let huge = Span { voltage: AlphaBeta { alpha: 1e9, beta: -1e8 }, omega: 300.0, ..rest };
    let after = motor.advance::<true>(i, &huge, &mut Sums::default());
    assert!(after.d.is_finite() && after.q.is_finite(), "{after:?}");
}

/// An undriven current falls to the rounding of the magnets' flux linkage, through all values between, and stays there: two
/// hundred motors by a figure and by a table, at rest and with initial currents from a thousandth to a billionth of an ampere.
#[test]
fn a_motor_that_nothing_drives_comes_to_rest() {
    let table = published(14, 12);
    let mut random = {
        let mut state = 39_u64;
        move |from: f64, to: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            from + (to - from) * (state >> 11) as f64 / 9_007_199_254_740_992.0
        }
    };
    for n in 0..200 {
        let along = 10_f64.powf(random(-4.0, -1.5));
        let inductance = Dq { d: along, q: random(0.3, 3.0) * along };
        let flux_linkage = 10_f64.powf(random(-3.0, 0.0));
        let current = flux_linkage / inductance.d * random(0.2, 2.0);
        let saturation = Saturation { current, share: random(0.75, 1.0), residual: random(0.05, 0.5) };
        let Ok(curve) = FluxMap::curve(&saturation, flux_linkage, inductance) else { continue };
        let is_a_table = n % 5 == 0;
        let (map, p) = if is_a_table {
            (&table, Params { resistance: 60.0, ..RELUCTANCE })
        } else {
            (&curve, Params { resistance: inductance.d / random(1e-4, 5e-3), inductance, flux_linkage, ..SERVO })
        };
        let motor = plain(&p, map);
        let h = 1.0 / 10_f64.powf(random(3.6, 5.0));
        let least = map.rounding(map.flux(Dq::default())) / p.inductance.d.min(p.inductance.q);
        let rotor = ElectricalAngle(random(-3.0, 3.0)).rotation();
        let mut x = State { current: Dq { d: -0.3 * current, q: 0.8 * current } };
        let rest = Input { voltage: AlphaBeta::default(), rotor, omega_e: 0.0 };
        let slowest = p.inductance.d.max(p.inductance.q) / p.resistance;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of ticks")]
        let ticks = (45.0 * slowest / h).min(30_000.0) as u32;
        for k in 0..ticks {
            motor.step(&mut x, &rest, h);
            assert!(x.current.d.is_finite() && x.current.q.is_finite(), "motor {n}, tick {k}");
        }
        assert!(x.current.magnitude() < 100.0 * least + 1e-12 * current, "motor {n}: {:?}, {least}", x.current);
        for size in [1e-3, 1e-5, 1e-7, 1e-9, 1e-12, 1e-15] {
            // Within a tick a current follows its voltage, whatever the size of either.
            let voltage = AlphaBeta { alpha: size * p.resistance, beta: -size * p.resistance };
            let output = motor.step(&mut x, &Input { voltage, rotor, omega_e: 3.0 }, h);
            assert!(x.current.magnitude().is_finite() && output.power.copper >= 0.0, "motor {n}, {size}: {x:?}");
        }
    }
}
