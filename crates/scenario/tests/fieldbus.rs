//! The resolved `[bus]`, `[drive.objects]` and `[axis.switches]`.
use servobench_cia402::counter::Counter;
use servobench_drive::EffortFeedforward;
use servobench_fieldbus::bus::{BusFault, BusFaultKind};
use servobench_fieldbus::link::{PositionGains, Sequencing};
use servobench_fieldbus::task::{TaskFault, TaskFaultKind};
use servobench_fieldbus::trajectory::PointTransfer;
use servobench_motion::interpolate::Mode;
use servobench_plant::Switches;
use servobench_scenario::*;
use std::f64::consts::TAU;

const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
[bus]
cycle = "1 ms"
"#;

fn scenario(text: &str) -> Scenario {
    parse("test.toml", text, None).unwrap_or_else(|e| panic!("{e}")).scenario
}

/// The axis with `addition` in or after `[bus]`.
fn bus(addition: &str) -> Bus {
    scenario(&format!("{AXIS}{addition}")).bus.unwrap()
}

#[test]
fn a_bus_that_says_its_cycle_alone() {
    let expected = Bus {
        cycle: 16,
        mode: BusMode::CyclicPosition,
        motion_every: 1,
        interpolation: Mode::Cubic,
        drive_interpolation: Mode::Linear,
        point_transfer: PointTransfer::MoveSegment,
        point_time: 0.01,
        delay: 1,
        velocity_offset: false,
        effort_offset: EffortFeedforward::Off,
        margin: 0,
        sequencing: Sequencing::Strict,
        drive_timeout: 0.5,
        run_ahead: 0,
        position_loop: None,
        counter: Counter::signed(32).unwrap(),
        units: DriveUnits { drive: 1 << 20, axis: 0.01 },
        velocity_from_differences: false,
        reverse_switches: false,
        faults: vec![],
        task_faults: vec![],
        objects: vec![],
    };
    assert_eq!(bus(""), expected);
}

#[test]
fn every_key_of_a_bus() {
    let keys = r#"
mode = "csv"
motion_cycle = "4 ms"
interpolation = "quintic"
delay = 0
velocity_offset = true
effort_offset = "rigid"
margin = "1.5 ms"
sequencing = "simplified"
drive_timeout = "20 ms"
position_gain = "80 1/s"
counter = { bits = 16, signed = false }
units = { drive = 1000, axis = "5 mm" }
velocity_from_differences = true
reverse_switches = true
"#;
    let expected = Bus {
        cycle: 16,
        mode: BusMode::CyclicVelocity,
        motion_every: 4,
        interpolation: Mode::Quintic,
        drive_interpolation: Mode::Linear,
        point_transfer: PointTransfer::MoveSegment,
        point_time: 0.01,
        delay: 0,
        velocity_offset: true,
        effort_offset: EffortFeedforward::Rigid,
        margin: 24,
        sequencing: Sequencing::Simplified,
        drive_timeout: 0.02,
        run_ahead: 0,
        position_loop: Some(PositionGains::proportional(80.0)),
        counter: Counter::unsigned(16).unwrap(),
        units: DriveUnits { drive: 1000, axis: 0.005 },
        velocity_from_differences: true,
        reverse_switches: true,
        faults: vec![],
        task_faults: vec![],
        objects: vec![],
    };
    assert_eq!(bus(keys), expected);
    assert_eq!(bus("drive_interpolation = \"cubic\"\n").drive_interpolation, Mode::Cubic);
    for (name, mode) in
        [("pp", BusMode::ProfilePosition), ("pv", BusMode::ProfileVelocity), ("ip", BusMode::InterpolatedPosition)]
    {
        assert_eq!(bus(&format!("mode = \"{name}\"\n")).mode, mode);
    }
}

#[test]
fn points_go_to_the_buffer_by_the_door_that_is_named() {
    for (name, object) in
        [("2010h", PointTransfer::MoveSegment), ("60C1h", PointTransfer::DataRecord), ("115h", PointTransfer::Serial)]
    {
        assert_eq!(bus(&format!("mode = \"ip\"\ntrajectory_buffer = \"{name}\"\n")).point_transfer, object);
    }
    assert_eq!(bus("mode = \"ip\"\n").point_transfer, PointTransfer::MoveSegment);
}

