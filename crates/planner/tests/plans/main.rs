//! Plans of every family against their generators.
mod peaks;

use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::position_profile::PlateauShare;
use servobench_motion::pvt::{Knot, Table, average, continuous};
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape};
use servobench_motion::sampled::Execution;
use servobench_motion::shape::{Shaper, Vibration};
use servobench_motion::{Limits, Order, PlanError, Profile};
use servobench_planner::{
    Averages, Binding, CommandRate, Filter, Follow, Generator, Grid, Method, Peak, Plan, PlanDetails, PointToPoint,
    Reader, Replanning, Request, Rockwell, Sampling, Sending, Shaping, TableMove, Velocities,
};
use std::f64::consts::TAU;

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

fn point_to_point(distance: f64, method: Method) -> Generator {
    Generator::PointToPoint(PointToPoint { distance, order: Order::Fourth, limits: LIMITS, method, grid: None })
}

/// 0.02 m, in samples of 1 ms.
fn sampled(sampling: Sampling, execution: Execution) -> Generator {
    let grid = Some(Grid { sample_time: 1e-3, sampling, execution });
    let (order, method) = (Order::Fourth, Method::Published);
    Generator::PointToPoint(PointToPoint { distance: 0.02, order, limits: LIMITS, method, grid })
}

/// A shaper for a vibration of 60 rad/s.
fn shaping(shaper: Shaper, damping: f64) -> Shaping {
    Shaping { shaper, frequency: 60.0 / TAU, damping }
}

fn plan(generator: Generator) -> Plan {
    Request::new(generator).plan().unwrap()
}

/// A transition from a state of motion, with limits by direction.
fn replanning() -> Replanning {
    Replanning {
        from: Setpoint { x: 0.1, v: 0.4, a: 1.0, j: -5.0, s: 0.0 },
        target: Target::Position { x: -0.5, v: -0.2 },
        order: Order::Fourth,
        limits: DirectionalLimits {
            velocity: Sides { below: 0.8, above: 1.0 },
            acceleration: Sides { below: 4.0, above: 5.0 },
            jerk: 50.0,
            snap: 1000.0,
        },
        effort: Effort::Fast,
    }
}

fn table(follow: Follow, velocities: Velocities) -> TableMove {
    let knots = [(0.5, 0.0), (0.6, 0.01), (0.75, 0.04), (0.9, 0.03), (1.0, 0.05)].map(|(t, x)| Knot::new(t, x));
    TableMove { knots: knots.to_vec(), velocities, follow }
}

/// One of each family, and a filtered one.
fn all() -> Vec<Plan> {
    let rockwell = Rockwell {
        operands: Move {
            distance: -0.1,
            speed: 0.2,
            acceleration: 10.0,
            deceleration: 20.0,
            shape: Shape::SCurve { acceleration: Jerk::PercentOfTime(25.0), deceleration: Jerk::PercentOfTime(60.0) },
        },
        maximum: MaximumJerk { acceleration: 1e4, deceleration: 1e4 },
    };
    let shaper = shaping(Shaper::Zvd, 0.02);
    let shaped = |duration| Request {
        duration,
        filter: Filter { shapers: vec![shaper], averages: None },
        ..Request::new(point_to_point(0.3, Method::Published))
    };
    let averages = Averages { lengths: vec![0.01, 0.025], sample_time: 1e-3 };
    let averaged = Request {
        filter: Filter { shapers: vec![shaper], averages: Some(averages) },
        ..Request::new(point_to_point(0.3, Method::Published))
    };
    vec![
        plan(point_to_point(1.0, Method::Published)),
        plan(point_to_point(-0.02, Method::Optimal)),
        plan(sampled(Sampling::Fewest, Execution::ExactHold)),
        plan(sampled(Sampling::Published, Execution::ForwardEuler)),
        plan(Generator::Replanning(replanning())),
        plan(Generator::Rockwell(rockwell)),
        plan(Generator::Table(table(Follow::Segments, Velocities::Continuous))),
        plan(Generator::Table(table(Follow::Segments, Velocities::Given))),
        plan(Generator::Table(table(Follow::Plateaus { share: 0.25.into() }, Velocities::Given))),
        plan(Generator::Table(table(Follow::Steps { rate: CommandRate::Given(500.0) }, Velocities::Given))),
        shaped(None).plan().unwrap(),
        shaped(Some(2.0)).plan().unwrap(),
        averaged.plan().unwrap(),
    ]
}

