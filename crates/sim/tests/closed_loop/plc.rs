//! Programs of function blocks: the scenarios of `scenarios/plc`.
use crate::rig::{self, bench, last, run_bench, scenario_in, text_of, when};
use servobench_plant::Exact;
use servobench_sim::Bench;
use servobench_trace::Recording;

/// Cycle of the programs below (s).
const CYCLE: f64 = 1e-3;

fn run(name: &str) -> Recording {
    changed(name, &[])
}

/// The recording of a program of `scenarios/plc` with something else in the place of what it says.
fn changed(name: &str, changes: &[(&str, &str)]) -> Recording {
    rig::run(&text_of(name, changes))
}

fn never(recording: &Recording, source: &str, name: &str) -> bool {
    let signal = recording.signal(source, name).unwrap_or_else(|| panic!("no signal {source}.{name}"));
    signal.changes.iter().all(|(_, value)| value != "TRUE")
}

/// Times at which a signal has become TRUE and FALSE, by turns (s).
fn edges(recording: &Recording, source: &str) -> Vec<(f64, bool)> {
    let signal = recording.signal(source, "Value").unwrap_or_else(|| panic!("no signal {source}.Value"));
    let mut edges: Vec<_> = signal.changes.iter().map(|(t, value)| (*t, value == "TRUE")).collect();
    edges.dedup_by_key(|edge| edge.1);
    edges.retain(|edge| *edge != (0.0, false));
    edges
}

/// The shaft turns at 0.72° per cycle: from edge to edge it takes the angle between them, and a cycle at most to see it.
#[test]
fn cams_switch_outputs_at_their_angles() {
    let recording = run("digital-cam-switch.toml");
    let [zero, forwards, pulse, ahead] = ["zero", "forwards", "pulse", "ahead"].map(|source| edges(&recording, source));
    // The first turn: (before, its angle, after, its angle), those of track 3 moved by 5 ms.
    for (from, first, to, second) in [
        (forwards[0], 30.0, forwards[1], 60.0),
        (forwards[1], 60.0, pulse[0], 90.0),
        (pulse[0], 90.0, ahead[0], 180.0 - 3.6),
        (ahead[0], 180.0, ahead[1], 200.0),
        (ahead[1], 200.0, ahead[2], 220.0),
        (ahead[2], 220.0, ahead[3], 225.0),
        (ahead[3], 225.0 - 3.6, zero[2], 350.0),
        (zero[2], 350.0, zero[3], 370.0),
        (zero[3], 370.0, forwards[2], 390.0),
        (forwards[0], 30.0, forwards[2], 390.0),
    ] {
        let (measured, expected) = (to.0 - from.0, (second - first) / 720.0);
        assert!((measured - expected).abs() <= CYCLE + 1e-9, "{first}° to {second}°: {measured} s for {expected} s");
    }
    // By time to the cycle, wherever the shaft goes.
    for pair in pulse.chunks_exact(2) {
        assert!(pair[0].1 && (pair[1].0 - pair[0].0 - 20e-3).abs() < 1e-9, "{pair:?}");
    }
    // Back it passes 90° and track 3 once more, and not track 1; it does not come to the zero.
    assert_eq!([zero.len(), forwards.len(), pulse.len(), ahead.len()], [4, 4, 6, 12]);
    // 20° with 7.2° ahead of either edge, at 1440°/s.
    let [on, off] = [ahead[10].0, ahead[11].0];
    assert!((off - on - 20.0 / 1440.0).abs() <= CYCLE + 1e-9, "{on} {off}");
}

