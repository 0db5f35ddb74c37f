//! `servobench plan`
use crate::{code, json, said, servobench};
use std::fs;

/// Bar: Lambrechts' limits, order 3: 1.30 s; order 4: 1.35 s, t_d = t_j = t_a = 0.05 s, t_v = 0.65 s; at 1 ms the same.
#[test]
fn plan_reproduces_the_published_profile() {
    let limits = "--distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4 --json";
    for sampled in ["", "--sample-time 1ms"] {
        for (order, duration) in [(3, 1.3), (4, 1.35)] {
            let line = format!("plan --order {order} {limits} {sampled}");
            let output = servobench(&line.split_whitespace().collect::<Vec<_>>());
            assert_eq!(code(&output), 0, "{}", said(&output));
            let plan = json(&output.stdout);
            let near = |name: &str, expected: f64| {
                let found = plan[name].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-12, "{line}: {name} = {found}");
            };
            near("duration_s", duration);
            if order == 4 {
                for name in ["t_d", "t_j", "t_a"] {
                    near(name, 0.05);
                }
                near("t_v", 0.65);
                near("snap_effective", 1000.0);
            }
            let lengths = plan["segments"].as_array().unwrap().iter().map(|one| one["length_s"].as_f64().unwrap());
            assert!((lengths.sum::<f64>() - duration).abs() < 1e-12);
        }
    }
}

#[test]
fn plan_writes_tables_and_drawings_and_refuses_what_is_missing() {
    let work = tempfile::tempdir().unwrap();
    let (csv, svg) = (work.path().join("plan.csv"), work.path().join("plan.svg"));
    let arguments = ["plan", "--order", "2", "--distance", "-90 deg", "--velocity", "60 rpm", "--acceleration"];
    let mut drawn = arguments.to_vec();
    drawn.extend(["50 rad/s2", "--csv", csv.to_str().unwrap(), "--svg", svg.to_str().unwrap()]);
    let output = servobench(&drawn);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).lines().all(|line| line.chars().count() <= 80));
    let table = fs::read_to_string(csv).unwrap();
    let last: Vec<f64> = table.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!((last[1] + std::f64::consts::FRAC_PI_2).abs() < 1e-15, "{last:?}");
    assert!(fs::read_to_string(svg).unwrap().starts_with("<svg"));
    let output =
        servobench(&["plan", "--order", "3", "--distance", "1", "--velocity", "1 m/s", "--acceleration", "1 m/s2"]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("\"1 mm\" or \"1 deg\""), "{}", said(&output));
}

#[test]
fn plan_lists_every_mistake_and_says_what_it_does_not_use() {
    let output =
        servobench(&["plan", "--order", "4", "--distance", "1", "--velocity", "1 m", "--acceleration", "5 m/s2"]);
    assert_eq!(code(&output), 2);
    for expected in [
        "invalid value '1' for '--distance <DISTANCE>': a length or an angle needs its unit; write \"1 mm\" or \"1 deg\"",
        "invalid value '1 m' for '--velocity <VELOCITY>': a velocity or an angular velocity is needed",
        "--jerk <JERK>\n      Jerk limit, as \"50 m/s3\" (orders 3 and 4)",
        "--snap <SNAP>\n      Snap limit, as \"1000 m/s4\" (order 4)",
    ] {
        assert!(said(&output).contains(expected), "{expected} in:\n{}", said(&output));
    }
    let line = "plan --order 2 --distance 90deg --velocity 3000rpm --acceleration 50rad/s2 --snap 1rad/s4";
    let output = servobench(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(code(&output), 0, "{}", said(&output));
    let said = said(&output);
    for expected in
        ["--snap is not used by a move of order 2", "move of 90 deg in 354.490770 ms", "3000 rpm", "50 rad/s2"]
    {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
}

/// A sample time that is too short by some powers of ten costs a sentence, not the machine's memory.
#[test]
fn plan_refuses_a_table_of_absurd_length_and_draws_it_all_the_same() {
    let work = tempfile::tempdir().unwrap();
    let (csv, svg) = (work.path().join("plan.csv"), work.path().join("plan.svg"));
    let arguments = "plan --order 4 --distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4 \
                     --sample-time 1ns";
    let plan = |more: &[&str]| servobench(&[&arguments.split_whitespace().collect::<Vec<_>>()[..], more].concat());
    let output = plan(&["--csv", csv.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("--csv would write a table of 1350000001 rows"), "{}", said(&output));
    assert_eq!(fs::read_dir(work.path()).unwrap().count(), 0);
    assert_eq!(code(&plan(&["--svg", svg.to_str().unwrap()])), 0);
    assert!(svg.metadata().unwrap().len() < 100_000);
}

/// Seed: 100 mm at 200 mm/s and 100 000 mm/s², 25 % of the time: the ramp takes 2.28 ms of about 502 ms.
#[test]
fn a_ramp_is_drawn_alone() {
    let work = tempfile::tempdir().unwrap();
    let svg = work.path().join("ramp.svg");
    let plan = |more: &[&str]| {
        let line = ["plan", "rockwell", "--distance", "100 mm", "--velocity", "200 mm/s"];
        let limits = ["--acceleration", "100000 mm/s2", "--jerk-percent-of-time", "25", "--svg", svg.to_str().unwrap()];
        servobench(&[&line[..], &limits, more].concat())
    };
    let output = plan(&["--to", "4 ms"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let drawn = fs::read_to_string(&svg).unwrap();
    assert!(drawn.contains("from 0 to 4 ms") && drawn.contains(">time (ms)<"), "{drawn}");
    // Ends of segments at 0.286 ms, 2.0 ms and 2.286 ms, which are one line in the whole.
    assert_eq!(drawn.matches("class=\"b\"").count() % 3, 0);
    let output = plan(&["--from", "600 ms"]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("--from, --to: the move has no time from 0.6 s"), "{}", said(&output));
    let output = servobench(&[
        "plan",
        "--order",
        "2",
        "--distance",
        "1m",
        "--velocity",
        "1m/s",
        "--acceleration",
        "1m/s2",
        "--from",
        "1 s",
    ]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("--svg"), "{}", said(&output));
}
