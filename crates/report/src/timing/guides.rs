//! Guide lines: start and end of commands.
use super::group::{self, Group};
use crate::drawing::{Axis, escaped, text_width};

/// Input that begins a command.
const BEGIN: &str = "Execute";
/// Outputs by which a block reports that its command is over or in effect.
const ENDS: [&str; 7] =
    ["Done", "InVelocity", "InEndVelocity", "InTorque", "ProfileCompleted", "CommandAborted", "Error"];
/// More lines than this would hide the curves.
const MOST: usize = 60;
/// Instants closer than this are one (pixels).
const APART: f64 = 0.5;
/// Height for the times above the panels, and the part of it that the slanted lines take (pixels).
const STRIP: f64 = 24.0;
const SLANT: f64 = 9.0;
/// Size of the letters of a time, which are bold, and the gap between two (pixels).
const LETTERS: f64 = 11.0;
const BOLD: f64 = 1.12;
const ROOM: f64 = 6.0;

/// Kind of event at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A command begins.
    Begin,
    /// A command is over or in effect.
    End,
    /// A command begins as another is over.
    Both,
}

impl Kind {
    pub(super) const ALL: [Self; 3] = [Self::Begin, Self::End, Self::Both];

    /// Class of its line.
    pub(super) const fn class(self) -> &'static str {
        match self {
            Self::Begin => "gb",
            Self::End => "ge",
            Self::Both => "gc",
        }
    }
}

/// An instant at which a command begins or ends.
#[derive(Debug, Clone)]
struct Guide {
    /// Place (pixels).
    x: f64,
    /// Event: `First.Done`.
    what: String,
    kind: Kind,
    /// Time, in the unit of the time axis.
    label: String,
    /// Middle of the label (pixels); `None` if it does not fit.
    middle: Option<f64>,
}

/// The guide lines of a diagram.
#[derive(Debug, Default)]
pub(super) struct Guides {
    lines: Vec<Guide>,
    /// Number of lines, if they were left out as too many.
    pub(super) left_out: usize,
    /// Names of the outputs that end a command.
    ends: Vec<&'static str>,
}

/// True if the rise of a signal `name` has a guide line.
pub(super) fn has_guide(name: &str) -> bool {
    name == BEGIN || ENDS.contains(&name)
}

