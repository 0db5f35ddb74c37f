//! A sweep file: a scenario, and keys with values that vary from run to run.
//!
//! ```text
//! TOML → tree with places → tables → `SweepRequest`
//! ```
//! The scenario decides the meaning of a value: here it is a number with a unit, or a text.
use crate::diagnostic::{Invalid, LoadError, Report};
use crate::field::{Field, Reported, Slot, key, written};
use crate::list::{Many, OneOrMany};
use crate::load::all_errors;
use crate::overrides::{Key, OverrideError};
use crate::quantity;
use crate::simple::OneOf;
use crate::source::{At, Place, SourceId, Sources, Span};
use crate::table::table;
use crate::tree::{self, Node, Value as TreeValue};
use serde_json::{Value as Json, json};
use servobench_config::Kind::Plain;
use servobench_config::positive;
use servobench_config::quantities::RATIO;
use servobench_files::suggestion;
use servobench_metrics::Name;
use servobench_plant::EngineName;
use servobench_sweep::{Arrangement, Axis, Distribution, Drawn, Draws, Method, Spacing, Sweep, SweepError, Value};
use std::collections::HashMap;
use std::ops::Range as Bytes;
use std::path::{Path, PathBuf};

/// A sweep as requested by its file.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepRequest {
    /// Text of the file.
    pub text: String,
    /// The scenario that is varied.
    pub scenario: PathBuf,
    /// Purpose in one sentence; empty if the file has none.
    pub description: String,
    /// Engines of the runs; empty: those of the scenario.
    pub engines: Vec<EngineName>,
    /// Metrics to report for each run; empty: all.
    pub metrics: Vec<Name>,
    /// The keys that vary, with their values.
    pub sweep: Sweep,
    /// The scenario keys that it sets, by their names in the sweep.
    pub keys: HashMap<String, Key>,
}

table! {
    /// A sweep of servobench: a scenario, and keys of it whose values vary from run to run.
    pub(crate) struct SweepFile requires ["scenario", "vary"] {
        /// The scenario that is varied: a path from the folder of this file.
        scenario: String = (),
        /// Purpose of the sweep, in a sentence.
        description: String = (),
        /// Engine or engines to run it on; default: those of the scenario.
        engine: OneOrMany<EngineName> = OneOf,
        /// Combination of the values of several keys; default: "grid".
        arrangement: Arrangement = OneOf,
        /// Metrics of each run in the results; default: all. Those that the scenario limits are always measured.
        metrics: OneOrMany<WantedMetric> = (),
        /// Keys that vary; `[[vary]]` for each.
        vary: Many<Vary> = (),
        /// Draws of the keys with a distribution.
        draws: DrawTable = (),
    }
}

table! {
    /// A key that varies. It has values, a range, or a distribution.
    pub(crate) struct Vary requires ["key"] {
        /// The key of the scenario, as `--set` has it: "setpoint.jerk", "program[0].move_to".
        key: String = (),
        /// Other keys that have the same value in each run: "measure.mode".
        also: OneOrMany<String> = (),
        /// Marks a given property of the machine, not a choice: the choices are then compared at their worst over these values. Only in
        /// a grid; a drawn key always counts as given. Default: in the front alone for keys of `axis`, `motor` and `disturbance` and
        /// for seeds; otherwise false.
        given: bool = (),
        /// List of its values.
        values: OneOrMany<Amount> = (),
        /// Values from one end to the other, both included.
        range: Range = (),
        /// Drawn uniformly between two values.
        uniform: Uniform = (),
        /// Drawn uniformly from the whole numbers between two, for seeds.
        whole: Whole = (),
        /// Drawn from a normal distribution.
        normal: Normal = (),
        /// Drawn from a triangular distribution.
        triangular: Triangular = (),
    }
}

table! {
    /// Values from one end to the other, both included.
    pub(crate) struct Range requires ["from", "to", "count"] {
        /// The first value.
        from: Amount = (),
        /// The last value, in the unit of the first.
        to: Amount = (),
        /// Number of values.
        count: u32 = 2..=1_000_000,
        /// Spacing at equal distances or at equal ratios; default: "linear".
        spacing: Spacing = OneOf,
    }
}