fn values(setpoint: Setpoint) -> [f64; 5] {
    let Setpoint { x, v, a, j, s } = setpoint;
    [x, v, a, j, s]
}

#[test]
fn a_plan_is_what_its_generator_says() {
    let profile = Profile::plan_optimal(Order::Fourth, -0.02, &LIMITS).unwrap();
    let Replanning { from, target, order, limits, effort } = replanning();
    let transition = Transition::plan(order, &from, &target, &limits, effort).unwrap();
    let mut knots = table(Follow::Segments, Velocities::Given).knots;
    average(&mut knots, 0.0, 0.0).unwrap();
    let through = Table::new(&knots).unwrap();
    let [optimal, moving] = [point_to_point(-0.02, Method::Optimal), Generator::Replanning(replanning())].map(plan);
    let averaged = plan(Generator::Table(table(Follow::Segments, Velocities::Average)));
    for k in 0..=1000_u32 {
        let part = f64::from(k) / 1000.0;
        let t = part * profile.duration();
        assert_eq!(optimal.at(t), profile.at(t), "{t}");
        let t = part * transition.duration();
        assert_eq!(moving.at(t), transition.at(t), "{t}");
        // The table begins at 0.5 s; a difference of times rounds to 1e-16 s, at velocities up to 1 m/s.
        let t = part * through.duration();
        assert!((averaged.at(t).x - through.at(0.5 + t).x).abs() < 1e-15, "{t}");
    }
    let PlanDetails::Transition { excess, .. } = moving.details() else { panic!("{:?}", moving.details()) };
    assert_eq!(excess.to_bits(), transition.excess().to_bits());
}

#[test]
fn a_reader_finds_what_a_look_up_finds() {
    for plan in all() {
        let mut reader = Reader::default();
        reader.look_up(&plan, 0.0);
        for k in 0..=20_000_u32 {
            let t = f64::from(k) / 20_000.0 * plan.duration();
            if !reader.holds(t) {
                reader.look_up(&plan, t);
            }
            assert_eq!(values(reader.at(t)).map(f64::to_bits), values(plan.at(t)).map(f64::to_bits), "{t} of {plan:?}");
        }
    }
}

/// Oracle: the shaper's own sum, and a mode that vanishes: ZVD at its frequency.
#[test]
fn a_shaped_plan_is_the_sum_of_its_parts() {
    let shaper = shaping(Shaper::Zvd, 0.02);
    let impulses = shaper.impulses().unwrap();
    let generator = point_to_point(0.3, Method::Optimal);
    let request = Request { filter: Filter { shapers: vec![shaper], averages: None }, ..Request::new(generator) };
    let plain = Profile::plan_optimal(Order::Fourth, 0.3, &LIMITS).unwrap();
    let shaped = request.plan().unwrap();
    assert!((shaped.duration() - plain.duration() - impulses.duration()).abs() < 1e-15);
    for k in -10..=1010_i32 {
        let t = f64::from(k) / 1000.0 * shaped.duration();
        assert_eq!(shaped.at(t), impulses.shape(t, |t| plain.at(t)), "{t}");
    }
    assert_eq!(shaped.end(), Setpoint::at_rest(0.3));
    let stretched = Request { duration: Some(3.0), ..request.clone() }.plan().unwrap();
    assert!((stretched.duration() - 3.0).abs() < 1e-12);
    let refused = Request { duration: Some(0.5), ..request }.plan().unwrap_err();
    assert!(matches!(refused, PlanError::TooShort { shortest, .. } if (shortest - shaped.duration()).abs() < 1e-12));
}

