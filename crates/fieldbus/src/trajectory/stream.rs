//! Point-by-point transfer of tables.
//!
//! Points with individual times are sent until the buffer is nearly full, and followed from then on, or once all are there; the last one
//! ends the move. Over the serial interface the mode is set first (C8h), and op-code 17 starts the move.
//!
//! In the sub-modes with constant time a move is ended only by bit 4: after the table its last position is repeated, and once the drive
//! moves from one repetition to the next, bit 4 is cleared and the buffer emptied (2010h, 80h). In sub-mode 0 bit 4 is set first, since the
//! drive discards the points that came before; then they are sent by the clock of the master, one in each period (60C2h).
use super::points::{PointEncoding, PointTransfer, Unsendable};
use super::words::SentPoint;
use crate::{ProfileCommand, ProfileFeedback, TrajectoryPoint};
use alloc::vec::Vec;
use servobench_base::Stateful;
use servobench_cia402::interpolated::serial::Message;
use servobench_cia402::interpolated::{CAPACITY, Point, SegmentCommand};

/// Number of points in the buffer before they are followed, if the table has that many.
const AHEAD: usize = 16;
/// Tolerance of times for rounding (s).
const ROUNDING: f64 = 1e-9;

/// Delays of the master's commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Period of the motion task (s).
    pub task: f64,
    /// Period of the bus (s).
    pub bus: f64,
    /// Time from a cycle of the bus until its frame is at the drive (s).
    pub frame: f64,
}

impl Timing {
    /// Time from a command to the cycle in which its answer is known (s). A step of the drive may have missed the frame that goes with it.
    fn answer(&self) -> f64 {
        2.0 * (self.frame + self.bus)
    }

    /// First cycle of the task from `t` on (s).
    fn first_cycle(&self, t: f64) -> f64 {
        libm::ceil((t - ROUNDING) / self.task) * self.task
    }
}

/// Sends tables to the buffer of a drive, one after the other.
#[derive(Debug, Clone, Stateful)]
pub struct Stream {
    #[state(constant)]
    encoding: PointEncoding,
    /// Start time (s) and points of each table.
    #[state(constant)]
    tables: Vec<(f64, Vec<Point>)>,
    table: usize,
    /// Number of sent points of all tables, as counted by the drive.
    number: u16,
    /// Number of arrived points of this table, and the drive's number with them.
    arrived: i64,
    seen: u16,
    /// Number of sent points of this table, repetitions of the last one included.
    sent: usize,
    /// Time at which the next one is sent (s), if the master keeps the time.
    due: f64,
    stage: Stage,
    message: Option<Message>,
    /// Cycles, of the last 64, in which a point was sent; the last one is the lowest bit.
    recent: u64,
    #[state(constant)]
    timing: Timing,
}

/// Stage of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
enum Stage {
    /// The mode of the serial interface is to be set.
    Setting,
    /// Points are sent and wait.
    Filling,
    /// The drive is commanded to follow the points.
    Following {
        /// True if the drive has been seen following them.
        was_active: bool,
    },
    /// The buffer is being emptied.
    Emptying,
}

impl Stream {
    /// Stream of tables, each given by its start time (s) and its points, in this order.
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

    /// Start of each table's trajectory in the drive (s, by the clock of the master, without the delay of its frame), if there are no
    /// faults.
    ///
    /// Before that the buffer is filled, in some sub-modes the axis goes to the first point, and the previous table has ended.
    #[must_use]
    pub fn beginnings(&self) -> Vec<f64> {
        let timing = &self.timing;
        let Timing { task, frame, .. } = *timing;
        let constant = self.constant_time();
        // On the serial interface the mode comes before the first table, and the start after its points; messages do not wait for a frame.
        let (mut set, start_message) = if self.is_serial() { (task, task - frame) } else { (0.0, 0.0) };
        let mut free = f64::NEG_INFINITY;
        let begin = |(start, points): &(f64, Vec<Point>)| {
            let told = timing.first_cycle(*start).max(free) + core::mem::take(&mut set);
            let filled = (points.len().min(AHEAD) as f64 - 1.0) * task + start_message;
            let begin = told
                + match (self.encoding.adapted_time().is_some(), constant) {
                    // Three points, and the segment to the first one.
                    (true, Some(time)) => 3.0 * time,
                    (_, Some(time)) => filled + time,
                    (_, None) => filled,
                };
            let length = points.iter().map(|point| f64::from(point.time) * 1e-6).sum::<f64>();
            let seen = timing.first_cycle(begin + length + timing.answer());
            // Without an end in the table the buffer is emptied.
            let is_free = if constant.is_some() { timing.first_cycle(seen + timing.answer()) } else { seen };
            free = is_free + task;
            begin
        };
        self.tables.iter().map(begin).collect()
    }

