//! The planned moves, and limits that no run of them can keep.
use super::{Doubt, Units};
use servobench_metrics::{DisplayUnits, Limit, Name, Quantity, Scope};
use servobench_scenario::{Actuator, BusMode, Scenario, Step};
use servobench_sim::Program;
use servobench_sim::run_length;
use servobench_trace::Move;

/// Metrics that are at least the planned duration.
const NO_SHORTER: [Name; 2] = [Name::MoveTime, Name::MoveAndSettlingTime];
/// A limit equal to the planned duration may differ from it by rounding.
const ROUNDING: f64 = 1e-9;

/// The planned moves.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedProgram {
    /// Moves, each with its peaks.
    pub moves: Vec<Move>,
    /// Largest position error of the moves that are sent as velocity commands or as points (axis unit); `None` without such a move.
    pub position_error: Option<f64>,
    /// True if such moves are sent as points.
    pub by_points: bool,
    /// End of the last step (s).
    pub end: f64,
    /// Length of the run (s).
    pub run: f64,
    /// True if function blocks command the axis: the motion they make is known only in a run.
    pub by_blocks: bool,
    /// Unit of the axis.
    pub axis_unit: &'static str,
    /// Units for display.
    pub units: DisplayUnits,
}

impl PlannedProgram {
    pub(super) fn new(scenario: &Scenario, planned: &Program) -> Self {
        let axis_unit = Units::of(scenario).axis;
        Self {
            moves: planned.moves().collect(),
            position_error: planned.announced().into_iter().flatten().reduce(f64::max),
            by_points: scenario.bus.as_ref().is_some_and(|bus| bus.mode == BusMode::InterpolatedPosition),
            end: planned.end(),
            run: run_length(scenario, planned),
            by_blocks: scenario.plc.is_some(),
            axis_unit,
            units: scenario.units.clone(),
        }
    }

    /// Duration of the longest move (s); `None` without one.
    #[must_use]
    pub fn longest(&self) -> Option<f64> {
        self.moves.iter().map(length).reduce(f64::max)
    }

    /// Largest |velocity|, |acceleration|, |jerk|, |snap| of all moves (axis unit and s).
    #[must_use]
    pub fn peaks(&self) -> [f64; 4] {
        let largest = |k: usize| self.moves.iter().map(|made| made.peaks[k]).fold(0.0, f64::max);
        std::array::from_fn(largest)
    }

    pub(super) fn doubts(&self, scenario: &Scenario) -> Vec<Doubt> {
        let mut doubts = Vec::new();
        if matches!(scenario.actuator, Actuator::Off(_)) && !self.moves.is_empty() {
            let moves = if self.moves.len() == 1 { "move: it is not" } else { "moves: none of them is" };
            let message = format!("the drive is off, and the program has {} {moves} executed", self.moves.len());
            doubts.push(Doubt::new("drive.enabled", message, "leave `enabled` out, or the moves"));
        }
        let steps = scenario.program.iter().enumerate().filter_map(|(index, step)| match step {
            Step::Move(step) => Some((index, step)),
            Step::Wait(_) => None,
        });
        for ((index, step), made) in steps.zip(&self.moves) {
            if made.from.to_bits() == made.to.to_bits() && length(made) <= 0.0 {
                let message =
                    format!("the move has no length: the axis is at {} already", self.units.plain(0).text(made.to));
                doubts.push(Doubt::new(format!("program.{index}"), message, "leave it out, or move somewhere else"));
            }
            let key = |metric: &str| format!("program.{index}.limits.{metric}");
            doubts.extend(step.metric_limits.iter().filter_map(|limit| missed(limit, length(made), "the move", key)));
        }
        doubts.extend(self.window_doubt(scenario));
        doubts.extend(self.profile_doubt(scenario));
        let key = |metric: &str| format!("limits.{metric}");
        match self.longest() {
            Some(longest) => {
                let it = if self.moves.len() == 1 { "the move" } else { "the longest move" };
                doubts.extend(scenario.limits.iter().filter_map(|limit| missed(limit, longest, it, key)));
            }
            None if !self.by_blocks => {
                let lacks_a_move = |limit: &&Limit| match limit.metric.scope() {
                    Scope::Run => false,
                    Scope::Move => true,
                    Scope::AfterMove => scenario.measure.from.is_none(),
                };
                doubts.extend(scenario.limits.iter().filter(lacks_a_move).map(|limit| {
                    let metric = limit.metric;
                    let help = if metric.scope() == Scope::AfterMove {
                        "give a `[[program]]`, or `from` in `[measure]`"
                    } else {
                        "give a `[[program]]`, or leave the limit out"
                    };
                    Doubt::new(
                        key(metric.as_str()),
                        format!("`{metric}` is about a move, and there is none: the limit is missed"),
                        help,
                    )
                }));
            }
            None => {}
        }
        doubts
    }
}

