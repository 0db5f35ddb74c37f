//! `servobench compare`
mod against;
mod documented;
mod equal;
mod published;
mod variants;

use crate::{SLIDE, code, folder, json, said, servobench};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

/// `servobench compare` with these arguments, into the folder `out`.
fn compare(out: &Path, arguments: &[&str]) -> Output {
    servobench(&[&["compare"], arguments, &["--out", out.to_str().unwrap()]].concat())
}

/// The runs that a comparison or a suite left in `out`.
fn runs(out: &Path, list: &str) -> Vec<Value> {
    json(&fs::read(out.join(list)).unwrap())["scenarios"].as_array().unwrap().clone()
}

/// The runs of a comparison that went well.
fn compared(out: &Path, arguments: &[&str]) -> (Vec<Value>, String) {
    let output = compare(out, arguments);
    assert_eq!(code(&output), 0, "{}", said(&output));
    (runs(out, "comparison.json"), String::from_utf8(output.stdout).unwrap())
}

/// A metric of a run (SI).
fn metric(run: &Value, name: &str) -> f64 {
    run["metrics"][name]["value"].as_f64().unwrap_or_else(|| panic!("{name}: {}", run["absent"][name]))
}

/// How long the move with this index lasts (s).
fn duration(run: &Value, index: usize) -> f64 {
    let made = &run["moves"][index];
    made["end"].as_f64().unwrap() - made["start"].as_f64().unwrap()
}

/// No line is wider than a terminal but the command that is to be pasted.
fn fits(text: &str) {
    let wide = text.lines().find(|line| line.chars().count() > 80 && !line.contains(" view "));
    assert_eq!(wide, None, "{text}");
}

#[test]
fn compare_says_in_words_which_wins_and_writes_one_recording() {
    let work = tempfile::tempdir().unwrap();
    for equal in ["limits", "duration"] {
        let out = work.path().join(equal);
        let output = servobench(&[
            "compare",
            "scenarios/lambrechts-jerk.toml",
            "scenarios/lambrechts-snap.toml",
            "--equal",
            equal,
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        assert!(said(&output).contains("residual vibration"), "{}", said(&output));
        let recordings = fs::read_dir(&out)
            .unwrap()
            .filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|extension| extension == "rrd"));
        assert_eq!(recordings.count(), 1);
    }
}

