//! `servobench objects`: the object dictionary as a table, a data sheet and JSON.
use crate::{SLIDE, code, command, folder, json, on_a_bus, said, servobench};
use serde_json::Value;
use std::fs;
use std::process::Output;

fn text(output: &Output) -> String {
    assert_eq!(code(output), 0, "{}", said(output));
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The entry of an index and sub-index in the JSON `table`.
fn entry(table: &Value, index: u16, subindex: u8) -> &Value {
    let mut entries = table.as_array().unwrap().iter();
    entries.find(|entry| entry["index"] == index && entry["subindex"] == subindex).unwrap()
}

#[test]
fn the_table_fits_a_terminal() {
    let table = text(&servobench(&["objects"]));
    assert!(table.lines().all(|line| line.chars().count() <= 80), "80 columns:\n{table}");
    insta::assert_snapshot!(table);
}

#[test]
fn what_a_scenario_writes_is_in_every_format() {
    let work = folder(&[("slide.toml", &on_a_bus("\"6065h\" = 10000\n\"607Dh.2\" = 500000"))]);
    let file = work.path().join("slide.toml");
    let shown = |format: &str| text(&servobench(&["objects", file.to_str().unwrap(), "--format", format]));

    let table = shown("table");
    let marked: Vec<&str> = table.lines().filter(|line| line.contains('*')).collect();
    assert!(
        matches!(marked[..], [window, limit, _] if window.starts_with("6065h ") && window.contains(" *10000 ")
            && limit.starts_with("607Dh:2 ") && limit.contains(" *500000 ")),
        "{marked:?}"
    );

    let values = json(shown("json").as_bytes());
    assert_eq!(entry(&values, 0x6065, 0)["value"], 10_000);
    assert_eq!(entry(&values, 0x607D, 2)["value"], 500_000);
    assert_eq!(entry(&values, 0x607D, 1)["value"], i32::MIN);

    let eds = shown("eds");
    let configured: Vec<&str> = eds.lines().filter(|line| line.starts_with("ParameterValue=")).collect();
    assert_eq!(configured, ["ParameterValue=10000", "ParameterValue=500000"]);
    let section = eds.split("[607Dsub2]\n").nth(1).unwrap().split("\n\n").next().unwrap();
    assert!(section.contains("DefaultValue=2147483647\n"), "the value after power-on stays:\n{section}");
    assert!(section.ends_with("ParameterValue=500000"), "{section}");
    assert!(!text(&servobench(&["objects", "--format", "eds"])).contains("ParameterValue"));
}

/// The codes are those of CiA 301, table 22.
#[test]
fn every_write_that_the_drive_refuses_is_told_at_its_place() {
    let objects = [
        "\"6065h\" = 0",
        "\"6041h\" = 1",
        "\"2FFFh\" = 1",
        "\"6099h.3\" = 1",
        "\"6066h\" = 65536",
        "\"6098h\" = 99",
        "\"607Dh.1\" = 2147483647",
    ];
    let scenario = on_a_bus(&objects.join("\n"));
    let first_line = 2 + scenario.lines().position(|line| line == "[drive.objects]").unwrap();
    let work = folder(&[("slide.toml", &scenario)]);
    let output = servobench(&["objects", work.path().join("slide.toml").to_str().unwrap()]);
    assert_eq!(code(&output), 2, "{}", said(&output));
    assert!(output.stdout.is_empty());
    let said = said(&output);
    assert!(said.contains("slide.toml: 7 mistakes"), "{said}");
    let words = said.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
    for (k, (code, message)) in [
        ("0609 0032h", "`Following error window` (6065h:00h) must be at least 1, got 0"),
        ("0601 0002h", "`Statusword` (6041h:00h) is read only"),
        ("0602 0000h", "object 2FFFh does not exist"),
        ("0609 0011h", "6099h:03h does not exist: `Homing speeds` has sub-indices up to 02h"),
        ("0609 0031h", "must be at most 65535, got 65536"),
        ("0609 0030h", "`Homing method` (6098h:00h) must be one of"),
        ("0609 0036h", "must be below 2147483647, the other end"),
    ]
    .into_iter()
    .enumerate()
    {
        let place = format!("slide.toml:{}:", first_line + k);
        for expected in [place.as_str(), code, message] {
            assert!(words.contains(expected), "{expected} in:\n{said}");
        }
    }
}

#[test]
fn a_scenario_without_a_bus_writes_no_objects() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let output = servobench(&["objects", work.path().join("slide.toml").to_str().unwrap()]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("slide.toml` has no `[bus]`"), "{}", said(&output));
}

/// CiA 306-1: ASCII, lines of at most 255 characters, ended by a line feed here.
#[test]
fn a_data_sheet_is_as_cia_306_has_it_and_the_same_each_time() {
    let work = tempfile::tempdir().unwrap();
    let file = work.path().join("axis.eds");
    let made_at = |seconds: &str, more: &[&str]| {
        let arguments = [&["objects", "--format", "eds"], more].concat();
        command(&arguments).env("SOURCE_DATE_EPOCH", seconds).output().unwrap()
    };
    let output = made_at("1795248000", &["-o", file.to_str().unwrap()]);
    assert_eq!((code(&output), said(&output).as_str()), (0, ""));
    let eds = fs::read_to_string(&file).unwrap();
    assert!(eds.is_ascii() && !eds.contains('\r') && eds.lines().all(|line| line.len() <= 255));
    assert!(eds.starts_with("[FileInfo]\nFileName=axis.eds\n"), "{eds}");
    // 20 778 days after 1970-01-01, at 08:00 in the morning.
    for expected in ["CreationTime=08:00AM\n", "CreationDate=11-21-2026\n", "ModificationDate=11-21-2026\n"] {
        assert!(eds.contains(expected), "{expected} in:\n{eds}");
    }
    let printed = text(&made_at("1795248000", &[]));
    assert_eq!(printed, eds.replace("FileName=axis.eds", "FileName=drive.eds"));
    let output = made_at("yesterday", &[]);
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("SOURCE_DATE_EPOCH is `yesterday`"), "{}", said(&output));
}

#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let work = tempfile::tempdir().unwrap();
    let (there, nowhere) = (work.path().join("objects.json"), work.path().join("no/folder/objects.json"));
    let write = |path: &std::path::Path| servobench(&["objects", "--format", "json", "-o", path.to_str().unwrap()]);
    assert_eq!(said(&write(&there)), "");
    assert_eq!(json(&fs::read(&there).unwrap()), json(text(&servobench(&["objects", "--format", "json"])).as_bytes()));
    let output = write(&nowhere);
    assert_eq!(code(&output), 3);
    assert!(said(&output).contains("cannot write") && said(&output).contains("no/folder"), "{}", said(&output));
    assert_eq!(fs::read_dir(work.path()).unwrap().count(), 1, "nothing else is left");
}
