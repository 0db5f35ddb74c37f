//! Velocity and position over time.
use super::window::Window;
use crate::drawing::{Axis, COLOURS, about_four, unit_at, with_zero};
use servobench_signals::Signal;
use servobench_trace::{Channel, Recording, envelope};
use std::fmt::Write;

/// Height of a panel (pixels).
pub(super) const HEIGHT: f64 = 104.0;
/// The panels from top to bottom: name, colour, set-point, motion of the load.
const PANELS: [(&str, &str, Signal, Signal); 2] = [
    ("velocity", COLOURS[1], Signal::SetpointVelocity, Signal::LoadVelocity),
    ("position", COLOURS[0], Signal::SetpointPosition, Signal::LoadPosition),
];
/// Larger values are not a motion, but a loop that diverged.
const DIVERGED: f64 = 1e100;
/// Values within this fraction of the largest are one, of which only rounding would be drawn.
const SAME: f64 = 1e-12;

/// One quantity over time.
#[derive(Debug)]
pub(super) struct Panel<'a> {
    pub(super) name: &'static str,
    pub(super) colour: &'static str,
    /// Unit (SI).
    unit: &'a str,
    pub(super) lines: Vec<Line>,
}

/// One curve.
#[derive(Debug)]
pub(super) struct Line {
    /// Quantity of the curve: `set-point`, `load`.
    pub(super) label: &'static str,
    /// Class of its style.
    pub(super) class: &'static str,
    /// Time (s) and value, ascending.
    points: Vec<(f64, f64)>,
}

/// The panels of `recording` in `window`, thinned for `width` pixels.
pub(super) fn panels(recording: &Recording, window: Window, width: f64) -> Vec<Panel<'_>> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some thousand pixels")]
    let buckets = width as usize;
    let panel = |(name, colour, setpoint, load): (&'static str, &'static str, Signal, Signal)| {
        let mut unit = "";
        let mut lines = Vec::new();
        for (signal, label, class) in [(setpoint, "set-point", "c"), (load, "load", "a")] {
            let Some(channel) = recording.find(signal) else {
                continue;
            };
            let points = points(recording, channel, window, buckets);
            if points.iter().any(|(_, value)| is_value(*value)) {
                unit = &channel.spec.unit;
                lines.push(Line { label, class, points });
            }
        }
        (!lines.is_empty()).then_some(Panel { name, colour, unit, lines })
    };
    PANELS.into_iter().filter_map(panel).collect()
}

/// Visible points of `channel` in `window`, up to its very ends as far as it is recorded.
fn points(recording: &Recording, channel: &Channel, window: Window, buckets: usize) -> Vec<(f64, f64)> {
    let values = &channel.values[..channel.values.len().min(recording.len())];
    // On the straight line between the instants before and after.
    let between = |time: f64| {
        let after = recording.index_at(time);
        let (start, end) = (recording.time_of(after.checked_sub(1)?), recording.time_of(after));
        let (one, other) = (values.get(after - 1)?, values.get(after)?);
        let part = (time - start) / (end - start);
        (0.0..=1.0).contains(&part).then(|| (time, one + part * (other - one)))
    };
    let first = recording.index_at(window.from).min(values.len());
    let last = recording.index_at(window.to);
    let end = (last + usize::from(recording.time_of(last) <= window.to)).clamp(first, values.len());
    let within = &values[first..end];
    let kept = envelope(within, buckets).into_iter().map(|index| (recording.time_of(first + index), within[index]));
    between(window.from).into_iter().chain(kept).chain(between(window.to)).collect()
}

impl Panel<'_> {
    /// Its scale, from `top` down.
    pub(super) fn axis(&self, top: f64) -> Axis {
        let values = self.lines.iter().flat_map(|line| &line.points).map(|(_, value)| *value);
        let (low, high) = values
            .filter(|value| is_value(*value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let largest = high.abs().max(low.abs());
        let is_same = high - low <= SAME * largest || largest < DIVERGED.recip();
        let range = if is_same { (if largest < DIVERGED.recip() { 0.0 } else { low }, low) } else { (low, high) };
        Axis::upright(with_zero(range), top, HEIGHT)
    }

    /// Unit of the scale of `axis`, and its ticks: place (pixels), label, true at zero.
    pub(super) fn ticks(&self, axis: &Axis) -> (String, Vec<(f64, String, bool)>) {
        let (unit, scale) = unit_at(axis.low.abs().max(axis.high.abs()) / 1.08, self.unit, true);
        let ticks = about_four(axis.low / scale, axis.high / scale);
        (unit, ticks.into_iter().map(|(value, label)| (axis.at(value * scale), label, value == 0.0)).collect())
    }
}

impl Line {
    /// Its path; a new one begins after values that cannot be drawn.
    pub(super) fn path(&self, time: &Axis, value: &Axis) -> String {
        let tenth = |pixel: f64| (pixel * 10.0).round() / 10.0;
        let pixels: Vec<Option<(f64, f64)>> = self
            .points
            .iter()
            .map(|(t, level)| is_value(*level).then(|| (tenth(time.at(*t)), tenth(value.at(*level)))))
            .collect();
        let mut path = String::new();
        let mut before: Option<(f64, f64)> = None;
        for (i, pixel) in pixels.iter().enumerate() {
            if let Some((x, y)) = *pixel {
                let next = pixels.get(i + 1).copied().flatten();
                let is_level =
                    |other: Option<(f64, f64)>| other.is_some_and(|(_, there)| there.to_bits() == y.to_bits());
                let written = match (is_level(before), is_level(next)) {
                    // Continues a level line.
                    (true, true) => Ok(()),
                    (true, false) => write!(path, "H{x:.1}"),
                    _ if before.is_none() => write!(path, "M{x:.1},{y:.1}"),
                    _ => write!(path, "L{x:.1},{y:.1}"),
                };
                debug_assert!(written.is_ok(), "a string takes everything");
            }
            before = *pixel;
        }
        path
    }
}

/// True if `value` can be drawn.
fn is_value(value: f64) -> bool {
    value.abs() < DIVERGED
}
