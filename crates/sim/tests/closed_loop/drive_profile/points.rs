//! Interpolated position: points by every door and in every sub-mode.
use super::{buffer, by_object, frequency, sine, sub_mode, table};
use crate::rig::{peak, refusal, run, scenario, values};
use servobench_motion::{Limits, Order, Profile};
use servobench_sim::Program;
use servobench_trace::Recording;

/// Moves in interpolated position are sent as points. Oracle: the profile itself, in closed form, beside what the drive follows: off by as much
/// as was announced of the way through the points, and by half a count at each of them.
#[test]
fn moves_in_interpolated_position_are_sent_as_points() {
    let limits = Limits { velocity: 0.5, acceleration: 4.0, jerk: 120.0, snap: 6000.0 };
    let profile = Profile::plan(Order::Fourth, 0.1234, &limits).unwrap_or_else(|error| panic!("{error}"));
    let steps = "[setpoint]\norder = 4\nvelocity = \"0.5 m/s\"\nacceleration = \"4 m/s2\"\njerk = \"120 m/s3\"\nsnap = \"6000 m/s4\"\n\
                 [[program]]\nwait = \"0.1 s\"\n[[program]]\nmove_to = \"123.4 mm\"\n[[program]]\nwait = \"0.2 s\"\n";
    let lines = sub_mode(-1).replace("= 10", "= 20");
    for (object, objects, point_time, is_linear) in [
        ("2010h", "", "10 ms", false),
        ("2010h", "", "30 ms", false),
        ("60C1h", "", "17 ms", false),
        ("115h", "", "30 ms", false),
        ("60C1h", &*lines, "20 ms", true),
    ] {
        let text = by_object(object, objects, steps, &format!("point_time = \"{point_time}\"\n"));
        let program = Program::new(&scenario(&text)).unwrap_or_else(|error| panic!("{error}"));
        let announced = program.announced()[0].unwrap_or_else(|| panic!("nothing announced"));
        let recording = run(&text);
        let setpoint = values(&recording, "setpoint.position");
        let begins = setpoint.iter().position(|x| *x > 0.0).unwrap_or_else(|| panic!("nothing moves"));
        let tick = recording.rate.period();
        // The drive begins at a step of its own, and lines from a first whole count.
        let off = |shift: usize| {
            let instants = setpoint[begins - shift..].iter().enumerate().map(|(k, x)| (k as f64 * tick, x));
            let errors =
                instants.take_while(|(t, _)| *t < profile.duration()).map(|(t, x)| (x - profile.at(t).x).abs());
            errors.fold(0.0, f64::max)
        };
        let best = (0..640).map(off).fold(f64::INFINITY, f64::min);
        println!("{object} {point_time}: {best:.3e} m off its plan, {announced:.3e} m announced");
        if is_linear {
            // The sagitta of a line over T at the largest acceleration.
            assert!(best < 4.0 * 0.02 * 0.02 / 8.0 + 1e-6 && best > announced, "{best}");
        } else {
            // Half a count at the points, a little more between them, and a step of the drive at 0.5 m/s.
            assert!((best - announced).abs() < 2e-6, "{object} {point_time}: {best} {announced}");
        }
        let end = setpoint[setpoint.len() - 1];
        assert!((end - 0.1234).abs() < 1e-6, "{end}");
        assert!(peak(&recording, "following_error.motor") < 1e-3);
    }
}

/// What the words cannot hold is refused, with the key.
#[test]
fn times_that_no_point_has_are_refused() {
    let steps =
        "[setpoint]\norder = 2\nvelocity = \"0.5 m/s\"\nacceleration = \"4 m/s2\"\n[[program]]\nmove_to = \"0.2 m\"\n";
    let refused =
        |objects: &str, time: &str| refusal(&by_object("60C1h", objects, steps, &format!("point_time = \"{time}\"\n")));
    for (objects, time, expected) in [
        ("", "2.5 ms", "whole milliseconds up to 255; choose other times (`bus.point_time` where"),
        ("", "256 ms", "whole milliseconds up to 255; choose other times (`bus.point_time` where"),
        (&*sub_mode(-1), "20 ms", "that of 60C2h only; write the time between the points to 60C2h"),
        ("", "1 ns", "long enough for at most 5 million points"),
    ] {
        let said = refused(objects, time);
        assert!(said.contains(expected), "{time}: {said}");
    }
}

