//! Reasons why a run failed: each missed limit and by how much, broken requirements, missing faults.
use indexmap::IndexMap;
use servobench_metrics::{Name, Quantity, Standing};
use servobench_results::{MetricResult, RunResult};

/// A limit that is missed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MissedLimit<'a> {
    /// Index and label of the move that missed the limit; `None` for the run as a whole.
    pub(crate) of_move: Option<(usize, &'a str)>,
    /// Name of the metric.
    pub(crate) name: &'a str,
    /// Value of the metric, if it was measured.
    pub(crate) value: Option<String>,
    /// The limit and the excess over it, or the reason for a missing value.
    pub(crate) words: String,
    /// Line of the scenario file.
    pub(crate) line: Option<usize>,
}

/// Most reasons listed for one requirement; the others are counted.
const MOST: usize = 5;

/// All missed limits, those of the run before those of its moves.
pub(crate) fn missed_limits(run: &RunResult) -> Vec<MissedLimit<'_>> {
    let all = run.moves.iter().enumerate().map(|(k, made)| (Some((k, made.label.as_str())), &made.metrics));
    let all = std::iter::once((None, &run.metrics)).chain(all);
    all.flat_map(|(of_move, metrics)| {
        let missed = metrics.iter().filter(|(_, metric)| metric.is_missed());
        missed.map(move |(name, metric)| missed_limit(of_move, name, metric, &run.absent))
    })
    .collect()
}

fn missed_limit<'a>(
    of_move: Option<(usize, &'a str)>,
    name: &'a str,
    metric: &MetricResult,
    absent: &IndexMap<String, String>,
) -> MissedLimit<'a> {
    let (value, words) = if let Some(value) = metric.value {
        let digits = metric.digits(value);
        (Some(format!("{:.digits$}", Quantity::new(value, &metric.unit))), bound(name, metric, value))
    } else {
        let why = absent.get(name).map_or("it is not measured here", String::as_str);
        (None, format!("could not be measured: {why}"))
    };
    MissedLimit { of_move, name, value, words, line: metric.line }
}

/// Failures besides limits: broken requirements and expected faults that did not occur.
pub(crate) fn other_failures(run: &RunResult) -> Vec<String> {
    let broken = run.requirements_that_are(Standing::Broken).flat_map(|(name, reasons)| {
        let more = reasons.len().saturating_sub(MOST);
        let more = (more > 0).then(|| format!("{name}: and {more} more"));
        reasons.iter().take(MOST).map(move |why| format!("{name}: {why}")).chain(more)
    });
    let missing = run.expected.iter().filter(|expected| expected.met_at.is_none());
    broken.chain(missing.map(|expected| format!("expected, but did not occur: {}", expected.words()))).collect()
}

/// Everything that is lifted: in one sentence the requirements that would hold, each that would not with its reason, then calls with
/// `optional` and expected faults without an end of their time.
pub(crate) fn lifted(run: &RunResult) -> Vec<String> {
    let all = || run.requirements_that_are(Standing::Lifted);
    let kept: Vec<&str> = all().filter(|(_, reasons)| reasons.is_empty()).map(|(name, _)| name).collect();
    let kept = (!kept.is_empty()).then(|| format!("lifted: {}", kept.join(", ")));
    let broken = all().filter_map(|(name, reasons)| {
        let first = reasons.first()?;
        let more = if reasons.len() > 1 { format!(" (and {} more)", reasons.len() - 1) } else { String::new() };
        Some(format!("lifted: {name}: {first}{more}"))
    });
    let optional: Vec<String> = run.optional_calls.iter().map(|name| format!("`{name}`")).collect();
    let optional = (!optional.is_empty()).then(|| format!("lifted: optional calls: {}", optional.join(", ")));
    let open = run.open_expectations().map(|expected| {
        let words = expected.words();
        if expected.from > 0.0 { words } else { format!("{words} at any time") }
    });
    let open: Vec<String> = open.collect();
    let open = (!open.is_empty()).then(|| format!("lifted: {}", open.join(", ")));
    broken.chain(kept).chain(optional).chain(open).collect()
}

