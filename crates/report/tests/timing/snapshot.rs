//! A small diagram, whole.
use crate::drawn::whole;
use crate::recordings::{channel, empty, logic, signal};
use servobench_trace::Recording;

#[test]
fn a_small_diagram() {
    let mut recording = Recording {
        channels: vec![channel("setpoint.velocity", "m/s", vec![0.0, 0.01, 0.02, 0.02, 0.02, 0.01, 0.0, 0.0, 0.0])],
        signals: vec![
            logic("Move", "Execute", &[0.001]),
            logic("Move", "Done", &[0.007]),
            logic("Move", "Error", &[]),
            signal("axis", "state", &[(0.0, "Standstill"), (0.001, "Discrete Motion"), (0.007, "Standstill")]),
        ],
        ..empty()
    };
    recording.about.scenario = "a move".into();
    let svg = whole(&recording);
    // What follows the style, which is looked at and not read.
    let drawn = svg.split("</style>").nth(1).unwrap();
    insta::assert_snapshot!(drawn);
}
