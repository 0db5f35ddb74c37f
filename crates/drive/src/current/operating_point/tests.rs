//! Tests of maximum torque per ampere and field weakening.
use super::*;
use crate::current::{Gains, voltage_limit};

/// The 2.2 kW motor with the resistance `r`.
fn motor(r: f64, d: f64, q: f64, flux_linkage: f64) -> MotorEstimate {
    MotorEstimate { electrical_ratio: 3.0, resistance: r, inductance: Dq { d, q }, flux_linkage }
}

const LOSSLESS: f64 = 1e-12;

fn drive(motor: MotorEstimate, strategy: Strategy, max_current: f64, dc_link: f64) -> Loop {
    let operation = Params { strategy, weakening: Some(Weakening { share: 1.0, feedback: 0.0 }) };
    let gains = Gains::from_bandwidth(&motor, 2_000.0);
    let max_voltage = voltage_limit(dc_link);
    Loop { motor, gains, d_reference: 0.0, max_current, max_voltage, operation, dead_time: None }
}

fn torque(motor: &MotorEstimate, i: Dq) -> f64 {
    motor.effort_constant(i.d) * i.q
}

fn salient(max_current: f64) -> Loop {
    drive(motor(LOSSLESS, 36e-3, 51e-3, 0.545), Strategy::Mtpa, max_current, 540.0)
}

/// Oracle: the closed form ψ/(4(L_q − L_d)) − √(ψ²/(16(L_q − L_d)²) + i²/2), either saliency; 0 without. By effort it is the same point,
/// and ±0.1 % of the angle take more current.
#[test]
fn mtpa_is_the_closed_form() {
    for (d, q) in [(36e-3, 51e-3), (12e-3, 55.3e-3), (51e-3, 36e-3), (40e-3, 40e-3), (40e-3, 40.000_001e-3)] {
        let m = motor(3.6, d, q, 0.545);
        for length in [0.37, 4.9, 9.12, 31.0] {
            let found = m.mtpa_at_current(length);
            let a = q - d;
            if a.abs() > 1e-6 {
                let root = (0.545 * 0.545 / (16.0 * a * a) + length * length / 2.0).sqrt();
                let exact = 0.545 / (4.0 * a) - root.copysign(a);
                // The closed form is a difference of two numbers of its first term's size.
                assert!((found - exact).abs() < 1e-15 * (0.545 / a.abs()), "{d} {q} {length}: {found} {exact}");
            } else {
                assert!(found.abs() < 1e-6 * length, "{found}");
            }
            let i = Dq { d: found, q: (length * length - found * found).sqrt() };
            for sign in [1.0, -1.0] {
                let by_effort = m.mtpa(sign * torque(&m, i));
                assert!((by_effort - found).abs() < 1e-12 * length, "{d} {q} {length}: {by_effort} {found}");
            }
            let turned = |angle: f64| {
                let (sin, cos) = angle.sin_cos();
                torque(&m, Dq { d: i.d * cos - i.q * sin, q: i.d * sin + i.q * cos })
            };
            assert!(turned(1e-3) < torque(&m, i) && turned(-1e-3) < torque(&m, i));
        }
    }
}

/// Oracle: below the base speed, where |u| of the MTPA point is U, all of its torque is available; i_d is that of MTPA.
#[test]
fn below_base_speed_there_is_all_torque_at_mtpa() {
    let p = salient(9.12);
    let d = p.motor.mtpa_at_current(9.12);
    let corner = Dq { d, q: (9.12 * 9.12 - d * d).sqrt() };
    let flux = Dq { d: 36e-3 * corner.d + 0.545, q: 51e-3 * corner.q };
    let base = p.max_voltage / flux.magnitude();
    let envelope = |omega| Envelope::new(&p, &State::default(), omega);
    for omega in [0.0, 0.3 * base, -0.999 * base, 0.999_999 * base] {
        let found = envelope(omega);
        for peak in [found.forward, found.backward] {
            assert!((peak.effort / torque(&p.motor, corner) - 1.0).abs() < 1e-14 && (peak.d - d).abs() < 1e-14);
        }
        let half = found.currents(&p, -0.37 * found.backward.effort);
        assert!((half.d - p.motor.mtpa(0.37 * found.backward.effort)).abs() < 1e-15 && half.q < 0.0);
    }
    assert!(envelope(1.001 * base).forward.effort < torque(&p.motor, corner));
}

