//! Diagnostics of a fieldbus, of the objects of a drive and of the switches along an axis.
use crate::{AXIS, mistakes, shortened, strings};
use servobench_scenario::{LoadError, parse};

const CYCLE: &str = "[bus]\ncycle = \"1 ms\"\nunits = { drive = 1, axis = \"1 um\" }\n";

/// Mistakes and warnings in the axis with `addition` after it; lines count from that of the addition.
fn said(axis: &str, addition: &str) -> [Vec<String>; 2] {
    let shift = axis.lines().count();
    let (sources, errors, warnings) = match parse("axis.toml", &format!("{axis}{addition}"), None) {
        Ok(loaded) => (loaded.sources, Vec::new(), loaded.warnings),
        Err(LoadError::Invalid(invalid)) => (invalid.sources, invalid.diagnostics, invalid.warnings),
        Err(other) => panic!("{other}"),
    };
    [errors, warnings].map(|all| {
        let relative = all.iter().map(|one| {
            let line = shortened(&one.line(&sources));
            let (number, rest) = line.split_once(':').unwrap();
            match number.parse::<usize>().unwrap().checked_sub(shift) {
                Some(number) if number > 0 => format!("{number}:{rest}"),
                _ => line,
            }
        });
        relative.collect()
    })
}

/// The axis with a drive that leaves the feedforward to the master.
fn bare() -> String {
    AXIS.replace("[drive.feedforward]\nvelocity = true\neffort = \"two-mass\"\n", "")
}

fn check(cases: &[(&str, &[&str])]) {
    for (addition, expected) in cases {
        assert_eq!(said(&bare(), addition), [strings(expected), strings(&[])], "{addition}");
    }
}

/// `CYCLE` with `keys` in `[bus]`.
fn bus(keys: &str) -> String {
    format!("{CYCLE}{keys}")
}

#[test]
fn a_bus_alone_is_right() {
    check(&[
        (CYCLE, &[]),
        (
            &bus("motion_cycle = \"4 ms\"\ninterpolation = \"quintic\"\ndrive_interpolation = \"cubic\"\ndelay = 0\n"),
            &[],
        ),
        (&bus("velocity_offset = true\neffort_offset = \"two-mass\"\nsequencing = \"simplified\"\n"), &[]),
        (&bus("mode = \"csv\"\nposition_gain = \"80 1/s\"\ncounter = { bits = 16, signed = false }\n"), &[]),
        (&bus("drive_timeout = \"1 s\"\nvelocity_from_differences = true\nreverse_switches = true\n"), &[]),
    ]);
}

#[test]
fn cycles_are_whole_numbers_of_each_other() {
    let cycle = |cycle: &str| format!("[bus]\ncycle = \"{cycle}\"\nunits = {{ drive = 1, axis = \"1 um\" }}\n");
    check(&[
        (&cycle("0.3 ms"), &["2:9: `cycle` is 4.8000 base ticks, not a whole number; 312.5 us fits"]),
        (
            &cycle("125 us"),
            &[
                "2:9: the bus is faster than the position loop of the drive, 4000 Hz; give a longer `cycle`, or a higher \
               `rate` in `[drive.position]`",
            ],
        ),
        (&cycle("1e6 s"), &["2:9: `cycle` is 16000000000 base ticks, more than 4294967295; make it shorter"]),
        (
            &bus("motion_cycle = \"2.5 ms\"\n"),
            &["4:16: `motion_cycle` is 2.5000 bus cycles, not a whole number; 3000 us fits"],
        ),
        (
            &bus("interpolation = \"cubic\"\n"),
            &[
                "4:17: `interpolation` is for a motion task that is slower than the bus; give `motion_cycle`, or leave it out",
            ],
        ),
        (
            "[bus]\n",
            &[
                "1:1: missing `cycle` in `bus`",
                "1:1: missing `units` in `bus`; the encoder is ideal and has no increments",
            ],
        ),
    ]);
}

