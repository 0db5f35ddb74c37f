//! Limits of `torque_peak` that the drive's own limit cannot keep.
//!
//! `max_torque` bounds the request of the velocity loop. The torque of the motor follows through the current loop, whose step
//! response overshoots by some per cent (its voltage acts a period late), so a saturated torque exceeds `max_torque`.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::File;
use crate::limit_table::LimitTable;
use crate::scenario::Actuator;
use servobench_base::Coordinate;
use servobench_metrics::Name;

/// Ratio to the drive's limit up to which a limit of the motor's torque causes a warning.
const OVERSHOOT: f64 = 1.05;
/// Relative tolerance: equal values may differ by a rounding.
const ROUNDING: f64 = 1e-9;

/// Warns of limits of `torque_peak` between the drive's own limit and the overshoot of a current loop above it.
pub(super) fn check(file: &File, actuator: &Actuator, report: &mut Report) {
    let (Actuator::Pmsm { drive, .. }, Some(given), Slot::Absent) = (actuator, file.drive.given(), &file.fmu) else {
        return;
    };
    let key = if report.motor == Some(Coordinate::Linear) { "max_force" } else { "max_torque" };
    let slot = if key == "max_force" { &given.max_force } else { &given.max_torque };
    if slot.given().is_none() {
        return;
    }
    let max_effort = drive.params.velocity.max_effort;
    let doubtful = max_effort * (1.0 - ROUNDING)..=max_effort * OVERSHOOT;
    let steps = file.program.given().map_or(&[][..], |program| &program.0);
    let tables = steps.iter().map(|step| &step.value.limits).chain([&file.limits]);
    for limit in tables.filter_map(Slot::given).flat_map(|LimitTable(limits)| limits) {
        if limit.value.metric == Name::TorquePeak && limit.value.max.is_some_and(|max| doubtful.contains(&max)) {
            let message = format!("a torque at `drive.{key}` exceeds this limit: the current loop overshoots");
            let help = "`torque_peak` is that of the motor; limit `torque_reference_peak`, that of the drive's command, or leave \
                        5 % and more above";
            report.warning(limit.span, message, help);
        }
    }
}