/// Oracle: Morimoto's closed form of the corner of circle and ellipse without resistance: with a = L_d² − L_q²,
/// a·i_d² + 2·ψ·L_d·i_d + ψ² + L_q²·I² − (U/ω)² = 0.
#[test]
fn the_corner_of_circle_and_ellipse_is_the_closed_form() {
    let p = salient(9.12);
    for omega in [620.0_f64, -700.0, 813.0, 1_000.0] {
        let (l_d, l_q, psi, r) = (36e-3, 51e-3, 0.545, p.max_voltage / omega);
        let (a, b, c) = (l_d * l_d - l_q * l_q, 2.0 * psi * l_d, psi * psi + l_q * l_q * 9.12 * 9.12 - r * r);
        let d = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
        let exact = torque(&p.motor, Dq { d, q: (9.12 * 9.12 - d * d).sqrt() });
        let found = Envelope::new(&p, &State::default(), omega).forward;
        // The remaining interval of the golden section is 4e-9 of the current limit's width, on either side of a corner.
        assert!(
            (found.d - d).abs() < 1e-7 && (found.effort / exact - 1.0).abs() < 1e-7,
            "{omega}: {found:?} {d} {exact}"
        );
    }
}

/// Oracle: Morimoto's closed form of maximum torque per voltage, which lies inside the circle where ψ/L_d < I_max and the speed is high:
/// i_d = −ψ/L_d + Δ, Δ = (L_q·ψ − √((L_q·ψ)² + 8·(L_q − L_d)²·(U/ω)²))/(4·L_d·(L_q − L_d)).
#[test]
fn at_infinite_speed_it_is_the_most_torque_per_voltage() {
    let (l_d, l_q, psi) = (36e-3_f64, 51e-3_f64, 0.545_f64);
    let p = salient(19.7);
    assert!(psi / l_d < 19.7);
    for omega in [1_700.0_f64, -3_100.0, 9_000.0, 1e5] {
        let (a, u) = (l_q - l_d, p.max_voltage / omega.abs());
        let delta = (l_q * psi - ((l_q * psi).powi(2) + 8.0 * (a * u).powi(2)).sqrt()) / (4.0 * l_d * a);
        let d = -psi / l_d + delta;
        let q = (u * u - (l_d * delta).powi(2)).sqrt() / l_q;
        assert!(d.hypot(q) < 19.7, "{omega}: inside of the circle");
        let found = Envelope::new(&p, &State::default(), omega).backward;
        let exact = torque(&p.motor, Dq { d, q });
        // At a smooth maximum the error of the torque is of second order in that of i_d.
        assert!(
            (found.effort / exact - 1.0).abs() < 1e-9 && (found.d - d).abs() < 1e-6,
            "{omega}: {found:?} {d} {exact}"
        );
    }
    // Without saliency the maximum is straight above the centre.
    let round = drive(motor(LOSSLESS, 36e-3, 36e-3, psi), Strategy::Mtpa, 19.7, 540.0);
    let found = Envelope::new(&round, &State::default(), 3_000.0).forward;
    let exact = 1.5 * 3.0 * psi * round.max_voltage / 3_000.0 / 36e-3;
    assert!((found.effort / exact - 1.0).abs() < 1e-9 && (found.d + psi / 36e-3).abs() < 1e-6, "{found:?}");
}

/// Oracle: a grid over all currents within circle and ellipse, with resistance.
#[test]
fn with_resistance_it_is_the_best_of_a_grid() {
    for (strategy, max_current) in [(Strategy::Mtpa, 9.12), (Strategy::Mtpa, 19.7), (Strategy::DReference, 14.0)] {
        let p = drive(motor(3.6, 36e-3, 51e-3, 0.545), strategy, max_current, 540.0);
        for omega in [310.0, 560.0, -700.0, 1_100.0, 2_300.0] {
            let envelope = Envelope::new(&p, &State::default(), omega);
            for (sign, peak) in [(1.0, envelope.forward), (-1.0, envelope.backward)] {
                let mut best = 0.0_f64;
                for k in 0..=1_200 {
                    for j in 0..=600 {
                        let d = -max_current * f64::from(k) / 1_200.0;
                        let i = Dq { d, q: sign * max_current * f64::from(j) / 600.0 };
                        let suffices = |i| p.motor.steady_voltage(i, omega).magnitude() <= p.max_voltage;
                        if i.magnitude() <= max_current && suffices(i) && suffices(Dq { q: 0.0, ..i }) {
                            best = best.max(sign * torque(&p.motor, i));
                        }
                    }
                }
                let plain = p.motor.effort_constant(0.0) * max_current;
                let best = if strategy == Strategy::DReference { best.min(plain) } else { best };
                // The grid is a 600th wide, and inside.
                let most = 1.5 * 3.0 * 0.9 * max_current / 600.0;
                let above = peak.effort - best;
                assert!((-1e-9..2.5 * most).contains(&above), "{strategy:?} {omega} {sign}: {peak:?} {best}");
            }
        }
    }
}

