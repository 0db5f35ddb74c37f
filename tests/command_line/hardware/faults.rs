//! `scenarios/hardware/faults`: each fault of the hardware is found, told by its code and reacted to; without it, or without what looks
//! for it, the scenario fails.
use super::run;

/// A file, its code, what takes the fault away, and what looks for it, where that has a key.
const FAULTS: [(&str, &str, &str, &str); 8] = [
    ("swapped-phases", "7122h", "motor.connection={}", "drive.supervision.commutation.speed='3000 rpm'"),
    (
        "commutation-offset-90",
        "7121h",
        "motor.encoder.commutation_offset='0 deg'",
        "drive.supervision.stall.time='1 s'",
    ),
    (
        "commutation-offset-180",
        "7122h",
        "motor.encoder.commutation_offset='0 deg'",
        "drive.supervision.commutation.speed='3000 rpm'",
    ),
    ("lost-track", "7305h", "motor.encoder.lost_at='5 s'", ""),
    ("lost-load-track", "7306h", "drive.load_encoder.lost_at='5 s'", ""),
    ("lost-phase", "3321h", "motor.connection.open_at='5 s'", "drive.supervision.phase_loss.time='1 s'"),
    (
        "dc-link-overvoltage",
        "3210h",
        "drive.link.brake={ resistance='47 Ohm', on='390 V', off='375 V' }",
        "drive.supervision.overvoltage='900 V'",
    ),
    ("dc-link-sag", "3220h", "drive.link.sag.depth=0", "drive.supervision.undervoltage='50 V'"),
];

#[test]
fn each_fault_is_told_by_its_code() {
    for (name, code, without, unseen) in FAULTS {
        let file = format!("hardware/faults/{name}");
        let (status, said, results) = run(&file, &[]);
        assert_eq!(status, 0, "{name}: {said}");
        assert!(results.contains(code), "{name}: {results}");
        for keys in [without, unseen].into_iter().filter(|keys| !keys.is_empty()) {
            let (status, said, _) = run(&file, &[keys]);
            assert_eq!(status, 4, "{name} with {keys}: {said}");
        }
    }
}

/// The rest of `lost-track` is a healthy axis: without its fault nothing that looks for one of the others finds any.
#[test]
fn a_healthy_axis_has_no_fault() {
    for (name, _, without, _) in FAULTS {
        let file = format!("hardware/faults/{name}");
        let (_, said, _) = run(&file, &[without, "expect=[]"]);
        assert!(!said.contains("drive has the fault") && !said.contains("no_fault"), "{name} with {without}: {said}");
    }
}

/// The example values of the supervision on axes that have nothing to do with it.
#[test]
fn the_supervision_leaves_other_scenarios_as_they_are() {
    let supervision = "drive.supervision={ overspeed = '6500 rpm', commutation = { speed = '200 rpm', current = '4 Arms' }, \
        stall = { speed = '5 rpm', time = '0.2 s' }, phase_loss = { current = '1 Arms', time = '10 ms' } }";
    for name in ["hardware/i2t-fault", "plc/coasting", "plc/limit-switch", "plc/pv-position-profile", "plc/homing"] {
        let (status, said, _) = run(name, &[supervision]);
        assert_eq!(status, 0, "{name}: {said}");
    }
}

/// Law 6: what nobody looks for is an event at least.
#[test]
fn a_collapsed_link_and_a_lost_track_are_events() {
    let sag = ["drive.link.sag.duration='0.5 s'", "drive.link.sag.depth=1", "limits={}"];
    let (_, said, _) = run("hardware/dc-link-sag", &sag);
    assert!(said.contains("the DC link has less than half"), "{said}");
    let lost = ["motor.encoder.lost_track='cosine'", "motor.encoder.lost_at='0.01 s'", "limits={}"];
    let (_, said, _) = run("hardware/sincos-amplitude", &lost);
    assert!(said.contains("the motor encoder has an error"), "{said}");
}
