//! Cost of tables: velocities for a million points, the set-point at a time, commands of a position profile:
//! `cargo bench -p servobench-motion --bench tables`.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use servobench_motion::position_profile::{Plateaus, Spline};
use servobench_motion::pvt::{Knot, Table, average, continuous, smooth};
use servobench_testkit::Random;

fn main() {
    divan::main();
}

const MILLION: usize = 1_000_000;

/// A walk with 5 to 255 ms between its points.
fn walk(points: usize) -> Vec<Knot> {
    let mut random = Random::seeded(17);
    let mut knot = Knot::new(0.0, 0.0);
    let mut next = || {
        knot = Knot::new(knot.t + 0.005 + 0.25 * random.unit(), knot.x + random.unit() - 0.5);
        knot
    };
    (0..points).map(|_| next()).collect()
}

fn smooth_walk(points: usize) -> Vec<Knot> {
    let mut knots = walk(points);
    let solved = continuous(&mut knots, 0.0, 0.0, &mut vec![0.0; points]);
    assert!(solved.is_ok(), "{solved:?}");
    knots
}

/// Time of each of `samples` set-points over the whole table (s).
fn times(knots: &[Knot], samples: usize) -> impl Iterator<Item = f64> {
    let (start, end) = (knots[0].t, knots[knots.len() - 1].t);
    let step = (end - start) / samples as f64;
    (0..samples).map(move |k| start + k as f64 * step)
}

/// One way to choose a million velocities, measured on points that have none, or those of the average rule.
fn velocities(bencher: Bencher<'_, '_>, choose: impl Fn(&mut [Knot], &mut [f64]) -> bool + Sync) {
    let mut knots = walk(MILLION);
    let averaged = average(&mut knots, 0.0, 0.0);
    assert!(averaged.is_ok(), "{averaged:?}");
    let mut scratch = vec![0.0; MILLION];
    bencher.counter(ItemsCount::new(MILLION)).bench_local(|| choose(black_box(&mut knots), &mut scratch));
}

#[divan::bench(sample_count = 10)]
fn velocities_by_the_average_rule(bencher: Bencher<'_, '_>) {
    velocities(bencher, |knots, _| average(knots, 0.0, 0.0).is_ok());
}

#[divan::bench(sample_count = 10)]
fn velocities_by_two_passes(bencher: Bencher<'_, '_>) {
    velocities(bencher, |knots, _| smooth(knots, 2).is_ok());
}

#[divan::bench(sample_count = 10)]
fn velocities_with_continuous_acceleration(bencher: Bencher<'_, '_>) {
    velocities(bencher, |knots, scratch| continuous(knots, 0.0, 0.0, scratch).is_ok());
}

#[divan::bench(args = [10, 1_000, MILLION], sample_count = 10)]
fn set_points_in_the_order_of_time(bencher: Bencher<'_, '_>, points: usize) {
    let knots = smooth_walk(points);
    let Ok(table) = Table::new(&knots) else { return };
    bencher.counter(ItemsCount::new(MILLION)).bench_local(|| {
        let mut cursor = black_box(table).cursor();
        times(&knots, MILLION).map(|t| cursor.at(t).x).sum::<f64>()
    });
}

#[divan::bench(args = [10, 1_000, MILLION], sample_count = 10)]
fn set_points_looked_up(bencher: Bencher<'_, '_>, points: usize) {
    let knots = smooth_walk(points);
    let Ok(table) = Table::new(&knots) else { return };
    bencher
        .counter(ItemsCount::new(MILLION))
        .bench_local(|| times(&knots, MILLION).map(|t| black_box(&table).at(t).x).sum::<f64>());
}

#[divan::bench(sample_count = 10)]
fn plateaus_solved_and_commanded(bencher: Bencher<'_, '_>) {
    let (mut knots, mut scratch) = (walk(MILLION), vec![0.0; MILLION]);
    bencher.counter(ItemsCount::new(MILLION)).bench_local(|| {
        let way = Plateaus::solve(black_box(&mut knots), 0.0, 0.0, 0.25, &mut scratch);
        way.map_or(0.0, |way| way.commands().map(|command| command.velocity).sum())
    });
}

#[divan::bench]
fn spline_stepped_at_1_khz(bencher: Bencher<'_, '_>) {
    let (mut knots, mut scratch) = (walk(1_000), vec![0.0; 1_000]);
    let Ok(spline) = Spline::solve(&mut knots, 0.0, 0.0, &mut scratch) else { return };
    let Ok(way) = spline.stepped(1e3) else { return };
    bencher
        .counter(ItemsCount::new(way.count()))
        .bench_local(|| black_box(way).commands().map(|command| command.velocity).sum::<f64>());
}

#[divan::bench]
fn largest_error_of_1000_points(bencher: Bencher<'_, '_>) {
    let (mut knots, mut scratch) = (walk(1_000), vec![0.0; 1_000]);
    let Ok(spline) = Spline::solve(&mut knots, 0.0, 0.0, &mut scratch) else { return };
    let Ok(way) = spline.stepped(1e3) else { return };
    bencher.counter(ItemsCount::new(1_000_usize)).bench_local(|| black_box(way).largest_error());
}

#[divan::bench]
fn lowest_rate_of_1000_points(bencher: Bencher<'_, '_>) {
    let (mut knots, mut scratch) = (walk(1_000), vec![0.0; 1_000]);
    let Ok(spline) = Spline::solve(&mut knots, 0.0, 0.0, &mut scratch) else { return };
    bencher.bench_local(|| black_box(spline).lowest_rate(black_box(1e-5)).is_ok());
}
