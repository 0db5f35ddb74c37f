//! `MC_PositionProfile`: moves along a table of positions.
//!
//! The standard leaves the path between the positions open. Two are implemented here, both from N. D. Baikov and A. N. Godunov, *An
//! Approach to Implementing Functional Blocks of the PLCopen Specification*, sections 4 and 5: plateaus of velocity, and the cubic spline.
//! Both begin with the present velocity of the axis. An axis in position mode follows the profile set-point by set-point. One in velocity
//! mode ([`AxisParams::velocity_ramps`]) receives the commands of the paper for a drive in profile velocity mode: one for each ramp between
//! two plateaus, or one for each step along the spline, in its cycles.
use super::outputs::{FunctionBlock, MotionOutputs};
use super::profile::{
    Beyond, Call, Course, Leading, Memory, Names, Pair, Scales, TIME_SCALE, VALUE_SCALE, check_room, pairs,
};
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Ending};
use crate::error::BlockError;
use crate::interface::{BlockInput, BlockInputs, FromValues as _, Tables, Trigger, Values, buffer_mode, or, required};
use crate::params::AxisParams;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::position_profile::{
    Clock, ClockedPlateaus, ClockedSpline, PlateauShare, Plateaus, Spline, VelocityRamp,
};
use servobench_motion::pvt::Knot;
use servobench_motion::{Limits, Piece, PlanError};

/// `MC_TP_REF`: positions and the times between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimePosition<'a> {
    /// `MC_TP_Array`, of `NumberOfPairs` elements.
    pub pairs: &'a [Pair],
    /// `IsAbsolute`; otherwise the positions count from the beginning of the profile.
    pub is_absolute: bool,
}

/// Interpolation between the positions.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Follow {
    /// At a constant velocity in each segment, but for this share of its time at either end, above 0 up to 1/2; `None` for the share that
    /// uses the smallest part of the velocity and the acceleration of the axis.
    Plateaus(Option<f64>),
    /// Along the cubic spline, whose acceleration is continuous.
    Spline,
    /// Along the cubic spline on an axis in velocity mode, with this rate of velocity commands (1/s).
    Steps(f64),
}

/// Moves along a table of positions, which it keeps in the memory `K` and `S`.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub struct PositionProfile<K, S> {
    leading: Leading,
    way: Way<K, S>,
}

/// Inputs of [`PositionProfile`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionProfileInputs<'a> {
    /// Execute.
    pub execute: bool,
    /// TimePosition.
    pub time_position: TimePosition<'a>,
    /// TimeScale.
    pub time_scale: f64,
    /// PositionScale.
    pub position_scale: f64,
    /// Offset (m or rad).
    pub offset: f64,
    /// Interpolation between the positions, beyond the standard.
    pub follow: Follow,
    /// Velocity at the last position (m/s or rad/s), beyond the standard.
    pub end_velocity: f64,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl<'a> PositionProfileInputs<'a> {
    /// Inputs for the absolute positions of `pairs`, unscaled, by the spline, to rest; not executed.
    #[must_use]
    pub fn along(pairs: &'a [Pair]) -> Self {
        let Scales { time: time_scale, value: position_scale, offset } = Scales::NONE;
        Self {
            execute: false,
            time_position: TimePosition { pairs, is_absolute: true },
            time_scale,
            position_scale,
            offset,
            follow: Follow::Spline,
            end_velocity: 0.0,
            buffer_mode: BufferMode::default(),
        }
    }

    const fn scales(&self) -> Scales {
        Scales { time: self.time_scale, value: self.position_scale, offset: self.offset }
    }
}

impl<'i> BlockInputs<'i> for PositionProfileInputs<'i> {
    const TRIGGER: Trigger = Trigger::Execute;
    const INPUTS: &'static [BlockInput] =
        &[required(Input::Table), TIME_SCALE, VALUE_SCALE, OFFSET, END_VELOCITY, buffer_mode()];

    fn read<T: Tables>(values: &'i Values<T>, execute: bool) -> Self {
        let pairs = pairs(values);
        let of_table = values.table(Input::Table).and_then(Tables::profile);
        Self {
            execute,
            time_position: TimePosition { pairs, is_absolute: !of_table.is_some_and(|table| table.is_relative) },
            time_scale: f64::read(values, &TIME_SCALE),
            position_scale: f64::read(values, &VALUE_SCALE),
            offset: f64::read(values, &OFFSET),
            follow: of_table.map_or(Follow::Spline, |table| table.follow),
            end_velocity: f64::read(values, &END_VELOCITY),
            buffer_mode: BufferMode::read(values, &buffer_mode()),
        }
    }
}

const OFFSET: BlockInput = or(Input::PositionOffset, 0.0);
const END_VELOCITY: BlockInput = or(Input::EndVelocity, 0.0);

