//! What came of a run, in words: the head of every page.
use crate::options::{Outcome, Verdict, ViewOptions};
use crate::run::Run;
use rerun::{EntityPath, RecordingStream, RecordingStreamResult, TextDocument};

/// Its entity.
const PATH: &str = "verdict";

/// The text that stands above everything.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    /// Which runs: `vibration-snap on exact`.
    pub(crate) subject: String,
    /// Markdown, a line or more for each run; empty where nothing was recorded.
    text: String,
}

impl Head {
    /// The head of `runs`, of which `subject` says what they are.
    pub(crate) fn of(subject: String, runs: &[Run<'_>], options: &ViewOptions) -> Self {
        let is_empty = |run: &Run<'_>| run.recording.is_empty() && run.recording.signals.is_empty();
        let text = if runs.iter().all(is_empty) {
            String::new()
        } else if options.verdicts.is_empty() {
            "no verdict is known".to_owned()
        } else {
            let paragraphs = runs.iter().zip(&options.verdicts).map(|(run, verdict)| paragraph(run.label, verdict));
            paragraphs.collect::<Vec<_>>().join("\n\n")
        };
        Self { subject, text }
    }

    /// Its entity; `None` when there is nothing to say.
    pub(crate) fn path(&self) -> Option<EntityPath> {
        (!self.text.is_empty()).then(|| EntityPath::from(PATH))
    }

    /// How many lines it has.
    pub(crate) fn lines(&self) -> usize {
        self.text.lines().filter(|line| !line.is_empty()).count()
    }

    /// Logs it.
    pub(crate) fn log(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        let Some(path) = self.path() else { return Ok(()) };
        stream.log_static(path, &TextDocument::from_markdown(self.text.as_str()))
    }
}

/// What is said of one run: the outcome, then why, a line each.
fn paragraph(label: Option<&str>, verdict: &Verdict) -> String {
    let of = label.map_or(String::new(), |label| format!("{}: ", escaped(label)));
    let reasons = verdict.reasons.iter().map(|reason| format!("- {}", escaped(reason)));
    let warnings = verdict.warnings.iter().map(|warning| format!("- warning: {}", escaped(warning)));
    let outcome = match verdict.outcome {
        Outcome::Passed => "passed",
        Outcome::Failed => "**FAILED**",
        Outcome::Unjudged => "no limits",
    };
    let lines = std::iter::once(format!("{of}{outcome}")).chain(reasons).chain(warnings);
    lines.collect::<Vec<_>>().join("\n")
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
        let expected = "jerk: **FAILED**\n- settling\\_time 35.2 ms, limit 20.0 ms\n- executed: `a_b` was not\n\
                        - warning: a \\* b";
        assert_eq!(paragraph(Some("jerk"), &verdict), expected);
        assert_eq!(paragraph(None, &Verdict::default()), "no limits");
    }
}
