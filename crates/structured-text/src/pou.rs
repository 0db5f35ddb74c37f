//! Declarations of the text: program organization units (POUs) with their variables and bodies.
//!
//! The parser only has to read the one text of this crate, so that a line that it does not understand is a defect of that text: it panics,
//! and a test reads the whole text.

/// A function or a function block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pou<'t> {
    pub(crate) name: &'t str,
    /// Type of a function's result; `None` for a function block.
    pub(crate) returns: Option<&'t str>,
    pub(crate) sections: Vec<Section<'t>>,
    /// The statements.
    pub(crate) body: &'t str,
}

/// Variables between a keyword and `END_VAR`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Section<'t> {
    pub(crate) kind: SectionKind,
    pub(crate) variables: Vec<Variable<'t>>,
}

/// Kind of the variables in a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SectionKind {
    Input,
    Output,
    Local,
    Temporary,
}

impl SectionKind {
    const ALL: [(&'static str, Self); 4] =
        [("VAR_INPUT", Self::Input), ("VAR_OUTPUT", Self::Output), ("VAR", Self::Local), ("VAR_TEMP", Self::Temporary)];

    /// Keyword that begins the section.
    pub(crate) fn keyword(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(keyword, _)| keyword)
    }
}

/// A declared variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Variable<'t> {
    pub(crate) name: &'t str,
    pub(crate) type_name: &'t str,
    pub(crate) initial: Option<&'t str>,
    /// Meaning; empty for a variable that no caller sees.
    pub(crate) meaning: &'t str,
}

impl<'t> Pou<'t> {
    /// Variables of all sections.
    pub(crate) fn variables(&self) -> impl Iterator<Item = &Variable<'t>> {
        self.sections.iter().flat_map(|section| &section.variables)
    }

    /// Keyword that begins the unit, and with `END_` in front ends it.
    pub(crate) const fn keyword(&self) -> &'static str {
        if self.returns.is_some() { "FUNCTION" } else { "FUNCTION_BLOCK" }
    }
}

/// Every POU of `text`, in its order.
///
/// # Panics
/// If `text` does not follow the rules of this crate's text: one declaration a line.
pub(crate) fn read(text: &str) -> Vec<Pou<'_>> {
    let mut pous = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        let (head, after) = rest.split_once('\n').unwrap_or((rest, ""));
        let (keyword, name) = head.split_once(' ').unwrap_or((head, ""));
        assert!(matches!(keyword, "FUNCTION" | "FUNCTION_BLOCK"), "not the head of a function or a block: {head}");
        let end = format!("END_{keyword}\n");
        let (content, after) = after.split_once(&end).unwrap_or_else(|| panic!("{name} has no {end}"));
        let (name, returns) = name.split_once(" : ").map_or((name, None), |(name, returns)| (name, Some(returns)));
        let (sections, body) = sections(content);
        pous.push(Pou { name, returns, sections, body });
        rest = after.trim_start();
    }
    pous
}

/// Sections at the beginning of `content`, and the rest.
fn sections(content: &str) -> (Vec<Section<'_>>, &str) {
    let (mut sections, mut rest) = (Vec::new(), content);
    while let Some((head, after)) = rest.split_once('\n')
        && let Some((_, kind)) = SectionKind::ALL.iter().find(|(keyword, _)| *keyword == head)
    {
        let (declarations, after) = after.split_once("END_VAR\n").unwrap_or_else(|| panic!("{head} has no END_VAR"));
        sections.push(Section { kind: *kind, variables: declarations.lines().map(variable).collect() });
        rest = after;
    }
    (sections, rest)
}

/// `name : TYPE := initial (* meaning *);`
fn variable(line: &str) -> Variable<'_> {
    let declaration = line.trim().strip_suffix(';').unwrap_or_else(|| panic!("not a declaration: {line}"));
    let (name, rest) = declaration.split_once(" : ").unwrap_or_else(|| panic!("not a declaration: {line}"));
    let (rest, meaning) = rest.split_once(" (* ").unwrap_or((rest, ""));
    let (type_name, initial) = rest.split_once(" := ").map_or((rest, None), |(name, initial)| (name, Some(initial)));
    Variable { name, type_name, initial, meaning: meaning.trim_end_matches(" *)") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_read() {
        let text = "FUNCTION_BLOCK B\nVAR_INPUT\n    x : LREAL := 0.5 (* in m *);\n    f : BOOL;\nEND_VAR\nVAR\n    g : F;\nEND_VAR\n\
                    y := x;\nEND_FUNCTION_BLOCK\n\nFUNCTION F : INT\nF := 1;\nEND_FUNCTION\n";
        let pous = read(text);
        let x = Variable { name: "x", type_name: "LREAL", initial: Some("0.5"), meaning: "in m" };
        assert_eq!(pous[0].variables().next(), Some(&x));
        assert_eq!(
            pous[0].sections.iter().map(|section| section.kind.keyword()).collect::<Vec<_>>(),
            ["VAR_INPUT", "VAR"]
        );
        assert_eq!((pous[0].name, pous[0].keyword(), pous[0].body), ("B", "FUNCTION_BLOCK", "y := x;\n"));
        assert_eq!((pous[1].name, pous[1].keyword(), pous[1].returns), ("F", "FUNCTION", Some("INT")));
    }

    #[test]
    #[should_panic(expected = "not a declaration: x")]
    fn a_line_that_declares_nothing_is_a_defect() {
        read("FUNCTION_BLOCK B\nVAR\nx\nEND_VAR\nEND_FUNCTION_BLOCK\n");
    }
}
