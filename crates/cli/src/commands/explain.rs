//! `servobench explain`: the reference of a name, from the descriptions that the program itself works with.
mod definition;

use crate::args::ExplainArgs;
use crate::console::{print, style};
use crate::error::CliError;
use crate::exit::{CODES, Exit, PRECEDENCE};
use definition::definition;
use servobench_files::nearest;
use servobench_metrics::{Name, Requirement};
use servobench_plcopen::{Absent, BlockName};
use servobench_report::{Style, two_columns, wrapped};
use servobench_scenario::{KeyFile, KeyReference, key_references, keys_named};
use servobench_signals::Signal;

/// Tables whose keys are named like metrics and requirements, whose explanations have more detail.
const BY_NAME: [&str; 3] = ["limits.", "program.limits.", "requirements."];

/// Rows of an explanation: a heading, and a text.
type Rows = Vec<(&'static str, String)>;

/// Explains a name, or lists the names.
pub(crate) fn explain(args: &ExplainArgs) -> Result<Exit, CliError> {
    let text = match &args.name {
        None => overview(style()),
        Some(name) => explained(name.trim(), style())?,
    };
    print(&text)?;
    Ok(Exit::Passed)
}

/// Explanations of everything with this name.
fn explained(name: &str, style: Style) -> Result<String, CliError> {
    let by_name = [exit_code, metric, requirement, signal, block];
    let own = BY_NAME.iter().find_map(|table| name.strip_prefix(table)).unwrap_or(name);
    let mut found: Vec<String> = by_name.into_iter().filter_map(|explain| explain(own, style)).collect();
    let mut keys = keys_named(name);
    if !found.is_empty() {
        keys.retain(|key| !BY_NAME.iter().any(|table| key.path.starts_with(table)));
    }
    match keys.as_slice() {
        [] => {}
        [one] => found.push(key(one, style)),
        several => {
            let rows: Vec<_> = several.iter().map(|key| (key.path.as_str(), key.meaning.as_str())).collect();
            found.push(two_columns(&format!("{name} (key of several tables)"), &rows, style));
        }
    }
    if found.is_empty() {
        let names = names();
        let help = match nearest(name, names.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "`servobench explain` lists what can be explained".to_owned(),
        };
        let what = "key, metric, requirement, signal, function block or exit code";
        return Err(CliError::NoSuch { what, name: name.to_owned(), help });
    }
    Ok(found.join("\n"))
}

fn key(key: &KeyReference, style: Style) -> String {
    let kind = if key.keys.is_empty() { "key" } else { "table" };
    let file = match key.file {
        KeyFile::Scenario => "scenario files",
        KeyFile::Sweep => "sweep files",
    };
    let mut rows: Rows = vec![("meaning", key.meaning.clone())];
    rows.extend(key.value.iter().filter(|_| key.choices.is_empty()).map(|value| ("value", value.replace('`', ""))));
    rows.extend(key.quantity.iter().map(|quantity| ("quantity", quantity.clone())));
    let place = if key.header.is_empty() { "top level" } else { key.header.as_str() };
    let needed = if key.is_required { "; required" } else { "" };
    rows.push((if key.keys.is_empty() { "table" } else { "header" }, format!("{place} of {file}{needed}")));
    let mut text = two_columns(&format!("{} ({kind})", key.path), &rows, style);
    if !key.choices.is_empty() {
        text.extend(["\n", &two_columns("values", &key.choices, style)]);
    }
    if !key.keys.is_empty() {
        let inner = key.keys.iter().map(|name| {
            let meaning = keys_named(&format!("{}.{name}", key.path)).first().map_or("", |key| key.meaning.as_str());
            (name, meaning)
        });
        text.extend(["\n", &two_columns("keys", &inner.collect::<Vec<_>>(), style)]);
    }
    text
}

fn metric(name: &str, style: Style) -> Option<String> {
    let metric: Name = name.parse().ok()?;
    let mut rows: Rows = vec![("meaning", metric.meaning().to_owned())];
    if let Some(definition) = definition(metric) {
        rows.push(("definition", definition.text));
        rows.push(("unit", with_meaning(&definition.unit)));
        rows.extend(definition.channels.map(|channels| ("from", channels)));
    }
    let example = metric.example();
    let example = if metric.largest().is_ratio() { example.to_owned() } else { format!("\"{example}\"") };
    let bounds = if metric.is_signed() { ", which bounds the magnitude" } else { "" };
    rows.push(("limit", format!("{metric} = {example} in [limits]{bounds}")));
    if metric.needs_window() {
        rows.push(("needs", "window in [measure]".to_owned()));
    }
    Some(two_columns(&format!("{metric} (metric)"), &rows, style))
}

fn requirement(name: &str, style: Style) -> Option<String> {
    let requirement = Requirement::ALL.iter().find(|requirement| requirement.as_str() == name)?;
    let rows: Rows = vec![
        ("meaning", requirement.meaning().to_owned()),
        ("lift", format!("{name} = false in [requirements]: a run does without it")),
    ];
    Some(two_columns(&format!("{name} (requirement)"), &rows, style))
}

fn signal(name: &str, style: Style) -> Option<String> {
    let signal: Signal = name.parse().ok()?;
    let rows: Rows = vec![
        ("meaning", signal.meaning().to_owned()),
        ("unit", with_meaning(&signal.unit().to_string())),
        ("present", signal.presence().meaning().to_owned()),
        ("use", "channels in [record]; inputs of FMUs; columns of recordings".to_owned()),
    ];
    Some(two_columns(&format!("{name} (signal)"), &rows, style))
}

/// A unit with the meaning of its letter.
fn with_meaning(unit: &str) -> String {
    match unit {
        "1" => "none, a pure number".to_owned(),
        "U" | "U/s" | "U/s²" | "U/s³" | "U/s⁴" => format!("{unit}; U is m or rad, as the axis moves"),
        "E" | "V or E" => format!("{unit}; E is N or N·m, as the motor moves"),
        "F" => format!("{unit}; F is N or N·m, as the axis moves"),
        _ => unit.to_owned(),
    }
}

fn block(name: &str, style: Style) -> Option<String> {
    let block = BlockName::from_name(name)?;
    let outputs: Vec<&str> = block.outputs().iter().map(|output| output.name()).collect();
    let rows: Rows = vec![
        ("meaning", block.meaning().to_owned()),
        ("call", format!("block = \"{name}\" in [[call]]; {} by `start` and `stop`", block.trigger().name())),
        ("outputs", outputs.join(", ")),
    ];
    let inputs: Vec<(&str, String)> = block
        .inputs()
        .iter()
        .map(|own| {
            let needed = if matches!(own.absent, Absent::Refused(_)) { " Required." } else { "" };
            (own.input.key(), format!("{}{needed}", own.input.meaning_with_default()))
        })
        .collect();
    let text = two_columns(&format!("{name} (function block)"), &rows, style);
    Some(if inputs.is_empty() { text } else { format!("{text}\n{}", two_columns("inputs", &inputs, style)) })
}

fn exit_code(name: &str, style: Style) -> Option<String> {
    let (code, meaning) = CODES.iter().find(|(code, _)| *code == name)?;
    Some(two_columns(&format!("{code} (exit code)"), &[("meaning", format!("{meaning}\n{PRECEDENCE}"))], style))
}

/// Everything that can be explained, by its name.
fn names() -> Vec<String> {
    let keys = key_references().iter();
    let last = keys.clone().filter_map(|key| key.path.rsplit('.').next()).map(str::to_owned);
    lists().into_iter().flat_map(|(_, names)| names).chain(last).chain(keys.map(|key| key.path.clone())).collect()
}

/// Everything that can be explained, except keys within tables: each kind with its names.
fn lists() -> Vec<(&'static str, Vec<String>)> {
    let top = |file| {
        let own = key_references().iter().filter(move |key| key.file == file && !key.path.contains('.'));
        own.map(|key| key.path.clone()).collect()
    };
    let texts = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    vec![
        ("keys and tables of scenario files, at the top level", top(KeyFile::Scenario)),
        ("keys and tables of sweep files, at the top level", top(KeyFile::Sweep)),
        ("metrics", texts(&Name::ALL.iter().map(|name| name.as_str()).collect::<Vec<_>>())),
        ("requirements", texts(&Requirement::ALL.iter().map(|one| one.as_str()).collect::<Vec<_>>())),
        ("signals", texts(&Signal::ALL.iter().map(|signal| signal.name()).collect::<Vec<_>>())),
        ("function blocks", texts(&BlockName::ALL.iter().map(|block| block.name()).collect::<Vec<_>>())),
        ("exit codes", texts(&CODES.map(|(code, _)| code))),
    ]
}

fn overview(style: Style) -> String {
    const INDENT: &str = "  ";
    let mut text = String::new();
    for (kind, names) in lists() {
        text += &two_columns::<&str, &str>(kind, &[], style);
        for line in wrapped(&names.join(", "), style.width - INDENT.len()) {
            text.extend([INDENT, &line, "\n"]);
        }
        text.push('\n');
    }
    let end = "servobench explain NAME explains one of them. A table (explain axis) lists its keys, which are explained by \
               their paths (explain axis.motor_side.mass) or by the ends of these (explain mass).";
    text + &wrapped(end, style.width).join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str) -> String {
        explained(name, Style::default()).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Oracle: the names themselves, of the lists and of the schema.
    #[test]
    fn every_name_is_explained_in_80_columns() {
        for name in names() {
            let text = of(&name);
            let too_wide = text.lines().find(|line| line.chars().count() > 80);
            assert_eq!(too_wide, None, "{name}");
            assert!(text.lines().count() > 1, "{text}");
        }
        assert!(overview(Style::default()).lines().all(|line| line.chars().count() <= 80));
    }

    #[test]
    fn explanations_of_each_kind() {
        let names = [
            "axis.motor_side.mass",
            "program[0].move_to",
            "axis.motion",
            "drive.position",
            "stiffness",
            "settling_time",
            "limits.setpoint_snap_ratio",
            "follows",
            "load.position",
            "effort.reference",
            "MC_Halt",
            "3",
        ];
        let all: Vec<String> = names.iter().map(|name| format!("$ servobench explain {name}\n{}", of(name))).collect();
        insta::assert_snapshot!(all.join("\n"));
    }

    #[test]
    fn an_unknown_name_has_a_near_one() {
        let wrong = |name: &str| explained(name, Style::default()).unwrap_err().to_string();
        assert!(wrong("setling_time").ends_with("did you mean `settling_time`?"), "{}", wrong("setling_time"));
        assert!(wrong("axis.motor_side.mas").ends_with("did you mean `axis.motor_side.mass`?"));
        assert!(wrong("mc_halt").ends_with("did you mean `MC_Halt`?"));
        assert!(wrong("5").ends_with("`servobench explain` lists what can be explained"), "{}", wrong("5"));
    }
}
