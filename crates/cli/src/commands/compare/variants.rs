//! Runs of a comparison: scenario files, each in variants.
use super::labels::labels;
use super::seeds;
use crate::args::{CompareArgs, Shapers, Variant};
use crate::error::CliError;
use crate::sources;
use servobench_config::Choice as _;
use servobench_metrics::Quantity;
use servobench_motion::shape::ShaperKind;
use servobench_results::printable;
use servobench_scenario::{Override, Scenario};
use servobench_suite::{Job, Source, jobs};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// A run that is to be made.
pub(super) struct Wanted {
    pub(super) job: Job,
    /// Name in tables and text.
    pub(super) label: String,
    /// The variant, by its name and in words; `None` without one.
    pub(super) variant: Option<(String, String)>,
    /// Index of its file among the scenarios.
    pub(super) file: usize,
    /// Its scenario with other seeds of its random numbers; empty where it has none.
    pub(super) reseeded: Vec<Source>,
}

/// A variant of one file.
struct Shaped {
    name: String,
    overrides: Vec<Override>,
    words: String,
}

/// Every scenario in every variant, all on the same engine.
pub(super) fn wanted(args: &CompareArgs) -> Result<Vec<Wanted>, CliError> {
    for (k, variant) in args.variants.iter().enumerate() {
        if args.variants[..k].iter().any(|other| other.name == variant.name) {
            return Err(CliError::VariantTwice(variant.name.clone()));
        }
    }
    let files = sources::load(&args.scenarios, &args.with)?;
    let names = names(&files);
    let of_files = labels(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let engine = args.engine.or_else(|| files.first().and_then(|source| source.scenario.engines.first().copied()));
    let (mut all, mut of_all, mut seeds) = (Vec::new(), Vec::new(), Vec::new());
    let is_one = files.len() == 1;
    let mut said = HashSet::new();
    for (file, source) in files.into_iter().enumerate() {
        let variants = variants(args, &source.scenario)?;
        if variants.is_empty() {
            seeds.push(seeds::reseeded(&source, args, &[]));
            all.push(source);
            of_all.push((of_files[file].clone(), None, file));
            continue;
        }
        let path = source.scenario.path.clone().unwrap_or_else(|| PathBuf::from("-"));
        for Shaped { name, overrides, words } in variants {
            let varied = varied(&source, &path, args, &name, &overrides, &mut said)?;
            seeds.push(seeds::reseeded(&varied, args, &overrides));
            all.push(varied);
            let name = printable(&name);
            let label = if is_one { name.clone() } else { format!("{} {name}", of_files[file]) };
            of_all.push((label, Some((name, words)), file));
        }
    }
    let mut unique: Vec<String> = Vec::new();
    for (label, ..) in &of_all {
        let mut one = label.clone();
        let mut number = 1;
        while unique.contains(&one) {
            number += 1;
            one = format!("{label}-{number}");
        }
        unique.push(one);
    }
    let jobs = jobs(all, &[engine.unwrap_or_default()]).into_iter().zip(unique).zip(of_all).zip(seeds);
    let wanted = jobs.map(|(((mut job, label), (_, variant, file)), reseeded)| {
        if variant.is_some() {
            job.call(label.clone());
        }
        Wanted { job, label, variant, file, reseeded }
    });
    Ok(wanted.collect())
}

/// Names of the scenarios; where their axes have different names, with these behind them.
fn names(files: &[Source]) -> Vec<String> {
    let axis = |source: &Source| source.scenario.axis.name;
    let is_one_axis = files.iter().all(|source| axis(source) == axis(&files[0]));
    let of_axis = |source| axis(source).filter(|_| !is_one_axis).map(|axis| format!("-{axis}")).unwrap_or_default();
    files.iter().map(|source| printable(&source.scenario.name) + &of_axis(source)).collect()
}

/// `source` in one variant.
fn varied(
    source: &Source,
    path: &Path,
    args: &CompareArgs,
    name: &str,
    overrides: &[Override],
    said: &mut HashSet<String>,
) -> Result<Source, CliError> {
    if overrides.is_empty() {
        return Ok(source.clone());
    }
    sources::variant(path, &args.with, overrides, said).map_err(|error| CliError::Variant {
        variant: name.to_owned(),
        scenario: path.to_owned(),
        error,
    })
}

/// The variants of a scenario: the named ones, then one for each shaper.
fn variants(args: &CompareArgs, scenario: &Scenario) -> Result<Vec<Shaped>, CliError> {
    let named = args.variants.iter().map(|Variant { name, overrides }| {
        let written: Vec<String> = overrides.iter().map(ToString::to_string).collect();
        let words = if written.is_empty() { "as it is".to_owned() } else { written.join("; ") };
        Shaped { name: name.clone(), overrides: overrides.clone(), words }
    });
    let mut all: Vec<Shaped> = named.collect();
    let kinds = Shapers::kinds(&args.shaper.kinds);
    let is_own = |key: &str| key.starts_with("program.") && key.split('.').nth(2) == Some("shaper");
    if let Some(own) = scenario.parameters.iter().find(|parameter| !kinds.is_empty() && is_own(&parameter.key)) {
        return Err(CliError::Shaper(format!(
            "--shaper: `{}` gives `{}` to one move, which would keep it; name the variants by --variant",
            scenario.name, own.key
        )));
    }
    let modes = if kinds.iter().any(Option::is_some) { modes(args, scenario)? } else { Vec::new() };
    for kind in kinds {
        all.push(shaped(kind, &modes, scenario)?);
    }
    Ok(all)
}

/// Frequency (Hz) and damping ratio of the modes that shapers suppress.
fn modes(args: &CompareArgs, scenario: &Scenario) -> Result<Vec<(f64, f64)>, CliError> {
    let frequencies = match (args.shaper.frequencies.as_slice(), scenario.measure.mode) {
        ([], Some(mode)) => vec![mode],
        ([], None) => {
            return Err(CliError::Shaper(format!(
                "--shaper: `{}` names no mode: give its frequency, as in --shaper-frequency 17.5Hz, or measure.mode in the \
                 scenario",
                scenario.name
            )));
        }
        (given, _) => given.to_vec(),
    };
    let dampings = match args.shaper.dampings.as_slice() {
        [] => vec![0.0; frequencies.len()],
        [one] => vec![*one; frequencies.len()],
        many if many.len() == frequencies.len() => many.to_vec(),
        many => {
            let (dampings, modes) = (many.len(), frequencies.len());
            return Err(CliError::Shaper(format!(
                "--shaper-damping: {dampings} damping ratios for {modes} modes; give one for all, or one for each"
            )));
        }
    };
    Ok(frequencies.into_iter().zip(dampings).collect())
}

/// The variant with a shaper of this kind, or without a shaper.
fn shaped(kind: Option<ShaperKind>, modes: &[(f64, f64)], scenario: &Scenario) -> Result<Shaped, CliError> {
    const KEY: &str = "setpoint.shaper";
    let Some(kind) = kind else {
        // A scenario without a shaper needs no override.
        let has_one = scenario.parameters.iter().any(|parameter| parameter.key.starts_with(KEY));
        let written = has_one.then(|| format!("{KEY}={{ kind = \"none\" }}"));
        let overrides = written.iter().map(|text| parsed(text)).collect::<Result<_, _>>()?;
        return Ok(Shaped { name: "none".into(), overrides, words: "no shaper".into() });
    };
    let tables = modes.iter().map(|(frequency, damping)| {
        let damping = if *damping > 0.0 { format!(", damping = {damping}") } else { String::new() };
        format!("{{ kind = \"{}\", frequency = \"{frequency} Hz\"{damping} }}", kind.name())
    });
    let tables: Vec<String> = tables.collect();
    let value = if let [one] = tables.as_slice() { one.clone() } else { format!("[{}]", tables.join(", ")) };
    let against = modes.iter().map(|(frequency, damping)| {
        let damping =
            if *damping > 0.0 { format!(" (ζ = {:.2})", Quantity::new(*damping, "")) } else { String::new() };
        format!("{:.4}{damping}", Quantity::new(*frequency, "Hz"))
    });
    let against: Vec<String> = against.collect();
    let words = format!("shaper {} against {}", kind.name(), against.join(" and "));
    Ok(Shaped { name: kind.name().to_owned(), overrides: vec![parsed(&format!("{KEY}={value}"))?], words })
}

/// An override that is made here.
fn parsed(text: &str) -> Result<Override, CliError> {
    text.parse().map_err(|error: servobench_scenario::OverrideError| CliError::Shaper(format!("`{text}`: {error}")))
}
