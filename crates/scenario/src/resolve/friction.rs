//! Converts the keys of a body's friction to the friction used by engines.
use super::axis::or_zero;
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file::FrictionKeys;
use servobench_base::Coordinate;
use servobench_config::quantities::EFFORT;
use servobench_plant::{DryFriction, Friction};

/// The friction of a body whose own coordinate is `motion`.
pub(super) fn resolve(keys: &FrictionKeys<'_>, motion: Coordinate, report: &mut Report) -> Option<Friction> {
    let dry = dry(keys, motion, report);
    Some(Friction { viscous: or_zero(keys.viscous)?, dry: dry? })
}

fn dry(keys: &FrictionKeys<'_>, motion: Coordinate, report: &mut Report) -> Option<DryFriction> {
    let FrictionKeys { coulomb, breakaway, stribeck_velocity, .. } = *keys;
    if let (Some(sliding), Some(resting)) = (coulomb.at(), breakaway.at())
        && resting.value < sliding.value
    {
        let unit = if motion == Coordinate::Linear { EFFORT.linear.unit } else { EFFORT.rotary.unit };
        let [above, below] = [sliding.value, resting.value].map(|effort| format!("{effort} {unit}"));
        // A value of the scenario is blamed before one of its model.
        let (span, message) = if sliding.span.source < resting.span.source {
            (sliding.span, format!("`coulomb` is {above}, above `static`, which is {below}"))
        } else {
            (resting.span, format!("`static` is {below}, below `coulomb`, which is {above}"))
        };
        let both = if sliding.span.source == resting.span.source { "" } else { ": give both here" };
        report.error(span, message, format!("friction at rest is at least that of sliding{both}"));
        return None;
    }
    if let (Slot::Absent, Some(span)) = (breakaway, stribeck_velocity.span()) {
        report.warning(span, "`stribeck_velocity` has no effect without `static`", "");
    }
    let coulomb = or_zero(coulomb)?;
    let breakaway = breakaway.optional().ok()?.copied().unwrap_or(coulomb);
    Some(DryFriction { coulomb, breakaway, stribeck_velocity: or_zero(stribeck_velocity)? })
}
