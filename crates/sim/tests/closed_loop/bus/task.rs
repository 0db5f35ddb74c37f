//! What goes wrong with the motion task: each state of the interpolation, and an axis that stays within its bounds.
use crate::rig::{BUS, MOVE, SCREW, last, peak, run, states, steepest, values};
use servobench_trace::Recording;

/// A motion task every 4 ms, with what goes wrong.
fn with(more: &str) -> Recording {
    run(&format!("{SCREW}{BUS}motion_cycle = \"4 ms\"\ninterpolation = \"quintic\"\n{more}{MOVE}"))
}

fn fault(kind: &str, more: &str) -> String {
    format!("[[bus.fault]]\nkind = \"{kind}\"\n{more}\n")
}

/// Velocity and acceleration of the move (m/s, m/s²), and of the recovery beside it.
const VELOCITY: f64 = 0.5;
const ACCELERATION: f64 = 5.0;
/// By how much a sample is wrong that is predicted two cycles of T = 4 ms ahead, at a jerk of j = 100 m/s³: j·(2T)³/6 (m).
const PREDICTION: f64 = 100.0 * 8e-3 * 8e-3 * 8e-3 / 6.0;
/// How far the axis may go off on the way back to the right sample: an acceleration that is wrong by j·3T, after two predicted
/// steps and the one that is joined, is led back with the jerk j in 3T: j·(3T)³ (m).
const RECOVERY: f64 = 100.0 * 12e-3 * 12e-3 * 12e-3;

/// The loops are never asked for more than the move and the recovery together, and the polynomial that leads from a sample
/// that was predicted two steps ahead to the right one, e = [`PREDICTION`] beside it, takes 10·e/(√3·T²). Increments of
/// 10 nm are 10 µm/s over a cycle, and the drive, straight from frame to frame, has two of them in a difference of velocities.
fn assert_bounded(recording: &Recording, what: &str) {
    let velocity = peak(recording, "setpoint.velocity");
    assert!(velocity < 2.0 * VELOCITY + 1e-4, "{what}: {velocity} m/s");
    let acceleration = steepest(recording, "setpoint.velocity", 1e-3) / 1e-3;
    let joining = 10.0 * PREDICTION / (3.0_f64.sqrt() * 4e-3 * 4e-3);
    assert!(acceleration < 2.0 * ACCELERATION + joining + 0.04, "{what}: {acceleration} m/s²");
}

/// The friction of the screw holds the load within micrometres.
fn assert_arrived(recording: &Recording, what: &str) {
    let x = last(recording, "load.position");
    assert!((x - 0.25).abs() < 5e-6, "{what}: {x}");
}

#[test]
fn each_state_of_the_interpolation_shows_and_the_axis_arrives() {
    let sound = peak(&with(""), "following_error.load");
    let twice = fault("task-lost", "start = \"0.14 s\"\ncycles = 2");
    for (what, fault, seen, error) in [
        ("nothing", String::new(), &[][..], 0.0),
        ("half a cycle late", fault("task-late", "start = \"0.14 s\"\nby = \"2 ms\""), &["Run2", "Run1"], 0.0),
        ("a command lost", fault("task-lost", "start = \"0.14 s\""), &["Run2", "Run1"], 0.0),
        ("two commands lost", twice, &["Run2", "Run3", "Run1"], RECOVERY),
        (
            "one and a half cycles late",
            fault("task-late", "start = \"0.14 s\"\nby = \"6 ms\""),
            &["Run2", "Run3", "Slow", "Run1"],
            RECOVERY,
        ),
        ("torn", fault("task-torn", "start = \"0.14 s\""), &["Busy", "Run1"], 0.0),
    ] {
        let recording = with(&fault);
        let states = states(&recording, "link", "interpolation");
        let found = peak(&recording, "following_error.load");
        let steep = steepest(&recording, "setpoint.velocity", 1e-3) / 1e-3;
        println!("{what}: {states:?}, {found:.3e} m of {sound:.3e} m, {steep:.2} m/s²");
        assert_eq!(states, [&["Off", "Wait", "Run1"], seen].concat(), "{what}");
        assert_bounded(&recording, what);
        assert_arrived(&recording, what);
        assert!(found < 1.5 * sound + error, "{what}: {found} {sound}");
    }
}

