//! What `servobench plan` refuses, and the way out that it names.
use crate::{code, folder, said, servobench};

const LIMITS: &str = "--distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4";
const ROCKWELL: &str = "--profile rockwell --distance 1m --velocity 1m/s --acceleration 1m/s2";

/// What `plan` says when it refuses the words of `line`.
fn refused(line: &str) -> String {
    let arguments: Vec<&str> = std::iter::once("plan").chain(line.split_whitespace()).collect();
    let output = servobench(&arguments);
    assert_eq!(code(&output), 2, "{line}: {}", said(&output));
    said(&output)
}

#[test]
fn every_mistake_names_its_flag_and_the_way_out() {
    for (line, expected) in [
        ("", "--distance is missing: how far the move goes, as \"1 m\""),
        ("", "--order is missing: 2 trapezoid, 3 jerk-limited, 4 snap-limited"),
        ("", "--velocity is missing: a move needs its limit, as \"1 m/s\""),
        (
            &format!("--order 4 {LIMITS} --plateau 0.2"),
            "--plateau is not used by this move: leave it out, or choose --profile position",
        ),
        (
            &format!("--order 4 {LIMITS} --points x.csv"),
            "--points is not used by this move: leave it out, or choose --profile pvt",
        ),
        (
            &format!("--order 4 {LIMITS} --shape s-curve"),
            "--shape is not used by this move: leave it out, or choose --profile rockwell",
        ),
        (
            &format!("--order 4 {LIMITS} --method optimal --sample-time 1ms --sampling fewest"),
            "--sampling is for --method published: the shortest move has the fewest samples of all; leave it out",
        ),
        (
            &format!("--order 4 {LIMITS} --sampling fewest"),
            "--sample-time is missing: --sampling needs one, as \"1 ms\"",
        ),
        (
            &format!("--order 4 {LIMITS} --start-velocity 1m/s --method optimal"),
            "--method is for a move from rest to rest: leave it out, or leave out --start-velocity",
        ),
        (
            &format!("--order 2 {LIMITS} --start-acceleration 1m/s2"),
            "--start-acceleration is not used by a move of order 2, whose acceleration may jump: leave it out, or choose \
             --order 3",
        ),
        (&format!("--order 3 {LIMITS} --start-jerk 1m/s3"), "--start-jerk is not used by a move of order 3"),
        (
            &format!("--order 4 {LIMITS} --end-velocity 2m/s"),
            "--end-velocity must be within the limits of velocity, got 2",
        ),
        (
            &format!("--order 4 {LIMITS} --negative-velocity -1m/s"),
            "--negative-velocity is a magnitude: write it without a sign",
        ),
        (&format!("--order 4 {LIMITS} --start-velocity 1rpm"), "--start-velocity `1rpm`: a velocity is needed"),
        (
            &format!("--order 4 {LIMITS} --start-velocity 1m/s --sample-time 1ms"),
            "--sample-time is not used by this move: leave it out; --csv-step says how far the rows of a table are apart",
        ),
        (ROCKWELL, "--maximum-jerk is missing: a trapezoid takes it, as \"1000 m/s3\""),
        (
            &format!("{ROCKWELL} --shape s-curve"),
            "--jerk is missing: or --jerk-percent-of-time, or --jerk-percent-of-maximum",
        ),
        (&format!("{ROCKWELL} --shape trapezoid --jerk 5m/s3"), "--jerk is for --shape s-curve"),
        (
            &format!("{ROCKWELL} --jerk-percent-of-time 125"),
            "--jerk-percent-of-time must be above 0 % and at most 100 %, got 125",
        ),
        (
            &format!("{ROCKWELL} --jerk-percent-of-time much"),
            "--jerk-percent-of-time `much`: write a number of percent, as 25",
        ),
        (
            &format!("{ROCKWELL} --jerk-percent-of-maximum 50%"),
            "--maximum-jerk is missing: a percentage of it is asked for",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zvd"),
            "--shaper-frequency is missing: a shaper is made for a vibration, as \"12 Hz\"",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper-damping 0.1"),
            "--shaper-damping is that of a --shaper: choose one, or leave it out",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zv --shaper-frequency 1Hz --shaper-damping 2"),
            "--shaper: `zeta` must be at least 0 and below 1, got 2",
        ),
        (
            &format!("--order 4 {LIMITS} --averages 10ms"),
            "--sample-time is missing: averages are those of samples, as \"1 ms\"",
        ),
        (
            &format!("--order 4 {LIMITS} --averages 1.5ms --sample-time 1ms"),
            "--averages must be a whole number of samples, 1 to 10 million, got 0.0015",
        ),
        (&format!("--order 4 {LIMITS} --duration 1s"), "--duration must be at least 1.35 s, got 1 s"),
        (
            &format!("--order 4 {LIMITS} --start-velocity 0.1m/s --duration 9s"),
            "--start-velocity must be zero for a move that is filtered or slowed, got 0.1",
        ),
        (
            &format!("--order 4 {LIMITS} --sample-time 1ns --execution euler"),
            "--sample-time must be long enough for a move of at most 10 million samples",
        ),
    ] {
        let said = refused(line);
        assert!(said.contains(expected), "{line}\n{expected} in:\n{said}");
    }
}

