//! `servobench plan`: one rest-to-rest move on paper.
use crate::args::PlanArgs;
use crate::exit::{CliError, Exit};
use crate::output::write_file;
use serde_json::json;
use servobench_base::Setpoint;
use servobench_metrics::Quantity;
use servobench_motion::{Limits, Order, Profile};
use servobench_report::{Panel, PlanDrawing};
use servobench_scenario::{ArgumentError, Derivative, Motion, axis_quantity, time};
use std::io::Write;

/// Samples of a continuous plan in a table or a drawing.
const SAMPLES: u32 = 1000;
const NAMES: [&str; 5] = ["position", "velocity", "acceleration", "jerk", "snap"];

/// A plan and what was asked for.
struct Planned {
    profile: Profile,
    limits: Limits,
    /// Unit of positions.
    unit: &'static str,
}

/// Plans the move and prints, tabulates or draws it.
pub(crate) fn plan(args: &PlanArgs) -> Result<Exit, CliError> {
    let planned = planned(args)?;
    if let Some(path) = &args.csv {
        write_file(path, &csv(&planned))?;
    }
    if let Some(path) = &args.svg {
        write_file(path, &svg(&planned))?;
    }
    let text = if args.json { json_text(&planned)? } else { table(&planned) };
    write!(std::io::stdout(), "{text}")?;
    Ok(Exit::Passed)
}

fn planned(args: &PlanArgs) -> Result<Planned, CliError> {
    let named = |name: &'static str| move |error: ArgumentError| CliError::Input(format!("--{name} {error}"));
    let (distance, motion) = axis_quantity(Derivative::Position, None, &args.distance).map_err(named("distance"))?;
    let limit = |name: &'static str, derivative, text: &str| {
        axis_quantity(derivative, Some(motion), text).map(|(value, _)| value).map_err(named(name))
    };
    let needed = |name: &'static str, derivative, text: &Option<String>, order: u8| match text {
        Some(text) => limit(name, derivative, text),
        None if args.order >= order => {
            Err(CliError::Input(format!("--{name} is missing: a move of order {} needs its limit", args.order)))
        }
        None => Ok(f64::INFINITY),
    };
    let limits = Limits {
        velocity: limit("velocity", Derivative::Velocity, &args.velocity)?,
        acceleration: limit("acceleration", Derivative::Acceleration, &args.acceleration)?,
        jerk: needed("jerk", Derivative::Jerk, &args.jerk, 3)?,
        snap: needed("snap", Derivative::Snap, &args.snap, 4)?,
    };
    let order = match args.order {
        2 => Order::Second,
        3 => Order::Third,
        _ => Order::Fourth,
    };
    let profile = match &args.sample_time {
        Some(text) => {
            let sample_time = time(text).map_err(named("sample-time"))?;
            Profile::plan_sampled(order, distance, &limits, sample_time)
        }
        None => Profile::plan(order, distance, &limits),
    };
    let profile = profile.map_err(|error| CliError::Input(error.to_string()))?;
    let unit = if motion == Motion::Linear { "m" } else { "rad" };
    Ok(Planned { profile, limits, unit })
}

impl Planned {
    /// Unit of the derivative `n` of position.
    fn unit_of(&self, n: usize) -> String {
        let power = ["", "/s", "/s²", "/s³", "/s⁴"][n];
        format!("{}{power}", self.unit)
    }

    /// Limits of velocity, acceleration, jerk and snap that the order uses.
    fn limits(&self) -> impl Iterator<Item = f64> {
        let Limits { velocity, acceleration, jerk, snap } = self.limits;
        [velocity, acceleration, jerk, snap].into_iter().take(self.profile.order().derivative())
    }

    /// Peaks of the same derivatives.
    fn peaks(&self) -> impl Iterator<Item = f64> {
        let peaks = self.profile.peaks();
        [peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap].into_iter().take(self.profile.order().derivative())
    }

    /// Times of a table or a drawing: the samples of a sampled plan, otherwise equally spaced.
    fn times(&self) -> Vec<f64> {
        match self.profile.samples() {
            Some(samples) => (0..=samples.total()).map(|k| k as f64 * samples.time).collect(),
            None => (0..=SAMPLES).map(|k| self.profile.duration() * f64::from(k) / f64::from(SAMPLES)).collect(),
        }
    }
}

