//! `Profile4th`: an axis following the published [generator](crate::generator) of order 4.
//!
//! The generator only computes a reference, without an axis. Here the axis follows its set-points, like those of a profile block, from its
//! commanded position. Each move goes from rest to rest and ends by itself, so it is a Discrete Motion and begins at Standstill only; Done
//! of the axis comes with the last set-point, `CmdDone` of the generator `T_set` later.
//!
//! | output | TRUE |
//! |---|---|
//! | Ready | a rising edge of Enable starts a move |
//! | Done | the last move is over, and its settling time too |
//! | Busy | from the start of a move until Ready |
//! | Active | the axis follows the generator |
//! | CommandAborted, Error | until Enable is FALSE, for at least one cycle |
//!
//! Position, Velocity, Acceleration, `pref_add`, Jerk and `dJerk` are those of the generator; the axis follows them while Active is TRUE.
//!
//! As with the generator, a falling Enable does not end the move, and one that stays TRUE starts another as soon as the block is ready:
//! here, if `pref` differs from that of the last start.
use super::outputs::FunctionBlock;
use crate::axis::Axis;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Dynamics, Ending, Goal};
use crate::error::{BlockError, ErrorId};
use crate::generator::{self, Method, Mounting};
use crate::interface::{
    BlockInput, BlockInputs, FromValues as _, Tables, Trigger, Values, flag, limit, or, outputs, required, required_for,
};
use crate::ledger::{CommandId, Progress};
use servobench_base::{Setpoint, Stateful};
use servobench_motion::{Limits, Order};

/// Follows the generator of order 4.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub struct Profile4th {
    generator: generator::State,
    id: Option<CommandId>,
    /// Target of the last start, as long as Enable is TRUE.
    reference: Option<f64>,
    is_aborted: bool,
    error: Option<BlockError>,
}

/// Inputs of [`Profile4th`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile4thInputs {
    /// `TriggerEnable`.
    pub enable: bool,
    /// `pref`: target (m or rad).
    pub position: f64,
    /// `vel_bnd`, `acc_bnd`, `jerk_bnd` and `djerk_bnd`, of which those up to the order apply.
    pub limits: Limits,
    /// `T_set`: time from the end of a move until the block is ready for the next (s).
    pub settling_time: f64,
    /// Mounting of the motor, which may reverse the references.
    pub mounting: Mounting,
    /// Order of the switched derivative: 2, 3 or 4. The block refuses others.
    pub order: f64,
}

outputs! {
    /// Outputs of [`Profile4th`].
    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct Profile4thOutputs {
        /// `Ready`.
        ready: bool = Ready,
        /// `CmdDone`.
        done: bool = Done,
        /// Busy.
        busy: bool = Busy,
        /// Active.
        active: bool = Active,
        /// CommandAborted: another command took the axis.
        command_aborted: bool = CommandAborted,
        /// Error.
        error: bool = Error,
        /// ErrorID.
        error_id: ErrorId = ErrorId,
        /// `Position` of the generator (m or rad).
        position: f64 = Position,
        /// `Velocity`.
        velocity: f64 = Velocity,
        /// `Acceleration`.
        acceleration: f64 = Acceleration,
        /// `pref_add`: position that the move adds.
        added: f64 = Added,
        /// `Jerk`.
        jerk: f64 = Jerk,
        /// `dJerk`.
        snap: f64 = Snap,
    }
}

impl Profile4thInputs {
    /// Inputs of a move to `position` by `limits` at order 4, without a settling time; not enabled.
    #[must_use]
    pub const fn to(position: f64, limits: Limits) -> Self {
        Self { enable: false, position, limits, settling_time: 0.0, mounting: Mounting::Same, order: 4.0 }
    }
}

impl BlockInputs<'_> for Profile4thInputs {
    const TRIGGER: Trigger = Trigger::Enable;
    const INPUTS: &'static [BlockInput] =
        &[POSITION, VELOCITY, ACCELERATION, JERK, SNAP, SETTLING_TIME, REVERSED, ORDER];
    /// Inputs are taken over at a start.
    const ARE_FOLLOWED: bool = false;

    fn read<T: Tables>(values: &Values<T>, enable: bool) -> Self {
        Self {
            enable,
            position: f64::read(values, &POSITION),
            limits: Limits {
                velocity: f64::read(values, &VELOCITY),
                acceleration: f64::read(values, &ACCELERATION),
                jerk: f64::read(values, &JERK),
                snap: f64::read(values, &SNAP),
            },
            settling_time: f64::read(values, &SETTLING_TIME),
            mounting: if bool::read(values, &REVERSED) { Mounting::Opposite } else { Mounting::Same },
            order: f64::read(values, &ORDER),
        }
    }
}

const POSITION: BlockInput = required(Input::Position);
const VELOCITY: BlockInput = limit(Input::Velocity);
const ACCELERATION: BlockInput = limit(Input::Acceleration);
const JERK: BlockInput = limit(Input::Jerk);
const SNAP: BlockInput = limit(Input::Snap);
const SETTLING_TIME: BlockInput =
    required_for(Input::SettlingTime, "from the end of a profile until the block is ready for the next");
const REVERSED: BlockInput = flag(Input::Reversed, false);
const ORDER: BlockInput = or(Input::Order, 4.0);

