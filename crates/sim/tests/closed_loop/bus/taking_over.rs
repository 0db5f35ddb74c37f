//! An axis that moves when its drive is enabled: nothing jumps.
use crate::rig::{SCREW, lasting, run, states, values};
use servobench_trace::Recording;

/// A feed axis at 0.4 m/s whose drive loses power by an external fault, coasts (605Ah = 0) and is enabled again while it does.
fn coasting(more: &str) -> Recording {
    let text = lasting(SCREW, "1.2 s");
    run(&format!(
        r#"{text}
[bus]
cycle = "1 ms"
velocity_offset = true
effort_offset = "rigid"
{more}
[drive.objects]
"605Ah" = 0
[[bus.fault]]
kind = "external-fault"
start = "0.4 s"
duration = "10 ms"
[plc]
homing_required = false
[[call]]
block = "MC_Power"
name = "power"
[[call]]
block = "MC_MoveVelocity"
name = "turn"
start = "power.Status"
velocity = "24 m/min"
[[call]]
block = "MC_Reset"
name = "reset"
start = {{ at = "0.42 s" }}
"#
    ))
}

/// The rows from `from` to `to` (s).
fn part<'a>(recording: &'a Recording, name: &str, from: f64, to: f64) -> &'a [f64] {
    &values(recording, name)[recording.index_at(from)..recording.index_at(to)]
}

/// The largest change from one row to the next.
fn jump(values: &[f64]) -> f64 {
    values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
}

/// Oracle: the limits of the recovery, which are those of the axis: 5 m/s² are 0.3 mm/s in a tick of 62.5 µs, 5 mm/s in a cycle of the
/// bus in which a line has one velocity.
#[test]
fn it_goes_on_at_its_velocity_and_is_brought_to_rest_from_there() {
    for (mode, more) in [("csp", ""), ("csv", "mode = \"csv\"\nposition_gain = \"60 1/s\"\n")] {
        let recording = coasting(more);
        assert!(states(&recording, "drive", "mode").contains(&mode));
        let signal = recording.signal("drive", "state").unwrap();
        let lost = signal.changes.iter().find(|(t, state)| *t > 0.4 && state == "Switch on disabled").unwrap().0;
        let enabled = signal.changes.iter().find(|(t, state)| *t > lost && state == "Operation enabled").unwrap().0;
        let v = values(&recording, "motor.velocity")[recording.index_at(enabled)];
        println!("{mode}: off at {lost} s, on again at {enabled} s, at {v} m/s");
        assert!(v > 0.05, "{mode}: it still moves: {v}");
        // Without power the master puts out what the axis does: as old as a frame and a step of the drive.
        let off = (enabled - 5e-3, enabled - 1e-3);
        let [put_out, actual] = ["link.velocity", "motor.velocity"].map(|name| part(&recording, name, off.0, off.1));
        let apart = put_out.iter().zip(actual).map(|(put_out, actual)| (put_out - actual).abs()).fold(0.0, f64::max);
        let slowing = jump(part(&recording, "motor.velocity", off.0, off.1)) * 16e3;
        println!("{mode}: {apart:.2e} m/s apart, slows down by {slowing:.2} m/s²");
        assert!(apart < slowing * 3.5e-3 + 1e-3, "{mode}: {apart}");
        // From then on until it stands.
        let after = (enabled - 2e-3, enabled + 0.3);
        let reference = jump(part(&recording, "velocity.reference", after.0, after.1));
        let measured = jump(part(&recording, "motor.velocity", after.0, after.1));
        let put_out = jump(part(&recording, "link.velocity", after.0, after.1));
        println!(
            "{mode}: in a tick the reference changes by {reference:.2e}, the axis by {measured:.2e}, the master by {put_out:.2e} m/s"
        );
        assert!(reference < 0.04, "{mode}: {reference}");
        assert!(put_out < 0.03, "{mode}: {put_out}");
        assert!(values(&recording, "motor.velocity").last().unwrap().abs() < 1e-3, "{mode}");
    }
}
