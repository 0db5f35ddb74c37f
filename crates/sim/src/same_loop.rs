//! The report of a loop, computed once for all runs that share it: a sweep mostly varies the set-point, which is not part of the loop.
use crate::error::BuildError;
use crate::linear::{AtRest, WiredSensors};
use servobench_stability::{Depth, Loop, Report, StabilityError, analyse};
use std::cell::RefCell;

/// A loop, and its report at a depth.
struct Analysed {
    model: Loop,
    sensors: WiredSensors,
    depth: Depth,
    report: Report,
}

thread_local! {
    /// The loop that this thread analysed last.
    static LAST: RefCell<Option<Analysed>> = const { RefCell::new(None) };
}

/// The report of the loop `model` with `sensors`.
///
/// # Errors
/// [`BuildError`] for a loop that cannot be built; inside, the reason why it cannot be analysed.
pub(crate) fn report(
    model: &Loop,
    sensors: &WiredSensors,
    depth: Depth,
) -> Result<Result<Report, StabilityError>, BuildError> {
    let is_same = |last: &Analysed| last.depth == depth && last.sensors == *sensors && last.model == *model;
    let known = LAST.with_borrow(|last| last.as_ref().filter(|last| is_same(last)).map(|last| last.report.clone()));
    if let Some(report) = known {
        return Ok(Ok(report));
    }
    let found = analyse(model, Box::new(AtRest::new(model, sensors, None)?), depth);
    if let Ok(report) = &found {
        let analysed = Analysed { model: model.clone(), sensors: *sensors, depth, report: report.clone() };
        LAST.set(Some(analysed));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use crate::{Analysis, analyse_stability};
    use servobench_scenario::{Document, Override};
    use servobench_stability::Depth;

    const AXIS: &str = "run.base_rate = \"16 kHz\"\n[axis]\nmotion = \"linear\"\nmotor_side.mass = \"21 kg\"\n\
        [motor]\nkind = \"ideal-source\"\n[drive.velocity]\nrate = \"4 kHz\"\nbandwidth = \"30 Hz\"\n\
        [drive.position]\nrate = \"4 kHz\"\ngain = \"60 1/s\"\n[setpoint]\norder = 2\nvelocity = \"1 m/s\"\nacceleration = \"1 m/s2\"\n\
        [[program]]\nmove_to = \"10 mm\"\n";

    /// Independent of earlier analyses: a loop has its own report, and a set-point is not part of the loop.
    #[test]
    fn a_loop_has_the_report_that_it_has_alone() {
        let report = |settings: &[&str], depth| {
            let settings: Vec<Override> = settings.iter().map(|one| one.parse().unwrap()).collect();
            let document = Document::parse("axis.toml", AXIS, None, None).unwrap_or_else(|error| panic!("{error}"));
            let scenario = document.scenario(&settings).unwrap_or_else(|error| panic!("{error}")).scenario;
            match analyse_stability(&scenario, depth, None, None) {
                Ok(Analysis::Done { report, .. }) => report,
                other => panic!("{other:?}"),
            }
        };
        // A new thread has analysed nothing before.
        let alone = |settings, depth| std::thread::spawn(move || report(settings, depth)).join().unwrap();
        let cases: [(&'static [&'static str], Depth); 6] = [
            (&[], Depth::Verdict),
            (&["setpoint.velocity=2 m/s"], Depth::Verdict),
            (&["setpoint.velocity=2 m/s"], Depth::Boundaries),
            (&["drive.position.gain=61 1/s"], Depth::Boundaries),
            (&["drive.velocity.bandwidth=5 kHz"], Depth::Verdict),
            (&[], Depth::Verdict),
        ];
        for (settings, depth) in cases {
            assert_eq!(report(settings, depth), alone(settings, depth), "{settings:?}");
        }
    }
}
