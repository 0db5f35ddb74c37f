//! Programs gone mad: random calls with random inputs on an axis whose drive faults and fails at random.
//!
//! The sweep is small in ordinary runs. `SERVOBENCH_SWEEP=5000000 cargo test --release -p servobench-plcopen --test random` runs the
//! large one; the number is that of cycles per order.
use servobench_base::Setpoint;
use servobench_fieldbus::{AxisCommand, AxisFeedback, Fault, Homing, Power as DrivePower, Task};
use servobench_motion::Limits;
use servobench_plcopen::{
    ARROWS, Arrow, Axis, AxisParams, AxisState, BlockName, BufferMode, Cause, Direction, ErrorId, FunctionBlock, Halt,
    HaltInputs, Home, HomeInputs, MoveAbsolute, MoveAbsoluteInputs, MoveAdditive, MoveAdditiveInputs,
    MoveContinuousAbsolute, MoveContinuousAbsoluteInputs, MoveRelative, MoveRelativeInputs, MoveSuperimposed,
    MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs, Power, PowerInputs, Reset, ResetInputs, SetOverride,
    SetOverrideInputs, SetPosition, SetPositionInputs, Stop, StopInputs, TorqueControl, TorqueControlInputs,
};

const CYCLE_TIME: f64 = 2e-3;
const LIMITS: Limits = Limits { velocity: 2.0, acceleration: 10.0, jerk: 200.0, snap: 8000.0 };
/// Part of the limits that a block may use so that two of them may on top of each other.
const PART: f64 = 0.5;
/// Cycles after which a new program starts on a new axis.
const LIFE: usize = 5_000;

fn cycles() -> usize {
    std::env::var("SERVOBENCH_SWEEP").ok().and_then(|count| count.parse().ok()).unwrap_or(100_000)
}

#[test]
fn no_program_of_order_4_leaves_the_diagram_or_the_limits() {
    sweep(LIMITS);
}

#[test]
fn no_program_of_order_3_leaves_the_diagram_or_the_limits() {
    sweep(Limits { snap: f64::INFINITY, ..LIMITS });
}

#[test]
fn no_program_of_order_2_leaves_the_diagram_or_the_limits() {
    sweep(Limits { snap: f64::INFINITY, jerk: f64::INFINITY, ..LIMITS });
}

fn sweep(limits: Limits) {
    let mut random = SplitMix(limits.jerk.to_bits() ^ limits.snap.to_bits());
    let mut seen = [0_usize; AxisState::ALL.len()];
    let mut taken = [0_usize; ARROWS.len()];
    let mut done = 0;
    for life in 0..cycles().div_ceil(LIFE) {
        let modulo = random.once_in(2).then_some(3.0);
        let needs_homing = random.once_in(4);
        let params = AxisParams { modulo, needs_homing, buffered_commands: 3, ..AxisParams::new(CYCLE_TIME, limits) };
        let mut program = Program::new(params, random.one_of(&[150, 5000]));
        for cycle in 0..LIFE {
            program.cycle(&mut random, &format!("life {life}, cycle {cycle}"), &mut taken);
            seen[program.axis.state() as usize] += 1;
        }
        done += program.done;
    }
    // The test is where it matters: in every state for a while, on every arrow but those of the generator and of tables, and with
    // moves that end.
    let few = cycles() / 2000;
    assert!(seen.iter().all(|times| *times > few), "{seen:?}");
    let not_called = [Cause::Block(BlockName::Profile4th), Cause::DoneMoving];
    let is_called = |arrow: &Arrow| !not_called.iter().any(|cause| arrow.causes.contains(cause));
    assert!(ARROWS.iter().zip(taken).all(|(arrow, times)| times > 0 || !is_called(arrow)), "{taken:?}");
    assert!(done > few / 10, "{done}");
}

