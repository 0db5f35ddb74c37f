//! Diagnostics of calls of function blocks.
mod tables;

use crate::{AXIS, strings};
use servobench_scenario::{LoadError, parse};

const BUS: &str = "[bus]\ncycle = \"1 ms\"\nunits = { drive = 1, axis = \"1 um\" }\n[plc]\nhoming_required = false\n";
const POWER: &str = "[[call]]\nblock = \"MC_Power\"\nname = \"power\"\n";

/// Mistakes and warnings in the axis on a bus with `calls` as its program; lines count from that of the calls.
pub(crate) fn said(calls: &str) -> [Vec<String>; 2] {
    said_of(&lasting(), &format!("{BUS}{POWER}"), calls)
}

/// The axis, with a run of two seconds.
fn lasting() -> String {
    AXIS.replace("base_rate = \"16 kHz\"\n", "base_rate = \"16 kHz\"\nduration = \"2 s\"\n")
}

/// The file of [`said`].
pub(crate) fn text(calls: &str) -> String {
    lasting().replace("[[program]]\nmove_to = \"250 mm\"\n", &format!("{BUS}{POWER}{calls}"))
}

/// The same for `axis`, with `before` before the calls.
fn said_of(axis: &str, before: &str, calls: &str) -> [Vec<String>; 2] {
    let (head, tail) = axis.split_once("[[program]]\nmove_to = \"250 mm\"\n").unwrap();
    let head = format!("{head}{before}");
    let shift = head.matches('\n').count();
    let folder = tempfile::tempdir().unwrap();
    for (name, heading) in [("x.csv", "position [mm]"), ("v.csv", "velocity [mm/s]"), ("a.csv", "acceleration [mm/s2]")]
    {
        std::fs::write(folder.path().join(name), format!("time [ms],{heading}\n0,0\n10,5\n20,0\n")).unwrap();
    }
    let pvt = "time [ms],position [mm],velocity [mm/s]\n0,0,0\n10,5,0\n";
    std::fs::write(folder.path().join("pvt.csv"), pvt).unwrap();
    std::fs::write(folder.path().join("early.csv"), "time [ms],velocity [mm/s]\n-10,0\n10,5\n").unwrap();
    let parsed = parse("test.toml", &format!("{head}{calls}{tail}"), Some(folder.path()));
    let (sources, errors, warnings) = match parsed {
        Ok(loaded) => (loaded.sources, Vec::new(), loaded.warnings),
        Err(LoadError::Invalid(invalid)) => (invalid.sources, invalid.diagnostics, invalid.warnings),
        Err(other) => panic!("{other}"),
    };
    let folder = folder.path().display().to_string();
    [errors, warnings].map(|all| {
        let lines = all.iter().map(|one| {
            let (line, column) = sources.line_and_column(one.source, one.span.start);
            let help = one.help.as_ref().map_or_else(String::new, |help| format!("; {help}"));
            format!("{}:{column}: {}{help}", line.cast_signed() - shift.cast_signed(), one.message)
        });
        lines.map(|line| line.replace(&folder, "HERE")).collect()
    })
}

fn check(cases: &[(&str, &[&str])]) {
    for (calls, expected) in cases {
        assert_eq!(said(calls), [strings(expected), strings(&[])], "{calls}");
    }
}

/// A call of `block` with `keys`.
fn call(block: &str, keys: &str) -> String {
    format!("[[call]]\nblock = \"{block}\"\n{keys}\n")
}

