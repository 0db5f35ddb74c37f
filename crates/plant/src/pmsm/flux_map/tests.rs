use super::*;
use proptest::prelude::*;

/// Magnet-assisted synchronous reluctance motor of 5.5 kW (Baldor ECS101M0H7EF4), fitted to its measured flux linkages: Lelli, Hinkkanen
/// and Giulii Capponi, "A saturation model based on a simplified equivalent magnetic circuit for permanent magnet machines", 2024, with the
/// parameters of motulator's example of that motor. Currents as functions of flux linkages, the derivatives of an energy.
pub(in crate::pmsm) fn published_current(psi: Dq) -> Dq {
    let (d, q) = (psi.d.abs(), psi.q.abs());
    let own_d = 3.96 + 28.46 * d.powi(4) + 41.52 / 3.0 * d * q.powi(3);
    let own_q = 5.89 + 2.672 * q.powi(6) + 41.52 / 3.0 * d.powi(3) * q;
    let bridge = psi.d - 0.804;
    let square = bridge * bridge + 0.1 * psi.q * psi.q;
    let of_bridge = 81.75 * square / (1.0 + square);
    Dq { d: own_d * psi.d + of_bridge * bridge, q: (own_q + 0.1 * of_bridge) * psi.q }
}

/// The flux linkage of that motor: Newton's method with differences, starting without current.
pub(in crate::pmsm) fn published_flux(i: Dq) -> Dq {
    let mut psi = Dq { d: 0.477, q: 0.0 };
    for step in 1..=20 {
        let share = f64::from(step) / 20.0;
        for _ in 0..8 {
            let at = |d: f64, q: f64| published_current(Dq { d: psi.d + d, q: psi.q + q });
            let (here, e) = (at(0.0, 0.0), 1e-6);
            let by = |a: Dq, b: Dq| [(a.d - b.d) / (2.0 * e), (a.q - b.q) / (2.0 * e)];
            let ([dd, qd], [dq, qq]) = (by(at(e, 0.0), at(-e, 0.0)), by(at(0.0, e), at(0.0, -e)));
            let (off_d, off_q) = (share * i.d - here.d, share * i.q - here.q);
            let determinant = dd * qq - dq * qd;
            psi.d += (qq * off_d - dq * off_q) / determinant;
            psi.q += (dd * off_q - qd * off_d) / determinant;
        }
    }
    psi
}

fn line(from: f64, to: f64, count: u32) -> Vec<f64> {
    (0..count).map(|n| from + (to - from) * f64::from(n) / f64::from(count - 1)).collect()
}

pub(in crate::pmsm) fn sampled(i_d: Vec<f64>, i_q: Vec<f64>, flux: impl Fn(Dq) -> Dq) -> FluxData {
    let all: Vec<Dq> = i_d.iter().flat_map(|d| i_q.iter().map(|q| flux(Dq { d: *d, q: *q }))).collect();
    FluxData { i_d, i_q, psi_d: all.iter().map(|psi| psi.d).collect(), psi_q: all.iter().map(|psi| psi.q).collect() }
}

/// i_d from −20 to 8 A and i_q from 0 to 24 A in `d` and `q` steps.
pub(in crate::pmsm) fn published(d: u32, q: u32) -> FluxMap {
    FluxMap::table(&sampled(line(-20.0, 8.0, d + 1), line(0.0, 24.0, q + 1), published_flux)).unwrap()
}

const SERVO: (f64, Dq) = (0.0606, Dq { d: 3.485e-3, q: 4.1e-3 });

fn curve(current: f64, share: f64, residual: f64) -> FluxMap {
    FluxMap::curve(&Saturation { current, share, residual }, SERVO.0, SERVO.1).unwrap()
}

/// The published motor matches its paper: 0.477 V·s without current, 1.5·p·(ψ_d·i_q − ψ_q·i_d) of its rated torque at its rated
/// current.
#[test]
fn the_published_motor_is_the_published_one() {
    let psi = published_flux(Dq::default());
    assert!((psi.d - 0.477).abs() < 5e-4 && psi.q.abs() < 1e-12, "{psi:?}");
    // 8.8 A effective at 45° give the 29.2 N·m of the rating plate within the 10 % that the angle and the losses leave open.
    let i = Dq { d: -8.8, q: 8.8 };
    let psi = published_flux(i);
    let torque = 3.0 * (psi.d * i.q - psi.q * i.d);
    assert!((torque / 29.2 - 1.0).abs() < 0.1, "{torque} N·m");
}

