//! Option 2: a cubic spline, followed in steps of velocity.
use super::Command;
use crate::PlanError;
use crate::limits::{RANGE, in_range};
use crate::pvt::{Cursor, Knot, Table, continuous};
use servobench_base::positive;

/// The cubic spline through the points with given end velocities; the velocities of the points are stored in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spline<'a> {
    table: Table<'a>,
}

impl<'a> Spline<'a> {
    /// Solves for the velocities of `knots`, of which the first one is the position at the start, and writes them
    /// there.
    ///
    /// `start` and `end` are the velocities V_s and V_e (m/s or rad/s); `scratch` holds a value for each point.
    ///
    /// # Errors
    /// [`PlanError`] for fewer than two points, names the first one that is not finite or not later than the one
    /// before, and refuses a short slice.
    pub fn solve(knots: &'a mut [Knot], start: f64, end: f64, scratch: &mut [f64]) -> Result<Self, PlanError> {
        continuous(knots, start, end, scratch)?;
        Ok(Self { table: Table::new(knots)? })
    }

    /// The spline of `knots` in which an earlier [`solve`](Self::solve) has left its velocities, if its result
    /// cannot be kept; nothing is checked again.
    #[must_use]
    pub const fn solved(knots: &'a [Knot]) -> Self {
        Self { table: Table::solved(knots) }
    }

    /// The set-points of the spline itself.
    #[must_use]
    pub const fn table(&self) -> Table<'a> {
        self.table
    }

    /// The spline, followed by `rate` commands per second (1/s).
    ///
    /// # Errors
    /// [`PlanError`] if `rate` is not positive or out of range, or so high that the times of the table do not separate two
    /// commands.
    pub fn stepped(self, rate: f64) -> Result<Stepped<'a>, PlanError> {
        let rate = in_range("rate", positive("rate", rate)?, "give commands per second")?;
        let (resolution, highest) = (self.resolution(), self.highest_rate());
        if rate > highest {
            let remedy = "send fewer commands, or let the table begin at time 0";
            return Err(PlanError::OutOfRange { name: "rate", value: rate, lowest: RANGE.0, highest, remedy });
        }
        // A last interval of mere rounding belongs to the one before.
        let intervals = (self.table.duration() - resolution) * rate;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number below 2^43")]
        let count = (libm::ceil(intervals) as u64).max(1);
        Ok(Stepped { table: self.table, rate, count })
    }

    /// The highest rate (1/s) for which the resolution of the table's times is sufficient.
    pub(super) fn highest_rate(self) -> f64 {
        1e-3 / self.resolution()
    }

    /// Rounding of the times (s).
    fn resolution(self) -> f64 {
        let knots = self.table.knots();
        4.0 * f64::EPSILON * knots[0].t.abs().max(knots[knots.len() - 1].t.abs())
    }
}

/// A [`Spline`] followed by a drive with a command every 1/rate seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepped<'a> {
    table: Table<'a>,
    rate: f64,
    count: u64,
}

impl<'a> Stepped<'a> {
    /// The commands, from that of the first point on. The last one takes the remaining time, so that the drive has the
    /// end velocity at the last point.
    #[must_use]
    pub fn commands(self) -> SteppedCommands<'a> {
        let cursor = self.table.cursor();
        SteppedCommands { way: self, next: 0, velocity: self.table.segment(0).v, cursor }
    }

    /// Position of the drive minus the spline's at each point (m or rad), from the first on: exact except for rounding.
    #[must_use]
    pub fn point_errors(self) -> PointErrors<'a> {
        PointErrors { way: self, next: 0, grid: Grid::new(&self), ends: self.table.cursor() }
    }

    /// Largest difference between the positions of the drive and the spline at any time (m or rad): exact except for
    /// rounding.
    #[must_use]
    pub fn largest_error(&self) -> f64 {
        let knots = self.table.knots();
        let mut grid = Grid::new(self);
        let mut points = self.point_errors();
        let mut largest = 0.0_f64;
        for i in 0..knots.len() {
            largest = points.advance().map_or(largest, |near| largest.max(near.largest));
            // From the first to the last command in a segment the error is monotonic.
            let behind = knots.get(i + 1).map_or(0.0, |next| libm::floor(self.intervals_to(next.t)).min(self.last()));
            let first = libm::ceil(self.intervals_to(knots[i].t));
            if first <= behind {
                largest = largest.max(grid.error(self, first).abs()).max(grid.error(self, behind).abs());
            }
        }
        largest
    }

    /// Commands per second (1/s).
    #[must_use]
    pub const fn rate(&self) -> f64 {
        self.rate
    }

    /// Number of commands.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// Number of the last command.
    const fn last(&self) -> f64 {
        (self.count - 1) as f64
    }

    /// Time of command `k` (s), k a whole number; that of the last point behind the last command.
    fn time(&self, k: f64) -> f64 {
        let knots = self.table.knots();
        if k >= self.count as f64 { knots[knots.len() - 1].t } else { knots[0].t + k / self.rate }
    }

    /// `t` (s) in intervals from the first point on.
    fn intervals_to(&self, t: f64) -> f64 {
        (t - self.table.knots()[0].t) * self.rate
    }

    /// Jerk in segment `i` (m/s³ or rad/s³).
    fn jerk(&self, i: usize) -> f64 {
        self.table.segment(i).j
    }
}

