//! Metrics over a single dimension: a line, and for draws the band that holds nine in ten.
use super::dimension::Dimension;
use super::layers::{Layer, layers, note_of_left_out};
use super::metric::Measure;
use super::scale::{Scale, Tick, apart, are_spaced_by_ratio, range, spans_decades};
use super::sheet::{LEFT, LETTERS, RIGHT, Sheet, WIDTH, cross};
use super::survey::Survey;
use crate::drawing::{COLOURS, fitted};

/// Heights of a panel, of its heading and of the axis below the last one (pixels).
const HEIGHT: f64 = 132.0;
const HEADING: f64 = 28.0;
const AXIS: f64 = 42.0;
/// With more groups than this the points would merge into a line.
const MOST_POINTS: usize = 60;
/// Crosses closer than this would merge.
const APART: f64 = 10.0;
/// Most groups drawn; of more, those at even distances.
const MOST_GROUPS: usize = 600;

/// A group as drawn: its place along the axis, its number.
type Point = (f64, usize);

/// The drawing; `None` if nothing was measured.
pub(super) fn lines(survey: &Survey<'_, '_>, title: &str) -> Option<String> {
    let (layers, left_out) = layers(survey);
    if layers.iter().all(|layer| layer.range(false).is_none()) {
        return None;
    }
    let dimension = survey.dimensions.first()?;
    let along = Along::of(survey, dimension);
    let of = if survey.is_drawn {
        format!(": median of {} draws, and the band from 5 % to 95 % of them", survey.table.sweep.draws_of_each())
    } else {
        String::new()
    };
    let mut sheet = Sheet::new(title, &format!("over {}{of}", dimension.name));
    sheet.key(&key(survey, &layers));
    for (k, layer) in layers.iter().enumerate() {
        let top = sheet.y + HEADING;
        along.draw_panel(&mut sheet, survey, layer, COLOURS[k % COLOURS.len()], top);
        sheet.y = top + HEIGHT;
    }
    let y = sheet.y;
    for (x, label) in &along.labels {
        sheet.anchored("k", "middle", [*x, y + 17.0], label);
    }
    let words = fitted(&along.title, WIDTH - LEFT - RIGHT, LETTERS).unwrap_or_default();
    sheet.anchored("k", "middle", [f64::midpoint(LEFT, WIDTH - RIGHT), y + 35.0], &words);
    sheet.y = y + AXIS;
    let (count, shown) = (dimension.count(), along.points.len());
    if shown < count {
        sheet.note(&format!("{shown} of {count} values are drawn"));
    }
    if let Some(note) = note_of_left_out(&left_out) {
        sheet.note(&note);
    }
    Some(sheet.to_svg())
}

/// Key to the symbols.
fn key(survey: &Survey<'_, '_>, layers: &[Layer]) -> Vec<(String, String)> {
    let mut key = Vec::new();
    if (0..survey.table.groups()).any(|group| survey.is_marked(group)) {
        key.push((cross([0.0, 0.0], 3.5), survey.meaning_of_mark().to_owned()));
    }
    if layers.iter().any(|layer| layer.spreads.iter().any(Option::is_none)) {
        key.push((missing([0.0, 0.0]), "not measured".to_owned()));
    }
    if layers.iter().any(|layer| layer.measure.is_share()) {
        let symbol =
            format!("<rect class=\"d\" x=\"-8\" y=\"-6\" width=\"16\" height=\"12\" fill=\"{}\"/>", COLOURS[0]);
        key.push((symbol, "of a share: 95 % confidence on either side".to_owned()));
    }
    key
}

/// A small vertical mark at the foot of a panel.
fn missing([x, y]: [f64; 2]) -> String {
    format!("<path class=\"o\" style=\"stroke-width:2\" d=\"M{x:.1},{:.1}V{:.1}\"/>", y - 5.0, y + 4.0)
}

/// The axis that all panels share.
struct Along {
    points: Vec<Point>,
    labels: Vec<Tick>,
    title: String,
    /// True if neighbours are joined by a line.
    is_joined: bool,
}

impl Along {
    fn of(survey: &Survey<'_, '_>, dimension: &Dimension) -> Self {
        let groups: Vec<usize> = (0..survey.table.groups()).collect();
        let Some((numbers, (low, high))) =
            dimension.numbers.as_ref().and_then(|numbers| Some((numbers, range(numbers.iter().copied())?)))
        else {
            return Self::named(dimension, &groups);
        };
        let scale = Scale::with_room((low, high), are_spaced_by_ratio(numbers), LEFT, WIDTH - RIGHT);
        let mut points: Vec<Point> =
            groups.iter().map(|group| (scale.at(numbers[dimension.place(*group)]), *group)).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        let count = points.len();
        if count > MOST_GROUPS {
            points = (0..MOST_GROUPS).map(|k| points[k * (count - 1) / (MOST_GROUPS - 1)]).collect();
        }
        let measure = Measure::key(&dimension.unit);
        let (unit, ticks) = scale.ticks(&measure, 8.0);
        Self { points, labels: apart(&ticks, LETTERS), title: dimension.axis_title(&unit), is_joined: true }
    }

