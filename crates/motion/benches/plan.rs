//! Cost of planning a move and of reading one set-point: `cargo bench -p servobench-motion --bench plan`.
//!
//! A table of percentiles over random requests follows, beside `rsruckig` (order 3) on the same ones.
#[path = "shared/percentiles.rs"]
mod percentiles;

use divan::{Bencher, black_box};
use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
use servobench_motion::{Limits, Order, Profile};
use servobench_testkit::Random;

fn main() {
    divan::main();
    print_percentiles();
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

/// Binding limit in the middle of a move of order 4, and its place in [`random_requests`].
#[derive(Debug, Clone, Copy)]
enum Region {
    /// Not the velocity.
    Swing,
    /// The velocity for an instant.
    Touch,
    /// The velocity for a while.
    Cruise,
}

impl Region {
    fn of(distance: f64, limits: &Limits) -> Option<Self> {
        let plan = Profile::plan_optimal(Order::Fourth, distance, limits).ok()?;
        Some(if plan.cruise() > 0.0 {
            Self::Cruise
        } else if plan.peaks().velocity > limits.velocity * (1.0 - 1e-12) {
            Self::Touch
        } else {
            Self::Swing
        })
    }
}

/// Moves and limits, `of_each` of each region, in which every limit binds now and then.
fn random_requests(of_each: usize) -> [Vec<(f64, Limits)>; 3] {
    let mut random = Random::seeded(4);
    let mut regions = [const { vec![] }; 3];
    while regions.iter().any(|region| region.len() < of_each) {
        let mut decades = |low: f64, high: f64| 10.0_f64.powf(low + (high - low) * random.unit());
        let limits = Limits {
            velocity: decades(-1.0, 1.0),
            acceleration: decades(-1.0, 1.0),
            jerk: decades(-1.0, 1.0),
            snap: 1.0,
        };
        let distance = decades(-2.0, 2.0);
        let Some(region) = Region::of(distance, &limits) else { continue };
        let requests = &mut regions[region as usize];
        if requests.len() < of_each {
            requests.push((distance, limits));
        }
    }
    regions
}

fn print_percentiles() {
    let regions = random_requests(100_000);
    let all = regions.concat();
    percentiles::header("plan of order 4 from rest, ns");
    percentiles::row("nothing: what the clock takes", &all, |_| ());
    percentiles::row("published", &all, |(distance, limits)| Profile::plan(Order::Fourth, *distance, limits));
    let optimal = |(distance, limits): &(f64, Limits)| Profile::plan_optimal(Order::Fourth, *distance, limits);
    percentiles::row("optimal", &all, optimal);
    for (name, region) in ["- below the velocity limit", "- touching it", "- cruising"].into_iter().zip(&regions) {
        percentiles::row(name, region, optimal);
    }
    let mut ruckig = Ruckig::<1, ThrowErrorHandler>::new(None, 0.001);
    let mut trajectory = Trajectory::new(None);
    let mut input = InputParameter::new(None);
    percentiles::row("rsruckig, order 3", &all, |(distance, limits)| {
        input.target_position[0] = *distance;
        input.max_velocity[0] = limits.velocity;
        input.max_acceleration[0] = limits.acceleration;
        input.max_jerk[0] = limits.jerk;
        ruckig.calculate(&input, &mut trajectory).is_ok()
    });
}
