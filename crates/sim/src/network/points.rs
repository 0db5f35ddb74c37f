//! The points of a table as a master sends them to the buffer of a drive (2010h).
use servobench_base::Setpoint;
use servobench_drive::modes::interpolated::{Point, SegmentCommand};
use servobench_planner::Plan;
use servobench_scenario::DriveUnits;
use thiserror::Error;

/// A point that the object does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "point {point} of the table: {what} {value} cannot be sent in a point of the trajectory buffer (2010h), which holds {bound}; {way_out}"
)]
pub struct Unsendable {
    /// Number of the point, from 1.
    pub point: usize,
    /// Which of its values.
    pub what: &'static str,
    /// The value.
    pub value: f64,
    /// What there is room for.
    pub bound: &'static str,
    /// What to do.
    pub way_out: &'static str,
}

/// Points that stay free in the buffer: those under way between a frame and the answer that knows of it.
const RESERVE: u16 = 6;
/// Velocities beyond it are sent in units a hundred times as coarse.
const FINE: f64 = 8_388_607.0;
const COARSE: f64 = 100.0;

/// The points of a table, each with the way from the one before.
#[derive(Debug, Clone)]
pub(super) struct Points {
    points: Vec<Point>,
    sent: usize,
}

impl Points {
    /// The points of `plan`, which begins at `from` (m or rad).
    pub(super) fn of(plan: &Plan, from: f64, units: DriveUnits) -> Result<Self, Unsendable> {
        let count = f64::from(units.drive) / units.axis;
        let spans: Vec<_> = plan.spans().collect();
        let times = spans.iter().map(|span| span.length).chain([0.0]);
        let states = spans.iter().map(|span| span.state).chain([plan.end()]);
        let mut before = libm::round(from * count);
        let points = times.zip(states).enumerate().map(|(index, (time, state))| {
            let Setpoint { x, v, .. } = state;
            let position = libm::round((from + x) * count);
            let way = position - before;
            before = position;
            point(index + 1, time, way, 10.0 * v * count)
        });
        Ok(Self { points: points.collect::<Result<_, _>>()?, sent: 0 })
    }

    /// The next point, when the buffer has room for it.
    pub(super) fn next(&mut self, free: u16) -> Option<SegmentCommand> {
        if free <= RESERVE {
            return None;
        }
        let point = *self.points.get(self.sent)?;
        #[expect(clippy::cast_possible_truncation, reason = "below 8")]
        let counter = (self.sent % 8) as u8;
        self.sent += 1;
        Some(SegmentCommand::Point { counter, point })
    }

    /// How many were sent.
    pub(super) const fn sent(&self) -> usize {
        self.sent
    }

    /// Whether all were sent.
    pub(super) fn is_over(&self) -> bool {
        self.sent == self.points.len()
    }
}

/// A point so long (s) before the next, so far (counts) behind the last, at a velocity (0.1 counts/s).
fn point(number: usize, time: f64, way: f64, velocity: f64) -> Result<Point, Unsendable> {
    let milliseconds = libm::round(1000.0 * time);
    let refuse = |what, value, bound, way_out| Err(Unsendable { point: number, what, value, bound, way_out });
    if (1000.0 * time - milliseconds).abs() > 1e-6 || !(0.0..=255.0).contains(&milliseconds) {
        return refuse("a time to the next of", time, "whole milliseconds up to 255", "choose other times");
    }
    if way.abs() > FINE {
        return refuse("a way in counts of", way, "±8388607", "choose a coarser unit (`bus.units`), or more points");
    }
    let unit = if velocity.abs() > FINE { COARSE } else { 1.0 };
    let velocity = unit * libm::round(velocity / unit);
    if velocity.abs() > COARSE * FINE {
        return refuse("a velocity in 0.1 counts/s of", velocity, "±838860700", "choose a coarser unit (`bus.units`)");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within bounds")]
    let (way, velocity, time) = (way as i32, velocity as i32, milliseconds as u32 * 1000);
    Ok(Point { position: way, is_relative: true, velocity: Some(velocity), time })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_named_with_its_bound() {
        let message = |time, way, velocity| point(3, time, way, velocity).unwrap_err().to_string();
        assert!(message(0.0105, 1.0, 0.0).starts_with("point 3 of the table: a time to the next of 0.0105 cannot"));
        assert!(message(0.01, 1e7, 0.0).contains("±8388607"));
        assert!(message(0.01, 1.0, 1e9).contains("0.1 counts/s"));
        let coarse = point(1, 0.01, -5.0, 8_388_650.0).unwrap();
        assert_eq!(coarse, Point { position: -5, is_relative: true, velocity: Some(8_388_700), time: 10_000 });
        assert!(SegmentCommand::Point { counter: 1, point: coarse }.encode().is_some());
    }
}