/// Oracle: the sum of parts applied twice, and that each shaper in series suppresses its own mode.
#[test]
fn shapers_of_several_modes_stand_one_behind_the_other() {
    let low = Shaping { shaper: Shaper::Zvd, frequency: 11.0, damping: 0.02 };
    let high = Shaping { shaper: Shaper::TwoHumpEi { tolerable: 0.05 }, frequency: 37.0, damping: 0.1 };
    let filter = Filter { shapers: vec![low, high], averages: None };
    let both = filter.impulses().unwrap().unwrap();
    assert_eq!(both.iter().len(), 12);
    for Shaping { frequency, damping, .. } in &filter.shapers {
        let residual = |off: f64| both.residual(&Vibration::new(TAU * frequency * off, *damping).unwrap());
        assert!(residual(1.0) < 1e-14 && residual(1.3) > 1e-5, "{frequency} Hz: {:e}", residual(1.0));
    }
    let plan = |filter| Request { filter, ..Request::new(point_to_point(0.3, Method::Optimal)) }.plan().unwrap();
    let plain = plan(Filter::NONE);
    let [of_low, of_high] = [low, high].map(|shaping| shaping.impulses().unwrap());
    let shaped = plan(filter);
    assert!((shaped.duration() - plain.duration() - of_low.duration() - of_high.duration()).abs() < 1e-15);
    for k in -10..=1010_i32 {
        let t = f64::from(k) / 1000.0 * shaped.duration();
        let expected = of_low.shape(t, |t| of_high.shape(t, |t| plain.at(t)));
        assert!((shaped.at(t).x - expected.x).abs() < 1e-15 && (shaped.at(t).j - expected.j).abs() < 1e-12, "{t}");
    }
    assert_eq!(shaped.end(), Setpoint::at_rest(0.3));
    let zvdd = |frequency| Shaping { shaper: Shaper::Zvdd, frequency, damping: 0.0 };
    let long = Filter { shapers: [9.0, 17.0, 29.0].map(zvdd).to_vec(), averages: None };
    let refused = Request { filter: long, ..Request::new(point_to_point(0.3, Method::Optimal)) }.plan().unwrap_err();
    assert!(matches!(refused, PlanError::TooManyImpulses { impulses: 64, capacity: 32 }), "{refused}");
}

/// Oracle: a mean written as a sum.
#[test]
fn averages_are_means_of_the_last_samples() {
    let generator = point_to_point(0.3, Method::Published);
    let averages = Averages { lengths: vec![0.008], sample_time: 2e-3 };
    let filter = Filter { shapers: Vec::new(), averages: Some(averages) };
    let averaged = Request { filter: filter.clone(), ..Request::new(generator.clone()) }.plan().unwrap();
    let plain = plan(generator.clone());
    for k in 0..400_u32 {
        let t = f64::from(k) * 2e-3;
        let mean = (0..4).map(|i| plain.at(t - f64::from(i) * 2e-3).x).sum::<f64>() / 4.0;
        assert!((averaged.at(t + 1e-3).x - mean).abs() < 1e-15, "{t}");
    }
    assert_eq!(averaged.end(), Setpoint::at_rest(0.3));
    let odd = Averages { lengths: vec![0.009], sample_time: 2e-3 };
    let refused =
        Request { filter: Filter { averages: Some(odd), ..filter }, ..Request::new(generator) }.plan().unwrap_err();
    assert_eq!(refused.to_string(), "`averages` must be a whole number of samples, 1 to 10 million, got 0.009");
}

/// The motion of a drive by velocity commands differs from the spline by the announced error: at most, and at some time by exactly that.
#[test]
fn commands_lead_as_near_to_the_spline_as_announced() {
    let plan = plan(Generator::Table(table(Follow::Steps { rate: CommandRate::Given(200.0) }, Velocities::Given)));
    let PlanDetails::Commands { commands, error, .. } = plan.details() else { panic!("{:?}", plan.details()) };
    assert_eq!(commands.len(), 100);
    let mut knots = table(Follow::Segments, Velocities::Given).knots;
    let mut scratch = [0.0; 5];
    continuous(&mut knots, 0.0, 0.0, &mut scratch).unwrap();
    let spline = Table::new(&knots).unwrap();
    let off = |k: u32| {
        let t = 0.5 * f64::from(k) / 500_000.0;
        (plan.at(t).x - spline.at(0.5 + t).x).abs()
    };
    let largest = (0..=500_000).map(off).fold(0.0, f64::max);
    // 5000 samples between two commands miss the top of a parabola by 1e-8 of it.
    assert!((largest / error - 1.0).abs() < 1e-6 && *error > 0.0, "{largest} {error}");
}

/// Every position is hit if velocities have plateaus. Rounding of 0.05 m, summed over the segments.
#[test]
fn plateaus_hit_every_position() {
    let table = table(Follow::Plateaus { share: 0.3.into() }, Velocities::Given);
    let plan = plan(Generator::Table(table.clone()));
    for knot in table.knots {
        assert!((plan.at(knot.t - 0.5).x - knot.x).abs() < 1e-15, "{knot:?}");
    }
    let PlanDetails::Commands { commands, error, .. } = plan.details() else { panic!("{:?}", plan.details()) };
    assert_eq!((commands.len(), error.to_bits()), (5, 0.0_f64.to_bits()));
}

