//! Tables on their way, point by point.
//!
//! Points with times of their own are sent until the buffer is nearly full, and followed from then on, or when all are there; the
//! last one ends the move. By the serial interface the mode is set first (C8h), and op-code 17 starts the move.
//!
//! In the sub-modes without times nothing ends a move but bit 4: behind the table its last position is sent again and again, and
//! when the drive is on the way from one of them to the next, it is told to stop, and its buffer is emptied (2010h, 80h). In
//! sub-mode 0 the drive is told to go first, since it forgets the points that came before; then they come by the clock of the
//! master, one in each period (60C2h).
use super::points::{PointEncoding, PointTransfer, Unsendable};
use super::words::SentPoint;
use crate::{ProfileCommand, ProfileFeedback, TrajectoryPoint};
use alloc::vec::Vec;
use servobench_base::Stateful;
use servobench_cia402::interpolated::serial::Message;
use servobench_cia402::interpolated::{CAPACITY, Point, SegmentCommand};

/// Points that are in the buffer before they are followed, when there are so many.
const AHEAD: usize = 16;
/// For the rounding of times (s).
const ROUNDING: f64 = 1e-9;

/// How long the master's commands are under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// From one cycle of the motion task to the next (s).
    pub task: f64,
    /// From one cycle of the bus to the next (s).
    pub bus: f64,
    /// From a cycle of the bus until its frame is at the drive (s).
    pub frame: f64,
}

impl Timing {
    /// From a command to the cycle in which its answer is known (s). A step of the drive may have missed the frame that goes with it.
    fn answer(&self) -> f64 {
        2.0 * (self.frame + self.bus)
    }

    /// The first cycle of the task from `t` on (s).
    fn first_cycle(&self, t: f64) -> f64 {
        libm::ceil((t - ROUNDING) / self.task) * self.task
    }
}

/// Sends tables to the buffer of a drive, one after the other.
#[derive(Debug, Clone, Stateful)]
pub struct Stream {
    #[state(constant)]
    encoding: PointEncoding,
    /// When each begins (s), and its points.
    #[state(constant)]
    tables: Vec<(f64, Vec<Point>)>,
    table: usize,
    /// Points of all tables that were sent, as the drive numbers them.
    number: u16,
    /// Points of this table that have arrived, and the number that the drive told with them.
    arrived: i64,
    seen: u16,
    /// Points of this table that were sent, and last positions after it.
    sent: usize,
    /// When the next one is sent (s), where the master keeps the time.
    due: f64,
    stage: Stage,
    message: Option<Message>,
    /// In which of the last 64 cycles a point was sent; the last one is the lowest bit.
    recent: u64,
    #[state(constant)]
    timing: Timing,
}

/// How far a table is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
enum Stage {
    /// The serial interface is to be told the mode.
    Setting,
    /// Points are sent and wait.
    Filling,
    /// The drive is told to follow them.
    Following {
        /// Whether it was seen to.
        was_active: bool,
    },
    /// The buffer is being emptied.
    Emptying,
}

impl Stream {
    /// Tables, each by the time at which it begins (s) and its points, in this order.
    #[must_use]
    pub fn new(encoding: PointEncoding, tables: Vec<(f64, Vec<Point>)>, timing: Timing) -> Self {
        let is_serial = matches!(encoding.transfer(), PointTransfer::Serial);
        let stage = if is_serial { Stage::Setting } else { Stage::Filling };
        Self {
            encoding,
            tables,
            table: 0,
            number: 0,
            arrived: 0,
            seen: 0,
            sent: 0,
            due: 0.0,
            stage,
            message: None,
            recent: 0,
            timing,
        }
    }

