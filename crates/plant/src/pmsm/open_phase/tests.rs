use super::*;
use crate::inverter::legs;
use crate::pmsm::{Effects, FluxHarmonic, Input, Output, State};
use proptest::prelude::*;
use servobench_base::ElectricalAngle;

/// Saarakkala/Hinkkanen, 2.2 kW.
const MOTOR: Params =
    Params { electrical_ratio: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };
/// Across the axis of phase a.
const LINE: AlphaBeta = AlphaBeta { alpha: 0.0, beta: 1.0 };
const H: f64 = 1.0 / 16e3;

fn harmonics() -> Vec<FluxHarmonic> {
    vec![FluxHarmonic { order: 6, d: 0.02, q: -0.03, phase: 0.4 }]
}

fn real(phase_resistance: Option<[f64; 3]>, flux_harmonics: Vec<FluxHarmonic>) -> RealMotor {
    let effects = Effects { flux_harmonics, phase_resistance, ..Effects::default() };
    RealMotor::new(&MOTOR, &effects, H).unwrap()
}

/// Oracle: i = U/R·(1 − e^(−R·t/ℓ)) along the line, with the inductance ℓ of the two phases in series at the angle of the rotor.
#[test]
fn at_rest_two_phases_are_a_resistance_and_an_inductance() {
    for theta in [0.0, 0.37, 1.1, -2.5] {
        let rotor = ElectricalAngle(theta).rotation();
        let n = LINE.to_dq(rotor);
        let inductance = 36e-3 * n.d * n.d + 51e-3 * n.q * n.q;
        let (voltage, mut x) = (AlphaBeta { alpha: 31.0, beta: 47.3 }, State::default());
        for k in 1..=200 {
            OpenPhase::new(&MOTOR, None, 0.0, LINE).step(&mut x, &Input { voltage, rotor, omega_e: 0.0 }, H);
            let expected = 47.3 / 3.6 * -(-3.6 / inductance * f64::from(k) * H).exp_m1();
            let found = x.current.to_alpha_beta(rotor);
            // A part leaves out (R·h/L)⁵/720 of the transient: 1e-14 of 13 A at each of the ticks.
            assert!(found.alpha.abs() < 1e-14 && (found.beta - expected).abs() < 1e-11, "{theta}, {k}: {found:?}");
        }
    }
}

/// Currents, torque and copper loss after `ticks` of `h` (s) with one winding or the other.
fn run(omega_e: f64, h: f64, ticks: u32, mut step: impl FnMut(&mut State, &Input) -> Output) -> ([f64; 4], f64) {
    let (mut x, mut sums, mut largest) = (State::default(), [0.0; 2], 0.0_f64);
    for k in 0..ticks {
        let rotor = ElectricalAngle(0.3 + omega_e * h * f64::from(k)).rotation();
        let voltage = Dq { d: -60.0, q: 90.0 }.to_alpha_beta(rotor.ahead(omega_e * h / 2.0));
        let output = step(&mut x, &Input { voltage, rotor, omega_e });
        sums = [sums[0] + output.torque * h, sums[1] + output.power.copper * h];
        largest = largest.max(legs(x.current.to_alpha_beta(rotor.ahead(omega_e * h)))[0].abs());
    }
    ([x.current.d, x.current.q, sums[0], sums[1]], largest)
}

