//! Cost of a tick of a motor with each effect: `cargo bench -p servobench-plant --bench effects`.
//!
//! The motor turns at 3000 rpm in ticks of 16 kHz with its powers; `none` is the tick that is solved exactly, the others have one effect each.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_base::{Dq, PowerCommand};
use servobench_plant::pmsm::{
    Cogging, Effects, FluxData, FluxHarmonic, FluxMap, IronLoss, Params, Saturation, Temperature, Temperatures,
    ThermalNetwork,
};
use servobench_plant::{BodyState, PowerStage};

fn main() {
    divan::main();
}

const TICKS: u32 = 4_000;
const H: f64 = 1.0 / 16e3;
const MOTOR: Params = Params {
    electrical_ratio: 4.0,
    resistance: 1.615,
    inductance: Dq { d: 3.485e-3, q: 3.485e-3 },
    flux_linkage: 0.0606,
};

fn ticks(bencher: Bencher<'_, '_>, effects: &Effects) {
    let stage = PowerStage::pmsm(MOTOR, 320.0, 314.0, H).and_then(|stage| stage.with_effects(effects, H));
    let Ok(stage) = stage else { return };
    bencher.counter(ItemsCount::new(TICKS)).bench_local(|| {
        let mut stage = black_box(&stage).clone();
        (0..TICKS).fold(0.0, |sum, k| {
            let motor = BodyState { position: 314.0 * H * f64::from(k), velocity: 314.0 };
            stage.measured_current(motor);
            let voltage = Dq { d: -14.0, q: 80.0 }.to_alpha_beta(stage.rotation().rotation());
            sum + stage.advance(PowerCommand::Voltage(voltage), motor, H)
        })
    });
}

#[divan::bench]
fn a_none(bencher: Bencher<'_, '_>) {
    ticks(bencher, &Effects::default());
}

#[divan::bench]
fn b_cogging(bencher: Bencher<'_, '_>) {
    let cogging = vec![Cogging { ratio: 36.0, amplitude: 0.02, phase: 0.1 }];
    ticks(bencher, &Effects { cogging, ..Effects::default() });
}

#[divan::bench]
fn c_iron(bencher: Bencher<'_, '_>) {
    let iron = Some(IronLoss { speed: 314.0, hysteresis: 6.0, eddy: 10.0 });
    ticks(bencher, &Effects { iron, ..Effects::default() });
}

#[divan::bench]
fn d_flux_harmonic(bencher: Bencher<'_, '_>) {
    let flux_harmonics = vec![FluxHarmonic { order: 6, d: 0.01, q: -0.02, phase: 0.1 }];
    ticks(bencher, &Effects { flux_harmonics, ..Effects::default() });
}

#[divan::bench]
fn e_unequal_phases(bencher: Bencher<'_, '_>) {
    ticks(bencher, &Effects { phase_resistance: Some([1.0, 1.0, 1.1]), ..Effects::default() });
}

#[divan::bench]
fn f_thermal_model(bencher: Bencher<'_, '_>) {
    let network = ThermalNetwork {
        ambient: 30.0,
        to_housing: 0.6,
        to_ambient: 1.1,
        winding_capacity: 60.0,
        housing_capacity: 900.0,
        winding_limit: 155.0,
    };
    let temperature = Some(Temperature {
        reference: 20.0,
        resistance_coefficient: 0.003_93,
        flux_coefficient: -0.0011,
        start: Temperatures { winding: 30.0, housing: 30.0 },
        network: Some(network),
    });
    ticks(bencher, &Effects { temperature, ..Effects::default() });
}

#[divan::bench]
fn g_saturation(bencher: Bencher<'_, '_>) {
    let saturation = Saturation { current: 20.0, share: 0.8, residual: 0.1 };
    let flux_map = FluxMap::curve(&saturation, MOTOR.flux_linkage, MOTOR.inductance).ok();
    ticks(bencher, &Effects { flux_map, ..Effects::default() });
}

/// The same flux linkages by a table.
#[divan::bench]
fn h_flux_map(bencher: Bencher<'_, '_>) {
    let saturation = Saturation { current: 20.0, share: 0.8, residual: 0.1 };
    let Ok(curve) = FluxMap::curve(&saturation, MOTOR.flux_linkage, MOTOR.inductance) else { return };
    let i_d: Vec<f64> = (-10..=5).map(|n| 2.0 * f64::from(n)).collect();
    let i_q: Vec<f64> = (0..=15).map(|n| 2.0 * f64::from(n)).collect();
    let all: Vec<Dq> = i_d.iter().flat_map(|d| i_q.iter().map(|q| curve.flux(Dq { d: *d, q: *q }))).collect();
    let (psi_d, psi_q) = all.iter().map(|psi| (psi.d, psi.q)).unzip();
    let flux_map = FluxMap::table(&FluxData { i_d, i_q, psi_d, psi_q }).ok();
    ticks(bencher, &Effects { flux_map, ..Effects::default() });
}
