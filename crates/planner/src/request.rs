//! Requests for moves.
use crate::clocked::CommandCycle;
use crate::filter::Filter;
use crate::plan::{Plan, PlanDetails};
use crate::table::TableMove;
use servobench_base::{ParamError, Setpoint};
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::sampled::{Execution, Shortest};
use servobench_motion::{Limits, Order, PlanError, Profile, rockwell};

/// The request for a move.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Generator of its set-points, with its operands.
    pub generator: Generator,
    /// Duration (s), with every derivative slowed in proportion; `None`: as fast as its limits allow.
    pub duration: Option<f64>,
    /// Filter of the set-points.
    pub filter: Filter,
    /// Timing of velocity commands, for a table that is followed by them; `None`: at any time and exactly.
    pub commands: Option<CommandCycle>,
    /// Limits against which velocity and acceleration of a table are checked; the table is followed regardless. All other generators have
    /// separate limits. Infinite without a limit.
    pub table_limits: [Sides; 2],
}

/// A generator of set-points with its operands.
#[derive(Debug, Clone, PartialEq)]
pub enum Generator {
    /// From rest to rest.
    PointToPoint(PointToPoint),
    /// From any state.
    Replanning(Replanning),
    /// By the operands of Rockwell's axis move.
    Rockwell(Rockwell),
    /// Through a table.
    Table(TableMove),
}

/// A move from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointToPoint {
    /// Distance; its sign is the direction.
    pub distance: f64,
    /// Order of the profile.
    pub order: Order,
    /// Limits.
    pub limits: Limits,
    /// Choice of the profile.
    pub method: Method,
    /// Samples of which all times are whole multiples; `None`: continuous.
    pub grid: Option<Grid>,
}

/// Sampling of a move from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Sample time (s).
    pub sample_time: f64,
    /// Method by which its times become whole.
    pub sampling: Sampling,
    /// Computation of set-points from its samples.
    pub execution: Execution,
}

servobench_config::choices! {
    /// Rounding of the times of a move to whole numbers of samples.
    pub enum Sampling default Published {
        /// each time rounded up in turn, as published
        Published = "published",
        /// the fewest samples that the published profile needs
        Fewest = "fewest",
    }
}

impl Grid {
    /// Sampling as published, held exactly.
    #[must_use]
    pub const fn new(sample_time: f64) -> Self {
        Self { sample_time, sampling: Sampling::Published, execution: Execution::ExactHold }
    }
}

servobench_config::choices! {
    /// Profile of moves from rest to rest: the one of Pietrusewicz et al. 2019, or the shortest, for a sampled move that of the fewest
    /// samples, whatever its shape.
    pub enum Method default Published {
        /// the published profile, 15 segments at order 4: a step through one moving average for each order
        Published = "published",
        /// the shortest: up to 6.94 % less time at order 4 where the profile has no constant velocity
        Optimal = "optimal",
    }
}

/// A move from any state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replanning {
    /// Initial state.
    pub from: Setpoint,
    /// Target.
    pub target: Target,
    /// Order of the profile, 2, 3 or 4.
    pub order: Order,
    /// Limits by direction.
    pub limits: DirectionalLimits,
    /// Bound of the computing effort.
    pub effort: Effort,
}

/// Rockwell's axis move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rockwell {
    /// Its operands.
    pub operands: rockwell::Move,
    /// Maximum jerk configured for the axis.
    pub maximum: rockwell::MaximumJerk,
}

impl Request {
    /// As fast as the limits allow, without a filter.
    #[must_use]
    pub const fn new(generator: Generator) -> Self {
        let table_limits = [Sides::both(f64::INFINITY); 2];
        Self { generator, duration: None, filter: Filter::NONE, commands: None, table_limits }
    }

    /// Plans it.
    ///
    /// # Errors
    /// [`PlanError`] of the generator or of the shapers; [`PlanError::TooShort`] for a duration below that at the limits;
    /// [`PlanError::Parameter`] for a duration or a filter of a move that starts or ends in motion.
    pub fn plan(&self) -> Result<Plan, PlanError> {
        let mut filter = self.filter.solved()?;
        if let Generator::PointToPoint(PointToPoint { grid: Some(grid), .. }) = &self.generator {
            filter = filter.sampled(grid.sample_time)?;
        }
        let plan = match (&self.generator, &self.commands) {
            (Generator::Table(table), Some(cycle)) if table.is_sent() => table.plan_in(cycle)?,
            (generator, _) => generator.plan()?,
        };
        if self.duration.is_some() || filter.length() > 0.0 {
            for (name, value) in [("start_velocity", plan.start().v), ("end_velocity", plan.end().v)] {
                if value != 0.0 {
                    let bound = "zero for a move that is filtered or slowed";
                    return Err(ParamError { name, value, bound }.into());
                }
            }
        }
        let plan = match self.duration {
            Some(duration) => self.slowed(plan, duration, filter.length())?,
            None => plan,
        };
        let plan = plan.filtered(&filter)?;
        if !matches!(self.generator, Generator::Table(_)) {
            return Ok(plan);
        }
        let [velocity, acceleration] = self.table_limits;
        let none = Sides::both(f64::INFINITY);
        Ok(plan.within([velocity, acceleration, none, none]))
    }
}

