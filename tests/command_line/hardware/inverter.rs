//! Each effect of the inverter has a scenario whose limits hold it from both sides: as it is they pass, without the effect and with twice of
//! it they fail.
use super::{passes_but_not_with, run};

#[test]
fn each_effect_is_told_from_none_and_from_twice_as_much() {
    for (name, off, doubled) in [
        ("dead-time", "drive.inverter.dead_time=0 s", "drive.inverter.dead_time=4 us"),
        ("device-drop", "drive.inverter.device_drop=0 V", "drive.inverter.device_drop=2.4 V"),
        ("switching", "drive.inverter.modulation=averaged", "drive.inverter.carrier=8 kHz"),
        ("overmodulation", "drive.inverter.modulation=averaged", "drive.dc_link=310 V"),
        ("dc-link-sag", "drive.link.sag.depth=0.0", "drive.link.sag.depth=0.3"),
        ("brake-resistor", "drive.link.brake.on=2 kV", "drive.link.brake.resistance=280 Ohm"),
    ] {
        passes_but_not_with(name, &[&[off], &[doubled]]);
    }
}

/// What cannot be placed, sampled or believed is refused with the key, its value, the bound and the way out.
#[test]
fn what_does_not_go_together_is_refused() {
    for (name, set, words) in [
        ("switching", "drive.inverter.carrier=10 kHz", "must divide the base rate of 16000 Hz or be a multiple of it"),
        ("switching", "drive.inverter.carrier=4 kHz", "samples between the middles of the carrier of 4000 Hz"),
        (
            "dead-time",
            "drive.inverter.dead_time=7 us",
            "at most a tenth of the carrier's period, 6.2500 us, got 7.0000 us",
        ),
        ("brake-resistor", "drive.link.brake.off=300 V", "`off` of 300 V must be between the voltage of the link"),
    ] {
        let (code, said, _) = run(&format!("hardware/{name}"), &[set]);
        let in_a_line = said.split_whitespace().collect::<Vec<_>>().join(" ");
        let plain = in_a_line.replace(" │ ", " ");
        assert_eq!(code, 2, "{said}");
        assert!(plain.contains(words), "{set}: {said}");
    }
}
