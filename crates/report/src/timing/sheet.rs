//! The whole diagram: curves and rows with the texts above, below and beside them.
use super::curves::{self, Panel};
use super::group::{self, Group};
use super::guides::{Guides, Kind, has_guide};
use super::key::Key;
use super::trace;
use super::window::Window;
use crate::drawing::{Axis, STYLE as SHARED, escaped, fitted, text_width, ticks, unit_at};
use servobench_base::AxisName;
use servobench_metrics::round_above;
use servobench_trace::{About, of_axis};

/// Margins at the left and right of the diagram (pixels).
const MARGIN: f64 = 14.0;
const RIGHT: f64 = 26.0;
/// Smallest and largest width for the names of the signals.
const NAMES: (f64, f64) = (84.0, 190.0);
/// Distance from the top to the key, or to the times of the guide lines.
const TOP: f64 = 42.0;
/// Height of a heading of a panel and of a group, and margin below either.
const HEADING: f64 = 22.0;
const GAP: f64 = 10.0;
/// Distance from the last row to the time axis.
const ABOVE_AXIS: f64 = 4.0;
/// Height below: the time axis, and a line of notes.
const AXIS: f64 = 46.0;
const NOTE: f64 = 18.0;
/// Sizes of letters: title, heading, label.
const TITLE: f64 = 17.0;
const LETTERS: f64 = 11.0;
/// Bold letters are wider by this factor.
const BOLD: f64 = 1.12;
/// Gap between two labels of the time axis (pixels).
const APART: f64 = 26.0;
/// A set-point is a broad line in colour, the motion of the load a thin dark one; TRUE and states are blue, errors red,
/// in shades dark enough to be distinguished in black and white.
const STYLE: &str = ".c{fill:none;stroke-width:2.6;stroke-linejoin:round}.a{fill:none;stroke:#1c2330;stroke-width:1;\
stroke-linejoin:round}.w{fill:none;stroke:#1f5fa8;stroke-width:1.5}.f{fill:#1f5fa8;opacity:.22}.x{fill:#c2303a;\
fill-opacity:.3;stroke:#c2303a;stroke-width:1.5}.q{fill:#7d8794}.bs,.bo,.bx{fill:#e3ecf7;stroke:#1f5fa8;stroke-width:1}\
.bo{fill:#ffffff;stroke:#7d8794}.bx{fill:#f8dcde;stroke:#c2303a}.bt{font-size:11px}.bn{font-size:10px;fill:#5b6472;paint-order:stroke;stroke:#ffffff;\
stroke-width:3px}.r{font-size:11px}.h{stroke:#9aa3b0;\
stroke-width:1}.gb,.ge,.gc{fill:none;stroke:#5b6472;stroke-width:.9}.gb{stroke-dasharray:1 3}.ge{stroke-dasharray:6 3}\
.gc{stroke-dasharray:6 3 1 3}.o{fill:#1c2330}";

/// A timing diagram.
pub(super) struct Sheet<'a> {
    pub(super) about: &'a About,
    /// Name of the axis, where it has one.
    pub(super) axis: Option<AxisName>,
    pub(super) window: Window,
    pub(super) width: f64,
    pub(super) curves: Vec<Panel<'a>>,
    pub(super) groups: Vec<Group<'a>>,
    /// Names of idle signals, which are left out.
    pub(super) idle: Vec<String>,
}

/// Layout (pixels).
struct Layout {
    /// Tops of the curves and of the first row of each group.
    curves: Vec<f64>,
    rows: Vec<f64>,
    /// Bottom of the last of them.
    bottom: f64,
}

