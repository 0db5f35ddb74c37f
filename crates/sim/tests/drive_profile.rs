//! Ways that the drive makes itself: profile velocity, interpolated position, profile position.
use servobench_motion::position_profile::Spline;
use servobench_motion::pvt::Knot;
use servobench_motion::{Limits, Order, Profile};
use servobench_plant::Exact;
use servobench_scenario as scenario;
use servobench_sim::{Bench, Outcome, Program};
use servobench_trace::Recording;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

/// A ball screw under a stiff drive; the bus is to be given.
const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
dc_link = "320 V"
max_torque = "6.09 Nm"
[drive.feedforward]
velocity = true
effort = "rigid"
friction = true
"#;

fn run(text: &str) -> Recording {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc");
    let loaded = scenario::parse_within("test", text, Some(&folder), &[], Some(Path::new("/")))
        .unwrap_or_else(|error| panic!("{error}"));
    let bench = Bench::new(&loaded.scenario, &Exact).unwrap_or_else(|error| panic!("{error}"));
    let Outcome { recording, failure } = bench.run(&mut |_| {});
    assert_eq!(failure, None);
    recording
}

fn stored(name: &str) -> Recording {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc").join(name);
    run(&std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{error}")))
}

fn values<'a>(recording: &'a Recording, name: &str) -> &'a [f64] {
    recording.channel(name).unwrap_or_else(|| panic!("no channel {name}"))
}

fn peak(recording: &Recording, name: &str) -> f64 {
    values(recording, name).iter().fold(0.0, |peak, value| value.abs().max(peak))
}

/// Baikov & Godunov: plateaus meet every position, and the spline followed by steps of velocity is off by what the plan
/// announces. Oracle: the plan of the moves, and the table; the drive's velocity is summed up.
#[test]
fn a_position_profile_in_profile_velocity_mode_meets_its_positions() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc/pv-position-profile.toml");
    let loaded = scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let recording = stored("pv-position-profile.toml");
    let velocity = values(&recording, "setpoint.velocity");
    let table = [5.0, 20.0, 45.0, 70.0, 90.0, 100.0, 102.0, 101.0, 100.0, 100.0].map(|millimetres| 1e-3 * millimetres);
    let tick = recording.rate.period();
    let powered = recording.moves[0].start - 0.1;
    let mut knots = [Knot::default(); 11];
    for (k, (knot, x)) in (1_u32..).zip(knots[1..].iter_mut().zip(table)) {
        *knot = Knot::new(0.05 * f64::from(k), x);
    }
    let mut scratch = [0.0; 11];
    let spline = Spline::solve(&mut knots, 0.0, 0.0, &mut scratch).unwrap_or_else(|error| panic!("{error}"));
    let stepped = spline.stepped(200.0).unwrap_or_else(|error| panic!("{error}"));
    for (made, announced) in recording.moves.iter().zip([0.0, stepped.largest_error()]) {
        let mut program = Program::new(&loaded.scenario).unwrap_or_else(|error| panic!("{error}"));
        let (start, mut x) = (recording.index_at(made.start), 0.0);
        let (mut worst, mut from_plan) = (0.0_f64, 0.0_f64);
        for (k, pair) in velocity[start..].windows(2).take(8000).enumerate() {
            x += tick * f64::midpoint(pair[0], pair[1]);
            let planned = program.at(recording.time_of(start + k + 1) - powered).x - made.from;
            from_plan = from_plan.max((x - planned).abs());
            // A point every 50 ms.
            if (k + 1) % 800 == 0 {
                worst = worst.max((x - table[k / 800]).abs());
            }
        }
        println!(
            "{}: {from_plan:.1e} m from its plan, {worst:.2e} m from its points, {announced:.2e} m announced",
            made.label
        );
        // The drive is sent whole increments per second, 1e-8 m/s, and is between two of its steps for a tick.
        assert!(from_plan < 0.1e-6, "{}: {from_plan}", made.label);
        assert!(worst <= announced + 0.1e-6, "{}: {worst}", made.label);
    }
}

/// About 3 rad/s: whole periods of so many points, one every 10 ms.
fn frequency(points: u32) -> f64 {
    let length = 0.01 * f64::from(points - 1);
    TAU * (3.0 * length / TAU).round() / length
}