/// Oracle: the published motor between the nodes of its table. Bicubic: the flux linkages, its derivatives, are of third order.
#[test]
fn between_the_nodes_the_flux_is_that_of_the_published_motor() {
    let points: Vec<Dq> = (0..150)
        .map(|n| {
            let n = f64::from(n);
            Dq { d: -19.3 + 26.0 * (n * 0.618).fract(), q: -23.0 + 46.0 * (n * 0.7549).fract() }
        })
        .collect();
    let error = |map: &FluxMap| {
        let square = |i: &Dq| {
            let (found, expected) = (map.flux(*i), published_flux(*i));
            (found.d - expected.d).powi(2) + (found.q - expected.q).powi(2)
        };
        (points.iter().map(square).sum::<f64>() / points.len() as f64).sqrt()
    };
    let errors = [(14, 12), (28, 24), (56, 48)].map(|(d, q)| error(&published(d, q)));
    let order = (errors[1] / errors[2]).log2();
    println!("RMS errors of steps of 2, 1 and 0.5 A: {errors:?} V·s, observed order {order}");
    // Relative to 1.2 V·s.
    assert!(errors[0] < 2e-3 && errors[1] < 3e-4 && order > 2.5, "{errors:?}, {order}");
}

/// Oracle: differences of the flux linkages, and Simpson's rule along a straight path.
fn is_a_potential(map: &FluxMap, a: Dq, b: Dq, scale: f64) {
    let at = |s: f64| Dq { d: a.d + s * (b.d - a.d), q: a.q + s * (b.q - a.q) };
    // Over lines of the grid the slopes jump: many short steps.
    let n = 2000;
    let along = |s: f64| {
        let psi = map.flux(at(s));
        psi.d * (b.d - a.d) + psi.q * (b.q - a.q)
    };
    let sum: f64 = (0..n)
        .map(|k| {
            let s = |half: u32| f64::from(2 * k + half) / f64::from(2 * n);
            (along(s(0)) + 4.0 * along(s(1)) + along(s(2))) / (6.0 * f64::from(n))
        })
        .sum();
    let (beyond, last) = (map.beyond(a, b), map.flux(b));
    let expected = (b.d - a.d) * last.d + (b.q - a.q) * last.q - sum;
    assert!((beyond - expected).abs() < 1e-7 * scale, "{a:?} {b:?}: {beyond} {expected}");
    let (e, FluxPoint { inductance: Inductance { dd, dq, qq }, .. }) = (1e-6, map.at(b));
    let slope = |d: f64, q: f64| {
        let ends = [-1.0, 1.0].map(|s| map.flux(Dq { d: b.d + s * d, q: b.q + s * q }));
        [(ends[1].d - ends[0].d) / (2.0 * e), (ends[1].q - ends[0].q) / (2.0 * e)]
    };
    let found = [slope(e, 0.0), slope(0.0, e)];
    for (found, expected) in [(found[0][0], dd), (found[0][1], dq), (found[1][0], dq), (found[1][1], qq)] {
        assert!((found - expected).abs() < 1e-6 * (dd + qq), "{b:?}: {found} {expected}");
    }
    assert!(dd > 0.0 && qq > 0.0 && dd * qq > dq * dq, "{b:?}: {dd} {dq} {qq}");
}

