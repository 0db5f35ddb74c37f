//! Drawings: what is read off them is what went in. `SERVOBENCH_SHOW=folder` writes them there.
use crate::samples::{Run, Sample, jerk, mass, names, number, ringing, shown, tolerances};
use roxmltree::{Document, Node};
use servobench_report::{SweepOptions, sweep_front, sweep_map};
use servobench_sweep::{Arrangement, Axis, Outcome, Spacing, Table, Value};

const OPTIONS: SweepOptions<'_> = SweepOptions {
    title: "feed axis with a springy load",
    note: "",
    time: None,
    vibration: None,
    judged: true,
    equal_length: 0.0,
    seed: "",
};

fn map(name: &str, table: &Table<'_>) -> String {
    shown(&format!("{name}-map.svg"), sweep_map(table, &OPTIONS).unwrap())
}

fn front(name: &str, table: &Table<'_>) -> String {
    shown(&format!("{name}-front.svg"), sweep_front(table, &OPTIONS).unwrap())
}

/// All texts with their places.
fn texts<'d>(document: &'d Document<'_>) -> Vec<(&'d str, f64, f64)> {
    let number = |node: Node<'_, '_>, name| node.attribute(name).and_then(|text| text.parse().ok()).unwrap_or(0.0);
    let nodes = document.descendants().filter(|node| node.has_tag_name("text"));
    nodes.map(|node| (node.text().unwrap_or_default(), number(node, "x"), number(node, "y"))).collect()
}

fn count(document: &Document<'_>, tag: &str, class: &str) -> usize {
    let is_it = |node: &Node<'_, '_>| node.has_tag_name(tag) && node.attribute("class") == Some(class);
    document.descendants().filter(is_it).count()
}

fn path<'d>(document: &'d Document<'_>, class: &str, which: usize) -> &'d str {
    let is_it = |node: &Node<'_, '_>| node.has_tag_name("path") && node.attribute("class") == Some(class);
    document.descendants().filter(is_it).nth(which).unwrap().attribute("d").unwrap()
}

/// The corners of a path of M, L, H and V.
fn corners(path: &str) -> Vec<(f64, f64)> {
    let starts: Vec<usize> = path.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(at, _)| at).collect();
    let ends = starts.iter().skip(1).copied().chain([path.len()]);
    let mut here = (0.0, 0.0);
    let mut corners = Vec::new();
    for (start, end) in starts.iter().zip(ends) {
        let numbers: Vec<f64> = path[start + 1..end].split(',').filter_map(|text| text.parse().ok()).collect();
        here = match (&path[*start..=*start], numbers.as_slice()) {
            ("H", [x]) => (*x, here.1),
            ("V", [y]) => (here.0, *y),
            (_, [x, y]) => (*x, *y),
            _ => continue,
        };
        corners.push(here);
    }
    corners
}

/// Pixels of a value on the scale through two labels of round numbers.
fn through((one, there): (f64, f64), (other, elsewhere): (f64, f64)) -> impl Fn(f64) -> f64 {
    move |value| there + (value - one) / (other - one) * (elsewhere - there)
}

#[test]
fn a_heat_map_has_each_combination_with_its_number() {
    let sample = Sample::new(vec![jerk(9), mass(7)], Arrangement::Grid, None);
    let table = sample.table(|_, x| ringing(number(x, 0), number(x, 1), 5e4, 3.0));
    let svg = map("grid", &table);
    let document = Document::parse(&svg).unwrap();
    // Four metrics of 63 combinations, each a number in its cell; a cross in the cells of those that miss a limit, and one in the key.
    assert_eq!(count(&document, "text", "v"), 4 * 63);
    let failed = table.outcomes.iter().filter(|outcome| **outcome == Outcome::Failed).count();
    assert!(failed > 3, "{failed}");
    let crosses = document.descendants().filter(|node| node.attribute("class") == Some("x"));
    let crosses: usize = crosses.map(|node| node.attribute("d").unwrap().matches('M').count()).sum();
    assert_eq!(crosses, 4 * failed + 1);
    // The least and the most vibration have the ends of the map.
    for (number, colour) in [("19.8 nm", "#440154"), ("7.08 µm", "#fde725")] {
        let (_, x, y) = *texts(&document).iter().find(|(text, ..)| *text == number).unwrap();
        let is_around = |node: &Node<'_, '_>| {
            let Some(path) = node.attribute("d").filter(|_| node.attribute("fill") == Some(colour)) else {
                return false;
            };
            path.split_inclusive('z').any(|cell| {
                let cell = corners(cell);
                cell[0].0 <= x && x <= cell[1].0 && cell[0].1 <= y && y <= cell[2].1
            })
        };
        assert!(document.descendants().any(|node| is_around(&node)), "{number} is not {colour}");
    }
    // Vibration spans two and a half decades: the labels at its colours are powers.
    assert!(texts(&document).iter().any(|(text, ..)| *text == "100 nm") && svg.contains(">setpoint.jerk (m/s3) →<"));
}