impl Sheet<'_> {
    pub(super) fn to_svg(&self) -> String {
        let Window { from, to } = self.window;
        let time = Axis { low: from, high: to, from: self.left(), to: self.width - RIGHT };
        let (unit, scale) = unit_at(from.abs().max(to.abs()), "s", true);
        let guides = Guides::of(&self.groups, &time, scale);
        let key = self.key(&guides);
        let first = TOP + key.height() + guides.height();
        let layout = self.layout(first);
        let notes = self.notes(&guides);
        let height = layout.bottom + AXIS + NOTE * notes.len() as f64;
        let mut svg = self.heading(height);
        key.draw(&mut svg, TOP);
        let labels = time_labels(&time, scale);
        let tops = layout.curves.iter().map(|top| (*top, top + curves::HEIGHT));
        let rows = layout.rows.iter().zip(&self.groups);
        let blocks = tops.chain(rows.map(|(top, group)| (*top, top + trace::HEIGHT * group.rows.len() as f64)));
        let grid: Vec<String> = blocks
            .flat_map(|(top, bottom)| labels.iter().map(move |(x, _)| format!("M{x:.2},{top:.1}V{bottom:.1}")))
            .collect();
        svg.push(format!("<path class=\"g\" d=\"{}\"/>", grid.concat()));
        guides.draw(&mut svg, first, layout.bottom);
        for (panel, top) in self.curves.iter().zip(&layout.curves) {
            draw_panel(&mut svg, panel, &time, *top);
        }
        for (group, top) in self.groups.iter().zip(&layout.rows) {
            draw_group(&mut svg, group, &time, *top, !guides.is_empty());
        }
        draw_time(&mut svg, &time, &labels, &unit, layout.bottom);
        svg.extend(notes.iter().enumerate().map(|(i, note)| {
            let y = layout.bottom + AXIS + NOTE * i as f64 + 4.0;
            format!("<text class=\"k\" x=\"{MARGIN}\" y=\"{y:.1}\">{}</text>", escaped(note))
        }));
        svg.push("</svg>\n".to_owned());
        svg.join("\n")
    }

    /// Left end of the time axis: right of the longest name.
    fn left(&self) -> f64 {
        let names = self.groups.iter().flat_map(|group| &group.rows).map(|row| text_width(row.name, LETTERS));
        let longest = names.fold(0.0, f64::max);
        (longest + MARGIN + 16.0).clamp(NAMES.0, NAMES.1).ceil()
    }

    fn layout(&self, first: f64) -> Layout {
        let mut y = first;
        let mut next = |height: f64| {
            let top = y + HEADING;
            y = top + height + GAP;
            top
        };
        let curves = self.curves.iter().map(|_| next(curves::HEIGHT)).collect();
        let rows = self.groups.iter().map(|group| next(trace::HEIGHT * group.rows.len() as f64)).collect();
        Layout { curves, rows, bottom: y - GAP + ABOVE_AXIS }
    }

    /// Beginning of the file and title.
    fn heading(&self, height: f64) -> Vec<String> {
        let Self { width, about, axis, .. } = self;
        let title = if about.scenario.is_empty() { "Timing diagram" } else { &about.scenario };
        let title = &format!("{title}{}{}", of_axis(*axis), about.overridden());
        let engine = if about.engine.is_empty() { String::new() } else { format!("engine {}", about.engine) };
        let engine = fitted(&engine, width / 3.0, LETTERS).unwrap_or_default();
        let right = width - RIGHT;
        let room = right - MARGIN - text_width(&engine, LETTERS) - 20.0;
        let shown = fitted(title, room / BOLD, TITLE).unwrap_or_default();
        vec![
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
                 height=\"{height}\" role=\"img\">"
            ),
            format!("<title>{}</title>\n<style>{SHARED}{STYLE}</style>", escaped(title)),
            format!("<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>"),
            format!(
                "<text class=\"t\" x=\"{MARGIN}\" y=\"30\">{}</text>\n\
                 <text class=\"k\" x=\"{right}\" y=\"30\" text-anchor=\"end\">{}</text>",
                escaped(&shown),
                escaped(&engine)
            ),
        ]
    }

    /// Key to the lines.
    fn key(&self, guides: &Guides) -> Key {
        let mut key = Key::new(MARGIN, self.width - RIGHT);
        let lines = || self.curves.iter().flat_map(|panel| panel.lines.iter().map(|line| (panel.colour, line)));
        for label in ["set-point", "load"] {
            if let Some((colour, line)) = lines().find(|(_, line)| line.label == label) {
                key.add(line.class, Some(colour), label);
            }
        }
        for kind in Kind::ALL {
            if let Some(meaning) = guides.meaning(kind) {
                key.add(kind.class(), None, &meaning);
            }
        }
        key
    }

    /// Notes on signals and lines that are left out.
    fn notes(&self, guides: &Guides) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.idle.is_empty() {
            let (count, names) = (self.idle.len(), self.idle.join(", "));
            let note = match count {
                1 => format!("1 signal left out, in which nothing happens: {names}"),
                _ => format!("{count} signals left out, in which nothing happens: {names}"),
            };
            notes.extend(fitted(&note, self.width - 2.0 * MARGIN, LETTERS));
        }
        if guides.left_out > 0 {
            notes.push(format!("without guide lines: there would be {}", guides.left_out));
        }
        notes
    }
}

