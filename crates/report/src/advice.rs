//! Advice in words: the set-point, its cost and its certainty.
mod vendors;

use crate::style::{Ink, Style};
use crate::text::wrapped;
use serde_json::{Value, json};
use servobench_advise::{Advice, Question, SetPoint};
use servobench_base::Coordinate;
use servobench_metrics::{Limit, Quantity, digits};
use servobench_results::{printable, printable_lines};

/// Context of an advice.
#[derive(Debug, Clone)]
pub struct AdviceOptions<'a> {
    /// The scenario.
    pub scenario: &'a str,
    /// The engine that it ran on.
    pub engine: &'a str,
    /// The limits, in the order in which the advice counts them.
    pub limits: &'a [Limit],
    /// Linear or rotary motion of the axis.
    pub motion: Coordinate,
    /// The command that runs the scenario as it is.
    pub command: &'a str,
    /// The set-point as on the command line: `setpoint.jerk=50 m/s3`.
    pub settings: Vec<String>,
    /// True if the tolerances were assumed instead of given.
    pub is_assumed: bool,
    /// True if settling counts.
    pub has_window: bool,
    /// Natural frequency that shapers are designed for (Hz).
    pub shaper_frequency: Option<f64>,
}

/// Confidence of the bounds given.
const CONFIDENCE: f64 = 0.95;
/// Significant digits of values other than metrics.
const DIGITS: usize = 4;
/// Width of a first column.
const FIRST: usize = 8;
/// Difference of times that counts as none (s).
const NOTHING: f64 = 0.5e-4;
/// Number of other kinds of set-points listed.
const OTHERS: usize = 5;

/// The advice in at most [`Style::width`] columns: a sentence with its price and its certainty, the limits used, other kinds of
/// set-points, and the same in vendors' terms.
#[must_use]
pub fn advice_text(question: &Question, advice: &Advice, options: &AdviceOptions<'_>, style: Style) -> String {
    let text = Text { question, advice, options, style };
    [
        text.sentence(),
        text.used(),
        text.machines(),
        text.prices(),
        text.others(),
        vendors::words(question, advice, options, style),
        text.command(),
    ]
    .concat()
}

/// The advice for programs (SI; shares from 0 to 1).
#[must_use]
pub fn advice_json(question: &Question, advice: &Advice, options: &AdviceOptions<'_>) -> Value {
    let [velocity, acceleration, jerk, snap] = advice.point.limits;
    let finite = |value: f64| value.is_finite().then_some(value);
    let keys: Vec<&str> = question.machines.ranges().iter().map(|range| range.key.as_str()).collect();
    let machine = |values: &[f64]| -> Value {
        let pairs = keys.iter().zip(values).map(|(key, value)| ((*key).to_owned(), json!(value)));
        Value::Object(pairs.collect())
    };
    let usage = options.limits.iter().zip(&advice.worst.usage).map(|(limit, (usage, at))| {
        json!({ "limit": limit.metric.as_str(), "used": finite(*usage), "machine": machine(at) })
    });
    let ranges = question.machines.ranges().iter();
    let ranges =
        ranges.map(|range| json!({ "key": range.key, "from": range.ends[0], "to": range.ends[1], "unit": range.unit }));
    let prices = advice.prices.iter().map(|price| json!({ "factor": price.factor, "time": price.time }));
    let draws = advice.verification.draws;
    json!({
        "scenario": options.scenario,
        "engine": options.engine,
        "kind": question.families[advice.point.family].name,
        "order": question.families[advice.point.family].order,
        "velocity": velocity,
        "acceleration": acceleration,
        "jerk": finite(jerk),
        "snap": finite(snap),
        "settings": options.settings,
        "move_time": advice.duration,
        "time": advice.worst.time,
        "usage": usage.collect::<Vec<_>>(),
        "machines": ranges.collect::<Vec<_>>(),
        "verified": {
            "grid": advice.verification.grid,
            "spacing": advice.verification.spacing,
            "draws": draws.trials(),
            "kept": draws.hits(),
            "share_at_least": advice.verification.share,
            "confidence": CONFIDENCE,
        },
        "prices": prices.collect::<Vec<_>>(),
        "runs": advice.runs,
    })
}

