use super::*;
use crate::mechanics::BodyState;
use inverter::Params;
use std::f64::consts::PI;

const MOTOR: pmsm::Params = pmsm::Params {
    electrical_ratio: 4.0,
    resistance: 1.615,
    inductance: Dq { d: 3.485e-3, q: 3.485e-3 },
    flux_linkage: 60.6e-3,
};
const LINK: LinkParams = LinkParams {
    voltage: 320.0,
    capacitance: 470e-6,
    source_resistance: 0.7,
    mains_frequency: Some(50.0),
    sag: None,
    brake: None,
};
const H: f64 = 1.0 / 16e3;
const REAL: Params =
    Params { carrier: 16e3, dead_time: 2.3e-6, device_drop: 0.9, on_resistance: 0.06, ..Params::IDEAL };

/// All effects of a motor.
fn every_effect() -> pmsm::Effects {
    pmsm::Effects {
        flux_map: Some(
            pmsm::FluxMap::curve(
                &pmsm::Saturation { current: 31.0, share: 0.8, residual: 0.1 },
                MOTOR.flux_linkage,
                MOTOR.inductance,
            )
            .unwrap(),
        ),
        cogging: vec![pmsm::Cogging { ratio: 36.0, amplitude: 0.02, phase: 0.3 }],
        flux_harmonics: vec![pmsm::FluxHarmonic { order: 6, d: 0.013, q: -0.021, phase: 0.2 }],
        iron: Some(pmsm::IronLoss { speed: 314.0, hysteresis: 6.0, eddy: 11.0 }),
        phase_resistance: Some([1.0, 0.93, 1.12]),
        temperature: Some(pmsm::Temperature {
            reference: 20.0,
            resistance_coefficient: pmsm::COPPER,
            flux_coefficient: -0.0011,
            start: pmsm::Temperatures { winding: 71.0, housing: 43.0 },
            network: Some(pmsm::ThermalNetwork {
                ambient: 30.0,
                to_housing: 0.6,
                to_ambient: 1.1,
                winding_capacity: 6.0,
                housing_capacity: 90.0,
                winding_limit: 155.0,
            }),
        }),
    }
}

/// A motor at `speed` on a voltage that is constant in its rotor's frame; `each` sees it after every tick.
fn run(of: (&Params, Option<&LinkParams>), way: (Dq, f64), ticks: u32, each: impl FnMut(u32, &Synchronous)) {
    run_with(&pmsm::Effects::default(), of, way, ticks, each);
}

/// The same with a motor that has `effects`.
fn run_with(
    effects: &pmsm::Effects,
    of: (&Params, Option<&LinkParams>),
    (voltage, speed): (Dq, f64),
    ticks: u32,
    mut each: impl FnMut(u32, &Synchronous),
) {
    let mut one = Synchronous::new(MOTOR, 320.0, speed, H).unwrap().with_effects(effects, H).unwrap();
    one.put_on(of.0, of.1, H).unwrap();
    for k in 0..ticks {
        let motor = BodyState { position: speed * H * f64::from(k), velocity: speed };
        one.measured_current(motor);
        let wanted = voltage.to_alpha_beta(one.rotor().rotation().ahead(2.0 * speed * H));
        one.advance(wanted, motor, H);
        each(k, &one);
    }
}

#[test]
fn an_inverter_without_effects_costs_nothing() {
    let mut one = Synchronous::new(MOTOR, 320.0, 1.0, H).unwrap();
    one.put_on(&Params { carrier: 16e3, ..Params::IDEAL }, None, H).unwrap();
    assert!(one.inverter.is_none());
}

