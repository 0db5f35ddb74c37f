//! The resolved `[plc]` and `[[call]]`.
use servobench_motion::Limits;
use servobench_plcopen::generator::Mounting;
use servobench_plcopen::program::{Call, Condition, Inputs};
use servobench_plcopen::{
    AccelerationProfileInputs, BlockInputs, BlockName, BufferMode, Direction, Follow, HaltInputs, HomeInputs,
    MoveAbsoluteInputs, MoveAdditiveInputs, MoveContinuousAbsoluteInputs, MoveRelativeInputs, MoveSuperimposedInputs,
    MoveVelocityInputs, Output, Pair, PositionProfileInputs, PowerInputs, Profile4thInputs, ReadInputs, ResetInputs,
    SetOverrideInputs, SetPositionInputs, StopInputs, TimePosition, TorqueControlInputs, VelocityProfileInputs,
};
use servobench_scenario::{Plc, Scenario, parse};
use std::fmt::Debug;
use std::path::Path;

const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
duration = "2 s"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
[bus]
cycle = "1 ms"
[setpoint]
velocity = "0.5 m/s"
acceleration = "5 m/s2"
jerk = "100 m/s3"
snap = "5000 m/s4"
"#;

/// The scenario with `calls`, with some tables beside it.
fn scenario(calls: &str) -> Scenario {
    let folder = tempfile::tempdir().unwrap();
    for (name, heading) in [("x.csv", "position [mm]"), ("v.csv", "velocity [mm/s]"), ("a.csv", "acceleration [m/s2]")]
    {
        std::fs::write(folder.path().join(name), format!("time [ms],{heading}\n0,0\n10,5\n20,0\n")).unwrap();
    }
    let folder: &Path = folder.path();
    parse("test.toml", &format!("{AXIS}{calls}"), Some(folder)).unwrap_or_else(|e| panic!("{e}")).scenario
}

fn plc(calls: &str) -> Plc {
    scenario(calls).plc.unwrap()
}

/// A single call of `block` with `keys`.
fn call(block: &str, keys: &str) -> Call {
    plc(&format!("[[call]]\nblock = \"{block}\"\n{keys}\n")).calls.remove(0)
}

/// Limits of `[setpoint]`.
const LIMITS: Limits = Limits { velocity: 0.5, acceleration: 5.0, jerk: 100.0, snap: 5000.0 };

/// Checks that the call of a block with `keys` has these inputs, without diagnostics.
fn check<I: for<'i> BlockInputs<'i> + PartialEq + Debug + Copy>(name: &str, keys: &str, inputs: I) {
    let call = call(name, keys);
    assert_eq!(I::read(&call.inputs, false), inputs, "{name}");
    let alone = Call {
        name: format!("{name}_0"),
        block: BlockName::from_name(name).unwrap(),
        inputs: call.inputs.clone(),
        start: Condition::AtOnce,
        stop: None,
        timeout: f64::INFINITY,
        is_optional: false,
        updates: vec![],
    };
    assert_eq!(call, alone);
}

#[test]
fn every_block_with_its_least_inputs() {
    check("MC_Power", "", PowerInputs::default());
    check("MC_Home", "", HomeInputs::default());
    check("MC_Stop", "", StopInputs::within(&LIMITS));
    check("MC_Halt", "", HaltInputs::within(&LIMITS));
    check("MC_Reset", "", ResetInputs::default());
    let inputs = MoveAbsoluteInputs { position: 0.001, ..MoveAbsoluteInputs::within(&LIMITS) };
    check("MC_MoveAbsolute", "position = \"1 mm\"", inputs);
    let inputs = MoveRelativeInputs { distance: -0.001, ..MoveRelativeInputs::within(&LIMITS) };
    check("MC_MoveRelative", "distance = \"-1 mm\"", inputs);
    let inputs = MoveAdditiveInputs { distance: 0.001, ..MoveAdditiveInputs::within(&LIMITS) };
    check("MC_MoveAdditive", "distance = \"1 mm\"", inputs);
    let inputs =
        MoveSuperimposedInputs { distance: 0.001, velocity_diff: 0.1, ..MoveSuperimposedInputs::within(&LIMITS) };
    check("MC_MoveSuperimposed", "distance = \"1 mm\"\nvelocity_difference = \"0.1 m/s\"", inputs);
    let inputs = MoveVelocityInputs { velocity: -0.25, ..MoveVelocityInputs::within(&LIMITS) };
    check("MC_MoveVelocity", "velocity = \"-0.25 m/s\"", inputs);
    let inputs = MoveContinuousAbsoluteInputs {
        position: 0.001,
        end_velocity: -0.1,
        ..MoveContinuousAbsoluteInputs::within(&LIMITS)
    };
    check("MC_MoveContinuousAbsolute", "position = \"1 mm\"\nend_velocity = \"-0.1 m/s\"", inputs);
    let inputs = SetPositionInputs { position: 0.001, ..SetPositionInputs::default() };
    check("MC_SetPosition", "position = \"1 mm\"", inputs);
    check("MC_SetOverride", "", SetOverrideInputs::default());
    let inputs = TorqueControlInputs { torque: -2.0, ..TorqueControlInputs::within(&LIMITS) };
    check("MC_TorqueControl", "torque = \"-2 Nm\"", inputs);
    for name in
        ["MC_ReadStatus", "MC_ReadAxisError", "MC_ReadActualPosition", "MC_ReadActualVelocity", "MC_ReadActualTorque"]
    {
        check(name, "", ReadInputs::default());
    }
    let inputs = Profile4thInputs { settling_time: 0.05, ..Profile4thInputs::to(0.001, LIMITS) };
    check("Profile4th", "position = \"1 mm\"\nsettling_time = \"50 ms\"", inputs);
}

