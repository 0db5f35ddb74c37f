//! Heat maps: each metric as colours over two dimensions, side by side for the others.
use super::cells::{Cells, SMALL};
use super::colours::Colour;
use super::dimension::Dimension;
use super::layers::{Layer, layers, note_of_left_out};
use super::scale::{Scale, apart, spans_decades};
use super::sheet::{LETTERS, MARGIN, Sheet, WIDTH, cross, crosses};
use super::survey::Survey;
use crate::drawing::{fitted, text_width};
use std::collections::{BTreeMap, HashMap};

/// Most maps of each metric, and most cells along the two dimensions of a map.
const MOST_FACETS: usize = 12;
const MOST_CELLS: [usize; 2] = [120, 60];
/// Largest width of the labels of the vertical dimension.
const LABELS: f64 = 150.0;
/// Width at the right: the bar of colours with its labels.
const BAR: f64 = 112.0;
const BAR_WIDTH: f64 = 13.0;
/// Gap between maps; above each the values of the other dimensions.
const GAP: f64 = 14.0;
const FACET: f64 = 18.0;
/// Height below the lowest maps: labels and name of the horizontal dimension.
const AXIS: f64 = 40.0;

/// A dimension as drawn: its values from left to right or from bottom to top.
struct Along<'d> {
    dimension: &'d Dimension,
    /// Indices of its values, in order.
    places: Vec<usize>,
}

impl<'d> Along<'d> {
    /// At most `most` of its values, at even distances in their order.
    fn of(dimension: &'d Dimension, most: usize) -> Self {
        let mut places: Vec<usize> = (0..dimension.count()).collect();
        if let Some(numbers) = &dimension.numbers {
            places.sort_by(|one, other| numbers[*one].total_cmp(&numbers[*other]));
        }
        let count = places.len();
        if count > most {
            places = (0..most).map(|k| places[k * (count - 1) / (most - 1)]).collect();
        }
        Self { dimension, places }
    }

    fn title(&self) -> String {
        self.dimension.axis_title(&self.dimension.unit)
    }

    fn left_out(&self) -> Option<String> {
        let (count, shown) = (self.dimension.count(), self.places.len());
        (shown < count).then(|| format!("{shown} of the {count} values of {} are drawn", self.dimension.name))
    }
}

/// Layout of the maps side by side.
struct Grid {
    columns: usize,
    rows: usize,
    /// Left edge of the first map, size of a map (pixels).
    left: f64,
    width: f64,
    height: f64,
    has_names: bool,
}

impl Grid {
    fn of(facets: usize, has_names: bool, [nx, ny]: [usize; 2], labels: f64) -> Self {
        let columns = match facets {
            0..=4 => facets.max(1),
            5 | 6 | 9 => 3,
            _ => 4,
        };
        let left = (MARGIN + labels + 8.0).ceil();
        let width = ((WIDTH - BAR - left - GAP * (columns as f64 - 1.0)) / columns as f64).floor();
        // Cells are not much higher than wide, and a map leaves room for the next.
        let most = if columns == 1 { 300.0 } else { 170.0 };
        let cell = (width / nx as f64).clamp(20.0, 34.0);
        let height = (cell * ny as f64).clamp(40.0, most).round();
        Self { columns, rows: facets.div_ceil(columns), left, width, height, has_names }
    }

    /// Right edge of the last map in a row.
    const fn right(&self) -> f64 {
        self.left + self.columns as f64 * (self.width + GAP) - GAP
    }

    const fn above(&self) -> f64 {
        if self.has_names { FACET } else { 4.0 }
    }

    /// Left and upper edge of map `facet`, in a block with its top at `top`.
    fn corner(&self, facet: usize, top: f64) -> [f64; 2] {
        let (column, row) = ((facet % self.columns) as f64, (facet / self.columns) as f64);
        [self.left + column * (self.width + GAP), top + self.above() + row * (self.height + self.above() + GAP / 2.0)]
    }

    fn total(&self) -> f64 {
        self.rows as f64 * (self.height + self.above() + GAP / 2.0) - GAP / 2.0
    }
}

