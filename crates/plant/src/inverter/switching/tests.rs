use super::*;
use crate::inverter::Modulation;
use proptest::prelude::*;
use servobench_base::ElectricalAngle;
use std::f64::consts::PI;

/// WITTENSTEIN premo 1F on 320 V, made salient.
const MOTOR: pmsm::Params = pmsm::Params {
    electrical_ratio: 4.0,
    resistance: 1.615,
    inductance: Dq { d: 3.1e-3, q: 3.9e-3 },
    flux_linkage: 60.6e-3,
};
const U: f64 = 320.0;
const IDEAL: Params = Params { modulation: Modulation::Switching, carrier: 16e3, ..Params::IDEAL };
const REAL: Params = Params { dead_time: 2.3e-6, device_drop: 0.9, on_resistance: 0.06, ..IDEAL };

/// At constant speed, in ticks of `h` (s), with a voltage of the rotor frame that is renewed every `every` ticks and is exact in the
/// middle of that time. `each` gets tick, current and results.
fn run(
    (p, motor, h): (&Params, &pmsm::Params, f64),
    (start, voltage, omega_e): (Dq, Dq, f64),
    (ticks, every): (u32, u32),
    mut each: impl FnMut(u32, Dq, &Tick),
) {
    let switching = Switching::new(p, motor, h).unwrap();
    let (mut bridge, mut current, mut wanted) = (Bridge::default(), start, AlphaBeta::default());
    for k in 0..ticks {
        let angle = ElectricalAngle(omega_e * h * f64::from(k));
        if k % every == 0 {
            wanted = voltage.to_alpha_beta(angle.ahead(omega_e * h * f64::from(every) / 2.0).rotation());
        }
        let input = Input { wanted, u_dc: U, rotor: angle.rotation(), omega_e };
        let tick = switching.step::<true, _>(switching.equations(), &mut bridge, &mut current, &input);
        each(k, current, &tick);
    }
}

