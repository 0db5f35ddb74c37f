//! Fuzz targets: any file is a scenario in which every number makes sense, or yields a list of mistakes with places in their files.
//! `docs/testing.md` explains how to run more of them.
mod flux;
mod points;
mod quantities;
mod ranges;
mod sound;
mod sweeps;

use servobench_fuzz::{Splice, Target, check, fuzz};
use servobench_scenario::{Diagnostic, LoadError, Loaded, Sources, embedded_models, parse};
use std::fs;
use std::path::{Path, PathBuf};

/// Every scenario in the repository, and the empty file.
const SCENARIOS: [&str; 20] = [
    "",
    include_str!("../../../../scenarios/demo/jerk.toml"),
    include_str!("../../../../scenarios/demo/snap.toml"),
    include_str!("../../../../scenarios/emps.toml"),
    include_str!("../../../../scenarios/feed-axis-load-step.toml"),
    include_str!("../../../../scenarios/feed-axis-move.toml"),
    include_str!("../../../../scenarios/feed-axis-stick-slip.toml"),
    include_str!("../../../../scenarios/lambrechts-snap.toml"),
    include_str!("../../../../scenarios/own-mjcf.toml"),
    include_str!("../../../../scenarios/plc/buffered.toml"),
    include_str!("../../../../scenarios/plc/bus-jitter.toml"),
    include_str!("../../../../scenarios/plc/figure-3b.toml"),
    include_str!("../../../../scenarios/plc/homing.toml"),
    include_str!("../../../../scenarios/two-mass.toml"),
    include_str!("../../../../scenarios/two-mass-held.toml"),
    include_str!("../../../../scenarios/two-mass-ring-down.toml"),
    include_str!("../../../../scenarios/vibration-jerk.toml"),
    include_str!("../../../../scenarios/vibration-snap.toml"),
    include_str!("../../../../tests/scenarios/must-fail.toml"),
    include_str!("../../../../scenarios/hardware/saturation.toml"),
];

/// Ingredients of mistakes: the punctuation of TOML, keys, names, units, and numbers at every end of the scale.
#[rustfmt::skip]
const WORDS: &[&str] = &[
    "\"", "\"\"\"", "'", "'''", "[", "[[", "]", "]]", "{", "}", "=", " = ", ",", ".", "#", "\n", "\r\n", "\t", "\\",
    "\\u0000", "\u{0}", "\u{feff}", "\u{1f600}", "µ", "²", "³", "⁻", "·", "°", "/", "*", "^", "(", ")", "%",
    "a.b.c.d", "[a]\n", "[[program]]\n", "[[disturbance]]\n", "[drive]\n", "[drive.velocity]\n", "[drive.estimate]\n",
    "[axis]\n", "[axis.load]\n", "[axis.mjcf]\n", "[motor]\n", "[motor.saturation]\n", "[motor.flux_map]\n", "share = 0.9\n", "[run]\n", "[setpoint]\n", "[limits]\n", "[record]\n",
    "[measure]\n", "[initial]\n", "kind = \"prescribed\"\n", "kind = \"pmsm\"\n", "kind = \"ideal-source\"\n",
    "lead = \"10 mm\"\n", "gear_ratio = 5\n", "motion = \"rotary\"\n", "model = \"emps\"\n", "model = \"lambrechts\"\n",
    "move_by = \"-1 mm\"\n", "wait = \"1 s\"\n", "order = 2\n", "order = 4\n", "duration = \"2 s\"\n",
    "sample_time = \"1 ms\"\n", "mass = \"1 kg\"\n", "inertia = \"1 kg m2\"\n", "gain = \"1 N/V\"\n", "limit = \"10 V\"\n",
    "[bus]\n", "[[bus.fault]]\n", "[[call]]\n", "[plc]\n", "[drive.objects]\n", "[axis.switches]\n", "block = \"MC_Halt\"\n",
    "cycle = \"1 ms\"\n", "mode = \"csv\"\n", "start = \"power.Status\"\n", "\"607Dh.2\" = 5\n", "modulo = \"360 deg\"\n",
    "static = \"1 N\"\n", "coulomb = \"1 Nm\"\n", "bandwidth = \"10 Hz\"\n", "rate = \"1 kHz\"\n", "enabled = false\n",
    "counts_per_rev = 4294967295\n", "true", "false", "auto", "exact", "rapier", "load", "motor", "linear", "rotary",
    "m", "mm", "km", "um", "s", "min", "ms", "Hz", "kHz", "rad", "deg", "rev", "rpm", "krpm", "N", "Nm", "kg", "A", "Apk",
    "Arms", "V", "Vrms", "Ohm", "mH", "1/s",
    "0", "-0", "0.0", "-1", "1", "2", "3", "5", "0.5", "1e3", "1e-3", "1e30", "1e-30", "1e300", "1e-300", "1e308",
    "5e-324", "1e400", "1e-400", "1e99999999999", "nan", "inf", "-inf", "0x7f", "0b1", "1_000", "255", "65536",
    "4294967295", "4294967296", "9223372036854775807", "-9223372036854775808", "9223372036854775808",
    "99999999999999999999", "1979-05-27T07:32:00Z",
];