/// Oracle: U_T·Σ mean|i_x| = U_T·3·2/π·I, r·Σ mean i_x² = r·3/2·I².
#[test]
fn the_loss_is_that_of_sinusoidal_currents() {
    for modulation in [Modulation::Averaged, Modulation::Switching] {
        let (current, speed) = (Dq { d: 1.5, q: 9.0 }, 2.0 * PI * 10.0);
        let p = Params { modulation, dead_time: 0.0, ..REAL };
        let needed = MOTOR.steady_voltage(current, 4.0 * speed);
        // Drop of the devices in the fundamental: 4/π·U_T along the current, and r.
        let taken = 4.0 / PI * 0.9 / current.magnitude() + 0.06;
        let voltage = Dq { d: needed.d + taken * current.d, q: needed.q + taken * current.q };
        let (mut loss, mut count, mut length) = (0.0, 0.0, 0.0);
        run((&p, None), (voltage, speed), 2_800, |k, one| {
            if k >= 1_200 {
                loss += one.inverter_loss();
                length += one.current().magnitude();
                count += 1.0;
            }
        });
        let i = length / count;
        let expected = 0.9 * 6.0 / PI * i + 1.5 * 0.06 * i * i;
        println!("{modulation:?}: {} W, {expected} W at {i} A", loss / count);
        assert!((i / current.magnitude() - 1.0).abs() < 0.01, "{modulation:?}: {i}");
        assert!((loss / count / expected - 1.0).abs() < 0.01, "{modulation:?}: {} {expected}", loss / count);
    }
}

/// Oracle: the first law, of the motor and of the capacitor, at every tick; with the effects of the devices and the dead time.
#[test]
fn what_the_mains_give_is_stored_lost_or_turned() {
    let effects = [pmsm::Effects::default(), every_effect()];
    let modulations = [Modulation::Averaged, Modulation::Switching];
    for (effects, modulation) in effects.iter().flat_map(|effects| modulations.map(|modulation| (effects, modulation)))
    {
        let (p, speed) = (Params { modulation, ..REAL }, 90.0);
        let voltage = MOTOR.steady_voltage(Dq { d: -1.0, q: 25.0 }, 4.0 * speed);
        let (mut before, mut lowest): (f64, f64) = (320.0, 320.0);
        run_with(effects, (&p, Some(&LINK)), (voltage, speed), 600, |k, one| {
            let (u, power) = one.link();
            let pmsm::Power { electrical, copper, iron, stored, air_gap } = one.power();
            let field = 0.5 * LINK.capacitance * (u - before) * (u + before) / H;
            let terms = [power.source, electrical, one.inverter_loss(), field, copper, iron, stored, air_gap];
            let largest = terms.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
            assert!((electrical - copper - iron - stored - air_gap).abs() < 1e-12 * largest, "{k}: {terms:?}");
            assert_eq!(iron > 0.0, *effects != pmsm::Effects::default(), "{k}");
            let rest = power.source - electrical - one.inverter_loss() - field;
            // Δu has the rounding of u: of 320 V·470 µF/62.5 µs that is 2.4 kA·320 V·1e-16.
            assert!(rest.abs() < 1e-12 * largest + 1e-9, "{k}: {rest} of {terms:?}");
            (before, lowest) = (u, lowest.min(u));
        });
        assert!(lowest < 319.0 && lowest > 250.0, "{lowest}");
    }
}

/// Oracle: each other; without zero crossings of the current the carrier does not matter. 16 A, no leg below 6, against a ripple of 0.2 A.
#[test]
fn both_modulations_give_the_same_current() {
    let voltage = Dq { d: 45.0, q: -3.0 };
    let [averaged, switching] = [Modulation::Averaged, Modulation::Switching].map(|modulation| {
        let (mut sum, mut count) = (Dq::default(), 0.0);
        run((&Params { modulation, ..REAL }, None), (voltage, 0.0), 1_600, |k, one| {
            if k >= 800 {
                let Dq { d, q } = one.current();
                sum = Dq { d: sum.d + d, q: sum.q + q };
                count += 1.0;
            }
        });
        Dq { d: sum.d / count, q: sum.q / count }
    });
    let error = (averaged.d - switching.d).hypot(averaged.q - switching.q) / averaged.magnitude();
    println!("{error:e}: {averaged:?}");
    assert!(error < 1e-3, "{averaged:?} {switching:?}");
}

