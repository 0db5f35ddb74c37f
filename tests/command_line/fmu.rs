//! `servobench fmu`, and scenarios with FMUs in them: those that the program itself has written.
use crate::{code, folder, said, servobench};
use servobench_trace::Recording;
use std::path::Path;
use tempfile::TempDir;

const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
duration = "0.3 s"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
dc_link = "320 V"
max_torque = "6.09 Nm"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "100 m/s3"
snap = "5000 m/s4"
[[program]]
move_to = "20 mm"
"#;

/// Effort in, motion out.
const MECHANICS: &str = r#"
[axis.fmu]
file = "mechanics.fmu"
inputs = { "effort.motor" = "effort.motor" }
outputs = { "shaft.position" = "shaft.position", "shaft.velocity" = "shaft.velocity", "load.position" = "load.position", "load.velocity" = "load.velocity" }
"#;

/// Measurements in, effort out.
const DRIVE: &str = r#"
[[fmu]]
file = "drive.fmu"
inputs = { "shaft.position" = "shaft.position", "shaft.velocity" = "shaft.velocity", "load.position" = "load.position", "load.velocity" = "load.velocity" }
outputs = { "effort.motor" = "effort.motor" }
"#;

fn path(work: &TempDir, name: &str) -> String {
    work.path().join(name).display().to_string()
}