table! {
    /// Uniform distribution: `from` and `to`, or `mean` and `tolerance`.
    pub(crate) struct Uniform {
        /// The smallest value.
        from: Amount = (),
        /// The largest value, in the unit of the smallest.
        to: Amount = (),
        /// The value in the middle.
        mean: Amount = (),
        /// Distance of the ends from the middle, as a share of it.
        tolerance: f64 = positive(Plain(&RATIO), "5 %"),
    }
}

table! {
    /// Uniform distribution over the whole numbers between two.
    pub(crate) struct Whole requires ["from", "to"] {
        /// The smallest number.
        from: Amount = (),
        /// The largest number, in the unit of the smallest.
        to: Amount = (),
    }
}

table! {
    /// Normal distribution: `mean` and `sigma`, or `mean` and `tolerance`.
    pub(crate) struct Normal requires ["mean"] {
        /// The value in the middle.
        mean: Amount = (),
        /// Standard deviation, in the unit of the middle.
        sigma: Amount = (),
        /// Three standard deviations, as a share of the middle: 99.7 % of all values are within.
        tolerance: f64 = positive(Plain(&RATIO), "5 %"),
    }
}

table! {
    /// Triangular distribution: `from`, `mode` and `to`, or `mode` and `tolerance`.
    pub(crate) struct Triangular requires ["mode"] {
        /// The smallest value, in the unit of the most likely.
        from: Amount = (),
        /// The most likely value.
        mode: Amount = (),
        /// The largest value, in the unit of the most likely.
        to: Amount = (),
        /// Distance of the ends from the most likely value, as a share of it.
        tolerance: f64 = positive(Plain(&RATIO), "5 %"),
    }
}

table! {
    /// Draws of the keys with a distribution.
    pub(crate) struct DrawTable requires ["count"] {
        /// Number of draws, of all these keys together.
        count: u32 = 1..=10_000_000,
        /// The same seed gives the same draws, on every machine; default: 1.
        seed: u32 = 0..=u32::MAX,
        /// Sampling of the distributions; default: "latin-hypercube".
        method: Method = OneOf,
    }
}

/// A number with a unit, or any other value of a key.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Amount(Value);

impl Field for Amount {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let value = match &node.value {
            TreeValue::Number(number) => Value::Number(number.value, String::new()),
            TreeValue::Bool(value) => Value::Text(value.to_string()),
            TreeValue::Text(text) | TreeValue::Quantity { text, .. } => amount(text),
            TreeValue::Array(_) | TreeValue::Table(_) | TreeValue::Date => {
                let message = format!("`{}` must be a value, got {}", key(path), node.value.kind());
                report.error(node.span, message, "write it as text: \"[1, 2]\"");
                return None;
            }
        };
        Some(Self(value))
    }

    fn schema((): &()) -> Json {
        json!({ "type": ["string", "number", "boolean"], "examples": ["50 m/s3"] })
    }
}

/// A number with a unit, or else a text. Letters directly after a number are a unit only if such a unit exists: "2hump-ei" is a name.
pub(crate) fn amount(text: &str) -> Value {
    let trimmed = text.trim();
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    // The longest prefix that is a number: in "5 e" the 5, in "5e3 m" all but the unit.
    let ends = trimmed.char_indices().map(|(at, c)| (at + c.len_utf8(), c)).take_while(|(_, c)| is_of_number(*c));
    let longest = ends.filter_map(|(end, _)| Some((end, trimmed[..end].parse::<f64>().ok()?))).last();
    let is_unit =
        |rest: &str| rest.is_empty() || rest.starts_with(char::is_whitespace) || quantity::Scale::read(rest).is_ok();
    match longest {
        Some((end, number)) if number.is_finite() && is_unit(&trimmed[end..]) => {
            Value::Number(number, trimmed[end..].trim().to_owned())
        }
        _ => Value::Text(text.to_owned()),
    }
}

/// A metric by its name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WantedMetric(Name);

impl Field for WantedMetric {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let TreeValue::Text(text) = &node.value else {
            report.error(node.span, format!("`{}` must be a metric, got {}", key(path), written(node)), "");
            return None;
        };
        if let Ok(name) = text.parse() {
            return Some(Self(name));
        }
        let names = Name::ALL.iter().map(|metric| metric.as_str());
        report.error(node.span, format!("unknown metric `{text}`"), suggestion(text, names));
        None
    }

    fn schema((): &()) -> Json {
        let names: Vec<&str> = Name::ALL.iter().map(|metric| metric.as_str()).collect();
        json!({ "enum": names })
    }
}

