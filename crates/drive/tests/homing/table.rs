//! `docs/homing.md` holds the table of the methods. `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-drive` writes it.
use servobench_drive::modes::homing::{Method, Start};
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";
const BEGIN: &str = "<!-- generated: methods -->\n";
const END: &str = "<!-- end of generated methods -->\n";

#[test]
fn the_page_lists_every_method() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/homing.md");
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
    let mut table = String::from(
        "| no. | switch | start with the switch off | start with the switch on | a limit switch is met first |\n|---|---|---|---|---|\n",
    );
    for method in Method::all() {
        let (number, switch) = (method.number(), method.switch().map_or("–", |switch| switch.name()));
        let (off, on) = (legs(&method, Start::Off), legs(&method, Start::On));
        let at_limit = if method.turns_at_limit() { legs(&method, Start::AtLimit) } else { "error".into() };
        let on = if method.switch().is_some() { on } else { "–".into() };
        let at_limit = if off == "here" { "–".into() } else { at_limit };
        writeln!(table, "| {number} | {switch} | {off} | {on} | {at_limit} |").unwrap();
    }
    table
}

/// The legs, the one that finds the reference in bold.
fn legs(method: &Method, start: Start) -> String {
    let mut legs: Vec<String> =
        (0..).map_while(|number| method.leg(start, number)).map(|leg| leg.to_string()).collect();
    let Some(last) = legs.last_mut() else { return "here".into() };
    *last = format!("**{last}**");
    legs.join(", ")
}
