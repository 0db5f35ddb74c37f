//! Tables in counts of the bus, and tables of steps.
use crate::SCREW;
use servobench_motion::pvt::Knot;
use servobench_planner::{Generator, Positioning, TableMove};
use servobench_plcopen::BlockInputs as _;
use servobench_plcopen::PositionProfileInputs;
use servobench_scenario::{LoadError, Step, parse};

const COUNTS: &str = "time [ms],position [counts],velocity [0.1 counts/s]\n0,0,0\n20,4000,4000000\n40,8000,0\n";
const STEPS: &str = "time [ms],step [mm],velocity [mm/s]\n0,0,0\n20,2,200\n40,2,0\n";
const NO_VELOCITIES: &str = "time [ms],step [counts]\n0,0\n20,4000\n40,4000\n";
const LENGTHS: &str = "time [ms],position [mm],velocity [mm/s]\n0,0,0\n20,2,200\n40,4,0\n";

/// The table of the first move of a program on the axis, over a bus with `units`.
fn table(file: &str, units: &str, keys: &str) -> Result<(TableMove, Positioning), String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("points.csv"), file).unwrap();
    let text = format!("{SCREW}{units}\n[[program]]\ntable = {{ file = \"points.csv\"{keys} }}\n");
    match parse("test.toml", &text, Some(folder.path())) {
        Ok(loaded) => match &loaded.scenario.program[0] {
            Step::Move(step) => match &step.request.generator {
                Generator::Table(table) => Ok((table.clone(), step.positioning)),
                other => panic!("{other:?}"),
            },
            other @ Step::Wait(_) => panic!("{other:?}"),
        },
        Err(LoadError::Invalid(invalid)) => Err(invalid.diagnostics[0].message.clone()),
        Err(other) => panic!("{other}"),
    }
}

const BUS: &str = "[bus]\ncycle = \"1 ms\"\nunits = { drive = 10000, axis = \"5 mm\" }";

/// 10 000 counts on 5 mm: the same table in counts, in millimetres and as steps.
#[test]
fn a_table_in_counts_or_steps_is_the_one_in_lengths() {
    let (lengths, absolute) = table(LENGTHS, BUS, "").unwrap();
    assert_eq!(lengths.knots[1], Knot { t: 0.02, x: 0.002, v: Some(0.2) });
    let (counts, positioning) = table(COUNTS, BUS, "").unwrap();
    assert_eq!((absolute, positioning), (Positioning::Absolute, Positioning::Absolute));
    let (steps, relative) = table(STEPS, BUS, "").unwrap();
    assert_eq!(relative, Positioning::Relative);
    for other in [counts, steps] {
        for (one, other) in lengths.knots.iter().zip(&other.knots) {
            let near = |one: f64, other: f64| (one - other).abs() < 1e-15;
            assert!(near(one.t, other.t) && near(one.x, other.x), "{one:?} {other:?}");
            assert!(near(one.v.unwrap(), other.v.unwrap()), "{one:?} {other:?}");
        }
    }
    // A motor mounted the other way round counts downwards.
    let (reversed, _) = table(COUNTS, &BUS.replace("5 mm", "-5 mm"), "").unwrap();
    assert!((reversed.knots[2].x + 0.004).abs() < 1e-15, "{:?}", reversed.knots);
    // Without a bus a count has no meaning.
    let said = table(COUNTS, "", "").unwrap_err();
    assert!(said.contains("`units` to the `[bus]` of a scenario"), "{said}");
    assert_eq!(table(STEPS, BUS, ", relative = false").unwrap_err(), "a table of steps counts from where the axis is");
}

#[test]
fn a_block_follows_a_table_of_steps_from_where_the_axis_is() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("points.csv"), NO_VELOCITIES).unwrap();
    let text = format!(
        "{}{BUS}\n[plc]\nhoming_required = false\n[[call]]\nblock = \"MC_PositionProfile\"\ntable = {{ file = \"points.csv\" }}\n",
        SCREW.replace("[run]", "[run]\nduration = \"1 s\"")
    );
    let loaded = parse("test.toml", &text, Some(folder.path())).unwrap_or_else(|error| panic!("{error}"));
    let plc = loaded.scenario.plc.unwrap();
    let inputs = PositionProfileInputs::read(&plc.calls[0].inputs, false);
    assert!(!inputs.time_position.is_absolute);
    let values: Vec<f64> = inputs.time_position.pairs.iter().map(|pair| pair.value).collect();
    assert!(values.iter().zip([0.0, 0.002, 0.004]).all(|(one, other)| (one - other).abs() < 1e-15), "{values:?}");
}
