//! `servobench advise`: the fastest set-point that keeps the limits of a scenario on every machine within the given tolerances.
mod runs;

use crate::args::{AdviseArgs, Shapers};
use crate::console::{command, print, say, style};
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::Outputs;
use crate::sources;
use runs::Runs;
use servobench::usage::{LoadMode, limits_of_set_point, load_mode, longest_move};
use servobench_advise::{Family, Machines, Question, Range, Stretch, advise as find, refuse_impossible};
use servobench_base::Coordinate;
use servobench_config::Choice as _;
use servobench_metrics::digits;
use servobench_motion::Limits;
use servobench_motion::shape::ShaperKind;
use servobench_report::{AdviceOptions, advice_json, advice_text};
use servobench_scenario::{KeyRange, root_of};
use servobench_suite::Source;
use std::path::Path;
use thiserror::Error;

/// Why nothing can be advised.
#[derive(Debug, Error)]
pub(crate) enum AdviseMistake {
    #[error(
        "the scenario has no `[limits]` that a set-point could be chosen by: give `residual_vibration_pp`, for example"
    )]
    NoLimits,
    #[error(
        "the scenario has no move from rest to rest by velocity and acceleration: give `setpoint` and a `[[program]]` with `move_to`"
    )]
    NoMove,
    #[error("nothing of this axis is coupled by a spring: say with `--within KEY=RANGE` what its machines may be")]
    NoMode,
    #[error("with {settings} {why}: no set-point moves such an axis")]
    Unstable { settings: String, why: String },
    #[error("--choose: `{0}` is no key with values; write it as drive.position.bandwidth=20 Hz,30 Hz")]
    NoChoice(String),
    #[error("--within: with {settings} the scenario is invalid:\n{why}")]
    Machine { settings: String, why: String },
}

/// Default tolerances of the load's frequency and damping ratio, as factors of those of the scenario.
const FREQUENCIES: [f64; 2] = [0.9, 1.1];
const DAMPINGS: [f64; 2] = [0.5, 2.0];

/// Finds the set-point and prints it with its price and its certainty.
pub(crate) fn advise(args: &AdviseArgs) -> Result<Exit, CliError> {
    let folder = args.scenario.parent().unwrap_or_else(|| Path::new(""));
    let root = root_of(folder, args.with.root.as_deref())
        .map_err(|error| CliError::Read { path: args.scenario.clone(), error })?;
    let (document, base) = sources::base(&args.scenario, &args.with.overrides, &root)?;
    let scenario = &base.scenario;
    let limits: Vec<_> = scenario.limits.iter().copied().filter(|limit| limit.max.is_some()).collect();
    if limits.is_empty() {
        return Err(AdviseMistake::NoLimits.into());
    }
    let mode = load_mode(scenario);
    let machines = Machines::new(ranges(args, scenario.axis.motion, mode.as_ref())?);
    let frequency = frequency(&machines, scenario.measure.mode, mode.as_ref());
    let question = Question {
        families: families(args, &base, mode.as_ref(), frequency)?,
        ceiling: ceiling(args, &base)?,
        distance: longest_move(scenario).ok_or(AdviseMistake::NoMove)?,
        machines,
        frequency: frequency.unwrap_or_default(),
        limits: limits.len(),
        priced: limits.iter().position(|limit| limit.metric.as_str().starts_with("residual_vibration")),
        share: args.share,
        draws: args.draws,
        seed: args.seed,
    };
    let mut outputs = Outputs::default();
    let output = args.output.as_deref().map(|path| outputs.anywhere("-o", path)).transpose()?;
    let mut runs = Runs::new(args, &base, &document, &limits, &question)?;
    refuse_impossible(&question)?;
    runs.check()?;
    let kinds = if question.families.len() == 1 { "kind" } else { "kinds" };
    say(&format!("looking for a set-point among {} {kinds}\n", question.families.len()));
    let advice = find(&question, &mut runs);
    runs.finish();
    let advice = advice?;
    let options = AdviceOptions {
        scenario: &scenario.name,
        engine: runs.engine().name(),
        limits: &limits,
        motion: scenario.axis.motion,
        command: &command(&["run", &args.scenario.to_string_lossy()]),
        settings: runs.settings(&advice.point),
        is_assumed: args.within.is_empty(),
        has_window: scenario.measure.window.is_some(),
        shaper_frequency: frequency,
    };
    // The advice is printed before a write can fail.
    print(&advice_text(&question, &advice, &options, style()))?;
    if let Some(output) = output {
        let json = advice_json(&question, &advice, &options);
        output.write_text(&(serde_json::to_string_pretty(&json).map_err(CliError::Schema)? + "\n"))?;
    }
    Ok(Exit::Passed)
}

