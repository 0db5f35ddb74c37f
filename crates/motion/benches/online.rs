//! Cost of planning from any state and of reading a set-point, beside `rsruckig` (order 3) on the same requests:
//! `cargo bench -p servobench-motion --bench online`.
//!
//! A control cycle must bear the slow plans too: the table has percentiles of single calls.
use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Target, Transition};
use servobench_motion::{Limits, Order, Profile};
use std::hint::black_box;
use std::time::Instant;

const REQUESTS: usize = 100_000;

/// `SplitMix64`, as a number in [0, 1).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn decades(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(low + (high - low) * self.unit())
    }
}

/// One request: a state on the way of another move, a target at rest, limits of which each binds now and then.
struct Request {
    from: Setpoint,
    x: f64,
    limits: Limits,
}

fn requests() -> Vec<Request> {
    let mut random = Random(4);
    let mut all = Vec::with_capacity(REQUESTS);
    while all.len() < REQUESTS {
        let limits = Limits {
            velocity: random.decades(-0.7, 0.7),
            acceleration: random.decades(-0.7, 0.7),
            jerk: random.decades(-0.7, 0.7),
            snap: 1.0,
        };
        let mut from = Setpoint::default();
        for _ in 0..3 {
            let x = (random.unit() - 0.5).signum() * random.decades(-2.0, 1.0);
            let target = Target::Position { x, v: 0.0 };
            let Ok(way) = Transition::plan(Order::Fourth, &from, &target, &limits.into(), Effort::Fast) else {
                continue;
            };
            all.push(Request { from, x, limits });
            from = Setpoint { x: 0.0, ..way.at(random.unit() * way.duration()) };
        }
    }
    all
}

/// Times of single calls (ns), sorted.
fn times<T>(requests: &[Request], mut call: impl FnMut(&Request) -> T) -> Vec<f64> {
    let mut times: Vec<f64> = requests
        .iter()
        .map(|request| {
            let start = Instant::now();
            black_box(call(black_box(request)));
            start.elapsed().as_nanos() as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times
}

fn row(name: &str, times: &[f64]) {
    let at = |per_mille: usize| times[(times.len() - 1) * per_mille / 1000];
    println!("{name:<36} {:>9.0} {:>9.0} {:>9.0} {:>9.0}", at(500), at(900), at(990), at(999));
}

fn main() {
    let requests = requests();
    println!("{:<36} {:>9} {:>9} {:>9} {:>9}", "plan, ns", "median", "90 %", "99 %", "99.9 %");
    row("nothing: what the clock takes", &times(&requests, |_| ()));
    let plan = |order, effort| {
        move |request: &Request| {
            let target = Target::Position { x: request.x, v: 0.0 };
            Transition::plan(order, &request.from, &target, &DirectionalLimits::from(request.limits), effort)
        }
    };
    row("online order 4, fast", &times(&requests, plan(Order::Fourth, Effort::Fast)));
    row("online order 4, refined", &times(&requests, plan(Order::Fourth, Effort::Refined)));
    row("online order 3", &times(&requests, plan(Order::Third, Effort::Fast)));
    let mut ruckig = Ruckig::<1, ThrowErrorHandler>::new(None, 0.001);
    let mut trajectory = Trajectory::new(None);
    let mut input = InputParameter::new(None);
    let mut theirs = |from: &Setpoint, request: &Request| {
        input.current_velocity[0] = from.v;
        input.current_acceleration[0] = from.a;
        input.target_position[0] = request.x;
        input.max_velocity[0] = request.limits.velocity;
        input.max_acceleration[0] = request.limits.acceleration;
        input.max_jerk[0] = request.limits.jerk;
        ruckig.calculate(&input, &mut trajectory).is_ok()
    };
    row("rsruckig order 3", &times(&requests, |request| theirs(&request.from, request)));
    row("rsruckig order 3, rest to rest", &times(&requests, |request| theirs(&Setpoint::default(), request)));
    row("order 4 published, rest to rest", &times(&requests, |r| Profile::plan(Order::Fourth, r.x, &r.limits)));
    row("order 4 optimal, rest to rest", &times(&requests, |r| Profile::plan_optimal(Order::Fourth, r.x, &r.limits)));
    samples(&requests);
}

/// One set-point of a planned way, over 1000 of each.
fn samples(requests: &[Request]) {
    const SAMPLES: u32 = 1000;
    let (mut by_time, mut by_piece, mut count) = (0.0, 0.0, 0.0);
    for request in requests.iter().take(1000) {
        let target = Target::Position { x: request.x, v: 0.0 };
        let limits = request.limits.into();
        let Ok(way) = Transition::plan(Order::Fourth, &request.from, &target, &limits, Effort::Fast) else { continue };
        let step = way.duration() / f64::from(SAMPLES);
        let start = Instant::now();
        for k in 0..SAMPLES {
            black_box(black_box(&way).at(f64::from(k) * step));
        }
        by_time += start.elapsed().as_nanos() as f64;
        let start = Instant::now();
        let mut piece = way.piece(0.0);
        for k in 0..SAMPLES {
            let t = f64::from(k) * step;
            if !piece.holds(t) {
                piece = way.piece(t);
            }
            black_box(black_box(&piece).at(t));
        }
        by_piece += start.elapsed().as_nanos() as f64;
        count += f64::from(SAMPLES);
    }
    println!("one set-point: {:.1} ns looked up, {:.1} ns in the order of time", by_time / count, by_piece / count);
}
