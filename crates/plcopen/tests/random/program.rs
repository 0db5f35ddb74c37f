//! A program that calls every block in every cycle.
use super::LIMITS;
use super::chance::Chance;
use super::outputs::{Flags, call};
use super::setpoints::Setpoints;
use servobench_fieldbus::{AxisCommand, AxisFeedback, ProbeTrigger};
use servobench_motion::Limits;
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    ARROWS, AccelerationProfile, AccelerationProfileInputs, Axis, AxisParams, AxisState, BlockName, BufferMode, Cause,
    Direction, Follow, FunctionBlock, Halt, HaltInputs, HaltSuperimposed, HaltSuperimposedInputs, Home, HomeAbsolute,
    HomeAbsoluteInputs, HomeDirect, HomeDirectInputs, HomeInputs, MoveAbsolute, MoveAbsoluteInputs, MoveAdditive,
    MoveAdditiveInputs, MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveContinuousRelative,
    MoveContinuousRelativeInputs, MoveRelative, MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs,
    MoveVelocity, MoveVelocityInputs, Pair, PositionProfile, PositionProfileInputs, Power, PowerInputs, Profile4th,
    Profile4thInputs, Reset, ResetInputs, SetOverride, SetOverrideInputs, SetPosition, SetPositionInputs, Stop,
    StopInputs, TimePosition, TorqueControl, TorqueControlInputs, TouchProbe, TouchProbeInputs, VelocityProfile,
    VelocityProfileInputs,
};

/// Blocks with Execute.
const BLOCKS: usize = 22;

/// Their names, in the order in which they are called.
const NAMES: [BlockName; BLOCKS] = [
    BlockName::Home,
    BlockName::Stop,
    BlockName::Halt,
    BlockName::MoveAbsolute,
    BlockName::Reset,
    BlockName::PositionProfile,
    BlockName::MoveAbsolute,
    BlockName::MoveRelative,
    BlockName::MoveAdditive,
    BlockName::VelocityProfile,
    BlockName::MoveSuperimposed,
    BlockName::MoveVelocity,
    BlockName::AccelerationProfile,
    BlockName::MoveContinuousAbsolute,
    BlockName::TorqueControl,
    BlockName::Profile4th,
    BlockName::SetPosition,
    BlockName::MoveContinuousRelative,
    BlockName::HaltSuperimposed,
    BlockName::HomeDirect,
    BlockName::HomeAbsolute,
    BlockName::TouchProbe,
];

/// Highest number of pairs in a table.
const PAIRS: usize = 5;

pub(crate) struct Program {
    axis: Axis,
    enable: bool,
    setpoints: Setpoints,
    /// Completed moves and profiles.
    pub(crate) done: usize,
    pub(crate) followed: usize,
    /// Cycles between two calls of a block, on average.
    patience: u64,
    execute: [bool; BLOCKS],
    flags: [Flags; BLOCKS],
    blocks: Blocks,
    factor: SetOverrideInputs,
}

struct Blocks {
    power: Power,
    home: Home,
    stop: Stop,
    halt: Halt,
    reset: Reset,
    absolute: [MoveAbsolute; 2],
    relative: MoveRelative,
    additive: MoveAdditive,
    on_top: MoveSuperimposed,
    velocity: MoveVelocity,
    continuous: MoveContinuousAbsolute,
    torque: TorqueControl,
    by_positions: PositionProfile<[Knot; PAIRS + 1], [f64; PAIRS + 1]>,
    by_velocities: VelocityProfile<[Pair; PAIRS]>,
    by_accelerations: AccelerationProfile<[Pair; PAIRS]>,
    generator: Profile4th,
    set: SetPosition,
    continuous_relative: MoveContinuousRelative,
    halt_on_top: HaltSuperimposed,
    home_direct: HomeDirect,
    home_absolute: HomeAbsolute,
    probe: TouchProbe,
    factors: SetOverride,
}

impl Program {
    pub(crate) fn new(params: AxisParams, patience: u64) -> Self {
        let blocks = Blocks {
            power: Power,
            home: Home::default(),
            stop: Stop::default(),
            halt: Halt::default(),
            reset: Reset::default(),
            absolute: [MoveAbsolute::default(); 2],
            relative: MoveRelative::default(),
            additive: MoveAdditive::default(),
            on_top: MoveSuperimposed::default(),
            velocity: MoveVelocity::default(),
            continuous: MoveContinuousAbsolute::default(),
            torque: TorqueControl::default(),
            by_positions: PositionProfile::new([Knot::default(); PAIRS + 1], [0.0; PAIRS + 1]),
            by_velocities: VelocityProfile::new([Pair::default(); PAIRS]),
            by_accelerations: AccelerationProfile::new([Pair::default(); PAIRS]),
            generator: Profile4th::default(),
            set: SetPosition::default(),
            continuous_relative: MoveContinuousRelative::default(),
            halt_on_top: HaltSuperimposed::default(),
            home_direct: HomeDirect::default(),
            home_absolute: HomeAbsolute::default(),
            probe: TouchProbe::default(),
            factors: SetOverride::default(),
        };
        Self {
            axis: Axis::new(params).unwrap(),
            enable: false,
            setpoints: Setpoints::default(),
            done: 0,
            followed: 0,
            patience,
            execute: [false; BLOCKS],
            flags: [Flags::default(); BLOCKS],
            blocks,
            factor: SetOverrideInputs { enable: true, ..SetOverrideInputs::default() },
        }
    }