    /// Names side by side.
    fn named(dimension: &Dimension, groups: &[usize]) -> Self {
        let shown: Vec<usize> = groups.iter().copied().take(MOST_GROUPS).collect();
        let width = (WIDTH - RIGHT - LEFT) / shown.len() as f64;
        let at = |k: usize| LEFT + width * (k as f64 + 0.5);
        let points = shown.iter().enumerate().map(|(k, group)| (at(k), *group)).collect();
        let label = |(k, group): (usize, &usize)| {
            Some((at(k), fitted(dimension.label(*group), (width - 8.0).max(40.0), LETTERS)?))
        };
        let labels: Vec<Tick> = shown.iter().enumerate().filter_map(label).collect();
        Self { points, labels: apart(&labels, LETTERS), title: dimension.name.clone(), is_joined: false }
    }

    fn draw_panel(&self, sheet: &mut Sheet, survey: &Survey<'_, '_>, layer: &Layer, colour: &str, top: f64) {
        let (bottom, right) = (top + HEIGHT, WIDTH - RIGHT);
        for (x, _) in &self.labels {
            sheet.line("g", [*x, top], [*x, bottom]);
        }
        let Some(range) = layer.range(false) else {
            sheet.heading(top - 8.0, &layer.measure.name, "", colour, "not measured");
            return;
        };
        let is_log = !layer.measure.is_share() && spans_decades(range);
        let range = if is_log { range } else { crate::drawing::with_zero(range) };
        let value = Scale::with_room(range, is_log, bottom, top);
        let (unit, ticks) = value.ticks(&layer.measure, 5.0);
        sheet.heading(top - 8.0, &layer.measure.name, &unit, colour, "");
        for (y, label) in ticks {
            sheet.line("g", [LEFT, y], [right, y]);
            let label = fitted(&label, LEFT - 12.0, LETTERS).unwrap_or_default();
            sheet.anchored("k", "end", [LEFT - 8.0, y + 4.0], &label);
        }
        sheet.line("z", [LEFT, bottom], [right, bottom]);
        self.draw_values(sheet, survey, layer, colour, &value);
    }

    fn draw_values(&self, sheet: &mut Sheet, survey: &Survey<'_, '_>, layer: &Layer, colour: &str, value: &Scale) {
        let has_points = self.points.len() <= MOST_POINTS;
        let measured = |point: &&[Point]| layer.spreads[point[0].1].is_some();
        // Runs of neighbours that were measured, or not.
        let stretches =
            self.points.chunk_by(|one, other| layer.spreads[one.1].is_some() == layer.spreads[other.1].is_some());
        for stretch in stretches.filter(|stretch| measured(stretch)) {
            let spreads = || stretch.iter().filter_map(|(x, group)| Some((*x, layer.spreads[*group]?)));
            let path = |points: Vec<(f64, f64)>| -> String {
                let parts = points
                    .iter()
                    .enumerate()
                    .map(|(k, (x, y))| format!("{}{x:.1},{y:.1}", if k == 0 { 'M' } else { 'L' }));
                parts.collect()
            };
            if survey.is_drawn && self.is_joined {
                let above = spreads().map(|(x, spread)| (x, value.at(spread.high)));
                let below: Vec<(f64, f64)> = spreads().map(|(x, spread)| (x, value.at(spread.low))).collect();
                let outline = path(above.chain(below.into_iter().rev()).collect());
                sheet.push(format!("<path class=\"d\" fill=\"{colour}\" d=\"{outline}Z\"/>"));
            }
            if survey.is_drawn && !(self.is_joined && stretch.len() > 1) {
                for (x, spread) in spreads() {
                    let (low, high) = (value.at(spread.low), value.at(spread.high));
                    sheet.push(format!("<path class=\"w\" stroke=\"{colour}\" d=\"M{x:.1},{low:.1}V{high:.1}\"/>"));
                }
            }
            if self.is_joined && stretch.len() > 1 {
                let line = path(spreads().map(|(x, spread)| (x, value.at(spread.median))).collect());
                sheet.push(format!("<path class=\"c\" stroke=\"{colour}\" d=\"{line}\"/>"));
            }
        }
        let mut last = f64::NEG_INFINITY;
        for (x, group) in &self.points {
            match layer.spreads[*group] {
                None => sheet.push(missing([*x, value.from - 4.0])),
                Some(spread) => {
                    let y = value.at(spread.median);
                    if has_points || !self.is_joined {
                        sheet.push(format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.8\" fill=\"{colour}\"/>"));
                    }
                    if survey.is_marked(*group) && x - last >= APART {
                        last = *x;
                        sheet.push(cross([*x, y], 3.5));
                    }
                }
            }
        }
    }
}
