//! Cost of planning a move and of reading one set-point: `cargo bench -p servobench-motion`.
use divan::{Bencher, black_box};
use servobench_motion::{Limits, Order, Profile};

fn main() {
    divan::main();
}

/// Lambrechts' motor–load example.
const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

/// Distances from a few samples to a long cruise, so that every limit binds in some of them.
const DISTANCES: [f64; 8] = [1e-6, 1e-4, 1e-2, 0.05, 0.1, 0.2, 1.0, 10.0];

#[divan::bench(args = ORDERS)]
fn continuous(bencher: Bencher<'_, '_>, order: Order) {
    let mut distances = DISTANCES.into_iter().cycle();
    bencher
        .with_inputs(|| distances.next().unwrap_or_default())
        .bench_local_values(|distance| Profile::plan(order, black_box(distance), &LIMITS));
}

#[divan::bench]
fn optimal(bencher: Bencher<'_, '_>) {
    let mut distances = DISTANCES.into_iter().cycle();
    bencher
        .with_inputs(|| distances.next().unwrap_or_default())
        .bench_local_values(|distance| Profile::plan_optimal(Order::Fourth, black_box(distance), &LIMITS));
}

#[divan::bench(args = ORDERS)]
fn sampled(bencher: Bencher<'_, '_>, order: Order) {
    let mut distances = DISTANCES.into_iter().cycle();
    bencher
        .with_inputs(|| distances.next().unwrap_or_default())
        .bench_local_values(|distance| Profile::plan_sampled(order, black_box(distance), &LIMITS, 1e-3));
}

/// One move read at 16 kHz, as the loop does it; divide by 20 000.
#[divan::bench(args = ORDERS)]
fn at_20_000_instants(bencher: Bencher<'_, '_>, order: Order) {
    let Ok(plan) = Profile::plan(order, 1.0, &LIMITS) else { return };
    bencher.bench_local(|| (0..20_000).map(|k| black_box(black_box(&plan).at(f64::from(k) / 16_000.0)).x).sum::<f64>());
}