/// The name of `group` and its rows.
fn draw_group(svg: &mut Vec<String>, group: &Group<'_>, time: &Axis, top: f64, has_guides: bool) {
    let name = fitted(group.source, (time.to - MARGIN) / BOLD, 13.0).unwrap_or_default();
    svg.push(format!(
        "<text class=\"n\" x=\"{MARGIN}\" y=\"{:.1}\">{}</text>\n\
         <line class=\"h\" x1=\"{:.1}\" x2=\"{}\" y1=\"{:.1}\" y2=\"{:.1}\"/>",
        top - 6.0,
        escaped(&name),
        MARGIN + BOLD * text_width(&name, 13.0) + 8.0,
        time.to,
        top - 10.0,
        top - 10.0
    ));
    for (i, row) in group.rows.iter().enumerate() {
        let top = top + trace::HEIGHT * i as f64;
        let name = fitted(row.name, time.from - MARGIN - 8.0, LETTERS).unwrap_or_default();
        svg.push(format!(
            "<text class=\"r\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            time.from - 8.0,
            top + 14.0,
            escaped(&name)
        ));
        trace::draw(svg, row, time, top);
        if has_guides && row.kind == group::Kind::Logic && has_guide(row.name) {
            svg.extend(row.rises().map(|t| {
                format!(
                    "<circle class=\"o\" cx=\"{:.2}\" cy=\"{:.1}\" r=\"2.4\"/>",
                    time.at(t),
                    top + trace::HEIGHT / 2.0
                )
            }));
        }
    }
}

/// Heading, scale and curves of `panel` with its top at `top`.
fn draw_panel(svg: &mut Vec<String>, panel: &Panel<'_>, time: &Axis, top: f64) {
    let value = panel.axis(top);
    let (unit, ticks) = panel.ticks(&value);
    let (left, right) = (time.from, time.to);
    svg.push(format!(
        "<text x=\"{MARGIN}\" y=\"{:.1}\"><tspan class=\"n\" style=\"fill:{}\">{}</tspan><tspan class=\"k\" dx=\"6\">{}</tspan></text>",
        top - 7.0,
        panel.colour,
        panel.name,
        escaped(&unit)
    ));
    svg.extend(ticks.iter().map(|(y, label, is_zero)| {
        let class = if *is_zero { "z" } else { "g" };
        format!(
            "<line class=\"{class}\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.2}\" y2=\"{y:.2}\"/>\n\
             <text class=\"k\" x=\"{:.1}\" y=\"{:.2}\" text-anchor=\"end\">{label}</text>",
            left - 8.0,
            y + 4.0
        )
    }));
    svg.extend(panel.lines.iter().map(|line| {
        let stroke = if line.class == "c" { format!(" stroke=\"{}\"", panel.colour) } else { String::new() };
        format!("<path class=\"{}\"{stroke} d=\"{}\"/>", line.class, line.path(time, &value))
    }));
}

/// Places and labels of round times, as many as fit.
fn time_labels(time: &Axis, scale: f64) -> Vec<(f64, String)> {
    let (low, high, room) = (time.low / scale, time.high / scale, time.to - time.from);
    let every = |pixels: f64| ticks(low, high, round_above((high - low) * pixels / room));
    let widest =
        |labels: &[(f64, String)]| labels.iter().map(|(_, label)| text_width(label, LETTERS)).fold(0.0, f64::max);
    let labels = every(widest(&every(80.0)).max(44.0) + APART);
    labels.into_iter().map(|(t, label)| (time.at(t * scale), label)).collect()
}

/// The time axis below everything.
fn draw_time(svg: &mut Vec<String>, time: &Axis, labels: &[(f64, String)], unit: &str, bottom: f64) {
    let (left, right) = (time.from, time.to);
    svg.push(format!("<line class=\"z\" x1=\"{left}\" x2=\"{right}\" y1=\"{bottom:.1}\" y2=\"{bottom:.1}\"/>"));
    svg.extend(labels.iter().map(|(x, label)| {
        format!("<text class=\"k\" x=\"{x:.2}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>", bottom + 17.0)
    }));
    let (x, y) = (f64::midpoint(left, right), bottom + 34.0);
    svg.push(format!("<text class=\"k\" x=\"{x:.2}\" y=\"{y:.1}\" text-anchor=\"middle\">time ({unit})</text>"));
}
