//! Two quantities against each other: a picture with its own axes.
//!
//! Rerun's plots have time on one axis, and its 2D view has no axes and one scale for both directions. So a plane is drawn as lines and
//! numbers at round values, in a frame of fixed size.
use crate::layout::{Node, View};
use crate::rerun::blueprint::archetypes::VisualBounds2D;
use crate::rerun::{EntityPath, LineStrips2D, Points2D, RecordingStream, RecordingStreamResult};
use crate::rerun::{Range2D, ShowLabels};
use crate::run::range;
use crate::scale::Scale;
use crate::style::{self, Rgb};

/// Width of a frame whose height is 1.
const WIDTH: f64 = 1.6;
/// Margin of a frame for the numbers at its axes.
const AROUND: f64 = 0.14;
/// Share of the range of the curves that stays free at their ends.
const FREE: f64 = 0.06;
/// Approximate number of lines across a frame.
const LINES: f64 = 5.0;
/// Distances from a frame of the numbers at its lines, and of the names below and beside it.
const NUMBERS: f64 = 0.035;
const NAMES: f32 = 0.1;

/// One axis: its quantity and scale.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    /// `speed`
    pub(crate) name: &'static str,
    /// Its unit.
    pub(crate) scale: Scale,
}

/// Lines in a plane.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub(crate) path: EntityPath,
    /// Text at its first point.
    pub(crate) label: Option<String>,
    pub(crate) colour: Rgb,
    /// Width (points).
    pub(crate) width: f32,
    /// Points (SI), in unbroken lines.
    pub(crate) strips: Vec<Vec<[f64; 2]>>,
}

/// A picture.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    pub(crate) title: String,
    /// Entity of its frame.
    pub(crate) path: EntityPath,
    pub(crate) axes: [Axis; 2],
    /// True if both axes have one scale: a circle is a circle.
    pub(crate) is_isometric: bool,
    pub(crate) curves: Vec<Curve>,
}

/// Transformation from axis values to the frame.
struct Frame {
    /// Ends of both axes (SI).
    ends: [(f64, f64); 2],
    /// Size of the frame.
    size: [f64; 2],
}

impl Plane {
    /// The view of it.
    pub(crate) fn view(&self) -> Node {
        let frame = self.frame();
        let [width, height] = frame.size;
        let bounds = Range2D { x_range: [-AROUND, width + 0.04].into(), y_range: [-height - 0.12, AROUND].into() };
        let contents = std::iter::once(&self.path).chain(self.curves.iter().map(|curve| &curve.path));
        let view = View { recursive: true, ..View::new("2D", self.title.clone(), contents.cloned().collect()) };
        Node::View(view.with("VisualBounds2D", &VisualBounds2D::new(bounds)))
    }

    /// Logs frame and curves.
    pub(crate) fn log(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        let frame = self.frame();
        self.log_frame(stream, &frame)?;
        for curve in &self.curves {
            let place = |point: &[f64; 2]| frame.place(*point);
            let strips: Vec<Vec<[f32; 2]>> =
                curve.strips.iter().map(|strip| strip.iter().map(place).collect()).collect();
            let lines = LineStrips2D::new(strips).with_colors([curve.colour]).with_radii([-0.5 * curve.width]);
            stream.log_static(curve.path.clone(), &lines)?;
            if let (Some(label), Some(first)) = (&curve.label, curve.strips.iter().flatten().next()) {
                let point = written(&[(place(first), label.clone())]).with_colors([curve.colour]);
                stream.log_static(curve.path.join(&"label".into()), &point)?;
            }
        }
        Ok(())
    }