/// Every effort within the envelope is reached, within both limits, and continuously.
#[test]
fn every_effort_within_the_envelope_is_given_within_both_limits() {
    for (strategy, max_current) in [(Strategy::Mtpa, 9.12), (Strategy::Mtpa, 19.7), (Strategy::DReference, 14.0)] {
        let p = drive(motor(3.6, 36e-3, 51e-3, 0.545), strategy, max_current, 540.0);
        for omega in [0.0, 310.0, 560.0, -700.0, 1_100.0, -2_300.0] {
            let envelope = Envelope::new(&p, &State::default(), omega);
            let EffortLimits { forward, backward } = envelope.limits();
            // Beyond the last speed no current is within both limits: see below.
            let is_possible = forward > 0.0 || backward > 0.0;
            let mut last: Option<f64> = None;
            for k in 0..=400 {
                let effort = -backward + (forward + backward) * f64::from(k) / 400.0;
                let i = envelope.currents(&p, effort);
                let given = torque(&p.motor, i);
                assert!((given - effort).abs() < 1e-7 * (1.0 + effort.abs()), "{omega} {effort}: {given}");
                assert!(i.magnitude() <= max_current * (1.0 + 1e-12), "{i:?}");
                let u = p.motor.steady_voltage(i, omega).magnitude();
                assert!(!is_possible || u <= p.max_voltage * (1.0 + 1e-6), "{omega} {effort}: {u} {}", p.max_voltage);
                if let Some(last) = last {
                    // At the peak of a smooth envelope i_d goes as the root of the remaining effort, a 400th.
                    assert!((i.d - last).abs() < 0.1 * max_current, "{omega} {effort}: {} from {last}", i.d);
                }
                last = Some(i.d);
            }
            let beyond = envelope.currents(&p, 10.0 * forward + 1.0);
            assert!((torque(&p.motor, beyond) - forward).abs() < 1e-7 * (1.0 + forward), "{beyond:?}");
        }
    }
}

/// Oracle: ω at which the voltage is U with i_q = 0 and i_d = −I_max: (R·I)² + ω²·(ψ − L_d·I)² = U². Beyond it no effort is left.
#[test]
fn beyond_the_last_speed_nothing_is_left() {
    let p = drive(motor(3.6, 36e-3, 51e-3, 0.545), Strategy::Mtpa, 9.12, 540.0);
    let loss = 3.6 * 9.12;
    let last = (p.max_voltage * p.max_voltage - loss * loss).sqrt() / (0.545 - 36e-3 * 9.12);
    let at = |omega| Envelope::new(&p, &State::default(), omega);
    assert!(at(0.999 * last).forward.effort > 0.0);
    let beyond = at(1.001 * last);
    assert_eq!(beyond.limits(), EffortLimits::both(0.0));
    let i = beyond.currents(&p, 5.0);
    assert!((i.d + 9.12).abs() < 1e-12 && i.q.abs() < 1e-12, "{i:?}");
}

/// A reluctance motor of 6.7 kW without magnets; either axis may have the larger inductance.
fn reluctance(r: f64, d: f64, q: f64) -> Loop {
    let motor = MotorEstimate { electrical_ratio: 2.0, ..motor(r, d, q, 0.0) };
    drive(motor, Strategy::Mtpa, 31.0, 540.0)
}

/// Oracle: τ = K·(L_d − L_q)·i_d·i_q is largest for a current at 45°: |i_d| = |i_q| = √(|τ|/(K·|L_d − L_q|)), i_d with the sign of L_d −
/// L_q and i_q with that of τ. Zero torque takes no current, nor does a torque whose square underflows.
#[test]
fn a_motor_without_magnets_has_both_currents_alike() {
    for (l_d, l_q) in [(41.5e-3, 6.2e-3), (6.2e-3, 41.5e-3)] {
        let p = reluctance(0.54, l_d, l_q);
        assert_eq!(p.check(), Ok(()));
        let sign = f64::signum(l_d - l_q);
        let k = 1.5 * 2.0 * (l_d - l_q).abs();
        assert!((p.max_effort() / (k * 31.0 * 31.0 / 2.0) - 1.0).abs() < 1e-14);
        for omega in [0.0, 90.0, -90.0] {
            let envelope = Envelope::new(&p, &State::default(), omega);
            for effort in [1e-9, 0.3, 20.1, 50.0] {
                for direction in [1.0, -1.0] {
                    let i = envelope.currents(&p, direction * effort);
                    let expected = (effort / k).sqrt();
                    assert!((i.d * sign / expected - 1.0).abs() < 1e-12, "{l_d} {effort}: {i:?}");
                    assert!((i.q * direction / expected - 1.0).abs() < 1e-12, "{l_d} {effort}: {i:?}");
                }
            }
            for nothing in [0.0, -0.0] {
                assert_eq!(envelope.currents(&p, nothing).magnitude().to_bits(), 0.0_f64.to_bits());
            }
            // Field weakening finds a sufficient d-axis current by bisection from the limit.
            assert!(envelope.currents(&p, 1e-200).magnitude() < 31.0 * 0.5_f64.powi(35));
        }
    }
}

