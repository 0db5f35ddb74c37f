//! Runs side by side: each at its own limits, at equal ones, or slowed to equal duration.
use crate::job::Job;
use servobench_config::Choice as _;
use servobench_scenario::{MoveStep, Scenario, Step};
use servobench_sim::{BuildError, Program};
use thiserror::Error;

/// Why scenarios cannot be compared.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CompareError {
    /// Nothing that is measured of one has a meaning for the other.
    #[error(
        "`{one}` is {motion} and `{other}` {other_motion}: a length and an angle cannot be compared; compare axes of one kind"
    )]
    Axes {
        /// Name of the first scenario.
        one: String,
        /// `linear`, `rotary`.
        motion: &'static str,
        /// Name of the other.
        other: String,
        /// Its kind.
        other_motion: &'static str,
    },
    /// Moves without a counterpart cannot have its limits or its duration.
    #[error(
        "`{one}` makes {moves} moves and `{other}` {other_moves}; what is to be equal needs the same moves in each"
    )]
    Moves {
        /// Name of the first scenario.
        one: String,
        /// Its moves.
        moves: usize,
        /// Name of the other.
        other: String,
        /// Its moves.
        other_moves: usize,
    },
    /// A limit that both moves have differs.
    #[error(
        "move {number} of `{one}` is limited to {value} in {derivative} (SI), that of `{other}` to {other_value}; without \
         equal limits each runs at its own"
    )]
    Limits {
        /// Number of the move, from 1.
        number: usize,
        /// `velocity`, `acceleration`, `jerk`, `snap`.
        derivative: &'static str,
        /// Name of the first scenario.
        one: String,
        /// Its limit (SI).
        value: f64,
        /// Name of the other.
        other: String,
        /// Its limit (SI).
        other_value: f64,
    },
    /// A move cannot be planned.
    #[error("`{scenario}`: {error}")]
    Plan {
        /// Name of the scenario.
        scenario: String,
        /// Why not.
        error: BuildError,
    },
}

/// Whether what is measured of the jobs can stand side by side: their axes are all linear or all rotary.
///
/// # Errors
/// [`CompareError::Axes`] of the first job that is of another kind than the first of all.
pub fn comparable(jobs: &[Job]) -> Result<(), CompareError> {
    let Some((one, others)) = jobs.split_first() else { return Ok(()) };
    let kind = |job: &Job| job.scenario.axis.motion.name();
    let Some(other) = others.iter().find(|other| kind(other) != kind(one)) else { return Ok(()) };
    let (motion, other_motion) = (kind(one), kind(other));
    let (one, other) = (one.scenario.name.clone(), other.scenario.name.clone());
    Err(CompareError::Axes { one, motion, other, other_motion })
}

/// Whether the jobs differ in nothing but their set-points, so that what differs in the results is of those. Free are
/// names and words, the program with its limits and how long it is recorded, which channels are kept, and the limits by
/// which each run is judged on its own.
#[must_use]
pub fn only_setpoints_differ(jobs: &[Job]) -> bool {
    let Some((one, others)) = jobs.split_first() else { return true };
    others.iter().all(|other| has_same_axis_and_drive(&one.scenario, &other.scenario))
}

/// Every field is named: a new one must be thought of here.
fn has_same_axis_and_drive(one: &Scenario, other: &Scenario) -> bool {
    let Scenario {
        name: _,
        description: _,
        path: _,
        root: _,
        made_of: _,
        engines: _,
        base_rate,
        duration: _,
        axis,
        actuator,
        program: _,
        interpolation: _,
        bus,
        plc: _,
        fmus,
        coupling,
        disturbances,
        initial,
        record,
        measure,
        requirements: _,
        limits: _,
        parameters: _,
        units: _,
        overrides: _,
        time_limit: _,
    } = one;
    *base_rate == other.base_rate
        && *axis == other.axis
        && *actuator == other.actuator
        && *bus == other.bus
        && *fmus == other.fmus
        && *coupling == other.coupling
        && *disturbances == other.disturbances
        && *initial == other.initial
        // A peak between two rows is not seen.
        && record.rate == other.record.rate
        && *measure == other.measure
}

