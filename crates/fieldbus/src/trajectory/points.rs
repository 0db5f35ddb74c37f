//! Conversion of a move to points in the units of a drive.
use alloc::vec::Vec;
use core::fmt;
use servobench_base::Setpoint;
use servobench_cia402::interpolated::{Point, SubMode, TimePeriod};
use servobench_config::Choice as _;
use thiserror::Error;

servobench_config::choices! {
    /// Transfer of the points of a table to the buffer of the drive.
    pub enum PointTransfer default MoveSegment {
        /// move segment command of the drive: eight bytes of a frame
        MoveSegment = "2010h",
        /// interpolation data record, in the drive's sub-mode (60C0h)
        DataRecord = "60C1h",
        /// parameter of the serial interface, with trajectory mode 3 (C8h) and the start by op-code 17
        Serial = "115h",
    }
}

/// Points that cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsendable {
    /// A point that does not fit the object.
    #[error(
        "point {point} of the table: {what} {value} cannot be sent in a point of the trajectory buffer ({}), which holds \
         {bound}; {help}",
        by.name()
    )]
    Point {
        /// Number of the point, from 1.
        point: usize,
        /// Name of the value.
        what: &'static str,
        /// The value.
        value: f64,
        /// Object or parameter of the transfer.
        by: PointTransfer,
        /// Bound of the value, in words.
        bound: &'static str,
        /// Remedy.
        help: Help,
    },
    /// A sub-mode with constant time, for points that have individual times.
    #[error(
        "points by {} carry their times: the interpolation sub-mode (60C0h) must be -2 or -3, got {code}: send the \
         points by 60C1h, or write another sub-mode",
        by.name()
    )]
    SubMode {
        /// Object or parameter of the transfer.
        by: PointTransfer,
        /// The sub-mode.
        code: i16,
    },
    /// A point that the master sends too late: earlier ones fill the buffer or are on their way, or the points are closer than its cycles.
    #[error(
        "point {point} of the table arrives after the drive needs it: with a delay of {delay} cycles the trajectory buffer runs \
         empty; {}",
        Longest(*longest)
    )]
    Late {
        /// Number of the point, from 1.
        point: usize,
        /// Cycles of the bus until a frame arrives.
        delay: u32,
        /// Longest delay without a late point; `None` if every delay makes one late.
        longest: Option<u32>,
    },
}

/// Longest permissible delay of the bus.
struct Longest(Option<u32>);

impl fmt::Display for Longest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(0) => f.write_str("without a delay it does not, or with points farther apart"),
            Some(longest) => write!(f, "up to {longest} it does not, or with points farther apart"),
            None => f.write_str("the points follow each other faster than the motion task sends them: choose points farther apart, or a shorter cycle"),
        }
    }
}

/// Remedy for points that cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Help {
    /// Times that fit the object.
    OtherTimes,
    /// A segment time equal to that of the points, or points with individual times.
    SegmentTime,
    /// A coarser unit of the drive.
    CoarserUnit,
    /// More points, or a coarser unit of the drive.
    MorePoints,
    /// A sub-mode with linear segments, or a table with velocities.
    LinearWays,
}

impl fmt::Display for Help {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OtherTimes => "choose other times",
            Self::SegmentTime => "write the time between the points to 60C2h, or -2 to 60C0h",
            Self::CoarserUnit => "choose a coarser unit",
            Self::MorePoints => "choose more points, or a coarser unit",
            Self::LinearWays => "write -2 to 60C0h, or give the table velocities",
        })
    }
}

/// Transfer of points, and the corresponding settings of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PointEncoding {
    transfer: PointTransfer,
    sub_mode: SubMode,
    period: TimePeriod,
}

impl PointEncoding {
    /// Encoding by `transfer` for a drive in `sub_mode` (60C0h), with `period` (60C2h).
    ///
    /// # Errors
    /// [`Unsendable::SubMode`] for points with individual times in a sub-mode with constant time.
    pub const fn new(transfer: PointTransfer, sub_mode: SubMode, period: TimePeriod) -> Result<Self, Unsendable> {
        if !matches!(transfer, PointTransfer::DataRecord) && sub_mode.has_constant_time() {
            return Err(Unsendable::SubMode { by: transfer, code: sub_mode.code() });
        }
        Ok(Self { transfer, sub_mode, period })
    }