/// Times count from the start of the profile, pairs from the previous one.
#[test]
fn profiles_of_positions_velocities_and_accelerations() {
    let pairs = |values: [f64; 3]| {
        let times = [0.0, 0.01, 0.01];
        std::array::from_fn::<_, 3, _>(|i| Pair { delta_time: times[i], value: values[i] })
    };
    let rows = pairs([0.0, 0.005, 0.0]);
    let spline = PositionProfileInputs::along(&rows);
    let plateaus = |share| PositionProfileInputs { follow: Follow::Plateaus(share), ..spline };
    let relative = TimePosition { is_absolute: false, ..spline.time_position };
    for (keys, expected) in [
        ("table = { file = \"x.csv\" }", spline),
        (
            "table = { file = \"x.csv\", relative = true, velocities = \"continuous\" }\nend_velocity = \"-0.1 m/s\"",
            PositionProfileInputs { time_position: relative, end_velocity: -0.1, ..spline },
        ),
        (
            "table = { file = \"x.csv\" }\ntime_scale = \"50 %\"\nvalue_scale = 3\nposition_offset = \"-10 mm\"",
            PositionProfileInputs { time_scale: 0.5, position_scale: 3.0, offset: -0.01, ..spline },
        ),
        ("table = { file = \"x.csv\", follow = \"plateaus\" }", plateaus(Some(0.25))),
        ("table = { file = \"x.csv\", follow = \"plateaus\", plateau_share = 0.3 }", plateaus(Some(0.3))),
        ("table = { file = \"x.csv\", follow = \"plateaus\", plateau_share = \"auto\" }", plateaus(None)),
    ] {
        let call = call("MC_PositionProfile", keys);
        assert_eq!(PositionProfileInputs::read(&call.inputs, false), expected);
    }
    let along = VelocityProfileInputs::along(&rows);
    for (keys, expected) in [
        ("table = { file = \"v.csv\" }", along),
        (
            "table = { file = \"v.csv\" }\ntime_scale = 2\nvalue_scale = \"-50 %\"\nvelocity_offset = \"0.1 m/s\"",
            VelocityProfileInputs { time_scale: 2.0, velocity_scale: -0.5, offset: 0.1, ..along },
        ),
    ] {
        let call = call("MC_VelocityProfile", keys);
        assert_eq!(VelocityProfileInputs::read(&call.inputs, false), expected);
    }
    let rows = pairs([0.0, 5.0, 0.0]);
    let along = AccelerationProfileInputs::along(&rows);
    for (keys, expected) in [
        ("table = { file = \"a.csv\" }", along),
        (
            "table = { file = \"a.csv\" }\nacceleration_offset = \"-2 m/s2\"",
            AccelerationProfileInputs { offset: -2.0, ..along },
        ),
    ] {
        let call = call("MC_AccelerationProfile", keys);
        assert_eq!(AccelerationProfileInputs::read(&call.inputs, false), expected);
    }
}

