//! The points of a table as a master sends them to the buffer of a drive.
//!
//! | by | a point is | position | time to the next | velocity |
//! |---|---|---|---|---|
//! | 2010h | eight bytes in a frame | from the one before | of its own, ms | 0.1 or 10 counts/s, in 24 bits |
//! | 60C1h, sub-mode −3 | three sub-indices in a frame | absolute | of its own, ms | 0.1 counts/s |
//! | 60C1h, −2 | two of them | absolute | of its own, ms | – |
//! | 60C1h, −1 and 0 | one of them | absolute | 60C2h | – |
//! | 115h | a word and two values | from the one before | of its own, ms | 0.1 counts/s |
//!
//! 2010h and 115h leave the velocity out where the way to the point is a line; in the sub-modes without velocities every way is.
use servobench_base::Setpoint;
use servobench_drive::modes::interpolated::{Point, SubMode, TimePeriod};
use servobench_planner::{Plan, Span};
use servobench_scenario::{DriveUnits, TrajectoryBuffer};
use thiserror::Error;

/// Points that cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsendable {
    /// A point that the object does not hold.
    #[error(
        "point {point} of the table: {what} {value} cannot be sent in a point of the trajectory buffer ({by}), which holds \
         {bound}; {help}"
    )]
    Point {
        /// Number of the point, from 1.
        point: usize,
        /// Which of its values.
        what: &'static str,
        /// The value.
        value: f64,
        /// By which object or parameter.
        by: &'static str,
        /// What there is room for.
        bound: &'static str,
        /// What to do.
        help: &'static str,
    },
    /// A sub-mode in which points have no times of their own, for points that have.
    #[error(
        "points by {by} have times of their own: the interpolation sub-mode (60C0h) must be -2 or -3, got {code}: write \
         `trajectory_buffer = \"60C1h\"` in `[bus]`, or another sub-mode"
    )]
    SubMode {
        /// By which object or parameter.
        by: &'static str,
        /// The sub-mode.
        code: i16,
    },
}

/// How points get into the buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PointEncoding {
    /// The move segment command (2010h).
    MoveSegment,
    /// The interpolation data record (60C1h).
    DataRecord {
        /// 60C0h.
        sub_mode: SubMode,
        /// 60C2h.
        period: TimePeriod,
    },
    /// Parameter 115h of the serial interface.
    Serial,
}

impl PointEncoding {
    /// What `buffer` is of a drive in `sub_mode`.
    ///
    /// # Errors
    /// [`Unsendable::SubMode`] where the two do not go together.
    pub(super) const fn new(
        buffer: TrajectoryBuffer,
        sub_mode: SubMode,
        period: TimePeriod,
    ) -> Result<Self, Unsendable> {
        let encoding = match buffer {
            TrajectoryBuffer::DataRecord => return Ok(Self::DataRecord { sub_mode, period }),
            TrajectoryBuffer::MoveSegment => Self::MoveSegment,
            TrajectoryBuffer::Serial => Self::Serial,
        };
        if sub_mode.has_constant_time() {
            return Err(Unsendable::SubMode { by: encoding.name(), code: sub_mode.code() });
        }
        Ok(encoding)
    }

    const fn name(self) -> &'static str {
        match self {
            Self::MoveSegment => "2010h",
            Self::DataRecord { .. } => "60C1h",
            Self::Serial => "115h",
        }
    }

    /// Time of every segment where the points have none of their own (µs).
    pub(super) const fn constant_time(self) -> Option<u32> {
        match self {
            Self::DataRecord { sub_mode, period } if sub_mode.has_constant_time() => Some(period.microseconds()),
            _ => None,
        }
    }
}

/// Velocities of 2010h beyond it are sent in units a hundred times as coarse.
const FINE: f64 = 8_388_607.0;
const COARSE: f64 = 100.0;

/// A point of the table in counts, not rounded but for its position.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Exact {
    /// Time to the next point (s).
    time: f64,
    position: f64,
    /// From the point before.
    way: f64,
    /// Velocity (0.1 counts/s).
    velocity: f64,
    /// Velocity of the line that leads there; `None` where that is no line.
    line: Option<f64>,
}