/// Tolerances of the machines: those of `--within`, or the default ones.
fn ranges(args: &AdviseArgs, motion: Coordinate, mode: Option<&LoadMode>) -> Result<Vec<Range>, CliError> {
    if !args.within.is_empty() {
        let names: Vec<&str> = args.within.iter().map(|range| range.key.as_str()).collect();
        return Ok(args.within.iter().map(|range| with_stretch(range, &names)).collect());
    }
    Ok(default_ranges(mode.ok_or(AdviseMistake::NoMode)?, motion))
}

/// Default tolerances of the spring nearest to the load, in keys of that spring's table: no machine gets a spring that the scenario lacks.
fn default_ranges(mode: &LoadMode, motion: Coordinate) -> Vec<Range> {
    let range = |key: &str, value: f64, factors: [f64; 2], unit: &str, stretch| Range {
        key: format!("{}.{key}", mode.table),
        ends: factors.map(|factor| factor * value),
        unit: unit.to_owned(),
        stretch,
    };
    if mode.is_alone {
        return vec![
            range("frequency", mode.frequency, FREQUENCIES, "Hz", Stretch::Frequency),
            range("damping_ratio", mode.damping_ratio, DAMPINGS, "", Stretch::None),
        ];
    }
    let (stiffness, damping) = match motion {
        Coordinate::Linear => ("N/m", "N s/m"),
        Coordinate::Rotary => ("Nm/rad", "Nm s/rad"),
    };
    // The frequency is proportional to the root of the stiffness.
    let stiffnesses = FREQUENCIES.map(|factor| factor * factor);
    vec![
        range("stiffness", mode.link.stiffness, stiffnesses, stiffness, Stretch::Root),
        range("damping", mode.link.damping, DAMPINGS, damping, Stretch::None),
    ]
}

/// `range` with its effect on the mode; a mass or stiffness moves the mode unless the frequency is given by its own key.
fn with_stretch(range: &KeyRange, names: &[&str]) -> Range {
    let (table, last) = range.key.rsplit_once('.').unwrap_or(("", &range.key));
    let has_frequency = names.contains(&format!("{table}.frequency").as_str());
    let stretch = match last {
        "frequency" => Stretch::Frequency,
        "stiffness" | "mass" | "inertia" if !has_frequency => Stretch::Root,
        _ => Stretch::None,
    };
    Range { key: range.key.clone(), ends: range.ends, unit: range.unit.clone(), stretch }
}

/// The frequency in the middle of its tolerance, else the measured mode's, else the load's.
fn frequency(machines: &Machines, measured: Option<f64>, mode: Option<&LoadMode>) -> Option<f64> {
    let middle = machines.middle();
    let own = machines.ranges().iter().zip(middle).find(|(range, _)| range.stretch == Stretch::Frequency);
    own.map(|(_, value)| value).or(measured).or(mode.map(|mode| mode.frequency))
}

/// The largest limits of the set-point.
fn ceiling(args: &AdviseArgs, base: &Source) -> Result<Limits, CliError> {
    let limits = limits_of_set_point(&base.scenario).ok_or(AdviseMistake::NoMove)?;
    let kept = |limit: f64| if args.keep_jerk_and_snap { limit } else { f64::INFINITY };
    Ok(Limits {
        velocity: limits.velocity,
        acceleration: limits.acceleration,
        jerk: kept(limits.jerk),
        snap: kept(limits.snap),
    })
}

/// Kinds of set-points: each order, with each shaper where it may have one, with each choice.
fn families(
    args: &AdviseArgs,
    base: &Source,
    mode: Option<&LoadMode>,
    frequency: Option<f64>,
) -> Result<Vec<Family>, CliError> {
    let orders = if args.order.is_empty() { vec![2, 3, 4] } else { args.order.clone() };
    let mut families = Vec::new();
    for order in orders {
        families.push(Family { order, shaper: None, settings: without_shaper(base), name: format!("order {order}") });
        let Some(frequency) = frequency.filter(|_| order < 4) else { continue };
        let (frequency, damping) =
            (digits(frequency, DIGITS), digits(mode.map_or(0.0, |mode| mode.damping_ratio), DIGITS));
        let wanted = if args.shaper.is_empty() { &[Shapers::All][..] } else { &args.shaper };
        for kind in Shapers::kinds(wanted).into_iter().flatten().map(ShaperKind::name) {
            let table =
                format!("setpoint.shaper={{ kind = \"{kind}\", frequency = \"{frequency} Hz\", damping = {damping} }}");
            families.push(Family {
                order,
                shaper: Some(kind.to_owned()),
                settings: vec![table],
                name: format!("order {order}, {kind}"),
            });
        }
    }
    for choice in &args.choose {
        let (key, values) = choice.split_once('=').ok_or_else(|| AdviseMistake::NoChoice(choice.clone()))?;
        let values: Vec<&str> = values.split(',').map(str::trim).collect();
        if values.iter().any(|value| value.is_empty()) {
            return Err(AdviseMistake::NoChoice(choice.clone()).into());
        }
        let with = |family: &Family, value: &str| Family {
            order: family.order,
            shaper: family.shaper.clone(),
            settings: [&family.settings[..], &[format!("{key}={value}")]].concat(),
            name: format!("{}, {key} {value}", family.name),
        };
        families = families.iter().flat_map(|family| values.iter().map(move |value| with(family, value))).collect();
    }
    Ok(families)
}

