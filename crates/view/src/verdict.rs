//! Outcome of a run, in words: the head of every page.
use crate::rerun::{EntityPath, RecordingStream, RecordingStreamResult, TextDocument};
use crate::run::Run;
use servobench_view_request::{Outcome, Verdict, ViewOptions};

/// Its entity.
const PATH: &str = "verdict";
/// Height of title and margins, of a paragraph, of the room above a list and of a line of it (points).
const FRAME: f64 = 33.0;
const PARAGRAPH: f64 = 29.0;
const LIST: f64 = 13.0;
const ITEM: f64 = 16.0;

/// The text above every page.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    /// Names of the runs: `vibration-snap on exact`.
    pub(crate) subject: String,
    /// Markdown, a line or more for each run; empty where nothing was recorded.
    text: String,
}

impl Head {
    /// The head of `runs`, described by `subject`.
    pub(crate) fn of(subject: String, runs: &[Run<'_>], options: &ViewOptions) -> Self {
        let is_empty = |run: &Run<'_>| run.recording.is_empty() && run.recording.signals.is_empty();
        let text = if runs.iter().all(is_empty) {
            String::new()
        } else if options.verdicts.is_empty() {
            "no verdict is known: opened without the results of its run".to_owned()
        } else {
            let judged: Vec<_> = runs.iter().map(|run| run.label).zip(&options.verdicts).collect();
            text(&judged)
        };
        Self { subject, text }
    }

    /// Its entity; `None` when the text is empty.
    pub(crate) fn path(&self) -> Option<EntityPath> {
        (!self.text.is_empty()).then(|| EntityPath::from(PATH))
    }

    /// Height of its view (points), with the title: whole, or that of the first line alone.
    pub(crate) fn height(&self, is_whole: bool) -> f64 {
        let lists = self.text.split("\n\n").filter(|part| part.contains("\n- ")).count();
        let items = self.text.lines().filter(|line| line.starts_with("- ")).count();
        let paragraphs = self.text.split("\n\n").count();
        let [paragraphs, lists, items] = if is_whole { [paragraphs, lists, items] } else { [1, 0, 0] };
        FRAME + PARAGRAPH * paragraphs as f64 + LIST * lists as f64 + ITEM * items as f64
    }

    /// Logs it.
    pub(crate) fn log(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        let Some(path) = self.path() else { return Ok(()) };
        stream.log_static(path, &TextDocument::from_markdown(self.text.as_str()))
    }
}

/// The text for `runs`: the outcomes of all in one line, the only one on pages other than the first, then the reasons, a line each.
fn text(runs: &[(Option<&str>, &Verdict)]) -> String {
    let outcome = |(label, verdict): &(Option<&str>, &Verdict)| {
        let of = label.map_or(String::new(), |label| format!("{}: ", escaped(label)));
        let outcome = match verdict.outcome {
            Outcome::Passed => "passed",
            Outcome::Failed => "**FAILED**",
            Outcome::Unjudged => "no limits",
        };
        format!("{of}{outcome}")
    };
    let mut text = runs.iter().map(outcome).collect::<Vec<_>>().join(" · ");
    for (label, verdict) in runs {
        let reasons = verdict.reasons.iter().map(|reason| format!("\n- {}", escaped(reason)));
        let warnings = verdict.warnings.iter().map(|warning| format!("\n- warning: {}", escaped(warning)));
        let lines: String = reasons.chain(warnings).collect();
        if let Some(label) = label.filter(|_| !lines.is_empty()) {
            text.push_str("\n\n");
            text.push_str(&escaped(label));
        }
        text.push_str(&lines);
    }
    text
}

/// `text` in one line in which Markdown sees no marks but those of code.
fn escaped(text: &str) -> String {
    let mut is_code = false;
    let mut escaped = String::new();
    for sign in text.chars() {
        is_code ^= sign == '`';
        if !is_code && matches!(sign, '*' | '_' | '<' | '[' | '#' | '\\' | '~' | '|') {
            escaped.push('\\');
        }
        escaped.push(if sign.is_control() { ' ' } else { sign });
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fails_is_said_in_lines_of_its_own() {
        let verdict = Verdict {
            outcome: Outcome::Failed,
            reasons: vec!["settling_time 35.2 ms, limit 20.0 ms".into(), "executed: `a_b` was\nnot".into()],
            warnings: vec!["a * b".into()],
        };
        let lines = "\n- settling\\_time 35.2 ms, limit 20.0 ms\n- executed: `a_b` was not\n- warning: a \\* b";
        assert_eq!(text(&[(None, &verdict)]), format!("**FAILED**{lines}"));
        assert_eq!(text(&[(None, &Verdict::default())]), "no limits");
        let passed = Verdict { outcome: Outcome::Passed, ..Verdict::default() };
        let of_three = text(&[(Some("jerk"), &passed), (Some("snap"), &verdict), (Some("a_c"), &passed)]);
        assert_eq!(of_three, format!("jerk: passed · snap: **FAILED** · a\\_c: passed\n\nsnap{lines}"));
    }
}
