//! `servobench init`, `examples`, `explain` and `models`: the commands of somebody who has the program alone.
use crate::{code, folder, json, said};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// `servobench` in `folder`, where nothing of the repository is.
fn typed(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_servobench")).args(arguments).current_dir(folder).output().unwrap()
}

/// Widest line, and the text with this program by its name.
fn shown(output: &Output) -> String {
    let text = said(output).replace(env!("CARGO_BIN_EXE_servobench"), "servobench");
    let too_wide: Vec<&str> = text.lines().filter(|line| line.chars().count() > 80).collect();
    assert_eq!(too_wide, [""; 0]);
    text
}

const TEMPLATES: [&str; 5] = ["belt", "linear", "plc", "rotary", "screw"];

#[test]
fn every_template_is_valid_without_a_warning_and_passes() {
    for kind in TEMPLATES {
        let work = folder(&[]);
        let written = typed(work.path(), &["init", "--from", kind]);
        assert_eq!(code(&written), 0, "{}", said(&written));
        let text = fs::read_to_string(work.path().join("axis.toml")).unwrap();
        let count = text.lines().count();
        assert!((50..=90).contains(&count) && text.starts_with("# "), "{kind}: {count} lines");
        assert!(text.lines().all(|line| line.chars().count() <= 110), "{kind}");
        let checked = typed(work.path(), &["check", "axis.toml"]);
        assert!(code(&checked) == 0 && checked.stderr.is_empty(), "{kind}: {}", said(&checked));
        let run = typed(work.path(), &["run", "axis.toml", "--strict", "--quiet"]);
        assert_eq!(code(&run), 0, "{kind}: {}", said(&run));
        let results = json(&fs::read(work.path().join("servobench-out/results.json")).unwrap());
        assert_eq!(
            (&results["scenarios"][0]["engine"], &results["scenarios"][0]["verdict"]),
            (&"exact".into(), &"passed".into())
        );
    }
}

#[test]
fn init_says_how_to_go_on() {
    let work = folder(&[]);
    insta::assert_snapshot!(shown(&typed(work.path(), &["init"])), @r"
    axis.toml: a table on a ball screw, 200 mm

    Replace its values by those of your machine. It runs as it is:
      servobench check axis.toml
      servobench run axis.toml
    ");
    let piped = typed(work.path(), &["init", "-", "--from", "screw"]);
    assert_eq!(piped.stdout, fs::read(work.path().join("axis.toml")).unwrap(), "the default is a screw");
    let in_a_folder = typed(work.path(), &["init", "new/my axis.toml", "--from", "belt"]);
    assert!(said(&in_a_folder).contains("check 'new/my axis.toml'"), "{}", said(&in_a_folder));
}

#[test]
fn no_file_is_overwritten() {
    let work = folder(&[("axis.toml", "mine"), ("points.csv", "mine, too")]);
    let refused = typed(work.path(), &["init"]);
    assert_eq!(code(&refused), 2);
    insta::assert_snapshot!(said(&refused), @"servobench: `axis.toml` exists and is not overwritten; name another file, as in `servobench init NAME.toml`");
    let refused = typed(work.path(), &["examples", "setpoints/pvt"]);
    assert_eq!(code(&refused), 2);
    insta::assert_snapshot!(said(&refused), @"servobench: `points.csv` exists and is not overwritten; name another folder with `--to DIR`, or remove the file");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("nowhere", work.path().join("link.toml")).unwrap();
        assert_eq!(code(&typed(work.path(), &["init", "link.toml"])), 2, "a link that leads nowhere is there");
    }
    assert_eq!(fs::read_to_string(work.path().join("axis.toml")).unwrap(), "mine");
    assert_eq!(fs::read_to_string(work.path().join("points.csv")).unwrap(), "mine, too");
    assert!(!work.path().join("pvt.toml").exists(), "nothing is written where one file would be lost");
}

#[test]
fn a_wrong_name_has_a_near_one() {
    let work = folder(&[]);
    for (words, expected) in [
        (&["init", "--from", "skrew"][..], "screw"),
        (&["examples", "plc/bufered"], "did you mean `plc/buffered`?"),
        (&["examples", "zzz"], "`servobench examples` lists them"),
        (&["examples", "dc-link-sag"], "hardware/dc-link-sag, hardware/faults/dc-link-sag; name the folder, too"),
        (&["models", "teknic"], "did you mean `teknic-m2310p`?"),
        (&["models", "emps"], "axes/emps, drives/emps, motors/emps; name the folder, too"),
        (&["explain", "setling_time"], "did you mean `settling_time`?"),
        (&["explain", ""], "`servobench explain` lists what can be explained"),
    ] {
        let refused = typed(work.path(), words);
        assert_eq!(code(&refused), 2, "{words:?}");
        assert!(said(&refused).contains(expected), "{words:?}: {}", said(&refused));
    }
    assert_eq!(fs::read_dir(work.path()).unwrap().count(), 0);
}

