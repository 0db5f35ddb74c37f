//! Random requests: the plan lands, keeps its limits, is on the grid, and wastes no sample.
//!
//! The oracle integrates the published segments in 106-bit arithmetic, in the order of time, without using moving averages.
use crate::double_double::Dd;
use crate::requests::{Random, Request, request, sweep_size};
use servobench_motion::{Limits, Order, PlanError, Profile};

/// Position and derivatives, with the one that the order holds constant last.
type State = [Dd; 5];

/// The exact hold of derivative n over `t`: Taylor's series.
fn hold(state: &State, n: usize, t: Dd) -> State {
    const INVERSE: [f64; 5] = [f64::NAN, 1.0, 2.0, 3.0, 4.0];
    let mut next = *state;
    for (k, slot) in next.iter_mut().enumerate().take(n) {
        let mut sum = Dd::ZERO;
        for m in (k..=n).rev() {
            sum = state[m] + if m < n { sum * t / Dd::from(INVERSE[m + 1 - k]) } else { Dd::ZERO };
        }
        *slot = sum;
    }
    next
}

fn limit(limits: &Limits, k: usize) -> f64 {
    [f64::NAN, limits.velocity, limits.acceleration, limits.jerk, limits.snap][k]
}

/// Integrates the segments; checks the limits at the ends of all segments, where the derivatives have their extremes
/// (each is monotone inside a segment of its neighbour's constant sign), and returns the largest relative excess.
fn integrate(plan: &Profile, limits: &Limits, what: &dyn std::fmt::Debug) -> f64 {
    let n = plan.order().derivative();
    let mut state: State = [Dd::ZERO; 5];
    let (mut excess, mut end) = (0.0_f64, 0.0_f64);
    let mut peaks = [0.0_f64; 5];
    for segment in plan.segments() {
        // Starts are sums of at most four lengths.
        assert!((segment.start - end).abs() <= 4.0 * f64::EPSILON * plan.duration(), "{what:?}: a gap at {end}");
        end = segment.start + segment.length;
        state[n] = segment.value.into();
        state = hold(&state, n, segment.length.into());
        for k in 1..=n {
            peaks[k] = peaks[k].max(state[k].value().abs());
            excess = excess.max(state[k].value().abs() / limit(limits, k) - 1.0);
        }
    }
    // The closed forms and the sum of the segments differ by the rounding of a few products.
    let peak = plan.peaks();
    let closed = [f64::NAN, peak.velocity, peak.acceleration, peak.jerk, peak.snap];
    for k in 1..=n {
        assert!((peaks[k] / closed[k] - 1.0).abs() < 1e-14, "{what:?}: peak {k} {} {}", peaks[k], closed[k]);
    }
    assert!((end / plan.duration() - 1.0).abs() < 1e-15, "{what:?}: {end} {}", plan.duration());
    // Position: lengths and amplitude are rounded a few times each. The rest is zero by the symmetry of the lengths.
    assert!((state[0].value() / plan.distance() - 1.0).abs() < 1e-14, "{what:?}: lands at {}", state[0].value());
    for k in 1..n {
        // 106 bits are 1e-32; a residue of one derivative drifts into the one below.
        let tolerance = 1e-30 * (peaks[k] + peaks[k + 1] * plan.duration());
        assert!(state[k].value().abs() < tolerance, "{what:?}: derivative {k} is left over");
    }
    excess
}

