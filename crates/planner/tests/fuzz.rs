//! Any request: a plan or a refusal in words, never a panic, never a set-point that is not a number.
use servobench_base::Setpoint;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz, produce};
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target};
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};
use servobench_motion::sampled::Execution;
use servobench_motion::shape::Shaper;
use servobench_motion::{Limits, Order};
use servobench_planner::{
    Averages, CommandCycle, CommandRate, Filter, Follow, Generator, Grid, Method, Plan, PointToPoint, Replanning,
    Request, Rockwell, Sampling, Shaping, TableMove, Velocities,
};
use std::f64::consts::TAU;

/// Numbers for a request of any family, and the choice of family and variant.
#[derive(Debug)]
struct Asked {
    family: u8,
    variant: u8,
    signed: [f64; 6],
    magnitudes: [f64; 8],
    filter: u8,
}

fn asked() -> impl ValueGenerator<Output = Asked> {
    let (signed, magnitude) = (Number::any(), Number::magnitude());
    (0..4_u8, produce::<u8>(), [signed; 6], [magnitude; 8], produce::<u8>())
        .map_gen(|(family, variant, signed, magnitudes, filter)| Asked { family, variant, signed, magnitudes, filter })
}

impl Asked {
    fn order(&self) -> Order {
        [Order::Second, Order::Third, Order::Fourth][usize::from(self.variant % 3)]
    }

    fn generator(&self) -> Generator {
        let ([x, v, a, j, distance, end], [velocity, acceleration, jerk, snap, time, other, ..]) =
            (self.signed, self.magnitudes);
        let is = |bit: u8| self.variant >> bit & 1 == 1;
        match self.family {
            0 => Generator::PointToPoint(PointToPoint {
                distance,
                order: self.order(),
                limits: Limits { velocity, acceleration, jerk, snap },
                method: if is(7) { Method::Optimal } else { Method::Published },
                grid: is(6).then_some(Grid {
                    sample_time: time,
                    sampling: if is(5) { Sampling::Fewest } else { Sampling::Published },
                    execution: if is(4) { Execution::ForwardEuler } else { Execution::ExactHold },
                }),
            }),
            1 => Generator::Replanning(Replanning {
                from: Setpoint { x, v, a, j, s: 0.0 },
                target: if is(7) { Target::Velocity(end) } else { Target::Position { x: distance, v: end } },
                order: self.order(),
                limits: DirectionalLimits {
                    velocity: Sides { below: velocity, above: time },
                    acceleration: Sides { below: acceleration, above: other },
                    jerk,
                    snap,
                },
                effort: if is(6) { Effort::Refined } else { Effort::Fast },
            }),
            2 => {
                let shape = match self.variant % 3 {
                    0 => Shape::Trapezoid,
                    1 => Shape::SCurve { acceleration: Jerk::Value(jerk), deceleration: Jerk::PercentOfTime(time) },
                    _ => Shape::SCurve {
                        acceleration: Jerk::PercentOfTime(jerk),
                        deceleration: Jerk::PercentOfMaximum(time),
                    },
                };
                let (deceleration, maximum) = (snap, MaximumJerk { acceleration: other, deceleration: other });
                Generator::Rockwell(Rockwell {
                    operands: Move { distance, speed: velocity, acceleration, deceleration, shape },
                    maximum,
                })
            }
            _ => {
                let times = [velocity, acceleration, jerk, snap].into_iter().scan(0.0, |t, step| {
                    *t += step;
                    Some(*t)
                });
                let knots = times.zip([x, v, a, j]).enumerate();
                let knots = knots.map(|(k, (t, x))| Knot { t, x, v: (k % 2 == 1).then_some(end) }).collect();
                let velocities = match self.variant % 4 {
                    0 => Velocities::Given,
                    1 => Velocities::Average,
                    2 => Velocities::Smooth { passes: u32::from(self.variant >> 4) },
                    _ => Velocities::Continuous,
                };
                let follow = match self.variant >> 2 & 3 {
                    0 => Follow::Plateaus { share: time.into() },
                    1 => Follow::Steps { rate: CommandRate::Given(time) },
                    2 => Follow::Steps { rate: CommandRate::LowestWithin(time) },
                    _ => Follow::Segments,
                };
                Generator::Table(TableMove { knots, velocities, follow })
            }
        }
    }

