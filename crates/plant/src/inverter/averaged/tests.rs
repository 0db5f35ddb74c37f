use super::super::legs::product;
use super::*;
use core::f64::consts::PI;
use servobench_base::ElectricalAngle;

/// 2.3 µs of 62.5 µs on 320 V: 11.776 V of each leg.
const DEAD: Params = Params { carrier: 16e3, dead_time: 2.3e-6, ..Params::IDEAL };
const E: f64 = 2.3e-6 * 16e3 * U;
const U: f64 = 320.0;
const H: f64 = 1.0 / 16e3;

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of ticks")]
fn whole(ticks: f64) -> u32 {
    ticks as u32
}

/// A winding whose current stays where it is.
const HUGE: pmsm::Params =
    pmsm::Params { electrical_ratio: 4.0, resistance: 1e-9, inductance: Dq { d: 1e9, q: 1e9 }, flux_linkage: 1e-9 };

/// Mean voltage and loss of a tick with that current and no voltage.
fn of(p: &Params, i: AlphaBeta) -> Tick {
    let averaged = Averaged::new(p, &HUGE, H);
    let mut current = Dq { d: i.alpha, q: i.beta };
    let input = Input { wanted: AlphaBeta::default(), u_dc: U, rotor: Rotation::default(), omega_e: 0.0 };
    averaged.step::<true, _>(averaged.equations(), &mut current, &input)
}

fn at(angle: f64) -> AlphaBeta {
    AlphaBeta { alpha: 5.0 * angle.cos(), beta: 5.0 * angle.sin() }
}

/// Oracle: the published forms: 4/3 of t_d·f·U as a vector, 4/π of it as the fundamental of a phase.
#[test]
fn vector_and_fundamental_are_the_published_ones() {
    let (steps, mut in_phase, mut in_quadrature) = (7_000, 0.0, 0.0);
    for k in 0..steps {
        let angle = 2.0 * PI * (f64::from(k) + 0.37) / f64::from(steps);
        let taken = of(&DEAD, at(angle)).voltage;
        assert!((taken.alpha.hypot(taken.beta) / (4.0 / 3.0 * E) - 1.0).abs() < 1e-12, "{angle}: {taken:?}");
        in_phase -= 2.0 / f64::from(steps) * (taken.alpha * angle.cos() + taken.beta * angle.sin()) / 2.0;
        in_quadrature += (taken.beta * angle.cos() - taken.alpha * angle.sin()) / f64::from(steps);
    }
    assert!((in_phase / (4.0 / PI * E) - 1.0).abs() < 1e-6, "{in_phase}");
    assert!(in_quadrature.abs() < 1e-3 * E, "{in_quadrature}");
}

/// Oracle: U_T·Σ|i_x| + r·Σ i_x², and nothing by dead time.
#[test]
fn devices_turn_threshold_and_resistance_into_heat() {
    let real = Params { device_drop: 0.9, on_resistance: 0.05, ..DEAD };
    let expected: f64 = legs(at(0.4)).iter().map(|i| 0.9 * i.abs() + 0.05 * i * i).sum();
    let found = of(&real, at(0.4)).loss;
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    assert!(of(&DEAD, at(0.4)).loss.abs() < 1e-15);
}

/// Motors from 16 Ω and 50 µH to 0.02 Ω and 5 mH, with parameters of their inverters.
fn motors() -> Vec<(pmsm::Params, Params, f64, f64)> {
    let motor = |resistance: f64, l: f64, flux_linkage: f64| pmsm::Params {
        electrical_ratio: 4.0,
        resistance,
        inductance: Dq { d: l, q: l },
        flux_linkage,
    };
    let real =
        |dead_time: f64, device_drop: f64, on_resistance: f64| Params { dead_time, device_drop, on_resistance, ..DEAD };
    // With the voltage of the link and the current (A).
    vec![
        (motor(16.0, 50e-6, 0.004), real(2e-6, 0.7, 1.0), 48.0, 0.6),
        (motor(1.0, 20e-6, 0.02), real(1e-6, 0.5, 1.0), 48.0, 3.0),
        (motor(0.36, 0.2e-3, 0.0062), real(2e-6, 0.0, 0.03), 48.0, 4.0),
        (motor(1.615, 3.485e-3, 0.0606), real(2.3e-6, 0.9, 0.06), 320.0, 9.0),
        (motor(0.02, 5e-3, 0.5), real(2e-6, 1.2, 0.004), 560.0, 60.0),
    ]
}