    /// When the drive begins the way of each table (s, by the clock of the master, without the delay of its frame), if nothing goes wrong.
    ///
    /// Before that the buffer is filled, in some sub-modes the axis goes to the first point, and the table before has come to its end.
    #[must_use]
    pub fn beginnings(&self) -> Vec<f64> {
        let timing = &self.timing;
        let Timing { task, frame, .. } = *timing;
        let constant = self.constant_time();
        // The serial interface is told the mode before the first table, and the start behind each; no message waits for a frame.
        let (mut set, start_message) = if self.is_serial() { (task, task - frame) } else { (0.0, 0.0) };
        let mut free = f64::NEG_INFINITY;
        let begin = |(start, points): &(f64, Vec<Point>)| {
            let told = timing.first_cycle(*start).max(free) + core::mem::take(&mut set);
            let filled = (points.len().min(AHEAD) as f64 - 1.0) * task + start_message;
            let begin = told
                + match (self.encoding.adapted_time().is_some(), constant) {
                    // Three points, and the way to the first one.
                    (true, Some(time)) => 3.0 * time,
                    (_, Some(time)) => filled + time,
                    (_, None) => filled,
                };
            let length = points.iter().map(|point| f64::from(point.time) * 1e-6).sum::<f64>();
            let seen = timing.first_cycle(begin + length + timing.answer());
            // Where nothing ends a move the buffer is emptied.
            let is_free = if constant.is_some() { timing.first_cycle(seen + timing.answer()) } else { seen };
            free = is_free + task;
            begin
        };
        self.tables.iter().map(begin).collect()
    }

    /// The time of every segment where points have none of their own (s).
    fn constant_time(&self) -> Option<f64> {
        self.encoding.constant_time().map(|time| f64::from(time) * 1e-6)
    }

    /// Whether every point is there when the drive asks for it.
    ///
    /// # Errors
    /// [`Unsendable::Late`] names the first one that is not, because more points are under way than the buffer has room for, or because they
    /// follow each other faster than the master sends them.
    pub fn check(&self) -> Result<(), Unsendable> {
        let Some(point) = self.first_late(&self.timing) else { return Ok(()) };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cycles")]
        let delay = libm::round(self.timing.frame / self.timing.bus) as u32;
        let is_carried = |delay: &u32| {
            let timing = Timing { frame: f64::from(*delay) * self.timing.bus, ..self.timing };
            self.first_late(&timing).is_none()
        };
        Err(Unsendable::Late { point: point + 1, delay, longest: (0..delay).rev().find(is_carried) })
    }

    fn first_late(&self, timing: &Timing) -> Option<usize> {
        // Points that come by the clock of the master come in time.
        if self.encoding.adapted_time().is_some() {
            return None;
        }
        self.tables.iter().find_map(|(_, points)| self.first_late_of(points, timing))
    }

    /// The first of `points` that is sent too late.
    fn first_late_of(&self, points: &[Point], timing: &Timing) -> Option<usize> {
        let constant = self.constant_time();
        // When the drive takes the point behind that of this number, which it takes at `due`: as it begins the way between both.
        let after = |index: usize, due: f64| match (constant, index.checked_sub(1)) {
            (Some(time), _) => due + time,
            (None, Some(before)) => due + f64::from(points[before].time) * 1e-6,
            (None, None) => due,
        };
        // Cycles in which they are sent; how many have been taken by the last answer, and when the next one is.
        let mut sent: Vec<u32> = Vec::with_capacity(points.len());
        let (mut taken, mut due, mut begun) = (0, f64::INFINITY, None);
        let time_of = |cycle: u32| f64::from(cycle) * timing.task;
        for cycle in 0.. {
            let known = time_of(cycle) - timing.answer() + ROUNDING;
            while taken < sent.len() && due <= known {
                (due, taken) = (after(taken, due), taken + 1);
            }
            if sent.len() - taken < CAPACITY {
                sent.push(cycle);
            }
            if begun.is_none() && sent.len() >= AHEAD.min(points.len()) {
                due = time_of(cycle);
                begun = Some(due);
            }
            if sent.len() == points.len() {
                break;
            }
        }
        let mut due = begun?;
        sent.iter().enumerate().find_map(|(index, cycle)| {
            let is_late = time_of(*cycle) > due + ROUNDING;
            due = after(index, due);
            is_late.then_some(index)
        })
    }

    /// What goes over the serial interface in this cycle, once.
    pub const fn message(&mut self) -> Option<Message> {
        self.message.take()
    }

    /// The command of a cycle at `now` (s) to a drive that has answered `drive`.
    pub fn cycle(&mut self, now: f64, drive: &ProfileFeedback) -> ProfileCommand {
        self.recent <<= 1;
        let point = match self.tables.get(self.table) {
            Some((start, points)) if *start <= now => {
                let length = points.len();
                self.turn(now, drive, length)
            }
            _ => None,
        };
        let follow = matches!(self.stage, Stage::Following { .. }) && !self.is_serial();
        ProfileCommand::Points { point, follow }
    }

