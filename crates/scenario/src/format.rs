//! The format number of a scenario file: it increases when the meaning of a valid file changes.
//!
//! | format | meaning |
//! |---|---|
//! | 1 | a run passes when every limit is kept |
//! | 2 | a run must also meet requirements, unless `[requirements]` lifts them |
use crate::diagnostic::{Diagnostic, Report};
use crate::tree::{Node, Table, Value};

/// The newest format, and the default.
pub(crate) const FORMAT: u32 = 2;

/// Reason why a file of a newer format cannot be read; `None` for a format that this build reads.
pub(crate) fn newer(root: &Table) -> Option<Diagnostic> {
    let (node, number) = number(root)?;
    (number > i64::from(FORMAT)).then(|| {
        let known: Vec<String> = (1..=FORMAT).map(|known| known.to_string()).collect();
        let known = known.join(" and ");
        let message = format!("format {number} is newer than this build, which reads {known}");
        Diagnostic::new(node.span, message, "run it with the servobench that it was written for, or a later one".into())
    })
}

/// Warns of the changed meaning of a file of an older format.
pub(crate) fn warn_of_older(root: &Table, report: &mut Report) {
    let Some((node, 1)) = number(root) else { return };
    let message = "format 1: a run passed if it kept its limits; since format 2 it must also meet requirements (arrives, \
                   executed, no_fault, stable, bounded) and may fail where it passed";
    report.warning(
        node.span,
        message,
        "lift the requirements that are not meant, by name in `[requirements]`, and write `format = 2`",
    );
}

fn number(root: &Table) -> Option<(&Node, i64)> {
    let node = root.get("format")?;
    let Value::Number(number) = &node.value else { return None };
    Some((node, number.whole?))
}

#[cfg(test)]
mod tests {
    use crate::{LoadError, parse};

    const TEXT: &str = "run.base_rate = \"12 kHz\"\naxis = { motion = \"linear\", motor_side.mass = \"21 kg\" }\n\
                        motor.kind = \"prescribed\"\n";

    fn said(text: &str) -> Vec<String> {
        match parse("a.toml", text, None) {
            Ok(loaded) => loaded.warnings.iter().map(|warning| warning.line(&loaded.sources)).collect(),
            Err(LoadError::Invalid(invalid)) => vec![invalid.to_string()],
            Err(error) => panic!("{error}"),
        }
    }

    #[test]
    fn without_a_number_a_file_has_the_newest_format() {
        assert_eq!(said(TEXT), [""; 0]);
        assert_eq!(said(&format!("format = 2\n{TEXT}")), [""; 0]);
    }

    #[test]
    fn an_older_format_is_read_with_a_warning_that_says_what_has_changed() {
        let said = said(&format!("format = 1\n{TEXT}"));
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(
            said[0].starts_with("a.toml:1:10: format 1: ") && said[0].contains("must also meet requirements"),
            "{said:?}"
        );
    }

    /// No further mistakes are reported: keys of a later format are not mistakes.
    #[test]
    fn a_newer_format_is_refused_by_its_number() {
        let expected = "a.toml:1:10: format 7 is newer than this build, which reads 1 and 2; run it with the servobench that it \
                        was written for, or a later one";
        assert_eq!(said(&format!("format = 7\nteleport = true\n{TEXT}")), [expected]);
    }

    #[test]
    fn what_is_no_number_of_a_format_is_a_mistake() {
        for wrong in ["0", "-1", "1.5", "\"2\"", "true"] {
            let said = said(&format!("format = {wrong}\n{TEXT}"));
            assert!(said[0].starts_with("a.toml:1:10: `format` must be a whole number from 1 to 2"), "{said:?}");
        }
    }
}
