//! The remainder of a trajectory from a time on.
use servobench_motion::{Course, Piece};
use std::sync::Arc;

/// A trajectory from `start` (s) on: its times and positions count from there.
#[derive(Clone)]
pub(crate) struct Rest {
    course: Arc<dyn Course + Send + Sync>,
    start: f64,
    /// Position at the start.
    origin: f64,
}

impl Rest {
    pub(crate) fn of(course: Arc<dyn Course + Send + Sync>, start: f64) -> Self {
        Self { origin: course.at(start).x, course, start }
    }
}

impl Course for Rest {
    fn duration(&self) -> f64 {
        (self.course.duration() - self.start).max(0.0)
    }

    fn piece(&self, t: f64) -> Piece {
        self.course.piece(self.start + t.max(0.0)).seen_from(self.start, self.origin)
    }
}
