//! A plan as a drawing: position and its derivatives over time, one panel each, with their limits.
use super::curve::Curve;
use super::envelope::Envelope;
use super::panel::{Line, Panel};
use super::sheet::{Sheet, four_digits};
use super::window::Window;
use super::{NAMES, PlannedMove, derivatives};
use crate::drawing::unit_at;
use crate::error::ReportError;
use crate::text::wrapped;
use servobench_motion::online::Sides;
use servobench_planner::Span;

/// Characters in a line below the title.
const CHARACTERS: usize = 108;
/// Most polynomials that are drawn exactly; more are drawn as an envelope.
const EXACT: usize = 250;
/// Samples of a polynomial that find the range of its position.
const LOOKS: u32 = 8;

impl PlannedMove {
    /// The move as self-contained SVG.
    ///
    /// Every polynomial is drawn exactly, also those of a sampled profile, which is continuous between its samples; set-points
    /// with a hold are drawn in steps. Of very many polynomials the lowest and the highest value in each column of pixels are drawn.
    ///
    /// `from` and `to` (s) select the part drawn; `None` is the beginning, or the end.
    ///
    /// # Errors
    /// [`ReportError`] where the move has no such time.
    pub fn svg(&self, from: Option<f64>, to: Option<f64>) -> Result<String, ReportError> {
        let (n, duration) = (self.plan.order(), self.plan.duration());
        let window = Window::of(duration, from, to)?;
        let seen = || self.plan.spans().filter_map(|span| window.part(span));
        let spans: Vec<Span> = seen().take(EXACT + 1).collect();
        let end = if window.to < duration { self.plan.at(window.to) } else { self.plan.end() };
        let envelope = (spans.len() > EXACT).then(|| Envelope::of(seen(), &window));
        let start = spans.first().map_or(self.plan.start(), |span| span.state);
        let peaks = self.plan.peaks().map(|peak| (peak.lowest, peak.highest));
        let ranges = (0..NAMES.len()).map(|k| match &envelope {
            _ if k > 0 && window.is_whole => peaks[k - 1],
            Some(envelope) => envelope.range(k),
            None => range_of(&spans, k, derivatives(&start)[k]),
        });
        let limits = std::iter::once(Sides::both(f64::INFINITY)).chain(*self.plan.limits());
        let panels: Vec<Panel<'_>> = ranges
            .zip(limits)
            .enumerate()
            .take(n + 1)
            .map(|(k, ((low, high), limit))| {
                let unit = self.drawn_unit(k);
                let scale = unit.scale();
                let line = if let Some(envelope) = &envelope {
                    Line::Seen(envelope, k)
                } else {
                    let (from_zero, to_zero) = (k == n && window.from <= 0.0, k == n && window.to >= duration);
                    Line::Exact(Curve { spans: &spans, end, k, from_zero, to_zero, scale })
                };
                let limit = Sides { below: limit.below / scale, above: limit.above / scale };
                Panel { name: NAMES[k], unit, range: (low / scale, high / scale), limit, line }
            })
            .collect();
        // In the unit of the time axis; the table has them to the nanosecond.
        let (unit, scale) = unit_at(duration, "s", true);
        let shown = |time: f64| format!("{} {unit}", four_digits(time / scale));
        let what = self.what(&self.drawn_unit(0).short(self.distance()));
        let title = format!("{what} in {}, {}", shown(duration), self.kind());
        let stretch = (!window.is_whole).then(|| {
            let (unit, scale) = unit_at(window.to, "s", true);
            format!("from {} to {} {unit}", four_digits(window.from / scale), four_digits(window.to / scale))
        });
        let dwells: Vec<_> = self.dwells().map(|(name, _, value)| format!("{name} = {}", shown(value))).collect();
        let dwells = Some(dwells.join(", ")).filter(|dwells| !dwells.is_empty());
        let below = stretch.into_iter().chain(dwells).chain(self.notes()).collect::<Vec<_>>().join(" · ");
        let boundaries = if envelope.is_some() { Vec::new() } else { self.boundaries() };
        let sheet = Sheet {
            title: &title,
            lines: wrapped(&below, CHARACTERS),
            window,
            boundaries: boundaries.into_iter().filter(|time| window.contains(*time)).collect(),
            bindings: self.plan.bindings().into_iter().filter_map(|binding| window.part_of_binding(binding)).collect(),
            points: self.marked_points(),
            panels: &panels,
        };
        Ok(sheet.to_svg())
    }
}

