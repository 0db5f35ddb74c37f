//! The sampled move of the fewest samples as a course.
use servobench_motion::sampled::Shortest;
use servobench_motion::{Course, Piece};

/// A move from rest to rest whose highest derivative may be another one at every sample.
#[derive(Debug, Clone)]
pub(crate) struct Fewest(pub(crate) Box<Shortest>);

impl Course for Fewest {
    fn duration(&self) -> f64 {
        self.0.duration()
    }

    fn piece(&self, t: f64) -> Piece {
        self.0.piece(t)
    }
}
