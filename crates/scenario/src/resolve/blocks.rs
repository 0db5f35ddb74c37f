//! Blocks of the firmware for imperfections of real hardware.
use crate::diagnostic::Report;
use crate::field::{Reported, Slot};
use crate::file;
use crate::resolve::estimate::Belief;
use crate::resolve::motor::Motor;
use crate::resolve::{Alternative, measurement, one_of, supervision, torque_filter};
use servobench_base::{Coordinate, Rate};
use servobench_drive::cogging::{self, Harmonic};
use servobench_drive::current::dead_time;
use servobench_drive::overload::{self, Reaction};
use servobench_drive::{Blocks, schedule};

/// Values that the blocks depend on.
pub(super) struct Known<'a> {
    pub(super) motor: Option<&'a Motor>,
    pub(super) belief: Option<&'a Belief>,
    /// Rate of the velocity loop.
    pub(super) rate: Option<Rate>,
    /// Time from an effort of the velocity loop to its effect (s).
    pub(super) lag: f64,
    pub(super) has_bus: bool,
}

pub(super) fn resolve(drive: &file::Drive, known: &Known<'_>, report: &mut Report) -> Result<Blocks, Reported> {
    let filters = torque_filter::resolve(drive, known.rate, report);
    let velocity = drive.velocity.optional()?;
    let (blocks, are_right) = velocity.map_or((Blocks::default(), Ok(())), file::Velocity::parameters);
    if let Some(velocity) = velocity
        && let (Some(span), Some(file::VelocityKind::P)) = (velocity.reference_weight.span(), velocity.kind.given())
    {
        let message = "a P loop has no `reference_weight`: it would not reach its reference";
        report.error(span, message, "write `kind = \"pi\"`");
    }
    let [motor_load, drive_load] = loads(drive, known, report);
    let (cogging, schedule) = (cogging(drive, known, report), schedule(drive, report));
    let supervision = supervision::resolve(drive, known, report);
    let measures_dc_link = match drive.current.optional()? {
        Some(current) => current.measured_dc_link.optional()?.copied().unwrap_or(false),
        None => false,
    };
    let measurement = measurement::resolve(drive, known, report);
    let (acceleration, position) = (measurement::acceleration(drive, report), measurement::position(drive, report));
    are_right?;
    Ok(Blocks {
        filters: filters?,
        cogging: cogging?,
        motor_load: motor_load?,
        drive_load: drive_load?,
        schedule: schedule?,
        supervision: supervision?,
        measures_dc_link,
        measurement: measurement?,
        acceleration: acceleration?,
        position: position?,
        ..blocks
    })
}

type Load = Result<Option<overload::Params>, Reported>;

fn loads(drive: &file::Drive, known: &Known<'_>, report: &mut Report) -> [Load; 2] {
    let given = match drive.i2t.optional() {
        Ok(Some(given)) => given,
        Ok(None) => return [Ok(None), Ok(None)],
        Err(Reported) => return [Err(Reported), Err(Reported)],
    };
    let max_current = match known.motor {
        Some(Motor::Pmsm { max_current, .. }) => *max_current,
        Some(_) => {
            report.warning(given.span, "`i2t` is not used: the motor has no current", "");
            return [Ok(None), Ok(None)];
        }
        None => return [Err(Reported), Err(Reported)],
    };
    [("motor", &given.motor), ("drive", &given.drive)].map(|(name, slot)| {
        let Some(given) = slot.optional()? else { return Ok(None) };
        load(given, &format!("drive.i2t.{name}"), max_current, known.has_bus, report).map(Some)
    })
}

