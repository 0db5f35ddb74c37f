//! Ways that the drive makes itself: profile velocity, interpolated position, profile position.
mod points;
mod stream;
mod told;

use crate::rig::{axis, run, scenario, text_of, values};
use servobench_motion::position_profile::Spline;
use servobench_motion::pvt::Knot;
use servobench_sim::Program;
use servobench_trace::Recording;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// A ball screw under a stiff drive; the bus is to be given.
const AXIS: &str = concat!(axis!(), "velocity = true\neffort = \"rigid\"\n");

fn stored(name: &str) -> Recording {
    run(&text_of(name, &[]))
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

/// Baikov & Godunov: plateaus meet every position, and the spline followed by steps of velocity is off by what the plan
/// announces. Oracle: the plan of the moves, and the table; the drive's velocity is summed up.
#[test]
fn a_position_profile_in_profile_velocity_mode_meets_its_positions() {
    let scenario = scenario(&text_of("pv-position-profile.toml", &[]));
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
        let mut program = Program::new(&scenario).unwrap_or_else(|error| panic!("{error}"));
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