proptest! {
    /// The flux linkages are derivatives of one energy, the computed one: within the table, in its frame and behind it. The energies are
    /// about 30 V·s·A.
    #[test]
    fn a_table_is_a_potential(ad in -60.0..50.0_f64, aq in -70.0..70.0_f64, bd in -60.0..50.0_f64, bq in -70.0..70.0_f64) {
        static MAP: std::sync::OnceLock<FluxMap> = std::sync::OnceLock::new();
        is_a_potential(MAP.get_or_init(|| published(9, 7)), Dq { d: ad, q: aq }, Dq { d: bd, q: bq }, 100.0);
    }

    #[test]
    fn a_curve_is_a_potential(
        ad in -200.0..200.0_f64, aq in -200.0..200.0_f64, bd in -200.0..200.0_f64, bq in -200.0..200.0_f64,
        share in 0.5..1.0_f64, residual in 0.0..0.4_f64,
    ) {
        prop_assume!(FluxMap::curve(&Saturation { current: 37.0, share, residual }, SERVO.0, SERVO.1).is_ok());
        is_a_potential(&curve(37.0, share, residual), Dq { d: ad, q: aq }, Dq { d: bd, q: bq }, 100.0);
    }

    /// Around any triangle the field returns the energy that it took, to the rounding.
    #[test]
    fn a_cycle_gives_its_energy_back(all in prop::array::uniform6(-90.0..90.0_f64)) {
        static MAP: std::sync::OnceLock<FluxMap> = std::sync::OnceLock::new();
        for map in [MAP.get_or_init(|| published(9, 7)), &curve(37.0, 0.8, 0.1)] {
            let [a, b, c] = [0, 2, 4].map(|n| Dq { d: all[n], q: all[n + 1] });
            let taken = [map.stored(a, b), map.stored(b, c), map.stored(c, a)];
            let most = taken.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
            prop_assert!(taken.iter().sum::<f64>().abs() < 1e-12 * (most + 10.0), "{taken:?}");
        }
    }

    /// Oracle: the map itself. From the flux linkage back to the current, starting a few amperes off.
    #[test]
    fn the_current_follows_from_the_flux(d in -25.0..12.0_f64, q in -30.0..30.0_f64, off in -2.0..2.0_f64) {
        static MAP: std::sync::OnceLock<FluxMap> = std::sync::OnceLock::new();
        let map = MAP.get_or_init(|| published(28, 24));
        let found = map.current(map.flux(Dq { d, q }), Dq { d: d + off, q: q - off }).unwrap();
        prop_assert!((found.d - d).abs() + (found.q - q).abs() < 1e-12 * 50.0, "{found:?}");
    }
}

/// Oracle: the table itself at its nodes, as read and mirrored.
#[test]
fn at_the_nodes_the_flux_is_that_of_the_table() {
    let data = sampled(vec![-20.0, -13.0, -3.0, 0.0, 7.5], vec![0.0, 2.5, 8.0, 19.0], published_flux);
    let map = FluxMap::table(&data).unwrap();
    for (j, d) in data.i_d.iter().enumerate() {
        for (k, q) in data.i_q.iter().enumerate() {
            for side in [-1.0, 1.0] {
                let psi = map.flux(Dq { d: *d, q: side * q });
                let at = j * data.i_q.len() + k;
                assert!((psi.d - data.psi_d[at]).abs() < 1e-14, "{d} {q}: {psi:?}");
                assert!((side * psi.q - data.psi_q[at]).abs() < 1e-14, "{d} {q}: {psi:?}");
            }
        }
    }
}

/// Oracle: the straight lines. Behind a table too, whatever its steps are.
#[test]
fn a_table_of_constant_inductances_is_linear_everywhere() {
    let linear = |i: Dq| Dq { d: 0.0606 + 3.485e-3 * i.d, q: 4.1e-3 * i.q };
    let map = FluxMap::table(&sampled(vec![-31.0, -7.0, 0.0, 12.0], vec![0.0, 5.0, 40.0], linear)).unwrap();
    for i in [Dq { d: -4.0, q: 3.1 }, Dq { d: 17.0, q: -44.0 }, Dq { d: -900.0, q: 2000.0 }] {
        let (FluxPoint { flux, inductance }, expected) = (map.at(i), linear(i));
        assert!((flux.d - expected.d).abs() < 1e-12 && (flux.q - expected.q).abs() < 1e-12, "{flux:?} {expected:?}");
        let Inductance { dd, dq, qq } = inductance;
        assert!((dd - 3.485e-3).abs() + dq.abs() + (qq - 4.1e-3).abs() < 1e-14, "{inductance:?}");
        let energy = 0.75 * (3.485e-3 * i.d * i.d + 4.1e-3 * i.q * i.q);
        assert!((map.stored(Dq::default(), i) - energy).abs() < 1e-12 * energy, "{energy}");
    }
}

