//! The program of a scenario as the drive sees it, tick by tick, against what each generator promises.
use servobench_base::{Rate, Setpoint, Tick};
use servobench_motion::pvt::{Knot, Table, continuous};
use servobench_motion::shape::{Impulses, Vibration};
use servobench_motion::{Limits, Order, Profile};
use servobench_scenario::{Scenario, parse};
use servobench_sim::{BuildError, Program};
use std::f64::consts::TAU;

/// A motor that follows its set-point exactly, at 8 kHz.
const AXIS: &str = r#"
[run]
base_rate = "8 kHz"
[axis]
motion = "linear"
[motor]
kind = "prescribed"
[setpoint]
order = 4
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "50 m/s3"
snap = "1000 m/s4"
"#;
const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
const TICK: f64 = 1.0 / 8e3;

fn scenario(rest: &str) -> Scenario {
    let folder = tempfile::tempdir().unwrap();
    let points = "time [ms],position [mm]\n0,0\n50,1\n100,4\n150,3\n250,5\n";
    std::fs::write(folder.path().join("points.csv"), points).unwrap();
    parse("test.toml", &format!("{AXIS}{rest}"), Some(folder.path())).unwrap_or_else(|e| panic!("{e}")).scenario
}

/// The set-points of every tick until a tenth of a second after the end, and the times of the moves.
fn run(rest: &str) -> (Vec<Setpoint>, Vec<(f64, f64)>) {
    let scenario = scenario(rest);
    let mut program = Program::new(&scenario).unwrap();
    let Tick(last) = scenario.base_rate.tick_at(program.end() + 0.1);
    let setpoints = (0..=last).map(|k| program.at(scenario.base_rate.time(Tick(k)))).collect();
    let moves = program.moves().map(|made| (made.start, made.end)).collect();
    (setpoints, moves)
}

/// Whether nothing jumps that the order promises to be continuous, and the limits are kept. What the highest derivative
/// can change within a tick bounds the change of the next lower one, and so on.
fn is_smooth(setpoints: &[Setpoint], limits: [f64; 4]) {
    for (k, pair) in setpoints.windows(2).enumerate() {
        let [one, two] = [pair[0], pair[1]].map(|Setpoint { x, v, a, j, s }| [x, v, a, j, s]);
        for n in 0..4 {
            let most = limits[n] * TICK * (1.0 + 1e-9);
            assert!((two[n] - one[n]).abs() <= most, "derivative {n} at tick {k}: {} {}", one[n], two[n]);
            assert!(two[n + 1].abs() <= limits[n] * (1.0 + 1e-9), "derivative {} at tick {k}: {}", n + 1, two[n + 1]);
        }
    }
}

/// The second move of MC_MoveAbsolute takes over while the first one runs (figure 3b of Pietrusewicz et al. 2019).
#[test]
fn an_aborting_move_takes_over_in_motion() {
    let text = "[[program]]\nmove_to = \"1 m\"\n[[program]]\nmove_to = \"0.2 m\"\naborts_after = \"0.3 s\"\n";
    for online in ["", "online = \"refined\"\n"] {
        let (setpoints, moves) = run(&format!("{text}{online}"));
        is_smooth(&setpoints, [1.0, 5.0, 50.0, 1000.0]);
        let alone = Profile::plan(Order::Fourth, 1.0, &LIMITS).unwrap();
        for (k, setpoint) in (0..=2400_u32).zip(&setpoints) {
            assert!((setpoint.x - alone.at(f64::from(k) * TICK).x).abs() < 1e-12, "{k}");
        }
        assert!((moves[0].1 - 0.3).abs() < 1e-12 && (moves[1].0 - 0.3).abs() < 1e-12, "{moves:?}");
        assert_eq!(*setpoints.last().unwrap(), Setpoint::at_rest(0.2));
    }
}