/// The error at the commands in the order of time: h²/12·(a(t_k) − a(t_0)) + h³/6·Σ Δj·B3(θ).
#[derive(Debug, Clone, Copy)]
struct Grid {
    segment: usize,
    jerk: f64,
    /// Σ Δj·B3(θ) over the points passed.
    sum: f64,
    a_start: f64,
}

impl Grid {
    fn new(way: &Stepped<'_>) -> Self {
        let first = way.table.segment(0);
        Self { segment: 0, jerk: first.j, sum: 0.0, a_start: first.a }
    }

    /// The error at command `k`, a whole number not below the previous one.
    fn error(&mut self, way: &Stepped<'_>, k: f64) -> f64 {
        let (knots, t) = (way.table.knots(), way.time(k));
        while self.segment + 2 < knots.len() && knots[self.segment + 1].t <= t {
            self.segment += 1;
            let jerk = way.jerk(self.segment);
            let place = way.intervals_to(knots[self.segment].t);
            let theta = place - libm::floor(place);
            self.sum += (jerk - self.jerk) * (theta * (theta - 0.5) * (theta - 1.0));
            self.jerk = jerk;
        }
        let h = 1.0 / way.rate;
        let a = way.table.segment(self.segment).a + self.jerk * (t - knots[self.segment].t);
        h * h / 12.0 * (a - self.a_start) + h * h * h / 6.0 * self.sum
    }
}

/// The commands of [`Stepped`], in the order of time.
#[derive(Debug, Clone)]
pub struct SteppedCommands<'a> {
    way: Stepped<'a>,
    next: u64,
    /// Velocity of the drive at the next command (m/s or rad/s).
    velocity: f64,
    cursor: Cursor<Table<'a>>,
}

impl Iterator for SteppedCommands<'_> {
    type Item = Command;

    fn next(&mut self) -> Option<Command> {
        if self.next == self.way.count {
            return None;
        }
        let k = self.next as f64;
        let (t, until) = (self.way.time(k), self.way.time(k + 1.0));
        self.next += 1;
        let velocity = self.cursor.at(until).v;
        let acceleration = (velocity - self.velocity).abs() / (until - t);
        self.velocity = velocity;
        Some(Command { t, velocity, acceleration })
    }
}

/// The errors at the points of a [`Stepped`] spline, in the order of time.
#[derive(Debug, Clone)]
pub struct PointErrors<'a> {
    way: Stepped<'a>,
    next: usize,
    grid: Grid,
    /// Reads the velocities at the ends of the intervals in which the points lie.
    ends: Cursor<Table<'a>>,
}

/// The error at a point, and the largest one from the command or point before to the command or point behind it.
struct Near {
    error: f64,
    largest: f64,
}

impl PointErrors<'_> {
    fn advance(&mut self) -> Option<Near> {
        let (way, table, i) = (self.way, self.way.table, self.next);
        let knots = table.knots();
        let point = *knots.get(i)?;
        self.next += 1;
        let k = libm::floor(way.intervals_to(point.t)).min(way.last());
        let (start, until) = (way.time(k), way.time(k + 1.0));
        let at_command = self.grid.error(&way, k);
        let now = table.segment(self.grid.segment).after((start - knots[self.grid.segment].t).max(0.0));
        // From the command on, the velocity of the drive changes linearly.
        let (s, slope) = (point.t - start, (self.ends.at(until).v - now.v) / (until - start));
        let error = at_command + (s * now.v + s * s / 2.0 * slope - (point.x - now.x));
        let mut largest = error.abs();
        if self.grid.segment + 1 == i {
            // Otherwise the command lies before the previous point, which has covered everything from there on.
            let leave = Leave { error: at_command, velocity: 0.0, acceleration: slope - now.a, jerk: now.j };
            largest = largest.max(leave.largest_within(s));
        }
        if let Some(next) = knots.get(i + 1) {
            let here = table.segment(i);
            let velocity = now.v + s * slope - here.v;
            let leave = Leave { error, velocity, acceleration: slope - here.a, jerk: here.j };
            largest = largest.max(leave.largest_within(next.t.min(until) - point.t));
        }
        Some(Near { error, largest })
    }
}

/// Departure of the drive from the spline: error and its derivatives, those of the drive minus the spline's; the jerk is the
/// spline's, as the drive has none.
struct Leave {
    error: f64,
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl Leave {
    /// The largest error at a turning point within the next `length` (s); 0 if there is none.
    fn largest_within(&self, length: f64) -> f64 {
        let Self { error, velocity, acceleration, jerk } = *self;
        // j/2·s² − a·s − v = 0, without cancellation.
        let q = acceleration
            + libm::copysign(libm::sqrt(acceleration * acceleration + 2.0 * jerk * velocity), acceleration);
        let mut largest = 0.0_f64;
        for s in [q / jerk, -2.0 * velocity / q] {
            if s > 0.0 && s < length {
                largest = largest.max((error + s * (velocity + s / 2.0 * (acceleration - s / 3.0 * jerk))).abs());
            }
        }
        largest
    }
}

impl Iterator for PointErrors<'_> {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        self.advance().map(|near| near.error)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.way.table.knots().len() - self.next;
        (left, Some(left))
    }
}

impl ExactSizeIterator for PointErrors<'_> {}