#[test]
fn every_block_can_be_called() {
    for (block, keys) in [
        ("MC_Power", ""),
        ("MC_Home", "position = \"1 mm\""),
        ("MC_Stop", "deceleration = \"5 m/s2\"\njerk = \"20 m/s3\""),
        ("MC_Halt", "buffer_mode = \"buffered\""),
        ("MC_Reset", ""),
        ("MC_MoveAbsolute", "position = \"1 mm\"\nvelocity = \"1 m/min\"\ndeceleration = \"1 m/s2\""),
        ("MC_MoveRelative", "distance = \"-1 mm\"\nbuffer_mode = \"blending-low\""),
        ("MC_MoveAdditive", "distance = \"1 mm\"\ncontinuous_update = true"),
        ("MC_MoveSuperimposed", "distance = \"1 mm\"\nvelocity_difference = \"1 m/min\""),
        ("MC_MoveVelocity", "velocity = \"-1 m/min\"\ndirection = \"current\""),
        ("MC_MoveContinuousAbsolute", "position = \"1 mm\"\nend_velocity = \"-1 m/min\""),
        ("MC_PositionProfile", "table = { file = \"x.csv\", relative = true }\nend_velocity = \"1 mm/s\""),
        (
            "MC_VelocityProfile",
            "table = { file = \"v.csv\" }\ntime_scale = 2\nvalue_scale = \"-50 %\"\nvelocity_offset = \"1 m/min\"",
        ),
        ("MC_AccelerationProfile", "table = { file = \"a.csv\" }\nbuffer_mode = \"buffered\""),
        ("MC_SetPosition", "position = \"1 mm\"\nrelative = true"),
        ("MC_SetOverride", "velocity_factor = \"50 %\"\nacceleration_factor = 0.5\njerk_factor = 1"),
        ("MC_TorqueControl", "torque = \"-1 Nm\"\ntorque_ramp = \"5 Nm/s\"\ndirection = \"negative\""),
        ("MC_ReadStatus", ""),
        ("MC_ReadAxisError", ""),
        ("MC_ReadActualPosition", ""),
        ("MC_ReadActualVelocity", ""),
        ("MC_ReadActualTorque", ""),
        (
            "MC_DigitalCamSwitch",
            "switches = [{ track = 0, first = \"1 mm\", last = \"2 mm\" }, { track = 0, first = \"3 mm\", duration = \"1 ms\", \
             direction = \"negative\" }]\ntrack_options = [{ track = 0, on_compensation = \"-1 ms\", hysteresis = \"10 um\" }]\n\
             enable_mask = 0x80000001\nvalue_source = \"actual\"",
        ),
        ("MAM", "position = \"1 mm\"\nshape = \"s-curve\"\njerk_time = \"2 ms\"\ndeceleration_jerk_of_time = \"25 %\""),
        ("Profile4th", "position = \"1 mm\"\nsnap = \"1e4 m/s4\"\nsettling_time = \"50 ms\"\nreversed = true"),
    ] {
        let started = format!("start = \"power.Status\"\nstop = {{ at = \"1 s\" }}\ntimeout = \"1 s\"\n{keys}");
        check(&[(&call(block, keys), &[]), (&call(block, &started), &[])]);
    }
}