#[test]
fn every_block_with_inputs_of_its_own() {
    let own = "velocity = \"0.1 m/s\"\nacceleration = \"1 m/s2\"\ndeceleration = \"2 m/s2\"\njerk = \"3 m/s3\"\n\
               snap = \"4 m/s4\"\nbuffer_mode = \"blending-high\"\ncontinuous_update = true\n";
    let (jerk, snap, buffer_mode) = (Some(3.0), Some(4.0), BufferMode::BlendingHigh);
    let inputs = MoveRelativeInputs {
        execute: false,
        distance: 0.001,
        velocity: 0.1,
        acceleration: 1.0,
        deceleration: 2.0,
        jerk,
        snap,
        buffer_mode,
        continuous_update: true,
    };
    check("MC_MoveRelative", &format!("distance = \"1 mm\"\n{own}"), inputs);
    let inputs = MoveVelocityInputs {
        execute: false,
        velocity: 0.1,
        acceleration: 1.0,
        deceleration: 2.0,
        jerk,
        snap,
        direction: Direction::Current,
        buffer_mode,
        continuous_update: true,
    };
    check("MC_MoveVelocity", &format!("direction = \"current\"\n{own}"), inputs);
    check(
        "MC_TorqueControl",
        "torque = \"1 Nm\"\ntorque_ramp = \"10 Nm/s\"\nvelocity = \"0.1 m/s\"\ndirection = \"negative\"\n\
         buffer_mode = \"blending-high\"\ncontinuous_update = true\n",
        TorqueControlInputs {
            execute: false,
            torque: 1.0,
            torque_ramp: 10.0,
            velocity: 0.1,
            direction: Direction::Negative,
            buffer_mode,
            continuous_update: true,
        },
    );
    check(
        "MC_Halt",
        "deceleration = \"2 m/s2\"\njerk = \"3 m/s3\"\nsnap = \"4 m/s4\"\nbuffer_mode = \"buffered\"",
        HaltInputs { execute: false, deceleration: 2.0, jerk, snap, buffer_mode: BufferMode::Buffered },
    );
    check(
        "MC_SetOverride",
        "velocity_factor = 0\nacceleration_factor = \"50 %\"\njerk_factor = 0.25",
        SetOverrideInputs { enable: false, vel_factor: 0.0, acc_factor: 0.5, jerk_factor: 0.25 },
    );
    check(
        "MC_SetPosition",
        "position = \"1 mm\"\nrelative = true",
        SetPositionInputs { execute: false, position: 0.001, relative: true },
    );
    check(
        "MC_Home",
        "position = \"-1 mm\"\nbuffer_mode = \"buffered\"",
        HomeInputs { execute: false, position: -0.001, buffer_mode: BufferMode::Buffered },
    );
    check(
        "MC_MoveSuperimposed",
        "distance = \"0 mm\"\nvelocity_difference = \"0.1 m/s\"\ncontinuous_update = true",
        MoveSuperimposedInputs {
            velocity_diff: 0.1,
            continuous_update: true,
            ..MoveSuperimposedInputs::within(&LIMITS)
        },
    );
    check(
        "Profile4th",
        "position = \"1 mm\"\nsettling_time = \"50 ms\"\nreversed = true",
        Profile4thInputs { settling_time: 0.05, mounting: Mounting::Opposite, ..Profile4thInputs::to(0.001, LIMITS) },
    );
    check(
        "Profile4th",
        "position = \"1 mm\"\nsettling_time = \"50 ms\"\norder = 3",
        Profile4thInputs { settling_time: 0.05, order: 3.0, ..Profile4thInputs::to(0.001, LIMITS) },
    );
    for (name, buffer_mode) in [
        ("aborting", BufferMode::Aborting),
        ("blending-low", BufferMode::BlendingLow),
        ("blending-previous", BufferMode::BlendingPrevious),
        ("blending-next", BufferMode::BlendingNext),
    ] {
        let inputs = HaltInputs { buffer_mode, ..HaltInputs::within(&LIMITS) };
        check("MC_Halt", &format!("buffer_mode = \"{name}\""), inputs);
    }
}

/// The order of `[setpoint]` determines which of its limits apply.
#[test]
fn limits_are_those_of_the_order() {
    let of_order = |order: &str| {
        let text = AXIS.replace("[setpoint]\n", &format!("[setpoint]\n{order}"));
        let text = format!("{text}[[call]]\nblock = \"MC_Stop\"\n");
        parse("test.toml", &text, None).unwrap().scenario.plc.unwrap()
    };
    for (order, jerk, snap) in [
        ("order = 2\n", f64::INFINITY, f64::INFINITY),
        ("order = 3\n", 100.0, f64::INFINITY),
        ("order = 4\n", 100.0, 5000.0),
        ("", 100.0, 5000.0),
    ] {
        let plc = of_order(order);
        assert_eq!(plc.limits.map(f64::to_bits), [0.5, 5.0, jerk, snap].map(f64::to_bits), "{order}");
        let inputs = StopInputs::read(&plc.calls[0].inputs, false);
        assert_eq!(inputs, StopInputs::within(&Limits { jerk, snap, ..LIMITS }), "{order}");
    }
}

