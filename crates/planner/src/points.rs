//! A move as points, between which a drive generates cubics (PVT), and their deviation from the move.
use crate::analysis::Span;
use crate::plan::Plan;
use crate::request::{Generator, Request};
use crate::table::{Follow, TableMove, Velocities};
use servobench_base::{ParamError, Setpoint, positive};
use servobench_motion::PlanError;
use servobench_motion::pvt::Knot;

/// Times of the points of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointTimes {
    /// Time from point to point (s).
    pub spacing: f64,
    /// Unit (s) of the time of the last point, which is a whole multiple at or after the end of a move to rest; zero: exactly the end.
    pub unit: f64,
}

/// The trajectory through the points of a move.
#[derive(Debug, Clone)]
pub struct PointMove {
    /// The points, from time 0 on.
    pub knots: Vec<Knot>,
    /// The trajectory through them.
    pub way: Plan,
    /// Deviation of that from the move.
    pub deviation: Deviation,
}

/// The largest deviation between two moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Magnitude (m or rad).
    pub distance: f64,
    /// Time (s).
    pub time: f64,
}

/// Relative tolerance for equal times.
const NEAR: f64 = 1e-9;
/// Largest number of points: that of a table that can be read.
const MOST_POINTS: f64 = 5e6;
/// Longest time from point to point in the search (ms): the range of a point's time.
const LONGEST: u8 = 255;
/// Bisections that reduce an interval to rounding.
const BISECTIONS: u32 = 60;

impl PointTimes {
    /// Default time from point to point (s).
    pub const SPACING: f64 = 0.01;

    /// Points every `spacing` (s); the last of a move to rest is at a whole millisecond if the spacing is, as drives count time.
    #[must_use]
    pub fn every(spacing: f64) -> Self {
        let milliseconds = 1e3 * spacing;
        let is_whole = milliseconds > 0.5 && (milliseconds - milliseconds.round()).abs() < NEAR * milliseconds;
        Self { spacing, unit: if is_whole { 1e-3 } else { 0.0 } }
    }

    /// The time of point `k` (s): for a spacing of whole microseconds the nearest number to the decimal one.
    fn time(self, k: f64) -> f64 {
        multiple(self.spacing, k)
    }

    /// The time of the last point of `plan` (s).
    fn last(self, plan: &Plan) -> f64 {
        let duration = plan.duration();
        if self.unit > 0.0 && plan.end().v == 0.0 {
            let units = (duration / self.unit * (1.0 - NEAR)).ceil();
            multiple(self.unit, units).max(if units > 0.0 { 0.0 } else { self.unit })
        } else {
            duration
        }
    }
}

/// `k` times `time` (s), rounded once if the time is a whole number of microseconds.
fn multiple(time: f64, k: f64) -> f64 {
    let whole = (1e6 * time).round();
    if (1e6 * time - whole).abs() < NEAR * whole { k * whole / 1e6 } else { k * time }
}

impl Plan {
    /// The move as points at `times`, with its velocities there.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] for a time between points that is not above zero, or that leads to more than five million points;
    /// [`PlanError`] for points that are not a valid table.
    pub fn in_points(&self, times: PointTimes) -> Result<PointMove, PlanError> {
        positive("point_time", times.spacing)?;
        let last = times.last(self);
        let count = (last / times.spacing * (1.0 - NEAR)).ceil();
        if count > MOST_POINTS {
            let bound = "long enough for at most 5 million points";
            return Err(ParamError { name: "point_time", value: times.spacing, bound }.into());
        }
        let mut reader = self.reader_at(0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "five million at most")]
        let inner = (0..count as u32).map(|k| times.time(f64::from(k)));
        let knots: Vec<Knot> = inner
            .chain([last])
            .map(|t| {
                if !reader.holds(t) {
                    reader.look_up(self, t);
                }
                let Setpoint { x, v, .. } = reader.at(t);
                Knot::moving(t, x, v)
            })
            .collect();
        self.through(knots)
    }

    /// The move as points that are as rare as possible with a deviation of at most `allowed` (m or rad): at equal distances of whole
    /// milliseconds, at most 255. Returns the times of the points with the move.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] for a deviation that is not above zero, or smaller than that of points every millisecond; the others
    /// of [`Plan::in_points`].
    pub fn in_fewest_points(&self, allowed: f64) -> Result<(PointTimes, PointMove), PlanError> {
        positive("allowed_deviation", allowed)?;
        for milliseconds in (1..=LONGEST).rev() {
            let times = PointTimes { spacing: f64::from(milliseconds) / 1e3, unit: 1e-3 };
            let points = self.in_points(times)?;
            if points.deviation.distance <= allowed {
                return Ok((times, points));
            }
        }
        let bound = "what points every millisecond keep, or more";
        Err(ParamError { name: "allowed_deviation", value: allowed, bound }.into())
    }

    /// The trajectory through `knots`, which represent this move from their first time on.
    ///
    /// # Errors
    /// [`PlanError`] for points that are not a valid table.
    pub fn through(&self, knots: Vec<Knot>) -> Result<PointMove, PlanError> {
        let table = TableMove { knots, velocities: Velocities::Given, follow: Follow::Segments };
        let way = Request::new(Generator::Table(table.clone())).plan()?.within(*self.limits());
        let deviation = self.deviation(&way);
        Ok(PointMove { knots: table.knots, way, deviation })
    }

    /// Largest deviation between this move and `other`, which begin at the same time: exact except for rounding.
    #[must_use]
    pub fn deviation(&self, other: &Self) -> Deviation {
        let mut farthest = Deviation { distance: 0.0, time: 0.0 };
        let until = self.duration().max(other.duration());
        let (mut ours, mut theirs) = (Pieces::of(self, until), Pieces::of(other, until));
        let mut t = 0.0;
        loop {
            let (one, two) = (ours.at(t), theirs.at(t));
            let end = (one.start + one.length).min(two.start + two.length).min(until);
            let length = (end - t).max(0.0);
            let apart = Apart::new(one, two, t);
            if apart.bound(length) > farthest.distance {
                for since in apart.turns(length) {
                    let distance = apart.distance(since).abs();
                    if distance > farthest.distance {
                        farthest = Deviation { distance, time: t + since };
                    }
                }
            }
            if end >= until {
                return farthest;
            }
            t = end.max(t.next_up());
        }
    }
}

