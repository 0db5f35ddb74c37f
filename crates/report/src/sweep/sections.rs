//! Sections below the combinations: quantiles, sensitivities, the front, remarks.
use super::combinations::{NUMBER as WIDEST, broken, faint, painted};
use super::dimension::rounded;
use super::metric::{Measure, percent};
use super::survey::{CONFIDENCE, MOST, Survey};
use crate::style::{Ink, Style};
use crate::text::{elided, widest};
use servobench_sweep::{Influence, Outcome, Sample, Sensitivity, Value};

/// Most metrics whose sensitivities are listed, and most keys of each.
const METRICS: usize = 4;
const METRICS_OF_COMBINATIONS: usize = 2;
const KEYS: usize = 8;
/// Most combinations of the front.
const FRONT: usize = 12;
/// Width of a value in display units.
const NUMBER: usize = 9;
/// Width of `100 %`.
const SHARE: usize = 5;
/// Standard deviations beyond which it is not chance.
const BY_CHANCE: f64 = 2.0;
/// Smaller shares are not listed.
const LEAST: f64 = 0.005;

/// Quantiles of each metric, if only draws varied.
pub(super) fn quantiles(survey: &Survey<'_, '_>, style: Style) -> String {
    if !(survey.is_drawn && survey.dimensions.is_empty()) {
        return String::new();
    }
    let columns = survey.metrics.in_order(&survey.table);
    let measures: Vec<Measure> = columns.iter().map(|column| Measure::of(&survey.table.columns[*column])).collect();
    let samples: Vec<(&Measure, Sample)> = columns
        .iter()
        .zip(&measures)
        .filter_map(|(column, measure)| {
            Some((measure, Sample::of_times(survey.table.columns[*column].values.iter().copied())?))
        })
        .collect();
    let rows: Vec<[String; 5]> = samples.iter().map(|(measure, sample)| cells(measure, sample)).collect();
    let number = widest(rows.iter().flatten().map(String::as_str)).max(NUMBER);
    let room = style.width.saturating_sub(5 * (number + 1)).max("METRIC".len());
    let name = widest(measures.iter().map(|measure| measure.name.as_str())).clamp("METRIC".len(), room);
    let row = |name_of: &str, cells: &[String; 5]| {
        let cells: Vec<String> = cells.iter().map(|cell| format!(" {cell:>number$}")).collect();
        format!("{:name$}{}", elided(name_of, name), cells.concat())
    };
    let heading = row("METRIC", &["5 %", "MEDIAN", "95 %", "AT MOST", "MEAN"].map(str::to_owned));
    let mut text = style.paint(Ink::Heading, &heading) + "\n";
    for ((measure, sample), cells) in samples.iter().zip(&rows) {
        text += &row(&measure.name, cells);
        text.push('\n');
        let missing = survey.table.outcomes.len() - sample.count();
        if missing > 0 {
            text += &faint(&format!("{missing} draws without a value are not counted here"), style);
        }
    }
    let draws = survey.table.outcomes.len();
    text += &faint(
        &format!(
            "{draws} draws. AT MOST: what the 95 % quantile is not above, with 95 % confidence; it takes 59 draws"
        ),
        style,
    );
    if survey.is_judged {
        let kept = survey.kept(0);
        let (hits, trials, words) = (kept.hits(), kept.trials(), survey.kept_words(0));
        text += &broken(&format!("{hits} of {trials} runs keep all limits: {words} with 95 % confidence"), style.width);
    }
    text
}

/// Quantiles, the bound of the largest of them and the mean, in enough digits to distinguish them.
fn cells(measure: &Measure, sample: &Sample) -> [String; 5] {
    // Half of the remainder on either side: the bound alone then has the stated confidence.
    let [_, bound] = sample.interval(MOST, 2.0 * CONFIDENCE - 1.0);
    let [low, median, high] = [1.0 - MOST, 0.5, MOST].map(|share| sample.quantile(share));
    let [low, median, high, most, mean] =
        measure.texts_apart([low, median, high, bound.unwrap_or(high), sample.mean()]);
    [low, median, high, bound.map_or("–".to_owned(), |_| most), mean].map(|cell| elided(&cell, WIDEST))
}

