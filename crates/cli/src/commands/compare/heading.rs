//! Heading above the table: names of the runs, and the differences between their scenarios.
use super::earlier::Earlier;
use super::slowing::Slowing;
use super::variants::Wanted;
use crate::args::{CompareArgs, Equal};
use crate::console::style;
use servobench_config::Choice as _;
use servobench_report::{elided, wrapped};
use servobench_results::{COMPARISON, printable};
use servobench_scenario::{Difference, Override, differences};
use servobench_trace::of_axis;

/// Differences that are listed; the others are counted.
const MOST: usize = 12;
/// Characters of a value that are shown.
const LONGEST: usize = 30;
/// Characters of a name of a run that are shown in a list.
const LONGEST_NAME: usize = 24;

/// The heading: the runs, the terms of the comparison, and the differences.
pub(super) fn heading(args: &CompareArgs, wanted: &[Wanted], earlier: &[Earlier], slowing: Option<&Slowing>) -> String {
    let terms = match &args.equal {
        None => "each at its own limits".to_owned(),
        Some(Equal::Limits) => "at equal limits".to_owned(),
        Some(Equal::Slowed(_)) => slowing.map(Slowing::terms).unwrap_or_default(),
    };
    let Some((first, others)) = wanted.split_first() else { return terms };
    let mut firsts: Vec<&Wanted> = vec![first];
    for one in others {
        if !firsts.iter().any(|other| other.file == one.file) {
            firsts.push(one);
        }
    }
    let name = |one: &&Wanted| printable(&one.job.scenario.name) + &of_axis(one.job.scenario.axis.name);
    let names: Vec<String> = firsts.iter().map(name).collect();
    let variants = wanted.iter().filter(|one| one.file == first.file).filter_map(|one| one.variant.as_ref());
    let variants: Vec<(&str, &str)> = variants.map(|(name, words)| (name.as_str(), words.as_str())).collect();
    let in_variants = match variants.len() {
        0 => String::new(),
        1 => " in 1 variant".to_owned(),
        many => format!(" in {many} variants"),
    };
    let before = if earlier.is_empty() { "" } else { ", beside earlier results" };
    let line = format!("{}{in_variants} on {}, {terms}{before}", listing(&names), first.job.engine.name());
    let mut text = wrapped(&line, style().width).join("\n");
    text += &of_all(&args.with.overrides);
    text += &named(&variants);
    for (other, name) in firsts[1..].iter().zip(&names[1..]) {
        let all = differences(&first.job.scenario.parameters, &other.job.scenario.parameters);
        let all: Vec<_> = all.into_iter().filter(|difference| is_of_the_run(&difference.key)).collect();
        let of = if firsts.len() > 2 { format!(" ({} against {name})", names[0]) } else { String::new() };
        text += &listed(&of, &all);
    }
    for one in earlier {
        text += &one.words(style().width);
    }
    text += &slowing.map(|slowing| slowing.words(wanted, style().width)).unwrap_or_default();
    text
}

/// `one`, `one and two`, `one, two and three`
fn listing(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [others @ .., last] => format!("{} and {last}", others.join(", ")),
    }
}

/// Keys that have another value in all runs.
fn of_all(overrides: &[Override]) -> String {
    if overrides.is_empty() {
        return String::new();
    }
    let overrides: Vec<String> = overrides.iter().map(|one| printable(&one.to_string())).collect();
    let words = format!("overrides of all runs: {}", overrides.join(", "));
    format!("\n{}", wrapped(&words, style().width.saturating_sub(2)).join("\n  "))
}

/// The variants with their settings, one or more lines for each.
fn named(variants: &[(&str, &str)]) -> String {
    let width = variants.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0).min(LONGEST_NAME);
    let lines = variants.iter().map(|(name, words)| {
        let room = style().width.saturating_sub(width + 4);
        let words = wrapped(&printable(words), room).join(&format!("\n{:1$}", "", width + 4));
        format!("\n  {:width$}  {words}", elided(name, LONGEST_NAME))
    });
    lines.collect()
}

/// True for a key that affects the run itself, other than the engine and the recorded channels.
fn is_of_the_run(key: &str) -> bool {
    key != "engine" && !key.starts_with("record.channels")
}

/// Differences, one line for each key: `drive.velocity.bandwidth  60 Hz against 90 Hz`.
fn listed(of: &str, all: &[Difference]) -> String {
    if all.is_empty() {
        return format!("\nthe files say the same{of}");
    }
    let value = |value: &Option<String>| {
        value.as_ref().map_or_else(|| "nothing".to_owned(), |value| elided(&printable(value), LONGEST))
    };
    let shown = &all[..all.len().min(MOST)];
    let keys = shown.iter().map(|difference| difference.key.chars().count());
    let key = keys.filter(|length| *length <= LONGEST).max().unwrap_or(0);
    let lines = shown.iter().map(|difference| {
        let values = format!("{} against {}", value(&difference.one), value(&difference.other));
        let line = format!("\n  {:key$}  {values}", difference.key);
        // The values go below a key that leaves them no room.
        if line.chars().count() > style().width + 1 { format!("\n  {}\n      {values}", difference.key) } else { line }
    });
    let more = all.len() - shown.len();
    let more = if more > 0 { format!("\n  and {more} more: see `parameters` in {COMPARISON}") } else { String::new() };
    format!("\nwhat differs{of}:{}{more}", lines.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_listed_by_key_and_value() {
        let difference = |key: &str, one: &str, other: Option<&str>| Difference {
            key: key.into(),
            one: Some(one.into()),
            other: other.map(str::to_owned),
        };
        let all = [
            difference("drive.velocity.bandwidth", "60 Hz", Some("90 Hz")),
            difference("drive.filter.1.frequency.of.the.notch.that.has.a.very.long.name", "1 kHz", None),
        ];
        assert_eq!(listed("", &all[..1]), "\nwhat differs:\n  drive.velocity.bandwidth  60 Hz against 90 Hz");
        let text = listed(" (a against b)", &all);
        let first = "\nwhat differs (a against b):\n  drive.velocity.bandwidth  60 Hz against 90 Hz\n";
        assert!(text.starts_with(first), "{text}");
        assert!(text.ends_with("long.name\n      1 kHz against nothing"), "{text}");
        let many: Vec<_> = (0..20).map(|k| difference(&format!("key{k}"), "1", Some("2"))).collect();
        assert!(listed("", &many).ends_with("\n  and 8 more: see `parameters` in comparison.json"));
    }

    #[test]
    fn variants_are_listed_below_each_other() {
        let long =
            "setpoint.shaper=[{ kind = \"zv\", frequency = \"17.5 Hz\" }, { kind = \"ei\", frequency = \"31 Hz\" }]";
        let text = named(&[("none", "no shaper"), ("two modes", long)]);
        assert!(text.starts_with("\n  none       no shaper\n  two modes  setpoint.shaper=[{ kind"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }
}