/// Significant digits of a shaper's frequency and damping: settings have no more.
const DIGITS: usize = 4;

/// Override that removes the shaper of the scenario, if it has one.
fn without_shaper(base: &Source) -> Vec<String> {
    let has_one = base.scenario.parameters.iter().any(|one| one.key.starts_with("setpoint.shaper"));
    if has_one { vec!["setpoint.shaper={ kind = \"none\" }".to_owned()] } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_scenario::{AxisMechanics, Document, Key, Override, Scenario};

    const HEAD: &str = "run.base_rate = \"4 kHz\"\nmotor.kind = \"prescribed\"\n[[program]]\nwait = \"1 s\"\n[axis]\nmotion = \"linear\"\n";

    /// Springs between the bodies of an axis, and inertias.
    fn structure(scenario: &Scenario) -> (Vec<f64>, Vec<f64>) {
        let AxisMechanics::Bodies(chain) = &scenario.axis.mechanics else { panic!("{:?}", scenario.axis.mechanics) };
        let springs = chain.links().iter().map(|link| link.stiffness).collect();
        (springs, chain.bodies().iter().map(|body| body.inertia).collect())
    }

    /// For every form of the spring and everything bolted to it: as many springs, the same inertias, and the mode from −10 to +10 % of its
    /// frequency.
    #[test]
    fn each_machine_of_a_default_tolerance_has_the_structure_of_the_scenario() {
        let table = |spring: &str| format!("table = {{ mass = \"3.4 kg\", {spring} }}\n");
        let load = |spring: &str| format!("load = {{ mass = \"10 kg\"{spring} }}\n");
        let springs = [
            "stiffness = \"614 N/mm\", damping_ratio = 0.02",
            "stiffness = \"614 N/mm\", damping = \"90 N s/m\"",
            "frequency = \"34 Hz\", damping_ratio = 0.02",
            "frequency = \"34 Hz\"",
        ];
        for spring in springs {
            let bodies = [
                table(spring),
                table(spring) + &load(""),
                load(&format!(", {spring}")),
                table("stiffness = \"900 N/mm\"") + &load(&format!(", {spring}")),
            ];
            for bodies in bodies {
                let text = format!("{HEAD}{bodies}");
                let document = Document::parse("a", &text, None, None).unwrap();
                let own = document.scenario(&[]).unwrap_or_else(|error| panic!("{error}\n{text}")).scenario;
                let mode = load_mode(&own).unwrap();
                let ranges = default_ranges(&mode, Coordinate::Linear);
                let (springs, inertias) = structure(&own);
                let mut ratios = Vec::new();
                for machine in Machines::new(ranges.clone()).corners() {
                    let set = |(range, value): (&Range, &f64)| {
                        let value = servobench_sweep::Value::Number(*value, range.unit.clone());
                        Override::new(&range.key.parse::<Key>().unwrap(), &value).unwrap()
                    };
                    let overrides: Vec<Override> = ranges.iter().zip(&machine).map(set).collect();
                    let varied = document.scenario(&overrides);
                    let varied = varied.unwrap_or_else(|error| panic!("{error}\n{text}{machine:?}")).scenario;
                    let (other, masses) = structure(&varied);
                    assert_eq!((other.len(), &masses), (springs.len(), &inertias), "{bodies}");
                    ratios.push(load_mode(&varied).unwrap().frequency / mode.frequency);
                }
                let ends = ratios.iter().fold([f64::INFINITY, 0.0], |[low, high], one| [low.min(*one), one.max(high)]);
                assert!((ends[0] - 0.9).abs() < 1e-9 && (ends[1] - 1.1).abs() < 1e-9, "{bodies}: {ends:?}");
            }
        }
    }
}