/// Cost of each key.
pub(super) fn sensitivities(survey: &Survey<'_, '_>, style: Style) -> String {
    let (mut text, table) = (String::new(), &*survey.table);
    let most = if survey.dimensions.is_empty() { METRICS } else { METRICS_OF_COMBINATIONS };
    for column in survey.metrics.in_order(table).into_iter().take(most) {
        let measure = Measure::of(&table.columns[column]);
        let of_draws = Sensitivity::of_draws(table, &table.columns[column]);
        // A single axis explains everything.
        let of_axes = Sensitivity::of_axes(table, &table.columns[column]).filter(|of_axes| of_axes.keys.len() > 1);
        for (found, what) in [(of_draws, "the draws scatter"), (of_axes, "the combinations differ")] {
            let Some(found) = found else { continue };
            let deviation = measure.text(found.deviation);
            if !text.is_empty() {
                text.push('\n');
            }
            let heading = format!("Why {what} in {} (standard deviation {deviation})", measure.name);
            text += &painted(&heading, Ink::Heading, style);
            let (told, rest): (Vec<&Influence>, Vec<&Influence>) = found.keys.iter().partition(|key| is_told(key));
            for key in told.iter().take(KEYS) {
                text += &influence(key, &measure, style);
            }
            let rest: Vec<String> =
                told.iter().skip(KEYS).chain(&rest).map(|key| servobench_results::printable(&key.key)).collect();
            if !rest.is_empty() {
                text += &beside("–", &format!("{}: less, or not told from chance", rest.join(", ")), style);
            }
            text += &beside(&whole(found.rest), "no key alone", style);
        }
    }
    text
}

/// A share of a variance in whole percent.
fn whole(share: f64) -> String {
    if share < LEAST { "< 1 %".to_owned() } else { format!("{:.0} %", 100.0 * share) }
}

/// True if the share of a key is large enough to list.
fn is_told(key: &Influence) -> bool {
    key.share >= LEAST && key.share > BY_CHANCE * key.chance
}

/// `62 %  axis.load.mass: 12.0 ms more at 5.44 kg than at 4.56 kg`.
fn influence(key: &Influence, measure: &Measure, style: Style) -> String {
    let name = servobench_results::printable(&key.key);
    let (difference, at) = (key.difference(), |value: &Value| match value {
        Value::Number(number, unit) if unit.is_empty() => rounded(*number, 3),
        Value::Number(number, unit) => format!("{} {}", rounded(*number, 3), servobench_results::printable(unit)),
        Value::Text(text) => servobench_results::printable(text),
    });
    let (high, low) = (at(&key.high.at), at(&key.low.at));
    let words = if difference.abs() <= BY_CHANCE * key.error {
        "about the same at both ends".to_owned()
    } else {
        let more = if difference > 0.0 { "more" } else { "less" };
        format!("{} {more} at {high} than at {low}", measure.text(difference.abs()))
    };
    beside(&whole(key.share), &format!("{name}: {words}"), style)
}

/// `text` wrapped to the right of `share`.
fn beside(share: &str, text: &str, style: Style) -> String {
    let lines = broken(text, style.width.saturating_sub(SHARE + 2).max(20));
    let line = |(k, line): (usize, &str)| format!("{:>SHARE$}  {line}\n", if k == 0 { share } else { "" });
    lines.lines().enumerate().map(line).collect()
}

/// Explanation of a missing front: all keys describe the machine, so that nothing is left to choose.
pub(super) fn no_choice(survey: &Survey<'_, '_>, given: &[&str], style: Style) -> String {
    if survey.dimensions.is_empty() || survey.metrics.time.is_none() || survey.metrics.vibration.is_none() {
        return String::new();
    }
    let given = servobench_results::printable(&given.join(", "));
    painted(&format!("Nothing to choose: {given} {} what the machine is", is_or_are(&given)), Ink::Heading, style)
}