#[test]
fn further_dimensions_are_maps_side_by_side_and_what_is_left_out_is_said() {
    let shapers = names("shaper", &["none", "zv", "zvd", "ei"]);
    let orders = names("setpoint.order", &["jerk", "snap"]);
    let mut sample = Sample::new(vec![shapers, orders, jerk(9), mass(5)], Arrangement::Grid, None);
    sample.engines = vec!["exact".into(), "mujoco".into()];
    let table = sample.table(|engine, x| {
        let mut run = ringing(number(x, 2), number(x, 3), 5e4 + 10.0 * engine as f64, 3.0);
        if x[0].written() == "zvd" && number(x, 3) > 7.0 {
            run.0[1] = f64::NAN;
        }
        run
    });
    let svg = map("facets", &table);
    let document = Document::parse(&svg).unwrap();
    assert_eq!(count(&document, "rect", "o"), 4 * 12, "twelve maps of four metrics");
    assert!(svg.contains("above each map: shaper · engine · setpoint.order") && svg.contains(">zv · mujoco · snap<"));
    assert!(
        svg.contains(">12 of 16 combinations of the other keys are drawn<") && svg.contains(">not measured<"),
        "{svg}"
    );
    let hatched = document.descendants().filter(|node| node.attribute("fill") == Some("url(#sweep-not-measured)"));
    // One path in each map of the vibration with `zvd`, four of which are drawn, and the one in the key.
    assert_eq!(hatched.count(), 4 + 1);
}

/// Oracle: the labels of both axes, of which two make a scale. Coordinates are written to a tenth of a pixel.
#[test]
fn a_line_goes_through_its_values() {
    let along = Axis::range("axis.load.mass", [2.0, 8.0], "kg", 7, Spacing::Linear).unwrap();
    let sample = Sample::new(vec![along], Arrangement::Grid, None);
    let table = sample.table(|_, x| ([0.1 * number(x, 0), f64::NAN, 1.0, 1.0], Outcome::Good));
    let svg = map("line-linear", &table);
    let document = Document::parse(&svg).unwrap();
    let texts = texts(&document);
    let place = |label: &str| texts.iter().find(|(text, ..)| *text == label).map(|(_, x, y)| (*x, *y)).unwrap();
    let x = through((2.0, place("2").0), (8.0, place("8").0));
    let y = through((0.0, place("0.0").1 - 4.0), (0.8, place("0.8").1 - 4.0));
    let corners = corners(path(&document, "c", 0));
    assert_eq!(corners.len(), 7);
    for (mass, corner) in (2..).zip(corners) {
        let expected = (x(f64::from(mass)), y(0.1 * f64::from(mass)));
        assert!((corner.0 - expected.0).abs() < 0.2 && (corner.1 - expected.1).abs() < 0.3, "{corner:?} {expected:?}");
    }
    assert!(svg.contains("2 metrics are not drawn") && svg.contains("following_error_peak_load, torque_peak"), "{svg}");
}

#[test]
fn draws_are_a_band_and_the_share_that_keeps_all_limits_is_a_panel() {
    let sample = Sample::new(vec![jerk(31)], Arrangement::Grid, Some(tolerances(100)));
    let table = sample.table(|_, x| ringing(number(x, 0), number(x, 1), number(x, 2), 3.0));
    let svg = map("line-draws", &table);
    let document = Document::parse(&svg).unwrap();
    assert_eq!((count(&document, "path", "d"), count(&document, "path", "c")), (4, 4));
    for words in [">runs that keep all limits<", "more than 5 % of the draws miss a limit", ">10<", ">1000<"] {
        assert!(svg.contains(words), "{words}");
    }
    // A band goes there above the line and back below it.
    assert_eq!(corners(path(&document, "d", 0)).len(), 62);
    front("line-draws", &table);
    let two = Sample::new(
        vec![names("setpoint.order", &["jerk", "snap"]), jerk(13)],
        Arrangement::Grid,
        Some(tolerances(50)),
    );
    let order = |value: &Value| if value.written() == "snap" { 4.0 } else { 3.0 };
    let table = two.table(|_, x| ringing(number(x, 1), number(x, 2), number(x, 3), order(&x[0])));
    assert!(map("grid-draws", &table).contains("medians of 50 draws"));
    front("grid-draws", &table);
    let few = Sample::new(
        vec![names("shaper", &["none", "zv", "a name that has no room below its place"])],
        Arrangement::Grid,
        Some(tolerances(50)),
    );
    let table = few.table(|_, x| ringing(100.0, number(x, 1), number(x, 2), 3.0));
    let svg = map("names-draws", &table);
    let document = Document::parse(&svg).unwrap();
    assert_eq!(
        (count(&document, "path", "c"), count(&document, "path", "w")),
        (0, 3 * 4),
        "names have no line between them"
    );
}