impl<K: Memory<Knot>, S: Memory<f64>> PositionProfile<K, S> {
    /// A block with memory for a table of one pair less than `knots` and `scratch` hold.
    #[must_use]
    pub fn new(knots: K, scratch: S) -> Self {
        let way = Way {
            knots,
            scratch,
            count: 0,
            follow: Follow::Spline,
            is_absolute: true,
            origin: 0.0,
            says_where: false,
            end_velocity: 0.0,
            clock: None,
            share: PlateauShare::Given(0.5),
            alpha: 0.5,
            is_solved: false,
            piece: Piece::at_rest(0.0),
        };
        Self { leading: Leading::default(), way }
    }
}

impl PositionProfileInputs<'_> {
    fn check<K: Memory<Knot>, S: Memory<f64>>(&self, way: &Way<K, S>, axis: &Axis) -> Result<(), BlockError> {
        const NAMES: Names = Names { table: "TimePosition", scale: "PositionScale", may_jump: false };
        let (block, pairs) = (BlockName::PositionProfile, self.time_position.pairs);
        self.scales().check(block, &NAMES, pairs)?;
        let refuse = |input, value, bound| Err(BlockError::Input { block, input, value, bound });
        if pairs.iter().all(|pair| pair.delta_time == 0.0) {
            return refuse(NAMES.table, 0.0, "a table that takes some time");
        }
        match self.follow {
            Follow::Plateaus(Some(share)) if !(1e-15..=0.5).contains(&share) => {
                return refuse("Follow", share, "a share above 0 and at most 0.5");
            }
            Follow::Steps(rate) if axis.params().velocity_ramps.is_none() => {
                return refuse("Follow", rate, "the spline itself on an axis that receives positions");
            }
            Follow::Steps(rate) if !(1e-15..=1e15).contains(&rate) => {
                return refuse("Follow", rate, "a positive number of velocities per second, from 1e-15 to 1e15");
            }
            _ => {}
        }
        let (value, limit) = (self.end_velocity, axis.params().limits.velocity);
        if value.is_nan() || value.abs() > limit {
            return Err(BlockError::AboveLimit { block, input: "EndVelocity", value, limit });
        }
        if self.time_position.is_absolute && !axis.has_reference(self.buffer_mode) {
            return Err(BlockError::NotHomed { block, value: pairs[0].value });
        }
        let points = pairs.len() + 1;
        check_room(block, "knots", way.knots.as_ref(), points)?;
        check_room(block, "scratch", way.scratch.as_ref(), points)
    }
}

impl<K: Memory<Knot>, S: Memory<f64>> FunctionBlock for PositionProfile<K, S> {
    const NAME: BlockName = BlockName::PositionProfile;
    type Inputs<'i> = PositionProfileInputs<'i>;
    type Outputs = MotionOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &PositionProfileInputs<'_>) -> MotionOutputs {
        let ending = if inputs.end_velocity == 0.0 { Ending::AtRest } else { Ending::Moving };
        let PositionProfileInputs { execute, buffer_mode, .. } = *inputs;
        let call = Call { block: Self::NAME, execute, ending, buffer_mode };
        let check = |way: &Way<K, S>, axis: &Axis| inputs.check(way, axis);
        let params = *axis.params();
        self.leading.step(axis, call, &mut self.way, check, |way| way.load(inputs, &params)).into()
    }

    fn error(&self) -> Option<&BlockError> {
        self.leading.execution.error()
    }
}

#[cfg(feature = "program")]
impl crate::program::New for PositionProfile<alloc::vec::Vec<Knot>, alloc::vec::Vec<f64>> {
    fn new_for(inputs: &crate::program::Inputs) -> Self {
        // The beginning of the profile is a point too.
        let points = pairs(inputs).len() + 1;
        Self::new(alloc::vec![Knot::default(); points], alloc::vec![0.0; points])
    }
}

/// A table being followed.
#[derive(Debug, Clone, PartialEq, Stateful)]
struct Way<K, S> {
    knots: K,
    scratch: S,
    count: usize,
    follow: Follow,
    is_absolute: bool,
    /// Present origin of the positions of the knots.
    origin: f64,
    /// True if the table defines where the profile begins.
    says_where: bool,
    end_velocity: f64,
    /// Cycles of an axis in velocity mode.
    clock: Option<Clock>,
    /// Plateaus: the requested share, and the one that was found.
    share: PlateauShare,
    alpha: f64,
    is_solved: bool,
    piece: Piece,
}