    fn request(&self) -> Request {
        let [.., one, other] = self.magnitudes;
        let frequency = one / TAU;
        let zvd = Shaping { shaper: Shaper::Zvd, frequency, damping: 0.1 };
        let ei = Shaping { shaper: Shaper::Ei { tolerable: 0.05 }, frequency: 2.5 * frequency, damping: 0.02 };
        let mut shapers = match self.filter % 4 {
            0 => vec![zvd],
            1 => vec![ei],
            2 => vec![zvd, ei],
            _ => Vec::new(),
        };
        shapers.retain(|shaping| shaping.impulses().is_ok());
        // As many samples as a user would accept.
        let averages = (self.filter.is_multiple_of(7) && other > 1e-3)
            .then(|| Averages { lengths: vec![3.0 * other, other], sample_time: other });
        let duration = self.filter.is_multiple_of(5).then_some(one);
        let unit = if self.variant.is_multiple_of(2) { other } else { 0.0 };
        let cycle = CommandCycle { period: one, first: self.signed[5], unit };
        let commands = self.filter.is_multiple_of(3).then_some(cycle);
        Request { duration, filter: Filter { shapers, averages }, commands, ..Request::new(self.generator()) }
    }
}

fn is_finite(setpoint: Setpoint) -> bool {
    let Setpoint { x, v, a, j, s } = setpoint;
    [x, v, a, j, s].iter().all(|value| value.is_finite())
}

fn holds(plan: &Plan) {
    let duration = plan.duration();
    assert!(duration >= 0.0 && duration.is_finite(), "{plan:?}");
    for part in [-1.0, 0.0, 1e-9, 0.1, 0.5, 0.75, 1.0 - 1e-9, 1.0, 2.0] {
        assert!(is_finite(plan.at(part * duration)), "{} at {part} of {plan:?}", plan.at(part * duration).x);
    }
    let (start, length) = plan.cruise();
    assert!(length >= 0.0 && start >= 0.0 && start + length <= duration * (1.0 + 1e-9), "{start} {length} of {plan:?}");
    for peak in &plan.peaks()[..plan.order()] {
        assert!(peak.lowest <= peak.highest && peak.lowest.is_finite() && peak.highest.is_finite(), "{peak:?}");
    }
    for binding in plan.bindings() {
        assert!(binding.start >= 0.0 && binding.length >= 0.0 && binding.value.is_finite(), "{binding:?} of {plan:?}");
    }
}

/// Long moves of short samples take time: they are covered by the planners' own targets.
fn is_quick(request: &Request) -> bool {
    match &request.generator {
        Generator::PointToPoint(PointToPoint { grid: Some(grid), distance, order, limits, .. }) => {
            Request::new(Generator::PointToPoint(PointToPoint {
                grid: None,
                distance: *distance,
                order: *order,
                limits: *limits,
                method: Method::Published,
            }))
            .plan()
            .map_or(true, |plan| plan.duration() / grid.sample_time < 3e3)
        }
        Generator::Table(TableMove {
            follow: Follow::Steps { rate: CommandRate::Given(rate) | CommandRate::LowestWithin(rate) },
            knots,
            ..
        }) => {
            let rate = request.commands.map_or(*rate, |cycle| rate.max(1.0 / cycle.period));
            let length = knots.last().map_or(0.0, |last| last.t);
            (rate * length).abs() < 1e4 || !rate.is_finite()
        }
        _ => true,
    }
}

#[test]
fn requests() {
    fuzz(check!(), 5_000, asked(), |asked| {
        let request = asked.request();
        if !is_quick(&request) {
            return;
        }
        let quick = request.filter.averages.as_ref().is_none_or(|averages| {
            let plain = Request { filter: Filter::NONE, ..request.clone() };
            plain.plan().map_or(true, |plan| plan.duration() / averages.sample_time < 1e4)
        });
        if !quick {
            return;
        }
        match request.plan() {
            Ok(plan) => holds(&plan),
            Err(error) => assert!(error.to_string().len() > 15, "{error}"),
        }
    });
}