/// Segment times, peaks against limits, duration: for a person.
fn table(planned: &Planned) -> String {
    let Planned { profile, unit, .. } = planned;
    let n = profile.order().derivative();
    let mut text = String::new();
    let mut line = |words: String| {
        text.push_str(&words);
        text.push('\n');
    };
    line(format!("move of {} in {}, order {n}", Quantity::new(profile.distance(), unit), seconds(profile.duration())));
    if let Some(samples) = profile.samples() {
        line(format!("{} samples of {}", samples.total(), seconds(samples.time)));
    }
    line(String::new());
    for (name, meaning, value) in dwells(profile) {
        line(format!("{name}  {:>12}   {meaning}", seconds(value)));
    }
    line(String::new());
    line(format!("{:<13} {:>16} {:>16} {:>9}", "", "peak", "limit", "of limit"));
    for (i, (peak, limit)) in planned.peaks().zip(planned.limits()).enumerate() {
        let (name, unit) = (NAMES[i + 1], planned.unit_of(i + 1));
        let (peak_text, limit_text) = (Quantity::new(peak, &unit).to_string(), Quantity::new(limit, &unit).to_string());
        line(format!("{name:<13} {peak_text:>16} {limit_text:>16} {:>7.2} %", 100.0 * peak / limit));
    }
    line(String::new());
    let unit = planned.unit_of(n);
    line(format!("{:>12} {:>12}  {}", "start", "length", NAMES[n]));
    for segment in profile.segments() {
        let value = Quantity::new(segment.value, &unit).to_string();
        line(format!("{:>12} {:>12}  {value}", seconds(segment.start), seconds(segment.length)));
    }
    text
}

/// How long each derivative stays at its peak within one pulse of it: name in the literature, meaning, time (s).
fn dwells(profile: &Profile) -> impl Iterator<Item = (&'static str, &'static str, f64)> {
    let times = profile.times();
    [
        ("t_d", "snap at its peak", times.t_d),
        ("t_j", "jerk at its peak", times.t_j),
        ("t_a", "acceleration at its peak", Some(times.t_a)),
        ("t_v", "velocity at its peak", Some(times.t_v)),
    ]
    .into_iter()
    .filter_map(|(name, meaning, value)| Some((name, meaning, value?)))
}

/// To the nanosecond: a plan is read to be typed in somewhere else.
fn seconds(value: f64) -> String {
    let text = format!("{value:.9}");
    format!("{} s", text.trim_end_matches('0').trim_end_matches('.'))
}

fn json_text(planned: &Planned) -> Result<String, CliError> {
    let profile = &planned.profile;
    let segments: Vec<_> = profile
        .segments()
        .map(|segment| json!({ "start_s": segment.start, "length_s": segment.length, "value": segment.value }))
        .collect();
    let mut plan = json!({
        "order": profile.order().derivative(),
        "unit": planned.unit,
        "distance": profile.distance(),
        "duration_s": profile.duration(),
        "segments": segments,
        "peaks": NAMES[1..].iter().zip(planned.peaks()).map(|(name, peak)| ((*name).to_owned(), json!(peak)))
            .collect::<serde_json::Map<_, _>>(),
    });
    let effective = ["", "", "acceleration_effective", "jerk_effective", "snap_effective"];
    plan[effective[profile.order().derivative()]] = json!(profile.amplitude());
    for (name, _, value) in dwells(profile) {
        plan[name] = json!(value);
    }
    if let Some(samples) = profile.samples() {
        plan["sample_time_s"] = json!(samples.time);
        plan["samples"] = json!(samples.total());
    }
    let text = serde_json::to_string_pretty(&plan).map_err(|error| CliError::Run(error.to_string()))?;
    Ok(text + "\n")
}

fn csv(planned: &Planned) -> String {
    let unit = planned.unit;
    let heading =
        format!("time_s,position_{unit},velocity_{unit}_s,acceleration_{unit}_s2,jerk_{unit}_s3,snap_{unit}_s4");
    let rows = planned.times().into_iter().map(|t| {
        let Setpoint { x, v, a, j, s } = planned.profile.at(t);
        format!("{t},{x},{v},{a},{j},{s}")
    });
    std::iter::once(heading).chain(rows).collect::<Vec<_>>().join("\n") + "\n"
}

fn svg(planned: &Planned) -> String {
    let Planned { profile, unit, .. } = planned;
    let n = profile.order().derivative();
    // Switching instants too, so that the staircase of the highest derivative stands upright.
    let mut times = planned.times();
    times.extend(profile.segments().map(|segment| segment.start));
    times.sort_by(f64::total_cmp);
    times.dedup();
    let setpoints: Vec<Setpoint> = times.iter().map(|t| profile.at(*t)).collect();
    let columns: [Vec<f64>; 5] = [
        setpoints.iter().map(|at| at.x).collect(),
        setpoints.iter().map(|at| at.v).collect(),
        setpoints.iter().map(|at| at.a).collect(),
        setpoints.iter().map(|at| at.j).collect(),
        setpoints.iter().map(|at| at.s).collect(),
    ];
    let units: Vec<String> = (0..=n).map(|i| planned.unit_of(i)).collect();
    let limits: Vec<Option<f64>> =
        std::iter::once(None).chain(planned.limits().map(|limit| limit.is_finite().then_some(limit))).collect();
    let panels: Vec<Panel> = (0..=n)
        .map(|i| Panel { name: NAMES[i], unit: &units[i], values: &columns[i], limit: limits[i], held: i == n })
        .collect();
    let title = format!("{} in {}, order {n}", Quantity::new(profile.distance(), unit), seconds(profile.duration()));
    let subtitle: Vec<_> = dwells(profile).map(|(name, _, value)| format!("{name} = {}", seconds(value))).collect();
    PlanDrawing { title: &title, subtitle: &subtitle.join(",  "), times: &times, panels: &panels }.to_svg()
}