impl PlannedProgram {
    /// A profile that the drive does not follow, because it receives targets and has its own ramps.
    fn profile_doubt(&self, scenario: &Scenario) -> Option<Doubt> {
        let is_told = scenario.bus.as_ref().is_some_and(|bus| bus.mode == BusMode::ProfilePosition);
        (is_told && self.moves.iter().any(|made| made.peaks[2].is_finite())).then(|| {
            Doubt::new(
                "bus.mode",
                "in \"pp\" the drive makes its own profile to each target, with the ramps of 6086h: times and peaks of the program are not \
                 those of the run",
                "write `order = 2`, or read the times off a run",
            )
        })
    }

    /// A window that already contains the load before the smallest move begins.
    fn window_doubt(&self, scenario: &Scenario) -> Option<Doubt> {
        let window = scenario.measure.window?;
        let distance = |made: &Move| (made.to - made.from).abs();
        let moved = self.moves.iter().filter(|made| distance(made) > 0.0);
        let smallest = moved.min_by(|one, two| distance(one).total_cmp(&distance(two)))?;
        (window >= distance(smallest)).then(|| {
            let text = |value: f64| self.units.plain(0).text(value);
            Doubt::new(
                "measure.window",
                format!(
                    "±{} is as large as the distance of `{}`, {}: a load that never moved would be inside, so that settling is not \
                     judged there",
                    text(window),
                    smallest.label,
                    text(distance(smallest))
                ),
                "give a smaller window",
            )
        })
    }
}

/// Duration of a move (s).
fn length(made: &Move) -> f64 {
    made.end - made.start
}

/// Doubt where a move that lasts `planned` (s) cannot keep `limit`.
fn missed(limit: &Limit, planned: f64, it: &str, key: impl Fn(&str) -> String) -> Option<Doubt> {
    let name = limit.metric;
    let show = |seconds: f64, beside: f64| {
        format!("{:.1$}", Quantity::new(seconds, "s"), Quantity::digits_apart(seconds, beside))
    };
    let too_short = limit.max.filter(|max| NO_SHORTER.contains(&name) && *max < planned * (1.0 - ROUNDING));
    let too_long = limit.min.filter(|min| name == Name::MoveTime && *min > planned * (1.0 + ROUNDING));
    let bound = too_short.or(too_long)?;
    let side = if too_short.is_some() { "at most" } else { "at least" };
    let (planned_text, bound_text) = (show(planned, bound), show(bound, planned));
    let message = format!("no run keeps `{name}` {side} {bound_text}: {it} is planned to take {planned_text}");
    let help = if too_short.is_some() { "raise this limit, or those of the set-point" } else { "lower it" };
    Some(Doubt::new(key(name.as_str()), message, help))
}

#[cfg(test)]
mod tests {
    use crate::preview::{Doubt, preview};

    /// Order 2, 0.3 m at 0.6 m/s and 2 m/s²: x/v + v/a = 0.8 s.
    const MOVE: &str = r#"
        [run]
        base_rate = "20 kHz"
        duration = "3 s"
        [axis]
        motion = "linear"
        [motor]
        kind = "prescribed"
        [setpoint]
        order = 2
        velocity = "0.6 m/s"
        acceleration = "2 m/s2"
        [[program]]
        wait = "0.1 s"
        [[program]]
        move_to = "0.3 m"
        [measure]
        window = "1 mm"
        [limits]
    "#;

