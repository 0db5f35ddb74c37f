//! A plan as JSON.
use super::{NAMES, PlannedMove, derivatives};
use crate::error::ReportError;
use indexmap::IndexMap;
use serde::Serialize;
use servobench_base::Setpoint;
use servobench_config::Choice as _;
use servobench_motion::Profile;
use servobench_motion::sampled::Shortest;
use servobench_planner::{PlanDetails, Sending};
use std::iter;

/// Most segments, bindings and commands listed, each; of more, only the number is written, and `--csv` has the values.
const MOST: usize = 100_000;

/// A plan; values are SI.
#[derive(Debug, Serialize)]
struct Plan {
    family: &'static str,
    method: &'static str,
    order: usize,
    /// Unit of positions.
    unit: &'static str,
    distance: f64,
    duration_s: f64,
    /// Part of the duration added by shaper and moving averages.
    #[serde(skip_serializing_if = "Option::is_none")]
    filter_s: Option<f64>,
    #[serde(flatten)]
    compared: Option<Compared>,
    /// `t_d` … `t_v` (s).
    #[serde(flatten)]
    dwells: IndexMap<String, f64>,
    /// Values that the pulses of the highest derivative reach, signed: `snap_effective` at order 4.
    #[serde(flatten)]
    effective: IndexMap<String, f64>,
    /// Largest magnitudes.
    peaks: IndexMap<String, f64>,
    /// Lowest and highest values.
    extremes: IndexMap<String, [f64; 2]>,
    /// Lowest and highest values allowed, for each limited quantity.
    limits: IndexMap<String, [Option<f64>; 2]>,
    #[serde(flatten)]
    samples: Option<Samples>,
    /// Relative excess of a transition over its limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    excess: Option<f64>,
    /// Jerks of Rockwell's ramps.
    #[serde(skip_serializing_if = "Option::is_none")]
    jerks: Option<Jerks>,
    /// Largest deviation of the position from the spline.
    #[serde(skip_serializing_if = "Option::is_none")]
    position_error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plateau_share: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    command_rate_hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    command_count: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    commands: Option<Vec<Command>>,
    #[serde(flatten)]
    points: Option<Points>,
    /// Number of intervals with a derivative at its limit.
    binding_count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    bindings: Option<Vec<Binding>>,
    segment_count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    segments: Option<Vec<Segment>>,
}

/// The move as points.
#[derive(Debug, Serialize)]
struct Points {
    point_count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    point_time_s: Option<f64>,
    /// Largest deviation of the path through the points from the plan, and its time.
    point_deviation: f64,
    point_deviation_at_s: f64,
    /// The same for the path of a drive that receives the points in whole counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    sent_deviation: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sent_deviation_at_s: Option<f64>,
}

/// Comparison with the published profile.
#[derive(Debug, Serialize)]
struct Compared {
    published_duration_s: f64,
    /// Relative gain in duration.
    gain: f64,
}

#[derive(Debug, Serialize)]
struct Samples {
    sample_time_s: f64,
    #[serde(rename = "samples")]
    count: u64,
    /// Proven lower bound of the number of samples.
    #[serde(rename = "samples_at_least", skip_serializing_if = "Option::is_none")]
    at_least: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sampling: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    execution: Option<&'static str>,
}

#[derive(Debug, Serialize)]
struct Jerks {
    acceleration: f64,
    deceleration: f64,
}

#[derive(Debug, Serialize)]
struct Command {
    time_s: f64,
    velocity: f64,
    acceleration: f64,
}

/// A derivative at its limit; at an instant if the length is 0.
#[derive(Debug, Serialize)]
struct Binding {
    quantity: &'static str,
    start_s: f64,
    length_s: f64,
    value: f64,
}

/// An interval of constant highest derivative.
#[derive(Debug, Serialize)]
struct Segment {
    start_s: f64,
    length_s: f64,
    value: f64,
    #[serde(flatten)]
    state: Option<State>,
}

/// The set-point at the beginning of a segment of a move that is not from rest to rest.
#[derive(Debug, Serialize)]
struct State {
    position: f64,
    velocity: f64,
    acceleration: f64,
    jerk: f64,
}

impl PlannedMove {
    /// Lowest and highest position, and those of its derivatives up to the order.
    fn extremes(&self) -> IndexMap<String, [f64; 2]> {
        let peaks = iter::once(self.plan.positions()).chain(self.plan.peaks());
        let named = NAMES[..=self.plan.order()].iter().zip(peaks);
        named.map(|(name, peak)| ((*name).to_owned(), [peak.lowest, peak.highest])).collect()
    }

