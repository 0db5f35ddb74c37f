//! `velocity`: the load has a velocity that is requested and held.
use super::stretch::Stretch;
use super::task::{Piece, TIME_CONSTANTS, Task};
use crate::quantity::Quantity;

/// Largest error that droop explains, as a share of the velocity.
const OF_VELOCITY: f64 = 0.5;
/// Share of the largest requested velocity by which a hold at zero is judged.
const AT_ZERO: f64 = 0.2;

/// Reasons why a velocity is not reached; `None` where none is requested for long enough.
pub(super) fn broken(task: &Task<'_>) -> Option<Vec<String>> {
    let holds: Vec<_> = task
        .pieces
        .iter()
        .filter_map(|(piece, hold)| match piece {
            Piece::Hold(velocity) => Some((*velocity, hold)),
            Piece::Way | Piece::Rest { .. } => None,
        })
        .collect();
    let largest = holds.iter().map(|(velocity, _)| velocity.abs()).fold(0.0, f64::max);
    if largest == 0.0 {
        return None;
    }
    let unit = format!("{}/s", task.recording.about.axis_unit);
    let missed = holds.into_iter().filter(|(_, hold)| !task.is_excused(&hold.rows)).filter_map(|(velocity, hold)| {
        let scale = velocity.abs().max(AT_ZERO * largest);
        let of_loop = (velocity - hold.response_velocity).abs();
        let bound = (task.rules.tolerances.velocity * scale + droop(task, hold)).min(OF_VELOCITY * scale) + of_loop;
        let off = (hold.load_velocity - velocity).abs();
        (off.is_nan() || off > bound).then(|| {
            format!(
                "the load moves at {} from {} to {}, where {} is requested (±{}){}",
                Quantity::new(hold.load_velocity, &unit),
                task.time(hold.rows.start),
                task.time(hold.rows.end - 1),
                Quantity::new(velocity, &unit),
                Quantity::new(bound, &unit),
                task.bound_by(&hold.rows)
            )
        })
    });
    Some(missed.collect())
}

/// Velocity error that bias, friction and disturbances explain. A position loop, if there is one, removes it in time, except for
/// that of a disturbance, which may have come late.
fn droop(task: &Task<'_>, hold: &Stretch) -> f64 {
    let deflection = &task.rules.deflection;
    let time = hold.rows.len() as f64 * task.recording.rate.period();
    let is_over = task.rules.servo.is_some_and(|servo| servo.gain * time >= TIME_CONSTANTS);
    if is_over {
        deflection.velocity_per_effort * task.disturbance.min(deflection.max_effort)
    } else {
        deflection.velocity_droop(task.disturbance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::requirement::tests::rules;
    use crate::requirement::{Deflection, Rules};
    use crate::synthetic::Build;
    use servobench_signals::Signal;

    /// A second at 0.4 m/s, of which the load reaches `share`.
    fn found(rules: &Rules<'_>, share: f64) -> Vec<String> {
        let recording = Build::new(1000, 1001)
            .channel(Signal::RequestPosition, "m", |t| share * 0.4 * t)
            .channel(Signal::RequestVelocity, "m/s", |_| 0.4)
            .channel(Signal::LoadPosition, "m", |t| share * 0.4 * t)
            .requests(&[(0.0, "velocity")])
            .finish();
        broken(&Task::of(&recording, rules, &[])).unwrap()
    }

    #[test]
    fn three_per_cent_and_the_droop_are_allowed_and_never_more_than_half() {
        assert_eq!(
            found(&rules(), 0.0),
            ["the load moves at 0 m/s from 500 ms to 1.00 s, where 400 mm/s is requested (±12.0 mm/s)"]
        );
        let droops = |velocity_per_effort| Rules {
            deflection: Deflection { effort: 2.0, velocity_per_effort, ..Deflection::default() },
            ..rules()
        };
        for (rules, kept, missed) in
            [(rules(), 0.971, 0.969), (rules(), -0.0, 1.031), (droops(0.02), 0.88, 0.86), (droops(1.0), 0.51, 0.49)]
        {
            assert_eq!(found(&rules, missed).len(), 1, "{missed}");
            if kept > 0.0 {
                assert_eq!(found(&rules, kept), [""; 0], "{kept}");
            }
        }
    }
}
