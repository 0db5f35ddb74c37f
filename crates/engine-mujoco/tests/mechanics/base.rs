//! Chains behind a prescribed base.
use super::{STEP, body, motion, mujoco, ticks};
use servobench_base::{Coordinate, Setpoint};
use servobench_plant::{Chain, Drive, Link};
use std::f64::consts::TAU;

/// Amplitude (m) that a 1 m move of three or four moving averages leaves on an undamped mode of `frequency` (Hz).
///
/// A profile whose n-th derivative switches on and off at all partial sums of the lengths `boxes` is a step through n moving averages.
fn residual(boxes: &[f64], frequency: f64) -> f64 {
    let w = TAU * frequency;
    let link = Link { stiffness: 10.0 * w * w, damping: 0.0 };
    let bodies = vec![body("motor", Coordinate::Linear, 20.0), body("load", Coordinate::Linear, 10.0)];
    let chain = Chain::new(bodies, vec![link]).unwrap();
    let mut mechanics = mujoco(chain, Drive::Prescribed, STEP, &[]);
    let height = 1.0 / boxes.iter().product::<f64>();
    let switches: Vec<(usize, f64)> = (0..1_usize << boxes.len())
        .map(|set| {
            let members = (0..boxes.len()).filter(|i| set & (1 << i) != 0);
            let time: f64 = members.map(|i| boxes[i]).sum();
            let sign = if set.count_ones() % 2 == 0 { 1.0 } else { -1.0 };
            (ticks(time, STEP), sign * height)
        })
        .collect();
    let mut setpoint = Setpoint::default();
    for k in 0..=ticks(boxes.iter().sum(), STEP) {
        for (_, change) in switches.iter().filter(|(tick, _)| *tick == k) {
            if boxes.len() == 3 { setpoint.j += change } else { setpoint.s += change }
        }
        mechanics.advance(&motion(setpoint)).unwrap();
        setpoint = setpoint.after(STEP);
    }
    let (y, v) = (mechanics.bodies()[1].position - setpoint.x, mechanics.bodies()[1].velocity - setpoint.v);
    y.hypot(v / w)
}

/// Oracle: X·∏|sin(ωT/2)/(ωT/2)|. The move of Lambrechts under a jerk and under a snap limit, at its own mode and at frequencies where much
/// is left. The bench requires 1 %; a base that is right in the mean only would be off by (ω·h)²/12 = 2e-5, and beside the zero at 39 Hz
/// RK4's error of the frequency, 4.6e-10, counts 2600 times.
#[test]
fn residual_vibration_is_that_of_the_closed_form() {
    let jerk_limited = [1.0, 0.2, 0.1];
    let snap_limited = [1.0, 0.2, 0.1, 0.05];
    for (boxes, frequencies) in
        [(&jerk_limited[..], [38.985, 12.5, 17.3, 22.4]), (&snap_limited, [38.985, 12.5, 17.3, 7.7])]
    {
        for frequency in frequencies {
            let sinc = |t: f64| (TAU * frequency * t / 2.0).sin() / (TAU * frequency * t / 2.0);
            let exact: f64 = boxes.iter().map(|&t| sinc(t).abs()).product();
            let measured = residual(boxes, frequency);
            let error = measured / exact - 1.0;
            assert!(error.abs() < 1e-5, "{frequency} Hz: {measured:e} instead of {exact:e}: {error:e}");
        }
    }
}