/// Loads the sweep file at `path`.
///
/// # Errors
/// [`LoadError::Read`] when it cannot be read, [`LoadError::Invalid`] with every mistake in it.
pub fn load_sweep(path: &Path) -> Result<SweepRequest, LoadError> {
    let unreadable = |error| LoadError::Read { path: path.to_owned(), error };
    let text = servobench_files::read_text(path, LONGEST).map_err(unreadable)?;
    parse_sweep(&path.display().to_string(), &text, path.parent().unwrap_or_else(|| Path::new("")))
}

/// Largest size of a sweep file (bytes).
const LONGEST: u64 = 16 << 20;

/// Reads a sweep from `text`; `name` stands for the file in messages, and paths in it are relative to `folder`.
///
/// # Errors
/// [`LoadError::Invalid`] with every mistake in it.
pub fn parse_sweep(name: &str, text: &str, folder: &Path) -> Result<SweepRequest, LoadError> {
    let mut sources = Sources::default();
    let id = sources.add(name.to_owned(), text.to_owned(), Place::Folder(folder.to_owned()));
    let (mut syntax, mut report) = (Report::default(), Report::default());
    let mut parsed = tree::parse(id, text, &mut syntax);
    let broken: Vec<(SourceId, Bytes<usize>)> = parsed.broken.drain(..).map(|line| (id, line)).collect();
    let root = Node { value: TreeValue::Table(parsed.table), span: Span::new(id, &(0..0)) };
    let request =
        SweepFile::decode("", &root, &(), &mut report).and_then(|file| request(&file, text, folder, &mut report).ok());
    let diagnostics = all_errors(syntax, &mut report, &broken);
    match request {
        Some(request) if diagnostics.is_empty() => Ok(request),
        _ => Err(LoadError::Invalid(Box::new(Invalid { diagnostics, warnings: report.warnings, sources }))),
    }
}

fn request(file: &SweepFile, text: &str, folder: &Path, report: &mut Report) -> Result<SweepRequest, Reported> {
    let scenario = file.scenario.given().map(|path| folder.join(path));
    let (axes, drawn) = varied(file, report)?;
    let draws = draws(file, drawn, report)?;
    let arrangement = file.arrangement.optional()?.copied().unwrap_or_default();
    let place = file.vary.span().unwrap_or(file.span);
    let sweep = Sweep::new(axes, arrangement, draws).map_err(|error| refuse(report, place, &error))?;
    let sweep = followed(sweep, file, report)?;
    let keys = keys(file, report)?;
    let all = |list: Option<&OneOrMany<WantedMetric>>| list.map(|list| list.0.iter().map(|at| at.value.0).collect());
    Ok(SweepRequest {
        text: text.to_owned(),
        scenario: scenario.ok_or(Reported)?,
        description: file.description.optional()?.cloned().unwrap_or_default(),
        engines: file.engine.optional()?.map(|list| list.0.iter().map(|at| at.value).collect()).unwrap_or_default(),
        metrics: all(file.metrics.optional()?).unwrap_or_default(),
        sweep,
        keys,
    })
}

/// The keys that are set, parsed.
fn keys(file: &SweepFile, report: &mut Report) -> Result<HashMap<String, Key>, Reported> {
    let mut keys = HashMap::new();
    for At { value: vary, .. } in &file.vary.given().ok_or(Reported)?.0 {
        let followers = vary.also.optional()?.map(|also| also.0.as_slice()).unwrap_or_default();
        for At { value: name, span } in vary.key.at().into_iter().chain(followers) {
            match name.parse() {
                Ok(key) => drop(keys.insert(name.clone(), key)),
                Err(OverrideError(why)) => report.error(*span, format!("`{name}` is not a key: {why}"), ""),
            }
        }
    }
    if report.errors.is_empty() { Ok(keys) } else { Err(Reported) }
}