/// Positions of the points of `sine` in whole micrometres (m).
fn micrometres(points: u32) -> Vec<f64> {
    let omega = frequency(points);
    let x = |k: u32| 50.0 * (1.0 - (omega * 0.01 * f64::from(k)).cos());
    (0..points).map(|k| 1e-6 * (1e3 * x(k)).round()).collect()
}

/// The set-points of the drive at its turns, every fourth tick, from the last one at rest on.
fn turns(recording: &Recording) -> Vec<f64> {
    let setpoint = values(recording, "setpoint.position");
    // What is less is a rounding, as the axis leaves its rest a step of the drive later than at once.
    let moves = setpoint.iter().position(|x| x.abs() > 1e-12).unwrap_or_else(|| panic!("nothing moves"));
    setpoint[moves - 1..].iter().step_by(4).copied().collect()
}

/// Turns of the drive in 10 ms.
const SEGMENT: usize = 40;
/// A few roundings of 0.1 m.
const ROUNDING: f64 = 1e-15;

/// Oracle: points by 2010h. The points are the same, so the motion is, bit for bit.
#[test]
fn points_with_velocities_are_the_same_motion_by_every_door() {
    let file = sine(300);
    let run_by = |object, objects: &str| run(&by_object(object, objects, &table(&file), ""));
    let segments = run_by("2010h", "");
    let expected = turns(&segments);
    assert!(peak(&segments, "setpoint.position") > 0.0999);
    for (object, objects) in [("60C1h", sub_mode(-3)), ("60C1h", String::new()), ("115h", String::new())] {
        let recording = run_by(object, &objects);
        assert_eq!(buffer(&recording), ["none"], "{object}");
        let found = turns(&recording);
        let moving = SEGMENT * 299;
        let same = found.iter().zip(&expected).take(moving).filter(|(one, other)| one.to_bits() == other.to_bits());
        assert_eq!(same.count(), moving, "{object} {objects}");
        assert!((found[moving..].iter().fold(0.0_f64, |far, x| far.max((x - expected[moving]).abs()))) < ROUNDING);
    }
}

/// Oracle: straight lines between the points by hand, 10 ms each; before and after it the axis rests.
#[test]
fn sub_modes_in_lines_go_straight_from_point_to_point() {
    let file = sine(300);
    let points = micrometres(300);
    for code in [-2, -1] {
        let recording = run(&by_object("60C1h", &sub_mode(code), &table(&file), ""));
        assert_eq!(buffer(&recording), ["none"], "sub-mode {code}");
        let found = turns(&recording);
        let mut worst = 0.0_f64;
        for (turn, x) in found.iter().enumerate() {
            let (k, passed) = (turn / SEGMENT, (turn % SEGMENT) as f64 / SEGMENT as f64);
            let expected = match points.get(k..k + 2) {
                Some(ends) => ends[0] + passed * (ends[1] - ends[0]),
                None => points[299],
            };
            worst = worst.max((x - expected).abs());
        }
        println!("sub-mode {code}: {worst:.1e} m from the lines");
        assert!(worst < 1e-12, "sub-mode {code}: {worst}");
    }
}