struct Text<'a> {
    question: &'a Question,
    advice: &'a Advice,
    options: &'a AdviceOptions<'a>,
    style: Style,
}

impl Text<'_> {
    /// The command that runs the set-point on the machine of the scenario.
    fn command(&self) -> String {
        let AdviceOptions { command, settings, .. } = self.options;
        let set = |all: String, one: &String| format!("{all} \\\n  --set '{one}'");
        let command = settings.iter().fold((*command).to_owned(), set);
        printable_lines(&format!("\nrun it on the machine of the scenario:\n{command}\n"))
    }

    fn heading(&self, text: &str) -> String {
        format!("\n{}\n", self.style.paint(Ink::Heading, text))
    }

    fn broken(&self, text: &str) -> String {
        wrapped(text, self.style.width).into_iter().fold(String::new(), |all, line| all + &line + "\n")
    }

    fn unit(&self, power: usize) -> String {
        let axis = if self.options.motion == Coordinate::Linear { "m" } else { "rad" };
        match power {
            1 => format!("{axis}/s"),
            power => format!("{axis}/s{power}"),
        }
    }

    /// `order 4: velocity 500 mm/s, acceleration 3.69 m/s2`.
    fn point(&self, point: &SetPoint) -> String {
        let family = &self.question.families[point.family];
        let names = ["velocity", "acceleration", "jerk", "snap"];
        let limits = names.iter().zip(point.limits).enumerate().filter(|(_, (_, limit))| limit.is_finite());
        let limits: Vec<String> =
            limits.map(|(k, (name, limit))| format!("{name} {}", Quantity::new(limit, &self.unit(k + 1)))).collect();
        format!("{} with {}", family.name, limits.join(", "))
    }

    fn sentence(&self) -> String {
        let Self { advice, options, .. } = self;
        let time = Quantity::new(advice.worst.time, "s");
        let what = if options.has_window { "is in position" } else { "has moved" };
        let draws = advice.verification.draws;
        let share = 100.0 * advice.verification.share;
        let price = self.price().map_or(String::new(), |words| format!("; {words}"));
        self.broken(&format!(
            "Take {}: {} {what} {time} after the start of a move at worst, and at least {} % of the machines keep all limits ({} of {} draws did, \
             95 % certain){price}.",
            self.point(&advice.point),
            printable(options.scenario),
            // Rounded down: never more than was shown.
            (share * 10.0).floor() / 10.0,
            draws.hits(),
            draws.trials(),
        ))
    }

    /// Cost or saving of less vibration, of more, and of more time.
    fn price(&self) -> Option<String> {
        let metric = self.options.limits.get(self.question.priced?)?.metric;
        let (own, prices) = (self.advice.worst.time, &self.advice.prices);
        let of = |factor: f64| prices.iter().find(|price| price.factor.to_bits() == factor.to_bits());
        let less = match of(0.9)?.time {
            Some(time) if time - own < NOTHING => format!("10 % less {metric} would cost nothing"),
            Some(time) => format!("10 % less {metric} would cost {}", Quantity::new(time - own, "s")),
            None => format!("10 % less {metric} was not found at any price"),
        };
        let more = match of(1.1)?.time {
            Some(time) if own - time >= NOTHING => format!(", 10 % more would save {}", Quantity::new(own - time, "s")),
            _ => ", 10 % more would save nothing".to_owned(),
        };
        let is_near = |time: f64| time <= 1.1 * own;
        let slower = prices.iter().find(|price| price.factor < 1.0 && price.time.is_some_and(is_near));
        let slower = slower.map_or(String::new(), |price| {
            format!(", and in 10 % more time it could be {} % of its limit", digits(100.0 * price.factor, DIGITS))
        });
        Some(less + &more + &slower)
    }

    /// Usage of each limit, and the machine where it is highest.
    fn used(&self) -> String {
        let mut rows: Vec<(f64, String)> = Vec::new();
        for (limit, (usage, machine)) in self.options.limits.iter().zip(&self.advice.worst.usage) {
            let at = self.machine(machine);
            let name = limit.metric.as_str();
            rows.push((*usage, format!("{name} at {at}")));
        }
        rows.sort_by(|one, other| other.0.total_cmp(&one.0));
        let rows: String =
            rows.iter().map(|(usage, text)| self.beside(&format!("{:.1} %", 100.0 * usage), text)).collect();
        self.heading("What limits it: how much of each limit is used, at most") + &rows
    }

    /// `text` wrapped to the right of `first`.
    fn beside(&self, first: &str, text: &str) -> String {
        let lines = wrapped(text, self.style.width.saturating_sub(FIRST + 2).max(20));
        let line = |(k, line): (usize, String)| format!("{:>FIRST$}  {line}\n", if k == 0 { first } else { "" });
        lines.into_iter().enumerate().map(line).collect()
    }

    /// `frequency 15.8 Hz, damping_ratio 0.002`.
    fn machine(&self, machine: &[f64]) -> String {
        let ranges = self.question.machines.ranges();
        let of = |(range, value): (&servobench_advise::Range, &f64)| {
            let name = range.key.rsplit('.').next().unwrap_or_default();
            let unit = if range.unit.is_empty() { String::new() } else { format!(" {}", range.unit) };
            printable(&format!("{name} {}{unit}", digits(*value, DIGITS)))
        };
        ranges.iter().zip(machine).map(of).collect::<Vec<_>>().join(", ")
    }

    fn machines(&self) -> String {
        let ranges = self.question.machines.ranges().iter().map(|range| {
            let unit = if range.unit.is_empty() { String::new() } else { format!(" {}", range.unit) };
            let [low, high] = range.ends.map(|end| digits(end, DIGITS));
            printable(&format!("{} from {low} to {high}{unit}", range.key))
        });
        let assumed = if self.options.is_assumed { " (assumed; say what yours are with --within)" } else { "" };
        let verification = &self.advice.verification;
        let spacing = verification
            .spacing
            .map_or(String::new(), |spacing| format!(", {} Hz or less from each other", digits(spacing, DIGITS)));
        let ranges: Vec<String> = ranges.collect();
        let text = format!(
            "Machines{assumed}: {}. Verified by runs on {} of them at corners of the box and between these{spacing}, and on {} draws; {} \
             set-points were planned and {} runs made on {}.",
            ranges.join("; "),
            verification.grid,
            verification.draws.trials(),
            self.advice.planned,
            self.advice.runs,
            self.options.engine,
        );
        "\n".to_owned() + &self.broken(&text)
    }

    fn prices(&self) -> String {
        let limit = self.question.priced.and_then(|priced| self.options.limits.get(priced));
        let Some((metric, max)) = limit.and_then(|limit| Some((limit.metric, limit.max?))) else {
            return String::new();
        };
        let (axis, own) = (self.unit(0), self.advice.worst.time);
        let unit = if axis.starts_with("rad") { "rad" } else { "m" };
        let mut rows: Vec<(f64, Option<f64>)> =
            self.advice.prices.iter().map(|price| (price.factor, price.time)).chain([(1.0, Some(own))]).collect();
        rows.sort_by(|one, other| one.0.total_cmp(&other.0));
        let row = |(factor, time): &(f64, Option<f64>)| {
            let limit = Quantity::new(factor * max, unit).to_string();
            let time = time.map_or("none found".to_owned(), |time| Quantity::new(time, "s").to_string());
            let here = if (factor - 1.0).abs() < 1e-12 { "  this advice" } else { "" };
            format!("{limit:>FIRST$}  {time}{here}\n")
        };
        let heading = format!("What {metric} costs: its limit, and the time at worst");
        self.heading(&heading) + &rows.iter().map(row).collect::<String>()
    }

    fn others(&self) -> String {
        if self.advice.others.is_empty() {
            return String::new();
        }
        let row =
            |(point, time): &(SetPoint, f64)| self.beside(&Quantity::new(*time, "s").to_string(), &self.point(point));
        let rows: String = self.advice.others.iter().take(OTHERS).map(row).collect();
        self.heading("The best of other kinds, on the machines of the search") + &rows
    }
}
