//! Diagnostics of tables: profiles, their scales, switches of cams.
use super::*;

#[test]
fn tables_of_profiles() {
    check(&[
        (
            &call("MC_VelocityProfile", "table = { file = \"x.csv\" }"),
            &["3:18: HERE/x.csv:1:1: the column `velocity` is missing: add `velocity [mm/s]`"],
        ),
        (
            &call("MC_AccelerationProfile", "table = { file = \"v.csv\" }"),
            &["3:18: HERE/v.csv:1:1: the column `acceleration` is missing: add `acceleration [mm/s2]`"],
        ),
        (
            &call("MC_PositionProfile", "table = { file = \"a.csv\" }"),
            &["3:18: HERE/a.csv:1:1: the column `position` is missing: add `position [mm]`"],
        ),
        (
            &call("MC_VelocityProfile", "table = { file = \"v.csv\", relative = true, follow = \"steps\" }"),
            &["3:38: `relative` is for a table of positions", "3:53: `follow` is for a table of positions"],
        ),
        (
            &call("MC_PositionProfile", "table = { file = \"x.csv\", velocities = \"average\", follow = \"steps\" }"),
            &[
                "3:40: MC_PositionProfile does not choose its velocities by this rule; it follows the cubic spline, or by \"plateaus\"; by \"steps\" \
                 over a bus with `mode = \"pv\"`",
                "3:60: MC_PositionProfile does not follow its table by this method; it follows the cubic spline, or by \"plateaus\"; by \"steps\" over a \
                 bus with `mode = \"pv\"`",
            ],
        ),
        (
            &call("MC_PositionProfile", "table = { file = \"x.csv\", passes = 1, plateau_share = 0.3 }"),
            &[
                "3:36: `passes` is not for MC_PositionProfile; it follows the cubic spline, or by \"plateaus\"; by \"steps\" over a bus with \
                 `mode = \"pv\"`",
                "3:55: `plateau_share` is for \"plateaus\"",
            ],
        ),
        (
            &call("MC_VelocityProfile", "table = { file = \"early.csv\" }"),
            &["3:18: the table begins at -0.01 s, before the profile; its times count from the start of the profile"],
        ),
    ]);
}

#[test]
fn scales_of_tables() {
    let scaled = |keys: &str| call("MC_VelocityProfile", &format!("table = {{ file = \"v.csv\" }}\n{keys}"));
    check(&[
        (&scaled("value_scale = 0"), &["4:15: `value_scale` must not be 0; leave it out, or give a factor"]),
        (&scaled("time_scale = -1"), &["4:14: `time_scale` must be above zero, got -1"]),
        (
            &scaled("velocity_offset = \"1 mm\""),
            &["4:19: `velocity_offset` must be a velocity, but \"1 mm\" is a length (mm)"],
        ),
        (
            &scaled("position_offset = \"1 mm\""),
            &[
                "4:19: MC_VelocityProfile has no input `position_offset`; its inputs are table, time_scale, value_scale, \
                 velocity_offset, buffer_mode",
            ],
        ),
        (
            &call("MC_MoveVelocity", "velocity = \"1 m/min\"\ntime_scale = 2"),
            &[
                "4:14: MC_MoveVelocity has no input `time_scale`; its inputs are velocity, acceleration, deceleration, jerk, snap, \
 direction, buffer_mode, continuous_update",
            ],
        ),
    ]);
}