/// Oracles, without resistance: the corner of circle and ellipse, L_d²·i_d² + L_q²·(I² − i_d²) = (U/ω)²; once it is inside the circle,
/// maximum torque per voltage, L_d·|i_d| = L_q·|i_q| = U/(√2·ω). With the smaller inductance in d that is less i_d than at rest.
#[test]
fn the_field_of_a_motor_without_magnets_is_weakened_to_its_voltage() {
    let (most, ratio) = (31.0_f64, 1.5 * 2.0);
    for (l_d, l_q) in [(41.5e-3_f64, 6.2e-3_f64), (6.2e-3, 41.5e-3)] {
        let p = reluctance(LOSSLESS, l_d, l_q);
        for omega in [250.0_f64, 390.0, 600.0, -1_500.0, 9_000.0] {
            let u = p.max_voltage / omega.abs();
            let [at_rest, per_voltage] = [[most / 2.0_f64.sqrt(); 2], [l_d, l_q].map(|l| u / (2.0_f64.sqrt() * l))];
            let [d, q] = if (l_d * at_rest[0]).hypot(l_q * at_rest[1]) < u {
                at_rest
            } else if per_voltage[0].hypot(per_voltage[1]) < most {
                per_voltage
            } else {
                let square = (u * u - l_q * l_q * most * most) / (l_d * l_d - l_q * l_q);
                [square.sqrt(), (most * most - square).sqrt()]
            };
            let exact = ratio * (l_d - l_q).abs() * d * q;
            let envelope = Envelope::new(&p, &State::default(), omega);
            for peak in [envelope.forward, envelope.backward] {
                assert!((peak.effort / exact - 1.0).abs() < 1e-6, "{l_d} {omega}: {peak:?} {d} {exact}");
            }
            for share in [1.0, 0.6, 1e-3, -0.6, -1.0] {
                let i = envelope.currents(&p, share * exact);
                assert!((torque(&p.motor, i) / (share * exact) - 1.0).abs() < 1e-6, "{omega} {share}: {i:?}");
                assert!(p.motor.steady_voltage(i, omega).magnitude() < p.max_voltage * (1.0 + 1e-6), "{omega} {share}");
                assert!(i.magnitude() < most * (1.0 + 1e-12));
            }
        }
    }
}

/// Without magnets the d axis needs a current for an effort; without saliency there is none.
#[test]
fn a_motor_without_any_torque_is_refused() {
    let p = reluctance(0.54, 41.5e-3, 6.2e-3);
    let of = |d_reference: f64| Loop { operation: Params::default(), d_reference, ..p };
    assert_eq!(of(8.0).check(), Ok(()));
    for refused in [of(0.0), of(-8.0), reluctance(0.54, 6e-3, 6e-3)] {
        let said = refused.check().unwrap_err().to_string();
        assert!(
            said.contains("leave the motor some torque") || said.contains("flux linkage` must be above 0"),
            "{said}"
        );
    }
}

/// Oracle: dU/dt = α·(U − |u|): an excess of 10 V for 3 ms at 20 Hz takes 10·2π·20·3e-3 V; the correction never rises above 0 and ends at
/// half.
#[test]
fn the_feedback_lowers_the_voltage_and_gives_it_back() {
    let mut p = salient(9.12);
    let feedback = core::f64::consts::TAU * 20.0;
    p.operation.weakening = Some(Weakening { share: 0.93, feedback });
    let most = 0.93 * p.max_voltage;
    let mut x = State::default();
    for _ in 0..24 {
        step(&p, &mut x, Dq { d: 0.0, q: most + 10.0 }, 1.0 / 8e3);
    }
    assert!((x.correction + 10.0 * feedback * 3e-3).abs() < 1e-9, "{x:?}");
    let less = Envelope::new(&p, &x, 800.0).forward.effort;
    assert!(less < Envelope::new(&p, &State::default(), 800.0).forward.effort);
    for _ in 0..8_000 {
        step(&p, &mut x, Dq { d: 0.0, q: 1e3 }, 1.0 / 8e3);
    }
    assert!((x.correction + most / 2.0).abs() < 1e-12);
    for _ in 0..8_000 {
        step(&p, &mut x, Dq { d: 0.0, q: 100.0 }, 1.0 / 8e3);
    }
    assert_eq!(x, State::default());
}

#[test]
fn without_a_current_limit_there_is_no_optimum() {
    let p = Loop { max_current: f64::INFINITY, ..salient(9.0) };
    let said = p.check().unwrap_err().to_string();
    assert!(said.starts_with("`largest current` must be finite"), "{said}");
    assert_eq!(Loop { operation: Params::default(), ..p }.check(), Ok(()));
}
