//! Properties that the loop may assume of every loaded scenario.
use servobench_base::{Rate, Setpoint};
use servobench_motion::online::Target;
use servobench_planner::{Averages, Generator, Request, Shaping};
use servobench_plcopen::program::{Condition, Inputs, Rows};
use servobench_plcopen::{Absent, BlockName, Input, InputType, Pair, Value};
use servobench_scenario::*;

/// Every number is finite and has the right sign, or is infinite where that has a meaning.
pub(crate) fn check(scenario: &Scenario) {
    let Scenario { base_rate, axis, actuator, .. } = scenario;
    assert!(!scenario.engines.is_empty());
    optional("duration", scenario.duration);
    assert!(scenario.duration.is_none_or(|duration| duration <= LONGEST_RUN));
    positive("transmission", axis.transmission);
    if let AxisMechanics::Bodies(chain) = &axis.mechanics {
        assert!((1..=3).contains(&chain.bodies().len()) && chain.bodies()[0].name == "motor");
        assert_eq!(chain.check(), Ok(()));
    }
    match actuator {
        Actuator::Prescribed | Actuator::Off(_) => {}
        Actuator::Pmsm { motor, effects, wiring, encoder, dc_link, inverter, link, drive } => {
            assert_eq!(wiring.check(), Ok(()));
            assert_eq!((motor.check(), effects.check(), encoder.check()), (Ok(()), Ok(()), Ok(())));
            positive("dc_link", *dc_link);
            assert_eq!(inverter.map_or(Ok(()), |inverter| inverter.check()), Ok(()));
            assert_eq!(link.map_or(Ok(()), |link| link.check()), Ok(()));
            assert!(drive.params.current_loop().is_some() && drive.current_tuning.is_some());
            self::drive(drive, *base_rate);
        }
        Actuator::IdealSource { source, encoder, drive } => {
            positive("gain", source.gain);
            limit("limit", source.limit);
            assert_eq!(encoder.check(), Ok(()));
            assert!(drive.params.current_loop().is_none() && drive.current_tuning.is_none());
            self::drive(drive, *base_rate);
        }
    }
    scenario.program.iter().for_each(step);
    switches(axis);
    optional("modulo", axis.modulo);
    if let Some(bus) = &scenario.bus {
        self::bus(bus, scenario);
    }
    if let Some(plc) = &scenario.plc {
        assert!(scenario.bus.is_some() && scenario.duration.is_some() && scenario.program.is_empty());
        self::plc(plc);
    }
    for disturbance in &scenario.disturbances {
        not_negative("start", disturbance.start);
        limit("duration", disturbance.duration);
        finite("effort", disturbance.effort);
        optional("frequency", disturbance.frequency);
    }
    finite("load_position", scenario.initial.load_position);
    finite("load_velocity", scenario.initial.load_velocity);
    divides(scenario.record.rate, *base_rate);
    optional("window", scenario.measure.window);
    not_negative("from", scenario.measure.from.unwrap_or_default());
    optional("mode", scenario.measure.mode);
    for servobench_metrics::Limit { metric, min, max } in &scenario.limits {
        assert!(min.is_some() || max.is_some(), "{metric}");
        assert!(min.zip(*max).is_none_or(|(min, max)| min <= max), "{metric}: {min:?} to {max:?}");
        for bound in [min, max].into_iter().flatten() {
            finite(metric.as_str(), *bound);
        }
    }
}

fn drive(drive: &Drive, base_rate: Rate) {
    assert_eq!((drive.params.check(), drive.params.base_rate), (Ok(()), base_rate));
    if let Feedback::Load(encoder) = &drive.position_feedback {
        assert_eq!(encoder.check(), Ok(()));
    }
    let estimate = &drive.estimate;
    positive("estimated transmission", estimate.transmission);
    not_negative("motor_inertia", estimate.motor_inertia);
    not_negative("load_inertia", estimate.load_inertia);
    limit("stiffness", estimate.stiffness);
    not_negative("motor_viscous", estimate.motor_viscous);
    not_negative("load_viscous", estimate.load_viscous);
    not_negative("estimated coulomb", estimate.coulomb);
    finite("estimated bias", estimate.bias);
}

