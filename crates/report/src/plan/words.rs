//! Texts about a plan besides its numbers.
use super::table::Kept;
use super::{NAMES, PlannedMove};
use servobench_base::Setpoint;
use servobench_config::Choice as _;
use servobench_metrics::{DisplayUnit, Quantity, digits};
use servobench_motion::online::Target;
use servobench_motion::rockwell::Shape;
use servobench_motion::sampled::Execution;
use servobench_planner::{
    Filter, Follow, Generator, Grid, Method, PlanDetails, Sampling, Sending, TableMove, Velocities,
};
use std::cmp::Ordering;

/// An excess below this fraction of a limit is rounding.
const EXCESS: f64 = 1e-9;
/// A smaller deviation from a position (m or rad) is rounding.
const HIT: f64 = 1e-12;

impl PlannedMove {
    /// `point-to-point`, `online`, `rockwell`, `pvt` or `position`.
    pub(super) const fn family(&self) -> &'static str {
        match &self.request.generator {
            Generator::PointToPoint(_) => "point-to-point",
            Generator::Replanning(_) => "online",
            Generator::Rockwell(_) => "rockwell",
            Generator::Table(TableMove { follow: Follow::Segments, .. }) => "pvt",
            Generator::Table(_) => "position",
        }
    }

    /// Name of the method within its family.
    pub(super) fn method(&self) -> &'static str {
        match &self.request.generator {
            Generator::PointToPoint(asked) => asked.method.name(),
            Generator::Replanning(asked) => asked.effort.name(),
            Generator::Rockwell(asked) => asked.operands.shape.kind().name(),
            Generator::Table(asked) => match asked.follow {
                Follow::Segments => asked.velocities.kind().name(),
                Follow::Plateaus { .. } => asked.follow.kind().name(),
                Follow::Steps { .. } => "commands",
            },
        }
    }

    /// Sample grid of the plan, if it has one.
    pub(super) const fn grid(&self) -> Option<Grid> {
        match &self.request.generator {
            Generator::PointToPoint(asked) => asked.grid,
            _ => None,
        }
    }

    /// Family and method as text: `order 4, optimal`.
    pub(super) fn kind(&self) -> String {
        let order = self.plan.order();
        match &self.request.generator {
            Generator::PointToPoint(asked) => match (asked.method, asked.grid) {
                (Method::Published, Some(Grid { sampling: Sampling::Fewest, .. })) => {
                    format!("order {order}, fewest samples")
                }
                (Method::Published, _) => format!("order {order}"),
                (Method::Optimal, _) => format!("order {order}, {}", asked.method.name()),
            },
            Generator::Replanning(_) => format!("order {order}, online {}", self.method()),
            Generator::Rockwell(asked) => match asked.operands.shape {
                Shape::Trapezoid => "Rockwell trapezoid".to_owned(),
                Shape::SCurve { .. } => "Rockwell S-curve".to_owned(),
            },
            Generator::Table(TableMove { follow: Follow::Segments, velocities: Velocities::Given, knots })
                if knots.iter().all(|knot| knot.v.is_none()) =>
            {
                "PT".to_owned()
            }
            Generator::Table(TableMove { follow: Follow::Segments, .. }) => "PVT".to_owned(),
            Generator::Table(_) => "position profile".to_owned(),
        }
    }

    /// Description of the move: `move of 1.00 m`.
    pub(super) fn what(&self, distance: &str) -> String {
        match &self.request.generator {
            Generator::Table(asked) => format!("{distance} through {} points", asked.knots.len()),
            Generator::Replanning(asked) => match asked.target {
                Target::Velocity(v) => format!("{distance} to {}", self.show(1, v)),
                Target::Position { .. } => distance.to_owned(),
            },
            Generator::PointToPoint(_) | Generator::Rockwell(_) => distance.to_owned(),
        }
    }

    /// Notes on the plan, a sentence each.
    pub(super) fn notes(&self) -> Vec<String> {
        let time = |time: f64| {
            let (unit, scale) = Quantity::axis_unit(time, "s");
            format!("{} {unit}", digits(time / scale, 6))
        };
        let mut notes = Vec::new();
        if let Some((sample_time, samples)) = self.samples() {
            notes.push(format!("{samples} samples of {}", time(sample_time)));
        }
        if let Some(shortest) = self.shortest() {
            notes.push(match shortest.at_least() {
                least if least >= shortest.samples() => {
                    "proven: no move of fewer samples reaches the distance".to_owned()
                }
                0 | 1 => "not proven to be the fewest samples".to_owned(),
                least => format!("not proven to be the fewest samples; below {least} none reach the distance"),
            });
        }
        if let Some(Grid { execution: Execution::ForwardEuler, sample_time, .. }) = self.grid() {
            let late = 0.5 * (self.plan.order() as f64 - 1.0) * sample_time;
            notes.push(format!("forward-Euler cascade: {} behind the exact hold on the way", time(late)));
        }
        if let Some((published, gain)) = self.gain() {
            let published = time(published);
            notes.push(if gain.abs() < 1e-9 {
                format!("as long as the published profile ({published})")
            } else {
                format!("{:.2} % shorter than the published profile ({published})", 100.0 * gain)
            });
        }
        notes.extend(self.of_generator());
        notes.extend(self.filters(&time));
        if self.request.duration.is_some() {
            notes.push("slowed to the duration that was asked for".to_owned());
        }
        notes.extend(self.exceeded());
        notes.extend(self.notes_of_points(time));
        notes
    }

    /// Largest overshoot beyond the target of a move that passes it and comes back, in words; `None` for any other move.
    fn beyond_target(&self, target: &Target) -> Option<String> {
        let (Target::Position { x, .. }, start, reached) = (target, self.plan.start().x, self.plan.positions()) else {
            return None;
        };
        // Before the start it may turn round, too: that is not an overshoot of its target.
        let [above, below] = [reached.highest - x, x - reached.lowest];
        let beyond = match x.total_cmp(&start) {
            Ordering::Greater => above,
            Ordering::Less => below,
            Ordering::Equal => above.max(below),
        };
        (beyond > HIT.max(EXCESS * (x - start).abs())).then(|| {
            format!(
                "goes {} beyond its target and comes back: from its initial state there is no way without turning round",
                self.show(0, beyond)
            )
        })
    }

    /// Notes specific to the generator.
    fn of_generator(&self) -> Vec<String> {
        match (&self.request.generator, self.plan.details()) {
            (Generator::Replanning(asked), PlanDetails::Transition { excess, .. }) => {
                let Setpoint { x, v, a, j, .. } = asked.from;
                let mut from = vec![self.show(0, x)];
                let later = [(1, v), (2, a), (3, if self.plan.order() == 4 { j } else { 0.0 })];
                from.extend(later.into_iter().filter(|(_, value)| *value != 0.0).map(|(k, value)| self.show(k, value)));
                let to = match asked.target {
                    Target::Position { x, v: 0.0 } => format!("rest at {}", self.show(0, x)),
                    Target::Position { x, v } => format!("{}, {}", self.show(0, x), self.show(1, v)),
                    Target::Velocity(v) => self.show(1, v),
                };
                let mut told = vec![format!("from {} to {to}", from.join(", "))];
                if *excess > EXCESS {
                    told.push(format!(
                        "goes {:.3} % beyond its limits: its initial state cannot be left within them",
                        100.0 * excess
                    ));
                }
                told.extend(self.beyond_target(&asked.target));
                told
            }
            (_, PlanDetails::Rockwell { acceleration, deceleration }) => vec![format!(
                "jerk {} of the acceleration, {} of the deceleration",
                self.show(3, *acceleration),
                self.show(3, *deceleration)
            )],
            (Generator::Table(asked), PlanDetails::Table { .. }) => vec![velocities(asked)],
            (Generator::Table(_), PlanDetails::Commands { commands, error, sending }) => {
                vec![match sending {
                    Sending::Rate(rate) => format!(
                        "{} velocity commands at {rate} Hz: at most {} off the cubic spline",
                        commands.len(),
                        self.show_error(*error)
                    ),
                    Sending::Plateaus { share: alpha } if *error < HIT => {
                        format!("{} velocity commands, α = {}: every position is hit", commands.len(), rounded(*alpha))
                    }
                    Sending::Plateaus { share: alpha } => format!(
                        "{} velocity commands, α = {}: at most {} off the positions",
                        commands.len(),
                        rounded(*alpha),
                        self.show_error(*error)
                    ),
                }]
            }
            _ => Vec::new(),
        }
    }

    /// The limits exceeded by a table, which is followed all the same.
    fn exceeded(&self) -> Option<String> {
        matches!(self.request.generator, Generator::Table(_)).then(|| exceeded(&self.kept())).flatten()
    }

    /// An error of position, much smaller than the positions.
    pub(super) fn show_error(&self, error: f64) -> String {
        if self.units.base() == "m" { DisplayUnit::si("m", 0).text(error) } else { self.show(0, error) }
    }

    /// Filters of the plan.
    fn filters(&self, time: &impl Fn(f64) -> String) -> Option<String> {
        let Filter { shapers, averages } = &self.request.filter;
        let shaper = self.request.filter.impulses().ok().flatten().map(|all| {
            let what = if shapers.len() == 1 { "a shaper".to_owned() } else { format!("{} shapers", shapers.len()) };
            format!("{what} of {} impulses over {}", all.iter().count(), time(all.duration()))
        });
        let averages = averages.as_ref().map(|averages| {
            let lengths: Vec<_> = averages.lengths.iter().map(|length| time(*length)).collect();
            let plural = if lengths.len() == 1 { "an average" } else { "averages" };
            format!("{plural} of {}", lengths.join(" and "))
        });
        let filters: Vec<String> = shaper.into_iter().chain(averages).collect();
        let length = time(self.plan.filter_length());
        (!filters.is_empty()).then(|| format!("{length} longer by {}", filters.join(" and ")))
    }
}

