//! `servobench plan` for every family of set-points.
use crate::{code, folder, json, said, servobench};
use serde_json::Value;
use std::fs;
use std::path::Path;

const LAMBRECHTS: &str = "--velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --snap 1000m/s4";

/// Runs `plan` with the words of `line`; what it says fits the screen.
fn plan(line: &str) -> String {
    let arguments: Vec<&str> = std::iter::once("plan").chain(line.split_whitespace()).collect();
    let output = servobench(&arguments);
    assert_eq!(code(&output), 0, "{line}: {}", said(&output));
    let said = said(&output);
    assert!(line.contains("--json") || said.lines().all(|line| line.chars().count() <= 80), "{said}");
    said
}

fn json_of(line: &str) -> Value {
    json(plan(&format!("{line} --json")).as_bytes())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// (384/512)^¼ of the time, where snap alone binds.
#[test]
fn the_shortest_move_says_its_gain() {
    let line = format!("--order 4 --distance 1mm {LAMBRECHTS} --method optimal");
    let plan_json = json_of(&line);
    assert!((number(&plan_json["gain"]) - (1.0 - 0.75_f64.sqrt().sqrt())).abs() < 1e-9, "{plan_json}");
    assert_eq!((&plan_json["family"], &plan_json["method"]), (&"point-to-point".into(), &"optimal".into()));
    let said = plan(&line);
    assert!(
        said.starts_with("move of 1 mm in 139.98542 ms, order 4, optimal\n6.94 % shorter than the published"),
        "{said}"
    );
}

/// Both executions end on the distance at the last sample; on the way the cascade is 1.5 samples late: with a millisecond and
/// 1 m/s that is 1.5 mm, exactly so in the cruise but for the rounding of sums.
#[test]
fn executions_differ_by_their_lag() {
    let work = tempfile::tempdir().unwrap();
    let table = |execution: &str| {
        let path = work.path().join(execution);
        let line = format!("--order 4 --distance 1m {LAMBRECHTS} --sample-time 1ms --execution {execution} --csv");
        plan(&format!("{line} {}", path.display()));
        rows(&path)
    };
    let (hold, euler) = (table("hold"), table("euler"));
    assert_eq!((hold.len(), euler.len()), (1351, 1351));
    assert_eq!((hold[1350][1].to_bits(), euler[1350][1].to_bits()), (1.0_f64.to_bits(), 1.0_f64.to_bits()));
    assert!((hold[700][1] - euler[700][1] - 1.5e-3).abs() < 1e-9, "{} {}", hold[700][1], euler[700][1]);
    assert!(euler[..4].iter().all(|row| row[1] == 0.0) && euler[4][1] > 0.0, "it stands still for its first samples");
}

#[test]
fn fewest_samples_are_never_more() {
    let samples = |sampling: &str| {
        let line = format!("--order 4 --distance 37mm {LAMBRECHTS} --sample-time 7ms --sampling {sampling}");
        json_of(&line)["samples"].as_u64().unwrap()
    };
    assert!(samples("fewest") <= samples("published"));
}

/// The example of the generator: 50 samples, 55 through boxes, 56 as published.
#[test]
fn the_shortest_sampled_move_has_the_fewest_samples() {
    let line = format!("--order 4 --distance 10mm {LAMBRECHTS} --sample-time 5ms --method optimal");
    for execution in ["hold", "euler"] {
        let plan_json = json_of(&format!("{line} --execution {execution}"));
        assert_eq!((&plan_json["samples"], &plan_json["samples_at_least"]), (&50.into(), &50.into()), "{plan_json}");
        assert!((number(&plan_json["published_duration_s"]) - 0.28).abs() < 1e-12);
        assert_eq!(plan_json["execution"], execution);
    }
    assert!(plan(&line).contains("proven: no move of fewer samples reaches the distance"));
}

/// From 0.4 m/s: braking within 5 m/s² takes longer than 0.4²/(2·5) m, so that a target right there is passed and come back
/// to.
#[test]
fn a_transition_starts_in_motion_and_keeps_limits_by_direction() {
    let line = format!(
        "--order 4 --distance 0m {LAMBRECHTS} --start-position 0.1m --start-velocity 0.4m/s --negative-velocity 0.05m/s \
         --online refined"
    );
    let plan_json = json_of(&line);
    assert_eq!((&plan_json["family"], &plan_json["method"]), (&"online".into(), &"refined".into()));
    let [lowest, highest] = [0, 1].map(|i| number(&plan_json["extremes"]["velocity"][i]));
    assert!((lowest + 0.05).abs() < 1e-9 && (highest - 0.4).abs() < 1e-9, "{lowest} {highest}");
    assert_eq!(number(&plan_json["segments"][0]["velocity"]).to_bits(), 0.4_f64.to_bits());
    let said = plan(&line);
    assert!(said.contains("from 0.1 m, 0.4 m/s to rest at 0.1 m"), "{said}");
    assert!(said.contains("+velocity") && said.contains("-velocity"), "{said}");
}

/// From 0.9 m/s the brake is there after 0.1 s, at 0.8 m/s, and turns the axis round 0.8²/(2·2) m farther.
#[test]
fn a_way_beyond_its_target_says_so() {
    let limits = "--order 3 --velocity 1m/s --acceleration 2m/s2 --jerk 20m/s3";
    let turn = 0.9 * 0.1 - 20.0 * 0.001 / 6.0 + 0.16;
    for (sign, from) in [(1.0_f64, 0.0_f64), (-1.0, 0.0), (1.0, -0.2), (-1.0, 0.3)] {
        let (speed, distance) = (sign * 0.9, sign * 0.1);
        let line = format!("{limits} --start-position {from}m --start-velocity={speed}m/s --distance={distance}m");
        let said = plan(&line);
        let beyond = "goes 0.146667 m beyond its target and comes back";
        assert!(said.replace('\n', " ").contains(beyond), "{said}");
        let plan_json = json_of(&line);
        let [lowest, highest] = [0, 1].map(|i| number(&plan_json["extremes"]["position"][i]));
        let expected = [from.min(from + sign * turn), from.max(from + sign * turn)];
        assert!((lowest - expected[0]).abs() < 1e-9 && (highest - expected[1]).abs() < 1e-9, "{plan_json}");
    }
    // Where it begins at its target, either way is beyond it: 0.9·0.1 − 20·0.1³/6 + 0.16 m once more.
    for speed in [0.9, -0.9] {
        let said = plan(&format!("{limits} --start-velocity={speed}m/s --distance=0m"));
        assert!(said.replace('\n', " ").contains("goes 247 mm beyond its target"), "{said}");
    }
    // What is reached from one side is not passed, nor is a target that the move leaves behind at a velocity.
    for line in [
        "--start-velocity 0.9m/s --distance 0.3m",
        "--start-velocity=-0.1m/s --distance 0.3m",
        "--start-velocity 0.9m/s --distance 0.1m --end-velocity 0.85m/s",
    ] {
        let said = plan(&format!("{limits} {line}"));
        assert!(!said.contains("beyond its target"), "{said}");
    }
}

/// Jerk and snap bound the way to a velocity: with pulses of snap of D = J/S = 50 ms and a jerk held for T it gains
/// J·(D + T)·(2·D + T), here 0.5 m/s.
#[test]
fn a_velocity_may_be_the_target() {
    let plan_json = json_of(&format!("--order 4 --to-velocity 0.5m/s {LAMBRECHTS}"));
    let held = -0.075 + (0.075_f64 * 0.075 + 0.5 / 50.0 - 0.005).sqrt();
    assert!((number(&plan_json["duration_s"]) - (0.2 + 2.0 * held)).abs() < 1e-9, "{plan_json}");
    let velocity = number(&plan_json["extremes"]["velocity"][1]);
    assert!((velocity - 0.5).abs() < 1e-12, "{velocity}");
}

/// The corrected table of the source: 100 mm at 200 mm/s and 100 m/s². Times of the acceleration 2, 4 and 2.2857 ms; the move
/// lasts 100/200 s and once that longer, as both ramps cover half of what the speed would in their time.
#[test]
fn rockwell_moves_have_the_ramps_of_the_source() {
    let line = "rockwell --distance 100mm --velocity 200mm/s --acceleration 100m/s2";
    for (said, jerk, ramp) in [
        ("--jerk-percent-of-time 100", 5e4, 4e-3),
        ("--jerk-percent-of-time 25", 3.5e5, 16e-3 / 7.0),
        ("--jerk-percent-of-maximum 35 --maximum-jerk 1e6m/s3", 3.5e5, 16e-3 / 7.0),
        ("--jerk 350000m/s3", 3.5e5, 16e-3 / 7.0),
        // 100 m/s² at 1e12 m/s³ are there within 1e-10 s.
        ("--shape trapezoid --maximum-jerk 1e12m/s3", 1e12, 2e-3 + 1e-10),
    ] {
        let plan_json = json_of(&format!("{line} {said}"));
        let found = number(&plan_json["jerks"]["acceleration"]);
        assert!((found / jerk - 1.0).abs() < 1e-12, "{said}: {found}");
        let duration = number(&plan_json["duration_s"]);
        assert!((duration - 0.5 - ramp).abs() < 1e-12, "{said}: {duration}");
    }
    let slower = json_of(&format!("{line} --jerk-percent-of-time 25 --deceleration 50m/s2"));
    // (50²/0.2)·7
    assert!((number(&slower["jerks"]["deceleration"]) - 87_500.0).abs() < 1e-6, "{slower}");
}

/// Ten positions of Copley's paper, 10 ms apart.
fn ten_positions() -> String {
    let positions = [0, 100, 150, 200, 300, 240, 0, -100, -50, 40];
    let rows: Vec<String> = positions.iter().enumerate().map(|(k, x)| format!("{},{x}", 10 * k)).collect();
    format!("time [ms],position [mm]\n{}\n", rows.join("\n"))
}

/// Oracle: the velocities that the paper prints for the average rule; and that passes and the spline bring the jumps of the
/// acceleration down.
#[test]
fn pvt_tables_get_their_velocities() {
    let work = folder(&[("ten.csv", &ten_positions())]);
    let line = format!("pvt --points {}", work.path().join("ten.csv").display());
    let average = json_of(&line);
    let segments = average["segments"].as_array().unwrap();
    let printed = [0.0, 7.5, 5.0, 7.5, 2.0, -15.0, -17.0, -2.5, 7.0];
    for (segment, expected) in segments.iter().zip(printed) {
        assert!((number(&segment["velocity"]) - expected).abs() < 1e-12, "{segment}");
    }
    let jump = |velocities: &str| {
        let plan_json = json_of(&format!("{line} --velocities {velocities}"));
        let segments = plan_json["segments"].as_array().unwrap().clone();
        let ends = segments.windows(2).map(|pair| {
            let of = |k: usize, name: &str| number(&pair[k][name]);
            (of(0, "acceleration") + of(0, "jerk") * of(0, "length_s") - of(1, "acceleration")).abs()
        });
        ends.fold(0.0, f64::max)
    };
    let jumps = ["average", "smooth --passes 1", "smooth", "smooth --passes 3", "continuous"].map(jump);
    assert!(jumps[0] > 1000.0 && jumps.windows(2).all(|pair| pair[1] < pair[0] / 3.0), "{jumps:?}");
    assert!(jumps[4] < 1e-9 * jumps[0], "{jumps:?}");
    assert!(plan(&line).contains("velocities by the average rule"));
    let linear = plan(&format!("{line} --velocities given"));
    assert!(linear.starts_with("move of 40 mm through 10 points in 90 ms, PT\n"), "{linear}");
}

/// The source's first table: 0, 5000, 15000, 20000 with 750 at the inner points, here in millimetres.
#[test]
fn a_table_with_velocities_keeps_them() {
    let table = "time [ms],position [mm],velocity [m/s]\n0,0,0\n10,5,.75\n20,15,.75\n30,20,0\n";
    let work = folder(&[("four.csv", table)]);
    let said = plan(&format!("pvt --points {}", work.path().join("four.csv").display()));
    assert!(said.contains("velocities of the table"), "{said}");
    assert!(said.contains("10 ms             5 mm         0.75 m/s"), "{said}");
}

#[test]
fn position_profiles_are_sent_as_commands() {
    let work = folder(&[("ten.csv", &ten_positions())]);
    let (points, commands) = (work.path().join("ten.csv"), work.path().join("commands.csv"));
    let line = format!("position --points {} --commands {}", points.display(), commands.display());
    let plateaus = json_of(&format!("{line} --plateau 0.25"));
    assert_eq!((&plateaus["command_count"], &plateaus["position_error"]), (&10.into(), &0.0.into()));
    let sent = rows(&commands);
    assert_eq!(sent.len(), 10);
    assert_eq!((sent[0][0].to_bits(), sent[9][1].to_bits()), (0.0_f64.to_bits(), 0.0_f64.to_bits()));
    // The share that is chosen keeps the limits, and is told.
    let auto = json_of(&format!("{line} --plateau auto --velocity 40m/s --acceleration 1e5m/s2"));
    let share = number(&auto["plateau_share"]);
    assert!(share > 0.0 && share <= 0.5 && number(&auto["peaks"]["acceleration"]) <= 1e5, "{auto}");
    let error = |rate: u64| number(&json_of(&format!("{line} --command-rate {rate}Hz"))["position_error"]);
    assert!(error(4000) < error(1000) / 10.0, "it falls with the square of the rate");
    // The lowest rate is one at which the error is kept, and at one command less it is not.
    let within = json_of(&format!("{line} --allowed-error 100um"));
    let rate = number(&within["command_rate_hz"]);
    assert!(number(&within["position_error"]) <= 1e-4);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number of commands per second"
    )]
    let one_less = rate as u64 - 1;
    assert!(error(one_less) > 1e-4, "{rate}");
}

