//! `[bus]` and `[drive.objects]`: the connection of the motion task to the drive.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::{DriveInterpolation, File};
use crate::points::Counts;
use crate::resolve::{bus_fault, mode, need, refuse, whole};
use crate::scenario::{Actuator, Bus, BusMode, Drive, DriveUnits, Feedback, ObjectWrite, Step};
use crate::source::At;
use servobench_base::{Coordinate, Rate};
use servobench_cia402::counter::Counter;
use servobench_drive::EffortFeedforward;
use servobench_drive::feedforward::Model;
use servobench_fieldbus::link::{Derivative, PositionGains};
use servobench_motion::interpolate::Mode as InterpolationMode;
use servobench_planner::PointTimes;
use std::f64::consts::TAU;

/// Parts resolved so far.
pub(super) struct Known<'a> {
    pub(super) base_rate: Option<Rate>,
    /// Length of the run (s), if the file gives it.
    pub(super) duration: Option<f64>,
    pub(super) actuator: Option<&'a Actuator>,
}

/// Default number of bus cycles from the sampling of a frame to its effect: a sample of one cycle acts in the next.
const DELAY: u32 = 1;
/// Default time that the master waits for the drive (s).
const DRIVE_TIMEOUT: f64 = 0.5;
/// Default time constant of the low-pass before the derivative, as a share of the derivative time.
const DERIVATIVE_FILTER: f64 = 0.1;
/// Default width of the counter, and true if it has a sign: the position actual value (6064h) is an `INTEGER32`.
const COUNTER: (u32, bool) = (32, true);