/// Losses of copper and devices and the torque, each a mean over an electrical period, in ticks of 16 kHz over `finer`, on a voltage of the
/// rotor's frame that is renewed with 16 kHz.
fn run((motor, p, u_dc, current): &(pmsm::Params, Params, f64, f64), periods: f64, omega: f64, finer: u32) -> [f64; 3] {
    let h = H / f64::from(finer);
    let averaged = Averaged::new(p, motor, h);
    let (mut i, mut means, mut count) = (Dq { d: 0.0, q: *current }, [0.0; 3], 0.0);
    let ticks = (2.0 * PI * periods / omega / H).round();
    for k in 0..whole(ticks) {
        let begin = omega * H * f64::from(k);
        let wanted =
            wanted(motor, p, *u_dc, *current, omega).to_alpha_beta(ElectricalAngle(begin + omega * H / 2.0).rotation());
        for n in 0..finer {
            let rotor = ElectricalAngle(begin + omega * h * f64::from(n)).rotation();
            let input = Input { wanted, u_dc: *u_dc, rotor, omega_e: omega };
            let tick = averaged.step::<true, _>(averaged.equations(), &mut i, &input);
            if f64::from(k) >= ticks / 2.0 {
                for (mean, one) in means.iter_mut().zip([tick.power.copper, tick.loss, tick.torque]) {
                    *mean += one;
                }
                count += 1.0;
            }
        }
    }
    means.map(|mean| mean / count)
}

/// Voltage for about that current at the speed `omega`.
fn wanted(motor: &pmsm::Params, p: &Params, u_dc: f64, current: f64, omega: f64) -> Dq {
    let error = 4.0 / PI * (p.device_drop + p.dead_time * p.carrier * u_dc);
    let needed = motor.steady_voltage(Dq { d: 0.0, q: current }, omega);
    Dq { d: needed.d, q: needed.q + error + p.on_resistance * current }
}

