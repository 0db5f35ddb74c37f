//! What the inputs of a run were, by change: by determinism it is the whole state of a run.
//!
//! A saved state shares the part that it has in common with the run, so that saving at every step costs a constant time.
use crate::interface::INPUTS;
use std::sync::Arc;

/// An input has another value from a tick on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Change {
    pub(crate) tick: u64,
    pub(crate) input: u8,
    pub(crate) value: f64,
}

/// Changes up to the present.
#[derive(Debug, Default)]
pub(crate) struct History {
    older: Option<Arc<Chapter>>,
    recent: Vec<Change>,
    /// Values in force.
    last: [f64; INPUTS],
}

/// Changes up to a saved state.
#[derive(Debug, Clone, Default)]
pub(crate) struct Past {
    chapter: Option<Arc<Chapter>>,
    last: [f64; INPUTS],
}

#[derive(Debug)]
struct Chapter {
    older: Option<Arc<Self>>,
    changes: Vec<Change>,
}

impl History {
    /// Notes the inputs of tick `tick`. All are zero before the first.
    pub(crate) fn note(&mut self, tick: u64, inputs: &[f64; INPUTS]) {
        for (input, (last, value)) in (0..).zip(self.last.iter_mut().zip(inputs)) {
            if last.to_bits() != value.to_bits() {
                *last = *value;
                self.recent.push(Change { tick, input, value: *value });
            }
        }
    }

    /// What has been up to now.
    pub(crate) fn past(&mut self) -> Past {
        if !self.recent.is_empty() {
            let changes = std::mem::take(&mut self.recent);
            self.older = Some(Arc::new(Chapter { older: self.older.take(), changes }));
        }
        Past { chapter: self.older.clone(), last: self.last }
    }

    /// Goes on from `past`.
    pub(crate) fn after(past: &Past) -> Self {
        Self { older: past.chapter.clone(), recent: Vec::new(), last: past.last }
    }
}

impl Past {
    /// All changes in the order of time.
    pub(crate) fn changes(&self) -> Vec<Change> {
        let chapters = std::iter::successors(self.chapter.as_deref(), |chapter| chapter.older.as_deref());
        let mut all: Vec<&[Change]> = chapters.map(|chapter| &chapter.changes[..]).collect();
        all.reverse();
        all.concat()
    }
}

/// One after the other: a long chain would overflow the stack.
impl Drop for Chapter {
    fn drop(&mut self) {
        let mut next = self.older.take();
        while let Some(mut chapter) = next.and_then(Arc::into_inner) {
            next = chapter.older.take();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(first: f64) -> [f64; INPUTS] {
        let mut all = [0.0; INPUTS];
        all[0] = first;
        all
    }

    #[test]
    fn two_runs_from_one_past_do_not_see_each_other() {
        let mut run = History::default();
        run.note(0, &inputs(1.0));
        run.note(1, &inputs(1.0));
        let past = run.past();
        run.note(2, &inputs(2.0));
        let mut other = History::after(&past);
        other.note(2, &inputs(1.0));
        other.note(5, &inputs(-0.0));
        let change = |tick, value| Change { tick, input: 0, value };
        assert_eq!(past.changes(), [change(0, 1.0)]);
        assert_eq!(run.past().changes(), [change(0, 1.0), change(2, 2.0)]);
        assert_eq!(other.past().changes(), [change(0, 1.0), change(5, -0.0)], "by bits: -0 is another value than 1");
    }

    #[test]
    fn a_million_saved_states_are_dropped() {
        let mut run = History::default();
        for tick in 0..1_000_000_u32 {
            run.note(tick.into(), &inputs(f64::from(tick)));
            run.past();
        }
        assert_eq!(run.past().changes().len(), 999_999, "0 is no change");
    }
}