/// The timing diagrams of a second `MC_MoveAbsolute` after the first is done, and while it moves (Pietrusewicz, Waszczuk &
/// Kubicki 2019, figure 3): both end at the same position.
#[test]
fn a_second_move_ends_at_the_same_position_whether_the_first_was_done_or_not() {
    let (after, during) = (run("figure-3a.toml"), run("figure-3b.toml"));

    // After: Done of the first starts the second in the same cycle, further down in the program.
    let done = when(&after, "first", "Done", "TRUE");
    assert!((when(&after, "second", "Execute", "TRUE") - done).abs() < 1e-9);
    assert!(never(&after, "first", "CommandAborted") && !never(&after, "second", "Done"));

    // During: the first hears of it in its next call.
    let executed = when(&during, "second", "Execute", "TRUE");
    assert!((when(&during, "first", "CommandAborted", "TRUE") - executed - CYCLE).abs() < 1e-9);
    assert!(never(&during, "first", "Done") && never(&during, "second", "CommandAborted"));
    let state = |name: &str| when(&during, "axis", "state", name);
    assert!(state("DiscreteMotion") < executed && executed < state("Standstill"));
    assert!(when(&during, "second", "Done", "TRUE") < when(&after, "second", "Done", "TRUE"), "no stop between");

    // The set-points bit for bit; the load, which friction holds somewhere, to less than a nanometre.
    assert_eq!(last(&after, "task.position").to_bits(), last(&during, "task.position").to_bits());
    let [one, other] = [&after, &during].map(|recording| last(recording, "load.position"));
    println!("the load rests at {one} m and {other} m: {:.2e} m apart", (one - other).abs());
    assert!((one - other).abs() < 1e-9, "{one} {other}");
}

/// Oracle: the limits of the scenario, on what the loops of the drive follow.
#[test]
fn an_abort_is_smooth() {
    let recording = run("figure-3b.toml");
    let names = ["setpoint.position", "setpoint.velocity"];
    let [x, v] = names.map(|name| recording.channel(name).unwrap_or_else(|| panic!("no channel {name}")));
    let tick = recording.rate.period();
    for k in 1..x.len() {
        // The drive goes straight on between frames: the velocity changes by 5 m/s² · 1 ms and a unit per cycle at most, and
        // within a tick that is the last of one line and the first of the next the position by that times the tick.
        assert!((v[k] - v[k - 1]).abs() < 5.1e-3, "{k}: {} m/s", v[k] - v[k - 1]);
        assert!((x[k] - x[k - 1] - v[k] * tick).abs() < 5.1e-3 * tick, "{k}");
    }
}

#[test]
fn a_homed_axis_moves_from_its_reference() {
    let recording = run("homing.toml");
    assert!(when(&recording, "axis", "homed", "TRUE") >= when(&recording, "home", "Done", "TRUE") - 1e-9);
    assert!(when(&recording, "drive", "mode", "hm") > 0.0);
    // The last index pulse below the home switch, which begins at 100 mm: the screw moves 10 mm a revolution, and the pulse
    // comes at a quarter of it. The move ends 200 mm from there. Units are micrometres.
    let made = recording.moves.last().unwrap_or_else(|| panic!("no move"));
    let reference = made.to - 0.2;
    assert!((reference - 0.0925).abs() < 1e-6, "{reference}");
    assert!((last(&recording, "load.position") - made.to).abs() < 1e-5);
}

/// A program that waits for what does not come ends with the reason.
#[test]
fn waiting_in_vain_ends_with_the_reason() {
    for (start, reason) in [
        ("\"first.CommandAborted\"", "`first.CommandAborted` did not become TRUE within 1 s"),
        ("{ above = \"90 m\" }", "the axis did not pass 90 m upwards within 1 s"),
        ("{ below = \"-90 m\" }", "the axis did not pass -90 m downwards within 1 s"),
    ] {
        let waits = format!("start = {start}\ntimeout = \"1 s\"");
        let outcome = bench(&text_of("figure-3a.toml", &[("start = \"first.Done\"", &waits)])).run(&mut |_| {});
        let failure = outcome.failure.map(|failure| failure.to_string()).unwrap_or_default();
        assert!(failure.starts_with("at 1.00"), "{failure}");
        assert!(failure.ends_with(reason), "{failure}");
    }
}