/// The drawing; `None` if nothing was measured.
pub(super) fn heat_maps(survey: &Survey<'_, '_>, title: &str) -> Option<String> {
    let (layers, left_out) = layers(survey);
    if layers.iter().all(|layer| layer.range(true).is_none()) {
        return None;
    }
    let mut order: Vec<&Dimension> = survey.dimensions.iter().collect();
    // Numbers before names, many values before few.
    order.sort_by_key(|dimension| (dimension.numbers.is_none(), std::cmp::Reverse(dimension.count())));
    let (along, up) = (Along::of(order[0], MOST_CELLS[0]), Along::of(order[1], MOST_CELLS[1]));
    let others = &order[2..];
    let (facets, all) = facets(survey, others);
    let labels = up.places.iter().map(|place| text_width(&up.dimension.bare(*place), LETTERS));
    let labels = labels.fold(20.0, f64::max).min(LABELS);
    let grid = Grid::of(facets.len(), !others.is_empty(), [along.places.len(), up.places.len()], labels);
    let cells = cells(survey, &along, &up, others);
    let of = if survey.is_drawn {
        format!(", medians of {} draws", survey.table.sweep.draws_of_each())
    } else {
        String::new()
    };
    let (names, keys) = names(&facets, others, grid.width);
    let keys = keys.unwrap_or_default();
    let mut sheet = Sheet::new(title, &format!("{} over {}{of}{keys}", up.dimension.name, along.dimension.name));
    let is_small = grid.width / (along.places.len() as f64) < SMALL || grid.height / (up.places.len() as f64) < SMALL;
    sheet.key(&key(survey, &layers, is_small));
    for layer in &layers {
        sheet.y += 20.0;
        let scale = bar_scale(layer, sheet.y + grid.above(), grid.total().min(260.0) - grid.above());
        let unit = draw_bar(&mut sheet, layer, scale, &grid);
        let y = sheet.y;
        sheet.heading(y - 2.0, &layer.measure.name, &unit, "#1c2330", "");
        let top = y + 4.0;
        for (facet, ((key, _), name)) in facets.iter().zip(&names).enumerate() {
            let corner = grid.corner(facet, top);
            if grid.has_names {
                sheet.text("r", corner[0], corner[1] - 5.0, name);
            }
            let groups = cells.get(key).map_or(&[][..], Vec::as_slice);
            let map = Cells { corner, size: [grid.width, grid.height], groups };
            map.draw(&mut sheet, survey, layer, scale);
            if facet % grid.columns == 0 {
                draw_up(&mut sheet, &up, corner, &grid);
            }
            if facet + grid.columns >= facets.len() {
                draw_along(&mut sheet, &along, corner, &grid);
            }
        }
        sheet.y = top + grid.total() + AXIS;
        let right = grid.right();
        let room = (right - MARGIN) / 2.0 - 12.0;
        let y = sheet.y - 6.0;
        let words = fitted(&format!("↑ {}", up.title()), room, LETTERS).unwrap_or_default();
        sheet.text("k", MARGIN, y, &words);
        // The arrow is drawn even if nothing else fits.
        let words = fitted(&along.title(), room - 16.0, LETTERS).unwrap_or_default();
        sheet.anchored("k", "end", [right, y], &format!("{words} →"));
    }
    let notes = [along.left_out(), up.left_out(), facets_left_out(facets.len(), all), note_of_left_out(&left_out)];
    for note in notes.iter().flatten() {
        sheet.note(note);
    }
    Some(sheet.to_svg())
}

fn facets_left_out(shown: usize, all: usize) -> Option<String> {
    (shown < all).then(|| format!("{shown} of {all} combinations of the other keys are drawn"))
}

/// The combinations of `others` that are drawn, as indices of their values with a group of each, and the total number.
fn facets(survey: &Survey<'_, '_>, others: &[&Dimension]) -> (Vec<(Vec<usize>, usize)>, usize) {
    let mut all: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    for group in 0..survey.table.groups() {
        all.entry(others.iter().map(|dimension| dimension.place(group)).collect()).or_insert(group);
    }
    let count = all.len();
    (all.into_iter().take(MOST_FACETS).collect(), count)
}

/// Title of each map: keys and values, or values alone where these do not fit; then the keys are named once.
fn names(facets: &[(Vec<usize>, usize)], others: &[&Dimension], room: f64) -> (Vec<String>, Option<String>) {
    let of = |between: &str, words: &dyn Fn(&Dimension, usize) -> String| -> Vec<String> {
        let name = |group: usize| others.iter().map(|dimension| words(dimension, group)).collect::<Vec<_>>();
        facets.iter().map(|(_, group)| name(*group).join(between)).collect()
    };
    let whole = of(", ", &|dimension, group| dimension.words(group).to_owned());
    if whole.iter().all(|name| text_width(name, LETTERS) <= room) {
        return (whole, None);
    }
    let values = of(" · ", &|dimension, group| dimension.label(group).to_owned());
    let keys: Vec<&str> = others.iter().map(|dimension| dimension.name.as_str()).collect();
    let values = values.iter().map(|name| fitted(name, room, LETTERS).unwrap_or_default()).collect();
    (values, Some(format!("; above each map: {}", keys.join(" · "))))
}

/// The group of each cell of a map, for each of the `facets`.
fn cells(
    survey: &Survey<'_, '_>,
    along: &Along<'_>,
    up: &Along<'_>,
    others: &[&Dimension],
) -> HashMap<Vec<usize>, Groups> {
    let at = |along: &Along<'_>| -> HashMap<usize, usize> {
        along.places.iter().enumerate().map(|(at, place)| (*place, at)).collect()
    };
    let (columns, rows) = (at(along), at(up));
    let mut cells: HashMap<Vec<usize>, Groups> = HashMap::new();
    for group in 0..survey.table.groups() {
        let column = columns.get(&along.dimension.place(group));
        let row = rows.get(&up.dimension.place(group));
        if let (Some(column), Some(row)) = (column, row) {
            let key = others.iter().map(|dimension| dimension.place(group)).collect();
            let empty = || vec![vec![None; up.places.len()]; along.places.len()];
            cells.entry(key).or_insert_with(empty)[*column][*row] = Some(group);
        }
    }
    cells
}