#[test]
fn a_table_is_refused_at_the_place_of_its_mistake() {
    let work = folder(&[
        ("good.csv", "time [ms],position [mm]\n0,0\n10,5\n"),
        ("wide.csv", "time [ms],position [mm]\n0,0\n10,5,3\n"),
        ("late.csv", "time [ms],position [mm]\n0,0\n10,5\n9,6\n"),
        ("one.csv", "time [ms],position [mm]\n0,0\n"),
    ]);
    let path = |name: &str| work.path().join(name).display().to_string();
    for (arguments, expected) in [
        (
            "--profile pvt".to_owned(),
            "--points is missing: a CSV file with the heading `time [ms],position [mm]".to_owned(),
        ),
        (format!("--profile pvt --points {}", path("no.csv")), format!("--points: cannot read `{}`: ", path("no.csv"))),
        (
            format!("--profile pvt --points {}", path("wide.csv")),
            format!("{}:3:1: a row of 3 values below a heading of 2", path("wide.csv")),
        ),
        (
            format!("--profile pvt --points {}", path("late.csv")),
            format!("{}:4:1: `time` is 0.009 s, not later than 0.01 s at the point before", path("late.csv")),
        ),
        (
            format!("--profile pvt --points {}", path("one.csv")),
            format!("{}:2:1: a table needs at least 2 points, this one has 1", path("one.csv")),
        ),
        (
            format!("--profile pvt --points {} --distance 1m", path("good.csv")),
            "--distance is not used by this move: leave it out; the table says where the move goes".to_owned(),
        ),
        (
            format!("--profile pvt --points {} --passes 3", path("good.csv")),
            "--passes are those of --velocities smooth: choose that, or leave them out".to_owned(),
        ),
        (
            format!("--profile position --points {}", path("good.csv")),
            "--plateau is missing: or --command-rate, or --allowed-error".to_owned(),
        ),
        (
            format!("--profile position --points {} --plateau 0.7", path("good.csv")),
            "--plateau must be above 0 (at least 1e-30) and at most 0.5, got 0.7".to_owned(),
        ),
        (
            format!("--profile position --points {} --command-rate 100", path("good.csv")),
            "--command-rate `100`: a frequency needs its unit; write \"100 Hz\"".to_owned(),
        ),
        (
            format!("--profile position --points {} --plateau 0.2 --averages 1ms --sample-time 1ms", path("good.csv")),
            "--averages is not for --profile position, whose commands a drive follows as they are".to_owned(),
        ),
        (
            format!("--profile position --points {} --command-rate 1e10Hz", path("good.csv")),
            "--command-rate must be low enough for at most 10 million commands".to_owned(),
        ),
    ] {
        let said = refused(&arguments);
        assert!(said.contains(&expected), "{arguments}\n{expected} in:\n{said}");
    }
}

/// A percentage and a value of the same jerk, a distance and a velocity as targets: the parser refuses both at once.
#[test]
fn what_excludes_each_other_is_refused() {
    for line in [
        format!("{ROCKWELL} --jerk 1m/s3 --jerk-percent-of-time 25"),
        format!("--order 4 {LIMITS} --to-velocity 1m/s"),
        "--profile position --points x.csv --plateau 0.2 --allowed-error 1um".to_owned(),
        format!("--order 4 {LIMITS} --csv-step 1ms"),
    ] {
        assert!(refused(&line).contains("--help"), "{line}");
    }
}
