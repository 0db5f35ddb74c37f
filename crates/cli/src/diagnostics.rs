//! Mistakes of a scenario file, shown at their place.
use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report, Severity,
    ThemeCharacters, ThemeStyles,
};
use servobench_report::painted;
use servobench_results::{printable, printable_lines};
use servobench_scenario::{Diagnostic, Shown, Sources, shown};
use std::ops::Range;

/// Name in place of a file for a mistake in an option.
const COMMAND_LINE: &str = "command line";

/// Width of a diagnostic, in columns.
const WIDTH: usize = 80;

/// Everything that is wrong with a scenario, with its name and the number of mistakes.
pub(crate) fn mistakes(mistakes: &[Diagnostic], sources: &Sources) -> String {
    let plural = if mistakes.len() == 1 { "mistake" } else { "mistakes" };
    let name = printable(sources.name(sources.scenario()));
    format!("{name}: {} {plural}\n{}", mistakes.len(), render(mistakes, sources, Severity::Error))
}

/// The diagnostics as readable text, one after the other; of many in one file the first, and the number of others.
pub(crate) fn render(diagnostics: &[Diagnostic], sources: &Sources, severity: Severity) -> String {
    let plain = handler(ThemeStyles::none());
    let coloured = handler(ThemeStyles::ansi());
    let Shown { diagnostics, more } = shown(diagnostics, sources);
    let more = more.iter().map(|(name, count)| format!("  and {count} more in {name}\n"));
    diagnostics
        .into_iter()
        .map(|diagnostic| {
            let report = report(diagnostic, sources, severity);
            let drawn = |handler: &GraphicalReportHandler| {
                let mut text = String::new();
                handler.render_report(&mut text, report.as_ref()).is_ok().then_some(text)
            };
            match drawn(&plain) {
                // It quotes the file verbatim: text that is not fit for a terminal gets no colours, which could not be
                // distinguished from it.
                Some(text) if printable_lines(&text) != text => text,
                Some(text) => drawn(&coloured).map_or(text, |coloured| painted(&coloured)),
                // A span that cannot be drawn is still named by its line.
                None => diagnostic.line(sources),
            }
        })
        .chain(more)
        .collect()
}

fn handler(styles: ThemeStyles) -> GraphicalReportHandler {
    let theme = GraphicalTheme { characters: ThemeCharacters::unicode(), styles };
    GraphicalReportHandler::new_themed(theme).with_width(WIDTH).with_context_lines(1).with_links(false)
}

/// Most bytes of the lines in an excerpt.
const WIDEST: usize = 2000;

/// True if the lines of `span`, with the one on either side, are too long for an excerpt.
fn is_too_wide(text: &str, span: &Range<usize>) -> bool {
    let before = text.get(..span.start).unwrap_or_default().rsplit('\n').take(2).map(str::len).sum::<usize>();
    let behind = text.get(span.end..).unwrap_or_default().split('\n').take(2).map(str::len).sum::<usize>();
    before + behind + span.len() > WIDEST
}

fn report(diagnostic: &Diagnostic, sources: &Sources, severity: Severity) -> Report {
    let source = diagnostic.source;
    let name = if source.is_override() { COMMAND_LINE } else { sources.name(source) };
    let is_shown = sources.may_be_shown(source) && !is_too_wide(sources.text(source), &diagnostic.span);
    // A file that a scenario names may be any file: none of its lines is shown.
    let message = if is_shown { diagnostic.message.clone() } else { diagnostic.placed_message(sources) };
    let mut told = MietteDiagnostic::new(printable(&message)).with_severity(severity);
    if let Some(help) = &diagnostic.help {
        told = told.with_help(printable(help));
    }
    if !is_shown {
        return Report::new(told);
    }
    let told = told.with_label(LabeledSpan::new_with_span(None, diagnostic.span.clone()));
    Report::new(told).with_source_code(NamedSource::new(printable(name), sources.text(source).to_owned()))
}