    fn log_frame(&self, stream: &RecordingStream, frame: &Frame) -> RecordingStreamResult<()> {
        let [width, height] = frame.size;
        let (mut lines, mut numbers) = (Vec::new(), Vec::new());
        for (index, axis) in self.axes.iter().enumerate() {
            let (low, high) = frame.ends[index];
            for value in round_values(low * axis.scale.factor, high * axis.scale.factor) {
                let at = |other: f64| {
                    if index == 0 { [value / axis.scale.factor, other] } else { [other, value / axis.scale.factor] }
                };
                let (from, to) = frame.ends[1 - index];
                lines.push(vec![frame.place(at(from)), frame.place(at(to))]);
                let [x, y] = frame.place(at(from));
                #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
                let by = NUMBERS as f32;
                numbers.push((if index == 0 { [x, y + by] } else { [x - by, y] }, crate::scale::short(value)));
            }
        }
        let names = self.axes.each_ref().map(|axis| axis.scale.title(axis.name));
        #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
        let [width, height] = [width, height].map(|length| length as f32);
        let [x, y] = names;
        numbers.push(([0.5 * width, NAMES], x));
        numbers.push(([0.0, -height - 0.5 * NAMES], y));
        let border = vec![[0.0, 0.0], [width, 0.0], [width, -height], [0.0, -height], [0.0, 0.0]];
        let grid = LineStrips2D::new(lines).with_colors([style::IDLE]).with_radii([-0.5]);
        stream.log_static(self.path.join(&"grid".into()), &grid)?;
        let border = LineStrips2D::new([border]).with_colors([style::MARK]).with_radii([-0.5]);
        stream.log_static(self.path.join(&"border".into()), &border)?;
        stream.log_static(self.path.join(&"numbers".into()), &written(&numbers).with_colors([style::MARK]))
    }

    fn frame(&self) -> Frame {
        let ends = [0, 1].map(|index| {
            let values = self.curves.iter().flat_map(|curve| curve.strips.iter().flatten()).map(|point| &point[index]);
            let (low, high) = range(values).unwrap_or((-1.0, 1.0));
            let free = if high > low { FREE * (high - low) } else { 1.0 };
            (low - free, high + free)
        });
        if !self.is_isometric {
            return Frame { ends, size: [WIDTH, 1.0] };
        }
        let spans = ends.map(|(low, high)| high - low);
        let longest = spans[0].max(spans[1]);
        Frame { ends, size: spans.map(|span| span / longest) }
    }
}

impl Frame {
    /// A point (SI) in the frame, whose lower left corner is 0; upwards is negative.
    #[expect(clippy::cast_possible_truncation, reason = "rounds, to far less than a pixel")]
    fn place(&self, point: [f64; 2]) -> [f32; 2] {
        let part = |index: usize| {
            let (low, high) = self.ends[index];
            self.size[index] * (point[index] - low) / (high - low)
        };
        [part(0) as f32, -part(1) as f32]
    }
}

/// Words at places.
fn written(words: &[([f32; 2], String)]) -> Points2D {
    let places = words.iter().map(|(place, _)| *place);
    let labels = words.iter().map(|(_, word)| word.as_str());
    Points2D::new(places).with_radii([-0.1]).with_labels(labels).with_show_labels(ShowLabels::from(true))
}

/// Round values between two: multiples of 1, 2 or 5 times a power of ten, about [`LINES`] of them.
fn round_values(low: f64, high: f64) -> Vec<f64> {
    let span = high - low;
    if !(span.is_finite() && span > 0.0) {
        return Vec::new();
    }
    let power = 10_f64.powf((span / LINES).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|step| span / step <= LINES + 1.0);
    let step = step.unwrap_or(10.0 * power);
    let first = (low / step).ceil();
    let all = (0..=12).map(|k| first + f64::from(k)).take_while(|k| *k * step <= high);
    // A multiple as it is written: 3·0.1 is not 0.3.
    all.map(|k| if power < 1.0 { k * (step / power).round() / (1.0 / power).round() } else { k * step }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_stand_at_round_values() {
        let values = |low, high| round_values(low, high);
        assert_eq!(values(-3.2, 3.2), [-2.0, 0.0, 2.0]);
        assert_eq!(values(0.0, 0.73), [0.0, 0.2, 0.4, 0.6]);
        assert_eq!(values(-1_234.0, 5_678.0), [0.0, 2_000.0, 4_000.0]);
        assert_eq!(values(0.31, 0.33), [0.31, 0.315, 0.32, 0.325, 0.33]);
        assert_eq!((values(1.0, 1.0), values(0.0, f64::NAN)), (vec![], vec![]));
    }
}
