//! `docs/plcopen.md` holds the tables of the arrows, the ErrorIDs and the outputs.
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-plcopen` writes them.
use servobench_plcopen::{ARROWS, BlockName, ErrorId};
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

#[test]
fn the_page_lists_every_arrow_every_error_and_every_output() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/plcopen.md");
    let written = std::fs::read_to_string(&path).unwrap();
    let parts = [("arrows", arrows()), ("errors", errors()), ("outputs", outputs())];
    let page = parts.iter().fold(written.clone(), |page, (name, table)| replaced(&page, name, table));
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, page).unwrap();
    } else {
        assert!(written == page, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}

/// `page` with `table` between the marks of `name`.
fn replaced(page: &str, name: &str, table: &str) -> String {
    let (begin, end) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end of generated {name} -->\n"));
    let (before, rest) = page.split_once(&begin).unwrap();
    let (_, after) = rest.split_once(&end).unwrap();
    format!("{before}{begin}{table}{end}{after}")
}

fn arrows() -> String {
    let mut table = String::from("| no. | from | to | cause |\n|---|---|---|---|\n");
    for arrow in &ARROWS {
        let from: Vec<&str> = arrow.from.iter().map(|state| state.name()).collect();
        let causes: Vec<&str> = arrow.causes.iter().map(|cause| cause.name()).collect();
        let (number, to) = (arrow.number, arrow.to);
        writeln!(table, "| {number} | {} | {to} | {} |", from.join(", "), causes.join(", ")).unwrap();
    }
    table
}

fn errors() -> String {
    let mut table = String::from("| ErrorID | meaning |\n|---|---|\n");
    for id in ErrorId::ALL {
        writeln!(table, "| 16#{:04X} | {} |", id.number(), id.meaning()).unwrap();
    }
    table
}

fn outputs() -> String {
    let mut table = String::from("| block | outputs |\n|---|---|\n");
    for block in BlockName::ALL {
        let names: Vec<&str> = block.outputs().iter().map(|output| output.name()).collect();
        writeln!(table, "| {block} | {} |", names.join(", ")).unwrap();
    }
    table
}

#[test]
fn no_two_errors_share_a_number() {
    for (place, id) in ErrorId::ALL.iter().enumerate() {
        assert!(ErrorId::ALL[..place].iter().all(|other| other.number() != id.number()), "{id:?}");
    }
}
