//! What is analysed: an axis, the drive that closes its loops, and where it is operated.
use crate::StabilityError;
use servobench_base::{Divider, Dq, finite, positive};
use servobench_drive as drive;
use servobench_drive::current::Tuning;
use servobench_plant::{Chain, pmsm};

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
    /// The bodies.
    pub mechanics: Chain,
    /// Current along the d axis at rest (A, peak).
    pub d_current: f64,
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

    /// The inertia of all bodies in the motor's coordinate.
    pub(crate) fn inertia(&self) -> f64 {
        let bodies = self.mechanics.bodies();
        let motor = bodies[0].transmission;
        bodies.iter().map(|body| body.inertia * (motor / body.transmission).powi(2)).sum()
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
