//! A move as points: for a table, and as the words that are sent to a drive.
use super::csv::DERIVED;
use super::table::kept;
use super::words::exceeded;
use super::{NAMES, PlannedMove};
use crate::error::ReportError;
use servobench_base::Setpoint;
use servobench_cia402::interpolated::serial::{Message, TRAJECTORY_BUFFER};
use servobench_cia402::interpolated::{Point, SubMode, TimePeriod};
use servobench_config::Choice as _;
use servobench_fieldbus::trajectory::{PointEncoding, PointTransfer, SentPoint, Unsendable, followed, points};
use servobench_motion::PlanError;
use servobench_motion::pvt::Knot;
use servobench_planner::{Deviation, Generator, PointMove, PointTimes, TableMove, Velocities};
use std::io::Write;

/// Spacing of the points of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PointChoice {
    /// Constant time between points (s).
    Every(f64),
    /// Fewest points that keep the path through them this close to the move (m or rad).
    FewestWithin(f64),
    /// The points of a table that is followed as it is; for any other move one every [`PointTimes::SPACING`].
    Own,
}

/// A move as points.
#[derive(Debug, Clone)]
pub(super) struct Points {
    /// Time from point to point (s); `None` for the points of a table.
    pub(super) spacing: Option<f64>,
    pub(super) through: PointMove,
    pub(super) sent: Option<Sent>,
}

/// The points as sent to a drive.
#[derive(Debug, Clone)]
pub(super) struct Sent {
    pub(super) transfer: PointTransfer,
    encoding: PointEncoding,
    points: Vec<Point>,
    /// Counts per metre or radian.
    pub(super) counts: f64,
    /// Deviation of the drive's path from the move.
    pub(super) deviation: Deviation,
}

impl PlannedMove {
    /// Adds the points of the move.
    ///
    /// # Errors
    /// [`PlanError`] for times or a deviation that the move cannot have.
    pub fn in_points(self, choice: PointChoice) -> Result<Self, PlanError> {
        let (spacing, through) = match (choice, self.own_points()) {
            (PointChoice::Own, Some(own)) => (None, self.plan.through(own)?),
            (PointChoice::Own, None) => (Some(PointTimes::SPACING), self.every(PointTimes::SPACING)?),
            (PointChoice::Every(spacing), _) => (Some(spacing), self.every(spacing)?),
            (PointChoice::FewestWithin(allowed), _) => {
                let (times, through) = self.plan.in_fewest_points(allowed)?;
                (Some(times.spacing), through)
            }
        };
        Ok(Self { points: Some(Points { spacing, through, sent: None }), ..self })
    }

    fn every(&self, spacing: f64) -> Result<PointMove, PlanError> {
        self.plan.in_points(PointTimes::every(spacing))
    }

    /// Ends of the segments of a table that is followed as it is; without a velocity where a line leads to the point.
    fn own_points(&self) -> Option<Vec<Knot>> {
        if !self.is_plain_table() || self.family() != "pvt" {
            return None;
        }
        if let Generator::Table(TableMove { knots, velocities: Velocities::Given, .. }) = &self.request.generator {
            let start = knots.first().map_or(0.0, |knot| knot.t);
            return Some(knots.iter().map(|knot| Knot { t: knot.t - start, ..*knot }).collect());
        }
        let Setpoint { x, v, .. } = self.plan.start();
        let mut knots = vec![Knot::moving(0.0, x, v)];
        knots.extend(self.plan.spans().map(|span| {
            let Setpoint { x, v, .. } = span.after(span.length);
            let is_line = span.state.a == 0.0 && span.state.j == 0.0;
            Knot { t: span.start + span.length, x, v: (!is_line).then_some(v) }
        }));
        Some(knots)
    }

    /// Encodes the points for `transfer` to a drive with `counts` per metre or radian, below zero
    /// if it counts in the opposite direction.
    ///
    /// # Errors
    /// [`Unsendable`] names the first point that the words cannot hold; [`PlanError`] for points that no move goes through.
    pub fn sent_by(mut self, transfer: PointTransfer, counts: f64) -> Result<Self, Unsent> {
        let Some(own) = &mut self.points else { return Ok(self) };
        let millisecond = TimePeriod::new(1, -3).map_err(|error| Unsent::Setting(error.to_string()))?;
        let encoding = PointEncoding::new(transfer, SubMode::Cubic, millisecond)?;
        let way = &own.through.way;
        let from = way.start().x;
        let relative = |setpoint: Setpoint| Setpoint { x: setpoint.x - from, ..setpoint };
        let polynomials: Vec<(f64, Setpoint)> = way.spans().map(|span| (span.length, relative(span.state))).collect();
        let points = points(polynomials, relative(way.end()), from, counts, encoding)?;
        let deviation = self.plan.through(followed(&points, from, counts))?.deviation;
        own.sent = Some(Sent { transfer, encoding, points, counts, deviation });
        Ok(self)
    }

    /// Writes time, position and velocity of each point, in SI. Returns true if there are points.
    ///
    /// # Errors
    /// [`ReportError::Io`].
    pub fn write_points(&self, mut out: impl Write) -> Result<bool, ReportError> {
        let Some(Points { through, .. }) = &self.points else { return Ok(false) };
        let unit = self.units.base();
        writeln!(out, "time [s],{} [{unit}],{} [{unit}{}]", NAMES[0], NAMES[1], DERIVED[1])?;
        for Knot { t, x, v } in &through.knots {
            writeln!(out, "{t},{x},{}", v.map_or_else(String::new, |v| v.to_string()))?;
        }
        out.flush()?;
        Ok(true)
    }

