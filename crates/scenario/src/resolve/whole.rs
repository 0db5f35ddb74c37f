//! Times that must be whole multiples of a shorter unit: base ticks, bus cycles.
use crate::diagnostic::Report;
use crate::source::At;
use servobench_base::Rate;

/// Number of `units`, of which there are `per_second`, in the `time` of `key`: a whole number, at least one.
///
/// # Errors
/// The mistake, and the nearest time that fits.
pub(super) fn number(key: &str, time: f64, per_second: f64, units: &str) -> Result<f64, (String, String)> {
    let number = time * per_second;
    if number.round() >= 1.0 && (number - number.round()).abs() <= 1e-9 * number {
        return Ok(number.round());
    }
    let near = number.round().max(1.0) * (1e6 / per_second);
    Err((format!("`{key}` is {number:.4} {units}, not a whole number"), format!("{near} us fits")))
}

/// A time in base ticks.
pub(super) fn ticks(key: &str, time: At<f64>, base_rate: Option<Rate>, report: &mut Report) -> Option<u32> {
    count(key, time, f64::from(base_rate?.hertz()), "base ticks", report)
}

/// A time in cycles of a bus, each of `cycle` base ticks.
pub(super) fn cycles(
    key: &str,
    time: At<f64>,
    cycle: Option<u32>,
    base_rate: Option<Rate>,
    report: &mut Report,
) -> Option<u32> {
    count(key, time, f64::from(base_rate?.hertz()) / f64::from(cycle?), "bus cycles", report)
}

fn count(key: &str, time: At<f64>, per_second: f64, units: &str, report: &mut Report) -> Option<u32> {
    match number(key, time.value, per_second, units) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and in the range")]
        Ok(number) if number <= f64::from(u32::MAX) => Some(number as u32),
        Ok(number) => {
            let message = format!("`{key}` is {number} {units}, more than {}", u32::MAX);
            report.error(time.span, message, "make it shorter");
            None
        }
        Err((message, help)) => {
            report.error(time.span, message, help);
            None
        }
    }
}