#[test]
fn a_block_has_its_inputs_and_no_others() {
    check(&[
        (
            &call("MC_MoveAbsolut", "position = \"1 mm\""),
            &["2:9: unknown function block \"MC_MoveAbsolut\"; did you mean `MC_MoveAbsolute`?"],
        ),
        ("[[call]]\nname = \"a\"\n", &["1:1: missing `block` in `call`"]),
        (
            &call("MC_Halt", "position = \"1 mm\"\nvelocity = \"1 m/min\""),
            &[
                "3:12: MC_Halt has no input `position`; its inputs are deceleration, jerk, snap, buffer_mode",
                "4:12: MC_Halt has no input `velocity`; its inputs are deceleration, jerk, snap, buffer_mode",
            ],
        ),
        // Optional inputs of the standard, which a drive with effort commands does not have.
        (
            &call("MC_TorqueControl", "torque = \"1 Nm\"\nacceleration = \"1 m/s2\"\njerk = \"1 m/s3\""),
            &[
                "4:16: MC_TorqueControl has no input `acceleration`; its inputs are torque, torque_ramp, velocity, direction, \
                 buffer_mode, continuous_update",
                "5:8: MC_TorqueControl has no input `jerk`; its inputs are torque, torque_ramp, velocity, direction, \
                 buffer_mode, continuous_update",
            ],
        ),
        (&call("MC_Reset", "jerk = \"1 m/s3\""), &["3:8: MC_Reset has no input `jerk`; it has none"]),
        (
            &call("MC_Stop", "buffer_mode = \"buffered\"\nrelative = true"),
            &[
                "3:15: MC_Stop has no input `buffer_mode`; its inputs are deceleration, jerk, snap",
                "4:12: MC_Stop has no input `relative`; its inputs are deceleration, jerk, snap",
            ],
        ),
        (&call("MC_MoveAbsolute", ""), &["1:1: missing `position` in `call`; MC_MoveAbsolute needs it"]),
        (&call("MC_MoveRelative", ""), &["1:1: missing `distance` in `call`; MC_MoveRelative needs it"]),
        (
            &call("MC_MoveSuperimposed", ""),
            &[
                "1:1: missing `distance` in `call`; MC_MoveSuperimposed needs it",
                "1:1: missing `velocity_difference` in `call`; MC_MoveSuperimposed needs it",
            ],
        ),
        (
            &call("MC_MoveContinuousAbsolute", ""),
            &[
                "1:1: missing `position` in `call`; MC_MoveContinuousAbsolute needs it",
                "1:1: missing `end_velocity` in `call`; MC_MoveContinuousAbsolute needs it",
            ],
        ),
        (&call("MC_TorqueControl", ""), &["1:1: missing `torque` in `call`; MC_TorqueControl needs it"]),
        (&call("MC_SetPosition", ""), &["1:1: missing `position` in `call`; MC_SetPosition needs it"]),
        (&call("MC_PositionProfile", ""), &["1:1: missing `table` in `call`; MC_PositionProfile needs it"]),
        (
            &call("Profile4th", ""),
            &[
                "1:1: missing `position` in `call`; Profile4th needs it",
                "1:1: missing `snap` in `setpoint`; Profile4th needs it, here or in the call",
                "1:1: missing `settling_time` in `call`; from the end of a profile until the block is ready for the next",
            ],
        ),
        // An order that does not use the snap does not need it; `[setpoint]` here is of order 3.
        (&call("Profile4th", "position = \"1 mm\"\nsettling_time = \"50 ms\"\norder = 3"), &[]),
        (
            &call("Profile4th", "position = \"1 mm\"\nsettling_time = \"50 ms\"\nsnap = \"1e4 m/s4\"\norder = 2.5"),
            &["6:9: `order` must be a whole number from 2 to 4, got 2.5"],
        ),
        (
            &call("MC_MoveAbsolute", "position = \"1 mm\"\nvelocity = \"0 m/s\""),
            &["4:12: `velocity` of MC_MoveAbsolute must be above zero; the target gives the direction"],
        ),
        (
            &call("MC_MoveContinuousAbsolute", "position = \"1 mm\"\nend_velocity = \"40 m/min\""),
            &["4:16: beyond the velocity limit, 0.5 in SI; lower it or raise `velocity`"],
        ),
        (
            &call("MC_TorqueControl", "torque = \"1 N\""),
            &["3:10: `torque` must be a torque, but \"1 N\" is a force (N)"],
        ),
    ]);
}

#[test]
fn directions_belong_to_blocks() {
    check(&[
        (
            &call("MC_MoveVelocity", "direction = \"shortest\""),
            &["3:13: MC_MoveVelocity does not have this direction; write \"positive\", \"negative\" or \"current\""],
        ),
        (
            &call("MC_TorqueControl", "torque = \"1 Nm\"\ndirection = \"shortest\""),
            &["4:13: MC_TorqueControl does not have this direction; write \"positive\", \"negative\" or \"current\""],
        ),
    ]);
    let ignored = "4:13: `direction` is ignored: on an axis with ends only one direction leads to a position; give the period `modulo` in \
                   `[axis]`, or leave it out";
    let positive = call("MC_MoveAbsolute", "position = \"1 mm\"\ndirection = \"positive\"");
    assert_eq!(said(&positive), [strings(&[]), strings(&[ignored])]);
}