    pub(crate) fn state(&self) -> AxisState {
        self.axis.state()
    }

    pub(crate) fn cycle(
        &mut self,
        feedback: &AxisFeedback,
        chance: &mut Chance,
        place: &str,
        taken: &mut [usize],
    ) -> AxisCommand {
        let before = self.axis.state();
        self.axis.begin(feedback);
        self.passed(before, place, taken);
        self.call(chance, place, taken);
        let before = self.axis.state();
        let command = self.axis.end();
        self.passed(before, place, taken);
        self.setpoints.check(&self.axis, feedback, &command, place);
        command
    }

    /// Checks that a change of state follows an arrow of the diagram, or two arrows by way of Standstill.
    fn passed(&self, before: AxisState, place: &str, taken: &mut [usize]) {
        let after = self.axis.state();
        if before == after {
            return;
        }
        let leads = |from: AxisState, to: AxisState| ARROWS.iter().position(|a| a.from.contains(&from) && a.to == to);
        let number = leads(before, after);
        let by_standstill = leads(before, AxisState::Standstill).zip(leads(AxisState::Standstill, after));
        assert!(number.is_some() || by_standstill.is_some(), "{place}: {before} to {after}");
        if let Some(number) = number {
            taken[number] += 1;
        }
    }

    /// Calls all blocks.
    fn call(&mut self, chance: &mut Chance, place: &str, taken: &mut [usize]) {
        if chance.once_in(if self.enable { 2000 } else { 20 }) {
            self.enable = !self.enable;
        }
        let before = self.axis.state();
        let negative = !chance.once_in(5000);
        let inputs = PowerInputs { enable: self.enable, enable_positive: true, enable_negative: negative };
        self.blocks.power.step(&mut self.axis, &inputs);
        self.passed(before, place, taken);
        if chance.once_in(100) {
            let velocity = if chance.once_in(8) { 0.0 } else { chance.between(0.1, 1.0) };
            let mut factor = || if chance.once_in(4) { chance.between(0.5, 1.0) } else { 1.0 };
            let (acceleration, jerk) = (factor(), factor());
            self.factor = SetOverrideInputs {
                enable: true,
                vel_factor: chance.input(velocity),
                acc_factor: chance.input(acceleration),
                jerk_factor: chance.input(jerk),
            };
        }
        self.blocks.factors.step(&mut self.axis, &self.factor);
        for (number, name) in NAMES.into_iter().enumerate() {
            let was = self.execute[number];
            let quick = match name {
                BlockName::Reset => 10,
                BlockName::Home => self.patience / 3,
                BlockName::HomeDirect | BlockName::HomeAbsolute | BlockName::MoveContinuousRelative => {
                    4 * self.patience
                }
                BlockName::TorqueControl | BlockName::Profile4th => 2 * self.patience,
                _ => self.patience,
            };
            if chance.once_in(if was { 20 } else { quick }) {
                self.execute[number] = !was;
            }
            let (before, execute) = (self.axis.state(), self.execute[number]);
            let flags = self.call_block(number, execute, chance);
            if name != BlockName::Profile4th {
                flags.check(&format!("{place}, {name}"), execute, &self.flags[number]);
            }
            self.flags[number] = flags;
            let is_profile = matches!(
                name,
                BlockName::PositionProfile | BlockName::VelocityProfile | BlockName::AccelerationProfile
            );
            let is_move = matches!(name, BlockName::MoveAbsolute | BlockName::MoveRelative | BlockName::MoveAdditive);
            self.done += usize::from(is_move && flags.done);
            self.followed += usize::from(is_profile && flags.done);
            self.arrows_taken(before, name, execute, place, taken);
        }
    }

