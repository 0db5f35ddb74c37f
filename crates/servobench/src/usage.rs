//! Share of its limits that a run used, and the mode in which its load swings: the basis of an advice.
use crate::run::Run;
use servobench_metrics::{Limit, Name};
use servobench_motion::Limits;
use servobench_planner::Generator;
use servobench_plant::Link;
use servobench_scenario::{AxisMechanics, Scenario, Step};
use std::f64::consts::TAU;

/// Share of its limits that a run used.
#[derive(Debug, Clone, PartialEq)]
pub struct Usage {
    /// Longest move with settling (s), without a settling window longest move; not a number where the load does not settle.
    pub time: f64,
    /// Used share of each largest allowed value; not a number where it could not be measured.
    pub shares: Vec<f64>,
    /// True if nothing else failed: every requirement is met, every smallest value reached.
    pub is_sound: bool,
}

impl Run {
    /// Share that this run used of `limits`, which it was judged by; with `has_window`, settling counts.
    #[must_use]
    pub fn usage(&self, limits: &[Limit], has_window: bool) -> Usage {
        let value = |name| self.metrics.run.value(name).unwrap_or(f64::NAN);
        let share = |limit: &Limit| {
            let size = value(limit.metric).abs();
            // A zero value of a zero limit uses no share.
            limit.max.map(|max| if size == 0.0 { 0.0 } else { size / max })
        };
        let is_of_a_share = |limit: &Limit, in_move: Option<usize>| in_move.is_none() && limit.max.is_some();
        let verdict = &self.verdict;
        let is_sound = verdict.expected.iter().all(|expected| expected.met.is_some())
            && !verdict.requirements.iter().any(|(name, result)| result.is_not_met(name.as_str()))
            && verdict.misses.iter().all(|miss| is_of_a_share(&miss.limit, miss.in_move) && miss.value.is_some());
        let time = value(if has_window { Name::MoveAndSettlingTime } else { Name::MoveTime });
        Usage { time, shares: limits.iter().filter_map(share).collect(), is_sound }
    }
}

/// The mode in which the load of an axis swings on the nearest spring, with the drive side held.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadMode {
    /// The table of the scenario that has the spring: `axis.load`, or `axis.table` where the load is bolted to the table.
    pub table: &'static str,
    /// True if the body of that table swings alone. Otherwise another body is bolted to it, and `frequency` and `damping_ratio` of the
    /// table, which hold for its own mass, are not those of the mode.
    pub is_alone: bool,
    /// The spring (N/m or N·m/rad) and its damping (N·s/m or N·m·s/rad).
    pub link: Link,
    /// Natural frequency (Hz).
    pub frequency: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// The mode in which the load of `scenario` swings; `None` where nothing is coupled by a spring.
#[must_use]
pub fn load_mode(scenario: &Scenario) -> Option<LoadMode> {
    let AxisMechanics::Bodies(chain) = &scenario.axis.mechanics else { return None };
    let (body, link) = (chain.bodies().last()?, *chain.links().last()?);
    let has_spring = |table: &str| {
        let keys = ["stiffness", "frequency"].map(|key| format!("{table}.{key}"));
        scenario.parameters.iter().any(|one| keys.contains(&one.key))
    };
    // From the load inwards: a bolted body has no spring.
    let (table, name) = [("axis.load", "load"), ("axis.table", "table")].into_iter().find(|one| has_spring(one.0))?;
    let frequency = (link.stiffness / body.inertia).sqrt() / TAU;
    let damping_ratio = 0.5 * link.damping / (link.stiffness * body.inertia).sqrt();
    Some(LoadMode { table, is_alone: body.name == name, link, frequency, damping_ratio })
}

