//! Both options for a drive with commands at the instants of a clock.
use super::clock::{Clock, before, behind, thin};
use super::share::{Demand, PlateauShare};
use super::{Command, Spline, VelocityRamp};
use crate::limits::in_range;
use crate::pvt::{Cursor, Knot, Table, checked, scratch_for};
use crate::{Piece, PlanError};
use servobench_base::{Setpoint, positive};

/// Option 1 at instants: a plateau of velocity in each segment, and ramps between them that begin and end at instants.
///
/// The ramp at a point lasts from an instant b_i to an instant e_i, within the shares α of the segments beside it if they contain
/// an instant, and over the point in any case: with the times in periods
///
/// ```text
/// b_i = min(⌈t_i − α·dT_i⌉, ⌊t_i⌋)      e_i = max(⌊t_i + α·dT_(i+1)⌋, ⌈t_i⌉), at least b_i + 1
/// A_i = (e_i − t_i)²/2(e_i − b_i)       B_i = (t_i − b_i)²/2(e_i − b_i)
/// A_(i−1)·V_(i−1) + (dT_i − A_(i−1) − B_i)·V_i + B_i·V_(i+1) = (p_i − p_(i−1))/period          V_0 = V_s, V_(N+1) = V_e
/// ```
///
/// The third is the area below the velocity from point to point. Ramps do not overlap, so that A_(i−1) + B_i ≤ dT_i/2: the system is
/// diagonally dominant. If all ramps begin and end at instants anyway, it is that of [`Plateaus`](super::Plateaus).
///
/// A point is left out when no instant is between it and one before it, or less than a period is left for the ramps at the ends: with
/// one command in a period not all of them can be met. The axis then passes it as the points around it determine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockedPlateaus<'a> {
    /// Points with the velocity of the plateau before each.
    knots: &'a [Knot],
    alpha: f64,
    end: f64,
    clock: Clock,
}

impl<'a> ClockedPlateaus<'a> {
    /// Solves for the velocities of the plateaus of `knots`, and writes the points that are kept into `knots`.
    ///
    /// `start` and `end` are the velocities V_s and V_e (m/s or rad/s), `share` gives the share α of a segment at either
    /// end in which velocity changes. `scratch` holds a value for each point.
    ///
    /// # Errors
    /// As [`Plateaus::solve`](super::Plateaus::solve), and [`PlanError`] for a table of less than two periods.
    pub fn solve(
        knots: &'a mut [Knot],
        start: f64,
        end: f64,
        share: impl Into<PlateauShare>,
        clock: Clock,
        scratch: &mut [f64],
    ) -> Result<Self, PlanError> {
        let (clock, cycles) = clock.align(knots, start, end)?;
        let mut last = 0.0;
        let count = thin(knots, |knot| {
            let cell = before(clock.place(knot.t));
            let is_kept = cell > last && cell <= cycles - 2.0;
            if is_kept {
                last = cell;
            }
            is_kept
        });
        let knots = &mut knots[..count];
        let alpha = share.into().found(|alpha| {
            let profile = ClockedPlateaus::solve_at(knots, start, end, alpha, clock, scratch)?;
            Ok(Demand::of(profile.commands(), start))
        })?;
        Self::solve_at(knots, start, end, alpha, clock, scratch)
    }

    /// Solves with `alpha`, through `knots` that are all kept, of which the first and the last are at instants.
    fn solve_at(
        knots: &'a mut [Knot],
        start: f64,
        end: f64,
        alpha: f64,
        clock: Clock,
        scratch: &mut [f64],
    ) -> Result<Self, PlanError> {
        let (count, scratch) = (knots.len(), scratch_for(scratch, knots.len())?);
        let (mut above, mut known, mut corner) = (0.0, start, Corner::at(knots, 0, alpha, clock));
        for i in 1..count {
            let next = Corner::at(knots, i, alpha, clock);
            let (length, way) = (clock.place(knots[i].t) - clock.place(knots[i - 1].t), knots[i].x - knots[i - 1].x);
            let (left, right) = (corner.after(), next.before());
            let pivot = length - left - right - left * above;
            (above, known) = (right / pivot, (way / clock.period() - left * known) / pivot);
            (scratch[i], knots[i].v, corner) = (above, Some(known), next);
        }
        let mut behind = end;
        for i in (1..count).rev() {
            behind = knots[i].v.unwrap_or(0.0) - scratch[i] * behind;
            knots[i].v = Some(behind);
        }
        checked(knots)?;
        Ok(Self { knots, alpha, end, clock })
    }