/// The exceeded limits, in words; rounding aside.
pub(super) fn exceeded(kept: &[Kept]) -> Option<String> {
    let beyond = kept.iter().filter(|kept| kept.limit.is_finite() && kept.peak > kept.limit * (1.0 + EXCESS));
    let beyond: Vec<String> = beyond
        .map(|Kept { derivative, peak, limit, .. }| {
            format!("{} by {} %", NAMES[*derivative], digits(100.0 * (peak / limit - 1.0), 3))
        })
        .collect();
    (!beyond.is_empty()).then(|| format!("exceeds its limit of {}", beyond.join(" and of ")))
}

/// A share to six decimals.
fn rounded(share: f64) -> f64 {
    (1e6 * share).round() / 1e6
}

/// Source of the velocities at the points.
fn velocities(asked: &TableMove) -> String {
    match asked.velocities {
        Velocities::Given if asked.knots.iter().all(|knot| knot.v.is_none()) => "linear from point to point".to_owned(),
        Velocities::Given => "velocities of the table".to_owned(),
        Velocities::Average => "velocities by the average rule".to_owned(),
        Velocities::Smooth { passes: 1 } => "velocities by the average rule and 1 pass of F2 and F1".to_owned(),
        Velocities::Smooth { passes } => format!("velocities by the average rule and {passes} passes of F2 and F1"),
        Velocities::Continuous => "velocities of the cubic spline: continuous acceleration".to_owned(),
    }
}
