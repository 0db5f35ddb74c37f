//! From the tables of a file to a [`Scenario`]: defaults, derived values, and the rules that concern several keys.

mod axis;
mod bandwidth;
mod block;
mod blocks;
mod bus;
mod bus_fault;
mod cams;
mod condition;
mod coupling;
mod current;
mod disturbance;
mod drive;
mod end_stops;
mod estimate;
mod filter;
mod fmu;
mod friction;
mod inputs;
mod inverter;
mod keys;
mod loops;
mod measurement;
mod mode;
mod motor;
mod motor_effects;
mod plc;
mod points;
mod profile;
mod program;
mod requirements;
mod rockwell;
mod sensors;
mod supervision;
mod time;
mod torque_filter;
mod torque_limit;
mod whole;

use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::{File, MotorKind, Run};
use crate::limit_table::LimitTable;
use crate::list::BoundOrNone;
use crate::scenario::{BusMode, LONGEST_RUN, Record, Scenario, TimeBound};
use crate::simple::MAX_RATE;
use crate::source::{At, Authority, Sources, Span};
use servobench_base::Rate;
use servobench_metrics::{DisplayUnits, Limit, Question};
use servobench_plant::EngineName;
use std::collections::BTreeSet;

pub(crate) use axis::motor_motion;

/// The scenario; `None` if a part cannot be resolved. Mistakes go to `report`.
pub(crate) fn scenario(file: &File, sources: &Sources, report: &mut Report) -> Option<Scenario> {
    let run = file.run.given();
    let base_rate = run.and_then(|run| run.base_rate.given().copied());
    let axis = file.axis.given();
    let motor = file.motor.given();
    let is_prescribed = motor.is_some_and(|motor| motor.kind.given() == Some(&MotorKind::Prescribed));

    let files = fmu::Known { base_rate, sources, actuator: None };
    let mechanics = fmu::mechanics(file, files, report);
    let moved = axis
        .zip(motor)
        .zip(mechanics)
        .and_then(|((axis, motor), fmu)| axis::resolve(axis, motor, fmu, sources, report));
    let source = motor.and_then(|motor| motor::resolve(motor, sources, report));
    let known = drive::Known { base_rate, axis: moved.as_ref(), motor: source.as_ref() };
    let actuator = drive::resolve(file, &known, report);
    report.counts = bus::counts(file, actuator.as_ref(), report);
    let program = program::steps(file, base_rate, sources, report);
    let interpolation = filter::interpolation(file, base_rate, report);
    if let Some(actuator) = &actuator {
        bandwidth::check(file, actuator, report);
        torque_limit::check(file, actuator, report);
    }
    let duration = run.and_then(|run| duration(run, report));
    time::check(file, program.as_deref(), report);
    let bus = bus::resolve(file, &bus::Known { base_rate, duration, actuator: actuator.as_ref() }, report);
    if let Some(Some(bus)) = &bus {
        bus::refuse_by_program(file, bus, program.as_deref(), report);
    }
    let modulo = axis.map_or(&Slot::Absent, |axis| &axis.modulo);
    let mode = file.bus.given().and_then(|bus| bus.mode.given());
    let is_told_velocities = mode == Some(&BusMode::ProfileVelocity);
    let plc = plc::resolve(file, &plc::Known { duration, modulo, is_told_velocities, sources }, report);
    let of_run = requirements::Known {
        duration,
        has_bus: file.bus.span().is_some(),
        plc: plc.as_ref().and_then(Option::as_ref),
        has_ends: axis.is_none_or(|axis| axis.end_stops.span().or(axis.mjcf.span()).is_some()),
        warms_up: motor.is_none_or(|motor| motor.thermal.span().is_some()),
    };
    let requirements = requirements::resolve(file, &of_run, report);
    refuse_home_at(file, report);
    let fixed = is_prescribed.then(|| disturbance::Fixed::of(moved.as_ref()));
    let timing = disturbance::Timing { base_rate, duration };
    let coupling = coupling::resolve(file, base_rate, report);
    let fmus = fmu::others(file, coupling.as_ref(), fmu::Known { actuator: actuator.as_ref(), ..files }, report);
    let disturbances = disturbance::disturbances(file, &timing, fixed, report);
    let initial = disturbance::initial(file, fixed, report);
    if let Some(axis) = &moved {
        end_stops::refuse(file, axis, &initial, fixed, report);
    }
    let record = record(file, base_rate, report);
    let limits = file.limits.given().map_or_else(Vec::new, |given| limits(given, has_window(file), report));
    say_rates_of_models(file, base_rate, report);
    if is_prescribed && let Some(span) = file.drive.span() {
        report.warning(span, "`drive` is not used: the motor follows the set-point exactly", "");
    }

    let engines = match &file.engine {
        Slot::Absent => vec![EngineName::default()],
        Slot::Wrong(_) => return None,
        Slot::Given(engines) => distinct(&engines.value.0, report),
    };
    Some(Scenario {
        name: file.name.given().cloned().unwrap_or_default(),
        description: file.description.given().cloned().unwrap_or_default(),
        path: None,
        engines,
        base_rate: base_rate?,
        duration,
        time_limit: run.and_then(|run| run.time_limit.given()).map(|limit| match limit {
            BoundOrNone::None => TimeBound::Unlimited,
            BoundOrNone::Given(seconds) => TimeBound::AtMost(*seconds),
        }),
        warnings: Vec::new(),
        axis: moved?,
        actuator: actuator?,
        program: program?,
        interpolation: interpolation?,
        bus: bus?,
        plc: plc?,
        fmus: fmus?,
        coupling: coupling?,
        disturbances: disturbances?,
        initial,
        record: record?,
        measure: file.measure.given().map_or_else(Question::default, |measure| Question {
            window: measure.window.given().copied(),
            home_at: measure.home_at.given().copied(),
            from: measure.from.given().copied(),
            mode: measure.mode.given().copied(),
            ..Question::default()
        }),
        requirements: requirements?,
        limits,
        parameters: Vec::new(),
        units: DisplayUnits::new(report.axis?.unit()),
        overrides: Vec::new(),
        root: None,
        made_of: Vec::new(),
    })
}

