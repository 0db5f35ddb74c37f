//! Round numbers along an axis.
use servobench_metrics::{round_above, round_below};

/// Multiples of `step` from `low` to `high`, each with its label.
pub(crate) fn ticks(low: f64, high: f64, step: f64) -> Vec<(f64, String)> {
    let exponent: i32 = format!("{step:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let mut ticks = Vec::new();
    let mut k = first;
    while k <= last && ticks.len() < 100 {
        let value = k * step;
        // A minus sign before zero looks like a mistake.
        let value = if k == 0.0 { 0.0 } else { value };
        ticks.push((value, format!("{value:.decimals$}")));
        k += 1.0;
    }
    ticks
}

/// About four ticks from `low` to `high`. Where their round step leaves a single one, a finer step leaves at least three.
pub(crate) fn about_four(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    let few = ticks(low, high, round_above(span / 4.0));
    if few.len() > 1 { few } else { ticks(low, high, round_below(span / 3.0)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_as_many_decimals_as_the_step() {
        let labels = |low, high, step| ticks(low, high, step).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels(-0.5, 0.9, 0.5), ["-0.5", "0.0", "0.5"]);
        assert_eq!(labels(0.0, 0.6, 0.2), ["0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(-1000.0, 1000.0, 500.0), ["-1000", "-500", "0", "500", "1000"]);
    }
}
