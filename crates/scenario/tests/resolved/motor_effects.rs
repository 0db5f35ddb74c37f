//! Effects of a real motor, as the file has them.
use super::*;
use servobench_plant::pmsm::{Cogging, Effects, FluxHarmonic, IronLoss, Temperature, Temperatures, ThermalNetwork};

const TURNING: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "rotary"
[axis.motor_side]
inertia = "3 kg cm2"
[motor]
model = "wittenstein-premo-1f"
"#;
const DRIVE: &str = "[drive]\nmodel = \"servo-16khz\"\ndc_link = \"320 V\"\n";

fn effects(motor: &str) -> Effects {
    match scenario(&format!("{TURNING}{motor}\n{DRIVE}")).actuator {
        Actuator::Pmsm { effects, .. } => *effects,
        other => panic!("{other:?}"),
    }
}

fn mistake(text: &str) -> String {
    parse("test.toml", text, None)
        .map_or_else(|error| error.to_string(), |loaded| panic!("{:?}", loaded.scenario.actuator))
}

#[test]
fn without_keys_there_are_none() {
    assert_eq!(effects(""), Effects::default());
}

/// Oracle: by hand, in SI.
#[test]
fn every_key_becomes_its_parameter() {
    let found = effects(
        r#"
phase_resistance = [1, 0.98, 1.02]
[[motor.cogging]]
per_rev = 36
amplitude = "25 mNm"
[[motor.cogging]]
per_pole_pair = 6
amplitude = "5 mNm"
phase = "90 deg"
[[motor.flux_harmonic]]
order = 6
d = "1 %"
q = -0.02
[motor.iron_loss]
speed = "3000 rpm"
eddy = "10 W"
[motor.temperature]
winding = "80 °C"
flux_coefficient = "-0.0011 1/K"
[motor.thermal]
ambient = "40 degC"
to_housing = "0.6 K/W"
to_ambient = "1.1 K/W"
winding_capacity = "120 J/K"
housing_capacity = "1.6 kJ/K"
"#,
    );
    // Four pole pairs.
    let cogging = vec![
        Cogging { ratio: 36.0, amplitude: 0.025, phase: 0.0 },
        Cogging { ratio: 24.0, amplitude: 0.005, phase: PI / 2.0 },
    ];
    let network = ThermalNetwork {
        ambient: 40.0,
        to_housing: 0.6,
        to_ambient: 1.1,
        winding_capacity: 120.0,
        housing_capacity: 1600.0,
    };
    let expected = Effects {
        cogging,
        flux_harmonics: vec![FluxHarmonic { order: 6, d: 0.01, q: -0.02, phase: 0.0 }],
        iron: Some(IronLoss { speed: 3000.0 * TAU / 60.0, hysteresis: 0.0, eddy: 10.0 }),
        phase_resistance: Some([1.0, 0.98, 1.02]),
        temperature: Some(Temperature {
            reference: 20.0,
            resistance_coefficient: 0.003_93,
            flux_coefficient: -0.0011,
            start: Temperatures { winding: 80.0, housing: 40.0 },
            network: Some(network),
        }),
    };
    assert_eq!(found, expected);
}

/// Oracle: by hand. Two periods of cogging per two pole pitches of 24 mm are 2·2π/48 mm.
#[test]
fn a_linear_motor_cogs_by_its_poles() {
    let linear = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "100 kg"
[motor]
model = "siemens-1fn3900-4wb0"
pole_pitch = "24 mm"
[[motor.cogging]]
ORDER
amplitude = "12 N"
[drive]
model = "servo-16khz"
"#;
    let Actuator::Pmsm { effects, .. } = scenario(&linear.replace("ORDER", "per_pole_pair = 2")).actuator else {
        panic!("a synchronous motor")
    };
    assert!(same(effects.cogging[0].ratio, 2.0 * TAU / 0.048) && same(effects.cogging[0].amplitude, 12.0));
    let said = mistake(&linear.replace("ORDER", "per_rev = 36"));
    assert!(said.contains("a linear motor has no revolution"), "{said}");
}

#[test]
fn what_is_wrong_is_told_with_the_way_out() {
    for (motor, expected) in [
        ("phase_resistance = [1, 1.02]", "`phase_resistance` must have three values, got 2"),
        ("phase_resistance = [1, 0, 1]", "must be above zero"),
        ("[[motor.cogging]]\namplitude = \"1 Nm\"", "missing `per_rev` in `motor.cogging`"),
        ("[[motor.flux_harmonic]]\norder = 0", "`order` must be a whole number from 1 to 120"),
        ("[motor.iron_loss]\nspeed = \"0 rpm\"", "`speed` must be above zero"),
        ("[motor.temperature]\nwinding = \"80 K\"", "a temperature (degC)"),
        ("[motor.temperature]\nwinding = \"800 degC\"", "from -100 to 500"),
        (
            "[motor.temperature]\nhousing = \"120 degC\"\nflux_coefficient = \"-0.02 1/K\"",
            "the temperature coefficient of the flux linkage must be",
        ),
    ] {
        let said = mistake(&format!("{TURNING}{motor}\n{DRIVE}"));
        assert!(said.contains(expected), "{motor}:\n{said}");
    }
    let source =
        TURNING.replace("model = \"wittenstein-premo-1f\"", "kind = \"ideal-source\"\nphase_resistance = [1, 1, 1]");
    assert!(mistake(&source).contains("belongs to a synchronous motor"));
}
