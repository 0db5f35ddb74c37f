//! A motor that is mounted the other way round: the run of the axis is the same, that of motor and drive its mirror image.
use crate::rig::{MOVE, SCREW, last, run, screw_with, states, values};
use servobench_trace::Recording;

const ONE: &str = "units = { drive = 1048576, axis = \"10 mm\" }\n";

/// The axis with units of its encoder, and with the motor turned round.
fn both(bus: &str, more: &str) -> [Recording; 2] {
    ["10 mm", "-10 mm"].map(|axis| {
        let units = ONE.replace("10 mm", axis);
        run(&format!(
            "{SCREW}[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\neffort_offset = \"rigid\"\n{bus}{units}{more}"
        ))
    })
}

/// In the coordinate of the axis, and in that of the motor.
const OF_THE_AXIS: [&str; 19] = [
    "task.position",
    "task.velocity",
    "bus.position",
    "link.position",
    "link.velocity",
    "link.acceleration",
    "link.effort",
    "setpoint.position",
    "setpoint.velocity",
    "setpoint.acceleration",
    "motor.position",
    "motor.velocity",
    "load.position",
    "load.velocity",
    "reference.position",
    "reference.motor_position",
    "velocity.reference",
    "following_error.motor",
    "following_error.load",
];
const OF_THE_MOTOR: [&str; 6] =
    ["effort.motor", "effort.reference", "current.q", "current.q_reference", "voltage.q", "voltage.q_reference"];
const OF_NEITHER: [&str; 6] =
    ["current.d", "voltage.d", "voltage.magnitude", "power.electrical", "power.shaft", "saturation.voltage"];

/// Oracle: the other run, bit for bit; a zero is one whatever its sign.
fn assert_mirrored([one, other]: &[Recording; 2], what: &str) {
    let mut compared = 0;
    for (names, sign) in [(&OF_THE_AXIS[..], 1.0), (&OF_THE_MOTOR[..], -1.0), (&OF_NEITHER[..], 1.0)] {
        for name in names {
            let (Some(a), Some(b)) = (one.channel(name), other.channel(name)) else { continue };
            let differs = a.iter().zip(b).position(|(a, b)| (a + 0.0).to_bits() != (sign * b + 0.0).to_bits());
            assert_eq!(differs, None, "{what}: {name} at {:?}", differs.map(|at| (one.time_of(at), a[at], b[at])));
            compared += 1;
        }
    }
    assert!(compared >= 25, "{what}: {compared}");
    let moved = values(one, "effort.motor").iter().any(|effort| effort.abs() > 0.1);
    assert!(moved, "{what}: nothing moved");
    for (source, name) in [("drive", "state"), ("link", "fault"), ("link", "interpolation"), ("drive", "fault")] {
        assert_eq!(states(one, source, name), states(other, source, name), "{what}: {source}.{name}");
    }
}

#[test]
fn moves_of_a_reversed_motor_are_the_mirror_image() {
    for (bus, what) in [
        ("", "csp"),
        ("mode = \"csv\"\nposition_gain = \"60 1/s\"\n", "csv"),
        (
            "motion_cycle = \"20 ms\"\ninterpolation = \"cubic-b-spline\"\ncounter = { bits = 20, signed = false }\n",
            "B-spline",
        ),
        ("delay = 3\nvelocity_from_differences = true\n", "three cycles on its way"),
    ] {
        let runs = both(bus, MOVE);
        assert_mirrored(&runs, what);
        assert!((last(&runs[1], "load.position") - 0.25).abs() < 20e-6, "{what}: {}", last(&runs[1], "load.position"));
    }
}

#[test]
fn what_pushes_a_reversed_axis_pushes_along_the_axis() {
    let push = "[[disturbance]]\non = \"load\"\nstart = \"0.3 s\"\nduration = \"0.1 s\"\nforce = \"900 N\"\n";
    assert_mirrored(&both("", &format!("{push}{MOVE}")), "pushed");
}

/// The ways that the drive makes by itself: positions over a handshake, velocities.
#[test]
fn profiles_of_a_reversed_drive_are_the_mirror_image() {
    for mode in ["pp", "pv"] {
        let runs = ["10 mm", "-10 mm"].map(|axis| {
            let step = if mode == "pp" { MOVE.to_owned() } else { "[[program]]\nreach_velocity = \"10 m/min\"\nhold = \"0.3 s\"\n[[program]]\nreach_velocity = \"0 m/min\"\n".to_owned() };
            run(&format!(
                "{SCREW}[bus]\ncycle = \"1 ms\"\nmode = \"{mode}\"\n{}{step}",
                ONE.replace("10 mm", axis)
            ).replace("order = 4", "order = 2").replace("jerk = \"100 m/s3\"\n", "").replace("snap = \"5000 m/s4\"\n", ""))
        });
        assert_mirrored(&runs, mode);
    }
}

fn with_switches(switches: &str, bus: &str, calls: &str) -> [Recording; 2] {
    ["10 mm", "-10 mm"].map(|axis| {
        let text = screw_with(&format!("switches = {{ {switches} }}"), "2 s");
        let units = ONE.replace("10 mm", axis);
        run(&format!(
            "{text}[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\neffort_offset = \"rigid\"\n{bus}{units}{calls}"
        ))
    })
}

/// The drive has the switch of the other end at each input, and the master knows.
#[test]
fn a_reversed_axis_is_stopped_by_the_switch_of_its_own_end() {
    let calls = r#"
[plc]
homing_required = false
[[call]]
block = "MC_Power"
name = "power"
[[call]]
block = "MC_MoveAbsolute"
name = "into"
start = "power.Status"
position = "150 mm"
[[call]]
block = "MC_Reset"
name = "reset"
start = { after = "into.Error", delay = "0.3 s" }
[[call]]
block = "MC_MoveAbsolute"
name = "back"
start = "reset.Done"
position = "-20 mm"
"#;
    for bus in ["", "reverse_switches = true\n"] {
        let runs = with_switches("negative = \"-100 mm\", positive = \"100 mm\"", bus, calls);
        assert_mirrored(&runs, "switches");
        assert!(states(&runs[1], "link", "fault").contains(&"positive limit switch"));
        assert!((last(&runs[1], "load.position") + 0.02).abs() < 20e-6, "{}", last(&runs[1], "load.position"));
    }
}

/// Onto the limit switch of the negative end of the axis: by method 17 of a drive that counts along the axis, by 18 of one that counts
/// against it.
#[test]
fn homing_is_that_of_the_drive() {
    let homed = |axis: &str, method: u32| {
        let text = screw_with("switches = { negative = \"-20 mm\" }", "2 s");
        let units = ONE.replace("10 mm", axis);
        run(&format!(
            "{text}[drive.objects]\n\"6098h\" = {method}\n\"6099h.1\" = 5000000\n\"6099h.2\" = 500000\n\
             \"609Ah\" = 50000000\n[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\n{units}\
             [[call]]\nblock = \"MC_Power\"\nname = \"power\"\n\
             [[call]]\nblock = \"MC_Home\"\nname = \"home\"\nstart = \"power.Status\"\nposition = \"3 mm\"\n\
             [[call]]\nblock = \"MC_MoveAbsolute\"\nname = \"move\"\nstart = \"home.Done\"\nposition = \"40 mm\"\n"
        ))
    };
    let runs = [homed("10 mm", 17), homed("-10 mm", 18)];
    assert_mirrored(&runs, "homing");
    // 3 mm is the position of the switch now.
    let end = last(&runs[1], "load.position");
    assert!((end - (-20e-3 + 37e-3)).abs() < 50e-6, "{end}");
}
