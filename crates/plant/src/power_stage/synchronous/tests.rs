//! A motor behind a cable with faults.
use super::*;
use crate::inverter::{LinkParams, Modulation, Params, legs};
use crate::wiring::{Phase, Swap};

const MOTOR: pmsm::Params = pmsm::Params {
    electrical_ratio: 4.0,
    resistance: 1.615,
    inductance: Dq { d: 3.4e-3, q: 4.1e-3 },
    flux_linkage: 60.6e-3,
};
const H: f64 = 1.0 / 16e3;
const REAL: Params =
    Params { carrier: 16e3, dead_time: 2.3e-6, device_drop: 0.9, on_resistance: 0.06, ..Params::IDEAL };
const LINK: LinkParams = LinkParams {
    voltage: 320.0,
    capacitance: 470e-6,
    source_resistance: 0.7,
    mains_frequency: None,
    sag: None,
    brake: None,
};

fn motor(wiring: Wiring, inverter: Option<Params>) -> Synchronous {
    let mut one = Synchronous::new(MOTOR, 320.0, 20.0, H).unwrap();
    if let Some(inverter) = inverter {
        one.put_on(&inverter, Some(&LINK), H).unwrap();
    }
    one.put_behind(wiring).unwrap();
    one
}

/// A run of a motor that gets faster; `each` gets the tick, the measured current and the motor after it.
fn run(one: &mut Synchronous, ticks: u32, mut each: impl FnMut(u32, AlphaBeta, &Synchronous)) {
    for k in 0..ticks {
        let t = H * f64::from(k);
        let body = BodyState { position: 0.2 + 20.0 * t + 350.0 * t * t, velocity: 20.0 + 700.0 * t };
        let measured = one.measured_current(body);
        let wanted = Dq { d: -4.0, q: 70.0 }.to_alpha_beta(one.rotor().rotation().ahead(2.0 * body.velocity * H));
        one.advance(wanted, body, H);
        each(k, measured, one);
    }
}

#[test]
fn a_cable_that_is_right_costs_nothing() {
    assert!(motor(Wiring::default(), None).cable.is_none());
}

/// Oracle: the motor on the right cable, with the mirror image of the request.
#[test]
fn a_swapped_motor_is_the_mirror_image_for_every_inverter() {
    for inverter in [None, Some(REAL), Some(Params { modulation: Modulation::Switching, ..REAL })] {
        for swap in [Swap::Ab, Swap::Bc, Swap::Ca] {
            let wiring = Wiring { swapped: Some(swap), open: None };
            let [mut swapped, mut right] = [motor(wiring, inverter), motor(Wiring::default(), inverter)];
            let cable = Cable::new(wiring).unwrap();
            for k in 0..60 {
                let body = BodyState { position: 0.2 + 31.0 * H * f64::from(k), velocity: 31.0 };
                let [seen, straight] = [&mut swapped, &mut right].map(|one| one.measured_current(body));
                let mirrored = cable.across(straight);
                let wanted = AlphaBeta { alpha: 50.0 - 2.0 * f64::from(k), beta: 33.0 };
                let effort = swapped.advance(cable.across(wanted), body, H);
                let expected = right.advance(wanted, body, H);
                // Both are the same except for some roundings of the mirror, which the winding of the motor keeps for a while.
                let off = (seen.alpha - mirrored.alpha).hypot(seen.beta - mirrored.beta);
                assert!(off < 1e-9 && (effort - expected).abs() < 1e-9, "{inverter:?} {swap:?}: {off}, {effort}");
            }
            assert!(right.current().magnitude() > 5.0);
        }
    }
}

/// Oracle: the first law at every tick, the one in which the arc burns included, and a current that is zero at the leg. With `swapped` the
/// phase b of the motor is on leg c.
#[test]
fn a_lost_phase_has_no_current_and_the_powers_close() {
    for inverter in [None, Some(REAL), Some(Params { modulation: Modulation::Switching, ..REAL })] {
        for (swapped, leg) in [(None, 1), (Some(Swap::Bc), 2)] {
            let mut one = motor(Wiring { swapped, open: Some((Phase::B, 4e-3)) }, inverter);
            let (mut largest, mut arc, mut left) = ([0.0_f64; 2], 0.0, 0.0_f64);
            run(&mut one, 400, |k, measured, one| {
                let of_leg = legs(measured)[leg].abs();
                // The phase opens at the beginning of tick 64, after its current was measured.
                let at = usize::from(k > 64);
                largest[at] = largest[at].max(of_leg);
                let pmsm::Power { electrical, copper, stored, air_gap, .. } = one.power();
                let terms = [electrical, copper, stored, air_gap];
                let most = terms.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
                let closes = (electrical - copper - stored - air_gap).abs() < 1e-12 * most;
                assert!(closes, "{inverter:?}, {k}: {terms:?}");
                if k == 64 {
                    arc = copper;
                } else if k > 64 {
                    left = left.max(one.current().magnitude());
                }
            });
            assert!(largest[0] > 1.0 && largest[1] < 1e-13, "{inverter:?}: {largest:?}");
            assert!(left > 1.0 && arc > 100.0, "{left} A, {arc} W");
        }
    }
}

#[test]
fn a_snapshot_holds_the_cable() {
    let wiring = Wiring { swapped: Some(Swap::Ca), open: Some((Phase::A, 4e-3)) };
    let mut first = motor(wiring, Some(REAL));
    run(&mut first, 100, |_, _, _| ());
    let [mut one, mut other] = [first.clone(), first];
    let of = |one: &mut Synchronous| {
        let mut found = Vec::new();
        run(one, 50, |_, measured, _| found.push(measured));
        found
    };
    assert_eq!(of(&mut one), of(&mut other));
}