impl Request {
    /// Stretches `plan`, the plan of this request, to `duration` seconds, including the length `filter` of its filter.
    fn slowed(&self, plan: Plan, duration: f64, filter: f64) -> Result<Plan, PlanError> {
        if let (Generator::Table(table), Some(cycle)) = (&self.generator, &self.commands)
            && table.is_sent()
        {
            // Commands keep their instants.
            let factor = (duration - filter) / plan.duration();
            let is_slower = factor > 1.0 && factor.is_finite() && plan.duration() > 0.0;
            return if is_slower { table.slowed(factor).plan_in(cycle) } else { plan.stretched_to(duration, filter) };
        }
        let Generator::PointToPoint(shortest @ PointToPoint { grid: Some(grid), .. }) = &self.generator else {
            return plan.stretched_to(duration, filter);
        };
        if shortest.method == Method::Published || (plan.duration() + filter - duration).abs() <= 1e-9 * duration {
            return plan.stretched_to(duration, filter);
        }
        // Below its limits it need not be the shortest: with moving averages all its times stay whole samples.
        let grid = Some(Grid { sampling: Sampling::Fewest, ..*grid });
        let boxes = PointToPoint { method: Method::Published, grid, ..*shortest };
        boxes.plan()?.stretched_to(duration, filter)
    }
}

impl Generator {
    fn plan(&self) -> Result<Plan, PlanError> {
        match self {
            Self::PointToPoint(request) => request.plan(),
            Self::Replanning(request) => request.plan(),
            Self::Rockwell(request) => request.plan(),
            Self::Table(request) => request.plan(),
        }
    }
}

impl PointToPoint {
    fn plan(&self) -> Result<Plan, PlanError> {
        let Self { distance, order, limits, method, grid } = *self;
        let published = || match grid {
            Some(grid) => Profile::plan_sampled(order, distance, &limits, grid.sample_time),
            None => Profile::plan(order, distance, &limits),
        };
        let Limits { velocity, acceleration, jerk, snap } = limits;
        let mut sides = [velocity, acceleration, jerk, snap].map(Sides::both);
        sides[order.derivative()..].fill(Sides::both(f64::INFINITY));
        let (profile, compared) = match (method, grid) {
            (Method::Published, Some(Grid { sampling: Sampling::Fewest, sample_time, .. })) => {
                let fewest = Profile::plan_fewest(order, distance, &limits, sample_time)?;
                (fewest, Some(published()?.duration()))
            }
            (Method::Published, _) => (published()?, None),
            (Method::Optimal, None) => {
                (Profile::plan_optimal(order, distance, &limits)?, Some(published()?.duration()))
            }
            (Method::Optimal, Some(grid)) => {
                let shortest = Shortest::plan(order, distance, &limits, grid.sample_time)?;
                let plan = Plan::along_shortest(shortest, grid.execution)?;
                return Ok(plan.within(sides).instead_of(Some(published()?.duration())));
            }
        };
        let execution = grid.map_or(Execution::ExactHold, |grid| grid.execution);
        Ok(Plan::along(&profile, execution)?.within(sides).instead_of(compared))
    }
}

impl Replanning {
    fn plan(&self) -> Result<Plan, PlanError> {
        let Self { from, target, order, limits, effort } = self;
        let transition = Transition::plan(*order, from, target, limits, *effort)?;
        let DirectionalLimits { velocity, acceleration, jerk, snap } = *limits;
        let mut sides = [velocity, acceleration, Sides::both(jerk), Sides::both(snap)];
        sides[order.derivative()..].fill(Sides::both(f64::INFINITY));
        Ok(Plan::of(transition, PlanDetails::Transition { order: *order, excess: transition.excess() }).within(sides))
    }
}

impl Rockwell {
    fn plan(&self) -> Result<Plan, PlanError> {
        let Self { operands, maximum } = self;
        let trajectory = operands.plan(maximum)?;
        let [up, down] = operands.jerks(maximum)?;
        let (up_a, down_a) = (operands.acceleration, operands.deceleration);
        let (above, below) = if operands.distance < 0.0 { (down_a, up_a) } else { (up_a, down_a) };
        let sides = [
            Sides::both(operands.speed),
            Sides { below, above },
            Sides::both(up.max(down)),
            Sides::both(f64::INFINITY),
        ];
        Ok(Plan::of(trajectory, PlanDetails::Rockwell { acceleration: up, deceleration: down }).within(sides))
    }
}
