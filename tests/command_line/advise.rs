//! `servobench advise`: what to set, what it costs, how sure it is.
use crate::{SLIDE, code, folder, json, said, servobench};
use std::fs;

/// A load that hangs undamped on a base which follows the set-point.
const HANGING: &str = r#"
[run]
base_rate = "4 kHz"
duration = "0.9 s"
[axis]
motion = "linear"
[axis.load]
mass = "10 kg"
stiffness = "9.87e4 N/m"
damping = "20 N s/m"
[motor]
kind = "prescribed"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "5 m/s2"
jerk = "50 m/s3"
[[program]]
move_to = "0.1 m"
[measure]
window = "0.5 mm"
[limits]
residual_vibration_pp = "0.4 mm"
settling_time = "50 ms"
"#;

/// What it says, it has run: the set-point it names keeps the limits, and the time is that of a run.
#[test]
fn an_advice_has_been_run() {
    let work = folder(&[("hanging.toml", HANGING)]);
    let (file, out) = (work.path().join("hanging.toml"), work.path().join("advice.json"));
    let (file, out) = (file.to_str().unwrap(), out.to_str().unwrap());
    let output = servobench(&[
        "advise",
        file,
        "--order",
        "3",
        "--shaper",
        "none",
        "--within",
        "axis.load.frequency=15 Hz..17 Hz",
        "--draws",
        "200",
        "--share",
        "97 %",
        "-o",
        out,
    ]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    // A command to be pasted is as long as its paths are.
    let is_short = |line: &str| line.chars().count() <= 80 || line.contains(file);
    assert!(text.lines().all(is_short), "{text}");
    let flat = text.replace('\n', " ");
    for expected in [
        "Take order 3 with velocity",
        "200 of 200 draws did, 95 % certain",
        "10 % less residual_vibration_pp",
        "axis.load.frequency from 15 to 17 Hz",
        "Rockwell",
    ] {
        assert!(flat.contains(expected), "{expected}: {text}");
    }
    let advice = json(&fs::read(out).unwrap());
    // What keeps a tighter limit keeps this one, too: no price of less vibration is a shorter time.
    let prices = advice["prices"].as_array().unwrap();
    let times: Vec<f64> = prices.iter().map(|price| price["time"].as_f64().unwrap_or(f64::INFINITY)).collect();
    assert!(times.is_sorted_by(|one, other| one >= other) && times.len() == 6, "{advice}");
    let own = advice["time"].as_f64().unwrap();
    assert!(times[3] >= own - 1e-9 && own >= times[4] - 1e-9, "{advice}");
    assert!(advice["verified"]["share_at_least"].as_f64().unwrap() >= 0.97, "{advice}");
    // Finer than a tenth of a lobe: 2 Hz in steps of less than 0.1/T.
    assert!(advice["verified"]["spacing"].as_f64().unwrap() < 0.1 / advice["move_time"].as_f64().unwrap());
    // The worst time is that of the machine where the run was; on none of the corners it is longer.
    let settings: Vec<String> =
        advice["settings"].as_array().unwrap().iter().map(|one| one.as_str().unwrap().to_owned()).collect();
    for frequency in ["15 Hz", "16 Hz", "17 Hz"] {
        let results = work.path().join("results");
        let machine = format!("axis.load.frequency={frequency}");
        let mut arguments = vec!["run", file, "--out", results.to_str().unwrap(), "--set", &machine];
        arguments.extend(settings.iter().flat_map(|one| ["--set", one]));
        let run = servobench(&arguments);
        assert_eq!(code(&run), 0, "{}", said(&run));
        let results = json(&fs::read(results.join("results.json")).unwrap());
        let time = results["scenarios"][0]["metrics"]["move_and_settling_time"]["value"].as_f64().unwrap();
        assert!(time <= advice["time"].as_f64().unwrap() + 1e-9, "{frequency}: {time} {advice}");
    }
}

/// The same question has the same answer, however many runs are made at once.
#[test]
fn the_number_of_workers_changes_nothing() {
    let work = folder(&[("hanging.toml", HANGING)]);
    let file = work.path().join("hanging.toml");
    let advice = |jobs: &str| {
        let out = work.path().join(format!("advice-{jobs}.json"));
        let output = servobench(&[
            "advise",
            file.to_str().unwrap(),
            "--order",
            "2",
            "--shaper",
            "zv",
            "--draws",
            "50",
            "--share",
            "90 %",
            "--jobs",
            jobs,
            "-o",
            out.to_str().unwrap(),
        ]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        fs::read(out).unwrap()
    };
    assert!(advice("1") == advice("3"));
}

#[test]
fn what_cannot_be_advised_says_why() {
    let refusal = |scenario: &str, more: &[&str], expected: i32| {
        let work = folder(&[("a.toml", scenario)]);
        let file = work.path().join("a.toml");
        let output = servobench(&[&["advise", file.to_str().unwrap()], more].concat());
        assert_eq!(code(&output), expected, "{}", said(&output));
        said(&output)
    };
    assert!(refusal(SLIDE, &[], 2).contains("has no `[limits]`"));
    let limited = format!("{SLIDE}\n[limits]\ntorque_peak = \"1 kN\"\n");
    assert!(refusal(&limited, &[], 2).contains("--within KEY=RANGE"));
    // 99 % needs 368 draws: nothing is run.
    let few = refusal(HANGING, &["--draws", "200"], 2);
    assert!(few.contains("needs 368") && !few.contains("looking for"), "{few}");
    assert!(refusal(HANGING, &["--share", "99.99999999 %"], 2).contains("promise less"));
    let within = ["--within", "axis.motor_side.mass=19 kg..21 kg"];
    let unstable = refusal(&limited.replace("60 1/s", "60000 1/s"), &within, 2);
    assert!(unstable.contains("unstable") && unstable.contains("axis.motor_side.mass=19 kg"), "{unstable}");
    assert!(refusal(HANGING, &["--shaper", "zvx"], 2).contains("zvx"));
    assert!(refusal(HANGING, &["--choose", "a"], 2).contains("is no key with values"));
    assert!(refusal(HANGING, &["--within", "axis.load.mass=12 kg"], 2).contains("14 Hz..22 Hz"));
    let heavy = refusal(HANGING, &["--within", "axis.load.colour=1..2"], 2);
    assert!(heavy.contains("axis.load.colour") && heavy.contains("the scenario is invalid"), "{heavy}");
    let strict = HANGING.replace("0.4 mm", "0.1 nm");
    let none = refusal(&strict, &["--order", "2", "--shaper", "none"], 4);
    assert!(none.contains("keeps all limits on all machines"), "{none}");
}

/// Nothing is fed forward, so that the following error bounds the velocity to a third of its ceiling. The scenario is of third order.
const FOLLOWING: &str = r#"
[run]
base_rate = "2 kHz"
duration = "2 s"
[axis]
motion = "linear"
motor_side = { mass = "95 kg", viscous = "203 N s/m", coulomb = "20 N", bias = "-3 N" }
[motor]
kind = "ideal-source"
gain = "35.15 N/V"
limit = "10 V"
[drive]
velocity = { rate = "1 kHz", kind = "p", gain = "243 V s/m" }
position = { rate = "1 kHz", gain = "160 1/s" }
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "3 m/s2"
jerk = "60 m/s3"
[[program]]
move_to = "200 mm"
[measure]
window = "100 um"
[limits]
following_error_peak_load = "1.2 mm"
settling_time = "100 ms"
torque_reference_peak = "300 N"
"#;

/// Oracle: 0.175 m/s with 2 m/s² and 20 m/s³ keeps all limits and takes 200/175 + 0.175/2 + 2/20 = 1.33 s.
#[test]
fn a_third_of_the_velocity_is_found_for_another_order_too() {
    let work = folder(&[("following.toml", FOLLOWING)]);
    let (file, out) = (work.path().join("following.toml"), work.path().join("advice.json"));
    let output = servobench(&[
        "advise",
        file.to_str().unwrap(),
        "--order",
        "4",
        "--within",
        "axis.motor_side.mass=95 kg±5 %",
        "--draws",
        "40",
        "--share",
        "85 %",
        "-o",
        out.to_str().unwrap(),
    ]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let advice = json(&fs::read(out).unwrap());
    let time = advice["time"].as_f64().unwrap();
    assert!(time <= 1.30, "{advice}");
}

/// A gain is chosen where that is asked for.
#[test]
fn other_keys_are_chosen_where_they_are_named() {
    let limits = "[limits]\nfollowing_error_peak_load = \"110 um\"\nsettling_time = \"100 ms\"\n";
    let work = folder(&[("slide.toml", &format!("{}\n{limits}", SLIDE.replace("effort = \"rigid\"", "")))]);
    let (file, out) = (work.path().join("slide.toml"), work.path().join("advice.json"));
    let output = servobench(&[
        "advise",
        file.to_str().unwrap(),
        "--order",
        "3",
        "--within",
        "axis.motor_side.mass=19 kg..21 kg",
        "--choose",
        "drive.position.gain=20 1/s,60 1/s,100 1/s",
        "--draws",
        "50",
        "--share",
        "90 %",
        "-o",
        out.to_str().unwrap(),
    ]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let advice = json(&fs::read(out).unwrap());
    // The stiffer loop follows better, so that the move may be faster.
    assert!(advice["kind"].as_str().unwrap().contains("drive.position.gain 100 1/s"), "{advice}");
    assert!(!String::from_utf8(output.stdout).unwrap().contains("shaper"));
}
