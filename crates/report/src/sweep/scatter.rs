//! Vibration against time: every combination, and those that no other one beats in both.
use super::colours::SERIES;
use super::dimension::Dimension;
use super::metric::{Measure, percent};
use super::scale::{Scale, apart, range, spans_decades};
use super::sheet::{BOLD, LEFT, LETTERS, MARGIN, RIGHT, Sheet, WIDTH};
use super::survey::Survey;
use crate::drawing::{fitted, text_width, with_zero};
use std::collections::{HashMap, HashSet};

/// Height of the picture (pixels).
const HEIGHT: f64 = 360.0;
const HEADING: f64 = 28.0;
const AXIS: f64 = 42.0;
/// Height of a row of the list below.
const ROW: f64 = 17.0;
/// Most points, and most combinations that are named.
const MOST_POINTS: usize = 3000;
const MOST_NAMES: usize = 12;
/// Numbers closer together than this would merge.
const APART: f64 = 15.0;

/// A combination as drawn.
struct Point {
    group: usize,
    at: [f64; 2],
}

/// The drawing; `None` if no combination has both numbers.
pub(super) fn scatter(survey: &Survey<'_, '_>, title: &str, note: &str) -> Option<String> {
    let (time, vibration) = (survey.metrics.time?, survey.metrics.vibration?);
    let [along, up] = [time, vibration].map(|column| Measure::of(&survey.table.columns[column]));
    let median = |column: usize, group: usize| Some(survey.spread(column, group)?.median);
    let pairs: Vec<(usize, f64, f64)> = (0..survey.table.groups())
        .filter_map(|group| Some((group, median(time, group)?, median(vibration, group)?)))
        .collect();
    let (x_range, y_range) = (range(pairs.iter().map(|pair| pair.1))?, range(pairs.iter().map(|pair| pair.2))?);
    let series = series(survey);
    let of = if survey.is_drawn {
        format!("medians of {} draws; ", survey.table.sweep.draws_of_each())
    } else {
        String::new()
    };
    let note = if note.is_empty() { String::new() } else { format!("{note}; ") };
    let below = format!("{of}{note}the further to the left the faster, the further down the calmer");
    let mut sheet = Sheet::new(title, &below);
    sheet.key(&key(survey, series));
    let top = sheet.y + HEADING;
    let bottom = top + HEIGHT;
    let is_log = spans_decades(y_range);
    let x = Scale::with_room(x_range, spans_decades(x_range), LEFT, WIDTH - RIGHT);
    let y = Scale::with_room(if is_log { y_range } else { with_zero(y_range) }, is_log, bottom, top);
    draw_axes(&mut sheet, [&along, &up], [&x, &y]);
    let front = survey.front();
    let on_front: HashSet<usize> = front.iter().copied().collect();
    let points: Vec<Point> = pairs
        .iter()
        .map(|(group, time, vibration)| Point { group: *group, at: [x.at(*time), y.at(*vibration)] })
        .collect();
    let every = points.len().div_ceil(MOST_POINTS).max(1);
    for (k, point) in points.iter().enumerate() {
        if k % every == 0 && !on_front.contains(&point.group) {
            draw_point(&mut sheet, survey, series, point, false);
        }
    }
    let by_group: HashMap<usize, &Point> = points.iter().map(|point| (point.group, point)).collect();
    let on_front: Vec<&Point> = front.iter().filter_map(|group| by_group.get(group).copied()).collect();
    draw_front(&mut sheet, &on_front, top);
    for point in &on_front {
        draw_point(&mut sheet, survey, series, point, true);
    }
    let named = draw_numbers(&mut sheet, &on_front, [top, bottom]);
    sheet.y = bottom + AXIS + 8.0;
    draw_list(&mut sheet, survey, &named, [(&along, time), (&up, vibration)]);
    sheet.y += 6.0;
    let mut notes = Vec::new();
    if named.len() < front.len() {
        notes.push(format!("{} of the {} combinations on the line are named", named.len(), front.len()));
    }
    if every > 1 {
        notes
            .push(format!("of {} combinations beside the line one in {every} is drawn", points.len() - on_front.len()));
    }
    let missing = survey.table.groups() - points.len();
    if missing > 0 {
        notes.push(format!("{missing} combinations have no number for both and are not drawn"));
    }
    for note in &notes {
        sheet.note(note);
    }
    Some(sheet.to_svg())
}

