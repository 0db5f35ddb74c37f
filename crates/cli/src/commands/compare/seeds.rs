//! Runs with random numbers, repeated with other seeds: a difference within this noise is not one.
use super::variants::Wanted;
use crate::args::CompareArgs;
use crate::sources;
use servobench_scenario::{Override, Seed};
use servobench_suite::{Job, Source, reseeded as with_source};
use std::path::{Path, PathBuf};

/// The scenario of `source` with each further seed and with `overrides` beside those of all runs; empty where it has no random numbers, or
/// where an override does not allow another seed: its differences then count as noise.
pub(super) fn reseeded(source: &Source, args: &CompareArgs, overrides: &[Override]) -> Vec<Source> {
    let seeds = source.scenario.seeds();
    if seeds.is_empty() {
        return Vec::new();
    }
    let path = source.scenario.path.clone().unwrap_or_else(|| PathBuf::from("-"));
    let all = (1..args.seeds).map_while(|further| again(&path, args, overrides, &seeds, further));
    all.collect()
}

/// The scenario at `path` with each seed increased by `further`.
fn again(path: &Path, args: &CompareArgs, overrides: &[Override], seeds: &[Seed], further: u32) -> Option<Source> {
    let is_seed = |one: &Override| seeds.iter().any(|seed| key_of(one) == seed.key);
    let mut all: Vec<Override> =
        args.with.overrides.iter().chain(overrides).filter(|one| !is_seed(one)).cloned().collect();
    for Seed { key, value } in seeds {
        all.push(format!("{key}={}", value.wrapping_add(further)).parse().ok()?);
    }
    let with = crate::args::OverrideArgs { overrides: all, root: args.with.root.clone() };
    sources::again(path, &with).ok()
}

/// The key of an override as results name it: `bus.fault.0.seed`.
fn key_of(one: &Override) -> String {
    let text = one.to_string();
    let key = text.split_once('=').map_or(text.as_str(), |(key, _)| key);
    key.trim().replace('[', ".").replace([']', '"', '\''], "")
}

/// The jobs with further seeds, each with the index of the run that it repeats.
pub(super) fn jobs(wanted: &[Wanted]) -> Vec<(usize, Job)> {
    let all = wanted.iter().enumerate().flat_map(|(place, one)| {
        let each = one.reseeded.iter().zip(1..);
        each.map(move |(source, number)| {
            (place, with_source(&one.job, source.clone(), format!("{}-seed-{number}", one.job.id)))
        })
    });
    all.collect()
}