/// The sweep with keys that follow others, and with given keys.
fn followed(mut sweep: Sweep, file: &SweepFile, report: &mut Report) -> Result<Sweep, Reported> {
    for At { value: vary, .. } in &file.vary.given().ok_or(Reported)?.0 {
        let followers = vary.also.optional()?.map(|also| also.0.as_slice()).unwrap_or_default();
        let is_of_the_machine =
            |key: &String| is_of_the_machine(key) || followers.iter().any(|at| self::is_of_the_machine(&at.value));
        match (vary.key.given(), vary.given.optional()?) {
            (Some(key), Some(true)) => sweep = sweep.given(key),
            (Some(key), None) if is_of_the_machine(key) => sweep = sweep.of_the_machine(key),
            _ => {}
        }
        if let (Some(key), Some(also)) = (vary.key.given(), vary.also.optional()?) {
            let others: Vec<String> = also.0.iter().map(|at| at.value.clone()).collect();
            let place = vary.also.span().unwrap_or(file.span);
            sweep = sweep.followed(key, &others).map_err(|error| refuse(report, place, &error))?;
        }
    }
    Ok(sweep)
}

/// Tables of a scenario that describe the machine.
const MACHINE: [&str; 3] = ["axis", "motor", "disturbance"];

/// True for a key that is not a choice: the machine, its disturbances, the seed of its random numbers.
fn is_of_the_machine(key: &str) -> bool {
    let mut parts = key.split(['.', '[']);
    parts.next().is_some_and(|table| MACHINE.contains(&table)) || key.rsplit('.').next() == Some("seed")
}

fn refuse(report: &mut Report, place: Span, error: &SweepError) -> Reported {
    report.error(place, error.to_string(), "");
    Reported
}

/// Keys with listed values, and keys that are drawn.
fn varied(file: &SweepFile, report: &mut Report) -> Result<(Vec<Axis>, Vec<Drawn>), Reported> {
    let (mut axes, mut drawn, mut is_right) = (Vec::new(), Vec::new(), true);
    for At { value: vary, span } in &file.vary.given().ok_or(Reported)?.0 {
        match one(vary, *span, report) {
            Ok(Varied::Axis(axis)) => axes.push(axis),
            Ok(Varied::Drawn(of)) => drawn.push(of),
            Err(Reported) => is_right = false,
        }
    }
    if is_right { Ok((axes, drawn)) } else { Err(Reported) }
}

enum Varied {
    Axis(Axis),
    Drawn(Drawn),
}

fn one(vary: &Vary, span: Span, report: &mut Report) -> Result<Varied, Reported> {
    let key = vary.key.given().ok_or(Reported)?;
    let drawn = [vary.uniform.span(), vary.whole.span(), vary.normal.span(), vary.triangular.span()];
    let given = [&[vary.values.span(), vary.range.span()], &drawn[..]].concat();
    if given.iter().flatten().count() != 1 {
        let message = format!("`{key}` needs one of `values`, `range`, `uniform`, `whole`, `normal` and `triangular`");
        let what = if given.iter().flatten().next().is_none() { "it has none" } else { "it has more than one" };
        report.error(span, format!("{message}; {what}"), "");
        return Err(Reported);
    }
    if let Some(list) = vary.values.optional()? {
        let values = list.0.iter().map(|at| at.value.0.clone()).collect();
        return Ok(Varied::Axis(Axis { key: key.clone(), values }));
    }
    if let Some(range) = vary.range.optional()? {
        let (ends, unit) = ends(&range.from, &range.to, report)?;
        let count = *range.count.given().ok_or(Reported)? as usize;
        let spacing = range.spacing.optional()?.copied().unwrap_or_default();
        let axis = Axis::range(key, ends, &unit, count, spacing).map_err(|error| refuse(report, range.span, &error))?;
        return Ok(Varied::Axis(axis));
    }
    let (distribution, unit, place) = distribution(vary, report)?;
    if let Some(reason) = distribution.objection() {
        return Err(refuse(report, place, &SweepError::Distribution { key: key.clone(), reason }));
    }
    Ok(Varied::Drawn(Drawn { key: key.clone(), unit, distribution }))
}

