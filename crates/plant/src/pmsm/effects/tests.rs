use super::*;
use crate::inverter;
use crate::mechanics::BodyState;
use crate::pmsm::{Params, Power, Saturation, ThermalNetwork};
use crate::power_stage::PowerStage;
use servobench_base::{AlphaBeta, Dq, PowerCommand};

/// Saarakkala/Hinkkanen, 2.2 kW.
const MOTOR: Params =
    Params { electrical_ratio: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };
const H: f64 = 1.0 / 16e3;

fn with_cogging() -> Effects {
    Effects { cogging: vec![Cogging { ratio: 36.0, amplitude: 0.2, phase: 0.3 }], ..Effects::default() }
}

fn stage(effects: &Effects) -> PowerStage {
    PowerStage::pmsm(MOTOR, 540.0, 37.0, H).and_then(|stage| stage.with_effects(effects, H)).unwrap()
}

/// Effort, powers and current of 200 ticks with a voltage and a speed that change, off in the middle of them.
fn ticks(mut stage: PowerStage) -> Vec<[f64; 7]> {
    let mut position = 0.4;
    let ticks = (0..200).map(|k| {
        let t = f64::from(k) * H;
        let motor = BodyState { position, velocity: 37.0 + 900.0 * t };
        position += motor.velocity * H;
        stage.measured_current(motor);
        let voltage = AlphaBeta { alpha: 60.0 * (700.0 * t).cos(), beta: 80.0 };
        let command = if (90..100).contains(&k) { PowerCommand::Off } else { PowerCommand::Voltage(voltage) };
        let effort = stage.advance(command, motor, H);
        let Power { electrical, copper, iron, stored, air_gap } = stage.power();
        assert_eq!(iron.to_bits(), 0.0_f64.to_bits(), "nothing here has iron");
        [effort, electrical, copper, stored, air_gap, stage.current().d, stage.current().q]
    });
    ticks.collect()
}

fn bits(all: &[[f64; 7]]) -> Vec<[u64; 7]> {
    all.iter().map(|tick| tick.map(f64::to_bits)).collect()
}

#[test]
fn without_effects_the_bits_are_those_of_a_motor_that_never_heard_of_them() {
    let plain = PowerStage::pmsm(MOTOR, 540.0, 37.0, H).unwrap();
    assert_eq!(bits(&ticks(plain)), bits(&ticks(stage(&Effects::default()))));
}

/// Cogging leaves the currents unchanged: only the effort differs, by the closed form; and no power is lost.
#[test]
fn cogging_acts_on_the_rotor_and_not_on_the_currents() {
    let (plain, real) = (ticks(stage(&Effects::default())), ticks(stage(&with_cogging())));
    let mut position = 0.4;
    for (k, (plain, real)) in plain.iter().zip(&real).enumerate() {
        assert_eq!(bits(&[*plain])[0][5..], bits(&[*real])[0][5..], "tick {k}");
        let velocity = 37.0 + 900.0 * k as f64 * H;
        // Extrapolated from the last two ticks; before the first one the speed was constant.
        let travel = (velocity + if k == 0 { 0.0 } else { 450.0 * H }) * H;
        let expected = with_cogging().cogging[0].mean_effort(position, travel);
        assert!((real[0] - plain[0] - expected).abs() < 1e-13 * 60.0, "tick {k}: {} {expected}", real[0] - plain[0]);
        position += velocity * H;
        let [_, electrical, copper, stored, air_gap, ..] = *real;
        let largest = [electrical, copper, stored, air_gap].into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        assert!((electrical - copper - stored - air_gap).abs() < 1e-12 * largest, "tick {k}: {real:?}");
    }
}

