//! The table.
use super::relation::{Relation, percent};
use super::{Comparison, Value, force_or_torque};
use crate::style::{Ink, Style};
use crate::text::{elided, widest};
use servobench_metrics::{Name, Quantity};

/// How the last column of a row reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A duration: difference and per cent.
    Time,
    /// A size: ratio.
    Size,
    /// A property of the axis: no better or worse.
    Property,
}

const ROWS: [(&str, Name, Kind); 11] = [
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
];

const CELL: usize = 11;
/// `  +50.0 ms, +3.8 %` fits.
const CHANGE: usize = 18;

impl Comparison<'_> {
    /// One row for each quantity that any run has; with two runs a column says how the second stands to the first,
    /// with more an asterisk marks the smallest.
    #[must_use]
    pub fn table(&self, style: Style) -> String {
        let name = widest(ROWS.iter().map(|(label, ..)| *label));
        let room = style.width.saturating_sub(name + CHANGE) / self.runs.len().max(1);
        let cell = widest(self.runs.iter().map(|run| run.label)).min(room.saturating_sub(2)).max(CELL);
        let labels: Vec<_> = self.runs.iter().map(|run| format!("  {:>cell$}", elided(run.label, cell))).collect();
        let change = if self.runs.len() == 2 { "  change" } else { "" };
        let mut table = style.paint(Ink::Heading, &format!("{:name$}{}{change}", "", labels.concat())) + "\n";
        for (label, metric, kind) in ROWS {
            let values: Vec<_> = self.runs.iter().map(|run| run.result.metric(metric)).collect();
            if values.iter().all(Option::is_none) {
                continue;
            }
            let mark = |value| {
                if values.len() > 2 && kind != Kind::Property && is_smallest(value, &values) { "*" } else { "" }
            };
            let cells = values.iter().map(|value| match *value {
                Some((number, unit)) => {
                    format!("  {:>cell$}", format!("{}{}", mark(*value), shown(kind, number, unit)))
                }
                None => format!("  {:>cell$}", "–"),
            });
            let change = match values.as_slice() {
                [Some(one), Some(two)] => format!("  {}", beside(kind, *one, *two)),
                _ => String::new(),
            };
            let row = format!("{:name$}{}{change}", effort_word(label, &values), cells.collect::<Vec<_>>().concat());
            table += row.trim_end();
            table.push('\n');
        }
        if self.runs.len() > 2 {
            table += &style.paint(Ink::Faint, "* smallest, by more than 1 %");
            table.push('\n');
        }
        table
    }
}

/// Properties of the axis with more digits: they tell modes apart.
fn shown(kind: Kind, value: f64, unit: &str) -> String {
    let quantity = Quantity::new(value, unit);
    if kind == Kind::Property { format!("{quantity:.4}") } else { quantity.to_string() }
}

/// "effort" is a force or a torque, as the unit says.
fn effort_word(label: &str, values: &[Option<Value<'_>>]) -> String {
    let unit = values.iter().flatten().map(|(_, unit)| *unit).next().unwrap_or_default();
    label.replace("effort", force_or_torque(unit))
}

/// Whether `value` is smaller than all others by more than 1 %.
fn is_smallest(value: Option<Value<'_>>, all: &[Option<Value<'_>>]) -> bool {
    let Some((value, _)) = value else { return false };
    let not_smaller = all.iter().flatten().filter(|(other, _)| !(Relation::of(value, *other).is_more())).count();
    not_smaller == 1
}

fn beside(kind: Kind, one: Value<'_>, two: Value<'_>) -> String {
    match kind {
        Kind::Property => String::new(),
        Kind::Size => Relation::of(one.0, two.0).to_string(),
        Kind::Time if Relation::of(one.0, two.0) == Relation::Same => "same".into(),
        Kind::Time => {
            let sign = if two.0 > one.0 { "+" } else { "-" };
            let difference = Quantity::new((two.0 - one.0).abs(), one.1);
            format!("{sign}{difference}, {sign}{:.2} %", percent(one.0, two.0))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Compared;
    use crate::samples::{jerk, of_numbers, snap};

    #[test]
    fn table_of_two() {
        let (jerk, snap) = (jerk(), snap());
        let runs = vec![Compared { label: "jerk", result: &jerk }, Compared { label: "snap", result: &snap }];
        let table = Comparison::new(runs).table(Style::default());
        insta::assert_snapshot!(table, @r#"
                                            jerk         snap  change
        move                              1.30 s       1.35 s  +50.0 ms, +3.8 %
        move + settling                   1.30 s       1.35 s  +46.0 ms, +3.5 %
        peak following error, load       3.10 µm       730 nm  4.2 × less
        residual vibration, p-p          3.40 µm       210 nm  16 × less
          amplitude of the mode          1.70 µm       105 nm  16 × less
          its frequency                 38.98 Hz     38.98 Hz
          its damping ratio             0.002100     0.002100
        peak force                         170 N        169 N  same
        RMS force                         61.2 N       60.0 N  2.0 % less
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    #[test]
    fn of_three_the_smallest_is_marked() {
        let (jerk, snap) = (jerk(), snap());
        let trapezoid = of_numbers("trapezoid", [1.2, 0.3, 90e-6, 41e-6, 38.985, 0.0021, 190.0, 60.3]);
        let runs = vec![
            Compared { label: "trapezoid", result: &trapezoid },
            Compared { label: "jerk", result: &jerk },
            Compared { label: "snap", result: &snap },
        ];
        let comparison = Comparison::new(runs);
        insta::assert_snapshot!(comparison.table(Style::default()), @r#"
                                       trapezoid         jerk         snap
        move                             *1.20 s       1.30 s       1.35 s
        move + settling                   1.50 s      *1.30 s       1.35 s
        peak following error, load       90.0 µm      3.10 µm      *730 nm
        residual vibration, p-p          41.0 µm      3.40 µm      *210 nm
          amplitude of the mode          20.5 µm      1.70 µm      *105 nm
          its frequency                 38.98 Hz     38.98 Hz     38.98 Hz
          its damping ratio             0.002100     0.002100     0.002100
        peak force                         190 N        170 N        169 N
        RMS force                         60.3 N       61.2 N       60.0 N
        * smallest, by more than 1 %
        "#);
    }
}