/// `[setpoint]` holds the limits of the axis: a block refuses higher ones, which a run may want to show.
#[test]
fn limits_of_the_axis_bound_those_of_blocks() {
    let beyond = call("MC_MoveAbsolute", "position = \"1 mm\"\nvelocity = \"31 m/min\"\ndeceleration = \"7 m/s2\"");
    let expected = [
        "4:12: beyond the `velocity` of `[setpoint]`, 0.5 in SI: the block will refuse it; lower it or raise that",
        "5:16: beyond the `acceleration` of `[setpoint]`, 6 in SI: the block will refuse it; lower it or raise that",
    ];
    assert_eq!(said(&beyond), [strings(&[]), strings(&expected)]);
    let axis = AXIS.replace("base_rate = \"16 kHz\"\n", "base_rate = \"16 kHz\"\nduration = \"2 s\"\n");
    let limits = "order = 3\nvelocity = \"30 m/min\"\nacceleration = \"6 m/s2\"\njerk = \"200 m/s3\"\n";
    let stop = format!("{}{}", call("MC_Stop", ""), call("MC_Halt", ""));
    let found = said_of(&axis.replace(limits, ""), &format!("{BUS}{POWER}"), &stop);
    let expected = [
        "1:1: missing `deceleration` in `call`; or `acceleration` in `[setpoint]`",
        "4:1: missing `deceleration` in `call`; or `acceleration` in `[setpoint]`",
    ];
    assert_eq!(found, [strings(&expected), strings(&[])]);
    let snap = "velocity = \"30 m/min\"\nacceleration = \"6 m/s2\"\nsnap = \"1e4 m/s4\"\n";
    let found = said_of(&axis.replace(limits, snap), &format!("{BUS}{POWER}"), &stop);
    assert_eq!(found[0], ["-8:8: a limit of snap needs one of jerk; give `jerk` too"]);
}

#[test]
fn names_are_unique_identifiers() {
    check(&[
        (
            &call("MC_Reset", "name = \"POWER\""),
            &["3:8: there is a call `POWER` already; each needs a different `name`"],
        ),
        (
            &format!("{}{}", call("MC_Reset", "name = \"MC_Reset_1\""), call("MC_Reset", "")),
            &["4:1: there is a call `MC_Reset_1` already; each needs a different `name`"],
        ),
        (
            &call("MC_Reset", "name = \"a.b\""),
            &["3:8: \"a.b\" is not the name of an instance; write letters, digits and `_`, a letter first"],
        ),
        (
            &call("MC_Reset", "name = \"1st\""),
            &["3:8: \"1st\" is not the name of an instance; write letters, digits and `_`, a letter first"],
        ),
        (
            &call("MC_Reset", "name = \"\""),
            &["3:8: \"\" is not the name of an instance; write letters, digits and `_`, a letter first"],
        ),
        (&format!("{}{}", call("MC_Reset", ""), call("MC_Halt", "start = \"MC_Reset_0.Done\"")), &[]),
    ]);
}

#[test]
fn conditions_name_outputs_times_and_positions() {
    let move_when = |condition: &str| call("MC_MoveVelocity", &format!("name = \"turn\"\nstart = {condition}"));
    check(&[
        (&move_when("{ at = \"0.2 s\" }"), &[]),
        (&move_when("{ after = \"power.Status\", delay = \"50 ms\" }"), &[]),
        (&move_when("{ above = \"50 mm\" }"), &[]),
        (&move_when("{ below = \"-50 mm\" }"), &[]),
        (&move_when("\"powr.Status\""), &["4:9: unknown call `powr`; did you mean `power`?"]),
        (&move_when("\"power.Done\""), &["4:9: MC_Power has no output `Done`; its outputs are Status, Valid, Error"]),
        (
            &move_when("\"power\""),
            &["4:9: `power` is a call: name one of its outputs; its outputs are Status, Valid, Error"],
        ),
        (
            &format!("{}{}", move_when("\"power.Status\""), call("MC_Halt", "start = \"turn.Done\"")),
            &[
                "7:9: MC_MoveVelocity has no output `Done`; its outputs are InVelocity, Busy, Active, CommandAborted, Error",
            ],
        ),
        // Nothing aborts it here, which only the run can show.
        (&format!("{}{}", move_when("\"power.Status\""), call("MC_Halt", "start = \"turn.CommandAborted\"")), &[]),
        (&move_when("{ at = \"2 s\" }"), &["4:16: the run is over by then: it lasts 2 s"]),
        (&move_when("{ after = \"power.Status\", delay = \"3 s\" }"), &["4:43: the run is over by then: it lasts 2 s"]),
        (&move_when("{}"), &["4:9: this condition is empty; give `at`, `after`, `above` or `below`"]),
        (
            &move_when("{ above = \"1 mm\", below = \"2 mm\" }"),
            &["4:35: `above` and `below` in one condition; give one of them"],
        ),
        (&move_when("{ at = \"1 s\", delay = \"1 s\" }"), &["4:31: `delay` is for `after`"]),
        (
            &move_when("0.2"),
            &["4:9: `start` must be an output or a table, got 0.2; write \"first.Done\" or { at = \"0.2 s\" }"],
        ),
        (
            &move_when("{ at = \"1 s\" }\nstop = { at = \"1 s\" }"),
            &["5:8: it stops at 1 s and starts at 1 s: it is never TRUE"],
        ),
        (
            &move_when("{ at = \"1 s\" }\ntimeout = \"1.5 s\""),
            &["5:11: `timeout` is for a `start` that may not come; leave it out"],
        ),
        (&call("MC_Halt", "timeout = \"1 s\""), &["3:11: `timeout` is for a `start` that may not come; leave it out"]),
        (&move_when("\"power.Status\"\ntimeout = \"2 s\""), &["5:11: the run is over by then: it lasts 2 s"]),
    ]);
}