/// Oracle: the same edges by a plain list of times and rails of one period, made here from the duties, the dead time and the sign of
/// the current, with the equations by Runge and Kutta's method of order 4 in many small steps.
#[test]
fn a_period_is_that_of_many_small_steps_between_the_same_edges() {
    for (p, omega) in [(&IDEAL, 700.0), (&REAL, -1300.0), (&REAL, 0.0)] {
        let h = 1.0 / 16e3;
        let start = Dq { d: -1.1, q: 3.3 };
        let (rotor, wanted) = (ElectricalAngle(0.9).rotation(), AlphaBeta { alpha: 57.0, beta: -83.0 });
        let switching = Switching::new(p, &MOTOR, h).unwrap();
        let (mut bridge, mut current) = (Bridge::default(), start);
        let input = Input { wanted, u_dc: U, rotor, omega_e: omega };
        let tick = switching.step::<true, _>(switching.equations(), &mut bridge, &mut current, &input);

        let d = duties(wanted, U).of;
        let at = |i: Dq, t: f64| legs(i.to_alpha_beta(rotor.ahead(omega * t)));
        let mut edges: Vec<(f64, usize, bool)> = (0..3).map(|x| (d[x] * h / 2.0, x, false)).collect();
        edges.extend((0..3).map(|x| (h - d[x] * h / 2.0, x, true)));
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut y, mut t, mut up, mut later) = ([start.d, start.q, 0.0, 0.0, 0.0, 0.0], 0.0, [true; 3], Vec::new());
        let longest = core::cell::Cell::new(start.magnitude());
        let go = |y: &mut [f64; 6], from: f64, to: f64, up: [bool; 3]| {
            let signs = at(Dq { d: y[0], q: y[1] }, from).map(f64::signum);
            let u = vector(core::array::from_fn(|x| if up[x] { U } else { 0.0 } - p.device_drop * signs[x]));
            let steps = ((to - from) / 20e-9).ceil().max(1.0);
            let step = (to - from) / steps;
            let slope = |t: f64, y: &[f64; 6]| {
                let (i, v) = (Dq { d: y[0], q: y[1] }, u.to_dq(rotor.ahead(omega * t)));
                let needed = MOTOR.steady_voltage(i, omega);
                let square = i.d * i.d + i.q * i.q;
                let taken: f64 = (0..3).map(|x| p.device_drop * signs[x] * at(i, t)[x]).sum();
                [
                    (v.d - needed.d - p.on_resistance * i.d) / MOTOR.inductance.d,
                    (v.q - needed.q - p.on_resistance * i.q) / MOTOR.inductance.q,
                    MOTOR.torque(i),
                    square,
                    1.5 * (v.d * i.d + v.q * i.q) - 1.5 * p.on_resistance * square,
                    taken + 1.5 * p.on_resistance * square,
                ]
            };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some thousands")]
            for k in 0..steps as u32 {
                let t = from + step * f64::from(k);
                let ahead = |by: f64, k: &[f64; 6]| core::array::from_fn(|n| y[n] + by * k[n]);
                let k1 = slope(t, y);
                let k2 = slope(t + step / 2.0, &ahead(step / 2.0, &k1));
                let k3 = slope(t + step / 2.0, &ahead(step / 2.0, &k2));
                let k4 = slope(t + step, &ahead(step, &k3));
                *y = core::array::from_fn(|n| y[n] + step / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]));
                longest.set(longest.get().max(y[0].hypot(y[1])));
            }
        };
        while !(edges.is_empty() && later.is_empty()) {
            later.sort_by(|a: &(f64, usize, bool), b| a.0.total_cmp(&b.0));
            let is_later = !later.is_empty() && (edges.is_empty() || later[0].0 <= edges[0].0);
            let (time, x, rail) = if is_later { later.remove(0) } else { edges.remove(0) };
            go(&mut y, t, time, up);
            t = time;
            if is_later || p.dead_time == 0.0 {
                up[x] = rail;
            } else {
                up[x] = at(Dq { d: y[0], q: y[1] }, t)[x] <= 0.0;
                later.push((t + p.dead_time, x, rail));
            }
        }
        go(&mut y, t, h, up);
        // The small steps leave out (20 ns·10⁴/s)⁴; their roundings are some 3000, of 4 A and 200 V.
        let close = |found: f64, expected: f64, scale: f64| {
            assert!((found - expected).abs() < 3e-13 * scale, "{omega}: {found} {expected}");
        };
        close(current.d, y[0], 4.0);
        close(current.q, y[1], 4.0);
        close(tick.torque, y[2] / h, 2.0);
        close(tick.power.copper, 1.5 * MOTOR.resistance * y[3] / h, 30.0);
        close(tick.power.electrical, y[4] / h, 1000.0);
        close(tick.loss, y[5] / h, 10.0);
        close(tick.ripple.rms, (y[3] / h).sqrt(), 4.0);
        close(tick.ripple.peak, longest.get(), 4.0);
    }
}

proptest! {
    /// Oracle: the first law.
    #[test]
    fn electrical_power_is_loss_and_field_and_air_gap(
        d in -200.0..200.0_f64, q in -200.0..200.0_f64, omega in -1500.0..1500.0_f64, ticks in 1..7_u32,
    ) {
        let h = 1.0 / 16e3 / f64::from(ticks);
        run((&REAL, &MOTOR, h), (Dq { d: 2.0, q: -5.0 }, Dq { d, q }, omega), (40, ticks), |_, _, tick| {
            let pmsm::Power { electrical, copper, stored, air_gap, .. } = tick.power;
            let largest = [electrical, copper, stored, air_gap].iter().fold(0.0, |most: f64, one| most.max(one.abs()));
            assert!((electrical - copper - stored - air_gap).abs() <= 1e-12 * largest, "{tick:?}");
        });
    }
}