/// Oracle: the exact segments. Equal phases do not change the motor; the error of the solution between two edges is given in
/// `pmsm::varying`.
#[test]
fn a_winding_that_may_vary_is_followed_between_the_same_edges() {
    let p = Params { modulation: Modulation::Switching, ..REAL };
    let equal = pmsm::Effects { phase_resistance: Some([1.0; 3]), ..pmsm::Effects::default() };
    let way = (MOTOR.steady_voltage(Dq { d: -1.0, q: 11.0 }, 4.0 * 170.0), 170.0);
    let (mut exact, mut found) = (Vec::new(), Vec::new());
    run((&p, None), way, 700, |_, one| exact.push((one.current(), one.power())));
    run_with(&equal, (&p, None), way, 700, |_, one| found.push((one.current(), one.power())));
    for (k, ((i, power), (j, same))) in exact.iter().zip(&found).enumerate() {
        let error = (i.d - j.d).hypot(i.q - j.q);
        assert!(error < 1e-8 * 11.0, "{k}: {i:?} {j:?}");
        assert!((power.electrical - same.electrical).abs() < 1e-7 * 500.0, "{k}: {power:?} {same:?}");
    }
}

/// Oracle: each other, over a revolution, with all effects of a motor. The averaged inverter is limited
/// by the circle, which is not reached here.
#[test]
fn both_modulations_drive_a_motor_with_effects_alike() {
    let p = Params { carrier: 16e3, ..Params::IDEAL };
    let speed = 2.0 * PI * 16e3 / 3_200.0;
    let way = (MOTOR.steady_voltage(Dq { d: -2.0, q: 12.0 }, 4.0 * speed), speed);
    let [averaged, switching] = [Modulation::Averaged, Modulation::Switching].map(|modulation| {
        let (mut torque, mut copper) = (0.0, 0.0);
        run_with(&every_effect(), (&Params { modulation, ..p }, None), way, 6_400, |k, one| {
            if k >= 3_200 {
                torque += one.power().air_gap / speed / 3_200.0;
                copper += one.power().copper / 3_200.0;
            }
        });
        (torque, copper)
    });
    let ripple = 1.5 * MOTOR.resistance * 0.25 * 0.25;
    println!("{averaged:?} {switching:?}");
    assert!((averaged.0 / switching.0 - 1.0).abs() < 1e-3, "{averaged:?} {switching:?}");
    assert!((averaged.1 - switching.1).abs() < 1e-3 * averaged.1 + ripple, "{averaged:?} {switching:?}");
}

#[test]
fn a_snapshot_holds_the_bridge_and_the_link() {
    let p = Params { modulation: Modulation::Switching, carrier: 4e3, ..REAL };
    let mut first = Vec::new();
    let mut copy = None;
    run((&p, Some(&LINK)), (Dq { d: 10.0, q: 40.0 }, 80.0), 50, |k, one| {
        if k == 20 {
            copy = Some(one.clone());
        }
        if k > 20 {
            first.push((one.current(), one.link().0));
        }
    });
    let mut one = copy.unwrap();
    for (k, before) in (21..50).zip(first) {
        let motor = BodyState { position: 80.0 * H * f64::from(k), velocity: 80.0 };
        one.measured_current(motor);
        let wanted = Dq { d: 10.0, q: 40.0 }.to_alpha_beta(one.rotor().rotation().ahead(160.0 * H));
        one.advance(wanted, motor, H);
        assert_eq!((one.current(), one.link().0), before, "{k}");
    }
}

/// A thousand radians in a tick are followed; beyond them every winding ends the run at once.
#[test]
fn a_rotor_that_turns_too_far_in_a_tick_has_no_effort() {
    for (effects, inverter) in [
        (every_effect(), Params::IDEAL),
        (pmsm::Effects { flux_map: None, ..every_effect() }, REAL),
        (pmsm::Effects::default(), Params { modulation: Modulation::Switching, ..REAL }),
    ] {
        for (turn, is_followed) in [(1000.0, true), (-1030.0, false), (1e200, false), (f64::NAN, false)] {
            let speed = turn / H / MOTOR.electrical_ratio;
            let mut motor = Synchronous::new(MOTOR, 320.0, speed, H).unwrap();
            motor = motor.with_effects(&effects, H).unwrap();
            if inverter != Params::IDEAL {
                motor.put_on(&inverter, None, H).unwrap();
            }
            let effort = motor.advance(AlphaBeta::default(), BodyState { position: 0.0, velocity: speed }, H);
            assert_eq!(effort.is_finite(), is_followed, "{turn}: {effort}");
        }
    }
}