/// A bus takes commands at whole multiples of its cycle: plateaus hit their positions all the same, steps are as far off as told, and
/// more of them than cycles are no better.
#[test]
fn position_profiles_are_sent_in_the_cycle_of_a_bus() {
    let work = folder(&[("ten.csv", &ten_positions())]);
    let (points, commands) = (work.path().join("ten.csv"), work.path().join("commands.csv"));
    let line = format!("position --points {} --commands {}", points.display(), commands.display());
    let said = plan(&format!("{line} --plateau 0.25 --command-cycle 4ms"));
    assert!(said.contains("velocity commands, α = 0.25: every position is hit"), "{said}");
    for row in rows(&commands) {
        assert!((row[0] / 4e-3 - (row[0] / 4e-3).round()).abs() < 1e-6, "{row:?}");
    }
    let error =
        |rate: u64| number(&json_of(&format!("{line} --command-rate {rate}Hz --command-cycle 4ms"))["position_error"]);
    assert!(error(300) > 0.0 && error(300).to_bits() == error(4000).to_bits(), "{} {}", error(300), error(4000));
}

/// A ZVD shaper adds a period, averages add their lengths, two shapers as much as each.
#[test]
fn filters_make_a_move_longer() {
    let line = format!("--order 3 --distance 0.1m {LAMBRECHTS}").replace("--snap 1000m/s4", "");
    let plain = number(&json_of(&line)["duration_s"]);
    for (filter, longer) in [
        ("--shaper zv --shaper-frequency 10Hz", 0.05),
        ("--shaper zvd --shaper-frequency 10Hz", 0.1),
        ("--shaper zvdd --shaper-frequency 10Hz", 0.15),
        ("--shaper mzv --shaper-frequency 10Hz", 0.075),
        ("--shaper ei --shaper-frequency 10Hz --shaper-tolerable 5%", 0.1),
        ("--shaper 2hump-ei --shaper-frequency 10Hz", 0.15),
        ("--shaper 3hump-ei --shaper-frequency 10Hz", 0.2),
        ("--shaper zvd,ei --shaper-frequency 10Hz,20Hz --shaper-tolerable 3% --shaper-damping 0", 0.15),
        ("--shaper zv --shaper-frequency 10Hz --shaper mzv --shaper-frequency 30Hz", 0.075),
        ("--averages 20ms,10ms --sample-time 1ms", 0.03),
    ] {
        let plan_json = json_of(&format!("{line} {filter}"));
        let found = number(&plan_json["filter_s"]);
        assert!((found - longer).abs() < 1e-9, "{filter}: {found}");
        // A sampled move is a sample longer at most for each of its seven parts.
        let duration = number(&plan_json["duration_s"]);
        assert!((-1e-9..7e-3).contains(&(duration - plain - longer)), "{filter}: {duration} {plain}");
    }
}