    /// Time of every segment if points have no individual times (s).
    fn constant_time(&self) -> Option<f64> {
        self.encoding.constant_time().map(|time| f64::from(time) * 1e-6)
    }

    /// Checks that every point arrives before the drive needs it.
    ///
    /// # Errors
    /// [`Unsendable::Late`] names the first one that does not, because more points are on their way than the buffer has room for, or
    /// because they follow each other faster than the master sends them.
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
        // Points sent by the clock of the master come in time.
        if self.encoding.adapted_time().is_some() {
            return None;
        }
        self.tables.iter().find_map(|(_, points)| self.first_late_of(points, timing))
    }

    /// First of `points` that is sent too late.
    fn first_late_of(&self, points: &[Point], timing: &Timing) -> Option<usize> {
        let constant = self.constant_time();
        // Time at which the drive takes the point after number `index`, itself taken at `due`: when the segment between both begins.
        let after = |index: usize, due: f64| match (constant, index.checked_sub(1)) {
            (Some(time), _) => due + time,
            (None, Some(before)) => due + f64::from(points[before].time) * 1e-6,
            (None, None) => due,
        };
        // Cycles in which the points are sent; number of points taken by the last answer, and the time of the next one.
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

    /// Message for the serial interface in this cycle; returned once.
    pub const fn message(&mut self) -> Option<Message> {
        self.message.take()
    }

    /// Command of a cycle at `now` (s) to a drive that has answered `drive`.
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

    /// Executes a cycle of a table of `length` points.
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

    /// True if enough points have been sent to begin, of a table of `length`.
    const fn is_ready(&self, length: usize) -> bool {
        self.sent >= AHEAD || self.sent >= length
    }

    /// Makes the drive follow the points from `now` on.
    const fn follow(&mut self, now: f64) {
        (self.stage, self.due) = (Stage::Following { was_active: false }, now);
    }

    /// Advances to the next table.
    const fn go_on(&mut self) {
        self.table += 1;
        (self.sent, self.stage) = (0, Stage::Filling);
        (self.arrived, self.seen) = (0, self.number);
    }

    /// Points of this table that have left the buffer, by the answer of the drive. Lost ones have to arrive first.
    fn passed(&mut self, drive: &ProfileFeedback) -> usize {
        let number = told_number(drive);
        self.arrived += i64::from(number.wrapping_sub(self.seen).cast_signed());
        self.seen = number;
        let waiting = CAPACITY - usize::from(drive.buffer_free).min(CAPACITY);
        usize::try_from(self.arrived).unwrap_or(0).saturating_sub(waiting)
    }

    /// Next point, if it is due and the buffer has room.
    fn next(&mut self, now: f64, drive: &ProfileFeedback) -> Option<TrajectoryPoint> {
        let number = self.number;
        let (_, points) = self.tables.get(self.table)?;
        let point = match (points.get(self.sent), self.encoding.constant_time()) {
            (Some(point), _) => *point,
            (None, Some(_)) => *points.last()?,
            (None, None) => return None,
        };
        // Points that the drive has not reported are on their way; or lost, if that is long ago.
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

/// Number of points that have arrived at the drive by its answer, as counted by it (2012h).
const fn told_number(drive: &ProfileFeedback) -> u16 {
    let [low, high, ..] = drive.buffer_status.to_le_bytes();
    u16::from_le_bytes([low, high])
}