impl Guides {
    /// Guide lines of `groups`, with times in a unit of `scale` seconds.
    pub(super) fn of(groups: &[Group<'_>], time: &Axis, scale: f64) -> Self {
        let mut rises: Vec<(f64, Kind, String)> = Vec::new();
        let mut ends = Vec::new();
        for (group, row) in groups.iter().flat_map(|group| group.rows.iter().map(move |row| (group, row))) {
            let end = ENDS.into_iter().find(|end| *end == row.name);
            if row.kind != group::Kind::Logic || !has_guide(row.name) {
                continue;
            }
            let known = rises.len();
            let kind = if end.is_some() { Kind::End } else { Kind::Begin };
            rises.extend(row.rises().map(|t| (t, kind, format!("{}.{}", group.source, row.name))));
            if let Some(end) = end.filter(|end| rises.len() > known && !ends.contains(end)) {
                ends.push(end);
            }
        }
        rises.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut guides: Vec<(f64, Guide)> = Vec::new();
        for (t, kind, what) in rises {
            let x = time.at(t);
            match guides.last_mut() {
                Some((_, last)) if x - last.x < APART => {
                    last.kind = if last.kind == kind { kind } else { Kind::Both };
                    last.what = format!("{}, {what}", last.what);
                }
                _ => guides.push((t, Guide { x, what, kind, label: String::new(), middle: None })),
            }
        }
        if guides.len() > MOST {
            return Self { lines: vec![], left_out: guides.len(), ends: vec![] };
        }
        let times: Vec<f64> = guides.iter().map(|(t, _)| *t / scale).collect();
        let labels = labels(&times, (time.high - time.low) / scale / (time.to - time.from));
        let mut guides: Vec<Guide> =
            guides.into_iter().zip(labels).map(|((_, guide), label)| Guide { label, ..guide }).collect();
        place(&mut guides, time);
        Self { lines: guides, left_out: 0, ends }
    }

    /// Meaning of lines of that kind; `None` without any.
    pub(super) fn meaning(&self, kind: Kind) -> Option<String> {
        let is_there = |kind| self.lines.iter().any(|guide| guide.kind == kind);
        is_there(kind).then(|| match kind {
            Kind::Begin => format!("{BEGIN} rises"),
            Kind::End => format!("{} rises", self.ends.join(", ")),
            Kind::Both if is_there(Kind::Begin) && is_there(Kind::End) => "both at once".to_owned(),
            Kind::Both => format!("{BEGIN} and {} at once", self.ends.join(", ")),
        })
    }

    /// True without any lines.
    pub(super) const fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Height of the times above the panels.
    pub(super) const fn height(&self) -> f64 {
        if self.lines.is_empty() { 0.0 } else { STRIP }
    }

    /// Draws the lines from the times, which are above `top`, down to `bottom`, with their events.
    pub(super) fn draw(&self, svg: &mut Vec<String>, top: f64, bottom: f64) {
        for Guide { x, what, kind, label, middle } in &self.lines {
            let (class, what) = (kind.class(), escaped(what));
            let (start, base) = (top - SLANT, top - SLANT - 3.0);
            let slant = middle.map(|middle| format!("M{middle:.2},{start:.1}L"));
            let (to, foot) = (slant.as_deref().unwrap_or("M"), top - 1.0);
            svg.push(format!(
                "<path class=\"{class}\" d=\"{to}{x:.2},{foot:.1}V{bottom:.1}\"><title>{what}</title></path>"
            ));
            if let Some(middle) = middle {
                svg.push(format!(
                    "<text class=\"e\" x=\"{middle:.2}\" y=\"{base:.1}\" text-anchor=\"middle\">{label}</text>"
                ));
            }
        }
    }
}

/// Places the label of each of `guides` above its line, or as near as the others allow. If they do not all fit, only those
/// that need not move have one.
fn place(guides: &mut [Guide], time: &Axis) {
    let half = |guide: &Guide| 0.5 * (BOLD * text_width(&guide.label, LETTERS) + ROOM);
    let halves: Vec<f64> = guides.iter().map(half).collect();
    // Middles if all labels stood side by side, beginning at the left.
    let side_by_side: Vec<f64> = halves
        .iter()
        .scan(time.from, |end, half| {
            *end += 2.0 * half;
            Some(*end - half)
        })
        .collect();
    let free = time.to - time.from - 2.0 * halves.iter().sum::<f64>();
    if free < 0.0 {
        let mut taken = time.from - ROOM;
        for (guide, half) in guides.iter_mut().zip(halves) {
            if guide.x - half >= taken && guide.x + half <= time.to + ROOM {
                guide.middle = Some(guide.x);
                taken = guide.x + half;
            }
        }
        return;
    }
    // Wanted and actual shift of each from there: ascending, the mean of those that are in each other's way.
    let mut blocks: Vec<(f64, usize)> = Vec::new();
    let mean = |(sum, count): (f64, usize)| sum / count as f64;
    for (guide, place) in guides.iter().zip(&side_by_side) {
        let mut block = (guide.x - place, 1);
        while let Some(last) = blocks.pop_if(|last| mean(*last) > mean(block)) {
            block = (block.0 + last.0, block.1 + last.1);
        }
        blocks.push(block);
    }
    let moves = blocks.into_iter().flat_map(|block| std::iter::repeat_n(mean(block), block.1));
    for ((guide, place), by) in guides.iter_mut().zip(side_by_side).zip(moves) {
        guide.middle = Some(place + by.clamp(0.0, free));
    }
}

/// `times` in as many decimals as they need, at most to a tenth of `pixel`.
fn labels(times: &[f64], pixel: f64) -> Vec<String> {
    let exponent: i32 = format!("{pixel:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let most = usize::try_from(1 - exponent).unwrap_or(0);
    let needed = |time: &f64| {
        let text = format!("{time:.most$}");
        text.split_once('.').map_or(0, |(_, decimals)| decimals.trim_end_matches('0').len())
    };
    let decimals = times.iter().map(needed).max().unwrap_or(0);
    // A minus sign before zero looks like a mistake.
    times.iter().map(|time| format!("{:.decimals$}", if *time == 0.0 { 0.0 } else { *time })).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_decimals_that_they_need() {
        assert_eq!(labels(&[0.1, 1.302, 2.0], 0.005), ["0.100", "1.302", "2.000"]);
        assert_eq!(labels(&[0.0, 1.0 / 3.0], 0.005), ["0.0000", "0.3333"]);
        assert_eq!(labels(&[5.0, 10.0], 0.1), ["5", "10"]);
        assert_eq!(labels(&[1234.4], 40.0), ["1234"]);
    }

    fn guides(xs: &[f64]) -> Vec<Guide> {
        let guide =
            |x: &f64| Guide { x: *x, what: String::new(), kind: Kind::End, label: "1.234".into(), middle: None };
        xs.iter().map(guide).collect()
    }

    const TIME: Axis = Axis { low: 0.0, high: 1.0, from: 100.0, to: 500.0 };

    #[test]
    fn times_stand_side_by_side_near_their_lines() {
        let mut placed = guides(&[100.0, 250.0, 252.0, 400.0, 500.0]);
        place(&mut placed, &TIME);
        let middles: Vec<f64> = placed.iter().map(|guide| guide.middle.unwrap()).collect();
        let width = BOLD * text_width("1.234", LETTERS);
        assert!(middles.windows(2).all(|pair| pair[1] - pair[0] >= width + ROOM - 1e-9), "{middles:?}");
        assert!((f64::midpoint(middles[1], middles[2]) - 251.0).abs() < 1e-9, "the two move by the same: {middles:?}");
        assert!((middles[3] - 400.0).abs() < 1e-9 && middles[0] > 100.0 && middles[4] < 500.0, "{middles:?}");
    }

    #[test]
    fn of_too_many_times_only_some_are_written() {
        let xs: Vec<f64> = (0..40).map(|k| 100.0 + 10.0 * f64::from(k)).collect();
        let mut placed = guides(&xs);
        place(&mut placed, &TIME);
        let middles: Vec<f64> = placed.iter().filter_map(|guide| guide.middle).collect();
        assert!(middles.len() > 5 && middles.windows(2).all(|pair| pair[1] - pair[0] > 38.0), "{middles:?}");
    }
}
