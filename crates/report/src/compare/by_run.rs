//! The table of many runs: a row for each, columns in as many blocks as they need.
use super::relation::Relation;
use super::table::{Kind, LIMITS, ROWS, SMALLEST, effort_word, largest, verdict};
use super::{Comparison, Value};
use crate::style::{Ink, Style};
use crate::text::{elided, widest};
use servobench_metrics::{Name, Quantity};

/// Widest name of a run (characters).
const LONGEST: usize = 22;
/// Gap between two columns.
const GAP: usize = 2;

/// A quantity of all runs.
struct Column {
    /// Name in two lines, and the unit.
    head: [String; 3],
    cells: Vec<String>,
}

impl Column {
    fn width(&self) -> usize {
        widest(self.head.iter().chain(&self.cells).map(String::as_str)) + GAP
    }
}

impl Comparison<'_> {
    /// A row for each run, an asterisk at the smallest value of a column. Limits and properties of the axis are listed if they differ.
    pub(super) fn table_by_run(&self, style: Style) -> String {
        let labels: Vec<String> = self.runs.iter().map(|run| elided(run.label, LONGEST)).collect();
        let name = widest(labels.iter().map(String::as_str));
        let room = style.width.saturating_sub(name);
        let mut blocks: Vec<Vec<Column>> = Vec::new();
        let mut used = 0;
        for column in self.columns() {
            used += column.width();
            match blocks.last_mut() {
                Some(block) if used <= room => block.push(column),
                _ => {
                    used = column.width();
                    blocks.push(vec![column]);
                }
            }
        }
        let mut table = String::new();
        for (k, block) in blocks.iter().enumerate() {
            if k > 0 {
                table.push('\n');
            }
            for line in 0..3 {
                let heads = block.iter().map(|column| format!("{:>1$}", column.head[line], column.width()));
                let line = format!("{:name$}{}", "", heads.collect::<String>());
                if !line.trim().is_empty() {
                    table += &style.paint(Ink::Heading, line.trim_end());
                    table.push('\n');
                }
            }
            for (row, label) in labels.iter().enumerate() {
                let cells = block.iter().map(|column| format!("{:>1$}", column.cells[row], column.width()));
                table += format!("{label:name$}{}", cells.collect::<String>()).trim_end();
                table.push('\n');
            }
        }
        table += &style.paint(Ink::Faint, SMALLEST);
        table.push('\n');
        table
    }

    fn columns(&self) -> impl Iterator<Item = Column> {
        let limits = LIMITS.into_iter().enumerate().filter_map(|(k, (words, power))| {
            let unit = format!("{}/s{power}", self.axis_unit());
            let values: Vec<_> = self.runs.iter().map(|run| Some((run.limit(k)?, unit.as_str()))).collect();
            column(words, (Kind::Limit, None), &values)
        });
        let metrics = ROWS.into_iter().filter_map(|(_, metric, kind)| {
            let values: Vec<_> = self.runs.iter().map(|run| run.metric(metric)).collect();
            let smallest = self.ranks(metric, kind).smallest;
            column(&effort_word(in_two_lines(metric), &values), (kind, smallest), &values)
        });
        let verdicts = self.has_out().then(|| Column {
            head: [String::new(), "verdict".to_owned(), String::new()],
            cells: self.runs.iter().map(|run| verdict(run).to_owned()).collect(),
        });
        let program =
            self.program().and_then(|(values, ranks)| column("program\ndone", (Kind::Time, ranks.smallest), &values));
        limits.chain(program).chain(metrics).chain(verdicts).collect::<Vec<_>>().into_iter()
    }
}

/// Name of a metric, in two short lines.
const fn in_two_lines(metric: Name) -> &'static str {
    match metric {
        Name::MoveTime => "move",
        Name::MoveAndSettlingTime => "move +\nsettling",
        Name::FollowingErrorPeakLoad => "peak error,\nload",
        Name::FollowingErrorPeakMotor => "peak error,\nmotor",
        Name::ResidualVibrationPp => "vibration,\np-p",
        Name::ResidualVibrationAmplitude => "amplitude\nof the mode",
        Name::ResidualVibrationFrequency => "frequency\nof the mode",
        Name::ResidualVibrationDamping => "damping\nratio",
        Name::TorquePeak => "peak\neffort",
        Name::TorqueRms => "RMS\neffort",
        Name::CurrentRms => "RMS\ncurrent",
        Name::ElectricalEnergy => "electrical\nenergy",
        Name::CopperLoss => "copper\nloss",
        _ => metric.as_str(),
    }
}

