//! Metrics of a sweep that are reported, and the format of their values.
use super::SweepOptions;
use super::dimension::rounded;
use super::scale::range;
use crate::drawing::unit_at;
use crate::text::elided;
use servobench_metrics::{Name, Quantity};
use servobench_results::printable;
use servobench_sweep::{Column, Table};

/// Metrics that stand for time and for vibration; the first one measured is used.
const TIME: [&str; 3] = ["program_time", Name::MoveAndSettlingTime.as_str(), Name::MoveTime.as_str()];
const VIBRATION: [&str; 2] = [Name::ResidualVibrationAmplitude.as_str(), Name::ResidualVibrationPp.as_str()];

/// Most characters of a unit: enough for `kg·m²/rad`.
const UNIT: usize = 10;

/// Columns of the metrics in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Metrics {
    pub(super) time: Option<usize>,
    pub(super) vibration: Option<usize>,
}

impl Metrics {
    pub(super) fn of(table: &Table<'_>, options: &SweepOptions<'_>) -> Self {
        let named = |name: &str| table.columns.iter().position(|column| column.name == name);
        let first = |names: &[&str]| {
            names.iter().filter_map(|name| named(name)).find(|place| is_measured(&table.columns[*place]))
        };
        let of = |asked: Option<&str>, names| asked.map_or_else(|| first(names), named);
        Self { time: of(options.time, &TIME), vibration: of(options.vibration, &VIBRATION) }
    }

    /// The columns that were measured: time and vibration first, the others in order.
    pub(super) fn in_order(self, table: &Table<'_>) -> Vec<usize> {
        let main = [self.time, self.vibration];
        let others = (0..table.columns.len()).filter(|place| !main.contains(&Some(*place)));
        let all = main.into_iter().flatten().chain(others);
        all.filter(|place| is_measured(&table.columns[*place])).collect()
    }
}

fn is_measured(column: &Column) -> bool {
    column.values.iter().any(|value| value.is_finite())
}

/// Kind of values, and their format.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measure {
    pub(super) name: String,
    unit: String,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A metric (SI).
    Metric,
    /// Fractions of a whole, shown as percent.
    Share,
    /// Values of a key, in the unit of the file.
    Key,
}

impl Measure {
    pub(super) fn of(column: &Column) -> Self {
        Self { name: printable(&column.name), unit: elided(&printable(&column.unit), UNIT), kind: Kind::Metric }
    }

    /// The share of runs that keep all limits.
    pub(super) fn share() -> Self {
        Self { name: "runs that keep all limits".into(), unit: String::new(), kind: Kind::Share }
    }

    /// Values of a key, in the unit of the file.
    pub(super) fn key(unit: &str) -> Self {
        Self { name: String::new(), unit: unit.to_owned(), kind: Kind::Key }
    }

    pub(super) const fn is_share(&self) -> bool {
        matches!(self.kind, Kind::Share)
    }

    /// A value in engineering notation.
    pub(super) fn text(&self, value: f64) -> String {
        match self.kind {
            Kind::Metric if value.is_infinite() => "never".to_owned(),
            Kind::Share => percent(value),
            Kind::Key => format!("{} {}", rounded(value, 4), self.unit).trim_end().to_owned(),
            Kind::Metric => Quantity::new(value, &self.unit).to_string(),
        }
    }

    /// Values with enough digits to distinguish the smallest from the largest.
    pub(super) fn texts_apart<const N: usize>(&self, values: [f64; N]) -> [String; N] {
        let (low, high) = range(values).unwrap_or_default();
        let digits = Quantity::digits_apart(low, high);
        values.map(|value| match self.kind {
            Kind::Metric if value.is_infinite() => "never".to_owned(),
            Kind::Metric if value.is_nan() => "–".to_owned(),
            Kind::Metric => format!("{:.digits$}", Quantity::new(value, &self.unit)),
            Kind::Share | Kind::Key => self.text(value),
        })
    }