/// Oracle: the motor on the mean voltage, held over the period. Ticks that are periods, whole parts of them, odd parts, and several periods.
#[test]
fn the_mean_current_is_that_of_the_averaged_inverter() {
    for (carrier, base, every) in [(16e3, 16e3, 1), (16e3, 64e3, 4), (12e3, 36e3, 3), (32e3, 8e3, 1)] {
        let p = Params { carrier, ..IDEAL };
        for omega in [0.0, 900.0] {
            let (wanted, h) = (Dq { d: -3.7, q: 2.9 }, 1.0 / base);
            let (voltage, from) = (MOTOR.steady_voltage(wanted, omega), 2_400);
            let (mut sums, mut averaged) = ([Dq::default(); 2], pmsm::State { current: wanted });
            run((&p, &MOTOR, h), (wanted, voltage, omega), (2 * from, every), |k, i, _| {
                let angle = |k: u32| ElectricalAngle(omega * h * f64::from(k));
                let held = angle(k - k % every).ahead(omega * h * f64::from(every) / 2.0);
                let voltage = voltage.to_alpha_beta(held.rotation());
                pmsm::step(
                    &MOTOR,
                    &mut averaged,
                    pmsm::Input { voltage, rotor: angle(k).rotation(), omega_e: omega },
                    h,
                );
                if k >= from && (k + 1) % every == 0 {
                    for (sum, i) in sums.iter_mut().zip([i, averaged.current]) {
                        *sum = Dq { d: sum.d + i.d, q: sum.q + i.q };
                    }
                }
            });
            let [found, expected] = sums;
            let error = (found.d - expected.d).hypot(found.q - expected.q) / expected.magnitude();
            println!("{carrier} Hz, {base} Hz, {omega} rad/s: {error:.1e}");
            // 0.1 % is required. The pulses are spread over the period, in which the rotor turns: of second order in its angle.
            assert!(error < 1e-3, "{carrier} Hz, {base} Hz, {omega} rad/s: {error}");
        }
    }
}

/// Ripple over 16 periods of the carrier of 16 kHz, in `parts` ticks each: by the ticks' own result, and from the instants at their ends.
fn ripple<W: Winding>(
    p: &Params,
    motor: &pmsm::Params,
    winding: &W,
    (start, voltage, omega): (Dq, Dq, f64),
    parts: u32,
) -> [Ripple; 2] {
    let (periods, h) = (16, 1.0 / 16e3 / f64::from(parts));
    let switching = Switching::new(p, motor, h).unwrap();
    let (mut bridge, mut current, mut wanted) = (Bridge::default(), start, AlphaBeta::default());
    let (mut peaks, mut squares) = ([0.0_f64; 2], [0.0; 2]);
    for k in 0..periods * parts {
        let angle = ElectricalAngle(omega * h * f64::from(k));
        if k % parts == 0 {
            wanted = voltage.to_alpha_beta(angle.ahead(omega * h * f64::from(parts) / 2.0).rotation());
        }
        let input = Input { wanted, u_dc: U, rotor: angle.rotation(), omega_e: omega };
        let Ripple { peak, rms } = switching.step::<true, _>(winding, &mut bridge, &mut current, &input).ripple;
        let instant = current.magnitude();
        peaks = [peaks[0].max(peak), peaks[1].max(instant)];
        squares = [squares[0] + rms * rms, squares[1] + instant * instant];
    }
    [0, 1].map(|n| Ripple { peak: peaks[n], rms: (squares[n] / f64::from(periods * parts)).sqrt() })
}

