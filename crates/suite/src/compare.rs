//! The same axis under different set-points: at equal limits, or slowed to equal duration.
use crate::execute::RunError;
use crate::job::Job;
use servobench_sim::{BuildError, Program};

/// Slows every move to the longest of its counterparts, so that all jobs make the same moves in the same time.
///
/// # Errors
/// [`RunError::Input`] when the programs differ in their number of moves, or a move cannot be planned.
pub fn to_equal_duration(jobs: &mut [Job]) -> Result<(), RunError> {
    let durations = jobs
        .iter()
        .map(|job| Ok(Program::plan(&job.scenario.program)?.moves("").map(|made| made.end - made.start).collect()))
        .collect::<Result<Vec<Vec<f64>>, BuildError>>()?;
    let moves = durations.iter().map(Vec::len).min().unwrap_or(0);
    if let Some((job, _)) = jobs.iter().zip(&durations).find(|(_, durations)| durations.len() != moves) {
        let words = format!(
            "`{}` makes another number of moves than the others; equal durations need the same moves in each",
            job.scenario.name
        );
        return Err(RunError::Input(words));
    }
    let longest: Vec<f64> =
        (0..moves).map(|i| durations.iter().map(|durations| durations[i]).fold(0.0, f64::max)).collect();
    for job in jobs {
        job.slow_to(longest.clone());
    }
    Ok(())
}
