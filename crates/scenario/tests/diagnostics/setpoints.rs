//! Diagnostics of moves: combinations of keys, and sequences of moves.
use crate::AXIS;
use servobench_scenario::{LoadError, parse};
use std::path::Path;

/// `line:column: message; help` of every mistake in the axis with `setpoint` added to `[setpoint]` and `program` as its program; lines
/// count from that of the addition.
fn mistakes(setpoint: &str, program: &str) -> Vec<String> {
    let (before, behind) = AXIS.split_once("[[program]]\nmove_to = \"250 mm\"\n").unwrap();
    let shift = before.lines().count();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("points.csv"), "time [ms],position [mm]\n0,0\n10,5\n20,15\n30,20\n").unwrap();
    std::fs::write(folder.path().join("turns.csv"), "time [ms],position [deg]\n0,0\n10,5\n").unwrap();
    std::fs::write(folder.path().join("wrong.csv"), "time [ms],position [mm]\n0,0\n0,5\n").unwrap();
    let text = format!("{before}{setpoint}{program}{behind}");
    let parsed = parse("test.toml", &text, Some(Path::new(folder.path())));
    let Err(LoadError::Invalid(invalid)) = parsed else { return Vec::new() };
    let folder = folder.path().display().to_string();
    let said = invalid.diagnostics.iter().map(|one| {
        let before = &invalid.sources.text(one.source)[..one.span.start];
        let line = before.matches('\n').count() - shift + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        let help = one.help.as_ref().map_or_else(String::new, |help| format!("; {help}"));
        format!("{line}:{column}: {}{help}", one.message).replace(&folder, "HERE")
    });
    said.collect()
}

fn check(cases: &[(&str, &str, &[&str])]) {
    for (setpoint, program, said) in cases {
        assert_eq!(mistakes(setpoint, program), *said, "{setpoint}{program}");
    }
}

const TO: &str = "[[program]]\nmove_to = \"0 mm\"\n";

#[test]
fn what_can_follow_a_move_in_motion() {
    let passing = "[[program]]\nmove_to = \"250 mm\"\nend_velocity = \"1 m/min\"\n";
    let turning = "[[program]]\nreach_velocity = \"-10 m/min\"\nhold = \"0.5 s\"\n";
    let wait = "[[program]]\nwait = \"0.1 s\"\n";
    let table = "[[program]]\ntable = { file = \"points.csv\" }\n";
    check(&[
        ("", &format!("{passing}{TO}"), &[]),
        ("", &format!("{turning}{passing}{TO}"), &[]),
        ("", passing, &["1:1: the program ends in motion; add a move to rest after this one"]),
        (
            "",
            &format!("{turning}{wait}{TO}"),
            &["4:1: the axis does not rest here: the move before ends in motion; let the next move follow at once; a \
               velocity that was reached is held by `hold`"],
        ),
        ("", &format!("{passing}{table}"), &["4:1: a table starts at rest; let the move before end at rest"]),
        (
            "",
            "[[program]]\nmove_to = \"1 mm\"\naborts_after = \"0.1 s\"\n",
            &["3:16: this step has no move to abort; give the step before a move, or leave `aborts_after` out"],
        ),
        ("", &format!("{TO}[[program]]\nmove_to = \"1 mm\"\naborts_after = \"0.1 s\"\n"), &[]),
        (
            "",
            &format!("{TO}[[program]]\nmove_to = \"1 mm\"\nduration = \"2 s\"\naborts_after = \"0.1 s\"\n"),
            &[
                "5:12: a move that starts or ends in motion is not filtered or slowed: its velocity would jump; leave it out: \
               limits say how fast the move is",
            ],
        ),
        (
            "shaper = { kind = \"zv\", frequency = \"17 Hz\" }\naverages = [\"10 ms\"]\n",
            &format!("{passing}averages = []\n{TO}averages = []\nshaper = {{ kind = \"none\" }}\n"),
            &["1:10: a move that starts or ends in motion is not filtered or slowed: its velocity would jump; write \
               `shaper = { kind = \"none\" }` into this step"],
        ),
    ]);
}

