//! A function block with its inputs.
use crate::block::BlockName;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::TableOfPoints;
use crate::resolve::inputs::{Defaults, Inputs, either};
use crate::resolve::keys::{LIMITS, Said};
use crate::resolve::profile;
use crate::scenario::{Block, Braking, BufferMode, Command, Direction, Dynamics, Scales};
use crate::source::{At, Sources, Span};

/// What blocks need to know of the rest of the file.
pub(super) struct Context<'a> {
    pub(super) defaults: &'a Defaults<'a>,
    pub(super) is_modulo: bool,
    pub(super) sources: &'a Sources,
}

impl Context<'_> {
    /// The block `name` with the inputs `inputs`.
    pub(super) fn block(
        &self,
        name: BlockName,
        inputs: &Inputs<'_>,
        said: &mut Said,
        report: &mut Report,
    ) -> Option<Block> {
        let mut read = Reading { context: self, name, inputs, said, report };
        match name {
            BlockName::Power => {
                let [positive, negative] = inputs.permissions.map(|slot| flag_or(slot, true));
                Some(Block::Power { positive: positive?, negative: negative? })
            }
            BlockName::Reset => Some(Block::Reset),
            BlockName::ReadStatus => Some(Block::ReadStatus),
            BlockName::ReadAxisError => Some(Block::ReadAxisError),
            BlockName::ReadActualPosition => Some(Block::ReadActualPosition),
            BlockName::ReadActualVelocity => Some(Block::ReadActualVelocity),
            BlockName::ReadActualTorque => Some(Block::ReadActualTorque),
            BlockName::Home => {
                Some(Block::Home { position: read.or("position", 0.0)?, buffer_mode: read.buffer_mode()? })
            }
            BlockName::Stop => read.braking().map(Block::Stop),
            BlockName::Halt => Some(Block::Halt { braking: read.braking()?, buffer_mode: read.buffer_mode()? }),
            BlockName::MoveAbsolute => {
                let (position, direction, motion) = (read.required("position"), read.way(), read.motion("velocity"));
                let (dynamics, command) = motion?;
                Some(Block::MoveAbsolute { position: position?, direction: direction?, dynamics, command })
            }
            BlockName::MoveRelative => {
                let (distance, motion) = (read.required("distance"), read.motion("velocity"));
                let (dynamics, command) = motion?;
                Some(Block::MoveRelative { distance: distance?, dynamics, command })
            }
            BlockName::MoveAdditive => {
                let (distance, motion) = (read.required("distance"), read.motion("velocity"));
                let (dynamics, command) = motion?;
                Some(Block::MoveAdditive { distance: distance?, dynamics, command })
            }
            BlockName::MoveSuperimposed => {
                let (distance, motion) = (read.required("distance"), read.motion("velocity_difference"));
                let (dynamics, Command { continuous_update, .. }) = motion?;
                Some(Block::MoveSuperimposed { distance: distance?, dynamics, continuous_update })
            }
            BlockName::MoveVelocity => read.move_velocity(),
            BlockName::MoveContinuousAbsolute => read.move_continuous_absolute(),
            BlockName::PositionProfile => read.position_profile(),
            BlockName::VelocityProfile => {
                let pairs = read.table().and_then(|table| profile::velocities(table, self.sources, read.report));
                let scales = read.scales(&inputs.call.velocity_offset);
                Some(Block::VelocityProfile { pairs: pairs?, scales: scales?, buffer_mode: read.buffer_mode()? })
            }
            BlockName::AccelerationProfile => {
                let pairs = read.table().and_then(|table| profile::accelerations(table, self.sources, read.report));
                let scales = read.scales(&inputs.call.acceleration_offset);
                Some(Block::AccelerationProfile { pairs: pairs?, scales: scales?, buffer_mode: read.buffer_mode()? })
            }
            BlockName::SetPosition => {
                let (position, relative) = (read.required("position"), flag(&inputs.call.relative));
                Some(Block::SetPosition { position: position?, relative: relative? })
            }
            BlockName::SetOverride => {
                let factors = ["velocity_factor", "acceleration_factor", "jerk_factor"];
                let [velocity, acceleration, jerk] = factors.map(|name| read.or(name, 1.0));
                Some(Block::SetOverride { factors: [velocity?, acceleration?, jerk?] })
            }
            BlockName::TorqueControl => read.torque_control(),
            BlockName::Profile4th => read.generator(),
        }
    }
}

/// A block whose inputs are being read.
struct Reading<'a, 'r> {
    context: &'a Context<'a>,
    name: BlockName,
    inputs: &'a Inputs<'a>,
    said: &'r mut Said,
    report: &'r mut Report,
}

