//! Writing an FMU: description, library and resources in one archive.
use crate::description::describe;
use crate::error::FmuError;
use crate::machine::Model;
use crate::part::Part;
use crate::resources::Resources;
use servobench_fmi::Version;
use servobench_scenario::Loaded;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Name of the library in the archive, without its extension.
const IDENTIFIER: &str = "servobench";
/// Beginning of an ELF file of 64 bits, little endian, and the machine x86-64 at byte 18.
const ELF64: &[u8] = b"\x7fELF\x02\x01";
const X86_64: [u8; 2] = [62, 0];

/// The FMU of a part of a scenario, as the bytes of its archive, with this library inside: the one that this crate is built to. The
/// same arguments give the same bytes.
///
/// # Errors
/// [`FmuError`] says what of the scenario cannot be in an FMU, or that the library is none.
pub fn export(loaded: &Loaded, version: Version, part: Part, library: &[u8]) -> Result<Vec<u8>, FmuError> {
    if !(library.starts_with(ELF64) && library.get(18..20) == Some(&X86_64)) {
        return Err(FmuError::Library);
    }
    let model = Model::new(part, &loaded.scenario)?;
    let resources = Resources::of(part, loaded)?;
    let description = describe(&model, version, &resources.token(), IDENTIFIER)
        .map_err(|error| FmuError::Archive(error.to_string()))?;
    let platform = match version {
        Version::Two => "linux64",
        Version::Three => "x86_64-linux",
    };
    let description = description.write();
    let library_path = format!("binaries/{platform}/{IDENTIFIER}.so");
    let mut files = vec![("modelDescription.xml".to_owned(), description.as_bytes()), (library_path, library)];
    for (path, text) in &resources.files {
        files.push((format!("resources/{path}"), text.as_bytes()));
    }
    archive(&files).map_err(|error| FmuError::Archive(error.to_string()))
}

/// A zip archive of `files` without anything that differs from one writing to the next.
fn archive(files: &[(String, &[u8])]) -> zip::result::ZipResult<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    for (path, bytes) in files {
        let mode = if path.starts_with("binaries/") { 0o755 } else { 0o644 };
        zip.start_file(path, options.unix_permissions(mode))?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}
