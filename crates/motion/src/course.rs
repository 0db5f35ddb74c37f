//! Common interface of all generators.
use crate::online::Transition;
use crate::{Piece, Profile, Trajectory};
use servobench_base::Setpoint;

/// A set-point over time from any planner: consecutive polynomials, in the axis unit (m or rad) and seconds from
/// its start.
pub trait Course {
    /// Duration (s).
    fn duration(&self) -> f64;

    /// The polynomial at `t` (s): that of the start before it, that of the end from there on.
    fn piece(&self, t: f64) -> Piece;

    /// The set-point at `t` (s).
    fn at(&self, t: f64) -> Setpoint {
        self.piece(t).at(t)
    }

    /// The state at the end, which continues at its velocity.
    fn end(&self) -> Setpoint {
        self.at(self.duration())
    }
}

impl Course for Profile {
    fn duration(&self) -> f64 {
        Self::duration(self)
    }

    fn piece(&self, t: f64) -> Piece {
        Self::piece(self, t)
    }
}

impl Course for Transition {
    fn duration(&self) -> f64 {
        Self::duration(self)
    }

    fn piece(&self, t: f64) -> Piece {
        Self::piece(self, t)
    }
}

impl<const N: usize> Course for Trajectory<N> {
    fn duration(&self) -> f64 {
        Self::duration(self)
    }

    fn piece(&self, t: f64) -> Piece {
        Self::piece(self, t)
    }
}

#[cfg(feature = "std")]
impl Course for crate::sampled::Shortest {
    fn duration(&self) -> f64 {
        Self::duration(self)
    }

    fn piece(&self, t: f64) -> Piece {
        Self::piece(self, t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, Order, PlanError};

    /// Oracle: the set-point computed separately at every instant.
    #[test]
    fn a_course_is_walked_piece_by_piece() -> Result<(), PlanError> {
        let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
        let profile = Profile::plan(Order::Fourth, 1.0, &limits)?;
        let course: &dyn Course = &profile;
        let (mut t, mut pieces) = (0.0, 0);
        while t < course.duration() {
            let piece = course.piece(t);
            let ends = piece.ends().max(t.next_up());
            for part in 0..10 {
                let t = t + (ends.min(course.duration()) - t) * f64::from(part) / 10.0;
                assert!(piece.holds(t), "{t}");
                assert_eq!(piece.at(t), course.at(t), "{t}");
            }
            (t, pieces) = (ends, pieces + 1);
        }
        // The cruise is cut in its middle, from which on the move is counted from its end.
        assert_eq!(pieces, 16);
        assert_eq!(course.end(), Setpoint::at_rest(1.0));
        Ok(())
    }
}
