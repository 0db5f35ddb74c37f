//! What the loop may take for granted of every scenario that was loaded.
use servobench_base::{Rate, Setpoint};
use servobench_motion::online::Target;
use servobench_motion::shape::Shaper;
use servobench_planner::{Averages, Generator, Request, Shaping};
use servobench_scenario::*;

/// Every number is finite and on its side of zero, or infinite where that has a meaning.
pub(crate) fn check(scenario: &Scenario) {
    let Scenario { base_rate, axis, actuator, .. } = scenario;
    assert!(!scenario.engines.is_empty());
    optional("duration", scenario.duration);
    assert!(scenario.duration.is_none_or(|duration| duration <= LONGEST_RUN));
    positive("transmission", axis.transmission);
    if let AxisMechanics::Bodies(bodies) = &axis.mechanics {
        assert!((1..=3).contains(&bodies.len()) && bodies[0].name == "motor" && bodies[0].coupling.is_none());
        bodies.iter().for_each(body);
        for body in &bodies[1..] {
            coupling(body.coupling.expect("only the motor has no coupling"));
        }
    }
    match actuator {
        Actuator::Prescribed | Actuator::Off => {}
        Actuator::Pmsm { motor, dc_link, current, drive } => {
            pmsm(motor);
            positive("dc_link", *dc_link);
            self::current(current, *base_rate);
            self::drive(drive, *base_rate);
            assert!(current.rate.divider(drive.velocity.rate).is_ok(), "{:?} in {:?}", drive.velocity, current.rate);
        }
        Actuator::IdealSource { source, estimated_gain, drive } => {
            positive("gain", source.gain);
            positive("estimated gain", *estimated_gain);
            limit("limit", source.limit);
            resolution(&source.encoder);
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

fn body(body: &Body) {
    positive("inertia", body.inertia);
    not_negative("viscous", body.viscous);
    not_negative("coulomb", body.coulomb);
    finite("breakaway", body.breakaway);
    assert!(body.breakaway >= body.coulomb, "{body:?}");
    not_negative("stribeck_velocity", body.stribeck_velocity);
    finite("bias", body.bias);
}

fn coupling(coupling: Coupling) {
    positive("stiffness", coupling.stiffness);
    not_negative("damping", coupling.damping);
}

fn pmsm(motor: &Pmsm) {
    positive("electrical_ratio", motor.electrical_ratio);
    positive("resistance", motor.resistance);
    positive("inductance_d", motor.inductance_d);
    positive("inductance_q", motor.inductance_q);
    positive("flux_linkage", motor.flux_linkage);
    resolution(&motor.encoder);
}

fn resolution(encoder: &Encoder) {
    optional("resolution", encoder.resolution);
}

fn current(current: &CurrentLoop, base_rate: Rate) {
    divides(current.rate, base_rate);
    match current.gain {
        CurrentGain::Bandwidth(bandwidth) => positive("bandwidth", bandwidth),
        CurrentGain::PerAxis { d, q } => {
            positive("gain, d", d);
            positive("gain, q", q);
        }
    }
    if let Some((d, q)) = current.integral_time {
        positive("integral time, d", d);
        positive("integral time, q", q);
    }
    positive("max_current", current.max_current);
    positive("estimated dc_link", current.dc_link);
    let MotorEstimate { electrical_ratio, resistance, inductance_d, inductance_q, flux_linkage } = current.motor;
    positive("estimated electrical_ratio", electrical_ratio);
    positive("estimated resistance", resistance);
    positive("estimated inductance_d", inductance_d);
    positive("estimated inductance_q", inductance_q);
    positive("estimated flux_linkage", flux_linkage);
}

fn drive(drive: &Drive, base_rate: Rate) {
    limit("max_effort", drive.max_effort);
    let VelocityLoop { rate, gain, integral_time, filter_time } = drive.velocity;
    divides(rate, base_rate);
    not_negative("velocity gain", gain);
    optional("integral_time", integral_time);
    not_negative("filter_time", filter_time);
    divides(drive.position.rate, rate);
    not_negative("position gain", drive.position.gain);
    if let Feedback::Load(encoder) = &drive.position_feedback {
        resolution(encoder);
    }
    assert!((0.0..=1.0).contains(&drive.feedforward.velocity));
    not_negative("delay", drive.feedforward.delay.unwrap_or_default());
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
            let Request { generator, duration, filter, commands } = request;
            let limits = generator.limits();
            let (limited, free) = limits.split_at(self::generator(generator));
            for limit in limited {
                positive("limit of a move", *limit);
            }
            if !matches!(generator, Generator::Rockwell(_)) {
                assert!(free.iter().all(|limit| *limit == f64::INFINITY), "{limits:?}");
            }
            if let Some(Shaping { shaper, frequency, damping }) = filter.shaper {
                positive("frequency of a shaper", frequency);
                not_negative("damping", damping);
                if let Shaper::Ei { tolerable } = shaper {
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

/// How many limits the generator needs.
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
    let Switches { negative, positive, home, index } = axis.switches;
    for end in [negative, positive].into_iter().flatten() {
        finite("switch", end);
    }
    assert!(negative.zip(positive).is_none_or(|(negative, positive)| negative < positive));
    assert!(home.is_none_or(|home| home.from < home.to));
    assert!(index.is_none_or(|index| (0.0..std::f64::consts::TAU).contains(&index)));
    assert_eq!(index.is_some(), axis.motor_motion == servobench_base::Coordinate::Rotary);
}

fn bus(bus: &Bus, scenario: &Scenario) {
    assert!(scenario.actuator.drive().is_some());
    assert!(bus.cycle >= 1 && bus.motion_every >= 1 && (8..=32).contains(&bus.counter.bits), "{bus:?}");
    assert_eq!(bus.position_gain.is_some(), bus.mode == BusMode::CyclicVelocity);
    optional("position_gain", bus.position_gain);
    positive("drive_timeout", bus.drive_timeout);
    assert!(bus.units.drive >= 1);
    positive("units.axis", bus.units.axis);
    assert!(bus.faults.iter().all(|fault| !fault.cycles.is_empty()), "{bus:?}");
    let mut objects: Vec<_> = bus.objects.iter().map(|object| (object.index, object.subindex)).collect();
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
        let same = |update: &Update| std::mem::discriminant(&update.block) == std::mem::discriminant(&call.block);
        assert!(!call.name.is_empty() && call.updates.iter().all(same));
        for block in [&call.block].into_iter().chain(call.updates.iter().map(|update| &update.block)) {
            self::block(block);
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

fn block(block: &Block) {
    match block {
        Block::MoveAbsolute { dynamics, .. }
        | Block::MoveRelative { dynamics, .. }
        | Block::MoveAdditive { dynamics, .. }
        | Block::MoveSuperimposed { dynamics, .. }
        | Block::MoveContinuousAbsolute { dynamics, .. } => {
            positive("velocity", dynamics.velocity);
            self::dynamics(dynamics);
        }
        Block::TorqueControl { torque, torque_ramp, velocity, .. } => {
            finite("torque", *torque);
            limit("torque_ramp", *torque_ramp);
            positive("velocity", *velocity);
        }
        Block::MoveVelocity { velocity, dynamics, .. } => {
            assert_eq!(velocity.abs().to_bits(), dynamics.velocity.to_bits());
            not_negative("velocity", dynamics.velocity);
            self::dynamics(dynamics);
        }
        Block::Stop(braking) | Block::Halt { braking, .. } => positive("deceleration", braking.deceleration),
        Block::PositionProfile { pairs, scales, end_velocity, .. } => {
            self::pairs(pairs);
            self::scales(scales);
            finite("end_velocity", *end_velocity);
        }
        Block::VelocityProfile { pairs, scales, .. } | Block::AccelerationProfile { pairs, scales, .. } => {
            self::pairs(pairs);
            self::scales(scales);
        }
        Block::SetOverride { factors } => factors.iter().for_each(|factor| not_negative("factor", *factor)),
        Block::Profile4th { limits, settling_time, .. } => {
            for limit in limits {
                positive("limit", *limit);
            }
            positive("settling_time", *settling_time);
        }
        Block::Home { position, .. } | Block::SetPosition { position, .. } => finite("position", *position),
        Block::Power { .. }
        | Block::Reset
        | Block::ReadStatus
        | Block::ReadAxisError
        | Block::ReadActualPosition
        | Block::ReadActualVelocity
        | Block::ReadActualTorque => {}
    }
}

fn pairs(pairs: &[Pair]) {
    assert!(pairs.len() >= 2 && pairs[0].delta_time >= 0.0);
    assert!(pairs[1..].iter().all(|pair| pair.delta_time > 0.0 && pair.value.is_finite()));
}

fn scales(scales: &Scales) {
    positive("time_scale", scales.time);
    finite("value_scale", scales.value);
    assert!(scales.value != 0.0, "{scales:?}");
    finite("offset", scales.offset);
}

fn dynamics(dynamics: &Dynamics) {
    positive("acceleration", dynamics.acceleration);
    positive("deceleration", dynamics.deceleration);
    limit("jerk", dynamics.jerk);
    limit("snap", dynamics.snap);
    assert!(dynamics.jerk.is_finite() || dynamics.snap.is_infinite(), "{dynamics:?}");
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

/// Positive, or infinite for none.
fn limit(what: &str, value: f64) {
    assert!(value > 0.0, "{what} is {value}");
}

fn divides(task: Rate, base_rate: Rate) {
    assert!(base_rate.divider(task).is_ok(), "{task:?} in {base_rate:?}");
}
