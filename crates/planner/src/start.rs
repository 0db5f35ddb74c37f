//! Where and how a move begins.
use crate::request::{Generator, PointToPoint, Replanning, Request, Rockwell};
use crate::table::{Follow, TableMove};
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Target};
use servobench_motion::pvt::Knot;
use servobench_motion::rockwell::{Jerk, Shape};
use servobench_motion::{Limits, PlanError, rockwell};

/// What the positions of a request count from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Positioning {
    /// The zero of the axis.
    Absolute,
    /// Where the axis is when the move begins.
    Relative,
}

/// A first point that is nearer (m or rad) is where the axis is: sums of targets are rounded.
const NEAR: f64 = 1e-9;

impl Request {
    /// The request of the same move that begins in the state `start`, whose position is the zero of the plan.
    ///
    /// # Errors
    /// [`PlanError::Point`] of a table whose first point is elsewhere.
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
    /// The same from time 0 and position 0, if its first point is at `origin`.
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
    /// How far the move goes from the zero of its positions, if that is asked for.
    #[must_use]
    pub const fn distance(&self) -> Option<f64> {
        match self {
            Self::PointToPoint(asked) => Some(asked.distance),
            Self::Replanning(Replanning { target: Target::Position { x, .. }, .. }) => Some(*x),
            Self::Rockwell(asked) => Some(asked.operands.distance),
            Self::Replanning(_) | Self::Table(_) => None,
        }
    }

    /// Whether the axis still moves at the end.
    #[must_use]
    pub fn ends_in_motion(&self) -> bool {
        match self {
            Self::Replanning(Replanning { target: Target::Position { v, .. } | Target::Velocity(v), .. }) => *v != 0.0,
            Self::PointToPoint(_) | Self::Rockwell(_) => false,
            Self::Table(table) => table.ends().1 != 0.0,
        }
    }

    /// Order of the profile, 2, 3 or 4: the highest derivative that is no impulse, of a table the highest that it can be.
    #[must_use]
    pub const fn order(&self) -> usize {
        match self {
            Self::PointToPoint(asked) => asked.order.derivative(),
            Self::Replanning(asked) => asked.order.derivative(),
            Self::Rockwell(_) | Self::Table(TableMove { follow: Follow::Segments, .. }) => 3,
            Self::Table(_) => 2,
        }
    }

    /// Limits of |velocity|, |acceleration|, |jerk|, |snap|, above zero where those below are others; infinite where there is none.
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