/// A move, homing behind it and an absolute move behind that, all executed at once.
#[test]
fn homing_waits_for_a_move_and_a_move_for_homing() {
    let first =
        "[[call]]\nblock = \"MC_MoveRelative\"\nname = \"away\"\nstart = \"power.Status\"\ndistance = \"20 mm\"\n\n";
    let recording = changed(
        "homing.toml",
        &[
            (
                "[[call]]\nblock = \"MC_Home\"\n",
                &format!("{first}[[call]]\nblock = \"MC_Home\"\nbuffer_mode = \"buffered\"\n"),
            ),
            ("start = \"home.Done\"\ntimeout = \"5 s\"\n", "start = \"power.Status\"\nbuffer_mode = \"buffered\"\n"),
        ],
    );
    for (before, behind) in [("away", "home"), ("home", "move")] {
        let (done, active) = (when(&recording, before, "Done", "TRUE"), when(&recording, behind, "Active", "TRUE"));
        assert!((done - active).abs() < 1e-9, "{before} {done} {behind} {active}");
    }
    assert!(when(&recording, "axis", "state", "Homing") > when(&recording, "axis", "state", "DiscreteMotion"));
    // The reference of `a_homed_axis_moves_from_its_reference`.
    let made = recording.moves.last().unwrap_or_else(|| panic!("no move"));
    assert!((made.to - 0.2925).abs() < 1e-6, "{}", made.to);
    assert!((last(&recording, "load.position") - made.to).abs() < 1e-5);
}

/// Upwards only: the way back is refused; and no more upwards while the axis moves so: an error of the axis.
#[test]
fn power_permits_directions() {
    let back = ("position = \"400 mm\"", "position = \"100 mm\"");
    let power = "name = \"power\"\n";
    let recording = changed("figure-3a.toml", &[back, (power, &format!("{power}enable_negative = false\n"))]);
    let refused = when(&recording, "second", "Error", "TRUE");
    assert!((refused - when(&recording, "first", "Done", "TRUE")).abs() < 1e-9);
    assert!((when(&recording, "second", "ErrorID", &0x2004.to_string()) - refused).abs() < 1e-9);
    assert!((last(&recording, "task.position") - 0.24).abs() < 1e-9);

    let taken = format!("{power}updates = [{{ when = {{ at = \"0.5 s\" }}, enable_positive = false }}]\n");
    let recording = changed("figure-3a.toml", &[(power, &taken)]);
    let stopped = when(&recording, "axis", "state", "ErrorStop");
    // MC_Power is told in the cycle, and the axis looks at the next one.
    assert!((stopped - 0.5 - CYCLE).abs() < CYCLE + 1e-9, "{stopped}");
    when(&recording, "first", "ErrorID", &0x4004.to_string());
    assert!(never(&recording, "first", "Done"));
}

/// Position and velocity that the motion task commands at `t` (s).
fn commanded(recording: &Recording, t: f64) -> [f64; 2] {
    let channel = |name| recording.channel(name).unwrap_or_else(|| panic!("no channel {name}"));
    let tick = (0..1_000_000).position(|tick| f64::from(tick) * recording.rate.period() > t - 1e-9).unwrap_or_default();
    ["task.position", "task.velocity"].map(|name| channel(name)[tick])
}

/// Oracle: the table. Every position is commanded at its time, in the cycle on which it falls, by the spline and by plateaus.
#[test]
fn a_position_profile_meets_its_positions_at_their_times() {
    const POSITIONS: [f64; 11] = [0.0, 0.005, 0.02, 0.045, 0.07, 0.09, 0.1, 0.102, 0.101, 0.1, 0.1];
    let recording = run("position-profile.toml");
    for (call, from) in [("spline", 0.0), ("plateaus", 0.1)] {
        let start = when(&recording, call, "Execute", "TRUE");
        for (k, position) in POSITIONS.iter().enumerate() {
            let [x, _] = commanded(&recording, start + 0.05 * k as f64);
            // Sums of some hundred cycles.
            assert!((x - from - position).abs() < 1e-12, "{call} {k}: {x} {position}");
        }
        assert!((when(&recording, call, "Done", "TRUE") - start - 0.5).abs() < 1e-9);
    }
    assert!((last(&recording, "load.position") - 0.2).abs() < 1e-5);
}

/// Oracle: areas under the lines of velocity by hand.
#[test]
fn a_velocity_profile_goes_by_its_lines_and_keeps_the_last_velocity() {
    let recording = run("velocity-profile.toml");
    let start = when(&recording, "profile", "Execute", "TRUE");
    let points = [(0.1, 0.01, 0.2), (0.2, 0.03, 0.2), (0.3, 0.05, 0.2), (0.4, 0.0625, 0.05), (0.5, 0.0675, 0.05)];
    for (t, position, velocity) in points {
        let [x, v] = commanded(&recording, start + t);
        assert!((x - position).abs() < 1e-12 && (v - velocity).abs() < 1e-12, "{t}: {x} {v}");
    }
    assert!((when(&recording, "profile", "ProfileCompleted", "TRUE") - start - 0.4).abs() < 1e-9);
    // The halt begins 0.2 s later and brakes with the 8 m/s² of the scenario: v²/2a more.
    let end = 0.0725 + 0.05 * 0.05 / 16.0;
    assert!((last(&recording, "task.position") - end).abs() < 1e-9, "{}", last(&recording, "task.position"));
    assert!(when(&recording, "halt", "Done", "TRUE") > start + 0.6);
}

