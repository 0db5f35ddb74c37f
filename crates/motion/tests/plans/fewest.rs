//! The fewest samples by moving averages, against brute force and against the sequential rounding.
use crate::requests::{Random, Request, request, sweep_size};
use servobench_motion::{Limits, Order, Profile};

/// Required products: X/V, X/A, X/J, X/D in samples, by the number of averages counted from the last.
fn needs(request: &Request) -> Vec<f64> {
    let Limits { velocity, acceleration, jerk, snap } = request.limits;
    let ts = request.sample_time;
    let powers = [ts, ts * ts, ts * ts * ts, ts * ts * ts * ts];
    [velocity, acceleration, jerk, snap]
        .iter()
        .zip(powers)
        .take(request.order.derivative())
        // Met except for the rounding of a request and a handful of products.
        .map(|(limit, power)| request.distance.abs() / (limit * power) * (1.0 - 1e-14))
        .collect()
}

/// True if averages n1 … nn, n1 being the first, reach the required products, in the order that keeps pulses apart.
fn reaches(boxes: &[u64], needs: &[f64]) -> bool {
    let (mut product, mut sum) = (1.0, 0);
    let enough = boxes.iter().rev().zip(needs).all(|(length, need)| {
        product *= *length as f64;
        product >= *need
    });
    enough
        && boxes.iter().all(|length| {
            let apart = *length >= sum;
            sum += length;
            apart
        })
}

/// True if any averages of `total` samples reach the required products: all of them are tried.
fn any_reach(order: Order, total: u64, needs: &[f64]) -> bool {
    let first = |most: u64| 1..=most;
    match order {
        Order::Second => first(total / 2).any(|n1| reaches(&[n1, total - n1], needs)),
        Order::Third => first(total / 4)
            .any(|n1| (n1..=total / 2).any(|n2| n1 + n2 < total && reaches(&[n1, n2, total - n1 - n2], needs))),
        Order::Fourth => first(total / 8).any(|n1| {
            (n1..=total / 4).any(|n2| {
                (n1 + n2..=total / 2)
                    .any(|n3| n1 + n2 + n3 < total && reaches(&[n1, n2, n3, total - n1 - n2 - n3], needs))
            })
        }),
    }
}

/// No total below is possible, by trying every combination of averages; a longer total is possible if a shorter one is, as
/// the last one may take any more.
#[test]
fn no_boxes_of_fewer_samples_reach_the_distance() {
    let mut random = Random::seeded(29);
    let (mut tried, mut saved) = ([0_usize; 3], 0);
    while tried.iter().sum::<usize>() < sweep_size() / 50 {
        let request = request(&mut random);
        let Request { order, distance, limits, sample_time } = request;
        let Ok(plan) = Profile::plan_fewest(order, distance, &limits, sample_time) else { continue };
        let samples = plan.samples().unwrap();
        let most = [2000, 400, 150][order.derivative() - 2];
        if samples.total() > most {
            continue;
        }
        tried[order.derivative() - 2] += 1;
        let needs = needs(&request);
        assert!(reaches(&samples.boxes[..order.derivative()], &needs), "{request:?}: {samples:?}");
        assert!(!any_reach(order, samples.total() - 1, &needs), "{request:?}: {samples:?}");
        let published = Profile::plan_sampled(order, distance, &limits, sample_time).unwrap();
        saved += published.samples().unwrap().total() - samples.total();
    }
    assert!(tried.iter().all(|count| *count > sweep_size() / 400), "{tried:?}");
    assert!(saved > 0);
}

#[test]
fn never_more_samples_than_the_sequential_rounding_and_within_the_limits() {
    let mut random = Random::seeded(30);
    let mut saved = [0_u64; 3];
    for _ in 0..sweep_size() / 5 {
        let request = request(&mut random);
        let Request { order, distance, limits, sample_time } = request;
        let fewest = Profile::plan_fewest(order, distance, &limits, sample_time);
        let Ok(published) = Profile::plan_sampled(order, distance, &limits, sample_time) else {
            assert!(fewest.is_err(), "{request:?}");
            continue;
        };
        let fewest = fewest.unwrap();
        let less = published.samples().unwrap().total().checked_sub(fewest.samples().unwrap().total());
        saved[order.derivative() - 2] += less.unwrap_or_else(|| panic!("{request:?}: {:?}", fewest.samples()));
        let continuous = Profile::plan(order, distance, &limits).unwrap().duration();
        assert!(fewest.duration() >= continuous * (1.0 - 1e-11), "{request:?}: faster than continuous");
        let peaks = fewest.peaks();
        for (peak, limit) in [
            (peaks.velocity, limits.velocity),
            (peaks.acceleration, limits.acceleration),
            (peaks.jerk, limits.jerk),
            (peaks.snap, limits.snap),
        ]
        .into_iter()
        .take(order.derivative())
        {
            // One forgiving comparison of 16 ulp, and the rounding of four quotients.
            assert!(peak <= limit * (1.0 + 1e-14), "{request:?}: {peak} {limit}");
        }
        assert_eq!(fewest.at(fewest.duration()).x.to_bits(), (distance + 0.0).to_bits(), "{request:?}");
    }
    assert!(saved[1] > 0, "{saved:?}");
    assert!(saved[0] > 0 && saved[2] > saved[1], "{saved:?}");
}