/// Sub-mode 0. Oracle: straight lines between the points by hand, each in a segment of 10 ms or of one turn of the drive, 250 µs,
/// more or less: as many turns in the end as the master was late.
#[test]
fn sub_mode_0_goes_through_every_point_and_adapts_the_time() {
    let file = sine(300);
    let points = micrometres(300);
    // A master that stops for 15 ms, 60 turns, sends every point that much later from then on.
    let stopped = "[[bus.fault]]\nkind = \"master-stopped\"\nstart = \"1 s\"\nduration = \"15 ms\"\n";
    for (faults, lost) in [("", 0), (stopped, 60)] {
        let recording = run(&by_object("60C1h", &sub_mode(0), &table(&file), faults));
        assert_eq!(buffer(&recording), ["none"]);
        let found = turns(&recording);
        // Where each segment may begin: on a line between equal points every length is possible.
        let mut starts = vec![0_usize];
        for ends in points.windows(2) {
            let is_line = |start: usize, length: usize| {
                (0..=length).all(|turn| {
                    let expected = ends[0] + turn as f64 / length as f64 * (ends[1] - ends[0]);
                    found.get(start + turn).is_some_and(|x| (x - expected).abs() < 1e-12)
                })
            };
            let lengths = |start: usize| (SEGMENT - 1..=SEGMENT + 1).filter(move |length| is_line(start, *length));
            let mut next: Vec<_> =
                starts.iter().flat_map(|start| lengths(*start).map(move |length| start + length)).collect();
            next.dedup();
            assert!(!next.is_empty(), "no line from {} m to {} m at turns {starts:?}", ends[0], ends[1]);
            starts = next;
        }
        let at = starts[0];
        let strays = (0..300).filter(|k| (found[SEGMENT * k] - points[*k]).abs() > 1e-12).count();
        println!("sub-mode 0: {at} turns for {}, {strays} points not at their time", SEGMENT * 299);
        assert_eq!(strays > 0, lost > 0);
        assert!(found[at..].iter().all(|x| (x - points[299]).abs() < 1e-12), "at rest at the last point");
        // A turn in each segment is taken out of what was lost, until a segment begins within a turn of where it did.
        assert!(at.abs_diff(SEGMENT * 299 + lost) <= 1, "{at} turns");
    }
}

/// Oracle: where the tables end, and that nothing of the first is left when the second begins.
#[test]
fn tables_follow_each_other_by_every_door() {
    // Not a multiple of eight points: the counter of 2010h goes on.
    let file = sine(211);
    let steps = format!("{}[[program]]\nwait = \"0.3 s\"\n{}", table(&file), table(&file));
    let segments: Vec<f64> = micrometres(211);
    for (object, code) in [("2010h", -3), ("60C1h", -3), ("60C1h", -2), ("60C1h", -1), ("60C1h", 0), ("115h", -3)] {
        let recording = run(&by_object(object, &sub_mode(code), &steps, ""));
        assert_eq!(buffer(&recording), ["none"], "{object} {code}");
        let velocity = values(&recording, "setpoint.velocity");
        let moving: Vec<usize> = (0..velocity.len()).filter(|row| velocity[*row].abs() > 0.0).collect();
        // The sine stands still for a tick in its turning points; 0.1 s are not one of those.
        let ways: Vec<_> = moving.chunk_by(|row, next| next - row < 1600).collect();
        assert_eq!(ways.len(), 2, "{object} {code}");
        for way in ways {
            let length = way.len() as f64 * recording.rate.period();
            assert!((length - 2.1).abs() < 0.02, "{object} {code}: {length} s");
        }
        let last = values(&recording, "setpoint.position").last().copied().unwrap_or_default();
        assert!((last - 2.0 * segments[210]).abs() < 1.1e-6, "{object} {code}: {last}");
        assert!(peak(&recording, "following_error.motor") < 1e-3, "{object} {code}");
    }
}

#[test]
fn points_that_the_object_does_not_hold_are_refused() {
    let file = sine(30);
    let refused = |object, objects: &str| refusal(&by_object(object, objects, &table(&file), ""));
    for object in ["2010h", "115h"] {
        assert_eq!(
            refused(object, "\"60C0h\" = 0\n"),
            format!(
                "points by {object} carry their times: the interpolation sub-mode (60C0h) must be -2 or -3, got 0: \
                 send the points by 60C1h, or write another sub-mode (`bus.trajectory_buffer`, `drive.objects.60C0h`)"
            )
        );
    }
    // 60C2h is a millisecond unless written.
    assert_eq!(
        refused("60C1h", "\"60C0h\" = -1\n"),
        "point 1 of the table: a time to the next of 0.01 cannot be sent in a point of the trajectory buffer (60C1h), which \
         holds that of 60C2h only; write the time between the points to 60C2h, or -2 to 60C0h"
    );
}
