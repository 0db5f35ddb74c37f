//! One row: a logic trace, states as bars, or a number as a curve.
use super::group::{Kind, Row};
use super::stretch::{Seen, Stretch, seen};
use crate::drawing::{Axis, escaped, fitted, text_width};
use servobench_metrics::digits;
use std::fmt::Write;

/// Height of a row (pixels).
pub(super) const HEIGHT: f64 = 20.0;
/// Distances from the top of a row to TRUE and to FALSE, and to the edges of a bar.
const HIGH: f64 = 4.0;
const LOW: f64 = 16.0;
const BAR: (f64, f64) = (2.0, 18.0);
/// Size of letters in a bar, and the margin at each end of them.
const LETTERS: f64 = 11.0;
const MARGIN: f64 = 3.0;
/// Size of the letters beside a curve.
const SMALL: f64 = 10.0;

/// Values that mean off.
const OFF: [&str; 6] = ["FALSE", "0", "16#0000", "none", "Off", "Disabled"];
/// Parts of values and of names of signals that report an error.
const WRONG: [&str; 6] = ["Error", "Fault", "fault", "Aborted", "Underflow", "Overflow"];

/// True if `text` reports an error.
fn is_wrong(text: &str) -> bool {
    WRONG.iter().any(|wrong| text.contains(wrong))
}

/// Draws `row` with its top at `top`.
pub(super) fn draw(svg: &mut Vec<String>, row: &Row<'_>, time: &Axis, top: f64) {
    let seen = seen(&row.stretches, time);
    match row.kind {
        Kind::Logic => logic(svg, row.name, &seen, top),
        Kind::Number => curve(svg, &row.stretches, time, top),
        Kind::States => bars(svg, &seen, |value| class(row.name, value), top),
        Kind::Excused => bars(svg, &seen, |_| "bo", top),
        Kind::Missed => bars(svg, &seen, |_| "bx", top),
    }
}

/// A line that is low or high, filled below where it is high.
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
    // Errors are in front of the line, with a separate edge.
    let parts = if is_wrong(name) {
        [("q", blocks), ("w", line), ("x", fill)]
    } else {
        [("f", fill), ("q", blocks), ("w", line)]
    };
    let seen = parts.into_iter().filter(|(_, path)| !path.is_empty());
    svg.extend(seen.map(|(class, path)| format!("<path class=\"{class}\" d=\"{path}\"/>")));
}

/// A number from change to change, from its lowest value at the bottom of the row to its highest; both are written beside it. Of the
/// changes within half a pixel the lowest and the highest value are drawn.
fn curve(svg: &mut Vec<String>, stretches: &[Stretch<'_>], time: &Axis, top: f64) {
    let values = || stretches.iter().filter_map(|stretch| Some((*stretch, stretch.number()?)));
    let (low, high) =
        values().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, value)| (low.min(value), high.max(value)));
    // Half of each, as their difference may overflow.
    let range = 0.5 * high - 0.5 * low;
    let part = |value: f64| if range > 0.0 { (0.5 * value - 0.5 * low) / range } else { 0.0 };
    let level = |value: f64| top + LOW - (LOW - HIGH) * part(value);
    let (mut path, mut end) = (String::new(), time.from);
    for run in values().collect::<Vec<_>>().chunk_by(|one, next| half_pixel(time, one.0) == half_pixel(time, next.0)) {
        let ((first, _), (last, value)) = (run[0], run[run.len() - 1]);
        let (lowest, highest) =
            run.iter().fold((value, value), |(low, high), (_, value)| (low.min(*value), high.max(*value)));
        let x = time.at(first.from);
        let begun =
            if path.is_empty() { write!(path, "M{x:.2},{:.1}", level(run[0].1)) } else { write!(path, "H{x:.2}") };
        let written = if run.len() > 1 {
            write!(path, "V{:.1}V{:.1}V{:.1}", level(lowest), level(highest), level(value))
        } else {
            write!(path, "V{:.1}", level(value))
        };
        debug_assert!(begun.is_ok() && written.is_ok(), "a string takes everything");
        end = time.at(last.to);
    }
    let label = format!("{} … {}", digits(low, 4), digits(high, 4));
    let room = text_width(&label, SMALL) + 2.0 * MARGIN;
    // Places where the curve stays in the other half: at the end of the row, or at its beginning.
    let is_free = |from: f64, to: f64, is_above: bool| {
        let seen = stretches.iter().filter(|one| time.at(one.to) >= from && time.at(one.from) <= to);
        seen.filter_map(Stretch::number).all(|value| if is_above { part(value) <= 0.5 } else { part(value) >= 0.5 })
    };
    let places = [(time.to - room, time.to), (time.from, time.from + room)];
    let mut places = places.into_iter().flat_map(|(from, to)| [(from, to, true), (from, to, false)]);
    let (from, _, is_above) =
        places.find(|(from, to, above)| is_free(*from, *to, *above)).unwrap_or((time.to - room, time.to, true));
    let (x, base) = (from + MARGIN, top + if is_above { 7.5 } else { 20.0 });
    svg.push(format!(
        "<path class=\"w\" d=\"{path}H{end:.2}\"/>\n<text class=\"bn\" x=\"{x:.2}\" y=\"{base:.1}\">{label}</text>"
    ));
}