/// So many points of a sine, from rest to rest, as CSV.
fn sine(points: u32) -> tempfile::NamedTempFile {
    let omega = frequency(points);
    let mut text = "time [ms],position [mm],velocity [mm/s]\n".to_owned();
    for k in 0..points {
        let t = 0.01 * f64::from(k);
        let (x, v) = (50.0 * (1.0 - (omega * t).cos()), 50.0 * omega * (omega * t).sin());
        let v = if k == 0 || k + 1 == points { 0.0 } else { v };
        let _ = writeln!(text, "{},{x},{v}", 10 * k);
    }
    let mut file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap_or_else(|error| panic!("{error}"));
    std::io::Write::write_all(&mut file, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    file
}

fn streamed(file: &tempfile::NamedTempFile, faults: &str) -> Recording {
    let table = format!(
        "[bus]\ncycle = \"1 ms\"\nmode = \"ip\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n{faults}\n\
         [[program]]\ntable = {{ file = \"{}\" }}\n",
        file.path().display()
    );
    run(&format!("{AXIS}{table}"))
}

/// What the buffer of the drive has latched, one after the other.
fn buffer(recording: &Recording) -> Vec<&str> {
    let signal = recording.signal("drive", "buffer").unwrap_or_else(|| panic!("no buffer"));
    signal.changes.iter().map(|(_, value)| value.as_str()).collect()
}

/// Oracle: the sine itself. A cubic by positions and velocities is off by ω⁴·A·T⁴/384 of it, 1e-10 m; the points are whole
/// micrometres.
#[test]
fn ten_thousand_points_are_streamed_with_jitter_and_none_is_missing() {
    let file = sine(10_000);
    let recording = streamed(&file, "[[bus.fault]]\nkind = \"jitter\"\nby = \"500 us\"\nseed = 3\n");
    assert_eq!(buffer(&recording), ["none"]);
    // 32 places, all free before the first point and after the last.
    let free = recording.signal("drive", "buffer_free").unwrap_or_else(|| panic!("no 2011h"));
    let places: Vec<u16> =
        free.changes.iter().map(|(_, value)| value.parse().unwrap_or_else(|e| panic!("{e}"))).collect();
    assert!(places.first() == Some(&32) && places.last() == Some(&32) && places.iter().min() < Some(&8), "{places:?}");
    // 2012h: the number of the next segment in the lower half, and nothing that went wrong.
    let status = recording.signal("drive", "buffer_status").unwrap_or_else(|| panic!("no 2012h"));
    assert!(status.changes.len() > 1000 && status.changes.iter().all(|(_, value)| value.ends_with('h')), "2012h");
    let omega = frequency(10_000);
    let setpoint = values(&recording, "setpoint.position");
    let begins = setpoint.iter().position(|x| *x > 0.0).unwrap_or_else(|| panic!("nothing moves"));
    let tick = recording.rate.period();
    // The first segment begins at most one step of the drive before the position is above zero.
    let off = |shift: usize| {
        let errors = setpoint[begins - shift..]
            .iter()
            .take(1_590_000)
            .enumerate()
            .map(|(k, x)| (x - 0.05 * (1.0 - (omega * k as f64 * tick).cos())).abs());
        errors.fold(0.0, f64::max)
    };
    let best = (0..200).map(off).fold(f64::INFINITY, f64::min);
    println!("10 000 points: off by {best:.2e} m at most");
    assert!(best < 1.5e-6, "{best}");
}

/// The master stops: the buffer runs empty, which is latched, and the axis comes to rest within its limits.
#[test]
fn a_master_that_stops_leaves_an_underflow_and_a_stop() {
    let file = sine(1_000);
    let recording = streamed(&file, "[[bus.fault]]\nkind = \"master-stopped\"\nstart = \"2.03 s\"\n");
    assert_eq!(buffer(&recording), ["none", "Underflow"]);
    let velocity = values(&recording, "setpoint.velocity");
    let stop = velocity.iter().rposition(|v| v.abs() > 0.0).map_or(0.0, |row| recording.time_of(row));
    println!("at rest at {stop} s");
    assert!(stop > 2.03 && stop < 2.6, "the points in the buffer, then a ramp: {stop}");
    // At the cycles of the position loop, every fourth tick: between them a set-point goes straight on.
    let turns: Vec<f64> = velocity.iter().step_by(4).copied().collect();
    let steepest = turns.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    // The quick stop has twice the largest acceleration of the table.
    let quick_stop = 2.0 * recording.moves[0].peaks[1];
    println!("{} m/s² of {quick_stop}", steepest / recording.rate.period());
    assert!(steepest <= 1.000_001 * quick_stop * 250e-6, "{steepest} m/s in a turn, {quick_stop} m/s²");
    assert!(peak(&recording, "following_error.motor") < 1e-3);
}

/// Profile position: the drive plans each move itself. Oracle: a trapezoid by hand, 100 mm at 0.5 m/s and 5 m/s² take
/// 0.1/0.5 + 0.5/5 = 0.3 s, and back again after the pause.
#[test]
fn moves_in_profile_position_are_the_drives_own() {
    let recording = run(&format!(
        "{AXIS}[bus]\ncycle = \"1 ms\"\nmode = \"pp\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n\
         [setpoint]\norder = 2\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\n\
         [[program]]\nmove_to = \"100 mm\"\n[[program]]\nwait = \"0.1 s\"\n[[program]]\nmove_by = \"-100 mm\"\n"
    ));
    let (x, v) = (values(&recording, "setpoint.position"), values(&recording, "setpoint.velocity"));
    let moving: Vec<usize> = (0..v.len()).filter(|row| v[*row].abs() > 0.0).collect();
    let ways: Vec<(f64, f64)> = moving
        .chunk_by(|row, next| next - row < 16)
        .map(|rows| (rows.len() as f64 * recording.rate.period(), x[rows[rows.len() - 1]]))
        .collect();
    println!("{ways:?}");
    assert_eq!(ways.len(), 2, "{ways:?}");
    for ((length, end), target) in ways.iter().zip([0.1, 0.0]) {
        assert!((length - 0.3).abs() < 1e-3 && (end - target).abs() < 1e-5, "{ways:?}");
    }
    assert!((peak(&recording, "setpoint.velocity") - 0.5).abs() < 1e-9);
    assert!(peak(&recording, "following_error.motor") < 1e-3);
}

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
        let loaded = scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}"));
        let program = Program::new(&loaded.scenario).unwrap_or_else(|error| panic!("{error}"));
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
    let refused = |objects: &str, time: &str| {
        let text = by_object("60C1h", objects, steps, &format!("point_time = \"{time}\"\n"));
        let loaded = scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}"));
        Bench::new(&loaded.scenario, &Exact).err().map(|error| error.to_string()).unwrap_or_default()
    };
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