#[test]
fn keys_belong_to_modes() {
    check(&[
        (&bus("mode = \"csv\"\n"), &["1:1: missing `position_gain` in `bus`"]),
        (
            &bus("motion_cycle = \"4 ms\"\nrun_ahead = 2\n"),
            &[
                "5:13: with this interpolation the delay is 1 cycle, and no more can be predicted; write 1, or another `interpolation`",
            ],
        ),
        (
            &bus("mode = \"pp\"\nrun_ahead = 1\n"),
            &["5:13: `run_ahead` is for the modes \"csp\" and \"csv\"; elsewhere nothing is predicted"],
        ),
        (
            &bus("mode = \"csv\"\nposition_gain = \"80 1/s\"\nposition_derivative_filter = \"1 ms\"\n"),
            &[
                "6:30: `position_derivative_filter` is for a derivative; give `position_derivative_time` too, or leave it out",
            ],
        ),
        (
            &bus("position_integral_time = \"0.1 s\"\nposition_derivative_time = \"2 ms\"\n"),
            &[
                "4:26: `position_integral_time` is for the mode \"csv\"; here the drive closes the position loop",
                "5:28: `position_derivative_time` is for the mode \"csv\"; here the drive closes the position loop",
            ],
        ),
        (
            &bus("").replace("axis = \"1 um\"", "axis = \"0 um\""),
            &[
                "3:29: `axis` must not be zero; give the distance of the axis, such as \"5 mm\"; negative for a motor mounted the \
                 other way round",
            ],
        ),
        (
            &bus("position_gain = \"80 1/s\"\n"),
            &["4:17: `position_gain` is for the mode \"csv\"; here the drive closes the position loop"],
        ),
        (
            &bus("mode = \"csv\"\nposition_gain = \"80 1/s\"\ndrive_interpolation = \"cubic\"\n"),
            &["6:23: `drive_interpolation` is for the mode \"csp\""],
        ),
        (
            &bus("mode = \"pp\"\nvelocity_offset = true\neffort_offset = \"rigid\"\n"),
            &[
                "5:19: `velocity_offset` is for the modes \"csp\" and \"csv\"; the drive generates the profile here",
                "6:17: `effort_offset` is for the modes \"csp\" and \"csv\"; the drive generates the profile here",
            ],
        ),
        (
            &bus("trajectory_buffer = \"60C1h\"\n"),
            &[
                "4:21: `trajectory_buffer` is for the mode \"ip\"; only there the drive moves through the points of a buffer",
            ],
        ),
        (
            &bus("point_time = \"10 ms\"\n"),
            &["4:14: `point_time` is for the mode \"ip\"; only there the drive moves through the points of a buffer"],
        ),
        (
            &bus("trajectory_buffer = \"60C2h\"\nmode = \"ip\"\n"),
            &["4:21: \"60C2h\" is not a value of `trajectory_buffer`; did you mean `60C1h`?"],
        ),
        (&bus("mode = \"cst\"\n"), &["4:8: \"cst\" is not a value of `mode`; did you mean `csp`?"]),
        (&bus("delay = 16\n"), &["4:9: `delay` must be a whole number from 0 to 15, got 16"]),
        (&bus("counter = { bits = 65 }\n"), &["4:20: `bits` must be a whole number from 8 to 64, got 65"]),
    ]);
}

/// In the modes with profiles from the drive there is a single way to generate them.
#[test]
fn modes_carry_some_steps_only() {
    let axis = |step: &str| bare().replace("move_to = \"250 mm\"", step);
    let cannot = |mode: &str, does: &str| {
        format!(
            "39:1: a drive in the mode \"{mode}\" does not support this step; it supports {does}; \"csp\" supports every step"
        )
    };
    let (positions, velocities) =
        ("`move_to` and `move_by`", "`reach_velocity`, and tables that are followed by \"plateaus\" or \"steps\"");
    let points = "`move_to` and `move_by` to rest that abort nothing, and tables that are followed by \"segments\"";
    let turning = "reach_velocity = \"1 m/min\"\n[[program]]\nreach_velocity = \"0 m/min\"";
    let itself = "39:1: a drive in the mode \"pp\" plans the profile itself; leave out `method`, samples, shaper, averages and \
                  `duration`, or write \"csp\"";
    for (mode, step, expected) in [
        ("pp", "move_by = \"1 mm\"", vec![]),
        ("pp", turning, vec![cannot("pp", positions), cannot("pp", positions).replace("39:", "41:")]),
        ("pp", "move_to = \"1 mm\"\nmethod = \"optimal\"", vec![itself.into()]),
        ("pp", "move_to = \"1 mm\"\nsample_time = \"1 ms\"", vec![itself.into()]),
        ("pp", "move_to = \"1 mm\"\naverages = [\"1 ms\"]", vec![itself.into()]),
        ("pp", "move_to = \"1 mm\"\nduration = \"1 s\"", vec![itself.into()]),
        ("pv", turning, vec![]),
        ("pv", "move_to = \"1 mm\"", vec![cannot("pv", velocities)]),
        ("ip", "move_to = \"1 mm\"", vec![]),
        ("ip", "move_to = \"1 mm\"\nmethod = \"optimal\"\nduration = \"1 s\"", vec![]),
        ("ip", turning, vec![cannot("ip", points), cannot("ip", points).replace("39:", "41:")]),
        (
            "ip",
            "move_to = \"100 mm\"\nend_velocity = \"1 m/min\"\n[[program]]\nmove_to = \"1 mm\"\naborts_after = \"10 ms\"",
            vec![cannot("ip", points), cannot("ip", points).replace("39:", "42:")],
        ),
        ("ip", "wait = \"1 s\"", vec![]),
        ("csp", turning, vec![]),
    ] {
        let found = mistakes(&format!("{}{}", axis(step), bus(&format!("mode = \"{mode}\"\n"))));
        assert_eq!(found, expected, "{mode} {step}");
    }
}

