//! Requests of the motion task, delayed by the path to the loops.
//!
//! A program of moves is known beforehand and is evaluated at every tick. Function blocks give one request per cycle; a path
//! between two cycles is the quintic polynomial through both, and before the second one is there the first one continues.
use super::reference::between;
use super::tables::Tables;
use super::targets::Targets;
use crate::program::Program;
use servobench_base::{Request, RequestKind, Setpoint, Stateful};
use servobench_motion::interpolate::Interval;
use std::collections::VecDeque;

/// Cycles without a request after which a motion task counts as requesting nothing.
const MISSED: f64 = 3.0;
/// Rounding of differences of times (s).
const ROUNDING: f64 = 5e-10;

/// Requests on their way to the loops.
#[derive(Debug, Stateful)]
#[state(fixed)]
pub(super) enum Requests {
    /// Requests of a program that began at some time (s), `delay` seconds later.
    Program {
        course: Course,
        #[state(constant)]
        period: f64,
        #[state(constant)]
        delay: f64,
        running: Option<Running>,
    },
    /// Requests of function blocks.
    Cycles(Box<Cycles>),
}

/// Path requested by a program.
#[derive(Debug, Stateful)]
#[state(fixed)]
pub(super) enum Course {
    /// Path of its moves.
    Moves(Box<Program>),
    /// Path of a drive that gets targets.
    Targets(#[state(constant)] Targets),
    /// Path of a drive that follows points.
    Tables(Box<Tables>),
}

/// A running program.
#[derive(Debug, Clone, Copy, Stateful)]
pub(super) struct Running {
    /// Start (s) derived from its last cycle: later if its task was held up.
    begun: f64,
    /// Time of its last cycle (s).
    last: f64,
}

/// One request per cycle.
#[derive(Debug, Stateful)]
pub(super) struct Cycles {
    /// Time from one cycle to the next (s).
    #[state(constant)]
    period: f64,
    /// Delay of the loops (s).
    #[state(constant)]
    delay: f64,
    /// Requests with their times (s), the oldest first.
    kept: VecDeque<(f64, Request)>,
    /// Interval between the first two of them, if both are paths.
    interval: Option<Interval>,
}

impl Requests {
    /// Requests of `program`, whose task has cycles of `period` (s), and which reach the loops `delay` (s) later.
    pub(super) fn of_program(program: &Program, period: f64, delay: f64) -> Self {
        Self::Program { course: Course::Moves(Box::new(program.clone())), period, delay, running: None }
    }

    /// Requests of a program whose drive gets `targets`.
    pub(super) const fn of_targets(targets: Targets, period: f64, delay: f64) -> Self {
        Self::Program { course: Course::Targets(targets), period, delay, running: None }
    }

    /// Requests of a program whose drive follows `tables`.
    pub(super) fn of_tables(tables: Tables, period: f64, delay: f64) -> Self {
        Self::Program { course: Course::Tables(Box::new(tables)), period, delay, running: None }
    }

    /// Requests of a motion task with cycles of `period` (s), which reach the loops `delay` (s) later.
    pub(super) fn of_cycles(period: f64, delay: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cycles")]
        let room = (delay / period) as usize + 4;
        let kept = VecDeque::with_capacity(room);
        Self::Cycles(Box::new(Cycles { period, delay, kept, interval: None }))
    }

    /// Notes a cycle of the program at `t` (s), `passed` seconds after its start.
    pub(super) fn goes_on(&mut self, t: f64, passed: f64) {
        if let Self::Program { running, .. } = self {
            *running = Some(Running { begun: t - passed, last: t });
        }
    }

    /// Adds the request of the cycle at `t` (s).
    pub(super) fn push(&mut self, t: f64, request: Request) {
        if let Self::Cycles(cycles) = self {
            cycles.kept.push_back((t, request));
        }
    }