    /// The profile of `knots` in which an earlier [`solve`](Self::solve) with this `end`, `alpha` and `clock` has left its points, if
    /// its result cannot be kept; nothing is checked again.
    #[must_use]
    pub fn solved(knots: &'a [Knot], end: f64, alpha: f64, clock: Clock) -> Self {
        let first = knots.first().map_or(0.0, |knot| clock.nearest(knot.t));
        Self { knots, alpha, end, clock: clock.from(first) }
    }

    /// The points that are met, the ends at instants, each with the velocity of the plateau before it.
    #[must_use]
    pub const fn knots(&self) -> &'a [Knot] {
        self.knots
    }

    /// The share α of a segment at either end in which velocity changes.
    #[must_use]
    pub const fn share(&self) -> f64 {
        self.alpha
    }

    /// The ramps in the order of time: one at each point.
    #[must_use]
    pub fn ramps(self) -> impl ExactSizeIterator<Item = VelocityRamp> + 'a {
        (0..self.knots.len()).map(move |i| self.ramp(i))
    }

    /// The commands: one at the beginning of each ramp.
    #[must_use]
    pub fn commands(self) -> impl ExactSizeIterator<Item = Command> + 'a {
        self.ramps().map(|ramp| ramp.command())
    }

    /// The last ramp that has begun at `t` (s), found in log N steps; the first one before it.
    #[must_use]
    pub fn ramp_at(&self, t: f64) -> VelocityRamp {
        self.ramp(self.begun(t))
    }

    /// The polynomial at `t` (s): of a ramp, of the plateau behind it, or of the velocity V_e at the end.
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        let i = self.begun(t);
        let ramp = self.ramp(i);
        let (VelocityRamp { begin, from, to, .. }, end) = (ramp, ramp.end());
        let knot = self.knots[i];
        // A known position: that of the point, which lies within the ramp.
        let slope = ramp.slope();
        let place = Setpoint { x: knot.x, v: from + slope * (knot.t - begin), a: slope, ..Setpoint::default() };
        if t < end {
            return Piece::between(place.after(begin - knot.t), begin, end);
        }
        let plateau = Setpoint { v: to, a: 0.0, ..place.after(end - knot.t) };
        let until = if i + 1 < self.knots.len() { self.ramp(i + 1).begin } else { f64::INFINITY };
        Piece::between(plateau, end, until)
    }

    /// The ramp at point `i`.
    fn ramp(&self, i: usize) -> VelocityRamp {
        let Corner { begin, end, .. } = Corner::at(self.knots, i, self.alpha, self.clock);
        let velocity = |i: usize| self.knots.get(i).map_or(self.end, |knot| knot.v.unwrap_or(0.0));
        let (begin, length) = (self.clock.time(begin), (end - begin) * self.clock.period());
        VelocityRamp { begin, length, from: velocity(i), to: velocity(i + 1) }
    }

    /// Number of the last ramp that has begun at `t` (s).
    fn begun(&self, t: f64) -> usize {
        // A ramp begins before its point, and after the one before.
        let behind = self.knots.partition_point(|knot| knot.t <= t).min(self.knots.len() - 1);
        if t >= self.ramp(behind).begin { behind } else { behind.saturating_sub(1) }
    }
}

/// Beginning and end of the ramp from one plateau to the next, and the point in it (periods).
#[derive(Debug, Clone, Copy)]
struct Corner {
    begin: f64,
    point: f64,
    end: f64,
}

impl Corner {
    fn at(knots: &[Knot], i: usize, alpha: f64, clock: Clock) -> Self {
        let place = |i: usize| clock.place(knots[i].t);
        let point = place(i);
        let begin = if i > 0 { behind(point - alpha * (point - place(i - 1))).min(before(point)) } else { 0.0 };
        if i + 1 == knots.len() {
            // At an instant itself.
            let end = before(point);
            return Self { begin: begin.min(end - 1.0), point, end };
        }
        let end = before(point + alpha * (place(i + 1) - point)).max(behind(point));
        Self { begin, point, end: end.max(begin + 1.0) }
    }

    /// The part of the velocity's step that is made at the point, integrated before and after it (periods).
    fn before(&self) -> f64 {
        let part = self.point - self.begin;
        part * part / (2.0 * (self.end - self.begin))
    }

    fn after(&self) -> f64 {
        let part = self.end - self.point;
        part * part / (2.0 * (self.end - self.begin))
    }
}

