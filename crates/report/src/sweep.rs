//! Results of a sweep: tables, and drawings over the dimensions that varied.
//!
//! ```text
//! Table of runs → Survey: dimensions (what varies), spread of each metric in each group
//!     ↳ combinations, quantiles, sensitivities, front                       in words
//!     ↳ heat maps over two dimensions, lines over one, distributions of draws, time against vibration     as SVG
//! ```
mod cells;
mod colours;
mod combinations;
mod dimension;
mod distributions;
mod heat;
mod layers;
mod lines;
mod metric;
mod scale;
mod scatter;
mod sections;

mod sheet;
mod survey;

use crate::style::Style;
use servobench_sweep::{Sweep, Table};
use std::borrow::Cow;
use survey::Survey;

/// Options of the report of a sweep.
#[derive(Debug, Clone, Copy, Default)]
pub struct SweepOptions<'a> {
    /// Name of the sweep: headline of drawings.
    pub title: &'a str,
    /// Meaning of the numbers, below the headline: `each at its worst over axis.load.frequency`.
    pub note: &'a str,
    /// The metric used as time; `None`: `move_and_settling_time`, else `move_time`.
    pub time: Option<&'a str>,
    /// The metric used as vibration; `None`: `residual_vibration_amplitude`, else `residual_vibration_pp`.
    pub vibration: Option<&'a str>,
    /// True if runs are judged by limits. Otherwise the number that keeps them is not reported.
    pub judged: bool,
    /// Vibrations that differ by no more are equal (axis unit).
    pub equal_length: f64,
    /// Key of the seed of random numbers, if too few of its values were run to distinguish a difference from chance; else empty.
    pub seed: &'a str,
}

/// Combinations to choose from: the keys of the machine and the engines are given, not chosen.
struct Choice<'a> {
    sweep: Option<Sweep>,
    /// Keys that are given: `axis.load.frequency`.
    given: Vec<&'a str>,
}

impl<'a> Choice<'a> {
    fn of(table: &Table<'a>) -> Self {
        let sweep: &'a Sweep = table.sweep;
        let engines = (table.engines.len() > 1).then_some("the engines");
        let given: Vec<&str> = sweep.machine_keys().iter().map(String::as_str).chain(engines).collect();
        let chosen = if given.is_empty() { None } else { sweep.chosen_for_a_machine() };
        Self { sweep: chosen, given }
    }

    /// The table of the combinations to choose from; `None` if there are none.
    fn table<'t>(&'t self, table: &'t Table<'a>) -> Option<Cow<'t, Table<'t>>>
    where
        'a: 't,
    {
        match &self.sweep {
            Some(chosen) => Some(Cow::Owned(table.at_worst_on_all_engines(chosen))),
            None => self.given.is_empty().then_some(Cow::Borrowed(table)),
        }
    }

    /// Note on the keys over which each combination is at its worst.
    fn words(&self) -> String {
        if self.given.is_empty() { String::new() } else { format!("each at its worst over {}", self.given.join(", ")) }
    }
}

/// Results of a sweep, in at most [`Style::width`] columns: a row for each combination of the keys and each engine, the scatter of
/// draws, the cost of each key, and the combinations that no other one beats in time and vibration.
///
/// With draws a row has the median, the bound that 95 % of them keep, and the share that keeps all limits with its lower bound at
/// 95 % confidence (Clopper and Pearson). A run without a verdict counts as not keeping them, and its measurements are left out; one
/// that broke a requirement never arrives. Combinations are compared at their worst over the keys of the machine and the engines.
#[must_use]
pub fn sweep_table(table: &Table<'_>, style: Style, options: &SweepOptions<'_>) -> String {
    let survey = Survey::of(table, options);
    let choice = Choice::of(table);
    let chosen = choice.table(table);
    let chosen = chosen.as_ref().map(|chosen| Survey::of(chosen, options));
    let front = chosen.map_or_else(
        || sections::no_choice(&survey, &choice.given, style),
        |chosen| sections::front(&chosen, &choice.words(), options.seed, style),
    );
    let sections = [
        combinations::combinations(&survey, style),
        sections::quantiles(&survey, style),
        sections::sensitivities(&survey, style),
        front,
        sections::remarks(&survey, options.seed, style),
    ];
    let parts: Vec<String> = sections.into_iter().filter(|part| !part.is_empty()).collect();
    parts.join("\n")
}

/// The metrics of a sweep over the dimensions that varied, as SVG: colours over two, lines over one, distributions over draws
/// alone. Further dimensions are small drawings side by side. `None` if nothing varied or nothing was measured.
#[must_use]
pub fn sweep_map(table: &Table<'_>, options: &SweepOptions<'_>) -> Option<String> {
    let survey = Survey::of(table, options);
    match survey.dimensions.len() {
        0 if survey.is_drawn => distributions::distributions(&survey, options.title),
        0 => None,
        1 => lines::lines(&survey, options.title),
        _ => heat::heat_maps(&survey, options.title),
    }
}

/// Vibration against time of all combinations to choose from, as SVG, with those that no other one beats in both. For draws the medians.
/// `None` if there is nothing to choose, or if one of the two was not measured.
#[must_use]
pub fn sweep_front(table: &Table<'_>, options: &SweepOptions<'_>) -> Option<String> {
    let choice = Choice::of(table);
    let table = choice.table(table)?;
    let survey = Survey::of(&table, options);
    let notes = [options.note.to_owned(), choice.words()];
    let notes: Vec<String> = notes.into_iter().filter(|note| !note.is_empty()).collect();
    if survey.dimensions.is_empty() { None } else { scatter::scatter(&survey, options.title, &notes.join("; ")) }
}