fn step(step: &Step) {
    match step {
        Step::Wait(length) => not_negative("wait", *length),
        Step::Move(MoveStep { request, positioning: _, hold, aborts_after, metric_limits }) => {
            let Request { generator, duration, filter, commands, table_limits } = request;
            assert!(table_limits.iter().all(|sides| sides.below > 0.0 && sides.above > 0.0), "{table_limits:?}");
            let limits = generator.limits();
            let (limited, free) = limits.split_at(self::generator(generator));
            for limit in limited {
                positive("limit of a move", *limit);
            }
            if !matches!(generator, Generator::Rockwell(_)) {
                assert!(free.iter().all(|limit| *limit == f64::INFINITY), "{limits:?}");
            }
            for Shaping { shaper, frequency, damping } in &filter.shapers {
                positive("frequency of a shaper", *frequency);
                not_negative("damping", *damping);
                if let Some(tolerable) = shaper.tolerable() {
                    positive("tolerable", tolerable);
                }
            }
            if let Some(Averages { lengths, sample_time }) = &filter.averages {
                assert!(!lengths.is_empty());
                positive("sample time of averages", *sample_time);
                for length in lengths {
                    positive("length of an average", *length);
                }
            }
            assert_eq!(*commands, None);
            not_negative("hold", *hold);
            optional("aborts_after", *aborts_after);
            optional("duration of a move", *duration);
            assert!(metric_limits.iter().all(|limit| limit.min.is_some() || limit.max.is_some()), "{metric_limits:?}");
        }
    }
}

/// Number of limits that the generator needs.
fn generator(generator: &Generator) -> usize {
    match generator {
        Generator::PointToPoint(asked) => {
            finite("target", asked.distance);
            optional("sample_time", asked.grid.map(|grid| grid.sample_time));
            generator.order()
        }
        Generator::Replanning(asked) => {
            assert_eq!(asked.from, Setpoint::default());
            match asked.target {
                Target::Position { x, v } => {
                    finite("target", x);
                    finite("end_velocity", v);
                }
                Target::Velocity(v) => finite("reach_velocity", v),
            }
            positive("negative velocity", asked.limits.velocity.below);
            positive("negative acceleration", asked.limits.acceleration.below);
            generator.order()
        }
        Generator::Rockwell(asked) => {
            finite("target", asked.operands.distance);
            positive("deceleration", asked.operands.deceleration);
            limit("maximum jerk", asked.maximum.acceleration);
            limit("maximum jerk", asked.maximum.deceleration);
            2
        }
        Generator::Table(asked) => {
            assert!(asked.knots.len() >= 2);
            0
        }
    }
}

fn switches(axis: &Axis) {
    let switches = &axis.switches;
    assert_eq!((switches.check(), switches.normally_closed), (Ok(()), false));
    let (negative, positive, index) = (switches.negative, switches.positive, switches.index);
    assert!(negative.zip(positive).is_none_or(|(negative, positive)| negative < positive));
    assert!(switches.home.as_ref().is_none_or(|home| home.start() < home.end()));
    assert!(index.is_none_or(|index| (0.0..std::f64::consts::TAU).contains(&index)));
    assert_eq!(index.is_some(), axis.motor_motion == servobench_base::Coordinate::Rotary);
}

fn bus(bus: &Bus, scenario: &Scenario) {
    assert!(scenario.actuator.drive().is_some());
    assert!(bus.cycle >= 1 && bus.motion_every >= 1 && (8..=64).contains(&bus.counter.range().ilog2()), "{bus:?}");
    assert_eq!(bus.position_loop.is_some(), bus.mode == BusMode::CyclicVelocity);
    optional("position_gain", bus.position_loop.map(|gains| gains.gain));
    optional("position_integral_time", bus.position_loop.and_then(|gains| gains.integral_time));
    let derivative = bus.position_loop.and_then(|gains| gains.derivative);
    optional("position_derivative_time", derivative.map(|derivative| derivative.time));
    assert!(derivative.is_none_or(|derivative| derivative.filter >= 0.0));
    positive("drive_timeout", bus.drive_timeout);
    assert!(bus.units.drive >= 1);
    positive("units.axis", bus.units.axis.abs());
    let mut cycles =
        bus.faults.iter().map(|fault| &fault.cycles).chain(bus.task_faults.iter().map(|fault| &fault.cycles));
    assert!(cycles.all(|cycles| !cycles.is_empty()), "{bus:?}");
    let mut objects: Vec<_> = bus.objects.iter().map(|write| (write.object.index, write.object.subindex)).collect();
    objects.sort_unstable();
    objects.dedup();
    assert_eq!(objects.len(), bus.objects.len());
}

