//! Path of a drive that follows points: a program whose moves begin when their points wait in the buffer of the drive.
use super::requests::of_moves;
use crate::program::Program;
use servobench_base::{Request, Stateful};

/// A program with moves that begin late.
#[derive(Debug, Stateful)]
pub(super) struct Tables {
    program: Program,
    #[state(constant)]
    moves: Vec<Later>,
    /// The move that began last, if any.
    now: Option<usize>,
}

/// A move of the program, begun late by the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Later {
    /// Start of the move in the drive (s), and its lag behind the program.
    begun: f64,
    lag: f64,
    /// End of the move in the program, and its target.
    end: f64,
    target: f64,
}

impl Tables {
    /// The moves of `program`, which the drive begins with `lags` (s).
    pub(super) fn of(program: &Program, lags: &[f64]) -> Self {
        let moves = program.plans().zip(lags).map(|((start, from, plan), lag)| Later {
            begun: start + lag,
            lag: *lag,
            end: start + plan.duration(),
            target: from + plan.end().x,
        });
        Self { program: program.clone(), moves: moves.collect(), now: None }
    }

    /// The request `passed` seconds after the start of the program, which must not decrease.
    pub(super) fn at(&mut self, passed: f64) -> Request {
        let next = self.now.map_or(0, |now| now + 1);
        if self.moves.get(next).is_some_and(|later| later.begun <= passed) {
            self.now = Some(next);
        }
        let Some(now) = self.now else { return Request::Stand };
        let Later { lag, end, target, .. } = self.moves[now];
        // The next move may have begun in the program, but not in the drive.
        if passed - lag >= end && now + 1 < self.moves.len() {
            return Request::Rest(target);
        }
        of_moves(&mut self.program, passed - lag)
    }
}