/// For longer than is predicted: the axis is brought to rest by itself and goes on when there are set-points again.
#[test]
fn a_motion_task_that_stays_away_stops_the_axis_until_it_comes_back() {
    for kind in ["master-stopped", "task-lost"] {
        let recording = with(&fault(kind, "start = \"0.4 s\"\nduration = \"0.2 s\""));
        let states = states(&recording, "link", "interpolation");
        println!("{kind}: {states:?}, {:.3e} m", peak(&recording, "following_error.load"));
        assert_eq!(states[..6], ["Off", "Wait", "Run1", "Run2", "Run3", "Underflow"], "{kind}");
        assert_eq!(states.last(), Some(&"Run1"), "{kind}");
        // At rest before it comes back: from 0.5 m/s at 5 m/s² and 100 m/s³ in 0.15 s.
        let velocity = values(&recording, "setpoint.velocity");
        assert!(velocity[recording.index_at(0.59)].abs() < 1e-9, "{kind}: {}", velocity[recording.index_at(0.59)]);
        assert_bounded(&recording, kind);
        assert_arrived(&recording, kind);
    }
}

#[test]
fn a_motion_task_whose_clock_is_fast_overflows() {
    let recording = with(&fault("task-fast", "start = \"0.3 s\"\nby = \"1 ms\"\nduration = \"0.15 s\""));
    let states = states(&recording, "link", "interpolation");
    println!("{states:?}, {:.3e} m", peak(&recording, "following_error.load"));
    assert!(states.contains(&"Overflow"), "{states:?}");
    assert!(!states.contains(&"Underflow") && states.last() == Some(&"Run1"), "{states:?}");
    assert_bounded(&recording, "fast");
    assert_arrived(&recording, "fast");
    // Up to five cycles of samples wait before they are thrown away; while that difference is taken out the next one grows.
    let behind = peak(&recording, "following_error.load");
    assert!(behind > 1e-3 && behind < 2.0 * 5.0 * 4e-3 * VELOCITY, "{behind}");
}

#[test]
fn a_motion_task_that_is_faster_than_the_bus_makes_the_link_slow() {
    let recording = with(&fault("task-fast", "start = \"0.4 s\"\nby = \"3.5 ms\"\ncycles = 3"));
    let states = states(&recording, "link", "interpolation");
    println!("{states:?}, {:.3e} m", peak(&recording, "following_error.load"));
    assert!(states.contains(&"Slow") && states.last() == Some(&"Run1"), "{states:?}");
    assert_arrived(&recording, "slow");
}

#[test]
fn what_comes_within_the_margin_is_in_time() {
    let jitter = fault("task-jitter", "by = \"2 ms\"\nseed = 5");
    let recording = with(&format!("margin = \"2 ms\"\n{jitter}"));
    assert_eq!(states(&recording, "link", "interpolation"), ["Off", "Wait", "Run1"]);
    assert_arrived(&recording, "margin");
    let without = with(&jitter);
    assert!(states(&without, "link", "interpolation").contains(&"Run2"));
    assert_bounded(&without, "jitter");
    assert_arrived(&without, "jitter");
    let [one, other] = [&recording, &without].map(|recording| peak(recording, "following_error.load"));
    println!("{one:.3e} m with a margin, {other:.3e} m without");
    // The margin makes everything later, and what the axis is measured against.
    let sound = peak(&with(""), "following_error.load");
    assert!((one / sound - 1.0).abs() < 0.02, "{one} {sound}");
}
