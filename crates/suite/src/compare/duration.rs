//! Moves of equal duration.
use super::{CompareError, slow};
use crate::job::Job;
use servobench_metrics::Quantity;
use servobench_planner::Generator;
use servobench_scenario::Step;
use servobench_sim::Program;

/// Slows every move to the longest of its counterparts, so that all jobs make the same moves in the same time. A slowed job loses its
/// limits: they were made for another set-point.
///
/// # Errors
/// [`CompareError::Moves`] when the programs differ in their number of moves, [`CompareError::Plan`].
pub fn to_equal_duration(jobs: &mut [Job]) -> Result<(), CompareError> {
    let durations = jobs.iter().map(durations).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = durations.first() else { return Ok(()) };
    if let Some(k) = durations.iter().position(|durations| durations.len() != first.len()) {
        let name = |k: usize| jobs[k].label().to_owned();
        let (moves, other_moves) = (first.len(), durations[k].len());
        return Err(CompareError::Moves { one: name(0), moves, other: name(k), other_moves });
    }
    let longest: Vec<f64> =
        (0..first.len()).map(|i| durations.iter().map(|durations| durations[i]).fold(0.0, f64::max)).collect();
    for (job, durations) in jobs.iter_mut().zip(&durations) {
        if *durations != longest {
            slow(job, longest.clone());
        }
    }
    Ok(())
}

/// Slows all moves of each job in proportion, so that its longest lasts `duration` (s), and returns the factors of their durations. A
/// slowed job loses its limits.
///
/// # Errors
/// [`CompareError::TooSlow`], [`CompareError::NotSlowable`], [`CompareError::Plan`].
pub fn to_duration(jobs: &mut [Job], duration: f64) -> Result<Vec<f64>, CompareError> {
    let mut factors = Vec::new();
    for job in jobs {
        let own = slowable(job)?;
        let longest = own.iter().copied().fold(0.0, f64::max);
        // The requested duration may be typed with fewer digits than the computed one has.
        let factor = duration / longest;
        if factor < 1.0 - ROUNDING {
            let text = |value| format!("{:.5}", Quantity::new(value, "s"));
            let (shortest, wanted) = (text(longest), text(duration));
            return Err(CompareError::TooSlow { scenario: job.label().to_owned(), shortest, wanted });
        }
        if factor > 1.0 + ROUNDING {
            slow(job, own.iter().map(|one| if *one >= longest { duration } else { one * factor }).collect());
        }
        factors.push(factor.max(1.0));
    }
    Ok(factors)
}

/// Durations that differ by less, relative, are equal.
const ROUNDING: f64 = 1e-12;

/// Duration of each move (s).
///
/// # Errors
/// [`CompareError::Plan`]
pub(super) fn durations(job: &Job) -> Result<Vec<f64>, CompareError> {
    let program =
        Program::new(&job.scenario).map_err(|error| CompareError::Plan { scenario: job.label().to_owned(), error })?;
    Ok(program.durations().collect())
}

/// Duration of each move (s), if the moves may be slowed.
///
/// # Errors
/// [`CompareError::NotSlowable`], [`CompareError::Plan`].
pub(super) fn slowable(job: &Job) -> Result<Vec<f64>, CompareError> {
    let scenario = || job.label().to_owned();
    let refused = |why: String| CompareError::NotSlowable { scenario: scenario(), why };
    if job.scenario.plc.is_some() {
        return Err(refused("its moves are those of function blocks, whose inputs say how fast they are".into()));
    }
    let mut number = 0;
    for step in &job.scenario.program {
        let Step::Move(step) = step else { continue };
        number += 1;
        let why = match &step.request.generator {
            _ if step.aborts_after.is_some() => "breaks the one before off",
            _ if step.hold > 0.0 => "holds a velocity",
            Generator::Table(_) => "follows a table, whose times are part of it",
            _ => continue,
        };
        return Err(refused(format!("its move {number} {why}")));
    }
    let own = durations(job)?;
    if !own.iter().any(|duration| *duration > 0.0) {
        return Err(refused("it makes no move".into()));
    }
    let mut slower = job.clone();
    slower.slow_to(own.iter().map(|duration| 2.0 * duration).collect());
    match Program::new(&slower.scenario) {
        Ok(_) => Ok(own),
        Err(error) => Err(refused(error.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{ONE, of};
    use super::*;

    #[test]
    fn equal_durations_are_those_of_the_slower_move() {
        let limited = format!("{ONE}\n[limits]\nmove_time = \"0.52 s\"");
        let slow = limited.replace("0.5 m/s", "0.1 m/s");
        let mut jobs = of([&limited, &slow]);
        // 50 mm at 5 m/s²: the triangle lasts 2·√(0.05/5) s = 0.2 s; at 0.1 m/s the trapezoid 0.05/0.1 + 0.1/5 s.
        to_equal_duration(&mut jobs).unwrap();
        for job in &jobs {
            let lasts = durations(job).unwrap();
            assert_eq!(lasts.len(), 1);
            assert!((lasts[0] - 0.52).abs() < 1e-12, "{lasts:?}");
        }
        assert_eq!(jobs.iter().map(|job| job.scenario.limits.len()).collect::<Vec<_>>(), [0, 1]);
        let more = format!("{ONE}\n[[program]]\nmove_to = \"0 mm\"");
        let error = to_equal_duration(&mut of([ONE, &more])).unwrap_err().to_string();
        assert_eq!(error, "`one` makes 1 moves and `two` 2; what is to be equal needs the same moves in each");
    }

    #[test]
    fn a_duration_that_is_asked_for_is_that_of_the_longest_move() {
        let two = format!("{ONE}\n[[program]]\nmove_to = \"40 mm\"");
        let mut jobs = of([ONE, &two]);
        let factors = to_duration(&mut jobs, 0.25).unwrap();
        // 50 mm at 5 m/s² take 0.2 s.
        assert!(factors.iter().all(|factor| (factor - 1.25).abs() < 1e-12), "{factors:?}");
        let lasts = durations(&jobs[1]).unwrap();
        let shorter = 1.25 * 2.0 * (0.01_f64 / 5.0).sqrt();
        assert!((lasts[0] - 0.25).abs() < 1e-15 && (lasts[1] - shorter).abs() < 1e-12, "{lasts:?}");
        let error = to_duration(&mut of([ONE, ONE]), 0.1).unwrap_err().to_string();
        assert!(error.starts_with("`one` takes 200.00 ms at its own limits, longer than the 100.00 ms"), "{error}");
    }

    #[test]
    fn what_has_times_of_its_own_is_not_slowed() {
        let aborted = format!("{ONE}\n[[program]]\nmove_to = \"10 mm\"\naborts_after = \"0.1 s\"");
        let passing = ONE.replace(
            "move_to = \"50 mm\"",
            "move_to = \"50 mm\"\nend_velocity = \"0.1 m/s\"\n[[program]]\nmove_to = \"90 mm\"",
        );
        let none = ONE.replace("[[program]]\n        move_to = \"50 mm\"", "[[program]]\nwait = \"1 s\"");
        for (text, why) in [(aborted, "its move 2 breaks"), (passing, "end_velocity"), (none, "it makes no move")] {
            let error = slowable(&of([&text, ONE])[0]).unwrap_err().to_string();
            assert!(error.starts_with("`one` cannot be slowed:") && error.contains(why), "{error}");
        }
    }
}
