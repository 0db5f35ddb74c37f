//! Properties of the text in every dialect.
use super::*;
use crate::pou::{Pou, SectionKind};

const WRITTEN: &str = "2026-01-02T03:04:05Z";

fn export(dialect: Dialect, format: Format) -> Export<'static> {
    Export { dialect, format, times: Times { sample: 1e-3, settling: 0.0 }, move_block: MOVE }
}

fn text(dialect: Dialect, format: Format) -> String {
    export(dialect, format).text(WRITTEN).unwrap()
}

/// Returns `body` without its comments.
fn code(body: &str) -> String {
    let parts = body.split("(*").enumerate();
    parts.map(|(k, part)| if k == 0 { part } else { part.split_once("*)").unwrap().1 }).collect()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}

#[test]
fn the_text_is_as_short_and_as_small_as_it_has_to_be() {
    let text = text(Dialect::Iec, Format::St);
    assert!(text.lines().count() <= 900, "{}", text.lines().count());
    assert!(text.lines().all(|line| line.chars().count() <= 125));
    let [(_, profile), (_, absolute)] = instances();
    assert!(profile <= 3000 && absolute <= 3000, "{profile} {absolute}");
}

/// Oracle: counted by hand in the declarations. Profile4th: inputs 8 + 5·8 + 8 + 3·8 + 4 = 84 with their gaps, outputs, kept variables.
#[test]
fn memory_is_what_the_declarations_say() {
    // SINT at 0, pref to djerk_bnd at 8 to 40, TriggerEnable at 48, ActRefPos, Ts, T_set at 56 to 72, ProfileOrder at 80,
    // MotorReversed at 82; Position, Velocity, Acceleration, pref_add at 88 to 112, CmdDone at 120, Jerk, dJerk at 128 and 136,
    // Ready and Error at 144 and 145, ErrorID at 146; five BOOL at 148 to 152, two INT at 154 and 156, 19 LREAL from 160 on.
    assert_eq!(instances()[0], ("Profile4th", 160 + 19 * 8));
}

/// Loops are bounded: each is a FOR between constants.
#[test]
fn every_loop_has_a_constant_bound() {
    for pou in pou::read(include_str!("profile_4th.st")) {
        let code = code(pou.body);
        assert!(words(&code).all(|word| !matches!(word, "WHILE" | "REPEAT" | "GOTO" | "JMP")), "{}", pou.name);
        for line in code.lines().filter(|line| words(line).any(|word| word == "FOR")) {
            let (_, range) = line.split_once(" := ").unwrap();
            let (from, to) = range.strip_suffix(" DO").unwrap().split_once(" TO ").unwrap();
            assert!(from.parse::<u8>().is_ok() && to.parse::<u8>().is_ok(), "{line}");
        }
    }
}

/// Real numbers are LREAL, and integers have no type that a small controller lacks.
#[test]
fn there_are_few_types() {
    let source = include_str!("profile_4th.st");
    let pous = pou::read(source);
    for variable in pous.iter().flat_map(Pou::variables) {
        let known =
            matches!(variable.type_name, "LREAL" | "BOOL" | "INT" | "SINT") || variable.type_name == "Profile4th";
        assert!(known, "{}", variable.name);
    }
    assert!(words(source).all(|word| word != "REAL"));
}

/// Some front ends split a text at its keywords before they remove the comments.
#[test]
fn comments_have_no_words_of_the_language() {
    const STATEMENTS: [&str; 16] = [
        "if", "then", "else", "elsif", "case", "for", "while", "repeat", "until", "exit", "return", "end_if",
        "end_for", "continue", "var", "end_var",
    ];
    let source = include_str!("profile_4th.st");
    for comment in source.split("(*").skip(1).map(|part| part.split_once("*)").unwrap().0) {
        assert!(!comment.contains(['\'', '"', ';']), "{comment}");
        let word = words(comment).find(|word| STATEMENTS.contains(&word.to_lowercase().as_str()));
        assert_eq!(word, None, "{comment}");
    }
    // Keywords of later editions, by which some tools recognise a text with classes.
    for word in words(&text(Dialect::Iec, Format::St)) {
        assert!(
            !["method", "interface", "extends", "generic", "ref_to"].contains(&word.to_lowercase().as_str()),
            "{word}"
        );
    }
}