#[test]
fn a_modulo_axis_has_directions() {
    let text = AXIS.replace("model = \"ball-screw\"\n", "model = \"ball-screw\"\nmodulo = \"0.1 m\"\n");
    let calls = "[plc]\nhoming_required = false\n[[call]]\nblock = \"MC_MoveAbsolute\"\nposition = \"10 mm\"\n\
                 direction = \"negative\"\n";
    let scenario = parse("test.toml", &format!("{text}{calls}"), None).unwrap().scenario;
    assert_eq!(scenario.axis.modulo, Some(0.1));
    let plc = scenario.plc.unwrap();
    assert!(!plc.homing_required);
    assert_eq!(MoveAbsoluteInputs::read(&plc.calls[0].inputs, false).direction, Direction::Negative);
}

#[test]
fn conditions_refer_to_calls_by_their_place() {
    let plc = plc(r#"
[[call]]
block = "MC_Halt"
start = "turn.InVelocity"
stop = { at = "1.5 s" }
timeout = "1.9 s"
[[call]]
block = "MC_Power"
[[call]]
block = "MC_MoveVelocity"
name = "turn"
start = { after = "MC_Power_0.Status", delay = "50 ms" }
[[call]]
block = "MC_Halt"
start = { above = "50 mm" }
[[call]]
block = "MC_ReadStatus"
name = "state"
start = { at = "0.2 s" }
[[call]]
block = "MC_Halt"
start = { below = "-50 mm" }
stop = "state.Standstill"
"#);
    assert!(plc.homing_required);
    let names: Vec<_> = plc.calls.iter().map(|call| call.name.as_str()).collect();
    assert_eq!(names, ["MC_Halt_0", "MC_Power_0", "turn", "MC_Halt_1", "state", "MC_Halt_2"]);
    let after = |call, output, delay| Condition::After { call, output, delay };
    let starts: Vec<_> = plc.calls.iter().map(|call| (call.start, call.stop, call.timeout)).collect();
    let never = f64::INFINITY;
    let expected = [
        (after(2, Output::InVelocity, 0.0), Some(Condition::At(1.5)), 1.9),
        (Condition::AtOnce, None, never),
        (after(1, Output::Status, 0.05), None, never),
        (Condition::Above(0.05), None, never),
        (Condition::At(0.2), None, never),
        (Condition::Below(-0.05), Some(after(4, Output::Standstill, 0.0)), never),
    ];
    assert_eq!(starts, expected);
}

/// The permissions of MC_Power change while it is enabled.
#[test]
fn permissions_change_under_power() {
    let when =
        "{ when = { at = \"1 s\" }, enable_positive = false }, { when = { at = \"1.5 s\" }, enable_negative = true }";
    let call = call("MC_Power", &format!("enable_negative = false\nupdates = [{when}]"));
    let permits = |inputs: &Inputs| {
        let PowerInputs { enable_positive, enable_negative, .. } = PowerInputs::read(inputs, false);
        [enable_positive, enable_negative]
    };
    let updates: Vec<_> = call.updates.iter().map(|update| permits(&update.inputs)).collect();
    assert_eq!((permits(&call.inputs), updates), ([true, false], vec![[false, false], [false, true]]));
}

/// An update changes the given inputs; the others keep the values of the previous update.
#[test]
fn updates_add_up() {
    let call = call(
        "MC_MoveVelocity",
        r#"
continuous_update = true
updates = [
    { when = { at = "0.3 s" }, velocity = "0.1 m/s" },
    { when = { at = "0.6 s" }, acceleration = "1 m/s2", direction = "negative" },
]
"#,
    );
    let inputs = |velocity, acceleration, direction| MoveVelocityInputs {
        velocity,
        acceleration,
        deceleration: acceleration,
        direction,
        continuous_update: true,
        ..MoveVelocityInputs::within(&LIMITS)
    };
    let read = |inputs: &Inputs| MoveVelocityInputs::read(inputs, false);
    assert_eq!(read(&call.inputs), inputs(0.5, 5.0, Direction::Positive));
    let updates: Vec<_> = call.updates.iter().map(|update| (update.when, read(&update.inputs))).collect();
    let expected = [
        (Condition::At(0.3), inputs(0.1, 5.0, Direction::Positive)),
        (Condition::At(0.6), inputs(0.1, 1.0, Direction::Negative)),
    ];
    assert_eq!(updates, expected);
}