#[test]
fn switches_of_cams() {
    let cam = |keys: &str| call("MC_DigitalCamSwitch", keys);
    let one = |keys: &str| cam(&format!("switches = [{{ {keys} }}]"));
    let with = |keys: &str| {
        cam(&format!("switches = [{{ track = 3, first = \"1 mm\", last = \"2 mm\" }}]\ntrack_options = [{keys}]"))
    };
    check(&[
        (&cam(""), &["1:1: missing `switches` in `call`; MC_DigitalCamSwitch needs it"]),
        (
            &cam("switches = []"),
            &["3:12: `switches` must not be empty; write `switches = [{ track = 0, first = …, last = … }]`"],
        ),
        (&cam("switches = \"cams.csv\""), &["3:12: `switches` must be a list, got a string"]),
        (
            &one("track = 32, first = \"1 mm\", last = \"2 mm\""),
            &["3:23: `track` must be a whole number from 0 to 31, got 32"],
        ),
        (
            &one("track = 0, first = \"1 mm\""),
            &["3:13: missing `last` in `call.switches`; the upper end of its window, or a `duration` from `first` on"],
        ),
        (&one("first = \"1 mm\", last = \"2 mm\""), &["3:13: missing `track` in `call.switches`"]),
        (
            &one("track = 0, first = \"1 mm\", last = \"2 mm\", duration = \"1 ms\""),
            &["3:68: a switch ends at `last` or after a `duration`; give one of them"],
        ),
        (
            &one("track = 0, first = \"1 deg\", last = \"2 s\""),
            &[
                "3:34: `first` must be a length, but \"1 deg\" is an angle (deg)",
                "3:50: `last` must be a length, but \"2 s\" is a time (s)",
            ],
        ),
        (
            &one("track = 0, first = \"2 mm\", last = \"1 mm\""),
            &[
                "3:49: `last` must be at FirstOnPosition or above it, but on a modulo axis; `first` is the lower end of the window; \
                 one over the zero needs `modulo` in `[axis]`",
            ],
        ),
        (
            &one("track = 0, first = \"1 mm\", duration = \"-1 ms\""),
            &["3:53: `duration` must be above zero, got \"-1 ms\""],
        ),
        (
            &one("track = 0, first = \"1 mm\", last = \"2 mm\", direction = \"up\", mode = \"time\""),
            &[
                "3:69: \"up\" is not a value of `direction`; known here: `both`, `positive`, `negative`",
                "3:75: unknown key `mode` in `call.switches`; known here: `track`, `first`, `last`, `duration`, `direction`",
            ],
        ),
        (&with("{ track = 4 }"), &["4:28: no switch is on track 4; leave its options out"]),
        (&with("{ track = 3 }, { track = 3 }"), &["4:43: track 3 has two options; join them"]),
        (
            &with("{ track = 3, hysteresis = \"-1 mm\", on_compensation = \"1 mm\" }"),
            &[
                "4:44: `hysteresis` must be zero or more, got \"-1 mm\"",
                "4:71: `on_compensation` must be a time, but \"1 mm\" is a length (mm)",
            ],
        ),
        (
            &with("{ track = 3 }]\nenable_mask = -1\nvalue_source = \"commanded\"\n#"),
            &[
                "5:15: `enable_mask` must be a whole number from 0 to 4294967295, got -1",
                "6:16: \"commanded\" is not a value of `value_source`; known here: `set-point`, `actual`",
            ],
        ),
    ]);
    // Inputs that an update keeps are not reported again.
    let kept = "switches = [{ track = 0, first = \"2 mm\", last = \"1 mm\" }]\n\
                updates = [{ when = { at = \"1 s\" }, enable_mask = 0 }]";
    check(&[(
        &cam(kept),
        &[
            "3:49: `last` must be at FirstOnPosition or above it, but on a modulo axis; `first` is the lower end of the window; \
                 one over the zero needs `modulo` in `[axis]`",
        ],
    )]);
}

/// On an axis with a period of 100 mm a window may cross the zero, and every position is within the period.
#[test]
fn switches_of_cams_on_a_modulo_axis() {
    let modulo = lasting().replace("lead = \"10 mm\"\n", "lead = \"10 mm\"\nmodulo = \"100 mm\"\n");
    for (keys, expected) in [
        ("first = \"90 mm\", last = \"10 mm\" }]", None),
        ("first = \"0 mm\", last = \"100 mm\" }]", None),
        ("first = \"100 mm\", last = \"10 mm\" }]", Some("3:34: `first` must be within the modulo period, from 0 on")),
        (
            "first = \"0 mm\", last = \"101 mm\" }]",
            Some("3:49: `last` must be within the modulo period, from 0 up to it"),
        ),
        ("first = \"-1 mm\", duration = \"1 s\" }]", Some("3:34: `first` must be within the modulo period, from 0 on")),
        (
            "first = \"0 mm\", last = \"1 mm\" }]\ntrack_options = [{ track = 0, hysteresis = \"50 mm\" }]",
            Some("4:44: `hysteresis` must be less than half of the modulo period"),
        ),
    ] {
        let calls = call("MC_DigitalCamSwitch", &format!("switches = [{{ track = 0, {keys}"));
        let [errors, warnings] = said_of(&modulo, &format!("{BUS}{POWER}"), &calls);
        assert_eq!((errors, warnings), (expected.into_iter().map(str::to_owned).collect(), Vec::new()), "{keys}");
    }
}