struct Program {
    axis: Axis,
    feedback: AxisFeedback,
    enable: bool,
    last: Option<Setpoint>,
    done: usize,
    /// Cycles between two calls of a block, on average.
    patience: u64,
    execute: [bool; BLOCKS],
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
    set: SetPosition,
    factors: SetOverride,
    factor: SetOverrideInputs,
}

/// Blocks with Execute.
const BLOCKS: usize = 13;

/// Their names, in the order in which they are called.
const NAMES: [BlockName; BLOCKS] = [
    BlockName::Home,
    BlockName::Stop,
    BlockName::Halt,
    BlockName::MoveAbsolute,
    BlockName::Reset,
    BlockName::MoveAbsolute,
    BlockName::MoveRelative,
    BlockName::MoveAdditive,
    BlockName::MoveSuperimposed,
    BlockName::MoveVelocity,
    BlockName::MoveContinuousAbsolute,
    BlockName::TorqueControl,
    BlockName::SetPosition,
];

impl Program {
    fn new(params: AxisParams, patience: u64) -> Self {
        Self {
            axis: Axis::new(params).unwrap(),
            feedback: AxisFeedback::default(),
            enable: false,
            last: None,
            done: 0,
            patience,
            execute: [false; BLOCKS],
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
            set: SetPosition::default(),
            factors: SetOverride::default(),
            factor: SetOverrideInputs { enable: true, ..SetOverrideInputs::default() },
        }
    }

    fn cycle(&mut self, random: &mut SplitMix, place: &str, taken: &mut [usize]) {
        let before = self.axis.state();
        self.axis.begin(&self.feedback);
        self.passed(before, place, taken);
        self.call(random, place, taken);
        let command = self.axis.end();
        self.check(&command, place);
        self.drive(&command, random);
    }

    /// The state has changed along an arrow, if at all; several at once only through Standstill.
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

