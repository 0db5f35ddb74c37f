//! Mistakes of a scenario file, shown at their place.
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report, Severity};
use servobench_scenario::{Diagnostic, Shown, Sources, shown};
use std::io::IsTerminal;

/// What is named in place of a file where a mistake is in an option.
const COMMAND_LINE: &str = "command line";

/// Columns that a diagnostic is laid out for.
const WIDTH: usize = 80;

/// Everything that is wrong with a scenario, with its name and the number of mistakes.
pub(crate) fn mistakes(mistakes: &[Diagnostic], sources: &Sources) -> String {
    let plural = if mistakes.len() == 1 { "mistake" } else { "mistakes" };
    let name = sources.name(sources.scenario());
    format!("{name}: {} {plural}\n{}", mistakes.len(), render(mistakes, sources, Severity::Error))
}

/// The diagnostics as a person reads them, one after the other; of many in one file the first, and how many more there are.
pub(crate) fn render(diagnostics: &[Diagnostic], sources: &Sources, severity: Severity) -> String {
    let theme = if std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none() {
        GraphicalTheme::unicode()
    } else {
        GraphicalTheme::unicode_nocolor()
    };
    let handler = GraphicalReportHandler::new_themed(theme).with_width(WIDTH).with_context_lines(1).with_links(false);
    let Shown { diagnostics, more } = shown(diagnostics, sources);
    let more = more.iter().map(|(name, count)| format!("  and {count} more in {name}\n"));
    diagnostics
        .into_iter()
        .map(|diagnostic| {
            let mut text = String::new();
            let report = report(diagnostic, sources, severity);
            match handler.render_report(&mut text, report.as_ref()) {
                Ok(()) => text,
                // A span that cannot be drawn is still named by its line.
                Err(_) => diagnostic.line(sources),
            }
        })
        .chain(more)
        .collect()
}

fn report(diagnostic: &Diagnostic, sources: &Sources, severity: Severity) -> Report {
    let source = diagnostic.source;
    let name = if source.is_override() { COMMAND_LINE } else { sources.name(source) };
    let text = sources.text(source);
    let mut told = MietteDiagnostic::new(diagnostic.message.clone())
        .with_severity(severity)
        .with_label(LabeledSpan::new_with_span(None, diagnostic.span.clone()));
    if let Some(help) = &diagnostic.help {
        told = told.with_help(help.clone());
    }
    Report::new(told).with_source_code(NamedSource::new(name, text.to_owned()))
}
