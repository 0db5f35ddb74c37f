//! Names and numbers of any kind: XML that can be read, places that are numbers on the page, lines of 80 columns.
use roxmltree::Document;
use servobench_report::{Style, SweepOptions, sweep_front, sweep_map, sweep_table};
use servobench_sweep::{
    Arrangement, Axis, Column, Distribution, Drawn, Draws, Method, Outcome, Spacing, Sweep, Table, Value,
};

const NAME: &str = "axis.<&\"'>]]>\u{1b}[2J\u{202e}\n::error::";

fn long() -> String {
    format!("{NAME}{}", "x".repeat(300))
}

/// Axes from none to four, grids and zips, with draws and without.
fn sweeps() -> Vec<Sweep> {
    let numbers = |key: &str, values: &[f64], unit: &str| Axis {
        key: key.into(),
        values: values.iter().map(|value| Value::Number(*value, unit.into())).collect(),
    };
    let texts = |key: &str, values: &[&str]| Axis {
        key: key.into(),
        values: values.iter().map(|value| Value::Text((*value).into())).collect(),
    };
    let axes = [
        numbers(&long(), &[-1e300, 0.0, 1e300], NAME),
        texts(NAME, &["", &long(), "<&\"", "same"]),
        numbers("b", &[1e-320, 1e-300, 1.0], ""),
        texts("..", &["x", "y"]),
    ];
    let normal = Distribution::Normal { mean: 0.0, sigma: 1e290 };
    let drawn = || Drawn { key: format!("drawn.{}", long()), unit: NAME.into(), distribution: normal };
    let draws = |count| Draws::new(count, 1, Method::Random, vec![drawn()]).unwrap();
    let mut sweeps = Vec::new();
    for count in 0..=axes.len() {
        for draws in [None, Some(draws(1)), Some(draws(30))] {
            sweeps.push(Sweep::new(axes[..count].to_vec(), Arrangement::Grid, draws).unwrap());
        }
    }
    let zip = vec![axes[0].clone(), axes[2].clone(), texts("t", &["a", "a", "a"])];
    sweeps.push(Sweep::new(zip, Arrangement::Zip, None).unwrap());
    sweeps.push(Sweep::new(vec![axes[2].clone()], Arrangement::Grid, None).unwrap());
    let one = Axis::range("one", [5.0, 5.0], "m", 2, Spacing::Linear).unwrap();
    sweeps.push(Sweep::new(vec![one], Arrangement::Grid, None).unwrap());
    sweeps
}

type Values = fn(usize) -> f64;

const VALUES: [Values; 9] = [
    |_| f64::NAN,
    |row| if row == 1 { 3.0 } else { f64::NAN },
    |row| if row % 2 == 0 { f64::INFINITY } else { f64::NEG_INFINITY },
    |row| if row % 2 == 0 { 1e300 } else { -1e300 },
    |row| if row % 3 == 0 { f64::MAX } else { -f64::MAX },
    |_| 0.0,
    |row| if row % 2 == 0 { 5e-324 } else { 1e-310 },
    |row| if row % 2 == 0 { 1e-300 } else { 1e300 },
    |row| 1.0 + 1e-16 * row as f64,
];

fn table<'a>(sweep: &'a Sweep, engines: &'a [String], values: [Values; 2]) -> Table<'a> {
    let rows = engines.len().max(1) * sweep.points();
    let named = |name: &str, unit: &str, values: Values| Column {
        name: name.into(),
        unit: unit.into(),
        values: (0..rows).map(values).collect(),
    };
    let outcome = |row: usize| [Outcome::Good, Outcome::Failed, Outcome::Good, Outcome::NoVerdict][row % 4];
    let columns = vec![
        named("move_time", "s", values[0]),
        named("residual_vibration_pp", "m", values[1]),
        named(&long(), NAME, values[0]),
        named("", "", values[1]),
    ];
    Table { sweep, engines, columns, outcomes: (0..rows).map(outcome).collect() }
}

/// Every number of every attribute is one, and what has a place has it on the page.
fn check(svg: &str) {
    let document = Document::parse(svg).unwrap();
    let height: f64 = document.root_element().attribute("height").unwrap().parse().unwrap();
    assert!(height < 4000.0, "{height}");
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            assert!(!value.contains("NaN") && !value.contains("inf"), "{name}={value}");
            let end = match name {
                "x" | "cx" => 860.0,
                "y" | "cy" => height,
                _ => continue,
            };
            if node.ancestors().any(|above| above.has_tag_name("g")) {
                continue;
            }
            let place: f64 = value.parse().unwrap_or_else(|_| panic!("{name}={value}"));
            assert!((-1.0..=end).contains(&place), "{name}={value} of {end}");
        }
        if let Some(path) = node.attribute("d") {
            let numbers = path.split(|c: char| c.is_ascii_alphabetic() || c == ',').filter(|part| !part.is_empty());
            for number in numbers {
                assert!(number.parse::<f64>().is_ok_and(|number| (-20.0..4000.0).contains(&number)), "{path}");
            }
        }
    }
    assert!(!svg.contains('\u{1b}') && !svg.contains('\u{202e}'));
}

#[test]
fn whatever_goes_in_what_comes_out_is_sound() {
    let engines = [vec![], vec!["exact".to_owned()], vec!["exact".to_owned(), long()]];
    let mut drawings = 0;
    for sweep in sweeps() {
        for (k, engines) in engines.iter().enumerate() {
            for (i, first) in VALUES.iter().enumerate() {
                // Each with itself, and with another.
                for second in [*first, VALUES[(i + k + 1) % VALUES.len()]] {
                    let table = table(&sweep, engines, [*first, second]);
                    for judged in [true, false] {
                        let options = SweepOptions {
                            title: &long(),
                            note: &long(),
                            time: None,
                            vibration: None,
                            judged,
                            equal_length: 0.0,
                            seed: &long(),
                        };
                        let text = sweep_table(&table, Style::default(), &options);
                        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
                        assert!(!text.contains('\u{1b}') && !text.contains('\u{202e}'));
                        let svgs = [sweep_map(&table, &options), sweep_front(&table, &options)];
                        for svg in svgs.iter().flatten() {
                            drawings += 1;
                            check(svg);
                        }
                    }
                }
            }
        }
    }
    assert!(drawings > 1000, "{drawings}");
}

/// A table that holds less than it is to: rows that are not there, columns that are too short.
#[test]
fn what_is_missing_is_missing() {
    let axis = Axis::range("k", [1.0, 2.0], "m", 5, Spacing::Linear).unwrap();
    let sweep = Sweep::new(vec![axis], Arrangement::Grid, None).unwrap();
    let short = Column { name: "move_time".into(), unit: "s".into(), values: vec![1.0, 2.0] };
    let options = SweepOptions { judged: true, ..SweepOptions::default() };
    for outcomes in [vec![], vec![Outcome::Good; 3]] {
        let table = Table { sweep: &sweep, engines: &[], columns: vec![short.clone()], outcomes };
        let text = sweep_table(&table, Style::default(), &options);
        assert!(text.contains("5 combinations"), "{text}");
        if let Some(svg) = sweep_map(&table, &options) {
            check(&svg);
        }
        assert!(sweep_front(&table, &options).is_none());
    }
}
