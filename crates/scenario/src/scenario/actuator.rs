//! What moves the axis: the part of the plant that a drive commands, and the drive that goes with it.
use super::drive::Drive;
use servobench_drive::Stage;
use servobench_plant::{Encoder, IdealSource, Wiring, inverter, pmsm};

/// What moves the axis, and what commands that.
#[derive(Debug, Clone, PartialEq)]
pub enum Actuator {
    /// The motor side follows the set-point exactly.
    Prescribed,
    /// The power stage is off: no current, and the axis is free but for what acts on the rotor of its motor without one.
    Off(Option<Box<IdleMotor>>),
    /// A permanent-magnet synchronous motor on an inverter.
    Pmsm {
        /// The motor.
        motor: pmsm::Params,
        /// What it does beside its equations.
        effects: Box<pmsm::Effects>,
        /// How it is connected to the inverter.
        wiring: Wiring,
        /// Encoder on the motor.
        encoder: Encoder,
        /// DC-link voltage of the inverter (V).
        dc_link: f64,
        /// What the inverter does beside giving the voltage that it is asked for; `None`: nothing.
        inverter: Option<inverter::Params>,
        /// Its DC link; `None`: a constant voltage.
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

/// A motor without current whose teeth or iron act on the axis all the same.
#[derive(Debug, Clone, PartialEq)]
pub struct IdleMotor {
    /// The motor.
    pub motor: pmsm::Params,
    /// What it does beside its equations.
    pub effects: pmsm::Effects,
}

impl Actuator {
    /// The drive, where there is one.
    #[must_use]
    pub const fn drive(&self) -> Option<&Drive> {
        match self {
            Self::Prescribed | Self::Off(_) => None,
            Self::Pmsm { drive, .. } | Self::IdealSource { drive, .. } => Some(drive),
        }
    }

    /// The encoder on the motor, where a drive reads one.
    #[must_use]
    pub const fn encoder(&self) -> Option<Encoder> {
        match self {
            Self::Prescribed | Self::Off(_) => None,
            Self::Pmsm { encoder, .. } | Self::IdealSource { encoder, .. } => Some(*encoder),
        }
    }

    /// Largest effort reference (N·m or N): the drive's effort limit, or what its current limit leaves of it.
    #[must_use]
    pub fn max_effort(&self) -> f64 {
        self.drive().map_or(f64::INFINITY, |drive| drive.params.max_effort())
    }

    /// Largest effort that the drive knows of (N·m or N): its limit, or what an ideal source's output leaves of it. A
    /// thousand of CiA 402's torque objects stand for it; there is none where nothing has a limit.
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