/// The counts again in 106 bits: each is the smallest for its step.
///
/// Step k fixes average k; those behind it are the sums of their predecessors. Its amplitude is the one at which the
/// tightest bound is met. One sample less would not have reached that bound with the amplitude of the step before.
fn check_counts(request: &Request, counts: &[u64], what: &dyn std::fmt::Debug) {
    let n = request.order.derivative();
    let ts = Dd::from(request.sample_time);
    // By the number of averages in the product that it bounds: 0 is the highest derivative, n the distance.
    let mut bounds = vec![Dd::from(request.distance.abs())];
    let mut power = Dd::from(1.0);
    for k in 1..=n {
        power = power * ts;
        bounds.insert(0, Dd::from(limit(&request.limits, k)) * power);
    }
    let product = |boxes: &[f64], m: usize| {
        let mut all = boxes.to_vec();
        while all.len() < m {
            all.push(all.iter().sum());
        }
        all[..m].iter().fold(Dd::from(1.0), |product, length| product * Dd::from(*length))
    };
    let mut boxes: Vec<f64> = Vec::new();
    let mut amplitude = bounds[0];
    for (k, count) in counts[..n].iter().enumerate() {
        let shortest: f64 = boxes.iter().sum();
        let count = *count as f64;
        assert!(count >= shortest.max(1.0), "{what:?}: box {k} of {count} is shorter than {shortest}");
        let shorter: Vec<f64> = boxes.iter().copied().chain([count - 1.0]).collect();
        boxes.push(count);
        let to_meet: Vec<Dd> = (k + 1..=n).map(|m| bounds[m] / product(&boxes, m)).collect();
        let next = to_meet.iter().copied().min_by(|a, b| a.value().total_cmp(&b.value())).unwrap();
        // The planner's comparison in f64 forgives 16 ulp, so that each step may gain that much.
        let slack = 1.0 + 20.0 * f64::EPSILON;
        assert!((next / amplitude).value() < slack, "{what:?}: step {k} raises the amplitude");
        let needed = (k + 1..=n).zip(&to_meet).any(|(m, meets)| {
            let tight = (*meets / next).value() < slack;
            tight && (amplitude * product(&shorter, m) / bounds[m]).value() < 1.0
        });
        assert!(needed || count <= shortest, "{what:?}: box {k}: {} would do", count - 1.0);
        amplitude = next;
    }
}

#[test]
fn sampled_plans_land_keep_their_limits_and_waste_nothing() {
    let mut random = Random::seeded(4);
    let (mut worst, mut refused) = (0.0_f64, 0);
    for _ in 0..sweep_size() {
        let request = request(&mut random);
        let Request { order, distance, limits, sample_time } = request;
        let continuous = Profile::plan(order, distance, &limits).unwrap();
        let plan = match Profile::plan_sampled(order, distance, &limits, sample_time) {
            Ok(plan) => plan,
            Err(e) => {
                let too_many = continuous.duration() / sample_time > 9e15;
                assert!(matches!(e, PlanError::TooManySamples { .. }) && too_many, "{request:?}: {e}");
                refused += 1;
                continue;
            }
        };
        let samples = plan.samples().unwrap();
        for segment in plan.segments() {
            for time in [segment.start, segment.length] {
                let whole = (time / sample_time).round() * sample_time;
                assert_eq!(time.to_bits(), whole.to_bits(), "{request:?}: {time} is no whole number of samples");
            }
        }
        worst = worst.max(integrate(&plan, &limits, &request));
        check_counts(&request, &samples.boxes, &request);
        // The continuous move is the shortest of its shape; it treats 1e-12 as no dwell.
        assert!(plan.duration() >= continuous.duration() * (1.0 - 1e-11), "{request:?}: faster than continuous");
    }
    // At most four steps of 16 ulp; the bar is 1e-9.
    assert!(worst < 2e-14, "a limit is exceeded by {worst:e}");
    assert!(refused * 100 <= sweep_size(), "{refused} refusals: the sweep tests too little");
}

#[test]
fn continuous_plans_land_and_keep_their_limits() {
    let mut random = Random::seeded(40);
    let mut worst = 0.0_f64;
    for _ in 0..sweep_size() {
        let request = request(&mut random);
        let plan = Profile::plan(request.order, request.distance, &request.limits).unwrap();
        worst = worst.max(integrate(&plan, &request.limits, &request));
        assert!(plan.samples().is_none());
    }
    // A dwell below 1e-12 of its average is dropped, which an average enters with its fourth power at most; the bar is 1e-9.
    assert!(worst < 4e-12, "a limit is exceeded by {worst:e}");
}

