//! Kind and capabilities of an FMU.
use super::value::number;
use super::{fitted, heading_lines, plain};
use crate::style::{Ink, Style};
use servobench_fmi::{DefaultExperiment, ModelDescription, Version};
use std::collections::BTreeSet;

/// Width of `description` and its separator.
const LABEL: usize = 13;

/// Folders of `binaries/` as FMI 2.0 and FMI 3.0 name them.
const PLATFORMS: [(&str, &str); 12] = [
    ("linux64", "Linux x86-64"),
    ("x86_64-linux", "Linux x86-64"),
    ("linux32", "Linux x86"),
    ("x86-linux", "Linux x86"),
    ("aarch64-linux", "Linux ARM64"),
    ("win64", "Windows x86-64"),
    ("x86_64-windows", "Windows x86-64"),
    ("win32", "Windows x86"),
    ("x86-windows", "Windows x86"),
    ("darwin64", "macOS x86-64"),
    ("x86_64-darwin", "macOS x86-64"),
    ("aarch64-darwin", "macOS ARM64"),
];

/// The lines above the variables.
pub(super) fn head(description: &ModelDescription, files: &[String], style: Style) -> String {
    let name = format!("{}, FMI {}", plain(&description.model_name), plain(&description.fmi_version));
    let mut head = heading_lines(&name, style);
    let mut row = |label: &str, text: &str, ink: Option<Ink>| {
        for (at, line) in fitted(text, style.width.saturating_sub(LABEL)).iter().enumerate() {
            let line = ink.map_or_else(|| line.clone(), |ink| style.paint(ink, line));
            let line = format!("{:LABEL$}{line}\n", if at == 0 { label } else { "" });
            head += &line;
        }
    };
    for (label, text) in [
        ("description", &description.description),
        ("version", &description.model_version),
        ("author", &description.author),
        ("copyright", &description.copyright),
        ("licence", &description.license),
        ("made with", &description.generation_tool),
        ("made on", &description.generation_date_and_time),
    ] {
        row(label, &plain(text), None);
    }
    row("platforms", &platforms(files), None);
    if let Some(missing) = missing_library(description, files) {
        row("", &missing, Some(Ink::Bad));
    }
    row("can", &can(description).join("; "), None);
    row("cannot", &cannot(description).join("; "), None);
    row("needs", &needs(description).join("; "), None);
    row("experiment", &experiment(description.default_experiment), None);
    head
}

/// Folders of `binaries/` that contain a file.
fn folders(files: &[String]) -> BTreeSet<&str> {
    let within = files.iter().filter_map(|file| file.strip_prefix("binaries/")?.split_once('/'));
    within.map(|(folder, _)| folder).collect()
}

fn platforms(files: &[String]) -> String {
    let named = |folder: &&str| {
        let known = PLATFORMS.iter().find(|(name, _)| name == folder);
        known.map_or_else(|| plain(folder), |(name, words)| format!("{words} ({name})"))
    };
    let mut all: Vec<String> = folders(files).iter().map(named).collect();
    if files.iter().any(|file| file.starts_with("sources/")) {
        all.push("sources in C".into());
    }
    if all.is_empty() { "none".into() } else { all.join(", ") }
}

/// Reason why the FMU does not run on Linux x86-64, if it does not. Tools mix up the folders of the two versions, so either one counts.
fn missing_library(description: &ModelDescription, files: &[String]) -> Option<String> {
    let library = |folder: &str| format!("binaries/{folder}/{}.so", description.co_simulation.model_identifier);
    let folders = ["linux64", "x86_64-linux"];
    if folders.iter().any(|folder| files.contains(&library(folder))) {
        return None;
    }
    let wanted = library(folders[usize::from(description.version == Version::Three)]);
    Some(format!("not for Linux x86-64: it has no `{wanted}`"))
}

fn can(description: &ModelDescription) -> Vec<String> {
    let own = &description.co_simulation;
    let mut all: Vec<String> = [
        (own.can_get_and_set_state, "save and restore its state"),
        (own.can_serialize_state, "turn its state into bytes"),
        (own.can_handle_variable_communication_step_size, "take steps of any length"),
        (own.can_interpolate_inputs, "take derivatives of inputs"),
        (own.provides_directional_derivatives, "give directional derivatives"),
        (own.has_event_mode, "handle events (event mode)"),
        (own.provides_intermediate_update, "call back within a step"),
        (own.might_return_early_from_do_step, "return early from a step"),
        (own.can_return_early_after_intermediate_update, "end a step from a call back"),
    ]
    .into_iter()
    .filter(|(flag, _)| *flag)
    .map(|(_, words)| words.to_owned())
    .collect();
    if own.max_output_derivative_order > 0 {
        all.push(format!("give derivatives of outputs, up to order {}", own.max_output_derivative_order));
    }
    all
}

/// Missing capabilities that a coupling would use.
fn cannot(description: &ModelDescription) -> Vec<&'static str> {
    let own = &description.co_simulation;
    let wanted = [
        (own.can_get_and_set_state, "save and restore its state"),
        (own.can_handle_variable_communication_step_size, "take steps of varying length"),
    ];
    wanted.into_iter().filter(|(flag, _)| !flag).map(|(_, words)| words).collect()
}

fn needs(description: &ModelDescription) -> Vec<String> {
    let own = &description.co_simulation;
    let step = own.fixed_internal_step_size.map(|step| format!("steps that are multiples of {} s", number(step)));
    let tool = own.needs_execution_tool.then(|| "its tool to be installed".to_owned());
    let alone = own.can_be_instantiated_only_once_per_process.then(|| "a process for each instance".to_owned());
    [tool, alone, step].into_iter().flatten().collect()
}

fn experiment(experiment: DefaultExperiment) -> String {
    let DefaultExperiment { start_time, stop_time, tolerance, step_size } = experiment;
    let seconds = |word: &str, value: Option<f64>| value.map(|value| format!("{word} {} s", number(value)));
    let span: Vec<String> = [seconds("from", start_time), seconds("to", stop_time)].into_iter().flatten().collect();
    let all = [
        (!span.is_empty()).then(|| span.join(" ")),
        seconds("in steps of", step_size),
        tolerance.map(|value| format!("tolerance {}", number(value))),
    ];
    all.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