/// Oracle: the same current at instants 125 ns apart. A tick of one period accounts for the current between its ends: with dead time and
/// thresholds, in field weakening, on a tiny inductance, in iron that saturates, and with a lost phase.
#[test]
fn a_tick_knows_the_ripple_between_its_ends() {
    let weak = pmsm::Params { resistance: 16.0, inductance: Dq { d: 50e-6, q: 50e-6 }, ..MOTOR };
    let idle = pmsm::Params { resistance: 0.4, inductance: Dq { d: 0.2e-3, q: 0.2e-3 }, ..MOTOR };
    let map = pmsm::Saturation { current: 31.0, share: 0.8, residual: 0.1 };
    let effects = pmsm::Effects {
        flux_map: Some(pmsm::FluxMap::curve(&map, MOTOR.flux_linkage, MOTOR.inductance).unwrap()),
        ..pmsm::Effects::default()
    };
    let saturating = pmsm::RealMotor::new(&MOTOR, &effects, 1.0 / 16e3).unwrap();
    let line = AlphaBeta { alpha: 0.0, beta: 1.0 };
    for (name, p, motor, current, omega) in [
        ("ideal", &IDEAL, &MOTOR, Dq { d: 0.0, q: 4.0 }, 800.0),
        ("dead time", &REAL, &MOTOR, Dq { d: 0.0, q: -4.0 }, 300.0),
        ("field weakening", &REAL, &MOTOR, Dq { d: -9.0, q: 2.0 }, 3_000.0),
        ("idle", &IDEAL, &idle, Dq::default(), 1_200.0),
        ("weak", &REAL, &weak, Dq { d: 0.0, q: 3.0 }, 1_000.0),
        ("saturating", &REAL, &MOTOR, Dq { d: 0.0, q: 9.0 }, 500.0),
        ("lost phase", &IDEAL, &MOTOR, Dq { d: 0.0, q: 4.0 }, 700.0),
    ] {
        let way = (current, motor.steady_voltage(current, omega), omega);
        let equations = Equations::new(motor, p.on_resistance);
        let both = [1, 500].map(|parts| match name {
            "saturating" => {
                let winding = saturating.winding(motor, p.on_resistance).unwrap();
                ripple(p, motor, &winding, way, parts)
            }
            "lost phase" => {
                let winding = pmsm::OpenPhase::new(motor, None, p.on_resistance, line);
                ripple(p, motor, &winding, (Dq::default(), way.1, omega), parts)
            }
            _ => ripple(p, motor, &equations, way, parts),
        });
        let [[found, sampled], [_, expected]] = both;
        println!("{name}: {found:.4?}, at ends {sampled:.4?}, of instants {expected:.4?}");
        // Between two instants a current changes by 125 ns·(2/3·320 V)/L, whose largest is missed: half of it in the mean.
        let step = 125e-9 * U / motor.inductance.d;
        assert!(found.peak > expected.peak - 1e-9 && found.peak < expected.peak + step, "{name}: {both:?}");
        assert!((found.rms / expected.rms - 1.0).abs() < 2e-3, "{name}: {both:?}");
    }
}

/// Ripple of the current vector on an inductance alone, with units of one for link voltage, period and inductance: RMS of the vector over
/// a turn and largest peak-to-peak of phase a, from the piecewise voltages of the vectors themselves.
fn integrated(modulation: f64) -> (f64, f64) {
    let (turns, steps) = (720, 4000);
    let (mut square, mut largest): (f64, f64) = (0.0, 0.0);
    for n in 0..turns {
        let angle = 2.0 * PI * (f64::from(n) + 0.5) / f64::from(turns);
        let wanted = [0.0, -2.0 * PI / 3.0, 2.0 * PI / 3.0].map(|phase| 0.5 * modulation * (angle + phase).cos());
        let [most, least] = [f64::max, f64::min].map(|f| wanted.iter().copied().fold(wanted[0], f));
        let d = wanted.map(|u| 0.5 + u - 0.5 * (most + least));
        let (mut i, mut low, mut high) = ([0.0; 2], 0.0_f64, 0.0_f64);
        for k in 0..steps {
            let t = (f64::from(k) + 0.5) / f64::from(steps);
            let up = d.map(|d| f64::from(u8::from((t - 0.5).abs() > 0.5 * (1.0 - d))));
            let level: [f64; 3] = core::array::from_fn(|x| up[x] - wanted[x]);
            let u = [(2.0 * level[0] - level[1] - level[2]) / 3.0, (level[1] - level[2]) / 3.0_f64.sqrt()];
            i = [i[0] + u[0] / f64::from(steps), i[1] + u[1] / f64::from(steps)];
            square += (i[0] * i[0] + i[1] * i[1]) / f64::from(steps) / f64::from(turns);
            (low, high) = (low.min(i[0]), high.max(i[0]));
        }
        largest = largest.max(high - low);
    }
    (square.sqrt(), largest)
}