#[test]
fn names_differ_by_more_than_their_case() {
    for pou in pou::read(include_str!("profile_4th.st")) {
        let mut names: Vec<String> = pou.variables().map(|variable| variable.name.to_lowercase()).collect();
        names.sort_unstable();
        let count = names.len();
        names.dedup();
        assert_eq!(names.len(), count, "{}", pou.name);
    }
}

/// Some front ends substitute names in the text of a call.
#[test]
fn inputs_of_calls_are_no_variables_of_the_caller() {
    for pou in pou::read(include_str!("profile_4th.st")) {
        let names: Vec<String> = pou.variables().map(|variable| variable.name.to_lowercase()).collect();
        let code = code(pou.body);
        let (mut depth, mut rest) = (0, code.as_str());
        while let Some(at) = rest.find(['(', ')', ':']) {
            let before = rest[..at].trim_end();
            if rest[at..].starts_with(":=") && depth > 0 {
                let input = before.rsplit(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next().unwrap();
                assert!(!names.contains(&input.to_lowercase()), "{}: {input}", pou.name);
            }
            depth += i32::from(rest[at..].starts_with('(')) - i32::from(rest[at..].starts_with(')'));
            rest = &rest[at + 1..];
        }
    }
}

/// The declarations document the meaning of every input and output for the caller.
#[test]
fn every_input_and_output_has_a_meaning() {
    for pou in pou::read(include_str!("profile_4th.st")) {
        for section in &pou.sections {
            let is_seen = matches!(section.kind, SectionKind::Input | SectionKind::Output);
            assert!(section.variables.iter().all(|variable| variable.meaning.is_empty() != is_seen), "{}", pou.name);
        }
    }
}

#[test]
fn times_are_initial_values_in_every_dialect() {
    let settings =
        |dialect, format| Export { times: Times { sample: 2.5e-7, settling: 0.05 }, ..export(dialect, format) };
    for (dialect, format, sample, settling) in [
        (Dialect::Iec, Format::St, "Ts : LREAL := 2.5E-7 (*", "T_set : LREAL := 0.05 (*"),
        (Dialect::Codesys, Format::Xml, "<simpleValue value=\"2.5E-7\"/>", "<simpleValue value=\"0.05\"/>"),
        (Dialect::Scl, Format::St, "Ts : LReal := 2.5E-7;", "T_set : LReal := 0.05;"),
    ] {
        let text = settings(dialect, format).text(WRITTEN).unwrap();
        assert!(text.contains(sample) && text.contains(settling) && !text.contains("_time}"), "{text}");
    }
    assert_eq!([literal(1.0), literal(1e-3), literal(1e-7), literal(0.0)], ["1.0", "0.001", "1.0E-7", "0.0"]);
}

#[test]
fn what_the_block_would_refuse_is_refused() {
    let at = |sample, settling| {
        Export { times: Times { sample, settling }, ..Export::iec() }.text(WRITTEN).unwrap_err().to_string()
    };
    assert_eq!(at(0.0, 0.0), "`sample_time` must be finite and positive, got 0");
    assert!(at(f64::NAN, 0.0).contains("`sample_time`") && at(1e-3, -1.0).contains("`settling_time`"));
    assert!(at(1e-31, 0.0).contains("within 1e-30 and 1e30 s") && at(1e-3, 1e31).contains("within 0e0 and 1e30 s"));
    let xml = export(Dialect::Scl, Format::Xml).text(WRITTEN).unwrap_err().to_string();
    assert_eq!(xml, "the dialect `scl` has no PLCopen XML, which TIA Portal does not import: take the format `st`");
}

impl Export<'_> {
    fn iec() -> Self {
        export(Dialect::Iec, Format::St)
    }
}