/// A program of `steps` in interpolated position, its points by `object` in units of a micrometre, with `objects` of the drive.
fn by_object(object: &str, objects: &str, steps: &str, faults: &str) -> String {
    format!(
        "{AXIS}[drive.objects]\n{objects}[bus]\ncycle = \"1 ms\"\nmode = \"ip\"\ntrajectory_buffer = \"{object}\"\n\
         units = {{ drive = 1000, axis = \"1 mm\" }}\n{faults}{steps}"
    )
}

fn table(file: &tempfile::NamedTempFile) -> String {
    format!("[[program]]\ntable = {{ file = \"{}\" }}\n", file.path().display())
}

/// 60C0h, and 10 ms in 60C2h.
fn sub_mode(code: i32) -> String {
    format!("\"60C0h\" = {code}\n\"60C2h.1\" = 10\n\"60C2h.2\" = -3\n")
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
    let refused = |object, objects: &str| {
        let text = by_object(object, objects, &table(&file), "");
        let loaded = scenario::parse_within("test", &text, Some(Path::new(".")), &[], Some(Path::new("/")))
            .unwrap_or_else(|error| panic!("{error}"));
        Bench::new(&loaded.scenario, &Exact).err().map(|error| error.to_string()).unwrap_or_default()
    };
    for object in ["2010h", "115h"] {
        assert_eq!(
            refused(object, "\"60C0h\" = 0\n"),
            format!(
                "points by {object} have times of their own: the interpolation sub-mode (60C0h) must be -2 or -3, got 0: \
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

/// Oracle: the same without the master's pause, and the pause.
#[test]
fn a_master_that_is_held_up_is_made_up_for() {
    let text = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/plc").join(name);
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{error}"))
    };
    let held_up = text("pt-two-clocks.toml");
    let in_time = held_up.replace("start = \"4 s\"", "start = \"100 s\"");
    assert_ne!(held_up, in_time);
    let end = |text: &str| {
        let recording = run(text);
        assert_eq!(buffer(&recording), ["none"]);
        assert!(peak(&recording, "following_error.load") < 100e-6);
        let velocity = values(&recording, "setpoint.velocity");
        recording.time_of(velocity.iter().rposition(|v| v.abs() > 0.0).unwrap_or_default())
    };
    let late = end(&held_up) - end(&in_time);
    println!("{late} s late");
    // To two steps of the drive.
    assert!((late - 20e-3).abs() < 0.6e-3, "{late}");
}

/// The drive begins each table when its points are there, few or many, and when it has come to the end of the one before: the request goes
/// through the middle of each move when the drive's own set-point does, and the recording says that it began and ended then.
#[test]
fn the_request_begins_a_table_when_the_drive_does() {
    let targets = [0.0, 0.2, 0.203, 0.15, 0.152];
    let steps = |pause: &str| {
        let moves: Vec<_> =
            targets[1..].iter().map(|to| format!("[[program]]\nmove_to = \"{to} m\"\n{pause}")).collect();
        let moves = moves.concat();
        format!(
            "[setpoint]\norder = 3\nvelocity = \"0.5 m/s\"\nacceleration = \"4 m/s2\"\njerk = \"120 m/s3\"\n\
             [[program]]\nwait = \"0.1003 s\"\n{moves}[[program]]\nwait = \"0.3 s\"\n"
        )
    };
    let wait = |time: &str| format!("[[program]]\nwait = \"{time}\"\n");
    for pause in [wait("0.3007 s"), wait("8 ms"), String::new()] {
        for (object, code, more) in [
            ("2010h", -3, ""),
            ("60C1h", -3, "motion_cycle = \"4 ms\"\n"),
            ("60C1h", -3, "delay = 2\n"),
            ("60C1h", -2, ""),
            ("60C1h", -1, ""),
            ("60C1h", -1, "delay = 0\nmotion_cycle = \"2 ms\"\n"),
            ("60C1h", 0, ""),
            ("60C1h", 0, "delay = 3\nmotion_cycle = \"2 ms\"\n"),
            ("115h", -3, ""),
            ("115h", -3, "delay = 3\n"),
            ("115h", -3, "delay = 0\nmotion_cycle = \"4 ms\"\n"),
        ] {
            let bus = format!("point_time = \"10 ms\"\n{more}");
            let recording = run(&by_object(object, &sub_mode(code), &steps(&pause), &bus));
            let [setpoint, request] = ["setpoint.position", "request.position"].map(|name| values(&recording, name));
            for (made, way) in recording.moves.iter().zip(targets.windows(2)) {
                let after = recording.index_at(made.start);
                let passed = |values: &[f64], place: f64| {
                    let passes = |pair: &[f64]| (pair[0] - place) * (pair[1] - place) <= 0.0;
                    after + values[after..].windows(2).position(passes).unwrap_or_else(|| panic!("never at {place}"))
                };
                let middle = f64::midpoint(way[0], way[1]);
                let rows = [setpoint, request].map(|values| passed(values, middle));
                let [of_drive, of_task] = rows.map(|row| recording.time_of(row));
                // To a step of the drive; a line is not in the middle when its move is.
                let case = format!("{object} {code} {more:?} {pause:?} to {}", way[1]);
                assert!((of_drive - of_task).abs() < 0.26e-3, "{case}: {of_drive} s, and {of_task} s");
                let halfway = f64::midpoint(made.start, made.end);
                assert!((halfway - of_task).abs() < 5e-3, "{case}: {of_task} s, and recorded {halfway} s");
            }
        }
    }
}

/// Points of a way there and back over 40 mm, at times of 1 ms to 20 ms, or of 10 ms, and its length (s).
fn uneven(seed: u64, has_own_times: bool) -> (tempfile::NamedTempFile, f64) {
    let mut state = seed;
    let times: Vec<u32> = (0..60)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // Some tables are fast all the way, others slow.
            let slowest = 1 + u32::try_from(seed % 20).unwrap_or_default();
            if has_own_times { 1 + u32::try_from(state >> 33).unwrap_or_default() % slowest } else { 10 }
        })
        .collect();
    let length = 1e-3 * f64::from(times.iter().sum::<u32>());
    let mut text = "time [ms],position [mm],velocity [mm/s]\n".to_owned();
    let mut t = 0;
    for k in 0..=times.len() {
        let phase = TAU * 1e-3 * f64::from(t) / length;
        let v = if k == 0 || k == times.len() { 0.0 } else { 20.0 * TAU / length * phase.sin() };
        let _ = writeln!(text, "{t},{},{v}", 20.0 * (1.0 - phase.cos()));
        t += times.get(k).copied().unwrap_or_default();
    }
    let mut file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap_or_else(|error| panic!("{error}"));
    std::io::Write::write_all(&mut file, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    (file, length)
}

/// Through every door and over a bus of any delay a table is followed to the end, or refused with the delay that the buffer carries: none
/// runs over, none runs empty. `SERVOBENCH_SWEEP` says how many tables for each.
#[test]
fn a_table_is_followed_or_refused_whatever_the_delay() {
    let tables: u64 = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|size| size.parse().ok()).unwrap_or(1);
    let delays: &[u32] =
        if tables > 1 { &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15] } else { &[0, 3, 8, 15] };
    let (mut followed, mut refused) = (0, 0);
    for (object, code) in [("2010h", -3), ("60C1h", -3), ("60C1h", -2), ("60C1h", -1), ("60C1h", 0), ("115h", -3)] {
        for (delay, table) in delays.iter().flat_map(|delay| (0..tables).map(move |table| (*delay, table))) {
            let has_own_times = code < -1;
            let seed = if tables == 1 { u64::from(delay) * 5 + 4 } else { table };
            let (file, length) = uneven(seed, has_own_times);
            let steps = format!(
                "[[program]]\ntable = {{ file = \"{}\" }}\n[[program]]\nwait = \"0.1 s\"\n",
                file.path().display()
            );
            let text = by_object(object, &sub_mode(code), &steps, &format!("delay = {delay}\n"));
            let case = format!("{object} {code}, delay {delay}, table {seed}");
            let loaded = scenario::parse_within("test", &text, Some(Path::new(".")), &[], Some(Path::new("/")))
                .unwrap_or_else(|error| panic!("{error}"));
            let bench = match Bench::new(&loaded.scenario, &Exact) {
                Ok(bench) => bench,
                Err(error) => {
                    let words = error.to_string();
                    assert!(words.contains("the trajectory buffer runs empty"), "{case}: {words}");
                    refused += 1;
                    continue;
                }
            };
            let Outcome { recording, failure } = bench.run(&mut |_| {});
            assert_eq!(failure, None, "{case}");
            assert_eq!(buffer(&recording), ["none"], "{case}");
            let setpoint = values(&recording, "setpoint.position");
            let highest = setpoint.iter().fold(0.0, |highest: f64, x| highest.max(*x));
            assert!((highest - 0.04).abs() < 3e-4, "{case}: {highest}");
            assert!(setpoint[setpoint.len() - 1].abs() < 1.1e-6, "{case}");
            let begun = recording.moves[0].start;
            let off = setpoint.iter().enumerate().map(|(row, x)| {
                let t = (recording.time_of(row) - begun).clamp(0.0, length);
                (x - 0.02 * (1.0 - (TAU * t / length).cos())).abs()
            });
            // A step of the drive at the highest velocity, and the sagitta of lines.
            let (step, sagitta) =
                (250e-6 * 0.02 * TAU / length, 0.02 * (TAU / length).powi(2) * 0.02_f64.powi(2) / 8.0);
            let worst = off.fold(0.0, f64::max);
            assert!(code == 0 || worst < step + sagitta + 3e-6, "{case}: {worst} m off");
            followed += 1;
        }
    }
    println!("{followed} tables followed, {refused} refused");
    assert!(followed > 3 * refused, "{followed} followed, {refused} refused");
}

