//! The position loop in the master, and efforts over the bus.
use crate::rig::{BUS, MOVE, SCREW, last, lasting, peak, run, states, values, when};

/// The master closes the position loop every millisecond, of a position that is three cycles old and a turn of the drive.
///
/// Oracle: what is left of a velocity that lags by τ, half a turn of the drive's position loop (4 kHz), over which it is held:
/// (a·τ + j·T²/12)/K; without feedforward v/K more.
#[test]
fn the_master_closes_the_position_loop() {
    let recording = run(&format!("{SCREW}{BUS}mode = \"csv\"\nposition_gain = \"60 1/s\"\n{MOVE}"));
    assert_eq!(states(&recording, "drive", "mode").last(), Some(&"csv"));
    let error = peak(&recording, "following_error.load");
    let left = (5.0 * 0.5 / 4e3 + 100.0 * 1e-6 / 12.0) / 60.0;
    println!("{error:.3e} m of {left:.3e} m, {:.3e} m at the end", last(&recording, "load.position") - 0.25);
    assert!((last(&recording, "load.position") - 0.25).abs() < 10e-6, "{}", last(&recording, "load.position"));
    assert!(error < left, "{error}");
    let bare = BUS.replace("velocity_offset = true\n", "");
    let bare = run(&format!("{SCREW}{bare}mode = \"csv\"\nposition_gain = \"60 1/s\"\n{MOVE}"));
    let lag = peak(&bare, "following_error.load");
    println!("{lag:.3e} m without");
    assert!((lag - 0.5 / 60.0).abs() < left, "{lag}");
}

/// Oracle: the call itself.
#[test]
fn a_torque_over_the_bus_is_the_motor_s() {
    let text = lasting(SCREW, "1 s");
    let recording = run(&format!(
        r#"{text}{BUS}
[[call]]
block = "MC_Power"
name = "power"
[[call]]
block = "MC_TorqueControl"
name = "push"
start = "power.Status"
torque = "0.5 Nm"
torque_ramp = "10 Nm/s"
[[call]]
block = "MC_Halt"
name = "halt"
start = {{ after = "push.InTorque", delay = "50 ms" }}
"#
    ));
    let modes = states(&recording, "drive", "mode");
    println!("{modes:?} {:?}", states(&recording, "axis", "state"));
    assert!(modes.contains(&"cst") && modes.last() == Some(&"csp"), "{modes:?}");
    let reached = when(&recording, "push", "InTorque", "TRUE");
    let begun = when(&recording, "push", "Active", "TRUE");
    assert!((reached - begun - 0.05).abs() < 5e-3, "0.5 N·m at 10 N·m/s: {} s", reached - begun);
    let torque = values(&recording, "effort.motor");
    let held = torque[recording.index_at(reached + 0.03)];
    // A thousandth of 6.09 N·m, and the ripple of the current loop.
    assert!((held - 0.5).abs() < 0.01, "{held}");
    assert!(when(&recording, "halt", "Done", "TRUE") > reached);
    assert!(last(&recording, "motor.velocity").abs() < 1e-3);
}

/// Oracle: the objects themselves, in thousandths of 6.09 N·m: an axis that is told 5 m/s² with a torque that does not suffice
/// lags, and catches up later.
#[test]
fn torque_limits_of_the_objects_bind_in_every_mode() {
    for mode in ["", "mode = \"csv\"\nposition_gain = \"60 1/s\"\n", "mode = \"pp\"\n"] {
        let objects = "[drive.objects]\n\"6065h\" = 4294967295\n\"6072h\" = 150\n\"60E1h\" = 100\n";
        let bus = if mode.contains("pp") { "[bus]\ncycle = \"1 ms\"\n" } else { BUS };
        let free = run(&format!("{SCREW}{bus}{mode}{MOVE}"));
        let limited = run(&format!("{SCREW}{bus}{mode}{objects}{MOVE}"));
        let (asked, given) = (values(&free, "effort.reference"), values(&limited, "effort.reference"));
        let most = |efforts: &[f64]| efforts.iter().fold([0.0_f64; 2], |[f, b], e| [f.max(*e), b.max(-e)]);
        println!("{mode:?}: {:?} of {:?} N·m", most(given), most(asked));
        assert!(most(asked)[0] > 0.15 * 6.09 && most(asked)[1] > 0.1 * 6.09, "{mode}: there is something to cut");
        assert!((most(given)[0] - 0.15 * 6.09).abs() < 1e-12 && (most(given)[1] - 0.1 * 6.09).abs() < 1e-12, "{mode}");
    }
}
