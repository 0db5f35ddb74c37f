//! Effects of a real motor, as given in the file.
use super::*;
use servobench_base::Dq;
use servobench_plant::pmsm::{
    Cogging, Effects, FluxHarmonic, FluxMap, IronLoss, Saturation, Temperature, Temperatures, ThermalNetwork,
};

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
        winding_limit: 155.0,
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
        flux_map: None,
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

/// Oracle: by hand. The motor has 3.485 mH and 60.6 mV·s.
#[test]
fn saturation_is_a_curve_of_what_the_data_sheet_gives() {
    let found = effects("[motor.saturation]\ncurrent = \"20 Arms\"\nshare = \"85 %\"").flux_map.unwrap();
    let Actuator::Pmsm { motor, .. } = scenario(&format!("{TURNING}{DRIVE}")).actuator else { panic!("a motor") };
    let saturation = Saturation { current: 20.0 * 2.0_f64.sqrt(), share: 0.85, residual: 0.1 };
    assert_eq!(found, FluxMap::curve(&saturation, motor.flux_linkage, motor.inductance).unwrap());
    for (motor, expected) in [
        ("[motor.saturation]\ncurrent = \"20 Arms\"", "missing `share` in `motor.saturation`"),
        ("[motor.saturation]\ncurrent = \"20 Arms\"\nshare = 0.2", "`share` must be from 0.3 to 1"),
        ("[motor.saturation]\ncurrent = \"20 A\"\nshare = 0.9", "write `Arms` or `Apk`"),
        (
            "[motor.saturation]\ncurrent = \"1 Arms\"\nshare = 0.5\nresidual = 0.4",
            "the share of the effort per ampere must be within what these magnets and inductances allow",
        ),
        ("flux_map = { file = \"map.csv\" }\n[motor.saturation]\ncurrent = \"20 Arms\"\nshare = 0.9", "`saturation`"),
    ] {
        let said = mistake(&format!("{TURNING}{motor}\n{DRIVE}"));
        assert!(said.contains(expected), "{motor}:\n{said}");
    }
}

/// The table is read beside the scenario, checked, and compared with the motor's data.
#[test]
fn a_flux_map_is_read_from_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("{TURNING}flux_map = {{ file = \"map.csv\" }}\n{DRIVE}");
    let table = |flux: f64, cross: f64| {
        let mut rows = vec!["i_d [Apk],i_q [Apk],psi_d [mV s],psi_q [mV s]".to_owned()];
        for d in [-20.0, -8.0, 0.0, 9.0] {
            for q in [-30.0, 0.0, 5.0, 30.0] {
                rows.push(format!("{d},{q},{},{}", flux + 3.485 * d + cross * q, 3.485 * q));
            }
        }
        rows.join("\n")
    };
    let loaded = |table: &str| {
        std::fs::write(folder.path().join("map.csv"), table).unwrap();
        parse("test.toml", &text, Some(folder.path()))
    };
    let found = loaded(&table(60.6, 0.0)).unwrap();
    let Actuator::Pmsm { effects, .. } = found.scenario.actuator else { panic!("a motor") };
    let flux = effects.flux_map.unwrap().flux(Dq { d: -3.0, q: 7.0 });
    assert!((flux.d - 50.145e-3).abs() < 1e-15 && (flux.q - 24.395e-3).abs() < 1e-15, "{flux:?}");
    assert!(found.scenario.made_of.iter().any(|file| file.path.ends_with("map.csv")), "{:?}", found.scenario.made_of);
    let warned = loaded(&table(71.0, 0.0)).unwrap().warnings;
    assert!(warned.iter().any(|one| one.message.contains("without current the map has")), "{warned:?}");
    for (table, expected) in [
        (table(60.6, 1.0), "map.csv: the table would generate energy: between i_d = -20 and -8 A, i_q = -30 and 0 A"),
        (table(60.6, 0.0).replace("-8,5,", "-8,4,"), "map.csv:17:1: missing row for i_d = -20 A and i_q = 4 A"),
        (table(60.6, 0.0).replace("mV s", "mV"), "map.csv:1:21: `psi_d` cannot be in `mV`"),
        (table(60.6, 0.0).replace("\n0,", "\n1,"), "map.csv: `i_d` must have 0 A among its currents, got -20 A to 9 A"),
        (table(60.6, 0.0).replace(",0,", ",1,"), "map.csv: `i_q` must have 0 A among its currents, got -30 A to 30 A"),
    ] {
        let said = loaded(&table).unwrap_err().to_string();
        assert!(said.contains(expected), "{expected}:\n{said}");
    }
    std::fs::remove_file(folder.path().join("map.csv")).unwrap();
    let said = parse("test.toml", &text, Some(folder.path())).unwrap_err().to_string();
    assert!(said.contains("cannot read"), "{said}");
}
