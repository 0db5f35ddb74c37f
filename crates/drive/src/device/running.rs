//! The mode that runs, with its state.
use super::{Beat, Params};
use crate::modes::cyclic::{effort, position, velocity};
use crate::modes::{Answer, Moment};
use servobench_cia402::Mode;

/// A mode, by its abbreviation, and its state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Running {
    Csp(position::State),
    Csv(velocity::State),
    Cst(effort::State),
}

impl Running {
    /// The mode takes over; `None` for one that the drive does not have.
    pub(super) fn begin(mode: Mode, now: &Moment) -> Option<Self> {
        match mode {
            Mode::CyclicSynchronousPosition => Some(Self::Csp(position::State::begin(now))),
            Mode::CyclicSynchronousVelocity => Some(Self::Csv(velocity::State::begin(now))),
            Mode::CyclicSynchronousTorque => Some(Self::Cst(effort::State::begin(now))),
            Mode::ProfilePosition
            | Mode::ProfileVelocity
            | Mode::ProfileTorque
            | Mode::Homing
            | Mode::InterpolatedPosition => None,
        }
    }

    /// Goes on after a halt, from where the axis stands.
    pub(super) fn resume(&mut self, now: &Moment) {
        match self {
            Self::Csp(x) => *x = position::State::begin(now),
            Self::Csv(x) => *x = velocity::State::begin(now),
            Self::Cst(x) => *x = effort::State::begin(now),
        }
    }

    pub(super) fn step(&mut self, p: &Params, now: &Moment, beat: Beat) -> Answer {
        match self {
            Self::Csp(x) => position::step(&p.cyclic_position(), x, now, beat),
            Self::Csv(x) => velocity::step(&p.cyclic_velocity(), x, now, beat),
            Self::Cst(x) => effort::step(p.cyclic_effort(), x, now, beat),
        }
    }

    /// Whether it asks for less than the master does.
    pub(super) const fn is_limited(&self) -> bool {
        match self {
            Self::Csp(x) => x.is_limited(),
            Self::Csv(x) => x.is_limited(),
            Self::Cst(_) => false,
        }
    }

    /// Whether a frame has to come every cycle.
    pub(super) const fn needs_frames(&self) -> bool {
        matches!(self, Self::Csp(_) | Self::Csv(_) | Self::Cst(_))
    }
}