/// Oracle: by hand. At 0.3 s the axis is at 0.125 m with 0.5 m/s; it stops in 0.1 s at 0.15 m, and goes back 0.1 m in 0.1/0.5 + 0.5/5 s.
#[test]
fn an_aborting_move_of_order_2_takes_over_in_motion() {
    let limits = "order = 2\nvelocity = \"0.5 m/s\"\n";
    let (setpoints, moves) = run(&format!(
        "[[program]]\nmove_to = \"1 m\"\n{limits}[[program]]\nmove_to = \"50 mm\"\naborts_after = \"0.3 s\"\n{limits}"
    ));
    // Of order 2 the velocity is continuous, the acceleration is not.
    is_smooth(&setpoints, [0.5, 5.0, f64::INFINITY, f64::INFINITY]);
    assert!((moves[1].0 - 0.3).abs() < 1e-12 && (moves[1].1 - 0.7).abs() < 1e-12, "{moves:?}");
    for (tick, x, v) in
        [(2400, 0.125, 0.5), (3200, 0.15, 0.0), (4000, 0.125, -0.5), (4800, 0.075, -0.5), (5600, 0.05, 0.0)]
    {
        let at = setpoints[tick];
        assert!((at.x - x).abs() < 1e-12 && (at.v - v).abs() < 1e-12, "tick {tick}: {at:?}");
    }
    assert_eq!(*setpoints.last().unwrap(), Setpoint::at_rest(0.05));
}

