//! Each effect of the inverter has a scenario whose limits hold it from both sides: as it is they pass, without the effect and with twice of
//! it they fail.
use crate::{code, said, servobench};

/// Exit code and words of a run of `scenarios/hardware/<name>.toml` with `set`.
fn run(name: &str, set: Option<&str>) -> (i32, String) {
    let out = tempfile::tempdir().unwrap();
    let (file, out) = (format!("scenarios/hardware/{name}.toml"), out.path().join("out"));
    let mut arguments = vec!["run", file.as_str(), "--keep", "none", "--out", out.to_str().unwrap()];
    if let Some(set) = set {
        arguments.extend(["--set", set]);
    }
    let output = servobench(&arguments);
    (code(&output), said(&output))
}

#[test]
fn each_effect_is_told_from_none_and_from_twice_as_much() {
    for (name, off, doubled) in [
        ("dead-time", "drive.inverter.dead_time=0 s", "drive.inverter.dead_time=4 us"),
        ("device-drop", "drive.inverter.device_drop=0 V", "drive.inverter.device_drop=2.4 V"),
        ("switching", "drive.inverter.modulation=averaged", "drive.inverter.carrier=8 kHz"),
        ("dc-link-sag", "drive.link.sag.depth=0.0", "drive.link.sag.depth=0.3"),
        ("brake-resistor", "drive.link.brake.on=2 kV", "drive.link.brake.resistance=280 Ohm"),
    ] {
        for (set, expected) in [(None, 0), (Some(off), 4), (Some(doubled), 4)] {
            let (code, said) = run(name, set);
            assert_eq!(code, expected, "{name} {set:?}\n{said}");
        }
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
        let (code, said) = run(name, Some(set));
        let in_a_line = said.split_whitespace().collect::<Vec<_>>().join(" ");
        let plain = in_a_line.replace(" │ ", " ");
        assert_eq!(code, 2, "{said}");
        assert!(plain.contains(words), "{set}: {said}");
    }
}
