//! The shortest sampled move: as few samples as the corners of all moves allow, within its limits, at its end.
use crate::double_double::Dd;
use crate::requests::{Random, request, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::sampled::{Cascade, Execution, Shortest};
use servobench_motion::{Limits, Order, PlanError, Profile};

const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

/// A request of about `samples` samples; all limits within three decades, so that every pattern occurs.
struct Request {
    order: Order,
    distance: f64,
    limits: Limits,
    sample_time: f64,
}

impl Request {
    fn random(random: &mut Random, samples: f64) -> Self {
        let mut decades = |low: f64, high: f64| 10.0_f64.powf(low + (high - low) * random.unit());
        let limits = Limits {
            velocity: decades(-2.0, 1.0),
            acceleration: decades(-1.5, 1.5),
            jerk: decades(-1.0, 2.0),
            snap: decades(0.0, 3.0),
        };
        let distance = decades(-2.0, 1.5);
        let order = ORDERS[random.index(3)];
        let sample_time = Profile::plan_optimal(order, distance, &limits).unwrap().duration() / samples;
        let distance = if random.index(2) == 0 { distance } else { -distance };
        Self { order, distance, limits, sample_time }
    }

    fn plan(&self) -> Shortest {
        Shortest::plan(self.order, self.distance, &self.limits, self.sample_time).unwrap()
    }

    /// Limits from velocity on, as many as the order uses.
    fn limits(&self) -> Vec<f64> {
        let Limits { velocity, acceleration, jerk, snap } = self.limits;
        [velocity, acceleration, jerk, snap][..self.order.derivative()].to_vec()
    }
}

fn values(s: Setpoint) -> [f64; 5] {
    [s.x, s.v, s.a, s.j, s.s]
}

/// The plan is executed with 106 bits, sample by sample: no limit is exceeded by more than the rounding that the planner
/// admits, 1e-11, the reported peaks are the largest values, and the end is at rest at the distance. The order of the
/// counts is that of the freedom of the planners.
#[test]
fn forward_euler_keeps_every_limit_at_every_sample_and_lands() {
    let mut random = Random::seeded(61);
    let (mut proven, mut tried) = (0, 0);
    // Samples by which the fewest averages and the shortest move of order 4 are shorter than published: sum and most.
    let (mut count, mut shorter) = (0_u32, [(0, 0); 2]);
    for _ in 0..sweep_size() / 100 {
        let about = 4.0 + 290.0 * random.unit();
        let request = Request::random(&mut random, about);
        let (n, ts) = (request.order.derivative(), request.sample_time);
        let plan = request.plan();
        let limits = request.limits();
        let (mut state, mut most, mut passed) = ([Dd::ZERO; 5], [0.0_f64; 5], 0);
        for run in plan.runs() {
            for _ in 0..run.count {
                state[n] = run.value.into();
                for m in 1..=n {
                    most[m] = most[m].max(state[m].value().abs());
                }
                for m in 0..n {
                    state[m] = state[m] + state[m + 1] * ts.into();
                }
                passed += 1;
            }
        }
        assert_eq!(passed, plan.samples());
        let peaks = plan.peaks();
        for (m, peak) in [peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap].into_iter().enumerate().take(n) {
            assert!(most[m + 1] <= limits[m] * (1.0 + 2e-11), "{}: {} {}", m + 1, most[m + 1], limits[m]);
            assert!((most[m + 1] / peak - 1.0).abs() < 1e-9, "{}: {} {peak}", m + 1, most[m + 1]);
        }
        // Amplitudes are rounded to 1e-16 of the largest and integrated up to four times.
        let duration = plan.duration();
        let mut scale = most[n];
        for m in (0..n).rev() {
            scale = most[m].max(scale * duration);
            let end = if m == 0 { plan.distance() } else { 0.0 };
            assert!((state[m].value() - end).abs() <= 1e-13 * scale, "derivative {m} ends at {}", state[m].value());
        }
        let counts = [Profile::plan_fewest, Profile::plan_sampled].map(|plan| {
            let plan = plan(request.order, request.distance, &request.limits, ts).unwrap();
            plan.samples().unwrap().total()
        });
        assert!(plan.at_least() <= plan.samples() && plan.samples() <= counts[0] && counts[0] <= counts[1]);
        tried += 1;
        proven += u32::from(plan.at_least() == plan.samples());
        if request.order == Order::Fourth {
            count += 1;
            for ((sum, most), samples) in shorter.iter_mut().zip([counts[0], plan.samples()]) {
                *sum += counts[1] - samples;
                *most = (*most).max(counts[1] - samples);
            }
        }
    }
    let [fewest, shortest] = shorter.map(|(sum, most)| (sum as f64 / f64::from(count), most));
    println!("{proven} of {tried} proven; of order 4 {count}, shorter than published: {fewest:.2?} {shortest:.2?}");
    assert!(shortest.0 > fewest.0 && fewest.0 > 0.0);
    assert!(f64::from(proven) >= 0.99 * f64::from(tried), "{proven} of {tried} are proven to be the shortest");
}

/// Limits kept by the cascade at its samples are kept by the exact hold at all times: at the ends and turning points of its pieces,
/// which are in the peaks, and at any.
#[test]
fn the_exact_hold_keeps_every_limit_at_every_time() {
    let mut random = Random::seeded(62);
    for _ in 0..sweep_size() / 1000 {
        let about = 4.0 + 290.0 * random.unit();
        let request = Request::random(&mut random, about);
        let n = request.order.derivative();
        let plan = request.plan();
        let peaks = plan.peaks_by(Execution::ExactHold);
        let peaks = [peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap];
        for (peak, limit) in peaks.iter().zip(request.limits()) {
            assert!(*peak <= limit * (1.0 + 2e-11), "{peak} {limit}");
        }
        let mut most = [0.0_f64; 5];
        for k in 0..=1000 {
            let at = values(plan.at(plan.duration() * f64::from(k) / 1000.0));
            for m in 1..=n {
                most[m] = most[m].max(at[m].abs());
                assert!(at[m].abs() <= peaks[m - 1] * (1.0 + 1e-11), "{m} at {k}: {} {}", at[m], peaks[m - 1]);
            }
        }
        // Velocity is flat where it is largest, a thousandth of the move beside it.
        assert!((most[1] / peaks[0] - 1.0).abs() < 0.01, "{} {}", most[1], peaks[0]);
        assert_eq!(plan.at(plan.duration()), Setpoint::at_rest(request.distance));
        // In the middle, where the half meets its reflection, and at any other time, it continues without a step.
        for k in 0..40 {
            let t = if k == 0 { 0.5 } else { random.unit() } * plan.duration();
            let step = 1e-7 * plan.duration();
            let (before, after) = (values(plan.at(t - step)), values(plan.at(t + step)));
            let speed = peaks[0].max(request.distance.abs() / plan.duration());
            assert!((after[0] - before[0]).abs() <= 2.1 * step * speed + 1e-11 * request.distance.abs(), "at {t}");
            assert!((after[1] - before[1]).abs() <= 2.1 * step * peaks[1] + 1e-9 * peaks[0], "at {t}");
        }
    }
}

/// The largest distance of `total` samples, by trying every corner of the set of all moves: whole moves, without symmetry or
/// program. A corner is where as many limits are met as there are samples left free by the conditions of rest.
fn farthest(total: usize, bounds: &[f64]) -> f64 {
    let n = bounds.len() + 1;
    let choose = |t: usize, m: usize| (0..m).fold(1.0, |c, i| c * (t as f64 - i as f64) / (i as f64 + 1.0));
    let integral = |m: usize, k: usize| -> Vec<f64> {
        (0..total).map(|i| if i < k { choose(k - 1 - i, m - 1) } else { 0.0 }).collect()
    };
    let mut limits: Vec<(Vec<f64>, f64)> =
        (0..total).map(|i| ((0..total).map(|j| f64::from(u8::from(i == j))).collect(), 1.0)).collect();
    for (m, bound) in bounds.iter().enumerate().filter(|(_, bound)| bound.is_finite()) {
        limits.extend((m + 1..total).map(|k| (integral(m + 1, k), *bound)));
    }
    let rest: Vec<Vec<f64>> = (1..n).map(|m| integral(m, total)).collect();
    let worth = integral(n, total);
    let free = total - rest.len();
    let (mut chosen, mut best) = ((0..free).collect::<Vec<_>>(), 0.0_f64);
    loop {
        for signs in 0..1_u32 << free {
            let mut system: Vec<Vec<f64>> = rest.iter().map(|row| [row.as_slice(), &[0.0]].concat()).collect();
            system.extend(chosen.iter().enumerate().map(|(bit, limit)| {
                let (row, bound) = &limits[*limit];
                [row.as_slice(), &[if signs >> bit & 1 == 1 { *bound } else { -bound }]].concat()
            }));
            if let Some(u) = solved(system) {
                let dot = |row: &[f64]| row.iter().zip(&u).map(|(a, u)| a * u).sum::<f64>();
                if limits.iter().all(|(row, bound)| dot(row).abs() <= bound * (1.0 + 1e-9)) {
                    best = best.max(dot(&worth));
                }
            }
        }
        // The next choice of `free` limits.
        let Some(at) = (0..free).rev().find(|at| chosen[*at] < limits.len() - free + at) else { return best };
        chosen[at] += 1;
        for next in at + 1..free {
            chosen[next] = chosen[next - 1] + 1;
        }
    }
}

/// Gaussian elimination; `None` if the rows depend on each other.
fn solved(mut system: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let size = system.len();
    for i in 0..size {
        let pivot = (i..size).max_by(|a, b| system[*a][i].abs().total_cmp(&system[*b][i].abs()))?;
        system.swap(i, pivot);
        if system[i][i].abs() < 1e-9 {
            return None;
        }
        let top = system[i].clone();
        for (r, row) in system.iter_mut().enumerate() {
            let factor = row[i] / top[i];
            if r != i {
                row.iter_mut().zip(&top).for_each(|(entry, above)| *entry -= factor * above);
            }
        }
    }
    Some((0..size).map(|i| system[i][size] / system[i][i]).collect())
}

/// Oracle: all corners. A thousandth less than the farthest of N samples takes N, a thousandth more takes more.
#[test]
fn it_takes_a_sample_more_just_beyond_the_farthest_corner() {
    let mut random = Random::seeded(63);
    for (order, totals) in ORDERS.into_iter().zip([3..=6, 4..=7, 5..=7]) {
        for total in totals {
            for _ in 0..6 {
                let n = order.derivative();
                // From binding at every sample to not at all.
                let mut scale = 0.7;
                let mut bound = || {
                    scale *= (2.0 * random.unit()).exp2();
                    scale
                };
                let bounds: Vec<f64> = (1..n).map(|_| bound()).collect();
                let farthest = farthest(total, &bounds);
                let mut limits = [f64::INFINITY; 4];
                limits[n - 1] = 1.0;
                for (m, bound) in bounds.iter().enumerate() {
                    limits[n - 2 - m] = *bound;
                }
                let [velocity, acceleration, jerk, snap] = limits;
                let limits = Limits { velocity, acceleration, jerk, snap };
                let samples = |part: f64| {
                    let plan = Shortest::plan(order, part * farthest, &limits, 1.0).unwrap();
                    assert_eq!(plan.at_least(), plan.samples(), "{order:?} {limits:?} {total}");
                    plan.samples()
                };
                assert!(samples(0.999) <= total as u64, "{order:?} {limits:?}: {farthest} in {total}");
                assert!(samples(1.001) > total as u64, "{order:?} {limits:?}: {farthest} in {total}");
            }
        }
    }
}

/// Both executions of both plans land; the cascade in closed form from run to run.
#[test]
fn every_way_to_execute_it_lands() {
    let mut random = Random::seeded(64);
    for _ in 0..sweep_size() / 1000 {
        let about = 4.0 + 290.0 * random.unit();
        let request = Request::random(&mut random, about);
        let ts = request.sample_time;
        let plan = request.plan();
        let mut cascade = Cascade::at_rest(request.order, 0.0, ts).unwrap();
        assert_eq!(cascade.along(plan.runs()).count() as u64, plan.samples());
        // Up to 300 runs, each rounded at the size of the whole move.
        assert!((cascade.state().x / plan.distance() - 1.0).abs() < 1e-9, "{:?}", cascade.state());
        assert_eq!(plan.at(plan.samples() as f64 * ts), Setpoint::at_rest(plan.distance()));
        // The hold of consecutive runs equals the evaluated set-point.
        let (mut state, mut time) = (Setpoint::default(), 0);
        for run in plan.runs() {
            match request.order {
                Order::Second => state.a = run.value,
                Order::Third => state.j = run.value,
                Order::Fourth => state.s = run.value,
            }
            let at = plan.at(time as f64 * ts);
            assert!((at.x - state.x).abs() <= 1e-9 * plan.distance().abs(), "{time}: {at:?} {state:?}");
            assert_eq!(values(at)[request.order.derivative()].to_bits(), run.value.to_bits(), "{time}");
            state = state.after(run.count as f64 * ts);
            time += run.count;
        }
    }
}

/// Keeping a piece as long as it applies gives the set-points of a look-up at every instant, bit for bit, with one look-up
/// for each run at most, and two more: where the middle of the move cuts a run in two, and the rest at the end.
#[test]
fn a_piece_holds_exactly_as_long_as_it_is_the_one() {
    let mut random = Random::seeded(66);
    for _ in 0..sweep_size() / 1000 {
        let about = 4.0 + 290.0 * random.unit();
        let plan = Request::random(&mut random, about).plan();
        let (ts, duration) = (plan.sample_time(), plan.duration());
        let instants = (0..=2 * plan.samples()).map(|k| 0.5 * k as f64 * ts);
        let beside =
            instants.flat_map(|t| [t, t.next_up(), t.next_down(), t + 0.9e-9 * ts, t - 0.9e-9 * ts, t + 0.3 * ts]);
        let mut times: Vec<f64> = beside.chain([-1.0, 2.0 * duration]).collect();
        times.sort_by(f64::total_cmp);
        let (mut piece, mut looked_up) = (plan.piece(-1.0), 0);
        for t in times {
            if !piece.holds(t) {
                piece = plan.piece(t);
                looked_up += 1;
            }
            assert_eq!(values(piece.at(t)).map(f64::to_bits), values(plan.at(t)).map(f64::to_bits), "{plan:?} at {t}");
        }
        assert!(looked_up <= plan.runs().len() + 2, "{plan:?}: {looked_up}");
    }
}

/// Many samples: within five of the continuous optimum, without and with a cruise.
#[test]
fn long_moves_are_near_the_continuous_optimum() {
    for (distance, samples) in [(0.01, 3000.0), (0.01, 100_000.0), (1.0, 3000.0), (1.0, 60_000.0)] {
        let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
        let optimum = Profile::plan_optimal(Order::Fourth, distance, &limits).unwrap();
        let ts = optimum.duration() / samples;
        let plan = Shortest::plan(Order::Fourth, distance, &limits, ts).unwrap();
        assert!(plan.samples() as f64 <= samples + 5.0, "{} {samples}", plan.samples());
        let peaks = plan.peaks();
        assert!(peaks.velocity <= 1.0 + 2e-11 && peaks.acceleration <= 5.0 + 1e-10 && peaks.jerk <= 50.0 + 1e-9);
        let mut cascade = Cascade::at_rest(Order::Fourth, 0.0, ts).unwrap();
        assert_eq!(cascade.along(plan.runs()).count() as u64, plan.samples());
        assert!((cascade.state().x / distance - 1.0).abs() < 1e-9, "{:?}", cascade.state());
    }
}

#[test]
fn what_the_boxes_refuse_is_refused_and_no_distance_is_no_move() {
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
    let plan = |distance: f64, limits: &Limits, ts: f64| Shortest::plan(Order::Fourth, distance, limits, ts);
    for distance in [f64::NAN, f64::INFINITY] {
        assert!(matches!(plan(distance, &limits, 1e-3), Err(PlanError::Parameter(_))));
    }
    for ts in [0.0, -1.0, f64::NAN] {
        assert!(matches!(plan(1.0, &limits, ts), Err(PlanError::Parameter(_))));
    }
    assert!(matches!(plan(1.0, &limits, 1e-20), Err(PlanError::TooManySamples { .. })));
    assert!(matches!(plan(1.0, &Limits { jerk: -1.0, ..limits }, 1e-3), Err(PlanError::Parameter(_))));
    let nothing = plan(0.0, &limits, 1e-3).unwrap();
    assert_eq!((nothing.samples(), nothing.at_least(), nothing.runs().count()), (0, 0, 0));
    assert_eq!(nothing.at(1.0), Setpoint::at_rest(0.0));
    // One encoder count within one sample: as short as its order allows.
    let one = plan(1e-9, &limits, 0.1).unwrap();
    assert_eq!((one.samples(), one.at_least()), (4, 4), "s, −3s, 3s, −s");
    // More samples than are searched: moving averages, without a proof.
    let slow = plan(1.0, &limits, 1e-6).unwrap();
    assert_eq!(slow.at_least(), 1);
    assert_eq!(slow.at(slow.duration()), Setpoint::at_rest(1.0));
}

/// Wide requests, ten decades apart, as in the sweeps of the other planners.
#[test]
fn requests_of_any_size_are_proven() {
    let mut random = Random::seeded(65);
    let (mut tried, mut proven, mut excess) = (0, 0, 0.0_f64);
    while tried < sweep_size() / 100 {
        let crate::requests::Request { order, distance, limits, sample_time } = request(&mut random);
        let Ok(boxes) = Profile::plan_fewest(order, distance, &limits, sample_time) else { continue };
        if boxes.samples().unwrap().total() > 300 {
            continue;
        }
        let plan = Shortest::plan(order, distance, &limits, sample_time).unwrap();
        let (peaks, hold) = (plan.peaks(), plan.peaks_by(Execution::ExactHold));
        excess = excess.max(peaks.velocity.max(hold.velocity) / limits.velocity - 1.0);
        excess = excess.max(peaks.acceleration.max(hold.acceleration) / limits.acceleration - 1.0);
        tried += 1;
        proven += usize::from(plan.at_least() == plan.samples());
    }
    // The rounding that the planner admits, and that of the peaks.
    assert!(excess < 2e-11, "a limit is exceeded by {excess:e}");
    assert!(proven * 100 >= tried * 99, "{proven} of {tried}");
}