/// Commanded again while it brakes to the velocity at which it passes its target, the move turned round there and took 1.7 s. Oracle: the
/// same program without the second command.
#[test]
fn a_move_commanded_again_keeps_its_way() {
    let limits = "velocity = \"0.5 m/s\"\nacceleration = \"5 m/s2\"\njerk = \"100 m/s3\"\nsnap = \"5000 m/s4\"\n";
    for (order, sign) in [(2, 1), (3, 1), (4, 1), (3, -1), (4, -1)] {
        let limits = limits.lines().take(order).collect::<Vec<_>>().join("\n");
        let axis = format!("{}[setpoint]\norder = {order}\n{limits}\n", AXIS.split("[setpoint]").next().unwrap());
        let first = format!("[[program]]\nmove_to = \"{} mm\"\nend_velocity = \"{} m/min\"\n", sign * 100, sign * 20);
        let last = format!("[[program]]\nmove_to = \"{} mm\"\n", sign * 400);
        let program = |again: &str| {
            let text = format!("{axis}{first}{again}{last}");
            let scenario = parse("test.toml", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
            Program::new(&scenario).unwrap()
        };
        let (once, first_lasts) = (program("").end(), program("").durations().next().unwrap());
        for share in [0.23, 0.8, 0.93, 0.999] {
            let after = share * first_lasts;
            let mut again = program(&format!("{first}aborts_after = \"{after} s\"\n"));
            assert!(
                (again.end() - once).abs() < 1e-9,
                "order {order}, again after {after}: {} for {once}",
                again.end()
            );
            let back = (0..16_000).map(|k| f64::from(sign) * again.at(f64::from(k) * TICK).v).fold(f64::MAX, f64::min);
            assert!(back >= -1e-12, "order {order}, again after {after}: back at {back} m/s");
        }
    }
}

#[test]
fn what_has_ended_cannot_be_aborted() {
    let text = "[[program]]\nmove_to = \"1 m\"\n[[program]]\nmove_to = \"0 m\"\naborts_after = \"1.4 s\"\n";
    let error = Program::new(&scenario(text)).unwrap_err();
    assert!(matches!(error, BuildError::NothingToAbort { index: 1, .. }), "{error:?}");
    assert_eq!(
        error.to_string(),
        "program step 2: `aborts_after` is 1.4 s, but the move before lasts 1.35 s: abort it earlier, or let this move \
         follow without `aborts_after`"
    );
}

/// A target passed at a velocity, a velocity held, and back to rest: the axis never stops on the way.
#[test]
fn moves_follow_each_other_in_motion() {
    let (setpoints, moves) = run("[[program]]\nmove_to = \"0.5 m\"\nend_velocity = \"0.4 m/s\"\n\
         [[program]]\nreach_velocity = \"-0.6 m/s\"\nhold = \"0.25 s\"\n\
         [[program]]\nmove_to = \"0 m\"\nnegative_velocity = \"0.7 m/s\"\n");
    is_smooth(&setpoints, [1.0, 5.0, 50.0, 1000.0]);
    let rate = Rate::from_hertz(8e3).unwrap();
    let at = |t: f64| setpoints[usize::try_from(rate.tick_at(t).0).unwrap()];
    // The tick beside the instant: at most half a tick at 0.4 m/s.
    assert!((at(moves[0].1).x - 0.5).abs() < 0.4 * TICK && (at(moves[0].1).v - 0.4).abs() < 5.0 * TICK);
    let held = moves[1].1 - 0.25;
    for t in [held + TICK, moves[1].1 - TICK] {
        assert!((at(t).v + 0.6).abs() < 1e-12 && at(t).a.abs() < 1e-12, "{t}: {:?}", at(t));
    }
    assert!((at(moves[1].1).x - at(held).x + 0.15).abs() < 0.6 * 2.0 * TICK);
    assert_eq!(*setpoints.last().unwrap(), Setpoint::at_rest(0.0));
    assert!(setpoints.iter().all(|at| at.v >= -0.7 * (1.0 + 1e-9)) && setpoints.iter().any(|at| at.v < -0.699));
}

/// What a recording says of a move whose limits differ between the directions is that of the direction that uses more of its own.
#[test]
fn peaks_stand_beside_the_limits_of_their_direction() {
    let text = "[[program]]\nmove_to = \"-1 m\"\nonline = \"fast\"\nnegative_velocity = \"0.7 m/s\"\n";
    let made = Program::new(&scenario(text)).unwrap().moves().next().unwrap();
    assert_eq!(made.limits, [Some(0.7), Some(5.0), Some(50.0), Some(1000.0)]);
    assert!((made.peaks[0] - 0.7).abs() < 1e-9 && made.label.ends_with("order 4 online"), "{made:?}");
}

/// Oracle: the shaper's own sum of the profile.
#[test]
fn a_shaped_move_is_the_sum_of_its_parts_and_next_waits_for_it() {
    let (setpoints, moves) =
        run("method = \"optimal\"\nshaper = { kind = \"zvdd\", frequency = \"12 Hz\", damping = 0.05 }\n\
         [[program]]\nmove_to = \"20 mm\"\n[[program]]\nmove_to = \"0 mm\"\n");
    let profile = Profile::plan_optimal(Order::Fourth, 0.02, &LIMITS).unwrap();
    let shaper = Impulses::zvdd(&Vibration::new(TAU * 12.0, 0.05).unwrap());
    assert!((moves[0].1 - profile.duration() - shaper.duration()).abs() < 1e-12);
    for (k, setpoint) in setpoints.iter().enumerate().take_while(|(k, _)| *k as f64 * TICK < moves[0].1) {
        let expected = shaper.shape(k as f64 * TICK, |t| profile.at(t));
        assert!((setpoint.x - expected.x).abs() < 1e-15 && (setpoint.a - expected.a).abs() < 1e-9, "{k}");
    }
    is_smooth(&setpoints, [1.0, 5.0, 50.0, 1000.0]);
    assert_eq!(*setpoints.last().unwrap(), Setpoint::at_rest(0.0));
}

/// Averages of 10 ms and 5 ms are 80 and 40 ticks of 8 kHz: trapezoid to jerk- to snap-limited. Oracle: means written down.
#[test]
fn averages_are_means_of_the_last_ticks() {
    let (setpoints, moves) = run("averages = [\"10 ms\", \"5 ms\"]\n[[program]]\nmove_to = \"0.3 m\"\norder = 2\n");
    let profile = Profile::plan(Order::Second, 0.3, &LIMITS).unwrap();
    assert!((moves[0].1 - profile.duration() - 0.015).abs() < 1e-12);
    for k in (0..setpoints.len()).step_by(97) {
        let mean = |from: i64, n: i64, of: &dyn Fn(i64) -> f64| (0..n).map(|i| of(from - i)).sum::<f64>() / n as f64;
        let plain = |k: i64| profile.at(k as f64 * TICK).x;
        let expected = mean(i64::try_from(k).unwrap(), 40, &|k| mean(k, 80, &plain));
        assert!((setpoints[k].x - expected).abs() < 1e-13, "{k}: {} {expected}", setpoints[k].x);
    }
}

/// Oracle: the cubic spline itself; and the drive that obeys velocities stays as near to it as it was announced.
#[test]
fn a_table_is_followed_from_where_the_axis_is() {
    let table = |keys: &str| {
        format!(
            "[[program]]\nmove_to = \"10 mm\"\n[[program]]\ntable = {{ file = \"points.csv\", relative = true, {keys} }}\n"
        )
    };
    let points = [(0.0, 0.0), (0.05, 1e-3), (0.1, 4e-3), (0.15, 3e-3), (0.25, 5e-3)];
    let mut knots = points.map(|(t, x)| Knot::new(t, x));
    continuous(&mut knots, 0.0, 0.0, &mut [0.0; 5]).unwrap();
    let spline = Table::new(&knots).unwrap();
    for (keys, most) in
        [("velocities = \"continuous\"", 1e-15), ("follow = \"steps\", command_rate = \"400 Hz\"", 3e-6)]
    {
        let (setpoints, moves) = run(&table(keys));
        assert!((moves[1].1 - moves[1].0 - 0.25).abs() < 1e-12);
        for (k, setpoint) in setpoints.iter().enumerate() {
            let since = k as f64 * TICK - moves[1].0;
            if since > 0.0 {
                let off = setpoint.x - 0.01 - spline.at(since.min(0.25)).x;
                assert!(off.abs() <= most, "{keys} at {since}: {off}");
            }
        }
    }
    let elsewhere = table("velocities = \"average\"").replace("relative = true, ", "");
    let error = Program::new(&scenario(&elsewhere)).unwrap_err().to_string();
    assert_eq!(
        error,
        "program step 2: point 0: `position` must be where the axis is when the move starts, got 0: begin the table there, \
         or move to its first point before"
    );
}

/// K. T. Erickson's example, 100 mm at 200 mm/s with 100 m/s² and 25 % of the time: 2.2857 ms each way.
#[test]
fn rockwells_move_has_its_times() {
    let (_, moves) = run("[[program]]\nmove_to = \"100 mm\"\nvelocity = \"200 mm/s\"\nacceleration = \"100 m/s2\"\n\
         rockwell = { shape = \"s-curve\", jerk_of_time = \"25 %\" }\n");
    let ramp: f64 = 2.0 / 0.875 * 1e-3;
    // The ramps cover half a ramp's time at full speed each.
    assert!((moves[0].1 - (0.5 + ramp)).abs() < 1e-12, "{moves:?}");
}

/// Every mode has, its delay later, what the slow task commanded: bit for bit at the commands where it passes through them.
#[test]
fn interpolation_is_late_by_what_its_mode_says() {
    let program = "[[program]]\nmove_to = \"0.3 m\"\n";
    let (direct, moves) = run(program);
    for (mode, delay, off) in [
        ("linear", 1, 1e-15),
        ("cubic", 1, 1e-15),
        ("quintic", 1, 1e-15),
        // a·T²·(n + 1)/24 at 5 m/s² and 2 ms.
        ("cubic-b-spline", 2, 5.0 * 4e-6 * 4.0 / 24.0),
        ("quintic-b-spline", 3, 5.0 * 4e-6 * 6.0 / 24.0),
        ("all-linear", 1, 1e-15),
        ("all-cubic", 1, 1e-15),
    ] {
        let (fine, late) = run(&format!("interpolation = {{ mode = \"{mode}\", period = \"2 ms\" }}\n{program}"));
        let ticks = 16 * delay;
        assert!((late[0].1 - moves[0].1 - 2e-3 * delay as f64).abs() < 1e-12, "{mode}: {late:?}");
        for (k, setpoint) in fine.iter().enumerate().skip(ticks).step_by(16) {
            let Some(commanded) = direct.get(k - ticks) else { break };
            assert!(
                (setpoint.x - commanded.x).abs() <= off * (1.0 + 1e-9),
                "{mode} at {k}: {} {}",
                setpoint.x,
                commanded.x
            );
        }
        assert_eq!(fine.last().map(|at| (at.x, at.v)), Some((0.3, 0.0)), "{mode}");
    }
}

/// Forward Euler, (72)–(75): it comes to rest at the same sample, and lags by 1.5 samples on the way.
#[test]
fn samples_are_executed_as_they_are_named() {
    let text = |execution: &str| {
        format!("sample_time = \"1 ms\"\nexecution = \"{execution}\"\n[[program]]\nmove_to = \"1 m\"\n")
    };
    let ((hold, _), (euler, moves)) = (run(&text("hold")), run(&text("euler")));
    assert!((moves[0].1 - 1.35).abs() < 1e-12, "{moves:?}");
    // In the cruise at 1 m/s.
    let k = 8 * 675;
    assert!((hold[k].x - euler[k].x - 1.5e-3).abs() < 1e-12, "{} {}", hold[k].x, euler[k].x);
    assert_eq!(*euler.last().unwrap(), Setpoint::at_rest(1.0));
}