/// Groups from left to right and from bottom to top.
type Groups = Vec<Vec<Option<usize>>>;

/// Key to the symbols.
fn key(survey: &Survey<'_, '_>, layers: &[Layer], is_small: bool) -> Vec<(String, String)> {
    let mut key = Vec::new();
    if layers.iter().any(|layer| layer.spreads.iter().any(Option::is_none)) {
        let symbol = "<rect x=\"-8\" y=\"-6\" width=\"16\" height=\"12\" fill=\"url(#sweep-not-measured)\"/>";
        key.push((symbol.to_owned(), "not measured".to_owned()));
    }
    if (0..survey.table.groups()).any(|group| survey.is_marked(group)) {
        let meaning = survey.meaning_of_mark();
        key.push(if is_small {
            (crosses("M-7,5V-4H1V-1H7V5z"), format!("inside the outline: {meaning}"))
        } else {
            (cross([0.0, 0.0], 3.5), meaning.to_owned())
        });
    }
    key
}

/// The scale of the colours, with the largest value at the top.
fn bar_scale(layer: &Layer, top: f64, height: f64) -> Option<Scale> {
    let range = layer.range(true)?;
    let is_log = !layer.measure.is_share() && spans_decades(range);
    Some(Scale::tight(range, is_log, top + height.max(40.0), top))
}

/// Draws the bar of colours; returns the unit of its numbers.
fn draw_bar(sheet: &mut Sheet, layer: &Layer, scale: Option<Scale>, grid: &Grid) -> String {
    let Some(scale) = scale else { return String::new() };
    let x = grid.right() + 18.0;
    let (bottom, top) = (scale.from + 4.0, scale.to + 4.0);
    let steps = 64;
    let height = (bottom - top) / f64::from(steps);
    for step in 0..steps {
        let colour = Colour::at((f64::from(step) + 0.5) / f64::from(steps)).hex();
        let y = bottom - height * f64::from(step + 1);
        // Slightly larger, so that nothing shows through between two.
        let more = if step == 0 { 0.0 } else { 1.0 };
        sheet.push(format!(
            "<rect x=\"{x:.1}\" y=\"{y:.2}\" width=\"{BAR_WIDTH}\" height=\"{:.2}\" fill=\"{colour}\"/>",
            height + more
        ));
    }
    let (unit, ticks) = scale.ticks(&layer.measure, ((bottom - top) / 28.0).clamp(2.0, 6.0));
    for (y, label) in ticks {
        let y = y + 4.0;
        sheet.line("o", [x + BAR_WIDTH, y], [x + BAR_WIDTH + 4.0, y]);
        let label = fitted(&label, WIDTH - x - BAR_WIDTH - 8.0, LETTERS).unwrap_or_default();
        sheet.text("k", x + BAR_WIDTH + 7.0, y + 4.0, &label);
    }
    unit
}

/// Labels of the vertical dimension, left of the map at `corner`.
fn draw_up(sheet: &mut Sheet, up: &Along<'_>, [x, y]: [f64; 2], grid: &Grid) {
    let height = grid.height / up.places.len() as f64;
    let every = (14.0 / height).ceil().max(1.0);
    for (row, place) in up.places.iter().enumerate() {
        if row as f64 % every != 0.0 {
            continue;
        }
        let middle = y + grid.height - height * (row as f64 + 0.5);
        let label = fitted(&up.dimension.bare(*place), x - 8.0 - MARGIN, LETTERS).unwrap_or_default();
        sheet.anchored("k", "end", [x - 6.0, middle + 4.0], &label);
    }
}

/// Labels of the horizontal dimension, below the map at `corner`.
fn draw_along(sheet: &mut Sheet, along: &Along<'_>, [x, y]: [f64; 2], grid: &Grid) {
    let width = grid.width / along.places.len() as f64;
    let is_named = along.dimension.numbers.is_none();
    let labels = along.places.iter().enumerate().filter_map(|(column, place)| {
        let label = along.dimension.bare(*place);
        let label = if is_named { fitted(&label, (width - 4.0).max(30.0), LETTERS)? } else { label };
        Some((x + width * (column as f64 + 0.5), label))
    });
    // Keeps clear of the labels of the next map.
    let end = x + grid.width + 4.0;
    let labels = labels.filter(|(at, label)| grid.columns == 1 || at + text_width(label, LETTERS) / 2.0 <= end);
    for (at, label) in apart(&labels.collect::<Vec<_>>(), LETTERS) {
        sheet.anchored("k", "middle", [at, y + grid.height + 15.0], &label);
    }
}
