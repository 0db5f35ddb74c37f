//! Running ahead of the samples: the delay is so many cycles shorter, and unpredicted changes of the motion are an error.
use crate::rig::{BUS, MOTION, RATE, Rig, follow, sample, settings};
use servobench_base::{Setpoint, Tick};
use servobench_fieldbus::Interpolation;
use servobench_fieldbus::link::{Params, Settings};
use servobench_motion::interpolate::Mode;
use servobench_motion::{Limits, Order, Profile};

/// Cycles of the motion task before the motion, in which the drive comes to power.
const BEFORE: u64 = 12;
/// Cycle of the motion task (s).
const T: f64 = MOTION as f64 / RATE;

/// Every interpolation with each number of cycles by which it can run ahead.
fn all() -> impl Iterator<Item = (Mode, u32)> {
    let most = |mode: Mode| u32::try_from(mode.delay_samples().min(2)).unwrap();
    Mode::ALL.into_iter().flat_map(move |mode| (0..=most(mode)).map(move |ahead| (mode, ahead)))
}

fn rig(mode: Mode, run_ahead: u32, margin: u32) -> Rig {
    Rig::new(Settings { interpolation: mode, run_ahead, margin, ..settings() })
}

/// Time of the motion at a tick, less `delay` (s).
fn time(tick: u64, delay: u64) -> f64 {
    (tick as f64 - delay as f64 - (BEFORE * MOTION) as f64) / RATE
}

/// Runs `motion`, a function of the time since its start, for `cycles`; the largest error to the delayed motion from the cycle `from` on.
fn largest_error(rig: &mut Rig, cycles: u64, from: u64, motion: impl Fn(f64) -> Setpoint) -> f64 {
    let delay = rig.params.delay();
    let mut largest = 0.0_f64;
    for _ in 0..BEFORE + cycles {
        rig.write(rig.tick, follow(sample(motion(time(rig.tick, 0)))));
        for _ in 0..MOTION / BUS {
            rig.cycle();
            let t = time(rig.tick - BUS, delay);
            if t >= from as f64 * T {
                largest = largest.max((rig.setpoint().x - motion(t).x).abs());
            }
        }
    }
    largest
}

/// Oracle: the definition, (points/2 − ahead)·cycle + margin.
#[test]
fn the_delay_is_as_many_cycles_shorter() {
    for (mode, ahead) in all() {
        for margin in [0, 40] {
            let delay = rig(mode, ahead, margin).params.delay();
            assert_eq!(
                delay,
                (mode.delay_samples() as u64 - u64::from(ahead)) * MOTION + u64::from(margin),
                "{mode:?}"
            );
        }
    }
    let too_far = Params::new(Settings { interpolation: Mode::Cubic, run_ahead: 2, ..settings() }).unwrap_err();
    assert_eq!(
        too_far.to_string(),
        "`run_ahead` must be at most 1 cycles of the motion task with this interpolation, got 2: that leaves no delay to take out"
    );
}

/// Oracle: a constant velocity, which every mode predicts, and a constant acceleration, which the parabola of a sample predicts. The
/// remaining difference is below the threshold of a correction, a thousandth of a unit.
#[test]
fn what_is_predicted_exactly_costs_nothing() {
    for (mode, ahead) in all() {
        let uses_velocity = !matches!(mode, Mode::Linear | Mode::CubicBSpline | Mode::QuinticBSpline);
        for (a, from) in [(0.0, 0), (1.0, 40)] {
            if a > 0.0 && (!uses_velocity || mode == Mode::AllLinear) {
                continue;
            }
            let motion = |t: f64| Setpoint { v: 0.2 + a * t, a, ..Setpoint::at_rest(0.2 * t + a / 2.0 * t * t) };
            let mut rig = rig(mode, ahead, 0);
            // The axis is brought to the velocity first.
            let error =
                largest_error(&mut rig, 100, from.max(40), |t| if t < 0.0 { Setpoint::default() } else { motion(t) });
            assert!(error < 2e-9, "{mode:?}, {ahead} ahead, {a} m/s²: {error:.2e} m");
        }
    }
}