/// The dimension that colours the points: names before numbers, few values before many.
fn series<'s>(survey: &'s Survey<'_, '_>) -> Option<&'s Dimension> {
    let few = survey.dimensions.iter().filter(|dimension| dimension.count() <= SERIES.len());
    let others = |dimension: &&Dimension| survey.dimensions.len() > 1 || dimension.numbers.is_none();
    few.filter(others).min_by_key(|dimension| (dimension.numbers.is_some(), dimension.count()))
}

fn draw_axes(sheet: &mut Sheet, [along, up]: [&Measure; 2], [x, y]: [&Scale; 2]) {
    let (x_unit, x_ticks) = x.ticks(along, 8.0);
    let (y_unit, y_ticks) = y.ticks(up, 7.0);
    sheet.heading(y.to - 8.0, &up.name, &y_unit, "#1c2330", "");
    for (at, label) in y_ticks {
        sheet.line("g", [x.from, at], [x.to, at]);
        let label = fitted(&label, LEFT - 12.0, LETTERS).unwrap_or_default();
        sheet.anchored("k", "end", [LEFT - 8.0, at + 4.0], &label);
    }
    for (at, label) in apart(&x_ticks, LETTERS) {
        sheet.line("g", [at, y.to], [at, y.from]);
        sheet.anchored("k", "middle", [at, y.from + 17.0], &label);
    }
    sheet.line("z", [x.from, y.from], [x.to, y.from]);
    let words = fitted(&along.titled(&x_unit), x.to - x.from, LETTERS).unwrap_or_default();
    sheet.anchored("k", "middle", [f64::midpoint(x.from, x.to), y.from + 35.0], &words);
}

/// Key to the colours and shapes.
fn key(survey: &Survey<'_, '_>, series: Option<&Dimension>) -> Vec<(String, String)> {
    let mut key = Vec::new();
    if let Some(dimension) = series {
        for (place, label) in dimension.labels.iter().enumerate() {
            key.push((shape(place, [0.0, 0.0], 4.4, Look::Plain), format!("{} {label}", dimension.short)));
        }
    }
    if (0..survey.table.groups()).any(|group| survey.is_marked(group)) {
        let hollow = shape(0, [0.0, 0.0], 4.0, Look::Hollow).replace(SERIES[0], "#5b6472");
        key.push((hollow, format!("hollow: {}", survey.meaning_of_mark())));
    }
    let line = "<path class=\"f\" d=\"M-8,-5H0V5H8\"/>".to_owned();
    key.push((line, format!("no other combination{} is smaller in both", survey.of_good())));
    key
}

fn draw_point(sheet: &mut Sheet, survey: &Survey<'_, '_>, series: Option<&Dimension>, point: &Point, is_front: bool) {
    let place = series.map_or(0, |dimension| dimension.place(point.group));
    let look = match (survey.is_marked(point.group), is_front) {
        (true, _) => Look::Hollow,
        (false, true) => Look::Outlined,
        (false, false) => Look::Plain,
    };
    sheet.push(shape(place, point.at, if is_front { 5.2 } else { 3.6 }, look));
}

/// Fill and outline of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Look {
    Plain,
    /// On the front.
    Outlined,
    /// Misses a limit.
    Hollow,
}

/// A point of series `place`: circle, square, diamond, two triangles, a flat bar.
fn shape(place: usize, [x, y]: [f64; 2], size: f64, look: Look) -> String {
    let colour = SERIES[place % SERIES.len()];
    let style = match look {
        Look::Plain => format!("fill=\"{colour}\" stroke=\"#ffffff\" stroke-width=\"0.7\""),
        Look::Outlined => format!("fill=\"{colour}\" stroke=\"#1c2330\" stroke-width=\"1.4\""),
        Look::Hollow => format!("fill=\"#ffffff\" stroke=\"{colour}\" stroke-width=\"1.6\""),
    };
    let corners: &[(f64, f64)] = match place % SERIES.len() {
        0 => return format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size}\" {style}/>"),
        1 => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
        2 => &[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)],
        3 => &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
        4 => &[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
        _ => &[(-1.3, -0.5), (1.3, -0.5), (1.3, 0.5), (-1.3, 0.5)],
    };
    let path: Vec<String> =
        corners.iter().map(|(dx, dy)| format!("{:.1},{:.1}", x + dx * size, y + dy * size)).collect();
    format!("<path d=\"M{}Z\" {style}/>", path.join("L"))
}