#[test]
fn a_bus_leads_to_a_drive() {
    let off = bare().replace("dc_link = \"320 V\"", "enabled = false");
    let expected = "1:1: the power stage stays off; leave `enabled` out of `[drive]`: the master powers the drive";
    assert_eq!(said(&off, CYCLE)[0], [expected]);
    let prescribed = "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\n[motor]\nkind = \"prescribed\"\n";
    let expected = "1:1: the motor follows the set-point exactly: the bus has no drive";
    assert_eq!(said(prescribed, CYCLE)[0], [expected]);
    let slow = bare().replace("[setpoint]\n", "[setpoint]\ninterpolation = { mode = \"cubic\", period = \"4 ms\" }\n");
    let expected = "35:17: with a fieldbus the master interpolates; give `motion_cycle` and `interpolation` in `[bus]`";
    assert_eq!(said(&slow, CYCLE)[0], [expected]);
}

#[test]
fn the_master_knows_what_it_feeds_forward() {
    let rigid = bare().replace("stiffness = \"43 N/um\"\ndamping = \"1659 N s/m\"\n", "");
    let expected = "4:17: the axis is rigid: it is a single mass; write \"rigid\", or give `stiffness` and `load_inertia` \
                    in `[drive.estimate]`";
    assert_eq!(said(&rigid, &bus("effort_offset = \"two-mass\"\n"))[0], [expected]);
    let axis = bare();
    let (mechanics, drive) =
        (axis.split_once("[motor]\n").unwrap().0, axis.split_once("[drive.velocity]\n").unwrap().1);
    let source = "[motor]\nkind = \"ideal-source\"\ninertia = \"1.57 kg cm2\"\n";
    let unlimited = format!("{mechanics}{source}[drive.velocity]\n{drive}");
    let expected = "4:17: the torque offset is sent in thousandths of the largest effort, and this drive has no limit; give \
                    `max_torque` in `[drive]`, such as \"12 Nm\"";
    assert_eq!(said(&unlimited, &bus("effort_offset = \"rigid\"\n"))[0], [expected]);
    let twice = [
        "4:19: the drive feeds the velocity forward too: it is added twice; leave `velocity` out of \
         `[drive.feedforward]`, or this out",
        "5:17: the drive feeds the torque or force forward too: it is added twice; leave `effort` out of \
         `[drive.feedforward]`, or this out",
    ];
    assert_eq!(
        said(AXIS, &bus("velocity_offset = true\neffort_offset = \"rigid\"\n")),
        [strings(&[]), strings(&twice)]
    );
}

#[test]
fn faults_are_in_the_run_and_have_what_they_need() {
    let fault = |keys: &str| format!("{CYCLE}[[bus.fault]]\n{keys}");
    check(&[
        (&fault("kind = \"lost\"\nstart = \"1 ms\"\ncycles = 3\n"), &[]),
        (&fault("kind = \"drive-silent\"\nduration = \"20 ms\"\n"), &[]),
        (&fault("kind = \"jitter\"\nby = \"250 us\"\nseed = 0\n"), &[]),
        (&fault("cycles = 1\n"), &["4:1: missing `kind` in `bus.fault`"]),
        (&fault("kind = \"late\"\n"), &["4:1: missing `by` in `bus.fault`; the delay"]),
        (
            &fault("kind = \"late\"\nby = \"100 us\"\n"),
            &["6:6: `by` is 1.6000 base ticks, not a whole number; 125 us fits"],
        ),
        (
            &fault("kind = \"lost\"\nby = \"250 us\"\nseed = 3\n"),
            &["6:6: `by` is for the kinds \"late\", \"jitter\" and \"fast\"", "7:8: `seed` is for \"jitter\""],
        ),
        (&fault("kind = \"task-torn\"\n"), &[]),
        (&fault("kind = \"task-fast\"\nby = \"250 us\"\n"), &[]),
        (
            &fault("kind = \"task-fast\"\n"),
            &["4:1: missing `by` in `bus.fault`; the time by which a cycle is too short"],
        ),
        (
            &fault("kind = \"task-fast\"\nby = \"1 ms\"\n"),
            &["6:6: nothing is left of the cycle of the motion task; make it shorter"],
        ),
        (&fault("kind = \"task-late\"\nby = \"1 ms\"\nseed = 3\n"), &["7:8: `seed` is for \"jitter\""]),
        (
            &fault("kind = \"lost\"\ncycles = 3\nduration = \"2 ms\"\n"),
            &["7:12: `cycles` and `duration` give the same quantity; give one of them"],
        ),
        (
            &fault("kind = \"lost\"\nstart = \"100 us\"\nduration = \"200 us\"\n"),
            &["7:12: no cycle begins between its start and its end, they are 0.001 s apart"],
        ),
    ]);
    let short = bare().replace("base_rate = \"16 kHz\"\n", "base_rate = \"16 kHz\"\nduration = \"2 s\"\n");
    let late = said(&short, &fault("kind = \"lost\"\nstart = \"2 s\"\n"));
    assert_eq!(late[0], ["6:9: the run is over by then: it lasts 2 s"]);
}

