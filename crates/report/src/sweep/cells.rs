//! The cells of a heat map: colours, numbers where they fit, marks of missed limits.
use super::colours::Colour;
use super::layers::Layer;
use super::scale::Scale;
use super::sheet::{Sheet, cross_path, crosses};
use super::survey::Survey;
use crate::drawing::{escaped, text_width};
use std::collections::BTreeMap;

/// Padding beside the number in a cell, and size of its letters (pixels).
const PADDING: f64 = 3.0;
const NUMBER: f64 = 10.5;
/// Smaller cells are not marked one by one: an outline surrounds those that miss a limit.
pub(super) const SMALL: f64 = 8.0;

/// A map: its place and size (pixels), and the group of each cell, from left to right and from bottom to top.
pub(super) struct Cells<'g> {
    pub(super) corner: [f64; 2],
    pub(super) size: [f64; 2],
    pub(super) groups: &'g [Vec<Option<usize>>],
}

/// A cell and its edges (pixels).
struct Cell {
    group: usize,
    place: [usize; 2],
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Cells<'_> {
    /// Width and height of a cell.
    fn cell_size(&self) -> [f64; 2] {
        let rows = self.groups.first().map_or(1, Vec::len);
        [self.size[0] / self.groups.len() as f64, self.size[1] / rows as f64]
    }

    /// All cells; axes that go side by side leave most places empty.
    fn all(&self) -> Vec<Cell> {
        let [width, height] = self.cell_size();
        // Edges on whole pixels, so that nothing shows through between two cells.
        let column_at = |column: usize| self.corner[0] + (width * column as f64).round();
        let row_at = |row: usize| self.corner[1] + self.size[1] - (height * row as f64).round();
        let mut cells = Vec::new();
        for (column, groups) in self.groups.iter().enumerate() {
            for (row, group) in groups.iter().enumerate() {
                let (left, right, top, bottom) =
                    (column_at(column), column_at(column + 1), row_at(row + 1), row_at(row));
                cells.extend(group.map(|group| Cell { group, place: [column, row], left, right, top, bottom }));
            }
        }
        cells
    }

    pub(super) fn draw(&self, sheet: &mut Sheet, survey: &Survey<'_, '_>, layer: &Layer, scale: Option<Scale>) {
        let [width, height] = self.cell_size();
        let has_numbers = have_room(layer, [width, height]);
        let (mut paths, mut texts) = (BTreeMap::<String, String>::new(), Vec::new());
        let cells = self.all();
        for cell in &cells {
            let Cell { left, right, top, bottom, .. } = *cell;
            let value = layer.spreads[cell.group].map(|spread| spread.median);
            let colour = value.zip(scale).map(|(value, scale)| Colour::at(scale.part(value)));
            let fill = colour.map_or("url(#sweep-not-measured)".to_owned(), Colour::hex);
            let path = format!("M{left},{top}H{right}V{bottom}H{left}z");
            paths.entry(fill).or_default().push_str(&path);
            if let (true, Some(colour), Some(value)) = (has_numbers, colour, value) {
                let (x, y) = (f64::midpoint(left, right), f64::midpoint(top, bottom) + 3.8);
                let (ink, text) = (colour.ink(), escaped(&layer.measure.text(value)));
                texts.push(format!(
                    "<text class=\"v\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" style=\"fill:{ink}\">{text}</text>"
                ));
            }
        }
        for (fill, path) in paths {
            sheet.push(format!("<path fill=\"{fill}\" d=\"{path}\"/>"));
        }
        for text in texts {
            sheet.push(text);
        }
        let marked: Vec<&Cell> = cells.iter().filter(|cell| survey.is_marked(cell.group)).collect();
        let marks = if width.min(height) < SMALL {
            self.outline(survey, &marked)
        } else {
            marked.iter().map(|cell| mark(cell, has_numbers)).collect()
        };
        if !marks.is_empty() {
            sheet.push(crosses(&marks));
        }
        let ([x, y], [width, height]) = (self.corner, self.size);
        sheet.push(format!("<rect class=\"o\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>"));
    }

    /// The edges between marked and unmarked cells.
    fn outline(&self, survey: &Survey<'_, '_>, marked: &[&Cell]) -> String {
        let is_marked = |column: Option<usize>, row: Option<usize>| {
            let group = column.and_then(|column| self.groups.get(column)).zip(row);
            group.and_then(|(groups, row)| *groups.get(row)?).is_some_and(|group| survey.is_marked(group))
        };
        let edges = |cell: &&Cell| {
            let Cell { left, right, top, bottom, place: [column, row], .. } = **cell;
            let sides = [
                (is_marked(column.checked_sub(1), Some(row)), format!("M{left},{top}V{bottom}")),
                (is_marked(Some(column + 1), Some(row)), format!("M{right},{top}V{bottom}")),
                (is_marked(Some(column), Some(row + 1)), format!("M{left},{top}H{right}")),
                (is_marked(Some(column), row.checked_sub(1)), format!("M{left},{bottom}H{right}")),
            ];
            sides.into_iter().filter(|(is_inside, _)| !is_inside).map(|(_, edge)| edge).collect::<String>()
        };
        marked.iter().map(edges).collect()
    }
}

/// A cross in the middle of a cell, or in its corner beside a number.
fn mark(cell: &Cell, has_number: bool) -> String {
    let arm = ((cell.right - cell.left).min(cell.bottom - cell.top) * 0.3).min(3.5);
    let middle = [f64::midpoint(cell.left, cell.right), f64::midpoint(cell.top, cell.bottom)];
    cross_path(if has_number { [cell.right - arm - 3.0, cell.top + arm + 3.0] } else { middle }, arm)
}

/// True if the numbers of all cells fit into them.
fn have_room(layer: &Layer, [width, height]: [f64; 2]) -> bool {
    let texts = layer.spreads.iter().flatten().map(|spread| layer.measure.text(spread.median));
    height >= 17.0
        && width >= 24.0
        && texts.map(|text| text_width(&text, NUMBER)).fold(0.0, f64::max) + PADDING <= width
}
