pub(super) mod runs;

use super::*;
use proptest::prelude::*;
use runs::runge_kutta;
use servobench_base::ElectricalAngle;
use std::f64::consts::PI;

/// Saarakkala/Hinkkanen, 2.2 kW.
const MOTOR: Params =
    Params { electrical_ratio: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };

/// Runs at constant speed with a voltage that is constant in the rotor frame, and returns current and last torque.
fn run(p: &Params, omega_e: f64, voltage: Dq, h: f64, ticks: u32) -> (Dq, f64) {
    let mut x = State::default();
    let mut torque = 0.0;
    for k in 0..ticks {
        let theta = ElectricalAngle(omega_e * f64::from(k) * h);
        // Held in the stator frame at the angle of the middle of the tick, as a drive with compensation does.
        let voltage = voltage.to_alpha_beta(theta.ahead(omega_e * h / 2.0).rotation());
        torque = step(p, &mut x, Input { voltage, rotor: theta.rotation(), omega_e }, h);
    }
    (x.current, torque)
}

/// Oracle: at standstill i(t) = u/R·(1 − e^(−t·R/L)) in each axis.
#[test]
fn at_standstill_each_axis_is_a_first_order_lag() {
    let h = 1.0 / 16_000.0;
    let (i, _) = run(&MOTOR, 0.0, Dq { d: 10.0, q: 20.0 }, h, 160);
    let lag = |u: f64, l: f64| u / 3.6 * (1.0 - (-0.01 * 3.6 / l).exp());
    // 160 ticks round 3 A a few times each.
    assert!((i.d - lag(10.0, 36e-3)).abs() < 1e-12 && (i.q - lag(20.0, 51e-3)).abs() < 1e-12, "{i:?}");
}

/// Oracle: the Modelica Standard Library's `SM_PermanentMagnet` at 100 V, 100 A (RMS), 1500 rpm: 181.4 N·m, rotor
/// angle 20.75°, power factor 0.98; p = 2, R = 0.03 Ω, X = 0.4 Ω at 50 Hz, E = 112.3 V RMS.
#[test]
fn the_modelica_machine_gives_its_published_torque() {
    let omega = 2.0 * PI * 50.0;
    let l = 0.4 / omega;
    let p = Params {
        electrical_ratio: 2.0,
        resistance: 0.03,
        inductance: Dq { d: l, q: l },
        flux_linkage: 112.3 * 2.0_f64.sqrt() / omega,
    };
    let (angle, u) = (20.756_f64.to_radians(), 100.0 * 2.0_f64.sqrt());
    let voltage = Dq { d: -u * angle.sin(), q: u * angle.cos() };
    // L/R = 42 ms: after 1 s the transient is below 1e-10.
    let (i, torque) = run(&p, omega, voltage, 1.0 / 64_000.0, 64_000);
    assert!((torque - 181.44).abs() < 0.1, "published to 4 digits, the angle to 5: {torque}");
    assert!((i.magnitude() / 2.0_f64.sqrt() - 100.0).abs() < 0.1, "{i:?}");
    let power = 1.5 * (voltage.d * i.d + voltage.q * i.q);
    let factor = power / (1.5 * u * i.magnitude());
    assert!((factor - 0.98004).abs() < 2e-4, "{factor}");
}

/// Oracle: the steady state of the equations themselves, for any tick: here one of 40 time constants.
#[test]
fn the_steady_state_is_exact_and_stable_for_a_tick_far_beyond_the_time_constant() {
    let p = Params { inductance: Dq { d: 1e-6, q: 2e-6 }, ..MOTOR };
    let (i, _) = run(&p, 0.0, Dq { d: 10.0, q: 20.0 }, 20e-6, 2_000);
    assert!((i.d - 10.0 / 3.6).abs() < 1e-12 && (i.q - 20.0 / 3.6).abs() < 1e-12, "{i:?}");
}

/// Salient, round (Teknic M-2310P at 8 kHz), nearly without resistance, and over-damped: L/R far below the tick.
fn motors() -> [(Params, f64); 4] {
    let round =
        Params { electrical_ratio: 4.0, resistance: 0.36, inductance: Dq { d: 2e-4, q: 2e-4 }, flux_linkage: 6.395e-3 };
    let fast = Params { inductance: Dq { d: 1e-6, q: 2e-6 }, ..MOTOR };
    let lossless = Params { resistance: 1e-9, ..MOTOR };
    [(MOTOR, 1.0 / 12_000.0), (round, 1.0 / 8_000.0), (lossless, 1.0 / 20_000.0), (fast, 20e-6)]
}

/// A start that is not a steady state, and a voltage about the back-EMF.
fn start(p: &Params, omega_e: f64) -> (State, Input) {
    let rotor = ElectricalAngle(0.7).rotation();
    let voltage = Dq { d: -7.0, q: 11.0 + omega_e * p.flux_linkage }.to_alpha_beta(rotor);
    (State { current: Dq { d: -1.3, q: 2.4 } }, Input { voltage, rotor, omega_e })
}

