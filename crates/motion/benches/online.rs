//! Cost of planning from any state and of reading a set-point, beside `rsruckig` (order 3) on the same requests:
//! `cargo bench -p servobench-motion --bench online`; with `-- "order 3"` behind it only the rows with that in their names.
//!
//! A control cycle must bear the slow plans too: the table has percentiles of single calls. Each is timed in several passes over
//! all requests, of which the shortest counts: the others have in them what the operating system did in between. Calls shorter than
//! 1 µs are timed many in a row, because the clock of some machines has steps of 10 ns and more.

use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, RampLimits, Sides, Target, Transition, passing_velocity};
use servobench_motion::{Limits, Order, PlanError, Profile};
use servobench_testkit::Random;
use std::hint::black_box;
use std::time::Instant;

const REQUESTS: usize = 100_000;
const PASSES: usize = 5;
const IN_A_ROW: u32 = 16;

/// One request: a state on the way of another move, a target at rest or passed at a velocity, limits of which each binds now and
/// then.
struct Request {
    from: Setpoint,
    x: f64,
    v: f64,
    limits: Limits,
}

impl Request {
    /// With half the acceleration to speed up with.
    fn ramps(&self, order: Order) -> Result<Transition, PlanError> {
        let Limits { velocity, acceleration: deceleration, jerk, snap } = self.limits;
        let (velocity, acceleration) = (Sides::both(velocity), 0.5 * deceleration);
        let limits = RampLimits { velocity, acceleration, deceleration, jerk, snap };
        let target = Target::Position { x: self.x, v: self.v };
        Transition::plan_ramps(order, &self.from, &target, &limits, Effort::Fast)
    }

    fn passing(&self, order: Order) -> Option<f64> {
        passing_velocity(order, &self.from, self.x, &self.limits.into(), f64::MAX).ok()?
    }

    fn plan(&self, order: Order, effort: Effort) -> Result<Transition, PlanError> {
        let target = Target::Position { x: self.x, v: self.v };
        Transition::plan(order, &self.from, &target, &DirectionalLimits::from(self.limits), effort)
    }
}

/// With velocities at the targets up to `passing` of the limit.
fn requests(passing: f64) -> Vec<Request> {
    let mut random = Random::seeded(4);
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
            let x = random.signed().signum() * random.decades(-2.0, 1.0);
            let request = Request { from, x, v: passing * limits.velocity * random.signed(), limits };
            let Ok(way) = request.plan(Order::Fourth, Effort::Fast) else { continue };
            all.push(request);
            from = Setpoint { x: 0.0, ..way.at(random.unit() * way.duration()) };
        }
    }
    all
}

/// From any state within the limits, which may force the velocity beyond its own.
fn anywhere() -> Vec<Request> {
    let mut random = Random::seeded(5);
    let mut all = requests(1.0);
    for Request { from, limits, .. } in &mut all {
        let Limits { velocity, acceleration, jerk, .. } = *limits;
        let [v, a, j] = [velocity, acceleration, jerk].map(|limit| limit * random.signed());
        *from = Setpoint { v, a, j, ..Setpoint::default() };
    }
    all
}

/// Mean time (ns) of `calls`, one after the other. What they return stays where they leave it: a copy of a plan takes up to half as
/// long as planning it at order 2, by where on the stack it lies.
fn time<T>(calls: u32, mut call: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    for _ in 0..calls {
        black_box(&call());
    }
    start.elapsed().as_nanos() as f64 / f64::from(calls)
}

/// Times of single calls (ns), sorted.
fn times<T>(requests: &[Request], mut call: impl FnMut(&Request) -> T) -> Vec<f64> {
    let mut times = vec![f64::INFINITY; requests.len()];
    for _ in 0..PASSES {
        for (request, shortest) in requests.iter().zip(&mut times) {
            *shortest = shortest.min(time(1, || call(black_box(request))));
            if *shortest < 1e3 {
                *shortest = shortest.min(time(IN_A_ROW, || call(black_box(request))));
            }
        }
    }
    times.sort_by(f64::total_cmp);
    times
}