#[test]
fn calls_that_wait_for_each_other_never_start() {
    let halt = |name: &str, after: &str| call("MC_Halt", &format!("name = \"{name}\"\nstart = \"{after}.Done\""));
    check(&[
        (&halt("a", "a"), &["4:9: `a` waits for itself; let one of them start by itself"]),
        (
            &format!("{}{}{}", halt("a", "b"), halt("b", "c"), halt("c", "a")),
            &[
                "4:9: `a` waits for `b` waits for `c` waits for `a`: none of them ever starts; let one of them start by itself",
            ],
        ),
        // A call after a circle is not to blame.
        (
            &format!("{}{}{}", halt("a", "b"), halt("b", "c"), halt("c", "b")),
            &["8:9: `b` waits for `c` waits for `b`: none of them ever starts; let one of them start by itself"],
        ),
        (&format!("{}{}", halt("a", "b"), call("MC_Halt", "name = \"b\"\nstop = \"a.Done\"")), &[]),
        (&call("MC_Halt", "name = \"a\"\nstop = \"a.Done\""), &[]),
    ]);
}

#[test]
fn updates_count_with_continuous_update() {
    let moved = |keys: &str| call("MC_MoveAbsolute", &format!("position = \"1 mm\"\n{keys}"));
    check(&[
        (&moved("continuous_update = true\nupdates = [{ when = { at = \"1 s\" }, velocity = \"1 m/s\", position = \"2 mm\" }]")
            .replace("1 m/s", "1 m/min"), &[]),
        (
            &moved("updates = [{ when = { at = \"1 s\" }, velocity = \"1 m/min\" }]"),
            &["4:11: MC_MoveAbsolute keeps the inputs that it was started with; write `continuous_update = true`"],
        ),
        (
            &call("MC_Halt", "updates = [{ when = { at = \"1 s\" }, jerk = \"1 m/s3\" }]"),
            &["3:11: MC_Halt keeps the inputs that it was started with"],
        ),
        (
            &call("MC_SetOverride", "updates = [{ when = { at = \"1 s\" }, velocity_factor = 0 }]"),
            &[],
        ),
        (
            &moved("continuous_update = true\nupdates = [{ when = { at = \"1 s\" } }, { torque = \"1 Nm\" }]"),
            &[
                "5:12: this update changes nothing",
                "5:39: missing `when` in `call.updates`",
                "5:50: MC_MoveAbsolute has no input `torque`; its inputs are position, velocity, acceleration, deceleration, \
                 jerk, snap, direction, buffer_mode, continuous_update",
            ],
        ),
        (
            &moved("continuous_update = true\nupdates = [{ when = { at = \"1 s\" }, velocity = \"-1 m/min\" }]"),
            &["5:48: `velocity` of MC_MoveAbsolute must be above zero; the target gives the direction"],
        ),
    ]);
}

