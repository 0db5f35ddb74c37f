//! The parts of a plan in order of time, as many as a person reads.
use super::times::Times;
use super::{NAMES, PlannedMove, derivatives, without_dust};
use servobench_base::Setpoint;
use servobench_motion::Segment;
use servobench_motion::position_profile::Command;
use servobench_planner::{Generator, PlanDetails, Span};
use std::collections::VecDeque;

/// Width of `125.663706 ms`.
const TIME: usize = 13;
const QUANTITY: usize = 16;
/// Most rows; of more, the first and the last are shown.
const MOST: usize = 40;
const FIRST: usize = 12;
const LAST: usize = 4;

/// Times of one row, and its derivatives of position.
#[derive(Debug, Clone, Copy)]
struct Row {
    start: f64,
    length: Option<f64>,
    quantities: [Option<(usize, f64)>; 3],
}

impl Row {
    const fn point(t: f64, quantities: [Option<(usize, f64)>; 3]) -> Self {
        Self { start: t, length: None, quantities }
    }

    const fn segment(start: f64, length: f64, k: usize, value: f64) -> Self {
        Self { start, length: Some(length), quantities: [Some((k, value)), None, None] }
    }

    /// True if `other` has the same quantities except for rounding.
    fn is_as(&self, other: &Self) -> bool {
        let mut both = self.quantities.iter().flatten().zip(other.quantities.iter().flatten());
        both.all(|((_, one), (_, other))| (one - other).abs() <= 1e-9 * one.abs())
    }
}

/// Consecutive rows with the same quantities, joined into one.
fn joined(mut rows: impl Iterator<Item = Row>) -> impl Iterator<Item = Row> {
    let mut next = rows.next();
    std::iter::from_fn(move || {
        let mut row = next.take()?;
        for following in rows.by_ref() {
            if !row.is_as(&following) {
                next = Some(following);
                break;
            }
            row.length = row.length.zip(following.length).map(|(one, other)| one + other);
        }
        Some(row)
    })
}

impl PlannedMove {
    /// The segments, points or commands: heading and rows. None for a plan whose set-points are held: they are samples.
    pub(super) fn rows(&self) -> Vec<String> {
        let n = self.plan.order();
        if let PlanDetails::Commands { commands, .. } = self.plan.details() {
            let start = commands.first().map_or(0.0, |command| command.t);
            let row = |Command { t, velocity, acceleration }: &Command| {
                Row::point(t - start, [Some((1, *velocity)), Some((2, *acceleration)), None])
            };
            return self.listed("sent at", commands.iter().map(row), "commands");
        }
        if self.plan.held().is_some() {
            return Vec::new();
        }
        if matches!(self.request.generator, Generator::Table(_)) {
            // Where velocity jumps, there is no acceleration to list.
            let has_acceleration = n > 1;
            let row = |t: f64, Setpoint { x, v, a, .. }: Setpoint| {
                Row::point(t, [Some((0, x)), Some((1, v)), has_acceleration.then_some((2, a))])
            };
            let end = row(self.plan.duration(), self.plan.end());
            let rows = self.plan.spans().map(|span| row(span.start, span.state)).chain([end]);
            return self.listed("time", rows, "points");
        }
        self.listed("start", self.segment_rows(), "segments")
    }

    /// The segments, one for each interval of constant highest derivative.
    fn segment_rows(&self) -> Box<dyn Iterator<Item = Row> + '_> {
        let n = self.plan.order();
        if let Some(profile) = self.profile() {
            let row = move |segment: Segment| Row::segment(segment.start, segment.length, n, segment.value);
            return Box::new(joined(profile.segments().map(row)));
        }
        let row = move |span: Span| Row::segment(span.start, span.length, n, derivatives(&span.state)[n]);
        Box::new(joined(self.plan.spans().map(row)))
    }

    /// Ends of the rows (s), for a table its points; none for a plan whose set-points are held.
    pub(super) fn boundaries(&self) -> Vec<f64> {
        if self.plan.held().is_some() {
            return Vec::new();
        }
        if matches!(self.request.generator, Generator::Table(_)) {
            return self.plan.spans().map(|span| span.start + span.length).collect();
        }
        self.segment_rows().map(|row| row.start + row.length.unwrap_or_default()).collect()
    }

    /// Rows below their headings; of very many only the first and the last.
    fn listed(&self, start: &str, rows: impl Iterator<Item = Row>, name: &str) -> Vec<String> {
        let mut rows = rows.enumerate();
        let mut first: Vec<(usize, Row)> = rows.by_ref().take(MOST).collect();
        let mut last = VecDeque::new();
        for row in rows {
            last.push_back(row);
            if last.len() > LAST {
                last.pop_front();
            }
        }
        let count = last.back().map_or(first.len(), |(i, _)| i + 1);
        if count > MOST {
            // Some of those between the first and the last are still among the first.
            first.extend(last);
            first.retain(|(i, _)| *i < FIRST || i + LAST >= count);
        }
        self.written(start, &first, (count - first.len(), name))
    }

    /// `rows` as text, and a line that counts the `left_out` of that name.
    fn written(&self, start: &str, rows: &[(usize, Row)], (left_out, name): (usize, &str)) -> Vec<String> {
        let Some((_, Row { length, quantities, .. })) = rows.first() else { return Vec::new() };
        let all = rows.iter().flat_map(|(_, row)| [Some(row.start), row.length]).flatten();
        let times = Times::new(self.plan.duration(), all);
        // A single quantity is aligned left in its column, as nothing follows.
        let is_single = quantities[1].is_none();
        let column = |text: &str| if is_single { format!("  {text}") } else { format!(" {text:>QUANTITY$}") };
        let names = quantities.iter().flatten().map(|(k, _)| column(NAMES[*k]));
        let length = length.map(|_| format!(" {:>TIME$}", "length"));
        let mut lines = vec![[format!("{start:>TIME$}")].into_iter().chain(length).chain(names).collect::<String>()];
        let largest: [f64; 3] = std::array::from_fn(|i| {
            rows.iter()
                .filter_map(|(_, row)| row.quantities[i])
                .fold(0.0, |largest, (_, value)| value.abs().max(largest))
        });
        let mut before = 0;
        for (i, Row { start, length, quantities }) in rows {
            if i - before > 1 {
                lines.push(format!("{:>TIME$} {left_out} {name} more", "…"));
            }
            before = *i;
            let length = length.map(|length| format!(" {:>TIME$}", times.show(length)));
            let quantities = quantities.iter().zip(largest).filter_map(|(quantity, largest)| {
                quantity.map(|(k, value)| column(&self.show(k, without_dust(value, largest))))
            });
            let start = format!("{:>TIME$}", times.show(*start));
            lines.push([start].into_iter().chain(length).chain(quantities).collect());
        }
        lines
    }
}