/// The limits under which the same continuous move lasts `k` times as long: v/k, a/k², j/k³, s/k⁴.
fn slowed(limits: Limits, k: f64) -> Limits {
    Limits {
        velocity: limits.velocity / k,
        acceleration: limits.acceleration / (k * k),
        jerk: limits.jerk / (k * k * k),
        snap: limits.snap / (k * k * k * k),
    }
}

#[test]
fn a_stretched_plan_is_the_same_move_in_the_given_time() {
    let mut random = Random::seeded(400);
    for _ in 0..sweep_size() / 10 {
        let request = request(&mut random);
        let Request { order, distance, limits, sample_time } = request;
        let factor = 1.0 + 3.0 * random.unit();
        let continuous = Profile::plan(order, distance, &limits).unwrap();
        let wanted = factor * continuous.duration();
        let stretched = continuous.stretched_to(wanted).unwrap();
        let replanned = Profile::plan(order, distance, &slowed(limits, factor)).unwrap();
        assert!((stretched.duration() / wanted - 1.0).abs() < 1e-15, "{request:?}");
        assert!(integrate(&stretched, &slowed(limits, factor), &request) < 4e-12, "{request:?}");
        // The scaled limits are rounded; the duration depends on each of them with a power of at most one.
        assert!((replanned.duration() / wanted - 1.0).abs() < 1e-11, "{request:?}: {}", replanned.duration());

        let Ok(sampled) = Profile::plan_sampled(order, distance, &limits, sample_time) else {
            continue;
        };
        let wanted = factor * sampled.duration();
        let stretched = sampled.stretched_to(wanted).unwrap();
        let samples = stretched.samples().unwrap();
        let late = samples.total() as f64 - wanted / sample_time;
        // The quotient itself is only known to two ulp, and rounding up forgives two.
        let blur = 1e-9 + 4.0 * f64::EPSILON * wanted / sample_time;
        assert!((-blur..1.0 + blur).contains(&late), "{request:?}: {late} samples late");
        integrate(&stretched, &Limits { snap: limits.snap * 2.0, ..limits }, &request);
        for (before, after) in sampled.samples().unwrap().boxes.into_iter().zip(samples.boxes) {
            assert!(after >= before, "{request:?}: a shorter box means a higher peak");
        }
        let mut sum = 0;
        for count in &samples.boxes[..order.derivative()] {
            assert!(*count >= sum, "{request:?}: {:?} are out of order", samples.boxes);
            sum += count;
        }
    }
}

#[test]
fn whole_samples_stay_whole_however_the_duration_was_rounded() {
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
    for rate in [1000_u32, 3000, 16_000] {
        let ts = 1.0 / f64::from(rate);
        let plan = Profile::plan_sampled(Order::Fourth, 0.01, &limits, ts).unwrap();
        let shortest = plan.samples().unwrap().total();
        for total in shortest..shortest + 300 {
            for duration in [total as f64 * ts, total as f64 / f64::from(rate)] {
                let stretched = plan.stretched_to(duration).unwrap();
                assert_eq!(stretched.samples().unwrap().total(), total, "{duration} s at {rate} Hz");
            }
        }
    }
}

#[test]
fn a_move_cannot_be_stretched_below_its_duration() {
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
    let continuous = Profile::plan(Order::Fourth, 1.0, &limits).unwrap();
    let sampled = Profile::plan_sampled(Order::Fourth, 1.0, &limits, 1e-3).unwrap();
    for plan in [continuous, sampled] {
        assert_eq!(plan.stretched_to(plan.duration()), Ok(plan));
        assert!(matches!(plan.stretched_to(1.34), Err(PlanError::TooShort { .. })));
        assert!(matches!(plan.stretched_to(1e61), Err(PlanError::OutOfRange { .. })));
        assert!(matches!(plan.stretched_to(f64::NAN), Err(PlanError::Parameter(_))));
    }
    assert!(matches!(sampled.stretched_to(1e20), Err(PlanError::TooManySamples { .. })));
    let nothing = Profile::plan(Order::Third, 0.0, &limits).unwrap();
    assert_eq!(nothing.stretched_to(5.0), Ok(nothing));
}
