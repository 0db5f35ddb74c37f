//! Random programs: random calls with random inputs, some of them NaN, on an axis whose drive lags, faults and fails at
//! random. Nothing leaves the state diagram, no limit is exceeded, no set-point jumps, and outputs keep the rules of the standard.
//!
//! The sweep is small in ordinary runs. `SERVOBENCH_SWEEP=7500000 cargo test --release -p servobench-plcopen --test random` runs the
//! large one, with so many cycles per order.
mod chain;
mod chance;
mod drive;
mod outputs;
mod program;
mod setpoints;

use chain::Chain;
use chance::Chance;
use drive::Drive;
use program::Program;
use servobench_fieldbus::{AxisCommand, AxisFeedback};
use servobench_motion::Limits;
use servobench_plcopen::{ARROWS, Arrow, AxisParams, AxisState, Cause};

const CYCLE_TIME: f64 = 2e-3;
const LIMITS: Limits = Limits { velocity: 2.0, acceleration: 10.0, jerk: 200.0, snap: 8000.0 };
/// Cycles after which a new program starts on a new axis.
const LIFE: usize = 5_000;

fn cycles() -> usize {
    std::env::var("SERVOBENCH_SWEEP").ok().and_then(|count| count.parse().ok()).unwrap_or(200_000)
}

#[test]
fn no_program_of_order_4_leaves_the_diagram_or_the_limits() {
    sweep::<Drive>(LIMITS);
}

#[test]
fn no_program_of_order_3_leaves_the_diagram_or_the_limits() {
    sweep::<Drive>(Limits { snap: f64::INFINITY, ..LIMITS });
}

#[test]
fn no_program_of_order_2_leaves_the_diagram_or_the_limits() {
    sweep::<Drive>(Limits { snap: f64::INFINITY, jerk: f64::INFINITY, ..LIMITS });
}

/// The same over a link and a bus, with a drive that has a state machine.
#[test]
fn no_program_over_a_bus_leaves_the_diagram_or_the_limits() {
    sweep::<Chain>(LIMITS);
}

/// Drive that follows the set-points of an axis.
trait Follower: Default {
    fn feedback(&self) -> AxisFeedback;

    /// One cycle.
    fn follow(&mut self, command: &AxisCommand, chance: &mut Chance, place: &str);
}

fn sweep<F: Follower>(limits: Limits) {
    let mut chance = Chance::new(limits.jerk.to_bits() ^ limits.snap.to_bits());
    let mut seen = [0_usize; AxisState::ALL.len()];
    let mut taken = [0_usize; ARROWS.len()];
    let (mut done, mut followed) = (0, 0);
    for life in 0..cycles().div_ceil(LIFE) {
        let modulo = chance.once_in(2).then_some(3.0);
        let needs_homing = chance.once_in(4);
        let params = AxisParams { modulo, needs_homing, buffered_commands: 3, ..AxisParams::new(CYCLE_TIME, limits) };
        let mut program = Program::new(params, chance.one_of(&[150, 5000]));
        let mut follower = F::default();
        for cycle in 0..LIFE {
            let place = format!("life {life}, cycle {cycle}");
            let command = program.cycle(&follower.feedback(), &mut chance, &place, &mut taken);
            follower.follow(&command, &mut chance, &place);
            seen[program.state() as usize] += 1;
        }
        done += program.done;
        followed += program.followed;
    }
    // The test covers every state for a while, every arrow, and moves and profiles that end.
    let few = cycles() / 2000;
    assert!(seen.iter().all(|times| *times > few), "{seen:?}");
    // The end of a profile that keeps a velocity takes the same arrow as a command, and is counted with it.
    let is_counted = |arrow: &Arrow| arrow.causes != [Cause::DoneMoving];
    assert!(ARROWS.iter().zip(taken).all(|(arrow, times)| times > 0 || !is_counted(arrow)), "{taken:?}");
    assert!(done > few / 10 && followed > few / 20, "{done} moves, {followed} profiles");
}
