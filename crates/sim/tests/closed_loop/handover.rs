//! From a mode of the drive's own back to the set-points of the motion task: nothing jumps.
use crate::rig::{self, text_of, values};
use servobench_trace::Recording;

/// `scenarios/plc/homing.toml` with a pause before its move and something else in the place of what it says.
fn run(changes: &[(&str, &str)]) -> Recording {
    let pause = [("start = \"home.Done\"", "start = { after = \"home.Done\", delay = \"0.2 s\" }")];
    rig::run(&text_of("homing.toml", &[&pause, changes].concat()))
}

/// When a signal first has a value after `since` (s).
fn when(recording: &Recording, source: &str, name: &str, value: &str, since: f64) -> f64 {
    let signal = recording.signal(source, name).unwrap_or_else(|| panic!("no signal {source}.{name}"));
    let change = signal.changes.iter().find(|(t, found)| *t > since && found == value);
    change.unwrap_or_else(|| panic!("{source}.{name} is never {value}: {:?}", signal.changes)).0
}

/// The axis still moves to where it is to stop when the drive says that it is homed. Oracle: the drive has stopped its demand there, so
/// what it follows and what the motion task asks for stay there, to the half unit that a target is rounded by, until the move begins.
#[test]
fn homing_is_followed_by_csp_without_a_jump() {
    let counts = ("encoder = { counts_per_rev = 1048576 }", "encoder = { counts_per_rev = 10007 }");
    let unit = "units = { drive = 1, axis = \"1 um\" }";
    let cases: [(&[(&str, &str)], f64); 6] = [
        (&[], 1e-6),
        (&[("cycle = \"1 ms\"", "cycle = \"2 ms\"\ndelay = 2"), counts], 1e-6),
        (&[(unit, "motion_cycle = \"5 ms\"\ninterpolation = \"cubic\"\nunits = { drive = 1, axis = \"1 um\" }")], 1e-6),
        (&[("cycle = \"1 ms\"", "cycle = \"0.5 ms\"\ndelay = 3\ndrive_interpolation = \"linear\"")], 1e-6),
        (&[("\"6098h\" = 7", "\"6098h\" = 19"), ("\"6099h.2\" = 5000", "\"6099h.2\" = 31007")], 1e-6),
        (
            &[
                ("start = \"power.Status\"", "start = \"power.Status\"\nposition = \"-7.3 mm\""),
                ("friction = true", "friction = false"),
            ],
            1e-6,
        ),
    ];
    for (number, (changes, unit)) in cases.into_iter().enumerate() {
        let recording = run(changes);
        let homing = when(&recording, "drive", "mode", "hm", 0.0);
        let (csp, moving) =
            (when(&recording, "drive", "mode", "csp", homing), when(&recording, "move", "Execute", "TRUE", homing));
        // Before it is homed the program counts from elsewhere.
        let homed = when(&recording, "axis", "homed", "TRUE", homing);
        let window = |since: f64| recording.index_at(since)..recording.index_at(moving);
        for (name, since) in [("setpoint.position", csp - 1e-3), ("task.position", homed)] {
            let values = &values(&recording, name)[window(since)];
            let jump = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
            let way = values.iter().map(|x| (x - values[0]).abs()).fold(0.0, f64::max);
            println!("case {number}, {name}: {jump:.2e} m in a tick, {way:.2e} m in all");
            assert!(way <= 0.501 * unit, "case {number}, {name}: {way} m");
        }
        let lag = values(&recording, "setpoint.position")[recording.index_at(csp)]
            - values(&recording, "motor.position")[recording.index_at(csp)];
        println!("case {number}: {lag:.2e} m behind at {csp} s");
    }
}
