//! Position profiles for a drive on a bus: the commands lead to the announced motion.
use servobench_motion::position_profile::{Command, Spline};
use servobench_motion::pvt::Knot;
use servobench_planner::{
    CommandCycle, CommandRate, Follow, Generator, Plan, PlanDetails, Request, Sending, TableMove, Velocities,
};

/// No time is a whole number of a cycle of the tests; the table does not begin at 0.
const POINTS: [(f64, f64); 7] =
    [(0.5003, 0.02), (0.5317, 0.021), (0.5833, 0.031), (0.6217, 0.05), (0.7, 0.06), (0.7777, 0.031), (0.8543, 0.02)];

fn table(follow: Follow) -> TableMove {
    let knots = POINTS.iter().map(|(t, x)| Knot::new(*t, *x)).collect();
    TableMove { knots, velocities: Velocities::Given, follow }
}

fn request(follow: Follow, cycle: CommandCycle) -> Request {
    Request { commands: Some(cycle), ..Request::new(Generator::Table(table(follow))) }
}

fn told(plan: &Plan) -> (&[Command], f64, Option<f64>) {
    let PlanDetails::Commands { commands, error, sending } = plan.details() else { panic!("{:?}", plan.details()) };
    let rate = if let Sending::Rate(rate) = sending { Some(*rate) } else { None };
    (commands, *error, rate)
}

const CYCLES: [CommandCycle; 4] = [
    CommandCycle { period: 1e-3, first: 0.0, unit: 0.0 },
    CommandCycle { period: 4e-3, first: 1.7e-3, unit: 1e-6 },
    CommandCycle { period: 3.3e-3, first: -1e-3, unit: 2e-8 },
    CommandCycle { period: 0.5e-3, first: 0.2e-3, unit: 1e-4 },
];

/// Oracle: the plan itself, sampled densely, against points and spline. Commands are whole units and at instants.
#[test]
fn what_is_announced_is_what_the_commands_lead_to() {
    for cycle in CYCLES {
        let plateaus = [0.25, 0.5, 0.1, 0.4321].map(|share| Follow::Plateaus { share: share.into() });
        let steps = [300.0, 77.7, 1e4].map(|rate| Follow::Steps { rate: CommandRate::Given(rate) });
        for follow in plateaus.into_iter().chain(steps) {
            for slower in [1.0, 1.37] {
                let free = request(follow, cycle).plan().unwrap();
                let duration = (slower > 1.0).then(|| slower * free.duration());
                let plan = Request { duration, ..request(follow, cycle) }.plan().unwrap();
                let (commands, error, _) = told(&plan);
                let start = POINTS[0].0;
                for command in commands {
                    let place = (command.t - start - cycle.first) / cycle.period;
                    assert!((place - place.round()).abs() < 1e-6, "{follow:?} {cycle:?}: {command:?}");
                    let units = command.velocity / cycle.unit;
                    assert!(cycle.unit == 0.0 || (units - units.round()).abs() < 1e-6, "{cycle:?}: {command:?}");
                }
                let knots = POINTS.map(|(t, x)| Knot::new(start + slower * (t - start), x));
                let (mut solved, mut scratch) = (knots, [0.0; POINTS.len()]);
                let spline = Spline::solve(&mut solved, 0.0, 0.0, &mut scratch).unwrap();
                let off = |k: u32| {
                    let t = plan.duration() * f64::from(k) / 20_000.0;
                    (plan.at(t).x - spline.table().at(start + t).x).abs()
                };
                let measured = match follow {
                    Follow::Plateaus { .. } => {
                        knots.iter().map(|knot| (plan.at(knot.t - start).x - knot.x).abs()).fold(0.0, f64::max)
                    }
                    _ => (0..=20_000).map(off).fold(0.0, f64::max),
                };
                let what = format!("{follow:?} {cycle:?} {slower}: {measured} m, {error} m announced");
                assert!(measured <= error + 1e-15 && (error - measured).abs() <= 1e-4 * error + 1e-15, "{what}");
                if cycle.unit == 0.0 && matches!(follow, Follow::Plateaus { .. }) {
                    assert!(error < 1e-14, "{what}");
                }
            }
        }
    }
}

#[test]
fn the_lowest_rate_within_an_error_is_that_of_the_cycle_or_refused() {
    for cycle in CYCLES {
        let plan = request(Follow::Steps { rate: CommandRate::LowestWithin(1e-3) }, cycle).plan().unwrap();
        let (_, error, rate) = told(&plan);
        let rate = rate.unwrap();
        let below = request(Follow::Steps { rate: CommandRate::Given(rate - 1.0) }, cycle).plan().unwrap();
        assert!(error <= 1e-3 && told(&below).1 > 1e-3, "{cycle:?}: {error} at {rate}");
        let refused =
            request(Follow::Steps { rate: CommandRate::LowestWithin(1e-9) }, cycle).plan().unwrap_err().to_string();
        assert!(refused.contains("`allowed`") && refused.contains("a shorter cycle"), "{refused}");
    }
    assert!(request(Follow::Steps { rate: CommandRate::LowestWithin(f64::NAN) }, CYCLES[0]).plan().is_err());
}

/// Commands beyond the range of the drive's objects, and cycles without meaning.
#[test]
fn what_cannot_be_sent_is_refused() {
    let unit = |unit| CommandCycle { unit, ..CYCLES[0] };
    let said = |cycle| request(Follow::Plateaus { share: 0.1.into() }, cycle).plan().unwrap_err().to_string();
    assert!(said(unit(1e-10)).starts_with("`acceleration` must be at most 2³² − 1 units"), "{}", said(unit(1e-10)));
    assert!(
        said(unit(1e-11)).starts_with("`velocity` must be at most 2³¹ − 1 velocity units"),
        "{}",
        said(unit(1e-11))
    );
    assert!(said(unit(-1.0)).starts_with("`command_unit`") && said(unit(f64::NAN)).starts_with("`command_unit`"));
    for period in [0.0, f64::NAN, f64::INFINITY, 0.3] {
        assert!(said(CommandCycle { period, ..CYCLES[0] }).starts_with("`command_cycle`"), "{period}");
    }
    assert!(said(CommandCycle { first: f64::NAN, ..CYCLES[0] }).starts_with("`first_command`"));
}
