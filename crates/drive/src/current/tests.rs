//! Tests of the current loop.
use super::*;

const MOTOR: MotorEstimate = MotorEstimate {
    electrical_ratio: 3.0,
    resistance: 3.6,
    inductance: Dq { d: 36e-3, q: 51e-3 },
    flux_linkage: 0.545,
};
const H: f64 = 1.0 / 16_000.0;

fn tuned(alpha: f64, max_voltage: f64) -> Params {
    let gains = Gains::from_bandwidth(&MOTOR, alpha);
    Params {
        motor: MOTOR,
        gains,
        d_reference: 0.0,
        max_current: f64::INFINITY,
        max_voltage,
        operation: operating_point::Params::default(),
        dead_time: None,
    }
}

/// Lag (s) behind a ramp with an R–L load at standstill, where each axis is exactly i(k+1) = a·i + (1 − a)/R·u.
fn ramp_lag(alpha: f64) -> f64 {
    let p = tuned(alpha, 1e6);
    let (mut x, mut i) = (State::default(), Dq::default());
    let slope = 100.0;
    for k in 0..1_600 {
        let reference = Dq { d: 0.0, q: slope * f64::from(k) * H };
        let current = AlphaBeta { alpha: i.d, beta: i.q };
        let out = step(&p, &mut x, Input { reference, current, rotor: Rotation::default(), omega_e: 0.0 }, H);
        for (i, u, l) in [(&mut i.d, out.voltage.alpha, 36e-3), (&mut i.q, out.voltage.beta, 51e-3)] {
            let a = (-H * 3.6 / l).exp();
            *i = a * *i + (1.0 - a) / 3.6 * u;
        }
    }
    (slope * 1_600.0 * H - i.q) / slope
}

/// Oracle: the final-value theorem: a loop of gain α/s follows a ramp with a delay of 1/α, with or without a tick of dead time.
#[test]
fn a_ramp_is_followed_one_over_alpha_late() {
    for alpha in [500.0, 2_000.0, 6_000.0] {
        // Forward Euler and the exact hold of R–L differ by h·R/2L of the gain.
        assert!((ramp_lag(alpha) * alpha - 1.0).abs() < 5e-3, "{alpha}: {}", ramp_lag(alpha) * alpha);
    }
}

#[test]
fn d_has_first_call_on_the_voltage() {
    let cut = limit_d_first(Dq { d: -240.0, q: 300.0 }, 300.0);
    assert!((cut.d + 240.0).abs() < 1e-12 && (cut.q - 180.0).abs() < 1e-12, "{cut:?}");
    assert_eq!(limit_d_first(Dq { d: 400.0, q: 1.0 }, 300.0), Dq { d: 300.0, q: 0.0 });
}

/// Oracle: with the voltage at u_max, v = k_p·e + I and dI/dt = k_i·(e + (u_max − v)/k_p) = (u_max − I)·k_i/k_p: the integrator comes to
/// rest at u_max, whatever the error.
#[test]
fn the_integrator_of_a_saturated_axis_rests_at_the_limit() {
    let p = tuned(2_000.0, 300.0);
    let mut x = State::default();
    let input = Input {
        reference: Dq { d: 0.0, q: 100.0 },
        current: AlphaBeta::default(),
        rotor: Rotation::default(),
        omega_e: 0.0,
    };
    for _ in 0..160_000 {
        assert!(step(&p, &mut x, input, H).saturated);
    }
    // Each step rounds v, of 10 kV, and a difference of that size; rounding errors decay with k_i/k_p.
    assert!((x.integral.q - 300.0).abs() < 1e-10, "{:?}", x.integral);
}