    /// Writes a row for each point as sent: its values in units of the drive, and its words in hexadecimal digits. Returns true if there
    /// are points.
    ///
    /// # Errors
    /// [`ReportError::Io`].
    pub fn write_words(&self, mut out: impl Write) -> Result<bool, ReportError> {
        let Some(Sent { transfer, encoding, points, counts, .. }) =
            self.points.as_ref().and_then(|points| points.sent.as_ref())
        else {
            return Ok(false);
        };
        let words = match transfer {
            PointTransfer::MoveSegment => "2010h",
            PointTransfer::DataRecord => "60C1h.1,60C1h.2,60C1h.3",
            PointTransfer::Serial => "115h word,115h position,115h velocity",
        };
        writeln!(out, "point,position [counts],way [counts],velocity [0.1 counts/s],time to next [ms],{words}")?;
        let mut position = (self.plan.start().x * counts).round();
        for (number, point) in points.iter().enumerate() {
            let sent = f64::from(point.position);
            let way = if point.is_relative { sent } else { sent - position };
            position += way;
            let velocity = point.velocity.map_or_else(String::new, |velocity| velocity.to_string());
            let time = f64::from(point.time) / 1e3;
            #[expect(clippy::cast_possible_truncation, reason = "the drive's number of a point has 16 bits and wraps")]
            let words = encoding.sent(*point, number as u16).map_or_else(String::new, hexadecimal);
            writeln!(out, "{},{position},{way},{velocity},{time},{words}", number + 1)?;
        }
        out.flush()?;
        Ok(true)
    }

    /// Notes about the points.
    pub(super) fn notes_of_points(&self, time: impl Fn(f64) -> String) -> Vec<String> {
        let Some(Points { spacing, through, sent }) = &self.points else { return Vec::new() };
        let count = through.knots.len();
        let when = spacing.map_or_else(|| "its own".to_owned(), |spacing| format!("every {}", time(spacing)));
        let off = |deviation: &Deviation| {
            if self.is_on_the_plan(deviation) {
                "on the plan".to_owned()
            } else {
                format!("at most {} off the plan, at {}", self.show_error(deviation.distance), time(deviation.time))
            }
        };
        let mut notes = vec![format!("{count} points, {when}: the way through them is {}", off(&through.deviation))];
        // Excess of a table itself is reported with the table.
        if spacing.is_some() {
            let beyond = exceeded(&kept(&through.way));
            notes.extend(beyond.map(|beyond| format!("the way through them {beyond}")));
        }
        notes.extend(sent.as_ref().map(|Sent { transfer, counts, deviation, .. }| {
            let unit = self.show_error((1.0 / counts).abs());
            format!("by {} in counts of {unit} it is {}", transfer.name(), off(deviation))
        }));
        notes
    }

    /// True if the deviation from the plan is only rounding.
    pub(super) fn is_on_the_plan(&self, deviation: &Deviation) -> bool {
        let (from, to) = (self.plan.start().x.abs(), self.plan.end().x.abs());
        super::without_dust(deviation.distance, from.max(to).max(self.distance().abs())) == 0.0
    }

    /// The points to mark in a drawing, with the velocity where it is known: (time, position, velocity).
    pub(super) fn marked_points(&self) -> Vec<(f64, f64, Option<f64>)> {
        let of = |knots: &[Knot]| {
            let start = knots.first().map_or(0.0, |knot| knot.t);
            knots.iter().map(|knot| (knot.t - start, knot.x, knot.v)).collect()
        };
        match (&self.points, &self.request.generator) {
            (Some(points), _) => of(&points.through.knots),
            (None, Generator::Table(table)) if self.is_plain_table() => {
                self.own_points().map_or_else(|| of(&table.knots), |own| of(&own))
            }
            _ => Vec::new(),
        }
    }

    /// True if it is a table that is neither slowed down nor filtered.
    fn is_plain_table(&self) -> bool {
        matches!(self.request.generator, Generator::Table(_))
            && self.request.duration.is_none()
            && self.plan.filter_length() == 0.0
    }
}

/// Reasons why a move could not be encoded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unsent {
    /// A point that the words cannot hold.
    #[error(transparent)]
    Point(#[from] Unsendable),
    /// Points in whole counts through which no move goes.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A setting of the drive.
    #[error("{0}")]
    Setting(String),
}

/// The words of a point, in hexadecimal digits.
fn hexadecimal(sent: SentPoint) -> String {
    match sent {
        SentPoint::MoveSegment(bytes) => bytes.map(|byte| format!("{byte:02X}")).join(" "),
        SentPoint::DataRecord(data) => {
            let time = data.time.map_or_else(String::new, |time| format!("{time:#04X}"));
            let velocity = data.velocity.map_or_else(String::new, |velocity| format!("{velocity:#010X}"));
            format!("{:#010X},{time},{velocity}", data.position)
        }
        SentPoint::Serial(Message::Write { parameter: TRAJECTORY_BUFFER, words }) => {
            let value = |k: usize| words.values().get(k).map_or_else(String::new, |value| format!("{value:#010X}"));
            format!("{:#06X},{},{}", words.word(), value(0), value(1))
        }
        SentPoint::Serial(_) => String::new(),
    }
}