    fn call(&mut self, random: &mut SplitMix, place: &str, taken: &mut [usize]) {
        if random.once_in(if self.enable { 2000 } else { 20 }) {
            self.enable = !self.enable;
        }
        let before = self.axis.state();
        let negative = !random.once_in(5000);
        self.power.step(
            &mut self.axis,
            &PowerInputs { enable: self.enable, enable_positive: true, enable_negative: negative },
        );
        self.passed(before, place, taken);
        if random.once_in(100) {
            self.factor = SetOverrideInputs {
                enable: true,
                vel_factor: if random.once_in(8) { 0.0 } else { random.between(0.1, 1.0) },
                acc_factor: if random.once_in(4) { random.between(0.5, 1.0) } else { 1.0 },
                jerk_factor: if random.once_in(4) { random.between(0.5, 1.0) } else { 1.0 },
            };
        }
        self.factors.step(&mut self.axis, &self.factor);
        for (block, execute) in self.execute.iter_mut().enumerate() {
            let quick = if block == 4 { 10 } else { self.patience };
            if random.once_in(if *execute { 20 } else { quick }) {
                *execute = !*execute;
            }
        }
        for (block, name) in NAMES.into_iter().enumerate() {
            let before = self.axis.state();
            let execute = self.execute[block];
            self.call_block(block, execute, random);
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
    }

    fn call_block(&mut self, block: usize, execute: bool, random: &mut SplitMix) {
        let limits = random.limits(self.axis.params().limits);
        let axis = &mut self.axis;
        let deceleration = random.between(0.3, 1.0) * limits.acceleration;
        let continuous_update = random.once_in(4);
        let buffer_mode = random.one_of(&[
            BufferMode::Aborting,
            BufferMode::Buffered,
            BufferMode::BlendingLow,
            BufferMode::BlendingPrevious,
            BufferMode::BlendingNext,
            BufferMode::BlendingHigh,
        ]);
        let is_modulo = axis.params().modulo.is_some();
        let direction = match random.one_of(&[Direction::Positive, Direction::Negative, Direction::Current]) {
            _ if !is_modulo || random.once_in(3) => Direction::Shortest,
            direction => direction,
        };
        let position = if is_modulo { random.between(0.0, 2.999) } else { random.between(-1.0, 1.0) };
        let distance = random.between(-0.4, 0.4);
        let done = match block {
            0 => {
                self.home
                    .step(axis, &HomeInputs { execute: execute && random.once_in(4), position: 0.5, buffer_mode })
                    .done
            }
            1 => self.stop.step(axis, &StopInputs { execute, ..StopInputs::within(&limits) }).done,
            2 => self.halt.step(axis, &HaltInputs { execute, buffer_mode, ..HaltInputs::within(&limits) }).done,
            3 | 5 => {
                let inputs = MoveAbsoluteInputs {
                    execute,
                    continuous_update,
                    position,
                    deceleration,
                    direction,
                    buffer_mode,
                    ..MoveAbsoluteInputs::within(&limits)
                };
                let outputs = self.absolute[usize::from(block == 5)].step(axis, &inputs);
                assert!(outputs.error_id != ErrorId::Plan && outputs.error_id != ErrorId::PlanLost, "{inputs:?}");
                outputs.done
            }
            4 => self.reset.step(axis, &ResetInputs { execute }).done,
            6 => {
                let inputs = MoveRelativeInputs { execute, distance, ..MoveRelativeInputs::within(&limits) };
                self.relative
                    .step(axis, &MoveRelativeInputs { continuous_update, buffer_mode, deceleration, ..inputs })
                    .done
            }
            7 => {
                let inputs = MoveAdditiveInputs { execute, distance, ..MoveAdditiveInputs::within(&limits) };
                self.additive.step(axis, &MoveAdditiveInputs { continuous_update, buffer_mode, ..inputs }).done
            }
            8 => {
                let inputs = MoveSuperimposedInputs { execute, distance, ..MoveSuperimposedInputs::within(&limits) };
                self.on_top.step(axis, &MoveSuperimposedInputs { continuous_update, ..inputs }).done
            }
            9 => {
                let inputs = MoveVelocityInputs { execute, ..MoveVelocityInputs::within(&limits) };
                let direction = random.one_of(&[Direction::Positive, Direction::Negative, Direction::Current]);
                self.velocity.step(axis, &MoveVelocityInputs { continuous_update, buffer_mode, direction, ..inputs });
                false
            }
            10 => {
                let end_velocity = random.between(-1.0, 1.0) * limits.velocity;
                let inputs = MoveContinuousAbsoluteInputs { execute, ..MoveContinuousAbsoluteInputs::within(&limits) };
                let inputs = MoveContinuousAbsoluteInputs { position, end_velocity, direction, buffer_mode, ..inputs };
                self.continuous.step(axis, &inputs);
                false
            }
            11 => {
                let inputs = TorqueControlInputs { torque: distance, ..TorqueControlInputs::within(&limits) };
                let inputs = TorqueControlInputs { execute: execute && random.once_in(4), torque_ramp: 10.0, ..inputs };
                self.torque.step(axis, &TorqueControlInputs { velocity: LIMITS.velocity, ..inputs });
                false
            }
            _ => self.set.step(axis, &SetPositionInputs { execute, position: 0.1, relative: true }).done,
        };
        self.done += usize::from(done && matches!(block, 3 | 5 | 6 | 7));
    }

    /// What is commanded: nothing from an axis that is disabled, and no jump.
    fn check(&mut self, command: &AxisCommand, place: &str) {
        let (state, limits) = (self.axis.state(), self.axis.params().limits);
        let is_disabled = state == AxisState::Disabled;
        assert!(!is_disabled || !command.power || self.feedback.power != DrivePower::On, "{place}");
        assert!(!matches!(command.task, Task::Home { .. }) || state == AxisState::Homing, "{place}");
        let Task::Follow(sample) = command.task else {
            assert!(matches!(state, AxisState::Homing | AxisState::ContinuousMotion), "{place}: {state}");
            self.last = None;
            return;
        };
        if is_disabled {
            assert!(
                (sample.x - self.feedback.position).abs() == 0.0 || self.last.is_none(),
                "{place}: moves a disabled axis"
            );
        }
        let commanded = self.axis.commanded();
        let now = Setpoint { x: sample.x, ..commanded };
        let follows = is_disabled || (state == AxisState::ErrorStop && self.feedback.power != DrivePower::On);
        if let Some(last) = self.last.filter(|_| !follows) {
            let h = CYCLE_TIME;
            // The mean of each derivative over a cycle is within its limit. Two motions on top of each other and limits that were
            // higher before keep those of the axis together; the margin is rounding.
            let step = |name, one: f64, other: f64, limit: f64, rounding: f64| {
                let mean = (other - one).abs() / h;
                assert!(
                    mean <= limit * (1.0 + 1e-6) + rounding,
                    "{place} in {state}: {name} {mean} {limit}\n{last:?}\n{now:?}"
                );
            };
            step("x", last.x, now.x, limits.velocity, 1e-12 / h);
            step("v", last.v, now.v, limits.acceleration, 1e-9 / h);
            if limits.jerk < f64::INFINITY {
                step("a", last.a, now.a, limits.jerk, 1e-7 / h);
            }
            if limits.snap < f64::INFINITY {
                step("j", last.j, now.j, limits.snap, 1e-5 / h);
            }
        }
        self.last = (!follows).then_some(now);
    }

    /// A drive that follows at once and fails now and then.
    fn drive(&mut self, command: &AxisCommand, random: &mut SplitMix) {
        let feedback = &mut self.feedback;
        if feedback.fault.is_none() {
            feedback.fault = random.once_in(3000).then_some(Fault::Drive(0x2310));
        } else if command.reset || random.once_in(50) {
            feedback.fault = None;
        }
        let is_on = command.power && (feedback.fault.is_none() || random.once_in(2)) && !random.once_in(3000);
        feedback.power = match feedback.power {
            DrivePower::On | DrivePower::Switching if is_on => DrivePower::On,
            DrivePower::Off if is_on => DrivePower::Switching,
            _ => DrivePower::Off,
        };
        feedback.homing = Homing::Idle;
        match command.task {
            Task::Follow(sample) if feedback.power == DrivePower::On => {
                (feedback.position, feedback.velocity) = (sample.x, sample.v);
            }
            Task::Follow(_) => feedback.velocity = 0.0,
            Task::Effort(effort) => {
                feedback.effort = effort;
                feedback.velocity = (feedback.velocity + 0.01 * effort).clamp(-1.2, 1.2);
                feedback.position += feedback.velocity * CYCLE_TIME;
            }
            Task::Home { .. } => {
                feedback.velocity = 0.0;
                feedback.homing = random.one_of(&[Homing::Busy, Homing::Busy, Homing::Attained]);
                if random.once_in(20) {
                    feedback.homing = Homing::Failed;
                }
            }
            Task::Drive(way) => panic!("no block leaves its way to the drive: {way:?}"),
        }
    }
}

/// SplitMix64 (Steele, Lea & Flood 2014).
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / 9_007_199_254_740_992.0)
    }

    fn once_in(&mut self, times: u64) -> bool {
        self.next().is_multiple_of(times)
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[usize::try_from(self.next() % choices.len() as u64).unwrap()]
    }

    /// Limits of a block: those of the axis, or so that two of them together are within them.
    fn limits(&mut self, axis: Limits) -> Limits {
        let whole = if self.once_in(2) { 1.0 } else { PART };
        let mut part = || whole * if self.once_in(2) { 1.0 } else { self.between(0.5, 1.0) };
        Limits {
            velocity: part() * axis.velocity,
            acceleration: part() * axis.acceleration,
            jerk: part() * axis.jerk,
            snap: part() * axis.snap,
        }
    }
}
