//! From a step of a scenario to what the planner is asked for.
use servobench_base::Setpoint;
use servobench_motion::online::{self, DirectionalLimits, Effort, Sides};
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::{self, Jerk, MaximumJerk, Shape};
use servobench_motion::shape::{Impulses, Vibration};
use servobench_motion::{Limits, Order, PlanError};
use servobench_planner as planner;
use servobench_planner::{Averages, CommandCycle, Plan, PointToPoint, Replanning, Request};
use servobench_scenario::{
    Execution, Filter, Follow, Goal, Grid, Method, MoveStep, OnlineMove, PlanEffort, RestMove, RockwellJerk,
    RockwellMove, RockwellShape, Sampling, Shaper, ShaperKind, TableMove, Target, Velocities, Way,
};
use std::f64::consts::TAU;

/// A step that is asked for from a state of motion.
pub(super) struct Asked<'a> {
    step: &'a MoveStep,
    from: Setpoint,
    tick: f64,
    cycle: Option<CommandCycle>,
}

/// The plan of `step` from `from`, whose position is the zero of the plan; a tick lasts `tick` (s), and velocity commands are sent in
/// `cycle`.
pub(super) const fn request(step: &MoveStep, from: Setpoint, tick: f64, cycle: Option<CommandCycle>) -> Asked<'_> {
    Asked { step, from, tick, cycle }
}

/// What a label says of the move besides its order.
pub(super) const fn kind(step: &MoveStep) -> &'static str {
    match &step.way {
        Way::Rest(RestMove { method: Method::Published, .. }) => "",
        Way::Rest(RestMove { method: Method::Optimal, .. }) => " optimal",
        Way::Online(OnlineMove { effort: PlanEffort::Fast, .. }) => " online",
        Way::Online(OnlineMove { effort: PlanEffort::Refined, .. }) => " online, refined",
        Way::Rockwell(RockwellMove { shape: RockwellShape::Trapezoid, .. }) => " Rockwell trapezoid",
        Way::Rockwell(RockwellMove { shape: RockwellShape::SCurve, .. }) => " Rockwell S-curve",
        Way::Table(TableMove { follow: Follow::Segments, .. }) => " table",
        Way::Table(TableMove { follow: Follow::Plateaus(_), .. }) => " position profile, plateaus",
        Way::Table(TableMove { follow: Follow::Steps(_), .. }) => " position profile, spline",
    }
}

