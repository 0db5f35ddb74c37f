//! Parts of scenarios: a ball screw under a stiff drive.

/// The axis for 0.3 s; set-points are to be given.
pub(crate) const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
duration = "0.3 s"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
dc_link = "320 V"
max_torque = "6.09 Nm"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "100 m/s3"
snap = "5000 m/s4"
"#;
pub(crate) const MOVE: &str = "[[program]]\nmove_to = \"50 mm\"\n";
pub(crate) const BUS: &str = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\n";
/// A program of function blocks, in place of a move.
pub(crate) const BLOCKS: &str = "[plc]\nhoming_required = false\n[[call]]\nblock = \"MC_Power\"\nname = \"power\"\n\
                      [[call]]\nblock = \"MC_MoveAbsolute\"\nname = \"move\"\nstart = \"power.Status\"\nposition = \"50 mm\"\n";