/// Largest difference of the set-points of two runs (SI).
fn apart(one: &Recording, other: &Recording) -> f64 {
    let differences = ["task.position", "task.velocity"].into_iter().flat_map(|name| {
        let [one, other] = [one, other].map(|of| of.channel(name).unwrap_or_else(|| panic!("no channel {name}")));
        assert_eq!(one.len(), other.len());
        one.iter().zip(other).map(|(one, other)| (one - other).abs())
    });
    differences.fold(0.0, f64::max)
}

/// Rounding of set-points (m, m/s): 1e-16 each of values and times below 1, added up in some hundred cycles, and the halt that
/// plans from there, as above.
const ROUNDING: f64 = 1e-12;

/// Oracle: the same table with the values that count, written out by hand. Each written value is `value_scale` · value + offset,
/// each time `time_scale` · time.
#[test]
fn a_scaled_table_is_the_table_written_out() {
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let table = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap_or_else(|error| panic!("{error}"));
    };
    let run_beside = |name: &str, changes: &[(&str, &str)]| {
        let scenario = scenario_in(folder.path(), &text_of(name, changes));
        run_bench(Bench::new(&scenario, &Exact).unwrap_or_else(|error| panic!("{error}")))
    };

    // 10 mm − 2 · value, at twice the time: ../setpoints/points.csv, absolute along the spline and relative by plateaus.
    table(
        "x.csv",
        "time [ms],position [mm]\n0,5\n25,2.5\n50,-5\n75,-17.5\n100,-30\n125,-40\n150,-45\n175,-46\n200,-45.5\n225,-45\n250,-45\n",
    );
    let scales = "time_scale = 2\nvalue_scale = -2\nposition_offset = \"10 mm\"\n";
    let scaled = run_beside(
        "position-profile.toml",
        &[
            ("table = { file = \"../setpoints/points.csv\" }\n", &format!("table = {{ file = \"x.csv\" }}\n{scales}")),
            (
                "table = { file = \"../setpoints/points.csv\", relative = true, follow = \"plateaus\", plateau_share = 0.3 }\n",
                &format!(
                    "table = {{ file = \"x.csv\", relative = true, follow = \"plateaus\", plateau_share = 0.3 }}\n{scales}"
                ),
            ),
        ],
    );
    let positions = apart(&scaled, &run("position-profile.toml"));

    // 120 mm/s − value/2, at half the time: velocities.csv.
    table("v.csv", "time [ms],velocity [mm/s]\n200,-160\n600,-160\n800,140\n");
    let scales = "time_scale = 0.5\nvalue_scale = \"-50 %\"\nvelocity_offset = \"120 mm/s\"\n";
    let scaled = run_beside(
        "velocity-profile.toml",
        &[("table = { file = \"velocities.csv\" }\n", &format!("table = {{ file = \"v.csv\" }}\n{scales}"))],
    );
    let velocities = apart(&scaled, &run("velocity-profile.toml"));

    // 1 m/s² + 4 · value, at a quarter of the time.
    table("written.csv", "time [ms],acceleration [m/s2]\n0,0\n100,3\n200,0\n");
    table("a.csv", "time [ms],acceleration [m/s2]\n0,-0.25\n400,0.5\n800,-0.25\n");
    let scales = "time_scale = 0.25\nvalue_scale = 4\nacceleration_offset = \"1 m/s2\"\n";
    let [scaled, written] = [("a.csv", scales), ("written.csv", "")].map(|(file, scales)| {
        run_beside(
            "velocity-profile.toml",
            &[
                ("block = \"MC_VelocityProfile\"", "block = \"MC_AccelerationProfile\""),
                ("table = { file = \"velocities.csv\" }\n", &format!("table = {{ file = \"{file}\" }}\n{scales}")),
            ],
        )
    });
    let start = when(&written, "profile", "Execute", "TRUE");
    let [_, kept] = commanded(&written, start + 0.3);
    // The area of a triangle of 3 m/s² over 0.2 s.
    assert!((kept - 0.3).abs() < ROUNDING, "{kept}");
    let accelerations = apart(&scaled, &written);

    println!("set-points apart: {positions:.1e}, {velocities:.1e}, {accelerations:.1e}");
    assert!([positions, velocities, accelerations].iter().all(|apart| *apart < ROUNDING));
}

