//! `--deny` and `--strict`: runs without limits, lifted requirements, warnings.
use super::{SLIDE, code, folder, json, said, servobench};
use std::fs;

const LIMITED: &str = "[limits]\nfollowing_error_peak_load = \"1 m\"\n";

/// Each kind with a scenario that has it, and words of the message.
fn kinds() -> Vec<(&'static str, String, &'static str)> {
    let warned = "[limits]\nfollowing_error_peak_load = \"1 m\"\nmove_time = { min = \"1 ms\" }\n[[program]]\nmove_to = \"50 mm\"\n";
    vec![
        ("unjudged", SLIDE.to_owned(), "has no limits"),
        ("lifted", format!("{SLIDE}{LIMITED}[requirements]\narrives = false\n"), "(arrives)"),
        ("warnings", format!("{SLIDE}{warned}"), "the move has no length"),
    ]
}

#[test]
fn what_is_denied_ends_with_four_and_is_named() {
    for (kind, text, words) in kinds() {
        let work = folder(&[("a.toml", &text)]);
        let (file, out) = (work.path().join("a.toml"), work.path().join("out"));
        let run = |more: &[&str]| {
            servobench(&[&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat())
        };
        let plain = run(&[]);
        assert_eq!(code(&plain), 0, "{kind}: {}", said(&plain));
        for denied in [&["--deny", kind][..], &["--strict"], &["--deny", "unjudged,lifted,warnings"]] {
            let output = run(denied);
            assert_eq!(code(&output), 4, "{kind}: {}", said(&output));
            let told: Vec<String> = said(&output).lines().map(str::to_owned).collect();
            assert!(told.iter().all(|line| line.chars().count() <= 80 || line.contains('/')), "{told:#?}");
            let line = String::from_utf8(run(&[denied, &["--quiet"]].concat()).stderr).unwrap();
            assert!(line.starts_with(&format!("servobench: denied: {kind}: 1 of 1 run ")), "{line}");
            assert!(line.contains(words) && line.contains("a on exact") && line.lines().count() == 1, "{line}");
        }
        let others = kinds().into_iter().map(|(other, ..)| other).filter(|other| *other != kind);
        let output = run(&["--deny", &others.collect::<Vec<_>>().join(",")]);
        assert_eq!(code(&output), 0, "{kind}: {}", said(&output));
        // The results of before are held to it too.
        let resumed = servobench(&["run", "--resume", out.to_str().unwrap(), "--strict"]);
        assert_eq!(code(&resumed), 4, "{kind}: {}", said(&resumed));
    }
}

#[test]
fn warnings_of_check_stand_below_the_row_and_in_the_count() {
    let (_, text, words) = kinds().remove(2);
    let work = folder(&[("a.toml", &text)]);
    let (file, out) = (work.path().join("a.toml"), work.path().join("out"));
    let arguments = ["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let table = String::from_utf8(servobench(&arguments).stdout).unwrap();
    let row = table.find("passed     a").unwrap();
    let below = table[row..].split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(below.contains("check: ") && below.contains(words) && below.contains("the axis is at 50 mm"), "{table}");
    assert!(table.contains("1 run: 1 passed\n1 with warnings\n"), "{table}");
    let quiet = servobench(&[&arguments[..], &["--quiet"]].concat());
    assert_eq!(said(&quiet), "1 run: 1 passed; 1 with warnings\n");
    let results = json(&fs::read(out.join("results.json")).unwrap());
    let found = results["scenarios"][0]["check_warnings"].as_array().unwrap();
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn junit_skips_what_nobody_judged_and_says_what_is_lifted() {
    let [unjudged, lifted, _] = kinds().try_into().unwrap();
    let work = folder(&[("unjudged.toml", &unjudged.1), ("lifted.toml", &lifted.1)]);
    let (folder, report) = (work.path().to_str().unwrap(), work.path().join("junit.xml"));
    let out = work.path().join("out");
    let output =
        servobench(&["run", folder, "--out", out.to_str().unwrap(), "--junit", report.to_str().unwrap(), "--quiet"]);
    assert_eq!(said(&output), "2 runs: 1 passed, 1 unjudged (no limits); 1 with something lifted\n");
    let report = fs::read_to_string(report).unwrap();
    assert!(report.contains("<skipped message=\"no limits: ") && report.contains("skipped=\"1\""), "{report}");
    assert!(report.contains("<property name=\"lifted\" value=\"arrives\"/>"), "{report}");
}

/// A sweep and a comparison are held to it as a run is.
#[test]
fn sweeps_and_comparisons_are_denied_too() {
    let (_, lifted, _) = kinds().remove(1);
    let sweep = "scenario = \"a.toml\"\n[[vary]]\nkey = \"setpoint.acceleration\"\nvalues = [\"4 m/s2\", \"5 m/s2\"]\n";
    let work = folder(&[("a.toml", &lifted), ("b.sweep.toml", sweep)]);
    let path = |name: &str| work.path().join(name).to_str().unwrap().to_owned();
    let (scenario, sweep, out) = (path("a.toml"), path("b.sweep.toml"), path("out"));
    for (arguments, count) in [
        (vec!["sweep", &sweep], "2 of 2 runs lift"),
        (
            vec!["compare", &scenario, "--variant", "slow: setpoint.acceleration=4m/s2", "--variant", "own:"],
            "2 of 2 runs lift",
        ),
    ] {
        let run = |more: &[&str]| servobench(&[&arguments[..], &["--out", &out], more].concat());
        assert_eq!(code(&run(&[])), 0, "{}", said(&run(&[])));
        let denied = run(&["--deny", "lifted"]);
        assert_eq!(code(&denied), 4, "{}", said(&denied));
        assert!(said(&denied).contains(count), "{}", said(&denied));
        assert_eq!(code(&run(&["--deny", "unjudged,warnings"])), 0, "{}", said(&run(&["--deny", "warnings"])));
    }
}