/// Half pixel in which an interval begins.
fn half_pixel(time: &Axis, stretch: Stretch<'_>) -> u64 {
    // A drawing has a few thousand pixels.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let half = (2.0 * time.at(stretch.from)) as u64;
    half
}

/// Class of the bar of `value` of the signal `name`.
fn class(name: &str, value: &str) -> &'static str {
    match value {
        _ if OFF.contains(&value) => "bo",
        _ if is_wrong(value) || is_wrong(name) => "bx",
        _ => "bs",
    }
}

/// A bar for each state with its name, as far as it fits. Those that report an error are in front: a short
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

#[cfg(test)]
mod tests {
    use super::*;

    fn stretches(values: &[(f64, &'static str)]) -> Vec<Stretch<'static>> {
        let ends = values.iter().skip(1).map(|(time, _)| *time).chain([1.0]);
        values.iter().zip(ends).map(|((from, value), to)| Stretch { from: *from, to, value, is_change: true }).collect()
    }

    /// From 0 at the bottom of a row at 0 to 4 at its top; 3 is three quarters up.
    #[test]
    fn a_number_is_a_curve_between_its_lowest_and_its_highest_value() {
        let time = Axis { low: 0.0, high: 1.0, from: 100.0, to: 200.0 };
        let mut svg = Vec::new();
        curve(&mut svg, &stretches(&[(0.0, "0"), (0.25, "4"), (0.5, "3")]), &time, 0.0);
        assert!(svg[0].contains("d=\"M100.00,16.0V16.0H125.00V4.0H150.00V7.0H200.00\""), "{}", svg[0]);
        assert!(svg[0].contains(">0 … 4</text>"), "{}", svg[0]);
        // Three changes within half a pixel: the lowest, the highest and the last of them.
        svg.clear();
        curve(&mut svg, &stretches(&[(0.0, "0"), (0.5001, "-4"), (0.5002, "4"), (0.5003, "0")]), &time, 0.0);
        assert!(svg[0].contains("H150.01V16.0V4.0V10.0H200.00"), "{}", svg[0]);
        // Numbers at the ends of the range of f64.
        svg.clear();
        curve(&mut svg, &stretches(&[(0.0, "-1.7e308"), (0.5, "1.7e308")]), &time, 0.0);
        assert!(!svg[0].contains("NaN") && !svg[0].contains("inf"), "{}", svg[0]);
        svg.clear();
        curve(&mut svg, &stretches(&[(0.0, "7"), (0.5, "7")]), &time, 0.0);
        assert!(svg[0].contains("M100.00,16.0V16.0H150.00V16.0H200.00"), "{}", svg[0]);
    }
}