/// A measurement with an error of 0.3 % is smoothed into an energy, and keeps its values at the nodes.
#[test]
fn small_errors_of_a_measurement_are_borne() {
    let noisy = |i: Dq| {
        let psi = published_flux(i);
        let off = |x: f64| 1.0 + 3e-3 * (12.9898 * i.d + 78.233 * i.q + x).sin();
        Dq { d: psi.d * off(0.0), q: psi.q * off(2.0) }
    };
    let data = sampled(line(-20.0, 8.0, 8), line(-24.0, 24.0, 13), noisy);
    let map = FluxMap::table(&data).unwrap();
    let (a, b, c) = (Dq { d: -17.0, q: 3.0 }, Dq { d: 2.0, q: 21.0 }, Dq { d: -9.0, q: -16.0 });
    assert!((map.stored(a, b) + map.stored(b, c) + map.stored(c, a)).abs() < 1e-12);
    let psi = map.flux(Dq { d: data.i_d[3], q: data.i_q[5] });
    assert!((psi.d - data.psi_d[3 * 13 + 5]).abs() < 1e-14, "{psi:?}");
}

/// Very large currents have a flux, and a not-a-number current gives none.
#[test]
fn far_currents_have_a_flux_and_no_number_has_none() {
    let map = published(9, 7);
    for size in [1e3, 1e9, 1e100] {
        for (d, q) in [(1.0, 0.3), (-0.2, 1.0), (-1.0, -1.0), (0.4, -1.0)] {
            let i = Dq { d: size * d, q: size * q };
            let FluxPoint { flux, inductance: Inductance { dd, dq, qq } } = map.at(i);
            assert!(flux.d.is_finite() && flux.q.is_finite() && dd * qq > dq * dq, "{i:?}");
            assert!(map.stored(Dq::default(), i).is_finite(), "{i:?}");
        }
    }
    for i in [Dq { d: f64::NAN, q: 0.0 }, Dq { d: 0.0, q: f64::NAN }] {
        let FluxPoint { flux, .. } = map.at(i);
        assert!(flux.d.is_nan() || flux.q.is_nan(), "{flux:?}");
        assert!(map.stored(Dq::default(), i).is_nan());
    }
    for i in [f64::INFINITY, f64::NEG_INFINITY] {
        let psi = map.flux(Dq { d: i, q: 0.0 });
        assert!(!psi.d.is_finite(), "{psi:?}");
    }
}

/// Oracle: the data sheet from which the curve was made, and the closed form of the torque per ampere.
#[test]
fn a_curve_has_what_the_data_sheet_says() {
    for (current, share, residual) in [(37.0, 0.83, 0.1), (5.0, 0.97, 0.0), (90.0, 0.62, 0.3), (12.0, 1.0, 0.2)] {
        let map = curve(current, share, residual);
        let FluxPoint { flux, inductance } = map.at(Dq::default());
        assert!((flux.d - SERVO.0).abs() < 1e-14 && flux.q == 0.0, "{flux:?}");
        let Inductance { dd, dq, qq } = inductance;
        assert!((dd - SERVO.1.d).abs() < 1e-14 && dq == 0.0 && (qq - SERVO.1.q).abs() < 1e-14, "{inductance:?}");
        let there = map.flux(Dq { d: 0.0, q: current });
        assert!((there.d / SERVO.0 - share).abs() < 1e-9, "{there:?}");
        // The same share of L_q, the flux per ampere, remains.
        assert!((there.q / current / SERVO.1.q - share).abs() < 1e-9, "{there:?}");
    }
    // These magnets saturate the iron so much by themselves that a current cannot saturate it further.
    let none = FluxMap::curve(&Saturation { current: 1.0, share: 0.5, residual: 0.4 }, 0.0606, SERVO.1);
    assert_eq!(none.unwrap_err().name, SaturationParameter::SHARE.name);
    for (saturation, name) in [
        (Saturation { current: 0.0, share: 0.9, residual: 0.1 }, SaturationParameter::CURRENT.name),
        (Saturation { current: 9.0, share: 0.2, residual: 0.1 }, SaturationParameter::SHARE.name),
        (Saturation { current: 9.0, share: 0.9, residual: 1.1 }, SaturationParameter::RESIDUAL.name),
    ] {
        assert_eq!(FluxMap::curve(&saturation, SERVO.0, SERVO.1).unwrap_err().name, name);
    }
}

