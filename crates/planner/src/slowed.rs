//! A trajectory in a longer time.
use servobench_motion::{Course, Piece};
use std::sync::Arc;

/// A trajectory followed more slowly: the k-th derivative is lower by `factor`^k.
#[derive(Clone)]
pub(crate) struct Slowed {
    pub(crate) course: Arc<dyn Course + Send + Sync>,
    pub(crate) factor: f64,
}

impl Course for Slowed {
    fn duration(&self) -> f64 {
        self.course.duration() * self.factor
    }

    fn piece(&self, t: f64) -> Piece {
        self.course.piece(t / self.factor).slowed(self.factor)
    }
}
