//! Interpolated position: tables on their way through the buffer of the drive, and when it follows them.
use super::{buffer, by_object, frequency, sine, streamed, sub_mode};
use crate::rig::{peak, run, scenario, text_of, values};
use servobench_plant::Exact;
use servobench_sim::{Bench, Outcome};
use std::f64::consts::TAU;
use std::fmt::Write as _;

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

/// Oracle: the same without the master's pause, and the pause.
#[test]
fn a_master_that_is_held_up_is_made_up_for() {
    let held_up = text_of("pt-two-clocks.toml", &[]);
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
            let bench = match Bench::new(&scenario(&text), &Exact) {
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