    /// A round value at a logarithmic axis. A metric has its unit with it, because its prefix changes along the axis.
    pub(super) fn round_text(&self, value: f64) -> String {
        match self.kind {
            Kind::Share => percent(value),
            Kind::Key => rounded(value, 2),
            Kind::Metric => format!("{:.1}", Quantity::new(value, &self.unit)),
        }
    }

    /// The unit that is not written with the values of a logarithmic axis.
    pub(super) fn unit_of_log(&self) -> String {
        if self.kind == Kind::Key { self.unit.clone() } else { String::new() }
    }

    /// Unit of an axis up to `largest`, and its size in plain units.
    pub(super) fn axis_unit(&self, largest: f64) -> (String, f64) {
        match self.kind {
            Kind::Share => ("%".into(), 0.01),
            Kind::Key => power_of_ten(largest, &self.unit, false),
            Kind::Metric => power_of_ten(largest, &self.unit, true),
        }
    }

    /// Name and unit, as title of an axis.
    pub(super) fn titled(&self, unit: &str) -> String {
        if unit.is_empty() { self.name.clone() } else { format!("{} ({unit})", self.name) }
    }
}

/// The unit of an axis up to `largest`: with a power of ten for numbers that no prefix makes short.
fn power_of_ten(largest: f64, unit: &str, takes_prefix: bool) -> (String, f64) {
    let (symbol, scale) = unit_at(largest, unit, takes_prefix);
    let shown = largest / scale;
    if !(shown > 0.0 && shown < 1e-3) {
        return (symbol, scale);
    }
    let exponent: i32 = format!("{shown:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    // Smaller powers are not normal numbers.
    let exponent = (exponent.div_euclid(3) * 3).max(-300);
    let digit = |c: char| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][c.to_digit(10).unwrap_or(0) as usize];
    let raised: String = exponent.unsigned_abs().to_string().chars().map(digit).collect();
    let power: f64 = format!("1e{exponent}").parse().unwrap_or(1.0);
    (format!("×10⁻{raised} {symbol}").trim_end().to_owned(), scale * power)
}

/// A share in percent, to a tenth, beyond 99 % to a hundredth: less than all is never shown as 100 %.
pub(super) fn percent(share: f64) -> String {
    in_percent(share, f64::round)
}

/// A lower bound of a share, rounded down.
pub(super) fn at_least(share: f64) -> String {
    in_percent(share, f64::floor)
}

fn in_percent(share: f64, round: fn(f64) -> f64) -> String {
    let percent = 100.0 * share;
    let (decimals, steps) = if percent > 99.0 { (2, 100.0) } else { (1, 10.0) };
    // For 29 % the product is 28.999999999999996.
    let shown = round(percent * steps + 1e-9) / steps;
    match share {
        _ if !share.is_finite() => "–".to_owned(),
        _ if share <= 0.0 || share >= 1.0 => format!("{percent:.0} %"),
        _ if shown >= 100.0 => "> 99.99 %".to_owned(),
        _ if shown <= 0.0 => "< 0.1 %".to_owned(),
        _ => format!("{shown:.decimals$} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_all_is_not_100_percent() {
        for (share, text) in [
            (1.0, "100 %"),
            (0.99701, "99.70 %"),
            (0.999_999, "> 99.99 %"),
            (0.9567, "95.7 %"),
            (0.29, "29.0 %"),
            (0.0432, "4.3 %"),
            (1e-5, "< 0.1 %"),
            (0.0, "0 %"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(percent(share), text);
        }
        assert_eq!(
            (at_least(0.9567), at_least(0.29), at_least(0.999_999)),
            ("95.6 %".into(), "29.0 %".into(), "99.99 %".into())
        );
    }

    #[test]
    fn numbers_without_a_prefix_are_short_too() {
        assert_eq!(power_of_ten(2e-7, "", true), ("×10⁻⁹".into(), 1e-9));
        assert_eq!(power_of_ten(3e-301, "m", true).0, "×10⁻³⁰⁰ m");
        assert_eq!(power_of_ten(0.25, "m", true), ("mm".into(), 1e-3));
    }
}