/// Oracle: j·t³/6 from rest. In its first cycle the axis is predicted to rest, so the error at the end of it is all of j·T³/6.
#[test]
fn a_jerk_costs_a_sixth_of_its_cube_in_the_first_cycle() {
    let jerk = 40.0;
    for mode in [Mode::Cubic, Mode::Quintic, Mode::AllCubic] {
        let mut rig = rig(mode, 1, 0);
        let motion = |t: f64| {
            let t = t.max(0.0);
            Setpoint { x: jerk / 6.0 * t * t * t, v: jerk / 2.0 * t * t, a: jerk * t, ..Setpoint::default() }
        };
        rig.run(BEFORE, |_| follow(sample(Setpoint::default())));
        for _ in 0..MOTION / BUS {
            if rig.tick.is_multiple_of(MOTION) {
                rig.write(rig.tick, follow(sample(motion(time(rig.tick, 0)))));
            }
            rig.cycle();
            let t = time(rig.tick - BUS, 0);
            let error = motion(t).x - rig.setpoint().x;
            assert!((error - jerk / 6.0 * t.powi(3)).abs() < 1e-15, "{mode:?}, {t}: {error}");
        }
    }
}

/// A metre with jerk and snap limits: the errors measured here are given in docs/fieldbus.md, as multiples of a·T² for modes that predict
/// along a line and of j·T³/6 for the others.
#[test]
fn the_error_on_a_move_is_that_of_the_prediction() {
    let limits = Limits { velocity: 1.0, acceleration: 4.0, jerk: 40.0, snap: 1000.0 };
    let profile = Profile::plan(Order::Fourth, 1.0, &limits).unwrap();
    for (mode, ahead) in all() {
        let mut rig = rig(mode, ahead, 0);
        let error = largest_error(&mut rig, 100, 0, |t| profile.at(t.clamp(0.0, profile.duration())));
        let (line, parabola) = (limits.acceleration * T * T, limits.jerk * T * T * T / 6.0);
        println!("{mode:?} {ahead}: {error:.2e} m, {:.2} a·T², {:.2} j·T³/6", error / line, error / parabola);
        let end = rig.setpoint().x;
        assert!((end - 1.0).abs() < 1e-9, "{mode:?}, {ahead} ahead: {end}");
        // Measured, and a tenth of it: the recovery of the rig has five times the jerk of the move.
        let most = match (mode, ahead) {
            (Mode::Linear | Mode::AllLinear, 0) => 0.15 * line,
            (Mode::CubicBSpline, 0) => 0.19 * line,
            (Mode::QuinticBSpline, 0 | 1) => 0.28 * line,
            (_, 0) => 0.02 * parabola,
            (Mode::Linear, _) | (Mode::CubicBSpline, 2) => 5.4 * line,
            (Mode::CubicBSpline, _) => 6.5 * line,
            (Mode::QuinticBSpline, _) => 1.4 * line,
            (Mode::Cubic | Mode::Quintic | Mode::AllLinear | Mode::AllCubic, _) => 6.6 * parabola,
        };
        assert!(error < most, "{mode:?}, {ahead} ahead: {error:.2e} m, at most {most:.2e} m");
    }
}

/// The reported buffered interval has the number of predicted samples.
#[test]
fn states_say_how_many_samples_are_predicted() {
    use Interpolation::{Run1, Run2, Run3, Underflow};
    let still = |_| follow(sample(Setpoint::default()));
    for (mode, ahead) in all() {
        let mut rig = rig(mode, ahead, 0);
        rig.run(BEFORE, still);
        let mut seen = vec![rig.feedback().interpolation];
        // No more samples come.
        for _ in 0..4 * MOTION / BUS {
            rig.cycle();
            let state = rig.feedback().interpolation;
            if seen.last() != Some(&state) {
                seen.push(state);
            }
        }
        let all = [Run1, Run2, Run3, Underflow];
        assert_eq!(seen, all[ahead as usize..], "{mode:?}, {ahead} ahead");
        // They come again.
        rig.run(10, still);
        assert_eq!(rig.feedback().interpolation, all[ahead as usize], "{mode:?}");
        let output = rig.state.setpoint(&rig.params, Tick(rig.tick - BUS));
        assert!(output.x.abs() < 1e-12 && output.v.abs() < 1e-12, "{output:?}");
    }
}

/// A margin of a cycle gives the sample the time by which it is predicted.
#[test]
fn a_margin_takes_the_prediction_back() {
    let profile =
        Profile::plan(Order::Fourth, 1.0, &Limits { velocity: 1.0, acceleration: 4.0, jerk: 40.0, snap: 1000.0 })
            .unwrap();
    let motion = |t: f64| profile.at(t.clamp(0.0, profile.duration()));
    let cycle = u32::try_from(MOTION).unwrap();
    let [plain, both] = [(0, 0), (1, cycle)].map(|(ahead, margin)| {
        let mut rig = rig(Mode::Quintic, ahead, margin);
        largest_error(&mut rig, 100, 0, motion)
    });
    assert!((plain - both).abs() < 1e-12, "{plain} {both}");
}
