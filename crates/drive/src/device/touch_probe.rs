//! Touch probe: latches the position at the edge of an input, or at the index pulse.
//!
//! The input is the home switch, sampled once per step: a position is late by at most a step. The index pulse has an exact position.
use super::Params;
use servobench_base::Stateful;
use servobench_cia402::touch_probe::{ENABLED, Edge, Function};

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub(super) struct State {
    function: u16,
    /// True if the input was active at the last step; `None` before the first one.
    was_active: Option<bool>,
    /// Positions of the edges (position units), in the count of that time.
    stored: [Option<i64>; Edge::ALL.len()],
}

/// Input of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input {
    /// Command of the master (60B8h).
    pub(super) function: u16,
    /// True if the input is active.
    pub(super) is_active: bool,
    /// Position (position units).
    pub(super) position: i64,
    /// Position of an index pulse since the last step.
    pub(super) index: Option<i64>,
}

impl State {
    pub(super) fn step(&mut self, input: &Input) {
        let (function, before) =
            (Function(input.function), Function(core::mem::replace(&mut self.function, input.function)));
        let was_active = self.was_active.replace(input.is_active).unwrap_or(input.is_active);
        if !function.is_on() || !before.is_on() {
            self.stored = [None; 2];
        }
        let edge = match (was_active, input.is_active) {
            (false, true) => Some(Edge::Positive),
            (true, false) => Some(Edge::Negative),
            _ => None,
        };
        if let Some(edge) = edge.filter(|_| function.is_of_input()) {
            self.latch(function, edge, input.position);
        }
        if let Some(position) = input.index.filter(|_| function.is_of_index_pulse()) {
            self.latch(function, Edge::Positive, position);
        }
    }

    fn latch(&mut self, function: Function, edge: Edge, position: i64) {
        let place = &mut self.stored[edge as usize];
        if function.latches(edge) && (function.is_continuous() || place.is_none()) {
            *place = Some(position);
        }
    }

    /// Status for the master (60B9h).
    pub(super) fn status(&self) -> u16 {
        let stored = |edge: &Edge| self.stored[*edge as usize].map_or(0, |_| edge.stored());
        let on = if Function(self.function).is_on() { ENABLED } else { 0 };
        Edge::ALL.iter().map(stored).fold(on, |status, bit| status | bit)
    }

    /// Positions for the master (60BAh, 60BBh), the lower 32 bits of a wider counter; 0 if nothing is stored.
    pub(super) fn positions(&self, p: &Params) -> [i32; 2] {
        self.stored.map(|position| position.map_or(0, |position| p.counter.words(p.shown(position))[0]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stored values after each step of (function, active, position, index).
    fn run(steps: &[(u16, bool, i64, Option<i64>)]) -> Vec<(u16, [Option<i64>; 2])> {
        let mut probe = State::default();
        let mut seen = Vec::new();
        for &(function, is_active, position, index) in steps {
            probe.step(&Input { function, is_active, position, index });
            seen.push((probe.status(), probe.stored));
        }
        seen
    }

    #[test]
    fn the_first_edge_is_kept_until_the_probe_is_switched_off() {
        let met = Function::first(Edge::Positive, false).0;
        let seen = run(&[
            (0, false, 0, None),
            (met, false, 1, None),
            (met, true, 2, None),
            (met, false, 3, None),
            (met, true, 4, None),
            (0, true, 5, None),
            (met, true, 6, None),
        ]);
        let stored: Vec<_> = seen.iter().map(|(_, stored)| stored[0]).collect();
        assert_eq!(stored, [None, None, Some(2), Some(2), Some(2), None, None]);
        let status: Vec<_> = seen.iter().map(|(status, _)| *status).collect();
        assert_eq!(status, [0, 1, 3, 3, 3, 0, 1]);
    }

    #[test]
    fn an_input_that_is_active_already_is_no_edge() {
        let met = Function::first(Edge::Positive, false).0;
        assert_eq!(run(&[(met, true, 7, None), (met, true, 8, None)])[1].1, [None; 2]);
    }

    #[test]
    fn continuous_both_edges_and_the_index_pulse() {
        let both = Function::first(Edge::Positive, false).0 | Edge::Negative.enabled() | 1 << 1;
        let seen = run(&[(both, false, 0, None), (both, true, 1, None), (both, false, 2, None), (both, true, 3, None)]);
        assert_eq!(seen[3], (0b111, [Some(3), Some(2)]));
        let index = Function::first(Edge::Positive, true).0;
        let seen = run(&[(index, false, 0, None), (index, true, 1, Some(-40)), (index, false, 2, Some(60))]);
        assert_eq!(seen[2], (0b11, [Some(-40), None]));
    }

    /// An unsupported source (bits 2 and 3) latches nothing.
    #[test]
    fn another_source_latches_nothing() {
        let other = Function::first(Edge::Positive, false).0 | 0b10 << 2;
        assert_eq!(run(&[(other, false, 0, None), (other, true, 1, Some(1))])[1], (1, [None; 2]));
    }
}
