//! The table of compared runs.
use super::relation::{Relation, percent};
use super::{Compared, Comparison, Standing, Value, force_or_torque};
use crate::style::{Ink, Style};
use crate::text::{elided, widest};
use servobench_metrics::{Name, Quantity};
use servobench_results::Outcome;

/// Kind of quantity in a row, which decides its last column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A duration: difference and per cent.
    Time,
    /// A size: ratio.
    Size,
    /// A property of the axis: neither better nor worse.
    Property,
    /// A limit that a set-point was planned with: listed when the runs differ in it.
    Limit,
}

/// Limits of the set-points, and the powers of the second in their units.
pub(super) const LIMITS: [(&str, &str); 4] =
    [("limit of velocity", ""), ("limit of acceleration", "²"), ("limit of jerk", "³"), ("limit of snap", "⁴")];

pub(super) const ROWS: [(&str, Name, Kind); 13] = [
    ("move", Name::MoveTime, Kind::Time),
    ("move + settling", Name::MoveAndSettlingTime, Kind::Time),
    ("peak following error, load", Name::FollowingErrorPeakLoad, Kind::Size),
    ("peak following error, motor", Name::FollowingErrorPeakMotor, Kind::Size),
    ("residual vibration, p-p", Name::ResidualVibrationPp, Kind::Size),
    ("  amplitude of the mode", Name::ResidualVibrationAmplitude, Kind::Size),
    ("  its frequency", Name::ResidualVibrationFrequency, Kind::Property),
    ("  its damping ratio", Name::ResidualVibrationDamping, Kind::Property),
    ("peak effort", Name::TorquePeak, Kind::Size),
    ("RMS effort", Name::TorqueRms, Kind::Size),
    ("RMS current", Name::CurrentRms, Kind::Size),
    ("electrical energy", Name::ElectricalEnergy, Kind::Size),
    ("copper loss", Name::CopperLoss, Kind::Size),
];

/// Most runs that are shown as columns; with more, runs are rows, so that the table stays within 80 columns.
pub(super) const MOST_COLUMNS: usize = 4;

/// All quantities that are compared.
pub(super) fn compared() -> impl Iterator<Item = Name> {
    ROWS.into_iter().map(|(_, name, _)| name)
}

const CELL: usize = 11;
/// Width of `  +50.0 ms, +3.8 %`.
const CHANGE: usize = 18;

impl<'a> Comparison<'a> {
    /// One row for each quantity that any run has; with two runs a column compares the second with the first,
    /// with more an asterisk marks the smallest. With more than four runs each run is a row.
    #[must_use]
    pub fn table(&self, style: Style) -> String {
        if self.runs.len() > MOST_COLUMNS {
            return self.table_by_run(style);
        }
        let name = widest(ROWS.iter().map(|(label, ..)| *label));
        let room = style.width.saturating_sub(name + CHANGE) / self.runs.len().max(1);
        let cell = widest(self.runs.iter().map(|run| run.label)).min(room.saturating_sub(2)).max(CELL);
        let labels: Vec<_> = self.runs.iter().map(|run| format!("  {:>cell$}", elided(run.label, cell))).collect();
        let change = if self.runs.len() == 2 { "  change" } else { "" };
        let mut table = style.paint(Ink::Heading, &format!("{:name$}{}{change}", "", labels.concat())) + "\n";
        for (k, (label, power)) in LIMITS.into_iter().enumerate() {
            let unit = format!("{}/s{power}", self.axis_unit());
            let values: Vec<_> = self.runs.iter().map(|run| Some((run.limit(k)?, unit.as_str()))).collect();
            row(&mut table, &format!("{label:name$}"), cell, (Kind::Limit, &Ranks::default()), &values);
        }
        for (label, metric, kind) in ROWS {
            let values: Vec<_> = self.runs.iter().map(|run| run.metric(metric)).collect();
            let ranks = self.ranks(metric, kind);
            row(&mut table, &format!("{:name$}", effort_word(label, &values)), cell, (kind, &ranks), &values);
            if let Some((values, ranks)) = self.program().filter(|_| metric == Name::MoveAndSettlingTime) {
                row(&mut table, &format!("{PROGRAM:name$}"), cell, (Kind::Time, &ranks), &values);
            }
        }
        if self.has_out() {
            let words = self.runs.iter().map(|run| format!("  {:>cell$}", verdict(run)));
            table += &style.paint(Ink::Warning, &format!("{:name$}{}", "verdict", words.collect::<String>()));
            table.push('\n');
        }
        if self.runs.len() > 2 {
            table += &style.paint(Ink::Faint, SMALLEST);
            table.push('\n');
        }
        table
    }

    /// True if a run is out.
    pub(super) fn has_out(&self) -> bool {
        self.runs.iter().any(|run| !Self::is_in(run))
    }