#[test]
fn the_gain_over_the_published_profile_is_known() {
    let plan = plan(point_to_point(1e-3, Method::Optimal));
    let told = plan.published_duration().unwrap();
    // Snap alone binds: (384/512)^¼.
    assert!((plan.duration() / told - libm::pow(0.75, 0.25)).abs() < 1e-9, "{told}");
}

/// Oracle: the cascade written as sums. 1e-15: those of 0.02 m over some hundred samples.
#[test]
fn the_cascade_sums_sample_by_sample() {
    let hold = plan(sampled(Sampling::Published, Execution::ExactHold));
    let euler = plan(sampled(Sampling::Published, Execution::ForwardEuler));
    assert_eq!((euler.held(), euler.duration().to_bits()), (Some(1e-3), hold.duration().to_bits()));
    let [mut x, mut v, mut a, mut j] = [0.0_f64; 4];
    for t in (0..).map(|k| (f64::from(k) + 0.5) * 1e-3).take_while(|t| *t < hold.duration()) {
        let (at, snap) = (euler.at(t), hold.at(t).s);
        assert!((at.x - x).abs() < 1e-15 && (at.v - v).abs() < 1e-13, "{at:?} instead of {x} {v} at {t}");
        (x, v, a, j) = (x + 1e-3 * v, v + 1e-3 * a, a + 1e-3 * j, j + 1e-3 * snap);
    }
    assert_eq!(euler.end(), Setpoint::at_rest(0.02));
    let slow = Request { duration: Some(1.0), ..Request::new(sampled(Sampling::Published, Execution::ForwardEuler)) };
    let slow = slow.plan().unwrap();
    assert!(slow.held() == Some(1e-3) && (slow.duration() - 1.0).abs() < 1e-12, "{slow:?}");
}

#[test]
fn the_fewest_samples_are_compared_with_the_published_ones() {
    let [published, fewest] =
        [Sampling::Published, Sampling::Fewest].map(|sampling| plan(sampled(sampling, Execution::ExactHold)));
    assert_eq!(fewest.published_duration().map(f64::to_bits), Some(published.duration().to_bits()));
    assert!(fewest.duration() <= published.duration());
}

#[test]
fn what_would_fill_the_memory_is_refused() {
    let grid = |sample_time, execution| Some(Grid { sample_time, sampling: Sampling::Published, execution });
    let generator = |grid, method| {
        Generator::PointToPoint(PointToPoint { distance: 1.0, order: Order::Fourth, limits: LIMITS, method, grid })
    };
    let said = |generator| Request::new(generator).plan().unwrap_err().to_string();
    assert_eq!(
        said(generator(grid(1e-9, Execution::ForwardEuler), Method::Published)),
        "`sample_time` must be long enough for a move of at most 10 million samples, got 0.000000001"
    );
    assert_eq!(
        said(Generator::Table(table(Follow::Steps { rate: CommandRate::Given(1e10) }, Velocities::Given))),
        "`rate` must be low enough for at most 10 million commands, got 10000000000"
    );
}

/// One command per second less would exceed the error.
#[test]
fn the_lowest_rate_within_an_error_is_found() {
    let steps = |follow| {
        let PlanDetails::Commands { error, sending: Sending::Rate(rate), .. } =
            plan(Generator::Table(table(follow, Velocities::Given))).details().clone()
        else {
            panic!("commands");
        };
        (error, rate)
    };
    let (error, rate) = steps(Follow::Steps { rate: CommandRate::LowestWithin(1e-5) });
    assert!(
        error <= 1e-5 && steps(Follow::Steps { rate: CommandRate::Given(rate - 1.0) }).0 > 1e-5,
        "{error} at {rate}"
    );
}

