//! `--against`: results of before beside those of now.
use super::{compare, fits, runs};
use crate::{SLIDE, code, folder, json, said, servobench};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn run(file: &Path, out: &Path, more: &[&str]) {
    let output = servobench(&[&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat());
    assert!([0, 4].contains(&code(&output)), "{}", said(&output));
}

/// The results of `before` with something changed, as the file `name`.
fn changed(before: &Path, name: &str, change: impl Fn(&mut Value)) -> String {
    let mut value = json(&fs::read(before.join("results.json")).unwrap());
    change(&mut value);
    let file = before.join(name);
    fs::write(&file, value.to_string()).unwrap();
    file.to_str().unwrap().to_owned()
}

/// One scenario is enough; its run of before is a column, and a limit that it missed changes no exit code.
#[test]
fn one_scenario_stands_beside_its_run_of_before() {
    let limited = format!("{SLIDE}\n[limits]\nmove_time = \"1 ms\"\n");
    let work = folder(&[("slide.toml", &limited)]);
    let [slide, before, out] = ["slide.toml", "before", "out"].map(|name| work.path().join(name));
    run(&slide, &before, &["--set", "setpoint.jerk=100 m/s3"]);
    fs::write(&slide, SLIDE).unwrap();
    for against in [before.clone(), before.join("results.json")] {
        let output = compare(&out, &[slide.to_str().unwrap(), "--against", against.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        fits(&text);
        assert!(
            text.starts_with("slide on exact, each at its own limits, beside earlier results\nbefore: `slide` on"),
            "{text}"
        );
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("failed, with setpoint.jerk=100 m/s3"), "{text}");
        assert!(words.contains("slide before change") && !text.contains("before failed:"), "{text}");
        let own = runs(&out, "comparison.json");
        assert_eq!(own.len(), 1, "only what was run now");
        assert_eq!(own[0]["recording"], "slide.rrd");
    }
    // A limit that is missed now is judged.
    fs::write(&slide, limited).unwrap();
    let output = compare(&out, &[slide.to_str().unwrap(), "--against", before.to_str().unwrap()]);
    assert_eq!(code(&output), 4, "{}", said(&output));
}

#[test]
fn runs_of_the_same_name_are_taken_or_the_names_told() {
    let work = folder(&[("a.toml", SLIDE), ("b.toml", SLIDE), ("c.toml", SLIDE)]);
    let [a, b, c, before, out] = ["a.toml", "b.toml", "c.toml", "before", "out"].map(|name| work.path().join(name));
    let output = servobench(&["run", a.to_str().unwrap(), b.to_str().unwrap(), "--out", before.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let against = |files: &[&Path]| {
        let files: Vec<&str> = files.iter().map(|file| file.to_str().unwrap()).collect();
        compare(&out, &[&files[..], &["--against", before.to_str().unwrap()]].concat())
    };
    let output = against(&[&a]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).contains("before: `a` on exact") && !said(&output).contains("`b`"), "{}", said(&output));
    let output = against(&[&a, &b]);
    assert!(said(&output).contains("before a") && said(&output).contains("before b"), "{}", said(&output));
    let output = against(&[&c]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("it has no run of `c` but of `a`, `b`"), "{}", said(&output));
    // The only run of a file is taken whatever it is called.
    run(&a, &before, &[]);
    assert_eq!(code(&against(&[&c])), 0);
}

/// The comparison of before holds variants of one name: all of them stand there, numbered, each with its keys.
#[test]
fn a_comparison_of_before_gives_all_its_variants() {
    let work = folder(&[("a.toml", SLIDE)]);
    let [a, before, out] = ["a.toml", "before", "out"].map(|name| work.path().join(name));
    let a = a.to_str().unwrap();
    let first = compare(&before, &[a, "--variant", "jerk:", "--variant", "trapezoid: setpoint.order=2"]);
    assert_eq!(code(&first), 0, "{}", said(&first));
    let list = before.join("comparison.json");
    let output = compare(&out, &[a, "--against", list.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let words = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("before-2: `a` on exact") && words.contains("with setpoint.order=2"), "{words}");
    // What is read is not written over.
    let output = compare(&before, &[a, "--against", list.to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("is the results"), "{}", said(&output));
}

/// Results may come from anywhere.
#[test]
fn foreign_results_are_refused_or_made_fit_to_be_shown() {
    let work = folder(&[("a.toml", SLIDE)]);
    let [a, before, out] = ["a.toml", "before", "out"].map(|name| work.path().join(name));
    run(&a, &before, &[]);
    let hostile = "\u{1b}]0;owned\u{7}\n::error::x";
    let huge = "x".repeat(100_000);
    let file = |name: &str, text: &str| {
        fs::write(before.join(name), text).unwrap();
        before.join(name).to_str().unwrap().to_owned()
    };
    let newer = changed(&before, "newer.json", |v| v["schema"] = json!("servobench-results/99"));
    let nothing = changed(&before, "nothing.json", |v| v["scenarios"] = json!([]));
    let rotary = changed(&before, "rotary.json", |v| {
        for (_, metric) in v["scenarios"][0]["metrics"].as_object_mut().unwrap() {
            if metric["unit"] == "m" {
                metric["unit"] = json!("rad");
            }
        }
    });
    for (file, part) in [
        (file("no.json", "{"), "EOF"),
        (file("other.json", "{\"schema\": \"other/1\"}"), "other/1"),
        (newer, "servobench-results/99"),
        (nothing, "it has no run that came to its end"),
        (rotary, "is of a rotary axis and those of now are linear"),
        (before.join("none.json").to_str().unwrap().to_owned(), "cannot read"),
    ] {
        let output = compare(&out, &[a.to_str().unwrap(), "--against", &file]);
        assert_eq!(code(&output), 2, "{file}: {}", said(&output));
        assert!(said(&output).contains(part), "{file}: {}", said(&output));
    }
    let painted = changed(&before, "painted.json", |v| {
        v["generator"] = json!(hostile);
        let run = &mut v["scenarios"][0];
        (run["name"], run["engine"]) = (json!(hostile), json!(huge));
        run["overrides"] = json!([hostile]);
    });
    let output = compare(&out, &[a.to_str().unwrap(), "--against", &painted]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let text = said(&output);
    assert!(
        !text.contains('\u{1b}') && !text.contains('\u{7}') && !text.lines().any(|line| line.starts_with("::")),
        "{text}"
    );
    assert!(text.len() < 10_000, "{}", text.len());
}