    /// Object or parameter of the transfer.
    pub(super) const fn transfer(self) -> PointTransfer {
        self.transfer
    }

    /// Time of every segment if the points have no individual times (µs).
    pub(super) const fn constant_time(self) -> Option<u32> {
        if self.sub_mode.has_constant_time() { Some(self.period.microseconds()) } else { None }
    }

    /// Same time if the drive adapts it to the clock of the master, which therefore sends one point in each.
    pub(super) const fn adapted_time(self) -> Option<u32> {
        if matches!(self.sub_mode, SubMode::LinearAdapted) { Some(self.period.microseconds()) } else { None }
    }

    /// True if positions are sent as distances from the previous point.
    const fn is_relative(self) -> bool {
        !matches!(self.transfer, PointTransfer::DataRecord)
    }

    /// True if the point at the end of a line, or of a cubic, is sent without a velocity.
    const fn is_sent_as_line(self, is_line: bool) -> bool {
        match self.transfer {
            PointTransfer::DataRecord => !matches!(self.sub_mode, SubMode::Cubic),
            PointTransfer::MoveSegment | PointTransfer::Serial => is_line,
        }
    }
}

/// Largest velocity of 2010h in fine units; higher ones are sent in units a hundred times as coarse.
const FINE: f64 = 8_388_607.0;
const COARSE: f64 = 100.0;

/// A point of the table in counts, with only its position rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Exact {
    /// Time to the next point (s).
    time: f64,
    position: f64,
    /// Distance from the previous point.
    way: f64,
    /// Velocity (0.1 counts/s).
    velocity: f64,
    /// Velocity of the line that leads to the point; `None` if it is not a line.
    line: Option<f64>,
}

/// Points of a move that begins at `from` (m or rad): of its `polynomials`, each given by its length (s) and the set-point at its
/// beginning, and of the set-point at its `end`; positions of set-points count from `from`. `counts` is the number of counts in a metre or
/// radian.
///
/// # Errors
/// [`Unsendable::Point`] names the first point that cannot be sent, and the reason.
pub fn points(
    polynomials: impl IntoIterator<Item = (f64, Setpoint), IntoIter: Clone>,
    end: Setpoint,
    from: f64,
    counts: f64,
    encoding: PointEncoding,
) -> Result<Vec<Point>, Unsendable> {
    let tenths = |v: f64| 10.0 * v * counts;
    let polynomials = polynomials.into_iter();
    let line = |(_, state): (f64, Setpoint)| (state.a == 0.0 && state.j == 0.0).then(|| tenths(state.v));
    let lines = [None].into_iter().chain(polynomials.clone().map(line));
    let mut before = libm::round(from * counts);
    let points =
        polynomials.chain([(0.0, end)]).zip(lines).enumerate().map(|(index, ((time, Setpoint { x, v, .. }), line))| {
            let position = libm::round((from + x) * counts);
            let way = position - core::mem::replace(&mut before, position);
            point(index + 1, encoding, &Exact { time, position, way, velocity: tenths(v), line })
        });
    points.collect()
}

