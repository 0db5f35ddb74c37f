//! Agreement with the engine `exact`, tick by tick.
use super::{H, build, effort, feed_axis, lambrechts, motion};
use servobench_base::Setpoint;
use servobench_plant::{Chain, Drive, Engine, Exact, Mechanics, MechanicsSetup, Model};

fn build_exact(chain: &Chain, drive: Drive) -> Box<dyn Mechanics> {
    Exact.build(&MechanicsSetup { model: Model::Chain(chain.clone()), drive, step: H, initial: vec![] }).unwrap()
}

/// Set-points of the jerk-limited 1 m move of Lambrechts at every tick: 1 m/s, 5 m/s², 50 m/s³; 1.3 s, then rest.
fn jerk_limited_move(ticks: u32) -> Vec<Setpoint> {
    let segments = [(0.1, 50.0), (0.1, 0.0), (0.1, -50.0), (0.7, 0.0), (0.1, -50.0), (0.1, 0.0), (0.1, 50.0)];
    (0..ticks)
        .map(|k| {
            let mut rest = f64::from(k) * H;
            let mut at = Setpoint::default();
            for (length, jerk) in segments {
                at.j = jerk;
                at = at.after(rest.min(length));
                rest = (rest - length).max(0.0);
            }
            if k >= 20_800 { Setpoint::at_rest(1.0) } else { at }
        })
        .collect()
}

/// Largest difference of the last body over all ticks, and over those after the move (m).
fn difference(chain: &Chain, drive: Drive, input: impl Fn(usize) -> servobench_plant::Input) -> [f64; 2] {
    let (mut rapier, mut exact) = (build(chain, drive, H, vec![]), build_exact(chain, drive));
    let mut worst = [0.0_f64; 2];
    for k in 0..25_600 {
        rapier.advance(&input(k)).unwrap();
        exact.advance(&input(k)).unwrap();
        let last = chain.bodies().len() - 1;
        let difference = (rapier.bodies()[last].position - exact.bodies()[last].position).abs();
        worst[usize::from(k > 20_800)] = worst[usize::from(k > 20_800)].max(difference);
    }
    worst
}

/// The project asks for 1 % or 10 nm; peak error and residual vibration of this move are 84 µm and 0.2 … 3 µm.
#[test]
fn lambrechts_behind_the_set_point() {
    let setpoints = jerk_limited_move(25_601);
    let [moving, resting] = difference(&lambrechts(), Drive::Prescribed, |k| motion(setpoints[k]));
    assert!(moving < 4e-9 && resting < 1e-9, "{moving:e} m, at rest {resting:e} m");
}

#[test]
fn lambrechts_under_the_force_of_the_move() {
    let setpoints = jerk_limited_move(25_601);
    // Rigid-body force for the middle of the tick: what a zero-order hold should be given.
    let force = |k: usize| {
        let middle = setpoints[k].after(H / 2.0);
        effort(30.0 * middle.a + 20.0 * middle.v)
    };
    let [moving, resting] = difference(&lambrechts(), Drive::Effort, force);
    assert!(moving < 4e-9 && resting < 4e-9, "{moving:e} m, at rest {resting:e} m");
}

/// Four lumps in two scenes, driven by a chirp of torque from standstill to 100 Hz, through the lowest mode. The load
/// then vibrates by 88 µm against the table; the project asks for 1 % of that.
#[test]
fn a_feed_axis_under_a_chirp() {
    let torque = |k: usize| {
        let t = k as f64 * H;
        effort(0.5 + 2.0 * (200.0 * t * t).sin())
    };
    let [early, late] = difference(&feed_axis(), Drive::Effort, torque);
    assert!(early < 2.1e-8 && late < 1e-7, "{early:e} m, {late:e} m");
}
