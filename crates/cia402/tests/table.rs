//! Pages of `docs/` with tables made of the source. `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-cia402` writes them.
use servobench_cia402::objects::{Access, Admitted, Contents, Entry, NODE_ID, OBJECTS, ObjectDescription};
use servobench_cia402::{AbortCode, ErrorCode, Source, TRANSITIONS};
use std::fmt::Write as _;
use std::path::Path;

const WRITE_DOCS: &str = "SERVOBENCH_WRITE_DOCS";

#[test]
fn the_page_lists_every_transition() {
    hold("cia402.md", "transitions", &transitions());
}

#[test]
fn the_page_lists_every_object() {
    hold("objects.md", "objects", &objects());
}

#[test]
fn the_page_lists_every_process_data_object() {
    let mut table = String::from("| PDO | parameters | COB-ID | mapping | objects |\n|---|---|---|---|---|\n");
    let entries = |index: u16| OBJECTS.iter().find(|object| object.index == index).unwrap().entries();
    for (kind, first) in [("RPDO", 0x1400), ("TPDO", 0x1800)] {
        for number in 0..5 {
            let (parameters, mapping) = (first + number, first + 0x200 + number);
            let mapped: Vec<_> = entries(mapping).iter().map(|entry| format!("{:04X}h", entry.default >> 16)).collect();
            // Bits 30 and 31 are not part of the identifier.
            let identifier = match entries(parameters)[0].default & 0x7FF {
                0 => "not valid".into(),
                identifier => format!("{:X}h + node-ID", identifier - i64::from(NODE_ID)),
            };
            let (number, mapped) = (number + 1, mapped.join(", "));
            writeln!(table, "| {kind} {number} | {parameters:04X}h | {identifier} | {mapping:04X}h | {mapped} |")
                .unwrap();
        }
    }
    hold("objects.md", "process data objects", &table);
}

#[test]
fn the_page_lists_every_abort_code() {
    let mut table = String::from("| code | text |\n|---|---|\n");
    for code in AbortCode::ALL {
        writeln!(table, "| {code} | {} |", code.text()).unwrap();
    }
    hold("objects.md", "abort codes", &table);
}

#[test]
fn the_page_lists_every_error_code() {
    let mut table = String::from("| code | error | given by | 1001h | when |\n|---|---|---|---|---|\n");
    for error in ErrorCode::ALL {
        let (source, register) = match error.source() {
            Source::Drive { register } => ("drive", format!("{register:02X}h")),
            Source::Link => ("link", "–".into()),
        };
        let (code, text, when) = (error.code(), error.text(), error.when());
        writeln!(table, "| {code:04X}h | {text} | {source} | {register} | {when} |").unwrap();
    }
    hold("objects.md", "error codes", &table);
}

/// Compares a section of a page with its source, or writes it.
fn hold(page: &str, section: &str, table: &str) {
    // Several tests may write to one page.
    static PAGES: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let _alone = PAGES.lock();
    let (begin, end) = (format!("<!-- generated: {section} -->\n"), format!("<!-- end of generated {section} -->\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(page);
    let text = std::fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(&begin).unwrap();
    let (written, after) = rest.split_once(&end).unwrap();
    if std::env::var_os(WRITE_DOCS).is_some() {
        std::fs::write(&path, format!("{before}{begin}{table}{end}{after}")).unwrap();
    } else {
        assert!(written == table, "run the tests of this crate with {WRITE_DOCS}=1");
    }
}

fn transitions() -> String {
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

fn objects() -> String {
    let mut table = String::from("| object | name | type | access | PDO | default | values | unit |\n");
    table += "|---|---|---|---|---|---|---|---|\n";
    let is_of_pdo = |object: &&ObjectDescription| (0x1400..0x1C00).contains(&object.index);
    for object in OBJECTS.iter().filter(|object| !is_of_pdo(object)) {
        if let Contents::Text(text) = object.contents {
            let (index, name) = (object.index, object.name);
            writeln!(table, "| {index:04X}h | {name} | VISIBLE_STRING | const | – | {text} | – | – |").unwrap();
            continue;
        }
        let is_list_of_constants = object.entries().iter().all(|entry| entry.access == Access::Constant);
        if is_list_of_constants && object.entries().len() > 4 {
            let values: Vec<String> = object.entries().iter().map(|entry| number(entry.default)).collect();
            row(&mut table, object, &format!(":1–{}", values.len()), &object.entries()[0], &values.join(", "));
            continue;
        }
        for (subindex, entry) in (object.first_subindex()..).zip(object.entries()) {
            let subindex = if subindex == 0 { String::new() } else { format!(":{subindex}") };
            row(&mut table, object, &subindex, entry, &default(entry));
        }
    }
    table
}

fn row(table: &mut String, object: &ObjectDescription, subindex: &str, entry: &Entry, default: &str) {
    let index = object.index;
    let name = if object.name == entry.name { object.name.into() } else { format!("{}: {}", object.name, entry.name) };
    let footnote = match entry.governs {
        _ if entry.disabled_only => "¹",
        Some(_) => "²",
        None => "",
    };
    let access = entry.access.abbreviation().to_owned() + footnote;
    let (data_type, pdo) = (entry.data_type.name(), or_dash(entry.mapping.abbreviation()));
    let (values, unit) = (values(entry), or_dash(entry.unit));
    writeln!(
        table,
        "| {index:04X}h{subindex} | {name} | {data_type} | {access} | {pdo} | {default} | {values} | {unit} |"
    )
    .unwrap();
}

/// Long bounds read better as powers of two.
fn default(entry: &Entry) -> String {
    match entry.default {
        0xFFFF_FFFF => "2³² − 1".into(),
        value if value == i64::from(i32::MIN) => "−2³¹".into(),
        value if value == i64::from(i32::MAX) => "2³¹ − 1".into(),
        0x2_0192 => "00020192h".into(),
        value => number(value),
    }
}

/// With a minus sign.
fn number(value: i64) -> String {
    value.to_string().replace('-', "−")
}

fn values(entry: &Entry) -> String {
    match entry.admitted {
        Admitted::Any => "–".into(),
        Admitted::Range(lowest, highest) if i128::from(highest) == entry.data_type.highest() => {
            format!("{} and more", number(lowest))
        }
        Admitted::Range(lowest, highest) if lowest == highest => number(lowest),
        Admitted::Range(lowest, highest) => format!("{} to {}", number(lowest), number(highest)),
        Admitted::OneOf(accepted) => accepted.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", "),
        Admitted::Bits(bits) => format!("bits {bits:02X}h"),
    }
}

fn or_dash(text: &str) -> String {
    if text.is_empty() { "–".into() } else { text.into() }
}