impl Asked<'_> {
    pub(super) fn plan(&self) -> Result<Plan, PlanError> {
        let way = match &self.step.way {
            Way::Rest(asked) => planner::Way::PointToPoint(self.rest(asked)),
            Way::Online(asked) => planner::Way::Replanning(self.online(asked)),
            Way::Rockwell(asked) => planner::Way::Rockwell(self.rockwell(asked)),
            Way::Table(asked) => planner::Way::Table(self.table(asked)?),
        };
        let filter = filter(&self.step.filter, self.tick)?;
        Request { way, duration: self.step.duration, filter, commands: self.cycle }.plan()
    }

    /// From here to `target`.
    fn distance(&self, target: Target) -> f64 {
        match target {
            Target::Absolute(target) => target - self.from.x,
            Target::Relative(distance) => distance,
        }
    }

    const fn order(&self) -> Order {
        match self.step.order {
            2 => Order::Second,
            3 => Order::Third,
            _ => Order::Fourth,
        }
    }

    fn rest(&self, asked: &RestMove) -> PointToPoint {
        let RestMove { target, method, grid } = *asked;
        let [velocity, acceleration, jerk, snap] = self.step.limits;
        PointToPoint {
            distance: self.distance(target),
            order: self.order(),
            limits: Limits { velocity, acceleration, jerk, snap },
            method: match method {
                Method::Published => planner::Method::Published,
                Method::Optimal => planner::Method::Optimal,
            },
            grid: grid.map(|Grid { sample_time, sampling, execution }| planner::Grid {
                sample_time,
                sampling: match sampling {
                    Sampling::Published => planner::Sampling::Published,
                    Sampling::Fewest => planner::Sampling::Fewest,
                },
                execution: match execution {
                    Execution::Hold => planner::Execution::Hold,
                    Execution::Euler => planner::Execution::Euler,
                },
            }),
        }
    }

    fn online(&self, asked: &OnlineMove) -> Replanning {
        let OnlineMove { goal, effort, negative } = *asked;
        let [velocity, acceleration, jerk, snap] = self.step.limits;
        let sides = |above: f64, below: Option<f64>| Sides { below: below.unwrap_or(above), above };
        Replanning {
            from: Setpoint { x: 0.0, s: 0.0, ..self.from },
            target: match goal {
                Goal::Position(target, v) => online::Target::Position { x: self.distance(target), v },
                Goal::Velocity(v, _) => online::Target::Velocity(v),
            },
            order: self.order(),
            limits: DirectionalLimits {
                velocity: sides(velocity, negative[0]),
                acceleration: sides(acceleration, negative[1]),
                jerk,
                snap,
            },
            effort: match effort {
                PlanEffort::Fast => Effort::Fast,
                PlanEffort::Refined => Effort::Refined,
            },
        }
    }

    fn rockwell(&self, asked: &RockwellMove) -> planner::Rockwell {
        let RockwellMove { target, shape, deceleration, jerks, maximum } = *asked;
        let [speed, acceleration, ..] = self.step.limits;
        let jerk = |jerk| match jerk {
            RockwellJerk::Value(jerk) => Jerk::Value(jerk),
            RockwellJerk::PartOfMaximum(part) => Jerk::PercentOfMaximum(100.0 * part),
            RockwellJerk::PartOfTime(part) => Jerk::PercentOfTime(100.0 * part),
        };
        let shape = match shape {
            RockwellShape::Trapezoid => Shape::Trapezoid,
            RockwellShape::SCurve => Shape::SCurve { acceleration: jerk(jerks[0]), deceleration: jerk(jerks[1]) },
        };
        planner::Rockwell {
            operands: rockwell::Move { distance: self.distance(target), speed, acceleration, deceleration, shape },
            maximum: MaximumJerk { acceleration: maximum[0], deceleration: maximum[1] },
        }
    }

    fn table(&self, asked: &TableMove) -> Result<planner::TableMove, PlanError> {
        let (begin, first) = asked.points.first().map_or((0.0, 0.0), |first| (first.0, first.1));
        let origin = if asked.is_relative { 0.0 } else { self.from.x };
        if (first - origin).abs() > NEAR {
            return Err(PlanError::Point {
                point: 0,
                name: "position",
                value: first,
                bound: if asked.is_relative {
                    "0 in a relative table"
                } else {
                    "where the axis is when the move starts"
                },
                remedy: "begin the table there, or move to its first point before",
            });
        }
        Ok(planner::TableMove {
            knots: asked.points.iter().map(|(t, x, v)| Knot { t: t - begin, x: x - first, v: *v }).collect(),
            velocities: match asked.velocities {
                Velocities::Given => planner::Velocities::Given,
                Velocities::Average => planner::Velocities::Average,
                Velocities::Smooth(passes) => planner::Velocities::Smooth(passes as usize),
                Velocities::Continuous => planner::Velocities::Continuous,
            },
            follow: match asked.follow {
                Follow::Segments => planner::Follow::Segments,
                Follow::Plateaus(share) => planner::Follow::Plateaus(share),
                Follow::Steps(rate) => planner::Follow::Steps(rate),
            },
        })
    }
}

/// A first point that is nearer (m or rad) is where the axis is: sums of targets are rounded.
const NEAR: f64 = 1e-9;

fn filter(asked: &Filter, tick: f64) -> Result<planner::Filter, PlanError> {
    let shaper = match asked.shaper {
        None => None,
        Some(Shaper { kind, frequency, damping }) => {
            let mode = Vibration::new(TAU * frequency, damping)?;
            Some(match kind {
                ShaperKind::Zv => Impulses::zv(&mode),
                ShaperKind::Zvd => Impulses::zvd(&mode),
                ShaperKind::Zvdd => Impulses::zvdd(&mode),
                ShaperKind::Ei(tolerable) => Impulses::ei(&mode, tolerable)?,
            })
        }
    };
    let averages =
        (!asked.averages.is_empty()).then(|| Averages { lengths: asked.averages.clone(), sample_time: tick });
    Ok(planner::Filter { shaper, averages })
}