/// The distribution of a key, the unit of its values and its place.
fn distribution(vary: &Vary, report: &mut Report) -> Result<(Distribution, String, Span), Reported> {
    if let Some(table) = vary.uniform.optional()? {
        let (low, high, unit) = match (table.from.optional()?, table.mean.optional()?, table.tolerance.optional()?) {
            (Some(_), None, None) => {
                let ([low, high], unit) = ends(&table.from, &table.to, report)?;
                (low, high, unit)
            }
            (None, Some(_), Some(tolerance)) if table.to.optional()?.is_none() => {
                let (mean, unit) = number(&table.mean, None, report)?;
                let off = (mean * tolerance).abs();
                (mean - off, mean + off, unit)
            }
            _ => return Err(incomplete(report, table.span, "`from` and `to`, or `mean` and `tolerance`")),
        };
        return Ok((Distribution::Uniform { low, high }, unit, table.span));
    }
    if let Some(table) = vary.whole.optional()? {
        let ([low, high], unit) = ends(&table.from, &table.to, report)?;
        return Ok((Distribution::Whole { low, high }, unit, table.span));
    }
    if let Some(table) = vary.normal.optional()? {
        let (mean, unit) = number(&table.mean, None, report)?;
        let sigma = match (table.sigma.optional()?, table.tolerance.optional()?) {
            (Some(_), None) => number(&table.sigma, Some(&unit), report)?.0,
            (None, Some(tolerance)) => (mean * tolerance / 3.0).abs(),
            _ => return Err(incomplete(report, table.span, "`sigma` or `tolerance` beside `mean`")),
        };
        return Ok((Distribution::Normal { mean, sigma }, unit, table.span));
    }
    let table = vary.triangular.optional()?.ok_or(Reported)?;
    let (mode, unit) = number(&table.mode, None, report)?;
    let (low, high) = match (table.from.optional()?, table.to.optional()?, table.tolerance.optional()?) {
        (Some(_), Some(_), None) => {
            (number(&table.from, Some(&unit), report)?.0, number(&table.to, Some(&unit), report)?.0)
        }
        (None, None, Some(tolerance)) => {
            let off = (mode * tolerance).abs();
            (mode - off, mode + off)
        }
        _ => return Err(incomplete(report, table.span, "`from` and `to`, or `tolerance`, beside `mode`")),
    };
    Ok((Distribution::Triangular { low, mode, high }, unit, table.span))
}

fn incomplete(report: &mut Report, place: Span, needed: &str) -> Reported {
    report.error(place, format!("the distribution needs {needed}"), "");
    Reported
}

/// Two numbers in the same unit, and the unit.
fn ends(from: &Slot<Amount>, to: &Slot<Amount>, report: &mut Report) -> Result<([f64; 2], String), Reported> {
    let (low, unit) = number(from, None, report)?;
    let (high, _) = number(to, Some(&unit), report)?;
    Ok(([low, high], unit))
}

/// A number with its unit, which must be `unit` if that is given.
fn number(slot: &Slot<Amount>, unit: Option<&str>, report: &mut Report) -> Result<(f64, String), Reported> {
    let At { value: Amount(value), span } = slot.at().ok_or(Reported)?;
    let Value::Number(number, own) = value else {
        report.error(
            *span,
            format!("`{}` is not a number", value.written()),
            "write a number with its unit: \"50 m/s3\"",
        );
        return Err(Reported);
    };
    if let Some(unit) = unit.filter(|unit| unit != own) {
        let of = |unit: &str| if unit.is_empty() { "no unit".to_owned() } else { format!("`{unit}`") };
        report.error(
            *span,
            format!("`{}` has {}, the other number {}", value.written(), of(own), of(unit)),
            "use one unit for both",
        );
        return Err(Reported);
    }
    Ok((*number, own.clone()))
}

fn draws(file: &SweepFile, drawn: Vec<Drawn>, report: &mut Report) -> Result<Option<Draws>, Reported> {
    let Some(table) = file.draws.optional()? else {
        if drawn.is_empty() {
            return Ok(None);
        }
        let place = file.vary.span().unwrap_or(file.span);
        report.error(place, "the number of draws is missing", "write `[draws]` with `count = 1000`");
        return Err(Reported);
    };
    let count = *table.count.given().ok_or(Reported)?;
    let seed = u64::from(table.seed.optional()?.copied().unwrap_or(1));
    let method = table.method.optional()?.copied().unwrap_or_default();
    Draws::new(count, seed, method, drawn).map(Some).map_err(|error| refuse(report, table.span, &error))
}