/// The refusal names the requested error, not a rate that was not requested: late times are too coarse, and memory ends.
#[test]
fn an_error_that_is_too_small_is_refused_by_its_name() {
    let late = |error: f64| {
        let mut late = table(Follow::Steps { rate: CommandRate::LowestWithin(error) }, Velocities::Given);
        late.knots.iter_mut().for_each(|knot| knot.t += 1e9);
        Request::new(Generator::Table(late)).plan().map(|_| ()).map_err(|error| error.to_string())
    };
    let refused = late(1e-12).unwrap_err();
    assert!(refused.starts_with("`allowed` must be"), "{refused}");
    assert!(refused.ends_with("allow a larger error, or let the table begin at time 0"), "{refused}");
    assert_eq!(late(1e-4), Ok(()));
    let refused = Request::new(Generator::Table(table(
        Follow::Steps { rate: CommandRate::LowestWithin(1e-16) },
        Velocities::Given,
    )))
    .plan()
    .unwrap_err();
    let bound = "large enough for at most 10 million commands";
    assert_eq!(refused.to_string(), format!("`allowed` must be {bound}, got 0.0000000000000001"));
}

/// A velocity would jump at the impulses of a shaper, or with stretched time.
#[test]
fn a_move_that_starts_in_motion_is_neither_filtered_nor_slowed() {
    let shapers = vec![shaping(Shaper::Zv, 0.0)];
    let generator = Generator::Replanning(replanning());
    let filtered = Request { filter: Filter { shapers, averages: None }, ..Request::new(generator.clone()) };
    let slowed = Request { duration: Some(10.0), ..Request::new(generator) };
    for request in [filtered, slowed] {
        let message = request.plan().unwrap_err().to_string();
        assert_eq!(message, "`start_velocity` must be zero for a move that is filtered or slowed, got 0.4");
    }
}

/// Oracle: the documented example of the generator, 50 samples instead of 55 with moving averages and 56 as published; and the
/// cascade, which ends on the distance at the same sample.
#[test]
fn the_shortest_sampled_move_is_shorter_than_any_boxes() {
    let request = |execution, duration| {
        let grid = Some(Grid { sample_time: 5e-3, sampling: Sampling::Published, execution });
        let (order, method) = (Order::Fourth, Method::Optimal);
        let generator = Generator::PointToPoint(PointToPoint { distance: 0.01, order, limits: LIMITS, method, grid });
        Request { duration, ..Request::new(generator) }
    };
    for execution in [Execution::ExactHold, Execution::ForwardEuler] {
        let plan = request(execution, None).plan().unwrap();
        let PlanDetails::Shortest(shortest) = plan.details() else { panic!("{:?}", plan.details()) };
        assert_eq!((shortest.samples(), shortest.at_least()), (50, 50));
        assert!((plan.duration() - 0.25).abs() < 1e-12 && plan.end() == Setpoint::at_rest(0.01));
        assert!((plan.published_duration().unwrap() - 0.28).abs() < 1e-12);
        for (peak, limit) in plan.largest().into_iter().zip([1.0, 5.0, 50.0, 1000.0]) {
            assert!(peak <= limit * (1.0 + 1e-9), "{peak} {limit}");
        }
        // Slowed to its own time it does not change; below that of moving averages nothing fits, above it uses moving averages.
        let slowed = |duration| request(execution, Some(duration)).plan();
        assert!(matches!(slowed(0.25).unwrap().details(), PlanDetails::Shortest(_)));
        assert!(matches!(slowed(0.26), Err(PlanError::TooShort { shortest, .. }) if (shortest - 0.275).abs() < 1e-12));
        let slow = slowed(0.5).unwrap();
        assert!(matches!(slow.details(), PlanDetails::Profile(_)) && (slow.duration() - 0.5).abs() < 1e-12);
    }
}

/// Velocity jumps between linear segments, acceleration at the start of a cubic spline; the five points of an S-curve join without
/// either.
#[test]
fn a_table_says_what_jumps() {
    let order = |knots: Vec<Knot>, velocities| {
        plan(Generator::Table(TableMove { knots, velocities, follow: Follow::Segments })).order()
    };
    let knots = table(Follow::Segments, Velocities::Given).knots;
    assert_eq!(order(knots.clone(), Velocities::Given), 1);
    assert_eq!(order(knots.clone(), Velocities::Average), 2);
    assert_eq!(order(knots, Velocities::Continuous), 2);
    assert_eq!(order(servobench_motion::pvt::s_curve(0.0, 1.0, 0.1).unwrap().to_vec(), Velocities::Given), 3);
}

