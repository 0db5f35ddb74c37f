//! The inputs of a function block, according to the list in `servobench_plcopen`.
use crate::block::GivenRows;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::resolve::inputs::{Defaults, Inputs};
use crate::resolve::keys::Reported;
use crate::resolve::{cams, one_of, profile, refuse};
use crate::source::{At, Sources, Span};
use servobench_config::Choice as _;
use servobench_motion::rockwell::ShapeKind;
use servobench_planner::Positioning;
use servobench_plcopen::{
    Absent, BlockInput, BlockName, Direction, Follow, Input, Pair, Table, Trigger, Value, program,
};

/// Values from the rest of the file that blocks depend on.
pub(super) struct Context<'a> {
    pub(super) defaults: &'a Defaults<'a>,
    /// Period of a modulo axis; absent for an axis with ends.
    pub(super) modulo: &'a Slot<f64>,
    /// True if the drive is in the mode profile velocity.
    pub(super) is_told_velocities: bool,
    pub(super) sources: &'a Sources,
}

impl Context<'_> {
    /// The inputs of `block` from those that a file gives, `inputs`.
    pub(super) fn inputs(
        &self,
        block: BlockName,
        inputs: &Inputs<'_>,
        said: &mut Reported,
        report: &mut Report,
    ) -> Option<program::Inputs> {
        let mut reading = Reading { context: self, block, inputs, said, report };
        reading.warn_beyond_the_axis();
        reading.check_jerks();
        // All inputs are read before the first error returns, so that every mistake is reported.
        let values: Vec<_> = block.inputs().iter().map(|own| (own.input, reading.value(own))).collect();
        let mut found = program::Inputs::default();
        for (input, value) in values {
            if let Some(value) = value.ok()? {
                found.set(input, value);
            }
        }
        reading.check_end_velocity(&found);
        Some(found)
    }
}

/// A mistake in an input has been reported.
struct Wrong;

/// A block whose inputs are being read.
struct Reading<'a, 'r> {
    context: &'a Context<'a>,
    block: BlockName,
    inputs: &'a Inputs<'a>,
    said: &'r mut Reported,
    report: &'r mut Report,
}

impl Reading<'_, '_> {
    /// The value of an input, or of the limit that replaces it; `None` where the block decides.
    fn value(&mut self, own: &BlockInput) -> Result<Option<Value<program::Rows>>, Wrong> {
        let input = own.input;
        if input == Input::Table {
            return self.table(own).map(|table| Some(Value::Table(program::Rows::Profile(table))));
        }
        self.warn_beyond_the_order(input);
        match own.absent {
            Absent::Limit(limit) if self.is_left_to_the_order(input, limit) => return Ok(None),
            Absent::Refused(why) => self.require(input, why),
            Absent::Direction(Direction::Shortest) => self.warn_without_modulo(),
            Absent::Direction(_) => self.refuse_shortest(),
            Absent::Limit(limit) => return self.needed_limit(own, limit).map(Value::Number).map(Some).ok_or(Wrong),
            Absent::LimitIfAny(limit) => return self.free_limit(input, limit).map(|limit| limit.map(Value::Number)),
            Absent::Number(_) | Absent::Flag(_) | Absent::Aborting | Absent::Nothing | Absent::As(_) => {}
        }
        if input == Input::ValueScale {
            self.refuse_zero(input);
        }
        match self.inputs.slot(input) {
            Slot::Given(At { value: Value::Number(number), .. }) => Ok(Some(Value::Number(*number))),
            Slot::Given(At { value: Value::Flag(flag), .. }) => Ok(Some(Value::Flag(*flag))),
            Slot::Given(At { value: Value::Direction(direction), .. }) => Ok(Some(Value::Direction(*direction))),
            Slot::Given(At { value: Value::BufferMode(mode), .. }) => Ok(Some(Value::BufferMode(*mode))),
            Slot::Given(At { value: Value::Choice(name), .. }) => Ok(Some(Value::Choice(name))),
            Slot::Given(At { value: Value::Table(rows), span }) => self.cams(rows, *span).map(Some),
            Slot::Absent if !matches!(own.absent, Absent::Refused(_)) => Ok(None),
            Slot::Absent | Slot::Wrong(_) => Err(Wrong),
        }
    }

    /// Reports a missing input that the call must have.
    fn require(&mut self, input: Input, why: Option<&str>) {
        if matches!(self.inputs.slot(input), Slot::Absent) {
            let help = why.map_or_else(|| format!("{} needs it", self.block), str::to_owned);
            self.report.missing_with_help("call", input.key(), self.inputs.header, &help);
        }
    }