#[test]
fn an_example_is_written_with_its_files_and_runs() {
    let work = folder(&[]);
    let written = typed(work.path(), &["examples", "plc/pv-blocks", "--to", "mine"]);
    assert_eq!(code(&written), 0, "{}", said(&written));
    insta::assert_snapshot!(shown(&written), @r"
    mine/pv-blocks.toml
    mine/points.csv

    function blocks in profile velocity mode: plateaus, steps along a spline, a move
      servobench run mine/pv-blocks.toml
    ");
    let run = typed(work.path(), &["run", "mine/pv-blocks.toml", "--engine", "exact", "--quiet"]);
    assert_eq!(code(&run), 0, "{}", said(&run));
    let sweep = typed(work.path(), &["examples", "jerk-or-snap"]);
    assert!(said(&sweep).contains("servobench sweep jerk-or-snap.sweep.toml"), "{}", said(&sweep));
    insta::assert_snapshot!(shown(&typed(work.path(), &["examples", "load-as-fmu"])), @r"
    load-as-fmu.toml

    It needs two-mass.fmu, which is not built in: the head of the scenario has the
    command that makes it.

    2.2 kW PMSM with an elastic load that is an FMU
      servobench run load-as-fmu.toml
    ");
}

#[test]
fn lists_fit_a_terminal() {
    let work = folder(&[]);
    let group = |text: &str, heading: &str| -> String {
        let lines = text.lines().skip_while(|line| *line != heading);
        lines.take_while(|line| !line.is_empty()).flat_map(|line| [line, "\n"]).collect()
    };
    let examples = shown(&typed(work.path(), &["examples"]));
    insta::assert_snapshot!(group(&examples, "templates"), @r"
    templates
      belt    a carriage on a toothed belt, 800 mm
      linear  a slide on a linear motor, 300 mm
      plc     function blocks over a fieldbus, 200 mm there and back
      rotary  a rotary table behind a gearbox, a quarter turn
      screw   a table on a ball screw, 200 mm
    ");
    for folder in ["scenarios", "demo", "hardware", "hardware/faults", "plc", "setpoints", "sweeps", "scenarios-fmu"] {
        assert!(group(&examples, folder).lines().count() > 1, "{folder}");
    }
    insta::assert_snapshot!(group(&shown(&typed(work.path(), &["models"])), "drives"), @r"
    drives
      emps         velocity.rate 1 kHz, velocity.kind p, velocity.gain 243.45 V s/m,
                   position.rate 1 kHz, position.gain 160.18 1/s
                   Janot, Gautier, Brunot: Data set and reference models of EMPS,
                   Nonlinear System Identification Benchmarks, 2019
      servo-16khz  dc_link 560 V, current.rate 16 kHz, current.bandwidth 1.2 kHz,
                   velocity.rate 8 kHz, velocity.bandwidth 60 Hz, position.rate
                   4 kHz, position.bandwidth 12 Hz
                   no product: task rates and bandwidths in the usual proportions;
                   gain rules as in Harnefors, Nee, IEEE Trans. Ind. Appl. 34(1),
                   1998 (current) and with both velocity poles at ω/2 (T_i = 4/ω)
    ");
    let names = shown(&typed(work.path(), &["explain"]));
    assert!(group(&names, "exit codes").ends_with("  0, 1, 2, 3, 4, 130, 143\n"), "{names}");
    for command in ["init", "examples", "explain", "models"] {
        shown(&typed(work.path(), &[command, "--help"]));
    }
}

#[test]
fn models_are_printed_as_they_are_and_as_json() {
    let work = folder(&[]);
    let model = typed(work.path(), &["models", "motors/emps"]);
    assert_eq!(model.stdout, fs::read(crate::repository().join("models/motors/emps.toml")).unwrap());
    let all = json(&typed(work.path(), &["models", "--json"]).stdout);
    let all = all.as_array().unwrap();
    let screw = all.iter().find(|model| model["name"] == "ball-screw").unwrap();
    assert_eq!((&screw["kind"], &screw["values"]["table.mass"]), (&"axes".into(), &"40 kg".into()));
    assert!(all.iter().all(|model| !model["source"].as_str().unwrap().is_empty()));
}
