//! The start of a move.
use crate::request::{Generator, PointToPoint, Replanning, Request, Rockwell};
use crate::table::{Follow, TableMove};
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Target};
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::{Jerk, Shape};
use servobench_motion::{Limits, PlanError, rockwell};

/// Origin of the positions of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Positioning {
    /// The zero of the axis.
    Absolute,
    /// The position of the axis at the start of the move.
    Relative,
}

/// Distance of the first point (m or rad) up to which it counts as the position of the axis: sums of targets are rounded.
const NEAR: f64 = 1e-9;

impl Request {
    /// The request for the same move from the state `start`, whose position becomes the zero of the plan.
    ///
    /// # Errors
    /// [`PlanError::Point`] for a table whose first point is elsewhere.
    pub fn begun_in(&self, start: &Setpoint, positioning: Positioning) -> Result<Self, PlanError> {
        let origin = match positioning {
            Positioning::Absolute => start.x,
            Positioning::Relative => 0.0,
        };
        let generator = match &self.generator {
            Generator::PointToPoint(asked) => {
                Generator::PointToPoint(PointToPoint { distance: asked.distance - origin, ..*asked })
            }
            Generator::Replanning(asked) => Generator::Replanning(Replanning {
                from: Setpoint { x: 0.0, s: 0.0, ..*start },
                target: match asked.target {
                    Target::Position { x, v } => Target::Position { x: x - origin, v },
                    velocity @ Target::Velocity(_) => velocity,
                },
                ..*asked
            }),
            Generator::Rockwell(asked) => {
                let operands = rockwell::Move { distance: asked.operands.distance - origin, ..asked.operands };
                Generator::Rockwell(Rockwell { operands, ..*asked })
            }
            Generator::Table(asked) => Generator::Table(asked.begun_at(origin, positioning)?),
        };
        Ok(Self { generator, filter: self.filter.clone(), ..*self })
    }
}

impl TableMove {
    /// The same move from time 0 and position 0, if its first point is at `origin`.
    fn begun_at(&self, origin: f64, positioning: Positioning) -> Result<Self, PlanError> {
        let first = self.knots.first().copied().unwrap_or_default();
        if (first.x - origin).abs() > NEAR {
            return Err(PlanError::Point {
                point: 0,
                name: "position",
                value: first.x,
                bound: match positioning {
                    Positioning::Relative => "0 in a relative table",
                    Positioning::Absolute => "where the axis is when the move starts",
                },
                remedy: "begin the table there, or move to its first point before",
            });
        }
        let knots = self.knots.iter().map(|knot| Knot { t: knot.t - first.t, x: knot.x - first.x, v: knot.v });
        Ok(Self { knots: knots.collect(), ..*self })
    }
}

impl Generator {
    /// Distance of the target from the zero of its positions, if the move has such a target.
    #[must_use]
    pub const fn distance(&self) -> Option<f64> {
        match self {
            Self::PointToPoint(asked) => Some(asked.distance),
            Self::Replanning(Replanning { target: Target::Position { x, .. }, .. }) => Some(*x),
            Self::Rockwell(asked) => Some(asked.operands.distance),
            Self::Replanning(_) | Self::Table(_) => None,
        }
    }

    /// True if the axis still moves at the end.
    #[must_use]
    pub fn ends_in_motion(&self) -> bool {
        match self {
            Self::Replanning(Replanning { target: Target::Position { v, .. } | Target::Velocity(v), .. }) => *v != 0.0,
            Self::PointToPoint(_) | Self::Rockwell(_) => false,
            Self::Table(table) => table.ends().1 != 0.0,
        }
    }

    /// Order of the profile, 2, 3 or 4: the highest derivative without impulses, for a table the highest possible.
    #[must_use]
    pub const fn order(&self) -> usize {
        match self {
            Self::PointToPoint(asked) => asked.order.derivative(),
            Self::Replanning(asked) => asked.order.derivative(),
            Self::Rockwell(_) | Self::Table(TableMove { follow: Follow::Segments, .. }) => 3,
            Self::Table(_) => 2,
        }
    }

    /// Limits of |velocity|, |acceleration|, |jerk|, |snap|, the upper ones if the lower differ; infinite without a limit.
    #[must_use]
    pub const fn limits(&self) -> [f64; 4] {
        match *self {
            Self::PointToPoint(PointToPoint { limits: Limits { velocity, acceleration, jerk, snap }, .. }) => {
                [velocity, acceleration, jerk, snap]
            }
            Self::Replanning(Replanning {
                limits: DirectionalLimits { velocity, acceleration, jerk, snap }, ..
            }) => [velocity.above, acceleration.above, jerk, snap],
            Self::Rockwell(Rockwell { operands: rockwell::Move { speed, acceleration, shape, .. }, .. }) => {
                let jerk = match shape {
                    Shape::SCurve { acceleration: Jerk::Value(jerk), .. } => jerk,
                    Shape::SCurve { .. } | Shape::Trapezoid => f64::INFINITY,
                };
                [speed, acceleration, jerk, f64::INFINITY]
            }
            Self::Table(_) => [f64::INFINITY; 4],
        }
    }
}