/// Turns in, turns out.
#[test]
fn rotary_plans_are_drawn_in_the_units_of_the_user() {
    let work = tempfile::tempdir().unwrap();
    let svg = work.path().join("plan.svg");
    plan(&format!(
        "--order 3 --distance 2rev --velocity 300rpm --acceleration 100rev/s2 --jerk 4000rev/s3 --svg {}",
        svg.display()
    ));
    let drawn = fs::read_to_string(svg).unwrap();
    for expected in [">2 rev in ", ">limit 300 rpm<", ">limit 100 rev/s²<", ">limit 4000 rev/s³<", ">at its limit<"] {
        assert!(drawn.contains(expected), "{expected}");
    }
    assert!(!drawn.contains("rad") && !drawn.contains("snap"));
}

/// A million points: read, planned and drawn.
#[test]
fn a_table_of_a_million_points_is_drawn_small() {
    let rows: Vec<String> = (0..1_000_000).map(|k: u32| format!("{k},{}\n", k * 7 % 13)).collect();
    let work = folder(&[("million.csv", &format!("time [ms],position [um]\n{}", rows.concat()))]);
    let svg = work.path().join("plan.svg");
    let said = plan(&format!("pvt --points {} --svg {}", work.path().join("million.csv").display(), svg.display()));
    assert!(said.contains("… 999984 points more"), "{said}");
    assert!(svg.metadata().unwrap().len() < 200_000);
}