impl<'a> Reading<'a, '_> {
    fn span(&self) -> Span {
        self.inputs.call.span
    }

    /// A quantity that the call must have.
    fn required(&mut self, name: &str) -> Option<f64> {
        let slot = self.inputs.quantity(name);
        if matches!(slot, Slot::Absent) {
            let help = format!("{} needs it", self.name.name());
            self.report.missing_with_help("call", name, self.span(), &help);
        }
        slot.given().copied()
    }

    /// A quantity that has a value when the call says nothing.
    fn or(&self, name: &str, otherwise: f64) -> Option<f64> {
        self.inputs.quantity(name).optional().ok().map(|value| value.copied().unwrap_or(otherwise))
    }

    /// A limit of the call or of `[setpoint]`.
    fn limit(&self, name: &str) -> &'a Slot<f64> {
        either(self.inputs.quantity(name), self.context.defaults.limit(name))
    }

    /// A limit that one of both must have.
    fn needed_limit(&mut self, name: &'static str) -> Option<f64> {
        let slot = self.limit(name);
        if matches!(slot, Slot::Absent) {
            let help = format!("{} needs it, here or in the call", self.name.name());
            self.said.missing(name, self.span(), &help, self.report);
        }
        slot.given().copied()
    }

    /// A limit that may be left out; the call and `[setpoint]` then have none.
    fn free_limit(&self, name: &str) -> Option<f64> {
        self.limit(name).optional().ok().map(|limit| limit.copied().unwrap_or(f64::INFINITY))
    }

    /// Limits of jerk and snap. One of snap needs one of jerk.
    fn jerk_and_snap(&mut self) -> Option<[f64; 2]> {
        let [jerk, snap] = [self.free_limit("jerk")?, self.free_limit("snap")?];
        if let (true, Some(span)) = (jerk.is_infinite() && snap.is_finite(), self.limit("snap").span()) {
            let say = |report: &mut Report| report.error(span, "a limit of snap needs one of jerk", "give `jerk` too");
            self.said.once(span, say, self.report);
            return None;
        }
        Some([jerk, snap])
    }

    /// The input `velocity` or `velocity_difference`.
    fn velocity(&mut self, name: &'static str) -> Option<f64> {
        let is_magnitude = self.name != BlockName::MoveVelocity;
        let most = if name == LIMITS[0] { self.needed_limit(name) } else { self.required(name) };
        if let (true, Some(..=0.0), Some(span)) = (is_magnitude, most, self.inputs.quantity(name).span()) {
            let message = format!("`{name}` of {} must be above zero", self.name.name());
            self.report.error(span, message, "the target says in which direction");
        }
        self.warn_beyond_the_axis();
        most
    }

    /// Velocity, which is the input `velocity`, and what leads to it; and how the motion begins.
    fn motion(&mut self, velocity: &'static str) -> Option<(Dynamics, Command)> {
        let most = self.velocity(velocity);
        let acceleration = self.needed_limit("acceleration");
        let deceleration = self.inputs.quantity("deceleration").optional().ok();
        let (jerk_and_snap, command) = (self.jerk_and_snap(), self.command());
        let acceleration = acceleration?;
        let deceleration = deceleration?.copied().unwrap_or(acceleration);
        let [jerk, snap] = jerk_and_snap?;
        Some((Dynamics { velocity: most?, acceleration, deceleration, jerk, snap }, command?))
    }

    /// A block refuses what is beyond the limits of its axis.
    fn warn_beyond_the_axis(&mut self) {
        let both = LIMITS.map(|name| (name, name)).into_iter().chain([("deceleration", "acceleration")]);
        for (input, limit) in both {
            let (Some(own), Some(most)) =
                (self.inputs.quantity(input).at(), self.context.defaults.limit(limit).given())
            else {
                continue;
            };
            if own.value.abs() > *most {
                let message = format!("beyond the `{limit}` of `[setpoint]`, {most} in SI: the block will refuse it");
                let say = |report: &mut Report| report.warning(own.span, message, "lower it or raise that");
                self.said.once(own.span, say, self.report);
            }
        }
    }

    fn braking(&mut self) -> Option<Braking> {
        self.warn_beyond_the_axis();
        let own = self.inputs.quantity("deceleration");
        let slot = either(own, self.context.defaults.limit("acceleration"));
        if matches!(slot, Slot::Absent) {
            let help = "or `acceleration` in `[setpoint]`";
            self.report.missing_with_help("call", "deceleration", self.span(), help);
        }
        let jerk_and_snap = self.jerk_and_snap();
        let [jerk, snap] = jerk_and_snap?;
        Some(Braking { deceleration: *slot.given()?, jerk, snap })
    }

    fn command(&self) -> Option<Command> {
        let continuous_update = flag(&self.inputs.call.continuous_update)?;
        Some(Command { buffer_mode: self.buffer_mode()?, continuous_update })
    }

    fn buffer_mode(&self) -> Option<BufferMode> {
        self.inputs.call.buffer_mode.optional().ok().map(|mode| mode.copied().unwrap_or_default())
    }

    /// Which way round a modulo axis.
    fn way(&mut self) -> Option<Direction> {
        if let (false, Some(span)) = (self.context.is_modulo, self.inputs.direction.span()) {
            let message = "`direction` is ignored: on an axis with ends one way leads to a position";
            let help = "give the period `modulo` in `[axis]`, or leave it out";
            self.said.once(span, |report| report.warning(span, message, help), self.report);
        }
        self.inputs.direction.optional().ok().map(|way| way.copied().unwrap_or(Direction::Shortest))
    }

    /// Direction of a velocity or torque beside its sign.
    fn sign(&mut self) -> Option<Direction> {
        let given = self.inputs.direction.optional().ok()?.copied().unwrap_or(Direction::Positive);
        if let (Direction::Shortest, Some(span)) = (given, self.inputs.direction.span()) {
            let message = format!("{} does not go this way", self.name.name());
            self.report.error(span, message, "write \"positive\", \"negative\" or \"current\"");
        }
        Some(given)
    }

    /// The table of a profile.
    fn table(&mut self) -> Option<&'a At<TableOfPoints>> {
        let call = self.inputs.call;
        if matches!(call.table, Slot::Absent) {
            self.report.missing_with_help("call", "table", call.span, &format!("{} needs it", self.name.name()));
        }
        call.table.at()
    }

    /// What becomes of the pairs of the table, to which `offset` is added.
    fn scales(&mut self, offset: &Slot<f64>) -> Option<Scales> {
        let call = self.inputs.call;
        if let Some(zero) = call.value_scale.at().filter(|scale| scale.value == 0.0) {
            self.report.error(zero.span, "`value_scale` must not be 0", "leave it out, or give a factor");
        }
        let or = |slot: &Slot<f64>, otherwise| slot.optional().ok().map(|value| value.copied().unwrap_or(otherwise));
        Some(Scales { time: or(&call.time_scale, 1.0)?, value: or(&call.value_scale, 1.0)?, offset: or(offset, 0.0)? })
    }

    fn move_velocity(&mut self) -> Option<Block> {
        let (direction, motion) = (self.sign(), self.motion("velocity"));
        let (dynamics, command) = motion?;
        let velocity = dynamics.velocity;
        let dynamics = Dynamics { velocity: velocity.abs(), ..dynamics };
        Some(Block::MoveVelocity { velocity, direction: direction?, dynamics, command })
    }

    fn move_continuous_absolute(&mut self) -> Option<Block> {
        let (position, end_velocity) = (self.required("position"), self.required("end_velocity"));
        let (direction, motion) = (self.way(), self.motion("velocity"));
        let (dynamics, command) = motion?;
        let (position, end_velocity, direction) = (position?, end_velocity?, direction?);
        if let (true, Some(span)) =
            (end_velocity.abs() > dynamics.velocity, self.inputs.quantity("end_velocity").span())
        {
            let message = format!("beyond the velocity limit, {} in SI", dynamics.velocity);
            self.report.error(span, message, "lower it or raise `velocity`");
        }
        Some(Block::MoveContinuousAbsolute { position, end_velocity, direction, dynamics, command })
    }

    fn torque_control(&mut self) -> Option<Block> {
        let (torque, torque_ramp) = (self.required("torque"), self.or("torque_ramp", f64::INFINITY));
        let (direction, velocity, command) = (self.sign(), self.velocity("velocity"), self.command());
        Some(Block::TorqueControl {
            torque: torque?,
            torque_ramp: torque_ramp?,
            velocity: velocity?,
            direction: direction?,
            command: command?,
        })
    }

    fn position_profile(&mut self) -> Option<Block> {
        let table = self.table()?;
        let follow = profile::follow(table, self.report);
        let pairs = profile::positions(table, self.context.sources, self.report);
        let scales = self.scales(&self.inputs.call.position_offset);
        Some(Block::PositionProfile {
            pairs: pairs?,
            scales: scales?,
            is_relative: flag(&table.value.relative)?,
            follow: follow?,
            end_velocity: self.or("end_velocity", 0.0)?,
            buffer_mode: self.buffer_mode()?,
        })
    }

    fn generator(&mut self) -> Option<Block> {
        let position = self.required("position");
        let limits = LIMITS.map(|name| self.needed_limit(name));
        let call = self.inputs.call;
        if matches!(call.settling_time, Slot::Absent) {
            let help = "from the end of a profile until the block is ready for the next";
            self.report.missing_with_help("call", "settling_time", call.span, help);
        }
        let [velocity, acceleration, jerk, snap] = limits;
        Some(Block::Profile4th {
            position: position?,
            limits: [velocity?, acceleration?, jerk?, snap?],
            settling_time: *call.settling_time.given()?,
            reversed: flag(&call.reversed)?,
        })
    }
}

/// Something that is not so unless the call says it.
fn flag(slot: &Slot<bool>) -> Option<bool> {
    flag_or(slot, false)
}

fn flag_or(slot: &Slot<bool>, otherwise: bool) -> Option<bool> {
    slot.optional().ok().map(|value| value.copied().unwrap_or(otherwise))
}