/// Oracle: the labels of the axis, and by hand: of 1.01 to 1.99 s the median is 1.5 s, a twentieth is not above 1.053 s (type 8).
#[test]
fn a_distribution_has_its_quantiles() {
    let sample = Sample::new(vec![], Arrangement::Grid, Some(tolerances(99)));
    let next = std::cell::Cell::new(1.0);
    let table = sample.table(|_, _| {
        next.set(next.get() + 0.01);
        ([next.get(), 1e-6 * next.get(), f64::NAN, 7.0], Outcome::Good)
    });
    let svg = map("distribution", &table);
    let document = Document::parse(&svg).unwrap();
    assert_eq!(count(&document, "path", "q"), 2 * 3, "three quantiles of two metrics");
    assert!(svg.contains("5 % ≤ 1.05 s  ·  50 % ≤ 1.50 s  ·  95 % ≤ 1.95 s"), "{svg}");
    assert!(svg.contains("torque_peak") && svg.contains("1 metric is not drawn"));
    let texts = texts(&document);
    let place = |label: &str| texts.iter().find(|(text, ..)| *text == label).unwrap().1;
    let x = through((1.2, place("1.2")), (1.8, place("1.8")));
    let median = corners(path(&document, "q", 1));
    assert!((median.last().unwrap().0 - x(1.5)).abs() < 0.2, "{median:?}");
    assert!(sweep_front(&table, &OPTIONS).is_none());
}

/// The line of the front has a corner at each of its points, and the list says what these are.
#[test]
fn the_front_is_drawn_and_named() {
    let sample = Sample::new(vec![names("setpoint.order", &["jerk", "snap"]), mass(4)], Arrangement::Grid, None);
    let run = |x: &[Value]| -> Run {
        let (is_snap, mass) = (x[0].written() == "snap", number(x, 1));
        let (time, vibration) = if is_snap { (1.0 + 0.1 * mass, 1e-6 / mass) } else { (1.5 - 0.01 * mass, 4e-7) };
        ([time, vibration, 0.0, 0.0], if is_snap && mass < 3.0 { Outcome::Failed } else { Outcome::Good })
    };
    let table = sample.table(|_, x| run(x));
    let svg = front("front", &table);
    let document = Document::parse(&svg).unwrap();
    // By hand: `snap` with 2 kg fails and is out; 4 kg 1.4 s, 6 kg 1.6 s, 8 kg 1.8 s; `jerk` at 1.42 s is worse than 4 kg.
    let listed: Vec<&str> = texts(&document)
        .iter()
        .map(|(text, ..)| *text)
        .filter(|text| text.starts_with("order ") && text.contains("mass"))
        .collect();
    assert_eq!(listed, ["order snap, mass 4 kg", "order snap, mass 6 kg", "order snap, mass 8 kg"]);
    let line = corners(path(&document, "f", 1));
    assert_eq!(line.len(), 1 + 2 * 3 + 1);
    assert!(line.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1 + 0.01), "{line:?}");
    assert!(
        svg.contains("hollow: misses a limit") && svg.contains(">order snap<") && svg.contains("that keeps all limits")
    );
    // The more jerk the sooner and the louder, each by more than 1 %: all of them are on the line.
    let big = Sample::new(vec![jerk(20)], Arrangement::Grid, None);
    let table = big.table(|_, x| {
        let jerk = number(x, 0);
        ([jerk.powf(-0.3), 1e-8 * jerk, 0.0, 0.0], Outcome::Good)
    });
    assert!(front("big", &table).contains("12 of the 20 combinations on the line are named"));
    map("big", &table);
}

/// However much varies, a drawing is as large as it can be looked at.
#[test]
fn large_sweeps_have_drawings_of_bounded_size() {
    let sample = Sample::new(vec![jerk(300), mass(120), names("k", &["a", "b"])], Arrangement::Grid, None);
    let table = sample.table(|_, x| ringing(number(x, 0), number(x, 1), 5e4, 3.0));
    let (svg, front) = (map("large", &table), front("large", &table));
    // Two maps of four metrics of 120 by 60 cells, each with some 20 letters, and as many more for its cross.
    assert!(svg.len() < 8 * 7200 * 45 && front.len() < 500_000, "{} {}", svg.len(), front.len());
    assert!(
        svg.contains("120 of the 300 values of setpoint.jerk are drawn") && front.contains("one in 24 is drawn"),
        "{}",
        front.len()
    );
    let long = Sample::new(vec![jerk(100_000)], Arrangement::Grid, None);
    let table = long.table(|_, x| ringing(number(x, 0), 5.0, 5e4, 3.0));
    let svg = map("long", &table);
    assert!(svg.len() < 200_000 && svg.contains("600 of 100000 values are drawn"), "{}", svg.len());
}
