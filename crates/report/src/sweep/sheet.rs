//! Common parts of drawings of sweeps: the page, its head, keys and notes.
use crate::drawing::{STYLE as SHARED, escaped, fitted, text_width};

/// Width of the page (pixels), the same as for other drawings.
pub(super) const WIDTH: f64 = 860.0;
pub(super) const MARGIN: f64 = 14.0;
/// Margins at the left and right of a panel.
pub(super) const LEFT: f64 = 84.0;
pub(super) const RIGHT: f64 = 26.0;
/// Sizes of letters: title, label, name of a panel.
const TITLE: f64 = 17.0;
pub(super) const LETTERS: f64 = 11.0;
pub(super) const NAME: f64 = 13.0;
/// Bold letters are wider by this factor.
pub(super) const BOLD: f64 = 1.12;
/// Height of a line of the notes below.
const NOTE: f64 = 17.0;
/// Cells and lines; ink of missing values and of missed limits.
const STYLE: &str = ".c{fill:none;stroke-width:2;stroke-linejoin:round}.d{opacity:.17;stroke:none}.w{stroke-width:1.4;fill:none}\
.q{stroke:#5b6472;stroke-width:1;stroke-dasharray:4 3;fill:none}.x{stroke:#c2303a;stroke-width:1.6;fill:none}\
.h{stroke:#ffffff;stroke-width:3.6;fill:none;stroke-linecap:round}.v{font-size:10.5px}.o{fill:none;stroke:#9aa3b0;stroke-width:1}\
.r{font-size:11px}.f{fill:none;stroke:#1c2330;stroke-width:1.2;stroke-dasharray:5 3}.m{font-size:11px;font-weight:600;\
paint-order:stroke;stroke:#ffffff;stroke-width:3px}";
/// Hatching of values that were not measured.
const HATCHED: &str = "<defs><pattern id=\"sweep-not-measured\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" \
patternTransform=\"rotate(45)\"><rect width=\"6\" height=\"6\" fill=\"#eef0f3\"/><rect width=\"2\" height=\"6\" fill=\"#c9cfd8\"/></pattern></defs>";

/// A drawing in progress: its parts, and its current height.
pub(super) struct Sheet {
    parts: Vec<String>,
    /// Bottom of the finished part (pixels).
    pub(super) y: f64,
    title: String,
}

impl Sheet {
    /// A page with a headline and a line below it.
    pub(super) fn new(title: &str, below: &str) -> Self {
        let title = if title.is_empty() { "Sweep" } else { title };
        let shown = fitted(title, (WIDTH - 2.0 * MARGIN) / BOLD, TITLE).unwrap_or_default();
        let mut sheet = Self { parts: Vec::new(), y: 34.0, title: title.to_owned() };
        sheet.text("t", MARGIN, 34.0, &shown);
        sheet.y = 40.0;
        for line in lines(below, 12.5) {
            sheet.y += NOTE;
            let y = sheet.y;
            sheet.text("s", MARGIN, y, &line);
        }
        sheet.y += 10.0;
        sheet
    }

    pub(super) fn push(&mut self, part: String) {
        self.parts.push(part);
    }

    /// A text that begins at `x`.
    pub(super) fn text(&mut self, class: &str, x: f64, y: f64, text: &str) {
        self.parts.push(format!("<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>", escaped(text)));
    }

    /// A text with its middle, or its end, at `x`.
    pub(super) fn anchored(&mut self, class: &str, anchor: &str, [x, y]: [f64; 2], text: &str) {
        let text = escaped(text);
        self.parts
            .push(format!("<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>"));
    }

    pub(super) fn line(&mut self, class: &str, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
        self.parts.push(format!("<path class=\"{class}\" d=\"M{x1:.1},{y1:.1}L{x2:.1},{y2:.1}\"/>"));
    }

    /// The name of a panel and the unit of its scale, with a text at the right end of the line.
    pub(super) fn heading(&mut self, y: f64, name: &str, unit: &str, colour: &str, right: &str) {
        let room = WIDTH - 2.0 * MARGIN - text_width(unit, LETTERS) - text_width(right, LETTERS) - 24.0;
        let name = fitted(name, room / BOLD, NAME).unwrap_or_default();
        self.parts.push(format!(
            "<text x=\"{MARGIN}\" y=\"{y:.1}\"><tspan class=\"n\" style=\"fill:{colour}\">{}</tspan>\
             <tspan class=\"k\" dx=\"6\">{}</tspan></text>",
            escaped(&name),
            escaped(unit)
        ));
        if !right.is_empty() {
            self.anchored("k", "end", [WIDTH - RIGHT, y], right);
        }
    }

    /// Symbols with their meanings, side by side, in as many rows as needed. A symbol is drawn about its place.
    pub(super) fn key(&mut self, entries: &[(String, String)]) {
        let mut x = MARGIN;
        if entries.is_empty() {
            return;
        }
        self.y += 14.0;
        for (symbol, meaning) in entries {
            let meaning = fitted(meaning, WIDTH - 2.0 * MARGIN - 30.0, LETTERS).unwrap_or_default();
            let width = 22.0 + text_width(&meaning, LETTERS);
            if x > MARGIN && x + width > WIDTH - MARGIN {
                x = MARGIN;
                self.y += NOTE;
            }
            let y = self.y;
            self.push(format!("<g transform=\"translate({:.1},{:.1})\">{symbol}</g>", x + 8.0, y - 4.0));
            self.text("k", x + 20.0, y, &meaning);
            x += width + 18.0;
        }
        self.y += 8.0;
    }

    /// A note at the end.
    pub(super) fn note(&mut self, note: &str) {
        for line in lines(note, LETTERS) {
            self.y += NOTE;
            let y = self.y;
            self.text("k", MARGIN, y, &line);
        }
    }

    pub(super) fn to_svg(&self) -> String {
        let height = (self.y + 14.0).ceil();
        let title = escaped(&self.title);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
             height=\"{height}\" role=\"img\">\n<title>{title}</title>\n<style>{SHARED}{STYLE}</style>\n{HATCHED}\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}\n</svg>\n",
            self.parts.join("\n")
        )
    }
}

/// `text` in at most two lines that fit on the page in letters of `size`.
fn lines(text: &str, size: f64) -> Vec<String> {
    let room = WIDTH - 2.0 * MARGIN;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if lines_fit(line, word, room, size) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    if lines.len() > 2 {
        let rest = lines.split_off(1).join(" ");
        lines.push(rest);
    }
    lines.iter().filter_map(|line| fitted(line, room, size)).collect()
}

fn lines_fit(line: &str, word: &str, room: f64, size: f64) -> bool {
    text_width(line, size) + text_width(" ", size) + text_width(word, size) <= room
}

/// A small cross about a place: a missed limit.
pub(super) fn cross(place: [f64; 2], arm: f64) -> String {
    crosses(&cross_path(place, arm))
}

/// The path of such a cross, to be drawn with others.
pub(super) fn cross_path([x, y]: [f64; 2], arm: f64) -> String {
    let whole = 2.0 * arm;
    format!("M{:.1},{:.1}l{whole:.1},{whole:.1}m-{whole:.1},0l{whole:.1},-{whole:.1}", x - arm, y - arm)
}

/// Crosses, or an outline, by their path: with a light border that sets them off from every colour.
pub(super) fn crosses(path: &str) -> String {
    format!("<path class=\"h\" d=\"{path}\"/><path class=\"x\" d=\"{path}\"/>")
}