    /// The request at `t` (s), which must not decrease.
    pub(super) fn at(&mut self, t: f64) -> Request {
        match self {
            Self::Program { course, period, delay, running } => {
                let Some(Running { begun, last }) = running else { return Request::Nothing };
                let passed = t - *begun - *delay;
                if t - *delay - *last > MISSED * *period {
                    return Request::Nothing;
                }
                if passed < -ROUNDING {
                    return Request::Stand;
                }
                let passed = passed.max(0.0);
                match course {
                    Course::Moves(program) => of_moves(program, passed),
                    Course::Targets(targets) => targets.at(passed),
                    Course::Tables(tables) => tables.at(passed),
                }
            }
            Self::Cycles(cycles) => cycles.at(t),
        }
    }
}

/// The request of a program `passed` seconds after its start.
pub(super) fn of_moves(program: &mut Program, passed: f64) -> Request {
    let setpoint = program.at(passed);
    match program.request_at(passed, setpoint) {
        (_, RequestKind::Nothing | RequestKind::Effort) => Request::Nothing,
        (_, RequestKind::Stand) => Request::Stand,
        (setpoint, RequestKind::Rest) => Request::Rest(setpoint.x),
        (setpoint, RequestKind::Follow) => Request::Follow(setpoint),
        (setpoint, RequestKind::Velocity) => Request::Velocity(setpoint.v),
    }
}

impl Cycles {
    fn at(&mut self, t: f64) -> Request {
        let wanted = t - self.delay;
        while self.kept.get(1).is_some_and(|(next, _)| wanted - next >= -ROUNDING) {
            self.kept.pop_front();
            self.interval = None;
        }
        let Some((begin, from)) = self.kept.front() else { return Request::Nothing };
        let since = wanted - begin;
        if since < -ROUNDING || since > MISSED * self.period {
            return Request::Nothing;
        }
        let Request::Follow(setpoint) = from else { return *from };
        let end = self.kept.get(1).and_then(|(end, to)| Some((end - begin, path(to)?)));
        let Some((length, to)) = end else { return Request::Follow(setpoint.after(since.max(0.0))) };
        let interval = match &self.interval {
            Some(interval) => Some(interval),
            None => between(length, setpoint, &to).map(|found| &*self.interval.insert(found)),
        };
        let fraction = (since / length).clamp(0.0, 1.0);
        let at = interval.and_then(|interval| interval.at(fraction).ok());
        Request::Follow(at.map_or(*setpoint, |command| command.setpoint))
    }
}

/// The set-point of a path at a request; `None` if the request is not a path.
const fn path(request: &Request) -> Option<Setpoint> {
    match request {
        Request::Follow(setpoint) => Some(*setpoint),
        Request::Rest(x) => Some(Setpoint::at_rest(*x)),
        Request::Nothing | Request::Stand | Request::Velocity(_) | Request::Effort(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a quintic itself, which is the path through two requests, at the delayed time.
    #[test]
    fn a_path_between_two_cycles_is_the_quintic_through_both() {
        let at = |t: f64| Setpoint { x: t.powi(5), v: 5.0 * t.powi(4), a: 20.0 * t.powi(3), ..Setpoint::default() };
        let (period, delay) = (4e-3, 5.125e-3);
        let mut requests = Requests::of_cycles(period, delay);
        assert_eq!(requests.at(0.0), Request::Nothing);
        for tick in 0..4_000_u32 {
            let t = f64::from(tick) / 16e3;
            if tick % 64 == 0 {
                requests.push(t, Request::Follow(at(t)));
            }
            match requests.at(t) {
                Request::Follow(found) => assert!((found.x - at(t - delay).x).abs() < 1e-14, "{t}: {found:?}"),
                other => assert!(other == Request::Nothing && t < delay, "{t}: {other:?}"),
            }
        }
    }

    #[test]
    fn what_has_no_path_holds_for_its_cycle_and_silence_is_no_request() {
        let (period, delay) = (1e-3, 2e-3);
        let mut requests = Requests::of_cycles(period, delay);
        requests.push(0.0, Request::Stand);
        requests.push(period, Request::Velocity(3.0));
        requests.push(2.0 * period, Request::Effort(-1.0));
        for (t, expected) in [
            (2e-3, Request::Stand),
            (2.9e-3, Request::Stand),
            (3e-3, Request::Velocity(3.0)),
            (4.5e-3, Request::Effort(-1.0)),
            (6.9e-3, Request::Effort(-1.0)),
            (7.1e-3, Request::Nothing),
        ] {
            assert_eq!(requests.at(t), expected, "{t}");
        }
    }
}
