//! The operands of Rockwell's axis move.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::resolve::{Alternative, one_of, refuse};
use crate::source::At;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape, ShapeKind};
use servobench_planner::Rockwell;

/// Operands of Rockwell's move that are limits of moves in general.
pub(super) struct Operands<'a> {
    /// Limits of velocity and acceleration (SI), if given.
    pub(super) limits: Option<[f64; 2]>,
    pub(super) acceleration: &'a Slot<f64>,
    /// Jerk in the table that contains `rockwell`, which must not contradict it.
    pub(super) jerk_beside: &'a Slot<f64>,
    /// Jerk, from any table.
    pub(super) jerk: &'a Slot<f64>,
}

/// The move over `distance` with these keys.
pub(super) fn resolve(
    keys: &At<file::Rockwell>,
    operands: &Operands<'_>,
    distance: Option<f64>,
    report: &mut Report,
) -> Option<Rockwell> {
    let own = &keys.value;
    let kind = own.shape.given().copied();
    let deceleration = own.deceleration.optional().ok()?.or(operands.acceleration.given()).copied();
    let up = [
        ("jerk", operands.jerk_beside),
        ("jerk_of_time", &own.jerk_of_time),
        ("jerk_of_maximum", &own.jerk_of_maximum),
        ("jerk_time", &own.jerk_time),
        ("jerk_master_units", &own.jerk_master_units),
    ];
    let down = [
        ("deceleration_jerk", &own.deceleration_jerk),
        ("deceleration_jerk_of_time", &own.deceleration_jerk_of_time),
        ("deceleration_jerk_of_maximum", &own.deceleration_jerk_of_maximum),
        ("deceleration_jerk_time", &own.deceleration_jerk_time),
        ("deceleration_jerk_master_units", &own.deceleration_jerk_master_units),
    ];
    if kind == Some(ShapeKind::Trapezoid) {
        let parts: Vec<_> = up[1..].iter().chain(&down).map(|(key, slot)| (*key, slot.span())).collect();
        refuse(&parts, "is for an S-curve", "a trapezoid takes `maximum_jerk`", report);
    }
    let master_speed = master_speed(own, report);
    let up = said_jerk(up, master_speed, report);
    let down = said_jerk(down, master_speed, report);
    let maximum = own.maximum_jerk.optional().ok()?.copied();
    let maximum_down = own.maximum_deceleration_jerk.optional().ok()?.copied().or(maximum);
    let (up, down) = (up.ok()?, down.ok()?);
    let shape = match kind? {
        ShapeKind::Trapezoid => Shape::Trapezoid,
        ShapeKind::SCurve => {
            let Some(up) = up.or(operands.jerk.given().copied().map(Jerk::Value)) else {
                let message = "an S-curve needs the jerk of its acceleration";
                let help = "give `jerk`, `jerk_of_time`, `jerk_of_maximum`, `jerk_time` or `jerk_master_units`";
                report.error(keys.span, message, help);
                return None;
            };
            Shape::SCurve { acceleration: up, deceleration: down.unwrap_or(up) }
        }
    };
    let needs_maximum = match shape {
        Shape::Trapezoid => Some("a trapezoid"),
        Shape::SCurve { acceleration, deceleration } => [acceleration, deceleration]
            .iter()
            .any(|jerk| matches!(jerk, Jerk::PercentOfMaximum(_)))
            .then_some("a part of the maximum"),
    };
    if let (Some(what), None) = (needs_maximum, maximum) {
        report.error(keys.span, format!("{what} needs `maximum_jerk`"), "that for which the axis is configured");
        return None;
    }
    // Not required if no operand depends on it.
    let [acceleration, deceleration_jerk] = [maximum, maximum_down].map(|jerk| jerk.unwrap_or(f64::INFINITY));
    let maximum = MaximumJerk { acceleration, deceleration: deceleration_jerk };
    let ([speed, acceleration], distance, deceleration) = (operands.limits?, distance?, deceleration?);
    Some(Rockwell { operands: Move { distance, speed, acceleration, deceleration, shape }, maximum })
}

/// The speed of the master, required by jerk in master units; otherwise it is not used.
fn master_speed(own: &file::Rockwell, report: &mut Report) -> f64 {
    let in_master_units = own.jerk_master_units.span().or(own.deceleration_jerk_master_units.span());
    match (in_master_units, own.master_speed.span()) {
        (Some(span), None) => {
            report.error(span, "jerk in master units needs `master_speed`", "give the master units per second");
        }
        (None, Some(span)) => {
            let help = "give `jerk_master_units`, or leave it out";
            report.error(span, "`master_speed` is for jerk in master units", help);
        }
        _ => {}
    }
    own.master_speed.given().copied().unwrap_or(f64::NAN)
}

/// The jerk from one of five keys: value, share of the time, share of the maximum, time, master units.
///
/// # Errors
/// A mistake that has been reported.
fn said_jerk(
    keys: [(&'static str, &Slot<f64>); 5],
    master_speed: f64,
    report: &mut Report,
) -> Result<Option<Jerk>, ()> {
    let which = match one_of(&keys.map(|(key, slot)| (key, slot.span())), report) {
        Alternative::Use(which) => which,
        Alternative::None => return Ok(None),
        Alternative::Contradiction => return Err(()),
    };
    let value = *keys[which].1.given().ok_or(())?;
    Ok(Some(match which {
        0 => Jerk::Value(value),
        1 => Jerk::PercentOfTime(100.0 * value),
        2 => Jerk::PercentOfMaximum(100.0 * value),
        3 => Jerk::Time(value),
        _ if master_speed.is_nan() => return Err(()),
        _ => Jerk::MasterUnits { way: value, speed: master_speed },
    }))
}
