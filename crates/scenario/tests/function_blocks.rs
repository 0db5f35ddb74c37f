//! What `[plc]` and `[[call]]` become.
use servobench_scenario::*;
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

/// The scenario with `calls`, beside some tables.
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

/// A call of `block` with `keys`, alone.
fn call(block: &str, keys: &str) -> Call {
    plc(&format!("[[call]]\nblock = \"{block}\"\n{keys}\n")).calls.remove(0)
}

/// What `[setpoint]` says.
const DYNAMICS: Dynamics = Dynamics { velocity: 0.5, acceleration: 5.0, deceleration: 5.0, jerk: 100.0, snap: 5000.0 };
const BRAKING: Braking = Braking { deceleration: 5.0, jerk: 100.0, snap: 5000.0 };

/// The call of a block that says nothing but its inputs.
fn alone(name: &str, block: Block) -> Call {
    Call {
        name: format!("{name}_0"),
        block,
        start: Condition::AtOnce,
        stop: None,
        timeout: f64::INFINITY,
        is_optional: false,
        updates: vec![],
    }
}

#[test]
fn every_block_with_its_least_inputs() {
    let (aborting, command) = (BufferMode::Aborting, Command::default());
    for (name, keys, block) in [
        ("MC_Power", "", Block::Power { positive: true, negative: true }),
        ("MC_Home", "", Block::Home { position: 0.0, buffer_mode: aborting }),
        ("MC_Stop", "", Block::Stop(BRAKING)),
        ("MC_Halt", "", Block::Halt { braking: BRAKING, buffer_mode: aborting }),
        ("MC_Reset", "", Block::Reset),
        (
            "MC_MoveAbsolute",
            "position = \"1 mm\"",
            Block::MoveAbsolute { position: 0.001, direction: Direction::Shortest, dynamics: DYNAMICS, command },
        ),
        (
            "MC_MoveRelative",
            "distance = \"-1 mm\"",
            Block::MoveRelative { distance: -0.001, dynamics: DYNAMICS, command },
        ),
        (
            "MC_MoveAdditive",
            "distance = \"1 mm\"",
            Block::MoveAdditive { distance: 0.001, dynamics: DYNAMICS, command },
        ),
        (
            "MC_MoveSuperimposed",
            "distance = \"1 mm\"\nvelocity_difference = \"0.1 m/s\"",
            Block::MoveSuperimposed {
                distance: 0.001,
                dynamics: Dynamics { velocity: 0.1, ..DYNAMICS },
                continuous_update: false,
            },
        ),
        (
            "MC_MoveVelocity",
            "velocity = \"-0.25 m/s\"",
            Block::MoveVelocity {
                velocity: -0.25,
                direction: Direction::Positive,
                dynamics: Dynamics { velocity: 0.25, ..DYNAMICS },
                command,
            },
        ),
        (
            "MC_MoveContinuousAbsolute",
            "position = \"1 mm\"\nend_velocity = \"-0.1 m/s\"",
            Block::MoveContinuousAbsolute {
                position: 0.001,
                end_velocity: -0.1,
                direction: Direction::Shortest,
                dynamics: DYNAMICS,
                command,
            },
        ),
        ("MC_SetPosition", "position = \"1 mm\"", Block::SetPosition { position: 0.001, relative: false }),
        ("MC_SetOverride", "", Block::SetOverride { factors: [1.0; 3] }),
        (
            "MC_TorqueControl",
            "torque = \"-2 Nm\"",
            Block::TorqueControl {
                torque: -2.0,
                torque_ramp: f64::INFINITY,
                velocity: 0.5,
                direction: Direction::Positive,
                command,
            },
        ),
        ("MC_ReadStatus", "", Block::ReadStatus),
        ("MC_ReadAxisError", "", Block::ReadAxisError),
        ("MC_ReadActualPosition", "", Block::ReadActualPosition),
        ("MC_ReadActualVelocity", "", Block::ReadActualVelocity),
        ("MC_ReadActualTorque", "", Block::ReadActualTorque),
        (
            "Profile4th",
            "position = \"1 mm\"\nsettling_time = \"50 ms\"",
            Block::Profile4th {
                position: 0.001,
                limits: [0.5, 5.0, 100.0, 5000.0],
                settling_time: 0.05,
                reversed: false,
            },
        ),
    ] {
        assert_eq!(call(name, keys), alone(name, block));
    }
}