/// Oracle: the equations in stator coordinates by Runge and Kutta's method of order 4, with the means as
/// further states: current at the end; means of torque, copper and electrical power.
fn by_runge_kutta(p: &Params, x: &State, u: &Input, h: f64, steps: u32) -> [f64; 5] {
    let slope = |t: f64, y: [f64; 5]| {
        let (i, v) = (Dq { d: y[0], q: y[1] }, u.voltage.to_dq(u.rotor.ahead(u.omega_e * t)));
        let needed = p.steady_voltage(i, u.omega_e);
        [
            (v.d - needed.d) / p.inductance.d,
            (v.q - needed.q) / p.inductance.q,
            p.torque(i) / h,
            1.5 * p.resistance * (i.d * i.d + i.q * i.q) / h,
            1.5 * (v.d * i.d + v.q * i.q) / h,
        ]
    };
    runge_kutta([x.current.d, x.current.q, 0.0, 0.0, 0.0], h, steps, slope)
}

fn found(x: &State, output: &Output) -> [f64; 5] {
    [x.current.d, x.current.q, output.torque, output.power.copper, output.power.electrical]
}

/// Turns of a rotor in a tick (rad): none, slow, usual, fast, in parts of a tick, and beyond the table.
const TURNS: [f64; 9] = [0.0, 1e-7, 0.02, -0.14, 0.4, -0.5, 1.9, 6.1, -9.0];

fn stepped(ticks: &Ticks, x: &mut State, u: &Input) -> Output {
    let mut power = Power::default();
    Output { torque: ticks.step_with_power(x, u, &mut power), power }
}

#[test]
fn a_tick_at_constant_speed_is_exact() {
    for (p, h) in motors() {
        let ticks = Ticks::new(p, h);
        for turn in TURNS {
            let (before, u) = start(&p, turn / h);
            // The change in a step of the oracle is below 0.005, of which it leaves out (0.005)⁴/120.
            let oracle = by_runge_kutta(&p, &before, &u, h, 16_384);
            let (mut x, mut y) = (before, before);
            let ours = stepped(&ticks, &mut x, &u);
            let others = step_with_power(&p, &mut y, u, h);
            let (ours, others) = (found(&x, &ours), found(&y, &others));
            for (ours, exact) in ours.into_iter().chain(others).zip(oracle.into_iter().chain(oracle)) {
                // Relative to the current that the voltage alone would make in the tick, or through the resistance.
                let through = 1.0 / (p.resistance + p.inductance.d / h);
                let current = 3.0 + (20.0 + (turn / h * p.flux_linkage).abs()) * through;
                let scale = exact.abs().max(current);
                assert!((ours - exact).abs() < 1e-11 * scale, "{p:?} {turn}: {ours} {exact}");
            }
        }
    }
}

/// Oracle: 256 ticks of a 256th.
#[test]
fn a_tick_is_that_of_256_finer_ones() {
    for (p, h) in motors() {
        let (coarse, fine) = (Ticks::new(p, h), Ticks::new(p, h / 256.0));
        for turn in TURNS {
            let (before, u) = start(&p, turn / h);
            let (mut x, mut y, mut torque) = (before, before, 0.0);
            let ours = coarse.step(&mut x, &u);
            for k in 0..256 {
                let rotor = u.rotor.ahead(turn * f64::from(k) / 256.0);
                torque += fine.step(&mut y, &Input { rotor, ..u }) / 256.0;
            }
            let (x, y) = (x.current, y.current);
            let scale = x.magnitude() + before.current.magnitude();
            assert!(
                (x.d - y.d).abs() < 1e-11 * scale && (x.q - y.q).abs() < 1e-11 * scale,
                "{p:?} {turn}: {x:?} {y:?}"
            );
            let most = 1.5 * p.electrical_ratio * p.flux_linkage * scale;
            assert!((ours - torque).abs() < 1e-11 * most.max(torque.abs()), "{p:?} {turn}: {ours} {torque}");
        }
    }
}

proptest! {
    /// Oracle: the first law.
    #[test]
    fn no_power_is_lost(
        resistance in 1e-3..50.0_f64,
        (d, q) in (5e-5..5e-2_f64, 0.3..3.0_f64),
        flux_linkage in 1e-3..1.0_f64,
        turn in -0.5..0.5_f64,
        (i_d, i_q, u_d, u_q) in (-20.0..20.0_f64, -20.0..20.0_f64, -50.0..50.0_f64, -50.0..50.0_f64),
    ) {
        let h = 1.0 / 12_000.0;
        let p = Params { electrical_ratio: 5.0, resistance, inductance: Dq { d, q: d * q }, flux_linkage };
        let rotor = ElectricalAngle(-1.1).rotation();
        let voltage = Dq { d: u_d, q: u_q + turn / h * flux_linkage }.to_alpha_beta(rotor);
        let (mut x, input) = (State { current: Dq { d: i_d, q: i_q } }, Input { voltage, rotor, omega_e: turn / h });
        let Power { electrical, copper, stored, air_gap, .. } = stepped(&Ticks::new(p, h), &mut x, &input).power;
        let largest = [electrical, copper, stored, air_gap].into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        prop_assert!((electrical - copper - stored - air_gap).abs() < 1e-12 * largest,
            "{electrical} {copper} {stored} {air_gap}");
        prop_assert!(copper >= 0.0);
    }
}

