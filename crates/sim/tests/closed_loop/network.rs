//! A motion task, a fieldbus and a drive behind it.
use crate::rig::{self, peak, states, values};
use servobench_trace::Recording;

/// Lambrechts' motor and load, moved 1 m under an ideal force; feedforward and bus are to be given.
const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
model = "lambrechts"
[motor]
kind = "ideal-source"
limit = "1 kN"
[drive.velocity]
rate = "16 kHz"
bandwidth = "15 Hz"
[drive.position]
rate = "16 kHz"
bandwidth = "4 Hz"
[setpoint]
order = 4
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
[[program]]
wait = "0.1 s"
[[program]]
move_to = "1 m"
"#;

/// A bus of 1 ms in units of a nanometre, with the feedforward of the master in 60B1h and 60B2h.
const BUS: &str = r#"
[bus]
cycle = "1 ms"
velocity_offset = true
effort_offset = "two-mass"
units = { drive = 1000000, axis = "1 mm" }
"#;

fn run(more: &str) -> Recording {
    rig::run(&format!("{AXIS}{more}"))
}

/// Oracle: the same move fed to the drive at every tick. The torque has steps of 1 N here, a thousandth of the limit.
#[test]
fn feedforward_over_a_bus_is_nearly_as_good_as_without_one() {
    let direct = run("[drive.feedforward]\nvelocity = true\neffort = \"two-mass\"\n");
    let direct = peak(&direct, "following_error.load");
    let peak_over = |more: &str| peak(&run(&format!("{BUS}{more}")), "following_error.load");
    for (interpolation, allowed) in [("cubic", 1.5), ("linear", 2.0)] {
        let bus = peak_over(&format!("drive_interpolation = \"{interpolation}\"\n"));
        println!("{interpolation}: {bus:.3e} m over the bus, {direct:.3e} m without one, {:.2} times", bus / direct);
        assert!(bus < allowed * direct, "{interpolation}: {bus} {direct}");
    }
    let bare = BUS.replace("velocity_offset = true", "").replace("effort_offset = \"two-mass\"", "");
    let without = peak(&run(&bare), "following_error.load");
    assert!(without > 1e3 * direct, "60B1h and 60B2h are what it is owed to: {without}");
}

/// Oracle: the program itself, as much later as the link, the frame and the drive take. Linear between frames of 1 ms a
/// set-point of acceleration a is off by a·T²/8 at most, 0.6 µm; against the undelayed one it would be 4 mm.
#[test]
fn what_the_loops_follow_is_the_program_as_much_later_as_the_way_takes() {
    let recording = run(&format!("{BUS}motion_cycle = \"20 ms\"\ninterpolation = \"quintic\"\n"));
    let [setpoint, task] = ["setpoint.position", "task.position"].map(|name| values(&recording, name));
    // The master sends where the motor is to be: the spring is between it and the load.
    let reference = values(&recording, "reference.motor_position");
    let apart = setpoint.iter().zip(reference).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    // Half a period of the position loop is in the reference only: 1 m/s · 31 µs.
    assert!(apart < 32e-6, "{apart}");
    let behind = task.iter().zip(setpoint).map(|(task, setpoint)| task - setpoint).fold(0.0, f64::max);
    assert!(behind > 20e-3, "the motion task is far ahead: {behind} m");
    // The torque is a line between the set-points: off by m·s·T²/8 = 30·1000·0.02²/8 = 1.5 N while the snap acts, against a
    // position loop of 2.8 kN·s/m · 25/s = 71 N/mm: 21 µm if it lasted. An undelayed reference would be 22 mm ahead.
    println!("{:.2e} m against the delayed reference", peak(&recording, "following_error.load"));
    assert!(peak(&recording, "following_error.load") < 21e-6, "{}", peak(&recording, "following_error.load"));
    assert_eq!(states(&recording, "link", "interpolation"), ["Off", "Wait", "Run1"]);
}

#[test]
fn the_drive_is_led_to_power_state_by_state() {
    let recording = run(BUS);
    let states = states(&recording, "drive", "state");
    assert_eq!(states, ["Switch on disabled", "Ready to switch on", "Switched on", "Operation enabled"]);
    // The move is noted when the axis makes it: after the power, and as much later as the way takes.
    let made = &recording.moves[0];
    assert!(made.start > 0.1 && (made.end - made.start - 1.35).abs() < 1e-9, "{made:?}");
    let last = values(&recording, "load.position").last().copied().unwrap_or_default();
    assert!((last - 1.0).abs() < 1e-9, "{last}");
}

/// csv: the position loop is the master's, on a bus whose frames are on their way for up to three cycles.
///
/// Oracle: the same move fed to the drive at every tick, and what the loop leaves of a velocity that lags by τ, half a period of
/// the drive's loop over which it is held: (a·τ + j·T²/12)/K.
#[test]
fn the_master_can_close_the_position_loop() {
    let direct = run("[drive.feedforward]\nvelocity = true\neffort = \"two-mass\"\n");
    let direct = peak(&direct, "following_error.load");
    let left = (5.0 * 0.5 / 16e3 + 50.0 * 1e-6 / 12.0) / 25.0;
    for delay in [0, 1, 3] {
        let recording = run(&format!("{BUS}mode = \"csv\"\nposition_gain = \"25 1/s\"\ndelay = {delay}\n"));
        let error = values(&recording, "following_error.load");
        let last = values(&recording, "load.position").last().copied().unwrap_or_default();
        let made = &recording.moves[0];
        // At constant velocity, as long as the spring and the loops take to forget the acceleration.
        let cruise = recording.index_at(made.start + 0.9)..recording.index_at(made.start + 1.0);
        let cruising = error[cruise].iter().fold(0.0_f64, |peak, error| peak.max(error.abs()));
        let largest = peak(&recording, "following_error.load");
        println!(
            "csv, {delay} cycles: {largest:.2e} m of {:.2e} m, {cruising:.1e} m at constant velocity, rests {:.1e} m off",
            direct + left,
            last - 1.0
        );
        assert_eq!(states(&recording, "drive", "mode").last(), Some(&"csv"));
        assert!(largest < direct + left, "{largest}");
        // A unit of a nanometre: half of it in the position as it is heard, the rest for what is being forgotten.
        assert!(cruising < 1e-9 && (last - 1.0).abs() < 1e-9, "{cruising} {last}");
    }
}

/// In units of a nanometre the velocity windows of the bench (606Dh, 606Fh) are more than 16 bits hold: what nobody wrote stays as
/// it is, and only what is written is refused. Oracle: the same bus without objects.
#[test]
fn a_written_object_leaves_the_others_as_they_are() {
    let without = run(BUS);
    let with = run(&format!("{BUS}[drive.objects]\n\"6068h\" = 7\n"));
    for name in ["setpoint.position", "following_error.load"] {
        let bits = |recording: &Recording| values(recording, name).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(bits(&with) == bits(&without), "{name}");
    }
    for (object, value, expected) in [
        ("606Dh", 1_000_000, "`drive.objects.606Dh`: `Velocity window` (606Dh:00h) must be at most 65535, got 1000000"),
        (
            "607Bh.2",
            359_999,
            "`drive.objects.607Bh.2` must be the whole range: the link counts through the end of its counter, got 359999",
        ),
    ] {
        let text = format!("{AXIS}{BUS}[drive.objects]\n\"{object}\" = {value}\n");
        assert_eq!(rig::refusal(&text), expected);
    }
}
