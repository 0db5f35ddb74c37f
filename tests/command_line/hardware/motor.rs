//! Effects of a real motor: each ready scenario keeps its limits as it is, and misses them without its effect and with twice of it.
use super::passes_but_not_with;

/// Scenario, and the keys that switch its effect off and that double it.
const SCENARIOS: [(&str, &[&str], &[&str]); 8] = [
    (
        "cogging",
        &["motor.cogging[0].amplitude=0 mNm", "motor.cogging[1].amplitude=0 mNm"],
        &["motor.cogging[0].amplitude=50 mNm", "motor.cogging[1].amplitude=10 mNm"],
    ),
    (
        "flux-harmonics",
        &["motor.flux_harmonic[0].d=0", "motor.flux_harmonic[0].q=0", "motor.flux_harmonic[1].q=0"],
        &["motor.flux_harmonic[0].d=0.02", "motor.flux_harmonic[0].q=-0.04", "motor.flux_harmonic[1].q=0.008"],
    ),
    // Twice of the 11 % that are missing.
    ("saturation", &["motor.saturation.share=1"], &["motor.saturation.share=0.782"]),
    // Iron that saturates at half of the current.
    (
        "saturation-table",
        &["motor.flux_map.file=../../tests/scenarios/saturation-off.csv"],
        &["motor.flux_map.file=../../tests/scenarios/saturation-doubled.csv"],
    ),
    (
        "iron-loss",
        &["motor.iron_loss.hysteresis=0 W", "motor.iron_loss.eddy=0 W"],
        &["motor.iron_loss.hysteresis=12 W", "motor.iron_loss.eddy=20 W"],
    ),
    ("unequal-phases", &["motor.phase_resistance=[1, 1, 1]"], &["motor.phase_resistance=[1, 1, 1.2]"]),
    (
        "hot-motor",
        &["motor.temperature.winding=20 degC", "motor.temperature.housing=20 degC"],
        &["motor.temperature.winding=220 degC", "motor.temperature.housing=140 degC"],
    ),
    (
        "warming-up",
        &["motor.temperature.resistance_coefficient=0 1/K"],
        &["motor.temperature.resistance_coefficient=0.00786 1/K"],
    ),
];

/// Without its own strategy, a constant current in d, and with less of the difference of inductances that its torque comes from.
#[test]
fn a_motor_without_magnets_has_torque_by_its_saliency() {
    let constant = "drive.current={ rate='16 kHz', bandwidth='1.2 kHz', d_reference='18 Apk' }";
    passes_but_not_with("reluctance", &[&[constant], &["motor.inductance_q=12 mH"]]);
}

#[test]
fn each_scenario_passes_as_it_is_and_fails_without_its_effect_and_with_twice_of_it() {
    for (scenario, off, doubled) in SCENARIOS {
        passes_but_not_with(scenario, &[off, doubled]);
    }
}