/// A tick of 72 time constants with the powers, and at the end a tick at rest without inputs: exact zeros.
#[test]
fn nothing_in_is_nothing_out() {
    for (p, h) in motors() {
        let input = Input { voltage: AlphaBeta::default(), rotor: Rotation::default(), omega_e: 0.0 };
        let mut x = State::default();
        assert_eq!(stepped(&Ticks::new(p, h), &mut x, &input), Output::default(), "{p:?}");
        assert_eq!(x, State::default());
    }
}

#[test]
fn a_speed_that_is_no_number_gives_none() {
    for omega_e in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        let (mut x, u) = start(&MOTOR, 0.0);
        let torque = Ticks::new(MOTOR, 1e-4).step(&mut x, &Input { omega_e, ..u });
        assert!(torque.is_nan() && x.current.d.is_nan() && x.current.q.is_nan(), "{omega_e}: {torque} {x:?}");
    }
}

/// Under constant acceleration, with the mean speed of each tick: against a finer tick the error of the current falls
/// by four when the tick is halved.
#[test]
fn a_tick_in_which_the_speed_changes_is_of_second_order() {
    let (omega, acceleration) = (800.0, 4e5);
    let end = |n: u32| {
        let (h, mut x) = (2e-3 / f64::from(n), State::default());
        let ticks = Ticks::new(MOTOR, h);
        for k in 0..n {
            let t = f64::from(k) * h;
            let voltage = AlphaBeta { alpha: 60.0, beta: 90.0 };
            let rotor = ElectricalAngle(omega * t + acceleration * t * t / 2.0).rotation();
            ticks.step(&mut x, &Input { voltage, rotor, omega_e: omega + acceleration * (t + h / 2.0) });
        }
        x.current.q
    };
    let exact = end(4096);
    let order = ((end(16) - exact) / (end(32) - exact)).log2();
    assert!((order - 2.0).abs() < 0.1, "observed order {order}");
}

/// Oracle: the vector, shortened by its mean over the tick.
#[test]
fn the_voltage_of_the_middle_is_the_mean_but_for_its_length() {
    let (_, u) = start(&MOTOR, 1_500.0);
    let (h, count) = (1.0 / 4_000.0, 10_000);
    let middle = u.voltage_at_middle(h);
    let half = 1_500.0 * h / 2.0;
    let mut mean = Dq::default();
    for k in 0..count {
        let met = u.voltage.to_dq(u.rotor.ahead(2.0 * half * (f64::from(k) + 0.5) / f64::from(count)));
        mean = Dq { d: mean.d + met.d / f64::from(count), q: mean.q + met.q / f64::from(count) };
    }
    let sinc = half.sin() / half;
    // The sum of 10 000 midpoints leaves out half²/6e8 of 1 kV.
    assert!((mean.d - sinc * middle.d).abs() < 1e-6 && (mean.q - sinc * middle.q).abs() < 1e-6, "{mean:?} {middle:?}");
}

/// Processors with and without wide registers give the same bits, at every speed and number of terms.
#[test]
fn both_kinds_of_processors_give_the_same_bits() {
    let (ticks, mut random) = (Ticks::new(MOTOR, 1.0 / 16_000.0), servobench_testkit::Random::seeded(19));
    for k in 0..4000 {
        let mut signed = |size: f64| size * random.signed();
        // Up to the limit of the table, and beyond.
        let omega_e = signed([300.0, 1000.0, 2500.0, 6000.0, 50_000.0][k % 5]);
        let current = Dq { d: signed(20.0), q: signed(20.0) };
        let voltage = AlphaBeta { alpha: signed(300.0), beta: signed(300.0) };
        let input = Input { voltage, rotor: ElectricalAngle(signed(9.0)).rotation(), omega_e };
        let (mut here, mut in_any) = (State { current }, State { current });
        let (with, mut power) = (stepped(&ticks, &mut here, &input), Power::default());
        let any = Output { torque: ticks.solved_with_power(&mut in_any, &input, &mut power), power };
        let bits = |output: Output, state: State| {
            let Output { torque, power: Power { electrical, copper, iron, stored, air_gap } } = output;
            [torque, electrical, copper, iron, stored, air_gap, state.current.d, state.current.q].map(f64::to_bits)
        };
        assert_eq!(bits(with, here), bits(any, in_any), "{input:?}");
        let (mut here, mut in_any) = (State { current }, State { current });
        let (with, any) = (ticks.step(&mut here, &input), ticks.solved_without_power(&mut in_any, &input));
        assert_eq!((with.to_bits(), here), (any.to_bits(), in_any), "{input:?}");
    }
}