/// The column of `values`; `None` if no run has one, or if they are limits or properties that are the same for all runs.
fn column(words: &str, (kind, smallest): (Kind, Option<usize>), values: &[Option<Value<'_>>]) -> Option<Column> {
    let (first, unit) = values.iter().flatten().next().copied()?;
    let is_same = |value: &Option<Value<'_>>| match (value, kind) {
        (None, _) => true,
        (Some((value, _)), Kind::Limit) => value.to_bits() == first.to_bits(),
        (Some((value, _)), _) => Relation::of(first, *value) == Relation::Same,
    };
    if matches!(kind, Kind::Limit | Kind::Property) && values.iter().all(is_same) {
        return None;
    }
    // A single line goes next to the unit.
    let parted = if kind == Kind::Limit { words.rsplit_once(' ') } else { words.split_once('\n') };
    let (one, two) = parted.unwrap_or(("", words));
    let (symbol, scale) = Quantity::axis_unit(largest(values), unit);
    let cells = values.iter().enumerate().map(|(k, value)| match value {
        None => "–".to_owned(),
        Some((number, _)) if number.is_infinite() => "never".to_owned(),
        Some((_, other)) if *other != unit => "other unit".to_owned(),
        Some((number, _)) => {
            let mark = if smallest == Some(k) { "*" } else { "" };
            let digits = if kind == Kind::Property { 4 } else { 3 };
            format!("{mark}{:.digits$}", Quantity::new(number / scale, ""))
        }
    });
    Some(Column { head: [one.to_owned(), two.to_owned(), symbol], cells: cells.collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Compared, Noise};
    use servobench_results::RunResult;
    use servobench_results::samples::{jerk, lambrechts_move, of_numbers};

    fn eight() -> Vec<(String, RunResult)> {
        let names = ["none", "zv", "mzv", "zvd", "zvdd", "ei", "2hump-ei", "3hump-ei"];
        let runs = (0..8_u8).zip(names).map(|(k, name)| {
            let f = f64::from(k);
            let vibration = if k == 4 { 3e-9 } else { 3.4e-6 / (1.0 + f) };
            of_numbers(name, [1.3 + 0.01 * f, 0.1, 3.1e-6, vibration, 38.985, 0.0021, 170.0, 61.2])
        });
        names.into_iter().map(str::to_owned).zip(runs).collect()
    }

    #[test]
    fn eight_runs_are_rows_of_eighty_columns() {
        let all = eight();
        let runs = all.iter().map(|(label, result)| Compared { label, result, moves: &[], noise: Noise::None });
        let table = Comparison::new(runs.collect()).table(Style::default());
        insta::assert_snapshot!(table, @r#"
                          move +  peak error,  vibration,    amplitude   peak    RMS
                  move  settling         load         p-p  of the mode  force  force
                     s         s           µm          µm           µm      N      N
        none      1.30      1.40         3.10        3.40         1.70    170   61.2
        zv        1.31      1.41         3.10        1.70        0.850    170   61.2
        mzv       1.32      1.42         3.10        1.13        0.567    170   61.2
        zvd       1.33      1.43         3.10       0.850        0.425    170   61.2
        zvdd      1.34      1.44         3.10    *0.00300     *0.00150    170   61.2
        ei        1.35      1.45         3.10       0.567        0.283    170   61.2
        2hump-ei  1.36      1.46         3.10       0.486        0.243    170   61.2
        3hump-ei  1.37      1.47         3.10       0.425        0.213    170   61.2
        * smallest, by more than what counts as equal
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    #[test]
    fn limits_and_modes_are_there_where_they_differ() {
        let (other, one) = (of_numbers("other", [1.3, 0.1, 3e-6, 1e-6, 17.5, 0.0021, 170.0, 61.2]), jerk());
        let (slow, fast) = ([lambrechts_move(3)], [lambrechts_move(4)]);
        let label = "a name that is longer than a column";
        let mut runs = vec![Compared { label: "jerk", result: &one, moves: &slow, noise: Noise::None }; 5];
        let same = Comparison::new(runs.clone()).table(Style::default());
        assert!(!same.contains("limit") && !same.contains("frequency"), "{same}");
        runs[4] = Compared { label, result: &other, moves: &fast, noise: Noise::None };
        let table = Comparison::new(runs).table(Style::default());
        assert!(table.contains("frequency") && table.contains("17.50") && !table.contains("limit of"), "{table}");
        assert!(table.contains("a name that…n a column"), "{table}");
        let mut slower = slow.clone();
        slower[0].limits[0] = Some(0.5);
        let mut runs = vec![Compared { label: "jerk", result: &one, moves: &slow, noise: Noise::None }; 5];
        runs[1] = Compared { label: "slower", result: &one, moves: &slower, noise: Noise::None };
        let table = Comparison::new(runs).table(Style::default());
        assert!(table.contains("limit of") && table.contains("velocity") && !table.contains("snap"), "{table}");
    }
}