/// Oracle: a rotor alone in the field of its teeth is a pendulum of the energy J·v²/2 + F/κ·cos(κ·x + φ). Its effort is constant over
/// a tick, at a linearly extrapolated speed. The energy error of that is of third order, and a loss: nothing grows.
#[test]
fn a_rotor_that_swings_in_its_cogging_keeps_its_energy() {
    let cogging = Cogging { ratio: 36.0, amplitude: 0.2, phase: 0.3 };
    let inertia = 2e-3;
    let lost = |ticks: u32| {
        let h = 1.0 / f64::from(ticks);
        let mut stage = PowerStage::pmsm(MOTOR, 540.0, 0.0, h)
            .and_then(|stage| stage.with_effects(&Effects { cogging: vec![cogging], ..Effects::default() }, h))
            .unwrap();
        let mut motor = BodyState { position: 0.02, velocity: 0.0 };
        let energy = |motor: BodyState| {
            inertia * motor.velocity * motor.velocity / 2.0
                + cogging.amplitude / cogging.ratio * (cogging.ratio * motor.position + cogging.phase).cos()
        };
        let begun = energy(motor);
        for _ in 0..ticks {
            let acceleration = stage.advance(PowerCommand::Off, motor, h) / inertia;
            motor.position += h * (motor.velocity + h * acceleration / 2.0);
            motor.velocity += h * acceleration;
        }
        // Relative to the swing, 0.2/36·(1 + cos(0.02·36 + 0.3)) J.
        (energy(motor) - begun) / (cogging.amplitude / cogging.ratio * 1.523)
    };
    let lost = [4_000, 8_000].map(lost);
    let order = (lost[0] / lost[1]).log2();
    assert!((order - 3.0).abs() < 0.1 && (-1e-5..0.0).contains(&lost[1]), "observed order {order}, {lost:?}");
}

/// All effects at once.
fn all() -> Effects {
    Effects {
        cogging: with_cogging().cogging,
        flux_harmonics: vec![FluxHarmonic { order: 6, d: 0.012, q: -0.027, phase: 0.7 }],
        iron: Some(IronLoss { speed: 157.0, hysteresis: 31.0, eddy: 47.0 }),
        phase_resistance: Some([1.0, 0.97, 1.08]),
        temperature: Some(WARMING),
        flux_map: None,
    }
}

/// A winding of such a small heat capacity that it warms up in a tenth of a second.
const WARMING: Temperature = Temperature {
    reference: 20.0,
    resistance_coefficient: 0.003_93,
    flux_coefficient: -0.0011,
    start: Temperatures { winding: 71.0, housing: 43.0 },
    network: Some(ThermalNetwork {
        ambient: 31.0,
        to_housing: 0.62,
        to_ambient: 1.13,
        winding_capacity: 0.4,
        housing_capacity: 9.0,
        winding_limit: 155.0,
    }),
};

fn saturated() -> FluxMap {
    let saturation = Saturation { current: 12.0, share: 0.8, residual: 0.1 };
    FluxMap::curve(&saturation, MOTOR.flux_linkage, MOTOR.inductance).unwrap()
}

/// Oracle: the first law, with the power on and off, whatever is switched on.
#[test]
fn no_power_is_lost_whatever_is_switched_on() {
    let cases = [
        Effects { iron: all().iron, ..Effects::default() },
        Effects { iron: all().iron, temperature: all().temperature, ..Effects::default() },
        all(),
        Effects { flux_map: Some(saturated()), ..Effects::default() },
        Effects { flux_map: Some(saturated()), ..all() },
        Effects { flux_map: Some(crate::pmsm::flux_map::tests::published(14, 12)), ..all() },
    ];
    for effects in cases {
        let (mut stage, mut position) = (stage(&effects), 0.4);
        for k in 0..400 {
            let velocity = 37.0 - 0.3 * f64::from(k);
            let motor = BodyState { position, velocity };
            position += velocity * H;
            stage.measured_current(motor);
            let voltage = Dq { d: -20.0, q: 90.0 }.to_alpha_beta(stage.rotation().rotation());
            let is_off = (200..210).contains(&k);
            let command = if is_off { PowerCommand::Off } else { PowerCommand::Voltage(voltage) };
            let effort = stage.advance(command, motor, H);
            let Power { electrical, copper, iron, stored, air_gap } = stage.power();
            let terms = [electrical, copper, iron, stored, air_gap];
            let largest = terms.into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
            // Off and without current, all are zero where nothing loses.
            assert!((electrical - copper - iron - stored - air_gap).abs() <= 1e-12 * largest, "tick {k}: {terms:?}");
            let is_lossy = effects.iron.is_some();
            assert!(iron >= 0.0 && copper >= 0.0, "tick {k}: {terms:?}");
            assert!(!is_lossy || iron > 0.0 || velocity.abs() < 0.5, "tick {k}: {terms:?}");
            // The last two ticks give the speed: 0.3 rad/s less in each.
            let speed = if k == 0 { velocity } else { velocity - 0.15 };
            assert!((air_gap - effort * speed).abs() <= 1e-12 * largest, "tick {k}");
        }
    }
}