fn distinct(engines: &[At<EngineName>], report: &mut Report) -> Vec<EngineName> {
    let mut all = Vec::new();
    for engine in engines {
        if all.contains(&engine.value) {
            report.error(engine.span, "this engine is named twice", "");
        } else {
            all.push(engine.value);
        }
    }
    all
}

/// Length of the run (s), if given.
fn duration(run: &Run, report: &mut Report) -> Option<f64> {
    let given = run.duration.at()?;
    if given.value > LONGEST_RUN {
        report.error(given.span, format!("a run lasts {LONGEST_RUN} s at most, got {} s", given.value), "");
    }
    Some(given.value)
}

fn record(file: &File, base_rate: Option<Rate>, report: &mut Report) -> Option<Record> {
    let Some(record) = file.record.given() else { return Some(Record { rate: base_rate?, channels: Vec::new() }) };
    let rate = match record.rate {
        Slot::Absent => base_rate,
        _ => task_rate(&record.rate, base_rate, report),
    };
    let channels = record.channels.given().map(|names| names.0.iter().map(|name| name.value).collect());
    Some(Record { rate: rate?, channels: channels.unwrap_or_default() })
}

fn has_window(file: &File) -> bool {
    file.measure.given().is_some_and(|measure| measure.window.span().is_some())
}

/// Without homing there is no zero to be checked; on a modulo axis it recurs every turn. A homed axis is on a bus, which has units:
/// there is always a window.
fn refuse_home_at(file: &File, report: &mut Report) {
    let Some(at) = file.measure.given().and_then(|measure| measure.home_at.at()) else { return };
    let homes = |call: &At<crate::file::Call>| call.value.block.given().is_none_or(|block| block.homes());
    let is_homed = file.call.given().is_some_and(|calls| calls.0.iter().any(homes));
    if !is_homed {
        let message = "`home_at` is the position of the zero after homing, and nothing homes the axis";
        report.error(at.span, message, "call \"MC_Home\", or leave `home_at` out");
    }
    if let Some(axis) = file.axis.given()
        && axis.modulo.span().is_some()
    {
        report.error(at.span, "`home_at` is for an axis that is not modulo", "leave it out");
    }
}