/// A loaded scenario is sound; every reported place is in its file.
fn check_outcome(outcome: Result<Loaded, LoadError>) {
    match outcome {
        Ok(loaded) => {
            check_places(&loaded.sources, &loaded.warnings);
            sound::check(&loaded.scenario);
        }
        Err(LoadError::Invalid(invalid)) => {
            assert!(!invalid.diagnostics.is_empty());
            check_places(&invalid.sources, &invalid.diagnostics);
            check_places(&invalid.sources, &invalid.warnings);
        }
        Err(LoadError::Read { path, error }) => panic!("{}: {error}", path.display()),
    }
}

fn check_places(sources: &Sources, all: &[Diagnostic]) {
    for one in all {
        let file = sources.text(one.source);
        assert!(file.get(one.span.clone()).is_some(), "{:?} of {} bytes: {}", one.span, file.len(), one.message);
        assert!(!one.message.is_empty() && !one.line(sources).is_empty());
    }
}

/// Folder of the scenarios, with their models beside them.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios")
}

#[test]
fn scenario_files() {
    let folder = folder();
    fuzz(check!(), 1_500, Splice::text(&SCENARIOS, WORDS), |text| {
        check_outcome(parse("any.toml", text, Some(&folder)));
    });
}

/// `scenario` with the model `fuzzed` in `table`.
fn with_model(scenario: &str, table: &str) -> String {
    let (before, after) = scenario.split_once(&format!("[{table}]\nmodel = \"")).unwrap();
    let (_, after) = after.split_once('"').unwrap();
    format!("{before}[{table}]\nmodel = \"fuzzed\"{after}")
}

/// Valid scenarios with a model of one kind that may be wrong: its mistakes are reported at their places in the model.
fn models(target: Target, (folder, table): (&str, &str), users: &[&str]) {
    let home = tempfile::tempdir().unwrap();
    let place = home.path().join("models").join(folder);
    fs::create_dir_all(&place).unwrap();
    let users: Vec<_> = users.iter().map(|scenario| with_model(scenario, table)).collect();
    let models = embedded_models();
    let models: Vec<&str> = models.iter().filter(|(path, _)| path.starts_with(folder)).map(|(_, text)| *text).collect();
    fuzz(target, 200, Splice::text(&models, WORDS), |model| {
        fs::write(place.join("fuzzed.toml"), model).unwrap();
        for user in &users {
            check_outcome(parse("user.toml", user, Some(home.path())));
        }
    });
}

const DEMO: &str = SCENARIOS[1];
const EMPS: &str = SCENARIOS[3];
const LAMBRECHTS: &str = SCENARIOS[7];
const TWO_MASS: &str = SCENARIOS[13];

#[test]
fn axis_models() {
    models(check!(), ("axes", "axis"), &[DEMO, EMPS, LAMBRECHTS, TWO_MASS]);
}

#[test]
fn motor_models() {
    models(check!(), ("motors", "motor"), &[DEMO, EMPS, TWO_MASS]);
}

#[test]
fn drive_models() {
    models(check!(), ("drives", "drive"), &[EMPS, TWO_MASS]);
}