impl MissedLimit<'_> {
    /// The limit in one line: `settling_time 35.2 ms, limit 20.0 ms, 76 % over`.
    pub(crate) fn sentence(&self) -> String {
        let Self { of_move, name, value, words, .. } = self;
        let of_move = of_move.map(|(index, _)| format!("move {}: ", index + 1)).unwrap_or_default();
        match value {
            Some(value) => format!("{of_move}{name} {value}, {words}"),
            None => format!("{of_move}{name} {words}"),
        }
    }
}

/// `limit 20.0 ms, 76 % over`
fn bound(name: &str, metric: &MetricResult, value: f64) -> String {
    let digits = metric.digits(value);
    let bound = |bound: f64| format!("{:.digits$}", Quantity::new(bound, &metric.unit));
    let size = if name.parse::<Name>().is_ok_and(Name::is_signed) { value.abs() } else { value };
    let below = metric.limit_min.filter(|min| size < *min);
    let (words, limit) = match (below, metric.limit) {
        (Some(min), _) => (format!("limit at least {}", bound(min)), min),
        (None, Some(max)) => (format!("limit {}", bound(max)), max),
        (None, None) => return String::new(),
    };
    let share = 100.0 * (size / limit - 1.0);
    match share {
        _ if limit <= 0.0 || !share.is_finite() => words,
        share if below.is_some() => format!("{words}, {} under", percent(-share)),
        // A multiple is easier to grasp than a thousand per cent.
        share if share >= 200.0 => format!("{words}, {:.2} times as much", Quantity::new(size / limit, "")),
        share => format!("{words}, {} over", percent(share)),
    }
}

/// A percentage in two digits; a miss never rounds to none.
fn percent(share: f64) -> String {
    if share < 0.1 { "less than 0.1 %".into() } else { format!("{:.2} %", Quantity::new(share, "")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::samples;

    #[test]
    fn how_far_beyond_a_limit() {
        let metric = |limit_min, limit| MetricResult {
            value: None,
            unit: "s".into(),
            limit,
            limit_min,
            pass: Some(false),
            line: None,
        };
        for (limit_min, limit, value, words) in [
            (None, Some(0.02), 0.0352, "limit 20.0 ms, 76 % over"),
            (None, Some(0.02), -0.0352, "limit 20.0 ms, 76 % over"),
            (None, Some(0.02), 0.1, "limit 20.0 ms, 5.0 times as much"),
            (None, Some(0.02), 0.020_000_1, "limit 20.00000 ms, less than 0.1 % over"),
            (Some(1.0), Some(2.0), 0.9, "limit at least 1.00 s, 10 % under"),
            (Some(1.0), Some(2.0), -0.9, "limit at least 1.00 s, 10 % under"),
            (None, Some(0.0), 0.9, "limit 0 s"),
        ] {
            assert_eq!(bound("steady_state_error", &metric(limit_min, limit), value), words);
        }
    }

    #[test]
    fn of_many_reasons_five_are_told() {
        let reasons = (0..8).map(|k| format!("reason {k}")).collect();
        let mut run = samples::short();
        run.requirements = samples::requirements([("executed", Standing::Broken, reasons)]);
        let told = other_failures(&run);
        assert_eq!(told.len(), 6 + 1, "five, how many more, and the fault that is missing: {told:#?}");
        assert_eq!((told[4].as_str(), told[5].as_str()), ("executed: reason 4", "executed: and 3 more"));
    }

    #[test]
    fn lifted_requirements_are_told_with_what_would_have_broken_them() {
        let mut run = samples::kept();
        run.requirements = samples::requirements([
            ("arrives", Standing::Lifted, vec![]),
            ("stable", Standing::Lifted, vec!["the loop has a pole outside".into(), "it rings".into()]),
            ("bounded", Standing::Lifted, vec![]),
        ]);
        assert_eq!(
            lifted(&run),
            ["lifted: stable: the loop has a pole outside (and 1 more)", "lifted: arrives, bounded"]
        );
    }
}
