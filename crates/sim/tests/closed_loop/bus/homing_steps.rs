//! Homing against a stop, end to end.
use crate::rig::{last, peak, run, screw_with, states, values, when};
use servobench_trace::Recording;

/// Torque limit of the search (N·m): the nearest thousandth of 6.09 N·m to 0.5 N·m.
const LIMIT: f64 = 0.082 * 6.09;
/// The same as a force on the load (N): a lead of 10 mm.
const FORCE: f64 = LIMIT * std::f64::consts::TAU / 10e-3;
const STIFFNESS: f64 = 20e6;
const SCREW_STIFFNESS: f64 = 43e6;
/// Of table and motor (N).
const FRICTION: f64 = 20.0 + 0.03 * std::f64::consts::TAU / 10e-3;

/// A search towards the stop at −40 mm, whose position is then −5 mm, and what comes after it.
fn searched(bus: &str, search: &str, then: &str) -> Recording {
    let stops = "end_stops = { negative = \"-40 mm\", stiffness = \"20 N/um\", damping = \"10 kN s/m\" }";
    let text = screw_with(stops, "3 s");
    run(&format!(
        r#"{text}{bus}
[[call]]
block = "MC_Power"
name = "power"
[[call]]
block = "MC_StepBlock"
name = "search"
start = "power.Status"
direction = "negative"
velocity = "40 mm/s"
position = "-5 mm"
detection_velocity_limit = "1 mm/s"
detection_velocity_time = "50 ms"
torque_limit = "0.5 Nm"
{search}
{then}"#
    ))
}

const BUS: &str = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\n[drive.objects]\n\"6065h\" = 1000000\n";

/// Away from the stop to 0 mm, and to 60 mm.
const AWAY: &str = r#"
[[call]]
block = "MC_FinishHoming"
name = "away"
start = "search.Done"
distance = "5 mm"
velocity = "50 mm/s"
[[call]]
block = "MC_MoveAbsolute"
name = "goes"
start = "away.Done"
position = "60 mm"
"#;

/// What pushes against the load, from `from` (s) on.
fn pushes(recording: &Recording, from: f64) -> f64 {
    values(recording, "effort.end_stop")[recording.index_at(from)..].iter().fold(0.0, |most, push| push.max(most))
}

/// Oracle: the stop itself. The encoder on the motor is held where stop and screw give way to the torque: (1/k_stop + 1/k_screw)·F
/// behind −40 mm, less what friction takes of F. The effort never exceeds its limit, and nothing is left that pushes when it is lifted.
#[test]
fn the_position_counts_from_the_stop_in_every_mode_that_blocks_command() {
    let feedforward = "velocity_offset = true\n";
    for mode in [
        feedforward.to_owned(),
        format!("{feedforward}mode = \"csv\"\nposition_gain = \"60 1/s\"\n"),
        "mode = \"pv\"\n".to_owned(),
        format!("{feedforward}units = {{ drive = 1048576, axis = \"-10 mm\" }}\n"),
    ] {
        let recording = searched(&BUS.replace(feedforward, &mode), "", AWAY);
        let (begins, done) = (when(&recording, "search", "Active", "TRUE"), when(&recording, "search", "Done", "TRUE"));
        let asked = &values(&recording, "effort.reference")[recording.index_at(begins)..recording.index_at(done)];
        let most = asked.iter().fold(0.0_f64, |most, effort| most.max(effort.abs()));
        let (pushed, afterwards) = (pushes(&recording, done), pushes(&recording, done + 5e-3));
        let held_at = last(&recording, "motor.position") - 65e-3;
        println!(
            "{mode:?}: done at {done} s, held at {held_at} m, {most} N·m, {pushed} N of {FORCE} N at the end, {afterwards} N \
             afterwards, following error {} m",
            peak(&recording, "following_error.motor")
        );
        assert!((most - LIMIT).abs() < 1e-9, "{mode}: {most} N·m");
        assert!(pushed < FORCE + FRICTION && afterwards <= pushed, "{mode}: {pushed} N, {afterwards} N");
        if !mode.contains("pv") {
            let gives_way = |force: f64| -40e-3 - force / STIFFNESS - force / SCREW_STIFFNESS;
            assert!((gives_way(FORCE)..gives_way(FORCE - FRICTION)).contains(&held_at), "{mode}: {held_at} m");
        }
        // Standstill in between lasts no cycle.
        assert_eq!(states(&recording, "axis", "state"), ["Disabled", "Homing", "DiscreteMotion", "Standstill"]);
        assert_eq!(states(&recording, "axis", "homed"), ["FALSE", "TRUE"]);
        let homed = when(&recording, "axis", "homed", "TRUE");
        assert!(
            (homed - when(&recording, "away", "Done", "TRUE")).abs() < 1e-9,
            "the steps do not home, their end does"
        );
    }
}

