//! An axis with an ideal drive: the command of one cycle is the feedback of the next.
use servobench_fieldbus::{AxisCommand, AxisFeedback, Homing, Power, ProfileCommand, Task};
use servobench_motion::Limits;
use servobench_plcopen::{Axis, AxisParams, AxisState, FunctionBlock, Power as MovePower, PowerInputs};

pub(crate) const CYCLE_TIME: f64 = 1e-3;
/// The published example of a snap-limited move: 1 m in 1.35 s (Lambrechts, Boerlage & Steinbuch 2005).
pub(crate) const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

/// Axis, drive and MC_Power.
pub(crate) struct Bench {
    pub(crate) axis: Axis,
    pub(crate) feedback: AxisFeedback,
    pub(crate) enable: bool,
    pub(crate) permits_negative: bool,
    pub(crate) command: Option<AxisCommand>,
    /// Homing state that the drive reports while it is commanded to home.
    pub(crate) homing: Homing,
}

impl Bench {
    pub(crate) fn disabled(params: AxisParams) -> Self {
        let axis = Axis::new(params).unwrap();
        Self {
            axis,
            feedback: AxisFeedback::default(),
            enable: false,
            permits_negative: true,
            command: None,
            homing: Homing::Busy,
        }
    }

    pub(crate) fn params() -> AxisParams {
        AxisParams { needs_homing: false, buffered_commands: 4, ..AxisParams::new(CYCLE_TIME, LIMITS) }
    }

    /// At Standstill at position 0.
    pub(crate) fn standstill() -> Self {
        Self::powered(Self::params())
    }

    pub(crate) fn powered(params: AxisParams) -> Self {
        let mut bench = Self::disabled(params);
        bench.enable = true;
        for _ in 0..3 {
            bench.cycle(|_| ());
        }
        assert_eq!(bench.axis.state(), AxisState::Standstill);
        bench
    }

    /// One cycle: feedback, MC_Power, what `program` calls, and the command.
    pub(crate) fn cycle<T>(&mut self, program: impl FnOnce(&mut Axis) -> T) -> T {
        self.axis.begin(&self.feedback);
        let inputs = PowerInputs { enable: self.enable, enable_positive: true, enable_negative: self.permits_negative };
        MovePower.step(&mut self.axis, &inputs);
        let answer = program(&mut self.axis);
        let command = self.axis.end();
        self.command = Some(command);
        self.feedback.power = if command.power && self.feedback.fault.is_none() { Power::On } else { Power::Off };
        self.feedback.homing = Homing::Idle;
        match command.task {
            Task::Follow(sample) => {
                (self.feedback.position, self.feedback.velocity) = (sample.x, sample.v);
            }
            Task::Home { position } => {
                self.feedback.homing = self.homing;
                if self.homing == Homing::Attained {
                    self.feedback.position = position;
                }
            }
            Task::Effort(effort) => self.feedback.effort = effort,
            Task::Drive(ProfileCommand::Velocity { velocity, acceleration }) => self.obey(velocity, acceleration),
            Task::Drive(way) => panic!("no block leaves its way to the drive: {way:?}"),
        }
        answer
    }

    /// One cycle of a drive in profile velocity, which goes to `velocity` in a straight line.
    fn obey(&mut self, velocity: f64, acceleration: f64) {
        let AxisFeedback { position, velocity: before, .. } = &mut self.feedback;
        let way = velocity - *before;
        let needed = if way == 0.0 { 0.0 } else { way.abs() / acceleration };
        // A ramp that is longer than the cycle by rounding ends with it.
        let time = if needed > CYCLE_TIME * (1.0 - 1e-9) { CYCLE_TIME } else { needed };
        let reached = if needed > CYCLE_TIME * (1.0 + 1e-9) { *before + way * time / needed } else { velocity };
        *position += time * f64::midpoint(*before, reached) + (CYCLE_TIME - time) * reached;
        *before = reached;
    }

    /// Runs cycles without a call until `state`, at most 10 000.
    pub(crate) fn until(&mut self, state: AxisState) {
        for _ in 0..10_000 {
            if self.axis.state() == state {
                return;
            }
            self.cycle(|_| ());
        }
        panic!("the axis is in {}, not in {state}", self.axis.state());
    }
}