/// The polynomials of a plan, the last of which extends to any requested time.
struct Pieces<I> {
    spans: I,
    now: Span,
    end: Span,
}

impl<'a> Pieces<Box<dyn Iterator<Item = Span> + 'a>> {
    fn of(plan: &'a Plan, until: f64) -> Self {
        let Setpoint { x, v, .. } = plan.end();
        let start = plan.duration();
        let state = Setpoint { v, ..Setpoint::at_rest(x) };
        let end = Span { start, length: until - start, state, is_held: false };
        let mut spans: Box<dyn Iterator<Item = Span> + 'a> = Box::new(plan.spans());
        let now = spans.next().unwrap_or(end);
        Self { spans, now, end }
    }

    /// The polynomial at `t` (s), which must not precede the previous request.
    fn at(&mut self, t: f64) -> Span {
        while self.now.start + self.now.length <= t && self.now.start < self.end.start {
            self.now = self.spans.next().unwrap_or(self.end);
        }
        self.now
    }
}

/// The difference of two polynomials: Σ c[k]·t^k.
struct Apart {
    c: [f64; 5],
}

impl Apart {
    fn new(one: Span, two: Span, t: f64) -> Self {
        let at = |span: Span| {
            let Setpoint { x, v, a, j, s } = span.after(t - span.start);
            if span.is_held { [x, 0.0, 0.0, 0.0, 0.0] } else { [x, v, a / 2.0, j / 6.0, s / 24.0] }
        };
        let (one, two) = (at(one), at(two));
        Self { c: std::array::from_fn(|k| two[k] - one[k]) }
    }

    fn distance(&self, t: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |sum, c| sum * t + c)
    }

    /// Upper bound of the magnitude up to `length`.
    fn bound(&self, length: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |sum, c| sum * length + c.abs())
    }

    fn slope(&self, t: f64) -> f64 {
        let [_, c1, c2, c3, c4] = self.c;
        c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * 4.0 * c4))
    }

    /// Times up to `length` at which the distance may be extreme: both ends, and the sign changes of the slope.
    fn turns(&self, length: f64) -> Vec<f64> {
        let [_, _, c2, c3, c4] = self.c;
        // Between the zeros of its derivative, c2 + 3·c3·t + 6·c4·t², the slope is monotonic.
        let root = (9.0 * c3 * c3 - 24.0 * c4 * c2).sqrt();
        let q = -0.5 * (3.0 * c3 + root.copysign(c3));
        let mut ends = vec![0.0, length];
        ends.extend([q / (6.0 * c4), c2 / q].into_iter().filter(|t| *t > 0.0 && *t < length));
        ends.sort_by(f64::total_cmp);
        let zeros: Vec<f64> = ends
            .windows(2)
            .filter(|pair| self.slope(pair[0]) * self.slope(pair[1]) < 0.0)
            .map(|pair| {
                let (mut low, mut high) = (pair[0], pair[1]);
                let sign = self.slope(low);
                for _ in 0..BISECTIONS {
                    let middle = 0.5 * (low + high);
                    if self.slope(middle) * sign > 0.0 { low = middle } else { high = middle }
                }
                low
            })
            .collect();
        [0.0, length].into_iter().chain(zeros).collect()
    }
}
