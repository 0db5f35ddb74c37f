//! Results of a sweep: its table as files, its pictures, and a report.
use super::points::Points;
use crate::args::SweepArgs;
use crate::console::{print, style};
use crate::error::CliError;
use crate::outputs::OutputFolder;
use crate::suite::how_to_resume;
use servobench_report::{SweepOptions, run_count, sweep_front, sweep_map, sweep_table, wrapped};
use servobench_results::{Columns, Outcome as Ended, Runs, SWEEP_FRONT, SWEEP_MAP, TABLE_CSV, TABLE_PARQUET};
use servobench_sweep::{Column, Outcome, Table};
use servobench_trace::{Cells, Table as File, TableColumn};
use std::borrow::Cow;

/// Writes tables and pictures into the folder of the results, and reports the cost of the values. An interrupted sweep has results only.
pub(super) fn say_what_came(
    runs: &dyn Runs,
    args: &SweepArgs,
    points: &Points<'_>,
    out: &OutputFolder,
) -> Result<(), CliError> {
    let resume = how_to_resume(runs, "sweep", &args.suite, out.path());
    if runs.unfinished().next().is_some() {
        return print(&[run_count(runs, style()), "\n".into(), resume].concat());
    }
    let columns = Columns::of(runs, points.len())?;
    let file = file_of(points, &columns);
    let csv = out.file(TABLE_CSV)?;
    csv.stream(|to| file.write_csv(to).map_err(|error| csv.failed(error)))?;
    let parquet = out.file(TABLE_PARQUET)?;
    parquet.stream(|to| file.write_parquet(to).map_err(|error| parquet.failed(error)))?;
    drop(file);

    let engines = points.engines();
    let table = table_of(points, &engines, columns);
    // Chosen values are compared at the worst of the given ones.
    let chosen = points.sweep().chosen();
    let at_its_worst = chosen.as_ref().map(|chosen| table.at_worst(chosen));
    let compared = at_its_worst.as_ref().unwrap_or(&table);
    let at_worst = match chosen {
        None => String::new(),
        Some(_) => format!("each at its worst over {}", points.sweep().given_keys().join(", ")),
    };
    let seed = points.too_few_seeds().unwrap_or_default();
    let options = SweepOptions {
        title: points.description(),
        note: &at_worst,
        judged: points.is_judged(),
        equal_length: points.equal_length(),
        seed: &seed,
        ..SweepOptions::default()
    };
    let mut has_pictures = false;
    let drawings = [(SWEEP_MAP, sweep_map(&table, &options)), (SWEEP_FRONT, sweep_front(compared, &options))];
    for (name, drawing) in drawings {
        if let Some(drawing) = drawing {
            out.file(name)?.write(drawing)?;
            has_pictures = true;
        }
    }
    let style = style();
    let count = run_count(runs, style) + "\n";
    if args.suite.quiet {
        return print(&count);
    }
    let described = [points.description(), &at_worst].into_iter().filter(|part| !part.is_empty());
    let described = described.collect::<Vec<_>>().join(", ");
    let mut described = wrapped(&described, style.width);
    if !described.is_empty() {
        described.extend([String::new(), String::new()]);
    }
    let folder = out.path().display();
    let pictures = if has_pictures { " and pictures" } else { "" };
    let where_it_is = format!("results, tables{pictures}: {folder}\n{resume}");
    print(&[described.join("\n"), sweep_table(compared, style, &options), "\n".into(), count, where_it_is].concat())
}

/// The runs as a table of `servobench-sweep`, with the requested metrics only: limited ones are in the files too.
fn table_of<'a>(points: &'a Points<'_>, engines: &'a [String], columns: Columns) -> Table<'a> {
    let outcome = |(outcome, is_broken): (Option<Ended>, bool)| match outcome {
        Some(outcome) if is_broken && (outcome.is_good() || outcome == Ended::Failed) => Outcome::Broken,
        Some(outcome) if outcome.is_good() => Outcome::Good,
        Some(Ended::Failed) => Outcome::Failed,
        Some(_) | None => Outcome::NoVerdict,
    };
    let outcomes = columns.outcomes.into_iter().zip(columns.broken).map(outcome).collect();
    let metrics = columns.metrics.into_iter().filter(|column| points.is_asked(column.metric));
    let columns = metrics.map(|of| Column { name: of.metric.to_string(), unit: of.unit, values: of.values }).collect();
    Table { sweep: points.sweep(), engines, columns, outcomes }
}

/// Table with a row for each run: number, engine, varied keys, verdict, metrics.
fn file_of<'a>(points: &'a Points<'_>, columns: &'a Columns) -> File<'a> {
    let count = points.sweep().points();
    let engines = points.engines();
    let numbers = |name: &str, unit: &str, cell: Box<dyn Fn(usize) -> f64 + 'a>| TableColumn {
        name: name.to_owned(),
        unit: unit.to_owned(),
        cells: Cells::Numbers(cell),
    };
    let texts = |name: &str, cell: Box<dyn Fn(usize) -> Cow<'a, str> + 'a>| TableColumn {
        name: name.to_owned(),
        unit: String::new(),
        cells: Cells::Texts(cell),
    };
    let mut all = vec![
        numbers("point", "", Box::new(move |row| (row % count + 1) as f64)),
        texts("engine", Box::new(move |row| engines[row / count].clone().into())),
    ];
    for (k, key) in points.sweep().columns().enumerate() {
        let value = move |row: usize| points.sweep().value(row % count, k);
        all.push(match key.unit {
            Some(unit) => {
                let cell = move |row| value(row).and_then(|value| value.number()).unwrap_or(f64::NAN);
                numbers(key.key, unit, Box::new(cell))
            }
            None => texts(key.key, Box::new(move |row| value(row).map_or_else(String::new, |v| v.written()).into())),
        });
    }
    let word = |outcome: &Option<Ended>| outcome.map_or("", verdict);
    all.push(texts("verdict", Box::new(move |row| Cow::Borrowed(word(&columns.outcomes[row])))));
    all.extend(
        columns
            .metrics
            .iter()
            .map(|column| numbers(column.metric.as_str(), &column.unit, Box::new(|row| column.values[row]))),
    );
    File { rows: points.len(), columns: all }
}

/// Verdict as in `results.json`.
const fn verdict(outcome: Ended) -> &'static str {
    match outcome {
        Ended::Passed => "passed",
        Ended::Unjudged => "unjudged",
        Ended::Failed => "failed",
        Ended::Invalid => "invalid",
        Ended::Error => "error",
    }
}