impl<K: Memory<Knot>, S: Memory<f64>> Way<K, S> {
    /// Loads the table, behind a first point at which the profile will begin on an axis with `params`.
    fn load(&mut self, inputs: &PositionProfileInputs<'_>, params: &AxisParams) {
        let (scales, pairs) = (inputs.scales(), inputs.time_position.pairs);
        let knots = self.knots.as_mut();
        let (mut t, mut count) = (0.0, 1);
        (self.origin, self.says_where) = (0.0, false);
        for pair in pairs {
            let Pair { delta_time, value } = scales.of(pair);
            t += delta_time;
            if t == 0.0 {
                knots[0] = Knot::new(0.0, value);
                self.says_where = true;
                continue;
            }
            knots[count] = Knot::new(t, value);
            count += 1;
        }
        (self.count, self.is_solved) = (count, false);
        (self.follow, self.end_velocity) = (inputs.follow, inputs.end_velocity);
        self.is_absolute = inputs.time_position.is_absolute;
        self.clock = params.velocity_ramps.and_then(|_| Clock::new(0.0, params.cycle_time).ok());
        let Limits { velocity, acceleration, .. } = params.limits;
        self.share = match inputs.follow {
            Follow::Plateaus(Some(share)) => PlateauShare::Given(share),
            _ => PlateauShare::SmallestPartOf { velocity, acceleration },
        };
    }

    fn points(&self) -> &[Knot] {
        &self.knots.as_ref()[..self.count]
    }

    /// Solves for the velocities of the points; on an axis in velocity mode, of those that its cycles can resolve.
    fn solve(&mut self, start: f64) -> Result<(), PlanError> {
        let Self { knots, scratch, count, follow, end_velocity: end, clock, share, alpha, .. } = self;
        let (knots, scratch, end) = (&mut knots.as_mut()[..*count], scratch.as_mut(), *end);
        match (*follow, *clock) {
            (Follow::Plateaus(_), None) => *alpha = Plateaus::solve(knots, start, end, *share, scratch)?.share(),
            (Follow::Plateaus(_), Some(clock)) => {
                let solved = ClockedPlateaus::solve(knots, start, end, *share, clock, scratch)?;
                (*alpha, *count) = (solved.share(), solved.knots().len());
            }
            (Follow::Steps(rate), Some(clock)) => {
                *count = ClockedSpline::solve(knots, start, end, rate, clock, scratch)?.table().knots().len();
            }
            (Follow::Spline | Follow::Steps(_), _) => {
                Spline::solve(knots, start, end, scratch)?;
            }
        }
        Ok(())
    }
}

impl<K: Memory<Knot>, S: Memory<f64>> Course for Way<K, S> {
    fn begin(&mut self, from: &Setpoint) {
        let origin = if self.is_absolute { 0.0 } else { from.x };
        let moved = origin - core::mem::replace(&mut self.origin, origin);
        let knots = &mut self.knots.as_mut()[..self.count];
        for knot in &mut *knots {
            knot.x += moved;
        }
        if !self.says_where {
            knots[0] = Knot::new(0.0, from.x);
        }
        self.is_solved = self.solve(from.v).is_ok();
        // A profile that cannot be solved is beyond every limit.
        let beyond = Setpoint { v: f64::NAN, ..*from };
        self.piece = if self.is_solved { self.look_up(0.0) } else { Piece::held(beyond, f64::INFINITY) };
    }

    fn at(&mut self, t: f64) -> Setpoint {
        if self.is_solved && !self.piece.holds(t) {
            self.piece = self.look_up(t);
        }
        if t < self.duration() {
            return self.piece.at(t);
        }
        if self.end_velocity == 0.0 {
            // The end, bit for bit.
            return Setpoint::at_rest(self.points()[self.count - 1].x);
        }
        Setpoint { a: 0.0, j: 0.0, ..self.piece.at(t) }
    }

    fn ramp(&self, t: f64) -> Option<VelocityRamp> {
        let clock = self.clock.filter(|_| self.is_solved)?;
        let between = t - 0.5 * clock.period();
        match self.follow {
            Follow::Plateaus(_) => Some(self.plateaus(clock).ramp_at(between)),
            Follow::Steps(rate) => Some(ClockedSpline::solved(self.points(), rate, clock).ramp_at(between)),
            Follow::Spline => None,
        }
    }

    fn duration(&self) -> f64 {
        self.points()[self.count - 1].t
    }

    fn beyond(&self, limits: &Limits) -> Option<Beyond> {
        if !self.is_solved {
            return Beyond::within(&self.piece.at(0.0), 0.0, limits);
        }
        let (mut t, end) = (0.0, self.duration());
        while t < end {
            let piece = self.look_up(t);
            let until = piece.ends().min(end).max(t.next_up());
            let found = Beyond::within(&piece.at(t), until - t, limits);
            if found.is_some() {
                return found;
            }
            t = until;
        }
        None
    }
}

impl<K: Memory<Knot>, S: Memory<f64>> Way<K, S> {
    fn look_up(&self, t: f64) -> Piece {
        match self.follow {
            Follow::Plateaus(_) => match self.clock {
                Some(clock) => self.plateaus(clock).piece(t),
                None => Plateaus::solved(self.points(), self.alpha).piece(t),
            },
            Follow::Spline | Follow::Steps(_) => Spline::solved(self.points()).table().piece(t),
        }
    }

    fn plateaus(&self, clock: Clock) -> ClockedPlateaus<'_> {
        ClockedPlateaus::solved(self.points(), self.end_velocity, self.alpha, clock)
    }
}
