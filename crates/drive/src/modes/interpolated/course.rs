//! Trajectory of a move: from point to point, in the order of the buffer.
//!
//! The polynomials are those of [`Table`](servobench_motion::pvt::Table), formed one at a time:
//!
//! ```text
//! with h the time of the segment, s = (P1 − P0)/h:    linear  v = s    cubic  a0 = 2(3s − 2V0 − V1)/h,  j = 6(V0 + V1 − 2s)/h²
//! ```
//!
//! A cubic segment behind a linear one begins with its velocity; behind a first point without a velocity, at rest.
//!
//! No segment exceeds the highest velocity: one that is too long ends before its point, and the next one catches up as far as it can;
//! behind the last point a line leads there. A cubic that would be too fast between its ends is replaced by a line.
use super::Params;
use super::buffer::{Buffer, Entry};
use crate::modes::reach::Reach;
use servobench_base::{Setpoint, Stateful};
use servobench_cia402::interpolated::Point;

/// Unit of a drive's velocity (counts/s).
const VELOCITY_UNIT: f64 = 0.1;

/// A point with its position made absolute.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Knot {
    /// Position (counts); relative points may leave the 32 bits of a counter.
    pub(super) counts: i64,
    point: Point,
}

/// Next point of the buffer; a relative one counts from `origin` (counts).
pub(super) fn next_knot(buffer: &mut Buffer, mut origin: i64) -> Option<Knot> {
    loop {
        match buffer.pop()? {
            Entry::Base(position) => origin = position.into(),
            Entry::Point(point) => {
                let from = if point.is_relative { origin } else { 0 };
                return Some(Knot { counts: from + i64::from(point.position), point });
            }
        }
    }
}

/// The present segment.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct Course {
    /// State at the beginning of the segment, with the derivatives for the whole segment.
    start: Setpoint,
    /// Time since the beginning (s).
    passed: f64,
    duration: f64,
    end: Knot,
    /// Distance from the end of the segment to its point (m or rad): not zero if the point could not be reached in time.
    left: f64,
    /// True if the segment is slower than the points request.
    is_limited: bool,
}

/// Result of a step of the trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    /// Present set-point.
    Along(Setpoint),
    /// The last point is reached, with this position and velocity.
    Ended(Setpoint),
    /// The next point is missing.
    Starved,
}

/// Actual duration of segments of constant time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(super) enum Pace {
    /// As given by the points.
    Given,
    /// A period of the drive less or more, so that the buffer holds [`HELD`] points as a segment begins.
    Adapted,
}

/// Number of points that sub-mode 0 waits for, and keeps in the buffer.
pub(super) const HELD: usize = 3;

impl Course {
    /// Trajectory from a first point, which lasts until the second; `None` without a second one.
    ///
    /// The axis starts at its present position, within a count of the first point.
    pub(super) fn from_knot(first: Knot, at: f64, p: &Params, buffer: &mut Buffer) -> Option<Self> {
        let v = first.velocity(p.count).unwrap_or(0.0);
        let start = Setpoint { v, ..Setpoint::at_rest(at) };
        let end = next_knot(buffer, first.counts)?;
        Some(Self::segment(start, first.duration(), end, p, end.offset(at, p.count)))
    }

    /// Trajectory from the present position to the first point in a constant time (s).
    pub(super) fn approach(at: f64, counts: i64, duration: f64, p: &Params, buffer: &mut Buffer) -> Option<Self> {
        let end = next_knot(buffer, counts)?;
        Some(Self::segment(Setpoint::at_rest(at), duration, end, p, end.offset(at, p.count)))
    }

