//! Fuzz targets: foreign archives and descriptions. `docs/testing.md` describes longer runs.
use servobench_fmi::{Archive, DataType, FmuError, Limits, ModelDescription, Values};
use servobench_fuzz::{Splice, check, fuzz};
use std::io::{Cursor, Write};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const TWO: &str = include_str!("../description/drive2.xml");
const THREE: &str = include_str!("../description/drive3.xml");

#[rustfmt::skip]
const WORDS: &[&str] = &[
    "<", ">", "/>", "</", "\"", "'", "=", "&", "&lt;", "&#0;", "<!--", "-->", "<![CDATA[", "]]>", "<!DOCTYPE a>", "\u{feff}", "\u{0}",
    "start", "min", "max", "valueReference", "dependencies", "index", "declaredType", "causality", "variability", "initial",
    "input", "output", "parameter", "local", "exact", "calculated", "continuous", "discrete", "Real", "Float64", "Int8", "Clock",
    "INF", "-INF", "NaN", "0", "-1", "4294967296", "18446744073709551616", "1e999", "true",
    "<Dimension start=\"2\"/>", "<Dimension valueReference=\"1\"/>", "<Start value=\"\"/>", "<Alias name=\"a\"/>",
];

/// In an accepted description every reference resolves and every start value fits; a refusal has a place.
#[test]
fn descriptions() {
    let files = Splice::text(&[TWO, THREE], WORDS);
    fuzz(check!(), 1_000, files, |text: &String| match ModelDescription::read(text, "a.xml") {
        Ok(description) => assert_consistent(&description),
        Err(FmuError::Description { line, column, .. }) => {
            assert!(line >= 1 && column >= 1 && line as usize <= text.lines().count().max(1) + 1);
        }
        Err(other) => panic!("{other}"),
    });
}

fn assert_consistent(it: &ModelDescription) {
    for (at, variable) in it.variables.iter().enumerate() {
        assert_eq!(it.position(&variable.name), Some(at));
        assert!(variable.unit.is_none_or(|unit| unit < it.units.len()));
        assert_eq!(variable.data_type == DataType::Enumeration, it.enumeration(variable).is_some());
        assert!(variable.derivative_of.is_none_or(|of| of < it.variables.len()));
        assert!(variable.min.zip(variable.max).is_none_or(|(min, max)| min <= max));
        let count: u64 = it.shape(variable).iter().product();
        assert!(count > 0);
        let fits = |values: &Values| values.len() == 1 || values.len() as u64 == count;
        assert!(variable.start.as_ref().is_none_or(fits), "{variable:?}");
    }
    for unit in it.units.iter().filter_map(|unit| unit.base) {
        assert!(unit.from_si(unit.to_si(0.0, true), true) == 0.0);
    }
    let all = [&it.structure.outputs, &it.structure.derivatives, &it.structure.initial_unknowns];
    for unknown in all.into_iter().flatten() {
        let dependencies = unknown.dependencies.iter().flatten().map(|(at, _)| *at);
        assert!(dependencies.chain([unknown.variable]).all(|at| at < it.variables.len()));
    }
}

/// Unpacking writes nothing outside the folder and nothing larger than allowed; a refusal is in words.
#[test]
fn archives() {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    for (name, content) in
        [("modelDescription.xml", THREE), ("binaries/x86_64-linux/drive.so", "x"), ("resources/..a/", "")]
    {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content.as_bytes()).unwrap();
    }
    let bytes = zip.finish().unwrap().into_inner();
    let words: &[&[u8]] =
        &[b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06", b"PK\x06\x06", b"../", b"/", b"\\", &[0xff; 4], &[0; 4]];
    let room = tempfile::tempdir().unwrap();
    let path = room.path().join("a.fmu");
    let limits = Limits { entries: 10, file: 1 << 16, total: 1 << 17, ..Limits::default() };
    fuzz(check!(), 500, Splice::bytes(&[&bytes], words), |bytes: &Vec<u8>| {
        std::fs::write(&path, bytes).unwrap();
        match Archive::open(&path, &limits).and_then(Archive::unpack) {
            Ok(unpacked) => {
                let (mut folders, mut total) = (vec![unpacked.folder().to_owned()], 0);
                while let Some(folder) = folders.pop() {
                    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
                        let kind = entry.file_type().unwrap();
                        assert!(kind.is_dir() || kind.is_file());
                        total += if kind.is_file() { entry.metadata().unwrap().len() } else { 0 };
                        folders.extend(kind.is_dir().then(|| entry.path()));
                    }
                }
                assert!(total <= limits.total);
            }
            Err(refused) => assert!(!refused.to_string().is_empty()),
        }
        let here: Vec<_> = std::fs::read_dir(room.path()).unwrap().collect();
        assert_eq!(here.len(), 1, "nothing but the archive");
    });
}