impl FunctionBlock for Profile4th {
    const NAME: BlockName = BlockName::Profile4th;
    type Inputs<'i> = Profile4thInputs;
    type Outputs = Profile4thOutputs;

    fn step(&mut self, axis: &mut Axis, inputs: &Profile4thInputs) -> Profile4thOutputs {
        if !inputs.enable {
            (self.reference, self.is_aborted, self.error) = (None, false, None);
        }
        self.watch(axis);
        if self.is_aborted || self.error.is_some() {
            return self.outputs(&at_rest(axis));
        }
        let generated = self.generate(axis, inputs).unwrap_or_else(|error| {
            self.release(axis);
            self.error = Some(error);
            at_rest(axis)
        });
        self.outputs(&generated)
    }

    fn error(&self) -> Option<&BlockError> {
        self.error.as_ref()
    }
}

impl Profile4th {
    /// Checks that the axis still follows.
    fn watch(&mut self, axis: &Axis) {
        let Some(id) = self.id else { return };
        match axis.progress(id) {
            Progress::Aborted => self.is_aborted = true,
            Progress::Failed => self.error = axis.ledger().failure(id),
            Progress::Buffered | Progress::Active | Progress::InTarget | Progress::Done => return,
        }
        (self.id, self.generator) = (None, generator::State::default());
    }

    /// Computes one sample of the generator and leads the axis to it.
    fn generate(&mut self, axis: &mut Axis, inputs: &Profile4thInputs) -> Result<generator::Output, BlockError> {
        let &Profile4thInputs { enable, position, limits, settling_time, mounting, order } = inputs;
        let order = order_of(order)?;
        let params = generator::Params::new(axis.params().cycle_time, settling_time).map_err(|_| {
            let (input, bound) = ("T_set", "zero or more");
            BlockError::Input { block: Self::NAME, input, value: settling_time, bound }
        })?;
        let stands = axis.commanded().x;
        let input = generator::Input {
            method: Method::Step,
            order,
            reference: self.reference.unwrap_or(position),
            limits,
            enable: enable && self.reference != Some(position),
            actual_reference: stands,
            mounting,
        };
        let generated = generator::step(&params, &mut self.generator, &input);
        match self.id {
            None if self.generator.is_moving() => {
                self.id = Some(begin(axis, order, &limits, position)?);
                self.reference = Some(position);
            }
            None => {}
            Some(id) => {
                if let Some(error) = generated.error {
                    return Err(BlockError::Plan { block: Self::NAME, error });
                }
                if axis.led_cycles(id) == Some(1) {
                    // The start: the generator counts from where the axis stands in this cycle.
                    axis.begin_leading(id);
                }
                axis.lead(id, generated.set_point);
                if !self.generator.is_moving() {
                    axis.conclude(id);
                    self.id = None;
                }
            }
        }
        Ok(generated)
    }

    /// Releases an axis that has not been moved.
    fn release(&mut self, axis: &mut Axis) {
        self.generator = generator::State::default();
        if let Some(id) = self.id.take() {
            axis.lead(id, Setpoint::at_rest(axis.commanded().x));
            axis.conclude(id);
        }
    }

    fn outputs(&self, generated: &generator::Output) -> Profile4thOutputs {
        let (active, has_ended) = (self.id.is_some(), self.is_aborted || self.error.is_some());
        let ready = generated.ready && !active;
        Profile4thOutputs {
            ready,
            done: ready && generated.done,
            busy: !ready && !has_ended,
            active,
            command_aborted: self.is_aborted,
            error: self.error.is_some(),
            error_id: self.error.as_ref().map_or(ErrorId::None, BlockError::id),
            position: generated.set_point.x,
            velocity: generated.set_point.v,
            acceleration: generated.set_point.a,
            added: generated.added,
            jerk: generated.set_point.j,
            snap: generated.set_point.s,
        }
    }
}

/// Output of a reset generator: it would begin at the commanded position.
fn at_rest(axis: &Axis) -> generator::Output {
    generator::Output { set_point: Setpoint::at_rest(axis.commanded().x), ..generator::Output::default() }
}

/// Order by its number.
fn order_of(number: f64) -> Result<Order, BlockError> {
    let of_number = |order: &Order| (order.derivative() as f64).to_bits() == number.to_bits();
    [Order::Second, Order::Third, Order::Fourth].into_iter().find(of_number).ok_or(BlockError::Input {
        block: Profile4th::NAME,
        input: "ProfileOrder",
        value: number,
        bound: "2, 3 or 4",
    })
}

/// Submits the command that makes the axis follow.
fn begin(axis: &mut Axis, order: Order, limits: &Limits, position: f64) -> Result<CommandId, BlockError> {
    let block = BlockName::Profile4th;
    if !axis.has_reference(BufferMode::Aborting) {
        return Err(BlockError::NotHomed { block, value: position });
    }
    let Limits { velocity, acceleration, jerk, snap } = *limits;
    let dynamics = Dynamics {
        velocity: Some(velocity),
        acceleration,
        deceleration: acceleration,
        jerk: (order >= Order::Third).then_some(jerk),
        snap: (order >= Order::Fourth).then_some(snap),
    };
    axis.submit(Command { block, goal: Goal::Led(Ending::AtRest), dynamics, buffer_mode: BufferMode::Aborting })
}
