//! Interface and memory of the blocks in `docs/plc-export.md`, written by
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-structured-text`.
use crate::pou::{self, Section, SectionKind};
use crate::{BLOCKS, instances};
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

#[test]
fn the_page_lists_interface_and_memory() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/plc-export.md");
    let written = std::fs::read_to_string(&path).unwrap();
    let parts = [("interface", interface()), ("memory", memory())];
    let page = parts.iter().fold(written.clone(), |page, (name, table)| replaced(&page, name, table));
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, page).unwrap();
    } else {
        assert!(written == page, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}

/// Returns `page` with `table` between the marks of `name`.
fn replaced(page: &str, name: &str, table: &str) -> String {
    let (begin, end) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end of generated {name} -->\n"));
    let (before, rest) = page.split_once(&begin).unwrap();
    let (_, after) = rest.split_once(&end).unwrap();
    format!("{before}{begin}{table}{end}{after}")
}

fn interface() -> String {
    let mut table = String::from("| block | | name | type | meaning |\n|---|---|---|---|---|\n");
    for pou in pou::read(include_str!("profile_4th.st")).iter().filter(|pou| BLOCKS.contains(&pou.name)) {
        let mut name = format!("`{}`", pou.name);
        for Section { kind, variables } in &pou.sections {
            let mut way = match kind {
                SectionKind::Input => "in",
                SectionKind::Output => "out",
                SectionKind::Local | SectionKind::Temporary => continue,
            };
            for variable in variables {
                let (own, kind, meaning) = (variable.name, variable.type_name, variable.meaning);
                writeln!(table, "| {name} | {way} | `{own}` | {kind} | {meaning} |").unwrap();
                name.clear();
                way = "";
            }
        }
    }
    table
}

fn memory() -> String {
    let mut table = String::from("| block | an instance takes |\n|---|---|\n");
    for (name, bytes) in instances() {
        writeln!(table, "| `{name}` | {bytes} bytes |").unwrap();
    }
    table
}