    /// Time at which each program is done, and the ranks in it; `None` if every program is a single move.
    pub(super) fn program(&self) -> Option<(Vec<Option<Value<'a>>>, Ranks)> {
        if self.runs.iter().all(Compared::is_one_move) {
            return None;
        }
        let values = self.runs.iter().map(Compared::arrival).collect();
        Some((values, self.ranks_by(Compared::arrival, |one, other| self.arrival(one, other), self.runs.len() > 2)))
    }

    /// Ranks of the runs in `metric`. Runs that are out have no rank; two runs of which one is broken are not compared.
    pub(super) fn ranks(&self, metric: Name, kind: Kind) -> Ranks {
        let is_ranked = self.runs.len() > 2 && matches!(kind, Kind::Time | Kind::Size);
        self.ranks_by(|run| run.metric(metric), |one, other| self.relation(metric, one, other), is_ranked)
    }

    fn ranks_by(
        &self,
        value: impl Fn(&Compared<'a>) -> Option<Value<'a>>,
        relation: impl Fn(&Compared<'a>, &Compared<'a>) -> Option<Relation>,
        is_ranked: bool,
    ) -> Ranks {
        let is_less = |one: &Compared<'a>, other: &Compared<'a>| {
            relation(one, other).is_none_or(|relation| matches!(relation, Relation::Less(_)))
        };
        let runs = || self.runs.iter().enumerate().filter(|(_, run)| Self::is_in(run));
        let smallest =
            runs().find(|(k, one)| value(one).is_some() && runs().all(|(other, two)| other == *k || is_less(one, two)));
        let smallest = smallest.map(|(k, _)| k).filter(|_| is_ranked);
        let change = match self.runs.as_slice() {
            [one, two] if [one, two].iter().all(|run| run.standing() < Standing::Broken) => relation(two, one),
            _ => None,
        };
        Ranks { smallest, change }
    }

    /// Unit of the axis, taken from the residual vibration.
    pub(super) fn axis_unit(&self) -> &str {
        let unit = self.runs.iter().find_map(|run| run.metric(Name::ResidualVibrationPp));
        unit.map_or("m", |(_, unit)| unit)
    }
}

/// Ranks of the runs in one quantity.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ranks {
    /// The run with a smaller value than each of the others.
    pub(super) smallest: Option<usize>,
    /// Relation of the second of two runs to the first.
    change: Option<Relation>,
}

/// Label of the time at which the last target is reached for good.
pub(super) const PROGRAM: &str = "program done";

/// Meaning of an asterisk.
pub(super) const SMALLEST: &str = "* smallest, by more than what counts as equal";