/// The lowest and the highest value of derivative `k` of position, from `start` on.
fn range_of(spans: &[Span], k: usize, start: f64) -> (f64, f64) {
    let looks = spans.iter().flat_map(|span| {
        (0..=LOOKS).map(move |look| derivatives(&span.after(span.length * f64::from(look) / f64::from(LOOKS)))[k])
    });
    looks.fold((start, start), |(low, high), x| (low.min(x), high.max(x)))
}

#[cfg(test)]
mod tests {
    use super::super::panel::HEIGHT;
    use super::super::sheet::{GAP, LEFT, RIGHT, TOP, WIDTH};
    use super::super::{PlannedMove, moves};
    use servobench_base::Setpoint;
    use servobench_motion::pvt::Knot;
    use servobench_motion::sampled::Execution;
    use servobench_motion::shape::Shaper;
    use servobench_motion::{Limits, Order};
    use servobench_planner::{
        Filter, Follow, Generator, Method, PointToPoint, Request, Shaping, TableMove, Velocities,
    };
    use std::f64::consts::PI;

    /// The path of the line of panel `k`.
    fn path(svg: &str, k: usize) -> &str {
        let rest = svg.split("<path class=\"c\"").nth(k + 1).unwrap();
        rest.split(" d=\"").nth(1).unwrap().split('"').next().unwrap()
    }

    /// All numbers in `path`.
    fn numbers(path: &str) -> Vec<f64> {
        let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
        path.split(|c| !is_number(c)).filter(|text| !text.is_empty()).map(|text| text.parse().unwrap()).collect()
    }