/// Oracle: the plain motor with the resistance and the flux linkage of those temperatures, bit for bit: a tick costs no more.
#[test]
fn a_temperature_that_stays_is_another_motor() {
    let temperature = Temperature { network: None, ..WARMING };
    let effects = Effects { temperature: Some(temperature), ..Effects::default() };
    let resistance = 3.6 * (1.0 + 0.003_93 * (71.0 - 20.0));
    let flux_linkage = 0.545 * (1.0 - 0.0011 * (43.0 - 20.0));
    let warm = PowerStage::pmsm(Params { resistance, flux_linkage, ..MOTOR }, 540.0, 37.0, H).unwrap();
    assert_eq!(bits(&ticks(stage(&effects))), bits(&ticks(warm)));
}

/// Oracle: a rotor held at rest on a constant voltage u along d: at the end R = R_ref·(1 + α·(T_w − T_ref)), P = 3/2·u²/R,
/// T_w − T_a = P·(R_wh + R_ha), a quadratic equation for T_w. With less resistance at 0 it has another solution, which is the run that
/// must fail.
#[test]
fn a_winding_on_a_constant_voltage_comes_to_rest_where_its_loss_is() {
    let network = WARMING.network.unwrap();
    let ends = [0.003_93, 0.0].map(|resistance_coefficient| {
        let temperature = Temperature { resistance_coefficient, ..WARMING };
        let effects = Effects { temperature: Some(temperature), ..Effects::default() };
        let mut stage = stage(&effects);
        let rest = BodyState { position: 0.0, velocity: 0.0 };
        // Speed 37 a tick before time 0 is of the first tick alone. 160 s: 13 of the slowest time constants.
        let mut stage_at_rest = |ticks: u32| {
            for _ in 0..ticks {
                stage.measured_current(rest);
                stage.advance(PowerCommand::Voltage(AlphaBeta { alpha: 17.0, beta: 0.0 }), rest, H);
            }
            (stage.temperatures(), stage.power().copper)
        };
        let (_, cold) = stage_at_rest(400);
        let (end, hot) = stage_at_rest(160 * 16_000);
        (end, cold, hot)
    });
    let whole = network.to_housing + network.to_ambient;
    let expected = |alpha: f64| {
        // x·(1 + α·(T_a − T_ref) + α·x) = P_ref·whole
        let (linear, power) = (1.0 + alpha * (network.ambient - 20.0), 1.5 * 17.0 * 17.0 / 3.6 * whole);
        if alpha == 0.0 { power } else { ((linear * linear + 4.0 * alpha * power).sqrt() - linear) / (2.0 * alpha) }
    };
    for (alpha, (end, ..)) in [0.003_93, 0.0].into_iter().zip(ends) {
        let rise = end.winding - network.ambient;
        // e⁻¹³ of the start, 2e-6 of 40 K.
        assert!((rise - expected(alpha)).abs() < 1e-3, "{alpha}: {end:?} {}", expected(alpha));
    }
    let [(_, cold, hot), _] = ends;
    assert!(hot < 0.9 * cold, "the loss falls as the winding warms up: {cold} W, {hot} W");
    assert!(expected(0.0) > 1.3 * expected(0.003_93));
}

/// A copy has a separate state: it continues in the same way, bit for bit.
#[test]
fn a_copy_goes_on_as_the_original_does() {
    let mut original = stage(&all());
    let mut position = 0.0;
    let advance = |stage: &mut PowerStage, position: f64| {
        let motor = BodyState { position, velocity: 29.0 };
        stage.measured_current(motor);
        let effort = stage.advance(PowerCommand::Voltage(AlphaBeta { alpha: 70.0, beta: -20.0 }), motor, H);
        let Temperatures { winding, housing } = stage.temperatures();
        [effort, winding, housing, stage.current().q].map(f64::to_bits)
    };
    for _ in 0..77 {
        advance(&mut original, position);
        position += 29.0 * H;
    }
    let mut copy = original.clone();
    for _ in 0..77 {
        assert_eq!(advance(&mut original, position), advance(&mut copy, position));
        position += 29.0 * H;
    }
}

#[test]
fn what_is_out_of_its_bound_is_refused_by_name() {
    let stage =
        |effects: &Effects| PowerStage::pmsm(MOTOR, 540.0, 0.0, H).and_then(|stage| stage.with_effects(effects, H));
    let wrong = [
        (Effects { cogging: vec![Cogging { ratio: 0.0, amplitude: 1.0, phase: 0.0 }], ..all() }, "cogging order"),
        (Effects { cogging: vec![Cogging { ratio: 6.0, amplitude: -1.0, phase: 0.0 }], ..all() }, "cogging amplitude"),
        (Effects { phase_resistance: Some([1.0, 0.0, 1.0]), ..all() }, "phase resistance"),
        (
            Effects { iron: Some(IronLoss { speed: 100.0, hysteresis: 1.0, eddy: f64::NAN }), ..all() },
            "eddy-current loss",
        ),
        (
            Effects { flux_harmonics: vec![FluxHarmonic { order: 0, d: 0.0, q: 0.0, phase: 0.0 }], ..all() },
            "order of the flux harmonic",
        ),
    ];
    for (effects, name) in wrong {
        assert_eq!(stage(&effects).err().map(|error| error.name), Some(name));
    }
    assert!(stage(&all()).is_ok());
}