#[test]
fn calls_need_a_bus_and_a_duration_and_no_program() {
    let halt = call("MC_Halt", "");
    let [errors, _] = said_of(AXIS, POWER, &halt);
    assert_eq!(
        errors,
        [
            "-41:1: missing `duration` in `run`; the duration of calls is not known beforehand",
            "-2:1: missing table `[bus]`; function blocks command a drive on a fieldbus: give its `cycle`",
        ]
    );
    check(&[(
        &format!("{halt}[[program]]\nmove_to = \"1 mm\"\n"),
        &["-2:1: `[[program]]` and `[[call]]` exclude each other; write the moves as calls, or leave the calls out"],
    )]);
    let axis = AXIS.replace("base_rate = \"16 kHz\"\n", "base_rate = \"16 kHz\"\nduration = \"2 s\"\n");
    let axis = axis.replace("[setpoint]\n", "[setpoint]\nmethod = \"optimal\"\naverages = [\"1 ms\"]\n");
    let [errors, _] = said_of(&axis, &format!("{BUS}{POWER}"), &halt);
    assert_eq!(
        errors,
        [
            "-13:10: `method` is not used by function blocks; they plan from any state of motion",
            "-12:12: `averages` is not used by function blocks; they plan from any state of motion",
        ]
    );
    let profile = BUS.replace("cycle", "mode = \"pp\"\ncycle");
    let [errors, _] = said_of(
        &axis.replace("method = \"optimal\"\naverages = [\"1 ms\"]\n", ""),
        &format!("{profile}{POWER}"),
        &halt,
    );
    assert_eq!(errors, ["-7:8: function blocks generate the set-points themselves; write \"csp\", \"csv\" or \"pv\""]);
    let [errors, _] =
        said_of(AXIS, "", "[plc]\nhoming_required = true\n[axis.switches]\n[[program]]\nmove_to = \"1 mm\"\n");
    assert!(
        errors.contains(&"1:1: `plc` is for function blocks; give a `[[call]]`, or leave it out".to_owned()),
        "{errors:?}"
    );
    let modulo = AXIS.replace("lead = \"10 mm\"\n", "lead = \"10 mm\"\nmodulo = \"100 mm\"\n");
    assert_eq!(crate::mistakes(&modulo), ["8:10: `modulo` is for function blocks; give a `[[call]]`, or leave it out"]);
}

#[test]
fn velocities_of_positions_are_not_used() {
    let warning = "3:18: MC_PositionProfile chooses the velocities itself: the column `velocity` is not used; `end_velocity` is that \
                   at the last position";
    let calls = call("MC_PositionProfile", "table = { file = \"pvt.csv\" }");
    assert_eq!(said(&calls), [strings(&[]), strings(&[warning])]);
}

/// Steps along the spline, and the start of their ramps, are for a drive that receives velocities.
#[test]
fn velocities_are_told_to_a_drive_in_profile_velocity() {
    let steps =
        |keys: &str| call("MC_PositionProfile", &format!("table = {{ file = \"x.csv\", follow = \"steps\"{keys} }}"));
    let pv = BUS.replace("cycle", "mode = \"pv\"\ncycle").replace("[plc]\n", "[plc]\nramp_start = \"actual\"\n");
    let said_in_pv = |calls: &str| said_of(&lasting(), &format!("{pv}{POWER}"), calls);
    for keys in ["", ", command_rate = \"100 Hz\"", ", relative = true"] {
        assert_eq!(said_in_pv(&steps(keys)), [strings(&[]), strings(&[])], "{keys}");
    }
    assert_eq!(
        said_in_pv(&steps(", plateau_share = \"auto\", velocities = \"average\""))[0],
        [
            "3:61: `plateau_share` is for \"plateaus\"",
            "3:82: MC_PositionProfile does not choose its velocities by this rule; it follows the cubic spline, by \"plateaus\", or by \
             \"steps\" along the spline",
        ]
    );
    let bus = BUS.replace("[plc]\n", "[plc]\nramp_start = \"actual\"\n");
    let [errors, _] = said_of(&lasting(), &format!("{bus}{POWER}"), &call("MC_Halt", ""));
    assert_eq!(errors, ["-4:14: `ramp_start` is for the mode \"pv\"; elsewhere the drive receives positions"]);
    let rate = "table = { file = \"x.csv\", command_rate = \"100 Hz\" }";
    assert!(
        said(&call("MC_PositionProfile", rate))[0][0].contains("`command_rate` is for a table that is followed by")
    );
}

