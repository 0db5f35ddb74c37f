//! One row: a logic trace, or states as bars.
use super::group::{Kind, Row};
use super::stretch::{Seen, seen};
use crate::drawing::{Axis, escaped, fitted};
use std::fmt::Write;

/// Height of a row (pixels).
pub(super) const HEIGHT: f64 = 20.0;
/// From the top of a row to TRUE and to FALSE, and to the edges of a bar.
const HIGH: f64 = 4.0;
const LOW: f64 = 16.0;
const BAR: (f64, f64) = (2.0, 18.0);
/// Size of letters in a bar, and the room at each end of them.
const LETTERS: f64 = 11.0;
const MARGIN: f64 = 3.0;

/// Values that say that something is off.
const OFF: [&str; 6] = ["FALSE", "0", "16#0000", "none", "Off", "Disabled"];
/// Parts of values and of names of signals that say that something went wrong.
const WRONG: [&str; 6] = ["Error", "Fault", "fault", "Aborted", "Underflow", "Overflow"];

/// Whether `text` says that something went wrong.
fn is_wrong(text: &str) -> bool {
    WRONG.iter().any(|wrong| text.contains(wrong))
}

/// Draws `row` with its top at `top`.
pub(super) fn draw(svg: &mut Vec<String>, row: &Row<'_>, time: &Axis, top: f64) {
    let seen = seen(&row.stretches, time);
    match row.kind {
        Kind::Logic => logic(svg, row.name, &seen, top),
        Kind::States => bars(svg, &seen, |value| class(row.name, value), top),
        Kind::Excused => bars(svg, &seen, |_| "bo", top),
        Kind::Missed => bars(svg, &seen, |_| "bx", top),
    }
}

/// A line that is low or high, and filled below where it is high.
fn logic(svg: &mut Vec<String>, name: &str, seen: &[Seen<'_>], top: f64) {
    let (high, low) = (top + HIGH, top + LOW);
    let level = |value: &str| if value == "TRUE" { high } else { low };
    let (mut line, mut fill, mut blocks) = (String::new(), String::new(), String::new());
    let mut here: Option<f64> = None;
    for stretch in seen {
        let (from, to, value) = match stretch {
            Seen::One { from, to, value } | Seen::Many { from, to, value, .. } => (*from, *to, *value),
        };
        let y = level(value);
        let written = match here {
            None => write!(line, "M{from:.2},{y:.1}"),
            Some(before) if before.to_bits() != y.to_bits() => write!(line, "V{y:.1}"),
            Some(_) => Ok(()),
        };
        let along = write!(line, "H{to:.2}");
        let filled = match stretch {
            Seen::Many { .. } => write!(blocks, "M{from:.2},{low:.1}V{high:.1}H{to:.2}V{low:.1}Z"),
            Seen::One { .. } if value == "TRUE" => write!(fill, "M{from:.2},{low:.1}V{high:.1}H{to:.2}V{low:.1}Z"),
            Seen::One { .. } => Ok(()),
        };
        debug_assert!([written, along, filled].iter().all(Result::is_ok), "a string takes everything");
        here = Some(y);
    }
    // What went wrong is in front of the line, with an edge of its own.
    let parts = if is_wrong(name) {
        [("q", blocks), ("w", line), ("x", fill)]
    } else {
        [("f", fill), ("q", blocks), ("w", line)]
    };
    let seen = parts.into_iter().filter(|(_, path)| !path.is_empty());
    svg.extend(seen.map(|(class, path)| format!("<path class=\"{class}\" d=\"{path}\"/>")));
}

/// Class of the bar of `value` of the signal `name`.
fn class(name: &str, value: &str) -> &'static str {
    match value {
        _ if OFF.contains(&value) => "bo",
        _ if is_wrong(value) || is_wrong(name) => "bx",
        _ => "bs",
    }
}

/// A bar for each state with its name, as far as it fits. Those that say that something went wrong are in front: a short
/// one is not hidden by the edges of its neighbours.
fn bars(svg: &mut Vec<String>, seen: &[Seen<'_>], class: impl Fn(&str) -> &'static str, top: f64) {
    let is_in_front = |stretch: &&Seen<'_>| matches!(stretch, Seen::One { value, .. } if class(value) == "bx");
    let (front, back): (Vec<_>, Vec<_>) = seen.iter().partition(is_in_front);
    for stretch in back.into_iter().chain(front) {
        bar(svg, stretch, &class, top);
    }
}

fn bar(svg: &mut Vec<String>, stretch: &Seen<'_>, class: impl Fn(&str) -> &'static str, top: f64) {
    let rect = |class: &str, from: f64, to: f64| {
        let (y, width, height) = (top + BAR.0, to - from, BAR.1 - BAR.0);
        format!("<rect class=\"{class}\" x=\"{from:.2}\" y=\"{y:.1}\" width=\"{width:.2}\" height=\"{height}\"")
    };
    match *stretch {
        Seen::Many { from, to, count, .. } => {
            svg.push(format!("{}><title>{count} changes</title></rect>", rect("q", from, to)));
        }
        Seen::One { from, to, value } => {
            let (rect, shown) = (rect(class(value), from, to), fitted(value, to - from - 2.0 * MARGIN, LETTERS));
            svg.push(if shown.as_deref() == Some(value) {
                format!("{rect}/>")
            } else {
                format!("{rect}><title>{}</title></rect>", escaped(value))
            });
            if let Some(shown) = shown.filter(|shown| !shown.is_empty()) {
                let (x, base, shown) = (f64::midpoint(from, to), top + 14.0, escaped(&shown));
                svg.push(format!(
                    "<text class=\"bt\" x=\"{x:.2}\" y=\"{base:.1}\" text-anchor=\"middle\">{shown}</text>"
                ));
            }
        }
    }
}