/// Times count from the start of the profile, pairs from the one before.
#[test]
fn profiles_of_positions_velocities_and_accelerations() {
    let buffer_mode = BufferMode::Aborting;
    let pairs = |values: [f64; 3]| {
        let times = [0.0, 0.01, 0.01];
        times.into_iter().zip(values).map(|(delta_time, value)| Pair { delta_time, value }).collect()
    };
    let scales = Scales { time: 1.0, value: 1.0, offset: 0.0 };
    let positions = |is_relative, follow, end_velocity| Block::PositionProfile {
        pairs: pairs([0.0, 0.005, 0.0]),
        scales,
        is_relative,
        follow,
        end_velocity,
        buffer_mode,
    };
    let plateaus = |share| positions(false, ProfileFollow::Plateaus(share), 0.0);
    for (name, keys, block) in [
        ("MC_PositionProfile", "table = { file = \"x.csv\" }", positions(false, ProfileFollow::Spline, 0.0)),
        (
            "MC_PositionProfile",
            "table = { file = \"x.csv\", relative = true, velocities = \"continuous\" }\nend_velocity = \"-0.1 m/s\"",
            positions(true, ProfileFollow::Spline, -0.1),
        ),
        (
            "MC_PositionProfile",
            "table = { file = \"x.csv\" }\ntime_scale = \"50 %\"\nvalue_scale = 3\nposition_offset = \"-10 mm\"",
            Block::PositionProfile {
                pairs: pairs([0.0, 0.005, 0.0]),
                scales: Scales { time: 0.5, value: 3.0, offset: -0.01 },
                is_relative: false,
                follow: ProfileFollow::Spline,
                end_velocity: 0.0,
                buffer_mode,
            },
        ),
        ("MC_PositionProfile", "table = { file = \"x.csv\", follow = \"plateaus\" }", plateaus(0.25)),
        (
            "MC_PositionProfile",
            "table = { file = \"x.csv\", follow = \"plateaus\", plateau_share = 0.3 }",
            plateaus(0.3),
        ),
        (
            "MC_VelocityProfile",
            "table = { file = \"v.csv\" }",
            Block::VelocityProfile { pairs: pairs([0.0, 0.005, 0.0]), scales, buffer_mode },
        ),
        (
            "MC_VelocityProfile",
            "table = { file = \"v.csv\" }\ntime_scale = 2\nvalue_scale = \"-50 %\"\nvelocity_offset = \"0.1 m/s\"",
            Block::VelocityProfile {
                pairs: pairs([0.0, 0.005, 0.0]),
                scales: Scales { time: 2.0, value: -0.5, offset: 0.1 },
                buffer_mode,
            },
        ),
        (
            "MC_AccelerationProfile",
            "table = { file = \"a.csv\" }",
            Block::AccelerationProfile { pairs: pairs([0.0, 5.0, 0.0]), scales, buffer_mode },
        ),
        (
            "MC_AccelerationProfile",
            "table = { file = \"a.csv\" }\nacceleration_offset = \"-2 m/s2\"",
            Block::AccelerationProfile {
                pairs: pairs([0.0, 5.0, 0.0]),
                scales: Scales { offset: -2.0, ..scales },
                buffer_mode,
            },
        ),
    ] {
        assert_eq!(call(name, keys), alone(name, block));
    }
}

