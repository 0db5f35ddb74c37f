//! Round numbers along an axis.

/// Distance of round ticks (1, 2 or 5 times a power of ten) such that at most `count` fit in `span`.
pub(super) fn step(span: f64, count: f64) -> f64 {
    let wanted = span / count;
    let exponent: i32 = format!("{wanted:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let power = |exponent: i32| format!("1e{exponent}").parse::<f64>().unwrap_or(1.0);
    // Rounding must not make a step of 0.2 fit one tick more or less.
    let candidates = [power(exponent), 2.0 * power(exponent), 5.0 * power(exponent), power(exponent + 1)];
    candidates.into_iter().find(|step| *step >= wanted * (1.0 - 1e-9)).unwrap_or(wanted)
}

/// Multiples of `step` from `low` to `high`, each with its label.
pub(super) fn ticks(low: f64, high: f64, step: f64) -> Vec<(f64, String)> {
    let exponent: i32 = format!("{step:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let mut ticks = Vec::new();
    let mut k = first;
    while k <= last && ticks.len() < 100 {
        let value = k * step;
        // A minus sign before zero reads as a mistake.
        let value = if k == 0.0 { 0.0 } else { value };
        ticks.push((value, format!("{value:.decimals$}")));
        k += 1.0;
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (span, count, round) in [(1.35, 8.0, 0.2), (1.0, 4.0, 0.5), (2.2, 4.0, 1.0), (2e-7, 4.0, 5e-8)] {
            assert!((step(span, count) / round - 1.0).abs() < 1e-12, "{span}");
        }
    }

    #[test]
    fn labels_have_as_many_decimals_as_the_step() {
        let labels = |low, high, step| ticks(low, high, step).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels(-0.5, 0.5, 0.25), ["-0.5", "-0.2", "0.0", "0.2", "0.5"]);
        assert_eq!(labels(0.0, 0.6, 0.2), ["0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(-1000.0, 1000.0, 500.0), ["-1000", "-500", "0", "500", "1000"]);
    }
}