fn point(number: usize, encoding: PointEncoding, exact: &Exact) -> Result<Point, Unsendable> {
    let refuse = |what, value, bound, help| {
        Err(Unsendable::Point { point: number, what, value, by: encoding.transfer, bound, help })
    };
    let &Exact { time, position, way, velocity, line } = exact;
    let whole = libm::round(1e6 * time);
    if let Some(constant) = encoding.constant_time() {
        if time > 0.0 && (1e6 * time - f64::from(constant)).abs() > 1e-3 {
            return refuse("a time to the next of", time, "that of 60C2h only", Help::SegmentTime);
        }
    } else if (1e6 * time - whole).abs() > 1e-3 || whole % 1000.0 != 0.0 || !(0.0..=255_000.0).contains(&whole) {
        return refuse("a time to the next of", time, "whole milliseconds up to 255", Help::OtherTimes);
    }
    let is_relative = encoding.is_relative();
    let place = if is_relative { way } else { position };
    let bits_32 = f64::from(i32::MAX);
    let is_by_segment = encoding.transfer == PointTransfer::MoveSegment;
    let is_line = encoding.is_sent_as_line(line.is_some());
    if is_by_segment && !is_line && place.abs() > FINE {
        return refuse("a distance in counts of", place, "±8388607", Help::MorePoints);
    }
    if place.abs() > bits_32 {
        let what = if is_relative { "a distance in counts of" } else { "a position in counts of" };
        return refuse(what, place, "±2147483647", Help::CoarserUnit);
    }
    let sent = if is_line {
        None
    } else {
        let unit = if is_by_segment && velocity.abs() > FINE { COARSE } else { 1.0 };
        let sent = unit * libm::round(velocity / unit);
        let (most, bound) = if is_by_segment { (COARSE * FINE, "±838860700") } else { (bits_32, "±2147483647") };
        if sent.abs() > most {
            return refuse("a velocity in 0.1 counts/s of", sent, bound, Help::CoarserUnit);
        }
        // A cubic between the velocities of a line is that line, unless it ends with another one.
        if line.is_some_and(|line| (line - velocity).abs() > 1.0) {
            return refuse(
                "a jump of velocity in 0.1 counts/s to",
                sent,
                "no linear segments in sub-mode -3",
                Help::LinearWays,
            );
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
    use servobench_cia402::interpolated::SegmentCommand;

    const EXACT: Exact = Exact { time: 0.01, position: 7.0, way: 1.0, velocity: 0.0, line: None };

    fn by(transfer: PointTransfer, sub_mode: SubMode) -> PointEncoding {
        PointEncoding::new(transfer, sub_mode, TimePeriod::new(10, -3).unwrap()).unwrap()
    }

    fn segment() -> PointEncoding {
        by(PointTransfer::MoveSegment, SubMode::Cubic)
    }

    fn serial() -> PointEncoding {
        by(PointTransfer::Serial, SubMode::Cubic)
    }

    fn record(sub_mode: SubMode) -> PointEncoding {
        by(PointTransfer::DataRecord, sub_mode)
    }

    #[test]
    fn what_does_not_fit_is_named_with_its_bound() {
        let message = |encoding, exact| point(3, encoding, &exact).unwrap_err().to_string();
        let by_segment = |exact| message(segment(), exact);
        assert_eq!(
            by_segment(Exact { time: 0.0105, ..EXACT }),
            "point 3 of the table: a time to the next of 0.0105 cannot be sent in a point of the trajectory buffer (2010h), \
             which holds whole milliseconds up to 255; choose other times"
        );
        assert!(by_segment(Exact { way: 1e7, ..EXACT }).contains("±8388607"));
        assert!(by_segment(Exact { velocity: 1e9, ..EXACT }).contains("0.1 counts/s of 1000000000"));
        let coarse = point(1, segment(), &Exact { way: -5.0, velocity: 8_388_650.0, ..EXACT }).unwrap();
        let expected = Point { position: -5, is_relative: true, velocity: Some(8_388_700), time: 10_000 };
        assert_eq!(coarse, expected);
        assert!(SegmentCommand::Point { counter: 1, point: coarse }.encode().is_some());
        // A value too large for 24 bits may fit 32.
        let fine = point(1, serial(), &Exact { way: 1e7, velocity: 8_388_651.0, ..EXACT }).unwrap();
        assert_eq!((fine.position, fine.velocity), (10_000_000, Some(8_388_651)));
        assert!(message(serial(), Exact { way: 3e9, ..EXACT }).contains("(115h), which holds ±2147483647"));
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
        for encoding in [segment(), serial()] {
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
        for (_, transfer, _) in PointTransfer::ALL {
            for sub_mode in SubMode::ALL {
                let refused = *transfer != PointTransfer::DataRecord && sub_mode.has_constant_time();
                assert_eq!(
                    PointEncoding::new(*transfer, sub_mode, period).is_err(),
                    refused,
                    "{transfer:?} {sub_mode:?}"
                );
            }
        }
    }
}
