//! Moves aborted by moves: at any instant, with new targets and now and then with new limits.
use crate::random::{Random, limits, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};

/// State of one chain.
struct Chain {
    random: Random,
    /// Limits around which the others change.
    usual: DirectionalLimits,
    limits: DirectionalLimits,
    /// True if a path begins within other limits than those of its plan.
    is_changed: bool,
    /// Distance that fills the velocity limit in about the time that the limits take.
    length: f64,
    state: Setpoint,
}

impl Chain {
    fn new(seed: u64) -> Self {
        let mut random = Random::seeded(seed);
        let (d, t) = (random.decades(-6.0, 9.0), random.decades(-3.0, 1.0));
        let limits = limits(&mut random, d, t);
        Self { random, usual: limits, limits, is_changed: false, length: d * t * t * t * t, state: Setpoint::default() }
    }

    /// New limits now and then, as of the next command: each between two thirds and one and a half of the usual one.
    fn change_limits(&mut self) {
        if self.random.unit() < 0.8 {
            return;
        }
        let DirectionalLimits { velocity, acceleration, jerk, snap } = self.usual;
        let mut around = |value: f64| value * self.random.decades(-0.18, 0.18);
        let mut sides = |Sides { below, above }: Sides| Sides { below: around(below), above: around(above) };
        let (velocity, acceleration) = (sides(velocity), sides(acceleration));
        self.limits = DirectionalLimits { velocity, acceleration, jerk: around(jerk), snap: around(snap) };
        self.is_changed = true;
    }

    fn target(&mut self) -> Target {
        let Sides { below, above } = self.limits.velocity;
        let draw = 4.0 * self.random.signed();
        let v = if draw > 2.0 {
            above * self.random.unit()
        } else if draw < -2.0 {
            -below * self.random.unit()
        } else {
            0.0
        };
        if self.random.unit() < 0.1 {
            return Target::Velocity(v);
        }
        let away = self.random.signed().signum() * self.length * self.random.decades(-3.0, 1.5);
        Target::Position { x: self.state.x + away, v }
    }
}

/// Largest part by which a set-point of `planned` is beyond the limits, and the largest jump of one where pieces join.
fn check(planned: &Transition, chain: &Chain, target: &Target, what: &str) {
    let DirectionalLimits { velocity, acceleration, jerk, .. } = chain.limits;
    let context = || format!("{what}: from {:?} to {target:?} within {:?}: {planned:?}", chain.state, chain.limits);
    assert!(planned.duration().is_finite() && (planned.excess() <= 1e-9 || chain.is_changed), "{}", context());
    // Excess that the state forces, or that is reported.
    let allowed = 1.0 + planned.excess() + 1e-9;
    let mut last: Option<Setpoint> = None;
    for segment in planned.segments() {
        for part in [0.0, 0.3, 0.7, 1.0 - 1e-9] {
            let at = planned.at(segment.start + part * segment.length);
            let inside = |sides: Sides, value: f64| value <= sides.above * allowed && value >= -sides.below * allowed;
            assert!(inside(velocity, at.v) && inside(acceleration, at.a), "{at:?} {}", context());
            assert!(planned.order() < Order::Fourth || at.j.abs() <= jerk * allowed, "{at:?} {}", context());
            if let (0.0, Some(before)) = (part, last) {
                // 1e-9 of a segment before it ends.
                let close = |one: f64, two: f64, size: f64| (one - two).abs() <= 1e-8 * size;
                assert!(close(before.v, at.v, velocity.above + velocity.below), "{before:?} {at:?} {}", context());
                let is_smooth = close(before.a, at.a, acceleration.above + acceleration.below);
                assert!(planned.order() == Order::Second || is_smooth, "{before:?} {at:?} {}", context());
            }
            last = Some(at);
        }
    }
    // End of the polynomials, and the target.
    let (before, end) = (planned.at(planned.duration().next_down()), planned.at(planned.duration()));
    let travel = match target {
        Target::Position { x, .. } => (x - chain.state.x).abs() + chain.length,
        Target::Velocity(_) => chain.length,
    };
    if planned.duration() > 0.0 {
        let Sides { below, above } = velocity;
        assert!((before.x - end.x).abs() <= 1e-9 * travel, "{before:?} {end:?} {}", context());
        assert!((before.v - end.v).abs() <= 1e-9 * (below + above), "{before:?} {end:?} {}", context());
        let is_smooth = (before.a - end.a).abs() <= 1e-9 * (acceleration.below + acceleration.above);
        assert!(planned.order() == Order::Second || is_smooth, "{before:?} {}", context());
        assert!(planned.order() < Order::Fourth || (before.j - end.j).abs() <= 1e-9 * jerk, "{before:?} {}", context());
    }
    match target {
        Target::Position { x, v } => assert_eq!((end.x.to_bits(), end.v.to_bits()), (x.to_bits(), v.to_bits())),
        Target::Velocity(v) => assert_eq!(end.v.to_bits(), v.to_bits()),
    }
}

fn chains(order: Order, effort: Effort, aborts: usize) {
    const LINKS: usize = 20;
    let (mut plans, mut beyond) = (0, 0);
    for seed in 0..aborts.div_ceil(LINKS) as u64 {
        let mut chain = Chain::new(seed);
        for link in 0..LINKS {
            chain.change_limits();
            let target = chain.target();
            let planned = Transition::plan(order, &chain.state, &target, &chain.limits, effort).unwrap();
            check(&planned, &chain, &target, &format!("seed {seed}, link {link}"));
            (plans, beyond) = (plans + 1, beyond + usize::from(planned.excess() > 1e-9));
            chain.is_changed &= planned.excess() > 1e-9;
            chain.state = planned.at(chain.random.unit() * planned.duration());
            // As in a drive: the position restarts now and then.
            chain.state.x = chain.random.signed() * chain.length;
        }
    }
    println!("{order:?}: {beyond} of {plans} begin where new limits are exceeded");
    assert!(200 * beyond > plans && 5 * beyond < plans, "{beyond} of {plans}");
}

#[test]
fn order_4_fast_never_fails() {
    chains(Order::Fourth, Effort::Fast, sweep_size(100_000));
}

#[test]
fn order_4_refined_never_fails() {
    chains(Order::Fourth, Effort::Refined, sweep_size(100_000) / 100);
}

#[test]
fn order_3_never_fails() {
    chains(Order::Third, Effort::Fast, sweep_size(100_000));
}

#[test]
fn order_2_never_fails() {
    chains(Order::Second, Effort::Fast, sweep_size(100_000));
}

/// Two in a thousand are longer, and two in ten thousand by more than a tenth; the bounds leave room for other draws.
#[test]
fn order_4_fast_is_nearly_always_the_refined_one() {
    let (mut longer, mut much_longer, count) = (0, 0, sweep_size(100_000) / 5);
    for seed in 0..count as u64 / 20 {
        let mut chain = Chain::new(seed);
        for _ in 0..20 {
            let target = chain.target();
            let [fast, refined] = [Effort::Fast, Effort::Refined]
                .map(|effort| Transition::plan(Order::Fourth, &chain.state, &target, &chain.limits, effort).unwrap());
            let ratio = fast.duration() / refined.duration();
            longer += usize::from(ratio > 1.0 + 1e-9);
            much_longer += usize::from(ratio > 1.1);
            chain.state = fast.at(chain.random.unit() * fast.duration());
        }
    }
    assert!(longer * 1000 <= 4 * count, "{longer} of {count} are longer");
    assert!(much_longer * 1000 <= count, "{much_longer} of {count} are longer by more than a tenth");
}
