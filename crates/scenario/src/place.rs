//! Diagnostics of mistakes found after loading, with the key that caused them or a line of the MJCF file.
use crate::diagnostic::Diagnostic;
use crate::load::Loaded;
use crate::source::{SourceId, Sources, Span};
use crate::tree::{Node, Value};

impl Loaded {
    /// A diagnostic for the value of `key`, a path like `axis.mjcf.file` or `program.0.duration`. Its place is the innermost part of
    /// the path that the files contain.
    #[must_use]
    pub fn mistake(&self, key: &str, message: String, help: String) -> Diagnostic {
        Diagnostic::new(self.place_of(key), message, help)
    }

    /// A diagnostic for a line, from 1, of the MJCF file that the scenario names; the help contains the place that names the file. Without
    /// such a file the diagnostic is at the key `axis.mjcf.file`.
    #[must_use]
    pub fn mistake_in_mjcf(&self, line: u32, message: String, help: &str) -> Diagnostic {
        let key = "axis.mjcf.file";
        let Some(source) = self.mjcf else { return self.mistake(key, message, help.to_owned()) };
        let named = self.place_of(key);
        let place = self.sources.place_in_words(named.source, named.start);
        let help = format!("{place} names this file; {help}");
        Diagnostic::new(line_of(&self.sources, source, line), message, help)
    }

    fn place_of(&self, key: &str) -> Span {
        let (mut node, mut rest) = (&self.root, key);
        while !rest.is_empty() {
            // Indices of objects contain points: "6099h.1".
            let whole = inner(node, rest).map(|found| (found, ""));
            let (part, behind) = rest.split_once('.').unwrap_or((rest, ""));
            let Some(next) = whole.or_else(|| inner(node, part).map(|found| (found, behind))) else { break };
            (node, rest) = next;
        }
        node.span
    }
}

/// The part `key` of `node`.
fn inner<'a>(node: &'a Node, key: &str) -> Option<&'a Node> {
    match &node.value {
        Value::Table(table) => table.get(key),
        Value::Array(items) => key.parse().ok().and_then(|index: usize| items.get(index)),
        _ => None,
    }
}

/// The contents of a line, from 1, of a file; the end of the file if it has fewer lines.
fn line_of(sources: &Sources, source: SourceId, number: u32) -> Span {
    let text = sources.text(source);
    let before = text.split_inclusive('\n').take(number.saturating_sub(1) as usize).map(str::len).sum();
    let line = text[before..].lines().next().unwrap_or_default();
    let start = before + (line.len() - line.trim_start().len());
    Span::new(source, &(start..start.max(before + line.trim_end().len())))
}

#[cfg(test)]
mod tests {
    use crate::{Loaded, parse};

    const TEXT: &str = r#"[run]
base_rate = "4 kHz"
[axis]
motion = "linear"
motor_side.mass = "20 kg"
[motor]
kind = "prescribed"
[[program]]
wait = "1 s"
[[program]]
wait = "2 s"
"#;

    fn place(loaded: &Loaded, key: &str) -> String {
        loaded.mistake(key, "x".into(), String::new()).line(&loaded.sources)
    }

    #[test]
    fn keys_are_found_as_far_as_they_are_there() {
        let loaded = parse("a.toml", TEXT, None).unwrap();
        for (key, expected) in [
            ("run.base_rate", "a.toml:2:13: x"),
            ("axis.motor_side.mass", "a.toml:5:19: x"),
            ("program.1.wait", "a.toml:11:8: x"),
            ("program.1.duration", "a.toml:10:1: x"),
            ("program.7.wait", "a.toml:8:1: x"),
            ("axis.mjcf.file", "a.toml:3:1: x"),
            ("record.channels", "a.toml:1:1: x"),
        ] {
            assert_eq!(place(&loaded, key), expected, "{key}");
        }
    }

    #[test]
    fn lines_of_the_mjcf_file_say_where_it_is_named() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("arm.xml"), "<mujoco>\n  <equality/>\n</mujoco>\n").unwrap();
        let mjcf = "mjcf = { file = \"arm.xml\", motor_joint = \"m\", load_joint = \"l\", actuator = \"u\" }";
        let text = TEXT.replace("motor_side.mass = \"20 kg\"", mjcf);
        let loaded = parse("a.toml", &text, Some(folder.path())).unwrap();
        let found = loaded.mistake_in_mjcf(2, "no".into(), "change it");
        let xml = loaded.sources.text(found.source);
        assert_eq!(&xml[found.span.clone()], "<equality/>");
        assert_eq!(found.help.as_deref(), Some("a.toml:5:17 names this file; change it"));
        let beyond = loaded.mistake_in_mjcf(9, "no".into(), "change it");
        assert_eq!(beyond.span, xml.len()..xml.len());
    }
}
