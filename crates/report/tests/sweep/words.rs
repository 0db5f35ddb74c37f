//! Tables.
use crate::samples::{METRICS, Sample, jerk, mass, names, number, ringing, shown, tolerances};
use servobench_report::{Style, SweepOptions, sweep_table};
use servobench_sweep::{Arrangement, Outcome, Table, Value};

const OPTIONS: SweepOptions<'_> =
    SweepOptions { title: "", note: "", time: None, vibration: None, judged: true, equal_length: 0.0, seed: "" };

fn words(name: &str, table: &Table<'_>, options: &SweepOptions<'_>) -> String {
    let text = shown(&format!("{name}.txt"), sweep_table(table, Style::default(), options));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    text
}

#[test]
fn a_grid_of_keys() {
    let sample =
        Sample::new(vec![names("setpoint.order", &["jerk", "snap"]), jerk(3), mass(2)], Arrangement::Grid, None);
    let order = |value: &Value| if value.written() == "snap" { 4.0 } else { 3.0 };
    let table = sample.table(|_, x| {
        let mut run = ringing(number(x, 1), number(x, 2), 5e4, order(&x[0]));
        if number(x, 1) < 20.0 && number(x, 2) > 7.0 {
            run = ([f64::NAN; 4], Outcome::NoVerdict);
        }
        run
    });
    insta::assert_snapshot!(words("grid", &table, &OPTIONS));
}

#[test]
fn draws_of_each_combination() {
    let sample = Sample::new(vec![jerk(4)], Arrangement::Grid, Some(tolerances(200)));
    let table = sample.table(|_, x| ringing(number(x, 0), number(x, 1), number(x, 2), 3.0));
    insta::assert_snapshot!(words("draws-of-each", &table, &OPTIONS));
}

#[test]
fn draws_alone() {
    let sample = Sample::new(vec![], Arrangement::Grid, Some(tolerances(1000)));
    let table = sample.table(|_, x| {
        let mut run = ringing(60.0, number(x, 0), number(x, 1), 3.0);
        run.0[0] += 1e-3 * number(x, 2);
        if number(x, 0) > 5.3 {
            run.1 = Outcome::Failed;
        }
        run
    });
    insta::assert_snapshot!(words("draws", &table, &OPTIONS));
    let unjudged = words("draws", &table, &SweepOptions { judged: false, ..OPTIONS });
    assert!(!unjudged.contains("limits"), "{unjudged}");
}

/// More than a screen: the fastest of those that keep all limits, and how many more there are.
#[test]
fn of_many_combinations_the_best_are_shown() {
    let sample = Sample::new(vec![jerk(20), mass(20)], Arrangement::Grid, None);
    let table = sample.table(|_, x| ringing(number(x, 0), number(x, 1), 5e4, 3.0));
    let text = words("many", &table, &OPTIONS);
    let rows: Vec<&str> = text.lines().filter(|line| line.contains("passed")).collect();
    assert!(rows.len() == 20 && text.contains("380 more are not shown") && !text.contains("FAILED"), "{text}");
    let best = table.columns[0].values.iter().zip(&table.outcomes).filter(|(_, outcome)| **outcome == Outcome::Good);
    let best = best.map(|(value, _)| *value).fold(f64::INFINITY, f64::min);
    assert!(rows[0].contains(&format!("{:.0} ms", 1e3 * best)), "{text}");
}

/// The names that are asked for stand in the place of the default ones; what was not measured is no default.
#[test]
fn time_and_vibration_are_those_that_are_asked_for() {
    let sample = Sample::new(vec![jerk(3)], Arrangement::Grid, None);
    let mut table = sample.table(|_, x| ringing(number(x, 0), 5.0, 5e4, 3.0));
    let asked = SweepOptions { vibration: Some("torque_peak"), ..OPTIONS };
    let of = |name: &str, table: &Table<'_>, options| {
        words(name, table, options).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(of("asked", &table, &asked).contains("smaller in both move_and_settling_time and torque_peak"));
    for (column, name) in table.columns.iter_mut().zip(["move_time", "residual_vibration_pp"]) {
        column.name = name.into();
    }
    assert!(of("default", &table, &OPTIONS).contains("smaller in both move_time and residual_vibration_pp"));
    table.columns[0].values.fill(f64::NAN);
    assert!(!of("none", &table, &OPTIONS).contains("smaller in both"));
    assert_eq!(METRICS.len(), 4);
}

/// What a run that broke off has measured says nothing.
#[test]
fn numbers_of_runs_without_a_verdict_are_in_no_statistic() {
    let sample = Sample::new(vec![], Arrangement::Grid, Some(tolerances(100)));
    let next = std::cell::Cell::new(0);
    let table = sample.table(|_, _| {
        next.set(next.get() + 1);
        if next.get() <= 50 { ([1.0, 1e-6, 0.0, 0.0], Outcome::Good) } else { ([1e9; 4], Outcome::NoVerdict) }
    });
    let text = words("broken", &table, &OPTIONS);
    assert!(text.contains("50 of 100 runs keep all limits: 50.0 %") && !text.contains("e9"), "{text}");
    assert!(text.contains("50 of 100 runs have no verdict"), "{text}");
}