/// Oracle: steps so short that the winding is its inductance alone, against which three dry frictions act: the currents p without them
/// are drawn to zero by E·dt/L, with the star point where they sum up to zero.
fn tiny_steps(
    (motor, p, u_dc, current): &(pmsm::Params, Params, f64, f64),
    periods: f64,
    omega: f64,
    dt: f64,
) -> [f64; 3] {
    let per_tick = whole((H / dt).round());
    let (dt, l) = (H / f64::from(per_tick), motor.inductance.d);
    let most = dt / l * (p.device_drop + p.dead_time * p.carrier * u_dc);
    let mut i = Dq { d: 0.0, q: *current }.to_alpha_beta(Rotation::default());
    let (mut means, mut count) = ([0.0; 3], 0.0);
    let ticks = (2.0 * PI * periods / omega / H).round();
    for k in 0..whole(ticks) {
        let begin = omega * H * f64::from(k);
        let wanted =
            wanted(motor, p, *u_dc, *current, omega).to_alpha_beta(ElectricalAngle(begin + omega * H / 2.0).rotation());
        for n in 0..per_tick {
            let rotor = ElectricalAngle(begin + omega * dt * (f64::from(n) + 0.5)).rotation();
            let emf = Dq { d: 0.0, q: omega * motor.flux_linkage }.to_alpha_beta(rotor);
            let r = motor.resistance + p.on_resistance;
            // The implicit midpoint rule, without the error.
            let (keep, gain) = ((l / dt - r / 2.0) / (l / dt + r / 2.0), 1.0 / (l / dt + r / 2.0));
            let free = legs(AlphaBeta {
                alpha: keep * i.alpha + gain * (wanted.alpha - emf.alpha),
                beta: keep * i.beta + gain * (wanted.beta - emf.beta),
            });
            let most = most * gain * l / dt;
            let median = -(free[0].max(free[1]).max(free[2]) + free[0].min(free[1]).min(free[2]));
            let star = (0.5 * median).clamp(-most / 3.0, most / 3.0);
            let error = vector(free.map(|p| (p + star).clamp(-most, most)));
            let free = vector(free);
            let next = AlphaBeta { alpha: free.alpha - error.alpha, beta: free.beta - error.beta };
            if f64::from(k) >= ticks / 2.0 {
                let mean =
                    AlphaBeta { alpha: f64::midpoint(i.alpha, next.alpha), beta: f64::midpoint(i.beta, next.beta) };
                let square = mean.alpha * mean.alpha + mean.beta * mean.beta;
                let of_legs = legs(mean);
                means[0] += 1.5 * motor.resistance * square;
                means[1] += p.device_drop * product(of_legs, of_legs.map(f64::signum)) + 1.5 * p.on_resistance * square;
                means[2] += 1.5 * motor.electrical_ratio * motor.flux_linkage * mean.to_dq(rotor).q;
                count += 1.0;
            }
            i = next;
        }
    }
    means.map(|mean| mean / count)
}

/// From a speed at which currents stick at zero for a long time to half of the largest speed on the link.
#[test]
fn losses_and_torque_are_those_of_tiny_steps() {
    for (n, motor) in motors().iter().enumerate() {
        let fastest = motor.2 / 3.0_f64.sqrt() / motor.0.flux_linkage;
        for (periods, omega) in [(1.0, 0.03 * fastest), (4.0, 0.15 * fastest), (8.0, 0.5 * fastest)] {
            let found = run(motor, periods, omega, 1);
            let expected = tiny_steps(motor, periods, omega, 125e-9);
            println!("motor {n} at {omega:.0} rad/s: {found:?} {expected:?}");
            for at in 0..3 {
                assert!(
                    (found[at] / expected[at] - 1.0).abs() < 0.005,
                    "motor {n}, {omega}, {at}: {found:?} {expected:?}"
                );
            }
        }
    }
}

/// The voltage stands for a tick of 16 kHz, which is cut into 1, 2 and 4 parts, against 64: losses and torque of salient motors, too.
#[test]
fn a_tick_is_of_second_order() {
    let mut all = motors();
    let (motor, ..) = &mut all[3];
    motor.inductance = Dq { d: 2.9e-3, q: 4.4e-3 };
    for (n, motor) in all.iter().enumerate() {
        let fastest = motor.2 / 3.0_f64.sqrt() / motor.0.flux_linkage;
        for (periods, share) in [(1.0, 0.03), (4.0, 0.15), (8.0, 0.5)] {
            let exact = run(motor, periods, share * fastest, 64);
            let off = [1, 2, 4].map(|finer| {
                let found = run(motor, periods, share * fastest, finer);
                let off: [f64; 3] = core::array::from_fn(|at| (found[at] / exact[at] - 1.0).abs());
                off
            });
            println!("motor {n} {share}: {off:?}");
            for at in 0..3 {
                // Of a quarter of the tick; a second zero in one tick is of first order and leaves less than 1e-6.
                let part = if at == 2 { 4.0 } else { 14.0 };
                let (coarse, fine) = (off[0][at], off[2][at]);
                assert!(coarse < 5e-3 && (fine < coarse / part || fine < 2e-7), "motor {n}, {share}, {at}: {off:?}");
            }
        }
    }
}