#[test]
fn objects_are_named_by_index_and_sub_index() {
    let objects = |entries: &str| format!("{CYCLE}[drive.objects]\n{entries}\n");
    check(&[
        (&objects("\"6065h\" = 10000\n\"607Dh.2\" = -5\n607Eh.01h = 0x10\n6099h = { 1 = 5, 0Ah = 6 }"), &[]),
        (
            &objects("\"6065\" = 1\n0x6065 = 1"),
            &[
                "5:1: `6065` is not the index of an object; write \"6065h\" = 10000, or \"607Dh.2\" with a sub-index",
                "6:1: `0x6065` is not the index of an object; write \"6065h\" = 10000, or \"607Dh.2\" with a sub-index",
            ],
        ),
        (
            &objects("\"607Dh.10\" = 1\n\"607Dh.100h\" = 1"),
            &[
                "5:1: `607Dh.10` is not the sub-index of an object; write \"6065h\" = 10000, or \"607Dh.2\" with a sub-index",
                "6:1: `607Dh.100h` is not the sub-index of an object; write \"6065h\" = 10000, or \"607Dh.2\" with a sub-index",
            ],
        ),
        (
            &objects("\"6065h\" = 1.5\n\"6066h\" = \"1 s\""),
            &[
                "5:11: an object takes a whole number, got 1.5; values are in the units of the drive",
                "6:11: an object takes a whole number, got \"1 s\"; values are in the units of the drive",
            ],
        ),
        (
            &objects("\"6065h\" = 1\n\"6065h.0\" = 2"),
            &["6:1: 6065h:00h is written twice; the master writes each object once"],
        ),
        ("[drive.objects]\n\"6065h\" = 1\n", &["1:1: `objects` is for a drive on a fieldbus; give `[bus]`"]),
    ]);
    let path = format!("{}{}", bare(), objects("\"6065h\" = 1\n607Dh.2 = 7\n\"6099h.1\" = 5"));
    let loaded = parse("axis.toml", &path, None).unwrap();
    for (key, value) in [("drive.objects.6065h", "1"), ("drive.objects.607Dh.2", "7"), ("drive.objects.6099h.1", "5")] {
        let found = loaded.mistake(key, "wrong".into(), String::new());
        assert_eq!(&path[found.span], value, "{key}");
    }
}

#[test]
fn switches_are_along_the_axis() {
    let switches = |keys: &str| format!("{CYCLE}[axis.switches]\n{keys}\n");
    check(&[
        (
            &switches(
                "negative = \"-20 mm\"\npositive = \"520 mm\"\nhome = { from = \"0 mm\", to = \"9 mm\" }\nindex = \"90 deg\"",
            ),
            &[],
        ),
        (
            &switches("negative = \"20 mm\"\npositive = \"20 mm\""),
            &["6:12: the positive end is not above the negative one; swap them"],
        ),
        (
            &switches("home = { from = \"9 mm\", to = \"8 mm\" }"),
            &["5:30: the home switch ends at or below where it begins; swap `from` and `to`"],
        ),
        (&switches("home = { from = \"9 mm\" }"), &["5:8: missing `to` in `axis.switches.home`"]),
        ("[axis.switches]\nnegative = \"-20 mm\"\n", &["1:1: `switches` is for a drive on a fieldbus; give `[bus]`"]),
    ]);
    let linear = bare()
        .replace("lead = \"10 mm\"\n", "")
        .replace("pole_pairs = 4", "pole_pitch = \"23 mm\"")
        .replace("inertia = \"1.57 kg cm2\"", "mass = \"20 kg\"");
    let expected = "5:9: a linear motor has no index pulse; a home switch is where homing can end";
    assert_eq!(said(&linear, &switches("index = \"0 deg\""))[0], [expected]);
}