/// Oracle: another XML parser. Interface and statements are those of the text.
#[test]
fn xml_reads_back_to_the_text() {
    let source = Export::iec().source().unwrap();
    let pous = pou::read(&source);
    for (dialect, namespace) in [
        (Dialect::Iec, "http://www.plcopen.org/xml/tc6_0201"),
        (Dialect::Codesys, "http://www.plcopen.org/xml/tc6_0200"),
    ] {
        let text = text(dialect, Format::Xml);
        let document = roxmltree::Document::parse(&text).unwrap();
        let all = |node: roxmltree::Node, name: &str| -> Vec<String> {
            let found = node.descendants().filter(|node| node.has_tag_name((namespace, name)));
            found.map(|node| node.attribute("name").unwrap().to_owned()).collect()
        };
        assert_eq!(all(document.root(), "pou"), pous.iter().map(|pou| pou.name).collect::<Vec<_>>());
        let nodes = document.descendants().filter(|node| node.has_tag_name((namespace, "pou")));
        for (node, pou) in nodes.zip(&pous) {
            assert_eq!(all(node, "variable"), pou.variables().map(|variable| variable.name).collect::<Vec<_>>());
            let types = node.descendants().filter(|node| node.has_tag_name((namespace, "type")));
            let types = types.map(|node| node.first_element_child().unwrap());
            let names = types.map(|node| node.attribute("name").unwrap_or(node.tag_name().name()).to_owned());
            assert!(names.eq(pou.variables().map(|variable| variable.type_name.to_owned())));
            let body = node.descendants().find(|node| node.has_tag_name((namespace, "ST"))).unwrap();
            let statements: String =
                body.descendants().filter_map(|node| node.text().filter(|_| node.is_text())).collect();
            assert!(statements.ends_with(pou.body), "{}", pou.name);
            assert_eq!(statements.starts_with("(*\nProfile4th"), pou.name == "Profile4th");
        }
    }
}

/// Every variable is marked, and no other word.
#[test]
fn scl_has_the_same_statements() {
    let scl = text(Dialect::Scl, Format::St);
    let (head, units) = scl.split_once("*)\n").unwrap();
    assert!(head.contains("dialect scl") && head.contains("Not tried"));
    for (pou, unit) in pou::read(include_str!("profile_4th.st")).iter().zip(units.split("BEGIN\n").skip(1)) {
        let body = unit.split("END_FUNCTION").next().unwrap();
        assert_eq!(body.replace(['#', '"'], ""), pou.body);
    }
}

/// A project may have a block of the standard's name already.
#[test]
fn the_block_with_execute_can_have_another_name() {
    for (dialect, format) in [
        (Dialect::Iec, Format::St),
        (Dialect::Codesys, Format::Xml),
        (Dialect::Scl, Format::St),
        (Dialect::Iec, Format::Xml),
    ] {
        let [own, other] = [MOVE, "MoveBySnap"]
            .map(|move_block| Export { move_block, ..export(dialect, format) }.text(WRITTEN).unwrap());
        // The title of the paper stays.
        let renamed = own.replace(MOVE, "MoveBySnap").replace("MoveBySnap() 4th", "MC_MoveAbsolute() 4th");
        let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(squeezed(&other), squeezed(&renamed), "{dialect:?} {format:?}");
        assert!(!other.replace("MC_MoveAbsolute() 4th", "").contains(MOVE));
    }
    let long = "a".repeat(81);
    let refused =
        |move_block| Export { move_block, ..export(Dialect::Iec, Format::St) }.text(WRITTEN).unwrap_err().to_string();
    for name in ["", "4th", "a b", "a__b", "a_", "ä", "a;b"] {
        assert!(refused(name).starts_with("`move_block` must be letters, digits and single `_`"), "{name}");
    }
    assert!(refused(&long).contains("at most 80 letters"));
    assert!(refused("profile4th").contains("another name than those of the other blocks"));
}
