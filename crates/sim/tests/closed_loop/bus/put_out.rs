//! What the master puts out between the samples of the motion task.
use crate::rig::{BUS, MOVE, SCREW, last, run, values};
use servobench_trace::Recording;

/// Base ticks per cycle of the bus and of the motion task.
const CYCLE: usize = 16;
const TASK: usize = 20 * CYCLE;

fn recorded(more: &str) -> Recording {
    run(&format!("{SCREW}{BUS}motion_cycle = \"20 ms\"\ninterpolation = \"cubic\"\n{more}{MOVE}"))
}

/// Oracle: the Hermite cubic by the positions and velocities that the motion task gave at both ends, a cycle of the task later.
#[test]
fn it_is_the_cubic_between_the_samples_of_the_task_held_for_a_cycle() {
    let recording = recorded("");
    let of = |name| values(&recording, name);
    let (x, v) = (of("task.position"), of("task.velocity"));
    let [position, velocity, acceleration] = ["link.position", "link.velocity", "link.acceleration"].map(of);
    let t = TASK as f64 / 16e3;
    // The drive comes to power in the first cycles.
    for tick in 5 * TASK..recording.len() {
        let put_out = tick / CYCLE * CYCLE;
        let from = (put_out / TASK - 1) * TASK;
        let u = (put_out - from - TASK) as f64 / TASK as f64;
        let (x0, x1, v0, v1) = (x[from], x[from + TASK], v[from] * t, v[from + TASK] * t);
        let (c2, c3) = (3.0 * (x1 - x0) - 2.0 * v0 - v1, v0 + v1 - 2.0 * (x1 - x0));
        let expected = [
            x0 + u * (v0 + u * (c2 + u * c3)),
            (v0 + u * (2.0 * c2 + 3.0 * u * c3)) / t,
            (2.0 * c2 + 6.0 * u * c3) / (t * t),
        ];
        let found = [position[tick], velocity[tick], acceleration[tick]];
        // A few roundings of 0.25 m, divided by t once more for each derivative.
        let bounds = [1e-15, 1e-13, 1e-11];
        let apart: Vec<f64> = expected.iter().zip(found).map(|(expected, found)| (expected - found).abs()).collect();
        assert!(apart.iter().zip(bounds).all(|(apart, bound)| *apart < bound), "{tick}: {found:?} for {expected:?}");
    }
}

/// Oracle: rounding. What the drive follows at the seams of its own lines is what was put out a cycle of the bus and its way
/// before, to the nearest of its units; what was put out is not.
#[test]
fn it_is_not_rounded_to_the_units_of_the_drive() {
    let unit = 10e-6;
    let recording = recorded("units = { drive = 100, axis = \"1 mm\" }\n");
    let [put_out, followed] = ["link.position", "setpoint.position"].map(|name| values(&recording, name));
    let way = 2 * CYCLE;
    let seams = (5 * TASK..recording.len()).step_by(CYCLE);
    let (mut most, mut rounded, mut moving) = (0.0_f64, 0, 0);
    let a = values(&recording, "link.acceleration");
    for tick in seams {
        let apart = followed[tick] - put_out[tick - way];
        most = most.max(apart.abs());
        let counts = put_out[tick] / unit;
        if a[tick].abs() > 1.0 {
            moving += 1;
            rounded += usize::from((counts - counts.round()).abs() < 1e-3);
        }
        let of_drive = followed[tick] / unit;
        assert!((of_drive - of_drive.round()).abs() < 1e-6, "{tick}: {of_drive}");
    }
    println!("{most:.2e} m apart at most, {rounded} values whole");
    assert!(most <= unit / 2.0 + 1e-12 && most > unit / 4.0, "{most}");
    assert!((last(&recording, "link.position") - 0.25).abs() < 1e-15);
    // Two in a thousand are whole to that by chance.
    assert!(moving > 150 && rounded < moving / 20, "{rounded} of {moving}");
}

/// Oracle: the torque of the source is linear in every interpolation: no second difference within a cycle of the task; and it is the
/// inertia times the acceleration beside friction, which has the same sign in both directions of acceleration.
#[test]
fn its_effort_is_linear_between_the_samples() {
    let with = recorded("");
    let [a, effort] = ["link.acceleration", "link.effort"].map(|name| values(&with, name));
    let at = |cycle: usize| effort[cycle * CYCLE];
    for cycle in 100..with.len() / CYCLE - 2 {
        if cycle % 20 < 18 {
            let bend = at(cycle + 2) - 2.0 * at(cycle + 1) + at(cycle);
            assert!(bend.abs() < 1e-14, "{cycle}: {bend}");
        }
    }
    let mean = |sign: f64| {
        let there = a.iter().zip(effort).filter(|(a, _)| sign * **a > 4.99).map(|(_, effort)| *effort);
        there.clone().sum::<f64>() / there.count() as f64
    };
    println!("{} N m accelerating, {} N m braking", mean(1.0), mean(-1.0));
    assert!(mean(1.0) > 0.5 && mean(-1.0) < -0.5 && mean(1.0) + mean(-1.0) > 0.0);
    let without = run(&format!("{SCREW}[bus]\ncycle = \"1 ms\"\n{MOVE}"));
    // Until the drive follows it is the actual one.
    let link = values(&without, "link.effort");
    let running =
        without.signal("link", "interpolation").unwrap().changes.iter().find(|(_, state)| state == "Run1").unwrap().0;
    assert!(link[without.index_at(running)..].iter().all(|effort| effort.abs() < f64::MIN_POSITIVE));
}

#[test]
fn without_a_bus_there_is_none() {
    let recording = run(&format!("{SCREW}{MOVE}"));
    for name in ["link.position", "link.velocity", "link.acceleration", "link.effort"] {
        assert!(recording.channel(name).is_none(), "{name}");
    }
}