/// Oracle: the travel per increment by hand, from lead and gear.
#[test]
fn units_are_increments_of_the_encoder_that_closes_the_loop() {
    let units = |old: &str, new: &str| {
        assert!(AXIS.contains(old), "{old}");
        scenario(&AXIS.replace(old, new)).bus.unwrap().units
    };
    let counts = "counts_per_rev = 1048576";
    let geared = units("model = \"ball-screw\"", "model = \"ball-screw\"\ngear_ratio = 4");
    assert_eq!(geared, DriveUnits { drive: 1 << 20, axis: 0.0025 });
    let step = units(counts, "step = \"0.036 deg\"");
    // A ten-thousandth of a turn is a micrometre of a lead of 10 mm.
    assert!(step.drive == 1 && (step.axis / 1e-6 - 1.0).abs() < 1e-15, "{step:?}");
    let scale = units(
        "model = \"servo-16khz\"",
        "model = \"servo-16khz\"\nposition_feedback = \"load\"\nload_encoder = { step = \"0.1 um\" }",
    );
    assert_eq!(scale, DriveUnits { drive: 1, axis: 1e-7 });
    let rotary = AXIS
        .replace("model = \"ball-screw\"", "motion = \"rotary\"\nmotor_side.inertia = \"1e-4 kg m2\"\ngear_ratio = 2");
    assert_eq!(scenario(&rotary).bus.unwrap().units, DriveUnits { drive: 1 << 20, axis: TAU / 2.0 });
    let linear = AXIS
        .replace("ball-screw", "linear-slide")
        .replace("wittenstein-premo-1f", "siemens-1fn3900-4wb0")
        .replace(counts, "step = \"0.1 um\"");
    assert_eq!(scenario(&linear).bus.unwrap().units, DriveUnits { drive: 1, axis: 1e-7 });
}

/// Oracle: the multiples of a millisecond within the times.
#[test]
fn faults_concern_whole_cycles() {
    let bus = bus(r#"
motion_cycle = "4 ms"
[[bus.fault]]
kind = "lost"
start = "0.5 s"
[[bus.fault]]
kind = "late"
start = "10.1 ms"
by = "750 us"
cycles = 3
[[bus.fault]]
kind = "jitter"
by = "250 us"
seed = 7
[[bus.fault]]
kind = "master-stopped"
start = "0.3 s"
duration = "20 ms"
[[bus.fault]]
kind = "drive-silent"
start = "10.1 ms"
duration = "1.8 ms"
[[bus.fault]]
kind = "external-fault"
[[bus.fault]]
kind = "task-late"
start = "10.1 ms"
by = "6 ms"
[[bus.fault]]
kind = "task-jitter"
by = "2 ms"
[[bus.fault]]
kind = "task-lost"
start = "10.1 ms"
cycles = 2
[[bus.fault]]
kind = "task-torn"
[[bus.fault]]
kind = "task-fast"
by = "1 ms"
duration = "20 ms"
"#);
    let fault = |kind, cycles| BusFault { kind, cycles };
    let expected = [
        fault(BusFaultKind::Lost, 500..501),
        fault(BusFaultKind::Late { by: 12 }, 11..14),
        fault(BusFaultKind::Jitter { by: 4, seed: 7 }, 0..u64::MAX),
        fault(BusFaultKind::MasterStopped, 300..320),
        fault(BusFaultKind::DriveSilent, 11..12),
        fault(BusFaultKind::ExternalFault, 0..u64::MAX),
    ];
    assert_eq!(bus.faults, expected);
    // In cycles of the motion task, 4 ms each.
    let fault = |kind, cycles| TaskFault { kind, cycles };
    let expected = [
        fault(TaskFaultKind::Late { by: 96 }, 3..4),
        fault(TaskFaultKind::Jitter { by: 32, seed: 1 }, 0..u64::MAX),
        fault(TaskFaultKind::Lost, 3..5),
        fault(TaskFaultKind::Torn, 0..1),
        fault(TaskFaultKind::Fast { by: 16 }, 0..5),
    ];
    assert_eq!(bus.task_faults, expected);
}

#[test]
fn objects_keep_their_order_and_their_keys() {
    let objects = bus("[drive.objects]\n\"6098h\" = 7\n\"6099h.1\" = 50000\n607Dh = { 01h = -5, 2 = 0x10 }\n").objects;
    let found: Vec<_> = objects.iter().map(|o| (o.object.index, o.object.subindex, o.value, o.key.as_str())).collect();
    let expected = [
        (0x6098, 0, 7, "drive.objects.6098h"),
        (0x6099, 1, 50_000, "drive.objects.6099h.1"),
        (0x607d, 1, -5, "drive.objects.607Dh.01h"),
        (0x607d, 2, 16, "drive.objects.607Dh.2"),
    ];
    assert_eq!(found, expected);
}

#[test]
fn switches_of_the_axis() {
    let switches = |keys: &str| scenario(&format!("{AXIS}[axis.switches]\n{keys}\n")).axis.switches;
    let all = switches(
        "negative = \"-20 mm\"\npositive = \"520 mm\"\nhome = { from = \"0 mm\", to = \"10 mm\" }\nindex = \"-90 deg\"",
    );
    let expected = Switches {
        negative: Some(-0.02),
        positive: Some(0.52),
        home: Some(0.0..=0.01),
        index: Some(0.75 * TAU),
        normally_closed: false,
    };
    assert_eq!(all, expected);
    assert_eq!(switches("index = \"720 deg\"").index, Some(0.0));
    assert_eq!(switches("index = \"-1e-20 deg\"").index, Some(0.0), "a revolution of f64 is none");
    assert_eq!(scenario(AXIS).axis.switches, Switches { index: Some(0.0), ..Switches::default() });
}