    /// Segment from `start` to `end`, which is `distance` away, as far as the highest velocity allows.
    fn segment(start: Setpoint, duration: f64, end: Knot, p: &Params, distance: f64) -> Self {
        let reach = Reach::new(p.velocity, duration, start.x.abs() + distance.abs());
        let cut = reach.cut(distance);
        let way = cut.unwrap_or(distance);
        let (slope, h) = (way / duration, duration);
        let line = Setpoint { v: slope, ..Setpoint::at_rest(start.x) };
        let (start, is_slower) = match end.velocity(p.count) {
            None => (line, false),
            Some(asked) => {
                let (v0, v1) = (reach.velocity(start.v), reach.velocity(asked));
                let (a, j) = ((3.0 * slope - 2.0 * v0 - v1) * 2.0 / h, (v0 + v1 - 2.0 * slope) * 6.0 / h / h);
                let cubic = Setpoint { x: start.x, v: v0, a, j, s: 0.0 };
                let is_too_fast = reach.is_passed_by(&cubic);
                let is_slower = is_too_fast || reach.is_exceeded_by(asked) || reach.is_exceeded_by(start.v);
                (if is_too_fast { line } else { cubic }, is_slower)
            }
        };
        let left = cut.map_or(0.0, |way| distance - way);
        Self { start, passed: 0.0, duration, end, left, is_limited: cut.is_some() || is_slower }
    }

    /// First set-point.
    pub(super) const fn start(&self) -> Setpoint {
        self.start
    }

    /// True if the highest velocity makes the trajectory slower than the points request.
    pub(super) const fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// Advances by one period of the drive.
    pub(super) fn step(&mut self, period: f64, p: &Params, pace: Pace, buffer: &mut Buffer) -> Step {
        self.passed += period;
        while self.passed >= self.duration {
            let at = self.reached(p.count);
            let passed = self.passed - self.duration;
            if self.end.is_last() {
                if self.left != 0.0 {
                    *self = Self { passed, ..self.rest(at.x, p) };
                    continue;
                }
                return Step::Ended(Setpoint { v: self.end.velocity(p.count).unwrap_or(0.0), ..at });
            }
            let waiting = buffer.count();
            let Some(next) = next_knot(buffer, self.end.counts) else { return Step::Starved };
            let distance = (next.counts - self.end.counts) as f64 * p.count + self.left;
            let duration = match pace {
                Pace::Given => self.end.duration(),
                Pace::Adapted => adapted(self.end.duration(), waiting, period),
            };
            *self = Self { passed, ..Self::segment(at, duration, next, p, distance) };
        }
        Step::Along(self.start.after(self.passed))
    }

    /// Position and velocity at the end of the segment.
    fn reached(&self, count: f64) -> Setpoint {
        let x = self.end.counts as f64 * count - self.left;
        let asked = self.end.velocity(count).filter(|_| !self.is_limited);
        Setpoint { v: asked.unwrap_or_else(|| self.start.after(self.duration).v), ..Setpoint::at_rest(x) }
    }

    /// Line over the remaining distance to the last point, from `x` on at the highest velocity.
    fn rest(&self, x: f64, p: &Params) -> Self {
        let start = Setpoint { v: p.velocity.copysign(self.left), ..Setpoint::at_rest(x) };
        Self { start, duration: self.left.abs() / p.velocity, left: 0.0, ..*self }
    }
}

/// Duration, shorter by a period if more points than [`HELD`] wait, longer by a period if fewer do.
fn adapted(duration: f64, waiting: usize, period: f64) -> f64 {
    match waiting.cmp(&HELD) {
        core::cmp::Ordering::Less => duration + period,
        core::cmp::Ordering::Equal => duration,
        core::cmp::Ordering::Greater => (duration - period).max(period),
    }
}

impl Knot {
    /// Distance of the point from `at`.
    fn offset(&self, at: f64, unit: f64) -> f64 {
        self.counts as f64 * unit - at
    }

    /// True if the move ends at this point.
    pub(super) const fn is_last(&self) -> bool {
        self.point.time == 0
    }

    fn velocity(&self, unit: f64) -> Option<f64> {
        self.point.velocity.map(|velocity| f64::from(velocity) * VELOCITY_UNIT * unit)
    }

    fn duration(&self) -> f64 {
        f64::from(self.point.time) / 1e6
    }
}
