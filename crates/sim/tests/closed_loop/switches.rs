//! Limit and home switches, wired normally open and normally closed.
use crate::rig::{self, axis, lasting};
use servobench_trace::Recording;

const SWITCHES: &str = r#"
[axis.switches]
negative = "-21.37 mm"
positive = "53.19 mm"
home = { from = "11.113 mm", to = "17.7 mm" }
index = "77 deg"
"#;

/// A ball screw of 10 mm a revolution with an encoder of an odd number of counts.
fn run(text: &str, reversed: bool) -> Recording {
    let axis = lasting(axis!(), "3.5 s").replace("1048576", "100003");
    rig::run(&format!(
        "{axis}[setpoint]\norder = 3\nvelocity = \"300 mm/s\"\nacceleration = \"3 m/s2\"\njerk = \"70 m/s3\"\n{text}\n\
         [bus]\ncycle = \"2 ms\"\ndelay = 1\nvelocity_offset = true\nunits = {{ drive = 1, axis = \"1 um\" }}\nreverse_switches = {reversed}\n"
    ))
}

/// Whether a signal ever has a value.
fn is_ever(recording: &Recording, source: &str, name: &str, value: &str) -> bool {
    let signal = recording.signal(source, name).unwrap_or_else(|| panic!("no signal {source}.{name}"));
    signal.changes.iter().any(|(_, found)| found == value)
}

/// Oracle: the run with switches that are wired normally open. A switch that is met is the same whichever way it is wired, so that
/// every value is the same bit for bit.
fn assert_same(open: &Recording, closed: &Recording, what: &str) {
    for name in ["load.position", "motor.position", "setpoint.position", "task.position"] {
        let [one, other] =
            [open, closed].map(|recording| recording.channel(name).unwrap_or_else(|| panic!("no {name}")));
        assert!(one.iter().map(|x| x.to_bits()).eq(other.iter().map(|x| x.to_bits())), "{what}: {name}");
    }
    for (source, name) in [("axis", "state"), ("drive", "state"), ("link", "fault"), ("power", "Status")] {
        let changes = |recording: &Recording| recording.signal(source, name).map(|signal| signal.changes.clone());
        assert_eq!(changes(open), changes(closed), "{what}: {source}.{name}");
    }
}

/// Onto either limit switch and the home switch from either side, with the index pulse and without.
#[test]
fn an_axis_homes_onto_switches_of_either_polarity() {
    // The index pulse comes at 77° of revolutions of 10 mm.
    let index = |revolution: f64| 10e-3 * (revolution + 77.0 / 360.0);
    for (method, reference) in
        [(17, -21.37e-3), (18, 53.19e-3), (19, 11.113e-3), (24, 11.113e-3), (7, index(0.0)), (1, index(-2.0))]
    {
        let text = format!(
            "{SWITCHES}
[drive.objects]
\"6098h\" = {method}
\"6099h.1\" = 50000
\"6099h.2\" = 5000
\"609Ah\" = 500000
[[call]]
block = \"MC_Power\"
name = \"power\"
[[call]]
block = \"MC_Home\"
name = \"home\"
start = \"power.Status\"
position = \"3 mm\"
"
        );
        let [open, closed] = [false, true].map(|reversed| run(&text, reversed));
        assert_same(&open, &closed, &format!("method {method}"));
        assert!(
            is_ever(&closed, "home", "Done", "TRUE") && is_ever(&closed, "axis", "homed", "TRUE"),
            "method {method}"
        );
        // It stops behind its reference: what the drive follows is up to 70 µm ahead of the axis at 5 mm/s when that meets it, and
        // is stopped at 0.5 m/s² within 25 µm.
        let found = closed.channel("load.position").and_then(|values| values.last().copied()).unwrap_or_default();
        assert!((found - reference).abs() < 100e-6, "method {method}: {found} instead of {reference}");
    }
}

/// Into the positive end at 300 mm/s, reset, and out of it again.
#[test]
fn a_limit_switch_of_either_polarity_is_hit_in_motion() {
    let text = format!(
        "{SWITCHES}
[plc]
homing_required = false
[[call]]
block = \"MC_Power\"
name = \"power\"
[[call]]
block = \"MC_MoveAbsolute\"
name = \"into\"
start = \"power.Status\"
position = \"120 mm\"
[[call]]
block = \"MC_Reset\"
name = \"reset\"
start = {{ after = \"into.Error\", delay = \"313 ms\" }}
[[call]]
block = \"MC_MoveAbsolute\"
name = \"out\"
start = {{ after = \"reset.Done\", delay = \"57 ms\" }}
position = \"-7 mm\"
"
    );
    let [open, closed] = [false, true].map(|reversed| run(&text, reversed));
    assert_same(&open, &closed, "in motion");
    assert!(is_ever(&closed, "into", "Error", "TRUE") && is_ever(&closed, "out", "Done", "TRUE"));
    assert!(is_ever(&closed, "link", "fault", "positive limit switch"));
    let furthest = closed.channel("load.position").map_or(0.0, |values| values.iter().copied().fold(0.0, f64::max));
    assert!((53.19e-3..80e-3).contains(&furthest), "{furthest}");
}

/// Inputs without switches are open: taken for normally closed they read as both switches met, and the axis moves in no direction.
#[test]
fn switches_that_are_not_there_are_met_where_they_are_taken_for_normally_closed() {
    for (target, fault) in [("7 mm", "positive limit switch"), ("-7 mm", "negative limit switch")] {
        let text = format!(
            "
[plc]
homing_required = false
[[call]]
block = \"MC_Power\"
name = \"power\"
[[call]]
block = \"MC_MoveAbsolute\"
name = \"into\"
start = \"power.Status\"
position = \"{target}\"
"
        );
        let [open, closed] = [false, true].map(|reversed| run(&text, reversed));
        assert!(is_ever(&open, "into", "Done", "TRUE") && !is_ever(&open, "link", "fault", fault), "to {target}");
        assert!(is_ever(&closed, "into", "Error", "TRUE") && is_ever(&closed, "link", "fault", fault), "to {target}");
    }
}