/// Times the calls of `work`, unless only rows with other names are wanted.
fn row<T>(name: &str, requests: &[Request], work: impl FnMut(&Request) -> T) {
    let mut wanted = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).peekable();
    if wanted.peek().is_some() && !wanted.any(|part| name.contains(&part)) {
        return;
    }
    let times = times(requests, work);
    let at = |per_mille: usize| times[(times.len() - 1) * per_mille / 1000];
    println!(
        "{name:<36} {:>9.0} {:>9.0} {:>9.0} {:>9.0} {:>9.0}",
        at(500),
        at(900),
        at(990),
        at(999),
        times[times.len() - 1]
    );
}

/// `rsruckig` from `from` to the target of `request`.
struct Peer {
    ruckig: Ruckig<1, ThrowErrorHandler>,
    input: InputParameter<1>,
    trajectory: Trajectory<1>,
}

impl Peer {
    fn new() -> Self {
        Self { ruckig: Ruckig::new(None, 0.001), input: InputParameter::new(None), trajectory: Trajectory::new(None) }
    }

    fn plan(&mut self, from: &Setpoint, request: &Request) -> bool {
        let Self { ruckig, input, trajectory } = self;
        input.current_velocity[0] = from.v;
        input.current_acceleration[0] = from.a;
        input.target_position[0] = request.x;
        input.target_velocity[0] = request.v;
        input.max_velocity[0] = request.limits.velocity;
        input.max_acceleration[0] = request.limits.acceleration;
        input.max_jerk[0] = request.limits.jerk;
        ruckig.calculate(input, trajectory).is_ok()
    }
}

fn main() {
    let (stopping, passing) = (requests(0.0), requests(1.0));
    println!("{:<36} {:>9} {:>9} {:>9} {:>9} {:>9}", "plan, ns", "median", "90 %", "99 %", "99.9 %", "worst");
    row("nothing: what the clock takes", &stopping, |_| ());
    let mut peer = Peer::new();
    for (requests, what) in [(&stopping, "to rest"), (&passing, "to a velocity")] {
        row(&format!("order 4 {what}, fast"), requests, |r| r.plan(Order::Fourth, Effort::Fast));
        row(&format!("order 4 {what}, refined"), requests, |r| r.plan(Order::Fourth, Effort::Refined));
        row(&format!("order 3 {what}"), requests, |r| r.plan(Order::Third, Effort::Fast));
        row(&format!("order 3 {what}, rsruckig"), requests, |r| peer.plan(&r.from, r));
        row(&format!("order 2 {what}"), requests, |r| r.plan(Order::Second, Effort::Fast));
    }
    for (order, name) in [(Order::Second, "order 2"), (Order::Third, "order 3"), (Order::Fourth, "order 4")] {
        row(&format!("{name} to rest, two accelerations"), &stopping, |r| r.ramps(order));
        row(&format!("{name}, passing velocity"), &stopping, |r| r.passing(order));
    }
    let anywhere = anywhere();
    row("order 4 from anywhere, fast", &anywhere, |r| r.plan(Order::Fourth, Effort::Fast));
    row("order 4 from anywhere, refined", &anywhere, |r| r.plan(Order::Fourth, Effort::Refined));
    row("order 3 from anywhere", &anywhere, |r| r.plan(Order::Third, Effort::Fast));
    let at_rest = Setpoint::default();
    row("order 3 rest to rest, rsruckig", &stopping, |r| peer.plan(&at_rest, r));
    row("order 4 rest to rest, published", &stopping, |r| Profile::plan(Order::Fourth, r.x, &r.limits));
    row("order 4 rest to rest, optimal", &stopping, |r| Profile::plan_optimal(Order::Fourth, r.x, &r.limits));
    samples(&stopping);
}

/// One set-point of a planned way, over 1000 of each.
fn samples(requests: &[Request]) {
    const SAMPLES: u32 = 1000;
    let (mut by_time, mut by_piece, mut count) = (0.0, 0.0, 0.0);
    for request in requests.iter().take(1000) {
        let Ok(way) = request.plan(Order::Fourth, Effort::Fast) else { continue };
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
