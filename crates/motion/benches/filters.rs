//! Cost of a tick: reading a planned way, interpolating, shaping, averaging:
//! `cargo bench -p servobench-motion --bench filters`.
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_base::Setpoint;
use servobench_motion::interpolate::{Interpolator, Mode, Sample};
use servobench_motion::online::{Effort, Target, Transition};
use servobench_motion::shape::{Impulses, MovingAverage, ShapingFilter, Vibration};
use servobench_motion::{Limits, Order, Piece, PlanError, Profile};

fn main() {
    divan::main();
}

/// Ticks of one measurement, and their time (s).
const TICKS: u32 = 10_000;
const TICK: f64 = 1.0 / 16_000.0;
const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

/// Sum over the ticks of what each gives, measured by the tick.
fn ticks(bencher: Bencher<'_, '_>, mut tick: impl FnMut(u32) -> f64) {
    bencher.counter(ItemsCount::new(TICKS)).bench_local(|| (0..TICKS).map(&mut tick).sum::<f64>());
}

fn profile() -> Result<Profile, PlanError> {
    Profile::plan(Order::Fourth, 0.1, &LIMITS)
}

fn transition() -> Result<Transition, PlanError> {
    let from = Setpoint { v: 0.3, a: 1.0, ..Setpoint::default() };
    let target = Target::Position { x: 0.1, v: 0.0 };
    Transition::plan(Order::Fourth, &from, &target, &LIMITS.into(), Effort::Fast)
}

/// The loop of a drive: a piece is kept as long as it holds.
fn by_pieces(bencher: Bencher<'_, '_>, piece_at: impl Fn(f64) -> Piece) {
    let mut piece = piece_at(0.0);
    ticks(bencher, |k| {
        let t = f64::from(k) * TICK;
        if k == 0 || !piece.holds(t) {
            piece = piece_at(t);
        }
        black_box(&piece).at(t).x
    });
}

#[divan::bench]
fn profile_looked_up(bencher: Bencher<'_, '_>) {
    let Ok(plan) = profile() else { return };
    ticks(bencher, |k| black_box(&plan).at(f64::from(k) * TICK).x);
}

#[divan::bench]
fn profile_by_pieces(bencher: Bencher<'_, '_>) {
    let Ok(plan) = profile() else { return };
    by_pieces(bencher, |t| plan.piece(t));
}

#[divan::bench]
fn transition_looked_up(bencher: Bencher<'_, '_>) {
    let Ok(way) = transition() else { return };
    ticks(bencher, |k| black_box(&way).at(f64::from(k) * TICK).x);
}

#[divan::bench]
fn transition_by_pieces(bencher: Bencher<'_, '_>) {
    let Ok(way) = transition() else { return };
    by_pieces(bencher, |t| way.piece(t));
}

/// Sixteen ticks between two samples.
#[divan::bench(args = Mode::ALL)]
fn interpolation(bencher: Bencher<'_, '_>, mode: Mode) {
    let Ok(plan) = profile() else { return };
    let Ok(mut axis) = Interpolator::new(mode, 16.0 * TICK) else { return };
    ticks(bencher, |k| {
        if k % 16 == 0 {
            let Setpoint { x, v, a, .. } = plan.at(f64::from(k) * TICK);
            let pushed = axis.push(black_box(Sample { x, v, a, torque: 0.0 }));
            debug_assert!(pushed.is_ok(), "{pushed:?}");
        }
        axis.at(f64::from(k % 16) / 16.0).map_or(0.0, |command| command.setpoint.x)
    });
}

/// Shapers of 2, 3 and 4 impulses for a mode of 17 Hz, each split on the grid of ticks of 1 ms.
#[divan::bench(args = ["ZV", "ZVD", "ZVDD", "EI"])]
fn shaping(bencher: Bencher<'_, '_>, shaper: &str) {
    let Ok(mode) = Vibration::new(107.0, 0.01) else { return };
    let impulses = match shaper {
        "ZV" => Ok(Impulses::zv(&mode)),
        "ZVD" => Ok(Impulses::zvd(&mode)),
        "ZVDD" => Ok(Impulses::zvdd(&mode)),
        _ => Impulses::ei(&mode, 0.05),
    };
    let Ok(plan) = profile() else { return };
    let filter = impulses.and_then(|impulses| ShapingFilter::<128>::new(&impulses, 1e-3, Setpoint::default()));
    let Ok(mut filter) = filter else { return };
    ticks(bencher, |k| {
        let set_point = plan.at(f64::from(k) * TICK);
        filter.next(black_box(set_point)).map_or(0.0, |shaped| shaped.x)
    });
}

#[divan::bench(args = [1, 16, 256])]
fn moving_average(bencher: Bencher<'_, '_>, length: usize) {
    let Ok(plan) = profile() else { return };
    let Ok(mut mean) = MovingAverage::over(vec![Setpoint::default(); length], Setpoint::default()) else { return };
    ticks(bencher, |k| {
        let set_point = plan.at(f64::from(k) * TICK);
        mean.next(black_box(set_point)).map_or(0.0, |mean| mean.x)
    });
}