/// RMS of the ripple's vector: (U_dc·T/L)²·f(M)/288 with f(M) = 3/2·M² − 4√3/π·M³ + (27/16 − 81√3/64π)·M⁴ and the amplitude M·U_dc/2
/// (Holmes & Lipo, *Pulse Width Modulation for Power Converters*; Hava, Kerkman & Lipo, *IEEE Transactions on Power Electronics* 14(1), 1999:
/// the harmonic distortion function of space-vector modulation). The factor 1/288: at small M the flux is a sawtooth of M·U_dc/2·T/4 twice per
/// carrier, of mean square M²·(U_dc·T)²/192 = 3/2·M²·(U_dc·T)²/288.
fn closed_form(m: f64) -> f64 {
    let root = 3.0_f64.sqrt();
    let f = 1.5 * m.powi(2) - 4.0 * root / PI * m.powi(3) + (27.0 / 16.0 - 81.0 * root / (64.0 * PI)) * m.powi(4);
    (f / 288.0).sqrt()
}

/// Oracles: the closed form, and the voltages of the vectors integrated on an inductance. The current besides the ripple is negligible: the
/// voltage is the back-EMF.
#[test]
fn the_ripple_is_that_of_space_vector_modulation() {
    let l = 3.485e-3;
    let (fast, parts) = (16e3, 400);
    for m in [0.31, 0.67, 1.02] {
        let omega = 2.0 * PI * 20.0;
        let amplitude = m * U / 2.0;
        let motor =
            pmsm::Params { resistance: 1e-6, inductance: Dq { d: l, q: l }, flux_linkage: amplitude / omega, ..MOTOR };
        let unit = U / (fast * l);
        // One turn of 800 carriers; sampled 400 times in each, and by the exact mean of squares.
        let (mut square, mut largest, mut low, mut high) = (0.0, 0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
        let ticks = 800 * parts;
        let h = 1.0 / fast / f64::from(parts);
        run((&IDEAL, &motor, h), (Dq::default(), Dq { d: 0.0, q: amplitude }, omega), (ticks, parts), |k, i, tick| {
            square += tick.power.copper / (1.5 * 1e-6) / f64::from(ticks);
            let angle = omega * h * f64::from(k + 1);
            let a = i.d * angle.cos() - i.q * angle.sin();
            (low, high) = (low.min(a), high.max(a));
            if (k + 1) % parts == 0 {
                largest = largest.max(high - low);
                (low, high) = (a, a);
            }
        });
        let (rms, peak_to_peak) = integrated(m);
        let found = square.sqrt() / unit;
        println!("{m}: rms {found} {rms} {}, peak to peak {} {peak_to_peak}", closed_form(m), largest / unit);
        assert!((found / closed_form(m) - 1.0).abs() < 0.01, "{m}: {found} {}", closed_form(m));
        assert!((found / rms - 1.0).abs() < 0.01, "{m}: {found} {rms}");
        assert!((largest / unit / peak_to_peak - 1.0).abs() < 0.01, "{m}: {} {peak_to_peak}", largest / unit);
    }
}

/// Oracle: −t_d·f·U·sgn(i) of each leg, 4/3 of it as a vector; at currents more than twenty times the ripple. Beside it the threshold.
#[test]
fn dead_time_and_threshold_take_what_the_averaged_inverter_takes() {
    let motor = pmsm::Params { inductance: Dq { d: 50e-3, q: 50e-3 }, ..MOTOR };
    for (p, each) in
        [(Params { dead_time: 2.3e-6, ..IDEAL }, 2.3e-6 * 16e3 * U), (Params { device_drop: 1.3, ..IDEAL }, 1.3)]
    {
        for angle in [0.2_f64, 1.3, 2.9, -1.1] {
            let current = Dq { d: 20.0 * angle.cos(), q: 20.0 * angle.sin() };
            let voltage = Dq { d: motor.resistance * current.d, q: motor.resistance * current.q };
            let switching = Switching::new(&p, &motor, 1.0 / 16e3).unwrap();
            let (mut bridge, mut i) = (Bridge::default(), current);
            let wanted = AlphaBeta { alpha: voltage.d, beta: voltage.q };
            let input = Input { wanted, u_dc: U, rotor: Rotation::default(), omega_e: 0.0 };
            // The second period: the first begins without an edge before it.
            switching.step::<true, _>(switching.equations(), &mut bridge, &mut i, &input);
            let tick = switching.step::<true, _>(switching.equations(), &mut bridge, &mut i, &input);
            let [alpha, beta] = [wanted.alpha - tick.voltage.alpha, wanted.beta - tick.voltage.beta];
            let signs = legs(AlphaBeta { alpha: current.d, beta: current.q }).map(|i| each.copysign(i));
            let expected = vector(signs);
            let length = alpha.hypot(beta);
            assert!((length / (4.0 / 3.0 * each) - 1.0).abs() < 1e-9, "{angle}: {length}");
            assert!((alpha - expected.alpha).abs() < 1e-9 && (beta - expected.beta).abs() < 1e-9, "{angle}");
        }
    }
}

/// A pulse as short as the dead time is lost where the diodes lead the current to its rails, and nothing is left over from tick to tick.
#[test]
fn short_pulses_are_lost_and_not_forgotten() {
    let p = Params { dead_time: 3e-6, ..IDEAL };
    // Along −a by nearly all there is: phase a is up for 1 µs of 62.5.
    let d: f64 = 1.0 / 62.5;
    let wanted = AlphaBeta { alpha: -(1.0 - 2.0 * d) * 2.0 / 3.0 * U, beta: 0.0 };
    assert!((duties(wanted, U).of[0] - d).abs() < 1e-12);
    let motor = pmsm::Params { inductance: Dq { d: 1.0, q: 1.0 }, ..MOTOR };
    for (current, up) in [(9.0, 0.0), (-9.0, 1.0 / 62.5 + 3.0 / 62.5)] {
        let switching = Switching::new(&p, &motor, 1.0 / 16e3).unwrap();
        let (mut bridge, mut i) = (Bridge::default(), Dq { d: current, q: 0.0 });
        let input = Input { wanted, u_dc: U, rotor: Rotation::default(), omega_e: 0.0 };
        for _ in 0..3 {
            switching.step::<true, _>(switching.equations(), &mut bridge, &mut i, &input);
        }
        let tick = switching.step::<true, _>(switching.equations(), &mut bridge, &mut i, &input);
        // b and c are down for as long: with the current into them (−a out), their pulses shrink or grow the other way.
        let others = if current > 0.0 { (1.0 - d) + 3.0 / 62.5 } else { (1.0 - d) - 3.0 / 62.5 };
        let expected = 2.0 / 3.0 * U * (up - others.min(1.0));
        assert!((tick.voltage.alpha - expected).abs() < 1e-6 * U, "{current}: {} {expected}", tick.voltage.alpha);
    }
}

#[test]
fn a_carrier_that_does_not_go_with_the_ticks_is_refused() {
    for (carrier, base, fits) in
        [(16e3, 16e3, true), (8e3, 24e3, true), (48e3, 16e3, true), (10e3, 16e3, false), (24e3, 16e3, false)]
    {
        let made = Switching::new(&Params { carrier, ..IDEAL }, &MOTOR, 1.0 / base);
        assert_eq!(made.is_ok(), fits, "{carrier} {base}");
    }
}

/// On processors with wide registers and on any other, to the bit.
#[test]
fn both_kinds_of_processors_give_the_same_tick() {
    let switching = Switching::new(&REAL, &MOTOR, 1.0 / 16e3).unwrap();
    let (mut one, mut other) = ((Bridge::default(), Dq { d: 0.3, q: 2.0 }), (Bridge::default(), Dq { d: 0.3, q: 2.0 }));
    for k in 0..500 {
        let rotor = ElectricalAngle(0.03 * f64::from(k)).rotation();
        let wanted = Dq { d: -20.0, q: 60.0 }.to_alpha_beta(rotor);
        let input = Input { wanted, u_dc: U, rotor, omega_e: 0.03 * 16e3 };
        let ticks = [
            switching.step::<true, _>(switching.equations(), &mut one.0, &mut one.1, &input),
            switching.solved::<true, _>(switching.equations(), &mut other.0, &mut other.1, &input),
        ];
        assert_eq!(ticks[0], ticks[1]);
        assert_eq!((one.1.d.to_bits(), one.1.q.to_bits()), (other.1.d.to_bits(), other.1.q.to_bits()));
    }
}