    fn arrows_taken(&self, before: AxisState, name: BlockName, execute: bool, place: &str, taken: &mut [usize]) {
        let after = self.axis.state();
        if before != after || execute {
            self.passed(before, place, taken);
        }
        let cause = Cause::Block(name);
        let named = ARROWS.iter().position(|arrow| arrow.from.contains(&before) && arrow.causes.contains(&cause));
        if let Some(number) = named.filter(|number| execute && ARROWS[*number].to == after) {
            taken[number] += 1;
        }
    }

    fn call_block(&mut self, number: usize, execute: bool, chance: &mut Chance) -> Flags {
        let (axis, blocks) = (&mut self.axis, &mut self.blocks);
        let limits = chance.limits(axis.params().limits);
        let deceleration = chance.between(0.3, 1.0) * limits.acceleration;
        let continuous_update = chance.once_in(4);
        let buffer_mode = chance.one_of(&[
            BufferMode::Aborting,
            BufferMode::Buffered,
            BufferMode::BlendingLow,
            BufferMode::BlendingPrevious,
            BufferMode::BlendingNext,
            BufferMode::BlendingHigh,
        ]);
        let ways = [Direction::Positive, Direction::Negative, Direction::Current];
        let endless = chance.one_of(&ways);
        let is_modulo = axis.params().modulo.is_some();
        let direction = if is_modulo && !chance.once_in(3) { endless } else { Direction::Shortest };
        let position = if is_modulo { chance.between(0.0, 2.999) } else { chance.between(-1.0, 1.0) };
        let (position, distance) = (chance.input(position), chance.between(-0.4, 0.4));
        let distance = chance.input(distance);
        match NAMES[number] {
            BlockName::Stop => call(&mut blocks.stop, axis, &StopInputs { execute, ..StopInputs::within(&limits) }),
            BlockName::Halt => {
                call(&mut blocks.halt, axis, &HaltInputs { execute, buffer_mode, ..HaltInputs::within(&limits) })
            }
            BlockName::MoveAbsolute => {
                let inputs = MoveAbsoluteInputs { execute, continuous_update, position, ..within(&limits) };
                let inputs = MoveAbsoluteInputs { deceleration, direction, buffer_mode, ..inputs };
                call(&mut blocks.absolute[usize::from(number == 3)], axis, &inputs)
            }
            BlockName::Reset => call(&mut blocks.reset, axis, &ResetInputs { execute }),
            BlockName::MoveRelative => {
                let inputs = MoveRelativeInputs { execute, distance, ..MoveRelativeInputs::within(&limits) };
                let inputs = MoveRelativeInputs { continuous_update, buffer_mode, deceleration, ..inputs };
                call(&mut blocks.relative, axis, &inputs)
            }
            BlockName::MoveAdditive => {
                let inputs = MoveAdditiveInputs { execute, distance, ..MoveAdditiveInputs::within(&limits) };
                call(&mut blocks.additive, axis, &MoveAdditiveInputs { continuous_update, buffer_mode, ..inputs })
            }
            BlockName::MoveSuperimposed => {
                let inputs = MoveSuperimposedInputs { execute, distance, ..MoveSuperimposedInputs::within(&limits) };
                call(&mut blocks.on_top, axis, &MoveSuperimposedInputs { continuous_update, ..inputs })
            }
            BlockName::MoveVelocity => {
                let inputs = MoveVelocityInputs { execute, ..MoveVelocityInputs::within(&limits) };
                let inputs = MoveVelocityInputs { continuous_update, buffer_mode, direction: endless, ..inputs };
                call(&mut blocks.velocity, axis, &inputs)
            }
            BlockName::MoveContinuousAbsolute => {
                let end = if chance.once_in(4) { 0.0 } else { chance.between(-1.0, 1.0) * limits.velocity };
                let inputs = MoveContinuousAbsoluteInputs { execute, ..MoveContinuousAbsoluteInputs::within(&limits) };
                let inputs =
                    MoveContinuousAbsoluteInputs { position, end_velocity: end, direction, buffer_mode, ..inputs };
                call(&mut blocks.continuous, axis, &inputs)
            }
            BlockName::TorqueControl => {
                let inputs = TorqueControlInputs { torque: distance, ..TorqueControlInputs::within(&limits) };
                let velocity = chance.input(LIMITS.velocity);
                let inputs = TorqueControlInputs { execute, torque_ramp: 10.0, velocity, ..inputs };
                call(&mut blocks.torque, axis, &inputs)
            }
            BlockName::Profile4th => {
                let limits =
                    Limits { snap: limits.snap.min(LIMITS.snap), jerk: limits.jerk.min(LIMITS.jerk), ..limits };
                let inputs = Profile4thInputs { enable: execute, ..Profile4thInputs::to(position, limits) };
                call(&mut blocks.generator, axis, &inputs)
            }
            BlockName::MoveContinuousRelative => {
                let end = if chance.once_in(4) { 0.0 } else { chance.between(-1.0, 1.0) * limits.velocity };
                let inputs = MoveContinuousRelativeInputs { execute, ..MoveContinuousRelativeInputs::within(&limits) };
                let inputs = MoveContinuousRelativeInputs {
                    distance,
                    end_velocity: end,
                    continuous_update,
                    buffer_mode,
                    ..inputs
                };
                call(&mut blocks.continuous_relative, axis, &inputs)
            }
            name if name.homes() => call_homing(name, blocks, axis, execute, buffer_mode),
            BlockName::PositionProfile | BlockName::VelocityProfile | BlockName::AccelerationProfile => {
                call_profile(NAMES[number], blocks, axis, execute, buffer_mode, chance)
            }
            name => call_beside(name, blocks, axis, execute, (&limits, deceleration, position), chance),
        }
    }
}