/// Option 2 at instants: the cubic spline, followed in steps of velocity from instant to instant.
///
/// Of `rate` commands per second the k-th is sent at the last instant not behind `k/rate`, and none twice: the velocity is the spline's
/// at each, and linear in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockedSpline<'a> {
    table: Table<'a>,
    clock: Clock,
    cycles: f64,
    /// Periods from one command to the next, at least 1.
    step: f64,
}

impl<'a> ClockedSpline<'a> {
    /// Solves for the velocities of the spline of `knots`, the ends of which are moved to instants and their neighbours left out if
    /// they are within half a period of them, and writes the points that are kept into `knots`.
    ///
    /// `start` and `end` are the velocities V_s and V_e (m/s or rad/s), `rate` the commands per second (1/s); if there are fewer
    /// instants, one is sent at each. `scratch` holds a value for each point.
    ///
    /// # Errors
    /// As [`Spline::solve`], and [`PlanError`] for a rate that is not positive, and for a table of less than two periods.
    pub fn solve(
        knots: &'a mut [Knot],
        start: f64,
        end: f64,
        rate: f64,
        clock: Clock,
        scratch: &mut [f64],
    ) -> Result<Self, PlanError> {
        let rate = in_range("rate", positive("rate", rate)?, "give commands per second")?;
        let (clock, cycles) = clock.align(knots, start, end)?;
        let count = thin(knots, |knot| (0.5..=cycles - 0.5).contains(&clock.place(knot.t)));
        let table = Spline::solve(&mut knots[..count], start, end, scratch)?.table();
        Ok(Self { table, clock, cycles, step: (1.0 / (rate * clock.period())).max(1.0) })
    }

    /// The steps along the spline of `knots` in which an earlier [`solve`](Self::solve) with this `rate` and `clock` has left its points,
    /// if its result cannot be kept; nothing is checked again.
    #[must_use]
    pub fn solved(knots: &'a [Knot], rate: f64, clock: Clock) -> Self {
        let [first, last] = [knots.first(), knots.last()].map(|knot| knot.map_or(0.0, |knot| clock.nearest(knot.t)));
        let step = (1.0 / (rate * clock.period())).max(1.0);
        Self { table: Table::solved(knots), clock: clock.from(first), cycles: last - first, step }
    }

    /// The spline itself.
    #[must_use]
    pub const fn table(&self) -> Table<'a> {
        self.table
    }

    /// The commands, from that of the first point on.
    #[must_use]
    pub fn commands(self) -> ClockedSteps<'a> {
        ClockedSteps { way: self, next: 0.0, velocity: self.table.segment(0).v, cursor: self.table.cursor() }
    }

    /// The last step that has begun at `t` (s), found in log N steps; the first one before it, and the last one behind the end.
    #[must_use]
    pub fn ramp_at(&self, t: f64) -> VelocityRamp {
        let Self { table, clock, cycles, step } = *self;
        let place = before(clock.place(t)).clamp(0.0, cycles - 1.0);
        // The last command sent at or before this instant.
        let last = libm::ceil((place + 1.0) / step) - 1.0;
        let k = if before(last * step) > place { last - 1.0 } else { last };
        let [begin, end] = [k, k + 1.0].map(|k| clock.time(before(k * step).min(cycles)));
        let [from, to] = [begin, end].map(|t| table.at(t).v);
        VelocityRamp { begin, length: end - begin, from, to }
    }
}

/// The commands of [`ClockedSpline`], in the order of time.
#[derive(Debug, Clone)]
pub struct ClockedSteps<'a> {
    way: ClockedSpline<'a>,
    next: f64,
    /// Velocity of the drive at the next command (m/s or rad/s).
    velocity: f64,
    cursor: Cursor<Table<'a>>,
}

impl Iterator for ClockedSteps<'_> {
    type Item = Command;

    fn next(&mut self) -> Option<Command> {
        let ClockedSpline { clock, cycles, step, .. } = self.way;
        let [from, to] = [self.next, self.next + 1.0].map(|k| before(k * step).min(cycles));
        if from >= cycles {
            return None;
        }
        self.next += 1.0;
        let (t, until) = (clock.time(from), clock.time(to));
        // The end velocity bit for bit.
        let end = self.way.table.knots().last().and_then(|last| last.v).filter(|_| to >= cycles);
        let velocity = end.unwrap_or_else(|| self.cursor.at(until).v);
        let acceleration = (velocity - self.velocity).abs() / (until - t);
        self.velocity = velocity;
        Some(Command { t, velocity, acceleration })
    }
}
