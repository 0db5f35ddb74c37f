//! What keeps a scenario from being built is told at once.
use crate::rig;
use servobench_plant::{Exact, MechanicsError, MjcfModel};
use servobench_scenario::{AxisMechanics, Scenario};
use servobench_signals::Signal;
use servobench_sim::{Bench, BuildError, NoFmus};

fn scenario(program: &str) -> Scenario {
    let text = format!(
        r#"
[run]
base_rate = "1 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "1 kHz"
bandwidth = "20 Hz"
[drive.position]
rate = "1 kHz"
gain = "20 1/s"
[setpoint]
order = 2
velocity = "1 m/s"
acceleration = "1 m/s2"
[[program]]
move_to = "10 mm"
{program}
[record]
channels = "table.position"
"#
    );
    rig::scenario(&text)
}

/// A move that its limits do not let be so fast, and mechanics that `exact` has not.
#[test]
fn program_and_mechanics_are_objected_to_together() {
    let mut scenario = scenario("duration = \"1 ms\"");
    let name = || "m".to_owned();
    scenario.axis.mechanics = AxisMechanics::Mjcf(MjcfModel {
        xml: "<mujoco/>".into(),
        path: "m.xml".into(),
        motor_joint: name(),
        load_joint: name(),
        actuator: name(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    });
    let found = Bench::objections(&scenario, &Exact, &NoFmus);
    let [BuildError::Plan { index: 0, .. }, BuildError::Mechanics(MechanicsError::Unsupported { .. })] = &found[..]
    else {
        panic!("{found:?}");
    };
}

#[test]
fn what_stands_on_them_is_objected_to_without_them() {
    let mut scenario = scenario("");
    let found = Bench::objections(&scenario, &Exact, &NoFmus);
    assert!(matches!(&found[..], [BuildError::UnknownChannel { signal: Signal::TablePosition, .. }]), "{found:?}");
    scenario.record.channels.clear();
    assert_eq!(Bench::objections(&scenario, &Exact, &NoFmus), []);
}