/// The border of the dominated region: from the top down to the fastest point, along and down to the next, at last to the right.
fn draw_front(sheet: &mut Sheet, front: &[&Point], top: f64) {
    let Some(first) = front.first() else { return };
    let corners: Vec<String> = front.iter().map(|point| format!("H{:.1}V{:.1}", point.at[0], point.at[1])).collect();
    let (start, end) = (first.at[0], WIDTH - RIGHT);
    sheet.push(format!("<path class=\"f\" d=\"M{start:.1},{top:.1}{}H{end:.1}\"/>", corners.concat()));
}

/// Draws numbers beside points of the front, where there is room; returns the groups that have one.
fn draw_numbers(sheet: &mut Sheet, front: &[&Point], [top, bottom]: [f64; 2]) -> Vec<usize> {
    let mut places: Vec<[f64; 2]> = Vec::new();
    let mut named = Vec::new();
    for point in spread_out(front) {
        // The lower left is free: no point is smaller in both.
        let [x, y] = point.at;
        let width = text_width(&(named.len() + 1).to_string(), LETTERS) * BOLD / 2.0;
        let left = [[x - width - 6.0, y + 14.0], [x - width - 9.0, y + 4.0], [x, y + 18.0]];
        let is_free = |place: &[f64; 2]| {
            let is_inside = place[0] > LEFT + 4.0 && place[1] > top + 8.0 && place[1] < bottom - 2.0;
            is_inside && places.iter().all(|other| (other[0] - place[0]).hypot(other[1] - place[1]) >= APART)
        };
        let place = left.into_iter().find(is_free).or_else(|| {
            let beyond = [[x + 11.0, y - 7.0], [x + 10.0, y + 14.0]];
            beyond
                .into_iter()
                .find(|place| places.iter().all(|other| (other[0] - place[0]).hypot(other[1] - place[1]) >= APART))
        });
        if let Some(place) = place {
            places.push(place);
            named.push(point.group);
            sheet.anchored("m", "middle", place, &named.len().to_string());
        }
    }
    named
}

/// Points of the front that are named: the ends, and those between at even distances in its order.
fn spread_out<'p>(front: &[&'p Point]) -> Vec<&'p Point> {
    let count = front.len();
    if count <= MOST_NAMES {
        return front.to_vec();
    }
    (0..MOST_NAMES).map(|k| front[k * (count - 1) / (MOST_NAMES - 1)]).collect()
}

/// Draws the list of the numbered points.
fn draw_list(sheet: &mut Sheet, survey: &Survey<'_, '_>, named: &[usize], [along, up]: [(&Measure, usize); 2]) {
    let value = |(measure, column): (&Measure, usize), group: usize| {
        survey.spread(column, group).map_or(String::new(), |spread| measure.text(spread.median))
    };
    for (k, group) in named.iter().enumerate() {
        sheet.y += ROW;
        let y = sheet.y;
        let mut words = survey.words(*group);
        if survey.is_judged && survey.is_drawn {
            let kept = percent(survey.kept(*group).share());
            words = format!("{words} ({kept} keep all limits)");
        }
        let numbers = [value(along, *group), value(up, *group)];
        sheet.anchored("e", "end", [MARGIN + 18.0, y], &(k + 1).to_string());
        sheet.anchored("r", "end", [MARGIN + 100.0, y], &numbers[0]);
        sheet.anchored("r", "end", [MARGIN + 180.0, y], &numbers[1]);
        let left = MARGIN + 196.0;
        sheet.text("r", left, y, &fitted(&words, WIDTH - MARGIN - left, LETTERS).unwrap_or_default());
    }
}