/// Oracle: the motor without saturation, for currents at which it has none; and a run that must differ, at those at which it has. On a
/// switching bridge, from edge to edge, with the drop of its devices; the field returns its stored energy over the run.
#[test]
fn a_map_is_followed_on_every_inverter() {
    let none =
        FluxMap::curve(&Saturation { current: 12.0, share: 1.0, residual: 0.1 }, MOTOR.flux_linkage, MOTOR.inductance);
    let effects = [None, none.ok(), Some(saturated())].map(|flux_map| Effects { flux_map, ..Effects::default() });
    for modulation in [inverter::Modulation::Averaged, inverter::Modulation::Switching] {
        let real =
            inverter::Params { modulation, carrier: 16e3, dead_time: 2e-6, device_drop: 0.9, on_resistance: 0.1 };
        let ends = effects.each_ref().map(|effects| {
            let mut stage = stage(effects).with_inverter(&real, None, H).unwrap();
            let (mut stored, mut electrical) = (0.0, 0.0);
            for k in 0..800 {
                let motor = BodyState { position: 37.0 * H * f64::from(k), velocity: 37.0 };
                stage.measured_current(motor);
                let voltage = Dq { d: -25.0, q: 110.0 }.to_alpha_beta(stage.rotation().rotation());
                stage.advance(PowerCommand::Voltage(voltage), motor, H);
                let power = stage.power();
                let terms = [power.electrical, power.copper, power.stored, power.air_gap];
                let largest = terms.into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
                let rest = power.electrical - power.copper - power.stored - power.air_gap;
                assert!(rest.abs() < 1e-12 * largest, "{modulation:?} {k}: {rest} of {terms:?}");
                stored += power.stored * H;
                electrical += power.electrical.abs() * H;
            }
            let current = stage.current();
            let field = match &effects.flux_map {
                Some(map) => map.stored(Dq::default(), current),
                None => MOTOR.stored_energy(current),
            };
            assert!(
                (stored - field).abs() < 1e-12 * electrical,
                "{modulation:?}: {stored} J, {field} J of {electrical} J"
            );
            current
        });
        let [plain, linear, saturated] = ends;
        let size = plain.magnitude();
        println!("{modulation:?}: {plain:?} {linear:?} {saturated:?}");
        assert!((plain.d - linear.d).hypot(plain.q - linear.q) < 1e-6 * size, "{modulation:?}: {plain:?} {linear:?}");
        assert!((plain.d - saturated.d).hypot(plain.q - saturated.q) > 0.02 * size, "{saturated:?}");
    }
}

/// Oracle: the loss of the iron by the flux linkages of the map, (ψ_d² + ψ_q²)/ψ², at a current that a held voltage keeps.
#[test]
fn the_iron_loses_by_the_flux_of_the_map() {
    let iron = IronLoss { speed: 157.0, hysteresis: 0.0, eddy: 47.0 };
    let effects = Effects { iron: Some(iron), flux_map: Some(saturated()), ..Effects::default() };
    let mut stage = stage(&effects);
    for k in 0..4000 {
        let motor = BodyState { position: 37.0 * H * f64::from(k), velocity: 37.0 };
        stage.measured_current(motor);
        // In the frame of the rotor in the middle of the tick.
        let voltage = Dq { d: -25.0, q: 110.0 }.to_alpha_beta(stage.rotation().rotation().ahead(1.5 * 37.0 * H));
        stage.advance(PowerCommand::Voltage(voltage), motor, H);
    }
    let psi = saturated().flux(stage.current());
    let relative = (psi.d * psi.d + psi.q * psi.q) / (0.545 * 0.545);
    let expected = 47.0 * (37.0_f64 / 157.0).powi(2) * relative;
    assert!((stage.power().iron / expected - 1.0).abs() < 1e-9, "{} {expected}", stage.power().iron);
    assert!((relative - 1.0).abs() > 0.05, "there is something to test: {relative}");
}