/// A master that is held up, or hears nothing of the drive for a while, sends no more than there is room for: the answers that it has are
/// old, but each tells how many points had arrived with the room that was left.
#[test]
fn old_answers_do_not_fill_the_buffer() {
    let file = sine(60);
    for delay in [1, 2, 4] {
        for (kind, by) in [("task-late", "by = \"3 ms\""), ("drive-silent", ""), ("late", "by = \"3 ms\"")] {
            for start in ["20 ms", "40 ms", "61 ms"] {
                let fault = format!("[[bus.fault]]\nkind = \"{kind}\"\nstart = \"{start}\"\ncycles = 15\n{by}\n");
                let recording = streamed(&file, &format!("delay = {delay}\n{fault}"));
                // Two cycles of a late task in one of the bus lose a point, which is another fault.
                let overflows = buffer(&recording).iter().any(|states| states.contains("Overflow"));
                assert!(!overflows, "{kind} at {start} behind {delay} cycles");
            }
        }
    }
}

/// A drive whose gear ratio (6091h), encoder resolution (608Fh) or feed (6092h) is wrong by two goes half as far or twice, and reads what it
/// was told: target (607Ah) and actual position (6064h) are in one unit. Oracle: 100 mm, by the ratio of right and wrong.
#[test]
fn a_wrong_factor_group_scales_the_way_and_not_what_is_read() {
    let moved = |mode: &str, write: &str| {
        let recording = run(&format!(
            "{AXIS}[drive.objects]\n{write}\n[bus]\ncycle = \"1 ms\"\nmode = \"{mode}\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n\
             [setpoint]\norder = 2\nvelocity = \"0.2 m/s\"\nacceleration = \"2 m/s2\"\n[[program]]\nmove_to = \"100 mm\"\n\
             [[program]]\nwait = \"0.4 s\"\n"
        ));
        let last = |name| values(&recording, name).last().copied().unwrap_or_default();
        (last("load.position"), last("bus.position"))
    };
    for mode in ["csp", "pp", "ip"] {
        for (write, way) in [("", 0.1), ("\"6091h.1\" = 2", 0.2), ("\"6091h.2\" = 2", 0.05), ("\"60C0h\" = -3", 0.1)] {
            let (load, read) = moved(mode, write);
            assert!((load - way).abs() < 2e-6, "{mode}, {write}: the load is at {load} m");
            assert!((read - 0.1).abs() < 3e-6, "{mode}, {write}: {read} m are read");
        }
    }
}