/// Where there is no stop, the search ends by itself: the axis brakes by its own limits and is in ErrorStop.
#[test]
fn a_search_without_an_obstacle_ends_at_its_limits() {
    for (limit, way) in [("time_limit = \"0.5 s\"", 0.5 * 40e-3), ("distance_limit = \"20 mm\"", 20e-3)] {
        let recording = searched(BUS, limit, "[requirements]\nexecuted = false\n");
        let (begins, fails) =
            (when(&recording, "search", "Active", "TRUE"), when(&recording, "search", "Error", "TRUE"));
        let end = last(&recording, "load.position");
        println!("{limit}: {} s, {end} m", fails - begins);
        // Ramps of 40 ms at either end, and the way of the set-point to the axis.
        assert!((end + way).abs() < 2e-3, "{limit}: {end} m");
        assert_eq!(states(&recording, "axis", "state").last(), Some(&"ErrorStop"));
        assert!(last(&recording, "load.velocity").abs() < 1e-6, "{limit}");
    }
}

/// MC_Stop takes the axis from the search while it pushes: the limit is lifted, and nothing is left that pushes then. The axis may
/// search once more.
#[test]
fn a_search_that_is_stopped_while_it_pushes_pushes_no_more() {
    let again = r#"
[[call]]
block = "MC_Stop"
name = "halts"
start = { at = "1.18 s" }
stop = { at = "1.4 s" }
[[call]]
block = "MC_StepBlock"
name = "again"
start = { at = "1.5 s" }
direction = "negative"
velocity = "40 mm/s"
detection_velocity_limit = "1 mm/s"
detection_velocity_time = "50 ms"
torque_limit = "0.5 Nm"
[[call]]
block = "MC_HomeDirect"
name = "there"
start = "again.Done"
position = "7 mm"
[requirements]
executed = false
"#;
    for mode in ["", "mode = \"csv\"\nposition_gain = \"60 1/s\"\n"] {
        let bus = BUS.replace("velocity_offset = true\n", &format!("velocity_offset = true\n{mode}"));
        let recording = searched(&bus, "", again);
        let stopped = when(&recording, "search", "CommandAborted", "TRUE");
        let before = values(&recording, "effort.end_stop")[recording.index_at(stopped)];
        let after = &values(&recording, "effort.end_stop")[recording.index_at(stopped)..recording.index_at(1.5)];
        let most = after.iter().fold(0.0_f64, |most, push| most.max(*push));
        println!("{mode:?}: {before} N at {stopped} s, {most} N afterwards");
        assert!(before > 100.0 && most < FORCE + FRICTION, "{mode}: {before} N, {most} N");
        assert_eq!(states(&recording, "axis", "homed"), ["FALSE", "TRUE"]);
        assert_eq!(
            states(&recording, "axis", "state"),
            ["Disabled", "Homing", "Stopping", "Standstill", "Homing", "Standstill"]
        );
        assert!(when(&recording, "there", "Done", "TRUE") > 1.5);
    }
}