#[test]
fn every_block_with_inputs_of_its_own() {
    let own = "velocity = \"0.1 m/s\"\nacceleration = \"1 m/s2\"\ndeceleration = \"2 m/s2\"\njerk = \"3 m/s3\"\n\
               snap = \"4 m/s4\"\nbuffer_mode = \"blending-high\"\ncontinuous_update = true\n";
    let dynamics = Dynamics { velocity: 0.1, acceleration: 1.0, deceleration: 2.0, jerk: 3.0, snap: 4.0 };
    let command = Command { buffer_mode: BufferMode::BlendingHigh, continuous_update: true };
    for (name, keys, block) in [
        ("MC_MoveRelative", "distance = \"1 mm\"\n", Block::MoveRelative { distance: 0.001, dynamics, command }),
        (
            "MC_MoveVelocity",
            "direction = \"current\"\n",
            Block::MoveVelocity { velocity: 0.1, direction: Direction::Current, dynamics, command },
        ),
    ] {
        assert_eq!(call(name, &format!("{keys}{own}")).block, block);
    }
    assert_eq!(
        call(
            "MC_TorqueControl",
            "torque = \"1 Nm\"\ntorque_ramp = \"10 Nm/s\"\nvelocity = \"0.1 m/s\"\ndirection = \"negative\"\n\
             buffer_mode = \"blending-high\"\ncontinuous_update = true\n"
        )
        .block,
        Block::TorqueControl { torque: 1.0, torque_ramp: 10.0, velocity: 0.1, direction: Direction::Negative, command }
    );
    assert_eq!(
        call("MC_Halt", "deceleration = \"2 m/s2\"\njerk = \"3 m/s3\"\nsnap = \"4 m/s4\"\nbuffer_mode = \"buffered\"")
            .block,
        Block::Halt { braking: Braking { deceleration: 2.0, jerk: 3.0, snap: 4.0 }, buffer_mode: BufferMode::Buffered }
    );
    assert_eq!(
        call("MC_SetOverride", "velocity_factor = 0\nacceleration_factor = \"50 %\"\njerk_factor = 0.25").block,
        Block::SetOverride { factors: [0.0, 0.5, 0.25] }
    );
    assert_eq!(
        call("MC_SetPosition", "position = \"1 mm\"\nrelative = true").block,
        Block::SetPosition { position: 0.001, relative: true }
    );
    assert_eq!(
        call("MC_Home", "position = \"-1 mm\"\nbuffer_mode = \"buffered\"").block,
        Block::Home { position: -0.001, buffer_mode: BufferMode::Buffered }
    );
    assert_eq!(
        call("MC_MoveSuperimposed", "distance = \"0 mm\"\nvelocity_difference = \"0.1 m/s\"\ncontinuous_update = true")
            .block,
        Block::MoveSuperimposed {
            distance: 0.0,
            dynamics: Dynamics { velocity: 0.1, ..DYNAMICS },
            continuous_update: true
        }
    );
    for (name, mode) in [
        ("aborting", BufferMode::Aborting),
        ("blending-low", BufferMode::BlendingLow),
        ("blending-previous", BufferMode::BlendingPrevious),
        ("blending-next", BufferMode::BlendingNext),
    ] {
        let Block::Halt { buffer_mode, .. } = call("MC_Halt", &format!("buffer_mode = \"{name}\"")).block else {
            panic!("a halt")
        };
        assert_eq!(buffer_mode, mode);
    }
}

/// The order of `[setpoint]` says which of its limits hold.
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
        assert_eq!(plc.calls[0].block, Block::Stop(Braking { jerk, snap, ..BRAKING }), "{order}");
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
    let Block::MoveAbsolute { direction, .. } = plc.calls[0].block else { panic!("{:?}", plc.calls) };
    assert_eq!(direction, Direction::Negative);
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

/// What MC_Power permits changes while it is enabled.
#[test]
fn permissions_change_under_power() {
    let when =
        "{ when = { at = \"1 s\" }, enable_positive = false }, { when = { at = \"1.5 s\" }, enable_negative = true }";
    let call = call("MC_Power", &format!("enable_negative = false\nupdates = [{when}]"));
    assert_eq!(call.block, Block::Power { positive: true, negative: false });
    let blocks: Vec<_> = call.updates.into_iter().map(|update| update.block).collect();
    let denied = |negative| Block::Power { positive: false, negative };
    assert_eq!(blocks, [denied(false), denied(true)]);
}

/// An update says what changes; what it does not say is as the update before left it.
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
    let block = |velocity, acceleration, direction| Block::MoveVelocity {
        velocity,
        direction,
        dynamics: Dynamics { velocity, acceleration, deceleration: acceleration, ..DYNAMICS },
        command: Command { continuous_update: true, ..Command::default() },
    };
    assert_eq!(call.block, block(0.5, 5.0, Direction::Positive));
    let expected = [
        Update { when: Condition::At(0.3), block: block(0.1, 5.0, Direction::Positive) },
        Update { when: Condition::At(0.6), block: block(0.1, 1.0, Direction::Negative) },
    ];
    assert_eq!(call.updates, expected);
}
