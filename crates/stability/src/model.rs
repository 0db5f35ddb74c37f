//! What is analysed: an axis, the drive that closes its loops, and where it is operated.
use crate::StabilityError;
use servobench_base::{Coordinate, Divider, Dq, finite, positive};
use servobench_drive as drive;
use servobench_drive::current::Tuning;
use servobench_plant::{Body, Chain, LinearMechanics, pmsm};

/// What the analysis leaves out, in a sentence.
pub const LEFT_OUT: &str = "the analysis is of the linear loop at standstill: dry friction, saturation (current, voltage, \
                            effort) and quantisation are not in it";

/// An axis with its drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Loop {
    /// The drive: gains, rates and what it believes of the axis. Its limits and its feedforward are outside of the loop.
    pub drive: drive::Params,
    /// Whether the drive closes a position loop.
    pub closes_position: bool,
    /// Cycle of the master that closes a position loop over a bus, in its place.
    pub master_cycle: Option<Divider>,
    /// Where the drive has the motor's velocity from.
    pub velocity_signal: VelocitySignal,
    /// Which position closes the position loop.
    pub position_feedback: PositionFeedback,
    /// What the gains of the current loop follow from, which is how reports call them; `None` without one.
    pub current_tuning: Option<Tuning>,
    /// What turns the drive's command into effort.
    pub source: Source,
    /// What the motor moves.
    pub mechanics: Mechanics,
    /// Current along the d axis at rest (A, peak).
    pub d_current: f64,
}

/// What the motor moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Mechanics {
    /// Bodies in a row.
    Bodies(Chain),
    /// A user's own model.
    Model {
        /// How the motor moves.
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
    /// How the motor moves.
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

    /// True where no viscous friction ends a motion.
    pub(crate) fn is_free(&self) -> bool {
        match self {
            Self::Bodies(chain) => chain.bodies().iter().all(|body| body.friction.linear() == 0.0),
            Self::Model { linear, .. } => linear.is_free(),
        }
    }

    /// How far off numbers of a tick can be, as a share of the largest one, beside their roundings.
    pub(crate) const fn uncertainty(&self) -> f64 {
        match self {
            Self::Bodies(_) => 0.0,
            Self::Model { linear, .. } => linear.uncertainty(),
        }
    }

    /// Shares of the squares of velocities in the kinetic energy, from the motor's on; of a model the motor's alone is known.
    pub(crate) fn energies(&self) -> Vec<f64> {
        match self {
            Self::Bodies(chain) => {
                chain.bodies().iter().map(|body| body.inertia / (body.transmission * body.transmission)).collect()
            }
            Self::Model { .. } => vec![1.0],
        }
    }
}

/// Where the drive has the motor's velocity from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VelocitySignal {
    /// An ideal encoder gives it.
    Encoder,
    /// Differences of positions over the period of the velocity loop.
    Differences,
}

/// Which position closes the position loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PositionFeedback {
    /// The motor's.
    Motor,
    /// The load's: the last body.
    Load,
}

/// What turns the drive's command into effort. It must be the kind of the drive's [`Stage`](drive::Stage).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// A synchronous motor on an inverter, under the drive's current loop.
    Pmsm(pmsm::Params),
    /// An ideal source: so much effort (N or N·m) per unit of output.
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

    /// Whether a position loop is closed, by the drive or by a master.
    pub(crate) fn has_position_loop(&self) -> bool {
        self.master_cycle.is_some() || (self.closes_position && self.drive.position_gain > 0.0)
    }

    /// Whether all current gains, those of both axes by the same factor, are one number in the scenario.
    pub(crate) const fn has_bandwidth(&self) -> bool {
        !matches!(self.current_tuning, Some(Tuning::Gains(_)))
    }

    /// Effort that the source gives per effort that the drive asks for, at rest.
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