#[test]
fn keys_that_a_way_does_not_have() {
    let rockwell = |keys: &str| format!("[[program]]\nmove_to = \"1 mm\"\nrockwell = {{ {keys} }}\n");
    check(&[
        (
            "",
            "[[program]]\nwait = \"1 s\"\nhold = \"1 s\"\nmethod = \"optimal\"\n",
            &["3:8: a pause has no `hold`", "4:10: a pause has no `method`"],
        ),
        (
            "",
            "[[program]]\nmove_to = \"1 mm\"\nhold = \"1 s\"\nnegative_velocity = \"1 m/s\"\n",
            &[
                "3:8: a move to a position has no `hold`",
                "4:21: a move that is not planned `online` has no `negative_velocity`",
            ],
        ),
        (
            "",
            "[[program]]\nmove_to = \"1 mm\"\nonline = \"fast\"\nmethod = \"optimal\"\n",
            &["4:10: `method` is for moves from rest to rest, this one is planned in motion"],
        ),
        (
            "",
            &format!("[[program]]\nmove_to = \"1 mm\"\nend_velocity = \"31 m/min\"\n{TO}"),
            &["3:16: beyond the velocity limit, 0.5 in SI; lower it or raise the limit"],
        ),
        (
            "",
            "[[program]]\nmove_to = \"1 mm\"\nsampling = \"fewest\"\n",
            &["3:12: `sampling` is for a move that has samples; give `sample_time`"],
        ),
        ("", &rockwell("shape = \"s-curve\", jerk_of_time = \"25 %\""), &[]),
        (
            "",
            &rockwell("shape = \"s-curve\", jerk_of_maximum = \"25 %\""),
            &["3:12: a part of the maximum needs `maximum_jerk`; that for which the axis is configured"],
        ),
        (
            "",
            &rockwell("shape = \"s-curve\", jerk_of_time = 1, jerk_of_maximum = 1"),
            &["3:69: `jerk_of_time` and `jerk_of_maximum` give the same quantity; give one of them"],
        ),
        ("", &rockwell("shape = \"s-curve\", jerk_time = \"1 ms\", deceleration_jerk_of_time = \"25 %\""), &[]),
        (
            "",
            &rockwell(
                "shape = \"s-curve\", jerk_master_units = 2, deceleration_jerk_time = \"1 ms\", master_speed = 360",
            ),
            &[],
        ),
        (
            "",
            &rockwell("shape = \"s-curve\", jerk_master_units = 2"),
            &["3:53: jerk in master units needs `master_speed`; give the master units per second"],
        ),
        (
            "",
            &rockwell("shape = \"s-curve\", jerk_of_time = 1, master_speed = 360"),
            &["3:66: `master_speed` is for jerk in master units; give `jerk_master_units`, or leave it out"],
        ),
        (
            "",
            &rockwell("shape = \"trapezoid\", maximum_jerk = \"500 m/s3\", jerk_of_time = 1"),
            &["3:77: `jerk_of_time` is for an S-curve; a trapezoid takes `maximum_jerk`"],
        ),
        (
            "",
            &format!("{}end_velocity = \"1 m/min\"\n{TO}", rockwell("shape = \"s-curve\"")),
            &["4:16: Rockwell's move starts and ends at rest; leave `rockwell` out of this step, or let the axis rest"],
        ),
        (
            "averages = [\"10 ms\", \"0.1 ms\"]\n",
            TO,
            &["1:22: `averages` is 1.6000 base ticks, not a whole number; 125 us fits"],
        ),
        (
            "interpolation = { mode = \"cubic\", period = \"0.7 ms\" }\n",
            TO,
            &["1:44: `period` is 11.2000 base ticks, not a whole number; 687.5 us fits"],
        ),
    ]);
}