/// Oracle: the targets; and the samples of the plan, by the closed form of a move that reaches all limits but that of the velocity
/// in whole samples: d/v + v/a + a/j + j/s.
#[test]
fn the_generator_of_fourth_order_ends_on_its_targets() {
    let recording = run("profile-4th.toml");
    let (there, back) = (when(&recording, "there", "Done", "TRUE"), when(&recording, "back", "Done", "TRUE"));
    let moves: Vec<_> = recording.moves.iter().map(|made| (made.from, made.to)).collect();
    assert_eq!(moves.len(), 2, "{moves:?}");
    assert!((moves[0].1 - 0.25).abs() < 1e-15 && moves[1].1.abs() < 1e-15, "{moves:?}");
    let [x, v] = commanded(&recording, there);
    assert!((x - 0.25).abs() < 1e-15 && v.to_bits() == 0, "{x} {v}");
    // 0.25/0.5 + 0.5/5 + 5/100 + 100/5000 = 0.67 s and the settling time; a cycle from the edge to the start, and as `t_exec` is
    // half a cycle less than a whole number of them from there on, one more to the first that is beyond both.
    let duration = there - when(&recording, "there", "Enable", "TRUE");
    assert!((duration - 0.67 - 0.05 - 2.0 * CYCLE).abs() < 1e-9, "{duration}");
    let state = |name: &str| when(&recording, "axis", "state", name);
    assert!(state("DiscreteMotion") < there && back > there);
    assert!(last(&recording, "load.position").abs() < 1e-5);
}

/// The second call repeats the first while that brakes to its end velocity: the set-point went back at 0.287 m/s.
#[test]
fn a_continuous_move_called_again_turns_round_nowhere() {
    let axis = "[run]\nbase_rate = \"16 kHz\"\nduration = \"0.8 s\"\n[axis]\nmodel = \"ball-screw\"\n[motor]\n\
        model = \"wittenstein-premo-1f\"\n[drive]\nmodel = \"servo-16khz\"\ndc_link = \"320 V\"\nmax_torque = \"6.09 Nm\"\n\
        [bus]\ncycle = \"1 ms\"\nunits = { drive = 1, axis = \"100 nm\" }\n[setpoint]\norder = 3\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\n\
        jerk = \"100 m/s3\"\n[plc]\nhoming_required = false\n[[call]]\nblock = \"MC_Power\"\nname = \"power\"\n\
        [[call]]\nblock = \"MC_HomeDirect\"\nname = \"here\"\nstart = \"power.Status\"\nposition = \"0 mm\"\n";
    for (sign, delay) in [(1, 274), (-1, 274), (1, 120), (1, 260)] {
        let call = |name: &str, start: &str| {
            format!(
                "[[call]]\nblock = \"MC_MoveContinuousAbsolute\"\nname = \"{name}\"\nstart = {start}\nposition = \"{} mm\"\n\
                 end_velocity = \"{} m/min\"\nvelocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\ndeceleration = \"5 m/s2\"\n\
                 jerk = \"100 m/s3\"\n",
                100 * sign,
                20 * sign
            )
        };
        let second = format!("{{ after = \"here.Done\", delay = \"{delay} ms\" }}");
        let text = format!("{axis}{}{}", call("first", "\"here.Done\""), call("second", &second));
        let recording = rig::run(&text);
        let velocity = recording.channel("setpoint.velocity").unwrap();
        let back = velocity.iter().map(|v| f64::from(sign) * v).fold(f64::MAX, f64::min);
        assert!(back >= -1e-9, "again after {delay} ms: back at {back} m/s");
        assert!((last(&recording, "setpoint.velocity") - f64::from(sign) / 3.0).abs() < 1e-3);
    }
}
