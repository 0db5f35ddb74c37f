//! What can be asked for.
use crate::clocked::CommandCycle;
use crate::filter::Filter;
use crate::plan::{Plan, Told};
use crate::table::TableMove;
use servobench_base::{ParamError, Setpoint};
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::sampled::Shortest;
use servobench_motion::{Limits, Order, PlanError, Profile, rockwell};

/// A move as it was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Which way it goes.
    pub way: Way,
    /// How long it lasts (s), slowed with every derivative in proportion; as fast as its limits allow without.
    pub duration: Option<f64>,
    /// What filters it.
    pub filter: Filter,
    /// How velocity commands get to the drive, of a table that is followed by them; at any time and exactly without.
    pub commands: Option<CommandCycle>,
}

/// Which way a move goes.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
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
    /// Which profile.
    pub method: Method,
    /// Samples of which all times are whole multiples; continuous without.
    pub grid: Option<Grid>,
}

/// How a move from rest to rest is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Sample time (s).
    pub sample_time: f64,
    /// How its times are made whole.
    pub sampling: Sampling,
    /// How set-points are made of its samples.
    pub execution: Execution,
}

/// How the times of a move are made whole numbers of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// One after the other, from the shortest on: as it is published.
    #[default]
    Published,
    /// With the fewest samples that a step through boxes needs.
    Fewest,
}

/// What is between two samples of the highest derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Execution {
    /// The exact polynomial: the highest derivative is held.
    #[default]
    Hold,
    /// The forward-Euler cascade: sums sample by sample, each set-point held until the next. On the way it lags by half a
    /// sample for each derivative but one: by 1.5 samples at order 4.
    Euler,
}

impl Grid {
    /// As it is published, and held exactly.
    #[must_use]
    pub const fn new(sample_time: f64) -> Self {
        Self { sample_time, sampling: Sampling::Published, execution: Execution::Hold }
    }
}

/// Which profile goes from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The step through boxes that is published (Pietrusewicz et al. 2019): 15 segments at order 4.
    #[default]
    Published,
    /// The shortest; of a sampled move that of the fewest samples, whatever its shape.
    Optimal,
}

/// A move from any state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replanning {
    /// Where from.
    pub from: Setpoint,
    /// Where to.
    pub target: Target,
    /// Order of the profile, 2, 3 or 4.
    pub order: Order,
    /// Limits by direction.
    pub limits: DirectionalLimits,
    /// How much work it may be.
    pub effort: Effort,
}

/// Rockwell's axis move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rockwell {
    /// Its operands.
    pub operands: rockwell::Move,
    /// What the axis is configured for.
    pub maximum: rockwell::MaximumJerk,
}

impl Request {
    /// As fast as the limits allow, and not filtered.
    #[must_use]
    pub const fn new(way: Way) -> Self {
        Self { way, duration: None, filter: Filter::NONE, commands: None }
    }

    /// Plans it.
    ///
    /// # Errors
    /// [`PlanError`] of the generator; [`PlanError::TooShort`] for a duration below that at the limits;
    /// [`PlanError::Parameter`] for a duration or a filter of a move that starts or ends in motion.
    pub fn plan(&self) -> Result<Plan, PlanError> {
        let plan = match (&self.way, &self.commands) {
            (Way::Table(table), Some(cycle)) if table.is_sent() => table.plan_in(cycle)?,
            (way, _) => way.plan()?,
        };
        if self.duration.is_some() || self.filter.length() > 0.0 {
            for (name, value) in [("start_velocity", plan.start().v), ("end_velocity", plan.end().v)] {
                if value != 0.0 {
                    let bound = "zero for a move that is filtered or slowed";
                    return Err(ParamError { name, value, bound }.into());
                }
            }
        }
        let plan = match self.duration {
            Some(duration) => self.slowed(plan, duration)?,
            None => plan,
        };
        plan.filtered(&self.filter)
    }
}

impl Request {
    /// `plan`, which this request is, in `duration` seconds.
    fn slowed(&self, plan: Plan, duration: f64) -> Result<Plan, PlanError> {
        if let (Way::Table(table), Some(cycle)) = (&self.way, &self.commands)
            && table.is_sent()
        {
            // Commands stay at their instants.
            let factor = (duration - self.filter.length()) / plan.duration();
            let is_slower = factor > 1.0 && factor.is_finite() && plan.duration() > 0.0;
            return if is_slower {
                table.slowed(factor).plan_in(cycle)
            } else {
                plan.stretched_to(duration, self.filter.length())
            };
        }
        let Way::PointToPoint(way @ PointToPoint { grid: Some(grid), .. }) = &self.way else {
            return plan.stretched_to(duration, self.filter.length());
        };
        if way.method == Method::Published
            || (plan.duration() + self.filter.length() - duration).abs() <= 1e-9 * duration
        {
            return plan.stretched_to(duration, self.filter.length());
        }
        // Slower than its limits it need not be the shortest: through boxes all its times stay whole samples.
        let grid = Some(Grid { sampling: Sampling::Fewest, ..*grid });
        let boxes = PointToPoint { method: Method::Published, grid, ..*way };
        boxes.plan()?.stretched_to(duration, self.filter.length())
    }
}

impl Way {
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
        let execution = grid.map_or(Execution::Hold, |grid| grid.execution);
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
        Ok(Plan::of(transition, Told::Transition { order: *order, excess: transition.excess() }).within(sides))
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
        Ok(Plan::of(trajectory, Told::Rockwell { acceleration: up, deceleration: down }).within(sides))
    }
}
