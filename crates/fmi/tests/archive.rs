//! Archives: good ones as a common tool writes them, and hostile ones byte by byte.
use servobench_fmi::{Archive, FmuError, Limits, Unpacked};
use std::fs;
use std::io::{Cursor, Write};
use std::os::unix::fs::PermissionsExt;
use tempfile::{NamedTempFile, tempdir};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const DESCRIPTION: &str = include_str!("description/drive3.xml");

/// An archive of entries: name, content, kind and permissions as Unix has them.
fn zipped(entries: &[(&str, &[u8], u32)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    for (name, content, mode) in entries {
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).unix_permissions(*mode);
        zip.start_file(*name, options).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn file(bytes: &[u8]) -> NamedTempFile {
    let mut file = NamedTempFile::new().unwrap();
    file.write_all(bytes).unwrap();
    file
}

fn good() -> Vec<(&'static str, &'static [u8], u32)> {
    vec![
        ("modelDescription.xml", DESCRIPTION.as_bytes(), 0o644),
        ("binaries/x86_64-linux/drive.so", b"no library", 0o755),
        ("resources/a/b/table.csv", b"1,2\n", 0o600),
        ("resources/tool", b"#!/bin/sh\n", 0o777),
    ]
}

fn refusal(bytes: &[u8]) -> String {
    let file = file(bytes);
    let refused = Archive::open(file.path(), &Limits::default()).and_then(Archive::unpack);
    let message = refused.unwrap_err().to_string();
    message.replace(file.path().to_str().unwrap(), "a.fmu")
}

#[test]
fn what_was_packed_is_unpacked_and_removed_again() {
    let file = file(&zipped(&good()));
    let mut archive = Archive::open(file.path(), &Limits::default()).unwrap();
    assert_eq!(archive.files().count(), 4);
    assert_eq!(archive.description().unwrap().model_name, "Drive");
    let unpacked = archive.unpack().unwrap();
    let folder = unpacked.folder().to_owned();
    for (name, content, mode) in good() {
        assert_eq!(fs::read(folder.join(name)).unwrap(), content);
        let permissions = fs::metadata(folder.join(name)).unwrap().permissions().mode() & 0o777;
        assert_eq!(permissions, 0o600 | mode & 0o100, "{name}");
    }
    assert_eq!(unpacked.description().variables.len(), 14);
    drop(unpacked);
    assert!(!folder.exists());
}

#[test]
fn names_that_lead_out_are_refused_before_anything_is_written() {
    let outside = tempdir().unwrap();
    let inside = outside.path().join("evil");
    let absolute = inside.to_str().unwrap().to_owned();
    for name in ["../evil", "resources/../../evil", &absolute, "resources\\..\\evil", "C:/evil", "a\0b"] {
        let mut entries = good();
        entries.push((name, b"evil", 0o644));
        let message = refusal(&zipped(&entries));
        assert!(message.starts_with("`a.fmu` cannot be used as an FMU: the name `"), "{message}");
        assert!(message.ends_with("nothing was unpacked"), "{message}");
    }
    assert!(!inside.exists());
}

/// [`good`] with a second `resources/tool`.
fn with_a_second_tool(content: &[u8], mode: u32) -> Vec<u8> {
    let mut entries = good();
    entries.push(("resources/tooL", content, mode));
    let mut bytes = zipped(&entries);
    replace(&mut bytes, b"resources/tooL", b"resources/tool");
    bytes
}

/// A directory that names a file twice: other readers take the first or the last, so the checked entry and the one in use could differ.
#[test]
fn a_name_that_is_there_twice_with_different_bytes_is_refused() {
    let why = "the name `resources/tool` in it is there twice, and not with the same bytes; nothing was unpacked";
    for (content, mode) in [(&b"other"[..], 0o777), (b"#!/bin/sh ", 0o777), (b"#!/bin/sh\n", 0o644)] {
        let message = refusal(&with_a_second_tool(content, mode));
        assert!(message.contains(why), "{message}");
    }
    // One that claims to be the same: size and sum are those of the other, the bytes differ.
    let mut bytes = with_a_second_tool(b"#!/bin/sh\n", 0o777);
    let last = find(&bytes, b"PK\x03\x04").pop().unwrap();
    bytes[last + 30 + "resources/tool".len() + 3] ^= 1;
    assert!(refusal(&bytes).contains(why), "{}", refusal(&bytes));
}

/// Found in an official Reference FMU.
#[test]
fn a_name_that_is_there_twice_with_the_same_bytes_is_remarked() {
    let file = file(&with_a_second_tool(b"#!/bin/sh\n", 0o777));
    let mut archive = Archive::open(file.path(), &Limits::default()).unwrap();
    assert_eq!(archive.files().count(), 4);
    let remark = "`resources/tool` is in the archive 2 times, always with the same bytes";
    assert_eq!(archive.description().unwrap().remarks.last().unwrap(), remark);
    let unpacked = archive.unpack().unwrap();
    assert_eq!(fs::read(unpacked.folder().join("resources/tool")).unwrap(), b"#!/bin/sh\n");
}

#[test]
fn a_path_that_begins_with_a_point_is_inside_its_folder() {
    let mut entries = good();
    entries[0].0 = "./modelDescription.xml";
    entries[2].0 = "resources/./a/b/table.csv";
    let file = file(&zipped(&entries));
    let unpacked = Unpacked::new(file.path()).unwrap();
    assert_eq!(fs::read(unpacked.folder().join("resources/a/b/table.csv")).unwrap(), b"1,2\n");
    assert_eq!(unpacked.description().model_name, "Drive");
}

/// Opening a FIFO waits for a writer.
#[test]
fn what_is_no_file_is_refused_at_once() {
    let folder = tempdir().unwrap();
    let fifo = folder.path().join("fifo.fmu");
    assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    let said = |path: &std::path::Path| Archive::open(path, &Limits::default()).unwrap_err().to_string();
    assert!(said(&fifo).ends_with("cannot be read: it is a FIFO, and no file"), "{}", said(&fifo));
    assert!(said(folder.path()).ends_with("it is a folder, and no file"));
    assert!(said(std::path::Path::new("/dev/zero")).ends_with("it is a device, and no file"));
}

#[test]
fn links_and_devices_are_refused() {
    for (kind, expected) in
        [(0o120_000, "a symbolic link"), (0o060_000, "a special file"), (0o010_000, "a special file")]
    {
        let mut bytes =
            zipped(&[("modelDescription.xml", DESCRIPTION.as_bytes(), 0o644), ("resources/x", b"/etc", 0o777)]);
        // The external attributes of the last entry of the directory, 38 bytes behind its signature (§4.3.12).
        let last = find(&bytes, b"PK\x01\x02").pop().unwrap();
        let attributes: u32 = (kind | 0o777) << 16;
        bytes[last + 38..last + 42].copy_from_slice(&attributes.to_le_bytes());
        assert!(refusal(&bytes).contains(&format!("`resources/x` in it is {expected}")), "{}", refusal(&bytes));
    }
}

#[test]
fn sizes_are_limited() {
    let zeros = vec![0; 64 << 20];
    let bomb = zipped(&[("modelDescription.xml", DESCRIPTION.as_bytes(), 0o644), ("resources/x", &zeros, 0o644)]);
    let message = refusal(&bomb);
    assert!(message.contains("the size of all its files for a byte of the archive is 10"), "{message}");
    let small = file(&zipped(&good()));
    let limited = |limits| Archive::open(small.path(), &limits).unwrap_err().to_string();
    let all = Limits::default();
    assert!(limited(Limits { entries: 3, ..all }).contains("the number of its files is 4, at most 3 is unpacked"));
    assert!(limited(Limits { name: 20, ..all }).contains("the length of a name in it is 30"));
    assert!(limited(Limits { file: 9, ..all }).contains("the size of `modelDescription.xml` in bytes is"));
    let total = DESCRIPTION.len() as u64 + 20;
    assert!(limited(Limits { total, ..all }).contains("the size of all its files in bytes is"));
}

/// A directory that states too small a size: no more than that size is written.
#[test]
fn a_size_that_is_not_true_is_found_out() {
    let mut bytes = zipped(&[("modelDescription.xml", DESCRIPTION.as_bytes(), 0o644), ("x", &[7; 1000], 0o644)]);
    let last = find(&bytes, b"PK\x01\x02").pop().unwrap();
    bytes[last + 24..last + 28].copy_from_slice(&10_u32.to_le_bytes());
    let message = refusal(&bytes);
    assert!(message.contains("`x` in it cannot be read ("), "{message}");
}

#[test]
fn a_changed_byte_is_found_out() {
    let mut bytes = zipped(&[("modelDescription.xml", DESCRIPTION.as_bytes(), 0o644), ("x", b"abcdefgh", 0o644)]);
    let at = find(&bytes, b"PK\x03\x04").pop().unwrap() + 30 + 1;
    bytes[at + 2] ^= 1;
    assert!(refusal(&bytes).contains("`x` in it cannot be read"), "{}", refusal(&bytes));
}

#[test]
fn what_is_no_fmu_is_said() {
    assert!(refusal(b"").contains("it is no readable zip archive"));
    assert!(refusal(b"PK\x03\x04 and nothing").contains("it is no readable zip archive"));
    let mut many = zipped(&good());
    let end = find(&many, b"PK\x05\x06").pop().unwrap();
    many[end + 10..end + 12].copy_from_slice(&[0xff; 2]);
    assert!(refusal(&many).contains("zip64"));
    assert!(
        refusal(&zipped(&[("a", b"", 0o644)])).contains("no `modelDescription.xml` at its top level; is it an FMU?")
    );
    let nested = refusal(&zipped(&[("my/modelDescription.xml", b"", 0o644)]));
    assert!(nested.ends_with("`my/modelDescription.xml`; pack the content of the folder, not the folder"), "{nested}");
    let ssp = refusal(&zipped(&[("SystemStructure.ssd", b"", 0o644), ("resources/a.fmu", b"", 0o644)]));
    assert!(ssp.contains("an SSP package") && ssp.contains("give one FMU"), "{ssp}");
    assert!(refusal(&zipped(&[("modelDescription.xml", b"\xff", 0o644)])).contains("it has to be UTF-8"));
    let place = refusal(&zipped(&[("modelDescription.xml", b"<a/>", 0o644)]));
    assert!(place.starts_with("a.fmu/modelDescription.xml:1:1: "), "{place}");
    let nowhere = Unpacked::new("/nowhere.fmu").unwrap_err();
    assert!(matches!(nowhere, FmuError::File { what: "read", .. }), "{nowhere}");
}

fn find(bytes: &[u8], piece: &[u8]) -> Vec<usize> {
    (0..bytes.len()).filter(|at| bytes[*at..].starts_with(piece)).collect()
}

fn replace(bytes: &mut [u8], from: &[u8], to: &[u8]) {
    for at in find(bytes, from) {
        bytes[at..at + to.len()].copy_from_slice(to);
    }
}