    /// A cycle of a table of so many points.
    fn turn(&mut self, now: f64, drive: &ProfileFeedback, length: usize) -> Option<TrajectoryPoint> {
        let is_endless = self.encoding.constant_time().is_some();
        match self.stage {
            Stage::Setting => {
                self.message = Some(Message::SELECT_PVT);
                self.stage = Stage::Filling;
                None
            }
            Stage::Filling => {
                if self.encoding.adapted_time().is_some() {
                    self.follow(now);
                    return None;
                }
                if self.is_serial() && self.is_ready(length) {
                    self.message = Some(Message::START_MOVE);
                    self.follow(now);
                    return None;
                }
                let point = self.next(now, drive);
                if !self.is_serial() && self.is_ready(length) {
                    self.follow(now);
                }
                point
            }
            Stage::Following { was_active } => {
                let is_passed = if is_endless { self.passed(drive) > length } else { was_active && !drive.is_active };
                if is_passed && self.sent >= length {
                    if is_endless {
                        self.stage = Stage::Emptying;
                        return SegmentCommand::Clear.encode().map(TrajectoryPoint::MoveSegment);
                    }
                    self.go_on();
                    return None;
                }
                self.stage = Stage::Following { was_active: was_active || drive.is_active };
                self.next(now, drive)
            }
            Stage::Emptying => {
                if !drive.is_active && usize::from(drive.buffer_free) == CAPACITY {
                    self.go_on();
                }
                None
            }
        }
    }

    /// Whether as many points of so many are sent as are to wait.
    const fn is_ready(&self, length: usize) -> bool {
        self.sent >= AHEAD || self.sent >= length
    }

    /// Has the drive follow the points from `now` on.
    const fn follow(&mut self, now: f64) {
        (self.stage, self.due) = (Stage::Following { was_active: false }, now);
    }

    /// To the next table.
    const fn go_on(&mut self) {
        self.table += 1;
        (self.sent, self.stage) = (0, Stage::Filling);
        (self.arrived, self.seen) = (0, self.number);
    }

    /// Points of this table that have left the buffer, by the answer of the drive. Where some were lost on their way, they have
    /// to come first.
    fn passed(&mut self, drive: &ProfileFeedback) -> usize {
        let number = told_number(drive);
        self.arrived += i64::from(number.wrapping_sub(self.seen).cast_signed());
        self.seen = number;
        let waiting = CAPACITY - usize::from(drive.buffer_free).min(CAPACITY);
        usize::try_from(self.arrived).unwrap_or(0).saturating_sub(waiting)
    }

    /// The next point, when it is time for it and the buffer has room.
    fn next(&mut self, now: f64, drive: &ProfileFeedback) -> Option<TrajectoryPoint> {
        let number = self.number;
        let (_, points) = self.tables.get(self.table)?;
        let point = match (points.get(self.sent), self.encoding.constant_time()) {
            (Some(point), _) => *point,
            (None, Some(_)) => *points.last()?,
            (None, None) => return None,
        };
        // What the drive has not told of is under way; or lost, where that is long ago.
        let under_way = u32::from(number.wrapping_sub(told_number(drive))).min(self.recent.count_ones());
        if u32::from(drive.buffer_free) <= under_way {
            return None;
        }
        if let Some(period) = self.encoding.adapted_time() {
            if now < self.due - ROUNDING {
                return None;
            }
            self.due += f64::from(period) * 1e-6;
        }
        self.number = number.wrapping_add(1);
        self.sent += 1;
        self.recent |= 1;
        match self.encoding.sent(point, number)? {
            SentPoint::MoveSegment(bytes) => Some(TrajectoryPoint::MoveSegment(bytes)),
            SentPoint::DataRecord(data) => Some(TrajectoryPoint::DataRecord(data)),
            SentPoint::Serial(message) => {
                self.message = Some(message);
                None
            }
        }
    }

    fn is_serial(&self) -> bool {
        self.encoding.transfer() == PointTransfer::Serial
    }
}

/// Points that have arrived at the drive by its answer, as it numbers them (2012h).
const fn told_number(drive: &ProfileFeedback) -> u16 {
    let [low, high, ..] = drive.buffer_status.to_le_bytes();
    u16::from_le_bytes([low, high])
}
