//! `docs/cia402.md` holds the table of the transitions. `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-cia402` writes it.
use servobench_cia402::TRANSITIONS;
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";
const BEGIN: &str = "<!-- generated: transitions -->\n";
const END: &str = "<!-- end of generated transitions -->\n";

#[test]
fn the_page_lists_every_transition() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cia402.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (written, after) = rest.split_once(END).unwrap();
    let table = table();
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
    } else {
        assert!(written == table, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}

fn table() -> String {
    let mut table = String::from("| no. | from | to | cause | condition | action |\n|---|---|---|---|---|---|\n");
    for transition in &TRANSITIONS {
        let from: Vec<&str> = transition.from.iter().map(|state| state.name()).collect();
        let causes: Vec<&str> = transition.causes.iter().map(|cause| cause.name()).collect();
        let (from, causes) = (or_dash(&from.join(", ")), causes.join(" or "));
        let (number, to, action) = (transition.number, transition.to, transition.action);
        let condition = or_dash(transition.condition);
        writeln!(table, "| {number} | {from} | {to} | {causes} | {condition} | {action} |").unwrap();
    }
    table
}

fn or_dash(text: &str) -> String {
    if text.is_empty() { "–".into() } else { text.into() }
}