/// The points of `plan`, which begins at `from` (m or rad).
pub(super) fn points(
    plan: &Plan,
    from: f64,
    units: DriveUnits,
    encoding: PointEncoding,
) -> Result<Vec<Point>, Unsendable> {
    let count = f64::from(units.drive) / units.axis;
    let tenths = |v: f64| 10.0 * v * count;
    let spans: Vec<Span> = plan.spans().collect();
    let lines = spans.iter().map(|Span { state, .. }| (state.a == 0.0 && state.j == 0.0).then(|| tenths(state.v)));
    let times = spans.iter().map(|span| span.length).chain([0.0]);
    let states = spans.iter().map(|span| span.state).chain([plan.end()]);
    let mut before = libm::round(from * count);
    let points =
        times.zip(states).zip([None].into_iter().chain(lines)).enumerate().map(|(index, ((time, state), line))| {
            let Setpoint { x, v, .. } = state;
            let position = libm::round((from + x) * count);
            let way = position - core::mem::replace(&mut before, position);
            point(index + 1, encoding, &Exact { time, position, way, velocity: tenths(v), line })
        });
    points.collect()
}

fn point(number: usize, encoding: PointEncoding, exact: &Exact) -> Result<Point, Unsendable> {
    let refuse = |what, value, bound, help| {
        Err(Unsendable::Point { point: number, what, value, by: encoding.name(), bound, help })
    };
    let &Exact { time, position, way, velocity, line } = exact;
    let whole = libm::round(1e6 * time);
    if let Some(constant) = encoding.constant_time() {
        if time > 0.0 && (1e6 * time - f64::from(constant)).abs() > 1e-3 {
            let help = "write the time between the points to 60C2h, or -2 to 60C0h";
            return refuse("a time to the next of", time, "that of 60C2h only", help);
        }
    } else if (1e6 * time - whole).abs() > 1e-3 || whole % 1000.0 != 0.0 || !(0.0..=255_000.0).contains(&whole) {
        return refuse("a time to the next of", time, "whole milliseconds up to 255", "choose other times");
    }
    let coarser = "choose a coarser unit (`bus.units`)";
    let is_relative = !matches!(encoding, PointEncoding::DataRecord { .. });
    let place = if is_relative { way } else { position };
    let bits_32 = f64::from(i32::MAX);
    let is_line = match encoding {
        PointEncoding::DataRecord { sub_mode: SubMode::Cubic, .. } => false,
        PointEncoding::DataRecord { .. } => true,
        PointEncoding::MoveSegment | PointEncoding::Serial => line.is_some(),
    };
    if encoding == PointEncoding::MoveSegment && !is_line && place.abs() > FINE {
        return refuse("a way in counts of", place, "±8388607", "choose a coarser unit (`bus.units`), or more points");
    }
    if place.abs() > bits_32 {
        let what = if is_relative { "a way in counts of" } else { "a position in counts of" };
        return refuse(what, place, "±2147483647", coarser);
    }
    let sent = if is_line {
        None
    } else {
        let unit = if encoding == PointEncoding::MoveSegment && velocity.abs() > FINE { COARSE } else { 1.0 };
        let sent = unit * libm::round(velocity / unit);
        let (most, bound) = if encoding == PointEncoding::MoveSegment {
            (COARSE * FINE, "±838860700")
        } else {
            (bits_32, "±2147483647")
        };
        if sent.abs() > most {
            return refuse("a velocity in 0.1 counts/s of", sent, bound, coarser);
        }
        // A cubic between the velocities of a line is that line, unless it ends with another one.
        if line.is_some_and(|line| (line - velocity).abs() > 1.0) {
            let help = "write -2 to 60C0h, or give the table velocities";
            return refuse("a jump of velocity in 0.1 counts/s to", sent, "no linear ways in sub-mode -3", help);
        }
        Some(sent)
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within bounds")]
    let (position, velocity, time) = (place as i32, sent.map(|sent| sent as i32), whole as u32);
    Ok(Point { position, is_relative, velocity, time })
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_drive::modes::interpolated::SegmentCommand;

    const EXACT: Exact = Exact { time: 0.01, position: 7.0, way: 1.0, velocity: 0.0, line: None };

    fn record(sub_mode: SubMode) -> PointEncoding {
        PointEncoding::DataRecord { sub_mode, period: TimePeriod::new(10, -3).unwrap() }
    }

    #[test]
    fn what_does_not_fit_is_named_with_its_bound() {
        let message = |encoding, exact| point(3, encoding, &exact).unwrap_err().to_string();
        let by_segment = |exact| message(PointEncoding::MoveSegment, exact);
        assert_eq!(
            by_segment(Exact { time: 0.0105, ..EXACT }),
            "point 3 of the table: a time to the next of 0.0105 cannot be sent in a point of the trajectory buffer (2010h), \
             which holds whole milliseconds up to 255; choose other times"
        );
        assert!(by_segment(Exact { way: 1e7, ..EXACT }).contains("±8388607"));
        assert!(by_segment(Exact { velocity: 1e9, ..EXACT }).contains("0.1 counts/s of 1000000000"));
        let coarse =
            point(1, PointEncoding::MoveSegment, &Exact { way: -5.0, velocity: 8_388_650.0, ..EXACT }).unwrap();
        let expected = Point { position: -5, is_relative: true, velocity: Some(8_388_700), time: 10_000 };
        assert_eq!(coarse, expected);
        assert!(SegmentCommand::Point { counter: 1, point: coarse }.encode().is_some());
        // What 24 bits do not hold, 32 do.
        let fine = point(1, PointEncoding::Serial, &Exact { way: 1e7, velocity: 8_388_651.0, ..EXACT }).unwrap();
        assert_eq!((fine.position, fine.velocity), (10_000_000, Some(8_388_651)));
        assert!(
            message(PointEncoding::Serial, Exact { way: 3e9, ..EXACT }).contains("(115h), which holds ±2147483647")
        );
        assert!(
            message(record(SubMode::LinearTimed), Exact { position: 3e9, ..EXACT }).contains("a position in counts")
        );
        for sub_mode in [SubMode::LinearAdapted, SubMode::Linear] {
            let said = message(record(sub_mode), Exact { time: 0.012, ..EXACT });
            assert!(said.contains("a time to the next of 0.012") && said.contains("60C2h"), "{said}");
        }
        let jump = Exact { velocity: 0.0, line: Some(100.0), ..EXACT };
        assert!(message(record(SubMode::Cubic), jump).contains("sub-mode -3"));
        assert!(point(1, record(SubMode::Cubic), &Exact { line: Some(0.5), ..EXACT }).is_ok());
    }

    #[test]
    fn lines_have_no_velocity_where_the_object_can_say_so() {
        let line = Exact { line: Some(100.0), ..EXACT };
        for encoding in [PointEncoding::MoveSegment, PointEncoding::Serial] {
            assert_eq!(point(2, encoding, &line).unwrap().velocity, None);
            assert_eq!(point(2, encoding, &EXACT).unwrap().velocity, Some(0));
        }
        for sub_mode in [SubMode::LinearAdapted, SubMode::Linear, SubMode::LinearTimed] {
            let sent = point(2, record(sub_mode), &EXACT).unwrap();
            assert_eq!(sent, Point { position: 7, is_relative: false, velocity: None, time: 10_000 });
        }
    }

    #[test]
    fn sub_modes_without_times_of_their_own_are_for_the_data_record() {
        let period = TimePeriod::new(1, -3).unwrap();
        for buffer in [TrajectoryBuffer::MoveSegment, TrajectoryBuffer::Serial, TrajectoryBuffer::DataRecord] {
            for sub_mode in SubMode::ALL {
                let refused = buffer != TrajectoryBuffer::DataRecord && sub_mode.has_constant_time();
                assert_eq!(PointEncoding::new(buffer, sub_mode, period).is_err(), refused, "{buffer:?} {sub_mode:?}");
            }
        }
    }
}
