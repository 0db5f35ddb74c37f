//! All metrics of one run, one to a line.
use crate::results::{MetricResult, RunResult};
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};
use servobench_metrics::Quantity;

const VALUE: usize = 11;
const USED: usize = 6;

/// All metrics of a run with their limits and how much of these is used, then what could not be measured and why.
pub(crate) fn metric_table(run: &RunResult, style: Style) -> String {
    let name = widest(run.metrics.iter().map(|(name, _)| name)).max("METRIC".len());
    let heading = format!("{:name$}  {:>VALUE$}  {:>VALUE$}  {:>USED$}", "METRIC", "VALUE", "LIMIT", "USED");
    let mut table = style.paint(Ink::Heading, &heading) + "\n";
    for (metric_name, metric) in run.metrics.iter() {
        let Some(value) = metric.value else { continue };
        let missed = metric.pass == Some(false);
        let digits = if missed { metric.digits(value) } else { 3 };
        let value_text = format!("{:>VALUE$.digits$}", Quantity::new(value, &metric.unit));
        let value_text = if missed { style.paint(Ink::Bad, &value_text) } else { value_text };
        let text = format!("{metric_name:name$}  {value_text}  {}", limit(metric, value, digits));
        table.push_str(text.trim_end());
        table.push_str(if missed { "  missed\n" } else { "\n" });
    }
    for (why, names) in by_reason(run) {
        let text = format!("not measured: {} ({why})", names.join(", "));
        for (k, part) in wrapped(&text, style.width.saturating_sub(2)).iter().enumerate() {
            let text = format!("{}{}", if k == 0 { "" } else { "  " }, style.paint(Ink::Faint, part));
            table.push_str(&text);
            table.push('\n');
        }
    }
    table
}

/// What could not be measured: each reason once, with the metrics that it keeps from being measured.
fn by_reason(run: &RunResult) -> Vec<(&str, Vec<&str>)> {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for (name, why) in run.absent.iter() {
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, names)) => names.push(name),
            None => reasons.push((why, vec![name])),
        }
    }
    reasons
}

/// Bound and share of it that is used.
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
        (Some(min), Some(max)) => format!("{} to {}", bound(min), bound(max)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

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
}