fn plc(plc: &Plc) {
    assert!(!plc.calls.is_empty());
    plc.limits.iter().for_each(|most| limit("limit of the axis", *most));
    for call in &plc.calls {
        let conditions = [Some(call.start), call.stop].into_iter().flatten();
        for condition in conditions.chain(call.updates.iter().map(|update| update.when)) {
            self::condition(condition, plc);
        }
        limit("timeout", call.timeout);
        assert!(!call.name.is_empty());
        for inputs in [&call.inputs].into_iter().chain(call.updates.iter().map(|update| &update.inputs)) {
            self::inputs(call.block, inputs);
        }
    }
}

fn condition(condition: Condition, plc: &Plc) {
    match condition {
        Condition::AtOnce => {}
        Condition::At(time) => not_negative("at", time),
        Condition::After { call, delay, .. } => {
            assert!(call < plc.calls.len());
            not_negative("delay", delay);
        }
        Condition::Above(position) | Condition::Below(position) => finite("position", position),
    }
}

/// The inputs that a block needs are given, each with the right sign.
fn inputs(block: BlockName, inputs: &Inputs) {
    for own in block.inputs() {
        let is_needed = matches!(own.absent, Absent::Refused(_) | Absent::Limit(_));
        match (inputs.get(own.input), own.input.value_type()) {
            (Some(Value::Number(number)), InputType::Quantity(measure)) => {
                finite(own.input.key(), *number);
                assert!(measure.bound.holds(*number) && own.bound.holds(*number), "{own:?}: {number}");
            }
            (Some(Value::Table(Rows::Profile(table))), InputType::Table) => pairs(&table.pairs),
            (Some(Value::Table(Rows::Switches(switches))), InputType::Switches) => assert!(!switches.is_empty()),
            (Some(Value::Table(Rows::Tracks(_))), InputType::Tracks)
            | (Some(Value::Flag(_)), InputType::Flag)
            | (Some(Value::Direction(_)), InputType::Direction)
            | (Some(Value::BufferMode(_)), InputType::BufferMode) => {}
            (None, _) => assert!(!is_needed, "{block}: {own:?}"),
            (Some(other), _) => panic!("{block}: {own:?} is {other:?}"),
        }
    }
    assert!(inputs.number(Input::ValueScale) != Some(0.0), "{inputs:?}");
    if let (Some(velocity), true) = (inputs.number(Input::Velocity), block != BlockName::MoveVelocity) {
        positive("velocity", velocity);
    }
    if inputs.number(Input::Snap).is_some() {
        assert!(inputs.number(Input::Jerk).is_some(), "{inputs:?}");
    }
}

fn pairs(pairs: &[Pair]) {
    assert!(pairs.len() >= 2 && pairs[0].delta_time >= 0.0);
    assert!(pairs[1..].iter().all(|pair| pair.delta_time > 0.0 && pair.value.is_finite()));
}

fn finite(what: &str, value: f64) {
    assert!(value.is_finite(), "{what} is {value}");
}

fn positive(what: &str, value: f64) {
    assert!(value.is_finite() && value > 0.0, "{what} is {value}");
}

fn not_negative(what: &str, value: f64) {
    assert!(value.is_finite() && value >= 0.0, "{what} is {value}");
}

fn optional(what: &str, value: Option<f64>) {
    if let Some(value) = value {
        positive(what, value);
    }
}

/// Positive, or infinite for no limit.
fn limit(what: &str, value: f64) {
    assert!(value > 0.0, "{what} is {value}");
}

fn divides(task: Rate, base_rate: Rate) {
    assert!(base_rate.divider(task).is_ok(), "{task:?} in {base_rate:?}");
}