/// The everyday question: two bandwidths on one axis.
#[test]
fn compare_says_by_key_and_value_what_differs() {
    let work =
        folder(&[("one.toml", SLIDE), ("two.toml", &SLIDE.replace("80 Hz", "50 Hz").replace("60 1/s", "30 1/s"))]);
    let (one, two, out) = (work.path().join("one.toml"), work.path().join("two.toml"), work.path().join("out"));
    let output = servobench(&["compare", one.to_str().unwrap(), two.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    let head: Vec<_> = text.lines().take(5).collect();
    assert_eq!(
        head,
        [
            "one and two on exact, each at its own limits",
            "what differs:",
            "  drive.velocity.bandwidth  80 Hz against 50 Hz",
            "  drive.position.gain       60 1/s against 30 1/s",
            ""
        ]
    );
    assert!(text.contains("peak following error") && !text.contains("set-points alone"), "{text}");
    fits(&text);
}

#[test]
fn compare_refuses_a_length_beside_an_angle() {
    let rotary = SLIDE
        .replace("\"linear\"", "\"rotary\"")
        .replace("mass = \"20 kg\"", "inertia = \"20 kg m2\"")
        .replace("m/s", "rad/s")
        .replace("50 mm", "50 mrad")
        .replace("10 um", "10 urad");
    let work = folder(&[("one.toml", SLIDE), ("two.toml", &rotary)]);
    let (one, two, out) = (work.path().join("one.toml"), work.path().join("two.toml"), work.path().join("out"));
    let output = servobench(&["compare", one.to_str().unwrap(), two.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("`one` is linear and `two` rotary"), "{}", said(&output));
    assert!(!out.exists());
}

/// Another limit, not another order of the profile, makes the difference here: it is said, or refused on demand.
#[test]
fn limits_that_differ_are_said_or_refused() {
    let work = folder(&[("one.toml", SLIDE), ("two.toml", &SLIDE.replace("5 m/s2", "2 m/s2"))]);
    let (one, two, out) = (work.path().join("one.toml"), work.path().join("two.toml"), work.path().join("out"));
    let arguments = ["compare", one.to_str().unwrap(), two.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = servobench(&arguments);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let words = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("Their limits differ: acceleration 2.00 m/s² against 5.00 m/s²."), "{}", said(&output));
    let output = servobench(&[&arguments[..], &["--equal", "limits"]].concat());
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("move 1 of `one` is limited to 5 in acceleration"), "{}", said(&output));
}

#[test]
fn a_limit_that_is_missed_in_a_comparison_ends_with_4_and_is_named() {
    let fast = format!("{SLIDE}\n[limits]\nmove_time = \"1 ms\"\n");
    let work = folder(&[("one.toml", &fast), ("two.toml", &SLIDE.replace("5 m/s2", "2 m/s2"))]);
    let (one, two, out) = (work.path().join("one.toml"), work.path().join("two.toml"), work.path().join("out"));
    let output = servobench(&["compare", one.to_str().unwrap(), two.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 4, "{}", said(&output));
    assert!(said(&output).contains("one is out: move_time"), "{}", said(&output));
    let results = json(&fs::read(out.join("comparison.json")).unwrap());
    let runs = results["scenarios"].as_array().unwrap();
    assert_eq!((&runs[0]["verdict"], &runs[1]["verdict"]), (&"failed".into(), &"unjudged".into()));
    assert!(runs.iter().all(|run| run["recording"] == "one-against-two.rrd"), "{results}");
    assert!(out.join("one-against-two.rrd").is_file());
}

/// A motor that friction holds leaves no vibration behind. It does not win by that, whichever comes first.
#[test]
fn an_axis_that_does_not_move_never_wins() {
    let work = folder(&[("slide.toml", &SLIDE.replace("mass = \"20 kg\"", "mass = \"20 kg\"\ncoulomb = \"5 N\""))]);
    let (slide, out) = (work.path().join("slide.toml"), work.path().join("out"));
    let (stuck, free) = ("stuck: motor.limit=2 N", "free: motor.limit=1 kN");
    for variants in [[stuck, free], [free, stuck]] {
        let output = compare(&out, &[slide.to_str().unwrap(), "--variant", variants[0], "--variant", variants[1]]);
        assert_eq!(code(&output), 4, "{}", said(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        fits(&text);
        let (before, conclusion) =
            text.split_once("free wins: the other one is out.").unwrap_or_else(|| panic!("{text}"));
        assert!(before.contains("\nstuck is out: follows: the load is"), "{text}");
        assert!(!conclusion.contains("is out"), "who is out stands before the conclusion: {text}");
    }
    // Nothing is made equal to it either.
    let arguments = [slide.to_str().unwrap(), "--variant", stuck, "--variant", free, "--equal", "torque"];
    let output = compare(&out, &arguments);
    assert!(said(&output).contains("left as it is: it breaks a requirement"), "{}", said(&output));
    assert!(said(&output).contains("that of free"), "{}", said(&output));
}

/// One machine is not better than itself, with any seed of its noise.
#[test]
fn of_one_machine_with_two_seeds_none_wins() {
    let noisy =
        SLIDE.replace("\"ideal-source\"", "\"ideal-source\"\nencoder = { step = \"0.1 um\", noise = \"0.5 um\" }");
    let work = folder(&[("slide.toml", &noisy)]);
    let (slide, out) = (work.path().join("slide.toml"), work.path().join("out"));
    for (seeds, words) in [("5", "ithin noise"), ("1", "fewer than 5 seeds")] {
        let variants = ["--variant", "a: ", "--variant", "b: motor.encoder.seed=7", "--seeds", seeds];
        let output = compare(&out, &[&[slide.to_str().unwrap()], &variants[..]].concat());
        assert_eq!(code(&output), 0, "{}", said(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(!text.contains(" wins: "), "{text}");
        assert!(text.split_whitespace().collect::<Vec<_>>().join(" ").contains(words), "{text}");
        assert_eq!(runs(&out, "comparison.json").len(), 2, "runs with other seeds are not among the results");
    }
}

/// Two moves from rest to rest against one that blends them: the longest move of the second is longer, and it is done sooner.
#[test]
fn the_program_decides_and_not_its_longest_move() {
    let work = tempfile::tempdir().unwrap();
    let files = ["scenarios/plc/figure-3a.toml", "scenarios/plc/figure-3b.toml", "--engine", "exact"];
    let (_, text) = compared(work.path(), &files);
    assert!(text.contains("program done"), "{text}");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("3b wins: in position sooner at equal vibration."), "{text}");
}
