//! All metrics of one run, one to a line.
use crate::results::{MetricResult, RunResult};
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};
use servobench_metrics::Quantity;

const VALUE: usize = 11;
const USED: usize = 6;

/// All metrics of a run with their limits and how much of these is used, then what could not be measured and why.
pub(crate) fn metric_table(run: &RunResult, style: Style) -> String {
    let names = run.metrics.iter().map(|(name, _)| name).chain(run.absent.iter().map(|(name, _)| name));
    let name = widest(names).max("METRIC".len());
    let heading = format!("{:name$}  {:>VALUE$}  {:>VALUE$}  {:>USED$}", "METRIC", "VALUE", "LIMIT", "USED");
    let mut table = style.paint(Ink::Heading, &heading) + "\n";
    for (metric_name, metric) in run.metrics.iter() {
        let Some(value) = metric.value else { continue };
        let value_text = format!("{:>VALUE$}", Quantity::new(value, &metric.unit));
        let missed = metric.pass == Some(false);
        let value_text = if missed { style.paint(Ink::Bad, &value_text) } else { value_text };
        let text = format!("{metric_name:name$}  {value_text}  {}", limit(metric, value));
        table.push_str(text.trim_end());
        table.push_str(if missed { "  missed\n" } else { "\n" });
    }
    for (metric_name, why) in run.absent.iter() {
        let parts = wrapped(why, style.width.saturating_sub(name + 2 + 2 + VALUE));
        for (k, part) in parts.iter().enumerate() {
            let (label, dash) = if k == 0 { (metric_name, "–") } else { ("", "") };
            let text = format!("{label:name$}  {dash:>VALUE$}  {}", style.paint(Ink::Faint, part));
            table.push_str(text.trim_end());
            table.push('\n');
        }
    }
    table
}

/// Bound and share of it that is used.
fn limit(metric: &MetricResult, value: f64) -> String {
    let bound = |bound: f64| Quantity::new(bound, &metric.unit).to_string();
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
        current_peak                         –  the recording has no channel `current.d`
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }
}
