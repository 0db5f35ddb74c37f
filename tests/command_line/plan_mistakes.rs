//! What `servobench plan` refuses, and the way out that it names.
use crate::{code, folder, said, servobench};

const LIMITS: &str = "--distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4";
const ROCKWELL: &str = "rockwell --distance 1m --velocity 1m/s --acceleration 1m/s2";

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
        ("", "--distance <DISTANCE>\n      Distance, as \"1 m\" or \"90 deg\"; its sign is the direction"),
        ("", "--order <ORDER>\n      Order of the profile: 2 trapezoid, 3 jerk-limited, 4 snap-limited"),
        ("", "--velocity <VELOCITY>\n      Velocity limit, as \"1 m/s\""),
        (
            &format!("--order 4 {LIMITS} --plateau 0.2"),
            "unexpected argument '--plateau' found\n\n  tip: it is an option of servobench plan position\n",
        ),
        (
            &format!("--order 4 {LIMITS} --points x.csv"),
            "unexpected argument '--points' found\n\n  tip: it is an option of servobench plan pvt, servobench plan position\n",
        ),
        (
            &format!("--order 4 {LIMITS} --shape s-curve"),
            "unexpected argument '--shape' found\n\n  tip: it is an option of servobench plan rockwell\n",
        ),
        (
            &format!("--order 4 {LIMITS} --method optimal --sample-time 1ms --sampling fewest"),
            "--sampling is for --method published: the shortest move has the fewest samples of all; leave it out",
        ),
        (
            &format!("--order 4 {LIMITS} --sampling fewest"),
            "--sample-time <TIME>\n      Make every time a whole number of samples of this length, as \"1 ms\"",
        ),
        (
            &format!("--order 4 {LIMITS} --start-velocity 1m/s --method optimal"),
            "the argument '--method <METHOD>' cannot be used with '--start-velocity <VELOCITY>'",
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
            "invalid value '-1m/s' for '--negative-velocity <VELOCITY>': it is a magnitude: write it without a sign",
        ),
        (&format!("--order 4 {LIMITS} --start-velocity 1rpm"), "--start-velocity `1rpm`: a velocity is needed"),
        (
            &format!("--order 4 {LIMITS} --start-velocity 1m/s --sample-time 1ms"),
            "--sample-time is not used by a move from a state of motion: leave it out; --csv-step says how far the rows",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zvd"),
            "--shaper-frequency <FREQUENCY>\n      Natural frequency of the vibration, as \"12 Hz\"",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper-damping 0.1"),
            "--shaper <SHAPER>\n      Input shaper for one vibration",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zv --shaper-frequency 1Hz --shaper-damping 2"),
            "--shaper: `zeta` must be at least 0 and below 1, got 2",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zv,zvd --shaper-frequency 1Hz"),
            "--shaper-frequency has 1 values and --shaper 2: give a frequency for each shaper",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zv,zvd,mzv --shaper-frequency 1Hz,2Hz,3Hz --shaper-damping 0.1,0.2"),
            "--shaper-damping has 2 values for 3 shapers: give one for all, or one for each",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zv --shaper-frequency 1Hz --shaper-tolerable 1%"),
            "--shaper-tolerable is for the EI shapers: the others leave nothing at the frequency",
        ),
        (
            &format!("--order 4 {LIMITS} --shaper zvdd,zvdd,zvd --shaper-frequency 9Hz,17Hz,29Hz"),
            "--shaper: the filter has 48 impulses, at most 32 are kept: take fewer shapers or shorter ones, or filter one after",
        ),
        (
            &format!("--order 4 {LIMITS} --averages 10ms"),
            "--sample-time <TIME>\n      Make every time a whole number of samples of this length, as \"1 ms\"",
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
fn every_mistake_in_rockwells_operands_names_its_flag_and_the_way_out() {
    for (line, expected) in [
        (ROCKWELL, "--maximum-jerk is missing: a trapezoid takes it, as \"1000 m/s3\""),
        (
            &format!("{ROCKWELL} --shape s-curve"),
            "--jerk is missing: or --jerk-percent-of-time, or another way to say it",
        ),
        (&format!("{ROCKWELL} --shape trapezoid --jerk 5m/s3"), "--shape trapezoid takes all of --maximum-jerk"),
        (
            &format!("{ROCKWELL} --jerk-percent-of-time 25 --master-speed 360"),
            "--master-speed is not used: no jerk is given in master units; leave it out",
        ),
        (&format!("{ROCKWELL} --jerk-master-units 2"), "--master-speed <SPEED>"),
        (
            &format!("{ROCKWELL} --jerk-percent-of-time 125"),
            "--jerk-percent-of-time must be above 0 % and at most 100 %, got 125",
        ),
        (
            &format!("{ROCKWELL} --jerk-percent-of-time much"),
            "invalid value 'much' for '--jerk-percent-of-time <PERCENT>': write a number of percent, as 25",
        ),
        (
            &format!("{ROCKWELL} --jerk-percent-of-maximum 50%"),
            "--maximum-jerk is missing: a percentage of it is asked for",
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
            "pvt".to_owned(),
            "--points <FILE>\n      Table of points: time, position and, if known, velocity, with their units".to_owned(),
        ),
        (format!("pvt --points {}", path("no.csv")), format!("--points: cannot read `{}`: ", path("no.csv"))),
        (
            format!("pvt --points {}", path("wide.csv")),
            format!("{}:3:1: a row of 3 values below a heading of 2", path("wide.csv")),
        ),
        (
            format!("pvt --points {}", path("late.csv")),
            format!("{}:4:1: `time` is 0.009 s, not later than 0.01 s at the point before", path("late.csv")),
        ),
        (
            format!("pvt --points {}", path("one.csv")),
            format!("{}:2:1: a table needs at least 2 points, this one has 1", path("one.csv")),
        ),
        (
            format!("pvt --points {} --distance 1m", path("good.csv")),
            "tip: it is an option of servobench plan, servobench plan rockwell".to_owned(),
        ),
        (
            format!("pvt --points {} --passes 3", path("good.csv")),
            "--passes are those of --velocities smooth: choose that, or leave them out".to_owned(),
        ),
        (
            format!("position --points {}", path("good.csv")),
            "<--plateau <ALPHA>|--command-rate <RATE>|--allowed-error <DISTANCE>>".to_owned(),
        ),
        (
            format!("position --points {} --plateau 0.7", path("good.csv")),
            "--plateau must be above 0 (at least 1e-30) and at most 0.5, got 0.7".to_owned(),
        ),
        (
            format!("position --points {} --plateau auto --velocity 1m/s", path("good.csv")),
            "--plateau auto is chosen by limits: give --velocity and --acceleration".to_owned(),
        ),
        (
            format!("position --points {} --plateau 0.2 --velocity 1m/s", path("good.csv")),
            "--velocity and --acceleration choose the share of --plateau auto: choose that, or leave them out".to_owned(),
        ),
        (
            format!("position --points {} --plateau auto --velocity 1m/s --acceleration 1um/s2", path("good.csv")),
            "no share of plateaus keeps `acceleration` within 0.000001 (SI)".to_owned(),
        ),
        (
            format!("position --points {} --plateau best", path("good.csv")),
            "'best' for '--plateau <ALPHA>'".to_owned(),
        ),
        (
            format!("position --points {} --command-rate 100", path("good.csv")),
            "'100' for '--command-rate <RATE>': a frequency needs its unit; write \"100 Hz\"".to_owned(),
        ),
        (
            format!("position --points {} --plateau 0.2 --averages 1ms --sample-time 1ms", path("good.csv")),
            "'--averages' found\n\n  tip: it is an option of servobench plan, servobench plan rockwell, servobench plan pvt"
                .to_owned(),
        ),
        (
            format!("position --points {} --command-rate 1e10Hz", path("good.csv")),
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
        "position --points x.csv --plateau 0.2 --allowed-error 1um".to_owned(),
        format!("--order 4 {LIMITS} --csv-step 1ms"),
    ] {
        assert!(refused(&line).contains("--help"), "{line}");
    }
}

/// All that the parser can find, in the order of its finding: values and options of other profiles, then what is missing.
#[test]
fn every_mistake_that_the_parser_finds_is_told_at_once() {
    let said = refused(
        "rockwell --distance 1 --velocity 1m --order 4 --csv-step 1 --passes=3 --acceleration 1m/s2 --shaper zv",
    );
    let lines: Vec<&str> = said.lines().filter(|line| line.starts_with("error: ")).collect();
    let [distance, order, velocity, passes, step, missing] = lines.as_slice() else { panic!("{said}") };
    assert!(distance.starts_with("error: invalid value '1' for '--distance <DISTANCE>': "), "{said}");
    assert_eq!(*order, "error: unexpected argument '--order' found");
    assert!(velocity.starts_with("error: invalid value '1m' for '--velocity <VELOCITY>': "), "{said}");
    assert_eq!(*passes, "error: unexpected argument '--passes' found");
    assert!(step.starts_with("error: invalid value '1' for '--csv-step <TIME>': "), "{said}");
    assert_eq!(*missing, "error: the following required arguments were not provided:");
    assert!(said.contains("  --csv <FILE>\n") && said.contains("  --shaper-frequency <FREQUENCY>\n"), "{said}");
    assert_eq!((said.matches("Usage:").count(), said.matches("try '--help'").count()), (1, 1), "{said}");
}

/// What `--profile` was is a command; what else is wrong below the former name is nobody's question.
#[test]
fn a_profile_that_is_chosen_as_it_was_is_told_its_command() {
    for (line, expected) in [
        (
            "--profile rockwell --distance 1m --shape s-curve",
            "each profile is a command now: servobench plan rockwell …",
        ),
        ("--profile=pvt --points x.csv", "each profile is a command now: servobench plan pvt …"),
        ("--profile point-to-point --order 9", "leave --profile out: servobench plan --order … --distance …"),
    ] {
        let said = refused(line);
        assert!(said.contains(expected) && said.matches("error: ").count() == 1, "{line}\n{expected} in:\n{said}");
    }
}
