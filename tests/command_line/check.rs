//! `servobench check` and `servobench schema`.
use crate::{SLIDE, code, folder, json, repository, said, servobench};
use std::fs;

#[test]
fn every_mistake_of_a_file_is_reported_in_one_go() {
    let text = SLIDE
        .replace("\"20 kg\"", "20")
        .replace("velocity = \"0.5 m/s\"", "velocity = \"0.5 m\"")
        .replace("jerk =", "jerq =")
        .replace("rate = \"4 kHz\"\ngain", "rate = \"3 kHz\"\ngain");
    let work = folder(&[("bad.toml", &text)]);
    let output = servobench(&["check", work.path().join("bad.toml").to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    let said = said(&output);
    for expected in ["\"20 kg\"", "velocity", "jerk", "3000 Hz"] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
    assert!(said.lines().all(|line| line.chars().count() <= 80), "80 columns:\n{said}");
}

#[test]
fn the_schema_is_the_one_in_the_repository() {
    let output = servobench(&["schema"]);
    let kept = fs::read(repository().join("docs/scenario.schema.json")).unwrap();
    assert_eq!(json(&output.stdout), json(&kept), "run `servobench schema > docs/scenario.schema.json`");
}

/// Two slides on the ground that a tendon couples; line numbers in the tests count from here.
const ARM: &str = r#"<mujoco>
  <compiler angle="radian"/>
  <option gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body name="carriage"><joint name="carriage" type="slide" axis="1 0 0"/><inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/></body>
    <body name="load"><joint name="load" type="slide" axis="1 0 0"/><inertial pos="0 0 0" mass="10" diaginertia="1 1 1"/></body>
  </worldbody>
  <tendon><fixed stiffness="6e5" springlength="0"><joint joint="carriage" coef="1"/><joint joint="load" coef="-1"/></fixed></tendon>
  <actuator><motor name="force" joint="carriage"/></actuator>
</mujoco>
"#;

/// [`SLIDE`] with the mechanics of `arm.xml`, on `engines`.
fn own_mjcf(engines: &str) -> String {
    let mjcf = "mjcf = { file = \"arm.xml\", motor_joint = \"carriage\", load_joint = \"load\", actuator = \"force\" }";
    let estimate = "[drive.estimate]\nmotor_inertia = \"20 kg\"\nload_inertia = \"10 kg\"\nstiffness = \"6e5 N/m\"\n";
    let slide = SLIDE
        .replace("[axis.motor_side]\nmass = \"20 kg\"", mjcf)
        .replace("[setpoint]", &format!("{estimate}[setpoint]"));
    format!("engine = {engines}{slide}")
}

/// What `check` says of a scenario with the MJCF file `arm`, and its exit code.
fn checked(scenario: &str, arm: &str) -> (i32, String) {
    let work = folder(&[("own.toml", scenario), ("arm.xml", arm)]);
    let output = servobench(&["check", work.path().join("own.toml").to_str().unwrap()]);
    (code(&output), said(&output))
}

#[test]
fn check_asks_the_engines_that_a_scenario_names() {
    let (code, said) = checked(&own_mjcf("[\"rapier\"]"), ARM);
    assert!(code == 0 && said.ends_with("\n1 scenario is valid\n"), "{code} {said}");
    let (code, said) = checked(&own_mjcf("[\"exact\"]"), ARM);
    assert_eq!(code, 2);
    assert!(said.contains("own.toml:7:17]") && said.contains("engine `exact` does not support MJCF files"), "{said}");
}

#[test]
fn all_that_rapier_refuses_in_a_file_is_said_by_name_at_its_place_in_one_go() {
    let arm = ARM
        .replace("<worldbody>", "<equality/>\n<worldbody>")
        .replace(r#"name="load" type="slide""#, r#"name="load" type="slide" range="0 1""#);
    let (code, said) = checked(&own_mjcf("[\"rapier\"]"), &arm);
    let said = said.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    assert_eq!(code, 2);
    for expected in [
        "2 mistakes",
        "arm.xml:4:3: ",
        "`<equality>` in `<mujoco>` is not simulated",
        "arm.xml:7:5: ",
        "`range`",
        "own.toml:7:17",
    ] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
}

#[test]
fn names_that_the_mjcf_file_lacks_are_said_where_they_are_given() {
    let scenario = own_mjcf("[\"rapier\"]").replace("load_joint = \"load\"", "load_joint = \"laod\"");
    let (code, said) = checked(&scenario.replace("actuator = \"force\"", "actuator = \"motor\""), ARM);
    assert_eq!(code, 2);
    for expected in [
        "2 mistakes",
        "own.toml:7:67]",
        "`laod`; there is `carriage`, `load`",
        "own.toml:7:86]",
        "motor `motor`; there is `force`",
    ] {
        assert!(
            said.split_whitespace().collect::<Vec<_>>().join(" ").replace("│ ", "").contains(expected),
            "{expected} in:\n{said}"
        );
    }
}

/// What only a run would tell before: a move that cannot be so fast, beside mechanics that cannot be built.
#[test]
fn check_builds_what_run_would_run() {
    let scenario =
        own_mjcf("[\"exact\", \"rapier\"]").replace("move_to = \"50 mm\"", "move_to = \"50 mm\"\nduration = \"1 ms\"");
    let (code, said) = checked(&scenario, ARM);
    assert_eq!(code, 2);
    assert!(said.contains("2 mistakes") && said.contains("`duration` must be at least"), "{said}");
}

/// Each of these was valid to `check` and ended `run` without a place.
#[test]
fn what_run_would_refuse_is_refused_at_its_place() {
    for (from, to, line, expected) in [
        ("effort = \"rigid\"", "effort = \"rigid\"\ndelay = \"1 s\"", 21, "`drive.feedforward.delay`"),
        ("[measure]", "[record]\nchannels = [\"current.q\"]\n[measure]", 29, "`current.q`"),
        ("move_to = \"50 mm\"", "move_to = \"50 mm\"\nduration = \"1 ms\"", 26, "`duration` must be at least"),
    ] {
        assert!(SLIDE.contains(from), "{from}");
        let scenario = SLIDE.replace(from, to);
        let work = folder(&[("slide.toml", &scenario)]);
        let (file, out) = (work.path().join("slide.toml"), work.path().join("out"));
        let output = servobench(&["check", file.to_str().unwrap()]);
        assert_eq!(code(&output), 2, "{}", said(&output));
        let said = said(&output);
        assert!(
            said.contains(&format!("slide.toml:{line}:")) && said.contains(expected),
            "{line} {expected} in:\n{said}"
        );
        assert_eq!(code(&servobench(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()])), 2);
    }
}

#[cfg(not(feature = "mujoco"))]
#[test]
fn check_says_which_engines_it_could_not_ask() {
    let (code, said) = checked(&own_mjcf("[\"rapier\", \"mujoco\"]"), ARM);
    let end = "\n1 scenario is valid as far as this build can tell, which lacks `mujoco`\n";
    assert!(code == 0 && said.ends_with(end), "{code} {said}");
}

#[cfg(feature = "mujoco")]
#[test]
fn mujoco_is_asked_in_a_process_of_its_own() {
    let (code, said) = checked(&own_mjcf("[\"rapier\", \"mujoco\"]"), ARM);
    assert!(code == 0 && said.ends_with("\n1 scenario is valid\n"), "{code} {said}");
    // MuJoCo knows no such attribute either, and stops at its first mistake.
    let (code, said) =
        checked(&own_mjcf("[\"rapier\", \"mujoco\"]"), &ARM.replace("diaginertia=\"1 1 1\"", "inertia=\"1\""));
    assert_eq!(code, 2);
    for expected in ["3 mistakes", "engine `mujoco`", "unrecognized attribute", "engine `rapier`"] {
        assert!(said.contains(expected), "{expected} in:\n{said}");
    }
}

/// What `check` says of `SLIDE` with `changes`, on standard output and standard error.
fn previewed(changes: &[(&str, &str)], more: &[&str]) -> (i32, String, String) {
    let mut text = SLIDE.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let work = folder(&[("slide.toml", &text)]);
    let file = work.path().join("slide.toml");
    let output = servobench(&[&["check", file.to_str().unwrap()], more].concat());
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8(bytes.clone()).unwrap());
    (code(&output), out, err)
}

#[test]
fn a_healthy_file_shows_one_screen_of_what_can_be_computed() {
    let (code, out, err) = previewed(&[], &[]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.lines().count() <= 24 && out.lines().all(|line| line.chars().count() <= 80), "{out}");
    insta::assert_snapshot!("check_slide", out);
}

#[test]
fn the_screen_of_a_motor_has_its_voltage_and_its_loops() {
    let file = repository().join("scenarios/feed-axis-move.toml");
    let output = servobench(&["check", file.to_str().unwrap()]);
    assert_eq!(code(&output), 0);
    let out = String::from_utf8(output.stdout).unwrap();
    assert!(out.lines().count() <= 24 && out.lines().all(|line| line.chars().count() <= 80), "{out}");
    // What the last line says depends on the engines of the build.
    let (screen, _) = out.split_once("1 scenario is valid").unwrap();
    insta::assert_snapshot!("check_feed_axis", screen);
}

#[test]
fn several_files_have_a_line_each_unless_asked() {
    let text = SLIDE.replace("50 mm", "60 mm");
    let work = folder(&[("one.toml", SLIDE), ("two.toml", &text)]);
    let folder = work.path().to_str().unwrap();
    let lines = |output: &std::process::Output| String::from_utf8_lossy(&output.stdout).lines().count();
    let short = servobench(&["check", folder]);
    assert_eq!((code(&short), lines(&short)), (0, 3), "{}", said(&short));
    let long = servobench(&["check", "--verbose", folder]);
    assert!(lines(&long) > 15, "{}", said(&long));
}

/// The doubts of a file that runs, each at its place.
#[test]
fn what_no_run_can_keep_is_a_warning_at_its_place() {
    for (changes, place, expected) in [
        (&[("[measure]", "[limits]\nmove_time = \"0.1 s\"\n[measure]")], "slide.toml:29:", "no run keeps `move_time`"),
        (&[("move_to = \"50 mm\"", "move_to = \"0 mm\"")], "slide.toml:26:", "the move has no length"),
        (
            &[("[[program]]\nmove_to = \"50 mm\"", "[[program]]\nwait = \"0.3 s\"\n[limits]\novershoot = \"1 um\"")],
            "slide.toml:29:",
            "`overshoot` is about a move, and there is none",
        ),
    ] {
        let (code, _, err) = previewed(changes, &[]);
        let words = err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(code == 0 && err.contains(place) && words.contains(expected), "{place} {expected} in {code}:\n{err}");
    }
}

/// The pieces of a table meet with steps of the acceleration, on an axis with a limit of the jerk.
#[test]
fn a_table_with_corners_is_a_warning_on_an_axis_with_a_jerk() {
    let scenario = fs::read_to_string(repository().join("scenarios/plc/velocity-profile.toml")).unwrap();
    for (pairs, jerk, expected) in [
        ("200,900\n500,900\n", "jerk = \"73 m/s3\"", Some("steps by up to 4.50 m/s² between pairs of the table")),
        // From 0.3 m/s² up to 0.4 in a corner, and from there to none at the end.
        ("200,60\n300,100\n", "jerk = \"73 m/s3\"", Some("steps by up to 400 mm/s²")),
        ("100,0\n200,0\n", "jerk = \"73 m/s3\"", None),
        ("200,900\n500,900\n", "", None),
    ] {
        let order = if jerk.is_empty() { "order = 2" } else { "order = 3" };
        let text = scenario.replace("order = 2", &format!("{order}\n{jerk}")).replace("velocities.csv", "own.csv");
        let table = format!("time [ms],velocity [mm/s]\n{pairs}");
        let work = folder(&[("table.toml", &text), ("own.csv", &table)]);
        let output = servobench(&["check", work.path().join("table.toml").to_str().unwrap()]);
        let said = said(&output).split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert_eq!(code(&output), 0, "{said}");
        assert_eq!(said.contains("the acceleration steps"), expected.is_some(), "{said}");
        // What function blocks ask of the motor only a run can tell.
        assert!(!said.contains("% left"), "{said}");
        assert!(
            expected.is_none_or(|expected| said.contains(expected) && said.contains("limit of 73.0 m/s³")),
            "{said}"
        );
    }
}

/// A slide as the joint of a motor that turns, and a hinge as the load of a linear axis.
#[test]
fn joints_have_to_be_of_the_kind_that_the_axis_is() {
    let (code, said) = checked(
        &own_mjcf("[\"rapier\"]"),
        &ARM.replace("name=\"load\" type=\"slide\"", "name=\"load\" type=\"hinge\""),
    );
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ").replace("│ ", "");
    assert_eq!(code, 2, "{said}");
    assert!(words.contains("own.toml:7:67]") && words.contains("joint `load` turns and the axis is linear"), "{said}");
}

#[cfg(feature = "mujoco")]
#[test]
fn what_mujoco_does_otherwise_is_said_before_the_run() {
    let creeping = ARM.replace(
        "axis=\"1 0 0\"/><inertial pos=\"0 0 0\" mass=\"10\"",
        "axis=\"1 0 0\" frictionloss=\"5\"/><inertial pos=\"0 0 0\" mass=\"10\"",
    );
    let (code, said) = checked(&own_mjcf("[\"mujoco\"]"), &creeping);
    assert!(code == 0 && said.contains("arm.xml:6:") && said.contains("creeps"), "{code} {said}");
    let weak = ARM.replace(
        "joint=\"carriage\"/></actuator>",
        "joint=\"carriage\" ctrllimited=\"true\" ctrlrange=\"-1 1\"/></actuator>",
    );
    let (code, said) = checked(&own_mjcf("[\"mujoco\"]"), &weak);
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ").replace("│ ", "");
    assert!(code == 2 && words.contains("the model limits it to -1 … 1 N"), "{code} {said}");
}
