//! The active mode, with its state.
use super::{CycleEvent, Params};
use crate::modes::interpolated::Buffer;
use crate::modes::{Answer, Moment, cyclic, homing, interpolated, profile};
use servobench_base::Stateful;
use servobench_cia402::Mode;

/// A mode, by its abbreviation, and its state.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) enum Running {
    Pp(profile::position::State),
    Pv(profile::velocity::State),
    Tq(profile::effort::State),
    Hm(homing::State),
    Ip(interpolated::State),
    Csp(cyclic::position::State),
    Csv(cyclic::velocity::State),
    Cst(cyclic::effort::State),
}

impl Running {
    /// Begins a mode.
    pub(super) fn begin(p: &Params, mode: Mode, now: &Moment) -> Self {
        match mode {
            Mode::ProfilePosition => Self::Pp(profile::position::State::begin(&p.profile_position(), now)),
            Mode::ProfileVelocity => Self::Pv(profile::velocity::State::begin(now)),
            Mode::ProfileTorque => Self::Tq(profile::effort::State::begin(now)),
            Mode::Homing => Self::Hm(homing::State::begin(now)),
            Mode::CyclicSynchronousPosition => Self::Csp(cyclic::position::State::begin(&p.cyclic_position(), now)),
            Mode::CyclicSynchronousVelocity => Self::Csv(cyclic::velocity::State::begin(now)),
            Mode::CyclicSynchronousTorque => Self::Cst(cyclic::effort::State::begin(now)),
            Mode::InterpolatedPosition => Self::Ip(interpolated::State::begin(now)),
        }
    }

    /// Continues after a halt, from the present position of the axis.
    pub(super) fn resume(&mut self, p: &Params, now: &Moment) {
        match self {
            Self::Pp(x) => x.resume(&p.profile_position(), now),
            Self::Pv(x) => x.resume(now),
            Self::Tq(x) => *x = profile::effort::State::begin(now),
            Self::Hm(x) => x.resume(now),
            Self::Ip(x) => *x = interpolated::State::begin(now),
            Self::Csp(x) => *x = cyclic::position::State::begin(&p.cyclic_position(), now),
            Self::Csv(x) => *x = cyclic::velocity::State::begin(now),
            Self::Cst(x) => *x = cyclic::effort::State::begin(now),
        }
    }

    /// Bits 12 and 13 of a step at which the axis is halted: they keep the meaning of the mode. A mode that follows the master does not do
    /// so during a halt.
    pub(super) fn halted(&mut self, p: &Params, now: &Moment) -> [bool; 2] {
        match self {
            Self::Pp(x) => [x.halted(now), false],
            Self::Pv(x) => [x.stands(&p.profile_velocity(), now), false],
            Self::Hm(x) => [x.is_homed(), x.failure().is_some()],
            Self::Tq(_) | Self::Ip(_) | Self::Csp(_) | Self::Csv(_) | Self::Cst(_) => [false; 2],
        }
    }

    /// Executes a step of the mode; `shift` receives the shift by homing of every position from the next step on.
    #[inline]
    pub(super) fn step(
        &mut self,
        p: &Params,
        now: &Moment,
        event: CycleEvent,
        buffer: &mut Buffer,
        shift: &mut Option<f64>,
    ) -> Answer {
        match self {
            Self::Pp(x) => profile::position::step(&p.profile_position(), x, now),
            Self::Pv(x) => profile::velocity::step(&p.profile_velocity(), x, now),
            Self::Tq(x) => profile::effort::step(p.profile_effort(), x, now),
            Self::Hm(x) => {
                let homing::Output { answer, shift: found } = homing::step(&p.homing(now), x, now);
                *shift = found;
                answer
            }
            Self::Ip(x) => interpolated::step(&p.interpolated(), x, buffer, now),
            Self::Csp(x) => cyclic::position::step(&p.cyclic_position(), x, now, event),
            Self::Csv(x) => cyclic::velocity::step(&p.cyclic_velocity(), x, now, event),
            Self::Cst(x) => cyclic::effort::step(p.cyclic_effort(), x, now, event),
        }
    }

    /// True if the mode demands less than the master does.
    pub(super) const fn is_limited(&self) -> bool {
        match self {
            Self::Pp(x) => x.is_limited(),
            Self::Pv(x) => x.is_limited(),
            Self::Ip(x) => x.is_limited(),
            Self::Csp(x) => x.is_limited(),
            Self::Csv(x) => x.is_limited(),
            Self::Tq(_) | Self::Hm(_) | Self::Cst(_) => false,
        }
    }

    /// True if the mode follows a target of the master in every cycle (bit 12): each needs a frame.
    pub(super) const fn follows_master(&self) -> bool {
        matches!(self, Self::Csp(_) | Self::Csv(_) | Self::Cst(_))
    }

    /// True if the mode moves to the ends of the axis by itself.
    pub(super) const fn looks_for_ends(&self) -> bool {
        matches!(self, Self::Hm(_))
    }
}
