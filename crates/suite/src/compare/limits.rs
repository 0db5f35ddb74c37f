//! Limits that moves share.
use super::CompareError;
use crate::job::Job;
use servobench_scenario::{MoveStep, Step};

/// Checks that each move has the limits of its counterparts, as far as its order has them.
///
/// # Errors
/// [`CompareError::Moves`] when the programs differ in their number of moves, [`CompareError::Limits`].
pub fn limits_agree(jobs: &[Job]) -> Result<(), CompareError> {
    const DERIVATIVES: [&str; 4] = ["velocity", "acceleration", "jerk", "snap"];
    let Some((one, others)) = jobs.split_first() else { return Ok(()) };
    let moves = moves(one);
    for other in others {
        let other_moves = self::moves(other);
        let (one, other) = (one.label().to_owned(), other.label().to_owned());
        if moves.len() != other_moves.len() {
            let (moves, other_moves) = (moves.len(), other_moves.len());
            return Err(CompareError::Moves { one, moves, other, other_moves });
        }
        for (k, (step, other_step)) in moves.iter().zip(other_moves).enumerate() {
            let [own, other_own] = [step, &other_step].map(|step| &step.request.generator);
            let both = own.limits().into_iter().zip(other_own.limits()).zip(DERIVATIVES);
            let shared = both.take(own.order().min(other_own.order()));
            for ((value, other_value), derivative) in shared {
                if value.to_bits() != other_value.to_bits() {
                    return Err(CompareError::Limits { number: k + 1, derivative, one, value, other, other_value });
                }
            }
        }
    }
    Ok(())
}

/// The moves of a job.
fn moves(job: &Job) -> Vec<MoveStep> {
    let moves = job.scenario.program.iter().filter_map(|step| match step {
        Step::Move(step) => Some(step.clone()),
        Step::Wait(_) => None,
    });
    moves.collect()
}

#[cfg(test)]
mod tests {
    use super::super::samples::{ONE, of};
    use super::*;

    #[test]
    fn limits_agree_as_far_as_both_orders_have_them() {
        let third = ONE.replace("order = 2", "order = 3\n        jerk = \"50 m/s3\"");
        assert_eq!(limits_agree(&of([ONE, &third])), Ok(()));
        let fast = third.replace("0.5 m/s", "5 m/s");
        let error = limits_agree(&of([ONE, &fast])).unwrap_err().to_string();
        let expected = "move 1 of `one` is limited to 0.5 in velocity (SI), that of `two` to 5;";
        assert!(error.starts_with(expected), "{error}");
        let more = format!("{ONE}\n[[program]]\nmove_to = \"0 mm\"");
        assert!(matches!(limits_agree(&of([ONE, &more])), Err(CompareError::Moves { .. })));
    }
}
