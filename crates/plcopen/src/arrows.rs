//! Arrows of the state diagram (PLCopen part 1, version 2.0, figure 2.1): the one table on which the axis runs, which the tests
//! cover and from which `docs/plcopen.md` is generated.
//!
//! The standard numbers only its six notes; arrows 1 to 6 are these. Arrows 14 and 15 are additions of this crate: the generator of
//! order 4 and Rockwell's axis move go from rest to rest, and a table of positions may end with a velocity.
//!
//! Arrow 16 comes from part 5: a homing step leaves the axis in Homing until a block ends it.
//!
//! `MC_PositionProfile` leads to a last position and reports Done there, so it is a Discrete Motion; after profiles of velocity
//! and acceleration the axis stays in Continuous Motion (sections 3.15 and 3.16 of the standard).
use crate::blocks::BlockName;
use crate::state::AxisState::{
    self, ContinuousMotion, Disabled, DiscreteMotion, ErrorStop, Homing, Standstill, Stopping,
};

/// Cause of a state transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Cause {
    /// An error of the axis: of its drive, its power, its reference or its own.
    AxisError,
    /// Enable of MC_Power is FALSE.
    Unpowered,
    /// MC_Reset took the error away, and Status of MC_Power is FALSE.
    ResetUnpowered,
    /// MC_Reset took the error away, and Enable and Status of MC_Power are TRUE.
    ResetPowered,
    /// Enable and Status of MC_Power are TRUE.
    Powered,
    /// Done of MC_Stop is TRUE and its Execute FALSE.
    StopReleased,
    /// The motion is over and the axis at rest.
    Done,
    /// The motion is over and the axis keeps a velocity.
    DoneMoving,
    /// A block is executed.
    Block(BlockName),
}

impl Cause {
    /// Name in the words of the standard.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::AxisError => "an error of the axis",
            Self::Unpowered => "MC_Power.Enable = FALSE",
            Self::ResetUnpowered => "MC_Reset and MC_Power.Status = FALSE",
            Self::ResetPowered => "MC_Reset and MC_Power.Status = TRUE and MC_Power.Enable = TRUE",
            Self::Powered => "MC_Power.Enable = TRUE and MC_Power.Status = TRUE",
            Self::StopReleased => "MC_Stop.Done = TRUE and MC_Stop.Execute = FALSE",
            Self::Done => "Done",
            Self::DoneMoving => "Done of MC_PositionProfile, with a velocity",
            Self::Block(block) => block.name(),
        }
    }
}

/// An arrow of the state diagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrow {
    /// Place in the table, from 1.
    pub number: u8,
    /// States that the arrow leaves.
    pub from: &'static [AxisState],
    /// State that the arrow enters.
    pub to: AxisState,
    /// Causes, any of which triggers the arrow.
    pub causes: &'static [Cause],
}

/// Every arrow, in the order of the numbers.
pub const ARROWS: [Arrow; 16] = [
    Arrow {
        number: 1,
        from: &[Disabled, Standstill, Homing, DiscreteMotion, ContinuousMotion, Stopping],
        to: ErrorStop,
        causes: &[Cause::AxisError],
    },
    Arrow {
        number: 2,
        from: &[Standstill, Homing, DiscreteMotion, ContinuousMotion, Stopping],
        to: Disabled,
        causes: &[Cause::Unpowered],
    },
    Arrow { number: 3, from: &[ErrorStop], to: Disabled, causes: &[Cause::ResetUnpowered] },
    Arrow { number: 4, from: &[ErrorStop], to: Standstill, causes: &[Cause::ResetPowered] },
    Arrow { number: 5, from: &[Disabled], to: Standstill, causes: &[Cause::Powered] },
    Arrow { number: 6, from: &[Stopping], to: Standstill, causes: &[Cause::StopReleased] },
    Arrow {
        number: 7,
        from: &[Standstill],
        to: Homing,
        causes: &[
            Cause::Block(BlockName::Home),
            Cause::Block(BlockName::HomeDirect),
            Cause::Block(BlockName::HomeAbsolute),
            Cause::Block(BlockName::StepBlock),
        ],
    },
    Arrow { number: 8, from: &[Homing, DiscreteMotion], to: Standstill, causes: &[Cause::Done] },
    Arrow {
        number: 9,
        from: &[Standstill, Homing, DiscreteMotion, ContinuousMotion],
        to: Stopping,
        causes: &[Cause::Block(BlockName::Stop)],
    },
    Arrow {
        number: 10,
        from: &[Standstill, DiscreteMotion, ContinuousMotion],
        to: DiscreteMotion,
        causes: &[
            Cause::Block(BlockName::MoveAbsolute),
            Cause::Block(BlockName::MoveRelative),
            Cause::Block(BlockName::MoveAdditive),
            Cause::Block(BlockName::Halt),
            Cause::Block(BlockName::PositionProfile),
        ],
    },
    Arrow {
        number: 11,
        from: &[Standstill, DiscreteMotion],
        to: DiscreteMotion,
        causes: &[Cause::Block(BlockName::MoveSuperimposed)],
    },
    Arrow {
        number: 12,
        from: &[ContinuousMotion],
        to: ContinuousMotion,
        causes: &[Cause::Block(BlockName::MoveSuperimposed)],
    },
    Arrow {
        number: 13,
        from: &[Standstill, DiscreteMotion, ContinuousMotion],
        to: ContinuousMotion,
        causes: &[
            Cause::Block(BlockName::MoveVelocity),
            Cause::Block(BlockName::MoveContinuousAbsolute),
            Cause::Block(BlockName::MoveContinuousRelative),
            Cause::Block(BlockName::TorqueControl),
            Cause::Block(BlockName::VelocityProfile),
            Cause::Block(BlockName::AccelerationProfile),
        ],
    },
    Arrow {
        number: 14,
        from: &[Standstill],
        to: DiscreteMotion,
        causes: &[Cause::Block(BlockName::Profile4th), Cause::Block(BlockName::AxisMove)],
    },
    Arrow { number: 15, from: &[DiscreteMotion], to: ContinuousMotion, causes: &[Cause::DoneMoving] },
    Arrow {
        number: 16,
        from: &[Homing],
        to: Homing,
        causes: &[
            Cause::Block(BlockName::StepBlock),
            Cause::Block(BlockName::HomeDirect),
            Cause::Block(BlockName::HomeAbsolute),
            Cause::Block(BlockName::FinishHoming),
        ],
    },
];

impl BlockName {
    /// True if the block gives the axis its reference.
    #[must_use]
    pub fn homes(self) -> bool {
        ARROWS.iter().any(|arrow| arrow.to == Homing && arrow.causes.contains(&Cause::Block(self)))
    }
}

/// Arrow triggered by `cause` in `state`.
pub(crate) fn arrow(state: AxisState, cause: Cause) -> Option<&'static Arrow> {
    ARROWS.iter().find(|arrow| arrow.from.contains(&state) && arrow.causes.contains(&cause))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_arrow_stands_at_the_place_of_its_number() {
        for (place, arrow) in ARROWS.iter().enumerate() {
            assert_eq!(usize::from(arrow.number), place + 1);
            assert!(!arrow.from.is_empty() && !arrow.causes.is_empty(), "{place}");
        }
    }

    #[test]
    fn a_cause_leads_to_one_state() {
        for state in AxisState::ALL {
            for cause in ARROWS.iter().flat_map(|arrow| arrow.causes) {
                let due = ARROWS.iter().filter(|arrow| arrow.from.contains(&state) && arrow.causes.contains(cause));
                assert!(due.count() <= 1, "{state} {}", cause.name());
            }
        }
    }
}
