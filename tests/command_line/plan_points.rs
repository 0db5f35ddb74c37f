//! Moves as tables of points, and back.
use super::{code, folder, json, said, servobench};
use serde_json::Value;
use std::path::Path;

/// Every time is a whole number of 10 ms.
const S_CURVE: &str = "--order 3 --distance 1m --velocity 1m/s --acceleration 5m/s2 --jerk 50m/s3 --sample-time 10ms";

fn plan(line: &str) -> String {
    let output = servobench(&["plan"].into_iter().chain(line.split_whitespace()).collect::<Vec<_>>());
    assert_eq!(code(&output), 0, "{line}: {}", said(&output));
    said(&output)
}

fn json_of(line: &str) -> Value {
    let output = servobench(&["plan"].into_iter().chain(line.split_whitespace()).chain(["--json"]).collect::<Vec<_>>());
    assert_eq!(code(&output), 0, "{line}: {}", said(&output));
    json(&output.stdout)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn name(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Oracle: the closed form of the S-curve (1 m, 1 m/s, 5 m/s², 50 m/s³: 0.1 s of jerk, 0.1 s of constant acceleration, 0.7 s of cruise, 1.3 s
/// in all, all of them whole multiples of 10 ms). Its jerk is constant between its samples, where the way through the points is a cubic:
/// the same one.
#[test]
fn what_plan_writes_plan_reads() {
    let work = folder(&[]);
    let csv = work.path().join("move.csv");
    plan(&format!("{S_CURVE} --csv {}", name(&csv)));
    let said = plan(&format!("pvt --points {}", name(&csv)));
    assert!(said.contains("move of 1 m through 131 points in 1.3 s"), "{said}");
    assert!(said.contains("not used of the table: acceleration, jerk, snap;"), "{said}");
    let again = json_of(&format!("pvt --points {}", name(&csv)));
    assert!((number(&again["duration_s"]) - 1.3).abs() < 1e-12);
    // Second and third differences of positions over 10 ms magnify rounding of 1e-16 by 1e4·6 and 1e6·12.
    for (derivative, peak, rounding) in [("velocity", 1.0, 1e-12), ("acceleration", 5.0, 1e-10), ("jerk", 50.0, 1e-7)] {
        let found = number(&again["peaks"][derivative]);
        assert!((found - peak).abs() < rounding, "{derivative}: {found}");
    }
}

/// The same table in a program and in a profile block.
#[test]
fn scenarios_read_what_plan_writes() {
    let axis = "[run]\nbase_rate = \"4 kHz\"\nduration = \"2 s\"\n[axis]\nmotion = \"linear\"\n[axis.motor_side]\nmass = \"20 kg\"\n\
                [motor]\nkind = \"ideal-source\"\nlimit = \"1 kN\"\n[drive.velocity]\nrate = \"4 kHz\"\nbandwidth = \"80 Hz\"\nkind = \"p\"\n\
                [drive.position]\nrate = \"4 kHz\"\nbandwidth = \"10 Hz\"\n";
    let program = format!("{axis}[[program]]\ntable = {{ file = \"move.csv\" }}\n");
    let bus = "[bus]\ncycle = \"1 ms\"\nmotion_cycle = \"4 ms\"\nunits = { drive = 1, axis = \"1 um\" }\n[plc]\nhoming_required = false\n";
    let calls = "[[call]]\nblock = \"MC_Power\"\nname = \"power\"\n[[call]]\nblock = \"MC_PositionProfile\"\nname = \"go\"\n\
                 start = \"power.Status\"\ntable = { file = \"move.csv\" }\n";
    let work = folder(&[("program.toml", &program), ("block.toml", &format!("{axis}{bus}{calls}"))]);
    plan(&format!("{S_CURVE} --csv {} --csv-step 20ms", name(&work.path().join("move.csv"))));
    for (file, warns) in [("program.toml", false), ("block.toml", true)] {
        let output = servobench(&["run", name(&work.path().join(file))]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let warning = "MC_PositionProfile chooses the velocities itself";
        assert_eq!(said(&output).contains(warning), warns, "{}", said(&output));
    }
}