/// Oracle: the motor with all three phases, one of which has thousands of times the resistance of the others: as far off as that is
/// finite, half of it with twice the resistance. With harmonics and a difference between the other two phases.
#[test]
fn it_is_the_limit_of_a_phase_with_more_and_more_resistance() {
    let omega_e = 140.0;
    let here = real(Some([1.0, 0.95, 1.2]), harmonics());
    let (open, of_the_phase) =
        run(omega_e, H, 160, |x, u| OpenPhase::new(&MOTOR, Some(&here), 0.0, LINE).step(x, u, H));
    assert!(of_the_phase < 1e-13, "{of_the_phase}");
    assert!(open[0].hypot(open[1]) > 1.0, "{open:?}");
    let error = |factor: f64| {
        let there = real(Some([factor, 0.95, 1.2]), harmonics());
        let (found, _) = run(omega_e, H, 160, |x, u| there.winding(&MOTOR, 0.0).unwrap().step(x, u, H));
        // The loss of the phase itself is u²/R of the whole voltage.
        [0, 1, 2].map(|k| (found[k] - open[k]).abs())
    };
    let [coarse, fine] = [error(3_000.0), error(6_000.0)];
    for (k, name) in ["i_d", "i_q", "torque"].into_iter().enumerate() {
        println!("{name}: {} off by {:e}, {:e}", open[k], coarse[k], fine[k]);
        assert!(fine[k] < 2e-2, "{name}: {}", fine[k]);
        assert!((coarse[k] / fine[k] - 2.0).abs() < 0.1, "{name}: {} {}", coarse[k], fine[k]);
    }
}

/// The same fixed voltage at the same speed in half as many ticks: the error falls by 16.
#[test]
fn it_is_of_fourth_order() {
    let here = real(Some([1.0, 0.95, 1.2]), harmonics());
    let at = |ticks: u32| {
        let (h, omega_e) = (8e-3 / f64::from(ticks), 150.0);
        let mut x = State { current: Dq::default() };
        for k in 0..ticks {
            let rotor = ElectricalAngle(0.3 + omega_e * h * f64::from(k)).rotation();
            let voltage = AlphaBeta { alpha: 3.0, beta: 120.0 };
            OpenPhase::new(&MOTOR, Some(&here), 0.0, LINE).step(&mut x, &Input { voltage, rotor, omega_e }, h);
        }
        x.current.magnitude()
    };
    let exact = at(4_096);
    let [coarse, fine] = [at(32), at(64)].map(|found| (found - exact).abs());
    let order = (coarse / fine).log2();
    assert!(order > 3.7 && fine < 1e-4 * exact, "{order}: {coarse} {fine} of {exact}");
}

proptest! {
    /// Oracle: the first law, and no current in the lost phase, whatever the phase.
    #[test]
    fn the_powers_close(
        s in -9.0..9.0_f64,
        alpha in -300.0..300.0_f64,
        beta in -300.0..300.0_f64,
        theta in -9.0..9.0_f64,
        omega_e in -900.0..900.0_f64,
        lost in 0..3_usize,
    ) {
        let half = 3.0_f64.sqrt() / 2.0;
        let line = [(0.0, 1.0), (-half, -0.5), (half, -0.5)].map(|(alpha, beta)| AlphaBeta { alpha, beta })[lost];
        let here = real(Some([1.0, 0.95, 1.2]), harmonics());
        let rotor = ElectricalAngle(theta).rotation();
        let n = line.to_dq(rotor);
        let mut x = State { current: Dq { d: s * n.d, q: s * n.q } };
        let input = Input { voltage: AlphaBeta { alpha, beta }, rotor, omega_e };
        let crate::pmsm::Power { electrical, copper, stored, air_gap, .. } =
            OpenPhase::new(&MOTOR, Some(&here), 0.0, line).step(&mut x, &input, H).power;
        let terms = [electrical, copper, stored, air_gap];
        let largest = terms.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        // Energies have the rounding of themselves: 3/4·ℓ·s²/h of 50 kW at 9 A.
        let stored_itself = MOTOR.stored_energy(x.current) / H;
        prop_assert!(
            (electrical - copper - stored - air_gap).abs() < 1e-12 * largest + 1e-15 * stored_itself,
            "{terms:?}"
        );
        let phases = legs(x.current.to_alpha_beta(rotor.ahead(omega_e * H)));
        prop_assert!(phases[lost].abs() < 1e-14 * 20.0, "{phases:?}");
        prop_assert!((phases[(lost + 1) % 3] + phases[(lost + 2) % 3]).abs() < 1e-14 * 20.0, "a single-phase current");
    }
}