/// The verdict of a run, in a word.
pub(super) fn verdict(run: &Compared<'_>) -> &'static str {
    match (run.standing(), run.result.verdict) {
        (Standing::In, Outcome::Passed) => "passed",
        (Standing::In, _) => "unjudged",
        (Standing::Missed | Standing::Broken, _) => "out",
    }
}

/// Largest finite magnitude.
pub(super) fn largest(values: &[Option<Value<'_>>]) -> f64 {
    let sizes = values.iter().flatten().map(|(value, _)| value.abs()).filter(|size| size.is_finite());
    sizes.fold(0.0, f64::max)
}

/// A row of one quantity, if any run has it: all values with one prefix, with two runs their relation.
fn row(table: &mut String, label: &str, cell: usize, (kind, ranks): (Kind, &Ranks), values: &[Option<Value<'_>>]) {
    if values.iter().all(Option::is_none) {
        return;
    }
    let largest = largest(values);
    let cells = values.iter().enumerate().map(|(k, value)| {
        let text = value.map_or("–".into(), |(number, unit)| shown(kind, Quantity::new(number, unit), largest));
        let mark = if ranks.smallest == Some(k) { "*" } else { "" };
        format!("  {:>cell$}", format!("{mark}{text}"))
    });
    let change = match values {
        [Some(one), Some(two)] => format!("  {}", beside((kind, ranks), *one, *two)),
        _ => String::new(),
    };
    *table += format!("{label}{}{change}", cells.collect::<String>()).trim_end();
    table.push('\n');
}

/// Value with enough digits; properties of the axis have more, because they distinguish modes.
fn shown(kind: Kind, quantity: Quantity<'_>, largest: f64) -> String {
    if quantity.value.is_infinite() {
        return "never".to_owned();
    }
    if kind == Kind::Property { format!("{quantity:.4}") } else { quantity.beside(largest) }
}

/// `label` with "effort" replaced by force or torque, according to the unit.
pub(super) fn effort_word(label: &str, values: &[Option<Value<'_>>]) -> String {
    let unit = values.iter().flatten().map(|(_, unit)| *unit).next().unwrap_or_default();
    label.replace("effort", force_or_torque(unit))
}

fn beside((kind, ranks): (Kind, &Ranks), one: Value<'_>, two: Value<'_>) -> String {
    match kind {
        _ if one.1 != two.1 => "other unit".into(),
        Kind::Property => String::new(),
        Kind::Limit if one.0.to_bits() == two.0.to_bits() => String::new(),
        Kind::Limit => "differs".into(),
        Kind::Size | Kind::Time => match ranks.change {
            None => String::new(),
            Some(Relation::Less(_) | Relation::More(_)) if !(one.0.is_finite() && two.0.is_finite()) => String::new(),
            Some(relation @ (Relation::Less(_) | Relation::More(_))) if kind == Kind::Time => {
                let sign = if relation.is_more() { "+" } else { "-" };
                let difference = Quantity::new((two.0 - one.0).abs(), one.1);
                format!("{sign}{difference}, {sign}{:.2} %", percent(one.0, two.0))
            }
            Some(relation) => relation.to_string(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Compared, Noise};
    use servobench_results::samples::{jerk, lambrechts_move, of_numbers, snap};

    #[test]
    fn table_of_two() {
        let (jerk, snap) = (jerk(), snap());
        let runs = vec![
            Compared { label: "jerk", result: &jerk, moves: &[], noise: Noise::None },
            Compared { label: "snap", result: &snap, moves: &[], noise: Noise::None },
        ];
        let table = Comparison::new(runs).table(Style::default());
        insta::assert_snapshot!(table, @r#"
                                            jerk         snap  change
        move                              1.30 s       1.35 s  +50.0 ms, +3.8 %
        move + settling                   1.30 s       1.35 s  +46.0 ms, +3.5 %
        peak following error, load       3.10 µm     0.730 µm  4.2 × less
        residual vibration, p-p          3.40 µm     0.210 µm  16 × less
          amplitude of the mode          1.70 µm     0.105 µm  16 × less
          its frequency                 38.98 Hz     38.98 Hz
          its damping ratio             0.002100     0.002100
        peak force                         170 N        169 N  same
        RMS force                         61.2 N       60.0 N  2.0 % less
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    /// 0.98 N beside 1.01 kN would hide which is larger.
    #[test]
    fn a_row_has_one_prefix_and_limits_stand_above() {
        let one = of_numbers("one", [0.98, 0.1, 3e-6, 980e-9, 39.0, 0.002, 170.0, 60.0]);
        let two = of_numbers("two", [1.01, 0.1, 3e-6, 1.4e-6, 39.0, 0.002, 1200.0, 60.0]);
        let (third, mut fourth) = ([lambrechts_move(3)], [lambrechts_move(4)]);
        fourth[0].limits[0] = Some(0.5);
        let runs = vec![
            Compared { label: "one", result: &one, moves: &third, noise: Noise::None },
            Compared { label: "two", result: &two, moves: &fourth, noise: Noise::None },
        ];
        let table = Comparison::new(runs).table(Style::default());
        let row = |name: &str| {
            let row = table.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_else(|| panic!("{table}"));
            row.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(row("limit of velocity"), "1.00 m/s 0.500 m/s differs");
        assert_eq!(row("limit of jerk"), "50.0 m/s³ 50.0 m/s³");
        assert_eq!(row("limit of snap"), "– 1000 m/s⁴");
        assert_eq!(row("move "), "0.980 s 1.01 s +30.0 ms, +3.1 %");
        assert_eq!(row("residual vibration, p-p"), "0.980 µm 1.40 µm 43 % more");
        assert_eq!(row("peak force"), "0.170 kN 1.20 kN 7.1 × as much");
    }

    #[test]
    fn of_three_the_smallest_is_marked() {
        let (jerk, snap) = (jerk(), snap());
        let trapezoid = of_numbers("trapezoid", [1.2, 0.3, 90e-6, 41e-6, 38.985, 0.0021, 190.0, 60.3]);
        let runs = vec![
            Compared { label: "trapezoid", result: &trapezoid, moves: &[], noise: Noise::None },
            Compared { label: "jerk", result: &jerk, moves: &[], noise: Noise::None },
            Compared { label: "snap", result: &snap, moves: &[], noise: Noise::None },
        ];
        let comparison = Comparison::new(runs);
        insta::assert_snapshot!(comparison.table(Style::default()), @r#"
                                       trapezoid         jerk         snap
        move                             *1.20 s       1.30 s       1.35 s
        move + settling                   1.50 s      *1.30 s       1.35 s
        peak following error, load       90.0 µm      3.10 µm    *0.730 µm
        residual vibration, p-p          41.0 µm      3.40 µm    *0.210 µm
          amplitude of the mode          20.5 µm      1.70 µm    *0.105 µm
          its frequency                 38.98 Hz     38.98 Hz     38.98 Hz
          its damping ratio             0.002100     0.002100     0.002100
        peak force                         190 N        170 N        169 N
        RMS force                         60.3 N       61.2 N       60.0 N
        * smallest, by more than what counts as equal
        "#);
    }
}