fn limits(limits: &LimitTable, has_window: bool, report: &mut Report) -> Vec<Limit> {
    for limit in &limits.0 {
        if !has_window && limit.value.metric.needs_window() {
            let message = format!("`{}` needs a settling window", limit.value.metric);
            report.error(limit.span, message, "give `window` in `[measure]`");
        }
    }
    limits.0.iter().map(|limit| limit.value).collect()
}

/// The value of a required key.
fn need<T: Clone>(slot: &Slot<T>, path: &str, key: &str, header: Span, report: &mut Report) -> Option<T> {
    if matches!(slot, Slot::Absent) {
        report.missing(path, key, header);
    }
    slot.given().cloned()
}

/// A task rate, which must divide the base rate. Rates from models are reported together by [`say_rates_of_models`].
fn task_rate(slot: &Slot<Rate>, base_rate: Option<Rate>, report: &mut Report) -> Option<Rate> {
    let rate = slot.at()?;
    let is_of_model = rate.span.source.authority() == Authority::Model;
    if is_of_model {
        report.rates_of_models.push(rate.value);
    }
    match base_rate?.divider(rate.value) {
        Ok(_) => Some(rate.value),
        Err(why) => {
            if !is_of_model {
                report.error(rate.span, why.to_string(), "change it or `run.base_rate`");
            }
            None
        }
    }
}

/// Reports a base rate that rates of models do not divide: a single mistake, at the scenario's `base_rate`.
fn say_rates_of_models(file: &File, base_rate: Option<Rate>, report: &mut Report) {
    let place = file.run.given().and_then(|run| run.base_rate.span());
    let (Some(place), Some(base_rate)) = (place, base_rate) else { return };
    let rates: BTreeSet<Rate> = report.rates_of_models.iter().copied().collect();
    let wrong = rates.iter().rev().filter(|rate| base_rate.divider(**rate).is_err());
    let listed: Vec<String> = wrong.map(|rate| format!("{} Hz", rate.hertz())).collect();
    if listed.is_empty() {
        return;
    }
    let multiple = rates
        .iter()
        .map(|rate| u64::from(rate.hertz()))
        .fold(1_u64, |multiple, rate| rate.saturating_mul(multiple / greatest_divisor(multiple, rate)));
    let times = (u64::from(base_rate.hertz()) / multiple).max(1);
    let message = format!("the base rate must be a multiple of the model's rates: {}", listed.join(", "));
    let help = if multiple <= u64::from(MAX_RATE) {
        format!("write \"{} Hz\", or other rates in `[drive]`", times * multiple)
    } else {
        "write other rates in `[drive]`".to_owned()
    };
    report.error(place, message, help);
}

/// Euclid's algorithm.
const fn greatest_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

/// The one in use of several keys with the same meaning.
enum Alternative {
    /// None is given.
    None,
    /// The one with this index.
    Use(usize),
    /// Several are given, which has been reported.
    Contradiction,
}

/// Picks one of several keys with the same meaning. The command line takes precedence over the scenario, and the scenario over the
/// model; each may give only one of them.
fn one_of(keys: &[(&str, Option<Span>)], report: &mut Report) -> Alternative {
    let there = || keys.iter().enumerate().filter_map(|(i, (key, span))| Some((i, *key, (*span)?)));
    let Some(first) = there().map(|(.., span)| span.source.authority()).min() else { return Alternative::None };
    let mut ours = there().filter(|(.., span)| span.source.authority() == first);
    match (ours.next(), ours.next()) {
        (Some((_, first, _)), Some((_, second, span))) => {
            report.error(span, format!("`{first}` and `{second}` give the same quantity"), "give one of them");
            Alternative::Contradiction
        }
        (Some((i, ..)), None) => Alternative::Use(i),
        (None, _) => Alternative::None,
    }
}

/// Refuses keys without a meaning here, if the scenario itself or the command line gives them: a model may give more than is used.
fn refuse(keys: &[(&str, Option<Span>)], why: &str, help: &str, report: &mut Report) {
    for (key, span) in keys {
        if let Some(span) = span.filter(|span| span.source.authority() != Authority::Model) {
            report.error(span, format!("`{key}` {why}"), help);
        }
    }
}