    fn doubts(text: &str) -> Vec<(String, String)> {
        let scenario =
            servobench_scenario::parse("test", text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
        let found = preview(&scenario, &scenario.engines, None).unwrap().doubts;
        found.into_iter().map(|Doubt { key, message, .. }| (key, message)).collect()
    }

    /// A drive that receives targets makes trapezoids of velocity, whatever the jerk of the program.
    #[test]
    fn the_profile_of_a_program_in_profile_position_is_not_the_drives() {
        let text = |mode: &str, order: &str| {
            format!(
                "[run]\nbase_rate = \"16 kHz\"\n[axis]\nmodel = \"ball-screw\"\n[motor]\nmodel = \"wittenstein-premo-1f\"\n\
                 [drive]\nmodel = \"servo-16khz\"\ndc_link = \"320 V\"\nmax_torque = \"6.09 Nm\"\n\
                 [bus]\ncycle = \"1 ms\"\nmode = \"{mode}\"\nunits = {{ drive = 1000, axis = \"1 mm\" }}\n[setpoint]\n{order}\nvelocity = \"0.4 m/s\"\n\
                 acceleration = \"4 m/s2\"\n[[program]]\nmove_to = \"100 mm\"\n[[program]]\nwait = \"0.3 s\"\n"
            )
        };
        let (second, third) = ("order = 2", "order = 3\njerk = \"90 m/s3\"");
        for (mode, order, is_told) in [("pp", third, true), ("pp", second, false), ("csp", third, false)] {
            let said = doubts(&text(mode, order)).iter().any(|(key, _)| key == "bus.mode");
            assert_eq!(said, is_told, "{mode}, {order}");
        }
    }

    #[test]
    fn a_limit_below_the_plan_is_missed_by_every_run() {
        for kept in ["move_time = \"0.8 s\"", "move_and_settling_time = \"0.9 s\"", "settling_time = \"1 us\""] {
            assert_eq!(doubts(&format!("{MOVE}{kept}")), [], "{kept}");
        }
        for (missed, key, words) in [
            ("move_time = \"0.79 s\"", "limits.move_time", "at most 790 ms: the move is planned to take 800 ms"),
            ("move_and_settling_time = \"0.7999 s\"", "limits.move_and_settling_time", "at most 799.90 ms"),
            ("move_time = { min = \"0.9 s\", max = \"1 s\" }", "limits.move_time", "at least 900 ms"),
        ] {
            let found = doubts(&format!("{MOVE}{missed}"));
            assert!(found.len() == 1 && found[0].0 == key && found[0].1.contains(words), "{found:?}");
        }
        let own = MOVE.replace("move_to = \"0.3 m\"", "move_to = \"0.3 m\"\nlimits = { move_time = \"0.5 s\" }");
        assert_eq!(doubts(&own)[0].0, "program.1.limits.move_time");
    }

    #[test]
    fn a_program_that_moves_an_axis_whose_drive_is_off_is_doubted() {
        let off = format!("{MOVE}[drive]\nenabled = false\n[axis.motor_side]\nmass = \"10 kg\"\n")
            .replace("kind = \"prescribed\"", "kind = \"ideal-source\"\nlimit = \"1 kN\"");
        let found = doubts(&off);
        let words = "the drive is off, and the program has 1 move: it is not executed";
        assert_eq!(found, [("drive.enabled".to_owned(), words.to_owned())]);
        let held = off.replace("move_to = \"0.3 m\"", "wait = \"1 s\"");
        assert_eq!(doubts(&held), []);
    }

    #[test]
    fn a_move_to_where_the_axis_is_and_limits_without_a_move_are_doubted() {
        let there = MOVE.replace("[measure]", "[[program]]\nmove_to = \"0.3 m\"\n[measure]");
        let found = doubts(&there);
        assert!(
            found.len() == 1 && found[0].0 == "program.2" && found[0].1.contains("is at 0.3 m already"),
            "{found:?}"
        );
        let none = MOVE.replace("move_to = \"0.3 m\"", "wait = \"1 s\"");
        let limits = "overshoot = \"1 um\"\nresidual_vibration_pp = \"1 um\"\nfollowing_error_peak_load = \"1 um\"";
        let keys: Vec<_> = doubts(&format!("{none}{limits}")).into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["limits.overshoot", "limits.residual_vibration_pp"]);
        let from = none.replace("window = \"1 mm\"", "from = \"0.5 s\"");
        let keys: Vec<_> = doubts(&format!("{from}{limits}")).into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["limits.overshoot"]);
    }
}