    /// Parts of a path, each as a cubic curve: its ends and control points; vertical parts are left out.
    fn cubics(path: &str) -> Vec<[(f64, f64); 4]> {
        let mut parts: Vec<[(f64, f64); 4]> = Vec::new();
        let mut here = (0.0, 0.0);
        let starts = path.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(i, _)| i);
        let ends = starts.clone().skip(1).chain([path.len()]);
        for command in starts.zip(ends).map(|(start, end)| &path[start..end]) {
            let numbers = numbers(command);
            let straight = |to: (f64, f64)| {
                let along = |part: f64| (here.0 + part * (to.0 - here.0), here.1 + part * (to.1 - here.1));
                [here, along(1.0 / 3.0), along(2.0 / 3.0), to]
            };
            let part = match &command[..1] {
                "C" => [here, (numbers[0], numbers[1]), (numbers[2], numbers[3]), (numbers[4], numbers[5])],
                "L" => straight((numbers[0], numbers[1])),
                "H" => straight((numbers[0], here.1)),
                "V" => {
                    here.1 = numbers[0];
                    continue;
                }
                _ => {
                    here = (numbers[0], numbers[1]);
                    continue;
                }
            };
            here = part[3];
            parts.push(part);
        }
        parts
    }

    /// Pixels of the time and of the value `value` in panel `k`, whose values go from `low` to `high`. Room is 2 % at zero
    /// and 8 % elsewhere.
    fn pixel(duration: f64, k: u8, (low, high): (f64, f64), t: f64, value: f64) -> (f64, f64) {
        let span = high - low;
        let room = |side: f64| if side == 0.0 { 0.02 * span } else { 0.08 * span };
        let (bottom, top) = (low - room(low), high + room(high));
        let y = TOP + f64::from(k) * (HEIGHT + GAP) + (top - value) / (top - bottom) * HEIGHT;
        (LEFT + t / duration * (WIDTH - RIGHT - LEFT), y)
    }

    /// Oracle: the profile itself, at a hundred instants of every part. Coordinates are written to a hundredth of a pixel,
    /// and three of them err in the curve.
    #[test]
    fn curves_are_those_of_the_profile() {
        let plan = moves::lambrechts(Order::Fourth);
        let (profile, svg) = (&plan.plan, plan.svg(None, None).unwrap());
        let values: [fn(Setpoint) -> f64; 3] = [|at| at.x, |at| at.v, |at| at.a];
        for (k, (value, range)) in (0..).zip(values.into_iter().zip([(0.0, 1.0), (0.0, 1.0), (-5.0, 5.0)])) {
            for part in cubics(path(&svg, usize::from(k))) {
                for step in 0..=100 {
                    let u = f64::from(step) / 100.0;
                    let weights = [(1.0 - u).powi(3), 3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u), u.powi(3)];
                    let at =
                        |pick: fn(&(f64, f64)) -> f64| part.iter().zip(weights).map(|(p, w)| w * pick(p)).sum::<f64>();
                    let (x, y) = (at(|p| p.0), at(|p| p.1));
                    let t = (x - LEFT) / (WIDTH - RIGHT - LEFT) * profile.duration();
                    let expected = pixel(profile.duration(), k, range, t, value(profile.at(t)));
                    assert!((y - expected.1).abs() < 0.03, "panel {k} at {t} s: {y} instead of {}", expected.1);
                }
            }
        }
    }

    /// A part of the move: the same curve over another interval, and nothing of the rest. Oracle: the profile itself.
    #[test]
    fn a_part_of_a_move_is_drawn_alone() {
        let plan = moves::lambrechts(Order::Fourth);
        let (from, to) = (0.173, 0.391);
        let svg = plan.svg(Some(from), Some(to)).unwrap();
        assert!(svg.contains("from 173 to 391 ms") && svg.contains(">391</text>"), "{svg}");
        let at = |k: usize, t: f64| {
            let set_point = plan.plan.at(t);
            [set_point.x, set_point.v, set_point.a][k]
        };
        for k in 0..3 {
            let parts = cubics(path(&svg, k));
            let looks: Vec<f64> = (0..=1000).map(|i| from + (to - from) * f64::from(i) / 1000.0).collect();
            let values = || looks.iter().map(|t| at(k, *t));
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            // Lowest and highest values are at ends of the parts, and the scale between them is linear.
            let points: Vec<(f64, f64)> = parts.iter().flat_map(|part| [part[0], part[3]]).collect();
            let y = |value: f64| {
                let nearest = |wanted: f64| {
                    points
                        .iter()
                        .map(|(x, y)| (at(k, from + (x - LEFT) / (WIDTH - RIGHT - LEFT) * (to - from)), *y))
                        .min_by(|(one, _), (other, _)| (one - wanted).abs().total_cmp(&(other - wanted).abs()))
                        .unwrap()
                };
                let ((one, y_one), (two, y_two)) = (nearest(low), nearest(high));
                y_one + (value - one) / (two - one) * (y_two - y_one)
            };
            assert!((points[0].0 - LEFT).abs() < 0.01 && (points.last().unwrap().0 - (WIDTH - RIGHT)).abs() < 0.01);
            for (x, drawn) in &points {
                let t = from + (x - LEFT) / (WIDTH - RIGHT - LEFT) * (to - from);
                assert!((y(at(k, t)) - drawn).abs() < 0.1, "panel {k} at {t} s: {drawn} instead of {}", y(at(k, t)));
            }
        }
        // The snap of the whole move rises from zero; that of a part begins at its value there, -1000 m/s4.
        let (whole, part) = (plan.svg(None, None).unwrap(), plan.svg(Some(0.12), None).unwrap());
        let first = |svg: &str| numbers(path(svg, 4))[1];
        assert!(first(&part) > first(&whole) + 40.0, "{} {}", first(&part), first(&whole));
        assert!(plan.svg(Some(1.4), None).is_err());
    }

    /// A corner would show as a tangent that differs left and right of a point. A hundredth of a pixel of the control points
    /// turns a tangent of ten pixels by a thousandth.
    #[test]
    fn curves_have_no_corners() {
        let svg = moves::lambrechts(Order::Fourth).svg(None, None).unwrap();
        for k in 0..3 {
            let parts = cubics(path(&svg, k));
            assert!(parts.len() >= 15, "{}", parts.len());
            for pair in parts.windows(2) {
                let slope = |from: (f64, f64), to: (f64, f64)| (to.1 - from.1) / (to.0 - from.0);
                let (before, after) = (slope(pair[0][2], pair[0][3]), slope(pair[1][0], pair[1][1]));
                assert!((before - after).abs() < 0.02, "{before} and {after} at {:?}", pair[1][0]);
            }
        }
    }

    /// Jerk is straight from switch to switch; snap is horizontal and vertical and ends on both sides at zero.
    #[test]
    fn the_highest_derivatives_are_drawn_without_slant() {
        let svg = moves::lambrechts(Order::Fourth).svg(None, None).unwrap();
        let (jerk, snap) = (path(&svg, 3), path(&svg, 4));
        assert!(jerk.chars().all(|c| !c.is_ascii_alphabetic() || "MLH".contains(c)), "{jerk}");
        assert!(snap.chars().all(|c| !c.is_ascii_alphabetic() || "MHV".contains(c)), "{snap}");
        let zero = pixel(1.35, 4, (-1000.0, 1000.0), 0.0, 0.0).1;
        let numbers = numbers(snap);
        assert!((numbers[1] - zero).abs() < 0.02 && (numbers.last().unwrap() - zero).abs() < 0.02, "{snap}");
    }

    /// A move of 1.35 thousand million samples needs no more space than the continuous one, and looks the same.
    #[test]
    fn the_size_of_a_drawing_does_not_depend_on_the_number_of_samples() {
        let (fine, continuous) =
            (moves::sampled(1e-9).svg(None, None).unwrap(), moves::lambrechts(Order::Fourth).svg(None, None).unwrap());
        assert!(fine.len() < 40_000, "{} bytes", fine.len());
        for panel in 0..5 {
            let (one, two) = (numbers(path(&fine, panel)), numbers(path(&continuous, panel)));
            assert!(
                one.len() == two.len() && one.iter().zip(two).all(|(one, two)| (one - two).abs() < 0.02),
                "{panel}"
            );
        }
    }

    /// Pulses of jerk that last 1e-9 of the move reach their limit in the drawing.
    #[test]
    fn the_shortest_pulse_is_drawn_to_its_peak() {
        let limits = Limits { velocity: 1.0, acceleration: 1e-3, jerk: 1e6, snap: 1e16 };
        let peak = moves::published(Order::Fourth, 1.0, limits).plan.largest()[2];
        let svg = moves::published(Order::Fourth, 1.0, Limits { jerk: peak, ..limits }).svg(None, None).unwrap();
        let top = pixel(1.0, 3, (-peak, peak), 0.0, peak).1;
        let highest = cubics(path(&svg, 3)).into_iter().map(|part| part[3].1).fold(f64::INFINITY, f64::min);
        assert!((highest - top).abs() < 0.02, "{highest} {top}");
    }

    #[test]
    fn the_ends_of_the_segments_and_of_the_move_are_marked() {
        let svg = moves::lambrechts(Order::Fourth).svg(None, None).unwrap();
        assert_eq!(svg.matches("class=\"b\"").count(), 5 * 15, "15 segments in five panels");
        assert_eq!(svg.matches("class=\"e\"").count(), 1);
        assert!(svg.contains(">1.35</text>"), "the end of the move");
        // 1.35 s is too close to 1.4 s for that label, not to 1.2 s.
        assert!(svg.contains(">1.2</text>"));
    }

    #[test]
    fn times_are_written_in_the_unit_of_the_axis() {
        let limits = Limits { velocity: 1.0, acceleration: 3.0, jerk: 100.0, snap: 1e4 };
        let svg = moves::published(Order::Second, 1e-3, limits).svg(None, None).unwrap();
        // Two halves of √(1 mm/3 m/s²) = 18.257 ms each.
        assert!(svg.contains(">1.00 mm in 36.51 ms, order 2<") && svg.contains("t_a = 18.26 ms"), "{svg}");
        assert!(svg.contains(">36.51</text>") && svg.contains(">time (ms)</text>"));
    }

    #[test]
    fn a_move_of_no_distance_is_still_a_drawing() {
        let limits = Limits { velocity: 1.0, acceleration: 1.0, jerk: 1.0, snap: 1.0 };
        let svg = moves::published(Order::Third, 0.0, limits).svg(None, None).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && !svg.contains("NaN"), "{svg}");
    }

    /// Lambrechts' move is at its limits in as many intervals as its figure shows: velocity in one, acceleration in two,
    /// jerk in four, and snap in eight.
    #[test]
    fn where_a_bound_binds_is_marked() {
        let svg = moves::lambrechts(Order::Fourth).svg(None, None).unwrap();
        let marks: Vec<usize> = svg
            .split("<path class=\"m\"")
            .skip(1)
            .map(|rest| rest.split("/>").next().unwrap().matches('M').count())
            .collect();
        // The last one is the symbol in the key.
        assert_eq!(marks, [1, 2, 4, 8, 1]);
        assert!(svg.contains(">at its limit<") && !svg.contains("for an instant"));
    }

    #[test]
    fn a_limit_that_is_touched_gets_a_dot() {
        let limits = |velocity| Limits { velocity, ..moves::LAMBRECHTS };
        let peak = moves::published(Order::Third, 0.01, limits(1.0)).plan.largest()[0];
        let svg = moves::published(Order::Third, 0.01, limits(peak)).svg(None, None).unwrap();
        assert!(svg.contains("<path class=\"d\"") && svg.contains("at its limit for an instant"), "{svg}");
    }

    /// The panels end with the order: none is empty.
    #[test]
    fn there_is_a_panel_for_each_derivative_that_is_limited() {
        let svg = moves::lambrechts(Order::Third).svg(None, None).unwrap();
        assert!(svg.contains(">jerk<") && !svg.contains(">snap<"));
    }

    /// A quarter of a turn: 90 at the axis, and a limit of 60 rpm.
    #[test]
    fn angles_are_drawn_in_their_units() {
        let limits = Limits { velocity: 2.0 * PI, acceleration: 50.0, jerk: f64::INFINITY, snap: f64::INFINITY };
        let (order, method, distance) = (Order::Second, Method::Published, PI / 2.0);
        let asked = PointToPoint { distance, order, limits, method, grid: None };
        let plan = PlannedMove::new(Request::new(Generator::PointToPoint(asked)), "rad").unwrap();
        let svg = plan.as_given(0, "90 deg", PI / 2.0).as_given(1, "60 rpm", 2.0 * PI).svg(None, None).unwrap();
        for text in [">90 deg in 375.7 ms, order 2<", ">peak 90 deg<", ">limit 60 rpm<", ">rev/s²<"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
        assert!(!svg.contains("rad"));
    }

    /// The samples of the cascade, as far as they are visible, and a table of a hundred thousand points.
    #[test]
    fn very_many_polynomials_take_little_room() {
        let knots = (0..100_000).map(|k| Knot::new(f64::from(k), f64::from(k % 3))).collect();
        let asked = TableMove { knots, velocities: Velocities::Average, follow: Follow::Segments };
        for plan in [moves::executed(1e-3, Execution::ForwardEuler), moves::of(Generator::Table(asked))] {
            let svg = plan.svg(None, None).unwrap();
            assert!(svg.len() < 200_000 && svg.contains("class=\"v\""), "{} bytes", svg.len());
        }
    }

    /// A filter cuts the profile where its pieces begin, also in the middle of a cruise: there is a line where the snap changes, as there
    /// is a row in the table, and nowhere else.
    #[test]
    fn lines_of_segments_stand_where_the_highest_derivative_changes() {
        let generator = |order| {
            let asked =
                PointToPoint { distance: 0.1, order, limits: moves::LAMBRECHTS, method: Method::Published, grid: None };
            Generator::PointToPoint(asked)
        };
        for order in [Order::Second, Order::Third, Order::Fourth] {
            for shaper in [Shaper::Zv, Shaper::Zvd, Shaper::Ei { tolerable: 0.05 }] {
                let shaping = Shaping { shaper, frequency: 38.985, damping: 0.02 };
                let filter = Filter { shapers: vec![shaping], ..Filter::default() };
                let request = Request { filter, ..Request::new(generator(order)) };
                let svg = PlannedMove::new(request, "m").unwrap().svg(None, None).unwrap();
                let mut lines: Vec<&str> =
                    svg.split("class=\"b\" x1=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
                lines.truncate(lines.len() / (order.derivative() + 1));
                let highest = path(&svg, order.derivative());
                let (last, within) = lines.split_last().unwrap();
                assert_eq!(*last, "728.00");
                for x in within {
                    assert!(
                        highest.contains(&format!("H{x}V")),
                        "{order:?}, {shaper:?}: nothing changes at {x}: {highest}"
                    );
                }
            }
        }
    }
}
