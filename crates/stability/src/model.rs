//! Subject of the analysis: an axis, the drive that closes its loops, and the operating point.
use crate::StabilityError;
use servobench_base::{Coordinate, Divider, Dq, finite, positive};
use servobench_drive as drive;
use servobench_drive::current::Tuning;
use servobench_plant::{Body, Chain, LinearMechanics, pmsm};

/// Parts left out of the analysis, in a sentence.
pub const LEFT_OUT: &str = "the analysis is of the linear loop at standstill: dry friction, saturation (current, voltage, \
                            effort) and quantisation are not in it";

/// An axis with its drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    /// The drive: gains, rates and its estimate of the axis. Its limits and its feedforward are outside of the loop.
    pub drive: drive::Params,
    /// True if the drive closes a position loop.
    pub closes_position: bool,
    /// Cycle of the master that closes a position loop over a bus, in its place.
    pub master_cycle: Option<Divider>,
    /// Source of the drive's motor velocity.
    pub velocity_signal: VelocitySignal,
    /// Position that closes the position loop.
    pub position_feedback: PositionFeedback,
    /// Parameters from which the gains of the current loop follow, after which reports name them; `None` without one.
    pub current_tuning: Option<Tuning>,
    /// Conversion of the drive's command into effort.
    pub source: Source,
    /// Mechanics driven by the motor.
    pub mechanics: Mechanics,
    /// Current along the d axis at rest (A, peak).
    pub d_current: f64,
}

/// Mechanics driven by the motor.
#[derive(Debug, Clone, PartialEq)]
pub enum Mechanics {
    /// Bodies in a row.
    Bodies(Chain),
    /// A user's own model.
    Model {
        /// Coordinate of the motor.
        coordinate: Coordinate,
        /// Axis coordinate per motor coordinate.
        transmission: f64,
        /// The model around its rest.
        linear: LinearMechanics,
    },
}

impl From<Chain> for Mechanics {
    fn from(chain: Chain) -> Self {
        Self::Bodies(chain)
    }
}

impl Mechanics {
    /// Coordinate of the motor.
    #[must_use]
    pub fn coordinate(&self) -> Coordinate {
        match self {
            Self::Bodies(chain) => chain.bodies()[0].coordinate,
            Self::Model { coordinate, .. } => *coordinate,
        }
    }

    /// Axis coordinate per motor coordinate.
    #[must_use]
    pub fn transmission(&self) -> f64 {
        match self {
            Self::Bodies(chain) => chain.bodies()[0].transmission,
            Self::Model { transmission, .. } => *transmission,
        }
    }

    /// The inertia of all bodies in the motor's coordinate.
    pub(crate) fn inertia(&self) -> f64 {
        match self {
            Self::Bodies(chain) => {
                let of = |body: &Body| body.inertia * (self.transmission() / body.transmission).powi(2);
                chain.bodies().iter().map(of).sum()
            }
            Self::Model { linear, .. } => linear.inertia(),
        }
    }

    /// True without viscous friction that would end a motion.
    pub(crate) fn is_free(&self) -> bool {
        match self {
            Self::Bodies(chain) => chain.bodies().iter().all(|body| body.friction.linear() == 0.0),
            Self::Model { linear, .. } => linear.is_free(),
        }
    }

    /// Uncertainty of the numbers of a tick, relative to the largest one, besides their roundings.
    pub(crate) const fn uncertainty(&self) -> f64 {
        match self {
            Self::Bodies(_) => 0.0,
            Self::Model { linear, .. } => linear.uncertainty(),
        }
    }

    /// Shares of the squares of velocities in the kinetic energy, beginning with the motor; for a user's model only the motor's is known.
    pub(crate) fn energies(&self) -> Vec<f64> {
        match self {
            Self::Bodies(chain) => {
                chain.bodies().iter().map(|body| body.inertia / (body.transmission * body.transmission)).collect()
            }
            Self::Model { .. } => vec![1.0],
        }
    }
}

/// Source of the drive's motor velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VelocitySignal {
    /// Velocity of an ideal encoder.
    Encoder,
    /// Differences of positions over the period of the velocity loop.
    Differences,
}

/// Position that closes the position loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PositionFeedback {
    /// Position of the motor.
    Motor,
    /// Position of the load: the last body.
    Load,
}

/// Conversion of the drive's command into effort. It must match the kind of the drive's [`Stage`](drive::Stage).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// A synchronous motor on an inverter, under the drive's current loop.
    Pmsm(pmsm::Params),
    /// An ideal source: effort (N or N·m) per unit of output.
    Ideal {
        /// Effort per unit of output.
        gain: f64,
    },
}

impl Loop {
    /// # Errors
    /// [`StabilityError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), StabilityError> {
        self.drive.check()?;
        finite("current along the d axis at rest", self.d_current)?;
        match (&self.source, &self.drive.stage) {
            (Source::Pmsm(motor), drive::Stage::Current { .. }) => Ok(motor.check()?),
            (Source::Ideal { gain }, drive::Stage::Direct { .. }) => {
                Ok(positive("gain of the source", *gain).map(|_| ())?)
            }
            (Source::Pmsm(_), drive::Stage::Direct { .. }) | (Source::Ideal { .. }, drive::Stage::Current { .. }) => {
                Err(StabilityError::SourceDoesNotFit)
            }
        }
    }

    /// True if a position loop is closed, by the drive or by a master.
    pub(crate) fn has_position_loop(&self) -> bool {
        self.master_cycle.is_some() || (self.closes_position && self.drive.position_gain > 0.0)
    }

    /// True if all current gains, scaled by the same factor in both axes, are one number in the scenario.
    pub(crate) const fn has_bandwidth(&self) -> bool {
        !matches!(self.current_tuning, Some(Tuning::Gains(_)))
    }

    /// Effort of the source per effort requested by the drive, at rest.
    pub(crate) fn effort_ratio(&self) -> f64 {
        match (&self.source, &self.drive.stage) {
            (Source::Pmsm(motor), drive::Stage::Current { params, .. }) => {
                let ampere = Dq { d: self.d_current, q: 1.0 };
                motor.torque(ampere) / params.motor.effort_constant(params.d_reference)
            }
            (Source::Ideal { gain }, drive::Stage::Direct { gain: estimated }) => gain / estimated,
            _ => 1.0,
        }
    }
}
