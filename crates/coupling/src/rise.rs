//! Levels that rise from window to window without a break.

/// Fewest windows in a row; two rises among noise of one level are one in six, so the growth asked for has to do the rest.
const WINDOWS: u32 = 3;

/// A rise as far as it has come.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rise {
    first: f64,
    last: f64,
    windows: u32,
}

/// What a window did to a rise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Risen {
    /// It ended one: a rise can begin with it.
    Anew,
    /// It went on.
    On,
    /// It went on, long enough to tell: the level now is so many times the first.
    For {
        /// Last level by the first.
        growth: f64,
        /// How many windows it has gone on.
        windows: u32,
    },
}

impl Rise {
    /// The level of a window; it counts if it `qualifies`.
    pub(crate) fn push(&mut self, level: f64, qualifies: bool) -> Risen {
        let on = qualifies && self.windows > 0 && level > self.last;
        self.last = level;
        if !on {
            self.first = level;
            self.windows = u32::from(qualifies && level > 0.0);
            return Risen::Anew;
        }
        self.windows += 1;
        let growth = level / self.first;
        if self.windows < WINDOWS { Risen::On } else { Risen::For { growth, windows: self.windows } }
    }
}
