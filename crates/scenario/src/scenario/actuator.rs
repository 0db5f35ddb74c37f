//! The actuator: motor or source, power stage and drive of the axis.
use super::drive::Drive;
use servobench_drive::Stage;
use servobench_plant::{Encoder, IdealSource, Wiring, inverter, pmsm};

/// Motor or source of the axis with its drive.
#[derive(Debug, Clone, PartialEq)]
pub enum Actuator {
    /// The motor side follows the set-point exactly.
    Prescribed,
    /// The power stage is off: no current; the axis is free except for effects of its motor that need no current.
    Off(Option<Box<IdleMotor>>),
    /// A permanent-magnet synchronous motor on an inverter.
    Pmsm {
        /// The motor.
        motor: pmsm::Params,
        /// Effects of the motor beyond its equations.
        effects: Box<pmsm::Effects>,
        /// Connection of the motor to the inverter.
        wiring: Wiring,
        /// Encoder on the motor.
        encoder: Encoder,
        /// DC-link voltage of the inverter (V).
        dc_link: f64,
        /// Deviations of the inverter from an ideal voltage source; `None` for an ideal one.
        inverter: Option<inverter::Params>,
        /// DC link of the inverter; `None`: a constant voltage.
        link: Option<inverter::LinkParams>,
        /// The drive.
        drive: Drive,
    },
    /// An ideal source of force or torque.
    IdealSource {
        /// The source.
        source: IdealSource,
        /// Encoder on the motor.
        encoder: Encoder,
        /// The drive.
        drive: Drive,
    },
}

/// A motor without current whose teeth or iron still act on the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct IdleMotor {
    /// The motor.
    pub motor: pmsm::Params,
    /// Effects of the motor beyond its equations.
    pub effects: pmsm::Effects,
}

impl Actuator {
    /// The drive, if there is one.
    #[must_use]
    pub const fn drive(&self) -> Option<&Drive> {
        match self {
            Self::Prescribed | Self::Off(_) => None,
            Self::Pmsm { drive, .. } | Self::IdealSource { drive, .. } => Some(drive),
        }
    }

    /// The encoder on the motor, if a drive reads one.
    #[must_use]
    pub const fn encoder(&self) -> Option<Encoder> {
        match self {
            Self::Prescribed | Self::Off(_) => None,
            Self::Pmsm { encoder, .. } | Self::IdealSource { encoder, .. } => Some(*encoder),
        }
    }

    /// Largest effort reference (N·m or N): the drive's effort limit, reduced to the effort at its current limit.
    #[must_use]
    pub fn max_effort(&self) -> f64 {
        self.drive().map_or(f64::INFINITY, |drive| drive.params.max_effort())
    }

    /// Largest effort known to the drive (N·m or N): its limit, at most an ideal source's output. It corresponds to 1000 in CiA 402's
    /// torque objects; `None` where nothing has a limit.
    #[must_use]
    pub fn rated_effort(&self) -> Option<f64> {
        let rated = match self {
            Self::IdealSource { source, drive, .. } => match drive.params.stage {
                Stage::Direct { gain } => self.max_effort().min(gain * source.limit),
                Stage::Current { .. } => self.max_effort(),
            },
            Self::Prescribed | Self::Off(_) | Self::Pmsm { .. } => self.max_effort(),
        };
        rated.is_finite().then_some(rated)
    }
}