/// Oracle: by hand. T_i = L/R of each axis: 10 V/A · 3.6 Ω / 36 mH and 20 V/A · 3.6 Ω / 51 mH; or as given.
#[test]
fn each_axis_has_its_own_integral_gain() {
    let k_p = Dq { d: 10.0, q: 20.0 };
    let k_i = Gains::cancelling(&MOTOR, k_p).k_i;
    assert!((k_i.d / 1000.0 - 1.0).abs() < 1e-15 && (k_i.q / (72.0 / 0.051) - 1.0).abs() < 1e-15, "{k_i:?}");
    let given = Gains::with_integral_times(k_p, Dq { d: 0.5, q: 0.25 });
    assert_eq!(given, Gains { k_p, k_i: Dq { d: 20.0, q: 80.0 } });
    let k_p = Gains::from_bandwidth(&MOTOR, 1_000.0).k_p;
    assert!((k_p.d / 36.0 - 1.0).abs() < 1e-15 && (k_p.q / 51.0 - 1.0).abs() < 1e-15, "{k_p:?}");
}

/// Oracle: by hand. 3-4-5: −3 A in d leave 4 of 5 A, and (36 − 51) mH · −3 A add 45 mVs to the flux linkage.
#[test]
fn the_current_limit_is_one_of_the_vector() {
    let p = Params { d_reference: -3.0, max_current: 5.0, ..tuned(2_000.0, 300.0) };
    assert!((p.max_q_current() - 4.0).abs() < 1e-15);
    assert!((p.max_effort() - 1.5 * 3.0 * (0.545 + 0.045) * 4.0).abs() < 1e-14, "{}", p.max_effort());
    assert_eq!(p.check(), Ok(()));
    let said = |d_reference| Params { d_reference, ..p }.check().unwrap_err().to_string();
    let bound = "below the largest current and leave the motor some torque";
    assert_eq!(said(-5.0), format!("`reference of the current in d` must be {bound}, got -5"), "all of it");
    assert!(said(f64::NAN).ends_with("got NaN"));
    let far = Params { d_reference: 37.0, max_current: 100.0, ..p };
    assert!(far.check().is_err(), "0.545 V·s less 37 A · 15 mH turns the motor round");
    assert_eq!(Params { d_reference: 36.0, ..far }.check(), Ok(()));
}

#[test]
fn errors_name_the_parameter() {
    let good = tuned(2_000.0, 300.0);
    assert_eq!(good.check(), Ok(()));
    let said = |p: Params| p.check().unwrap_err().to_string();
    let weak = MotorEstimate { flux_linkage: 0.0, ..MOTOR };
    assert_eq!(
        said(Params { motor: weak, ..good }),
        "`estimate of the flux linkage` must be above 0 where the d axis has no current that makes torque by different \
         inductances, got 0"
    );
    assert_eq!(said(Params { max_current: -1.0, ..good }), "`largest current` must be positive, got -1");
    assert_eq!(said(Params { max_voltage: f64::NAN, ..good }), "`voltage of the DC link` must be positive, got NaN");
    assert!(Params { gains: Gains::from_bandwidth(&MOTOR, 0.0), ..good }.check().is_err());
}

#[test]
fn the_voltage_meets_the_rotor_one_and_a_half_ticks_later() {
    let p = tuned(2_000.0, 1e6);
    let mut x = State::default();
    let (rotor, omega_e) = (Rotation::default().ahead(0.7), 2_000.0);
    let input = Input { reference: Dq { d: 1.0, q: 2.0 }, current: AlphaBeta::default(), rotor, omega_e };
    let computed = step(&p, &mut x, input, H).computed;
    let met = step(&p, &mut x, input, H).voltage.to_dq(rotor.ahead(1.5 * H * omega_e));
    assert!((met.d - computed.d).abs() < 1e-10 && (met.q - computed.q).abs() < 1e-10, "{met:?} {computed:?}");
}

/// A NaN current stays NaN: a clamp between NaN bounds would panic.
#[test]
fn a_current_that_is_no_number_gives_a_voltage_that_is_none() {
    for (d, q) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::INFINITY, 1.0)] {
        let current = AlphaBeta { alpha: d, beta: q };
        let input = Input { reference: Dq { d: 0.0, q: 5.0 }, current, rotor: Rotation::default(), omega_e: 0.0 };
        let p = tuned(2.0 * core::f64::consts::PI * 500.0, 300.0);
        let mut x = State::default();
        let _: Output = step(&p, &mut x, input, H);
        let then = step(&p, &mut x, input, H).voltage;
        assert!(then.alpha.is_nan() || then.beta.is_nan(), "{d} {q}: {then:?}");
    }
}
