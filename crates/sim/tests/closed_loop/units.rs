//! Units that depend on the axis.
use crate::rig::run;

/// Unit of the channel `command.output` of an ideal source.
fn output_unit(motion: &str, side: &str, source: &str, gain: &str) -> String {
    let text = format!(
        r#"
[run]
base_rate = "1 kHz"
duration = "2 ms"
[axis]
motion = "{motion}"
[axis.motor_side]
{side}
[motor]
kind = "ideal-source"
{source}
[drive.velocity]
rate = "1 kHz"
gain = "{gain}"
[drive.position]
rate = "1 kHz"
gain = "1 1/s"
"#
    );
    let recording = run(&text);
    let channel = recording.channels.iter().find(|channel| channel.spec.name == "command.output").unwrap();
    channel.spec.unit.clone()
}

#[test]
fn the_output_of_a_source_without_gain_is_its_force_or_torque() {
    assert_eq!(output_unit("linear", "mass = \"1 kg\"", "", "10 N s/m"), "N");
    assert_eq!(output_unit("rotary", "inertia = \"1 kg m2\"", "", "10 Nm s/rad"), "N m");
    assert_eq!(output_unit("linear", "mass = \"1 kg\"", "gain = \"2 N/V\"", "10 N s/m"), "V");
    assert_eq!(output_unit("rotary", "inertia = \"1 kg m2\"", "gain = \"2 Nm/V\"", "10 Nm s/rad"), "V");
}