    /// A limit from the call or from `[setpoint]`.
    fn limit(&self, input: Input, limit: Input) -> Slot<f64> {
        match self.inputs.number(input) {
            Slot::Absent => self.context.defaults.limit(limit).clone(),
            own => own,
        }
    }

    /// A limit that the call or `[setpoint]` must give.
    fn needed_limit(&mut self, own: &BlockInput, limit: Input) -> Option<f64> {
        let (input, header) = (own.input, self.inputs.header);
        let slot = self.limit(input, limit);
        if matches!(slot, Slot::Absent) && input == limit {
            let help = format!("{} needs it, here or in the call", self.block);
            self.said.missing(input.key(), header, &help, self.report);
        } else if matches!(slot, Slot::Absent) {
            let help = format!("or `{}` in `[setpoint]`", limit.key());
            self.report.missing_with_help("call", input.key(), header, &help);
        }
        let value = slot.given().copied();
        if let (Some(value), Some(span)) = (value, self.inputs.slot(input).span())
            && !own.bound.holds(value)
        {
            let message = format!("`{}` of {} must be {}", input.key(), self.block, own.bound);
            self.report.error(span, message, "the target gives the direction");
        }
        value
    }

    /// An optional limit; `None` if neither the call nor `[setpoint]` gives it. A limit of snap needs one of jerk.
    fn free_limit(&mut self, input: Input, limit: Input) -> Result<Option<f64>, Wrong> {
        let slot = self.limit(input, limit);
        if let (Input::Snap, Some(At { span, .. }), Slot::Absent) =
            (input, slot.at(), self.limit(Input::Jerk, Input::Jerk))
        {
            let span = *span;
            let say = |report: &mut Report| report.error(span, "a limit of snap needs one of jerk", "give `jerk` too");
            self.said.once(span, say, self.report);
            return Err(Wrong);
        }
        slot.optional().map(Option::<&f64>::copied).map_err(|_| Wrong)
    }

    /// Warns of values beyond the limits of the axis, which a block refuses.
    fn warn_beyond_the_axis(&mut self) {
        let is_limited = self.block.inputs().iter().any(|own| matches!(own.absent, Absent::Limit(_)));
        if !is_limited || self.block.trigger() != Trigger::Execute {
            return;
        }
        let limits = [Input::Velocity, Input::Acceleration, Input::Jerk, Input::Snap].map(|input| (input, input));
        for (input, limit) in limits.into_iter().chain([(Input::Deceleration, Input::Acceleration)]) {
            let own = self.inputs.number(input);
            let (Some(own), Some(most)) = (own.at(), self.context.defaults.limit(limit).given()) else { continue };
            if own.value.abs() > *most {
                let key = limit.key();
                let message = format!("beyond the `{key}` of `[setpoint]`, {most} in SI: the block will refuse it");
                let say = |report: &mut Report| report.warning(own.span, message, "lower it or raise that");
                self.said.once(own.span, say, self.report);
            }
        }
    }

    /// Checks the jerks of a block with a shape: each is given in a single way, and that of a trapezoid only by the axis.
    fn check_jerks(&mut self) {
        const UP: [Input; 4] = [Input::Jerk, Input::JerkOfTime, Input::JerkOfMaximum, Input::JerkTime];
        const DOWN: [Input; 4] = [
            Input::DecelerationJerk,
            Input::DecelerationJerkOfTime,
            Input::DecelerationJerkOfMaximum,
            Input::DecelerationJerkTime,
        ];
        if self.block.input(Input::Shape).is_none() {
            return;
        }
        let spans = |inputs: [Input; 4]| inputs.map(|input| (input.key(), self.inputs.slot(input).span()));
        let (up, down) = (spans(UP), spans(DOWN));
        let is_trapezoid = match self.inputs.slot(Input::Shape) {
            Slot::Given(At { value: Value::Choice(name), .. }) => *name == ShapeKind::Trapezoid.name(),
            Slot::Absent => true,
            _ => return,
        };
        if is_trapezoid {
            let help = "write `shape = \"s-curve\"`, or leave it out: a trapezoid takes the `jerk` of `[setpoint]`";
            refuse(&[up, down].concat(), "is for an S-curve", help, self.report);
            if matches!(self.context.defaults.limit(Input::Jerk), Slot::Absent) {
                let help = "a trapezoid takes the jerk that the axis is configured for";
                self.said.missing(Input::Jerk.key(), self.inputs.header, help, self.report);
            }
        } else {
            one_of(&up, self.report);
            one_of(&down, self.report);
        }
    }

