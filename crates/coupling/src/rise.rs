//! Levels that rise from window to window without interruption.

/// Fewest windows in a row; two rises among noise of one level are one in six, so the required growth has to do the rest.
const WINDOWS: u32 = 3;

/// State of a rise.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Rise {
    first: f64,
    last: f64,
    windows: u32,
}

/// Effect of a window on a rise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Risen {
    /// End of a rise: a new one can begin with this window.
    Anew,
    /// Continuation of the rise.
    On,
    /// Continuation of the rise, long enough to judge it by its growth.
    For {
        /// Ratio of the last level to the first.
        growth: f64,
        /// Number of windows in the rise.
        windows: u32,
    },
}

impl Rise {
    /// Adds the level of a window; it counts if it `qualifies`.
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
