use super::*;

const NETWORK: ThermalNetwork = ThermalNetwork {
    ambient: 31.0,
    to_housing: 0.62,
    to_ambient: 1.13,
    winding_capacity: 118.0,
    housing_capacity: 1_640.0,
    winding_limit: 155.0,
};

/// Rises above the surroundings after `t` (s) at constant losses from rest: A = V·diag(λ)·V⁻¹ by hand.
fn closed_form(t: f64, copper: f64, iron: f64) -> [f64; 2] {
    let ThermalNetwork { to_housing, to_ambient, winding_capacity, housing_capacity, .. } = NETWORK;
    let [a, b] = [1.0 / (to_housing * winding_capacity), 1.0 / (to_housing * housing_capacity)];
    let c = 1.0 / (to_ambient * housing_capacity);
    // dx/dt = −a·x + a·y, dy/dt = b·x − (b + c)·y about the end; λ² + (a + b + c)·λ + a·c = 0.
    let sum = a + b + c;
    let root = (sum * sum - 4.0 * a * c).sqrt();
    let lambdas = [1.0, -1.0].map(|sign| 0.5 * (sign * root - sum));
    let housing = (copper + iron) * to_ambient;
    let end = [housing + copper * to_housing, housing];
    // Eigenvectors (a, a + λ): at time 0 their sum is −end.
    let [v, w] = lambdas.map(|lambda| a + lambda);
    let second = (-end[1] + end[0] * v / a) / (w - v);
    let first = -end[0] / a - second;
    let [e1, e2] = [first * (lambdas[0] * t).exp(), second * (lambdas[1] * t).exp()];
    [end[0] + a * (e1 + e2), end[1] + v * e1 + w * e2]
}

/// Oracle: the closed form of the step response, at times that do not divide each other; steps from a tick to ten time constants.
#[test]
fn the_step_response_is_exact_whatever_the_step() {
    let (copper, iron) = (57.0, 13.0);
    for (h, steps) in [(1.0 / 16e3, 5_000), (0.37, 700), (41.0, 60), (1.3e3, 9)] {
        let network = ThermalSteps::new(&NETWORK, h);
        let mut now = Temperatures { winding: NETWORK.ambient, housing: NETWORK.ambient };
        for _ in 0..steps {
            now = network.after(now, copper, iron);
        }
        let [winding, housing] = closed_form(h * f64::from(steps), copper, iron);
        // 5000 steps round 31 °C each; the rise after 0.3 s is 0.15 K.
        assert!((now.winding - 31.0 - winding).abs() < 1e-11 + 1e-12 * winding, "{h}: {now:?} {winding}");
        assert!((now.housing - 31.0 - housing).abs() < 1e-11 + 1e-12 * housing, "{h}: {now:?} {housing}");
    }
}

/// Oracle: with a constant current, P = P_ref·(1 + α·(T − T_ref)) in T_w − T_a = P·(R_wh + R_ha) + P_iron·R_ha solved for T_w.
#[test]
fn the_steady_state_grows_with_the_resistance() {
    let temperature = Temperature {
        reference: 20.0,
        resistance_coefficient: COPPER,
        flux_coefficient: -0.0011,
        start: Temperatures { winding: 31.0, housing: 31.0 },
        network: Some(NETWORK),
    };
    let motor = Params {
        electrical_ratio: 4.0,
        resistance: 1.615,
        inductance: servobench_base::Dq { d: 3.5e-3, q: 3.5e-3 },
        flux_linkage: 0.0606,
    };
    let (cold, iron) = (1.5 * 1.615 * 4.3 * 4.3, 9.0);
    let steps = ThermalSteps::new(&NETWORK, 0.5);
    let mut now = temperature.start;
    for _ in 0..80_000 {
        let copper = 1.5 * temperature.motor(&motor, now).resistance * 4.3 * 4.3;
        now = steps.after(now, copper, iron);
    }
    let (whole, outer) = (NETWORK.to_housing + NETWORK.to_ambient, NETWORK.to_ambient);
    let rise = (cold * (1.0 + COPPER * (31.0 - 20.0)) * whole + iron * outer) / (1.0 - cold * COPPER * whole);
    // 40 000 s are 20 of the slowest time constants, which the feedback makes twice as long.
    assert!((now.winding - 31.0 - rise).abs() < 1e-3, "{now:?}: {rise} K");
    let hot = temperature.motor(&motor, now);
    assert!((hot.flux_linkage / 0.0606 - (1.0 - 0.0011 * (now.housing - 20.0))).abs() < 1e-14);
    assert!(rise > 1.2 * (cold * whole + iron * outer), "{rise}: the feedback is what is tested");
}

#[test]
fn a_temperature_at_which_nothing_is_left_is_refused() {
    let good = Temperature {
        reference: 20.0,
        resistance_coefficient: COPPER,
        flux_coefficient: -0.0011,
        start: Temperatures { winding: 80.0, housing: 60.0 },
        network: None,
    };
    assert_eq!(good.check(), Ok(()));
    let wrong = [
        Temperature { flux_coefficient: -0.03, ..good },
        Temperature { resistance_coefficient: -0.001, ..good },
        Temperature { start: Temperatures { winding: 501.0, ..good.start }, ..good },
        Temperature { network: Some(ThermalNetwork { to_ambient: 0.0, ..NETWORK }), ..good },
    ];
    for wrong in wrong {
        assert!(wrong.check().is_err(), "{wrong:?}");
    }
}
