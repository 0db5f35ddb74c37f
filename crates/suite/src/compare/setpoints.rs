//! Runs that differ in their set-points alone, and set-points with a closed form.
use crate::job::Job;
use servobench_planner::{Generator, Method};
use servobench_scenario::{Scenario, Step};

/// True if the jobs differ in their set-points only, so that differences of the results come from these. Names and descriptions, the
/// program with its limits, the recorded length, the kept channels and the limits that judge each run are free.
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
        warnings: _,
    } = one;
    *base_rate == other.base_rate
        && *axis == other.axis
        && *actuator == other.actuator
        && *bus == other.bus
        && *fmus == other.fmus
        && *coupling == other.coupling
        && *disturbances == other.disturbances
        && *initial == other.initial
        // A peak between two rows is not recorded.
        && record.rate == other.record.rate
        && *measure == other.measure
}

/// True if the velocity of every move is a step through moving averages only, so that its peaks describe it completely: published profiles,
/// without shapers, averages and interpolation.
#[must_use]
pub fn setpoints_have_closed_form(jobs: &[Job]) -> bool {
    let is_plain = |step: &Step| match step {
        Step::Wait(_) => true,
        Step::Move(step) => {
            let filter = &step.request.filter;
            let is_published =
                matches!(&step.request.generator, Generator::PointToPoint(one) if one.method == Method::Published);
            is_published && filter.shapers.is_empty() && filter.averages.is_none()
        }
    };
    jobs.iter().all(|job| job.scenario.interpolation.is_none() && job.scenario.program.iter().all(is_plain))
}

#[cfg(test)]
mod tests {
    use super::super::samples::{ONE, of};
    use super::*;
    use crate::compare::comparable;

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
    fn a_filtered_move_has_no_closed_form() {
        let shaped = ONE.replace("[[program]]", "shaper = { kind = \"zv\", frequency = \"40 Hz\" }\n[[program]]");
        let averaged = ONE.replace("[[program]]", "averages = [\"10 ms\"]\n[[program]]");
        let shortest = ONE.replace("[[program]]", "method = \"optimal\"\n[[program]]");
        assert!(setpoints_have_closed_form(&of([ONE, ONE])));
        for other in [shaped, averaged, shortest] {
            assert!(!setpoints_have_closed_form(&of([ONE, &other])), "{other}");
        }
    }
}
