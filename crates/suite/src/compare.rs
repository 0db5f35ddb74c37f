//! Runs side by side: each at its own limits, at equal ones, or slowed until a measured quantity is equal.
mod duration;
mod equal;
mod error;
mod limits;
mod search;
mod setpoints;

pub use duration::{to_duration, to_equal_duration};
pub use equal::{EqualError, EqualQuantity, Equalized, Measuring, Slowed, equal_metric, to_equal};
pub use error::{CompareError, NotReached};
pub use limits::limits_agree;
pub use setpoints::{only_setpoints_differ, setpoints_have_closed_form};

use crate::job::{Job, Source};
use servobench::increment;
use servobench_config::Choice as _;
use servobench_scenario::Step;

/// Checks that measurements of the jobs can stand side by side: their axes are all linear or all rotary.
///
/// # Errors
/// [`CompareError::Axes`] for the first job whose kind of axis differs from that of the first one.
pub fn comparable(jobs: &[Job]) -> Result<(), CompareError> {
    let Some((one, others)) = jobs.split_first() else { return Ok(()) };
    let kind = |job: &Job| job.scenario.axis.motion.name();
    let Some(other) = others.iter().find(|other| kind(other) != kind(one)) else { return Ok(()) };
    let (motion, other_motion) = (kind(one), kind(other));
    let (one, other) = (one.label().to_owned(), other.label().to_owned());
    Err(CompareError::Axes { one, motion, other, other_motion })
}

/// Share of the settling window within which lengths are equal: negligible at the user's choice of window.
const OF_A_WINDOW: f64 = 0.01;

/// Largest difference of equal lengths on these axes (axis unit): 1 % of the smallest settling window, or one increment of the encoder that
/// closes the position loop, the coarsest of all.
#[must_use]
pub fn equal_length(jobs: &[Job]) -> f64 {
    let windows = jobs.iter().filter_map(|job| job.scenario.measure.window);
    let window = windows.reduce(f64::min).unwrap_or_default();
    jobs.iter().map(|job| increment(&job.scenario)).fold(OF_A_WINDOW * window, f64::max)
}

/// `job` with the random numbers of `source`, which is its scenario with other seeds; its recording is not kept.
#[must_use]
pub fn reseeded(job: &Job, source: Source, id: String) -> Job {
    let mut other = job.of_source(source, id);
    if !job.durations().is_empty() {
        slow(&mut other, job.durations().to_vec());
    }
    other.leave_recording_out();
    other
}

/// Slows the moves of `job` to `durations` (s). It loses its limits, which were made for another set-point.
fn slow(job: &mut Job, durations: Vec<f64>) {
    job.slow_to(durations);
    job.scenario.limits.clear();
    for step in &mut job.scenario.program {
        if let Step::Move(step) = step {
            step.metric_limits.clear();
        }
    }
}

#[cfg(test)]
mod samples {
    use crate::job::{Job, Source, jobs};
    use servobench_plant::EngineName;

    pub(super) const ONE: &str = r#"
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
    pub(super) fn of(texts: [&str; 2]) -> Vec<Job> {
        let sources = ["one", "two"].into_iter().zip(texts).map(|(name, text)| {
            let scenario = servobench_scenario::parse(name, text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
            Source { scenario, text: text.to_owned() }
        });
        jobs(sources.collect(), &[EngineName::Exact])
    }
}

#[cfg(test)]
mod tests {
    use super::samples::{ONE, of};
    use super::*;

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
}
