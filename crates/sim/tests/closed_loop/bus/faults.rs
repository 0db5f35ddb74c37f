//! What stops an axis: a drive that is silent, frames that are missing, an external fault, following errors, limit switches.
use crate::rig::{BUS, MOVE, SCREW, last, run, screw_with, states, values, when};
use servobench_trace::Recording;

fn with(more: &str) -> Recording {
    run(&format!("{SCREW}{BUS}{more}{MOVE}"))
}

/// The axis was in motion and stands, without power.
fn assert_stopped(recording: &Recording, what: &str) {
    assert!(values(recording, "motor.velocity").iter().any(|v| v.abs() > 0.1), "{what}: it did move");
    assert!(last(recording, "motor.velocity").abs() < 1e-3, "{what}: {}", last(recording, "motor.velocity"));
    assert_ne!(states(recording, "drive", "state").last(), Some(&"Operation enabled"), "{what}");
    assert!((last(recording, "load.position") - 0.25).abs() > 0.01, "{what}: short of the target");
}

#[test]
fn a_silent_drive_is_a_time_out() {
    let recording = with("drive_timeout = \"20 ms\"\n[[bus.fault]]\nkind = \"drive-silent\"\nstart = \"0.4 s\"\n");
    // The last answer is that of 399 ms; the frame with the next is a millisecond on its way.
    let found = when(&recording, "link", "fault", "drive time-out");
    assert!((found - 0.42).abs() < 2.1e-3, "{found}");
    // The drive still hears, and stops as it is told.
    assert!(states(&recording, "drive", "state").contains(&"Quick stop active"));
    assert_stopped(&recording, "silent");
}

#[test]
fn frames_that_are_missing_are_a_fault_of_the_drive() {
    let recording = with("[[bus.fault]]\nkind = \"lost\"\nstart = \"0.4 s\"\ncycles = 20\n");
    let found = when(&recording, "drive", "fault", "8700h");
    // Two are bridged.
    assert!(found > 0.402 && found < 0.406, "{found}");
    assert!(
        when(&recording, "link", "fault", "fault 8700h of the drive") > 0.419,
        "the master hears when frames come again"
    );
    assert_stopped(&recording, "missing");
    let bridged = with("[[bus.fault]]\nkind = \"lost\"\nstart = \"0.4 s\"\ncycles = 2\n");
    assert_eq!(states(&bridged, "drive", "fault"), ["none"]);
    assert!((last(&bridged, "load.position") - 0.25).abs() < 5e-6);
}

/// Oracle: the quick stop is a ramp of twice the acceleration of the move, 10 m/s².
#[test]
fn an_external_fault_is_a_quick_stop() {
    let recording = with("[[bus.fault]]\nkind = \"external-fault\"\nstart = \"0.4 s\"\n");
    assert!((when(&recording, "link", "fault", "external fault") - 0.4).abs() < 1e-9);
    let begins = when(&recording, "drive", "state", "Quick stop active");
    assert!((begins - 0.401).abs() < 1e-3, "{begins}");
    let velocity = values(&recording, "setpoint.velocity");
    let (first, rest) = (velocity[recording.index_at(begins)], velocity[recording.index_at(begins)..].iter());
    let length = rest.take_while(|v| v.abs() > 0.0).count() as f64 * recording.rate.period();
    println!("from {first} m/s in {length} s");
    // The drive's own period of 250 us at either end.
    assert!((length - first / 10.0).abs() < 5e-4, "{length} s from {first} m/s");
    assert_stopped(&recording, "external");
}

/// A push of 6 kN, more than the motor holds, against a window of 100 µm for 2 ms.
#[test]
fn a_following_error_beyond_its_window_is_a_fault() {
    let push = "units = { drive = 1, axis = \"1 um\" }\n[drive.objects]\n\"6065h\" = 100\n\"6066h\" = 2\n\
                [[disturbance]]\non = \"load\"\nstart = \"0.4 s\"\nduration = \"50 ms\"\nforce = \"-6 kN\"\n";
    let recording = with(push);
    let found = when(&recording, "drive", "fault", "8611h");
    let error = values(&recording, "following_error.motor");
    let outside = recording.time_of(error.iter().position(|error| error.abs() > 100e-6).unwrap_or(error.len() - 1));
    println!("outside at {outside} s, told at {found} s");
    assert!(found > 0.4 && found < 0.45, "{found}");
    assert_stopped(&recording, "window");
    // A wider one holds.
    let wide = with(&push.replace("= 100\n", "= 1000000\n"));
    assert_eq!(states(&wide, "drive", "fault"), ["none"]);
}

/// Into a limit switch, out of it by a reset and a move back.
#[test]
fn a_limit_switch_is_left_by_a_reset_and_a_move_back() {
    let text = screw_with("switches = { positive = \"200 mm\" }", "2.5 s");
    let recording = run(&format!(
        r#"{text}{BUS}
[plc]
homing_required = false
[[call]]
block = "MC_Power"
name = "power"
[[call]]
block = "MC_MoveAbsolute"
name = "into"
start = "power.Status"
position = "300 mm"
[[call]]
block = "MC_MoveAbsolute"
name = "refused"
start = {{ after = "into.Error", delay = "0.4 s" }}
position = "100 mm"
[[call]]
block = "MC_Reset"
name = "reset"
start = {{ after = "into.Error", delay = "0.5 s" }}
[[call]]
block = "MC_MoveAbsolute"
name = "back"
start = "reset.Done"
position = "100 mm"
"#
    ));
    let states = states(&recording, "axis", "state");
    println!("{states:?}");
    let stopped = when(&recording, "axis", "state", "ErrorStop");
    assert!(stopped > 0.4, "{stopped}");
    assert_eq!(states, ["Disabled", "DiscreteMotion", "ErrorStop", "DiscreteMotion", "Standstill"]);
    assert!(when(&recording, "refused", "Error", "TRUE") < when(&recording, "reset", "Done", "TRUE"));
    assert!(when(&recording, "back", "Done", "TRUE") > 0.0);
    // Oracle: the quick stop of 10 m/s² from 0.5 m/s, and a period of the drive of 250 µs until it begins. Its acceleration is
    // not fed forward: loops of 60 Hz and 12 Hz are behind by no more than a/(ω·K_v).
    let beyond = values(&recording, "load.position").iter().fold(0.0, |most: f64, x| most.max(*x)) - 0.2;
    let braking = 0.5 * 0.5 / (2.0 * 10.0);
    let behind = 10.0 / (std::f64::consts::TAU * 60.0 * std::f64::consts::TAU * 12.0);
    println!("{beyond} m beyond the switch, {braking} m of them braking");
    assert!((-behind..0.5 * 250e-6 + behind).contains(&(beyond - braking)), "{beyond}");
    assert!((last(&recording, "load.position") - 0.1).abs() < 5e-6);
}