fn load(
    given: &file::ThermalLoad,
    path: &str,
    max_current: f64,
    has_bus: bool,
    report: &mut Report,
) -> Result<overload::Params, Reported> {
    let continuous_current = *given.continuous_current.given().ok_or(Reported)?;
    let ways = [("time_constant", given.time_constant.span()), ("peak_time", given.peak_time.span())];
    let time_constant = match one_of(&ways, report) {
        Alternative::Use(0) => *given.time_constant.given().ok_or(Reported)?,
        Alternative::Use(_) => {
            let at = given.peak_time.at().ok_or(Reported)?;
            let found = overload::Params::time_constant_of(continuous_current, max_current, at.value);
            found.ok_or_else(|| {
                let message =
                    format!("`motor.max_current`, {max_current:.5} A (peak), is not above the continuous current");
                report.error(at.span, message, "give `time_constant`, or less `continuous_current`");
                Reported
            })?
        }
        Alternative::Contradiction => return Err(Reported),
        Alternative::None => {
            report.missing_with_help(path, "time_constant", given.span, "or `peak_time`");
            return Err(Reported);
        }
    };
    let reaction = given.reaction.optional()?.copied().unwrap_or_default();
    if reaction == Reaction::Fault && !has_bus {
        let span = given.reaction.span().unwrap_or(given.span);
        report.error(span, "without a `[bus]` no fault can be reported", "write \"derate\", or add `[bus]`");
        return Err(Reported);
    }
    Ok(overload::Params { continuous_current, time_constant, reaction })
}

fn cogging(drive: &file::Drive, known: &Known<'_>, report: &mut Report) -> Result<Option<cogging::Params>, Reported> {
    let Some(given) = drive.cogging.optional()? else { return Ok(None) };
    if let Some(ninth) = given.0.get(cogging::MOST) {
        let message = format!("more than {} harmonics of cogging", cogging::MOST);
        report.error(ninth.span, message, "leave the smallest ones out");
        return Err(Reported);
    }
    // For a rotary motor the order is per revolution, for a linear one per electrical period.
    let ratio = match (report.motor, known.motor) {
        (Some(Coordinate::Linear), Some(Motor::Pmsm { motor, .. })) => motor.electrical_ratio,
        (Some(Coordinate::Linear), _) => {
            let span = drive.cogging.span().ok_or(Reported)?;
            report.error(span, "a linear motor without poles has no cogging", "");
            return Err(Reported);
        }
        _ => 1.0,
    };
    let harmonic = |at: &file::CoggingHarmonic| {
        let (order, amplitude) = (*at.order.given()?, *at.amplitude.given()?);
        let phase = at.phase.optional().ok()?.copied().unwrap_or(0.0);
        Some(Harmonic { ratio: f64::from(order) * ratio, amplitude, phase })
    };
    let harmonics = given.0.iter().map(|at| harmonic(&at.value)).collect::<Option<Vec<_>>>().ok_or(Reported)?;
    cogging::Params::new(&harmonics, known.lag).map(Some).map_err(|_| Reported)
}

fn schedule(drive: &file::Drive, report: &mut Report) -> Result<Option<schedule::Params>, Reported> {
    let Some(given) = drive.gain_schedule.optional()? else { return Ok(None) };
    let or_one = |slot: &Slot<f64>| Ok::<_, Reported>(slot.optional()?.copied().unwrap_or(1.0));
    let (from, to) = (*given.from.given().ok_or(Reported)?, given.to.at().ok_or(Reported)?);
    if to.value <= from {
        report.error(to.span, "`to` must be above `from`", "");
        return Err(Reported);
    }
    Ok(Some(schedule::Params {
        from,
        to: to.value,
        position: or_one(&given.position)?,
        velocity: or_one(&given.velocity)?,
    }))
}

/// Dead-time compensation with the drive's estimate `dc_link` (V) of the link voltage.
pub(super) fn dead_time(given: &file::Current, dc_link: f64) -> Result<Option<dead_time::Params>, Reported> {
    let Some(given) = given.dead_time_compensation.optional()? else { return Ok(None) };
    Ok(Some(dead_time::Params {
        dead_time: *given.dead_time.given().ok_or(Reported)?,
        frequency: *given.frequency.given().ok_or(Reported)?,
        linear_zone: given.linear_zone.optional()?.copied().unwrap_or(0.0),
        dc_link,
    }))
}
