//! Memory of an instance, by its declarations.
use crate::pou::{Pou, SectionKind};

/// Size and alignment in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Layout {
    size: usize,
    alignment: usize,
}

/// Bytes of an instance of the function block `name`, with each variable at a multiple of its own size as in the layout of most
/// controllers. Temporary variables are on the stack and not counted.
///
/// # Panics
/// If the text does not have a type of that name.
pub(crate) fn instance(pous: &[Pou], name: &str) -> usize {
    block(pous, name).size
}

fn block(pous: &[Pou], name: &str) -> Layout {
    let pou = pous.iter().find(|pou| pou.name == name).unwrap_or_else(|| panic!("there is no type {name}"));
    let mut whole = Layout { size: 0, alignment: 1 };
    for section in pou.sections.iter().filter(|section| section.kind != SectionKind::Temporary) {
        for variable in &section.variables {
            let Layout { size, alignment } = elementary(variable.type_name)
                .map_or_else(|| block(pous, variable.type_name), |size| Layout { size, alignment: size });
            whole.size = whole.size.next_multiple_of(alignment) + size;
            whole.alignment = whole.alignment.max(alignment);
        }
    }
    Layout { size: whole.size.next_multiple_of(whole.alignment), ..whole }
}

/// Size of an elementary type (bytes).
fn elementary(name: &str) -> Option<usize> {
    Some(match name {
        "BOOL" | "SINT" => 1,
        "INT" => 2,
        "DINT" => 4,
        "LINT" | "LREAL" => 8,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pou::read;

    /// By hand: BOOL at 0, LREAL at 8, INT at 16, its block (two LREAL) at 24, rounded up to 40.
    #[test]
    fn variables_lie_at_multiples_of_their_size() {
        let text = "FUNCTION_BLOCK In\nVAR\n    a : LREAL;\n    b : LREAL;\nEND_VAR\nVAR_TEMP\n    t : LREAL;\nEND_VAR\nEND_FUNCTION_BLOCK\n\
                    FUNCTION_BLOCK Out\nVAR_INPUT\n    f : BOOL;\n    x : LREAL;\n    n : INT;\n    in : In;\nEND_VAR\nEND_FUNCTION_BLOCK\n";
        assert_eq!(instance(&read(text), "Out"), 40);
        assert_eq!(instance(&read(text), "In"), 16);
    }
}
