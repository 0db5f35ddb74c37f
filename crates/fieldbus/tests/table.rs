//! The page of `docs/` with tables made of the source. `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-fieldbus` writes them.
use servobench_cia402::{ErrorCode, Source};
use servobench_fieldbus::{Interpolation, LinkFault};
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

#[test]
fn the_page_lists_every_state_and_every_fault() {
    let mut states = String::from("| no. | state | meaning |\n|---|---|---|\n");
    for state in Interpolation::ALL {
        writeln!(states, "| {} | {} | {} |", state.number(), state.name(), state.meaning()).unwrap();
    }
    hold("states", &states);
    let mut faults = String::from("| code | fault | command to the drive |\n|---|---|---|\n");
    for fault in LinkFault::ALL {
        writeln!(faults, "| {:04X}h | {} | {} |", fault.code(), fault.name(), fault.response()).unwrap();
    }
    hold("faults", &faults);
}

/// Compares a section of the page with its source, or writes it.
fn hold(section: &str, table: &str) {
    let (begin, end) = (format!("<!-- generated: {section} -->\n"), format!("<!-- end of generated {section} -->\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/fieldbus.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once(&begin).unwrap();
    let (written, after) = rest.split_once(&end).unwrap();
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, format!("{before}{begin}{table}{end}{after}")).unwrap();
    } else {
        assert!(written == table, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}

/// The table of `docs/objects.md`: it has the faults of the link by their names, and no others as the link's.
#[test]
fn every_code_of_the_link_has_its_fault() {
    let of_link = |error: &&ErrorCode| error.source() == Source::Link;
    let mut listed: Vec<_> = ErrorCode::ALL.iter().filter(of_link).map(|error| (error.code(), error.text())).collect();
    let mut found = LinkFault::ALL.map(|fault| (fault.code(), fault.name()));
    listed.sort_unstable();
    found.sort_unstable();
    assert_eq!(listed, found);
}
