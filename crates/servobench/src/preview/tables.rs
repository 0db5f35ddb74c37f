//! Tables of function blocks: their pieces meet with steps of the acceleration, which no limit of the jerk allows.
use super::{Doubt, Units};
use servobench_metrics::Quantity;
use servobench_plcopen::program::{Call, Inputs};
use servobench_plcopen::{
    AccelerationProfileInputs, BlockInputs as _, BlockName, Follow, Pair, PositionProfileInputs, VelocityProfileInputs,
};
use servobench_scenario::{Plc, Scenario};

/// A step of this part of the largest acceleration is rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn doubts(scenario: &Scenario) -> Vec<Doubt> {
    let axis_unit = Units::of(scenario).axis;
    let of_calls = |plc: &Plc| {
        let numbered = plc.calls.iter().enumerate();
        numbered.filter_map(|(index, call)| doubt(index, call, &plc.limits, axis_unit)).collect()
    };
    scenario.plc.as_ref().map_or_else(Vec::new, of_calls)
}

fn doubt(index: usize, call: &Call, limits: &[f64; 4], axis_unit: &str) -> Option<Doubt> {
    let [_, most, jerk, _] = *limits;
    if jerk == f64::INFINITY {
        return None;
    }
    let step = step(call.block, &call.inputs)?;
    let where_it_steps = match step {
        Step::Of(step) if step > ROUNDING * most => {
            format!(
                "by up to {} between pairs of the table, begun at rest",
                Quantity::new(step, &format!("{axis_unit}/s²"))
            )
        }
        Step::At(place) => format!("where {place}"),
        Step::Of(_) => return None,
    };
    let message = format!(
        "the acceleration steps {where_it_steps}: infinite jerk, on an axis with a limit of {}",
        Quantity::new(jerk, &format!("{axis_unit}/s³"))
    );
    let help = "blocks that move to a target keep the jerk; or give the axis `order = 2`";
    Some(Doubt::new(format!("call.{index}.table"), message, help))
}

enum Step {
    /// So large (axis unit/s²).
    Of(f64),
    /// At a place.
    At(&'static str),
}

fn step(block: BlockName, inputs: &Inputs) -> Option<Step> {
    let step = match block {
        BlockName::VelocityProfile => Step::Of(step_of_velocities(VelocityProfileInputs::read(inputs, false).scaled())),
        BlockName::AccelerationProfile => {
            Step::Of(step_of_accelerations(AccelerationProfileInputs::read(inputs, false).scaled()))
        }
        BlockName::PositionProfile => match PositionProfileInputs::read(inputs, false).follow {
            Follow::Plateaus(_) => Step::At("its ramps begin and end"),
            Follow::Spline | Follow::Steps(_) => Step::At("the spline begins and ends"),
        },
        _ => return None,
    };
    Some(step)
}

/// The largest step of the acceleration where velocities are linear from pair to pair.
fn step_of_velocities(pairs: impl Iterator<Item = Pair>) -> f64 {
    let (mut velocity, mut slope, mut largest) = (0.0, 0.0_f64, 0.0_f64);
    for Pair { delta_time: length, value } in pairs {
        if length > 0.0 {
            let next = (value - velocity) / length;
            largest = largest.max((next - slope).abs());
            slope = next;
        }
        velocity = value;
    }
    largest.max(slope.abs())
}

/// The same where accelerations are piecewise linear; behind the last pair the acceleration is zero.
fn step_of_accelerations(pairs: impl Iterator<Item = Pair>) -> f64 {
    let (mut acceleration, mut largest) = (0.0_f64, 0.0_f64);
    for Pair { delta_time: length, value } in pairs {
        if length == 0.0 {
            largest = largest.max((value - acceleration).abs());
        }
        acceleration = value;
    }
    largest.max(acceleration.abs())
}