/// The axis in a folder, with an FMU of a part of it.
fn exported(part: &str, version: &str) -> TempDir {
    let work = folder(&[("axis.toml", AXIS)]);
    let fmu = path(&work, &format!("{part}.fmu"));
    let output =
        servobench(&["fmu", "export", &path(&work, "axis.toml"), "--part", part, "--fmi", version, "-o", &fmu]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    work
}

/// What a run of `text` records.
fn recorded(work: &TempDir, name: &str, engine: &str, text: &str) -> Recording {
    std::fs::write(work.path().join(format!("{name}.toml")), text).unwrap();
    let out = path(work, name);
    let output = servobench(&["run", &path(work, &format!("{name}.toml")), "--out", &out, "--allow-unisolated-fmus"]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    Recording::read_parquet(Path::new(&out).join(format!("{name}.{engine}.parquet"))).unwrap()
}

/// Largest differences of what both have recorded. At the last instant nobody asks an FMU for the effort of a tick that does not
/// come: the one before stays.
fn difference(one: &Recording, other: &Recording) -> f64 {
    let mut most = 0.0_f64;
    for name in ["load.position", "motor.velocity", "effort.motor"] {
        let (one, other) = (one.channel(name).unwrap(), other.channel(name).unwrap());
        assert_eq!(one.len(), other.len(), "{name}");
        let asked = one.len() - usize::from(name == "effort.motor");
        most = one.iter().zip(other).take(asked).fold(most, |most, (one, other)| most.max((one - other).abs()));
    }
    most
}

/// Oracle: the built-in parts. What goes through an FMU is the same numbers in the same order.
#[test]
fn our_own_parts_come_back_as_what_they_were() {
    let isolations = ["process", "none"];
    for (version, isolation) in [("2", isolations[0]), ("3", isolations[0]), ("3", isolations[1])] {
        let key = format!("isolation = \"{isolation}\"\n");
        let work = exported("mechanics", version);
        let built_in = recorded(&work, "built-in", "exact", AXIS);
        let text = format!("engine = \"fmu\"\n{AXIS}{MECHANICS}{key}");
        assert!(difference(&built_in, &recorded(&work, "plant", "fmu", &text)) < 1e-12, "FMI {version}, {isolation}");
        let work = exported("drive", version);
        let controlled = recorded(&work, "controlled", "exact", &format!("{AXIS}{DRIVE}{key}"));
        assert!(difference(&built_in, &controlled) < 1e-12, "FMI {version}, {isolation}");
        let moved = controlled.channel("load.position").unwrap().last().copied().unwrap_or_default();
        assert!((moved - 0.02).abs() < 1e-3, "{moved}");
    }
}

/// Oracle: the built-in mechanics under the same coupling. Steps are repeated, which takes the FMU back to where it was.
#[test]
fn steps_are_repeated_with_mechanics_that_are_an_fmu() {
    let work = exported("mechanics", "2");
    let export = ["fmu", "export", &path(&work, "axis.toml"), "--part", "mechanics", "-o", &path(&work, "second.fmu")];
    assert_eq!(code(&servobench(&export)), 0);
    // A second axis, driven by the same effort, leads.
    let load = "[[fmu]]\nfile = \"second.fmu\"\ninputs = { \"effort.motor\" = \"effort.motor\" }\n\
                outputs = { \"load.position\" = \"setpoint.position\" }\n[coupling]\nmethod = \"iterated\"\nstep = \"0.25 ms\"\n";
    let axis = AXIS.split("[[program]]").next().unwrap();
    let exact = recorded(&work, "exact", "exact", &format!("{axis}{load}"));
    let fmu = recorded(&work, "fmu", "fmu", &format!("engine = \"fmu\"\n{axis}{MECHANICS}{load}"));
    assert!(difference(&exact, &fmu) < 1e-12);
}

#[test]
fn info_says_what_is_inside() {
    let work = exported("drive", "3");
    let output = servobench(&["fmu", "info", &path(&work, "drive.fmu")]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let text = said(&output);
    for word in ["FMI 3.0", "Linux x86-64", "shaft.position", "effort.motor", "INPUTS", "OUTPUTS"] {
        assert!(text.contains(word), "{word}:\n{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let output = servobench(&["fmu", "info", &path(&work, "axis.toml")]);
    assert_eq!(code(&output), 2, "{}", said(&output));
}

/// Each at the key that is to blame, whichever FMU it belongs to.
#[test]
fn check_places_all_that_does_not_fit() {
    let work = exported("mechanics", "3");
    let wrong = MECHANICS.replace("\"shaft.velocity\" = \"shaft.velocity\"", "\"shaft.speed\" = \"shaft.velocity\"")
        + "parameters = { mass = \"3 kg\" }\n";
    let text = format!("engine = \"fmu\"\n{AXIS}{wrong}");
    std::fs::write(work.path().join("wrong.toml"), &text).unwrap();
    let output = servobench(&["check", &path(&work, "wrong.toml")]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    let line = |part: &str| 1 + text.lines().position(|line| line.contains(part)).unwrap();
    for (what, part) in [("no variable `shaft.speed`", "shaft.speed"), ("no such variable", "3 kg")] {
        assert!(said(&output).contains(what), "{}", said(&output));
        assert!(said(&output).contains(&format!("wrong.toml:{}:", line(part))), "{}", said(&output));
    }
    assert!(said(&output).contains("2 mistakes"), "{}", said(&output));
}

/// Users of other tools stumble over the delay of a step.
#[test]
fn check_shows_how_late_each_connection_is() {
    let work = exported("drive", "3");
    std::fs::write(work.path().join("controlled.toml"), format!("{AXIS}{DRIVE}")).unwrap();
    let output = servobench(&["check", &path(&work, "controlled.toml")]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let text = said(&output);
    assert!(text.contains("shaft.position     -> drive.shaft.position  1 step, 0.0625 ms"), "{text}");
    assert!(text.contains("drive.effort.motor -> effort.motor          no delay"), "{text}");
}

#[test]
fn what_an_fmu_does_not_have_is_said_at_the_door() {
    let work = exported("drive", "2");
    let text = format!("{AXIS}{}", DRIVE.replace("\"shaft.position\" =", "\"shaft.angle\" ="));
    std::fs::write(work.path().join("wrong.toml"), text).unwrap();
    let output = servobench(&["check", &path(&work, "wrong.toml")]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("no variable `shaft.angle`"), "{}", said(&output));
    let text = format!("{AXIS}{}", DRIVE.replace("= \"load.position\"", "= \"load.velocity\""));
    std::fs::write(work.path().join("units.toml"), text).unwrap();
    let output = servobench(&["check", &path(&work, "units.toml")]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(said(&output).contains("counts in `m`, which cannot be turned into m/s"), "{}", said(&output));
    std::fs::write(work.path().join("drive.fmu"), "no archive").unwrap();
    std::fs::write(work.path().join("broken.toml"), format!("{AXIS}{DRIVE}")).unwrap();
    let output = servobench(&["run", &path(&work, "broken.toml"), "--out", &path(&work, "out")]);
    assert_ne!(code(&output), 0, "{}", said(&output));
    assert!(said(&output).contains("drive.fmu"), "{}", said(&output));
}

/// Oracle: the FMUs themselves. What their descriptions say is what they are, as far as a check tells.
#[test]
fn a_check_says_the_same_whether_code_runs_or_not() {
    let iterated = "[coupling]\nmethod = \"iterated\"\nstep = \"1 ms\"\n";
    for version in ["2", "3"] {
        for (part, keys, engine) in [("mechanics", MECHANICS, "engine = \"fmu\"\n"), ("drive", DRIVE, "")] {
            let work = exported(part, version);
            for coupling in ["", iterated] {
                std::fs::write(work.path().join("it.toml"), format!("{engine}{AXIS}{keys}{coupling}")).unwrap();
                let checked = |more: &[&str]| servobench(&[&["check", &path(&work, "it.toml")], more].concat());
                let (described, loaded) = (checked(&[]), checked(&["--load-fmus"]));
                assert_eq!((code(&described), said(&described)), (code(&loaded), said(&loaded)), "{part} {version}");
                assert!(!coupling.is_empty() || code(&loaded) == 0, "{}", said(&loaded));
            }
        }
    }
}
