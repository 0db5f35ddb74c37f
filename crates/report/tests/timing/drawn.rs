//! Reads a diagram back.
use roxmltree::{Document, Node};
use servobench_report::{TimingOptions, timing_diagram};
use servobench_trace::Recording;

/// The diagram of all of `recording`.
pub(crate) fn whole(recording: &Recording) -> String {
    timing_diagram(recording, &TimingOptions::default()).unwrap()
}

/// The elements `tag` of `class`, in order.
pub(crate) fn elements<'a>(document: &'a Document<'_>, tag: &'a str, class: &str) -> Vec<Node<'a, 'a>> {
    let is_it = |node: &Node<'_, '_>| node.has_tag_name(tag) && node.attribute("class") == Some(class);
    document.descendants().filter(is_it).collect()
}

/// The attribute `name` as a number.
pub(crate) fn number(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// The text that is seen of `node`, without a tooltip.
pub(crate) fn text<'a>(node: Node<'a, 'a>) -> &'a str {
    node.text().unwrap_or_default()
}

/// Where round numbers of one axis are (pixels): `labels` that stand at x, or y where they are `upright`, make a line
/// through two of them.
pub(crate) struct Scale {
    zero: f64,
    per_unit: f64,
}

impl Scale {
    /// The scale on which `one` and `other` are at these pixels.
    pub(crate) fn through((one, there): (f64, f64), (other, elsewhere): (f64, f64)) -> Self {
        let per_unit = (elsewhere - there) / (other - one);
        Self { zero: there - one * per_unit, per_unit }
    }

    /// That of time: its labels are centred, in the line right above `time (s)`.
    pub(crate) fn of_time(document: &Document<'_>) -> Self {
        let labels = elements(document, "text", "k");
        let unit = labels.iter().find(|node| text(**node).starts_with("time (s)")).unwrap();
        let line = number(*unit, "y") - 17.0;
        let places: Vec<(f64, f64)> = labels
            .iter()
            .filter(|node| (number(**node, "y") - line).abs() < 0.1)
            .map(|node| (text(*node).parse().unwrap(), number(*node, "x")))
            .collect();
        Self::through(places[0], *places.last().unwrap())
    }

    pub(crate) fn at(&self, value: f64) -> f64 {
        self.zero + value * self.per_unit
    }
}

/// The commands of a path with their numbers.
pub(crate) fn commands(path: &str) -> Vec<(char, Vec<f64>)> {
    let starts: Vec<usize> = path.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(i, _)| i).collect();
    let ends = starts.iter().skip(1).copied().chain([path.len()]);
    let numbers = |text: &str| -> Vec<f64> {
        text.split([',', ' ']).filter(|part| !part.is_empty()).map(|part| part.parse().unwrap()).collect()
    };
    starts.iter().zip(ends).map(|(i, end)| (char::from(path.as_bytes()[*i]), numbers(&path[i + 1..end]))).collect()
}

/// The corners of a path that goes along, upright and straight.
pub(crate) fn corners(path: &str) -> Vec<(f64, f64)> {
    let mut here = (0.0, 0.0);
    let step = |(command, numbers): (char, Vec<f64>)| {
        match command {
            'H' => here.0 = numbers[0],
            'V' => here.1 = numbers[0],
            _ => here = (numbers[0], numbers[1]),
        }
        here
    };
    commands(path).into_iter().filter(|(command, _)| *command != 'Z').map(step).collect()
}