fn within(limits: &Limits) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs::within(limits)
}

/// Calls a block that gives the axis its reference.
fn call_homing(name: BlockName, blocks: &mut Blocks, axis: &mut Axis, execute: bool, buffer_mode: BufferMode) -> Flags {
    match name {
        BlockName::HomeDirect => {
            call(&mut blocks.home_direct, axis, &HomeDirectInputs { execute, position: 0.25, buffer_mode })
        }
        BlockName::HomeAbsolute => call(&mut blocks.home_absolute, axis, &HomeAbsoluteInputs { execute, buffer_mode }),
        _ => call(&mut blocks.home, axis, &HomeInputs { execute, position: 0.5, buffer_mode }),
    }
}

/// Calls a block that acts beside the motion of the axis, or on top of it.
fn call_beside(
    name: BlockName,
    blocks: &mut Blocks,
    axis: &mut Axis,
    execute: bool,
    (limits, deceleration, position): (&Limits, f64, f64),
    chance: &mut Chance,
) -> Flags {
    match name {
        BlockName::SetPosition => {
            let inputs = SetPositionInputs { execute, position: 0.1, relative: true };
            call(&mut blocks.set, axis, &inputs)
        }
        BlockName::HaltSuperimposed => {
            let Limits { jerk, snap, .. } = *limits;
            let [jerk, snap] = [jerk, snap].map(|limit| Some(limit).filter(|limit| limit.is_finite()));
            call(&mut blocks.halt_on_top, axis, &HaltSuperimposedInputs { execute, deceleration, jerk, snap })
        }
        BlockName::TouchProbe => {
            let inputs = TouchProbeInputs {
                execute,
                trigger: ProbeTrigger::HomeSwitchMet,
                first_position: chance.once_in(2).then_some(position),
                last_position: None,
            };
            call(&mut blocks.probe, axis, &inputs)
        }
        name => unreachable!("{name} is not called"),
    }
}

/// Calls a block with a table, which it reads at the edge only.
fn call_profile(
    name: BlockName,
    blocks: &mut Blocks,
    axis: &mut Axis,
    execute: bool,
    buffer_mode: BufferMode,
    chance: &mut Chance,
) -> Flags {
    let most = match name {
        BlockName::PositionProfile => 0.3,
        BlockName::VelocityProfile => 1.05 * LIMITS.velocity,
        _ => 1.05 * LIMITS.acceleration,
    };
    let pairs: Vec<Pair> =
        chance.table(most).into_iter().map(|(delta_time, value)| Pair { delta_time, value }).collect();
    let time_scale = chance.input(1.0);
    match name {
        BlockName::PositionProfile => {
            let time_position = TimePosition { pairs: &pairs, is_absolute: chance.once_in(4) };
            let follow =
                if chance.once_in(2) { Follow::Spline } else { Follow::Plateaus(Some(chance.between(0.05, 0.5))) };
            let end_velocity = if chance.once_in(2) { 0.0 } else { chance.between(-1.0, 1.0) };
            let inputs = PositionProfileInputs { execute, time_scale, ..PositionProfileInputs::along(&pairs) };
            let inputs = PositionProfileInputs { time_position, follow, end_velocity, buffer_mode, ..inputs };
            call(&mut blocks.by_positions, axis, &inputs)
        }
        BlockName::VelocityProfile => {
            let inputs = VelocityProfileInputs { execute, time_scale, ..VelocityProfileInputs::along(&pairs) };
            call(&mut blocks.by_velocities, axis, &VelocityProfileInputs { buffer_mode, ..inputs })
        }
        _ => {
            let inputs = AccelerationProfileInputs { execute, time_scale, ..AccelerationProfileInputs::along(&pairs) };
            call(&mut blocks.by_accelerations, axis, &AccelerationProfileInputs { buffer_mode, ..inputs })
        }
    }
}