/// Each mistake by its name, with its place and a remedy.
#[test]
fn what_is_wrong_with_a_table_is_told() {
    use FluxMapError as E;
    let good = || sampled(line(-20.0, 8.0, 8), line(0.0, 24.0, 7), published_flux);
    let found = |change: fn(&mut FluxData)| {
        let mut data = good();
        change(&mut data);
        FluxMap::table(&data).unwrap_err()
    };
    assert!(FluxMap::table(&good()).is_ok());
    let few = found(|data| data.i_d.truncate(2));
    assert_eq!(few, E::Count { which: FluxPart::CurrentD, count: 2 });
    assert_eq!(found(|data| data.psi_q.truncate(9)), E::Size { which: FluxPart::FluxQ, count: 9, expected: 56 });
    assert!(matches!(found(|data| data.psi_d[3] = f64::NAN), E::NotFinite { which: FluxPart::FluxD, .. }));
    assert_eq!(found(|data| data.i_q[3] = 4.0), E::Order { which: FluxPart::CurrentQ, before: 8.0, after: 4.0 });
    let above = |data: &mut FluxData| data.i_d.iter_mut().for_each(|i| *i += 21.0);
    assert_eq!(found(above), E::WithoutZero { which: FluxPart::CurrentD, range: [1.0, 29.0] });
    assert!(matches!(found(|data| data.psi_q[7] = 0.1), E::NoMirror { current: -16.0, .. }));
    let falls = found(|data| data.psi_d.iter_mut().for_each(|psi| *psi = -*psi));
    assert!(
        matches!(falls, E::Falls { which: FluxPart::FluxD, from: [-20.0, -24.0], to: [-16.0, -24.0], .. }),
        "{falls}"
    );
    // Each grows with its own current, but the cross inductances are 0.3 and 0.1 of the others.
    let curl = sampled(line(-3.0, 3.0, 4), line(-3.0, 3.0, 4), |i| Dq { d: i.d + 0.3 * i.q, q: i.q + 0.1 * i.d });
    let curl = FluxMap::table(&curl);
    let curl = curl.unwrap_err();
    assert!(matches!(curl, E::MakesEnergy { curl, d: [-3.0, -1.0], .. } if (curl - 0.2).abs() < 1e-12), "{curl}");
    let said = curl.to_string();
    assert!(
        said.starts_with("the table would generate energy: between i_d = ") && said.ends_with("10 % are allowed"),
        "{said}"
    );
    // Both grow with their own current alone, but not with both at once: L_dq above √(L_d·L_q).
    let coupled = sampled(line(-3.0, 3.0, 4), line(-3.0, 3.0, 4), |i| Dq { d: i.d + 1.1 * i.q, q: i.q + 1.1 * i.d });
    let coupled = FluxMap::table(&coupled).unwrap_err();
    assert!(matches!(coupled, E::NotIncreasing { d: [-3.0, -1.0], q: [-3.0, -1.0], .. }), "{coupled}");
    for error in [few, falls, curl, coupled] {
        assert!(!error.way_out().is_empty(), "{error}");
    }
}

/// The tables of that motor for scenarios and tests: unchanged, without saturation, and with iron that saturates at half of the
/// current. `SERVOBENCH_WRITE_DOCS=1` writes them.
#[test]
fn the_tables_that_are_shipped_are_the_published_motor() {
    let i_d = [-20.0, -17.0, -14.0, -12.0, -10.0, -8.0, -6.0, -4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0, 6.0, 8.0];
    let i_q = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 14.0, 17.0, 20.0, 24.0];
    let magnets = published_flux(Dq::default()).d;
    let at_half = |i: Dq| {
        let psi = published_flux(Dq { d: 2.0 * i.d, q: 2.0 * i.q });
        Dq { d: f64::midpoint(psi.d, magnets), q: psi.q / 2.0 }
    };
    let linear = |i: Dq| {
        let small = published_flux(Dq { d: 1e-3, q: 1e-3 });
        Dq { d: magnets + (small.d - magnets) / 1e-3 * i.d, q: small.q / 1e-3 * i.q }
    };
    let all: [(&str, &dyn Fn(Dq) -> Dq); 3] = [
        ("scenarios/hardware/saturation-table.csv", &published_flux),
        ("tests/scenarios/saturation-doubled.csv", &at_half),
        ("tests/scenarios/saturation-off.csv", &linear),
    ];
    for (file, flux) in all {
        use std::fmt::Write;
        let mut text = "i_d [Apk],i_q [Apk],psi_d [mV s],psi_q [mV s]\n".to_owned();
        for d in i_d {
            for q in i_q {
                let psi = flux(Dq { d, q });
                writeln!(text, "{d},{q},{:.3},{:.3}", psi.d * 1e3, psi.q * 1e3).unwrap();
            }
        }
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
        if std::env::var_os("SERVOBENCH_WRITE_DOCS").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text, "{file}");
    }
}
