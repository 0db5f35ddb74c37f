//! All metrics of one run, one to a line.
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};
use servobench_metrics::Quantity;
use servobench_results::{MetricResult, RunResult, printable};

const VALUE: usize = 11;
const USED: usize = 6;

/// All metrics of a run with their limits and the share used, then those of single moves with separate limits,
/// then those that could not be measured, with the reasons.
pub(crate) fn metric_table(run: &RunResult, style: Style) -> String {
    let name = widest(run.metrics.keys().map(String::as_str)).max("METRIC".len());
    let heading = format!("{:name$}  {:>VALUE$}  {:>VALUE$}  {:>USED$}", "METRIC", "VALUE", "LIMIT", "USED");
    let mut table = style.paint(Ink::Heading, &heading) + "\n";
    for (metric_name, metric) in &run.metrics {
        row(&mut table, &format!("{metric_name:name$}"), metric, style);
    }
    for (k, made) in run.moves.iter().enumerate() {
        let is_limited = |metric: &MetricResult| metric.pass.is_some();
        let limited: Vec<_> = made.metrics.iter().filter(|(_, metric)| is_limited(metric)).collect();
        if !limited.is_empty() {
            let heading = format!("limits of move {} ({}):", k + 1, printable(&made.label));
            table += &style.paint(Ink::Heading, &heading);
            table.push('\n');
        }
        for (metric_name, metric) in limited {
            row(&mut table, &format!("{metric_name:name$}"), metric, style);
        }
    }
    for (why, names) in by_reason(run) {
        let text = format!("not measured: {} ({})", names.join(", "), printable(why));
        for (k, part) in wrapped(&text, style.width.saturating_sub(2)).iter().enumerate() {
            let text = format!("{}{}", if k == 0 { "" } else { "  " }, style.paint(Ink::Faint, part));
            table.push_str(&text);
            table.push('\n');
        }
    }
    table
}

/// A row for a metric and its limit; none if it could not be measured.
fn row(table: &mut String, name: &str, metric: &MetricResult, style: Style) {
    let Some(value) = metric.value else { return };
    let missed = metric.pass == Some(false);
    let of_range = metric.limit_min.zip(metric.limit).map_or(3, |(min, max)| Quantity::digits_apart(min, max));
    let digits = if missed { metric.digits(value) } else { 3 }.max(of_range);
    let value_text = format!("{:>VALUE$.digits$}", Quantity::new(value, &metric.unit));
    let value_text = if missed { style.paint(Ink::Bad, &value_text) } else { value_text };
    let text = format!("{name}  {value_text}  {}", limit(metric, value, digits));
    table.push_str(text.trim_end());
    table.push_str(if missed { "  missed\n" } else { "\n" });
}

/// Metrics that could not be measured, grouped by reason.
fn by_reason(run: &RunResult) -> Vec<(&str, Vec<&str>)> {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for (name, why) in &run.absent {
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, names)) => names.push(name),
            None => reasons.push((why, vec![name])),
        }
    }
    reasons
}

/// Limit, and the share of it that is used.
fn limit(metric: &MetricResult, value: f64, digits: usize) -> String {
    let bound = |bound: f64| format!("{:.digits$}", Quantity::new(bound, &metric.unit));
    match (metric.limit_min, metric.limit) {
        (None, None) => String::new(),
        (None, Some(max)) => {
            let used = 100.0 * value.abs() / max;
            let used = if used.is_finite() { format!("{used:.0} %") } else { String::new() };
            format!("{:>VALUE$}  {used:>USED$}", bound(max))
        }
        (Some(min), None) => format!("{:>VALUE$}", format!("≥ {}", bound(min))),
        (Some(min), Some(max)) => {
            let digits = digits.max(Quantity::digits_apart(min, max));
            let bound = |bound: f64| format!("{:.digits$}", Quantity::new(bound, &metric.unit));
            format!("{} to {}", bound(min), bound(max))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::MoveResult;
    use servobench_results::samples;

    #[test]
    fn all_metrics_of_a_run() {
        let table = metric_table(&samples::missed(), Style::default());
        insta::assert_snapshot!(table, @r#"
        METRIC                           VALUE        LIMIT    USED
        move_time                       500 ms
        settling_time                  35.2 ms      20.0 ms   176 %  missed
        following_error_peak_load      45.1 µm      50.0 µm    90 %
        residual_vibration_pp          8.30 µm      2.00 µm   415 %  missed
        not measured: current_peak (`current.d` is not recorded; only a PMSM has a
          current)
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    #[test]
    fn limits_of_a_single_move_stand_below_its_name() {
        let mut run = samples::kept();
        let metrics = samples::missed().metrics;
        run.moves = vec![MoveResult { label: "move from 0 m to 1 m, order 3".into(), start: 0.0, end: 1.3, metrics }];
        let table = metric_table(&run, Style::default());
        let (_, of_move) = table.split_once("limits of move 1 (move from 0 m to 1 m, order 3):\n").unwrap();
        let lines: Vec<_> =
            of_move.lines().take(3).map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        assert_eq!(
            lines,
            [
                "settling_time 35.2 ms 20.0 ms 176 % missed",
                "following_error_peak_load 45.1 µm 50.0 µm 90 %",
                "residual_vibration_pp 8.30 µm 2.00 µm 415 % missed",
            ]
        );
        assert!(!of_move.contains("move_time"), "{table}");
    }
}