/// A limit in a call without effect.
#[test]
fn limits_beyond_the_order_are_told() {
    let profile = |keys: &str| call("Profile4th", &format!("position = \"1 mm\"\nsettling_time = \"50 ms\"\n{keys}"));
    let [errors, warnings] = said(&profile("order = 3\nsnap = \"1000 m/s4\"\njerk = \"50 m/s3\""));
    let told = "6:8: `snap` is not used by a profile of order 3; leave it out, or give a higher `order`";
    assert_eq!([errors, warnings], [strings(&[]), strings(&[told])]);
    assert_eq!(said(&profile("order = 4\nsnap = \"1000 m/s4\"\njerk = \"50 m/s3\"")), [strings(&[]), strings(&[])]);
}

/// Each jerk of Rockwell's move is given in a single way, and that of a trapezoid by the axis.
#[test]
fn the_jerks_of_rockwells_move() {
    let s_curve = |keys: &str| call("MAM", &format!("position = \"1 mm\"\nshape = \"s-curve\"\n{keys}"));
    check(&[
        (&s_curve(""), &[]),
        (
            &s_curve(
                "jerk_time = \"1 ms\"\njerk_of_time = 1\ndeceleration_jerk = \"1 m/s3\"\ndeceleration_jerk_time = \"1 ms\"",
            ),
            &[
                "5:13: `jerk_of_time` and `jerk_time` give the same quantity; give one of them",
                "8:26: `deceleration_jerk` and `deceleration_jerk_time` give the same quantity; give one of them",
            ],
        ),
        (
            &call("MAM", "position = \"1 mm\"\njerk_of_time = 1\n"),
            &[
                "4:16: `jerk_of_time` is for an S-curve; write `shape = \"s-curve\"`, or leave it out: a trapezoid takes the `jerk` \
               of `[setpoint]`",
            ],
        ),
        (
            &call("MAM", "position = \"1 mm\"\nmove_type = \"relative\""),
            &["4:13: \"relative\" is not a value of `move_type`; known here: `absolute`, `incremental`"],
        ),
    ]);
}

/// Calls that will be refused at execution cause warnings, not mistakes: a run may want to show that.
#[test]
fn what_will_be_refused_is_doubtful() {
    let axis = AXIS.replace("base_rate = \"16 kHz\"\n", "base_rate = \"16 kHz\"\nduration = \"2 s\"\n");
    let bus = BUS.replace("[plc]\nhoming_required = false\n", "");
    let to = call("MC_MoveAbsolute", "position = \"1 mm\"");
    let unhomed = "1:1: the axis is never homed: this move will be refused; call \"MC_Home\" before, or write \
                   `homing_required = false` in `[plc]`";
    assert_eq!(said_of(&axis, &format!("{bus}{POWER}"), &to), [strings(&[]), strings(&[unhomed])]);
    let homed = format!("{to}{}", call("MC_Home", ""));
    assert_eq!(said_of(&axis, &format!("{bus}{POWER}"), &homed), [strings(&[]), strings(&[])]);
    let blended = call("MC_Home", "buffer_mode = \"blending-low\"");
    let refused = "3:15: homing begins at Standstill and blends with nothing: the block will refuse it; write \"buffered\", or \
                   leave it out";
    assert_eq!(said_of(&axis, &format!("{bus}{POWER}"), &blended), [strings(&[]), strings(&[refused])]);
    let unpowered = "1:1: nothing powers the axis; call \"MC_Power\", and let the others wait for its `Status`";
    assert_eq!(said_of(&axis, BUS, &to), [strings(&[]), strings(&[unpowered])]);
}
