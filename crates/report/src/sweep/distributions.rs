//! Distributions of the metrics over the draws: the share that is at or below each value.
use super::layers::{MOST_LAYERS, note_of_left_out};
use super::metric::Measure;
use super::scale::{Scale, apart, range, spans_decades};
use super::sheet::{LEFT, LETTERS, RIGHT, Sheet, WIDTH};
use super::survey::{MOST, Survey};
use crate::drawing::COLOURS;
use servobench_sweep::Sample;

/// Heights of a panel, of its heading and of the axis below it (pixels).
const HEIGHT: f64 = 120.0;
const HEADING: f64 = 28.0;
const AXIS: f64 = 24.0;
/// Most steps drawn of a distribution.
const MOST_STEPS: usize = 400;

/// The drawing; `None` if no metric was measured.
pub(super) fn distributions(survey: &Survey<'_, '_>, title: &str) -> Option<String> {
    let table = &*survey.table;
    let columns = survey.metrics.in_order(table);
    let samples: Vec<(Measure, Sample)> = columns
        .iter()
        .filter_map(|column| {
            let column = &table.columns[*column];
            Some((Measure::of(column), Sample::of(column.values.iter().copied())?))
        })
        .collect();
    let (drawn, constant): (Vec<_>, Vec<_>) = samples.into_iter().partition(|(_, sample)| sample.deviation() > 0.0);
    let (drawn, constant) = if drawn.is_empty() { (constant, drawn) } else { (drawn, constant) };
    let (drawn, rest) = drawn.split_at(drawn.len().min(MOST_LAYERS));
    if drawn.is_empty() {
        return None;
    }
    let runs = table.outcomes.len();
    let kept = if survey.is_judged {
        format!("; all limits kept by {} (95 % confidence)", survey.kept_words(0))
    } else {
        String::new()
    };
    let mut sheet = Sheet::new(title, &format!("share of {runs} draws that is not above a value{kept}"));
    for (k, (measure, sample)) in drawn.iter().enumerate() {
        let top = sheet.y + HEADING;
        draw_panel(&mut sheet, measure, sample, COLOURS[k % COLOURS.len()], top, runs);
        sheet.y = top + HEIGHT + AXIS;
    }
    let left_out: Vec<String> = rest.iter().chain(&constant).map(|(measure, _)| measure.name.clone()).collect();
    if let Some(note) = note_of_left_out(&left_out) {
        sheet.note(&note);
    }
    Some(sheet.to_svg())
}

fn draw_panel(sheet: &mut Sheet, measure: &Measure, sample: &Sample, colour: &str, top: f64, runs: usize) {
    let (bottom, right) = (top + HEIGHT, WIDTH - RIGHT);
    let all = range(sample.sorted().iter().copied()).unwrap_or((0.0, 0.0));
    let along = Scale::with_room(all, spans_decades(all), LEFT, right);
    let up = Scale::tight((0.0, 1.0), false, bottom, top);
    let (unit, ticks) = along.ticks(measure, 8.0);
    let [low, median, high] = [1.0 - MOST, 0.5, MOST].map(|share| sample.quantile(share));
    let values = measure.texts_apart([low, median, high]);
    let mut words: Vec<String> =
        ["5 %", "50 %", "95 %"].iter().zip(values).map(|(share, value)| format!("{share} ≤ {value}")).collect();
    if sample.count() < runs {
        words.push(format!("{} not measured", runs - sample.count()));
    }
    sheet.heading(top - 8.0, &measure.name, &unit, colour, &words.join("  ·  "));
    for (x, label) in apart(&ticks, LETTERS) {
        sheet.line("g", [x, top], [x, bottom]);
        sheet.anchored("k", "middle", [x, bottom + 16.0], &label);
    }
    sheet.line("z", [LEFT, bottom], [right, bottom]);
    sheet.line("g", [LEFT, top], [right, top]);
    for (share, value, label) in [(1.0 - MOST, low, "5 %"), (0.5, median, "50 %"), (MOST, high, "95 %")] {
        let (x, y) = (along.at(value), up.at(share));
        sheet.push(format!("<path class=\"q\" d=\"M{LEFT},{y:.1}H{x:.1}V{bottom:.1}\"/>"));
        sheet.anchored("k", "end", [LEFT - 8.0, y + 4.0], label);
    }
    sheet.push(format!("<path class=\"c\" stroke=\"{colour}\" d=\"{}\"/>", steps(sample, &along, &up)));
    for (share, value) in [(1.0 - MOST, low), (0.5, median), (MOST, high)] {
        let (x, y) = (along.at(value), up.at(share));
        sheet.push(format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"));
    }
}

/// The share of the draws at or below a value, as a path.
fn steps(sample: &Sample, along: &Scale, up: &Scale) -> String {
    let sorted = sample.sorted();
    let count = sorted.len();
    let shown = count.min(MOST_STEPS);
    let mut parts = vec![format!("M{:.1},{:.1}", along.from, up.at(0.0))];
    for step in 0..shown {
        // The last of the draws that a step stands for.
        let last = (step + 1) * count / shown - 1;
        let (x, y) = (along.at(sorted[last]), up.at((last + 1) as f64 / count as f64));
        parts.push(format!("H{x:.1}V{y:.1}"));
    }
    parts.push(format!("H{:.1}", along.to));
    parts.concat()
}