#[test]
fn tables_of_points() {
    let table = |keys: &str| format!("[[program]]\ntable = {{ {keys} }}\n");
    check(&[
        ("", &table("file = \"points.csv\", velocities = \"continuous\""), &[]),
        (
            "",
            &table("file = \"none.csv\""),
            &[
                "2:18: cannot read `HERE/none.csv`: No such file or directory (os error 2); the path is relative to this file",
            ],
        ),
        (
            "",
            &table("file = \"turns.csv\""),
            &[
                "2:18: the positions in HERE/turns.csv are angles, this axis needs lengths; change the units of its heading",
            ],
        ),
        (
            "averages = [\"10 ms\"]\n",
            &table("file = \"points.csv\", follow = \"plateaus\""),
            &["1:12: a position profile is not filtered: it sends velocities; write `averages = []` into this step"],
        ),
        (
            "",
            &table("file = \"wrong.csv\""),
            &[
                "2:18: HERE/wrong.csv:3:1: `time` is 0 s, not later than 0 s at the point before: sort the rows by time and give \
                 each a different time",
            ],
        ),
        (
            "",
            &table("file = \"points.csv\", passes = 3, follow = \"steps\""),
            &[
                "2:9: missing `command_rate` in `table`; how often a velocity is sent; `servobench plan` finds the lowest for an \
             allowed error",
                "2:41: `passes` is for velocities that are \"smooth\"",
            ],
        ),
        // The limits of `[setpoint]`, or those of the step, determine the share.
        ("averages = []\n", &table("file = \"points.csv\", follow = \"plateaus\", plateau_share = \"auto\""), &[]),
        (
            "averages = []\n",
            &format!(
                "{}velocity = \"1 m/s\"\n",
                table("file = \"points.csv\", follow = \"plateaus\", plateau_share = \"auto\"")
            ),
            &[],
        ),
        (
            "averages = []\n",
            &table("file = \"points.csv\", follow = \"plateaus\", plateau_share = \"best\""),
            &["3:69: `plateau_share` must be \"auto\" or a value like 0.25, got \"best\""],
        ),
        (
            "",
            &format!("{}velocity = \"1 m/s\"\nend_velocity = \"1 m/s\"\n", table("file = \"points.csv\"")),
            &["3:12: a table has no `velocity`", "4:16: a table has no `end_velocity`"],
        ),
    ]);
}

#[test]
fn shapers() {
    check(&[
        ("shaper = { kind = \"zvd\" }\n", TO, &["1:10: missing `frequency` in `shaper`; that of the mode"]),
        (
            "shaper = { kind = \"zv\", frequency = \"9 Hz\", tolerable = 0.1 }\n",
            TO,
            &["1:57: `tolerable` is for the EI shapers"],
        ),
        ("shaper = []\n", TO, &["1:10: `shaper` must not be empty"]),
        (
            "shaper = [{ kind = \"zv\", frequency = \"9 Hz\" }, { kind = \"2hump_ei\" }, { kind = \"zv\" }]\n",
            TO,
            &[
                "1:57: \"2hump_ei\" is not a value of `kind`; did you mean `2hump-ei`?",
                "1:71: missing `frequency` in `shaper`; that of the mode",
            ],
        ),
        (
            "shaper = [{ kind = \"zv\", frequency = \"9 Hz\" }, { kind = \"zvd\" }, { kind = \"zv\", damping = 0.1 }]\n",
            &format!("{TO}{TO}"),
            &[
                "1:48: missing `frequency` in `shaper`; that of the mode",
                "1:66: missing `frequency` in `shaper`; that of the mode",
            ],
        ),
        (
            "shaper = { kind = \"3hump-ei\", frequency = \"9 Hz\", damping = 0.5 }\n",
            &format!("{TO}{TO}"),
            &[
                "1:10: `shaper`: no extra-insensitive shaper found for `damping_ratio` = 0.5 and `tolerable` = 0.05: lower \
               either, or take a ZVD shaper",
            ],
        ),
        (
            "shaper = [{ kind = \"zvdd\", frequency = \"9 Hz\" }, { kind = \"zvdd\", frequency = \"17 Hz\" }, { kind = \"zv\", \
             frequency = \"8 Hz\" }, { kind = \"zv\", frequency = \"29 Hz\" }]\n",
            &format!("{TO}{TO}"),
            &[
                "1:10: `shaper`: the filter has 64 impulses, at most 32 are kept: take fewer shapers or shorter ones, or \
               filter one after the other",
            ],
        ),
    ]);
}