/// Distance of the longest move of `scenario` from rest to rest by limits (m or rad); `None` where there is none.
#[must_use]
pub fn longest_move(scenario: &Scenario) -> Option<f64> {
    let distances = scenario.program.iter().filter_map(|step| match step {
        Step::Move(step) => match &step.request.generator {
            Generator::PointToPoint(request) => Some(request.distance.abs()),
            Generator::Replanning(_) | Generator::Rockwell(_) | Generator::Table(_) => None,
        },
        Step::Wait(_) => None,
    });
    distances.reduce(f64::max).filter(|distance| *distance > 0.0)
}

/// Limits of velocity, acceleration, jerk and snap in the moves of a scenario, each the largest; `None` where no move goes from rest to
/// rest by limits.
#[must_use]
pub fn limits_of_set_point(scenario: &Scenario) -> Option<Limits> {
    let of_moves = scenario.program.iter().filter_map(|step| match step {
        Step::Move(step) => match &step.request.generator {
            Generator::PointToPoint(request) => Some(request.limits),
            Generator::Replanning(_) | Generator::Rockwell(_) | Generator::Table(_) => None,
        },
        Step::Wait(_) => None,
    });
    of_moves.reduce(|one, other| Limits {
        velocity: one.velocity.max(other.velocity),
        acceleration: one.acceleration.max(other.acceleration),
        jerk: one.jerk.max(other.jerk),
        snap: one.snap.max(other.snap),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the file of the model, 17.5 Hz and 0.4 %.
    #[test]
    fn the_load_of_the_demo_swings_as_its_model_says() {
        let (name, text) = servobench_scenario::embedded_demo().into_iter().next().unwrap();
        let scenario = servobench_scenario::parse(name, text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        let mode = load_mode(&scenario).unwrap();
        assert_eq!((mode.table, mode.is_alone), ("axis.load", true));
        assert!((longest_move(&scenario).unwrap() - 0.25).abs() < 1e-12);
        assert!((mode.frequency - 17.5).abs() < 0.01 && (mode.damping_ratio - 0.004).abs() < 1e-4, "{mode:?}");
        let limits = limits_of_set_point(&scenario).unwrap();
        assert!((limits.velocity - 0.5).abs() < 1e-12 && (limits.jerk - 50.0).abs() < 1e-12, "{limits:?}");
    }

    /// Oracle: √(k/(m₁ + m₂))/2π by hand: the carriage's own mass and that which is bolted to it, on the belt's spring.
    #[test]
    fn what_is_bolted_to_a_table_swings_on_the_spring_of_the_table() {
        let axis = "run.base_rate = \"4 kHz\"\nmotor.kind = \"prescribed\"\n[axis]\nmotion = \"linear\"\n";
        let mode = |bodies: &str| {
            let text = format!("{axis}{bodies}[[program]]\nwait = \"1 s\"\n");
            let scenario = servobench_scenario::parse("belt", &text, None).unwrap_or_else(|e| panic!("{e}")).scenario;
            load_mode(&scenario)
        };
        let (table, load) =
            ("table = { mass = \"3.4 kg\", stiffness = \"614 N/mm\", damping = \"90 N s/m\" }\n", "load = { mass = ");
        let bolted = mode(&format!("{table}{load}\"10 kg\" }}\n")).unwrap();
        assert_eq!((bolted.table, bolted.is_alone), ("axis.table", false));
        assert!((bolted.frequency - (614e3_f64 / 13.4).sqrt() / TAU).abs() < 1e-9, "{bolted:?}");
        let alone = mode(table).unwrap();
        assert!(alone.is_alone && (alone.frequency - (614e3_f64 / 3.4).sqrt() / TAU).abs() < 1e-9, "{alone:?}");
        let both = mode(&format!("{table}{load}\"10 kg\", frequency = \"20 Hz\" }}\n")).unwrap();
        assert!(both.table == "axis.load" && both.is_alone && (both.frequency - 20.0).abs() < 1e-9, "{both:?}");
        assert!(mode(&format!("{load}\"10 kg\" }}\n")).is_none());
    }
}