/// Oracle: the motion of a drive by the commands, straight lines of velocity one after the other, at the end of each. Half the
/// pace takes a quarter of the acceleration and an eighth of the jerk.
#[test]
fn what_is_told_of_a_slowed_move_is_slowed() {
    for follow in [Follow::Plateaus { share: 0.3.into() }, Follow::Steps { rate: CommandRate::Given(50.0) }] {
        let request = Request::new(Generator::Table(table(follow, Velocities::Given)));
        let fast = request.plan().unwrap();
        let slow = Request { duration: Some(2.0 * fast.duration()), ..request }.plan().unwrap();
        let PlanDetails::Commands { commands, .. } = slow.details() else { panic!("{:?}", slow.details()) };
        let start = commands[0].t;
        for pair in commands.windows(2) {
            let reached = slow.at(pair[1].t - start - 1e-9);
            assert!((reached.v - pair[0].velocity).abs() < 1e-6, "{pair:?} {reached:?}");
            assert!((slow.at(pair[0].t - start + 1e-9).a.abs() - pair[0].acceleration).abs() < 1e-9, "{pair:?}");
        }
    }
    let all = all();
    let rockwell = all.iter().find(|plan| matches!(plan.details(), PlanDetails::Rockwell { .. })).unwrap();
    let PlanDetails::Rockwell { acceleration, .. } = rockwell.details() else { panic!("{:?}", rockwell.details()) };
    let operands = Move {
        distance: -0.1,
        speed: 0.2,
        acceleration: 10.0,
        deceleration: 20.0,
        shape: Shape::SCurve { acceleration: Jerk::PercentOfTime(25.0), deceleration: Jerk::PercentOfTime(60.0) },
    };
    let generator =
        Generator::Rockwell(Rockwell { operands, maximum: MaximumJerk { acceleration: 1e4, deceleration: 1e4 } });
    let slow = Request { duration: Some(2.0 * rockwell.duration()), ..Request::new(generator) }.plan().unwrap();
    let PlanDetails::Rockwell { acceleration: slowed, .. } = slow.details() else { panic!("{:?}", slow.details()) };
    assert!((8.0 * slowed / acceleration - 1.0).abs() < 1e-12, "{slowed} {acceleration}");
}

/// The share chosen by limits is reported, meets them, and is refused if none does. Oracle: for one segment V = p/(T·(1 − α)) and
/// a = V/(α·T), the same share of both limits.
#[test]
fn a_share_of_plateaus_is_chosen_by_limits() {
    let knots = vec![Knot::new(1.0, 0.0), Knot::new(2.0, 0.1)];
    let asked = |velocity, acceleration| {
        let follow = Follow::Plateaus { share: PlateauShare::SmallestPartOf { velocity, acceleration } };
        Generator::Table(TableMove { knots: knots.clone(), velocities: Velocities::Given, follow })
    };
    let found = plan(asked(0.2, 1.0));
    let PlanDetails::Commands { sending: Sending::Plateaus { share }, .. } = found.details() else {
        panic!("{:?}", found.details())
    };
    assert!((share - 0.2).abs() < 1e-6, "{share}");
    let refused = Request::new(asked(0.2, 0.39)).plan().unwrap_err().to_string();
    let said = "no share of plateaus keeps `acceleration` within 0.39 (SI), the best one takes 0.400000";
    assert!(
        refused.starts_with(said) && refused.ends_with("give the table more time, or raise the limit"),
        "{refused}"
    );
}

/// Before a move the axis rests: a derivative that begins at the first instant enters sample by sample, as all others do.
#[test]
fn averages_begin_with_an_axis_at_rest() {
    for order in [Order::Second, Order::Third, Order::Fourth] {
        let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
        let asked = PointToPoint { distance: 1.0, order, limits, method: Method::Published, grid: None };
        let averages = Averages { lengths: vec![0.01], sample_time: 1e-3 };
        let filter = Filter { shapers: Vec::new(), averages: Some(averages) };
        let filtered = Request { filter, ..Request::new(Generator::PointToPoint(asked)) }.plan().unwrap();
        let top = |at: &Setpoint| [at.a, at.j, at.s][order.derivative() - 2];
        let full = [5.0, 50.0, 1000.0][order.derivative() - 2];
        for k in 0..12 {
            let at = filtered.at(1e-3 * f64::from(k) + 1e-6);
            let expected = full * f64::from((k + 1).min(10)) / 10.0;
            assert!((top(&at) / expected - 1.0).abs() < 1e-12, "{order:?} {k}: {at:?}");
        }
    }
}