    /// The plan as JSON, in SI.
    ///
    /// # Errors
    /// [`ReportError::Json`].
    pub fn json(&self) -> Result<String, ReportError> {
        let n = self.plan.order();
        let effective = self.profile().map(|profile| (format!("{}_effective", NAMES[n]), profile.amplitude()));
        let names = || NAMES[1..=n].iter().map(|name| (*name).to_owned());
        let limits =
            self.plan.limits().map(|sides| [-sides.below, sides.above].map(|limit| limit.is_finite().then_some(limit)));
        let (commands, error, sending) = match self.plan.details() {
            PlanDetails::Commands { commands, error, sending } => (Some(commands), Some(*error), Some(*sending)),
            _ => (None, None, None),
        };
        let (plateau_share, command_rate_hz) = match sending {
            Some(Sending::Plateaus { share }) => (Some(share), None),
            Some(Sending::Rate(rate)) => (None, Some(rate)),
            None => (None, None),
        };
        let bindings = self.plan.bindings();
        let segments = self.segments();
        let plan = Plan {
            family: self.family(),
            method: self.method(),
            order: n,
            unit: self.units.base(),
            distance: self.distance(),
            duration_s: self.plan.duration(),
            filter_s: Some(self.plan.filter_length()).filter(|length| *length > 0.0),
            compared: self.gain().map(|(published_duration_s, gain)| Compared { published_duration_s, gain }),
            dwells: self.dwells().map(|(name, _, value)| (name.to_owned(), value)).collect(),
            effective: effective.into_iter().collect(),
            peaks: names().zip(self.plan.largest()).collect(),
            extremes: self.extremes(),
            limits: names().zip(limits).filter(|(_, limit)| limit.iter().any(Option::is_some)).collect(),
            samples: self.sampled(),
            excess: match self.plan.details() {
                PlanDetails::Transition { excess, .. } => Some(*excess),
                _ => None,
            },
            jerks: match self.plan.details() {
                PlanDetails::Rockwell { acceleration, deceleration } => {
                    Some(Jerks { acceleration: *acceleration, deceleration: *deceleration })
                }
                _ => None,
            },
            position_error: error,
            plateau_share,
            command_rate_hz,
            command_count: commands.map(Vec::len),
            commands: commands.filter(|commands| commands.len() <= MOST).map(|commands| {
                let start = commands.first().map_or(0.0, |command| command.t);
                let command = |of: &servobench_motion::position_profile::Command| Command {
                    time_s: of.t - start,
                    velocity: of.velocity,
                    acceleration: of.acceleration,
                };
                commands.iter().map(command).collect()
            }),
            points: self.points.as_ref().map(|points| {
                let (deviation, sent) = (points.through.deviation, points.sent.as_ref().map(|sent| sent.deviation));
                Points {
                    point_count: points.through.knots.len(),
                    point_time_s: points.spacing,
                    point_deviation: deviation.distance,
                    point_deviation_at_s: deviation.time,
                    sent_deviation: sent.map(|sent| sent.distance),
                    sent_deviation_at_s: sent.map(|sent| sent.time),
                }
            }),
            binding_count: bindings.len(),
            bindings: (bindings.len() <= MOST).then(|| {
                let binding = |of: servobench_planner::Binding| Binding {
                    quantity: NAMES[of.derivative],
                    start_s: of.start,
                    length_s: of.length,
                    value: of.value,
                };
                bindings.into_iter().map(binding).collect()
            }),
            segment_count: segments.len(),
            segments: (segments.len() <= MOST).then_some(segments),
        };
        Ok(serde_json::to_string_pretty(&plan)? + "\n")
    }

    fn sampled(&self) -> Option<Samples> {
        let (sample_time_s, count) = self.samples()?;
        let grid = self.grid();
        let sampling = grid.filter(|_| self.shortest().is_none()).map(|grid| grid.sampling.name());
        let execution = grid.map(|grid| grid.execution.name());
        let at_least = self.shortest().map(Shortest::at_least);
        Some(Samples { sample_time_s, count, at_least, sampling, execution })
    }