fn is_or_are(given: &str) -> &'static str {
    if given.contains(", ") || given == "the engines" { "are" } else { "is" }
}

/// The combinations that no other one beats in time and vibration, `at_worst` over the given keys.
pub(super) fn front(survey: &Survey<'_, '_>, at_worst: &str, seed: &str, style: Style) -> String {
    let (Some(time), Some(vibration)) = (survey.metrics.time, survey.metrics.vibration) else { return String::new() };
    let front = survey.front();
    if survey.dimensions.is_empty() {
        return String::new();
    }
    if front.is_empty() {
        let is_any_good = (0..survey.table.groups()).any(|group| !survey.is_marked(group));
        let words = if is_any_good { "No combination has both numbers" } else { "No combination is left: all failed" };
        return painted(words, Ink::Heading, style);
    }
    let measures = [time, vibration].map(|column| Measure::of(&survey.table.columns[column]));
    let [faster, calmer] = measures.each_ref().map(|measure| measure.name.as_str());
    let of = if survey.is_drawn { "medians of " } else { "" };
    let good = survey.of_good();
    let at_worst =
        if at_worst.is_empty() { String::new() } else { format!(", {}", servobench_results::printable(at_worst)) };
    let noise = if seed.is_empty() { "No" } else { "Within noise: no" };
    let heading = format!("{noise} other combination{good} is smaller in both {of}{faster} and {calmer}{at_worst}");
    let mut text = String::new();
    text += &painted(&heading, Ink::Heading, style);
    for group in front.iter().take(FRONT) {
        let value = |measure: &Measure, column| {
            let spread = survey.with_never(column, *group);
            format!("{:>NUMBER$}", spread.map_or("–".to_owned(), |spread| measure.text(spread.median)))
        };
        let numbers = format!("{}  {}", value(&measures[0], time), value(&measures[1], vibration));
        let kept = if survey.is_judged && survey.is_drawn {
            format!(" ({} keep all limits)", percent(survey.kept(*group).share()))
        } else {
            String::new()
        };
        let words = format!("{}{kept}", survey.words(*group));
        let indent = numbers.chars().count() + 2;
        let lines = broken(&words, style.width.saturating_sub(indent).max(20));
        for (k, line) in lines.lines().enumerate() {
            let before = if k == 0 { format!("{numbers}  ") } else { " ".repeat(indent) };
            text.push_str(&before);
            text.push_str(line);
            text.push('\n');
        }
    }
    let more = front.len().saturating_sub(FRONT);
    if more > 0 {
        text += &faint(&format!("{more} more, slower ones are not shown"), style);
    }
    text
}

/// Remarks on the numbers above.
pub(super) fn remarks(survey: &Survey<'_, '_>, seed: &str, style: Style) -> String {
    let of = survey.table.outcomes.len();
    let runs = |count: usize| if count == 1 { "run" } else { "runs" };
    let mut text = String::new();
    let broken = survey.count_of(Outcome::Broken);
    if broken > 0 {
        let words = format!(
            "{broken} of {of} {} broke a requirement: later than all others, and not in any other number",
            runs(of)
        );
        text += &painted(&words, Ink::Warning, style);
    }
    let without = survey.count_of(Outcome::NoVerdict);
    if without > 0 {
        let end = if survey.is_judged {
            "; they count as runs that do not keep all limits, and not in any other number"
        } else {
            "; they are not in any number"
        };
        let words = format!("{without} of {of} runs have no verdict (invalid, ended in an error, or not run){end}");
        text += &painted(&words, Ink::Warning, style);
    }
    if !seed.is_empty() {
        let words = format!(
            "random numbers: differences may be chance; vary `{}` over at least 5 values",
            servobench_results::printable(seed)
        );
        text += &painted(&words, Ink::Warning, style);
    }
    text
}
