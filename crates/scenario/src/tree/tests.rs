use super::*;
use crate::source::Sources;

fn parsed(text: &str) -> (Parsed, Report) {
    let mut report = Report::default();
    (parse(Sources::default().scenario(), text, &mut report), report)
}

#[test]
fn entries_keep_the_order_of_the_file() {
    let (parsed, _) = parsed("b = 1\na = 2\n[z]\n[y]\n");
    let keys: Vec<_> = parsed.table.entries.iter().map(|entry| entry.key.as_str()).collect();
    assert_eq!(keys, ["b", "a", "z", "y"]);
}

#[test]
fn an_overlay_merges_tables_and_keeps_what_it_does_not_name() {
    let (mut below, _) = parsed("a = 1\n[t]\nx = 1\ny = 2\n");
    let (over, _) = parsed("[t]\ny = 3\nz = 4\n");
    below.table.overlay(over.table);
    let t = below.table.get("t").and_then(|node| node.value.as_table()).unwrap();
    let numbers: Vec<_> = t
        .entries
        .iter()
        .map(|entry| match &entry.node.value {
            Value::Number(number) => (entry.key.as_str(), number.whole.unwrap()),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(numbers, [("x", 1), ("y", 3), ("z", 4)]);
    assert!(below.table.get("a").is_some());
}

#[test]
fn every_line_with_wrong_syntax_is_reported_once() {
    let (parsed, report) = parsed("a = \nb = 2\na = 3\nq = 1e\nn = 5 mm\n");
    let said: Vec<_> = report.errors.iter().map(|e| (e.span.start, e.message.as_str())).collect();
    assert_eq!(
        said,
        [
            (4, "string values must be quoted, expected literal string"),
            (11, "duplicate key `a`"),
            (23, "invalid exponent, expected digits"),
            (28, "string values must be quoted, expected literal string"),
        ]
    );
    assert_eq!(parsed.broken.len(), 4);
}

fn places(text: &str) -> Vec<(usize, String)> {
    parsed(text).1.errors.into_iter().map(|error| (error.span.start, error.message)).collect()
}

#[test]
fn a_bracket_that_is_not_closed_is_one_error_at_its_place() {
    let said = "this bracket is not closed".to_owned();
    assert_eq!(places("[a]\nx = [1, 2\ny = 3\n[b]\nz = 4\n"), [(8, said.clone())]);
    assert_eq!(places("[a]\nx = { b = 1\ny = 3\n"), [(8, said)]);
}

#[test]
fn what_is_there_twice_is_named_with_its_first_place() {
    let text =
        "[run]\nrate = 1\n[a]\nrate = 2\nb.c = 1\nrate = 3\nb.c = 2\n[ run ] # again\n[[d]]\nx = 1\nx = 2\n[run]\n";
    let said: Vec<_> = parsed(text).1.errors.into_iter().map(|e| (e.message, e.help.unwrap_or_default())).collect();
    let pairs = [
        ("duplicate key `rate`", "the first one is on line 4"),
        ("duplicate key `c`", "the first one is on line 5"),
        ("a second table `[run]`", "the first one is on line 1"),
        ("duplicate key `x`", "the first one is on line 10"),
        ("a second table `[run]`", "the first one is on line 1"),
    ];
    assert_eq!(said, pairs.map(|(message, help)| (message.to_owned(), help.to_owned())));
}

/// Its keys are not keys of the previous table.
#[test]
fn a_header_that_is_not_closed_takes_its_keys_with_it() {
    for text in ["[a]\nx = 1\n[limits\ny = 2\nz = \"\n[b]\nv = 3\n", "[a]\nx = 1\n[limits\ny = 2\n"] {
        let (parsed, report) = parsed(text);
        let said: Vec<_> = report.errors.iter().map(|error| (error.span.start, error.message.as_str())).collect();
        assert_eq!(said, [(17, "unclosed table, expected `]`")], "{text}");
        let [lines] = parsed.broken.as_slice() else { panic!("{:?}", parsed.broken) };
        assert!(text[lines.clone()].starts_with("[limits\ny = 2") && !text[lines.clone()].contains("[b]"));
        assert_eq!(parsed.table.get("b").is_some(), text.contains("[b]"));
    }
}

#[test]
fn errors_after_a_key_without_value_are_found_too() {
    let said: Vec<usize> = places("a b = 1\nc = \nd e\nf = 1e\n").into_iter().map(|(at, _)| at).collect();
    assert_eq!(said, [2, 12, 15, 23]);
    assert!(parsed("a b = 1\n[t]\nc = 2\n").0.table.get("t").is_some());
}

#[test]
fn bottomless_nesting_is_refused() {
    let (deep, wide) = (".a".repeat(100_000), "[".repeat(100_000));
    for text in [format!("a{deep} = 1\n"), format!("[a{deep}]\n"), format!("a = {wide}")] {
        assert!(!parsed(&text).1.errors.is_empty());
    }
}

#[test]
fn what_is_no_toml_is_one_mistake() {
    let json = (0..50).map(|k| format!("  \"key{k}\": {k},\n")).collect::<Vec<_>>().concat();
    let prose = "a line of prose\n".repeat(9);
    for (text, why) in [
        (format!("{{\n{json}}}\n"), "it looks like JSON"),
        ("{}".to_owned(), "it looks like JSON"),
        ("\u{feff} <mujoco>\n</mujoco>\n".to_owned(), "it looks like XML or HTML"),
        (prose.clone(), "most of its lines are neither `key = value` nor `[table]`"),
        (format!("a = 1\n# remark\n{prose}"), "most of its lines are neither `key = value` nor `[table]`"),
    ] {
        let (parsed, report) = parsed(&text);
        let said: Vec<_> = report.errors.iter().map(|error| error.message.clone()).collect();
        assert_eq!(said, [format!("this is not TOML: {why}")]);
        let [all] = parsed.broken.as_slice() else { panic!("{:?}", parsed.broken) };
        assert_eq!((parsed.table, all), (Table::default(), &(0..text.len())));
    }
    // As many lines that can be read make it a scenario with nine mistakes.
    let keys = (0..9).map(|k| format!("k{k} = 1\n")).collect::<Vec<_>>().concat();
    assert_eq!(parsed(&(prose + &keys)).1.errors.len(), 9);
}

#[test]
fn an_integer_beyond_64_bits_is_infinite() {
    let (parsed, _) = parsed("a = 99999999999999999999\n");
    let Some(Value::Number(number)) = parsed.table.get("a").map(|node| &node.value) else { panic!() };
    assert!(number.whole.is_none() && number.value.is_infinite());
}
