//! `servobench plc export`: the files, and what is refused.
use crate::{code, command, folder, said, servobench};
use std::fs;
use std::process::Output;

fn text(output: &Output) -> String {
    assert_eq!(code(output), 0, "{}", said(output));
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn every_dialect_is_written_to_standard_output() {
    for (dialect, format, begin) in [
        ("iec", "st", "FUNCTION_BLOCK Profile4th\nVAR_INPUT\n"),
        ("codesys", "st", "FUNCTION_BLOCK MC_MoveAbsolute\nVAR_INPUT\n"),
        ("scl", "st", "FUNCTION_BLOCK \"Profile4th\"\n{ S7_Optimized_Access := 'TRUE' }\n"),
        ("iec", "xml", "<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\""),
        ("codesys", "xml", "<project xmlns=\"http://www.plcopen.org/xml/tc6_0200\""),
    ] {
        let text = text(&servobench(&["plc", "export", "--dialect", dialect, "--format", format]));
        assert!(text.contains(begin) && (text.lines().count() <= 900 || format == "xml"), "{text}");
        assert!(text.contains(&format!("dialect {dialect}.")), "{dialect}: its head says which it is");
    }
}

#[test]
fn a_file_is_written_whole_and_its_memory_said() {
    let work = folder(&[]);
    let file = work.path().join("profile4th.st");
    let path = file.to_str().unwrap();
    let output = servobench(&["plc", "export", "--sample-time", "250 us", "--settling-time", "5 ms", "-o", path]);
    assert_eq!((code(&output), output.stdout.len()), (0, 0), "{}", said(&output));
    let written = fs::read_to_string(&file).unwrap();
    assert!(written.contains("Ts : LREAL := 0.00025 (*") && written.contains("T_set : LREAL := 0.005 (*"));
    let said = said(&output);
    assert!(said.contains("bytes for an instance of Profile4th") && said.contains("of MC_MoveAbsolute"), "{said}");
}

#[test]
fn what_cannot_be_written_is_refused() {
    for (arguments, message) in [
        (&["--dialect", "scl", "--format", "xml"][..], "the dialect `scl` has no PLCopen XML"),
        (&["--sample-time", "0 s"], "`sample_time` must be finite and positive, got 0"),
        (&["--settling-time=-1 ms"], "`settling_time` must be finite and not negative, got -0.001"),
        (&["--dialect", "rockwell"], "[possible values: iec, codesys, scl]"),
        (&["-o", "no/such/folder/a.st"], "cannot write `no/such/folder/a.st`"),
    ] {
        let output = servobench(&[&["plc", "export"], arguments].concat());
        assert!(code(&output) != 0 && output.stdout.is_empty(), "{arguments:?}");
        assert!(said(&output).contains(message), "{}", said(&output));
    }
}

/// The time in it is that of the convention of reproducible builds.
#[test]
fn xml_says_when_it_was_written() {
    let output = command(&["plc", "export", "--format", "xml"]).env("SOURCE_DATE_EPOCH", "1").output().unwrap();
    assert!(text(&output).contains("creationDateTime=\"1970-01-01T00:00:01Z\""));
}