/// The bus between the motion task and the drive, if there is one.
#[expect(clippy::option_option, reason = "a wrong table is not the same as none")]
pub(super) fn resolve(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Option<Bus>> {
    let objects = file.drive.given().map(|drive| &drive.objects);
    let given = match &file.bus {
        Slot::Absent => {
            let why = "is for a drive on a fieldbus";
            let switches = file.axis.given().and_then(|axis| axis.switches.span());
            let written = objects.and_then(Slot::span);
            refuse(&[("switches", switches), ("objects", written)], why, "give `[bus]`", report);
            return Some(None);
        }
        Slot::Wrong(_) => return None,
        Slot::Given(bus) => &bus.value,
    };
    refuse_without_a_drive(given, known.actuator, report);
    refuse_a_second_interpolation(file, report);
    let mode = given.mode.optional().ok().map(|mode| mode.copied().unwrap_or_default());
    if let Some(mode) = mode {
        refuse_by_mode(given, mode, report);
    }
    let cycle = given.cycle.at().and_then(|cycle| whole::ticks("cycle", *cycle, known.base_rate, report));
    let motion_every = motion_every(given, cycle, known, report);
    refuse_fast_cycle(given, cycle, known, report);
    let position_loop = mode.and_then(|mode| position_loop(given, mode, report));
    let effort_offset = effort_offset(given, known.actuator, report);
    warn_of_what_is_added_twice(given, known.actuator, report);
    let margin = margin(given, cycle.zip(motion_every), known, report);
    let run_ahead = run_ahead(given, report);
    let units = units(file, given, known.actuator, report);
    let counter = counter(given, report);
    let faults = bus_fault::faults(given, cycle.zip(motion_every), known, report);
    let objects = match objects {
        Some(Slot::Given(objects)) => Some(objects.value.0.clone()),
        Some(Slot::Wrong(_)) => None,
        Some(Slot::Absent) | None => Some(Vec::<ObjectWrite>::new()),
    };
    let (faults, task_faults) = faults?;
    let flag = |slot: &Slot<bool>| slot.optional().ok().map(|value| value.copied().unwrap_or(false));
    Some(Some(Bus {
        cycle: cycle?,
        mode: mode?,
        motion_every: motion_every?,
        interpolation: given.interpolation.optional().ok()?.copied().unwrap_or(InterpolationMode::Cubic),
        drive_interpolation: match given.drive_interpolation.optional().ok()?.copied().unwrap_or_default() {
            DriveInterpolation::Linear => InterpolationMode::Linear,
            DriveInterpolation::Cubic => InterpolationMode::Cubic,
        },
        point_transfer: given.trajectory_buffer.optional().ok()?.copied().unwrap_or_default(),
        point_time: given.point_time.optional().ok()?.copied().unwrap_or(PointTimes::SPACING),
        delay: given.delay.optional().ok()?.copied().unwrap_or(DELAY),
        velocity_offset: flag(&given.velocity_offset)?,
        effort_offset: effort_offset?,
        margin: margin?,
        run_ahead: run_ahead?,
        sequencing: given.sequencing.optional().ok()?.copied().unwrap_or_default(),
        drive_timeout: given.drive_timeout.optional().ok()?.copied().unwrap_or(DRIVE_TIMEOUT),
        position_loop: position_loop?,
        counter: counter?,
        units: units?,
        velocity_from_differences: flag(&given.velocity_from_differences)?,
        reverse_switches: flag(&given.reverse_switches)?,
        faults,
        task_faults,
        objects: objects?,
    }))
}

/// Refuses a bus without a drive that can move the axis.
fn refuse_without_a_drive(given: &file::Bus, actuator: Option<&Actuator>, report: &mut Report) {
    let (message, help) = match actuator {
        Some(Actuator::Prescribed) => ("the motor follows the set-point exactly: the bus has no drive", ""),
        Some(Actuator::Off(_)) => {
            ("the power stage stays off", "leave `enabled` out of `[drive]`: the master powers the drive")
        }
        Some(Actuator::Pmsm { .. } | Actuator::IdealSource { .. }) | None => return,
    };
    report.error(given.span, message, help);
}

fn refuse_a_second_interpolation(file: &File, report: &mut Report) {
    if let Some(span) = file.setpoint.given().and_then(|setpoint| setpoint.interpolation.span()) {
        let help = "give `motion_cycle` and `interpolation` in `[bus]`";
        report.error(span, "with a fieldbus the master interpolates", help);
    }
}

/// Refuses keys that belong to another mode.
fn refuse_by_mode(given: &file::Bus, mode: BusMode, report: &mut Report) {
    let offsets = [("velocity_offset", given.velocity_offset.span()), ("effort_offset", given.effort_offset.span())];
    if !mode.is_cyclic() {
        refuse(&offsets, "is for the modes \"csp\" and \"csv\"", "the drive generates the profile here", report);
    }
    if !mode.is_cyclic() {
        let key = [("margin", given.margin.span()), ("run_ahead", given.run_ahead.span())];
        refuse(&key, "is for the modes \"csp\" and \"csv\"", "elsewhere nothing is predicted", report);
    }
    if mode != BusMode::CyclicPosition {
        let key = [("drive_interpolation", given.drive_interpolation.span())];
        refuse(&key, "is for the mode \"csp\"", "", report);
    }
    if mode != BusMode::InterpolatedPosition {
        let key = [("trajectory_buffer", given.trajectory_buffer.span()), ("point_time", given.point_time.span())];
        refuse(&key, "is for the mode \"ip\"", "only there the drive moves through the points of a buffer", report);
    }
}

fn motion_every(given: &file::Bus, cycle: Option<u32>, known: &Known<'_>, report: &mut Report) -> Option<u32> {
    let every = match &given.motion_cycle {
        Slot::Absent => Some(1),
        Slot::Wrong(_) => None,
        Slot::Given(at) => whole::cycles("motion_cycle", *at, cycle, known.base_rate, report),
    };
    if every == Some(1) {
        let key = [("interpolation", given.interpolation.span())];
        let help = "give `motion_cycle`, or leave it out";
        refuse(&key, "is for a motion task that is slower than the bus", help, report);
    }
    every
}

/// Slack for late commands (base ticks): the master can store at most two cycles of them.
fn margin(given: &file::Bus, cycles: Option<(u32, u32)>, known: &Known<'_>, report: &mut Report) -> Option<u32> {
    let Some(at) = given.margin.at() else { return given.margin.optional().ok().map(|_| 0) };
    let margin = whole::ticks("margin", *at, known.base_rate, report)?;
    let (cycle, every) = cycles?;
    if u64::from(margin) > 2 * u64::from(cycle) * u64::from(every) {
        report.error(at.span, "the margin is at most two cycles of the motion task", "make it shorter");
        return None;
    }
    Some(margin)
}

/// Cycles of prediction: at most up to the present.
fn run_ahead(given: &file::Bus, report: &mut Report) -> Option<u32> {
    let interpolation = given.interpolation.optional().ok()?.copied().unwrap_or(InterpolationMode::Cubic);
    let Some(at) = given.run_ahead.at() else { return given.run_ahead.optional().ok().map(|_| 0) };
    let highest = interpolation.delay_samples();
    if at.value as usize > highest {
        let message = format!("with this interpolation the delay is {highest} cycle, and no more can be predicted");
        report.error(at.span, message, format!("write {highest}, or another `interpolation`"));
        return None;
    }
    Some(at.value)
}

/// Refuses a bus cycle shorter than the period of the drive's position loop, which would miss frames.
fn refuse_fast_cycle(given: &file::Bus, cycle: Option<u32>, known: &Known<'_>, report: &mut Report) {
    let (Some(cycle), Some(span), Some(base_rate)) = (cycle, given.cycle.span(), known.base_rate) else { return };
    let Some(drive) = known.actuator.and_then(Actuator::drive) else { return };
    let rate = drive.params.position_rate();
    if u64::from(cycle) * u64::from(rate.hertz()) < u64::from(base_rate.hertz()) {
        let message = format!("the bus is faster than the position loop of the drive, {} Hz", rate.hertz());
        report.error(span, message, "give a longer `cycle`, or a higher `rate` in `[drive.position]`");
    }
}

/// The position loop of the master, if the master closes it.
#[expect(clippy::option_option, reason = "a wrong gain is not the same as none")]
fn position_loop(given: &file::Bus, mode: BusMode, report: &mut Report) -> Option<Option<PositionGains>> {
    if mode == BusMode::CyclicVelocity {
        let gain = need(&given.position_gain, "bus", "position_gain", given.span, report);
        let integral_time = given.position_integral_time.optional().ok();
        let derivative_time = given.position_derivative_time.optional().ok();
        let filter = given.position_derivative_filter.optional().ok();
        if let (Slot::Absent, Some(span)) = (&given.position_derivative_time, given.position_derivative_filter.span()) {
            let help = "give `position_derivative_time` too, or leave it out";
            report.error(span, "`position_derivative_filter` is for a derivative", help);
        }
        let derivative = derivative_time?.copied().map(|time| {
            let filter = filter.flatten().copied().unwrap_or(DERIVATIVE_FILTER * time);
            Derivative { time, filter }
        });
        return Some(Some(PositionGains { gain: gain?, integral_time: integral_time?.copied(), derivative }));
    }
    for (key, span) in [
        ("position_gain", given.position_gain.span()),
        ("position_integral_time", given.position_integral_time.span()),
        ("position_derivative_time", given.position_derivative_time.span()),
        ("position_derivative_filter", given.position_derivative_filter.span()),
    ] {
        if let Some(span) = span {
            let message = format!("`{key}` is for the mode \"csv\"");
            report.error(span, message, "here the drive closes the position loop");
        }
    }
    Some(None)
}

/// The model behind the torque offset; the estimate must contain what it needs, and there must be a rated effort.
fn effort_offset(given: &file::Bus, actuator: Option<&Actuator>, report: &mut Report) -> Option<EffortFeedforward> {
    let Some(at) = given.effort_offset.at() else {
        return given.effort_offset.optional().ok().map(|_| EffortFeedforward::Off);
    };
    let Some((actuator, Drive { estimate, .. })) = actuator.and_then(|it| Some((it, it.drive()?))) else {
        return Some(at.value);
    };
    if at.value != EffortFeedforward::Off && actuator.rated_effort().is_none() {
        let (key, example) = match report.motor {
            Some(Coordinate::Linear) => ("max_force", "300 N"),
            Some(Coordinate::Rotary) | None => ("max_torque", "12 Nm"),
        };
        let message = "the torque offset is sent in thousandths of the largest effort, and this drive has no limit";
        report.error(at.span, message, format!("give `{key}` in `[drive]`, such as \"{example}\""));
    }
    let is_heavy = estimate.motor_inertia + estimate.load_inertia > 0.0;
    let is_elastic = estimate.stiffness.is_finite() && estimate.load_inertia > 0.0;
    if at.value != EffortFeedforward::Off && !is_heavy {
        let help = "give `motor_inertia` in `[drive.estimate]`";
        report.error(at.span, "the inertia of this axis is unknown", help);
    } else if at.value == EffortFeedforward::TwoMass && !is_elastic {
        let help = "write \"rigid\", or give `stiffness` and `load_inertia` in `[drive.estimate]`";
        report.error(at.span, "the axis is rigid: it is a single mass", help);
    }
    Some(at.value)
}

/// Warns if both master and drive feed forward the same quantity.
fn warn_of_what_is_added_twice(given: &file::Bus, actuator: Option<&Actuator>, report: &mut Report) {
    let Some(feedforward) = actuator.and_then(Actuator::drive).map(|drive| &drive.params.feedforward) else { return };
    let velocity = given.velocity_offset.at().filter(|at| at.value && feedforward.velocity > 0.0);
    let effort = given.effort_offset.at().filter(|at| at.value != EffortFeedforward::Off);
    let effort = effort.filter(|_| feedforward.model != Model::Off);
    for (what, key, span) in [
        ("the velocity", "velocity", velocity.map(|at| at.span)),
        ("the torque or force", "effort", effort.map(|at| at.span)),
    ] {
        if let Some(span) = span {
            let message = format!("the drive feeds {what} forward too: it is added twice");
            report.warning(span, message, format!("leave `{key}` out of `[drive.feedforward]`, or this out"));
        }
    }
}

fn counter(given: &file::Bus, report: &mut Report) -> Option<Counter> {
    let (bits, signed) = match given.counter.optional().ok()? {
        Some(given) => (given.bits.optional().ok()?.copied(), given.signed.optional().ok()?.copied()),
        None => (None, None),
    };
    let new = if signed.unwrap_or(COUNTER.1) { Counter::signed } else { Counter::unsigned };
    new(bits.unwrap_or(COUNTER.0))
        .map_err(|error| report.error(given.counter.span().unwrap_or(given.span), error.to_string(), ""))
        .ok()
}

/// Counts of the bus, for tables in counts; mistakes in the units are not reported here.
pub(super) fn counts(file: &File, actuator: Option<&Actuator>, report: &Report) -> Option<Counts> {
    let mut unheard = Report { axis: report.axis, motor: report.motor, ..Report::default() };
    let DriveUnits { drive, axis } = units(file, file.bus.given()?, actuator, &mut unheard)?;
    Some(Counts { per: f64::from(drive) / axis, motion: report.axis? })
}

/// The units as given; the default is the increments of the encoder that closes the position loop.
fn units(file: &File, given: &file::Bus, actuator: Option<&Actuator>, report: &mut Report) -> Option<DriveUnits> {
    if let Some(units) = given.units.optional().ok()? {
        let axis = units.axis.at()?;
        if axis.value == 0.0 {
            let help =
                "give the distance of the axis, such as \"5 mm\"; negative for a motor mounted the other way round";
            report.error(axis.span, "`axis` must not be zero", help);
            return None;
        }
        return Some(DriveUnits { drive: *units.drive.given()?, axis: axis.value });
    }
    let (axis, drive) = (file.axis.given()?, actuator?.drive()?);
    let gear = axis.gear_ratio.optional().ok()?.copied().unwrap_or(1.0);
    let (counts, step, per_step, per_turn) = match drive.position_feedback {
        Feedback::Load(_) => {
            let encoder = file.drive.given()?.load_encoder.given()?;
            (&encoder.counts_per_rev, &encoder.step, 1.0, TAU)
        }
        Feedback::Motor => {
            // The lead itself rather than the lead divided and multiplied by 2π: units remain exact decimal numbers.
            let per_turn = axis.lead.given().copied().unwrap_or(TAU) / gear;
            let per_step = if report.motor == Some(Coordinate::Rotary) { per_turn / TAU } else { 1.0 };
            match file.motor.given()?.encoder.optional().ok()? {
                Some(encoder) => (&encoder.counts_per_rev, &encoder.step, per_step, per_turn),
                None => (&Slot::Absent, &Slot::Absent, per_step, per_turn),
            }
        }
    };
    match (counts, step) {
        (Slot::Given(At { value: counts, .. }), _) => Some(DriveUnits { drive: *counts, axis: per_turn }),
        (_, Slot::Given(At { value: step, .. })) => Some(DriveUnits { drive: 1, axis: step * per_step }),
        (Slot::Wrong(_), _) | (_, Slot::Wrong(_)) => None,
        (Slot::Absent, Slot::Absent) => {
            let help = "the encoder is ideal and has no increments";
            report.missing_with_help("bus", "units", given.span, help);
            None
        }
    }
}

/// Refuses calls or steps that the mode of the bus cannot carry out.
pub(super) fn refuse_by_program(file: &File, bus: &Bus, steps: Option<&[Step]>, report: &mut Report) {
    if bus.mode.is_cyclic() {
        return;
    }
    let mode_span = file.bus.given().and_then(|bus| bus.mode.span());
    if let (Some(span), Some(calls)) = (mode_span, file.call.given())
        && !calls.0.is_empty()
        && bus.mode != BusMode::ProfileVelocity
    {
        let help = "write \"csp\", \"csv\" or \"pv\"";
        report.error(span, "function blocks generate the set-points themselves", help);
    }
    let (Some(program), Some(steps)) = (file.program.given(), steps) else { return };
    for (written, step) in program.0.iter().zip(steps) {
        mode::refuse_step(bus.mode, step, written.value.span, report);
    }
}
