//! Structured Control Language: the text of an external source for TIA Portal.
//!
//! The language is that of the standard except for its notation: POUs in quotes, `#` before each local variable, `BEGIN` before the
//! statements, temporary variables in functions, names of types in mixed case.
use crate::pou::{Pou, SectionKind};
use std::fmt::Write as _;

/// All POUs as a source.
pub(crate) fn text(pous: &[Pou]) -> String {
    pous.iter().map(|pou| unit(pous, pou)).collect::<Vec<_>>().join("\n")
}

fn unit(pous: &[Pou], pou: &Pou) -> String {
    let (keyword, name) = (pou.keyword(), pou.name);
    let mut text = match pou.returns {
        Some(returns) => format!("{keyword} \"{name}\" : {}\n", type_name(returns)),
        None => format!("{keyword} \"{name}\"\n"),
    };
    text.push_str("{ S7_Optimized_Access := 'TRUE' }\nVERSION : 0.1\n");
    for section in &pou.sections {
        // A function keeps no state: it only has temporary variables.
        let kind = match section.kind {
            SectionKind::Local if pou.returns.is_some() => SectionKind::Temporary,
            kind => kind,
        };
        let _ = writeln!(text, "{}", kind.keyword());
        for variable in &section.variables {
            let initial = variable.initial.map(|initial| format!(" := {initial}")).unwrap_or_default();
            let meaning =
                if variable.meaning.is_empty() { String::new() } else { format!("  // {}", variable.meaning) };
            let _ = writeln!(text, "    {} : {}{initial};{meaning}", variable.name, type_name(variable.type_name));
        }
        text.push_str("END_VAR\n");
    }
    let _ = write!(text, "BEGIN\n{}END_{keyword}\n", body(pous, pou));
    text
}

fn type_name(name: &str) -> String {
    match name {
        "BOOL" => "Bool".into(),
        "SINT" => "SInt".into(),
        "INT" => "Int".into(),
        "LREAL" => "LReal".into(),
        block => format!("\"{block}\""),
    }
}

/// Statements, with variables and POUs marked.
fn body(pous: &[Pou], pou: &Pou) -> String {
    let (mut text, mut rest, mut depth) = (String::new(), pou.body, 0_usize);
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("(*") {
            rest.find("*)").map_or(rest.len(), |end| end + 2)
        } else if first.is_ascii_alphabetic() || first.is_ascii_digit() {
            rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        match token {
            "(" => depth += 1,
            ")" => depth = depth.saturating_sub(1),
            _ => {}
        }
        let is_assigned = after.trim_start().starts_with(":=");
        // A member belongs to its instance, an input to the call that names it.
        let is_of_another = text.ends_with('.') || (depth > 0 && is_assigned);
        let is_local = pou.variables().any(|variable| variable.name == token) || (token == pou.name && is_assigned);
        if is_local && !is_of_another {
            text.push('#');
            text.push_str(token);
        } else if pous.iter().any(|pou| pou.name == token) {
            let _ = write!(text, "\"{token}\"");
        } else {
            text.push_str(token);
        }
        rest = after;
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::pou::read;

    #[test]
    fn variables_and_units_are_marked_and_inputs_of_calls_are_not() {
        let text = "FUNCTION F : LREAL\nVAR_INPUT\n    x : LREAL (* a number *);\nEND_VAR\nVAR\n    E : LREAL;\nEND_VAR\n\
                    (* x is not E *)\nE := x + 1.0E-3;\nF := E;\nEND_FUNCTION\n\
                    FUNCTION_BLOCK B\nVAR\n    x : LREAL := 0.5;\n    g : G;\nEND_VAR\nx := F(x := x);\ng(x := (x), y := x);\nx := g.x;\n\
                    END_FUNCTION_BLOCK\nFUNCTION_BLOCK G\nEND_FUNCTION_BLOCK\n";
        let expected = "FUNCTION \"F\" : LReal\n{ S7_Optimized_Access := 'TRUE' }\nVERSION : 0.1\nVAR_INPUT\n    x : LReal;  // a number\n\
                        END_VAR\nVAR_TEMP\n    E : LReal;\nEND_VAR\nBEGIN\n(* x is not E *)\n#E := #x + 1.0E-3;\n#F := #E;\nEND_FUNCTION\n\n\
                        FUNCTION_BLOCK \"B\"\n{ S7_Optimized_Access := 'TRUE' }\nVERSION : 0.1\nVAR\n    x : LReal := 0.5;\n    g : \"G\";\n\
                        END_VAR\nBEGIN\n#x := \"F\"(x := #x);\n#g(x := (#x), y := #x);\n#x := #g.x;\nEND_FUNCTION_BLOCK\n";
        let scl = super::text(&read(text));
        assert!(scl.starts_with(expected), "{scl}");
    }
}