/// In profile position the drive makes its own profile, whatever that of the program is: linear ramps, or jerk-limited ones. Oracle: its
/// set-point, which the request meets to a step of the drive, and by hand 0.1/0.4 + 0.4/4 = 0.35 s for a trapezoid over 100 mm.
#[test]
fn the_request_in_profile_position_is_the_profile_of_the_drive() {
    for (objects, length) in [("", 0.35), ("\"6086h\" = 3\n\"60A4h.1\" = 40000000\n", 0.45)] {
        let recording = run(&format!(
            "{AXIS}[drive.objects]\n{objects}[bus]\ncycle = \"1 ms\"\nmode = \"pp\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n\
             [setpoint]\norder = 3\nvelocity = \"0.4 m/s\"\nacceleration = \"4 m/s2\"\njerk = \"90 m/s3\"\n\
             [[program]]\nwait = \"0.1003 s\"\n[[program]]\nmove_to = \"100 mm\"\n[[program]]\nwait = \"0.25 s\"\n\
             [[program]]\nmove_to = \"0 mm\"\n[[program]]\nwait = \"0.3 s\"\n"
        ));
        let [setpoint, request] = ["setpoint.position", "request.position"].map(|name| values(&recording, name));
        let off = setpoint.iter().zip(request).map(|(x, wanted)| (x - wanted).abs()).fold(0.0, f64::max);
        assert!(off < 0.4 * 0.3e-3, "{objects}: {off} m");
        for made in &recording.moves {
            assert!((made.end - made.start - length).abs() < 1e-9, "{objects}: {} s", made.end - made.start);
            let begins = recording.index_at(made.start);
            let moves = |row: usize| (setpoint[row] - setpoint[row - 1]).abs() > 0.0;
            assert!(!moves(begins - 2) && moves(begins + 10), "{objects}: it begins at {} s", made.start);
        }
    }
}