    /// Segments of a profile from rest to rest; for other plans the polynomials with their initial states; none for samples.
    fn segments(&self) -> Vec<Segment> {
        if let Some(segments) = self.profile().map(Profile::segments) {
            let segment = |of: servobench_motion::Segment| Segment {
                start_s: of.start,
                length_s: of.length,
                value: of.value,
                state: None,
            };
            return segments.map(segment).collect();
        }
        if self.plan.held().is_some() {
            return Vec::new();
        }
        let n = self.plan.order();
        let segment = |of: servobench_planner::Span| {
            let Setpoint { x, v, a, j, .. } = of.state;
            let state = State { position: x, velocity: v, acceleration: a, jerk: j };
            Segment { start_s: of.start, length_s: of.length, value: derivatives(&of.state)[n], state: Some(state) }
        };
        self.plan.spans().map(segment).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{PlannedMove, moves};
    use servobench_motion::Order;
    use servobench_motion::pvt::Knot;
    use servobench_motion::sampled::Execution;
    use servobench_planner::{CommandRate, Follow, Generator, Method, PointToPoint, TableMove, Velocities};

    fn json(plan: &PlannedMove) -> serde_json::Value {
        serde_json::from_str(&plan.json().unwrap()).unwrap()
    }

    /// Lambrechts' limits at order 2: 1 m at 1 m/s, and 0.2 s more for 5 m/s² up and down.
    #[test]
    fn a_trapezoid() {
        insta::assert_snapshot!(moves::lambrechts(Order::Second).json().unwrap(), @r#"
        {
          "family": "point-to-point",
          "method": "published",
          "order": 2,
          "unit": "m",
          "distance": 1.0,
          "duration_s": 1.2,
          "t_a": 0.2,
          "t_v": 0.8,
          "acceleration_effective": 5.0,
          "peaks": {
            "velocity": 1.0,
            "acceleration": 5.0
          },
          "extremes": {
            "position": [
              0.0,
              1.0
            ],
            "velocity": [
              0.0,
              1.0
            ],
            "acceleration": [
              -5.0,
              5.0
            ]
          },
          "limits": {
            "velocity": [
              -1.0,
              1.0
            ],
            "acceleration": [
              -5.0,
              5.0
            ]
          },
          "binding_count": 3,
          "bindings": [
            {
              "quantity": "velocity",
              "start_s": 0.2,
              "length_s": 0.8,
              "value": 1.0
            },
            {
              "quantity": "acceleration",
              "start_s": 0.0,
              "length_s": 0.2,
              "value": 5.0
            },
            {
              "quantity": "acceleration",
              "start_s": 1.0,
              "length_s": 0.19999999999999996,
              "value": -5.0
            }
          ],
          "segment_count": 3,
          "segments": [
            {
              "start_s": 0.0,
              "length_s": 0.2,
              "value": 5.0
            },
            {
              "start_s": 0.2,
              "length_s": 0.8,
              "value": 0.0
            },
            {
              "start_s": 1.0,
              "length_s": 0.2,
              "value": -5.0
            }
          ]
        }
        "#);
    }

    #[test]
    fn samples_are_counted() {
        let plan = json(&moves::sampled(1e-3));
        assert_eq!((&plan["samples"], &plan["sample_time_s"]), (&1350.into(), &1e-3.into()), "{plan}");
        assert_eq!(plan["segments"].as_array().unwrap().len(), 15);
        let euler = json(&moves::executed(1e-3, Execution::ForwardEuler));
        assert_eq!((&euler["samples"], &euler["execution"]), (&1350.into(), &"euler".into()), "{euler}");
    }

    /// (384/512)^¼ of the time, where snap alone binds.
    #[test]
    fn the_gain_is_a_number() {
        let (order, method) = (Order::Fourth, Method::Optimal);
        let asked = PointToPoint { distance: 1e-3, order, limits: moves::LAMBRECHTS, method, grid: None };
        let plan = json(&moves::of(Generator::PointToPoint(asked)));
        let near = |name: &str, expected: f64| {
            let found = plan[name].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-9, "{name}: {found}");
        };
        near("gain", 1.0 - 0.75_f64.sqrt().sqrt());
        near("published_duration_s", (512.0 * 1e-3 / 1000.0_f64).sqrt().sqrt());
        assert_eq!((&plan["family"], &plan["method"]), (&"point-to-point".into(), &"optimal".into()));
        assert!(plan["bindings"].as_array().unwrap().iter().all(|one| one["quantity"] == "snap"), "{plan}");
    }

    #[test]
    fn commands_are_listed_with_their_error() {
        let knots = [(0.5, 0.0), (0.6, 0.01), (0.75, 0.04)].map(|(t, x)| Knot::new(t, x)).to_vec();
        let asked = TableMove {
            knots,
            velocities: Velocities::Given,
            follow: Follow::Steps { rate: CommandRate::Given(100.0) },
        };
        let plan = json(&moves::of(Generator::Table(asked)));
        assert_eq!((&plan["command_count"], &plan["command_rate_hz"]), (&25.into(), &100.0.into()), "{plan}");
        assert!(plan["position_error"].as_f64().unwrap() > 0.0 && plan["limits"].as_object().unwrap().is_empty());
        assert_eq!(plan["commands"][0]["time_s"], 0.0);
        assert_eq!(plan["segments"][0]["position"], 0.0);
    }
}