/// Whether each move has the limits of its counterparts, as far as its order has them.
///
/// # Errors
/// [`CompareError::Moves`] when the programs differ in their number of moves, [`CompareError::Limits`].
pub fn limits_agree(jobs: &[Job]) -> Result<(), CompareError> {
    const DERIVATIVES: [&str; 4] = ["velocity", "acceleration", "jerk", "snap"];
    let Some((one, others)) = jobs.split_first() else { return Ok(()) };
    let moves = moves(one);
    for other in others {
        let other_moves = self::moves(other);
        let (one, other) = (one.scenario.name.clone(), other.scenario.name.clone());
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

/// Slows every move to the longest of its counterparts, so that all jobs make the same moves in the same time. A job
/// that is slowed loses its limits: they were made for another set-point.
///
/// # Errors
/// [`CompareError::Moves`] when the programs differ in their number of moves, [`CompareError::Plan`].
pub fn to_equal_duration(jobs: &mut [Job]) -> Result<(), CompareError> {
    let durations = jobs.iter().map(durations).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = durations.first() else { return Ok(()) };
    if let Some(k) = durations.iter().position(|durations| durations.len() != first.len()) {
        let name = |k: usize| jobs[k].scenario.name.clone();
        let (moves, other_moves) = (first.len(), durations[k].len());
        return Err(CompareError::Moves { one: name(0), moves, other: name(k), other_moves });
    }
    let longest: Vec<f64> =
        (0..first.len()).map(|i| durations.iter().map(|durations| durations[i]).fold(0.0, f64::max)).collect();
    for (job, durations) in jobs.iter_mut().zip(&durations) {
        if *durations != longest {
            job.slow_to(longest.clone());
            job.scenario.limits.clear();
            for step in &mut job.scenario.program {
                if let Step::Move(step) = step {
                    step.metric_limits.clear();
                }
            }
        }
    }
    Ok(())
}

/// How long each move lasts (s).
fn durations(job: &Job) -> Result<Vec<f64>, CompareError> {
    let program = Program::new(&job.scenario)
        .map_err(|error| CompareError::Plan { scenario: job.scenario.name.clone(), error })?;
    Ok(program.durations().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Source, jobs};
    use servobench_plant::EngineName;

    const ONE: &str = r#"
        [run]
        base_rate = "4 kHz"
        [axis]
        motion = "linear"
        [axis.motor_side]
        mass = "20 kg"
        [motor]
        kind = "ideal-source"
        [drive.velocity]
        rate = "4 kHz"
        bandwidth = "80 Hz"
        [drive.position]
        rate = "4 kHz"
        gain = "60 1/s"
        [setpoint]
        order = 2
        velocity = "0.5 m/s"
        acceleration = "5 m/s2"
        [[program]]
        move_to = "50 mm"
        [measure]
        window = "10 um"
        [record]
        rate = "2 kHz"
    "#;

    /// Jobs of the texts, named `one`, `two`.
    fn of(texts: [&str; 2]) -> Vec<Job> {
        let sources = ["one", "two"].into_iter().zip(texts).map(|(name, text)| {
            let scenario = servobench_scenario::parse(name, text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
            Source { scenario, text: text.to_owned() }
        });
        jobs(sources.collect(), &[EngineName::Exact])
    }

    #[test]
    fn setpoints_names_and_limits_may_differ() {
        let other = ONE.replace("5 m/s2", "2 m/s2").replace("[run]", "[run]\nduration = \"2 s\"").replace(
            "rate = \"2 kHz\"",
            "rate = \"2 kHz\"\nchannels = [\"load.position\"]\n[limits]\nmove_time = \"1 s\"",
        );
        assert!(only_setpoints_differ(&of([ONE, &other])));
    }

    #[test]
    fn whatever_else_differs_is_no_difference_of_set_points() {
        for (from, to) in [
            ("4 kHz\"\n        [axis]", "8 kHz\"\n        [axis]"),
            ("20 kg", "21 kg"),
            ("80 Hz", "81 Hz"),
            ("60 1/s", "30 1/s"),
            ("[drive.velocity]", "[drive.feedforward]\nvelocity = true\n[drive.velocity]"),
            ("kind = \"ideal-source\"", "kind = \"ideal-source\"\nencoder = { step = \"1 um\" }"),
            ("10 um", "11 um"),
            ("rate = \"2 kHz\"", "rate = \"1 kHz\""),
            ("[measure]", "[initial]\nload_position = \"1 um\"\n[measure]"),
            ("[measure]", "[[disturbance]]\non = \"load\"\nforce = \"1 N\"\nstart = \"0 s\"\n[measure]"),
        ] {
            assert!(ONE.contains(from), "{from}");
            let jobs = of([ONE, &ONE.replace(from, to)]);
            assert!(!only_setpoints_differ(&jobs), "{to}");
            assert_eq!(comparable(&jobs), Ok(()), "{to}: it is an axis of the same kind");
        }
    }

    #[test]
    fn a_length_is_not_compared_with_an_angle() {
        let rotary = ONE
            .replace("\"linear\"", "\"rotary\"")
            .replace("mass = \"20 kg\"", "inertia = \"20 kg m2\"")
            .replace("0.5 m/s", "0.5 rad/s")
            .replace("5 m/s2", "5 rad/s2")
            .replace("50 mm", "50 mrad")
            .replace("10 um", "10 urad");
        let error = comparable(&of([ONE, &rotary])).unwrap_err().to_string();
        assert!(error.starts_with("`one` is linear and `two` rotary: a length and an angle"), "{error}");
        assert_eq!(comparable(&of([&rotary, &rotary])), Ok(()));
    }

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
}