    /// Warns of a direction on an axis with ends: only a modulo axis has two directions to a position.
    fn warn_without_modulo(&mut self) {
        if let (Slot::Absent, Some(span)) = (self.context.modulo, self.inputs.slot(Input::Direction).span()) {
            let message = "`direction` is ignored: on an axis with ends only one direction leads to a position";
            let help = "give the period `modulo` in `[axis]`, or leave it out";
            self.said.once(span, |report| report.warning(span, message, help), self.report);
        }
    }

    /// Refuses the shortest direction for a velocity or torque.
    fn refuse_shortest(&mut self) {
        if let Slot::Given(At { value: Value::Direction(Direction::Shortest), span }) =
            self.inputs.slot(Input::Direction)
        {
            let message = format!("{} does not have this direction", self.block);
            self.report.error(*span, message, "write \"positive\", \"negative\" or \"current\"");
        }
    }

    fn refuse_zero(&mut self, input: Input) {
        if let Some(zero) = self.inputs.number(input).at().filter(|scale| scale.value == 0.0) {
            let message = format!("`{}` must not be 0", input.key());
            self.report.error(zero.span, message, "leave it out, or give a factor");
        }
    }

    /// True for a limit that is not given and that the order of the profile does not use.
    fn is_left_to_the_order(&self, input: Input, limit: Input) -> bool {
        self.order_without(limit).is_some() && matches!(self.limit(input, limit), Slot::Absent)
    }

    /// The order of the profile, if it is too low to use `limit`.
    fn order_without(&self, limit: Input) -> Option<f64> {
        let derivative = match limit {
            Input::Jerk => 3.0,
            Input::Snap => 4.0,
            _ => return None,
        };
        self.block.input(Input::Order)?;
        self.inputs.number(Input::Order).given().copied().filter(|order| *order < derivative)
    }

    /// Warns of a limit in the call that the order of its profile does not use.
    fn warn_beyond_the_order(&mut self, input: Input) {
        let Some((order, span)) = self.order_without(input).zip(self.inputs.slot(input).span()) else { return };
        let key = input.key();
        let message = format!("`{key}` is not used by a profile of order {order}");
        let say = |report: &mut Report| report.warning(span, message, "leave it out, or give a higher `order`");
        self.said.once(span, say, self.report);
    }

    /// Checks the velocity at the target against the velocity limit.
    fn check_end_velocity(&mut self, inputs: &program::Inputs) {
        let [end, most] = [Input::EndVelocity, Input::Velocity].map(|input| inputs.number(input));
        if let (Some(end), Some(most), Some(span)) = (end, most, self.inputs.slot(Input::EndVelocity).span())
            && end.abs() > most
        {
            let message = format!("beyond the velocity limit, {most} in SI");
            self.report.error(span, message, "lower it or raise `velocity`");
        }
    }

    /// Switches and tracks of cams.
    fn cams(&mut self, rows: &GivenRows, span: Span) -> Result<Value<program::Rows>, Wrong> {
        let switches = self.inputs.slot(Input::Switches);
        let mut reading = cams::Reading { modulo: self.context.modulo, said: self.said, report: self.report };
        let rows = match (rows, switches) {
            (program::Rows::Switches(list), _) => reading.switches(list, span).map(program::Rows::Switches),
            (
                program::Rows::Tracks(list),
                Slot::Given(At { value: Value::Table(program::Rows::Switches(switches)), .. }),
            ) => reading.tracks(list, switches).map(program::Rows::Tracks),
            _ => None,
        };
        rows.map(Value::Table).ok_or(Wrong)
    }

    /// The table of a profile: the block's further inputs (offsets) decide the kind of its values.
    fn table(&mut self, own: &BlockInput) -> Result<Table<Vec<Pair>>, Wrong> {
        if let Absent::Refused(why) = own.absent {
            self.require(own.input, why);
        }
        let Slot::Given(At { value: Value::Table(program::Rows::Profile(table)), .. }) = self.inputs.slot(own.input)
        else {
            return Err(Wrong);
        };
        let sources = self.context.sources;
        let has = |input| self.block.input(input).is_some();
        if has(Input::VelocityOffset) {
            let pairs = profile::velocities(table, sources, self.report);
            return Ok(Table { pairs: pairs.ok_or(Wrong)?, is_relative: false, follow: Follow::Spline });
        }
        if has(Input::AccelerationOffset) {
            let pairs = profile::accelerations(table, sources, self.report);
            return Ok(Table { pairs: pairs.ok_or(Wrong)?, is_relative: false, follow: Follow::Spline });
        }
        let follow = profile::follow(table, self.context.is_told_velocities, self.report);
        let (pairs, positioning) = profile::positions(table, sources, self.report).ok_or(Wrong)?;
        Ok(Table { pairs, is_relative: positioning == Positioning::Relative, follow: follow.ok_or(Wrong)? })
    }
}
